#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>

enum { ELEMENTS = 16, DOFS = ELEMENTS + 1, ATTACHED = 5 };

/* Rounding of a solve: the condition number of the bar is (2 / pi h)^2. */
static const double solve_error = DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS;

static int64_t spaced[] = {0, 4, 8, 12, 16};

typedef struct fixture {
    ritz_component bar;
    ritz_request request; /* five dofs, rigid motion and four modes */
    ritz_basis basis;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.bar;
    f.request.attached = (ritz_dofs){ATTACHED, spaced};
    f.request.modes = ATTACHED - 1;
    assert_ok(bar_component(ELEMENTS, &f.bar));
    assert_ok(ritz_basis_make(&ritz_method_serep, &f.request, &f.basis));
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

static void assert_modes_exact(const fixture *f, const ritz_basis *basis)
{
    RITZ_OWN(ritz_dense) K = project(&f->bar.K, &basis->T);
    RITZ_OWN(ritz_dense) M = project(&f->bar.M, &basis->T);
    RITZ_OWN(ritz_pairs) pairs = {0};
    double highest = bar_eigenvalue(ELEMENTS, basis->T.ncol - 1);

    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_int_equal(pairs.num_rigid, 1);
    assert_int_equal(pairs.Phi.ncol, basis->T.ncol);
    for (int64_t k = 0; k < pairs.Phi.ncol; k++)
        assert_near(pairs.lambda[k], bar_eigenvalue(ELEMENTS, k),
                    solve_error * highest);
}

static void kept_frequencies_are_exact(void **state)
{
    assert_modes_exact(*state, &((fixture *)*state)->basis);
}

/*
 * The bar's modes are cos(k pi x) on any mesh, so what is measured of one at
 * the attached dofs expands to all of it.
 */
static void measured_shapes_expand_to_whole_ones(void **state)
{
    const fixture *f = *state;
    const double pi = 3.14159265358979323846;

    for (int k = 0; k < ATTACHED; k++)
        for (int64_t i = 0; i < DOFS; i++) {
            double sum = 0.0;

            for (int64_t j = 0; j < ATTACHED; j++)
                sum += ritz_dense_col(&f->basis.T, j)[i] *
                       cos(k * pi * (double)spaced[j] / ELEMENTS);
            assert_near(sum, cos(k * pi * (double)i / ELEMENTS), solve_error);
        }
}

static void columns_are_the_attached_dofs(void **state)
{
    const ritz_basis *basis = &((fixture *)*state)->basis;

    assert_string_equal(basis->origin.reference, "OCallahan1989b");
    assert_int_equal(basis->columns.count, ATTACHED);
    assert_string_equal(basis->remark, "");
    for (int64_t j = 0; j < ATTACHED; j++) {
        assert_int_equal(basis->columns.kind[j], RITZ_COLUMN_CONSTRAINT);
        assert_int_equal(basis->columns.dof[j], spaced[j]);
        for (int64_t i = 0; i < ATTACHED; i++)
            assert_true(ritz_dense_col(&basis->T, j)[spaced[i]] ==
                        (i == j ? 1.0 : 0.0));
    }
}

/* Three modes at five dofs: three of these are coordinates, and named. */
static void fewer_modes_than_dofs_choose_dofs(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = 2;
    assert_ok(ritz_basis_make(&ritz_method_serep, &request, &basis));
    assert_int_equal(basis.T.ncol, 3);
    assert_modes_exact(f, &basis);
    /* the ends and the middle, which tell 1, cos and cos 2 apart best */
    assert_int_equal(basis.columns.dof[0], 0);
    assert_int_equal(basis.columns.dof[1], 8);
    assert_int_equal(basis.columns.dof[2], 16);
    assert_non_null(strstr(basis.remark, "3 of 5 attached dofs are coordinates,"
                                         " which are enough: grid 1 T1, "
                                         "grid 9 T1, grid 17 T1"));
}

/*
 * Three dofs at 1/64 of the bar from each other hardly tell 1, sqrt 2 cos pi x
 * and sqrt 2 cos 2 pi x apart: NumPy gives these, over their size sqrt 2,
 * the singular values 2.72768 and 1.15684e-6.
 */
static void badly_seen_modes_are_reported(void **state)
{
    static int64_t near[] = {0, 1, 2};
    RITZ_OWN(ritz_component) bar = {0};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(bar_component(64, &bar));
    request.component = &bar;
    request.attached = (ritz_dofs){3, near};
    request.modes = 2;
    assert_ok(ritz_basis_make(&ritz_method_serep, &request, &basis));
    assert_string_equal(
        basis.remark,
        "a rigid-body motion is hardly observable at the attached dofs: "
        "condition 2.4e+06");
}

static void more_modes_than_dofs_are_refused(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    ritz_basis none = {0};

    request.modes = ATTACHED;
    assert_fails(ritz_basis_make(&ritz_method_serep, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "5 attached dof(s) cannot show 6 modes, 1 rigid ones among");
}

/* Axial dofs see nothing of bending. */
static void unseen_modes_are_refused_by_name(void **state)
{
    static int64_t axial[] = {0, 3, 6};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) beam = {0};
    ritz_basis none = {0};

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    request.component = &beam;
    request.attached = (ritz_dofs){3, axial};
    request.modes = 2;
    assert_fails(ritz_basis_make(&ritz_method_serep, &request, &none),
                 RITZ_ERR_SINGULAR,
                 "serep: the attached dofs cannot distinguish the kept modes");
    assert_non_null(strstr(ritz_error_message(), "), mode "));
    assert_non_null(strstr(ritz_error_message(), " is least observable: "));
}

static void requests_without_sense_are_refused(void **state)
{
    static int64_t twice[] = {2, 2};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) beam = {0};
    ritz_basis none = {0};

    request.attached = (ritz_dofs){0};
    assert_fails(ritz_basis_make(&ritz_method_serep, &request, &none),
                 RITZ_ERR_ARGUMENT, "serep: nothing is attached");
    request.attached = (ritz_dofs){2, twice};
    assert_fails(ritz_basis_make(&ritz_method_serep, &request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    request.component = &beam;
    request.attached = (ritz_dofs){1, twice};
    request.modes = 0;
    assert_fails(ritz_basis_make(&ritz_method_serep, &request, &none),
                 RITZ_ERR_ARGUMENT, "no mode is kept");
}

/* With all dofs attached and all modes kept, T is I. */
static void all_modes_at_all_dofs_are_no_reduction(void **state)
{
    int64_t at[DOFS];
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_basis) basis = {0};

    for (int64_t i = 0; i < DOFS; i++)
        at[i] = i;
    request.attached = (ritz_dofs){DOFS, at};
    request.modes = DOFS + 7;
    assert_ok(ritz_basis_make(&ritz_method_serep, &request, &basis));
    assert_int_equal(basis.T.ncol, DOFS);
    for (int64_t k = 0; k < DOFS * DOFS; k++)
        assert_true(basis.T.val[k] == (k % (DOFS + 1) == 0 ? 1.0 : 0.0));
}

static void no_allocation_failure_leaks(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = 2;
    assert_survives_every_allocation(ritz_method_serep.make(&request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(kept_frequencies_are_exact),
    cmocka_unit_test(measured_shapes_expand_to_whole_ones),
    cmocka_unit_test(columns_are_the_attached_dofs),
    cmocka_unit_test(fewer_modes_than_dofs_choose_dofs),
    cmocka_unit_test(badly_seen_modes_are_reported),
    cmocka_unit_test(more_modes_than_dofs_are_refused),
    cmocka_unit_test(unseen_modes_are_refused_by_name),
    cmocka_unit_test(requests_without_sense_are_refused),
    cmocka_unit_test(all_modes_at_all_dofs_are_no_reduction),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(serep, tests, set_up, tear_down)
