/*
 * The next shift of a rational Krylov space. In the static equation
 * (K + m M) x = F of a real shift m the projected solution leaves the residual
 *
 *     r(m) = -(m - mu) q L Theta (Lambda + m)^-1 Phi'F,
 *
 * which is 0 at the shifts whose solutions the space contains. The next shift
 * is where |r(m)| / |F| is largest [DruskinSimoncini2011]. Beyond the highest
 * frequency of the mesh the solution itself tends to 0, so that r is weighted
 * by top / (top + m), with the largest eigenvalue `top` of the projected model.
 */
#include "base/alloc.h"
#include "gramians/projection.h"

#include <math.h>

enum {
    POINTS = 128, /* shifts that are compared, in geometric progression */
    BEYOND = 30   /* the last one is so many times the largest eigenvalue */
};

/* The largest |r(m)| / |F| of the columns of F; r is working memory, p. */
static double measure_static(const ritz_projected *p, const ritz_dense *F,
                             double m, double *r)
{
    const int64_t rows = p->L.nrow;
    double most = 0.0;

    for (int64_t j = 0; j < F->ncol; j++) {
        const double *f = ritz_dense_col(F, j);
        double load = 0.0, sum = 0.0;

        for (int64_t i = 0; i < rows; i++)
            r[i] = 0.0;
        for (int64_t k = 0; k < p->count; k++) {
            const double *L = ritz_dense_col(&p->L, k);
            const double y = p->theta[k] * f[k] / (p->lambda[k] + m);

            load += p->theta[k] * f[k] * f[k];
            for (int64_t i = 0; i < rows; i++)
                r[i] += L[i] * y;
        }
        for (int64_t i = 0; i < rows; i++)
            sum += r[i] * r[i];
        if (load > 0.0)
            most = fmax(most, fabs(m - p->mu) * sqrt(sum / load));
    }
    return most;
}

ritz_status ritz_projected_shift(const ritz_projected *projected, double *shift,
                                 double *residual)
{
    const ritz_projected *p = projected;
    const ritz_dense *const loads[] = {&p->B, &p->C, &p->Cv, &p->P};
    const double top = p->lambda[p->count - 1];
    const double ratio = pow(BEYOND * top / p->lowest, 1.0 / (POINTS - 1));
    RITZ_OWN_ARRAY double *r = NULL;

    RITZ_CHECK_NEW(r, p->L.nrow);
    *shift = *residual = 0.0;
    for (int k = 0; k < POINTS; k++)
        for (int i = 0; i < 4; i++) {
            const double m = p->lowest * pow(ratio, k);
            const double at =
                measure_static(p, loads[i], m, r) * top / (top + m);

            if (at > *residual) {
                *residual = at;
                *shift = m;
            }
        }
    return RITZ_OK;
}
