/*
 * Stochastic Lanczos quadrature [LinSaadYang2016]. For a random vector z with
 * independent entries +-1 / sqrt(d_j), d_j = sum over i of |M_ij|, the expected
 * value of (x'M z)^2 is x'M D^-1 M x: 1 for a diagonal M, and nearly 1 for a mode
 * x that is smooth from dof to dof. So
 *
 *     number of theta > t  =  E sum over theta_i > t of (x_i'M z)^2
 *
 * and a few steps of Lanczos on A^-1 M that begin with z give a Gauss quadrature
 * of that sum: the eigenvalues of the tridiagonal matrix are its points, and the
 * squares of the first components of its vectors, times z'M z, are its weights.
 * Eight vectors are used, and the mean of their sums.
 */
#include "linear/density.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    VECTORS = 8, /* one block of a solve */
    STEPS = 14,  /* of Lanczos: theta of neighbouring points differ by a factor
                    of 1.5 at most */
};

/* A point of a quadrature and its weight. */
typedef struct quadrature_point {
    double theta, weight;
} quadrature_point;

/* Eight recurrences of Lanczos, side by side. */
typedef struct recurrences {
    ritz_dense V, before; /* n x 8, the last two vectors of each */
    double mass[VECTORS]; /* z'M z */
    double alpha[VECTORS][STEPS], beta[VECTORS][STEPS];
    int steps[VECTORS]; /* fewer than STEPS if the space is exhausted */
} recurrences;

static void recurrences_free(recurrences *r)
{
    ritz_dense_free(&r->V);
    ritz_dense_free(&r->before);
}

/* V := z / |z|_M */
static ritz_status begin_vectors(const ritz_sparse *M, recurrences *r)
{
    RITZ_OWN(ritz_dense) MV = {0};
    uint64_t seed = 2016;

    RITZ_CHECK(ritz_dense_new(M->nrow, VECTORS, &r->V));
    RITZ_CHECK(ritz_dense_new(M->nrow, VECTORS, &r->before));
    for (int64_t i = 0; i < M->nrow; i++) {
        double d = 0.0;

        for (int64_t p = M->colptr[i]; p < M->colptr[i + 1]; p++)
            d += fabs(M->val[p]);
        for (int64_t c = 0; c < VECTORS && d > 0.0; c++)
            ritz_dense_col(&r->V, c)[i] =
                copysign(1.0 / sqrt(d), ritz_general_noise(&seed));
    }
    RITZ_CHECK(ritz_sparse_mul(M, &r->V, &MV));
    for (int64_t c = 0; c < VECTORS; c++) {
        double *v = ritz_dense_col(&r->V, c);

        r->mass[c] = ritz_dense_dot(&r->V, c, &MV, c);
        for (int64_t i = 0; i < M->nrow && r->mass[c] > 0.0; i++)
            v[i] /= sqrt(r->mass[c]);
    }
    return RITZ_OK;
}

/*
 * Step k of all recurrences:
 *
 *     w = A^-1 M v_k - beta_k-1 v_k-1,  alpha_k = w'M v_k,
 *     w -= alpha_k v_k,  beta_k = |w|_M,  v_k+1 = w / beta_k
 */
static ritz_status advance_vectors(const ritz_shifted *S, int k, recurrences *r)
{
    const int64_t n = S->M->nrow;
    RITZ_OWN(ritz_dense) MV = {0}, W = {0}, MW = {0};

    RITZ_CHECK(ritz_sparse_mul(S->M, &r->V, &MV));
    RITZ_CHECK(ritz_dense_copy(&MV, &W));
    RITZ_CHECK(ritz_factor_solve(S->A, &W));
    for (int64_t c = 0; c < VECTORS; c++) {
        double *w = ritz_dense_col(&W, c);
        const double *v = ritz_dense_col(&r->V, c);
        const double *before = ritz_dense_col(&r->before, c);
        const double beta = k > 0 ? r->beta[c][k - 1] : 0.0;

        r->alpha[c][k] = ritz_dense_dot(&W, c, &MV, c);
        for (int64_t i = 0; i < n; i++)
            w[i] -= beta * before[i] + r->alpha[c][k] * v[i];
    }
    RITZ_CHECK(ritz_sparse_mul(S->M, &W, &MW));
    for (int64_t c = 0; c < VECTORS; c++) {
        const double beta = sqrt(fmax(ritz_dense_dot(&W, c, &MW, c), 0.0));
        double *w = ritz_dense_col(&W, c);

        if (r->steps[c] == k && r->mass[c] > 0.0)
            r->steps[c] = k + 1;
        if (!(beta > RITZ_DENSITY_END * fabs(r->alpha[c][0])))
            r->mass[c] = -fabs(r->mass[c]); /* no further step */
        r->beta[c][k] = beta;
        for (int64_t i = 0; i < n && beta > 0.0; i++)
            w[i] /= beta;
    }
    ritz_dense_free(&r->before);
    RITZ_MOVE(r->before, r->V);
    RITZ_MOVE(r->V, W);
    return RITZ_OK;
}

/* Append the points of one quadrature. */
static ritz_status append_points(recurrences *r, int c, int64_t *count,
                                 quadrature_point *list)
{
    const int64_t k = r->steps[c];
    double Z[STEPS * STEPS] = {0};
    int info = 0;

    if (k > 0)
        info = LAPACKE_dsteqr(LAPACK_COL_MAJOR, 'I', (int)k, r->alpha[c],
                              r->beta[c], Z, (int)k);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for eigenvectors of order %" PRId64, k);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "eigenvalues of order %" PRId64 " do not converge", k);
    for (int64_t j = 0; j < k; j++)
        list[(*count)++] = (quadrature_point){
            r->alpha[c][j], Z[j * k] * Z[j * k] * fabs(r->mass[c]) / VECTORS};
    return RITZ_OK;
}

static int compare_points(const void *a, const void *b)
{
    const double x = ((const quadrature_point *)a)->theta;
    const double y = ((const quadrature_point *)b)->theta;

    return x > y ? -1 : x < y;
}

/* The theta at which the sum of weights, half of each point's own included,
   reaches k; interpolated in log theta. 0 if it does not. */
static double find_theta(int64_t count, const quadrature_point *list, double k)
{
    double sum = 0.0;
    double last = 0.0;

    for (int64_t i = 0; i < count && list[i].theta > 0.0; i++) {
        const double here = sum + 0.5 * list[i].weight;

        if (here >= k) {
            const double part = i > 0 ? (k - last) / (here - last) : 1.0;
            const double above = i > 0 ? list[i - 1].theta : list[i].theta;

            return above * pow(list[i].theta / above, part);
        }
        sum += list[i].weight;
        last = here;
    }
    return 0.0;
}

ritz_status ritz_density_reach(const ritz_shifted *S, int64_t k, double *out)
{
    RITZ_OWN(recurrences) r = {0};
    RITZ_OWN_ARRAY quadrature_point *list = NULL;
    int64_t count = 0;
    double theta = 0.0;

    RITZ_CHECK_NEW(list, (int64_t)VECTORS * STEPS);
    RITZ_CHECK(begin_vectors(S->M, &r));
    for (int i = 0; i < STEPS; i++) {
        ritz_monitor_step("estimate of the number of modes", i, STEPS);
        RITZ_CHECK(advance_vectors(S, i, &r));
    }
    for (int c = 0; c < VECTORS; c++)
        RITZ_CHECK(append_points(&r, c, &count, list));
    qsort(list, (size_t)count, sizeof *list, compare_points);
    theta = find_theta(count, list, (double)k);
    *out = theta > 0.0 ? S->sigma + 1.0 / theta : HUGE_VAL;
    return RITZ_OK;
}
