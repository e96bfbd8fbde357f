/* Text and bytes: names that files hold, whole files, numbers, near misses. */
#ifndef RITZ_TEXT_H
#define RITZ_TEXT_H

#include <ritz/status.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)

enum {
    RITZ_NAME_SIZE = 64,       /* room for a name and its NUL */
    RITZ_DIGEST_SIZE = 64 + 1, /* SHA-256 as hexadecimal text, and its NUL */
};

/**
 * The whole of @p path, ended by NUL. The caller frees @p out.
 *
 * A file is read once, from its start to its end, so that a pipe serves too.
 *
 * @return RITZ_ERR_FILE if it cannot be read; RITZ_ERR_FORMAT if it holds a NUL
 */
ritz_status ritz_text_read(const char *path, char **out);

/** The same of any bytes; a NUL is added behind them. */
ritz_status ritz_bytes_read(const char *path, int64_t *size, char **out);

/**
 * Parse all of @p text as a finite number, or as a whole one.
 *
 * @return false if it is anything else: empty, "nan", "1x", too large
 */
bool ritz_text_real(const char *text, double *out);
bool ritz_text_whole(const char *text, int64_t *out);

/**
 * Copy a name, which must fit RITZ_NAME_SIZE, be not empty and hold neither
 * '/' nor control characters, as names become parts of HDF5 paths.
 *
 * @return RITZ_ERR_ARGUMENT naming it
 */
ritz_status ritz_name_copy(const char *name, char out[RITZ_NAME_SIZE]);

/**
 * The candidate nearest to a mistyped @p word by edit distance; NULL if none
 * is near (more than half its letters differ). Names lie @p stride bytes apart,
 * the first at @p first: an array of char[stride], or a struct that starts so.
 */
const char *ritz_text_nearest(const char *word, int64_t count,
                              const char *first, size_t stride);

/**
 * The row called @p name of a table of pointers that ends in NULL, each to a
 * struct whose first member is its name. NULL if there is none, and the
 * sentence "there is no KIND 'NAME', is 'NEAREST' meant?" is recorded.
 */
const void *ritz_row_find(const void *table, const char *kind,
                          const char *name);

/** SHA-256 of some bytes, as text. */
void ritz_digest_bytes(const void *bytes, size_t size,
                       char out[RITZ_DIGEST_SIZE]);

/** SHA-256 of a file. @return RITZ_ERR_FILE */
ritz_status ritz_digest_file(const char *path, char out[RITZ_DIGEST_SIZE]);

#pragma GCC visibility pop

#endif
