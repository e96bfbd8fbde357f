/* Which engine finds modes where the user names none. */
#ifndef RITZ_LINEAR_ENGINE_CHOICE_H
#define RITZ_LINEAR_ENGINE_CHOICE_H

#include <ritz/matrix.h>

/** What the time of a search depends on. */
typedef struct ritz_search_size {
    int64_t n;         /* dofs */
    int64_t k;         /* modes to be found */
    double entries;    /* of the factor */
    double operations; /* to make a factor */
    double accuracy;   /* requested, 0: to rounding */
} ritz_search_size;

/** Predict the time of RITZ_EIGEN_LANCZOS, _SLICES or _AMLS, in operations of a
 * large matrix product. HUGE_VAL for any other engine, for slices with an
 * accuracy or with few modes, and for substructures without an accuracy. */
double ritz_engine_cost(ritz_eigen_engine engine, const ritz_search_size *size);

/** The fastest engine by this prediction. Memory has no part in the choice, so
 * that results do not depend on it: a basis that does not fit is on disk. */
ritz_eigen_engine ritz_engine_choose(const ritz_search_size *size);

/** The engine that a span names, or the one chosen for @p k modes with the
 * factor @p A of a matrix of @p n rows. */
ritz_eigen_engine ritz_engine_of(const ritz_span *span, const ritz_factor *A,
                                 int64_t n, int64_t k);

#endif
