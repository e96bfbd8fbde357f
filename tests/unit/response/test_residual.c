/*
 * What modes above those that are summed answer where a M + b K damps them, on
 * a free bar of 331 dofs: more than are taken whole.
 */
#include "responses.h"
#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "verify/sides.h"

#include <ritz/response.h>

#include <complex.h>

enum { ELEMENTS = 330, DOFS = ELEMENTS + 1, POINTS = 8 };

/* Hz: the band holds modes at 0.5, 1, 1.5 and 2 Hz. Near 0 a free body's
   matrices are almost singular. */
static const double from_hz = 0.1, to_hz = 2.2;

/* Ratio 0.05 at 0.5 and 2 Hz; mostly of K; mostly of M. */
static const ritz_damping dampings[] = {
    {.kind = RITZ_DAMPING_RAYLEIGH, .a = 0.25, .b = 0.0064},
    {.kind = RITZ_DAMPING_RAYLEIGH, .a = 0.01, .b = 0.03},
    {.kind = RITZ_DAMPING_RAYLEIGH, .a = 6.0, .b = 0.001},
};

enum { DAMPINGS = sizeof dampings / sizeof *dampings };

/* Driven at its end and inside, seen as displacement and acceleration. */
static void open_bar(ritz_component *bar)
{
    const int64_t in[] = {ELEMENTS, 120};
    const int64_t out[] = {ELEMENTS, 200};

    assert_ok(bar_component(ELEMENTS, bar));
    assert_ok(frame_io(bar, 2, in, 2, out));
    ritz_dense_col(&bar->io.C, 200)[1] = 0.0;
    ritz_dense_col(&bar->io.Ca, 200)[1] = 1.0;
}

/* D = a M + b K as a matrix, and no word of it. */
static ritz_damping as_matrix(const ritz_damping *damping, ritz_component *bar)
{
    assert_ok(
        ritz_sparse_add(damping->a, &bar->M, damping->b, &bar->K, &bar->D));
    return (ritz_damping){0};
}

/* Of the bar by factors, the full matrices at each point. */
static void respond_directly(const ritz_component *bar,
                             const ritz_damping *damping, ritz_response *out)
{
    const ritz_grid grid = {
        .from_hz = from_hz, .to_hz = to_hz, .count = POINTS};

    assert_ok(direct_response(bar, damping, 3.0 * to_hz, &grid, out));
}

/* Largest difference over the largest |H| of its channel. */
static double apart(const ritz_response *direct, const double _Complex *H)
{
    double worst = 0.0;

    for (int v = 0; v < 4; v++) {
        double largest = 0.0, difference = 0.0;

        for (int64_t k = v; k < 4 * POINTS; k += 4) {
            largest = fmax(largest, cabs(direct->H[k]));
            difference = fmax(difference, cabs(direct->H[k] - H[k]));
        }
        worst = fmax(worst, difference / largest);
    }
    return worst;
}

static double modal_apart(const ritz_component *bar,
                          const ritz_damping *damping)
{
    const ritz_grid grid = {
        .from_hz = from_hz, .to_hz = to_hz, .count = POINTS};
    RITZ_OWN(ritz_response) direct = {0}, modal = {0};
    double found = 0.0;

    respond_directly(bar, damping, &direct);
    assert_ok(modal_response(bar, damping, 3.0 * to_hz, &grid, &modal));
    found = apart(&direct, modal.H);
    return found;
}

/* What ritz-verify compares with, at the same points. */
static double reference_apart(const ritz_component *bar,
                              const ritz_damping *damping, bool *factors)
{
    const ritz_reference_request request = {.band_hz = {from_hz, to_hz},
                                            .damping = *damping};
    RITZ_OWN(ritz_reference) *reference = NULL;
    RITZ_OWN(ritz_response) direct = {0};
    ritz_reference_sweep sweep = {.count = POINTS};
    double found = 0.0;

    respond_directly(bar, damping, &direct);
    assert_ok(ritz_reference_new(bar, &request, &reference));
    sweep.hertz = direct.hertz;
    assert_ok(ritz_reference_respond(reference, &sweep));
    found = apart(&direct, sweep.full);
    *factors = ritz_reference_factors(reference);
    sweep.hertz = NULL;
    ritz_sweep_free(&sweep);
    return found;
}

/*
 * The series is good to 1e-12 of what it stands for. A factor loses eps
 * lambda_max / |lambda - w^2|, 2.2e-16 * 1.3e6 / (2 pi 0.1)^2 = 7e-10 where
 * rigid motion answers; measured 5e-11. Undamped, the rest was 2e-4 off, and
 * 4e-3 where K damps most.
 */
static const double within = 1e-9;

static void modes_and_factors_agree_where_damping_is_proportional(void **state)
{
    (void)state;
    for (int k = 0; k < DAMPINGS; k++) {
        RITZ_OWN(ritz_component) bar = {0};
        ritz_damping rule = dampings[k], none = {0};
        bool factors = true;

        open_bar(&bar);
        assert_true(modal_apart(&bar, &rule) < within);
        assert_true(reference_apart(&bar, &rule, &factors) < within);
        assert_false(factors);
        none = as_matrix(&rule, &bar);
        assert_true(modal_apart(&bar, &none) < within);
        assert_true(reference_apart(&bar, &none, &factors) < within);
        assert_false(factors);
        /* half of it each way */
        for (int64_t p = 0; p < bar.D.colptr[bar.D.ncol]; p++)
            bar.D.val[p] *= 0.5;
        rule.a *= 0.5;
        rule.b *= 0.5;
        assert_true(modal_apart(&bar, &rule) < within);
    }
}

/* a w = 2000 is beyond lambda of the first mode above, (2 pi 6.6)^2 = 1720:
 * there is no series. */
static void damping_that_leaves_no_series_takes_factors(void **state)
{
    const ritz_damping heavy = {
        .kind = RITZ_DAMPING_RAYLEIGH, .a = 145.0, .b = 1e-4};
    RITZ_OWN(ritz_component) bar = {0};
    bool factors = false;

    (void)state;
    open_bar(&bar);
    assert_true(reference_apart(&bar, &heavy, &factors) < within);
    assert_true(factors);
}

/*
 * D = a M + c K M^-1 K, M lumped, couples no modes and is no a M + b K: those
 * that are known do not say what it does to the rest.
 */
static void damping_of_higher_powers_takes_factors(void **state)
{
    const double a = 0.6, c = 1e-6;
    const ritz_damping none = {0};
    int64_t row[5 * DOFS], col[5 * DOFS], at = 0;
    double m[DOFS], val[5 * DOFS];
    RITZ_OWN(ritz_component) bar = {0};
    ritz_dense K = {0}, Q = {0};
    bool factors = false;

    (void)state;
    open_bar(&bar);
    for (int64_t k = 0; k < DOFS; k++) {
        row[k] = k;
        m[k] = 1.0 / ELEMENTS;
    }
    ritz_sparse_free(&bar.M);
    assert_ok(ritz_sparse_from_triplets(DOFS, DOFS, DOFS, row, row, m, &bar.M));
    assert_ok(ritz_sparse_dense(&bar.K, &K));
    assert_ok(ritz_dense_mul(&K, &K, &Q));
    for (int64_t j = 0; j < DOFS; j++)
        for (int64_t i = 0; i < DOFS; i++)
            if (ritz_dense_col(&Q, j)[i] != 0.0) {
                row[at] = i;
                col[at] = j;
                val[at++] = c * ELEMENTS * ritz_dense_col(&Q, j)[i] +
                            (i == j ? a * m[i] : 0.0);
            }
    assert_ok(ritz_sparse_from_triplets(DOFS, DOFS, at, row, col, val, &bar.D));
    assert_true(reference_apart(&bar, &none, &factors) < within);
    assert_true(factors);
    ritz_dense_free(&K);
    ritz_dense_free(&Q);
}

static ritz_status respond_once(const ritz_component *bar)
{
    const ritz_grid grid = {.from_hz = 0.1, .to_hz = 0.3, .count = 2};
    const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_response) r = {0};

    RITZ_TRY(modal_response(bar, &none, 1.0, &grid, &r));
done:
    return status;
}

/*
 * With M s^2 every frequency is f / s, and displacements stay what they were.
 * Below the first mode, 0.5 Hz / s, rigid motion alone is kept. Errors are of a
 * free body's matrices near 0, as above; a shift that does not follow the body
 * leaves out most of what is not rigid.
 */
static void a_slow_body_answers_as_a_fast_one_does(void **state)
{
    enum { MANY = 4 };
    const int64_t end = ELEMENTS;
    const double slower = 8192.0;
    const ritz_damping rule = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    const ritz_grid grid = {.from_hz = 0.1, .to_hz = 0.2, .count = MANY};
    const ritz_grid later = {
        .from_hz = 0.1 / slower, .to_hz = 0.2 / slower, .count = MANY};
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_response) fast = {0}, slow = {0};

    (void)state;
    assert_ok(bar_component(ELEMENTS, &bar));
    assert_ok(frame_io(&bar, 1, &end, 1, &end));
    assert_ok(modal_response(&bar, &rule, 0.3, &grid, &fast));
    for (int64_t p = 0; p < bar.M.colptr[bar.M.ncol]; p++)
        bar.M.val[p] *= slower * slower;
    assert_ok(modal_response(&bar, &rule, 0.3 / slower, &later, &slow));
    for (int64_t k = 0; k < MANY; k++)
        assert_true(cabs(slow.H[k] - fast.H[k]) < within * cabs(fast.H[k]));
}

static void the_rest_survives_every_allocation(void **state)
{
    const int64_t end = 6;
    RITZ_OWN(ritz_component) bar = {0};

    (void)state;
    assert_ok(bar_component(end, &bar));
    assert_ok(frame_io(&bar, 1, &end, 1, &end));
    (void)as_matrix(&dampings[0], &bar);
    assert_survives_every_allocation(respond_once(&bar));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modes_and_factors_agree_where_damping_is_proportional),
    cmocka_unit_test(damping_that_leaves_no_series_takes_factors),
    cmocka_unit_test(damping_of_higher_powers_takes_factors),
    cmocka_unit_test(a_slow_body_answers_as_a_fast_one_does),
    cmocka_unit_test(the_rest_survives_every_allocation),
};

TEST_MODULE(residual, tests, NULL, NULL)
