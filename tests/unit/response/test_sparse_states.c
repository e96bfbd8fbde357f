/* Responses of sparse state spaces, compared with those of dense ones. */
#include "testing.h"

#include "spaces.h"

#include <ritz/response.h>

#include <complex.h>
#include <stdlib.h>

static ritz_status respond(const ritz_state_space *model, const char *engine,
                           const ritz_grid *grid, ritz_response *out)
{
    return ritz_response_of(ritz_model_of_states(model),
                            engine ? ritz_response_engine_find(engine) : NULL,
                            0.0, 0.0, grid, out);
}

static double difference(const ritz_response *a, const ritz_response *b)
{
    double worst = 0.0, most = 0.0;

    assert_int_equal(a->count, b->count);
    for (int64_t k = 0; k < a->count * a->num_inputs * a->num_outputs; k++) {
        worst = fmax(worst, cabs(a->H[k] - b->H[k]));
        most = fmax(most, cabs(b->H[k]));
    }
    return worst / most;
}

static void a_sparse_model_responds_as_its_dense_copy(void **)
{
    static const ritz_grid grid = {.to_hz = 0.5, .count = 30};

    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_state_space) rod = {0};
        RITZ_OWN(ritz_response) sparse = {0}, dense = {0};

        assert_ok(spaces_rod(100, k & 1 ? 0.1 : 0.0, k & 2, &rod));
        ritz_dense_col(&rod.D, 1)[0] = 0.25;
        assert_ok(respond(&rod, NULL, &grid, &sparse));
        assert_string_equal(sparse.method, "sparse");
        assert_ok(respond(&rod, "states", &grid, &dense));
        assert_string_equal(dense.method, "states");
        /* condition of A is 4e3 */
        assert_near(difference(&sparse, &dense), 0.0, 1e-12);
    }
}

static void a_dense_model_takes_the_sparse_engine_if_asked(void **)
{
    static const double A[] = {-1, 2, 0, -3}, B[] = {1, 1}, C[] = {1, 0};
    static const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    static const ritz_grid grid = {.to_hz = 2.0, .count = 9};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_response) sparse = {0}, dense = {0};

    assert_ok(spaces_make(&rows, &model));
    assert_ok(respond(&model, "sparse", &grid, &sparse));
    assert_ok(respond(&model, NULL, &grid, &dense));
    assert_string_equal(dense.method, "states");
    assert_near(difference(&sparse, &dense), 0.0, 1e-14);
}

/* With wind 50 poles oscillate: -2 +- 2 i sqrt(wind^2 - 1) cos(..), within the
   range. */
static void points_are_added_at_poles_that_oscillate(void **)
{
    const ritz_grid even = {.to_hz = 40.0, .count = 20};
    ritz_grid refined = even;
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_response) plain = {0}, more = {0};

    refined.refine = true;
    assert_ok(spaces_rod(100, 100.0, false, &rod));
    assert_ok(respond(&rod, NULL, &even, &plain));
    assert_ok(respond(&rod, NULL, &refined, &more));
    assert_int_equal(plain.count, 20);
    assert_true(more.count > 60);
    ritz_response_free(&plain);
    ritz_response_free(&more);
    ritz_state_space_free(&rod); /* real poles have no peaks */
    assert_ok(spaces_rod(100, 0.0, true, &rod));
    assert_ok(respond(&rod, NULL, &refined, &more));
    assert_int_equal(more.count, 20);
}

static void a_point_on_a_pole_is_refused(void **)
{
    static const double rest[] = {0.0};
    static const ritz_grid grid = {.count = 1, .hertz = rest};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_response) none = {0};

    assert_ok(spaces_rod(30, 0.0, false, &rod));
    rod.sA.val[0] = rod.sA.val[rod.sA.colptr[30] - 1] = -1.0; /* a pole at 0 */
    assert_fails(respond(&rod, NULL, &grid, &none), RITZ_ERR_SINGULAR,
                 "0 Hz is the frequency of a pole");
}

/* Rods with and without wind and mass, with real and with oscillating poles. */
static void projections_and_interpolants_agree_with_factors(void **)
{
    static const char *const engine[] = {"krylov", "rational"};
    static const struct {
        int64_t n;
        double wind;
        bool mass;
        double to_hz[2]; /* for krylov, for rational */
    } kind[] = {{150, 0.0, false, {0.5, 1e-3}},
                {150, 0.0, true, {2.0, 1e-3}},
                {150, 0.1, true, {0.1, 1e-2}},
                {60, 0.3, false, {0.5, 0.1}},
                {150, 3.0, false, {0.02, 0.02}}};

    for (size_t k = 0; k < 2 * sizeof kind / sizeof *kind; k++) {
        const ritz_grid grid = {.to_hz = kind[k / 2].to_hz[k % 2], .count = 47};
        RITZ_OWN(ritz_state_space) rod = {0};
        RITZ_OWN(ritz_response) made = {0}, full = {0};

        assert_ok(spaces_rod(kind[k / 2].n, kind[k / 2].wind, kind[k / 2].mass,
                             &rod));
        ritz_dense_col(&rod.D, 1)[0] = 0.25;
        assert_ok(respond(&rod, "sparse", &grid, &full));
        assert_ok(respond(&rod, engine[k % 2], &grid, &made));
        assert_string_equal(made.method, engine[k % 2]);
        if (!(difference(&made, &full) <= 1e-9))
            fail_msg("%s, rod %d: %.1e", engine[k % 2], (int)k / 2,
                     difference(&made, &full));
    }
}

/* A dense model of 16 damped oscillators; two of them differ in frequency by
   less than the spacing of points. */
static void resonances_are_in_the_space(void **)
{
    enum { MODES = 16, N = 2 * MODES };
    static const char *const engine[] = {"krylov", "rational"};
    static const ritz_grid grid = {.to_hz = 1.5, .count = 60, .refine = true};
    double B[N], C[N];
    RITZ_OWN_ARRAY double *A = calloc((size_t)N * N, sizeof *A);
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_response) full = {0};

    assert_non_null(A);
    for (int k = 0; k < MODES; k++) {
        double w = k == 1 ? 1.0001 : k + 1.0;
        int at = 2 * k;

        A[at * N + at + 1] = w;
        A[(at + 1) * N + at] = -w;
        A[(at + 1) * N + at + 1] = -2e-3 * w;
        B[at] = 0.0;
        B[at + 1] = C[at] = 1.0 / w;
        C[at + 1] = 0.0;
    }
    assert_ok(
        spaces_make(&(spaces_rows){N, 1, 1, A, B, C, NULL, NULL}, &model));
    assert_ok(respond(&model, "states", &grid, &full));
    for (int k = 0; k < 2; k++) {
        const ritz_grid same = {.hertz = full.hertz, .count = full.count};
        RITZ_OWN(ritz_response) made = {0};

        assert_ok(respond(&model, engine[k], &same, &made));
        assert_near(difference(&made, &full), 0.0, 1e-9);
    }
}

static void krylov_and_rational_refuse_a_pole_too(void **)
{
    static const double rest[] = {0.0, 0.1};
    const ritz_grid grid = {.count = 2, .hertz = rest};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_response) none = {0};

    assert_ok(spaces_rod(30, 0.0, false, &rod));
    rod.sA.val[0] = rod.sA.val[rod.sA.colptr[30] - 1] = -1.0; /* a pole at 0 */
    assert_fails(respond(&rod, "krylov", &grid, &none), RITZ_ERR_SINGULAR,
                 "0 Hz");
    assert_fails(respond(&rod, "rational", &grid, &none), RITZ_ERR_SINGULAR,
                 "0 Hz");
    assert_fails(respond(&rod, "modal", &grid, &none), RITZ_ERR_ARGUMENT,
                 "modal is not for a state space");
}

static ritz_status make(const ritz_state_space *model)
{
    static const ritz_grid grid = {.to_hz = 0.5, .count = 3, .refine = true};
    RITZ_OWN(ritz_response) r = {0};

    return respond(model, "sparse", &grid, &r);
}

static ritz_status make_by(const ritz_state_space *model, const char *engine)
{
    static const ritz_grid grid = {.to_hz = 0.5, .count = 3};
    RITZ_OWN(ritz_response) r = {0};

    return respond(model, engine, &grid, &r);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, wind = {0};

    assert_ok(spaces_rod(8, 0.0, true, &rod));
    assert_survives_allocations(3, make(&rod));
    assert_ok(spaces_rod(8, 3.0, false, &wind));
    assert_survives_allocations(3, make(&wind));
    assert_survives_allocations(3, make_by(&rod, "krylov"));
    assert_survives_allocations(3, make_by(&wind, "rational"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_sparse_model_responds_as_its_dense_copy),
    cmocka_unit_test(a_dense_model_takes_the_sparse_engine_if_asked),
    cmocka_unit_test(points_are_added_at_poles_that_oscillate),
    cmocka_unit_test(a_point_on_a_pole_is_refused),
    cmocka_unit_test(projections_and_interpolants_agree_with_factors),
    cmocka_unit_test(resonances_are_in_the_space),
    cmocka_unit_test(krylov_and_rational_refuse_a_pole_too),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(sparse_states, tests, NULL, NULL)
