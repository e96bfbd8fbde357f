/* Numbers as the bytes of a file hold them. */
#ifndef RITZ_FORMATS_BYTES_H
#define RITZ_FORMATS_BYTES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/** An unsigned number of 1 to 8 bytes. */
static inline uint64_t ritz_bytes_bits(const unsigned char *at, int64_t size,
                                       bool big_endian)
{
    const bool turned = big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
    uint64_t bits = 0;
    uint32_t half = 0;

    if (size == 8) { /* fast for 8 and 4 bytes, which files have by millions */
        memcpy(&bits, at, sizeof bits);
        return turned ? __builtin_bswap64(bits) : bits;
    }
    if (size == 4) {
        memcpy(&half, at, sizeof half);
        return turned ? __builtin_bswap32(half) : half;
    }
    for (int64_t k = 0; k < size; k++)
        bits = bits << 8 | at[big_endian ? k : size - 1 - k];
    return bits;
}

static inline double ritz_bytes_single(const unsigned char *at, bool big_endian)
{
    uint32_t bits = (uint32_t)ritz_bytes_bits(at, 4, big_endian);
    float value = 0.0F;

    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static inline double ritz_bytes_double(const unsigned char *at, bool big_endian)
{
    uint64_t bits = ritz_bytes_bits(at, 8, big_endian);
    double value = 0.0;

    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
