/* ritz-verify - full against reduced: every error, pass or fail. */
#include "print/dampers.h"
#include "print/nested.h"

#include <math.h>

typedef struct wish {
    ritz_verify_request verify;
    const char *damping, *at;
    int64_t order; /* columns of a nested component; 0: all */
    cli_list damper;
} wish;

/* Where the errors of what is verified stand. */
static ritz_measures *place_of(model *reduced)
{
    if (reduced->kind == MODEL_STATES)
        return &reduced->states.errors;
    return reduced->at ? &reduced->at->errors : &reduced->reduced.errors;
}

/* Measures, which are moved, into the object that is written. */
static void keep(cli_run *run, ritz_measures *measures, ritz_measures *place)
{
    ritz_measures_free(place);
    *place = *measures;
    *measures = (ritz_measures){0};
    for (int64_t k = 0; k < place->count; k++)
        cli_record_error(run, place->item[k].name, place->item[k].value);
}

static ritz_status measure(cli_run *run, const model *full, model *reduced,
                           const ritz_verify_request *request)
{
    ritz_status status = RITZ_OK;
    ritz_measures measures = {0};

    RITZ_TRY(reduced->at
                 ? ritz_verify_system(&full->component, reduced->at, request,
                                      &measures)
                 : ritz_verify_reduced(&full->component, &reduced->reduced,
                                       request, &measures));
    keep(run, &measures, place_of(reduced));
done:
    ritz_measures_free(&measures);
    return status;
}

static ritz_status write(cli_run *run, const model *reduced)
{
    ritz_stamp stamp = cli_stamp(run);

    if (reduced->kind == MODEL_STATES)
        return ritz_container_write_state_space(run->output, &reduced->states,
                                                &stamp);
    if (reduced->at)
        return ritz_container_write_system(run->output, &reduced->system,
                                           &stamp);
    return ritz_container_write_reduced(run->output, &reduced->reduced, &stamp);
}

static ritz_status judge(cli_run *run, const ritz_measures *measures)
{
    const ritz_measure *first = NULL;
    int64_t failed = 0;
    int64_t asked = 0;

    model_say_measures(run, "measures", measures, "measured");
    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *m = &measures->item[k];

        asked += !isnan(m->limit);
        if (ritz_measure_holds(m))
            continue;
        first = first ? first : m;
        failed++;
    }
    RITZ_REFUSE_IF(first, RITZ_ERR_CONVERGENCE,
                   "'%s': %lld of %lld limits not met, first '%s', %.3e where "
                   "%.3e is asked",
                   run->operand[1], (long long)failed, (long long)asked,
                   first->name, first->value, first->limit);
    return RITZ_OK;
}

static ritz_status check_limits(const cli_run *run, const wish *asked,
                                bool states)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        RITZ_REFUSE_IF(!isnan(asked->verify.limit[k]) &&
                           (states ? !kind->of_states : !kind->of_modes),
                       RITZ_ERR_ARGUMENT,
                       "'%s' is %s state space, --limit-%s is not for it",
                       run->operand[1], states ? "a" : "no", kind->word);
    }
    return RITZ_OK;
}

/* A limit of what is not there is met, and nothing was compared. */
static void say_unmeasured(cli_run *run, const wish *asked,
                           const ritz_measures *measures)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (isnan(asked->verify.limit[k]) ||
            ritz_measures_find(measures, kind->name) ||
            (kind->other && ritz_measures_find(measures, kind->other)))
            continue;
        cli_warn(run, "--limit-%s: nothing of '%s' is there to be compared",
                 kind->word, run->operand[1]);
    }
}

/* The full model as states: as it is, or a component that is small enough. */
static ritz_status full_states(const cli_run *run, model *full,
                               const model *reduced, const wish *asked)
{
    const char *path = run->operand[0];
    const char *own = asked->damping;
    ritz_damping damping = {0};

    RITZ_REFUSE_IF(asked->damper.count > 0, RITZ_ERR_ARGUMENT,
                   "'%s' holds its dampers in A: --damper cannot change them",
                   run->operand[1]);
    RITZ_REFUSE_IF(full->kind == MODEL_STATES && own, RITZ_ERR_ARGUMENT,
                   "'%s' is damped as it is: --damping is for components",
                   path);
    if (full->kind == MODEL_STATES)
        return RITZ_OK;
    RITZ_REFUSE_IF(
        full->component.num_dofs > RITZ_STATE_DOFS, RITZ_ERR_ARGUMENT,
        "'%s' has %lld dofs, of more than %d no norms are taken: "
        "compare the responses that ritz-frf gives of both",
        path, (long long)full->component.num_dofs, (int)RITZ_STATE_DOFS);
    RITZ_CHECK_IN(
        own ? "--damping" : run->operand[1],
        ritz_damping_parse(own ? own : reduced->states.damping, &damping));
    RITZ_CHECK_IN(path, ritz_state_space_of_component(&full->component,
                                                      &damping, &full->states));
    return RITZ_OK;
}

static ritz_status verify_states(cli_run *run, model *full, model *reduced,
                                 const wish *asked)
{
    ritz_status status = RITZ_OK;
    ritz_measures measures = {0};

    cli_record(run, reduced->states.origin.method, reduced->states.A.nrow);
    RITZ_TRY(full_states(run, full, reduced, asked));
    RITZ_TRY_IN(run->operand[1],
                ritz_verify_states(&full->states, &reduced->states,
                                   &asked->verify, &measures));
    keep(run, &measures, place_of(reduced));
    RITZ_TRY(write(run, reduced));
    say_unmeasured(run, asked, place_of(reduced));
    RITZ_TRY(judge(run, place_of(reduced)));
done:
    ritz_measures_free(&measures);
    return status;
}

static ritz_status verify(cli_run *run, wish *asked)
{
    ritz_status status = RITZ_OK;
    model full = {0};
    model reduced = {0};
    dampers_bare bare = {0};
    const char *own = asked->damping;

    RITZ_TRY(model_read(run, run->operand[0], MODEL_COMPONENT | MODEL_STATES,
                        &full));
    RITZ_TRY(model_read(run, run->operand[1],
                        MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES, &reduced));
    RITZ_TRY(nested_take(run->operand[1], asked->order, &reduced));
    RITZ_TRY(model_at(&reduced, run->operand[1], asked->at));
    RITZ_TRY(check_limits(run, asked, reduced.kind == MODEL_STATES));
    if (reduced.kind == MODEL_STATES) {
        RITZ_TRY(verify_states(run, &full, &reduced, asked));
        goto done;
    }
    RITZ_FAIL_IF(full.kind == MODEL_STATES, RITZ_ERR_ARGUMENT,
                 "'%s' is a state space and '%s' is none: there is nothing to "
                 "compare by",
                 run->operand[0], run->operand[1]);
    RITZ_TRY(model_damping(&reduced, own, &asked->verify.damping));
    if (reduced.at && !(asked->verify.band_hz[1] > 0.0)) {
        asked->verify.band_hz[0] = reduced.system.band_hz[0];
        asked->verify.band_hz[1] = reduced.system.band_hz[1];
    }
    cli_record(run, reduced.at ? "system" : reduced.reduced.origin.method,
               model_look(&reduced).matrices.K->nrow);
    RITZ_TRY_IN(run->operand[0], dampers_install(&full, &asked->damper));
    RITZ_TRY_IN(run->operand[1], dampers_tune(&reduced, &asked->damper));
    RITZ_TRY(dampers_keep(&reduced, &bare));
    RITZ_TRY(dampers_install(&reduced, NULL));
    RITZ_TRY_IN(run->operand[1], measure(run, &full, &reduced, &asked->verify));
    dampers_restore(&reduced, &bare);
    RITZ_TRY(write(run, &reduced)); /* limits met or not: it says which */
    say_unmeasured(run, asked, place_of(&reduced));
    RITZ_TRY(judge(run, place_of(&reduced)));
done:
    dampers_bare_free(&bare);
    model_free(&reduced);
    model_free(&full);
    return status;
}

enum { OWN_OPTIONS = 5 };

/* "--limit-gain": one option for each measure that takes a limit. */
static void add_limits(ritz_verify_request *request,
                       char (*name)[RITZ_NAME_SIZE], cli_option *options)
{
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (!kind->word)
            continue;
        snprintf(name[k], sizeof name[k], "limit-%s", kind->word);
        *options++ = (cli_option){CLI_REAL(&request->limit[k]),
                                  .name = name[k],
                                  .argument = "X",
                                  .min = 0.0,
                                  .max = kind->large_is_good ? 1.0 : 1e9,
                                  .help = kind->help};
    }
}

int main(int argc, char **argv)
{
    const char *band = NULL;
    wish asked = {.verify = RITZ_VERIFY_NONE};
    char name[RITZ_MEASURES][RITZ_NAME_SIZE];
    cli_option options[OWN_OPTIONS + RITZ_MEASURES + 1] = {
        {CLI_TEXT(&asked.at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "which configuration of a system, degrees and lengths"},
        {CLI_TEXT(&band), .name = "band-hz", .argument = "F,F",
         .help = "band in Hz of all measures [the scene's; else up to half the "
                 "highest reduced frequency]"},
        ORDER_OPTION(&asked.order),
        DAMPING_OPTION(&asked.damping),
        DAMPERS_OPTION(&asked.damper),
    };
    const cli_program program = {
        .name = "ritz-verify",
        .operands = {{"FULL",
                      "the full component (ritz-assemble --full of a "
                      "system) or state space",
                      false},
                     {"REDUCED", "the reduced component, system or state space",
                      false}},
        .summary = "Measure every error of a reduced model against the full "
                   "one. The output is REDUCED\nwith the errors, their limits "
                   "and verdicts added; it is written even where a limit is\n"
                   "not met (status 1), so that the file says so.",
        .example = "ritz-verify blade.h5 blade-reduced.h5 --limit-frequency "
                   "1e-3 -o blade-verified.h5",
        .options = options,
        .output = "REDUCED with its errors",
        .threads = true,
    };
    cli_run run;

    add_limits(&asked.verify, name, options + OWN_OPTIONS);
    cli_parse(&program, argc, argv, &run);
    if (band)
        cli_pair(&program, "band-hz", band, asked.verify.band_hz);
    return cli_finish(&run, verify(&run, &asked));
}
