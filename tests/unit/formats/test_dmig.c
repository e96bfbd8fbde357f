/* DMIG cards: matrices of every form, and what cannot be one. */
#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "foreign.h"
#include "solvers.h"

#include <ritz/import.h>

#include <lapacke.h>
#include <stdio.h>

/* All matrices of bytes that are taken for DMIG. */
static ritz_status parse_bytes(const char *bytes, int64_t size,
                               ritz_matrices *out)
{
    RITZ_OWN(ritz_foreign)
    file = {.bytes = bytes, .size = size, .format = &ritz_format_dmig};
    RITZ_OWN(ritz_matrices) all = {0};

    RITZ_CHECK(ritz_format_dmig.list(&file, &file.listing));
    RITZ_CHECK_NEW(all.matrix, file.listing.count);
    for (; all.count < file.listing.count; all.count++)
        RITZ_CHECK(ritz_foreign_take(&file, all.count, &all.matrix[all.count]));
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

static ritz_status parse(const char *text, ritz_matrices *out)
{
    return parse_bytes(text, (int64_t)strlen(text), out);
}

static double re(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->A.val, i, j);
}

static double im(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->imaginary, i, j);
}

/* The same 3 x 3: grids 2 T1, 2 R3 and point 10. */
static const char SMALL[] =
    "DMIG    K       0       6       2       0                       3\n"
    "DMIG    K       2       6               2       6       4.\n"
    "DMIG    K       10      0               2       1       -1.5\n"
    "        10              7.5-1\n"
    "DMIG    K       2       1               2       1       2.\n";
static const char LARGE[] =
    "GRID    2\n"
    "DMIG*   K                              2               6\n"
    "*                      2               6 4.000000000D+00\n"
    "DMIG*   K                              2               1\n"
    "*                      2               1 2.000000000D+00\n"
    "*                     10               0-1.500000000D+00\n"
    "CBAR    1       1       1       2\n"
    "DMIG*   K                             10               0\n"
    "*                     10               0 7.500000000D-01\n"
    "DMIG    K              0       6       2       0                  3\n";
static const char FREE[] = "$ comment\nSOL 103\nCEND\nBEGIN BULK\n"
                           "dmig,k,0,6,2,0\n"
                           "dmig,k,2,1,,2,1,2.\n,10,,-1.5\n"
                           "dmig,k,2,6,,2,6,4.0\n"
                           "dmig,k,10,0,,10,0,.75\nENDDATA\n";

static void check_spelling(const char *text, int64_t digits)
{
    static const double K[3][3] = {
        {2.0, 0.0, -1.5}, {0.0, 4.0, 0.0}, {-1.5, 0.0, 0.75}};
    static const ritz_dof ROWS[] = {{2, 1}, {2, 6}, {10, 0}};
    RITZ_OWN(ritz_matrices) all = {0};
    ritz_matrix *m = NULL;

    assert_true(ritz_format_dmig.recognise(text, (int64_t)strlen(text)));
    assert_ok(parse(text, &all));
    assert_int_equal(all.count, 1);
    m = all.matrix;
    assert_string_equal(m->name, "K");
    assert_true(m->symmetric);
    assert_null(m->imaginary);
    assert_null(m->col);
    assert_int_equal(m->digits, digits);
    assert_int_equal(m->A.nrow, 3);
    for (int k = 0; k < 9; k++) {
        int i = k / 3;
        int j = k % 3;

        assert_int_equal(m->row[i].grid, ROWS[i].grid);
        assert_int_equal(m->row[i].component, ROWS[i].component);
        assert_near(re(m, i, j), K[i][j], 0.0); /* no arithmetic */
    }
}

static void three_spellings_give_the_same_bits(void **state)
{
    (void)state;
    check_spelling(SMALL, 2);
    check_spelling(LARGE, 10);
    check_spelling(FREE, 2);
}

static void square_ones_stay_as_they_are_given(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};

    (void)state;
    assert_ok(
        parse("DMIG,B,0,1,1,0\nDMIG,B,7,0,,5,0,2.,,\nDMIG,E,0,6,2\n", &all));
    assert_int_equal(all.count, 2);
    assert_false(all.matrix[0].symmetric);
    assert_int_equal(all.matrix[0].A.nrow, 2);
    assert_near(re(&all.matrix[0], 0, 1), 2.0, 0.0);
    assert_near(re(&all.matrix[0], 1, 0), 0.0, 0.0);
    assert_int_equal(all.matrix[1].A.nrow, 0);
}

static void polar_values_are_turned(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};
    double half = 2.0 * sqrt(0.5);

    (void)state;
    assert_ok(parse("DMIG,P,0,9,4,0,1\nDMIG,P,3,,,1,1,2.,45.\n", &all));
    assert_non_null(all.matrix[0].imaginary);
    assert_int_equal(all.matrix[0].A.ncol, 1);
    assert_int_equal(all.matrix[0].col[0].grid, 3);
    /* sin and cos of a rounded angle: two units in the last place of 1.4 */
    assert_near(re(&all.matrix[0], 0, 0), half, 2 * 2.3e-16);
    assert_near(im(&all.matrix[0], 0, 0), half, 2 * 2.3e-16);
}

/* Columns of form 9 are 1 to NCOL; other rectangular matrices have the columns
 * that occur. */
static void rectangular_ones_have_these_columns(void **state)
{
    static const char TEXT[] = "DMIG,P,0,9,2,0,,,4\n"
                               "DMIG,P,3,,,7,2,1.5\nDMIG,P,1,5,,7,1,2.5\n"
                               "DMIG,Q,0,9,2,0\n"
                               "DMIG,Q,30,,,7,2,1.5\nDMIG,Q,10,,,7,1,2.5\n"
                               "DMIG,R,0,2,2,0,,,99\n"
                               "DMIG,R,7,2,,7,1,1.5\nDMIG,R,7,1,,8,,2.5\n";
    static const ritz_dof cols[] = {{7, 1}, {7, 2}};
    RITZ_OWN(ritz_matrices) all = {0};

    (void)state;
    assert_ok(parse(TEXT, &all));
    assert_int_equal(all.count, 3);
    assert_int_equal(all.matrix[0].A.ncol, 4);
    assert_int_equal(all.matrix[0].A.nrow, 2);
    assert_true(re(&all.matrix[0], 1, 2) == 1.5);
    assert_true(re(&all.matrix[0], 0, 0) == 2.5);
    assert_int_equal(all.matrix[0].A.colptr[4], 2);
    assert_int_equal(all.matrix[1].A.ncol, 2);
    assert_true(re(&all.matrix[1], 0, 0) == 2.5);
    assert_true(re(&all.matrix[1], 1, 1) == 1.5);
    assert_int_equal(all.matrix[2].A.ncol, 2);
    assert_true(re(&all.matrix[2], 0, 1) == 1.5);
    assert_true(re(&all.matrix[2], 1, 0) == 2.5);
    for (int k = 0; k < 2; k++)
        assert_int_equal(ritz_dof_compare(&all.matrix[2].col[k], &cols[k]), 0);
}

static void what_is_no_matrix_is_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"GRID,1\n", "there is no DMIG card"},
        {"DMIG,K,1,1,,1,1,1.\n", "line 1: DMIG 'K' has no header"},
        {"DMIG,K,0,6,2\n\nDMIG,K,0,6,2\n", "line 3: DMIG 'K' has a second"},
        {"DMIG,K,0,3,2\n", "'3' in DMIG is not a form: 1, 2, 6 or 9"},
        {"DMIG,K,0,6,7\n", "'7' in DMIG is not a type"},
        {"DMIG,K,0,6,2,0,2\n", "'2' in DMIG is not 0 or 1 for POLAR"},
        {"DMIG,K,0,9,2,0,,,-1\n", "'-1' in DMIG is not a number of columns"},
        {"DMIG,K,0,9,2,0,,,1000001\n", "is not a number of columns"},
        {"DMIG,K,0,9,2,0,,,3\nDMIG,K,4,,,1,1,1.\n",
         "line 2: '4' in DMIG is not among the columns 1 to NCOL"},
        {"DMIG,1K,0,6,2\n", "'1K' in DMIG is not the name of a matrix"},
        {"DMIG,K,0,6,2\nDMIG,K,1,7,,1,1,1.\n", "line 2: '7' in DMIG is not a "
                                               "direction"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,1,1,x\n", "line 2: 'x' in DMIG is not a "
                                              "number"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,1,1,1e999\n", "is not a number"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,1,1,nan\n", "is not a number"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,,1,1.\n", "a field of DMIG is blank"},
        {"DMIG,K,0,6,2\nDMIG,K,-1,1,,1,1,1.\n", "positive whole number"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,1,1,1.,2.\n", "'2.' in DMIG is not blank"},
        {"DMIG,K,0,1,2\nDMIG,K,1,1,,1,1,1.\nDMIG,K,1,1,,1,1,1.\n",
         "line 3: DMIG 'K' gives (grid 1 T1, grid 1 T1) twice"},
        {"DMIG,K,0,6,2\nDMIG,K,1,1,,2,4,1.\nDMIG,K,2,4,,1,1,1.\n",
         "line 3: DMIG 'K' gives (grid 2 R1, grid 1 T1) twice; a symmetric"},
        {"DMIG,K,0,6,2\nINCLUDE 'columns.pch'\n",
         "line 1: DMIG 'K' has no columns here, and INCLUDE"},
    };
    ritz_matrices all = {0};

    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        assert_fails(parse(CASES[k].text, &all), RITZ_ERR_FORMAT,
                     CASES[k].words);
        assert_null(all.matrix);
    }
}

static void only_a_dmig_card_is_recognised(void **state)
{
    static const char *const OTHERS[] = {"",      "DMIGX,1", "$DMIG,K",
                                         "DMI,K", "DMIG",    " 1 DMIG 2\n"};

    (void)state;
    for (size_t k = 0; k < sizeof OTHERS / sizeof *OTHERS; k++)
        assert_false(
            ritz_format_dmig.recognise(OTHERS[k], (int64_t)strlen(OTHERS[k])));
}

static ritz_status read_bytes(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_matrices) all = {0};

    (void)ritz_format_dmig.recognise(bytes, size);
    return parse_bytes(bytes, size, &all);
}

static void a_deck_cut_or_corrupted_anywhere_ends_well(void **state)
{
    static const char *const TEXTS[] = {SMALL, LARGE, FREE};

    (void)state;
    for (int t = 0; t < 3; t++) {
        damage_cut(read_bytes, TEXTS[t], (int64_t)strlen(TEXTS[t]) + 1);
        damage_corrupt(read_bytes, TEXTS[t], (int64_t)strlen(TEXTS[t]));
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char POLAR[] = "DMIG,P,0,9,4,0,1,,3\n"
                                "DMIG,P,3,,,1,1,2.,45.\n";

    assert_survives_every_allocation(read_bytes(LARGE, sizeof LARGE - 1));
    assert_survives_every_allocation(read_bytes(POLAR, sizeof POLAR - 1));
}

/* ---- what others wrote ------------------------------------------------- */

static bool external(const char *name, ritz_matrices *out)
{
    char path[512];

    if (!solvers_find(name, path))
        return false;
    assert_ok(foreign_read(path, out));
    return out->matrix != NULL;
}

static void a_punched_model_has_its_published_frequencies(void **state)
{
    enum { N = 15 };
    RITZ_OWN(ritz_matrices) all = {0};
    double K[N * N];
    double M[N * N];
    double w[N];
    double f[2] = {0.0, 0.0};

    (void)state;
    if (!external("pynastran/dmig.pch", &all)) {
        skip();
        return;
    }
    assert_int_equal(all.count, 6);
    assert_string_equal(all.matrix[0].name, "KAAX");
    assert_string_equal(all.matrix[1].name, "MAAX");
    assert_int_equal(all.matrix[0].A.nrow, N);
    assert_int_equal(all.matrix[1].A.nrow, N);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            K[i + N * j] = re(&all.matrix[0], i, j);
            M[i + N * j] = re(&all.matrix[1], i, j);
        }
    assert_int_equal(
        LAPACKE_dsygv(LAPACK_COL_MAJOR, 1, 'N', 'L', N, K, N, M, N, w), 0);
    for (int k = N - 1; k >= 0; k--) {
        double hertz = sqrt(fmax(w[k], 0.0)) / (2.0 * 3.14159265358979323846);

        if (hertz > 0.01) { /* above the rigid motions */
            f[1] = f[0];
            f[0] = hertz;
        }
    }
    /* oracles.md, section 7: printed with six decimals */
    assert_near(f[0], 1.033490, 5e-7);
    assert_near(f[1], 2.130694, 5e-7);
    assert_int_equal(all.matrix[3].A.ncol, 1); /* VAX */
    assert_int_equal(all.matrix[3].col[0].component, 0);
    assert_int_equal(all.matrix[5].A.ncol, 90); /* MUG1T, most of them null */
    assert_true(re(&all.matrix[5], 14, 84) == 1.0);
    assert_int_equal(all.matrix[5].A.colptr[90], 15);
}

static void forms_and_types_of_others_are_read(void **state)
{
    ritz_matrices all = {0};

    (void)state;
    if (!external("pynastran/dmig.bdf", &all)) {
        skip();
        return;
    }
    assert_int_equal(all.count, 5);
    assert_near(re(&all.matrix[0], 0, 2), 0.25, 0.0); /* REALS, mirrored */
    assert_near(re(&all.matrix[1], 2, 0), 0.0, 0.0);  /* REAL */
    assert_near(im(&all.matrix[3], 1, 2), 0.751, 0.0);
    assert_near(im(&all.matrix[3], 2, 1), 0.751, 0.0);
    assert_near(im(&all.matrix[4], 0, 0), sqrt(0.5), 2 * 1.2e-16);
    ritz_matrices_free(&all);
    assert_true(external("dmig/matrix_factory.pch", &all));
    assert_int_equal(all.count, 4);
    for (int j = 0; j < 21; j++) { /* PATRN counts its columns */
        assert_near(re(&all.matrix[0], 20, j), j + 1.0, 0.0);
        assert_near(re(&all.matrix[1], j, j), 1.0, 0.0);
    }
    assert_int_equal(all.matrix[3].A.nrow, 21);
    assert_int_equal(all.matrix[3].A.ncol, 50);
    assert_near(re(&all.matrix[3], 20, 49), 0.3924328341, 0.0);
    assert_near(im(&all.matrix[3], 20, 49), 0.9245890204, 0.0);
    ritz_matrices_free(&all);
    assert_true(external("pynastran/dmig_sparse.pch", &all));
    assert_near(re(&all.matrix[0], 0, 1), 4.413810330e5, 0.0);
    ritz_matrices_free(&all);
}

/* Columns in an included file are columns of the matrix. */
static void included_columns_are_read(void **state)
{
    const char *deck = NULL;
    ritz_matrices all = {0};

    assert_int_equal(folder_make(state), 0);
    deck = folder_write(
        "deck.bdf", "DMIG,K,0,6,2\nDMIG,K,1,1,,1,1,4.0\nINCLUDE 'part.pch'\n");
    folder_write("part.pch", "DMIG,K,2,1,,2,1,9.0\n");
    assert_ok(foreign_read(deck, &all));
    assert_int_equal(all.count, 1);
    assert_int_equal(all.matrix[0].A.ncol, 2);
    assert_near(all.matrix[0].A.val[1], 9.0, 0.0);
    ritz_matrices_free(&all);
    remove(folder_path("part.pch"));
    assert_fails(foreign_read(deck, &all), RITZ_ERR_FILE, "part.pch");
    assert_int_equal(folder_remove(state), 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(three_spellings_give_the_same_bits),
    cmocka_unit_test(square_ones_stay_as_they_are_given),
    cmocka_unit_test(polar_values_are_turned),
    cmocka_unit_test(rectangular_ones_have_these_columns),
    cmocka_unit_test(what_is_no_matrix_is_refused),
    cmocka_unit_test(only_a_dmig_card_is_recognised),
    cmocka_unit_test(a_deck_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(a_punched_model_has_its_published_frequencies),
    cmocka_unit_test(forms_and_types_of_others_are_read),
    cmocka_unit_test(included_columns_are_read),
};

TEST_MODULE(dmig, tests, NULL, NULL)
