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

bool ritz_bulk_selects(const ritz_deck *deck, int64_t which, int64_t set)
{
    return deck->num_selected[which] == 0 ||
           bsearch(&set, deck->selected[which],
                   (size_t)deck->num_selected[which], sizeof set,
                   ritz_bulk_compare_ids);
}

/* Members of selected combinations are selected too; these are not nested. */
static ritz_status complete_selection(ritz_bulk_cards *all, int64_t which)
{
    ritz_deck *deck = &all->deck;
    int64_t given = deck->num_selected[which];
    int64_t *list = NULL;
    int64_t count = given;

    if (given == 0)
        return RITZ_OK;
    qsort(deck->selected[which], (size_t)given, sizeof *deck->selected[which],
          ritz_bulk_compare_ids);
    RITZ_CHECK_NEW(list, given + all->num_sums);
    memcpy(list, deck->selected[which], (size_t)given * sizeof *list);
    for (int64_t k = 0; k < all->num_sums; k++)
        if (all->sum[k].which == which &&
            ritz_bulk_selects(deck, which, all->sum[k].set))
            list[count++] = all->sum[k].member;
    qsort(list, (size_t)count, sizeof *list, ritz_bulk_compare_ids);
    free(deck->selected[which]);
    deck->selected[which] = list;
    deck->num_selected[which] = count;
    return RITZ_OK;
}

/* What is said of an SPC with a motion, once matrices are to obey it. */
static ritz_status note_imposed(const ritz_deck *deck,
                                const ritz_bulk_range *range, ritz_bulk *out)
{
    /* the sentence is kept, the failure is not one yet */
    (void)ritz_deck_refuse(deck, range->line,
                           "SPC %" PRId64 " moves '%" PRId64 "' by what is not "
                           "zero: imposed motion is no part of a component, "
                           "use a port and an input",
                           range->set, range->from);
    return ritz_bulk_keep_sentence(&out->imposed);
}

/* Keep the SPC cards that act, and add what GRID cards hold fixed. */
static ritz_status settle_fixed(ritz_bulk_cards *all, ritz_bulk *out)
{
    ritz_bulk_ranges *spc = &all->ranges[RITZ_BULK_SPC];
    int64_t kept = 0;

    for (int64_t k = 0; k < spc->count; k++) {
        if (!ritz_bulk_selects(&all->deck, RITZ_SELECT_SPC, spc->range[k].set))
            continue;
        if (spc->range[k].imposed && !out->imposed)
            RITZ_CHECK(note_imposed(&all->deck, &spc->range[k], out));
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

static ritz_status name_constraints(const ritz_bulk_cards *all, ritz_bulk *out)
{
    RITZ_CHECK_NEW(out->constraint, all->num_constraints);
    for (int64_t k = 0; k < all->num_constraints; k++) {
        const ritz_bulk_constraint *one = &all->constraint[k];

        if (one->is_set &&
            !ritz_bulk_selects(&all->deck, RITZ_SELECT_MPC, one->id))
            continue;
        snprintf(out->constraint[out->num_constraints++],
                 sizeof *out->constraint, "%s %" PRId64, one->name, one->id);
    }
    return RITZ_OK;
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
    RITZ_CHECK(ritz_bulk_settle_grids(all));
    RITZ_CHECK(ritz_bulk_settle_frames(all));
    RITZ_CHECK(ritz_bulk_resolve_frames(all));
    RITZ_CHECK(ritz_bulk_place_grids(all, &out->grids));
    RITZ_CHECK(ritz_bulk_list_points(all, out));
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
    RITZ_TRY(ritz_bulk_take_cards(&all));
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
    char *text = NULL;
    char *folder = NULL;

    RITZ_TRY(ritz_deck_folder(path, &folder));
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
    ritz_equations_free(&bulk->equations);
    ritz_elements_free(&bulk->elements);
    free(bulk->imposed);
    *bulk = (ritz_bulk){0};
}
