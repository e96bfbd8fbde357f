/* A state space in a basis of its states: see ritz_reduce_states. */
#include "base/alloc.h"
#include "model/state_reduce.h"

#include <inttypes.h>
#include <string.h>

static ritz_status check(const ritz_state_space *full, const ritz_basis *basis)
{
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = &basis->W;

    RITZ_REFUSE_IF(!basis->states, RITZ_ERR_ARGUMENT,
                   "the basis is of displacements, and a state space has none");
    RITZ_REFUSE_IF(T->nrow != full->A.nrow, RITZ_ERR_ARGUMENT,
                   "the basis is for %" PRId64
                   " states, the state space has %" PRId64,
                   T->nrow, full->A.nrow);
    RITZ_REFUSE_IF(W->val && (W->nrow != T->nrow || W->ncol != T->ncol),
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " left vectors do not fit %" PRId64
                   " x %" PRId64 " right ones",
                   W->nrow, W->ncol, T->nrow, T->ncol);
    return RITZ_OK;
}

/* W'A T */
static ritz_status between(const ritz_dense *W, const ritz_dense *A,
                           const ritz_dense *T, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense AT = {0};

    ritz_dense_free(out);
    if (A->val == NULL)
        return ritz_dense_mul_tn(W, T, out);
    RITZ_TRY(ritz_dense_mul(A, T, &AT));
    RITZ_TRY(ritz_dense_mul_tn(W, &AT, out));
done:
    ritz_dense_free(&AT);
    return status;
}

ritz_status ritz_reduce_space(const ritz_state_space *full,
                              const ritz_basis *basis, ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = basis->W.val ? &basis->W : T;
    const ritz_io io = {.num_inputs = full->num_inputs,
                        .num_outputs = full->num_outputs,
                        .input = full->input,
                        .output = full->output,
                        .limit = full->limit};
    ritz_state_space reduced = {0};
    ritz_dense E = {0};

    RITZ_TRY(check(full, basis));
    RITZ_TRY(ritz_state_space_new(T->ncol, &io, &reduced));
    RITZ_TRY(between(W, &full->A, T, &reduced.A));
    RITZ_TRY(between(W, &full->E, T, &E));
    ritz_dense_free(&reduced.B);
    RITZ_TRY(ritz_dense_mul_tn(W, &full->B, &reduced.B));
    ritz_dense_free(&reduced.C);
    RITZ_TRY(ritz_dense_mul(&full->C, T, &reduced.C));
    ritz_dense_free(&reduced.D);
    RITZ_TRY(ritz_dense_copy(&full->D, &reduced.D));
    RITZ_TRY(ritz_states_settle(basis, &E, &reduced));
    memcpy(reduced.units, full->units, sizeof reduced.units);
    memcpy(reduced.damping, full->damping, sizeof reduced.damping);
    *out = reduced;
    reduced = (ritz_state_space){0};
done:
    ritz_dense_free(&E);
    ritz_state_space_free(&reduced);
    return status;
}
