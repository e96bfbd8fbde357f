/* What models are held to that lack a motion, or inputs and outputs. */
#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "masses.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <math.h>

/* A beam of 4 elements that nothing holds, and its modes. */
typedef struct fixture {
    ritz_component beam;
    ritz_pairs pairs;
} fixture;

enum { RIGID = 3 };

static void open_free(fixture *f)
{
    *f = (fixture){0};
    assert_ok(
        frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &f->beam));
    dense_modes(&f->beam, &f->pairs);
    assert_int_equal(f->pairs.num_rigid, RIGID);
}

static void close_free(fixture *f)
{
    ritz_pairs_free(&f->pairs);
    ritz_component_free(&f->beam);
}

/* Against `count` modes from `first` on, and a spring on the first of them. */
static void measure(const fixture *f, int64_t first, int64_t count,
                    double spring, const ritz_verify_request *request,
                    ritz_measures *out)
{
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(ritz_basis_new(f->beam.num_dofs, count, &basis));
    memcpy(basis.T.val, f->pairs.Phi.val + first * f->pairs.Phi.nrow,
           (size_t)(f->beam.num_dofs * count) * sizeof(double));
    assert_ok(ritz_reduce(&f->beam, &basis, &reduced));
    reduced.K.val[0] += spring; /* M is the identity */
    assert_ok(verify_reduced(&f->beam, &reduced, request, out));
}

static void a_rigid_motion_that_is_not_there_is_missing(void **)
{
    static const struct {
        int64_t first, count;
        double low, missing;
        bool holds;
    } table[] = {
        {0, 5, 0.0, 0.0, true},
        {1, 5, 0.0, 1.0, false},
        {3, 5, 0.0, 3.0, false},
        {1, 1, 0.0, 2.0, false}, /* fewer coordinates than rigid motions */
        {1, 5, 1e-3, 1.0, true}, /* rigid motion is not of this band */
    };
    fixture f;

    open_free(&f);
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        ritz_verify_request request = RITZ_VERIFY_NONE;
        RITZ_OWN(ritz_measures) found = {0};
        const ritz_measure *missing = NULL;

        request.limit[RITZ_MEASURE_FREQUENCY] = 1e-3;
        request.band_hz[0] = table[k].low;
        /* short of the first flexible mode: nothing else is missing */
        request.band_hz[1] = 0.9 * ritz_eigen_hertz(f.pairs.lambda[RIGID]);
        measure(&f, table[k].first, table[k].count, 0.0, &request, &found);
        missing = find_measure(&found, "missing-rigid-modes");
        assert_true(missing->value == table[k].missing);
        assert_string_equal(missing->where,
                            table[k].missing > 0.0 ? "of 3" : "");
        assert_int_equal(ritz_measure_holds(missing), table[k].holds);
        assert_true(find_measure(&found, "missing-modes")->value == 0.0);
    }
    close_free(&f);
}

/* The eigenvalue of a lone rigid motion is rounding, of either sign, and is
 * judged by the band: what is no rounding of that is refused. */
static void rounding_of_a_lone_rigid_motion_is_no_instability(void **)
{
    static const double part[] = {2e-17, -2e-17, -1e-3}; /* of the first mode */
    ritz_verify_request request = RITZ_VERIFY_NONE;
    fixture f;

    open_free(&f);
    request.band_hz[1] = 0.9 * ritz_eigen_hertz(f.pairs.lambda[RIGID]);
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_measures) found = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        assert_ok(ritz_basis_new(f.beam.num_dofs, 1, &basis));
        memcpy(basis.T.val, f.pairs.Phi.val,
               (size_t)f.beam.num_dofs * sizeof(double));
        assert_ok(ritz_reduce(&f.beam, &basis, &reduced));
        reduced.K.val[0] = part[k] * f.pairs.lambda[RIGID];
        if (k < 2)
            assert_ok(verify_reduced(&f.beam, &reduced, &request, &found));
        else
            assert_fails(verify_reduced(&f.beam, &reduced, &request, &found),
                         RITZ_ERR_ARGUMENT,
                         "an unstable model has no steady response");
    }
    close_free(&f);
}

/* lambda of a rigid motion on a spring k is k, of unit modal mass. */
static void a_rigid_motion_on_a_spring_is_as_far_off_as_frequencies(void **)
{
    fixture f;

    open_free(&f);
    for (int soft = 0; soft < 2; soft++) {
        ritz_verify_request request = RITZ_VERIFY_NONE;
        RITZ_OWN(ritz_measures) found = {0};
        const double relative = soft ? 0.9e-3 : 1.1e-3;
        const double lambda = f.pairs.lambda[RIGID];

        request.limit[RITZ_MEASURE_FREQUENCY] = 1e-3;
        request.band_hz[1] = 1.1 * ritz_eigen_hertz(lambda);
        measure(&f, 0, 5, relative * relative * lambda, &request, &found);
        assert_near(find_measure(&found, "rigid-hertz")->value,
                    relative * ritz_eigen_hertz(lambda),
                    1e-3 * ritz_eigen_hertz(lambda) * 1e-3);
        assert_int_equal(
            ritz_measure_holds(find_measure(&found, "missing-rigid-modes")),
            soft);
        ritz_measures_free(&found);
        /* nothing is asked: nothing fails */
        request.limit[RITZ_MEASURE_FREQUENCY] = nan("");
        measure(&f, 0, 5, relative * relative * lambda, &request, &found);
        assert_true(find_measure(&found, "missing-rigid-modes")->value == 1.0);
        assert_true(
            ritz_measure_holds(find_measure(&found, "missing-rigid-modes")));
    }
    close_free(&f);
}

static void a_response_that_does_not_exist_cannot_be_held_to_a_limit(void **)
{
    static const struct {
        size_t offset;
        const char *words;
    } table[] = {
        {offsetof(ritz_verify_request, limit[RITZ_MEASURE_RESPONSE]),
         "a limit of 'response-relative' needs inputs and outputs"},
        {offsetof(ritz_verify_request, limit[RITZ_MEASURE_FLEXIBLE]),
         "a limit of 'flexible-response-relative' needs inputs and outputs"},
        {offsetof(ritz_verify_request, limit[RITZ_MEASURE_GAIN]),
         "a limit of 'static-gain-relative' needs inputs and outputs, and "
         "there are 0 and 0"},
    };
    fixture f;
    ritz_basis basis = {0};
    ritz_reduced reduced = {0};

    open_free(&f);
    assert_ok(ritz_basis_new(f.beam.num_dofs, 5, &basis));
    memcpy(basis.T.val, f.pairs.Phi.val,
           (size_t)(f.beam.num_dofs * 5) * sizeof(double));
    assert_ok(ritz_reduce(&f.beam, &basis, &reduced));
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        ritz_verify_request request = RITZ_VERIFY_NONE;
        ritz_measures found = {0};

        memcpy((char *)&request + table[k].offset, &(double){0.1},
               sizeof(double));
        assert_fails(verify_reduced(&f.beam, &reduced, &request, &found),
                     RITZ_ERR_ARGUMENT, table[k].words);
    }
    ritz_reduced_free(&reduced);
    ritz_basis_free(&basis);
    close_free(&f);
}

/* Without rigid motion all of the response is flexible. */
static void the_flexible_response_of_what_is_held_is_all_of_it(void **)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};
    int64_t tip = 0;

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    tip = beam.num_dofs - 2;
    assert_ok(frame_io(&beam, 1, &tip, 1, &tip));
    assert_ok(ritz_basis_new(beam.num_dofs, 1, &basis));
    basis.T.val[tip] = 1.0; /* far too stiff */
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    request.band_hz[1] = 0.1;
    request.limit[RITZ_MEASURE_FLEXIBLE] = 0.1;
    request.limit[RITZ_MEASURE_RESPONSE] = 0.5;
    assert_ok(verify_reduced(&beam, &reduced, &request, &found));
    assert_true(find_measure(&found, "response-relative")->limit == 0.1);
    assert_false(ritz_measure_holds(find_measure(&found, "response-relative")));
    assert_null(ritz_measures_find(&found, "flexible-response-relative"));
    assert_null(ritz_measures_find(&found, "missing-rigid-modes"));
}

/* Four masses on springs of their own, the first with a damper. What rounding
 * leaves of the others is not compared; a ratio that is none is. */
static void rounding_of_a_ratio_is_no_ratio(void **)
{
    static const double stiffness[] = {1.0, 4.0, 9.0, 16.0};
    static const double damper[] = {0.1, 1e-17, -3e-17, 2e-4};
    static const double error[] = {0.0, 0.5}; /* of 2e-4 and 4e-4 */
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(masses_apart(4, stiffness, damper, &c));
    assert_ok(ritz_io_new(4, 0, 0, &c.io));
    request.band_hz[1] = 1.0;
    request.limit[RITZ_MEASURE_DAMPING] = 1e-2;
    for (int twice = 0; twice < 2; twice++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};

        assert_ok(ritz_basis_new(4, 4, &basis));
        for (int k = 0; k < 4; k++)
            ritz_dense_col(&basis.T, k)[k] = 1.0;
        assert_ok(ritz_reduce(&c, &basis, &reduced));
        ritz_dense_col(&reduced.D, 1)[1] *= -2.0;
        ritz_dense_col(&reduced.D, 2)[2] = 0.0;
        if (twice)
            ritz_dense_col(&reduced.D, 3)[3] *= 2.0;
        assert_ok(verify_reduced(&c, &reduced, &request, &found));
        assert_near(find_measure(&found, "damping-relative")->value,
                    error[twice], 1e-12);
    }
}

/* A free chain beside another: an input of one, an output of the other. Rigid
 * modes and equal ones are mixed by rounding, and that is no response. */
static void what_cancels_is_no_response(void **)
{
    enum { ELEMENTS = 3, ALL = 2 * (ELEMENTS + 1) };
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(bar_component(ALL - 1, &c));
    for (int which = 0; which < 2; which++) {
        ritz_sparse *A = which ? &c.M : &c.K;
        RITZ_OWN(ritz_dense) all = {0};

        assert_ok(ritz_sparse_dense(A, &all));
        for (int k = 0; k < 2; k++) { /* the element between is cut */
            int64_t i = ELEMENTS + k;

            ritz_dense_col(&all, i)[i] *= 0.5;
            ritz_dense_col(&all, i)[ALL - 1 - i] = 0.0;
        }
        ritz_sparse_free(A);
        assert_ok(ritz_sparse_from_dense(&all, A));
    }
    ritz_io_free(&c.io);
    assert_ok(ritz_io_new(ALL, 1, 1, &c.io));
    c.io.B.val[0] = 1.0;
    c.io.C.val[ALL - 1] = 1.0;
    assert_ok(ritz_basis_new(ALL, ALL, &basis));
    for (int64_t j = 0; j < ALL; j++) /* turned, so that nothing is 0 */
        for (int64_t i = 0; i < ALL; i++)
            ritz_dense_col(&basis.T, j)[i] =
                cos((double)(i * j) + 0.3 * (double)i);
    assert_ok(ritz_reduce(&c, &basis, &reduced));
    request.band_hz[1] = 1.0;
    for (int across = 1; across >= 0; across--) {
        RITZ_OWN(ritz_measures) found = {0};
        const ritz_measure *response = NULL;

        if (!across) {
            c.io.C.val[0] = 1.0;
            for (int64_t j = 0; j < ALL; j++)
                reduced.io.C.val[j] += ritz_dense_col(&basis.T, j)[0];
        }
        assert_ok(verify_reduced(&c, &reduced, &request, &found));
        response = ritz_measures_find(&found, "response-relative");
        assert_int_equal(response == NULL, across);
        /* cond(T)^2 eps of a full turn: measured, 1e-10 */
        assert_true(!response || response->value < 1e-7);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_rigid_motion_that_is_not_there_is_missing),
    cmocka_unit_test(rounding_of_a_lone_rigid_motion_is_no_instability),
    cmocka_unit_test(a_rigid_motion_on_a_spring_is_as_far_off_as_frequencies),
    cmocka_unit_test(a_response_that_does_not_exist_cannot_be_held_to_a_limit),
    cmocka_unit_test(the_flexible_response_of_what_is_held_is_all_of_it),
    cmocka_unit_test(rounding_of_a_ratio_is_no_ratio),
    cmocka_unit_test(what_cancels_is_no_response),
};

TEST_MODULE(verify_limits, tests, NULL, NULL)
