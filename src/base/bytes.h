/* SHA-256 of bytes, computed while the caller goes on. */
#ifndef RITZ_BASE_BYTES_H
#define RITZ_BASE_BYTES_H

#include <ritz/base.h>

/* A SHA-256 that is being computed. */
typedef struct ritz_digest_work ritz_digest_work;

/**
 * Start to compute the SHA-256 of @p size bytes: in a thread of its own if they
 * are at least 4 MiB and ritz_set_threads() allows two threads, otherwise
 * before this function returns.
 *
 * @param[in]  bytes  valid and unchanged until ritz_digest_end()
 * @param[out] out    to be freed by ritz_digest_end()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_digest_begin(const void *bytes, int64_t size,
                              ritz_digest_work **out);

/**
 * Wait until the SHA-256 is computed, and free *work, which becomes NULL. Does
 * nothing, and leaves @p digest as it is, if *work is NULL.
 *
 * @param[out] digest  64 hexadecimal digits and a NUL; NULL: not wanted
 */
void ritz_digest_end(ritz_digest_work **work, char digest[RITZ_DIGEST_SIZE]);

#endif
