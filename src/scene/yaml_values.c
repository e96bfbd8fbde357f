/* Values of a YAML document: tables of keys, names, numbers. */
#include "scene/yaml.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <string.h>

ritz_status ritz_yaml_word(const ritz_yaml *yaml, const yaml_node_t *node,
                           const ritz_names *names, int64_t *out)
{
    const char *text = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    return ritz_yaml_at(yaml, node, ritz_words_find(names, text, out));
}

static bool has_key(const ritz_yaml *yaml, const yaml_node_t *node,
                    const char *name)
{
    int64_t pairs =
        node->data.mapping.pairs.top - node->data.mapping.pairs.start;

    for (int64_t k = 0; k < pairs; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);

        if (word->type == YAML_SCALAR_NODE &&
            strcmp((const char *)word->data.scalar.value, name) == 0)
            return true;
    }
    return false;
}

/* A mistyped key is rather one that the mapping has not got yet. */
static ritz_status suggest(const ritz_yaml *yaml, const yaml_node_t *node,
                           const ritz_names *names, const char *word)
{
    enum { MOST_KEYS = 16 };
    char absent[MOST_KEYS][sizeof(((ritz_yaml_key *)0)->name)];
    ritz_names left = {names->what, 0, absent[0], sizeof *absent};
    int64_t at = 0;

    for (int64_t k = 0; k < names->count && left.count < MOST_KEYS; k++) {
        const char *name = names->first + (size_t)k * names->stride;

        if (!has_key(yaml, node, name))
            memcpy(absent[left.count++], name, sizeof *absent);
    }
    if (ritz_text_nearest(word, left.count, left.first, left.stride))
        RITZ_CHECK(ritz_words_find(&left, word, &at));
    return ritz_words_find(names, word, &at);
}

/* Index of the key that a node of a mapping names. */
static ritz_status find_key(const ritz_yaml *yaml, const yaml_node_t *node,
                            const yaml_node_t *word, const ritz_names *names,
                            int64_t *out)
{
    const char *text = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, word, &text));
    *out = ritz_names_index(names, text);
    if (*out < 0)
        RITZ_CHECK(ritz_yaml_at(yaml, word, suggest(yaml, node, names, text)));
    return RITZ_OK;
}

ritz_status ritz_yaml_mapping(const ritz_yaml *yaml, const yaml_node_t *node,
                              int64_t count, const ritz_yaml_key *keys,
                              void *object, const yaml_node_t **value)
{
    ritz_names names = {"key", count, keys->name, sizeof *keys};
    int64_t pairs = 0;

    for (int64_t k = 0; k < count; k++)
        value[k] = NULL;
    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &pairs));
    for (int64_t k = 0; k < pairs; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        int64_t at = 0;

        RITZ_CHECK(find_key(yaml, node, word, &names, &at));
        RITZ_REFUSE_AT(value[at], yaml, word, "key '%s' is given twice",
                       keys[at].name);
        value[at] = ritz_yaml_value_at(yaml, node, k);
        if (keys[at].take)
            RITZ_CHECK(keys[at].take(yaml, value[at],
                                     (char *)object + keys[at].offset));
    }
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_AT(keys[k].required && !value[k], yaml, node,
                       "key '%s' is missing", keys[k].name);
    return RITZ_OK;
}

ritz_status ritz_yaml_name(const ritz_yaml *yaml, const yaml_node_t *node,
                           void *field)
{
    const char *text = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    return ritz_yaml_at(yaml, node, ritz_name_copy(text, field));
}

ritz_status ritz_yaml_copy(const ritz_yaml *yaml, const yaml_node_t *node,
                           void *field)
{
    const char *text = NULL;
    char *copy = NULL;
    char **out = (char **)field;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_CHECK_NEW(copy, (int64_t)strlen(text) + 1);
    memcpy(copy, text, strlen(text) + 1);
    *out = copy;
    return RITZ_OK;
}

ritz_status ritz_yaml_real(const ritz_yaml *yaml, const yaml_node_t *node,
                           void *field)
{
    const char *text = NULL;
    char cut[RITZ_SHORT_SIZE];

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_REFUSE_AT(!ritz_text_real(text, (double *)field), yaml, node,
                   "'%s' is not a finite number", ritz_text_short(text, cut));
    return RITZ_OK;
}

ritz_status ritz_yaml_positive(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    double value = 0.0;

    RITZ_CHECK(ritz_yaml_real(yaml, node, &value));
    RITZ_REFUSE_AT(!(value > 0.0), yaml, node, "%g is not above 0", value);
    *(double *)field = value;
    return RITZ_OK;
}

ritz_status ritz_yaml_fraction(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    double value = 0.0;

    RITZ_CHECK(ritz_yaml_real(yaml, node, &value));
    RITZ_REFUSE_AT(!(value > 0.0 && value < 1.0), yaml, node,
                   "%g is not between 0 and 1", value);
    *(double *)field = value;
    return RITZ_OK;
}

ritz_status ritz_yaml_whole(const ritz_yaml *yaml, const yaml_node_t *node,
                            void *field)
{
    const char *text = NULL;
    char cut[RITZ_SHORT_SIZE];

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_REFUSE_AT(!ritz_text_whole(text, (int64_t *)field), yaml, node,
                   "'%s' is not a whole number", ritz_text_short(text, cut));
    return RITZ_OK;
}

ritz_status ritz_yaml_reals(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t count, double *out)
{
    int64_t found = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &found));
    RITZ_REFUSE_AT(found != count, yaml, node,
                   "%" PRId64 " numbers are expected here, not %" PRId64, count,
                   found);
    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(
            ritz_yaml_real(yaml, ritz_yaml_item(yaml, node, k), &out[k]));
    return RITZ_OK;
}
