/* Whole files, and SHA-256 beside other work. */
#ifndef RITZ_BASE_BYTES_H
#define RITZ_BASE_BYTES_H

#include <ritz/base.h>

/* SHA-256 on its way. */
typedef struct ritz_digest_work ritz_digest_work;

/**
 * Begin to sum bytes up: in a thread of its own if they are many and
 * ritz_set_threads() allows more than one.
 *
 * @param[in]  bytes  must stay until ritz_digest_end()
 * @param[out] out    ended by ritz_digest_end(), whatever happens
 */
ritz_status ritz_digest_begin(const void *bytes, int64_t size,
                              ritz_digest_work **out);

/** Wait for the sum, and free *work, which becomes NULL. @p digest may be
 * NULL. */
void ritz_digest_end(ritz_digest_work **work, char digest[RITZ_DIGEST_SIZE]);

#endif
