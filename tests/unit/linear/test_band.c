#include "linear/band.h"

#include "base/tolerances.h"
#include "linear/general.h"
#include "testing.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>

enum { N = 120, MOST_WIDTH = 16 };

/* A random band matrix, and its eigenvalues by LAPACK. */
typedef struct sample {
    ritz_band T;
    double val[N * (MOST_WIDTH + 1)];
    double theta[N]; /* ascending */
} sample;

/* Diagonal entries far above the others make the matrix positive definite; their
   sizes differ by up to six digits. */
static void open_sample(int64_t width, uint64_t seed, sample *s)
{
    double copy[N * (MOST_WIDTH + 1)];
    double unused[1];

    s->T = (ritz_band){N, width, s->val};
    for (int64_t j = 0; j < N; j++)
        for (int64_t i = 0; i <= width; i++) {
            const double size =
                pow(10.0, -6.0 * (double)(j + i < N ? j + i : 0) / N);

            s->val[j * (width + 1) + i] =
                size *
                (i == 0 ? 4.0 + (double)width : ritz_general_noise(&seed));
        }
    memcpy(copy, s->val, (size_t)(N * (width + 1)) * sizeof *copy);
    assert_int_equal(LAPACKE_dsbev(LAPACK_COL_MAJOR, 'N', 'L', N, (int)width,
                                   copy, (int)width + 1, s->theta, unused, 1),
                     0);
}

/* |T z - theta z| of z, of length one. */
static double residual_of(const sample *s, double theta, const double *z)
{
    const int64_t w = s->T.width;
    double y[N] = {0};
    double sum = 0.0;

    for (int64_t j = 0; j < N; j++)
        for (int64_t i = 0; i <= w && j + i < N; i++) {
            const double value = s->val[j * (w + 1) + i];

            y[j + i] += value * z[j];
            if (i > 0)
                y[j] += value * z[j + i];
        }
    for (int64_t j = 0; j < N; j++)
        sum = hypot(sum, y[j] - theta * z[j]);
    return sum;
}

/* An eigenvalue is known within RITZ_KTH_WITHIN of itself and some eps of the
   largest; so is the residual of its vector, twice over. */
static void single_pairs_agree_with_lapack(void **state)
{
    const int64_t width[] = {0, 1, 8, MOST_WIDTH};
    sample s;

    (void)state;
    for (size_t c = 0; c < 4; c++) {
        double rounding = 0.0;

        open_sample(width[c], 7 + c, &s);
        rounding = 100.0 * DBL_EPSILON * s.theta[N - 1];
        for (int64_t k = 1; k <= N; k++) {
            const double exact = s.theta[N - k];
            double theta = 1e-3 * s.theta[0];
            double z[N];
            bool exists = false;

            assert_ok(ritz_band_kth(&s.T, k, &theta, &exists));
            assert_true(exists);
            assert_near(theta, exact, RITZ_KTH_WITHIN * exact + rounding);
            assert_ok(ritz_band_vector(&s.T, theta, z));
            assert_true(residual_of(&s, theta, z) <=
                        2.0 * (RITZ_KTH_WITHIN * exact + rounding));
        }
    }
}

/* A lower bound that is the eigenvalue itself, or one above it. */
static void a_close_bound_is_enough_and_a_wrong_one_is_noticed(void **state)
{
    sample s;
    double theta = 0.0;
    bool exists = false;

    (void)state;
    open_sample(8, 3, &s);
    theta = s.theta[N - 20] * (1.0 - 1e-12);
    assert_ok(ritz_band_kth(&s.T, 20, &theta, &exists));
    assert_true(exists);
    assert_near(theta, s.theta[N - 20], RITZ_KTH_WITHIN * s.theta[N - 20]);
    theta = s.theta[N - 20] * (1.0 + 1e-9);
    assert_ok(ritz_band_kth(&s.T, 20, &theta, &exists));
    assert_false(exists);
    assert_true(theta == 0.0);
}

static ritz_status find_one(const sample *s)
{
    double theta = s->theta[0];
    double z[N];
    bool exists = false;

    RITZ_CHECK(ritz_band_kth(&s->T, 3, &theta, &exists));
    return ritz_band_vector(&s->T, theta, z);
}

static void band_survives_every_allocation(void **state)
{
    sample s;

    (void)state;
    open_sample(8, 5, &s);
    assert_survives_every_allocation(find_one(&s));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(single_pairs_agree_with_lapack),
    cmocka_unit_test(a_close_bound_is_enough_and_a_wrong_one_is_noticed),
    cmocka_unit_test(band_survives_every_allocation),
};

TEST_MODULE(band, tests, NULL, NULL)
