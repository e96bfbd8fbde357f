/*
 * HDF5 trusts its files: one that is damaged, or made to, can end a program
 * that reads it, lead it in circles or have it ask for all memory. So another
 * process reads each file first, libexec/ritz-walk.c, which may die of it. Here
 * is what the two sides agree on.
 */
#ifndef RITZ_TOOLS_CLI_WALK_H
#define RITZ_TOOLS_CLI_WALK_H

#include <ritz/base.h>

enum {
    WALK_FILE = 3,                 /* the file, as a descriptor */
    WALK_BYTES = 1 << 30,          /* memory that the process may have */
    WALK_SECONDS = 10,             /* of its processor, */
    WALK_BYTES_A_SECOND = 1 << 18, /* and one more for so much of the file */
    WALK_RATIO = 1032,             /* that deflate can reach */
    WALK_SPARE = 1 << 19,          /* bytes that may be declared in vain */
};

/* How the process ends, unless a signal ends it, or it
   cannot be started. */
typedef enum walk_end {
    WALK_WHOLE,    /* all that can be read was read; errors are the tool's */
    WALK_UNOPENED, /* HDF5 does not know it */
    WALK_MEMORY,   /* HDF5 asked for more memory than it may have */
} walk_end;

/**
 * Have an open file read by a process of its own, with limits on its time, its
 * memory and what it may write; a file that was read so, and was not changed,
 * is not read again. For ritz_container_guard.
 *
 * @return RITZ_ERR_FORMAT if that process does not come to its end, and
 *         RITZ_ERR_FILE if it cannot be started
 */
ritz_status walk_file(int file);

#endif
