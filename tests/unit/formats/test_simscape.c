/* Flexible solids for Simscape Multibody, read back by Ritz's own reader of MAT
 * files, which knows nothing of the writer. */
#include "model/interface_form.h"
#include "testing.h"

#include "bodies.h"
#include "folder.h"
#include "foreign.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int set_up(void **state)
{
    static ritz_reduced reduced;

    *state = &reduced;
    assert_ok(body_with_two_frames(&ritz_method_macneal_rubin, &reduced));
    snprintf(reduced.damping, sizeof reduced.damping, "modal 0.01");
    return folder_make(state);
}

static int tear_down(void **state)
{
    ritz_reduced_free(*state);
    return folder_remove(state);
}

static ritz_status write_solid(const ritz_reduced *reduced, const char *ports,
                               const char *path, ritz_export_report *report)
{
    const ritz_export_request request = {.output = path, .ports = ports};

    return ritz_exporter_simscape.write(
        &(ritz_export_object){.reduced = reduced}, &request, report);
}

static void assert_same(const ritz_matrices *list, const char *name,
                        const ritz_dense *A)
{
    for (int64_t k = 0; k < list->count; k++) {
        RITZ_OWN(ritz_dense) found = {0};

        if (strcmp(list->matrix[k].name, name) != 0)
            continue;
        assert_ok(ritz_sparse_dense(&list->matrix[k].A, &found));
        assert_int_equal(found.nrow, A->nrow);
        assert_int_equal(found.ncol, A->ncol);
        for (int64_t e = 0; e < A->nrow * A->ncol; e++)
            assert_true(found.val[e] == A->val[e]);
        return;
    }
    fail_msg("there is no %s", name);
}

static void a_solid_has_frames_and_matrices(void **state)
{
    double origin[6] = {0, 1, 0, 1, 0, 0.5}; /* by columns */
    double turn[8] = {1, 1};
    const ritz_dense P = {2, 3, origin}, Q = {2, 4, turn};
    const ritz_reduced *reduced = *state;
    const char *path = folder_path("solid.mat");
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_interface_form) form = {0};
    RITZ_OWN(ritz_matrices) list = {0};

    assert_ok(write_solid(reduced, "g1,g3", path, &report));
    assert_ok(foreign_read(path, &list));
    assert_ok(ritz_interface_form_of(reduced, "g1,g3", &form));
    assert_non_null(form.D.val);
    assert_same(&list, "K", &form.K);
    assert_same(&list, "M", &form.M);
    assert_same(&list, "C", &form.D);
    assert_same(&list, "P", &P);
    assert_same(&list, "Q", &Q);
    assert_non_null(strstr(report.line[0], "2 interface frames and "));
    assert_non_null(strstr(report.line[2], "frame 2: port g3 grid 3 at 1 1 "
                                           "0.5"));
}

static void a_body_without_ports_is_refused(void **state)
{
    const char *path = folder_path("none.mat");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_solid(*state, "g9", path, &report), RITZ_ERR_ARGUMENT,
                 "there is no port 'g9'");
    assert_int_equal(access(path, F_OK), -1);
}

static ritz_status write_once(const ritz_reduced *reduced, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_solid(reduced, NULL, path, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("solid.mat")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_solid_has_frames_and_matrices),
    cmocka_unit_test(a_body_without_ports_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(simscape, tests, set_up, tear_down)
