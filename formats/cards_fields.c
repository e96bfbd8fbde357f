/*
 * The fields of a card: how it is taken apart, and what a field says as number
 * or id. Two large lines count as one small: a small line that follows a single
 * large one leaves its four missing fields blank.
 */
#include "formats/cards.h"
#include "formats/cards_lines.h"
#include "formats/decimal.h"

#include <ritz/base.h>

#include <math.h>

/* ---- values ------------------------------------------------------------- */

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

bool ritz_card_is_word(const char *text, const char *word)
{
    for (; *text && *word; text++, word++)
        if (*text != *word && *text - 'a' + 'A' != *word)
            return false;
    return *text == *word;
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

    ritz_card_trim(&piece.text, &piece.length);
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
