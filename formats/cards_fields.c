/*
 * A line of bulk data, the fields of a card, and what they say as number or id.
 *
 *     small field   name    8 fields of  8 columns   marker in 73-80
 *     large field   name*   4 fields of 16 columns   marker in 73-80
 *     free field    name,   8 fields (4 if name*)    ,marker
 *
 * A line whose first field is blank, or begins with + or *, continues a card.
 * A comma in the first ten columns makes a line free. A tab goes to the next of
 * columns 9, 17, ... What lies beyond column 80 of a fixed line is not read.
 * Two large lines count as one small: a small line that follows a single large
 * one leaves its four missing fields blank.
 */
#include "formats/cards.h"

#include <math.h>
#include <stdarg.h>
#include <strings.h>

ritz_piece ritz_piece_trim(ritz_piece piece)
{
    while (piece.length > 0 && ritz_card_is_blank(piece.text[piece.length - 1]))
        piece.length--;
    while (piece.length > 0 && ritz_card_is_blank(*piece.text)) {
        piece.text++;
        piece.length--;
    }
    return piece;
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
    ritz_piece piece = ritz_piece_trim((ritz_piece){line, length});
    int64_t size = (int64_t)strlen(word);

    if (piece.length < size ||
        strncasecmp(piece.text, word, (size_t)size) != 0 ||
        (piece.length > size && isalnum((unsigned char)piece.text[size])))
        return false;
    *rest = piece.text + size;
    return true;
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
        item[count] =
            ritz_piece_trim((ritz_piece){at, (comma ? comma : end) - at});
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

    if (!memchr(line->text, '\t', (size_t)line->length)) { /* mostly */
        column =
            line->length < RITZ_CARD_COLUMNS ? line->length : RITZ_CARD_COLUMNS;
        memcpy(out, line->text, (size_t)column);
        out[column] = '\0';
        return column;
    }
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

    take_name(ritz_piece_trim(cut_columns(out, length, 0, RITZ_CARD_NAME)),
              out);
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

/* ---- values ------------------------------------------------------------- */

int ritz_cards_compare_name(const void *name, const void *row)
{
    const char *const *one = row;

    return strcmp(name, *one);
}

ritz_status ritz_cards_refuse(const ritz_cards *cards, int64_t line,
                              const char *format, ...)
{
    const ritz_line *at = &cards->line[line];
    ritz_status status = RITZ_OK;
    va_list args;

    va_start(args, format);
    status =
        ritz_deck_refuse(&cards->files, at->file, at->number, format, args);
    va_end(args);
    return status;
}

const char *ritz_card_text(const ritz_card *card, int64_t k)
{
    return k < card->count ? card->field[k].text : "";
}

ritz_status ritz_card_refuse(const ritz_card *card, int64_t k,
                             const char *wanted)
{
    const char *text = ritz_card_text(card, k);
    int64_t line = k < card->count ? card->field[k].line : card->entry->line;

    if (!*text)
        return ritz_cards_refuse(card->cards, line,
                                 "a field of %s is blank where %s must be",
                                 card->entry->name, wanted);
    return ritz_cards_refuse(card->cards, line, "'%s' in %s is not %s", text,
                             card->entry->name, wanted);
}

ritz_status ritz_card_whole(const ritz_card *card, int64_t k, int64_t blank,
                            int64_t *out)
{
    const char *text = ritz_card_text(card, k);

    if (*text && !ritz_text_whole(text, out))
        return ritz_card_refuse(card, k, "a whole number");
    if (!*text)
        *out = blank;
    return RITZ_OK;
}

ritz_status ritz_card_id(const ritz_card *card, int64_t k, int64_t *out)
{
    static const int64_t MOST_ID = 999999999999999;
    const char *text = ritz_card_text(card, k);

    if (!ritz_text_whole(text, out) || *out <= 0)
        return ritz_card_refuse(card, k, "a positive whole number");
    if (*out > MOST_ID) /* so that one may count beyond it */
        return ritz_card_refuse(card, k, "an id of at most 15 digits");
    return RITZ_OK;
}

ritz_status ritz_card_real(const ritz_card *card, int64_t k, double blank,
                           double *out)
{
    const char *text = ritz_card_text(card, k);

    if (*text && !ritz_card_number(text, out))
        return ritz_card_refuse(card, k, "a number");
    if (!*text)
        *out = blank;
    return RITZ_OK;
}

/* All of a text as a number, and the digits it is written with. */
static bool scan_number(const char *text, ritz_decimal *out)
{
    const char *end = text + strlen(text);

    return ritz_decimal_scan(&text, end, out) && text == end &&
           isfinite(out->value);
}

bool ritz_card_number(const char *text, double *out)
{
    ritz_decimal number = {0};

    if (!scan_number(text, &number))
        return false;
    *out = number.value;
    return true;
}

int64_t ritz_card_digits(const char *text)
{
    ritz_decimal number = {0};

    return scan_number(text, &number) ? number.digits : 0;
}

bool ritz_card_mask(int64_t digits, uint8_t *out)
{
    uint8_t mask = digits == 0 ? 1 : 0;

    if (digits < 0 || digits > 6543210)
        return false;
    for (; digits > 0; digits /= 10) {
        uint8_t bit = (uint8_t)(1U << (unsigned)(digits % 10));

        if (digits % 10 > 6 || (mask & bit) || digits % 10 == 0)
            return false;
        mask |= bit;
    }
    *out = mask;
    return true;
}

ritz_status ritz_card_directions(const ritz_card *card, int64_t k, uint8_t *out)
{
    int64_t digits = 0;

    RITZ_CHECK(ritz_card_whole(card, k, 0, &digits));
    if (!ritz_card_mask(digits, out))
        return ritz_card_refuse(card, k, "a list of directions 1 to 6");
    return RITZ_OK;
}

/* ---- fields ------------------------------------------------------------- */

static ritz_status add_field(ritz_card *card, int64_t line, ritz_piece piece)
{
    ritz_field *field = NULL;

    piece = ritz_piece_trim(piece);
    if (piece.length >= RITZ_CARD_FIELD_SIZE)
        return ritz_cards_refuse(card->cards, line,
                                 "'%.16s...' in %s is too long for a field",
                                 piece.text, card->entry->name);
    RITZ_CHECK_ROOM(card->field, card->count, card->room);
    field = &card->field[card->count++];
    if (piece.length > 0)
        memcpy(field->text, piece.text, (size_t)piece.length);
    field->text[piece.length] = '\0';
    field->line = line;
    return RITZ_OK;
}

/* The name must fill its field alone, or the columns are not what they seem. */
static ritz_status check_name(const ritz_card *card, ritz_piece name)
{
    for (int64_t k = 0; k < name.length; k++)
        if (ritz_card_is_blank(name.text[k]) &&
            name.text[name.length - 1] != '*')
            return ritz_cards_refuse(card->cards, card->entry->line,
                                     "'%.*s' is not the name of a card alone",
                                     (int)(name.length < 20 ? name.length : 20),
                                     name.text);
    return RITZ_OK;
}

ritz_status ritz_card_take(const ritz_cards *cards, int64_t k, ritz_card *card)
{
    ritz_view seen;

    card->cards = cards;
    card->entry = &cards->entry[k];
    card->count = 0;
    for (int64_t at = card->entry->line; at >= 0; at = cards->line[at].next) {
        ritz_view_look(&cards->line[at], &seen);
        if (at == card->entry->line)
            RITZ_CHECK(check_name(card, seen.name));
        while (!seen.large && card->count % 8 != 0)
            RITZ_CHECK(add_field(card, at, (ritz_piece){0}));
        if (seen.overfull)
            return ritz_cards_refuse(cards, at,
                                     "a line of %s has more than %d fields",
                                     card->entry->name, (int)seen.width);
        for (int64_t j = 0; j < seen.width; j++)
            RITZ_CHECK(add_field(card, at, seen.field[j]));
    }
    while (card->count > 0 && !card->field[card->count - 1].text[0])
        card->count--;
    return RITZ_OK;
}

void ritz_card_free(ritz_card *card)
{
    free(card->field);
    *card = (ritz_card){0};
}
