/*
 * Damping ratios act on every mode of a component, above the band too: a free
 * bar with modes in closed form, with few and with many dofs.
 */
#include "responses.h"
#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "model/modal.h"
#include "project.h"
#include "response/responder.h"
#include "verify/sides.h"

#include <ritz/response.h>

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* One size for the dense eigensolver, one for the sparse eigensolver. */
enum { FEW = 40, MANY = 700, POINTS = 12, SIDES = 2, VALUES = SIDES * SIDES };

/* Hz: the band holds modes at 0.5, 1, 1.5 and 2 Hz. */
static const double from_hz = 0.1, to_hz = 2.2;

static const ritz_damping dampings[] = {
    {.kind = RITZ_DAMPING_MODAL, .zeta = 0.001},
    {.kind = RITZ_DAMPING_MODAL, .zeta = 0.05},
    {.kind = RITZ_DAMPING_MODAL, .zeta = 0.5},
    {.kind = RITZ_DAMPING_MODAL, .zeta = 0.9},
    {.kind = RITZ_DAMPING_MODES, .count = 3, .ratio = {0.02, 0.01, 0.3}},
    {.kind = RITZ_DAMPING_BANDS,
     .count = 2,
     .band = {{0.0, 3.0, 0.02}, {3.0, 40.0, 0.6}}},
};

enum { DAMPINGS = sizeof dampings / sizeof *dampings };

/* Inputs and outputs at an end and near the middle. */
static void open_bar(int64_t elements, ritz_component *bar)
{
    const int64_t at[SIDES] = {elements, 2 * elements / 5};

    assert_ok(bar_component(elements, bar));
    assert_ok(frame_io(bar, SIDES, at, SIDES, at));
}

static void add_damper(ritz_component *bar, double c)
{
    const int64_t at = bar->num_dofs / 3;

    assert_ok(ritz_sparse_from_triplets(bar->num_dofs, bar->num_dofs, 1, &at,
                                        &at, &c, &bar->D));
}

/* Response of a free bar of N elements, the sum over all modes cos(k pi x). */
static void bar_response(int64_t N, const ritz_damping *damping, double hertz,
                         double _Complex *H)
{
    const int64_t inside = 2 * N / 5;
    const double x[SIDES] = {1.0, (double)inside / (double)N};
    double w = 2.0 * pi * hertz;

    for (int v = 0; v < VALUES; v++)
        H[v] = 0.0;
    for (int64_t k = 0; k <= N; k++) {
        double a = (double)k * pi;
        double lambda = k > 0 ? bar_eigenvalue(N, k) : 0.0;
        double mass = (2.0 + cos(a / (double)N)) / (k % N == 0 ? 3.0 : 6.0);
        double rate = ritz_modal_rate(damping, k - 1, lambda);

        for (int v = 0; v < VALUES; v++)
            H[v] += cos(a * x[v / SIDES]) * cos(a * x[v % SIDES]) / mass /
                    ritz_complex(lambda - w * w, w * rate);
    }
}

static double hertz_of(int point)
{
    return from_hz + (to_hz - from_hz) * point / (POINTS - 1);
}

/* Largest difference, relative to the largest |H|. */
static double apart(const double _Complex *exact, const double _Complex *H)
{
    double largest = 0.0, worst = 0.0;

    for (int k = 0; k < POINTS * VALUES; k++) {
        largest = fmax(largest, cabs(exact[k]));
        worst = fmax(worst, cabs(H[k] - exact[k]));
    }
    return worst / largest;
}

static char remark[RITZ_REMARK_SIZE]; /* of the last responder */

/* Respond at all points. @return the uncertainty that the engine states */
static double respond(const char *engine, const ritz_component *bar,
                      const ritz_damping *damping, double end_hz,
                      double _Complex *H)
{
    const ritz_response_request request = {
        .model = ritz_model_of_component(bar, damping),
        .from_hz = from_hz,
        .to_hz = end_hz};
    RITZ_OWN(ritz_responder) *r = NULL;

    assert_ok(
        ritz_responder_new(ritz_response_engine_find(engine), &request, &r));
    for (int k = 0; k < POINTS; k++)
        assert_ok(ritz_responder_at(r, hertz_of(k), H + k * VALUES));
    (void)snprintf(remark, sizeof remark, "%s", ritz_responder_remark(r));
    return ritz_responder_uncertainty(r);
}

/* The response that ritz-verify and ritz-fit compare with. */
static void refer(const ritz_component *bar, const ritz_damping *damping,
                  double _Complex *H)
{
    const ritz_reference_request request = {.band_hz = {from_hz, to_hz},
                                            .damping = *damping};
    double hertz[POINTS];
    RITZ_OWN(ritz_reference) *reference = NULL;
    ritz_reference_sweep sweep = {.count = POINTS, .hertz = hertz};

    for (int k = 0; k < POINTS; k++)
        hertz[k] = hertz_of(k);
    assert_ok(ritz_reference_new(bar, &request, &reference));
    assert_ok(ritz_reference_respond(reference, &sweep));
    memcpy(H, sweep.full, POINTS * VALUES * sizeof *H);
    sweep.hertz = NULL;
    ritz_sweep_free(&sweep);
}

/*
 * The eigenvalue of rigid motion is off by eps lambda_max, relative to the
 * lowest w^2 by 2e4 eps / 0.4 = 1e-11; with many elements by less, because
 * sparse eigenpairs are refined. With
 * undamped modes above the sum the response was off by 1e-3 at zeta = 0.05 and
 * by 2e-2 at 0.5.
 */
static void a_ratio_damps_all_modes(void **state)
{
    static const struct {
        const char *engine;
        double within;
    } kinds[] = {{"modal", 1e-10},
                 {"direct", 1e-10},
                 {"krylov", 1e-9},
                 {"rational", 1e-9}};
    const int64_t elements[] = {FEW, MANY};

    (void)state;
    for (int e = 0; e < 2; e++)
        for (int d = 0; d < DAMPINGS; d++) {
            double _Complex exact[POINTS * VALUES], H[POINTS * VALUES];
            RITZ_OWN(ritz_component) bar = {0};

            /* with many dofs, every second damping only, to save time */
            if (e == 1 && d % 2 == 1)
                continue;
            open_bar(elements[e], &bar);
            for (int k = 0; k < POINTS; k++)
                bar_response(elements[e], &dampings[d], hertz_of(k),
                             exact + k * VALUES);
            for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
                respond(kinds[k].engine, &bar, &dampings[d], to_hz, H);
                if (!(apart(exact, H) <= kinds[k].within))
                    fail_msg("%s, %d elements, damping %d: %.1e",
                             kinds[k].engine, (int)elements[e], d,
                             apart(exact, H));
            }
            refer(&bar, &dampings[d], H);
            if (!(apart(exact, H) <= 1e-10))
                fail_msg("reference, %d elements, damping %d: %.1e",
                         (int)elements[e], d, apart(exact, H));
        }
}

/* The end of the range decides which modes are summed, but not the response. */
static void a_response_does_not_depend_on_the_end_of_its_range(void **state)
{
    double _Complex near[POINTS * VALUES], far[POINTS * VALUES];
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    open_bar(FEW, &bar);
    respond("modal", &bar, &dampings[2], to_hz, near);
    respond("modal", &bar, &dampings[2], 5.0 * to_hz, far);
    assert_true(apart(far, near) < 1e-10);
}

/*
 * A last node that agrees does not prove the interpolant right between other
 * nodes: with many poles cancelled, six nodes in a row once agreed, and the
 * response was off by 3e-3.
 */
static void interpolation_is_checked_between_nodes(void **state)
{
    const ritz_damping heavy = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.99};
    double _Complex exact[POINTS * VALUES], H[POINTS * VALUES];
    RITZ_OWN(ritz_component) bar = {0};
    const ritz_response_request request = {
        .model = ritz_model_of_component(&bar, &heavy),
        .from_hz = from_hz,
        .to_hz = 12.0};
    RITZ_OWN(ritz_responder) *r = NULL;

    (void)state;
    open_bar(FEW, &bar);
    assert_ok(ritz_responder_new(ritz_response_engine_find("rational"),
                                 &request, &r));
    for (int k = 0; k < POINTS; k++) {
        double hertz = 1.0 + k;

        bar_response(FEW, &heavy, hertz, exact + k * VALUES);
        assert_ok(ritz_responder_at(r, hertz, H + k * VALUES));
    }
    assert_true(apart(exact, H) <= 1e-9);
}

/* A ratio and a damper: the reference is a dense model with all modes. */
static void a_ratio_beside_a_damper_damps_all_modes(void **state)
{
    static const char *const engines[] = {"direct", "krylov", "rational"};
    const int64_t elements[] = {FEW, 8 * FEW};
    const ritz_grid grid = {
        .from_hz = from_hz, .to_hz = to_hz, .count = POINTS};

    (void)state;
    for (int e = 0; e < 2; e++) {
        double _Complex H[POINTS * VALUES];
        RITZ_OWN(ritz_component) bar = {0};
        RITZ_OWN(ritz_dense) K = {0}, M = {0}, D = {0};
        RITZ_OWN(ritz_response) exact = {0};

        open_bar(elements[e], &bar);
        add_damper(&bar, 0.3);
        assert_ok(ritz_sparse_dense(&bar.K, &K));
        assert_ok(ritz_sparse_dense(&bar.M, &M));
        assert_ok(ritz_sparse_dense(&bar.D, &D));
        assert_ok(
            dense_response(&K, &M, &D, &bar.io, &dampings[2], &grid, &exact));
        for (size_t k = 0; k < sizeof engines / sizeof *engines; k++) {
            respond(engines[k], &bar, &dampings[2], to_hz, H);
            if (!(apart(exact.H, H) <= 1e-9))
                fail_msg("%s, %d elements: %.1e", engines[k], (int)elements[e],
                         apart(exact.H, H));
        }
        refer(&bar, &dampings[2], H);
        assert_true(apart(exact.H, H) <= 1e-9);
    }
}

/* Above RITZ_RATIO_DOFS dofs, ratios damp only the modes up to a frequency, in
   each engine that factors the same modes. */
static void engines_agree_on_a_damper_and_ratios_of_large_components(void **s)
{
    double _Complex direct[POINTS * VALUES], H[POINTS * VALUES];
    RITZ_OWN(ritz_component) bar = {0};

    (void)s;
    open_bar(RITZ_RATIO_DOFS, &bar);
    add_damper(&bar, 0.3);
    respond("direct", &bar, &dampings[1], to_hz, direct);
    assert_string_equal(remark, "ratios damp the modes up to 6.6 Hz alone");
    respond("krylov", &bar, &dampings[1], to_hz, H);
    assert_true(apart(direct, H) <= 1e-8);
}

/* With all dofs kept the error is rounding, and within the proven bound. */
static void the_identity_is_exact_at_any_ratio(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    open_bar(FEW, &bar);
    for (int d = 0; d < 4; d++) {
        const ritz_estimate_request estimate = {.band_hz = {from_hz, to_hz},
                                                .damping = dampings[d]};
        ritz_verify_request request = RITZ_VERIFY_NONE;
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};
        double error = 0.0;

        request.band_hz[0] = from_hz;
        request.band_hz[1] = to_hz;
        request.damping = dampings[d];
        assert_ok(ritz_basis_new(bar.num_dofs, bar.num_dofs, &basis));
        for (int64_t k = 0; k < bar.num_dofs; k++)
            ritz_dense_col(&basis.T, k)[k] = 1.0;
        assert_ok(ritz_reduce(&bar, &basis, &reduced));
        assert_ok(ritz_estimate(&bar, &basis, &estimate, &reduced));
        assert_ok(verify_reduced(&bar, &reduced, &request, &found));
        error = find_measure(&found, "response-relative")->value;
        /* eps lambda_max / (2 pi 0.1)^2, divided by 2 zeta at a peak */
        assert_true(error <= 1e-11 / fmin(dampings[d].zeta, 0.1));
        assert_true(error <= ritz_measures_value(&reduced.estimates,
                                                 "response-relative-bound"));
    }
}

/* What damping ratios change in the modes above 6.6 Hz, from all modes
   (`exact`) and from Ritz vectors (`found`). */
static ritz_status change_by_space(const ritz_component *bar,
                                   const ritz_damping *damping,
                                   ritz_residual *exact, ritz_residual *found)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_poles) poles = {0};

    RITZ_CHECK(
        ritz_poles_of_component(bar, damping, 3.0 * to_hz, &pairs, &poles));
    if (exact)
        RITZ_CHECK(
            ritz_residual_of_ratios(bar, damping, &pairs, 3.0 * to_hz, exact));
    return ritz_ratio_space(bar, damping, &pairs, 3.0 * to_hz, found);
}

/* Ritz vectors replace all modes above the sum, within the stated
   uncertainty. */
static void few_vectors_replace_all_modes_above_the_sum(void **state)
{
    (void)state;
    for (int d = 0; d < DAMPINGS; d++) {
        double _Complex H[POINTS * VALUES] = {0}, exact[POINTS * VALUES] = {0};
        RITZ_OWN(ritz_component) bar = {0};
        RITZ_OWN(ritz_residual) all = {0}, found = {0};
        double worst = 0.0;

        open_bar(4 * FEW, &bar);
        assert_ok(change_by_space(&bar, &dampings[d], &all, &found));
        assert_true(found.num_damped < all.num_damped);
        for (int k = 0; k < POINTS; k++) {
            ritz_residual_add_ratios(&all, hertz_of(k), exact + k * VALUES);
            ritz_residual_add_ratios(&found, hertz_of(k), H + k * VALUES);
        }
        for (int k = 0; k < POINTS * VALUES; k++)
            worst = fmax(worst, cabs(H[k] - exact[k]));
        if (!(worst <= fmax(found.uncertain, 1e-12)))
            fail_msg("damping %d: %.1e where %.1e is stated", d, worst,
                     found.uncertain);
        /* damping has a step at the end of the last band, 40 Hz */
        assert_true(found.uncertain <=
                    (dampings[d].kind == RITZ_DAMPING_BANDS ? 1e-4 : 1e-6));
    }
}

/* Errors are within the stated uncertainty; with undamped modes above the sum
   the response was off by 2e-2. */
static void ratios_damp_all_modes_of_large_components(void **state)
{
    static const char *const engines[] = {"modal", "direct"};
    const int64_t elements = RITZ_RATIO_DOFS;
    double _Complex exact[POINTS * VALUES], H[POINTS * VALUES];
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    open_bar(elements, &bar);
    for (int k = 0; k < POINTS; k++)
        bar_response(elements, &dampings[2], hertz_of(k), exact + k * VALUES);
    for (size_t k = 0; k < sizeof engines / sizeof *engines; k++) {
        double stated = respond(engines[k], &bar, &dampings[2], to_hz, H);

        if (!(stated > 0.0 && stated <= 1e-6 && apart(exact, H) <= stated))
            fail_msg("%s: %.1e where %.1e is stated", engines[k],
                     apart(exact, H), stated);
    }
    refer(&bar, &dampings[2], H);
    assert_true(apart(exact, H) <= 1e-8);
}

static ritz_status find_space(const ritz_component *bar)
{
    RITZ_OWN(ritz_residual) found = {0};

    return change_by_space(bar, &dampings[4], NULL, &found);
}

static ritz_status respond_once(const ritz_component *bar, const char *engine)
{
    const ritz_response_request request = {
        .model = ritz_model_of_component(bar, &dampings[2]),
        .from_hz = 0.1,
        .to_hz = 0.3};
    RITZ_OWN(ritz_responder) *r = NULL;
    double _Complex H[VALUES];

    RITZ_CHECK(
        ritz_responder_new(ritz_response_engine_find(engine), &request, &r));
    return ritz_responder_at(r, 0.2, H);
}

static void ratios_survive_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    open_bar(6, &bar);
    assert_survives_every_allocation(respond_once(&bar, "modal"));
    assert_survives_every_allocation(respond_once(&bar, "direct"));
    assert_survives_every_allocation(find_space(&bar));
    add_damper(&bar, 0.3);
    assert_survives_every_allocation(respond_once(&bar, "direct"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(interpolation_is_checked_between_nodes),
    cmocka_unit_test(a_ratio_damps_all_modes),
    cmocka_unit_test(a_response_does_not_depend_on_the_end_of_its_range),
    cmocka_unit_test(a_ratio_beside_a_damper_damps_all_modes),
    cmocka_unit_test(engines_agree_on_a_damper_and_ratios_of_large_components),
    cmocka_unit_test(the_identity_is_exact_at_any_ratio),
    cmocka_unit_test(few_vectors_replace_all_modes_above_the_sum),
    cmocka_unit_test(ratios_damp_all_modes_of_large_components),
    cmocka_unit_test(ratios_survive_every_allocation),
};

TEST_MODULE(ratios, tests, NULL, NULL)
