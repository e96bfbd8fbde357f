/* Matrices for Project Chrono, read back by the rules of docs/simulators.md. */
#include "model/interface_form.h"
#include "testing.h"

#include "bodies.h"
#include "folder.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MODES = BODY_MODES };

static int set_up(void **state)
{
    static ritz_reduced reduced;

    *state = &reduced;
    assert_ok(body_with_two_frames(&ritz_method_craig_bampton, &reduced));
    return folder_make(state);
}

static int tear_down(void **state)
{
    ritz_reduced_free(*state);
    return folder_remove(state);
}

static ritz_status write_load(const ritz_reduced *reduced, const char *ports,
                              const char *path, ritz_export_report *report)
{
    const ritz_export_request request = {.output = path, .ports = ports};

    return ritz_exporter_chrono.write(&(ritz_export_object){.reduced = reduced},
                                      &request, report);
}

/* The next word; '#' begins a comment that ends with its line. */
static const char *next_word(FILE *file)
{
    static char word[64];

    while (fscanf(file, "%63s", word) == 1) {
        if (word[0] != '#')
            return word;
        (void)fscanf(file, "%*[^\n]");
    }
    return "";
}

static double next_number(FILE *file)
{
    char *end = NULL;
    const char *word = next_word(file);
    const double value = strtod(word, &end);

    assert_true(end != word && *end == '\0');
    return value;
}

static void assert_word(FILE *file, const char *word)
{
    assert_string_equal(next_word(file), word);
}

static void assert_matrix(FILE *file, const char *name, const ritz_dense *A,
                          int64_t order)
{
    assert_word(file, name);
    for (int64_t i = 0; i < order; i++)
        for (int64_t j = 0; j < order; j++)
            assert_true(next_number(file) ==
                        (A->val ? ritz_dense_col(A, j)[i] : 0.0));
}

static void matrices_have_all_bits(void **state)
{
    const double place[2][4] = {{1, 0, 0, 0}, {3, 1, 1, 0.5}};
    const ritz_reduced *reduced = *state;
    const char *path = folder_path("load.txt");
    RITZ_OWN(ritz_export_report) report = {0};
    FILE *file = NULL;

    assert_ok(write_load(reduced, NULL, path, &report));
    file = fopen(path, "r");
    assert_non_null(file);
    assert_word(file, "frames");
    assert_true(next_number(file) == 2.0);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 4; i++)
            assert_true(next_number(file) == place[k][i]);
    assert_word(file, "modes");
    assert_true(next_number(file) == (double)MODES);
    for (int64_t k = 0; k < MODES; k++)
        assert_near(next_number(file), reduced->columns.hertz[12 + k],
                    1e-11 * reduced->columns.hertz[12 + MODES - 1]);
    /* constraint modes are the motions of both grids already */
    assert_matrix(file, "M", &reduced->M, 12 + MODES);
    assert_matrix(file, "K", &reduced->K, 12 + MODES);
    assert_matrix(file, "D", &reduced->D, 12 + MODES);
    assert_word(file, "");
    assert_int_equal(fclose(file), 0);
    assert_non_null(strstr(report.line[0], "2 interface frames and 4 modes"));
}

static void a_port_that_is_not_there_is_refused(void **state)
{
    const char *path = folder_path("none.txt");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_load(*state, "g9", path, &report), RITZ_ERR_ARGUMENT,
                 "there is no port 'g9'");
    assert_int_equal(access(path, F_OK), -1);
}

static ritz_status write_once(const ritz_reduced *reduced, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_load(reduced, NULL, path, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("load.txt")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(matrices_have_all_bits),
    cmocka_unit_test(a_port_that_is_not_there_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(chrono, tests, set_up, tear_down)
