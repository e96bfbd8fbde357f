/*
 * Sets of dofs in bulk data: lists of grids, THRU ranges, directions.
 *
 * A grid that is named counts whether the deck defines it or not. THRU and ALL
 * mean those of the range that exist: grids where directions are given, scalar
 * points where none are. Ranges may overlap as much as they like: they are
 * merged direction by direction, so the work grows with what comes out.
 */
#include "formats/bulk.h"

#include "base/alloc.h"
#include "base/search.h"

#include <inttypes.h>

enum { MOST_IDS = 10000000 }; /* that ranges alone may stand for */

void ritz_bulk_ranges_free(ritz_bulk_ranges *list)
{
    free(list->range);
}

ritz_status ritz_bulk_add_range(ritz_bulk_ranges *list, ritz_bulk_range range)
{
    RITZ_CHECK_ROOM(list->range, list->count, list->room);
    list->range[list->count++] = range;
    return RITZ_OK;
}

static bool has_direction(const ritz_bulk_range *range, int64_t c)
{
    return (((unsigned)range->mask >> (unsigned)c) & 1U) != 0;
}

/* Ranges of direction c, less dofs that are named one by one unless `named`;
 * those that overlap or touch become one. */
static ritz_status merge_ranges(const ritz_bulk_ranges *given, int64_t c,
                                bool named, ritz_bulk_ranges *out)
{
    int64_t kept = 0;

    RITZ_CHECK_NEW(out->range, given->count);
    for (int64_t k = 0; k < given->count; k++)
        if ((named || !given->range[k].each) &&
            has_direction(&given->range[k], c))
            out->range[out->count++] = given->range[k];
    if (out->count > 1)
        qsort(out->range, (size_t)out->count, sizeof *out->range,
              ritz_cards_compare_ids);
    for (int64_t k = 0; k < out->count; k++) {
        ritz_bulk_range *last = &out->range[kept > 0 ? kept - 1 : 0];

        if (kept == 0 || out->range[k].from > last->to)
            out->range[kept++] = out->range[k];
        else if (out->range[k].to > last->to)
            last->to = out->range[k].to;
    }
    out->count = kept;
    return RITZ_OK;
}

/* How many ids the ranges stand for, refused if too many. */
static ritz_status count_ids(const ritz_cards *cards,
                             const ritz_bulk_ranges *list, int64_t *out)
{
    *out = 0;
    for (int64_t k = 0; k < list->count; k++) {
        const ritz_bulk_range *range = &list->range[k];

        if (range->to - range->from >= MOST_IDS - *out)
            return ritz_cards_refuse(cards, range->line,
                                     "THRU stands for more than %d points",
                                     MOST_IDS);
        *out += range->to - range->from + 1;
    }
    return RITZ_OK;
}

ritz_status ritz_bulk_list_points(const ritz_bulk_cards *all, ritz_deck *out)
{
    RITZ_OWN(ritz_bulk_ranges) list = {0};
    int64_t num = 0;

    RITZ_CHECK(merge_ranges(&all->points, 0, true, &list));
    RITZ_CHECK(count_ids(&all->cards, &list, &num));
    RITZ_CHECK_NEW(out->point, num);
    for (int64_t k = 0; k < list.count; k++)
        for (int64_t id = list.range[k].from; id <= list.range[k].to; id++) {
            if (ritz_bulk_find_grid(all, id))
                return ritz_cards_refuse(&all->cards, list.range[k].line,
                                         "%" PRId64 " is a GRID and an SPOINT",
                                         id);
            out->point[out->num_points++] = id;
        }
    return RITZ_OK;
}

/* ---- sets --------------------------------------------------------------- */

/* A list of dofs that grows. */
typedef struct dofs {
    int64_t count, room;
    ritz_dof *dof;
} dofs;

static void dofs_free(dofs *list)
{
    free(list->dof);
}

static ritz_status add_dof(dofs *list, int64_t grid, int64_t component)
{
    RITZ_CHECK_ROOM(list->dof, list->count, list->room);
    list->dof[list->count++] = (ritz_dof){grid, component};
    return RITZ_OK;
}

/* The dofs of a grid or point that is named. */
static ritz_status add_named(const ritz_bulk_cards *all,
                             const ritz_bulk_range *one, const ritz_deck *built,
                             dofs *list)
{
    bool point = ritz_search(built->num_points, built->point, one->from) >= 0;
    bool grid = ritz_grids_find(&built->grids, one->from) >= 0;

    if (point && (one->mask & ~3U))
        return ritz_cards_refuse(&all->cards, one->line,
                                 "scalar point %" PRId64 " has no directions",
                                 one->from);
    if (grid && has_direction(one, 0))
        return ritz_cards_refuse(&all->cards, one->line,
                                 "no directions of GRID %" PRId64 " are given",
                                 one->from);
    for (int64_t c = 0; c <= 6; c++)
        if (has_direction(one, c))
            RITZ_CHECK(add_dof(list, one->from, point ? 0 : c));
    return RITZ_OK;
}

/* Direction c of what exists in the ranges; of all ids in them where the deck
 * defines no grid at all. */
static ritz_status add_direction(const ritz_bulk_cards *all,
                                 const ritz_bulk_ranges *given,
                                 const ritz_deck *built, int64_t c, dofs *out)
{
    int64_t count = c == 0 ? built->num_points : built->grids.count;
    const int64_t *ids = c == 0 ? built->point : built->grids.id;
    bool any = built->grids.count + built->num_points > 0;
    RITZ_OWN(ritz_bulk_ranges) list = {0};
    int64_t num = 0;

    RITZ_CHECK(merge_ranges(given, c, false, &list));
    if (!any)
        RITZ_CHECK(count_ids(&all->cards, &list, &num));
    for (int64_t k = 0; k < list.count; k++) {
        const ritz_bulk_range *range = &list.range[k];

        for (int64_t id = range->from; !any && id <= range->to; id++)
            RITZ_CHECK(add_dof(out, id, c));
        for (int64_t at = ritz_lower_bound(count, ids, range->from);
             at < count && ids[at] <= range->to; at++)
            RITZ_CHECK(add_dof(out, ids[at], c));
    }
    return RITZ_OK;
}

ritz_status ritz_bulk_list_set(const ritz_bulk_cards *all,
                               const ritz_bulk_ranges *list,
                               const ritz_deck *built, int64_t *count,
                               ritz_dof **out)
{
    RITZ_OWN(dofs) found = {0};

    for (int64_t k = 0; k < list->count; k++)
        if (list->range[k].each)
            RITZ_CHECK(add_named(all, &list->range[k], built, &found));
    for (int64_t c = 0; c <= 6; c++)
        RITZ_CHECK(add_direction(all, list, built, c, &found));
    found.count = ritz_dof_distinct(found.count, found.dof);
    if (!found.dof)
        RITZ_CHECK_NEW(found.dof, 0);
    *count = found.count;
    RITZ_MOVE(*out, found.dof);
    return RITZ_OK;
}
