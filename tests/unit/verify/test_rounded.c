/*
 * A free steel bar of 5 cm, whose stiffness was printed with few digits. Rigid
 * motions R then have K R != 0, so that K gives a response at low frequencies
 * which the body does not have.
 */
#include "testing.h"

#include "frame.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/response.h>
#include <ritz/verify.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { RIGID = 3, ENDS = 2 };

/* With Rayleigh damping the direct engine factors the full matrices. */
static const ritz_damping light = {.kind = RITZ_DAMPING_RAYLEIGH, .b = 1e-8};

static void round_to(ritz_sparse *A, int digits)
{
    char text[40];

    for (int64_t p = 0; p < A->colptr[A->ncol]; p++) {
        (void)snprintf(text, sizeof text, "%.*e", digits - 1, A->val[p]);
        A->val[p] = strtod(text, NULL);
    }
}

/* A transverse force at one end, and the displacement there. */
static void open_bar(int64_t elements, int digits, ritz_component *bar)
{
    const frame_section steel = {.rho = 7850.0,
                                 .area = 2.53e-5,
                                 .inertia = 5.31e-11,
                                 .modulus = 2.07e11};
    const int64_t end = 3 * elements + 1;

    assert_ok(frame_component(elements, 0.0513 / (double)elements, &steel,
                              false, false, 1, bar));
    assert_ok(frame_io(bar, 1, &end, 1, &end));
    round_to(&bar->K, digits);
    bar->digits = digits;
}

static double _Complex response_at(const ritz_component *bar,
                                   const char *engine, double hertz)
{
    const ritz_response_request request = {
        .model = ritz_model_of_component(bar, &light),
        .from_hz = 0.0,
        .to_hz = 20e3};
    RITZ_OWN(ritz_responder) *responder = NULL;
    double _Complex H = 0.0;

    assert_ok(ritz_responder_new(ritz_response_engine_find(engine), &request,
                                 &responder));
    assert_ok(ritz_responder_at(responder, hertz, &H));
    return H;
}

static ritz_rounded rounded_of(const ritz_component *bar, const char *engine)
{
    const ritz_response_request request = {
        .model = ritz_model_of_component(bar, &light),
        .from_hz = 20.0,
        .to_hz = 20e3};
    RITZ_OWN(ritz_responder) *responder = NULL;

    assert_ok(ritz_responder_new(ritz_response_engine_find(engine), &request,
                                 &responder));
    return ritz_responder_rounded(responder);
}

/* The response of the flexible modes at 0 Hz. */
static double flexible_gain(const ritz_component *bar)
{
    const int64_t row = bar->num_dofs - 2;
    RITZ_OWN(ritz_pairs) pairs = {0};
    double gain = 0.0;

    dense_modes(bar, &pairs);
    for (int64_t k = RIGID; k < pairs.Phi.ncol; k++)
        gain += pow(ritz_dense_col(&pairs.Phi, k)[row], 2.0) / pairs.lambda[k];
    return gain;
}

/*
 * Rounding gives rigid motions a frequency w_r, and changes the response at the
 * end of the bar by (4 / m) w_r^2 / w^4. The first bending mode's gain at 0 Hz
 * is 4 / (m lambda_1). At the stated frequency, for the tolerance 1e-3, the
 * change is at most 1e-3 of this gain. At a tenth of that frequency the change
 * is 1e4 times as large: at least a tenth of the gain, if the largest w_r^2 of
 * motions at this end is at least a hundredth of the largest of all.
 */
static void rounding_dominates_below_the_stated_frequency(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    ritz_rounded rounded = {0};
    double ends = 0.0, gain = 0.0;

    open_bar(10, 9, &bar);
    rounded = rounded_of(&bar, "direct");
    assert_int_equal(rounded.motions, RIGID);
    assert_false(rounded.hidden);
    ends = ritz_rounded_ends(&rounded, 1e-3);
    gain = flexible_gain(&bar);
    assert_true(ends > 10.0 && ends < rounded.flexible_hz);
    for (int k = 0; k < ENDS; k++) {
        double hertz = k == 0 ? ends : 0.1 * ends;
        double error = cabs(response_at(&bar, "direct", hertz) -
                            response_at(&bar, "modal", hertz));

        if (k == 0)
            assert_true(error <= 1.001e-3 * gain);
        else
            assert_true(error >= 0.1 * gain);
    }
}

/* These engines sum modes, and rigid modes respond without stiffness. */
static void engines_with_modes_ignore_rounded_stiffness(void **)
{
    RITZ_OWN(ritz_component) bar = {0};

    open_bar(10, 9, &bar);
    assert_int_equal(rounded_of(&bar, "modal").motions, 0);
    assert_int_equal(rounded_of(&bar, "krylov").motions, 0);
}

/* The band starts at r / sqrt(e) if that is above the first flexible frequency
   f, else at the geometric mean of r / sqrt(e) and f. */
static void the_end_depends_on_the_tolerance(void **)
{
    const ritz_rounded rounded = {
        .motions = RIGID, .rigid_hz = 2.0, .flexible_hz = 180.0};

    assert_near(ritz_rounded_ends(&rounded, 1e-2), 60.0, 64 * DBL_EPSILON * 60);
    assert_near(ritz_rounded_ends(&rounded, 1e-4), 200.0,
                64 * DBL_EPSILON * 200);
}

/* With six digits rigid eigenvalues are not below flexible ones by enough to be
   told apart; the positions of grids show how many there are. */
static void positions_show_what_rounding_hides(void **)
{
    static const char *const engines[] = {"direct", "krylov", "modal",
                                          "rational"};
    RITZ_OWN(ritz_component) bar = {0};

    open_bar(10, 6, &bar);
    for (size_t k = 0; k < sizeof engines / sizeof *engines; k++) {
        ritz_rounded rounded = rounded_of(&bar, engines[k]);

        assert_true(rounded.hidden);
        assert_int_equal(rounded.motions, RIGID);
        assert_true(rounded.rigid_hz > 10.0);
    }
}

/* A clamped bar has no rigid motions, however few digits its stiffness has. */
static void a_held_bar_is_not_called_rounded(void **)
{
    const frame_section steel = {.rho = 7850.0,
                                 .area = 2.53e-5,
                                 .inertia = 5.31e-11,
                                 .modulus = 2.07e11};
    const int64_t end = 28;
    RITZ_OWN(ritz_component) bar = {0};

    assert_ok(frame_component(10, 0.00513, &steel, true, false, 1, &bar));
    assert_ok(frame_io(&bar, 1, &end, 1, &end));
    round_to(&bar.K, 5);
    bar.digits = 5.0;
    assert_int_equal(rounded_of(&bar, "direct").motions, 0);
}

/* Reduce by the first `modes` modes, and measure errors over a band. */
static void verify_bar(const ritz_component *bar, int64_t modes,
                       const double band_hz[2], ritz_measures *found)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    dense_modes(bar, &pairs);
    assert_ok(ritz_basis_new(bar->num_dofs, modes, &basis));
    memcpy(basis.T.val, pairs.Phi.val,
           (size_t)(bar->num_dofs * modes) * sizeof(double));
    assert_ok(ritz_reduce(bar, &basis, &reduced));
    memcpy(request.band_hz, band_hz, sizeof request.band_hz);
    assert_ok(verify_reduced(bar, &reduced, &request, found));
}

/* A damper from the observed dof to the ground. */
static void add_damper(ritz_component *bar, double c)
{
    const int64_t row = bar->num_dofs - 2;
    RITZ_OWN(ritz_dense) D = {0};

    assert_ok(ritz_dense_new(bar->num_dofs, bar->num_dofs, &D));
    ritz_dense_col(&D, row)[row] = c;
    assert_ok(ritz_sparse_from_dense(&D, &bar->D));
}

/*
 * With a damper and more than 300 dofs, verify factors the full matrices. Modes
 * far above the band are kept, so that an error at the start of a band from 20
 * Hz is rounding, and the measure says so. A band from 0 Hz starts above this
 * rounding.
 */
static void verify_starts_above_rounding_or_names_it(void **)
{
    const double whole[2] = {0.0, 20e3}, low[2] = {20.0, 20e3};
    const ritz_measure *start = NULL, *worst = NULL;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_measures) above = {0}, below = {0};

    open_bar(104, 13, &bar);
    add_damper(&bar, 1e-3);
    verify_bar(&bar, 60, whole, &above);
    verify_bar(&bar, 60, low, &below);
    start = find_measure(&above, "rounding-to-hz");
    assert_true(start->value > 40.0 && start->value < 20e3);
    assert_non_null(strstr(start->where, "rigid eigenvalues of rounded K"));
    worst = find_measure(&below, "response-db");
    assert_non_null(
        strstr(worst->where, "20 Hz: rigid eigenvalues of rounded"));
    assert_true(worst->value >
                10.0 * find_measure(&above, "response-db")->value);
    assert_near(find_measure(&below, "rounding-to-hz")->value, start->value,
                0.01 * start->value);
}

/* With six digits rigid eigenvalues have either sign. The band starts above
   them, and errors are still measured. */
static void hidden_rigid_motions_are_no_undamped_modes(void **)
{
    const double band[2] = {0.0, 40e3};
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_measures) found = {0};

    open_bar(10, 6, &bar);
    verify_bar(&bar, bar.num_dofs, band, &found);
    assert_true(find_measure(&found, "rounding-to-hz")->value > 1e3);
    assert_true(find_measure(&found, "response-relative")->value < 1e-6);
    assert_true(find_measure(&found, "static-gain-relative")->value < 1e-6);
}

static void rounding_survives_every_allocation(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    ritz_rounded rounded = {0};

    open_bar(10, 6, &bar);
    dense_modes(&bar, &pairs);
    assert_survives_every_allocation(
        ritz_rounded_of(&bar, &pairs, true, &rounded));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rounding_dominates_below_the_stated_frequency),
    cmocka_unit_test(engines_with_modes_ignore_rounded_stiffness),
    cmocka_unit_test(the_end_depends_on_the_tolerance),
    cmocka_unit_test(positions_show_what_rounding_hides),
    cmocka_unit_test(a_held_bar_is_not_called_rounded),
    cmocka_unit_test(verify_starts_above_rounding_or_names_it),
    cmocka_unit_test(hidden_rigid_motions_are_no_undamped_modes),
    cmocka_unit_test(rounding_survives_every_allocation),
};

TEST_MODULE(rounded, tests, NULL, NULL)
