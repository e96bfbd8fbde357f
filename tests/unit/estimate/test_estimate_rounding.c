/* Bounds where rounding decides, and where nothing may be called proven. */
#include "testing.h"

#include "dualspin.h"
#include "estimate/estimator.h"
#include "frame.h"
#include "masses.h"
#include "poles/poles.h"
#include "project.h"
#include "spring_chain.h"
#include "truss.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <complex.h>
#include <math.h>

enum { MOST = 12 };

/* The pencil (diag lambda, I), each mode controllable and observable. */
static void diagonal(int64_t n, const double *lambda, ritz_component *out)
{
    assert_ok(masses_apart(n, lambda, NULL, out));
    assert_ok(ritz_io_new(n, 1, 1, &out->io));
    for (int64_t i = 0; i < n; i++)
        out->io.B.val[i] = out->io.C.val[i] = 1.0;
}

/* Rayleigh damping of a stiff row must not hide other damping of a soft one. */
static void damping_of_soft_rows_is_looked_at_by_itself(void **)
{
    enum { N = 3 };
    const double lambda[N] = {1.0, 2.0, 1e13};
    const struct {
        double soft; /* d of lambda = 2 */
        const char *name;
    } kind[] = {{2e-3, "response-relative-bound"},
                {1e-3, "response-relative-estimate"}};
    const int64_t at[N] = {0, 1, 2};
    const ritz_estimate_request request = {.band_hz = {0.0, 0.2}};

    for (size_t i = 0; i < 2; i++) {
        const double d[N] = {1e-3, kind[i].soft, 1e10};
        RITZ_OWN(ritz_component) body = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        diagonal(N, lambda, &body);
        assert_ok(ritz_sparse_from_triplets(N, N, N, at, at, d, &body.D));
        assert_ok(ritz_basis_new(N, 2, &basis));
        for (int64_t j = 0; j < 2; j++)
            ritz_dense_col(&basis.T, j)[j] = 1.0;
        assert_ok(ritz_reduce(&body, &basis, &reduced));
        assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
        (void)find_measure(&reduced.estimates, kind[i].name);
    }
}

/*
 * Two exact modes of three, which alone are controllable and observable: the
 * only error is the effect of D through the third one. Measured by the full
 * equations at 2000 frequencies.
 */
static double coupled_error(const double *lambda, const double D[3][3],
                            double to_hz, double *largest)
{
    double error = 0.0;

    *largest = 0.0;
    for (int k = 0; k <= 2000; k++) {
        double w = sqrt(ritz_eigen_lambda(to_hz)) * k / 2000.0;
        double _Complex Z[3][3];
        double _Complex det = 0.0, two = 0.0, H = 0.0, H_r = 0.0;

        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                Z[i][j] =
                    ritz_complex(i == j ? lambda[i] - w * w : 0.0, w * D[i][j]);
        /* b'adj(Z)b / det Z, b = (1, 1, 0) */
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                int a = (i + 1) % 3, b = (i + 2) % 3;
                int c = (j + 1) % 3, d = (j + 2) % 3;
                double _Complex part = Z[a][c] * Z[b][d] - Z[a][d] * Z[b][c];

                H += i < 2 && j < 2 ? part : 0.0;
                det += i == 0 ? Z[0][j] * part : 0.0;
            }
        two = Z[0][0] * Z[1][1] - Z[0][1] * Z[1][0];
        H /= det;
        H_r = (Z[0][0] + Z[1][1] - Z[0][1] - Z[1][0]) / two;
        error = fmax(error, cabs(H - H_r));
        *largest = fmax(*largest, cabs(H));
    }
    return error / *largest;
}

static void damping_that_couples_modes_is_not_left_out(void **)
{
    enum { N = 3 };
    const double lambda[N] = {1.0, 4.0, 100.0};
    const double D[N][N] = {{0.5, 0.3, 2.0}, {0.3, 0.4, 1.0}, {2.0, 1.0, 12.0}};
    const ritz_estimate_request request = {.band_hz = {0.0, 0.5}};
    int64_t row[N * N], col[N * N];
    double val[N * N];
    double largest = 0.0, error = 0.0, estimate = 0.0;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    diagonal(N, lambda, &body);
    body.io.B.val[2] = body.io.C.val[2] = 0.0;
    for (int64_t k = 0; k < (int64_t)N * N; k++) {
        row[k] = k % N;
        col[k] = k / N;
        val[k] = D[k % N][k / N];
    }
    assert_ok(ritz_sparse_from_triplets(N, N, (int64_t)N * N, row, col, val,
                                        &body.D));
    assert_ok(ritz_basis_new(N, 2, &basis));
    for (int64_t j = 0; j < 2; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    estimate =
        find_measure(&reduced.estimates, "response-relative-estimate")->value;
    error = coupled_error(lambda, D, 0.5, &largest);
    /* Z^-1 without coupling is near, not more: measured 1.0 */
    if (!(estimate >= 0.9 * error) || !(estimate <= 3.0 * error))
        fail_msg("estimate %.3e of %.3e", estimate, error);
}

/*
 * Columns of 1e4 flexible motions and one rigid one leave 1e8 eps of the rigid
 * motion's stiffness: no frequency, and no mode that is wrong. Not every such
 * number hides it; of these some do.
 */
static void a_rigid_motion_hidden_by_rounding_is_no_mode(void **)
{
    enum { MASSES = 10, COLUMNS = 3 };
    const double mixed[] = {7460.0,  8070.0,  8720.0,  9430.0,
                            10200.0, 12890.0, 16290.0, 22260.0};
    const double share[COLUMNS] = {1.0, 0.0, -0.5};
    const ritz_span span = {.modes = COLUMNS};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    ritz_estimate_request request = {0};

    assert_ok(spring_chain(MASSES, true, &chain));
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &span, &full));
    request.band_hz[1] = 1.1 * ritz_eigen_hertz(full.lambda[COLUMNS - 1]);
    for (size_t k = 0; k < sizeof mixed / sizeof *mixed; k++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        assert_ok(ritz_basis_new(MASSES, COLUMNS, &basis));
        for (int64_t j = 0; j < COLUMNS; j++)
            for (int64_t i = 0; i < MASSES; i++)
                ritz_dense_col(&basis.T, j)[i] =
                    ritz_dense_col(&full.Phi, j)[i] +
                    share[j] * mixed[k] * ritz_dense_col(&full.Phi, 1)[i];
        assert_ok(ritz_reduce(&chain, &basis, &reduced));
        assert_ok(ritz_estimate(&chain, &basis, &request, &reduced));
        if (!(find_measure(&reduced.estimates, "frequency-relative-bound")
                  ->value < 1e-6))
            fail_msg("%g: bound %g, %s", mixed[k],
                     reduced.estimates.item[0].value,
                     reduced.estimates.item[0].where);
    }
}

/*
 * A full basis of columns that nearly depend on each other: a threefold mode
 * comes out of the reduced matrices as three, moved by their rounding, and each
 * may be any of them.
 */
static void modes_that_rounding_exchanges_share_it(void **)
{
    enum { N = 6, TIMES = 12 };
    const double lambda[N] = {1.0, 3.0, 7.0, 7.0, 7.0, 40.0};
    ritz_estimate_request request = {0};
    RITZ_OWN(ritz_component) body = {0};
    uint64_t seed = 5;

    diagonal(N, lambda, &body);
    request.band_hz[1] = 1.1 * ritz_eigen_hertz(lambda[4]);
    for (int times = 0; times < TIMES; times++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        const ritz_measures *found = &reduced.estimates;
        double low = 0.0, high = 0.0;

        assert_ok(ritz_basis_new(N, N, &basis));
        for (int64_t k = 0; k < (int64_t)N * N; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            basis.T.val[k] = (double)(seed >> 40) / 0x1p24 - 0.5;
        }
        for (int64_t i = 0; i < N; i++) /* nearly the sum of two others */
            ritz_dense_col(&basis.T, 2)[i] =
                ritz_dense_col(&basis.T, 0)[i] +
                ritz_dense_col(&basis.T, 1)[i] +
                1e-4 * ritz_dense_col(&basis.T, 2)[i];
        assert_ok(ritz_reduce(&body, &basis, &reduced));
        assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
        low = find_measure(found, "mode-3")->value;
        high = find_measure(found, "mode-5")->value;
        /* the worst of the three may be the lowest of them, or the highest */
        if (!(low <= 3.0 * high) || !(high <= 3.0 * low))
            fail_msg("of equal modes %.3e and %.3e", low, high);
    }
}

/*
 * A full basis, or one of exact modes, contains the modes of the band up to
 * rounding. More eigenvalue counts then improve no bound, and a few factors are
 * enough.
 */
static void exact_bases_need_few_counts(void **)
{
    enum { MASSES = 60, MODES = 50, FEW = 6 };
    const ritz_span span = {.modes = MODES};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    ritz_estimate_request request = {0};

    assert_ok(spring_chain(MASSES, false, &chain));
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &span, &full));
    request.band_hz[1] = 1.001 * ritz_eigen_hertz(full.lambda[30]);
    for (int whole = 0; whole < 2; whole++) {
        int64_t columns = whole ? MASSES : MODES;
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};
        ritz_estimator *estimator = NULL;

        assert_ok(ritz_basis_new(MASSES, columns, &basis));
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < MASSES; i++)
                ritz_dense_col(&basis.T, j)[i] =
                    whole ? (double)(i == j) : ritz_dense_col(&full.Phi, j)[i];
        assert_ok(ritz_reduce(&chain, &basis, &reduced));
        assert_ok(ritz_estimator_new(&chain, &request, &estimator));
        assert_ok(
            ritz_estimator_measure(estimator, &basis, &reduced, false, &found));
        if (estimator->num_factors > FEW)
            fail_msg("%d columns: %d factors for counts", (int)columns,
                     (int)estimator->num_factors);
        assert_true(find_measure(&found, "frequency-relative-bound")->value <
                    1e-9);
        assert_true(find_measure(&found, "missing-modes-bound")->value == 0.0);
        ritz_estimator_free(&estimator);
    }
}

/* Estimate the errors of a chain that is reduced to COLUMNS sines. */
static void estimate_chain(const ritz_component *chain,
                           const ritz_estimate_request *request,
                           int64_t *num_factors, ritz_measures *found)
{
    enum { COLUMNS = 40 };
    ritz_estimator *estimator = NULL;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(ritz_basis_new(chain->num_dofs, COLUMNS, &basis));
    for (int64_t j = 0; j < COLUMNS; j++) /* sines that are no modes */
        for (int64_t i = 0; i < chain->num_dofs; i++)
            ritz_dense_col(&basis.T, j)[i] =
                sin(3.14159265358979 * (double)((i + 1) * (j + 1)) /
                    (double)(chain->num_dofs + 1));
    assert_ok(ritz_reduce(chain, &basis, &reduced));
    assert_ok(ritz_estimator_new(chain, request, &estimator));
    assert_ok(
        ritz_estimator_measure(estimator, &basis, &reduced, false, found));
    *num_factors = estimator->num_factors;
    ritz_estimator_free(&estimator);
}

/* Bounds are the same whether modes are counted by a factor or from known modes,
   all of them, or none beyond the third, or none proven: then factors count. */
static void known_modes_are_counted_without_factors(void **)
{
    enum { MASSES = 60, MODES = 30, BAND = 10 };
    const ritz_span span = {.modes = MODES};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    RITZ_OWN(ritz_measures) without = {0};
    ritz_estimate_request request = {0};
    int64_t factors = 0;

    assert_ok(spring_chain(MASSES, false, &chain));
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &span, &full));
    request.band_hz[1] = 1.001 * ritz_eigen_hertz(full.lambda[BAND - 1]);
    estimate_chain(&chain, &request, &factors, &without);
    assert_true(factors > 0);
    request.modes = &full;
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_measures) with = {0};
        const double proven[] = {full.proven_to, full.lambda[2], nan("")};
        const double before = full.proven_to;
        int64_t fewer = 0;

        full.proven_to = proven[k];
        estimate_chain(&chain, &request, &fewer, &with);
        full.proven_to = before;
        assert_true(k == 0 ? fewer == 0 : fewer <= factors && fewer > 0);
        assert_int_equal(with.count, without.count);
        for (int64_t j = 0; j < with.count; j++)
            assert_true(with.item[j].value == without.item[j].value);
    }
}

/*
 * A full basis has all modes: where its eigenvalues are clear of rounding, the
 * number of modes below a frequency is known without a factor. The band of this
 * free body ends below its first flexible mode, where many counts tell rigid
 * eigenvalues from zero.
 */
static void a_full_basis_is_counted_without_factors(void **)
{
    enum { FEW = 6 };
    const ritz_estimate_request request = {.band_hz = {0.0, 0.01}};
    ritz_estimator *estimator = NULL;
    RITZ_OWN(ritz_component) truss = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    assert_ok(truss_component(&truss_free72, &truss));
    assert_ok(ritz_basis_new(truss.num_dofs, truss.num_dofs, &basis));
    for (int64_t j = 0; j < truss.num_dofs; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&truss, &basis, &reduced));
    assert_ok(ritz_estimator_new(&truss, &request, &estimator));
    assert_ok(
        ritz_estimator_measure(estimator, &basis, &reduced, false, &found));
    if (estimator->num_factors > FEW)
        fail_msg("%d factors for %d counts", (int)estimator->num_factors,
                 (int)estimator->num_counts);
    ritz_estimator_free(&estimator);
}

/*
 * With all dofs kept, the residual that would enrich the trial space is
 * rounding. Part of it lies in the space already, and no vector may be added
 * twice. The rotor has dofs without mass.
 */
static void rounding_does_not_enrich_the_trial_space(void **)
{
    const ritz_estimate_request request = {
        .band_hz = {0.1, 2.15},
        .damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.5}};
    const int64_t at[2] = {60, 3 * 60};
    RITZ_OWN(ritz_component) rotor = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    dualspin_or_skip();
    assert_ok(dualspin_component(0, &rotor));
    ritz_io_free(&rotor.io);
    assert_ok(frame_io(&rotor, 1, at, 1, at + 1));
    assert_ok(ritz_basis_new(rotor.num_dofs, rotor.num_dofs, &basis));
    for (int64_t j = 0; j < rotor.num_dofs; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&rotor, &basis, &reduced));
    assert_ok(ritz_estimate(&rotor, &basis, &request, &reduced));
    assert_true(ritz_measures_value(&reduced.estimates,
                                    "response-relative-bound") < 1e-4);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(damping_of_soft_rows_is_looked_at_by_itself),
    cmocka_unit_test(damping_that_couples_modes_is_not_left_out),
    cmocka_unit_test(a_rigid_motion_hidden_by_rounding_is_no_mode),
    cmocka_unit_test(modes_that_rounding_exchanges_share_it),
    cmocka_unit_test(exact_bases_need_few_counts),
    cmocka_unit_test(known_modes_are_counted_without_factors),
    cmocka_unit_test(a_full_basis_is_counted_without_factors),
    cmocka_unit_test(rounding_does_not_enrich_the_trial_space),
};

TEST_MODULE(estimate_rounding, tests, NULL, NULL)
