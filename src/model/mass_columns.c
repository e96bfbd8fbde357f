#include "model/mass_columns.h"

#include <float.h>
#include <math.h>
#include <string.h>

/*
 * Residual flexibility without mass: zero rows and columns in M and damping.
 */
static void clear_massless(const ritz_columns *columns, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            if (columns->kind[i] == RITZ_COLUMN_MASSLESS ||
                columns->kind[j] == RITZ_COLUMN_MASSLESS)
                ritz_dense_col(A, j)[i] = 0.0;
}

/* T of what has mass, for the invariants to be of the same body as M. */
ritz_status ritz_mass_columns(const ritz_basis *basis, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(&basis->T, out));
    for (int64_t j = 0; j < out->ncol; j++)
        if (basis->columns.kind[j] == RITZ_COLUMN_MASSLESS)
            memset(ritz_dense_col(out, j), 0,
                   (size_t)out->nrow * sizeof *out->val);
    return RITZ_OK;
}

/*
 * A column made of motions without mass alone has the mass of rounding. No
 * eigenvalue 1/eps times @p fast, which those with mass have at most, can be
 * told from an infinite one; fast 0: every motion has mass.
 */
static void settle_mass(double fast, const ritz_dense *K, ritz_dense *M)
{
    double limit = fast / DBL_EPSILON;

    for (int64_t j = 0; j < M->ncol && limit > 0.0; j++) {
        if (ritz_dense_col(K, j)[j] <= limit * fabs(ritz_dense_col(M, j)[j]))
            continue;
        for (int64_t i = 0; i < M->nrow; i++)
            ritz_dense_col(M, j)[i] = ritz_dense_col(M, i)[j] = 0.0;
    }
}

/* Largest K_jj / M_jj of dofs with mass; 0 if all of them have mass. */
static double fastest_dof(const ritz_component *component)
{
    double most = 0.0;
    bool any = false;

    for (int64_t j = 0; j < component->num_dofs; j++) {
        double m = ritz_sparse_diagonal(&component->M, j);

        if (m > 0.0)
            most = fmax(most, ritz_sparse_diagonal(&component->K, j) / m);
        else
            any = true;
    }
    return any ? most : 0.0;
}

void ritz_mass_settle(const ritz_component *component,
                      const ritz_columns *columns, ritz_reduced *reduced)
{
    settle_mass(fastest_dof(component), &reduced->K, &reduced->M);
    clear_massless(columns, &reduced->M);
    clear_massless(columns, &reduced->D);
}

/* Largest K_jj / M_jj of coordinates with mass; 0 if all of them have mass. */
static double fastest(const ritz_reduced *reduced)
{
    double most = 0.0;
    bool any = false;

    for (int64_t j = 0; j < reduced->M.ncol; j++) {
        double m = ritz_dense_col(&reduced->M, j)[j];

        if (m > 0.0)
            most = fmax(most, ritz_dense_col(&reduced->K, j)[j] / m);
        else
            any = true;
    }
    return any ? most : 0.0;
}

void ritz_mass_settle_again(const ritz_reduced *from, ritz_reduced *to)
{
    settle_mass(fastest(from), &to->K, &to->M);
}
