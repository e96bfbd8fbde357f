/*
 * Rigid motion of dofs. A point at d from the origin moves by t + r x d, so
 * that along an axis a
 *
 *     u = a . t + (d x a) . r,    a rotation about it is a . r
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/equations.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

ritz_status ritz_ties_add(ritz_ties *list, ritz_tie tie)
{
    RITZ_CHECK_ROOM(list->tie, list->count, list->room);
    list->tie[list->count++] = tie;
    return RITZ_OK;
}

int64_t ritz_ties_dofs(const ritz_ties *list)
{
    int64_t count = 0;

    for (int64_t k = 0; k < list->count; k++)
        for (int64_t c = 1; c <= 6; c++)
            count += ritz_tie_has(&list->tie[k], c);
    return count;
}

void ritz_ties_free(ritz_ties *list)
{
    free(list->tie);
    *list = (ritz_ties){0};
}

void ritz_tie_row(const ritz_grids *grids, int64_t grid, int64_t c,
                  const double origin[static 3], double out[static 6])
{
    const double *a = grids->axes + 9 * grids->frame[grid] + 3 * ((c - 1) % 3);
    double d[3];

    for (int i = 0; i < 3; i++)
        d[i] = grids->position[3 * grid + i] - origin[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        out[i] = c > 3 ? 0.0 : a[i];
        out[3 + i] = c > 3 ? a[i] : d[j] * a[k] - d[k] * a[j];
    }
}

static int compare_ties(const void *left, const void *right)
{
    const ritz_tie *a = left;
    const ritz_tie *b = right;

    return (a->grid > b->grid) - (a->grid < b->grid);
}

static ritz_status mean_distance(const ritz_grids *grids, const ritz_ties *list,
                                 const double origin[static 3], double *out)
{
    RITZ_OWN_ARRAY ritz_tie *sorted = NULL;
    double sum = 0.0;
    int64_t count = 0;

    RITZ_CHECK_NEW(sorted, list->count);
    for (int64_t k = 0; k < list->count; k++)
        sorted[k] = list->tie[k];
    qsort(sorted, (size_t)list->count, sizeof *sorted, compare_ties);
    for (int64_t k = 0; k < list->count; k++) {
        const double *x = grids->position + 3 * sorted[k].grid;

        if (k > 0 && sorted[k].grid == sorted[k - 1].grid)
            continue;
        sum +=
            hypot(hypot(x[0] - origin[0], x[1] - origin[1]), x[2] - origin[2]);
        count++;
    }
    *out = sum > 0.0 ? sum / (double)count : 1.0;
    return RITZ_OK;
}

/* ---- rigid bodies ------------------------------------------------------ */

/* Factor of u(grid, i) in a dof that moves by `row` about the grid itself. */
static double share_of(const ritz_grids *grids, int64_t grid, int64_t i,
                       const double row[static 6])
{
    const double *a = grids->axes + 9 * grids->frame[grid] + 3 * ((i - 1) % 3);
    const double *part = row + (i > 3 ? 3 : 0);

    return a[0] * part[0] + a[1] * part[1] + a[2] * part[2];
}

static ritz_status follow_grid(const ritz_grids *grids, int64_t leader,
                               const ritz_ties *to, ritz_equations *equations)
{
    const double *origin = grids->position + 3 * leader;
    double row[6];

    for (int64_t k = 0; k < to->count; k++)
        for (int64_t c = 1; c <= 6; c++) {
            if (!ritz_tie_has(&to->tie[k], c))
                continue;
            ritz_tie_row(grids, to->tie[k].grid, c, origin, row);
            RITZ_CHECK(ritz_equations_begin(
                equations, (ritz_dof){grids->id[to->tie[k].grid], c}));
            for (int64_t i = 1; i <= 6; i++)
                RITZ_CHECK(ritz_equations_add(equations,
                                              (ritz_dof){grids->id[leader], i},
                                              share_of(grids, leader, i, row)));
        }
    return RITZ_OK;
}

static void scale_rows(const ritz_grids *grids, const ritz_ties *list,
                       const double origin[static 3], double length,
                       ritz_dense *S, ritz_dof *dof)
{
    int64_t at = 0;
    double row[6];

    for (int64_t k = 0; k < list->count; k++)
        for (int64_t c = 1; c <= 6; c++) {
            if (!ritz_tie_has(&list->tie[k], c))
                continue;
            dof[at] = (ritz_dof){grids->id[list->tie[k].grid], c};
            ritz_tie_row(grids, list->tie[k].grid, c, origin, row);
            for (int64_t j = 0; j < 6; j++)
                ritz_dense_col(S, j)[at] = (j < 3 ? row[j] : row[j] / length) *
                                           ritz_tie_scale(dof[at], length);
            at++;
        }
}

/* X' = S_m S_n^-1 by S_n' X = S_m', dofs scaled so that lengths cancel. */
static ritz_status solve_rigid(ritz_dense *S_n, const ritz_dense *S_m,
                               ritz_dense *X)
{
    lapack_int pivot[6];
    lapack_int count = (lapack_int)S_m->nrow;
    double size = LAPACKE_dlange(LAPACK_COL_MAJOR, 'I', 6, 6, S_n->val, 6);
    double rcond = 0.0;

    RITZ_CHECK(ritz_dense_new(6, S_m->nrow, X));
    for (int64_t j = 0; j < S_m->nrow; j++)
        for (int64_t i = 0; i < 6; i++)
            ritz_dense_col(X, j)[i] = ritz_dense_col(S_m, i)[j];
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, 6, 6, S_n->val, 6, pivot) == 0)
        (void)LAPACKE_dgecon(LAPACK_COL_MAJOR, 'I', 6, S_n->val, 6, size,
                             &rcond);
    RITZ_REFUSE_IF(
        !(rcond > RITZ_HALF_DIGITS), RITZ_ERR_SINGULAR,
        "the independent dofs leave it free to move as a rigid body");
    if (count > 0)
        RITZ_REFUSE_IF(LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'T', 6, count, S_n->val,
                                      6, pivot, X->val, 6) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
    return RITZ_OK;
}

static ritz_status put_rows(const ritz_dense *X, double length,
                            const ritz_dof *from, const ritz_dof *to,
                            ritz_equations *equations)
{
    for (int64_t j = 0; j < X->ncol; j++) {
        const double *share = ritz_dense_col(X, j);
        double most = 0.0;

        for (int64_t i = 0; i < 6; i++)
            most = fmax(most, fabs(share[i]));
        RITZ_CHECK(ritz_equations_begin(equations, to[j]));
        for (int64_t i = 0; i < 6; i++)
            if (fabs(share[i]) > RITZ_TIE_ROUNDING * most)
                RITZ_CHECK(ritz_equations_add(
                    equations, from[i],
                    share[i] * ritz_tie_scale(from[i], length) /
                        ritz_tie_scale(to[j], length)));
    }
    return RITZ_OK;
}

ritz_status ritz_tie_rigid(const ritz_grids *grids, const ritz_ties *from,
                           const ritz_ties *to, ritz_equations *equations)
{
    const double *origin = grids->position + 3 * from->tie[0].grid;
    double length = 0.0;
    int64_t count = ritz_ties_dofs(to);
    RITZ_OWN(ritz_dense) S_n = {0}, S_m = {0}, X = {0};
    ritz_dof leaders[6];
    RITZ_OWN_ARRAY ritz_dof *names = NULL;

    /* all six dofs of one grid: with its axes as rows of A, [t; r] = A' u */
    if (from->count == 1 && from->tie[0].mask == 0x7e)
        return follow_grid(grids, from->tie[0].grid, to, equations);
    RITZ_CHECK(mean_distance(grids, from, origin, &length));
    RITZ_CHECK_NEW(names, count);
    RITZ_CHECK(ritz_dense_new(6, 6, &S_n));
    RITZ_CHECK(ritz_dense_new(count, 6, &S_m));
    scale_rows(grids, from, origin, length, &S_n, leaders);
    scale_rows(grids, to, origin, length, &S_m, names);
    RITZ_CHECK(solve_rigid(&S_n, &S_m, &X));
    return put_rows(&X, length, leaders, names, equations);
}

/*
 * Averages of dofs: the rigid motion q = [t; r] nearest to them,
 *
 *     min_q |W^1/2 (S q - u)|,    q = A u,  A = V Sigma^-1 U' W^1/2
 *     W^1/2 S = U Sigma V'
 *
 * so that A S = I for all motions that the dofs determine, and the forces A' f
 * at them are those that a force f at the point is spread to: S' A' f = f.
 */

enum { SIX = 6 };

static void weigh_rows(const ritz_ties *over, ritz_dense *S)
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

/* Rows of V' beyond the rank span the motions that dofs leave loose. */
static void list_loose(int64_t rank, const double *Vt, ritz_average *out)
{
    for (int64_t k = rank; k < SIX; k++)
        for (int64_t i = 0; i < SIX; i++)
            out->loose[SIX * (k - rank) + i] = Vt[k + SIX * i];
    out->num_loose = SIX - rank;
}

/* A = V Sigma^-1 U' W^1/2, with the scaling of dofs and motions undone. */
static ritz_status multiply_average(const ritz_ties *over, const ritz_dense *U,
                                    int64_t rank, const double *sigma,
                                    const double *Vt, ritz_average *out)
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
    RITZ_OWN(ritz_average) new = {0};
    int64_t count = ritz_ties_dofs(over);
    lapack_int least = (lapack_int)(count < SIX ? count : SIX);
    int64_t rank = 0;
    RITZ_OWN(ritz_dense) S = {0}, U = {0};
    double sigma[SIX], Vt[SIX * SIX] = {0}, work[SIX];

    RITZ_CHECK_NEW(new.dof, count);
    RITZ_CHECK(mean_distance(grids, over, origin, &new.length));
    RITZ_CHECK(ritz_dense_new(count, SIX, &S));
    RITZ_CHECK(ritz_dense_new(count, SIX, &U));
    scale_rows(grids, over, origin, new.length, &S, new.dof);
    weigh_rows(over, &S);
    for (int k = 0; k < SIX * SIX; k += SIX + 1)
        Vt[k] = 1.0;
    if (least > 0)
        RITZ_REFUSE_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'S', 'A',
                                      (lapack_int)count, SIX, S.val,
                                      (lapack_int)count, sigma, U.val,
                                      (lapack_int)count, Vt, SIX, work) != 0,
                       RITZ_ERR_CONVERGENCE,
                       "singular values of the average do not converge");
    while (rank < least && sigma[rank] > RITZ_HALF_DIGITS * sigma[0])
        rank++;
    list_loose(rank, Vt, &new);
    RITZ_CHECK(multiply_average(over, &U, rank, sigma, Vt, &new));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
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
        /* a loose motion is known to eps over the gap, RITZ_HALF_DIGITS */
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
