/*
 * A file that appears under its name only once it is complete.
 *
 * It is written in the same folder under a name that no other writer has, then
 * renamed. Of two writers of one file the last to publish wins, whole.
 */
#ifndef RITZ_BASE_DRAFT_H
#define RITZ_BASE_DRAFT_H

#include <ritz/base.h>

enum { RITZ_MAX_DRAFTS = 16 };

typedef struct ritz_draft {
    char *path; /* where it will appear, which is what a link names */
    char *name; /* where it is written meanwhile */
} ritz_draft;

/**
 * Create an empty draft of @p path, with the permissions of any new file.
 *
 * @return RITZ_ERR_FILE if it cannot be created, or if @p path is a folder, a
 *         device or anything else that a rename must not replace;
 *         RITZ_ERR_ARGUMENT if RITZ_MAX_DRAFTS are unfinished
 */
ritz_status ritz_draft_new(const char *path, ritz_draft *out);

/** Give the draft its name; it is then empty. */
ritz_status ritz_draft_publish(ritz_draft *draft);

/** Remove the file of a draft that was not published. */
void ritz_draft_free(ritz_draft *draft);

/**
 * Remove the files of all drafts that are neither published nor freed, for a
 * signal handler that then ends the process: async-signal-safe, and the drafts
 * themselves stay as they are.
 */
void ritz_draft_discard_all(void);

#endif
