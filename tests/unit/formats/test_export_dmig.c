/*
 * DMIG that is written: the cards of a small component, digits of a field, what
 * rounding does to a free body, refusals. Files are read back by
 * formats/dmig.c, which does not come from the writer.
 */
#include "testing.h"

#include "bar.h"
#include "damage.h"
#include "folder.h"
#include "foreign.h"
#include "scenes.h"

#include "base/alloc.h"
#include "formats/large_field.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/import.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { ORDER = 3 };

static const double stiffness[] = {4.0, 0.0,  -1.5, 0.0, 1e7,
                                   0.0, -1.5, 0.0,  2.0};
static const double mass[] = {2.0, 0.0, 0.0, 0.0, 1.0, 0.25, 0.0, 0.25, 3.0};

static ritz_status put_values(const double *value, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, out));
    memcpy(out->val, value, ORDER * ORDER * sizeof *value);
    return RITZ_OK;
}

/* The coordinates are grid 12 T3, a mode and grid 11 T1. */
static ritz_status make_small(const double *K, const double *M,
                              ritz_reduced *out)
{
    static const ritz_dof dof[] = {{11, 1}, {12, 1}, {12, 3}};
    static const int64_t row[] = {2, -1, 0};

    RITZ_CHECK(put_values(K, &out->K));
    RITZ_CHECK(put_values(M, &out->M));
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, &out->T));
    RITZ_CHECK(ritz_columns_new(ORDER, &out->columns));
    out->num_dofs = ORDER;
    RITZ_CHECK_COPY(out->dof, dof, ORDER);
    for (int64_t j = 0; j < ORDER; j++) {
        ritz_dense_col(&out->T, j)[row[j] < 0 ? 1 : row[j]] = 1.0;
        out->columns.dof[j] = row[j];
        if (row[j] >= 0)
            out->columns.kind[j] = RITZ_COLUMN_CONSTRAINT;
    }
    return ritz_measures_add(&out->errors, "frequency-relative", 1.25e-3,
                             nan(""), "mode 7, 3.41 Hz");
}

static ritz_status write_to(const ritz_reduced *reduced, const char *path,
                            bool numbered, ritz_export_report *report)
{
    const ritz_export_object object = {.reduced = reduced};
    char name[] = "0123  small.h5";
    char *const input[] = {name};
    const ritz_stamp stamp = {
        .command = "ritz-export small.h5", .num_inputs = 1, .input = input};
    const ritz_export_request request = {
        .output = path, .numbered = numbered, .stamp = &stamp};

    return ritz_exporter_dmig.write(&object, &request, report);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

static void small_component_has_these_cards(void **state)
{
    static const char cards[] =
        "SPOINT      1001\n"
        "DMIG    KAAX           0       6       2       0\n"
        "DMIG*   KAAX                          11               1\n"
        "*                     11               1              2.\n"
        "*                     12               3            -1.5\n"
        "DMIG*   KAAX                          12               3\n"
        "*                     12               3              4.\n"
        "DMIG*   KAAX                        1001               0\n"
        "*                   1001               0       10000000.\n"
        "DMIG    MAAX           0       6       2       0\n"
        "DMIG*   MAAX                          11               1\n"
        "*                     11               1              3.\n"
        "*                   1001               0             .25\n"
        "DMIG*   MAAX                          12               3\n"
        "*                     12               3              2.\n"
        "DMIG*   MAAX                        1001               0\n"
        "*                   1001               0              1.\n";
    static const char *const comments[] = {
        "$ command: ritz-export small.h5\n",
        "$ input: 0123  small.h5\n",
        "$ error, measured: frequency-relative 0.00125, at mode 7, 3.41 Hz\n",
        "$ K is for K2GG = KAAX: 0 of 4 numbers are rounded",
        "$   M2GG = MAAX\n",
    };
    const char *path = folder_path("small.dmig");
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    (void)state;
    assert_ok(make_small(stiffness, mass, &small));
    assert_ok(write_to(&small, path, false, &report));
    assert_ok(ritz_text_read(path, &text));
    assert_non_null(strstr(text, "SPOINT"));
    assert_string_equal(strstr(text, "SPOINT  "), cards);
    for (size_t k = 0; k < sizeof comments / sizeof *comments; k++)
        assert_non_null(strstr(text, comments[k]));
    assert_true(says(&report, "SPOINT 1001 to 1001"));
    assert_true(says(&report, "no motion is rigid"));
}

/* The matrix of that card, with rows ascending: 11 T1, 12 T3, 1001. */
static void read_card(const char *path, const char *card, ritz_matrix *out)
{
    char spec[600];

    snprintf(spec, sizeof spec, "%s:%s", path, card);
    assert_ok(foreign_select(spec, out));
}

/* Relative error of a number in a field of 16 columns, by its size and sign. */
static double bound_of(double x)
{
    const double size = fabs(x);
    double digits = x < 0.0 ? 12.0 : 13.0;

    if (size >= 0.1 && size < 1e14)
        digits += 2.0;
    else if (size < 1e-10 || size >= 1e22)
        digits -= size < 1e-100 || size >= 1e100 ? 2.0 : 1.0;
    return 5.0 * pow(10.0, -digits);
}

static void check_damping(const double *D, const char *words)
{
    static const int64_t place[] = {2, 0, 1}; /* of coordinates 0, 1, 2 */
    const char *path = folder_path("damped.dmig");
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_matrix) m = {0};

    assert_ok(make_small(stiffness, mass, &small));
    assert_ok(put_values(D, &small.D));
    assert_ok(write_to(&small, path, false, &report));
    read_card(path, "BAAX", &m);
    assert_string_equal(m.spelling, "DMIG, form 1");
    assert_true(says(&report, words));
    for (int64_t j = 0; j < ORDER; j++)
        for (int64_t i = 0; i < ORDER; i++) {
            /* 11 T1 is coordinate 2, 12 T3 is 0, the point is 1 */
            const double x = D[place[i] + ORDER * place[j]];

            assert_near(matrix_entry(&m.A, m.A.val, i, j), x,
                        bound_of(x) * fabs(x));
        }
}

static void a_field_keeps_as_many_digits_as_fit(void **state)
{
    static const double third = 1.0 / 3.0;
    const double large[] = {third,        -third,        third * 1e14,
                            -third * 1e5, third * 1e21,  third * 1e60,
                            third * 1e-4, -third * 1e-4, third * 1e-30};
    const double far[] = {third * 1e-200,
                          -third * 1e-200,
                          third * 1e200,
                          1e22,
                          -1e-300,
                          0.1,
                          123456789012345.0,
                          1e-9,
                          -0.75};

    (void)state;
    check_damping(large, "D is for B2PP = BAAX (unsymmetric");
    check_damping(far, "B2PP = BAAX");
}

static void exponents_take_the_room_of_digits(void **state)
{
    static const double third = 1.0 / 3.0;
    static const struct {
        double x;
        const char *plain, *lettered;
    } field[] = {
        {third, ".333333333333333", ".3333333333333D0"},
        {-third * 1e6, "-333333.33333333", "-3.33333333333D5"},
        {third * 1e6, "333333.333333333", "3.333333333333D5"},
        {third * 1e-4, "3.333333333333-5", "3.33333333333D-5"},
        {third * 1e-19, "3.33333333333-20", "3.3333333333D-20"},
        {third * 1e31, "3.33333333333+30", "3.33333333333D30"},
        {-third * 1e-119, "-3.333333333-120", "-3.33333333D-120"},
        {0.0, "0.", "0.D0"},
        {-2.5, "-2.5", "-2.5D0"},
    };
    char text[RITZ_LARGE_FIELD_SIZE];

    (void)state;
    for (size_t k = 0; k < sizeof field / sizeof *field; k++) {
        ritz_large_field_print(field[k].x, text);
        assert_string_equal(text, field[k].plain);
        ritz_large_field_print_double(field[k].x, text);
        assert_string_equal(text, field[k].lettered);
    }
}

static void numbers_with_few_digits_come_back_in_every_bit(void **state)
{
    const double D[] = {1e22,   0.1,   -0.125,           0.1, 1e-9, 2.5e9,
                        -0.125, 2.5e9, 123456789012345.0};
    const char *path = folder_path("exact.dmig");
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_matrix) B = {0};

    (void)state;
    assert_ok(make_small(stiffness, mass, &small));
    assert_ok(put_values(D, &small.D));
    assert_ok(write_to(&small, path, false, &report));
    assert_true(says(&report, "D is for B2GG = BAAX: 0 of 6 numbers"));
    read_card(path, "BAAX", &B);
    assert_string_equal(B.spelling, "DMIG, form 6");
    assert_true(matrix_entry(&B.A, B.A.val, 0, 0) == 123456789012345.0);
    assert_true(matrix_entry(&B.A, B.A.val, 1, 1) == 1e22);
    assert_true(matrix_entry(&B.A, B.A.val, 2, 2) == 1e-9);
    assert_true(matrix_entry(&B.A, B.A.val, 1, 0) == -0.125);
    assert_true(matrix_entry(&B.A, B.A.val, 0, 2) == 2.5e9);
}

/* Free masses 1 on a stiff spring s and a soft one of 1/3. */
static void make_chain(double s, ritz_reduced *out)
{
    static const double ones[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double t = 1.0 / 3.0;
    const double K[] = {s, -s, 0.0, -s, s + t, -t, 0.0, -t, t};

    assert_ok(make_small(K, ones, out));
}

/* Springs of 1e13/3 keep hundredths in 16 columns, as much as the soft spring
   has; springs of 1/3 keep 14 digits. */
static void a_body_that_rounding_holds_is_reported(void **state)
{
    RITZ_OWN(ritz_reduced) even = {0}, stiff = {0};
    RITZ_OWN(ritz_export_report) calm = {0}, report = {0};

    (void)state;
    make_chain(1.0 / 3.0, &even);
    assert_ok(write_to(&even, folder_path("even.dmig"), false, &calm));
    assert_true(says(&calm, "1 rigid motions r"));
    assert_false(says(&calm, "warning"));
    make_chain(1e13 / 3.0, &stiff);
    assert_ok(write_to(&stiff, folder_path("stiff.dmig"), false, &report));
    assert_true(says(&report, "1 rigid motions r"));
    assert_true(says(&report, "warning: the body is no longer free: rounding "
                              "holds 1 of 1 rigid motions"));
}

/* A free bar by craig-bampton, and its frequencies from what was written. */
/* A bar of NASTRAN-95 has no mass about its axis. If it is askew, twelve digits
 * of 2/3 and 4/9 turn a determinant of 0 into one below 0. */
static void a_motion_without_mass_may_gain_some(void **state)
{
    static const double K[] = {4e17, 0.0,     -1.5e17, 0.0, 1e18,
                               0.0,  -1.5e17, 0.0,     2e17};
    static const double M[] = {1e17, 0.0,        2e17 / 3.0, 0.0,       1e17,
                               0.0,  2e17 / 3.0, 0.0,        4e17 / 9.0};
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_small(K, M, &small));
    assert_ok(write_to(&small, folder_path("askew.dmig"), false, &report));
    assert_true(says(&report, "warning: rounded, the mass is not positive "
                              "definite: it has the eigenvalue -"));
    assert_true(says(&report, "no motion is rigid"));
    assert_true(says(&report, "frequencies up to"));
    small.M.val[0] = -1e17;
    assert_fails(write_to(&small, folder_path("askew.dmig"), false, &report),
                 RITZ_ERR_SINGULAR, "modes: mass is not positive definite");
}

static void a_reduced_bar_keeps_its_frequencies(void **state)
{
    const char *path = folder_path("bar.dmig");
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_matrix) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) K_d = {0}, M_d = {0};
    RITZ_OWN(ritz_pairs) before = {0}, after = {0};

    (void)state;
    assert_ok(bar_component(20, &bar));
    assert_ok(add_port(&bar, "left", 1));
    assert_ok(add_port(&bar, "right", 21));
    assert_ok(reduce_with(&bar, &ritz_method_craig_bampton, 6, &reduced));
    snprintf(reduced.damping, sizeof reduced.damping, "modal 0.02");
    assert_ok(write_to(&reduced, path, false, &report));
    assert_true(says(&report, "6 other coordinates are SPOINT 1001 to 1006"));
    assert_true(says(&report, "damping 'modal 0.02' is in D"));
    assert_true(says(&report, "1 rigid motions r"));
    assert_false(says(&report, "warning"));
    read_card(path, "KAAX", &K);
    read_card(path, "MAAX", &M);
    assert_ok(ritz_sparse_dense(&K.A, &K_d));
    assert_ok(ritz_sparse_dense(&M.A, &M_d));
    assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &before));
    assert_ok(ritz_eigen_dense(&K_d, &M_d, &after));
    assert_int_equal(after.num_rigid, 1);
    for (int64_t k = 1; k < 8; k++)
        /* entries are off by 5e-13 of the largest, 1e4, which is a thousand
           times the first eigenvalue */
        assert_near(after.lambda[k], before.lambda[k], 1e-9 * before.lambda[k]);
}

/* Marks, both triangles, and a D in each number [Nastran1986]. */
static void nastran_95_gets_what_it_wants(void **state)
{
    static const char *const column =
        "DMIG*   MAAX                          12               3"
        "                *R000007\n"
        "*R000007              12               3            2.D0\n";
    static const char *const last =
        "DMIG*   MAAX                        1001               0"
        "                *R000008\n"
        "*R000008              11               1           .25D0"
        "                *R000009\n";
    const char *path = folder_path("numbered.dmig");
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_matrix) M = {0};
    RITZ_OWN_ARRAY char *text = NULL;

    (void)state;
    assert_ok(make_small(stiffness, mass, &small));
    assert_ok(write_to(&small, path, true, &report));
    assert_true(says(&report, "M is for M2PP = MAAX (both triangles, IFO 1): "
                              "0 of 5 numbers are rounded"));
    assert_ok(ritz_text_read(path, &text));
    assert_non_null(strstr(text, "\n$   K2PP = KAAX\n"));
    assert_non_null(strstr(text, column));
    assert_non_null(strstr(text, last));
    read_card(path, "MAAX", &M);
    assert_string_equal(M.spelling, "DMIG, form 1");
    assert_true(matrix_entry(&M.A, M.A.val, 0, 2) == 0.25);
    assert_true(matrix_entry(&M.A, M.A.val, 2, 0) == 0.25);
    assert_ok(put_values(stiffness, &small.K4));
    assert_fails(write_to(&small, path, true, &report), RITZ_ERR_ARGUMENT,
                 "NASTRAN-95, for which --numbered is, takes no 'K4'");
}

static void what_dmig_cannot_carry_is_refused(void **state)
{
    const char *path = folder_path("refused.dmig");
    const double K4[] = {1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_small(stiffness, mass, &small));
    assert_ok(put_values(K4, &small.K4));
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "'K4' is not symmetric, and NASTRAN takes no such matrix");
    ritz_dense_free(&small.K4);
    small.M.val[0] = nan("");
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "row 1 of column 1 of 'M' is not finite");
    small.M.val[0] = 2.0;
    small.dof[1].grid = 99999999;
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "grid 99999999 leaves no numbers up to 99999999 for 1");
    small.dof[1].grid = 12;
    ritz_dense_col(&small.T, 1)[0] = 0.5;
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "grid 11 T1 is attached, but no coordinate is its "
                 "displacement");
    small.columns.dof[0] = small.columns.dof[2] = -1;
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "no coordinate is the displacement of a grid");
    ritz_dense_free(&small.T);
    assert_fails(write_to(&small, path, false, &report), RITZ_ERR_ARGUMENT,
                 "it was made --without-basis");
    assert_null(fopen(path, "r"));
}

static void other_formats_number_nothing(void **state)
{
    const ritz_export_request request = {.output = "x", .numbered = true};

    (void)state;
    assert_ok(ritz_export_check(&ritz_exporter_dmig, &request));
    assert_fails(ritz_export_check(&ritz_exporter_tsv, &request),
                 RITZ_ERR_ARGUMENT, "tsv has no continuations to number");
}

static ritz_status write_once(const ritz_reduced *small)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_to(small, folder_path("denied.dmig"), false, &report);
}

static void survives_failing_allocations(void **state)
{
    RITZ_OWN(ritz_reduced) small = {0};

    (void)state;
    assert_ok(make_small(stiffness, mass, &small));
    assert_survives_every_allocation(write_once(&small));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(small_component_has_these_cards),
    cmocka_unit_test(a_field_keeps_as_many_digits_as_fit),
    cmocka_unit_test(exponents_take_the_room_of_digits),
    cmocka_unit_test(numbers_with_few_digits_come_back_in_every_bit),
    cmocka_unit_test(a_body_that_rounding_holds_is_reported),
    cmocka_unit_test(a_motion_without_mass_may_gain_some),
    cmocka_unit_test(a_reduced_bar_keeps_its_frequencies),
    cmocka_unit_test(nastran_95_gets_what_it_wants),
    cmocka_unit_test(what_dmig_cannot_carry_is_refused),
    cmocka_unit_test(other_formats_number_nothing),
    cmocka_unit_test(survives_failing_allocations),
};

TEST_MODULE(export_dmig, tests, folder_make, folder_remove)
