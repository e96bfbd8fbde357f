/*
 * A basis by the name of its method: the request is checked and the basis
 * signed.
 */
#include "base/alloc.h"
#include "bases/columns.h"

#include <ritz/basis.h>

#include <inttypes.h>
#include <stdio.h>

const ritz_method *ritz_method_find(const char *name)
{
    return ritz_row_find(ritz_methods, "method", name);
}

bool ritz_engine_fits(const ritz_method *method, ritz_engine engine)
{
    const bool modes =
        engine == RITZ_ENGINE_LANCZOS || engine == RITZ_ENGINE_ARPACK ||
        engine == RITZ_ENGINE_SLICES || engine == RITZ_ENGINE_AMLS ||
        engine == RITZ_ENGINE_SLEPC;

    return engine == RITZ_ENGINE_AUTO ||
           modes == ((method->uses & RITZ_USES_COUNT) != 0);
}

static bool knows_accuracy(ritz_engine engine)
{
    return engine == RITZ_ENGINE_AUTO || engine == RITZ_ENGINE_LANCZOS ||
           engine == RITZ_ENGINE_AMLS;
}

ritz_status ritz_request_check(const ritz_method *method,
                               const ritz_request *request)
{
    bool by_number = request->modes >= 0;
    bool by_frequency = request->up_to_hz > 0.0;

    if (method->uses & RITZ_USES_MODES)
        RITZ_REFUSE_IF(
            by_number == by_frequency, RITZ_ERR_ARGUMENT,
            "%s takes either a number of modes or a frequency: --modes "
            "or --up-to-hz (in a scene modes or up_to_hz)",
            method->name);
    else
        RITZ_REFUSE_IF(by_number || by_frequency, RITZ_ERR_ARGUMENT,
                       "%s has no modes to choose: leave out --modes and "
                       "--up-to-hz",
                       method->name);
    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++)
        RITZ_REFUSE_IF(request->choice.given & word->uses & ~method->uses,
                       RITZ_ERR_ARGUMENT, "%s has no '%s' to choose",
                       method->name, word->key);
    RITZ_REFUSE_IF(
        !ritz_engine_fits(method, request->choice.engine), RITZ_ERR_ARGUMENT,
        method->uses & RITZ_USES_COUNT
            ? "%s finds modes: its engines are auto, lanczos, arpack, "
              "slices, amls and slepc"
            : "%s finds Gramians: its engines are auto, dense, modal, "
              "low-rank and projection",
        method->name);
    RITZ_REFUSE_IF(request->choice.accuracy > 0.0 &&
                       !knows_accuracy(request->choice.engine),
                   RITZ_ERR_ARGUMENT,
                   "this engine finds eigenvalues to rounding only: with an "
                   "accuracy the engines are auto, lanczos and amls");
    RITZ_REFUSE_IF(request->neighbour && !(method->uses & RITZ_USES_NEIGHBOUR),
                   RITZ_ERR_ARGUMENT, "%s loads nothing on its interface",
                   method->name);
    return RITZ_OK;
}

void ritz_request_print(const ritz_request *request, char out[RITZ_NAME_SIZE])
{
    out[0] = '\0';
    if (request->modes >= 0)
        snprintf(out, RITZ_NAME_SIZE, "modes %" PRId64, request->modes);
    else if (request->up_to_hz > 0.0)
        snprintf(out, RITZ_NAME_SIZE, "up-to-hz %.17g", request->up_to_hz);
    ritz_choice_print(&request->choice, RITZ_NAME_SIZE, out);
}

static void sign_basis(const ritz_method *method, const ritz_request *request,
                       ritz_origin *origin)
{
    snprintf(origin->method, RITZ_NAME_SIZE, "%s", method->name);
    snprintf(origin->reference, RITZ_NAME_SIZE, "%s", method->reference);
    ritz_request_print(request, origin->options);
}

ritz_status ritz_basis_make(const ritz_method *method,
                            const ritz_request *request, ritz_basis *out)
{
    /* methods that take no damping know only dampers that are stated */
    const bool blind = request->component && method->uses & RITZ_USES_LOADS &&
                       !(method->uses & RITZ_USES_DAMPING);
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_request_check(method, request));
    RITZ_REFUSE_IF(request->choice.engine == RITZ_ENGINE_SLEPC &&
                       !method->by_ranks,
                   RITZ_ERR_ARGUMENT,
                   "engine slepc works in ritz-basis alone, for craig-bampton "
                   "and normal-modes");
    RITZ_CHECK_IN(method->name, method->make(request, &basis));
    sign_basis(method, request, &basis.origin);
    if (blind)
        RITZ_CHECK(ritz_remark_damping(request, &basis));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}
