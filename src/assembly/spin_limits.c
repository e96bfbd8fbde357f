/*
 * Rates that limit the model of a scene that spins, from the system at rest and
 * its spin terms: see ritz_spin_limits_of.
 */
#include "assembly/assembly.h"

#include "base/tolerances.h"

#include <math.h>

/* Unit vectors of the flexible modes up to the end of the band; of all flexible
   modes if there is no band, or no mode in it. */
static ritz_status band_modes(const ritz_scene *scene,
                              const ritz_configuration *c, ritz_dense *out)
{
    const double end = 2.0 * RITZ_PI * scene->band_hz[1];
    const int64_t e = c->K.nrow;
    int64_t last = c->num_rigid;

    while (last < e && (end == 0.0 || c->lambda[last] <= end * end))
        last++;
    if (last == c->num_rigid)
        last = e;
    RITZ_CHECK(ritz_dense_new(e, last - c->num_rigid, out));
    for (int64_t j = 0; j < out->ncol; j++)
        ritz_dense_col(out, j)[c->num_rigid + j] = 1.0;
    return RITZ_OK;
}

ritz_status ritz_stage_spin_limits(const ritz_stage *stage,
                                   const double *setting, double error,
                                   ritz_spin_limits *out)
{
    ritz_scene rest = *stage->scene, all = *stage->scene; /* borrowed */
    ritz_stage at_rest = *stage, consistent = *stage;
    ritz_spin_limits limits = {0}, band = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_spin_terms) kept = {0}, terms = {0};
    RITZ_OWN(ritz_dense) modes = {0};

    rest.spin.given = false;
    at_rest.scene = &rest;
    all.spin.model = RITZ_SPIN_CONSISTENT;
    consistent.scene = &all;
    RITZ_CHECK(ritz_stage_assemble(&at_rest, setting, &c));
    RITZ_CHECK(ritz_stage_spin(stage, &c, &kept));
    RITZ_CHECK(ritz_stage_spin(&consistent, &c, &terms));
    RITZ_CHECK(band_modes(&rest, &c, &modes));
    limits.stable = nan("");
    if (c.num_rigid == 0)
        RITZ_CHECK(ritz_spin_limits_of(&kept, &c.K, NULL, error, &limits));
    RITZ_CHECK(ritz_spin_limits_of(&terms, &c.K, &modes, error, &band));
    limits.negligible = band.negligible;
    *out = limits;
    return RITZ_OK;
}
