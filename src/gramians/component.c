/* Gramians of a component by the engine that is asked for, or that fits. */
#include "gramians/engines.h"
#include "gramians/low_rank.h"

#include <math.h>

/* What an engine is called, and what it heeds. */
typedef struct engine_row {
    const char *name;
    ritz_status (*find)(const ritz_gramians_request *request,
                        ritz_gramians *out);
    bool band, among;
} engine_row;

/* Closed form where damping allows, what takes any damping elsewhere. */
static ritz_status find_any(const ritz_gramians_request *request,
                            ritz_gramians *out)
{
    bool large = request->component->num_dofs > RITZ_STATE_DOFS;
    bool fits = false;

    if (request->band_hz[1] > 0.0)
        return ritz_gramians_modal(request, out);
    if (large && !(request->among_hz > 0.0))
        return ritz_gramians_low_rank(request, out);
    RITZ_CHECK(ritz_gramians_modal_if(request, &fits, out));
    if (!fits)
        RITZ_CHECK(large ? ritz_gramians_low_rank(request, out)
                         : ritz_gramians_dense(request, out));
    return RITZ_OK;
}

static const engine_row engines[] = {
    [RITZ_ENGINE_AUTO] = {"auto", find_any, true, true},
    [RITZ_ENGINE_DENSE] = {"dense", ritz_gramians_dense, false, false},
    [RITZ_ENGINE_MODAL] = {"modal", ritz_gramians_modal, true, true},
    [RITZ_ENGINE_LOW_RANK] = {"low-rank", ritz_gramians_low_rank, false, false},
};

static ritz_status check(const ritz_gramians_request *request,
                         const engine_row *engine)
{
    const ritz_io *io = &request->component->io;
    const double *band = request->band_hz;

    RITZ_REFUSE_IF(io->num_inputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no inputs: nothing of it can be reached");
    RITZ_REFUSE_IF(io->num_outputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no outputs: nothing of it can be seen");
    for (int64_t i = 0; i < io->num_outputs; i++)
        RITZ_REFUSE_IF(io->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       io->output[i], io->limit[i]);
    RITZ_REFUSE_IF(!(band[0] == 0.0 && band[1] == 0.0) && !engine->band,
                   RITZ_ERR_ARGUMENT,
                   "a band is of engine 'modal', not of '%s'", engine->name);
    RITZ_REFUSE_IF(band[1] <= 0.0 && band[0] != 0.0, RITZ_ERR_ARGUMENT,
                   "a band is from 0 Hz or more to more, not from %g to %g",
                   band[0], band[1]);
    RITZ_REFUSE_IF(!(request->among_hz >= 0.0), RITZ_ERR_ARGUMENT,
                   "modes cannot be taken up to %g Hz", request->among_hz);
    RITZ_REFUSE_IF(request->among_hz > 0.0 && !engine->among, RITZ_ERR_ARGUMENT,
                   "modes up to a frequency are of engine 'modal', not of '%s'",
                   engine->name);
    return RITZ_OK;
}

ritz_status ritz_gramians_of_component(const ritz_gramians_request *request,
                                       ritz_gramians *out)
{
    const engine_row *engine = &engines[request->engine];

    RITZ_CHECK(check(request, engine));
    return engine->find(request, out);
}
