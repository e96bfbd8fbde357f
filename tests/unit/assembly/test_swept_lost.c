/* What the basis of a joint that moves does not span of states and forces at
   the start, against sums over the modes there. */
#include <ritz/swept.h>

#include "rigs.h"
#include "swept_scenes.h"
#include "testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { KEPT = 14, INSIDE = 9, OUTSIDE = 20 };

static const double rig_start = 20.0;

/* Two bodies in space on a locked hinge: 6 of 30 modes are rigid motions. The
   moments of `pair` are in equilibrium, the force of `f` is not. */
static ritz_status make_model(moving *m, ritz_swept_model *out)
{
    static const char joint[] =
        "  - {name: p, between: [A/g3, B/g1], type: hinge, axis: [0, 0, 1], "
        "angles_deg: [20], state: locked}\n"
        "inputs:\n"
        "  - {name: f, at: B/g3, component: 1}\n"
        "  - {name: pair, at: B/g3, component: 4, against: B/g1}\n"
        "outputs: [{name: y, at: B/g3, component: 2}]\n";
    ritz_sweep_request asked = moving_sweep(&rig_start, 20.0, 30.0);
    rig r = rig_of_chains(2);
    char text[RIG_TEXT];

    rig_scene(&r, joint, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &m->scene));
    rig_stage(&r, &m->scene, &ritz_method_full, -1, &m->stage);
    rig_free(&r);
    asked.modes = KEPT;
    return ritz_stage_sweep(&m->stage, &asked, out);
}

/* 3 of a mode that is kept, and 4 of one that is not. */
static void shares_are_those_of_the_modes_left_out(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    double x0[30] = {[INSIDE] = 3.0, [OUTSIDE] = 4.0};
    double v0[30] = {[INSIDE] = 4.0, [OUTSIDE] = 3.0};
    ritz_swept_lost lost;
    double a = 0.0, b = 0.0;

    (void)state;
    assert_ok(make_model(&m, &model));
    assert_ok(ritz_stage_assemble(&m.stage, &rig_start, &c));
    a = 9.0 * c.lambda[INSIDE];
    b = 16.0 * c.lambda[OUTSIDE];
    assert_ok(ritz_swept_lost_state(&model, x0, v0, &lost));
    /* the start is a knot: T is exact there up to rounding of the modes */
    assert_near(lost.displacement, 0.64, 1e-9);
    assert_near(lost.strain, b / (a + b), 1e-9);
    assert_near(lost.velocity, 0.36, 1e-9);
    assert_false(lost.all);
}

static void a_kept_mode_and_a_rigid_motion_lose_nothing(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    double kept[30] = {[INSIDE] = 1.0}, rigid[30] = {[2] = 1.0};
    double still[30] = {0.0};
    ritz_swept_lost lost;

    (void)state;
    assert_ok(make_model(&m, &model));
    assert_ok(ritz_swept_lost_state(&model, kept, rigid, &lost));
    assert_true(lost.displacement + lost.strain + lost.velocity < 1e-12);
    assert_ok(ritz_swept_lost_state(&model, rigid, NULL, &lost));
    assert_true(lost.displacement + lost.strain + lost.velocity < 1e-12);
    assert_ok(ritz_swept_lost_state(&model, still, NULL, &lost));
    assert_false(lost.all);
}

static ritz_status run_from(const ritz_swept_model *model, const double *x0,
                            const double *v0)
{
    ritz_simulation_request request = moving_request(0.1, 0.05);
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    request.x0 = x0;
    request.v0 = v0;
    RITZ_CHECK(ritz_path_parse("20:30:1s", &path));
    return ritz_simulate_swept(model, &path, true, &request, &s);
}

static void a_state_that_is_lost_as_a_whole_is_refused(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    double outside[30] = {[OUTSIDE] = 1.0}, kept[30] = {[INSIDE] = 1.0};

    (void)state;
    assert_ok(make_model(&m, &model));
    assert_fails(run_from(&model, outside, NULL), RITZ_ERR_ARGUMENT,
                 "nothing would move: the basis of 14 modes has no part of the "
                 "initial state");
    assert_fails(run_from(&model, NULL, outside), RITZ_ERR_ARGUMENT,
                 "nothing would move");
    assert_ok(run_from(&model, outside, kept));
    assert_ok(run_from(&model, NULL, NULL));
}

/* sum b^2 / lambda over the modes left out, relative to that over all. */
static void a_static_response_is_lost_as_its_modes_are(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    double all = 0.0, outside = 0.0, lost = 0.0;

    (void)state;
    assert_ok(make_model(&m, &model));
    assert_ok(ritz_stage_assemble(&m.stage, &rig_start, &c));
    for (int64_t k = c.num_rigid; k < c.K.ncol; k++) {
        const double b = ritz_dense_col(&c.io.B, 1)[k];

        all += b * b / c.lambda[k];
        outside += k < KEPT ? 0.0 : b * b / c.lambda[k];
    }
    assert_true(outside > 0.01 * all);
    assert_ok(ritz_swept_lost_force(&model, 1, &lost));
    assert_near(lost, outside / all, 1e-9);
    assert_ok(ritz_swept_lost_force(&model, 0, &lost));
    assert_true(isnan(lost)); /* rigid motions have no static response */
}

static ritz_status find_all(const ritz_swept_model *model)
{
    const double x0[30] = {[INSIDE] = 1.0};
    ritz_swept_lost lost;
    double share = 0.0;

    RITZ_CHECK(ritz_swept_lost_state(model, x0, x0, &lost));
    return ritz_swept_lost_force(model, 1, &share);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(moving) m = {0};
    RITZ_OWN(ritz_swept_model) model = {0};

    (void)state;
    assert_ok(make_model(&m, &model));
    assert_survives_every_allocation(find_all(&model));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(shares_are_those_of_the_modes_left_out),
    cmocka_unit_test(a_kept_mode_and_a_rigid_motion_lose_nothing),
    cmocka_unit_test(a_state_that_is_lost_as_a_whole_is_refused),
    cmocka_unit_test(a_static_response_is_lost_as_its_modes_are),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(swept_lost, tests, NULL, NULL)
