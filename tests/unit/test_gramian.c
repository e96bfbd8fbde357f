#include "testing.h"

#include <ritz/ranking.h>

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
    ritz_status status = RITZ_OK;
    uint64_t seed = 7;

    out->count = modes;
    RITZ_NEW(out->omega, modes);
    RITZ_NEW(out->zeta, modes);
    RITZ_TRY(ritz_dense_new(modes, INPUTS, &out->B));
    RITZ_TRY(ritz_dense_new(OUTPUTS, modes, &out->C));
    RITZ_TRY(ritz_dense_new(OUTPUTS, modes, &out->Cv));
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
done:
    return status;
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
            ritz_modal modal = {0};
            ritz_dense Wc = {0};
            ritz_dense Wo = {0};
            double worst[2];

            assert_ok(modal_model(MODES, zeta[z], gap[g], &modal));
            assert_ok(ritz_modal_gramians(&modal, &Wc, &Wo));
            residuals(&modal, &Wc, &Wo, worst);
            assert_near(worst[0], 0.0,
                        2.0 * STATES * 2.2e-16 * 400.0 * largest(&Wc));
            assert_near(worst[1], 0.0,
                        2.0 * STATES * 2.2e-16 * 400.0 * largest(&Wo));
            ritz_dense_free(&Wc);
            ritz_dense_free(&Wo);
            ritz_modal_free(&modal);
        }
}

/* |H|_2^2 = trace(C Wc C') = trace(B'Wo B). */
static void both_gramians_give_one_h2_norm(void **unused)
{
    ritz_modal modal = {0};
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};
    double by_c = 0.0;
    double by_o = 0.0;

    (void)unused;
    assert_ok(modal_model(MODES, 0.05, 1.0, &modal));
    assert_ok(ritz_modal_gramians(&modal, &Wc, &Wo));
    for (int64_t i = 0; i < STATES; i++)
        for (int64_t j = 0; j < STATES; j++) {
            by_c += seen(&modal, i, j) * entry(&Wc, i, j);
            by_o += driven(&modal, i, j) * entry(&Wo, i, j);
        }
    /* STATES^2 terms of either sign, cancelling by less than 100 */
    assert_near(by_c, by_o, 100.0 * STATES * 2.2e-16 * by_o);
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    ritz_modal_free(&modal);
}

/* One mode: Wc = b b' / (4 zeta w) diag(1/w^2, 1). */
static void one_mode_has_the_textbook_gramian(void **unused)
{
    ritz_modal modal = {0};
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};
    double beta = 0.0;

    (void)unused;
    assert_ok(modal_model(1, 0.02, 1.0, &modal));
    modal.omega[0] = 3.0;
    modal.zeta[0] = 0.02;
    beta = driven(&modal, 1, 1);
    assert_ok(ritz_modal_gramians(&modal, &Wc, &Wo));
    assert_near(Wc.val[0], beta / (4 * 0.02 * 27.0), 4e-16 * Wc.val[0]);
    assert_near(Wc.val[3], beta / (4 * 0.02 * 3.0), 4e-16 * Wc.val[3]);
    assert_near(Wc.val[1], 0.0, 0.0);
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    ritz_modal_free(&modal);
}

static void a_mode_without_damping_has_no_gramian(void **unused)
{
    ritz_modal modal = {0};
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};

    (void)unused;
    assert_ok(modal_model(2, 0.02, 1.0, &modal));
    modal.zeta[1] = 0.0;
    assert_fails(ritz_modal_gramians(&modal, &Wc, &Wo), RITZ_ERR_ARGUMENT,
                 "without damping");
    ritz_modal_free(&modal);
}

static ritz_status gramians_once(const ritz_modal *modal)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0};
    ritz_dense Wo = {0};
    double sigma[STATES];

    RITZ_TRY(ritz_modal_gramians(modal, &Wc, &Wo));
    RITZ_TRY(ritz_modal_hankel(modal, sigma));
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    return status;
}

static void gramians_survive_every_allocation(void **unused)
{
    ritz_modal modal = {0};

    (void)unused;
    assert_ok(modal_model(MODES, 0.02, 1.0, &modal));
    assert_survives_every_allocation(gramians_once(&modal));
    ritz_modal_free(&modal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gramians_satisfy_their_lyapunov_equations),
        cmocka_unit_test(both_gramians_give_one_h2_norm),
        cmocka_unit_test(one_mode_has_the_textbook_gramian),
        cmocka_unit_test(a_mode_without_damping_has_no_gramian),
        cmocka_unit_test(gramians_survive_every_allocation),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
