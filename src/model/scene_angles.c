/* Angles of the hinges: a row holds one for each, NaN while it has none. */
#include "model/scene_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_scene_row_clear(const ritz_scene *scene, double *row)
{
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        row[k] = (double)NAN;
}

ritz_status ritz_scene_row_set(const ritz_scene *scene, const char *joint,
                               double setting, double *row)
{
    ritz_status status = RITZ_OK;
    ritz_names joints = {"hinge", scene->num_joints, scene->joint->name,
                         sizeof *scene->joint};
    int64_t at = 0;
    int64_t k = 0;

    RITZ_TRY(ritz_words_find(&joints, joint, &at));
    RITZ_FAIL_IF(scene->joint[at].type != RITZ_JOINT_HINGE, RITZ_ERR_ARGUMENT,
                 "'%s' is a fixed joint, it has no angle", joint);
    while (scene->sweep[k] != at)
        k++;
    RITZ_FAIL_IF(!isnan(row[k]), RITZ_ERR_ARGUMENT, "hinge '%s' is given twice",
                 joint);
    row[k] = setting;
done:
    return status;
}

ritz_status ritz_scene_row_fill(const ritz_scene *scene, double *row)
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < scene->num_sweeps; k++) {
        const ritz_joint *joint = &scene->joint[scene->sweep[k]];

        RITZ_FAIL_IF(isnan(row[k]) && joint->num_settings > 1,
                     RITZ_ERR_ARGUMENT,
                     "hinge '%s' has several angles and none is given here",
                     joint->name);
        if (isnan(row[k]))
            row[k] = joint->setting[0];
    }
done:
    return status;
}

ritz_status ritz_scene_row_read(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_scene *scene, double *row)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;

    ritz_scene_row_clear(scene, row);
    RITZ_TRY(ritz_yaml_pairs(yaml, node, &count));
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        const char *joint = NULL;
        double angle = 0.0;

        RITZ_TRY(ritz_yaml_text(yaml, word, &joint));
        RITZ_TRY(
            ritz_yaml_real(yaml, ritz_yaml_value_at(yaml, node, k), &angle));
        RITZ_TRY(ritz_yaml_at(yaml, word,
                              ritz_scene_row_set(scene, joint, angle, row)));
    }
    RITZ_TRY(ritz_yaml_at(yaml, node, ritz_scene_row_fill(scene, row)));
done:
    return status;
}

/* One "clock=60" of a text, `length` letters long. */
static ritz_status set_part(const ritz_scene *scene, const char *part,
                            size_t length, double *row)
{
    ritz_status status = RITZ_OK;
    char text[2 * RITZ_NAME_SIZE] = "";
    char cut[RITZ_SHORT_SIZE];
    char *equals = NULL;
    double angle = 0.0;

    memcpy(text, part, length < sizeof text ? length : sizeof text - 1);
    equals = strchr(text, '=');
    RITZ_FAIL_IF(length >= sizeof text || !equals || equals == text,
                 RITZ_ERR_ARGUMENT, "'%s' is not JOINT=ANGLE",
                 ritz_text_short(text, cut));
    *equals = '\0';
    RITZ_FAIL_IF(!ritz_text_real(equals + 1, &angle), RITZ_ERR_ARGUMENT,
                 "'%s' of hinge '%s' is not a finite number",
                 ritz_text_short(equals + 1, cut), text);
    RITZ_TRY(ritz_scene_row_set(scene, text, angle, row));
done:
    return status;
}

ritz_status ritz_scene_angles(const ritz_scene *scene, const char *at,
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
