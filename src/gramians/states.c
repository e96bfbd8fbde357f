#include "gramians/modes.h"

#include "base/alloc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rigid modes are decoupled if Delta does not couple them with flexible
   ones. */
static int64_t count_decoupled(const ritz_modal_model *modes)
{
    int64_t r = modes->num_rigid;

    for (int64_t j = r; j < modes->count; j++)
        for (int64_t i = 0; i < r; i++)
            if (ritz_dense_col(&modes->Delta, j)[i] != 0.0 ||
                ritz_dense_col(&modes->Delta, i)[j] != 0.0)
                return 0;
    return r;
}

static ritz_status choose_scale(ritz_states *states)
{
    const ritz_modal_model *modes = &states->modes;
    int64_t half = modes->count - states->num_decoupled;
    double least = 0.0;

    RITZ_CHECK_NEW(states->scale, half);
    for (int64_t k = 0; k < half; k++) {
        double w = sqrt(fabs(modes->lambda[states->num_decoupled + k]));

        states->scale[k] = w;
        if (w > 0.0 && (least == 0.0 || w < least))
            least = w;
    }
    for (int64_t k = 0; k < half; k++)
        if (states->scale[k] == 0.0)
            states->scale[k] = least > 0.0 ? least : 1.0;
    return RITZ_OK;
}

/* A - alpha I, B and C. */
static ritz_status fill_states(ritz_states *states)
{
    int64_t r = states->num_decoupled;
    const ritz_modal_layout layout = {r, r, states->scale};

    RITZ_CHECK(ritz_modal_states(&states->modes, &layout, &states->A,
                                 &states->B, &states->C));
    states->count = states->A.nrow;
    for (int64_t k = 0; k < states->count; k++)
        ritz_dense_col(&states->A, k)[k] -= states->alpha;
    return RITZ_OK;
}

ritz_status ritz_states_new(const ritz_component *component,
                            const ritz_damping *damping, double alpha,
                            ritz_states *out)
{
    RITZ_OWN(ritz_states) states = {.alpha = alpha};
    RITZ_OWN(ritz_structure) structure = {0};

    RITZ_CHECK(ritz_structure_of_component(component, &structure));
    RITZ_CHECK(ritz_modal_model_new(&structure, &component->io, damping,
                                    &states.modes));
    ritz_damping_print(damping, states.damping);
    states.num_decoupled = count_decoupled(&states.modes);
    RITZ_CHECK(choose_scale(&states));
    RITZ_CHECK(fill_states(&states));
    RITZ_REFUSE_IF(states.count == 0, RITZ_ERR_ARGUMENT,
                   "the component has no flexible states: its rigid modes are "
                   "all there is");
    RITZ_MOVE(*out, states);
    return RITZ_OK;
}

/* Rows first, first + step, ... of Z, times the scale or over it; NULL: 1. */
static ritz_status pick_rows(const ritz_dense *Z, int64_t first, int64_t step,
                             const double *scale, bool over, ritz_dense *out)
{
    int64_t m = Z->nrow / 2;

    RITZ_CHECK(ritz_dense_new(m, Z->ncol, out));
    for (int64_t j = 0; j < Z->ncol; j++) {
        const double *from = ritz_dense_col(Z, j) + first;
        double *to = ritz_dense_col(out, j);

        for (int64_t k = 0; k < m; k++) {
            double s = scale ? scale[k] : 1.0;

            to[k] = over ? from[k * step] / s : from[k * step] * s;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_states_lift(const ritz_mode_states *states, ritz_lift kind,
                             bool rigid, const ritz_dense *Z, ritz_dense *out)
{
    const ritz_modal_model *modes = states->modes;
    const ritz_dense *const halves[] = {
        kind == RITZ_LIFT_LEFT ? &modes->MPhi : &modes->Phi,
        kind == RITZ_LIFT_MOMENTA ? &modes->MPhi : &modes->Phi};
    int64_t n = modes->num_dofs, a = states->num_decoupled;
    int64_t r = rigid ? a : 0;
    RITZ_OWN(ritz_dense) x = {0};

    RITZ_CHECK(ritz_dense_new(2 * n, 2 * r + Z->ncol, &x));
    for (int half = 0; half < 2; half++) {
        const ritz_dense first = ritz_dense_part(halves[half], 0, r);
        const ritz_dense Phi =
            ritz_dense_part(halves[half], a, modes->count - a);
        int64_t row = states->step == 1 ? half * (Z->nrow / 2) : half;
        RITZ_OWN(ritz_dense) part = {0}, lifted = {0};

        ritz_dense_put(&first, half * n, half * r, &x);
        if (Z->ncol == 0)
            continue;
        RITZ_CHECK(pick_rows(Z, row, states->step,
                             half == 0 ? states->scale : NULL,
                             kind != RITZ_LIFT_LEFT, &part));
        RITZ_CHECK(ritz_dense_mul(&Phi, &part, &lifted));
        ritz_dense_put(&lifted, half * n, 2 * r, &x);
    }
    RITZ_MOVE(*out, x);
    return RITZ_OK;
}

ritz_status ritz_states_basis(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *out)
{
    const ritz_mode_states layout = {&states->modes, states->num_decoupled, 1,
                                     states->scale};
    int64_t r = 2 * states->num_decoupled;
    RITZ_OWN(ritz_basis) basis = {.states = true};

    RITZ_CHECK(ritz_states_lift(&layout, RITZ_LIFT_RIGHT, true, T, &basis.T));
    RITZ_CHECK(ritz_states_lift(&layout, RITZ_LIFT_LEFT, true, W, &basis.W));
    RITZ_CHECK(ritz_columns_new(basis.T.ncol, &basis.columns));
    for (int64_t j = 0; j < basis.T.ncol; j++)
        basis.columns.kind[j] = j < r ? RITZ_COLUMN_RIGID : RITZ_COLUMN_STATE;
    for (int64_t j = 0; j < r; j++)
        basis.columns.hertz[j] = 0.0;
    memcpy(basis.damping, states->damping, sizeof basis.damping);
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "dense LAPACK");
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

void ritz_states_free(ritz_states *states)
{
    ritz_modal_model_free(&states->modes);
    free(states->scale);
    ritz_dense_free(&states->A);
    ritz_dense_free(&states->B);
    ritz_dense_free(&states->C);
    *states = (ritz_states){0};
}
