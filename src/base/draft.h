/*
 * A file that appears under its name only once it is complete.
 *
 * It is written in the same folder under a name that no other writer has, then
 * renamed. Of two writers of one file the last to publish wins, whole. A link
 * stays a link, and the file that it names is replaced, with the permission
 * bits that it had; another name of that file (a hard link) keeps the old
 * content, because nothing is ever written into a file that is there.
 *
 * A name is given once the bytes are on the disk, and is then brought there as
 * well, so that a power cut leaves the old file or the new one; what fails then
 * leaves no file. The environment's RITZ_SYNC=0 leaves this out, for tests and
 * benchmarks.
 *
 * What a killed writer left is removed by the next writer of the same file: a
 * draft is locked as long as its writer lives.
 *
 * A program holds its files back until it knows that all went well: between
 * ritz_draft_hold and ritz_draft_settle, ritz_draft_publish only keeps the
 * complete file; no input is replaced, and no file is written twice. This state
 * is for one thread, as a program has that writes; without ritz_draft_hold
 * there is none.
 */
#ifndef RITZ_BASE_DRAFT_H
#define RITZ_BASE_DRAFT_H

#include <ritz/base.h>

#include <stdbool.h>

typedef struct ritz_draft {
    char *path; /* where it will appear, which is what a link names */
    char *name; /* where it is written meanwhile */
    int mode;   /* permission bits of the file that it replaces; -1: none */
    int file;   /* open and locked; of no meaning while name is NULL */
} ritz_draft;

/**
 * Create an empty draft of @p path; once published it has the permissions of
 * the file that it replaces, or of any new file. Before, drafts of it that have
 * no living writer are removed; files of other users, links and what is no
 * regular file stay, and all of them where the file system has no locks.
 *
 * @return RITZ_ERR_FILE if it cannot be created, or if @p path is a folder, a
 *         device, a pipe, what a process has open (/dev/stdout), or anything
 *         else that a rename must not replace;
 *         RITZ_ERR_ARGUMENT as ritz_draft_check
 */
ritz_status ritz_draft_new(const char *path, ritz_draft *out);

/** Give the draft its name, at once or when it is settled; it is then empty. */
ritz_status ritz_draft_publish(ritz_draft *draft);

/** Give the draft its name at once, whatever becomes of the others. */
ritz_status ritz_draft_publish_now(ritz_draft *draft);

/** Remove the file of a draft that was not published. */
void ritz_draft_free(ritz_draft *draft);

/** From now on published drafts wait for ritz_draft_settle, and the process may
 * have as many files open as the system allows. */
void ritz_draft_hold(void);

/**
 * Remember a regular file that is read, by device and inode, so that no draft
 * replaces it; before ritz_draft_hold nothing is remembered.
 */
ritz_status ritz_draft_protect(const char *path);

/**
 * Whether a file may be written under @p path.
 *
 * @return RITZ_ERR_ARGUMENT if it is a protected file or that of a draft that
 *         waits
 */
ritz_status ritz_draft_check(const char *path);

/** Whether both name one file: by device and inode or, of files that are not
 * there yet, by folder and name. */
bool ritz_draft_same(const char *path, const char *other);

/**
 * End ritz_draft_hold: all drafts that wait get their names or, without
 * @p keep, are removed, and so are those that have their names already if one
 * cannot get its own.
 *
 * @return RITZ_ERR_FILE if a name cannot be given
 */
ritz_status ritz_draft_settle(bool keep);

/**
 * Remove the files of all drafts that have not their names and are not freed,
 * for a signal handler that then ends the process: async-signal-safe, and the
 * drafts themselves stay as they are.
 */
void ritz_draft_discard_all(void);

#endif
