/*
 * Axes of joints in loops that are given with a few digits: how many motions
 * are left, in every form of the joined bodies, and which axes are listed.
 */
#include "testing.h"

#include "linkage.h"

#include "assembly/assembly.h"

#include <ritz/assembly.h>
#include <ritz/constrained.h>

#include <float.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { MOST_SETTINGS = 8 };

/* Rows and columns of the constraints in time. */
static void assert_rank_in_time(const ritz_stage *stage, const double *setting,
                                const ritz_configuration *c)
{
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    ritz_constrained_request how = {0};
    RITZ_OWN(ritz_unjoined) u = {0};
    RITZ_OWN(ritz_constrained_facts) facts = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    assert_ok(ritz_stage_unjoined(stage, setting, c, NULL, &u));
    request.seconds = 0.02;
    request.step = 0.01;
    assert_ok(ritz_constrained_parse("index-2", &how));
    assert_ok(ritz_simulate_constrained(&u, &how, &request, &facts, &s));
    assert_int_equal(facts.rank, c->rank);
}

/* Rank and motions of rigid links, by elimination and in time, motions of
   elastic ones; and the axes that are listed. */
static void assert_motions(const linkage *l, const char *at, int64_t rank,
                           int64_t motions, ritz_near_axes *near)
{
    const ritz_method *const method[] = {&ritz_method_rigid, &ritz_method_full};

    for (int k = 0; k < 2; k++) {
        double setting[MOST_SETTINGS] = {0.0};
        RITZ_OWN(ritz_scene) scene = {0};
        RITZ_OWN(ritz_stage) stage = {0};
        RITZ_OWN(ritz_configuration) c = {0};

        assert_ok(stage_of_linkage(l, method[k], &scene, &stage));
        assert_true(scene.num_sweeps <= MOST_SETTINGS);
        assert_ok(ritz_scene_settings(&scene, at, setting));
        assert_ok(ritz_stage_assemble(&stage, setting, &c));
        assert_int_equal(c.num_rigid, 6 + motions);
        ritz_near_axes_free(near);
        assert_ok(ritz_stage_near_axes(&stage, setting, near));
        if (k > 0)
            continue;
        assert_int_equal(c.rank, rank);
        assert_int_equal(c.K.ncol, 6 + motions);
        assert_rank_in_time(&stage, setting, &c);
    }
}

/* One axis is listed: of a joint, off by an angle from a direction. */
static void assert_listed(const ritz_near_axes *near, int64_t joint, bool taken,
                          double angle, const double exact[static 3])
{
    assert_int_equal(near->count, 1);
    assert_int_equal(near->item[0].joint, joint);
    assert_true(near->item[0].taken == taken);
    assert_int_equal(near->item[0].others, 0);
    assert_near(near->item[0].angle, angle, 1e-3 * angle);
    /* bodies stand where the given axis puts them: second order */
    for (int i = 0; i < 3; i++)
        assert_near(near->item[0].exact[i], exact[i],
                    angle * angle + 1e3 * DBL_EPSILON);
}

static const double departs[] = {0.0,  1e-12, 1e-10, 5e-10, 1e-8, 1e-7,
                                 1e-6, 1e-5,  9e-5,  1e-3,  9e-3, 0.1};
enum { DEPARTS = sizeof departs / sizeof *departs };

/* Rank and motions where the last joint's axis departs by d, and the joint and
   the direction that are to be listed. */
typedef struct departing {
    linkage of;
    const char *joints[2];   /* before and after d */
    const char *at, *tilted; /* settings, and those for a d above 1e-4 */
    int64_t rank, motions, joint;
    double exact[3];
} departing;

static void assert_departing(const departing *it)
{
    char text[1000];
    linkage l = it->of;
    RITZ_OWN(ritz_near_axes) near = {0};

    l.joints = text;
    for (int k = 0; k < DEPARTS; k++) {
        const double d = departs[k];
        const bool taken = d < 1e-4;

        snprintf(text, sizeof text, "%s%.17g%s", it->joints[0], d,
                 it->joints[1]);
        assert_motions(&l, taken ? it->at : it->tilted, it->rank + !taken,
                       it->motions - !taken, &near);
        if (d < 1e-9 || d > 1e-2)
            assert_int_equal(near.count, 0);
        else if (strcmp(it->at, it->tilted) != 0)
            assert_int_equal(near.count, 1); /* bodies are tilted by it too */
        else
            assert_listed(&near, it->joint, taken, atan(d), it->exact);
    }
}

/* Ground A, crank B, coupler C, rocker D: a parallelogram. */
static void a_four_bar_linkage_moves_with_a_rounded_axis(void **state)
{
    departing it = {
        .of = {.count = 4, .end = {{3, 0, 0}, {0, 1, 0}, {3, 0, 0}, {0, 1, 0}}},
        .joints =
            {"- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, "
             "1]}\n"
             "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, "
             "1]}\n"
             "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, ",
             ", "
             "1]}\n"
             "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, "
             "1]}\n"},
        .at = "",
        .tilted = "",
        .rank = 17,
        .motions = 1,
        .joint = 2,
        .exact = {0, 0, 1}};

    (void)state;
    assert_departing(&it);
    it.at = "a=50,b=-50,c=50,d=-50";
    assert_departing(&it);
}

/* Slider A, crank B, rod C. */
static void a_slider_crank_moves_with_a_rounded_axis(void **state)
{
    const departing it = {
        .of = {.count = 4,
               .end = {{5, 0, 0}, {0, 1, 0}, {3, -1, 0}, {0.5, 0.2, 0}}},
        .joints =
            {"- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, "
             "1]}\n"
             "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, ",
             ", 1]}\n"
             "- {name: c, between: [C/g2, D/g1], type: hinge, axis: [0, 0, "
             "1]}\n"
             "- {name: s, between: [A/g1, D/g1], type: slider, axis: [1, 0, "
             "0]}\n"},
        .at = "s=3",
        .tilted = "s=3",
        .rank = 17,
        .motions = 1,
        .joint = 1,
        .exact = {0, 0, 1}};

    (void)state;
    assert_departing(&it);
}

/* Two guides side by side. */
static void a_carriage_moves_on_guides_with_rounded_axes(void **state)
{
    const departing it = {
        .of = {.count = 2, .end = {{1, 2, 2}, {1, 2, 2}}},
        .joints =
            {"- {name: s, between: [A/g1, B/g1], type: slider, axis: [1, 0, "
             "0]}\n"
             "- {name: t, between: [A/g2, B/g2], type: slider, axis: [1, ",
             ", "
             "0]}\n"},
        .at = "",
        .tilted = "",
        .rank = 5,
        .motions = 1,
        .joint = 1,
        .exact = {1, 0, 0}};

    (void)state;
    assert_departing(&it);
}

/* A cross and the hinges about its axes. */
static void a_cross_moves_with_a_rounded_axis(void **state)
{
    departing it = {
        .of = {.count = 3, .end = {{3, 0, 0}, {0.1, 1, 0}, {0.2, 0.3, 0.4}}},
        .joints = {"- {name: p, between: [A/g1, B/g1], type: hinge, axis: [0, "
                   "0, 1]}\n"
                   "- {name: q, between: [B/g1, C/g1], type: hinge, axis: [0, "
                   "1, 0]}\n"
                   "- {name: u, between: [A/g1, C/g1], type: universal, axes: "
                   "[[0, 0, 1], [",
                   ", 1, 0]]}\n"},
        .at = "p=20,q=-40,u=20,u.2=-40",
        .tilted = "",
        .rank = 10,
        .motions = 2,
        .joint = 2,
        .exact = {0, 1, 0}};

    (void)state;
    assert_departing(&it);
    it.at = "";
    assert_departing(&it);
}

/* A door on hinges whose axes are rounded alike: neither lies in the line
   through both. */
static void a_door_turns_on_hinges_with_rounded_axes(void **state)
{
    static const struct {
        const char *axis;
        bool listed, taken;
        int64_t motions;
    } door[] = {
        {"[1, 2, 2]", false, true, 1},
        {"[0.333333333333, 0.666666666667, 0.666666666667]", false, true, 1},
        {"[0.33333, 0.66667, 0.66667]", true, true, 1},
        {"[0.3333, 0.6667, 0.6667]", true, true, 1},
        {"[0.33, 0.67, 0.67]", true, false, 0}};
    RITZ_OWN(ritz_near_axes) near = {0};

    (void)state;
    for (size_t k = 0; k < sizeof door / sizeof *door; k++) {
        char text[400];
        const linkage l = {
            .count = 2, .end = {{1, 2, 2}, {1, 2, 2}}, .joints = text};

        snprintf(text, sizeof text,
                 "- {name: s, between: [A/g1, B/g1], type: hinge, axis: %s}\n"
                 "- {name: t, between: [A/g2, B/g2], type: hinge, axis: %s}\n",
                 door[k].axis, door[k].axis);
        assert_motions(&l, "", 6 - door[k].motions, door[k].motions, &near);
        assert_int_equal(near.count, door[k].listed);
        if (!door[k].listed)
            continue;
        assert_true(near.item[0].taken == door[k].taken);
        assert_int_equal(near.item[0].others, 1);
        for (int i = 0; i < 3; i++)
            assert_near(near.item[0].exact[i], i == 0 ? 1.0 / 3.0 : 2.0 / 3.0,
                        1e3 * DBL_EPSILON);
    }
}

/* x := x Rz(angle) Tx(length) Rx(twist), x of axes as columns and a point. */
static void step_link(double angle, double length, double twist, double x[4][3])
{
    const double ca = cos(angle), sa = sin(angle);
    const double ct = cos(twist), st = sin(twist);

    for (int i = 0; i < 3; i++) {
        const double u = ca * x[0][i] + sa * x[1][i];
        const double v = ca * x[1][i] - sa * x[0][i], w = x[2][i];

        x[0][i] = u;
        x[1][i] = ct * v + st * w;
        x[2][i] = ct * w - st * v;
        x[3][i] += length * u;
    }
}

/*
 * The linkage of Bennett, whose four axes meet nowhere: links of lengths a and
 * b and twists p and q with sin(p) / a = sin(q) / b, at angles s and t with
 * tan(s / 2) tan(t / 2) = sin((q + p) / 2) / sin((q - p) / 2).
 */
static void make_bennett(int digits, char *text, size_t size, linkage *l)
{
    const double p = 40.0 * pi / 180.0, q = 65.0 * pi / 180.0;
    const double s = 50.0 * pi / 180.0;
    const double t =
        2.0 * atan(sin(0.5 * (q + p)) / sin(0.5 * (q - p)) / tan(0.5 * s));
    const double angle[] = {s, t, -s, -t};
    double x[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    size_t used = 0;

    l->count = 4;
    l->joints = text;
    for (int k = 0; k < 4; k++) {
        double from[3] = {x[3][0], x[3][1], x[3][2]};

        used += (size_t)snprintf(
            text + used, size - used,
            "- {name: %c, between: [%c/g2, %c/g1], type: hinge, "
            "axis: [%.*f, %.*f, %.*f]}\n",
            'a' + k, 'A' + (k + 3) % 4, 'A' + k, digits, x[2][0], digits,
            x[2][1], digits, x[2][2]);
        step_link(angle[k], k % 2 == 0 ? 1.0 : sin(q) / sin(p),
                  k % 2 == 0 ? p : q, x);
        for (int i = 0; i < 3; i++)
            l->end[k][i] = x[3][i] - from[i];
    }
}

static void a_bennett_linkage_moves_with_rounded_axes(void **state)
{
    (void)state;
    for (int digits = 2; digits < 16; digits++) {
        linkage l = {0};
        char text[800];
        const bool taken = digits > 2;
        RITZ_OWN(ritz_near_axes) near = {0};

        make_bennett(digits, text, sizeof text, &l);
        assert_motions(&l, "", 17 + !taken, taken, &near);
        assert_int_equal(near.count, digits < 9);
        if (near.count > 0)
            assert_true(near.item[0].taken == taken);
    }
}

/* Singular values of a plane loop are small near a dead centre: axes have
   nothing to do with it. */
static void a_dead_centre_is_not_an_axis(void **state)
{
    static const char joints[] =
        "- {name: a, between: [A/g1, B/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: b, between: [B/g2, C/g1], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: c, between: [C/g2, D/g2], type: hinge, axis: [0, 0, 1]}\n"
        "- {name: d, between: [D/g1, A/g2], type: hinge, axis: [0, 0, 1]}\n";
    const linkage l = {.count = 4,
                       .end = {{3, 0, 0}, {0, 1, 0}, {3, 0, 0}, {0, 1, 0}},
                       .joints = joints};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_near_axes) near = {0};

    (void)state;
    assert_ok(stage_of_linkage(&l, &ritz_method_rigid, &scene, &stage));
    for (int k = 0; k < 8; k++) {
        const double a = 90.0 - pow(10.0, -k);
        const double setting[] = {a, -a, a, -a};

        assert_ok(ritz_stage_near_axes(&stage, setting, &near));
        assert_int_equal(near.count, 0);
    }
}

static void rounded_axes_survive_every_allocation(void **state)
{
    const linkage l = {
        .count = 2,
        .end = {{1, 2, 2}, {1, 2, 2}},
        .joints = "- {name: s, between: [A/g1, B/g1], type: hinge, axis: "
                  "[0.3333, 0.6667, 0.6667]}\n"
                  "- {name: t, between: [A/g2, B/g2], type: hinge, axis: "
                  "[0.3333, 0.6667, 0.6667]}\n"};
    const double setting[2] = {0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_near_axes) near = {0};

    (void)state;
    assert_ok(stage_of_linkage(&l, &ritz_method_rigid, &scene, &stage));
    assert_survives_every_allocation(
        ritz_stage_near_axes(&stage, setting, &near));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_four_bar_linkage_moves_with_a_rounded_axis),
    cmocka_unit_test(a_slider_crank_moves_with_a_rounded_axis),
    cmocka_unit_test(a_carriage_moves_on_guides_with_rounded_axes),
    cmocka_unit_test(a_cross_moves_with_a_rounded_axis),
    cmocka_unit_test(a_door_turns_on_hinges_with_rounded_axes),
    cmocka_unit_test(a_bennett_linkage_moves_with_rounded_axes),
    cmocka_unit_test(a_dead_centre_is_not_an_axis),
    cmocka_unit_test(rounded_axes_survive_every_allocation),
};

TEST_MODULE(joint_axes, tests, NULL, NULL)
