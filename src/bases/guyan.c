/*
 * Guyan (static) reduction: Craig-Bampton without modes.
 *
 * [Guyan1965] R. J. Guyan, Reduction of stiffness and mass matrices,
 * AIAA Journal 3 (1965) 380.
 */
#include <ritz/basis.h>

#include <stdio.h>

static ritz_status make_guyan(const ritz_request *request, ritz_basis *out)
{
    ritz_request without_modes = *request;

    RITZ_REFUSE_IF(
        request->attached.count == 0, RITZ_ERR_ARGUMENT,
        "nothing is attached, so nothing would be kept: name a port");
    without_modes.modes = 0;
    RITZ_CHECK(ritz_method_craig_bampton.make(&without_modes, out));
    snprintf(out->origin.engine, sizeof out->origin.engine, "CHOLMOD");
    return RITZ_OK;
}

const ritz_method ritz_method_guyan = {
    .name = "guyan",
    .summary = "constraint modes only: static condensation",
    .reference = "Guyan1965",
    .when = "a first look; stiff components of little mass of their own",
    .cost = "a factor of the interior, a solve an attached dof",
    .holds = "statics of the interface, rigid motion; frequencies from above",
    .fails = "modes of the interior, which are not there",
    .uses = RITZ_USES_ATTACHED | RITZ_USES_INTERFACE,
    .make = make_guyan,
};
