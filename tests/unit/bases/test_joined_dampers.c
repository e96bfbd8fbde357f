/*
 * Static vectors of dampers inside bodies with attached dofs: for every basis,
 * the response to a damper's pair of forces lies in the span of the basis
 * [ChuMilman1992].
 */
#include "testing.h"

#include "project.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MASSES = 30, MODES = 6, DAMPERS = 3, HELD = 2 };

static const int64_t damped[DAMPERS] = {2, 9, 17};

/* Rounding of a solve with K of the chain, whose condition number is 3e3
   (test_normal_modes.c derives it). The tests allow a hundred times as much. */
static const double solve_error = MASSES * DBL_EPSILON * 3e3;

typedef struct fixture {
    ritz_component chain;
    int64_t held[HELD];
    ritz_neighbour neighbour; /* for loaded-interface */
    ritz_request request;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.held = {12, 29}, .request = RITZ_REQUEST_NONE};
    assert_ok(spring_chain(MASSES, false, &f.chain));
    assert_ok(spring_chain_damp(&f.chain, DAMPERS, damped, 150.0, -200.0));
    assert_ok(ritz_dense_new(HELD, HELD, &f.neighbour.K));
    assert_ok(ritz_dense_new(HELD, HELD, &f.neighbour.M));
    for (int k = 0; k < HELD; k++) {
        ritz_dense_col(&f.neighbour.K, k)[k] = 500.0;
        ritz_dense_col(&f.neighbour.M, k)[k] = 3.0;
    }
    f.request.component = &f.chain;
    f.request.modes = MODES;
    f.request.attached = (ritz_dofs){HELD, f.held};
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->chain);
    ritz_dense_free(&f->neighbour.K);
    ritz_dense_free(&f->neighbour.M);
    return 0;
}

/* b'A^-1 b for a symmetric positive definite A. */
static double flexibility(const ritz_dense *A, const double *b)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) L = {0};
    double x[2 * MASSES];
    double sum = 0.0;

    assert_true(n <= 2 * MASSES);
    assert_ok(ritz_dense_copy(A, &L));
    memcpy(x, b, (size_t)n * sizeof *x);
    assert_int_equal(LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', n, 1, L.val, n, x, n),
                     0);
    for (int i = 0; i < n; i++)
        sum += b[i] * x[i];
    return sum;
}

/* K of the chain; for loaded-interface with the neighbour's stiffness added. */
static ritz_dense stiffness(const fixture *f, const ritz_method *method)
{
    ritz_dense K = {0};

    assert_ok(ritz_sparse_dense(&f->chain.K, &K));
    for (int k = 0; k < HELD && method->uses & RITZ_USES_NEIGHBOUR; k++)
        ritz_dense_col(&K, f->held[k])[f->held[k]] +=
            ritz_dense_col(&f->neighbour.K, k)[k];
    return K;
}

/* Largest fraction of the strain energy of a damper's static response that lies
   outside the span of T. */
static double missing(const fixture *f, const ritz_method *method,
                      const ritz_dense *T)
{
    RITZ_OWN(ritz_dense) K = stiffness(f, method), K_r = {0}, B_r = {0};
    double worst = 0.0;

    assert_ok(ritz_dense_congruence(&K, T, &K_r));
    assert_ok(ritz_dense_mul_tn(T, &f->chain.dampers.B, &B_r));
    for (int64_t d = 0; d < DAMPERS; d++) {
        double all = flexibility(&K, ritz_dense_col(&f->chain.dampers.B, d));
        double has = flexibility(&K_r, ritz_dense_col(&B_r, d));

        worst = fmax(worst, (all - has) / all);
    }
    return worst;
}

static ritz_basis basis_of(const fixture *f, const ritz_method *method,
                           int loads)
{
    ritz_request request = f->request;
    ritz_basis basis = {0};

    if (!(method->uses & RITZ_USES_MODES))
        request.modes = -1;
    if (method->uses & RITZ_USES_NEIGHBOUR)
        request.neighbour = &f->neighbour;
    if (loads) {
        request.choice.given = RITZ_USES_LOADS;
        request.choice.loads = loads;
    }
    assert_ok(ritz_basis_make(method, &request, &basis));
    return basis;
}

/* Methods with modes, MODAL of them; then those with Krylov vectors. */
static const ritz_method *const joined[] = {
    &ritz_method_craig_bampton,
    &ritz_method_macneal_rubin,
    &ritz_method_macneal,
    &ritz_method_inertia_relief,
    &ritz_method_rubin,
    &ritz_method_dual_craig_bampton,
    &ritz_method_loaded_interface,
    &ritz_method_krylov_cms_fixed,
    &ritz_method_krylov_cms_free,
    NULL,
};

enum { MODAL = 7 };

/* guyan and irs have static vectors of loads only on request. The constraint
   modes of irs are corrected for inertia, so that they span static responses
   only approximately. */
static const ritz_method *const bare[] = {&ritz_method_guyan, &ritz_method_irs,
                                          NULL};

static void responses_along_dampers_are_spanned(void **state)
{
    const fixture *f = *state;

    for (const ritz_method *const *m = joined; *m; m++) {
        RITZ_OWN(ritz_basis) with = basis_of(f, *m, 0);
        RITZ_OWN(ritz_basis) without = basis_of(f, *m, RITZ_LOADS_ATTACHED);

        assert_near(missing(f, *m, &with.T), 0.0, 100.0 * solve_error);
        assert_true(missing(f, *m, &without.T) > 0.5);
        assert_null(strstr(with.remark, "without a static vector"));
        assert_non_null(
            strstr(without.remark, "3 damper(s) without a static vector"));
    }
    for (const ritz_method *const *m = bare; *m; m++) {
        RITZ_OWN(ritz_basis) with = basis_of(f, *m, RITZ_LOADS_DAMPERS);
        RITZ_OWN(ritz_basis) without = basis_of(f, *m, 0);

        assert_near(missing(f, *m, &with.T), 0.0,
                    *m == &ritz_method_irs ? 0.01 : 100.0 * solve_error);
        assert_true(missing(f, *m, &without.T) > 0.5);
        assert_int_equal(with.T.ncol, HELD + DAMPERS);
        assert_int_equal(without.T.ncol, HELD);
        assert_non_null(
            strstr(without.remark, "3 damper(s) without a static vector"));
    }
}

/* A damping matrix gets no vectors. Where it is no a M + b K, a remark says so,
   and how many dofs that concerns. */
static void a_damping_matrix_without_vectors_is_remarked(void **state)
{
    const fixture *f = *state;
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = f->request;
    char due[64];

    assert_ok(spring_chain(MASSES, false, &chain));
    request.component = &chain;
    for (int local = 0; local < 2; local++) {
        RITZ_OWN(ritz_dense) D = {0}, M = {0};
        int64_t touched = 0;

        assert_ok(ritz_sparse_dense(&chain.K, &D));
        assert_ok(ritz_sparse_dense(&chain.M, &M));
        for (int64_t k = 0; k < MASSES * MASSES; k++)
            D.val[k] = 0.02 * M.val[k] + 3e-4 * D.val[k];
        for (int64_t i = 0; i < MASSES && local; i++) {
            double size = 0.0;

            for (int64_t d = 0; d < DAMPERS; d++) {
                const double *b = ritz_dense_col(&f->chain.dampers.B, d);

                size += fabs(b[i]);
                for (int64_t j = 0; j < MASSES; j++)
                    ritz_dense_col(&D, j)[i] += 150.0 * b[i] * b[j];
            }
            touched += size > 0.0;
        }
        snprintf(due, sizeof due, "no a M + b K at %d dof(s)", (int)touched);
        ritz_sparse_free(&chain.D);
        assert_ok(ritz_sparse_from_dense(&D, &chain.D));
        for (const ritz_method *const *m = joined; *m; m++) {
            RITZ_OWN(ritz_basis) basis = {0};

            request.neighbour =
                (*m)->uses & RITZ_USES_NEIGHBOUR ? &f->neighbour : NULL;
            assert_ok(ritz_basis_make(*m, &request, &basis));
            if (local)
                assert_non_null(strstr(basis.remark, due));
            else
                assert_null(strstr(basis.remark, "damping matrix"));
        }
    }
}

/* Columns of the interface and of modes do not change; the additional columns
   are static vectors, which belong to no dof. */
static void other_columns_do_not_change(void **state)
{
    const fixture *f = *state;

    for (int m = 0; m < MODAL; m++) {
        RITZ_OWN(ritz_basis) with = basis_of(f, joined[m], 0);
        RITZ_OWN(ritz_basis)
        without = basis_of(f, joined[m], RITZ_LOADS_ATTACHED);

        assert_int_equal(with.T.ncol, without.T.ncol + DAMPERS);
        for (int64_t j = 0; j < without.T.ncol; j++) {
            double largest = ritz_dense_col_max(&without.T, j);

            assert_int_equal(with.columns.kind[j], without.columns.kind[j]);
            assert_int_equal(with.columns.dof[j], without.columns.dof[j]);
            for (int64_t i = 0; i < MASSES; i++)
                assert_near(ritz_dense_col(&with.T, j)[i],
                            ritz_dense_col(&without.T, j)[i],
                            100.0 * solve_error * largest);
        }
        for (int64_t j = without.T.ncol; j < with.T.ncol; j++) {
            assert_int_equal(with.columns.kind[j], RITZ_COLUMN_STATIC);
            assert_int_equal(with.columns.dof[j], -1);
        }
    }
}

/* In dual-craig-bampton K does not couple interface forces with static vectors;
   in rubin all columns after the first HELD vanish at the attached dofs. */
static void static_vectors_leave_the_interface_alone(void **state)
{
    const fixture *f = *state;
    RITZ_OWN(ritz_basis)
    dual = basis_of(f, &ritz_method_dual_craig_bampton, 0);
    RITZ_OWN(ritz_basis) rubin = basis_of(f, &ritz_method_rubin, 0);
    RITZ_OWN(ritz_dense) K = project(&f->chain.K, &dual.T);

    for (int64_t j = 0; j < K.ncol; j++)
        for (int64_t i = 0; i < K.ncol; i++)
            if (dual.columns.kind[i] == RITZ_COLUMN_FORCE &&
                dual.columns.kind[j] == RITZ_COLUMN_STATIC)
                assert_near(ritz_dense_col(&K, j)[i], 0.0,
                            solve_error * sqrt(ritz_dense_col(&K, i)[i] *
                                               ritz_dense_col(&K, j)[j]));
    for (int64_t j = HELD; j < rubin.T.ncol; j++)
        for (int k = 0; k < HELD; k++)
            assert_near(ritz_dense_col(&rubin.T, j)[f->held[k]], 0.0, 0.0);
}

/* Responses to inputs and to dampers can be requested together. */
static void loads_are_those_asked_for(void **state)
{
    fixture *f = *state;
    ritz_io none = f->chain.io;

    f->chain.io = (ritz_io){0};
    assert_ok(ritz_io_new(MASSES, 1, 0, &f->chain.io));
    memcpy(f->chain.io.input[0], "push", 5);
    f->chain.io.B.val[20] = 1.0;
    for (int m = 0; m < MODAL; m++) {
        RITZ_OWN(ritz_basis) one = basis_of(f, joined[m], RITZ_LOADS_INPUTS);
        RITZ_OWN(ritz_basis)
        all = basis_of(f, joined[m], RITZ_LOADS_INPUTS | RITZ_LOADS_DAMPERS);

        assert_int_equal(all.T.ncol, one.T.ncol + DAMPERS);
        assert_near(missing(f, joined[m], &all.T), 0.0, 100.0 * solve_error);
    }
    ritz_io_free(&f->chain.io);
    f->chain.io = none;
}

/* Constraint modes span the response to a damper between two attached dofs,
   which therefore adds no column. */
static void a_damper_of_the_interface_has_no_vector(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    f->held[0] = 8;
    f->held[1] = 9;
    basis = basis_of(f, &ritz_method_craig_bampton, 0);
    assert_int_equal(basis.T.ncol, HELD + MODES + DAMPERS - 1);
    assert_non_null(strstr(basis.remark, "1 static mode(s) left out"));
    assert_non_null(strstr(basis.remark, "damper 'damper 9'"));
    f->held[0] = 12;
    f->held[1] = 29;
}

static void loads_that_are_not_there_are_refused(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    ritz_component plain = f->chain;
    ritz_basis none = {0};

    plain.dampers = (ritz_dampers){0};
    request.component = &plain;
    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_DAMPERS;
    assert_fails(ritz_basis_make(&ritz_method_rubin, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "there is no load to respond to, no damper");
    assert_fails(ritz_basis_make(&ritz_method_craig_bampton, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "there is no load to respond to, no damper");
    request.choice.loads |= RITZ_LOADS_ATTACHED; /* attached dofs exist */
    assert_ok(ritz_basis_make(&ritz_method_rubin, &request, &none));
    assert_int_equal(none.T.ncol, HELD + MODES);
    ritz_basis_free(&none);
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) one = {0}, two = {0}, three = {0};

    request.neighbour = &f->neighbour;
    assert_survives_every_allocation(
        ritz_method_craig_bampton.make(&f->request, &one));
    assert_survives_every_allocation(ritz_method_rubin.make(&f->request, &two));
    assert_survives_every_allocation(
        ritz_method_loaded_interface.make(&request, &three));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(responses_along_dampers_are_spanned),
    cmocka_unit_test(a_damping_matrix_without_vectors_is_remarked),
    cmocka_unit_test(other_columns_do_not_change),
    cmocka_unit_test(static_vectors_leave_the_interface_alone),
    cmocka_unit_test(loads_are_those_asked_for),
    cmocka_unit_test(a_damper_of_the_interface_has_no_vector),
    cmocka_unit_test(loads_that_are_not_there_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(joined_dampers, tests, set_up, tear_down)
