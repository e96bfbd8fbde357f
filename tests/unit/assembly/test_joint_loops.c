/*
 * Joints that form loops: how many motions are left of rigid bodies, what
 * elastic ones do, and loops that do not close.
 */
#include "testing.h"

#include "linkage.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

static ritz_status assemble(const linkage *l, const ritz_method *method,
                            const char *at, ritz_configuration *out)
{
    double setting[8] = {0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(stage_of_linkage(l, method, &scene, &stage));
    assert_true(scene.num_sweeps <= 8);
    assert_ok(ritz_scene_settings(&scene, at, setting));
    return ritz_stage_assemble(&stage, setting, out);
}

/* Of rigid links rows say things twice; of elastic ones each says its own. */
static void assert_mobility(const linkage *l, const char *at, int64_t rank,
                            int64_t motions)
{
    RITZ_OWN(ritz_configuration) c = {0};

    assert_ok(assemble(l, &ritz_method_rigid, at, &c));
    assert_int_equal(c.rank, rank);
    assert_int_equal(c.num_rigid, 6 + motions);
    assert_int_equal(c.K.ncol, 6 + motions);
    ritz_configuration_free(&c);
    assert_ok(assemble(l, &ritz_method_full, at, &c));
    assert_int_equal(c.num_rigid, 6 + motions);
}

/* Ground A, crank B, coupler C, rocker D: a parallelogram. */
static const linkage four_bar = {
    .count = 4,
    .end = {{3, 0, 0}, {0, 1, 0}, {3, 0, 0}, {0, 1, 0}},
    .joints =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, 1]}\n",
};

/*
 * One motion, as the fourth hinge states but two things new: rank 17 of 20.
 * Where all links lie on one line there is a second motion, to first order.
 */
static void a_four_bar_linkage_has_one_motion(void **state)
{
    (void)state;
    assert_mobility(&four_bar, "", 17, 1);
    assert_mobility(&four_bar, "a=50,b=-50,c=50,d=-50", 17, 1);
    assert_mobility(&four_bar, "a=-107.25,b=107.25,c=-107.25,d=107.25", 17, 1);
    assert_mobility(&four_bar, "a=90,b=-90,c=90,d=-90", 16, 2);
}

/* Opposite hinges of a parallelogram turn alike: half the spring in each. */
static void springs_in_a_loop_share_its_motion(void **state)
{
    static const char one[] =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 4, damping: 2}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, 1]}\n";
    static const char two[] =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 1, damping: 0.5}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 1, damping: 0.5}\n"
        "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 1, damping: 0.5}\n"
        "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 1, damping: 0.5}\n";
    linkage l = four_bar;
    RITZ_OWN(ritz_configuration) a = {0}, b = {0};

    (void)state;
    l.joints = one;
    assert_ok(assemble(&l, &ritz_method_rigid, "a=50,b=-50,c=50,d=-50", &a));
    l.joints = two;
    assert_ok(assemble(&l, &ritz_method_rigid, "a=50,b=-50,c=50,d=-50", &b));
    assert_int_equal(a.num_rigid, 6);
    assert_int_equal(a.K.ncol, 7);
    /* 24 coordinates scaled to unit mass, of a few dozen roundings each */
    assert_near(b.lambda[6], a.lambda[6], 1e3 * DBL_EPSILON * a.lambda[6]);
    assert_near(ritz_dense_col(&a.D, 6)[6], 0.5 * a.lambda[6],
                1e3 * DBL_EPSILON * a.lambda[6]);
    assert_near(ritz_dense_col(&b.D, 6)[6], 0.5 * a.lambda[6],
                1e3 * DBL_EPSILON * a.lambda[6]);
}

/*
 * Slider A, crank B of r = 1, rod C of l = 2.5: at crank angle a the rod stands
 * at -asin(r sin(a) / l), its end at x = r cos(a) + sqrt(l^2 - r^2 sin(a)^2).
 */
static void a_slider_crank_closes_and_has_one_motion(void **state)
{
    static const char joints[] =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: c, between: [C/g2, D/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: s, between: [A/g1, D/g1], type: slider, axis: [1, 0, 0]}\n";
    const linkage crank = {
        .count = 4,
        .end = {{5, 0, 0}, {1, 0, 0}, {2.5, 0, 0}, {0.5, 0.2, 0}},
        .joints = joints};
    ritz_configuration none = {0};
    char at[200];

    (void)state;
    for (int k = 1; k < 12; k++) {
        double a = 17.0 + 30.0 * k;
        double rod = -asin(sin(a * pi / 180.0) / 2.5) * 180.0 / pi;
        double x = cos(a * pi / 180.0) + 2.5 * cos(rod * pi / 180.0);

        snprintf(at, sizeof at, "a=%.12g,b=%.12g,c=%.12g,s=%.12g", a, rod - a,
                 -rod, x);
        assert_mobility(&crank, at, 17, 1);
        snprintf(at, sizeof at, "a=%.12g,b=%.12g,c=%.12g,s=%.12g", a, rod - a,
                 -rod, x + 0.01);
        assert_fails(assemble(&crank, &ritz_method_rigid, at, &none),
                     RITZ_ERR_ARGUMENT,
                     "linkage.yaml:11:3: joint 's': closes a loop of joints "
                     "that does not meet: 'A/g1' and 'D/g1' stand 0.01 apart");
        snprintf(at, sizeof at, "a=%.12g,b=%.12g,c=%.12g,s=%.12g", a, rod - a,
                 0.1 - rod, x);
        assert_fails(assemble(&crank, &ritz_method_rigid, at, &none),
                     RITZ_ERR_ARGUMENT,
                     "joint 's': closes a loop of joints whose angles do not "
                     "agree: 'D' is turned otherwise against 'A' by the other "
                     "joints");
    }
}

/* Five digits do not close a loop to rounding, but take no motion from it. */
static void settings_of_few_digits_leave_every_motion(void **state)
{
    static const char joints[] =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 1, 1]}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 1, 1]}\n"
        "- {name: c, between: [C/g2, D/g1], type: hinge, axis: [0, 1, 1]}\n"
        "- {name: s, between: [A/g1, D/g1], type: slider, axis: [1, 0, 0]}\n";
    const linkage crank = {
        .count = 4,
        .end = {{5, 0, 0}, {1, 0, 0}, {2.5, 0, 0}, {0.5, 0.2, 0}},
        .joints = joints};

    (void)state;
    assert_mobility(&crank, "a=35.27,b=-48.6243,c=13.3544,s=3.2488", 17, 1);
    assert_mobility(&crank, "a=213.4,b=-200.6796,c=-12.7205,s=1.6038", 17, 1);
}

/*
 * A cross in a loop with two hinges about its axes: what they state is the
 * same, both motions stay.
 */
static void a_universal_joint_closes_with_its_hinges(void **state)
{
    static const char joints[] =
        "- {name: p, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: q, between: [B/g1, C/g1], type: hinge, axis: [1, 1, 0]}\n"
        "- {name: u, between: [A/g1, C/g1], type: universal, axes: "
        "[[0, 0, 1], [1, 1, 0]]}\n";
    const linkage cross = {.count = 3,
                           .end = {{3, 0, 0}, {0.1, 1, 0}, {0.2, 0.3, 0.4}},
                           .joints = joints};
    ritz_configuration none = {0};

    (void)state;
    assert_mobility(&cross, "p=20,q=-40,u=20,u.2=-40", 10, 2);
    assert_fails(
        assemble(&cross, &ritz_method_rigid, "p=20,q=-40,u=-40,u.2=20", &none),
        RITZ_ERR_ARGUMENT,
        "joint 'u': closes a loop of joints whose "
        "angles do not agree");
}

/*
 * A crank B on a hinge about z, a rocker D on one about x, a rod C between them
 * on spherical joints: the crank moves it all, and the rod spins. The rod's
 * deck has the axes of the crank, so R' (end of rocker - end of crank).
 */
static void a_spatial_linkage_takes_the_turn_that_is_left(void **state)
{
    static const char joints[] =
        "- {name: s, between: [B/g2, C/g1], type: spherical}\n"
        "- {name: t, between: [C/g2, D/g2], type: spherical%s}\n"
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: b, between: [A/g2, D/g1], type: hinge, axis: [1, 0, 0]}\n";
    const double a = 40.0 * pi / 180.0, b = 25.0 * pi / 180.0;
    const double d[3] = {4.0 - cos(a), 2.0 * cos(b) - sin(a), 2.0 * sin(b)};
    char text[500];
    linkage l = {.count = 4,
                 .end = {{4, 0, 0},
                         {1, 0, 0},
                         {cos(a) * d[0] + sin(a) * d[1],
                          cos(a) * d[1] - sin(a) * d[0], d[2]},
                         {0, 2, 0}},
                 .joints = text};
    ritz_configuration none = {0};

    (void)state;
    snprintf(text, sizeof text, joints, "");
    assert_mobility(&l, "a=40,b=25", 16, 2);
    snprintf(text, sizeof text, joints, ", state: locked");
    assert_mobility(&l, "a=40,b=25", 18, 0);
    assert_fails(assemble(&l, &ritz_method_rigid, "a=40,b=26", &none),
                 RITZ_ERR_ARGUMENT,
                 "closes a loop of joints that does not "
                 "meet: 'C/g2' and 'D/g2' stand 0.0349");
}

/* Two balls leave the turn about the line through both. */
static void two_spherical_joints_make_a_hinge(void **state)
{
    static const char balls[] =
        "- {name: s, between: [A/g1, B/g1], type: spherical}\n"
        "- {name: t, between: [A/g2, B/g2], type: spherical}\n";
    static const char hinge[] =
        "- {name: s, between: [A/g1, B/g1], type: hinge, axis: [1, 2, 2]}\n";
    linkage l = {.count = 2, .end = {{1, 2, 2}, {1, 2, 2}}, .joints = balls};
    RITZ_OWN(ritz_configuration) one = {0}, two = {0};

    (void)state;
    assert_mobility(&l, "", 5, 1);
    assert_ok(assemble(&l, &ritz_method_rigid, "", &one));
    l.joints = hinge;
    assert_ok(assemble(&l, &ritz_method_rigid, "", &two));
    assert_int_equal(one.K.ncol, two.K.ncol);
}

/* A bushing beside a hinge is the cage of that hinge, and holds no position. */
static void a_bushing_in_a_loop_is_a_spring(void **state)
{
    static const char cage[] =
        "- {name: p, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1], "
        "state: caged, stiffness: 7}\n";
    static const char both[] =
        "- {name: p, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: q, between: [B/g1, A/g1], type: bushing, "
        "stiffness: [9, 9, 9, 5, 5, 7]}\n";
    linkage l = {.count = 2, .end = {{1, 2, 2}, {0, 1, 2}}, .joints = cage};
    ritz_configuration one = {0}, two = {0};

    (void)state;
    assert_ok(assemble(&l, &ritz_method_full, "p=0", &one));
    l.joints = both;
    assert_ok(assemble(&l, &ritz_method_full, "p=0", &two));
    assert_int_equal(one.K.ncol, two.K.ncol);
    for (int64_t k = 0; k < one.K.ncol; k++)
        assert_near(two.lambda[k], one.lambda[k],
                    1e3 * DBL_EPSILON * one.lambda[one.K.ncol - 1]);
    ritz_configuration_free(&one);
    ritz_configuration_free(&two);
    assert_fails(assemble(&l, &ritz_method_full, "p=5", &one),
                 RITZ_ERR_ARGUMENT,
                 "joint 'q': closes a loop of joints whose "
                 "angles do not agree");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_four_bar_linkage_has_one_motion),
    cmocka_unit_test(springs_in_a_loop_share_its_motion),
    cmocka_unit_test(a_slider_crank_closes_and_has_one_motion),
    cmocka_unit_test(settings_of_few_digits_leave_every_motion),
    cmocka_unit_test(a_universal_joint_closes_with_its_hinges),
    cmocka_unit_test(a_spatial_linkage_takes_the_turn_that_is_left),
    cmocka_unit_test(two_spherical_joints_make_a_hinge),
    cmocka_unit_test(a_bushing_in_a_loop_is_a_spring),
};

TEST_MODULE(joint_loops, tests, NULL, NULL)
