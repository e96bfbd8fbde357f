/*
 * A scene as a whole: its keys in any order, then its parts in the order in
 * which they name each other.
 */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <ritz/container.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SCENE,
    COMPONENTS,
    JOINTS,
    CONFIGURATIONS,
    INPUTS,
    OUTPUTS,
    BAND,
    DAMPING,
    SELECT,
    COMPOSITE,
    AUGMENT,
    EXTRANEOUS,
    NUM_KEYS
};

static const ritz_yaml_key keys[NUM_KEYS] = {
    [SCENE] = {"scene", true, ritz_yaml_name, offsetof(ritz_scene, name)},
    [COMPONENTS] = {"components", true, NULL, 0},
    [JOINTS] = {"joints", false, NULL, 0},
    [CONFIGURATIONS] = {"configurations", false, NULL, 0},
    [INPUTS] = {"inputs", false, NULL, 0},
    [OUTPUTS] = {"outputs", false, NULL, 0},
    [BAND] = {"band_hz", false, ritz_scene_band, offsetof(ritz_scene, band_hz)},
    [DAMPING] = {"damping", false, ritz_scene_damping,
                 offsetof(ritz_scene, damping)},
    [SELECT] = {"select", false, NULL, 0},
    [COMPOSITE] = {"composite", false, NULL, 0},
    [AUGMENT] = {"augment", false, NULL, 0},
    [EXTRANEOUS] = {"extraneous", false, NULL, 0},
};

static const struct {
    int key;
    ritz_scene_part *read;
} parts[] = {
    {COMPONENTS, ritz_scene_components},
    {JOINTS, ritz_scene_joints},
    {CONFIGURATIONS, ritz_scene_configurations},
    {INPUTS, ritz_scene_inputs},
    {OUTPUTS, ritz_scene_outputs},
    {SELECT, ritz_scene_select},
    {COMPOSITE, ritz_scene_composite},
    {AUGMENT, ritz_scene_augment},
    {EXTRANEOUS, ritz_scene_extraneous},
};

ritz_status ritz_scene_parse(const char *path, const char *text,
                             ritz_scene *out)
{
    ritz_status status = RITZ_OK;
    const yaml_node_t *value[NUM_KEYS];
    ritz_yaml yaml = {0};
    ritz_scene scene = {.source = &ritz_container_source,
                        .select_by = "hankel",
                        .select_tolerance = 1e-3,
                        .composite_tolerance = 1e-12,
                        .attached_tolerance = 1e-3};

    RITZ_NEW(scene.path, (int64_t)strlen(path) + 1);
    memcpy(scene.path, path, strlen(path));
    RITZ_TRY(ritz_yaml_load(path, text, &yaml));
    RITZ_TRY(ritz_yaml_mapping(&yaml, ritz_yaml_root(&yaml), NUM_KEYS, keys,
                               &scene, value));
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        RITZ_TRY(parts[k].read(&yaml, value[parts[k].key], &scene));
    *out = scene;
    scene = (ritz_scene){0};
done:
    ritz_scene_free(&scene);
    ritz_yaml_free(&yaml);
    return status;
}

/* A relative model is found from the folder, the first letters of a path. */
static ritz_status place_model(const char *path, size_t folder, char **model)
{
    size_t length = strlen(*model);
    char *placed = NULL;

    if ((*model)[0] == '/' || folder == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(placed, (int64_t)(folder + length + 1));
    memcpy(placed, path, folder);
    memcpy(placed + folder, *model, length);
    free(*model);
    *model = placed;
    return RITZ_OK;
}

ritz_status ritz_scene_read(const char *path, ritz_scene *out)
{
    ritz_status status = RITZ_OK;
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    ritz_scene scene = {0};
    char *text = NULL;

    RITZ_TRY(ritz_text_read(path, &text));
    RITZ_TRY(ritz_scene_parse(path, text, &scene));
    for (int64_t k = 0; k < scene.num_components; k++)
        RITZ_TRY(place_model(path, folder, &scene.component[k].model));
    *out = scene;
    scene = (ritz_scene){0};
done:
    ritz_scene_free(&scene);
    free(text);
    return status;
}

ritz_status ritz_scene_context(const ritz_scene *scene, ritz_status status,
                               int64_t line, int64_t column, const char *kind,
                               const char *name)
{
    char what[512];

    snprintf(what, sizeof what, "%s:%" PRId64 ":%" PRId64 ": %s '%s'",
             scene->path, line, column, kind, name);
    return ritz_context(status, what);
}

void ritz_scene_free(ritz_scene *scene)
{
    for (int64_t k = 0; k < scene->num_components; k++) {
        free(scene->component[k].model);
        free(scene->component[k].attach);
    }
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        free(scene->sweep[k].setting);
    free(scene->path);
    free(scene->component);
    free(scene->joint);
    free(scene->sweep);
    free(scene->setting);
    free(scene->input);
    free(scene->output);
    free(scene->reference);
    free(scene->select_mode);
    free(scene->attached_input);
    *scene = (ritz_scene){0};
}
