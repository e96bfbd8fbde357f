/* What ritz-assemble and ritz-simulate print about a scene that spins. */
#include "print/print.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/inertia_terms.h"

#include <math.h>

/* Warn of the terms that a spin model leaves out [PadillaVonFlotow1992]. */
static void warn_of_model(cli_run *run, ritz_spin_model kept)
{
    if (kept == RITZ_SPIN_INCONSISTENT)
        cli_warn(run, "spin model 'inconsistent' leaves out geometric "
                      "stiffness (KG) and keeps softening: frequencies are too "
                      "low, and a rate at which the structure is stable may "
                      "make it unstable");
    if (kept == RITZ_SPIN_RUTHLESS)
        cli_warn(run, "spin model 'ruthless' leaves out gyroscopic, softening "
                      "and stiffening terms: loads of the spin act on the "
                      "structure at rest");
}

/* Warn of bodies without KG: a consistent model needs one for each product of
   rates. */
static ritz_status warn_of_missing_stiffening(cli_run *run,
                                              const ritz_stage *stage,
                                              const ritz_configuration *at,
                                              bool *any)
{
    for (int64_t k = 0; k < stage->count; k++) {
        int missing = 0;

        RITZ_CHECK(ritz_stage_missing_stiffening(stage, at, k, &missing));
        if (missing == RITZ_NUM_STIFFENINGS)
            continue;
        *any = true;
        if (stage->scene->spin.model == RITZ_SPIN_CONSISTENT)
            cli_warn(run,
                     "component '%s' has no 'stiffening: {%s: LOAD}': the "
                     "geometric stiffness of its deformation is left out, as "
                     "an inconsistent model does",
                     stage->scene->component[k].name,
                     ritz_stiffening_word[missing]);
    }
    return RITZ_OK;
}

ritz_status spin_warn_of_loss(cli_run *run, const ritz_stage *stage,
                              const bool *turns, const char *terms)
{
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];
        ritz_inertia_loss loss = {0};

        if (turns && !turns[k])
            continue;
        RITZ_CHECK(
            ritz_inertia_loss_of(&body->invariants, &body->K, &body->M, &loss));
        if (loss.value > RITZ_ENERGY_LOST)
            cli_warn(run,
                     "component '%s': %s terms are approximate: mode %ld "
                     "loses %.1g of its kinetic energy",
                     stage->scene->component[k].name, terms, loss.mode + 1,
                     loss.value);
    }
    return RITZ_OK;
}

/* The largest |rate| of a course. */
static double highest_rate(const ritz_spin_rate *rate)
{
    double most = 0.0;

    for (int64_t k = 0; k < rate->count; k++)
        most = fmax(most, fabs(rate->value[k]));
    return most;
}

/* Warn of flexible bodies that name no load for the pull of outboard bodies, if
   that pull changes a frequency by more than `negligible`. *any is set if a
   body has such a pull. */
static ritz_status warn_of_pulls(cli_run *run, const ritz_stage *stage,
                                 const ritz_configuration *at,
                                 const double *without_pull, bool *any)
{
    const ritz_scene_spin *spin = &stage->scene->spin;

    for (int64_t k = 0; k < stage->count; k++) {
        double mass = 0.0;

        *any = *any || isfinite(without_pull[k]);
        if (!(highest_rate(&spin->rate) > without_pull[k]) ||
            spin->model != RITZ_SPIN_CONSISTENT)
            continue;
        RITZ_CHECK(ritz_stage_spin_outboard(stage, at, k, &mass));
        cli_warn(run,
                 "component '%s' has no 'stiffening: {tip: LOAD}': the pull of "
                 "the mass of %.6g outboard does not stiffen it, although it "
                 "changes a frequency by more than %g from about %.3g rad/s on",
                 stage->scene->component[k].name, mass, spin->negligible,
                 without_pull[k]);
    }
    return RITZ_OK;
}

/* The rate up to which stiffening may be left out, and what it rests on. */
static void say_negligible(cli_run *run, double rate, double error,
                           bool estimated, bool missing)
{
    if (!isfinite(rate))
        return;
    sink_field(run, "stiffening",
               ",,stiffening_negligible_rate,stiffening_negligible_error",
               "%s up to %s%.6g rad/s: frequencies change by at most %g",
               missing ? "that is named may be left out" : "may be left out",
               estimated ? "about " : "", rate, error);
}

static ritz_status say_limits(cli_run *run, const ritz_stage *stage,
                              const ritz_configuration *at, bool missing)
{
    const ritz_scene_spin *spin = &stage->scene->spin;
    const double most = highest_rate(&spin->rate);
    RITZ_OWN_ARRAY double *without_pull = NULL;
    ritz_spin_limits limits = {0};
    bool estimated = false;

    RITZ_CHECK_NEW(without_pull, stage->count);
    RITZ_CHECK(ritz_stage_spin_limits(stage, at->setting, spin->negligible,
                                      &limits, without_pull));
    RITZ_CHECK(warn_of_pulls(run, stage, at, without_pull, &estimated));
    say_negligible(run, limits.negligible, spin->negligible, estimated,
                   missing);
    if (isfinite(limits.stable))
        sink_field(run, "stiffness", "stable_rate",
                   "positive definite up to %.6g rad/s", limits.stable);
    if (most >= limits.stable)
        cli_warn(run,
                 "spin of %.6g rad/s is above %.6g rad/s, where the stiffness "
                 "of the %s model stops being positive definite: its motion "
                 "diverges%s",
                 most, limits.stable, ritz_spin_model_name(spin->model),
                 spin->model == RITZ_SPIN_INCONSISTENT
                     ? ", for want of geometric stiffness"
                     : "");
    return RITZ_OK;
}

/* Warn of a joint that closes a loop: how the forces divide is not computed. */
static ritz_status warn_of_loop(cli_run *run, const ritz_stage *stage)
{
    int64_t joint = -1;

    RITZ_CHECK(ritz_stage_spin_loop(stage, &joint));
    if (joint >= 0 && stage->scene->spin.model == RITZ_SPIN_CONSISTENT)
        cli_warn(run,
                 "joint '%s' closes a loop: bodies are stiffened by the "
                 "centrifugal forces that they have without this joint",
                 stage->scene->joint[joint].name);
    return RITZ_OK;
}

ritz_status spin_say(cli_run *run, const ritz_stage *stage,
                     const ritz_configuration *at)
{
    const ritz_scene_spin *spin = &stage->scene->spin;
    const double most = highest_rate(&spin->rate);
    bool missing = false;

    if (!spin->given)
        return RITZ_OK;
    sink_set(run, "spin_rate,spin_model", "%.6g %s", most,
             ritz_spin_model_name(spin->model));
    if (spin->rate.course != RITZ_SPIN_CONSTANT) /* else the system has it */
        cli_say(run, "  %-14s up to %.6g rad/s, %s", "spin", most,
                ritz_spin_model_name(spin->model));
    warn_of_model(run, spin->model);
    RITZ_CHECK(warn_of_loop(run, stage));
    RITZ_CHECK(warn_of_missing_stiffening(run, stage, at, &missing));
    RITZ_CHECK(spin_warn_of_loss(run, stage, NULL, "spin"));
    return say_limits(run, stage, at, missing);
}
