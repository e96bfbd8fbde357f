/* What a scene's second stage is made from: ranked modes, a band, a list. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <ritz/ranking.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_MODES = 10000, /* listed, each held against all before it */
    MOST_VECTORS = 10000,
};

enum { BY, TOLERANCE, MODES, VECTORS, START, NUM_KEYS };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [BY] = {"by", false, NULL, 0},
    [TOLERANCE] = {"tolerance", false, ritz_yaml_fraction,
                   offsetof(ritz_scene, select_tolerance)},
    [MODES] = {"modes", false, NULL, 0},
    [VECTORS] = {"vectors", false, NULL, 0},
    [START] = {"start", false, NULL, 0},
};

static ritz_status take_by(const ritz_yaml *yaml, const yaml_node_t *node,
                           ritz_scene *scene)
{
    static const struct {
        const char *word;
        ritz_selection select;
    } others[] = {{"band", RITZ_SELECT_BAND}, {"krylov", RITZ_SELECT_KRYLOV}};
    char word[RITZ_NAME_SIZE];

    RITZ_CHECK(ritz_yaml_name(yaml, node, word));
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (strcmp(word, others[k].word) == 0) {
            scene->select = others[k].select;
            return RITZ_OK;
        }
    if (!ritz_ranker_find(word))
        RITZ_CHECK(ritz_yaml_at(yaml, node, RITZ_ERR_ARGUMENT));
    memcpy(scene->select_by, word, sizeof word);
    return RITZ_OK;
}

/* Put mode `number` where it belongs among those before it. */
static ritz_status insert(const ritz_yaml *yaml, const yaml_node_t *node,
                          int64_t number, ritz_scene *scene)
{
    int64_t *mode = scene->select_mode;
    int64_t at = scene->num_select_modes;

    while (at > 0 && mode[at - 1] > number)
        at--;
    RITZ_REFUSE_AT(at > 0 && mode[at - 1] == number, yaml, node,
                   "mode %" PRId64 " is listed before", number + 1);
    memmove(mode + at + 1, mode + at,
            (size_t)(scene->num_select_modes - at) * sizeof *mode);
    mode[at] = number;
    scene->num_select_modes++;
    return RITZ_OK;
}

static ritz_status take_modes(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0 || count > MOST_MODES, yaml, node,
                   "1 to %d modes can be listed, not %" PRId64, MOST_MODES,
                   count);
    RITZ_CHECK_NEW(scene->select_mode, count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        int64_t number = 0;

        RITZ_CHECK(ritz_yaml_whole(yaml, item, &number));
        RITZ_REFUSE_AT(number < 1, yaml, item,
                       "%" PRId64 " is no flexible mode, the first is 1",
                       number);
        RITZ_CHECK(insert(yaml, item, number - 1, scene));
    }
    scene->select = RITZ_SELECT_LISTED;
    return RITZ_OK;
}

static ritz_status take_krylov(const ritz_yaml *yaml,
                               const yaml_node_t *const *value,
                               ritz_scene *scene)
{
    static const char words[][8] = {"inputs", "both"};
    const ritz_names names = {"start", 2, words[0], sizeof *words};
    int64_t at = 0;

    RITZ_CHECK(ritz_yaml_whole(yaml, value[VECTORS], &scene->select_vectors));
    RITZ_REFUSE_AT(
        scene->select_vectors < 1 || scene->select_vectors > MOST_VECTORS, yaml,
        value[VECTORS], "1 to %d Krylov vectors can be made, not %" PRId64,
        MOST_VECTORS, scene->select_vectors);
    if (value[START])
        RITZ_CHECK(ritz_yaml_word(yaml, value[START], &names, &at));
    scene->select_outputs = at == 1;
    return RITZ_OK;
}

/* Each key says something of one way to select alone. */
static ritz_status check(const ritz_yaml *yaml, const yaml_node_t *node,
                         const yaml_node_t *const *value,
                         const ritz_scene *scene)
{
    bool krylov = scene->select == RITZ_SELECT_KRYLOV;

    RITZ_REFUSE_AT(value[MODES] && value[BY], yaml, value[BY],
                   "modes are chosen by a list or by something, not both");
    RITZ_REFUSE_AT(value[TOLERANCE] && scene->select != RITZ_SELECT_RANKED,
                   yaml, value[TOLERANCE],
                   "a tolerance goes with a ranking alone");
    RITZ_REFUSE_AT(krylov && !value[VECTORS], yaml, node,
                   "by krylov wants to know how many 'vectors'");
    RITZ_REFUSE_AT(!krylov && value[VECTORS], yaml, value[VECTORS],
                   "'vectors' goes with 'by: krylov' alone");
    RITZ_REFUSE_AT(!krylov && value[START], yaml, value[START],
                   "'start' goes with 'by: krylov' alone");
    RITZ_REFUSE_AT(krylov && scene->num_inputs == 0, yaml, node,
                   "Krylov vectors begin with what inputs do, and there are "
                   "none");
    RITZ_REFUSE_AT(scene->select == RITZ_SELECT_BAND &&
                       !(scene->band_hz[1] > 0.0),
                   yaml, node,
                   "modes are chosen by a band and there is no "
                   "'band_hz'");
    return RITZ_OK;
}

ritz_status ritz_scene_select(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    const yaml_node_t *value[NUM_KEYS] = {0};

    if (!node)
        return RITZ_OK;
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, scene, value));
    if (value[BY])
        RITZ_CHECK(take_by(yaml, value[BY], scene));
    if (value[MODES] && !value[BY])
        RITZ_CHECK(take_modes(yaml, value[MODES], scene));
    RITZ_CHECK(check(yaml, node, value, scene));
    if (scene->select == RITZ_SELECT_KRYLOV)
        RITZ_CHECK(take_krylov(yaml, value, scene));
    return RITZ_OK;
}
