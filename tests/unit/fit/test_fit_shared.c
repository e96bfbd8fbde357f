/* Bodies of scenes whose candidates share one basis. */
#include "testing.h"

#include "answers.h"
#include "fit/fitter.h"
#include "fit_scenes.h"
#include "folder.h"

#include <ritz/matrix.h>

#include <stdio.h>
#include <string.h>

enum { METHODS = 3, LARGEST = 5 };

static const ritz_method *const methods[METHODS] = {
    &ritz_method_craig_bampton, &ritz_method_rubin,
    &ritz_method_krylov_cms_fixed};

#define TWO_BRANCHES(more)                                                     \
    "scene: a trunk and two equal branches\n"                                  \
    "components:\n"                                                            \
    "  trunk: {model: left.h5, basis: craig-bampton, modes: 4}\n"              \
    "  one: {model: right.h5, basis: craig-bampton, modes: 4}\n"               \
    "  other: {model: right.h5, basis: craig-bampton, modes: 4" more "}\n"     \
    "joints:\n"                                                                \
    "  - {name: i, between: [trunk/joint, one/joint], type: fixed}\n"          \
    "  - {name: j, between: [trunk/joint, other/joint], type: fixed}\n"        \
    "inputs: [{name: f, at: trunk/joint, component: 2}]\n"                     \
    "outputs: [{name: y, at: one/tip, component: 2}]\n"                        \
    "band_hz: [0, 0.3]\n"                                                      \
    "damping: {modal: 0.01}\n"

static const char branches[] = TWO_BRANCHES("");

static void open_branches(const char *text, bool damped, answer *out)
{
    const ritz_fit_request request =
        fit_scenes_by(methods, METHODS, "response=1e-2");

    fit_scenes_store_beams(16, 16);
    if (damped)
        fit_scenes_damp_left();
    answer_open(text, &request, out);
}

/* Columns of the same kinds, equal eigenvalues, and T of all columns. */
static void assert_same_body(const ritz_reduced *taken,
                             const ritz_reduced *made)
{
    RITZ_OWN(ritz_pairs) a = {0}, b = {0};
    const int64_t r = made->K.ncol;

    assert_int_equal(taken->K.ncol, r);
    assert_int_equal(taken->T.ncol, r);
    assert_memory_equal(taken->columns.kind, made->columns.kind,
                        (size_t)r * sizeof *made->columns.kind);
    assert_ok(ritz_eigen_dense(&taken->K, &taken->M, &a));
    assert_ok(ritz_eigen_dense(&made->K, &made->M, &b));
    for (int64_t k = 0; k < b.Phi.ncol; k++) /* and rounding, 1e-12 */
        assert_near(a.lambda[k], b.lambda[k],
                    1e-9 * b.lambda[k] + 1e-12 * b.lambda[r - 1]);
}

static void compare_bodies(ritz_fitter *fitter, const ritz_method *method)
{
    for (int64_t modes = LARGEST; modes >= 1; modes--)
        for (int64_t k = 0; k < fitter->num_bodies; k++) {
            RITZ_OWN(ritz_reduced) taken = {0}, made = {0};
            RITZ_OWN(ritz_dense) parts = {0};

            assert_ok(
                ritz_fit_take(fitter, method, k, modes, true, &taken, &parts));
            assert_ok(ritz_fit_body(fitter, method, k, modes, &made));
            assert_same_body(&taken, &made);
            assert_null(parts.val); /* systems are not compared by shapes */
        }
}

/* Candidates with fewer modes have the bodies that are made for each number of
   modes, and equal bodies one basis by each method. */
static void bodies_of_a_scene_share_their_bases(void **state)
{
    static const int64_t equal[] = {0, 1, 1};
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, false, &a);
    assert_memory_equal(a.fitter->equal, equal, sizeof equal);
    for (int m = 0; m < METHODS; m++) {
        compare_bodies(a.fitter, methods[m]);
        assert_int_equal(a.fitter->num_families, 2 * (m + 1));
    }
    for (int64_t k = 0; k < a.fitter->num_families; k++)
        assert_false(a.fitter->family[k].exact);
}

/* Static vectors of a damper change with the number of modes. */
static void dampers_of_a_body_are_heeded(void **state)
{
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, true, &a);
    for (int m = 0; m < METHODS; m++)
        compare_bodies(a.fitter, methods[m]);
}

static void bodies_with_other_ports_or_options_are_not_equal(void **state)
{
    static const char *const unlike[] = {TWO_BRANCHES(", attach: [joint, tip]"),
                                         TWO_BRANCHES(", interface_modes: 2")};

    (void)state;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(answer) a = {0};

        open_branches(unlike[k], false, &a);
        assert_int_equal(a.fitter->equal[1], 1);
        assert_int_equal(a.fitter->equal[2], 2);
    }
}

/* Errors of a candidate are those of bodies made for it alone. */
static void errors_are_those_of_bodies_made_for_one_candidate(void **state)
{
    const int64_t modes[] = {4, 3, 2};
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, false, &a);
    for (int m = 0; m < METHODS; m++) {
        RITZ_OWN(ritz_fit_candidate) shared = {0}, alone = {.worst = -1};
        RITZ_OWN(ritz_fit_joined) joined = {0};

        assert_ok(ritz_fitter_try(a.fitter, methods[m], modes, &shared));
        assert_ok(ritz_bodies_new(3, &joined.own));
        for (int64_t k = 0; k < 3; k++)
            assert_ok(ritz_fit_body(a.fitter, methods[m], k, modes[k],
                                    &joined.own.item[k]));
        assert_ok(ritz_fit_join_own(a.fitter, &joined));
        assert_ok(ritz_fit_measure(a.fitter, &joined, &alone));
        assert_int_equal(shared.order, alone.order);
        assert_int_equal(shared.feasible, alone.feasible);
        assert_near(shared.ratio, alone.ratio, 1e-6 * alone.ratio);
    }
}

/* A count proves the modes of the answer's bodies; those of an interrupted
   search are taken as they are, which their options say. */
static void the_answer_s_bodies_are_made_once_more(void **state)
{
    const int64_t modes[] = {4, 3, 2};

    (void)state;
    for (int stopped = 0; stopped < 2; stopped++) {
        RITZ_OWN(answer) a = {0};

        open_branches(branches, false, &a);
        assert_ok(ritz_fitter_try(a.fitter, methods[0], modes, &a.whole));
        a.fitter->stopped = stopped;
        answer_system(&a, &a.whole);
        for (int k = 0; k < 3; k++)
            assert_int_equal(
                strstr(a.body.item[k].origin.options, "count no") != NULL,
                stopped);
        assert_int_equal(a.system.configuration[0].K.ncol, a.whole.order);
        assert_true(a.system.configuration[0].momentum.ncol > 0);
    }
}

/* A body whose equal could not be made is tried itself: a refusal names the body
   it is of. */
static void a_refusal_is_of_one_body_alone(void **state)
{
    static const int64_t modes[][3] = {{1, 3, 1}, {1, 1, 3}};
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, false, &a);
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_fit_candidate) c = {0};

        assert_ok(ritz_fitter_try(a.fitter, methods[0], modes[k / 2], &c));
        assert_string_equal(c.refusal, k == 1 ? "one: broken" : "");
        for (int64_t t = 0; t < a.fitter->num_made && k == 0; t++) {
            ritz_fit_made *made = &a.fitter->made[t];

            if (made->body != 1 || made->modes != 3)
                continue;
            made->status = RITZ_ERR_SINGULAR;
            (void)snprintf(made->refusal, sizeof made->refusal, "one: broken");
        }
    }
}

/* Bases of two bodies by one method stay, whatever room there is: each
   candidate needs both. Another method's are dropped for them. */
static void bases_of_one_method_are_kept_together(void **state)
{
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, false, &a);
    a.fitter->most_entries = 1;
    for (int m = 0; m < 2; m++)
        compare_bodies(a.fitter, methods[m]);
    assert_int_equal(a.fitter->num_families, 4);
    for (int64_t k = 0; k < 4; k++)
        assert_int_equal(a.fitter->family[k].whole.T.val != NULL, k >= 2);
}

static ritz_status take_anew(ritz_fitter *fitter)
{
    RITZ_OWN(ritz_reduced) taken = {0};
    RITZ_OWN(ritz_dense) parts = {0};

    for (int64_t k = 0; k < fitter->num_families; k++)
        ritz_fit_family_free(&fitter->family[k]);
    fitter->num_families = 0;
    return ritz_fit_take(fitter, methods[1], 1, 2, true, &taken, &parts);
}

static void sharing_survives_every_allocation(void **state)
{
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_branches(branches, false, &a);
    assert_survives_every_allocation(take_anew(a.fitter));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bodies_of_a_scene_share_their_bases),
    cmocka_unit_test(dampers_of_a_body_are_heeded),
    cmocka_unit_test(bodies_with_other_ports_or_options_are_not_equal),
    cmocka_unit_test(errors_are_those_of_bodies_made_for_one_candidate),
    cmocka_unit_test(the_answer_s_bodies_are_made_once_more),
    cmocka_unit_test(a_refusal_is_of_one_body_alone),
    cmocka_unit_test(bases_of_one_method_are_kept_together),
    cmocka_unit_test(sharing_survives_every_allocation),
};

TEST_MODULE(fit_shared, tests, folder_make, folder_remove)
