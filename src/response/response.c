#include "poles/poles.h"

#include "base/alloc.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* H of more values than this is a mistake in the request. */
static const int64_t most_values = INT64_C(1) << 31;

static ritz_status copy_names(int64_t count, const char (*from)[RITZ_NAME_SIZE],
                              char (**out)[RITZ_NAME_SIZE])
{
    RITZ_CHECK_NEW(*out, count);
    memcpy(*out, from, (size_t)count * RITZ_NAME_SIZE);
    return RITZ_OK;
}

ritz_status ritz_response_new(const ritz_grid *grid, const ritz_poles *poles,
                              const char *method, const ritz_damping *damping,
                              ritz_response *out)
{
    static const ritz_damping none = {0};
    const ritz_io *io = &poles->io;
    RITZ_OWN(ritz_response)
    r = {.num_inputs = io->num_inputs, .num_outputs = io->num_outputs};
    RITZ_OWN_ARRAY double *omega = NULL;
    RITZ_OWN_ARRAY double *zeta = NULL;

    RITZ_CHECK(ritz_poles_ratios(poles, &omega, &zeta));
    RITZ_CHECK(
        ritz_grid_points(grid, poles->count, omega, zeta, &r.count, &r.hertz));
    RITZ_REFUSE_IF(r.num_inputs * r.num_outputs > most_values / r.count,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " frequencies of %" PRId64 " x %" PRId64
                   " responses are too many",
                   r.count, r.num_outputs, r.num_inputs);
    RITZ_CHECK(copy_names(r.num_inputs, io->input, &r.input));
    RITZ_CHECK(copy_names(r.num_outputs, io->output, &r.output));
    RITZ_CHECK_NEW(r.H, r.count * r.num_inputs * r.num_outputs);
    (void)snprintf(r.method, RITZ_NAME_SIZE, "%s", method);
    ritz_damping_print(damping ? damping : &none, r.damping);
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}
