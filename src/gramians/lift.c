/* From vectors and Gramians of modal states to those of x = [u; u']. */
#include "base/alloc.h"
#include "gramians/modes.h"

/* Half of the rows of Z: first, first + step, ..., the k-th of them divided by
   scale[k] if `over`, multiplied otherwise; NULL: not scaled. */
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

ritz_status ritz_states_lift(const ritz_mode_states *states,
                             ritz_lift_kind kind, bool rigid,
                             const ritz_dense *Z, ritz_dense *out)
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

ritz_status ritz_gramians_lift(const ritz_mode_states *states,
                               ritz_gramians *gramians)
{
    RITZ_OWN(ritz_dense) none = {0};
    bool whole = states->modes->count > states->num_decoupled;
    const ritz_dense *Zc = whole ? &gramians->Zc : &none;
    const ritz_dense *Zo = whole ? &gramians->Zo : &none;
    RITZ_OWN(ritz_gramians) x = *gramians;

    x.Zc = x.Zo = x.T = x.W = (ritz_dense){0};
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_RIGHT, false, Zc, &x.Zc));
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_MOMENTA, false, Zc, &x.EZc));
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_LEFT, false, Zo, &x.Zo));
    RITZ_CHECK(
        ritz_states_lift(states, RITZ_LIFT_RIGHT, true, &gramians->T, &x.T));
    RITZ_CHECK(
        ritz_states_lift(states, RITZ_LIFT_LEFT, true, &gramians->W, &x.W));
    RITZ_MOVE(x.core[0], gramians->Zc);
    RITZ_MOVE(x.core[1], gramians->Zo);
    ritz_gramians_free(gramians);
    RITZ_MOVE(*gramians, x);
    return RITZ_OK;
}

void ritz_gramians_free(ritz_gramians *gramians)
{
    ritz_dense_free(&gramians->Zc);
    ritz_dense_free(&gramians->EZc);
    ritz_dense_free(&gramians->Zo);
    ritz_dense_free(&gramians->core[0]);
    ritz_dense_free(&gramians->core[1]);
    ritz_dense_free(&gramians->T);
    ritz_dense_free(&gramians->W);
    *gramians = (ritz_gramians){0};
}
