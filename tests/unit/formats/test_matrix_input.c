/* MATRIX INPUT: texts written by hand from the layout of the manuals. */
#include "testing.h"

#include "damage.h"
#include "foreign.h"

#include <ritz/import.h>

#include <stdio.h>

static ritz_status parse(const char *text, ritz_matrices *out)
{
    return foreign_parse(text, (int64_t)strlen(text), out);
}

static ritz_status read_text(const char *text)
{
    return damage_read_matrices(text, (int64_t)strlen(text));
}

static double entry(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->A.val, i, j);
}

/* The same 3 x 3 of node 2 in 1 and 6 and node 10 in 3: as Abaqus writes it, as
 * CalculiX does, with upper triangle, both, and mixed as nodes may be ordered. */
static const char LOWER[] = "2,1, 2,1,  2.000000000000000e+00\n"
                            "10,3, 2,1, -1.500000000000000e+00\n"
                            "2,6, 2,6,  4.000000000000000e+00\n"
                            "10,3, 10,3,  7.500000000000000e-01\n";
static const char CALCULIX[] =
    "         2,    1,         2,    1, 0.2000000000000E+01\n"
    "         2,    6,         2,    1, 0.0000000000000E+00\n"
    "         2,    6,         2,    6, 0.4000000000000E+01\n"
    "        10,    3,         2,    1,-0.1500000000000E+01\n"
    "        10,    3,         2,    6, 0.0000000000000E+00\n"
    "        10,    3,        10,    3, 0.7500000000000E+00\n";
static const char UPPER[] = "** of a program\r\n\r\n"
                            "2, 1, 2, 1, 2.\r\n 2,6,2,6,4.0\r\n"
                            "2,1,10,3,-1.5D0\r\n10,3,10,3,.75,";
static const char BOTH[] = "2,1,2,1,2.\n2,1,10,3,-1.5\n2,6,2,6,4.\n"
                           "10,3,2,1,-1.5\n10,3,10,3,.75\n";
static const char SCALED[] =
    "*Matrix Input, name = K, type=symmetric, ScaleFactor=-0.5\n"
    "** half, and negative\n2,1,2,1,-4.\n2,6,2,6,-8.\n"
    "2,1,10,3,3.\n10,3,2,1,3.\n10,3,10,3,-1.5\n";

static void check_spelling(const char *text, const char *name, bool symmetric,
                           int64_t digits)
{
    static const double K[3][3] = {
        {2.0, 0.0, -1.5}, {0.0, 4.0, 0.0}, {-1.5, 0.0, 0.75}};
    static const ritz_dof ROWS[] = {{2, 1}, {2, 6}, {10, 3}};
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;

    assert_ok(parse(text, &all));
    assert_string_equal(foreign_format, "matrix-input");
    assert_int_equal(all.count, 1);
    m = all.matrix;
    assert_string_equal(m->name, name);
    assert_int_equal(m->symmetric, symmetric);
    assert_int_equal(m->digits, digits);
    assert_null(m->imaginary);
    assert_null(m->col);
    assert_int_equal(m->A.nrow, 3);
    assert_int_equal(m->A.ncol, 3);
    assert_ok(ritz_sparse_check(&m->A, 5)); /* no zero is kept */
    for (int k = 0; k < 9; k++)
        assert_near(entry(m, k / 3, k % 3), K[k / 3][k % 3], 0.0);
    for (int k = 0; k < 3; k++)
        assert_int_equal(ritz_dof_compare(&m->row[k], &ROWS[k]), 0);
}

static void triangles_and_scales_give_the_same_bits(void **state)
{
    (void)state;
    check_spelling(LOWER, "", true, 16);
    check_spelling(CALCULIX, "", true, 13);
    check_spelling(UPPER, "", true, 2);
    check_spelling(BOTH, "", false, 2);
    check_spelling(SCALED, "K", true, 2);
}

/* The nodes are not in the order of their numbers: what is one triangle for the
 * solver has entries on both sides of the diagonal. */
static void one_triangle_in_another_order_of_nodes_is_completed(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};
    (void)state;

    assert_ok(parse("5,1,5,1,3.\n1,1,5,1,-1.\n9,1,5,1,-2.\n1,1,1,1,1.\n"
                    "9,1,9,1,2.\n",
                    &all));
    assert_near(entry(all.matrix, 0, 1), -1.0, 0.0);
    assert_near(entry(all.matrix, 1, 0), -1.0, 0.0);
    assert_near(entry(all.matrix, 1, 2), -2.0, 0.0);
    assert_near(entry(all.matrix, 2, 1), -2.0, 0.0);
}

static void an_unsymmetric_matrix_stays_as_it_is(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};
    (void)state;

    assert_ok(parse("*MATRIX INPUT,NAME=C,TYPE=UNSYMMETRIC\n1,1,2,1,3.\n"
                    "*MATRIX INPUT,NAME=D,TYPE=UNSYMMETRIC\n1,1,2,1,3.\n"
                    "2,1,1,1,-3.\n1,1,1,2,5.\n",
                    &all));
    assert_int_equal(all.count, 2);
    assert_string_equal(all.matrix[0].name, "C");
    assert_false(all.matrix[0].symmetric);
    assert_near(entry(&all.matrix[0], 0, 1), 3.0, 0.0);
    assert_near(entry(&all.matrix[0], 1, 0), 0.0, 0.0);
    assert_near(entry(&all.matrix[1], 0, 2), 3.0, 0.0);
    assert_near(entry(&all.matrix[1], 2, 0), -3.0, 0.0);
    assert_near(entry(&all.matrix[1], 0, 1), 5.0, 0.0);
    assert_near(entry(&all.matrix[1], 1, 0), 0.0, 0.0);
}

static void matrices_of_one_file_are_listed_by_name(void **state)
{
    static const char TEXT[] = "1,1,1,1,1.\n*MATRIX INPUT,NAME=K\n1,1,1,1,2.\n"
                               "*MATRIX INPUT,NAME=M\n3,3,3,3,4.\n";
    ritz_foreign file = {.bytes = TEXT,
                         .size = sizeof TEXT - 1,
                         .format = &ritz_format_matrix_input};
    ritz_matrix m = {0};
    (void)state;

    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, 3);
    assert_string_equal(file.listing.item[0].name, "");
    assert_string_equal(file.listing.item[2].name, "M");
    assert_false(file.listing.item[0].symmetric);
    assert_true(file.listing.item[2].symmetric);
    assert_int_equal(file.listing.item[2].nrow, -1);
    assert_ok(ritz_foreign_take(&file, 2, &m));
    assert_near(entry(&m, 0, 0), 4.0, 0.0);
    assert_int_equal(m.row[0].grid, 3);
    ritz_matrix_free(&m);
    file.listing.item[2].at = 77; /* a mapped file was changed */
    assert_fails(ritz_foreign_take(&file, 2, &m), RITZ_ERR_FORMAT,
                 "the matrix 'M' is no longer there");
    ritz_foreign_free(&file);
}

#define KEYWORD "*MATRIX INPUT,NAME=K"

static void what_is_wrong_is_said_with_its_line(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {"1,1,1,1,1.\n1,1,1,1\n",
         "line 2: '1,1,1,1' is not 'node, direction, node, direction, value'"},
        {"1,1,1,1,1.\n1,1,2,1,1.,2.\n", "line 2: '1,1,2,1,1.,2.' is not"},
        {"1,1,1,1,1.\n1,1,2,1,\n", "line 2: '1,1,2,1,' is not"},
        {"1,1,1,1,1.\nx,1,2,1,1.\n", "line 2: 'x' is not a whole number"},
        {"1,1,1,1,1.\n1.5,1,2,1,1.\n", "'1.5' is not a whole number"},
        {"1,1,1,1,1.\n1,1,2,1,1.x\n", "line 2: '1.x' is not a number"},
        {"1,1,1,1,1.\n1,1,,1,1.\n", "line 2: '' is not a whole number"},
        {"1,1,1,1,nan\n", "line 1: 'nan' is not finite"},
        {"1,1,1,1,1.e999\n", "line 1: '1.e999' is not finite"},
        {"1,1,1,1,1.\n-3,1,1,1,1.\n", "line 2: node -3 is internal to Abaqus"},
        {"0,1,1,1,1.\n", "line 1: node 0 is internal"},
        {"1,8,1,1,1.\n",
         "line 1: degree of freedom 8, a pressure, is not read"},
        {"1,1,1,11,1.\n",
         "line 1: degree of freedom 11, a temperature, is not read"},
        {"1,1,1,12,1.\n", "degree of freedom 12 is none of 1 to 6"},
        {"1,0,1,1,1.\n", "degree of freedom 0 is none of 1 to 6"},
        {"1,1,1,1,1.\n2,1,1,1,5.\n2,1,1,1,5.\n",
         "line 3: entry (grid 2 T1, grid 1 T1) is given twice"},
        {"1,1,1,1,1.\n\n1,1,1,1,1.\n",
         "line 3: entry (grid 1 T1, grid 1 T1) is given twice"},
        {"2,1,1,1,5.\n1,1,2,1,5.\n1,1,2,1,5.\n",
         "line 3: entry (grid 1 T1, grid 2 T1) is given twice"},
        {"2,1,1,1,5.\n1,1,2,1,5.\n3,6,1,1,7.\n",
         "line 3: entry (grid 3 R3, grid 1 T1) has no counterpart"},
        {KEYWORD "\n2,1,1,1,5.\n1,1,2,1,6.\n",
         "line 3: entry (grid 1 T1, grid 2 T1) differs from its counterpart"},
        {KEYWORD "\n", "line 1: *MATRIX INPUT of 'K' is followed by no entry"},
        {"*MATRIX INPUT\n1,1,1,1,1.\n", "line 1: *MATRIX INPUT has no NAME"},
        {"*MATRIX INPUT,NAME=\n", "line 1: '' is not the name of a matrix"},
        {"*MATRIX INPUT,NAME=a/b\n", "'a/b' is not the name of a matrix"},
        {KEYWORD ",TYPE=SKEW\n",
         "neither SYMMETRIC nor UNSYMMETRIC but 'SKEW'"},
        {KEYWORD ",SCALE FACTOR=x\n", "line 1: 'x' is not a number"},
        {KEYWORD ",SCALE FACTOR=1e300\n1,1,1,1,1e300\n",
         "line 2: the value times SCALE FACTOR is not finite"},
        {KEYWORD ",INPUT=k.mtx\n",
         "line 1: the entries are in another file, 'k.mtx'"},
        {KEYWORD ",MATRIX=MASS\n", "line 1: 'MATRIX' of *MATRIX INPUT is not"},
        {KEYWORD "\n1,1,1,1,1.\n*MATRIX ASSEMBLE,STIFFNESS=K\n",
         "line 3: '*MATRIX ASSEMBLE' is not *MATRIX INPUT"},
        {KEYWORD "\n1,1,1,1,1.\n*\n", "line 3: '*' is not *MATRIX INPUT"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++)
        assert_fails(read_text(CASES[k].text), RITZ_ERR_FORMAT, CASES[k].words);
}

static void only_the_keyword_or_an_entry_is_recognised(void **state)
{
    static const char *const OTHERS[] = {
        "",
        "** only a comment\n",
        "*MATRIX, TYPE=MASS\n",
        "*HEADING\n*MATRIX INPUT, NAME=K\n",
        "1, 2, 3, 4, 5\n", /* an element and its nodes */
        "1,1,1,1,x\n",
        "1,1,1,1\n",
        "1,1.,1,1,2.\n",
        "1 1 1 1 2.\n",
    };
    (void)state;

    for (size_t k = 0; k < sizeof OTHERS / sizeof *OTHERS; k++)
        assert_false(ritz_format_matrix_input.recognise(
            OTHERS[k], (int64_t)strlen(OTHERS[k])));
}

static const char *const SOUND[] = {LOWER, CALCULIX, UPPER, BOTH, SCALED};
enum { NUM_SOUND = sizeof SOUND / sizeof *SOUND };

static void a_file_cut_or_corrupted_anywhere_ends_well(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SOUND; k++) {
        damage_cut(damage_read_matrices, SOUND[k],
                   (int64_t)strlen(SOUND[k]) + 1);
        damage_corrupt(damage_read_matrices, SOUND[k],
                       (int64_t)strlen(SOUND[k]));
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SOUND; k++)
        assert_survives_every_allocation(read_text(SOUND[k]));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(triangles_and_scales_give_the_same_bits),
    cmocka_unit_test(one_triangle_in_another_order_of_nodes_is_completed),
    cmocka_unit_test(an_unsymmetric_matrix_stays_as_it_is),
    cmocka_unit_test(matrices_of_one_file_are_listed_by_name),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(only_the_keyword_or_an_entry_is_recognised),
    cmocka_unit_test(a_file_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(matrix_input, tests, NULL, NULL)
