/*
 * Bases of free-interface modes with fewer modes, from one with more. With the
 * modes m + 1 .. N of a macneal-rubin basis T_N = [Phi_N, Psi_N],
 *
 *     Psi_m = Psi_N + sum_k phi_k phi_k' F / lambda_k,   m < k <= N
 *
 * so that T_m = T_N V, where V picks the first m modes and adds the others to
 * the residual modes: a candidate costs projections of K_N and M_N, and no
 * factor. With Psi_bb = F' Psi_m and Phi_b = F' Phi_m the basis of rubin is
 * T_N [G, V_Phi - G Phi_b], G = V_Psi Psi_bb^-1.
 *
 * Held to: bases of trusses that are made for each number of modes, in
 * tests/unit/fit/test_fit_family.c.
 */
#include "bases/free_set.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

/* A basis with more modes, and the part of it that is asked for. */
typedef struct narrowing {
    const ritz_reduced *wide;
    int64_t modes;        /* that are kept, rigid ones among them */
    int64_t residuals;    /* columns of Psi */
    const int64_t *mode;  /* their columns in the wide basis, ascending */
    const int64_t *first; /* columns of Psi there */
    ritz_dense F;         /* T_N' F, wide x residuals: rows of T_N */
    ritz_dense Psi;       /* V_Psi, wide x residuals */
} narrowing;

static void narrowing_free(narrowing *n)
{
    ritz_dense_free(&n->F);
    ritz_dense_free(&n->Psi);
}

static bool is_residual(const ritz_reduced *wide, int64_t j)
{
    return wide->columns.kind[j] == RITZ_COLUMN_RESIDUAL;
}

/* Modes come first in the list, as in the basis, and then residual modes. */
static void divide_list(const ritz_reduced *wide, int64_t count,
                        const int64_t *at, narrowing *n)
{
    n->wide = wide;
    while (n->modes < count && !is_residual(wide, at[n->modes]))
        n->modes++;
    n->residuals = count - n->modes;
    n->mode = at;
    n->first = at + n->modes;
}

/* phi_k'f_j of unit forces: entries of T_N. */
static ritz_status find_forces(narrowing *n)
{
    const ritz_dense *T = &n->wide->T;

    RITZ_CHECK(ritz_dense_new(T->ncol, n->residuals, &n->F));
    for (int64_t j = 0; j < n->residuals; j++) {
        const int64_t dof = n->wide->columns.dof[n->first[j]];

        for (int64_t k = 0; k < T->ncol; k++)
            ritz_dense_col(&n->F, j)[k] = ritz_dense_col(T, k)[dof];
    }
    return RITZ_OK;
}

/* V_Psi: the residual modes of the wide basis, and the modes that are not kept
   by their flexibility. */
static ritz_status add_flexibility(narrowing *n)
{
    const ritz_reduced *wide = n->wide;
    int64_t next = 0;

    RITZ_CHECK(ritz_dense_new(wide->K.ncol, n->residuals, &n->Psi));
    for (int64_t k = 0; k < wide->K.ncol; k++) {
        const double lambda = ritz_dense_col(&wide->K, k)[k];

        if (next < n->modes && n->mode[next] == k) {
            next++;
            continue;
        }
        for (int64_t j = 0; j < n->residuals && !is_residual(wide, k); j++)
            ritz_dense_col(&n->Psi, j)[k] =
                ritz_dense_col(&n->F, j)[k] / lambda;
    }
    for (int64_t j = 0; j < n->residuals; j++)
        ritz_dense_col(&n->Psi, j)[n->first[j]] = 1.0;
    return RITZ_OK;
}

/* Whether a basis of fewer modes would keep all residual modes too: with more
   flexibility that several forces share, some may depend on others. */
static ritz_status check_independent(const narrowing *n, double tolerance,
                                     bool *independent)
{
    const ritz_reduced *wide = n->wide;
    RITZ_OWN_ARRAY double *least = NULL;
    RITZ_OWN_ARRAY bool *keep = NULL;
    int64_t kept = 0;

    RITZ_CHECK_NEW(least, n->residuals);
    RITZ_CHECK_NEW(keep, n->residuals);
    for (int64_t j = 0; j < n->residuals; j++) {
        const double *f = ritz_dense_col(&n->F, j);

        least[j] = ritz_dense_dot(&n->F, j, &n->Psi, j);
        for (int64_t i = 0; i < n->modes; i++) {
            const int64_t k = n->mode[i];

            if (wide->columns.kind[k] == RITZ_COLUMN_NORMAL)
                least[j] += f[k] * f[k] / ritz_dense_col(&wide->K, k)[k];
        }
        least[j] *= tolerance;
    }
    RITZ_CHECK(
        ritz_statics_choose(&n->F, &n->Psi, least, tolerance, keep, &kept));
    *independent = kept == n->residuals;
    return RITZ_OK;
}

static ritz_status open_narrowing(const ritz_reduced *wide, int64_t count,
                                  const int64_t *at, double tolerance,
                                  narrowing *n, bool *independent)
{
    divide_list(wide, count, at, n);
    RITZ_CHECK(find_forces(n));
    RITZ_CHECK(add_flexibility(n));
    return check_independent(n, tolerance, independent);
}

ritz_status ritz_macneal_rubin_narrow(const ritz_reduced *wide, int64_t count,
                                      const int64_t *at, double tolerance,
                                      ritz_dense *V, ritz_columns *columns)
{
    RITZ_OWN(narrowing) n = {0};
    bool independent = false;

    RITZ_CHECK(open_narrowing(wide, count, at, tolerance, &n, &independent));
    if (!independent)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(wide->K.ncol, count, V));
    for (int64_t i = 0; i < n.modes; i++)
        ritz_dense_col(V, i)[n.mode[i]] = 1.0;
    ritz_dense_put(&n.Psi, 0, n.modes, V);
    return ritz_columns_pick(&wide->columns, count, at, columns);
}

/* G = V_Psi Psi_bb^-1, in the coordinates of the wide basis. */
static ritz_status divide_residuals(const narrowing *n, ritz_dense *G)
{
    const int64_t r = n->wide->K.ncol, p = n->residuals;
    RITZ_OWN(ritz_dense) tall = {0}, Psi_bb = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;

    RITZ_CHECK_NEW(row, p);
    for (int64_t j = 0; j < p; j++)
        row[j] = r + j;
    RITZ_CHECK(ritz_dense_mul_tn(&n->F, &n->Psi, &Psi_bb));
    RITZ_CHECK(ritz_dense_new(r + p, p, &tall));
    ritz_dense_put(&n->Psi, 0, 0, &tall);
    ritz_dense_put(&Psi_bb, r, 0, &tall);
    RITZ_CHECK(ritz_residual_divide(row, &tall));
    return ritz_dense_block(&tall, 0, r, 0, p, G);
}

/* Columns as make_rubin names them: attached dofs, then modes. */
static ritz_status label_columns(const narrowing *n, ritz_columns *columns)
{
    const ritz_columns *wide = &n->wide->columns;
    const int64_t p = n->residuals;
    RITZ_OWN(ritz_columns) made = {0};

    RITZ_CHECK(ritz_columns_new(p + n->modes, &made));
    for (int64_t j = 0; j < p; j++)
        ritz_columns_label_dofs(1, &wide->dof[n->first[j]], j, &made);
    for (int64_t i = 0; i < n->modes; i++) {
        const int64_t k = n->mode[i];

        made.kind[p + i] = RITZ_COLUMN_NORMAL;
        made.residual[p + i] = wide->residual[k];
        if (wide->kind[k] != RITZ_COLUMN_NORMAL)
            continue;
        made.hertz[p + i] = wide->hertz[k];
        if (wide->error)
            made.error[p + i] = wide->error[k];
    }
    RITZ_MOVE(*columns, made);
    return RITZ_OK;
}

ritz_status ritz_rubin_narrow(const ritz_reduced *wide, int64_t count,
                              const int64_t *at, double tolerance,
                              ritz_dense *V, ritz_columns *columns)
{
    RITZ_OWN(narrowing) n = {0};
    RITZ_OWN(ritz_dense) G = {0}, Phi_b = {0}, GPhi = {0};
    bool independent = false;

    RITZ_CHECK(open_narrowing(wide, count, at, tolerance, &n, &independent));
    if (!independent)
        return RITZ_OK;
    if (n.residuals == 0) /* no attached dof becomes a coordinate */
        return ritz_macneal_rubin_narrow(wide, count, at, tolerance, V,
                                         columns);
    RITZ_CHECK(divide_residuals(&n, &G));
    RITZ_CHECK(ritz_dense_new(n.residuals, n.modes, &Phi_b));
    for (int64_t i = 0; i < n.modes; i++)
        for (int64_t j = 0; j < n.residuals; j++)
            ritz_dense_col(&Phi_b, i)[j] = ritz_dense_col(&n.F, j)[n.mode[i]];
    RITZ_CHECK(ritz_dense_mul(&G, &Phi_b, &GPhi));
    RITZ_CHECK(ritz_dense_new(wide->K.ncol, count, V));
    ritz_dense_put(&G, 0, 0, V);
    for (int64_t i = 0; i < n.modes; i++) {
        double *v = ritz_dense_col(V, n.residuals + i);

        v[n.mode[i]] = 1.0;
        for (int64_t k = 0; k < V->nrow; k++)
            v[k] -= ritz_dense_col(&GPhi, i)[k];
    }
    return label_columns(&n, columns);
}
