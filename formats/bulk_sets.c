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

ritz_status ritz_bulk_add_range(ritz_bulk_ranges *list, ritz_bulk_range range)
{
    RITZ_CHECK_ROOM(list->range, list->count, list->room);
    list->range[list->count++] = range;
    return RITZ_OK;
}

static int compare_ranges(const void *a, const void *b)
{
    const ritz_bulk_range *left = a;
    const ritz_bulk_range *right = b;

    return (left->from > right->from) - (left->from < right->from);
}

/* Ranges that overlap or touch become one; returns how many are left. */
static int64_t merge_ranges(int64_t count, ritz_bulk_range *range)
{
    int64_t kept = 0;

    if (count > 1)
        qsort(range, (size_t)count, sizeof *range, compare_ranges);
    for (int64_t k = 0; k < count; k++) {
        if (kept > 0 && range[k].from <= range[kept - 1].to) {
            if (range[k].to > range[kept - 1].to)
                range[kept - 1].to = range[k].to;
        } else {
            range[kept++] = range[k];
        }
    }
    return kept;
}

/* How many ids the ranges stand for, refused if too many. */
static ritz_status count_ids(const ritz_cards *cards, int64_t count,
                             const ritz_bulk_range *range, int64_t *out)
{
    *out = 0;
    for (int64_t k = 0; k < count; k++) {
        if (range[k].to - range[k].from >= MOST_IDS - *out)
            return ritz_cards_refuse(cards, range[k].line,
                                     "THRU stands for more than %d points",
                                     MOST_IDS);
        *out += range[k].to - range[k].from + 1;
    }
    return RITZ_OK;
}

ritz_status ritz_bulk_list_points(const ritz_bulk_cards *all, ritz_deck *out)
{
    RITZ_OWN_ARRAY ritz_bulk_range *range = NULL;
    RITZ_OWN_ARRAY int64_t *point = NULL;
    int64_t count = 0;
    int64_t num = 0;

    RITZ_CHECK_COPY(range, all->points.range, all->points.count);
    count = merge_ranges(all->points.count, range);
    RITZ_CHECK(count_ids(&all->cards, count, range, &num));
    RITZ_CHECK_NEW(point, num);
    num = 0;
    for (int64_t k = 0; k < count; k++)
        for (int64_t id = range[k].from; id <= range[k].to; id++) {
            if (ritz_bulk_find_grid(all, id))
                return ritz_cards_refuse(&all->cards, range[k].line,
                                         "%" PRId64 " is a GRID and an "
                                         "SPOINT",
                                         id);
            point[num++] = id;
        }
    RITZ_MOVE(out->point, point);
    out->num_points = num;
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

static bool has_direction(const ritz_bulk_range *range, int64_t c)
{
    return (((unsigned)range->mask >> (unsigned)c) & 1U) != 0;
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

/* Direction c of what exists in merged ranges. */
static ritz_status add_existing(int64_t num_ids, const int64_t *ids, int64_t c,
                                int64_t count, const ritz_bulk_range *range,
                                dofs *list)
{
    for (int64_t k = 0; k < count; k++)
        for (int64_t at = ritz_lower_bound(num_ids, ids, range[k].from);
             at < num_ids && ids[at] <= range[k].to; at++)
            RITZ_CHECK(add_dof(list, ids[at], c));
    return RITZ_OK;
}

/* Direction c of all in the ranges, where the deck defines no grid at all. */
static ritz_status add_all(const ritz_bulk_cards *all, int64_t c, int64_t count,
                           const ritz_bulk_range *range, dofs *list)
{
    int64_t ids = 0;

    RITZ_CHECK(count_ids(&all->cards, count, range, &ids));
    for (int64_t k = 0; k < count; k++)
        for (int64_t id = range[k].from; id <= range[k].to; id++)
            RITZ_CHECK(add_dof(list, id, c));
    return RITZ_OK;
}

static ritz_status add_direction(const ritz_bulk_cards *all,
                                 const ritz_bulk_ranges *given,
                                 const ritz_deck *built, int64_t c, dofs *list)
{
    RITZ_OWN_ARRAY ritz_bulk_range *range = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(range, given->count);
    for (int64_t k = 0; k < given->count; k++)
        if (!given->range[k].each && has_direction(&given->range[k], c))
            range[count++] = given->range[k];
    count = merge_ranges(count, range);
    if (built->grids.count + built->num_points == 0)
        RITZ_CHECK(add_all(all, c, count, range, list));
    else if (c == 0)
        RITZ_CHECK(add_existing(built->num_points, built->point, c, count,
                                range, list));
    else
        RITZ_CHECK(add_existing(built->grids.count, built->grids.id, c, count,
                                range, list));
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
