/*
 * Averages of dofs: the rigid motion q = [t; r] nearest to them,
 *
 *     min_q |W^1/2 (S q - u)|,    q = A u,  A = V Sigma^-1 U' W^1/2
 *     W^1/2 S = U Sigma V'
 *
 * so that A S = I for all motions that the dofs can tell, and the forces A' f
 * at them are those that a force f at the point is spread to: S' A' f = f.
 */
#include "base/tolerances.h"
#include "model/ties.h"

#include "base/alloc.h"

#include <lapacke.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIX = 6 };

static void weigh(const ritz_ties *over, ritz_dense *S)
{
    int64_t at = 0;

    for (int64_t k = 0; k < over->count; k++)
        for (int64_t c = 1; c <= SIX; c++) {
            if (!ritz_tie_has(&over->tie[k], c))
                continue;
            for (int64_t j = 0; j < SIX; j++)
                ritz_dense_col(S, j)[at] *= sqrt(over->tie[k].weight);
            at++;
        }
}

/* Rows of V' without a singular value. */
static void list_loose(int64_t rank, const double *Vt, ritz_average *out)
{
    for (int64_t k = rank; k < SIX; k++)
        for (int64_t i = 0; i < SIX; i++)
            out->loose[SIX * (k - rank) + i] = Vt[k + SIX * i];
    out->num_loose = SIX - rank;
}

/* A = V Sigma^-1 U' W^1/2, of dofs and motions as they are. */
static ritz_status multiply(const ritz_ties *over, const ritz_dense *U,
                            int64_t rank, const double *sigma, const double *Vt,
                            ritz_average *out)
{
    int64_t at = 0;

    RITZ_CHECK(ritz_dense_new(SIX, U->nrow, &out->A));
    for (int64_t k = 0; k < over->count; k++)
        for (int64_t c = 1; c <= SIX; c++) {
            double scale = c > 3 ? out->length : 1.0;
            double *col = NULL;

            if (!ritz_tie_has(&over->tie[k], c))
                continue;
            col = ritz_dense_col(&out->A, at);
            scale *= sqrt(over->tie[k].weight);
            for (int64_t m = 0; m < rank; m++)
                for (int64_t i = 0; i < SIX; i++)
                    col[i] += Vt[m + SIX * i] / sigma[m] *
                              ritz_dense_col(U, m)[at] *
                              (i < 3 ? scale : scale / out->length);
            at++;
        }
    return RITZ_OK;
}

ritz_status ritz_average_new(const ritz_grids *grids, const ritz_ties *over,
                             const double origin[static 3], ritz_average *out)
{
    ritz_status status = RITZ_OK;
    ritz_average new = {0};
    int64_t count = ritz_ties_dofs(over);
    lapack_int least = (lapack_int)(count < SIX ? count : SIX);
    int64_t rank = 0;
    ritz_dense S = {0}, U = {0};
    double sigma[SIX], Vt[SIX * SIX] = {0}, work[SIX];

    RITZ_NEW(new.dof, count);
    RITZ_TRY(ritz_tie_length(grids, over, origin, &new.length));
    RITZ_TRY(ritz_dense_new(count, SIX, &S));
    RITZ_TRY(ritz_dense_new(count, SIX, &U));
    ritz_tie_rows(grids, over, origin, new.length, &S, new.dof);
    weigh(over, &S);
    for (int k = 0; k < SIX * SIX; k += SIX + 1)
        Vt[k] = 1.0;
    if (least > 0)
        RITZ_FAIL_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'S', 'A',
                                    (lapack_int)count, SIX, S.val,
                                    (lapack_int)count, sigma, U.val,
                                    (lapack_int)count, Vt, SIX, work) != 0,
                     RITZ_ERR_CONVERGENCE,
                     "singular values of the average do not converge");
    while (rank < least && sigma[rank] > RITZ_LOOSE_MOTION * sigma[0])
        rank++;
    list_loose(rank, Vt, &new);
    RITZ_TRY(multiply(over, &U, rank, sigma, Vt, &new));
    *out = new;
    new = (ritz_average){0};
done:
    ritz_dense_free(&S);
    ritz_dense_free(&U);
    ritz_average_free(&new);
    return status;
}

bool ritz_average_tells(const ritz_average *average, const double row[static 6])
{
    double scaled[SIX];
    double norm = 0.0;

    for (int i = 0; i < SIX; i++) {
        scaled[i] = i < 3 ? row[i] : row[i] / average->length;
        norm = hypot(norm, scaled[i]);
    }
    for (int64_t k = 0; k < average->num_loose; k++) {
        double part = 0.0;

        for (int64_t i = 0; i < SIX; i++)
            part += scaled[i] * average->loose[SIX * k + i];
        /* a loose motion is known to eps over the gap, RITZ_LOOSE_MOTION */
        if (fabs(part) > RITZ_LOOSE_PART * norm)
            return false;
    }
    return true;
}

void ritz_average_free(ritz_average *average)
{
    free(average->dof);
    ritz_dense_free(&average->A);
    *average = (ritz_average){0};
}
