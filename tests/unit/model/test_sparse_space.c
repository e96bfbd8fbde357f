/*
 * State spaces with sparse A and E, compared with their dense copies; refusals.
 */
#include "testing.h"

#include "spaces.h"

#include "base/complex.h"
#include "model/space.h"

#include <ritz/basis.h>
#include <ritz/container.h>

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void a_dense_copy_has_all_of_it(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
    const ritz_state_space *dense = NULL;

    assert_ok(spaces_rod(12, 0.3, true, &rod));
    snprintf(rod.units, sizeof rod.units, "kg m s");
    ritz_dense_col(&rod.D, 1)[0] = 7.0;
    rod.limit[1] = 0.5;
    assert_true(ritz_state_space_is_sparse(&rod));
    assert_int_equal(ritz_state_space_order(&rod), 12);
    assert_int_equal(ritz_model_order(ritz_model_of_states(&rod)), 12);
    assert_ok(ritz_state_space_dense(&rod, &made, &dense));
    assert_ptr_equal(dense, &made);
    assert_false(ritz_state_space_is_sparse(dense));
    assert_true(ritz_dense_col(&made.A, 4)[5] == 1.3 &&
                ritz_dense_col(&made.A, 5)[4] == 0.7);
    assert_true(ritz_dense_col(&made.E, 4)[5] == 1.0 / 6.0);
    assert_true(made.D.val[2] == 7.0 && made.limit[1] == 0.5);
    assert_string_equal(made.units, "kg m s");
    assert_ok(ritz_state_space_dense(dense, &rod, &dense));
    assert_ptr_equal(dense, &made);
}

static void poles_and_transfer_are_those_of_the_dense_model(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made = {0};
    RITZ_OWN(ritz_pencil) sparse = {0}, full = {0};
    const ritz_state_space *dense = NULL;
    RITZ_OWN(ritz_pencil_pairs) slow = {0};
    double _Complex *pole = NULL, H[2][4];
    int64_t count = 0;

    assert_ok(spaces_rod(130, 0.05, false, &rod));
    assert_ok(ritz_state_space_dense(&rod, &made, &dense));
    assert_ok(ritz_state_space_poles(&rod, &count, &pole));
    assert_int_equal(count, 130);
    assert_ok(ritz_pencil_of_space(&rod, &sparse));
    assert_ok(ritz_pencil_of_space(dense, &full));
    assert_ok(ritz_space_slowest(&sparse, 3, &slow));
    /* the poles have the condition number (1.05 / 0.95)^65 = 670 */
    for (int k = 0; k < 3; k++)
        assert_near(creal(slow.s[k]), spaces_rod_pole(130, 0.05, k + 1), 1e-10);
    for (int k = 0; k < 4; k++) {
        const double _Complex s = ritz_complex(0.01 * k, 0.1 * k);

        assert_ok(ritz_space_transfer(&rod, &sparse, s, H[0]));
        assert_ok(ritz_space_transfer(dense, &full, s, H[1]));
        for (int i = 0; i < 4; i++)
            assert_true(cabs(H[0][i] - H[1][i]) <= 1e-13 * cabs(H[1][i]));
    }
    free(pole);
}

/* With fewer outputs than inputs the solver takes the rows of C, not the
   columns of B. */
static void one_output_gives_the_row_of_two(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(ritz_dense) row = {0};
    const int64_t first = 0;
    double _Complex both[4], one[2];

    assert_ok(spaces_rod(50, 0.2, true, &rod));
    assert_ok(ritz_pencil_of_space(&rod, &pencil));
    assert_ok(ritz_space_transfer(&rod, &pencil, ritz_complex(0.0, 0.2), both));
    assert_ok(ritz_dense_rows(&rod.C, 1, &first, &row));
    ritz_dense_replace(&rod.C, &row);
    rod.num_outputs = 1;
    assert_ok(ritz_space_transfer(&rod, &pencil, ritz_complex(0.0, 0.2), one));
    for (int k = 0; k < 2; k++)
        assert_true(cabs(one[k] - both[k]) <= 1e-13 * cabs(both[k]));
}

static void a_projection_is_that_of_the_dense_model(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, made = {0}, a = {0}, b = {0};
    RITZ_OWN(ritz_basis) basis = {.states = true};
    const ritz_state_space *dense = NULL;

    assert_ok(spaces_rod(20, 0.3, true, &rod));
    assert_ok(ritz_state_space_dense(&rod, &made, &dense));
    assert_ok(ritz_dense_new(20, 3, &basis.T));
    assert_ok(ritz_dense_new(20, 3, &basis.W));
    for (int k = 0; k < 60; k++) {
        basis.T.val[k] = cos(k * k);
        basis.W.val[k] = sin(k * k + 1.0);
    }
    assert_ok(ritz_columns_new(3, &basis.columns));
    assert_ok(ritz_reduce_space(&rod, &basis, &a));
    assert_ok(ritz_reduce_space(dense, &basis, &b));
    for (int k = 0; k < 9; k++)
        assert_near(a.A.val[k], b.A.val[k], 1e-12);
}

static void what_does_not_fit_is_refused(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0}, large = {0}, none = {0};
    const ritz_state_space *dense = NULL;

    assert_ok(spaces_rod(8, 0.0, true, &rod));
    assert_ok(ritz_state_space_check(&rod));
    rod.sE.val[0] = rod.sE.val[1] = rod.sE.val[2] = 0.0;
    assert_fails(ritz_state_space_check(&rod), RITZ_ERR_FORMAT,
                 "'E' is singular");
    ritz_sparse_free(&rod.sE);
    assert_ok(ritz_state_space_check(&rod));
    rod.sA.val[3] = (double)NAN;
    assert_fails(ritz_state_space_check(&rod), RITZ_ERR_FORMAT,
                 "'A' is not finite");
    rod.sA.val[3] = 1.0;
    assert_ok(ritz_dense_new(8, 8, &rod.E));
    assert_fails(ritz_state_space_check(&rod), RITZ_ERR_FORMAT,
                 "both dense or both sparse");
    assert_ok(spaces_rod(3001, 0.0, false, &large));
    assert_fails(ritz_state_space_dense(&large, &none, &dense),
                 RITZ_ERR_ARGUMENT, "more than 3000");
}

static void a_container_keeps_it_sparse(void **)
{
    char path[] = "/tmp/ritz-sparse-XXXXXX";
    int file = mkstemp(path);
    RITZ_OWN(ritz_state_space) rod = {0}, back = {0};
    const ritz_stamp stamp = {.command = "test"};

    assert_true(file >= 0);
    close(file);
    assert_ok(spaces_rod(700, 0.3, true, &rod));
    assert_ok(ritz_container_write_state_space(path, &rod, &stamp));
    assert_ok(ritz_container_read_state_space(path, &back));
    unlink(path);
    assert_true(!back.A.val && !back.E.val);
    assert_int_equal(ritz_state_space_order(&back), 700);
    assert_int_equal(back.columns.count, 700);
    for (int64_t k = 0; k < rod.sA.colptr[700]; k++)
        assert_true(back.sA.val[k] == rod.sA.val[k] &&
                    back.sE.val[k] == rod.sE.val[k]);
    for (int64_t k = 0; k < 1400; k++)
        assert_true(back.B.val[k] == rod.B.val[k]);
}

static ritz_status make_dense(const ritz_state_space *rod)
{
    RITZ_OWN(ritz_state_space) made = {0};
    const ritz_state_space *dense = NULL;

    RITZ_CHECK(ritz_state_space_check(rod));
    return ritz_state_space_dense(rod, &made, &dense);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};

    assert_ok(spaces_rod(9, 0.1, true, &rod));
    assert_survives_every_allocation(make_dense(&rod));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_dense_copy_has_all_of_it),
    cmocka_unit_test(poles_and_transfer_are_those_of_the_dense_model),
    cmocka_unit_test(one_output_gives_the_row_of_two),
    cmocka_unit_test(a_projection_is_that_of_the_dense_model),
    cmocka_unit_test(what_does_not_fit_is_refused),
    cmocka_unit_test(a_container_keeps_it_sparse),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(sparse_space, tests, NULL, NULL)
