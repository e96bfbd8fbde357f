/* Inputs and outputs from matrix files, and models without grids. */
#include "testing.h"

#include "folder.h"
#include "matrix_files.h"

#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>

#define ARRAY "%%MatrixMarket matrix array real general\n"

/* Write a matrix whose entries are lines "row column value". */
static const char *put_entries(const char *name, int nrow, int ncol, int count,
                               const char *entries)
{
    char text[2048];

    snprintf(text, sizeof text,
             "%%%%MatrixMarket matrix coordinate real general\n%d %d %d\n%s",
             nrow, ncol, count, entries);
    return folder_write(name, text);
}

/* Grid 7 is turned: its first axis is the basic second axis, its second axis
 * the basic first axis reversed. */
static const char deck[] = "BEGIN BULK\n"
                           "CORD2R,4,,0.,0.,0.,0.,0.,1.\n"
                           ",0.,1.,0.\n"
                           "GRID,9,,4.,0.,0.\n"
                           "GRID,3,,1.,0.,0.\n"
                           "GRID,7,,2.,6.,0.,4\n"
                           "SPOINT,5\n";

/* Rows of matrices: grid 3 has rows 1 to 6, point 5 has row 7, grid 7 begins at
   row 8. */
static void inputs_by_matrix_and_by_text_agree(void **)
{
    const char *const inputs[] = {"a=3:1,7:2*2", "b=5:0*-4"};
    const char *const outputs[] = {"a=3:1,7:1*-3", "b=9:6/vel", "c=5:0/acc@2"};
    const ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 19, NULL),
        .bulk = folder_write("deck.bdf", deck),
        .num_inputs = 2,
        .input = inputs,
        .num_outputs = 3,
        .output = outputs,
        .input_matrix =
            put_entries("b.mtx", 19, 2, 3, "1 1 1\n8 1 2\n7 2 -4\n"),
        .output_matrix = put_entries("c.mtx", 3, 19, 2, "1 1 1\n1 9 3\n"),
        .velocity_matrix = put_entries("v.mtx", 19, 3, 1, "19 2 1\n"),
        .acceleration_matrix = put_entries("a.mtx", 3, 19, 1, "3 7 1\n"),
        .input_names = "x,y",
        .output_names = "p,q,r@1e-3"};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    const ritz_io *io = &c.io;

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(io->num_inputs, 4);
    assert_int_equal(io->num_outputs, 6);
    assert_string_equal(io->input[1], "b");
    assert_string_equal(io->input[2], "x");
    assert_string_equal(io->output[5], "r");
    assert_near(io->limit[2], 2.0, 0.0);
    assert_near(io->limit[5], 1e-3, 0.0);
    assert_true(isnan(io->limit[3]));
    for (int64_t i = 0; i < 19; i++)
        for (int64_t k = 0; k < 3; k++) {
            const double *C = ritz_dense_col(&io->C, i);
            const double *Cv = ritz_dense_col(&io->Cv, i);
            const double *Ca = ritz_dense_col(&io->Ca, i);

            /* frames contain square roots: two eps, times the scale 3 */
            if (k < 2)
                assert_near(ritz_dense_col(&io->B, k)[i],
                            ritz_dense_col(&io->B, k + 2)[i], 2e-15);
            assert_near(C[k], C[k + 3], 2e-15);
            assert_near(Cv[k], Cv[k + 3], 0.0);
            assert_near(Ca[k], Ca[k + 3], 0.0);
        }
    assert_near(ritz_dense_col(&io->B, 2)[7], 2.0, 0.0);
    assert_near(ritz_dense_col(&io->C, 8)[3], 3.0, 0.0);
}

/* A file has outputs in its rows or in its columns; a square one has them in
   its rows. */
static void outputs_are_rows_or_columns(void **)
{
    ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 3, NULL),
        .rows = "0",
        .output_matrix =
            folder_write("c.mtx", ARRAY "2 3\n1\n2\n3\n4\n5\n6\n")};
    const char *const turned =
        folder_write("t.mtx", ARRAY "3 2\n1\n3\n5\n2\n4\n6\n");
    const char *const square =
        folder_write("s.mtx", ARRAY "3 3\n1\n2\n3\n4\n5\n6\n7\n8\n9\n");
    ritz_import_report report = {0};

    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_component) c = {0};

        request.output_matrix = k == 0   ? request.output_matrix
                                : k == 1 ? turned
                                         : square;
        assert_ok(ritz_import(&request, &c, &report));
        assert_int_equal(c.io.num_outputs, k < 2 ? 2 : 3);
        assert_int_equal(c.io.C.ncol, 3);
        for (int64_t i = 0; i < c.io.C.nrow * 3; i++)
            assert_near(c.io.C.val[i], (double)(i + 1), 0.0);
        assert_string_equal(c.io.output[1], "y2");
        ritz_import_report_free(&report);
    }
}

/* Grid 4 follows grid 3, from which it is 2 away along x: a force f along y on
 * grid 4 is a force f and a moment 2 f about z on grid 3. */
static void constraints_act_on_inputs_and_outputs(void **)
{
    const char *const inputs[] = {"a=4:2*5"};
    const char *const outputs[] = {"a=4:2"};
    const ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 12, NULL),
        .bulk = folder_write("deck.bdf", "GRID,3,,1.,0.,0.\nGRID,4,,3.,0.,0.\n"
                                         "RBE2,600,3,123456,4\n"),
        .num_inputs = 1,
        .input = inputs,
        .num_outputs = 1,
        .output = outputs,
        .input_matrix = put_entries("b.mtx", 12, 1, 1, "8 1 5\n"),
        .output_matrix = put_entries("c.mtx", 1, 12, 1, "1 8 1\n")};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 6);
    for (int64_t i = 0; i < 6; i++) {
        assert_near(ritz_dense_col(&c.io.B, 1)[i],
                    ritz_dense_col(&c.io.B, 0)[i], 0.0);
        assert_near(ritz_dense_col(&c.io.C, i)[1],
                    ritz_dense_col(&c.io.C, i)[0], 0.0);
    }
    assert_near(ritz_dense_col(&c.io.B, 1)[1], 5.0, 0.0);
    assert_near(ritz_dense_col(&c.io.B, 1)[5], 10.0, 0.0);
}

/* The deck fixes directions 1, 5 and 6 of grid 3, whose entries are dropped. */
static void entries_of_fixed_dofs_are_left_out(void **)
{
    const ritz_import_request request = {
        .stiffness = put_diagonal("k.mtx", 6, NULL),
        .mass = put_diagonal("m.mtx", 6, NULL),
        .bulk = folder_write("deck.bdf", "GRID,3,,1.,0.,0.,,156\n"),
        .input_matrix = put_entries("b.mtx", 6, 1, 3, "1 1 9\n2 1 7\n6 1 9\n"),
        .output_matrix = put_entries("c.mtx", 1, 6, 2, "1 5 9\n1 4 8\n")};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 3);
    assert_near(c.io.B.val[0], 7.0, 0.0);
    assert_near(c.io.B.val[1], 0.0, 0.0);
    assert_near(c.io.B.val[2], 0.0, 0.0);
    assert_near(c.io.C.val[0], 0.0, 0.0);
    assert_near(c.io.C.val[2], 8.0, 0.0);
}

/* A DMIG matrix of 2 x 1 names the dofs of its two rows; the model has
   twelve. */
static void files_that_name_rows_are_placed_by_name(void **)
{
    const char *file = folder_write("b.pch", "DMIG,B,0,9,2,0,,,1\n"
                                             "DMIG,B,1,0,,2,3,5.\n"
                                             "DMIG,B,1,0,,1,1,7.\n");
    char spec[300];
    const ritz_import_request request = {.mass =
                                             put_diagonal("m.mtx", 12, NULL),
                                         .input_matrix = spec,
                                         .output_matrix = spec};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    snprintf(spec, sizeof spec, "%s:B", file);
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.io.num_inputs, 1);
    assert_int_equal(c.io.num_outputs, 1);
    for (int64_t i = 0; i < 12; i++) {
        double due = i == 0 ? 7.0 : i == 8 ? 5.0 : 0.0;

        assert_near(c.io.B.val[i], due, 0.0);
        assert_near(c.io.C.val[i], due, 0.0);
    }
}

/* A request and the sentence that refuses it. */
typedef struct refusal {
    const char *B, *C, *Cv, *inputs, *outputs, *says;
} refusal;

static void wrong_matrices_are_refused(void **)
{
    const char *const b = put_entries("b.mtx", 6, 1, 1, "2 1 9\n");
    const char *const c = put_entries("c.mtx", 1, 6, 1, "1 2 9\n");
    const char *const two = put_entries("two.mtx", 2, 6, 1, "1 2 9\n");
    const char *const off = put_entries("off.mtx", 6, 1, 1, "5 1 9\n");
    const char *const bad = put_entries("bad.mtx", 5, 2, 1, "1 1 9\n");
    const char *const pairs =
        folder_write("i.mtx", "%%MatrixMarket matrix coordinate complex "
                              "general\n6 1 1\n1 1 2 3\n");
    const refusal cases[] = {
        {bad, 0, 0, 0, 0, "is 5 x 2: 6 rows are due, one for each dof"},
        {0, bad, 0, 0, 0, "is 5 x 2: 6 columns are due"},
        {0, 0, bad, 0, 0, "velocity matrix: "},
        {pairs, 0, 0, 0, 0, "is complex, a real matrix is due"},
        {0, c, two, 0, 0, "has 2 outputs, "},
        {off, 0, 0, 0, 0,
         "has an entry for 'grid 1 R2', which has neither stiffness nor mass"},
        {b, 0, 0, "p,q", 0, "--input-names: 2 names are given for 1 inputs"},
        {b, 0, 0, "f", 0, "there are two inputs 'f'"},
        {0, two, 0, 0, "y,y", "'y' is named twice"},
        {0, c, 0, 0, "y@0", "'0' is no limit"},
        {0, c, 0, "p", 0, "names of inputs are given, but no input matrix"},
        {b, 0, 0, 0, "p", "names of outputs are given, but no output matrix"},
    };
    const char *const input[] = {"f=1:1"};
    ritz_import_request request = {
        .mass = put_entries("m.mtx", 6, 6, 5,
                            "1 1 1\n2 2 1\n3 3 1\n4 4 1\n6 6 1\n"),
        .num_inputs = 1,
        .input = input};
    ritz_import_report report = {0};
    ritz_component component = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        request.input_matrix = cases[k].B;
        request.output_matrix = cases[k].C;
        request.velocity_matrix = cases[k].Cv;
        request.input_names = cases[k].inputs;
        request.output_names = cases[k].outputs;
        assert_int_not_equal(ritz_import(&request, &component, &report),
                             RITZ_OK);
        if (!strstr(ritz_error_message(), cases[k].says))
            fail_msg("%s: %s", cases[k].says, ritz_error_message());
        assert_null(component.dof);
    }
}

/* The sum of the two terms exceeds the largest double. */
static void inputs_that_are_not_finite_are_refused(void **)
{
    const char *const input[] = {"f=1:1*1e308,1:1*1e308"};
    const ritz_import_request request = {.mass = put_diagonal("m.mtx", 6, NULL),
                                         .num_inputs = 1,
                                         .input = input};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "inputs are not finite");
}

/* ---- rows of chains and of plane models --------------------------------- */

static void rows_are_directions_of_grids(void **)
{
    static const struct {
        const char *rows;
        ritz_dof last;
        int64_t grids; /* a single grid lies at the origin */
    } cases[] = {{"0", {6, 0}, 0},   {"1", {6, 1}, 0},     {"12", {3, 2}, 0},
                 {"126", {2, 6}, 0}, {"612", {2, 2}, 0},   {"345", {2, 5}, 0},
                 {"16", {3, 6}, 0},  {"123456", {1, 6}, 1}};
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 6, NULL)};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_import_report) report = {0};
        RITZ_OWN(ritz_component) c = {0};

        request.rows = cases[k].rows;
        assert_ok(ritz_import(&request, &c, &report));
        assert_string_equal(report.map, "--rows");
        assert_int_equal(c.num_dofs, 6);
        assert_int_equal(ritz_dof_compare(&c.dof[5], &cases[k].last), 0);
        assert_int_equal(c.dof[0].grid, 1);
        assert_int_equal(c.grids.count, cases[k].grids);
    }
}

static void wrong_rows_are_refused(void **)
{
    ritz_import_request request = {.mass = put_diagonal("m.mtx", 7, NULL),
                                   .rows = "126"};
    ritz_import_report report = {0};
    ritz_component c = {0};

    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 7 rows, which is not 3 for each grid, as --rows 126");
    request.rows = "";
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "--rows: '' are not directions");
    request.rows = "11";
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "--rows: '11' are not directions: digits 1 to 6, each once");
    request.rows = "01";
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "0, for scalar points, goes alone");
    request.rows = "1";
    request.bulk = folder_write("deck.bdf", deck);
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "--rows: the deck names the rows already");
    request.dofs = folder_write("dofs", "1 0\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "--rows: --dofs names the rows already");
    request.rows = NULL;
    request.dofs = request.bulk = NULL;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "--rows, --dofs or --bulk must say what they are");
}

/* ---- a public model ----------------------------------------------------- */

/* LF10 of the Oberwolfach collection: M, D, K, B and C of 18 dofs. */
static void lf10_needs_no_made_up_grids(void **)
{
    static const char *const names[] = {"K", "M", "D", "B", "C"};
    const char *where = getenv("RITZ_EXTERNAL_DATA");
    const char *const input[] = {"u=8:0"};
    char path[5][512];
    ritz_import_request request = {.stiffness = path[0],
                                   .mass = path[1],
                                   .damping = path[2],
                                   .rows = "0",
                                   .num_inputs = 1,
                                   .input = input,
                                   .input_matrix = path[3],
                                   .output_matrix = path[4],
                                   .input_names = "v"};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    if (!where)
        skip();
    for (int k = 0; k < 5; k++)
        snprintf(path[k], sizeof path[k], "%s/second_order/LF10/%s.mtx", where,
                 names[k]);
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 18);
    for (int64_t i = 0; i < 18; i++) {
        assert_near(ritz_dense_col(&c.io.B, 1)[i], i == 7, 0.0);
        assert_near(ritz_dense_col(&c.io.C, i)[0], i == 7, 0.0);
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
    const ritz_import_request request = {
        .mass = put_diagonal("m.mtx", 6, NULL),
        .rows = "126",
        .input_matrix = put_entries("b.mtx", 6, 2, 2, "1 1 9\n2 2 1\n"),
        .output_matrix = put_entries("c.mtx", 1, 6, 1, "1 2 9\n"),
        .velocity_matrix = put_entries("v.mtx", 6, 1, 1, "2 1 9\n"),
        .input_names = "a,b",
        .output_names = "y@3"};

    assert_survives_every_allocation(import_and_free(&request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(inputs_by_matrix_and_by_text_agree),
    cmocka_unit_test(outputs_are_rows_or_columns),
    cmocka_unit_test(constraints_act_on_inputs_and_outputs),
    cmocka_unit_test(entries_of_fixed_dofs_are_left_out),
    cmocka_unit_test(files_that_name_rows_are_placed_by_name),
    cmocka_unit_test(wrong_matrices_are_refused),
    cmocka_unit_test(inputs_that_are_not_finite_are_refused),
    cmocka_unit_test(rows_are_directions_of_grids),
    cmocka_unit_test(wrong_rows_are_refused),
    cmocka_unit_test(lf10_needs_no_made_up_grids),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(import_matrices, tests, folder_make, folder_remove)
