/*
 * A body for Exudyn: the HDF5 file that its ObjectFFRFreducedOrderInterface
 * loads [Gerstmayr2023], as release 1.13.6 saves it. Nodes carry translations
 * only, along basic axes, and come in the order of grid ids.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "formats/exudyn.h"
#include "formats/sink.h"
#include "linear/orthonormal.h"
#include "model/inertia_terms.h"

#include <math.h>
#include <stdlib.h>
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

static void exudyn_modes_free(exudyn_modes *modes)
{
    ritz_dense_free(&modes->V);
    ritz_dense_free(&modes->K);
    ritz_dense_free(&modes->M);
    *modes = (exudyn_modes){0};
}

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

/* Refuse motions T Z that are not those of a rigid body. */
static ritz_status demand_rigid(const ritz_reduced *reduced,
                                const ritz_dense *Z)
{
    const ritz_component body = {.num_dofs = reduced->num_dofs,
                                 .dof = reduced->dof,
                                 .grids = reduced->grids};
    RITZ_OWN(ritz_dense) R = {0}, U = {0}, rest = {0};
    RITZ_OWN(ritz_orthonormal) rigid = {0};
    ritz_dense V = {0};

    RITZ_CHECK(ritz_rigid_geometry(&body, reduced->inertia.centre, &R));
    RITZ_CHECK(ritz_dense_mul(&reduced->T, Z, &U));
    RITZ_CHECK(ritz_dense_copy(&U, &rest));
    RITZ_CHECK(
        ritz_orthonormal_new(R.nrow, NULL, RITZ_ROTATION_ON_A_LINE, &rigid));
    RITZ_CHECK(ritz_orthonormal_append(&rigid, &R, R.ncol, NULL));
    V = ritz_dense_part(&rigid.V, 0, rigid.count);
    for (int twice = 0; twice < 2; twice++)
        RITZ_CHECK(ritz_dense_take_out(&V, &V, &rest));
    for (int64_t j = 0; j < U.ncol; j++)
        RITZ_REFUSE_IF(sqrt(ritz_dense_dot(&rest, j, &rest, j)) >
                           RITZ_LOOSE_IN_FRAME *
                               sqrt(ritz_dense_dot(&U, j, &U, j)),
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

/* Leave rigid-body motion to the moving frame: columns of kind rigid if those
 * make up all of it, eigenvectors of (K_r, M_r) otherwise. */
static ritz_status find_modes(const ritz_reduced *reduced, exudyn_modes *out)
{
    RITZ_OWN(exudyn_modes) modes = {0};

    RITZ_CHECK(keep_columns(reduced, &modes));
    if (!modes.V.val)
        RITZ_CHECK(diagonalise_body(reduced, &modes));
    RITZ_MOVE(*out, modes);
    return RITZ_OK;
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
 * [ZwolferGerstmayr2021]. What does not change with deformation is taken from
 * all of M: mass, inertia, and the momenta R'M Psi. The equations of motion
 * keep momentum only if the other terms agree with these: m skew(psi_l) must be
 * skew of the linear momentum S_l, and of (x . psi) I - psi x' the antisymmetric
 * part must belong to the angular momentum C_l; so they are set. Where the
 * invariants are exact, both are identities.
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

/* ---- the body ----------------------------------------------------------- */

void exudyn_body_free(exudyn_body *b)
{
    ritz_nodes_free(&b->nodes);
    free(b->dof);
    ritz_dense_free(&b->T);
    free(b->xRef);
    ritz_dense_free(&b->modeBasis);
    exudyn_modes_free(&b->modes);
    exudyn_terms_free(&b->terms);
    ritz_invariants_free(&b->invariants);
    *b = (exudyn_body){0};
}

static ritz_status check_parts(const ritz_reduced *reduced)
{
    RITZ_REFUSE_IF(
        !reduced->T.val || !reduced->dof, RITZ_ERR_ARGUMENT,
        "it was reduced --without-basis, which holds the shapes that "
        "the file needs");
    RITZ_REFUSE_IF(reduced->grids.count == 0, RITZ_ERR_ARGUMENT,
                   "no grid has a position: import with --bulk");
    RITZ_REFUSE_IF(!reduced->inertia.known, RITZ_ERR_ARGUMENT,
                   "the body has no mass");
    RITZ_REFUSE_IF(
        !reduced->invariants.momentum.val, RITZ_ERR_ARGUMENT,
        "it holds no invariants of inertia, which are kept of at most "
        "%d columns, and it has %lld",
        (int)RITZ_INVARIANT_COLUMNS, (long long)reduced->K.ncol);
    return RITZ_OK;
}

static ritz_status check_rows(const ritz_reduced *reduced)
{
    for (int64_t i = 0; i < reduced->num_dofs; i++) {
        ritz_dof dof = reduced->dof[i];

        RITZ_REFUSE_IF(dof.component == 0, RITZ_ERR_ARGUMENT,
                       "point %lld is a scalar point, which has no place in a "
                       "body that moves",
                       (long long)dof.grid);
        RITZ_REFUSE_IF(ritz_grids_find(&reduced->grids, dof.grid) < 0,
                       RITZ_ERR_ARGUMENT, "grid %lld has no position",
                       (long long)dof.grid);
    }
    return RITZ_OK;
}

/* An absent translation is zero along its axis, which must be a basic one. */
static ritz_status check_nodes(const ritz_nodes *nodes)
{
    RITZ_REFUSE_IF(nodes->count == 0, RITZ_ERR_ARGUMENT,
                   "no grid has a translation");
    for (int64_t k = 0; k < nodes->count; k++) {
        const int64_t *row = nodes->row + 3 * k;
        bool all = row[0] >= 0 && row[1] >= 0 && row[2] >= 0;

        RITZ_REFUSE_IF(!all && !ritz_axes_basic(ritz_nodes_axes(nodes, k)),
                       RITZ_ERR_ARGUMENT,
                       "grid %lld has axes of its own and brings only some of "
                       "its translations",
                       (long long)nodes->grids->id[nodes->grid[k]]);
    }
    return RITZ_OK;
}

/*
 * A grid that is only recovered may lack a translation, of which nothing is
 * known: it is left out.
 */
static void leave_partial(int64_t num_rows, ritz_nodes *nodes)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < nodes->count; k++) {
        const int64_t *row = nodes->row + 3 * k;
        bool own = false;
        bool all = true;

        for (int p = 0; p < 3; p++) {
            own = own || (row[p] >= 0 && row[p] < num_rows);
            all = all && row[p] >= 0;
        }
        if (!own && !all)
            continue;
        memmove(nodes->row + 3 * kept, row, 3 * sizeof *row);
        nodes->grid[kept++] = nodes->grid[k];
    }
    nodes->count = kept;
}

static ritz_status count_rotating(const ritz_grids *grids, exudyn_body *b)
{
    RITZ_OWN_ARRAY bool *turns = NULL;

    RITZ_CHECK_NEW(turns, grids->count);
    for (int64_t i = 0; i < b->num_dofs; i++) {
        int64_t k = b->dof[i].component > 3
                        ? ritz_grids_find(grids, b->dof[i].grid)
                        : -1;

        if (k < 0 || turns[k])
            continue;
        turns[k] = true;
        b->num_rotating++;
    }
    return RITZ_OK;
}

/* Where the nodes are, and Psi: rows x, y, z of each node. */
static ritz_status shape_modes(exudyn_body *b)
{
    int64_t n = b->nodes.count;
    RITZ_OWN(ritz_dense) Psi = {0}, along = {0};

    RITZ_CHECK_NEW(b->xRef, 3 * n);
    for (int64_t k = 0; k < n; k++)
        memcpy(b->xRef + 3 * k, b->nodes.grids->position + 3 * b->nodes.grid[k],
               3 * sizeof *b->xRef);
    RITZ_CHECK(ritz_dense_mul(&b->T, &b->modes.V, &Psi));
    RITZ_CHECK(ritz_dense_new(3 * n, Psi.ncol, &b->modeBasis));
    for (int a = 0; a < 3; a++) {
        ritz_dense_free(&along);
        RITZ_CHECK(ritz_nodes_along(&b->nodes, &Psi, a, &along));
        for (int64_t j = 0; j < Psi.ncol; j++)
            for (int64_t k = 0; k < n; k++)
                ritz_dense_col(&b->modeBasis, j)[3 * k + a] =
                    ritz_dense_col(&along, j)[k];
    }
    return RITZ_OK;
}

ritz_status exudyn_body_of(const ritz_reduced *reduced, exudyn_body *out)
{
    RITZ_OWN(exudyn_body) b = {0};

    RITZ_CHECK(check_parts(reduced));
    b.num_dofs = reduced->num_dofs + reduced->recovery.count;
    RITZ_CHECK(ritz_recovery_extend(&reduced->recovery, reduced->num_dofs,
                                    reduced->dof, &reduced->T, &b.dof, &b.T));
    RITZ_CHECK(check_rows(reduced));
    RITZ_CHECK(count_rotating(&reduced->grids, &b));
    RITZ_CHECK(ritz_nodes_of(b.num_dofs, b.dof, &reduced->grids, &b.nodes));
    leave_partial(reduced->num_dofs, &b.nodes);
    RITZ_CHECK(check_nodes(&b.nodes));
    RITZ_CHECK(find_modes(reduced, &b.modes));
    RITZ_CHECK(shape_modes(&b));
    RITZ_CHECK(ritz_invariants_project(&reduced->invariants, &b.modes.V,
                                       &b.invariants));
    RITZ_CHECK(exudyn_terms_of(&b.invariants, &reduced->inertia, &b.terms));
    RITZ_MOVE(*out, b);
    return RITZ_OK;
}

static ritz_status say_losses(const ritz_reduced *reduced, const exudyn_body *b,
                              ritz_export_report *report)
{
    ritz_inertia_loss loss = {0};
    const double *rigid = b->invariants.rigid;
    double m = reduced->inertia.mass;

    RITZ_CHECK(
        ritz_inertia_loss_of(&b->invariants, &b->modes.K, &b->modes.M, &loss));
    if (b->num_rotating > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "rotations of %lld grids left out: they count in all terms of "
            "inertia and stiffness, not in shapes",
            (long long)b->num_rotating));
    if (loss.value > RITZ_ENERGY_LOST)
        RITZ_CHECK(ritz_export_say(
            report,
            "invariants are approximate: mode %lld loses %.2g of its kinetic "
            "energy",
            (long long)loss.mode + 1, loss.value));
    if (fabs(rigid[0] - m) + fabs(rigid[7] - m) + fabs(rigid[14] - m) >
        RITZ_MASS_AGREES * m)
        RITZ_CHECK(ritz_export_say(report,
                                   "mass differs by direction, %.6g %.6g %.6g: "
                                   "are dofs fixed? Their mean is taken",
                                   rigid[0], rigid[7], rigid[14]));
    if (reduced->D.val || reduced->K4.val || reduced->damping[0])
        RITZ_CHECK(ritz_export_say(report, "damping left out: the file has no "
                                           "place for it"));
    return RITZ_OK;
}

ritz_status exudyn_body_say(const ritz_reduced *reduced, const exudyn_body *b,
                            ritz_export_report *report)
{
    RITZ_CHECK(ritz_export_say(
        report, "%lld flexible modes, %.6g to %.6g Hz, at %lld nodes",
        (long long)b->modes.V.ncol, b->modes.lowest_hz, b->modes.highest_hz,
        (long long)b->nodes.count));
    RITZ_CHECK(ritz_export_say(
        report, "%lld rigid %s left to the moving frame%s",
        (long long)b->modes.num_rigid, b->modes.kept ? "columns" : "motions",
        b->modes.kept ? "" : ", the modes are eigenvectors of the others"));
    return say_losses(reduced, b, report);
}

/* ---- its file ----------------------------------------------------------- */

/* Exudyn compares `datatype` with str: only text of variable length is one. */
static hid_t text_type(void)
{
    hid_t type = ritz_h5_string(1);

    if (H5Tset_size(type, H5T_VARIABLE) >= 0)
        return type;
    ritz_h5_close(type);
    return -1;
}

static ritz_status label_object(hid_t at, const char *datatype)
{
    RITZ_OWN(hid_t) type = text_type();

    return ritz_h5_set(at, "datatype", type, ritz_h5_scalar(), &datatype);
}

static ritz_status label_set(hid_t file, const char *name, const char *datatype)
{
    RITZ_OWN(hid_t) set = H5Dopen2(file, name, H5P_DEFAULT);

    RITZ_REFUSE_IF(set < 0, RITZ_ERR_FILE, "cannot open '%s'", name);
    return label_object(set, datatype);
}

static ritz_status write_text(hid_t file, const char *name, const char *text)
{
    RITZ_OWN(hid_t) type = text_type();

    RITZ_CHECK(ritz_h5_write(file, name, type, ritz_h5_scalar(), &text));
    return label_set(file, name, "str");
}

/* Values that are no matrix, then matrices. */
static ritz_status write_arrays(hid_t file, const ritz_reduced *reduced,
                                const exudyn_body *b)
{
    const exudyn_terms *t = &b->terms;
    int64_t m = b->modes.V.ncol;
    const int64_t version = 1;
    const int64_t info[6] = {m, b->nodes.count, 3, 4, 7, 7 + m};
    const struct {
        const char *name, *datatype;
        hid_t type;
        ritz_h5_shape shape;
        const void *values;
    } list[] = {
        {"fileVersion", "int", H5T_STD_I64LE, ritz_h5_scalar(), &version},
        {"infoList", "ndarray", H5T_STD_I64LE, ritz_h5_vector(6), info},
        {"xRef", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3 * b->nodes.count),
         b->xRef},
        {"totalMass", "float64", H5T_IEEE_F64LE, ritz_h5_scalar(),
         &reduced->inertia.mass},
        {"chiU", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3),
         reduced->inertia.centre},
        {"trigList", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(0), b->xRef},
    };
    const struct {
        const char *name;
        const ritz_dense *A;
    } matrix[] = {
        {"modeBasis", &b->modeBasis},
        {"massMatrixReduced", &b->modes.M},
        {"stiffnessMatrixReduced", &b->modes.K},
        {"inertiaLocal", &t->inertiaLocal},
        {"Mtt", &t->Mtt},
        {"chiUtilde", &t->chiUtilde},
        {"mPsiTildePsi", &t->mPsiTildePsi},
        {"mPsiTildePsiTilde", &t->mPsiTildePsiTilde},
        {"mPhitTPsi", &t->mPhitTPsi},
        {"mPhitTPsiTilde", &t->mPhitTPsiTilde},
        {"mXRefTildePsi", &t->mXRefTildePsi},
        {"mXRefTildePsiTilde", &t->mXRefTildePsiTilde},
    };

    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        RITZ_CHECK(ritz_h5_write(file, list[k].name, list[k].type,
                                 list[k].shape, list[k].values));
        RITZ_CHECK(label_set(file, list[k].name, list[k].datatype));
    }
    for (size_t k = 0; k < sizeof matrix / sizeof *matrix; k++) {
        RITZ_CHECK(ritz_h5_write_dense(file, matrix[k].name, matrix[k].A));
        RITZ_CHECK(label_set(file, matrix[k].name, "ndarray"));
    }
    return RITZ_OK;
}

/* What the file is made of. */
typedef struct exudyn_parts {
    const ritz_reduced *reduced;
    const exudyn_body *body;
} exudyn_parts;

static ritz_status write_file(hid_t file, const void *what)
{
    const exudyn_parts *parts = what;
    RITZ_OWN(hid_t) group = 0;

    RITZ_CHECK(write_arrays(file, parts->reduced, parts->body));
    RITZ_CHECK(write_text(file, "type", "ObjectFFRFreducedOrderInterface"));
    RITZ_CHECK(write_text(file, "rigidBodyNodeType",
                          "NodeType.RotationEulerParameters"));
    RITZ_CHECK(ritz_h5_group(file, "postProcessingModes", &group));
    return label_object(group, "dict");
}

static ritz_status write_body(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    RITZ_OWN(exudyn_body) b = {0};
    RITZ_OWN(ritz_draft) draft = {0};
    const exudyn_parts parts = {object->reduced, &b};

    RITZ_CHECK(exudyn_body_of(object->reduced, &b));
    RITZ_CHECK(exudyn_body_say(object->reduced, &b, report));
    RITZ_CHECK(ritz_draft_new(request->output, &draft));
    RITZ_CHECK(ritz_sink_fill_h5(&draft, write_file, &parts));
    return ritz_draft_publish(&draft);
}

const ritz_exporter ritz_exporter_exudyn = {
    .name = "exudyn",
    .summary = "a flexible body for Exudyn (FFRF, reduced order), HDF5",
    .reference = "Gerstmayr2023",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED,
    .write = write_body,
};
