/*
 * Gramians of a state space. What belongs to stable poles,
 *
 *     Y'E X z' = Y'A X z + Y'B u,   y = C X z,   Y'A X quasi-triangular,
 *
 * has Hammarling's factors: Z_c = X F_c, Z_o = Y F_o. The rest is split off, as
 * T and W. [Hammarling1982], [Penzl1998]
 */
#include "base/alloc.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/split.h"

#include <stdio.h>

static ritz_status check_space(const ritz_state_space *model)
{
    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_REFUSE_IF(model->A.nrow == 0, RITZ_ERR_ARGUMENT,
                   "the model has no states, and no Gramians");
    return ritz_ends_check("model", model->num_inputs, model->num_outputs,
                           model->limit, model->output);
}

/* Z_c and Z_o of the stable part. */
static ritz_status factor_stable(const ritz_state_space *model,
                                 const ritz_split *split, ritz_gramians *out)
{
    RITZ_OWN(ritz_dense) B = {0}, Ct = {0}, C = {0}, F = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&split->Y, &model->B, &B));
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &Ct));
    RITZ_CHECK(ritz_dense_mul_tn(&split->X, &Ct, &C));
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
    RITZ_MOVE(gramians.T, split.T);
    RITZ_MOVE(gramians.W, split.W);
    snprintf(gramians.engine, sizeof gramians.engine, "SLICOT %s",
             split.P.val ? "SG03BD" : "SB03OD");
    snprintf(gramians.damping, sizeof gramians.damping, "%s", model->damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}
