/*
 * Joints between two rigid bodies, compared with closed forms, and ports that a
 * joint cannot hold.
 */
#include "testing.h"

#include "bodies.h"
#include "folder.h"
#include "rigs.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>

/* Their mass and inertia, reduced: 1 / (1 / 2 + 1 / 3), 1 / (1 / 0.5 + 1 / 4).
 */
static const double mass = 6.0 / 5.0;
static const double inertia = 4.0 / 9.0;

/* M is diagonal, K of rank one to six: a few dozen roundings. */
static const double rounding = 100.0 * DBL_EPSILON;

static rig two_points(void)
{
    rig r = {.count = 2};

    assert_ok(body_point(2.0, 0.5, &r.body[0]));
    assert_ok(body_point(3.0, 4.0, &r.body[1]));
    return r;
}

/* A joint p between points A and B, and what else is said of it. */
#define BETWEEN(rest) "- {name: p, between: [A/g1, B/g1], " rest "}\n"

static void assert_points(const char *joint, const char *at, int64_t rigid,
                          int64_t count, const double *lambda)
{
    RITZ_OWN(rig) r = two_points();
    RITZ_OWN(ritz_configuration) c = rig_join(&r, joint, at);

    assert_int_equal(c.num_rigid, rigid);
    assert_int_equal(c.K.ncol, rigid + count);
    for (int64_t k = 0; k < count; k++)
        assert_near(c.lambda[rigid + k], lambda[k],
                    rounding * lambda[count - 1]);
}

/* Six rigid modes and one for each motion that is left; rank of the rest. */
static void motions_that_stay_free_are_rigid_modes(void **)
{
    static const struct {
        const char *joint, *at;
        int64_t rigid;
    } cases[] = {
        {BETWEEN("type: fixed"), "", 6},
        {BETWEEN("type: rigid, offset: [1, 2, 3]"), "", 6},
        {BETWEEN("type: hinge, axis: [1, 2, -2]"), "p=33", 7},
        {BETWEEN("type: slider, axis: [1, 2, -2]"), "p=-4.5", 7},
        {BETWEEN("type: universal, axes: [[1, 0, 0], [1, 2, 0]]"),
         "p=21,p.2=-140", 8},
        {BETWEEN("type: spherical"), "", 9},
        {BETWEEN("type: hinge, axis: [1, 2, -2], state: locked"), "p=33", 6},
        {BETWEEN("type: slider, axis: [1, 2, -2], state: locked"), "p=4", 6},
        {BETWEEN("type: universal, axes: [[1, 0, 0], [1, 2, 0]], "
                 "state: locked"),
         "p=20,p.2=30", 6},
        {BETWEEN("type: universal, axes: [[1, 0, 0], [1, 2, 0]], "
                 "state: [free, locked]"),
         "p=20,p.2=30", 7},
        {BETWEEN("type: spherical, state: locked"), "", 6},
        {BETWEEN("type: slider, axis: [0, 1, 0], state: caged, damping: 3"),
         "p=1", 7},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_points(cases[k].joint, cases[k].at, cases[k].rigid, 0,
                      (double[]){1.0});
}

/* k / J, of any axis at any angle; k / m, at any position. */
static void a_caged_joint_swings_on_its_spring(void **)
{
    static const char *const hinges[] = {"[0, 0, 1]", "[1, 0, 0]",
                                         "[2, -3, 6]"};
    static const char *const at[] = {"p=0", "p=90", "p=-37.5", "p=215"};
    char joint[200];

    for (int k = 0; k < 12; k++) {
        snprintf(joint, sizeof joint,
                 BETWEEN("type: hinge, axis: %s, state: caged, stiffness: 8"),
                 hinges[k % 3]);
        assert_points(joint, at[k / 3], 6, 1, (double[]){8.0 / inertia});
        snprintf(joint, sizeof joint,
                 BETWEEN("type: slider, axis: %s, state: caged, stiffness: 8"),
                 hinges[k % 3]);
        assert_points(joint, at[k / 3], 6, 1, (double[]){8.0 / mass});
    }
    assert_points(BETWEEN("type: spherical, state: caged, stiffness: 8"), "", 6,
                  3, (double[]){8.0 / inertia, 8.0 / inertia, 8.0 / inertia});
}

/*
 * Angles q about axes at an angle g: K = diag(k), M = J [1, cos g; cos g, 1],
 * whatever the first angle.
 */
static void a_caged_cross_swings_about_both_axes(void **)
{
    const double g = 0.6, k = 5.0, l = 2.0;
    const double sum = (k + l) / (1.0 - g * g), product = k * l / (1.0 - g * g);
    const double root = sqrt(0.25 * sum * sum - product);
    const double skew[] = {(0.5 * sum - root) / inertia,
                           (0.5 * sum + root) / inertia};
    static const char *const at[] = {"p=0,p.2=0", "p=70,p.2=-25",
                                     "p.2=90,p=180"};

    for (int i = 0; i < 3; i++) {
        assert_points(BETWEEN("type: universal, state: caged, stiffness: "
                              "[2, 5], axes: [[0, 0, 1], [0, 1, 0]]"),
                      at[i], 6, 2, (double[]){2.0 / inertia, 5.0 / inertia});
        assert_points(BETWEEN("type: universal, state: caged, stiffness: "
                              "[5, 2], axes: [[0, 0, 2], [0, 4, 3]]"),
                      at[i], 6, 2, skew);
        assert_points(BETWEEN("type: universal, state: [caged, free], axes: "
                              "[[0, 0, 1], [1, 0, 0]], stiffness: 7"),
                      at[i], 7, 1, (double[]){7.0 / inertia});
    }
}

/* Six springs along and about axes of one's own. */
static void a_bushing_is_six_springs(void **)
{
    static const char *const axes[] = {"", ", axes: [[0, 0, 1], [0, 1, 0]]",
                                       ", axes: [[2, -3, 6], [1, 1, 1]]"};
    const double lambda[] = {0.3 / mass,    0.6 / mass,    1.2 / mass,
                             2.0 / inertia, 3.0 / inertia, 4.0 / inertia};
    char joint[200];

    for (int k = 0; k < 3; k++) {
        snprintf(joint, sizeof joint,
                 BETWEEN("type: bushing, stiffness: [0.6, 0.3, 1.2, 4, 2, 3]"
                         "%s"),
                 axes[k]);
        assert_points(joint, "", 6, 6, lambda);
    }
    assert_points(BETWEEN("type: bushing, stiffness: [0, 0, 1.2, 0, 0, 0]"), "",
                  11, 1, &lambda[2]);
}

/* D = c phi^2 = c / J of the mode, and none of the rigid ones. */
static void a_cage_damps(void **)
{
    static const struct {
        const char *joint;
        int64_t rigid;
        double damping; /* sum over modes */
    } cases[] = {
        {BETWEEN("type: hinge, axis: [0, 1, 0], state: caged, stiffness: 8, "
                 "damping: 0.5"),
         6, 0.5 * 9.0 / 4.0},
        {BETWEEN("type: slider, axis: [0, 1, 0], state: caged, damping: 0.5, "
                 "stiffness: 2"),
         6, 0.5 * 5.0 / 6.0},
        {BETWEEN("type: spherical, state: caged, stiffness: 2, damping: 4"), 6,
         3.0 * 4.0 * 9.0 / 4.0},
        {BETWEEN("type: bushing, stiffness: [1, 1, 1, 1, 1, 1], "
                 "damping: [0, 0, 6, 0, 4, 0]"),
         6, 6.0 * 5.0 / 6.0 + 4.0 * 9.0 / 4.0},
    };
    RITZ_OWN(rig) r = two_points();

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_configuration) c = rig_join(&r, cases[k].joint, "");
        double sum = 0.0;

        assert_non_null(c.D.val);
        for (int64_t j = 0; j < c.D.ncol; j++) {
            double d = ritz_dense_col(&c.D, j)[j];

            sum += d;
            assert_near(j < cases[k].rigid ? d : 0.0, 0.0, rounding);
        }
        assert_near(sum, cases[k].damping, rounding * cases[k].damping);
    }
}

/*
 * A on a spring k to a much heavier ground turns about z with B on an arm of
 * length d: k = lambda (J_A + J_B + m d^2), where translations are held.
 */
static void a_rigid_joint_has_a_lever(void **)
{
    const double k = 50.0, d2 = 9.0 + 16.0, heavy = 1e9;
    RITZ_OWN(rig) r = two_points();
    RITZ_OWN(ritz_configuration) c = {0};

    r.count = 3;
    assert_ok(body_point(heavy, heavy, &r.body[2]));
    c = rig_join(
        &r,
        BETWEEN("type: rigid, offset: [3, -4, 12]") "- {name: q, between: "
                                                    "[C/g1, A/g1], type: "
                                                    "hinge, axis: [0, 0, 1], "
                                                    "state: caged, stiffness: "
                                                    "50}\n",
        "");
    assert_int_equal(c.num_rigid, 6);
    /* the ground gives way by all inertia about any axis over its own */
    assert_near(c.lambda[6], k / (0.5 + 4.0 + 3.0 * d2),
                2.0 * (4.5 + 3.0 * 169.0) / heavy * c.lambda[6]);
}

/* --- refusals ------------------------------------------------------------ */

/* Leave `kept` of the dofs of port `name`. */
static void cut_port(ritz_component *body, const char *name, int64_t kept)
{
    for (int64_t k = 0; k < body->num_ports; k++)
        if (strcmp(body->port[k].name, name) == 0)
            body->port[k].dofs.count = kept;
}

static void assert_refused(const rig *r, const char *joint, const char *words)
{
    char text[RIG_TEXT];
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_configuration none = {0};
    const double setting[2] = {0.0, 0.0};

    rig_scene(r, joint, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    rig_stage(r, &scene, &ritz_method_full, -1, &stage);
    assert_int_equal(ritz_stage_assemble(&stage, setting, &none),
                     RITZ_ERR_ARGUMENT);
    assert_string_equal(ritz_error_message(), words);
}

static void ports_that_do_not_fit_are_refused(void **)
{
    RITZ_OWN(rig) r = rig_of_chains(2);

    cut_port(&r.body[0], "g3", 3);
    cut_port(&r.body[1], "g1", 5);
    assert_refused(
        &r,
        "- {name: p, between: [A/g3, B/g1], type: hinge, axis: [0, 0, 1]}\n",
        "joint 'p': a hinge holds one six-dof grid on each side, "
        "grid 3 of 'A/g3' has no R1, R2, R3");
    assert_refused(&r, "- {name: p, between: [A/g1, B/g1], type: rigid}\n",
                   "joint 'p': a rigid joint holds one six-dof grid on each "
                   "side, grid 11 of 'B/g1' has no R3");
    cut_port(&r.body[1], "g1", 0);
    assert_refused(&r, "- {name: p, between: [A/g1, B/g1], type: spherical}\n",
                   "joint 'p': a spherical joint holds one six-dof grid on "
                   "each side, 'B/g1' has no grid");
    r.body[0].port[0].dofs.at[5] = 7;
    assert_refused(&r,
                   "- {name: p, between: [A/g1, B/g2], type: slider, "
                   "axis: [0, 0, 1]}\n",
                   "joint 'p': a slider holds one six-dof grid on each side, "
                   "'A/g1' has more than one grid, or a scalar point");
    r.body[1].port[1].origin[1] += 0.25;
    assert_refused(&r,
                   "- {name: p, between: [A/g2, B/g2], type: bushing, "
                   "stiffness: [1, 1, 1, 1, 1, 1], tolerance: 0.1}\n",
                   "joint 'p': a bushing lies between grids at one place, "
                   "those of 'A/g2' and 'B/g2' lie 0.25 apart, 0.1 is let "
                   "pass");
}

static const double allocated[] = {20.0, -35.0};

static ritz_status assemble_anew(const ritz_stage *stage)
{
    RITZ_OWN(ritz_configuration) c = {0};

    return ritz_stage_assemble(stage, allocated, &c);
}

static ritz_status assemble_full_anew(const ritz_scene *scene)
{
    RITZ_OWN(ritz_component) system = {0};

    return ritz_assemble_full(scene, allocated, &system, NULL);
}

static void no_allocation_failure_leaks(void **)
{
    static const char cross[] =
        BETWEEN("type: universal, axes: [[0, 0, 1], [0, 1, 0]], "
                "state: [free, caged], stiffness: 20, damping: 0.5");
    char text[RIG_TEXT];
    RITZ_OWN(rig) r = two_points();
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_component system = rig_join_full(&r, cross, ""); /* writes the files */

    ritz_component_free(&system);
    rig_scene(&r, cross, text);
    folder_parse(text, &scene);
    rig_stage(&r, &scene, &ritz_method_full, -1, &stage);
    assert_survives_every_allocation(assemble_anew(&stage));
    assert_survives_every_allocation(assemble_full_anew(&scene));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(motions_that_stay_free_are_rigid_modes),
    cmocka_unit_test(a_caged_joint_swings_on_its_spring),
    cmocka_unit_test(a_caged_cross_swings_about_both_axes),
    cmocka_unit_test(a_bushing_is_six_springs),
    cmocka_unit_test(a_cage_damps),
    cmocka_unit_test(a_rigid_joint_has_a_lever),
    cmocka_unit_test(ports_that_do_not_fit_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(joints, tests, folder_make, folder_remove)
