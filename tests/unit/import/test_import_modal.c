/* Components in modal form: frequencies, ratios, B and C, and no geometry. */
#include "testing.h"

#include "folder.h"
#include "matrices.h"
#include "responses.h"

#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>

#define ARRAY "%%MatrixMarket matrix array real general\n"

static double two_pi(void)
{
    return 2.0 * acos(-1.0);
}

/* Three modes, the first of them rigid. */
static void modes_are_scalar_points_of_unit_mass(void **)
{
    const ritz_import_request request = {
        .frequencies = folder_write("f.mtx", ARRAY "3 1\n0\n2\n5\n"),
        .ratios = folder_write("z.mtx", ARRAY "1 3\n0\n0.01\n0.5\n"),
        .input_matrix = folder_write("b.mtx", ARRAY "3 1\n1\n2\n3\n"),
        .output_matrix = folder_write("c.mtx", ARRAY "2 3\n1\n2\n3\n4\n5\n6\n"),
        .input_names = "force",
        .units = "kg m s"};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(report.map, "modes");
    assert_string_equal(c.units, "kg m s");
    assert_int_equal(c.num_dofs, 3);
    assert_int_equal(c.grids.count, 0);
    assert_int_equal(report.num_floating, 1);
    assert_int_equal(report.num_massless, 0);
    assert_near(c.digits, 0.0, 0.0);
    for (int64_t k = 0; k < 3; k++) {
        const double w = two_pi() * (k == 0 ? 0.0 : k == 1 ? 2.0 : 5.0);
        const double z = k == 0 ? 0.0 : k == 1 ? 0.01 : 0.5;

        assert_int_equal(c.dof[k].grid, k + 1);
        assert_int_equal(c.dof[k].component, 0);
        assert_near(entry(&c.M, k, k), 1.0, 0.0);
        /* rounding of a square and of its root */
        assert_near(entry(&c.K, k, k), w * w, 4.0 * DBL_EPSILON * w * w);
        assert_near(entry(&c.D, k, k), 2.0 * z * w, 4.0 * DBL_EPSILON * w);
        assert_near(c.io.B.val[k], (double)(k + 1), 0.0);
        assert_near(ritz_dense_col(&c.io.C, k)[1], (double)(2 * k + 2), 0.0);
    }
    assert_int_equal(c.K.colptr[3], 2);
    assert_int_equal(c.M.colptr[3], 3);
    assert_string_equal(c.io.input[0], "force");
    assert_string_equal(c.io.output[1], "y2");
}

static void one_ratio_is_that_of_all_modes(void **)
{
    ritz_import_request request = {
        .frequencies = folder_write("f.mtx", ARRAY "1 2\n1\n3\n"),
        .ratios = "0.02"};
    ritz_import_report report = {0};

    for (int turn = 0; turn < 3; turn++) {
        RITZ_OWN(ritz_component) c = {0};

        assert_ok(ritz_import(&request, &c, &report));
        if (turn < 2)
            assert_near(entry(&c.D, 1, 1), 0.04 * two_pi() * 3.0,
                        8.0 * DBL_EPSILON);
        else
            assert_null(c.D.colptr);
        request.ratios =
            turn == 0 ? folder_write("z.mtx", ARRAY "1 1\n0.02\n") : NULL;
        ritz_import_report_free(&report);
    }
}

/* Two unit masses in a chain with unit springs, ground - 1 - 2, as two
   modes. */
static ritz_status import_chain(const char *ratios, ritz_component *out)
{
    const double lambda[] = {(3.0 - sqrt(5.0)) / 2.0, (3.0 + sqrt(5.0)) / 2.0};
    char text[3][200];
    ritz_import_request request = {.ratios = ratios};
    RITZ_OWN(ritz_import_report) report = {0};
    double phi[2][2];

    for (int k = 0; k < 2; k++) { /* (2 - lambda) phi_1 = phi_2 */
        double length = hypot(1.0, 2.0 - lambda[k]);

        phi[k][0] = 1.0 / length;
        phi[k][1] = (2.0 - lambda[k]) / length;
    }
    snprintf(text[0], sizeof text[0], "%s2 1\n%.17g\n%.17g\n", ARRAY,
             sqrt(lambda[0]) / two_pi(), sqrt(lambda[1]) / two_pi());
    snprintf(text[1], sizeof text[1], "%s2 1\n%.17g\n%.17g\n", ARRAY, phi[0][0],
             phi[1][0]);
    snprintf(text[2], sizeof text[2], "%s1 2\n%.17g\n%.17g\n", ARRAY, phi[0][1],
             phi[1][1]);
    request.frequencies = folder_write("f.mtx", text[0]);
    request.input_matrix = folder_write("b.mtx", text[1]);
    request.output_matrix = folder_write("c.mtx", text[2]);
    return ritz_import(&request, out, &report);
}

/* Response of mass 2 to a force on mass 1: 1 / det(K - w^2 I). */
static void a_chain_and_its_modes_respond_alike(void **)
{
    const double hertz[] = {0.0, 0.05, 0.13, 0.2, 0.4};
    const ritz_grid grid = {.count = 5, .hertz = hertz};
    const ritz_damping none = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_response) response = {0};

    assert_ok(import_chain(NULL, &c));
    assert_ok(direct_response(&c, &none, 0.0, &grid, &response));
    for (int k = 0; k < 5; k++) {
        double s = two_pi() * hertz[k] * two_pi() * hertz[k];
        double due = 1.0 / ((2.0 - s) * (1.0 - s) - 1.0);

        /* w^2 differs from lambda by 0.3 or more: condition below 10 */
        assert_near(creal(response.H[k]), due, 100.0 * DBL_EPSILON * 10.0);
    }
}

/* Ratios that import stores in D damp as `modal 0.03` does. */
static void ratios_in_d_are_modal_damping(void **)
{
    const double hertz[] = {0.05, 0.0984, 0.2575, 0.3};
    const ritz_grid grid = {.count = 4, .hertz = hertz};
    const ritz_damping none = {0};
    const ritz_damping modal = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.03};
    RITZ_OWN(ritz_component) with = {0}, without = {0};
    RITZ_OWN(ritz_response) mine = {0}, theirs = {0};

    assert_ok(import_chain("0.03", &with));
    assert_ok(import_chain(NULL, &without));
    assert_ok(direct_response(&with, &none, 0.0, &grid, &mine));
    assert_ok(modal_response(&without, &modal, 10.0, &grid, &theirs));
    for (int k = 0; k < 4; k++)
        assert_near(cabs(mine.H[k] - theirs.H[k]), 0.0,
                    1e-13 * cabs(theirs.H[k]) * 10.0);
}

static void what_is_no_modal_form_is_refused(void **)
{
    const char *const f = folder_write("f.mtx", ARRAY "2 1\n1\n3\n");
    const char *const z = folder_write("z.mtx", ARRAY "3 1\n0\n0\n0\n");
    const char *const high = folder_write("h.mtx", ARRAY "2 1\n0.1\n1\n");
    const char *const minus = folder_write("n.mtx", ARRAY "2 1\n1\n-3\n");
    const char *const square = folder_write("s.mtx", ARRAY "2 2\n1\n0\n0\n3\n");
    const char *const pairs =
        folder_write("i.mtx", "%%MatrixMarket matrix array complex general\n"
                              "2 1\n1 1\n0 2\n");
    const struct {
        const char *frequencies, *ratios, *other, *says;
    } cases[] = {
        {f, z, 0, "ratios: '"},
        {f, z, 0, "has 3 for 2 frequencies"},
        {f, high, 0, "each is 0 or more and below 1, '1' is not"},
        {f, "-0.1", 0, "ratios: '-0.1': each is 0 or more"},
        {minus, 0, 0, "each is finite and not negative, '-3' is not"},
        {square, 0, 0, "is 2 x 2, one row or one column is due"},
        {pairs, 0, 0, "is complex, real numbers are due"},
        {f, pairs, 0, "ratios: '"},
        {f, 0, f, "frequencies make a whole component"},
        {0, "0.1", f, "ratios are given, but no frequencies"},
        {f, "0.1x", 0, "cannot open"},
    };
    ritz_import_report report = {0};
    ritz_component c = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const ritz_import_request request = {.frequencies =
                                                 cases[k].frequencies,
                                             .ratios = cases[k].ratios,
                                             .mass = cases[k].other};

        assert_int_not_equal(ritz_import(&request, &c, &report), RITZ_OK);
        if (!strstr(ritz_error_message(), cases[k].says))
            fail_msg("%s: %s", cases[k].says, ritz_error_message());
        assert_null(c.dof);
    }
}

static ritz_status import_and_free(const char *ratios)
{
    ritz_component c = {0};
    ritz_status status = import_chain(ratios, &c);

    ritz_component_free(&c);
    return status;
}

static void no_allocation_failure_leaks(void **)
{
    char z[512]; /* folder_path keeps sixteen paths */

    snprintf(z, sizeof z, "%s", folder_write("z.mtx", ARRAY "1 1\n0.02\n"));
    assert_survives_every_allocation(import_and_free("0.02"));
    assert_survives_every_allocation(import_and_free(z));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_are_scalar_points_of_unit_mass),
    cmocka_unit_test(one_ratio_is_that_of_all_modes),
    cmocka_unit_test(a_chain_and_its_modes_respond_alike),
    cmocka_unit_test(ratios_in_d_are_modal_damping),
    cmocka_unit_test(what_is_no_modal_form_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(import_modal, tests, folder_make, folder_remove)
