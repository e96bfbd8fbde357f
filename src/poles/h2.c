/* H2 norm of a model of any kind. */
#include "poles/h2.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Set c and k of each damper; without values, those that the matrices hold. */
static void set_values(const double *c, const double *k, ritz_dampers *dampers)
{
    for (int64_t j = 0; j < dampers->count; j++) {
        dampers->c[j] = c ? c[j] : dampers->held_c[j];
        dampers->k[j] = k ? k[j] : dampers->held_k[j];
    }
}

static ritz_status take_root(const ritz_variance *variance, ritz_h2 *out)
{
    if (!variance->finite)
        return ritz_refuse_infinite(variance);
    out->value = sqrt(variance->square);
    return RITZ_OK;
}

static ritz_status measure_plant(const double *c, const double *k,
                                 ritz_plant *plant, ritz_h2 *out)
{
    ritz_variance variance = {0};

    set_values(c, k, &plant->dampers);
    RITZ_CHECK(ritz_variance_of(plant, &variance));
    return take_root(&variance, out);
}

/* Number of modes in the first space, and largest number of modes. */
enum { FIRST_MODES = 20, MOST_MODES = 320 };

/* H2 norm of a large component in spaces of modes and static responses; the
   number of modes is doubled until the norm settles. */
static ritz_status measure_large(ritz_model model,
                                 const ritz_disturbance *noise, const double *c,
                                 const double *k, ritz_h2 *out)
{
    double before = 0.0;

    for (int64_t modes = FIRST_MODES; modes <= MOST_MODES; modes *= 2) {
        RITZ_OWN(ritz_static_space) space = {0};
        RITZ_OWN(ritz_plant) plant = {0};

        RITZ_CHECK(ritz_static_space_new(model, modes, noise, &space));
        RITZ_CHECK(ritz_static_space_plant(&space, NULL, &plant));
        RITZ_CHECK(measure_plant(c, k, &plant, out));
        out->change =
            out->value > 0.0 ? fabs(out->value - before) / out->value : 0.0;
        (void)snprintf(out->engine, sizeof out->engine,
                       "%" PRId64 " modes and static responses",
                       space.num_modes);
        if (out->change <= RITZ_H2_SETTLED)
            return RITZ_OK;
        before = out->value;
    }
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "with %d modes the H2 norm still changes by %.1e: what "
                     "high frequencies add is damped too little, give damping "
                     "or a low-pass",
                     MOST_MODES, out->change);
}

ritz_status ritz_h2_with(ritz_model model, const ritz_disturbance *noise,
                         const double *c, const double *k, ritz_h2 *out)
{
    ritz_h2 h2 = {.engine = "dense, SLICOT SB03OD"};
    RITZ_OWN(ritz_plant) plant = {0};

    ritz_variance variance = {0};

    RITZ_REFUSE_IF(model.kind == RITZ_MODEL_DENSE && !model.dense.io,
                   RITZ_ERR_ARGUMENT, "the model has no inputs and outputs");
    if (model.kind == RITZ_MODEL_STATES) {
        RITZ_CHECK(ritz_variance_of_states(model.states, noise, &variance));
        RITZ_CHECK(take_root(&variance, &h2));
    } else if (model.kind == RITZ_MODEL_COMPONENT &&
               model.component->num_dofs > RITZ_WHOLE_DOFS) {
        RITZ_CHECK(measure_large(model, noise, c, k, &h2));
    } else {
        RITZ_CHECK(ritz_plant_new(model, noise, &plant));
        RITZ_CHECK(measure_plant(c, k, &plant, &h2));
    }
    *out = h2;
    return RITZ_OK;
}

ritz_status ritz_h2_of(ritz_model model, const ritz_disturbance *noise,
                       ritz_h2 *out)
{
    return ritz_h2_with(model, noise, NULL, NULL, out);
}
