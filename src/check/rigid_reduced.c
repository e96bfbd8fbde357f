/*
 * Rigid motions R c of a body in its reduced model, by the momentum
 * N = R'M T that the model stores, with c'R'M R c = I. If R c = T q, then
 * M_r q = N'c, and
 *
 *     Q = M_r^-1 N' c
 *
 * has Q'M_r Q = I. If T does not span the motions, Q'M_r Q is less than I. The
 * part of a mode phi, phi'M_r phi = 1, that is rigid motion is |Q'M_r phi|^2.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>

/* c, the motions that have mass, by the eigenvectors of R'M R in coordinates
   without units. */
static ritz_status scale_motions(const double *rigid, ritz_dense *out)
{
    enum { ALL = RITZ_BODY_MOTIONS };
    RITZ_OWN(ritz_dense) A = {0}, c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double unit[ALL];
    int64_t kept = 0;

    RITZ_CHECK(ritz_dense_new(ALL, ALL, &A));
    for (int64_t i = 0; i < ALL; i++)
        unit[i] = rigid[7 * i] > 0.0 ? 1.0 / sqrt(rigid[7 * i]) : 0.0;
    for (int64_t j = 0; j < ALL; j++)
        for (int64_t i = 0; i < ALL; i++)
            ritz_dense_col(&A, j)[i] = unit[i] * unit[j] * rigid[ALL * j + i];
    RITZ_CHECK(ritz_general_symmetric(&A, &pairs));
    RITZ_CHECK(ritz_dense_new(ALL, ALL, &c));
    for (int64_t j = 0; j < ALL; j++) {
        if (!(pairs.lambda[j] > RITZ_MOTION_WITHOUT_MASS))
            continue;
        for (int64_t i = 0; i < ALL; i++)
            ritz_dense_col(&c, kept)[i] = unit[i] *
                                          ritz_dense_col(&pairs.Phi, j)[i] /
                                          sqrt(pairs.lambda[j]);
        kept++;
    }
    c.ncol = kept;
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

/* N'c = M_r Q; *spans: T spans the motions. */
static ritz_status find_motions(const ritz_checker *it, ritz_dense *out,
                                bool *spans)
{
    const ritz_invariants *known = &it->reduced->invariants;
    RITZ_OWN(ritz_dense) c = {0}, F = {0}, Q = {0}, A = {0};
    ritz_status status = RITZ_OK;

    *spans = false;
    RITZ_CHECK(scale_motions(known->rigid, &c));
    RITZ_CHECK(ritz_dense_mul_tn(&known->momentum, &c, &F));
    RITZ_CHECK(ritz_dense_copy(&F, &Q));
    status = ritz_general_solve_scaled(&it->model.M, false, &Q);
    if (status == RITZ_ERR_SINGULAR) /* columns without mass */
        return RITZ_OK;
    RITZ_CHECK(status);
    RITZ_CHECK(ritz_dense_mul_tn(&Q, &F, &A));
    for (int64_t j = 0; j < A.ncol; j++)
        ritz_dense_col(&A, j)[j] -= 1.0;
    *spans = c.ncol > 0 && ritz_dense_max(&A) <= RITZ_MOTIONS_BEARABLE;
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

ritz_status ritz_check_motions(ritz_checker *it)
{
    RITZ_OWN(ritz_dense) F = {0}, part = {0};
    bool spans = false;

    if (!it->reduced->invariants.momentum.val)
        return RITZ_OK;
    RITZ_CHECK(find_motions(it, &F, &spans));
    if (!spans)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&F, &it->modes.Phi, &part));
    RITZ_CHECK_NEW(it->moves, part.ncol);
    for (int64_t k = 0; k < part.ncol; k++)
        it->moves[k] =
            ritz_dense_dot(&part, k, &part, k) >= 1.0 - RITZ_MOTIONS_BEARABLE;
    return RITZ_OK;
}
