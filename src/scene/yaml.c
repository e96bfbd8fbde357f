#include "scene/yaml.h"
#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* libyaml's time grows with the square of both. */
enum { MOST_NESTED = 100, MOST_ANCHORS = 1000 };

/* Line and column, from 0, of a byte: libyaml gives no more of a bad one. */
static yaml_mark_t mark_of(const char *text, size_t offset)
{
    yaml_mark_t mark = {0};

    for (; mark.index < offset && text[mark.index]; mark.index++) {
        mark.column++;
        if (text[mark.index] == '\n') {
            mark.line++;
            mark.column = 0;
        }
    }
    return mark;
}

/* The reason that libyaml gives for a failure, as one sentence. */
static ritz_status explain_failure(const char *path, const char *text,
                                   const yaml_parser_t *parser)
{
    yaml_mark_t mark = parser->problem_mark;

    /* out of memory, libyaml fails now and then without a word */
    if (parser->error == YAML_MEMORY_ERROR || !parser->problem)
        return ritz_fail(RITZ_ERR_MEMORY, "no memory is left to read '%s'",
                         path);
    if (parser->error == YAML_READER_ERROR)
        mark = mark_of(text, parser->problem_offset);
    return ritz_fail(RITZ_ERR_FORMAT, "%s:%zu:%zu: %s%s%s", path, mark.line + 1,
                     mark.column + 1, parser->problem,
                     parser->context ? " " : "",
                     parser->context ? parser->context : "");
}

static ritz_status start_parser(yaml_parser_t *parser, const char *path,
                                const char *text)
{
    if (!yaml_parser_initialize(parser))
        return ritz_fail(RITZ_ERR_MEMORY, "no memory is left to read '%s'",
                         path);
    yaml_parser_set_input_string(parser, (const yaml_char_t *)text,
                                 strlen(text));
    return RITZ_OK;
}

/* Change of the depth of [ and { by a token. */
static int step_of(yaml_token_type_t type)
{
    switch (type) {
    case YAML_FLOW_SEQUENCE_START_TOKEN:
    case YAML_FLOW_MAPPING_START_TOKEN:
        return 1;
    case YAML_FLOW_SEQUENCE_END_TOKEN:
    case YAML_FLOW_MAPPING_END_TOKEN:
        return -1;
    default:
        return 0;
    }
}

/* Scan the tokens first, to refuse what libyaml would need hours to load. */
static ritz_status guard_size(const char *path, const char *text)
{
    [[gnu::cleanup(yaml_parser_delete)]] yaml_parser_t parser = {0};
    bool at_end = false;
    int depth = 0;
    int anchors = 0;

    RITZ_CHECK(start_parser(&parser, path, text));
    while (!at_end) {
        [[gnu::cleanup(yaml_token_delete)]] yaml_token_t token = {0};

        if (!yaml_parser_scan(&parser, &token))
            return explain_failure(path, text, &parser);
        at_end = token.type == YAML_STREAM_END_TOKEN;
        depth += step_of(token.type);
        anchors += token.type == YAML_ANCHOR_TOKEN;
        RITZ_REFUSE_IF(depth > MOST_NESTED || anchors > MOST_ANCHORS,
                       RITZ_ERR_FORMAT, "%s:%zu:%zu: more than %d %s", path,
                       token.start_mark.line + 1, token.start_mark.column + 1,
                       depth > MOST_NESTED ? MOST_NESTED : MOST_ANCHORS,
                       depth > MOST_NESTED ? "brackets one in another"
                                           : "anchors");
    }
    return RITZ_OK;
}

/* Load the next document of the stream; at its end one without a root. */
static ritz_status load_document(yaml_parser_t *parser, const char *text,
                                 ritz_yaml *yaml)
{
    if (!yaml_parser_load(parser, &yaml->document))
        return explain_failure(yaml->path, text, parser);
    yaml->loaded = true;
    return RITZ_OK;
}

ritz_status ritz_yaml_load(const char *path, const char *text, ritz_yaml *out)
{
    [[gnu::cleanup(yaml_parser_delete)]] yaml_parser_t parser = {0};
    RITZ_OWN(ritz_yaml) yaml = {.path = path}, second = {.path = path};

    RITZ_CHECK(guard_size(path, text));
    RITZ_CHECK(start_parser(&parser, path, text));
    RITZ_CHECK(load_document(&parser, text, &yaml));
    RITZ_REFUSE_IF(!ritz_yaml_root(&yaml), RITZ_ERR_FORMAT,
                   "%s:1:1: the file is empty", path);
    RITZ_CHECK(load_document(&parser, text, &second));
    RITZ_REFUSE_AT(ritz_yaml_root(&second), &second, ritz_yaml_root(&second),
                   "a second document begins here, a scene is one");
    RITZ_MOVE(*out, yaml);
    return RITZ_OK;
}

static const yaml_node_t *node_of(const ritz_yaml *yaml, int number)
{
    return yaml->document.nodes.start + number - 1; /* libyaml counts from 1 */
}

const yaml_node_t *ritz_yaml_root(const ritz_yaml *yaml)
{
    if (yaml->document.nodes.top == yaml->document.nodes.start)
        return NULL;
    return node_of(yaml, 1);
}

ritz_status ritz_yaml_at(const ritz_yaml *yaml, const yaml_node_t *node,
                         ritz_status status)
{
    char inner[512];

    if (status == RITZ_OK || status == RITZ_ERR_MEMORY)
        return status;
    snprintf(inner, sizeof inner, "%s", ritz_error_message());
    return ritz_fail(RITZ_ERR_FORMAT, "%s:%zu:%zu: %s", yaml->path,
                     node->start_mark.line + 1, node->start_mark.column + 1,
                     inner);
}

void ritz_yaml_locate(const yaml_node_t *node, int64_t *line, int64_t *column)
{
    *line = (int64_t)node->start_mark.line + 1;
    *column = (int64_t)node->start_mark.column + 1;
}

ritz_status ritz_yaml_distinct(const ritz_yaml *yaml, const yaml_node_t *node,
                               const char *what, int64_t k, const void *items,
                               size_t size)
{
    const ritz_names before = {what, k, items, size};
    const char *name = (const char *)items + (size_t)k * size;

    RITZ_REFUSE_AT(ritz_names_index(&before, name) >= 0, yaml, node,
                   "%s '%s' is given twice", what, name);
    return RITZ_OK;
}

static const char *const kind_name[] = {
    [YAML_SCALAR_NODE] = "a word or number",
    [YAML_SEQUENCE_NODE] = "a list",
    [YAML_MAPPING_NODE] = "a mapping",
};

static const char *const plain_tag[] = {
    [YAML_SCALAR_NODE] = YAML_DEFAULT_SCALAR_TAG,
    [YAML_SEQUENCE_NODE] = YAML_DEFAULT_SEQUENCE_TAG,
    [YAML_MAPPING_NODE] = YAML_DEFAULT_MAPPING_TAG,
};

static ritz_status expect_type(const ritz_yaml *yaml, const yaml_node_t *node,
                               yaml_node_type_t type)
{
    const char *tag = (const char *)node->tag;
    char text[RITZ_SHORT_SIZE];

    RITZ_REFUSE_AT(node->type != type, yaml, node,
                   "%s is expected here, not %s", kind_name[type],
                   kind_name[node->type]);
    RITZ_REFUSE_AT(strcmp(tag, plain_tag[type]) != 0, yaml, node,
                   "the tag '%s' means nothing here",
                   ritz_text_short(tag, text));
    return RITZ_OK;
}

ritz_status ritz_yaml_list(const ritz_yaml *yaml, const yaml_node_t *node,
                           int64_t *count)
{
    RITZ_CHECK(expect_type(yaml, node, YAML_SEQUENCE_NODE));
    *count = node->data.sequence.items.top - node->data.sequence.items.start;
    return RITZ_OK;
}

const yaml_node_t *ritz_yaml_item(const ritz_yaml *yaml,
                                  const yaml_node_t *node, int64_t k)
{
    return node_of(yaml, node->data.sequence.items.start[k]);
}

ritz_status ritz_yaml_pairs(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t *count)
{
    RITZ_CHECK(expect_type(yaml, node, YAML_MAPPING_NODE));
    *count = node->data.mapping.pairs.top - node->data.mapping.pairs.start;
    return RITZ_OK;
}

const yaml_node_t *ritz_yaml_key_at(const ritz_yaml *yaml,
                                    const yaml_node_t *node, int64_t k)
{
    return node_of(yaml, node->data.mapping.pairs.start[k].key);
}

const yaml_node_t *ritz_yaml_value_at(const ritz_yaml *yaml,
                                      const yaml_node_t *node, int64_t k)
{
    return node_of(yaml, node->data.mapping.pairs.start[k].value);
}

ritz_status ritz_yaml_text(const ritz_yaml *yaml, const yaml_node_t *node,
                           const char **out)
{
    const char *text = NULL;

    RITZ_CHECK(expect_type(yaml, node, YAML_SCALAR_NODE));
    text = (const char *)node->data.scalar.value;
    RITZ_REFUSE_AT(node->data.scalar.length == 0, yaml, node,
                   "a name or value is missing here");
    RITZ_REFUSE_AT(node->data.scalar.length != strlen(text), yaml, node,
                   "a NUL character stands in a text");
    *out = text;
    return RITZ_OK;
}

void ritz_yaml_free(ritz_yaml *yaml)
{
    if (yaml->loaded)
        yaml_document_delete(&yaml->document);
    *yaml = (ritz_yaml){0};
}

ritz_status ritz_yaml_word(const ritz_yaml *yaml, const yaml_node_t *node,
                           const ritz_names *names, int64_t *out)
{
    const char *text = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    return ritz_yaml_at(yaml, node, ritz_words_find(names, text, out));
}

/* Suggest a key that the mapping does not have, if one is near. */
static ritz_status suggest_key(const ritz_names *names, const char *word,
                               const yaml_node_t *const *value)
{
    enum { MOST_KEYS = 16 };
    char absent[MOST_KEYS][sizeof(((ritz_yaml_key *)0)->name)];
    ritz_names left = {names->what, 0, absent[0], sizeof *absent};
    int64_t at = 0;

    for (int64_t k = 0; k < names->count && left.count < MOST_KEYS; k++)
        if (!value[k])
            memcpy(absent[left.count++],
                   names->first + (size_t)k * names->stride, sizeof *absent);
    if (ritz_text_nearest(word, left.count, left.first, left.stride))
        RITZ_CHECK(ritz_words_find(&left, word, &at));
    return ritz_words_find(names, word, &at);
}

/* The values of all keys that are known, wherever they stand. */
static void list_values(const ritz_yaml *yaml, const yaml_node_t *node,
                        int64_t pairs, const ritz_names *names,
                        const yaml_node_t **value)
{
    for (int64_t k = 0; k < names->count; k++)
        value[k] = NULL;
    for (int64_t k = 0; k < pairs; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        int64_t at = word->type != YAML_SCALAR_NODE
                         ? -1
                         : ritz_names_index(
                               names, (const char *)word->data.scalar.value);

        if (at >= 0)
            value[at] = ritz_yaml_value_at(yaml, node, k);
    }
}

ritz_status ritz_yaml_mapping(const ritz_yaml *yaml, const yaml_node_t *node,
                              int64_t count, const ritz_yaml_key *keys,
                              void *object, const yaml_node_t **value)
{
    ritz_names names = {"key", count, keys->name, sizeof *keys};
    uint64_t taken = 0; /* bits of keys */
    int64_t pairs = 0;

    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &pairs));
    list_values(yaml, node, pairs, &names, value);
    for (int64_t k = 0; k < pairs; k++) {
        const yaml_node_t *word = ritz_yaml_key_at(yaml, node, k);
        const char *text = NULL;
        int64_t at = 0;

        RITZ_CHECK(ritz_yaml_text(yaml, word, &text));
        at = ritz_names_index(&names, text);
        if (at < 0)
            return ritz_yaml_at(yaml, word, suggest_key(&names, text, value));
        RITZ_REFUSE_AT(taken >> at & 1U, yaml, word, "key '%s' is given twice",
                       keys[at].name);
        taken |= UINT64_C(1) << at;
        RITZ_CHECK(ritz_yaml_value(yaml, ritz_yaml_value_at(yaml, node, k),
                                   &keys[at], object));
    }
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_AT(keys[k].required && !value[k], yaml, node,
                       "key '%s' is missing", keys[k].name);
    return RITZ_OK;
}

ritz_status ritz_yaml_name(const ritz_yaml *yaml, const yaml_node_t *node,
                           char out[RITZ_NAME_SIZE])
{
    const char *text = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    return ritz_yaml_at(yaml, node, ritz_name_copy(text, out));
}

ritz_status ritz_yaml_real(const ritz_yaml *yaml, const yaml_node_t *node,
                           double *out)
{
    const char *text = NULL;
    char cut[RITZ_SHORT_SIZE];

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_REFUSE_AT(!ritz_text_real(text, out), yaml, node,
                   "'%s' is not a finite number", ritz_text_short(text, cut));
    return RITZ_OK;
}

ritz_status ritz_yaml_whole(const ritz_yaml *yaml, const yaml_node_t *node,
                            int64_t *out)
{
    const char *text = NULL;
    char cut[RITZ_SHORT_SIZE];

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_REFUSE_AT(!ritz_text_whole(text, out), yaml, node,
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

/* Scaled first so that no square leaves the range. */
ritz_status ritz_yaml_direction(const ritz_yaml *yaml, const yaml_node_t *node,
                                void *field)
{
    double *axis = (double *)field;
    double largest = 0.0;
    double length = 0.0;

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 3, axis));
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fabs(axis[i]));
    RITZ_REFUSE_AT(largest == 0.0, yaml, node, "the axis has no length");
    for (int i = 0; i < 3; i++)
        axis[i] /= largest;
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int i = 0; i < 3; i++)
        axis[i] /= length;
    return RITZ_OK;
}

/* ---- values by kind ----------------------------------------------------- */

static ritz_status take_text(const ritz_yaml *yaml, const yaml_node_t *node,
                             char **out)
{
    const char *text = NULL;
    char *copy = NULL;

    RITZ_CHECK(ritz_yaml_text(yaml, node, &text));
    RITZ_CHECK_NEW(copy, (int64_t)strlen(text) + 1);
    memcpy(copy, text, strlen(text) + 1);
    *out = copy;
    return RITZ_OK;
}

static ritz_status take_real(const ritz_yaml *yaml, const yaml_node_t *node,
                             ritz_yaml_kind kind, double *out)
{
    double value = 0.0;

    RITZ_CHECK(ritz_yaml_real(yaml, node, &value));
    RITZ_REFUSE_AT(kind == RITZ_YAML_POSITIVE && !(value > 0.0), yaml, node,
                   "%g is not above 0", value);
    RITZ_REFUSE_AT(kind == RITZ_YAML_FRACTION && !(value > 0.0 && value < 1.0),
                   yaml, node, "%g is not between 0 and 1", value);
    *out = value;
    return RITZ_OK;
}

static ritz_status take_whole(const ritz_yaml *yaml, const yaml_node_t *node,
                              const ritz_yaml_key *key, int64_t *out)
{
    int64_t value = 0;

    RITZ_CHECK(ritz_yaml_whole(yaml, node, &value));
    RITZ_REFUSE_AT(value < key->least || value > key->most, yaml, node,
                   "%s%" PRId64 "%s", key->before ? key->before : "", value,
                   key->after ? key->after : "");
    *out = value;
    return RITZ_OK;
}

/* Fields of words are flags, enumerations or whole numbers. */
static ritz_status take_word(const ritz_yaml *yaml, const yaml_node_t *node,
                             const ritz_yaml_key *key, void *field)
{
    int64_t at = 0;

    RITZ_CHECK(ritz_yaml_word(yaml, node, &key->words, &at));
    if (key->size == sizeof(int64_t))
        *(int64_t *)field = at;
    else if (key->size == sizeof(int))
        *(int *)field = (int)at;
    else
        *(bool *)field = at == 1;
    return RITZ_OK;
}

ritz_status ritz_yaml_value(const ritz_yaml *yaml, const yaml_node_t *node,
                            const ritz_yaml_key *key, void *object)
{
    void *field = (char *)object + key->offset;

    switch (key->kind) {
    case RITZ_YAML_LATER:
        break;
    case RITZ_YAML_NAME:
        return ritz_yaml_name(yaml, node, field);
    case RITZ_YAML_TEXT:
        return take_text(yaml, node, field);
    case RITZ_YAML_POSITIVE:
    case RITZ_YAML_FRACTION:
        return take_real(yaml, node, key->kind, field);
    case RITZ_YAML_REALS:
        return ritz_yaml_reals(yaml, node, key->count, field);
    case RITZ_YAML_WHOLE:
        return take_whole(yaml, node, key, field);
    case RITZ_YAML_WORD:
        return take_word(yaml, node, key, field);
    case RITZ_YAML_BY_HAND:
        return key->take(yaml, node, field);
    }
    return RITZ_OK;
}
