/*
 * Components of a scene, COMPONENT/PORT, as joints and inputs name it, and
 * inputs and outputs.
 */
#include "scene/yaml.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
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

enum {
    MODEL,
    BASIS,
    ORDER,
    STIFFENING,
    MODES,
    UP_TO,
    ATTACH,
    NUM_KEYS,
    MOST_KEYS = 32
};

static const ritz_yaml_key keys[NUM_KEYS] = {
    [MODEL] = {"model", true, RITZ_YAML_TEXT,
               .offset = offsetof(ritz_scene_component, model)},
    [BASIS] = {"basis", false, RITZ_YAML_NAME,
               .offset = offsetof(ritz_scene_component, basis)},
    [ORDER] = {"order", false, RITZ_YAML_WHOLE,
               .offset = offsetof(ritz_scene_component, order), .least = 1,
               .most = INT64_MAX, .after = " columns are no model"},
    [STIFFENING] = {"stiffening", false, RITZ_YAML_BY_HAND,
                    .offset = offsetof(ritz_scene_component, stiffening),
                    .take = ritz_scene_stiffening},
    [MODES] = {"modes", false, RITZ_YAML_WHOLE,
               .offset = offsetof(ritz_scene_component, modes),
               .most = INT64_MAX, .after = " modes cannot be kept"},
    [UP_TO] = {"up_to_hz", false, RITZ_YAML_POSITIVE,
               .offset = offsetof(ritz_scene_component, up_to_hz)},
    [ATTACH] = {"attach", false, RITZ_YAML_BY_HAND,
                .offset = offsetof(ritz_scene_component, attach),
                .take = take_attach},
};

/* [0, 5] is read as "0,5", a scalar as its text. */
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

/* ---- inputs and outputs ------------------------------------------------- */

static const ritz_yaml_key direction = {
    .kind = RITZ_YAML_WHOLE,
    .least = 1,
    .most = 6,
    .before = "component ",
    .after = " is none of 1-3, along the axes, and 4-6, about them",
};

/* One direction, or a list of directions in which a force acts at once. */
static ritz_status take_directions(const ritz_yaml *yaml,
                                   const yaml_node_t *node, ritz_scene_io *io)
{
    int64_t count = 0;

    if (node->type != YAML_SEQUENCE_NODE)
        return ritz_yaml_value(yaml, node, &direction, &io->component);
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < 1 || count > 6, yaml, node,
                   "1 to 6 directions can be listed, not %" PRId64, count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        int64_t *into = k == 0 ? &io->component : &io->also[k - 1];

        RITZ_CHECK(ritz_yaml_value(yaml, item, &direction, into));
        for (int64_t j = 0; j < k; j++)
            RITZ_REFUSE_AT(*into == (j == 0 ? io->component : io->also[j - 1]),
                           yaml, item, "direction %" PRId64 " is listed before",
                           *into);
        io->num_also = k;
    }
    return RITZ_OK;
}

static ritz_status take_scale(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    double scale = 0.0;

    RITZ_CHECK(ritz_yaml_real(yaml, node, &scale));
    RITZ_REFUSE_AT(scale == 0.0, yaml, node, "a scale of 0 leaves no input");
    *(double *)field = scale;
    return RITZ_OK;
}

static const char quantities[][16] = {"displacement", "velocity",
                                      "acceleration"};

enum { NAME, AT, COMPONENT, GRID, NUM_SHARED };
enum { NUM_INPUT_KEYS = NUM_SHARED + 2, NUM_OUTPUT_KEYS = NUM_SHARED + 2 };
enum { AGAINST = NUM_SHARED }; /* of an input */

#define SHARED_KEYS                                                            \
    [NAME] = {"name", true, RITZ_YAML_NAME,                                    \
              .offset = offsetof(ritz_scene_io, name)},                        \
    [AT] = {.name = "at", .required = true},                                   \
    [COMPONENT] = {.name = "component", .required = true},                     \
    [GRID] = {"grid",                                                          \
              false,                                                           \
              RITZ_YAML_WHOLE,                                                 \
              .offset = offsetof(ritz_scene_io, grid),                         \
              .least = 1,                                                      \
              .most = INT64_MAX,                                               \
              .after = " is no grid"}

static const ritz_yaml_key input_keys[NUM_INPUT_KEYS] = {
    SHARED_KEYS,
    [AGAINST] = {.name = "against"},
    {"scale", false, RITZ_YAML_BY_HAND,
     .offset = offsetof(ritz_scene_io, scale), .take = take_scale},
};

static const ritz_yaml_key output_keys[NUM_OUTPUT_KEYS] = {
    SHARED_KEYS,
    {"quantity", false, RITZ_YAML_WORD,
     RITZ_YAML_FIELD(ritz_scene_io, derivative),
     RITZ_YAML_WORDS("quantity", quantities)},
    {"limit", false, RITZ_YAML_POSITIVE,
     .offset = offsetof(ritz_scene_io, limit)},
};

/* How inputs and outputs differ. */
typedef struct io_side {
    const char *what;
    int64_t count;
    const ritz_yaml_key *keys;
    bool drives;
} io_side;

/* Directions, and the port that an input reacts on; outputs have one
   direction. */
static ritz_status read_force(const ritz_yaml *yaml, const io_side *side,
                              const yaml_node_t *const *value,
                              const ritz_scene *scene, ritz_scene_io *io)
{
    if (!side->drives)
        return ritz_yaml_value(yaml, value[COMPONENT], &direction,
                               &io->component);
    RITZ_CHECK(take_directions(yaml, value[COMPONENT], io));
    if (!value[AGAINST])
        return RITZ_OK;
    RITZ_CHECK(
        ritz_scene_place_read(yaml, value[AGAINST], scene, &io->against));
    RITZ_REFUSE_AT(io->against.component == io->at.component &&
                       strcmp(io->against.port, io->at.port) == 0,
                   yaml, value[AGAINST], "input '%s' acts against itself",
                   io->name);
    return RITZ_OK;
}

static ritz_status read_list(const ritz_yaml *yaml, const yaml_node_t *list,
                             const io_side *side, const ritz_scene *scene,
                             int64_t *count, ritz_scene_io **out)
{
    const yaml_node_t *value[NUM_OUTPUT_KEYS];

    if (list)
        RITZ_CHECK(ritz_scene_count(yaml, list, count));
    RITZ_CHECK_NEW(*out, *count);
    for (int64_t k = 0; k < *count; k++) {
        const yaml_node_t *node = ritz_yaml_item(yaml, list, k);
        ritz_scene_io *io = &(*out)[k];

        io->scale = 1.0;
        io->limit = (double)NAN;
        ritz_yaml_locate(node, &io->line, &io->column);
        RITZ_CHECK(
            ritz_yaml_mapping(yaml, node, side->count, side->keys, io, value));
        RITZ_CHECK(ritz_yaml_distinct(yaml, value[NAME], side->what, k, *out,
                                      sizeof *io));
        RITZ_CHECK(ritz_scene_place_read(yaml, value[AT], scene, &io->at));
        RITZ_CHECK(read_force(yaml, side, value, scene, io));
    }
    return RITZ_OK;
}

ritz_status ritz_scene_inputs(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    static const io_side inputs = {"input", NUM_INPUT_KEYS, input_keys, true};

    return read_list(yaml, node, &inputs, scene, &scene->num_inputs,
                     &scene->input);
}

ritz_status ritz_scene_outputs(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_scene *scene)
{
    static const io_side outputs = {"output", NUM_OUTPUT_KEYS, output_keys,
                                    false};

    return read_list(yaml, node, &outputs, scene, &scene->num_outputs,
                     &scene->output);
}
