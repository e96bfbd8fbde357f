/*
 * A scene as a whole: its keys in any order, then its parts in the order in
 * which they name each other.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "scene/scene_parts.h"

#include <ritz/container.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- band and damping --------------------------------------------------- */

static ritz_status take_band(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    double *band = (double *)field;

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 2, band));
    RITZ_REFUSE_AT(!(band[0] >= 0.0 && band[1] > band[0]), yaml, node,
                   "the band %g to %g Hz does not ascend from 0 or above",
                   band[0], band[1]);
    return RITZ_OK;
}

/* Forms of damping: rows of `width` numbers, from `least` to `most` of them. */
static const struct damping_form {
    ritz_damping_kind kind;
    const char *what; /* NULL: one row, without a list */
    int64_t least, most, width;
    size_t offset; /* of the numbers in ritz_damping */
} forms[] = {
    {RITZ_DAMPING_MODAL, NULL, 1, 1, 1, offsetof(ritz_damping, zeta)},
    {RITZ_DAMPING_MODES, "ratios of modes", 1, RITZ_MOST_RATIOS, 1,
     offsetof(ritz_damping, ratio)},
    {RITZ_DAMPING_BANDS, "bands", 1, RITZ_MAX_BANDS, 3,
     offsetof(ritz_damping, band)},
    {RITZ_DAMPING_RAYLEIGH, NULL, 1, 1, 2, offsetof(ritz_damping, a)},
    {RITZ_DAMPING_FIT, "points of a fit", 2, RITZ_MOST_POINTS, 2,
     offsetof(ritz_damping, point)},
};

enum { NUM_FORMS = sizeof forms / sizeof *forms };

static const ritz_yaml_key damping_keys[NUM_FORMS] = {
    {.name = "modal"},    {.name = "modes"},        {.name = "bands"},
    {.name = "rayleigh"}, {.name = "rayleigh_fit"},
};

static ritz_status read_numbers(const ritz_yaml *yaml, const yaml_node_t *node,
                                int64_t width, double *out)
{
    return width == 1 ? ritz_yaml_real(yaml, node, out)
                      : ritz_yaml_reals(yaml, node, width, out);
}

/* What is wrong with a band is said at that band. */
static ritz_status read_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                                const struct damping_form *form,
                                ritz_damping *damping)
{
    double *number = (double *)(void *)((char *)damping + form->offset);
    int64_t count = 0;

    damping->kind = form->kind;
    if (!form->what) {
        RITZ_CHECK(read_numbers(yaml, node, form->width, number));
        return ritz_yaml_at(yaml, node, ritz_damping_check(damping));
    }
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < form->least || count > form->most, yaml, node,
                   "%" PRId64 " to %" PRId64 " %s can be given, not %" PRId64,
                   form->least, form->most, form->what, count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);

        RITZ_CHECK(
            read_numbers(yaml, item, form->width, number + k * form->width));
        damping->count = k + 1;
        if (form->kind == RITZ_DAMPING_BANDS || k + 1 == count)
            RITZ_CHECK(ritz_yaml_at(
                yaml, form->kind == RITZ_DAMPING_BANDS ? item : node,
                ritz_damping_check(damping)));
    }
    if (form->kind == RITZ_DAMPING_FIT)
        ritz_damping_fit(damping);
    return RITZ_OK;
}

static ritz_status take_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                                void *field)
{
    const yaml_node_t *value[NUM_FORMS];
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    RITZ_REFUSE_AT(count != 1, yaml, node,
                   "damping is one of modal, modes, bands, rayleigh and "
                   "rayleigh_fit");
    RITZ_CHECK(
        ritz_yaml_mapping(yaml, node, NUM_FORMS, damping_keys, field, value));
    for (int k = 0; k < NUM_FORMS; k++)
        if (value[k])
            RITZ_CHECK(read_damping(yaml, value[k], &forms[k], field));
    return RITZ_OK;
}

/* ---- the whole ---------------------------------------------------------- */

enum { /* in the order in which parts name each other */
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
    [SCENE] = {"scene", true, RITZ_YAML_NAME,
               .offset = offsetof(ritz_scene, name)},
    [BAND] = {"band_hz", false, RITZ_YAML_BY_HAND,
              .offset = offsetof(ritz_scene, band_hz), .take = take_band},
    [DAMPING] = {"damping", false, RITZ_YAML_BY_HAND,
                 .offset = offsetof(ritz_scene, damping), .take = take_damping},
    [COMPONENTS] = {.name = "components", .required = true},
    [JOINTS] = {.name = "joints"},
    [CONFIGURATIONS] = {.name = "configurations"},
    [INPUTS] = {.name = "inputs"},
    [OUTPUTS] = {.name = "outputs"},
    [SELECT] = {.name = "select"},
    [COMPOSITE] = {.name = "composite"},
    [AUGMENT] = {.name = "augment"},
    [EXTRANEOUS] = {.name = "extraneous"},
};

static ritz_scene_part *const parts[NUM_KEYS] = {
    [COMPONENTS] = ritz_scene_components,
    [JOINTS] = ritz_scene_joints,
    [CONFIGURATIONS] = ritz_scene_configurations,
    [INPUTS] = ritz_scene_inputs,
    [OUTPUTS] = ritz_scene_outputs,
    [SELECT] = ritz_scene_select,
    [COMPOSITE] = ritz_scene_composite,
    [AUGMENT] = ritz_scene_augment,
    [EXTRANEOUS] = ritz_scene_extraneous,
};

ritz_status ritz_scene_parse(const char *path, const char *text,
                             ritz_scene *out)
{
    const yaml_node_t *value[NUM_KEYS];
    RITZ_OWN(ritz_yaml) yaml = {0};
    RITZ_OWN(ritz_scene)
    scene = {.source = &ritz_container_source,
             .select_by = "hankel",
             .select_tolerance = RITZ_SCENE_SELECT,
             .composite_tolerance = RITZ_NEGLIGIBLE,
             .attached_tolerance = RITZ_SCENE_ATTACHED};

    RITZ_CHECK_NEW(scene.path, (int64_t)strlen(path) + 1);
    memcpy(scene.path, path, strlen(path));
    RITZ_CHECK(ritz_yaml_load(path, text, &yaml));
    RITZ_CHECK(ritz_yaml_mapping(&yaml, ritz_yaml_root(&yaml), NUM_KEYS, keys,
                                 &scene, value));
    for (int k = 0; k < NUM_KEYS; k++)
        if (parts[k])
            RITZ_CHECK(parts[k](&yaml, value[k], &scene));
    RITZ_MOVE(*out, scene);
    return RITZ_OK;
}

/* A relative path of a model begins at the folder of the scene. */
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
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    RITZ_CHECK(ritz_text_read(path, &text));
    RITZ_CHECK(ritz_scene_parse(path, text, &scene));
    for (int64_t k = 0; k < scene.num_components; k++)
        RITZ_CHECK(place_model(path, folder, &scene.component[k].model));
    RITZ_MOVE(*out, scene);
    return RITZ_OK;
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
