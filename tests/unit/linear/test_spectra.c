/* Pairs of small pencils that are solved once. */
#include "base/alloc.h"
#include "fixtures/lattice.h"
#include "linear/spectra.h"
#include "testing.h"

enum { EDGE = 5, MANY = 20 };

static const double ground = 0.3;

/* Whether the first pairs of two sets are the same, bit by bit. */
static void assert_same_pairs(const ritz_pairs *a, const ritz_pairs *b)
{
    const size_t count = (size_t)a->Phi.ncol;

    assert_int_equal(a->Phi.ncol, b->Phi.ncol);
    assert_int_equal(a->num_rigid, b->num_rigid);
    assert_true(a->proven_to == b->proven_to);
    assert_memory_equal(a->lambda, b->lambda, count * sizeof *a->lambda);
    assert_memory_equal(a->residual, b->residual, count * sizeof *a->residual);
    assert_memory_equal(a->Phi.val, b->Phi.val,
                        count * (size_t)a->Phi.nrow * sizeof *a->Phi.val);
}

/* Solve without a store, twice with one, and compare. */
static ritz_status solve_alike(const ritz_sparse *K, const ritz_sparse *M,
                               const ritz_span *span)
{
    RITZ_OWN(ritz_spectra) *spectra = NULL;
    RITZ_OWN(ritz_pairs) alone = {0}, first = {0}, second = {0};

    RITZ_CHECK(ritz_eigen_sparse(K, M, span, &alone));
    RITZ_CHECK(ritz_spectra_new(&spectra));
    {
        [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) lent =
            ritz_spectra_lend(spectra);

        RITZ_CHECK(ritz_eigen_sparse(K, M, span, &first));
        RITZ_CHECK(ritz_eigen_sparse(K, M, span, &second));
    }
    assert_int_equal(ritz_spectra_count(spectra), 1);
    assert_same_pairs(&alone, &first);
    assert_same_pairs(&alone, &second);
    return RITZ_OK;
}

static void stored_pairs_are_those_that_are_computed(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    const ritz_span spans[] = {
        {.modes = 7}, {.modes = EDGE * EDGE * EDGE}, {.modes = 0}};

    (void)state;
    lattice_new(EDGE, ground, &K, &M);
    for (size_t k = 0; k < sizeof spans / sizeof *spans; k++)
        assert_ok(solve_alike(&K, &M, &spans[k]));
    assert_survives_every_allocation(solve_alike(&K, &M, &spans[0]));
}

/* Different numbers of modes are taken from one entry; a pencil with another
   stiffness gets its own. */
static void each_pencil_has_one_entry(void **state)
{
    RITZ_OWN(ritz_spectra) *spectra = NULL;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, stiffer = {0};

    (void)state;
    lattice_new(EDGE, ground, &K, &M);
    assert_ok(ritz_sparse_add(1.0, &K, 1e-12, &M, &stiffer));
    assert_ok(ritz_spectra_new(&spectra));
    assert_false(ritz_spectra_are_lent());
    {
        [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) lent =
            ritz_spectra_lend(spectra);

        assert_true(ritz_spectra_are_lent());
        for (int64_t modes = 1; modes < 5; modes++) {
            RITZ_OWN(ritz_pairs) P = {0};

            assert_ok(
                ritz_eigen_sparse(&K, &M, &(ritz_span){.modes = modes}, &P));
            assert_true(P.Phi.ncol >= modes);
            assert_int_equal(ritz_spectra_count(spectra), 1);
        }
        assert_null(ritz_spectra_find(&stiffer, &M));
        assert_null(ritz_spectra_find(&K, &K));
        assert_non_null(ritz_spectra_find(&K, &M));
    }
    assert_null(ritz_spectra_find(&K, &M));
}

/* A full store drops what was stored first. */
static void a_store_is_limited(void **state)
{
    RITZ_OWN(ritz_spectra) *spectra = NULL;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    int64_t full = 0;

    (void)state;
    lattice_new(2, ground, &K, &M);
    assert_ok(ritz_spectra_new(&spectra));
    {
        [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) lent =
            ritz_spectra_lend(spectra);

        for (int k = 0; k < MANY; k++) {
            RITZ_OWN(ritz_sparse) K_k = {0};
            RITZ_OWN(ritz_pairs) P = {0};

            assert_ok(ritz_sparse_add(1.0 + k, &K, 0.0, &M, &K_k));
            assert_ok(
                ritz_eigen_sparse(&K_k, &M, &(ritz_span){.modes = 1}, &P));
            assert_non_null(ritz_spectra_find(&K_k, &M));
        }
        full = ritz_spectra_count(spectra);
        assert_true(full < MANY);
        assert_null(ritz_spectra_find(&K, &M));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(stored_pairs_are_those_that_are_computed),
    cmocka_unit_test(each_pencil_has_one_entry),
    cmocka_unit_test(a_store_is_limited),
};

TEST_MODULE(spectra, tests, NULL, NULL)
