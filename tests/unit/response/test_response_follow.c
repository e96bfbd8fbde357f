#include "testing.h"

#include "frame.h"

#include <ritz/matrix.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

enum { CHECKS = 1000 };

/* A fixed sequence of numbers between 0 and 1 (Lehmer, modulo 2^31 - 1). */
static double random_part(int64_t *seed)
{
    *seed = *seed * 48271 % 2147483647;
    return (double)*seed / 2147483647.0;
}

/* Oscillators of mass 1, each driven by and seen through `gain`. */
typedef struct oscillators {
    double k[16], m[16];
    ritz_dense K, M;
    ritz_io io;
    ritz_second_order model;
} oscillators;

static void make_oscillators(int64_t count, const double *hertz,
                             const double *gain, oscillators *out)
{
    *out =
        (oscillators){.K = {count, count, out->k}, .M = {count, count, out->m}};
    assert_ok(ritz_io_new(count, 1, 1, &out->io));
    for (int64_t i = 0; i < count; i++) {
        out->k[i * (count + 1)] = pow(2.0 * pi * hertz[i], 2.0);
        out->m[i * (count + 1)] = 1.0;
        out->io.B.val[i] = gain[i];
        out->io.C.val[i] = 1.0;
    }
    out->model =
        (ritz_second_order){.K = &out->K, .M = &out->M, .io = &out->io};
}

/* Largest error between points, of the largest |H| of each channel. */
static double error_between(const ritz_response *r, ritz_responder *exact)
{
    int64_t values = r->num_outputs * r->num_inputs;
    double _Complex *H = calloc((size_t)(2 * values), sizeof *H);
    double *peak = calloc((size_t)values, sizeof *peak);
    double low = r->hertz[0];
    double high = r->hertz[r->count - 1];
    double worst = 0.0;
    int64_t seed = 1992;

    assert_true(H && peak);
    for (int64_t k = 0; k < r->count * values; k++)
        peak[k % values] = fmax(peak[k % values], cabs(r->H[k]));
    for (int t = 0; t < CHECKS; t++) {
        double at = low + (high - low) * random_part(&seed);
        int64_t near = (int64_t)((double)(r->count - 1) * random_part(&seed));

        if (t % 2) /* as many where points are close */
            at = r->hertz[near] +
                 random_part(&seed) * (r->hertz[near + 1] - r->hertz[near]);
        assert_ok(ritz_response_at(r, at, H));
        assert_ok(ritz_responder_at(exact, at, H + values));
        for (int64_t v = 0; v < values; v++)
            if (peak[v] > 0.0)
                worst = fmax(worst, cabs(H[v] - H[values + v]) / peak[v]);
    }
    free(H);
    free(peak);
    return worst;
}

static bool has_point(const ritz_response *r, double hertz, double within)
{
    for (int64_t k = 0; k < r->count; k++)
        if (fabs(r->hertz[k] - hertz) <= within * hertz)
            return true;
    return false;
}

/* Two poles of ratio 1e-4 as far apart as they are wide, one far away; between
 * them a zero each, 20 even points over all. */
static void the_tolerance_holds_at_a_thousand_frequencies(void **state)
{
    const double hertz[] = {3.0, 3.0006, 7.0, 20.0};
    const double gain[] = {1.0, 0.7, 2.0, -1.0};
    const double tolerance[] = {1e-2, 1e-3, 1e-4, 1e-6};
    const ritz_damping faint = {.kind = RITZ_DAMPING_MODAL, .zeta = 1e-4};
    const ritz_grid grid = {.from_hz = 0.0, .to_hz = 10.0, .count = 20};
    ritz_response_request request = {.to_hz = 10.0};
    RITZ_OWN(ritz_responder) *responder = NULL;
    oscillators o;

    (void)state;
    make_oscillators(4, hertz, gain, &o);
    request.model = ritz_model_of_dense(&o.model, &faint);
    assert_ok(ritz_responder_new(ritz_response_engine_find("modal"), &request,
                                 &responder));
    for (size_t k = 0; k < sizeof tolerance / sizeof *tolerance; k++) {
        RITZ_OWN(ritz_response) r = {0};

        assert_ok(ritz_responder_follow(responder, &grid, tolerance[k], &r));
        assert_string_equal(r.interpolation, "cubic");
        assert_near(r.tolerance, tolerance[k], 0.0);
        assert_near(r.hertz[0], 0.0, 0.0);
        /* a peak of ratio z is at f sqrt(1 - 2 z^2) */
        for (int p = 0; p < 3; p++)
            assert_true(has_point(&r, hertz[p], 2e-8));
        assert_true(error_between(&r, responder) <= tolerance[k]);
        print_message("# tolerance %.0e: %d points, error %.1e\n", tolerance[k],
                      (int)r.count, error_between(&r, responder));
    }
    ritz_io_free(&o.io);
}

/* 1/(a - w^2) + 1/(b - w^2) is zero at w^2 = (a + b)/2, undamped; with ratio
 * 1e-4 its zero is as near to the axis. */
static void a_zero_between_points_is_a_point(void **state)
{
    const double hertz[] = {1.0, 2.0};
    const double gain[] = {1.0, 1.0};
    const ritz_damping faint = {.kind = RITZ_DAMPING_MODAL, .zeta = 1e-4};
    const ritz_grid grid = {.from_hz = 0.5, .to_hz = 3.0, .count = 5};
    ritz_response_request request = {.from_hz = 0.5, .to_hz = 3.0};
    RITZ_OWN(ritz_responder) *responder = NULL;
    RITZ_OWN(ritz_response) r = {0};
    oscillators o;

    (void)state;
    make_oscillators(2, hertz, gain, &o);
    request.model = ritz_model_of_dense(&o.model, &faint);
    assert_ok(ritz_responder_new(ritz_response_engine_find("modal"), &request,
                                 &responder));
    assert_ok(ritz_responder_follow(responder, &grid, 1e-3, &r));
    /* the dip is shifted by the square of the ratio */
    assert_true(has_point(&r, sqrt(2.5), 1e-7));
    ritz_io_free(&o.io);
}

/* The range begins where rigid motion answers 1/w^2; against full factors. */
static void a_free_body_is_followed_by_krylov(void **state)
{
    const ritz_damping light = {.kind = RITZ_DAMPING_MODAL, .zeta = 1e-4};
    const ritz_grid grid = {.from_hz = 0.002, .to_hz = 0.3, .count = 20};
    const int64_t in[] = {22, 13}, out[] = {22, 16};
    const int64_t at = 13;
    const double d = 0.01;

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        ritz_response_request request = {.from_hz = 0.002, .to_hz = 0.3};
        RITZ_OWN(ritz_component) c = {0};
        RITZ_OWN(ritz_responder) *direct = NULL;
        RITZ_OWN(ritz_response) r = {0};

        assert_ok(
            frame_component(8, 0.5, &frame_mcdaniel, false, false, 1, &c));
        assert_ok(frame_io(&c, 2, in, 2, out));
        if (damped)
            assert_ok(ritz_sparse_from_triplets(c.num_dofs, c.num_dofs, 1, &at,
                                                &at, &d, &c.D));
        request.model = ritz_model_of_component(&c, &light);
        assert_ok(ritz_responder_new(ritz_response_engine_find("direct"),
                                     &request, &direct));
        assert_ok(ritz_response_of(ritz_model_of_component(&c, &light),
                                   ritz_response_engine_find("krylov"), 0.0,
                                   1e-4, &grid, &r));
        assert_string_equal(r.method, "krylov");
        assert_true(error_between(&r, direct) <= 1e-4);
    }
}

/* Interpolation reproduces a cubic, in the first and the last interval too. */
static void cubics_are_exact_for_cubics(void **state)
{
    double hertz[] = {1.0, 1.5, 2.5, 3.0, 4.5, 5.0};
    double _Complex H[6], value = 0.0;
    ritz_response r = {
        .count = 6, .hertz = hertz, .num_inputs = 1, .num_outputs = 1, .H = H};

    (void)state;
    for (int k = 0; k < 6; k++)
        H[k] = pow(hertz[k], 3.0) - 2.0 * hertz[k] + 1.0;
    for (int j = 0; j <= 32; j++) {
        double f = 1.0 + 0.125 * j;

        assert_ok(ritz_response_at(&r, f, &value));
        /* Each of the four terms has at most 17 roundings, and the absolute
           values of the weights add up to at most 3.6; no term of H exceeds
           5^3. */
        assert_near(creal(value), f * f * f - 2.0 * f + 1.0,
                    32.0 * DBL_EPSILON * 125.0);
    }
    assert_fails(ritz_response_at(&r, 5.1, &value), RITZ_ERR_ARGUMENT,
                 "5.1 Hz is outside the response, which is from 1 to 5 Hz");
    r.count = 0;
    assert_fails(ritz_response_at(&r, 1.0, &value), RITZ_ERR_ARGUMENT,
                 "has no points");
    r.count = 2; /* through two points goes a line */
    assert_ok(ritz_response_at(&r, 1.25, &value));
    assert_near(creal(value), 0.5 * creal(H[0] + H[1]), 1e-15);
    hertz[1] = 1.0;
    assert_fails(ritz_response_at(&r, 1.0, &value), RITZ_ERR_ARGUMENT,
                 "has 1 Hz twice");
}

static void what_cannot_be_followed_is_refused(void **state)
{
    const double hertz[] = {1.0};
    const double gain[] = {1.0};
    const double given[] = {0.5, 1.5};
    const ritz_grid grid = {.from_hz = 0.5, .to_hz = 1.7, .count = 5};
    const ritz_grid points = {
        .from_hz = 0.5, .to_hz = 1.5, .count = 2, .hertz = given};
    ritz_response_request request = {.from_hz = 0.5, .to_hz = 1.7};
    RITZ_OWN(ritz_responder) *responder = NULL;
    ritz_response r = {0};
    oscillators o;

    (void)state;
    make_oscillators(1, hertz, gain, &o);
    request.model = ritz_model_of_dense(&o.model, NULL);
    assert_ok(ritz_responder_new(ritz_response_engine_find("modal"), &request,
                                 &responder));
    assert_fails(ritz_responder_follow(responder, &grid, 1e-3, &r),
                 RITZ_ERR_SINGULAR, "1 Hz is the frequency of an undamped");
    assert_fails(ritz_responder_follow(responder, &grid, 0.0, &r),
                 RITZ_ERR_ARGUMENT, "not between 0 and 1");
    assert_fails(ritz_responder_follow(responder, &points, 1e-3, &r),
                 RITZ_ERR_ARGUMENT, "points that are given");
    ritz_io_free(&o.io);
}

static ritz_status follow_once(const ritz_second_order *model)
{
    const ritz_damping light = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.05};
    const ritz_grid grid = {.from_hz = 0.5, .to_hz = 2.5, .count = 3};
    const ritz_response_request request = {
        .model = ritz_model_of_dense(model, &light),
        .from_hz = 0.5,
        .to_hz = 2.5};
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_responder) *responder = NULL;
    RITZ_OWN(ritz_response) r = {0};

    RITZ_TRY(ritz_responder_new(ritz_response_engine_find("modal"), &request,
                                &responder));
    RITZ_TRY(ritz_responder_follow(responder, &grid, 0.1, &r));
done:
    return status;
}

static void following_survives_every_allocation(void **state)
{
    const double hertz[] = {1.0, 2.0};
    const double gain[] = {1.0, 1.0};
    oscillators o;

    (void)state;
    make_oscillators(2, hertz, gain, &o);
    assert_survives_every_allocation(follow_once(&o.model));
    ritz_io_free(&o.io);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_tolerance_holds_at_a_thousand_frequencies),
    cmocka_unit_test(a_zero_between_points_is_a_point),
    cmocka_unit_test(a_free_body_is_followed_by_krylov),
    cmocka_unit_test(cubics_are_exact_for_cubics),
    cmocka_unit_test(what_cannot_be_followed_is_refused),
    cmocka_unit_test(following_survives_every_allocation),
};

TEST_MODULE(response_follow, tests, NULL, NULL)
