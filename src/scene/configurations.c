/*
 * Configurations of a scene: those listed, or all combinations of settings. A
 * row holds one setting for each sweep, NaN while it has none.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "scene/yaml.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void clear_row(const ritz_scene *scene, double *row)
{
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        row[k] = nan("");
}

ritz_status ritz_scene_sweep(const ritz_scene *scene, const char *name,
                             int64_t *out)
{
    const ritz_names sweeps = {"joint", scene->num_sweeps,
                               (const char *)scene->sweep,
                               sizeof *scene->sweep};
    const ritz_names joints = {"joint", scene->num_joints,
                               (const char *)scene->joint,
                               sizeof *scene->joint};
    const int64_t k = ritz_names_index(&sweeps, name);

    RITZ_REFUSE_IF(k < 0 && ritz_names_index(&joints, name) >= 0,
                   RITZ_ERR_ARGUMENT,
                   "joint '%s' has nothing to set: only hinges, sliders and "
                   "universal joints have",
                   name);
    if (k < 0)
        return ritz_words_find(&sweeps, name, out);
    *out = k;
    return RITZ_OK;
}

/* Put a setting in a row, once; the sweep is named "clock" or "wrist.2". */
static ritz_status set_in_row(const ritz_scene *scene, const char *name,
                              double setting, double *row)
{
    int64_t k = 0;

    RITZ_CHECK(ritz_scene_sweep(scene, name, &k));
    RITZ_REFUSE_IF(!isnan(row[k]), RITZ_ERR_ARGUMENT,
                   "joint '%s' is given twice", name);
    row[k] = setting;
    return RITZ_OK;
}

/* A sweep with one setting alone need not be given. */
static ritz_status fill_row(const ritz_scene *scene, double *row)
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

/* The row of {clock: 60, slide: 0.5}. */
static ritz_status read_row(const ritz_yaml *yaml, const yaml_node_t *node,
                            const ritz_scene *scene, double *row)
{
    int64_t count = 0;

    clear_row(scene, row);
    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        const char *name = NULL;
        double setting = 0.0;

        RITZ_CHECK(ritz_yaml_text(yaml, word, &name));
        RITZ_CHECK(
            ritz_yaml_real(yaml, ritz_yaml_value_at(yaml, node, k), &setting));
        RITZ_CHECK(
            ritz_yaml_at(yaml, word, set_in_row(scene, name, setting, row)));
    }
    return ritz_yaml_at(yaml, node, fill_row(scene, row));
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
    return set_in_row(scene, text, setting, row);
}

ritz_status ritz_scene_settings(const ritz_scene *scene, const char *at,
                                double *setting)
{
    RITZ_OWN_ARRAY double *row = NULL;

    RITZ_CHECK_NEW(row, scene->num_sweeps);
    clear_row(scene, row);
    for (const char *part = *at ? at : NULL; part;) {
        size_t length = strcspn(part, ",");

        RITZ_CHECK(set_part(scene, part, length, row));
        part = part[length] ? part + length + 1 : NULL;
    }
    RITZ_CHECK(fill_row(scene, row));
    if (scene->num_sweeps > 0)
        memcpy(setting, row, (size_t)scene->num_sweeps * sizeof *row);
    return RITZ_OK;
}

/* ---- configurations ------------------------------------------------------ */

typedef struct sorted_row {
    const double *val;
    int64_t n;
    int64_t index;
} sorted_row;

static int compare_values(const sorted_row *a, const sorted_row *b)
{
    for (int64_t j = 0; j < a->n; j++)
        if (a->val[j] != b->val[j])
            return a->val[j] < b->val[j] ? -1 : 1;
    return 0;
}

static int compare_rows(const void *left, const void *right)
{
    const sorted_row *a = left;
    const sorted_row *b = right;
    int order = compare_values(a, b);

    return order ? order : (a->index > b->index) - (a->index < b->index);
}

ritz_status ritz_rows_repeated(int64_t count, int64_t n, const double *val,
                               int64_t *out)
{
    RITZ_OWN_ARRAY sorted_row *row = NULL;
    int64_t first = -1;

    RITZ_CHECK_NEW(row, count);
    for (int64_t k = 0; k < count; k++)
        row[k] = (sorted_row){val + k * n, n, k};
    qsort(row, (size_t)count, sizeof *row, compare_rows);
    for (int64_t k = 1; k < count; k++)
        if (compare_values(&row[k - 1], &row[k]) == 0 &&
            (first < 0 || row[k].index < first))
            first = row[k].index;
    *out = first;
    return RITZ_OK;
}

/* Allocate `count` rows, if that is not too many. */
static ritz_status new_settings(const ritz_yaml *yaml, const yaml_node_t *node,
                                double count, ritz_scene *scene)
{
    int64_t n = scene->num_sweeps;

    RITZ_REFUSE_AT(count > RITZ_MOST_CONFIGURATIONS ||
                       count * (double)n > RITZ_MOST_SETTINGS,
                   yaml, node,
                   "%.6g configurations of %" PRId64
                   " settings are too many: list those wanted under "
                   "'configurations'",
                   count, n);
    RITZ_CHECK_NEW(scene->setting, (int64_t)count * n);
    scene->num_configurations = (int64_t)count;
    return RITZ_OK;
}

/* All combinations: row c counts with a digit a sweep, the last fastest. */
static ritz_status combine_settings(const ritz_yaml *yaml, ritz_scene *scene)
{
    int64_t n = scene->num_sweeps;
    double count = 1.0;

    for (int64_t k = 0; k < n; k++)
        count *= (double)scene->sweep[k].count;
    RITZ_CHECK(new_settings(yaml, ritz_yaml_root(yaml), count, scene));
    for (int64_t c = 0; c < scene->num_configurations; c++) {
        int64_t rest = c;

        for (int64_t k = n - 1; k >= 0; k--) {
            const ritz_sweep *sweep = &scene->sweep[k];

            scene->setting[c * n + k] = sweep->setting[rest % sweep->count];
            rest /= sweep->count;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_scene_configurations(const ritz_yaml *yaml,
                                      const yaml_node_t *node,
                                      ritz_scene *scene)
{
    int64_t n = scene->num_sweeps;
    int64_t count = 0;
    int64_t again = -1;

    if (!node)
        return combine_settings(yaml, scene);
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0, yaml, node,
                   "no configuration is listed; without 'configurations' every "
                   "combination of settings is one");
    RITZ_CHECK(new_settings(yaml, node, (double)count, scene));
    for (int64_t c = 0; c < count; c++)
        RITZ_CHECK(read_row(yaml, ritz_yaml_item(yaml, node, c), scene,
                            scene->setting + c * n));
    RITZ_CHECK(ritz_rows_repeated(count, n, scene->setting, &again));
    RITZ_REFUSE_AT(again >= 0, yaml, ritz_yaml_item(yaml, node, again),
                   "this configuration is listed before");
    return RITZ_OK;
}

static bool rows_agree(int64_t n, const double *a, const double *b)
{
    for (int64_t k = 0; k < n; k++)
        if (!(fabs(a[k] - b[k]) <= RITZ_SAME))
            return false;
    return true;
}

/* The configuration of the scene that a reference names, not named before. */
static ritz_status find_reference(const ritz_yaml *yaml,
                                  const yaml_node_t *node, double *row,
                                  ritz_scene *scene)
{
    int64_t n = scene->num_sweeps;
    int64_t c = 0;

    RITZ_CHECK(read_row(yaml, node, scene, row));
    while (c < scene->num_configurations &&
           !rows_agree(n, row, scene->setting + c * n))
        c++;
    RITZ_REFUSE_AT(c == scene->num_configurations, yaml, node,
                   "this is none of the scene's configurations");
    for (int64_t k = 0; k < scene->num_reference; k++)
        RITZ_REFUSE_AT(scene->reference[k] == c, yaml, node,
                       "this reference is listed before");
    scene->reference[scene->num_reference++] = c;
    return RITZ_OK;
}

static ritz_status read_reference(const ritz_yaml *yaml,
                                  const yaml_node_t *node, ritz_scene *scene)
{
    RITZ_OWN_ARRAY double *row = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0 || count > RITZ_MOST_REFERENCES, yaml, node,
                   "1 to %d references can be listed, not %" PRId64,
                   RITZ_MOST_REFERENCES, count);
    RITZ_CHECK_NEW(row, scene->num_sweeps);
    RITZ_CHECK_NEW(scene->reference, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(
            find_reference(yaml, ritz_yaml_item(yaml, node, k), row, scene));
    return RITZ_OK;
}

enum { TOLERANCE, REFERENCE, NUM_KEYS };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [TOLERANCE] = {"tolerance", false, RITZ_YAML_FRACTION,
                   .offset = offsetof(ritz_scene, composite_tolerance)},
    [REFERENCE] = {.name = "reference"},
};

ritz_status ritz_scene_composite(const ritz_yaml *yaml, const yaml_node_t *node,
                                 ritz_scene *scene)
{
    static const char words[][8] = {"union"};
    ritz_names names = {"composite", 1, words[0], sizeof *words};
    const yaml_node_t *value[NUM_KEYS] = {0};
    int64_t at = 0;

    if (node && node->type == YAML_SCALAR_NODE)
        RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    else if (node)
        RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, scene, value));
    if (value[REFERENCE])
        RITZ_CHECK(read_reference(yaml, value[REFERENCE], scene));
    return RITZ_OK;
}
