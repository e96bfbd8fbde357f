#include "testing.h"

#include "damage.h"
#include "foreign.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static ritz_status parse(const char *text, ritz_matrices *out)
{
    return foreign_parse(text, (int64_t)strlen(text), out);
}

static ritz_status read_text(const char *text)
{
    return damage_read_matrices(text, (int64_t)strlen(text));
}

/* A 2 x 2 matrix by columns. */
static void assert_holds(const char *text, const double *re, const double *im)
{
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;

    assert_ok(parse(text, &all));
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

#define REAL "%%MatrixMarket matrix coordinate real "
#define CPLX "%%MatrixMarket matrix coordinate complex "

static void every_kind_is_read(void **state)
{
    static const double general[] = {1, 3, 0, -2.5};
    static const double symmetric[] = {1, 3, 3, -2.5};
    static const double skew[] = {0, 3, -3, 0};
    static const double ones[] = {1, 1, 0, 1};
    static const double hermitian_re[] = {1, 3, 3, 2};
    static const double hermitian_im[] = {0, 4, -4, 0};
    (void)state;

    assert_holds(REAL "general\n2 2 3\n1 1 1\n2 1 3\n2 2 -2.5", general, NULL);
    assert_holds(REAL "general\n% c\n\n2 2 3\n2 2 -2.5\n\n1 1 1\n2 1 3\n",
                 general, NULL);
    assert_holds("%%matrixmarket  MATRIX coordinate Real general \r\n"
                 "%\r\n2 2 4\r\n1 1 1\r\n2 1 3\r\n1 2 0\r\n2 2 -2.5d0\r\n",
                 general, NULL);
    assert_holds("%%MatrixMarket matrix array real general\n2 2\n1\n3\n0\n-2.5",
                 general, NULL);
    assert_holds("%%MatrixMarket matrix array real general\n2 2\n1 3 0\n-2.5",
                 general, NULL);
    assert_holds(REAL "symmetric\n2 2 3\n1 1 1\n2 1 3\n2 2 -2.5\n", symmetric,
                 NULL);
    assert_holds(REAL "symmetric\n2 2 3\n1 1 1\n1 2 3\n2 2 -2.5\n", symmetric,
                 NULL);
    assert_holds(REAL "symmetric\n2 2 4\n1 1 1\n1 2 3\n2 1 3\n2 2 -2.5\n",
                 symmetric, NULL);
    assert_holds("%%MatrixMarket matrix array real symmetric\n2 2\n1\n3\n-2.5",
                 symmetric, NULL);
    assert_holds(REAL "skew-symmetric\n2 2 1\n2 1 3\n", skew, NULL);
    assert_holds(REAL "skew-symmetric\n2 2 2\n2 1 3\n1 2 -3\n", skew, NULL);
    assert_holds("%%MatrixMarket matrix array real skew-symmetric\n2 2\n3\n",
                 skew, NULL);
    assert_holds("%%MatrixMarket matrix coordinate pattern general\n2 2 3\n"
                 "1 1\n2 1\n2 2\n",
                 ones, NULL);
    assert_holds(CPLX "hermitian\n2 2 3\n1 1 1 0\n2 1 3 4\n2 2 2 0\n",
                 hermitian_re, hermitian_im);
    assert_holds(CPLX "hermitian\n2 2 3\n1 1 1 0\n1 2 3 -4\n2 2 2 0\n",
                 hermitian_re, hermitian_im);
}

static void digits_are_those_of_the_longest_number(void **state)
{
    ritz_matrices all = {0};
    (void)state;

    assert_ok(
        parse(REAL "general\n2 2 2\n1 1 0.00125\n2 2 1.50000E+3\n", &all));
    assert_int_equal(all.matrix[0].digits, 6);
    ritz_matrices_free(&all);
    assert_ok(parse("%%MatrixMarket matrix coordinate integer general\n"
                    "2 2 1\n1 1 7\n",
                    &all));
    assert_int_equal(all.matrix[0].digits, 17); /* exact */
    ritz_matrices_free(&all);
}

static void what_is_wrong_is_said_with_its_line(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"%%MatrixMarket vector", "line 1: not"},
        {"%%MatrixMarket matrix sparse real general\n", "'coordinate'"},
        {"%%MatrixMarket matrix array pattern general\n1 1\n", "pattern"},
        {"%%MatrixMarket matrix array quaternion general\n1 1\n", "real"},
        {REAL "triangular\n1 1 1\n", "hermitian"},
        {REAL "hermitian\n1 1 1\n", "hermitian, but not complex"},
        {REAL "general\n", "ends before its size"},
        {REAL "general\n2 2\n", "line 2: '2 2' is not a size"},
        {REAL "general\n2 2 -1\n", "is not a size"},
        {REAL "symmetric\n2 3 1\n1 1 1\n", "cannot be 2 x 3"},
        {REAL "general\n2 2 2\n1 1 1\n", "line 3: ends after 1 of 2"},
        {REAL "general\n2 2 1\n1 1 1\n2 2 1\n",
         "line 4: more entries than the 1"},
        {REAL "general\n2 2 1\n3 1 1\n", "line 3: entry (3, 1) lies outside"},
        {REAL "general\n2 2 1\n0 1 1\n", "line 3: entry (0, 1) lies outside"},
        {REAL "general\n2 2 1\n1 1 x\n", "line 3: 'x' is not a number"},
        {REAL "general\n2 2 1\n1 1 nan\n", "line 3: the value is not finite"},
        {REAL "general\n2 2 1\n1 1 1e999\n", "not finite"},
        {REAL "general\n2 2 1\n1 1 1 2\n", "line 3: more than an entry"},
        {REAL "general\n2 2 1\n1.5 1 1\n", "is not an entry"},
        {REAL "general\n2 2 2\n1 1 1\n1 1 1\n", "(1, 1) is given twice"},
        {REAL "symmetric\n2 2 2\n2 1 1\n1 2 3\n",
         "(2, 1) and (1, 2) of a symmetric matrix disagree"},
        {REAL "symmetric\n2 2 3\n2 1 1\n1 2 1\n2 1 1\n",
         "(2, 1) is given twice"},
        {REAL "skew-symmetric\n2 2 1\n1 1 3\n", "diagonal entry 1"},
        {CPLX "hermitian\n2 2 1\n1 1 3 1\n", "diagonal entry 1"},
        {REAL "general\n2 2 1000000000\n1 1 1\n", "more entries than"},
        {REAL "general\n999999999999 1 1\n1 1 1\n", "far more than"},
        {"%%MatrixMarket matrix array real general\n30000000 30000000\n1\n",
         "more entries than"},
        {"%%MatrixMarket matrix array real general\n1 2\n1\n2\n3\n",
         "line 5: more values"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(read_text(cases[k].text), RITZ_ERR_FORMAT, cases[k].words);
}

/* At 80 letters, a round number of them, as at any other length. */
static void a_long_line_is_quoted_by_its_first_79_letters(void **state)
{
    (void)state;
    for (int length = 78; length <= 160; length++) {
        char line[161] = "";
        char text[300];
        char quoted[120];

        memset(line, 'x', (size_t)length);
        snprintf(text, sizeof text, "%sgeneral\n%s\n", REAL, line);
        snprintf(quoted, sizeof quoted, "line 2: '%.79s' is not a size", line);
        assert_fails(read_text(text), RITZ_ERR_FORMAT, quoted);
    }
}

/* Two mirrored pairs that agree, one after the other. */
static void both_triangles_are_taken_once(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};
    (void)state;

    assert_ok(parse(REAL "symmetric\n3 3 6\n2 1 1\n1 2 1\n3 1 2\n1 3 2\n"
                         "2 3 4\n3 2 4\n",
                    &all));
    assert_int_equal(all.matrix[0].A.colptr[3], 6);
    assert_true(ritz_sparse_asymmetry(&all.matrix[0].A) == 0.0);
    assert_true(all.matrix[0].symmetric);
}

static void assert_round_trip(const ritz_matrix *m, const char *spelling)
{
    const char *path = "market_round.mtx";
    ritz_matrices all = {0};
    int64_t nnz = m->A.colptr[m->A.ncol];

    assert_ok(ritz_matrix_market_write(path, m, "two\nlines"));
    assert_ok(foreign_read(path, &all));
    assert_string_equal(all.matrix[0].spelling, spelling);
    assert_int_equal(all.matrix[0].A.colptr[m->A.ncol], nnz);
    assert_memory_equal(all.matrix[0].A.rowind, m->A.rowind,
                        (size_t)nnz * sizeof *m->A.rowind);
    assert_memory_equal(all.matrix[0].A.val, m->A.val,
                        (size_t)nnz * sizeof *m->A.val);
    if (m->imaginary)
        assert_memory_equal(all.matrix[0].imaginary, m->imaginary,
                            (size_t)nnz * sizeof *m->imaginary);
    ritz_matrices_free(&all);
    remove(path);
}

static void what_is_written_is_read_to_the_same_bits(void **state)
{
    double imaginary[4] = {1e-300, -1.0 / 3.0, 2.0, 0.0};
    int64_t colptr[3] = {0, 2, 4};
    int64_t rowind[4] = {0, 1, 0, 1};
    double val[4] = {1.0 / 3.0, -1e300, -1e300, 0.1};
    ritz_matrix m = {.A = {2, 2, colptr, rowind, val}, .symmetric = true};
    (void)state;

    assert_round_trip(&m, "Matrix Market array, real, symmetric");
    val[2] = nextafter(-1e300, 0.0); /* the triangles differ in a bit */
    assert_round_trip(&m, "Matrix Market array, real, general");
    m.A.nrow = 3;
    rowind[1] = 2;
    m.symmetric = false;
    assert_round_trip(&m, "Matrix Market coordinate, real, general");
    m.imaginary = imaginary;
    assert_round_trip(&m, "Matrix Market coordinate, complex, general");
}

static void a_matrix_that_is_not_finite_leaves_no_file(void **state)
{
    int64_t colptr[2] = {0, 1};
    int64_t rowind[1] = {0};
    double val[1] = {HUGE_VAL};
    const ritz_matrix m = {.A = {1, 1, colptr, rowind, val}};
    (void)state;

    assert_fails(ritz_matrix_market_write("market_none.mtx", &m, NULL),
                 RITZ_ERR_ARGUMENT, "not finite");
    assert_int_not_equal(access("market_none.mtx", F_OK), 0);
}

/* Sizes from the files' own heads; the values of two are published. */
static void third_party_files_are_read(void **state)
{
    static const struct {
        const char *file;
        int64_t n, nnz;
        double first;
    } cases[] = {
        {"pairs/lund/lund_a.mtx", 147, 2449, 7.5e7},
        {"pairs/lund/lund_b.mtx", 147, 2441, 765.30615},
        {"pairs/bcsst01/bcsstm01.mtx", 48, 24, 100.0},
        {"second_order/LF10/K.mtx", 18, 0, 0.0},
        {"ansys/rotorAnsysMassMatrixSparse.txt", 345, 345, .9812500000001962},
        {"ansys/rotorAnsysStiffnessMatrixSparse.txt", 345, 0, 0.0},
    };
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    (void)state;

    if (!folder || access(folder, R_OK) != 0) {
        print_message("skipped: no external data\n");
        skip();
    }
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_matrices) all = {0};
        const ritz_matrix *m = NULL;
        char path[600];

        snprintf(path, sizeof path, "%s/%s", folder, cases[k].file);
        assert_ok(foreign_read(path, &all));
        m = &all.matrix[0];
        assert_int_equal(m->A.nrow, cases[k].n);
        assert_true(ritz_sparse_asymmetry(&m->A) == 0.0);
        assert_true(m->symmetric);
        if (cases[k].nnz > 0) {
            assert_int_equal(m->A.colptr[m->A.ncol], cases[k].nnz);
            assert_true(m->A.val[0] == cases[k].first);
        }
    }
}

static const char *const samples[] = {
    CPLX "hermitian\n2 2 3\n2 2 2 0\n1 1 1 0\n1 2 3 -4\n",
    REAL "symmetric\r\n3 3 4\r\n1 2 3.5e+2\r\n2 1 3.5E2\r\n3 3 1\r\n1 1 7",
    "%%MatrixMarket matrix array real general\n% c\n2 3\n1\n2\n3\n4\n5\n6\n",
    "%%MatrixMarket matrix coordinate pattern symmetric\n3 3 2\n3 1\n2 2\n",
    CPLX "general\n2 3 3\n1 1 1.5 -2\n2 3 0 1e-3\n1 2 -1 0\n",
    REAL "skew-symmetric\n% c\n\n4 4 3\n2 1 1.\n4 3 -2D0\n3 1 .25\n",
    "%%MatrixMarket matrix coordinate integer general\n2 2 2\n1 2 7\n2 2 9\n",
    "%%MatrixMarket matrix array complex hermitian\n2 2\n1 0\n2 3\n4 0\n",
    "%%MatrixMarket matrix array integer skew-symmetric\n3 3\n1 2\n3\n",
};

static void damaged_files_are_answered(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
        int64_t size = (int64_t)strlen(samples[k]);

        damage_cut(damage_read_matrices, samples[k], size);
        damage_corrupt(damage_read_matrices, samples[k], size);
    }
}

static void every_allocation_may_fail(void **state)
{
    int64_t colptr[2] = {0, 1};
    int64_t rowind[1] = {0};
    double val[1] = {1.0};
    const ritz_matrix m = {.A = {1, 1, colptr, rowind, val}};
    const char *path = "market_alloc.mtx";
    (void)state;

    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++)
        assert_survives_every_allocation(read_text(samples[k]));
    assert_survives_every_allocation(ritz_matrix_market_write(path, &m, NULL));
    remove(path);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_kind_is_read),
    cmocka_unit_test(digits_are_those_of_the_longest_number),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(a_long_line_is_quoted_by_its_first_79_letters),
    cmocka_unit_test(both_triangles_are_taken_once),
    cmocka_unit_test(what_is_written_is_read_to_the_same_bits),
    cmocka_unit_test(a_matrix_that_is_not_finite_leaves_no_file),
    cmocka_unit_test(third_party_files_are_read),
    cmocka_unit_test(damaged_files_are_answered),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(matrix_market, tests, NULL, NULL)
