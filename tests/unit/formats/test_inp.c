/* Input files of Abaqus and CalculiX: rows, sets, supports and equations by
 * hand, refusals, real decks with the rows of their matrices. */
#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "matrix_files.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static ritz_status parse(const char *text, ritz_deck *out)
{
    return ritz_deck_parse("t.inp", text, (int64_t)strlen(text), ".", out);
}

/* Dofs as "5.1 5.2 9.3". */
static void assert_dofs(int64_t count, const ritz_dof *dof,
                        const char *expected)
{
    char text[400] = "";
    size_t used = 0;

    for (int64_t k = 0; k < count; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%d.%d",
                                 k > 0 ? " " : "", (int)dof[k].grid,
                                 (int)dof[k].component);
    assert_string_equal(text, expected);
}

/* Cell k as "10: 1 2 3 4". */
static void assert_cell(const ritz_elements *all, int64_t k,
                        const char *expected)
{
    char text[200] = "";
    size_t used = 0;

    assert_true(k < all->count);
    used = (size_t)snprintf(text, sizeof text, "%d:", (int)all->kind[k]);
    for (int64_t i = all->first[k]; i < all->first[k + 1]; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %d",
                                 (int)all->grid[i]);
    assert_string_equal(text, expected);
}

/* ---- what is read -------------------------------------------------------- */

static void a_node_has_the_rows_of_its_elements(void **state)
{
    static const char TEXT[] =
        "** of Abaqus, by its last step\r\n"
        "*Heading\r\n a title\r\n*Preprint, echo=NO,\r\n model=NO\r\n"
        "*NODE\r\n1, 0.5\r\n2, 1.D0, 2E0, 3\r\n3,,, 4., 1., 0., 0.\r\n\r\n"
        " 4 , -1.5e-1, 0, 0\r\n5\r\n6, 9., 9., 9.\r\n7\r\n8\r\n9\r\n"
        "** 10, 1., 1., 1.\r\n"
        "* element , Type = c3d4h\r\n1, 1, 2, 3, 4\r\n"
        "*Element, type=B31\r\n2, 1, 5, 6\r\n" /* 6 orients it */
        "*Element, type=CPE4R\r\n3, 2, 7, 7, 2\r\n"
        "*Element, type=MASS, elset=E\r\n4, 8\r\n"
        "*Element, type=ROTARYI\r\n5, 8\r\n"
        "*Node Output\r\nU, UR\r\n*Material, name=*Steel\r\n*Density\r\n1.,\r\n"
        "*Step\r\n*Matrix Generate, stiffness\r\n*End Step\r\n";
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse(TEXT, &deck));
    assert_ptr_equal(deck.format, &ritz_deck_inp);
    assert_int_equal(deck.grids.count, 9);
    assert_near(deck.grids.position[0], 0.5, 0.0);
    assert_near(deck.grids.position[5], 3.0, 0.0);
    assert_near(deck.grids.position[6], 0.0, 0.0);
    assert_near(deck.grids.position[8], 4.0, 0.0);
    assert_near(deck.grids.position[9], -0.15, 0.0);
    assert_dofs(deck.num_dofs, deck.dof,
                "1.1 1.2 1.3 1.4 1.5 1.6 2.1 2.2 2.3 3.1 3.2 3.3 4.1 4.2 4.3 "
                "5.1 5.2 5.3 5.4 5.5 5.6 7.1 7.2 8.1 8.2 8.3 8.4 8.5 8.6");
    assert_null(deck.unnumbered);
    assert_int_equal(deck.elements.count, 3);
    assert_cell(&deck.elements, 1, "3: 1 5");
}

static void elements_are_drawn_as_they_are_written(void **state)
{
    static const char TEXT[] =
        "*NODE\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n12\n13\n14\n15\n16\n17\n"
        "18\n19\n20\n"
        "*ELEMENT, TYPE=C3D20R\n7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,\n"
        "11, 12, 13, 14, 15\n16, 17, 18, 19, 20\n" /* the comma may miss */
        "*ELEMENT, TYPE=C3D15\n8,1,2,3,4,5,6,7,8,\n9,10,11,12,13,14,15,\n"
        "*ELEMENT, TYPE=B32\n9, 4, 5, 6\n"
        "*ELEMENT, TYPE=S8R\n10, 1, 2, 3, 4, 5, 6, 7, 8\n"
        "*ELEMENT, TYPE=FRAME2D\n11, 1,\n2\n12, 1, 2\n"
        "*ELEMENT, TYPE=C3D10\n13, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n";
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse(TEXT, &deck));
    assert_int_equal(deck.elements.count, 6);
    assert_int_equal(deck.elements.id[3], 9); /* both halves of a bent line */
    assert_int_equal(deck.elements.id[5], 13);
    assert_int_equal(deck.num_strange, 2);
    assert_cell(&deck.elements, 0,
                "25: 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20");
    assert_cell(&deck.elements, 1, "26: 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15");
    assert_cell(&deck.elements, 2, "3: 4 5");
    assert_cell(&deck.elements, 3, "3: 5 6");
    assert_cell(&deck.elements, 4, "23: 1 2 3 4 5 6 7 8");
    assert_cell(&deck.elements, 5, "24: 1 2 3 4 5 6 7 8 9 10");
}

static void supports_act_on_nodes_and_sets(void **state)
{
    static const char TEXT[] =
        "*NODE, NSET=FIRST\n1\n2\n3\n*NODE\n4\n5\n6\n7\n8\n"
        "*NSET, NSET=Odd, GENERATE\n1, 8, 2\n"
        "*NSET, NSET=A\n4, B, 99\n*NSET, NSET=B\n5, a\n" /* each in the other */
        "*NSET, NSET=A\n6\n"
        "*NSET, NSET=\"a, quoted\"\n8,\n"
        "*NSET, NSET=UNUSED, ELSET=E\n"
        "*BOUNDARY\nfirst, 1\nODD, 2, 2, 0.\nB, 3, 3\n7, 4, 6\n"
        "*BOUNDARY, OP=MOD\n2, XSYMM\n\"a, quoted\", pinned\n3, 1, 1\n";
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse(TEXT, &deck));
    assert_dofs(deck.num_fixed, deck.fixed,
                "1.1 1.2 2.1 2.5 2.6 3.1 3.2 4.3 5.2 5.3 6.3 7.2 7.4 7.5 7.6 "
                "8.1 8.2 8.3");
    assert_null(deck.imposed);
}

static void an_instance_places_its_part(void **state)
{
    static const char TEXT[] =
        "*Part, name=Plate\n*Node\n1, 1., 2., 3.\n2\n"
        "*Element, type=SPRINGA\n1, 1, 2\n*Nset, nset=Set-1\n1\n*End Part\n"
        "*Part, name=Empty\n*End Part\n"
        "*Assembly, name=A\n*Instance, name=Plate-1, part=PLATE\n10., 0., -1.\n"
        "*End Instance\n*Nset, nset=Set-1, instance=Plate-1\n2,\n"
        "*End Assembly\n"
        "*Boundary\nset-1, 1\nplate-1.Set-1, 2\nPlate-1.2, 3\n";
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(parse(TEXT, &deck));
    assert_near(deck.grids.position[0], 11.0, 0.0);
    assert_near(deck.grids.position[2], 2.0, 0.0);
    assert_near(deck.grids.position[3], 10.0, 0.0);
    assert_dofs(deck.num_dofs, deck.dof, "1.1 1.2 1.3 2.1 2.2 2.3");
    assert_dofs(deck.num_fixed, deck.fixed, "1.2 2.1 2.3");
}

static void equations_eliminate_their_first_dof(void **state)
{
    static const char TEXT[] =
        "*NODE\n1\n2\n3\n*ELEMENT, TYPE=SPRINGA\n1, 1, 2\n"
        "*EQUATION\n3\n2, 1, 2., 1, 1, -4.,\n3, 6, 1.\n"
        "2\n1, 2, 1., 2, 2, 1.\n";
    RITZ_OWN(ritz_deck) deck = {0};
    const ritz_equations *eq = &deck.equations;

    (void)state;
    assert_ok(parse(TEXT, &deck));
    assert_int_equal(deck.num_constraints, 2);
    assert_string_equal(deck.constraint[1], "EQUATION 2");
    assert_null(eq->refused);
    assert_dofs(eq->count, eq->dependent, "2.1 1.2");
    assert_dofs(eq->first[2], eq->dof, "1.1 3.6 2.2");
    assert_near(eq->share[0], 2.0, 0.0);
    assert_near(eq->share[1], -0.5, 0.0);
    assert_near(eq->share[2], -1.0, 0.0);
    assert_int_equal(eq->from[1].line, 11);
    assert_dofs(deck.num_dofs, deck.dof, "1.1 1.2 1.3 2.1 2.2 2.3 3.6");
}

/* ---- what is refused ----------------------------------------------------- */

static void constraints_that_are_not_understood_are_kept(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"*NODE\n1\n*TIE, NAME=T\na, b\n",
         "'t.inp', line 3: '*TIE' is not understood: of constraints *EQUATION"},
        {"*NODE\n1\n*Rigid Body, REF NODE=1\n", "'*RIGID BODY' is not"},
        {"*NODE\n1\n*EQUATION\n2\n1, 1, 0., 1, 2, 1.\n",
         "line 4: the first factor of '*EQUATION' is zero"},
        {"*NODE\n1\n*EQUATION\n2\n1, 1, 1e-300, 1, 2, 1e300\n", "too much"},
        {"*NODE\n1\n*EQUATION\n1\n7, 1, 1.\n", "line 5: there is no node 7"},
        {"*NODE\n1\n*EQUATION\n1\nA, 1, 1.\n", "'A' is a set, and equations"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        assert_ok(parse(CASES[k].text, &deck));
        assert_int_equal(deck.num_constraints, 1);
        assert_non_null(deck.equations.refused);
        assert_non_null(strstr(deck.equations.refused, CASES[k].words));
    }
}

static void a_support_that_moves_is_kept_as_a_sentence(void **state)
{
    static const char *const TEXTS[] = {
        "*NODE\n1\n*BOUNDARY\n1, 1, 1, 0.1\n",
        "*NODE\n1\n*BOUNDARY, USER\n1, 1\n",
        "*NODE\n1\n*BOUNDARY, SUBMODEL, STEP=1\n1, 1\n",
    };

    (void)state;
    for (size_t k = 0; k < sizeof TEXTS / sizeof *TEXTS; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        assert_ok(parse(TEXTS[k], &deck));
        assert_non_null(deck.imposed);
        assert_non_null(strstr(deck.imposed, "'t.inp', line 4: '*BOUNDARY' "
                                             "moves nodes by what is not"));
    }
}

static void rows_that_the_deck_does_not_tell_must_be_named(void **state)
{
#define SHELL "*NODE\n1\n2\n3\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n"
    static const struct {
        const char *text, *words; /* NULL: the deck tells the rows */
    } CASES[] = {
        {SHELL, "line 5: 'S3' elements have other rows in CalculiX"},
        {SHELL "*STEP\n*MATRIX GENERATE, MASS\n", NULL},
        {SHELL "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n",
         "line 5: CalculiX makes solids of 'S3' elements"},
        {"*NODE\n2\n1\n*ELEMENT, TYPE=MASS\n1, 1\n",
         "line 3: the numbers of nodes do not ascend"},
        {"*NODE\n2\n1\n*STEP\n*MATRIX OUTPUT, MASS\n", "do not ascend"},
        {"*NODE\n2\n1\n*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n", NULL},
        {"*NODE\n1\n*ELEMENT, TYPE=C3D8T\n", "'C3D8T' elements have is not"},
        {"*NODE\n1\n*ELEMENT, TYPE=S8R5\n", "'S8R5' elements have is not"},
        {"*NODE\n1\n*ELEMENT, TYPE=C3D8RHX\n", "which rows nodes of"},
        {"*NODE\n1\n*ELEMENT, TYPE=C3D\n", "which rows nodes of"},
        {"*NODE\n1\n*ELEMENT, TYPE=C3D20RH\n", NULL},
    };
#undef SHELL

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        assert_ok(parse(CASES[k].text, &deck));
        if (!CASES[k].words)
            assert_null(deck.unnumbered);
        else if (!deck.unnumbered || !strstr(deck.unnumbered, CASES[k].words))
            fail_msg("'%s' is not in '%s'", CASES[k].words,
                     deck.unnumbered ? deck.unnumbered : "");
    }
}

static const struct {
    const char *text, *words;
} MEANINGLESS[] = {
    {"*NODE\nx, 1.\n", "'t.inp', line 2: 'x' in '*NODE' is not a number "
                       "from 1 on"},
    {"*NODE\n-3\n", "'-3' in '*NODE' is not a number from 1"},
    {"*NODE\n1000000000000000\n", "of at most 15 digits"},
    {"*NODE\n, 1.\n", "field 1 of '*NODE' is blank where"},
    {"*NODE\n1, 1.2.3\n", "'1.2.3' in '*NODE' is not a number"},
    {"*NODE\n1, nan\n", "'nan' in '*NODE' is not a number"},
    {"*NODE\n1, 1.\n2\n1, 2.\n",
     "line 4: node 1 was defined at another position"},
    {"*NODE, SYSTEM=C\n1\n", "'*NODE' with SYSTEM is not read"},
    {"*NODE, NSET\n1\n", "line 1: '*NODE' does not name its set"},
    {"*NSET\n1\n", "line 1: '*NSET' does not name its set"},
    {"*NSET, NSET=A, GENERATE\n5, 1\n",
     "line 2: GENERATE ends at 1, before it begins, at 5"},
    {"*ELEMENT\n1, 2\n", "'*ELEMENT' does not say its TYPE"},
    {"*ELEMENT, TYPE=C3D4\n9, 1, 2,\n3,\n*STEP\n",
     "line 3: element 9 has 3 nodes, and a 'C3D4' has 4"},
    {"*ELEMENT, TYPE=C3D4\n9, 1, 2,\n3, 4, 5\n",
     "line 3: element 9 has more than the 4 nodes of a 'C3D4'"},
    {"*ELEMENT, TYPE=C3D4\n9, P-1.4, 2, 3, 4\n", "'P-1.4' in '*ELEMENT'"},
    {"*NODE\n1\n*BOUNDARY\nA, 1\n", "line 4: there is no set 'A' of"},
    {"*NODE\n1\n*BOUNDARY\n2, 1\n", "line 4: there is no node 2"},
    {"*BOUNDARY\n1, 11\n", "'11' in '*BOUNDARY' is not a direction, 1 to"},
    {"*BOUNDARY\n1\n", "field 2 of '*BOUNDARY' is blank where a direction"},
    {"*NODE\n1\n*BOUNDARY\n1, 1, 3, 0., 9\n",
     "line 4: '9' in '*BOUNDARY' is one field too many"},
    {"*NODE\n1\n*BOUNDARY\n1, PINNED, 3\n",
     "line 4: '3' in '*BOUNDARY' is one field too many"},
    {"*NODE\n1\n*ELEMENT, TYPE=C3D4\n9,\n1, 2, 3, 4\n",
     "line 4: there is no node 2 of element 9"},
    {"*NODE,\n1, 0.\n", "line 1: '*NODE' ends with a comma, but '1' in the "
                        "line that continues it is no parameter"},
    {"*NSET, NSET=A,\nB, 7\n", "line 1: '*NSET' ends with a comma, but '7'"},
    {"*BOUNDARY\n1, 3, 1\n", "'*BOUNDARY' ends at direction 1, before it "
                             "begins, at 3"},
    {"*NODE\n1\n*NSET, NSET=A, ELSET=E\n*BOUNDARY\nA, 1\n",
     "line 5: the set 'A' has the nodes of a set of elements"},
    {"*NODE\n1\n*BOUNDARY\n1, 1\n*STEP\n*BOUNDARY, OP=NEW\n1, 2\n",
     "line 6: '*BOUNDARY' with OP=NEW removes supports"},
    {"*STEP\n*BOUNDARY\n1, 1\n*STEP\n*BOUNDARY\n1, 2\n",
     "line 5: '*BOUNDARY' is in a second step"},
    {"*STEP\n*BOUNDARY, LOAD CASE=2\n1, 1\n", "with LOAD CASE acts"},
    {"*EQUATION\n2\n1, 1, 1.\n*STEP\n",
     "line 3: '*EQUATION' has 1 terms less than it says"},
    {"*EQUATION\n1\n1, 1, 1., 2, 1, 1.\n", "has more terms than it says"},
    {"*EQUATION\n1\n1, 1\n", "'*EQUATION' has a term without a factor"},
    {"*EQUATION, REMOVE\n", "'*EQUATION' with 'REMOVE' is not read"},
    {"*Transform, nset=A\n", "line 1: '*TRANSFORM' turns the directions of "
                             "rows, and is not read"},
    {"*NODE\n1\n*NGEN\n1, 2\n", "'*NGEN' makes nodes, and is not read"},
    {"*MODEL CHANGE, REMOVE\n", "'*MODEL CHANGE' removes elements"},
    {"*USER ELEMENT, NODES=2\n", "'*USER ELEMENT' makes a type"},
    {"*Part, name=A\n*Node\n1\n*End Part\n",
     "line 3: there is no '*INSTANCE' of the part 'A'"},
    {"*Part, name=A\n*Node\n1\n*End Part\n*Instance, name=B, part=B\n",
     "there is no '*INSTANCE' of the part 'A'"},
    {"*Part, name=A\n*Node\n1\n*End Part\n*Part, name=B\n*Node\n1\n",
     "line 6: '*Node' of a second part, instance or assembly"},
    {"*Instance, name=A, part=B\n*Node\n1\n*End Instance\n*Node\n1\n",
     "line 5: '*Node' of a second part"},
    {"*Instance, name=A, part=B\n*Instance, name=C, part=B\n",
     "line 2: there is a second '*INSTANCE'"},
    {"*Instance, name=A, part=B\n1., 0., 0.\n0., 0., 0., 0., 0., 1., 9.\n",
     "line 3: '*INSTANCE' is turned, which is not read"},
    {"*Instance, name=A, part=B\n1., 0., 0., 0., 0., 0., 0., 0., 1., 9.\n",
     "line 2: '*INSTANCE' is turned, which is not read"},
    {"*Instance, library=x, instance=B\n", "is of another analysis"},
    {"*EQUATION\n2, 4, 1, 1.\n", "has its number of terms alone"},
    {"*STEP\n*MATRIX GENERATE\n*END STEP\n*STEP\n*BOUNDARY\n1, 1\n",
     "line 5: '*BOUNDARY' is in a step after the one that makes"},
    {"*INCLUDE\n", "line 1: '*INCLUDE' does not say its INPUT"},
    {"*INCLUDE, INPUT=\n", "INPUT of '*INCLUDE' names no file"},
    {"*INCLUDE, INPUT=x,\n*NODE\n", "ends with a comma, and no line"},
    {"*INCLUDE, INPUT=no_such_file\n", "'t.inp', line 1: cannot open"},
};

static void what_a_deck_cannot_mean_is_refused(void **state)
{
    ritz_deck deck = {0};

    (void)state;
    for (size_t k = 0; k < sizeof MEANINGLESS / sizeof *MEANINGLESS; k++) {
        bool missing = strstr(MEANINGLESS[k].text, "no_such_file") != NULL;
        ritz_status status = parse(MEANINGLESS[k].text, &deck);

        if (status != (missing ? RITZ_ERR_FILE : RITZ_ERR_FORMAT) ||
            !strstr(ritz_error_message(), MEANINGLESS[k].words))
            fail_msg("'%s' is not in '%s'", MEANINGLESS[k].words,
                     status == RITZ_OK ? "" : ritz_error_message());
        assert_null(deck.grids.id);
    }
}

static void too_many_parameters_are_refused(void **state)
{
    char text[400] = "*NODE";
    size_t used = strlen(text);
    ritz_deck deck = {0};

    (void)state;
    for (int k = 0; k < 33; k++)
        used +=
            (size_t)snprintf(text + used, sizeof text - used, ", K%d=%d", k, k);
    assert_fails(parse(text, &deck), RITZ_ERR_FORMAT,
                 "line 1: '*NODE' has more than 32 parameters");
}

/* ---- files --------------------------------------------------------------- */

static void included_lines_go_on_with_the_data_above(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    folder_write("top.inp", "*NODE, NSET=ALL\n1\n*INCLUDE, INPUT=more.inp\n4\n"
                            "*ELEMENT, TYPE=C3D4, INPUT=\"more two.inp\"\n"
                            "*BOUNDARY\nALL, 2\n");
    folder_write("more.inp", "2, 1.\n** a comment\n3, 2.\n");
    folder_write("more two.inp", "1, 1, 2,\n3, 4\n");
    assert_ok(ritz_deck_read(folder_path("top.inp"), &deck));
    assert_int_equal(deck.grids.count, 4);
    assert_cell(&deck.elements, 0, "10: 1 2 3 4");
    assert_dofs(deck.num_fixed, deck.fixed, "1.2 2.2 3.2 4.2");
    folder_write("loop.inp", "*INCLUDE, INPUT=loop.inp\n");
    assert_fails(ritz_deck_read(folder_path("loop.inp"), &deck),
                 RITZ_ERR_FORMAT, "includes itself");
}

/* It is the end of its file, not the next line of the other one. */
static void a_comma_at_the_end_of_a_file_continues_nothing(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    folder_write("top.inp", "*INCLUDE, INPUT=comma.inp\n7, 1.\n8, 2.\n");
    folder_write("comma.inp", "*NODE,\n");
    assert_ok(ritz_deck_read(folder_path("top.inp"), &deck));
    assert_int_equal(deck.grids.count, 2);
    assert_int_equal(deck.grids.id[0], 7);
    ritz_deck_free(&deck);
    folder_write("top.inp", "*NODE\n7\n*INCLUDE, INPUT=comma.inp\nSIZE=3\n");
    folder_write("comma.inp", "*NSET, NSET=A,\n");
    assert_ok(ritz_deck_read(folder_path("top.inp"), &deck));
}

/* Nodes may be in a file that is not read. */
static void without_included_files_nodes_may_be_missing(void **state)
{
    static const char TEXT[] = "*INCLUDE, INPUT=nodes.inp\n*NODE\n1\n"
                               "*ELEMENT, TYPE=MASS\n1, 1\n2, 2\n";
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_ok(
        ritz_deck_parse("t.inp", TEXT, (int64_t)strlen(TEXT), NULL, &deck));
    assert_int_equal(deck.num_dofs, 3);
}

static void files_outside_the_decks_folder_are_not_quoted(void **state)
{
    static const char *const TEXTS[] = {
        "*NODE\npass'word', 1.\n",
        ("*secret\n*SECRET WORD, INPUT=x\nsecret\n"
         "*BOUNDARY\nsecret, secret\n"),
        "*NODE, SYSTEM=secret\n", "*EQUATION, secret\n"};
    const char *inner = folder_path("in");
    ritz_deck deck = {0};

    (void)state;
    assert_int_equal(mkdir(inner, 0700), 0);
    folder_write("in/top.inp", "*INCLUDE, INPUT=../key\n");
    for (size_t k = 0; k < sizeof TEXTS / sizeof *TEXTS; k++) {
        folder_write("key", TEXTS[k]);
        assert_fails(ritz_deck_read(folder_path("in/top.inp"), &deck),
                     RITZ_ERR_FORMAT, "key', line ");
        assert_null(strstr(ritz_error_message(), "secret"));
        assert_null(strstr(ritz_error_message(), "word"));
    }
    assert_int_equal(remove(folder_path("in/top.inp")), 0);
    assert_int_equal(rmdir(inner), 0);
}

/* ---- with matrices ------------------------------------------------------- */

static void matrices_get_the_rows_of_the_deck(void **state)
{
    static const char TWO[] = "*NODE\n4, 1.\n9\n*ELEMENT, TYPE=MASS\n1, 4\n"
                              "2, 9\n*BOUNDARY\n4, 3\n"
                              "*EQUATION\n2\n9, 1, 1., 4, 1, -2.\n";
    const double m[6] = {1, 2, 3, 4, 5, 6};
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 6, m),
                                   .bulk = folder_write("two.inp", TWO)};
    ritz_import_report report = {0};
    ritz_component c = {0};

    (void)state;
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "grids ascending");
    assert_string_equal(report.constraint[0], "EQUATION 1");
    assert_dofs(c.num_dofs, c.dof, "4.1 4.2 9.2 9.3");
    assert_near(c.M.val[0], 1.0 + 2.0 * 4.0 * 2.0, 0.0);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.mass = put_diagonal("m.mtx", 4, m);
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "grids less SPCs and dependents");
    assert_near(c.M.val[0], 1.0, 0.0);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.bulk = folder_write("two.inp", "*NODE\n9\n4\n*ELEMENT, TYPE=MASS\n"
                                           "1, 4\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "two.inp', line 3: the numbers of nodes do not ascend");
    assert_non_null(strstr(ritz_error_message(), "--dofs must name the rows"));
}

static bool external(const char *name, char path[static 512])
{
    const char *data = getenv("RITZ_EXTERNAL_DATA");

    snprintf(path, 512, "%s/%s", data ? data : "", name);
    if (data && access(path, R_OK) == 0)
        return true;
    print_message("skipped: no external data\n");
    return false;
}

/* CalculiX itself names the rows of its matrices. */
static void rows_of_a_real_deck_are_those_of_calculix(void **state)
{
    RITZ_OWN(ritz_deck) deck = {0};
    char path[512], line[80];
    int64_t count = 0;
    FILE *file = NULL;

    (void)state;
    if (!external("calculix/conrod/conrod.inp", path))
        skip();
    assert_ok(ritz_deck_read(path, &deck));
    assert_int_equal(deck.grids.count, 935);
    assert_int_equal(deck.elements.count, 136);
    assert_null(deck.unnumbered);
    assert_cell(&deck.elements, 0,
                "25: 161 43 160 252 41 1 42 159 277 276 275 274 278 279 280 "
                "281 283 282 284 285");
    assert_true(external("calculix/conrod/conrod.dof", path));
    file = fopen(path, "r");
    assert_non_null(file);
    for (; fgets(line, sizeof line, file); count++) {
        char own[80];

        assert_true(count < deck.num_dofs);
        snprintf(own, sizeof own, "%d.%d", (int)deck.dof[count].grid,
                 (int)deck.dof[count].component);
        line[strcspn(line, "\r\n")] = '\0';
        assert_string_equal(line, own);
    }
    assert_int_equal(fclose(file), 0);
    assert_int_equal(count, deck.num_dofs);
}

/* Number of rows of a matrix "row column value". */
static int64_t count_rows(const char *path)
{
    FILE *file = fopen(path, "r");
    char line[80];
    int64_t most = 0;

    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        const int64_t row = strtol(line, NULL, 10);

        most = row > most ? row : most;
    }
    assert_int_equal(fclose(file), 0);
    return most;
}

static void rows_of_real_decks_are_as_many_as_those_of_abaqus(void **state)
{
    static const struct {
        const char *deck, *matrix;
        int64_t grids, elements;
    } CASES[] = {
        {"abaqus/blockC3D4.inp", "abaqus/blockC3D4_STIF1.mtx", 214, 767},
        {"abaqus/blockC3D10.inp", "abaqus/blockC3D10_STIF1.mtx", 257, 122},
    };
    char path[512];

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        RITZ_OWN(ritz_deck) deck = {0};

        if (!external(CASES[k].deck, path))
            skip();
        assert_ok(ritz_deck_read(path, &deck));
        assert_int_equal(deck.grids.count, CASES[k].grids);
        assert_int_equal(deck.elements.count, CASES[k].elements);
        assert_null(deck.unnumbered);
        assert_int_equal(deck.num_dofs, 3 * CASES[k].grids);
        assert_true(external(CASES[k].matrix, path));
        assert_int_equal(count_rows(path), deck.num_dofs);
    }
}

/* ---- hostile ------------------------------------------------------------- */

static const char DECK[] =
    "** a\n*Part, name=P\n*End Part\n*Assembly\n*Instance, name=P-1, part=P\n"
    "1., 2., 3.\n*Node, nset=ALL\n1, 1.5\n2, , 2.D0\n4, 0., 0., 1e1\n3,1.\n"
    "*Element, type=C3D4\n1, 1, 2,\n3, 4\n*Element, type=B32\n2, 1, 2, 3\n"
    "*Element, type=X\n3, 1,\n2\n*Nset, nset=E, generate\n2, 4, 2\n"
    "*Nset, nset=\"q, r\"\n1, E\n*End Instance\n*End Assembly\n"
    "*Include, input=x.inp\n*Equation\n2\n1, 1, 1., 2, 1, -1.,\n"
    "*Tie, name=T\na, b\n*Boundary\nP-1.\"q, r\", 1, 2, 0.5\nP-1.3, PINNED\n"
    "*Step\n*Matrix generate,\nmass\n*End Step\n";

/* No NUL ends the copies: the reader goes by lengths. */
static ritz_status read_bytes(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_deck) deck = {0};

    return ritz_deck_inp.parse(NULL, bytes, size, NULL, &deck);
}

static void a_deck_cut_or_corrupted_anywhere_ends_well(void **state)
{
    (void)state;
    assert_ok(read_bytes(DECK, sizeof DECK - 1));
    damage_cut(read_bytes, DECK, sizeof DECK);
    damage_corrupt(read_bytes, DECK, sizeof DECK - 1);
}

/* Each support names a set of all nodes again. */
static void supports_without_end_are_refused(void **state)
{
    enum { NODES = 20000, SUPPORTS = 1001 };
    char *text = malloc(16 * (NODES + SUPPORTS) + 80);
    size_t used = 0;
    ritz_deck deck = {0};

    (void)state;
    assert_non_null(text);
    used += (size_t)sprintf(text, "*NODE, NSET=A\n");
    for (int k = 1; k <= NODES; k++)
        used += (size_t)sprintf(text + used, "%d\n", k);
    used += (size_t)sprintf(text + used, "*BOUNDARY\n");
    for (int k = 0; k < SUPPORTS; k++)
        used += (size_t)sprintf(text + used, "A, 1\n");
    assert_fails(parse(text, &deck), RITZ_ERR_FORMAT,
                 "supports name more than 20000000 nodes");
    free(text);
}

/* Neither names nor supports go through all of the sets. */
static void many_sets_are_found_at_once(void **state)
{
    enum { SETS = 60000 };
    char *text = malloc(64 * SETS);
    size_t used = 0;
    RITZ_OWN(ritz_deck) deck = {0};

    (void)state;
    assert_non_null(text);
    used += (size_t)sprintf(text, "*NODE\n");
    for (int k = 1; k <= SETS; k++)
        used += (size_t)sprintf(text + used, "%d\n", k);
    for (int k = 1; k <= SETS; k++)
        used += (size_t)sprintf(text + used, "*NSET, NSET=Set-%d\n%d\n", k, k);
    used += (size_t)sprintf(text + used, "*BOUNDARY\n");
    for (int k = 2; k <= SETS; k++)
        used += (size_t)sprintf(text + used, "SET-%d, 2\n", k);
    assert_ok(parse(text, &deck));
    assert_int_equal(deck.num_fixed, SETS - 1);
    assert_int_equal(deck.fixed[0].grid, 2);
    free(text);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(read_bytes(DECK, sizeof DECK - 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_node_has_the_rows_of_its_elements),
    cmocka_unit_test(elements_are_drawn_as_they_are_written),
    cmocka_unit_test(supports_act_on_nodes_and_sets),
    cmocka_unit_test(an_instance_places_its_part),
    cmocka_unit_test(equations_eliminate_their_first_dof),
    cmocka_unit_test(constraints_that_are_not_understood_are_kept),
    cmocka_unit_test(a_support_that_moves_is_kept_as_a_sentence),
    cmocka_unit_test(rows_that_the_deck_does_not_tell_must_be_named),
    cmocka_unit_test(what_a_deck_cannot_mean_is_refused),
    cmocka_unit_test(too_many_parameters_are_refused),
    cmocka_unit_test(included_lines_go_on_with_the_data_above),
    cmocka_unit_test(a_comma_at_the_end_of_a_file_continues_nothing),
    cmocka_unit_test(without_included_files_nodes_may_be_missing),
    cmocka_unit_test(files_outside_the_decks_folder_are_not_quoted),
    cmocka_unit_test(matrices_get_the_rows_of_the_deck),
    cmocka_unit_test(rows_of_a_real_deck_are_those_of_calculix),
    cmocka_unit_test(rows_of_real_decks_are_as_many_as_those_of_abaqus),
    cmocka_unit_test(a_deck_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(supports_without_end_are_refused),
    cmocka_unit_test(many_sets_are_found_at_once),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(inp, tests, folder_make, folder_remove)
