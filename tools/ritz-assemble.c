/* ritz-assemble - the components of a scene joined at its configurations. */
#include "base/alloc.h"
#include "print/print.h"

#include <ritz/assembly.h>

#include <stdlib.h>

/* NULL: not given. */
typedef struct assemble_options {
    const char *at, *tracks, *prefix;
    bool full;
} assemble_options;

static ritz_status system_of(cli_run *run, const ritz_scene *scene,
                             const assemble_options *given)
{
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(model) made = {.kind = MODEL_SYSTEM};

    RITZ_CHECK(model_foresee_bodies(given->prefix, scene));
    RITZ_CHECK(ritz_stage_new(scene, &stage));
    if (!given->at)
        RITZ_CHECK(model_foresee(run, &stage));
    RITZ_CHECK(ritz_assemble(&stage, given->at, &made.system));
    RITZ_CHECK(model_write_bodies(run, given->prefix, scene, stage.body));
    RITZ_CHECK(describe_output(run, &made));
    settings_say(run, scene, made.system.units, NULL);
    RITZ_CHECK(spin_say(run, &stage, &made.system.configuration[0]));
    RITZ_CHECK(
        given->at
            ? axes_say(run, &stage, 1, made.system.configuration[0].setting)
            : axes_say(run, &stage, scene->num_configurations, scene->setting));
    describe_remarks(run, scene, stage.body);
    RITZ_CHECK(tracks_report(run, &stage, &made.system, given->tracks));
    cli_record(run, "assemble", made.system.configuration[0].K.nrow);
    return RITZ_OK;
}

static ritz_status full_of(cli_run *run, const ritz_scene *scene,
                           const char *at)
{
    RITZ_OWN(model) full = {.kind = MODEL_COMPONENT};
    RITZ_OWN_ARRAY double *setting =
        calloc((size_t)scene->num_sweeps + 1, sizeof *setting);

    RITZ_REFUSE_IF(!setting, RITZ_ERR_MEMORY, "no memory for settings");
    RITZ_CHECK_IN("--at", ritz_scene_settings(scene, at ? at : "", setting));
    RITZ_CHECK(ritz_assemble_full(scene, setting, &full.component, NULL));
    RITZ_CHECK(describe_output(run, &full));
    RITZ_CHECK(axes_say_full(run, scene, setting));
    cli_record(run, "full", full.component.num_dofs);
    return RITZ_OK;
}

static ritz_status assemble_scene(cli_run *run, const assemble_options *given)
{
    RITZ_OWN(ritz_scene) scene = {0};

    RITZ_CHECK(model_scene(run, run->operand[0], &scene));
    RITZ_REFUSE_IF(scene.spin.given &&
                       scene.spin.rate.course != RITZ_SPIN_CONSTANT,
                   RITZ_ERR_ARGUMENT,
                   "%s:%ld:%ld: a rate of spin that changes is for "
                   "ritz-simulate; a system has one 'rate'",
                   scene.path, scene.spin.line, scene.spin.column);
    return given->full ? full_of(run, &scene, given->at)
                       : system_of(run, &scene, given);
}

int main(int argc, char **argv)
{
    assemble_options given = {0};
    const cli_option options[] = {
        CLI_TEXT("at", &given.at, "JOINT=SETTING[,JOINT=SETTING]",
                 "one configuration, in degrees and lengths [all of the "
                 "scene's]"),
        CLI_FLAG("full", &given.full,
                 "reduce nothing: make one component with the dofs of all "
                 "bodies"),
        CLI_TEXT("components", &given.prefix, "PREFIX",
                 "write the reduced components as PREFIXname.h5"),
        CLI_OUTPUT("tracks", &given.tracks, "FILE",
                   "write which mode is which at each configuration, as a "
                   "table with tabs"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-assemble",
        .operands = {{"SCENE", "scene file (YAML)", false}},
        .summary = "Join the components of a scene, each reduced as the scene "
                   "says, at its configurations.",
        .example = "ritz-assemble scene.yaml --at clock=60,cone=0 -o at60.h5",
        .output = "the system; with --full a component",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    if (given.full && given.tracks)
        cli_refuse(&program, "--full makes one component, whose modes are not "
                             "followed by --tracks");
    if (given.full && given.prefix)
        cli_refuse(&program, "--full reduces no component, there are none to "
                             "write by --components");
    return cli_finish(&run, assemble_scene(&run, &given));
}
