/*
 * The static response of the modes that are left out to forces F. With the kept
 * modes Phi, Psi solves
 *
 *     K Psi = G,  G = F - M Phi Phi' F,    Phi' M Psi = 0
 *
 * and is found from one definite factor of A = K + s M, s > 0, by
 *
 *     Psi <- A^-1 (G + s M Psi),
 *
 * which contracts by s / (lambda + s) for every mode lambda that was left out.
 * F' Psi = Psi' K Psi is the residual flexibility: columns that are dependent
 * by it, or negligible relative to the flexibility of the kept modes, are
 * removed.
 */
#include "bases/free_modes.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/loads.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_SWEEPS = 60 };

/*
 * A shift below the first flexible mode contracts fast and makes A well
 * conditioned. If that mode is not kept, it is found for this; if there is
 * none, the shift is of the scale of the matrices.
 */
static ritz_status choose_shift(const ritz_component *component,
                                const ritz_pairs *modes, double *out)
{
    const ritz_span one = {.modes = 1};
    double K = ritz_sparse_max(&component->K);
    double M = ritz_sparse_max(&component->M);
    RITZ_OWN(ritz_pairs) first = {0};
    const ritz_pairs *known = modes;

    if (modes->Phi.ncol == modes->num_rigid) {
        RITZ_CHECK_IN(
            "first flexible mode",
            ritz_eigen_sparse(&component->K, &component->M, &one, &first));
        known = &first;
    }
    if (known->Phi.ncol > known->num_rigid)
        *out = RITZ_SHIFT_OF_FIRST * known->lambda[known->num_rigid];
    else
        *out = K > 0.0 && M > 0.0 ? RITZ_SHIFT_OF_SIZE * K / M : 1.0;
    return RITZ_OK;
}

/* An upper bound of the kept flexible modes' static response to load j. */
static double bound_response(const ritz_pairs *modes, const ritz_dense *F,
                             int64_t j)
{
    double most = 0.0;

    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++)
        most = fmax(most, ritz_dense_col_max(&modes->Phi, k) *
                              fabs(ritz_dense_dot(&modes->Phi, k, F, j)) /
                              modes->lambda[k]);
    return most;
}

/*
 * One step of the iteration; *change is the largest change of a column relative
 * to its size. A column smaller than least[j] is rounding, and its change is
 * relative to least[j].
 */
static ritz_status iterate_residual(ritz_factor *A, const ritz_sparse *M,
                                    double s, const ritz_dense *G,
                                    const double *least, ritz_dense *Psi,
                                    double *change)
{
    RITZ_OWN(ritz_dense) next = {0};

    RITZ_CHECK(ritz_sparse_mul(M, Psi, &next));
    for (int64_t k = 0; k < G->nrow * G->ncol; k++)
        next.val[k] = G->val[k] + s * next.val[k];
    RITZ_CHECK(ritz_factor_solve(A, &next));
    *change = 0.0;
    for (int64_t j = 0; j < G->ncol; j++) {
        const double *now = ritz_dense_col(&next, j);
        const double *before = ritz_dense_col(Psi, j);
        double moved = 0.0;
        double size = least[j];

        for (int64_t i = 0; i < G->nrow; i++) {
            moved = fmax(moved, fabs(now[i] - before[i]));
            size = fmax(size, fabs(now[i]));
        }
        if (size > 0.0)
            *change = fmax(*change, moved / size);
    }
    ritz_dense_replace(Psi, &next);
    return RITZ_OK;
}

/*
 * The response of A to each load at the load itself, and the size below which
 * its column is rounding.
 */
static ritz_status find_scales(const ritz_free_set *set, double tolerance,
                               ritz_factor *A, double *own, double *least)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_copy(&set->F, &X));
    RITZ_CHECK(ritz_factor_solve(A, &X));
    for (int64_t j = 0; j < X.ncol; j++) {
        own[j] = ritz_dense_dot(&set->F, j, &X, j);
        least[j] = fmax(tolerance * bound_response(&set->modes, &set->F, j),
                        RITZ_FORCE_RELIEVED * ritz_dense_col_max(&X, j));
    }
    return RITZ_OK;
}

/* Psi, and the response of A to each load at the load itself. */
static ritz_status find_residual(const ritz_request *request,
                                 ritz_free_set *set, double *response)
{
    const ritz_sparse *M = &request->component->M;
    const ritz_dense *Phi = &set->modes.Phi;
    const double settled = RITZ_SWEEPS_SETTLED * sqrt((double)M->nrow);
    double s = 0.0;
    double change = 1.0, best = HUGE_VAL;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) MPhi = {0}, G = {0};
    RITZ_OWN_ARRAY double *least = NULL;

    RITZ_CHECK_NEW(least, set->F.ncol);
    RITZ_CHECK(choose_shift(request->component, &set->modes, &s));
    RITZ_CHECK(ritz_sparse_add(1.0, &request->component->K, s, M, &A));
    RITZ_CHECK_IN("shifted stiffness", ritz_factor_spd(&A, &L));
    RITZ_CHECK(find_scales(set, request->tolerance, L, response, least));
    RITZ_CHECK(ritz_sparse_mul(M, Phi, &MPhi));
    RITZ_CHECK(ritz_dense_copy(&set->F, &G));
    RITZ_CHECK(ritz_dense_take_out(&MPhi, Phi, &G));
    RITZ_CHECK(ritz_dense_take_out(&MPhi, Phi, &G)); /* twice is enough */
    RITZ_CHECK(ritz_dense_new(G.nrow, G.ncol, &set->Psi));
    for (int k = 0; k < MOST_SWEEPS && change > settled; k++) {
        RITZ_CHECK(iterate_residual(L, M, s, &G, least, &set->Psi, &change));
        RITZ_CHECK(ritz_dense_take_out(Phi, &MPhi, &set->Psi));
        if (k > 8 && change > 0.5 * best)
            break; /* rounding, not contraction, is what is left */
        best = fmin(best, change);
    }
    RITZ_REFUSE_IF(change > RITZ_SWEEPS_UNSETTLED, RITZ_ERR_CONVERGENCE,
                   "residual attachment modes still change by %.1e", change);
    return RITZ_OK;
}

/* Flexibility F' Phi_f Lambda_f^-1 Phi_f' F of the kept modes for load j. */
static double kept_flexibility(const ritz_free_set *set, int64_t j)
{
    const ritz_pairs *modes = &set->modes;
    double sum = 0.0;

    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++) {
        double x = ritz_dense_dot(&modes->Phi, k, &set->F, j);

        sum += x * x / modes->lambda[k];
    }
    return sum;
}

/*
 * Independent columns by pivoted Cholesky of R = F' Psi scaled to a unit
 * diagonal: the square of what is new in a column must exceed the tolerance. Of
 * pivots that are equal to six digits the first is taken, so that the choice
 * does not depend on a processor's rounding. keep[j] says whether column j
 * stays; R is destroyed.
 */
static void choose_columns(ritz_dense *R, double tolerance, bool *keep)
{
    int64_t a = R->ncol;

    for (;;) {
        int64_t pivot = -1;
        double *column = NULL;
        double d = tolerance;

        for (int64_t j = 0; j < a; j++)
            if (!keep[j] && ritz_dense_col(R, j)[j] >
                                (pivot < 0 ? d : RITZ_PIVOT_TIE * d)) {
                pivot = j;
                d = ritz_dense_col(R, j)[j];
            }
        if (pivot < 0)
            return;
        keep[pivot] = true;
        column = ritz_dense_col(R, pivot);
        for (int64_t j = 0; j < a; j++) {
            double factor = ritz_dense_col(R, j)[pivot] / d;

            for (int64_t i = 0; i < a && j != pivot; i++)
                ritz_dense_col(R, j)[i] -= factor * column[i];
        }
    }
}

/* Mark the residual modes that are independent and more than rounding. */
static ritz_status choose_independent(const double *response, double tolerance,
                                      ritz_free_set *set)
{
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN_ARRAY double *scale = NULL;

    RITZ_CHECK_NEW(scale, set->Psi.ncol);
    RITZ_CHECK(ritz_dense_mul_tn(&set->F, &set->Psi, &R));
    for (int64_t j = 0; j < R.ncol; j++) {
        double own = ritz_dense_col(&R, j)[j];
        double all = own + kept_flexibility(set, j);

        if (own > tolerance * all && own > RITZ_FORCE_RELIEVED * response[j])
            scale[j] = 1.0 / sqrt(own);
    }
    for (int64_t j = 0; j < R.ncol; j++)
        for (int64_t i = 0; i < R.ncol; i++)
            ritz_dense_col(&R, j)[i] *= scale[i] * scale[j];
    ritz_dense_symmetrise(&R);
    choose_columns(&R, tolerance, set->keep);
    return RITZ_OK;
}

/*
 * The basis of free-interface methods: with the lowest modes of (K, M), rigid
 * ones first, and residual modes of loads F,
 *
 *     K Phi = M Phi Lambda,   Phi' M Phi = I,
 *     K Psi = (I - M Phi Phi') F,   Phi' M Psi = 0,   T = [Phi, Psi]
 *
 * so that T'KT and T'MT are block diagonal, and the flexible static response to
 * F at the loaded dofs is exact.
 */

ritz_status ritz_free_set_find(const ritz_request *request, int loads,
                               ritz_free_set *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = {request->modes, request->up_to_hz};
    RITZ_OWN(ritz_free_set) set = {.loads = loads};
    RITZ_OWN(ritz_dofs) rest = {0};
    RITZ_OWN_ARRAY double *response = NULL;

    /* refuses attached dofs that are out of range or repeated */
    RITZ_CHECK(
        ritz_dofs_complement(&request->attached, component->num_dofs, &rest));
    RITZ_CHECK(ritz_lowest_modes("free-interface modes", "K", &component->K,
                                 &component->M, &span, &set.modes));
    if (ritz_loads_count(request, loads) > 0) {
        RITZ_CHECK(ritz_loads_collect(request, loads, &set.F, &set.dof));
        RITZ_CHECK_NEW(set.keep, set.F.ncol);
        RITZ_CHECK_NEW(response, set.F.ncol);
        RITZ_CHECK(find_residual(request, &set, response));
        RITZ_CHECK(choose_independent(response, request->tolerance, &set));
        for (int64_t j = 0; j < set.Psi.ncol; j++)
            set.kept += set.keep[j];
    }
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out)
{
    int64_t k = set->modes.Phi.ncol;
    char name[RITZ_LOADS_NAME_SIZE] = "";

    RITZ_CHECK(ritz_basis_of_modes(&set->modes, set->kept, out));
    for (int64_t j = 0; j < set->Psi.ncol; j++) {
        const ritz_dense column = ritz_dense_part(&set->Psi, j, 1);

        if (!set->keep[j] && !name[0])
            ritz_loads_name(request, set->loads, j, name);
        if (!set->keep[j])
            continue;
        out->columns.kind[k] = kind;
        out->columns.dof[k] = set->dof[j];
        ritz_dense_put(&column, 0, k++, &out->T);
    }
    if (set->kept < set->Psi.ncol)
        ritz_remark_add(out, "; ",
                        "%" PRId64 " %s mode(s) left out, the first of %s: "
                        "dependent, or negligible relative to the kept modes",
                        set->Psi.ncol - set->kept, ritz_column_name(kind),
                        name);
    return RITZ_OK;
}

ritz_status ritz_free_basis(const ritz_request *request, int loads,
                            ritz_column_kind kind, ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};

    RITZ_CHECK(ritz_free_set_find(request, loads, &set));
    return ritz_free_set_join(request, &set, kind, out);
}

void ritz_free_set_free(ritz_free_set *set)
{
    ritz_pairs_free(&set->modes);
    ritz_dense_free(&set->F);
    ritz_dense_free(&set->Psi);
    RITZ_FREE(set->dof, set->keep);
    *set = (ritz_free_set){0};
}
