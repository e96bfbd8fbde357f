/*
 * Response of a full component, one complex symmetric factor a frequency:
 *
 *     Z_0 = K + i K4 + i w D - w^2 M,    Rayleigh: (1 + i w b) K, a M too
 *
 * Damping ratios act on modes Phi: Z = Z_0 + M Phi E Phi'M with
 * E = i w diag(2 zeta w_k).
 *
 * Without D and K4 the modes come apart from the rest exactly,
 *
 *     x = Phi (Lambda - w^2 I + E)^-1 Phi'f + P Z_0^-1 P'f,
 *     P = I - Phi Phi'M,
 *
 * and Z_0 may be near a pole as P'f does not reach it. With them, and
 * U = M Phi,
 *
 *     x = (I - Y (I + E U'Y)^-1 E U') Z_0^-1 f,    Y = Z_0^-1 U
 */
#include "verify/poles.h"

#include "base/alloc.h"

#include <ritz/factor.h>
#include <ritz/monitor.h>

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_MATRICES = 4, MOST_NUDGES = 100 };

static const double pi = 3.14159265358979323846;
/* How far the rest stays from a pole that was removed, of its lambda: its own
   error is of this size or less, while the factor loses as many digits in a
   direction that is projected out. */
static const double nudge = 1e-9;
static const double nudge_at_rest = 1e-6;

/* What all frequencies share. */
typedef struct direct {
    const ritz_component *component;
    const ritz_damping *damping;
    ritz_zldl *Z;
    ritz_pairs pairs;
    ritz_poles poles;
    ritz_dense MPhi; /* n x m */
    int64_t n, m, inputs;
    bool apart; /* neither D nor K4 nor Rayleigh damping */
    bool ratios;
    double _Complex *X; /* n x (inputs + m), m columns only if needed */
} direct;

static ritz_status start(direct *s)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = s->component;
    const ritz_sparse *A[MOST_MATRICES] = {&c->K, &c->M};
    int64_t count = 2;
    bool matrices = c->D.colptr || c->K4.colptr;
    bool rayleigh = ritz_damping_is_rayleigh(s->damping);

    if (c->D.colptr)
        A[count++] = &c->D;
    if (c->K4.colptr)
        A[count++] = &c->K4;
    s->n = c->num_dofs;
    s->m = s->pairs.Phi.ncol;
    s->inputs = c->io.num_inputs;
    s->ratios = !rayleigh && s->damping->kind != RITZ_DAMPING_NONE;
    s->apart = !matrices && !rayleigh;
    RITZ_NEW(s->X, s->n * (s->inputs + s->m));
    RITZ_TRY(ritz_sparse_mul(&c->M, &s->pairs.Phi, &s->MPhi));
    RITZ_TRY(ritz_zldl_new(count, A, &s->Z));
done:
    return status;
}

static void finish(direct *s)
{
    ritz_zldl_free(&s->Z);
    ritz_pairs_free(&s->pairs);
    ritz_poles_free(&s->poles);
    ritz_dense_free(&s->MPhi);
    free(s->X);
}

static ritz_status factor(direct *s, double w, double w2)
{
    ritz_status status = RITZ_OK;
    double a = 0.0;
    double b = 0.0;
    double _Complex c[MOST_MATRICES];
    int64_t count = 2;

    if (ritz_damping_is_rayleigh(s->damping)) {
        a = s->damping->a;
        b = s->damping->b;
    }
    c[0] = ritz_complex(1.0, w * b);
    c[1] = ritz_complex(-w2, w * a);
    if (s->component->D.colptr)
        c[count++] = ritz_complex(0.0, w);
    if (s->component->K4.colptr)
        c[count] = ritz_complex(0.0, 1.0);
    status = ritz_zldl_factor(s->Z, c);
    RITZ_FAIL_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                 "the response at %.9g Hz is infinite: an undamped mode, or at "
                 "0 Hz a rigid-body motion",
                 w / (2.0 * pi));
done:
    return status;
}

/* y -= A (B'y), columns of y complex, A and B real n x m. */
static void remove_modes(const ritz_dense *A, const ritz_dense *B,
                         double _Complex *y)
{
    for (int64_t k = 0; k < A->ncol; k++) {
        const double *a = ritz_dense_col(A, k);
        const double *b = ritz_dense_col(B, k);
        double _Complex q = 0.0;

        for (int64_t i = 0; i < A->nrow; i++)
            q += b[i] * y[i];
        for (int64_t i = 0; i < A->nrow; i++)
            y[i] -= a[i] * q;
    }
}

/* w^2, or next to it, where no removed mode has its pole. */
static double beside_poles(const direct *s, double w2)
{
    int64_t r = s->poles.num_rigid;
    double first = r < s->m ? s->poles.lambda[r] : fabs(s->pairs.sigma);
    double gap = fmax(nudge * w2, r > 0 ? nudge_at_rest * first : 0.0);
    bool clear = false;

    for (int t = 0; t < MOST_NUDGES && !clear; t++) {
        clear = true;
        for (int64_t k = 0; k < s->m; k++)
            if (fabs(s->poles.lambda[k] - w2) < gap) {
                w2 = s->poles.lambda[k] + 1.5 * gap;
                clear = false;
            }
    }
    return w2;
}

/* Modes by themselves, the rest with their share of the load taken away. */
static ritz_status solve_apart(direct *s, double hertz, double _Complex *H)
{
    ritz_status status = RITZ_OK;
    double w = 2.0 * pi * hertz;

    RITZ_TRY(ritz_poles_add(&s->poles, hertz, H));
    if (s->m >= s->n)
        goto done;
    for (int64_t j = 0; j < s->inputs; j++)
        remove_modes(&s->MPhi, &s->pairs.Phi, s->X + j * s->n);
    RITZ_TRY(factor(s, w, beside_poles(s, w * w)));
    RITZ_TRY(ritz_zldl_solve(s->Z, s->inputs, s->X));
    for (int64_t j = 0; j < s->inputs; j++)
        remove_modes(&s->pairs.Phi, &s->MPhi, s->X + j * s->n);
    ritz_response_see(&s->component->io, hertz, s->X, H);
done:
    return status;
}

/* out = E U'X, m x columns. */
static void rates(const direct *s, double w, int64_t columns,
                  const double _Complex *X, double _Complex *out)
{
    for (int64_t j = 0; j < columns; j++)
        for (int64_t k = 0; k < s->m; k++) {
            const double *u = ritz_dense_col(&s->MPhi, k);
            double wk = sqrt(s->poles.lambda[k]);
            int64_t mode = k - s->poles.num_rigid;
            double e = 2.0 * wk * ritz_damping_of_mode(s->damping, mode, wk);
            double _Complex sum = 0.0;

            for (int64_t i = 0; i < s->n; i++)
                sum += u[i] * X[i + j * s->n];
            out[k + j * s->m] =
                ritz_complex(0.0, k < s->poles.num_rigid ? 0.0 : w * e) * sum;
        }
}

/* X := X - Y (I + E U'Y)^-1 E U'X, X the first columns and Y the others. */
static ritz_status correct(direct *s, double w)
{
    ritz_status status = RITZ_OK;
    int64_t m = s->m;
    double _Complex *Y = s->X + s->n * s->inputs;
    double _Complex *S = NULL;
    double _Complex *q = NULL;
    lapack_int *pivot = NULL;
    int info = 0;

    RITZ_NEW(S, m * m);
    RITZ_NEW(q, m * s->inputs);
    RITZ_NEW(pivot, m);
    rates(s, w, m, Y, S);
    rates(s, w, s->inputs, s->X, q);
    for (int64_t k = 0; k < m; k++)
        S[k + k * m] += 1.0;
    if (m > 0)
        info = LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)m, (int)s->inputs, S,
                             (int)m, pivot, q, (int)m);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_SINGULAR,
                 "the response at %.9g Hz is infinite", w / (2.0 * pi));
    for (int64_t j = 0; j < s->inputs; j++)
        for (int64_t k = 0; k < m; k++)
            for (int64_t i = 0; i < s->n; i++)
                s->X[i + j * s->n] -= Y[i + k * s->n] * q[k + j * m];
done:
    free(S);
    free(q);
    free(pivot);
    return status;
}

static ritz_status solve_together(direct *s, double hertz, double _Complex *H)
{
    ritz_status status = RITZ_OK;
    double w = 2.0 * pi * hertz;
    int64_t columns = s->inputs + (s->ratios ? s->m : 0);

    RITZ_FAIL_IF(hertz == 0.0 && s->poles.num_rigid > 0, RITZ_ERR_SINGULAR,
                 "at 0 Hz the response is infinite: the body is free, begin "
                 "above 0 Hz");
    for (int64_t k = 0; k < s->n * s->m; k++)
        s->X[s->n * s->inputs + k] = s->MPhi.val[k];
    RITZ_TRY(factor(s, w, w * w));
    RITZ_TRY(ritz_zldl_solve(s->Z, columns, s->X));
    if (s->ratios)
        RITZ_TRY(correct(s, w));
    ritz_response_see(&s->component->io, hertz, s->X, H);
done:
    return status;
}

static ritz_status sweep(direct *s, ritz_response *r)
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < r->count && s->inputs > 0; k++) {
        double _Complex *H = r->H + k * r->num_outputs * r->num_inputs;

        for (int64_t i = 0; i < s->n * s->inputs; i++)
            s->X[i] = s->component->io.B.val[i];
        if (s->apart)
            RITZ_TRY(solve_apart(s, r->hertz[k], H));
        else
            RITZ_TRY(solve_together(s, r->hertz[k], H));
        ritz_monitor_step("response", k + 1, r->count);
    }
done:
    return status;
}

ritz_status ritz_response_direct(const ritz_component *component,
                                 const ritz_damping *damping, double up_to_hz,
                                 const ritz_grid *grid, ritz_response *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    direct s = {.component = component, .damping = damping ? damping : &none};
    ritz_response r = {0};
    double highest = up_to_hz > 0.0 ? up_to_hz : 3.0 * grid->to_hz;

    RITZ_TRY(ritz_grid_check(grid));
    RITZ_TRY(ritz_poles_of_component(component, damping, highest, &s.pairs,
                                     &s.poles));
    RITZ_TRY(start(&s));
    RITZ_TRY(ritz_response_new(grid, &s.poles, "direct", damping, &r));
    RITZ_TRY(sweep(&s, &r));
    *out = r;
    r = (ritz_response){0};
done:
    finish(&s);
    ritz_response_free(&r);
    return status;
}
