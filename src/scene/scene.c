/*
 * A scene as a whole: its keys in any order, then its parts in the order in
 * which they name each other. The parts of the second stage are read here.
 */
#include "base/alloc.h"

#include "base/tolerances.h"
#include "scene/yaml.h"

#include <ritz/container.h>
#include <ritz/ranking.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- modes that the second stage selects -------------------------------- */

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

static ritz_status read_selection(const ritz_yaml *yaml,
                                  const yaml_node_t *node, ritz_scene *scene)
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

enum { LEVEL, ATTACHED, AMONG, AUGMENT_TOLERANCE, NUM_AUGMENT_KEYS };

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
    [AMONG] = {.name = "among"},
    [AUGMENT_TOLERANCE] = {"tolerance", false, RITZ_YAML_FRACTION,
                           .offset = offsetof(ritz_scene, attached_tolerance)},
};

/* Words for the sets of forces, in the order of their bits; names of inputs and
   outputs are accepted in addition. */
static const char sets[][RITZ_NAME_SIZE] = {"inputs", "interface", "outputs",
                                            "dampers"};

enum { NUM_SETS = sizeof sets / sizeof *sets };

/* Read an item of the list: the word of a set, or the name of a force. */
static ritz_status read_force(const ritz_yaml *yaml, const yaml_node_t *item,
                              const ritz_names *names, ritz_scene *scene)
{
    ritz_scene_force force = {.input = -1, .output = -1};
    const char *text = NULL;
    int64_t at = 0;

    ritz_yaml_locate(item, &force.line, &force.column);
    RITZ_CHECK(ritz_yaml_text(yaml, item, &text));
    if (strchr(text, '/')) {
        RITZ_CHECK(ritz_scene_place_read(yaml, item, scene, &force.at));
    } else {
        RITZ_CHECK(ritz_yaml_word(yaml, item, names, &at));
        if (at < NUM_SETS) {
            RITZ_REFUSE_AT(scene->attached & (1 << at), yaml, item,
                           "'%s' is listed before", text);
            scene->attached |= 1 << at;
            return RITZ_OK;
        }
        if (at < NUM_SETS + scene->num_inputs)
            force.input = at - NUM_SETS;
        else
            force.output = at - NUM_SETS - scene->num_inputs;
    }
    for (int64_t k = 0; k < scene->num_attached_forces; k++) {
        const ritz_scene_force *other = &scene->attached_force[k];

        RITZ_REFUSE_AT(other->input == force.input &&
                           other->output == force.output &&
                           other->at.component == force.at.component &&
                           strcmp(other->at.port, force.at.port) == 0,
                       yaml, item, "'%s' is listed before", text);
    }
    scene->attached_force[scene->num_attached_forces++] = force;
    return RITZ_OK;
}

/* Read a list of sets and forces. */
static ritz_status take_forces(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_scene *scene)
{
    const int64_t num_words = NUM_SETS + scene->num_inputs + scene->num_outputs;
    RITZ_OWN_ARRAY char(*words)[RITZ_NAME_SIZE] = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_scene_count(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0, yaml, node,
                   "nothing is attached: 'augment: none' says so");
    RITZ_CHECK_NEW(words, num_words);
    memcpy(words, sets, sizeof sets);
    for (int64_t j = 0; j < scene->num_inputs; j++)
        memcpy(words[NUM_SETS + j], scene->input[j].name, RITZ_NAME_SIZE);
    for (int64_t j = 0; j < scene->num_outputs; j++)
        memcpy(words[NUM_SETS + scene->num_inputs + j], scene->output[j].name,
               RITZ_NAME_SIZE);
    RITZ_CHECK_NEW(scene->attached_force, count);
    for (int64_t k = 0; k < count; k++) {
        const ritz_names names = {"attached set", num_words, words[0],
                                  sizeof *words};

        RITZ_CHECK(
            read_force(yaml, ritz_yaml_item(yaml, node, k), &names, scene));
    }
    return RITZ_OK;
}

/* Read the word 'auto', or a list. */
static ritz_status take_attached(const ritz_yaml *yaml, const yaml_node_t *node,
                                 ritz_scene *scene)
{
    static const char words[][8] = {"auto"};
    const ritz_names names = {"choice of attached dofs", 1, words[0],
                              sizeof *words};
    int64_t at = 0;

    if (node->type != YAML_SCALAR_NODE)
        return take_forces(yaml, node, scene);
    RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    scene->attached |= RITZ_ATTACHED_AUTO;
    return RITZ_OK;
}

static ritz_status check_augmentation(const ritz_yaml *yaml,
                                      const yaml_node_t *const *value,
                                      const ritz_scene *scene)
{
    bool automatic = scene->attached & RITZ_ATTACHED_AUTO;
    const yaml_node_t *listed = value[AMONG] ? value[AMONG] : value[ATTACHED];

    RITZ_REFUSE_AT(scene->augment == RITZ_AUGMENT_NONE && value[ATTACHED], yaml,
                   value[ATTACHED],
                   "nothing is attached where nothing is "
                   "augmented");
    RITZ_REFUSE_AT(scene->augment == RITZ_AUGMENT_SYSTEM &&
                       (scene->attached & RITZ_ATTACHED_INTERFACE),
                   yaml, listed,
                   "in a system the forces at an interface cancel: attach "
                   "'interface' with 'level: component'");
    RITZ_REFUSE_AT(value[AMONG] && !automatic, yaml, value[AMONG],
                   "'among' goes with 'attached: auto' alone");
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

static ritz_status read_augmentation(const ritz_yaml *yaml,
                                     const yaml_node_t *node, ritz_scene *scene)
{
    const yaml_node_t *value[NUM_AUGMENT_KEYS] = {0};

    if (!node)
        return RITZ_OK;
    if (node->type == YAML_SCALAR_NODE)
        return ritz_yaml_value(yaml, node, &augment_keys[LEVEL], scene);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_AUGMENT_KEYS, augment_keys,
                                 scene, value));
    if (value[ATTACHED])
        RITZ_CHECK(take_attached(yaml, value[ATTACHED], scene));
    if (value[AMONG] && (scene->attached & RITZ_ATTACHED_AUTO))
        RITZ_CHECK(take_forces(yaml, value[AMONG], scene));
    return check_augmentation(yaml, value, scene);
}

/* ---- extraneous modes --------------------------------------------------- */

enum { FATE, EXTRANEOUS_TOLERANCE, NUM_EXTRANEOUS_KEYS };

static const ritz_yaml_key extraneous_keys[NUM_EXTRANEOUS_KEYS] = {
    [FATE] = {.name = "fate", .required = true},
    [EXTRANEOUS_TOLERANCE] = {"tolerance", false, RITZ_YAML_FRACTION,
                              .offset =
                                  offsetof(ritz_scene, extraneous_tolerance)},
};

static ritz_status read_extraneous(const ritz_yaml *yaml,
                                   const yaml_node_t *node, ritz_scene *scene)
{
    const yaml_node_t *value[NUM_EXTRANEOUS_KEYS] = {node};
    const char *text = NULL;

    if (!node)
        return RITZ_OK;
    if (node->type != YAML_SCALAR_NODE)
        RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_EXTRANEOUS_KEYS,
                                     extraneous_keys, scene, value));
    RITZ_CHECK(ritz_yaml_text(yaml, value[FATE], &text));
    RITZ_CHECK(ritz_yaml_at(yaml, value[FATE],
                            ritz_scene_set_extraneous(scene, text)));
    RITZ_REFUSE_AT(value[EXTRANEOUS_TOLERANCE] &&
                       scene->extraneous != RITZ_EXTRANEOUS_COMPACT,
                   yaml, value[EXTRANEOUS_TOLERANCE],
                   "a tolerance goes with 'fate: compact' alone");
    return RITZ_OK;
}

ritz_status ritz_scene_set_extraneous(ritz_scene *scene, const char *word)
{
    static const char words[][16] = {
        [RITZ_EXTRANEOUS_KEEP] = "keep",
        [RITZ_EXTRANEOUS_REMOVE] = "remove",
        [RITZ_EXTRANEOUS_OUT_OF_BAND] = "out-of-band",
        [RITZ_EXTRANEOUS_COMPACT] = "compact",
    };
    const ritz_names names = {"fate of extraneous modes",
                              sizeof words / sizeof *words, words[0],
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

/* ---- band and damping --------------------------------------------------- */

static ritz_status take_band(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    double *band = (double *)field;

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 2, band));
    RITZ_REFUSE_AT(!(band[0] >= 0.0 && band[1] > band[0]), yaml, node,
                   "the band %g to %g Hz does not ascend from 0 or above",
                   band[0], band[1]);
    return RITZ_OK;
}

/* Forms of damping: rows of `width` numbers, from `least` to `most` of them. */
static const struct damping_form {
    ritz_damping_kind kind;
    const char *what; /* NULL: one row, without a list */
    int64_t least, most, width;
    size_t offset; /* of the numbers in ritz_damping */
} forms[] = {
    {RITZ_DAMPING_MODAL, NULL, 1, 1, 1, offsetof(ritz_damping, zeta)},
    {RITZ_DAMPING_MODES, "ratios of modes", 1, RITZ_MOST_RATIOS, 1,
     offsetof(ritz_damping, ratio)},
    {RITZ_DAMPING_BANDS, "bands", 1, RITZ_MAX_BANDS, 3,
     offsetof(ritz_damping, band)},
    {RITZ_DAMPING_RAYLEIGH, NULL, 1, 1, 2, offsetof(ritz_damping, a)},
    {RITZ_DAMPING_FIT, "points of a fit", 2, RITZ_MOST_POINTS, 2,
     offsetof(ritz_damping, point)},
};

enum { NUM_FORMS = sizeof forms / sizeof *forms };

static const ritz_yaml_key damping_keys[NUM_FORMS] = {
    {.name = "modal"},    {.name = "modes"},        {.name = "bands"},
    {.name = "rayleigh"}, {.name = "rayleigh_fit"},
};

static ritz_status read_numbers(const ritz_yaml *yaml, const yaml_node_t *node,
                                int64_t width, double *out)
{
    return width == 1 ? ritz_yaml_real(yaml, node, out)
                      : ritz_yaml_reals(yaml, node, width, out);
}

/* What is wrong with a band is said at that band. */
static ritz_status read_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                                const struct damping_form *form,
                                ritz_damping *damping)
{
    double *number = (double *)(void *)((char *)damping + form->offset);
    int64_t count = 0;

    damping->kind = form->kind;
    if (!form->what) {
        RITZ_CHECK(read_numbers(yaml, node, form->width, number));
        return ritz_yaml_at(yaml, node, ritz_damping_check(damping));
    }
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < form->least || count > form->most, yaml, node,
                   "%" PRId64 " to %" PRId64 " %s can be given, not %" PRId64,
                   form->least, form->most, form->what, count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);

        RITZ_CHECK(
            read_numbers(yaml, item, form->width, number + k * form->width));
        damping->count = k + 1;
        if (form->kind == RITZ_DAMPING_BANDS || k + 1 == count)
            RITZ_CHECK(ritz_yaml_at(
                yaml, form->kind == RITZ_DAMPING_BANDS ? item : node,
                ritz_damping_check(damping)));
    }
    if (form->kind == RITZ_DAMPING_FIT)
        ritz_damping_fit(damping);
    return RITZ_OK;
}

static ritz_status take_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                                void *field)
{
    const yaml_node_t *value[NUM_FORMS];
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    RITZ_REFUSE_AT(count != 1, yaml, node,
                   "damping is one of modal, modes, bands, rayleigh and "
                   "rayleigh_fit");
    RITZ_CHECK(
        ritz_yaml_mapping(yaml, node, NUM_FORMS, damping_keys, field, value));
    for (int k = 0; k < NUM_FORMS; k++)
        if (value[k])
            RITZ_CHECK(read_damping(yaml, value[k], &forms[k], field));
    return RITZ_OK;
}

/* ---- the whole ---------------------------------------------------------- */

enum { /* in the order in which parts name each other */
       SCENE,
       PLANE,
       COMPONENTS,
       JOINTS,
       CONFIGURATIONS,
       INPUTS,
       OUTPUTS,
       BAND,
       DAMPING,
       SPIN,
       SPIN_MODEL,
       SELECT,
       COMPOSITE,
       AUGMENT,
       EXTRANEOUS,
       NUM_KEYS
};

static const char planes[][8] = {
    [RITZ_PLANE_NONE] = "none",
    [RITZ_PLANE_YZ] = "yz",
    [RITZ_PLANE_XZ] = "xz",
    [RITZ_PLANE_XY] = "xy",
};

static const ritz_yaml_key keys[NUM_KEYS] = {
    [PLANE] = {"plane", false, RITZ_YAML_WORD,
               RITZ_YAML_FIELD(ritz_scene, plane),
               RITZ_YAML_WORDS("plane", planes)},
    [SCENE] = {"scene", true, RITZ_YAML_NAME,
               .offset = offsetof(ritz_scene, name)},
    [BAND] = {"band_hz", false, RITZ_YAML_BY_HAND,
              .offset = offsetof(ritz_scene, band_hz), .take = take_band},
    [DAMPING] = {"damping", false, RITZ_YAML_BY_HAND,
                 .offset = offsetof(ritz_scene, damping), .take = take_damping},
    [SPIN] = {.name = "spin"},
    [SPIN_MODEL] = {.name = "spin_model"},
    [COMPONENTS] = {.name = "components", .required = true},
    [JOINTS] = {.name = "joints"},
    [CONFIGURATIONS] = {.name = "configurations"},
    [INPUTS] = {.name = "inputs"},
    [OUTPUTS] = {.name = "outputs"},
    [SELECT] = {.name = "select"},
    [COMPOSITE] = {.name = "composite"},
    [AUGMENT] = {.name = "augment"},
    [EXTRANEOUS] = {.name = "extraneous"},
};

static ritz_scene_part *const parts[NUM_KEYS] = {
    [COMPONENTS] = ritz_scene_components,
    [JOINTS] = ritz_scene_joints,
    [CONFIGURATIONS] = ritz_scene_configurations,
    [INPUTS] = ritz_scene_inputs,
    [OUTPUTS] = ritz_scene_outputs,
    [SPIN] = ritz_scene_spin_part,
    [SPIN_MODEL] = ritz_scene_spin_model,
    [SELECT] = read_selection,
    [COMPOSITE] = ritz_scene_composite,
    [AUGMENT] = read_augmentation,
    [EXTRANEOUS] = read_extraneous,
};

ritz_status ritz_scene_parse(const char *path, const char *text,
                             ritz_scene *out)
{
    const yaml_node_t *value[NUM_KEYS];
    RITZ_OWN(ritz_yaml) yaml = {0};
    RITZ_OWN(ritz_scene)
    scene = {.source = &ritz_container_source,
             .select_by = "hankel",
             .select_tolerance = RITZ_SCENE_SELECT,
             .composite_tolerance = RITZ_NEGLIGIBLE,
             .attached_tolerance = RITZ_SCENE_ATTACHED,
             .extraneous_tolerance = RITZ_SCENE_COMPACT,
             .spin = {.negligible = RITZ_SCENE_SPIN}};

    RITZ_CHECK_NEW(scene.path, (int64_t)strlen(path) + 1);
    memcpy(scene.path, path, strlen(path));
    RITZ_CHECK(ritz_yaml_load(path, text, &yaml));
    RITZ_CHECK(ritz_yaml_mapping(&yaml, ritz_yaml_root(&yaml), NUM_KEYS, keys,
                                 &scene, value));
    for (int k = 0; k < NUM_KEYS; k++)
        if (parts[k])
            RITZ_CHECK(parts[k](&yaml, value[k], &scene));
    RITZ_MOVE(*out, scene);
    return RITZ_OK;
}

/* A relative path of a model begins at the folder of the scene. */
static ritz_status place_model(const char *path, size_t folder, char **model)
{
    size_t length = strlen(*model);
    char *placed = NULL;

    if ((*model)[0] == '/' || folder == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(placed, (int64_t)(folder + length + 1));
    memcpy(placed, path, folder);
    memcpy(placed + folder, *model, length);
    free(*model);
    *model = placed;
    return RITZ_OK;
}

ritz_status ritz_scene_read(const char *path, ritz_scene *out)
{
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    RITZ_CHECK(ritz_text_read(path, &text));
    RITZ_CHECK(ritz_scene_parse(path, text, &scene));
    for (int64_t k = 0; k < scene.num_components; k++)
        RITZ_CHECK(place_model(path, folder, &scene.component[k].model));
    RITZ_MOVE(*out, scene);
    return RITZ_OK;
}

ritz_status ritz_scene_context(const ritz_scene *scene, ritz_status status,
                               int64_t line, int64_t column, const char *kind,
                               const char *name)
{
    char what[512];

    snprintf(what, sizeof what, "%s:%" PRId64 ":%" PRId64 ": %s '%s'",
             scene->path, line, column, kind, name);
    return ritz_context(status, what);
}

void ritz_scene_free(ritz_scene *scene)
{
    for (int64_t k = 0; k < scene->num_components; k++) {
        RITZ_FREE(scene->component[k].model, scene->component[k].attach);
    }
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        free(scene->sweep[k].setting);
    ritz_spin_rate_free(&scene->spin.rate);
    RITZ_FREE(scene->path, scene->component, scene->joint, scene->sweep,
              scene->setting, scene->input, scene->output, scene->reference,
              scene->select_mode, scene->attached_force);
    *scene = (ritz_scene){0};
}
