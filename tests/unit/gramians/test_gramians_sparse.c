/*
 * Gramians of sparse state spaces: ADI against SLICOT, the stated residual
 * against that of the equation, poles at 0, bands against closed forms,
 * refusals.
 */
#include "testing.h"

#include "spaces.h"

#include "gramians/space.h"
#include "linear/general.h"

#include <ritz/basis.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static double frobenius(const ritz_dense *A)
{
    return ritz_general_size(A);
}

/* A W E' + E W A' + B B' for W = Z Z'. */
static void residual_matrix(const ritz_state_space *m, const ritz_dense *Z,
                            ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AZ = {0}, EZ = {0}, BB = {0}, back = {0};

    assert_ok(ritz_dense_mul(&m->A, Z, &AZ));
    assert_ok(m->E.val ? ritz_dense_mul(&m->E, Z, &EZ)
                       : ritz_dense_copy(Z, &EZ));
    assert_ok(ritz_dense_mul_nt(&AZ, &EZ, out));
    assert_ok(ritz_dense_mul_nt(&EZ, &AZ, &back));
    assert_ok(ritz_dense_mul_nt(&m->B, &m->B, &BB));
    ritz_dense_add(1.0, &back, out);
    ritz_dense_add(1.0, &BB, out);
}

/* |A W E' + E W A' + B B'| / |B B'|, W = Z Z', in the Frobenius norm. */
static double residual_of(const ritz_state_space *m, const ritz_dense *Z)
{
    RITZ_OWN(ritz_dense) R = {0}, BB = {0};

    residual_matrix(m, Z, &R);
    assert_ok(ritz_dense_mul_nt(&m->B, &m->B, &BB));
    return frobenius(&R) / frobenius(&BB);
}

/* The same in the 2-norm. */
static double equation_norm(const ritz_state_space *m, const ritz_dense *Z)
{
    RITZ_OWN(ritz_dense) R = {0}, BB = {0};
    double residual = 0.0, load = 0.0;

    residual_matrix(m, Z, &R);
    assert_ok(ritz_dense_mul_tn(&m->B, &m->B, &BB));
    assert_ok(ritz_general_norm(&R, &residual));
    assert_ok(ritz_general_norm(&BB, &load));
    return residual / load;
}

/* Rods with and without wind, with and without E. */
static void low_rank_values_are_those_of_dense_ones(void **)
{
    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
        RITZ_OWN(ritz_gramians) thin = {0}, full = {0};
        const ritz_state_space *dense = NULL;
        double *a = NULL, *b = NULL;
        int64_t count_a = 0, count_b = 0;

        assert_ok(spaces_rod(150, k & 1 ? 0.05 : 0.0, k & 2, &rod));
        assert_ok(ritz_state_space_dense(&rod, &made, &dense));
        assert_ok(
            ritz_gramians_of_space_by(&rod, RITZ_ENGINE_LOW_RANK, NULL, &thin));
        assert_ok(
            ritz_gramians_of_space_by(dense, RITZ_ENGINE_DENSE, NULL, &full));
        assert_non_null(strstr(thin.engine, "ADI"));
        assert_true(thin.Zc.ncol < 100 && thin.residual[0] <= 1e-10 &&
                    thin.residual[1] <= 1e-10);
        /* the stated residual is in the 2-norm, this one in the Frobenius
           norm */
        assert_near(residual_of(dense, &thin.Zc), 0.0, 4e-10);
        assert_ok(ritz_gramians_hankel(&thin, &count_a, &a));
        assert_ok(ritz_gramians_hankel(&full, &count_b, &b));
        for (int i = 0; i < 8; i++)
            assert_near(a[i], b[i], 1e-8 * b[0]);
        free(a);
        free(b);
    }
}

/* Projection of rods: the stated residual is that of the equation in the
   2-norm, and values are those of SLICOT and of ADI. */
static void projected_values_are_those_of_dense_ones(void **)
{
    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
        RITZ_OWN(ritz_gramians) found = {0}, thin = {0}, full = {0};
        const ritz_state_space *dense = NULL;
        double *sigma[3] = {NULL};
        int64_t count = 0;

        assert_ok(spaces_rod(150, k & 1 ? 0.05 : 0.0, k & 2, &rod));
        assert_ok(ritz_state_space_dense(&rod, &made, &dense));
        assert_ok(ritz_gramians_of_space_by(&rod, RITZ_ENGINE_PROJECTION, NULL,
                                            &found));
        assert_ok(
            ritz_gramians_of_space_by(&rod, RITZ_ENGINE_LOW_RANK, NULL, &thin));
        assert_ok(
            ritz_gramians_of_space_by(dense, RITZ_ENGINE_DENSE, NULL, &full));
        assert_non_null(strstr(found.engine, "projection, "));
        assert_true(found.Zc.ncol < 100 && found.residual[0] <= 1e-10 &&
                    found.residual[1] <= 1e-10);
        assert_ok(ritz_gramians_hankel(&found, &count, &sigma[0]));
        assert_ok(ritz_gramians_hankel(&thin, &count, &sigma[1]));
        assert_ok(ritz_gramians_hankel(&full, &count, &sigma[2]));
        for (int i = 0; i < 8; i++) {
            assert_near(sigma[0][i], sigma[2][i], 1e-8 * sigma[2][0]);
            assert_near(sigma[0][i], sigma[1][i], 1e-8 * sigma[2][0]);
        }
        for (int i = 0; i < 3; i++)
            free(sigma[i]);
    }
}

/* The residual that is stated, for tolerances of 1e-8 to 1e-4, is that of the
   equation up to the rounding of A W E', n eps |A| |W| / |B B'|. */
static void the_residual_of_a_projection_is_measured(void **)
{
    double largest = 0.0;

    for (int k = 1; k < 3; k++)
        for (int power = -8; power <= -4; power += 2) {
            RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
            RITZ_OWN(ritz_gramians) found = {0};
            const ritz_state_space *dense = NULL;

            assert_ok(spaces_rod(150, k & 1 ? 0.05 : 0.0, k & 2, &rod));
            assert_ok(ritz_state_space_dense(&rod, &made, &dense));
            assert_ok(
                ritz_gramians_space_projection(&rod, pow(10.0, power), &found));
            assert_true(found.residual[0] <= pow(10.0, power));
            assert_near(equation_norm(dense, &found.Zc), found.residual[0],
                        1e-12);
            largest = fmax(largest, found.residual[0]);
        }
    assert_true(largest > 1e-6);
}

/* x' = -a x + b u, y = c x: W_c = b^2 / 2a, W_o = c^2 / 2a. */
static void a_single_state_has_its_closed_form(void **)
{
    const double a = -0.3, b = 2.0, c = 5.0;
    const spaces_rows rows = {1, 1, 1, &a, &b, &c, NULL, NULL};
    RITZ_OWN(ritz_state_space) one = {0};
    RITZ_OWN(ritz_gramians) found = {0};

    assert_ok(spaces_make(&rows, &one));
    assert_ok(
        ritz_gramians_of_space_by(&one, RITZ_ENGINE_PROJECTION, NULL, &found));
    assert_near(ritz_dense_dot(&found.Zc, 0, &found.Zc, 0), b * b / 0.6,
                64.0 * DBL_EPSILON * b * b / 0.6);
    assert_near(ritz_dense_dot(&found.Zo, 0, &found.Zo, 0), c * c / 0.6,
                64.0 * DBL_EPSILON * c * c / 0.6);
}

/* A chain as [u; u'] is stable and not dissipative. */
static void projection_refuses_what_it_may_make_unstable(void **)
{
    RITZ_OWN(ritz_state_space) chains = {0};
    ritz_gramians none = {0};

    assert_ok(spaces_chains(1, 30, false, &chains));
    assert_fails(
        ritz_gramians_of_space_by(&chains, RITZ_ENGINE_PROJECTION, NULL, &none),
        RITZ_ERR_ARGUMENT, "E and -(A + A') are not both definite");
}

static void a_sparse_model_takes_adi_by_itself(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
    RITZ_OWN(ritz_gramians) thin = {0}, full = {0};
    const ritz_state_space *dense = NULL;

    assert_ok(spaces_rod(60, 0.0, true, &rod));
    assert_ok(ritz_gramians_of_space(&rod, &thin));
    assert_non_null(strstr(thin.engine, "ADI"));
    assert_ok(ritz_state_space_dense(&rod, &made, &dense));
    assert_ok(ritz_gramians_of_space(dense, &full));
    assert_non_null(strstr(full.engine, "SLICOT"));
}

/* ADI stops at a residual of 1e-10 |B B'|; Hankel values agreed to 1e-8. */
#define RESIDUAL 1e-8

/* Both engines find the same Hankel values and decouple as many states. */
static void compare_engines(const ritz_state_space *sparse, int64_t decoupled,
                            double tolerance)
{
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_gramians) thin = {0}, full = {0};
    RITZ_OWN(ritz_dense) WET = {0}, ET = {0};
    const ritz_state_space *dense = NULL;
    double *a = NULL, *b = NULL;
    int64_t count_a = 0, count_b = 0;

    assert_ok(ritz_state_space_dense(sparse, &made, &dense));
    assert_ok(
        ritz_gramians_of_space_by(sparse, RITZ_ENGINE_LOW_RANK, NULL, &thin));
    assert_ok(ritz_gramians_of_space_by(dense, RITZ_ENGINE_DENSE, NULL, &full));
    assert_int_equal(full.T.ncol, decoupled);
    assert_int_equal(thin.T.ncol, decoupled);
    assert_int_equal(thin.W.ncol, decoupled);
    assert_ok(dense->E.val ? ritz_dense_mul(&dense->E, &thin.T, &ET)
                           : ritz_dense_copy(&thin.T, &ET));
    assert_ok(ritz_dense_mul_tn(&thin.W, &ET, &WET));
    for (int64_t j = 0; j < decoupled; j++)
        for (int64_t i = 0; i < decoupled; i++)
            assert_near(ritz_dense_col(&WET, j)[i], i == j, 1e-10);
    assert_ok(ritz_gramians_hankel(&thin, &count_a, &a));
    assert_ok(ritz_gramians_hankel(&full, &count_b, &b));
    for (int i = 0; i < 8; i++)
        assert_near(a[i], b[i], tolerance * b[0]);
    free(a);
    free(b);
}

/* A rod that loses no heat at its ends has a pole at 0, whose right and left
   vectors differ with wind. */
static void a_pole_at_0_is_decoupled(void **)
{
    for (int k = 0; k < 4; k++) {
        RITZ_OWN(ritz_state_space) rod = {0};
        const double wind = k & 1 ? 0.05 : 0.0;

        assert_ok(spaces_rod(60, wind, k & 2, &rod));
        rod.sA.val[0] = -1.0 - wind;
        rod.sA.val[rod.sA.colptr[60] - 1] = -1.0 + wind;
        compare_engines(&rod, 1, RESIDUAL);
    }
}

/* Two free chains of masses, springs and dampers have two double poles at 0,
   each with a single eigenvector. */
static void double_poles_of_free_bodies_are_decoupled(void **)
{
    for (int mass = 0; mass < 2; mass++) {
        RITZ_OWN(ritz_state_space) chain = {0};

        assert_ok(spaces_chains(2, 20, mass, &chain));
        compare_engines(&chain, 4, RESIDUAL);
    }
}

/* A damper to the ground moves one of the two poles at 0 of a free chain. */
static void a_damped_rigid_motion_leaves_one_pole(void **)
{
    RITZ_OWN(ritz_state_space) chain = {0};

    assert_ok(spaces_chains(1, 20, false, &chain));
    for (int64_t p = chain.sA.colptr[20]; p < chain.sA.colptr[21]; p++)
        if (chain.sA.rowind[p] == 20)
            chain.sA.val[p] -= 0.3;
    compare_engines(&chain, 1, RESIDUAL);
}

/* A pole at -2e-9 is no pole at 0. Rounding moves it by some eps |A| = 1e-15,
   so that its Gramian is known to a relative 1e-6. */
static void a_slow_pole_is_no_pole_at_0(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};

    assert_ok(spaces_rod(60, 0.05, false, &rod));
    rod.sA.val[0] = -1.05;
    rod.sA.val[rod.sA.colptr[60] - 1] = -0.95 - 1e-7;
    compare_engines(&rod, 0, 1e-6);
}

/* An unstable pole is left to the dense engine. */
static void an_unstable_pole_goes_to_the_dense_engine(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_gramians) g = {0}, none = {0};

    assert_ok(spaces_rod(60, 0.0, false, &rod));
    rod.sA.val[0] = 0.5;
    assert_int_equal(
        ritz_gramians_of_space_by(&rod, RITZ_ENGINE_LOW_RANK, NULL, &none),
        RITZ_ERR_CONVERGENCE);
    assert_ok(ritz_gramians_of_space(&rod, &g));
    assert_int_equal(g.T.ncol, 1);
}

/* The first four Hankel values of two pairs of Gramians, to 1e-3 of the
   largest. */
static void assert_same_values(const ritz_gramians *all,
                               const ritz_gramians *part)
{
    double *a = NULL, *b = NULL;
    int64_t count = 0;

    assert_ok(ritz_gramians_hankel(all, &count, &a));
    assert_ok(ritz_gramians_hankel(part, &count, &b));
    for (int i = 0; i < 4; i++)
        assert_near(a[i], b[i], 1e-3 * a[0]);
    free(a);
    free(b);
}

/* Gramians over a band leave out rigid motion, as those over all frequencies
   do. */
static void a_band_from_0_may_have_a_pole_at_0(void **)
{
    static const double band[] = {0.0, 40.0};
    RITZ_OWN(ritz_state_space) chain = {0};
    RITZ_OWN(ritz_gramians) all = {0}, part = {0};

    assert_ok(spaces_chains(1, 6, false, &chain));
    assert_ok(ritz_gramians_of_space(&chain, &all));
    assert_ok(ritz_gramians_of_space_by(&chain, RITZ_ENGINE_AUTO, band, &part));
    assert_int_equal(part.T.ncol, 2);
    assert_same_values(&all, &part);
}

/* x' = -a x + b u has the Gramian b^2 / (pi a) (atan(w2 / a) - atan(w1 /
   a)). */
static void a_band_of_one_state_has_its_closed_form(void **)
{
    static const double a[] = {-3.0}, b[] = {2.0}, c[] = {5.0};
    static const spaces_rows rows = {1, 1, 1, a, b, c, NULL, NULL};
    const double pi = acos(-1.0), band[] = {0.2, 1.5};
    const double arc =
        (atan(2.0 * pi * 1.5 / 3.0) - atan(2.0 * pi * 0.2 / 3.0)) / (3.0 * pi);
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    double *sigma = NULL;
    int64_t count = 0;

    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space_by(&model, RITZ_ENGINE_AUTO, band, &g));
    assert_ok(ritz_gramians_hankel(&g, &count, &sigma));
    assert_near(sigma[0], 2.0 * 5.0 * arc, 1e-8);
    free(sigma);
}

/* A mode of 1 Hz with 0.1 % damping has nearly all of its Gramian within 0 to
   50 Hz: b^2 / (4 zeta w^3) of a displacement. */
static void a_narrow_peak_within_a_band_is_found(void **)
{
    const double pi = acos(-1.0), w = 2.0 * pi, zeta = 1e-3;
    const double A[] = {0.0, 1.0, -w * w, -2.0 * zeta * w};
    static const double B[] = {0.0, 1.0}, C[] = {1.0, 0.0};
    const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    static const double band[] = {0.0, 50.0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    double sum = 0.0;

    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_gramians_of_space_by(&model, RITZ_ENGINE_AUTO, band, &g));
    for (int64_t j = 0; j < g.Zc.ncol; j++)
        sum += ritz_dense_col(&g.Zc, j)[0] * ritz_dense_col(&g.Zc, j)[0];
    /* beyond the band lies 4 zeta / (3 pi) (w / (50 w))^3 = 3e-9 of it */
    assert_near(sum * 4.0 * zeta * w * w * w, 1.0, 1e-7);
}

static void all_frequencies_are_the_limit_of_a_band(void **)
{
    static const double band[] = {0.0, 400.0};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_gramians) all = {0}, part = {0};

    assert_ok(spaces_rod(40, 0.05, true, &rod));
    assert_ok(ritz_gramians_of_space(&rod, &all));
    assert_ok(ritz_gramians_of_space_by(&rod, RITZ_ENGINE_AUTO, band, &part));
    assert_same_values(&all, &part);
}

static void wrong_requests_are_refused(void **)
{
    static const double A[] = {0.0, 1.0, -4.0, 0.0};
    static const double B[] = {0.0, 1.0}, C[] = {1.0, 0.0};
    static const spaces_rows rows = {2, 1, 1, A, B, C, NULL, NULL};
    static const double none_at_all[] = {2.0, 1.0}, wide[] = {0.0, 5.0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) none = {0};

    assert_ok(spaces_make(&rows, &model));
    assert_fails(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_MODAL, NULL, &none),
        RITZ_ERR_ARGUMENT, "its engines are dense, low-rank and projection");
    assert_fails(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_DENSE, wide, &none),
        RITZ_ERR_ARGUMENT, "leave out --engine");
    assert_fails(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_AUTO, none_at_all, &none),
        RITZ_ERR_ARGUMENT, "a band is from 0 Hz");
    assert_int_equal(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_AUTO, wide, &none),
        RITZ_ERR_CONVERGENCE); /* undamped pole at 0.318 Hz */
}

static ritz_status make(const ritz_state_space *model, const double *band)
{
    RITZ_OWN(ritz_gramians) g = {0};

    return ritz_gramians_of_space_by(
        model, band ? RITZ_ENGINE_AUTO : RITZ_ENGINE_LOW_RANK, band, &g);
}

static ritz_status project(const ritz_state_space *model)
{
    RITZ_OWN(ritz_gramians) g = {0};

    return ritz_gramians_of_space_by(model, RITZ_ENGINE_PROJECTION, NULL, &g);
}

static void every_allocation_may_fail(void **)
{
    static const double band[] = {0.0, 0.01};
    RITZ_OWN(ritz_state_space) rod = {0}, chain = {0};

    assert_ok(spaces_rod(8, 0.1, true, &rod));
    assert_ok(spaces_chains(1, 3, false, &chain));
    assert_survives_allocations(10, make(&rod, NULL));
    assert_survives_allocations(10, make(&chain, NULL));
    assert_survives_allocations(10, project(&rod));
    assert_survives_allocations(10, make(&rod, band));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(low_rank_values_are_those_of_dense_ones),
    cmocka_unit_test(projected_values_are_those_of_dense_ones),
    cmocka_unit_test(the_residual_of_a_projection_is_measured),
    cmocka_unit_test(a_single_state_has_its_closed_form),
    cmocka_unit_test(projection_refuses_what_it_may_make_unstable),
    cmocka_unit_test(a_sparse_model_takes_adi_by_itself),
    cmocka_unit_test(a_pole_at_0_is_decoupled),
    cmocka_unit_test(double_poles_of_free_bodies_are_decoupled),
    cmocka_unit_test(a_damped_rigid_motion_leaves_one_pole),
    cmocka_unit_test(a_slow_pole_is_no_pole_at_0),
    cmocka_unit_test(an_unstable_pole_goes_to_the_dense_engine),
    cmocka_unit_test(a_band_from_0_may_have_a_pole_at_0),
    cmocka_unit_test(a_band_of_one_state_has_its_closed_form),
    cmocka_unit_test(a_narrow_peak_within_a_band_is_found),
    cmocka_unit_test(all_frequencies_are_the_limit_of_a_band),
    cmocka_unit_test(wrong_requests_are_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(gramians_sparse, tests, NULL, NULL)
