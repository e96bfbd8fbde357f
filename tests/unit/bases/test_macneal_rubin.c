#include "testing.h"

#include "bar.h"
#include "fixtures/lattice.h"
#include "masses.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/verify.h>

#include <float.h>
#include <stdlib.h>

enum { ELEMENTS = 16, DOFS = ELEMENTS + 1, MODES = 4 };

/* Rounding of a solve: the condition number of the bar is (2 / pi h)^2. */
static const double solve_error = DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS;

static int64_t attached[] = {0, 5, DOFS - 1};

typedef struct fixture {
    ritz_component bar;
    ritz_request request;
    ritz_basis basis;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.bar;
    f.request.attached = (ritz_dofs){3, attached};
    f.request.modes = MODES;
    assert_ok(bar_component(ELEMENTS, &f.bar));
    assert_ok(
        ritz_basis_make(&ritz_method_macneal_rubin, &f.request, &f.basis));
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

static void columns_are_rigid_then_normal_then_residual(void **state)
{
    const ritz_columns *columns = &((fixture *)*state)->basis.columns;

    assert_int_equal(columns->count, 1 + MODES + 3);
    assert_int_equal(columns->kind[0], RITZ_COLUMN_RIGID);
    assert_true(columns->hertz[0] == 0.0);
    for (int64_t j = 1; j <= MODES; j++) {
        double exact = ritz_eigen_hertz(bar_eigenvalue(ELEMENTS, j));

        assert_int_equal(columns->kind[j], RITZ_COLUMN_NORMAL);
        assert_near(columns->hertz[j], exact, solve_error * exact);
    }
    for (int64_t j = 0; j < 3; j++) {
        assert_int_equal(columns->kind[1 + MODES + j], RITZ_COLUMN_RESIDUAL);
        assert_int_equal(columns->dof[1 + MODES + j], attached[j]);
    }
}

/* Phi' M Psi = 0 and Phi' K Psi = 0, to the accuracy of a solve. */
static void residual_modes_are_orthogonal_to_kept_ones(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) Kr = project(&f->bar.K, &f->basis.T);
    RITZ_OWN(ritz_dense) Mr = project(&f->bar.M, &f->basis.T);

    for (int64_t j = 1 + MODES; j < Kr.ncol; j++)
        for (int64_t i = 0; i <= MODES; i++) {
            double stiffness =
                sqrt(bar_eigenvalue(ELEMENTS, i) * ritz_dense_col(&Kr, j)[j]);
            double mass = sqrt(ritz_dense_col(&Mr, j)[j]);

            assert_near(ritz_dense_col(&Mr, j)[i], 0.0, solve_error * mass);
            assert_near(ritz_dense_col(&Kr, j)[i], 0.0,
                        solve_error * (stiffness + mass));
        }
}

/*
 * K Psi = F - M Phi Phi'F and Phi' M Psi = 0 of a bar that is large enough for
 * the search to lend its factor: 40 modes to the shift of the search, so that
 * sweeps contract; with 2 modes a factor is made.
 */
static void residual_modes_of_a_long_bar_solve_their_equation(void **state)
{
    enum { LONG = 800, ROWS = LONG + 1 };
    const int64_t numbers[] = {2, 40};
    int64_t ends[] = {0, LONG};
    ritz_component bar = {0};

    (void)state;
    assert_ok(bar_component(LONG, &bar));
    for (size_t k = 0; k < 2; k++) {
        ritz_request request = RITZ_REQUEST_NONE;
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_dense) KT = {0}, MT = {0}, C = {0};
        ritz_dense Psi = {0};

        request.component = &bar;
        request.attached = (ritz_dofs){2, ends};
        request.modes = numbers[k];
        assert_ok(
            ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
        assert_int_equal(basis.T.ncol, 1 + numbers[k] + 2);
        assert_ok(ritz_sparse_mul(&bar.K, &basis.T, &KT));
        assert_ok(ritz_sparse_mul(&bar.M, &basis.T, &MT));
        Psi = ritz_dense_part(&basis.T, 1 + numbers[k], 2);
        assert_ok(ritz_dense_mul_tn(&MT, &Psi, &C));
        for (int64_t j = 0; j < 2; j++) {
            const double *KPsi = ritz_dense_col(&KT, 1 + numbers[k] + j);
            const double size = ritz_dense_col_max(&Psi, j);
            double G[ROWS] = {0.0};

            G[ends[j]] = 1.0;
            for (int64_t m = 0; m <= numbers[k]; m++) {
                const double share = ritz_dense_col(&basis.T, m)[ends[j]];

                assert_near(ritz_dense_col(&C, j)[m], 0.0, 1e-13 * size);
                for (int64_t i = 0; i < ROWS; i++)
                    G[i] -= ritz_dense_col(&MT, m)[i] * share;
            }
            for (int64_t i = 0; i < ROWS; i++) /* |K||Psi| is 4 size / h */
                assert_near(KPsi[i], G[i], 4.0 * LONG * 1e-13 * size);
        }
    }
    ritz_component_free(&bar);
}

/*
 * Psi of equation (6) as it is printed, with a support at dof r: S is the
 * inverse of K without row and column r, bordered by zeros.
 */
static void find_by_the_book(const fixture *f, int64_t r, ritz_dense *out)
{
    ritz_dofs support = {1, &r}, rest = {0};
    RITZ_OWN(ritz_sparse) K_ii = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    const ritz_dense *T = &f->basis.T;
    ritz_dense MT = {0}, X = {0};

    assert_ok(ritz_dense_new(DOFS, 3, out));
    assert_ok(ritz_dofs_complement(&support, DOFS, &rest));
    assert_ok(ritz_sparse_extract(&f->bar.K, rest.count, rest.at, rest.count,
                                  rest.at, &K_ii));
    assert_ok(ritz_factor_spd(&K_ii, &L));
    assert_ok(ritz_sparse_mul(&f->bar.M, T, &MT));
    for (int64_t j = 0; j < 3; j++) {
        double F[DOFS] = {0.0};
        double *psi = ritz_dense_col(out, j);
        double share = ritz_dense_col(T, 0)[attached[j]];

        F[attached[j]] = 1.0; /* P F = F - M Phi_r Phi_r' F */
        for (int64_t i = 0; i < DOFS; i++)
            F[i] -= ritz_dense_col(&MT, 0)[i] * share;
        assert_ok(ritz_dense_new(rest.count, 1, &X));
        for (int64_t i = 0; i < rest.count; i++)
            X.val[i] = F[rest.at[i]];
        assert_ok(ritz_factor_solve(L, &X));
        for (int64_t i = 0; i < rest.count; i++)
            psi[rest.at[i]] = X.val[i];
        ritz_dense_free(&X);
        share = 0.0; /* P' S P F */
        for (int64_t i = 0; i < DOFS; i++)
            share += ritz_dense_col(&MT, 0)[i] * psi[i];
        for (int64_t i = 0; i < DOFS; i++)
            psi[i] -= ritz_dense_col(T, 0)[i] * share;
        for (int64_t k = 1; k <= MODES; k++)
            for (int64_t i = 0; i < DOFS; i++)
                psi[i] -= ritz_dense_col(T, k)[i] *
                          ritz_dense_col(T, k)[attached[j]] /
                          bar_eigenvalue(ELEMENTS, k);
    }
    ritz_dofs_free(&rest);
    ritz_dense_free(&MT);
}

static void the_formula_with_any_support_gives_the_same(void **state)
{
    fixture *f = *state;
    const int64_t supports[] = {0, 7, DOFS - 1};

    for (int s = 0; s < 3; s++) {
        RITZ_OWN(ritz_dense) Psi = {0};

        find_by_the_book(f, supports[s], &Psi);
        for (int64_t j = 0; j < 3; j++)
            for (int64_t i = 0; i < DOFS; i++)
                assert_near(ritz_dense_col(&f->basis.T, 1 + MODES + j)[i],
                            ritz_dense_col(&Psi, j)[i], solve_error);
    }
}

/* Flexible static gain at attached dofs: full and reduced agree. */
static void flexible_static_gain_is_exact(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, full = {0}, reduced = {0};
    RITZ_OWN(ritz_io) io = {0}, part = {0};
    RITZ_OWN(ritz_dense) Kr = project(&f->bar.K, &f->basis.T);
    RITZ_OWN(ritz_dense) Mr = project(&f->bar.M, &f->basis.T);

    assert_ok(ritz_io_new(DOFS, 3, 3, &io));
    for (int64_t j = 0; j < 3; j++) {
        ritz_dense_col(&io.B, j)[attached[j]] = 1.0;
        ritz_dense_col(&io.C, attached[j])[j] = 1.0;
    }
    assert_ok(ritz_io_project(&io, &f->basis.T, &part));
    assert_ok(ritz_sparse_dense(&f->bar.K, &K));
    assert_ok(ritz_sparse_dense(&f->bar.M, &M));
    assert_ok(ritz_static_gain(&K, &M, &io, 0, &full));
    assert_ok(ritz_static_gain(&Kr, &Mr, &part, 0, &reduced));
    for (int64_t k = 0; k < 9; k++)
        assert_near(reduced.val[k], full.val[k],
                    10.0 * solve_error * ritz_dense_max(&full));
}

/* With all modes kept nothing is left to answer: residual modes are dropped. */
static void residual_modes_of_nothing_are_left_out_and_named(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = DOFS - 1;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, DOFS);
    assert_non_null(strstr(basis.remark, "3 residual mode(s) left out"));
    assert_non_null(strstr(basis.remark, "grid 1 T1"));
}

/* Two flexible modes are left out, so three residual modes are dependent. */
static void dependent_residual_modes_are_left_out(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = DOFS - 3;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, DOFS);
    assert_non_null(strstr(basis.remark, "1 residual mode(s) left out"));
}

static void a_dof_attached_twice_is_refused(void **state)
{
    fixture *f = *state;
    int64_t twice[] = {4, 4};
    ritz_request request = f->request;
    ritz_basis none = {0};

    request.attached = (ritz_dofs){2, twice};
    assert_fails(ritz_basis_make(&ritz_method_macneal_rubin, &request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
}

/* A mass alone is all rigid modes, and its residual is nothing. */
static void a_rigid_body_keeps_its_mass(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) mass = {0};
    int64_t zero = 0;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(masses_component(1, &(double){4.0}, &(double){0.0}, NULL, &mass));
    request.component = &mass;
    request.attached = (ritz_dofs){1, &zero};
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, 1);
    assert_near(basis.T.val[0], 0.5, 4 * DBL_EPSILON);
}

/*
 * Masses of 1 on springs 1 and 1e9, and a mass that nothing holds. With no
 * flexible mode kept, the residual of the first mass is all of its flexibility:
 * it moves against a body of 2, (2/3)^2 / 1 beside what 1e9 adds, below 1e-9.
 * Rounding is eps 1e9, the ratio of the eigenvalues; 4 for the sums.
 */
static void without_flexible_modes_the_residual_is_all_flexibility(void **state)
{
    static const int64_t row[] = {0, 1, 0, 1, 1, 2, 1, 2};
    static const int64_t col[] = {0, 0, 1, 1, 2, 1, 1, 2};
    static const double k[] = {1, -1, -1, 1, -1e9, -1e9, 1e9, 1e9};
    static const int64_t all[] = {0, 1, 2, 3};
    static const double one[] = {1, 1, 1, 1};
    static int64_t ends[] = {0, 3};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) chain = {.num_dofs = 4};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_non_null(chain.dof = calloc(4, sizeof *chain.dof));
    for (int64_t i = 0; i < 4; i++)
        chain.dof[i] = (ritz_dof){i + 1, 1};
    assert_ok(ritz_sparse_from_triplets(4, 4, 8, row, col, k, &chain.K));
    assert_ok(ritz_sparse_from_triplets(4, 4, 4, all, all, one, &chain.M));
    assert_ok(ritz_component_settle(&chain, false));
    request.component = &chain;
    request.modes = 0;
    request.attached = (ritz_dofs){2, ends};
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, 3);
    assert_int_equal(basis.columns.kind[2], RITZ_COLUMN_RESIDUAL);
    assert_int_equal(basis.columns.dof[2], 0);
    assert_near(ritz_dense_col(&basis.T, 2)[0], 4.0 / 9.0,
                1e-9 + 4 * DBL_EPSILON * 1e9);
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_survives_every_allocation(
        ritz_method_macneal_rubin.make(&f->request, &basis));
}

/* A free cube, whose modes by substructures have residuals of 1e-4 or less: each
   sweep brings back a part of residual modes in these modes, which is removed
   again. That is no lack of convergence. */
static void residual_modes_exist_for_approximate_modes(void **state)
{
    enum { EDGE = 12, SOME = 40 };
    int64_t at[] = {0, 800};
    RITZ_OWN(ritz_component) cube = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) MT = {0}, C = {0};

    (void)state;
    lattice_new(EDGE, 0.0, &cube.K, &cube.M);
    cube.num_dofs = cube.K.nrow;
    for (int64_t j = 0; j < cube.K.ncol; j++) { /* free: rows have sum 0 */
        double sum = 0.0;
        int64_t diagonal = -1;

        for (int64_t q = cube.K.colptr[j]; q < cube.K.colptr[j + 1]; q++) {
            sum += cube.K.val[q];
            diagonal = cube.K.rowind[q] == j ? q : diagonal;
        }
        cube.K.val[diagonal] -= sum;
    }
    request.component = &cube;
    request.attached = (ritz_dofs){2, at};
    request.modes = SOME;
    request.choice.engine = RITZ_ENGINE_AMLS;
    request.choice.given |= RITZ_USES_ENGINE;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_non_null(strstr(basis.origin.engine, "substructures"));
    assert_true(basis.T.ncol >= SOME + 2);
    assert_ok(ritz_sparse_mul(&cube.M, &basis.T, &MT));
    assert_ok(ritz_dense_mul_tn(&MT, &basis.T, &C));
    for (int64_t j = basis.T.ncol - 2; j < basis.T.ncol; j++)
        for (int64_t m = 0; m < basis.T.ncol - 2; m++)
            assert_near(ritz_dense_col(&C, j)[m], 0.0,
                        1e-12 * ritz_dense_col_max(&basis.T, j));
}

/* Modes that the request knows are copied, as their changed signs show here, but
   only if the mode above them is known too. */
static void known_modes_are_not_computed(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    const ritz_span span = {.modes = MODES + 1};
    RITZ_OWN(ritz_pairs) known = {0};
    double sign[2] = {0.0};

    assert_ok(ritz_eigen_sparse(&f->bar.K, &f->bar.M, &span, &known));
    for (int64_t k = 0; k < known.Phi.nrow * known.Phi.ncol; k++)
        known.Phi.val[k] = -known.Phi.val[k];
    request.known = &known;
    for (int more = 0; more < 2; more++) {
        RITZ_OWN(ritz_basis) basis = {0};

        request.modes = MODES + more;
        assert_ok(
            ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
        assert_int_equal(basis.T.ncol, f->basis.T.ncol + more);
        sign[more] = basis.T.val[0] / f->basis.T.val[0];
        if (more)
            continue;
        for (int64_t k = 0; k < DOFS * f->basis.T.ncol; k++) {
            const bool mode = k < DOFS * (1 + MODES);

            assert_near(basis.T.val[k], (mode ? -1.0 : 1.0) * f->basis.T.val[k],
                        solve_error * ritz_dense_max(&basis.T));
        }
    }
    assert_near(sign[0], -1.0, solve_error);
    assert_near(sign[1], 1.0, solve_error);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(columns_are_rigid_then_normal_then_residual),
    cmocka_unit_test(residual_modes_of_a_long_bar_solve_their_equation),
    cmocka_unit_test(residual_modes_exist_for_approximate_modes),
    cmocka_unit_test(residual_modes_are_orthogonal_to_kept_ones),
    cmocka_unit_test(the_formula_with_any_support_gives_the_same),
    cmocka_unit_test(flexible_static_gain_is_exact),
    cmocka_unit_test(residual_modes_of_nothing_are_left_out_and_named),
    cmocka_unit_test(dependent_residual_modes_are_left_out),
    cmocka_unit_test(a_dof_attached_twice_is_refused),
    cmocka_unit_test(a_rigid_body_keeps_its_mass),
    cmocka_unit_test(without_flexible_modes_the_residual_is_all_flexibility),
    cmocka_unit_test(known_modes_are_not_computed),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(macneal_rubin, tests, set_up, tear_down)
