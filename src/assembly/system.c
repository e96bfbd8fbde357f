/* A system over all configurations of a scene. */
#include "base/alloc.h"

#include <ritz/monitor.h>
#include <ritz/synthesis.h>

#include <stdlib.h>
#include <string.h>

/* Names, orders, band and damping of the scene. */
static ritz_status label(const ritz_stage *stage, ritz_system *system)
{
    const ritz_scene *scene = stage->scene;

    memcpy(system->name, scene->name, sizeof system->name);
    memcpy(system->band_hz, scene->band_hz, sizeof system->band_hz);
    ritz_damping_print(&scene->damping, system->damping);
    if (stage->count > 0)
        memcpy(system->units, stage->body[0].units, sizeof system->units);
    RITZ_CHECK_NEW(system->component, stage->count);
    RITZ_CHECK_NEW(system->order, stage->count);
    RITZ_CHECK_NEW(system->order_full, stage->count);
    system->num_components = stage->count;
    for (int64_t k = 0; k < stage->count; k++) {
        memcpy(system->component[k], scene->component[k].name, RITZ_NAME_SIZE);
        system->order[k] = stage->body[k].K.ncol;
        system->order_full[k] = stage->body[k].num_dofs;
        RITZ_REFUSE_IF(
            strcmp(stage->body[k].units, system->units) != 0, RITZ_ERR_ARGUMENT,
            "'%s' is in units '%s' and '%s' in '%s'", scene->component[0].name,
            system->units, scene->component[k].name, stage->body[k].units);
    }
    RITZ_CHECK_NEW(system->sweep, scene->num_sweeps);
    system->num_sweeps = scene->num_sweeps;
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        memcpy(system->sweep[k], scene->sweep[k].name, RITZ_NAME_SIZE);
    return RITZ_OK;
}

ritz_status ritz_assemble(const ritz_stage *stage, const char *at,
                          ritz_system *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    int64_t count = at ? 1 : scene->num_configurations;
    ritz_system system = {0};
    double *setting = NULL;

    RITZ_NEW(setting, scene->num_sweeps);
    RITZ_TRY(label(stage, &system));
    RITZ_NEW(system.configuration, count);
    for (int64_t k = 0; k < count; k++) {
        const double *row = setting;

        ritz_monitor_step("configuration", k, count);
        if (at)
            RITZ_TRY(ritz_scene_settings(scene, at, setting));
        else
            row = scene->setting + k * scene->num_sweeps;
        RITZ_TRY(ritz_stage_assemble(stage, row, &system.configuration[k]));
        system.num_configurations++;
    }
    *out = system;
    system = (ritz_system){0};
done:
    free(setting);
    ritz_system_free(&system);
    return status;
}
