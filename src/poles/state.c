#include "poles/state.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"
#include "poles/massless.h"

#include <ritz/matrix.h>

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

double ritz_state_weight(const ritz_state *state, int64_t j)
{
    return ritz_modal_scale(state->lambda[j]);
}

/* G = D_aa^-1 [D_ap I], k x (m + k). */
static ritz_status solve_massless(const ritz_state *s, ritz_dense *G)
{
    int64_t m = s->m, k = s->k;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    int info = 0;

    RITZ_CHECK_NEW(pivot, k);
    RITZ_CHECK(ritz_dense_new(k, k, &A));
    RITZ_CHECK(ritz_dense_new(k, m + k, G));
    for (int64_t i = 0; i < k; i++) {
        for (int64_t j = 0; j < k; j++)
            ritz_dense_col(&A, j)[i] = ritz_dense_col(&s->D, m + j)[m + i];
        for (int64_t j = 0; j < m; j++)
            ritz_dense_col(G, j)[i] = ritz_dense_col(&s->D, j)[m + i];
        ritz_dense_col(G, m + i)[i] = 1.0;
    }
    if (k > 0)
        info = LAPACKE_dgesv(LAPACK_COL_MAJOR, (int)k, (int)(m + k), A.val,
                             (int)k, pivot, G->val, (int)k);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "damping of the motions without mass is singular");
    return RITZ_OK;
}

ritz_status ritz_state_matrix(const ritz_state *s, ritz_dense *out)
{
    int64_t m = s->m, k = s->k;
    RITZ_OWN(ritz_dense) A = {0}, G = {0};

    RITZ_CHECK(ritz_dense_new(2 * m + k, 2 * m + k, &A));
    RITZ_CHECK(solve_massless(s, &G));
    for (int64_t j = 0; j < m; j++) {
        double w = ritz_state_weight(s, j);

        ritz_dense_col(&A, m + j)[j] = w;
        ritz_dense_col(&A, j)[m + j] = -s->lambda[j] / w;
    }
    for (int64_t j = 0; j < m + k; j++)
        for (int64_t i = 0; i < m + k; i++) {
            double *a = &ritz_dense_col(&A, m + j)[m + i];

            if (i >= m) {
                *a = -ritz_dense_col(&G, j)[i - m];
                continue;
            }
            *a = j < m ? -ritz_dense_col(&s->D, j)[i] : 0.0;
            for (int64_t t = 0; t < k; t++) /* D_pa G */
                *a +=
                    ritz_dense_col(&s->D, m + t)[i] * ritz_dense_col(&G, j)[t];
        }
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

/* X'AX whose entries are 0 where they are rounding alone. */
static ritz_status project_above_rounding(const ritz_dense *A,
                                          const ritz_dense *X, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) most = {0};

    RITZ_CHECK(ritz_dense_project(A, X, out));
    RITZ_CHECK(ritz_dense_terms(A, X, &most));
    for (int64_t i = 0; i < out->nrow * out->ncol; i++)
        if (fabs(out->val[i]) <= RITZ_SUM_ROUNDING * most.val[i])
            out->val[i] = 0.0;
    return RITZ_OK;
}

static bool is_present(const ritz_dense *A)
{
    return A && A->val;
}

/*
 * The finite modes as X; lambda, 0 where rigid. Of a model with negative
 * eigenvalues, as columns joined by forces bring with them, rigid motions come
 * behind those, and are told by what is left; num_rigid counts both.
 */
static ritz_status take_modes(const ritz_second_order *model, ritz_pairs *pairs)
{
    double largest = 0.0;
    int64_t m = 0, negative = 0;

    RITZ_CHECK(ritz_eigen_dense(model->K, model->M, pairs));
    m = pairs->Phi.ncol;
    for (int64_t j = 0; j < m; j++)
        largest = fmax(largest, fabs(pairs->lambda[j]));
    while (negative < m &&
           pairs->lambda[negative] < -RITZ_RIGID_DIGITS * largest)
        negative++;
    if (negative > 0)
        pairs->num_rigid =
            negative +
            ritz_eigen_rigid(m - negative, pairs->lambda + negative, largest);
    for (int64_t j = negative; j < pairs->num_rigid; j++)
        pairs->lambda[j] = 0.0;
    return RITZ_OK;
}

/* D += stated damping. In the coordinates N, where M is 0 and K is 1, a M +
   b K is b. */
static void add_given(const ritz_damping *damping, const ritz_pairs *pairs,
                      ritz_dense *D)
{
    bool rayleigh = damping && ritz_damping_is_rayleigh(damping);
    int64_t m = pairs->Phi.ncol;

    for (int64_t j = 0; j < D->ncol; j++)
        if (j < m)
            ritz_dense_col(D, j)[j] += ritz_modal_rate(
                damping, j - pairs->num_rigid, pairs->lambda[j]);
        else if (rayleigh)
            ritz_dense_col(D, j)[j] += damping->b;
}

/*
 * N turned so that the symmetric part of its D is diagonal and descends; how
 * many columns it acts on.
 *
 * @param[in] floor  what rounding of N makes of N'DN at most
 */
static ritz_status turn_massless(const ritz_dense *D, int64_t m, double floor,
                                 ritz_dense *N, int64_t *count)
{
    int64_t k = N->ncol;
    RITZ_OWN(ritz_dense) V = {0}, turned = {0};
    RITZ_OWN_ARRAY double *delta = NULL;
    double largest = 0.0;
    int info = 0;

    RITZ_CHECK_NEW(delta, k);
    RITZ_CHECK(ritz_dense_new(k, k, &V));
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i < k; i++) /* negative: descending */
            ritz_dense_col(&V, j)[i] = -0.5 * (ritz_dense_col(D, m + j)[m + i] +
                                               ritz_dense_col(D, m + i)[m + j]);
    info =
        LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)k, V.val, (int)k, delta);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "damping of the motions without mass was not found");
    for (int64_t j = 0; j < k; j++)
        largest = fmax(largest, fabs(delta[j]));
    *count = 0;
    for (int64_t j = 0; j < k; j++)
        *count +=
            -delta[j] > fmax(floor, (double)k * RITZ_SUM_ROUNDING * largest);
    RITZ_CHECK(ritz_dense_mul(N, &V, &turned));
    ritz_dense_free(N);
    RITZ_MOVE(*N, turned);
    return RITZ_OK;
}

/* The rest of N, columns `from` on of D, must be left alone. */
static ritz_status check_rest(const ritz_dense *D, int64_t from)
{
    double largest = ritz_dense_max(D);

    for (int64_t j = from; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++)
            RITZ_REFUSE_IF(fabs(ritz_dense_col(D, j)[i]) >
                                   RITZ_MASSLESS_COUPLED * largest ||
                               fabs(ritz_dense_col(D, i)[j]) >
                                   RITZ_MASSLESS_COUPLED * largest,
                           RITZ_ERR_ARGUMENT,
                           "the damping matrix couples a motion without mass "
                           "that it does not damp: are its gyroscopic terms at "
                           "massless dofs?");
    return RITZ_OK;
}

/* The first `kept` rows and columns. */
static ritz_status keep_leading(ritz_dense *A, int64_t kept)
{
    ritz_dense part = {0};

    RITZ_CHECK(ritz_dense_new(kept, kept, &part));
    for (int64_t j = 0; j < kept; j++)
        for (int64_t i = 0; i < kept; i++)
            ritz_dense_col(&part, j)[i] = ritz_dense_col(A, j)[i];
    ritz_dense_free(A);
    *A = part;
    return RITZ_OK;
}

/* Put into N what D acts on, into X all that is kept, and D of that. */
static ritz_status take_massless(const ritz_second_order *model,
                                 const ritz_damping *damping,
                                 const ritz_pairs *pairs, ritz_state *s)
{
    int64_t m = pairs->Phi.ncol;
    RITZ_OWN(ritz_dense) N = {0};

    if (m < pairs->Phi.nrow)
        RITZ_CHECK(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    for (int pass = 0; pass < 2; pass++) {
        ritz_dense_free(&s->X);
        ritz_dense_free(&s->D);
        RITZ_CHECK(ritz_dense_beside(&pairs->Phi, &N, &s->X));
        if (is_present(model->D))
            RITZ_CHECK(project_above_rounding(model->D, &s->X, &s->D));
        else
            RITZ_CHECK(ritz_dense_new(s->X.ncol, s->X.ncol, &s->D));
        add_given(damping, pairs, &s->D);
        if (N.ncol == 0)
            break;
        if (pass == 0)
            RITZ_CHECK(turn_massless(&s->D, m,
                                     is_present(model->D)
                                         ? RITZ_MASSLESS_VECTOR *
                                               ritz_dense_max(model->D) *
                                               pow(ritz_dense_max(&N), 2.0)
                                         : 0.0,
                                     &N, &s->k));
    }
    RITZ_CHECK(check_rest(&s->D, m + s->k));
    RITZ_CHECK(keep_leading(&s->D, m + s->k));
    if (is_present(model->K4)) {
        RITZ_CHECK(project_above_rounding(model->K4, &s->X, &s->K4));
        RITZ_REFUSE_IF(
            N.ncol > 0 && ritz_dense_max(&s->K4) > 0.0, RITZ_ERR_ARGUMENT,
            "there are motions without mass beside structural damping: "
            "give it as a modal ratio");
        if (N.ncol > 0)
            ritz_dense_free(&s->K4);
    }
    return RITZ_OK;
}

/* Whether D and K4 leave coordinate j alone. */
static bool is_free(const ritz_state *s, int64_t j)
{
    if (s->lambda[j] != 0.0)
        return false;
    for (int64_t i = 0; i < s->D.ncol; i++)
        if (ritz_dense_col(&s->D, j)[i] != 0.0 ||
            ritz_dense_col(&s->D, i)[j] != 0.0)
            return false;
    for (int64_t i = 0; i < s->K4.ncol; i++)
        if (ritz_dense_col(&s->K4, j)[i] != 0.0)
            return false;
    return true;
}

/* A := A without the rows and columns that are not kept. */
static void keep_square(int64_t n, const bool *kept, ritz_dense *A)
{
    int64_t at = 0;
    int64_t count = 0;

    for (int64_t j = 0; j < n; j++)
        count += kept[j];
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            if (kept[i] && kept[j])
                A->val[at++] = A->val[i + j * n];
    A->nrow = A->ncol = count;
}

/* Leave out rigid motions that nothing damps. */
static ritz_status drop_free(ritz_state *s)
{
    int64_t all = s->m + s->k;
    int64_t n = s->X.nrow;
    int64_t at = 0;
    RITZ_OWN_ARRAY bool *kept = NULL;

    RITZ_CHECK_NEW(kept, all);
    for (int64_t j = 0; j < all; j++)
        kept[j] = j >= s->m || !is_free(s, j);
    for (int64_t j = 0; j < all; j++) {
        if (!kept[j])
            continue;
        if (j < s->m)
            s->lambda[at] = s->lambda[j];
        memmove(s->X.val + at * n, s->X.val + j * n,
                (size_t)n * sizeof *s->X.val);
        at++;
    }
    keep_square(all, kept, &s->D);
    if (s->K4.val)
        keep_square(s->m, kept, &s->K4);
    s->num_free = all - at;
    s->m -= s->num_free;
    s->X.ncol = at;
    return RITZ_OK;
}

static bool is_diagonal(const ritz_dense *D)
{
    for (int64_t j = 0; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++)
            if (i != j && ritz_dense_col(D, j)[i] != 0.0)
                return false;
    return true;
}

ritz_status ritz_state_new(const ritz_second_order *model,
                           const ritz_damping *damping, ritz_state *out)
{
    RITZ_OWN(ritz_state) s = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(take_modes(model, &pairs));
    s.m = pairs.Phi.ncol;
    RITZ_CHECK(take_massless(model, damping, &pairs, &s));
    s.lambda = pairs.lambda;
    pairs.lambda = NULL;
    RITZ_CHECK(drop_free(&s));
    s.diagonal = s.k == 0 && !s.K4.val && is_diagonal(&s.D);
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

void ritz_state_free(ritz_state *state)
{
    free(state->lambda);
    ritz_dense_free(&state->X);
    ritz_dense_free(&state->D);
    ritz_dense_free(&state->K4);
    *state = (ritz_state){0};
}
