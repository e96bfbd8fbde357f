/*
 * The closed loop in states. With S_y the measured outputs, S_u the driven
 * inputs, the sign s = -1 of negative feedback, and u = r + s S_u v,
 *
 *     e = S_y y = Q (C_y x + s D_yu C_c w + D_y r),   Q = (I - s D_yu D_c)^-1,
 *     v = C_c w + D_c e,
 *     E x' = A x + B r + s B_u v,    E_c w' = A_c w + B_c e,
 *     y = C x + D r + s D_u v
 *
 * [Sirlin1992] (4), (5), with what feeds through the plant.
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "response/loop.h"

#include <ritz/response.h>

#include <string.h>

/* to(row.., col..) += factor A */
static void add_block(double factor, const ritz_dense *A, int64_t row,
                      int64_t col, ritz_dense *to)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(to, col + j)[row + i] +=
                factor * ritz_dense_col(A, j)[i];
}

/* to(row.., :) += factor A X */
static ritz_status add_product(double factor, const ritz_dense *A,
                               const ritz_dense *X, int64_t row, ritz_dense *to)
{
    RITZ_OWN(ritz_dense) AX = {0};

    RITZ_CHECK(ritz_dense_mul(A, X, &AX));
    add_block(factor, &AX, row, 0, to);
    return RITZ_OK;
}

/* e := Q e; the status says whether Q exists. */
static ritz_status multiply_q(double sign, const ritz_dense *D_yu,
                              const ritz_dense *D_c, ritz_dense *e)
{
    RITZ_OWN(ritz_dense) inverse = {0};
    ritz_status status = RITZ_OK;

    if (ritz_dense_max(D_yu) == 0.0 || ritz_dense_max(D_c) == 0.0)
        return RITZ_OK; /* Q = I */
    RITZ_CHECK(ritz_dense_mul(D_yu, D_c, &inverse));
    for (int64_t j = 0; j < inverse.ncol; j++)
        for (int64_t i = 0; i < inverse.nrow; i++)
            ritz_dense_col(&inverse, j)[i] =
                (i == j ? 1.0 : 0.0) - sign * ritz_dense_col(&inverse, j)[i];
    status = ritz_general_solve(&inverse, false, e);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "the feedthroughs of plant and controller form a loop that "
                   "has no solution: I + D_c D is singular");
    return status;
}

ritz_status ritz_loop_measured(const ritz_dense *C, const ritz_dense *D,
                               const ritz_state_space *controller,
                               const ritz_loop *loop, ritz_dense *e)
{
    const ritz_state_space *c = controller;
    double sign = loop->positive ? 1.0 : -1.0;
    int64_t n = C->ncol, m = c->A.nrow;
    RITZ_OWN(ritz_dense) C_y = {0}, D_y = {0}, D_yu = {0}, DC = {0};

    RITZ_CHECK(ritz_dense_rows(C, loop->num_measured, loop->measured, &C_y));
    RITZ_CHECK(ritz_dense_rows(D, loop->num_measured, loop->measured, &D_y));
    RITZ_CHECK(ritz_dense_pick(&D_y, loop->num_driven, loop->driven, &D_yu));
    RITZ_CHECK(ritz_dense_mul(&D_yu, &c->C, &DC));
    RITZ_CHECK(ritz_dense_new(loop->num_measured, n + m + D->ncol, e));
    add_block(1.0, &C_y, 0, 0, e);
    add_block(sign, &DC, 0, n, e);
    add_block(1.0, &D_y, 0, n + m, e);
    return multiply_q(sign, &D_yu, &c->D, e);
}

/* v = C_c w + D_c e, where w and r follow the n states of the plant. */
static ritz_status find_output(int64_t n, const ritz_state_space *controller,
                               const ritz_dense *e, ritz_dense *v)
{
    RITZ_CHECK(ritz_dense_mul(&controller->D, e, v));
    add_block(1.0, &controller->C, 0, n, v);
    return RITZ_OK;
}

ritz_status ritz_loop_output(const ritz_dense *C, const ritz_dense *D,
                             const ritz_state_space *controller,
                             const ritz_loop *loop, ritz_dense *v)
{
    RITZ_OWN(ritz_dense) e = {0};

    RITZ_CHECK(ritz_loop_measured(C, D, controller, loop, &e));
    return find_output(C->ncol, controller, &e, v);
}

/* [A B] of plant and controller, their own terms and those that couple them. */
static ritz_status fill_first_order(const ritz_state_space *p,
                                    const ritz_state_space *c,
                                    const ritz_loop *loop, const ritz_dense *e,
                                    const ritz_dense *v, ritz_dense *rates,
                                    ritz_dense *seen)
{
    double sign = loop->positive ? 1.0 : -1.0;
    int64_t n = p->A.nrow, m = c->A.nrow;
    RITZ_OWN(ritz_dense) B_u = {0}, D_u = {0};

    RITZ_CHECK(ritz_dense_pick(&p->B, loop->num_driven, loop->driven, &B_u));
    RITZ_CHECK(ritz_dense_pick(&p->D, loop->num_driven, loop->driven, &D_u));
    RITZ_CHECK(ritz_dense_new(n + m, n + m + p->num_inputs, rates));
    RITZ_CHECK(ritz_dense_new(p->num_outputs, n + m + p->num_inputs, seen));
    add_block(1.0, &p->A, 0, 0, rates);
    add_block(1.0, &c->A, n, n, rates);
    add_block(1.0, &p->B, 0, n + m, rates);
    RITZ_CHECK(add_product(sign, &B_u, v, 0, rates));
    RITZ_CHECK(add_product(1.0, &c->B, e, n, rates));
    add_block(1.0, &p->C, 0, 0, seen);
    add_block(1.0, &p->D, 0, n + m, seen);
    return add_product(sign, &D_u, v, 0, seen);
}

/* [E 0; 0 E_c]; {0} if both are the identity. */
static ritz_status join_masses(const ritz_state_space *p,
                               const ritz_state_space *c, ritz_dense *out)
{
    int64_t n = p->A.nrow, m = c->A.nrow;

    if (!p->E.val && !c->E.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(n + m, n + m, out));
    for (int64_t k = 0; k < n + m; k++)
        if (!(k < n ? &p->E : &c->E)->val)
            ritz_dense_col(out, k)[k] = 1.0;
    if (p->E.val)
        add_block(1.0, &p->E, 0, 0, out);
    if (c->E.val)
        add_block(1.0, &c->E, n, n, out);
    return RITZ_OK;
}

static ritz_status name_signals(const ritz_state_space *p,
                                const ritz_state_space *c,
                                ritz_state_space *out)
{
    int64_t n = p->A.nrow, m = c->A.nrow;

    out->num_inputs = p->num_inputs;
    out->num_outputs = p->num_outputs;
    RITZ_CHECK_COPY(out->input, p->input, p->num_inputs);
    RITZ_CHECK_COPY(out->output, p->output, p->num_outputs);
    RITZ_CHECK_COPY(out->limit, p->limit, p->num_outputs);
    RITZ_CHECK(ritz_columns_new(n + m, &out->columns));
    for (int64_t k = 0; k < n + m; k++)
        out->columns.kind[k] =
            k < n ? p->columns.kind[k] : c->columns.kind[k - n];
    memcpy(out->damping, p->damping, sizeof out->damping);
    memcpy(out->units, p->units, sizeof out->units);
    return RITZ_OK;
}

ritz_status ritz_closed_loop(const ritz_state_space *plant,
                             const ritz_state_space *controller,
                             const ritz_loop *loop, ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_dense) rates = {0}, seen = {0}, e = {0}, v = {0};
    const ritz_io plant_io = ritz_model_io(ritz_model_of_states(plant));
    const ritz_io controller_io =
        ritz_model_io(ritz_model_of_states(controller));
    int64_t states = plant->A.nrow + controller->A.nrow;

    RITZ_CHECK(ritz_loop_check(loop, &plant_io, &controller_io));
    RITZ_CHECK(ritz_loop_measured(&plant->C, &plant->D, controller, loop, &e));
    RITZ_CHECK(find_output(plant->A.nrow, controller, &e, &v));
    RITZ_CHECK(
        fill_first_order(plant, controller, loop, &e, &v, &rates, &seen));
    RITZ_CHECK(name_signals(plant, controller, &made));
    RITZ_CHECK(ritz_dense_columns(&rates, 0, states, &made.A));
    RITZ_CHECK(ritz_dense_columns(&rates, states, plant->num_inputs, &made.B));
    RITZ_CHECK(ritz_dense_columns(&seen, 0, states, &made.C));
    RITZ_CHECK(ritz_dense_columns(&seen, states, plant->num_inputs, &made.D));
    RITZ_CHECK(join_masses(plant, controller, &made.E));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}
