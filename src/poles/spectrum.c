/*
 * Poles of a dense model, from its first-order form. Where D couples no modes
 * each has s^2 + d s + lambda = 0 of its own.
 *
 * With K Phi = M Phi Lambda, Phi'M Phi = I and, where M is singular, N spanning
 * its null space with N'KN = I and Phi'KN = 0, the model in u = Phi p + N a is
 *
 *     p'' + D_pp p' + D_pa a' + L p = 0,    D_ap p' + D_aa a' + a = 0
 *
 * with L = Lambda + i K4_pp. Of N only what D acts on is kept, as the rest of a
 * is 0. In
 *
 *     y = [W p; p'; a],    W = |Lambda|^1/2, or 1 where Lambda is 0,
 *
 *     y' = [  0         W                         0            ] y
 *          [ -L W^-1   -(D_pp - D_pa F)   D_pa D_aa^-1         ]
 *          [  0        -F                 -D_aa^-1             ]
 *
 * F = D_aa^-1 D_ap. Scaled by W, slow poles are not lost beside fast ones.
 * Rigid motions that nothing damps are left out: a double pole at 0 is
 * defective, and rounding would scatter it [TisseurMeerbergen2001].
 */
#include <ritz/poles.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"
#include "poles/poles.h"

#include <ritz/matrix.h>

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct state_form {
    int64_t m, k;     /* modes p; massless coordinates a */
    int64_t num_free; /* rigid motions left out */
    double *lambda;   /* m, 0 where rigid */
    ritz_dense X;     /* n x (m + k), columns of Phi and N */
    ritz_dense D;     /* (m + k) x (m + k) */
    ritz_dense K4;    /* m x m, or {0} */
    bool diagonal;    /* D couples nothing, and there is neither a nor K4 */
} state_form;

static void state_form_free(state_form *state)
{
    free(state->lambda);
    ritz_dense_free(&state->X);
    ritz_dense_free(&state->D);
    ritz_dense_free(&state->K4);
}

/* W of mode j. */
static double weight_of(const state_form *state, int64_t j)
{
    return ritz_modal_scale(state->lambda[j]);
}

/* G = D_aa^-1 [D_ap I], k x (m + k). */
static ritz_status solve_massless(const state_form *s, ritz_dense *G)
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

/* The matrix of y', 2m + k square, without what K4 does. */
static ritz_status assemble_matrix(const state_form *s, ritz_dense *out)
{
    int64_t m = s->m, k = s->k;
    RITZ_OWN(ritz_dense) A = {0}, G = {0};

    RITZ_CHECK(ritz_dense_new(2 * m + k, 2 * m + k, &A));
    RITZ_CHECK(solve_massless(s, &G));
    for (int64_t j = 0; j < m; j++) {
        double w = weight_of(s, j);

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

ritz_status ritz_project_above(const ritz_dense *A, const ritz_dense *B,
                               double floor, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) most = {0};

    RITZ_CHECK(ritz_dense_project(A, B, out));
    RITZ_CHECK(ritz_dense_terms(A, B, &most));
    for (int64_t k = 0; k < out->nrow * out->ncol; k++)
        if (fabs(out->val[k]) <= RITZ_SUM_ROUNDING * most.val[k] + floor)
            out->val[k] = 0.0;
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
    RITZ_OWN(ritz_dense) V = {0};
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
    return ritz_dense_times(&V, N);
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

/*
 * Rigid motion has no structural damping, except rounding of K4, which would
 * put two poles of s^2 = -i eps |K4| near 0, one of them right of the axis.
 */
static void clear_rigid_loss(const ritz_pairs *pairs, ritz_dense *K4)
{
    const double floor = RITZ_SUM_ROUNDING * ritz_dense_max(K4);

    for (int64_t j = 0; j < pairs->Phi.ncol; j++)
        for (int64_t i = 0; i < K4->nrow && pairs->lambda[j] == 0.0; i++) {
            if (fabs(ritz_dense_col(K4, j)[i]) <= floor)
                ritz_dense_col(K4, j)[i] = 0.0;
            if (fabs(ritz_dense_col(K4, i)[j]) <= floor)
                ritz_dense_col(K4, i)[j] = 0.0;
        }
}

/* Put into N what D acts on, into X all that is kept, and D of that. */
static ritz_status take_massless(const ritz_second_order *model,
                                 const ritz_damping *damping,
                                 const ritz_pairs *pairs, state_form *s)
{
    int64_t m = pairs->Phi.ncol;
    RITZ_OWN(ritz_dense) N = {0}, all = {0};

    if (m < pairs->Phi.nrow)
        RITZ_CHECK(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    for (int pass = 0; pass < 2; pass++) {
        ritz_dense_free(&s->X);
        ritz_dense_free(&s->D);
        RITZ_CHECK(ritz_dense_beside(&pairs->Phi, &N, &s->X));
        if (is_present(model->D))
            RITZ_CHECK(ritz_project_above(model->D, &s->X, 0.0, &s->D));
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
    RITZ_MOVE(all, s->D);
    RITZ_CHECK(ritz_dense_block(&all, 0, m + s->k, 0, m + s->k, &s->D));
    if (is_present(model->K4)) {
        RITZ_CHECK(ritz_project_above(model->K4, &s->X, 0.0, &s->K4));
        clear_rigid_loss(pairs, &s->K4);
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
static bool is_free(const state_form *s, int64_t j)
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

/* A := its rows and columns at[0], at[1], ... */
static ritz_status keep_principal(int64_t count, const int64_t *at,
                                  ritz_dense *A)
{
    RITZ_OWN(ritz_dense) kept = {0};

    RITZ_CHECK(ritz_dense_principal(A, count, at, &kept));
    ritz_dense_replace(A, &kept);
    return RITZ_OK;
}

/* Leave out rigid motions that nothing damps. */
static ritz_status drop_free(state_form *s)
{
    int64_t all = s->m + s->k, count = 0, modes = 0;
    RITZ_OWN_ARRAY int64_t *kept = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK_NEW(kept, all);
    for (int64_t j = 0; j < all; j++) {
        if (j < s->m && is_free(s, j))
            continue;
        if (j < s->m)
            s->lambda[modes++] = s->lambda[j];
        kept[count++] = j;
    }
    RITZ_CHECK(ritz_dense_pick(&s->X, count, kept, &X));
    ritz_dense_replace(&s->X, &X);
    RITZ_CHECK(keep_principal(count, kept, &s->D));
    if (s->K4.val)
        RITZ_CHECK(keep_principal(modes, kept, &s->K4));
    s->num_free = all - count;
    s->m = modes;
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

static ritz_status state_form_new(const ritz_second_order *model,
                                  const ritz_damping *damping, state_form *out)
{
    RITZ_OWN(state_form) s = {0};
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

/* Eigenvalues of y' = A y, and vectors y as columns. */
typedef struct found {
    int64_t count, size;
    double _Complex *s; /* count */
    double _Complex *y; /* size x count */
    ritz_dense A;       /* without K4 */
    double norm;        /* of A, Frobenius */
} found;

static void found_free(found *f)
{
    RITZ_FREE(f->s, f->y);
    ritz_dense_free(&f->A);
}

static ritz_status found_new(const state_form *state, found *out)
{
    out->count = out->size = 2 * state->m + state->k;
    RITZ_CHECK_NEW(out->s, out->size);
    RITZ_CHECK_NEW(out->y, out->size * out->size);
    RITZ_CHECK(assemble_matrix(state, &out->A));
    for (int64_t i = 0; i < out->size * out->size; i++)
        out->norm = hypot(out->norm, out->A.val[i]);
    return RITZ_OK;
}

double ritz_spectrum_ratio(double _Complex s)
{
    return creal(s) == 0.0 ? 0.0 : -creal(s) / cabs(s); /* never -0 */
}

double _Complex ritz_nearest_pole(int64_t count, const double _Complex *pole,
                                  bool above, double _Complex s)
{
    double _Complex best = ritz_complex(nan(""), 0.0);
    double least = HUGE_VAL;

    for (int64_t k = 0; k < count; k++)
        if ((!above || cimag(pole[k]) > 0.0) && cabs(pole[k] - s) < least) {
            least = cabs(pole[k] - s);
            best = pole[k];
        }
    return best;
}

/* Each mode by itself: p = 1, so that y = [W; s]. */
static void solve_diagonal(const state_form *state, found *out)
{
    int64_t m = state->m;

    for (int64_t j = 0; j < m; j++) {
        ritz_poles_roots(state->lambda[j], ritz_dense_col(&state->D, j)[j],
                         out->s + 2 * j);
        for (int64_t t = 2 * j; t < 2 * j + 2; t++) {
            out->y[j + t * 2 * m] = weight_of(state, j);
            out->y[m + j + t * 2 * m] = out->s[t];
        }
    }
}

static ritz_status solve_real(found *out)
{
    int64_t size = out->size;
    int n = (int)size;
    RITZ_OWN(ritz_dense) A = {0}, V = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL;
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(&out->A, &A));
    RITZ_CHECK(ritz_dense_new(size, size, &V));
    RITZ_CHECK_NEW(re, size);
    RITZ_CHECK_NEW(im, size);
    if (n > 0)
        info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, A.val, n, re, im,
                             NULL, 1, V.val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "damped modes were not found");
    for (int64_t j = 0; j < size; j++) {
        bool second = im[j] < 0.0; /* its vector is that of the one before */
        const double *x = ritz_dense_col(&V, second ? j - 1 : j);

        out->s[j] = ritz_complex(re[j], im[j]);
        for (int64_t i = 0; i < size; i++)
            out->y[i + j * size] =
                im[j] == 0.0
                    ? x[i]
                    : ritz_complex(x[i], second ? -x[i + n] : x[i + n]);
    }
    return RITZ_OK;
}

/* Poles with K4: those with Im s < 0 belong to the conjugate problem and are
   dropped later. */
static ritz_status solve_complex(const state_form *state, found *out)
{
    int64_t size = out->size, m = state->m;
    RITZ_OWN_ARRAY double _Complex *Z = NULL;
    int info = 0;

    RITZ_CHECK_NEW(Z, size * size);
    for (int64_t i = 0; i < size * size; i++)
        Z[i] = out->A.val[i];
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            Z[m + i + j * size] -= ritz_complex(
                0.0, ritz_dense_col(&state->K4, j)[i] / weight_of(state, j));
    if (size > 0)
        info = LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'V', (int)size, Z,
                             (int)size, out->s, NULL, 1, out->y, (int)size);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "damped modes were not found");
    return RITZ_OK;
}

typedef struct listed_pole {
    double size, imaginary;
    int64_t index;
} listed_pole;

static int compare_poles(const void *left, const void *right)
{
    const listed_pole *a = left;
    const listed_pole *b = right;

    if (a->size != b->size)
        return a->size > b->size ? 1 : -1;
    if (a->imaginary != b->imaginary)
        return a->imaginary > b->imaginary ? 1 : -1;
    return (a->index > b->index) - (a->index < b->index);
}

/*
 * Magnitude below which a pole is a rounded 0, where rigid motion is kept
 * because D acts on it: a few eps of the matrix.
 */
static double find_zero(const state_form *state, const found *f)
{
    bool rigid = false;

    for (int64_t j = 0; j < state->m; j++)
        rigid = rigid || state->lambda[j] == 0.0;
    return rigid && !state->diagonal ? 10.0 * DBL_EPSILON * f->norm : 0.0;
}

/* Which are listed, in order; those up to `zero` are counted. */
static int64_t choose_listed(const found *f, bool structural, double zero,
                             listed_pole *order, int64_t *zeros)
{
    int64_t count = 0;

    for (int64_t j = 0; j < f->count; j++) {
        double im = cimag(f->s[j]);

        if (cabs(f->s[j]) <= zero)
            (*zeros)++;
        else if (im > 0.0 || (im == 0.0 && !structural))
            order[count++] = (listed_pole){cabs(f->s[j]), im, j};
    }
    qsort(order, (size_t)count, sizeof *order, compare_poles);
    return count;
}

/* x = X [p; a] of y = [W p; p'; a], with |x| = 1. */
static void put_shape(const state_form *state, const double _Complex *y,
                      double *re, double *im)
{
    int64_t n = state->X.nrow;
    double size = 0.0;

    for (int64_t j = 0; j < state->m + state->k; j++) {
        const double *x = ritz_dense_col(&state->X, j);
        double _Complex q =
            j < state->m ? y[j] / weight_of(state, j) : y[state->m + j];

        for (int64_t i = 0; i < n; i++) {
            re[i] += x[i] * creal(q);
            im[i] += x[i] * cimag(q);
        }
    }
    for (int64_t i = 0; i < n; i++)
        size = hypot(size, hypot(re[i], im[i]));
    for (int64_t i = 0; i < n && size > 0.0; i++) {
        re[i] /= size;
        im[i] /= size;
    }
}

/* Columns y of the poles that are listed, real or imaginary parts. */
static ritz_status pick_columns(const found *f, int64_t count,
                                const listed_pole *order,
                                double (*part)(double _Complex),
                                ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(f->size, count, out));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < f->size; i++)
            ritz_dense_col(out, j)[i] =
                part(f->y[i + order[j].index * f->size]);
    return RITZ_OK;
}

/* Ay += (imaginary part of A, which K4 makes) y: rows m .. 2m - 1. */
static void add_structural(const state_form *state, const ritz_dense *y,
                           double sign, ritz_dense *Ay)
{
    int64_t m = state->m;

    for (int64_t c = 0; state->K4.val && c < y->ncol; c++)
        for (int64_t j = 0; j < m; j++)
            for (int64_t i = 0; i < m; i++)
                ritz_dense_col(Ay, c)[m + i] -=
                    sign * ritz_dense_col(&state->K4, j)[i] /
                    weight_of(state, j) * ritz_dense_col(y, c)[j];
}

/* |A y - s y| / ((|A| + |s|) |y|) of each, |A| in the Frobenius norm. */
static ritz_status find_residuals(const state_form *state, const found *f,
                                  const listed_pole *order, ritz_spectrum *out)
{
    RITZ_OWN(ritz_dense) re = {0}, im = {0}, Are = {0}, Aim = {0};

    RITZ_CHECK(pick_columns(f, out->count, order, creal, &re));
    RITZ_CHECK(pick_columns(f, out->count, order, cimag, &im));
    RITZ_CHECK(ritz_dense_mul(&f->A, &re, &Are));
    RITZ_CHECK(ritz_dense_mul(&f->A, &im, &Aim));
    add_structural(state, &im, -1.0, &Are);
    add_structural(state, &re, 1.0, &Aim);
    for (int64_t j = 0; j < out->count; j++) {
        double _Complex s = out->s[j];
        double gap = 0.0, y = 0.0;

        for (int64_t i = 0; i < f->size; i++) {
            double _Complex x = f->y[i + order[j].index * f->size];

            gap = hypot(gap, cabs(ritz_complex(ritz_dense_col(&Are, j)[i],
                                               ritz_dense_col(&Aim, j)[i]) -
                                  s * x));
            y = hypot(y, cabs(x));
        }
        out->residual[j] = gap / ((f->norm + cabs(s)) * y);
    }
    return RITZ_OK;
}

static ritz_status list_poles(const state_form *state, const found *f,
                              ritz_spectrum *out)
{
    int64_t n = state->X.nrow;
    RITZ_OWN_ARRAY listed_pole *order = NULL;

    RITZ_CHECK_NEW(order, f->count);
    out->num_zero = 2 * state->num_free;
    out->count = choose_listed(f, state->K4.val, find_zero(state, f), order,
                               &out->num_zero);
    RITZ_CHECK_NEW(out->s, out->count);
    RITZ_CHECK_NEW(out->residual, out->count);
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->re));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->im));
    for (int64_t j = 0; j < out->count; j++) {
        out->s[j] = f->s[order[j].index];
        put_shape(state, f->y + order[j].index * f->size,
                  ritz_dense_col(&out->re, j), ritz_dense_col(&out->im, j));
    }
    return find_residuals(state, f, order, out);
}

ritz_status ritz_spectrum_dense(const ritz_second_order *model,
                                const ritz_damping *damping, ritz_spectrum *out)
{
    RITZ_OWN(ritz_spectrum) spectrum = {0};
    RITZ_OWN(state_form) state = {0};
    RITZ_OWN(found) f = {0};

    RITZ_CHECK(state_form_new(model, damping, &state));
    RITZ_CHECK(found_new(&state, &f));
    if (state.diagonal)
        solve_diagonal(&state, &f);
    else if (state.K4.val)
        RITZ_CHECK(solve_complex(&state, &f));
    else
        RITZ_CHECK(solve_real(&f));
    RITZ_CHECK(list_poles(&state, &f, &spectrum));
    (void)snprintf(spectrum.engine, sizeof spectrum.engine, "dense LAPACK");
    RITZ_MOVE(*out, spectrum);
    return RITZ_OK;
}

void ritz_spectrum_free(ritz_spectrum *spectrum)
{
    RITZ_FREE(spectrum->s, spectrum->residual);
    ritz_dense_free(&spectrum->re);
    ritz_dense_free(&spectrum->im);
    *spectrum = (ritz_spectrum){0};
}
