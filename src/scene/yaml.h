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

#include "model/names.h"

#include <yaml.h>

typedef struct ritz_yaml {
    const char *path; /* for sentences; borrowed */
    bool loaded;
    yaml_document_t document;
} ritz_yaml;

/* Store the value of a key in a field of an object, if it is a good one. */
typedef ritz_status ritz_yaml_take(const ritz_yaml *yaml,
                                   const yaml_node_t *node, void *field);

typedef struct ritz_yaml_key {
    char name[16];
    bool required;
    ritz_yaml_take *take; /* NULL: the caller looks at the value */
    size_t offset;        /* of the field in the object */
} ritz_yaml_key;

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

/* RITZ_FAIL_IF and RITZ_REFUSE_IF with a node's place before the sentence. */
#define RITZ_YAML_FAIL_IF(condition, yaml, node, ...)                          \
    do {                                                                       \
        if (condition) {                                                       \
            status = ritz_yaml_at((yaml), (node),                              \
                                  ritz_fail(RITZ_ERR_FORMAT, __VA_ARGS__));    \
            goto done;                                                         \
        }                                                                      \
    } while (0)

#define RITZ_REFUSE_AT(condition, yaml, node, ...)                             \
    do {                                                                       \
        if (condition)                                                         \
            return ritz_yaml_at((yaml), (node),                                \
                                ritz_fail(RITZ_ERR_FORMAT, __VA_ARGS__));      \
    } while (0)

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

/** A list of exactly @p count numbers. */
ritz_status ritz_yaml_reals(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t count, double *out);

/** Index of a word among names. */
ritz_status ritz_yaml_word(const ritz_yaml *yaml, const yaml_node_t *node,
                           const ritz_names *names, int64_t *out);

/* Fields: char[RITZ_NAME_SIZE]; char * of the owner's; double; int64_t. */
ritz_yaml_take ritz_yaml_name;
ritz_yaml_take ritz_yaml_copy;
ritz_yaml_take ritz_yaml_real;
ritz_yaml_take ritz_yaml_positive; /* above 0 */
ritz_yaml_take ritz_yaml_fraction; /* between 0 and 1, neither of them */
ritz_yaml_take ritz_yaml_whole;

void ritz_yaml_free(ritz_yaml *yaml);

#endif
