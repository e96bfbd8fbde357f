#include "testing.h"

#include "damage.h"
#include "foreign.h"
#include "solvers.h"

#include <ritz/import.h>

#include <dirent.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { PATH_SIZE = 512 };

static void parse(const char *bytes, ritz_matrices *out)
{
    assert_ok(foreign_parse(bytes, (int64_t)strlen(bytes), out));
}

static double at(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->A.val, i, j);
}

/* Same pattern; numbers equal to half a unit of digit `digits`, 0: bits. */
static void assert_same(const ritz_matrix *a, const ritz_matrix *b,
                        int64_t digits)
{
    int64_t nnz = a->A.colptr[a->A.ncol];

    assert_int_equal(a->A.nrow, b->A.nrow);
    assert_int_equal(a->A.ncol, b->A.ncol);
    assert_memory_equal(a->A.colptr, b->A.colptr,
                        (size_t)(a->A.ncol + 1) * sizeof *a->A.colptr);
    assert_int_equal(!a->imaginary, !b->imaginary);
    for (int64_t p = 0; p < nnz; p++) {
        const double x[2] = {a->A.val[p], a->imaginary ? a->imaginary[p] : 0};
        const double y[2] = {b->A.val[p], b->imaginary ? b->imaginary[p] : 0};

        assert_int_equal(a->A.rowind[p], b->A.rowind[p]);
        for (int part = 0; part < 2; part++) {
            double scale = fmax(fabs(x[part]), 1e-300);
            /* half a unit of the last digit, two ulp for both roundings */
            double unit = pow(10.0, floor(log10(scale)) + 1.0 - (double)digits);
            double bound =
                digits > 0 ? 0.5 * unit + 2.0 * DBL_EPSILON * scale : 0.0;

            assert_near(x[part], y[part], bound);
        }
    }
}

/* 1 0 / 2 3 / 0 4 in each spelling of text; words differ, not the matrix. */
static const char dense[] = "       2       3       2       2A       "
                            "1P,3E16.9\n"
                            "       1       1       2\n"
                            " 1.000000000E+00 2.000000000E+00\n"
                            "       2       2       2\n"
                            " 3.000000000E+00 4.000000000E+00\n"
                            "       3       1       1\n"
                            " 1.414213562E+00\n";
static const char bigmat[] = "       2      -3       2       2A       "
                             "1P,3D16.9\n"
                             "       1       0       6\n"
                             "       5       1\n"
                             " 1.000000000D+00 2.000000000D+00\n"
                             "       2       0       6\n"
                             "       5       2\n"
                             " 3.000000000D+00 4.000000000D+00\n"
                             "       3       1       1\n"
                             " 1.414213562D+00\n";
static const char unmarked[] = "       2       3       2       2A       "
                               "1P,3E16.9\n"
                               "       1       0       6\n"
                               "       5       1\n"
                               " 1.000000000+000 2.000000000+000\n"
                               "       2       0       6\n"
                               "       5       2\n"
                               " 3.000000000+000 4.000000000+000\n"
                               "       3       1       1\n"
                               " 1.414213562+000\n";
static const char strings[] = "       2       3       2       2A\n"
                              "       1       0       5\n"
                              "  327681\n"
                              " 1.000000000E+00 2.000000000E+00\n"
                              "       2       0       5\n"
                              "  327682\n"
                              " 3.000000000E+00 4.000000000E+00\n"
                              "       3       1       2\n"
                              " 1.414213562E+00\n";
static const char nastran95[] = "       2       3       2       2A       "
                                "1P,3E16.9\r\n"
                                "       1       0       5\r\n"
                                "  131073\r\n"
                                " 1.000000000E+00 2.000000000E+00\r\n"
                                "       2       0       6\r\n"
                                "   65538\r\n"
                                " 3.000000000E+00\r\n"
                                "   65539\r\n"
                                " 4.000000000E+00\r\n"
                                "       3       1       1\r\n"
                                " 1.414213562E+00\r\n";
static const char wide[] = "               2               3       2       2"
                           "A       1P,3E16.9|I16\n"
                           "               1               1               2\n"
                           " 1.000000000E+00 2.000000000E+00\n"
                           "               2               2               2\n"
                           " 3.000000000E+00 4.000000000E+00\n"
                           "               3               1               1\n"
                           " 1.414213562E+00\n";
static const char one_word[] = "       2       3       2       2A       "
                               "1P,3E16.9\n"
                               "       1       0       3\n"
                               "  196609\n"
                               " 1.000000000E+00 2.000000000E+00\n"
                               "       2       0       3\n"
                               "  196610\n"
                               " 3.000000000E+00 4.000000000E+00\n"
                               "       3       1       1\n"
                               " 1.414213562E+00\n";
static const char *const spellings[] = {dense,     bigmat, unmarked, strings,
                                        nastran95, wide,   one_word};
enum { SPELLINGS = sizeof spellings / sizeof *spellings };

static void every_spelling_of_text_gives_the_same_matrix(void **state)
{
    (void)state;
    for (int k = 0; k < SPELLINGS; k++) {
        RITZ_OWN(ritz_matrices) all = {0};
        const ritz_matrix *m = NULL;

        parse(spellings[k], &all);
        m = &all.matrix[0];
        assert_int_equal(all.count, 1);
        assert_string_equal(m->name, "A");
        assert_string_equal(foreign_format, "output4");
        assert_int_equal(m->A.nrow, 3);
        assert_int_equal(m->A.ncol, 2);
        assert_int_equal(m->A.colptr[2], 4);
        assert_true(at(m, 0, 0) == 1.0 && at(m, 1, 0) == 2.0);
        assert_true(at(m, 1, 1) == 3.0 && at(m, 2, 1) == 4.0);
        assert_int_equal(m->digits, 10);
        assert_false(m->symmetric);
    }
}

/* Lines that end in "\r\n", and some that end in blanks too, which are not read
   field by field. */
static void ends_of_lines_make_no_difference(void **state)
{
    (void)state;
    for (int k = 0; k < SPELLINGS; k++) {
        RITZ_OWN(ritz_matrices) usual = {0}, other = {0};
        char text[1200];
        size_t used = 0;

        for (const char *c = spellings[k]; *c; c++) {
            if (*c == '\n' && c[-1] != '\r') {
                if (used % 3 == 0)
                    text[used++] = ' ';
                text[used++] = '\r';
            }
            text[used++] = *c;
            assert_true(used + 2 < sizeof text);
        }
        text[used] = '\0';
        parse(spellings[k], &usual);
        parse(text, &other);
        for (int64_t i = 0; i < 3; i++)
            for (int64_t j = 0; j < 2; j++)
                assert_true(at(&usual.matrix[0], i, j) ==
                            at(&other.matrix[0], i, j));
        assert_string_equal(usual.matrix[0].spelling, other.matrix[0].spelling);
    }
}

static void forms_mean_what_nastran_means_by_them(void **state)
{
    static const char end[] = " 1.0E+00\n";
    static const char *const text[] = {
        /* one triangle of FORM 6 */
        "       2       2       6       2K       1P,2E8.1\n"
        "       1       1       2\n 1.0E+00 2.0E+00\n"
        "       2       2       1\n 3.0E+00\n       3       1       1\n",
        /* FORM 3 as one column */
        "       1       2       3       2D       1P,2E8.1\n"
        "       1       1       2\n 1.0E+00 2.0E+00\n"
        "       2       1       1\n",
        /* FORM 8 without entries */
        "       2       2       8       2I       1P,2E8.1\n"
        "       3       1       1\n",
        /* FORM 4 stays a triangle */
        "       2       2       4       2L       1P,2E8.1\n"
        "       1       1       2\n 1.0E+00 2.0E+00\n"
        "       2       2       1\n 3.0E+00\n       3       1       1\n",
    };
    static const double expected[4][4] = {
        {1, 2, 2, 3}, {1, 0, 0, 2}, {1, 0, 0, 1}, {1, 2, 0, 3}};
    (void)state;

    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_matrices) all = {0};
        char whole[300];

        snprintf(whole, sizeof whole, "%s%s", text[k], end);
        parse(whole, &all);
        assert_int_equal(all.matrix[0].A.ncol, 2);
        for (int e = 0; e < 4; e++)
            assert_true(at(&all.matrix[0], e % 2, e / 2) == expected[k][e]);
        assert_int_equal(all.matrix[0].symmetric, k < 3);
    }
}

static void ten_million_null_columns_are_read(void **state)
{
    static const char text[] =
        "        10000001       -10000001       1       2BIG     "
        "1P,2E8.1|I16\n"
        "10000001       0       4\n"
        "       3       7\n"
        " 5.0E+00\n"
        "10000002       1       1\n"
        " 1.0E+00\n";
    RITZ_OWN(ritz_matrices) all = {0};
    (void)state;

    parse(text, &all);
    assert_int_equal(all.matrix[0].A.ncol, 10000001);
    assert_int_equal(all.matrix[0].A.colptr[10000000], 0);
    assert_true(at(&all.matrix[0], 6, 10000000) == 5.0);
}

static void what_is_wrong_is_said(void **state)
{
#define HEAD "       2       3       2       2A       1P,2E8.1\n"
    static const struct {
        const char *text, *words;
    } cases[] = {
        {HEAD "       1       3       2\n 1.0E+00 2.0E+00\n", "3 rows"},
        {HEAD "       2       1       1\n 1.0E+00\n"
              "       1       1       1\n 1.0E+00\n",
         "column 1 of 'A' follows column 2"},
        {HEAD "       1       1       1\n 1.0E+00\n"
              "       1       2       1\n 1.0E+00\n",
         "column 1 of 'A' follows column 1"},
        {HEAD "       1       1       1\n     NaN\n",
         "row 1 of column 1 of 'A' is not finite"},
        {HEAD "       1       1       1\n1.0E+999\n",
         "row 1 of column 1 of 'A' is not finite"},
        {HEAD "       1       1       1\n 1.0X+00\n", "is not a number"},
        {HEAD "       1       1       3\n 1.0E+00 2.0E+00\n",
         "column 1 of 'A' ends after 2 of 3 numbers"},
        {HEAD "       1       1       1\n 1.0E+00 2.0E+00\n",
         "wants no more than 1"},
        {HEAD "       1       1       1\n 1.0E+00\n",
         "'A' ends after column 1 of 2"},
        {HEAD "       1       0       5\n  131072\n 1.0E+00\n",
         "begins no string of column 1"},
        {HEAD "       9       1       1\n 1.0E+00\n",
         "has 2 columns, but one is numbered 9"},
        {HEAD "       1       0       6\n  196610\n 1.0E+00\n"
              "  196609\n 1.0E+00\n",
         "rows of column 1 of 'A' do not ascend"},
        {HEAD "       3       1       1\n 1.0E+00\nhello\n",
         "'hello' begins no matrix"},
        {"99999999       3       2       2A       1P,2E8.1\n"
         "       1       1       1\n 1.0E+00\n",
         "far more than its file can fill"},
        {"       2       3       2       4A       1P,2E8.1\n"
         "       1       1       1\n 1.0E+00\n",
         "half a complex value"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(
            damage_read_matrices(cases[k].text, (int64_t)strlen(cases[k].text)),
            RITZ_ERR_FORMAT, cases[k].words);
}

/* A matrix with gaps, negative and extreme values; complex on request. */
static void make(bool complex, bool extreme, ritz_matrix *out)
{
    enum { N = 9 };
    double *imaginary = calloc(64, sizeof *imaginary);
    int64_t p = 0;

    assert_ok(ritz_sparse_new(N + 2, N, 64, &out->A));
    for (int64_t j = 0; j < N; j++) {
        out->A.colptr[j] = p;
        for (int64_t i = j % 4; i < N + 2 && j != 3; i += 1 + (i + j) % 3) {
            out->A.rowind[p] = i;
            out->A.val[p] = sin((double)(7 * i + j + 1)) / 3.0;
            if (extreme && i % 2)
                out->A.val[p] *= 1e-200;
            imaginary[p++] = complex ? cos((double)(i + 5 * j)) * 1e5 : 0.0;
        }
    }
    out->A.colptr[N] = p;
    snprintf(out->name, sizeof out->name, "%s", complex ? "cplx" : "kreal");
    out->imaginary = complex ? imaginary : NULL;
    if (!complex)
        free(imaginary);
}

static void assert_round_trip(int64_t count, const ritz_matrix *m,
                              const ritz_output4_style *style)
{
    const char *path = "output4_round.op4";
    RITZ_OWN(ritz_matrices) all = {0};

    assert_ok(ritz_output4_write(path, count, m, style));
    assert_ok(foreign_read(path, &all));
    assert_int_equal(all.count, count);
    for (int64_t k = 0; k < count; k++) {
        assert_string_equal(all.matrix[k].name,
                            m[k].imaginary ? "CPLX" : "KREAL");
        assert_int_equal(all.matrix[k].digits, style->digits);
        assert_same(&m[k], &all.matrix[k],
                    style->digits < 17 ? style->digits : 0);
    }
    remove(path);
}

static void what_is_written_is_read_to_the_same_bits(void **state)
{
    (void)state;
    for (int k = 0; k < 16; k++) {
        const ritz_output4_style style = {k & 1, k & 2, 17};
        ritz_matrix m[2] = {0};

        make(k & 4, k & 8, &m[0]);
        make(!(k & 4), false, &m[1]);
        assert_round_trip(2, m, &style);
        ritz_matrix_free(&m[0]);
        ritz_matrix_free(&m[1]);
    }
}

static void fewer_digits_are_right_to_half_a_unit(void **state)
{
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    make(true, false, &m);
    for (int64_t digits = 1; digits <= 16; digits++)
        assert_round_trip(1, &m,
                          &(ritz_output4_style){true, digits % 2, digits});
}

static void what_cannot_be_written_leaves_no_file(void **state)
{
    const ritz_output4_style style = {.text = true, .digits = 18};
    const ritz_output4_style binary = {0};
    const char *path = "output4_none.op4";
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    make(false, false, &m);
    assert_fails(ritz_output4_write(path, 1, &m, &style), RITZ_ERR_ARGUMENT,
                 "1 to 17");
    assert_fails(ritz_output4_write(path, 0, &m, &binary), RITZ_ERR_ARGUMENT,
                 "there is no matrix");
    m.A.val[2] = HUGE_VAL;
    assert_fails(ritz_output4_write(path, 1, &m, &binary), RITZ_ERR_ARGUMENT,
                 "not finite");
    m.A.val[2] = 1.0;
    assert_fails(ritz_output4_write("/no/such/place", 1, &m, &binary),
                 RITZ_ERR_FILE, "/no/such/place");
    assert_int_not_equal(access(path, F_OK), 0);
}

/* Files that hold the same matrices as the first; 0 digits: the same bits. */
static const struct {
    int64_t digits;
    const char *file, *other[12];
} families[] = {
    {0,
     "output4/double_dense_le.op4",
     {"output4/double_dense_be.op4", "output4/double_dense_le_i64.op4",
      "output4/double_dense_be_i64.op4", "output4/double_bigmat_le.op4",
      "output4/double_bigmat_be.op4", "output4/double_bigmat_be_i64.op4",
      "output4/double_bigmat_le_i64.op4", "output4/double_nonbigmat_le.op4",
      "output4/double_nonbigmat_be.op4", "output4/double_nonbigmat_le_i64.op4",
      "output4/double_nonbigmat_be_i64.op4"}},
    {10,
     "output4/double_dense_le.op4",
     {"output4/double_dense_ascii.op4", "output4/double_bigmat_ascii.op4"}},
    {15, "output4/double_dense_le.op4", {"output4/double_nonbigmat_ascii.op4"}},
    {0,
     "output4/double_dense_ascii.op4",
     {"output4/double_dense_ascii_d.op4", "output4/double_dense_ascii_i64.op4",
      "output4/double_bigmat_ascii.op4", "output4/double_bigmat_ascii_d.op4",
      "output4/double_bigmat_ascii_i64.op4",
      "output4/double_bigmat_ascii_badname.op4"}},
    {0,
     "output4/double_nonbigmat_ascii.op4",
     {"output4/double_nonbigmat_ascii_d.op4",
      "output4/double_nonbigmat_ascii_i64.op4"}},
    {0,
     "output4/single_dense_le.op4",
     {"output4/single_dense_be.op4", "output4/single_bigmat_le.op4",
      "output4/single_bigmat_be.op4", "output4/single_nonbigmat_le.op4",
      "output4/single_nonbigmat_be.op4"}},
    {10, "output4/single_dense_le.op4", {"output4/single_dense_ascii.op4"}},
    {9, "output4/single_dense_le.op4", {"output4/single_bigmat_ascii.op4"}},
    {0, "output4/single_dense_le.op4", {"output4/single_nonbigmat_ascii.op4"}},
    {0,
     "output4/single_dense_le_i64.op4",
     {"output4/single_dense_be_i64.op4", "output4/double_dense_le.op4",
      "output4/single_bigmat_le_i64.op4", "output4/single_nonbigmat_be_i64.op4",
      "output4/single_nonbigmat_le_i64.op4"}},
    {10,
     "output4/single_dense_le_i64.op4",
     {"output4/single_dense_ascii_i64.op4"}},
    {0,
     "output4/double_bigmat_be.op4.other",
     {"output4/double_nonbigmat_be.op4.other"}},
    {0,
     "output4/double_bigmat_ascii.op4.other",
     {"output4/double_nonbigmat_ascii.op4.other"}},
    {10,
     "output4/double_bigmat_be.op4.other",
     {"output4/double_bigmat_ascii.op4.other"}},
    {0,
     "output4/cdbin_ascii_sparse_bigmat.op4",
     {"output4/cdbin_ascii_sparse_nonbigmat.op4"}},
    {16, "output4/cdbin.op4", {"output4/cdbin_ascii_sparse_bigmat.op4"}},
    {17, "output4/cdbin.op4", {"output4/cd.op4"}},
    {10, "output4/csbin.op4", {"output4/cs.op4"}},
    {17, "output4/rdbin.op4", {"output4/rd.op4"}},
    {10, "output4/rsbin.op4", {"output4/rs.op4"}},
    {17, "output4/binary_fabiola.op4", {"output4/ascii_fabiola.op4"}},
    {0, "output4/big_dense_binary.op4", {"output4/big_bigmat_binary.op4"}},
    {0, "output4/big_dense_ascii.op4", {"output4/big_bigmat_ascii.op4"}},
    {0, "output4/big_dense_binary.op4", {"output4/big_dense_ascii.op4"}},
    {0,
     "public_solvers/nastran95_inboard.op4",
     {"public_solvers/nastran95_inboard_dense.op4"}},
    {0,
     "pynastran/mat_b_dn.op4",
     {"pynastran/mat_b_s1.op4", "pynastran/mat_b_s2.op4"}},
    {15,
     "pynastran/mat_t_dn.op4",
     {"pynastran/mat_t_s1.op4", "pynastran/mat_t_s2.op4"}},
};

static void spellings_of_third_party_files_agree(void **state)
{
    char path[PATH_SIZE];
    int64_t pairs = 0;
    (void)state;

    if (!solvers_find("", path))
        skip();
    for (size_t k = 0; k < sizeof families / sizeof *families; k++)
        for (int o = 0; families[k].other[o]; o++, pairs++) {
            RITZ_OWN(ritz_matrices) a = {0};
            RITZ_OWN(ritz_matrices) b = {0};

            solvers_find(families[k].file, path);
            assert_ok(foreign_read(path, &a));
            solvers_find(families[k].other[o], path);
            assert_ok(foreign_read(path, &b));
            assert_int_equal(a.count, b.count);
            for (int64_t m = 0; m < a.count; m++)
                assert_same(&a.matrix[m], &b.matrix[m], families[k].digits);
        }
    assert_int_equal(pairs, 54);
}

static void all_third_party_files_are_read(void **state)
{
    static const char *const folders[] = {"output4", "pynastran",
                                          "nas2cam_csuper", "public_solvers"};
    char path[PATH_SIZE];
    int files = 0;
    (void)state;

    if (!solvers_find("", path))
        skip();
    for (int k = 0; k < 4; k++) {
        DIR *folder = NULL;
        struct dirent *entry = NULL;

        solvers_find(folders[k], path);
        folder = opendir(path);
        assert_non_null(folder);
        while ((entry = readdir(folder)) != NULL) {
            RITZ_OWN(ritz_matrices) all = {0};
            char file[PATH_SIZE + 300];

            if (!strstr(entry->d_name, ".op4"))
                continue;
            snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
            assert_ok(foreign_read(file, &all));
            for (int64_t m = 0; m < all.count; m++)
                assert_ok(ritz_sparse_check(
                    &all.matrix[m].A,
                    all.matrix[m].A.colptr[all.matrix[m].A.ncol]));
            assert_string_equal(foreign_format, "output4");
            files++;
        }
        closedir(folder);
    }
    assert_true(files >= 74);
}

static void damaged_text_is_answered(void **state)
{
    (void)state;
    for (int k = 0; k < SPELLINGS; k++) {
        int64_t size = (int64_t)strlen(spellings[k]);

        damage_cut(damage_read_matrices, spellings[k], size);
        damage_corrupt(damage_read_matrices, spellings[k], size);
    }
}

/* Every length of the first headers and columns, then some along the file. */
static void cut_often(const char *bytes, int64_t size)
{
    damage_cut(damage_read_matrices, bytes, 600);
    for (int64_t k = 0; k < 200; k++)
        damage_try(damage_read_matrices, bytes, k * (size / 200) + k % 9);
    for (int64_t cut = size - 40; cut < size; cut++)
        damage_try(damage_read_matrices, bytes, cut);
}

/* A word of four bytes becomes one that lengths and places rarely are. */
static void put_odd_words(const char *bytes, int64_t size)
{
    static const uint32_t words[] = {
        0, 1, 0xffffffffU, 0x7fffffffU, 0x80000000U, 65536, 24, 0x01000000U};
    char *damaged = malloc((size_t)size);
    uint64_t seed = 4321;

    for (int k = 0; k < 160; k++) {
        int64_t within = k % 2 ? size : 1000; /* all, or where headers are */
        int64_t place =
            (int64_t)(damage_random(&seed) >> 33) % (within / 4) * 4;

        memcpy(damaged, bytes, (size_t)size);
        memcpy(damaged + place, &words[k % 8], sizeof *words);
        damage_try(damage_read_matrices, damaged, size);
    }
    free(damaged);
}

/* Some whole, and those of public solvers, which are larger: binary of
 * NASTRAN-95, dense and in strings, and of MYSTRAN. */
static void damaged_third_party_files_are_answered(void **state)
{
    static const char *const files[] = {
        "output4/rdbin.op4",
        "output4/cs.op4",
        "output4/csbin.op4",
        "output4/big_bigmat_ascii.op4",
        "output4/big_bigmat_binary.op4",
        "output4/big_dense_binary.op4",
        "output4/single_nonbigmat_le.op4",
        "output4/single_nonbigmat_be_i64.op4",
        "output4/double_bigmat_be.op4.other",
        "output4/double_nonbigmat_ascii.op4.other",
        "output4/double_bigmat_ascii_badname.op4",
        "pynastran/mat_b_s1.op4",
        SOLVERS "nastran95_inboard.op4",
        SOLVERS "nastran95_inboard_dense.op4",
        SOLVERS "nastran95_outboard.op4",
        SOLVERS "mystran_inboard.op4",
        SOLVERS "mystran_outboard_cb.op4",
    };
    char path[PATH_SIZE];
    (void)state;

    if (!solvers_find("", path))
        skip();
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char *bytes = NULL;
        int64_t size = 0;

        solvers_find(files[k], path);
        assert_ok(ritz_bytes_read(path, &size, &bytes));
        if (strstr(files[k], SOLVERS)) {
            cut_often(bytes, size);
            put_odd_words(bytes, size);
        } else {
            damage_cut(damage_read_matrices, bytes, size);
        }
        damage_corrupt(damage_read_matrices, bytes, size);
        free(bytes);
    }
}

static void every_allocation_may_fail(void **state)
{
    const ritz_output4_style style = {.sparse = true};
    const char *path = "output4_alloc.op4";
    static const char form3[] =
        "       1       2       3       4D       1P,2E8.1\n"
        "       1       1       4\n 1.0E+00 2.0E+00\n 1.0E+00 2.0E+00\n"
        "       2       1       1\n 1.0E+00\n";
    char *bytes = NULL;
    int64_t size = 0;
    ritz_matrix m = {0};
    (void)state;

    make(true, true, &m);
    assert_survives_every_allocation(ritz_output4_write(path, 1, &m, &style));
    assert_ok(ritz_bytes_read(path, &size, &bytes));
    assert_survives_every_allocation(damage_read_matrices(bytes, size));
    assert_survives_every_allocation(
        damage_read_matrices(form3, (int64_t)strlen(form3)));
    for (int k = 0; k < SPELLINGS; k++)
        assert_survives_every_allocation(
            damage_read_matrices(spellings[k], (int64_t)strlen(spellings[k])));
    free(bytes);
    ritz_matrix_free(&m);
    remove(path);
}

/* Empty records stand between others in some large files. */
static void records_of_no_bytes_are_skipped(void **state)
{
    const ritz_output4_style style = {0};
    const char *path = "output4_empty.op4";
    ritz_matrices all = {0};
    ritz_matrix m = {0};
    char *bytes = NULL;
    char *spaced = NULL;
    int64_t size = 0;
    (void)state;

    make(false, false, &m);
    assert_ok(ritz_output4_write(path, 1, &m, &style));
    assert_ok(ritz_bytes_read(path, &size, &bytes));
    spaced = calloc((size_t)size + 16, 1);
    memcpy(spaced, bytes, 32); /* the header, then two records of 0 bytes */
    memcpy(spaced + 32 + 16, bytes + 32, (size_t)size - 32);
    assert_ok(foreign_parse(spaced, size + 16, &all));
    assert_same(&m, &all.matrix[0], 0);
    ritz_matrices_free(&all);
    ritz_matrix_free(&m);
    free(spaced);
    free(bytes);
    remove(path);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_spelling_of_text_gives_the_same_matrix),
    cmocka_unit_test(ends_of_lines_make_no_difference),
    cmocka_unit_test(forms_mean_what_nastran_means_by_them),
    cmocka_unit_test(ten_million_null_columns_are_read),
    cmocka_unit_test(what_is_wrong_is_said),
    cmocka_unit_test(what_is_written_is_read_to_the_same_bits),
    cmocka_unit_test(fewer_digits_are_right_to_half_a_unit),
    cmocka_unit_test(what_cannot_be_written_leaves_no_file),
    cmocka_unit_test(records_of_no_bytes_are_skipped),
    cmocka_unit_test(spellings_of_third_party_files_agree),
    cmocka_unit_test(all_third_party_files_are_read),
    cmocka_unit_test(damaged_text_is_answered),
    cmocka_unit_test(damaged_third_party_files_are_answered),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(output4, tests, NULL, NULL)
