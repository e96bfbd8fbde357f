/*
 * HDF5 trusts its files: a damaged or malicious one can crash the program that
 * reads it, make it loop, or make it ask for all memory. Another process,
 * libexec/ritz-walk.c, therefore reads each file first. This header is what the
 * two sides share.
 */
#ifndef RITZ_TOOLS_CLI_WALK_H
#define RITZ_TOOLS_CLI_WALK_H

#include <ritz/base.h>

enum {
    WALK_FILE = 3,                 /* descriptor of the file */
    WALK_BYTES = 1 << 30,          /* memory limit of the process */
    WALK_SECONDS = 10,             /* of processor time, and one more for */
    WALK_BYTES_A_SECOND = 1 << 18, /* each of these bytes of the file */
    WALK_RATIO = 1032,             /* best compression of deflate */
    WALK_SPARE = 1 << 19, /* bytes declared beyond what the file holds */
};

/* How the process ends, if it can be started and no signal ends it. */
typedef enum walk_end {
    WALK_WHOLE,    /* all that can be read was read; the tool reports errors */
    WALK_UNOPENED, /* HDF5 does not recognise the file */
    WALK_MEMORY,   /* HDF5 asked for more memory than it may have */
} walk_end;

/**
 * Let another process read an open file, with limits on its time, its memory
 * and what it may write. A file that was read before and has not changed is not
 * read again. For ritz_container_guard.
 *
 * @return RITZ_ERR_FORMAT if a signal or a limit ends the process,
 *         RITZ_ERR_FILE if it cannot be started
 */
ritz_status walk_file(int file);

/**
 * Start that process for a file that will be opened soon, so that it runs at the
 * same time as the tool and others like it; walk_file() waits for its end. Does
 * nothing with what is no HDF5 file or cannot be opened, which is reported when
 * the tool opens it.
 */
void walk_ahead(const char *path);

#endif
