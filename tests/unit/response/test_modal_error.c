/*
 * The error that the modal engine states where dampers act on modes above those
 * that it sums.
 */
#include "testing.h"

#include "bar.h"
#include "frame.h"

#include <ritz/matrix.h>
#include <ritz/response.h>

#include <complex.h>
#include <stdlib.h>

/* Both bars have many modes above the range, which are not summed. */
enum { FEW = 330, MANY = 2100, POINTS = 100 };

/* Hz: the free bar has modes at 0.5, 1, 1.5 and 2 Hz. */
static const double from_hz = 0.1, to_hz = 2.2;

/* Three dampers to ground with c, c / 2 and 0.7 c, relative to the impedance of
 * the bar, which is 1: a damper of 1 absorbs an arriving wave. */
static void open_damped_bar(int64_t elements, double c, ritz_component *bar)
{
    const int64_t at[] = {elements / 5, elements / 2, 4 * elements / 5};
    const int64_t in = elements, out = elements / 3;
    const double d[] = {c, 0.5 * c, 0.7 * c};

    assert_ok(bar_component(elements, bar));
    assert_ok(frame_io(bar, 1, &in, 1, &out));
    assert_ok(ritz_sparse_from_triplets(bar->num_dofs, bar->num_dofs, 3, at, at,
                                        d, &bar->D));
}

static ritz_response_request request_of(const ritz_component *bar,
                                        double tolerance)
{
    return (ritz_response_request){
        .model = ritz_model_of_component(bar, NULL),
        .from_hz = from_hz,
        .to_hz = to_hz,
        .tolerance = tolerance,
    };
}

/* The largest difference from the direct engine at evenly spaced frequencies,
   relative to the largest |H|. */
static double apart_from_direct(const ritz_component *bar, ritz_responder *r)
{
    const ritz_response_request request = request_of(bar, 0.0);
    RITZ_OWN(ritz_responder) *direct = NULL;
    double largest = 0.0, difference = 0.0;

    assert_ok(
        ritz_responder_new(&ritz_response_engine_direct, &request, &direct));
    for (int k = 0; k < POINTS; k++) {
        double hertz = from_hz + (to_hz - from_hz) * k / (POINTS - 1);
        double _Complex exact = 0.0, H = 0.0;

        assert_ok(ritz_responder_at(direct, hertz, &exact));
        assert_ok(ritz_responder_at(r, hertz, &H));
        largest = fmax(largest, cabs(exact));
        difference = fmax(difference, cabs(H - exact));
    }
    return difference / largest;
}

/* Whichever engine responds, the tolerance holds. */
static void with_a_tolerance_direct_takes_over(void **state)
{
    const ritz_response_request none = {0};
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_responder) *r = NULL;
    ritz_response_request request = none;

    (void)state;
    open_damped_bar(FEW, 1.0, &bar);
    request = request_of(&bar, 1e-4);
    assert_ok(
        ritz_responder_or_direct(&ritz_response_engine_modal, &request, &r));
    assert_true(apart_from_direct(&bar, r) < 1e-4);
}

static void a_sum_that_misses_its_tolerance_is_refused(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    ritz_response_request request = {0};
    ritz_responder *r = NULL;

    (void)state;
    open_damped_bar(MANY, 1.0, &bar);
    request = request_of(&bar, 1e-4);
    assert_fails(ritz_responder_new(&ritz_response_engine_modal, &request, &r),
                 RITZ_ERR_CONVERGENCE,
                 "modes above 6.6 Hz are summed undamped: off by ");
    assert_ok(
        ritz_responder_or_direct(&ritz_response_engine_modal, &request, &r));
    assert_non_null(strstr(ritz_responder_remark(r), "direct instead: modes"));
    ritz_responder_free(&r);
}

/*
 * Without a tolerance the engine responds and states its error. It compares at
 * a dozen frequencies, which find at least half and at most twice the error at
 * a hundred.
 */
static void without_a_tolerance_the_error_is_stated(void **state)
{
    static const double strength[] = {1e-3, 1.0, 30.0};

    (void)state;
    for (size_t k = 0; k < sizeof strength / sizeof *strength; k++) {
        RITZ_OWN(ritz_component) bar = {0};
        RITZ_OWN(ritz_responder) *r = NULL;
        ritz_response_request request = {0};
        const char *told = NULL;
        double off = 0.0, found = 0.0;

        open_damped_bar(MANY, strength[k], &bar);
        request = request_of(&bar, 0.0);
        assert_ok(
            ritz_responder_new(&ritz_response_engine_modal, &request, &r));
        told = strstr(ritz_responder_remark(r), "off by ");
        assert_non_null(told);
        off = strtod(told + strlen("off by "), NULL);
        found = apart_from_direct(&bar, r);
        print_message("# damper of %g: %s; found %.1e\n", strength[k],
                      ritz_responder_remark(r), found);
        assert_true(off > 0.5 * found && off < 2.0 * found);
    }
}

/* A sum of modes within the tolerance is not replaced. */
static void a_sum_within_its_tolerance_stays_one(void **state)
{
    const ritz_grid grid = {.from_hz = from_hz, .to_hz = to_hz, .count = 5};
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_response) response = {0};

    (void)state;
    open_damped_bar(MANY, 1e-3, &bar);
    assert_ok(ritz_response_of(ritz_model_of_component(&bar, NULL),
                               &ritz_response_engine_modal, 0.0, 0.3, &grid,
                               &response));
    assert_string_equal(response.method, "modal");
}

static ritz_status respond_once(const ritz_component *bar, double tolerance)
{
    const ritz_response_request request = request_of(bar, tolerance);
    RITZ_OWN(ritz_responder) *r = NULL;

    return ritz_responder_new(&ritz_response_engine_modal, &request, &r);
}

static void the_comparison_survives_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    open_damped_bar(20, 1.0, &bar);
    assert_survives_every_allocation(respond_once(&bar, 0.0));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(with_a_tolerance_direct_takes_over),
    cmocka_unit_test(a_sum_that_misses_its_tolerance_is_refused),
    cmocka_unit_test(without_a_tolerance_the_error_is_stated),
    cmocka_unit_test(a_sum_within_its_tolerance_stays_one),
    cmocka_unit_test(the_comparison_survives_every_allocation),
};

TEST_MODULE(modal_error, tests, NULL, NULL)
