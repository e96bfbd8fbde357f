/* Coded databases of ANSYS. */
#include "testing.h"

#include <ritz/import.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEAD "/COM,ANSYS RELEASE 2024\n/PREP7\n"

/* Nodes in fields of 5 and 9 letters; a line ends where only zeros follow. */
static const char nodes[] =
    HEAD "ET,1,185\nET,       2,186\nET,3,BEAM188\nET,4,21\nKEYOPT,4,3,2\n"
         "ET,5,999\nNBLOCK,6,SOLID,  9,  9\n(3i5,6e9.2)\n"
         "    1    0    0\n"
         "    2    0    0 1.00E+00\n"
         "    3    7    2 1.00E+00 1.00E+00\n"
         "    4    0    0 0.00E+00 1.00E+00\n"
         "    5    0    0 0.00E+00 0.00E+00 1.00E+00\n"
         "    6    0    0 1.00E+00 0.00E+00 1.00E+00\n"
         "    7    0    0 1.00E+00 1.00E+00 1.00E+00\n"
         "    8    0    0 0.00E+00 1.00E+00 1.00E+00\n"
         "   20    0    0-2.50E-01 0.00E+00 0.00E+00 9.00E+01\n"
         "N,R5.3,LOC,      -1,\n";

static ritz_status parse(const char *text, ritz_deck *out)
{
    return ritz_deck_parse("a.cdb", text, (int64_t)strlen(text), ".", out);
}

/* Parse a database of `nodes` followed by more lines. */
static ritz_status parse_with(const char *more, ritz_deck *out)
{
    char text[4096];

    snprintf(text, sizeof text, "%s%s", nodes, more);
    return parse(text, out);
}

static void nodes_have_places_and_axes(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};
    const double *axes = NULL;

    (void)state;
    assert_ok(parse(nodes, &deck));
    assert_ptr_equal(deck.format, &ritz_deck_cdb);
    assert_int_equal(deck.grids.count, 9);
    assert_int_equal(deck.grids.id[8], 20);
    assert_true(deck.grids.position[3 * 6 + 2] == 1.0);
    assert_true(deck.grids.position[3 * 8] == -0.25);
    assert_int_equal(deck.grids.num_frames, 2);
    assert_int_equal(deck.grids.frame[8], 1);
    assert_int_equal(deck.grids.frame[0], 0);
    /* 90 degrees about z: the first axis is y, the second -x */
    axes = deck.grids.axes + 9;
    assert_near(axes[1], 1.0, DBL_EPSILON);
    assert_near(axes[3], -1.0, DBL_EPSILON);
    assert_near(axes[8], 1.0, DBL_EPSILON);
    assert_non_null(strstr(deck.unnumbered, "--dofs and the mapping file"));
}

/* 90 degrees about z, then about the new x, then about the new y: x goes to y,
   then stays, then to -(z of the second axes) = -x. */
static void angles_follow_each_other(void **state)
{
    static const double expected[9] = {-1, 0, 0, 0, 0, 1, 0, 1, 0};
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse(HEAD "N,3,1,2,3,90,90,90\n", &deck));
    for (int k = 0; k < 9; k++)
        assert_near(deck.grids.axes[9 + k], expected[k], 4 * DBL_EPSILON);
}

/* Check the kind and the grids of cell k. */
static void assert_cell(const ritz_deck *deck, int64_t k, ritz_cell kind,
                        int64_t count, const int64_t *grid)
{
    const ritz_elements *cells = &deck->elements;

    assert_true(k < cells->count);
    assert_int_equal(cells->kind[k], kind);
    assert_int_equal(cells->first[k + 1] - cells->first[k], count);
    for (int64_t i = 0; i < count; i++)
        assert_int_equal(cells->grid[cells->first[k] + i], grid[i]);
}

static void elements_become_cells(void **state)
{
    static const int64_t brick[] = {1, 2, 3, 4, 5, 6, 7, 8};
    static const int64_t wedge[] = {1, 2, 3, 5, 6, 7};
    static const int64_t tetra[] = {1, 2, 3, 5};
    static const int64_t line[] = {1, 20};
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(
        parse_with("EBLOCK,19,SOLID,,\n(19i4)\n"
                   "   1   1   1   1   0   0   0   0   8   0   1"
                   "   1   2   3   4   5   6   7   8\n"
                   "   1   1   1   1   0   0   0   0   8   0   2"
                   "   1   2   3   3   5   6   7   7\n"
                   "   1   1   1   1   0   0   0   0   8   0   3"
                   "   1   2   3   3   5   5   5   5\n"
                   /* 20 nodes, of which those between corners are missing */
                   "   1   2   1   1   0   0   0   0  20   0   4"
                   "   1   2   3   4   5   6   7   8\n"
                   "   0   0   0   0   0   0   0   0   0   0   0   0\n"
                   "   1   3   1   1   0   0   0   0   3   0   5   1  20   2\n"
                   "   1   5   1   1   0   0   0   0   2   0   6   1   2\n"
                   "  -1\nTYPE,4\nEBLOCK,10\n(15i3)\n  9  1  1  1  0 20\n -1\n",
                   &deck));
    assert_int_equal(deck.elements.count, 5);
    assert_int_equal(deck.elements.id[1], 2);
    assert_int_equal(deck.elements.id[4], 5);
    assert_cell(&deck, 0, RITZ_CELL_HEXA, 8, brick);
    assert_cell(&deck, 1, RITZ_CELL_WEDGE, 6, wedge);
    assert_cell(&deck, 2, RITZ_CELL_TETRA, 4, tetra);
    assert_cell(&deck, 3, RITZ_CELL_HEXA, 8, brick);
    assert_cell(&deck, 4, RITZ_CELL_LINE, 2, line);
    assert_int_equal(deck.num_strange, 1);
    /* a beam gives grid 20 six directions, though its mass has three */
    assert_int_equal(deck.num_dofs, 6 + 7 * 3 + 6);
}

static void whole_cells_keep_their_nodes(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};
    int64_t grid[20];
    char text[4096];
    int at = snprintf(text, sizeof text, "%sET,2,186\n", HEAD);

    (void)state;
    for (int k = 0; k < 20; k++) {
        grid[k] = 21 + k;
        at += snprintf(text + at, sizeof text - (size_t)at, "N,%d,%d\n", 21 + k,
                       k);
    }
    at += snprintf(text + at, sizeof text - (size_t)at,
                   "eblock,19,solid\n(19i4)\n   1   2   1   1   0   0   0   0"
                   "  20   0   1");
    for (int k = 0; k < 20; k++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%s%4d",
                       k == 8 ? "\n" : "", 21 + k);
    snprintf(text + at, sizeof text - (size_t)at, "\n-1\n");
    assert_ok(parse(text, &deck));
    assert_int_equal(deck.elements.count, 1);
    assert_cell(&deck, 0, RITZ_CELL_HEXA20, 20, grid);
}

static void elements_without_nodes_are_counted(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(
        parse(HEAD "ET,1,185\nTYPE,1\nEBLOCK,10\n(15i3)\n  2\n -1\n", &deck));
    assert_int_equal(deck.num_strange, 1);
}

static void supports_are_fixed(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0}, moved = {0}, more = {0};

    (void)state;
    assert_ok(parse_with("NSEL,S,NODE,,1\nD,1,UX,0,,,,UY,ROTZ\nallsel\n"
                         "CMSEL,S,A\nnsel,all\nD,ALL,UZ\n",
                         &more));
    assert_int_equal(more.num_fixed, 3 + more.grids.count);
    assert_ok(parse_with("D,1,UX,  0.00000000 , 0.0\nD,2,ALL\n"
                         "D,3,ROTZ,0\nD,1,TEMP,20\n",
                         &deck));
    assert_int_equal(deck.num_fixed, 8);
    assert_int_equal(deck.fixed[0].component, 1);
    assert_int_equal(deck.fixed[7].grid, 3);
    assert_int_equal(deck.fixed[7].component, 6);
    assert_null(deck.imposed);
    assert_ok(parse_with("D,ALL,UY,0\nD,1,UX,1e-3\n", &moved));
    assert_int_equal(moved.num_fixed, 10);
    assert_non_null(strstr(moved.imposed, "'a.cdb', line 22: 'D' imposes"));
}

static void constraints_are_listed(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse_with("CE,R5.0,DEFI,2,1,0.\nET,6,184\nEBLOCK,19,SOLID\n"
                         "(19i4)\n   1   6   1   1   0   0   0   0   2   0   1"
                         "   1   2\n-1\n",
                         &deck));
    assert_int_equal(deck.num_constraints, 2);
    assert_string_equal(deck.constraint[0], "CE 1");
    assert_string_equal(deck.constraint[1], "MPC184 2");
    assert_non_null(strstr(deck.equations.refused, "'CE 1' is not understood"));
    assert_int_equal(deck.equations.count, 0);
}

static void what_is_wrong_is_named_with_its_line(void **state)
{
    static const struct {
        const char *more, *words;
    } bad[] = {
        {"NBLOCK,6,SOLID\n    1\n", "line 22: 'NBLOCK' is not followed by a "
                                    "format such as '(3i9,6e21.13e3)'"},
        {"EBLOCK,19,SOLID\n(3i9,6e21.13e3)\n", "such as '(19i9)'"},
        {"NBLOCK,3\n(1i5,3e9.2)\n    x\n",
         "line 23: 'x' is not a whole number"},
        {"NBLOCK,3\n(1i5,3e9.2)\n    1 1.0x\n", "'1.0x' is not a number"},
        {"NBLOCK,3\n(1i5,3e9.2)\n    1  1.E999\n", "'1.E999' is not a number"},
        {"NBLOCK,3\n(1i5,3e9.2)\n    0\n", "0 is not a node number"},
        {"NBLOCK,3\n(1i5,3e9.2)\n    1\n", "'NBLOCK' has no end"},
        {"EBLOCK,19,SOLID\n(19i4)\n   1   1\n", "an element has 2 fields"},
        {"EBLOCK,19,SOLID\n(19i4)\n   1   1   1   1   0   0   0   0  99   0"
         "   1\n",
         "and 99 nodes"},
        {"EBLOCK,19,SOLID\n(19i4)\n   1   1   1   1   0   0   0   0   8   0"
         "   1\n",
         "nodes of this element are missing"},
        {"EBLOCK,19,SOLID\n(19i4)\n   1   1   1   1   0   0   0   0   1   0"
         "   1  -5\n",
         "-5 is not a node number"},
        {"EBLOCK,19,SOLID\n(19i4)\n", "'EBLOCK' has no end"},
        {"D,77,UX,0\n", "'D' holds node 77, which does not exist"},
        {"D,P51X,UX,0\n", "'P51X' of 'D' is not a whole number"},
        {"ET,x,185\n", "'x' of 'ET' is not a whole number"},
        {"N,R5.3,ANG,5,90\n", "angles of node 5 do not follow its position"},
        {"CSYS,11\nN,30,1,0,0\n",
         "'N' after CSYS, along other axes, is not read"},
        {"LOCAL,11,1\nN,30,1,90\n",
         "'N' after CSYS, along other axes, is not read"},
        {"CMSEL,S,A\nD,ALL,ALL\n", "'D' holds nodes of a range or selection"},
        {"NSEL,S,NODE,,1\nD,all,UX\n", "nodes of a range or selection"},
        {"D,1,UX,0,,3,1\n", "nodes of a range or selection"},
        {"*IF,A,EQ,1,THEN\nN,30,1\n*ENDIF\n", "'N' stands behind '*IF'"},
        {"FILL,1,2\n", "'FILL' changes the model"},
        {"NDELE,1\n", "'NDELE' changes the model"},
        {"DSYM,SYMM,X\n", "'DSYM' changes the model"},
        {"*DO,I,1,9\n", "line 21: '*DO' changes the model, and Ritz does not "
                        "evaluate it: let ANSYS write the model by CDWRITE"},
        {"ngen,2,10,1,8\n", "'NGEN' changes the model"},
        {"/INPUT,more,inp\n", "'/INPUT' changes the model"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        assert_fails(parse_with(bad[k].more, &deck), RITZ_ERR_FORMAT,
                     bad[k].words);
        assert_null(deck.format);
    }
}

static const char whole[] =
    HEAD "ET,1,185\nNBLOCK,3\n(1i5,3e9.2)\n    1\n    2 1.00E+00\n-1\n"
         "N,R5.3,LOC,3,0,1,0\nN,R5.3,ANG,3,30,0,0\n"
         "EBLOCK,19,SOLID\n(19i4)\n   1   1   1   1   0   0   0   0   8   0"
         "   1   1   2   3   3   1   2   3   3\n  -1\nD,1,ALL\nCE,1\nFINISH\n";

static void every_cut_is_read_or_refused(void **state)
{
    (void)state;
    for (size_t length = 0; length < strlen(whole); length++) {
        RITZ_OWN(ritz_deck) deck = {0};
        char *text = strndup(whole, length);

        assert_non_null(text);
        if (ritz_deck_cdb.parse("a.cdb", text, (int64_t)length, NULL, &deck) !=
            RITZ_OK)
            assert_true(strlen(ritz_error_message()) > 0);
        free(text);
    }
}

static ritz_status parse_once(void)
{
    RITZ_OWN(ritz_deck) deck = {0};

    return parse(whole, &deck);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(parse_once());
}

static void the_format_is_recognised(void **state)
{
    (void)state;
    assert_ptr_equal(ritz_deck_recognise("/prep7\n", 7), &ritz_deck_cdb);
    assert_ptr_equal(ritz_deck_recognise("! head\nnblock,3\n", 16),
                     &ritz_deck_cdb);
    assert_ptr_equal(
        ritz_deck_recognise("*Heading\n/COM,x\nNBLOCK\n*NODE\n", 29),
        &ritz_deck_inp);
    assert_ptr_equal(ritz_deck_recognise("*SET,A,1\n/COM,x\n", 16),
                     &ritz_deck_cdb);
    assert_ptr_equal(ritz_deck_recognise("$ /PREP7\nGRID,1\n", 16),
                     &ritz_deck_nastran);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(nodes_have_places_and_axes),
    cmocka_unit_test(angles_follow_each_other),
    cmocka_unit_test(elements_become_cells),
    cmocka_unit_test(whole_cells_keep_their_nodes),
    cmocka_unit_test(elements_without_nodes_are_counted),
    cmocka_unit_test(supports_are_fixed),
    cmocka_unit_test(constraints_are_listed),
    cmocka_unit_test(what_is_wrong_is_named_with_its_line),
    cmocka_unit_test(every_cut_is_read_or_refused),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(the_format_is_recognised),
};

TEST_MODULE(cdb, tests, NULL, NULL)
