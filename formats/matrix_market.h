/* What the parts of the Matrix Market reader hand each other. */
#ifndef RITZ_FORMATS_MATRIX_MARKET_H
#define RITZ_FORMATS_MATRIX_MARKET_H

#include "formats/lines.h"

#include <ritz/foreign.h>

/* In the order of their names in matrix_market.c. */
enum { RITZ_MARKET_COORDINATE, RITZ_MARKET_ARRAY };
enum {
    RITZ_MARKET_REAL,
    RITZ_MARKET_DOUBLE,
    RITZ_MARKET_INTEGER,
    RITZ_MARKET_COMPLEX,
    RITZ_MARKET_PATTERN,
};
enum {
    RITZ_MARKET_GENERAL,
    RITZ_MARKET_SYMMETRIC,
    RITZ_MARKET_SKEW,
    RITZ_MARKET_HERMITIAN,
};

typedef struct ritz_market_entry {
    int64_t row, col; /* from 0; of symmetric files in the lower triangle */
    double re, im;
    bool flipped; /* stood in the upper triangle */
} ritz_market_entry;

typedef struct ritz_market {
    ritz_lines text;
    int layout, field, symmetry;
    const char *kind; /* its symmetry in words */
    int64_t nrow, ncol;
    int64_t most; /* entries there is room for */
    int64_t count;
    ritz_market_entry *entry;
    int64_t digits;
} ritz_market;

/** Take the next line that is neither blank nor a comment, less its blanks. */
bool ritz_market_next(ritz_market *m);

/** a := the value that entry (col, row) has if (row, col) has a. */
void ritz_market_mirror(const ritz_market *m, double *re, double *im);

/** Entries from the next line to the end of the file. */
ritz_status ritz_market_read_entries(ritz_market *m);

/** Sort; of a mirrored pair that agrees keep one, refuse other repetitions. */
ritz_status ritz_market_settle(ritz_market *m);

/** Columns from sorted entries, both triangles. */
ritz_status ritz_market_compress(const ritz_market *m, ritz_matrix *out);

#endif
