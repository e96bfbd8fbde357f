#include "scene/yaml.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* libyaml's time grows with the square of both; no scene comes near. */
enum { MOST_NESTED = 100, MOST_ANCHORS = 1000 };

/* Line and column, from 0, of a byte: all that is known of a bad character. */
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

/* What libyaml says of a failure, in one sentence. */
static ritz_status explain(const char *path, const char *text,
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

static ritz_status start(yaml_parser_t *parser, const char *path,
                         const char *text)
{
    if (!yaml_parser_initialize(parser))
        return ritz_fail(RITZ_ERR_MEMORY, "no memory is left to read '%s'",
                         path);
    yaml_parser_set_input_string(parser, (const yaml_char_t *)text,
                                 strlen(text));
    return RITZ_OK;
}

/* What a token adds to the depth of [ and {. */
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

/* Go through the tokens alone, to refuse what loading would take ages for. */
static ritz_status guard(const char *path, const char *text)
{
    ritz_status status = RITZ_OK;
    yaml_parser_t parser = {0};
    yaml_token_t token = {0};
    bool at_end = false;
    int depth = 0;
    int anchors = 0;

    RITZ_TRY(start(&parser, path, text));
    while (!at_end) {
        if (!yaml_parser_scan(&parser, &token))
            RITZ_TRY(explain(path, text, &parser));
        at_end = token.type == YAML_STREAM_END_TOKEN;
        depth += step_of(token.type);
        anchors += token.type == YAML_ANCHOR_TOKEN;
        RITZ_FAIL_IF(depth > MOST_NESTED || anchors > MOST_ANCHORS,
                     RITZ_ERR_FORMAT, "%s:%zu:%zu: more than %d %s", path,
                     token.start_mark.line + 1, token.start_mark.column + 1,
                     depth > MOST_NESTED ? MOST_NESTED : MOST_ANCHORS,
                     depth > MOST_NESTED ? "brackets one in another"
                                         : "anchors");
        yaml_token_delete(&token);
    }
done:
    yaml_token_delete(&token);
    yaml_parser_delete(&parser);
    return status;
}

/* One document more from the stream; without a root at its end. */
static ritz_status load(yaml_parser_t *parser, const char *text,
                        ritz_yaml *yaml)
{
    if (!yaml_parser_load(parser, &yaml->document))
        return explain(yaml->path, text, parser);
    yaml->loaded = true;
    return RITZ_OK;
}

ritz_status ritz_yaml_load(const char *path, const char *text, ritz_yaml *out)
{
    ritz_status status = RITZ_OK;
    yaml_parser_t parser = {0};
    ritz_yaml yaml = {.path = path};
    ritz_yaml second = {.path = path};

    RITZ_TRY(guard(path, text));
    RITZ_TRY(start(&parser, path, text));
    RITZ_TRY(load(&parser, text, &yaml));
    RITZ_FAIL_IF(!ritz_yaml_root(&yaml), RITZ_ERR_FORMAT,
                 "%s:1:1: the file is empty", path);
    RITZ_TRY(load(&parser, text, &second));
    RITZ_YAML_FAIL_IF(ritz_yaml_root(&second), &second, ritz_yaml_root(&second),
                      "a second document begins here, a scene is one");
    *out = yaml;
    yaml = (ritz_yaml){0};
done:
    ritz_yaml_free(&second);
    ritz_yaml_free(&yaml);
    yaml_parser_delete(&parser);
    return status;
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

static ritz_status expect(const ritz_yaml *yaml, const yaml_node_t *node,
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
    RITZ_CHECK(expect(yaml, node, YAML_SEQUENCE_NODE));
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
    RITZ_CHECK(expect(yaml, node, YAML_MAPPING_NODE));
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

    RITZ_CHECK(expect(yaml, node, YAML_SCALAR_NODE));
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
