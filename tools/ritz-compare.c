/* ritz-compare - two-stage reduction of a scene over all configurations. */
#include "print/comparison.h"
#include "print/tracks.h"

#include <string.h>

enum { MOST_TOLERANCES = 64 };

/* PREFIX and the component's name, of each body of the second stage. */
static ritz_status write_bodies(cli_run *run, const char *prefix,
                                const ritz_comparison *comparison)
{
    const ritz_stage *stage = &comparison->second;
    ritz_stamp stamp = cli_stamp(run);
    json_t *files = json_array();

    json_object_set_new(run->report, "component_files", files);
    for (int64_t k = 0; prefix && k < stage->count; k++) {
        char path[4096];
        int length = snprintf(path, sizeof path, "%s%s.h5", prefix,
                              stage->scene->component[k].name);

        RITZ_REFUSE_IF(length < 0 || length >= (int)sizeof path,
                       RITZ_ERR_ARGUMENT, "--components '%.40s...' is too long",
                       prefix);
        RITZ_CHECK(ritz_container_write_reduced(path, &stage->body[k], &stamp));
        json_array_append_new(files, cli_string(path));
    }
    return RITZ_OK;
}

/* What the command line asks beside the scene. */
typedef struct compare_options {
    const char *prefix, *report, *tracks, *extraneous, *tolerance_table;
    int64_t num_tolerances;
    double tolerance[MOST_TOLERANCES];
} compare_options;

/* "1e-12,1e-6" */
static void read_tolerances(const cli_program *program, const char *text,
                            compare_options *a)
{
    char word[64];

    for (const char *at = text; at;) {
        size_t length = strcspn(at, ",");
        double *into = &a->tolerance[a->num_tolerances];

        if (a->num_tolerances == MOST_TOLERANCES)
            cli_refuse(program, "--tolerances takes %d numbers, not more",
                       (int)MOST_TOLERANCES);
        snprintf(word, sizeof word, "%.*s", (int)(length < 63 ? length : 63),
                 at);
        if (!ritz_text_real(word, into) || !(*into > 0.0 && *into < 1.0))
            cli_refuse(program,
                       "--tolerances takes numbers between 0 and 1, not '%s'",
                       word);
        a->num_tolerances++;
        at = at[length] ? at + length + 1 : NULL;
    }
}

/* The chart of the composite tolerance. */
static ritz_status chart(cli_run *run, const compare_options *a,
                         const ritz_stage *stage,
                         const ritz_comparison *comparison)
{
    ritz_status status = RITZ_OK;
    ritz_tolerance_row *rows = NULL;

    if (a->num_tolerances == 0)
        return RITZ_OK;
    RITZ_TRY_IN("tolerances",
                ritz_compare_tolerances(stage, comparison, a->num_tolerances,
                                        a->tolerance, &rows));
    comparison_say_tolerances(run, stage, a->num_tolerances, rows);
    if (a->tolerance_table)
        RITZ_TRY(comparison_write_tolerances(a->tolerance_table, stage,
                                             a->num_tolerances, rows));
done:
    ritz_tolerances_free(a->num_tolerances, &rows);
    return status;
}

static ritz_status compare(cli_run *run, const compare_options *a)
{
    ritz_status status = RITZ_OK;
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison comparison = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(model_scene(run, run->operand[0], &scene));
    if (a->extraneous)
        RITZ_TRY_IN("--extraneous",
                    ritz_scene_set_extraneous(&scene, a->extraneous));
    RITZ_TRY(ritz_stage_new(&scene, &stage));
    RITZ_TRY(ritz_compare(&stage, &comparison));
    RITZ_TRY(write_bodies(run, a->prefix, &comparison));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_system(run->output, &comparison.second_system,
                                         &stamp));
    RITZ_TRY(comparison_say(run, &stage, &comparison));
    RITZ_TRY(tracks_report(run, &stage, &comparison.first_system, a->tracks));
    RITZ_TRY(chart(run, a, &stage, &comparison));
    if (a->report)
        RITZ_TRY(cli_save(run, a->report));
done:
    ritz_comparison_free(&comparison);
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
    return status;
}

int main(int argc, char **argv)
{
    compare_options a = {0};
    const char *tolerances = NULL;
    const cli_option options[] = {
        {CLI_TEXT(&a.prefix), .name = "components", .argument = "PREFIX",
         .help = "write the reduced components too, as PREFIXname.h5"},
        {CLI_TEXT(&a.report), .name = "report", .argument = "FILE",
         .help = "write the report there too"},
        {CLI_TEXT(&a.extraneous), .name = "extraneous", .argument = "WORD",
         .help = "modes of the system that stand for no kept one: keep, "
                 "remove, out-of-band [the scene's]"},
        {CLI_TEXT(&a.tracks), .name = "tracks", .argument = "FILE",
         .help = "write which mode of stage 1 is which at every "
                 "configuration, as a table with tabs"},
        {CLI_TEXT(&tolerances), .name = "tolerances", .argument = "X[,X]",
         .help = "chart composite tolerances against orders and errors"},
        {CLI_TEXT(&a.tolerance_table), .name = "tolerance-table",
         .argument = "FILE",
         .help = "write that chart as a table with tabs [tolerances 1e-12 to "
                 "1e-2]"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-compare",
        .operands = {{"SCENE", "scene file (YAML)", false}},
        .summary = "Reduce the components of an articulated system in two "
                   "stages so that the important\nsystem modes are kept at "
                   "every configuration of the scene [LeeTsuha1992]; report "
                   "what\nwas reduced, how far, and how wrong it is.",
        .example = "ritz-compare scene.yaml --components small- --report "
                   "report.txt -o system.h5",
        .options = options,
        .output = "the system of the second stage",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (a.tolerance_table && !tolerances)
        tolerances = "1e-12,1e-10,1e-8,1e-6,1e-5,1e-4,1e-3,1e-2";
    if (tolerances)
        read_tolerances(&program, tolerances, &a);
    return cli_finish(&run, compare(&run, &a));
}
