/*
 * krylov and tangential of state spaces: moments, interpolation, conditions of
 * the smallest H2 error, stability of one-sided projection, refusals.
 */
#include "testing.h"

#include "spaces.h"

#include "base/complex.h"
#include "model/space.h"

#include <ritz/basis.h>
#include <ritz/check.h>
#include <ritz/poles.h>

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>

enum { STATES = 90 };

typedef struct made {
    ritz_basis basis;
    ritz_state_space model;
} made;

static void made_free(made *m)
{
    ritz_basis_free(&m->basis);
    ritz_state_space_free(&m->model);
}

static ritz_request asking(const ritz_state_space *space, int64_t modes)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.space = space;
    request.modes = modes;
    return request;
}

static void shift_to(ritz_request *request, int count, const double *hertz)
{
    request->choice.given |= RITZ_USES_SHIFTS;
    request->choice.num_shifts = count;
    for (int k = 0; k < count; k++)
        request->choice.shift_hz[k] = hertz[k];
}

static void reduce(const char *method, const ritz_request *request, made *out)
{
    assert_ok(ritz_basis_make(ritz_method_find(method), request, &out->basis));
    assert_true(out->basis.states);
    assert_ok(ritz_reduce_space(request->space, &out->basis, &out->model));
}

/* Moment j about s, C ((A - s E)^-1 E)^j (A - s E)^-1 B, outputs x inputs. */
static void find_moments(const ritz_state_space *model, double _Complex s,
                         int count, double _Complex *out)
{
    const int64_t m = model->num_inputs, p = model->num_outputs;
    RITZ_OWN(ritz_pencil) pencil = {0};
    double _Complex *X = NULL, *Y = NULL;

    assert_ok(ritz_pencil_of_space(model, &pencil));
    X = calloc((size_t)(pencil.n * m), sizeof *X);
    Y = calloc((size_t)(pencil.n * m), sizeof *Y);
    assert_true(X && Y);
    for (int64_t k = 0; k < pencil.n * m; k++)
        X[k] = model->B.val[k];
    assert_ok(ritz_pencil_factor(&pencil, s));
    for (int j = 0; j < count; j++) {
        assert_ok(ritz_pencil_solve(&pencil, false, m, X));
        for (int64_t i = 0; i < p * m; i++) {
            out[j * p * m + i] = 0.0;
            for (int64_t k = 0; k < pencil.n; k++)
                out[j * p * m + i] += ritz_dense_col(&model->C, k)[i / m] *
                                      X[k + (i % m) * pencil.n];
        }
        ritz_pencil_times(&pencil.E, m, X, Y);
        memcpy(X, Y, (size_t)(pencil.n * m) * sizeof *X);
    }
    free(X);
    free(Y);
}

/* Largest difference of moment j, relative to the largest entry of the
   moment. */
static double moment_error(const ritz_state_space *full, const made *m,
                           double _Complex s, int j)
{
    double _Complex a[40], b[40];
    double worst = 0.0, most = 0.0;

    find_moments(full, s, j + 1, a);
    find_moments(&m->model, s, j + 1, b);
    for (int i = 0; i < 4; i++) {
        worst = fmax(worst, cabs(a[4 * j + i] - b[4 * j + i]));
        most = fmax(most, cabs(a[4 * j + i]));
    }
    return worst / most;
}

static void one_side_of_a_symmetric_rod_keeps_two_moments_a_block(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(STATES, 0.0, true, &rod));
    request = asking(&rod, 8); /* two blocks of four vectors */
    reduce("krylov", &request, &m);
    assert_null(m.basis.W.val);
    assert_non_null(strstr(m.basis.remark, "2 whole block(s) about 0 Hz"));
    assert_non_null(strstr(m.basis.remark, "left and right vectors agree"));
    for (int j = 0; j < 4; j++)
        assert_near(moment_error(&rod, &m, 0.0, j), 0.0, 1e-10);
    assert_true(moment_error(&rod, &m, 0.0, 4) > 1e-10);
}

/* With two sides, the moments that B keeps and those that C' keeps add up at
   each expansion point. */
static void two_sides_keep_moments_of_each_at_every_point(void **)
{
    static const double hertz[] = {0.0, 0.02};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(STATES, 0.05, true, &rod));
    /* 6 vectors about 0 Hz, 3 pairs about 0.02 Hz */
    request = asking(&rod, 12);
    shift_to(&request, 2, hertz);
    request.choice.given |= RITZ_USES_SIDES;
    reduce("krylov", &request, &m);
    assert_int_equal(m.basis.T.ncol, 12);
    assert_int_equal(m.basis.W.ncol, 12);
    for (int j = 0; j < 6; j++)
        assert_near(moment_error(&rod, &m, 0.0, j), 0.0, 1e-8);
    for (int j = 0; j < 2; j++)
        assert_near(
            moment_error(&rod, &m, ritz_complex(0.0, 0.04 * acos(-1.0)), j),
            0.0, 1e-8);
}

static void one_side_is_stable_wherever_energy_falls(void **)
{
    for (int64_t modes = 1; modes <= 25; modes++) {
        RITZ_OWN(ritz_state_space) rod = {0};
        RITZ_OWN(made) m = {0};
        ritz_request request = {0};
        ritz_probe probe = {0};

        assert_ok(spaces_rod(STATES, 0.8, true, &rod));
        request = asking(&rod, modes);
        reduce("krylov", &request, &m);
        assert_null(m.basis.W.val);
        assert_ok(ritz_probe_states(&m.model, &probe));
        assert_int_equal(probe.verdict, RITZ_STABLE);
    }
}

static void loads_are_inputs_or_outputs_alone_if_asked(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};

    assert_ok(spaces_rod(STATES, 0.0, true, &rod));
    for (int loads = RITZ_LOADS_INPUTS; loads <= RITZ_LOADS_OUTPUTS;
         loads += RITZ_LOADS_OUTPUTS - RITZ_LOADS_INPUTS) {
        RITZ_OWN(made) m = {0};
        ritz_request request = asking(&rod, 4);

        request.choice.given = RITZ_USES_LOADS;
        request.choice.loads = loads;
        reduce("krylov", &request, &m);
        for (int j = 0; j < 2; j++)
            assert_near(moment_error(&rod, &m, 0.0, j), 0.0, 1e-9);
        assert_true(moment_error(&rod, &m, 0.0, 2) > 1e-9);
    }
}

static double _Complex response_at(const ritz_state_space *model,
                                   double _Complex s, int which)
{
    double _Complex H[4];
    RITZ_OWN(ritz_pencil) pencil = {0};

    assert_ok(ritz_pencil_of_space(model, &pencil));
    assert_ok(ritz_space_transfer(model, &pencil, s, H));
    return H[which];
}

static void given_points_are_interpolated(void **)
{
    static const double hertz[] = {0.001, 0.003, 0.01};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(STATES, 0.1, true, &rod));
    request = asking(&rod, 12);
    shift_to(&request, 3, hertz);
    reduce("tangential", &request, &m);
    assert_int_equal(m.basis.T.ncol, 12);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 4; i++) {
            double _Complex s = ritz_complex(0.0, 2.0 * acos(-1.0) * hertz[k]);
            double _Complex H = response_at(&rod, s, i);

            assert_near(cabs(response_at(&m.model, s, i) - H) / cabs(H), 0.0,
                        1e-8);
        }
}

/* For one input and one output the smallest H2 error implies that H and H'
   agree at -p for each reduced pole p. Settled points move by less than 1e-4,
   which bounds the difference of H and H'. */
static void settled_points_mirror_the_poles(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    RITZ_OWN(ritz_dense) B = {0}, C = {0};
    ritz_request request = {0};
    const int64_t first = 0;
    double _Complex *pole = NULL;
    int64_t count = 0;

    assert_ok(spaces_rod(STATES, 0.0, true, &rod));
    assert_ok(ritz_dense_columns(&rod.B, 0, 1, &B));
    assert_ok(ritz_dense_rows(&rod.C, 1, &first, &C));
    ritz_dense_replace(&rod.B, &B);
    ritz_dense_replace(&rod.C, &C);
    rod.num_inputs = rod.num_outputs = 1;
    rod.D.nrow = rod.D.ncol = 1;
    request = asking(&rod, 3);
    reduce("tangential", &request, &m);
    assert_non_null(strstr(m.basis.remark, "points settled"));
    assert_ok(ritz_state_space_poles(&m.model, &count, &pole));
    assert_int_equal(count, 3);
    for (int k = 0; k < 3; k++) {
        double _Complex a[2], b[2];

        find_moments(&rod, -pole[k], 2, a);
        find_moments(&m.model, -pole[k], 2, b);
        for (int j = 0; j < 2; j++)
            assert_near(cabs(a[j] - b[j]) / cabs(a[j]), 0.0, 2e-4);
    }
    free(pole);
}

/* IRKA ends at a local minimum of the H2 error, here below the error of
   balancing with the same order. */
static void tangential_has_no_larger_h2_error_than_balanced(void **)
{
    static const char *const method[] = {"tangential", "balanced"};
    RITZ_OWN(ritz_state_space) rod = {0};
    ritz_norm error[2] = {0};

    assert_ok(spaces_rod(STATES, 0.2, false, &rod));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(made) m = {0};
        RITZ_OWN(ritz_state_space) dense = {0}, apart = {0};
        const ritz_state_space *full = NULL;
        ritz_request request = asking(&rod, 8);

        reduce(method[k], &request, &m);
        assert_ok(ritz_state_space_dense(&rod, &dense, &full));
        assert_ok(ritz_state_space_difference(full, &m.model, &apart));
        assert_ok(ritz_norm_two(&apart, &error[k]));
    }
    assert_true(error[0].value <= error[1].value * (1.0 + 1e-6));
}

static void fewer_states_than_asked_are_said(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(6, 0.0, true, &rod));
    request = asking(&rod, 30);
    reduce("krylov", &request, &m);
    assert_int_equal(m.basis.T.ncol, 6);
    assert_non_null(strstr(m.basis.remark, "6 vectors and not 30"));
}

static void wrong_requests_are_refused(void **)
{
    const ritz_method *krylov = ritz_method_find("krylov");
    const ritz_method *tangential = ritz_method_find("tangential");
    static const double rest[] = {0.0};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_basis) none = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(20, 0.0, false, &rod));
    request = asking(&rod, 0);
    assert_fails(ritz_basis_make(krylov, &request, &none), RITZ_ERR_ARGUMENT,
                 "no states are asked for");
    request.modes = -1;
    request.up_to_hz = 5.0;
    assert_fails(ritz_basis_make(tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "not by a frequency");
    request = asking(&rod, 4);
    request.choice.given = RITZ_USES_INNER;
    assert_fails(ritz_basis_make(krylov, &request, &none), RITZ_ERR_ARGUMENT,
                 "of a state space there is no 'inner' to choose");
    request = asking(&rod, 4);
    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_ATTACHED;
    assert_fails(ritz_basis_make(krylov, &request, &none), RITZ_ERR_ARGUMENT,
                 "inputs and outputs, and no other loads");
    request.choice.given = RITZ_USES_LOADS | RITZ_USES_SIDES;
    request.choice.loads = RITZ_LOADS_INPUTS;
    assert_fails(ritz_basis_make(krylov, &request, &none), RITZ_ERR_ARGUMENT,
                 "a choice of loads needs one side");
    /* insulated rod: a uniform temperature is a pole at 0 */
    rod.sA.val[0] = rod.sA.val[rod.sA.colptr[20] - 1] = -1.0;
    request = asking(&rod, 4);
    shift_to(&request, 1, rest);
    assert_fails(ritz_basis_make(krylov, &request, &none), RITZ_ERR_SINGULAR,
                 "is a pole: move it");
    for (int64_t k = 0; k < 40; k++)
        rod.B.val[k] = 0.0;
    request = asking(&rod, 4);
    assert_fails(ritz_basis_make(tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "");
}

static ritz_status make(const char *method, const ritz_request *request)
{
    RITZ_OWN(ritz_basis) basis = {0};

    return ritz_basis_make(ritz_method_find(method), request, &basis);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(6, 0.1, true, &rod));
    request = asking(&rod, 3);
    assert_survives_every_allocation(make("krylov", &request));
    request = asking(&rod, 1); /* settles in a few iterations */
    assert_survives_every_allocation(make("tangential", &request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_side_of_a_symmetric_rod_keeps_two_moments_a_block),
    cmocka_unit_test(two_sides_keep_moments_of_each_at_every_point),
    cmocka_unit_test(one_side_is_stable_wherever_energy_falls),
    cmocka_unit_test(loads_are_inputs_or_outputs_alone_if_asked),
    cmocka_unit_test(given_points_are_interpolated),
    cmocka_unit_test(settled_points_mirror_the_poles),
    cmocka_unit_test(tangential_has_no_larger_h2_error_than_balanced),
    cmocka_unit_test(fewer_states_than_asked_are_said),
    cmocka_unit_test(wrong_requests_are_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(space_bases, tests, NULL, NULL)
