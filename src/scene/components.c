/* Components of a scene, and COMPONENT/PORT, as joints and inputs name it. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_scene_count(const ritz_yaml *yaml, const yaml_node_t *node,
                             int64_t *count)
{
    RITZ_CHECK(ritz_yaml_list(yaml, node, count));
    RITZ_REFUSE_AT(*count > RITZ_MOST_PARTS, yaml, node,
                   "%" PRId64 " items are too many, %d can be", *count,
                   RITZ_MOST_PARTS);
    return RITZ_OK;
}

/* Item k of a list of ports, which must differ from those before it. */
static ritz_status read_port(const ritz_yaml *yaml, const yaml_node_t *list,
                             int64_t k, const char *before,
                             char port[RITZ_NAME_SIZE])
{
    const yaml_node_t *node = ritz_yaml_item(yaml, list, k);
    ritz_names taken = {"port", k, before, RITZ_NAME_SIZE};

    RITZ_CHECK(ritz_yaml_name(yaml, node, port));
    RITZ_REFUSE_AT(strchr(port, ','), yaml, node,
                   "'%s' holds a comma, a port cannot", port);
    RITZ_REFUSE_AT(ritz_names_index(&taken, port) >= 0, yaml, node,
                   "port '%s' is listed twice", port);
    return RITZ_OK;
}

/* [bearing, scan] is kept as "bearing,scan". */
static ritz_status take_attach(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    RITZ_OWN_ARRAY char(*port)[RITZ_NAME_SIZE] = NULL;
    char **out = (char **)field;
    char *end = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_scene_count(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0, yaml, node,
                   "no port is listed; without 'attach' those that joints and "
                   "inputs use are attached");
    RITZ_CHECK_NEW(port, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(read_port(yaml, node, k, port[0], port[k]));
    RITZ_CHECK_NEW(*out, count * RITZ_NAME_SIZE);
    end = *out;
    for (int64_t k = 0; k < count; k++)
        end += sprintf(end, "%s%s", k > 0 ? "," : "", port[k]);
    return RITZ_OK;
}

enum { MODEL, BASIS, ORDER, MODES, UP_TO, ATTACH, NUM_KEYS, MOST_KEYS = 32 };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [MODEL] = {"model", true, RITZ_YAML_TEXT,
               .offset = offsetof(ritz_scene_component, model)},
    [BASIS] = {"basis", false, RITZ_YAML_NAME,
               .offset = offsetof(ritz_scene_component, basis)},
    [ORDER] = {"order", false, RITZ_YAML_WHOLE,
               .offset = offsetof(ritz_scene_component, order), .least = 1,
               .most = INT64_MAX, .after = " columns are no model"},
    [MODES] = {"modes", false, RITZ_YAML_WHOLE,
               .offset = offsetof(ritz_scene_component, modes),
               .most = INT64_MAX, .after = " modes cannot be kept"},
    [UP_TO] = {"up_to_hz", false, RITZ_YAML_POSITIVE,
               .offset = offsetof(ritz_scene_component, up_to_hz)},
    [ATTACH] = {"attach", false, RITZ_YAML_BY_HAND,
                .offset = offsetof(ritz_scene_component, attach),
                .take = take_attach},
};

/* [0, 5] is taken as "0,5", a scalar as it is. */
static ritz_status take_choice(const ritz_yaml *yaml, const yaml_node_t *node,
                               const ritz_choice_word *word,
                               ritz_choice *choice)
{
    bool scalar = node->type == YAML_SCALAR_NODE;
    char text[1024] = "";
    int64_t count = 1;
    size_t used = 0;

    if (!scalar)
        RITZ_CHECK(ritz_scene_count(yaml, node, &count));
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = scalar ? node : ritz_yaml_item(yaml, node, k);
        const char *part = NULL;

        RITZ_CHECK(ritz_yaml_text(yaml, item, &part));
        RITZ_REFUSE_AT(used + strlen(part) + 2 > sizeof text, yaml, item,
                       "the list of '%s' is too long", word->key);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                 k > 0 ? "," : "", part);
    }
    return ritz_yaml_at(yaml, node, ritz_choice_take(word, text, choice));
}

/* The keys above, then the words of a choice. */
static int64_t list_keys(ritz_yaml_key all[MOST_KEYS])
{
    int64_t count = NUM_KEYS;

    memcpy(all, keys, sizeof keys);
    for (const ritz_choice_word *word = ritz_choice_words; word->key; word++) {
        all[count] = (ritz_yaml_key){0};
        snprintf(all[count].name, sizeof all[count].name, "%s", word->key);
        count++;
    }
    return count;
}

static ritz_status read_component(const ritz_yaml *yaml,
                                  const yaml_node_t *word,
                                  const yaml_node_t *node,
                                  ritz_scene_component *out)
{
    const yaml_node_t *value[MOST_KEYS];
    ritz_yaml_key all[MOST_KEYS];
    int64_t count = list_keys(all);

    out->modes = -1;
    ritz_yaml_locate(word, &out->line, &out->column);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, count, all, out, value));
    RITZ_REFUSE_AT(value[MODES] && value[UP_TO], yaml, value[UP_TO],
                   "'modes' and 'up_to_hz' are both given, one decides");
    RITZ_REFUSE_AT(value[ORDER] && value[BASIS], yaml, value[ORDER],
                   "'order' is how much of a model that is reduced already to "
                   "take, and a 'basis' reduces one");
    for (int64_t k = MODES; k < count; k++)
        RITZ_REFUSE_AT(value[k] && !value[BASIS], yaml, value[k],
                       "'%s' says how to reduce, which needs a 'basis' too",
                       all[k].name);
    for (int64_t k = NUM_KEYS; k < count; k++)
        if (value[k])
            RITZ_CHECK(take_choice(yaml, value[k],
                                   &ritz_choice_words[k - NUM_KEYS],
                                   &out->choice));
    return RITZ_OK;
}

ritz_status ritz_scene_components(const ritz_yaml *yaml,
                                  const yaml_node_t *node, ritz_scene *scene)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0 || count > RITZ_MOST_PARTS, yaml, node,
                   "a scene has 1 to %d components, not %" PRId64,
                   RITZ_MOST_PARTS, count);
    RITZ_CHECK_NEW(scene->component, count);
    scene->num_components = count;
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        ritz_scene_component *component = &scene->component[k];

        RITZ_CHECK(ritz_yaml_name(yaml, word, component->name));
        RITZ_CHECK(ritz_yaml_distinct(yaml, word, "component", k,
                                      scene->component, sizeof *component));
        RITZ_CHECK(read_component(yaml, word, ritz_yaml_value_at(yaml, node, k),
                                  component));
    }
    return RITZ_OK;
}

ritz_status ritz_scene_place_read(const ritz_yaml *yaml,
                                  const yaml_node_t *node,
                                  const ritz_scene *scene,
                                  ritz_scene_place *out)
{
    ritz_names components = {"component", scene->num_components,
                             scene->component->name, sizeof *scene->component};
    const char *text = NULL;
    const char *slash = NULL;
    char component[RITZ_NAME_SIZE] = "";
    char cut[RITZ_SHORT_SIZE];

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    slash = strchr(text, '/');
    RITZ_REFUSE_AT(
        !slash || slash == text || slash - text >= RITZ_NAME_SIZE || !slash[1],
        yaml, node, "'%s' is not COMPONENT/PORT, such as rotor/bearing",
        ritz_text_short(text, cut));
    memcpy(component, text, (size_t)(slash - text));
    RITZ_CHECK(ritz_yaml_at(
        yaml, node, ritz_words_find(&components, component, &out->component)));
    return ritz_yaml_at(yaml, node, ritz_name_copy(slash + 1, out->port));
}
