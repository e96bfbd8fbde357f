/*
 * An averaged port: its grid is the average of its dofs, q = A u, and so that q
 * can be held, six of these depend on it and the others,
 *
 *     A_p u_p + A_r u_r = q,    u_p = A_p^-1 (q - A_r u_r)
 *
 * chosen by QR with column pivoting, which keeps A_p^-1 small. Where the dofs
 * depend on others already, A stands for A G. What ports hold is not chosen.
 */
#include "import/import_tied.h"

#include "base/alloc.h"

#include <lapacke.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

enum { SIX = 6 };

/* The average over dofs that depend on nothing: A G, and what its columns
 * are; those that a port holds come last. */
typedef struct reach {
    ritz_dense A; /* 6 x k, scaled so that lengths cancel */
    int64_t num_free;
    ritz_dof *dof;
} reach;

/* Columns of A G that are not zero, of dofs held or not, from `first` on;
 * place[j]: column of j there. */
static int64_t place_columns(const ritz_tied *it, const ritz_sparse *turned,
                             const int64_t *row, bool held, int64_t first,
                             int64_t *place)
{
    const ritz_tying *tying = it->tying;

    for (int64_t i = 0; i < it->average.A.ncol; i++)
        for (int64_t p = turned->colptr[row[i]]; p < turned->colptr[row[i] + 1];
             p++) {
            int64_t j = turned->rowind[p];
            int64_t k = tying->by.kept.at[j];

            if (!tying->fixed[k] && it->held[k] == held && place[j] < 0)
                place[j] = first++;
        }
    return first;
}

static void spread(const ritz_tied *it, const ritz_sparse *turned,
                   const int64_t *row, const int64_t *place, reach *out)
{
    const ritz_average *average = &it->average;
    const ritz_tying *tying = it->tying;

    for (int64_t i = 0; i < average->A.ncol; i++)
        for (int64_t p = turned->colptr[row[i]]; p < turned->colptr[row[i] + 1];
             p++) {
            int64_t j = place[turned->rowind[p]];
            ritz_dof dof =
                tying->names.dof[tying->by.kept.at[turned->rowind[p]]];
            double share =
                turned->val[p] / ritz_tie_scale(dof, average->length);

            if (j < 0)
                continue;
            out->dof[j] = dof;
            for (int k = 0; k < SIX; k++)
                ritz_dense_col(&out->A, j)[k] +=
                    share * ritz_dense_col(&average->A, i)[k] *
                    (k < 3 ? 1.0 : average->length);
        }
}

static ritz_status substitute(const ritz_tied *it, const ritz_sparse *turned,
                              reach *out)
{
    ritz_status status = RITZ_OK;
    const ritz_tying *tying = it->tying;
    int64_t count = it->average.A.ncol;
    int64_t *row = NULL, *place = NULL;
    int64_t found = 0;
    ritz_roster roster = {0};

    RITZ_NEW(row, count);
    RITZ_NEW(place, tying->by.kept.count);
    RITZ_TRY(ritz_roster_new(tying->names.count, tying->names.dof, &roster));
    for (int64_t i = 0; i < count; i++)
        row[i] = ritz_roster_row(&roster, it->average.dof[i]);
    for (int64_t j = 0; j < tying->by.kept.count; j++)
        place[j] = -1;
    out->num_free = place_columns(it, turned, row, false, 0, place);
    found = place_columns(it, turned, row, true, out->num_free, place);
    RITZ_NEW(out->dof, found);
    RITZ_TRY(ritz_dense_new(SIX, found, &out->A));
    spread(it, turned, row, place, out);
done:
    free(row);
    free(place);
    ritz_roster_free(&roster);
    return status;
}

/* Motions that the first columns of A leave open, by its triangular factor. */
static int64_t count_open(const ritz_dense *A)
{
    double rcond = 0.0;
    int64_t rank = 0;

    (void)LAPACKE_dtrcon(LAPACK_COL_MAJOR, '1', 'U', 'N', SIX, A->val, SIX,
                         &rcond);
    if (rcond > 1.5e-8) /* as of positions: half the digits are lost */
        return 0;
    while (rank < SIX - 1 &&
           fabs(ritz_dense_col(A, rank)[rank]) > 1.5e-8 * fabs(A->val[0]))
        rank++;
    return SIX - rank;
}

static ritz_status check_open(const reach *over, int64_t open)
{
    if (open == 0)
        return RITZ_OK;
    if (over->num_free == over->A.ncol)
        return ritz_tied_refuse(open);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "six of its dofs are to depend on it, and without those "
                     "that other ports hold %" PRId64 " motions are left open: "
                     "name more of them",
                     open);
}

/* A := Q' A with A_p = Q R in front, by pivoting among the free columns. */
static ritz_status factor(reach *over, lapack_int *order, double *tau)
{
    ritz_dense *A = &over->A;
    int64_t k = over->num_free;

    RITZ_CHECK(check_open(over, k < SIX ? SIX - k : 0));
    for (int64_t j = k; j < A->ncol; j++)
        order[j] = (lapack_int)j + 1;
    RITZ_REFUSE_IF(LAPACKE_dgeqp3(LAPACK_COL_MAJOR, SIX, (lapack_int)k, A->val,
                                  SIX, order, tau) != 0,
                   RITZ_ERR_MEMORY, "no memory for the average");
    if (A->ncol > k)
        RITZ_REFUSE_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'T', SIX,
                                      (lapack_int)(A->ncol - k), SIX, A->val,
                                      SIX, tau, ritz_dense_col(A, k), SIX) != 0,
                       RITZ_ERR_MEMORY, "no memory for the average");
    return check_open(over, count_open(A));
}

/* X = R_p^-1 [Q', -R_r]: u_p = X [q; u_r]. */
static ritz_status pivot(reach *over, lapack_int *order, ritz_dense *X)
{
    const ritz_dense *A = &over->A;
    lapack_int k = (lapack_int)A->ncol;
    double tau[SIX];

    RITZ_CHECK(factor(over, order, tau));
    RITZ_CHECK(ritz_dense_new(SIX, k, X));
    for (int64_t j = 0; j < SIX; j++)
        ritz_dense_col(X, j)[j] = 1.0;
    RITZ_REFUSE_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'T', SIX, SIX, SIX,
                                  A->val, SIX, tau, X->val, SIX) != 0,
                   RITZ_ERR_MEMORY, "no memory for the average");
    for (int64_t j = SIX; j < k; j++)
        for (int64_t i = 0; i < SIX; i++)
            ritz_dense_col(X, j)[i] = -ritz_dense_col(A, j)[i];
    RITZ_REFUSE_IF(LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'U', 'N', 'N', SIX, k,
                                  A->val, SIX, X->val, SIX) != 0,
                   RITZ_ERR_SINGULAR, "the average is singular");
    return RITZ_OK;
}

static ritz_status put(const ritz_tied *it, const ritz_dense *X,
                       const ritz_dof *dof, const lapack_int *order)
{
    ritz_equations *eq = &it->deck->equations;
    double length = it->average.length;

    for (int64_t i = 0; i < SIX; i++) {
        ritz_dof dependent = dof[order[i] - 1];
        double most = 0.0;

        RITZ_CHECK(ritz_equations_begin(eq, dependent));
        for (int64_t j = 0; j < X->ncol; j++)
            most = fmax(most, fabs(ritz_dense_col(X, j)[i]));
        for (int64_t j = 0; j < X->ncol; j++) {
            ritz_dof of =
                j < SIX ? (ritz_dof){it->id, j + 1} : dof[order[j] - 1];
            double share = ritz_dense_col(X, j)[i];

            if (fabs(share) > RITZ_TIE_ROUNDING * most)
                RITZ_CHECK(
                    ritz_equations_add(eq, of,
                                       share * ritz_tie_scale(of, length) /
                                           ritz_tie_scale(dependent, length)));
        }
    }
    return RITZ_OK;
}

ritz_status ritz_tied_average(const ritz_tied *it, const ritz_sparse *turned)
{
    ritz_status status = RITZ_OK;
    reach over = {0};
    ritz_dense X = {0};
    lapack_int *order = NULL;

    RITZ_TRY(substitute(it, turned, &over));
    RITZ_NEW(order, over.A.ncol);
    RITZ_TRY(pivot(&over, order, &X));
    RITZ_TRY(ritz_tied_cite(it));
    RITZ_TRY(put(it, &X, over.dof, order));
done:
    free(over.dof);
    free(order);
    ritz_dense_free(&over.A);
    ritz_dense_free(&X);
    return status;
}
