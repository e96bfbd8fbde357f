/*
 * Effect of rounding of a free body's stiffness. K R = 0 for rigid motions R is
 * the result of large numbers that cancel; with rounded entries K R = F. The
 * rigid eigenvalues of (K, M) are then small values mu, of either sign, and
 * rigid motion responds by
 *
 *     c'R (mu - w^2)^-1 R'b  =  -c'R R'b / w^2  -  mu c'R R'b / w^4  -  ...
 *
 * Let participations in rigid motion be of the size of those in the first
 * flexible mode, which has the eigenvalue lambda and the static response c'b /
 * lambda. The second term is then below a part e of the response of both modes
 * at all frequencies w with
 *
 *     mu / w^2 <= e   and   mu lambda / w^4 <= e.
 *
 * A relative error u of the entries of K causes in row i of F at most u sum_j
 * |K_ij| |r_j|; a larger force is that of a support.
 */
#include "model/rounding.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <math.h>

ritz_status ritz_rigid_forces_of(const ritz_sparse *K, const ritz_dense *R,
                                 ritz_rigid_forces *out)
{
    RITZ_OWN(ritz_dense) F = {0};

    RITZ_CHECK(ritz_sparse_mul(K, R, &F));
    *out = (ritz_rigid_forces){.row = -1};
    for (int64_t j = 0; j < R->ncol; j++)
        for (int64_t i = 0; i < K->ncol; i++) {
            double force = fabs(ritz_dense_col(&F, j)[i]);
            double sum = 0.0;

            for (int64_t p = K->colptr[i]; p < K->colptr[i + 1]; p++)
                sum += fabs(K->val[p] * ritz_dense_col(R, j)[K->rowind[p]]);
            out->bound = fmax(out->bound, sum);
            if (force > out->largest) {
                out->largest = force;
                out->row = i;
            }
        }
    return RITZ_OK;
}

double ritz_digits_rounding(double digits)
{
    return 0.5 * pow(10.0, 1.0 - digits);
}

/* Mean position of the dofs' grids, and the largest distance from it; false if
   a dof has no grid with a position. */
static bool find_extent(const ritz_component *c, double centre[static 3],
                        double *size)
{
    *size = 0.0;
    for (int64_t k = 0; k < c->num_dofs; k++) {
        int64_t g = ritz_grids_find(&c->grids, c->dof[k].grid);

        if (g < 0 || c->dof[k].component == 0)
            return false;
        for (int i = 0; i < 3; i++)
            centre[i] +=
                (c->grids.position[3 * g + i] - centre[i]) / (double)(k + 1);
    }
    for (int64_t k = 0; k < c->num_dofs; k++) {
        int64_t g = ritz_grids_find(&c->grids, c->dof[k].grid);
        const double *at = &c->grids.position[3 * g];

        *size = fmax(*size, hypot(hypot(at[0] - centre[0], at[1] - centre[1]),
                                  at[2] - centre[2]));
    }
    return c->num_dofs > 0;
}

/* Whether the forces of a rigid motion are no larger than a relative error u of
   K causes. */
static ritz_status is_free(const ritz_component *c, const ritz_dense *R,
                           int64_t j, double u, bool *out)
{
    ritz_rigid_forces forces = {0};
    RITZ_OWN(ritz_dense) r = {0};

    RITZ_CHECK(ritz_dense_columns(R, j, 1, &r));
    RITZ_CHECK(ritz_rigid_forces_of(&c->K, &r, &forces));
    *out = forces.largest <= u * forces.bound;
    return RITZ_OK;
}

/* Number of independent motions with mass: the rank of R'MR. */
static ritz_status count_massive(const ritz_component *c, const ritz_dense *R,
                                 int64_t *out)
{
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    const double *lambda = NULL;

    RITZ_CHECK(ritz_sparse_condense(&c->M, R, &A));
    RITZ_CHECK(ritz_general_symmetric(&A, &pairs));
    lambda = pairs.lambda;
    *out = 0;
    for (int64_t k = 0; k < A.ncol; k++)
        *out += lambda[k] > RITZ_MOTION_WITHOUT_MASS * lambda[A.ncol - 1];
    return RITZ_OK;
}

/* Relative rounding error of the entries of K. */
static ritz_status find_rounding(const ritz_component *c, double *out)
{
    double digits = 0.0;
    bool declared = false;

    RITZ_CHECK(ritz_source_digits(c, &digits, &declared));
    *out = digits < RITZ_MOST_DIGITS ? ritz_digits_rounding(digits)
                                     : RITZ_ELEMENT_ROUNDING;
    return RITZ_OK;
}

/*
 * Number of rigid motions, found from the positions of grids, that K resists by
 * rounding alone; 0 if K holds any translation, or positions are not known.
 */
static ritz_status count_free(const ritz_component *c, int64_t *out)
{
    RITZ_OWN(ritz_dense) R = {0};
    double centre[3] = {0.0, 0.0, 0.0}, size = 0.0, u = 0.0;
    int64_t kept = 0;

    *out = 0;
    if (!c->dof || !find_extent(c, centre, &size))
        return RITZ_OK;
    RITZ_CHECK(find_rounding(c, &u));
    RITZ_CHECK(ritz_rigid_geometry(c, centre, &R));
    for (int64_t j = 0; j < R.ncol; j++) {
        double unit = j < 3 || size == 0.0 ? 1.0 : 1.0 / size;
        bool free = false;

        for (int64_t i = 0; i < R.nrow; i++)
            ritz_dense_col(&R, kept)[i] = unit * ritz_dense_col(&R, j)[i];
        RITZ_CHECK(is_free(c, &R, kept,
                           j < 3 ? u : fmax(u, RITZ_SINGLE_PRECISION), &free));
        if (!free && j < 3)
            return RITZ_OK;
        kept += free;
    }
    R.ncol = kept;
    return count_massive(c, &R, out);
}

/* The largest |f| of the rigid motions, and the frequency of the next mode. */
static void take_pairs(const ritz_pairs *pairs, ritz_rounded *out)
{
    for (int64_t k = 0; k < out->motions && k < pairs->Phi.ncol; k++)
        out->rigid_hz =
            fmax(out->rigid_hz, fabs(ritz_eigen_hertz(pairs->lambda[k])));
    if (out->motions < pairs->Phi.ncol)
        out->flexible_hz = ritz_eigen_hertz(pairs->lambda[out->motions]);
}

/* Take the frequencies from @p pairs or, if these contain no flexible mode,
   compute more. */
static ritz_status take_lowest(const ritz_component *component,
                               const ritz_pairs *pairs, ritz_rounded *out)
{
    const ritz_span lowest = {.modes = 1 + RITZ_BODY_MOTIONS};
    RITZ_OWN(ritz_pairs) more = {0};

    if (out->motions < pairs->Phi.ncol) {
        take_pairs(pairs, out);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &lowest, &more));
    take_pairs(&more, out);
    return RITZ_OK;
}

ritz_status ritz_rounded_of(const ritz_component *component,
                            const ritz_pairs *pairs, bool by_matrices,
                            ritz_rounded *out)
{
    int64_t free = 0;

    *out = (ritz_rounded){0};
    if (!component->K.colptr || component->K.colptr[component->num_dofs] == 0)
        return RITZ_OK; /* a rigid body */
    if (pairs->num_rigid < RITZ_BODY_MOTIONS)
        RITZ_CHECK(count_free(component, &free));
    out->hidden = free > pairs->num_rigid;
    if (out->hidden)
        out->motions = free;
    else if (by_matrices)
        out->motions = pairs->num_rigid;
    return out->motions > 0 ? take_lowest(component, pairs, out) : RITZ_OK;
}

double ritz_rounded_ends(const ritz_rounded *rounded, double tolerance)
{
    double rigid = rounded->rigid_hz / sqrt(tolerance);

    return rigid < rounded->flexible_hz ? sqrt(rigid * rounded->flexible_hz)
                                        : rigid;
}
