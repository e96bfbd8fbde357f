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

static ritz_piece trim_piece(const char *text, const char *end)
{
    ritz_piece piece = {text, end - text};

    ritz_card_trim(&piece.text, &piece.length);
    return piece;
}

/* The name says how the line is to be read. */
static void take_name(ritz_piece name, ritz_view *out)
{
    bool star = name.length > 0 && *name.text == '*';

    out->name = name;
    out->continues = star || name.length == 0 || *name.text == '+';
    out->large = star || (!out->continues &&
                          memchr(name.text, '*', (size_t)name.length) != NULL);
    out->width = out->large ? 4 : 8;
}

/* True if an item is a marker, +C1 or *, rather than a number. */
static bool is_marker(ritz_piece item)
{
    if (item.length == 0 || (*item.text != '+' && *item.text != '*'))
        return false;
    return item.length == 1 || *item.text == '*' ||
           isalpha((unsigned char)item.text[1]);
}

/* Items of a free line are data up to the ninth, or to a marker that ends the
 * line before. */
static void split_free(const ritz_line *line, ritz_view *out)
{
    enum { MOST = 10 }; /* a name, data, a marker */
    ritz_piece item[MOST];
    const char *at = line->text;
    const char *end = at + line->length;
    const char *comma = NULL;
    int64_t count = 0;

    do {
        comma = memchr(at, ',', (size_t)(end - at));
        item[count] = trim_piece(at, comma ? comma : end);
        if (count++ == 0)
            take_name(item[0], out);
        at = comma ? comma + 1 : end;
    } while (comma && count < out->width + 2);
    if (count > 1 && (count > out->width + 1 || is_marker(item[count - 1])))
        out->marker = item[--count];
    memcpy(out->field, item + 1, (size_t)(count - 1) * sizeof *item);
    out->overfull = out->marker.length > 0 && !is_marker(out->marker) &&
                    *out->marker.text != '+';
    for (; at < end; at++)
        out->overfull =
            out->overfull || (*at != ',' && !ritz_card_is_blank(*at));
}

static int64_t expand_tabs(const ritz_line *line, char *out)
{
    int64_t column = 0;

    for (int32_t k = 0; k < line->length && column < RITZ_CARD_COLUMNS; k++) {
        if (line->text[k] != '\t') {
            out[column++] = line->text[k];
            continue;
        }
        do
            out[column++] = ' ';
        while (column % 8 != 0);
    }
    out[column] = '\0';
    return column;
}

static ritz_piece cut_columns(const ritz_view *line, int64_t length,
                              int64_t from, int64_t to)
{
    to = to < length ? to : length;
    return (ritz_piece){line->buffer + from, to > from ? to - from : 0};
}

static void split_fixed(const ritz_line *line, ritz_view *out)
{
    int64_t length = expand_tabs(line, out->buffer);
    ritz_piece name = cut_columns(out, length, 0, RITZ_CARD_NAME);

    take_name(trim_piece(name.text, name.text + name.length), out);
    for (int64_t k = 0; k < out->width; k++) {
        int64_t size = (RITZ_CARD_DATA - RITZ_CARD_NAME) / out->width;
        int64_t from = RITZ_CARD_NAME + k * size;

        out->field[k] = cut_columns(out, length, from, from + size);
    }
    out->marker = cut_columns(out, length, RITZ_CARD_DATA, RITZ_CARD_COLUMNS);
}

void ritz_view_look(const ritz_line *line, ritz_view *out)
{
    enum { FREE_BY = 10 };
    int64_t head = line->length < FREE_BY ? line->length : FREE_BY;

    out->free = memchr(line->text, ',', (size_t)head) != NULL;
    out->overfull = false;
    out->marker = (ritz_piece){0};
    memset(out->field, 0, sizeof out->field);
    if (out->free)
        split_free(line, out);
    else
        split_fixed(line, out);
}
