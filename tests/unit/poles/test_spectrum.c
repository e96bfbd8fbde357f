#include "testing.h"

#include "poles/poles.h"
#include "scenes.h"
#include "spring_chain.h"

#include <complex.h>

static const double eps = 2.2204460492503131e-16;

/* All of a model of two or three coordinates as arrays; NULL: none. */
static ritz_spectrum poles_of(int64_t n, double *K, double *M, double *D,
                              double *K4, const char *damping)
{
    const ritz_dense A[] = {{n, n, K}, {n, n, M}, {n, n, D}, {n, n, K4}};
    const ritz_second_order model = {&A[0], &A[1], &A[2], &A[3], NULL};
    ritz_damping given = {0};
    ritz_spectrum spectrum = {0};

    assert_ok(ritz_damping_parse(damping, &given));
    assert_ok(
        ritz_spectrum_of(ritz_model_of_dense(&model, &given), NULL, &spectrum));
    return spectrum;
}

static void assert_pole(double _Complex s, double real, double imaginary,
                        double bound)
{
    assert_near(creal(s), real, bound);
    assert_near(cimag(s), imaginary, bound);
}

/* m = 2, k = 50: w = 5; d = 4: zeta = 0.2, d = 20 critical, d = 52: s = -1 and
 * -25. */
static void one_mass_swings_creeps_or_does_neither(void **state)
{
    double k = 50.0, m = 2.0, d = 4.0;
    RITZ_OWN(ritz_spectrum) s = poles_of(1, &k, &m, &d, NULL, "");

    (void)state;
    assert_int_equal(s.count, 1);
    assert_pole(s.s[0], -1.0, sqrt(24.0), 8.0 * eps);
    assert_near(ritz_spectrum_ratio(s.s[0]), 0.2, 2.0 * eps);
    assert_near(s.residual[0], 0.0, 4.0 * eps);
    ritz_spectrum_free(&s);
    d = 20.0;
    s = poles_of(1, &k, &m, &d, NULL, "");
    assert_int_equal(s.count, 2);
    /* a double root: rounding of 1 / (2 w) moves it by its square root */
    assert_pole(s.s[0], -5.0, 0.0, 5.0 * sqrt(8.0 * eps));
    ritz_spectrum_free(&s);
    d = 52.0;
    s = poles_of(1, &k, &m, &d, NULL, "");
    assert_int_equal(s.count, 2);
    assert_pole(s.s[0], -1.0, 0.0, 8.0 * eps);
    assert_pole(s.s[1], -25.0, 0.0, 100.0 * eps);
    for (int j = 0; j < 2; j++) /* tools print 0, not -0 */
        assert_false(signbit(cimag(s.s[j])));
    assert_near(ritz_spectrum_ratio(s.s[1]), 1.0, 0.0);
}

/* w = 1 and 3 of their own, 10 eps each. */
static void ratios_and_rayleigh_act_on_the_modes(void **state)
{
    double K[] = {1.0, 0.0, 0.0, 9.0};
    double M[] = {1.0, 0.0, 0.0, 1.0};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, NULL, NULL, "modes 0.1 0.3");

    (void)state;
    assert_pole(s.s[0], -0.1, sqrt(0.99), 10.0 * eps);
    assert_pole(s.s[1], -0.9, 3.0 * sqrt(0.91), 30.0 * eps);
    ritz_spectrum_free(&s);
    s = poles_of(2, K, M, NULL, NULL, "rayleigh 0.1 0.2");
    assert_near(-2.0 * creal(s.s[0]), 0.1 + 0.2, 10.0 * eps);
    assert_near(-2.0 * creal(s.s[1]), 0.1 + 0.2 * 9.0, 30.0 * eps);
}

/* s^2 + k (1 + i eta) = 0: s = i w sqrt(1 + i eta), the one of Im s > 0. */
static void structural_damping_is_a_complex_stiffness(void **state)
{
    double k = 9.0, m = 1.0, k4 = 0.9;
    RITZ_OWN(ritz_spectrum) s = poles_of(1, &k, &m, NULL, &k4, "");
    double _Complex i = (double _Complex)_Complex_I;
    double _Complex expected = 3.0 * i * csqrt(1.0 + 0.1 * i);

    (void)state;
    assert_int_equal(s.count, 1);
    assert_pole(s.s[0], creal(expected), cimag(expected), 20.0 * eps);
}

/*
 * x'' - g y' + k x = 0, y'' + g x' + k y = 0: with z = x + i y,
 * s = i (+-g + sqrt(g^2 + 4 k)) / 2, undamped. k = 6, g = 1: 2 and 3.
 */
static void a_gyroscopic_pair_splits_and_is_not_damped(void **state)
{
    double K[] = {6.0, 0.0, 0.0, 6.0};
    double M[] = {1.0, 0.0, 0.0, 1.0};
    double D[] = {0.0, 1.0, -1.0, 0.0};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, D, NULL, "");

    (void)state;
    assert_int_equal(s.count, 2);
    assert_pole(s.s[0], 0.0, 2.0, 30.0 * eps);
    assert_pole(s.s[1], 0.0, 3.0, 30.0 * eps);
}

/*
 * A Maxwell element: mass 1 on a spring 1, and over a damper 1 and a spring 2,
 * between which there is no mass: (s^2 + 1)(2 + s) + 2 s = (s + 1)(s^2 + s +
 * 2).
 */
static void a_damper_between_massless_points_creeps(void **state)
{
    double K[] = {1.0, 0.0, 0.0, 2.0};
    double M[] = {1.0, 0.0, 0.0, 0.0};
    double D[] = {1.0, -1.0, -1.0, 1.0};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, D, NULL, "");

    (void)state;
    assert_int_equal(s.count, 2);
    assert_pole(s.s[0], -1.0, 0.0, 30.0 * eps);
    assert_pole(s.s[1], -0.5, sqrt(7.0) / 2.0, 30.0 * eps);
    /* x of the first: (s^2 + s + 1) x = s y, so y = -x */
    assert_near(ritz_dense_col(&s.re, 0)[0], -ritz_dense_col(&s.re, 0)[1],
                30.0 * eps);
}

/* Without the damper the massless point is held by its spring, and still. */
static void massless_points_that_nothing_damps_have_no_pole(void **state)
{
    double K[] = {3.0, -2.0, -2.0, 4.0}; /* condensed: 3 - 4 / 4 = 2 */
    double M[] = {1.0, 0.0, 0.0, 0.0};
    double D[] = {0.5, 0.0, 0.0, 0.0};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, D, NULL, "");

    (void)state;
    assert_int_equal(s.count, 1);
    assert_pole(s.s[0], -0.25, sqrt(2.0 - 0.0625), 20.0 * eps);
}

/* Masses 1 and 1, k = 8 between them: w = 4; a damper 2 between, or 2 to
 * ground at each, under which the body creeps at s = -2. */
static void rigid_motion_is_counted_and_creeps_where_it_is_damped(void **state)
{
    double K[] = {8.0, -8.0, -8.0, 8.0};
    double M[] = {1.0, 0.0, 0.0, 1.0};
    double inside[] = {2.0, -2.0, -2.0, 2.0};
    double outside[] = {2.0, 0.0, 0.0, 2.0};
    double one[] = {2.0, 0.0, 0.0, 0.0};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, inside, NULL, "");

    (void)state;
    assert_int_equal(s.num_zero, 2);
    assert_int_equal(s.count, 1);
    assert_pole(s.s[0], -2.0, sqrt(12.0), 40.0 * eps);
    ritz_spectrum_free(&s);
    s = poles_of(2, K, M, outside, NULL, "");
    assert_int_equal(s.num_zero, 1);
    assert_int_equal(s.count, 2);
    assert_pole(s.s[0], -2.0, 0.0, 40.0 * eps);
    assert_pole(s.s[1], -1.0, sqrt(15.0), 40.0 * eps);
    ritz_spectrum_free(&s);
    /* s^3 + 2 s^2 + 16 s + 16 = 0 at -1.0663536698618 (bisection) */
    s = poles_of(2, K, M, one, NULL, "");
    assert_int_equal(s.num_zero, 1);
    assert_pole(s.s[0], -1.0663536698618, 0.0, 1e-12);
}

static void what_grows_has_a_negative_ratio(void **state)
{
    double K[] = {-4.0, 0.0, 0.0, 9.0};
    double M[] = {1.0, 0.0, 0.0, 1.0};
    double D[] = {0.0, 0.0, 0.0, -0.6};
    RITZ_OWN(ritz_spectrum) s = poles_of(2, K, M, D, NULL, "");

    (void)state;
    assert_int_equal(s.count, 3);
    assert_near(fabs(creal(s.s[0])), 2.0, 10.0 * eps);
    assert_near(creal(s.s[0]) + creal(s.s[1]), 0.0, 10.0 * eps);
    assert_near(ritz_spectrum_ratio(s.s[2]), -0.1, 10.0 * eps);
}

static void what_cannot_be_answered_is_refused_in_words(void **state)
{
    double K[] = {1.0, 0.0, 0.0, 2.0};
    double M[] = {1.0, 0.0, 0.0, 0.0};
    double D[] = {0.0, 1.0, -1.0, 0.0};
    const ritz_dense A[] = {{2, 2, K}, {2, 2, M}, {2, 2, D}};
    const ritz_second_order skew = {&A[0], &A[1], &A[2], NULL, NULL};
    const ritz_second_order loss = {&A[0], &A[1], NULL, &A[0], NULL};
    ritz_spectrum s = {0};

    (void)state;
    assert_fails(ritz_spectrum_of(ritz_model_of_dense(&skew, NULL), NULL, &s),
                 RITZ_ERR_ARGUMENT,
                 "are its gyroscopic terms at massless dofs?");
    assert_fails(ritz_spectrum_of(ritz_model_of_dense(&loss, NULL), NULL, &s),
                 RITZ_ERR_ARGUMENT,
                 "there are motions without mass beside structural damping");
    K[3] = 0.0;
    assert_fails(ritz_spectrum_of(ritz_model_of_dense(&skew, NULL), NULL, &s),
                 RITZ_ERR_SINGULAR,
                 "neither is the stiffness of the motions without mass");
}

/* A row of the table of the damper chain: rad/s and percent. */
typedef struct published {
    int64_t pole; /* among those that oscillate, 0 the first */
    double full[2], ritz[2], truncated[2];
} published;

/* Half a unit of the last digit: six decimals (five above 10), five. */
static const published table[] = {
    {0, {1.649553, 1.24409}, {1.649553, 1.24408}, {1.648109, 1.04182}},
    {1, {5.007665, 2.38032}, {5.007663, 2.38033}, {4.960024, 2.44723}},
    {2, {8.389993, 2.09051}, {8.389981, 2.09076}, {8.264060, 3.03347}},
    {3, {11.95587, 3.46340}, {11.95581, 3.46761}, {11.53278, 6.73235}},
};

enum { ROWS = sizeof table / sizeof *table };

static void assert_row(const ritz_spectrum *s, int64_t pole,
                       const double expected[2])
{
    int64_t j = -1;

    for (int64_t seen = 0; seen <= pole; seen++)
        do
            j++;
        while (!(cimag(s->s[j]) > 0.0));
    assert_near(cabs(s->s[j]), expected[0],
                expected[0] > 10.0 ? 5.1e-6 : 5.1e-7);
    assert_near(100.0 * ritz_spectrum_ratio(s->s[j]), expected[1], 5.1e-6);
}

static ritz_reduced reduce_chain(const ritz_component *chain,
                                 const ritz_method *method, int64_t modes,
                                 int loads)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_reduced reduced = {0};

    request.component = chain;
    request.modes = modes;
    request.choice.loads = loads;
    request.choice.given = RITZ_USES_LOADS;
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_ok(ritz_reduce(chain, &basis, &reduced));
    assert_int_equal(reduced.K.ncol, 11);
    return reduced;
}

/* 11 modes alone, without attachment modes. */
static ritz_reduced truncate(const ritz_component *chain)
{
    return reduce_chain(chain, &ritz_method_macneal_rubin, 11,
                        RITZ_LOADS_ATTACHED);
}

static ritz_reduced with_ritz_vectors(const ritz_component *chain)
{
    return reduce_chain(chain, &ritz_method_normal_modes, 8,
                        RITZ_LOADS_DAMPERS);
}

static ritz_second_order view(const ritz_reduced *r)
{
    return (ritz_second_order){&r->K, &r->M, &r->D, &r->K4, &r->io};
}

static void the_chain_has_its_published_poles(void **state)
{
    const ritz_span twenty = {.modes = 20};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_reduced small[2];
    ritz_spectrum s[3] = {{0}};

    (void)state;
    assert_ok(chain_component(30, &chain));
    small[0] = with_ritz_vectors(&chain);
    small[1] = truncate(&chain);
    assert_ok(ritz_component_install(&chain));
    assert_ok(ritz_spectrum_of(ritz_model_of_component(&chain, NULL), &twenty,
                               &s[0]));
    assert_int_equal(s[0].count, 20);
    for (int k = 0; k < 2; k++) {
        ritz_second_order model = view(&small[k]);

        assert_ok(ritz_reduced_install(&small[k]));
        assert_ok(ritz_spectrum_of(ritz_model_of_dense(&model, NULL), NULL,
                                   &s[1 + k]));
    }
    for (int k = 0; k < ROWS; k++) {
        assert_row(&s[0], table[k].pole, table[k].full);
        assert_row(&s[1], table[k].pole, table[k].ritz);
        assert_row(&s[2], table[k].pole, table[k].truncated);
    }
    for (int k = 0; k < 3; k++)
        ritz_spectrum_free(&s[k]);
    ritz_reduced_free(&small[0]);
    ritz_reduced_free(&small[1]);
}

/* The published optima are multiples of 10: the best of each scan is better than
   its two neighbours on either side. The optimum of the truncated model is four
   times too high. */
static void scans_find_the_published_optima(void **state)
{
    static const int64_t all[] = {0, 1, 2};
    static const double best[2][3] = {{810, 810, 3270}, {260, 260, 970}};
    static const double zeta[3] = {2.793, 2.793, 10.11}; /* of mode 2, % */
    RITZ_OWN(ritz_component) chain = {0};
    ritz_reduced small[2];

    (void)state;
    assert_ok(chain_component(30, &chain));
    small[0] = with_ritz_vectors(&chain);
    small[1] = truncate(&chain);
    assert_ok(ritz_component_install(&chain));
    for (int k = 0; k < 2; k++)
        assert_ok(ritz_reduced_install(&small[k]));
    for (int64_t mode = 0; mode < 2; mode++)
        for (int k = 0; k < 3; k++) {
            double c = best[mode][k];
            const ritz_scan_axis axis = {3,        all,      false,
                                         c - 20.0, c + 20.0, 10.0};
            const ritz_scan_request request = {1, &axis, mode};
            RITZ_OWN(ritz_scan) scan = {0};

            assert_ok(
                k == 0
                    ? ritz_scan_of(ritz_model_of_component(&chain, NULL),
                                   &request, &scan)
                    : ritz_scan_of(ritz_model_of_reduced(&small[k - 1], NULL),
                                   &request, &scan));
            assert_int_equal(scan.count, 5);
            assert_near(scan.value[scan.best], c, 0.0);
            if (mode == 1)
                assert_near(100.0 * ritz_spectrum_ratio(scan.s[scan.best]),
                            zeta[k], k < 2 ? 5.1e-4 : 5.1e-3);
        }
    ritz_reduced_free(&small[0]);
    ritz_reduced_free(&small[1]);
}

/* From c = 0 to 150 three real poles come below mode 4, which is then the
 * seventh. */
static void a_mode_is_followed_past_poles_that_come_between(void **state)
{
    static const int64_t all[] = {0, 1, 2};
    const ritz_scan_axis axis = {3, all, false, 0.0, 150.0, 10.0};
    const ritz_scan_request request = {1, &axis, 3};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_scan) scan = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    assert_ok(ritz_component_install(&chain));
    assert_ok(
        ritz_scan_of(ritz_model_of_component(&chain, NULL), &request, &scan));
    assert_int_equal(scan.count, 16);
    assert_near(cabs(scan.s[15]), table[3].full[0], 5.1e-6);
    assert_near(100.0 * ritz_spectrum_ratio(scan.s[15]), table[3].full[1],
                5.1e-6);
    assert_near(creal(scan.s[0]), 0.0, 1e-13); /* undamped to begin with */
}

static void bad_scans_are_refused_in_words(void **state)
{
    static const int64_t all[] = {0, 1, 2};
    const struct {
        ritz_scan_axis axis;
        int64_t mode;
        const char *words;
    } cases[] = {
        {{3, all, false, 10.0, 10.0, 1.0},
         0,
         "a scan from 10 to 10 in steps of 1"},
        {{3, all, false, -1.0, 10.0, 1.0}, 0, "a scan from -1 to 10"},
        {{3, all, false, 0.0, 10.0, 0.0}, 0, "in steps of 0 has no range"},
        {{3, all, false, 0.0, 1e9, 1.0},
         0,
         "1000000000 steps of a scan are too many"},
        {{3, all, true, 10.0, -10.0, 1.0}, 0, "a scan from 10 to -10"},
        {{3, all, true, -HUGE_VAL, 10.0, 1.0}, 0, "a scan from -inf to 10"},
        {{3, all, false, 0.0, 10.0, 1.0}, 30, "there is no mode 31, 30 poles"},
    };
    const ritz_scan_axis wide = {1, all, true, 0.0, 1e3, 1.0};
    const ritz_scan_axis axes[] = {wide, {1, all, false, 0.0, 1e3, 1.0}, wide};
    const ritz_scan_request many[] = {{2, axes, 0}, {3, axes, 0}, {0, axes, 0}};
    static const char *const says[] = {
        "1002001 points of a scan are too many",
        "k of damper 'a' is scanned twice",
        "a scan has no values to go through",
    };
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(chain_component(30, &chain));
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const ritz_scan_request request = {1, &cases[k].axis, cases[k].mode};
        ritz_scan scan = {0};

        assert_fails(ritz_scan_of(ritz_model_of_component(&chain, NULL),
                                  &request, &scan),
                     RITZ_ERR_ARGUMENT, cases[k].words);
    }
    for (size_t k = 0; k < sizeof many / sizeof *many; k++) {
        ritz_scan scan = {0};

        assert_fails(ritz_scan_of(ritz_model_of_component(&chain, NULL),
                                  &many[k], &scan),
                     RITZ_ERR_ARGUMENT, says[k]);
    }
}

/* At each point of a grid over k and c, the pole is one of the model with these
   values. */
static void a_grid_of_c_and_k_follows_its_mode_to_every_point(void **state)
{
    static const int64_t all[] = {0, 1, 2};
    const ritz_scan_axis axes[] = {{2, all, true, -800.0, 0.0, 100.0},
                                   {1, all + 2, false, 0.0, 400.0, 50.0}};
    const ritz_scan_request request = {2, axes, 1};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_scan) scan = {0};
    double most = 0.0;

    (void)state;
    assert_ok(chain_component(20, &chain));
    assert_ok(
        ritz_scan_of(ritz_model_of_component(&chain, NULL), &request, &scan));
    assert_int_equal(scan.num_axes, 2);
    assert_int_equal(scan.size[0], 9);
    assert_int_equal(scan.size[1], 9);
    assert_int_equal(scan.count, 81);
    for (int64_t k = 0; k < scan.count; k += 8) {
        RITZ_OWN(ritz_component) one = {0};
        RITZ_OWN(ritz_spectrum) s = {0};
        const ritz_span ten = {.modes = 10};
        double least = HUGE_VAL;
        int64_t slow = k / 9, fast = k % 9;

        assert_near(scan.value[2 * k], -800.0 + 100.0 * (double)slow, 0.0);
        assert_near(scan.value[2 * k + 1], 50.0 * (double)fast, 0.0);
        assert_ok(chain_component(20, &one));
        one.dampers.k[0] = one.dampers.k[1] = scan.value[2 * k];
        one.dampers.c[2] = scan.value[2 * k + 1];
        assert_ok(ritz_component_install(&one));
        assert_ok(
            ritz_spectrum_of(ritz_model_of_component(&one, NULL), &ten, &s));
        for (int64_t j = 0; j < s.count; j++)
            least = fmin(least, cabs(s.s[j] - scan.s[k]));
        /* the largest |s| is 70 rad/s, and eps of it 1.6e-14 */
        assert_near(least, 0.0, 1e-11);
    }
    for (int64_t k = 0; k < scan.count; k++)
        most = fmax(most, ritz_spectrum_ratio(scan.s[k]));
    assert_near(ritz_spectrum_ratio(scan.s[scan.best]), most, 0.0);
}

/* The same poles from 28 modes, static answers and inverse iteration as from
 * all 120 eigenvalues, held to their own rounding. */
static void a_large_component_has_the_poles_of_its_dense_matrices(void **state)
{
    const ritz_span ten = {.modes = 10};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_dense A[3] = {{0}};
    const ritz_second_order model = {&A[0], &A[1], &A[2], NULL, NULL};
    RITZ_OWN(ritz_spectrum) whole = {0}, part = {0};

    (void)state;
    assert_ok(chain_component(60, &chain));
    assert_ok(ritz_component_install(&chain));
    assert_ok(ritz_sparse_dense(&chain.K, &A[0]));
    assert_ok(ritz_sparse_dense(&chain.M, &A[1]));
    assert_ok(ritz_sparse_dense(&chain.D, &A[2]));
    assert_ok(
        ritz_spectrum_of(ritz_model_of_dense(&model, NULL), NULL, &whole));
    assert_ok(ritz_spectrum_large(&chain, NULL, &ten, &part));
    assert_int_equal(part.count, 10);
    for (int64_t j = 0; j < part.count; j++) {
        /* n eps |A| of the dense one, its largest |s| being 90 */
        assert_near(cabs(part.s[j] - whole.s[j]), 0.0, 60 * eps * 90.0);
        assert_near(part.residual[j], 0.0, 1e-10); /* measured: 1e-12 */
    }
    for (int k = 0; k < 3; k++)
        ritz_dense_free(&A[k]);
}

/* Without D the pole of ratio zeta is known from the undamped frequency; of
 * Rayleigh damping too; and a free body has two poles at 0. */
static void a_large_component_heeds_given_damping(void **state)
{
    const ritz_span few = {.modes = 4};
    ritz_damping modal = {0}, rayleigh = {0};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_spectrum) s = {0};

    (void)state;
    assert_ok(ritz_damping_parse("modes 0.01 0.02 0.03", &modal));
    assert_ok(ritz_damping_parse("rayleigh 0.001 0.02", &rayleigh));
    assert_ok(chain_component(60, &chain));
    chain_free(&chain);
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &few, &pairs));
    assert_ok(ritz_spectrum_large(&chain, &modal, &few, &s));
    assert_int_equal(s.num_zero, 2);
    for (int64_t j = 0; j < 4; j++) {
        double w = sqrt(pairs.lambda[1 + j]);

        /* both solvers err by eps 1e4 / w in w */
        assert_near(cabs(s.s[j]), w, 1e-10);
        assert_near(ritz_spectrum_ratio(s.s[j]),
                    0.01 * (double)(j < 2 ? j + 1 : 3), 1e-10);
    }
    ritz_spectrum_free(&s);
    assert_ok(ritz_spectrum_large(&chain, &rayleigh, &few, &s));
    assert_int_equal(s.num_zero, 1);
    for (int64_t j = 1; j < 4; j++) /* the first is the body's own, -0.001 */
        assert_near(-2.0 * creal(s.s[j]), 0.001 + 0.02 * pairs.lambda[j],
                    1e-10);
    assert_pole(s.s[0], -0.001, 0.0, 1e-10);
}

static ritz_status scan_all(const ritz_component *chain)
{
    static const int64_t one[] = {1};
    const ritz_scan_axis axes[] = {{1, one, false, 0.0, 20.0, 10.0},
                                   {1, one, true, -20.0, 0.0, 20.0}};
    const ritz_scan_request request = {2, axes, 0};
    const ritz_span two = {.modes = 2};
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_scan) scan = {0};
    RITZ_OWN(ritz_spectrum) s = {0};

    RITZ_TRY(
        ritz_scan_of(ritz_model_of_component(chain, NULL), &request, &scan));
    RITZ_TRY(ritz_spectrum_of(ritz_model_of_component(chain, NULL), &two, &s));
done:
    return status;
}

static ritz_status spectrum_of_everything(void)
{
    double K[] = {3.0, -1.0, 0.0, -1.0, 3.0, 0.0, 0.0, 0.0, 2.0};
    double M[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
    double D[] = {1.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0};
    double K4[] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    double full[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const ritz_dense A[] = {
        {3, 3, K}, {3, 3, M}, {3, 3, D}, {3, 3, K4}, {3, 3, full}};
    const ritz_second_order real = {&A[0], &A[1], &A[2], NULL, NULL};
    const ritz_second_order complex_ = {&A[0], &A[4], &A[2], &A[3], NULL};
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_spectrum) s = {0};

    RITZ_TRY(ritz_spectrum_of(ritz_model_of_dense(&real, NULL), NULL, &s));
    ritz_spectrum_free(&s);
    RITZ_TRY(ritz_spectrum_of(ritz_model_of_dense(&complex_, NULL), NULL, &s));
done:
    return status;
}

static void no_allocation_is_forgotten(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_component_install(&chain));
    assert_survives_every_allocation(spectrum_of_everything());
    assert_survives_every_allocation(scan_all(&chain));
}

static ritz_status large_of(const ritz_component *chain)
{
    const ritz_span two = {.modes = 2};
    RITZ_OWN(ritz_spectrum) s = {0};
    ritz_status status = ritz_spectrum_large(chain, NULL, &two, &s);

    return status;
}

static void no_allocation_of_a_large_one_is_forgotten(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    assert_ok(chain_component(20, &chain));
    assert_ok(ritz_component_install(&chain));
    assert_survives_every_allocation(large_of(&chain));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_mass_swings_creeps_or_does_neither),
    cmocka_unit_test(ratios_and_rayleigh_act_on_the_modes),
    cmocka_unit_test(structural_damping_is_a_complex_stiffness),
    cmocka_unit_test(a_gyroscopic_pair_splits_and_is_not_damped),
    cmocka_unit_test(a_damper_between_massless_points_creeps),
    cmocka_unit_test(massless_points_that_nothing_damps_have_no_pole),
    cmocka_unit_test(rigid_motion_is_counted_and_creeps_where_it_is_damped),
    cmocka_unit_test(what_grows_has_a_negative_ratio),
    cmocka_unit_test(what_cannot_be_answered_is_refused_in_words),
    cmocka_unit_test(the_chain_has_its_published_poles),
    cmocka_unit_test(scans_find_the_published_optima),
    cmocka_unit_test(a_mode_is_followed_past_poles_that_come_between),
    cmocka_unit_test(a_grid_of_c_and_k_follows_its_mode_to_every_point),
    cmocka_unit_test(bad_scans_are_refused_in_words),
    cmocka_unit_test(a_large_component_has_the_poles_of_its_dense_matrices),
    cmocka_unit_test(a_large_component_heeds_given_damping),
    cmocka_unit_test(no_allocation_is_forgotten),
    cmocka_unit_test(no_allocation_of_a_large_one_is_forgotten),
};

TEST_MODULE(spectrum, tests, NULL, NULL)
