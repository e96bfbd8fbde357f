/*
 * Constraints of bodies whose residual columns are responses to interface
 * forces [Rixen2004]. With multipliers lambda the forces of the joints are -C'
 * lambda. The residual coordinates p, whose K_pp is the flexibility F'Psi,
 * respond by
 *
 *     p = -K_pp^-1 C_p' lambda.
 *
 * Inserted into q'Kq/2 + p'K_pp p/2 + lambda'(C_q q + C_p p) this gives, with H
 * = C_p K_pp^-1,
 *
 *     K = [ Lambda   C_q'    ]    M = [ I   0         ]
 *         [ C_q     -H C_p'  ],       [ 0   H M_pp H' ]
 *
 * Here K_pp = L L' and C_p L'^-1 = U S V'. Of the rows of U'C those with a
 * singular value are taken as forces mu, lambda = U_1 S_1^-1 mu, so that their
 * block of K is -I; the others have no part in p and constrain q as in any
 * assembly, q = N y:
 *
 *     p = -L'^-1 V_1 mu,   X = [N, 0; 0, -L'^-1 V_1]
 *
 * X'KX has +I for mu; the constraints add -2I and C_1q N, C_1 = S_1^-1 U_1'C.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/squares.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/*
 * The transformation x = [q; p] = X [y; mu] to coordinates in which constraints
 * are forces, and K and M of the system in these.
 */
typedef struct dual {
    int64_t num_modal, num_force; /* q and p */
    int64_t *modal, *force;       /* which of the Q coordinates they are */
    int64_t rank;                 /* mu, singular values above rounding */
    ritz_dense L;                 /* p x p, lower: K_pp = L L' */
    ritz_dense U, V;              /* c x c, p x p: C_p L'^-1 = U S V' */
    double *sigma;                /* the lesser of c and p */
    ritz_dense K, M;              /* of the system */
    ritz_dense P; /* X, scaled coordinates; then from those of the system to
                     those of the bodies */
} dual;

static void dual_free(dual *d)
{
    RITZ_FREE(d->modal, d->force, d->sigma);
    ritz_dense_free(&d->L);
    ritz_dense_free(&d->U);
    ritz_dense_free(&d->V);
    ritz_dense_free(&d->K);
    ritz_dense_free(&d->M);
    ritz_dense_free(&d->P);
}

static ritz_status list_coordinates(const ritz_stage *stage, dual *d)
{
    RITZ_CHECK_NEW(d->modal, stage->num_coordinates);
    RITZ_CHECK_NEW(d->force, stage->num_coordinates);
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t j = 0; j < stage->body[k].K.ncol; j++)
            if (j < stage->body[k].columns.count &&
                stage->body[k].columns.kind[j] == RITZ_COLUMN_FORCE)
                d->force[d->num_force++] = stage->first[k] + j;
            else
                d->modal[d->num_modal++] = stage->first[k] + j;
    return RITZ_OK;
}

/* The Cholesky factor L of K_pp. */
static ritz_status factor_flexibility(const ritz_dense *K, dual *d)
{
    const int p = (int)d->num_force;
    RITZ_OWN(ritz_dense) columns = {0};

    RITZ_CHECK(ritz_dense_pick(K, p, d->force, &columns));
    RITZ_CHECK(ritz_dense_rows(&columns, p, d->force, &d->L));
    RITZ_REFUSE_IF(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', p, d->L.val, p) != 0,
                   RITZ_ERR_SINGULAR,
                   "the residual flexibility of force columns is not positive "
                   "definite");
    return RITZ_OK;
}

/* The singular value decomposition C_p L'^-1 = U S V'. */
static ritz_status decompose_constraints(const ritz_dense *C, dual *d)
{
    const int p = (int)d->num_force;
    const int64_t least = C->nrow < p ? C->nrow : p;
    RITZ_OWN(ritz_dense) W = {0};

    RITZ_CHECK(ritz_dense_pick(C, p, d->force, &W));
    if (least > 0)
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans,
                    CblasNonUnit, (int)C->nrow, p, 1.0, d->L.val, p, W.val,
                    (int)C->nrow);
    RITZ_CHECK_IN("the interface",
                  ritz_general_svd(&W, &d->U, &d->sigma, &d->V));
    while (d->rank < least && d->sigma[d->rank] > RITZ_RANK_LOSS * d->sigma[0])
        d->rank++;
    return RITZ_OK;
}

/* N, the null space for q of the constraints that have no part in p. */
static ritz_status constrain_modal(const dual *d, const ritz_dense *C_q,
                                   int64_t *rank, ritz_dense *N)
{
    const double most = ritz_dense_max(C_q);
    const ritz_dense U_0 = ritz_dense_part(&d->U, d->rank, d->U.ncol - d->rank);
    RITZ_OWN(ritz_dense) C_0 = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&U_0, C_q, &C_0));
    for (int64_t k = 0; k < C_0.nrow * C_0.ncol; k++)
        if (fabs(C_0.val[k]) <= RITZ_RANK_LOSS * most)
            C_0.val[k] = 0.0;
    return ritz_null_space(&C_0, rank, N);
}

/* Rows of A become those rows of X, columns from @p first on. */
static void scatter_rows(const ritz_dense *A, const int64_t *row, int64_t first,
                         ritz_dense *X)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(X, first + j)[row[i]] = ritz_dense_col(A, j)[i];
}

/* X = [N, 0; 0, -L'^-1 V_1], its rows in the order of the coordinates. */
static ritz_status build_transformation(const ritz_dense *N, dual *d)
{
    const int p = (int)d->num_force;
    RITZ_OWN(ritz_dense) Y = {0};

    RITZ_CHECK(ritz_dense_columns(&d->V, 0, d->rank, &Y));
    if (d->rank > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, p, (int)d->rank, -1.0, d->L.val, p, Y.val, p);
    RITZ_CHECK(ritz_dense_new(N->nrow + p, N->ncol + d->rank, &d->P));
    scatter_rows(N, d->modal, 0, &d->P);
    scatter_rows(&Y, d->force, N->ncol, &d->P);
    return RITZ_OK;
}

/* K += [0, (C_1q N)'; C_1q N, -2 I]. */
static ritz_status add_joint(const ritz_dense *C_q, const ritz_dense *N,
                             dual *d)
{
    const int64_t y = N->ncol;
    const ritz_dense U_1 = ritz_dense_part(&d->U, 0, d->rank);
    RITZ_OWN(ritz_dense) C_1 = {0}, G = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&U_1, C_q, &C_1));
    RITZ_CHECK(ritz_dense_mul(&C_1, N, &G));
    for (int64_t i = 0; i < d->rank; i++) {
        ritz_dense_col(&d->K, y + i)[y + i] += -2.0;
        for (int64_t j = 0; j < y; j++) {
            const double g = ritz_dense_col(&G, j)[i] / d->sigma[i];

            ritz_dense_col(&d->K, y + i)[j] += g;
            ritz_dense_col(&d->K, j)[y + i] += g;
        }
    }
    return RITZ_OK;
}

/*
 * Dual assembly [Rixen2004]: the system in modal coordinates and interface
 * forces, with X and joint as above,
 *
 *     K_z = X'KX + joint,   M_z = X'MX,   z = [y; mu].
 *
 * K_z is indefinite, for the forces of a few static shapes hold a joint only
 * approximately: there are about as many negative eigenvalues as forces, -1/m
 * of the order of the residual frequencies squared. They are kept and counted.
 * Forces without mass are condensed, mu_0 = -K_00^-1 K_0z z, before the modes
 * are computed. The modes are sorted by |lambda|, rigid ones first.
 */

/* The first body with force columns, -1 if there is none. */
static int64_t find_body(const ritz_stage *stage)
{
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t j = 0; j < stage->body[k].columns.count; j++)
            if (stage->body[k].columns.kind[j] == RITZ_COLUMN_FORCE)
                return k;
    return -1;
}

bool ritz_dual_is_due(const ritz_stage *stage)
{
    return find_body(stage) >= 0;
}

ritz_status ritz_dual_refuse(const ritz_stage *stage)
{
    int64_t k = find_body(stage);

    RITZ_REFUSE_IF(k >= 0, RITZ_ERR_ARGUMENT,
                   "component '%s' is reduced by dual-craig-bampton: a system "
                   "of such has negative eigenvalues, and no modes to choose "
                   "from; macneal-rubin has the same columns",
                   stage->scene->component[k].name);
    return RITZ_OK;
}

/* diag(A_1, A_2, ...) of K or M of the bodies, in scaled coordinates. */
static ritz_status stack_blocks(const ritz_stage *stage, size_t offset,
                                ritz_dense *out)
{
    const double *scale = stage->scale;

    RITZ_CHECK(
        ritz_dense_new(stage->num_coordinates, stage->num_coordinates, out));
    for (int64_t k = 0; k < stage->count; k++) {
        const void *at = (const char *)&stage->body[k] + offset;
        const ritz_dense *A = at;
        int64_t first = stage->first[k];

        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t i = 0; i < A->nrow; i++)
                ritz_dense_col(out, first + j)[first + i] =
                    scale[first + i] * scale[first + j] *
                    ritz_dense_col(A, j)[i];
    }
    return RITZ_OK;
}

/* K, M and P in new coordinates, z = Z w. */
static ritz_status transform_pencil(const ritz_dense *Z, dual *d)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, P = {0};

    RITZ_CHECK(ritz_dense_congruence(&d->K, Z, &K));
    RITZ_CHECK(ritz_dense_congruence(&d->M, Z, &M));
    RITZ_CHECK(ritz_dense_mul(&d->P, Z, &P));
    ritz_dense_replace(&d->K, &K);
    ritz_dense_replace(&d->M, &M);
    ritz_dense_replace(&d->P, &P);
    return RITZ_OK;
}

/* K_z and M_z; on return P leads to coordinates that are not scaled. */
static ritz_status make_pencil(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *C,
                               dual *d, int64_t *rank)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, C_q = {0}, N = {0};

    RITZ_CHECK(list_coordinates(stage, d));
    RITZ_CHECK(stack_blocks(stage, offsetof(ritz_reduced, K), &K));
    RITZ_CHECK(stack_blocks(stage, offsetof(ritz_reduced, M), &M));
    RITZ_CHECK(factor_flexibility(&K, d));
    RITZ_CHECK(decompose_constraints(C, d));
    RITZ_CHECK(ritz_dense_pick(C, d->num_modal, d->modal, &C_q));
    RITZ_CHECK(constrain_modal(d, &C_q, rank, &N));
    *rank += d->rank;
    RITZ_CHECK(build_transformation(&N, d));
    RITZ_CHECK(ritz_dense_congruence(&K, &d->P, &d->K));
    RITZ_CHECK(ritz_dense_congruence(&M, &d->P, &d->M));
    RITZ_CHECK(add_joint(&C_q, &N, d));
    ritz_dense_scale_rows(stage->scale, &d->P);
    return ritz_springs_add(springs, false, &d->P, &d->K);
}

/*
 * Z = diag(I, Y) with Y the eigenvectors of the forces' mass, forces without
 * mass last. Their eigenvalue is rounding relative to the largest. Their number
 * is the result.
 */
static ritz_status diagonalise_forces(const dual *d, ritz_dense *Z,
                                      int64_t *massless)
{
    const int64_t forces = d->rank, y = d->M.ncol - forces;
    RITZ_OWN(ritz_dense) Y = {0};
    RITZ_OWN_ARRAY double *m = NULL;

    *massless = 0;
    RITZ_CHECK_NEW(m, forces);
    RITZ_CHECK(ritz_dense_block(&d->M, y, forces, y, forces, &Y));
    RITZ_CHECK(ritz_dense_identity(d->M.ncol, Z));
    RITZ_REFUSE_IF(forces > 0 &&
                       LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)forces,
                                      Y.val, (int)forces, m) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the mass of interface forces has no eigenvalues");
    for (int64_t j = 0; j < forces; j++) { /* dsyevd ascends */
        const ritz_dense one = ritz_dense_part(&Y, forces - 1 - j, 1);

        ritz_dense_put(&one, y, y + j, Z);
    }
    while (*massless < forces && m[*massless] <= 4.0 * (double)forces *
                                                     DBL_EPSILON *
                                                     fmax(m[forces - 1], 0.0))
        (*massless)++;
    return RITZ_OK;
}

/* Z = [I; -K_00^-1 K_0z]: condense the last coordinates, which have no mass. */
static ritz_status condense_massless(int64_t massless, dual *d)
{
    const int64_t rest = d->K.ncol - massless;
    const int n = (int)massless;
    RITZ_OWN(ritz_dense) K_00 = {0}, K_0 = {0}, Z = {0};
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;

    RITZ_CHECK_NEW(pivot, massless);
    RITZ_CHECK(ritz_dense_block(&d->K, rest, n, rest, n, &K_00));
    RITZ_CHECK(ritz_dense_block(&d->K, rest, n, 0, rest, &K_0));
    RITZ_CHECK(ritz_dense_new(rest + massless, rest, &Z));
    RITZ_REFUSE_IF(
        rest > 0 && LAPACKE_dsysv(LAPACK_COL_MAJOR, 'L', n, (int)rest, K_00.val,
                                  n, pivot, K_0.val, n) != 0,
        RITZ_ERR_SINGULAR, "interface forces without mass have no stiffness");
    for (int64_t j = 0; j < rest; j++)
        ritz_dense_col(&Z, j)[j] = 1.0;
    ritz_general_place(-1.0, &K_0, false, rest, 0, &Z);
    return transform_pencil(&Z, d);
}

/* Fill lambda and num_rigid of the configuration; P becomes P Phi. */
static ritz_status order_modes(ritz_pairs *pairs, ritz_dense *P,
                               ritz_configuration *c)
{
    RITZ_CHECK(ritz_pairs_by_size(pairs));
    RITZ_CHECK_COPY(c->lambda, pairs->lambda, pairs->Phi.ncol);
    c->num_rigid = pairs->num_rigid;
    return ritz_dense_times(&pairs->Phi, P);
}

/* Report the number of negative eigenvalues and the one nearest to 0. */
static ritz_status report_negative(int64_t modes, ritz_configuration *c)
{
    int64_t count = 0;
    int64_t first = -1;
    char where[RITZ_NAME_SIZE] = "";

    for (int64_t k = c->num_rigid; k < modes; k++)
        if (c->lambda[k] < 0.0) {
            first = first < 0 ? k : first;
            count++;
        }
    if (count > 0)
        snprintf(where, sizeof where, "first: mode %" PRId64 ", %.4g Hz",
                 first + 1, ritz_eigen_hertz(c->lambda[first]));
    return ritz_measures_add(&c->errors, RITZ_NEGATIVE_SQUARES, (double)count,
                             0.0, where);
}

ritz_status ritz_dual_assemble(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *C,
                               ritz_dense *P, ritz_configuration *c)
{
    RITZ_OWN(dual) d = {0};
    RITZ_OWN(ritz_dense) Z = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t massless = 0;

    RITZ_CHECK(make_pencil(stage, springs, C, &d, &c->rank));
    RITZ_CHECK(diagonalise_forces(&d, &Z, &massless));
    RITZ_CHECK(transform_pencil(&Z, &d));
    if (massless > 0)
        RITZ_CHECK(condense_massless(massless, &d));
    RITZ_CHECK_IN("system modes", ritz_eigen_dense(&d.K, &d.M, &pairs));
    RITZ_CHECK(order_modes(&pairs, &d.P, c));
    RITZ_CHECK(report_negative(d.P.ncol, c));
    RITZ_MOVE(*P, d.P);
    return RITZ_OK;
}
