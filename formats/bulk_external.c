/*
 * Reads EXTRN, which names the rows of the matrices of an external
 * superelement:
 *
 *     EXTRN  G1  C1  G2  C2  G3  C3  G4  C4
 *            G5  C5  G6  THRU G7 C7  ...
 *
 * The pairs are in the order of the rows. A pair with several directions stands
 * for rows in ascending order of direction [MSC2022]. The direction of a scalar
 * point is 0, 1 or blank.
 */
#include "formats/bulk.h"

#include "base/alloc.h"
#include "base/search.h"

#include <inttypes.h>
#include <strings.h>

enum { MOST_ROWS = 1000000 }; /* of all EXTRN cards */

ritz_status ritz_bulk_take_external(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how)
{
    ritz_bulk_ranges *list = &all->external;

    (void)how;
    for (int64_t k = 0; k < card->count; k += 2) {
        ritz_bulk_range range = {.line = card->field[k].line, .each = true};

        if (!*ritz_card_text(card, k) && !*ritz_card_text(card, k + 1))
            continue;
        RITZ_CHECK(ritz_card_id(card, k, &range.from));
        range.to = range.from;
        if (strcasecmp(ritz_card_text(card, k + 1), "THRU") == 0) {
            k += 2;
            range.each = false;
            RITZ_CHECK(ritz_card_id(card, k, &range.to));
            if (range.to < range.from)
                return ritz_card_refuse(card, k,
                                        "at or above where THRU begins");
        }
        RITZ_CHECK(ritz_card_directions(card, k + 1, &range.mask));
        RITZ_CHECK_ROOM(list->range, list->count, list->room);
        list->range[list->count++] = range;
    }
    return RITZ_OK;
}

/* A list of rows that grows. */
typedef struct external_rows {
    int64_t count, room;
    ritz_dof *dof;
} external_rows;

static void external_rows_free(external_rows *rows)
{
    free(rows->dof);
}

/* Append the rows of one grid or scalar point. The deck may lack its card. */
static ritz_status add_point(const ritz_bulk_cards *all, const ritz_deck *built,
                             const ritz_bulk_range *range, int64_t id,
                             external_rows *rows)
{
    const bool point = ritz_search(built->num_points, built->point, id) >= 0;
    const unsigned mask = point && range->mask <= 3 ? 1U : range->mask;

    if (rows->count >= MOST_ROWS)
        return ritz_cards_refuse(&all->cards, range->line,
                                 "EXTRN stands for more than %d rows",
                                 MOST_ROWS);
    for (int64_t c = 0; c <= 6; c++) {
        if (((mask >> (unsigned)c) & 1U) == 0)
            continue;
        RITZ_CHECK_ROOM(rows->dof, rows->count, rows->room);
        rows->dof[rows->count++] = (ritz_dof){id, c};
    }
    return RITZ_OK;
}

/* The smallest number of a grid or scalar point that is at least @p id;
 * INT64_MAX if there is none. */
static int64_t next_point(const ritz_deck *built, int64_t id)
{
    const ritz_grids *grids = &built->grids;
    const int64_t g = ritz_lower_bound(grids->count, grids->id, id);
    const int64_t p = ritz_lower_bound(built->num_points, built->point, id);
    const int64_t grid = g < grids->count ? grids->id[g] : INT64_MAX;
    const int64_t point = p < built->num_points ? built->point[p] : INT64_MAX;

    return grid < point ? grid : point;
}

/* THRU stands for the grids and points of its range that the deck defines, or
 * for all numbers of the range if the deck defines none at all. */
static ritz_status add_range(const ritz_bulk_cards *all,
                             const ritz_bulk_range *range,
                             const ritz_deck *built, external_rows *rows)
{
    const bool any = range->each || built->grids.count + built->num_points == 0;
    int64_t id = any ? range->from : next_point(built, range->from);

    while (id <= range->to && id < INT64_MAX) {
        RITZ_CHECK(add_point(all, built, range, id, rows));
        id = any ? id + 1 : next_point(built, id + 1);
    }
    return RITZ_OK;
}

/* If a dof is named twice, as by the EXTRN cards of two superelements, store
 * the sentence that an import fails with if EXTRN has to name its rows. */
static ritz_status note_twice(const external_rows *rows, ritz_deck *out)
{
    RITZ_OWN_ARRAY ritz_dof *sorted = NULL;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_CHECK_COPY(sorted, rows->dof, rows->count);
    if (rows->count > 1)
        qsort(sorted, (size_t)rows->count, sizeof *sorted, ritz_dof_compare);
    for (int64_t k = 1; k < rows->count; k++) {
        if (ritz_dof_compare(&sorted[k - 1], &sorted[k]) != 0)
            continue;
        (void)ritz_fail(RITZ_ERR_FORMAT,
                        "EXTRN names '%s' twice: a deck with one superelement "
                        "alone, or --dofs, must name the rows",
                        ritz_dof_name(sorted[k], name));
        return ritz_deck_keep_sentence(&out->external_twice);
    }
    return RITZ_OK;
}

ritz_status ritz_bulk_list_external(const ritz_bulk_cards *all, ritz_deck *out)
{
    RITZ_OWN(external_rows) rows = {0};

    for (int64_t k = 0; k < all->external.count; k++)
        RITZ_CHECK(add_range(all, &all->external.range[k], out, &rows));
    RITZ_CHECK(note_twice(&rows, out));
    out->num_external = rows.count;
    RITZ_MOVE(out->external, rows.dof);
    return RITZ_OK;
}
