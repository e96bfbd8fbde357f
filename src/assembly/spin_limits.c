/*
 * Rates that limit the model of a scene that spins, from the system at rest and
 * its spin terms: see ritz_spin_limits_of.
 */
#include "assembly/spin.h"

#include "base/alloc.h"
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

/* Add to KG of a system what the pull of outboard bodies lacks; of each body,
   the rate up to which that alone may be left out. */
static ritz_status add_missing_pulls(const ritz_stage *stage,
                                     const ritz_configuration *c,
                                     const ritz_dense *modes, double error,
                                     ritz_spin_terms *sum, double *without_pull)
{
    for (int64_t k = 0; k < stage->count; k++) {
        RITZ_OWN(ritz_dense) KG = {0};
        RITZ_OWN(ritz_spin_terms) pull = {0};
        ritz_spin_limits limits = {HUGE_VAL, HUGE_VAL};

        RITZ_CHECK(ritz_spin_add_missing_pull(stage, &c->places, k, &KG));
        if (KG.val) {
            RITZ_CHECK(ritz_dense_congruence(&KG, &c->P[k], &pull.KG));
            RITZ_CHECK(ritz_dense_new(c->K.nrow, 2, &pull.load));
            RITZ_CHECK(
                ritz_spin_limits_of(&pull, &c->K, modes, error, &limits));
            if (!sum->KG.val)
                RITZ_CHECK(ritz_dense_new(c->K.nrow, c->K.nrow, &sum->KG));
            ritz_dense_add(1.0, &pull.KG, &sum->KG);
        }
        if (without_pull)
            without_pull[k] = limits.negligible;
    }
    return RITZ_OK;
}

ritz_status ritz_stage_spin_limits(const ritz_stage *stage,
                                   const double *setting, double error,
                                   ritz_spin_limits *out, double *without_pull)
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
    RITZ_CHECK(
        add_missing_pulls(stage, &c, &modes, error, &terms, without_pull));
    limits.stable = nan("");
    if (c.num_rigid == 0)
        RITZ_CHECK(ritz_spin_limits_of(&kept, &c.K, NULL, error, &limits));
    RITZ_CHECK(ritz_spin_limits_of(&terms, &c.K, &modes, error, &band));
    limits.negligible = band.negligible;
    *out = limits;
    return RITZ_OK;
}
