#include "testing.h"

#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/model.h>

#include <stdlib.h>

enum { MODES = 6, INPUTS = 2, OUTPUTS = 3, STATES = 2 * MODES };

/* A fixed sequence of numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

static ritz_status modal_model(int64_t modes, double zeta, double gap,
                               ritz_modal *out)
{
    uint64_t seed = 7;

    out->count = modes;
    RITZ_CHECK_NEW(out->omega, modes);
    RITZ_CHECK_NEW(out->zeta, modes);
    RITZ_CHECK(ritz_dense_new(modes, INPUTS, &out->B));
    RITZ_CHECK(ritz_dense_new(OUTPUTS, modes, &out->C));
    RITZ_CHECK(ritz_dense_new(OUTPUTS, modes, &out->Cv));
    for (int64_t k = 0; k < modes; k++) {
        out->omega[k] = 1.0 + gap * (double)k * (1.0 + 0.1 * noise(&seed));
        out->zeta[k] = zeta * (1.0 + 0.3 * noise(&seed));
    }
    for (int64_t k = 0; k < modes * INPUTS; k++)
        out->B.val[k] = noise(&seed);
    for (int64_t k = 0; k < modes * OUTPUTS; k++) {
        out->C.val[k] = noise(&seed);
        out->Cv.val[k] = noise(&seed);
    }
    return RITZ_OK;
}

/* A of x' = A x + B u, in (q_1, q_1', q_2, ...). */
static double state(const ritz_modal *modal, int64_t i, int64_t j)
{
    double w = modal->omega[i / 2];

    if (i / 2 != j / 2 || i == j - 1)
        return i == j - 1 && i % 2 == 0 ? 1.0 : 0.0;
    if (i % 2 == 0)
        return 0.0;
    return j % 2 == 0 ? -w * w : -2.0 * modal->zeta[i / 2] * w;
}

/* (C'C)(i, j), or (B B')(i, j), in the same states. */
static double seen(const ritz_modal *modal, int64_t i, int64_t j)
{
    const ritz_dense *const part[2] = {&modal->C, &modal->Cv};
    double sum = 0.0;

    for (int64_t k = 0; k < modal->C.nrow; k++)
        sum += ritz_dense_col(part[i % 2], i / 2)[k] *
               ritz_dense_col(part[j % 2], j / 2)[k];
    return sum;
}

static double driven(const ritz_modal *modal, int64_t i, int64_t j)
{
    double sum = 0.0;

    for (int64_t k = 0; i % 2 == 1 && j % 2 == 1 && k < modal->B.ncol; k++)
        sum += ritz_dense_col(&modal->B, k)[i / 2] *
               ritz_dense_col(&modal->B, k)[j / 2];
    return sum;
}

static double entry(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* Largest entry of A Wc + Wc A' + B B' and of A'Wo + Wo A + C'C. */
static void residuals(const ritz_modal *modal, const ritz_dense *Wc,
                      const ritz_dense *Wo, double worst[2])
{
    int64_t n = 2 * modal->count;

    worst[0] = 0.0;
    worst[1] = 0.0;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double c = driven(modal, i, j);
            double o = seen(modal, i, j);

            for (int64_t k = 0; k < n; k++) {
                c += state(modal, i, k) * entry(Wc, k, j) +
                     entry(Wc, i, k) * state(modal, j, k);
                o += state(modal, k, i) * entry(Wo, k, j) +
                     entry(Wo, i, k) * state(modal, k, j);
            }
            worst[0] = fmax(worst[0], fabs(c));
            worst[1] = fmax(worst[1], fabs(o));
        }
}

static double largest(const ritz_dense *A)
{
    double value = 0.0;

    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        value = fmax(value, fabs(A->val[k]));
    return value;
}

/*
 * Rounding of each sum of 2 n + 1 terms, none larger than |A| |W|; here w < 20
 * and |A| < 400.
 */
static void gramians_satisfy_their_lyapunov_equations(void **unused)
{
    static const double zeta[] = {0.3, 0.01, 1e-4};
    static const double gap[] = {3.0, 0.01, 0.0};

    (void)unused;
    for (int z = 0; z < 3; z++)
        for (int g = 0; g < 3; g++) {
            RITZ_OWN(ritz_modal) modal = {0};
            RITZ_OWN(ritz_dense) Wc = {0};
            RITZ_OWN(ritz_dense) Wo = {0};
            double worst[2];

            assert_ok(modal_model(MODES, zeta[z], gap[g], &modal));
            assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
            residuals(&modal, &Wc, &Wo, worst);
            assert_near(worst[0], 0.0,
                        2.0 * STATES * 2.2e-16 * 400.0 * largest(&Wc));
            assert_near(worst[1], 0.0,
                        2.0 * STATES * 2.2e-16 * 400.0 * largest(&Wo));
        }
}

/* |H|_2^2 = trace(C Wc C') = trace(B'Wo B). */
static void both_gramians_give_one_h2_norm(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_dense) Wc = {0};
    RITZ_OWN(ritz_dense) Wo = {0};
    double by_c = 0.0;
    double by_o = 0.0;

    (void)unused;
    assert_ok(modal_model(MODES, 0.05, 1.0, &modal));
    assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    for (int64_t i = 0; i < STATES; i++)
        for (int64_t j = 0; j < STATES; j++) {
            by_c += seen(&modal, i, j) * entry(&Wc, i, j);
            by_o += driven(&modal, i, j) * entry(&Wo, i, j);
        }
    /* STATES^2 terms of either sign, cancelling by less than 100 */
    assert_near(by_c, by_o, 100.0 * STATES * 2.2e-16 * by_o);
}

/* One mode: Wc = b b' / (4 zeta w) diag(1/w^2, 1). */
static void one_mode_has_the_textbook_gramian(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_dense) Wc = {0};
    RITZ_OWN(ritz_dense) Wo = {0};
    double beta = 0.0;

    (void)unused;
    assert_ok(modal_model(1, 0.02, 1.0, &modal));
    modal.omega[0] = 3.0;
    modal.zeta[0] = 0.02;
    beta = driven(&modal, 1, 1);
    assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    assert_near(Wc.val[0], beta / (4 * 0.02 * 27.0), 4e-16 * Wc.val[0]);
    assert_near(Wc.val[3], beta / (4 * 0.02 * 3.0), 4e-16 * Wc.val[3]);
    assert_near(Wc.val[1], 0.0, 0.0);
}

static void a_mode_without_damping_has_no_gramian(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};

    (void)unused;
    assert_ok(modal_model(2, 0.02, 1.0, &modal));
    modal.zeta[1] = 0.0;
    assert_fails(ritz_modal_gramians(&modal, NULL, &Wc, &Wo), RITZ_ERR_ARGUMENT,
                 "without damping");
}

/*
 * Z Z' = W, by eps of a unit diagonal a column; under-, over- and critically
 * damped, of one frequency too. The least damped ratio is 0.7 zeta.
 */
static void factors_multiply_to_the_gramians(void **unused)
{
    static const double zeta[] = {1e-4, 0.3, 0.95, 1.0, 3.0};
    static const double gap[] = {3.0, 0.01, 0.0};

    (void)unused;
    for (int t = 0; t < 15; t++) {
        RITZ_OWN(ritz_modal) modal = {0};
        ritz_dense W[2] = {{0}, {0}}, Z[2] = {{0}, {0}};

        assert_ok(modal_model(MODES, zeta[t / 3], gap[t % 3], &modal));
        modal.zeta[0] = t / 3 == 3 ? 1.0 : modal.zeta[0];
        assert_ok(ritz_modal_gramians(&modal, NULL, &W[0], &W[1]));
        assert_ok(ritz_modal_factors(&modal, NULL, &Z[0], &Z[1]));
        for (int k = 0; k < 2; k++) {
            RITZ_OWN(ritz_dense) ZZ = {0};

            assert_ok(ritz_dense_mul_nt(&Z[k], &Z[k], &ZZ));
            for (int e = 0; e < STATES * STATES; e++)
                assert_near(ZZ.val[e], W[k].val[e],
                            2.0 * STATES * 2.2e-16 *
                                sqrt(entry(&W[k], e % STATES, e % STATES) *
                                     entry(&W[k], e / STATES, e / STATES)));
            ritz_dense_free(&W[k]);
            ritz_dense_free(&Z[k]);
        }
    }
}

enum { MANY = 40 };

/* One input, and every position is an output. */
static void set_one_to_many(double zeta, ritz_modal *modal, ritz_dense *A,
                            ritz_dense *B, ritz_dense *Ct)
{
    assert_ok(modal_model(MANY, zeta, 0.5, modal));
    modal->B.ncol = 1;
    ritz_dense_free(&modal->C);
    ritz_dense_free(&modal->Cv);
    assert_ok(ritz_dense_new(MANY, MANY, &modal->C));
    assert_ok(ritz_dense_new(MANY, MANY, &modal->Cv));
    assert_ok(ritz_dense_new(2 * MANY, 2 * MANY, A));
    assert_ok(ritz_dense_new(2 * MANY, 1, B));
    assert_ok(ritz_dense_new(2 * MANY, MANY, Ct));
    for (int64_t j = 0; j < 2 * MANY; j++)
        for (int64_t i = 0; i < 2 * MANY; i++)
            ritz_dense_col(A, j)[i] = state(modal, i, j);
    for (int64_t k = 0; k < MANY; k++) {
        ritz_dense_col(&modal->C, k)[k] = 1.0;
        ritz_dense_col(Ct, k)[2 * k] = 1.0;
        B->val[2 * k + 1] = modal->B.val[k];
    }
}

/*
 * W_o has full rank and shows what W_c hardly holds: factors of Gramians that
 * were formed would be wrong by eps^1/2 of the largest value.
 */
static void small_values_are_those_of_hammarlings_factors(void **unused)
{
    static const double zeta[] = {1.0, 2.0};

    (void)unused;
    for (int t = 0; t < 2; t++) {
        RITZ_OWN(ritz_modal) modal = {0};
        RITZ_OWN(ritz_dense) A = {0}, At = {0}, B = {0}, Ct = {0};
        RITZ_OWN(ritz_dense) U = {0}, V = {0}, H = {0}, left = {0};
        double sigma[2 * MANY];
        double *due = NULL;

        set_one_to_many(zeta[t], &modal, &A, &B, &Ct);
        assert_ok(ritz_general_transpose(&A, &At));
        assert_ok(ritz_general_gramian(&A, &B, &U));
        assert_ok(ritz_general_gramian(&At, &Ct, &V));
        assert_ok(ritz_dense_mul_tn(&V, &U, &H));
        assert_ok(ritz_general_svd(&H, &left, &due, NULL));
        assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
        assert_true(due[3 * MANY / 4] < 1e-9 * due[0]);
        for (int k = 0; k < 2 * MANY; k++) /* measured: 2e-15 */
            assert_near(sigma[k], due[k], 1e-12 * due[0]);
        free(due);
    }
}

static ritz_status gramians_once(const ritz_modal *modal)
{
    RITZ_OWN(ritz_dense) Wc = {0};
    RITZ_OWN(ritz_dense) Wo = {0};
    double sigma[STATES];

    RITZ_CHECK(ritz_modal_gramians(modal, NULL, &Wc, &Wo));
    RITZ_CHECK(ritz_modal_hankel(modal, NULL, sigma));
    return RITZ_OK;
}

static void gramians_survive_every_allocation(void **unused)
{
    RITZ_OWN(ritz_modal) modal = {0};

    (void)unused;
    assert_ok(modal_model(MODES, 0.02, 1.0, &modal));
    assert_survives_every_allocation(gramians_once(&modal));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(gramians_satisfy_their_lyapunov_equations),
    cmocka_unit_test(both_gramians_give_one_h2_norm),
    cmocka_unit_test(one_mode_has_the_textbook_gramian),
    cmocka_unit_test(a_mode_without_damping_has_no_gramian),
    cmocka_unit_test(factors_multiply_to_the_gramians),
    cmocka_unit_test(small_values_are_those_of_hammarlings_factors),
    cmocka_unit_test(gramians_survive_every_allocation),
};

TEST_MODULE(gramian, tests, NULL, NULL)
