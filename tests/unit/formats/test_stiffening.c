/*
 * Geometric stiffness in exported files: frequencies of a turning cantilever
 * from Standard Input Data agree with those of an independent program; forces
 * on a node; matrices by name; formats without a place for it.
 */
#include "testing.h"

#include "base/alloc.h"
#include "column.h"
#include "folder.h"
#include "formats/sid.h"
#include "sid_file.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { ELEMENTS = 12, COLUMN_MODES = 12 };

static int set_up(void **state)
{
    static ritz_reduced reduced;
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    reduced = (ritz_reduced){0};
    *state = &reduced;
    assert_ok(column_component(ELEMENTS, COLUMN_CLAMPED_FREE, &c));
    request.component = &c;
    request.modes = COLUMN_MODES;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_ok(ritz_reduce(&c, &basis, &reduced));
    return folder_make(state);
}

static int tear_down(void **state)
{
    ritz_reduced_free(*state);
    return folder_remove(state);
}

static ritz_status write_as(const ritz_exporter *exporter,
                            const ritz_reduced *reduced,
                            ritz_export_request request, const char *name,
                            ritz_export_report *report)
{
    const ritz_export_object object = {.reduced = reduced};

    request.output = folder_path(name);
    return ritz_export_write(exporter, &object, &request, report);
}

static void write_sid(const ritz_reduced *reduced, const char *stiffening,
                      sid_file *out)
{
    RITZ_OWN(ritz_export_report) report = {0};

    assert_ok(write_as(&ritz_exporter_sid, reduced,
                       (ritz_export_request){.stiffening = stiffening},
                       "column.SID_FEM", &report));
    sid_file_read(folder_path("column.SID_FEM"), out);
}

/* Lowest frequency of Ke + w^2 Oe_zz for modes of unit mass: the frame turns at
   a constant rate, and gyroscopic terms are left out. */
static double turning(const sid_file *f, double rate)
{
    const int64_t m = f->num_modes;
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_dense_new(m, m, &K));
    assert_ok(ritz_dense_identity(m, &M));
    for (int64_t k = 0; k < m; k++)
        for (int64_t l = 0; l < m; l++)
            ritz_dense_col(&K, k)[l] =
                sid_m0(&f->of[SID_KE], l, k) +
                rate * rate * sid_m1(&f->of[SID_OE], l, k, 2);
    ritz_dense_symmetrise(&K);
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    return copysign(sqrt(fabs(pairs.lambda[0])), pairs.lambda[0]);
}

/* Lead-lag of the rotating cantilever in units of sqrt(E I / rho A L^4), by 12
   Hermite elements: 3.6217988, 3.8977298, 5.0492158 at rates 2, 4 and 10. The
   products of a beam without cells are approximated: 1.3e-3 is measured. */
static void a_turning_cantilever_is_as_stiff_as_tension_makes_it(void **state)
{
    static const double rates[][2] = {{0.0, 3.5160167},
                                      {2.0, 3.6217988},
                                      {4.0, 3.8977298},
                                      {10.0, 5.0492158}};
    RITZ_OWN(sid_file) f = {0};

    write_sid(*state, "spin_zz", &f);
    assert_non_null(strstr(f.comment, "with geometric stiffening"));
    assert_int_equal(f.of[SID_OE].order, 1);
    for (size_t k = 0; k < sizeof rates / sizeof *rates; k++)
        assert_near(turning(&f, rates[k][0]) / rates[k][1], 1.0, 2e-3);
}

/* sqrt(3.5160167^2 - 4^2) is imaginary: -3.64 is its square. */
static void without_stiffening_the_cantilever_diverges(void **state)
{
    RITZ_OWN(sid_file) f = {0};
    double w = 0.0;

    write_sid(*state, NULL, &f);
    assert_non_null(strstr(f.comment, "no geometric stiffening"));
    w = turning(&f, 4.0);
    assert_near(w * fabs(w), -3.64, 0.02);
}

/* The generalised force of f on a node is (phi + m1 q)'f: a push of half the
   buckling load leaves half of the softest stiffness against it. */
static double softened(const sid_file *f, double push)
{
    const int64_t m = f->num_modes, tip = f->num_nodes - 1;
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_dense_new(m, m, &K));
    assert_ok(ritz_dense_identity(m, &M));
    for (int64_t k = 0; k < m; k++)
        for (int64_t l = 0; l < m; l++)
            ritz_dense_col(&K, k)[l] =
                sid_m0(&f->of[SID_KE], l, k) -
                push * sid_m1(&f->node[tip].at[SID_PHI], 0, k, l);
    ritz_dense_symmetrise(&K);
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    return pairs.lambda[0];
}

static void a_force_on_a_node_buckles_the_body_of_the_file(void **state)
{
    RITZ_OWN(sid_file) f = {0};

    /* "tip" pushes along -x, so that per force along x it pulls */
    write_sid(*state, "force_x@13=pull", &f);
    assert_int_equal(f.node[f.num_nodes - 1].at[SID_PHI].order, 1);
    assert_int_equal(f.node[0].at[SID_PHI].order, 0);
    assert_true(softened(&f, -2.467) > 0.0);
    /* of 12 modes the load is higher by 2e-5, measured */
    assert_true(softened(&f, -2.469) < 0.0);
    assert_true(softened(&f, 5.0) > softened(&f, 0.0));
}

/* Terms of acceleration, angular acceleration and products of rates are in Ct,
   Cr and Oe. */
static void accelerations_are_in_their_terms(void **state)
{
    RITZ_OWN(sid_file) bare = {0}, f = {0};

    write_sid(*state, NULL, &bare);
    write_sid(*state, "accel_x=pull,turn_z=both,spin_xy=tip", &f);
    assert_int_equal(bare.of[SID_CT].order, 0);
    assert_int_equal(f.of[SID_CT].order, 1);
    for (int64_t k = 0; k < f.num_modes; k++)
        for (int64_t l = 0; l < f.num_modes; l++) {
            const double pull = sid_m1(&f.of[SID_CT], l, k, 0);
            const double push = sid_m1(&f.of[SID_OE], l, k, 3) -
                                sid_m1(&bare.of[SID_OE], l, k, 3);

            assert_true(sid_m1(&f.of[SID_CT], l, k, 1) == 0.0);
            assert_near(push, -pull, 1e-9 * (1.0 + fabs(pull)));
            assert_true(sid_m1(&f.of[SID_CR], l, k, 0) ==
                        sid_m1(&bare.of[SID_CR], l, k, 0));
        }
    assert_true(fabs(sid_m1(&f.of[SID_CR], 0, 0, 2) -
                     sid_m1(&bare.of[SID_CR], 0, 0, 2)) > 0.1);
}

/* ---- matrices by name --------------------------------------------------- */

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

static void matrices_are_written_by_their_names(void **state)
{
    const ritz_reduced *reduced = *state;
    RITZ_OWN(ritz_export_report) all = {0}, one = {0}, mat = {0};

    assert_ok(write_as(&ritz_exporter_matrix_market, reduced,
                       (ritz_export_request){0}, "all-%.mtx", &all));
    assert_true(says(&all, "KG1  12 x 12, KG of load 'tip'"));
    assert_true(says(&all, "KG4  12 x 12, KG of load 'both'"));
    assert_int_equal(access(folder_path("all-KG4.mtx"), R_OK), 0);
    assert_ok(write_as(&ritz_exporter_output4, reduced,
                       (ritz_export_request){.matrices = "K,KG:spin_zz"},
                       "one.op4", &one));
    assert_true(says(&one, "KG3  12 x 12, KG of load 'spin_zz'"));
    assert_false(says(&one, "KG1"));
    assert_ok(write_as(&ritz_exporter_matlab, reduced,
                       (ritz_export_request){.matrices = "KG"}, "column.mat",
                       &mat));
    assert_true(says(&mat, "KG2  12 x 12, KG of load 'pull'"));
    assert_false(says(&mat, "is left out: matlab"));
}

static void matrices_that_are_not_there_are_refused(void **state)
{
    static const char *const names[][2] = {
        {"KG:wind", "this reduced component has no 'KG:wind'"},
        {"KG:", "there is no matrix 'KG:'"},
        {"KG:tip,KG", "'KG1' is named twice"},
        {"KGtip", "there is no matrix 'KGtip'"},
    };
    ritz_reduced bare = *(const ritz_reduced *)*state; /* borrowed */
    RITZ_OWN(ritz_export_report) report = {0};

    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        assert_fails(write_as(&ritz_exporter_output4, *state,
                              (ritz_export_request){.matrices = names[k][0]},
                              "no.op4", &report),
                     RITZ_ERR_ARGUMENT, names[k][1]);
    bare.num_loads = 0;
    assert_fails(write_as(&ritz_exporter_output4, &bare,
                          (ritz_export_request){.matrices = "KG"}, "no.op4",
                          &report),
                 RITZ_ERR_ARGUMENT, "this reduced component has no 'KG'");
}

static ritz_status write_all(const ritz_reduced *reduced)
{
    RITZ_OWN(ritz_export_report) sid = {0}, market = {0};

    RITZ_CHECK(
        write_as(&ritz_exporter_sid, reduced,
                 (ritz_export_request){.stiffening = "spin_zz,accel_x=tip,"
                                                     "moment_y@13=both"},
                 "a.SID_FEM", &sid));
    return write_as(&ritz_exporter_matrix_market, reduced,
                    (ritz_export_request){.matrices = "KG"}, "a-%.mtx",
                    &market);
}

static void stiffening_survives_every_allocation(void **state)
{
    assert_survives_every_allocation(write_all(*state));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_turning_cantilever_is_as_stiff_as_tension_makes_it),
    cmocka_unit_test(without_stiffening_the_cantilever_diverges),
    cmocka_unit_test(a_force_on_a_node_buckles_the_body_of_the_file),
    cmocka_unit_test(accelerations_are_in_their_terms),
    cmocka_unit_test(matrices_are_written_by_their_names),
    cmocka_unit_test(matrices_that_are_not_there_are_refused),
    cmocka_unit_test(stiffening_survives_every_allocation),
};

TEST_MODULE(stiffening, tests, set_up, tear_down)
