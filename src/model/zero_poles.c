/*
 * Poles at 0 of E x' = A x, of rigid motion and of integrators. States of these
 * poles have no Gramian, and are decoupled by right and left vectors T and W,
 *
 *     A T = E T J,   A'W = E'W J',   W'E T = I,   J nilpotent:
 *     B := B - E T W'B,   C' := C' - E'W T'C'
 *
 * For a free body J has a block [0 1; 0 0] for each motion, whose eigenvalues
 * are known only to the square root of rounding. T and W span the right and
 * left invariant subspaces of the slowest poles, found by block iterations with
 * (A - sigma E)^-1 E, sigma > 0, and with the same operator of (A', E'). A
 * Jordan block does not make these subspaces less accurate. An eigenvalue mu of
 * J with right and left vectors x and y counts as 0 if
 *
 *     |mu| <= 8 eps |y|'(|A| + |mu| |E|)|x| / |y'E x|,
 *
 * a criterion that does not depend on the units of states.
 */
#include "model/space.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCK = 28,  /* vectors in a block */
    ROUNDS = 12, /* largest number of rounds to place sigma */
    FEW = 3,     /* iterations in a round */
    MANY = 12,   /* iterations after the last round */
};

typedef struct slow_poles {
    ritz_pencil *pencil; /* borrowed */
    double sigma;
    ritz_dense V[2];  /* n x BLOCK, orthonormal: right and left */
    ritz_dense SV;    /* (A - sigma E)^-1 E V of the side iterated last */
    ritz_dense at[2]; /* n x c, vectors of the slowest poles: right and left */
} slow_poles;

static void slow_poles_free(slow_poles *s)
{
    for (int side = 0; side < 2; side++) {
        ritz_dense_free(&s->V[side]);
        ritz_dense_free(&s->at[side]);
    }
    ritz_dense_free(&s->SV);
}

/* Replace V by orthonormal columns with the same span. */
static ritz_status orthonormalise(ritz_dense *V)
{
    const int n = (int)V->nrow, k = (int)V->ncol;
    RITZ_OWN_ARRAY double *tau = NULL;
    int info = 0;

    RITZ_CHECK_NEW(tau, k);
    info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, k, V->val, n, tau);
    if (info == 0)
        info = LAPACKE_dorgqr(LAPACK_COL_MAJOR, n, k, k, V->val, n, tau);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "vectors of slow poles are not finite");
    return RITZ_OK;
}

/* Starting vectors that are not smooth, and the same on every machine. */
static ritz_status start_block(slow_poles *s, int side)
{
    const int64_t n = s->pencil->n, k = n < BLOCK ? n : BLOCK;

    RITZ_CHECK(ritz_dense_new(n, k, &s->V[side]));
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&s->V[side], j)[i] =
                cos(3.0 * (double)i * (double)i + 2.0 * (double)(i * j)) +
                (i == j ? 1.0 : 0.0);
    return orthonormalise(&s->V[side]);
}

/* Compute SV or, if @p next, replace V by the orthonormalised SV. */
static ritz_status iterate_block(slow_poles *s, int side, bool next)
{
    const bool left = side == 1;
    const int64_t size = s->V[side].nrow * s->V[side].ncol;
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY double _Complex *x = NULL;

    RITZ_CHECK(ritz_sparse_mul(ritz_pencil_descriptor(s->pencil, left),
                               &s->V[side], &X));
    RITZ_CHECK_NEW(x, size);
    for (int64_t i = 0; i < size; i++)
        x[i] = X.val[i];
    RITZ_CHECK(ritz_pencil_solve(s->pencil, left, X.ncol, x));
    for (int64_t i = 0; i < size; i++)
        X.val[i] = creal(x[i]);
    if (next) {
        ritz_dense_replace(&s->V[side], &X);
        return orthonormalise(&s->V[side]);
    }
    ritz_dense_replace(&s->SV, &X);
    return RITZ_OK;
}

/* -sigma V'S V; a pole s gives the eigenvalue 1 / (1 - s / sigma). */
static ritz_status project_operator(slow_poles *s, int side, ritz_dense *out)
{
    RITZ_CHECK(iterate_block(s, side, false));
    RITZ_CHECK(ritz_dense_mul_tn(&s->V[side], &s->SV, out));
    for (int64_t k = 0; k < out->nrow * out->ncol; k++)
        out->val[k] *= -s->sigma;
    return RITZ_OK;
}

/* |s| / sigma of an eigenvalue of the projected operator. */
static double relative_size(double re, double im)
{
    const double _Complex nu = ritz_complex(re, im);

    return cabs(nu) > 0.0 ? cabs(1.0 - 1.0 / nu) : HUGE_VAL;
}

static int compare_sizes(const void *left, const void *right)
{
    const double *a = left, *b = right;

    return (*a > *b) - (*a < *b);
}

/* |s| of the first pole above the widest gap between computed poles; poles at 0
   lie below that gap. */
static ritz_status find_gap(slow_poles *s, double *out)
{
    RITZ_OWN(ritz_dense) H = {0};
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    RITZ_OWN_ARRAY double *size = NULL;
    double widest = 0.0;
    int64_t last = 0;

    RITZ_CHECK(project_operator(s, 0, &H));
    RITZ_CHECK(ritz_eigenvalues_of(&H, &poles));
    RITZ_CHECK_NEW(size, poles.count);
    for (int64_t k = 0; k < poles.count; k++)
        size[k] = s->sigma * relative_size(poles.re[k], poles.im[k]);
    qsort(size, (size_t)poles.count, sizeof *size, compare_sizes);
    last = poles.count > BLOCK / 2 ? poles.count - BLOCK / 7 : poles.count;
    *out = poles.count > 0 ? size[0] : 0.0;
    for (int64_t k = 1; k < last; k++) {
        double gap = size[k] / fmax(size[k - 1], DBL_EPSILON * size[k]);

        if (isfinite(size[k]) && gap > widest) {
            widest = gap;
            *out = size[k];
        }
    }
    return RITZ_OK;
}

/* Factor A - sigma E; sigma is increased while that is singular. */
static ritz_status factor_beside(slow_poles *s)
{
    ritz_status status = ritz_pencil_factor(s->pencil, s->sigma);

    for (int k = 0; k < FEW && status == RITZ_ERR_SINGULAR; k++) {
        s->sigma *= RITZ_SHIFT_FARTHER;
        status = ritz_pencil_factor(s->pencil, s->sigma);
    }
    return status;
}

/* Iterate the right side until sigma is well below all poles but those at 0. */
static ritz_status place_sigma(slow_poles *s)
{
    for (int round = 0; round < ROUNDS; round++) {
        double above = 0.0;

        RITZ_CHECK(factor_beside(s));
        for (int k = 0; k < FEW; k++)
            RITZ_CHECK(iterate_block(s, 0, true));
        RITZ_CHECK(find_gap(s, &above));
        if (!(above > 0.0) || !isfinite(above) ||
            fabs(log(s->sigma / (RITZ_ZERO_POLE_SHIFT * above))) < 1.0)
            break;
        s->sigma = RITZ_ZERO_POLE_SHIFT * above;
    }
    return factor_beside(s);
}

/* Poles nearer to 0 than half of sigma. */
static lapack_logical is_slow(const double *re, const double *im)
{
    return relative_size(*re, *im) < 0.5;
}

/* Orthonormal vectors of one side that span those of the slow poles. */
static ritz_status take_slow(slow_poles *s, int side)
{
    const int k = (int)s->V[side].ncol;
    RITZ_OWN(ritz_dense) H = {0}, Q = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL;
    ritz_dense first = {0};
    lapack_int count = 0;
    int info = 0;

    for (int i = 0; i < MANY; i++)
        RITZ_CHECK(iterate_block(s, side, true));
    RITZ_CHECK(project_operator(s, side, &H));
    RITZ_CHECK(ritz_dense_new(k, k, &Q));
    RITZ_CHECK_NEW(re, k);
    RITZ_CHECK_NEW(im, k);
    info = LAPACKE_dgees(LAPACK_COL_MAJOR, 'V', 'S', is_slow, k, H.val, k,
                         &count, re, im, Q.val, k);
    /* k + 2: rounding moved a reordered pole to half of sigma or beyond */
    RITZ_REFUSE_IF(info != 0 && info != k + 2, RITZ_ERR_CONVERGENCE,
                   "poles near 0 were not separated");
    first = ritz_dense_part(&Q, 0, count);
    ritz_dense_free(&s->at[side]);
    return ritz_dense_mul(&s->V[side], &first, &s->at[side]);
}

/* Magnitude of each entry of B v, with v the eigenvector of eigenvalue k. */
static ritz_status size_entries(const ritz_dense *B, const ritz_dense *V,
                                const double *im, int64_t k, double *out)
{
    const bool pair = im[k] != 0.0;
    const ritz_dense part = ritz_dense_part(V, k, pair ? 2 : 1);
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_mul(B, &part, &X));
    for (int64_t i = 0; i < X.nrow; i++)
        out[i] = hypot(X.val[i], pair ? X.val[i + X.nrow] : 0.0);
    return RITZ_OK;
}

/* |eta^H xi| of the left and right eigenvectors of eigenvalue k. */
static double cosine_of(const ritz_dense *left, const ritz_dense *right,
                        const double *im, int64_t k)
{
    double re = ritz_dense_dot(left, k, right, k), imaginary = 0.0;

    if (im[k] != 0.0) {
        re += ritz_dense_dot(left, k + 1, right, k + 1);
        imaginary = ritz_dense_dot(left, k, right, k + 1) -
                    ritz_dense_dot(left, k + 1, right, k);
    }
    return hypot(re, imaginary);
}

/* Number of eigenvalues of J that count as 0, and the least magnitude of the
   others. */
static ritz_status judge_slow(const slow_poles *s, const ritz_dense *J,
                              int64_t *zero, double *least)
{
    const int64_t n = s->pencil->n;
    const int c = (int)J->nrow;
    RITZ_OWN(ritz_dense) A = {0}, left = {0}, right = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL, *x = NULL, *y = NULL;

    RITZ_CHECK(ritz_dense_copy(J, &A));
    RITZ_CHECK(ritz_dense_new(c, c, &left));
    RITZ_CHECK(ritz_dense_new(c, c, &right));
    RITZ_CHECK_NEW(re, c);
    RITZ_CHECK_NEW(im, c);
    RITZ_CHECK_NEW(x, n);
    RITZ_CHECK_NEW(y, n);
    RITZ_REFUSE_IF(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'V', 'V', c, A.val, c, re,
                                 im, left.val, c, right.val, c) != 0,
                   RITZ_ERR_CONVERGENCE, "poles near 0 were not found");
    *zero = 0;
    *least = HUGE_VAL;
    for (int64_t k = 0, step = 1; k < c; k += step) {
        double mu = hypot(re[k], im[k]), moves = 0.0;

        step = im[k] != 0.0 ? 2 : 1;
        RITZ_CHECK(size_entries(&s->at[0], &right, im, k, x));
        RITZ_CHECK(size_entries(&s->at[1], &left, im, k, y));
        moves = RITZ_POLE_BOUND_FACTOR * DBL_EPSILON *
                ritz_pencil_magnitude(s->pencil, mu, x, y);
        if (mu * cosine_of(&left, &right, im, k) <= moves)
            *zero += step;
        else
            *least = fmin(*least, mu);
    }
    return RITZ_OK;
}

/* W := W (W'E T)^-T, and J = W'A T. *fit is false if T and W do not have the
   same number of columns, or W'E T is singular. */
static ritz_status normalise_sides(slow_poles *s, ritz_dense *J, bool *fit)
{
    RITZ_OWN(ritz_dense) ET = {0}, AT = {0}, G = {0}, X = {0};
    ritz_status status = RITZ_OK;

    *fit = s->at[0].ncol == s->at[1].ncol && s->at[0].ncol > 0;
    if (!*fit)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(&s->pencil->E, &s->at[0], &ET));
    RITZ_CHECK(ritz_dense_mul_tn(&ET, &s->at[1], &G));
    RITZ_CHECK(ritz_general_transpose(&s->at[1], &X));
    status = ritz_general_solve(&G, true, &X);
    *fit = status == RITZ_OK;
    if (!*fit)
        return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
    ritz_dense_free(&s->at[1]);
    RITZ_CHECK(ritz_general_transpose(&X, &s->at[1]));
    RITZ_CHECK(ritz_sparse_mul(&s->pencil->A, &s->at[0], &AT));
    return ritz_dense_mul_tn(&s->at[1], &AT, J);
}

static ritz_status find_slow(slow_poles *s, int64_t *zero, double *least)
{
    RITZ_OWN(ritz_dense) J = {0};
    bool fit = false;

    *zero = 0;
    *least = HUGE_VAL;
    for (int side = 0; side < 2; side++)
        RITZ_CHECK(take_slow(s, side));
    RITZ_CHECK(normalise_sides(s, &J, &fit));
    return fit ? judge_slow(s, &J, zero, least) : RITZ_OK;
}

static ritz_status take_decoupled(slow_poles *s, ritz_zero_poles *out)
{
    ritz_zero_poles *z = out;

    z->radius = s->sigma;
    RITZ_CHECK(ritz_sparse_mul(&s->pencil->E, &s->at[0], &z->ET));
    RITZ_CHECK(ritz_sparse_mul(ritz_pencil_descriptor(s->pencil, true),
                               &s->at[1], &z->EtW));
    RITZ_MOVE(z->T, s->at[0]);
    RITZ_MOVE(z->W, s->at[1]);
    return RITZ_OK;
}

ritz_status ritz_zero_poles_find(ritz_pencil *pencil, ritz_zero_poles *out)
{
    RITZ_OWN(slow_poles) s = {.pencil = pencil};
    RITZ_OWN(ritz_zero_poles) z = {0};
    const double size =
        ritz_sparse_max(&pencil->A) / ritz_sparse_max(&pencil->E);
    bool none = false;
    int64_t zero = 0;
    double least = HUGE_VAL;

    RITZ_CHECK(ritz_pencil_is_dissipative(pencil, &none));
    s.sigma = RITZ_SHIFT_OF_SIZE * size;
    if (!none && s.sigma > 0.0) {
        for (int side = 0; side < 2; side++)
            RITZ_CHECK(start_block(&s, side));
        RITZ_CHECK(place_sigma(&s));
        RITZ_CHECK(find_slow(&s, &zero, &least));
        for (int k = 0; k < FEW && zero > 0 && isfinite(least); k++) {
            s.sigma = RITZ_ZERO_POLE_SHIFT * least;
            RITZ_CHECK(factor_beside(&s));
            RITZ_CHECK(find_slow(&s, &zero, &least));
        }
    }
    if (zero > 0 && !isfinite(least)) {
        RITZ_CHECK(take_decoupled(&s, &z));
    } else {
        RITZ_CHECK(ritz_dense_new(pencil->n, 0, &z.T));
        RITZ_CHECK(ritz_dense_new(pencil->n, 0, &z.W));
    }
    RITZ_MOVE(*out, z);
    return RITZ_OK;
}

ritz_status ritz_zero_poles_of_loads(const ritz_zero_poles *z, bool outputs,
                                     ritz_dense *F)
{
    if (z->T.ncol == 0)
        return RITZ_OK;
    return outputs ? ritz_dense_take_out(&z->EtW, &z->T, F)
                   : ritz_dense_take_out(&z->ET, &z->W, F);
}

ritz_status ritz_zero_poles_of_states(const ritz_zero_poles *z, bool outputs,
                                      int64_t count, double _Complex *x)
{
    const int64_t n = z->T.nrow;
    RITZ_OWN(ritz_dense) X = {0};

    if (z->T.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(n, 2 * count, &X));
    for (int64_t i = 0; i < n * count; i++) {
        X.val[i] = creal(x[i]);
        X.val[i + n * count] = cimag(x[i]);
    }
    RITZ_CHECK(outputs ? ritz_dense_take_out(&z->W, &z->ET, &X)
                       : ritz_dense_take_out(&z->T, &z->EtW, &X));
    for (int64_t i = 0; i < n * count; i++)
        x[i] = ritz_complex(X.val[i], X.val[i + n * count]);
    return RITZ_OK;
}

void ritz_zero_poles_free(ritz_zero_poles *z)
{
    ritz_dense_free(&z->T);
    ritz_dense_free(&z->W);
    ritz_dense_free(&z->ET);
    ritz_dense_free(&z->EtW);
}
