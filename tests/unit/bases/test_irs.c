#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdlib.h>

enum { ELEMENTS = 32, DOFS = ELEMENTS + 1 };

/* Rounding of a solve: the condition number of the bar is (2 / pi h)^2. */
static const double solve_error = DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS;

typedef struct fixture {
    ritz_component bar;
    ritz_request request; /* every eighth dof */
    ritz_basis guyan, irs;
} fixture;

static int64_t spaced[] = {0, 8, 16, 24, 32};

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.bar;
    f.request.attached = (ritz_dofs){5, spaced};
    assert_ok(bar_component(ELEMENTS, &f.bar));
    assert_ok(ritz_basis_make(&ritz_method_guyan, &f.request, &f.guyan));
    assert_ok(ritz_basis_make(&ritz_method_irs, &f.request, &f.irs));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->bar);
    ritz_basis_free(&f->guyan);
    ritz_basis_free(&f->irs);
    return 0;
}

/* A chain of unit springs between `n` masses, by grid number from 1. */
static void chain(int64_t n, const double *mass, ritz_component *out)
{
    int64_t row[64], col[64], at[16];
    double k[64];
    int64_t count = 0;

    *out = (ritz_component){.num_dofs = n};
    assert_non_null(out->dof = calloc((size_t)n, sizeof *out->dof));
    for (int64_t i = 0; i < n; i++) {
        out->dof[i] = (ritz_dof){i + 1, 1};
        at[i] = i;
    }
    for (int64_t e = 0; e + 1 < n; e++)
        for (int64_t j = 0; j < 4; j++, count++) {
            row[count] = e + j / 2;
            col[count] = e + j % 2;
            k[count] = j / 2 == j % 2 ? 1.0 : -1.0;
        }
    assert_ok(ritz_sparse_from_triplets(n, n, count, row, col, k, &out->K));
    assert_ok(ritz_sparse_from_triplets(n, n, n, at, at, mass, &out->M));
    assert_ok(ritz_component_settle(out, false));
}

/*
 * Two elements of length h, the third dof free: M_R = h [1/3, 1/6; 1/6, 4/3],
 * K_R = [1, -1; -1, 1] / h, and the last row of T is
 *
 *     [0, 1] + h * (h / 2) * (6 / 5 h^2) [-1, 1] = [-3/5, 8/5].
 */
static void a_bar_of_two_elements_by_hand(void **state)
{
    static int64_t at[] = {0, 1};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(bar_component(2, &bar));
    request.component = &bar;
    request.attached = (ritz_dofs){2, at};
    assert_ok(ritz_basis_make(&ritz_method_irs, &request, &basis));
    assert_near(ritz_dense_col(&basis.T, 0)[2], -0.6, 16 * DBL_EPSILON);
    assert_near(ritz_dense_col(&basis.T, 1)[2], 1.6, 16 * DBL_EPSILON);
}

static void columns_are_the_attached_dofs(void **state)
{
    const fixture *f = *state;
    const ritz_columns *columns = &f->irs.columns;

    assert_string_equal(f->irs.origin.reference, "OCallahan1989");
    assert_int_equal(columns->count, 5);
    for (int64_t j = 0; j < 5; j++) {
        assert_int_equal(columns->kind[j], RITZ_COLUMN_CONSTRAINT);
        assert_int_equal(columns->dof[j], spaced[j]);
        for (int64_t i = 0; i < 5; i++)
            assert_true(ritz_dense_col(&f->irs.T, j)[spaced[i]] ==
                        (i == j ? 1.0 : 0.0));
    }
}

/* Relative error of mode 1 with every `step`-th dof attached. */
static double error_of(const fixture *f, const ritz_method *method,
                       int64_t step)
{
    int64_t at[DOFS];
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double exact = bar_eigenvalue(ELEMENTS, 1);
    double error = 0.0;

    request.attached = (ritz_dofs){0, at};
    for (int64_t i = 0; i < DOFS; i += step)
        at[request.attached.count++] = i;
    assert_ok(ritz_basis_make(method, &request, &basis));
    K = project(&f->bar.K, &basis.T);
    M = project(&f->bar.M, &basis.T);
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    error = pairs.lambda[1] / exact - 1.0;
    return error;
}

/*
 * Between attached dofs at distance s the bar's clamped eigenvalues are those
 * of length s, (pi / s)^2: halving s divides lambda / lambda_i by 4. Guyan's
 * error is of first order in it, that of IRS of third: 1.05 and 3.25 measured,
 * higher terms still count. The errors themselves are those of an independent
 * program (NumPy) in dense arithmetic.
 */
static void frequencies_are_right_to_third_order(void **state)
{
    const fixture *f = *state;
    const double coarse[2] = {error_of(f, &ritz_method_guyan, 8),
                              error_of(f, &ritz_method_irs, 8)};
    const double fine[2] = {error_of(f, &ritz_method_guyan, 4),
                            error_of(f, &ritz_method_irs, 4)};

    assert_near(coarse[0], 0.05154200245033613, solve_error);
    assert_near(coarse[1], 9.88753049258051e-06, solve_error);
    assert_near(fine[0], 0.012102872770916484, solve_error);
    assert_near(fine[1], 1.098683473088613e-07, solve_error);
    assert_near(log(coarse[0] / fine[0]) / log(4.0), 1.0, 0.1);
    assert_near(log(coarse[1] / fine[1]) / log(4.0), 3.0, 0.3);
}

/* With (K T_G)_i = 0, T'KT = K_R + C'K_ii C, C what IRS adds: no less stiff. */
static void stiffness_grows_by_what_is_added(void **state)
{
    const fixture *f = *state;
    RITZ_OWN(ritz_dense) guyan = project(&f->bar.K, &f->guyan.T);
    RITZ_OWN(ritz_dense) irs = project(&f->bar.K, &f->irs.T);
    RITZ_OWN(ritz_dense) C = {0}, more = {0};

    assert_ok(ritz_dense_copy(&f->irs.T, &C));
    for (int64_t k = 0; k < C.nrow * C.ncol; k++)
        C.val[k] -= f->guyan.T.val[k];
    more = project(&f->bar.K, &C);
    for (int64_t k = 0; k < 25; k++)
        assert_near(irs.val[k], guyan.val[k] + more.val[k],
                    solve_error * ritz_dense_max(&irs));
    assert_true(more.val[0] > 1e-2 * guyan.val[0]);
}

/* It is one projection: every reduced eigenvalue bounds its own from above. */
static void eigenvalues_are_bounds(void **state)
{
    const fixture *f = *state;
    RITZ_OWN(ritz_dense) K = project(&f->bar.K, &f->irs.T);
    RITZ_OWN(ritz_dense) M = project(&f->bar.M, &f->irs.T);
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_int_equal(pairs.num_rigid, 1);
    for (int64_t k = 1; k < 5; k++)
        assert_true(pairs.lambda[k] >=
                    bar_eigenvalue(ELEMENTS, k) * (1.0 - solve_error));
}

/* K_R is nothing for three dofs that just hold a plane beam: T is T_G, whose
 * columns are its rigid motions. */
static void a_determinate_interface_moves_rigidly(void **state)
{
    static int64_t at[] = {0, 1, 2};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) guyan = {0}, irs = {0};

    (void)state;
    assert_ok(frame_component(6, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    request.component = &beam;
    request.attached = (ritz_dofs){3, at};
    assert_ok(ritz_basis_make(&ritz_method_guyan, &request, &guyan));
    assert_ok(ritz_basis_make(&ritz_method_irs, &request, &irs));
    for (int64_t k = 0; k < irs.T.nrow * irs.T.ncol; k++)
        assert_true(irs.T.val[k] == guyan.T.val[k]);
}

static void with_every_dof_attached_nothing_is_reduced(void **state)
{
    const fixture *f = *state;
    int64_t at[DOFS];
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};

    for (int64_t i = 0; i < DOFS; i++)
        at[i] = i;
    request.attached = (ritz_dofs){DOFS, at};
    assert_ok(ritz_basis_make(&ritz_method_irs, &request, &basis));
    for (int64_t k = 0; k < DOFS * DOFS; k++)
        assert_true(basis.T.val[k] == (k % (DOFS + 1) == 0 ? 1.0 : 0.0));
}

static void bad_attached_dofs_are_refused(void **state)
{
    const fixture *f = *state;
    int64_t at[] = {3, 3, DOFS};
    ritz_request request = f->request;
    ritz_basis none = {0};

    request.attached = (ritz_dofs){0};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_ARGUMENT, "irs: nothing is attached");
    request.attached = (ritz_dofs){2, at};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
    request.attached = (ritz_dofs){1, at + 2};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_ARGUMENT, "not among the 33");
    request.modes = 3;
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_ARGUMENT, "irs has no modes to choose");
}

/* A free part: the fourth mass hangs on nothing once its spring is gone. */
static void a_mechanism_is_named(void **state)
{
    static const double mass[] = {1, 1, 1, 1};
    static int64_t at[] = {0, 1};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) loose = {0};
    ritz_basis none = {0};

    chain(4, mass, &loose);
    for (int64_t p = 0; p < loose.K.colptr[4]; p++)
        if (loose.K.rowind[p] == 3)
            loose.K.val[p] = 0.0;
    for (int64_t p = loose.K.colptr[3]; p < loose.K.colptr[4]; p++)
        loose.K.val[p] = 0.0;
    request.component = &loose;
    request.attached = (ritz_dofs){2, at};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_SINGULAR, "irs: interior stiffness: singular");
    assert_non_null(strstr(ritz_error_message(), "grid 4 T1"));
}

/*
 * Of masses 0, 0, 1 in a chain with the first two attached, the first is
 * nothing by itself; of 0, 1, 0 with the ends attached, both move one mass.
 */
static void attached_dofs_without_mass_are_named(void **state)
{
    static const double ends[] = {0, 0, 1}, middle[] = {0, 1, 0};
    static int64_t first[] = {0, 1}, outer[] = {0, 2};
    ritz_request request = ((fixture *)*state)->request;
    ritz_component body = {0};
    ritz_basis none = {0};

    request.component = &body;
    chain(3, ends, &body);
    request.attached = (ritz_dofs){2, first};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_SINGULAR, "condensed mass is singular: grid 1 T1");
    ritz_component_free(&body);
    chain(3, middle, &body);
    request.attached = (ritz_dofs){2, outer};
    assert_fails(ritz_basis_make(&ritz_method_irs, &request, &none),
                 RITZ_ERR_SINGULAR, "condensed mass is singular: grid 3 T1");
    ritz_component_free(&body);
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_survives_every_allocation(ritz_method_irs.make(&f->request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_bar_of_two_elements_by_hand),
    cmocka_unit_test(columns_are_the_attached_dofs),
    cmocka_unit_test(frequencies_are_right_to_third_order),
    cmocka_unit_test(stiffness_grows_by_what_is_added),
    cmocka_unit_test(eigenvalues_are_bounds),
    cmocka_unit_test(a_determinate_interface_moves_rigidly),
    cmocka_unit_test(with_every_dof_attached_nothing_is_reduced),
    cmocka_unit_test(bad_attached_dofs_are_refused),
    cmocka_unit_test(a_mechanism_is_named),
    cmocka_unit_test(attached_dofs_without_mass_are_named),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(irs, tests, set_up, tear_down)
