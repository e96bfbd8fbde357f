/* Memory whose contents are in a file for a while, so that something else can
 * use it. */
#ifndef RITZ_BASE_SPILL_H
#define RITZ_BASE_SPILL_H

#include <ritz/base.h>

#include <stddef.h>

/** Contents that are in a file; {0}: none are. */
typedef struct ritz_spill {
    size_t bytes;
    int file;
} ritz_spill;

/**
 * Write the contents of memory to a file and return its pages to the system.
 * The memory keeps its address, and must not be read or written until
 * ritz_spill_fetch() has read the contents back. The file has no name: it is
 * deleted when the process ends, in whatever way.
 *
 * The file is in the folder that the environment variable TMPDIR names,
 * /var/tmp if there is none.
 *
 * @param[in]     what   begins the sentence of a failure, "the factor"
 * @param[in]     pages  anonymous memory of mmap(), whole pages
 * @param[in,out] out    empty; unchanged on failure, as the memory is
 * @return RITZ_ERR_FILE if the folder cannot be written to or has no room, or
 *         if its files are in memory (tmpfs)
 */
ritz_status ritz_spill_put(const char *what, void *pages, size_t bytes,
                           ritz_spill *out);

/**
 * Read the contents back to @p pages, where they were, and delete the file.
 * Does nothing if @p spill is empty.
 *
 * @param[in,out] spill  emptied, but not on failure
 * @return RITZ_ERR_FILE
 */
ritz_status ritz_spill_fetch(ritz_spill *spill, void *pages);

/** Delete the file; the contents are lost. */
void ritz_spill_free(ritz_spill *spill);

#endif
