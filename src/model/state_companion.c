/*
 * Left vectors of second order as a basis of states: with
 *
 *     T_2 = [T 0; 0 T],   W_2 = [M'W 0; 0 W],
 *
 * W_2'E T_2 = [W'M T 0; 0 W'M T] and W_2'A T_2 = [0 W'M T; -W'K T -W'D T], from
 * which the companion form comes by division, its upper half being [0 I].
 */
#include "base/alloc.h"

#include <ritz/state_space.h>

#include <inttypes.h>
#include <string.h>

static ritz_status check(const ritz_component *component,
                         const ritz_basis *basis)
{
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = &basis->W;

    RITZ_REFUSE_IF(
        basis->states || !W->val, RITZ_ERR_ARGUMENT,
        "the basis of '%s' is not of displacements with left vectors",
        basis->origin.method);
    RITZ_REFUSE_IF(T->nrow != component->num_dofs || W->nrow != T->nrow ||
                       W->ncol != T->ncol,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " left and %" PRId64 " x %" PRId64
                   " right vectors do not fit %" PRId64 " dofs",
                   W->nrow, W->ncol, T->nrow, T->ncol, component->num_dofs);
    return RITZ_OK;
}

/* out = [upper 0; 0 lower] */
static ritz_status stack(const ritz_dense *upper, const ritz_dense *lower,
                         ritz_dense *out)
{
    int64_t n = upper->nrow;
    size_t size = (size_t)n * sizeof *out->val;

    RITZ_CHECK(ritz_dense_new(2 * n, 2 * upper->ncol, out));
    for (int64_t j = 0; j < upper->ncol && n > 0; j++) {
        memcpy(ritz_dense_col(out, j), ritz_dense_col(upper, j), size);
        memcpy(ritz_dense_col(out, upper->ncol + j) + n,
               ritz_dense_col(lower, j), size);
    }
    return RITZ_OK;
}

static ritz_status to_states(const ritz_component *component,
                             const ritz_basis *basis, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    const ritz_columns *columns = &basis->columns;
    int64_t r = basis->T.ncol;
    ritz_basis states = {.states = true, .among_hz = basis->among_hz};
    ritz_dense MW = {0};

    states.origin = basis->origin;
    RITZ_TRY(ritz_sparse_mul(&component->M, &basis->W, &MW));
    RITZ_TRY(stack(&basis->T, &basis->T, &states.T));
    RITZ_TRY(stack(&MW, &basis->W, &states.W));
    RITZ_TRY(ritz_columns_new(2 * r, &states.columns));
    for (int64_t j = 0; j < 2 * r; j++) {
        states.columns.kind[j] = columns->kind[j % r];
        states.columns.dof[j] = columns->dof[j % r];
        states.columns.hertz[j] = columns->hertz[j % r];
    }
    *out = states;
    states = (ritz_basis){0};
done:
    ritz_dense_free(&MW);
    ritz_basis_free(&states);
    return status;
}

/* q' is q', without the rounding of a division. */
static void settle(ritz_state_space *model)
{
    int64_t r = model->A.nrow / 2;

    for (int64_t j = 0; j < 2 * r; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&model->A, j)[i] = j == r + i ? 1.0 : 0.0;
    for (int64_t j = 0; j < model->num_inputs; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&model->B, j)[i] = 0.0;
}

ritz_status ritz_reduce_companion(const ritz_component *component,
                                  const ritz_damping *damping,
                                  const ritz_basis *basis,
                                  ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis states = {0};

    RITZ_TRY(check(component, basis));
    RITZ_TRY(to_states(component, basis, &states));
    RITZ_TRY(ritz_reduce_states(component, damping, &states, out));
    settle(out);
done:
    ritz_basis_free(&states);
    return status;
}
