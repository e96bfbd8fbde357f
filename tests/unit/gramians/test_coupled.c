/* Modes coupled by damping: Gramians, clusters, and poles at 0. */
#include "testing.h"

#include "gramians/modes.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = 3, RIGID = 2, ALL = MODES + RIGID, STATES = 2 * ALL };

/*
 * Three flexible modes and no or two rigid ones. Damping has a definite
 * symmetric part and a gyroscopic part; there are outputs of displacement and
 * of velocity.
 */
typedef struct numbers {
    double omega[MODES], zeta[MODES];
    double delta[ALL * ALL], b[2 * ALL], c[2 * ALL], cv[2 * ALL];
} numbers;

static ritz_modal set_model(int rigid, numbers *at)
{
    static const double omega[MODES] = {1.0, 2.5, 4.0};
    static const double delta[ALL][ALL] = {{0.30, 0.20, -0.05, 0.10, 0.04},
                                           {0.10, 0.50, 0.15, 0.20, -0.10},
                                           {-0.05, 0.25, 0.80, -0.3, 0.20},
                                           {0.10, 0.20, -0.3, 0.60, 0.10},
                                           {0.04, -0.10, 0.20, 0.10, 0.40}};
    static const double b[2][ALL] = {{1.0, -0.5, 0.3, 0.8, -0.2},
                                     {0.2, 0.7, -1.1, 0.4, 0.5}};
    static const double c[2][ALL] = {{0.9, 0.4, -0.6, 0.7, 0.3},
                                     {-0.3, 1.2, 0.5, -0.2, 0.6}};
    int n = MODES + rigid;

    memcpy(at->omega, omega, sizeof omega);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++)
            at->delta[i + j * n] = delta[i][j];
        for (int k = 0; k < 2; k++) {
            at->b[j + k * n] = b[k][j];
            at->c[k + 2 * j] = c[k][j];
            at->cv[k + 2 * j] = k == 1 ? 0.1 * b[0][j] : 0.0;
        }
        if (j < MODES)
            at->zeta[j] = delta[j][j] / (2.0 * omega[j]);
    }
    return (ritz_modal){MODES,         at->omega,         at->zeta,
                        {n, 2, at->b}, {2, n, at->c},     {2, n, at->cv},
                        rigid,         {n, n, at->delta}, {0}};
}

/* A of the states (q_1, q_1', ..., v), v the velocities of rigid motion. */
static void set_matrix(const ritz_modal *modal, double A[STATES][STATES])
{
    int64_t n = modal->count + modal->num_rigid;

    memset(A, 0, sizeof(double[STATES][STATES]));
    for (int64_t i = 0; i < n; i++) {
        int64_t at = i < modal->count ? 2 * i + 1 : modal->count + i;

        for (int64_t j = 0; j < n; j++)
            A[at][j < modal->count ? 2 * j + 1 : modal->count + j] =
                -ritz_dense_col(&modal->Delta, j)[i];
        if (i < modal->count) {
            A[at - 1][at] = 1.0;
            A[at][at - 1] = -modal->omega[i] * modal->omega[i];
        }
    }
}

/* Largest entry of A W + W A' + sum_k f_k f_k', or of the equation with A'. */
static double residual(const ritz_modal *modal, bool transposed,
                       const ritz_dense *W, const double f[2][STATES])
{
    double A[STATES][STATES];
    double largest = 0.0;
    int64_t n = W->nrow;

    set_matrix(modal, A);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double sum = f[0][i] * f[0][j] + f[1][i] * f[1][j];

            for (int64_t k = 0; k < n; k++)
                sum +=
                    (transposed ? A[k][i] : A[i][k]) * ritz_dense_col(W, j)[k] +
                    (transposed ? A[k][j] : A[j][k]) * ritz_dense_col(W, i)[k];
            largest = fmax(largest, fabs(sum));
        }
    return largest;
}

/* Entries are up to 20, and 1e-13 is some twenty of their roundings. */
static void gramians_satisfy_their_equations(void **state)
{
    numbers own;
    const ritz_modal modal = set_model(0, &own);
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0};
    double b[2][STATES] = {{0}}, c[2][STATES] = {{0}};

    (void)state;
    assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    assert_int_equal(Wc.nrow, 2 * MODES);
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < MODES; j++) {
            b[k][2 * j + 1] = ritz_dense_col(&modal.B, k)[j];
            c[k][2 * j] = ritz_dense_col(&modal.C, j)[k];
            c[k][2 * j + 1] = ritz_dense_col(&modal.Cv, j)[k];
        }
    assert_near(residual(&modal, false, &Wc, b), 0.0, 1e-13);
    assert_near(residual(&modal, true, &Wo, c), 0.0, 1e-13);
}

/* Damped rigid motion has its velocities as states. The Gramians satisfy
   Lyapunov equations with the same inputs, and with the outputs of
   ritz_modal_outputs, from which poles at 0 are removed. */
static void gramians_of_rigid_motion_satisfy_them_too(void **state)
{
    numbers own;
    const ritz_modal modal = set_model(RIGID, &own);
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0}, C = {0};
    double b[2][STATES] = {{0}}, c[2][STATES] = {{0}};

    (void)state;
    assert_int_equal(ritz_modal_order(&modal), 2 * MODES + RIGID);
    assert_ok(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    assert_ok(ritz_modal_outputs(&modal, &C));
    for (int k = 0; k < 2; k++) {
        for (int j = 0; j < ALL; j++)
            b[k][j < MODES ? 2 * j + 1 : MODES + j] =
                ritz_dense_col(&modal.B, k)[j];
        memcpy(c[k], ritz_dense_col(&C, k), (size_t)C.nrow * sizeof *c[k]);
    }
    assert_near(residual(&modal, false, &Wc, b), 0.0, 1e-13);
    assert_near(residual(&modal, true, &Wo, c), 0.0, 1e-12);
}

/*
 * Computed by SciPy 1.10: of the states [q; q'] of all modes, poles at 0 are
 * removed by x - X (W'X)^-1 W'x with their right and left eigenvectors X and W;
 * solve_continuous_lyapunov gives W_c and W_o of the rest; values are the
 * square roots of the eigenvalues of W_c W_o.
 */
static void hankel_values_are_those_of_scipy(void **state)
{
    static const double bound[2 * MODES] = {1.88644699179378, 1.40143268783457,
                                            0.49838227583724, 0.41952336435923,
                                            0.13547701964239, 0.11705577420425};
    static const double free[2 * MODES + RIGID] = {
        1.60130124511136, 1.47649745852518, 1.15880651451303, 0.67023302791745,
        0.48423700238135, 0.41013867353938, 0.12942292658021, 0.11921017248769};
    numbers own;
    ritz_modal modal = set_model(0, &own);
    double sigma[2 * MODES + RIGID] = {0};
    int64_t count = 0;

    (void)state;
    assert_ok(ritz_modal_hankel(&modal, NULL, sigma));
    for (int k = 0; k < 2 * MODES; k++)
        assert_near(sigma[k], bound[k], 1e-12 * bound[0]);
    modal = set_model(RIGID, &own);
    assert_ok(ritz_coupled_hankel(&modal, &count, sigma));
    assert_int_equal(count, 2 * MODES + RIGID);
    for (int k = 0; k < 2 * MODES + RIGID; k++)
        assert_near(sigma[k], free[k], 1e-12 * free[0]);
}

/*
 * A rotor without damping of its own, v' = 0.7 q' + u / 2, is coupled by a
 * gyroscopic term to a damped mode, q'' + 0.2 q' + 0.7 v + 4 q = u. With v =
 * 0.7 q + z, z' = u / 2, and p = s^2 + 0.2 s + 4.49,
 *
 *     q = (s - 0.35) / (s p) u,    y = q + 0.3 q_r,    q_r' = v
 *
 * there are three poles at 0. They are removed term by term by
 *
 *     G / s = g(0) / s + (G - g(0) p) / (s p),
 *
 * and a mode with denominator p and outputs q and q' is left.
 */
static void an_undamped_rotor_is_not_refused(void **state)
{
    double omega[] = {2.0}, zeta[] = {0.05};
    double delta[] = {0.2, -0.7, 0.7, 0.0};
    double b[] = {1.0, 0.5}, c[] = {1.0, 0.3}, none[] = {0.0, 0.0};
    const ritz_modal modal = {1,         omega,         zeta,
                              {2, 1, b}, {1, 2, c},     {1, 2, none},
                              1,         {2, 2, delta}, {0}};
    double r = -0.35 / 4.49;  /* residue of q at s = 0 */
    double x = 1.0 - 0.2 * r; /* rest of q: (x - r s) / p */
    double t = x / 4.49;      /* residue of its integral */
    double seen[] = {x + 0.21 * (-r - 0.2 * t)};
    double rate[] = {-r - 0.21 * t};
    double w[] = {sqrt(4.49)}, z[] = {0.1 / sqrt(4.49)};
    const ritz_modal left = {1, w,   z,  {1, 1, b}, {1, 1, seen}, {1, 1, rate},
                             0, {0}, {0}};
    double sigma[3] = {0}, exact[2] = {0};
    int64_t count = 0;

    (void)state;
    assert_ok(ritz_coupled_hankel(&modal, &count, sigma));
    assert_ok(ritz_modal_hankel(&left, NULL, exact));
    assert_int_equal(count, 2);
    for (int k = 0; k < 2; k++)
        assert_near(sigma[k], exact[k], 1e-13 * exact[0]);
}

/* Damping couples modes 1 and 3 by 0.2 of their own damping, modes 3 and 4 by
   0.3, and mode 2 with no other by more than 0.05. */
static void clusters_are_chains_of_couplings(void **state)
{
    double omega[] = {1.0, 2.0, 3.0, 4.0};
    double zeta[] = {0.5, 0.25, 1.0 / 6.0, 0.125};
    double delta[] = {1.0, 0.05, 0.20, 0.00, 0.05, 1.0,  0.01, 0.02,
                      0.2, 0.01, 1.00, 0.30, 0.00, 0.02, 0.30, 1.0};
    const ritz_modal modal = {
        .count = 4, .omega = omega, .zeta = zeta, .Delta = {4, 4, delta}};
    int64_t cluster[4];

    (void)state;
    assert_ok(ritz_coupled_clusters(&modal, cluster));
    assert_int_equal(cluster[0], 0);
    assert_int_equal(cluster[1], 1);
    assert_int_equal(cluster[2], 0);
    assert_int_equal(cluster[3], 0);
}

/*
 * Rigid motion is always kept, and joins no modes to one cluster. It is in a
 * mode's cluster only if no other damping acts on that mode, and then as a
 * whole, because any basis of rigid motion is as good.
 */
static void rigid_motion_joins_no_modes(void **state)
{
    double omega[] = {1.0, 2.0}, zeta[] = {0.5, 0.25};
    double delta[] = {1.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.3, 0.0,
                      0.3, 0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    const ritz_modal modal = {.count = 2,
                              .omega = omega,
                              .zeta = zeta,
                              .num_rigid = 2,
                              .Delta = {4, 4, delta}};
    int64_t cluster[4];

    (void)state;
    assert_ok(ritz_coupled_clusters(&modal, cluster));
    for (int k = 0; k < 4; k++)
        assert_int_equal(cluster[k], k < 2 ? k : 2);
    /* mode 1 has no damping of its own, and a gyroscopic coupling to rigid
       motion */
    delta[0] = zeta[0] = 0.0;
    delta[2] = -0.3;
    assert_ok(ritz_coupled_clusters(&modal, cluster));
    assert_int_equal(cluster[0], 0);
    assert_int_equal(cluster[1], 1);
    assert_int_equal(cluster[2], 0);
    assert_int_equal(cluster[3], 0);
}

enum { MANY = 151 };

/*
 * A mode with damping of -0.01 decays through gyroscopic couplings of 0.009 to
 * 150 other modes, each of which adds 0.009^2 = 8.1e-5 of damping. All modes
 * form one cluster, because fewer of them would grow.
 */
static void modes_that_decay_only_together_are_one_cluster(void **state)
{
    ritz_modal modal = {.count = MANY};
    RITZ_OWN_ARRAY int64_t *cluster = NULL;

    (void)state;
    assert_non_null(cluster = calloc(MANY, sizeof *cluster));
    assert_non_null(modal.omega = calloc(MANY, sizeof *modal.omega));
    assert_non_null(modal.zeta = calloc(MANY, sizeof *modal.zeta));
    assert_ok(ritz_dense_new(MANY, MANY, &modal.Delta));
    for (int k = 0; k < MANY; k++) {
        double own = k == 0 ? -0.01 : 1.0;

        modal.omega[k] = 1.0 + 1e-4 * k;
        modal.zeta[k] = own / (2.0 * modal.omega[k]);
        ritz_dense_col(&modal.Delta, k)[k] = own;
        if (k > 0) {
            ritz_dense_col(&modal.Delta, k)[0] = 0.009;
            ritz_dense_col(&modal.Delta, 0)[k] = -0.009;
        }
    }
    assert_ok(ritz_coupled_clusters(&modal, cluster));
    for (int k = 0; k < MANY; k++)
        assert_int_equal(cluster[k], 0);
    /* with half of each coupling the whole system grows */
    for (int k = 1; k < MANY; k++)
        ritz_dense_col(&modal.Delta, k)[0] *= 0.5;
    assert_fails(ritz_coupled_clusters(&modal, cluster), RITZ_ERR_ARGUMENT,
                 "the mode at 0.159155 Hz has negative damping");
    ritz_modal_free(&modal);
}

/* A part's modes have the damping of that part alone. */
static void a_part_has_its_own_damping(void **state)
{
    const bool first[] = {true, false, false}, two[] = {true, true, false};
    const bool none[RIGID] = {false, false};
    numbers own;
    const ritz_modal modal = set_model(RIGID, &own);
    RITZ_OWN(ritz_modal) one = {0}, pair = {0}, all = {0};

    (void)state;
    assert_ok(ritz_modal_part(&modal, first, none, &one));
    assert_int_equal(one.count, 1);
    assert_null(one.Delta.val);
    assert_near(one.zeta[0], 0.15, 1e-15);
    assert_ok(ritz_modal_part(&modal, two, none, &pair));
    assert_int_equal(pair.Delta.ncol, 2);
    assert_near(pair.Delta.val[1], 0.10, 0.0);
    assert_near(pair.Delta.val[2], 0.20, 0.0);
    assert_ok(ritz_modal_part(&modal, first, NULL, &all));
    assert_int_equal(all.num_rigid, RIGID);
    assert_near(ritz_dense_col(&all.Delta, 2)[0], 0.04, 0.0);
    assert_near(ritz_dense_col(&all.C, 1)[0], 0.7, 0.0);
}

/* Accelerations of a part are b u - Lambda q - Delta q' with Delta of the part,
   not of the whole. */
static void accelerations_of_a_part_have_its_damping(void **state)
{
    const bool taken[] = {true, false, true};
    const bool rigid[] = {false, true};
    double ca[2 * ALL];
    numbers own;
    ritz_modal modal = set_model(RIGID, &own);
    RITZ_OWN(ritz_modal) part = {0};

    (void)state;
    for (int k = 0; k < 2 * ALL; k++)
        ca[k] = 0.3 - 0.1 * k;
    modal.Ca = (ritz_dense){2, ALL, ca};
    for (int k = 0; k < ALL; k++)
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < ALL; j++)
                ritz_dense_col(&modal.Cv, k)[i] -=
                    ritz_dense_col(&modal.Ca, j)[i] *
                    ritz_dense_col(&modal.Delta, k)[j];
    assert_ok(ritz_modal_part(&modal, taken, rigid, &part));
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) {
            int mode = k < 2 ? 2 * k : 4; /* its number in the whole */
            double left = ritz_dense_col(&part.Cv, k)[i];

            for (int j = 0; j < 3; j++)
                left += ritz_dense_col(&part.Ca, j)[i] *
                        ritz_dense_col(&part.Delta, k)[j];
            assert_near(left, i == 1 ? 0.1 * own.b[mode] : 0.0, 1e-14);
        }
}

static void motions_that_do_not_decay_are_refused(void **state)
{
    double omega[] = {1.0, 2.0}, zeta[] = {0.0, 0.25};
    double delta[] = {0.0, 0.0, 0.0, 1.0};
    double b[] = {1.0, 1.0}, none[] = {0.0, 0.0};
    ritz_modal modal = {2,         omega,         zeta,
                        {2, 1, b}, {1, 2, b},     {1, 2, none},
                        0,         {2, 2, delta}, {0}};
    int64_t cluster[2], count = 0;
    double sigma[4];
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};

    (void)state;
    assert_fails(ritz_coupled_clusters(&modal, cluster), RITZ_ERR_ARGUMENT,
                 "the mode at 0.159155 Hz has no damping");
    assert_fails(ritz_coupled_hankel(&modal, &count, sigma), RITZ_ERR_ARGUMENT,
                 "a motion at 0.159155 Hz is not damped, or grows");
    delta[0] = zeta[0] = 0.1;
    delta[1] = delta[2] = 0.2;
    assert_fails(ritz_modal_factors(&modal, (double[]){0.0, 1.0}, &X, &Y),
                 RITZ_ERR_ARGUMENT,
                 "couples the modes at 0.159155 and 0.31831 Hz: over a band");
    assert_fails(ritz_modal_gramians(&modal, (double[]){0.0, 1.0}, &X, &Y),
                 RITZ_ERR_ARGUMENT, "over a band it must be mode by mode");
}

static ritz_status once(void)
{
    numbers own;
    const ritz_modal modal = set_model(RIGID, &own);
    const bool taken[] = {true, false, true};
    RITZ_OWN(ritz_dense) Wc = {0}, Wo = {0}, C = {0};
    RITZ_OWN(ritz_modal) part = {0};
    double sigma[2 * MODES + RIGID];
    int64_t cluster[ALL];

    RITZ_CHECK(ritz_coupled_clusters(&modal, cluster));
    RITZ_CHECK(ritz_modal_gramians(&modal, NULL, &Wc, &Wo));
    RITZ_CHECK(ritz_modal_outputs(&modal, &C));
    RITZ_CHECK(ritz_modal_hankel(&modal, NULL, sigma));
    return ritz_modal_part(&modal, taken, NULL, &part);
}

static void coupled_modes_survive_every_allocation(void **state)
{
    (void)state;
    assert_survives_every_allocation(once());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(gramians_satisfy_their_equations),
    cmocka_unit_test(gramians_of_rigid_motion_satisfy_them_too),
    cmocka_unit_test(hankel_values_are_those_of_scipy),
    cmocka_unit_test(an_undamped_rotor_is_not_refused),
    cmocka_unit_test(clusters_are_chains_of_couplings),
    cmocka_unit_test(rigid_motion_joins_no_modes),
    cmocka_unit_test(modes_that_decay_only_together_are_one_cluster),
    cmocka_unit_test(a_part_has_its_own_damping),
    cmocka_unit_test(accelerations_of_a_part_have_its_damping),
    cmocka_unit_test(motions_that_do_not_decay_are_refused),
    cmocka_unit_test(coupled_modes_survive_every_allocation),
};

TEST_MODULE(coupled, tests, NULL, NULL)
