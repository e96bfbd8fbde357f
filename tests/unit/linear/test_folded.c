#include "linear/folded.h"

#include "fixtures/lattice.h"
#include "testing.h"

#include <math.h>
#include <string.h>

/* A symmetric matrix whose columns have an entry on the diagonal or none, and
   one column that is empty. Zeros with either sign are stored. */
static void make_sparse(ritz_sparse *out)
{
    const int64_t colptr[] = {0, 3, 5, 5, 8, 10};
    const int64_t rowind[] = {0, 1, 3, 0, 3, 0, 1, 4, 3, 4};
    const double val[] = {1.0, 2.0, -0.0, 2.0, 3.5, -0.0, 3.5, 0.0, 0.0, 7.0};

    assert_ok(ritz_sparse_new(5, 5, 10, out));
    memcpy(out->colptr, colptr, sizeof colptr);
    memcpy(out->rowind, rowind, sizeof rowind);
    memcpy(out->val, val, sizeof val);
}

static void assert_same_bits(const ritz_sparse *A, const ritz_sparse *B)
{
    const size_t count = (size_t)B->colptr[B->ncol];

    assert_int_equal(A->nrow, B->nrow);
    assert_int_equal(A->ncol, B->ncol);
    assert_memory_equal(A->colptr, B->colptr,
                        (size_t)(B->ncol + 1) * sizeof *B->colptr);
    if (count == 0)
        return;
    assert_memory_equal(A->rowind, B->rowind, count * sizeof *B->rowind);
    assert_memory_equal(A->val, B->val, count * sizeof *B->val);
}

static void assert_opens_as_it_was(const ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) B = {0};
    RITZ_OWN(ritz_folded) F = {0};

    assert_ok(ritz_sparse_copy(A, &B));
    assert_ok(ritz_folded_new(&B, &F));
    assert_null(B.colptr);
    assert_non_null(F.colptr);
    assert_ok(ritz_folded_open(&F, &B));
    assert_null(F.colptr);
    assert_same_bits(&B, A);
}

static void a_folded_matrix_opens_with_the_same_bits(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0}, none = {0}, nothing = {0};

    (void)state;
    lattice_new(9, 0.1, &K, &M);
    make_sparse(&A);
    assert_ok(ritz_sparse_new(4, 4, 0, &none));
    assert_ok(ritz_sparse_new(0, 0, 0, &nothing));
    assert_opens_as_it_was(&K);
    assert_opens_as_it_was(&M);
    assert_opens_as_it_was(&A);
    assert_opens_as_it_was(&none);
    assert_opens_as_it_was(&nothing);
}

static void one_triangle_is_held(void **state)
{
    const int32_t row[] = {0, 1, 3, 3, 4, 4};
    const double val[] = {1.0, 2.0, -0.0, 3.5, 0.0, 7.0};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_folded) F = {0};

    (void)state;
    make_sparse(&A);
    assert_ok(ritz_folded_new(&A, &F));
    assert_memory_equal(F.row, row, sizeof row);
    assert_memory_equal(F.val, val, sizeof val);
}

static void assert_stays(const ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) B = {0};
    RITZ_OWN(ritz_folded) F = {0};

    assert_ok(ritz_sparse_copy(A, &B));
    assert_ok(ritz_folded_new(&B, &F));
    assert_null(F.colptr);
    assert_same_bits(&B, A);
    assert_ok(ritz_folded_open(&F, &B));
    assert_same_bits(&B, A);
}

/* Numbers that differ by their last bit, zeros of different sign, and an entry
   without a counterpart in either triangle. */
static void a_matrix_that_is_not_symmetric_stays_as_it_is(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0}, wide = {0};

    (void)state;
    make_sparse(&A);
    A.val[1] = nextafter(A.val[1], 3.0);
    assert_stays(&A);
    A.val[1] = A.val[3];
    A.val[2] = 0.0;
    assert_stays(&A);
    A.val[2] = A.val[5];
    A.rowind[2] = 2; /* (3,0) becomes (2,0), and (0,3) is alone */
    assert_stays(&A);
    A.rowind[2] = 3;
    A.rowind[7] = 2; /* (4,3) becomes (2,3), which leaves (3,4) alone */
    assert_stays(&A);
    assert_ok(ritz_sparse_new(2, 3, 0, &wide));
    assert_stays(&wide);
}

static ritz_status fold_and_open(const ritz_sparse *from)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_folded) F = {0};

    RITZ_CHECK(ritz_sparse_copy(from, &A));
    RITZ_CHECK(ritz_folded_new(&A, &F));
    return ritz_folded_open(&F, &A);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};

    (void)state;
    make_sparse(&A);
    assert_survives_every_allocation(fold_and_open(&A));
}

static void a_failure_to_open_loses_nothing(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0}, B = {0};
    RITZ_OWN(ritz_folded) F = {0};

    (void)state;
    make_sparse(&A);
    assert_ok(ritz_sparse_copy(&A, &B));
    assert_ok(ritz_folded_new(&B, &F));
    assert_survives_every_allocation(ritz_folded_open(&F, &B));
    assert_same_bits(&B, &A);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_folded_matrix_opens_with_the_same_bits),
    cmocka_unit_test(one_triangle_is_held),
    cmocka_unit_test(a_matrix_that_is_not_symmetric_stays_as_it_is),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(a_failure_to_open_loses_nothing),
};

TEST_MODULE(folded, tests, NULL, NULL)
