/*
 * A bound of the error of the projected model, from its residual in the
 * equations of the large one. With s = i w and y the projected response to a
 * load F:
 *
 *     Z(s) = K + s D + s^2 M,   r = F - Z Phi y = -z(s) q L Theta y,
 *     z(s) = s^2 + a s - mu (1 + b s),   q'K_s^-1 q = I
 *
 *     G - G_V = r_C' Z^-1 r_B,   |G - G_V| <= |r_C| |r_B| N(s),
 *
 * where |r|^2 = r'K_s^-1 r, so that |r| = |z L Theta y|, and N is the norm of
 * K_s^1/2 Z^-1 K_s^1/2. Without dampers, Z = Z_0,
 *
 *     N_0(s) = max over lambda of |(lambda + mu) / ((1 + b s)(lambda + mu) + z)|
 *
 * With dampers Z = Z_0 + s P c P'. As the norm of c (1 + s c P'Z_0^-1 P)^-1 is
 * at most the largest c,
 *
 *     N <= N_0 + N_0^2 |r_P|^2 w max(c),
 *
 * where r_P is the residual for the load F = P in the model without dampers.
 * The Hankel values of two stable models differ by at most the largest
 * |G - G_V| on the imaginary axis [Glover1984].
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "gramians/projection.h"
#include "linear/general.h"

#include <cblas.h>
#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* One frequency, with memory for the responses to one kind of load. `columns`
   is the largest number of loads of a kind. */
typedef struct frequency_point {
    double _Complex s, z;
    double _Complex *diagonal; /* m, diagonal of Phi'Z_0 Phi */
    double _Complex *y;        /* m x columns, modal response */
    double _Complex *r;        /* p x columns, residual divided by z */
    double _Complex *S, *w;    /* d x d and d x columns, for dampers */
} frequency_point;

static void frequency_point_free(frequency_point *point)
{
    RITZ_FREE(point->diagonal, point->y, point->r, point->S, point->w);
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static ritz_status allocate_point(const ritz_projected *p,
                                  frequency_point *point)
{
    int64_t d = p->P.ncol;
    int64_t columns = larger(larger(p->B.ncol, p->C.ncol), d);

    RITZ_CHECK_NEW(point->diagonal, p->count);
    RITZ_CHECK_NEW(point->y, p->count * columns);
    RITZ_CHECK_NEW(point->r, p->L.nrow * columns);
    RITZ_CHECK_NEW(point->S, d * d);
    RITZ_CHECK_NEW(point->w, d * columns);
    return RITZ_OK;
}

static void set_frequency(const ritz_projected *p, double omega,
                          frequency_point *point)
{
    double _Complex s = ritz_complex(0.0, omega);

    point->s = s;
    point->z = s * s + p->a * s - p->mu * (1.0 + p->b * s);
    for (int64_t k = 0; k < p->count; k++)
        point->diagonal[k] = (1.0 + p->b * s) * p->lambda[k] + s * s + p->a * s;
}

/* w = P'y */
static void observe_dampers(const ritz_projected *p, int64_t columns,
                            const double _Complex *y, double _Complex *w)
{
    int64_t d = p->P.ncol, m = p->count;

    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < d; i++) {
            const double *P = ritz_dense_col(&p->P, i);

            w[i + j * d] = 0.0;
            for (int64_t k = 0; k < m; k++)
                w[i + j * d] += P[k] * y[k + j * m];
        }
}

/* Turn the response y without dampers into that with dampers:
   y -= s Z_0^-1 P c (I + s P'Z_0^-1 P c)^-1 P'y. */
static ritz_status add_dampers(const ritz_projected *p, int64_t columns,
                               frequency_point *point)
{
    int64_t d = p->P.ncol, m = p->count;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    RITZ_OWN_ARRAY double _Complex *x = NULL;

    RITZ_CHECK_NEW(pivot, d);
    RITZ_CHECK_NEW(x, m * d);
    for (int64_t i = 0; i < d; i++)
        for (int64_t k = 0; k < m; k++)
            x[k + i * m] = point->s * ritz_dense_col(&p->P, i)[k] * p->c[i] /
                           point->diagonal[k];
    observe_dampers(p, d, x, point->S);
    for (int64_t i = 0; i < d; i++)
        point->S[i + i * d] += 1.0;
    observe_dampers(p, columns, point->y, point->w);
    RITZ_REFUSE_IF(
        LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)d, (int)columns, point->S, (int)d,
                      pivot, point->w, (int)d) != 0,
        RITZ_ERR_CONVERGENCE, "dampers make the projected model singular");
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < d; i++)
            for (int64_t k = 0; k < m; k++)
                point->y[k + j * m] -= x[k + i * m] * point->w[i + j * d];
    return RITZ_OK;
}

/* |z L Theta y|, Frobenius norm over all columns y. */
static double measure_residual(const ritz_projected *p, int64_t columns,
                               const frequency_point *point)
{
    int64_t m = p->count, rows = p->L.nrow;
    double sum = 0.0;

    for (int64_t j = 0; j < columns; j++) {
        double _Complex *r = point->r + j * rows;

        for (int64_t i = 0; i < rows; i++)
            r[i] = 0.0;
        for (int64_t k = 0; k < m; k++) {
            const double *L = ritz_dense_col(&p->L, k);
            double _Complex by = p->theta[k] * point->y[k + j * m];

            for (int64_t i = 0; i < rows; i++)
                r[i] += L[i] * by;
        }
        for (int64_t i = 0; i < rows; i++)
            sum += creal(r[i]) * creal(r[i]) + cimag(r[i]) * cimag(r[i]);
    }
    return cabs(point->z) * sqrt(sum);
}

/* |r| of the loads F + s Fv, of the model with dampers or without. Fv = 0 if it
   is NULL. */
static ritz_status find_residual(const ritz_projected *p, const ritz_dense *F,
                                 const ritz_dense *Fv, bool damped,
                                 frequency_point *point, double *out)
{
    for (int64_t j = 0; j < F->ncol; j++)
        for (int64_t k = 0; k < p->count; k++) {
            double _Complex load = ritz_dense_col(F, j)[k];

            if (Fv)
                load += point->s * ritz_dense_col(Fv, j)[k];
            point->y[k + j * p->count] = load / point->diagonal[k];
        }
    if (damped && p->P.ncol > 0)
        RITZ_CHECK(add_dampers(p, F->ncol, point));
    *out = measure_residual(p, F->ncol, point);
    return RITZ_OK;
}

/*
 * N_0 = max of 1 / |1 + b s + t z| over t = 1 / (lambda + mu),
 * 0 <= t <= 1 / (lowest + mu): the inverse of the distance of a line segment
 * in the complex plane from 0.
 */
static double amplify(const ritz_projected *p, const frequency_point *point)
{
    double _Complex from = 1.0 + p->b * point->s;
    double square = creal(point->z * conj(point->z));
    double t = square > 0.0 ? -creal(conj(point->z) * from) / square : 0.0;

    t = fmin(fmax(t, 0.0), 1.0 / (p->lowest + p->mu));
    return 1.0 / cabs(from + t * point->z);
}

static ritz_status bound_at(const ritz_projected *p, double omega,
                            frequency_point *point, double *bound)
{
    double in = 0.0, seen = 0.0, dampers = 0.0, most = 0.0, N = 0.0;

    set_frequency(p, omega, point);
    N = amplify(p, point);
    RITZ_CHECK(find_residual(p, &p->B, NULL, true, point, &in));
    RITZ_CHECK(find_residual(p, &p->C, &p->Cv, true, point, &seen));
    RITZ_CHECK(find_residual(p, &p->P, NULL, false, point, &dampers));
    for (int64_t i = 0; i < p->P.ncol; i++)
        most = fmax(most, p->c[i]);
    N += N * N * dampers * dampers * omega * most;
    RITZ_REFUSE_IF(!isfinite(in * seen * N), RITZ_ERR_CONVERGENCE,
                   "the residual of a projected model is not finite");
    *bound = fmax(*bound, in * seen * N);
    return RITZ_OK;
}

ritz_status ritz_projected_bound(const ritz_projected *projected, double *out)
{
    enum { BEYOND = 4 }; /* octaves sampled above and below all modes */
    const ritz_projected *p = projected;
    RITZ_OWN(frequency_point) point = {0};
    double bound = 0.0;

    if (p->count > 0 && p->L.nrow > 0) {
        double last = sqrt(p->lambda[p->count - 1]);

        RITZ_CHECK(allocate_point(p, &point));
        for (int k = 1; k <= BEYOND; k++) {
            RITZ_CHECK(bound_at(p, ldexp(last, k), &point, &bound));
            RITZ_CHECK(
                bound_at(p, ldexp(sqrt(p->lambda[0]), -k), &point, &bound));
        }
    }
    for (int64_t k = 0; k < p->count && p->L.nrow > 0; k++) {
        double omega = sqrt(p->lambda[k]);

        RITZ_CHECK(bound_at(p, omega, &point, &bound));
        if (k + 1 < p->count)
            RITZ_CHECK(bound_at(p, sqrt(omega * sqrt(p->lambda[k + 1])), &point,
                                &bound));
    }
    *out = bound;
    return RITZ_OK;
}
