/* Inputs of a scene that act in several directions, or against another port. */
#include "testing.h"

#include "beams.h"

static void read(const char *inputs, ritz_scene *scene, ritz_stage *stage)
{
    assert_ok(beams_stage(false, inputs, scene, stage));
}

static void release(ritz_scene *scene, ritz_stage *stage)
{
    ritz_stage_free(stage);
    ritz_scene_free(scene);
}

/* Coordinates of A are nodes 1 and 2, of B nodes 2, 3 and 4, three each. */
static void directions_of_a_list_act_at_once(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};

    read("inputs: [{name: u, at: A/middle, component: [1, 6, 2], scale: 3}]\n",
         &scene, &stage);
    assert_int_equal(stage.io.num_inputs, 1);
    for (int64_t k = 0; k < stage.num_coordinates; k++)
        assert_near(stage.io.B.val[k], k >= 3 && k < 6 ? 3.0 : 0.0, 0.0);
    release(&scene, &stage);
}

static void a_motor_acts_against_the_other_side(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};

    read("inputs: [{name: u, at: A/n1, component: 6, against: B/n4}]\n", &scene,
         &stage);
    for (int64_t k = 0; k < stage.num_coordinates; k++)
        assert_near(stage.io.B.val[k], (k == 2) - (k == 14), 0.0);
    release(&scene, &stage);
}

static void forces_that_make_no_sense_are_refused(void **)
{
    static const struct {
        const char *inputs, *words;
    } cases[] = {
        {"inputs: [{name: u, at: A/n1, component: []}]\n",
         "beams.yaml:7:41: 1 to 6 directions can be listed, not 0"},
        {"inputs: [{name: u, at: A/n1, component: [1, 7]}]\n",
         "component 7 is none of 1-3, along the axes, and 4-6, about them"},
        {"inputs: [{name: u, at: A/n1, component: [1, 2, 1]}]\n",
         "direction 1 is listed before"},
        {"inputs: [{name: u, at: A/n1, component: 1, against: A/n1}]\n",
         "input 'u' acts against itself"},
        {"inputs: [{name: u, at: A/n1, component: 1, against: C/n1}]\n",
         "unknown component 'C'"},
        {"outputs: [{name: y, at: A/n1, component: [1, 2]}]\n",
         "a word or number is expected here"},
        {"outputs: [{name: y, at: A/n1, component: 1, against: B/n3}]\n",
         "unknown key 'against'"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};

        assert_fails(beams_stage(false, cases[k].inputs, &scene, &stage),
                     RITZ_ERR_FORMAT, cases[k].words);
    }
}

static void a_port_without_the_direction_is_refused(void **)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};

    assert_fails(
        beams_stage(false, "inputs: [{name: u, at: A/n1, component: [1, 3]}]\n",
                    &scene, &stage),
        RITZ_ERR_ARGUMENT, "input 'u': port 'n1' has no direction 3");
    ritz_scene_free(&scene);
    assert_fails(
        beams_stage(false,
                    "inputs: [{name: u, at: A/n1, component: 1, against: B/n9}]"
                    "\n",
                    &scene, &stage),
        RITZ_ERR_ARGUMENT, "there is no port 'n9'");
    ritz_scene_free(&scene);
}

static ritz_status read_anew(void)
{
    ritz_scene scene = {0};
    ritz_status status = ritz_scene_parse(
        "s",
        "{scene: s, components: {a: {model: a}, b: {model: b}}, inputs: "
        "[{name: u, at: a/p, component: [1, 2], against: b/q}]}",
        &scene);

    ritz_scene_free(&scene);
    return status;
}

static void no_allocation_failure_leaks(void **)
{
    assert_survives_every_allocation(read_anew());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(directions_of_a_list_act_at_once),
    cmocka_unit_test(a_motor_acts_against_the_other_side),
    cmocka_unit_test(forces_that_make_no_sense_are_refused),
    cmocka_unit_test(a_port_without_the_direction_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(forces, tests, NULL, NULL)
