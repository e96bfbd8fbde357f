#include "testing.h"

#include "foreign.h"
#include "solvers.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

#define ONE(name, value)                                                       \
    "       1       1       6       2" name "1P,1E9.1\n"                       \
    "       1       1       1\n  " value "E+00\n"                              \
    "       2       1       1\n  1.0E+00\n"

static const char several[] = ONE("KAA     ", "1.0") ONE("MAA     ", "2.0")
    ONE("KAA     ", "3.0") ONE("KAA     ", "4.0");

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

static double select_value(const char *spec)
{
    ritz_matrix m = {0};
    double value = 0.0;

    assert_ok(foreign_select(spec, &m));
    value = m.A.val[0];
    ritz_matrix_free(&m);
    return value;
}

static void a_spec_names_file_matrix_and_turn(void **state)
{
    (void)state;
    put("foreign.op4", several);
    put("foreign_one.op4", ONE("KAA     ", "1.0"));
    assert_true(select_value("foreign.op4:MAA") == 2.0);
    assert_true(select_value("foreign.op4:maa ") == 2.0);
    assert_true(select_value("foreign.op4:KAA#1") == 1.0);
    assert_true(select_value("foreign.op4:KAA#2") == 3.0);
    assert_true(select_value("./foreign.op4:kaa#3") == 4.0);
    assert_true(select_value("foreign_one.op4") == 1.0);
    assert_true(select_value("foreign_one.op4:KAA") == 1.0);
    remove("foreign.op4");
    remove("foreign_one.op4");
}

static void a_file_with_a_colon_is_tried_first(void **state)
{
    (void)state;
    put("foreign.op4:KAA", ONE("X       ", "7.0"));
    put("foreign.op4", several);
    assert_true(select_value("foreign.op4:KAA") == 7.0);
    assert_true(select_value("foreign.op4:KAA:X") == 7.0);
    remove("foreign.op4:KAA");
    remove("foreign.op4");
}

static void an_unclear_spec_lists_what_the_file_holds(void **state)
{
    ritz_matrix m = {0};
    (void)state;

    put("foreign.op4", several);
    assert_fails(foreign_select("foreign.op4", &m), RITZ_ERR_ARGUMENT,
                 "'foreign.op4' holds KAA (3 times), MAA: name one, as "
                 "foreign.op4:KAA#1");
    assert_fails(foreign_select("foreign.op4:KAA", &m), RITZ_ERR_ARGUMENT,
                 "say which, as foreign.op4:KAA#1");
    assert_fails(foreign_select("foreign.op4:KGG", &m), RITZ_ERR_ARGUMENT,
                 "holds no 'KGG', but KAA (3 times), MAA");
    assert_fails(foreign_select("foreign.op4:KAA#4", &m), RITZ_ERR_ARGUMENT,
                 "KAA 3 times, so that #4");
    assert_fails(foreign_select("foreign.op4:KAA#0", &m), RITZ_ERR_ARGUMENT,
                 "holds no 'KAA#0'");
    assert_null(m.A.colptr);
    remove("foreign.op4");
}

static void files_that_are_none_are_refused(void **state)
{
    ritz_matrices all = {0};
    char refusal[512] = "'foreign.txt': holds no matrix in a format that is "
                        "known: ";
    (void)state;

    for (int k = 0; ritz_formats[k]; k++) {
        size_t used = strlen(refusal);

        snprintf(refusal + used, sizeof refusal - used, "%s%s",
                 k > 0 ? ", " : "", ritz_formats[k]->name);
    }
    assert_fails(foreign_read("no_such.op4", &all), RITZ_ERR_FILE,
                 "no_such.op4");
    put("foreign.txt", "hello\n");
    assert_fails(foreign_read("foreign.txt", &all), RITZ_ERR_FORMAT, refusal);
    put("foreign.txt", "");
    assert_fails(foreign_read("foreign.txt", &all), RITZ_ERR_FORMAT,
                 "'foreign.txt': is empty");
    remove("foreign.txt");
}

static void the_file_of_a_spec_is_what_stands_before_the_colon(void **state)
{
    static const char *const cases[][2] = {
        {"a.op4", "a.op4"},
        {"a.op4:K", "a.op4"},
        {"a.op4:K#2", "a.op4"},
        {"dir:x/a.op4", "dir:x/a.op4"},
        {"dir:x/a.op4:K", "dir:x/a.op4"},
        {":K", ":K"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *path = NULL;

        assert_ok(ritz_foreign_path(cases[k][0], &path));
        assert_string_equal(path, cases[k][1]);
        free(path);
    }
}

/* The value of the second matrix is none: its file can still be listed. */
static void a_directory_is_read_without_values(void **state)
{
    static const char text[] =
        ONE("KAA     ", "1.0") ONE("MAA     ", "?.0") ONE("KGG     ", "3.0");
    ritz_foreign file = {0};
    ritz_matrix m = {0};
    (void)state;

    put("foreign.op4", text);
    assert_ok(ritz_foreign_open("foreign.op4", &file));
    assert_ptr_equal(file.format, &ritz_format_output4);
    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, 3);
    assert_string_equal(file.listing.item[2].name, "KGG");
    assert_int_equal(file.listing.item[2].nrow, 1);
    assert_true(file.listing.item[2].symmetric);
    assert_ok(ritz_foreign_take(&file, 2, &m));
    assert_true(m.A.val[0] == 3.0);
    ritz_matrix_free(&m);
    assert_fails(ritz_foreign_take(&file, 1, &m), RITZ_ERR_FORMAT,
                 "line 8: '  ?.0E+00' in column 1 of 'MAA' is not a number");
    ritz_foreign_free(&file);
    remove("foreign.op4");
}

/* Columns with gaps, and one that is null, of a 7 x 5 matrix. */
static void make_matrix(const char *name, double scale, ritz_matrix *out)
{
    static const int64_t start[] = {0, 3, 4, 4, 8, 9};
    static const int64_t row[] = {0, 1, 5, 6, 0, 2, 3, 6, 4};

    *out = (ritz_matrix){.digits = 17};
    snprintf(out->name, sizeof out->name, "%s", name);
    assert_ok(ritz_sparse_new(7, 5, 9, &out->A));
    memcpy(out->A.colptr, start, sizeof start);
    memcpy(out->A.rowind, row, sizeof row);
    for (int k = 0; k < 9; k++)
        out->A.val[k] = scale * (k + 1);
}

static void matrices_are_taken_in_any_order(const ritz_output4_style *style)
{
    static const char *const names[] = {"K", "M", "D"};
    ritz_matrix all[3];
    ritz_foreign file = {0};

    for (int k = 0; k < 3; k++)
        make_matrix(names[k], k + 0.5, &all[k]);
    assert_ok(ritz_output4_write("foreign.op4", 3, all, style));
    assert_ok(ritz_foreign_open("foreign.op4", &file));
    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, 3);
    for (int k = 2; k >= 0; k--) {
        ritz_matrix m = {0};

        assert_string_equal(file.listing.item[k].name, names[k]);
        assert_int_equal(file.listing.item[k].nrow, 7);
        assert_int_equal(file.listing.item[k].ncol, 5);
        assert_ok(ritz_foreign_take(&file, k, &m));
        assert_memory_equal(m.A.colptr, all[k].A.colptr, 6 * sizeof(int64_t));
        assert_memory_equal(m.A.rowind, all[k].A.rowind, 9 * sizeof(int64_t));
        assert_memory_equal(m.A.val, all[k].A.val, 9 * sizeof(double));
        ritz_matrix_free(&m);
        ritz_matrix_free(&all[k]);
    }
    ritz_foreign_free(&file);
    remove("foreign.op4");
}

static void every_spelling_of_output4_has_a_directory(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++)
        matrices_are_taken_in_any_order(&(ritz_output4_style){
            .text = k & 1, .sparse = (k & 2) != 0, .digits = 17});
}

static void files_are_read_once_for_all_that_is_wanted(void **state)
{
    ritz_matrix m[3] = {0};
    const ritz_wanted wanted[] = {{"foreign.op4:KAA#2", "stiffness", &m[0]},
                                  {"foreign_one.op4", "mass", &m[1]},
                                  {"foreign.op4:MAA", "damping", &m[2]}};
    const ritz_wanted wrong = {"foreign.op4:X", "mass", &m[0]};
    char digest[RITZ_DIGEST_SIZE];
    ritz_file_sums sums = {0};
    (void)state;

    put("foreign.op4", several);
    put("foreign_one.op4", ONE("KAA     ", "7.0"));
    assert_ok(ritz_foreign_collect(3, wanted, &sums));
    assert_true(m[0].A.val[0] == 3.0);
    assert_true(m[1].A.val[0] == 7.0);
    assert_true(m[2].A.val[0] == 2.0);
    assert_int_equal(sums.count, 2);
    assert_string_equal(sums.sum[0].path, "foreign.op4");
    assert_string_equal(sums.sum[1].path, "foreign_one.op4");
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_digest_file(sums.sum[k].path, digest));
        assert_string_equal(sums.sum[k].digest, digest);
    }
    ritz_file_sums_free(&sums);
    for (int k = 0; k < 3; k++)
        ritz_matrix_free(&m[k]);
    assert_fails(ritz_foreign_collect(1, &wrong, NULL), RITZ_ERR_ARGUMENT,
                 "mass: 'foreign.op4' holds no 'X'");
    remove("foreign.op4");
    remove("foreign_one.op4");
}

static ritz_status select_and_drop(const char *spec)
{
    ritz_matrix m = {0};
    ritz_status status = foreign_select(spec, &m);

    ritz_matrix_free(&m);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    put("foreign_alloc.op4", several);
    assert_survives_every_allocation(
        select_and_drop("foreign_alloc.op4:KAA#2"));
    remove("foreign_alloc.op4");
}

/* The lists of contracts.md: KAA is there three times. */
static void nas2cam_holds_three_components(void **state)
{
    ritz_matrix m = {0};
    char path[512];
    char spec[520];
    (void)state;

    if (!solvers_find(CSUPER "nas2cam.op4", path))
        skip();
    snprintf(spec, sizeof spec, "%s:KAA#2", path);
    assert_ok(foreign_select(spec, &m));
    assert_int_equal(m.A.ncol, 36);
    ritz_matrix_free(&m);
    spec[strlen(spec) - 2] = '\0';
    assert_fails(foreign_select(spec, &m), RITZ_ERR_ARGUMENT, "KAA (3 times)");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_spec_names_file_matrix_and_turn),
    cmocka_unit_test(a_file_with_a_colon_is_tried_first),
    cmocka_unit_test(an_unclear_spec_lists_what_the_file_holds),
    cmocka_unit_test(files_that_are_none_are_refused),
    cmocka_unit_test(the_file_of_a_spec_is_what_stands_before_the_colon),
    cmocka_unit_test(a_directory_is_read_without_values),
    cmocka_unit_test(every_spelling_of_output4_has_a_directory),
    cmocka_unit_test(files_are_read_once_for_all_that_is_wanted),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(nas2cam_holds_three_components),
};

TEST_MODULE(foreign, tests, NULL, NULL)
