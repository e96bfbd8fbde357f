/*
 * A file that appears under its name only once it is complete.
 *
 * It is written in the same folder under a name that no other writer has, then
 * renamed. If two writers publish the same file, the complete file of the last
 * one remains. A symbolic link stays, and the file that it points to is
 * replaced by one with the same permission bits. A hard link to that file keeps
 * the old content, because existing files are never written to.
 *
 * A draft is renamed once its contents are on the disk, and the new name is
 * then written to the disk as well, so that a power cut leaves the old file or
 * the new one; if writing the name fails, the file is removed. The environment
 * variable RITZ_SYNC=0 skips these writes, for tests and benchmarks.
 *
 * A draft that a killed writer left behind is removed by the next writer of the
 * same file, since a draft is locked only as long as its writer lives.
 *
 * A program publishes its files together, after it has succeeded: between
 * ritz_draft_hold and ritz_draft_settle, ritz_draft_publish only keeps the
 * complete draft; drafts that would replace an input, or the file of another
 * draft, are refused. Only one thread may write files in that time. Without
 * ritz_draft_hold no such state exists.
 */
#ifndef RITZ_BASE_DRAFT_H
#define RITZ_BASE_DRAFT_H

#include <ritz/base.h>

#include <stdbool.h>

typedef struct ritz_draft {
    char *path; /* where it will appear, which is what a link names */
    char *name; /* where it is written meanwhile */
    int mode;   /* permission bits of the file that it replaces; -1: none */
    int file;   /* open and locked while `name` is not NULL */
} ritz_draft;

/**
 * Create an empty draft of @p path. Once published, it has the permissions of
 * the file that it replaces, or those of any new file. Old drafts of @p path
 * without a living writer are removed first, except files of other users, links
 * and anything that is not a regular file; where the file system has no locks,
 * none is removed.
 *
 * @return RITZ_ERR_FILE if it cannot be created, or if @p path is a folder, a
 *         device, a pipe, an open file of a process (/dev/stdout), or anything
 *         else that a rename must not replace; RITZ_ERR_ARGUMENT as
 *         ritz_draft_check
 */
ritz_status ritz_draft_new(const char *path, ritz_draft *out);

/** Rename the draft to its path, now or in ritz_draft_settle; @p draft is then
 * empty. */
ritz_status ritz_draft_publish(ritz_draft *draft);

/**
 * Publish files that belong together, all or none: if one cannot be renamed,
 * those already renamed are removed. The drafts are then empty.
 */
ritz_status ritz_draft_publish_all(int64_t count, ritz_draft *const *draft);

/** Rename the draft to its path now, even while others are held. */
ritz_status ritz_draft_publish_now(ritz_draft *draft);

/** Remove the file of a draft that was not published. */
void ritz_draft_free(ritz_draft *draft);

/** From now on keep published drafts until ritz_draft_settle, and let the
 * process open as many files as the system allows. */
void ritz_draft_hold(void);

/**
 * Register a regular file as an input, by device and inode, so that no draft
 * replaces it; does nothing before ritz_draft_hold.
 */
ritz_status ritz_draft_protect(const char *path);

/** Undo ritz_draft_protect for a file that is read and then replaced, such as a
 * checkpoint. */
void ritz_draft_unprotect(const char *path);

/**
 * Whether a file may be written to @p path.
 *
 * @return RITZ_ERR_ARGUMENT if it is a registered input or the target of a
 *         draft that is kept
 */
ritz_status ritz_draft_check(const char *path);

/** Whether two paths name the same file: by device and inode, or by folder and
 * name if the files do not exist yet. */
bool ritz_draft_same(const char *path, const char *other);

/**
 * End ritz_draft_hold: rename all drafts that were kept or, without @p keep,
 * remove them. If one cannot be renamed, those already renamed are removed as
 * well.
 *
 * @return RITZ_ERR_FILE if a draft cannot be renamed
 */
ritz_status ritz_draft_settle(bool keep);

/**
 * Remove the files of all drafts that have been neither renamed nor freed, for
 * a signal handler that then ends the process. Where files that belong together
 * are being renamed, it waits until all have their names. The function is
 * async-signal-safe and does not change the drafts themselves.
 */
void ritz_draft_discard_all(void);

#endif
