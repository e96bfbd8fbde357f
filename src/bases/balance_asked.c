#include "bases/balance_asked.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static ritz_status check_states(const ritz_request *request)
{
    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "states are asked for by their number, not by a frequency");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no states are asked for, one at least is needed");
    RITZ_REFUSE_IF(request->choice.num_shifts > 1, RITZ_ERR_ARGUMENT,
                   "the states are shifted by one frequency, not by several");
    return RITZ_OK;
}

ritz_status ritz_request_damping(const ritz_request *request, ritz_damping *out)
{
    if (request->choice.given & RITZ_USES_DAMPING) {
        *out = request->choice.damping;
        return RITZ_OK;
    }
    return ritz_context(ritz_damping_parse(request->component->damping, out),
                        "damping of the component");
}

ritz_status ritz_states_asked(const ritz_request *request, ritz_states *out)
{
    ritz_damping damping = {0};
    double alpha = 0.0;

    RITZ_CHECK(check_states(request));
    RITZ_CHECK(ritz_request_damping(request, &damping));
    if (request->choice.num_shifts > 0)
        alpha = 2.0 * RITZ_PI * request->choice.shift_hz[0];
    return ritz_states_new(request->component, &damping, alpha, out);
}

static ritz_status check_request(const ritz_request *request)
{
    const int of_components = RITZ_USES_DAMPING | RITZ_USES_AMONG;
    int given = request->choice.given;
    ritz_engine engine = request->choice.engine;
    bool modal = given & (RITZ_USES_AMONG | RITZ_USES_BAND);

    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "balanced vectors are asked for by their number, not by a "
                   "frequency");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no vectors are asked for, one at least is needed");
    RITZ_REFUSE_IF(request->space && (given & of_components), RITZ_ERR_ARGUMENT,
                   "a state space has neither modes nor any damping beside its "
                   "matrix");
    RITZ_REFUSE_IF(request->space && engine > RITZ_ENGINE_DENSE,
                   RITZ_ERR_ARGUMENT,
                   "a state space is balanced by the dense engine alone");
    RITZ_REFUSE_IF(
        modal && engine != RITZ_ENGINE_AUTO && engine != RITZ_ENGINE_MODAL,
        RITZ_ERR_ARGUMENT,
        "a choice of modes, or a band, is of the modal engine alone");
    return RITZ_OK;
}

ritz_status ritz_gramians_asked(const ritz_request *request, ritz_gramians *out)
{
    const ritz_choice *choice = &request->choice;
    ritz_gramians_request asked = {
        .component = request->component,
        .engine = choice->engine,
        .among_hz = choice->among_hz,
        .band_hz = {choice->band_hz[0], choice->band_hz[1]}};

    RITZ_CHECK(check_request(request));
    if (request->space)
        return ritz_gramians_of_space(request->space, out);
    RITZ_CHECK(ritz_request_damping(request, &asked.damping));
    if (choice->given & (RITZ_USES_AMONG | RITZ_USES_BAND))
        asked.engine = RITZ_ENGINE_MODAL;
    return ritz_gramians_of_component(&asked, out);
}

ritz_status ritz_balance_asked(const ritz_request *request,
                               const ritz_gramians *gramians,
                               ritz_balanced *out)
{
    RITZ_OWN(ritz_balanced) balanced = {0};

    RITZ_CHECK(ritz_gramians_balance(gramians, request->modes,
                                     request->tolerance, &balanced));
    RITZ_REFUSE_IF(balanced.count == 0, RITZ_ERR_ARGUMENT,
                   "inputs reach nothing that outputs see: there is nothing to "
                   "balance");
    RITZ_REFUSE_IF(balanced.kept == 0, RITZ_ERR_ARGUMENT,
                   "the first values are equal, and are kept whole or not at "
                   "all: ask for more than %" PRId64,
                   request->modes);
    RITZ_MOVE(*out, balanced);
    return RITZ_OK;
}

/* [A B], of which A may be {0}. */
static ritz_status join_columns(const ritz_dense *A, const ritz_dense *B,
                                ritz_dense *out)
{
    return A->ncol == 0 ? ritz_dense_copy(B, out)
                        : ritz_dense_beside(A, B, out);
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
    int64_t apart = gramians->T.ncol;

    for (int64_t j = 0; j < columns->count; j++)
        columns->kind[j] =
            j < apart + kept ? RITZ_COLUMN_STATE : RITZ_COLUMN_PERTURBED;
    for (int64_t j = 0; j < apart; j++)
        if (request->component && is_rigid(&gramians->T, j)) {
            columns->kind[j] = RITZ_COLUMN_RIGID;
            columns->hertz[j] = 0.0;
        }
}

static void add_remark(const ritz_request *request,
                       const ritz_gramians *gramians,
                       const ritz_balanced *balanced, const char *what,
                       ritz_basis *basis)
{
    char text[2 * RITZ_DAMPING_SIZE];
    const double *residual = gramians->residual;

    snprintf(text, sizeof text, "%" PRId64 " of %" PRId64 " %s kept",
             balanced->kept, balanced->count, what);
    ritz_remark_append(basis, text);
    if (balanced->kept < request->modes) {
        snprintf(text, sizeof text,
                 balanced->kept == balanced->count
                     ? "%" PRId64 " were asked for, rounding leaves no more"
                     : "%" PRId64 " were asked for, the next are equal or "
                       "below the tolerance",
                 request->modes);
        ritz_remark_append(basis, text);
    }
    if (!isnan(basis->bound)) {
        snprintf(text, sizeof text, "error at most %.4g, largest value %.4g",
                 basis->bound, balanced->sigma[0]);
        ritz_remark_append(basis, text);
    }
    if (residual[0] > 0.0 || residual[1] > 0.0) {
        snprintf(text, sizeof text, "residuals of Gramians %.1e and %.1e",
                 residual[0], residual[1]);
        ritz_remark_append(basis, text);
    }
    if (!request->space) {
        snprintf(text, sizeof text, "damping: %s",
                 gramians->damping[0] ? gramians->damping
                                      : "that of the matrices");
        ritz_remark_append(basis, text);
    }
}

void ritz_remark_append(ritz_basis *basis, const char *text)
{
    size_t used = strlen(basis->remark);

    snprintf(basis->remark + used, sizeof basis->remark - used, "%s%s",
             used > 0 ? "; " : "", text);
}

ritz_status ritz_balanced_note(const ritz_request *request,
                               const ritz_gramians *gramians,
                               const ritz_balanced *balanced, bool bounded,
                               const char *what, ritz_basis *basis)
{
    RITZ_CHECK_NEW(basis->hankel, balanced->count);
    basis->num_hankel = balanced->count;
    memcpy(basis->hankel, balanced->sigma,
           (size_t)balanced->count * sizeof *basis->hankel);
    basis->bound = bounded ? balanced->bound : nan("");
    basis->among_hz = request->choice.among_hz;
    memcpy(basis->damping, gramians->damping, sizeof basis->damping);
    snprintf(basis->origin.engine, sizeof basis->origin.engine, "%s",
             gramians->engine);
    add_remark(request, gramians, balanced, what, basis);
    return RITZ_OK;
}

ritz_status ritz_balanced_states(const ritz_request *request,
                                 const ritz_gramians *gramians, bool bounded,
                                 ritz_basis *out)
{
    RITZ_OWN(ritz_balanced) kept = {0}, all = {0};
    const ritz_balanced *used = &kept;
    RITZ_OWN(ritz_basis) basis = {.states = true};

    RITZ_CHECK(ritz_balance_asked(request, gramians, &kept));
    if (request->choice.perturb) {
        RITZ_CHECK(
            ritz_gramians_balance(gramians, -1, request->tolerance, &all));
        used = &all;
    }
    RITZ_CHECK(join_columns(&gramians->T, &used->T, &basis.T));
    RITZ_CHECK(join_columns(&gramians->W, &used->W, &basis.W));
    RITZ_CHECK(ritz_columns_new(basis.T.ncol, &basis.columns));
    name_columns(request, gramians, kept.kept, &basis.columns);
    RITZ_CHECK(ritz_balanced_note(request, gramians, &kept, bounded, "states",
                                  &basis));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}
