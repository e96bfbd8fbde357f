/*
 * Balanced truncation: states are made equally controllable and observable, and
 * those with the largest Hankel values are kept. With factors of the Gramians,
 *
 *     Z_o'E Z_c = U S V',   T = Z_c V_1 S_1^-1/2,   W = Z_o U_1 S_1^-1/2,
 *
 * W'E T = I, and of the reduced model W'A T both Gramians are S_1. It is stable
 * and its error is at most twice the sum of the values in S_2 [Moore1981]. The
 * states of S_2 can be kept as columns that respond statically: then the
 * response at 0 Hz is exact, and the bound is the same [LiuAnderson1989].
 *
 * Rigid modes, and unstable poles of a state space, have no Gramian: they are
 * decoupled and always kept.
 */
#include "base/alloc.h"
#include "bases/balancing.h"
#include "bases/columns.h"

/* T contains rigid modes as positions or as velocities; other poles as both. */
static bool is_rigid(const ritz_dense *T, int64_t j)
{
    const double *x = ritz_dense_col(T, j);
    int64_t n = T->nrow / 2;
    bool zero[2] = {true, true};

    for (int64_t i = 0; i < 2 * n; i++)
        zero[i >= n] = zero[i >= n] && x[i] == 0.0;
    return zero[0] || zero[1];
}

static void name_columns(const ritz_request *request,
                         const ritz_gramians *gramians, int64_t kept,
                         ritz_columns *columns)
{
    int64_t first = gramians->T.ncol;

    for (int64_t j = 0; j < columns->count; j++)
        columns->kind[j] =
            j < first + kept ? RITZ_COLUMN_STATE : RITZ_COLUMN_PERTURBED;
    for (int64_t j = 0; j < first; j++)
        if (request->component && is_rigid(&gramians->T, j))
            ritz_columns_label_rigid(j, columns);
}

/*
 * T = [T_d, T_kept, T_rest] of states, and W likewise: states without Gramian,
 * balanced states that are kept and, if requested, those that respond
 * statically.
 *
 * @param[in] bounded  whether the rest of the values bounds the error
 */
static ritz_status balance_states(const ritz_request *request, bool bounded,
                                  ritz_basis *out)
{
    RITZ_OWN(ritz_gramians) gramians = {0};
    RITZ_OWN(ritz_balanced) kept = {0}, all = {0};
    const ritz_balanced *used = &kept;
    RITZ_OWN(ritz_basis) basis = {.states = true};

    RITZ_CHECK(ritz_request_gramians(request, &gramians));
    RITZ_CHECK(ritz_request_balance(request, &gramians, &kept));
    if (request->choice.perturb) {
        RITZ_CHECK(
            ritz_gramians_balance(&gramians, -1, request->tolerance, &all));
        used = &all;
    }
    RITZ_CHECK(ritz_dense_beside(&gramians.T, &used->T, &basis.T));
    RITZ_CHECK(ritz_dense_beside(&gramians.W, &used->W, &basis.W));
    RITZ_CHECK(ritz_columns_new(basis.T.ncol, &basis.columns));
    name_columns(request, &gramians, kept.kept, &basis.columns);
    RITZ_CHECK(ritz_balanced_note(request, &gramians, &kept, bounded, "states",
                                  &basis));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

static ritz_status make_balanced(const ritz_request *request, ritz_basis *out)
{
    return balance_states(request, true, out);
}

const ritz_method ritz_method_balanced = {
    .name = "balanced",
    .summary = "balanced states, with a bound of the error before it is made",
    .reference = "Moore1981",
    .when = "damped models for control, few inputs and outputs; state spaces",
    .cost = "modal O(m^2 r), dense O(n^3); low rank: some solves a state",
    .holds = "stability; error at most twice the values left out",
    .fails = "light damping: no value is small; interfaces of other bodies",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_REMAINDER | RITZ_USES_SPACE,
    .make = make_balanced,
};

/*
 * Balanced truncation over a band [GawronskiJuang1990]: Gramians are integrals
 * over frequency, and those over w1 <= |w| <= w2 alone,
 *
 *     W_c = 1/2pi int (i w - A)^-1 B B' (i w - A)^-* dw,
 *
 * show which states matter in the band. They solve Lyapunov equations whose
 * right side is indefinite, so that the reduced model may be unstable, and no
 * sum of the values bounds its error: ritz-reduce checks its stability. In
 * modal coordinates they have closed forms.
 */
static ritz_status make_balanced_band(const ritz_request *request,
                                      ritz_basis *out)
{
    RITZ_REFUSE_IF(
        !(request->choice.given & RITZ_USES_BAND), RITZ_ERR_ARGUMENT,
        "a band is needed, from and to which frequency: band-hz 0,10");
    return balance_states(request, false, out);
}

const ritz_method ritz_method_balanced_band = {
    .name = "balanced-band",
    .summary = "states balanced over a band of frequencies alone",
    .reference = "GawronskiJuang1990",
    .when = "a response over one band, modal damping, in states",
    .cost = "all modes, or those up to a frequency; O(m^3)",
    .holds = "nothing: stability is checked, the error measured",
    .fails = "one reduction in ten is unstable; coupled damping",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_BAND,
    .only_named = RITZ_NAMED_FOR_COMPONENTS,
    .make = make_balanced_band,
};
