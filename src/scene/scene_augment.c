/* Static corrections of a scene's second stage, and its extraneous modes. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVEL, ATTACHED, TOLERANCE, NUM_KEYS };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [LEVEL] = {"level", true, NULL, 0},
    [ATTACHED] = {"attached", false, NULL, 0},
    [TOLERANCE] = {"tolerance", false, ritz_yaml_fraction,
                   offsetof(ritz_scene, attached_tolerance)},
};

static ritz_status take_level(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    static const char words[][16] = {
        [RITZ_AUGMENT_NONE] = "none",
        [RITZ_AUGMENT_SYSTEM] = "system",
        [RITZ_AUGMENT_COMPONENT] = "component",
    };
    const ritz_names names = {"augmentation", 3, words[0], sizeof *words};
    int64_t at = 0;

    RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    scene->augment = (ritz_augment)at;
    return RITZ_OK;
}

/* Sets of forces, in the order of their bits; names of inputs follow. */
static const char sets[][RITZ_NAME_SIZE] = {"inputs", "interface", "outputs"};
enum { NUM_SETS = sizeof sets / sizeof *sets };

/* Words that may stand under 'attached'. */
static ritz_status list_words(const ritz_scene *scene,
                              char (**out)[RITZ_NAME_SIZE])
{
    char(*words)[RITZ_NAME_SIZE] = NULL;

    RITZ_CHECK_NEW(words, NUM_SETS + scene->num_inputs);
    memcpy(words, sets, sizeof sets);
    for (int64_t j = 0; j < scene->num_inputs; j++)
        memcpy(words[NUM_SETS + j], scene->input[j].name, RITZ_NAME_SIZE);
    *out = words;
    return RITZ_OK;
}

static ritz_status take_attached(const ritz_yaml *yaml, const yaml_node_t *node,
                                 ritz_scene *scene)
{
    ritz_status status = RITZ_OK;
    char(*words)[RITZ_NAME_SIZE] = NULL;
    bool *taken = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_yaml_list(yaml, node, &count));
    RITZ_YAML_FAIL_IF(count == 0, yaml, node,
                      "nothing is attached: 'augment: none' says so");
    RITZ_TRY(list_words(scene, &words));
    RITZ_NEW(taken, NUM_SETS + scene->num_inputs);
    RITZ_NEW(scene->attached_input, scene->num_inputs);
    for (int64_t k = 0; k < count; k++) {
        const ritz_names names = {"attached set", NUM_SETS + scene->num_inputs,
                                  words[0], sizeof *words};
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        int64_t at = 0;

        RITZ_TRY(ritz_yaml_word(yaml, item, &names, &at));
        RITZ_YAML_FAIL_IF(taken[at], yaml, item, "'%s' is listed before",
                          words[at]);
        taken[at] = true;
        if (at < NUM_SETS)
            scene->attached |= 1 << at;
        else
            scene->attached_input[scene->num_attached_inputs++] = at - NUM_SETS;
    }
done:
    free(words);
    free(taken);
    return status;
}

/* A word, 'auto', or a list. */
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

static ritz_status check(const ritz_yaml *yaml, const yaml_node_t *const *value,
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
    RITZ_REFUSE_AT(value[TOLERANCE] && !automatic, yaml, value[TOLERANCE],
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
    const yaml_node_t *value[NUM_KEYS] = {0};

    if (!node)
        return RITZ_OK;
    if (node->type == YAML_SCALAR_NODE)
        return take_level(yaml, node, scene);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, scene, value));
    RITZ_CHECK(take_level(yaml, value[LEVEL], scene));
    if (value[ATTACHED])
        RITZ_CHECK(take_sets(yaml, value[ATTACHED], scene));
    return check(yaml, value, scene);
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
