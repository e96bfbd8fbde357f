#include "responses.h"
#include "testing.h"

#include "spaces.h"

#include "poles/poles.h"

#include <ritz/basis.h>
#include <ritz/poles.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* SLICOT's example of AB13DD: 0.5000000001e6 at 1.414213562 rad/s. */
static void slicot_publishes_this_peak(void **unused)
{
    static const double A[] = {
        0, 1, 0, 0, 0, 0, -0.5, -0.0002, 0,  0,        0,  0,
        0, 0, 0, 1, 0, 0, 0,    0,       -1, -0.00002, 0,  0,
        0, 0, 0, 0, 0, 1, 0,    0,       0,  0,        -2, -0.000002};
    static const double B[] = {1, 0, 1, 0, 1, 0}, C[] = {1, 0, 1, 0, 1, 0};
    const spaces_rows rows = {6, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_norm norm = {0};

    (void)unused;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
    assert_near(norm.value, 0.5000000001e6, 5e-4);
    assert_near(norm.hertz * 2.0 * pi, 1.414213562, 5e-10);
    assert_true(norm.lower <= norm.value);
    assert_near(norm.lower, norm.value, 1e-8 * norm.value);
    assert_string_equal(norm.engine, "SLICOT AB13DD");
}

/* [s; -s]: of what is right of the axis, the mirror image. */
static void mirror(ritz_state_space *model)
{
    for (int64_t k = 0; k < model->A.nrow * model->A.ncol; k++)
        model->A.val[k] = -model->A.val[k];
    for (int64_t k = 0; k < model->B.nrow * model->B.ncol; k++)
        model->B.val[k] = -model->B.val[k];
}

/* SLICOT's example of AB13BD, two of whose poles are unstable: its L2 norm is
   that of both parts, which are orthogonal. */
static void
slicot_publishes_this_norm_of_stable_and_unstable_parts(void **unused)
{
    static const double A[] = {
        -0.04165, 0,     4.92,  0.492,  0,        0,     0,     /**/
        -5.21,    -12.5, 0,     0,      0,        0,     0,     /**/
        0,        3.33,  -3.33, 0,      0,        0,     0,     /**/
        0.545,    0,     0,     0,      0.0545,   0,     0,     /**/
        0,        0,     0,     -0.492, 0.004165, 0,     4.92,  /**/
        0,        0,     0,     0,      0.521,    -12.5, 0,     /**/
        0,        0,     0,     0,      0,        3.33,  -3.33, /**/
    };
    static const double B[] = {0, 0, 12.5, 0, 0, 0, 0, 0, 0, 0, 0, 12.5, 0, 0};
    static const double C[] = {1, 0, 0, 0, 0, 0, 0, /**/
                               0, 0, 0, 1, 0, 0, 0, /**/
                               0, 0, 0, 0, 1, 0, 0};
    const spaces_rows rows = {7, 2, 3, A, B, C, NULL, NULL};
    ritz_state_space model = {0}, part[2] = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};
    ritz_norm norm[2] = {0};

    (void)unused;
    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_int_equal(g.T.ncol, 2);
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_int_equal(b.kept, 5);
    assert_ok(spaces_project(&model, &b.W, &b.T, &part[0]));
    assert_ok(spaces_project(&model, &g.W, &g.T, &part[1]));
    mirror(&part[1]);
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_norm_two(&part[k], &norm[k]));
        ritz_state_space_free(&part[k]);
    }
    assert_near(hypot(norm[0].value, norm[1].value), 7.93948, 5e-6);
    assert_fails(ritz_norm_two(&model, &norm[0]), RITZ_ERR_ARGUMENT,
                 "2 of 7 poles are not left of the imaginary axis");
    ritz_state_space_free(&model);
}

/*
 * w^2 / (s^2 + 2 z w s + w^2): the peak 1 / (2 z sqrt(1 - z^2)) is at
 * w sqrt(1 - 2 z^2), the H2 norm sqrt(w / (4 z)).
 */
static void a_mode_has_its_closed_forms(void **unused)
{
    static const double zeta[] = {0.5, 0.02, 1e-4, 1e-6};
    const double w = 40.0;

    (void)unused;
    for (size_t k = 0; k < sizeof zeta / sizeof *zeta; k++) {
        double z = zeta[k];
        const double A[] = {0, 1, -w * w, -2 * z * w};
        const double B[] = {0, w * w}, C[] = {1, 0};
        const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
        double peak = 1.0 / (2.0 * z * sqrt(1.0 - z * z));
        RITZ_OWN(ritz_state_space) model = {0};
        ritz_norm norm = {0};

        assert_ok(spaces_make(&rows, &model));
        assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
        /* the tolerance, and poles z w off the axis known to eps w */
        assert_near(norm.value, peak, (1e-9 + 16 * DBL_EPSILON / z) * peak);
        assert_near(norm.hertz * 2.0 * pi, w * sqrt(1.0 - 2.0 * z * z),
                    1e-4 * w * fmax(z, 1e-6));
        assert_ok(ritz_norm_two(&model, &norm));
        assert_near(norm.value, sqrt(w / (4.0 * z)),
                    16 * DBL_EPSILON / z * sqrt(w / z));
    }
}

/* Units of inputs and outputs only scale the norm. */
static void units_do_not_matter(void **unused)
{
    static const double A[] = {-1, 2, -2, -1}, B[] = {1e-9, 0};
    static const double C[] = {0, 1e-12, 1e-12, 0}, D[] = {1e-22, 0};
    static const double one[] = {1, 0}, seen[] = {0, 1, 1, 0}, d[] = {0.1, 0};
    const spaces_rows small = {2, 1, 2, A, B, C, D, NULL};
    const spaces_rows plain = {2, 1, 2, A, one, seen, d, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_norm tiny = {0}, norm = {0};

    (void)unused;
    assert_ok(spaces_make(&small, &model));
    assert_ok(ritz_norm_infinity(&model, 1e-9, &tiny));
    ritz_state_space_free(&model);
    assert_ok(spaces_make(&plain, &model));
    assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
    assert_near(tiny.value * 1e21, norm.value, 2e-9 * norm.value);
}

/* What inputs do at once, no states, and what stands at infinity: 1 - 1/(s + 1)
   is s/(s + 1). */
static void feedthrough_counts(void **unused)
{
    static const double D[] = {3, 0, 4, 0}, A[] = {-1}, one[] = {1},
                        minus[] = {-1};
    const spaces_rows gain = {0, 2, 2, D, D, D, D, NULL};
    const spaces_rows high = {1, 1, 1, A, one, minus, one, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_norm norm = {0};

    (void)unused;
    assert_ok(spaces_make(&gain, &model));
    assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
    assert_near(norm.value, 5.0, 16 * DBL_EPSILON);
    assert_fails(ritz_norm_two(&model, &norm), RITZ_ERR_ARGUMENT,
                 "H2 norm: it is infinite, an input reaches an output at once");
    ritz_state_space_free(&model);
    assert_ok(spaces_make(&high, &model));
    assert_ok(ritz_norm_infinity(&model, 1e-9, &norm));
    assert_near(norm.value, 1.0, 2e-9);
}

/* Outside: SciPy 1.10, Lyapunov equation and a bounded search. */
static void collections_have_these_norms(void **unused)
{
    static const struct {
        const char *name;
        double infinity, hertz, two;
    } known[] = {
        {"building", 0.005276333761571003, 0.8285727739588027,
         0.004530060517918369},
        {"CDplayer", 2319820.9691393897, 3.5918393382791334,
         1102128.9069533446},
        {"heat-cont", 0.05610422184269782, 0.0, 0.011263044232557202},
    };

    (void)unused;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        RITZ_OWN(ritz_state_space) model = {0};
        ritz_norm norm = {0};

        if (!spaces_read(known[k].name, &model))
            skip();
        assert_ok(ritz_norm_infinity(&model, 1e-8, &norm));
        assert_near(norm.value, known[k].infinity, 1e-8 * known[k].infinity);
        assert_near(norm.hertz, known[k].hertz, 1e-6);
        assert_ok(ritz_norm_two(&model, &norm));
        assert_near(norm.value, known[k].two, 1e-9 * known[k].two);
    }
}

/* Ten modes scattered, 602 states: no Hamiltonian, the value is one that is
   met. Without the many the same ten go through AB13DD. */
static void large_models_get_a_value_that_is_met(void **unused)
{
    enum { MODES = 10, MANY = 602 };
    ritz_norm norm[2] = {0};

    (void)unused;
    for (int large = 0; large < 2; large++) {
        int64_t n = large ? MANY : 2 * MODES;
        double *A = calloc((size_t)(n * n), sizeof *A);
        double *B = calloc((size_t)n, sizeof *B);
        double *C = calloc((size_t)n, sizeof *C);
        const spaces_rows rows = {n, 1, 1, A, B, C, NULL, NULL};
        RITZ_OWN(ritz_state_space) model = {0};

        assert_non_null(A);
        assert_non_null(B);
        assert_non_null(C);
        for (int64_t i = 0; i < n; i += 2) {
            double w = 3.0 + (double)i * (1.0 + 0.01 * (double)(i % 7));

            A[i * n + i + 1] = w;
            A[(i + 1) * n + i] = -w;
            A[i * n + i] = A[(i + 1) * n + i + 1] = -0.002 * w;
            B[i] = i < 2 * MODES; /* what is not driven is only there */
            C[i] = i < 2 * MODES ? 1.0 + 0.1 * (double)(i % 5) : 1.0;
        }
        assert_ok(spaces_make(&rows, &model));
        assert_ok(ritz_norm_infinity(&model, 1e-9, &norm[large]));
        free(A);
        free(B);
        free(C);
    }
    assert_string_equal(norm[1].engine, "search at poles, a lower bound");
    assert_near(norm[1].value, norm[0].value, 3e-9 * norm[0].value);
    assert_near(norm[1].lower, norm[1].value, 0.0);
}

/* By hand: H of both, one with E, at one frequency. */
static void a_difference_is_what_both_answer_apart(void **unused)
{
    static const double A[] = {-1, 1, 0, -2}, B[] = {1, 2}, C[] = {1, 1};
    static const double D[] = {0.5}, E[] = {2, 0, 1, 1};
    static const double a[] = {-3}, one[] = {1};
    const spaces_rows with_E = {2, 1, 1, A, B, C, D, E};
    const spaces_rows small = {1, 1, 1, a, one, one, NULL, NULL};
    const double w = 0.7;
    double _Complex s = ritz_complex(0.0, w);
    /* (s E - A) x = B: E = [2 0; 1 1] */
    double _Complex det = (2 * s + 1) * (s + 2) + s;
    double _Complex x = ((s + 2) + 2.0) / det;
    double _Complex y = ((2 * s + 1) * 2.0 - s) / det;
    ritz_state_space model[2] = {0}, difference[2] = {0};
    double expected = cabs(x + y + 0.5 - 1.0 / (s + 3));

    (void)unused;
    assert_ok(spaces_make(&with_E, &model[0]));
    assert_ok(spaces_make(&small, &model[1]));
    for (int k = 0; k < 2; k++) {
        ritz_grid grid = {.hertz = (const double[]){w / (2 * pi), 1.0},
                          .count = 2};
        RITZ_OWN(ritz_response) response = {0};

        assert_ok(ritz_state_space_difference(&model[k], &model[1 - k],
                                              &difference[k]));
        assert_ok(ritz_state_space_check(&difference[k]));
        assert_int_equal(difference[k].A.nrow, 3);
        assert_ok(states_response(&difference[k], &grid, &response));
        assert_near(cabs(response.H[0]), expected, 64 * DBL_EPSILON);
    }
    assert_near(difference[0].D.val[0], 0.5, 0.0);
    assert_near(difference[1].D.val[0], -0.5, 0.0);
    for (int k = 0; k < 2; k++) {
        ritz_state_space_free(&model[k]);
        ritz_state_space_free(&difference[k]);
    }
}

static void models_that_differ_in_kind_have_no_difference(void **unused)
{
    static const double A[] = {-1}, B[] = {1, 1}, C[] = {1};
    const spaces_rows one = {1, 1, 1, A, B, C, NULL, NULL};
    const spaces_rows two = {1, 2, 1, A, B, C, NULL, NULL};
    ritz_state_space a = {0}, b = {0}, difference = {0};

    (void)unused;
    assert_ok(spaces_make(&one, &a));
    assert_ok(spaces_make(&two, &b));
    assert_fails(ritz_state_space_difference(&a, &b, &difference),
                 RITZ_ERR_ARGUMENT, "the models differ in inputs: 1 and 2");
    ritz_state_space_free(&b);
    assert_ok(spaces_make(&one, &b));
    snprintf(b.output[0], RITZ_NAME_SIZE, "tip");
    assert_fails(
        ritz_state_space_difference(&a, &b, &difference), RITZ_ERR_ARGUMENT,
        "output 1 is 'y1' in the full model and 'tip' in the reduced one");
    ritz_state_space_free(&a);
    ritz_state_space_free(&b);
}

static void infinite_norms_and_bad_tolerances_are_refused(void **unused)
{
    static const double A[] = {0, 1, -4, 0}, B[] = {0, 1}, C[] = {1, 0};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_norm norm = {0};

    (void)unused;
    assert_ok(spaces_make(&rows, &model));
    assert_fails(ritz_norm_infinity(&model, 1e-6, &norm), RITZ_ERR_ARGUMENT,
                 "H-infinity norm: 2 of 2 poles are not left of the imaginary "
                 "axis: a norm of the response is infinite");
    assert_fails(ritz_norm_infinity(&model, 0.0, &norm), RITZ_ERR_ARGUMENT,
                 "the tolerance of a norm is 0, it must be between 0 and 1");
}

static ritz_status norms_once(const ritz_state_space *model)
{
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_state_space) difference = {0};
    ritz_norm norm = {0};

    RITZ_TRY(ritz_state_space_difference(model, model, &difference));
    RITZ_TRY(ritz_norm_infinity(&difference, 1e-3, &norm));
    RITZ_TRY(ritz_norm_two(&difference, &norm));
done:
    return status;
}

static void norms_survive_every_allocation(void **unused)
{
    static const double A[] = {-1, 1, 0, -2}, B[] = {1, 2}, C[] = {1, 1};
    static const double E[] = {2, 0, 1, 1};
    ritz_state_space model = {0};

    (void)unused;
    for (int with_E = 0; with_E < 2; with_E++) {
        const spaces_rows rows = {2, 1, 1, A, B, C, NULL, with_E ? E : NULL};

        assert_ok(spaces_make(&rows, &model));
        assert_survives_every_allocation(norms_once(&model));
        ritz_state_space_free(&model);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(slicot_publishes_this_peak),
    cmocka_unit_test(slicot_publishes_this_norm_of_stable_and_unstable_parts),
    cmocka_unit_test(a_mode_has_its_closed_forms),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(feedthrough_counts),
    cmocka_unit_test(collections_have_these_norms),
    cmocka_unit_test(large_models_get_a_value_that_is_met),
    cmocka_unit_test(a_difference_is_what_both_answer_apart),
    cmocka_unit_test(models_that_differ_in_kind_have_no_difference),
    cmocka_unit_test(infinite_norms_and_bad_tolerances_are_refused),
    cmocka_unit_test(norms_survive_every_allocation),
};

TEST_MODULE(norms, tests, NULL, NULL)
