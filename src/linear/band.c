/*
 * Tests compare with eigenpairs of random band matrices by LAPACK.
 */
#include "linear/band.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/*
 * The number of eigenvalues above x: of positive pivots of T - x = L D L',
 * column by column, without exchange of rows. `room` holds what the columns so
 * far have
 * left of the next width + 1 columns, column j in slot j modulo width + 1.
 */
static int64_t count_above(const ritz_band *T, double x, double *room)
{
    const int64_t ld = T->width + 1;
    int64_t count = 0;

    memset(room, 0, (size_t)(ld * ld) * sizeof *room);
    for (int64_t j = 0; j < T->n; j++) {
        double *c = room + j % ld * ld;
        const int64_t end = T->n - j < ld ? T->n - j : ld;

        for (int64_t i = 0; i < end; i++)
            c[i] += T->val[j * ld + i];
        c[0] -= x;
        count += c[0] > 0.0;
        if (c[0] == 0.0)
            c[0] = -DBL_EPSILON * x;
        for (int64_t k = 1; k < end; k++) {
            double *next = room + (j + k) % ld * ld;
            const double part = c[k] / c[0];

            for (int64_t i = k; i < end; i++)
                next[i - k] -= part * c[i];
        }
        memset(c, 0, (size_t)ld * sizeof *c);
    }
    return count;
}

ritz_status ritz_band_kth(const ritz_band *T, int64_t k, double *theta,
                          bool *exists)
{
    RITZ_OWN_ARRAY double *room = NULL;
    double low = *theta;
    double high = low;
    double growth = RITZ_KTH_WITHIN;

    RITZ_CHECK_NEW(room, (T->width + 1) * (T->width + 1));
    *exists = low > 0.0 && count_above(T, low, room) >= k;
    *theta = 0.0;
    if (!*exists)
        return RITZ_OK;
    do {
        low = high;
        growth *= 4.0;
        high *= 1.0 + growth;
    } while (count_above(T, high, room) >= k);
    while (high > low * (1.0 + RITZ_KTH_WITHIN)) {
        const double middle = sqrt(low * high);

        if (count_above(T, middle, room) >= k)
            low = middle;
        else
            high = middle;
    }
    *theta = low;
    return RITZ_OK;
}

/* LU := T - theta, as dgbtrf reads it. */
static void spread_band(const ritz_band *T, double theta, double *LU)
{
    const int64_t w = T->width;
    const int64_t ld = 3 * w + 1;

    for (int64_t j = 0; j < T->n; j++)
        for (int64_t i = 0; i <= w && j + i < T->n; i++) {
            const double value =
                T->val[j * (w + 1) + i] - (i == 0 ? theta : 0.0);

            LU[2 * w + i + j * ld] = value;
            LU[2 * w - i + (j + i) * ld] = value;
        }
}

ritz_status ritz_band_vector(const ritz_band *T, double theta, double *z)
{
    const int n = (int)T->n;
    const int w = (int)T->width;
    const int ld = 3 * w + 1;
    const int64_t diagonal = 2 * T->width;
    RITZ_OWN_ARRAY double *LU = NULL;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    uint64_t seed = 1986;

    RITZ_CHECK_NEW(LU, T->n * ld);
    RITZ_CHECK_NEW(pivot, T->n);
    spread_band(T, theta, LU);
    if (LAPACKE_dgbtrf(LAPACK_COL_MAJOR, n, n, w, w, LU, ld, pivot) > 0)
        for (int64_t j = 0; j < T->n; j++) /* theta is an eigenvalue: move it */
            if (LU[diagonal + j * ld] == 0.0)
                LU[diagonal + j * ld] = DBL_EPSILON * fabs(theta);
    for (int64_t i = 0; i < T->n; i++)
        z[i] = ritz_general_noise(&seed);
    for (int k = 0; k < 2; k++) {
        LAPACKE_dgbtrs(LAPACK_COL_MAJOR, 'N', n, w, w, 1, LU, ld, pivot, z, n);
        cblas_dscal(n, 1.0 / cblas_dnrm2(n, z, 1), z, 1);
    }
    return RITZ_OK;
}
