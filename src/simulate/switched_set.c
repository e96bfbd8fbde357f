/*
 * The model of one set of vectors of a library. U spans the set with
 * orthonormal columns, and X are the modes of U'K U. If the library consists of
 * orthonormal modes, U X picks some of its coordinates and is not stored.
 */
#include "simulate/switched.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <string.h>

void ritz_set_model_free(ritz_set_model *set)
{
    ritz_march_free(&set->march);
    ritz_motion_free(&set->motion);
    ritz_dense_free(&set->UX);
    RITZ_FREE(set->at, set->damped_hold);
    *set = (ritz_set_model){0};
}

/* out = X'U'y, for the part of y in the span of the library. */
static void restrict_to_set(const ritz_set_model *set, const double *y,
                            double *out)
{
    const int64_t r = set->motion.n;

    for (int64_t i = 0; i < r; i++)
        out[i] = set->at ? y[set->at[i]]
                         : ritz_motion_dot(set->UX.nrow,
                                           ritz_dense_col(&set->UX, i), y);
}

void ritz_set_model_expand(const ritz_set_model *set, const double *x_0,
                           const double *p, int64_t n, double *x)
{
    if (set->at) {
        for (int64_t i = 0; i < set->motion.n; i++)
            x[set->at[i]] = p[i]; /* x_0 is 0 here; other rows are held */
        return;
    }
    memcpy(x, x_0, (size_t)n * sizeof *x);
    ritz_motion_gemv(&set->UX, 1.0, p, x);
}

/* Whether a matrix is diagonal. */
static bool is_diagonal(const ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            if (i != j && ritz_dense_col(A, j)[i] != 0.0)
                return false;
    return true;
}

/* If the library consists of modes, those of the set are among them: fill `at`,
   Lambda and D by their numbers. */
static ritz_status take_modes(const ritz_library *library,
                              const double *present, ritz_set_model *set,
                              bool *taken)
{
    int64_t r = 0;
    RITZ_OWN(ritz_dense) K = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;

    *taken = false;
    if (library->redundant)
        return RITZ_OK;
    RITZ_CHECK_NEW(at, library->span);
    for (int64_t k = 0; k < library->num_vectors; k++)
        if (present[k] != 0.0)
            at[r++] = k;
    RITZ_CHECK(ritz_dense_principal(&library->K, r, at, &K));
    if (!is_diagonal(&K))
        return RITZ_OK;
    set->motion.n = r;
    RITZ_CHECK_NEW(set->motion.lambda, r);
    for (int64_t k = 0; k < r; k++)
        set->motion.lambda[k] = ritz_dense_col(&K, k)[k];
    RITZ_CHECK(ritz_dense_principal(&library->D, r, at, &set->motion.D));
    RITZ_MOVE(set->at, at);
    *taken = true;
    return RITZ_OK;
}

/* Modes of U'K U. */
static ritz_status find_modes(const ritz_library *library,
                              const double *present, ritz_set_model *set)
{
    const int64_t n = library->span;
    RITZ_OWN(ritz_dense) U = {0}, part = {0}, K = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_library_columns(library, present, &U));
    RITZ_CHECK(ritz_dense_block(&library->K, 0, n, 0, n, &part));
    RITZ_CHECK(ritz_dense_congruence(&part, &U, &K));
    RITZ_CHECK(ritz_general_symmetric(&K, &pairs));
    RITZ_CHECK(ritz_dense_mul(&U, &pairs.Phi, &set->UX));
    set->motion.n = U.ncol;
    RITZ_MOVE(set->motion.lambda, pairs.lambda);
    ritz_dense_free(&part);
    RITZ_CHECK(ritz_dense_block(&library->D, 0, n, 0, n, &part));
    return ritz_dense_project(&part, &set->UX, &set->motion.D);
}

/* [X'U'B, -X'U'(K q_0 + D w_0)], and X'U'D w_0. */
ritz_status ritz_set_model_load(const ritz_library *library, const double *q_0,
                                const double *w_0, ritz_set_model *set)
{
    const int64_t m = library->B.ncol, r = set->motion.n;
    RITZ_OWN_ARRAY double *held = NULL;

    RITZ_CHECK_NEW(held, library->n);
    RITZ_CHECK_NEW(set->damped_hold, r);
    RITZ_CHECK(ritz_dense_new(r, m + 1, &set->motion.B));
    for (int64_t j = 0; j < m; j++)
        restrict_to_set(set, ritz_dense_col(&library->B, j),
                        ritz_dense_col(&set->motion.B, j));
    ritz_motion_gemv(&library->D, 1.0, w_0, held);
    restrict_to_set(set, held, set->damped_hold);
    ritz_motion_gemv(&library->K, 1.0, q_0, held);
    restrict_to_set(set, held, ritz_dense_col(&set->motion.B, m));
    for (int64_t i = 0; i < r; i++) {
        double *load = &ritz_dense_col(&set->motion.B, m)[i];

        *load = -*load - set->damped_hold[i];
    }
    return RITZ_OK;
}

ritz_status ritz_set_model_new(const ritz_library *library,
                               const double *present, ritz_set_model *out)
{
    bool taken = false;

    RITZ_CHECK(take_modes(library, present, out, &taken));
    return taken ? RITZ_OK : find_modes(library, present, out);
}

void ritz_set_model_hold(const ritz_set_model *set, int64_t n, const double *y,
                         double *y_0, double *p)
{
    memcpy(y_0, y, (size_t)n * sizeof *y);
    restrict_to_set(set, y, p);
    if (!set->at) {
        for (int64_t i = 0; i < set->motion.n; i++)
            for (int64_t k = 0; k < set->UX.nrow; k++)
                y_0[k] -= ritz_dense_col(&set->UX, i)[k] * p[i];
        return;
    }
    for (int64_t i = 0; i < set->motion.n; i++)
        y_0[set->at[i]] = 0.0;
}
