/*
 * Bodies of a scene before they are joined: their constraints give the joined
 * system, redundant rows of loops are named, and a loop that closes only to
 * rounded digits has the same rank.
 */
#include "testing.h"

#include "blade.h"
#include "bodies.h"
#include "dualspin.h"
#include "scenes.h"

#include "assembly/assembly.h"

#include <float.h>
#include <stdio.h>

enum { LINKS = 4 };

static const char joints[] =
    "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
    "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1]}\n"
    "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, 0, 1]}\n"
    "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, 1], "
    "state: caged, stiffness: 4, damping: 2}\n";

/* Four-bar linkage of ground A, crank B, coupler C and rocker D, whose lengths
   are 3, 1, 3.1 and 1.2. */
static ritz_status build_linkage(ritz_scene *scene, ritz_stage *stage)
{
    static const double end[LINKS][2] = {
        {3.0, 0.0}, {1.0, 0.0}, {3.1, 0.0}, {1.2, 0.0}};
    char text[3000] = "scene: linkage\ncomponents:\n";
    size_t used = strlen(text);
    ritz_reduced part[LINKS] = {0};

    for (int64_t k = 0; k < LINKS; k++) {
        const double place[2][3] = {{0.0}, {end[k][0], end[k][1], 0.0}};
        ritz_component body = {0};

        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  %c: {model: m, basis: full}\n",
                                 (char)('A' + k));
        assert_ok(body_chain(2, place, 1, 31 + (uint64_t)k, &body));
        assert_ok(reduce_with(&body, &ritz_method_rigid, -1, &part[k]));
        ritz_component_free(&body);
    }
    snprintf(text + used, sizeof text - used,
             "joints:\n%sdamping: {modal: 0.01}\n", joints);
    assert_ok(ritz_scene_parse("linkage.yaml", text, scene));
    return ritz_stage_from(scene, part, stage);
}

/*
 * Settings that close the loop: of the crank at p, the angles q of the coupler
 * and r of the rocker in the axes of the ground follow from
 *
 *     (cos p, sin p) + 3.1 (cos q, sin q) = (3, 0) + 1.2 (cos r, sin r).
 */
static void close_loop(double digits, char *at, size_t size)
{
    const double degree = 3.14159265358979323846 / 180.0;
    const double p = 70.0 * degree;
    const double x = 3.0 - cos(p), y = -sin(p);
    const double d = sqrt(x * x + y * y);
    const double q =
        atan2(y, x) + acos((3.1 * 3.1 + d * d - 1.2 * 1.2) / (2.0 * 3.1 * d));
    const double r = atan2(sin(p) + 3.1 * sin(q), cos(p) + 3.1 * cos(q) - 3.0);
    const double angle[LINKS] = {p, q - p, r - q, -r};

    for (int k = 0; k < LINKS; k++) {
        const double value = round(angle[k] / degree * digits) / digits;
        const size_t used = k > 0 ? strlen(at) : 0;

        (void)snprintf(at + used, size - used, "%s%c=%.17g", k > 0 ? "," : "",
                       'a' + k, value);
    }
}

/* M_e = P'MP = I, K_e = P'KP, D_e = P'DP and C P = 0, each entry to some eps of
   the terms of its sum. */
static void assert_joins(const ritz_unjoined *u, const ritz_configuration *c,
                         double zeta)
{
    RITZ_OWN(ritz_dense) M = {0}, K = {0}, D = {0}, C = {0};

    assert_ok(ritz_dense_congruence(&u->M, &u->P, &M));
    assert_ok(ritz_dense_congruence(&u->K, &u->P, &K));
    assert_ok(ritz_dense_congruence(&u->D, &u->P, &D));
    assert_ok(ritz_dense_mul(&u->C, &u->P, &C));
    for (int64_t j = 0; j < c->K.ncol; j++)
        for (int64_t i = 0; i < c->K.ncol; i++) {
            const double flexible = i == j && j >= c->num_rigid;
            const double own = c->D.val ? ritz_dense_col(&c->D, j)[i] : 0.0;
            const double top = c->lambda[c->K.ncol - 1];

            assert_near(ritz_dense_col(&M, j)[i], i == j, 1e3 * DBL_EPSILON);
            assert_near(ritz_dense_col(&K, j)[i], i == j ? c->lambda[j] : 0.0,
                        1e3 * DBL_EPSILON * fmax(top, 1.0));
            assert_near(ritz_dense_col(&D, j)[i],
                        own + flexible * 2.0 * zeta * sqrt(fabs(c->lambda[j])),
                        1e4 * DBL_EPSILON * fmax(top, 1.0));
        }
    assert_near(ritz_dense_max(&C), 0.0, 1e3 * DBL_EPSILON);
}

/* Rigid links in space close a plane loop. Of 20 rows 17 are independent: those
   of the last hinge for the position along its axis and for both rotations
   across the axis follow from the others. */
static void assert_loop(const ritz_stage *stage, const char *at)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    ritz_constrained_request how = {0};
    double setting[LINKS] = {0.0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_unjoined) u = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    assert_ok(ritz_scene_settings(stage->scene, at, setting));
    assert_ok(ritz_stage_assemble(stage, setting, &c));
    assert_int_equal(c.rank, 17);
    assert_ok(
        ritz_stage_unjoined(stage, setting, &c, &stage->scene->damping, &u));
    assert_int_equal(u.num_rows, 20);
    assert_joins(&u, &c, 0.01);
    request.seconds = 0.1;
    request.step = 0.01;
    assert_ok(ritz_constrained_parse("index-2", &how));
    assert_ok(ritz_simulate_constrained(&u, &how, &request, &facts, &s));
    assert_int_equal(facts.rank, 17);
    assert_int_equal(facts.num_redundant, 3);
    for (int k = 0; k < 3; k++)
        assert_true(u.row[facts.redundant[k]][0] == 'd');
    assert_string_equal(u.row[0], "a translation 1");
    assert_string_equal(u.row[19], "d rotation 2");
    /* eigenvalues of 24 unjoined and 7 joined coordinates are the same */
    assert_near(facts.joined_hz, ritz_eigen_hertz(c.lambda[c.K.ncol - 1]),
                1e-9 * facts.joined_hz);
}

static void redundant_rows_of_a_loop_are_named(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    char at[256];

    (void)state;
    assert_ok(build_linkage(&scene, &stage));
    for (int k = 3; k < 14; k += 2) {
        close_loop(pow(10.0, k), at, sizeof at);
        assert_loop(&stage, at);
    }
}

static void bodies_and_constraints_give_the_joined_system(void **state)
{
    double setting[2] = {60.0, 0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_unjoined) u = {0};

    (void)state;
    dualspin_or_skip();
    assert_ok(dualspin_stage(&scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    assert_ok(ritz_stage_unjoined(&stage, setting, &c, NULL, &u));
    assert_int_equal(u.num_rows, c.rank);
    assert_int_equal(u.P.nrow, u.n);
    assert_int_equal(u.io.num_outputs, c.io.num_outputs);
    assert_true(u.D.val == NULL);
}

/* P'AP; A need not be symmetric. */
static void project(const ritz_dense *A, const ritz_dense *P, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AP = {0};

    assert_ok(ritz_dense_mul(A, P, &AP));
    assert_ok(ritz_dense_mul_tn(P, &AP, out));
}

/* Spin terms are in K and D, and the centrifugal load is one more input. */
static void matrices_of_the_bodies_include_a_spin(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_unjoined) u = {0};
    RITZ_OWN(ritz_dense) K = {0}, D = {0};

    (void)state;
    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 0, 1], rate: 4}\n", 6,
                          &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    assert_ok(ritz_stage_unjoined(&stage, NULL, &c, NULL, &u));
    assert_int_equal(u.num_rows, 0);
    assert_int_equal(u.io.num_inputs, c.io.num_inputs);
    assert_string_equal(u.io.input[u.io.num_inputs - 1], RITZ_SPIN_INPUT);
    project(&u.K, &u.P, &K);
    project(&u.D, &u.P, &D);
    assert_true(ritz_dense_skew(&D) > 0.5);
    for (int64_t k = 0; k < K.nrow * K.ncol; k++) {
        const double top = c.lambda[K.ncol - 1];

        assert_near(K.val[k], c.K.val[k], 1e3 * DBL_EPSILON * top);
        assert_near(D.val[k], c.D.val[k], 1e3 * DBL_EPSILON * 8.0);
    }
}

static void structural_damping_is_refused(void **state)
{
    double setting[LINKS] = {0.0};
    char at[256];
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_unjoined) u = {0};

    (void)state;
    assert_ok(build_linkage(&scene, &stage));
    close_loop(1e12, at, sizeof at);
    assert_ok(ritz_scene_settings(&scene, at, setting));
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    assert_ok(ritz_dense_identity(6, &stage.body[1].K4));
    assert_fails(ritz_stage_unjoined(&stage, setting, &c, NULL, &u),
                 RITZ_ERR_ARGUMENT, "structural damping");
}

static ritz_status try_unjoined(const ritz_stage *stage, const double *setting,
                                const ritz_configuration *c)
{
    RITZ_OWN(ritz_unjoined) u = {0};

    return ritz_stage_unjoined(stage, setting, c, &stage->scene->damping, &u);
}

static void unjoined_bodies_survive_every_allocation(void **state)
{
    double setting[LINKS] = {0.0};
    char at[256];
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    assert_ok(build_linkage(&scene, &stage));
    close_loop(1e12, at, sizeof at);
    assert_ok(ritz_scene_settings(&scene, at, setting));
    assert_ok(ritz_stage_assemble(&stage, setting, &c));
    assert_survives_every_allocation(try_unjoined(&stage, setting, &c));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(redundant_rows_of_a_loop_are_named),
    cmocka_unit_test(bodies_and_constraints_give_the_joined_system),
    cmocka_unit_test(matrices_of_the_bodies_include_a_spin),
    cmocka_unit_test(structural_damping_is_refused),
    cmocka_unit_test(unjoined_bodies_survive_every_allocation),
};

TEST_MODULE(unjoined, tests, NULL, NULL)
