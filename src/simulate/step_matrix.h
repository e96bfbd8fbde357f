/*
 * The matrix of an exact step, and quadratic forms that are integrated over
 * one, where few signals couple modes. A mode alone has a block of its own in
 * them, two rows and columns. What couples it to others passes through a
 * controller or a damper, and is smooth over a step, so that it has a low rank
 * k but for rounding:
 *
 *     E = blocks + U V',   W = blocks + V diag(s) V'
 *
 * Then a product takes O(N k) operations instead of N^2. If k is not small (a
 * step of many periods, a full matrix of damping), the full matrix is kept,
 * and of a form one triangle.
 */
#ifndef RITZ_SIMULATE_STEP_MATRIX_H
#define RITZ_SIMULATE_STEP_MATRIX_H

#include "base/alloc.h"

#include <ritz/matrix.h>

#include <stdbool.h>

typedef struct ritz_step_matrix {
    bool form;
    int64_t rows, cols;
    int64_t pairs; /* rows and columns j and pairs + j are those of a block */
    double (*own)[4]; /* the blocks, by columns */
    int64_t rank;     /* k; -1: it is `full`, and nothing else */
    ritz_dense U;     /* rows x k; of a form {0} */
    ritz_dense V;     /* cols x k */
    double *weight;   /* s, of a form */
    double *signal;   /* k, to work in */
    ritz_dense full;
} ritz_step_matrix;

/* States that begin with positions and rates of modes q'' + D q' + lambda q. */
typedef struct ritz_step_matrix_modes {
    int64_t count;
    const double *lambda;
    const ritz_dense *D; /* count x count */
    int64_t rows;        /* of E that are wanted, the first ones */
} ritz_step_matrix_modes;

/**
 * As ritz_exponential.
 *
 * @param[in]  Q  count; the first is that of the power of damping
 * @param[out] W  count
 * @cost   that of ritz_exponential and O(N^3) for each form and for E
 */
ritz_status ritz_step_matrices(const ritz_step_matrix_modes *modes,
                               const ritz_dense *A, double h, int count,
                               const ritz_dense *Q, ritz_step_matrix *E,
                               ritz_step_matrix *W);

/** y = E z */
void ritz_step_matrix_apply(const ritz_step_matrix *E, const double *z,
                            double *y);

/** z'W z */
double ritz_step_matrix_value(const ritz_step_matrix *W, const double *z);

/** Multiplications of a product or a value. */
int64_t ritz_step_matrix_cost(const ritz_step_matrix *A);

void ritz_step_matrix_free(ritz_step_matrix *A);

RITZ_ARRAY_OF(ritz_step_matrix);

#endif
