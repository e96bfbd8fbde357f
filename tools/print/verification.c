#include "print/print.h"

#include "base/text.h"

static ritz_status say_measures(cli_run *run, const ritz_measures *measures)
{
    const ritz_measure *first = NULL;
    int64_t failed = 0;
    int64_t limits = 0;

    model_say_measures(run, SINK_LINE, "measures", measures, "measured");
    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];

        limits += !isnan(m->limit);
        if (ritz_measure_holds(m))
            continue;
        first = first ? first : m;
        failed++;
    }
    RITZ_REFUSE_IF(first, RITZ_ERR_CONVERGENCE,
                   "'%s': %ld of %ld limits not met, first '%s', %.3e where "
                   "%.3e is asked",
                   run->operand[1], failed, limits, first->name, first->value,
                   first->limit);
    return RITZ_OK;
}

/* A limit of what is not there is met, and nothing was compared. */
static void warn_unmeasured(cli_run *run, const verify_options *given,
                            const ritz_measures *measures)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (isnan(given->verify.limit[k]) ||
            ritz_measures_find(measures, kind->name) ||
            (kind->other && ritz_measures_find(measures, kind->other)))
            continue;
        cli_warn(run, "--limit-%s: nothing of '%s' is there to be compared",
                 kind->word, run->operand[1]);
    }
}

static ritz_status check_limits(const cli_run *run, const verify_options *given,
                                bool states)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        RITZ_REFUSE_IF(!isnan(given->verify.limit[k]) &&
                           (states ? !kind->of_states : !kind->of_modes),
                       RITZ_ERR_ARGUMENT,
                       "'%s' is %s state space, --limit-%s is not for it",
                       run->operand[1], states ? "a" : "no", kind->word);
    }
    return RITZ_OK;
}

/* Write what was measured, limits met or not, and refuse what is not met. */
static ritz_status keep_measures(cli_run *run, const verify_options *given,
                                 ritz_measures *measures, model *reduced)
{
    ritz_measures *place = reduced->kind == MODEL_STATES
                               ? &reduced->states.errors
                           : reduced->at ? &reduced->at->errors
                                         : &reduced->reduced.errors;

    ritz_measures_free(place);
    RITZ_MOVE(*place, *measures);
    model_record(run, place);
    RITZ_CHECK(model_write(run, reduced));
    cli_keep_outputs(run);
    warn_unmeasured(run, given, place);
    return say_measures(run, place);
}

/* The full model as states: as it is, or a component that is small enough. */
static ritz_status settle_states(cli_run *run, model *full, model *reduced,
                                 verify_options *given)
{
    const char *path = run->operand[0];
    const char *own = given->model.damping;
    ritz_damping damping = {0};

    cli_record(run, reduced->states.origin.method,
               ritz_model_order(model_reference(reduced)));
    RITZ_REFUSE_IF(given->model.damper.count > 0, RITZ_ERR_ARGUMENT,
                   "'%s' holds its dampers in A: --damper cannot change them",
                   run->operand[1]);
    RITZ_REFUSE_IF(full->kind == MODEL_STATES && own, RITZ_ERR_ARGUMENT,
                   "'%s' is damped as it is: --damping is for components",
                   path);
    if (full->kind == MODEL_STATES)
        return RITZ_OK;
    RITZ_REFUSE_IF(full->component.num_dofs > RITZ_STATE_DOFS,
                   RITZ_ERR_ARGUMENT,
                   "'%s' has %ld dofs, of more than %d no norms are taken: "
                   "compare the responses that ritz-frf gives of both",
                   path, full->component.num_dofs, (int)RITZ_STATE_DOFS);
    RITZ_CHECK_IN(
        own ? "--damping" : run->operand[1],
        ritz_damping_parse(own ? own : reduced->states.damping, &damping));
    RITZ_CHECK_IN(path, ritz_state_space_of_component(&full->component,
                                                      &damping, &full->states));
    full->kind = MODEL_STATES;
    return RITZ_OK;
}

/* A reduced component is written with its dampers apart, as it was read. */
static ritz_status take_apart(cli_run *run, const verify_options *given,
                              model *reduced)
{
    const char *path = run->operand[1];

    if (reduced->kind != MODEL_REDUCED)
        return RITZ_OK;
    model_free(reduced);
    RITZ_CHECK(model_read(run, path, MODEL_REDUCED, reduced));
    RITZ_CHECK(model_prefix(reduced, path, given->model.order));
    return ritz_context(model_tune(reduced, &given->model.damper), path);
}

static ritz_status settle_matrices(cli_run *run, model *full, model *reduced,
                                   verify_options *given)
{
    ritz_verify_request *request = &given->verify;
    const cli_list *damper = &given->model.damper;

    RITZ_REFUSE_IF(
        full->kind == MODEL_STATES, RITZ_ERR_ARGUMENT,
        "'%s' is a state space and '%s' is none: there is nothing to "
        "compare by",
        run->operand[0], run->operand[1]);
    RITZ_CHECK(model_damping(reduced, given->model.damping, &request->damping));
    if (reduced->at && !(request->band_hz[1] > 0.0))
        memcpy(request->band_hz, reduced->system.band_hz,
               sizeof request->band_hz);
    cli_record(run, reduced->at ? "system" : reduced->reduced.origin.method,
               ritz_model_order(model_reference(reduced)));
    RITZ_CHECK_IN(run->operand[0], model_install(full, damper));
    return ritz_context(model_install(reduced, damper), run->operand[1]);
}

/* --at belongs to whichever model is a system, --order to the reduced model. */
static ritz_status settle_configurations(const cli_run *run, model *full,
                                         model *reduced,
                                         const model_options *given)
{
    const bool placed = full->kind == MODEL_SYSTEM;
    const model_options whole = {.at = placed ? given->at : NULL};
    const bool also = !placed || reduced->kind == MODEL_SYSTEM;

    RITZ_CHECK(model_as_component(full, run->operand[0], &whole));
    RITZ_CHECK(model_prefix(reduced, run->operand[1], given->order));
    return model_at(reduced, run->operand[1], also ? given->at : NULL);
}

/* K, M and loads of a reduced component or of a system where it stands,
   borrowed. */
static ritz_reduced take_loaded(const model *m)
{
    if (m->kind == MODEL_SYSTEM)
        return (ritz_reduced){.K = m->at->K,
                              .M = m->at->M,
                              .num_loads = m->at->num_loads,
                              .load = m->at->load};
    return (ritz_reduced){.K = m->reduced.K,
                          .M = m->reduced.M,
                          .num_loads = m->reduced.num_loads,
                          .load = m->reduced.load};
}

/* A factor of both models, and how far apart they are. */
static void say_factor(cli_run *run, const char *load, const char *way,
                       double full, double reduced)
{
    if (isnan(full) && isnan(reduced))
        return;
    cli_say(run,
            "buckling factor of load '%s'%s: %.6g full, %.6g reduced, %.1e",
            load, way, full, reduced, reduced / full - 1.0);
}

/* Factors of both models; a warning, and none, if they cannot be computed. */
static ritz_status find_factors(cli_run *run, const ritz_component *full,
                                const ritz_reduced *reduced,
                                ritz_buckling **whole, ritz_buckling **small)
{
    ritz_status status = ritz_buckling_of_component(full, whole);

    if (status == RITZ_OK)
        status = ritz_buckling_of_reduced(reduced, small);
    if (status != RITZ_ERR_SINGULAR && status != RITZ_ERR_CONVERGENCE)
        return status;
    cli_warn(run, "buckling factors are not compared: %s",
             ritz_error_message());
    return RITZ_OK;
}

/* Buckling factors of loads that both models have. */
static ritz_status say_buckling(cli_run *run, const model *full,
                                const model *reduced)
{
    const ritz_component *c = &full->component;
    const ritz_reduced r = take_loaded(reduced);
    const ritz_names loads = {"load", c->num_loads, (const char *)c->load,
                              sizeof *c->load};
    RITZ_OWN_ARRAY ritz_buckling *whole = NULL, *small = NULL;

    if (r.num_loads > 0 && c->num_loads > 0)
        RITZ_CHECK(find_factors(run, c, &r, &whole, &small));
    SINK_ITEMS(run, "buckling", k, whole && small ? r.num_loads : 0) {
        const char *name = r.load[k].name;
        const int64_t j = ritz_names_index(&loads, name);
        const ritz_buckling none = {nan(""), nan("")};
        const ritz_buckling *f = j >= 0 ? &whole[j] : &none;

        say_factor(run, name, "", f->factor, small[k].factor);
        say_factor(run, name, " reversed", f->reversed, small[k].reversed);
        sink_set(run, "load,full,reduced", "%s %g %g", name, f->factor,
                 small[k].factor);
        sink_set(run, "full_reversed,reduced_reversed", "%g %g", f->reversed,
                 small[k].reversed);
    }
    return RITZ_OK;
}

ritz_status verify_run(cli_run *run, verify_options *given)
{
    const char *path = run->operand[1];
    RITZ_OWN(model) full = {0}, reduced = {0};
    RITZ_OWN(ritz_measures) measures = {0};

    RITZ_CHECK(model_read(run, run->operand[0], MODEL_DYNAMIC, &full));
    RITZ_CHECK(model_read(
        run, path, MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES, &reduced));
    RITZ_CHECK(settle_configurations(run, &full, &reduced, &given->model));
    RITZ_CHECK(model_refuse_forces(&reduced, path));
    RITZ_CHECK(check_limits(run, given, reduced.kind == MODEL_STATES));
    RITZ_CHECK(reduced.kind == MODEL_STATES
                   ? settle_states(run, &full, &reduced, given)
                   : settle_matrices(run, &full, &reduced, given));
    RITZ_CHECK_IN(path,
                  ritz_verify(model_reference(&full), model_reference(&reduced),
                              &given->verify, &measures));
    if (reduced.kind != MODEL_STATES)
        RITZ_CHECK(say_buckling(run, &full, &reduced));
    RITZ_CHECK(take_apart(run, given, &reduced));
    return keep_measures(run, given, &measures, &reduced);
}
