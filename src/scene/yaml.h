/*
 * A thin reader over libyaml: a document is loaded whole, its mappings are read
 * by tables of keys, and every refusal begins with file, line and column.
 *
 * What stands under a key is visited only as its table says, never followed
 * blindly: an alias is the node it stands for, so that a text cannot grow by
 * them nor lead in circles.
 */
#ifndef RITZ_SCENE_YAML_H
#define RITZ_SCENE_YAML_H

#include "base/text.h"

#include <ritz/scene.h>

#include <yaml.h>

typedef struct ritz_yaml {
    const char *path; /* for sentences; borrowed */
    bool loaded;
    yaml_document_t document;
} ritz_yaml;

/* Store the value of a key in a field of an object, if it is a good one. */
typedef ritz_status ritz_yaml_take(const ritz_yaml *yaml,
                                   const yaml_node_t *node, void *field);

/* What the value of a key is, and the field it is stored in. */
typedef enum ritz_yaml_kind {
    RITZ_YAML_LATER,    /* the caller looks at it */
    RITZ_YAML_NAME,     /* char[RITZ_NAME_SIZE] */
    RITZ_YAML_TEXT,     /* char *, the owner's */
    RITZ_YAML_POSITIVE, /* double above 0 */
    RITZ_YAML_FRACTION, /* double between 0 and 1, neither of them */
    RITZ_YAML_REALS,    /* double[count] */
    RITZ_YAML_WHOLE,    /* int64_t from least to most */
    RITZ_YAML_WORD,     /* index of a word, as an integer of `size` bytes */
    RITZ_YAML_BY_HAND,  /* as `take` does */
} ritz_yaml_kind;

typedef struct ritz_yaml_key {
    char name[16];
    bool required;
    ritz_yaml_kind kind;
    size_t offset; /* of the field in the object */
    size_t size;
    int64_t count;
    int64_t least, most;
    const char *before, *after; /* the number, in the sentence of refusal */
    ritz_names words;
    ritz_yaml_take *take;
} ritz_yaml_key;

/* Offset of a field, and its size. */
#define RITZ_YAML_FIELD(type, field)                                           \
    .offset = offsetof(type, field), .size = sizeof(((type *)0)->field)

/* Words of an array of char[]. */
#define RITZ_YAML_WORDS(what, list)                                            \
    .words = {what, sizeof(list) / sizeof *(list), (list)[0], sizeof *(list)}

/**
 * The only document of @p text.
 *
 * @return RITZ_ERR_FORMAT if it is no YAML, empty, several documents, nested
 *         deeper or holding more anchors than any scene needs
 */
ritz_status ritz_yaml_load(const char *path, const char *text, ritz_yaml *out);

const yaml_node_t *ritz_yaml_root(const ritz_yaml *yaml);

/** Put "path:line:column: " before the sentence of a failed status. */
ritz_status ritz_yaml_at(const ritz_yaml *yaml, const yaml_node_t *node,
                         ritz_status status);

/* RITZ_REFUSE_IF with a node's place before the sentence. */
#define RITZ_REFUSE_AT(condition, yaml, node, ...)                             \
    do {                                                                       \
        if (condition)                                                         \
            return ritz_yaml_at((yaml), (node),                                \
                                ritz_fail(RITZ_ERR_FORMAT, __VA_ARGS__));      \
    } while (0)

/** Line and column of a node, from 1. */
void ritz_yaml_locate(const yaml_node_t *node, int64_t *line, int64_t *column);

/**
 * Whether item @p k of an array, whose items of @p size bytes begin with their
 * names, has another name than those before it.
 *
 * @return RITZ_ERR_FORMAT "WHAT 'clock' is given twice"
 */
ritz_status ritz_yaml_distinct(const ritz_yaml *yaml, const yaml_node_t *node,
                               const char *what, int64_t k, const void *items,
                               size_t size);

/** Number of items of a list, which @p node must be; and one of them. */
ritz_status ritz_yaml_list(const ritz_yaml *yaml, const yaml_node_t *node,
                           int64_t *count);
const yaml_node_t *ritz_yaml_item(const ritz_yaml *yaml,
                                  const yaml_node_t *node, int64_t k);

/** Number of pairs of a mapping, which @p node must be; and one of them. */
ritz_status ritz_yaml_pairs(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t *count);
const yaml_node_t *ritz_yaml_key_at(const ritz_yaml *yaml,
                                    const yaml_node_t *node, int64_t k);
const yaml_node_t *ritz_yaml_value_at(const ritz_yaml *yaml,
                                      const yaml_node_t *node, int64_t k);

/**
 * Read a mapping by a table of @p count keys.
 *
 * @param[out] object  what the keys' fields belong to
 * @param[out] value   for each key its value, NULL where it is absent
 * @return RITZ_ERR_FORMAT for an unknown, repeated or missing key
 */
ritz_status ritz_yaml_mapping(const ritz_yaml *yaml, const yaml_node_t *node,
                              int64_t count, const ritz_yaml_key *keys,
                              void *object, const yaml_node_t **value);

/** Text that is not empty, borrowed from the document. */
ritz_status ritz_yaml_text(const ritz_yaml *yaml, const yaml_node_t *node,
                           const char **out);

/** The value of one key, in the field of an object. */
ritz_status ritz_yaml_value(const ritz_yaml *yaml, const yaml_node_t *node,
                            const ritz_yaml_key *key, void *object);

/** A name, which must fit; a finite number; a whole one. */
ritz_status ritz_yaml_name(const ritz_yaml *yaml, const yaml_node_t *node,
                           char out[RITZ_NAME_SIZE]);
ritz_status ritz_yaml_real(const ritz_yaml *yaml, const yaml_node_t *node,
                           double *out);
ritz_status ritz_yaml_whole(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t *out);

/** A list of exactly @p count numbers. */
ritz_status ritz_yaml_reals(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t count, double *out);

/** An axis of three numbers, as a unit vector of doubles. */
ritz_yaml_take ritz_yaml_direction;

/** Index of a word among names. */
ritz_status ritz_yaml_word(const ritz_yaml *yaml, const yaml_node_t *node,
                           const ritz_names *names, int64_t *out);

void ritz_yaml_free(ritz_yaml *yaml);

/* Parts of a scene, each read by its own file; scene.c puts them together. */

enum {
    RITZ_MOST_PARTS = 10000,           /* components, joints, inputs, outputs */
    RITZ_MOST_SWEEPS = 1000,           /* as looked up for every setting */
    RITZ_MOST_SETTINGS = 1000000,      /* configurations times sweeps */
    RITZ_MOST_CONFIGURATIONS = 100000, /* given or combined */
    RITZ_MOST_REFERENCES = 1000,       /* each sought among all of those */
};

/*
 * Each reads the value of one key of the scene, NULL where it is absent; what
 * it names must have been read: components, joints, configurations, the rest.
 */
typedef ritz_status ritz_scene_part(const ritz_yaml *yaml,
                                    const yaml_node_t *node, ritz_scene *scene);
ritz_scene_part ritz_scene_components;
ritz_scene_part ritz_scene_joints;
ritz_scene_part ritz_scene_configurations;
ritz_scene_part ritz_scene_inputs;
ritz_scene_part ritz_scene_outputs;
ritz_scene_part ritz_scene_composite;
ritz_scene_part ritz_scene_spin_part;
ritz_scene_part ritz_scene_spin_model;

/** Names of loads, in the field `stiffening` of a component. */
ritz_yaml_take ritz_scene_stiffening;

/** Number of items of a list of parts, refused if it is too long. */
ritz_status ritz_scene_count(const ritz_yaml *yaml, const yaml_node_t *node,
                             int64_t *count);

/** "rotor/bearing", its component one of the scene. */
ritz_status ritz_scene_place_read(const ritz_yaml *yaml,
                                  const yaml_node_t *node,
                                  const ritz_scene *scene,
                                  ritz_scene_place *out);

/** First of @p count rows of @p n numbers that repeats one before it, or -1. */
ritz_status ritz_rows_repeated(int64_t count, int64_t n, const double *val,
                               int64_t *out);

#endif
