/* Modes and constant matrices of a body for Exudyn. */
#include "formats/exudyn.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"

#include <ritz/matrix.h>

#include <math.h>
#include <string.h>

/* ---- modes -------------------------------------------------------------- */

/*
 * Which modes of a reduced component its body has beside a moving frame.
 *
 * The frame brings rigid-body motion; a mode that is rigid too would make the
 * mass matrix of the whole singular. MacNeal-Rubin bases mark rigid columns;
 * in others, as of Craig-Bampton, rigid motion lies in combinations of columns,
 * and the eigenvectors of (K_r, M_r) without stiffness are left out.
 */

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

static double dot_product(int64_t n, const double *x, const double *y)
{
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

/*
 * Take from x its part along the columns of a set, twice, which makes it
 * orthogonal to rounding; returns |x| after over |x| before, 0 of nothing.
 */
static double remove_part(const ritz_orthonormal *set, double *x)
{
    int64_t n = set->V.nrow;
    double before = sqrt(dot_product(n, x, x));

    for (int64_t j = 0; j < 2 * set->count; j++) {
        const double *q = ritz_dense_col(&set->V, j % set->count);
        double part = dot_product(n, q, x);

        for (int64_t i = 0; i < n; i++)
            x[i] -= part * q[i];
    }
    return before > 0.0 ? sqrt(dot_product(n, x, x)) / before : 0.0;
}

/* Refuse motions T Z that are not those of a rigid body. */
static ritz_status demand_rigid(const ritz_reduced *reduced,
                                const ritz_dense *Z)
{
    const ritz_component body = {.num_dofs = reduced->num_dofs,
                                 .dof = reduced->dof,
                                 .grids = reduced->grids};
    RITZ_OWN(ritz_dense) R = {0}, U = {0};
    RITZ_OWN(ritz_orthonormal) rigid = {0};

    RITZ_CHECK(ritz_rigid_geometry(&body, reduced->inertia.centre, &R));
    RITZ_CHECK(ritz_dense_mul(&reduced->T, Z, &U));
    RITZ_CHECK(
        ritz_orthonormal_new(R.nrow, NULL, RITZ_ROTATION_ON_A_LINE, &rigid));
    RITZ_CHECK(ritz_orthonormal_append(&rigid, &R, R.ncol, NULL));
    for (int64_t j = 0; j < U.ncol; j++)
        RITZ_REFUSE_IF(remove_part(&rigid, ritz_dense_col(&U, j)) >
                           RITZ_LOOSE_IN_FRAME,
                       RITZ_ERR_ARGUMENT,
                       "of %lld motions without stiffness number %lld is not "
                       "that of a rigid body: a part is loose, and a moving "
                       "frame cannot follow it",
                       (long long)U.ncol, (long long)j + 1);
    return RITZ_OK;
}

static ritz_status project_matrices(const ritz_reduced *reduced,
                                    exudyn_modes *modes)
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
    RITZ_OWN(exudyn_modes) kept = {.kept = true};
    RITZ_OWN(ritz_dense) Z = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(select_columns(&reduced->columns, true, &Z));
    RITZ_CHECK(select_columns(&reduced->columns, false, &kept.V));
    if (Z.ncol == 0 || kept.V.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(project_matrices(reduced, &kept));
    RITZ_CHECK(ritz_eigen_dense(&kept.K, &kept.M, &pairs));
    if (pairs.num_rigid > 0 || pairs.Phi.ncol < kept.V.ncol)
        return RITZ_OK;
    RITZ_CHECK(demand_rigid(reduced, &Z));
    kept.num_rigid = Z.ncol;
    note_band(&pairs, &kept);
    RITZ_MOVE(*modes, kept);
    return RITZ_OK;
}

static ritz_status diagonalise_body(const ritz_reduced *reduced,
                                    exudyn_modes *modes)
{
    RITZ_OWN(ritz_dense) Z = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(&reduced->K, &reduced->M, &pairs));
    RITZ_REFUSE_IF(pairs.num_rigid == pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                   "no mode is flexible: a rigid body needs no file, but mass "
                   "and inertia");
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &Z));
    RITZ_CHECK(demand_rigid(reduced, &Z));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, pairs.num_rigid,
                                  pairs.Phi.ncol - pairs.num_rigid, &modes->V));
    RITZ_CHECK(project_matrices(reduced, modes));
    modes->num_rigid = pairs.num_rigid;
    note_band(&pairs, modes);
    return RITZ_OK;
}

ritz_status exudyn_modes_of(const ritz_reduced *reduced, exudyn_modes *out)
{
    RITZ_OWN(exudyn_modes) modes = {0};

    RITZ_CHECK(keep_columns(reduced, &modes));
    if (!modes.V.val)
        RITZ_CHECK(diagonalise_body(reduced, &modes));
    RITZ_MOVE(*out, modes);
    return RITZ_OK;
}

void exudyn_modes_free(exudyn_modes *modes)
{
    ritz_dense_free(&modes->V);
    ritz_dense_free(&modes->K);
    ritz_dense_free(&modes->M);
    *modes = (exudyn_modes){0};
}

/* ---- constant matrices -------------------------------------------------- */

/*
 * Exudyn's constant matrices from inertia invariants. With skew(v) w = v x w,
 * x a node's place, psi_k its motion in mode k, and sums over all pairs of
 * nodes with their mass m, block k of columns (or of rows) is
 *
 *     mPsiTildePsi        skew(psi_k)' m psi_l   =  psi_l x psi_k
 *     mPsiTildePsiTilde   skew(psi_k)' m skew(psi_l)
 *                                     =  (psi_k . psi_l) I - psi_l psi_k'
 *     mXRefTildePsi       skew(x)' m psi_l       =  -(x x psi_l)
 *     mXRefTildePsiTilde  skew(x)' m skew(psi_l) =  (x . psi_l) I - psi_l x'
 *     mPhitTPsi           m psi_l
 *     mPhitTPsiTilde      m skew(psi_l)
 *
 * [ZwolferGerstmayr2021]. Of a body whose grids rotate, what does not change
 * with deformation is taken from all of M: mass, inertia, and the momenta
 * R'M Psi. The equations of motion keep momentum only if the other terms agree
 * with these: m skew(psi_l) must be skew of the linear momentum S_l, and of
 * (x . psi) I - psi x' the antisymmetric part must belong to the angular
 * momentum C_l; so they are set. For solids both are identities.
 */

/* The permutation symbol e_abc. */
static double permutation(int a, int b, int c)
{
    return (a - b) * (b - c) * (c - a) / 2.0;
}

/* skew(v)_ab = -e_abc v_c, put at column `col`. */
static void put_skew(const double *v, int64_t col, ritz_dense *out)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double sum = 0.0;

            for (int c = 0; c < 3; c++)
                sum -= permutation(a, b, c) * v[c];
            ritz_dense_col(out, col + b)[a] = sum;
        }
}

static void put_rigid(const ritz_invariants *of, const ritz_inertia *inertia,
                      exudyn_terms *t)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            ritz_dense_col(&t->Mtt, b)[a] = of->rigid[a + 6 * b];
            ritz_dense_col(&t->inertiaLocal, b)[a] =
                of->rigid[a + 3 + 6 * (b + 3)];
        }
    put_skew(inertia->centre, 0, &t->chiUtilde);
}

static void put_momenta(const ritz_invariants *of, exudyn_terms *t)
{
    for (int64_t l = 0; l < of->momentum.ncol; l++) {
        const double *momentum = ritz_dense_col(&of->momentum, l);

        for (int a = 0; a < 3; a++) {
            ritz_dense_col(&t->mPhitTPsi, l)[a] = momentum[a];
            ritz_dense_col(&t->mXRefTildePsi, l)[a] = -momentum[3 + a];
        }
        put_skew(momentum, 3 * l, &t->mPhitTPsiTilde);
    }
}

/* (x . psi_l) I - sym(psi_l x') - skew(C_l) / 2 */
static void put_first_order(const ritz_invariants *of, exudyn_terms *t)
{
    int64_t m = of->momentum.ncol;

    for (int64_t l = 0; l < m; l++) {
        double *C = ritz_dense_col(&of->momentum, l) + 3;
        double trace = 0.0;

        put_skew(C, 3 * l, &t->mXRefTildePsiTilde);
        for (int a = 0; a < 3; a++)
            trace += ritz_dense_col(&of->position, a * m + l)[a];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                double *at =
                    &ritz_dense_col(&t->mXRefTildePsiTilde, 3 * l + b)[a];
                double x_psi = ritz_dense_col(&of->position, b * m + l)[a] +
                               ritz_dense_col(&of->position, a * m + l)[b];

                *at = (a == b ? trace : 0.0) - (x_psi + *at) / 2.0;
            }
    }
}

/* mPsiTildePsi and mPsiTildePsiTilde of one pair of modes. */
static void put_pair(const ritz_dense *product, int64_t m, int64_t k, int64_t l,
                     exudyn_terms *t)
{
    double P[3][3]; /* psi_k, axis a, times psi_l, axis b */

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            P[a][b] = ritz_dense_col(product, b * m + l)[a * m + k];
    for (int b = 0; b < 3; b++) {
        int c = (b + 1) % 3;
        int d = (b + 2) % 3;

        ritz_dense_col(&t->mPsiTildePsi, l)[3 * k + b] = P[d][c] - P[c][d];
        for (int f = 0; f < 3; f++)
            ritz_dense_col(&t->mPsiTildePsiTilde, 3 * l + f)[3 * k + b] =
                (b == f ? P[0][0] + P[1][1] + P[2][2] : 0.0) - P[f][b];
    }
}

ritz_status exudyn_terms_of(const ritz_invariants *invariants,
                            const ritz_inertia *inertia, exudyn_terms *out)
{
    int64_t m = invariants->momentum.ncol;
    RITZ_OWN(exudyn_terms) t = {0};

    RITZ_CHECK(ritz_dense_new(3, 3, &t.inertiaLocal));
    RITZ_CHECK(ritz_dense_new(3, 3, &t.Mtt));
    RITZ_CHECK(ritz_dense_new(3, 3, &t.chiUtilde));
    RITZ_CHECK(ritz_dense_new(3 * m, m, &t.mPsiTildePsi));
    RITZ_CHECK(ritz_dense_new(3 * m, 3 * m, &t.mPsiTildePsiTilde));
    RITZ_CHECK(ritz_dense_new(3, m, &t.mPhitTPsi));
    RITZ_CHECK(ritz_dense_new(3, 3 * m, &t.mPhitTPsiTilde));
    RITZ_CHECK(ritz_dense_new(3, m, &t.mXRefTildePsi));
    RITZ_CHECK(ritz_dense_new(3, 3 * m, &t.mXRefTildePsiTilde));
    put_rigid(invariants, inertia, &t);
    put_momenta(invariants, &t);
    put_first_order(invariants, &t);
    for (int64_t l = 0; l < m; l++)
        for (int64_t k = 0; k < m; k++)
            put_pair(&invariants->product, m, k, l, &t);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

void exudyn_terms_free(exudyn_terms *terms)
{
    ritz_dense_free(&terms->inertiaLocal);
    ritz_dense_free(&terms->Mtt);
    ritz_dense_free(&terms->chiUtilde);
    ritz_dense_free(&terms->mPsiTildePsi);
    ritz_dense_free(&terms->mPsiTildePsiTilde);
    ritz_dense_free(&terms->mPhitTPsi);
    ritz_dense_free(&terms->mPhitTPsiTilde);
    ritz_dense_free(&terms->mXRefTildePsi);
    ritz_dense_free(&terms->mXRefTildePsiTilde);
    *terms = (exudyn_terms){0};
}
