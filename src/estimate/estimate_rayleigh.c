/*
 * D as a M + b K, if it is that to rounding: least squares over the diagonals
 * d, m, k, by Gram-Schmidt, once more of what it leaves, and then held to every
 * entry.
 */
#include "estimate/estimate_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* Of sqrt(d_ii d_jj): rounding of matrices printed with 15 digits. */
static const double within = 1e-13;
enum { PASSES = 3 };

typedef struct sums {
    double mm, mk, md;
} sums;

/* Entry j of m, k and of d - a m - b k. */
static void entry(const ritz_component *full, const double ab[2], int64_t j,
                  double out[3])
{
    out[0] = ritz_sparse_diagonal(&full->M, j);
    out[1] = ritz_sparse_diagonal(&full->K, j);
    out[2] =
        ritz_sparse_diagonal(&full->D, j) - ab[0] * out[0] - ab[1] * out[1];
}

/* One pass: a and b get better. */
static void improve(const ritz_component *full, double ab[2])
{
    sums s = {0};
    double kk = 0.0, kd = 0.0, b = 0.0;
    double e[3];

    for (int64_t j = 0; j < full->num_dofs; j++) {
        entry(full, ab, j, e);
        s.mm += e[0] * e[0];
        s.mk += e[0] * e[1];
        s.md += e[0] * e[2];
    }
    for (int64_t j = 0; j < full->num_dofs && s.mm > 0.0; j++) {
        double k = 0.0;

        entry(full, ab, j, e);
        k = e[1] - s.mk / s.mm * e[0];
        kk += k * k;
        kd += k * e[2];
    }
    b = kk > 0.0 ? kd / kk : 0.0;
    if (s.mm > 0.0)
        ab[0] += (s.md - s.mk * b) / s.mm;
    ab[1] += b;
}

/* A soft row is held to what is soft, however stiff others are. */
static ritz_status vanishes(const ritz_component *full, const double ab[2],
                            const ritz_sparse *rest, bool *out)
{
    ritz_status status = RITZ_OK;
    double *size = NULL;
    bool all = true;

    RITZ_NEW(size, full->num_dofs);
    for (int64_t j = 0; j < full->num_dofs; j++)
        size[j] =
            sqrt(within * (fabs(ritz_sparse_diagonal(&full->D, j)) +
                           fabs(ab[0] * ritz_sparse_diagonal(&full->M, j)) +
                           fabs(ab[1] * ritz_sparse_diagonal(&full->K, j))));
    for (int64_t j = 0; j < rest->ncol; j++)
        for (int64_t p = rest->colptr[j]; p < rest->colptr[j + 1]; p++)
            all = all && fabs(rest->val[p]) <= size[rest->rowind[p]] * size[j];
    *out = all;
done:
    free(size);
    return status;
}

ritz_status ritz_rayleigh_of(const ritz_component *full, double *a, double *b,
                             bool *found)
{
    ritz_status status = RITZ_OK;
    ritz_sparse part = {0};
    ritz_sparse rest = {0};
    double ab[2] = {0.0, 0.0};
    double k_size = ritz_sparse_max(&full->K);
    double m_size = ritz_sparse_max(&full->M);
    double most = 0.0;

    *found = false;
    if (!full->D.colptr || full->K4.colptr)
        return RITZ_OK;
    most = within * ritz_sparse_max(&full->D);
    for (int pass = 0; pass < PASSES; pass++)
        improve(full, ab);
    RITZ_TRY(ritz_sparse_add(1.0, &full->D, -ab[0], &full->M, &part));
    RITZ_TRY(ritz_sparse_add(1.0, &part, -ab[1], &full->K, &rest));
    RITZ_TRY(vanishes(full, ab, &rest, found));
    *found = *found && ab[0] * m_size >= -most && ab[1] * k_size >= -most;
    *a = fmax(ab[0], 0.0);
    *b = fmax(ab[1], 0.0);
done:
    ritz_sparse_free(&part);
    ritz_sparse_free(&rest);
    return status;
}
