/* Candidates against their tolerances. */
#include "fit/fit_parts.h"

#include <inttypes.h>
#include <math.h>

/* A tolerance needs something to be measured by. */
static ritz_status check_limit(const ritz_component *full,
                               const ritz_verify_request *limits,
                               const ritz_measure_kind *kind)
{
    const ritz_io *io = &full->io;
    const bool damped = limits->damping.kind != RITZ_DAMPING_NONE ||
                        full->damping[0] || full->D.colptr || full->K4.colptr;

    RITZ_REFUSE_IF(kind->needs & RITZ_NEEDS_CHANNELS &&
                       (io->num_inputs == 0 || io->num_outputs == 0),
                   RITZ_ERR_ARGUMENT,
                   "a tolerance of '%s' needs inputs and outputs, and there "
                   "are %" PRId64 " and %" PRId64,
                   kind->word, io->num_inputs, io->num_outputs);
    RITZ_REFUSE_IF(
        kind->needs & RITZ_NEEDS_DAMPING && !damped, RITZ_ERR_ARGUMENT,
        "a tolerance of '%s' needs a model that is damped", kind->word);
    return RITZ_OK;
}

ritz_status ritz_fit_check(const ritz_verify_request *limits,
                           const ritz_component *full)
{
    bool any = false;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        if (isnan(limits->limit[k]))
            continue;
        any = any || k != RITZ_MEASURE_MISSING || limits->limit[k] == 0.0;
        RITZ_CHECK(check_limit(full, limits, &ritz_measure_table[k]));
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "no tolerance is given: which measure, how far off");
    return RITZ_OK;
}

void ritz_fit_settle(const ritz_reference *reference,
                     ritz_verify_request *limits)
{
    double *limit = limits->limit;
    int64_t rigid = 0;

    if (!isnan(limit[RITZ_MEASURE_DAMPING])) /* a missing mode has no damping */
        limit[RITZ_MEASURE_MISSING] = fmax(limit[RITZ_MEASURE_MISSING], 0.0);
    (void)ritz_reference_modes(reference, &rigid);
    if (rigid > 0)
        return;
    limit[RITZ_MEASURE_RESPONSE] =
        fmin(limit[RITZ_MEASURE_RESPONSE], limit[RITZ_MEASURE_FLEXIBLE]);
    limit[RITZ_MEASURE_FLEXIBLE] = nan("");
}

void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate)
{
    candidate->excess = 0.0;
    candidate->binding = -1;
    for (int64_t k = 0; k < candidate->errors.count; k++) {
        ritz_measure *m = &candidate->errors.item[k];
        double ratio = 0.0;

        if (isnan(m->limit))
            m->limit = ritz_measure_limit(limits->limit, m->name);
        if (isnan(m->limit))
            continue;
        ratio = ritz_measure_ratio(m->name, m->value, m->limit);
        if (candidate->binding < 0 || ratio > candidate->excess) {
            candidate->excess = ratio;
            candidate->binding = k;
        }
    }
    candidate->feasible = candidate->excess <= 1.0;
}
