/*
 * The checksum of a chunked data set: over 64-bit words w of the values as they
 * lie in memory (a dense matrix column by column, a last part of a word filled
 * with zeros),
 *
 *     h := (h xor w) p,   h := h xor (h >> 32),   modulo 2^64
 *
 * from h = 14695981039346656037 with p = 1099511628211, the numbers of FNV-1a.
 * Each step can be undone, so that no change of a single word goes unseen.
 */
#include "container/h5.h"

#include <string.h>

static int64_t sum(int64_t bytes, const void *values)
{
    const unsigned char *at = values;
    uint64_t h = 14695981039346656037U;

    for (int64_t k = 0; k < bytes; k += 8) {
        uint64_t w = 0;

        memcpy(&w, at + k, bytes - k < 8 ? (size_t)(bytes - k) : 8);
        h = (h ^ w) * 1099511628211U;
        h ^= h >> 32;
    }
    return (int64_t)(h >> 1); /* a positive number for every reader */
}

static bool is_chunked(hid_t set)
{
    hid_t plan = H5Dget_create_plist(set);
    bool is = H5Pget_layout(plan) == H5D_CHUNKED;

    ritz_h5_close(plan);
    return is;
}

ritz_status ritz_h5_seal(hid_t set, const char *name, int64_t bytes,
                         const void *values)
{
    int64_t checksum = 0;

    if (!is_chunked(set))
        return RITZ_OK;
    checksum = sum(bytes, values);
    RITZ_CHECK_IN(name, ritz_h5_set(set, "checksum", H5T_STD_I64LE,
                                    ritz_h5_scalar(), &checksum));
    return RITZ_OK;
}

/* What a script wrote has none. */
ritz_status ritz_h5_verify(hid_t set, const char *name, int64_t bytes,
                           const void *values)
{
    int64_t checksum = 0;

    if (H5Aexists(set, "checksum") <= 0)
        return RITZ_OK;
    RITZ_CHECK_IN(name,
                  ritz_h5_get(set, "checksum", H5T_STD_I64LE, 1, &checksum));
    RITZ_REFUSE_IF(checksum != sum(bytes, values), RITZ_ERR_FORMAT,
                   "'%s' is damaged: its checksum does not fit", name);
    return RITZ_OK;
}
