/*
 * Balanced truncation: states are made equally controllable and observable, and
 * those with the largest Hankel values S_1 are kept: of the reduced model W'A T
 * (ritz_gramians_balance) both Gramians are S_1. It is stable and its error is
 * at most twice the sum of the values in S_2 [Moore1981]. The states of S_2 can
 * be kept as columns that respond statically: then the response at 0 Hz is
 * exact, and the bound is the same [LiuAnderson1989].
 *
 * Rigid modes, and unstable poles of a state space, have no Gramian: they are
 * decoupled and always kept.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "gramians/modes.h"
#include "linear/orthonormal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ritz_status check_request(const ritz_request *request)
{
    const int of_components = RITZ_USES_DAMPING | RITZ_USES_AMONG;
    int given = request->choice.given;
    ritz_engine engine = request->choice.engine;
    bool modal = given & (RITZ_USES_AMONG | RITZ_USES_BAND);

    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "balanced vectors are asked for by their number, not by a "
                   "frequency: --modes, not --up-to-hz");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no vectors are asked for, one at least is needed: --modes");
    RITZ_REFUSE_IF(request->space && (given & of_components), RITZ_ERR_ARGUMENT,
                   "a state space has neither modes nor any damping beside its "
                   "matrix");
    RITZ_REFUSE_IF(
        !request->space && modal && engine != RITZ_ENGINE_AUTO &&
            engine != RITZ_ENGINE_MODAL,
        RITZ_ERR_ARGUMENT,
        "a choice of modes, or a band, is of the modal engine alone");
    return RITZ_OK;
}

/* Gramians of the component or state space of a request, by its engine. */
static ritz_status request_gramians(const ritz_request *request,
                                    ritz_gramians *out)
{
    const ritz_choice *choice = &request->choice;
    ritz_gramians_request wanted = {
        .component = request->component,
        .engine = choice->engine,
        .among_hz = choice->among_hz,
        .band_hz = {choice->band_hz[0], choice->band_hz[1]}};

    RITZ_CHECK(check_request(request));
    if (request->space)
        return ritz_gramians_of_space_by(
            request->space, choice->engine,
            choice->given & RITZ_USES_BAND ? choice->band_hz : NULL, out);
    RITZ_CHECK(ritz_request_damping(request, &wanted.damping));
    if (choice->given & (RITZ_USES_AMONG | RITZ_USES_BAND))
        wanted.engine = RITZ_ENGINE_MODAL;
    return ritz_gramians_of_component(&wanted, out);
}

/* Truncate the balanced states as requested. */
static ritz_status request_balance(const ritz_request *request,
                                   const ritz_gramians *gramians,
                                   ritz_balanced *out)
{
    RITZ_OWN(ritz_balanced) balanced = {0};

    RITZ_CHECK(ritz_gramians_balance(gramians, request->modes,
                                     request->tolerance, &balanced));
    RITZ_REFUSE_IF(balanced.count == 0, RITZ_ERR_ARGUMENT,
                   "nothing is both controllable and observable: there is "
                   "nothing to balance");
    RITZ_REFUSE_IF(balanced.kept == 0, RITZ_ERR_ARGUMENT,
                   "the first values are equal, and are kept whole or not at "
                   "all: ask for more than %" PRId64,
                   request->modes);
    RITZ_MOVE(*out, balanced);
    return RITZ_OK;
}

static void add_remark(const ritz_request *request,
                       const ritz_gramians *gramians,
                       const ritz_balanced *balanced, const char *what,
                       ritz_basis *basis)
{
    const double *residual = gramians->residual;

    ritz_remark_add(basis, "; ", "%" PRId64 " of %" PRId64 " %s kept",
                    balanced->kept, balanced->count, what);
    if (balanced->kept < request->modes)
        ritz_remark_add(basis, "; ", "%" PRId64 " were asked for, %s",
                        request->modes,
                        balanced->kept == balanced->count
                            ? "rounding leaves no more"
                            : "the next are equal or below the tolerance");
    if (!isnan(basis->bound))
        ritz_remark_add(basis, "; ", "error at most %.4g, largest value %.4g",
                        basis->bound, balanced->sigma[0]);
    if (gramians->error > 0.0)
        ritz_remark_add(basis, "; ",
                        "no Hankel value errs by more than %.1e of the largest",
                        gramians->error);
    if (residual[0] > 0.0 || residual[1] > 0.0)
        ritz_remark_add(basis, "; ", "residuals of Gramians %.1e and %.1e",
                        residual[0], residual[1]);
    if (!request->space)
        ritz_remark_add(basis, "; ", "damping: %s",
                        gramians->damping[0] ? gramians->damping
                                             : "that of the matrices");
}

/* Add the values, and a remark on their reliability. */
static ritz_status note_values(const ritz_request *request,
                               const ritz_gramians *gramians,
                               const ritz_balanced *balanced, bool bounded,
                               const char *what, ritz_basis *basis)
{
    RITZ_CHECK_COPY(basis->hankel, balanced->sigma, balanced->count);
    basis->num_hankel = balanced->count;
    basis->bound = bounded ? balanced->bound : nan("");
    basis->among_hz = request->choice.among_hz;
    memcpy(basis->damping, gramians->damping, sizeof basis->damping);
    snprintf(basis->origin.engine, sizeof basis->origin.engine, "%s",
             gramians->engine);
    add_remark(request, gramians, balanced, what, basis);
    return RITZ_OK;
}

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

    RITZ_CHECK(request_gramians(request, &gramians));
    RITZ_CHECK(request_balance(request, &gramians, &kept));
    if (request->choice.perturb) {
        RITZ_CHECK(
            ritz_gramians_balance(&gramians, -1, request->tolerance, &all));
        used = &all;
    }
    RITZ_CHECK(ritz_dense_beside(&gramians.T, &used->T, &basis.T));
    RITZ_CHECK(ritz_dense_beside(&gramians.W, &used->W, &basis.W));
    RITZ_CHECK(ritz_columns_new(basis.T.ncol, &basis.columns));
    name_columns(request, &gramians, kept.kept, &basis.columns);
    RITZ_CHECK(
        note_values(request, &gramians, &kept, bounded, "states", &basis));
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
    .cost = "modal O(m^2 r), dense O(n^3); large: solves, see projection",
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
    .when = "a response over one band, modal damping, in states; state spaces",
    .cost = "all modes, or those up to a frequency; O(m^3); a factor a point",
    .holds = "nothing: stability is checked, the error measured",
    .fails = "one reduction in ten is unstable; coupled damping",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_BAND | RITZ_USES_SPACE,
    .only_named = RITZ_NAMED_FOR_COMPONENTS,
    .make = make_balanced_band,
};

/*
 * Balanced truncation of M u'' + D u' + K u = B f, y = C u + Cv u', that gives
 * a model of second order [ReisStykel2008]. The factors of both Gramians of x =
 * [u; u'] are cut in halves,
 *
 *     Z_c = [Z_p; Z_v],   Z_o = [.; L],   U S V' = svd(L'M Z),
 *     T = Z V_1 S_1^-1/2,   W = L U_1 S_1^-1/2,   W'M T = I,
 *     M_r = I,   D_r = W'D T,   K_r = W'K T,
 *
 * with Z = Z_p or Z = Z_v, the position-velocity and the velocity balancing of
 * the paper. The lower half of the equation (s E - A)' w = [C'; Cv'] is
 *
 *     (s^2 M' + s D' + K') w = C' + s Cv'
 *
 * so L L' is the position Gramian of the dual model with input matrix C', and
 * its velocity Gramian with Cv'. Hence W = T for a symmetric model whose
 * outputs are the displacements (Z_p) or velocities (Z_v) at its inputs, and
 * the reduced model is symmetric, definite and stable. Otherwise that is not
 * guaranteed; if one-sided projection is requested, T serves on the left too,
 * which keeps symmetry but not the balance.
 *
 * The upper half of Z_o is the dual velocity but for D': balancing it against
 * Z_p, as [MeyerSrinivasan1996] do and keep T alone of, needs M^-1 to be a left
 * vector and is not symmetric where the model is.
 */
/* Which half of the controllability Gramian of x = [u; u'] is balanced. */
typedef enum ritz_half {
    RITZ_HALF_POSITION,
    RITZ_HALF_VELOCITY,
} ritz_half;

typedef struct second {
    ritz_gramians states; /* of x = [u; u'] */
    ritz_gramians half;   /* Z, M Z and L in the place of Z_c, E Z_c and Z_o */
    ritz_balanced balanced;
    ritz_dense Phi, MPhi; /* rigid modes; {0}: none */
} second;

static void second_free(second *s)
{
    ritz_gramians_free(&s->states);
    ritz_gramians_free(&s->half);
    ritz_balanced_free(&s->balanced);
    ritz_dense_free(&s->Phi);
    ritz_dense_free(&s->MPhi);
}

static ritz_status copy_half(const ritz_dense *Z, bool lower, ritz_dense *out)
{
    int64_t n = Z->nrow / 2;

    return ritz_dense_block(Z, lower ? n : 0, n, 0, Z->ncol, out);
}

/* The part without Gramian must be rigid motion. */
static ritz_status refuse_unstable(const second *s)
{
    for (int lower = 0; lower < 2; lower++) {
        RITZ_OWN(ritz_dense) part = {0};
        double size = 0.0;

        RITZ_CHECK(copy_half(&s->states.T, lower, &part));
        size = ritz_dense_max(&part);
        if (s->Phi.ncol > 0)
            RITZ_CHECK(ritz_dense_take_out(&s->Phi, &s->MPhi, &part));
        RITZ_REFUSE_IF(
            ritz_dense_max(&part) > RITZ_RIGID_STATE * size, RITZ_ERR_ARGUMENT,
            "a pole that is no rigid motion is not left of the axis: "
            "balance the states of this component instead");
    }
    return RITZ_OK;
}

static ritz_status find_rigid(const ritz_component *component, second *s)
{
    const ritz_span rigid = {.modes = 0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (s->states.T.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK_IN("rigid modes", ritz_eigen_sparse(&component->K, &component->M,
                                                   &rigid, &pairs));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &s->Phi));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &s->Phi, &s->MPhi));
    return refuse_unstable(s);
}

/* The halves of the factors, M-orthogonal to rigid motion. */
static ritz_status cut_halves(const ritz_component *component, ritz_half half,
                              second *s)
{
    ritz_gramians *to = &s->half;

    RITZ_CHECK(copy_half(&s->states.Zc, half == RITZ_HALF_VELOCITY, &to->Zc));
    RITZ_CHECK(copy_half(&s->states.Zo, true, &to->Zo));
    for (int twice = 0; twice < 2 && s->Phi.ncol > 0; twice++) {
        RITZ_CHECK(ritz_dense_take_out(&s->Phi, &s->MPhi, &to->Zc));
        RITZ_CHECK(ritz_dense_take_out(&s->Phi, &s->MPhi, &to->Zo));
    }
    return ritz_sparse_mul(&component->M, &to->Zc, &to->EZc);
}

/* |X'Y|^2 in the Frobenius norm. */
static ritz_status squared_norm(const ritz_dense *X, const ritz_dense *Y,
                                double *out)
{
    RITZ_OWN(ritz_dense) XY = {0};

    RITZ_CHECK(ritz_dense_mul_tn(X, Y, &XY));
    *out = 0.0;
    for (int64_t k = 0; k < XY.nrow * XY.ncol; k++)
        *out += XY.val[k] * XY.val[k];
    return RITZ_OK;
}

/*
 * Whether B B' = a C'C, a > 0, and K, M and D are symmetric:
 *
 *     |B B' - a C'C|^2 = |B'B|^2 - 2 a |C B|^2 + a^2 |C C'|^2
 *
 * is least, and then zero, with a = |C B|^2 / |C C'|^2.
 */
static ritz_status is_self_dual(const ritz_component *component, ritz_half half,
                                bool *out)
{
    const ritz_io *io = &component->io;
    bool velocity = half == RITZ_HALF_VELOCITY;
    RITZ_OWN(ritz_dense) C = {0};
    double BB = 0.0, CB = 0.0, CC = 0.0;

    *out = false;
    if (ritz_dense_max(velocity ? &io->C : &io->Cv) > 0.0 ||
        ritz_dense_max(&io->Ca) > 0.0 ||
        (component->D.colptr && ritz_sparse_asymmetry(&component->D) > 0.0))
        return RITZ_OK;
    RITZ_CHECK(ritz_outputs_scaled(velocity ? &io->Cv : &io->C, io->limit, &C));
    RITZ_CHECK(squared_norm(&io->B, &io->B, &BB));
    RITZ_CHECK(squared_norm(&C, &io->B, &CB));
    RITZ_CHECK(squared_norm(&C, &C, &CC));
    *out = CB > 0.0 && BB * CC - CB * CB <= RITZ_SQUARE_ROUNDING * BB * CC;
    return RITZ_OK;
}

/*
 * Make T M-orthonormal column by column, so that the first columns remain the
 * most important.
 */
static ritz_status orthonormalise_columns(const ritz_component *component,
                                          double tolerance, ritz_dense *T)
{
    RITZ_OWN(ritz_orthonormal) set = {0};

    RITZ_CHECK(ritz_orthonormal_new(T->nrow, &component->M, tolerance, &set));
    for (int64_t j = 0; j < T->ncol; j++) {
        ritz_dense column = ritz_dense_part(T, j, 1); /* overwritten */

        RITZ_CHECK(ritz_orthonormal_append(&set, &column, 1, NULL));
    }
    ritz_dense_free(T);
    return ritz_dense_columns(&set.V, 0, set.count, T);
}

static ritz_status find_vectors(const ritz_request *request, const second *s,
                                bool one_sided, ritz_basis *basis)
{
    RITZ_CHECK(ritz_dense_beside(&s->Phi, &s->balanced.T, &basis->T));
    if (one_sided)
        RITZ_CHECK(orthonormalise_columns(request->component,
                                          request->tolerance, &basis->T));
    else
        RITZ_CHECK(ritz_dense_beside(&s->Phi, &s->balanced.W, &basis->W));
    RITZ_CHECK(ritz_columns_new(basis->T.ncol, &basis->columns));
    for (int64_t j = 0; j < basis->T.ncol; j++)
        basis->columns.kind[j] = RITZ_COLUMN_BALANCED;
    for (int64_t j = 0; j < s->Phi.ncol; j++)
        ritz_columns_label_rigid(j, &basis->columns);
    return RITZ_OK;
}

/*
 * T = [Phi, T_b] and W = [Phi, W_b], Phi the rigid modes: as above.
 *
 * @return RITZ_ERR_ARGUMENT if a pole that is no rigid motion is not left of
 *         the axis, or as request_gramians
 */
static ritz_status balance_second_order(const ritz_request *request,
                                        ritz_half half, ritz_basis *out)
{
    const ritz_component *component = request->component;
    RITZ_OWN(second) s = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    bool self_dual = false;

    RITZ_CHECK(request_gramians(request, &s.states));
    RITZ_CHECK(find_rigid(component, &s));
    RITZ_CHECK(cut_halves(component, half, &s));
    RITZ_CHECK(request_balance(request, &s.half, &s.balanced));
    RITZ_CHECK(is_self_dual(component, half, &self_dual));
    RITZ_CHECK(find_vectors(request, &s, self_dual || request->choice.one_sided,
                            &basis));
    if (self_dual)
        ritz_remark_add(&basis, "; ", "left and right vectors agree");
    RITZ_CHECK(
        note_values(request, &s.states, &s.balanced, false, "vectors", &basis));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

/*
 * Balancing of positions: displacements that the inputs control, against those
 * that the outputs of the dual model observe.
 */

static ritz_status make_position(const ritz_request *request, ritz_basis *out)
{
    return balance_second_order(request, RITZ_HALF_POSITION, out);
}

const ritz_method ritz_method_balanced_position = {
    .name = "balanced-position",
    .summary = "vectors balanced by positions, second order stays second order",
    .reference = "ReisStykel2008",
    .when = "few inputs, displacements as outputs, a second-order result",
    .cost = "as balanced: modal O(m^2 r), dense O(n^3), low rank",
    .holds = "symmetry and stability if outputs lie at inputs, or on one side",
    .fails = "inputs and outputs apart: stability is checked, error measured",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_SIDES,
    .make = make_position,
};

/*
 * Balancing of velocities, the half of the states in which a mode's values are
 * nearly its Hankel values.
 */

static ritz_status make_velocity(const ritz_request *request, ritz_basis *out)
{
    return balance_second_order(request, RITZ_HALF_VELOCITY, out);
}

const ritz_method ritz_method_balanced_velocity = {
    .name = "balanced-velocity",
    .summary = "vectors balanced by velocities, second order stays so",
    .reference = "ReisStykel2008",
    .when = "few inputs, velocities as outputs, a second-order result",
    .cost = "as balanced: modal O(m^2 r), dense O(n^3), low rank",
    .holds = "symmetry and stability if velocities lie at inputs, or one side",
    .fails = "inputs and outputs apart: stability is checked, error measured",
    .uses = RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_ENGINE |
            RITZ_USES_AMONG | RITZ_USES_SIDES,
    .make = make_velocity,
};
