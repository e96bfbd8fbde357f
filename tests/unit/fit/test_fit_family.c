/* Candidates whose bases are columns of a basis with more modes. */
#include "testing.h"

#include "fit_scenes.h"
#include "frame.h"
#include "masses.h"
#include "project.h"
#include "scenes.h"
#include "truss.h"

#include "fit/fitter.h"

#include <ritz/matrix.h>

#include <stdio.h>

enum { LARGEST = 12, NESTED = 4 };

static const ritz_method *const nested[NESTED] = {
    &ritz_method_craig_bampton, &ritz_method_krylov,
    &ritz_method_krylov_cms_fixed, &ritz_method_krylov_cms_free};

/* The free truss, loaded and measured at its end, with a port at a grid. */
static void open_truss(bool damped, ritz_component *truss)
{
    const int64_t in = 69, out = 71;

    assert_ok(truss_component(&truss_free72, truss));
    assert_ok(frame_io(truss, 1, &in, 1, &out));
    assert_ok(add_port(truss, "left", 1));
    assert_ok(add_port(truss, "right", 34));
    if (!damped)
        return;
    ritz_dampers_free(&truss->dampers);
    assert_ok(ritz_dampers_new(truss->num_dofs, 1, &truss->dampers));
    (void)snprintf(truss->dampers.name[0], RITZ_NAME_SIZE, "strut");
    ritz_dense_col(&truss->dampers.B, 0)[30] = 1.0;
    ritz_dense_col(&truss->dampers.B, 0)[33] = -1.0;
    truss->dampers.c[0] = 1.0;
}

static ritz_fit_request ask(const ritz_method *const *methods, int64_t count)
{
    ritz_fit_request request = fit_scenes_truss("frequency=1e-3,mac=0.99");

    request.methods = methods;
    request.num_methods = count;
    return request;
}

/* Both models have columns of the same kinds and the same eigenvalues, and the
   parts are Phi'M T of the first. */
static void assert_same_model(const ritz_fitter *fitter,
                              const ritz_reduced *taken,
                              const ritz_dense *parts, const ritz_reduced *made)
{
    RITZ_OWN(ritz_pairs) a = {0}, b = {0};
    RITZ_OWN(ritz_dense) own = {0};
    const int64_t r = made->K.ncol;

    assert_int_equal(taken->K.ncol, r);
    assert_memory_equal(taken->columns.kind, made->columns.kind,
                        (size_t)r * sizeof *made->columns.kind);
    assert_ok(ritz_eigen_dense(&taken->K, &taken->M, &a));
    assert_ok(ritz_eigen_dense(&made->K, &made->M, &b));
    assert_int_equal(a.Phi.ncol, b.Phi.ncol);
    for (int64_t k = 0; k < b.Phi.ncol; k++) /* and rounding, 1e-12 */
        assert_near(a.lambda[k], b.lambda[k],
                    1e-9 * b.lambda[k] + 1e-12 * b.lambda[r - 1]);
    assert_int_equal(parts->ncol, r);
    assert_ok(
        ritz_reference_parts(fitter->place[0].reference, &taken->T, &own));
    for (int64_t k = 0; k < own.nrow * own.ncol; k++)
        assert_near(own.val[k], parts->val[k], 1e-12 * ritz_dense_max(parts));
}

/* The options are the same, except for `count no` of a basis that candidates
   share. */
static void assert_options(const ritz_method *method, const ritz_reduced *taken,
                           const ritz_reduced *made)
{
    const bool shared = method->nested || method->narrow;
    const bool uncounted = shared && method->uses & RITZ_USES_COUNT;
    char expected[2 * sizeof made->origin.options];

    (void)snprintf(expected, sizeof expected, "%s%s", made->origin.options,
                   uncounted ? " count no" : "");
    assert_string_equal(taken->origin.options, expected);
    assert_null(strstr(made->origin.options, "count"));
}

static void compare_all(const ritz_method *method, ritz_fitter *fitter)
{
    for (int64_t modes = LARGEST; modes >= 1; modes--) {
        RITZ_OWN(ritz_reduced) taken = {0}, made = {0};
        RITZ_OWN(ritz_dense) parts = {0};

        assert_ok(
            ritz_fit_take(fitter, method, 0, modes, true, &taken, &parts));
        assert_ok(ritz_fit_body(fitter, method, 0, modes, &made));
        assert_same_model(fitter, &taken, &parts, &made);
        assert_options(method, &taken, &made);
    }
}

static void fewer_modes_are_columns_of_more(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, NESTED);
    RITZ_OWN(ritz_fitter) *fitter = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    for (int m = 0; m < NESTED; m++) {
        assert_true(nested[m]->nested);
        compare_all(nested[m], fitter);
        assert_int_equal(fitter->num_families, m + 1);
        assert_false(fitter->family[m].exact);
    }
}

/* Take a candidate of rubin from the kept basis. */
static ritz_status narrow_once(ritz_fitter *fitter)
{
    RITZ_OWN(ritz_reduced) taken = {0};
    RITZ_OWN(ritz_dense) parts = {0};

    return ritz_fit_take(fitter, &ritz_method_rubin, 0, 2, true, &taken,
                         &parts);
}

/* With fewer modes, bases of free modes follow from one basis of macneal-rubin
   with more: the residual modes get what the other modes had. */
static void bases_of_free_modes_follow_from_one(void **state)
{
    static const ritz_method *const free_modes[] = {&ritz_method_rubin,
                                                    &ritz_method_macneal_rubin};
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(free_modes, 2);
    RITZ_OWN(ritz_fitter) *fitter = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    for (int m = 0; m < 2; m++)
        compare_all(free_modes[m], fitter);
    assert_int_equal(fitter->num_families, 1);
    assert_ptr_equal(fitter->family[0].method, free_modes[1]);
    assert_survives_every_allocation(narrow_once(fitter));
    assert_false(fitter->family[0].exact);
}

/* Of 69 flexible modes three are left for four attached dofs: a residual mode is
   left out, so that bases with fewer modes do not follow. */
static void residual_modes_that_are_left_out_end_that(void **state)
{
    const ritz_method *const one[] = {&ritz_method_macneal_rubin};
    const int64_t modes[] = {66, 3};
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(one, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_reduced) taken = {0}, made = {0};
        RITZ_OWN(ritz_dense) parts = {0};

        assert_ok(
            ritz_fit_take(fitter, one[0], 0, modes[k], true, &taken, &parts));
        assert_ok(ritz_fit_body(fitter, one[0], 0, modes[k], &made));
        assert_same_model(fitter, &taken, &parts, &made);
        assert_true(fitter->family[0].exact);
    }
}

/* Static vectors of dampers are made without the part that lies in the modes,
   so they differ with the number of modes. */
static void static_vectors_are_made_for_each_number_of_modes(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;

    (void)state;
    open_truss(true, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    compare_all(nested[0], fitter);
    assert_true(fitter->family[0].exact);
}

/* A method that is not nested makes no second basis if the same number of modes
   is asked for again. Invariants and options are those of the basis. */
static void the_last_basis_of_a_method_is_kept(void **state)
{
    const ritz_method *const one[] = {&ritz_method_macneal};
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(one, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_reduced) taken = {0}, made = {0};
    RITZ_OWN(ritz_dense) parts = {0};
    const double *T = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    compare_all(one[0], fitter);
    assert_int_equal(fitter->num_families, 1);
    assert_true(fitter->family[0].exact);
    T = fitter->family[0].whole.T.val;
    assert_ok(ritz_fit_take(fitter, one[0], 0, 1, true, &taken, &parts));
    assert_ptr_equal(fitter->family[0].whole.T.val, T);
    assert_ok(ritz_fit_body(fitter, one[0], 0, 1, &made));
    assert_memory_equal(taken.K.val, made.K.val,
                        (size_t)(made.K.ncol * made.K.ncol) *
                            sizeof *made.K.val);
    assert_int_equal(taken.invariants.momentum.ncol,
                     made.invariants.momentum.ncol);
    assert_string_equal(taken.origin.options, made.origin.options);
}

/* A candidate with more modes than the first basis has makes a larger one. */
static void more_modes_than_the_basis_has_make_a_larger_one(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    int64_t first = 0;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    for (int64_t modes = 0; modes <= 60; modes += 5) {
        RITZ_OWN(ritz_reduced) taken = {0};
        RITZ_OWN(ritz_dense) parts = {0};

        assert_ok(
            ritz_fit_take(fitter, nested[0], 0, modes, false, &taken, &parts));
        assert_null(taken.T.val);
        assert_true(fitter->family[0].modes >= modes);
        if (modes == 0)
            first = fitter->family[0].modes;
    }
    assert_int_equal(fitter->num_families, 1);
    assert_true(first > 0 && fitter->family[0].modes > first);
}

/* Take a candidate of several methods in turn. @return entries of all bases */
static int64_t take_in_turn(ritz_fitter *fitter)
{
    static const int served[] = {0, 1, 0, 2};
    int64_t entries = 0;

    for (size_t k = 0; k < sizeof served / sizeof *served; k++) {
        RITZ_OWN(ritz_reduced) taken = {0};
        RITZ_OWN(ritz_dense) parts = {0};

        assert_ok(ritz_fit_take(fitter, nested[served[k]], 0, 3, false, &taken,
                                &parts));
    }
    assert_int_equal(fitter->num_families, 3);
    for (int k = 0; k < 3; k++)
        entries +=
            fitter->family[k].whole.T.nrow * fitter->family[k].whole.T.ncol;
    return entries;
}

/* Where there is no room for all three, the third basis drops the one of the
   other two that served longest ago, and no more. */
static void the_basis_that_served_longest_ago_is_dropped(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, NESTED);
    RITZ_OWN(ritz_fitter) *roomy = NULL, *narrow = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &roomy));
    assert_ok(ritz_fitter_new(&truss, &request, &narrow));
    narrow->most_entries = take_in_turn(roomy) - 1;
    (void)take_in_turn(narrow);
    assert_non_null(narrow->family[0].whole.T.val);
    assert_null(narrow->family[1].whole.T.val);
    assert_non_null(narrow->family[2].whole.T.val);
}

/* What is not a number is no proof, wherever it stands among other errors. */
static void an_error_that_is_no_number_is_not_met(void **state)
{
    static const char *const names[] = {"frequency-relative", "mac",
                                        "response-relative"};

    (void)state;
    for (int bad = 0; bad < 3; bad++) {
        ritz_fit_candidate candidate = {0};
        const ritz_fit_request request = ask(nested, 1);

        for (int k = 0; k < 3; k++)
            assert_ok(ritz_measures_add(
                &candidate.errors, names[k],
                k == bad ? nan("") : (k == 1 ? 1.0 : 1e-9), 0.5, ""));
        ritz_fit_judge(&request.tolerance, &candidate);
        assert_false(candidate.feasible);
        assert_int_equal(candidate.worst, bad);
        ritz_measures_free(&candidate.errors);
    }
}

/* Errors measured with Phi'M T and without T are those with T, MAC included. */
static void errors_without_a_basis_are_those_with_it(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_reduced) taken = {0};
    RITZ_OWN(ritz_dense) parts = {0};
    RITZ_OWN(ritz_measures) with = {0}, without = {0};
    const ritz_reference *reference = NULL;

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    reference = fitter->place[0].reference;
    assert_ok(ritz_fit_take(fitter, nested[0], 0, 4, true, &taken, &parts));
    assert_ok(ritz_reference_measure(reference,
                                     ritz_model_of_reduced(&taken, NULL),
                                     &request.tolerance, 0, &with));
    ritz_dense_free(&taken.T);
    assert_ok(ritz_reference_measure_parts(
        reference, ritz_model_of_reduced(&taken, NULL),
        &(ritz_compared){.parts = &parts}, &request.tolerance, 0, &without));
    assert_non_null(find_measure(&with, "mac"));
    assert_true(find_measure(&with, "mac")->value < 1.0);
    assert_int_equal(with.count, without.count);
    for (int64_t k = 0; k < with.count; k++) {
        assert_string_equal(with.item[k].name, without.item[k].name);
        assert_near(with.item[k].value, without.item[k].value, 1e-12);
    }
}

/* If only measures with a limit are requested, these and the measures that cost
   nothing have the same values as otherwise, and the others are left out. */
static void measures_without_a_limit_can_be_left_out(void **state)
{
    RITZ_OWN(ritz_component) truss = {0};
    const ritz_fit_request request = ask(nested, 1);
    static const int of[] = {RITZ_MEASURE_FREQUENCY, RITZ_MEASURE_RESPONSE,
                             RITZ_MEASURE_GAIN};
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_reduced) taken = {0};
    RITZ_OWN(ritz_dense) parts = {0};

    (void)state;
    open_truss(false, &truss);
    assert_ok(ritz_fitter_new(&truss, &request, &fitter));
    assert_ok(ritz_fit_take(fitter, nested[0], 0, 4, false, &taken, &parts));
    for (int k = 0; k < 3; k++) {
        ritz_verify_request limits = RITZ_VERIFY_NONE;
        RITZ_OWN(ritz_measures) all = {0}, some = {0};

        limits.limit[of[k]] = 1e-3;
        for (int t = 0; t < 2; t++)
            assert_ok(ritz_reference_measure_parts(
                fitter->place[0].reference, ritz_model_of_reduced(&taken, NULL),
                &(ritz_compared){.parts = &parts}, &limits,
                RITZ_AT_RANDOM | (t == 0 ? 0 : RITZ_ONLY_LIMITED),
                t == 0 ? &all : &some));
        assert_non_null(find_measure(&some, ritz_measure_table[of[k]].name));
        assert_non_null(find_measure(&some, "missing-modes"));
        assert_int_equal(!ritz_measures_find(&some, "response-relative"),
                         k != 1);
        assert_int_equal(!ritz_measures_find(&some, "static-gain-relative"),
                         k != 2);
        for (int64_t j = 0; j < some.count; j++)
            assert_true(some.item[j].value ==
                        find_measure(&all, some.item[j].name)->value);
    }
}

static ritz_status search_once(const ritz_component *truss)
{
    ritz_fit_request request = ask(nested, 1);
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_reduced) taken = {0};
    RITZ_OWN(ritz_dense) parts = {0};

    request.num_random = 0;
    RITZ_CHECK(ritz_fitter_new(truss, &request, &fitter));
    return ritz_fit_take(fitter, nested[0], 0, 2, true, &taken, &parts);
}

static void reducing_by_a_kept_basis_survives_every_allocation(void **state)
{
    const double ones[] = {1.0, 1.0};
    const int64_t in = 1;
    RITZ_OWN(ritz_component) beam = {0};

    (void)state;
    assert_ok(masses_component(2, ones, ones, NULL, &beam));
    assert_ok(masses_io(&beam, 1, &in, 1, &in));
    assert_survives_every_allocation(search_once(&beam));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(fewer_modes_are_columns_of_more),
    cmocka_unit_test(bases_of_free_modes_follow_from_one),
    cmocka_unit_test(residual_modes_that_are_left_out_end_that),
    cmocka_unit_test(static_vectors_are_made_for_each_number_of_modes),
    cmocka_unit_test(the_last_basis_of_a_method_is_kept),
    cmocka_unit_test(more_modes_than_the_basis_has_make_a_larger_one),
    cmocka_unit_test(the_basis_that_served_longest_ago_is_dropped),
    cmocka_unit_test(an_error_that_is_no_number_is_not_met),
    cmocka_unit_test(errors_without_a_basis_are_those_with_it),
    cmocka_unit_test(measures_without_a_limit_can_be_left_out),
    cmocka_unit_test(reducing_by_a_kept_basis_survives_every_allocation),
};
TEST_MODULE(fit_family, tests, NULL, NULL)
