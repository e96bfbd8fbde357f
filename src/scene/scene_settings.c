/* Settings of the joints: a row holds one a sweep, NaN while it has none. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_scene_row_clear(const ritz_scene *scene, double *row)
{
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        row[k] = nan("");
}

/* Index of a sweep; a joint with nothing to set has a sentence of its own. */
static ritz_status find_sweep(const ritz_scene *scene, const char *name,
                              int64_t *out)
{
    const ritz_names sweeps = {"joint", scene->num_sweeps,
                               (const char *)scene->sweep,
                               sizeof *scene->sweep};
    const ritz_names joints = {"joint", scene->num_joints,
                               (const char *)scene->joint,
                               sizeof *scene->joint};

    *out = ritz_names_index(&sweeps, name);
    if (*out >= 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(ritz_names_index(&joints, name) >= 0, RITZ_ERR_ARGUMENT,
                   "joint '%s' has nothing to set", name);
    return ritz_words_find(&sweeps, name, out);
}

ritz_status ritz_scene_row_set(const ritz_scene *scene, const char *name,
                               double setting, double *row)
{
    int64_t k = 0;

    RITZ_CHECK(find_sweep(scene, name, &k));
    RITZ_REFUSE_IF(!isnan(row[k]), RITZ_ERR_ARGUMENT,
                   "joint '%s' is given twice", name);
    row[k] = setting;
    return RITZ_OK;
}

ritz_status ritz_scene_row_fill(const ritz_scene *scene, double *row)
{
    for (int64_t k = 0; k < scene->num_sweeps; k++) {
        const ritz_sweep *sweep = &scene->sweep[k];

        RITZ_REFUSE_IF(isnan(row[k]) && sweep->count > 1, RITZ_ERR_ARGUMENT,
                       "joint '%s' has several settings and none is given here",
                       sweep->name);
        if (isnan(row[k]))
            row[k] = sweep->setting[0];
    }
    return RITZ_OK;
}

ritz_status ritz_scene_row_read(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_scene *scene, double *row)
{
    int64_t count = 0;

    ritz_scene_row_clear(scene, row);
    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        const char *name = NULL;
        double setting = 0.0;

        RITZ_CHECK(ritz_yaml_text(yaml, word, &name));
        RITZ_CHECK(
            ritz_yaml_real(yaml, ritz_yaml_value_at(yaml, node, k), &setting));
        RITZ_CHECK(ritz_yaml_at(yaml, word,
                                ritz_scene_row_set(scene, name, setting, row)));
    }
    return ritz_yaml_at(yaml, node, ritz_scene_row_fill(scene, row));
}

/* One "clock=60" of a text, `length` letters long. */
static ritz_status set_part(const ritz_scene *scene, const char *part,
                            size_t length, double *row)
{
    char text[2 * RITZ_NAME_SIZE] = "";
    char cut[RITZ_SHORT_SIZE];
    char *equals = NULL;
    double setting = 0.0;

    memcpy(text, part, length < sizeof text ? length : sizeof text - 1);
    equals = strchr(text, '=');
    RITZ_REFUSE_IF(length >= sizeof text || !equals || equals == text,
                   RITZ_ERR_ARGUMENT, "'%s' is not JOINT=SETTING",
                   ritz_text_short(text, cut));
    *equals = '\0';
    RITZ_REFUSE_IF(!ritz_text_real(equals + 1, &setting), RITZ_ERR_ARGUMENT,
                   "'%s' of joint '%s' is not a finite number",
                   ritz_text_short(equals + 1, cut), text);
    return ritz_scene_row_set(scene, text, setting, row);
}

ritz_status ritz_scene_settings(const ritz_scene *scene, const char *at,
                                double *setting)
{
    ritz_status status = RITZ_OK;
    double *row = NULL;

    RITZ_NEW(row, scene->num_sweeps);
    ritz_scene_row_clear(scene, row);
    for (const char *part = *at ? at : NULL; part;) {
        size_t length = strcspn(part, ",");

        RITZ_TRY(set_part(scene, part, length, row));
        part = part[length] ? part + length + 1 : NULL;
    }
    RITZ_TRY(ritz_scene_row_fill(scene, row));
    if (scene->num_sweeps > 0)
        memcpy(setting, row, (size_t)scene->num_sweeps * sizeof *row);
done:
    free(row);
    return status;
}
