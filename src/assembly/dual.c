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
#include <ritz/assembly.h>

#include "assembly/constraints.h"
#include "assembly/dual.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Dual assembly: a transformation to coordinates in which constraints are
 * forces.
 */

/*
 * With the constraints C_q q + C_p p = 0 of modal coordinates q and force
 * coordinates p, x = [q; p] = X [y; mu], and the matrix that the constraints
 * add to X'KX, as above.
 */
typedef struct ritz_dual {
    int64_t rank;       /* of the constraints */
    ritz_dense X;       /* Q x (y + mu), scaled coordinates */
    ritz_dense joint;   /* (y + mu) square, symmetric */
    int64_t num_forces; /* mu, the last of the columns */
} ritz_dual;

/* The columns of A whose flag is `wanted`. */
static ritz_status select_columns(const ritz_dense *A, const bool *flag,
                                  bool wanted, ritz_dense *out)
{
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++)
        count += flag[j] == wanted;
    RITZ_CHECK(ritz_dense_new(A->nrow, count, out));
    count = 0;
    for (int64_t j = 0; j < A->ncol; j++)
        if (flag[j] == wanted && A->nrow > 0)
            memcpy(ritz_dense_col(out, count++), ritz_dense_col(A, j),
                   (size_t)A->nrow * sizeof *A->val);
    return RITZ_OK;
}

/* The Cholesky factor L of K_pp. */
static ritz_status factor_flexibility(const ritz_dense *K, const bool *is_force,
                                      ritz_dense *L)
{
    RITZ_OWN(ritz_dense) columns = {0};
    int64_t p = 0;

    RITZ_CHECK(select_columns(K, is_force, true, &columns));
    RITZ_CHECK(ritz_dense_new(columns.ncol, columns.ncol, L));
    for (int64_t j = 0; j < L->ncol; j++) {
        p = 0;
        for (int64_t i = 0; i < K->nrow; i++)
            if (is_force[i])
                ritz_dense_col(L, j)[p++] = ritz_dense_col(&columns, j)[i];
    }
    p = L->ncol;
    RITZ_REFUSE_IF(
        LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)p, L->val, (int)p) != 0,
        RITZ_ERR_SINGULAR,
        "the residual flexibility of force columns is not positive "
        "definite");
    return RITZ_OK;
}

/* The singular value decomposition W = C_p L'^-1 = U S V'. */
typedef struct split {
    int64_t rank;     /* singular values above rounding */
    ritz_dense L;     /* p x p, lower */
    ritz_dense U, Vt; /* c x c, p x p */
    double *sigma;    /* the lesser of c and p */
} split;

static ritz_status decompose_constraints(const ritz_dense *C,
                                         const bool *is_force, split *s)
{
    RITZ_OWN(ritz_dense) W = {0};
    int c = (int)C->nrow;
    int p = (int)s->L.ncol;
    int least = c < p ? c : p;

    RITZ_CHECK(select_columns(C, is_force, true, &W));
    RITZ_CHECK(ritz_dense_new(c, c, &s->U));
    RITZ_CHECK(ritz_dense_new(p, p, &s->Vt));
    RITZ_CHECK_NEW(s->sigma, least);
    if (least == 0)
        return RITZ_OK;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                c, p, 1.0, s->L.val, p, W.val, c);
    RITZ_REFUSE_IF(LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'A', c, p, W.val, c,
                                  s->sigma, s->U.val, c, s->Vt.val, p) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "singular values of the interface do not converge");
    while (s->rank < least && s->sigma[s->rank] > RITZ_RANK_LOSS * s->sigma[0])
        s->rank++;
    return RITZ_OK;
}

/* N, the null space for q of the constraints that have no part in p. */
static ritz_status constrain_modal(const split *s, const ritz_dense *C_q,
                                   int64_t *rank, ritz_dense *N)
{
    double most = ritz_dense_max(C_q);
    RITZ_OWN(ritz_dense) U_0 = {0}, C_0 = {0};

    if (s->sigma && s->L.ncol > 0)
        RITZ_CHECK(
            ritz_dense_columns(&s->U, s->rank, s->U.ncol - s->rank, &U_0));
    if (s->L.ncol > 0)
        RITZ_CHECK(ritz_dense_mul_tn(&U_0, C_q, &C_0));
    else
        RITZ_CHECK(ritz_dense_copy(C_q, &C_0));
    for (int64_t k = 0; k < C_0.nrow * C_0.ncol; k++)
        if (fabs(C_0.val[k]) <= RITZ_RANK_LOSS * most)
            C_0.val[k] = 0.0;
    return ritz_null_space(&C_0, rank, N);
}

/* X = [N, 0; 0, -L'^-1 V_1], its rows in the order of the coordinates. */
static ritz_status build_transformation(split *s, const bool *is_force,
                                        const ritz_dense *N, ritz_dense *X)
{
    int p = (int)s->L.ncol;
    int64_t rows[2] = {0, 0};
    RITZ_OWN(ritz_dense) Y = {0};

    RITZ_CHECK(ritz_dense_new(p, s->rank, &Y));
    for (int64_t j = 0; j < s->rank; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&Y, j)[i] = -ritz_dense_col(&s->Vt, i)[j];
    if (s->rank > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, p, (int)s->rank, 1.0, s->L.val, p, Y.val, p);
    RITZ_CHECK(ritz_dense_new(N->nrow + p, N->ncol + s->rank, X));
    for (int64_t i = 0; i < X->nrow; i++) {
        const ritz_dense *from = is_force[i] ? &Y : N;
        int64_t first = is_force[i] ? N->ncol : 0;
        int64_t row = rows[is_force[i]]++;

        for (int64_t j = 0; j < from->ncol; j++)
            ritz_dense_col(X, first + j)[i] = ritz_dense_col(from, j)[row];
    }
    return RITZ_OK;
}

/* joint = [0, (C_1q N)'; C_1q N, -2 I]. */
static ritz_status add_joint(const split *s, const ritz_dense *C_q,
                             const ritz_dense *N, ritz_dense *joint)
{
    int64_t y = N->ncol;
    RITZ_OWN(ritz_dense) U_1 = {0}, C_1 = {0}, G = {0};

    RITZ_CHECK(ritz_dense_new(y + s->rank, y + s->rank, joint));
    RITZ_CHECK(ritz_dense_columns(&s->U, 0, s->rank, &U_1));
    RITZ_CHECK(ritz_dense_mul_tn(&U_1, C_q, &C_1));
    RITZ_CHECK(ritz_dense_mul(&C_1, N, &G));
    for (int64_t i = 0; i < s->rank; i++) {
        ritz_dense_col(joint, y + i)[y + i] = -2.0;
        for (int64_t j = 0; j < y; j++)
            ritz_dense_col(joint, y + i)[j] = ritz_dense_col(joint, j)[y + i] =
                ritz_dense_col(&G, j)[i] / s->sigma[i];
    }
    return RITZ_OK;
}

static void split_free(split *s)
{
    ritz_dense_free(&s->L);
    ritz_dense_free(&s->U);
    ritz_dense_free(&s->Vt);
    free(s->sigma);
}

static void ritz_dual_free(ritz_dual *dual)
{
    ritz_dense_free(&dual->X);
    ritz_dense_free(&dual->joint);
}

/*
 * @param[in] K        Q x Q, of all bodies, scaled coordinates
 * @param[in] C        c x Q, the same
 * @param[in] is_force Q, which coordinates are p
 */
static ritz_status new_dual(const ritz_dense *K, const ritz_dense *C,
                            const bool *is_force, ritz_dual *out)
{
    RITZ_OWN(split) s = {0};
    RITZ_OWN(ritz_dense) C_q = {0}, N = {0};

    RITZ_CHECK(factor_flexibility(K, is_force, &s.L));
    RITZ_CHECK(decompose_constraints(C, is_force, &s));
    RITZ_CHECK(select_columns(C, is_force, false, &C_q));
    RITZ_CHECK(constrain_modal(&s, &C_q, &out->rank, &N));
    RITZ_CHECK(build_transformation(&s, is_force, &N, &out->X));
    RITZ_CHECK(add_joint(&s, &C_q, &N, &out->joint));
    out->rank += s.rank;
    out->num_forces = s.rank;
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

/*
 * diag(A_1, A_2, ...), with a zero block for a body without the matrix; {0} if
 * no body has it.
 */
static ritz_status stack_blocks(const ritz_stage *stage, size_t offset,
                                const double *scale, ritz_dense *out)
{
    bool any = false;

    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_dense *A = ritz_body_matrix(&stage->body[k], offset);
        int64_t first = stage->first[k];

        if (!A->val)
            continue;
        if (!any)
            RITZ_CHECK(ritz_dense_new(stage->num_coordinates,
                                      stage->num_coordinates, out));
        any = true;
        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t i = 0; i < A->nrow; i++)
                ritz_dense_col(out, first + j)[first + i] =
                    (scale ? scale[first + i] * scale[first + j] : 1.0) *
                    ritz_dense_col(A, j)[i];
    }
    return RITZ_OK;
}

/*
 * K and M of the system, and P from its coordinates, first scaled, to those of
 * the bodies.
 */
typedef struct dual_pencil {
    ritz_dense K, M, P;
} dual_pencil;

static void dual_pencil_free(dual_pencil *of)
{
    ritz_dense_free(&of->K);
    ritz_dense_free(&of->M);
    ritz_dense_free(&of->P);
}

/* Transform K, M and P to new coordinates, z = Z w. */
static ritz_status transform_pencil(const ritz_dense *Z, dual_pencil *of)
{
    RITZ_OWN(dual_pencil) to = {0};

    RITZ_CHECK(ritz_dense_congruence(&of->K, Z, &to.K));
    RITZ_CHECK(ritz_dense_congruence(&of->M, Z, &to.M));
    RITZ_CHECK(ritz_dense_mul(&of->P, Z, &to.P));
    dual_pencil_free(of);
    RITZ_MOVE(*of, to);
    return RITZ_OK;
}

static ritz_status make_pencil(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *K,
                               const ritz_dual *dual, const double *scale,
                               dual_pencil *out)
{
    RITZ_OWN(ritz_dense) M = {0};
    ritz_dense none = {0};

    RITZ_CHECK(stack_blocks(stage, offsetof(ritz_reduced, M), scale, &M));
    RITZ_CHECK(ritz_dense_congruence(K, &dual->X, &out->K));
    RITZ_CHECK(ritz_dense_congruence(&M, &dual->X, &out->M));
    RITZ_CHECK(ritz_dense_copy(&dual->X, &out->P));
    for (int64_t j = 0; j < out->P.ncol; j++)
        for (int64_t i = 0; i < out->P.nrow; i++)
            ritz_dense_col(&out->P, j)[i] *= scale[i];
    for (int64_t k = 0; k < out->K.nrow * out->K.ncol; k++)
        out->K.val[k] += dual->joint.val[k];
    return ritz_springs_add(springs, &out->P, &out->K, &none);
}

/*
 * Z = diag(I, Y) with Y the eigenvectors of the forces' mass, forces without
 * mass last. Their eigenvalue is rounding relative to the largest. Their number
 * is the result.
 */
static ritz_status diagonalise_forces(const ritz_dense *M, int64_t forces,
                                      ritz_dense *Z, int64_t *massless)
{
    int64_t y = M->ncol - forces;
    RITZ_OWN(ritz_dense) Y = {0};
    RITZ_OWN_ARRAY double *m = NULL;

    *massless = 0;
    RITZ_CHECK_NEW(m, forces);
    RITZ_CHECK(ritz_dense_new(forces, forces, &Y));
    RITZ_CHECK(ritz_dense_new(M->ncol, M->ncol, Z));
    for (int64_t j = 0; j < forces; j++)
        for (int64_t i = 0; i < forces; i++)
            ritz_dense_col(&Y, j)[i] = ritz_dense_col(M, y + j)[y + i];
    RITZ_REFUSE_IF(forces > 0 &&
                       LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)forces,
                                      Y.val, (int)forces, m) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the mass of interface forces has no eigenvalues");
    for (int64_t j = 0; j < y; j++)
        ritz_dense_col(Z, j)[j] = 1.0;
    for (int64_t j = 0; j < forces; j++) /* dsyevd ascends */
        memcpy(ritz_dense_col(Z, y + forces - 1 - j) + y, ritz_dense_col(&Y, j),
               (size_t)forces * sizeof *Y.val);
    while (*massless < forces && m[*massless] <= 4.0 * (double)forces *
                                                     DBL_EPSILON *
                                                     fmax(m[forces - 1], 0.0))
        (*massless)++;
    return RITZ_OK;
}

/* Z = [I; -K_00^-1 K_0z]: condense the last coordinates, which have no mass. */
static ritz_status condense_massless(int64_t massless, dual_pencil *of)
{
    int64_t rest = of->K.ncol - massless;
    RITZ_OWN(ritz_dense) K_00 = {0}, K_0 = {0}, Z = {0};
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    int n = (int)massless;

    RITZ_CHECK_NEW(pivot, massless);
    RITZ_CHECK(ritz_dense_new(massless, massless, &K_00));
    RITZ_CHECK(ritz_dense_new(massless, rest, &K_0));
    RITZ_CHECK(ritz_dense_new(rest + massless, rest, &Z));
    for (int64_t j = 0; j < rest + massless; j++) {
        double *to = j < rest ? ritz_dense_col(&K_0, j)
                              : ritz_dense_col(&K_00, j - rest);

        memcpy(to, ritz_dense_col(&of->K, j) + rest,
               (size_t)massless * sizeof *to);
    }
    RITZ_REFUSE_IF(
        rest > 0 && LAPACKE_dsysv(LAPACK_COL_MAJOR, 'L', n, (int)rest, K_00.val,
                                  n, pivot, K_0.val, n) != 0,
        RITZ_ERR_SINGULAR, "interface forces without mass have no stiffness");
    for (int64_t j = 0; j < rest; j++) {
        ritz_dense_col(&Z, j)[j] = 1.0;
        for (int64_t i = 0; i < massless; i++)
            ritz_dense_col(&Z, j)[rest + i] = -ritz_dense_col(&K_0, j)[i];
    }
    return transform_pencil(&Z, of);
}

/* The modes found, and their order, by |lambda|. */
typedef struct force_place {
    double size;
    int64_t from;
} force_place;

static int compare_magnitude(const void *left, const void *right)
{
    const force_place *a = left;
    const force_place *b = right;

    return a->size != b->size ? (a->size > b->size) - (a->size < b->size)
                              : (a->from > b->from) - (a->from < b->from);
}

/* Fill lambda, num_rigid, K and M of the configuration; P becomes P Phi. */
static ritz_status order_modes(const ritz_pairs *pairs, ritz_dense *P,
                               ritz_configuration *c)
{
    int64_t e = pairs->Phi.ncol;
    RITZ_OWN(ritz_dense) Phi = {0}, Q = {0};
    RITZ_OWN_ARRAY force_place *at = NULL;
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(at, e);
    RITZ_CHECK_NEW(size, e);
    RITZ_CHECK_NEW(c->lambda, e);
    RITZ_CHECK(ritz_dense_new(pairs->Phi.nrow, e, &Phi));
    RITZ_CHECK(ritz_dense_new(e, e, &c->K));
    RITZ_CHECK(ritz_dense_new(e, e, &c->M));
    for (int64_t j = 0; j < e; j++)
        at[j] = (force_place){fabs(pairs->lambda[j]), j};
    if (e > 0)
        qsort(at, (size_t)e, sizeof *at, compare_magnitude);
    for (int64_t j = 0; j < e; j++) {
        size[j] = at[j].size;
        c->lambda[j] = pairs->lambda[at[j].from];
        ritz_dense_col(&c->K, j)[j] = c->lambda[j];
        ritz_dense_col(&c->M, j)[j] = 1.0;
        memcpy(ritz_dense_col(&Phi, j), ritz_dense_col(&pairs->Phi, at[j].from),
               (size_t)Phi.nrow * sizeof *Phi.val);
    }
    c->num_rigid = ritz_eigen_rigid(e, size, e > 0 ? size[e - 1] : 0.0);
    RITZ_CHECK(ritz_dense_mul(P, &Phi, &Q));
    ritz_dense_free(P);
    RITZ_MOVE(*P, Q);
    return RITZ_OK;
}

/* Report the number of negative eigenvalues and the one nearest to 0. */
static ritz_status report_negative(ritz_configuration *c)
{
    int64_t count = 0;
    int64_t first = -1;
    char where[RITZ_NAME_SIZE] = "";

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        if (c->lambda[k] < 0.0) {
            first = first < 0 ? k : first;
            count++;
        }
    if (count > 0)
        snprintf(where, sizeof where, "first: mode %" PRId64 ", %.4g Hz",
                 first + 1, ritz_eigen_hertz(c->lambda[first]));
    return ritz_measures_add(&c->errors, "negative-eigenvalues", (double)count,
                             0.0, where);
}

/* P'DP and the damping of the springs; {0} without damping. */
static ritz_status add_damping(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *P,
                               ritz_configuration *c)
{
    RITZ_OWN(ritz_dense) D = {0}, none = {0};

    RITZ_CHECK(stack_blocks(stage, offsetof(ritz_reduced, D), NULL, &D));
    if (D.val)
        RITZ_CHECK(ritz_dense_project(&D, P, &c->D));
    else if (ritz_springs_damp(springs))
        RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, &c->D));
    if (c->D.val) {
        RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, &none));
        RITZ_CHECK(ritz_springs_add(springs, P, &none, &c->D));
    }
    return RITZ_OK;
}

/* The pencil with its forces diagonalised, and those without mass condensed. */
static ritz_status prepare_pencil(const ritz_stage *stage,
                                  const ritz_springs *springs,
                                  const ritz_dense *C, const double *scale,
                                  dual_pencil *of, int64_t *rank)
{
    RITZ_OWN(ritz_dual) dual = {0};
    RITZ_OWN(ritz_dense) K = {0}, Z = {0};
    RITZ_OWN_ARRAY bool *is_force = NULL;
    int64_t massless = 0;

    RITZ_CHECK_NEW(is_force, stage->num_coordinates);
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t j = 0; j < stage->body[k].columns.count; j++)
            is_force[stage->first[k] + j] =
                stage->body[k].columns.kind[j] == RITZ_COLUMN_FORCE;
    RITZ_CHECK(stack_blocks(stage, offsetof(ritz_reduced, K), scale, &K));
    RITZ_CHECK(new_dual(&K, C, is_force, &dual));
    RITZ_CHECK(make_pencil(stage, springs, &K, &dual, scale, of));
    RITZ_CHECK(diagonalise_forces(&of->M, dual.num_forces, &Z, &massless));
    RITZ_CHECK(transform_pencil(&Z, of));
    if (massless > 0)
        RITZ_CHECK(condense_massless(massless, of));
    *rank = dual.rank;
    return RITZ_OK;
}

ritz_status ritz_dual_assemble(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *C,
                               const double *scale, ritz_dense *P,
                               ritz_configuration *c)
{
    RITZ_OWN(dual_pencil) of = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(prepare_pencil(stage, springs, C, scale, &of, &c->rank));
    RITZ_CHECK_IN("system modes", ritz_eigen_dense(&of.K, &of.M, &pairs));
    RITZ_CHECK(order_modes(&pairs, &of.P, c));
    RITZ_CHECK(add_damping(stage, springs, &of.P, c));
    RITZ_CHECK(report_negative(c));
    RITZ_MOVE(*P, of.P);
    return RITZ_OK;
}
