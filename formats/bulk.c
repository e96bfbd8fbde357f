/*
 * NASTRAN bulk data: what its cards say together.
 *
 * The cards may come in any order, so they are first taken as they are written
 * and put together when all are there. Sections behind BEGIN SUPER are read
 * like the main one: what both define alike counts once, what they define
 * otherwise is refused.
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

/* ---- what the case control selects ------------------------------------- */

int ritz_bulk_compare_ids(const void *left, const void *right)
{
    const int64_t *a = left;
    const int64_t *b = right;

    return (*a > *b) - (*a < *b);
}

bool ritz_bulk_selects(const ritz_cards *cards, int64_t which, int64_t set)
{
    return cards->num_selected[which] == 0 ||
           bsearch(&set, cards->selected[which],
                   (size_t)cards->num_selected[which], sizeof set,
                   ritz_bulk_compare_ids);
}

/* Members of selected combinations are selected too; these are not nested. */
static ritz_status complete_selection(ritz_bulk_cards *all, int64_t which)
{
    ritz_cards *cards = &all->cards;
    int64_t given = cards->num_selected[which];
    int64_t *list = NULL;
    int64_t count = given;

    if (given == 0)
        return RITZ_OK;
    qsort(cards->selected[which], (size_t)given, sizeof *cards->selected[which],
          ritz_bulk_compare_ids);
    RITZ_CHECK_NEW(list, given + all->num_sums);
    memcpy(list, cards->selected[which], (size_t)given * sizeof *list);
    for (int64_t k = 0; k < all->num_sums; k++)
        if (all->sum[k].which == which &&
            ritz_bulk_selects(cards, which, all->sum[k].set))
            list[count++] = all->sum[k].member;
    qsort(list, (size_t)count, sizeof *list, ritz_bulk_compare_ids);
    free(cards->selected[which]);
    cards->selected[which] = list;
    cards->num_selected[which] = count;
    return RITZ_OK;
}

/* What is said of an SPC with a motion, once matrices are to obey it. */
static ritz_status note_imposed(const ritz_cards *cards,
                                const ritz_bulk_range *range, ritz_deck *out)
{
    /* the sentence is kept, the failure is not one yet */
    (void)ritz_cards_refuse(cards, range->line,
                            "SPC %" PRId64 " moves '%" PRId64
                            "' by what is not "
                            "zero: imposed motion is no part of a component, "
                            "use a port and an input",
                            range->set, range->from);
    return ritz_bulk_keep_sentence(&out->imposed);
}

/* Keep the SPC cards that act, and add what GRID cards hold fixed. */
static ritz_status settle_fixed(ritz_bulk_cards *all, ritz_deck *out)
{
    ritz_bulk_ranges *spc = &all->ranges[RITZ_BULK_SPC];
    int64_t kept = 0;

    for (int64_t k = 0; k < spc->count; k++) {
        if (!ritz_bulk_selects(&all->cards, RITZ_SELECT_SPC, spc->range[k].set))
            continue;
        if (spc->range[k].imposed && !out->imposed)
            RITZ_CHECK(note_imposed(&all->cards, &spc->range[k], out));
        spc->range[kept++] = spc->range[k];
    }
    spc->count = kept;
    for (int64_t k = 0; k < all->num_grids; k++) {
        const ritz_bulk_grid *grid = &all->grid[k];
        ritz_bulk_range range = {
            .from = grid->id, .to = grid->id, .line = grid->line, .each = true};

        if (grid->spc == 0 || !ritz_bulk_mask(grid->spc, &range.mask))
            continue;
        RITZ_CHECK(ritz_bulk_add_range(spc, range));
    }
    return RITZ_OK;
}

static ritz_status name_constraints(const ritz_bulk_cards *all, ritz_deck *out)
{
    RITZ_CHECK_NEW(out->constraint, all->num_constraints);
    for (int64_t k = 0; k < all->num_constraints; k++) {
        const ritz_bulk_constraint *one = &all->constraint[k];

        if (one->is_set &&
            !ritz_bulk_selects(&all->cards, RITZ_SELECT_MPC, one->id))
            continue;
        snprintf(out->constraint[out->num_constraints++],
                 sizeof *out->constraint, "%s %" PRId64, one->name, one->id);
    }
    return RITZ_OK;
}

static void free_cards(ritz_bulk_cards *all)
{
    ritz_cards_free(&all->cards);
    free(all->grid);
    free(all->frame);
    free(all->sum);
    free(all->constraint);
    free(all->points.range);
    for (int k = 0; k < RITZ_BULK_SETS; k++)
        free(all->ranges[k].range);
}

/* Rows ascend by id: a grid has six dofs, a scalar point one. */
static ritz_status list_dofs(ritz_deck *out)
{
    const ritz_grids *grids = &out->grids;
    int64_t g = 0;
    int64_t p = 0;

    RITZ_CHECK_NEW(out->dof, 6 * grids->count + out->num_points);
    while (g < grids->count || p < out->num_points) {
        bool point = g == grids->count ||
                     (p < out->num_points && out->point[p] < grids->id[g]);

        if (point) {
            out->dof[out->num_dofs++] = (ritz_dof){out->point[p++], 0};
            continue;
        }
        for (int64_t i = 1; i <= 6; i++)
            out->dof[out->num_dofs++] = (ritz_dof){grids->id[g], i};
        g++;
    }
    return RITZ_OK;
}

/* Put together what all cards say. */
static ritz_status build_deck(ritz_bulk_cards *all, ritz_deck *out)
{
    RITZ_CHECK(ritz_bulk_settle_grids(all));
    RITZ_CHECK(ritz_bulk_settle_frames(all));
    RITZ_CHECK(ritz_bulk_resolve_frames(all));
    RITZ_CHECK(ritz_bulk_place_grids(all, &out->grids));
    RITZ_CHECK(ritz_bulk_list_points(all, out));
    RITZ_CHECK(list_dofs(out));
    RITZ_CHECK(complete_selection(all, RITZ_SELECT_SPC));
    RITZ_CHECK(complete_selection(all, RITZ_SELECT_MPC));
    RITZ_CHECK(settle_fixed(all, out));
    RITZ_CHECK(ritz_bulk_list_set(all, &all->ranges[RITZ_BULK_SPC], out,
                                  &out->num_fixed, &out->fixed));
    for (int k = 0; k < 3; k++)
        RITZ_CHECK(ritz_bulk_list_set(all, &all->ranges[k], out,
                                      &out->num_sets[k], &out->set[k]));
    RITZ_CHECK(name_constraints(all, out));
    RITZ_CHECK(ritz_bulk_list_equations(all, out));
    return ritz_bulk_list_elements(all, out);
}

static ritz_status parse_bulk(const char *path, const char *bytes, int64_t size,
                              const char *folder, ritz_deck *out)
{
    ritz_status status = RITZ_OK;
    ritz_bulk_cards all = {.defaults = {.line = -1,
                                        .cp = RITZ_BULK_BLANK,
                                        .cd = RITZ_BULK_BLANK,
                                        .spc = RITZ_BULK_BLANK}};
    ritz_deck deck = {0};

    RITZ_TRY(ritz_cards_parse(path, bytes, size, folder, &all.cards));
    RITZ_TRY(ritz_bulk_take_cards(&all));
    RITZ_TRY(build_deck(&all, &deck));
    *out = deck;
    deck = (ritz_deck){0};
done:
    free_cards(&all);
    ritz_deck_free(&deck);
    return status;
}

/* Any text may be bulk data: comments and unknown cards are passed over. */
static bool is_text(const char *bytes, int64_t size)
{
    return !memchr(bytes, '\0', (size_t)size);
}

const ritz_deck_format ritz_deck_nastran = {
    .name = "bulk",
    .title = "NASTRAN bulk data",
    .reference = "Nastran1986",
    .recognise = is_text,
    .parse = parse_bulk,
};
