/* Joints that move, against closed forms: a pendulum that keeps its plane in
   space, and a body whose inertia changes. */
#include <ritz/swept.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include "bodies.h"
#include "scenes.h"
#include "swept_scenes.h"
#include "testing.h"

#include <ritz/simulate.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int64_t in_plane[3] = {1, 2, 6};

/* Grid 1 has a small mass. Grid 2, at a distance of 1, has the mass 2 on
   springs of 8 along x and 8 b along y: 2 and 2 sqrt(b) rad/s. */
static ritz_status make_oscillator(double b, ritz_component *out)
{
    const double c = -8.0, d = 8.0 * b;
    const int64_t row[] = {0, 3, 0, 3, 1, 1, 1, 2, 2, 2, 4, 4, 4},
                  col[] = {0, 3, 3, 0, 1, 2, 4, 1, 2, 4, 1, 2, 4},
                  own[] = {0, 1, 2, 3, 4};
    const double val[] = {8, 8, c, c, d, d, -d, d, d, -d, -d, -d, d},
                 mass[] = {0.1, 0.1, 0.1, 2, 2};
    RITZ_OWN(ritz_component) body = {.num_dofs = 5};

    RITZ_CHECK_NEW(body.dof, 5);
    for (int k = 0; k < 5; k++)
        body.dof[k] = (ritz_dof){1 + k / 3, k < 3 ? in_plane[k] : k - 2};
    RITZ_CHECK(ritz_sparse_from_triplets(5, 5, 13, row, col, val, &body.K));
    RITZ_CHECK(ritz_sparse_from_triplets(5, 5, 5, own, own, mass, &body.M));
    RITZ_CHECK_NEW(body.grids.id, 2);
    RITZ_CHECK_NEW(body.grids.position, 6);
    RITZ_CHECK_NEW(body.grids.frame, 2);
    RITZ_CHECK_NEW(body.grids.axes, 9);
    body.grids.count = 2;
    body.grids.num_frames = 1;
    body.grids.id[0] = 1;
    body.grids.id[1] = 2;
    body.grids.position[3] = 1.0;
    for (int k = 0; k < 3; k++)
        body.grids.axes[4 * k] = 1.0;
    RITZ_CHECK(add_port(&body, "g1", 1));
    RITZ_CHECK(add_port(&body, "tip", 2));
    RITZ_CHECK(ritz_component_settle(&body, false));
    RITZ_MOVE(*out, body);
    return RITZ_OK;
}

/* A stage of bodies A and B on a joint, with keys behind it. */
static ritz_status join(const ritz_component body[2], const char *joint,
                        const char *keys, moving *out)
{
    RITZ_OWN(ritz_bodies) reduced = {0};
    char text[2000];

    snprintf(text, sizeof text,
             "scene: two\nplane: xy\ncomponents:\n"
             "  A: {model: a.h5, basis: full}\n"
             "  B: {model: b.h5, basis: full}\n"
             "joints:\n"
             "  - {name: p, between: [A/g1, B/g1], %s}\n%s",
             joint, keys);
    RITZ_CHECK(ritz_scene_parse("two.yaml", text, &out->scene));
    RITZ_CHECK(ritz_bodies_new(2, &reduced));
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(
            reduce_with(&body[k], &ritz_method_full, -1, &reduced.item[k]));
    return ritz_stage_from(&out->scene, reduced.item, &out->stage);
}

/* x0 for displacements or velocities u of the coordinates of all bodies. */
static ritz_status modal_start(const moving *m, double setting, const double *u,
                               double **out)
{
    RITZ_OWN(ritz_configuration) c = {0};

    RITZ_CHECK(ritz_stage_assemble(&m->stage, &setting, &c));
    if (!m->stage.first)
        return RITZ_ERR_ARGUMENT; /* there are bodies */
    RITZ_CHECK_NEW(*out, c.K.ncol);
    for (int64_t j = 0; j < c.K.ncol; j++)
        for (int64_t k = 0; k < c.num_blocks; k++) {
            const ritz_dense *M = &m->stage.body[k].M;
            const double *own = u + m->stage.first[k];

            for (int64_t a = 0; a < M->ncol; a++)
                for (int64_t b = 0; b < M->ncol; b++)
                    (*out)[j] += ritz_dense_col(&c.P[k], j)[a] *
                                 ritz_dense_col(M, b)[a] * own[b];
        }
    return RITZ_OK;
}

/* A pendulum on a hinge with a body so heavy that it hardly moves. The hinge
   turns from 10 degrees at 30 degrees a second. */
static ritz_status make_pendulum(double b, moving *m)
{
    RITZ_OWN(ritz_component) first = {0}, second = {0};
    ritz_component body[2];

    RITZ_CHECK(body_link(in_plane, 1.0, (double[]){1e10, 1e10, 0, 0}, &first));
    RITZ_CHECK(make_oscillator(b, &second));
    body[0] = first;
    body[1] = second;
    return join(body,
                "type: hinge, axis: [0, 0, 1], angles_deg: [10], "
                "state: locked",
                "outputs:\n"
                "  - {name: x, at: B/tip, component: 1}\n"
                "  - {name: y, at: B/tip, component: 2}\n"
                "  - {name: push, at: B/tip, component: 1, "
                "quantity: acceleration}\n"
                "inputs: [{name: f, at: B/tip, component: 2}]\n",
                m);
}

static const double pendulum_start = 10.0;
static const double deflected[8] = {0, 0, 0, 0, 0, 0, 1, 0};

static ritz_status swing(const moving *m, bool terms, double step,
                         ritz_simulation *out)
{
    const ritz_sweep_request asked = moving_sweep(&pendulum_start, 10.0, 100.0);
    ritz_simulation_request request = moving_request(3.0, step);
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN_ARRAY double *x0 = NULL;

    request.every = (int64_t)(0.1 / step + 0.5);
    RITZ_CHECK(modal_start(m, pendulum_start, deflected, &x0));
    request.x0 = x0;
    RITZ_CHECK(ritz_path_parse("10:100:3s", &path));
    RITZ_CHECK(ritz_stage_sweep(&m->stage, &asked, &model));
    RITZ_CHECK(ritz_simulate_swept(&model, &path, terms, &request, out));
    return RITZ_OK;
}

/* Largest error of the motion in a plane that is constant in space. With w = 2
   rad/s and the hinge turned by a it is x = cos a cos w t, y = -sin a cos w t
   along the axes of B, in which the plane turns; `turns` false: in which it
   does not, as without the terms. */
static double plane_error(const ritz_simulation *s, bool turns)
{
    double worst = 0.0;

    for (int64_t k = 0; k < s->count; k++) {
        const double t = s->seconds[k];
        const double a = turns ? RITZ_PI / 6.0 * t : 0.0;
        const double *y = s->y + 3 * k;

        worst = fmax(worst, fabs(y[0] - cos(a) * cos(2.0 * t)));
        worst = fmax(worst, fabs(y[1] + sin(a) * cos(2.0 * t)));
    }
    return worst;
}

static void a_pendulum_keeps_its_plane_in_space(void **state)
{
    RITZ_OWN(moving) m = {0};
    double last = 0.0;

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    for (int k = 0; k < 5; k++) { /* order 2 over four halvings */
        RITZ_OWN(ritz_simulation) s = {0};
        double error = 0.0;

        assert_ok(swing(&m, true, 0.05 / (1 << k), &s));
        error = plane_error(&s, true);
        if (k > 0)
            assert_near(last / error, 4.0, 0.1);
        last = error;
    }
    /* (w h)^2 / 12 of a phase of 6 rad, h = 0.05 / 16: 2e-5 */
    assert_true(last < 3e-5);
}

static void without_the_terms_the_plane_turns_with_the_body(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    assert_ok(swing(&m, false, 0.003125, &s));
    assert_true(plane_error(&s, false) < 3e-5);
    assert_true(plane_error(&s, true) > 0.9);
}

/* The sensor turns with its axes at a'. Along x it measures the second
   derivative of x = cos a' t cos w t. */
static void accelerations_are_those_of_the_coordinates(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    const double rate = RITZ_PI / 6.0;

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    assert_ok(swing(&m, true, 0.003125, &s));
    for (int64_t k = 0; k < s.count; k++) {
        const double t = s.seconds[k];
        const double due = -(rate * rate + 4.0) * cos(rate * t) * cos(2.0 * t) +
                           4.0 * rate * sin(rate * t) * sin(2.0 * t);

        assert_near(s.y[3 * k + 2], due, 3e-4); /* 4 times that of x, and 2
                                                   x' error */
    }
}

/* A mass slides from 1 to 2 along the arm of a ring of inertia 3. I w is
   conserved, with I = J + mu d^2 and mu = 2 1.5 / 3.5. The mass slides at a
   constant rate, since the forces of an accelerated one are left out. */
static ritz_status make_skater(moving *m)
{
    RITZ_OWN(ritz_component) first = {0}, second = {0};
    ritz_component body[2];

    RITZ_CHECK(body_link(in_plane, 1.0, (double[]){2.0, 3.0, 0, 0}, &first));
    RITZ_CHECK(body_link(in_plane, 1.0, (double[]){1.5, 0.1, 0, 0}, &second));
    body[0] = first;
    body[1] = second;
    return join(body,
                "type: slider, axis: [1, 0, 0], positions: [1], "
                "state: locked",
                "outputs: [{name: spin, at: A/g1, component: 6, quantity: "
                "velocity}]\n",
                m);
}

static double skater_inertia(double d)
{
    return 3.1 + 2.0 * 1.5 / 3.5 * d * d;
}

static ritz_status pull_mass(bool terms, double step, ritz_simulation *out)
{
    const double start = 1.0;
    const ritz_sweep_request asked = moving_sweep(&start, 1.0, 2.0);
    /* a unit spin about the centre of mass, at 1.5 / 3.5 of the way */
    const double c = 1.5 / 3.5, spin[6] = {0, -c, 1, 0, 1 - c, 1};
    ritz_simulation_request request = moving_request(2.5, step);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN_ARRAY double *v0 = NULL;

    RITZ_CHECK(make_skater(&m));
    RITZ_CHECK(modal_start(&m, 1.0, spin, &v0));
    request.v0 = v0;
    RITZ_CHECK(ritz_path_parse("1:2:2.5s", &path));
    RITZ_CHECK(ritz_stage_sweep(&m.stage, &asked, &model));
    return ritz_simulate_swept(&model, &path, terms, &request, out);
}

static void a_mass_that_slides_outwards_slows_the_spin(void **state)
{
    RITZ_OWN(ritz_simulation) s = {0}, naive = {0};
    const double before = skater_inertia(1.0);
    double worst = 0.0, wrong = 0.0;

    (void)state;
    assert_ok(pull_mass(true, 0.0025, &s));
    assert_ok(pull_mass(false, 0.0025, &naive));
    assert_string_equal(s.diagnostic[0], "position");
    for (int64_t k = 0; s.y && naive.y && k < s.count; k++) {
        const double I = skater_inertia(s.diagnosis[3 * k]);

        worst = fmax(worst, fabs(s.y[k] - before / I));
        wrong = fmax(wrong, fabs(naive.y[k] - sqrt(before / I)));
        assert_near(s.balance[k], 0.0, 1e-5); /* h^2 of rates of order 1 */
    }
    assert_true(s.count == 1001 && worst > 0.0 &&
                worst < 1e-5); /* h^2 of x''' of order 1 */
    /* without the terms energy is conserved, since T'M T is constant, and the
       momentum is not */
    assert_true(wrong < 1e-6);
}

static ritz_status swing_once(const moving *m)
{
    RITZ_OWN(ritz_simulation) s = {0};

    return swing(m, true, 0.1, &s);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(moving) m = {0};

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    assert_survives_allocations(7, swing_once(&m));
}

/* Knots that are whole turns apart would all be one position. */
static void whole_turns_have_the_knots_of_one(void **state)
{
    const double turns[] = {361.0, 1440.0, 3.6e6};
    const ritz_sweep_request part = moving_sweep(&pendulum_start, 10.0, 100.0);
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) expected = {0};

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    assert_ok(ritz_stage_sweep(&m.stage, &part, &expected));
    assert_true(ritz_dense_max(&expected.H) > 0.1);
    for (int k = 0; k < 3; k++) {
        const ritz_sweep_request asked =
            moving_sweep(&pendulum_start, 10.0, 10.0 + turns[k]);
        RITZ_OWN(ritz_swept_model) model = {0};

        assert_ok(ritz_stage_sweep(&m.stage, &asked, &model));
        assert_near((double)(model.count - 1) * model.spacing, 2.0 * RITZ_PI,
                    1e-12);
        ritz_dense_add(-1.0, &expected.G, &model.G);
        ritz_dense_add(-1.0, &expected.H, &model.H);
        assert_true(ritz_dense_max(&model.G) < 1e-9);
        assert_true(ritz_dense_max(&model.H) < 1e-9);
    }
}

/* The pendulum on a hinge that makes three turns, either way. */
static ritz_status whirl(const moving *m, double way, double step,
                         ritz_simulation *out)
{
    const double ends[2] = {10.0, 10.0 + way * 1080.0};
    const ritz_sweep_request asked = moving_sweep(
        &pendulum_start, fmin(ends[0], ends[1]), fmax(ends[0], ends[1]));
    ritz_simulation_request request = moving_request(6.0, step);
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN_ARRAY double *x0 = NULL;

    RITZ_CHECK(modal_start(m, pendulum_start, deflected, &x0));
    request.x0 = x0;
    RITZ_CHECK(
        ritz_path_parse(way > 0.0 ? "10:1090:6s" : "10:-1070:6s", &path));
    RITZ_CHECK(ritz_stage_sweep(&m->stage, &asked, &model));
    return ritz_simulate_swept(&model, &path, true, &request, out);
}

static void a_pendulum_keeps_its_plane_over_whole_turns(void **state)
{
    RITZ_OWN(moving) m = {0};

    (void)state;
    assert_ok(make_pendulum(1.0, &m));
    for (int side = 0; side < 2; side++) {
        const double way = side == 0 ? 1.0 : -1.0;
        double last = 0.0;

        for (int k = 0; k < 3; k++) {
            RITZ_OWN(ritz_simulation) s = {0};
            double worst = 0.0;

            assert_ok(whirl(&m, way, 0.01 / (1 << k), &s));
            for (int64_t i = 0; i < s.count; i++) {
                const double t = s.seconds[i], a = way * RITZ_PI * t;

                worst = fmax(worst, fabs(s.y[3 * i] - cos(a) * cos(2.0 * t)));
                worst =
                    fmax(worst, fabs(s.y[3 * i + 1] + sin(a) * cos(2.0 * t)));
            }
            if (k > 0)
                assert_near(last / worst, 4.0, 0.1);
            last = worst;
        }
        /* ((pi + 2) h)^2 / 12 of a phase of 31 rad, h = 0.0025: 4e-4 */
        assert_true(last < 6e-4);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(whole_turns_have_the_knots_of_one),
    cmocka_unit_test(a_pendulum_keeps_its_plane_over_whole_turns),
    cmocka_unit_test(a_pendulum_keeps_its_plane_in_space),
    cmocka_unit_test(without_the_terms_the_plane_turns_with_the_body),
    cmocka_unit_test(accelerations_are_those_of_the_coordinates),
    cmocka_unit_test(a_mass_that_slides_outwards_slows_the_spin),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(swept, tests, NULL, NULL)
