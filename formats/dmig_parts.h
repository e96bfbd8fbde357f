/* What the parts of the DMIG reader hand each other; private to them. */
#ifndef RITZ_FORMATS_DMIG_H
#define RITZ_FORMATS_DMIG_H

#include "formats/cards.h"

#include <ritz/foreign.h>

enum {
    RITZ_DMIG_SQUARE = 1,
    RITZ_DMIG_WIDE = 2,
    RITZ_DMIG_SYMMETRIC = 6,
    RITZ_DMIG_COLUMNS = 9,
};

/* What a header says. */
typedef struct ritz_dmig_header {
    char name[RITZ_NAME_SIZE];
    int64_t line; /* in the deck */
    int64_t form;
    bool complex, polar;
    int64_t digits;
    int64_t first, count; /* its terms, once sorted */
    int64_t rank;         /* place in the file */
} ritz_dmig_header;

/* A(row, col) = re + i im, as a column card gives it. */
typedef struct ritz_dmig_term {
    ritz_dof row, col;
    double re, im;
    int64_t line;
    int64_t matrix; /* index of the header */
} ritz_dmig_term;

typedef struct ritz_dmig_cards {
    ritz_cards cards;
    int64_t num_headers, headers_room;
    int64_t num_terms, terms_room;
    ritz_dmig_header *header; /* sorted by name once taken */
    ritz_dmig_term *term;
} ritz_dmig_cards;

/** Headers and terms of the deck, as its cards give them. */
ritz_status ritz_dmig_take(ritz_dmig_cards *all);

/** The matrix of a header and its sorted terms. */
ritz_status ritz_dmig_matrix(const ritz_dmig_header *owner,
                             const ritz_dmig_term *terms, ritz_matrix *out);

#endif
