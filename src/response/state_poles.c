#include "response/state_poles.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "response/responder.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_near_poles_free(ritz_near_poles *near)
{
    RITZ_FREE(near->s, near->x);
    *near = (ritz_near_poles){0};
}

/* Add a pole and its vector of n entries, unless the pole is known already. */
static void add_pole(double _Complex s, int64_t n, const double _Complex *x,
                     ritz_near_poles *out)
{
    for (int64_t k = 0; k < out->count; k++)
        if (cabs(out->s[k] - s) <= RITZ_SAME * cabs(s))
            return;
    memcpy(out->x + out->count * n, x, (size_t)n * sizeof *x);
    out->s[out->count++] = s;
}

static ritz_status find_around(ritz_pencil *pencil, double hertz,
                               ritz_near_poles *out)
{
    RITZ_OWN(ritz_pencil_pairs) near = {0};
    ritz_status status =
        ritz_pencil_nearest(pencil, ritz_complex(0.0, 2.0 * RITZ_PI * hertz),
                            RITZ_POLES_NEAR, &near);

    if (status != RITZ_OK)
        return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
    for (int64_t k = 0; k < near.count; k++)
        add_pole(near.s[k], pencil->n, near.x + k * pencil->n, out);
    return RITZ_OK;
}

ritz_status ritz_poles_near(ritz_pencil *pencil,
                            const ritz_response_request *request,
                            ritz_near_poles *out)
{
    const int64_t most = (int64_t)RITZ_POLE_PLACES * RITZ_POLES_NEAR;
    const double width = request->to_hz - request->from_hz;
    RITZ_OWN(ritz_near_poles) near = {0};

    RITZ_CHECK_NEW(near.s, most);
    RITZ_CHECK_NEW(near.x, most * pencil->n);
    for (int k = 0; k < RITZ_POLE_PLACES && pencil->n > 0; k++)
        RITZ_CHECK(find_around(
            pencil, request->from_hz + width * (k + 0.5) / RITZ_POLE_PLACES,
            &near));
    RITZ_MOVE(*out, near);
    return RITZ_OK;
}

ritz_status ritz_near_poles_list(const ritz_near_poles *near,
                                 const ritz_response_request *request,
                                 ritz_poles *out)
{
    const ritz_io io = ritz_model_io(request->model); /* borrowed */

    RITZ_CHECK_NEW(out->lambda, near->count);
    RITZ_CHECK_NEW(out->rate, near->count);
    for (int64_t k = 0; k < near->count; k++) {
        if (!(cimag(near->s[k]) > RITZ_SAME * cabs(near->s[k])))
            continue;
        out->lambda[out->count] = pow(cabs(near->s[k]), 2.0);
        out->rate[out->count++] = fmax(-2.0 * creal(near->s[k]), 0.0);
    }
    return ritz_poles_name(&io, out);
}
