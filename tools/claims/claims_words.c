/* A line of claims as words. */
#include "claims/claims.h"

#include <stdlib.h>
#include <string.h>

/* A folder that a word begins with: "$DATA/lund" */
static const char *replace_folder(const claims_state *state, const char *text,
                                  size_t *length)
{
    const struct {
        const char *name, *value;
    } known[] = {{"$DATA", state->data}, {"$HERE", state->here}};

    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        *length = strlen(known[k].name);
        if (strncmp(text, known[k].name, *length) == 0)
            return known[k].value;
    }
    return NULL;
}

/*
 * One word from `text` to `out`; what follows it, or NULL: never closed. A
 * quote within a word is a letter.
 */
static const char *take_word(const claims_state *state, const char *text,
                             char *out)
{
    char quote = '\0';

    if (strchr("\"'", *text))
        quote = *text++;
    for (; *text && (quote || !strchr(" \t", *text)); text++) {
        size_t length = 0;
        const char *value =
            *text == '$' ? replace_folder(state, text, &length) : NULL;

        if (value) {
            memcpy(out, value, strlen(value));
            out += strlen(value);
            text += length - 1;
        } else if (quote && *text == quote) {
            *out = '\0';
            return text + 1;
        } else {
            *out++ = *text;
        }
    }
    *out = '\0';
    return quote ? NULL : text;
}

/* Room that every word fits, folders put in. */
static size_t count_room(const char *text)
{
    size_t size = 2 * strlen(text) + 1;

    for (const char *at = text; *at; at++)
        size += *at == '$' ? PATH_MAX : 0;
    return size;
}

ritz_status claims_cut(const claims_state *state, const char *text,
                       claims_line *line)
{
    char *out = malloc(count_room(text));

    line->room = out;
    line->count = 0;
    RITZ_REFUSE_IF(!out, RITZ_ERR_MEMORY, "no memory for a line");
    for (text += strspn(text, " \t"); *text && *text != '#';
         text += strspn(text, " \t")) {
        RITZ_REFUSE_IF(line->count == CLAIMS_MOST_WORDS, RITZ_ERR_FORMAT,
                       "more than %d words", CLAIMS_MOST_WORDS);
        line->word[line->count] = out;
        text = take_word(state, text, out);
        RITZ_REFUSE_IF(!text, RITZ_ERR_FORMAT, "a quote is not closed");
        out += strlen(line->word[line->count++]) + 1;
    }
    return RITZ_OK;
}

void claims_line_free(claims_line *line)
{
    free(line->room);
    line->room = NULL;
    line->count = 0;
}
