/*
 * Joints, each held to closed forms on two masses, to the other joints, and to
 * itself turned, exchanged and at full order on elastic bodies.
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
#include <stdlib.h>

enum { MOST_BODIES = 5 };

/* Bodies A, B, C, ... and the list of joints between them. */
typedef struct rig {
    int64_t count;
    ritz_component body[MOST_BODIES];
} rig;

static void rig_free(rig *r)
{
    for (int64_t k = 0; k < r->count; k++)
        ritz_component_free(&r->body[k]);
}

static void write_scene(const rig *r, const char *joints, char text[4000])
{
    size_t used = (size_t)snprintf(text, 4000, "scene: rig\ncomponents:\n");

    for (int64_t k = 0; k < r->count; k++)
        used += (size_t)snprintf(text + used, 4000 - used,
                                 "  %c: {model: %c.h5, basis: full}\n",
                                 (char)('A' + k), (char)('a' + k));
    used += (size_t)snprintf(text + used, 4000 - used, "joints:\n%s", joints);
    assert_true(used < 4000);
}

static void stage_of(const rig *r, const ritz_scene *scene,
                     const ritz_method *method, ritz_stage *out)
{
    ritz_reduced body[MOST_BODIES] = {0};

    for (int64_t k = 0; k < r->count; k++)
        assert_ok(reduce_with(&r->body[k], method, -1, &body[k]));
    assert_ok(ritz_stage_from(scene, body, out));
}

/* The rig at some settings. */
static ritz_configuration join_by(const rig *r, const ritz_method *method,
                                  const char *joints, const char *at)
{
    char text[4000];
    double setting[16] = {0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_configuration c = {0};

    write_scene(r, joints, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    assert_true(scene.num_sweeps <= 16);
    assert_ok(ritz_scene_settings(&scene, at, setting));
    stage_of(r, &scene, method, &stage);
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    return c;
}

static ritz_configuration join(const rig *r, const char *joints, const char *at)
{
    return join_by(r, &ritz_method_full, joints, at);
}

/* Eigenvalues agree to `error` of the largest; rigid ones in number. */
static void assert_alike(const ritz_configuration *a,
                         const ritz_configuration *b, double error)
{
    int64_t n = a->K.ncol;

    assert_int_equal(b->K.ncol, n);
    assert_int_equal(b->num_rigid, a->num_rigid);
    for (int64_t k = 0; k < n; k++)
        assert_near(b->lambda[k], a->lambda[k], error * a->lambda[n - 1]);
}

/* --- two masses ---------------------------------------------------------- */

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
    RITZ_OWN(ritz_configuration) c = join(&r, joint, at);

    assert_int_equal(c.num_rigid, rigid);
    assert_int_equal(c.K.ncol, rigid + count);
    for (int64_t k = 0; k < count; k++)
        assert_near(c.lambda[rigid + k], lambda[k],
                    rounding * lambda[count - 1]);
}

/* Six rigid modes and one for each motion that is left; rank of the rest. */
static void what_a_joint_leaves_is_rigid(void **state)
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

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_points(cases[k].joint, cases[k].at, cases[k].rigid, 0,
                      (double[]){1.0});
}

/* k / J, of any axis at any angle; k / m, at any position. */
static void a_caged_joint_swings_on_its_spring(void **state)
{
    static const char *const hinges[] = {"[0, 0, 1]", "[1, 0, 0]",
                                         "[2, -3, 6]"};
    static const char *const at[] = {"p=0", "p=90", "p=-37.5", "p=215"};
    char joint[200];

    (void)state;
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
static void a_caged_cross_swings_about_both_axes(void **state)
{
    const double g = 0.6, k = 5.0, l = 2.0;
    const double sum = (k + l) / (1.0 - g * g), product = k * l / (1.0 - g * g);
    const double root = sqrt(0.25 * sum * sum - product);
    const double skew[] = {(0.5 * sum - root) / inertia,
                           (0.5 * sum + root) / inertia};
    static const char *const at[] = {"p=0,p.2=0", "p=70,p.2=-25",
                                     "p.2=90,p=180"};

    (void)state;
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
static void a_bushing_is_six_springs(void **state)
{
    static const char *const axes[] = {"", ", axes: [[0, 0, 1], [0, 1, 0]]",
                                       ", axes: [[2, -3, 6], [1, 1, 1]]"};
    const double lambda[] = {0.3 / mass,    0.6 / mass,    1.2 / mass,
                             2.0 / inertia, 3.0 / inertia, 4.0 / inertia};
    char joint[200];

    (void)state;
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
static void a_cage_damps(void **state)
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

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_configuration) c = join(&r, cases[k].joint, "");
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
static void a_rigid_joint_has_a_lever(void **state)
{
    const double k = 50.0, d2 = 9.0 + 16.0, heavy = 1e9;
    RITZ_OWN(rig) r = two_points();
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    r.count = 3;
    assert_ok(body_point(heavy, heavy, &r.body[2]));
    c = join(
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

/* --- elastic bodies ------------------------------------------------------ */

static const double places[3][3] = {
    {0.3, -0.2, 0.1}, {1.1, 0.4, -0.3}, {1.6, 1.2, 0.5}};

/* Bodies of three grids: 12 elastic modes each, of 10 to 1e5 rad^2/s^2. */
static rig chains(int64_t count)
{
    rig r = {.count = count};

    for (int64_t k = 0; k < count; k++)
        assert_ok(
            body_chain(3, places, 1 + 10 * k, 7 + (uint64_t)k, &r.body[k]));
    return r;
}

/* 12 to 90 dofs at lambda_max of 1e5: n eps of that, and a margin of ten. */
static const double elastic = 1e3 * DBL_EPSILON;

#define HELD(type) "- {name: p, between: [A/g3, B/g1], type: " type "}\n"

static void locked_joints_are_fixed_ones(void **state)
{
    static const char *const locked[] = {
        HELD("rigid"),
        HELD("hinge, axis: [1, 2, 3], state: locked"),
        HELD("slider, axis: [1, 2, 3], state: locked"),
        HELD("universal, axes: [[1, 2, 3], [1, 0, 1]], state: locked"),
        HELD("spherical, state: locked"),
    };
    RITZ_OWN(rig) r = chains(2);
    RITZ_OWN(ritz_configuration) one = join(&r, HELD("fixed"), "");

    (void)state;
    for (size_t k = 0; k < sizeof locked / sizeof *locked; k++) {
        RITZ_OWN(ritz_configuration) two = join(&r, locked[k], "");

        assert_int_equal(two.rank, 6);
        assert_alike(&one, &two, elastic);
    }
}

/* From grid 1 of a rigid body to its grid 3 is as good as grid 3 itself. */
static void an_offset_reaches_another_grid(void **state)
{
    static const char bushing[] =
        "- {name: q, between: [B/g3, C/g1], type: bushing, "
        "stiffness: [30, 20, 10, 5, 6, 7]}\n";
    static const char *const reached[] = {
        "- {name: p, between: [A/g3, B/g1], type: fixed}\n",
        "- {name: p, between: [A/g1, B/g1], type: rigid, "
        "offset: [1.3, 1.4, 0.4]}\n",
        "- {name: p, between: [B/g1, A/g1], type: rigid, "
        "offset: [-1.3, -1.4, -0.4]}\n",
        "- {name: p, between: [A/g1, B/g1], type: slider, "
        "axis: [1.3, 1.4, 0.4], state: locked}\n"};
    const double length = sqrt(1.3 * 1.3 + 1.4 * 1.4 + 0.4 * 0.4);
    RITZ_OWN(rig) r = chains(3);
    ritz_configuration c[4] = {0};
    char joints[600], at[40];

    (void)state;
    for (int k = 0; k < 4; k++) {
        snprintf(joints, sizeof joints, "%s%s", reached[k], bushing);
        snprintf(at, sizeof at, "p=%.17g", length);
        c[k] = join_by(&r, &ritz_method_rigid, joints, k == 3 ? at : "");
        assert_int_equal(c[k].num_rigid, 6);
        assert_alike(&c[0], &c[k], elastic);
    }
    for (int k = 0; k < 4; k++)
        ritz_configuration_free(&c[k]);
}

/*
 * Two scenes that say the same. A universal joint is two hinges with a body
 * between that weighs nothing, a spherical one three.
 */
static void joints_agree_with_each_other(void **state)
{
    static const struct {
        int64_t points; /* bodies without mass, C and D */
        const char *one, *at_one, *two, *at_two;
    } cases[] = {
        {0, HELD("slider, axis: [2, -1, 2], state: locked"), "p=-1.5",
         HELD("rigid, offset: [-1, 0.5, -1]"), ""},
        {1, HELD("universal, axes: [[0, 0, 1], [0, 1, 0]]"), "p=30,p.2=-70",
         "- {name: p, between: [A/g3, C/g1], type: hinge, axis: [0, 0, 1]}\n"
         "- {name: q, between: [C/g1, B/g1], type: hinge, axis: [0, 1, 0]}\n",
         "p=30,q=-70"},
        {1,
         HELD("universal, axes: [[0, 1, 2], [3, 1, 0]], state: caged, "
              "stiffness: [9, 40], damping: [1, 2]"),
         "p=30,p.2=-70",
         "- {name: p, between: [A/g3, C/g1], type: hinge, axis: [0, 1, 2], "
         "state: caged, stiffness: 9, damping: 1}\n"
         "- {name: q, between: [C/g1, B/g1], type: hinge, axis: [3, 1, 0], "
         "state: caged, stiffness: 40, damping: 2}\n",
         "p=30,q=-70"},
        {2, HELD("spherical"), "",
         "- {name: p, between: [A/g3, C/g1], type: hinge, axis: [0, 0, 1]}\n"
         "- {name: q, between: [C/g1, D/g1], type: hinge, axis: [0, 1, 0]}\n"
         "- {name: s, between: [D/g1, B/g1], type: hinge, axis: [1, 0, 0]}\n",
         ""},
        {0,
         HELD("universal, axes: [[0, 0, 1], [0, 1, 0]], state: [locked, "
              "free]"),
         "p.2=25", HELD("hinge, axis: [0, 1, 0]"), "p=25"},
        {0,
         HELD("universal, axes: [[0, 0, 1], [0, 1, 0]], state: [free, "
              "locked]"),
         "p=25", HELD("hinge, axis: [0, 0, 1]"), "p=25"},
        {0, HELD("spherical, state: caged, stiffness: 300"), "",
         HELD("bushing, stiffness: [1.0e12, 1.0e12, 1.0e12, 300, 300, 300]"),
         ""},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(rig) r = chains(2);
        RITZ_OWN(ritz_configuration)
        one = join(&r, cases[k].one, cases[k].at_one);
        RITZ_OWN(ritz_configuration) two = {0};

        for (int64_t p = 0; p < cases[k].points; p++)
            assert_ok(body_point(0.0, 0.0, &r.body[r.count++]));
        two = join(&r, cases[k].two, cases[k].at_two);
        if (k + 1 < sizeof cases / sizeof *cases)
            assert_alike(&one, &two, elastic);
        for (int64_t j = 0; j < one.K.ncol; j++) /* 1e12 is not all stiffness */
            assert_near(two.lambda[j], one.lambda[j],
                        1e-6 * one.lambda[one.K.ncol - 1]);
    }
}

/* What a spring k yields of a locked joint: lambda errs as 1 / k. */
static void stiff_cages_approach_locked_joints(void **state)
{
    static const struct {
        const char *locked, *caged, *at;
    } cases[] = {
        {HELD("hinge, axis: [1, 2, 3], state: locked"),
         "hinge, axis: [1, 2, 3]", "p=40"},
        {HELD("slider, axis: [1, 2, 3], state: locked"),
         "slider, axis: [1, 2, 3]", "p=0.7"},
        {HELD("universal, axes: [[1, 2, 3], [1, 0, 0]], state: locked"),
         "universal, axes: [[1, 2, 3], [1, 0, 0]]", "p=40,p.2=10"},
        {HELD("spherical, state: locked"), "spherical", ""},
    };
    RITZ_OWN(rig) r = chains(2);
    char joint[400];

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_configuration)
        locked = join(&r, cases[k].locked, cases[k].at);
        double error[2] = {0.0, 0.0};

        for (int i = 0; i < 2; i++) {
            RITZ_OWN(ritz_configuration) caged = {0};

            snprintf(joint, sizeof joint,
                     HELD("%s, state: caged, stiffness: %g"), cases[k].caged,
                     i ? 1e8 : 1e7);
            caged = join(&r, joint, cases[k].at);
            assert_int_equal(caged.num_rigid, locked.num_rigid);
            for (int64_t j = 6; j < 20; j++) /* the low ones */
                error[i] = fmax(error[i],
                                fabs(1.0 - caged.lambda[j] / locked.lambda[j]));
        }
        assert_true(error[0] < 1e-2 && error[0] > 1e-7);
        assert_near(error[1] / error[0], 0.1, 1e-3);
    }
}

/* Each type at settings, its ends exchanged, its axes to be turned. */
typedef struct sample {
    const char *type, *at;      /* between A and B */
    const char *back, *back_at; /* between B and A */
    const char *rest;           /* behind the axes */
    double axis[2][3];          /* of `type` */
    int64_t num_axes;           /* 0: key without */
    const char *key;
} sample;

static const sample samples[] = {
    {"hinge",
     "p=35",
     "hinge, axis: [1, 2, 3]",
     "p=-35",
     "",
     {{1, 2, 3}},
     1,
     "axis"},
    {"hinge",
     "p=120",
     "hinge, axis: [1, 2, 3], state: caged, stiffness: 90, damping: 1",
     "p=-120",
     ", state: caged, stiffness: 90, damping: 1",
     {{1, 2, 3}},
     1,
     "axis"},
    {"slider",
     "p=0.8",
     "slider, axis: [1, 2, 3]",
     "p=-0.8",
     "",
     {{1, 2, 3}},
     1,
     "axis"},
    {"slider",
     "p=-2.5",
     "slider, axis: [1, 2, 3], state: caged, stiffness: 70",
     "p=2.5",
     ", state: caged, stiffness: 70",
     {{1, 2, 3}},
     1,
     "axis"},
    {"universal",
     "p=25,p.2=-65",
     "universal, axes: [[2, 0, 1], [1, 2, 3]]",
     "p=65,p.2=-25",
     "",
     {{1, 2, 3}, {2, 0, 1}},
     2,
     "axes"},
    {"universal",
     "p=25,p.2=-65",
     "universal, axes: [[2, 0, 1], [1, 2, 3]], state: caged, "
     "stiffness: [30, 60]",
     "p=65,p.2=-25",
     ", state: caged, stiffness: [60, 30]",
     {{1, 2, 3}, {2, 0, 1}},
     2,
     "axes"},
    {"spherical", "", "spherical", "", "", {{0}}, 0, ""},
    {"spherical",
     "",
     "spherical, state: caged, stiffness: 80",
     "",
     ", state: caged, stiffness: 80",
     {{0}},
     0,
     ""},
    {"bushing",
     "",
     "bushing, axes: [[1, 2, 3], [2, 0, 1]], "
     "stiffness: [50, 900, 20, 3, 0, 500], damping: [1, 2, 3, 4, 5, 6]",
     "",
     ", stiffness: [50, 900, 20, 3, 0, 500], damping: [1, 2, 3, 4, 5, 6]",
     {{1, 2, 3}, {2, 0, 1}},
     2,
     "axes"},
    {"rigid",
     "",
     "rigid, offset: [-1, -2, -3]",
     "",
     "",
     {{1, 2, 3}},
     1,
     "offset"},
    {"fixed", "", "fixed", "", "", {{0}}, 0, ""},
};

enum { NUM_SAMPLES = sizeof samples / sizeof *samples };

/* "type: hinge, axis: [..]", the axes turned by R. */
static void write_sample(const sample *s, const double R[9], char *text,
                         size_t size)
{
    size_t used = (size_t)snprintf(
        text, size, "- {name: p, between: [A/g3, B/g1], type: %s", s->type);

    for (int64_t k = 0; k < s->num_axes; k++) {
        const bool pair = s->num_axes > 1;
        double x[3];

        ritz_turn_apply(R, s->axis[k], x);
        if (k == 0)
            used += (size_t)snprintf(text + used, size - used, ", %s: %s",
                                     s->key, pair ? "[" : "");
        used += (size_t)snprintf(text + used, size - used,
                                 "%s[%.17g, %.17g, %.17g]%s", k > 0 ? ", " : "",
                                 x[0], x[1], x[2], k > 0 ? "]" : "");
    }
    used += (size_t)snprintf(text + used, size - used, "%s}\n", s->rest);
    assert_true(used < size);
}

static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static double damping_of(const ritz_configuration *c)
{
    double sum = 0.0;

    for (int64_t j = 0; c->D.val && j < c->D.ncol; j++)
        sum += ritz_dense_col(&c->D, j)[j];
    return sum;
}

/* Decks stand where they like, all of them turned by the same R. */
static void a_turned_scene_is_the_same(void **state)
{
    const double axis[3] = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
    uint64_t seed = 11;
    double R[9];
    RITZ_OWN(rig) r = chains(2), turned = chains(2);

    (void)state;
    ritz_turn_about(axis, 77.7, R);
    for (int k = 0; k < 2; k++) {
        double t[3];

        for (int i = 0; i < 3; i++)
            t[i] = 5.0 * body_number(&seed);
        assert_ok(body_move(&turned.body[k], R, t));
    }
    for (int k = 0; k < NUM_SAMPLES; k++) {
        char here[400], there[400];
        RITZ_OWN(ritz_configuration) one = {0}, two = {0};

        write_sample(&samples[k], unit, here, sizeof here);
        write_sample(&samples[k], R, there, sizeof there);
        one = join(&r, here, samples[k].at);
        two = join(&turned, there, samples[k].at);
        assert_int_equal(one.rank, two.rank);
        assert_alike(&one, &two, elastic);
        assert_near(damping_of(&two), damping_of(&one),
                    elastic * damping_of(&one));
    }
}

static void ends_can_be_exchanged(void **state)
{
    RITZ_OWN(rig) r = chains(2);

    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++) {
        char here[400], there[400];
        RITZ_OWN(ritz_configuration) one = {0}, two = {0};

        write_sample(&samples[k], unit, here, sizeof here);
        snprintf(there, sizeof there,
                 "- {name: p, between: [B/g1, A/g3], type: %s}\n",
                 samples[k].back);
        one = join(&r, here, samples[k].at);
        two = join(&r, there, samples[k].back_at);
        assert_alike(&one, &two, elastic);
        assert_near(damping_of(&two), damping_of(&one),
                    elastic * damping_of(&one));
    }
}

/* Craig-Bampton with every mode is the body itself. */
static ritz_configuration join_all_modes(const rig *r, const char *joints,
                                         const char *at)
{
    char text[4000];
    double setting[16] = {0.0};
    ritz_reduced body[MOST_BODIES] = {0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_configuration c = {0};

    write_scene(r, joints, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    assert_ok(ritz_scene_settings(&scene, at, setting));
    for (int64_t k = 0; k < r->count; k++)
        assert_ok(
            reduce_with(&r->body[k], &ritz_method_craig_bampton, 18, &body[k]));
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    return c;
}

/* The rig at full order, from files. */
static ritz_component join_full(const rig *r, const char *joints,
                                const char *at)
{
    char text[4000], file[8];
    double setting[16] = {0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    ritz_component system = {0};

    for (int64_t k = 0; k < r->count; k++) {
        snprintf(file, sizeof file, "%c.h5", (char)('a' + k));
        folder_store(file, &r->body[k]);
    }
    write_scene(r, joints, text);
    folder_parse(text, &scene);
    assert_ok(ritz_scene_settings(&scene, at, setting));
    assert_ok(ritz_assemble_full(&scene, setting, &system, NULL));
    return system;
}

/* tr(M^-1 D) is that of the modes; so is every eigenvalue. */
static void assert_full(const ritz_configuration *c,
                        const ritz_component *system)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, D = {0}, modal = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double sum = 0.0;

    assert_int_equal(system->num_dofs, c->K.ncol);
    assert_ok(ritz_sparse_dense(&system->K, &K));
    assert_ok(ritz_sparse_dense(&system->M, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_int_equal(pairs.num_rigid, c->num_rigid);
    for (int64_t k = 0; k < c->K.ncol; k++)
        assert_near(pairs.lambda[k], c->lambda[k],
                    elastic * c->lambda[c->K.ncol - 1]);
    assert_int_equal(system->D.colptr != NULL, c->D.val != NULL);
    if (c->D.val) {
        assert_ok(ritz_sparse_dense(&system->D, &D));
        assert_ok(ritz_dense_congruence(&D, &pairs.Phi, &modal));
        for (int64_t j = 0; j < modal.ncol; j++)
            sum += ritz_dense_col(&modal, j)[j];
        assert_near(sum, damping_of(c), elastic * sum);
    }
}

static void full_order_agrees(void **state)
{
    RITZ_OWN(rig) r = chains(2);

    (void)state;
    for (int k = 0; k < NUM_SAMPLES; k++) {
        char joint[400];
        RITZ_OWN(ritz_configuration) c = {0};
        RITZ_OWN(ritz_component) system = {0};

        write_sample(&samples[k], unit, joint, sizeof joint);
        c = join_all_modes(&r, joint, samples[k].at);
        system = join_full(&r, joint, samples[k].at);
        assert_full(&c, &system);
    }
}

/* One of each in a row of five bodies, at settings of their own. */
static const char train[] =
    "- {name: one, between: [A/g3, B/g1], type: slider, axis: [1, 0, 2], "
    "positions: [0.1, 0.5]}\n"
    "- {name: two, between: [C/g1, B/g2], type: universal, "
    "axes: [[0, 1, 0], [1, 0, 1]], angles_deg: [0, 45], "
    "state: [free, caged], stiffness: 20, damping: 0.5}\n"
    "- {name: three, between: [C/g3, D/g2], type: hinge, axis: [1, 1, 0], "
    "angles_deg: [10, 20, 30]}\n"
    "- {name: four, between: [D/g3, E/g1], type: bushing, "
    "stiffness: [100, 200, 300, 0, 5, 6], damping: [0, 0, 0, 1, 0, 0]}\n";

/* Six, and one each of slider, cross and hinge; the bushing turns about x. */
static void several_swept_joints_agree_with_full_order(void **state)
{
    static const char *const at[] = {"one=0.1,two=0,three=10",
                                     "one=0.5,two=45,three=30",
                                     "one=-7,two=123,two.2=-80,three=260"};
    RITZ_OWN(rig) r = chains(5);

    (void)state;
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_configuration) c = join_all_modes(&r, train, at[k]);
        RITZ_OWN(ritz_component) system = join_full(&r, train, at[k]);

        assert_int_equal(c.rank, 5 + 4 + 5);
        assert_int_equal(c.num_rigid, 6 + 4);
        assert_full(&c, &system);
    }
}

static void every_combination_of_settings_is_assembled(void **state)
{
    char text[4000];
    RITZ_OWN(rig) r = chains(5);
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_system) system = {0};
    const ritz_configuration *found = NULL;

    (void)state;
    write_scene(&r, train, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    stage_of(&r, &scene, &ritz_method_rigid, &stage);
    assert_ok(ritz_assemble(&stage, NULL, &system));
    assert_int_equal(system.num_sweeps, 4);
    assert_string_equal(system.sweep[1], "two");
    assert_string_equal(system.sweep[2], "two.2");
    assert_int_equal(system.num_configurations, 2 * 2 * 3);
    for (int64_t k = 0; k < 12; k++)
        assert_int_equal(system.configuration[k].num_rigid, 6 + 4);
    assert_ok(
        ritz_system_find(&system, "three=20,one=0.5,two=0,two.2=0", &found));
    assert_string_equal(found->at, "one=0.5,two=0,two.2=0,three=20");
    assert_survives_every_allocation(
        ritz_system_find(&system, "three=30,one=0.1,two=45", &found));
    assert_string_equal(found->at, "one=0.1,two=45,two.2=0,three=30");
    assert_fails(ritz_system_find(&system, "two.3=1", &found),
                 RITZ_ERR_ARGUMENT, "there is no joint 'two.3' to set");
    assert_fails(ritz_system_find(&system, "two", &found), RITZ_ERR_ARGUMENT,
                 "'two' is not JOINT=SETTING");
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
    char text[4000];
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_configuration none = {0};
    const double setting[2] = {0.0, 0.0};

    write_scene(r, joint, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    stage_of(r, &scene, &ritz_method_full, &stage);
    assert_int_equal(ritz_stage_assemble(&stage, setting, &none),
                     RITZ_ERR_ARGUMENT);
    assert_string_equal(ritz_error_message(), words);
}

static void ports_that_do_not_fit_are_refused(void **state)
{
    RITZ_OWN(rig) r = chains(2);

    (void)state;
    cut_port(&r.body[0], "g3", 3);
    cut_port(&r.body[1], "g1", 5);
    assert_refused(&r, HELD("hinge, axis: [0, 0, 1]"),
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

static void no_allocation_failure_leaks(void **state)
{
    static const char cross[] =
        BETWEEN("type: universal, axes: [[0, 0, 1], [0, 1, 0]], "
                "state: [free, caged], stiffness: 20, damping: 0.5");
    char text[4000];
    RITZ_OWN(rig) r = two_points();
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_component system = join_full(&r, cross, ""); /* stores files */

    (void)state;
    ritz_component_free(&system);
    write_scene(&r, cross, text);
    folder_parse(text, &scene);
    stage_of(&r, &scene, &ritz_method_full, &stage);
    assert_survives_every_allocation(assemble_anew(&stage));
    assert_survives_every_allocation(assemble_full_anew(&scene));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_a_joint_leaves_is_rigid),
    cmocka_unit_test(a_caged_joint_swings_on_its_spring),
    cmocka_unit_test(a_caged_cross_swings_about_both_axes),
    cmocka_unit_test(a_bushing_is_six_springs),
    cmocka_unit_test(a_cage_damps),
    cmocka_unit_test(a_rigid_joint_has_a_lever),
    cmocka_unit_test(locked_joints_are_fixed_ones),
    cmocka_unit_test(an_offset_reaches_another_grid),
    cmocka_unit_test(joints_agree_with_each_other),
    cmocka_unit_test(stiff_cages_approach_locked_joints),
    cmocka_unit_test(a_turned_scene_is_the_same),
    cmocka_unit_test(ends_can_be_exchanged),
    cmocka_unit_test(full_order_agrees),
    cmocka_unit_test(several_swept_joints_agree_with_full_order),
    cmocka_unit_test(every_combination_of_settings_is_assembled),
    cmocka_unit_test(ports_that_do_not_fit_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(joints, tests, folder_make, folder_remove)
