#include "testing.h"

#include "bar.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>

enum { ELEMENTS = 16, DOFS = ELEMENTS + 1, MODES = 5 };

/* Rounding of a solve with K_ii: its condition number is (2 / pi h)^2. */
static const double solve_error = DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS;

static int64_t ends[] = {0, DOFS - 1};

typedef struct fixture {
    ritz_component bar;
    ritz_request request; /* both ends and MODES modes */
    ritz_basis basis;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.bar;
    f.request.attached = (ritz_dofs){2, ends};
    f.request.modes = MODES;
    assert_ok(bar_component(ELEMENTS, &f.bar));
    assert_ok(
        ritz_basis_make(&ritz_method_craig_bampton, &f.request, &f.basis));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->bar);
    ritz_basis_free(&f->basis);
    return 0;
}

/* Pull one end of a uniform bar and every point follows in proportion. */
static void constraint_modes_are_linear(void **state)
{
    fixture *f = *state;

    for (int64_t i = 0; i < DOFS; i++) {
        double x = (double)i / ELEMENTS;

        assert_near(ritz_dense_col(&f->basis.T, 0)[i], 1.0 - x, solve_error);
        assert_near(ritz_dense_col(&f->basis.T, 1)[i], x, solve_error);
    }
}

static void columns_say_what_they_are(void **state)
{
    const ritz_basis *basis = &((fixture *)*state)->basis;
    const ritz_columns *columns = &basis->columns;

    assert_string_equal(basis->origin.options, "modes 5");
    assert_string_equal(basis->origin.reference, "CraigBampton1968");
    for (int64_t j = 0; j < 2; j++) {
        assert_int_equal(columns->kind[j], RITZ_COLUMN_CONSTRAINT);
        assert_int_equal(columns->dof[j], ends[j]);
        assert_true(isnan(columns->hertz[j]) && isnan(columns->residual[j]));
    }
    for (int64_t j = 2; j < 2 + MODES; j++) {
        double exact = ritz_eigen_hertz(bar_eigenvalue(ELEMENTS, j - 1));

        assert_int_equal(columns->kind[j], RITZ_COLUMN_NORMAL);
        assert_int_equal(columns->dof[j], -1);
        assert_near(columns->hertz[j], exact, solve_error * exact);
        assert_true(columns->residual[j] <= solve_error);
    }
}

/* K_r = diag(K_bb + K_bi Psi, Lambda); the bar between its ends is a spring. */
static void reduced_stiffness_is_block_diagonal(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) Kr = project(&f->bar.K, &f->basis.T);
    double highest = bar_eigenvalue(ELEMENTS, MODES);

    for (int64_t j = 0; j < Kr.ncol; j++)
        for (int64_t i = 0; i < Kr.nrow; i++) {
            double spring = i == j ? 1.0 : -1.0;
            double modal = i == j ? bar_eigenvalue(ELEMENTS, i - 1) : 0.0;

            assert_near(ritz_dense_col(&Kr, j)[i],
                        i < 2 && j < 2 ? spring : modal, solve_error * highest);
        }
}

/* Rayleigh-Ritz: a subspace only stiffens; five modes cost 1.6e-3 in mode 1. */
static void reduced_eigenvalues_bound_those_of_the_mesh(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) Kr = project(&f->bar.K, &f->basis.T);
    RITZ_OWN(ritz_dense) Mr = project(&f->bar.M, &f->basis.T);
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_eigen_dense(&Kr, &Mr, &pairs));
    assert_int_equal(pairs.num_rigid, 1);
    for (int64_t k = 1; k < 2 + MODES; k++)
        assert_true(pairs.lambda[k] >=
                    bar_eigenvalue(ELEMENTS, k) - solve_error);
    assert_near(pairs.lambda[0], 0.0, solve_error);
    assert_near(pairs.lambda[1] / bar_eigenvalue(ELEMENTS, 1), 1.0, 2e-3);
}

/* A frequency between two modes asks for the same basis as their number. */
static void modes_are_chosen_by_frequency(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = -1;
    request.up_to_hz = ritz_eigen_hertz(bar_eigenvalue(ELEMENTS, MODES)) + 0.1;
    assert_ok(ritz_basis_make(&ritz_method_craig_bampton, &request, &basis));
    assert_int_equal(basis.T.ncol, 2 + MODES);
}

/* Static condensation keeps the answer to boundary forces: K_r is a spring. */
static void guyan_is_exact_statically(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) Kr = {0};

    request.modes = -1;
    assert_ok(ritz_basis_make(&ritz_method_guyan, &request, &basis));
    assert_int_equal(basis.T.ncol, 2);
    Kr = project(&f->bar.K, &basis.T);
    assert_near(ritz_dense_col(&Kr, 0)[0], 1.0, solve_error);
    assert_near(ritz_dense_col(&Kr, 1)[0], -1.0, solve_error);
}

static void boundary_must_be_a_set_of_dofs(void **state)
{
    fixture *f = *state;
    int64_t at[] = {3, 3, DOFS};
    ritz_request request = f->request;
    ritz_basis none = {0};

    request.attached = (ritz_dofs){2, at};
    assert_fails(ritz_method_craig_bampton.make(&request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
    request.attached = (ritz_dofs){1, at + 2};
    assert_fails(ritz_method_craig_bampton.make(&request, &none),
                 RITZ_ERR_ARGUMENT, "not among the 17");
    assert_null(none.T.val);
}

static void free_rigid_body_motion_is_refused_by_name(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    ritz_basis none = {0};

    request.attached = (ritz_dofs){0};
    assert_fails(ritz_basis_make(&ritz_method_craig_bampton, &request, &none),
                 RITZ_ERR_SINGULAR, "craig-bampton: interior stiffness: sing");
    assert_non_null(strstr(ritz_error_message(), "rigid-body motion"));
    assert_non_null(strstr(ritz_error_message(), "grid 1 T1"));
}

/* K - tau M with tau between the second and the third eigenvalue of the bar
   with its port held: two motions have negative energy. */
static void indefinite_stiffness_is_refused_by_name(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_sparse) K = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_request request = f->request;
    const double tau =
        0.5 * (bar_eigenvalue(ELEMENTS, 2) + bar_eigenvalue(ELEMENTS, 3));

    assert_ok(bar_component(ELEMENTS, &bar));
    assert_ok(ritz_sparse_add(1.0, &bar.K, -tau, &bar.M, &K));
    ritz_sparse_free(&bar.K);
    RITZ_MOVE(bar.K, K);
    request.component = &bar;
    assert_fails(
        ritz_basis_make(&ritz_method_craig_bampton, &request, &basis),
        RITZ_ERR_SINGULAR,
        "not positive definite: with the attached dofs held, 2 motion(s) have "
        "negative energy; largest at grid ");
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;

    request.up_to_hz = 3.0;
    assert_fails(ritz_request_check(&ritz_method_craig_bampton, &request),
                 RITZ_ERR_ARGUMENT, "either a number of modes or a frequency");
    assert_fails(ritz_request_check(&ritz_method_guyan, &request),
                 RITZ_ERR_ARGUMENT, "guyan has no modes to choose");
    request.up_to_hz = 0.0;
    request.choice.engine = RITZ_ENGINE_SLICES;
    request.choice.accuracy = 1e-4;
    assert_fails(ritz_request_check(&ritz_method_craig_bampton, &request),
                 RITZ_ERR_ARGUMENT, "the engines are auto, lanczos and amls");
    assert_null(ritz_method_find("craig-bamton"));
    assert_non_null(strstr(ritz_error_message(), "is 'craig-bampton' meant?"));
}

static void matrices_that_are_not_needed_are_freed_if_owned(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_request request = f->request;

    assert_ok(bar_component(ELEMENTS, &bar));
    request.component = request.owned = &bar;
    assert_ok(ritz_basis_make(&ritz_method_craig_bampton, &request, &basis));
    assert_null(bar.K.val);
    assert_null(bar.M.val);
    assert_memory_equal(basis.T.val, f->basis.T.val,
                        (size_t)(DOFS * basis.T.ncol) * sizeof *basis.T.val);
}

static void matrices_are_kept_where_they_are_still_needed(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) few = {0}, damped = {0};
    ritz_request request = f->request;

    assert_ok(bar_component(ELEMENTS, &bar));
    request.component = request.owned = &bar;
    request.choice.interface_modes = 1;
    assert_ok(ritz_basis_make(&ritz_method_craig_bampton, &request, &few));
    assert_non_null(bar.K.val);
    request.choice.interface_modes = 0;
    assert_ok(ritz_sparse_copy(&bar.K, &bar.D));
    assert_ok(ritz_basis_make(&ritz_method_craig_bampton, &request, &damped));
    assert_non_null(bar.M.val);
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_survives_every_allocation(
        ritz_method_craig_bampton.make(&f->request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(constraint_modes_are_linear),
    cmocka_unit_test(columns_say_what_they_are),
    cmocka_unit_test(reduced_stiffness_is_block_diagonal),
    cmocka_unit_test(reduced_eigenvalues_bound_those_of_the_mesh),
    cmocka_unit_test(modes_are_chosen_by_frequency),
    cmocka_unit_test(guyan_is_exact_statically),
    cmocka_unit_test(boundary_must_be_a_set_of_dofs),
    cmocka_unit_test(free_rigid_body_motion_is_refused_by_name),
    cmocka_unit_test(indefinite_stiffness_is_refused_by_name),
    cmocka_unit_test(requests_that_make_no_sense_are_refused),
    cmocka_unit_test(matrices_that_are_not_needed_are_freed_if_owned),
    cmocka_unit_test(matrices_are_kept_where_they_are_still_needed),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(craig_bampton, tests, set_up, tear_down)
