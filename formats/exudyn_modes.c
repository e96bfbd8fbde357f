/*
 * Which modes of a reduced component its body has beside a moving frame.
 *
 * The frame brings rigid-body motion; a mode that is rigid too would make the
 * mass matrix of the whole singular. MacNeal-Rubin bases mark rigid columns;
 * in others, as of Craig-Bampton, rigid motion lies in combinations of columns,
 * and the eigenvectors of (K_r, M_r) without stiffness are left out.
 */
#include "formats/exudyn.h"

#include <ritz/eigen.h>

#include <math.h>
#include <string.h>

/* Columns of the identity: those of kind rigid, or the others. */
static ritz_status select_columns(const ritz_columns *columns, bool rigid,
                                  ritz_dense *out)
{
    int64_t count = 0;

    for (int64_t j = 0; j < columns->count; j++)
        count += (columns->kind[j] == RITZ_COLUMN_RIGID) == rigid;
    RITZ_CHECK(ritz_dense_new(columns->count, count, out));
    count = 0;
    for (int64_t j = 0; j < columns->count; j++)
        if ((columns->kind[j] == RITZ_COLUMN_RIGID) == rigid)
            ritz_dense_col(out, count++)[j] = 1.0;
    return RITZ_OK;
}

static double dot(int64_t n, const double *x, const double *y)
{
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

/*
 * Take from x its part along the first k columns of Q, twice, which makes it
 * orthogonal to rounding; returns |x| after over |x| before, 0 of nothing.
 */
static double remove_part(const ritz_dense *Q, int64_t k, double *x)
{
    int64_t n = Q->nrow;
    double before = sqrt(dot(n, x, x));

    for (int64_t j = 0; j < 2 * k; j++) {
        const double *q = ritz_dense_col(Q, j % k);
        double part = dot(n, q, x);

        for (int64_t i = 0; i < n; i++)
            x[i] -= part * q[i];
    }
    return before > 0.0 ? sqrt(dot(n, x, x)) / before : 0.0;
}

/* Orthonormal columns in front; how many there are. */
static int64_t orthonormalise(ritz_dense *R)
{
    int64_t k = 0;

    for (int64_t j = 0; j < R->ncol; j++) {
        double *x = ritz_dense_col(R, k);
        double norm = 0.0;

        memmove(x, ritz_dense_col(R, j), (size_t)R->nrow * sizeof *x);
        /* of grids on a line one rotation is no motion: it drops out */
        if (remove_part(R, k, x) < 1e-8)
            continue;
        norm = sqrt(dot(R->nrow, x, x));
        for (int64_t i = 0; i < R->nrow; i++)
            x[i] /= norm;
        k++;
    }
    return k;
}

/*
 * Motions T Z are those of a rigid body. The allowance of 1e-3 lies between
 * what matrices of six digits may do to a rigid mode (1e-5, a judgement) and
 * the order of 1 by which a loose part differs.
 */
static ritz_status demand_rigid(const ritz_reduced *reduced,
                                const ritz_dense *Z)
{
    ritz_status status = RITZ_OK;
    const ritz_component body = {.num_dofs = reduced->num_dofs,
                                 .dof = reduced->dof,
                                 .grids = reduced->grids};
    ritz_dense R = {0}, U = {0};
    int64_t k = 0;

    RITZ_TRY(ritz_rigid_geometry(&body, reduced->inertia.centre, &R));
    RITZ_TRY(ritz_dense_mul(&reduced->T, Z, &U));
    k = orthonormalise(&R);
    for (int64_t j = 0; j < U.ncol; j++)
        RITZ_FAIL_IF(remove_part(&R, k, ritz_dense_col(&U, j)) > 1e-3,
                     RITZ_ERR_ARGUMENT,
                     "of %lld motions without stiffness number %lld is not "
                     "that of a rigid body: a part is loose, and a moving "
                     "frame cannot follow it",
                     (long long)U.ncol, (long long)j + 1);
done:
    ritz_dense_free(&R);
    ritz_dense_free(&U);
    return status;
}

static ritz_status project(const ritz_reduced *reduced, exudyn_modes *modes)
{
    RITZ_CHECK(ritz_dense_congruence(&reduced->K, &modes->V, &modes->K));
    return ritz_dense_congruence(&reduced->M, &modes->V, &modes->M);
}

static void note_band(const ritz_pairs *pairs, exudyn_modes *modes)
{
    modes->lowest_hz = ritz_eigen_hertz(pairs->lambda[pairs->num_rigid]);
    modes->highest_hz = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
}

/* Columns of kind rigid are all of rigid motion: the others stay as they are.
 * `modes` is left empty if they are not. */
static ritz_status keep_columns(const ritz_reduced *reduced,
                                exudyn_modes *modes)
{
    ritz_status status = RITZ_OK;
    exudyn_modes kept = {.kept = true};
    ritz_dense Z = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(select_columns(&reduced->columns, true, &Z));
    RITZ_TRY(select_columns(&reduced->columns, false, &kept.V));
    if (Z.ncol == 0 || kept.V.ncol == 0)
        goto done;
    RITZ_TRY(project(reduced, &kept));
    RITZ_TRY(ritz_eigen_dense(&kept.K, &kept.M, &pairs));
    if (pairs.num_rigid > 0 || pairs.Phi.ncol < kept.V.ncol)
        goto done;
    RITZ_TRY(demand_rigid(reduced, &Z));
    kept.num_rigid = Z.ncol;
    note_band(&pairs, &kept);
    *modes = kept;
    kept = (exudyn_modes){0};
done:
    exudyn_modes_free(&kept);
    ritz_dense_free(&Z);
    ritz_pairs_free(&pairs);
    return status;
}

static ritz_status diagonalise(const ritz_reduced *reduced, exudyn_modes *modes)
{
    ritz_status status = RITZ_OK;
    ritz_dense Z = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_eigen_dense(&reduced->K, &reduced->M, &pairs));
    RITZ_FAIL_IF(pairs.num_rigid == pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                 "no mode is flexible: a rigid body needs no file, but mass "
                 "and inertia");
    RITZ_TRY(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &Z));
    RITZ_TRY(demand_rigid(reduced, &Z));
    RITZ_TRY(ritz_dense_columns(&pairs.Phi, pairs.num_rigid,
                                pairs.Phi.ncol - pairs.num_rigid, &modes->V));
    RITZ_TRY(project(reduced, modes));
    modes->num_rigid = pairs.num_rigid;
    note_band(&pairs, modes);
done:
    ritz_dense_free(&Z);
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status exudyn_modes_of(const ritz_reduced *reduced, exudyn_modes *out)
{
    ritz_status status = RITZ_OK;
    exudyn_modes modes = {0};

    RITZ_TRY(keep_columns(reduced, &modes));
    if (!modes.V.val)
        RITZ_TRY(diagonalise(reduced, &modes));
    *out = modes;
    modes = (exudyn_modes){0};
done:
    exudyn_modes_free(&modes);
    return status;
}

void exudyn_modes_free(exudyn_modes *modes)
{
    ritz_dense_free(&modes->V);
    ritz_dense_free(&modes->K);
    ritz_dense_free(&modes->M);
    *modes = (exudyn_modes){0};
}
