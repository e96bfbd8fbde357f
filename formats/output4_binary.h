/* OUTPUT4 as records: what their reader and that of columns have in common. */
#ifndef RITZ_FORMATS_OUTPUT4_BINARY_H
#define RITZ_FORMATS_OUTPUT4_BINARY_H

#include "formats/output4.h"

/* The file and how its bytes are meant. */
typedef struct ritz_binary {
    const unsigned char *begin, *at, *end;
    bool big_endian;
    int64_t mark;    /* bytes of a record's length */
    int64_t integer; /* bytes of an integer, the size of a word too */
    int64_t real;    /* bytes of a number in this matrix */
} ritz_binary;

typedef struct ritz_binary_record {
    const unsigned char *at;
    int64_t size;
} ritz_binary_record;

/** How the file is spelled, from the length of its first record. */
bool ritz_binary_spelling(const char *bytes, int64_t size, ritz_binary *out);

/** @p size bytes as an unsigned number. */
static inline uint64_t ritz_binary_load(const unsigned char *at, int64_t size,
                                        bool big_endian)
{
    uint64_t value = 0;

    for (int64_t k = 0; k < size; k++)
        value = value << 8 | at[big_endian ? k : size - 1 - k];
    return value;
}

/** @p size bytes, 4 or 8, as an integer. */
static inline int64_t ritz_binary_integer(const ritz_binary *b,
                                          const unsigned char *at, int64_t size)
{
    uint64_t bits = ritz_binary_load(at, size, b->big_endian);

    return size == 4 ? (int64_t)(int32_t)(uint32_t)bits : (int64_t)bits;
}

/** Take a record that is not empty; its size is -1 at the end of the file. */
ritz_status ritz_binary_take(ritz_binary *b, ritz_binary_record *out);

/** A record as the header of a matrix. */
ritz_status ritz_binary_header(const ritz_binary *b,
                               const ritz_binary_record *from,
                               ritz_output4_header *out);

/** Numbers in the columns ahead, at most: what to make room for. */
int64_t ritz_binary_numbers(const ritz_binary *b, int64_t ncol);

#endif
