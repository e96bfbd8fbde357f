/*
 * Elements for pictures: the grids that each of them joins. An element that is
 * not understood is no failure: it is left out of pictures, and counted.
 *
 * Nodes between corners of wedges and bricks are listed in the order lower,
 * vertical, upper edges here, and lower, upper, vertical edges in VTK.
 *
 * [Nastran1986], section 2.4.
 */
#include "formats/bulk.h"

#include "base/alloc.h"

#include <ritz/model.h>

enum { MOST_GRIDS = 20 };

/* Fields from 0, of the element's number. */
typedef struct ritz_bulk_cell {
    const char *name;
    int8_t first;   /* field of its first grid */
    int8_t step;    /* from one grid's field to the next one's */
    ritz_cell kind; /* with corners alone */
    ritz_cell full; /* with nodes between them; 0: it has none */
} ritz_bulk_cell;

/* Sorted by name. */
static const ritz_bulk_cell cells[] = {
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
static int64_t take_grids(const ritz_card *card, const ritz_bulk_cell *cell,
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

/* A spring to the ground joins one grid and is nothing to be seen. */
static ritz_status take_cell(const ritz_card *card, const ritz_bulk_cell *cell,
                             int64_t *room, ritz_deck *out)
{
    ritz_elements *all = &out->elements;
    int64_t grid[MOST_GRIDS];
    int64_t corners = ritz_cell_shape_of(cell->kind)->size;
    int64_t most = cell->full ? ritz_cell_shape_of(cell->full)->size : corners;
    int64_t count = take_grids(card, cell, most, grid);
    int64_t kind = cell->full && count == most ? cell->full : cell->kind;
    int64_t *end = &all->first[all->count + 1];
    int64_t held = *room;

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
    all->kind[all->count++] = kind;
    return RITZ_OK;
}

ritz_status ritz_bulk_list_elements(const ritz_bulk_cards *all, ritz_deck *out)
{
    const ritz_cards *cards = &all->cards;
    RITZ_OWN(ritz_card) card = {0};
    int64_t room = 0;

    RITZ_CHECK_NEW(out->elements.kind, cards->num_entries);
    RITZ_CHECK_NEW(out->elements.first, cards->num_entries + 1);
    for (int64_t k = 0; k < cards->num_entries; k++) {
        const ritz_bulk_cell *cell =
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
