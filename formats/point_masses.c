/*
 * Finds point masses with given invariants of inertia, for formats that
 * describe the inertia of a body by masses at nodes. The fields 1, x, y, z and
 * psi_aj, the translation along axis a in mode j, have the products
 *
 *     G_fg = integral of f g dm        G of order p = 4 + 3m
 *
 * and all invariants are entries of G. Points i with masses m_i and values F_if
 * have these invariants if
 *
 *     F'diag(m_i) F = G,   F_i1 = 1
 *
 * G is positive semidefinite for solids and lumped masses. Its eigenvalues give
 * G = B'B, where B has as many rows as the rank of G, and G = (HB)'(HB) for any
 * orthogonal H. Take for H the Householder reflection that makes the first
 * column of HB constant. Then each row of HB is a point, and all points have
 * the same mass.
 *
 * G is indefinite if invariants are approximate, or if grids have rotary
 * inertia that no distribution of mass has, such as J_x alone. Then G = B'B -
 * C'C, and the rows of C become points of negative mass in the same way. If C
 * e_1 is small, these points would be far away. So the row e_1' sqrt(mass) is
 * appended to both B and C, which does not change B'B - C'C.
 *
 * The momenta of the modes are computed from all of M. So (x, psi) has the
 * antisymmetric part that belongs to the angular momentum, and the symmetric
 * part of the integrals, as in the file of Exudyn.
 */
#include "formats/point_masses.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

void ritz_point_masses_free(ritz_point_masses *points)
{
    free(points->mass);
    ritz_dense_free(&points->field);
    *points = (ritz_point_masses){0};
}

/* ---- products of fields ------------------------------------------------- */

static void put_pair(ritz_dense *G, int64_t i, int64_t j, double value)
{
    ritz_dense_col(G, j)[i] = value;
    ritz_dense_col(G, i)[j] = value;
}

/* Products of the fields 1 and x: int x x' dm = tr(J_o) / 2 I - J_o, where J_o
   is the inertia about the origin. */
static void put_rigid(const ritz_inertia *inertia, ritz_dense *G)
{
    const double *c = inertia->centre;
    const double *J = inertia->tensor;
    double m = inertia->mass;
    double trace = J[0] + J[4] + J[8];

    put_pair(G, 0, 0, m);
    for (int a = 0; a < 3; a++) {
        put_pair(G, 0, 1 + a, m * c[a]);
        for (int b = 0; b <= a; b++)
            put_pair(G, 1 + a, 1 + b,
                     m * c[a] * c[b] + (a == b ? trace / 2.0 : 0.0) -
                         (J[3 * a + b] + J[3 * b + a]) / 2.0);
    }
}

/* Products of the fields 1 and x with mode j. */
static void put_momenta(const ritz_invariants *of, int64_t j, ritz_dense *G)
{
    int64_t m = of->momentum.ncol;
    const double *linear = ritz_dense_col(&of->momentum, j);
    const double *angular = linear + 3;

    for (int a = 0; a < 3; a++) {
        put_pair(G, 0, 4 + a * m + j, linear[a]);
        for (int b = 0; b < 3; b++) {
            double sum = ritz_dense_col(&of->position, b * m + j)[a] +
                         ritz_dense_col(&of->position, a * m + j)[b];
            /* x_a psi_b - x_b psi_a = e_abc (x x psi)_c */
            double turn = 0.0;

            if (b == (a + 1) % 3)
                turn = angular[(a + 2) % 3];
            else if (a == (b + 1) % 3)
                turn = -angular[(b + 2) % 3];

            put_pair(G, 1 + a, 4 + b * m + j, (sum + turn) / 2.0);
        }
    }
}

static ritz_status multiply_fields(const ritz_inertia *inertia,
                                   const ritz_invariants *of, ritz_dense *G)
{
    int64_t m = of->momentum.ncol;

    RITZ_CHECK(ritz_dense_new(4 + 3 * m, 4 + 3 * m, G));
    put_rigid(inertia, G);
    for (int64_t j = 0; j < m; j++)
        put_momenta(of, j, G);
    ritz_dense_put(&of->product, 4, 4, G);
    return RITZ_OK;
}

/*
 * The sizes by which fields are scaled: that of a mode is the square root of
 * its modal mass, since the product of a mode of rotations with itself may be
 * 0.
 */
static ritz_status size_fields(const ritz_inertia *inertia, const ritz_dense *G,
                               const ritz_dense *M, double **size)
{
    double square = 0.0;

    RITZ_CHECK_NEW(*size, G->ncol);
    (*size)[0] = sqrt(inertia->mass);
    for (int a = 1; a < 4; a++)
        square += fabs(ritz_dense_col(G, a)[a]);
    for (int a = 1; a < 4; a++)
        (*size)[a] = sqrt(square);
    for (int64_t f = 4; f < G->ncol; f++) {
        int64_t j = (f - 4) % M->ncol;

        (*size)[f] =
            sqrt(fmax(ritz_dense_col(M, j)[j], fabs(ritz_dense_col(G, f)[f])));
    }
    for (int64_t f = 0; f < G->ncol; f++)
        if (!((*size)[f] > 0.0)) /* a field that is zero */
            (*size)[f] = 1.0;
    return RITZ_OK;
}

/* ---- points ------------------------------------------------------------- */

/* Eigenvectors and eigenvalues of G, for fields divided by their sizes. */
typedef struct field_axes {
    ritz_dense Q;
    double *lambda, *size;
} field_axes;

static void field_axes_free(field_axes *axes)
{
    ritz_dense_free(&axes->Q);
    RITZ_FREE(axes->lambda, axes->size);
}

static ritz_status find_axes(const ritz_inertia *inertia,
                             const ritz_invariants *invariants,
                             const ritz_dense *M, field_axes *out)
{
    int64_t p = 0;
    ritz_dense *G = &out->Q;

    RITZ_CHECK(multiply_fields(inertia, invariants, G));
    RITZ_CHECK(size_fields(inertia, G, M, &out->size));
    p = G->ncol;
    RITZ_CHECK_NEW(out->lambda, p);
    for (int64_t k = 0; k < p * p; k++)
        G->val[k] /= out->size[k % p] * out->size[k / p];
    ritz_dense_symmetrise(G);
    RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)p, G->val,
                                 (int)p, out->lambda) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the invariants of inertia have no eigenvalues");
    return RITZ_OK;
}

/* Number of eigenvalues of one sign that are not rounding errors. */
static int64_t count_of_sign(const field_axes *axes, double sign)
{
    int64_t count = 0;

    for (int64_t k = 0; k < axes->Q.ncol; k++)
        count += sign * axes->lambda[k] > RITZ_INVARIANT_ROUNDING;
    return count;
}

/* B has a row sqrt(|lambda|) q' for each eigenvalue of one sign and, if
   `paired`, the row e_1'. */
static ritz_status list_rows(const field_axes *axes, double sign, bool paired,
                             ritz_dense *B)
{
    int64_t p = axes->Q.ncol;
    int64_t row = 0;

    RITZ_CHECK(ritz_dense_new(count_of_sign(axes, sign) + paired, p, B));
    for (int64_t k = 0; k < p; k++) {
        double root = sqrt(fabs(axes->lambda[k]));

        if (!(sign * axes->lambda[k] > RITZ_INVARIANT_ROUNDING))
            continue;
        for (int64_t f = 0; f < p; f++)
            ritz_dense_col(B, f)[row] = root * ritz_dense_col(&axes->Q, k)[f];
        row++;
    }
    if (paired)
        B->val[row] = 1.0;
    return RITZ_OK;
}

/* B := (I - 2 v v'/ v'v) B, with v such that the first column becomes constant
   and positive. *out is that constant. */
static ritz_status level_first(ritz_dense *B, double *out)
{
    int64_t n = B->nrow;
    double sum = 0.0, square = 0.0, norm = 0.0;
    RITZ_OWN_ARRAY double *v = NULL;

    RITZ_CHECK_COPY(v, B->val, n);
    for (int64_t i = 0; i < n; i++) {
        sum += v[i];
        square += v[i] * v[i];
    }
    *out = sqrt(square / (double)n);
    /* v = b + s c 1 with s the sign of the sum: nothing cancels */
    for (int64_t i = 0; i < n; i++) {
        v[i] += sum < 0.0 ? -*out : *out;
        norm += v[i] * v[i];
    }
    for (int64_t f = 0; f < B->ncol; f++) {
        double *b = ritz_dense_col(B, f);
        double product = 0.0;

        for (int64_t i = 0; i < n; i++)
            product += v[i] * b[i];
        for (int64_t i = 0; i < n; i++) {
            b[i] -= 2.0 * product / norm * v[i];
            b[i] = sum < 0.0 ? b[i] : -b[i];
        }
    }
    return RITZ_OK;
}

/* Make points of the rows of B, from point `first` on. */
static ritz_status put_points(const field_axes *axes, double sign,
                              ritz_dense *B, int64_t first,
                              ritz_point_masses *out)
{
    double level = 0.0;
    const double *size = axes->size;

    if (B->nrow == 0)
        return RITZ_OK;
    RITZ_CHECK(level_first(B, &level));
    for (int64_t i = 0; i < B->nrow; i++)
        out->mass[first + i] = sign * level * level * size[0] * size[0];
    for (int64_t f = 1; f < B->ncol; f++)
        for (int64_t i = 0; i < B->nrow; i++)
            ritz_dense_col(&out->field, f - 1)[first + i] =
                ritz_dense_col(B, f)[i] / level * (size[f] / size[0]);
    return RITZ_OK;
}

ritz_status ritz_point_masses_of(const ritz_inertia *inertia,
                                 const ritz_invariants *invariants,
                                 const ritz_dense *M, ritz_point_masses *out)
{
    RITZ_OWN(field_axes) axes = {0};
    RITZ_OWN(ritz_dense) B = {0}, C = {0};
    RITZ_OWN(ritz_point_masses) points = {0};
    bool paired = false;

    RITZ_CHECK(find_axes(inertia, invariants, M, &axes));
    paired = count_of_sign(&axes, -1.0) > 0;
    points.least = axes.lambda[0] / axes.lambda[axes.Q.ncol - 1];
    RITZ_CHECK(list_rows(&axes, 1.0, paired, &B));
    RITZ_CHECK(list_rows(&axes, -1.0, paired, &C));
    points.num_negative = C.nrow;
    points.count = B.nrow + C.nrow;
    RITZ_CHECK_NEW(points.mass, points.count);
    RITZ_CHECK(ritz_dense_new(points.count, B.ncol - 1, &points.field));
    RITZ_CHECK(put_points(&axes, 1.0, &B, 0, &points));
    RITZ_CHECK(put_points(&axes, -1.0, &C, B.nrow, &points));
    RITZ_MOVE(*out, points);
    return RITZ_OK;
}
