#include "testing.h"

#include "balancing.h"
#include "project.h"
#include "spaces.h"
#include "states.h"

#include "linear/general.h"

#include <complex.h>
#include <float.h>
#include <stdlib.h>

enum { MASSES = 10, STATES = 2 * MASSES };

/* AB13DD's own, to which norms are asked for. */
static const double norm_error = 1e-6;

typedef struct fixture {
    ritz_component chain;
    ritz_state_space full;
} fixture;

/* Driven at the free end, seen at the held one, 5 % damping. */
static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    balancing_chain(MASSES, false, MASSES - 1, 0, "modal 0.05", &f.chain);
    balancing_full(&f.chain, &f.full);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->chain);
    ritz_state_space_free(&f->full);
    return 0;
}

static double at(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* sigma_(r+1) <= |H - H_r| <= 2 (sigma_(r+1) + ...), at every order. */
static void the_error_lies_between_its_bounds(void **state)
{
    fixture *f = *state;

    for (int64_t r = 1; r < STATES; r++) {
        ritz_request request = balancing_asking(&f->chain, r);
        states_outcome got = {0};
        double error = 0.0;
        const double rounding = 1e-12; /* STATES eps |H|, of the measuring */

        states_run(&ritz_method_balanced, &request, &got);
        assert_int_equal(got.basis.T.ncol, r);
        assert_int_equal(got.basis.num_hankel, STATES);
        error = balancing_error(&f->full, &got.model);
        assert_true(error <= got.basis.bound * (1.0 + norm_error) + rounding);
        assert_true(error >=
                    got.basis.hankel[r] * (1.0 - norm_error) - rounding);
        assert_int_equal(got.probe.verdict, RITZ_STABLE);
        states_discard(&got);
    }
}

/*
 * Of this chain by sqrt(eig(W_c W_o)) in SciPy, which has 1e-8 of the largest:
 * eigenvalues of a product are half as accurate.
 */
static void hankel_values_are_those_of_another_program(void **state)
{
    static const double expected[] = {
        0.006677558715, 0.006052135166, 0.002164872911, 0.002005368112,
        0.000965766986, 0.000934667303, 0.000463717769, 0.000448135527};
    fixture *f = *state;
    ritz_request request = balancing_asking(&f->chain, 4);
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_basis_make(&ritz_method_balanced, &request, &basis));
    for (int64_t k = 0; k < 8; k++)
        assert_near(basis.hankel[k], expected[k], 1e-8 * expected[0]);
}

/* Both Gramians of the reduced model are diag(sigma_1 .. sigma_r). */
static void gramians_of_the_reduced_model_are_equal_and_diagonal(void **state)
{
    enum { KEPT = 6 };
    fixture *f = *state;
    ritz_request request = balancing_asking(&f->chain, KEPT);
    states_outcome got = {0};
    ritz_dense At = {0}, Ct = {0}, U[2] = {0};

    states_run(&ritz_method_balanced, &request, &got);
    assert_ok(ritz_general_transpose(&got.model.A, &At));
    assert_ok(ritz_general_transpose(&got.model.C, &Ct));
    assert_ok(ritz_general_gramian(&got.model.A, &got.model.B, &U[0]));
    assert_ok(ritz_general_gramian(&At, &Ct, &U[1]));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_dense) W = {0};

        assert_ok(ritz_dense_mul_nt(&U[k], &U[k], &W));
        for (int64_t j = 0; j < KEPT; j++)
            for (int64_t i = 0; i < KEPT; i++) /* measured: 1e-17 */
                assert_near(at(&W, i, j), i == j ? got.basis.hankel[j] : 0.0,
                            1e-11 * got.basis.hankel[0]);
        ritz_dense_free(&U[k]);
    }
    ritz_dense_free(&At);
    ritz_dense_free(&Ct);
    states_discard(&got);
}

static void engines_make_the_same_model(void **state)
{
    fixture *f = *state;
    static const ritz_engine engines[] = {RITZ_ENGINE_DENSE, RITZ_ENGINE_MODAL};
    ritz_request request = balancing_asking(&f->chain, 5);
    states_outcome first = {0};

    states_run(&ritz_method_balanced, &request, &first);
    for (int k = 0; k < 2; k++) {
        states_outcome got = {0};

        request.choice.engine = engines[k];
        request.choice.given = RITZ_USES_ENGINE;
        states_run(&ritz_method_balanced, &request, &got);
        /* eps over the last value kept, relative to the first: 1e-14 */
        assert_near(balancing_error(&first.model, &got.model), 0.0,
                    1e-11 * first.basis.hankel[0]);
        states_discard(&got);
    }
    states_discard(&first);
}

/* ADI stops at 1e-10 of the right side, and the smallest value kept is a tenth
 * of the first: 1e-8 is left. */
static void low_rank_makes_the_same_model(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};
    states_outcome dense = {0}, low = {0};

    (void)state;
    balancing_chain(MASSES, false, MASSES - 1, 0, "rayleigh 0.5 0.001", &chain);
    request = balancing_asking(&chain, 4);
    request.choice.engine = RITZ_ENGINE_DENSE;
    states_run(&ritz_method_balanced, &request, &dense);
    request.choice.engine = RITZ_ENGINE_LOW_RANK;
    states_run(&ritz_method_balanced, &request, &low);
    assert_near(low.basis.bound, dense.basis.bound,
                1e-8 * dense.basis.hankel[0]);
    assert_near(balancing_error(&dense.model, &low.model), 0.0,
                1e-8 * dense.basis.hankel[0]);
    states_discard(&dense);
    states_discard(&low);
}

/* Only modes below the highest two are chosen from. */
static void modes_are_chosen_among_those_below_a_frequency(void **state)
{
    fixture *f = *state;
    ritz_request request = balancing_asking(&f->chain, 100);
    states_outcome got = {0};

    request.choice.among_hz = 9.0; /* the highest is at 10.6 Hz */
    request.choice.given = RITZ_USES_AMONG;
    states_run(&ritz_method_balanced, &request, &got);
    assert_true(got.basis.T.ncol < STATES && got.basis.T.ncol > 8);
    assert_int_equal(got.basis.T.ncol % 2, 0);
    assert_true(got.basis.among_hz == 9.0);
    assert_non_null(strstr(got.basis.remark, "rounding leaves no more"));
    states_discard(&got);
}

/*
 * Singular perturbation: the gain at 0 Hz is exact, which that of truncation is
 * not, and the error has the same bound.
 */
static void a_static_remainder_keeps_the_static_gain(void **state)
{
    enum { KEPT = 4 };
    fixture *f = *state;
    RITZ_OWN(ritz_dense) exact = balancing_static(&f->full);

    for (int perturb = 0; perturb < 2; perturb++) {
        ritz_request request = balancing_asking(&f->chain, KEPT);
        states_outcome got = {0};
        RITZ_OWN(ritz_dense) gain = {0};
        double off = 0.0;

        request.choice.perturb = perturb == 1;
        request.choice.given = RITZ_USES_REMAINDER;
        states_run(&ritz_method_balanced, &request, &got);
        assert_int_equal(got.model.A.nrow, KEPT);
        assert_int_equal(got.model.columns.count, KEPT);
        assert_int_equal(got.basis.T.ncol, perturb ? STATES : KEPT);
        gain = balancing_static(&got.model);
        off = fabs(gain.val[0] - exact.val[0]);
        if (perturb) /* STATES eps over the least value, 1e-5 of the first */
            assert_true(off <= 1e-10 * fabs(exact.val[0]));
        else
            assert_true(off >= 1e-3 * fabs(exact.val[0]));
        assert_true(balancing_error(&f->full, &got.model) <=
                    got.basis.bound * (1.0 + norm_error));
        assert_int_equal(got.probe.verdict, RITZ_STABLE);
        states_discard(&got);
    }
}

static void the_bound_is_an_estimate_of_the_reduced_model(void **state)
{
    fixture *f = *state;
    ritz_component *chain = &f->chain;
    ritz_request request = balancing_asking(chain, 6);
    states_outcome got = {0}, limited = {0};
    const ritz_measure *bound = NULL;

    states_run(&ritz_method_balanced, &request, &got);
    bound = find_measure(&got.model.estimates, "h-infinity-bound");
    assert_true(bound->value == got.basis.bound);
    assert_string_equal(bound->where, "");
    chain->io.limit[0] = 0.1;
    states_run(&ritz_method_balanced, &request, &limited);
    chain->io.limit[0] = nan("");
    bound = find_measure(&limited.model.estimates, "h-infinity-bound");
    assert_string_equal(bound->where, "outputs over their limits");
    assert_near(bound->value, 10.0 * got.basis.bound, 1e-12 * got.basis.bound);
    states_discard(&got);
    states_discard(&limited);
}

/*
 * Of a free chain the rigid states come first, [0 I; 0 0] to the bit, and what
 * remains of the error is that of the flexible part.
 */
static void rigid_motion_is_kept_as_it_is(void **state)
{
    (void)state;
    for (int engine = RITZ_ENGINE_DENSE; engine <= RITZ_ENGINE_MODAL;
         engine++) {
        RITZ_OWN(ritz_component) chain = {0};
        RITZ_OWN(ritz_state_space) full = {0};
        ritz_request request = {0};
        states_outcome got = {0};

        balancing_chain(MASSES, true, MASSES - 1, 0, "modal 0.05", &chain);
        balancing_full(&chain, &full);
        request = balancing_asking(&chain, 6);
        request.choice.engine = (ritz_engine)engine;
        states_run(&ritz_method_balanced, &request, &got);
        assert_int_equal(got.basis.T.ncol, 8);
        assert_int_equal(got.model.columns.kind[0], RITZ_COLUMN_RIGID);
        assert_int_equal(got.model.columns.kind[1], RITZ_COLUMN_RIGID);
        assert_int_equal(got.model.columns.kind[2], RITZ_COLUMN_STATE);
        for (int64_t j = 0; j < 8; j++)
            for (int64_t i = 0; i < 8; i++)
                if (i < 2 || j < 2)
                    assert_near(at(&got.model.A, i, j), i == 0 && j == 1,
                                i == 0 && j == 1 ? 8 * DBL_EPSILON : 0.0);
        for (int k = 0; k <= 20; k++) {
            double hertz = 0.1 * pow(1.3, k);
            double _Complex *a = balancing_response(&full, hertz);
            double _Complex *b = balancing_response(&got.model, hertz);

            assert_true(cabs(a[0] - b[0]) <=
                        got.basis.bound + 1e-10 * cabs(a[0]));
            free(a);
            free(b);
        }
        states_discard(&got);
    }
}

static void reduce(const ritz_state_space *full, int64_t states,
                   ritz_basis *basis, ritz_state_space *out)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.space = full;
    request.modes = states;
    assert_ok(ritz_basis_make(&ritz_method_balanced, &request, basis));
    assert_ok(ritz_reduce_space(full, basis, out));
}

/*
 * Poles at 2, -1, -5: the first has no Gramian, is kept, and comes beside the
 * one that was asked for.
 */
static void an_unstable_pole_of_a_state_space_is_kept(void **state)
{
    static const double A[] = {2, 0.3, -0.2, 0, -1, 0.5, 0, 0, -5};
    static const double B[] = {1, 1, 1}, C[] = {1, 2, 0.1};
    const spaces_rows rows = {3, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    reduce(&full, 1, &basis, &reduced);
    assert_int_equal(basis.T.ncol, 2);
    assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_STATE);
    assert_near(at(&reduced.A, 0, 0), 2.0, 64 * DBL_EPSILON);
    assert_near(at(&reduced.A, 0, 1), 0.0, 64 * DBL_EPSILON);
    assert_near(at(&reduced.A, 1, 0), 0.0, 64 * DBL_EPSILON);
}

/* E x' = A x + B u reduces to what E^-1 A, E^-1 B do. */
static void a_descriptor_matrix_changes_nothing(void **state)
{
    static const double E[] = {2, 0.5, 0, 0.25, 3, 0.5, 0, 0.125, 4};
    static const double A[] = {-2, 1, 0, -1, -3, 0.5, 0.25, 0, -8};
    static const double B[] = {1, 0.5, 1}, C[] = {1, 2, 0.5};
    const spaces_rows rows = {3, 1, 1, A, B, C, NULL, E};
    ritz_state_space full = {0}, plain = {0}, reduced[2] = {0};
    ritz_basis basis[2] = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    assert_ok(spaces_make(&rows, &plain));
    assert_ok(ritz_general_solve(&full.E, false, &plain.A));
    assert_ok(ritz_general_solve(&full.E, false, &plain.B));
    ritz_dense_free(&plain.E);
    reduce(&full, 2, &basis[0], &reduced[0]);
    reduce(&plain, 2, &basis[1], &reduced[1]);
    assert_null(reduced[0].E.val);
    assert_near(balancing_error(&reduced[0], &reduced[1]), 0.0,
                1e-13 * basis[0].hankel[0]);
    assert_true(balancing_error(&full, &reduced[0]) <=
                basis[0].bound * (1.0 + norm_error));
    for (int k = 0; k < 2; k++) {
        ritz_basis_free(&basis[k]);
        ritz_state_space_free(&reduced[k]);
    }
    ritz_state_space_free(&full);
    ritz_state_space_free(&plain);
}

/* The hospital building: 48 states, whose values its authors stored. */
static void the_building_is_reduced_within_its_bound(void **state)
{
    static const int64_t orders[] = {2, 4, 11, 20, 30, 46};
    RITZ_OWN(ritz_state_space) full = {0};
    double *stored = NULL;

    (void)state;
    if (!spaces_read("building", &full))
        skip();
    assert_int_equal(
        spaces_numbers("building", "hsv_stored_by_authors.txt", &stored), 48);
    for (size_t k = 0; k < sizeof orders / sizeof *orders; k++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_state_space) reduced = {0};
        double error = 0.0;

        reduce(&full, orders[k], &basis, &reduced);
        assert_int_equal(basis.T.ncol, orders[k]);
        for (int64_t i = 0; i < 48; i++) /* of the issue */
            assert_near(basis.hankel[i], stored[i],
                        stored[i] > 1e-8 * stored[0] ? 1e-9 * stored[i]
                                                     : 1e-11 * stored[0]);
        error = balancing_error(&full, &reduced);
        assert_true(error <= basis.bound * (1.0 + norm_error));
        assert_true(error >= stored[orders[k]] * (1.0 - norm_error));
    }
    free(stored);
}

/* Two equal systems side by side: each value twice, never one of the two. */
static void equal_values_are_kept_whole(void **state)
{
    static const double A[] = {-1, 0, 0,  0, 0, -1, 0, 0,
                               0,  0, -3, 0, 0, 0,  0, -3};
    static const double B[] = {1, 0, 0, 1, 1, 0, 0, 1};
    static const double C[] = {1, 0, 1, 0, 0, 1, 0, 1};
    const spaces_rows rows = {4, 2, 2, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    request.space = &full;
    request.modes = 1;
    assert_fails(ritz_basis_make(&ritz_method_balanced, &request, &basis),
                 RITZ_ERR_ARGUMENT, "equal");
    reduce(&full, 3, &basis, &reduced);
    assert_int_equal(basis.T.ncol, 2);
    assert_non_null(strstr(basis.remark, "3 were asked for"));
}

static void more_states_than_there_are_gives_all(void **state)
{
    fixture *f = *state;
    ritz_request request = balancing_asking(&f->chain, 500);
    states_outcome got = {0};

    states_run(&ritz_method_balanced, &request, &got);
    assert_int_equal(got.basis.T.ncol, STATES);
    assert_true(got.basis.bound == 0.0);
    assert_near(balancing_error(&f->full, &got.model), 0.0,
                1e-9 * got.basis.hankel[0]); /* measured: 1e-13 */
    states_discard(&got);
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    fixture *f = *state;
    const ritz_method *method = &ritz_method_balanced;
    ritz_request request = balancing_asking(&f->chain, 0);
    ritz_basis none = {0};
    int64_t inputs = f->chain.io.num_inputs;

    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "one at least");
    request.modes = -1;
    request.up_to_hz = 3.0;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "not by a frequency");
    request = balancing_asking(&f->chain, 4);
    request.choice.given = RITZ_USES_AMONG | RITZ_USES_ENGINE;
    request.choice.among_hz = 5.0;
    request.choice.engine = RITZ_ENGINE_DENSE;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "of the modal engine alone");
    request = balancing_asking(NULL, 4);
    request.space = &f->full;
    request.choice.engine = RITZ_ENGINE_MODAL;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "its engines are dense, low-rank and projection");
    request.choice.engine = RITZ_ENGINE_AUTO;
    request.choice.given = RITZ_USES_DAMPING;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "neither modes nor any damping");
    request = balancing_asking(&f->chain, 4);
    f->chain.io.num_inputs = 0;
    assert_fails(ritz_basis_make(method, &request, &none), RITZ_ERR_ARGUMENT,
                 "no inputs");
    f->chain.io.num_inputs = inputs;
}

/* A force that moves what no output sees. */
static void what_is_reached_but_not_seen_is_refused(void **state)
{
    static const double A[] = {-1, 0, 0, -2}, B[] = {1, 0}, C[] = {0, 1};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) full = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_basis none = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    request.space = &full;
    request.modes = 1;
    assert_fails(ritz_basis_make(&ritz_method_balanced, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "nothing is both controllable and observable");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    ritz_request request = balancing_asking(&f->chain, 4);
    ritz_state_space reduced = {0};
    ritz_damping damping = {0};
    ritz_basis basis = {0};

    request.choice.perturb = true;
    assert_survives_every_allocation(
        ritz_method_balanced.make(&request, &basis));
    assert_ok(ritz_damping_parse(basis.damping, &damping));
    assert_survives_every_allocation(
        ritz_reduce_states(&f->chain, &damping, &basis, &reduced));
    ritz_basis_free(&basis);
    ritz_state_space_free(&reduced);
    request.component = NULL;
    request.space = &f->full;
    assert_survives_every_allocation(
        ritz_method_balanced.make(&request, &basis));
    assert_survives_every_allocation(
        ritz_reduce_space(&f->full, &basis, &reduced));
    ritz_basis_free(&basis);
    ritz_state_space_free(&reduced);
}

/*
 * SLICOT's example of AB09BD, singular perturbation to five states. Entries are
 * printed to 5e-5, which moves the response by 3e-4 (measured on AB09AD's).
 */
static void slicot_publishes_this_perturbed_model(void **state)
{
    static const double A7[] = {
        -0.04165, 0,     4.92,  -4.92, 0,        0,     0,    /**/
        -5.21,    -12.5, 0,     0,     0,        0,     0,    /**/
        0,        3.33,  -3.33, 0,     0,        0,     0,    /**/
        0.545,    0,     0,     0,     -0.545,   0,     0,    /**/
        0,        0,     0,     4.92,  -0.04165, 0,     4.92, /**/
        0,        0,     0,     0,     -5.21,    -12.5, 0,    /**/
        0,        0,     0,     0,     0,        3.33,  -3.33};
    static const double B7[] = {0, 0, 12.5, 0, 0, 0, 0, 0, 0, 0, 0, 12.5, 0, 0};
    static const double C7[] = {1, 0, 0, 0, 0, 0, 0, /**/
                                0, 0, 0, 1, 0, 0, 0, /**/
                                0, 0, 0, 0, 1, 0, 0};
    static const double A5[] = {
        1.3960,  5.1248,  0,       0,       4.4331,  /**/
        -4.1411, -3.8605, 0,       0,       -0.6738, /**/
        0,       0,       0.5847,  1.9230,  0,       /**/
        0,       0,       -4.3823, -3.2922, 0,       /**/
        1.3261,  1.7851,  0,       0,       -0.2249};
    static const double B5[] = {-0.2901, 0.2901,  -3.4004, 3.4004, -0.6379,
                                -0.6379, -3.9315, -3.9315, 1.9813, -1.9813};
    static const double C5[] = {-0.6570, 0.2053,  -0.6416, 0.2526, -0.0364,
                                0.1094,  0.4875,  0,       0,      0.8641,
                                0.6570,  -0.2053, -0.6416, 0.2526, 0.0364};
    static const double D5[] = {0.0498,  -0.0007, 0.0010,
                                -0.0010, -0.0007, 0.0498};
    static const spaces_rows whole = {7, 2, 3, A7, B7, C7, NULL, NULL};
    static const spaces_rows printed = {5, 2, 3, A5, B5, C5, D5, NULL};
    RITZ_OWN(ritz_state_space) model = {0}, theirs = {0}, ours = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(spaces_make(&whole, &model));
    assert_ok(spaces_make(&printed, &theirs));
    request.space = &model;
    request.modes = 5;
    request.choice.given = RITZ_USES_REMAINDER;
    request.choice.perturb = true;
    assert_ok(ritz_basis_make(&ritz_method_balanced, &request, &basis));
    assert_ok(ritz_reduce_space(&model, &basis, &ours));
    assert_int_equal(ours.A.nrow, 5);
    assert_near(balancing_error(&ours, &theirs), 0.0, 1e-3);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(slicot_publishes_this_perturbed_model),
    cmocka_unit_test(the_error_lies_between_its_bounds),
    cmocka_unit_test(hankel_values_are_those_of_another_program),
    cmocka_unit_test(gramians_of_the_reduced_model_are_equal_and_diagonal),
    cmocka_unit_test(engines_make_the_same_model),
    cmocka_unit_test(low_rank_makes_the_same_model),
    cmocka_unit_test(modes_are_chosen_among_those_below_a_frequency),
    cmocka_unit_test(a_static_remainder_keeps_the_static_gain),
    cmocka_unit_test(the_bound_is_an_estimate_of_the_reduced_model),
    cmocka_unit_test(rigid_motion_is_kept_as_it_is),
    cmocka_unit_test(an_unstable_pole_of_a_state_space_is_kept),
    cmocka_unit_test(a_descriptor_matrix_changes_nothing),
    cmocka_unit_test(the_building_is_reduced_within_its_bound),
    cmocka_unit_test(equal_values_are_kept_whole),
    cmocka_unit_test(more_states_than_there_are_gives_all),
    cmocka_unit_test(requests_that_make_no_sense_are_refused),
    cmocka_unit_test(what_is_reached_but_not_seen_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(balanced, tests, set_up, tear_down)
