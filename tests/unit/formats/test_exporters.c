/*
 * What all exporters say of a body that has more than their formats take: rows
 * to recover, and matrices that no one asked for.
 */
#include "testing.h"

#include "folder.h"
#include "moving_body.h"

#include <stdio.h>
#include <string.h>

/* The body with two quantities, of which only the names are used. */
static ritz_reduced with_rows(const moving_body *of)
{
    static ritz_quantity rows[] = {{.name = "stress"}, {.name = "drift"}};
    ritz_reduced reduced = of->reduced;

    reduced.num_quantities = 2;
    reduced.quantity = rows;
    return reduced;
}

static ritz_status export_to(const ritz_exporter *exporter,
                             const ritz_reduced *reduced, const char *matrices,
                             ritz_export_report *report)
{
    char name[RITZ_NAME_SIZE];
    const ritz_export_object object = {.reduced = reduced};
    ritz_export_request request = {.matrices = matrices};

    snprintf(name, sizeof name, "%s-%%.out", exporter->name);
    request.output = folder_path(name);
    return ritz_export_write(exporter, &object, &request, report);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

static void rows_to_recover_that_are_left_out_are_named(void **state)
{
    static const ritz_exporter *const bodies[] = {
        &ritz_exporter_42,     &ritz_exporter_chrono,   &ritz_exporter_dmig,
        &ritz_exporter_exudyn, &ritz_exporter_fxbody,   &ritz_exporter_mbdyn,
        &ritz_exporter_sid,    &ritz_exporter_simscape, NULL};
    const moving_body *of = *state;
    const ritz_reduced reduced = with_rows(of);

    for (size_t k = 0; bodies[k]; k++) {
        RITZ_OWN(ritz_export_report) report = {0}, without = {0};

        assert_ok(export_to(bodies[k], &reduced, NULL, &report));
        if (!says(&report, "rows to recover are left out, ritz-recover has "
                           "them: stress, drift"))
            fail_msg("%s says nothing of its rows", bodies[k]->name);
        assert_ok(export_to(bodies[k], &of->reduced, NULL, &without));
        assert_false(says(&without, "rows to recover"));
    }
}

static void matrices_that_are_left_out_are_named(void **state)
{
    const ritz_reduced reduced = with_rows(*state);
    RITZ_OWN(ritz_export_report) all = {0}, asked = {0}, binary = {0};

    assert_ok(export_to(&ritz_exporter_matrix_market, &reduced, NULL, &all));
    assert_true(says(&all, "left out, --matrix names them: T stress drift"));
    assert_false(says(&all, "rows to recover"));
    assert_ok(export_to(&ritz_exporter_matrix_market, &reduced, "K", &asked));
    assert_false(says(&asked, "left out"));
    assert_ok(export_to(&ritz_exporter_output4, &reduced, NULL, &binary));
    assert_true(says(&binary, "left out, --matrix names them: T stress drift"));
    assert_true(says(&binary, "numbers keep every bit"));
    assert_true(says(&binary, "no place for names, inertia and the cert"));
}

/* A report has room for the names of many quantities, but not for all. */
static void long_lists_of_rows_are_cut(void **state)
{
    static ritz_quantity rows[40];
    ritz_reduced reduced = with_rows(*state);
    RITZ_OWN(ritz_export_report) report = {0};

    for (int k = 0; k < 40; k++)
        snprintf(rows[k].name, sizeof rows[k].name, "quantity number %d", k);
    reduced.quantity = rows;
    reduced.num_quantities = 40;
    assert_ok(export_to(&ritz_exporter_chrono, &reduced, NULL, &report));
    assert_true(says(&report, "them: quantity number 0, quantity number 1,"));
    assert_ok(export_to(&ritz_exporter_output4, &reduced, NULL, &report));
    assert_true(says(&report, "them: T quantity number 0 quantity"));
}

static ritz_status write_once(const ritz_reduced *reduced)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return export_to(&ritz_exporter_chrono, reduced, NULL, &report);
}

static void every_allocation_may_fail(void **state)
{
    const ritz_reduced reduced = with_rows(*state);

    assert_survives_every_allocation(write_once(&reduced));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_to_recover_that_are_left_out_are_named),
    cmocka_unit_test(matrices_that_are_left_out_are_named),
    cmocka_unit_test(long_lists_of_rows_are_cut),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(exporters, tests, moving_body_set_up, moving_body_tear_down)
