/*
 * The space on which models are projected: block Krylov vectors of K_s^-1 M
 * that begin with the static responses to all loads F = [B, C', Cv', P],
 *
 *     V_1 = K_s^-1 F,   V_j+1 = K_s^-1 M V_j,   V'K_s V = I,   V'M V = T,
 *
 *     M V = K_s (V T + v h),   v the next block, h = v'M (last block of V),
 *
 * T is block tridiagonal, and one factor of K_s = K + mu M serves for all
 * blocks; mu is 0 if K is positive definite. Displacements and velocities are
 * projected on the same space, so that the projected model is one of second
 * order with symmetric matrices, and stable.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/projection.h"
#include "linear/general.h"

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIRST_ROOM = 64, /* columns */
    PASSES = 3       /* of orthogonalisation, at most */
};

static ritz_status factor_shifted(ritz_projection_space *space)
{
    const ritz_low_rank_model *low = &space->model->low;

    space->mu = low->Phi.ncol > 0 ? low->lowest : 0.0;
    RITZ_CHECK(ritz_sparse_add(1.0, &low->K, space->mu, &low->M, &space->Ks));
    return ritz_context(ritz_factor_spd(&space->Ks, &space->F),
                        "stiffness of the projection");
}

/* F = [B, C', Cv', P] */
static ritz_status collect_loads(const ritz_projection_model *model,
                                 ritz_dense *out)
{
    const ritz_dense *const parts[] = {
        &model->low.W[RITZ_CONTROLLABLE][RITZ_BELOW],
        &model->low.W[RITZ_OBSERVABLE][RITZ_ABOVE],
        &model->low.W[RITZ_OBSERVABLE][RITZ_BELOW], &model->P};
    int64_t at = 0;

    RITZ_CHECK(ritz_dense_new(
        model->low.n, model->inputs + 2 * model->outputs + model->P.ncol, out));
    for (int k = 0; k < 4; k++) {
        ritz_dense_put(parts[k], 0, at, out);
        at += parts[k]->ncol;
    }
    return RITZ_OK;
}

/* Enlarge A to nrow x ncol, filled up with zeros. */
static ritz_status grow_dense(int64_t nrow, int64_t ncol, ritz_dense *A)
{
    RITZ_OWN(ritz_dense) grown = {0};

    RITZ_CHECK(ritz_dense_new(nrow, ncol, &grown));
    ritz_dense_put(A, 0, 0, &grown);
    ritz_dense_replace(A, &grown);
    return RITZ_OK;
}

/* Allocate memory for `more` columns of V, and for T and V'F of that size. V is
   by far the largest, and is not copied; its new columns have no values. */
static ritz_status reserve_columns(int64_t more, ritz_projection_space *space)
{
    const int64_t n = space->model->low.n, needed = space->count + more;
    const int64_t room = needed + needed / 2 + FIRST_ROOM;

    RITZ_REFUSE_IF(needed > space->model->most, RITZ_ERR_CONVERGENCE,
                   "the Gramians are not found in a space of %" PRId64
                   " vectors, the most that memory allows: take more damping, "
                   "fewer inputs and outputs, or engine 'modal' with "
                   "--among-hz",
                   space->model->most);
    if (needed <= space->room)
        return RITZ_OK;
    space->room = room < space->model->most ? room : space->model->most;
    RITZ_CHECK(ritz_array_lengthen(&space->V.val, n * space->room,
                                   sizeof *space->V.val));
    space->V.ncol = space->room;
    RITZ_CHECK(grow_dense(space->room, space->room, &space->T));
    return grow_dense(space->room, space->loads.ncol, &space->loads);
}

/* X -= V C, V the C->nrow columns of the space from `first` on. */
static void subtract_columns(const ritz_projection_space *space, int64_t first,
                             const ritz_dense *C, ritz_dense *X)
{
    int n = (int)X->nrow;

    if (n > 0 && X->ncol > 0 && C->nrow > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, (int)X->ncol,
                    (int)C->nrow, -1.0, ritz_dense_col(&space->V, first), n,
                    C->val, (int)C->nrow, 1.0, X->val, n);
}

/*
 * before[j] := x'K_s x of column j, then X := X - V (V'K_s X) and
 * G := X'K_s X. Rigid-body motion is removed from X, too: it is the eigenvector
 * of the largest eigenvalue of K_s^-1 M, so that what rounding leaves of it
 * would grow from block to block.
 */
static ritz_status project_out(const ritz_projection_space *space,
                               ritz_dense *X, double *before, ritz_dense *G)
{
    const ritz_low_rank_model *low = &space->model->low;
    const ritz_dense V = ritz_dense_part(&space->V, 0, space->count);
    RITZ_OWN(ritz_dense) KX = {0}, C = {0};

    RITZ_CHECK(ritz_sparse_mul(&space->Ks, X, &KX));
    for (int64_t j = 0; j < X->ncol; j++)
        before[j] = ritz_dense_dot(X, j, &KX, j);
    RITZ_CHECK(ritz_dense_mul_tn(&V, &KX, &C));
    subtract_columns(space, 0, &C, X);
    RITZ_CHECK(ritz_dense_take_out(&low->Phi, &low->MPhi, X));
    ritz_dense_free(&KX);
    RITZ_CHECK(ritz_sparse_mul(&space->Ks, X, &KX));
    RITZ_CHECK(ritz_dense_mul_tn(X, &KX, G));
    ritz_dense_symmetrise(G);
    return RITZ_OK;
}

/*
 * Orthonormalise X: X := X D U e^-1/2, where the diagonal D scales G to unit
 * diagonal and D G D = U e U'. Columns with e near 0, which depend on others,
 * are left out. *weak is the least part of its energy that a column has kept.
 */
static ritz_status normalise_columns(const double *before, ritz_dense *G,
                                     ritz_dense *X, double *weak)
{
    const double least = RITZ_PROJECTION_DEPENDENT * RITZ_PROJECTION_DEPENDENT;
    int p = (int)X->ncol, first = 0;
    RITZ_OWN_ARRAY double *d = NULL, *e = NULL;
    RITZ_OWN(ritz_dense) U = {0};

    RITZ_CHECK_NEW(d, p);
    RITZ_CHECK_NEW(e, p);
    *weak = 1.0;
    for (int j = 0; j < p; j++) {
        double own = ritz_dense_col(G, j)[j];

        if (own > least * before[j] && own > 0.0) {
            d[j] = 1.0 / sqrt(own);
            *weak = fmin(*weak, own / before[j]);
        }
    }
    for (int k = 0; k < p * p; k++)
        G->val[k] *= d[k % p] * d[k / p];
    RITZ_REFUSE_IF(p > 0 && LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', p, G->val,
                                          p, e) != 0,
                   RITZ_ERR_CONVERGENCE, "a block of vectors is not finite");
    while (first < p && !(e[first] > RITZ_PROJECTION_DEPENDENT))
        first++;
    for (int k = first; k < p; k++) {
        *weak = fmin(*weak, e[k]);
        for (int i = 0; i < p; i++)
            ritz_dense_col(G, k)[i] *= d[i] / sqrt(e[k]);
    }
    RITZ_CHECK(ritz_dense_columns(G, first, p - first, &U));
    return ritz_dense_times(&U, X);
}

/*
 * Orthonormalise X and append it to V. Another pass follows if a column has lost
 * nearly all of its energy, as it is then not orthogonal to rounding.
 *
 * @param[in] energy  x'K_s x of each column before any part was subtracted from
 *                    it, by which is judged whether the rest is rounding; NULL:
 *                    of X as it is given
 */
static ritz_status append_columns(const double *energy, ritz_dense *X,
                                  ritz_projection_space *space)
{
    const int64_t room = X->nrow - space->model->low.Phi.ncol - space->count;
    double weak = 0.0;

    for (int pass = 0;
         pass < PASSES && weak < RITZ_PROJECTION_KEPT && X->ncol > 0; pass++) {
        RITZ_OWN(ritz_dense) G = {0};
        RITZ_OWN_ARRAY double *before = NULL;

        RITZ_CHECK_NEW(before, X->ncol);
        RITZ_CHECK(project_out(space, X, before, &G));
        if (pass == 0 && energy)
            memcpy(before, energy, (size_t)X->ncol * sizeof *before);
        RITZ_CHECK(normalise_columns(before, &G, X, &weak));
    }
    X->ncol = X->ncol < room ? X->ncol : room;
    RITZ_CHECK(reserve_columns(X->ncol, space));
    ritz_dense_put(X, 0, space->count, &space->V);
    space->count += X->ncol;
    return RITZ_OK;
}

/* X := K_s^-1 X, and remove rigid-body motion. */
static ritz_status solve_static(const ritz_projection_space *space,
                                ritz_dense *X)
{
    const ritz_low_rank_model *low = &space->model->low;

    RITZ_CHECK(ritz_factor_solve(space->F, X));
    return ritz_dense_take_out(&low->Phi, &low->MPhi, X);
}

ritz_status ritz_projection_space_new(const ritz_projection_model *model,
                                      ritz_projection_space *out)
{
    RITZ_OWN(ritz_projection_space) space = {.model = model};
    RITZ_OWN(ritz_dense) F = {0}, X = {0}, at = {0};
    ritz_dense V = {0};

    RITZ_CHECK(collect_loads(model, &F));
    RITZ_CHECK(ritz_dense_copy(&F, &X));
    RITZ_CHECK(ritz_dense_new(model->low.n, 0, &space.V));
    RITZ_CHECK(ritz_dense_new(0, F.ncol, &space.loads));
    RITZ_CHECK(factor_shifted(&space));
    RITZ_CHECK(solve_static(&space, &X));
    RITZ_CHECK(append_columns(NULL, &X, &space));
    V = ritz_dense_part(&space.V, 0, space.count);
    RITZ_CHECK(ritz_dense_mul_tn(&V, &F, &at));
    ritz_dense_put(&at, 0, 0, &space.loads);
    RITZ_MOVE(*out, space);
    return RITZ_OK;
}

/* Set the blocks of T that belong to the last block Q of V, and subtract from
   X = K_s^-1 M Q its parts along Q and along the block before Q. */
static ritz_status take_out_near(const ritz_dense *Q, const ritz_dense *MQ,
                                 ritz_projection_space *space, ritz_dense *X)
{
    int64_t before = space->last - space->coupling.ncol;
    RITZ_OWN(ritz_dense) own = {0}, turned = {0};

    RITZ_CHECK(ritz_dense_mul_tn(Q, MQ, &own));
    ritz_dense_symmetrise(&own);
    ritz_dense_put(&own, space->last, space->last, &space->T);
    subtract_columns(space, space->last, &own, X);
    if (space->coupling.ncol == 0)
        return RITZ_OK;
    ritz_dense_put(&space->coupling, space->last, before, &space->T);
    RITZ_CHECK(ritz_general_transpose(&space->coupling, &turned));
    ritz_dense_put(&turned, before, space->last, &space->T);
    subtract_columns(space, before, &turned, X);
    return RITZ_OK;
}

ritz_status ritz_projection_space_extend(ritz_projection_space *space)
{
    int64_t first = space->count;
    RITZ_OWN(ritz_dense) MQ = {0}, X = {0}, coupling = {0};
    RITZ_OWN_ARRAY double *energy = NULL;
    ritz_dense Q = ritz_dense_part(&space->V, space->last, first - space->last);

    RITZ_CHECK(ritz_sparse_mul(&space->model->low.M, &Q, &MQ));
    RITZ_CHECK(ritz_dense_copy(&MQ, &X));
    RITZ_CHECK(solve_static(space, &X));
    RITZ_CHECK_NEW(energy, X.ncol);
    for (int64_t j = 0; j < X.ncol; j++) /* x'K_s x, x = K_s^-1 M q */
        energy[j] = ritz_dense_dot(&X, j, &MQ, j);
    RITZ_CHECK(take_out_near(&Q, &MQ, space, &X));
    RITZ_CHECK(append_columns(energy, &X, space));
    Q = ritz_dense_part(&space->V, first, space->count - first);
    RITZ_CHECK(ritz_dense_mul_tn(&Q, &MQ, &coupling));
    ritz_dense_replace(&space->coupling, &coupling);
    space->last = first;
    ritz_monitor_step("vectors", space->count, 0);
    return RITZ_OK;
}

ritz_status ritz_projection_space_shift(double m, ritz_projection_space *space)
{
    const ritz_low_rank_model *low = &space->model->low;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_sparse_add(1.0, &low->K, m, &low->M, &A));
    RITZ_CHECK_IN("stiffness of a shift", ritz_factor_spd(&A, &F));
    RITZ_CHECK(collect_loads(space->model, &X));
    RITZ_CHECK(ritz_factor_solve(F, &X));
    RITZ_CHECK(ritz_dense_take_out(&low->Phi, &low->MPhi, &X));
    RITZ_CHECK(append_columns(NULL, &X, space));
    /* V'M of the block before has zeros in the rows of x */
    return grow_dense(space->count - space->last, space->coupling.ncol,
                      &space->coupling);
}

void ritz_projection_space_free(ritz_projection_space *space)
{
    ritz_sparse_free(&space->Ks);
    ritz_factor_free(&space->F);
    ritz_dense_free(&space->V);
    ritz_dense_free(&space->T);
    ritz_dense_free(&space->coupling);
    ritz_dense_free(&space->loads);
    *space = (ritz_projection_space){0};
}

/*
 * Principal axes of T = U Theta U', theta descending: Phi = V Y,
 * Y = U Theta^-1/2, lambda = 1 / theta - mu, and
 *
 *     L = h U Theta^-3/2   (rows of U of the last block of V)
 */

/* theta and U, U in place of T. No theta is less than eps times the largest. */
static ritz_status find_axes(ritz_dense *T, double *theta)
{
    int m = (int)T->nrow;
    RITZ_OWN(ritz_dense) U = {0};
    RITZ_OWN_ARRAY double *e = NULL;

    RITZ_CHECK_NEW(e, m);
    RITZ_REFUSE_IF(m > 0 && LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', m,
                                           T->val, m, e) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the modes of the projected model do not converge");
    RITZ_CHECK(ritz_dense_new(m, m, &U));
    for (int64_t k = 0; k < m; k++) {
        const ritz_dense u = ritz_dense_part(T, m - 1 - k, 1);

        ritz_dense_put(&u, 0, k, &U);
        theta[k] = fmax(e[m - 1 - k], DBL_EPSILON * e[m - 1]);
    }
    ritz_dense_replace(T, &U);
    return RITZ_OK;
}

static void scale_columns(const double *theta, double power, ritz_dense *A)
{
    for (int64_t k = 0; k < A->ncol; k++)
        if (A->nrow > 0)
            cblas_dscal((int)A->nrow, pow(theta[k], power),
                        ritz_dense_col(A, k), 1);
}

static ritz_status find_residual_rows(const ritz_projection_space *space,
                                      const ritz_dense *U, ritz_projected *out)
{
    int64_t rows = space->coupling.ncol;
    RITZ_OWN(ritz_dense) last = {0};

    RITZ_CHECK(
        ritz_dense_block(U, out->count - rows, rows, 0, out->count, &last));
    RITZ_CHECK(ritz_dense_mul(&space->coupling, &last, &out->L));
    scale_columns(out->theta, -1.5, &out->L);
    return RITZ_OK;
}

/* Phi'F = Y'V'F of `count` loads from `first` on. */
static ritz_status project_loads(const ritz_projection_space *space,
                                 const ritz_dense *Y, int64_t first,
                                 int64_t count, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(
        ritz_dense_block(&space->loads, 0, Y->nrow, first, count, &part));
    return ritz_dense_mul_tn(Y, &part, out);
}

ritz_status ritz_projected_new(const ritz_projection_space *space,
                               ritz_projected *out)
{
    const ritz_projection_model *model = space->model;
    int64_t m = space->last, in = model->inputs, outs = model->outputs;
    RITZ_OWN(ritz_projected)
    p = {.count = m,
         .a = model->a,
         .b = model->b,
         .mu = space->mu,
         .lowest = model->low.lowest,
         .c = model->c};

    RITZ_CHECK_NEW(p.lambda, m);
    RITZ_CHECK_NEW(p.theta, m);
    RITZ_CHECK(ritz_dense_block(&space->T, 0, m, 0, m, &p.Y));
    RITZ_CHECK(find_axes(&p.Y, p.theta));
    RITZ_CHECK(find_residual_rows(space, &p.Y, &p));
    for (int64_t k = 0; k < m; k++)
        p.lambda[k] = 1.0 / p.theta[k] - p.mu;
    scale_columns(p.theta, -0.5, &p.Y);
    RITZ_CHECK(project_loads(space, &p.Y, 0, in, &p.B));
    RITZ_CHECK(project_loads(space, &p.Y, in, outs, &p.C));
    RITZ_CHECK(project_loads(space, &p.Y, in + outs, outs, &p.Cv));
    RITZ_CHECK(project_loads(space, &p.Y, in + 2 * outs, model->P.ncol, &p.P));
    RITZ_MOVE(*out, p);
    return RITZ_OK;
}

/* P diag(c) P' */
static ritz_status find_damping(const ritz_projected *p, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) cP = {0};

    RITZ_CHECK(ritz_dense_copy(&p->P, &cP));
    for (int64_t j = 0; j < cP.ncol; j++)
        for (int64_t i = 0; i < cP.nrow; i++)
            ritz_dense_col(&cP, j)[i] *= p->c[j];
    return ritz_dense_mul_nt(&cP, &p->P, out);
}

/* Modal damping matrix a I + b Lambda + P diag(c) P', stored only if there are
   dampers, and the damping ratios, half its diagonal over omega. */
static ritz_status put_damping(const ritz_projected *p, ritz_modal *modal)
{
    bool coupled = p->P.ncol > 0;

    if (coupled) {
        RITZ_CHECK(find_damping(p, &modal->Delta));
        ritz_dense_symmetrise(&modal->Delta);
    }
    for (int64_t k = 0; k < p->count; k++) {
        double own = p->a + p->b * p->lambda[k];

        modal->omega[k] = sqrt(p->lambda[k]);
        if (coupled)
            own = ritz_dense_col(&modal->Delta, k)[k] += own;
        modal->zeta[k] = own / (2.0 * modal->omega[k]);
    }
    return RITZ_OK;
}

ritz_status ritz_projected_modal(const ritz_projected *projected,
                                 ritz_modal *out)
{
    RITZ_OWN(ritz_modal) modal = {.count = projected->count};

    RITZ_CHECK_NEW(modal.omega, modal.count);
    RITZ_CHECK_NEW(modal.zeta, modal.count);
    RITZ_CHECK(put_damping(projected, &modal));
    RITZ_CHECK(ritz_dense_copy(&projected->B, &modal.B));
    RITZ_CHECK(ritz_general_transpose(&projected->C, &modal.C));
    RITZ_CHECK(ritz_general_transpose(&projected->Cv, &modal.Cv));
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

void ritz_projected_free(ritz_projected *projected)
{
    RITZ_FREE(projected->lambda, projected->theta);
    ritz_dense_free(&projected->Y);
    ritz_dense_free(&projected->L);
    ritz_dense_free(&projected->B);
    ritz_dense_free(&projected->C);
    ritz_dense_free(&projected->Cv);
    ritz_dense_free(&projected->P);
    *projected = (ritz_projected){0};
}
