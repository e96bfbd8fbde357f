/* What the fields of a card say: numbers, ids, and refusals of either. */
#include "formats/cards.h"

#include "formats/decimal.h"

#include <ritz/text.h>

#include <math.h>

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
