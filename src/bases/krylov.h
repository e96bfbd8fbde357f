/* Block Krylov vectors of a structure, about one or several frequencies. */
#ifndef RITZ_BASES_KRYLOV_H
#define RITZ_BASES_KRYLOV_H

#include "bases/elastic.h"
#include "linear/orthonormal.h"

#include <ritz/basis.h>

/** The requested kinds of loads. By default these are attached dofs, inputs and
 * outputs, and also dampers if the vectors are component modes of a body that
 * is @p joined to others. */
int ritz_krylov_loads(const ritz_request *request, bool joined);

/*
 * A point at which the response is expanded, and the state of its sequence of
 * blocks.
 */
typedef struct ritz_krylov_point {
    double hertz, sigma;  /* sigma = (2 pi f)^2 */
    ritz_ldl *A;          /* factor of K - sigma M; NULL at 0 Hz */
    int64_t first, count; /* the last block: columns of V */
    int64_t whole;        /* blocks that are complete */
    bool ended;           /* the last block had no new vector */
    bool cut;             /* the last block is not complete */
} ritz_krylov_point;

typedef struct ritz_krylov {
    const ritz_elastic *body; /* borrowed */
    ritz_inner inner;
    int64_t vectors; /* that are wanted in addition to the seeds */
    int64_t seeds;   /* columns of V that were put there before */
    int64_t num_points;
    ritz_krylov_point point[RITZ_MOST_SHIFTS];
    ritz_orthonormal set;
} ritz_krylov;

/*
 * Forces, and the magnitude of the terms they are sums of, from which rounding
 * is estimated.
 */
typedef struct ritz_forces {
    ritz_dense G;    /* n x p */
    ritz_dense size; /* the same; {0}: each is one term, |G| */
} ritz_forces;

/**
 * Replace the points of S by those of @p choice, without factors, in ascending
 * order, so that 0 Hz comes first; a choice without points means 0 Hz alone.
 */
void ritz_krylov_points(const ritz_choice *choice, ritz_krylov *S);

/**
 * Factors at the points that the request chooses, and an empty set.
 *
 * @param[in] body  borrowed until free
 * @return RITZ_ERR_ARGUMENT if the request is for a frequency;
 *         RITZ_ERR_SINGULAR if a point is a natural frequency, or M gives no
 *         inner product
 */
ritz_status ritz_krylov_new(const ritz_elastic *body,
                            const ritz_request *request, ritz_krylov *out);

/**
 * Krylov sequences of all forces F about every point in turn, until there are
 * as many vectors as requested, or no new ones.
 *
 * @param[in,out] F  columns from @p seeded on may be overwritten
 * @param[in] seeded  number of first columns of F that were seeds
 */
ritz_status ritz_krylov_run(ritz_krylov *S, ritz_dense *F, int64_t seeded);

/**
 * R = P' A^-1 P G of a point. Columns that are rounding come out as zero.
 */
ritz_status ritz_krylov_respond(const ritz_krylov *S,
                                const ritz_krylov_point *point,
                                const ritz_forces *forces, ritz_dense *R);

/**
 * Add |A| |X|, the magnitude of the terms that A X sums, times @p factor to @p
 * size.
 */
void ritz_krylov_size(const ritz_sparse *A, const ritz_dense *X, double factor,
                      ritz_dense *size);

/** T = [Phi_r, V]: rigid columns, Krylov columns. */
ritz_status ritz_krylov_join(const ritz_krylov *S, ritz_basis *out);

/**
 * Say what was done: the engine, and in the remark the number of vectors and
 * whole blocks, why there are not more, and how orthonormal V is:
 * max |V'WV - I|, and 16 eps max |v|'|W||v|, as near as products by W can show
 * it.
 *
 * @param[in] wanted  vectors of the request
 */
ritz_status ritz_krylov_sign(const ritz_krylov *S, int64_t wanted,
                             ritz_basis *basis);

void ritz_forces_free(ritz_forces *forces);
void ritz_krylov_free(ritz_krylov *S);

#endif
