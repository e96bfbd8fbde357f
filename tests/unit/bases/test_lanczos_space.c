/* lanczos-one-sided of state spaces, dense and sparse: stability at every
 * order, moments, both Gramians, refusals. */
#include "testing.h"

#include "spaces.h"

#include "model/space.h"

#include <ritz/basis.h>
#include <ritz/check.h>

#include <complex.h>

enum { STATES = 60 };

typedef struct made {
    ritz_basis basis;
    ritz_state_space model;
} made;

static void made_free(made *m)
{
    ritz_basis_free(&m->basis);
    ritz_state_space_free(&m->model);
}

static ritz_request asking(const ritz_state_space *space, int64_t modes,
                           bool inverse, ritz_gramian gramian)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.space = space;
    request.modes = modes;
    request.choice.inverse = inverse;
    request.choice.gramian = gramian;
    return request;
}

static void reduce(const ritz_request *request, made *out)
{
    assert_ok(ritz_basis_make(ritz_method_find("lanczos-one-sided"), request,
                              &out->basis));
    assert_ok(ritz_reduce_space(request->space, &out->basis, &out->model));
}

static void every_order_is_stable(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made_dense = {0};
    const ritz_state_space *dense = NULL;

    assert_ok(spaces_rod(STATES, 0.05, true, &rod));
    assert_ok(ritz_state_space_dense(&rod, &made_dense, &dense));
    for (int k = 0; k < 8; k++)
        for (int64_t modes = 1; modes <= 9; modes += 2) {
            const ritz_state_space *space = k & 1 ? &rod : dense;
            const ritz_request request =
                asking(space, modes, k & 2,
                       k & 4 ? RITZ_GRAMIAN_OUTPUTS : RITZ_GRAMIAN_INPUTS);
            ritz_probe probe = {0};
            RITZ_OWN(made) m = {0};

            reduce(&request, &m);
            assert_true(m.basis.T.ncol > 0 && m.basis.T.ncol <= modes);
            assert_ok(ritz_probe_states(&m.model, &probe));
            assert_int_equal(probe.verdict, RITZ_STABLE);
        }
}

static void find_gain(const ritz_state_space *model, double _Complex *H)
{
    RITZ_OWN(ritz_pencil) pencil = {0};

    assert_ok(ritz_pencil_of_space(model, &pencil));
    assert_ok(ritz_space_transfer(model, &pencil, 0.0, H));
}

/* With A^-1 as the operator, the first block contains the static response. */
static void the_inverse_operator_keeps_the_static_gain(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made_dense = {0};
    const ritz_state_space *dense = NULL;
    double _Complex full[4];

    assert_ok(spaces_rod(STATES, 0.05, true, &rod));
    assert_ok(ritz_state_space_dense(&rod, &made_dense, &dense));
    find_gain(dense, full);
    for (int k = 0; k < 4; k++) {
        const ritz_request request =
            asking(k & 1 ? &rod : dense, 4, true,
                   k & 2 ? RITZ_GRAMIAN_OUTPUTS : RITZ_GRAMIAN_INPUTS);
        double _Complex small[4];
        RITZ_OWN(made) m = {0};

        reduce(&request, &m);
        assert_int_equal(m.basis.T.ncol, 4);
        find_gain(&m.model, small);
        /* ADI's residual of the Gramian, times |A^-1| = 400 */
        for (int i = 0; i < 4; i++)
            assert_near(cabs(small[i] - full[i]), 0.0, 1e-6 * cabs(full[0]));
    }
}

/* The reduced model's Gramian is the identity: A_r + A_r' + B_r B_r' = 0. */
static void the_reduced_gramian_is_the_identity(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(STATES, 0.05, true, &rod));
    request = asking(&rod, 6, false, RITZ_GRAMIAN_INPUTS);
    reduce(&request, &m);
    for (int64_t j = 0; j < 6; j++)
        for (int64_t i = 0; i < 6; i++) {
            double sum = ritz_dense_col(&m.model.A, j)[i] +
                         ritz_dense_col(&m.model.A, i)[j];

            for (int64_t k = 0; k < 2; k++)
                sum += ritz_dense_col(&m.model.B, k)[i] *
                       ritz_dense_col(&m.model.B, k)[j];
            /* a thousandth of the slowest decay rate, 3e-3 1/s */
            assert_near(sum, 0.0, 3e-6);
        }
}

static void a_shift_allows_models_that_are_not_stable(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_basis) none = {0};
    RITZ_OWN(made) m = {0};
    ritz_request request = {0};

    assert_ok(spaces_rod(STATES, 0.0, true, &rod));
    rod.sA.val[0] = rod.sA.val[rod.sA.colptr[STATES] - 1] = -1.0;
    request = asking(&rod, 4, true, RITZ_GRAMIAN_INPUTS);
    assert_fails(
        ritz_basis_make(ritz_method_find("lanczos-one-sided"), &request, &none),
        RITZ_ERR_ARGUMENT, "poles at 0 (1 of them) have no damping");
    request.choice.given = RITZ_USES_SHIFTS;
    request.choice.num_shifts = 1;
    request.choice.shift_hz[0] = 0.01;
    reduce(&request, &m);
    assert_int_equal(m.basis.T.ncol, 4);
    request.choice.num_shifts = 2;
    assert_fails(
        ritz_basis_make(ritz_method_find("lanczos-one-sided"), &request, &none),
        RITZ_ERR_ARGUMENT, "by one frequency");
}

static ritz_status make(const ritz_request *request)
{
    RITZ_OWN(ritz_basis) basis = {0};

    return ritz_basis_make(ritz_method_find("lanczos-one-sided"), request,
                           &basis);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made_dense = {0};
    const ritz_state_space *dense = NULL;
    ritz_request request = {0};

    assert_ok(spaces_rod(8, 0.1, true, &rod));
    assert_ok(ritz_state_space_dense(&rod, &made_dense, &dense));
    request = asking(&rod, 3, true, RITZ_GRAMIAN_INPUTS);
    assert_survives_allocations(4, make(&request));
    request = asking(dense, 3, false, RITZ_GRAMIAN_OUTPUTS);
    assert_survives_allocations(4, make(&request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_order_is_stable),
    cmocka_unit_test(the_inverse_operator_keeps_the_static_gain),
    cmocka_unit_test(the_reduced_gramian_is_the_identity),
    cmocka_unit_test(a_shift_allows_models_that_are_not_stable),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(lanczos_space, tests, NULL, NULL)
