/*
 * Entries of a matrix as lines of text, as Matrix Market has them: below a head
 * that states sizes and symmetry, or without a head.
 */
#ifndef RITZ_FORMATS_MARKET_H
#define RITZ_FORMATS_MARKET_H

#include "formats/decimal.h"

#include <ritz/import.h>

/* In the order of their names in the banner. */
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
    bool bare; /* no head has stated what follows, and there are no comments:
                  while entries are read, nrow and ncol are INT64_MAX, `most` is
                  at least their number, and the matrix is general */
    int layout, field, symmetry;
    const char *kind; /* its symmetry in words */
    int64_t nrow, ncol;
    int64_t most; /* entries there is room for */
    int64_t count;
    ritz_market_entry *entry;
    int64_t digits;
} ritz_market;

/** Take the next line that is neither blank nor a comment, less the blanks
 * before it. */
bool ritz_market_next_line(ritz_market *m);

/** Refuse dimensions that @p bytes of entries can hardly fill. */
ritz_status ritz_market_admit_size(const ritz_market *m, int64_t bytes);

/** Read all lines that are left as entries, large files by several threads.
 * @return RITZ_ERR_FORMAT; the wrong line is the last that was taken */
ritz_status ritz_market_read_entries(ritz_market *m);

/** Put the line that was taken last before the sentence of a failure. */
ritz_status ritz_market_at_line(const ritz_market *m, ritz_status status);

/**
 * The matrix of the entries, both triangles of a symmetric one, with its
 * `symmetric` and `digits`. Entries are freed.
 *
 * @return RITZ_ERR_FORMAT if an entry is given twice
 */
ritz_status ritz_market_compress(ritz_market *m, ritz_matrix *out);

void ritz_market_free(ritz_market *m);

#endif
