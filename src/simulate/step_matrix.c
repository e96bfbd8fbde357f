/*
 * R, what is left of a matrix without its blocks, is reduced by a random sketch
 * [Halko2011]: the span of R X, X random with l columns, holds R but for its
 * singular values beyond l. If what it does not hold is more than rounding, R
 * is not of low rank. All norms are those of the balanced matrices, in which
 * the exponential errs by eps |A| h.
 */
#include "simulate/step_matrix.h"

#include "base/tolerances.h"
#include "linear/general.h"
#include "simulate/motion.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

void ritz_step_matrix_free(ritz_step_matrix *A)
{
    ritz_dense_free(&A->U);
    ritz_dense_free(&A->V);
    ritz_dense_free(&A->full);
    RITZ_FREE(A->own, A->weight, A->signal);
    *A = (ritz_step_matrix){0};
}

/* Scales of the balanced matrices, and what is rounding in them. */
typedef struct scales {
    const double *d;
    double cut; /* relative */
} scales;

/* E := D^-1 E D, or W := D W D. */
static void balance(bool form, const double *d, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *= (form ? d[i] : 1.0 / d[i]) * d[j];
}

/* Rows of X times d, or divided by it. */
static void scale_rows(bool divide, const double *d, ritz_dense *X)
{
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(X, j)[i] *= divide ? 1.0 / d[i] : d[i];
}

static void remove_blocks(const ritz_step_matrix *c, ritz_dense *A)
{
    const int64_t n = c->pairs;

    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(A, j)[j] -= c->own[j][0];
        ritz_dense_col(A, j)[n + j] -= c->own[j][1];
        ritz_dense_col(A, n + j)[j] -= c->own[j][2];
        ritz_dense_col(A, n + j)[n + j] -= c->own[j][3];
    }
}

/* Columns of a sketch: more than those with which a product would pay. */
static int64_t sketch_width(const ritz_dense *R)
{
    enum { SPARE = 8, PART = 3 };
    const int64_t least = R->nrow < R->ncol ? R->nrow : R->ncol;

    return least < SPARE + least / PART ? least : SPARE + least / PART;
}

/* Orthonormal Q whose span holds R but for rounding; {0}: there is none of so
   few columns. */
static ritz_status find_span(const ritz_dense *R, double floor, ritz_dense *Q)
{
    uint64_t seed = 2011;
    RITZ_OWN(ritz_dense) X = {0}, Y = {0}, span = {0}, part = {0}, held = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    RITZ_CHECK(ritz_dense_new(R->ncol, sketch_width(R), &X));
    for (int64_t k = 0; k < X.nrow * X.ncol; k++)
        X.val[k] = ritz_general_noise(&seed);
    RITZ_CHECK(ritz_dense_mul(R, &X, &Y));
    RITZ_CHECK(ritz_general_svd(&Y, &span, &s, NULL));
    RITZ_CHECK(ritz_dense_mul_tn(&span, R, &part));
    RITZ_CHECK(ritz_dense_mul(&span, &part, &held));
    ritz_dense_add(-1.0, R, &held);
    if (ritz_general_size(&held) <= floor * sqrt((double)R->ncol))
        RITZ_MOVE(*Q, span);
    return RITZ_OK;
}

/* Columns k of X whose |s_k| is above the floor. */
static ritz_status take_columns(const ritz_dense *X, const double *s,
                                double floor, double *kept, ritz_dense *out)
{
    int64_t count = 0;
    RITZ_OWN_ARRAY int64_t *at = NULL;

    RITZ_CHECK_NEW(at, X->ncol);
    for (int64_t k = 0; k < X->ncol; k++)
        if (fabs(s[k]) > floor) {
            kept[count] = s[k];
            at[count++] = k;
        }
    return ritz_dense_pick(X, count, at, out);
}

/* R = U V' in the span of Q; V has orthonormal columns, and U = R V. */
static ritz_status split_map(const ritz_dense *R, const ritz_dense *Q,
                             double floor, ritz_step_matrix *c)
{
    RITZ_OWN(ritz_dense) part = {0}, right = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    RITZ_CHECK(ritz_dense_mul_tn(R, Q, &part));
    RITZ_CHECK(ritz_general_svd(&part, &right, &s, NULL));
    RITZ_CHECK(take_columns(&right, s, floor, c->signal, &c->V));
    return ritz_dense_mul(R, &c->V, &c->U);
}

/* R = V diag(s) V' in the span of Q. */
static ritz_status split_form(const ritz_dense *R, const ritz_dense *Q,
                              double floor, ritz_step_matrix *c)
{
    RITZ_OWN(ritz_dense) small = {0}, all = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_dense_congruence(R, Q, &small));
    RITZ_CHECK(ritz_general_symmetric(&small, &pairs));
    RITZ_CHECK(ritz_dense_mul(Q, &pairs.Phi, &all));
    return take_columns(&all, pairs.lambda, floor, c->weight, &c->V);
}

/* c has its blocks: the rest of A, or A itself. */
static ritz_status split_rest(const ritz_dense *A, const scales *by,
                              ritz_step_matrix *c)
{
    double floor = 0.0;
    RITZ_OWN(ritz_dense) whole = {0}, R = {0}, Q = {0};

    RITZ_CHECK(ritz_dense_copy(A, &whole));
    RITZ_CHECK(ritz_dense_copy(A, &R));
    balance(c->form, by->d, &whole);
    for (int64_t j = 0; j < A->ncol; j++)
        floor = fmax(floor,
                     cblas_dasum((int)A->nrow, ritz_dense_col(&whole, j), 1));
    floor *= by->cut;
    remove_blocks(c, &R);
    balance(c->form, by->d, &R);
    RITZ_CHECK(find_span(&R, floor, &Q));
    RITZ_CHECK_NEW(c->signal, Q.ncol);
    RITZ_CHECK_NEW(c->weight, Q.ncol);
    if (Q.val)
        RITZ_CHECK(c->form ? split_form(&R, &Q, floor, c)
                           : split_map(&R, &Q, floor, c));
    c->rank = c->V.ncol;
    scale_rows(true, by->d, &c->V);
    scale_rows(false, by->d, &c->U);
    return RITZ_OK;
}

static ritz_status find_parts(const ritz_dense *A, const scales *by,
                              ritz_step_matrix *c)
{
    ritz_step_matrix whole = {.form = c->form, .rank = -1};

    whole.rows = c->rows = A->nrow;
    whole.cols = c->cols = A->ncol;
    RITZ_CHECK(split_rest(A, by, c));
    if (c->V.val && ritz_step_matrix_cost(c) < ritz_step_matrix_cost(&whole))
        return RITZ_OK;
    ritz_step_matrix_free(c);
    *c = whole;
    return ritz_dense_copy(A, &c->full);
}

/* Numbers k below n with k mod 3 = part. */
static int64_t list_third(int64_t n, int64_t part, int64_t *out)
{
    int64_t count = 0;

    for (int64_t k = part; k < n; k += 3)
        out[count++] = k;
    return count;
}

/* d_i -= D_iJ D_KJ^+ D_Ki of a third of the modes. */
static ritz_status leave_third(const ritz_dense *D, int64_t part, double *d)
{
    const int64_t n = D->nrow;
    RITZ_OWN_ARRAY int64_t *J = NULL, *K = NULL;
    RITZ_OWN_ARRAY double *s = NULL;
    RITZ_OWN(ritz_dense) D_J = {0}, D_KJ = {0}, D_K = {0}, U = {0}, V = {0};
    RITZ_OWN(ritz_dense) left = {0}, right = {0};
    int64_t num_J = 0, num_K = 0;

    RITZ_CHECK_NEW(J, n);
    RITZ_CHECK_NEW(K, n);
    num_J = list_third(n, (part + 1) % 3, J);
    num_K = list_third(n, (part + 2) % 3, K);
    RITZ_CHECK(ritz_dense_pick(D, num_J, J, &D_J));
    RITZ_CHECK(ritz_dense_rows(&D_J, num_K, K, &D_KJ));
    RITZ_CHECK(ritz_dense_rows(D, num_K, K, &D_K));
    RITZ_CHECK(ritz_general_svd(&D_KJ, &U, &s, &V));
    RITZ_CHECK(ritz_dense_mul(&D_J, &V, &left));
    RITZ_CHECK(ritz_dense_mul_tn(&U, &D_K, &right));
    for (int64_t i = part; i < n; i += 3)
        for (int64_t t = 0; t < (num_J < num_K ? num_J : num_K); t++)
            if (s[t] > RITZ_SUM_ROUNDING * s[0])
                d[i] -= ritz_dense_col(&left, t)[i] *
                        ritz_dense_col(&right, i)[t] / s[t];
    return RITZ_OK;
}

/*
 * What damping has of each mode alone: d of D = diag(d) + L with L of low rank,
 * as dampers between modes make it. Then L_ii = L_iJ L_KJ^+ L_Ki for any J and
 * K of enough modes, and if i, J and K have none in common, D and L are the
 * same there. If D is not such a sum, d is of no use, but does no harm.
 */
static ritz_status find_alone(const ritz_dense *D, double *d)
{
    enum { FEWEST = 9 };

    for (int64_t k = 0; k < D->nrow; k++)
        d[k] = ritz_dense_col(D, k)[k];
    for (int64_t part = 0; D->nrow >= FEWEST && part < 3; part++)
        RITZ_CHECK(leave_third(D, part, d));
    return RITZ_OK;
}

/* The step of each mode alone, and, with a form, what damping dissipates. */
static ritz_status find_blocks(const ritz_step_matrix_modes *modes, double h,
                               ritz_step_matrix *E, ritz_step_matrix *W)
{
    RITZ_OWN(ritz_dense) A = {0}, Q = {0};
    RITZ_OWN_ARRAY double *alone = NULL;

    RITZ_CHECK_NEW(alone, modes->count);
    if (modes->count > 0)
        RITZ_CHECK(find_alone(modes->D, alone));
    RITZ_CHECK(ritz_dense_new(2, 2, &A));
    RITZ_CHECK(ritz_dense_new(2, 2, &Q));
    E->pairs = modes->count;
    RITZ_CHECK_NEW(E->own, modes->count);
    if (W) {
        W->pairs = modes->count;
        RITZ_CHECK_NEW(W->own, modes->count);
    }
    A.val[2] = 1.0;
    for (int64_t j = 0; j < modes->count; j++) {
        const double lambda = modes->lambda[j], d = alone[j];
        const ritz_oscillator o = ritz_oscillator_over(lambda, d, h);
        const double own[4] = {o.hold, -lambda * o.S, o.S, o.rate};
        RITZ_OWN(ritz_dense) X = {0}, form = {0};

        memcpy(E->own[j], own, sizeof own);
        A.val[1] = -lambda;
        A.val[3] = -d;
        Q.val[3] = d;
        if (!W)
            continue;
        RITZ_CHECK(ritz_exponential(&A, h, 1, &Q, &X, &form));
        memcpy(W->own[j], form.val, sizeof own);
    }
    return RITZ_OK;
}

RITZ_ARRAY_OF(ritz_dense);

ritz_status ritz_step_matrices(const ritz_step_matrix_modes *modes,
                               const ritz_dense *A, double h, int count,
                               const ritz_dense *Q, ritz_step_matrix *E,
                               ritz_step_matrix *W)
{
    double norm = 0.0;
    RITZ_OWN(ritz_dense) X = {0}, rows = {0};
    RITZ_OWN(ritz_dense_array) forms = {.count = count};
    RITZ_OWN(ritz_step_matrix) map = {0};
    RITZ_OWN(ritz_step_matrix_array) form = {.count = count};
    RITZ_OWN_ARRAY double *d = NULL;
    scales by = {0};

    RITZ_CHECK_NEW(d, A->nrow);
    RITZ_CHECK_NEW(forms.at, count);
    RITZ_CHECK_NEW(form.at, count);
    RITZ_CHECK(ritz_exponential(A, h, count, Q, &X, forms.at));
    RITZ_CHECK(ritz_general_balance(A, d, &norm));
    by = (scales){d, RITZ_STEP_MATRIX_ROUNDING *
                         (RITZ_STEP_MATRIX_LEAST + norm * h)};
    RITZ_CHECK(find_blocks(modes, h, &map, count > 0 ? form.at : NULL));
    RITZ_CHECK(ritz_dense_block(&X, 0, modes->rows, 0, X.ncol, &rows));
    RITZ_CHECK(find_parts(&rows, &by, &map));
    for (int k = 0; k < count; k++) {
        form.at[k].form = true;
        RITZ_CHECK(find_parts(&forms.at[k], &by, &form.at[k]));
    }
    RITZ_MOVE(*E, map);
    for (int k = 0; k < count; k++)
        RITZ_MOVE(W[k], form.at[k]);
    return RITZ_OK;
}

/* signal = V'z */
static void find_signals(const ritz_step_matrix *A, const double *z)
{
    if (A->rank > 0)
        cblas_dgemv(CblasColMajor, CblasTrans, (int)A->cols, (int)A->rank, 1.0,
                    A->V.val, (int)A->cols, z, 1, 0.0, A->signal, 1);
}

void ritz_step_matrix_apply(const ritz_step_matrix *E, const double *z,
                            double *y)
{
    const int64_t n = E->pairs;

    memset(y, 0, (size_t)E->rows * sizeof *y);
    if (E->rank < 0) {
        ritz_motion_gemv(&E->full, 1.0, z, y);
        return;
    }
    for (int64_t j = 0; j < n; j++) {
        const double *b = E->own[j];

        y[j] = b[0] * z[j] + b[2] * z[n + j];
        y[n + j] = b[1] * z[j] + b[3] * z[n + j];
    }
    find_signals(E, z);
    ritz_motion_gemv(&E->U, 1.0, E->signal, y);
}

double ritz_step_matrix_value(const ritz_step_matrix *W, const double *z)
{
    const int64_t n = W->pairs;
    double sum = 0.0;

    if (W->rank < 0)
        return ritz_motion_form(&W->full, z);
    for (int64_t j = 0; j < n; j++) {
        const double *b = W->own[j];

        sum += z[j] * (b[0] * z[j] + (b[1] + b[2]) * z[n + j]) +
               b[3] * z[n + j] * z[n + j];
    }
    find_signals(W, z);
    for (int64_t k = 0; k < W->rank; k++)
        sum += W->weight[k] * W->signal[k] * W->signal[k];
    return sum;
}

int64_t ritz_step_matrix_cost(const ritz_step_matrix *A)
{
    const int64_t whole = A->rows * A->cols;

    if (A->rank < 0)
        return A->form ? (whole + A->rows) / 2 : whole;
    return 4 * A->pairs + A->rank * (A->cols + (A->form ? 0 : A->rows));
}
