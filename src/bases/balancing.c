#include "bases/balancing.h"

#include "base/alloc.h"
#include "bases/columns.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_request_damping(const ritz_request *request, ritz_damping *out)
{
    if (request->choice.given & RITZ_USES_DAMPING) {
        *out = request->choice.damping;
        return RITZ_OK;
    }
    return ritz_context(ritz_damping_parse(request->component->damping, out),
                        "damping of the component");
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

ritz_status ritz_request_gramians(const ritz_request *request,
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
        return ritz_gramians_of_space(request->space, out);
    RITZ_CHECK(ritz_request_damping(request, &wanted.damping));
    if (choice->given & (RITZ_USES_AMONG | RITZ_USES_BAND))
        wanted.engine = RITZ_ENGINE_MODAL;
    return ritz_gramians_of_component(&wanted, out);
}

ritz_status ritz_request_balance(const ritz_request *request,
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
    if (residual[0] > 0.0 || residual[1] > 0.0)
        ritz_remark_add(basis, "; ", "residuals of Gramians %.1e and %.1e",
                        residual[0], residual[1]);
    if (!request->space)
        ritz_remark_add(basis, "; ", "damping: %s",
                        gramians->damping[0] ? gramians->damping
                                             : "that of the matrices");
}

ritz_status ritz_balanced_note(const ritz_request *request,
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
