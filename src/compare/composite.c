/*
 * The composite set of each body, in three parts: the body's own static
 * solutions, independent directions in its mass, and what configurations give.
 */
#include "base/alloc.h"

#include "base/tolerances.h"
#include "compare/compare.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Static corrections of one body, once for all configurations [LeeTsuha1992,
 * sec. 3.1], [McDaniel2000, eq. 3.2.13]. With its rigid modes R, R'MR = I, and
 * unit forces F, relieved by the inertia of the motion that they cause,
 *
 *     F_e = F - M R R' F,    (K + s M R R' M) A = F_e
 *
 * has R'M A = 0 for any s > 0, as R'K = 0 and R'F_e = 0: the inertia-relief
 * attachment modes P'S P F of [LeeTsuha1992, eq. 14]. Together with R and the
 * projected modes they span what the residual modes of that equation do.
 *
 * In the static response of a system accelerations are rigid and each body
 * obeys K q = F g + B u - M R a with g the forces at its interface; since R'
 * times the right side is 0, q = A [g; u] + R b. So with all of them and R in
 * the subspace the flexible static gain is exact at every angle.
 *
 * Modes have no part in motions without mass: where M is singular its null
 * space is kept, lest a massless motion of the first system have mass in the
 * second.
 */

/*
 * A lambda of the body's own, the geometric mean of K_jj / M_jj: in K + lambda
 * M neither term is rounding relative to the other.
 */
static double typical_lambda(const ritz_reduced *body)
{
    double sum = 0.0;
    int64_t count = 0;

    for (int64_t j = 0; j < body->K.ncol; j++) {
        double k = ritz_dense_col(&body->K, j)[j];
        double m = ritz_dense_col(&body->M, j)[j];

        if (k > 0.0 && m > 0.0) {
            sum += log(k / m);
            count++;
        }
    }
    return count > 0 ? exp(sum / (double)count) : 1.0;
}

/* Factor K + s M R R' M in place, scaled to a unit diagonal by *scale. */
static ritz_status factor_shifted(const ritz_reduced *body,
                                  const ritz_dense *MR, double *scale,
                                  ritz_dense *L)
{
    int r = (int)body->K.ncol;

    RITZ_CHECK(ritz_dense_copy(&body->K, L));
    if (MR->ncol > 0)
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, r, (int)MR->ncol,
                    typical_lambda(body), MR->val, r, 1.0, L->val, r);
    for (int j = 0; j < r; j++) {
        double own = ritz_dense_col(L, j)[j];

        scale[j] = own > 0.0 ? 1.0 / sqrt(own) : 1.0;
    }
    for (int j = 0; j < r; j++)
        for (int i = j; i < r; i++)
            ritz_dense_col(L, j)[i] *= scale[i] * scale[j];
    RITZ_REFUSE_IF(
        r > 0 && LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', r, L->val, r),
        RITZ_ERR_SINGULAR,
        "the stiffness of motions that are not rigid is not definite, "
        "so there is no static solution");
    return RITZ_OK;
}

/*
 * F := S (F - M R R' F) with the row scales S. A column that is rounding
 * becomes zero: its force accelerates the body rigidly and does not deform it.
 */
static ritz_status relieve_inertia(const ritz_dense *R, const ritz_dense *MR,
                                   const double *scale, ritz_dense *F)
{
    RITZ_OWN(ritz_dense) share = {0}, gone = {0};

    RITZ_CHECK(ritz_dense_mul_tn(R, F, &share));
    RITZ_CHECK(ritz_dense_mul(MR, &share, &gone));
    for (int64_t j = 0; j < F->ncol; j++) {
        double before = 0.0, after = 0.0;

        for (int64_t i = 0; i < F->nrow; i++) {
            double f = ritz_dense_col(F, j)[i];
            double e = f - ritz_dense_col(&gone, j)[i];

            before = hypot(before, scale[i] * f);
            after = hypot(after, scale[i] * e);
            ritz_dense_col(F, j)[i] = scale[i] * e;
        }
        for (int64_t i = 0;
             i < F->nrow && !(after > RITZ_FORCE_RELIEVED * before); i++)
            ritz_dense_col(F, j)[i] = 0.0;
    }
    return RITZ_OK;
}

/* Remove zero columns. */
static ritz_status remove_zeros(ritz_dense *F)
{
    RITZ_OWN(ritz_dense) kept = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(at, F->ncol);
    for (int64_t j = 0; j < F->ncol; j++)
        if (F->nrow > 0 && ritz_dense_col_max(F, j) > 0.0)
            at[count++] = j;
    RITZ_CHECK(ritz_dense_pick(F, count, at, &kept));
    ritz_dense_replace(F, &kept);
    return RITZ_OK;
}

/* Rigid modes R of a body, and M R. */
static ritz_status find_rigid(const ritz_reduced *body, ritz_dense *R,
                              ritz_dense *MR)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(&body->K, &body->M, &pairs));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, R));
    return ritz_dense_mul(&body->M, R, MR);
}

ritz_status ritz_body_relieve(const ritz_stage *stage, int64_t k, ritz_dense *F)
{
    RITZ_OWN(ritz_dense) R = {0}, MR = {0};

    RITZ_CHECK(find_rigid(&stage->body[k], &R, &MR));
    return relieve_inertia(&R, &MR, stage->scale + stage->first[k], F);
}

ritz_status ritz_body_statics(const ritz_stage *stage, int64_t k,
                              const ritz_plan *plan, ritz_statics *out)
{
    const ritz_reduced *body = &stage->body[k];
    int r = (int)body->K.ncol;
    RITZ_OWN(ritz_dense) R = {0}, MR = {0}, F = {0}, L = {0};
    RITZ_OWN_ARRAY double *scale = NULL;

    RITZ_CHECK_NEW(scale, r);
    RITZ_CHECK(find_rigid(body, &R, &MR));
    RITZ_CHECK(factor_shifted(body, &MR, scale, &L));
    RITZ_CHECK(ritz_plan_body(stage, k, plan, &F));
    RITZ_CHECK(relieve_inertia(&R, &MR, scale, &F));
    RITZ_CHECK(remove_zeros(&F));
    if (F.ncol > 0 && r > 0)
        (void)LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', r, (int)F.ncol, L.val, r,
                             F.val, r);
    ritz_dense_scale_rows(scale, &F);
    RITZ_MOVE(out->rigid, R);
    RITZ_MOVE(out->answers, F);
    return RITZ_OK;
}

/* Motions without mass: null space of M, r x 0 if it is definite. */
static ritz_status body_massless(const ritz_reduced *body, const double *scale,
                                 ritz_dense *out)
{
    int r = (int)body->M.ncol;
    int null = 0;
    RITZ_OWN(ritz_dense) Q = {0};
    RITZ_OWN_ARRAY double *m = NULL;

    RITZ_CHECK_NEW(m, r);
    RITZ_CHECK(ritz_dense_copy(&body->M, &Q));
    for (int j = 0; j < r; j++)
        for (int i = 0; i < r; i++)
            ritz_dense_col(&Q, j)[i] *= scale[i] * scale[j];
    RITZ_REFUSE_IF(r > 0 && LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', r, Q.val,
                                           r, m) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "eigenvalues of the mass do not converge");
    /* as in linear/eigen_dense.c */
    while (null < r && m[null] <= 4.0 * r * DBL_EPSILON * m[r - 1])
        null++;
    ritz_dense_scale_rows(scale, &Q);
    return ritz_dense_columns(&Q, 0, null, out);
}

void ritz_statics_free(ritz_statics *statics)
{
    ritz_dense_free(&statics->rigid);
    ritz_dense_free(&statics->massless);
    ritz_dense_free(&statics->answers);
}

/* L = lower triangle of S (M + stiffness K) S. */
static void fill_mixed(const ritz_reduced *body, const double *scale,
                       double stiffness, ritz_dense *L)
{
    for (int64_t j = 0; j < L->ncol; j++)
        for (int64_t i = 0; i < L->nrow; i++)
            ritz_dense_col(L, j)[i] =
                i < j ? 0.0
                      : scale[i] * scale[j] *
                            (ritz_dense_col(&body->M, j)[i] +
                             stiffness * ritz_dense_col(&body->K, j)[i]);
}

/*
 * Factor L in place; not good if it is not definite, or its reciprocal
 * condition is below the least.
 */
static ritz_status factor_checked(ritz_dense *L, double least, bool *good)
{
    double rcond = 1.0;

    if (L->ncol > 0)
        RITZ_CHECK(ritz_general_cholesky(L, &rcond));
    *good = rcond > least;
    return RITZ_OK;
}

ritz_status ritz_mixed_factor(const ritz_reduced *body, const double *scale,
                              double lambda, ritz_dense *L)
{
    bool good = false;

    RITZ_CHECK(ritz_dense_new(body->M.ncol, body->M.ncol, L));
    fill_mixed(body, scale, 1.0 / lambda, L);
    RITZ_CHECK(factor_checked(L, DBL_EPSILON, &good));
    RITZ_REFUSE_IF(
        !good, RITZ_ERR_SINGULAR,
        "a motion has neither mass nor stiffness, or the reduced mass "
        "is not positive");
    return RITZ_OK;
}

ritz_status ritz_mass_factor(const ritz_reduced *body, const double *scale,
                             ritz_dense *L, bool *mixed)
{
    int64_t r = body->M.ncol;
    bool good = false;

    *mixed = false;
    RITZ_CHECK(ritz_dense_new(r, r, L));
    fill_mixed(body, scale, 0.0, L);
    RITZ_CHECK(factor_checked(L, RITZ_MASS_CONDITION, &good));
    if (good)
        return RITZ_OK;
    *mixed = true;
    ritz_dense_free(L);
    return ritz_mixed_factor(body, scale, typical_lambda(body), L);
}

/* Scale columns to unit length, or only those that are longer. */
static void scale_to_unit(bool longer, ritz_dense *Y)
{
    for (int64_t j = 0; j < Y->ncol; j++) {
        double norm = cblas_dnrm2((int)Y->nrow, ritz_dense_col(Y, j), 1);

        if (norm > (longer ? 1.0 : 0.0))
            cblas_dscal((int)Y->nrow, 1.0 / norm, ritz_dense_col(Y, j), 1);
    }
}

void ritz_mass_return(const ritz_dense *L, const double *scale, bool limited,
                      ritz_dense *U)
{
    int r = (int)U->nrow;

    if (U->ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, r, (int)U->ncol, 1.0, L->val, r, U->val, r);
    if (limited)
        scale_to_unit(true, U);
    ritz_dense_scale_rows(scale, U);
}

ritz_status ritz_mass_transform(const ritz_dense *L, const double *scale,
                                const ritz_dense *W, ritz_dense *Y)
{
    RITZ_CHECK(ritz_dense_copy(W, Y));
    for (int64_t j = 0; j < Y->ncol; j++)
        for (int64_t i = 0; i < Y->nrow; i++)
            ritz_dense_col(Y, j)[i] /= scale[i];
    if (Y->nrow * Y->ncol > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)Y->nrow, (int)Y->ncol, 1.0, L->val,
                    (int)Y->nrow, Y->val, (int)Y->nrow);
    return RITZ_OK;
}

static ritz_status append_columns(const ritz_dense *more, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) both = {0};

    if (more->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_beside(W, more, &both));
    ritz_dense_replace(W, &both);
    return RITZ_OK;
}

ritz_status ritz_span_append(ritz_dense *Y, double tolerance, double *largest,
                             double *value, ritz_dense *U)
{
    RITZ_OWN(ritz_dense) more = {0};

    RITZ_CHECK(ritz_dense_take_out(U, U, Y));
    RITZ_CHECK(ritz_dense_take_out(U, U, Y)); /* twice is enough */
    RITZ_CHECK(ritz_span_of(Y, tolerance, largest, value, &more));
    if (more.ncol > U->nrow - U->ncol)
        more.ncol = U->nrow - U->ncol;
    return append_columns(&more, U);
}

ritz_status ritz_givens_gather(const ritz_givens *givens,
                               const ritz_stage *stage, int64_t body, int group,
                               ritz_dense *out)
{
    RITZ_OWN(ritz_dense) W = {0};

    RITZ_CHECK(ritz_dense_new(stage->body[body].K.ncol, 0, &W));
    for (int64_t k = 0; k < givens->count; k++) {
        const ritz_given *given = &givens->each[k];
        RITZ_OWN(ritz_dense) part = {0};

        RITZ_CHECK(
            ritz_dense_mul(&given->at->P[body], &given->X[group], &part));
        RITZ_CHECK(append_columns(&part, &W));
    }
    RITZ_MOVE(*out, W);
    return RITZ_OK;
}

void ritz_givens_free(ritz_givens *givens)
{
    for (int64_t k = 0; givens->each && k < givens->count; k++) {
        for (int group = 0; group < RITZ_GROUPS; group++)
            ritz_dense_free(&givens->each[k].X[group]);
        free(givens->each[k].value);
    }
    free(givens->each);
    *givens = (ritz_givens){0};
}

ritz_status ritz_span_of(ritz_dense *Y, double tolerance, double *largest,
                         double *value, ritz_dense *out)
{
    int r = (int)Y->nrow;
    int m = (int)Y->ncol;
    int least = r < m ? r : m;
    int rank = 0;
    RITZ_OWN(ritz_dense) U = {0};
    RITZ_OWN_ARRAY double *sigma = NULL, *work = NULL;

    RITZ_CHECK_NEW(sigma, least);
    RITZ_CHECK_NEW(work, least);
    RITZ_CHECK(ritz_dense_new(r, least, &U));
    if (least > 0) {
        RITZ_REFUSE_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'S', 'N', r, m, Y->val,
                                      r, sigma, U.val, r, NULL, 1, work) != 0,
                       RITZ_ERR_CONVERGENCE,
                       "singular values of the composite set do not converge");
        *largest = fmax(*largest, sigma[0]);
    }
    while (rank < least && sigma[rank] > tolerance * *largest)
        rank++;
    for (int k = 0; value && k < rank; k++)
        value[k] = sigma[k];
    return ritz_dense_columns(&U, 0, rank, out);
}

/*
 * The vectors that one configuration contributes to the composite set, in its
 * modal coordinates: rigid modes, static solutions of the system, kept modes or
 * Krylov vectors. Their projection on the bodies is described below.
 */

/* Scale the flexible part of x to unit norm; false if there is none. */
static bool normalise_flexible(const ritz_configuration *c, double *x)
{
    return ritz_general_unit(c->K.ncol - c->num_rigid, x + c->num_rigid);
}

/* Divide modal forces x by lambda; false if the force only moves the system
   rigidly. */
static bool divide_by_lambda(const ritz_configuration *c, double *x)
{
    double rigid = 0.0, flexible = 0.0;

    for (int64_t k = 0; k < c->num_rigid; k++) {
        rigid = hypot(rigid, x[k]);
        x[k] = 0.0;
    }
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++) {
        flexible = hypot(flexible, x[k]);
        x[k] /= c->lambda[k];
    }
    return flexible > RITZ_FORCE_RELIEVED * rigid;
}

/* Modal coordinates of the system's static solutions. */
static ritz_status choose_statics(const ritz_stage *stage,
                                  const ritz_configuration *c,
                                  const ritz_plan *plan, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) X = {0};
    int64_t m = 0;

    RITZ_CHECK(ritz_plan_system(stage, c, plan, &X));
    for (int64_t j = 0; j < X.ncol; j++)
        if (divide_by_lambda(c, ritz_dense_col(&X, j)) &&
            normalise_flexible(c, ritz_dense_col(&X, j)))
            memmove(ritz_dense_col(&X, m++), ritz_dense_col(&X, j),
                    (size_t)X.nrow * sizeof *X.val);
    return ritz_dense_columns(&X, 0, m, out);
}

/* Unit vectors of `count` modes from `first` on. */
static ritz_status unit_vectors(int64_t e, int64_t count, int64_t first,
                                const int64_t *which, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(e, count, out));
    for (int64_t k = 0; k < count; k++)
        ritz_dense_col(out, k)[first + (which ? which[k] : k)] = 1.0;
    return RITZ_OK;
}

static ritz_status choose_krylov(const ritz_scene *scene,
                                 const ritz_configuration *c, ritz_dense *out)
{
    int64_t moments = 0;

    RITZ_CHECK(ritz_system_krylov(c, scene->select_vectors,
                                  scene->select_outputs, out, &moments));
    for (int64_t j = 0; j < out->ncol; j++)
        (void)normalise_flexible(c, ritz_dense_col(out, j));
    return RITZ_OK;
}

/*
 * The composite set, projected on each body. At a configuration the coordinates
 * of body c are q_c = P_c x with x modal, so that its columns are
 *
 *     P_c Phi_r                        rigid modes
 *     P_c Phi_f Lambda_f^-1 Phi_f' F   static solution in all flexible modes
 *                                      for each force [LeeTsuha1992, eq. 37],
 *                                      along dampers too [ChuMilman1992]
 *     P_c Phi_k                        kept modes, or
 *     P_c Phi_f W                      Krylov vectors [McDaniel2000, 3.2.3]
 *
 * over all configurations. With the kept modes, the static solution in all
 * flexible modes spans the same space as that in the truncated ones. If
 * components are augmented, the second group consists of the body's own static
 * solutions, once for all angles.
 *
 * With M_c = L L' and Y = L' W, columns are made orthogonal in this order:
 * motions without mass, rigid modes and static solutions completely, so that no
 * tolerance impairs rigid motion or static gain; then the rest of the kept
 * modes, of which singular values below the tolerance are dropped. V_c = L'^-1
 * U. Static solutions of the system and Krylov vectors are scaled to unit mass
 * of the system, as modes are; those of a body are scaled to the body's mass.
 *
 * Where M_c is singular, M_c + K_c / lambda takes its place. Motions without
 * mass, M_c N = 0, come first: if they were made orthogonal to a column that
 * stores energy, they would acquire part of that column and of its mass. Rigid
 * modes store energy by rounding, most of all in N, where every motion is
 * stiff; after N is projected out of them, that energy is of the order of eps.
 */

ritz_status ritz_composite_choose(const ritz_stage *stage,
                                  const ritz_configuration *configuration,
                                  const ritz_compare_row *row, int group,
                                  const ritz_plan *plan, ritz_dense *out)
{
    const ritz_scene *scene = stage->scene;
    const ritz_configuration *c = configuration;
    int64_t e = c->K.ncol;

    if (group == RITZ_GIVEN_RIGID)
        return unit_vectors(e, c->num_rigid, 0, NULL, out);
    if (group == RITZ_GIVEN_STATIC && plan->augment == RITZ_AUGMENT_SYSTEM)
        return choose_statics(stage, c, plan, out);
    if (group == RITZ_GIVEN_KEPT && scene->select == RITZ_SELECT_KRYLOV)
        return choose_krylov(scene, c, out);
    if (group == RITZ_GIVEN_KEPT)
        return unit_vectors(e, row->num_kept, c->num_rigid, row->kept, out);
    return ritz_dense_new(e, 0, out);
}

/*
 * A direction whose singular value is below this, relative to the largest, is
 * rounding. Rigid modes hold flexible motion of eps |P|'|K||P| / lambda, 1e-11
 * measured on frames of bars, while the least rigid motion of a body is of the
 * order of its size over its distance from the centre of the system. Static
 * solutions of a body for linearly dependent forces differ by eps cond(K) of
 * the solver.
 */
static const double tightest[RITZ_GROUPS] = {
    RITZ_TIGHTEST_RIGID, RITZ_TIGHTEST_RIGID, RITZ_TIGHTEST_STATIC,
    RITZ_TIGHTEST_STATIC};

/* A body while its composite set is made. */
typedef struct composing {
    const ritz_stage *stage;
    int64_t body;
    const ritz_plan *plan;
    const ritz_givens *givens; /* of the configurations */
    ritz_statics own;          /* of the body itself */
} composing;

/* W: what configurations and the body itself contribute to a group. */
static ritz_status gather_group(const composing *it, int group, ritz_dense *W)
{
    const ritz_dense none = {0};
    const ritz_dense *const own[RITZ_GROUPS] = {
        &it->own.massless, &it->own.rigid, &it->own.answers, &none};

    RITZ_CHECK(ritz_givens_gather(it->givens, it->stage, it->body, group, W));
    return append_columns(own[group], W);
}

/* Orthonormal directions U: the groups in turn, each orthogonal to those before
   it; first[g] is the first column of group g. */
static ritz_status choose_directions(const composing *it, const ritz_dense *L,
                                     const double *scale,
                                     int64_t first[RITZ_GROUPS], ritz_dense *U)
{
    bool own = it->plan->augment == RITZ_AUGMENT_COMPONENT;
    double largest = 0.0;

    RITZ_CHECK(ritz_dense_new(L->nrow, 0, U));
    for (int g = 0; g < RITZ_GROUPS; g++) {
        RITZ_OWN(ritz_dense) W = {0}, Y = {0};
        double least = tightest[g];

        first[g] = U->ncol;
        if (g == RITZ_GIVEN_KEPT)
            least = fmax(it->plan->tolerance, least);
        if (g == RITZ_GIVEN_STATIC && own)
            least = RITZ_TIGHTEST_BODY;
        RITZ_CHECK(gather_group(it, g, &W));
        RITZ_CHECK(ritz_mass_transform(L, scale, &W, &Y));
        if (g == RITZ_GIVEN_MASSLESS || (g == RITZ_GIVEN_STATIC && own))
            scale_to_unit(false, &Y);
        RITZ_CHECK(ritz_span_append(&Y, least, &largest, NULL, U));
    }
    return RITZ_OK;
}

/* V of one body; adds the number of its own vectors to out->vectors. */
static ritz_status compose_body(composing *it, ritz_subspaces *out)
{
    const ritz_reduced *body = &it->stage->body[it->body];
    const double *scale = it->stage->scale + it->stage->first[it->body];
    const bool compact =
        it->stage->scene->extraneous == RITZ_EXTRANEOUS_COMPACT;
    RITZ_OWN(ritz_dense) L = {0}, U = {0};
    int64_t first[RITZ_GROUPS] = {0};
    bool mixed = false;

    if (it->plan->augment != RITZ_AUGMENT_NONE)
        RITZ_CHECK(body_massless(body, scale, &it->own.massless));
    if (it->plan->augment == RITZ_AUGMENT_COMPONENT)
        RITZ_CHECK(ritz_body_statics(it->stage, it->body, it->plan, &it->own));
    out->vectors += it->own.answers.ncol;
    RITZ_CHECK(ritz_mass_factor(body, scale, &L, &mixed));
    RITZ_CHECK(choose_directions(it, &L, scale, first, &U));
    out->massless[it->body] = first[RITZ_GIVEN_RIGID];
    out->firm[it->body] = first[RITZ_GIVEN_KEPT];
    if (U.ncol == U.nrow && !compact) { /* nothing is removed: keep the
                                           coordinates of the body */
        out->massless[it->body] = 0;
        return ritz_dense_identity(U.nrow, &out->V[it->body]);
    }
    ritz_mass_return(&L, scale, mixed, &U);
    RITZ_MOVE(out->V[it->body], U);
    return RITZ_OK;
}

/* Whether configuration k of the scene contributes to the composite set. */
static bool is_reference(const ritz_scene *scene, int64_t k)
{
    for (int64_t j = 0; j < scene->num_reference; j++)
        if (scene->reference[j] == k)
            return true;
    return scene->num_reference == 0;
}

/* The contributions of all configurations; count their vectors. */
static ritz_status list_contributions(const ritz_rows *rows,
                                      const ritz_plan *plan, ritz_givens *out,
                                      int64_t *count)
{
    const ritz_scene *scene = rows->stage->scene;

    RITZ_CHECK_NEW(out->each, rows->listed->num_configurations);
    for (int64_t k = 0; k < rows->listed->num_configurations; k++) {
        ritz_given *given = &out->each[out->count];

        if (!is_reference(scene, k))
            continue;
        out->count++;
        given->at = ritz_rows_first(rows, k);
        for (int g = 0; g < RITZ_GROUPS; g++) {
            RITZ_CHECK(ritz_composite_choose(
                rows->stage, given->at, &rows->row[k], g, plan, &given->X[g]));
            *count += given->X[g].ncol;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_compare_composite(const ritz_rows *rows, const ritz_plan *plan,
                                   ritz_subspaces *out)
{
    const ritz_stage *stage = rows->stage;
    RITZ_OWN(ritz_givens) givens = {0};
    RITZ_OWN(ritz_subspaces) made = {.count = stage->count};

    RITZ_CHECK_NEW(made.V, stage->count);
    RITZ_CHECK_NEW(made.massless, stage->count);
    RITZ_CHECK_NEW(made.firm, stage->count);
    RITZ_CHECK(list_contributions(rows, plan, &givens, &made.vectors));
    for (int64_t c = 0; c < stage->count; c++) {
        composing it = {
            .stage = stage, .body = c, .plan = plan, .givens = &givens};
        ritz_status status = compose_body(&it, &made);

        ritz_statics_free(&it.own);
        RITZ_CHECK_IN(stage->scene->component[c].name, status);
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

void ritz_subspaces_free(ritz_subspaces *subspaces)
{
    RITZ_FREE_EACH(ritz_dense, subspaces->count, subspaces->V);
    RITZ_FREE(subspaces->massless, subspaces->firm);
    *subspaces = (ritz_subspaces){0};
}
