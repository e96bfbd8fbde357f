/*
 * Discrete dampers (and springs) kept apart from D and K, so that they can be
 * retuned after reduction: damper j adds c_j b_j b_j' to D and k_j b_j b_j' to
 * K, b_j being its influence vector, +1 and -1 at the dofs it lies between.
 */
#ifndef RITZ_DAMPERS_H
#define RITZ_DAMPERS_H

#include <ritz/dense.h>
#include <ritz/text.h>

typedef struct ritz_dampers {
    int64_t count;
    char (*name)[RITZ_NAME_SIZE];
    double *c, *k; /* either sign of k, c >= 0 */
    ritz_dense B;  /* n x count */
} ritz_dampers;

/** @p count dampers without name, c and k, for @p n coordinates. */
ritz_status ritz_dampers_new(int64_t n, int64_t count, ritz_dampers *out);

/** What the subspace x = T q sees of them: T'B; names, c and k kept. */
ritz_status ritz_dampers_project(const ritz_dampers *dampers,
                                 const ritz_dense *T, ritz_dampers *out);

void ritz_dampers_free(ritz_dampers *dampers);

#endif
