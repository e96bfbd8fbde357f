#include "testing.h"

#include "damage.h"
#include "foreign.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define TITLE                                                                  \
    "A matrix of two rows                                                    " \
    "KEY     \n"

/* Columns of fourteen. */
#define COUNTS(all, p, r, v, rhs)                                              \
    "             " all "             " p "             " r "             " v  \
    "             " rhs "\n"
#define SIZES(type, n, m, entries)                                             \
    type "           "                                                         \
         "             " n "             " m "             " entries           \
         "             0\n"
#define FORMS(p, r, values) p r values "\n"
#define I4                  "(4I4)           "
#define TWO                 TITLE COUNTS("3", "1", "1", "1", "0")
#define HEAD(type)          TWO SIZES(type, "2", "2", "3")
#define PLACES              "   1   3   4\n   1   2   2\n"
#define E12                 FORMS(I4, I4, "(3E12.4)            ")
#define THREE               "  1.0000E+00  3.0000E+00 -2.5000E+00\n"

static ritz_status read_text(const char *text)
{
    return damage_read_matrices(text, (int64_t)strlen(text));
}

/* A 2 x 2 matrix by columns. */
static void assert_holds(const char *text, const double *re, const double *im)
{
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;

    assert_ok(foreign_parse(text, (int64_t)strlen(text), &all));
    assert_string_equal(foreign_format, "harwell-boeing");
    assert_int_equal(all.count, 1);
    m = &all.matrix[0];
    assert_int_equal(m->A.nrow, 2);
    assert_int_equal(m->A.ncol, 2);
    assert_ok(ritz_sparse_check(&m->A, m->A.colptr[2]));
    assert_int_equal(!m->imaginary, !im);
    for (int e = 0; e < 4; e++) {
        assert_true(matrix_entry(&m->A, m->A.val, e % 2, e / 2) == re[e]);
        assert_true(!im ||
                    matrix_entry(&m->A, m->imaginary, e % 2, e / 2) == im[e]);
    }
}

static const double general[] = {1, 3, 0, -2.5};
static const double symmetric[] = {1, 3, 3, -2.5};

static void every_type_is_read(void **state)
{
    static const double skew[] = {0, 3, -3, 0};
    static const double whole[] = {1, 3, 3, -2};
    static const double re[] = {1, 3, 3, 2};
    static const double im[] = {0, 4, -4, 0}, same[] = {0, 4, 4, 0};
    (void)state;

    assert_holds(HEAD("RUA") E12 PLACES THREE, general, NULL);
    assert_holds(HEAD("RRA") E12 PLACES THREE, general, NULL);
    assert_holds(HEAD("RSA") E12 PLACES THREE, symmetric, NULL);
    assert_holds(HEAD("rsa") E12 PLACES THREE, symmetric, NULL);
    assert_holds(HEAD("rua") E12 PLACES THREE, general, NULL);
    /* the upper triangle */
    assert_holds(HEAD("RSA") E12 "   1   2   4\n   1   1   2\n" THREE,
                 symmetric, NULL);
    assert_holds(HEAD("rza") E12 PLACES
                 "  0.0000E+00  3.0000E+00  0.0000E+00\n",
                 skew, NULL);
    assert_holds(HEAD("isa") FORMS(I4, I4, "(3I4)               ") PLACES
                 "   1   3  -2\n",
                 whole, NULL);
    assert_holds(HEAD("CHA") FORMS(I4, I4, "(6F5.1)             ") PLACES
                 "  1.0  0.0  3.0  4.0  2.0  0.0\n",
                 re, im);
    assert_holds(HEAD("CSA") FORMS(I4, I4, "(6F5.1)             ") PLACES
                 "  1.0  0.0  3.0  4.0  2.0  0.0\n",
                 re, same);
}

static void every_spelling_of_numbers_is_read(void **state)
{
    (void)state;
    assert_holds(
        HEAD("RUA") FORMS(
            "(16I1)          ", "(10i1)          ",
            "( 3D9.1 )           ") "134\n122\n  1.0D+00  3.0d+00 -2.5D+00\n",
        general, NULL);
    /* values touch, and have no E */
    assert_holds(HEAD("RUA")
                     FORMS("(16I5)          ", "(10I8)          ",
                           "(5E7.1)             ") "    1    3    4\r\n       "
                                                   "1       2       2\r\n"
                                                   "1.00+003.00+00-2.5+00\r\n",
                 general, NULL);
    assert_holds(HEAD("RUA") FORMS(I4, I4, "(1P,3E12.4)         ") PLACES THREE,
                 general, NULL);
    assert_holds(HEAD("RUA") FORMS(I4, I4, "(1P3E12.4E2)        ") PLACES THREE,
                 general, NULL);
    assert_holds(HEAD("RUA") FORMS(I4, I4, "(3G12.4)            ") PLACES
                 "         1.0         3.0        -2.5",
                 general, NULL);
    /* one number on a line, as ANSYS writes */
    assert_holds(
        TITLE COUNTS("9", "3", "3", "3", "0") SIZES("RUA", "2", "2", "3")
            FORMS("(I4)            ", "(1I4)           ",
                  "(D12.4)             ") "   1\n   3\n   4\n   1\n   2\n   2\n"
                                          "  1.0000D+00\n  3.0000D+00\n "
                                          "-2.5000D+00\n\n",
        general, NULL);
}

static void right_sides_are_passed_over(void **state)
{
    static const char text[] = TITLE COUNTS("4", "1", "1", "1",
                                            "1") SIZES("RSA", "2", "2", "3")
        FORMS(I4, I4,
              "(3E12.4)            (3E12.4)") "F                          1    "
                                              "         0\n" PLACES THREE
                                              "  1.0000E+00  2.0000E+00\n";
    RITZ_OWN(ritz_matrices) all = {0};
    (void)state;

    assert_holds(text, symmetric, NULL);
    assert_ok(foreign_parse(text, sizeof text - 1, &all));
    assert_string_equal(all.matrix[0].spelling,
                        "Harwell-Boeing RSA, (3E12.4), right sides unread");
    assert_int_equal(all.matrix[0].digits, 5);
    assert_true(all.matrix[0].symmetric);
}

/*
 * What scipy.io.hb_write of SciPy 1.10.1 writes for
 * [[4, -1/3, 0], [0, 1e-20, 2.5], [1/7, 0, -3e100]], with fields of 24 columns
 * where its fourth line says 25.
 */
#define SCIPY(width)                                                           \
    "Default title                                                       "     \
    "    0       \n"                                                           \
    "             4             1             1             2\n"               \
    "RUA                        3             3             6             0\n" \
    "(40I2)          (40I2)          (3E" width ".16)           \n"            \
    " 1 3 5 7\n"                                                               \
    " 1 3 1 2 2 3\n"                                                           \
    "  4.0000000000000000E+00  1.4285714285714285E-01"                         \
    " -3.3333333333333331E-01\n"                                               \
    "  9.9999999999999995E-21  2.5000000000000000E+00"                         \
    "-2.9999999999999999E+100\n"

static void a_file_of_scipy_is_read_if_it_states_its_width(void **state)
{
    static const char text[] = SCIPY("24");
    static const double due[3][3] = {
        {4.0, -1.0 / 3.0, 0.0}, {0.0, 1e-20, 2.5}, {1.0 / 7.0, 0.0, -3e100}};
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;
    (void)state;

    assert_fails(read_text(SCIPY("25")), RITZ_ERR_FORMAT,
                 "line 7: '1.4285714285714285E-01 -' is not a number");
    assert_ok(foreign_parse(text, sizeof text - 1, &all));
    m = &all.matrix[0];
    assert_int_equal(m->A.colptr[3], 6);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_true(matrix_entry(&m->A, m->A.val, i, j) == due[i][j]);
    assert_int_equal(m->digits, 17);
}

static const struct {
    const char *text, *words;
} wrong[] = {
    {HEAD("PSA") E12 PLACES, "line 3: type 'PSA' is a pattern"},
    {HEAD("qsa") E12 PLACES, "type 'QSA' is a pattern"},
    {HEAD("RSE") E12 PLACES THREE, "type 'RSE' has matrices of elements"},
    {HEAD("RHA") E12 PLACES THREE, "hermitian, but not complex"},
    {TWO SIZES("RSA", "2", "3", "3") E12 PLACES THREE,
     "type 'RSA' cannot be 2 x 3"},
    {TWO "RUA                        2             2     999999999\n" E12 PLACES
         THREE,
     "2 x 2 with 999999999 entries is more than"},
    {HEAD("RUA"), "line 3: ends before its formats"},
    {HEAD("RUA") FORMS("(4F4.0)         ", I4, "(3E12.4)"),
     "line 4: '(4F4.0)' is not a format of whole numbers"},
    {HEAD("RUA") FORMS(I4, "4I4             ", "(3E12.4)"),
     "line 4: '4I4' is not a format of whole numbers"},
    {HEAD("RUA") FORMS(I4, I4, "(3(1X,E12.4))"),
     "line 4: '(3(1X,E12.4))' is not a format of values"},
    {HEAD("RUA") FORMS(I4, I4, "(3E12.4E)"), "is not a format of values"},
    {HEAD("RUA") FORMS(I4, I4, "(0E12.4)"), "is not a format of values"},
    {HEAD("RUA") FORMS(I4, I4, "(3E)"), "is not a format of values"},
    {HEAD("RUA") FORMS(I4, I4, "(3E12.)"), "is not a format of values"},
    {HEAD("RUA") FORMS(I4, I4, "(1P,E12.4"), "is not a format of values"},
    {TITLE COUNTS("4", "1", "1", "1", "1") SIZES("RUA", "2", "2", "3") E12,
     "ends before its fifth line"},
    {HEAD("RUA") FORMS("(2I4)           ", I4, "(3E12.4)") PLACES THREE,
     "3 pointers as (2I4) take 2 lines, but the head says 1"},
    {HEAD("RUA") FORMS(I4, "(1I4)           ", "(3E12.4)") PLACES THREE,
     "3 rows as (1I4) take 3 lines"},
    {HEAD("RUA") FORMS(I4, I4, "(E12.4)") PLACES THREE,
     "3 values as (E12.4) take 3 lines"},
    {HEAD("RUA") E12, "line 4: ends before all numbers as (4I4)"},
    {HEAD("RUA") E12 "   1   3", "line 5: ends within a number"},
    {HEAD("RUA") E12 "   1   3\n", "number 3 of the line, as (4I4), is"},
    {HEAD("RUA") E12 "   1   3   4   5\n", "line 5: '5' follows"},
    {HEAD("RUA") E12 "   1 3.0   4\n", "line 5: '3.0' is not a whole"},
    {HEAD("RUA") E12 "   2   3   4\n", "pointer 2 is not from 1 to 1"},
    {HEAD("RUA") E12 "   1   5   4\n", "pointer 5 is not from 1 to 4"},
    {HEAD("RUA") E12 "   1   3   3\n", "pointer 3 is not from 4 to 4"},
    {TITLE COUNTS("3", "1", "1", "1", "0") SIZES("RUA", "2", "3", "3") E12
     "   1   3   2   4\n",
     "pointer 2 is not from 3 to 4"},
    {HEAD("RUA") E12 "   1   3   4\n   1   2   3\n",
     "line 6: row 3 is not from 1 to 2"},
    {HEAD("RUA") E12 "   1   3   4\n   1   0   2\n", "row 0 is not from 1"},
    {HEAD("RUA") E12 PLACES "         1.x", "line 7: '1.x' is not a"},
    {HEAD("RUA") E12 PLACES "         nan         1.0         2.0\n",
     "line 7: 'nan' is not finite"},
    {HEAD("RUA") E12 PLACES "      1.E999         1.0         2.0\n",
     "'1.E999' is not finite"},
    {HEAD("RUA") E12 PLACES "           5         1.0         2.0\n",
     "'5' has no point or exponent, and is scaled as (3E12.4)"},
    {HEAD("RUA") FORMS(I4, I4, "(1P,3E12.4)") PLACES
     "         5.0         1.0         2.0\n",
     "'5.0' has no point or exponent, and is scaled as (1P,3E12.4)"},
    {HEAD("RUA") E12 PLACES THREE "\n x\n", "line 9: more than the head says"},
    {HEAD("RUA") E12 "   1   3   4\n   2   2   1\n" THREE,
     "entry (2, 1) is given twice"},
    {HEAD("RSA") E12 "   1   3   4\n   1   2   1\n" THREE,
     "entry (2, 1) is given twice; such a type gives one triangle only"},
    {HEAD("RZA") E12 PLACES THREE, "diagonal entry 1 cannot be in type"},
    {HEAD("CHA") FORMS(I4, I4, "(6F5.1)") PLACES
     "  1.0  1.0  3.0  4.0  2.0  0.0\n",
     "line 7: diagonal entry 1 cannot be in type 'CHA'"},
    {TITLE COUNTS("3", "1", "1", "1", "0") "RXA\n", "holds no matrix"},
    {TITLE COUNTS("2", "1", "1", "1", "0") SIZES("RUA", "2", "2", "3"),
     "holds no matrix"},
};

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;

    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_fails(read_text(wrong[k].text), RITZ_ERR_FORMAT, wrong[k].words);
}

static const char *const samples[] = {
    HEAD("RSA") E12 PLACES THREE,
    HEAD("rua") FORMS("(16I1)          ", "(10I1)          ",
                      "(3D9.1)") "134\n122\n  1.0D+00  3.0d+00 -2.5D+00\n",
    HEAD("CHA") FORMS(I4, I4, "(6F5.1)") PLACES
    "  1.0  0.0  3.0  4.0  2.0  0.0\n",
    HEAD("RSA")
        FORMS(I4, I4, "(1P,3E12.4)") "   1   2   4\n   1   2   1\n" THREE,
    TITLE COUNTS("9", "3", "3", "3", "0") SIZES("ISA", "2", "2", "3")
        FORMS("(I4)            ", "(1I4)           ",
              "(I2)") "   1\n   3\n   4\n   1\n   2\n   2\n 1\n 3\n-2\n",
};

enum { NUM_SAMPLES = sizeof samples / sizeof *samples };

/* A file that lost more than the end of its last line lost a number. */
static void a_file_that_is_cut_is_refused(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++) {
        const int64_t size = (int64_t)strlen(samples[k]);

        assert_ok(damage_read_matrices(samples[k], size));
        for (int64_t less = 0; less < size - 1; less++)
            assert_int_equal(damage_read_matrices(samples[k], less),
                             RITZ_ERR_FORMAT);
        assert_ok(damage_read_matrices(samples[k], size - 1));
    }
}

static void damaged_files_are_answered(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++) {
        const int64_t size = (int64_t)strlen(samples[k]);

        damage_cut(damage_read_matrices, samples[k], size);
        damage_corrupt(damage_read_matrices, samples[k], size);
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++)
        assert_survives_every_allocation(read_text(samples[k]));
}

/* The same matrix as Matrix Market, in a file of another origin. */
static void a_public_file_is_read(void **state)
{
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    RITZ_OWN(ritz_matrices) boeing = {0}, market = {0};
    const ritz_sparse *A = NULL, *B = NULL;
    char path[600];
    (void)state;

    if (!folder || access(folder, R_OK) != 0) {
        print_message("skipped: no external data\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/pairs/lund/lund_a.rsa", folder);
    assert_ok(foreign_read(path, &boeing));
    snprintf(path, sizeof path, "%s/pairs/lund/lund_a.mtx", folder);
    assert_ok(foreign_read(path, &market));
    A = &boeing.matrix[0].A;
    B = &market.matrix[0].A;
    assert_int_equal(A->ncol, B->ncol);
    assert_int_equal(A->colptr[A->ncol], B->colptr[B->ncol]);
    for (int64_t p = 0; p < A->colptr[A->ncol]; p++) {
        assert_int_equal(A->rowind[p], B->rowind[p]);
        assert_true(A->val[p] == B->val[p]);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_type_is_read),
    cmocka_unit_test(every_spelling_of_numbers_is_read),
    cmocka_unit_test(right_sides_are_passed_over),
    cmocka_unit_test(a_file_of_scipy_is_read_if_it_states_its_width),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(a_file_that_is_cut_is_refused),
    cmocka_unit_test(damaged_files_are_answered),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(a_public_file_is_read),
};

TEST_MODULE(harwell_boeing, tests, NULL, NULL)
