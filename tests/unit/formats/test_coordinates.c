/* Lines "row column value" without a header, of CalculiX and Abaqus. */
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

/* A 3 x 3 matrix by columns, and what the file says of it. */
static void assert_holds(const char *text, const double *value, bool symmetric)
{
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;
    int64_t nnz = 0;

    assert_ok(parse(text, &all));
    assert_string_equal(foreign_format, "coordinates");
    assert_int_equal(all.count, 1);
    m = &all.matrix[0];
    assert_int_equal(m->A.nrow, 3);
    assert_int_equal(m->A.ncol, 3);
    assert_int_equal(m->symmetric, symmetric);
    assert_string_equal(m->spelling,
                        symmetric ? "coordinates without a header, one triangle"
                                  : "coordinates without a header, both "
                                    "triangles");
    assert_null(m->imaginary);
    assert_null(m->row);
    assert_ok(ritz_sparse_check(&m->A, m->A.colptr[3]));
    for (int e = 0; e < 9; e++) {
        assert_true(matrix_entry(&m->A, m->A.val, e % 3, e / 3) == value[e]);
        nnz += value[e] != 0.0;
    }
    assert_int_equal(m->A.colptr[3], nnz);
}

static void one_triangle_is_completed(void **)
{
    static const double full[] = {8.5, -2, 0, -2, 1.25, 4, 0, 4, 300};

    assert_holds("1 1  8.5e+00\n1 2 -2.0e+00\n2 2  1.25e+00\n"
                 "1 3  0.0e+00\n2 3  4.0e+00\n3 3  3.0e+02\n",
                 full, true);
    assert_holds("1 1 8.5\n2 1 -2.\n2 2 1.25\n3 2 4.\n3 3 300.\n", full, true);
    /* each pair once, whichever triangle it is in */
    assert_holds("1 1 8.5\n1 2 -2.\n2 2 1.25\n3 2 4.\n3 3 300.\n", full, true);
    /* in any order, with blank lines, Fortran's exponents and other ends */
    assert_holds("\n  3 3 3.D+2\r\n1 1  8.5 \r\n\r\n2 3\t4\n2 2 1.25\n1 2 -2.0",
                 full, true);
}

static void both_triangles_are_taken_as_they_stand(void **)
{
    static const double symmetric[] = {8.5, -2, 0, -2, 1.25, 4, 0, 4, 300};
    static const double other[] = {1, 2, 0, -2, 3, 0, 0, 0, 5};
    static const double half[] = {1, 0, 0, 7, 1, 0, 0, 0, 1};

    assert_holds("1 1 8.5\n1 2 -2.\n2 1 -2.\n2 2 1.25\n2 3 4.\n3 2 4.\n"
                 "3 3 300.\n",
                 symmetric, false);
    assert_holds("1 1 1.\n2 1 2.\n1 2 -2.\n2 2 3.\n3 3 5.\n", other, false);
    /* a zero shows that the file has entries on both sides */
    assert_holds("1 1 1.\n2 1 0.\n1 2 7.\n2 2 1.\n3 3 1.\n", half, false);
    /* a zero needs no counterpart */
    assert_holds("1 1 1.\n2 1 0.\n1 2 7.\n1 3 0.\n2 2 1.\n3 3 1.\n", half,
                 false);
}

static void the_order_is_the_largest_row_or_column(void **)
{
    static const double diagonal[] = {2.5, 0, 0, 0, 0, 0, 0, 0, 1};
    static const double corner[] = {2.5, 0, 0, 0, 0, 0, 0, 0, 0};
    static const double wide[] = {2.5, 0, 4, 0, 0, 0, 4, 0, 0};

    assert_holds("1 1 2.5\n3 3 1.\n", diagonal, true);
    assert_holds("1 1 2.5\n3 3 0.\n", corner, true);
    assert_holds("1 1 2.5\n1 3 4.\n", wide, true);
    assert_holds("1 1 2.5\n3 1 4.\n", wide, true);
}

static void digits_are_those_of_the_longest_number(void **)
{
    RITZ_OWN(ritz_matrices) all = {0};

    assert_ok(parse("1 1  8.1311303948298E+08\n1 2  2.15E+02\n", &all));
    assert_int_equal(all.matrix[0].digits, 14);
}

static void sizes_are_known_when_values_are_read(void **)
{
    static const char text[] = "1 1 2.5\n";
    RITZ_OWN(ritz_foreign)
    file = {.bytes = text,
            .size = sizeof text - 1,
            .format = &ritz_format_coordinates};

    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, 1);
    assert_int_equal(file.listing.item[0].nrow, -1);
    assert_int_equal(file.listing.item[0].ncol, -1);
}

static void what_is_wrong_is_said_with_its_line(void **)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"1 1 2.5\n1 2 \n",
         "line 2: '1 2 ' is not an entry 'row column value'"},
        {"1 1 2.5\n\n2\n", "line 3: '2' is not an entry 'row column value'"},
        {"1 1 2.5\n% c\n", "line 2: '% c' is not an entry"},
        {"1 1 2.5\n1.5 1 1\n", "line 2: '1.5 1 1' is not an entry"},
        {"1 1 2.5\n1,1,1\n", "line 2: '1,1,1' is not an entry"},
        {"1 1 2.5\n2 2 x\n", "line 2: 'x' is not a number"},
        {"1 1 2.5\n2 2 1.5E\n", "line 2: '1.5E' is not a number"},
        {"1 1 2.5\n2 2 nan\n", "line 2: the value is not finite"},
        {"1 1 2.5\n2 2 1e999\n", "line 2: the value is not finite"},
        {"1 1 2.5\n2 2 1. 0.\n", "line 2: more than an entry on the line"},
        {"1 1 2.5\n0 2 1.\n", "line 2: entry (0, 2) is none: rows and columns "
                              "are counted from 1"},
        {"1 1 2.5\n2 -3 1.\n", "line 2: entry (2, -3) is none"},
        {"1 1 2.5\n1 2 1.\n1 2 1.\n", "entry (1, 2) is given twice"},
        {"1 1 2.5\n1 1 2.5\n", "entry (1, 1) is given twice"},
        {"1 1 2.5\n1 2 1.\n2 1 1.\n1 2 1.\n", "entry (1, 2) is given twice"},
        {"1 1 1.\n1 2 1.\n2 1 1.\n1 3 1e-9\n3 3 1.\n",
         "entry (1, 3) has no counterpart across the diagonal, but others "
         "have: it may be zero there, or equal"},
        {"1 1 1.\n1 2 1.\n3 1 1.\n1 3 1.\n", "entry (1, 2) has no counter"},
        {"1 1 2.5\n1 99999999 1.\n",
         "99999999 x 99999999 is far more than the file can fill"},
        {"2000000 1 2.5\n", "2000000 x 2000000 is far more than the file"},
        {"999999999999999999 1 2.5\n", "is far more than the file can fill"},
        {"1 1 2.5\n9999999999999999999 1 2.5\n", "line 2: "},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(read_text(cases[k].text), RITZ_ERR_FORMAT, cases[k].words);
}

/* The first line decides; what follows it is refused by its line. */
static void other_texts_are_not_taken_for_entries(void **)
{
    static const char *const texts[] = {
        "",
        "\n \n",
        "345 345 7002\n1 1 1.6e8\n", /* Matrix Market without its banner */
        "1 1\n1 2\n",
        "1.1\n1.2\n",
        "1 1 1\n",
        "0 1 1.5\n",
        "1 -1 1.5\n",
        "1 1 1.5 2.5\n",
        "1 1 1.5x\n",
        "1 1 nan\n",
        "1,1, 1,1, 1.5\n",
        "1 1. 1.5\n",
        "GRID 1 1.5\n",
        "# 1 1 1.5\n",
        "       2       2       2       2KGG     1P,3E23.16\n",
        "       2       2       2       2\n",
        "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2.0\n",
        "DMIG,KAAX,0,6,2,0\n",
    };

    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        if (ritz_format_coordinates.recognise(texts[k],
                                              (int64_t)strlen(texts[k])))
            fail_msg("'%s' is taken for coordinates", texts[k]);
}

static void entries_are_taken_for_no_other_format(void **)
{
    static const char *const texts[] = {
        "1 1  8.1311303948298e+08\n1 2  2.1569522598386e+02\n",
        "1 1  3.582994033916093e+10\n1 2  7.850217128178634e+09\n",
        "       1       1  3.5829940339160931E+10\n",
        "       2       2  3.5829940339160931E+10                 \n",
    };

    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        for (int f = 0; ritz_formats[f]; f++)
            if (ritz_formats[f]->recognise(texts[k],
                                           (int64_t)strlen(texts[k]))) {
                assert_string_equal(ritz_formats[f]->name, "coordinates");
                break;
            }
}

/* Values are those of the first lines of the files; entries that are zero are
 * left out. */
static void third_party_files_are_read(void **)
{
    static const struct {
        const char *file;
        int64_t n, digits;
        bool symmetric;
        double first, next; /* A(1,1) and A(1,2) */
    } cases[] = {
        {"calculix/conrod/conrod.sti", 2805, 14, true, 8.1311303948298e+08,
         2.1569522598386e+02},
        {"calculix/conrod/conrod.mas", 2805, 14, true, 1.8627205918600e-05, 0},
        {"abaqus/blockC3D4_STIF1.mtx", 642, 16, false, 3.582994033916093e+10,
         7.850217128178634e+09},
        {"abaqus/blockC3D4_MASS1.mtx", 642, 16, true, 1.391143153750872e+01, 0},
        {"abaqus/blockC3D10_STIF1.mtx", 771, 16, false, 3.261947364090431e+10,
         7.033983115384632e+09},
        {"abaqus/blockC3D10_MASS1.mtx", 771, 16, false, 4.362318308134916e+00,
         0},
    };
    const char *folder = getenv("RITZ_EXTERNAL_DATA");

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
        assert_string_equal(foreign_format, "coordinates");
        m = &all.matrix[0];
        assert_int_equal(m->A.nrow, cases[k].n);
        assert_int_equal(m->A.ncol, cases[k].n);
        assert_int_equal(m->digits, cases[k].digits);
        assert_int_equal(m->symmetric, cases[k].symmetric);
        assert_true(ritz_sparse_asymmetry(&m->A) == 0.0);
        assert_true(matrix_entry(&m->A, m->A.val, 0, 0) == cases[k].first);
        assert_true(matrix_entry(&m->A, m->A.val, 0, 1) == cases[k].next);
        assert_true(matrix_entry(&m->A, m->A.val, 1, 0) == cases[k].next);
    }
}

static const char *const samples[] = {
    "1 1  8.13e+08\n1 2  2.15e+02\n2 2  1.2e+09\n1 3  0.0e+00\n3 3 -6.14e+08\n",
    "1 1  3.5e+10\r\n1 2 -7.8e+09\r\n2 1 -7.8e+09\r\n\r\n2 2  3.5e+10",
    "3 3 1.5D+3\n1 1 .5\n\n2 2\t-1.\n",
};

static void damaged_files_are_answered(void **)
{
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
        int64_t size = (int64_t)strlen(samples[k]);

        damage_cut(damage_read_matrices, samples[k], size);
        damage_corrupt(damage_read_matrices, samples[k], size);
    }
}

static void every_allocation_may_fail(void **)
{
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++)
        assert_survives_every_allocation(read_text(samples[k]));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_triangle_is_completed),
    cmocka_unit_test(both_triangles_are_taken_as_they_stand),
    cmocka_unit_test(the_order_is_the_largest_row_or_column),
    cmocka_unit_test(digits_are_those_of_the_longest_number),
    cmocka_unit_test(sizes_are_known_when_values_are_read),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(other_texts_are_not_taken_for_entries),
    cmocka_unit_test(entries_are_taken_for_no_other_format),
    cmocka_unit_test(third_party_files_are_read),
    cmocka_unit_test(damaged_files_are_answered),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(coordinates, tests, NULL, NULL)
