/*
 * Types of elements: how they are drawn, and which directions their nodes have.
 *
 * The order of nodes is that of VTK: corners, then the nodes between them on
 * the lower edges, the upper and the upright ones [Abaqus2016].
 *
 * CalculiX replaces shells, membranes, plane elements, beams and trusses by
 * solids with nodes of their own [Dhondt2022].
 */
#include "formats/inp.h"

#include <string.h>

enum {
    PLANE = 0x06,   /* bits of directions 1 and 2 */
    FRAME = 0x46,   /* 1, 2 and 6 */
    SOLID = 0x0e,   /* 1 to 3 */
    TURNING = 0x70, /* 4 to 6 */
    ALL_SIX = 0x7e,
};

static const ritz_inp_type types[] = {
    {"C3D4", "H", 4, RITZ_CELL_TETRA, SOLID, false},
    {"C3D6", "H R", 6, RITZ_CELL_WEDGE, SOLID, false},
    {"C3D8", "H I IH R RH", 8, RITZ_CELL_HEXA, SOLID, false},
    {"C3D10", "H HS I M MH", 10, RITZ_CELL_TETRA10, SOLID, false},
    {"C3D15", "H", 15, RITZ_CELL_WEDGE15, SOLID, false},
    {"C3D20", "H R RH RI", 20, RITZ_CELL_HEXA20, SOLID, false},
    {"S3", "R RS", 3, RITZ_CELL_TRIANGLE, ALL_SIX, true},
    {"STRI3", "", 3, RITZ_CELL_TRIANGLE, ALL_SIX, true},
    {"S4", "R RS", 4, RITZ_CELL_QUAD, ALL_SIX, true},
    {"S6", "", 6, RITZ_CELL_TRIANGLE6, ALL_SIX, true},
    {"S8", "R", 8, RITZ_CELL_QUAD8, ALL_SIX, true},
    {"S4R5", "", 4, RITZ_CELL_QUAD, 0, true}, /* some nodes have five rows */
    {"S8R5", "", 8, RITZ_CELL_QUAD8, 0, true},
    {"STRI65", "", 6, RITZ_CELL_TRIANGLE6, 0, true},
    {"M3D3", "", 3, RITZ_CELL_TRIANGLE, SOLID, true},
    {"M3D4", "R", 4, RITZ_CELL_QUAD, SOLID, true},
    {"M3D6", "", 6, RITZ_CELL_TRIANGLE6, SOLID, true},
    {"M3D8", "R", 8, RITZ_CELL_QUAD8, SOLID, true},
    {"CPS3", "", 3, RITZ_CELL_TRIANGLE, PLANE, true},
    {"CPS4", "I R", 4, RITZ_CELL_QUAD, PLANE, true},
    {"CPS6", "M", 6, RITZ_CELL_TRIANGLE6, PLANE, true},
    {"CPS8", "R", 8, RITZ_CELL_QUAD8, PLANE, true},
    {"CPE3", "H", 3, RITZ_CELL_TRIANGLE, PLANE, true},
    {"CPE4", "H I IH R RH", 4, RITZ_CELL_QUAD, PLANE, true},
    {"CPE6", "H M MH", 6, RITZ_CELL_TRIANGLE6, PLANE, true},
    {"CPE8", "H R RH", 8, RITZ_CELL_QUAD8, PLANE, true},
    {"B31", "H R", 2, RITZ_CELL_LINE, ALL_SIX, true},
    {"B32", "H R", 3, RITZ_CELL_LINE, ALL_SIX, true},
    {"B33", "H", 2, RITZ_CELL_LINE, ALL_SIX, true},
    {"PIPE31", "H", 2, RITZ_CELL_LINE, ALL_SIX, true},
    {"PIPE32", "H", 3, RITZ_CELL_LINE, ALL_SIX, true},
    {"B21", "H", 2, RITZ_CELL_LINE, FRAME, true},
    {"B22", "H", 3, RITZ_CELL_LINE, FRAME, true},
    {"B23", "H", 2, RITZ_CELL_LINE, FRAME, true},
    {"T2D2", "H", 2, RITZ_CELL_LINE, PLANE, true},
    {"T2D3", "H", 3, RITZ_CELL_LINE, PLANE, true},
    {"T3D2", "H", 2, RITZ_CELL_LINE, SOLID, true},
    {"T3D3", "H", 3, RITZ_CELL_LINE, SOLID, true},
    {"MASS", "", 1, 0, SOLID, false},
    {"ROTARYI", "", 1, 0, TURNING, false},
    {"SPRINGA", "", 2, RITZ_CELL_LINE, SOLID, false},
    {"DASHPOTA", "", 2, RITZ_CELL_LINE, SOLID, false},
    {"SPRING1", "", 1, 0, 0, false}, /* their own data name the direction */
    {"SPRING2", "", 2, RITZ_CELL_LINE, 0, false},
    {"DASHPOT1", "", 1, 0, 0, false},
    {"DASHPOT2", "", 2, RITZ_CELL_LINE, 0, false},
};

/* Whether `rest` is empty, or a word of a list with blanks between them. */
static bool is_variant(ritz_piece rest, const char *list)
{
    while (*list) {
        size_t length = strcspn(list, " ");
        const ritz_piece word = {list, (int64_t)length};

        if (ritz_inp_same(rest, word))
            return true;
        list += length + (list[length] == ' ');
    }
    return rest.length == 0;
}

const ritz_inp_type *ritz_inp_find_type(ritz_piece name)
{
    for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
        const ritz_piece own = {types[k].name, (int64_t)strlen(types[k].name)};
        ritz_piece begin = name, rest = name;

        if (name.length < own.length)
            continue;
        begin.length = own.length;
        rest.text += own.length;
        rest.length -= own.length;
        if (ritz_inp_same(begin, own) && is_variant(rest, types[k].variants))
            return &types[k];
    }
    return NULL;
}
