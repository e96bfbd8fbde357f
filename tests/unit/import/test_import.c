/* Importing small decks and matrices that are written here. */
#include "testing.h"

#include "folder.h"
#include "matrix_files.h"

#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>

/* Three grids (7 turned by 90 degrees about z) and a point between them. */
static const char deck[] = "BEGIN BULK\n"
                           "CORD2R,4,,0.,0.,0.,0.,0.,1.\n"
                           ",0.,1.,0.\n"
                           "GRID,9,,4.,0.,0.\n"
                           "GRID,3,,1.,0.,0.\n"
                           "GRID,7,,2.,6.,0.,4\n"
                           "SPOINT,5\n";

static const double full[19] = {1,  2,  3,  4,  5,  6,  7,  8,  9, 10,
                                11, 12, 13, 14, 15, 16, 17, 18, 19};

static void grids_ascend_with_six_rows_and_points_with_one(void **)
{
    const char *const ports[] = {"all=1-8:123", "points=5:0", "pair=9,3"};
    const ritz_import_request request = {
        .stiffness = put_diagonal("k.mtx", 19, full),
        .mass = put_diagonal("m.mtx", 19, full),
        .bulk = folder_write("deck.bdf", deck),
        .num_ports = 3,
        .port = ports,
        .units = "kg m s"};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 19);
    assert_int_equal(c.dof[5].grid, 3);
    assert_int_equal(c.dof[5].component, 6);
    assert_int_equal(c.dof[6].grid, 5);
    assert_int_equal(c.dof[6].component, 0);
    assert_int_equal(c.dof[7].grid, 7);
    assert_int_equal(c.dof[18].grid, 9);
    assert_string_equal(report.map, "grids ascending");
    assert_string_equal(c.units, "kg m s");
    /* the range takes the grids 3 and 7, and not the point */
    assert_int_equal(c.port[0].dofs.count, 6);
    assert_int_equal(c.port[0].dofs.at[3], 7);
    assert_near(c.port[0].origin[0], 1.5, 0.0); /* the mean of grids 1 and 2 */
    assert_near(c.port[0].origin[1], 3.0, 0.0);
    assert_int_equal(c.port[1].dofs.at[0], 6);
    /* as listed: grid 9 first */
    assert_int_equal(c.port[2].dofs.count, 12);
    assert_int_equal(c.port[2].dofs.at[0], 13);
    assert_int_equal(c.port[2].dofs.at[6], 0);
}

static void rows_empty_in_both_are_removed_and_others_stay(void **)
{
    const double k[6] = {1, 1, 0, 1, 0, 1};
    const double m[6] = {1, 1, 1, 0, 0, 1};
    const ritz_import_request request = {.stiffness =
                                             put_diagonal("k.mtx", 6, k),
                                         .mass = put_diagonal("m.mtx", 6, m)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 5);
    assert_int_equal(report.num_removed, 1);
    assert_int_equal(report.removed[0].grid, 1);
    assert_int_equal(report.removed[0].component, 5);
    assert_int_equal(report.num_massless, 1);
    assert_int_equal(report.num_floating, 1);
    assert_int_equal(c.grids.count, 1); /* one grid lies at the origin */
}

static void mass_alone_is_a_rigid_component(void **)
{
    const ritz_import_request request = {.mass =
                                             put_diagonal("m.mtx", 6, full)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 6);
    assert_int_equal(c.K.colptr[6], 0);
    assert_int_equal(report.num_floating, 0);
}

static void rows_that_the_deck_fixes_are_taken_out(void **)
{
    const ritz_import_request request = {
        .stiffness = put_diagonal("k.mtx", 6, full),
        .mass = put_diagonal("m.mtx", 6, full),
        .bulk = folder_write("deck.bdf", "GRID,3,,1.,0.,0.,,156\n")};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 3);
    assert_int_equal(report.num_fixed, 3);
    assert_int_equal(report.fixed[2].component, 6);
    assert_near(c.K.val[0], 2.0, 0.0);
}

/* Their rows may be missing: they do not move. */
static void grids_that_the_deck_holds_have_places(void **state)
{
    const ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 3, full),
        .dofs = folder_write("m.dofs", "5 1\n5 2\n5 3\n"),
        .bulk = folder_write("deck.bdf",
                             "GRID,3,,1.,0.,0.,,123\nGRID,4,,2.,0.,0.,,12\n"
                             "GRID,5,,3.,0.,0.\nGRID,6,,4.,0.,0.\n"
                             "CBAR,1,1,3,5,4\nCBAR,2,1,4,5,3\n")};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 3);
    assert_int_equal(report.num_fixed, 0);
    assert_int_equal(c.grids.count, 2); /* of 4 and 6 it is not known */
    assert_int_equal(c.grids.id[0], 3);
    assert_int_equal(c.grids.id[1], 5);
    assert_near(c.grids.position[0], 1.0, 0.0);
    assert_int_equal(c.elements.count, 1);
    assert_int_equal(report.num_hidden, 1);
}

static void other_sizes_are_the_a_set_or_grids_less_spcs(void **)
{
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 4, full),
        .bulk = folder_write("deck.bdf", "GRID,3,,1.,0.,0.,,156\n"
                                         "GRID,4,,1.,0.,0.\nSPOINT,9\n"
                                         "BSET1,123,4\nQSET1,,9\n")};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "A-set");
    assert_int_equal(c.dof[0].grid, 4);
    assert_int_equal(c.dof[3].grid, 9);
    assert_int_equal(c.dof[3].component, 0);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.mass = put_diagonal("m.mtx", 10, full);
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "grids less SPCs");
    assert_int_equal(c.dof[0].component, 2);
    assert_int_equal(c.dof[1].component, 3);
    assert_int_equal(c.dof[2].component, 4);
    assert_int_equal(c.dof[3].grid, 4);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.mass = put_diagonal("m.mtx", 7, full);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 7 rows; the deck explains 13 (2 grids, 1 points) or 4 "
                 "(a-set) or 10 (grids less SPCs)");
}

static void constraints_act_on_matrices_that_have_their_dofs(void **)
{
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 12, full),
        .bulk =
            folder_write("deck.bdf", "GRID,3,,1.,0.,0.\nGRID,4,,2.,0.,0.\n"
                                     "RBE2,600,3,123456,4\nASET1,123456,3\n")};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "grids ascending");
    assert_int_equal(c.num_dofs, 6);
    assert_int_equal(report.num_eliminated, 6);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    request.mass = put_diagonal("m.mtx", 6, full); /* eliminated already */
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "A-set");
    assert_int_equal(report.num_eliminated, 0);
    ritz_component_free(&c);
    ritz_import_report_free(&report);
}

static void a_file_of_names_rules(void **)
{
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 3, full),
        .dofs = folder_write("dofs", "# GRID COMP\n 8 3\n\n7 2 # y\n9 0\n")};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.dof[0].grid, 8);
    assert_int_equal(c.dof[2].component, 0);
    assert_string_equal(report.map, "--dofs");
    ritz_component_free(&c);
    ritz_import_report_free(&report);
    folder_write("dofs", "8 3\n7 2\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "names 2 dofs");
    folder_write("dofs", "8 3\n7 2\n\n8 3\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "line 4: 'grid 8 T3' was named at line 1 already");
    folder_write("dofs", "8 3\n7 x\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT, "line 2");
    folder_write("dofs", "8 3\n7 7\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "'7 7' is no dof");
    folder_write("dofs", "8 3 4\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT, "line 1");
}

/* K has rows 1 T1 and 2 T1, M has 2 T1 and point 5: together three. */
static void matrices_that_name_their_rows_are_united(void **)
{
    const char *file = folder_write(
        "k.pch", "DMIG    K              0       6       2       0\n"
                 "DMIG    K              1       1               1"
                 "       1      5.\n"
                 "DMIG    K              2       1               2"
                 "       1      7.\n"
                 "DMIG    M              0       6       2       0\n"
                 "DMIG    M              2       1               2"
                 "       1      3.\n"
                 "DMIG    M              5       0               5"
                 "       0      4.\n");
    char K[300];
    char M[300];
    const ritz_import_request request = {.stiffness = K, .mass = M};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    snprintf(K, sizeof K, "%s:K", file);
    snprintf(M, sizeof M, "%s:M", file);
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "file");
    assert_int_equal(c.num_dofs, 3);
    assert_int_equal(report.num_massless, 1);
    assert_int_equal(report.num_floating, 1);
    assert_int_equal(c.M.rowind[0], 1);
    assert_near(c.M.val[0], 3.0, 0.0);
    assert_int_equal(c.dof[2].grid, 5);
}

/* Axis 1 of grid 7 is basic y, its axis 2 is basic -x. */
static void inputs_and_outputs_act_along_basic_axes(void **)
{
    const char *const inputs[] = {"fx=7:1*2.5", "q=5:0", "mz=3:6"};
    const char *const outputs[] = {"y=7:2", "v=3:1/vel", "a=9:6/acc@1e-3"};
    const ritz_import_request request = {.mass =
                                             put_diagonal("m.mtx", 19, full),
                                         .bulk = folder_write("deck.bdf", deck),
                                         .num_inputs = 3,
                                         .input = inputs,
                                         .num_outputs = 3,
                                         .output = outputs};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    /* frames are built of square roots: two eps */
    assert_near(ritz_dense_col(&c.io.B, 0)[7], 0.0, 1e-15);
    assert_near(ritz_dense_col(&c.io.B, 0)[8], -2.5, 1e-15);
    assert_near(ritz_dense_col(&c.io.B, 1)[6], 1.0, 0.0);
    assert_near(ritz_dense_col(&c.io.B, 2)[5], 1.0, 0.0);
    assert_near(ritz_dense_col(&c.io.C, 7)[0], 1.0, 1e-15);
    assert_near(ritz_dense_col(&c.io.Cv, 0)[1], 1.0, 0.0);
    assert_near(ritz_dense_col(&c.io.Ca, 18)[2], 1.0, 0.0);
    assert_near(c.io.limit[2], 1e-3, 0.0);
    assert_true(isnan(c.io.limit[0]));
    assert_string_equal(c.io.input[0], "fx");
}

/* Inputs and outputs of several terms are the sums of those of single dofs
 * times their scales; grid 7 is turned. */
static void terms_of_inputs_and_outputs_add_up(void **)
{
    const char *const inputs[] = {"a=3:1", "b=7:2", "c=5:0",
                                  "u=3:1,7:2*-0.5,5:0*4,3:1*2"};
    const char *const outputs[] = {"a=3:1/vel", "b=7:2/vel",
                                   "gap=3:1,7:2*-1/vel@1e-3", "s=5:0*-3"};
    const ritz_import_request request = {.mass =
                                             put_diagonal("m.mtx", 19, full),
                                         .bulk = folder_write("deck.bdf", deck),
                                         .num_inputs = 4,
                                         .input = inputs,
                                         .num_outputs = 4,
                                         .output = outputs};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    for (int64_t i = 0; i < 19; i++) {
        const double *Cv = ritz_dense_col(&c.io.Cv, i);

        /* exact: few terms, and scales are powers of two */
        assert_near(ritz_dense_col(&c.io.B, 3)[i],
                    3.0 * ritz_dense_col(&c.io.B, 0)[i] -
                        0.5 * ritz_dense_col(&c.io.B, 1)[i] +
                        4.0 * ritz_dense_col(&c.io.B, 2)[i],
                    0.0);
        assert_near(Cv[2], Cv[0] - Cv[1], 0.0);
    }
    assert_near(ritz_dense_col(&c.io.B, 3)[0], 3.0, 0.0);
    assert_near(ritz_dense_col(&c.io.B, 3)[7], -0.5, 1e-15);
    assert_near(ritz_dense_col(&c.io.C, 6)[3], -3.0, 0.0);
    assert_near(c.io.limit[2], 1e-3, 0.0);
    assert_string_equal(c.io.output[2], "gap");
}

/* Grid 7 is turned: its first axis is the second basic one. */
static void dampers_lie_along_basic_axes(void **)
{
    const char *const dampers[] = {"strut=7:1,3:1*150*-200", "foot=5:0*2"};
    const ritz_import_request request = {.mass =
                                             put_diagonal("m.mtx", 19, full),
                                         .bulk = folder_write("deck.bdf", deck),
                                         .num_dampers = 2,
                                         .damper = dampers};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    const double *b = NULL;

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.dampers.count, 2);
    assert_string_equal(c.dampers.name[0], "strut");
    assert_near(c.dampers.c[0], 150.0, 0.0);
    assert_near(c.dampers.k[0], -200.0, 0.0);
    assert_near(c.dampers.c[1], 2.0, 0.0);
    assert_near(c.dampers.k[1], 0.0, 0.0);
    assert_null(c.D.colptr);
    b = ritz_dense_col(&c.dampers.B, 0);
    /* frames are built of square roots: two eps */
    assert_near(b[0], -1.0, 0.0);
    assert_near(b[7], 0.0, 1e-15);
    assert_near(b[8], -1.0, 1e-15);
    assert_near(ritz_dense_col(&c.dampers.B, 1)[6], 1.0, 0.0);
}

/* One wrong text, and the sentence that it gets. */
typedef struct refusal {
    const char *text, *says;
} refusal;

static void wrong_ports_are_refused(void **)
{
    static const refusal cases[] = {
        {"a", "form NAME=GRIDS[:COMPS]"},
        {"a=", "form NAME=GRIDS"},
        {"=3", "a name is empty"},
        {"a=3,", "'' is no part"},
        {"a=x", "'x' is no part"},
        {"a=9-3", "'9-3' is no part"},
        {"a=6", "no grid or point '6'"},
        {"a=3,3", "listed twice"},
        {"a=1-4,3", "listed twice"},
        {"a=10-20", "nothing from 10"},
        {"a=3:", "no directions"},
        {"a=3:17", "'17' are not"},
        {"a=3:11", "each once"},
        {"a=3:01", "'01' are not"},
        {"a=5:1", "no 'grid 5 T1'"},
        {"a=7:1", "axes of its own"},
        {"a=3:0", "there is no 'point 3'"},
    };
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 19, full),
                                   .bulk = folder_write("deck.bdf", deck),
                                   .num_ports = 1};
    const char *const twice[] = {"a=3", "a=9"};
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        request.port = &cases[k].text;
        assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                     cases[k].says);
    }
    request.num_ports = 2;
    request.port = twice;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "two ports 'a'");
    assert_null(c.dof);
}

static void wrong_inputs_and_outputs_are_refused(void **)
{
    static const refusal inputs[] = {
        {"a=3", "no grid and direction"},
        {"a=3:7", "no grid and direction"},
        {"a=4:1", "the nearest is 3"},
        {"a=3:1*x", "'x' is no number"},
        {"a=3:1*0", "other than zero"},
        {"a=5:2", "no 'grid 5 T2'"},
        {"3:1", "form NAME=GRID:COMP[*SCALE][,...]"},
        {"a=3:1,", "'' is no grid and direction"},
        {"a=3:1,,7:1", "'' is no grid and direction"},
        {"a=3:1,4:1", "the nearest is 3"},
        {"a=3:1*2*3", "'2*3' is no number"},
        {"a=3:1*2,7:1*x", "'x' is no number"},
        {"a=3:1*,7:1", "'' is no number"},
        {"a=7:1,3:2*2,7:1*-1,3:2*-2", "cancel each other"},
    };
    static const refusal outputs[] = {
        {"a=3:1/dis", "neither 'vel' nor 'acc'"},
        {"a=3:1@-1", "a limit is positive"},
        {"a=3:1@", "'' is no number"},
        {"a=3:1/vel,7:1", "'vel,7:1' is neither 'vel' nor 'acc'"},
        {"a=3:1,3:1*-1/acc", "the terms of '3:1,3:1*-1' cancel"},
        {"3:1", "form NAME=GRID:COMP[*SCALE][,...][/vel|/acc][@LIMIT]"},
    };
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 19, full),
                                   .bulk = folder_write("deck.bdf", deck)};
    const char *const twice[] = {"a=3:1", "a=3:2"};
    ritz_import_report report = {0};
    ritz_component c = {0};

    request.num_inputs = 1;
    for (size_t k = 0; k < sizeof inputs / sizeof *inputs; k++) {
        request.input = &inputs[k].text;
        assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                     inputs[k].says);
    }
    request.num_inputs = 0;
    request.num_outputs = 1;
    for (size_t k = 0; k < sizeof outputs / sizeof *outputs; k++) {
        request.output = &outputs[k].text;
        assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                     outputs[k].says);
    }
    request.num_outputs = 2;
    request.output = twice;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "two outputs 'a'");
}

static void wrong_matrices_are_refused(void **)
{
    ritz_import_request request = {0};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "no mass matrix");
    request.mass =
        folder_write("c.mtx", "%%MatrixMarket matrix coordinate complex "
                              "general\n1 1 1\n1 1 2 3\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "is complex");
    request.mass =
        folder_write("r.mtx", "%%MatrixMarket matrix coordinate real "
                              "general\n6 5 1\n1 1 2\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "is 6 x 5");
    request.mass = put_diagonal("m.mtx", 7, full);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "not six for each grid");
    request.stiffness = put_diagonal("k.mtx", 6, full);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 7 rows");
}

static void asymmetry_is_refused_unless_it_is_to_be_averaged(void **)
{
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 6, full),
        .stiffness =
            folder_write("k.mtx", "%%MatrixMarket matrix coordinate real "
                                  "general\n6 6 3\n1 1 2\n1 2 1\n2 1 0.5\n")};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "--symmetrise");
    request.symmetrise = true;
    assert_ok(ritz_import(&request, &c, &report));
    assert_near(c.asymmetry, 0.25, 0.0); /* 0.5 of 2 */
    assert_near(c.K.val[1], 0.75, 0.0);
}

static void wrong_dampers_are_refused(void **)
{
    static const refusal dampers[] = {
        {"a=3:1", "'a=3:1' is not of the form NAME=GRID:COMP[,GRID:COMP]*C"},
        {"a=3:1*x", "'x' is neither C nor C*K"},
        {"a=3:1*1*", "'1*' is neither C nor C*K"},
        {"a=3:1*1*2*3", "is neither C nor C*K"},
        {"a=3:1*inf", "is neither C nor C*K"},
        {"a=3:1*-2", "a damper's c is not negative, '-2' is"},
        {"a=3:1,3:1*2", "nothing moves between '3:1,3:1'"},
        {"a=3:1,4:1*2", "the nearest is 3"},
        {"a=,3:1*2", "no grid and direction"},
        {"3:1*2", "form NAME=GRID:COMP"},
    };
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 19, full),
                                   .bulk = folder_write("deck.bdf", deck),
                                   .num_dampers = 1};
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof dampers / sizeof *dampers; k++) {
        request.damper = &dampers[k].text;
        assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                     dampers[k].says);
    }
}

static ritz_status import_and_free(const ritz_import_request *request)
{
    ritz_import_report report = {0};
    ritz_component c = {0};
    ritz_status status = ritz_import(request, &c, &report);

    ritz_component_free(&c);
    ritz_import_report_free(&report);
    return status;
}

static void no_allocation_failure_leaks(void **)
{
    const char *const ports[] = {"a=3,7", "b=5"};
    const char *const inputs[] = {"u=7:1,9:2*3"};
    const char *const outputs[] = {"y=7:1,5:0*-1/acc"};
    const char *const dampers[] = {"d=7:1,3:2*5*-6"};
    char load[300];
    const char *const loads[] = {load}, *const preloads[] = {"spin=2"};
    const ritz_import_request request = {
        .stiffness = put_diagonal("k.mtx", 19, full),
        .mass = put_diagonal("m.mtx", 19, full),
        .bulk = folder_write("deck.bdf", deck),
        .num_loads = 1,
        .load = loads,
        .num_preloads = 1,
        .preload = preloads,
        .num_ports = 2,
        .port = ports,
        .num_inputs = 1,
        .input = inputs,
        .num_outputs = 1,
        .output = outputs,
        .num_dampers = 1,
        .damper = dampers};

    snprintf(load, sizeof load, "%s@spin", request.stiffness);
    assert_survives_every_allocation(import_and_free(&request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(grids_ascend_with_six_rows_and_points_with_one),
    cmocka_unit_test(rows_empty_in_both_are_removed_and_others_stay),
    cmocka_unit_test(mass_alone_is_a_rigid_component),
    cmocka_unit_test(rows_that_the_deck_fixes_are_taken_out),
    cmocka_unit_test(grids_that_the_deck_holds_have_places),
    cmocka_unit_test(other_sizes_are_the_a_set_or_grids_less_spcs),
    cmocka_unit_test(constraints_act_on_matrices_that_have_their_dofs),
    cmocka_unit_test(a_file_of_names_rules),
    cmocka_unit_test(matrices_that_name_their_rows_are_united),
    cmocka_unit_test(inputs_and_outputs_act_along_basic_axes),
    cmocka_unit_test(terms_of_inputs_and_outputs_add_up),
    cmocka_unit_test(dampers_lie_along_basic_axes),
    cmocka_unit_test(wrong_dampers_are_refused),
    cmocka_unit_test(wrong_ports_are_refused),
    cmocka_unit_test(wrong_inputs_and_outputs_are_refused),
    cmocka_unit_test(wrong_matrices_are_refused),
    cmocka_unit_test(asymmetry_is_refused_unless_it_is_to_be_averaged),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(import, tests, folder_make, folder_remove)
