/*
 * Joints between elastic bodies, compared with equivalent joints, with the same
 * joint turned or with exchanged ends, and with the assembly at full order.
 */
#include "testing.h"

#include "assembly/assembly.h"
#include "bodies.h"
#include "folder.h"
#include "rigs.h"

#include <ritz/assembly.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>

/* Relative to the largest eigenvalue: n eps with n = 12 to 90 dofs, and a
   margin of ten. */
static const double elastic = 1e3 * DBL_EPSILON;

#define HELD(type) "- {name: p, between: [A/g3, B/g1], type: " type "}\n"

/* Eigenvalues agree within `error` times the largest one; the numbers of rigid
   modes are equal. */
static void assert_alike(const ritz_configuration *a,
                         const ritz_configuration *b, double error)
{
    int64_t n = a->K.ncol;

    assert_int_equal(b->K.ncol, n);
    assert_int_equal(b->num_rigid, a->num_rigid);
    for (int64_t k = 0; k < n; k++)
        assert_near(b->lambda[k], a->lambda[k], error * a->lambda[n - 1]);
}

static void locked_joints_are_fixed_ones(void **)
{
    static const char *const locked[] = {
        HELD("rigid"),
        HELD("hinge, axis: [1, 2, 3], state: locked"),
        HELD("slider, axis: [1, 2, 3], state: locked"),
        HELD("universal, axes: [[1, 2, 3], [1, 0, 1]], state: locked"),
        HELD("spherical, state: locked"),
    };
    RITZ_OWN(rig) r = rig_of_chains(2);
    RITZ_OWN(ritz_configuration) one = rig_join(&r, HELD("fixed"), "");

    for (size_t k = 0; k < sizeof locked / sizeof *locked; k++) {
        RITZ_OWN(ritz_configuration) two = rig_join(&r, locked[k], "");

        assert_int_equal(two.rank, 6);
        assert_alike(&one, &two, elastic);
    }
}

/* On a rigid body, an offset from grid 1 to grid 3 replaces the port at grid
   3. */
static void an_offset_reaches_another_grid(void **)
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
    RITZ_OWN(rig) r = rig_of_chains(3);
    ritz_configuration c[4] = {0};
    char joints[600], at[40];

    for (int k = 0; k < 4; k++) {
        snprintf(joints, sizeof joints, "%s%s", reached[k], bushing);
        snprintf(at, sizeof at, "p=%.17g", length);
        c[k] =
            rig_join_by(&r, &ritz_method_rigid, -1, joints, k == 3 ? at : "");
        assert_int_equal(c[k].num_rigid, 6);
        assert_alike(&c[0], &c[k], elastic);
    }
    for (int k = 0; k < 4; k++)
        ritz_configuration_free(&c[k]);
}

/*
 * Each case states one system twice. A universal joint equals two hinges with a
 * massless body between them, a spherical joint equals three hinges with two
 * such bodies.
 */
static void joints_agree_with_each_other(void **)
{
    static const struct {
        int64_t points; /* number of massless bodies: C, or C and D */
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

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(rig) r = rig_of_chains(2);
        RITZ_OWN(ritz_configuration)
        one = rig_join(&r, cases[k].one, cases[k].at_one);
        RITZ_OWN(ritz_configuration) two = {0};

        for (int64_t p = 0; p < cases[k].points; p++)
            assert_ok(body_point(0.0, 0.0, &r.body[r.count++]));
        two = rig_join(&r, cases[k].two, cases[k].at_two);
        if (k + 1 < sizeof cases / sizeof *cases)
            assert_alike(&one, &two, elastic);
        for (int64_t j = 0; j < one.K.ncol; j++) /* 1e12 N/m replaces a lock */
            assert_near(two.lambda[j], one.lambda[j],
                        1e-6 * one.lambda[one.K.ncol - 1]);
    }
}

/* A stiff spring k in place of a lock changes lambda in proportion to 1 / k. */
static void stiff_cages_approach_locked_joints(void **)
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
    RITZ_OWN(rig) r = rig_of_chains(2);
    char joint[400];

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_configuration)
        locked = rig_join(&r, cases[k].locked, cases[k].at);
        double error[2] = {0.0, 0.0};

        for (int i = 0; i < 2; i++) {
            RITZ_OWN(ritz_configuration) caged = {0};

            snprintf(joint, sizeof joint,
                     HELD("%s, state: caged, stiffness: %g"), cases[k].caged,
                     i ? 1e8 : 1e7);
            caged = rig_join(&r, joint, cases[k].at);
            assert_int_equal(caged.num_rigid, locked.num_rigid);
            for (int64_t j = 6; j < 20; j++) /* low elastic modes */
                error[i] = fmax(error[i],
                                fabs(1.0 - caged.lambda[j] / locked.lambda[j]));
        }
        assert_true(error[0] < 1e-2 && error[0] > 1e-7);
        assert_near(error[1] / error[0], 0.1, 1e-3);
    }
}

/* A joint at a setting, the same joint with its ends exchanged, and its axes,
   which a test may turn. */
typedef struct sample {
    const char *type, *at;      /* between A and B */
    const char *back, *back_at; /* between B and A */
    const char *rest;           /* keys after the axes */
    double axis[2][3];          /* of `type` */
    int64_t num_axes;           /* 0: the joint takes no axes */
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

/* YAML text of the joint, its axes turned by R: "type: hinge, axis: [..]". */
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

/* Each body's deck has its own origin; all decks are turned by the same R. */
static void a_turned_scene_is_the_same(void **)
{
    const double axis[3] = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
    uint64_t seed = 11;
    double R[9];
    RITZ_OWN(rig) r = rig_of_chains(2), turned = rig_of_chains(2);

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
        one = rig_join(&r, here, samples[k].at);
        two = rig_join(&turned, there, samples[k].at);
        assert_int_equal(one.rank, two.rank);
        assert_alike(&one, &two, elastic);
        assert_near(damping_of(&two), damping_of(&one),
                    elastic * damping_of(&one));
    }
}

static void ends_can_be_exchanged(void **)
{
    RITZ_OWN(rig) r = rig_of_chains(2);

    for (int k = 0; k < NUM_SAMPLES; k++) {
        char here[400], there[400];
        RITZ_OWN(ritz_configuration) one = {0}, two = {0};

        write_sample(&samples[k], unit, here, sizeof here);
        snprintf(there, sizeof there,
                 "- {name: p, between: [B/g1, A/g3], type: %s}\n",
                 samples[k].back);
        one = rig_join(&r, here, samples[k].at);
        two = rig_join(&r, there, samples[k].back_at);
        assert_alike(&one, &two, elastic);
        assert_near(damping_of(&two), damping_of(&one),
                    elastic * damping_of(&one));
    }
}

/* Bodies reduced by Craig-Bampton with all modes, which is exact. */
static ritz_configuration join_all_modes(const rig *r, const char *joints,
                                         const char *at)
{
    return rig_join_by(r, &ritz_method_craig_bampton, 18, joints, at);
}

/* All eigenvalues agree, and so does tr(M^-1 D), the sum of the modal
   damping. */
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

static void full_order_agrees(void **)
{
    RITZ_OWN(rig) r = rig_of_chains(2);

    for (int k = 0; k < NUM_SAMPLES; k++) {
        char joint[400];
        RITZ_OWN(ritz_configuration) c = {0};
        RITZ_OWN(ritz_component) system = {0};

        write_sample(&samples[k], unit, joint, sizeof joint);
        c = join_all_modes(&r, joint, samples[k].at);
        system = rig_join_full(&r, joint, samples[k].at);
        assert_full(&c, &system);
    }
}

/* Four joints in a row of five bodies; three of them have settings. */
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

/* Rigid modes: six of the whole, and one each of the slider, the free axis of
   the universal joint, the hinge, and the bushing, which has no stiffness about
   x. */
static void several_swept_joints_agree_with_full_order(void **)
{
    static const char *const at[] = {"one=0.1,two=0,three=10",
                                     "one=0.5,two=45,three=30",
                                     "one=-7,two=123,two.2=-80,three=260"};
    RITZ_OWN(rig) r = rig_of_chains(5);

    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_configuration) c = join_all_modes(&r, train, at[k]);
        RITZ_OWN(ritz_component) system = rig_join_full(&r, train, at[k]);

        assert_int_equal(c.rank, 5 + 4 + 5);
        assert_int_equal(c.num_rigid, 6 + 4);
        assert_full(&c, &system);
    }
}

static void every_combination_of_settings_is_assembled(void **)
{
    char text[RIG_TEXT];
    RITZ_OWN(rig) r = rig_of_chains(5);
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_system) system = {0};
    const ritz_configuration *found = NULL;

    rig_scene(&r, train, text);
    assert_ok(ritz_scene_parse("rig.yaml", text, &scene));
    rig_stage(&r, &scene, &ritz_method_rigid, -1, &stage);
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

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(locked_joints_are_fixed_ones),
    cmocka_unit_test(an_offset_reaches_another_grid),
    cmocka_unit_test(joints_agree_with_each_other),
    cmocka_unit_test(stiff_cages_approach_locked_joints),
    cmocka_unit_test(a_turned_scene_is_the_same),
    cmocka_unit_test(ends_can_be_exchanged),
    cmocka_unit_test(full_order_agrees),
    cmocka_unit_test(several_swept_joints_agree_with_full_order),
    cmocka_unit_test(every_combination_of_settings_is_assembled),
};

TEST_MODULE(joints_elastic, tests, folder_make, folder_remove)
