/*
 * Joints of plane models, compared with closed forms of two rigid links and
 * with the assembly at full order; bodies and joints that leave the plane are
 * refused.
 */
#include "testing.h"

#include "assembly/assembly.h"
#include "bodies.h"
#include "folder.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>

enum { PLANES = 3 };

/* For the planes yz, xz and xy: directions along u and v and about w. The
   rotation about w turns u towards v where `sign` is 1, v towards u where it is
   -1. */
static const struct {
    const char *name, *normal, *in;
    int64_t u, v, w;
    double sign;
} planes[PLANES] = {
    {"yz", "[1, 0, 0]", "[0, 2, 0]", 2, 3, 4, 1.0},
    {"xz", "[0, -3, 0]", "[1, 0, 0]", 1, 3, 5, -1.0},
    {"xy", "[0, 0, 1]", "[4, 0, 0]", 1, 2, 6, 1.0},
};

static ritz_status link_body(int p, double m, double J, double cu, double cv,
                             ritz_component *out)
{
    const int64_t direction[] = {planes[p].u, planes[p].v, planes[p].w};

    return body_link(direction, planes[p].sign, (double[]){m, J, cu, cv}, out);
}

/* Assemble bodies A and B with joint p at the setting `at`. */
static ritz_status join_bodies(const ritz_component body[2], const char *plane,
                               const char *joint, const char *at,
                               ritz_configuration *out)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_bodies) reduced = {0};
    double setting[2] = {0.0};
    char text[1000];

    snprintf(text, sizeof text,
             "scene: arm\nplane: %s\ncomponents:\n"
             "  A: {model: a.h5, basis: full}\n"
             "  B: {model: b.h5, basis: full}\njoints:\n"
             "  - {name: p, between: [A/g1, B/g1], %s}\n",
             plane, joint);
    RITZ_CHECK(ritz_scene_parse("arm.yaml", text, &scene));
    RITZ_CHECK(ritz_scene_settings(&scene, at, setting));
    RITZ_CHECK(ritz_bodies_new(2, &reduced));
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(
            reduce_with(&body[k], &ritz_method_full, -1, &reduced.item[k]));
    RITZ_CHECK(ritz_stage_from(&scene, reduced.item, &stage));
    return ritz_stage_assemble(&stage, setting, out);
}

static ritz_status join_links(int p, const char *joint, const char *at,
                              ritz_configuration *out)
{
    ritz_component body[2] = {0};
    ritz_status status = link_body(p, 2.0, 0.5, 0.6, 0.2, &body[0]);

    if (status == RITZ_OK)
        status = link_body(p, 3.0, 4.0, -0.4, 0.9, &body[1]);
    if (status == RITZ_OK)
        status = join_bodies(body, planes[p].name, joint, at, out);
    for (int k = 0; k < 2; k++)
        ritz_component_free(&body[k]);
    return status;
}

static double lambda_of(const ritz_configuration *c, int64_t k)
{
    return c->lambda ? c->lambda[k] : nan("");
}

/* Entries are of order one and matrices of order below ten: a few hundred
   roundings. */
static const double rounding = 200.0 * DBL_EPSILON;

/*
 * Two free links are connected by a hinge with a spring k; their centres lie at
 * a and b from the hinge, and mu is the reduced mass. The matrices of the two
 * rotations are
 *
 *     M = [J_1 + mu a^2, -mu a.b; ., J_2 + mu b^2],   K = k [1, -1; -1, 1]
 */
static void a_caged_hinge_swings_two_links(void **state)
{
    static const double angles[] = {0.0, 90.0, -37.5, 215.0};
    const double mu = 6.0 / 5.0, k = 8.0, a[] = {0.6, 0.2}, b[] = {-0.4, 0.9};
    char joint[200], at[40];

    (void)state;
    for (int t = 0; t < 4 * PLANES; t++) {
        const int p = t % PLANES;
        const double turn = angles[t / PLANES] * acos(-1.0) / 180.0;
        const double axis = p == 1 ? -1.0 : 1.0; /* -1: axis along -w */
        const double q = turn * axis * planes[p].sign;
        const double bu = cos(q) * b[0] - sin(q) * b[1];
        const double bv = sin(q) * b[0] + cos(q) * b[1];
        const double m11 = 0.5 + mu * (a[0] * a[0] + a[1] * a[1]);
        const double m22 = 4.0 + mu * (b[0] * b[0] + b[1] * b[1]);
        const double m12 = -mu * (a[0] * bu + a[1] * bv);
        const double due =
            k * (m11 + m22 + 2.0 * m12) / (m11 * m22 - m12 * m12);
        RITZ_OWN(ritz_configuration) c = {0};

        snprintf(joint, sizeof joint,
                 "type: hinge, axis: %s, state: caged, stiffness: 8",
                 planes[p].normal);
        snprintf(at, sizeof at, "p=%g", angles[t / PLANES]);
        assert_ok(join_links(p, joint, at, &c));
        assert_int_equal(c.rank, 2);
        assert_int_equal(c.num_rigid, 3);
        assert_int_equal(c.K.ncol, 4);
        assert_near(lambda_of(&c, 3), due, rounding * due);
    }
}

/* Three rigid modes of the whole, and one for each motion in the plane that the
   joint leaves free. */
static void motions_that_stay_free_in_the_plane_are_rigid_modes(void **state)
{
    static const struct {
        const char *joint;
        const char *at;
        int64_t rank;
    } cases[] = {
        {"type: fixed", "", 3},
        {"type: rigid, offset: [0.4, 1.5, 0]", "", 3},
        {"type: rigid, offset: [0.4, 1.5, 7]", "", 3},
        {"type: hinge, axis: [0, 0, -2]", "p=33", 2},
        {"type: hinge, axis: [0, 1.0e-7, -2]", "p=33", 2},
        {"type: hinge, axis: [0, 0, 1], state: locked", "p=33", 3},
        {"type: slider, axis: [1, 2, 0]", "p=-4.5", 2},
        {"type: slider, axis: [1, 0, 0], state: locked", "p=2", 3},
        {"type: spherical", "", 2},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_configuration) c = {0};

        assert_ok(join_links(2, cases[k].joint, cases[k].at, &c));
        assert_int_equal(c.rank, cases[k].rank);
        assert_int_equal(c.K.ncol, 6 - cases[k].rank);
        assert_int_equal(c.num_rigid, 6 - cases[k].rank);
    }
}

/* Springs along or about directions out of the plane have no effect. */
static void a_bushing_has_three_springs_in_the_plane(void **state)
{
    static const char *const same[] = {
        "type: bushing, stiffness: [7, 5, 0, 0, 0, 3]",
        "type: bushing, stiffness: [7, 5, 9, 8, 6, 3]",
        "type: bushing, axes: [[0, 0, 1], [1, 0, 0]], "
        "stiffness: [9, 7, 5, 3, 8, 6]",
        "type: bushing, axes: [[0, 2, 0], [0, 0, 1]], "
        "stiffness: [5, 9, 7, 6, 3, 8]",
    };
    RITZ_OWN(ritz_configuration) one = {0};

    (void)state;
    assert_ok(join_links(2, same[0], "", &one));
    assert_int_equal(one.num_rigid, 3);
    assert_int_equal(one.K.ncol, 6);
    for (int k = 1; k < 4; k++) {
        RITZ_OWN(ritz_configuration) two = {0};

        assert_ok(join_links(2, same[k], "", &two));
        for (int64_t j = 0; j < 6; j++)
            assert_near(lambda_of(&two, j), lambda_of(&one, j),
                        rounding * lambda_of(&one, 5));
    }
}

/* A free hinge at the grids themselves needs no rotational dof; a locked hinge
   and an offset need one. */
static void a_pin_needs_no_rotation(void **state)
{
    ritz_component body[2] = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    assert_ok(link_body(2, 2.0, 0.5, 0.0, 0.0, &body[0]));
    assert_ok(link_body(2, 3.0, 4.0, -0.4, 0.9, &body[1]));
    body[0].port[0].dofs.count = 2; /* T1 and T2 */
    assert_ok(
        join_bodies(body, "xy", "type: hinge, axis: [0, 0, 1]", "p=20", &c));
    assert_int_equal(c.rank, 2);
    ritz_configuration_free(&c);
    assert_fails(join_bodies(body, "xy",
                             "type: hinge, axis: [0, 0, 1], state: locked",
                             "p=20", &c),
                 RITZ_ERR_ARGUMENT,
                 "joint 'p': a hinge holds one grid on each side, grid 1 of "
                 "'A/g1' has no R3");
    assert_fails(
        join_bodies(body, "xy", "type: rigid, offset: [0, 1, 0]", "", &c),
        RITZ_ERR_ARGUMENT, "grid 1 of 'A/g1' has no R3");
    for (int k = 0; k < 2; k++)
        ritz_component_free(&body[k]);
}

static void joints_that_leave_the_plane_are_refused(void **state)
{
    static const struct {
        const char *joint, *words;
    } cases[] = {
        {"type: hinge, axis: [0, 1, 0]",
         "the models lie in a plane, and the axis of a hinge must be normal "
         "to it"},
        {"type: hinge, axis: [0, 1.0e-3, 1]", "must be normal to it"},
        {"type: slider, axis: [1, 0, 0.1]", "the axis of a slider must be in "
                                            "it"},
        {"type: universal, axes: [[0, 0, 1], [0, 1, 0]]", "a hinge is meant"},
        {"type: bushing, axes: [[0, 1, 1], [1, 0, 0]], "
         "stiffness: [1, 1, 1, 1, 1, 1]",
         "the axis of a bushing must be in it or normal to it"},
    };
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(join_links(2, cases[k].joint, "", &c), RITZ_ERR_FORMAT,
                     cases[k].words);
    assert_fails(join_links(1, "type: hinge, axis: [0, 0, 1]", "", &c),
                 RITZ_ERR_FORMAT, "must be normal to it");
}

/* Without the key `plane`, joints need six dofs at each grid; with it, dofs out
   of the plane are refused. */
static void plane_models_need_the_key_plane(void **state)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    ritz_component pair[2] = {0};

    (void)state;
    assert_ok(link_body(2, 2.0, 0.5, 0.6, 0.2, &body));
    pair[0] = pair[1] = body; /* borrowed */
    assert_fails(
        join_bodies(pair, "none", "type: hinge, axis: [0, 0, 1]", "", &c),
        RITZ_ERR_ARGUMENT,
        "a hinge holds one six-dof grid on each side, grid 1 of "
        "'A/g1' has no T3, R1, R2");
    assert_fails(
        join_bodies(pair, "yz", "type: hinge, axis: [1, 0, 0]", "", &c),
        RITZ_ERR_ARGUMENT,
        "arm.yaml:4:3: component 'A': g1: grid 1 T1 moves out of the "
        "plane yz, in which all models of the scene lie");
    assert_fails(
        join_bodies(pair, "zx", "type: hinge, axis: [1, 0, 0]", "", &c),
        RITZ_ERR_FORMAT, "unknown plane 'zx', there is");
}

/* The check covers all dofs of a model and the positions of its grids. */
static void models_lie_in_the_plane(void **state)
{
    static const double tilted[] = {0.8, 0.0,  0.6, 0.0, 1.0,
                                    0.0, -0.6, 0.0, 0.8};
    static const double turned[] = {0.8, -0.6, 0.0, 0.6, 0.8,
                                    0.0, 0.0,  0.0, 1.0};
    int64_t id[] = {1, 2}, frame[] = {0, 1};
    double place[] = {0.0, 1.0, 5.0, 2.0, 3.0, 5.0}, axes[18] = {0.0};
    ritz_grids grids = {2, id, place, frame, 2, axes};
    ritz_dof dof[] = {{1, 1}, {1, 2}, {1, 6}, {2, 2}, {2, 6}, {9, 0}};

    (void)state;
    for (int k = 0; k < 3; k++)
        axes[4 * k] = 1.0;
    memcpy(axes + 9, turned, sizeof turned);
    assert_ok(ritz_plane_check_dofs(RITZ_PLANE_XY, 6, dof, &grids));
    memcpy(axes + 9, tilted, sizeof tilted);
    assert_fails(ritz_plane_check_dofs(RITZ_PLANE_XY, 6, dof, &grids),
                 RITZ_ERR_ARGUMENT, "grid 2 R3 moves out of the plane xy");
    memcpy(axes + 9, turned, sizeof turned);
    place[5] = 5.1;
    assert_fails(ritz_plane_check_dofs(RITZ_PLANE_XY, 6, dof, &grids),
                 RITZ_ERR_ARGUMENT,
                 "grids 1 and 2 lie 0.1 apart across the plane xy");
    place[5] = 5.0;
    dof[4].component = 5;
    assert_fails(ritz_plane_check_dofs(RITZ_PLANE_XY, 6, dof, &grids),
                 RITZ_ERR_ARGUMENT, "grid 2 R2 moves out of the plane xy");
    assert_ok(ritz_plane_check_dofs(RITZ_PLANE_NONE, 6, dof, &grids));
}

/* Models that a scene loads are checked as a whole; the assembly at full order
   agrees. */
static void models_of_files_are_checked(void **state)
{
    static const char text[] =
        "scene: arm\nplane: xy\ncomponents:\n"
        "  A: {model: a.h5, basis: full}\n  B: {model: b.h5, basis: full}\n"
        "joints:\n  - {name: p, between: [A/g1, B/g1], type: hinge, "
        "axis: [0, 0, 1], state: caged, stiffness: 8}\n";
    RITZ_OWN(ritz_component) a = {0}, b = {0}, whole = {0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    const ritz_span all = {.modes = 1};
    const double angle = 30.0;

    (void)state;
    assert_ok(link_body(2, 2.0, 0.5, 0.6, 0.2, &a));
    assert_ok(link_body(2, 3.0, 4.0, -0.4, 0.9, &b));
    folder_store("a.h5", &a);
    folder_store("b.h5", &b);
    folder_parse(text, &scene);
    assert_ok(ritz_stage_new(&scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, &angle, &c));
    assert_ok(ritz_assemble_full(&scene, &angle, &whole, NULL));
    assert_int_equal(whole.num_dofs, 4);
    assert_ok(ritz_eigen_sparse(&whole.K, &whole.M, &all, &pairs));
    assert_near(pairs.lambda[3], lambda_of(&c, 3), rounding * lambda_of(&c, 3));
    a.dof[2].component = 5; /* rotation about y */
    folder_store("a.h5", &a);
    ritz_stage_free(&stage);
    assert_fails(ritz_stage_new(&scene, &stage), RITZ_ERR_ARGUMENT,
                 "component 'A': grid 1 R2 moves out of the plane xy");
}

static ritz_status join_once(void)
{
    RITZ_OWN(ritz_configuration) c = {0};

    return join_links(2, "type: hinge, axis: [0, 0, 1]", "p=30", &c);
}

static void no_allocation_failure_leaks(void **state)
{
    (void)state;
    assert_survives_every_allocation(join_once());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_caged_hinge_swings_two_links),
    cmocka_unit_test(motions_that_stay_free_in_the_plane_are_rigid_modes),
    cmocka_unit_test(a_bushing_has_three_springs_in_the_plane),
    cmocka_unit_test(a_pin_needs_no_rotation),
    cmocka_unit_test(joints_that_leave_the_plane_are_refused),
    cmocka_unit_test(plane_models_need_the_key_plane),
    cmocka_unit_test(models_lie_in_the_plane),
    cmocka_unit_test(models_of_files_are_checked),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(plane, tests, folder_make, folder_remove)
