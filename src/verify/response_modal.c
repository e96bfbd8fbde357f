/* Response of a full component by its lowest modes and the residual. */
#include "verify/poles.h"

#include <ritz/monitor.h>

ritz_status ritz_response_modal(const ritz_component *component,
                                const ritz_damping *damping, double up_to_hz,
                                const ritz_grid *grid, ritz_response *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    ritz_poles poles = {0};
    ritz_residual residual = {0};
    ritz_response r = {0};
    double highest = up_to_hz > 0.0 ? up_to_hz : 3.0 * grid->to_hz;

    RITZ_TRY(ritz_grid_check(grid));
    RITZ_FAIL_IF(highest < grid->to_hz, RITZ_ERR_ARGUMENT,
                 "modes up to %g Hz cannot give a response up to %g Hz",
                 highest, grid->to_hz);
    RITZ_TRY(
        ritz_poles_of_component(component, damping, highest, &pairs, &poles));
    RITZ_TRY(ritz_residual_new(component, &pairs, grid->to_hz, &residual));
    RITZ_TRY(ritz_response_new(grid, &poles, "modal", damping, &r));
    for (int64_t k = 0; k < r.count; k++) {
        double _Complex *H = r.H + k * r.num_outputs * r.num_inputs;

        RITZ_TRY(ritz_poles_add(&poles, r.hertz[k], H));
        ritz_residual_add(&residual, r.hertz[k], H);
        ritz_monitor_step("response", k + 1, r.count);
    }
    *out = r;
    r = (ritz_response){0};
done:
    ritz_pairs_free(&pairs);
    ritz_poles_free(&poles);
    ritz_residual_free(&residual);
    ritz_response_free(&r);
    return status;
}
