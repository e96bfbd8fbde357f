/* The smallest component that meets a tolerance, against exhaustive search. */
#include "testing.h"

#include "frame.h"
#include "masses.h"
#include "project.h"
#include "scenes.h"
#include "spring_chain.h"
#include "truss.h"

#include "fit/fitter.h"

#include <ritz/fit.h>
#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/verify.h>

#include <limits.h>

static const ritz_fit_request plain = RITZ_FIT_NONE;

enum { SOME = 5 };
static const ritz_method *const some[SOME] = {
    &ritz_method_craig_bampton, &ritz_method_krylov, &ritz_method_macneal_rubin,
    &ritz_method_normal_modes, &ritz_method_rubin};

/* Without what costs time and decides nothing. */
static ritz_fit_request quick(double to_hz, double zeta, const char *tolerance)
{
    ritz_fit_request request = plain;

    request.tolerance.band_hz[1] = to_hz;
    request.tolerance.damping =
        (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = zeta};
    request.num_random = 100;
    request.estimates = request.costs = false;
    request.methods = some;
    request.num_methods = SOME;
    assert_ok(ritz_tolerance_take(tolerance, &request.tolerance));
    return request;
}

/* Beam of 8 elements, its tip driven and seen, a port at the tip. */
static void open_beam(bool clamped, ritz_component *beam)
{
    int64_t in = 0;

    assert_ok(
        frame_component(8, 0.5, &frame_mcdaniel, clamped, false, 0, beam));
    in = beam->num_dofs - 2;
    assert_ok(frame_io(beam, 1, &in, 1, &in));
    assert_ok(add_port(beam, "tip", 8));
}

/* The clamped beam, ready to be fitted. */
typedef struct fitted {
    ritz_component beam;
    ritz_fitter *fitter;
    ritz_fit fit;
} fitted;

static void prepare_beam(const ritz_fit_request *request, fitted *out)
{
    open_beam(true, &out->beam);
    assert_ok(ritz_fitter_new(&out->beam, request, &out->fitter));
}

static void fit_beam(const ritz_fit_request *request, fitted *out)
{
    prepare_beam(request, out);
    assert_ok(ritz_fitter_search(out->fitter, &out->fit));
}

static void fitted_free(fitted *f)
{
    ritz_fit_free(&f->fit);
    ritz_fitter_free(&f->fitter);
    ritz_component_free(&f->beam);
}

/* The free truss, driven and seen at its end. */
static void open_truss(ritz_component *truss)
{
    const int64_t in = 69;
    const int64_t seen = 71;

    assert_ok(truss_component(&truss_free72, truss));
    assert_ok(frame_io(truss, 1, &in, 1, &seen));
    assert_ok(add_port(truss, "left", 1));
}

/* Every order that any method has, tried one by one. */
static int64_t exhaust(ritz_fitter *fitter, const ritz_fit *fit)
{
    int64_t least = INT64_MAX;

    for (int64_t m = 0; m < fit->num_methods; m++)
        for (int64_t modes = 0, before = -1; modes < 60; modes++) {
            ritz_fit_candidate c = {0};
            bool over = false;

            assert_ok(ritz_fitter_try(fitter, fit->method[m], &modes, &c));
            if (c.feasible && c.order < least)
                least = c.order;
            /* smaller ones of this method were all tried */
            over = c.order >= least || (modes > 8 && c.order == before);
            before = c.order;
            ritz_fit_candidate_free(&c);
            if (over)
                break;
        }
    return least;
}

/* Whatever the request says of estimates, exhaustive search measures all. */
static void assert_within_one(const ritz_component *component,
                              const ritz_fit_request *request)
{
    ritz_fit_request measured = *request;
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    ritz_fitter *all = NULL;
    RITZ_OWN(ritz_fit) fit = {0};
    int64_t least = 0;
    int64_t order = 0;

    assert_ok(ritz_fitter_new(component, request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    assert_true(fit.chosen >= 0);
    order = fit.candidate[fit.chosen].order;
    measured.estimates = false;
    assert_ok(ritz_fitter_new(component, &measured, &all));
    least = exhaust(all, &fit);
    ritz_fitter_free(&all);
    assert_true(least < INT64_MAX);
    /* fewer yet: columns are left out of bases that were tried whole */
    if (order > least + 1)
        fail_msg("%s\nfound %d, exhaustive search %d", fit.why, (int)order,
                 (int)least);
}

static void a_clamped_beam_is_fitted_within_one(void **state)
{
    RITZ_OWN(ritz_component) beam = {0};
    ritz_fit_request request = quick(0.5, 0.01, "response=1e-2");

    (void)state;
    open_beam(true, &beam);
    assert_within_one(&beam, &request);
    request = quick(0.5, 0.01, "frequency=1e-3,mac=0.99");
    assert_within_one(&beam, &request);
}

/* All candidates of a component are measured; only the result and the runner-up
   have bounds. */
static void the_answer_of_a_component_is_bounded(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    ritz_fit_request request = quick(40.0, 0.01, "frequency=1e-3");
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_fit) fit = {0};

    (void)state;
    open_truss(&truss);
    request.estimates = true;
    assert_within_one(&truss, &request);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    for (int64_t k = 0; k < fit.count; k++) {
        const ritz_fit_candidate *c = &fit.candidate[k];

        assert_false(c->ruled_out);
        assert_true(c->refusal[0] || c->errors.count > 0);
        if (k == fit.chosen || k == fit.runner_up)
            assert_true(find_measure(&c->estimates, "frequency-relative-bound")
                            ->value >=
                        find_measure(&c->errors, "frequency-relative")->value);
        else
            assert_int_equal(c->estimates.count, 0);
    }
    assert_true(fit.chosen >= 0 && fit.runner_up >= 0);
}

static void a_free_beam_is_fitted_within_one(void **state)
{
    RITZ_OWN(ritz_component) beam = {0};
    ritz_fit_request request = quick(1.0, 0.01, "response=1e-3,gain=1e-2");

    (void)state;
    open_beam(false, &beam);
    assert_within_one(&beam, &request);
    request = quick(1.0, 0.01, "1e-3,gain=1e-2");
    assert_within_one(&beam, &request);
}

static void a_free_truss_is_fitted_within_one(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    ritz_fit_request request = {0};

    (void)state;
    open_truss(&truss);
    request = quick(40.0, 0.01, "response=1e-3,frequency=1e-2");
    assert_within_one(&truss, &request);
}

/*
 * Its dampers couple modes, and each point of the full model takes a factor.
 * Bases are told of inputs alone and of dampers too; ratios are no matrix,
 * which krylov-damped needs.
 */
static void a_chain_with_dampers_is_fitted_within_one(void **state)
{
    static const ritz_method *const methods[] = {&ritz_method_normal_modes,
                                                 &ritz_method_krylov,
                                                 &ritz_method_krylov_damped};
    static const ritz_damping rayleigh = {
        .kind = RITZ_DAMPING_RAYLEIGH, .a = 0.02, .b = 1e-3};
    static const struct {
        int64_t num_methods;
        int loads;
        const char *tolerance;
    } cases[] = {
        {2, RITZ_LOADS_INPUTS, "response=2e-2,damping=5e-2"},
        {3, RITZ_LOADS_INPUTS | RITZ_LOADS_DAMPERS,
         "response=2e-2,damping=5e-2"},
        {3, RITZ_LOADS_INPUTS | RITZ_LOADS_DAMPERS, "response=1e-3,gain=1e-2"},
    };
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ritz_fit_request request = quick(3.0, 0.01, cases[k].tolerance);

        request.methods = methods;
        request.num_methods = cases[k].num_methods;
        request.choice.loads = cases[k].loads;
        request.choice.given = RITZ_USES_LOADS;
        if (k > 0)
            request.tolerance.damping = rayleigh;
        assert_within_one(&chain, &request);
    }
}

/* Chains of random masses and springs; half of them are free. */
static void random_chains_are_fitted_within_one(void **state)
{
    uint64_t seed = 7;

    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        double m[16];
        double k[16];
        const int64_t in = 15;
        const int64_t seen = 5 * trial;
        RITZ_OWN(ritz_component) chain = {0};
        const ritz_fit_request request =
            quick(0.2, 0.02, trial < 2 ? "response=3e-2" : "response=1e-3");

        for (int i = 0; i < 16; i++) {
            m[i] = 0.5 + 2.0 * ritz_random_next(&seed);
            k[i] = 5.0 + 20.0 * ritz_random_next(&seed);
        }
        if (trial % 2 == 0)
            k[0] = 0.0;
        assert_ok(masses_component(16, m, k, NULL, &chain));
        assert_ok(masses_io(&chain, 1, &in, 1, &seen));
        assert_within_one(&chain, &request);
    }
}

static void tolerances_are_taken_and_refused_in_words(void **state)
{
    ritz_verify_request limits = RITZ_VERIFY_NONE, alone = RITZ_VERIFY_NONE;
    char text[128];

    (void)state;
    assert_ok(ritz_tolerance_take("1e-2,frequency=1e-3,mac=0.9", &limits));
    ritz_tolerance_print(&limits, sizeof text, text);
    assert_string_equal(text, "frequency=0.001,mac=0.9,flexible=0.01");
    assert_ok(ritz_tolerance_take("1e-2", &alone));
    ritz_tolerance_print(&alone, sizeof text, text);
    assert_string_equal(text, "frequency=0.01,flexible=0.01");
    assert_fails(ritz_tolerance_take("gian=1", &limits), RITZ_ERR_ARGUMENT,
                 "there is no measure 'gian', is 'gain' meant?");
    assert_fails(ritz_tolerance_take("2e-2", &limits), RITZ_ERR_ARGUMENT,
                 "'2e-2' alone is of 'flexible' and 'frequency', and both have "
                 "a tolerance");
    assert_fails(ritz_tolerance_take("response=1,response=2", &limits),
                 RITZ_ERR_ARGUMENT, "'response' is given twice");
    alone = (ritz_verify_request)RITZ_VERIFY_NONE;
    assert_fails(ritz_tolerance_take("-1", &alone), RITZ_ERR_ARGUMENT,
                 "'-1' is no tolerance of 'flexible'");
    assert_fails(ritz_tolerance_take("gain=-1", &limits), RITZ_ERR_ARGUMENT,
                 "'-1' is no tolerance of 'gain'");
    assert_fails(ritz_tolerance_take("gain=0", &limits), RITZ_ERR_ARGUMENT,
                 "'0' is no tolerance of 'gain'");
    assert_fails(ritz_tolerance_take("gain=1,,", &limits), RITZ_ERR_ARGUMENT,
                 "'gain=1,,' is no list of tolerances");
}

static void what_cannot_be_fitted_is_refused_in_words(void **state)
{
    RITZ_OWN(ritz_component) beam = {0};
    ritz_fitter *fitter = NULL;
    ritz_fit_request request = quick(0.0, 0.01, "response=1e-2");

    (void)state;
    assert_ok(frame_component(3, 0.5, &frame_mcdaniel, true, false, 0, &beam));
    assert_fails(ritz_fitter_new(&beam, &request, &fitter), RITZ_ERR_ARGUMENT,
                 "there is no band");
    request = quick(0.5, 0.01, "response=1e-2");
    assert_fails(ritz_fitter_new(&beam, &request, &fitter), RITZ_ERR_ARGUMENT,
                 "a tolerance of 'response' needs inputs and outputs");
    request = quick(0.5, 0.01, "frequency=1e-2");
    request.tolerance.limit[RITZ_MEASURE_FREQUENCY] = nan("");
    assert_fails(ritz_fitter_new(&beam, &request, &fitter), RITZ_ERR_ARGUMENT,
                 "no tolerance is given");
    request = quick(0.5, 0.01, "damping=1e-2");
    request.tolerance.damping.kind = RITZ_DAMPING_NONE;
    assert_fails(ritz_fitter_new(&beam, &request, &fitter), RITZ_ERR_ARGUMENT,
                 "a tolerance of 'damping' needs a model that is damped");
    request = quick(0.5, 0.01, "frequency=1e-2");
    request.attach = "tpi";
    assert_fails(ritz_fitter_new(&beam, &request, &fitter), RITZ_ERR_ARGUMENT,
                 "tpi");
}

/* Of a mode that is not there no damping is wrong: so all must be there. */
static void a_tolerance_of_damping_is_not_met_by_missing_modes(void **state)
{
    const ritz_fit_request request = quick(0.5, 0.01, "damping=1e-2");
    const ritz_fit_candidate *c = NULL;
    RITZ_OWN(fitted) f = {0};

    (void)state;
    fit_beam(&request, &f);
    assert_true(f.fit.chosen >= 0);
    c = &f.fit.candidate[f.fit.chosen];
    assert_non_null(find_measure(&c->errors, "damping-relative"));
    assert_true(find_measure(&c->errors, "missing-modes")->value == 0.0);
    assert_true(find_measure(&c->errors, "missing-modes")->limit == 0.0);
}

/* What is refused for its size is too large, even if nothing smaller was made
   by then: three columns of the port and one mode are four. */
static void equal_order_is_found_below_what_is_too_large(void **state)
{
    ritz_fit_request request = quick(1e-5, 0.01, "response=1e-1");
    int64_t at = -1;
    RITZ_OWN(fitted) f = {0};

    (void)state;
    request.num_methods = 1; /* craig-bampton */
    request.largest = 4;
    fit_beam(&request, &f);
    if (f.fit.chosen < 0) /* static answers are enough */
        fail_msg("%s", f.fit.why);
    assert_int_equal(f.fit.candidate[f.fit.chosen].order, 3);
    assert_ok(ritz_fitter_equal(f.fitter, 4, &f.fit, &at));
    assert_true(at >= 0);
    assert_int_equal(f.fit.candidate[at].order, 4);
    assert_int_equal(f.fit.candidate[at].modes[0], 1);
}

/* With few columns allowed, the nearest is told and nothing is chosen. */
static void a_tolerance_that_no_method_meets_tells_the_nearest(void **state)
{
    ritz_fit_request request = quick(1.0, 0.01, "response=1e-6");
    RITZ_OWN(fitted) f = {0};

    (void)state;
    request.largest = 6;
    fit_beam(&request, &f);
    assert_int_equal(f.fit.chosen, -1);
    assert_non_null(
        strstr(f.fit.why, "no method meets the tolerance; nearest"));
    for (int64_t k = 0; k < f.fit.count; k++)
        assert_false(f.fit.candidate[k].feasible);
}

/*
 * Every prefix of what comes out is a model, is as far off as its file says,
 * and the whole is what was chosen.
 */
static void the_answer_is_nested_and_knows_its_errors(void **state)
{
    ritz_fit_request request = quick(0.5, 0.01, "frequency=1e-3,mac=0.99");
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_fit_candidate *chosen = NULL;
    RITZ_OWN(fitted) f = {0};

    (void)state;
    request.num_methods = 1; /* craig-bampton */
    fit_beam(&request, &f);
    chosen = &f.fit.candidate[f.fit.chosen];
    assert_ok(ritz_fitter_reduced(f.fitter, chosen, &reduced));
    assert_int_equal(reduced.K.ncol, chosen->order);
    assert_int_equal(reduced.nested.smallest, 3); /* the tip's dofs */
    assert_true(reduced.K.ncol > 3);
    for (int64_t r = 3; r <= reduced.K.ncol; r++) {
        RITZ_OWN(ritz_reduced) part = {0};
        RITZ_OWN(ritz_measures) found = {0};
        const ritz_verify_request *limits = ritz_fitter_tolerance(f.fitter);

        assert_ok(ritz_reduced_prefix(&reduced, r, &part));
        assert_ok(verify_reduced(&f.beam, &part, limits, &found));
        if (r < reduced.K.ncol)
            assert_true(find_measure(&found, "mac")->value < 0.99 ||
                        find_measure(&found, "frequency-relative")->value >
                            1e-3);
        /* the same arithmetic, but for the order of columns */
        assert_near(find_measure(&part.errors, "mac")->value,
                    find_measure(&found, "mac")->value, 1e-9);
    }
    assert_near(find_measure(&reduced.errors, "mac")->limit, 0.99, 0.0);
}

/* The bounds of a candidate hold: none is below the error that it bounds. */
static void bounds_stand_beside_errors_and_hold(void **state)
{
    ritz_fit_request request = quick(0.5, 0.01, "frequency=1e-3");
    int64_t incomplete = 0;
    RITZ_OWN(fitted) f = {0};

    (void)state;
    request.estimates = request.thorough = true;
    prepare_beam(&request, &f);
    for (int64_t modes = 0; modes < 8; modes++) {
        RITZ_OWN(ritz_fit_candidate) c = {0};
        const ritz_measure *error = NULL;
        const ritz_measure *bound = NULL;

        assert_ok(
            ritz_fitter_try(f.fitter, &ritz_method_craig_bampton, &modes, &c));
        assert_ok(ritz_fit_bound(f.fitter, &c));
        error = find_measure(&c.errors, "frequency-relative");
        bound = find_measure(&c.estimates, "frequency-relative-bound");
        if (find_measure(&c.estimates, "missing-modes-bound")->value > 0.0) {
            incomplete++;
            for (int64_t k = 0; k < c.estimates.count; k++)
                assert_string_not_equal(c.estimates.item[k].name,
                                        "frequency-relative-least");
            ritz_fit_candidate_free(&c);
            continue; /* errors of modes that no bound is of */
        }
        /* rounding of a frequency, eps lambda_max / lambda_1 = 1e-9 */
        assert_true(bound->value >= error->value - 1e-9);
    }
    assert_true(incomplete > 0);
}

/*
 * Between even points and the poles of the full model a pole of the reduced one
 * alone may stand, and only what confirms sees it: here the seventh mode of a
 * beam is given another frequency within the band.
 */
static void a_pole_between_points_is_seen_by_what_confirms(void **state)
{
    const ritz_fit_request asked = quick(1.0, 1e-5, "response=1e-2");
    RITZ_OWN(fitted) f = {0};
    RITZ_OWN(ritz_reference) *reference = NULL;
    RITZ_OWN(ritz_fit_candidate) c = {0};
    const int64_t modes = 21;
    ritz_reference_request request = {
        .band_hz = {0.0, 1.0},
        .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 1e-5},
        .num_random = 10,
        .seed = 3};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) grid = {0};
    RITZ_OWN(ritz_measures) all = {0};
    const ritz_model model = ritz_model_of_reduced(&reduced, NULL);
    double lambda = 0.0;

    (void)state;
    prepare_beam(&asked, &f);
    assert_ok(ritz_fitter_try(f.fitter, &ritz_method_normal_modes, &modes, &c));
    assert_ok(ritz_fitter_reduced(f.fitter, &c, &reduced));
    for (int64_t k = 0; k < reduced.K.ncol; k++)
        lambda = fmax(lambda, ritz_dense_col(&reduced.K, k)[k]);
    for (int64_t k = 0; k < reduced.K.ncol; k++)
        if (ritz_dense_col(&reduced.K, k)[k] == lambda) /* 0.6531 Hz */
            ritz_dense_col(&reduced.K, k)[k] = ritz_eigen_lambda(0.6531);
    assert_ok(ritz_reference_new(&f.beam, &request, &reference));
    assert_ok(
        ritz_reference_measure(reference, model, &asked.tolerance, 0, &grid));
    assert_ok(ritz_reference_measure(reference, model, &asked.tolerance,
                                     RITZ_AT_OTHER_POLES, &all));
    assert_true(find_measure(&all, "response-relative")->value >
                10.0 * find_measure(&grid, "response-relative")->value);
}

/* As request.stop: false as often as the context says, and then true. */
static bool is_enough(void *context)
{
    int *left = context;

    return --*left < 0;
}

/* The longer a search goes on before it is stopped, the smaller its result; the
   last search is not stopped. */
static void a_stopped_search_has_the_best_so_far(void **state)
{
    int64_t before = INT64_MAX;

    (void)state;
    for (int most = 0; most < 3000; most = most < 8 ? most + 1 : 2 * most) {
        ritz_fit_request request = quick(0.5, 0.01, "frequency=1e-3,mac=0.99");
        const ritz_fit_candidate *chosen = NULL;
        int left = most;
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(fitted) f = {0};

        request.stop = is_enough;
        request.context = &left;
        fit_beam(&request, &f);
        assert_true(!f.fit.interrupted || f.fit.count <= most);
        assert_true((strstr(f.fit.why, "interrupted after ") != NULL) ==
                    f.fit.interrupted);
        if (f.fit.chosen < 0) {
            assert_true(f.fit.interrupted);
            continue;
        }
        chosen = &f.fit.candidate[f.fit.chosen];
        assert_true(chosen->feasible && chosen->order <= before);
        before = chosen->order;
        left = INT_MAX; /* from here on nothing is stopped */
        assert_ok(ritz_fitter_reduced(f.fitter, chosen, &reduced));
        assert_int_equal(reduced.K.ncol, chosen->order);
        assert_true((reduced.nested.smallest == 0) == f.fit.interrupted);
        assert_near(find_measure(&reduced.errors, "mac")->value,
                    find_measure(&chosen->errors, "mac")->value, 0.0);
        if (!f.fit.interrupted)
            return;
    }
    fail_msg("the search never came to its end");
}

static ritz_status fit_once(const ritz_component *beam)
{
    ritz_fit_request request = quick(0.3, 0.01, "frequency=1e-2");
    const ritz_method *const one[] = {&ritz_method_normal_modes};
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_fit) fit = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    request.methods = one;
    request.num_methods = 1;
    request.num_random = 3;
    request.largest = 2;
    RITZ_CHECK(ritz_fitter_new(beam, &request, &fitter));
    RITZ_CHECK(ritz_fitter_search(fitter, &fit));
    RITZ_CHECK(
        ritz_fitter_reduced(fitter, &fit.candidate[fit.chosen], &reduced));
    return RITZ_OK;
}

static void fitting_survives_every_allocation(void **state)
{
    const double ones[] = {1.0, 1.0};
    const int64_t in = 1;
    RITZ_OWN(ritz_component) beam = {0};

    (void)state;
    assert_ok(masses_component(2, ones, ones, NULL, &beam));
    assert_ok(masses_io(&beam, 1, &in, 1, &in));
    assert_survives_every_allocation(fit_once(&beam));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_clamped_beam_is_fitted_within_one),
    cmocka_unit_test(the_answer_of_a_component_is_bounded),
    cmocka_unit_test(a_free_beam_is_fitted_within_one),
    cmocka_unit_test(a_free_truss_is_fitted_within_one),
    cmocka_unit_test(a_chain_with_dampers_is_fitted_within_one),
    cmocka_unit_test(random_chains_are_fitted_within_one),
    cmocka_unit_test(tolerances_are_taken_and_refused_in_words),
    cmocka_unit_test(what_cannot_be_fitted_is_refused_in_words),
    cmocka_unit_test(a_tolerance_of_damping_is_not_met_by_missing_modes),
    cmocka_unit_test(equal_order_is_found_below_what_is_too_large),
    cmocka_unit_test(a_tolerance_that_no_method_meets_tells_the_nearest),
    cmocka_unit_test(the_answer_is_nested_and_knows_its_errors),
    cmocka_unit_test(bounds_stand_beside_errors_and_hold),
    cmocka_unit_test(a_stopped_search_has_the_best_so_far),
    cmocka_unit_test(a_pole_between_points_is_seen_by_what_confirms),
    cmocka_unit_test(fitting_survives_every_allocation),
};

TEST_MODULE(fit, tests, NULL, NULL)
