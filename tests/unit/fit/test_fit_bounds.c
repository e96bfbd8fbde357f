/* What bounds decide in a search, and what they say of its answer. */
#include "testing.h"

#include "answers.h"
#include "bar.h"
#include "bodies.h"
#include "fit/fitter.h"
#include "fit_scenes.h"
#include "folder.h"
#include "project.h"
#include "scenes.h"

#include <ritz/verify.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                         &ritz_method_macneal_rubin};

/* Two chains of bodies in space that turn against each other about z. */
static const char arm[] =
    "scene: an arm\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 3}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 3}\n"
    "joints:\n"
    "  - {name: j, between: [left/g1, right/g1], type: hinge,"
    " axis: [0, 0, 1], angles_deg: [0, 30, 90]}\n"
    "inputs: [{name: f, at: left/g1, component: 6, against: right/g1}]\n"
    "outputs: [{name: y, at: right/g2, component: 2}]\n"
    "band_hz: [0, 6]\n"
    "damping: {modal: 0.01}\n";

static void store_arm(int64_t left, int64_t right)
{
    enum { MOST = 12 };
    const int64_t count[] = {left, right};
    static const char *const file[] = {"left.h5", "right.h5"};
    double position[MOST][3];

    for (int k = 0; k < MOST; k++) {
        position[k][0] = 0.7 * k;
        position[k][1] = 0.1 * k * k;
        position[k][2] = k % 2 == 0 ? 0.0 : 0.3;
    }
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) chain = {0};

        assert_ok(body_chain(count[k], (const double(*)[3])position,
                             k == 0 ? 1 : 101, k == 0 ? 11 : 12, &chain));
        folder_store(file[k], &chain);
    }
}

/* The arm at one setting: its system, and its full system. */
typedef struct placed {
    ritz_scene scene;
    ritz_stage stage;
    ritz_configuration at;
    ritz_component full;
    ritz_master *master;
} placed;

static void place_arm(int64_t left, int64_t right, double angle, placed *out)
{
    store_arm(left, right);
    folder_parse(arm, &out->scene);
    assert_ok(ritz_stage_new(&out->scene, &out->stage));
    assert_ok(ritz_stage_assemble(&out->stage, &angle, &out->at));
    assert_ok(
        ritz_assemble_full(&out->scene, &angle, &out->full, &out->master));
}

static void placed_free(placed *p)
{
    free(p->master);
    ritz_component_free(&p->full);
    ritz_configuration_free(&p->at);
    ritz_stage_free(&p->stage);
    ritz_scene_free(&p->scene);
}

/* Largest |A - B| over largest |B|. */
static double off(const ritz_dense *A, const ritz_dense *B)
{
    double gap = 0.0, size = 0.0;

    assert_int_equal(A->nrow * A->ncol, B->nrow * B->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++) {
        gap = fmax(gap, fabs(A->val[k] - B->val[k]));
        size = fmax(size, fabs(B->val[k]));
    }
    return gap / size;
}

/* K_e = T'KT and so on, to some hundred roundings; measured: 7e-15. */
static void the_system_s_basis_condenses_the_full_system(void **state)
{
    const double rounding = 1e-13;
    RITZ_OWN(placed) p = {0};
    RITZ_OWN(ritz_dense) T = {0}, K = {0}, M = {0}, B = {0}, C = {0};

    (void)state;
    place_arm(4, 6, 30.0, &p);
    assert_ok(ritz_stage_basis(&p.stage, &p.at, p.full.num_dofs, p.master, &T));
    assert_int_equal(T.nrow, p.full.num_dofs);
    assert_int_equal(T.ncol, p.at.K.ncol);
    assert_ok(ritz_sparse_condense(&p.full.K, &T, &K));
    assert_ok(ritz_sparse_condense(&p.full.M, &T, &M));
    assert_ok(ritz_dense_mul_tn(&T, &p.full.io.B, &B));
    assert_ok(ritz_dense_mul(&p.full.io.C, &T, &C));
    assert_true(off(&M, &p.at.M) < rounding);
    assert_true(off(&B, &p.at.io.B) < rounding);
    assert_true(off(&C, &p.at.io.C) < rounding);
}

static void a_body_without_its_basis_is_refused(void **state)
{
    const ritz_master master[] = {{0, 0}, {0, 1}, {1, 0}};
    RITZ_OWN(placed) p = {0};
    ritz_dense T = {0};

    (void)state;
    place_arm(2, 2, 0.0, &p);
    ritz_dense_free(&p.stage.body[1].T);
    assert_fails(ritz_stage_basis(&p.stage, &p.at, 3, master, &T),
                 RITZ_ERR_ARGUMENT, "'right' has no basis T for its 1 dofs");
    assert_null(T.val);
}

static ritz_status make_basis(const placed *p)
{
    RITZ_OWN(ritz_dense) T = {0};

    return ritz_stage_basis(&p->stage, &p->at, p->full.num_dofs, p->master, &T);
}

static void every_allocation_of_the_basis_may_fail(void **state)
{
    RITZ_OWN(placed) p = {0};

    (void)state;
    place_arm(2, 2, 90.0, &p);
    assert_survives_every_allocation(make_basis(&p));
}

static ritz_fit_request asked(const char *tolerance, bool estimates)
{
    ritz_fit_request request = fit_scenes_by(two, 2, tolerance);

    request.num_random = 30;
    request.num_between = 1;
    request.estimates = estimates;
    return request;
}

static double value_of(const ritz_measures *found, const char *name)
{
    return find_measure(found, name)->value;
}

/* What was ruled out unmeasured is measured, and fails where it was said to. */
static void assert_rightly_screened(ritz_fitter *measuring, const ritz_fit *fit)
{
    int64_t screened = 0;

    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        RITZ_OWN(ritz_fit_candidate) again = {0};

        if (!c->ruled_out)
            continue;
        screened++;
        assert_int_equal(c->errors.count, 0);
        assert_ok(ritz_fitter_try(measuring, c->method, c->modes, &again));
        assert_false(again.feasible);
        assert_false(again.ruled_out);
        if (!(value_of(&again.errors, "missing-modes") > 0.0))
            assert_true(value_of(&again.errors, "frequency-relative") >=
                        value_of(&c->estimates, "frequency-relative-least"));
    }
    assert_true(screened > 0);
    assert_true(screened < fit->count);
}

static void bounds_rule_out_what_fails_and_change_no_answer(void **state)
{
    static const char *const tolerance[] = {"frequency=1e-3", "frequency=1e-5",
                                            "frequency=1e-2,response=1e-2",
                                            "frequency=1e-3,mac=0.99"};

    (void)state;
    for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++) {
        const ritz_fit_request request = asked(tolerance[t], true);
        const ritz_fit_request measured = asked(tolerance[t], false);
        RITZ_OWN(answer) a = {0}, all = {0};

        store_arm(t % 2 == 0 ? 4 : 5, 4);
        answer_search(arm, &request, &a);
        answer_search(arm, &measured, &all);
        assert_int_equal(answer_chosen(&a)->order, answer_chosen(&all)->order);
        assert_int_equal(a.fit.count, all.fit.count);
        assert_rightly_screened(all.fitter, &a.fit);
    }
}

/* The answer's bounds are of all configurations that its errors are of, random
 * ones too. */
static void the_answer_of_a_scene_is_bounded(void **state)
{
    const ritz_fit_request request =
        asked("frequency=1e-3,response=1e-2", true);
    RITZ_OWN(answer) a = {0};
    const ritz_measures *said = NULL;
    double frequency = 0.0, response = 0.0;

    (void)state;
    store_arm(4, 3);
    answer_search(arm, &request, &a);
    said = &answer_chosen(&a)->estimates;
    frequency = value_of(&answer_chosen(&a)->errors, "frequency-relative");
    response = value_of(&answer_chosen(&a)->errors, "response-relative");
    assert_true(frequency > 0.0);
    assert_true(value_of(said, "frequency-relative-bound") >= frequency);
    assert_true(value_of(said, "frequency-relative-bound") < 10.0 * frequency);
    assert_true(value_of(said, "frequency-relative-least") <= frequency);
    assert_true(value_of(said, "frequency-relative-least") > 0.1 * frequency);
    assert_true(value_of(said, "response-relative-bound") >= response);
    assert_true(value_of(said, "missing-modes-bound") == 0.0);
}

/* The bar's errors are known: what is told at least is below, and near. */
static void what_is_told_at_least_is_below_the_error(void **state)
{
    enum { ELEMENTS = 40, MODES = 12 };
    int64_t attached[] = {0, 40};
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    assert_ok(bar_component(ELEMENTS, &bar));
    for (int64_t modes = 0; modes < MODES; modes++) {
        ritz_request request = {
            .component = &bar, .attached = {2, attached}, .modes = modes};
        const ritz_estimate_request band = {
            .band_hz = {0.0, ritz_eigen_hertz(bar_eigenvalue(ELEMENTS, 8))}};
        RITZ_OWN(ritz_estimator) *estimator = NULL;
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};
        RITZ_OWN(ritz_measures) all = {0}, found = {0};
        double inside = 0.0, worst = 0.0;

        assert_ok(
            ritz_basis_make(&ritz_method_craig_bampton, &request, &basis));
        assert_ok(ritz_reduce(&bar, &basis, &reduced));
        assert_ok(ritz_estimator_new(&bar, &band, &estimator));
        assert_ok(
            ritz_estimator_measure(estimator, &basis, &reduced, true, &found));
        assert_ok(
            ritz_estimator_measure(estimator, &basis, &reduced, false, &all));
        assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &pairs));
        for (int64_t k = 1; k < pairs.Phi.ncol; k++) {
            double known = bar_eigenvalue(ELEMENTS, k);

            double off = sqrt(pairs.lambda[k] / known) - 1.0;

            if (ritz_eigen_hertz(pairs.lambda[k]) <= band.band_hz[1])
                inside = fmax(inside, off);
            if (k <= 8) /* the band's, wherever the reduced one lies */
                worst = fmax(worst, off);
        }
        if (inside > 1e-8) {
            assert_true(value_of(&found, "frequency-relative-least") <= worst);
            assert_true(value_of(&found, "frequency-relative-least") >
                        0.3 * inside); /* measured: 0.6 and more */
            assert_true(value_of(&all, "frequency-relative-least") >=
                        value_of(&found, "frequency-relative-least"));
            assert_true(value_of(&all, "frequency-relative-least") <= worst);
        }
    }
}

/*
 * Full eigenvalues 1, 1.44, 25, 100, frequencies 1 and 1.2; the basis has the
 * second mode and of the first one, with some of the fourth in it,
 *
 *     theta = (1 + 100 t) / (1 + t) = 1.4161: a frequency of 1.19,
 *
 * much nearer to the second's. None being missing, the error is 19 %.
 */
static void bounds_are_of_the_same_mode_where_none_is_missing(void **state)
{
    enum { N = 4 };
    const double two_pi = 6.28318530717958647693;
    const double t = 0.4161 / (100.0 - 1.4161);
    const double lambda[N] = {1.0, 1.44, 25.0, 100.0}, unit[N] = {1, 1, 1, 1};
    const int64_t at[N] = {0, 1, 2, 3};
    const ritz_estimate_request band = {.band_hz = {0.0, 1.25 / two_pi}};
    ritz_component full = {.num_dofs = N};
    ritz_basis basis = {0};
    ritz_reduced reduced = {0};
    ritz_estimator *estimator = NULL;
    ritz_measures all = {0};

    (void)state;
    assert_ok(ritz_sparse_from_triplets(N, N, N, at, at, lambda, &full.K));
    assert_ok(ritz_sparse_from_triplets(N, N, N, at, at, unit, &full.M));
    assert_ok(ritz_dense_new(N, 2, &basis.T));
    ritz_dense_col(&basis.T, 0)[0] = 1.0;
    ritz_dense_col(&basis.T, 0)[3] = sqrt(t);
    ritz_dense_col(&basis.T, 1)[1] = 1.0;
    assert_ok(ritz_sparse_condense(&full.K, &basis.T, &reduced.K));
    assert_ok(ritz_sparse_condense(&full.M, &basis.T, &reduced.M));
    assert_ok(ritz_estimator_new(&full, &band, &estimator));
    assert_ok(ritz_estimator_measure(estimator, &basis, &reduced, false, &all));
    assert_true(value_of(&all, "missing-modes-bound") == 0.0);
    assert_true(value_of(&all, "frequency-relative-bound") >= 0.19);
    assert_true(value_of(&all, "frequency-relative-bound") < 10.0 * 0.19);
    assert_true(value_of(&all, "frequency-relative-least") <= 0.1901);
    assert_true(value_of(&all, "frequency-relative-least") > 0.1);
    ritz_measures_free(&all);
    ritz_estimator_free(&estimator);
    ritz_dense_free(&reduced.K);
    ritz_dense_free(&reduced.M);
    ritz_dense_free(&basis.T);
    ritz_sparse_free(&full.K);
    ritz_sparse_free(&full.M);
}

/* Of several configurations the largest bound is reported, with its
   configuration and cause. */
static void the_worst_configuration_keeps_its_cause(void **)
{
    static const struct {
        const char *at, *where, *cause;
        double value;
    } place[] = {
        {"clock=0,cone=0,slide=0.125", "1234.5 Hz, force to tip", "", 0.5},
        {"clock=60,cone=0,slide=0.125", "15 Hz, force_of_the_arm to tip",
         "damping of inexact modes", 2.0},
        {"clock=90,cone=0,slide=0.125", "15 Hz, force to tip", "rounding", 1.0},
    };
    RITZ_OWN(ritz_measures) worst = {0};

    for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
        RITZ_OWN(ritz_measures) one = {0};

        assert_ok(ritz_measures_add(&one, "response-relative-bound",
                                    place[k].value, nan(""), place[k].where));
        ritz_measures_name_cause(&one, place[k].cause);
        assert_ok(ritz_fit_worst(&one, place[k].at, &worst));
    }
    assert_int_equal(worst.count, 1);
    assert_true(worst.item[0].value == 2.0);
    assert_non_null(strstr(worst.item[0].where, "15 Hz, force_of_the_arm"));
    assert_string_equal(worst.item[0].cause, "damping of inexact modes");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_worst_configuration_keeps_its_cause),
    cmocka_unit_test(the_system_s_basis_condenses_the_full_system),
    cmocka_unit_test(a_body_without_its_basis_is_refused),
    cmocka_unit_test(every_allocation_of_the_basis_may_fail),
    cmocka_unit_test(bounds_rule_out_what_fails_and_change_no_answer),
    cmocka_unit_test(the_answer_of_a_scene_is_bounded),
    cmocka_unit_test(what_is_told_at_least_is_below_the_error),
    cmocka_unit_test(bounds_are_of_the_same_mode_where_none_is_missing),
};

TEST_MODULE(fit_bounds, tests, folder_make, folder_remove)
