/* DMIG cards one by one: headers by name, and the terms of their columns. */
#include "formats/dmig_parts.h"

#include "base/tolerances.h"

#include <ctype.h>
#include <math.h>

static int compare_names(const void *a, const void *b)
{
    const ritz_dmig_header *left = a;
    const ritz_dmig_header *right = b;

    return strcmp(left->name, right->name);
}

static char upper(char letter)
{
    return (char)toupper((unsigned char)letter);
}

static ritz_status take_name(const ritz_card *card, char out[RITZ_NAME_SIZE])
{
    const char *name = ritz_card_text(card, 0);
    size_t k = 0;

    if (!isalpha((unsigned char)*name))
        return ritz_card_refuse(card, 0, "the name of a matrix");
    for (; name[k]; k++) {
        if (iscntrl((unsigned char)name[k]) || name[k] == '/')
            return ritz_card_refuse(card, 0, "the name of a matrix");
        out[k] = upper(name[k]);
    }
    out[k] = '\0';
    return RITZ_OK;
}

/* The header has 0 where columns have a grid; a blank is a header's too. */
static bool is_header(const ritz_card *card)
{
    const char *grid = ritz_card_text(card, 1);

    return strcmp(grid, "0") == 0 || !*grid;
}

static ritz_status add_header(ritz_dmig_cards *all, const ritz_card *card)
{
    ritz_dmig_header new = {.line = card->entry->line,
                            .rank = all->num_headers};
    int64_t type = 0;
    int64_t polar = 0;

    RITZ_CHECK(take_name(card, new.name));
    RITZ_CHECK(ritz_card_whole(card, 2, 0, &new.form));
    RITZ_CHECK(ritz_card_whole(card, 3, 0, &type));
    RITZ_CHECK(ritz_card_whole(card, 5, 0, &polar));
    if (new.form != RITZ_DMIG_SQUARE &&new.form != RITZ_DMIG_WIDE &&new.form !=
        RITZ_DMIG_SYMMETRIC &&new.form != RITZ_DMIG_COLUMNS)
        RITZ_CHECK(ritz_card_refuse(card, 2, "a form: 1, 2, 6 or 9"));
    if (type < 1 || type > 4)
        RITZ_CHECK(ritz_card_refuse(card, 3, "a type: 1, 2, 3 or 4"));
    if (polar != 0 && polar != 1)
        RITZ_CHECK(ritz_card_refuse(card, 5, "0 or 1 for POLAR"));
    new.complex = type > 2;
    new.polar = polar == 1;
    RITZ_CHECK_ROOM(all->header, all->num_headers, all->headers_room);
    all->header[all->num_headers++] = new;
    return RITZ_OK;
}

static ritz_status sort_headers(ritz_dmig_cards *all)
{
    if (all->num_headers > 1)
        qsort(all->header, (size_t)all->num_headers, sizeof *all->header,
              compare_names);
    for (int64_t k = 1; k < all->num_headers; k++)
        if (compare_names(&all->header[k - 1], &all->header[k]) == 0)
            RITZ_CHECK(ritz_cards_refuse(&all->cards, all->header[k].line,
                                         "DMIG '%s' has a second header",
                                         all->header[k].name));
    return RITZ_OK;
}

static ritz_status take_dof(const ritz_card *card, int64_t k, ritz_dof *out)
{
    RITZ_CHECK(ritz_card_id(card, k, &out->grid));
    RITZ_CHECK(ritz_card_whole(card, k + 1, 0, &out->component));
    if (out->component < 0 || out->component > 6)
        RITZ_CHECK(ritz_card_refuse(card, k + 1, "a direction, 0 to 6"));
    return RITZ_OK;
}

static bool is_empty_group(const ritz_card *card, int64_t k)
{
    for (int64_t j = k; j < k + 4; j++)
        if (*ritz_card_text(card, j))
            return false;
    return true;
}

/* G C A B at field k. */
static ritz_status add_term(ritz_dmig_cards *all, ritz_dmig_header *owner,
                            const ritz_card *card, int64_t k, ritz_dof col)
{
    static const double RADIANS = RITZ_PI / 180.0;
    ritz_dmig_term new = {.col = col, .matrix = owner - all->header};
    double a = 0.0;
    double b = 0.0;
    int64_t digits = 0;

    RITZ_CHECK(take_dof(card, k, &new.row));
    RITZ_CHECK(ritz_card_real(card, k + 2, 0.0, &a));
    RITZ_CHECK(ritz_card_real(card, k + 3, 0.0, &b));
    if (!owner->complex && b != 0.0)
        RITZ_CHECK(
            ritz_card_refuse(card, k + 3, "blank, as it is in a real matrix"));
    new.line = card->field[k].line;
    new.re = owner->polar ? a *cos(b * RADIANS) : a;
    new.im = owner->polar ? a *sin(b * RADIANS) : b;
    for (int64_t j = k + 2; j < k + 4; j++) {
        digits = ritz_card_digits(ritz_card_text(card, j));
        if (digits > owner->digits)
            owner->digits = digits;
    }
    RITZ_CHECK_ROOM(all->term, all->num_terms, all->terms_room);
    all->term[all->num_terms++] = new;
    owner->count++;
    return RITZ_OK;
}

static ritz_status add_column(ritz_dmig_cards *all, const ritz_card *card)
{
    ritz_status status = RITZ_OK;
    ritz_dmig_header wanted = {0};
    ritz_dmig_header *owner = NULL;
    ritz_dof col = {0};

    RITZ_TRY(take_name(card, wanted.name));
    if (all->num_headers > 0)
        owner = bsearch(&wanted, all->header, (size_t)all->num_headers,
                        sizeof wanted, compare_names);
    if (!owner) {
        status = ritz_cards_refuse(&all->cards, card->entry->line,
                                   "DMIG '%s' has no header", wanted.name);
        goto done;
    }
    RITZ_TRY(take_dof(card, 1, &col));
    for (int64_t k = 4; k < card->count; k += 4)
        if (!is_empty_group(card, k))
            RITZ_TRY(add_term(all, owner, card, k, col));
done:
    return status;
}

/* Go through the DMIG cards: headers first, as they may follow columns. */
static ritz_status take_cards(ritz_dmig_cards *all, bool headers)
{
    ritz_status status = RITZ_OK;
    ritz_card card = {0};

    for (int64_t k = 0; k < all->cards.num_entries; k++) {
        if (strcmp(all->cards.entry[k].name, "DMIG") != 0)
            continue;
        RITZ_TRY(ritz_card_take(&all->cards, k, &card));
        if (is_header(&card) != headers)
            continue;
        if (headers)
            RITZ_TRY(add_header(all, &card));
        else
            RITZ_TRY(add_column(all, &card));
    }
done:
    ritz_card_free(&card);
    return status;
}

ritz_status ritz_dmig_take(ritz_dmig_cards *all)
{
    RITZ_CHECK(take_cards(all, true));
    RITZ_CHECK(sort_headers(all));
    return take_cards(all, false);
}
