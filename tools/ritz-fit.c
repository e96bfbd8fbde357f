/* ritz-fit - the smallest model that meets a tolerance. */
#include "cli/words.h"
#include "print/dampers.h"
#include "print/fit.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_METHODS = 64, NUM_OWN = 14 };

/* What the command line asks beside the tolerance. */
typedef struct asked {
    ritz_fit_request request;
    const ritz_method *method[MOST_METHODS];
    const char *tolerance, *band, *methods, *damping, *prefix, *report;
    cli_list damper;
    bool all;
    int64_t order; /* of --all; 0: the answer's */
    int64_t seed;
    fit_files files;                 /* that an answer makes */
    const ritz_component *component; /* NULL: of a scene */
} asked;

/* "craig-bampton,rubin", or "all" there are. */
static void read_methods(const cli_program *program, const char *text, asked *a)
{
    char word[RITZ_NAME_SIZE];
    ritz_fit_request *request = &a->request;

    request->methods = a->method;
    for (int k = 0; strcmp(text, "all") == 0 && ritz_methods[k]; k++)
        a->method[request->num_methods++] = ritz_methods[k];
    if (request->num_methods > 0)
        a->method[request->num_methods++] = &ritz_fit_compare;
    for (const char *at = request->num_methods > 0 ? NULL : text; at;) {
        size_t length = strcspn(at, ",");
        const ritz_method *found = NULL;

        snprintf(word, sizeof word, "%.*s", (int)(length < 60 ? length : 60),
                 at);
        found = ritz_fit_method_find(word);
        if (!found)
            cli_refuse(program, "%s", ritz_error_message());
        if (request->num_methods == MOST_METHODS)
            cli_refuse(program, "--methods takes %d methods, not more",
                       (int)MOST_METHODS);
        a->method[request->num_methods++] = found;
        at = at[length] ? at + length + 1 : NULL;
    }
}

/* Equal order: all methods once more, at one number of columns. */
static ritz_status contest(cli_run *run, const asked *a, ritz_fitter *fitter,
                           ritz_fit *fit)
{
    ritz_status status = RITZ_OK;
    int64_t order = a->order;
    int64_t *equal = NULL;

    if (!a->all)
        return RITZ_OK;
    RITZ_FAIL_IF(order == 0 && fit->chosen < 0, RITZ_ERR_ARGUMENT,
                 "%s: say at which --order methods are to be compared",
                 fit->why);
    if (order == 0)
        order = fit->candidate[fit->chosen].order;
    equal = calloc((size_t)fit->num_methods + 1, sizeof *equal);
    RITZ_FAIL_IF(!equal, RITZ_ERR_MEMORY, "no memory for a table");
    RITZ_TRY(ritz_fitter_equal(fitter, order, fit, equal));
    fit_say_all(run, fit, order, equal);
done:
    free(equal);
    return status;
}

static ritz_status write_component(cli_run *run, ritz_fitter *fitter,
                                   const ritz_fit_candidate *chosen)
{
    ritz_status status = RITZ_OK;
    ritz_reduced reduced = {0};
    ritz_stamp stamp = cli_stamp(run);

    RITZ_TRY(ritz_fitter_reduced(fitter, chosen, &reduced));
    RITZ_TRY(ritz_container_write_reduced(run->output, &reduced, &stamp));
done:
    ritz_reduced_free(&reduced);
    return status;
}

/* What inputs and outputs see was held to the tolerance, what other bodies feel
   at a port was not, unless the method keeps ports. */
static void warn_of_ports(cli_run *run, const ritz_component *component,
                          const ritz_fit_candidate *chosen)
{
    if (!component || component->num_ports == 0 ||
        chosen->method->uses & RITZ_USES_ATTACHED)
        return;
    cli_warn(run,
             "%s keeps nothing for port '%s': the tolerance was held against "
             "inputs and outputs alone. Where other bodies are joined to it, "
             "fit their scene, or name --methods that keep ports",
             chosen->method->name, component->port[0].name);
}

/* Search, say, record, write; nothing is written if nothing is found. */
static ritz_status answer(cli_run *run, const asked *a, fit_run *recorder,
                          const ritz_scene *scene, ritz_fitter *fitter)
{
    ritz_status status = RITZ_OK;
    ritz_fit fit = {0};
    const ritz_fit_candidate *chosen = NULL;

    recorder->limits = ritz_fitter_tolerance(fitter);
    RITZ_TRY(ritz_fitter_search(fitter, &fit));
    fit_say(run, fitter, &fit);
    RITZ_TRY(contest(run, a, fitter, &fit));
    RITZ_FAIL_IF(fit.chosen < 0, RITZ_ERR_CONVERGENCE, "%s", fit.why);
    chosen = &fit.candidate[fit.chosen];
    if (fit.runner_up >= 0)
        fit_record(recorder, &fit.candidate[fit.runner_up],
                   (fit_mark){.runner_up = true});
    fit_record(recorder, chosen, (fit_mark){.chosen = true, .why = fit.why});
    RITZ_TRY(recorder->recorded);
    warn_of_ports(run, a->component, chosen);
    if (run->output || a->prefix)
        RITZ_TRY(scene ? fit_write_scene(run, a->prefix, scene, fitter, chosen)
                       : write_component(run, fitter, chosen));
    if (a->report)
        RITZ_TRY(cli_save(run, a->report));
done:
    if (status != RITZ_OK)
        fit_files_discard(&a->files);
    ritz_fit_free(&fit);
    return status;
}

/* The name of the file without folder and ending, as charts call it. */
static void name_subject(const char *path, char out[RITZ_NAME_SIZE])
{
    const char *slash = strrchr(path, '/');

    snprintf(out, RITZ_NAME_SIZE, "%s", slash ? slash + 1 : path);
    if (strrchr(out, '.'))
        *strrchr(out, '.') = '\0';
}

static ritz_status fit(cli_run *run, asked *a)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    char subject[RITZ_NAME_SIZE];
    fit_run recorder = {.run = run, .subject = subject};
    ritz_fitter *fitter = NULL;
    ritz_scene scene = {0};
    model full = {0};

    a->request.observe = fit_observe;
    a->request.thorough = a->all;
    a->request.context = &recorder;
    name_subject(path, subject);
    if (a->damping)
        RITZ_TRY_IN(
            "--damping",
            ritz_damping_parse(a->damping, &a->request.tolerance.damping));
    if (ritz_container_is(path)) {
        RITZ_FAIL_IF(a->prefix, RITZ_ERR_ARGUMENT,
                     "'%s' is a component: --components is for scenes", path);
        RITZ_TRY(model_read(run, path, MODEL_COMPONENT, &full));
        RITZ_TRY_IN(path, dampers_tune(&full, &a->damper));
        RITZ_TRY(fit_files_foresee(run, NULL, a->report, NULL, &a->files));
        a->component = &full.component;
        RITZ_TRY_IN(path,
                    ritz_fitter_new(&full.component, &a->request, &fitter));
        RITZ_TRY(answer(run, a, &recorder, NULL, fitter));
        goto done;
    }
    RITZ_FAIL_IF(a->damper.count > 0 || a->request.attach, RITZ_ERR_ARGUMENT,
                 "'%s' is a scene: --damper and --attach are for components",
                 path);
    RITZ_TRY(model_scene(run, path, &scene));
    RITZ_TRY(fit_files_foresee(run, a->prefix, a->report, &scene, &a->files));
    if (*scene.name)
        snprintf(subject, sizeof subject, "%s", scene.name);
    RITZ_TRY_IN(path, ritz_fitter_scene(&scene, &a->request, &fitter));
    RITZ_TRY(answer(run, a, &recorder, &scene, fitter));
done:
    ritz_fitter_free(&fitter);
    fit_files_free(&a->files);
    ritz_scene_free(&scene);
    model_free(&full);
    return status;
}

/* "frequency, mac (least), missing (modes)" */
static const char *tolerance_help(void)
{
    static char help[1024];
    size_t used = 0;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (kind->word && kind->of_modes)
            used += (size_t)snprintf(help + used, sizeof help - used,
                                     "%s%s%s%s%s%s", used > 0 ? ", " : "",
                                     kind->word,
                                     kind->large_is_good ? " (least)" : "",
                                     kind->unit[0] ? " (" : "", kind->unit,
                                     kind->unit[0] ? ")" : "");
    }
    snprintf(help + used, sizeof help - used,
             "; a number alone is of the response");
    return help;
}

/* What --help lists first. */
static void own_options(asked *a, cli_option options[NUM_OWN])
{
    ritz_fit_request *r = &a->request;
    const cli_option own[NUM_OWN] = {
        {CLI_TEXT(&a->tolerance), .name = "tolerance",
         .argument = "[MEASURE=]X[,MEASURE=X]", .help = tolerance_help()},
        {CLI_TEXT(&a->band), .name = "band-hz", .argument = "F,F",
         .help = "where it is to hold [the scene's]"},
        DAMPERS_OPTION(&a->damper),
        {CLI_TEXT(&a->methods), .name = "methods", .argument = "M[,M]",
         .help = "which, or all; of a scene compare too [those of second "
                 "order with a number of modes]"},
        {CLI_TEXT(&r->attach), .name = "attach", .argument = "PORT[,PORT]",
         .help = "of a component: keep the dofs of these ports [all]"},
        {CLI_INT(&r->largest), .name = "largest", .argument = "N", .min = 1,
         .max = 100000, .help = "try no order above [what the band suggests]"},
        {CLI_INT(&r->num_random), .name = "confirm", .argument = "N", .min = 0,
         .max = 1000000,
         .help = "random frequencies at which an answer is confirmed"},
        {CLI_INT(&r->num_between), .name = "between", .argument = "N", .min = 0,
         .max = 1000, .help = "random configurations at which it is confirmed"},
        {CLI_INT(&a->seed), .name = "seed", .argument = "N", .min = 0,
         .max = 1e15, .help = "of those"},
        {CLI_FLAG(&a->all), .name = "all",
         .help = "compare all methods at equal error and at equal order"},
        {CLI_INT(&a->order), .name = "order", .argument = "N", .min = 1,
         .max = 100000, .help = "that equal order [the answer's]"},
        {CLI_TEXT(&a->prefix), .name = "components", .argument = "PREFIX",
         .help = "of a scene: write the reduced components too, as "
                 "PREFIXname.h5"},
        {CLI_TEXT(&a->report), .name = "report", .argument = "FILE",
         .help = "write the report there too"},
        DAMPING_OPTION(&a->damping),
    };

    memcpy(options, own, sizeof own);
}

int main(int argc, char **argv)
{
    asked a = {.request = RITZ_FIT_NONE, .seed = 1};
    ritz_fit_request *r = &a.request;
    words choice = {0};
    cli_option options[NUM_OWN + WORDS_MOST + 1] = {0};
    const cli_program program = {
        .name = "ritz-fit",
        .operands = {{"INPUT", "a scene (YAML) or a component", false}},
        .summary = "Find the smallest model, over methods and orders, that "
                   "meets a tolerance in a band;\nconfirm it at random "
                   "frequencies and configurations; say why it is that one.",
        .example = "ritz-fit blade.h5 --tolerance response=1e-2,frequency=1e-3 "
                   "--band-hz 0,50 -o small.h5",
        .options = options,
        .output = "the nested reduced component, or the system of a scene",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    own_options(&a, options);
    words_add(&choice, RITZ_USES_DAMPING | RITZ_USES_BAND, options + NUM_OWN);
    cli_parse(&program, argc, argv, &run);
    if (!a.tolerance)
        cli_refuse(&program, "--tolerance says what is to hold");
    if (ritz_tolerance_take(a.tolerance, &r->tolerance) != RITZ_OK)
        cli_refuse(&program, "--tolerance: %s", ritz_error_message());
    if (a.band)
        cli_pair(&program, "band-hz", a.band, r->tolerance.band_hz);
    if (a.methods)
        read_methods(&program, a.methods, &a);
    words_take(&program, &choice, &r->choice);
    r->seed = (uint64_t)a.seed;
    return cli_finish(&run, fit(&run, &a));
}
