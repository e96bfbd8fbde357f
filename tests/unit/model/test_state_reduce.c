#include "testing.h"

#include "balancing.h"
#include "masses.h"
#include "model/modal.h"
#include "spaces.h"
#include "spring_chain.h"

#include <ritz/check.h>
#include <ritz/matrix.h>

#include <float.h>

enum { MASSES = 8, VECTORS = 5 };

static double at(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* Numbers between -1 and 1 in no order. */
static void fill(uint64_t seed, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        A->val[k] = (double)(seed >> 33) / 1073741824.0 - 1.0;
    }
}

/* Any vectors at all, of states or displacements. */
static void any_basis(int64_t rows, bool states, ritz_basis *out)
{
    assert_ok(ritz_basis_new(rows, VECTORS, out));
    assert_ok(ritz_dense_new(rows, VECTORS, &out->W));
    out->states = states;
    fill(1, &out->T);
    fill(2, &out->W);
    for (int64_t k = 0; k < VECTORS; k++)
        out->columns.kind[k] =
            states ? RITZ_COLUMN_STATE : RITZ_COLUMN_BALANCED;
}

/*
 * The chain with dashpots in D, a damper, an input and three outputs, of which
 * one is a velocity and one an acceleration.
 */
static void make_chain(bool is_free, ritz_component *out)
{
    static const int64_t in[] = {MASSES - 1}, seen[] = {0, 3, 5};
    static const int64_t spring[] = {4};
    ritz_sparse D = {0};

    assert_ok(spring_chain(MASSES, is_free, out));
    assert_ok(masses_io(out, 1, in, 3, seen));
    ritz_dense_col(&out->io.C, 3)[1] = 0.0;
    ritz_dense_col(&out->io.Cv, 3)[1] = 1.0;
    ritz_dense_col(&out->io.C, 5)[2] = 0.0;
    ritz_dense_col(&out->io.Ca, 5)[2] = 1.0;
    assert_ok(ritz_sparse_add(3e-3, &out->K, 0.0, &out->M, &D));
    ritz_sparse_free(&out->D);
    out->D = D;
    assert_ok(spring_chain_damp(out, 1, spring, 5.0, 20.0));
}

/* To a part of the largest; of zeros to the rounding of terms of about 1. */
static void assert_same(const ritz_dense *A, const ritz_dense *B, double error)
{
    assert_int_equal(A->nrow, B->nrow);
    assert_int_equal(A->ncol, B->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        assert_near(A->val[k], B->val[k],
                    error * ritz_dense_max(B) + 16 * DBL_EPSILON);
}

/* By sparse products as for many dofs; E^-1 is taken as there. */
static void by_products(const ritz_component *chain,
                        const ritz_damping *damping, const ritz_basis *basis,
                        ritz_state_space *out)
{
    RITZ_OWN(ritz_dense) E = {0};

    assert_ok(ritz_state_space_new(basis->T.ncol, &chain->io, out));
    assert_ok(ritz_states_project(chain, damping, basis, out, &E));
    assert_ok(ritz_states_settle(basis, &E, out));
}

/*
 * What many dofs go through is what few go through, with every kind of damping;
 * ratios are those of all modes if all are up to the frequency given. The error
 * is eps times the condition of W'E T, 1e3, and of the modes, 1e2.
 */
static void sparse_products_give_what_all_modes_do(void **state)
{
    static const char *const dampings[] = {"", "rayleigh 0.2 0.001",
                                           "modal 0.03", "modes 0.01 0.05"};
    (void)state;
    for (int is_free = 0; is_free < 2; is_free++)
        for (int k = 0; k < 4; k++) {
            RITZ_OWN(ritz_component) chain = {0};
            RITZ_OWN(ritz_basis) basis = {0};
            ritz_damping damping = {0};
            RITZ_OWN(ritz_state_space) modes = {0}, products = {0};

            make_chain(is_free, &chain);
            any_basis(2 * MASSES, true, &basis);
            assert_ok(ritz_damping_parse(dampings[k], &damping));
            basis.among_hz = 1e3;
            assert_ok(ritz_reduce_states(&chain, &damping, &basis, &modes));
            by_products(&chain, &damping, &basis, &products);
            assert_same(&products.A, &modes.A, 1e-10);
            assert_same(&products.B, &modes.B, 1e-10);
            assert_same(&products.C, &modes.C, 1e-10);
            assert_same(&products.D, &modes.D, 1e-10);
        }
}

/* Rigid positions and velocities, then others: [0 I; 0 0] to the bit. */
static void rigid_columns_have_no_stiffness_by_products(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_state_space) made = {0};
    const ritz_damping none = {0};
    const ritz_span rigid = {.modes = 0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    (void)state;
    make_chain(true, &chain);
    any_basis(2 * MASSES, true, &basis);
    assert_ok(ritz_eigen_sparse(&chain.K, &chain.M, &rigid, &pairs));
    assert_int_equal(pairs.num_rigid, 1);
    for (int64_t half = 0; half < 2; half++)
        for (int64_t i = 0; i < MASSES; i++) {
            double phi = pairs.Phi.val[i];
            double *t = ritz_dense_col(&basis.T, half);
            double *w = ritz_dense_col(&basis.W, half);

            t[i] = half == 0 ? phi : 0.0;
            t[MASSES + i] = half == 1 ? phi : 0.0;
            w[i] = half == 0 ? phi * ritz_sparse_diagonal(&chain.M, i) : 0.0;
            w[MASSES + i] = half == 1 ? phi : 0.0;
            basis.columns.kind[half] = RITZ_COLUMN_RIGID;
        }
    by_products(&chain, &none, &basis, &made);
    for (int64_t i = 0; i < VECTORS; i++) /* E^-1 mixes rows, 1e3 eps */
        assert_near(at(&made.A, i, 0), 0.0, 1e-12 * ritz_dense_max(&made.A));
}

/* Of vectors that are M-orthogonal to rigid motion, nothing joins it. */
static void rigid_motion_stands_apart_by_products(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_damping damping = {0};
    RITZ_OWN(ritz_state_space) made = {0};

    (void)state;
    balancing_chain(MASSES, true, MASSES - 1, 0, "modal 0.05", &chain);
    request = balancing_asking(&chain, VECTORS);
    assert_ok(ritz_basis_make(&ritz_method_balanced, &request, &basis));
    assert_ok(ritz_damping_parse(basis.damping, &damping));
    basis.among_hz = 1e3;
    by_products(&chain, &damping, &basis, &made);
    assert_int_equal(made.columns.kind[1], RITZ_COLUMN_RIGID);
    for (int64_t k = 2; k < made.A.nrow; k++)
        for (int64_t rigid = 0; rigid < 2; rigid++) {
            assert_true(at(&made.A, rigid, k) == 0.0);
            assert_true(at(&made.A, k, rigid) == 0.0);
        }
}

static void ratios_without_modes_are_refused(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_damping damping = {0};
    RITZ_OWN(ritz_state_space) made = {0};
    ritz_dense E = {0};

    (void)state;
    make_chain(false, &chain);
    any_basis(2 * MASSES, true, &basis);
    assert_ok(ritz_damping_parse("modal 0.02", &damping));
    assert_ok(ritz_state_space_new(VECTORS, &chain.io, &made));
    assert_fails(ritz_states_project(&chain, &damping, &basis, &made, &E),
                 RITZ_ERR_ARGUMENT, "need all modes of 8 dofs");
    chain.M.val[chain.M.colptr[MASSES - 1]] = 0.0;
    assert_fails(ritz_states_project(&chain, &damping, &basis, &made, &E),
                 RITZ_ERR_ARGUMENT, "drives a dof without mass");
}

/*
 * x1' = -x1 + 2 x2 + u, x2' = 3 x1 - 4 x2 + 5 u, y = 6 x1 + 7 x2 + 8 u. With
 * x2' = 0, x2 = (3 x1 + 5 u) / 4.
 */
static void a_perturbed_state_is_what_its_equation_says(void **state)
{
    static const double A[] = {-1, 2, 3, -4}, B[] = {1, 5}, C[] = {6, 7};
    static const double D[] = {8};
    const spaces_rows rows = {2, 1, 1, A, B, C, D, NULL};
    ritz_state_space full = {0}, reduced = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    assert_ok(ritz_basis_new(2, 2, &basis));
    basis.states = true;
    basis.T.val[0] = basis.T.val[3] = 1.0;
    basis.columns.kind[0] = RITZ_COLUMN_STATE;
    basis.columns.kind[1] = RITZ_COLUMN_PERTURBED;
    assert_ok(ritz_reduce_space(&full, &basis, &reduced));
    assert_int_equal(reduced.A.nrow, 1);
    assert_int_equal(reduced.columns.count, 1);
    assert_true(reduced.A.val[0] == 0.5);
    assert_true(reduced.B.val[0] == 3.5);
    assert_true(reduced.C.val[0] == 11.25);
    assert_true(reduced.D.val[0] == 16.75);
    assert_int_equal(reduced.estimates.count, 0); /* no Hankel values */
    ritz_state_space_free(&reduced);
    full.A.val[3] = 0.0;
    assert_fails(ritz_reduce_space(&full, &basis, &reduced), RITZ_ERR_SINGULAR,
                 "the remainder has no static response");
    ritz_state_space_free(&full);
}

static void a_basis_of_other_states_is_refused(void **state)
{
    static const double A[] = {-1}, B[] = {1}, C[] = {1};
    const spaces_rows rows = {1, 1, 1, A, B, C, NULL, NULL};
    ritz_state_space full = {0}, none = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(spaces_make(&rows, &full));
    any_basis(6, true, &basis);
    assert_fails(ritz_reduce_space(&full, &basis, &none), RITZ_ERR_ARGUMENT,
                 "is for 6 states, the model has 1");
    basis.states = false;
    assert_fails(ritz_reduce_space(&full, &basis, &none), RITZ_ERR_ARGUMENT,
                 "of displacements");
    ritz_state_space_free(&full);
}

/*
 * In the basis of all displacements, W = T = I, the companion form is that of
 * the component itself, with all its damping.
 */
static void the_companion_of_all_dofs_is_the_component(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_damping damping = {0};
    RITZ_OWN(ritz_state_space) full = {0}, made = {0};

    (void)state;
    make_chain(false, &chain);
    assert_ok(ritz_basis_new(MASSES, MASSES, &basis));
    assert_ok(ritz_dense_new(MASSES, MASSES, &basis.W));
    for (int64_t k = 0; k < MASSES; k++)
        ritz_dense_col(&basis.T, k)[k] = ritz_dense_col(&basis.W, k)[k] = 1.0;
    assert_ok(ritz_damping_parse("modal 0.02", &damping));
    assert_ok(ritz_state_space_of_component(&chain, &damping, &full));
    assert_ok(ritz_reduce_companion(&chain, &damping, &basis, &made));
    assert_same(&made.A, &full.A, 1e-12);
    assert_same(&made.B, &full.B, 1e-12);
    assert_same(&made.C, &full.C, 1e-12);
    assert_same(&made.D, &full.D, 1e-12);
}

/* Its upper half is [0 I] and 0 to the bit. */
static void a_companion_is_of_second_order(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    const ritz_damping none = {0};
    ritz_state_space made = {0};
    ritz_reduced refused = {0};

    (void)state;
    make_chain(false, &chain);
    any_basis(MASSES, false, &basis);
    assert_ok(ritz_reduce_companion(&chain, &none, &basis, &made));
    assert_int_equal(made.A.nrow, 2 * VECTORS);
    assert_int_equal(made.columns.count, 2 * VECTORS);
    assert_int_equal(made.columns.kind[VECTORS], RITZ_COLUMN_BALANCED);
    for (int64_t i = 0; i < VECTORS; i++) {
        for (int64_t j = 0; j < 2 * VECTORS; j++)
            assert_true(at(&made.A, i, j) == (j == VECTORS + i ? 1.0 : 0.0));
        assert_true(at(&made.B, i, 0) == 0.0);
    }
    assert_fails(ritz_reduce(&chain, &basis, &refused), RITZ_ERR_ARGUMENT,
                 "has left vectors of its own");
    ritz_dense_free(&basis.W);
    ritz_state_space_free(&made);
    assert_fails(ritz_reduce_companion(&chain, &none, &basis, &made),
                 RITZ_ERR_ARGUMENT, "with left vectors");
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0}, two_sided = {0};
    ritz_damping damping = {0};
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_dense) E = {0};

    (void)state;
    make_chain(false, &chain);
    any_basis(2 * MASSES, true, &basis);
    any_basis(MASSES, false, &two_sided);
    basis.among_hz = 1e3;
    assert_ok(ritz_damping_parse("modal 0.02", &damping));
    assert_survives_every_allocation(
        ritz_reduce_companion(&chain, &damping, &two_sided, &made));
    ritz_state_space_free(&made);
    assert_ok(ritz_state_space_new(VECTORS, &chain.io, &made));
    assert_survives_every_allocation(
        (ritz_dense_free(&E),
         ritz_states_project(&chain, &damping, &basis, &made, &E)));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(sparse_products_give_what_all_modes_do),
    cmocka_unit_test(rigid_columns_have_no_stiffness_by_products),
    cmocka_unit_test(rigid_motion_stands_apart_by_products),
    cmocka_unit_test(ratios_without_modes_are_refused),
    cmocka_unit_test(a_perturbed_state_is_what_its_equation_says),
    cmocka_unit_test(a_basis_of_other_states_is_refused),
    cmocka_unit_test(the_companion_of_all_dofs_is_the_component),
    cmocka_unit_test(a_companion_is_of_second_order),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(state_reduce, tests, NULL, NULL)
