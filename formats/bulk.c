/*
 * NASTRAN bulk data: which card means what, and what they say together.
 *
 * The cards may come in any order, so they are first taken as they are written
 * and put together when all are there. Cards that are not in the table are
 * passed over. Sections behind BEGIN SUPER are read like the main one: what
 * both define alike counts once, what they define otherwise is refused.
 *
 * SPC and MPC cards act if the case control selects their set, alone or by way
 * of SPCADD and MPCADD; where it selects none, all of them are taken to act.
 *
 * [Nastran1986], section 2.4.
 */
#include "formats/bulk_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>

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

static bool is_word(const char *text, const char *word)
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
    ritz_status status = RITZ_OK;

    for (; k < card->count; k++) {
        if (!*ritz_card_text(card, k))
            continue;
        range.each = !is_word(ritz_card_text(card, k), "ALL");
        range.from = 1;
        range.to = INT64_MAX - 1;
        if (range.each) {
            RITZ_TRY(ritz_card_id(card, k, &range.from));
            range.to = range.from;
        }
        if (range.each && is_word(ritz_card_text(card, k + 1), "THRU")) {
            range.each = false;
            k += 2;
            RITZ_TRY(ritz_card_id(card, k, &range.to));
            if (range.to < range.from)
                RITZ_TRY(
                    ritz_card_refuse(card, k, "at or above where THRU begins"));
        }
        RITZ_TRY(ritz_bulk_add_range(out, range));
    }
done:
    return status;
}

static ritz_status take_points(ritz_bulk_cards *all, const ritz_card *card,
                               int32_t how)
{
    (void)how;
    for (int64_t k = 0; k < card->count; k++)
        if (is_word(ritz_card_text(card, k), "ALL"))
            return ritz_card_refuse(card, k, "a positive whole number");
    return take_list(card, 0,
                     (ritz_bulk_range){.line = card->entry->line, .mask = 1},
                     &all->points);
}

static ritz_status take_directions(const ritz_card *card, int64_t k,
                                   uint8_t *out)
{
    ritz_status status = RITZ_OK;
    int64_t digits = 0;

    RITZ_TRY(ritz_card_whole(card, k, 0, &digits));
    if (!ritz_bulk_mask(digits, out))
        RITZ_TRY(ritz_card_refuse(card, k, "a list of directions 1 to 6"));
done:
    return status;
}

/* ASET: ID C, four times. */
static ritz_status take_pairs(ritz_bulk_cards *all, const ritz_card *card,
                              int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_range range = {.line = card->entry->line, .each = true};

    for (int64_t k = 0; k < card->count; k += 2) {
        if (!*ritz_card_text(card, k) && !*ritz_card_text(card, k + 1))
            continue;
        RITZ_TRY(ritz_card_id(card, k, &range.from));
        range.to = range.from;
        RITZ_TRY(take_directions(card, k + 1, &range.mask));
        RITZ_TRY(ritz_bulk_add_range(&all->ranges[how], range));
    }
done:
    return status;
}

/* ASET1: C, then a list. */
static ritz_status take_set(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_range range = {.line = card->entry->line};

    RITZ_TRY(take_directions(card, 0, &range.mask));
    RITZ_TRY(take_list(card, 1, range, &all->ranges[how]));
done:
    return status;
}

/* SPC: SID, then G C D, twice. */
static ritz_status take_spc(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_range range = {.line = card->entry->line, .each = true};

    RITZ_TRY(ritz_card_id(card, 0, &range.set));
    for (int64_t k = 1; k < card->count; k += 3) {
        if (!*ritz_card_text(card, k) && !*ritz_card_text(card, k + 1))
            continue;
        RITZ_TRY(ritz_card_id(card, k, &range.from));
        range.to = range.from;
        RITZ_TRY(take_directions(card, k + 1, &range.mask));
        RITZ_TRY(ritz_bulk_add_range(&all->ranges[how], range));
    }
done:
    return status;
}

/* SPC1: SID C, then a list. */
static ritz_status take_spc1(ritz_bulk_cards *all, const ritz_card *card,
                             int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_range range = {.line = card->entry->line};

    RITZ_TRY(ritz_card_id(card, 0, &range.set));
    RITZ_TRY(take_directions(card, 1, &range.mask));
    RITZ_TRY(take_list(card, 2, range, &all->ranges[how]));
done:
    return status;
}

/* SPCADD, MPCADD: SID, then sets. */
static ritz_status take_sum(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_sum sum = {.which = how};

    RITZ_TRY(ritz_card_id(card, 0, &sum.set));
    for (int64_t k = 1; k < card->count; k++) {
        if (!*ritz_card_text(card, k))
            continue;
        RITZ_TRY(ritz_card_id(card, k, &sum.member));
        RITZ_ROOM(all->sum, all->num_sums, all->sums_room);
        all->sum[all->num_sums++] = sum;
    }
done:
    return status;
}

static ritz_status take_constraint(ritz_bulk_cards *all, const ritz_card *card,
                                   int32_t how)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_constraint new = {.is_set = how};

    RITZ_TRY(ritz_card_id(card, 0, &new.id));
    memcpy(new.name, card->entry->name, sizeof new.name);
    RITZ_ROOM(all->constraint, all->num_constraints, all->constraints_room);
    all->constraint[all->num_constraints++] = new;
done:
    return status;
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
    {"SPC", take_spc, RITZ_BULK_SPC},
    {"SPC1", take_spc1, RITZ_BULK_SPC},
    {"SPCADD", take_sum, RITZ_SELECT_SPC},
    {"SPOINT", take_points, 0},
};

static int compare_name(const void *name, const void *kind)
{
    const struct kind *one = kind;

    return strcmp(name, one->name);
}

static ritz_status take_cards(ritz_bulk_cards *all)
{
    ritz_status status = RITZ_OK;
    ritz_card card = {0};

    for (int64_t k = 0; k < all->deck.num_entries; k++) {
        const struct kind *kind =
            bsearch(all->deck.entry[k].name, KINDS,
                    sizeof KINDS / sizeof *KINDS, sizeof *KINDS, compare_name);

        if (!kind)
            continue;
        RITZ_TRY(ritz_deck_card(&all->deck, k, &card));
        RITZ_TRY(kind->take(all, &card, kind->how));
    }
done:
    ritz_card_free(&card);
    return status;
}

/* ---- what the case control selects ------------------------------------- */

static int compare_ids(const void *a, const void *b)
{
    const int64_t *left = a;
    const int64_t *right = b;

    return (*left > *right) - (*left < *right);
}

static bool selects(const ritz_deck *deck, int64_t which, int64_t set)
{
    return deck->num_selected[which] == 0 ||
           bsearch(&set, deck->selected[which],
                   (size_t)deck->num_selected[which], sizeof set, compare_ids);
}

/* Members of selected combinations are selected too; these are not nested. */
static ritz_status complete_selection(ritz_bulk_cards *all, int64_t which)
{
    ritz_status status = RITZ_OK;
    ritz_deck *deck = &all->deck;
    int64_t given = deck->num_selected[which];
    int64_t *list = NULL;
    int64_t count = given;

    if (given == 0)
        goto done;
    qsort(deck->selected[which], (size_t)given, sizeof *deck->selected[which],
          compare_ids);
    RITZ_NEW(list, given + all->num_sums);
    memcpy(list, deck->selected[which], (size_t)given * sizeof *list);
    for (int64_t k = 0; k < all->num_sums; k++)
        if (all->sum[k].which == which && selects(deck, which, all->sum[k].set))
            list[count++] = all->sum[k].member;
    qsort(list, (size_t)count, sizeof *list, compare_ids);
    free(deck->selected[which]);
    deck->selected[which] = list;
    deck->num_selected[which] = count;
done:
    return status;
}

/* Keep the SPC cards that act, and add what GRID cards hold fixed. */
static ritz_status settle_fixed(ritz_bulk_cards *all)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_ranges *spc = &all->ranges[RITZ_BULK_SPC];
    int64_t kept = 0;

    for (int64_t k = 0; k < spc->count; k++)
        if (selects(&all->deck, RITZ_SELECT_SPC, spc->range[k].set))
            spc->range[kept++] = spc->range[k];
    spc->count = kept;
    for (int64_t k = 0; k < all->num_grids; k++) {
        const ritz_bulk_grid *grid = &all->grid[k];
        ritz_bulk_range range = {
            .from = grid->id, .to = grid->id, .line = grid->line, .each = true};

        if (grid->spc == 0 || !ritz_bulk_mask(grid->spc, &range.mask))
            continue;
        RITZ_TRY(ritz_bulk_add_range(spc, range));
    }
done:
    return status;
}

static ritz_status name_constraints(const ritz_bulk_cards *all, ritz_bulk *out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->constraint, all->num_constraints);
    for (int64_t k = 0; k < all->num_constraints; k++) {
        const ritz_bulk_constraint *one = &all->constraint[k];

        if (one->is_set && !selects(&all->deck, RITZ_SELECT_MPC, one->id))
            continue;
        snprintf(out->constraint[out->num_constraints++],
                 sizeof *out->constraint, "%s %" PRId64, one->name, one->id);
    }
done:
    return status;
}

static void free_cards(ritz_bulk_cards *all)
{
    ritz_deck_free(&all->deck);
    free(all->grid);
    free(all->frame);
    free(all->sum);
    free(all->constraint);
    free(all->points.range);
    for (int k = 0; k < RITZ_BULK_SETS; k++)
        free(all->ranges[k].range);
}

/* Put together what all cards say. */
static ritz_status build(ritz_bulk_cards *all, ritz_bulk *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_bulk_settle_grids(all));
    RITZ_TRY(ritz_bulk_settle_frames(all));
    RITZ_TRY(ritz_bulk_resolve_frames(all));
    RITZ_TRY(ritz_bulk_place_grids(all, &out->grids));
    RITZ_TRY(ritz_bulk_list_points(all, out));
    RITZ_TRY(complete_selection(all, RITZ_SELECT_SPC));
    RITZ_TRY(complete_selection(all, RITZ_SELECT_MPC));
    RITZ_TRY(settle_fixed(all));
    RITZ_TRY(ritz_bulk_list_set(all, &all->ranges[RITZ_BULK_SPC], out,
                                &out->num_fixed, &out->fixed));
    for (int k = 0; k < 3; k++)
        RITZ_TRY(ritz_bulk_list_set(all, &all->ranges[k], out,
                                    &out->num_sets[k], &out->set[k]));
    RITZ_TRY(name_constraints(all, out));
done:
    return status;
}

ritz_status ritz_bulk_parse(const char *path, const char *text,
                            const char *folder, ritz_bulk *out)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_cards all = {.defaults = {.line = -1,
                                        .cp = RITZ_BULK_BLANK,
                                        .cd = RITZ_BULK_BLANK,
                                        .spc = RITZ_BULK_BLANK}};
    ritz_bulk bulk = {0};

    RITZ_TRY(
        ritz_deck_parse(path, text, (int64_t)strlen(text), folder, &all.deck));
    RITZ_TRY(take_cards(&all));
    RITZ_TRY(build(&all, &bulk));
    *out = bulk;
    bulk = (ritz_bulk){0};
done:
    free_cards(&all);
    ritz_bulk_free(&bulk);
    return status;
}

ritz_status ritz_bulk_read(const char *path, ritz_bulk *out)
{
    ritz_status status = RITZ_OK;
    const char *slash = strrchr(path, '/');
    char *text = NULL;
    char *folder = NULL;

    RITZ_NEW(folder, (int64_t)strlen(path) + 2);
    if (slash)
        memcpy(folder, path, slash == path ? 1 : (size_t)(slash - path));
    else
        folder[0] = '.';
    RITZ_TRY(ritz_text_read(path, &text));
    RITZ_TRY(ritz_bulk_parse(path, text, folder, out));
done:
    free(text);
    free(folder);
    return status;
}

void ritz_bulk_free(ritz_bulk *bulk)
{
    ritz_grids_free(&bulk->grids);
    free(bulk->point);
    free(bulk->fixed);
    for (int k = 0; k < 3; k++)
        free(bulk->set[k]);
    free(bulk->constraint);
    *bulk = (ritz_bulk){0};
}
