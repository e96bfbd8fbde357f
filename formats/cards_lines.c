/*
 * A line of bulk data.
 *
 *     small field   name    8 fields of  8 columns   marker in 73-80
 *     large field   name*   4 fields of 16 columns   marker in 73-80
 *     free field    name,   8 fields (4 if name*)    ,marker
 *
 * A line whose first field is blank, or begins with + or *, continues a card.
 * A comma in the first ten columns makes a line free. A tab goes to the next of
 * columns 9, 17, ... What lies beyond column 80 of a fixed line is not read.
 */
#include "formats/cards_lines.h"

void ritz_card_trim(const char **text, int64_t *length)
{
    while (*length > 0 && ritz_card_is_blank((*text)[*length - 1]))
        (*length)--;
    while (*length > 0 && ritz_card_is_blank(**text)) {
        (*text)++;
        (*length)--;
    }
}

void ritz_card_uncomment(const char *line, int64_t *length)
{
    const char *dollar = memchr(line, '$', (size_t)*length);

    if (dollar)
        *length = dollar - line;
}

bool ritz_card_begins(const char *line, int64_t length, const char *word,
                      const char **rest)
{
    int64_t k = 0;

    ritz_card_trim(&line, &length);
    for (; word[k]; k++)
        if (k == length || ritz_card_upper(line[k]) != word[k])
            return false;
    if (k < length && isalnum((unsigned char)line[k]))
        return false;
    *rest = line + k;
    return true;
}

static void expand_tabs(const ritz_line *line, ritz_view *out)
{
    int64_t column = 0;

    for (int32_t k = 0; k < line->length && column < RITZ_CARD_COLUMNS; k++) {
        if (line->text[k] != '\t') {
            out->buffer[column++] = line->text[k];
            continue;
        }
        do
            out->buffer[column++] = ' ';
        while (column % 8 != 0);
    }
    out->buffer[column] = '\0';
    out->text = out->buffer;
    out->length = column;
}

void ritz_view_name(const ritz_view *line, const char **text, int64_t *length)
{
    const char *comma = NULL;

    *text = line->text;
    *length = line->length < RITZ_CARD_NAME ? line->length : RITZ_CARD_NAME;
    if (line->free) {
        comma = memchr(line->text, ',', (size_t)line->length);
        *length = comma ? comma - line->text : line->length;
    }
    ritz_card_trim(text, length);
}

void ritz_view_look(const ritz_line *line, ritz_view *out)
{
    enum { FREE_BY = 10 };
    int64_t head = line->length < FREE_BY ? line->length : FREE_BY;
    const char *name = NULL;
    int64_t length = 0;

    out->free = memchr(line->text, ',', (size_t)head) != NULL;
    if (out->free) {
        out->text = line->text;
        out->length = line->length;
    } else {
        expand_tabs(line, out);
    }
    ritz_view_name(out, &name, &length);
    out->continues = length == 0 || *name == '+' || *name == '*';
    if (out->continues)
        out->large = length > 0 && *name == '*';
    else
        out->large = memchr(name, '*', (size_t)length) != NULL;
}

bool ritz_view_item(const ritz_view *line, int64_t k, const char **text,
                    int64_t *length)
{
    const char *at = line->text;
    const char *end = line->text + line->length;

    for (; k > 0; k--) {
        at = memchr(at, ',', (size_t)(end - at));
        if (!at)
            return false;
        at++;
    }
    *text = at;
    at = memchr(at, ',', (size_t)(end - at));
    *length = (at ? at : end) - *text;
    ritz_card_trim(text, length);
    return true;
}

bool ritz_view_is_marker(const char *text, int64_t length)
{
    if (length == 0 || (*text != '+' && *text != '*'))
        return false;
    return length == 1 || *text == '*' || isalpha((unsigned char)text[1]);
}

int64_t ritz_view_items(const ritz_view *line, int64_t *mark)
{
    int64_t width = line->large ? 4 : 8;
    const char *text = NULL;
    int64_t length = 0;
    int64_t count = 0;

    while (count <= width && ritz_view_item(line, count + 1, &text, &length))
        count++;
    *mark = 0;
    if (count > 0)
        (void)ritz_view_item(line, count, &text, &length);
    if (count > width || (count > 0 && ritz_view_is_marker(text, length)))
        *mark = count--;
    return count;
}
