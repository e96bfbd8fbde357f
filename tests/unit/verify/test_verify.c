#include "testing.h"

#include "frame.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

static const ritz_verify_request plain = RITZ_VERIFY_NONE;
static const ritz_estimate_request usual = {0};

/* Beam of 8 elements: force and displacement at the tip, one seen halfway. */
static void open_beam(bool clamped, ritz_component *beam)
{
    int64_t in = 0;
    int64_t seen[2];

    assert_ok(
        frame_component(8, 0.5, &frame_mcdaniel, clamped, false, 1, beam));
    in = beam->num_dofs - 2;
    seen[0] = in;
    seen[1] = in - 9;
    assert_ok(frame_io(beam, 1, &in, 2, seen));
}

/* Its lowest `modes` eigenvectors as a basis, turned among themselves. */
static void truncate_beam(const ritz_component *beam, int64_t modes,
                          ritz_basis *basis)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    dense_modes(beam, &pairs);
    assert_ok(ritz_basis_new(beam->num_dofs, modes, basis));
    memcpy(basis->T.val, pairs.Phi.val,
           (size_t)(basis->T.nrow * modes) * sizeof(double));
}

/* A basis of exact modes: all but what they leave out is exact. */
static void exact_modes_have_no_error_but_in_the_gain(void **)
{
    for (int clamped = 0; clamped < 2; clamped++) {
        RITZ_OWN(ritz_component) beam = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};

        open_beam(clamped, &beam);
        truncate_beam(&beam, 8, &basis);
        assert_ok(ritz_reduce(&beam, &basis, &reduced));
        assert_ok(verify_reduced(&beam, &reduced, &plain, &found));
        /* eps lambda_max / lambda_1 of this beam is 1e-9 */
        assert_near(find_measure(&found, "frequency-relative")->value, 0.0,
                    1e-8);
        assert_near(find_measure(&found, "mac")->value, 1.0, 1e-10);
        assert_near(find_measure(&found, "missing-modes")->value, 0.0, 0.0);
        assert_near(find_measure(&found, "extra-modes")->value, 0.0, 0.0);
        assert_true(find_measure(&found, "static-gain-relative")->value > 1e-6);
        assert_true(find_measure(&found, "static-gain-relative")->value < 0.1);
        assert_true(find_measure(&found, "response-relative")->value < 0.1);
        assert_non_null(strstr(find_measure(&found, "response-relative")->where,
                               "modal 0.01 assumed"));
        if (!clamped)
            assert_true(find_measure(&found, "rigid-hertz")->value < 1e-6);
    }
}

/* The identity is a basis without any error. */
static void the_whole_space_has_no_error_at_all(void **)
{
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    open_beam(true, &beam);
    request.band_hz[1] = 0.3;
    request.damping = (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 1e-3};
    request.limit[RITZ_MEASURE_RESPONSE] = 1e-6;
    assert_ok(ritz_basis_new(beam.num_dofs, beam.num_dofs, &basis));
    for (int64_t k = 0; k < beam.num_dofs; k++)
        ritz_dense_col(&basis.T, k)[k] = 1.0;
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    assert_ok(verify_reduced(&beam, &reduced, &request, &found));
    /* frequencies to 1e-9, over zeta = 1e-3 at a peak */
    assert_near(find_measure(&found, "response-relative")->value, 0.0, 1e-6);
    assert_true(ritz_measure_holds(find_measure(&found, "response-relative")));
    assert_near(find_measure(&found, "static-gain-relative")->value, 0.0, 1e-8);
    assert_near(find_measure(&found, "damping-relative")->value, 0.0, 1e-12);
}

/* Mode 2 is dropped: it is missing, named, and no other takes its place. */
static void a_mode_that_was_left_out_is_missing_by_name(void **)
{
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_reduced reduced = {0};
    ritz_measures found = {0};

    open_beam(true, &beam);
    truncate_beam(&beam, 6, &basis);
    memcpy(ritz_dense_col(&basis.T, 1), ritz_dense_col(&basis.T, 5),
           (size_t)beam.num_dofs * sizeof(double));
    basis.T.ncol = 5;
    basis.columns.count = 5;
    request.band_hz[1] = 0.1;
    request.limit[RITZ_MEASURE_FREQUENCY] = 1e-3;
    for (int with_shapes = 1; with_shapes >= 0; with_shapes--) {
        assert_ok(ritz_reduce(&beam, &basis, &reduced));
        if (!with_shapes)
            ritz_dense_free(&reduced.T);
        assert_ok(verify_reduced(&beam, &reduced, &request, &found));
        assert_near(find_measure(&found, "missing-modes")->value, 1.0, 0.0);
        assert_non_null(
            strstr(find_measure(&found, "missing-modes")->where, "mode 2,"));
        assert_false(ritz_measure_holds(find_measure(&found, "missing-modes")));
        assert_true(
            ritz_measure_holds(find_measure(&found, "frequency-relative")));
        ritz_measures_free(&found);
        ritz_reduced_free(&reduced);
    }
}

/* Two unit masses and a unit spring. */
static void the_gain_of_one_flexible_mode_is_one_over_its_stiffness(void **)
{
    double k[] = {1.0, -1.0, -1.0, 1.0};
    double m[] = {1.0, 0.0, 0.0, 1.0};
    const ritz_dense K = {2, 2, k};
    const ritz_dense M = {2, 2, m};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_dense) G = {0};

    assert_ok(ritz_io_new(2, 1, 1, &io));
    io.B.val[0] = io.C.val[0] = 1.0;
    assert_ok(ritz_static_gain(&K, &M, &io, 0, &G));
    assert_near(G.val[0], 0.25, 1e-15); /* phi = 1/sqrt 2, lambda = 2 */
    ritz_dense_free(&G);
    /* The rigid motion on a weak spring: compliance, unless told what it is. */
    k[0] += 1e-6;
    k[3] += 1e-6;
    assert_ok(ritz_static_gain(&K, &M, &io, 0, &G));
    assert_true(G.val[0] > 1e5);
    ritz_dense_free(&G);
    assert_ok(ritz_static_gain(&K, &M, &io, 1, &G));
    assert_near(G.val[0], 0.25, 1e-6);
}

/* |theta - lambda| <= eps (lambda - sigma): checked against the truth. */
static void estimates_hold_and_vanish_for_exact_modes(void **)
{
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    open_beam(true, &beam);
    truncate_beam(&beam, 6, &basis);
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    assert_ok(ritz_estimate(&beam, &basis, &usual, &reduced));
    /* rounding of K x, eps lambda_max / lambda_1 */
    assert_near(
        find_measure(&reduced.estimates, "frequency-relative-bound")->value,
        0.0, 1e-5);
    ritz_reduced_free(&reduced);
    for (int64_t i = 0; i < beam.num_dofs; i++)
        for (int64_t j = 0; j < 6; j++)
            ritz_dense_col(&basis.T, j)[i] *= 1.0 + 0.01 * (double)(i % 3);
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    assert_ok(ritz_estimate(&beam, &basis, &usual, &reduced));
    assert_ok(verify_reduced(&beam, &reduced, &plain, &found));
    assert_true(
        find_measure(&reduced.estimates, "frequency-relative-bound")->value >=
        find_measure(&found, "frequency-relative")->value);
    assert_non_null(find_measure(&reduced.estimates, "mode-1"));
}

static void other_models_are_refused_in_words(void **)
{
    ritz_verify_request request = plain;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_measures found = {0};

    open_beam(true, &beam);
    truncate_beam(&beam, 4, &basis);
    assert_ok(ritz_reduce(&beam, &basis, &reduced));
    request.band_hz[0] = 2.0;
    request.band_hz[1] = 1.0;
    assert_fails(verify_reduced(&beam, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT, "a band from 2 to 1 Hz");
    beam.io.input[0][0] = 'v';
    assert_fails(verify_reduced(&beam, &reduced, &plain, &found),
                 RITZ_ERR_ARGUMENT, "input 1 is 'v1'");
    reduced.num_dofs--;
    assert_fails(verify_reduced(&beam, &reduced, &plain, &found),
                 RITZ_ERR_ARGUMENT, "comes from 23 dofs");
}

static void limits_hold_from_the_right_side(void **)
{
    const ritz_measure mac = {.name = "mac", .value = 0.9, .limit = 0.95};
    const ritz_measure off = {
        .name = "frequency-relative", .value = 0.9, .limit = 0.95};
    const ritz_measure none = {.name = "mac", .value = 0.1, .limit = nan("")};

    assert_false(ritz_measure_holds(&mac));
    assert_true(ritz_measure_holds(&off));
    assert_true(ritz_measure_holds(&none));
}

/* What verify_once borrows. */
typedef struct pair {
    ritz_component beam;
    ritz_basis basis;
    ritz_reduced reduced;
} pair;

static ritz_status verify_once(pair *p)
{
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_measures) found = {0};

    RITZ_TRY(verify_reduced(&p->beam, &p->reduced, &plain, &found));
    RITZ_TRY(ritz_estimate(&p->beam, &p->basis, &usual, &p->reduced));
done:
    return status;
}

static void verifying_survives_every_allocation(void **)
{
    const int64_t row = 1;
    pair p = {0};

    assert_ok(
        frame_component(2, 0.5, &frame_mcdaniel, true, false, 1, &p.beam));
    assert_ok(frame_io(&p.beam, 1, &row, 1, &row));
    truncate_beam(&p.beam, 4, &p.basis);
    assert_ok(ritz_reduce(&p.beam, &p.basis, &p.reduced));
    assert_survives_every_allocation(verify_once(&p));
    ritz_reduced_free(&p.reduced);
    ritz_basis_free(&p.basis);
    ritz_component_free(&p.beam);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(exact_modes_have_no_error_but_in_the_gain),
    cmocka_unit_test(the_whole_space_has_no_error_at_all),
    cmocka_unit_test(a_mode_that_was_left_out_is_missing_by_name),
    cmocka_unit_test(the_gain_of_one_flexible_mode_is_one_over_its_stiffness),
    cmocka_unit_test(estimates_hold_and_vanish_for_exact_modes),
    cmocka_unit_test(other_models_are_refused_in_words),
    cmocka_unit_test(limits_hold_from_the_right_side),
    cmocka_unit_test(verifying_survives_every_allocation),
};

TEST_MODULE(verify, tests, NULL, NULL)
