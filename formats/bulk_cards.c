/*
 * Which card of bulk data means what. Cards that are not in the table are
 * passed over.
 *
 * [Nastran1986], section 2.4.
 */
#include "formats/bulk_parts.h"

/* How a card is taken; `how` is the table's. */
typedef ritz_status taker(ritz_bulk_cards *all, const ritz_card *card,
                          int32_t how);

static ritz_status take_grid(ritz_bulk_cards *all, const ritz_card *card,
                             int32_t how)
{
    (void)how;
    return ritz_bulk_take_grid(all, card);
}

static ritz_status take_defaults(ritz_bulk_cards *all, const ritz_card *card,
                                 int32_t how)
{
    (void)how;
    return ritz_bulk_take_defaults(all, card);
}

static ritz_status take_by_grids(ritz_bulk_cards *all, const ritz_card *card,
                                 int32_t how)
{
    return ritz_bulk_take_frame(all, card, how, true);
}

static ritz_status take_by_points(ritz_bulk_cards *all, const ritz_card *card,
                                  int32_t how)
{
    return ritz_bulk_take_frame(all, card, how, false);
}

bool ritz_bulk_is_word(const char *text, const char *word)
{
    for (; *text && *word; text++, word++)
        if (*text != *word && *text - 'a' + 'A' != *word)
            return false;
    return *text == *word;
}

/* 1, 3, 5 THRU 9 from field k of a card, each part as `range`; or ALL. */
static ritz_status take_list(const ritz_card *card, int64_t k,
                             ritz_bulk_range range, ritz_bulk_ranges *out)
{
    for (; k < card->count; k++) {
        if (!*ritz_card_text(card, k))
            continue;
        range.each = !ritz_bulk_is_word(ritz_card_text(card, k), "ALL");
        range.from = 1;
        range.to = INT64_MAX - 1;
        if (range.each) {
            RITZ_CHECK(ritz_card_id(card, k, &range.from));
            range.to = range.from;
        }
        if (range.each &&
            ritz_bulk_is_word(ritz_card_text(card, k + 1), "THRU")) {
            range.each = false;
            k += 2;
            RITZ_CHECK(ritz_card_id(card, k, &range.to));
            if (range.to < range.from)
                RITZ_CHECK(
                    ritz_card_refuse(card, k, "at or above where THRU begins"));
        }
        RITZ_CHECK(ritz_bulk_add_range(out, range));
    }
    return RITZ_OK;
}

static ritz_status take_points(ritz_bulk_cards *all, const ritz_card *card,
                               int32_t how)
{
    (void)how;
    for (int64_t k = 0; k < card->count; k++)
        if (ritz_bulk_is_word(ritz_card_text(card, k), "ALL"))
            return ritz_card_refuse(card, k, "a positive whole number");
    return take_list(card, 0,
                     (ritz_bulk_range){.line = card->entry->line, .mask = 1},
                     &all->points);
}

static ritz_status take_directions(const ritz_card *card, int64_t k,
                                   uint8_t *out)
{
    int64_t digits = 0;

    RITZ_CHECK(ritz_card_whole(card, k, 0, &digits));
    if (!ritz_bulk_mask(digits, out))
        RITZ_CHECK(ritz_card_refuse(card, k, "a list of directions 1 to 6"));
    return RITZ_OK;
}

/* SPC cards have a set id in front of what those of other sets have. */
static ritz_status take_sid(const ritz_card *card, int32_t how, int64_t *next,
                            int64_t *out)
{
    *next = 0;
    if (how != RITZ_BULK_SPC)
        return RITZ_OK;
    RITZ_CHECK(ritz_card_id(card, 0, out));
    *next = 1;
    return RITZ_OK;
}

/* ASET: ID C, four times. SPC: SID, then G C D, twice. */
static ritz_status take_pairs(ritz_bulk_cards *all, const ritz_card *card,
                              int32_t how)
{
    ritz_bulk_range range = {.line = card->entry->line, .each = true};
    int64_t width = how == RITZ_BULK_SPC ? 3 : 2;
    int64_t first = 0;
    double motion = 0.0;

    RITZ_CHECK(take_sid(card, how, &first, &range.set));
    for (int64_t k = first; k < card->count; k += width) {
        if (!*ritz_card_text(card, k) && !*ritz_card_text(card, k + 1))
            continue;
        RITZ_CHECK(ritz_card_id(card, k, &range.from));
        range.to = range.from;
        RITZ_CHECK(take_directions(card, k + 1, &range.mask));
        if (how == RITZ_BULK_SPC)
            RITZ_CHECK(ritz_card_real(card, k + 2, 0.0, &motion));
        range.imposed = motion != 0.0;
        RITZ_CHECK(ritz_bulk_add_range(&all->ranges[how], range));
    }
    return RITZ_OK;
}

/* ASET1: C, then a list. SPC1: SID C, then a list. */
static ritz_status take_set(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_bulk_range range = {.line = card->entry->line};
    int64_t first = 0;

    RITZ_CHECK(take_sid(card, how, &first, &range.set));
    RITZ_CHECK(take_directions(card, first, &range.mask));
    return take_list(card, first + 1, range, &all->ranges[how]);
}

/* SPCADD, MPCADD: SID, then sets. */
static ritz_status take_sum(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_bulk_sum sum = {.which = how};

    RITZ_CHECK(ritz_card_id(card, 0, &sum.set));
    for (int64_t k = 1; k < card->count; k++) {
        if (!*ritz_card_text(card, k))
            continue;
        RITZ_CHECK(ritz_card_id(card, k, &sum.member));
        RITZ_CHECK_ROOM(all->sum, all->num_sums, all->sums_room);
        all->sum[all->num_sums++] = sum;
    }
    return RITZ_OK;
}

static ritz_status take_constraint(ritz_bulk_cards *all, const ritz_card *card,
                                   int32_t how)
{
    ritz_bulk_constraint new = {.is_set = how,
                                .entry = card->entry - all->cards.entry};

    RITZ_CHECK(ritz_card_id(card, 0, &new.id));
    memcpy(new.name, card->entry->name, sizeof new.name);
    RITZ_CHECK_ROOM(all->constraint, all->num_constraints,
                    all->constraints_room);
    all->constraint[all->num_constraints++] = new;
    return RITZ_OK;
}

/* What each card is; sorted by name. */
static const struct kind {
    const char *name;
    taker *take;
    int32_t how;
} KINDS[] = {
    {"ASET", take_pairs, RITZ_SET_A},
    {"ASET1", take_set, RITZ_SET_A},
    {"BNDFIX", take_pairs, RITZ_SET_B},
    {"BNDFIX1", take_set, RITZ_SET_B},
    {"BSET", take_pairs, RITZ_SET_B},
    {"BSET1", take_set, RITZ_SET_B},
    {"CORD1C", take_by_grids, RITZ_CYLINDRICAL},
    {"CORD1R", take_by_grids, RITZ_RECTANGULAR},
    {"CORD1S", take_by_grids, RITZ_SPHERICAL},
    {"CORD2C", take_by_points, RITZ_CYLINDRICAL},
    {"CORD2R", take_by_points, RITZ_RECTANGULAR},
    {"CORD2S", take_by_points, RITZ_SPHERICAL},
    {"CRBAR", take_constraint, false},
    {"CRBE1", take_constraint, false},
    {"CRBE2", take_constraint, false},
    {"CRBE3", take_constraint, false},
    {"CRIGD1", take_constraint, false},
    {"CRIGD2", take_constraint, false},
    {"CRIGD3", take_constraint, false},
    {"CRIGDR", take_constraint, false},
    {"CRROD", take_constraint, false},
    {"CRSPLINE", take_constraint, false},
    {"CRTRPLT", take_constraint, false},
    {"GRDSET", take_defaults, 0},
    {"GRID", take_grid, 0},
    {"MPC", take_constraint, true},
    {"MPCADD", take_sum, RITZ_SELECT_MPC},
    {"QSET", take_pairs, RITZ_SET_Q},
    {"QSET1", take_set, RITZ_SET_Q},
    {"RBAR", take_constraint, false},
    {"RBAR1", take_constraint, false},
    {"RBE1", take_constraint, false},
    {"RBE2", take_constraint, false},
    {"RBE2GS", take_constraint, false},
    {"RBE3", take_constraint, false},
    {"RJOINT", take_constraint, false},
    {"RROD", take_constraint, false},
    {"RSPLINE", take_constraint, false},
    {"RSSCON", take_constraint, false},
    {"RTRPLT", take_constraint, false},
    {"RTRPLT1", take_constraint, false},
    {"SPC", take_pairs, RITZ_BULK_SPC},
    {"SPC1", take_set, RITZ_BULK_SPC},
    {"SPCADD", take_sum, RITZ_SELECT_SPC},
    {"SPOINT", take_points, 0},
};

static int compare_name(const void *name, const void *kind)
{
    const struct kind *one = kind;

    return strcmp(name, one->name);
}

ritz_status ritz_bulk_take_cards(ritz_bulk_cards *all)
{
    ritz_status status = RITZ_OK;
    ritz_card card = {0};

    for (int64_t k = 0; k < all->cards.num_entries; k++) {
        const struct kind *kind =
            bsearch(all->cards.entry[k].name, KINDS,
                    sizeof KINDS / sizeof *KINDS, sizeof *KINDS, compare_name);

        if (!kind)
            continue;
        RITZ_TRY(ritz_card_take(&all->cards, k, &card));
        RITZ_TRY(kind->take(all, &card, kind->how));
    }
done:
    ritz_card_free(&card);
    return status;
}
