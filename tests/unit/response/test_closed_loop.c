/* Loops: closed forms, two ways to the same response, margins, refusals. */
#include "responses.h"
#include "spaces.h"
#include "testing.h"

#include <ritz/check.h>
#include <ritz/poles.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static void named(char (*name)[RITZ_NAME_SIZE], int64_t k, const char *text)
{
    snprintf(name[k], RITZ_NAME_SIZE, "%s", text);
}

static ritz_io ends_of(const ritz_state_space *m)
{
    return ritz_model_io(ritz_model_of_states(m));
}

static void responder(const ritz_state_space *model, double to_hz,
                      ritz_responder **out)
{
    const ritz_response_request request = {.model = ritz_model_of_states(model),
                                           .to_hz = to_hz};

    assert_ok(
        ritz_responder_new(ritz_response_engine_find("states"), &request, out));
}

/* A static gain of one signal, called as the plant calls it. */
static void gain(double g, const char *in, const char *out,
                 ritz_state_space *model)
{
    const spaces_rows rows = {0, 1, 1, NULL, NULL, NULL, &g, NULL};

    assert_ok(spaces_make(&rows, model));
    named(model->input, 0, in);
    named(model->output, 0, out);
}

/* 1 / (s (s + 1)(s + 2)), input 'u', output 'y'. */
static void third_order(ritz_state_space *model)
{
    static const double A[] = {-3, -2, 0, 1, 0, 0, 0, 1, 0};
    static const double B[] = {1, 0, 0};
    static const double C[] = {0, 0, 1};
    static const spaces_rows rows = {3, 1, 1, A, B, C, NULL, NULL};

    assert_ok(spaces_make(&rows, model));
    named(model->input, 0, "u");
    named(model->output, 0, "y");
}

typedef struct pair {
    ritz_state_space plant, controller, closed;
    ritz_loop loop;
    ritz_responder *G, *F, *H;
    double _Complex *pole;
    int64_t num_poles;
} pair;

/* Join by name and make all ready. */
static void join(pair *p, bool positive, double to_hz)
{
    ritz_io plant = ends_of(&p->plant), control = ends_of(&p->controller);

    assert_ok(ritz_loop_match(&plant, &control, 0, NULL, &p->loop));
    p->loop.positive = positive;
    assert_ok(
        ritz_closed_loop(&p->plant, &p->controller, &p->loop, &p->closed));
    assert_ok(ritz_state_space_check(&p->closed));
    assert_ok(ritz_state_space_poles(&p->closed, &p->num_poles, &p->pole));
    responder(&p->plant, to_hz, &p->G);
    responder(&p->controller, to_hz, &p->F);
    assert_ok(ritz_loop_responder(&p->loop, p->G, p->F, p->num_poles, p->pole,
                                  &p->H));
}

static void part(pair *p)
{
    ritz_responder_free(&p->H);
    ritz_responder_free(&p->G);
    ritz_responder_free(&p->F);
    ritz_loop_free(&p->loop);
    ritz_state_space_free(&p->plant);
    ritz_state_space_free(&p->controller);
    ritz_state_space_free(&p->closed);
    free(p->pole);
    *p = (pair){0};
}

/* K / (s (s + 1)(s + 2) + K), which a gain of 6 brings to the axis at
   sqrt 2 rad/s. */
static void a_loop_of_three_lags_has_the_margins_of_the_textbook(void **state)
{
    const ritz_grid grid = {.from_hz = 0.01,
                            .to_hz = 1.0,
                            .count = 50,
                            .log = true,
                            .refine = true};
    ritz_margins m = {0};
    RITZ_OWN(ritz_response) r = {0};
    pair p = {0};

    (void)state;
    third_order(&p.plant);
    gain(1.0, "y", "u", &p.controller);
    join(&p, false, 1.0);
    assert_ok(ritz_responder_sample(p.H, &grid, &r));
    for (int64_t k = 0; k < r.count; k++) {
        double _Complex s = 2.0 * pi * r.hertz[k] * (double _Complex)_Complex_I;
        double _Complex due = 1.0 / (s * (s + 1.0) * (s + 2.0) + 1.0);

        /* two solves and a division */
        assert_near(cabs(r.H[k] - due), 0.0, 1e-13 * cabs(due));
    }
    assert_ok(ritz_loop_margins(&p.loop, p.G, p.F, r.count, r.hertz, &m));
    assert_near(m.gain_up, 6.0, 1e-12 * 6.0);
    assert_near(2.0 * pi * m.gain_up_hz, sqrt(2.0), 1e-12);
    assert_true(isnan(m.gain_down));
    /* |L| = 1 where x (x + 1)(x + 4) = 1, x = w^2: x = 0.198691, w = 0.445748;
       there 90 - atan w - atan w/2 degrees are left */
    assert_near(2.0 * pi * m.phase_hz, 0.4457479596, 1e-9);
    assert_near(m.phase,
                90.0 - (atan(0.4457479596) + atan(0.2228739798)) * 180 / pi,
                1e-5);
    part(&p);
}

static void a_gain_beyond_the_margin_makes_it_unstable(void **state)
{
    static const double gains[] = {5.999, 6.001};

    (void)state;
    for (int k = 0; k < 2; k++) {
        ritz_probe probe = {0};
        pair p = {0};

        third_order(&p.plant);
        gain(gains[k], "y", "u", &p.controller);
        join(&p, false, 1.0);
        assert_ok(ritz_probe_states(&p.closed, &probe));
        assert_int_equal(probe.verdict, k ? RITZ_UNSTABLE : RITZ_STABLE);
        part(&p);
        third_order(&p.plant);
        gain(-gains[k], "y", "u", &p.controller);
        join(&p, true, 1.0);
        assert_ok(ritz_probe_states(&p.closed, &probe));
        assert_int_equal(probe.verdict, k ? RITZ_UNSTABLE : RITZ_STABLE);
        part(&p);
    }
}

/* Velocity fed back is a damper: m s^2 + (c + g) s + k. */
static void velocity_feedback_is_a_damper(void **state)
{
    const double m = 2.0, c = 0.1, k = 50.0, g = 0.7;
    const double A[] = {0, 1, -k / m, -c / m};
    const double B[] = {0, 1 / m};
    const double C[] = {1, 0, 0, 1};
    const spaces_rows rows = {2, 1, 2, A, B, C, NULL, NULL};
    const ritz_grid grid = {
        .from_hz = 0.1, .to_hz = 3.0, .count = 20, .refine = true};
    RITZ_OWN(ritz_response) r = {0};
    double _Complex due = 0.0;
    pair p = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &p.plant));
    named(p.plant.input, 0, "force");
    named(p.plant.output, 0, "x");
    named(p.plant.output, 1, "v");
    gain(g, "v", "force", &p.controller);
    join(&p, false, 3.0);
    assert_ok(ritz_responder_sample(p.H, &grid, &r));
    for (int64_t j = 0; j < r.count; j++) {
        double w = 2.0 * pi * r.hertz[j];

        due = 1.0 / (k - m * w * w + (c + g) * w * (double _Complex)_Complex_I);
        /* where the open loop is 8 times higher, so much of it cancels */
        assert_near(cabs(r.H[2 * j] - due), 0.0, 1e-13 * 8 / k / 0.08);
    }
    due = -0.2 + sqrt(25.0 - 0.04) * (double _Complex)_Complex_I;
    assert_int_equal(p.num_poles, 2);
    assert_near(cabs(p.pole[0] - due), 0.0, 1e-14 * 5);
    part(&p);
}

/* Numbers that look random between -1 and 1. */
static double number(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

/* A stable model of n states, m inputs and q outputs, with all its matrices. */
static void random_space(int64_t n, int64_t m, int64_t q, bool mass,
                         uint64_t seed, ritz_state_space *out)
{
    double A[64], B[64], C[64], D[64], E[64];
    const spaces_rows rows = {n, m, q, A, B, C, D, mass ? E : NULL};

    for (int k = 0; k < 64; k++) {
        A[k] = number(&seed);
        B[k] = number(&seed);
        C[k] = number(&seed);
        D[k] = number(&seed);
        E[k] = 0.1 * number(&seed);
    }
    for (int64_t k = 0; k < n; k++) {
        A[k + k * n] -= 4.0;
        E[k + k * n] += 1.0;
    }
    assert_ok(spaces_make(&rows, out));
}

/* Of 2 x 3 with feedthrough on both sides: in frequency and in states. */
static void both_ways_close_the_same_loop(void **state)
{
    const ritz_grid grid = {.from_hz = 0.01, .to_hz = 2.0, .count = 40};

    (void)state;
    for (int k = 0; k < 4; k++) {
        const char *const out[] = {"a", "b", "c"}, *const in[] = {"p", "q"};
        RITZ_OWN(ritz_response) by_loop = {0}, by_states = {0};
        pair p = {0};

        random_space(6, 2, 3, k & 1, 7, &p.plant);
        random_space(4, 2, 2, k & 2, 11, &p.controller);
        for (int j = 0; j < 3; j++)
            named(p.plant.output, j, out[j]);
        for (int j = 0; j < 2; j++) {
            named(p.plant.input, j, in[j]);
            named(p.controller.input, j, out[2 - j]);
            named(p.controller.output, j, in[1 - j]);
        }
        join(&p, k == 3, 2.0);
        assert_int_equal(p.loop.measured[0], 2);
        assert_int_equal(p.loop.driven[0], 1);
        assert_ok(ritz_responder_sample(p.H, &grid, &by_loop));
        assert_ok(states_response(&p.closed, &grid, &by_states));
        assert_int_equal(by_states.count, by_loop.count);
        for (int64_t j = 0; j < 6 * by_loop.count; j++) /* well conditioned */
            assert_near(cabs(by_loop.H[j] - by_states.H[j]), 0.0, 1e-12);
        assert_string_equal(by_loop.output[2], "c");
        assert_string_equal(by_states.input[1], "q");
        part(&p);
    }
}

/* (I + L)^-1 (I + L) = I, and the largest of L by its definition. */
static void sensitivity_is_the_inverse_of_the_return_difference(void **state)
{
    const double _Complex G[] = {1.0, 2.0, 3.0, 4.0}, F[] = {0.5, 0, 0, 0.25};
    int64_t measured[] = {0, 1}, driven[] = {0, 1};
    const ritz_loop loop = {2, measured, 2, driven, false};
    ritz_loop_values values = {0};
    double _Complex H[4];

    (void)state;
    assert_ok(ritz_loop_at(&loop, 2, 2, G, F, H, &values));
    /* I + F G = [1.5 1; 0.75 2], its inverse [2 -1; -0.75 1.5] / 2.25 */
    assert_near(creal(H[0]), (2.0 - 1.5) / 2.25, 4 * DBL_EPSILON);
    assert_near(creal(H[1]), (-1.0 + 3.0) / 2.25, 4 * DBL_EPSILON);
    assert_near(creal(H[2]), (6.0 - 3.0) / 2.25, 8 * DBL_EPSILON);
    assert_near(creal(H[3]), (-3.0 + 6.0) / 2.25, 8 * DBL_EPSILON);
    assert_true(isnan(creal(values.gain)));
    /* sigma^2 of [2 -1; -0.75 1.5]: trace 7.8125, determinant 2.25^2 */
    assert_near(values.sensitivity,
                sqrt((7.8125 + sqrt(7.8125 * 7.8125 - 4 * 5.0625)) / 2) / 2.25,
                8 * DBL_EPSILON);
}

static void loops_without_answer_are_refused(void **state)
{
    const double one = 1.0;
    const spaces_rows rows = {0, 1, 1, NULL, NULL, NULL, &one, NULL};
    ritz_state_space plant = {0}, controller = {0}, closed = {0};
    ritz_io outer, inner;
    RITZ_OWN(ritz_loop) loop = {0};
    const char *const both[] = {"y=e"}, *const none[] = {"y=force"},
                      *const bad[] = {"y"}, *const twice[] = {"y=e", "y=e"};

    (void)state;
    assert_ok(spaces_make(&rows, &plant));
    named(plant.input, 0, "force");
    named(plant.output, 0, "y");
    gain(-1.0, "e", "force", &controller);
    outer = ends_of(&plant);
    inner = ends_of(&controller);
    assert_fails(ritz_loop_match(&outer, &inner, 0, NULL, &loop),
                 RITZ_ERR_ARGUMENT,
                 "the plant has no output 'e' for the controller");
    assert_fails(ritz_loop_match(&outer, &inner, 1, none, &loop),
                 RITZ_ERR_ARGUMENT, "'y=force' joins no output of the plant");
    assert_fails(ritz_loop_match(&outer, &inner, 1, bad, &loop),
                 RITZ_ERR_ARGUMENT, "'y' is not of the form OUT=IN");
    assert_fails(ritz_loop_match(&outer, &inner, 2, twice, &loop),
                 RITZ_ERR_ARGUMENT, "'e' of the controller is connected twice");
    assert_ok(ritz_loop_match(&outer, &inner, 1, both, &loop));
    assert_fails(ritz_closed_loop(&plant, &controller, &loop, &closed),
                 RITZ_ERR_SINGULAR, "form a loop that has no solution");
    loop.measured[0] = 1;
    assert_fails(ritz_closed_loop(&plant, &controller, &loop, &closed),
                 RITZ_ERR_ARGUMENT, "the plant has no output 2");
    ritz_state_space_free(&plant);
    ritz_state_space_free(&controller);
}

/* One resonance: 1 / (2 zeta sqrt(1 - zeta^2)), wherever the points lie. */
/* Ends of u1, ... and y1, ..., as nobody named them; or of other first names. */
static ritz_io ends_called(int64_t count, char (*u)[RITZ_NAME_SIZE],
                           char (*y)[RITZ_NAME_SIZE])
{
    return (ritz_io){
        .num_inputs = count, .num_outputs = count, .input = u, .output = y};
}

static void
signals_that_nobody_named_are_joined_if_there_is_one_way(void **state)
{
    char u[2][RITZ_NAME_SIZE] = {"u1", "u2"},
         y[2][RITZ_NAME_SIZE] = {"y1", "y2"};
    char force[1][RITZ_NAME_SIZE] = {"force"}, tip[1][RITZ_NAME_SIZE] = {"tip"};
    const ritz_io one = ends_called(1, u, y), two = ends_called(2, u, y),
                  named = ends_called(1, force, tip);
    const ritz_io *const pairs[][2] = {
        {&one, &one}, {&named, &one}, {&one, &named}};
    const char *const words[] = {"y1=u1", "y1=u1"};
    RITZ_OWN(ritz_loop) loop = {0};

    (void)state;
    for (int k = 0; k < 3; k++) {
        assert_ok(ritz_loop_match(pairs[k][0], pairs[k][1], 0, NULL, &loop));
        assert_int_equal(loop.measured[0], 0);
        assert_int_equal(loop.driven[0], 0);
        ritz_loop_free(&loop);
    }
    for (int k = 1; k <= 2; k++) {
        assert_ok(ritz_loop_match(&one, &one, k, words, &loop));
        assert_int_equal(loop.measured[0] + loop.driven[0], 0);
        ritz_loop_free(&loop);
    }
    assert_fails(ritz_loop_match(&named, &named, 0, NULL, &loop),
                 RITZ_ERR_ARGUMENT, "the plant has no output 'force'");
    assert_fails(ritz_loop_match(&two, &two, 0, NULL, &loop), RITZ_ERR_ARGUMENT,
                 "both are u1, ... and y1, ...; name the signals of one of "
                 "them otherwise: --input-names and --output-names");
    assert_fails(ritz_loop_match(&two, &one, 1, words, &loop),
                 RITZ_ERR_ARGUMENT,
                 "'y1=u1' can be read both ways: plant and controller have "
                 "both names; name the signals of one of them otherwise");
}

static void a_peak_is_found_between_points(void **state)
{
    const double zeta = 1e-4, w = 2.0 * pi;
    const double A[] = {0, 1, -w * w, -2 * zeta * w};
    const double B[] = {0, w * w};
    const double C[] = {1, 0};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    const ritz_grid grids[] = {
        {.from_hz = 0.1, .to_hz = 3.0, .count = 20, .refine = true},
        {.from_hz = 0.1, .to_hz = 3.0, .count = 20}};
    RITZ_OWN(ritz_state_space) model = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &model));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_responder) *r = NULL;
        RITZ_OWN(ritz_response) points = {0};
        double hertz = 0.0, value = 0.0;

        responder(&model, 3.0, &r);
        assert_ok(ritz_responder_sample(r, &grids[k], &points));
        assert_ok(ritz_singular_peak(&points, NULL, r, &hertz, &value));
        assert_near(value * 2 * zeta * sqrt(1 - zeta * zeta), 1.0, 1e-9);
        /* flat on top: sqrt(eps) of its width; n = 2 states and eps / zeta */
        assert_near(hertz, sqrt(1 - 2 * zeta * zeta), 1e-10);
    }
}

/* What scales make of a model of 6 states, 2 inputs and 3 outputs. */
static void scale(const double *limit, const double *size,
                  ritz_state_space *model)
{
    for (int64_t j = 0; j < 2; j++) {
        for (int64_t i = 0; i < 6; i++)
            ritz_dense_col(&model->B, j)[i] *= size[j];
        for (int64_t i = 0; i < 3; i++)
            ritz_dense_col(&model->D, j)[i] *= size[j] / limit[i];
    }
    for (int64_t j = 0; j < 6; j++)
        for (int64_t i = 0; i < 3; i++)
            ritz_dense_col(&model->C, j)[i] /= limit[i];
}

/* Found by an independent algorithm, of a Hamiltonian [Bruinsma1990]. */
static void the_peak_of_several_channels_is_the_h_infinity_norm(void **state)
{
    const ritz_grid grid = {
        .from_hz = 1e-4, .to_hz = 5.0, .count = 200, .refine = true};
    const double limit[] = {0.5, nan(""), 2.0}, by[] = {0.5, 1.0, 2.0};
    const double size[] = {3.0, 1.0}, one[] = {1.0, 1.0, 1.0};
    const ritz_scales scales = {limit, size};

    (void)state;
    for (int scaled = 0; scaled < 2; scaled++) {
        RITZ_OWN(ritz_state_space) model = {0}, same = {0};
        RITZ_OWN(ritz_responder) *r = NULL;
        RITZ_OWN(ritz_response) points = {0};
        ritz_norm norm = {0};
        double hertz = 0.0, value = 0.0;

        random_space(6, 2, 3, false, 3, &model);
        random_space(6, 2, 3, false, 3, &same);
        scale(scaled ? by : one, scaled ? size : one, &same);
        responder(&model, 5.0, &r);
        assert_ok(ritz_responder_sample(r, &grid, &points));
        assert_ok(ritz_singular_peak(&points, scaled ? &scales : NULL, r,
                                     &hertz, &value));
        assert_ok(ritz_norm_infinity(&same, 1e-10, &norm));
        /* it may lie at 0 Hz, where the range does not begin: flat there */
        assert_near(value, norm.value, 1e-6 * norm.value);
    }
}

/* Squares of all add up to those of H; kept in the response. */
static void all_values_are_there_and_descend(void **state)
{
    const ritz_grid grid = {.from_hz = 0.1, .to_hz = 5.0, .count = 7};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_response) r = {0};

    (void)state;
    random_space(6, 2, 3, false, 3, &model);
    assert_ok(states_response(&model, &grid, &r));
    assert_ok(ritz_singular_of(NULL, &r));
    assert_ok(ritz_singular_of(NULL, &r)); /* once more: in their place */
    assert_int_equal(r.num_singular, 2);
    for (int64_t k = 0; k < r.count; k++) {
        double sum = 0.0, squares = 0.0;

        for (int64_t j = 0; j < 2; j++)
            squares += pow(r.singular[2 * k + j], 2);
        for (int64_t j = 0; j < 6; j++)
            sum += pow(cabs(r.H[6 * k + j]), 2);
        assert_near(squares, sum, 32 * DBL_EPSILON * sum);
        assert_true(r.singular[2 * k] >= r.singular[2 * k + 1]);
    }
}

static void a_peak_that_nothing_damps_is_infinite(void **state)
{
    static const double A[] = {0, 1, -39.0, 0}, B[] = {0, 1}, C[] = {1, 0};
    static const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    const ritz_grid grid = {.from_hz = 0.1, .to_hz = 3.0, .count = 20};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_responder) *r = NULL;
    RITZ_OWN(ritz_response) points = {0};
    double hertz = 0.0, value = 0.0;

    (void)state;
    assert_ok(spaces_make(&rows, &model));
    responder(&model, 3.0, &r);
    assert_ok(ritz_responder_sample(r, &grid, &points));
    assert_ok(ritz_singular_peak(&points, NULL, r, &hertz, &value));
    assert_true(isinf(value));
    assert_near(hertz, sqrt(39.0) / (2 * pi), 1e-8);
    assert_ok(ritz_singular_peak(&points, NULL, NULL, &hertz, &value));
    assert_true(isfinite(value));
}

static ritz_status forget(pair *p)
{
    const ritz_grid grid = {
        .from_hz = 0.1, .to_hz = 1.0, .count = 5, .refine = true};
    ritz_status status = RITZ_OK;
    ritz_io plant = ends_of(&p->plant), control = ends_of(&p->controller);
    RITZ_OWN(ritz_loop) loop = {0};
    RITZ_OWN(ritz_state_space) closed = {0};
    ritz_responder *H = NULL;
    RITZ_OWN(ritz_response) r = {0};
    ritz_margins margins;
    double hertz, value;

    RITZ_TRY(ritz_loop_match(&plant, &control, 0, NULL, &loop));
    RITZ_TRY(ritz_closed_loop(&p->plant, &p->controller, &loop, &closed));
    RITZ_TRY(ritz_loop_responder(&loop, p->G, p->F, p->num_poles, p->pole, &H));
    RITZ_TRY(ritz_responder_sample(H, &grid, &r));
    RITZ_TRY(ritz_singular_of(NULL, &r));
    RITZ_TRY(ritz_singular_peak(&r, NULL, NULL, &hertz, &value));
    RITZ_TRY(ritz_loop_margins(&loop, p->G, p->F, 2, r.hertz, &margins));
done:
    ritz_responder_free(&H);
    return status;
}

static void loops_survive_every_allocation(void **state)
{
    pair p = {0};

    (void)state;
    third_order(&p.plant);
    gain(1.0, "y", "u", &p.controller);
    join(&p, false, 1.0);
    assert_survives_every_allocation(forget(&p));
    part(&p);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_loop_of_three_lags_has_the_margins_of_the_textbook),
    cmocka_unit_test(a_gain_beyond_the_margin_makes_it_unstable),
    cmocka_unit_test(velocity_feedback_is_a_damper),
    cmocka_unit_test(both_ways_close_the_same_loop),
    cmocka_unit_test(sensitivity_is_the_inverse_of_the_return_difference),
    cmocka_unit_test(loops_without_answer_are_refused),
    cmocka_unit_test(signals_that_nobody_named_are_joined_if_there_is_one_way),
    cmocka_unit_test(a_peak_is_found_between_points),
    cmocka_unit_test(the_peak_of_several_channels_is_the_h_infinity_norm),
    cmocka_unit_test(all_values_are_there_and_descend),
    cmocka_unit_test(a_peak_that_nothing_damps_is_infinite),
    cmocka_unit_test(loops_survive_every_allocation),
};

TEST_MODULE(closed_loop, tests, NULL, NULL)
