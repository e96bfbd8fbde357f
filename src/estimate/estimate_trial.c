/*
 * Ritz pairs of the full matrices in the range of T, anew: a reduced model's
 * own are theirs to rounding, unless some of its columns have lost their mass.
 *
 * Rounding. K x is summed up from |K||x|: so x'Kx is off by some eps times
 * |x|'|K||x|, and so may any other program's be; M x too. Pairs of a dense
 * pencil err by eps times its largest eigenvalue beside. Modes nearer to each
 * other than that may change places: what one of them is, the other may be.
 */
#include "estimate/estimate_parts.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SHIFTS = 16 };
/* Roundings of a sum of terms that cancel: one is due, the rest is room. */
static const double roundings = 4.0;

ritz_status ritz_estimator_open(ritz_estimator *estimator, double sigma)
{
    ritz_status status = RITZ_ERR_SINGULAR;
    const ritz_component *full = estimator->component;
    ritz_sparse A = {0};

    if (estimator->A)
        return RITZ_OK;
    for (int t = 0; t < MOST_SHIFTS && status == RITZ_ERR_SINGULAR; t++) {
        ritz_sparse_free(&A);
        estimator->sigma = t > 0 ? 10.0 * estimator->sigma : sigma;
        RITZ_TRY(
            ritz_sparse_add(1.0, &full->K, -estimator->sigma, &full->M, &A));
        status = ritz_factor_spd(&A, &estimator->A);
    }
done:
    ritz_sparse_free(&A);
    return ritz_context(status, "estimate");
}

/* Ritz pairs in the range of Y, which may be far from orthonormal. */
static ritz_status diagonalise(const ritz_component *full, const ritz_dense *Y,
                               ritz_lehmann *trial)
{
    ritz_status status = RITZ_OK;
    ritz_dense K = {0};
    ritz_dense M = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_sparse_condense(&full->K, Y, &K));
    RITZ_TRY(ritz_sparse_condense(&full->M, Y, &M));
    RITZ_TRY(ritz_eigen_dense(&K, &M, &pairs));
    RITZ_TRY(ritz_dense_mul(Y, &pairs.Phi, &trial->X));
    trial->count = pairs.Phi.ncol;
    trial->theta = pairs.lambda;
    pairs.lambda = NULL;
done:
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_pairs_free(&pairs);
    return status;
}

/* |x|'|K||x| of each column. */
static double magnitude(const ritz_sparse *K, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < K->ncol; j++) {
        double part = 0.0;

        for (int64_t p = K->colptr[j]; p < K->colptr[j + 1]; p++)
            part += fabs(K->val[p] * x[K->rowind[p]]);
        sum += fabs(x[j]) * part;
    }
    return sum;
}

/* R = K X - M X Theta; rounding of theta. */
static ritz_status resist(const ritz_component *full, ritz_lehmann *trial)
{
    ritz_status status = RITZ_OK;
    ritz_dense MX = {0};
    double largest = 0.0;

    if (trial->count > 0)
        largest = trial->theta[trial->count - 1];
    RITZ_NEW(trial->rounding, trial->count);
    RITZ_NEW(trial->inertia, trial->count);
    RITZ_TRY(ritz_sparse_mul(&full->K, &trial->X, &trial->R));
    RITZ_TRY(ritz_sparse_mul(&full->M, &trial->X, &MX));
    for (int64_t j = 0; j < trial->count; j++) {
        double *r = ritz_dense_col(&trial->R, j);
        double *x = ritz_dense_col(&trial->X, j);

        for (int64_t i = 0; i < MX.nrow; i++)
            r[i] -= trial->theta[j] * ritz_dense_col(&MX, j)[i];
        trial->inertia[j] = magnitude(&full->M, x);
        trial->rounding[j] =
            roundings * DBL_EPSILON *
            (magnitude(&full->K, x) +
             (fabs(trial->theta[j]) - trial->sigma) * trial->inertia[j] +
             largest);
    }
done:
    ritz_dense_free(&MX);
    return status;
}

/* Between what each eigenvalue of the reduced pencil can be. */
static void exchange(const ritz_pairs *pairs, ritz_lehmann *trial)
{
    double least = HUGE_VAL;
    double most = -HUGE_VAL;

    for (int64_t j = 0; j < trial->count; j++) {
        most = fmax(most, pairs->lambda[j] + trial->reduced[j]);
        trial->most[j] = most;
    }
    for (int64_t j = trial->count - 1; j >= 0; j--) {
        least = fmin(least, pairs->lambda[j] - trial->reduced[j]);
        trial->least[j] = least;
    }
}

/*
 * Of eigenvalues of the reduced pencil as it is: its entries, which some
 * vectors take the difference of, and the largest eigenvalue.
 */
static ritz_status round_reduced(const ritz_reduced *reduced,
                                 const ritz_pairs *pairs, ritz_lehmann *trial)
{
    ritz_status status = RITZ_OK;
    const ritz_dense Q = ritz_dense_part(&pairs->Phi, 0, trial->count);
    ritz_dense K = {0};
    ritz_dense M = {0};

    RITZ_NEW(trial->reduced, trial->count);
    RITZ_NEW(trial->least, trial->count);
    RITZ_NEW(trial->most, trial->count);
    RITZ_TRY(ritz_dense_terms(&reduced->K, &Q, &K));
    RITZ_TRY(ritz_dense_terms(&reduced->M, &Q, &M));
    for (int64_t j = 0; j < trial->count; j++) {
        trial->inertia[j] += ritz_dense_col(&M, j)[j];
        trial->reduced[j] = roundings * DBL_EPSILON *
                            (ritz_dense_col(&K, j)[j] +
                             fabs(pairs->lambda[j]) * ritz_dense_col(&M, j)[j] +
                             pairs->lambda[pairs->Phi.ncol - 1]);
    }
    exchange(pairs, trial);
done:
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    return status;
}

/* E = A^-1 R and G = R'E. */
static ritz_status answer(ritz_estimator *estimator, ritz_lehmann *trial)
{
    RITZ_CHECK(ritz_dense_copy(&trial->R, &trial->E));
    if (trial->count > 0)
        RITZ_CHECK(ritz_factor_solve(estimator->A, &trial->E));
    RITZ_CHECK(ritz_dense_mul_tn(&trial->R, &trial->E, &trial->G));
    ritz_dense_symmetrise(&trial->G);
    return RITZ_OK;
}

ritz_status ritz_lehmann_new(ritz_estimator *estimator, const ritz_dense *T,
                             const ritz_reduced *reduced,
                             const ritz_pairs *pairs, int64_t count,
                             ritz_lehmann *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense part = ritz_dense_part(&pairs->Phi, 0, count);
    ritz_lehmann trial = {.sigma = estimator->sigma};
    ritz_dense Y = {0};

    RITZ_TRY(ritz_dense_mul(T, &part, &Y));
    RITZ_TRY(diagonalise(estimator->component, &Y, &trial));
    RITZ_FAIL_IF(trial.count != count, RITZ_ERR_SINGULAR,
                 "estimate: columns of the basis depend on each other");
    RITZ_TRY(resist(estimator->component, &trial));
    RITZ_TRY(round_reduced(reduced, pairs, &trial));
    RITZ_TRY(answer(estimator, &trial));
    *out = trial;
    trial = (ritz_lehmann){0};
done:
    ritz_dense_free(&Y);
    ritz_lehmann_free(&trial);
    return status;
}

/*
 * A^-1 M X = (X - E) Theta_t^-1, as R = A X - M X Theta_t. Its columns are of
 * one size without the factor, and span the same.
 */
ritz_status ritz_lehmann_polish(ritz_estimator *estimator,
                                const ritz_lehmann *trial, ritz_lehmann *out)
{
    ritz_status status = RITZ_OK;
    ritz_lehmann polished = {.sigma = estimator->sigma};
    ritz_dense Y = {0};

    RITZ_TRY(ritz_dense_copy(&trial->X, &Y));
    for (int64_t k = 0; k < Y.nrow * Y.ncol; k++)
        Y.val[k] -= trial->E.val[k];
    RITZ_TRY(diagonalise(estimator->component, &Y, &polished));
    RITZ_TRY(resist(estimator->component, &polished));
    RITZ_TRY(answer(estimator, &polished));
    *out = polished;
    polished = (ritz_lehmann){0};
done:
    ritz_dense_free(&Y);
    ritz_lehmann_free(&polished);
    return status;
}

void ritz_lehmann_free(ritz_lehmann *trial)
{
    ritz_dense_free(&trial->X);
    ritz_dense_free(&trial->R);
    ritz_dense_free(&trial->E);
    ritz_dense_free(&trial->G);
    free(trial->theta);
    free(trial->rounding);
    free(trial->inertia);
    free(trial->reduced);
    free(trial->least);
    free(trial->most);
    *trial = (ritz_lehmann){0};
}
