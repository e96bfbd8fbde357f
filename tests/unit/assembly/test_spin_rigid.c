/*
 * Rigid bodies in scenes that spin: stiffness of their rotation against the
 * potential of mass points that turn by finite angles, hinged blades against
 * closed forms, a mass beyond the end of a blade against a beam, and the pull
 * that no load `tip` has.
 */
#include "testing.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/vector.h"
#include "blade.h"
#include "drafts.h"
#include "linear/general.h"
#include "model/spin.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 3 };

/* Mass points at grids 10, 13 and 16, of which the first two are ports. */
typedef struct swarm {
    double mass[POINTS], place[POINTS][3];
} swarm;

/* @p stiffness of springs to the ground at the first grid, which turns the
   component into one that is held. */
static ritz_status swarm_component(const swarm *of, double stiffness,
                                   ritz_component *out)
{
    draft d = {0};
    RITZ_OWN(ritz_component) body = {0};
    int64_t at[6];
    double k[6];

    draft_new(POINTS, &d);
    for (int64_t i = 0; i < POINTS; i++) {
        memcpy(d.place[i], of->place[i], sizeof d.place[i]);
        for (int64_t a = 0; a < 3; a++)
            draft_add(&d, 6 * i + a, 6 * i + a, of->mass[i]);
    }
    RITZ_CHECK(draft_component(&d, &body));
    draft_free(&d);
    for (int64_t a = 0; a < 6; a++) {
        at[a] = a;
        k[a] = stiffness;
    }
    if (stiffness > 0.0) {
        ritz_sparse_free(&body.K);
        RITZ_CHECK(ritz_sparse_from_triplets(body.num_dofs, body.num_dofs, 6,
                                             at, at, k, &body.K));
    }
    RITZ_CHECK(add_port(&body, "a", 10));
    RITZ_CHECK(add_port(&body, "b", 13));
    RITZ_MOVE(*out, body);
    return RITZ_OK;
}

static ritz_status swarm_body(const swarm *of, double stiffness,
                              ritz_reduced *out)
{
    RITZ_OWN(ritz_component) component = {0};

    RITZ_CHECK(swarm_component(of, stiffness, &component));
    return reduce_with(&component, ritz_method_find("rigid"), -1, out);
}

/* A stage of swarms, the first on springs. */
static ritz_status swarm_stage(const char *text, const swarm *of,
                               double stiffness, ritz_scene *scene,
                               ritz_stage *stage)
{
    RITZ_OWN(ritz_bodies) body = {0};

    RITZ_CHECK(ritz_scene_parse("swarm.yaml", text, scene));
    RITZ_CHECK(ritz_bodies_new(scene->num_components, &body));
    for (int64_t k = 0; k < body.count; k++)
        RITZ_CHECK(swarm_body(&of[k], k == 0 ? stiffness : 0.0, &body.item[k]));
    return ritz_stage_from(scene, body.item, stage);
}

/* ---- three bodies in a row that move as one ------------------------------ */

#define ROW_AT(angle, more)                                                    \
    "scene: row\n"                                                             \
    "components:\n"                                                            \
    "  hub: {model: a.h5, basis: rigid}\n"                                     \
    "  arm: {model: a.h5, basis: rigid}\n"                                     \
    "  end: {model: a.h5, basis: rigid}\n"                                     \
    "joints:\n"                                                                \
    "  - {name: p, between: [hub/b, arm/a], type: rigid,\n"                    \
    "     offset: [0.3, -0.2, 0.1]}\n"                                         \
    "  - {name: q, between: [arm/b, end/a], type: hinge, state: locked,\n"     \
    "     axis: [0, 0, 1], angles_deg: [" angle "]}\n" more                    \
    "spin: {axis: [2, -3, 6], through: [0.3, -0.2, 0.7], rate: 1}\n"

/* The end stands 2.2 and 0.35 from the hub where q is not turned. */
#define CLOSED                                                                 \
    "  - {name: r, between: [hub/a, end/b], type: rigid,\n"                    \
    "     offset: [2.2, 0, 0.35]}\n"

static const swarm row[3] = {
    {{1.0, 2.0, 0.5}, {{0.2, 0.1, -0.1}, {1.0, 0.5, 0.25}, {-0.5, 0.3, 0.4}}},
    {{0.7, 1.1, 0.3}, {{0.0, 0.0, 0.5}, {0.8, -0.4, 0.3}, {0.1, 0.9, -0.7}}},
    {{1.3, 0.4, 2.1}, {{0.3, 0.0, 0.0}, {0.6, 0.2, 0.1}, {0.5, -0.8, 0.2}}},
};

/* All points of the row in the frame of the hub. */
static void place_row(double x[3 * POINTS][3])
{
    const double offset[3] = {0.3, -0.2, 0.1};

    for (int i = 0; i < POINTS; i++)
        for (int a = 0; a < 3; a++) {
            const double turned[] = {-(row[2].place[i][1] - 0.0),
                                     row[2].place[i][0] - 0.3,
                                     row[2].place[i][2] - 0.0};
            const double arm = row[0].place[1][a] + offset[a];

            x[i][a] = row[0].place[i][a];
            x[POINTS + i][a] = arm + row[1].place[i][a] - row[1].place[0][a];
            x[2 * POINTS + i][a] =
                arm + row[1].place[1][a] - row[1].place[0][a] + turned[a];
        }
}

/* y = x + u, turned before by the rotation vector theta. */
static void move_point(const double x[3], const double q[6], double y[3])
{
    const double *theta = q + 3;
    const double angle = sqrt(ritz_dot(theta, theta));
    double once[3], twice[3];

    ritz_cross(theta, x, once);
    ritz_cross(theta, once, twice);
    for (int a = 0; a < 3; a++)
        y[a] = q[a] + x[a] +
               (angle > 0.0 ? sin(angle) / angle * once[a] +
                                  (1.0 - cos(angle)) / angle / angle * twice[a]
                            : 0.0);
}

/* Potential of centrifugal forces at a unit rate, -sum m r^2 / 2. */
static double potential(const double q[6])
{
    static const double n[3] = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0},
                        o[3] = {0.3, -0.2, 0.7};
    double x[3 * POINTS][3], V = 0.0;

    place_row(x);
    for (int i = 0; i < 3 * POINTS; i++) {
        double y[3], along = 0.0;

        move_point(x[i], q, y);
        for (int a = 0; a < 3; a++)
            y[a] -= o[a];
        along = ritz_dot(n, y);
        V -= 0.5 * row[i / POINTS].mass[i % POINTS] *
             (ritz_dot(y, y) - along * along);
    }
    return V;
}

/* d^2 V / dq_i dq_j by central differences with the error h^2 / 12 V''''. */
static double curvature(int i, int j)
{
    const double h = 3e-4;
    double sum = 0.0;

    for (int s = -1; s <= 1; s += 2)
        for (int t = -1; t <= 1; t += 2) {
            double q[6] = {0.0};

            q[i] += s * h;
            q[j] += t * h;
            sum += s * t * potential(q);
        }
    return sum / (4.0 * h * h);
}

/* S + KG of the coordinates q: translation of the hub's origin, rotation. */
static ritz_status row_terms(const ritz_stage *stage,
                             const ritz_configuration *c, ritz_dense *out)
{
    const ritz_port_map *port = &stage->body[0].port[0];
    RITZ_OWN(ritz_spin_terms) terms = {0};
    RITZ_OWN(ritz_dense) map = {0}, q = {0};

    RITZ_CHECK(ritz_stage_spin(stage, c, &terms));
    RITZ_CHECK(ritz_dense_mul(&port->map, &c->P[0], &map));
    RITZ_CHECK(ritz_dense_identity(6, &q)); /* the port's motion by q */
    for (int j = 0; j < 3; j++) {
        const double theta[3] = {j == 0, j == 1, j == 2};

        ritz_cross(theta, port->origin, ritz_dense_col(&q, 3 + j));
    }
    RITZ_CHECK(ritz_general_solve(&map, false, &q));
    ritz_dense_add(1.0, &terms.KG, &terms.S);
    return ritz_dense_congruence(&terms.S, &q, out);
}

/* The terms of a row, and the joint that closes a loop. */
static ritz_status measure_row(const char *text, int64_t *loop, ritz_dense *out)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) rest = {0};

    RITZ_CHECK(swarm_stage(text, row, 0.0, &scene, &stage));
    scene.spin.given = false;
    RITZ_CHECK(ritz_stage_assemble(&stage, scene.setting, &rest));
    scene.spin.given = true;
    assert_int_equal(rest.K.nrow, 6);
    RITZ_CHECK(ritz_stage_spin_loop(&stage, loop));
    return row_terms(&stage, &rest, out);
}

static void rotation_has_the_potential_of_finite_angles(void **)
{
    RITZ_OWN(ritz_dense) found = {0};
    int64_t loop = 0;

    assert_ok(measure_row(ROW_AT("90", ""), &loop, &found));
    assert_int_equal(loop, -1);
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++) /* h^2 / 12 V'''' */
            assert_near(ritz_dense_col(&found, j)[i], curvature(i, j), 5e-6);
}

/* All bodies move as one: one more joint changes nothing. */
static void a_loop_stiffens_as_its_tree_of_joints(void **)
{
    RITZ_OWN(ritz_dense) chain = {0}, closed = {0};
    int64_t loop = 0;

    assert_ok(measure_row(ROW_AT("0", ""), &loop, &chain));
    assert_ok(measure_row(ROW_AT("0", CLOSED), &loop, &closed));
    assert_int_equal(loop, 2);
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++)
            assert_near(ritz_dense_col(&closed, j)[i],
                        ritz_dense_col(&chain, j)[i], 1e-12);
}

/* ---- an arm to a component that names its loads --------------------------- */

#define ARMED                                                                  \
    "scene: armed\n"                                                           \
    "components:\n"                                                            \
    "  hub: {model: a.h5, basis: rigid}\n"                                     \
    "  mass: {model: a.h5, basis: rigid, stiffening: {spin_zz: none}}\n"       \
    "joints:\n"                                                                \
    "  - {name: p, between: [hub/a, mass/a], type: rigid,\n"                   \
    "     offset: [0.5, 0, 0]}\n"                                              \
    "spin: {axis: [0, 0, 1], rate: 1}\n"

static const swarm centre = {
    {0.1, 0.1, 0.1}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.3}, {0.0, 0.0, -0.3}}};
static const swarm point = {
    {2.0, 0.0, 0.0}, {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, 1.0, 0.0}}};

static ritz_status armed_stage(ritz_scene *scene, ritz_stage *stage)
{
    RITZ_OWN(ritz_bodies) body = {0};
    ritz_reduced_load *load = NULL;

    RITZ_CHECK(ritz_scene_parse("armed.yaml", ARMED, scene));
    RITZ_CHECK(ritz_bodies_new(2, &body));
    RITZ_CHECK(swarm_body(&centre, 0.0, &body.item[0]));
    RITZ_CHECK(swarm_body(&point, 0.0, &body.item[1]));
    RITZ_CHECK_NEW(load, 1);
    body.item[1].load = load;
    body.item[1].num_loads = 1;
    snprintf(load->name, sizeof load->name, "none");
    RITZ_CHECK(ritz_dense_new(6, 6, &load->KG));
    return ritz_stage_from(scene, body.item, stage);
}

/* The load of the mass, 0, has not the arm of 0.5 that leads to it: flapping of
   the hub has the stiffness m d^2 - int z^2, and rotation about the axis none. */
static void an_arm_to_a_component_with_loads_stiffens(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) rest = {0};
    RITZ_OWN(ritz_dense) found = {0};

    assert_ok(armed_stage(&scene, &stage));
    scene.spin.given = false;
    assert_ok(ritz_stage_assemble(&stage, scene.setting, &rest));
    scene.spin.given = true;
    assert_ok(row_terms(&stage, &rest, &found));
    assert_near(ritz_dense_col(&found, 4)[4], 2.0 * 0.25 - 0.2 * 0.09, 1e-12);
    assert_near(ritz_dense_col(&found, 5)[5], 0.0, 1e-12);
}

/* ---- a hinged blade ------------------------------------------------------ */

#define HINGED                                                                 \
    "scene: hinged\n"                                                          \
    "components:\n"                                                            \
    "  hub: {model: a.h5, basis: full}\n"                                      \
    "  blade: {model: a.h5, basis: rigid}\n"                                   \
    "joints:\n"                                                                \
    "  - {name: h, between: [hub/b, blade/a], type: hinge, axis: %s}\n"        \
    "spin: {axis: [0, 0, 1], rate: 3}\n"

/* Two points on a line through the hinge: m c and J about it. */
static const swarm hub = {
    {1e-3, 1e-3, 1e-3}, {{0.25, 0.0, 0.0}, {0.25, 0.0, 0.0}, {0.0, 0.1, 0.0}}};
static const swarm line = {{0.0, 1.0, 2.0},
                           {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.5, 0.0, 0.0}}};

/* The square of the lowest frequency: others are of the hub's springs. */
static double hinged(const char *axis)
{
    const swarm of[] = {hub, line};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    char text[1000];

    snprintf(text, sizeof text, HINGED, axis);
    assert_ok(swarm_stage(text, of, 1e9, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, scene.setting, &c));
    return c.lambda[0];
}

/* With the hinge at e, flapping has W^2 (1 + m c e / J), and lagging has
   W^2 m c e / J; m c = 3.5, J = 4.75, e = 0.25. */
static void a_hinged_blade_flaps_and_lags_by_closed_forms(void **)
{
    const double part = 3.5 * 0.25 / 4.75;

    assert_near(hinged("[0, 1, 0]"), 9.0 * (1.0 + part), 1e-6);
    assert_near(hinged("[0, 0, 1]"), 9.0 * part, 1e-6);
}

/* ---- a mass beyond the end of a flexible blade --------------------------- */

#define TIPPED                                                                 \
    "scene: tipped\n"                                                          \
    "components:\n"                                                            \
    "  blade: {model: b.h5, basis: full,\n"                                    \
    "    stiffening: {spin_zz: spin%s}}\n"                                     \
    "  mass: {model: m.h5, basis: rigid}\n"                                    \
    "joints:\n"                                                                \
    "  - {name: j, between: [blade/end, mass/a], type: fixed}\n"               \
    "spin: {axis: [0, 0, 1], rate: %g}\n"

/* A mass of 2 whose centre is 0.3 beyond its port. */
static const swarm beyond = {
    {0.0, 1.0, 1.0}, {{0.0, 0.0, 0.0}, {0.3, 0.1, 0.0}, {0.3, -0.1, 0.0}}};

static ritz_status tipped_stage(const char *tip, double rate, ritz_scene *scene,
                                ritz_stage *stage)
{
    char text[1000];
    RITZ_OWN(ritz_component) blade = {0};
    RITZ_OWN(ritz_bodies) body = {0};

    snprintf(text, sizeof text, TIPPED, tip, rate);
    RITZ_CHECK(ritz_scene_parse("tipped.yaml", text, scene));
    RITZ_CHECK(ritz_bodies_new(2, &body));
    RITZ_CHECK(blade_component(&blade));
    RITZ_CHECK(
        reduce_with(&blade, ritz_method_find("full"), -1, &body.item[0]));
    RITZ_CHECK(swarm_body(&beyond, 0.0, &body.item[1]));
    return ritz_stage_from(scene, body.item, stage);
}

static void a_mass_beyond_the_end_stiffens_a_blade(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    assert_ok(tipped_stage(", tip: tip", 3.0, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    /* NumPy, 12 elements and an arm of E I = 1e7, which adds 4e-8 */
    assert_near(sqrt(c.lambda[2]), 3.26475328, 2e-7);
    assert_near(sqrt(c.lambda[4]), 17.28234202, 2e-6);
}

/* Without KG lagging is as unstable as softening makes it, and flapping has the
   frequency at rest. */
static void an_inconsistent_model_leaves_rotation_out(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) rest = {0}, spun = {0};

    assert_ok(tipped_stage(", tip: tip", 3.0, &scene, &stage));
    scene.spin.model = RITZ_SPIN_INCONSISTENT;
    assert_ok(ritz_stage_assemble(&stage, NULL, &spun));
    scene.spin.given = false;
    assert_ok(ritz_stage_assemble(&stage, NULL, &rest));
    assert_true(spun.lambda[0] < -1.0);
    assert_near(spun.lambda[2], rest.lambda[2], 1e-9);
}

/* ---- pull that no load has ----------------------------------------------- */

static void limit_tipped(const char *tip, double *rate, double without_pull[2])
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_spin_limits limits = {0};

    assert_ok(tipped_stage(tip, 1.0, &scene, &stage));
    assert_ok(
        ritz_stage_spin_limits(&stage, NULL, 1e-3, &limits, without_pull));
    *rate = limits.negligible;
}

/* The estimate is the stiffness of a string, times 6/5 of a cantilever with a
   load at its end: the first mode has nearly that. */
static void the_pull_of_outboard_bodies_is_estimated(void **)
{
    double with = 0.0, without = 0.0, pull[2], none[2];

    limit_tipped(", tip: tip", &with, none);
    limit_tipped("", &without, pull);
    assert_true(isinf(none[0]) && isinf(none[1]) && isinf(pull[1]));
    assert_near(without / with, 1.0, 0.02); /* measured 1.012 */
    assert_true(pull[0] > without);         /* there are other terms */
}

static void mass_outboard_is_that_of_all_bodies_held(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    double mass = 0.0;

    assert_ok(tipped_stage("", 1.0, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    assert_ok(ritz_stage_spin_outboard(&stage, &c, 0, &mass));
    assert_near(mass, 2.0, 1e-12);
    assert_ok(ritz_stage_spin_outboard(&stage, &c, 1, &mass));
    assert_near(mass, 0.0, 0.0);
}

/* ---- motion of a body as a whole ----------------------------------------- */

/* Columns of translations and rotations about `from`, of a body whose rigid
   columns are those about its basic origin. */
static void assert_moves(const ritz_reduced *body, const ritz_dense *motion)
{
    const ritz_port_map *port = &body->port[0];

    assert_int_equal(motion->nrow, 6);
    for (int64_t j = 0; j < motion->ncol; j++)
        for (int64_t i = 0; i < 6; i++)
            assert_near(ritz_dense_col(motion, j)[i],
                        ritz_dense_col(&port->map, j)[i], 1e-12);
}

/* Ports of translations determine a rotation as ports with rotations do, unless
   their grids are on a line: the mass of the third does then. */
static void translations_determine_a_rotation(void **)
{
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_dense) motion = {0};
    bool rigid = false;

    assert_ok(swarm_body(&row[0], 0.0, &body));
    assert_true(body.num_ports == 2);
    body.port[1].count = 3; /* T1 to T3 */
    assert_ok(
        ritz_spin_rigid_motion(&body, body.port[0].origin, &rigid, &motion));
    assert_true(rigid);
    assert_moves(&body, &motion);
    ritz_dense_free(&motion);
    assert_ok(ritz_spin_port_motion(&body, &body.port[0], body.port[0].origin,
                                    &motion));
    assert_moves(&body, &motion);
}

/* Masses that nothing joins have no motion as a whole. */
static void loose_masses_are_not_rigid(void **)
{
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_reduced) body = {0};
    RITZ_OWN(ritz_dense) motion = {0};
    bool rigid = true, flexible = true;

    assert_ok(swarm_component(&row[0], 0.0, &component));
    assert_ok(reduce_with(&component, ritz_method_find("full"), -1, &body));
    assert_ok(
        ritz_spin_rigid_motion(&body, body.port[0].origin, &rigid, &motion));
    assert_false(rigid);
    assert_ok(ritz_spin_is_flexible(&body, &flexible));
    assert_false(flexible);
}

static ritz_status spin_tipped(void *of)
{
    const ritz_stage *stage = of;
    RITZ_OWN(ritz_configuration) c = {0};
    ritz_spin_limits limits = {0};
    double without_pull[2], mass = 0.0;
    int missing = 0;

    RITZ_CHECK(ritz_stage_assemble(stage, NULL, &c));
    RITZ_CHECK(ritz_stage_missing_stiffening(stage, &c, 0, &missing));
    RITZ_CHECK(ritz_stage_spin_outboard(stage, &c, 0, &mass));
    return ritz_stage_spin_limits(stage, NULL, 0.01, &limits, without_pull);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(tipped_stage("", 1.0, &scene, &stage));
    assert_survives_every_allocation(spin_tipped(&stage));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rotation_has_the_potential_of_finite_angles),
    cmocka_unit_test(a_loop_stiffens_as_its_tree_of_joints),
    cmocka_unit_test(an_arm_to_a_component_with_loads_stiffens),
    cmocka_unit_test(a_hinged_blade_flaps_and_lags_by_closed_forms),
    cmocka_unit_test(a_mass_beyond_the_end_stiffens_a_blade),
    cmocka_unit_test(an_inconsistent_model_leaves_rotation_out),
    cmocka_unit_test(the_pull_of_outboard_bodies_is_estimated),
    cmocka_unit_test(mass_outboard_is_that_of_all_bodies_held),
    cmocka_unit_test(translations_determine_a_rotation),
    cmocka_unit_test(loose_masses_are_not_rigid),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(spin_rigid, tests, NULL, NULL)
