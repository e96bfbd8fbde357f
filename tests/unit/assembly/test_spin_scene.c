/*
 * Scenes that spin: frequencies of a rotating cantilever, the tension that
 * outboard bodies cause, and which scenes are refused.
 */
#include "testing.h"

#include "assembly/assembly.h"
#include "blade.h"
#include "scenes.h"

#include <ritz/swept.h>

#include <math.h>
#include <stdio.h>

static void spin_blade(const char *more, int64_t modes, ritz_configuration *out)
{
    char text[1000];
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    snprintf(text, sizeof text, BLADE_SCENE "%s", more);
    assert_ok(blade_stage(text, modes, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, out));
}

enum { LEAD_LAG, FLAP };

/* Frequency k, from 0, of bending in the plane of rotation, which is the lower
   one of each pair, or out of it. Of a negative square the sign is negative. */
static double bending(const ritz_configuration *c, int way, int64_t k)
{
    const double lambda = c->lambda[2 * k + way];

    return copysign(sqrt(fabs(lambda)), lambda);
}

/* Frequencies by an independent program, and the unit of their last digits. */
typedef struct reference {
    double rate, flap[3], last[3], lead_lag, lead_lag_last;
} reference;

static const reference rows[] = {
    {0.0,
     {3.5160167, 22.034845, 61.704878},
     {1e-7, 1e-6, 1e-6},
     3.5160167,
     1e-7},
    {2.0,
     {4.1373211, 22.615267, 62.280778},
     {1e-7, 1e-6, 1e-6},
     3.6217988,
     1e-7},
    {4.0,
     {5.5850065, 24.273684, 63.97418},
     {1e-7, 1e-6, 1e-5},
     3.8977298,
     1e-7},
    {10.0,
     {11.202436, 33.640986, 74.656561},
     {1e-6, 1e-6, 1e-6},
     5.0492158,
     1e-7},
};

static void the_rotating_cantilever_has_its_frequencies(void **)
{
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        for (int axis = 0; axis < 2; axis++) {
            RITZ_OWN(ritz_configuration) c = {0};
            char text[100];

            snprintf(text, sizeof text, "spin: {axis: [0, %d, %d], rate: %g}\n",
                     axis, 1 - axis, rows[r].rate);
            spin_blade(text, 0, &c);
            for (int k = 0; k < 3; k++)
                assert_near(bending(&c, FLAP, k), rows[r].flap[k],
                            0.51 * rows[r].last[k]);
            assert_near(bending(&c, LEAD_LAG, 0), rows[r].lead_lag,
                        0.51 * rows[r].lead_lag_last);
        }
    }
}

/* w1^2 in plane without KG: 12.362 - W^2, negative from 3.516 rad/s on. */
static void without_stiffening_lead_lag_becomes_unstable(void **)
{
    static const double rate[] = {2.0, 4.0, 10.0},
                        square[] = {8.362, -3.64, -87.6},
                        last[] = {1e-3, 1e-2, 1e-1};

    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_configuration) c = {0};
        char text[160];

        snprintf(text, sizeof text,
                 "spin: {axis: [0, 0, 1], rate: %g}\n"
                 "spin_model: inconsistent\n",
                 rate[k]);
        spin_blade(text, 0, &c);
        assert_near(c.lambda[0], square[k], 0.51 * last[k]);
    }
}

static void the_first_mode_has_its_stiffening(void **)
{
    RITZ_OWN(ritz_configuration) c = {0};
    double value = 0.0;

    spin_blade("", 12, &c);
    assert_string_equal(c.load[0].name, "blade:spin");
    for (int64_t j = 0; j < c.K.ncol; j++)
        if (fabs(sqrt(c.lambda[j]) - 3.5160167) < 1e-6)
            value = ritz_dense_col(&c.load[0].KG, j)[j];
    assert_near(value, 1.1933364, 0.51e-7);
}

/* D is W G, which is skew, and inputs have the centrifugal load. A ruthless
   model has neither G nor softening, but the load. */
static void a_system_that_spins_has_gyroscopic_terms_and_a_load(void **)
{
    RITZ_OWN(ritz_configuration) c = {0}, ruthless = {0};

    spin_blade("spin: {axis: [0, 0, 1], rate: 2}\n", 0, &c);
    spin_blade("spin: {axis: [0, 0, 1], rate: 2}\nspin_model: ruthless\n", 0,
               &ruthless);
    assert_true(ritz_dense_max(&c.D) > 1.0);
    assert_near(ritz_dense_skew(&c.D), 1.0, 1e-12);
    assert_int_equal(c.io.num_inputs, 1);
    assert_string_equal(c.io.input[0], RITZ_SPIN_INPUT);
    assert_true(ritz_dense_max(&c.io.B) > 1.0);
    assert_null(ruthless.D.val);
    assert_near(bending(&ruthless, LEAD_LAG, 0), 3.5160167, 0.51e-7);
    assert_int_equal(ruthless.io.num_inputs, 1);
}

/* A rod stretches statically by u(1) = W^2 rho A L^3 / (3 E A); linear elements
   with consistent loads are exact at their nodes. */
static void a_rod_stretches_by_its_closed_form(void **)
{
    RITZ_OWN(ritz_configuration) c = {0};
    double u = 0.0;
    int64_t row = 3 * BLADE_ELEMENTS - 3;

    spin_blade("spin: {axis: [0, 1, 0], rate: 0.5}\nspin_model: ruthless\n", 0,
               &c);
    for (int64_t j = 0; j < c.K.ncol; j++)
        u += ritz_dense_col(&c.P[0], j)[row] * ritz_dense_col(&c.io.B, 0)[j] /
             c.lambda[j];
    assert_near(u, 0.25 / 3e4, 1e-15);
}

/* Up to the rate that is printed no frequency of the band changes by more than
   allowed, and at that rate one changes by nearly as much. */
static void stiffening_is_negligible_below_its_rate(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_spin_limits limits = {0};
    double change = 0.0;
    RITZ_OWN(ritz_configuration) with = {0}, without = {0};
    char text[160];

    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 0, 1], rate: 1}\n", 0,
                          &scene, &stage));
    assert_ok(ritz_stage_spin_limits(&stage, NULL, 0.01, &limits, NULL));
    assert_true(limits.stable > 100.0); /* of the rod, 157 */
    snprintf(text, sizeof text, "spin: {axis: [0, 0, 1], rate: %.17g}\n",
             limits.negligible);
    spin_blade(text, 0, &with);
    snprintf(text, sizeof text,
             "spin: {axis: [0, 0, 1], rate: %.17g}\n"
             "spin_model: inconsistent\n",
             limits.negligible);
    spin_blade(text, 0, &without);
    for (int64_t j = 0; j < with.K.ncol; j++)
        change = fmax(change, sqrt(with.lambda[j] / without.lambda[j]) - 1.0);
    assert_true(change <= 0.01 * (1.0 + 1e-9));
    assert_true(change > 0.0095); /* measured 0.0099: the bound is close */
}

/* Without KG stiffness is definite up to the first frequency in the plane. */
static void the_inconsistent_model_says_where_it_fails(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_spin_limits limits = {0};

    static const char text[] = BLADE_SCENE
        "spin: {axis: [0, 0, 1], rate: 1}\nspin_model: inconsistent\n";

    assert_ok(blade_stage(text, 0, &scene, &stage));
    assert_ok(ritz_stage_spin_limits(&stage, NULL, 0.01, &limits, NULL));
    assert_near(limits.stable, 3.5160167, 0.51e-7);
}

/* ---- what is outboard ---------------------------------------------------- */

/* Three blades in a row along x: the tip of one holds the root of the next. */
#define ROW                                                                    \
    "scene: row\n"                                                             \
    "components:\n"                                                            \
    "  inner: {model: a.h5, basis: full, stiffening: {tip: tip}}\n"            \
    "  middle: {model: a.h5, basis: full%s}\n"                                 \
    "  outer: {model: a.h5, basis: full%s}\n"                                  \
    "joints:\n"                                                                \
    "  - {name: p, between: [inner/end, middle/root], type: fixed}\n"          \
    "  - {name: q, between: [middle/end, outer/root], type: fixed}\n"          \
    "spin: {axis: [0, 0, 1], rate: %g}\n"

/* A stage of the row. All blades are clamped at x = 0; the second and third
   have the port "root" at their first free grid, which is at 1/12. */
static ritz_status row_stage(const char *middle, const char *outer,
                             ritz_scene *scene, ritz_stage *stage)
{
    char text[1000];
    RITZ_OWN(ritz_bodies) body = {0};

    snprintf(text, sizeof text, ROW, middle, outer, 1.0);
    RITZ_CHECK(ritz_scene_parse("row.yaml", text, scene));
    RITZ_CHECK(ritz_bodies_new(3, &body));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_component) beam = {0};

        RITZ_CHECK(blade_component(&beam));
        if (k > 0)
            RITZ_CHECK(add_port(&beam, "root", 2));
        RITZ_CHECK(reduce_with(&beam, &ritz_method_full, -1, &body.item[k]));
        body.item[k].inertia = (ritz_inertia){
            .mass = 1.0 + k, .centre = {0.5, 0.25, 0.0}, .known = true};
    }
    return ritz_stage_from(scene, body.item, stage);
}

/*
 * The second blade begins at 1 - 1/12 and the third at twice that, so that
 * their centres have the distances 0.5 + k 11/12 from the axis along x. Their
 * positions across x do not matter. Masses are 2 and 3.
 */
static void tension_is_of_all_that_is_outboard(void **)
{
    const double d = 11.0 / 12.0;
    const double tension = 2.0 * (0.5 + d) + 3.0 * (0.5 + 2.0 * d);
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_spun) spun = {0};
    RITZ_OWN(ritz_scene) plain = {0};
    RITZ_OWN(ritz_stage) without = {0};
    RITZ_OWN(ritz_spun) bare = {0};

    assert_ok(row_stage("", "", &scene, &stage));
    assert_ok(row_stage("", "", &plain, &without));
    plain.component[0].stiffening[RITZ_STIFFENING_TIP][0] = 0;
    assert_ok(ritz_stage_spun(&stage, NULL, &spun));
    assert_ok(ritz_stage_spun(&without, NULL, &bare));
    assert_true(stage.body && stage.body[0].num_loads == 2);
    ritz_dense_add(-1.0, &bare.stage.body[0].K, &spun.stage.body[0].K);
    ritz_dense_add(-tension, &stage.body[0].load[1].KG, &spun.stage.body[0].K);
    assert_string_equal(stage.body[0].load[1].name, "tip");
    assert_near(ritz_dense_max(&spun.stage.body[0].K), 0.0, /* eps of K */
                1e-9);
}

static void a_tip_needs_one_joint_outboard(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_spun) spun = {0};

    assert_ok(row_stage("", ", stiffening: {tip: tip}", &scene, &stage));
    assert_fails(ritz_stage_spun(&stage, NULL, &spun), RITZ_ERR_ARGUMENT,
                 "component 'outer': 'tip' is of one joint that leads "
                 "outboard, and there are 0");
    assert_true(stage.body && scene.component);
    stage.body[2].inertia.known = false;
    scene.component[2].stiffening[RITZ_STIFFENING_TIP][0] = 0;
    assert_fails(ritz_stage_spun(&stage, NULL, &spun), RITZ_ERR_ARGUMENT,
                 "component 'inner': the mass of 'outer', which pulls its "
                 "tip, is not known");
}

/* ---- refusals ----------------------------------------------------------- */

static void refuse_blade(const char *text, const char *sentence)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_configuration c = {0};

    assert_ok(blade_stage(text, 4, &scene, &stage));
    assert_fails(ritz_stage_assemble(&stage, NULL, &c), RITZ_ERR_ARGUMENT,
                 sentence);
}

static void scenes_that_cannot_spin_are_refused(void **)
{
    refuse_blade("scene: s\ncomponents:\n  blade: {model: b.h5, basis: full, "
                 "stiffening: {spin_zz: spun}}\n"
                 "spin: {axis: [0, 0, 1], rate: 1}\n",
                 "component 'blade': spin_zz: unknown load 'spun', is 'spin' "
                 "meant?");
    refuse_blade(BLADE_SCENE "spin: {axis: [0, 0, 1], through: [0, 0.1, 0], "
                             "rate: 1}\n",
                 "its stiffening is of a spin about its basic origin, which is "
                 "0.1 from the axis");
    refuse_blade(BLADE_SCENE
                 "spin: {axis: [0, 0, 1], rate: 1}\n"
                 "inputs: [{name: centrifugal, at: blade/end, component: 2}]\n",
                 "input 'centrifugal' is the load of the spin");
}

static void methods_that_know_no_spin_refuse_it(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_comparison comparison = {0};
    ritz_composite composite = {0};
    ritz_component full = {0};
    const ritz_sweep_request sweep = {0};
    ritz_swept_model swept = {0};
    static const char sentence[] = "a scene that spins is for ritz-assemble";

    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 0, 1], rate: 1}\n", 4,
                          &scene, &stage));
    assert_fails(ritz_compare(&stage, &comparison), RITZ_ERR_ARGUMENT,
                 sentence);
    assert_fails(ritz_composite_new(&stage, &composite), RITZ_ERR_ARGUMENT,
                 sentence);
    assert_fails(ritz_assemble_full(&scene, NULL, &full, NULL),
                 RITZ_ERR_ARGUMENT, sentence);
    assert_fails(ritz_stage_sweep(&stage, &sweep, &swept), RITZ_ERR_ARGUMENT,
                 "no joint is turned in a scene that spins");
}

static void a_product_without_a_load_is_named(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    int missing = 0;

    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 1, 1], rate: 1}\n", 4,
                          &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    assert_ok(ritz_stage_missing_stiffening(&stage, &c, 0, &missing));
    assert_int_equal(missing, RITZ_STIFFENING_YZ);
    scene.spin.axis[1] = 0.0;
    assert_ok(ritz_stage_missing_stiffening(&stage, &c, 0, &missing));
    assert_int_equal(missing, RITZ_NUM_STIFFENINGS);
}

/* K of the system at rest with W^2 (S + KG), summed over bodies, has the
   frequencies of the system that was assembled at the rate W. */
static void terms_of_a_system_are_those_of_its_bodies(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) rest = {0}, spun = {0};
    RITZ_OWN(ritz_spin_terms) terms = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 0, 1], rate: 3}\n", 6,
                          &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &spun));
    scene.spin.given = false;
    assert_ok(ritz_stage_assemble(&stage, NULL, &rest));
    assert_fails(ritz_stage_spin(&stage, &rest, &terms), RITZ_ERR_ARGUMENT,
                 "the scene has no 'spin'");
    scene.spin.given = true;
    assert_ok(ritz_stage_spin(&stage, &rest, &terms));
    ritz_dense_add(9.0, &terms.S, &rest.K);
    ritz_dense_add(9.0, &terms.KG, &rest.K);
    assert_ok(ritz_eigen_dense(&rest.K, &rest.M, &pairs));
    for (int64_t j = 0; j < spun.K.ncol; j++) /* some eps of the largest */
        assert_near(pairs.lambda[j], spun.lambda[j],
                    1e-14 * spun.lambda[spun.K.ncol - 1]);
}

static ritz_status spin_and_limit(void *of)
{
    const ritz_stage *stage = of;
    RITZ_OWN(ritz_configuration) c = {0};
    ritz_spin_limits limits = {0};

    RITZ_CHECK(ritz_stage_assemble(stage, NULL, &c));
    return ritz_stage_spin_limits(stage, NULL, 0.01, &limits, NULL);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(blade_stage(BLADE_SCENE "spin: {axis: [0, 0, 1], rate: 1}\n", 4,
                          &scene, &stage));
    assert_survives_every_allocation(spin_and_limit(&stage));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_rotating_cantilever_has_its_frequencies),
    cmocka_unit_test(without_stiffening_lead_lag_becomes_unstable),
    cmocka_unit_test(the_first_mode_has_its_stiffening),
    cmocka_unit_test(a_system_that_spins_has_gyroscopic_terms_and_a_load),
    cmocka_unit_test(a_rod_stretches_by_its_closed_form),
    cmocka_unit_test(stiffening_is_negligible_below_its_rate),
    cmocka_unit_test(the_inconsistent_model_says_where_it_fails),
    cmocka_unit_test(tension_is_of_all_that_is_outboard),
    cmocka_unit_test(a_tip_needs_one_joint_outboard),
    cmocka_unit_test(scenes_that_cannot_spin_are_refused),
    cmocka_unit_test(methods_that_know_no_spin_refuse_it),
    cmocka_unit_test(a_product_without_a_load_is_named),
    cmocka_unit_test(terms_of_a_system_are_those_of_its_bodies),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(spin_scene, tests, NULL, NULL)
