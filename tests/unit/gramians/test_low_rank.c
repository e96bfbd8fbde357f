#include "testing.h"

#include "gramians/modes.h"
#include "mass_row.h"
#include "masses.h"

#include <ritz/basis.h>
#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { MODES = 500 };

/* Of the largest value: what a residual of 1e-10 leaves, measured 1e-9 at
 * most here. */
static const double agreement = 1e-8;

/* Values of both engines agree; the low-rank Gramians are returned. */
static ritz_gramians agree(ritz_gramians_request request)
{
    request.engine = RITZ_ENGINE_LOW_RANK;
    return gramians_like_slicot(request, agreement);
}

static void an_oscillator_has_known_values(void **state)
{
    (void)state;
    oscillators_have_closed_form(RITZ_ENGINE_LOW_RANK,
                                 64.0 * DBL_EPSILON / 1e-3);
}

/* A X E + E X A' + B B' with X = Z Z', entry by entry: 0 but for 1e-10. */
static void the_equation_is_solved(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    const ritz_gramians_request request = mass_row_rayleigh(&held, 0.2, 1e-3);
    RITZ_OWN(ritz_gramians) low = {0};
    RITZ_OWN(ritz_dense) A = {0}, AZ = {0}, R = {0}, E = {0};
    double most = 0.0;

    (void)state;
    assert_ok(ritz_gramians_low_rank(&request, &low));
    assert_ok(ritz_dense_new(2L * MASS_ROW, 2L * MASS_ROW, &A));
    for (int64_t j = 0; j < MASS_ROW; j++) {
        ritz_dense_col(&A, MASS_ROW + j)[j] = 1.0;
        for (int64_t p = held.K.colptr[j]; p < held.K.colptr[j + 1]; p++) {
            int64_t i = MASS_ROW + held.K.rowind[p];

            ritz_dense_col(&A, j)[i] -= held.K.val[p];
            ritz_dense_col(&A, MASS_ROW + j)[i] -= 1e-3 * held.K.val[p];
        }
        ritz_dense_col(&A, MASS_ROW + j)[MASS_ROW + j] -=
            0.2 * ritz_sparse_diagonal(&held.M, j);
    }
    assert_ok(ritz_dense_mul(&A, &low.Zc, &AZ));
    assert_ok(ritz_dense_mul_nt(&AZ, &low.EZc, &R));
    assert_ok(ritz_dense_mul_nt(&low.EZc, &AZ, &E));
    for (int64_t j = 0; j < 2L * MASS_ROW; j++)
        for (int64_t i = 0; i < 2L * MASS_ROW; i++) {
            double sum = ritz_dense_col(&R, j)[i] + ritz_dense_col(&E, j)[i];

            for (int64_t u = 0; u < 2 && i >= MASS_ROW && j >= MASS_ROW; u++)
                sum += ritz_dense_col(&held.io.B, u)[i - MASS_ROW] *
                       ritz_dense_col(&held.io.B, u)[j - MASS_ROW];
            most = fmax(most, fabs(sum));
        }
    /* residuals are told with 1 / mass, and masses are 1 to 2 */
    assert_near(most, 0.0, 2.0 * 1e-10 + 1e4 * DBL_EPSILON);
    assert_true(low.residual[0] <= 1e-10 && low.residual[1] <= 1e-10);
}

static void several_inputs_and_outputs_agree_with_slicot(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    ritz_gramians low = {0};

    (void)state;
    low = agree(mass_row_rayleigh(&held, 0.2, 1e-3));
    assert_int_equal(low.T.ncol, 0);
    ritz_gramians_free(&low);
    low = agree(mass_row_rayleigh(&held, 1e-3, 1e-5)); /* ratios of 1e-4 */
    ritz_gramians_free(&low);
    low = agree(mass_row_rayleigh(&held, 0.0, 1.0)); /* beyond critical */
    ritz_gramians_free(&low);
}

static void velocities_accelerations_and_limits_count(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    ritz_gramians low = {0};

    (void)state;
    ritz_dense_col(&held.io.Cv, 3)[0] = 0.7;
    ritz_dense_col(&held.io.Ca, 8)[1] = 0.2;
    ritz_dense_col(&held.io.Ca, 2)[2] = 1.0;
    held.io.limit[0] = 0.1;
    low = agree(mass_row_rayleigh(&held, 0.2, 1e-3));
    ritz_gramians_free(&low);
}

/* The same force twice, and one that is nothing: ranks do not double. */
static void dependent_inputs_are_compressed(void **state)
{
    RITZ_OWN(ritz_component) twice = {0};
    RITZ_OWN(ritz_gramians) low = {0};

    (void)state;
    assert_ok(masses_component(
        MASS_ROW, (double[MASS_ROW]){1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2},
        (double[MASS_ROW]){9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9}, NULL, &twice));
    assert_ok(masses_io(&twice, 3, (int64_t[]){4, 4, 7}, 1, (int64_t[]){1}));
    ritz_dense_col(&twice.io.B, 2)[7] = 0.0;
    low = agree(mass_row_rayleigh(&twice, 0.5, 0.05));
    assert_true(low.Zc.ncol <= 2L * MASS_ROW);
}

/* Positions and velocities of the one rigid motion, and Z without it. */
static void rigid_motion_stands_apart(void **state)
{
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    ritz_gramians low = {0};
    ritz_dense mine = {0};

    (void)state;
    for (int a = 0; a < 2; a++) { /* with a, its velocity decays */
        low = agree(mass_row_rayleigh(&body, a ? 0.1 : 0.0, 2e-3));
        assert_int_equal(low.T.ncol, 2);
        assert_int_equal(low.W.ncol, 2);
        for (int64_t j = 0; j < 2; j++)
            for (int64_t i = 0; i < 2; i++) {
                double sum = 0.0;

                for (int64_t k = 0; k < 2L * MASS_ROW; k++)
                    sum += ritz_dense_col(&low.W, i)[k] *
                           (k < MASS_ROW
                                ? 1.0
                                : ritz_sparse_diagonal(&body.M, k - MASS_ROW)) *
                           ritz_dense_col(&low.T, j)[k];
                assert_near(sum, i == j ? 1.0 : 0.0,
                            64.0 * DBL_EPSILON * MASS_ROW);
            }
        assert_ok(ritz_dense_mul_tn(&low.W, &low.EZc, &mine));
        assert_near(ritz_dense_max(&mine), 0.0,
                    1e3 * DBL_EPSILON * ritz_dense_max(&low.EZc));
        ritz_dense_free(&mine);
        ritz_gramians_free(&low);
    }
}

/* Forces in proportion to mass deform nothing. */
static void rigid_motion_alone_has_no_columns(void **state)
{
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    const ritz_gramians_request request = mass_row_rayleigh(&body, 0.0, 2e-3);
    RITZ_OWN(ritz_gramians) low = {0};
    double *sigma = NULL;
    int64_t count = -1;

    (void)state;
    for (int64_t i = 0; i < MASS_ROW; i++)
        for (int64_t j = 0; j < 2; j++)
            ritz_dense_col(&body.io.B, j)[i] = ritz_sparse_diagonal(&body.M, i);
    assert_ok(ritz_gramians_low_rank(&request, &low));
    assert_int_equal(low.Zc.ncol, 0);
    assert_true(low.Zo.ncol > 0);
    assert_ok(ritz_gramians_hankel(&low, &count, &sigma));
    assert_int_equal(count, 0);
    free(sigma);
}

/* g (e_2 e_5' - e_5 e_2') beside dashpots, which couple modes. */
static void gyroscopes_agree_with_slicot(void **state)
{
    const int64_t at[] = {0, 2, 5, 11, 5, 2};
    const int64_t to[] = {0, 2, 5, 11, 2, 5};
    const double val[] = {1.0, 0.5, 2.0, 3.0, 4.0, -4.0};
    RITZ_OWN(ritz_component) spun = mass_row(100.0);
    ritz_gramians_request request = {.component = &spun};
    ritz_gramians low = {0};

    (void)state;
    assert_ok(
        ritz_sparse_from_triplets(MASS_ROW, MASS_ROW, 6, at, to, val, &spun.D));
    low = agree(request);
    ritz_gramians_free(&low);
}

static void discrete_dampers_count(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    RITZ_OWN(ritz_gramians) low = {0};

    (void)state;
    mass_row_damper(8.0, 30.0, &held);
    low = agree(mass_row_rayleigh(&held, 0.05, 1e-3));
    assert_string_equal(low.damping, "rayleigh 0.05 0.001");
    assert_null(held.D.colptr); /* the component is as it was */
}

static void dofs_without_mass_follow(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row_massless(3);
    ritz_gramians low = {0};

    (void)state;
    low = agree(mass_row_rayleigh(&held, 0.3, 0.0));
    ritz_gramians_free(&low);
    ritz_dense_col(&held.io.Cv, 8)[1] = 0.5;
    ritz_dense_col(&held.io.Ca, 8)[0] = 0.1;
    low = agree(mass_row_rayleigh(&held, 0.3, 0.0));
    ritz_gramians_free(&low);
}

/* A diagonal model of 500 modes, 1 to 50 Hz, all of one ratio. */
static ritz_component spread(double zeta, ritz_modal *modal)
{
    ritz_component c = {.units = "none", .num_dofs = MODES};
    int64_t *own = calloc(MODES, sizeof *own);
    double *val = calloc(3 * (size_t)MODES, sizeof *val);

    assert_true(own && val);
    c.dof = calloc(MODES, sizeof *c.dof);
    modal->count = MODES;
    modal->omega = calloc(MODES, sizeof(double));
    modal->zeta = calloc(MODES, sizeof(double));
    assert_true(c.dof && modal->omega && modal->zeta);
    assert_ok(ritz_io_new(MODES, 1, 1, &c.io));
    snprintf(c.io.input[0], RITZ_NAME_SIZE, "f");
    snprintf(c.io.output[0], RITZ_NAME_SIZE, "y");
    for (int64_t k = 0; k < MODES; k++) {
        double w = 2.0 * acos(-1.0) * (1.0 + 49.0 * (double)k / (MODES - 1.0));

        own[k] = k;
        c.dof[k] = (ritz_dof){k + 1, 0};
        val[k] = 1.0;
        val[MODES + k] = w * w;
        val[2 * MODES + k] = 2.0 * zeta * w;
        modal->omega[k] = w;
        modal->zeta[k] = zeta;
        c.io.B.val[k] = 1.0 + 0.3 * cos((double)k);
        c.io.C.val[k] = sin((double)k + 1.0);
    }
    assert_ok(
        ritz_sparse_from_triplets(MODES, MODES, MODES, own, own, val, &c.M));
    assert_ok(ritz_sparse_from_triplets(MODES, MODES, MODES, own, own,
                                        val + MODES, &c.K));
    assert_ok(ritz_sparse_from_triplets(MODES, MODES, MODES, own, own,
                                        val + 2L * MODES, &c.D));
    assert_ok(ritz_component_settle(&c, false));
    assert_ok(ritz_dense_copy(&c.io.B, &modal->B));
    assert_ok(ritz_dense_copy(&c.io.C, &modal->C));
    assert_ok(ritz_dense_copy(&c.io.Cv, &modal->Cv));
    free(own);
    free(val);
    return c;
}

/* An ADI in SciPy, apart from this one, takes 34 shifts; this one 32. */
static void five_hundred_damped_modes_agree_with_closed_form(void **state)
{
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_component) many = spread(0.3, &modal);
    const ritz_gramians_request request = {.component = &many};
    RITZ_OWN(ritz_gramians) low = {0};
    double *exact = calloc(2 * (size_t)MODES, sizeof *exact);
    double *sigma = NULL;
    int64_t count = 0;

    (void)state;
    assert_non_null(exact);
    assert_ok(ritz_modal_hankel(&modal, NULL, exact));
    assert_ok(ritz_gramians_low_rank(&request, &low));
    assert_ok(ritz_gramians_hankel(&low, &count, &sigma));
    assert_true(low.Zc.ncol < 100 && low.Zo.ncol < 100);
    for (int64_t k = 0; k < 2L * MODES; k++)
        assert_near(k < count ? sigma[k] : 0.0, exact[k], agreement * exact[0]);
    free(exact);
    free(sigma);
}

static void five_hundred_light_modes_are_refused(void **state)
{
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_component) many = spread(1e-4, &modal);
    const ritz_gramians_request request = {.component = &many};
    ritz_gramians low = {0};
    const char *said = NULL;

    (void)state;
    assert_fails(ritz_gramians_low_rank(&request, &low), RITZ_ERR_CONVERGENCE,
                 "the Gramians have no low rank: after 20 shifts");
    said = strstr(ritz_error_message(), "is a ratio of about ");
    assert_non_null(said);
    /* a shift mixes modes, and tells no more than the ratio of theirs */
    assert_near(strtod(said + 20, NULL), 7.5e-5, 2.6e-5);
    assert_non_null(strstr(said, "take engine 'modal'"));
    assert_null(low.Zc.val);
}

/* D = 100 M + 0.01 K, in the files as a matrix, and by words. */
static void lf10_agrees_with_slicot(void **state)
{
    static const char *const input[] = {"in=9:0"};
    static const char *const output[] = {"out=9:0"};
    const char *folder = getenv("RITZ_EXTERNAL_DATA");
    char path[3][512], dofs[] = "/tmp/lf10.dofs.XXXXXX";
    ritz_import_request files = {
        .num_inputs = 1, .input = input, .num_outputs = 1, .output = output};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) beam = {0};
    ritz_gramians low = {0};
    FILE *file = NULL;
    int handle = -1;

    (void)state;
    if (!folder) {
        printf("no RITZ_EXTERNAL_DATA\n");
        skip();
    }
    snprintf(path[0], sizeof path[0], "%s/second_order/LF10/K.mtx", folder);
    snprintf(path[1], sizeof path[1], "%s/second_order/LF10/M.mtx", folder);
    snprintf(path[2], sizeof path[2], "%s/second_order/LF10/D.mtx", folder);
    handle = mkstemp(dofs);
    file = fdopen(handle, "w");
    assert_non_null(file);
    for (int k = 1; k <= 18; k++)
        fprintf(file, "%d 0\n", k);
    fclose(file);
    files.stiffness = path[0];
    files.mass = path[1];
    files.damping = path[2];
    files.dofs = dofs;
    assert_ok(ritz_import(&files, &beam, &report));
    remove(dofs);
    low = agree((ritz_gramians_request){.component = &beam});
    ritz_gramians_free(&low);
    ritz_sparse_free(&beam.D);
    low = agree(mass_row_rayleigh(&beam, 100.0, 0.01));
    ritz_gramians_free(&low);
}

/* K + s G with G = [0 1; -1 0]: the transpose is K - s G. */
static void transposed_solves_are_of_the_transpose(void **state)
{
    const int64_t at[] = {0, 1, 0, 1}, to[] = {0, 0, 1, 1};
    const double k[] = {2.0, -1.5, -1.0, 1.0};
    const double _Complex c[] = {1.0 + 0.5 * (double _Complex)_Complex_I};
    double _Complex x[] = {1.0, 2.0};
    RITZ_OWN(ritz_sparse) A = {0};
    const ritz_sparse *const parts[] = {&A};
    RITZ_OWN(ritz_zldl) *F = NULL;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 2, 4, at, to, k, &A));
    assert_ok(ritz_zldl_new(1, parts, &F));
    assert_ok(ritz_zldl_factor(F, c));
    assert_ok(ritz_zldl_solve(F, true, 1, x));
    /* rows of A' are columns of A: (2, -1.5) and (-1, 1) */
    assert_near(cabs(c[0] * (2.0 * x[0] - 1.5 * x[1]) - 1.0), 0.0,
                64.0 * DBL_EPSILON);
    assert_near(cabs(c[0] * (-x[0] + x[1]) - 2.0), 0.0, 64.0 * DBL_EPSILON);
    ritz_zldl_definite(F); /* as it is: no pivots change that */
    assert_ok(ritz_zldl_factor(F, c));
    x[0] = 2.0;
    x[1] = -1.0;
    assert_ok(ritz_zldl_solve(F, false, 1, x));
    assert_near(cabs(c[0] * (2.0 * x[0] - x[1]) - 2.0), 0.0,
                64.0 * DBL_EPSILON);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_oscillator_has_known_values),
    cmocka_unit_test(the_equation_is_solved),
    cmocka_unit_test(several_inputs_and_outputs_agree_with_slicot),
    cmocka_unit_test(velocities_accelerations_and_limits_count),
    cmocka_unit_test(dependent_inputs_are_compressed),
    cmocka_unit_test(rigid_motion_stands_apart),
    cmocka_unit_test(rigid_motion_alone_has_no_columns),
    cmocka_unit_test(gyroscopes_agree_with_slicot),
    cmocka_unit_test(discrete_dampers_count),
    cmocka_unit_test(dofs_without_mass_follow),
    cmocka_unit_test(five_hundred_damped_modes_agree_with_closed_form),
    cmocka_unit_test(five_hundred_light_modes_are_refused),
    cmocka_unit_test(lf10_agrees_with_slicot),
    cmocka_unit_test(transposed_solves_are_of_the_transpose),
};

TEST_MODULE(low_rank, tests, NULL, NULL)
