/*
 * The elements of the library of ANSYS [Ansys2024]: their cells, and the
 * directions of their nodes.
 */
#include "formats/cdb.h"

#include <stdarg.h>

enum {
    PLANE = RITZ_CDB_PLANE,
    SOLID = RITZ_CDB_SOLID,
    ALL_SIX = RITZ_CDB_ALL_SIX,
};

/* ANSYS orders the nodes of an element as VTK does. */
static const ritz_cdb_kind kinds[] = {
    {185, 8, RITZ_CELL_HEXA, SOLID, false},
    {45, 8, RITZ_CELL_HEXA, SOLID, false},
    {190, 8, RITZ_CELL_HEXA, SOLID, false},
    {186, 20, RITZ_CELL_HEXA20, SOLID, false},
    {95, 20, RITZ_CELL_HEXA20, SOLID, false},
    {187, 10, RITZ_CELL_TETRA10, SOLID, false},
    {92, 10, RITZ_CELL_TETRA10, SOLID, false},
    {285, 4, RITZ_CELL_TETRA, SOLID, false},
    {181, 4, RITZ_CELL_QUAD, ALL_SIX, false},
    {63, 4, RITZ_CELL_QUAD, ALL_SIX, false},
    {281, 8, RITZ_CELL_QUAD8, ALL_SIX, false},
    {93, 8, RITZ_CELL_QUAD8, ALL_SIX, false},
    {41, 4, RITZ_CELL_QUAD, SOLID, false},
    {182, 4, RITZ_CELL_QUAD, PLANE, false},
    {42, 4, RITZ_CELL_QUAD, PLANE, false},
    {183, 8, RITZ_CELL_QUAD8, PLANE, false},
    {82, 8, RITZ_CELL_QUAD8, PLANE, false},
    {188, 2, RITZ_CELL_LINE, ALL_SIX, false},
    {189, 3, RITZ_CELL_LINE, ALL_SIX, false}, /* two ends, then the middle */
    {4, 2, RITZ_CELL_LINE, ALL_SIX, false},
    {44, 2, RITZ_CELL_LINE, ALL_SIX, false},
    {288, 2, RITZ_CELL_LINE, ALL_SIX, false},
    {180, 2, RITZ_CELL_LINE, SOLID, false},
    {8, 2, RITZ_CELL_LINE, SOLID, false},
    {14, 2, RITZ_CELL_LINE, 0, false},
    {RITZ_CDB_MASS21, 1, 0, ALL_SIX, false},
    {154, 0, 0, 0, false}, /* loads on surfaces */
    {153, 0, 0, 0, false},
    {200, 0, 0, 0, false}, /* meshes without dofs */
    {184, 0, 0, 0, true},  /* rigid links and joints */
};

const ritz_cdb_kind *ritz_cdb_find_kind(ritz_piece text)
{
    const char *at = text.text;
    const char *end = text.text + text.length;
    int64_t number = 0;

    while (at < end && !(*at >= '0' && *at <= '9'))
        at++;
    if (!ritz_decimal_scan_whole(&at, end, &number) || at != end)
        return NULL;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (kinds[k].number == number)
            return &kinds[k];
    return NULL;
}

int64_t ritz_cdb_seek_type(const ritz_cdb *all, int64_t number)
{
    int64_t from = 0, to = all->num_types;

    while (from < to) {
        const int64_t middle = (from + to) / 2;

        if (all->type[middle].number < number)
            from = middle + 1;
        else
            to = middle;
    }
    return from;
}

ritz_cdb_type *ritz_cdb_find_type(const ritz_cdb *all, int64_t number)
{
    const int64_t at = ritz_cdb_seek_type(all, number);

    return at < all->num_types && all->type[at].number == number
               ? &all->type[at]
               : NULL;
}

ritz_status ritz_cdb_refuse(const ritz_cdb *all, int64_t line,
                            const char *format, ...)
{
    va_list args;
    ritz_status status = RITZ_OK;

    va_start(args, format);
    status = ritz_deck_refuse(&all->files, 0, line, format, args);
    va_end(args);
    return status;
}
