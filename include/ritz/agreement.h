/*
 * How far two rankings of the same modes agree.
 *
 * Places are compared, not values: modes are sorted by magnitude, those below
 * 1e-12 of the largest are rounding and share the last place, as others of one
 * value share theirs.
 */
#ifndef RITZ_AGREEMENT_H
#define RITZ_AGREEMENT_H

#include <ritz/ranking.h>

#pragma GCC visibility push(default)

/* The first k of either, clusters whole. */
typedef struct ritz_overlap {
    int64_t k;
    double share; /* of the larger of both that the other has too */
} ritz_overlap;

typedef struct ritz_agreement {
    int64_t common;       /* modes that both have */
    int64_t alone[2];     /* modes that one has only */
    double spearman;      /* correlation of places, -1 .. 1; NaN if all are
                             equal in one */
    double kendall;       /* tau-b: pairs in the same order less those in the
                             other */
    int64_t num_overlaps; /* k = 1, 2, 5, 10, 20, 50, ... */
    ritz_overlap *overlap;
    int64_t top; /* the k of what follows */
    double top_share;
    int64_t num_left, num_entered; /* of the first k: in the first ranking */
    int64_t *left, *entered;       /* alone, in the second alone; numbers of
                                      modes or tracks, as they rank */
} ritz_agreement;

/**
 * Compare two rankings of one set of modes, matched by number.
 *
 * @param[in] track  of either, which number each mode has; NULL: its index
 * @param[in] top    whose changes are listed
 * @cost O(m^2)
 */
ritz_status ritz_rankings_agree(const ritz_ranking *a, const int64_t *track_a,
                                const ritz_ranking *b, const int64_t *track_b,
                                int64_t top, ritz_agreement *out);

void ritz_agreement_free(ritz_agreement *agreement);

#pragma GCC visibility pop

#endif
