/*
 * How large a free motion of a state space becomes before it dies. States have
 * no energy, and non-normal growth is no instability: what poles do not explain
 * is told, in units of states of the probe's own making.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/eigenvalues.h"
#include "linear/general.h"
#include "linear/split.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Of a state, per step: the error that integrators let pass unless they are
   told otherwise. What grows by more than its inverse is lost in it. */
static const double let_pass = 1e-3;

/*
 * Units of states are nobody's growth. They are scaled until what goes into
 * each is as large as what comes out of it; a coupling one way, which some
 * units make as small as one likes, has a floor to be held against.
 */
static ritz_status forget_units(ritz_dense *A)
{
    ritz_status status = RITZ_OK;
    int n = (int)A->nrow;
    double least = DBL_EPSILON * ritz_dense_max(A);
    ritz_dense sizes = {0};
    double *scale = NULL;
    lapack_int low = 0, high = 0;

    RITZ_NEW(scale, n);
    RITZ_TRY(ritz_dense_new(n, n, &sizes));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            if (i != j)
                ritz_dense_col(&sizes, j)[i] =
                    fmax(fabs(ritz_dense_col(A, j)[i]), least);
    if (n > 0)
        LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, sizes.val, n, &low, &high,
                       scale);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(A, j)[i] *= scale[j] / scale[i];
done:
    free(scale);
    ritz_dense_free(&sizes);
    return status;
}

/*
 * (|s| of the fastest pole over that of the slowest)^2: what a structure that
 * does not grow shows in displacements and velocities of one unit of time, as
 * a unit velocity of the slowest mode displaces it by 1 / |s|.
 */
static ritz_status spread(const ritz_dense *A, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_eigenvalues poles = {0};
    double fast = 0.0, slow = HUGE_VAL;

    RITZ_TRY(ritz_eigenvalues_of(A, &poles));
    for (int64_t k = 0; k < poles.count; k++) {
        double size = hypot(poles.re[k], poles.im[k]);

        fast = fmax(fast, size);
        slow = fmin(slow, size);
    }
    *out = poles.count > 0 && slow > 0.0 ? pow(fast / slow, 2.0) : 1.0;
done:
    ritz_eigenvalues_free(&poles);
    return status;
}

/* States have no energy: of their squares that is told which poles explain. */
ritz_status ritz_probe_growth_states(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    ritz_growth found = {0};
    ritz_dense A = {0};
    ritz_split split = {0};
    const ritz_dense none = {0};
    double explained = 1.0;

    RITZ_TRY(ritz_dense_copy(&it->space->A, &A));
    if (it->space->E.val)
        RITZ_TRY_IN("E", ritz_general_solve(&it->space->E, false, &A));
    RITZ_TRY(forget_units(&A));
    RITZ_TRY(ritz_split_new(&A, &none, &split));
    RITZ_TRY(ritz_growth_measure(&split.S, &found));
    RITZ_TRY(spread(&split.S, &explained));
    ritz_prober_growth(it, &found, explained / (let_pass * let_pass),
                       "square of scaled states");
done:
    ritz_split_free(&split);
    ritz_dense_free(&A);
    return status;
}
