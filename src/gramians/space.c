/*
 * Gramians of a state space. What belongs to stable poles,
 *
 *     Y'E X z' = Y'A X z + Y'B u,   y = C X z,   Y'A X quasi-triangular,
 *
 * has Hammarling's factors: Z_c = X F_c, Z_o = Y F_o. The rest is split off, as
 * T and W. [Hammarling1982], [Penzl1998]
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "linear/split.h"

#include <ritz/basis.h>

#include <math.h>
#include <stdio.h>

static ritz_status check_space(const ritz_state_space *model)
{
    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_REFUSE_IF(model->A.nrow == 0, RITZ_ERR_ARGUMENT,
                   "the model has no states, and no Gramians");
    RITZ_REFUSE_IF(model->num_inputs == 0, RITZ_ERR_ARGUMENT,
                   "the model has no inputs: nothing of it can be reached");
    RITZ_REFUSE_IF(model->num_outputs == 0, RITZ_ERR_ARGUMENT,
                   "the model has no outputs: nothing of it can be seen");
    for (int64_t i = 0; i < model->num_outputs; i++)
        RITZ_REFUSE_IF(model->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       model->output[i], model->limit[i]);
    return RITZ_OK;
}

/* X'C', its columns over the limits. */
static ritz_status observed_by(const ritz_state_space *model,
                               const ritz_dense *X, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) Ct = {0};

    RITZ_CHECK(ritz_general_transpose(&model->C, &Ct));
    for (int64_t i = 0; i < model->num_outputs; i++)
        if (!isnan(model->limit[i]))
            for (int64_t k = 0; k < Ct.nrow; k++)
                ritz_dense_col(&Ct, i)[k] /= model->limit[i];
    return ritz_dense_mul_tn(X, &Ct, out);
}

/* Z_c and Z_o of the stable part. */
static ritz_status factor_stable(const ritz_state_space *model,
                                 const ritz_split *split, ritz_gramians *out)
{
    RITZ_OWN(ritz_dense) B = {0}, C = {0}, F = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&split->Y, &model->B, &B));
    RITZ_CHECK(observed_by(model, &split->X, &C));
    RITZ_CHECK(ritz_general_hammarling(&split->S, &split->P, false, &B, &F));
    RITZ_CHECK(ritz_dense_mul(&split->X, &F, &out->Zc));
    ritz_dense_free(&F);
    RITZ_CHECK(ritz_general_hammarling(&split->S, &split->P, true, &C, &F));
    RITZ_CHECK(ritz_dense_mul(&split->Y, &F, &out->Zo));
    if (model->E.val)
        RITZ_CHECK(ritz_dense_mul(&model->E, &out->Zc, &out->EZc));
    return RITZ_OK;
}

ritz_status ritz_gramians_of_space(const ritz_state_space *model,
                                   ritz_gramians *out)
{
    RITZ_OWN(ritz_split) split = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(check_space(model));
    RITZ_CHECK(ritz_split_new(&model->A, &model->E, &split));
    RITZ_CHECK(factor_stable(model, &split, &gramians));
    gramians.T = split.T;
    gramians.W = split.W;
    split.T = (ritz_dense){0};
    split.W = (ritz_dense){0};
    snprintf(gramians.engine, sizeof gramians.engine, "SLICOT %s",
             split.P.val ? "SG03BD" : "SB03OD");
    snprintf(gramians.damping, sizeof gramians.damping, "%s", model->damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}
