/*
 * Reference conditions of floating frames.
 *
 * The basis of a free body contains its rigid motions, T Z = R. A reference
 * condition is therefore a change of reduced coordinates,
 *
 *     Psi = T V - R W = T U,     U = V - Z W,
 *
 * and products with Psi follow from the known products with T. Z is the best
 * approximation in the norm of M: Z = Phi Phi'T'MR, with all modes Phi of
 * (K_r, M_r).
 *
 *     mean-axis   R'MR W = R'MT V             [Buckens1963]
 *     tangent     C Z W = C V, C the rows of T at the node of the frame
 *
 * Both are solved for motions about the centre of mass, R N, whose rotations
 * are divided by the radius of gyration, so that the unit of length does not
 * matter. A motion that moves no mass, such as the rotation of grids on a line
 * about that line, is left out.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/floating_source.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Rigid motions about the centre of mass, and their reduced coordinates. */
typedef struct rigid_motions {
    double length; /* radius of gyration */
    int64_t count; /* of those that move mass */
    ritz_dense N;  /* 6 x 6: R N are about the centre, rotations / length */
    ritz_dense A;  /* 6 x 6, N'R'MR N */
    ritz_dense Z;  /* r x 6, T Z = R N */
} rigid_motions;

static void rigid_motions_free(rigid_motions *rigid)
{
    ritz_dense_free(&rigid->N);
    ritz_dense_free(&rigid->A);
    ritz_dense_free(&rigid->Z);
}

/* A rotation about c is the sum of a rotation about the basic origin and the
   translation -e_i x c. */
void ritz_floating_spin(const double *c, int i, double scale, ritz_dense *N)
{
    int j = (i + 1) % 3;
    int k = (i + 2) % 3;
    double *col = ritz_dense_col(N, 3 + i);

    col[3 + i] = scale;
    col[j] = c[k] * scale;
    col[k] = -c[j] * scale;
}

/*
 * Replace X by the solution w of B w = X in the sense of least squares that has
 * the smallest norm. Singular values of B up to `least` times the largest count
 * as zero; `rank` is the number of the others.
 */
static ritz_status solve_least(const ritz_dense *B, double least, ritz_dense *X,
                               int64_t *rank)
{
    RITZ_OWN(ritz_dense) U = {0}, V = {0}, UX = {0}, w = {0};
    RITZ_OWN_ARRAY double *s = NULL;
    int64_t most = B->nrow < B->ncol ? B->nrow : B->ncol;

    RITZ_CHECK(ritz_general_svd(B, &U, &s, &V));
    *rank = 0;
    while (*rank < most && s[*rank] > least * s[0])
        (*rank)++;
    U = (ritz_dense){U.nrow, *rank, U.val};
    V = (ritz_dense){V.nrow, *rank, V.val};
    RITZ_CHECK(ritz_dense_mul_tn(&U, X, &UX));
    for (int64_t j = 0; j < UX.ncol; j++)
        for (int64_t k = 0; k < *rank; k++)
            ritz_dense_col(&UX, j)[k] /= s[k];
    RITZ_CHECK(ritz_dense_mul(&V, &UX, &w));
    ritz_dense_replace(X, &w);
    return RITZ_OK;
}

/* Compute N, A, and the number of motions that move mass. */
static ritz_status find_motions(const ritz_reduced *reduced,
                                rigid_motions *rigid)
{
    const ritz_inertia *inertia = &reduced->inertia;
    const double *J = inertia->tensor;
    RITZ_OWN(ritz_dense) RMR = {0}, U = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    rigid->length = sqrt(fmax(J[0] + J[4] + J[8], 0.0) / (2.0 * inertia->mass));
    if (rigid->length == 0.0)
        rigid->length = 1.0;
    RITZ_CHECK(ritz_dense_identity(6, &rigid->N));
    for (int i = 0; i < 3; i++)
        ritz_floating_spin(inertia->centre, i, 1.0 / rigid->length, &rigid->N);
    RITZ_CHECK(ritz_dense_new(6, 6, &RMR));
    memcpy(RMR.val, reduced->invariants.rigid, 36 * sizeof *RMR.val);
    RITZ_CHECK(ritz_dense_congruence(&RMR, &rigid->N, &rigid->A));
    RITZ_CHECK(ritz_general_svd(&rigid->A, &U, &s, NULL));
    while (rigid->count < 6 &&
           s[rigid->count] > RITZ_PORT_HELD * RITZ_PORT_HELD * s[0])
        rigid->count++;
    return RITZ_OK;
}

/* Z = Phi Phi'T'MR N */
static ritz_status find_coordinates(const floating_source *s,
                                    rigid_motions *rigid)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) PPhi = {0}, share = {0};

    RITZ_CHECK(ritz_eigen_dense(&s->model.K, &s->model.M, &pairs));
    RITZ_CHECK(
        ritz_dense_mul(&s->reduced->invariants.momentum, &pairs.Phi, &PPhi));
    RITZ_CHECK(ritz_dense_mul_tn(&PPhi, &rigid->N, &share));
    return ritz_dense_mul(&pairs.Phi, &share, &rigid->Z);
}

/* Mean axes: W = N w with A w = N'R'MT V. */
static ritz_status find_mean_axes(const floating_source *s,
                                  const rigid_motions *rigid,
                                  const ritz_dense *V, ritz_dense *w)
{
    RITZ_OWN(ritz_dense) PV = {0};
    int64_t rank = 0;

    RITZ_CHECK(ritz_dense_mul(&s->reduced->invariants.momentum, V, &PV));
    RITZ_CHECK(ritz_dense_mul_tn(&rigid->N, &PV, w));
    return solve_least(&rigid->A, RITZ_PORT_HELD * RITZ_PORT_HELD, w, &rank);
}

/* Copy the rows of T of a grid's dofs, along the grid's own axes, to the first
   six rows of C; those of rotations are multiplied by `length`. */
static void put_grid(const floating_source *s, int64_t grid, double length,
                     ritz_dense *C)
{
    for (int64_t i = 0; i < s->count; i++) {
        const ritz_dof dof = s->dof[i];
        const double scale = ritz_tie_scale(dof, length);

        if (dof.grid != grid || dof.component == 0)
            continue;
        for (int64_t j = 0; j < C->ncol; j++)
            ritz_dense_col(C, j)[dof.component - 1] =
                scale * ritz_dense_col(&s->T, j)[i];
    }
}

static bool port_has(const ritz_port_map *port, int64_t grid)
{
    for (int64_t k = 0; k < port->count; k++)
        if (port->dof[k].component > 0 && port->dof[k].grid == grid)
            return true;
    return false;
}

/* Append to C the motion of all ports that contain a grid. @return number of
   rows of C; if C is {0}, the rows are only counted */
static int64_t put_ports(const floating_source *s, int64_t grid, double length,
                         ritz_dense *C)
{
    int64_t row = 6;

    for (int64_t p = 0; p < s->reduced->num_ports; p++) {
        const ritz_port_map *port = &s->reduced->port[p];

        for (int64_t k = 0; port_has(port, grid) && k < port->count; k++) {
            const double scale = ritz_tie_scale(port->dof[k], length);

            for (int64_t j = 0; C->val && j < C->ncol; j++)
                ritz_dense_col(C, j)[row] =
                    scale * ritz_dense_col(&port->map, j)[k];
            row++;
        }
    }
    return row;
}

/*
 * C, the motion of the node of the frame. If @p ports, the motion of the ports
 * that contain the node is appended: if such a port moves as a rigid body, its
 * rotation is that of the node.
 */
static ritz_status find_held(const floating_source *s, int64_t grid,
                             double length, bool ports, ritz_dense *C)
{
    const int64_t count = ports ? put_ports(s, grid, length, C) : 6;

    RITZ_CHECK(ritz_dense_new(count, s->T.ncol, C));
    put_grid(s, grid, length, C);
    if (ports)
        put_ports(s, grid, length, C);
    return RITZ_OK;
}

/* Refuse if `rest`, C (V - Z w), is larger than the rounding of T V and than
   the error of positions that have few digits. */
static ritz_status demand_held(const floating_source *s, int64_t grid,
                               const ritz_dense *CV, const ritz_dense *rest,
                               const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) TV = {0};
    double bound = RITZ_MOTIONS_AGREE * ritz_dense_max(CV);

    RITZ_CHECK(ritz_dense_mul(&s->T, V, &TV));
    bound = fmax(bound, RITZ_NEGLIGIBLE * ritz_dense_max(&TV));
    RITZ_REFUSE_IF(
        ritz_dense_max(rest) > bound, RITZ_ERR_ARGUMENT,
        "the port of grid %" PRId64 " does not move as a rigid body, "
        "and the grid has no rotations: a tangent frame needs a grid "
        "that turns",
        grid);
    return RITZ_OK;
}

/* Tangent frame: W = N w with C Z w = C V. The node alone is tried first, then
   the node with its ports. */
static ritz_status find_tangent(const floating_source *s,
                                const rigid_motions *rigid, int64_t grid,
                                const ritz_dense *V, ritz_dense *w)
{
    RITZ_OWN(ritz_dense) C = {0}, CZ = {0}, CV = {0}, rest = {0};
    int64_t rank = 0;

    for (int ports = 0; ports < 2 && rank < rigid->count; ports++) {
        ritz_dense_free(&C);
        ritz_dense_free(&CZ);
        ritz_dense_free(&CV);
        ritz_dense_free(w);
        RITZ_CHECK(find_held(s, grid, rigid->length, ports > 0, &C));
        RITZ_CHECK(ritz_dense_mul(&C, &rigid->Z, &CZ));
        RITZ_CHECK(ritz_dense_mul(&C, V, &CV));
        RITZ_CHECK(ritz_dense_copy(&CV, w));
        RITZ_CHECK(solve_least(&CZ, RITZ_PORT_HELD, w, &rank));
    }
    RITZ_REFUSE_IF(rank < rigid->count, RITZ_ERR_ARGUMENT,
                   "grid %" PRId64
                   " does not say how it turns, nor does a port "
                   "that it is in: a tangent frame needs a grid with six dofs",
                   grid);
    RITZ_CHECK(ritz_dense_mul(&CZ, w, &rest));
    ritz_dense_add(-1.0, &CV, &rest);
    return demand_held(s, grid, &CV, &rest, V);
}

ritz_status ritz_floating_refer(const floating_source *s, ritz_floating *f)
{
    RITZ_OWN(rigid_motions) rigid = {0};
    RITZ_OWN(ritz_dense) w = {0}, Zw = {0};

    RITZ_CHECK(ritz_dense_copy(&f->V, &f->U));
    if (f->reference == RITZ_REFERENCE_NONE)
        return ritz_dense_new(6, f->V.ncol, &f->W);
    RITZ_CHECK(find_motions(s->reduced, &rigid));
    RITZ_REFUSE_IF(f->num_rigid != rigid.count, RITZ_ERR_ARGUMENT,
                   "of %" PRId64 " rigid motions %" PRId64
                   " are free and in the "
                   "basis: a body that is held keeps its modes, which are "
                   "measured from where it is held (reference none)",
                   rigid.count, f->num_rigid);
    RITZ_REFUSE_IF(f->reference == RITZ_REFERENCE_TANGENT && f->grid < 0,
                   RITZ_ERR_ARGUMENT,
                   "a tangent frame is at a grid: name it as the frame");
    RITZ_CHECK(find_coordinates(s, &rigid));
    RITZ_CHECK(f->reference == RITZ_REFERENCE_MEAN_AXIS
                   ? find_mean_axes(s, &rigid, &f->V, &w)
                   : find_tangent(s, &rigid, f->grid, &f->V, &w));
    RITZ_CHECK(ritz_dense_mul(&rigid.N, &w, &f->W));
    RITZ_CHECK(ritz_dense_mul(&rigid.Z, &w, &Zw));
    ritz_dense_add(-1.0, &Zw, &f->U);
    return RITZ_OK;
}
