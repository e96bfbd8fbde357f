/* Inputs and outputs of a scene. */
#include "scene/scene_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static ritz_status take_component(const ritz_yaml *yaml,
                                  const yaml_node_t *node, void *field)
{
    int64_t component = 0;

    RITZ_CHECK(ritz_yaml_whole(yaml, node, &component));
    RITZ_REFUSE_AT(component < 1 || component > 6, yaml, node,
                   "component %" PRId64 " is none of 1-3, along the axes, and "
                   "4-6, about them",
                   component);
    *(int64_t *)field = component;
    return RITZ_OK;
}

/* One direction, or a list of directions in which a force acts at once. */
static ritz_status take_directions(const ritz_yaml *yaml,
                                   const yaml_node_t *node, ritz_scene_io *io)
{
    int64_t count = 0;

    if (node->type != YAML_SEQUENCE_NODE)
        return take_component(yaml, node, &io->component);
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < 1 || count > 6, yaml, node,
                   "1 to 6 directions can be listed, not %" PRId64, count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        int64_t *into = k == 0 ? &io->component : &io->also[k - 1];

        RITZ_CHECK(take_component(yaml, item, into));
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
        return take_component(yaml, value[COMPONENT], &io->component);
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
