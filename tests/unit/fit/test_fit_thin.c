/*
 * The smallest scene that meets a tolerance, against exhaustive search: modes
 * of bodies taken one by one, and exchanged, against all numbers of them.
 */
#include "testing.h"

#include "answers.h"
#include "dualspin.h"
#include "fit_scenes.h"
#include "folder.h"
#include "frame.h"
#include "scenes.h"

#include <stdlib.h>

static const ritz_method *const three[] = {&ritz_method_craig_bampton,
                                           &ritz_method_macneal_rubin,
                                           &ritz_method_krylov_cms_free};

enum { MOST = 20, BODIES = 3 };

static const char mixed_beams[] =
    "scene: an arm\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: right/tip, component: 1}]\n"
    "outputs: [{name: y, at: right/tip, component: 1},"
    " {name: z, at: left/joint, component: 2}]\n"
    "band_hz: [0, 0.5]\n"
    "damping: {modal: 0.01}\n";

/* A clamped beam and two more in a row, as stiff as it times `stiffness`. */
static void store_arm(const int64_t elements[BODIES],
                      const double stiffness[BODIES])
{
    static const char *const file[BODIES] = {"one.h5", "two.h5", "three.h5"};
    frame_section section = frame_mcdaniel;

    for (int k = 0; k < BODIES; k++) {
        ritz_component beam = {0};

        section.inertia = stiffness[k] * frame_mcdaniel.inertia;
        assert_ok(frame_component(elements[k], 0.5, &section, k == 0, false,
                                  100 * k, &beam));
        if (k > 0)
            assert_ok(add_port(&beam, "root", 100 * k));
        assert_ok(add_port(&beam, "tip", 100 * k + elements[k]));
        folder_store(file[k], &beam);
        ritz_component_free(&beam);
        section.offset += 0.5 * (double)elements[k];
    }
}

static const char arm[] =
    "scene: three beams\n"
    "components:\n"
    "  one: {model: one.h5, basis: craig-bampton, modes: 4}\n"
    "  two: {model: two.h5, basis: craig-bampton, modes: 4}\n"
    "  three: {model: three.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [one/tip, two/root], type: fixed}\n"
    "  - {name: k, between: [two/tip, three/root], type: fixed}\n"
    "inputs: [{name: f, at: three/tip, component: 2}]\n"
    "outputs: [{name: y, at: three/tip, component: 2},"
    " {name: z, at: one/tip, component: 6}]\n"
    "band_hz: [0, 0.2]\n"
    "damping: {modal: 0.01}\n";

/* Orders of one method by numbers of modes, of the last body fastest. */
typedef struct orders {
    int64_t bodies, count;
    int64_t *of; /* (MOST + 1)^bodies; 0: refused */
} orders;

/* Modes of each body at an index, and the index of one mode less. */
static int64_t modes_at(const orders *o, int64_t at, int64_t body,
                        int64_t *stride)
{
    *stride = 1;
    for (int64_t k = o->bodies - 1; k > body; k--)
        *stride *= MOST + 1;
    return at / *stride % (MOST + 1);
}

/*
 * More modes are no fewer columns: nothing is to be found above what is as
 * large as the least already. Nor where a body had none to add to one fewer.
 */
static bool is_known(const orders *o, int64_t at, int64_t least)
{
    for (int64_t k = 0; k < o->bodies; k++) {
        int64_t stride = 0;
        int64_t modes = modes_at(o, at, k, &stride);

        if (modes < 1)
            continue;
        if (o->of[at - stride] >= least ||
            (modes > 1 && o->of[at - stride] > 0 &&
             o->of[at - stride] == o->of[at - 2 * stride])) {
            o->of[at] = o->of[at - stride];
            return true;
        }
    }
    return false;
}

/* The least order at which a method has a candidate, if below @p least. */
static int64_t exhaust(ritz_fitter *fitter, const ritz_method *method,
                       int64_t least)
{
    orders o = {.bodies = ritz_fitter_bodies(fitter), .count = 1};

    for (int64_t k = 0; k < o.bodies; k++)
        o.count *= MOST + 1;
    o.of = calloc((size_t)o.count, sizeof *o.of);
    assert_non_null(o.of);
    for (int64_t at = 0; at < o.count; at++) {
        int64_t modes[BODIES] = {0};
        int64_t stride = 0;
        RITZ_OWN(ritz_fit_candidate) c = {0};

        if (is_known(&o, at, least))
            continue;
        for (int64_t k = 0; k < o.bodies; k++)
            modes[k] = modes_at(&o, at, k, &stride);
        assert_ok(ritz_fitter_try(fitter, method, modes, &c));
        o.of[at] = c.order;
        if (c.feasible && c.order < least)
            least = c.order;
    }
    free(o.of);
    return least;
}

/* What was found is among what exhaustive search tries, and one above at most;
   the answer, some of whose columns may be left out, is no larger. */
static void assert_within_one(const char *text, int64_t num_methods,
                              const char *tolerance)
{
    const ritz_fit_request request =
        fit_scenes_by(three, num_methods, tolerance);
    RITZ_OWN(answer) a = {0};
    int64_t least = 0;
    int64_t order = 0;

    answer_search(text, &request, &a);
    order = answer_smallest_whole(&a);
    assert_true(answer_chosen(&a)->order <= order);
    least = order + 1;
    for (int64_t m = 0; m < a.fit.num_methods; m++)
        least = exhaust(a.fitter, a.fit.method[m], least);
    if (order > least + 1 || order < least)
        fail_msg("%s\nfound %d, exhaustive search %d", a.fit.why, (int)order,
                 (int)least);
}

/* Lengths, ends and tolerances: each a scene of its own. */
static void two_beams_are_fitted_within_one(void **state)
{
    static const struct {
        int64_t left, right;
        const char *text, *tolerance;
    } cases[] = {
        {4, 6, fit_scenes_beams, "response=1e-2"},
        {7, 3, fit_scenes_beams, "frequency=1e-3"},
        {3, 8, fit_scenes_beams, "response=1e-3,gain=1e-2"},
        {9, 2, fit_scenes_beams, "gain=1e-3,missing=1"},
        {5, 5, fit_scenes_driven, "response=1e-2,frequency=1e-2"},
        {5, 5, fit_scenes_driven, "mac=0.99"},
        {4, 7, fit_scenes_driven, "mac=0.99,frequency=1e-3"},
        {4, 7, fit_scenes_driven, "frequency=1e-4,response=1e-3"},
        {6, 3, mixed_beams, "frequency=1e-2,response=1e-1"},
        {3, 9, mixed_beams, "missing=2,mac=0.9"},
        {8, 8, mixed_beams, "response=1e-3,gain=1e-3"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        fit_scenes_store_beams(cases[k].left, cases[k].right);
        assert_within_one(cases[k].text, 3, cases[k].tolerance);
    }
}

/* As stiff as each other, and a thousand times apart. */
static void three_beams_are_fitted_within_one(void **state)
{
    static const struct {
        int64_t elements[BODIES];
        double stiffness[BODIES];
        const char *tolerance;
    } cases[] = {
        {{4, 4, 4}, {1.0, 0.5, 0.1}, "response=1e-3"},
        {{6, 2, 5}, {1.0, 1.0, 0.02}, "mac=0.99,gain=1e-2"},
        {{2, 8, 2}, {1.0, 0.05, 10.0}, "missing=1,gain=1e-3"},
        {{3, 6, 3}, {1.0, 100.0, 0.01}, "response=1e-3"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        store_arm(cases[k].elements, cases[k].stiffness);
        assert_within_one(arm, 2, cases[k].tolerance);
    }
}

/* At two angles, where the rotor needs ten modes and the stator four. */
static void the_spacecraft_is_fitted_within_one(void **state)
{
    (void)state;
    dualspin_or_skip();
    fit_scenes_store_spacecraft();
    assert_within_one(fit_scenes_spacecraft, 2, "flexible=1e-2");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(two_beams_are_fitted_within_one),
    cmocka_unit_test(three_beams_are_fitted_within_one),
    cmocka_unit_test(the_spacecraft_is_fitted_within_one),
};

TEST_MODULE(fit_thin, tests, folder_make, folder_remove)
