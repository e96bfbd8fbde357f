/*
 * The second stage of a scene: which modes it selects, its static corrections,
 * and what becomes of extraneous modes.
 */
#include "base/alloc.h"
#include "scene/scene_parts.h"

#include <ritz/ranking.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_MODES = 10000, /* listed, each held against all before it */
    MOST_VECTORS = 10000,
};

enum { BY, SELECT_TOLERANCE, MODES, VECTORS, START, NUM_SELECT_KEYS };

static const char starts[][8] = {"inputs", "both"};

static const ritz_yaml_key select_keys[NUM_SELECT_KEYS] = {
    [BY] = {.name = "by"},
    [SELECT_TOLERANCE] = {"tolerance", false, RITZ_YAML_FRACTION,
                          .offset = offsetof(ritz_scene, select_tolerance)},
    [MODES] = {.name = "modes"},
    [VECTORS] = {"vectors", false, RITZ_YAML_WHOLE,
                 .offset = offsetof(ritz_scene, select_vectors), .least = 1,
                 .most = MOST_VECTORS,
                 .before = "1 to 10000 Krylov vectors can be made, not "},
    [START] = {"start", false, RITZ_YAML_WORD,
               RITZ_YAML_FIELD(ritz_scene, select_outputs),
               RITZ_YAML_WORDS("start", starts)},
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

/* Insert mode `number` into the ascending list of modes. */
static ritz_status insert_mode(const ritz_yaml *yaml, const yaml_node_t *node,
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
        RITZ_CHECK(insert_mode(yaml, item, number - 1, scene));
    }
    scene->select = RITZ_SELECT_LISTED;
    return RITZ_OK;
}

/* Most keys belong to one way of selecting modes. */
static ritz_status check_selection(const ritz_yaml *yaml,
                                   const yaml_node_t *node,
                                   const yaml_node_t *const *value,
                                   const ritz_scene *scene)
{
    bool krylov = scene->select == RITZ_SELECT_KRYLOV;

    RITZ_REFUSE_AT(value[MODES] && value[BY], yaml, value[BY],
                   "modes are chosen by a list or by something, not both");
    RITZ_REFUSE_AT(
        value[SELECT_TOLERANCE] && scene->select != RITZ_SELECT_RANKED, yaml,
        value[SELECT_TOLERANCE], "a tolerance goes with a ranking alone");
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
    const yaml_node_t *value[NUM_SELECT_KEYS] = {0};

    if (!node)
        return RITZ_OK;
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_SELECT_KEYS, select_keys,
                                 scene, value));
    if (value[BY])
        RITZ_CHECK(take_by(yaml, value[BY], scene));
    if (value[MODES] && !value[BY])
        RITZ_CHECK(take_modes(yaml, value[MODES], scene));
    return check_selection(yaml, node, value, scene);
}

/* ---- static corrections ------------------------------------------------- */

enum { LEVEL, ATTACHED, AUGMENT_TOLERANCE, NUM_AUGMENT_KEYS };

static const char levels[][16] = {
    [RITZ_AUGMENT_NONE] = "none",
    [RITZ_AUGMENT_SYSTEM] = "system",
    [RITZ_AUGMENT_COMPONENT] = "component",
};

static const ritz_yaml_key augment_keys[NUM_AUGMENT_KEYS] = {
    [LEVEL] = {"level", true, RITZ_YAML_WORD,
               RITZ_YAML_FIELD(ritz_scene, augment),
               RITZ_YAML_WORDS("augmentation", levels)},
    [ATTACHED] = {.name = "attached"},
    [AUGMENT_TOLERANCE] = {"tolerance", false, RITZ_YAML_FRACTION,
                           .offset = offsetof(ritz_scene, attached_tolerance)},
};

/* Sets of forces, in the order of their bits; names of inputs follow. */
static const char sets[][RITZ_NAME_SIZE] = {"inputs", "interface", "outputs"};
enum { NUM_SETS = sizeof sets / sizeof *sets };

static ritz_status take_attached(const ritz_yaml *yaml, const yaml_node_t *node,
                                 ritz_scene *scene)
{
    const int64_t num_words = NUM_SETS + scene->num_inputs;
    RITZ_OWN_ARRAY char(*words)[RITZ_NAME_SIZE] = NULL;
    RITZ_OWN_ARRAY bool *taken = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0, yaml, node,
                   "nothing is attached: 'augment: none' says so");
    RITZ_CHECK_NEW(words, num_words);
    memcpy(words, sets, sizeof sets); /* then the names of inputs */
    for (int64_t j = 0; j < scene->num_inputs; j++)
        memcpy(words[NUM_SETS + j], scene->input[j].name, RITZ_NAME_SIZE);
    RITZ_CHECK_NEW(taken, num_words);
    RITZ_CHECK_NEW(scene->attached_input, scene->num_inputs);
    for (int64_t k = 0; k < count; k++) {
        const ritz_names names = {"attached set", num_words, words[0],
                                  sizeof *words};
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        int64_t at = 0;

        RITZ_CHECK(ritz_yaml_word(yaml, item, &names, &at));
        RITZ_REFUSE_AT(taken[at], yaml, item, "'%s' is listed before",
                       words[at]);
        taken[at] = true;
        if (at < NUM_SETS)
            scene->attached |= 1 << at;
        else
            scene->attached_input[scene->num_attached_inputs++] = at - NUM_SETS;
    }
    return RITZ_OK;
}

/* The word 'auto', or a list of sets. */
static ritz_status take_sets(const ritz_yaml *yaml, const yaml_node_t *node,
                             ritz_scene *scene)
{
    static const char words[][8] = {"auto"};
    const ritz_names names = {"choice of attached dofs", 1, words[0],
                              sizeof *words};
    int64_t at = 0;

    if (node->type != YAML_SCALAR_NODE)
        return take_attached(yaml, node, scene);
    RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    scene->attached = RITZ_ATTACHED_AUTO;
    return RITZ_OK;
}

static ritz_status check_augmentation(const ritz_yaml *yaml,
                                      const yaml_node_t *const *value,
                                      const ritz_scene *scene)
{
    bool automatic = scene->attached == RITZ_ATTACHED_AUTO;

    RITZ_REFUSE_AT(scene->augment == RITZ_AUGMENT_NONE && value[ATTACHED], yaml,
                   value[ATTACHED],
                   "nothing is attached where nothing is "
                   "augmented");
    RITZ_REFUSE_AT(scene->augment == RITZ_AUGMENT_SYSTEM &&
                       (scene->attached & RITZ_ATTACHED_INTERFACE),
                   yaml, value[ATTACHED],
                   "in a system the forces at an interface cancel: attach "
                   "'interface' with 'level: component'");
    RITZ_REFUSE_AT(value[AUGMENT_TOLERANCE] && !automatic, yaml,
                   value[AUGMENT_TOLERANCE],
                   "a tolerance goes with 'attached: auto' alone");
    RITZ_REFUSE_AT(automatic &&
                       (scene->num_inputs == 0 || scene->num_outputs == 0 ||
                        !(scene->band_hz[1] > 0.0)),
                   yaml, value[ATTACHED],
                   "attached dofs are chosen by frequency responses, which "
                   "need inputs, outputs and 'band_hz'");
    return RITZ_OK;
}

ritz_status ritz_scene_augment(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_scene *scene)
{
    const yaml_node_t *value[NUM_AUGMENT_KEYS] = {0};

    if (!node)
        return RITZ_OK;
    if (node->type == YAML_SCALAR_NODE)
        return ritz_yaml_value(yaml, node, &augment_keys[LEVEL], scene);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_AUGMENT_KEYS, augment_keys,
                                 scene, value));
    if (value[ATTACHED])
        RITZ_CHECK(take_sets(yaml, value[ATTACHED], scene));
    return check_augmentation(yaml, value, scene);
}

ritz_status ritz_scene_extraneous(const ritz_yaml *yaml,
                                  const yaml_node_t *node, ritz_scene *scene)
{
    const char *text = NULL;

    if (!node)
        return RITZ_OK;
    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    return ritz_yaml_at(yaml, node, ritz_scene_set_extraneous(scene, text));
}

ritz_status ritz_scene_set_extraneous(ritz_scene *scene, const char *word)
{
    static const char words[][16] = {
        [RITZ_EXTRANEOUS_KEEP] = "keep",
        [RITZ_EXTRANEOUS_REMOVE] = "remove",
        [RITZ_EXTRANEOUS_OUT_OF_BAND] = "out-of-band",
    };
    const ritz_names names = {"fate of extraneous modes", 3, words[0],
                              sizeof *words};
    int64_t at = 0;

    RITZ_CHECK(ritz_words_find(&names, word, &at));
    RITZ_REFUSE_IF(at == RITZ_EXTRANEOUS_OUT_OF_BAND &&
                       !(scene->band_hz[1] > 0.0),
                   RITZ_ERR_ARGUMENT,
                   "what lies out of the band is to be removed and there is no "
                   "'band_hz'");
    RITZ_REFUSE_IF(at != RITZ_EXTRANEOUS_KEEP &&
                       scene->select == RITZ_SELECT_KRYLOV,
                   RITZ_ERR_ARGUMENT,
                   "Krylov vectors keep moments, not modes, so no mode is "
                   "extraneous");
    scene->extraneous = (ritz_extraneous)at;
    return RITZ_OK;
}
