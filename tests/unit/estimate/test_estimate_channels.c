/*
 * Bounds of responses: each channel relative to its own maximum, and the cause
 * of a bound.
 */
#include "testing.h"

#include "frame.h"
#include "masses.h"
#include "project.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <math.h>
#include <string.h>

/* The bound of the response of a model reduced by a method with `modes`
   modes. */
static void bound_of(const ritz_component *full, const ritz_method *method,
                     ritz_dofs attached, int64_t modes,
                     const ritz_estimate_request *asked, ritz_reduced *reduced,
                     ritz_measure *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};

    request.component = full;
    request.attached = attached;
    request.modes = modes;
    assert_ok(ritz_basis_make(method, &request, &basis));
    assert_ok(ritz_reduce(full, &basis, reduced));
    assert_ok(ritz_estimate(full, &basis, asked, reduced));
    *out = *find_measure(&reduced->estimates, "response-relative-bound");
}

/* Output i in another unit: row i of C times `by`. */
static void scale_output(int64_t i, double by, ritz_io *io)
{
    for (int64_t j = 0; j < io->C.ncol; j++)
        ritz_dense_col(&io->C, j)[i] *= by;
}

/* The error of output i alone, as ritz-verify measures it. */
static double error_of_output(const ritz_component *full,
                              const ritz_reduced *reduced, int64_t i,
                              const ritz_damping *damping, double to_hz)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_measures) found = {0};
    ritz_component one = *full; /* borrowed */
    ritz_reduced other = *reduced;

    request.band_hz[1] = to_hz;
    request.damping = *damping;
    /* other outputs times 1e-30 do not contribute to the measure */
    for (int64_t k = 0; k < one.io.num_outputs; k++)
        if (k != i) {
            scale_output(k, 1e-30, &one.io);
            scale_output(k, 1e-30, &other.io);
        }
    assert_ok(verify_reduced(&one, &other, &request, &found));
    for (int64_t k = 0; k < one.io.num_outputs; k++)
        if (k != i) {
            scale_output(k, 1e30, &one.io);
            scale_output(k, 1e30, &other.io);
        }
    return find_measure(&found, "response-relative")->value;
}

/* A clamped beam with a force at its tip. Outputs are the deflection and the
   rotation of the tip, and the deflection near the clamp, which is small. */
static void open_beam(ritz_component *beam)
{
    int64_t in = 0, seen[3];

    assert_ok(frame_component(12, 0.5, &frame_mcdaniel, true, false, 1, beam));
    in = beam->num_dofs - 2;
    seen[0] = in;
    seen[1] = in + 1;
    seen[2] = 1;
    assert_ok(frame_io(beam, 1, &in, 3, seen));
}

/* Each output's bound is relative to its own maximum, so that its unit does not
   matter. */
static void units_do_not_change_a_bound(void **)
{
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
    double bound[3];

    assert_ok(ritz_damping_parse("modal 0.01", &request.damping));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_component) beam = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        ritz_measure found = {0};

        open_beam(&beam);
        scale_output(1, k == 1 ? 1e3 : 1.0, &beam.io);
        scale_output(2, k == 2 ? 1e6 : 1.0, &beam.io);
        bound_of(&beam, &ritz_method_craig_bampton, (ritz_dofs){3, attached},
                 12, &request, &reduced, &found);
        bound[k] = found.value;
    }
    /* rounding of sums over modes, which also moves where intervals are
       halved */
    assert_near(bound[1], bound[0], 1e-6 * bound[0]);
    assert_near(bound[2], bound[0], 1e-6 * bound[0]);
}

/* Row i of A times by[i]; scale_both does the same to its columns. */
static void scale_rows(const double *by, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *= by[i];
}

static void scale_both(const double *by, ritz_sparse *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            A->val[p] *= by[A->rowind[p]] * by[j];
}

/*
 * The beam with lengths in units of 1 / `length` m, so that 1e3 means mm and N
 * mm. Inputs are a force and a moment at the tip; outputs are deflection and
 * rotation there and the deflection near the clamp. Dofs become u = S u', and K
 * becomes S' K S.
 */
static void open_beam_of(double length, ritz_component *beam)
{
    RITZ_OWN_ARRAY double *unit = NULL;
    int64_t n = 0, in[2], seen[3];

    assert_ok(frame_component(12, 0.5, &frame_mcdaniel, true, false, 1, beam));
    n = beam->num_dofs;
    in[0] = seen[0] = n - 2; /* transverse */
    in[1] = seen[1] = n - 1; /* rotation */
    seen[2] = 1;
    assert_ok(frame_io(beam, 2, in, 3, seen));
    unit = ritz_zalloc(n, sizeof *unit);
    assert_non_null(unit);
    for (int64_t i = 0; i < n; i++)
        unit[i] = beam->dof[i].component < 4 ? 1.0 / length : 1.0;
    scale_both(unit, &beam->K);
    scale_both(unit, &beam->M);
    scale_rows(unit, &beam->io.B);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < 3; i++) /* in the new unit of length */
            ritz_dense_col(&beam->io.C, j)[i] *=
                unit[j] * (i == 1 ? 1.0 : length);
    for (int64_t i = 0; i < n; i++) /* 1 N m is `length` units of moment */
        ritz_dense_col(&beam->io.B, 1)[i] /= length;
}

/* With forces and moments as inputs, and deflections and rotations as outputs,
   the bound, its channel and its cause are the same in all units of length. */
static void moments_in_other_units_change_no_bound(void **)
{
    static const double length[] = {1.0, 1e3, 1e-3};
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
    ritz_measure first = {0};

    assert_ok(ritz_damping_parse("modal 0.01", &request.damping));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_component) beam = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        ritz_measure found = {0};

        open_beam_of(length[k], &beam);
        bound_of(&beam, &ritz_method_craig_bampton, (ritz_dofs){3, attached},
                 12, &request, &reduced, &found);
        if (k == 0)
            first = found;
        /* rounding of sums over modes, which also moves where intervals are
           halved */
        assert_near(found.value, first.value, 1e-6 * first.value);
        assert_string_equal(found.where, first.where);
        assert_string_equal(found.cause, first.cause);
    }
}

/* The bound is at least the error of every output, and at most ten times the
   largest of them. */
static void a_bound_is_of_the_worst_channel(void **)
{
    int64_t attached[] = {0, 1, 2};
    ritz_estimate_request request = {.band_hz = {0.0, 0.2}};
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_measure found = {0};
    double worst = 0.0;

    assert_ok(ritz_damping_parse("modal 0.01", &request.damping));
    open_beam(&beam);
    bound_of(&beam, &ritz_method_craig_bampton, (ritz_dofs){3, attached}, 12,
             &request, &reduced, &found);
    for (int64_t i = 0; i < 3; i++)
        worst = fmax(
            worst, error_of_output(&beam, &reduced, i, &request.damping, 0.2));
    if (!(found.value >= worst) || !(found.value <= 10.0 * worst))
        fail_msg("bound %.3e of %.3e", found.value, worst);
}

/*
 * Input and output lie at opposite ends of a long chain: each residual is
 * large, and the product of the two is small. No mode is missing.
 */
static void far_channels_are_bounded_within_ten(void **)
{
    enum { MASSES = 40 };
    static const char *const damping[] = {"modal 0.01", "modal 0.1",
                                          "rayleigh 0.1 1e-4"};
    int64_t attached[] = {MASSES - 1};
    const ritz_span span = {.modes = 4};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    ritz_estimate_request request = {0};

    assert_ok(spring_chain(MASSES, false, &chain));
    ritz_io_free(&chain.io);
    assert_ok(ritz_io_new(MASSES, 1, 1, &chain.io));
    chain.io.B.val[MASSES - 1] = 1.0;
    chain.io.C.val[1] = 1.0;
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &span, &full));
    request.band_hz[1] = 1.01 * ritz_eigen_hertz(full.lambda[3]);
    for (size_t k = 0; k < sizeof damping / sizeof *damping; k++) {
        RITZ_OWN(ritz_reduced) reduced = {0};
        ritz_measure found = {0};
        double error = 0.0;

        assert_ok(ritz_damping_parse(damping[k], &request.damping));
        bound_of(&chain, &ritz_method_macneal_rubin, (ritz_dofs){1, attached},
                 10, &request, &reduced, &found);
        error = error_of_output(&chain, &reduced, 0, &request.damping,
                                request.band_hz[1]);
        if (!(found.value >= error) || !(found.value <= 10.0 * error))
            fail_msg("%s: bound %.3e of %.3e, %s", damping[k], found.value,
                     error, found.where);
    }
}

/* Two bodies without a connection: channels from one to the other have no
   response, and add nothing to the bound. */
static void channels_without_a_response_add_nothing_to_the_bound(void **)
{
    enum { N = 4 };
    const double lambda[N] = {1.0, 2.0, 30.0, 40.0};
    ritz_estimate_request request = {.band_hz = {0.0, 0.3}};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_measure *found = NULL;

    assert_ok(ritz_damping_parse("modal 0.05", &request.damping));
    assert_ok(masses_apart(N, lambda, NULL, &body));
    ritz_io_free(&body.io);
    assert_ok(ritz_io_new(N, 2, 2, &body.io));
    for (int64_t i = 0; i < N; i++) { /* body 1: dofs 0, 2; body 2: 1, 3 */
        ritz_dense_col(&body.io.B, i % 2)[i] = 1.0;
        ritz_dense_col(&body.io.C, i)[i % 2] = 1.0;
    }
    assert_ok(ritz_basis_new(N, 2, &basis));
    for (int64_t j = 0; j < 2; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    found = find_measure(&reduced.estimates, "response-relative-bound");
    /* the missing mode's 1 / (30 - w^2), relative to the peak 1 / (2 zeta) =
       10 */
    assert_true(found->value > 1e-3 && found->value < 1e-2);
}

/*
 * Two bodies without a connection, of which the reduced model couples the first
 * mode of one with the second mode of the other. That response is no larger
 * than its error, and no scale for a relative bound.
 */
static void a_response_below_its_error_is_no_scale(void **)
{
    enum { N = 4 };
    const double lambda[N] = {1.0, 2.0, 30.0, 40.0};
    const double mixed = 1e-3;
    ritz_estimate_request request = {.band_hz = {0.0, 0.3}};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_measure *found = NULL;

    assert_ok(ritz_damping_parse("modal 0.05", &request.damping));
    assert_ok(masses_apart(N, lambda, NULL, &body));
    ritz_io_free(&body.io);
    assert_ok(ritz_io_new(N, 2, 2, &body.io));
    for (int64_t i = 0; i < N; i++) { /* body 1: dofs 0, 2; body 2: 1, 3 */
        ritz_dense_col(&body.io.B, i % 2)[i] = i < 2 ? 1.0 : 0.0;
        ritz_dense_col(&body.io.C, i)[i % 2] = 1.0;
    }
    assert_ok(ritz_basis_new(N, 2, &basis));
    for (int64_t j = 0; j < 2; j++) {
        ritz_dense_col(&basis.T, j)[j] = 1.0;
        ritz_dense_col(&basis.T, j)[N - 1 - j] = mixed;
    }
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    found = find_measure(&reduced.estimates, "response-relative-bound");
    /* of the order of `mixed`; errors within a body are of the order of its
       square */
    assert_non_null(strstr(found->where, "hardly coupled"));
    if (!(found->value > 0.01 * mixed && found->value < 10.0 * mixed))
        fail_msg("%.3e at %s: %s", found->value, found->where, found->cause);
}

/* If the only channel may have no response, the bound is infinite and names a
   cause. */
static void a_channel_that_may_be_zero_has_no_finite_bound(void **)
{
    enum { N = 2 };
    const double lambda[N] = {1.0, 2.0};
    ritz_estimate_request request = {.band_hz = {0.0, 0.3}};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_measure *found = NULL;

    assert_ok(ritz_damping_parse("modal 0.05", &request.damping));
    assert_ok(masses_apart(N, lambda, NULL, &body));
    ritz_io_free(&body.io);
    assert_ok(ritz_io_new(N, 1, 1, &body.io));
    body.io.B.val[0] = 1.0;
    body.io.C.val[1] = 1.0;
    assert_ok(ritz_basis_new(N, 1, &basis));
    basis.T.val[0] = 1.0;
    basis.T.val[1] = 1e-3;
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    found = find_measure(&reduced.estimates, "response-relative-bound");
    assert_true(isinf(found->value));
    assert_true(found->cause[0]);
}

/* A bound far above the error names its cause. */
static void causes_are_named(void **)
{
    enum { N = 3 };
    const double lambda[N] = {1.0, 1.7, 9.0};
    ritz_estimate_request request = {.band_hz = {0.0, 0.25}};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    const ritz_measure *found = NULL;

    /* the basis lacks the second mode, which is weakly excited */
    assert_ok(ritz_damping_parse("modal 0.01", &request.damping));
    assert_ok(masses_apart(N, lambda, NULL, &body));
    ritz_io_free(&body.io);
    assert_ok(ritz_io_new(N, 1, 1, &body.io));
    for (int64_t i = 0; i < N; i++)
        body.io.B.val[i] = body.io.C.val[i] = i == 1 ? 1e-3 : 1.0;
    assert_ok(ritz_basis_new(N, 2, &basis));
    ritz_dense_col(&basis.T, 0)[0] = 1.0;
    ritz_dense_col(&basis.T, 1)[2] = 1.0;
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    found = find_measure(&reduced.estimates, "response-relative-bound");
    if (found->value > 1e-3 && strcmp(found->cause, "missing modes") != 0)
        fail_msg("%.3e: %s", found->value, found->cause);
    /* all modes are kept exactly: only rounding is left */
    ritz_basis_free(&basis);
    ritz_reduced_free(&reduced);
    assert_ok(ritz_basis_new(N, N, &basis));
    for (int64_t j = 0; j < N; j++)
        ritz_dense_col(&basis.T, j)[j] = 1.0;
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_estimate(&body, &basis, &request, &reduced));
    found = find_measure(&reduced.estimates, "response-relative-bound");
    assert_true(found->value < 1e-11);
    assert_string_equal(found->cause, "rounding");
    assert_string_equal(
        find_measure(&reduced.estimates, "frequency-relative-bound")->cause,
        "rounding");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(units_do_not_change_a_bound),
    cmocka_unit_test(a_bound_is_of_the_worst_channel),
    cmocka_unit_test(far_channels_are_bounded_within_ten),
    cmocka_unit_test(channels_without_a_response_add_nothing_to_the_bound),
    cmocka_unit_test(causes_are_named),
    cmocka_unit_test(moments_in_other_units_change_no_bound),
    cmocka_unit_test(a_response_below_its_error_is_no_scale),
    cmocka_unit_test(a_channel_that_may_be_zero_has_no_finite_bound),
};

TEST_MODULE(estimate_channels, tests, NULL, NULL)
