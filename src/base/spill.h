/* Memory whose contents are in a file for a while, so that something else can
 * use it, and files for what does not fit into memory. */
#ifndef RITZ_BASE_SPILL_H
#define RITZ_BASE_SPILL_H

#include <ritz/base.h>

#include <stddef.h>
#include <stdint.h>

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
 * @param[in]     pages  anonymous memory of mmap(), whole pages, which
 *                       ritz_memory_count_mapped() has counted; not until they
 *                       are read back
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
 * @return RITZ_ERR_FILE; RITZ_ERR_MEMORY if the limit has no room for them now
 */
ritz_status ritz_spill_fetch(ritz_spill *spill, void *pages);

/**
 * Open such a file for parts that are written and read in any order.
 *
 * @param[in]     what   as of ritz_spill_put()
 * @param[in]     bytes  of all parts together
 * @param[in,out] out    empty
 * @return RITZ_ERR_FILE as ritz_spill_put()
 */
ritz_status ritz_spill_open(const char *what, size_t bytes, ritz_spill *out);

/** Write a part, which begins at byte @p at. @return RITZ_ERR_FILE */
ritz_status ritz_spill_write(const ritz_spill *spill, int64_t at, size_t bytes,
                             const void *from);

/** Read a part. @return RITZ_ERR_FILE */
ritz_status ritz_spill_read(const ritz_spill *spill, int64_t at, size_t bytes,
                            void *to);

/** Delete the file; the contents are lost. */
void ritz_spill_free(ritz_spill *spill);

#endif
