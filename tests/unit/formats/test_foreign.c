#include "testing.h"

#include <ritz/foreign.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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

    assert_ok(ritz_foreign_select(spec, &m));
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
    assert_fails(ritz_foreign_select("foreign.op4", &m), RITZ_ERR_ARGUMENT,
                 "'foreign.op4' holds KAA (3 times), MAA: name one, as "
                 "foreign.op4:KAA#1");
    assert_fails(ritz_foreign_select("foreign.op4:KAA", &m), RITZ_ERR_ARGUMENT,
                 "say which, as foreign.op4:KAA#1");
    assert_fails(ritz_foreign_select("foreign.op4:KGG", &m), RITZ_ERR_ARGUMENT,
                 "holds no 'KGG', but KAA (3 times), MAA");
    assert_fails(ritz_foreign_select("foreign.op4:KAA#4", &m),
                 RITZ_ERR_ARGUMENT, "KAA 3 times, so that #4");
    assert_fails(ritz_foreign_select("foreign.op4:KAA#0", &m),
                 RITZ_ERR_ARGUMENT, "holds no 'KAA#0'");
    assert_null(m.A.colptr);
    remove("foreign.op4");
}

static void files_that_are_none_are_refused(void **state)
{
    ritz_matrices all = {0};
    (void)state;

    assert_fails(ritz_foreign_read("no_such.op4", &all), RITZ_ERR_FILE,
                 "no_such.op4");
    put("foreign.txt", "hello\n");
    assert_fails(ritz_foreign_read("foreign.txt", &all), RITZ_ERR_FORMAT,
                 "'foreign.txt': holds no matrix in a format that is known: "
                 "output4, matrix-market, mat, dmig");
    put("foreign.txt", "");
    assert_fails(ritz_foreign_read("foreign.txt", &all), RITZ_ERR_FORMAT,
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

static ritz_status select_and_drop(const char *spec)
{
    ritz_matrix m = {0};
    ritz_status status = ritz_foreign_select(spec, &m);

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
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    ritz_matrix m = {0};
    char spec[600];
    (void)state;

    if (!folder || access(folder, R_OK) != 0) {
        print_message("skipped: no external data\n");
        skip();
    }
    snprintf(spec, sizeof spec, "%s/nastran/nas2cam_csuper/nas2cam.op4:KAA#2",
             folder);
    assert_ok(ritz_foreign_select(spec, &m));
    assert_int_equal(m.A.ncol, 36);
    ritz_matrix_free(&m);
    spec[strlen(spec) - 2] = '\0';
    assert_fails(ritz_foreign_select(spec, &m), RITZ_ERR_ARGUMENT,
                 "KAA (3 times)");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_spec_names_file_matrix_and_turn),
    cmocka_unit_test(a_file_with_a_colon_is_tried_first),
    cmocka_unit_test(an_unclear_spec_lists_what_the_file_holds),
    cmocka_unit_test(files_that_are_none_are_refused),
    cmocka_unit_test(the_file_of_a_spec_is_what_stands_before_the_colon),
    cmocka_unit_test(every_allocation_may_fail),
    cmocka_unit_test(nas2cam_holds_three_components),
};

TEST_MODULE(foreign, tests, NULL, NULL)
