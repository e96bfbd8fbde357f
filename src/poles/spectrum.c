/*
 * Poles of a dense model, from its first-order form: see state.h. Where D
 * couples no modes each has s^2 + d s + lambda = 0 of its own.
 */
#include <ritz/poles.h>

#include "base/alloc.h"
#include "poles/poles.h"
#include "poles/spectrum_parts.h"
#include "poles/state.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Eigenvalues of y' = A y, and vectors y as columns. */
typedef struct found {
    int64_t count, size;
    double _Complex *s; /* count */
    double _Complex *y; /* size x count */
} found;

static void found_free(found *f)
{
    free(f->s);
    free(f->y);
}

static ritz_status found_new(int64_t size, found *out)
{
    out->count = out->size = size;
    RITZ_CHECK_NEW(out->s, size);
    RITZ_CHECK_NEW(out->y, size * size);
    return RITZ_OK;
}

double ritz_spectrum_ratio(double _Complex s)
{
    return creal(s) == 0.0 ? 0.0 : -creal(s) / cabs(s); /* never -0 */
}

/* Roots of s^2 + d s + lambda: a pair, or two real ones without cancellation;
 * p = 1, so that y = [W; s]. */
static ritz_status solve_diagonal(const ritz_state *state, found *out)
{
    int64_t m = state->m;

    RITZ_CHECK(found_new(2 * m, out));
    for (int64_t j = 0; j < m; j++) {
        double d = ritz_dense_col(&state->D, j)[j];
        double lambda = state->lambda[j];
        double square = 0.25 * d * d - lambda;
        double root = sqrt(fabs(square));
        double far = d < 0.0 ? -0.5 * d + root : -0.5 * d - root;

        if (square < 0.0) {
            out->s[2 * j] = ritz_complex(-0.5 * d, root);
            out->s[2 * j + 1] = ritz_complex(-0.5 * d, -root);
        } else {
            out->s[2 * j] = far;
            out->s[2 * j + 1] = far == 0.0 ? 0.0 : lambda / far;
        }
        for (int64_t t = 2 * j; t < 2 * j + 2; t++) {
            out->y[j + t * 2 * m] = ritz_state_weight(state, j);
            out->y[m + j + t * 2 * m] = out->s[t];
        }
    }
    return RITZ_OK;
}

static ritz_status solve_real(const ritz_state *state, found *out)
{
    int64_t size = 2 * state->m + state->k;
    int n = (int)size;
    RITZ_OWN(ritz_dense) A = {0}, V = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL;
    int info = 0;

    RITZ_CHECK(found_new(size, out));
    RITZ_CHECK(ritz_state_matrix(state, &A));
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
static ritz_status solve_complex(const ritz_state *state, found *out)
{
    ritz_status status = RITZ_OK;
    int64_t size = 2 * state->m;
    int n = (int)size;
    ritz_dense A = {0};
    double _Complex *Z = NULL;
    int info = 0;

    RITZ_TRY(found_new(size, out));
    RITZ_TRY(ritz_state_matrix(state, &A));
    RITZ_NEW(Z, size * size);
    for (int64_t i = 0; i < size * size; i++)
        Z[i] = A.val[i];
    for (int64_t j = 0; j < state->m; j++)
        for (int64_t i = 0; i < state->m; i++)
            Z[state->m + i + j * size] -=
                ritz_complex(0.0, ritz_dense_col(&state->K4, j)[i] /
                                      ritz_state_weight(state, j));
    if (n > 0)
        info = LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'V', n, Z, n, out->s, NULL,
                             1, out->y, n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "damped modes were not found");
done:
    ritz_dense_free(&A);
    free(Z);
    return status;
}

typedef struct listed_pole {
    double size, imaginary;
    int64_t index;
} listed_pole;

static int ascending(const void *left, const void *right)
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
static ritz_status find_zero(const ritz_state *state, double *out)
{
    RITZ_OWN(ritz_dense) A = {0};
    bool rigid = false;
    double size = 0.0;

    for (int64_t j = 0; j < state->m; j++)
        rigid = rigid || state->lambda[j] == 0.0;
    *out = 0.0;
    if (!rigid || state->diagonal)
        return RITZ_OK;
    RITZ_CHECK(ritz_state_matrix(state, &A));
    for (int64_t i = 0; i < A.nrow * A.ncol; i++)
        size = hypot(size, A.val[i]);
    *out = 10.0 * DBL_EPSILON * size;
    return RITZ_OK;
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
    qsort(order, (size_t)count, sizeof *order, ascending);
    return count;
}

/* x = X [p; a] of y = [W p; p'; a], with |x| = 1. */
static void put_shape(const ritz_state *state, const double _Complex *y,
                      double *re, double *im)
{
    int64_t n = state->X.nrow;
    double size = 0.0;

    for (int64_t j = 0; j < state->m + state->k; j++) {
        const double *x = ritz_dense_col(&state->X, j);
        double _Complex q =
            j < state->m ? y[j] / ritz_state_weight(state, j) : y[state->m + j];

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
static void add_structural(const ritz_state *state, const ritz_dense *y,
                           double sign, ritz_dense *Ay)
{
    int64_t m = state->m;

    for (int64_t c = 0; state->K4.val && c < y->ncol; c++)
        for (int64_t j = 0; j < m; j++)
            for (int64_t i = 0; i < m; i++)
                ritz_dense_col(Ay, c)[m + i] -=
                    sign * ritz_dense_col(&state->K4, j)[i] /
                    ritz_state_weight(state, j) * ritz_dense_col(y, c)[j];
}

/* |A y - s y| / ((|A| + |s|) |y|) of each, |A| in the Frobenius norm. */
static ritz_status find_residuals(const ritz_state *state, const found *f,
                                  const listed_pole *order, ritz_spectrum *out)
{
    RITZ_OWN(ritz_dense) A = {0}, re = {0}, im = {0}, Are = {0}, Aim = {0};
    double size = 0.0;

    RITZ_CHECK(ritz_state_matrix(state, &A));
    for (int64_t i = 0; i < A.nrow * A.ncol; i++)
        size = hypot(size, A.val[i]);
    RITZ_CHECK(pick_columns(f, out->count, order, creal, &re));
    RITZ_CHECK(pick_columns(f, out->count, order, cimag, &im));
    RITZ_CHECK(ritz_dense_mul(&A, &re, &Are));
    RITZ_CHECK(ritz_dense_mul(&A, &im, &Aim));
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
        out->residual[j] = gap / ((size + cabs(s)) * y);
    }
    return RITZ_OK;
}

static ritz_status list_poles(const ritz_state *state, const found *f,
                              ritz_spectrum *out)
{
    int64_t n = state->X.nrow;
    RITZ_OWN_ARRAY listed_pole *order = NULL;
    double zero = 0.0;

    RITZ_CHECK_NEW(order, f->count);
    out->num_zero = 2 * state->num_free;
    RITZ_CHECK(find_zero(state, &zero));
    out->count = choose_listed(f, state->K4.val, zero, order, &out->num_zero);
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
    RITZ_OWN(ritz_state) state = {0};
    RITZ_OWN(found) f = {0};

    RITZ_CHECK(ritz_state_new(model, damping, &state));
    if (state.diagonal)
        RITZ_CHECK(solve_diagonal(&state, &f));
    else if (state.K4.val)
        RITZ_CHECK(solve_complex(&state, &f));
    else
        RITZ_CHECK(solve_real(&state, &f));
    RITZ_CHECK(list_poles(&state, &f, &spectrum));
    (void)snprintf(spectrum.engine, sizeof spectrum.engine, "dense LAPACK");
    RITZ_MOVE(*out, spectrum);
    return RITZ_OK;
}

void ritz_spectrum_free(ritz_spectrum *spectrum)
{
    free(spectrum->s);
    free(spectrum->residual);
    ritz_dense_free(&spectrum->re);
    ritz_dense_free(&spectrum->im);
    *spectrum = (ritz_spectrum){0};
}
