/*
 * Where D is not a M + b K. Columns d, m, k of D, M and K at one dof give a and
 * b by the least squares of d = a m + b k; at a local damper these fit no other
 * dof. So a and b are computed at some dofs, spread over all, and those that
 * fit the most dofs are taken.
 */
#include "model/local_damping.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <stdlib.h>

/* Scalar products of the columns m, k and d of one dof. */
typedef struct column_products {
    double mm, kk, mk, md, kd, dd;
} column_products;

typedef struct proportion {
    double a, b;
} proportion;

/* x'y of column j of A and a column that is scattered. */
static double dot_column(const ritz_sparse *A, int64_t j, const double *x)
{
    double sum = 0.0;

    for (int64_t p = A->colptr ? A->colptr[j] : 0;
         A->colptr && p < A->colptr[j + 1]; p++)
        sum += A->val[p] * x[A->rowind[p]];
    return sum;
}

/* Put s times column j of A into x: 1, or 0 to clear it. */
static void scatter_column(const ritz_sparse *A, int64_t j, double s, double *x)
{
    for (int64_t p = A->colptr ? A->colptr[j] : 0;
         A->colptr && p < A->colptr[j + 1]; p++)
        x[A->rowind[p]] = s * A->val[p];
}

static ritz_status multiply_columns(const ritz_component *c,
                                    column_products *out)
{
    RITZ_OWN_ARRAY double *x = NULL;

    RITZ_CHECK_NEW(x, c->num_dofs);
    for (int64_t j = 0; j < c->num_dofs; j++) {
        column_products *p = &out[j];

        scatter_column(&c->M, j, 1.0, x);
        p->mm = dot_column(&c->M, j, x);
        p->mk = dot_column(&c->K, j, x);
        p->md = dot_column(&c->D, j, x);
        scatter_column(&c->M, j, 0.0, x);
        scatter_column(&c->K, j, 1.0, x);
        p->kk = dot_column(&c->K, j, x);
        p->kd = dot_column(&c->D, j, x);
        scatter_column(&c->K, j, 0.0, x);
        scatter_column(&c->D, j, 1.0, x);
        p->dd = dot_column(&c->D, j, x);
        scatter_column(&c->D, j, 0.0, x);
    }
    return RITZ_OK;
}

/* Least squares of one column; of parallel m and k the stiffness alone. */
static proportion fit_column(const column_products *p)
{
    const double det = p->mm * p->kk - p->mk * p->mk;

    if (det > RITZ_DAMPING_COUPLES * p->mm * p->kk)
        return (proportion){(p->kk * p->md - p->mk * p->kd) / det,
                            (p->mm * p->kd - p->mk * p->md) / det};
    if (p->kk > 0.0)
        return (proportion){0.0, p->kd / p->kk};
    return (proportion){p->mm > 0.0 ? p->md / p->mm : 0.0, 0.0};
}

/* Whether |d - a m - b k| is below six digits of its terms. */
static bool is_proportional(const column_products *p, proportion by)
{
    const double m = by.a * by.a * p->mm, k = by.b * by.b * p->kk;
    const double left = p->dd + m + k + 2.0 * by.a * by.b * p->mk -
                        2.0 * by.a * p->md - 2.0 * by.b * p->kd;

    return left <=
           RITZ_DAMPING_COUPLES * RITZ_DAMPING_COUPLES * (p->dd + m + k);
}

/* Columns that do not fit, and the first of them. */
static int64_t count_beyond(int64_t n, const column_products *p, proportion by,
                            int64_t *first)
{
    int64_t count = 0;

    *first = -1;
    for (int64_t j = 0; j < n; j++)
        if (!is_proportional(&p[j], by) && count++ == 0)
            *first = j;
    return count;
}

/* a and b that fit the most columns, and the columns that they do not fit. */
static ritz_status fit_columns(const ritz_component *component, proportion *by,
                               int64_t *count, int64_t *first)
{
    enum { TRIED = 32 };
    const int64_t n = component->num_dofs;
    RITZ_OWN_ARRAY column_products *products = NULL;

    *by = (proportion){0.0, 0.0};
    *count = 0;
    *first = -1;
    if (!component->D.colptr)
        return RITZ_OK;
    RITZ_CHECK_NEW(products, n);
    RITZ_CHECK(multiply_columns(component, products));
    *count = count_beyond(n, products, *by, first);
    for (int64_t t = 0; t < TRIED; t++) {
        const proportion tried = fit_column(&products[t * (n - 1) / TRIED]);
        int64_t at = -1;
        const int64_t beyond = count_beyond(n, products, tried, &at);

        if (beyond < *count) {
            *by = tried;
            *count = beyond;
            *first = at;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_damping_beyond(const ritz_component *component, int64_t *count,
                                int64_t *first)
{
    proportion by = {0.0, 0.0};

    return fit_columns(component, &by, count, first);
}

ritz_status ritz_damping_proportion(const ritz_component *component, double *a,
                                    double *b, bool *whole)
{
    proportion by = {0.0, 0.0};
    int64_t count = 0, first = -1;

    RITZ_CHECK(fit_columns(component, &by, &count, &first));
    *a = by.a;
    *b = by.b;
    *whole = count == 0;
    return RITZ_OK;
}
