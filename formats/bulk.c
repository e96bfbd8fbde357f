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
#include "formats/bulk.h"
#include "base/alloc.h"
#include "base/search.h"

#include <inttypes.h>
#include <stdio.h>
#include <strings.h>

/* ---- sets of dofs -------------------------------------------------------- */

/*
 * Lists of grids, THRU ranges, directions.
 *
 * A grid that is named counts whether the deck defines it or not. THRU and ALL
 * mean those of the range that exist: grids where directions are given, scalar
 * points where none are. Ranges may overlap as much as they like: they are
 * merged direction by direction, so the work grows with what comes out.
 */

enum { MOST_IDS = 10000000 }; /* that ranges alone may stand for */

static void ritz_bulk_ranges_free(ritz_bulk_ranges *list)
{
    free(list->range);
}

static ritz_status add_range(ritz_bulk_ranges *list, ritz_bulk_range range)
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
              ritz_ascending_index);
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

static ritz_status list_points(const ritz_bulk_cards *all, ritz_deck *out)
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

static ritz_status list_set(const ritz_bulk_cards *all,
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

/* ---- which card is what ------------------------------------------------- */

/* How a card is taken; `how` is the table's. */
typedef ritz_status taker(ritz_bulk_cards *all, const ritz_card *card,
                          int32_t how);

/* 1, 3, 5 THRU 9 from field k of a card, each part as `range`; or ALL. */
static ritz_status take_list(const ritz_card *card, int64_t k,
                             ritz_bulk_range range, ritz_bulk_ranges *out)
{
    for (; k < card->count; k++) {
        if (!*ritz_card_text(card, k))
            continue;
        range.each = strcasecmp(ritz_card_text(card, k), "ALL") != 0;
        range.from = 1;
        range.to = INT64_MAX - 1;
        if (range.each) {
            RITZ_CHECK(ritz_card_id(card, k, &range.from));
            range.to = range.from;
        }
        if (range.each &&
            strcasecmp(ritz_card_text(card, k + 1), "THRU") == 0) {
            range.each = false;
            k += 2;
            RITZ_CHECK(ritz_card_id(card, k, &range.to));
            if (range.to < range.from)
                return ritz_card_refuse(card, k,
                                        "at or above where THRU begins");
        }
        RITZ_CHECK(add_range(out, range));
    }
    return RITZ_OK;
}

static ritz_status take_points(ritz_bulk_cards *all, const ritz_card *card,
                               int32_t how)
{
    (void)how;
    for (int64_t k = 0; k < card->count; k++)
        if (strcasecmp(ritz_card_text(card, k), "ALL") == 0)
            return ritz_card_refuse(card, k, "a positive whole number");
    return take_list(card, 0,
                     (ritz_bulk_range){.line = card->entry->line, .mask = 1},
                     &all->points);
}

/* ASET: ID C, four times. SPC: SID, then G C D, twice. */
static ritz_status take_pairs(ritz_bulk_cards *all, const ritz_card *card,
                              int32_t how)
{
    ritz_bulk_range range = {.line = card->entry->line, .each = true};
    int64_t width = how == RITZ_BULK_SPC ? 3 : 2;
    int64_t first = how == RITZ_BULK_SPC; /* behind the set's id */
    double motion = 0.0;

    if (first > 0)
        RITZ_CHECK(ritz_card_id(card, 0, &range.set));
    for (int64_t k = first; k < card->count; k += width) {
        if (!*ritz_card_text(card, k) && !*ritz_card_text(card, k + 1))
            continue;
        RITZ_CHECK(ritz_card_id(card, k, &range.from));
        range.to = range.from;
        RITZ_CHECK(ritz_card_directions(card, k + 1, &range.mask));
        if (how == RITZ_BULK_SPC)
            RITZ_CHECK(ritz_card_real(card, k + 2, 0.0, &motion));
        range.imposed = motion != 0.0;
        RITZ_CHECK(add_range(&all->ranges[how], range));
    }
    return RITZ_OK;
}

/* ASET1: C, then a list. SPC1: SID C, then a list. */
static ritz_status take_set(ritz_bulk_cards *all, const ritz_card *card,
                            int32_t how)
{
    ritz_bulk_range range = {.line = card->entry->line};
    int64_t first = how == RITZ_BULK_SPC;

    if (first > 0)
        RITZ_CHECK(ritz_card_id(card, 0, &range.set));
    RITZ_CHECK(ritz_card_directions(card, first, &range.mask));
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

/* The cards that are read, and by which function; sorted by name. */
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
    {"CORD1C", ritz_bulk_take_by_grids, RITZ_CYLINDRICAL},
    {"CORD1R", ritz_bulk_take_by_grids, RITZ_RECTANGULAR},
    {"CORD1S", ritz_bulk_take_by_grids, RITZ_SPHERICAL},
    {"CORD2C", ritz_bulk_take_by_points, RITZ_CYLINDRICAL},
    {"CORD2R", ritz_bulk_take_by_points, RITZ_RECTANGULAR},
    {"CORD2S", ritz_bulk_take_by_points, RITZ_SPHERICAL},
    {"EXTRN", ritz_bulk_take_external, 0},
    {"GRDSET", ritz_bulk_take_defaults, 0},
    {"GRID", ritz_bulk_take_grid, 0},
    {"MPC", take_constraint, true},
    {"MPCADD", take_sum, RITZ_SELECT_MPC},
    {"QSET", take_pairs, RITZ_SET_Q},
    {"QSET1", take_set, RITZ_SET_Q},
    {"SPC", take_pairs, RITZ_BULK_SPC},
    {"SPC1", take_set, RITZ_BULK_SPC},
    {"SPCADD", take_sum, RITZ_SELECT_SPC},
    {"SPOINT", take_points, 0},
};

/* Elements that make dofs depend on others; sorted. */
static const char *const CONSTRAINTS[] = {
    "CRBAR",  "CRBE1",   "CRBE2",  "CRBE3",    "CRIGD1",  "CRIGD2",
    "CRIGD3", "CRIGDR",  "CRROD",  "CRSPLINE", "CRTRPLT", "RBAR",
    "RBAR1",  "RBE1",    "RBE2",   "RBE2GS",   "RBE3",    "RJOINT",
    "RROD",   "RSPLINE", "RSSCON", "RTRPLT",   "RTRPLT1"};

/* How a card is taken, if it says something of grids or sets. */
static const struct kind *find_kind(const char *name)
{
    static const struct kind constraint = {"", take_constraint, false};

    if (bsearch(name, CONSTRAINTS, sizeof CONSTRAINTS / sizeof *CONSTRAINTS,
                sizeof *CONSTRAINTS, ritz_cards_compare_name))
        return &constraint;
    return bsearch(name, KINDS, sizeof KINDS / sizeof *KINDS, sizeof *KINDS,
                   ritz_cards_compare_name);
}

static ritz_status take_cards(ritz_bulk_cards *all)
{
    RITZ_OWN(ritz_card) card = {0};

    for (int64_t k = 0; k < all->cards.num_entries; k++) {
        const struct kind *kind = find_kind(all->cards.entry[k].name);

        if (!kind)
            continue;
        RITZ_CHECK(ritz_card_take(&all->cards, k, &card));
        RITZ_CHECK(kind->take(all, &card, kind->how));
    }
    return RITZ_OK;
}

/* ---- elements for pictures ----------------------------------------------- */

/*
 * The grids that each element joins. An element that is not understood is no
 * failure: it is left out of pictures, and counted.
 *
 * Nodes between corners of wedges and bricks are listed in the order lower,
 * vertical, upper edges here, and lower, upper, vertical edges in VTK.
 */

enum { MOST_GRIDS = 20 };

/* Fields from 0, of the element's number. */
typedef struct bulk_cell {
    const char *name;
    int8_t first;   /* field of its first grid */
    int8_t step;    /* from one grid's field to the next one's */
    ritz_cell kind; /* with corners alone */
    ritz_cell full; /* with nodes between them; 0: it has none */
} bulk_cell;

/* Sorted by name. */
static const bulk_cell cells[] = {
    {"CBAR", 2, 1, RITZ_CELL_LINE, 0},
    {"CBEAM", 2, 1, RITZ_CELL_LINE, 0},
    {"CBUSH", 2, 1, RITZ_CELL_LINE, 0},
    {"CELAS1", 2, 2, RITZ_CELL_LINE, 0},
    {"CELAS2", 2, 2, RITZ_CELL_LINE, 0},
    {"CHEXA", 2, 1, RITZ_CELL_HEXA, RITZ_CELL_HEXA20},
    {"CONROD", 1, 1, RITZ_CELL_LINE, 0},
    {"CPENTA", 2, 1, RITZ_CELL_WEDGE, RITZ_CELL_WEDGE15},
    {"CQUAD4", 2, 1, RITZ_CELL_QUAD, 0},
    {"CQUAD8", 2, 1, RITZ_CELL_QUAD, RITZ_CELL_QUAD8},
    {"CQUADR", 2, 1, RITZ_CELL_QUAD, 0},
    {"CROD", 2, 1, RITZ_CELL_LINE, 0},
    {"CSHEAR", 2, 1, RITZ_CELL_QUAD, 0},
    {"CTETRA", 2, 1, RITZ_CELL_TETRA, RITZ_CELL_TETRA10},
    {"CTRIA3", 2, 1, RITZ_CELL_TRIANGLE, 0},
    {"CTRIA6", 2, 1, RITZ_CELL_TRIANGLE, RITZ_CELL_TRIANGLE6},
    {"CTRIAR", 2, 1, RITZ_CELL_TRIANGLE, 0},
    {"CTUBE", 2, 1, RITZ_CELL_LINE, 0},
    {"PLOTEL", 1, 1, RITZ_CELL_LINE, 0},
};

/* Grids of a card, up to `most`; how many there are without a gap. */
static int64_t take_grids(const ritz_card *card, const bulk_cell *cell,
                          int64_t most, int64_t *grid)
{
    int64_t count = 0;

    while (count < most) {
        int64_t k = cell->first + count * cell->step;
        int64_t id = 0;

        if (k >= card->count || !*ritz_card_text(card, k) ||
            ritz_card_whole(card, k, 0, &id) != RITZ_OK || id < 1)
            break;
        grid[count++] = id;
    }
    return count;
}

/* Where node i of VTK's order stands on the card. */
static int64_t place_of(int64_t kind, int64_t i)
{
    int64_t corners = ritz_cell_shape_of(kind)->corners;
    int64_t edges = 0; /* below, and as many upright and above */

    if (kind == RITZ_CELL_HEXA20)
        edges = 4;
    if (kind == RITZ_CELL_WEDGE15)
        edges = 3;
    if (edges == 0 || i < corners + edges)
        return i;
    return i < corners + 2 * edges ? i + edges : i - edges;
}

/* Springs to the ground, which have one grid, are not drawn. */
static ritz_status take_cell(const ritz_card *card, const bulk_cell *cell,
                             int64_t *room, ritz_deck *out)
{
    ritz_elements *all = &out->elements;
    int64_t grid[MOST_GRIDS] = {0};
    int64_t corners = ritz_cell_shape_of(cell->kind)->size;
    int64_t most = cell->full ? ritz_cell_shape_of(cell->full)->size : corners;
    int64_t count = take_grids(card, cell, most, grid);
    int64_t kind = cell->full && count == most ? cell->full : cell->kind;
    int64_t *end = &all->first[all->count + 1];
    int64_t held = *room;
    int64_t id = 0;

    if (card->count < 1 || ritz_card_whole(card, 0, 0, &id) != RITZ_OK)
        id = 0; /* the element's number is not known */
    if (count == 1 && corners == 2)
        return RITZ_OK;
    if (count < corners) {
        out->num_strange++;
        return RITZ_OK;
    }
    *end = all->first[all->count];
    for (int64_t i = 0; i < ritz_cell_shape_of(kind)->size; i++) {
        RITZ_CHECK_ROOM(all->grid, *end, held);
        all->grid[(*end)++] = grid[place_of(kind, i)];
    }
    *room = held;
    all->id[all->count] = id;
    all->kind[all->count++] = kind;
    return RITZ_OK;
}

static ritz_status list_elements(const ritz_bulk_cards *all, ritz_deck *out)
{
    const ritz_cards *cards = &all->cards;
    RITZ_OWN(ritz_card) card = {0};
    int64_t room = 0;

    RITZ_CHECK_NEW(out->elements.kind, cards->num_entries);
    RITZ_CHECK_NEW(out->elements.first, cards->num_entries + 1);
    RITZ_CHECK_NEW(out->elements.id, cards->num_entries);
    for (int64_t k = 0; k < cards->num_entries; k++) {
        const bulk_cell *cell =
            bsearch(cards->entry[k].name, cells, sizeof cells / sizeof *cells,
                    sizeof *cells, ritz_cards_compare_name);
        ritz_status status = RITZ_OK;

        if (!cell)
            continue;
        status = ritz_card_take(cards, k, &card);
        if (status == RITZ_ERR_FORMAT) {
            out->num_strange++;
            continue;
        }
        RITZ_CHECK(status);
        RITZ_CHECK(take_cell(&card, cell, &room, out));
    }
    return RITZ_OK;
}

/* ---- what they say together --------------------------------------------- */

/* Members of selected combinations are selected too; these are not nested. */
static ritz_status complete_selection(ritz_bulk_cards *all, int64_t which)
{
    ritz_cards *cards = &all->cards;
    int64_t count = cards->num_selected[which];

    if (count == 0)
        return RITZ_OK;
    qsort(cards->selected[which], (size_t)count, sizeof count,
          ritz_ascending_index);
    for (int64_t k = 0; k < all->num_sums; k++) {
        if (all->sum[k].which != which ||
            !ritz_cards_select(cards, which, all->sum[k].set))
            continue;
        RITZ_CHECK_ROOM(cards->selected[which], count,
                        cards->selected_room[which]);
        cards->selected[which][count++] = all->sum[k].member;
    }
    cards->num_selected[which] = count;
    qsort(cards->selected[which], (size_t)count, sizeof count,
          ritz_ascending_index);
    return RITZ_OK;
}

/* Keep a sentence that refuses an SPC with a motion: it fails the import only
 * if matrices are to obey it. */
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
    return ritz_deck_keep_sentence(&out->imposed);
}

/* Keep the SPC cards that act, and add what GRID cards hold fixed. */
static ritz_status settle_fixed(ritz_bulk_cards *all, ritz_deck *out)
{
    ritz_bulk_ranges *spc = &all->ranges[RITZ_BULK_SPC];
    int64_t kept = 0;

    for (int64_t k = 0; k < spc->count; k++) {
        if (!ritz_cards_select(&all->cards, RITZ_SELECT_SPC, spc->range[k].set))
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

        if (grid->spc == 0 || !ritz_card_mask(grid->spc, &range.mask))
            continue;
        RITZ_CHECK(add_range(spc, range));
    }
    return RITZ_OK;
}

/* Keep the constraints that act, and name them. */
static ritz_status name_constraints(ritz_bulk_cards *all, ritz_deck *out)
{
    int64_t kept = 0;

    RITZ_CHECK_NEW(out->constraint, all->num_constraints);
    for (int64_t k = 0; k < all->num_constraints; k++) {
        const ritz_bulk_constraint *one = &all->constraint[k];

        if (one->is_set &&
            !ritz_cards_select(&all->cards, RITZ_SELECT_MPC, one->id))
            continue;
        snprintf(out->constraint[kept], sizeof *out->constraint, "%s %" PRId64,
                 one->name, one->id);
        all->constraint[kept++] = *one;
    }
    all->num_constraints = out->num_constraints = kept;
    return RITZ_OK;
}

static void ritz_bulk_cards_free(ritz_bulk_cards *all)
{
    ritz_cards_free(&all->cards);
    RITZ_FREE(all->grid, all->frame, all->sum, all->constraint);
    ritz_bulk_ranges_free(&all->points);
    ritz_bulk_ranges_free(&all->external);
    for (int k = 0; k < RITZ_BULK_SETS; k++)
        ritz_bulk_ranges_free(&all->ranges[k]);
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
    RITZ_CHECK(ritz_bulk_place_grids(all, &out->grids));
    RITZ_CHECK(list_points(all, out));
    RITZ_CHECK(list_dofs(out));
    RITZ_CHECK(complete_selection(all, RITZ_SELECT_SPC));
    RITZ_CHECK(complete_selection(all, RITZ_SELECT_MPC));
    RITZ_CHECK(settle_fixed(all, out));
    RITZ_CHECK(list_set(all, &all->ranges[RITZ_BULK_SPC], out, &out->num_fixed,
                        &out->fixed));
    for (int k = 0; k < 3; k++)
        RITZ_CHECK(list_set(all, &all->ranges[k], out, &out->num_sets[k],
                            &out->set[k]));
    RITZ_CHECK(ritz_bulk_list_external(all, out));
    RITZ_CHECK(name_constraints(all, out));
    RITZ_CHECK(ritz_bulk_list_equations(all, out));
    return list_elements(all, out);
}

static ritz_status parse_bulk(const char *path, const char *bytes, int64_t size,
                              const char *folder, ritz_deck *out)
{
    RITZ_OWN(ritz_bulk_cards)
    all = {.defaults = {.line = -1,
                        .cp = RITZ_BULK_BLANK,
                        .cd = RITZ_BULK_BLANK,
                        .spc = RITZ_BULK_BLANK}};

    RITZ_CHECK(ritz_cards_parse(path, bytes, size, folder, &all.cards));
    RITZ_CHECK(take_cards(&all));
    return build_deck(&all, out);
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
