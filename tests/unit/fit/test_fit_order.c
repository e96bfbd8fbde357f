/* The order of columns, held to the greedy search that measures every model. */
#include "testing.h"

#include "fit_scenes.h"
#include "frame.h"
#include "project.h"
#include "scenes.h"
#include "truss.h"

#include "fit/nesting.h"

#include <math.h>
#include <string.h>

enum { MODES = 18, TRIED = 6 };

static const ritz_method *const methods[] = {&ritz_method_craig_bampton,
                                             &ritz_method_krylov_cms_fixed};

/* The free truss of 72 dofs, loaded and measured at its end, with a port. */
typedef struct ordered_truss {
    ritz_component truss;
    ritz_fitter *fitter;
    ritz_nesting n;
} ordered_truss;

static void ordered_truss_free(ordered_truss *o)
{
    ritz_nesting_free(&o->n);
    ritz_fitter_free(&o->fitter);
    ritz_component_free(&o->truss);
}

static void open_truss(const char *tolerance, int64_t method, ordered_truss *o)
{
    const int64_t in = 69, out = 71;
    const ritz_fit_request request = fit_scenes_truss(tolerance);

    assert_ok(truss_component(&truss_free72, &o->truss));
    assert_ok(frame_io(&o->truss, 1, &in, 1, &out));
    assert_ok(add_port(&o->truss, "left", 1));
    assert_ok(add_port(&o->truss, "right", 34));
    assert_ok(ritz_fitter_new(&o->truss, &request, &o->fitter));
    assert_ok(ritz_bodies_new(1, &o->n.whole));
    assert_ok(ritz_fit_body(o->fitter, methods[method], 0, MODES,
                            &o->n.whole.item[0]));
}

static ritz_status put_in_order(ordered_truss *o, int64_t method)
{
    int64_t modes = MODES;
    const ritz_fit_candidate of = {
        .method = methods[method], .modes = &modes, .num_bodies = 1};

    return ritz_nesting_order(o->fitter, &of, &o->n);
}

/* What ritz_nesting_order found before the last of the columns was dropped,
   those that matter most alone first. */
static void sort_alone(const ritz_nesting *n, int64_t *column)
{
    int64_t count = n->fixed;

    memcpy(column, n->column, (size_t)n->fixed * sizeof *column);
    for (int64_t c = 0; c < n->count; c++) {
        int64_t at = count;

        for (int64_t k = 0; k < n->fixed; k++)
            at = column[k] == c ? -1 : at;
        if (at < 0)
            continue;
        for (; at > n->fixed && n->alone[c] > n->alone[column[at - 1]]; at--)
            column[at] = column[at - 1];
        column[at] = c;
        count++;
    }
    assert_int_equal(count, n->count);
}

/* The ratio without one of the first @p left columns. */
static double measure_without(ritz_nesting *n, const int64_t *column,
                              int64_t left, int64_t which)
{
    int64_t some[72] = {0};
    double ratio = 0.0;

    for (int64_t k = 0, at = 0; k < left; k++)
        if (k != which)
            some[at++] = column[k];
    assert_ok(ritz_nesting_ratio(n, left - 1, some, HUGE_VAL, NULL, &ratio));
    return ratio;
}

/* The greedy search, every one of the last six measured at each step. */
static void drop_all(ritz_nesting *n, int64_t *column)
{
    for (int64_t left = n->count - 1; left > n->fixed + 1; left--) {
        double least = HUGE_VAL;
        int64_t worst = left - 1, dropped = 0;

        for (int64_t t = 0; t < TRIED && left - 1 - t >= n->fixed; t++) {
            const double ratio = measure_without(n, column, left, left - 1 - t);

            if (ratio < least) {
                least = ratio;
                worst = left - 1 - t;
            }
        }
        dropped = column[worst];
        memmove(column + worst, column + worst + 1,
                (size_t)(left - 1 - worst) * sizeof *column);
        column[left - 1] = dropped;
    }
}

/* Eigenvalues rule columns out where frequencies have a tolerance; with a
   response alone every column is measured. The order is the same. */
static void eigenvalues_rule_out_only_what_is_worse(void **state)
{
    static const char *const tolerance[] = {
        "frequency=1e-3", "frequency=1e-5,mac=0.99",
        "frequency=1e-2,response=1e-2", "response=1e-2"};

    (void)state;
    for (int64_t k = 0; k < 4; k++)
        for (int64_t m = 0; m < 2; m++) {
            RITZ_OWN(ordered_truss) o = {0};
            int64_t column[72] = {0};

            open_truss(tolerance[k], m, &o);
            assert_ok(put_in_order(&o, m));
            assert_true(o.n.count - o.n.fixed >= MODES - 3);
            sort_alone(&o.n, column);
            drop_all(&o.n, column);
            assert_memory_equal(column, o.n.column,
                                (size_t)o.n.count * sizeof *column);
        }
}

/* The order, and the modes of the last model that was left. */
static void the_order_has_the_same_bits_with_any_number_of_threads(void **state)
{
    RITZ_OWN(ordered_truss) one = {0}, two = {0};

    (void)state;
    ritz_set_threads(1);
    open_truss("frequency=1e-3,response=1e-2", 0, &one);
    assert_ok(put_in_order(&one, 0));
    ritz_set_threads(2);
    open_truss("frequency=1e-3,response=1e-2", 0, &two);
    assert_ok(put_in_order(&two, 0));
    ritz_set_threads(1);
    assert_int_equal(one.n.count, two.n.count);
    assert_memory_equal(one.n.column, two.n.column,
                        (size_t)one.n.count * sizeof *one.n.column);
    assert_memory_equal(one.n.alone, two.n.alone,
                        (size_t)one.n.count * sizeof *one.n.alone);
    assert_memory_equal(one.n.modes.lambda, two.n.modes.lambda,
                        (size_t)one.n.modes.Phi.ncol *
                            sizeof *one.n.modes.lambda);
}

/* A whole answer: errors of all its prefixes. */
static void errors_of_prefixes_do_not_depend_on_threads(void **state)
{
    RITZ_OWN(ordered_truss) o = {0};
    RITZ_OWN(ritz_fit_candidate) c = {0};
    RITZ_OWN(ritz_reduced) one = {0}, two = {0};
    const int64_t modes = MODES;

    (void)state;
    ritz_set_threads(1);
    open_truss("frequency=1e-3,response=1e-2", 0, &o);
    assert_ok(ritz_fitter_try(o.fitter, methods[0], &modes, &c));
    assert_ok(ritz_fitter_reduced(o.fitter, &c, &one));
    ritz_set_threads(3);
    assert_ok(ritz_fitter_reduced(o.fitter, &c, &two));
    ritz_set_threads(1);
    assert_int_equal(one.nested.count, two.nested.count);
    assert_true(one.nested.count > 0);
    assert_int_equal(one.nested.num_errors, two.nested.num_errors);
    assert_memory_equal(one.nested.order, two.nested.order,
                        (size_t)one.nested.count * sizeof *one.nested.order);
    assert_memory_equal(one.nested.value.val, two.nested.value.val,
                        (size_t)(one.nested.count * one.nested.num_errors) *
                            sizeof *one.nested.value.val);
}

static ritz_status open_again(const ordered_truss *o, int64_t methods_asked,
                              int64_t *pencils)
{
    const ritz_method *const krylov[] = {&ritz_method_krylov_cms_fixed};
    ritz_fit_request request = o->fitter->request;
    RITZ_OWN(ritz_fitter) *again = NULL;

    request.num_methods = methods_asked;
    request.methods = krylov;
    RITZ_CHECK(ritz_fitter_new(&o->truss, &request, &again));
    *pencils = ritz_spectra_count(again->spectra);
    return RITZ_OK;
}

/* Two pencils are solved if craig-bampton is among the methods: that of the
   whole component and that of its interior. */
static void fixed_modes_are_found_with_those_of_the_whole(void **state)
{
    RITZ_OWN(ordered_truss) o = {0};

    (void)state;
    open_truss("frequency=1e-3", 0, &o);
    for (int threads = 1; threads <= 2; threads++) {
        int64_t all = 0, krylov = 0;

        ritz_set_threads(threads);
        assert_ok(open_again(&o, 0, &all));
        assert_ok(open_again(&o, 1, &krylov));
        assert_int_equal(all, 2);
        assert_int_equal(krylov, 1);
    }
    ritz_set_threads(1);
}

static void every_allocation_of_a_fitter_may_fail(void **state)
{
    RITZ_OWN(ordered_truss) o = {0};
    int64_t pencils = 0;

    (void)state;
    open_truss("frequency=1e-3", 0, &o);
    assert_survives_every_allocation(open_again(&o, 0, &pencils));
}

static ritz_status order_again(ordered_truss *o)
{
    RITZ_OWN(ritz_nesting) n = {0};
    int64_t modes = MODES;
    const ritz_fit_candidate of = {
        .method = methods[0], .modes = &modes, .num_bodies = 1};

    RITZ_CHECK(ritz_bodies_new(1, &n.whole));
    RITZ_CHECK(ritz_fit_body(o->fitter, methods[0], 0, 4, &n.whole.item[0]));
    return ritz_nesting_order(o->fitter, &of, &n);
}

static void every_allocation_may_fail(void **state)
{
    RITZ_OWN(ordered_truss) o = {0};

    (void)state;
    open_truss("frequency=1e-3", 0, &o);
    assert_survives_every_allocation(order_again(&o));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(eigenvalues_rule_out_only_what_is_worse),
    cmocka_unit_test(the_order_has_the_same_bits_with_any_number_of_threads),
    cmocka_unit_test(errors_of_prefixes_do_not_depend_on_threads),
    cmocka_unit_test(fixed_modes_are_found_with_those_of_the_whole),
    cmocka_unit_test(every_allocation_of_a_fitter_may_fail),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(fit_order, tests, NULL, NULL)
