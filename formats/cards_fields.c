/*
 * A card taken apart into its fields, line by line. Two large lines count as
 * one small: a small line that follows a single large one leaves its four
 * missing fields blank.
 */
#include "formats/cards_parts.h"

static ritz_status add_field(ritz_card *card, int64_t line, const char *text,
                             int64_t length)
{
    ritz_field *field = NULL;

    ritz_card_trim(&text, &length);
    if (length >= RITZ_CARD_FIELD_SIZE)
        RITZ_CHECK(ritz_cards_refuse(card->cards, line,
                                     "'%.16s...' in %s is too long for a field",
                                     text, card->entry->name));
    RITZ_CHECK_ROOM(card->field, card->count, card->room);
    field = &card->field[card->count++];
    memcpy(field->text, text, (size_t)length);
    field->text[length] = '\0';
    field->line = line;
    return RITZ_OK;
}

/* Whether anything but blanks stands in a free line after item k. */
static bool more_items(const ritz_view *line, int64_t k)
{
    const char *text = NULL;
    int64_t length = 0;

    if (!ritz_view_item(line, k + 1, &text, &length))
        return false;
    for (const char *c = text; c < line->text + line->length; c++)
        if (*c != ',' && !ritz_card_is_blank(*c))
            return true;
    return false;
}

static ritz_status add_free(ritz_card *card, int64_t line,
                            const ritz_view *seen)
{
    int64_t width = seen->large ? 4 : 8;
    const char *text = "";
    int64_t length = 0;
    int64_t mark = 0;
    int64_t count = ritz_view_items(seen, &mark);
    const char *tenth = "";
    int64_t tenth_length = 0;

    if (mark > width)
        (void)ritz_view_item(seen, mark, &tenth, &tenth_length);
    if ((tenth_length > 0 && !ritz_view_is_marker(tenth, tenth_length) &&
         *tenth != '+') ||
        more_items(seen, width + 1))
        RITZ_CHECK(ritz_cards_refuse(card->cards, line,
                                     "a line of %s has more than %d fields",
                                     card->entry->name, (int)width));
    for (int64_t k = 0; k < width; k++) {
        length = 0;
        if (k < count)
            (void)ritz_view_item(seen, k + 1, &text, &length);
        RITZ_CHECK(add_field(card, line, text, length));
    }
    return RITZ_OK;
}

static ritz_status add_fixed(ritz_card *card, int64_t line,
                             const ritz_view *seen)
{
    int64_t width = seen->large ? 16 : 8;

    for (int64_t column = RITZ_CARD_NAME; column < RITZ_CARD_DATA;
         column += width) {
        int64_t length = seen->length - column;

        if (length > width)
            length = width;
        if (length < 0)
            length = 0;
        RITZ_CHECK(
            add_field(card, line, length ? seen->text + column : "", length));
    }
    return RITZ_OK;
}

/* The name must fill its field alone, or the columns are not what they seem. */
static ritz_status check_name(const ritz_card *card, const ritz_view *seen)
{
    const char *name = NULL;
    int64_t length = 0;

    ritz_view_name(seen, &name, &length);
    for (int64_t k = 0; k < length; k++)
        if (ritz_card_is_blank(name[k]) && name[length - 1] != '*')
            RITZ_CHECK(
                ritz_cards_refuse(card->cards, card->entry->line,
                                  "'%.*s' is not the name of a card alone",
                                  (int)(length < 20 ? length : 20), name));
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
            RITZ_CHECK(check_name(card, &seen));
        while (!seen.large && card->count % 8 != 0)
            RITZ_CHECK(add_field(card, at, "", 0));
        if (seen.free)
            RITZ_CHECK(add_free(card, at, &seen));
        else
            RITZ_CHECK(add_fixed(card, at, &seen));
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
