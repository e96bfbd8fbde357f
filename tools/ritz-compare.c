/* ritz-compare - two-stage reduction of a scene over all configurations. */
#include "comparison.h"

#include <string.h>

/* PREFIX and the component's name, of each body of the second stage. */
static ritz_status write_bodies(cli_run *run, const char *prefix,
                                const ritz_comparison *comparison)
{
    ritz_status status = RITZ_OK;
    const ritz_stage *stage = &comparison->second;
    ritz_stamp stamp = cli_stamp(run);
    json_t *files = json_array();

    json_object_set_new(run->report, "component_files", files);
    for (int64_t k = 0; prefix && k < stage->count; k++) {
        char path[4096];
        int length = snprintf(path, sizeof path, "%s%s.h5", prefix,
                              stage->scene->component[k].name);

        RITZ_FAIL_IF(length < 0 || length >= (int)sizeof path,
                     RITZ_ERR_ARGUMENT, "--components '%.40s...' is too long",
                     prefix);
        RITZ_TRY(ritz_container_write_reduced(path, &stage->body[k], &stamp));
        json_array_append_new(files, cli_string(path));
    }
done:
    return status;
}

static ritz_status compare(cli_run *run, const char *prefix, const char *report)
{
    ritz_status status = RITZ_OK;
    ritz_scene scene = {0};
    ritz_stage stage = {0};
    ritz_comparison comparison = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(model_scene(run, run->operand[0], &scene));
    RITZ_TRY(ritz_stage_new(&scene, &stage));
    RITZ_TRY(ritz_compare(&stage, &comparison));
    RITZ_TRY(write_bodies(run, prefix, &comparison));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_system(run->output, &comparison.second_system,
                                         &stamp));
    RITZ_TRY(comparison_say(run, &stage, &comparison));
    if (report)
        RITZ_TRY(cli_save(run, report));
done:
    ritz_comparison_free(&comparison);
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
    return status;
}

int main(int argc, char **argv)
{
    const char *prefix = NULL;
    const char *report = NULL;
    const cli_option options[] = {
        {CLI_TEXT(&prefix), .name = "components", .argument = "PREFIX",
         .help = "write the reduced components too, as PREFIXname.h5"},
        {CLI_TEXT(&report), .name = "report", .argument = "FILE",
         .help = "write the report there too"},
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
    return cli_finish(&run, compare(&run, prefix, report));
}
