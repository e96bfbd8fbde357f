/* How wrong a reduced model can be, held to how wrong it is. */
#include "testing.h"

#include "bar.h"
#include "dualspin.h"
#include "estimate/estimator.h"
#include "frame.h"
#include "project.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <stdio.h>
#include <stdlib.h>

static double reported(const ritz_measures *m, const char *name)
{
    return find_measure(m, name)->value;
}

/*
 * A bound is no less than what is so, and no more than ten times that where it
 * is more than 1e-9: beneath that is rounding, of the truth too.
 */
static void assert_bounds(double bound, double truth, const char *what)
{
    const double rounding = 1e-9;

    if (!(bound >= truth) && truth > rounding)
        fail_msg("%s is said to be within %.6e, and is %.6e off", what, bound,
                 truth);
    if (!(bound <= 10.0 * fmax(truth, rounding)))
        fail_msg("%s is said to be within %.6e, and is but %.6e off", what,
                 bound, truth);
}

/* mode-k of each flexible mode up to Hz, against full eigenvalues. */
static void hold_to(const ritz_measures *found, const ritz_reduced *reduced,
                    const double *lambda, double to_hz)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    int listed = 0;

    assert_ok(ritz_eigen_dense(&reduced->K, &reduced->M, &pairs));
    for (int64_t k = pairs.num_rigid; k < pairs.Phi.ncol; k++) {
        char name[RITZ_NAME_SIZE];

        if (ritz_eigen_hertz(pairs.lambda[k]) > to_hz)
            break;
        (void)snprintf(name, sizeof name, "mode-%d", (int)k + 1);
        assert_bounds(reported(found, name),
                      fabs(sqrt(pairs.lambda[k] / lambda[k]) - 1.0), name);
        listed++;
    }
    assert_true(listed > 0);
}

/* Reduce by a method, with some rows attached. */
static void reduce_by(const ritz_method *method,
                      const ritz_component *component, ritz_dofs attached,
                      int64_t modes, ritz_basis *basis, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = component;
    request.attached = attached;
    request.modes = modes;
    assert_ok(ritz_basis_make(method, &request, basis));
    assert_ok(ritz_reduce(component, basis, out));
}

/* The bar's eigenvalues are known to all digits. */
static void bounds_hold_on_the_bar_and_are_near(void **)
{
    enum { ELEMENTS = 40, KNOWN = 20, METHODS = 4 };
    const ritz_method *const method[METHODS] = {
        &ritz_method_craig_bampton, &ritz_method_krylov_cms_fixed,
        &ritz_method_macneal_rubin, &ritz_method_guyan};
    int64_t attached[] = {0, 13, 40};
    ritz_estimate_request request = {0};
    RITZ_OWN(ritz_component) bar = {0};
    double lambda[KNOWN];

    assert_ok(bar_component(ELEMENTS, &bar));
    for (int64_t k = 0; k < KNOWN; k++)
        lambda[k] = bar_eigenvalue(ELEMENTS, k);
    for (int i = 0; i < METHODS; i++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        /* guyan has two flexible modes, the others six at least */
        request.band_hz[1] =
            1.3 *
            ritz_eigen_hertz(lambda[method[i] == &ritz_method_guyan ? 1 : 4]);
        reduce_by(method[i], &bar, (ritz_dofs){3, attached},
                  method[i] == &ritz_method_guyan ? -1 : 6, &basis, &reduced);
        assert_ok(ritz_estimate(&bar, &basis, &request, &reduced));
        hold_to(&reduced.estimates, &reduced, lambda, request.band_hz[1]);
        /* a Krylov basis has the sixth mode at a frequency above the band */
        assert_true(reported(&reduced.estimates, "missing-modes-bound") <=
                    (method[i] == &ritz_method_krylov_cms_fixed ? 1.0 : 0.0));
    }
}

/* Free bodies, some of whose modes come in near pairs. */
static void bounds_hold_on_the_spacecraft(void **)
{
    enum { METHODS = 3 };
    const ritz_method *const method[METHODS] = {&ritz_method_craig_bampton,
                                                &ritz_method_krylov_cms_free,
                                                &ritz_method_macneal_rubin};
    const ritz_span span = {.modes = 12};

    dualspin_or_skip();
    for (int which = 0; which < 3; which++) {
        RITZ_OWN(ritz_component) body = {0};
        RITZ_OWN(ritz_pairs) full = {0};

        assert_ok(dualspin_component(which, &body));
        assert_ok(ritz_eigen_sparse(&body.K, &body.M, &span, &full));
        /* the platform is rigid: no mode of it can be wrong */
        for (int i = 0; full.Phi.ncol > 10 && i < METHODS; i++) {
            const ritz_estimate_request request = {
                .band_hz = {0.0, 1.01 * ritz_eigen_hertz(full.lambda[10])}};
            RITZ_OWN(ritz_basis) basis = {0};
            RITZ_OWN(ritz_reduced) reduced = {0};

            reduce_by(method[i], &body, body.port[0].dofs, 14, &basis,
                      &reduced);
            assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
            hold_to(&reduced.estimates, &reduced, full.lambda,
                    request.band_hz[1]);
        }
    }
}

/* Beam of 12 elements, free or clamped: force and displacement at its end. */
static void open_beam(bool clamped, ritz_component *beam)
{
    int64_t in = 0;
    int64_t seen[2];

    assert_ok(
        frame_component(12, 0.5, &frame_mcdaniel, clamped, false, 1, beam));
    in = beam->num_dofs - 2;
    seen[0] = in;
    seen[1] = in - 9;
    assert_ok(frame_io(beam, 1, &in, 2, seen));
}

/* Exact modes 1, 2, 4, 5, 6, 7, 8 of the clamped beam, turned a little. */
static void a_mode_that_is_missing_is_counted_and_skipped(void **)
{
    enum { MODES = 7, LEFT_OUT = 2 };
    const ritz_span span = {.modes = MODES + 1};
    ritz_estimate_request request = {0};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_measures *found = &reduced.estimates;

    open_beam(true, &beam);
    assert_ok(ritz_eigen_sparse(&beam.K, &beam.M, &span, &full));
    assert_ok(ritz_basis_new(beam.num_dofs, MODES, &basis));
    for (int64_t j = 0; j < MODES; j++)
        for (int64_t i = 0; i < beam.num_dofs; i++)
            ritz_dense_col(&basis.T, j)[i] =
                ritz_dense_col(&full.Phi, j < LEFT_OUT ? j : j + 1)[i];
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    request.band_hz[1] = 1.01 * ritz_eigen_hertz(full.lambda[4]);
    assert_ok(ritz_estimate(&beam, &basis, &request, &reduced));
    assert_true(reported(found, "missing-modes-bound") == 1.0);
    assert_true(reported(found, "frequency-relative-bound") < 1e-6);
    assert_null(strstr(find_measure(found, "mode-2")->where, "full mode"));
    assert_non_null(
        strstr(find_measure(found, "mode-3")->where, "full mode 4"));
    assert_non_null(
        strstr(find_measure(found, "mode-4")->where, "full mode 5"));
}

/* Against ritz-verify, which has all modes and looks at every peak. */
static void responses_are_bounded(void **)
{
    /* bound over error; where modes are off by more than their half width both
       peaks count, and the form in A^-1 beside: measured 14 */
    static const struct {
        const char *text;
        double most;
    } damping[] = {{"modal 0.01", 10.0},
                   {"modal 1e-4", 20.0},
                   {"rayleigh 0.1 1e-5", 10.0}};
    int64_t attached[] = {0, 1, 2};

    for (int clamped = 0; clamped < 2; clamped++)
        for (size_t i = 0; i < sizeof damping / sizeof *damping; i++) {
            ritz_verify_request verify = RITZ_VERIFY_NONE;
            ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
            RITZ_OWN(ritz_component) beam = {0};
            RITZ_OWN(ritz_basis) basis = {0};
            RITZ_OWN(ritz_reduced) reduced = {0};
            RITZ_OWN(ritz_measures) measured = {0};
            double bound = 0.0, error = 0.0;

            open_beam(clamped == 1, &beam);
            reduce_by(&ritz_method_craig_bampton, &beam,
                      (ritz_dofs){3, attached}, 12, &basis, &reduced);
            assert_ok(ritz_damping_parse(damping[i].text, &request.damping));
            verify.damping = request.damping;
            verify.band_hz[1] = request.band_hz[1];
            assert_ok(ritz_estimate(&beam, &basis, &request, &reduced));
            assert_ok(verify_reduced(&beam, &reduced, &verify, &measured));
            bound = reported(&reduced.estimates, "response-relative-bound");
            error = reported(&measured, "response-relative");
            if (!(bound >= error) || !(bound <= damping[i].most * error))
                fail_msg("%s: response bound %.3e of %.3e", damping[i].text,
                         bound, error);
        }
}

/* Ratios by bands do not tell how modes near an edge are damped. */
static void what_is_not_proven_is_called_an_estimate(void **)
{
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    open_beam(true, &beam);
    reduce_by(&ritz_method_craig_bampton, &beam, (ritz_dofs){3, attached}, 12,
              &basis, &reduced);
    assert_ok(
        ritz_damping_parse("bands 0 0.1 0.01 0.1 90 0.02", &request.damping));
    assert_ok(ritz_estimate(&beam, &basis, &request, &reduced));
    assert_true(reported(&reduced.estimates, "response-relative-estimate") >
                0.0);
}

/* The factor and the counts stay; what they say does not change. */
static void one_estimator_serves_many_reductions(void **)
{
    enum { TIMES = 3 };
    int64_t attached[] = {0, 1, 2};
    const ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
    ritz_estimator *estimator = NULL;
    RITZ_OWN(ritz_component) beam = {0};
    double first[TIMES];

    open_beam(true, &beam);
    assert_ok(ritz_estimator_new(&beam, &request, &estimator));
    for (int64_t pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < TIMES; i++) {
            RITZ_OWN(ritz_basis) basis = {0};
            RITZ_OWN(ritz_reduced) reduced = {0};
            RITZ_OWN(ritz_measures) found = {0};
            double bound = 0.0;

            reduce_by(&ritz_method_craig_bampton, &beam,
                      (ritz_dofs){3, attached}, 8 + 3 * i, &basis, &reduced);
            assert_ok(ritz_estimator_measure(estimator, &basis, &reduced, false,
                                             &found));
            bound = reported(&found, "frequency-relative-bound");
            /* more counts may have come since, and do no harm */
            assert_true(pass == 0 || bound <= first[i] * (1.0 + 1e-6));
            first[i] = bound;
        }
    ritz_estimator_free(&estimator);
    assert_null(estimator);
}

/* A count that does not fit puts the factor into a file first; it is read back
   where it is needed, and the bounds are the same. */
static void the_factor_leaves_memory_to_a_count(void **)
{
    enum { ELEMENTS = 2500 };
    int64_t attached[] = {0};
    const ritz_estimate_request request = {.frequencies = true};
    ritz_estimator *estimator = NULL;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) least = {0}, none = {0}, found = {0};

    unsetenv("TMPDIR"); /* the user's may be in memory */
    assert_ok(bar_component(ELEMENTS, &bar));
    reduce_by(&ritz_method_craig_bampton, &bar, (ritz_dofs){1, attached}, 4,
              &basis, &reduced);
    assert_ok(ritz_estimate(&bar, &basis, &request, &reduced));
    assert_ok(ritz_estimator_new(&bar, &request, &estimator));
    assert_ok(
        ritz_estimator_measure(estimator, &basis, &reduced, true, &least));
    assert_int_equal(ritz_disk_used(), 0);
    ritz_set_memory(1024);
    assert_fails(
        ritz_estimator_measure(estimator, &basis, &reduced, false, &none),
        RITZ_ERR_MEMORY, "the factor of a count needs");
    ritz_set_memory(0);
    assert_true(ritz_disk_used() > 0);
    assert_ok(
        ritz_estimator_measure(estimator, &basis, &reduced, false, &found));
    assert_int_equal(found.count, reduced.estimates.count);
    for (int64_t k = 0; k < found.count; k++)
        assert_memory_equal(&found.item[k].value,
                            &reduced.estimates.item[k].value,
                            sizeof found.item[k].value);
    ritz_estimator_free(&estimator);
}

/* The first count is that of a factor by itself, and is made once. Bounds have
   the same bits with one thread, where it comes before the factor. */
static void the_first_count_is_taken_while_factoring(void **)
{
    enum { ELEMENTS = 2500 };
    int64_t attached[] = {0};
    const ritz_estimate_request request = {.frequencies = true};
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) before = {0};

    assert_ok(bar_component(ELEMENTS, &bar));
    reduce_by(&ritz_method_craig_bampton, &bar, (ritz_dofs){1, attached}, 4,
              &basis, &reduced);
    for (int threads = 1; threads <= 2; threads++) {
        ritz_estimator *estimator = NULL;
        RITZ_OWN(ritz_measures) found = {0};
        int64_t below = -1;

        ritz_set_threads(threads);
        assert_ok(ritz_estimator_new(&bar, &request, &estimator));
        assert_ok(
            ritz_estimator_measure(estimator, &basis, &reduced, false, &found));
        ritz_set_threads(1);
        assert_ok(ritz_inertia_below(&bar.K, &bar.M, estimator->early.rho, NULL,
                                     &below));
        assert_int_equal(estimator->early.below, below);
        assert_int_equal(estimator->num_factors, estimator->num_counts);
        ritz_estimator_free(&estimator);
        for (int64_t k = 0; k < before.count; k++)
            assert_memory_equal(&found.item[k].value, &before.item[k].value,
                                sizeof found.item[k].value);
        assert_true(found.count > 0);
        ritz_measures_free(&before);
        RITZ_MOVE(before, found);
    }
}

/* Rows 3, 4, 5 of the chain have no mass: M is singular. */
static void massless_dofs_are_no_obstacle(void **)
{
    enum { MASSES = 20 };
    const ritz_span span = {.modes = 8};
    int64_t attached[] = {MASSES - 1};
    ritz_estimate_request request = {0};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(spring_chain(MASSES, false, &chain));
    for (int64_t j = 3; j < 6; j++)
        for (int64_t p = chain.M.colptr[j]; p < chain.M.colptr[j + 1]; p++)
            chain.M.val[p] = 0.0;
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &span, &full));
    request.band_hz[1] = 1.01 * ritz_eigen_hertz(full.lambda[3]);
    reduce_by(&ritz_method_craig_bampton, &chain, (ritz_dofs){1, attached}, 6,
              &basis, &reduced);
    assert_ok(ritz_estimate(&chain, &basis, &request, &reduced));
    hold_to(&reduced.estimates, &reduced, full.lambda, request.band_hz[1]);
}

static void bands_and_bases_that_do_not_fit_are_refused(void **)
{
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {2.0, 1.0}};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    open_beam(true, &beam);
    reduce_by(&ritz_method_craig_bampton, &beam, (ritz_dofs){3, attached}, 4,
              &basis, &reduced);
    assert_fails(ritz_estimate(&beam, &basis, &request, &reduced),
                 RITZ_ERR_ARGUMENT,
                 "a band from 2 to 1 Hz is not a band of frequencies");
    request.band_hz[1] = 4.0;
    basis.T.ncol--;
    assert_fails(ritz_estimate(&beam, &basis, &request, &reduced),
                 RITZ_ERR_ARGUMENT, "is not that of the reduction");
    basis.T.ncol++;
    assert_int_equal(reduced.estimates.count, 0);
}

static void estimating_survives_every_allocation(void **)
{
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {0.0, 0.5}};
    int64_t row = 1;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(frame_component(3, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    assert_ok(frame_io(&beam, 1, &row, 1, &row));
    reduce_by(&ritz_method_craig_bampton, &beam, (ritz_dofs){3, attached}, 2,
              &basis, &reduced);
    assert_ok(ritz_damping_parse("modal 0.05", &request.damping));
    assert_survives_every_allocation(
        ritz_estimate(&beam, &basis, &request, &reduced));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bounds_hold_on_the_bar_and_are_near),
    cmocka_unit_test(bounds_hold_on_the_spacecraft),
    cmocka_unit_test(a_mode_that_is_missing_is_counted_and_skipped),
    cmocka_unit_test(responses_are_bounded),
    cmocka_unit_test(what_is_not_proven_is_called_an_estimate),
    cmocka_unit_test(one_estimator_serves_many_reductions),
    cmocka_unit_test(the_factor_leaves_memory_to_a_count),
    cmocka_unit_test(the_first_count_is_taken_while_factoring),
    cmocka_unit_test(massless_dofs_are_no_obstacle),
    cmocka_unit_test(bands_and_bases_that_do_not_fit_are_refused),
    cmocka_unit_test(estimating_survives_every_allocation),
};

TEST_MODULE(estimate, tests, NULL, NULL)
