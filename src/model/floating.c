/* A reduced component in a floating frame [Buckens1963] [CanavinLikins1977]. */
#include "model/floating_source.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"
#include "model/inertia_terms.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void floating_source_free(floating_source *s)
{
    free(s->dof);
    ritz_dense_free(&s->T);
    ritz_structure_free(&s->model);
    ritz_nodes_free(&s->move);
    ritz_nodes_free(&s->turn);
}

/* ---- what the reduced component must have ------------------------------- */

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
    RITZ_REFUSE_IF(!reduced->invariants.momentum.val, RITZ_ERR_ARGUMENT,
                   "it holds no invariants of inertia, which are kept of at "
                   "most %d columns, and it has %" PRId64,
                   (int)RITZ_INVARIANT_COLUMNS, reduced->K.ncol);
    return RITZ_OK;
}

static ritz_status check_rows(const ritz_reduced *reduced)
{
    for (int64_t i = 0; i < reduced->num_dofs; i++) {
        ritz_dof dof = reduced->dof[i];

        RITZ_REFUSE_IF(dof.component == 0, RITZ_ERR_ARGUMENT,
                       "point %" PRId64 " is a scalar point, which has no "
                       "place in a body that moves",
                       dof.grid);
        RITZ_REFUSE_IF(ritz_grids_find(&reduced->grids, dof.grid) < 0,
                       RITZ_ERR_ARGUMENT, "grid %" PRId64 " has no position",
                       dof.grid);
    }
    return RITZ_OK;
}

/* A direction that a grid lacks is taken as zero displacement along a basic
   axis. Hence grids with axes of their own must have all three or none. */
static ritz_status check_nodes(const ritz_nodes *nodes, const char *what)
{
    for (int64_t k = 0; k < nodes->count; k++) {
        const int64_t *row = nodes->row + 3 * k;
        bool all = row[0] >= 0 && row[1] >= 0 && row[2] >= 0;

        RITZ_REFUSE_IF(!all && !ritz_axes_basic(ritz_nodes_axes(nodes, k)),
                       RITZ_ERR_ARGUMENT,
                       "grid %" PRId64 " has axes of its own and brings only "
                       "some of its %s",
                       nodes->grids->id[nodes->grid[k]], what);
    }
    return RITZ_OK;
}

/*
 * Drop nodes that have recovered dofs alone and lack a direction: their
 * displacement along it is not zero but unknown.
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

/* Rows of rotations, as ritz_nodes_of finds those of translations. */
static ritz_status list_turning(const floating_source *s, ritz_nodes *out)
{
    RITZ_OWN_ARRAY ritz_dof *dof = NULL;

    RITZ_CHECK_COPY(dof, s->dof, s->count);
    for (int64_t i = 0; i < s->count; i++)
        dof[i].component -= dof[i].component > 3 ? 3 : dof[i].component;
    return ritz_nodes_of(s->count, dof, &s->reduced->grids, out);
}

/* K, M and D with all that damps. */
static ritz_status find_structure(const ritz_reduced *reduced,
                                  ritz_structure *out)
{
    ritz_damping damping = {0};

    RITZ_CHECK(ritz_structure_of_reduced(reduced, out));
    if (!reduced->damping[0])
        return RITZ_OK;
    RITZ_CHECK(ritz_damping_parse(reduced->damping, &damping));
    return ritz_context(ritz_modal_damping(out, &damping, &out->D), "damping");
}

static ritz_status find_source(const ritz_reduced *reduced, floating_source *s)
{
    RITZ_CHECK(check_parts(reduced));
    s->reduced = reduced;
    s->count = reduced->num_dofs + reduced->recovery.count;
    RITZ_CHECK(ritz_recovery_extend(&reduced->recovery, reduced->num_dofs,
                                    reduced->dof, &reduced->T, &s->dof, &s->T));
    RITZ_CHECK(check_rows(reduced));
    RITZ_CHECK(ritz_nodes_of(s->count, s->dof, &reduced->grids, &s->move));
    RITZ_CHECK(list_turning(s, &s->turn));
    leave_partial(reduced->num_dofs, &s->move);
    leave_partial(reduced->num_dofs, &s->turn);
    RITZ_REFUSE_IF(s->move.count == 0, RITZ_ERR_ARGUMENT,
                   "no grid has a translation");
    RITZ_CHECK(check_nodes(&s->move, "translations"));
    RITZ_CHECK(check_nodes(&s->turn, "rotations"));
    return find_structure(reduced, &s->model);
}

/* ---- the frame ---------------------------------------------------------- */

static const char reference_names[][RITZ_NAME_SIZE] = {
    [RITZ_REFERENCE_NONE] = "none",
    [RITZ_REFERENCE_MEAN_AXIS] = "mean-axis",
    [RITZ_REFERENCE_TANGENT] = "tangent",
};

const char *ritz_frame_condition_name(ritz_frame_condition reference)
{
    return reference_names[reference];
}

static ritz_status read_reference(const char *text, ritz_frame_condition *out)
{
    const ritz_names names = {"reference condition",
                              sizeof reference_names / sizeof *reference_names,
                              reference_names[0], sizeof *reference_names};
    int64_t k = 0;

    if (text)
        RITZ_CHECK(ritz_words_find(&names, text, &k));
    *out = (ritz_frame_condition)k;
    return RITZ_OK;
}

static ritz_status read_frame(const ritz_reduced *reduced, const char *text,
                              ritz_floating *f)
{
    char shown[RITZ_SHORT_SIZE];
    const double *position = (const double[3]){0.0, 0.0, 0.0};
    int64_t id = 0;
    int64_t to = 0;

    f->grid = -1;
    if (text && strcmp(text, "centre") == 0) {
        position = reduced->inertia.centre;
    } else if (text && strcmp(text, "basic") != 0) {
        int64_t k = -1;

        RITZ_REFUSE_IF(!ritz_text_range(text, strlen(text), &id, &to) || to > 0,
                       RITZ_ERR_ARGUMENT,
                       "a frame is at 'basic', 'centre' or a grid, and '%s' is "
                       "none of these",
                       ritz_text_short(text, shown));
        k = ritz_grids_find(&reduced->grids, id);
        RITZ_REFUSE_IF(k < 0, RITZ_ERR_ARGUMENT,
                       "a frame at grid %" PRId64 ": there is no such grid",
                       id);
        position = reduced->grids.position + 3 * k;
        f->grid = id;
    }
    memcpy(f->origin, position, sizeof f->origin);
    return RITZ_OK;
}

/* ---- modes -------------------------------------------------------------- */

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
        RITZ_REFUSE_IF(
            sqrt(ritz_dense_dot(&rest, j, &rest, j)) >
                RITZ_LOOSE_IN_FRAME * sqrt(ritz_dense_dot(&U, j, &U, j)),
            RITZ_ERR_ARGUMENT,
            "of %" PRId64 " motions without stiffness number %" PRId64
            " is not that of a rigid body: a part is loose, and a "
            "moving frame cannot follow it",
            U.ncol, j + 1);
    return RITZ_OK;
}

static void note_band(const ritz_pairs *pairs, ritz_floating *f)
{
    f->lowest_hz = ritz_eigen_hertz(pairs->lambda[pairs->num_rigid]);
    f->highest_hz = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
}

/* If the columns of kind rigid span all rigid motion, V selects the others;
 * otherwise V stays empty. */
static ritz_status keep_columns(const floating_source *s, ritz_floating *f)
{
    const ritz_columns *columns = &s->reduced->columns;
    RITZ_OWN(ritz_dense) Z = {0}, V = {0}, K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(select_columns(columns, true, &Z));
    RITZ_CHECK(select_columns(columns, false, &V));
    if (Z.ncol == 0 || V.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_congruence(&s->model.K, &V, &K));
    RITZ_CHECK(ritz_dense_congruence(&s->model.M, &V, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &pairs));
    if (pairs.num_rigid > 0 || pairs.Phi.ncol < V.ncol)
        return RITZ_OK;
    RITZ_CHECK(demand_rigid(s->reduced, &Z));
    f->kept = true;
    f->num_rigid = Z.ncol;
    note_band(&pairs, f);
    RITZ_MOVE(f->V, V);
    return RITZ_OK;
}

static int compare_sizes(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;

    return (a > b) - (a < b);
}

/* Among the eigenvalues of an indefinite stiffness, which ascend, those of
   `count` motions without stiffness follow `*below` negative ones. */
static ritz_status count_free(const ritz_pairs *pairs, int64_t *below,
                              int64_t *count)
{
    const int64_t n = pairs->Phi.ncol;
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(size, n);
    for (int64_t k = 0; k < n; k++)
        size[k] = fabs(pairs->lambda[k]);
    qsort(size, (size_t)n, sizeof *size, compare_sizes);
    *count = ritz_eigen_rigid(n, size, size[n - 1]);
    for (*below = 0; *count > 0 && pairs->lambda[*below] < -size[*count - 1];)
        ++*below;
    return RITZ_OK;
}

/* Motions without stiffness come first, also of an indefinite stiffness. */
static ritz_status put_free_first(ritz_pairs *pairs)
{
    const int64_t n = pairs->Phi.ncol;
    RITZ_OWN(ritz_dense) Phi = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t below = 0, count = 0;

    if (pairs->num_rigid > 0 || n == 0 || pairs->lambda[0] >= 0.0)
        return RITZ_OK;
    RITZ_CHECK(count_free(pairs, &below, &count));
    RITZ_CHECK_NEW(at, n);
    RITZ_CHECK_COPY(lambda, pairs->lambda, n);
    for (int64_t k = 0; k < n; k++)
        at[k] = k < count ? below + k : k < count + below ? k - count : k;
    for (int64_t k = 0; k < n; k++)
        pairs->lambda[k] = lambda[at[k]];
    RITZ_CHECK(ritz_dense_pick(&pairs->Phi, n, at, &Phi));
    ritz_dense_free(&pairs->Phi);
    RITZ_MOVE(pairs->Phi, Phi);
    pairs->num_rigid = count;
    return RITZ_OK;
}

static ritz_status diagonalise_body(const floating_source *s, ritz_floating *f)
{
    RITZ_OWN(ritz_dense) Z = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(&s->model.K, &s->model.M, &pairs));
    RITZ_CHECK(put_free_first(&pairs));
    RITZ_REFUSE_IF(pairs.num_rigid == pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                   "no mode is flexible: a rigid body needs no file, but mass "
                   "and inertia");
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &Z));
    RITZ_CHECK(demand_rigid(s->reduced, &Z));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, pairs.num_rigid,
                                  pairs.Phi.ncol - pairs.num_rigid, &f->V));
    f->num_rigid = pairs.num_rigid;
    note_band(&pairs, f);
    return RITZ_OK;
}

/* ---- what simulators read ----------------------------------------------- */

/* Compute K, M and D, and the frequency band of (K, M), as W changes M. */
static ritz_status project_matrices(const floating_source *s, ritz_floating *f)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_dense_congruence(&s->model.K, &f->V, &f->K));
    RITZ_CHECK(ritz_dense_congruence(&s->model.M, &f->U, &f->M));
    if (s->model.D.val)
        RITZ_CHECK(ritz_dense_project(&s->model.D, &f->V, &f->D));
    if (f->D.val && ritz_dense_asymmetry(&f->D) <= RITZ_SYMMETRIC)
        ritz_dense_symmetrise(&f->D); /* simulators compare bits */
    if (f->reference == RITZ_REFERENCE_NONE)
        return RITZ_OK;
    RITZ_CHECK(ritz_eigen_dense(&f->K, &f->M, &pairs));
    RITZ_REFUSE_IF(pairs.num_rigid == pairs.Phi.ncol, RITZ_ERR_ARGUMENT,
                   "no mode is flexible");
    note_band(&pairs, f);
    return RITZ_OK;
}

static ritz_status place_nodes(const ritz_nodes *nodes, ritz_floating *f)
{
    f->count = nodes->count;
    RITZ_CHECK_NEW(f->id, f->count);
    RITZ_CHECK_NEW(f->position, 3 * f->count);
    RITZ_CHECK_NEW(f->rotates, f->count);
    for (int64_t k = 0; k < f->count; k++) {
        f->id[k] = nodes->grids->id[nodes->grid[k]];
        for (int a = 0; a < 3; a++)
            f->position[3 * k + a] =
                nodes->grids->position[3 * nodes->grid[k] + a] - f->origin[a];
    }
    return RITZ_OK;
}

/* Rows x, y, z of each node at[k] from those of nodes, along basic axes. */
static ritz_status spread_axes(const ritz_nodes *nodes, const int64_t *at,
                               int64_t count, const ritz_dense *Psi,
                               ritz_dense *out)
{
    RITZ_OWN(ritz_dense) along = {0};

    RITZ_CHECK(ritz_dense_new(3 * count, Psi->ncol, out));
    for (int a = 0; a < 3; a++) {
        ritz_dense_free(&along);
        RITZ_CHECK(ritz_nodes_along(nodes, Psi, a, &along));
        for (int64_t j = 0; j < Psi->ncol; j++)
            for (int64_t k = 0; k < nodes->count; k++)
                if (at[k] >= 0)
                    ritz_dense_col(out, j)[3 * at[k] + a] =
                        ritz_dense_col(&along, j)[k];
    }
    return RITZ_OK;
}

/* Number of each grid of @p from among those of @p to, both ascending; -1 if it
   is not there. @return how many are */
static int64_t find_common(const ritz_nodes *from, const ritz_nodes *to,
                           int64_t *at)
{
    int64_t k = 0;
    int64_t found = 0;

    for (int64_t i = 0; i < from->count; i++) {
        while (k < to->count && to->grid[k] < from->grid[i])
            k++;
        at[i] = k < to->count && to->grid[k] == from->grid[i] ? k : -1;
        found += at[i] >= 0;
    }
    return found;
}

/* Set the positions of the nodes and Psi at them. */
static ritz_status shape_modes(const floating_source *s, ritz_floating *f)
{
    RITZ_OWN(ritz_dense) Psi = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;

    RITZ_CHECK(place_nodes(&s->move, f));
    RITZ_CHECK_NEW(at, s->reduced->grids.count);
    RITZ_CHECK(ritz_dense_mul(&s->T, &f->U, &Psi));
    find_common(&s->move, &s->move, at);
    RITZ_CHECK(spread_axes(&s->move, at, f->count, &Psi, &f->shape));
    if (find_common(&s->turn, &s->move, at) == 0)
        return RITZ_OK;
    for (int64_t k = 0; k < s->turn.count; k++)
        if (at[k] >= 0)
            f->rotates[at[k]] = true;
    return spread_axes(&s->turn, at, f->count, &Psi, &f->turn);
}

/*
 * Move inertia and invariants to the origin o of the frame. Rotations about it
 * are R N, and S = e'M Psi is the linear momentum of a mode,
 *
 *     N'R'MR N,   N'R'M Psi,   (X_a - o_a)'m Psi_b = X_a'm Psi_b - o_a S_b
 */
static ritz_status move_invariants(ritz_floating *f)
{
    ritz_invariants *of = &f->invariants;
    const int64_t m = of->momentum.ncol;
    RITZ_OWN(ritz_dense) N = {0}, A = {0}, moved = {0};

    for (int a = 0; a < 3; a++)
        f->inertia.centre[a] -= f->origin[a];
    for (int b = 0; b < 3; b++)
        for (int64_t k = 0; k < m; k++)
            for (int a = 0; a < 3; a++)
                ritz_dense_col(&of->position, b * m + k)[a] -=
                    f->origin[a] * ritz_dense_col(&of->momentum, k)[b];
    RITZ_CHECK(ritz_dense_identity(6, &N));
    for (int i = 0; i < 3; i++)
        ritz_floating_spin(f->origin, i, 1.0, &N);
    RITZ_CHECK(ritz_dense_mul_tn(&N, &of->momentum, &moved));
    ritz_dense_replace(&of->momentum, &moved);
    RITZ_CHECK(ritz_dense_new(6, 6, &A));
    memcpy(A.val, of->rigid, sizeof of->rigid);
    RITZ_CHECK(ritz_dense_congruence(&A, &N, &moved));
    memcpy(of->rigid, moved.val, sizeof of->rigid);
    return RITZ_OK;
}

/* Leave rigid-body motion to the moving frame: columns of kind rigid if those
 * make up all of it, eigenvectors of (K_r, M_r) otherwise. */
static ritz_status find_modes(const floating_source *s, bool usual,
                              ritz_floating *f)
{
    RITZ_CHECK(keep_columns(s, f));
    if (!f->V.val)
        RITZ_CHECK(diagonalise_body(s, f));
    if (usual && f->num_rigid > 0)
        f->reference =
            f->grid >= 0 ? RITZ_REFERENCE_TANGENT : RITZ_REFERENCE_MEAN_AXIS;
    RITZ_CHECK(ritz_floating_refer(s, f));
    RITZ_CHECK(project_matrices(s, f));
    return shape_modes(s, f);
}

static ritz_status float_body(const ritz_reduced *reduced,
                              const ritz_floating_request *request, bool usual,
                              ritz_floating *out)
{
    RITZ_OWN(floating_source) source = {0};
    RITZ_OWN(ritz_floating) f = {0};
    ritz_inertia_loss loss = {0};

    RITZ_CHECK(find_source(reduced, &source));
    RITZ_CHECK(read_reference(request->reference, &f.reference));
    RITZ_CHECK(read_frame(reduced, request->frame, &f));
    RITZ_CHECK(find_modes(&source, usual, &f));
    f.inertia = reduced->inertia;
    f.structural = reduced->K4.val != NULL;
    RITZ_CHECK(
        ritz_invariants_project(&reduced->invariants, &f.U, &f.invariants));
    RITZ_CHECK(move_invariants(&f));
    RITZ_CHECK(ritz_inertia_loss_of(&f.invariants, &f.K, &f.M, &loss));
    f.approximate = loss.value;
    f.approximate_mode = loss.mode;
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

ritz_status ritz_floating_of(const ritz_reduced *reduced,
                             const ritz_floating_request *request,
                             ritz_floating *out)
{
    return float_body(reduced, request, false, out);
}

ritz_status ritz_floating_usual(const ritz_reduced *reduced, const char *frame,
                                ritz_floating *out)
{
    const ritz_floating_request request = {.frame = frame};

    return float_body(reduced, &request, true, out);
}

void ritz_floating_free(ritz_floating *f)
{
    RITZ_FREE(f->id, f->position, f->rotates);
    ritz_dense_free(&f->shape);
    ritz_dense_free(&f->turn);
    ritz_dense_free(&f->V);
    ritz_dense_free(&f->W);
    ritz_dense_free(&f->U);
    ritz_dense_free(&f->K);
    ritz_dense_free(&f->M);
    ritz_dense_free(&f->D);
    ritz_invariants_free(&f->invariants);
    *f = (ritz_floating){0};
}
