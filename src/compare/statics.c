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
#include "base/alloc.h"
#include "base/tolerances.h"
#include "compare/compare.h"
#include "compare/directions.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool ritz_plan_attaches(const ritz_scene *scene, const ritz_plan *plan,
                        int64_t j)
{
    for (int64_t k = 0; plan->inputs_too && k < scene->num_attached_inputs; k++)
        if (scene->attached_input[k] == j)
            return true;
    return plan->attached & RITZ_ATTACHED_INPUTS;
}

/* Whether a joint holds a port of body k. */
static bool is_held(const ritz_scene *scene, int64_t k, const char *port)
{
    for (int64_t j = 0; j < scene->num_joints; j++)
        for (int end = 0; end < 2; end++) {
            const ritz_scene_place *at = &scene->joint[j].between[end];

            if (at->component == k && strcmp(at->port, port) == 0)
                return true;
        }
    return false;
}

/* Append rows of A, for the coordinates of one body, as columns m.. of F. */
static int64_t append_rows(const ritz_dense *A, int64_t first, ritz_dense *F,
                           int64_t m)
{
    for (int64_t i = 0; i < A->nrow; i++)
        for (int64_t q = 0; q < F->nrow; q++)
            ritz_dense_col(F, m + i)[q] = ritz_dense_col(A, first + q)[i];
    return m + A->nrow;
}

/* Forces of the planned sets, in the coordinates of body k. */
static ritz_status list_forces(const ritz_stage *stage, int64_t k,
                               const ritz_plan *plan, ritz_dense *out)
{
    const ritz_reduced *body = &stage->body[k];
    const ritz_io *io = &stage->io;
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t most = io->num_inputs + 3 * io->num_outputs;
    int64_t first = stage->first[k];
    int64_t m = 0;
    RITZ_OWN(ritz_dense) F = {0};

    for (int64_t p = 0; p < body->num_ports; p++)
        most += body->port[p].count;
    RITZ_CHECK(ritz_dense_new(body->K.ncol, most, &F));
    for (int64_t j = 0; j < io->num_inputs && F.nrow > 0; j++)
        if (ritz_plan_attaches(stage->scene, plan, j))
            memcpy(ritz_dense_col(&F, m++), ritz_dense_col(&io->B, j) + first,
                   (size_t)F.nrow * sizeof *F.val);
    for (int64_t p = 0; p < body->num_ports; p++)
        if ((plan->attached & RITZ_ATTACHED_INTERFACE) &&
            is_held(stage->scene, k, body->port[p].name))
            m = append_rows(&body->port[p].map, 0, &F, m);
    for (int c = 0; c < 3 && (plan->attached & RITZ_ATTACHED_OUTPUTS); c++)
        m = append_rows(C[c], first, &F, m);
    return ritz_dense_columns(&F, 0, m, out);
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
                    ritz_typical_lambda(body), MR->val, r, 1.0, L->val, r);
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
        "so it answers no static force");
    return RITZ_OK;
}

/*
 * F := F - M R R' F. Columns that become rounding are left out: those of a
 * force that accelerates the body as a rigid one and does not deform it.
 */
static ritz_status relieve_inertia(const ritz_dense *R, const ritz_dense *MR,
                                   const double *scale, ritz_dense *F)
{
    RITZ_OWN(ritz_dense) share = {0}, gone = {0}, kept = {0};
    int64_t m = 0;

    RITZ_CHECK(ritz_dense_mul_tn(R, F, &share));
    RITZ_CHECK(ritz_dense_mul(MR, &share, &gone));
    for (int64_t j = 0; j < F->ncol; j++) {
        double before = 0.0, after = 0.0;

        for (int64_t i = 0; i < F->nrow; i++) {
            double f = ritz_dense_col(F, j)[i];
            double e = f - ritz_dense_col(&gone, j)[i];

            before = hypot(before, scale[i] * f);
            after = hypot(after, scale[i] * e);
            ritz_dense_col(F, m)[i] = scale[i] * e;
        }
        m += after > RITZ_FORCE_RELIEVED * before;
    }
    RITZ_CHECK(ritz_dense_columns(F, 0, m, &kept));
    ritz_dense_free(F);
    RITZ_MOVE(*F, kept);
    return RITZ_OK;
}

ritz_status ritz_body_statics(const ritz_stage *stage, int64_t k,
                              const ritz_plan *plan, ritz_statics *out)
{
    const ritz_reduced *body = &stage->body[k];
    int r = (int)body->K.ncol;
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) R = {0}, MR = {0}, F = {0}, L = {0};
    RITZ_OWN_ARRAY double *scale = NULL;

    RITZ_CHECK_NEW(scale, r);
    RITZ_CHECK(ritz_eigen_dense(&body->K, &body->M, &pairs));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &R));
    RITZ_CHECK(ritz_dense_mul(&body->M, &R, &MR));
    RITZ_CHECK(factor_shifted(body, &MR, scale, &L));
    RITZ_CHECK(list_forces(stage, k, plan, &F));
    RITZ_CHECK(relieve_inertia(&R, &MR, scale, &F));
    if (F.ncol > 0 && r > 0)
        (void)LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', r, (int)F.ncol, L.val, r,
                             F.val, r);
    for (int64_t j = 0; j < F.ncol; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&F, j)[i] *= scale[i];
    out->rigid = R;
    out->answers = F;
    R = F = (ritz_dense){0};
    return RITZ_OK;
}

ritz_status ritz_body_massless(const ritz_reduced *body, const double *scale,
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
    for (int j = 0; j < null; j++)
        for (int i = 0; i < r; i++)
            ritz_dense_col(&Q, j)[i] *= scale[i];
    return ritz_dense_columns(&Q, 0, null, out);
}

void ritz_statics_free(ritz_statics *statics)
{
    ritz_dense_free(&statics->rigid);
    ritz_dense_free(&statics->massless);
    ritz_dense_free(&statics->answers);
}

double ritz_typical_lambda(const ritz_reduced *body)
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
