/* Constraints of decks at import: elimination and recovery. */
#include "testing.h"

#include "folder.h"
#include "frame.h"
#include "matrices.h"
#include "matrix_files.h"

#include <ritz/import.h>
#include <ritz/model.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int64_t row(const ritz_component *c, int64_t grid, int64_t direction)
{
    return row_of_dof(c, (ritz_dof){grid, direction});
}

/* ---- an independent elimination ---------------------------------------- */

static const char *shipped(const char *name, size_t size, char *path)
{
    const char *data = getenv("RITZ_DATA");

    snprintf(path, size, "%s/tied/%s", data ? data : "", name);
    return data && access(path, R_OK) == 0 ? path : NULL;
}

/* data/tied: K and M before, and after elimination by MYSTRAN. */
static void another_solver_eliminates_to_the_same_matrices(void **)
{
    char path[5][300];
    ritz_import_request request = {0};
    ritz_import_report report = {0};
    RITZ_OWN(ritz_component) mine = {0}, theirs = {0};

    if (!shipped("kgg.mtx", sizeof path[0], path[0])) {
        print_message("skipped: no RITZ_DATA\n");
        skip();
    }
    request.stiffness = path[0];
    request.mass = shipped("mgg.mtx", sizeof path[1], path[1]);
    request.bulk = shipped("tied.bdf", sizeof path[2], path[2]);
    assert_ok(ritz_import(&request, &mine, &report));
    assert_string_equal(report.map, "grids ascending");
    assert_int_equal(report.num_eliminated, 18);
    assert_int_equal(report.num_recovered, 18);
    assert_int_equal(report.num_lost, 0);
    assert_int_equal(report.num_constraints, 4);
    assert_string_equal(report.constraint[0], "RBE2 101");
    assert_string_equal(report.constraint[3], "MPC 9");
    ritz_import_report_free(&report);
    /* theirs, by a size that the same deck explains */
    request.stiffness = shipped("kaa.mtx", sizeof path[3], path[3]);
    request.mass = shipped("maa.mtx", sizeof path[4], path[4]);
    assert_ok(ritz_import(&request, &theirs, &report));
    assert_string_equal(report.map, "grids less SPCs and dependents");
    assert_int_equal(report.num_eliminated, 0);
    assert_int_equal(report.num_recovered, 18);
    /* eps times the entries, up to 1e7 and 9, and the lengths up to 2 */
    assert_near_sparse(&mine.K, &theirs.K, 1e7 * 4.0 * 0x1p-52);
    assert_near_sparse(&mine.M, &theirs.M, 9.0 * 16.0 * 0x1p-52);
    /* recovered alike from either, as the constraints are the deck's */
    assert_near_sparse(&mine.recovery.G, &theirs.recovery.G, 0.0);
    assert_int_equal(ritz_grids_find(&theirs.grids, 11) >= 0, 1);
    ritz_import_report_free(&report);
    ritz_component_free(&theirs);
}

static void sizes_of_the_deck_are_told_apart(void **)
{
    char path[300];
    double ones[60];
    ritz_import_request request = {0};
    ritz_import_report report = {0};
    ritz_component c = {0};

    if (!shipped("tied.bdf", sizeof path, path)) {
        print_message("skipped: no RITZ_DATA\n");
        skip();
    }
    for (int k = 0; k < 60; k++)
        ones[k] = 1.0;
    request.bulk = path;
    request.mass = put_diagonal("m.mtx", 42, ones);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 42 rows, as the deck's grids less SPCs has and its grids "
                 "less dependents have: --dofs must say which");
    request.mass = put_diagonal("m.mtx", 41, ones);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 41 rows; the deck explains 60 (10 grids) or 42 (grids "
                 "less SPCs) or 24 (grids less SPCs and dependents)");
}

/* ---- closed form ------------------------------------------------------- */

/* Grid 3 at the origin, grid 7 with axes of its own (x to y) at (2, 0, 0). */
static const char LEVER[] = "CORD2R,4,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n"
                            "GRID,3\nGRID,7,,2.,0.,0.,4\n"
                            "RBE2,600,3,123456,7\n";

static void a_mass_on_a_rigid_lever_is_where_it_should_be(void **)
{
    /* 7 has mass 5 and inertia 0.1, 3 has 1, 2, 3, ... on its diagonal */
    const double k[12] = {10, 20, 30, 40, 50, 60};
    const double m[12] = {1, 1, 1, 1, 1, 1, 5, 5, 5, 0.1, 0.1, 0.1};
    const char *const outputs[] = {"tip=7:2@0.5", "spin=7:6/vel"};
    const char *const inputs[] = {"push=7:2*3", "turn=7:6"};
    const ritz_import_request request = {
        .stiffness = put_diagonal("k.mtx", 12, k),
        .mass = put_diagonal("m.mtx", 12, m),
        .bulk = folder_write("deck.bdf", LEVER),
        .num_inputs = 2,
        .input = inputs,
        .num_outputs = 2,
        .output = outputs};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    ritz_inertia inertia = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 6);
    assert_int_equal(report.num_eliminated, 6);
    /* parallel axes: 1 + 0.1 + 5 2^2 about y and z, and 5 2 across */
    assert_near(entry(&c.M, 0, 0), 6.0, 0.0);
    assert_near(entry(&c.M, 3, 3), 1.1, 0x1p-52);
    assert_near(entry(&c.M, 5, 5), 21.1, 0x1p-47);
    assert_near(entry(&c.M, 1, 5), 10.0, 0.0);
    assert_near(entry(&c.M, 2, 4), -10.0, 0.0);
    assert_near(entry(&c.K, 5, 5), 60.0, 0.0);
    assert_ok(ritz_inertia_of(&c, &inertia));
    assert_near(inertia.mass, 6.0, 0.0);
    assert_near(inertia.centre[0], 10.0 / 6.0, 1e-15);
    /* along basic y at 7: u_y + 2 r_z of 3, for forces as for displacements */
    assert_near(c.io.C.val[2 * row(&c, 3, 2)], 1.0, 0.0);
    assert_near(c.io.C.val[2 * row(&c, 3, 6)], 2.0, 0.0);
    assert_near(c.io.Cv.val[1 + 2 * row(&c, 3, 6)], 1.0, 0.0);
    assert_near(c.io.B.val[row(&c, 3, 2)], 3.0, 0.0);
    assert_near(c.io.B.val[row(&c, 3, 6)], 6.0, 0.0);
    assert_near(c.io.B.val[6 + row(&c, 3, 6)], 1.0, 0.0);
    /* recovered along its own axes: u7_x' = u_y + 2 r_z */
    assert_int_equal(c.recovery.count, 6);
    assert_near(entry(&c.recovery.G, 0, row(&c, 3, 2)), 1.0, 0.0);
    assert_near(entry(&c.recovery.G, 0, row(&c, 3, 6)), 2.0, 0.0);
    assert_near(entry(&c.recovery.G, 0, row(&c, 3, 1)), 0.0, 0.0);
}

/* A body without stiffness of its own is carried by what depends on it. */
static void a_leader_needs_no_rows_of_its_own(void **)
{
    const double m[6] = {5, 5, 5, 1, 1, 1};
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 6, m),
        .bulk = folder_write("deck.bdf", LEVER),
        .dofs = folder_write("dofs", "7 1\n7 2\n7 3\n7 4\n7 5\n7 6\n")};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_ok(ritz_import(&request, &c, &report)); /* 7 goes, 3 comes */
    assert_int_equal(c.num_dofs, 6);
    assert_int_equal(c.dof[0].grid, 3);
    assert_near(entry(&c.M, 5, 5), 21.0, 0.0);
    assert_int_equal(report.num_eliminated, 6);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    /* rows of 3 alone: it has been done, and 7 is recovered */
    request.dofs = folder_write("dofs", "3 1\n3 2\n3 3\n3 4\n3 5\n3 6\n");
    assert_ok(ritz_import(&request, &c, &report));
    assert_near(entry(&c.M, 5, 5), 1.0, 0.0);
    assert_int_equal(report.num_eliminated, 0);
    assert_int_equal(c.recovery.count, 6);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    /* and part of them: what follows the others is not known */
    request.mass = put_diagonal("m.mtx", 2, m);
    request.dofs = folder_write("dofs", "3 2\n3 6\n");
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 2);
    assert_int_equal(report.num_recovered, 2); /* 7.1 and 7.6 */
    assert_int_equal(report.num_lost, 4);
    assert_int_equal(c.recovery.dof[0].component, 1);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
}

static void what_is_fixed_holds_what_depends_on_it(void **)
{
    const double m[12] = {1, 1, 1, 1, 1, 1, 5, 5, 5, 1, 1, 1};
    char text[300];
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 12, m)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    snprintf(text, sizeof text, "%sSPC1,1,12345,3\n", LEVER);
    request.bulk = folder_write("deck.bdf", text);
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 1);
    assert_near(entry(&c.M, 0, 0), 22.0, 0.0);
    assert_int_equal(report.num_fixed, 5);
    /* 7.1 turns with 2 r_z; 7.2 is held, and recovered as nothing */
    assert_int_equal(c.recovery.count, 6);
    assert_near(entry(&c.recovery.G, 0, 0), 2.0, 0.0);
    assert_near(entry(&c.recovery.G, 1, 0), 0.0, 0.0);
}

/* ---- refusals ---------------------------------------------------------- */

static void decks_that_contradict_themselves_are_refused(void **)
{
    static const struct {
        const char *card, *words;
    } cases[] = {
        {"SPC1,1,3,7\n", "'grid 7 T3' depends on RBE2 600 ('"},
        {"SPC1,1,3,7\n", "line 5) and is fixed by the deck: it cannot be both"},
        {"ASET1,2,7\n", "line 5) and is in the a-set: it cannot be both"},
        {"MPC,8,7,1,1.0,3,1,-1.0\n", "'grid 7 T1' depends on RBE2 600 ('"},
        {"MPC,8,7,1,1.0,3,1,-1.0\n", "and on MPC 8 ('"},
        {"RSPLINE,9,,3,7\n", "RSPLINE 9 is not understood: MPC, RBAR"},
        {"RSPLINE,9,,3,7\n",
         "; the matrices still hold its dofs, and matrices of the a-set would "
         "not"},
        {"SPC,1,3,3,0.25\n",
         "SPC 1 moves '3' by what is not zero: imposed motion is no part of a "
         "component"},
        {"MPC,8,3,1,1.0,7,2,1.0\n", "leaves 'grid 7 T2' undetermined"},
    };
    const double m[12] = {1, 1, 1, 1, 1, 1, 5, 5, 5, 1, 1, 1};
    char text[300];
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_import_request request = {.mass = put_diagonal("m.mtx", 12, m)};

        snprintf(text, sizeof text, "%s%s", LEVER, cases[k].card);
        request.bulk = folder_write("deck.bdf", text);
        assert_true(ritz_import(&request, &c, &report) != RITZ_OK);
        if (!strstr(ritz_error_message(), cases[k].words))
            fail_msg("%s: '%s'", cases[k].card, ritz_error_message());
    }
    assert_null(c.dof);
}

static void what_is_not_understood_matters_only_where_it_acts(void **)
{
    const double m[6] = {1, 1, 1, 1, 1, 1};
    char text[300];
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 6, m)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    snprintf(text, sizeof text, "%sRSPLINE,9,,3,7\nASET1,123456,3\n", LEVER);
    request.bulk = folder_write("deck.bdf", text);
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "A-set");
    assert_int_equal(c.recovery.count, 0);
    assert_int_equal(report.num_constraints, 0);
    assert_non_null(strstr(report.unknown, "RSPLINE 9 is not understood"));
}

static void a_dof_that_depends_cannot_be_attached(void **)
{
    static const char *const ports[] = {"a=7", "a=3,7:2", "a=1-9:3"};
    const double m[12] = {1, 1, 1, 1, 1, 1, 5, 5, 5, 1, 1, 1};
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 12, m),
                                   .bulk = folder_write("deck.bdf", LEVER),
                                   .num_ports = 1};
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof ports / sizeof *ports; k++) {
        request.port = &ports[k];
        assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                     "depends on RBE2 600 ('");
        assert_non_null(strstr(ritz_error_message(),
                               "cannot be attached: attach what it follows, "
                               "grid 3"));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(another_solver_eliminates_to_the_same_matrices),
    cmocka_unit_test(sizes_of_the_deck_are_told_apart),
    cmocka_unit_test(a_mass_on_a_rigid_lever_is_where_it_should_be),
    cmocka_unit_test(a_leader_needs_no_rows_of_its_own),
    cmocka_unit_test(what_is_fixed_holds_what_depends_on_it),
    cmocka_unit_test(decks_that_contradict_themselves_are_refused),
    cmocka_unit_test(what_is_not_understood_matters_only_where_it_acts),
    cmocka_unit_test(a_dof_that_depends_cannot_be_attached),
};

TEST_MODULE(import_constraints, tests, folder_make, folder_remove)
