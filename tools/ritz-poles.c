/* ritz-poles - damped poles, and what dampers make of them. */
#include "print/dampers.h"
#include "print/describe.h"
#include "print/nested.h"
#include "print/poles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Poles of a large component that are listed where nothing is asked for. */
enum { SOME_MODES = 20 };

typedef struct wish {
    int64_t modes, mode;
    int64_t order; /* columns of a nested component; 0: all */
    double up_to_hz;
    const char *at, *damping, *scan;
    cli_list damper;
    bool tsv;
} wish;

/* Of states, one of each pair; no shapes and so no residuals. */
static ritz_status find_states(const ritz_state_space *states,
                               ritz_spectrum *out)
{
    ritz_status status = RITZ_OK;
    ritz_spectrum found = {.engine = "dense LAPACK"};
    int64_t count = 0;

    RITZ_TRY(ritz_state_space_poles(states, &count, &found.s));
    found.residual = calloc((size_t)count + 1, sizeof *found.residual);
    RITZ_FAIL_IF(!found.residual, RITZ_ERR_MEMORY, "no memory for poles");
    for (int64_t k = 0; k < count; k++) {
        if (cimag(found.s[k]) < 0.0)
            continue;
        found.residual[found.count] = (double)NAN;
        found.s[found.count++] = found.s[k];
    }
    *out = found;
    found = (ritz_spectrum){0};
done:
    ritz_spectrum_free(&found);
    return status;
}

static ritz_status find(const model *m, const wish *asked,
                        const ritz_damping *damping, ritz_spectrum *out)
{
    const ritz_second_order view = model_look(m).matrices;
    bool by_hertz = !isnan(asked->up_to_hz);
    double limit = 6.28318530717958647692 * asked->up_to_hz * (1.0 + 1e-9);
    ritz_span span = {.modes = asked->modes > 0 ? asked->modes : SOME_MODES};

    if (by_hertz)
        span = (ritz_span){.modes = -1, .up_to_hz = asked->up_to_hz};
    if (m->kind == MODEL_COMPONENT)
        return ritz_spectrum_component(&m->component, damping, &span, out);
    RITZ_CHECK(m->kind == MODEL_STATES
                   ? find_states(&m->states, out)
                   : ritz_spectrum_dense(&view, damping, out));
    while (out->count > 0 &&
           ((asked->modes > 0 && out->count > asked->modes) ||
            (by_hertz && cabs(out->s[out->count - 1]) > limit)))
        out->count--;
    return RITZ_OK;
}

static ritz_status scan(cli_run *run, model *m, const wish *asked,
                        const ritz_damping *damping)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order view = model_look(m).matrices;
    const ritz_dampers *dampers = dampers_of(m);
    poles_scan wanted = {0};
    ritz_scan found = {0};

    RITZ_TRY(poles_scan_parse(asked->scan, dampers, &wanted));
    wanted.request.mode = asked->mode - 1;
    RITZ_TRY(m->kind == MODEL_COMPONENT
                 ? ritz_scan_component(&m->component, damping, &wanted.request,
                                       &found)
                 : ritz_scan_dampers(&view, dampers, damping, &wanted.request,
                                     &found));
    poles_say_scan(run, &found, asked->tsv);
done:
    free(wanted.damper);
    ritz_scan_free(&found);
    return status;
}

/* Its damping is in A, and its dampers too. */
static ritz_status check_states(const char *path, const wish *asked)
{
    RITZ_REFUSE_IF(
        asked->damping || asked->scan || asked->damper.count > 0,
        RITZ_ERR_ARGUMENT,
        "'%s' is a state space, damped as it is: --damping, --damper "
        "and --scan are not for it",
        path);
    return RITZ_OK;
}

/* Dampers installed, and the damping beside them. */
static ritz_status damp(cli_run *run, model *m, const wish *asked,
                        ritz_damping *out)
{
    const char *path = run->operand[0];
    char text[RITZ_DAMPING_SIZE] = "";

    if (m->kind == MODEL_STATES) {
        RITZ_CHECK(check_states(path, asked));
        memcpy(text, m->states.damping, sizeof text);
    } else {
        RITZ_CHECK_IN(path, dampers_install(m, &asked->damper));
        RITZ_CHECK(model_damping(m, asked->damping, out));
        ritz_damping_print(out, text);
    }
    if (!asked->tsv) {
        cli_say(run, "%s:", path);
        describe_damping(run, text);
        if (m->kind != MODEL_STATES)
            describe_dampers(run, dampers_of(m));
    }
    return RITZ_OK;
}

static ritz_status poles(cli_run *run, const wish *asked)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    model m = {0};
    ritz_damping damping = {0};
    ritz_spectrum spectrum = {0};

    RITZ_TRY(model_read(
        run, path,
        MODEL_COMPONENT | MODEL_REDUCED | MODEL_SYSTEM | MODEL_STATES, &m));
    RITZ_TRY(nested_take(path, asked->order, &m));
    RITZ_TRY(model_at(&m, path, asked->at));
    RITZ_TRY(damp(run, &m, asked, &damping));
    if (asked->scan) {
        RITZ_TRY_IN(path, scan(run, &m, asked, &damping));
    } else {
        RITZ_TRY_IN(path, find(&m, asked, &damping, &spectrum));
        poles_say(run, &spectrum, asked->tsv);
        cli_record(run, "poles", spectrum.count);
    }
    if (run->output)
        RITZ_TRY(cli_save(run, run->output));
done:
    ritz_spectrum_free(&spectrum);
    model_free(&m);
    return status;
}

int main(int argc, char **argv)
{
    wish asked = {.mode = 1, .up_to_hz = (double)NAN};
    const cli_option options[] = {
        {CLI_INT(&asked.modes), .name = "modes", .argument = "N", .min = 1,
         .max = 1e6, .help = "the lowest N [all, 20 of a component]"},
        {CLI_REAL(&asked.up_to_hz), .name = "up-to-hz", .argument = "F",
         .min = 1e-9, .max = 1e9, .help = "those of |s| up to this instead"},
        {CLI_TEXT(&asked.at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "which configuration of a system, degrees and lengths"},
        ORDER_OPTION(&asked.order),
        DAMPING_OPTION(&asked.damping),
        DAMPERS_OPTION(&asked.damper),
        {CLI_TEXT(&asked.scan), .name = "scan",
         .argument = "NAME[,NAME]=FROM:TO:STEP",
         .help = "give these dampers one c, through a range"},
        {CLI_INT(&asked.mode), .name = "mode", .argument = "K", .min = 1,
         .max = 1e6,
         .help = "follow this one in a scan, counted where it begins"},
        {CLI_FLAG(&asked.tsv), .name = "tsv",
         .help = "columns divided by tabs, ratios as numbers"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-poles",
        .operands = {{"FILE",
                      "a component, reduced component, system or state space",
                      false}},
        .summary = "Damped poles: frequency |s|/2pi and damping ratio of each, "
                   "and the best c of dampers.",
        .example = "ritz-poles chain.h5 --damper top=150*-200 --scan "
                   "top,middle=0:1000:10 --mode 2",
        .options = options,
        .output = "write the text there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (asked.modes > 0 && !isnan(asked.up_to_hz))
        cli_refuse(&program, "--modes and --up-to-hz are two ways to say the "
                             "same");
    return cli_finish(&run, poles(&run, &asked));
}
