/* Configurations of a scene: those listed, or every combination of settings. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Settings are the same within this; of angles up to 360 it is 2e4 ulp. */
static const double same_setting = 1e-9;

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
    ritz_status status = RITZ_OK;
    sorted_row *row = NULL;
    int64_t first = -1;

    RITZ_NEW(row, count);
    for (int64_t k = 0; k < count; k++)
        row[k] = (sorted_row){val + k * n, n, k};
    qsort(row, (size_t)count, sizeof *row, compare_rows);
    for (int64_t k = 1; k < count; k++)
        if (compare_values(&row[k - 1], &row[k]) == 0 &&
            (first < 0 || row[k].index < first))
            first = row[k].index;
    *out = first;
done:
    free(row);
    return status;
}

/* Room for `count` rows, if so many can be. */
static ritz_status make_room(const ritz_yaml *yaml, const yaml_node_t *node,
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

/* Row c counts with one digit for each sweep, the last one fastest. */
static ritz_status combine(const ritz_yaml *yaml, ritz_scene *scene)
{
    int64_t n = scene->num_sweeps;
    double count = 1.0;

    for (int64_t k = 0; k < n; k++)
        count *= (double)scene->sweep[k].count;
    RITZ_CHECK(make_room(yaml, ritz_yaml_root(yaml), count, scene));
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
        return combine(yaml, scene);
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0, yaml, node,
                   "no configuration is listed; without 'configurations' every "
                   "combination of settings is one");
    RITZ_CHECK(make_room(yaml, node, (double)count, scene));
    for (int64_t c = 0; c < count; c++)
        RITZ_CHECK(ritz_scene_row_read(yaml, ritz_yaml_item(yaml, node, c),
                                       scene, scene->setting + c * n));
    RITZ_CHECK(ritz_rows_repeated(count, n, scene->setting, &again));
    RITZ_REFUSE_AT(again >= 0, yaml, ritz_yaml_item(yaml, node, again),
                   "this configuration is listed before");
    return RITZ_OK;
}

static bool rows_agree(int64_t n, const double *a, const double *b)
{
    for (int64_t k = 0; k < n; k++)
        if (!(fabs(a[k] - b[k]) <= same_setting))
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

    RITZ_CHECK(ritz_scene_row_read(yaml, node, scene, row));
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
    ritz_status status = RITZ_OK;
    double *row = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_yaml_list(yaml, node, &count));
    RITZ_YAML_FAIL_IF(count == 0 || count > RITZ_MOST_REFERENCES, yaml, node,
                      "1 to %d references can be listed, not %" PRId64,
                      RITZ_MOST_REFERENCES, count);
    RITZ_NEW(row, scene->num_sweeps);
    RITZ_NEW(scene->reference, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(
            find_reference(yaml, ritz_yaml_item(yaml, node, k), row, scene));
done:
    free(row);
    return status;
}

enum { TOLERANCE, REFERENCE, NUM_KEYS };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [TOLERANCE] = {"tolerance", false, ritz_yaml_fraction,
                   offsetof(ritz_scene, composite_tolerance)},
    [REFERENCE] = {"reference", false, NULL, 0},
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
