/* Which engine finds modes where the user names none. For eigen_sparse.c alone. */
#ifndef RITZ_LINEAR_ENGINE_CHOICE_H
#define RITZ_LINEAR_ENGINE_CHOICE_H

#include <ritz/matrix.h>

#include <stdbool.h>

/** What the time and memory of a search depend on. */
typedef struct ritz_search_size {
    int64_t n;         /* dofs */
    int64_t k;         /* modes to be found */
    double entries;    /* of the factor */
    double operations; /* to make a factor */
    double accuracy;   /* requested, 0: to rounding */
} ritz_search_size;

/** An engine with its predictions. */
typedef struct ritz_engine_cost {
    double operations; /* in multiples of those of a large matrix product */
    double bytes;      /* beside the factor */
} ritz_engine_cost;

/** Predict the cost of RITZ_EIGEN_LANCZOS, _SLICES or _AMLS; that of any other
 * engine is HUGE_VAL, and so is that of substructures without an accuracy. */
ritz_engine_cost ritz_engine_cost_of(ritz_eigen_engine engine,
                                     const ritz_search_size *size);

/**
 * The engine with the least time of those that fit into the memory allowed. If
 * none fits, it is the one with the least memory.
 *
 * @param[in]  fits    whether so many bytes fit (ritz_memory_fits())
 * @param[out] reason  one phrase, a constant
 */
ritz_eigen_engine ritz_engine_choose(const ritz_search_size *size,
                                     bool (*fits)(int64_t bytes),
                                     const char **reason);

#endif
