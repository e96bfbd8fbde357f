#include "gramians/modes.h"
#include "testing.h"

#include <ritz/model.h>

#include <complex.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MODES = 5, INPUTS = 2, OUTPUTS = 3, STATES = 2 * MODES };

static const double two_pi = 6.28318530717958647692;

/* A fixed sequence of numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

/* Two of one frequency; ratios are `zeta` times 1, 1, 2, 0.5, 1.5. */
static void set_model(double zeta, ritz_modal *out)
{
    static const double omega[MODES] = {1.0, 1.0, 1.3, 2.0, 5.0};
    static const double share[MODES] = {1.0, 1.0, 2.0, 0.5, 1.5};
    ritz_modal modal = {.count = MODES};
    uint64_t seed = 11;

    assert_non_null(modal.omega = calloc(MODES, sizeof *modal.omega));
    assert_non_null(modal.zeta = calloc(MODES, sizeof *modal.zeta));
    assert_ok(ritz_dense_new(MODES, INPUTS, &modal.B));
    assert_ok(ritz_dense_new(OUTPUTS, MODES, &modal.C));
    assert_ok(ritz_dense_new(OUTPUTS, MODES, &modal.Cv));
    for (int k = 0; k < MODES; k++) {
        modal.omega[k] = omega[k];
        modal.zeta[k] = zeta * share[k];
    }
    for (int k = 0; k < MODES * INPUTS; k++)
        modal.B.val[k] = noise(&seed);
    for (int k = 0; k < MODES * OUTPUTS; k++) {
        modal.C.val[k] = noise(&seed);
        modal.Cv.val[k] = noise(&seed);
    }
    *out = modal;
}

static double entry(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* Row k of (i w - A)^-1 B, or column k of C (i w - A)^-1, times entry p. */
static double complex state_at(const ritz_modal *modal, bool seen, int64_t k,
                               int64_t p, double w)
{
    double wk = modal->omega[k / 2];
    double d = 2.0 * modal->zeta[k / 2] * wk;
    double complex s = w * (double complex)I;
    double complex den = s * s + d * s + wk * wk;
    double c = 0.0, cv = 0.0;

    if (!seen)
        return entry(&modal->B, k / 2, p) * (k % 2 ? s : 1.0) / den;
    c = entry(&modal->C, p, k / 2);
    cv = entry(&modal->Cv, p, k / 2);
    return (k % 2 ? c + cv * s : c * (s + d) - cv * wk * wk) / den;
}

/* What an entry of a Gramian is the integral of. */
typedef struct integrand {
    const ritz_modal *modal;
    bool seen;
    int64_t i, j;
} integrand;

static double value(const integrand *f, double w)
{
    int64_t count = f->seen ? OUTPUTS : INPUTS;
    double sum = 0.0;

    for (int64_t p = 0; p < count; p++)
        sum += creal(state_at(f->modal, f->seen, f->i, p, w) *
                     conj(state_at(f->modal, f->seen, f->j, p, w)));
    return 2.0 * sum / two_pi;
}

/* Five points of Gauss, exact to degree 9. */
static double gauss(const integrand *f, double a, double b)
{
    static const double x[] = {0.0, 0.53846931010568309, 0.90617984593866399};
    static const double weight[] = {0.56888888888888889, 0.47862867049936647,
                                    0.23692688505618909};
    double middle = (a + b) / 2.0, half = (b - a) / 2.0;
    double sum = weight[0] * value(f, middle);

    for (int k = 1; k < 3; k++)
        sum += weight[k] * (value(f, middle - half * x[k]) +
                            value(f, middle + half * x[k]));
    return half * sum;
}

/* By steps so short that both halves of one agree with the whole. */
static double integral(const integrand *f, double from, double to, double bound)
{
    double at = from, step = to - from;
    double sum = 0.0;

    while (at < to) {
        double end = fmin(at + step, to);
        double middle = (at + end) / 2.0;
        double halves = gauss(f, at, middle) + gauss(f, middle, end);

        if (fabs(halves - gauss(f, at, end)) > bound && step > 1e-9 * to) {
            step /= 2.0;
            continue;
        }
        sum += halves;
        at = end;
        step *= 2.0;
    }
    return sum;
}

static double size(const ritz_dense *W, int64_t i, int64_t j)
{
    return sqrt(fabs(entry(W, i, i) * entry(W, j, j)));
}

/*
 * Lightly, critically and overdamped, in and beside resonances. An integral is
 * of at most a few hundred pieces, each right to 1e-13 of the entry's size.
 */
static void band_gramians_are_integrals_over_frequency(void **unused)
{
    static const double zeta[] = {0.002, 0.05, 0.5, 1.0, 3.0};
    static const double band[][2] = {{0.0, 0.1}, {0.15, 0.33}, {0.5, 0.52}};

    (void)unused;
    for (int t = 0; t < 15; t++) {
        const double *hz = band[t % 3];
        RITZ_OWN(ritz_modal) modal = {0};
        ritz_dense W[2] = {{0}, {0}};

        set_model(zeta[t / 3], &modal);
        assert_ok(ritz_modal_gramians(&modal, hz, &W[0], &W[1]));
        for (int k = 0; k < 2 * STATES * STATES; k++) {
            const integrand f = {&modal, k % 2, k / 2 / STATES, k / 2 % STATES};
            double scale = size(&W[k % 2], f.i, f.j);

            assert_near(
                entry(&W[k % 2], f.i, f.j),
                integral(&f, two_pi * hz[0], two_pi * hz[1], 1e-13 * scale),
                1e-10 * scale);
        }
        ritz_dense_free(&W[0]);
        ritz_dense_free(&W[1]);
    }
}

/* Gramians of neighbouring bands add up, and all of them are the full one. */
static void bands_add_up_to_the_whole(void **unused)
{
    static const double edge[] = {0.0, 0.12, 0.159, 0.16, 0.9, HUGE_VAL};
    static const double zeta[] = {1e-4, 0.02, 1.0, 4.0};

    (void)unused;
    for (int z = 0; z < 4; z++) {
        RITZ_OWN(ritz_modal) modal = {0};
        ritz_dense full[2] = {{0}, {0}}, once[2] = {{0}, {0}};
        double sum[2][STATES * STATES] = {{0}};

        set_model(zeta[z], &modal);
        assert_ok(ritz_modal_gramians(&modal, NULL, &full[0], &full[1]));
        assert_ok(ritz_modal_gramians(&modal, (double[]){0.0, HUGE_VAL},
                                      &once[0], &once[1]));
        for (int e = 0; e < 5; e++) {
            ritz_dense W[2] = {{0}, {0}};

            assert_ok(ritz_modal_gramians(&modal, &edge[e], &W[0], &W[1]));
            for (int k = 0; k < 2 * STATES * STATES; k++)
                sum[k % 2][k / 2] += W[k % 2].val[k / 2];
            ritz_dense_free(&W[0]);
            ritz_dense_free(&W[1]);
        }
        for (int k = 0; k < 2 * STATES * STATES; k++) {
            const ritz_dense *W = &full[k % 2];
            double scale = size(W, k / 2 % STATES, k / 2 / STATES);

            /* (W + W) / 2; and five sums of terms no larger */
            assert_near(once[k % 2].val[k / 2], W->val[k / 2], 1e-15 * scale);
            assert_near(sum[k % 2][k / 2], W->val[k / 2], 1e-14 * scale);
        }
        for (int k = 0; k < 2; k++) {
            ritz_dense_free(&full[k]);
            ritz_dense_free(&once[k]);
        }
    }
}

/* Z Z' = W but for what is dropped: STATES eps of a unit diagonal. */
static void factors_multiply_to_the_gramians(void **unused)
{
    static const double band[][2] = {{0.0, 0.1}, {0.15, 0.33}, {0.0, 10.0}};
    static const double zeta[] = {1e-3, 0.3, 2.0};

    (void)unused;
    for (int t = 0; t < 9; t++) {
        RITZ_OWN(ritz_modal) modal = {0};
        ritz_dense W[2] = {{0}, {0}}, Z[2] = {{0}, {0}};

        set_model(zeta[t / 3], &modal);
        assert_ok(ritz_modal_gramians(&modal, band[t % 3], &W[0], &W[1]));
        assert_ok(ritz_modal_factors(&modal, band[t % 3], &Z[0], &Z[1]));
        for (int k = 0; k < 2; k++) {
            RITZ_OWN(ritz_dense) ZZ = {0};

            assert_ok(ritz_dense_mul_nt(&Z[k], &Z[k], &ZZ));
            for (int e = 0; e < STATES * STATES; e++) /* measured: 3e-15 */
                assert_near(ZZ.val[e], W[k].val[e],
                            1e-13 * size(&W[k], e % STATES, e / STATES));
            ritz_dense_free(&W[k]);
            ritz_dense_free(&Z[k]);
        }
    }
}

static void
a_band_of_everything_has_the_hankel_values_of_everything(void **unused)
{
    static const double all[] = {0.0, HUGE_VAL};
    RITZ_OWN(ritz_modal) modal = {0};
    double sigma[STATES], band[STATES];

    (void)unused;
    set_model(0.02, &modal);
    assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
    assert_ok(ritz_modal_hankel(&modal, all, band));
    for (int k = 0; k < STATES; k++) /* of squares: eps / relative value */
        assert_near(band[k], sigma[k],
                    1e-14 * sigma[0] * (sigma[0] / sigma[k]));
}

/*
 * Of one mode with a displacement output, S = p I + g (A + d/2): both Gramians
 * are full diagonals times p +- g d/2, and sigma of the band in either
 * direction those of the whole times sqrt of products of these.
 */
static void a_band_around_one_mode_keeps_its_values(void **unused)
{
    double omega = two_pi, zeta = 1e-3, one = 1.0, none = 0.0;
    const ritz_modal modal = {
        1, &omega, &zeta, {1, 1, &one}, {1, 1, &one}, {1, 1, &none},
        0, {0},    {0}};
    double sigma[2], in[2], out[2];

    (void)unused;
    assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
    assert_ok(ritz_modal_hankel(&modal, (double[]){0.8, 1.2}, in));
    assert_ok(ritz_modal_hankel(&modal, (double[]){1.2, 3.0}, out));
    /* the half-power width is 0.002: atan(200) and so on of pi / 2 */
    assert_near(in[0], sigma[0], 1e-2 * sigma[0]);
    assert_true(in[0] < sigma[0]);
    assert_true(out[0] < 1e-2 * sigma[0] && out[1] > 0.0);
}

static void what_is_no_band_is_refused(void **unused)
{
    static const double wrong[][2] = {
        {2.0, 1.0}, {1.0, 1.0}, {-1.0, 1.0}, {HUGE_VAL, HUGE_VAL}};
    RITZ_OWN(ritz_modal) modal = {0};
    ritz_dense X = {0}, Y = {0};
    double sigma[STATES];

    (void)unused;
    set_model(0.02, &modal);
    for (int k = 0; k < 4; k++) {
        assert_fails(ritz_modal_gramians(&modal, wrong[k], &X, &Y),
                     RITZ_ERR_ARGUMENT, "a band is from 0 Hz or more");
        assert_fails(ritz_modal_hankel(&modal, wrong[k], sigma),
                     RITZ_ERR_ARGUMENT, "a band is from 0 Hz or more");
    }
    modal.zeta[3] = 0.0;
    assert_fails(ritz_modal_factors(&modal, (double[]){0.0, 1.0}, &X, &Y),
                 RITZ_ERR_ARGUMENT, "without damping");
}

/* Inputs that reach nothing, and no inputs at all. */
static void what_is_not_reached_has_no_values(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};
    double sigma[STATES];

    (void)unused;
    set_model(0.02, &modal);
    for (int k = 0; k < MODES * INPUTS; k++)
        modal.B.val[k] = 0.0;
    assert_ok(ritz_modal_hankel(&modal, (double[]){0.1, 1.0}, sigma));
    assert_near(sigma[0], 0.0, 0.0);
    modal.B.ncol = 0;
    assert_ok(ritz_modal_hankel(&modal, (double[]){0.1, 1.0}, sigma));
    assert_near(sigma[0], 0.0, 0.0);
}

static ritz_status once(const ritz_modal *modal)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};
    double sigma[STATES];

    RITZ_CHECK(ritz_modal_gramians(modal, (double[]){0.1, 1.0}, &X, &Y));
    RITZ_CHECK(ritz_modal_hankel(modal, (double[]){0.1, 1.0}, sigma));
    return RITZ_OK;
}

static void bands_survive_every_allocation(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};

    (void)unused;
    set_model(0.02, &modal);
    assert_survives_every_allocation(once(&modal));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(band_gramians_are_integrals_over_frequency),
    cmocka_unit_test(bands_add_up_to_the_whole),
    cmocka_unit_test(factors_multiply_to_the_gramians),
    cmocka_unit_test(a_band_of_everything_has_the_hankel_values_of_everything),
    cmocka_unit_test(a_band_around_one_mode_keeps_its_values),
    cmocka_unit_test(what_is_no_band_is_refused),
    cmocka_unit_test(what_is_not_reached_has_no_values),
    cmocka_unit_test(bands_survive_every_allocation),
};

TEST_MODULE(modal_band, tests, NULL, NULL)
