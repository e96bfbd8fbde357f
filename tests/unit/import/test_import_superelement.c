/*
 * External superelements: rows that EXTRN names, the files of EXTSEOUT, complex
 * stiffness, rectangular DMIG.
 */
#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "solvers.h"

#include <ritz/import.h>

#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* Three rows: a spring joins point 1001 and direction 3 of grid 9, and a
   spring to the ground holds direction 1 of grid 2. */
static const char deck[] = "BEGIN SUPER      7\n"
                           "EXTRN,9,3,2,1,1001,0\n"
                           "GRID,2,,1.,0.,0.\nGRID,9,,0.,2.,0.\n"
                           "SPOINT,1001\n";
static const char stiffness[] =
    "%%MatrixMarket matrix coordinate real symmetric\n"
    "3 3 4\n1 1 2.\n2 2 5.\n3 1 -2.\n3 3 2.\n";
static const char mass[] = "%%MatrixMarket matrix coordinate real symmetric\n"
                           "3 3 3\n1 1 1.\n2 2 2.\n3 3 3.\n";

static ritz_import_request request_of(const char *bulk)
{
    return (ritz_import_request){.stiffness = folder_write("k.mtx", stiffness),
                                 .mass = folder_write("m.mtx", mass),
                                 .bulk = folder_write("part.pch", bulk)};
}

static void rows_are_those_of_extrn_in_its_order(void **state)
{
    static const ritz_dof due[] = {{9, 3}, {2, 1}, {1001, 0}};
    const ritz_import_request request = request_of(deck);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "EXTRN");
    assert_int_equal(c.num_dofs, 3);
    for (int64_t k = 0; k < 3; k++)
        assert_int_equal(ritz_dof_compare(&c.dof[k], &due[k]), 0);
    assert_true(matrix_entry(&c.K, c.K.val, 2, 0) == -2.0);
    assert_true(matrix_entry(&c.M, c.M.val, 1, 1) == 2.0);
    assert_int_equal(c.grids.count, 2);
    assert_true(c.grids.position[4] == 2.0);
}

static void rows_that_do_not_fit_are_refused(void **state)
{
    ritz_import_request request = request_of("EXTRN,9,123,2,1\nGRID,2\n"
                                             "GRID,9\n");
    ritz_import_report report = {0};
    ritz_component c = {0};

    (void)state;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "k.mtx' has 3 rows; the deck explains 12 (2 grids) or 4 "
                 "(EXTRN)");
    /* as where the card is cut off: the points would fit in another order */
    request = request_of("EXTRN,9,0\nSPOINT,2,9,1001\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "has 3 rows, but EXTRN names 1: --dofs must name the rows");
    request = request_of("EXTRN,9,3,2,1\nEXTRN,9,3\nGRID,2\nGRID,9\n");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "EXTRN names 'grid 9 T3' twice");
}

/* ---- complex matrices ---------------------------------------------------- */

/* (3 + 4i) at grid 1 T1, and 5 at 36.8699 degrees between it and T2. */
static const char complex_cards[] =
    "DMIG,K,0,6,4,0\nDMIG,K,1,1,,1,1,3.,4.\n,1,2,1.,.5\n"
    "DMIG,K,1,2,,1,2,9.,1.\n"
    "DMIG,P,0,6,4,0,1\nDMIG,P,1,1,,1,1,2.,90.\n"
    "DMIG,P,1,2,,1,2,2.,0.\n"
    "DMIG,M,0,6,2,0\nDMIG,M,1,1,,1,1,1.\nDMIG,M,1,2,,1,2,1.\n"
    "DMIG,C,0,6,4,0\nDMIG,C,1,1,,1,1,1.,1.\nDMIG,C,1,2,,1,2,1.\n"
    "DMIG,H,0,1,4,0\nDMIG,H,1,1,,1,1,1.\n,1,2,0.,1.\n"
    "DMIG,H,1,2,,1,1,0.,-1.\n,1,2,1.\n";

static const char *spec_of(const char *name)
{
    static char spec[4][300];
    static int turn = 0;

    turn = (turn + 1) % 4;
    snprintf(spec[turn], sizeof spec[turn], "%s:%s", folder_path("c.pch"),
             name);
    return spec[turn];
}

static void the_imaginary_part_of_a_stiffness_is_damping(void **state)
{
    ritz_import_request request = {0};
    RITZ_OWN(ritz_import_report) report = {0}, polar_report = {0};
    RITZ_OWN(ritz_component) c = {0}, polar = {0};

    (void)state;
    folder_write("c.pch", complex_cards);
    request.stiffness = spec_of("K");
    request.mass = spec_of("M");
    assert_ok(ritz_import(&request, &c, &report));
    assert_true(matrix_entry(&c.K, c.K.val, 0, 0) == 3.0);
    assert_true(matrix_entry(&c.K, c.K.val, 0, 1) == 1.0);
    assert_true(matrix_entry(&c.K4, c.K4.val, 0, 0) == 4.0);
    assert_true(matrix_entry(&c.K4, c.K4.val, 0, 1) == 0.5);
    assert_true(matrix_entry(&c.K4, c.K4.val, 1, 0) == 0.5);
    request.stiffness = spec_of("P");
    assert_ok(ritz_import(&request, &polar, &polar_report));
    assert_true(matrix_entry(&polar.K4, polar.K4.val, 0, 0) == 2.0);
    /* cos of 90 degrees as a double */
    assert_near(matrix_entry(&polar.K, polar.K.val, 0, 0), 0.0, 2.0 * 6.2e-17);
    assert_true(matrix_entry(&polar.K, polar.K.val, 1, 1) == 2.0);
}

/* K + i K4 of one spring in Matrix Market; an imaginary part of zeros is
   left out. */
static void a_complex_stiffness_brings_structural_damping(void **state)
{
    ritz_import_request request = {.rows = "0"};
    RITZ_OWN(ritz_import_report) report = {0}, again = {0};
    RITZ_OWN(ritz_component) c = {0}, real = {0};

    (void)state;
    request.stiffness =
        folder_write("k.mtx", "%%MatrixMarket matrix coordinate complex "
                              "symmetric\n2 2 3\n1 1 5 0.25\n2 1 -3 0.125\n"
                              "2 2 4 0.5\n");
    request.mass =
        folder_write("m.mtx", "%%MatrixMarket matrix coordinate complex "
                              "general\n2 2 2\n1 1 2 0\n2 2 1 0\n");
    assert_ok(ritz_import(&request, &c, &report));
    assert_true(ritz_sparse_diagonal(&c.K, 0) == 5.0);
    assert_true(ritz_sparse_diagonal(&c.K4, 1) == 0.5);
    assert_int_equal(c.K4.colptr[2], 4);
    assert_true(c.K4.val[1] == 0.125 && c.K.val[1] == -3.0);
    request.stiffness = request.mass;
    assert_ok(ritz_import(&request, &real, &again));
    assert_int_equal(real.K4.nrow, 0);
    request.stiffness = folder_path("k.mtx");
    request.structural_damping = request.mass;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "is complex: only a stiffness may be, K + i K4");
}

static void other_complex_matrices_are_refused(void **state)
{
    ritz_import_request request = {0};
    ritz_import_report report = {0};
    ritz_component c = {0};

    (void)state;
    folder_write("c.pch", complex_cards);
    request.stiffness = spec_of("K");
    request.mass = spec_of("M");
    request.structural_damping = spec_of("M");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "c.pch:K' is complex: only a stiffness may be, K + i K4, "
                 "without another structural damping");
    request.structural_damping = NULL;
    request.damping = spec_of("C");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "c.pch:C' is complex: only a stiffness may be, K + i K4");
    request.damping = NULL;
    /* hermitian: its imaginary part is no structural damping */
    request.stiffness = spec_of("H");
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_FORMAT,
                 "K4: unsymmetric by 2.0e+00 of its largest entry");
}

static void null_columns_of_a_rectangular_dmig_are_inputs(void **state)
{
    ritz_import_request request = {.mass = folder_write("m.mtx", mass),
                                   .bulk = folder_write("part.pch", deck)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    folder_write("c.pch", "DMIG,P,0,9,2,0,,,3\nDMIG,P,1,,,9,3,5.\n"
                          "DMIG,P,3,,,1001,,7.\n,2,1,8.\n");
    request.input_matrix = spec_of("P");
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.io.num_inputs, 3);
    assert_true(c.io.B.val[0] == 5.0);
    for (int64_t i = 3; i < 6; i++)
        assert_true(c.io.B.val[i] == 0.0);
    assert_true(c.io.B.val[7] == 8.0);
    assert_true(c.io.B.val[8] == 7.0);
}

/* ---- files of EXTSEOUT --------------------------------------------------- */

static void write_members(const char *name)
{
    static const char zero[] =
        "       1       1       6       2%-8s1P,3E23.16\n"
        "       2       1       1\n"
        " 1.0000000000000000E+00\n";
    static const char two[] = "       2       2       6       2%-8s1P,3E23.16\n"
                              "       1       1       1\n"
                              " %.16E\n"
                              "       2       2       1\n"
                              " 1.0000000000000000E+00\n"
                              "       3       1       1\n"
                              " 1.0000000000000000E+00\n";
    char text[3000];
    size_t used = 0;

    used += (size_t)snprintf(text, sizeof text, two, "KXX", 4.0);
    used += (size_t)snprintf(text + used, sizeof text - used, two, "MXX", 1.0);
    used += (size_t)snprintf(text + used, sizeof text - used, zero, "BXX1");
    used +=
        (size_t)snprintf(text + used, sizeof text - used, two, "K4XX1", 0.5);
    used += (size_t)snprintf(text + used, sizeof text - used, zero, "PX1");
    snprintf(text + used, sizeof text - used, two, "MUG1", 2.0);
    folder_write(name, text);
}

static void files_are_found_by_their_names(void **state)
{
    RITZ_OWN(ritz_superelement) found = {0}, alone = {0};

    (void)state;
    write_members("se.op4");
    folder_write("se.asm", deck);
    assert_ok(ritz_superelement_find(folder_path("se.op4"), NULL, &found));
    assert_non_null(strstr(found.stiffness, "se.op4:KXX"));
    assert_non_null(strstr(found.mass, "se.op4:MXX"));
    assert_null(found.damping);
    assert_non_null(strstr(found.structural_damping, "se.op4:K4XX1"));
    assert_string_equal(found.bulk, folder_path("se.asm"));
    assert_int_equal(found.num_others, 1);
    assert_string_equal(found.other[0], "MUG1 2 x 2");
    ritz_superelement_free(&found);
    folder_write("se.pch", deck);
    assert_ok(ritz_superelement_find(folder_path("se.op4"), NULL, &found));
    assert_string_equal(found.bulk, folder_path("se.pch"));
    write_members("alone.op4");
    assert_ok(ritz_superelement_find(folder_path("alone.op4"), NULL, &alone));
    assert_null(alone.bulk);
}

static void a_punch_file_with_dmig_is_its_own_deck(void **state)
{
    const char *path =
        folder_write("punched.pch", "EXTRN,1,12\nGRID,1\n"
                                    "DMIG,KAAX,0,6,2\nDMIG,KAAX,1,1,,1,1,2.\n"
                                    "DMIG,MAAX,0,6,2\nDMIG,MAAX,1,1,,1,1,2.\n"
                                    "DMIG,VAX,0,9,2,0,,,1\n"
                                    "DMIG,VAX,1,0,,1,1,1.\n");
    RITZ_OWN(ritz_superelement) found = {0};

    (void)state;
    assert_ok(ritz_superelement_find(path, NULL, &found));
    assert_non_null(strstr(found.stiffness, "punched.pch:KAAX"));
    assert_string_equal(found.bulk, path);
    assert_null(found.structural_damping);
    assert_int_equal(found.num_others, 1);
    assert_string_equal(found.other[0], "VAX");
}

static void what_is_no_superelement_is_refused(void **state)
{
    ritz_superelement found = {0};

    (void)state;
    assert_fails(
        ritz_superelement_find(folder_path("absent.op4"), NULL, &found),
        RITZ_ERR_FILE, "absent.op4");
    folder_write("c.pch", "DMIG,KGG,0,6,2\nDMIG,KGG,1,1,,1,1,2.\n");
    assert_fails(ritz_superelement_find(folder_path("c.pch"), NULL, &found),
                 RITZ_ERR_FORMAT,
                 "c.pch' has no stiffness of an external superelement, KAA, "
                 "KXX or KAAX: name its matrices with --stiffness and --mass");
    folder_write("c.pch", "DMIG,KAAX,0,6,2\nDMIG,KAAX,1,1,,1,1,2.\n");
    assert_fails(ritz_superelement_find(folder_path("c.pch"), NULL, &found),
                 RITZ_ERR_FORMAT, "has no mass of an external superelement");
    assert_null(found.stiffness);
}

/* NX NASTRAN 9 printed 6.129345, 6.130134 and 23.63188 Hz with the interface
   fixed (inboard.out); its OUTPUT4 file has numbers of single precision, which
   is 6e-8 of an eigenvalue. */
static void a_real_superelement_has_its_printed_frequencies(void **state)
{
    static const double printed[] = {6.129345, 6.130134, 23.63188};
    static const double half[] = {5e-7, 5e-7, 5e-6};
    char path[512];
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    ritz_import_request request = {0};

    (void)state;
    if (!solvers_find(CSUPER "inboard.op4", path))
        skip();
    assert_ok(ritz_superelement_find(path, NULL, &found));
    assert_null(found.damping);
    assert_null(found.structural_damping);
    assert_int_equal(found.num_others, 1);
    assert_string_equal(found.other[0], "VA 32 x 1");
    request.stiffness = found.stiffness;
    request.mass = found.mass;
    request.bulk = found.bulk;
    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "EXTRN");
    assert_int_equal(c.num_dofs, 32);
    assert_int_equal(c.grids.count, 4);
    assert_int_equal(c.dof[24].grid, 2995001);
    assert_int_equal(c.dof[24].component, 0);
    for (int64_t k = 0; k < 3; k++) /* modes of unit mass */
        assert_near(
            ritz_eigen_hertz(matrix_entry(&c.K, c.K.val, 24 + k, 24 + k) /
                             matrix_entry(&c.M, c.M.val, 24 + k, 24 + k)),
            printed[k], half[k] + 3e-8 * printed[k]);
}

/* Bars 10 and 97 have constant shear: V1 = (M1A - M1B) / L, with lengths of 300
   and of 30 along x and 150 along y and z; the numbers are of single precision.
 */
static void check_bars(const ritz_quantity *force)
{
    static const int64_t element[] = {10, 97};
    const double length[] = {300.0, sqrt(30.0 * 30.0 + 2.0 * 150.0 * 150.0)};

    for (int64_t i = 0; i < 16; i++)
        assert_int_equal(force->place[i], element[i / 8]);
    assert_string_equal(force->part[0], "cbar.m1a");
    assert_string_equal(force->part[12], "cbar.v1");
    for (int64_t b = 0; b < 4; b++)
        for (int64_t j = 0; j < 32; j++) {
            const int64_t first = 8 * (b / 2) + b % 2;
            const ritz_sparse *S = &force->S;
            const double a = matrix_entry(S, S->val, first, j);
            const double end = matrix_entry(S, S->val, first + 2, j);
            const double shear = matrix_entry(S, S->val, first + 4, j);

            assert_near(shear * length[b / 2], a - end,
                        2e-5 * (fabs(a) + fabs(end)) + 1e-3);
        }
}

/* MUG1 and MEF1 of the same file; TUG1 and TEF1 name their rows. */
static void a_real_superelement_brings_its_rows_to_recover(void **state)
{
    char path[512];
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    ritz_import_request request = {0};

    (void)state;
    if (!solvers_find(CSUPER "inboard.op4", path))
        skip();
    assert_ok(ritz_superelement_find(path, NULL, &found));
    assert_int_equal(found.num_recoveries, 2);
    request = (ritz_import_request){
        .stiffness = found.stiffness,
        .mass = found.mass,
        .bulk = found.bulk,
        .num_recoveries = 2,
        .recovery = (const char *const *)found.recovery,
        .num_recovery_rows = 2,
        .recovery_rows = (const char *const *)found.recovery_rows};
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_quantities, 2);
    assert_string_equal(c.quantity[0].kind, "displacement");
    assert_int_equal(c.quantity[0].count, 36);
    assert_int_equal(c.quantity[0].place[35], 27);
    assert_string_equal(c.quantity[0].part[35], "R3");
    for (int64_t k = 0; k < 6; k++) /* grid 3 has these coordinates itself */
        assert_true(matrix_entry(&c.quantity[0].S, c.quantity[0].S.val, k, k) ==
                    1.0);
    assert_string_equal(c.quantity[1].kind, "force");
    check_bars(&c.quantity[1]);
}

/* A table that names another number of rows names none. */
static void rows_without_a_fitting_table_are_not_taken(void **state)
{
    static const char *const tables[] = {"", "DTI,TUG1,2,,1,9,6,1\n,ENDREC\n",
                                         "DTI,TEF1,2,,34,9,2,1\n,ENDREC\n"};
    RITZ_OWN(ritz_superelement) named = {0};
    ritz_superelement bad = {0};
    char text[400];

    (void)state;
    write_members("se.op4");
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        RITZ_OWN(ritz_superelement) found = {0};

        snprintf(text, sizeof text, "%s%s", deck, tables[k]);
        folder_write("se.pch", text);
        assert_ok(ritz_superelement_find(folder_path("se.op4"), NULL, &found));
        assert_int_equal(found.num_recoveries, 0);
        assert_string_equal(found.other[0], "MUG1 2 x 2");
    }
    folder_write("own.bdf", "DTI,TUG1,2,,2,9,2,1\n,ENDREC\n");
    assert_ok(ritz_superelement_find(folder_path("se.op4"),
                                     folder_path("own.bdf"), &named));
    assert_int_equal(named.num_recoveries, 1);
    assert_int_equal(named.num_others, 0);
    assert_non_null(strstr(named.recovery[0], "displacement="));
    assert_non_null(strstr(named.recovery_rows[0], "own.bdf"));
    folder_write("own.bdf", "DTI,TUG1,2,,7,9,2,1\n,ENDREC\n");
    assert_fails(ritz_superelement_find(folder_path("se.op4"),
                                        folder_path("own.bdf"), &bad),
                 RITZ_ERR_FORMAT, "own.bdf', line 1: TUG1 has type 7 of 9");
    assert_null(bad.stiffness);
}

static ritz_status import_all(const ritz_import_request *request)
{
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    return ritz_import(request, &c, &report);
}

static ritz_status find_once(void)
{
    RITZ_OWN(ritz_superelement) found = {0};

    return ritz_superelement_find(folder_path("se.op4"), NULL, &found);
}

static void every_allocation_may_fail(void **state)
{
    ritz_import_request request = request_of(deck);

    (void)state;
    assert_survives_every_allocation(import_all(&request));
    folder_write("c.pch", complex_cards);
    request =
        (ritz_import_request){.stiffness = spec_of("K"), .mass = spec_of("M")};
    assert_survives_every_allocation(import_all(&request));
    write_members("se.op4");
    folder_write("se.asm", deck);
    assert_survives_every_allocation(find_once());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_are_those_of_extrn_in_its_order),
    cmocka_unit_test(rows_that_do_not_fit_are_refused),
    cmocka_unit_test(the_imaginary_part_of_a_stiffness_is_damping),
    cmocka_unit_test(a_complex_stiffness_brings_structural_damping),
    cmocka_unit_test(other_complex_matrices_are_refused),
    cmocka_unit_test(null_columns_of_a_rectangular_dmig_are_inputs),
    cmocka_unit_test(files_are_found_by_their_names),
    cmocka_unit_test(a_punch_file_with_dmig_is_its_own_deck),
    cmocka_unit_test(what_is_no_superelement_is_refused),
    cmocka_unit_test(a_real_superelement_has_its_printed_frequencies),
    cmocka_unit_test(a_real_superelement_brings_its_rows_to_recover),
    cmocka_unit_test(rows_without_a_fitting_table_are_not_taken),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(import_superelement, tests, folder_make, folder_remove)
