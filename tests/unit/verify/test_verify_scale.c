/*
 * A model whose stiffness is 2^n times as large has frequencies 2^(n/2) times
 * as high: powers of two round nothing, and the errors are the same.
 */
#include "testing.h"

#include "frame.h"
#include "project.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

/* Free beam of 8 elements of stiffness 2^power, by its lowest 7 modes. */
static void open_beam(int power, ritz_component *beam, ritz_reduced *reduced)
{
    enum { MODES = 7 };
    const int64_t in = 1, seen = 16;
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(frame_component(8, 0.5, &frame_mcdaniel, false, false, 1, beam));
    assert_ok(frame_io(beam, 1, &in, 1, &seen));
    dense_modes(beam, &pairs);
    assert_ok(ritz_basis_new(beam->num_dofs, MODES, &basis));
    memcpy(basis.T.val, pairs.Phi.val,
           (size_t)(basis.T.nrow * MODES) * sizeof(double));
    for (int64_t k = 0; k < beam->K.colptr[beam->num_dofs]; k++)
        beam->K.val[k] = ldexp(beam->K.val[k], power);
    assert_ok(ritz_reduce(beam, &basis, reduced));
}

static void verify(int power, double to_hz, ritz_measures *found)
{
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    open_beam(power, &beam, &reduced);
    request.band_hz[1] = ldexp(to_hz, power / 2);
    request.damping = (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    assert_ok(verify_reduced(&beam, &reduced, &request, found));
}

/* The fifth flexible mode, which the basis has not, is in the band. */
static double past_the_basis(void)
{
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double hertz = 0.0;

    open_beam(0, &beam, &reduced);
    dense_modes(&beam, &pairs);
    hertz = 1.1 * ritz_eigen_hertz(pairs.lambda[7]);
    return hertz;
}

static void errors_do_not_know_the_unit_of_time(void **)
{
    static const char *const measures[] = {
        "frequency-relative", "response-relative", "flexible-response-relative",
        "response-db", "static-gain-relative"};
    static const int powers[] = {120, 80, -80, -120};
    RITZ_OWN(ritz_measures) once = {0};
    double to_hz = past_the_basis();

    verify(0, to_hz, &once);
    assert_true(find_measure(&once, "response-relative")->value > 1e-4);
    for (size_t p = 0; p < sizeof powers / sizeof *powers; p++) {
        RITZ_OWN(ritz_measures) found = {0};

        verify(powers[p], to_hz, &found);
        for (size_t k = 0; k < sizeof measures / sizeof *measures; k++) {
            double value = find_measure(&once, measures[k])->value;

            /* measured: 0 but for what ARPACK stops at */
            assert_near(find_measure(&found, measures[k])->value, value,
                        1e-7 * value);
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(errors_do_not_know_the_unit_of_time),
};

TEST_MODULE(verify_scale, tests, NULL, NULL)
