/* Mode displacement and mode acceleration of quantities y = S u. */
#include "testing.h"

#include "bar.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <stdio.h>

enum { ELEMENTS = 12, DOFS = ELEMENTS + 1 };

/* A quantity y = S u with zero rows, which put_entry() fills. */
typedef struct rows {
    int64_t count, entries;
    int64_t row[4 * DOFS], col[4 * DOFS];
    double val[4 * DOFS];
} rows;

static void put_entry(int64_t row, int64_t col, double val, rows *out)
{
    out->row[out->entries] = row;
    out->col[out->entries] = col;
    out->val[out->entries++] = val;
    out->count = row + 1 > out->count ? row + 1 : out->count;
}

/* Stress of each element between neighbours: (u_k+1 - u_k) / h. */
static rows stresses(int64_t n, double h)
{
    rows out = {0};

    for (int64_t k = 0; k + 1 < n; k++) {
        put_entry(k, k, -1.0 / h, &out);
        put_entry(k, k + 1, 1.0 / h, &out);
    }
    return out;
}

static void add_quantity(const char *name, const char *kind, const rows *of,
                         ritz_component *c)
{
    ritz_quantity *q = NULL;

    assert_ok(ritz_array_extend(&c->quantity, c->num_quantities, 1,
                                sizeof *c->quantity));
    q = &c->quantity[c->num_quantities++];
    snprintf(q->name, sizeof q->name, "%s", name);
    snprintf(q->kind, sizeof q->kind, "%s", kind);
    q->count = of->count;
    q->place = ritz_zalloc(of->count, sizeof *q->place);
    q->part = ritz_zalloc(of->count, sizeof *q->part);
    assert_non_null(q->place);
    assert_non_null(q->part);
    for (int64_t k = 0; k < of->count; k++)
        q->place[k] = k + 1;
    assert_ok(ritz_sparse_from_triplets(of->count, c->num_dofs, of->entries,
                                        of->row, of->col, of->val, &q->S));
}

static void add_port(int64_t dof, ritz_component *c)
{
    c->port = ritz_zalloc(1, sizeof *c->port);
    assert_non_null(c->port);
    c->num_ports = 1;
    snprintf(c->port[0].name, RITZ_NAME_SIZE, "end");
    c->port[0].dofs.at = ritz_zalloc(1, sizeof(int64_t));
    assert_non_null(c->port[0].dofs.at);
    c->port[0].dofs.at[0] = dof;
    c->port[0].dofs.count = 1;
    c->port[0].axes[0] = c->port[0].axes[4] = c->port[0].axes[8] = 1.0;
}

/* A bar with the stresses of its elements and a force at its right end. */
static void make_bar(ritz_component *out)
{
    const rows stress = stresses(DOFS, 1.0 / ELEMENTS);

    assert_ok(bar_component(ELEMENTS, out));
    ritz_io_free(&out->io);
    assert_ok(ritz_io_new(DOFS, 1, 0, &out->io));
    snprintf(out->io.input[0], RITZ_NAME_SIZE, "push");
    ritz_dense_col(&out->io.B, 0)[DOFS - 1] = 1.0;
    add_quantity("stress", "stress", &stress, out);
    assert_ok(ritz_component_settle(out, false));
}

static ritz_dense identity(int64_t n)
{
    ritz_dense T = {0};

    assert_ok(ritz_dense_identity(n, &T));
    return T;
}

/* Reduce with the first columns of T as basis. */
static void reduce(const ritz_component *c, const ritz_dense *T,
                   const char *ports, ritz_reduced *out,
                   ritz_mode_accelerations *made)
{
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_basis_new(T->nrow, T->ncol, &basis));
    ritz_dense_put(T, 0, 0, &basis.T);
    assert_ok(ritz_reduce(c, &basis, out));
    assert_ok(ritz_mode_acceleration(c, &basis.T, ports, out, made));
    assert_ok(ritz_quantities_check_reduced(out->num_quantities, out->quantity,
                                            out->K.ncol, out->io.num_inputs,
                                            out->dampers.count));
}

/* y_i += sum_j A(i,j) x_j */
static double row_of(const ritz_dense *A, int64_t i, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; A->val && j < A->ncol; j++)
        sum += ritz_dense_col(A, j)[i] * x[j];
    return sum;
}

/* Rounding of a static solution: the condition of the bar is (2 / pi h)^2. */
static const double solve_error =
    DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS * ELEMENTS;

/*
 * A force F at one end of a free bar accelerates it as a rigid body, so that a
 * section carries F m / m_all, where m is the mass behind it. Mode acceleration
 * gives this stress whatever modes are kept. With a consistent mass the stress
 * of a linear element is that at its middle.
 */
static void a_free_bar_has_the_stress_of_the_mass_behind(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) rigid = {0};
    ritz_mode_accelerations made = {0};
    const ritz_quantity *q = NULL;
    const double push = 3.0, acceleration = 3.0, still = 0.0;

    make_bar(&bar);
    assert_ok(ritz_dense_new(DOFS, 1, &rigid));
    for (int64_t k = 0; k < DOFS; k++)
        rigid.val[k] = 1.0; /* of unit mass */
    reduce(&bar, &rigid, NULL, &reduced, &made);
    assert_int_equal(made.count, 1);
    assert_int_equal(made.motions, 1);
    assert_near(made.rigid, 0.0, solve_error); /* of the rigid mode */
    q = reduced.quantity;
    for (int64_t k = 0; k < ELEMENTS; k++)
        assert_near(row_of(&q->Q, k, &still) + row_of(&q->A, k, &acceleration) +
                        row_of(&q->F, k, &push),
                    push * ((double)k + 0.5) / ELEMENTS, push * solve_error);
}

/* The bar is held at its left end by a port, whose force is not known. The
   force at its right end gives all elements the same stress, which mode
   acceleration finds in a basis whose columns contain no part of it. */
static void a_held_bar_has_the_same_stress_everywhere(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) T = {0};
    ritz_mode_accelerations made = {0};
    const double push = 2.0;

    make_bar(&bar);
    add_port(0, &bar);
    assert_ok(ritz_dense_new(DOFS, 1, &T));
    T.val[3] = 1.0;
    reduce(&bar, &T, NULL, &reduced, &made);
    assert_int_equal(made.motions, 0);
    for (int64_t k = 0; k < ELEMENTS; k++) {
        assert_near(row_of(&reduced.quantity->F, k, &push), push,
                    push * solve_error);
        /* (I - G K) T: the port's displacement of this column is 0 */
        assert_near(ritz_dense_col(&reduced.quantity->Q, 0)[k], 0.0,
                    ELEMENTS * solve_error);
    }
}

/*
 * If T is square, q determines u. A motion that satisfies
 *     M u'' + D u' + K u = B f - c b b'u' - k b b'u
 * at all dofs but those of ports then has exactly the stresses S u. The test
 * chooses a motion, and f is the force that it takes at each dof.
 */
static void a_square_basis_gives_the_stresses_of_its_motion(void **)
{
    const int64_t n = 9;
    const int64_t spring[] = {2, 6};
    const rows stress = stresses(n, 1.0);
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) T = identity(n), f = {0}, part = {0};
    RITZ_OWN(ritz_dense) u = {0}, v = {0}, a = {0}, g = {0};
    ritz_mode_accelerations made = {0};
    const ritz_quantity *q = NULL;

    assert_ok(spring_chain(n, false, &chain));
    assert_ok(spring_chain_damp(&chain, 2, spring, 12.0, -150.0));
    assert_ok(ritz_sparse_copy(&chain.K, &chain.D));
    for (int64_t p = 0; p < chain.D.colptr[n]; p++)
        chain.D.val[p] *= 1e-2;
    ritz_io_free(&chain.io);
    assert_ok(ritz_io_new(n, n, 0, &chain.io));
    for (int64_t k = 0; k < n; k++) {
        snprintf(chain.io.input[k], RITZ_NAME_SIZE, "f%d", (int)k);
        ritz_dense_col(&chain.io.B, k)[k] = 1.0;
    }
    add_quantity("stress", "stress", &stress, &chain);
    add_port(4, &chain);
    assert_ok(ritz_component_settle(&chain, false));
    reduce(&chain, &T, NULL, &reduced, &made);
    assert_ok(ritz_dense_new(n, 1, &u));
    assert_ok(ritz_dense_new(n, 1, &v));
    assert_ok(ritz_dense_new(n, 1, &a));
    for (int64_t k = 0; k < n; k++) {
        u.val[k] = sin(1.0 + 2.0 * (double)k);
        v.val[k] = cos(3.0 * (double)k);
        a.val[k] = 100.0 * sin(5.0 * (double)k);
    }
    assert_ok(ritz_sparse_mul(&chain.K, &u, &f));
    assert_ok(ritz_sparse_mul(&chain.D, &v, &part));
    ritz_dense_add(1.0, &part, &f);
    ritz_dense_free(&part);
    assert_ok(ritz_sparse_mul(&chain.M, &a, &part));
    ritz_dense_add(1.0, &part, &f);
    assert_ok(ritz_dense_new(2, 1, &g));
    for (int64_t j = 0; j < 2; j++) {
        const double *b = ritz_dense_col(&reduced.dampers.B, j);

        for (int64_t k = 0; k < n; k++)
            g.val[j] += b[k] * (12.0 * v.val[k] - 150.0 * u.val[k]);
        for (int64_t k = 0; k < n; k++)
            f.val[k] += b[k] * g.val[j];
    }
    f.val[4] = 1e3; /* the port's dof is given: forces there do not matter */
    q = reduced.quantity;
    assert_int_equal(q->H.ncol, 2);
    /* terms of 1e3 over stiffnesses of 1e3, some hundred of them */
    for (int64_t k = 0; k < stress.count; k++)
        assert_near(row_of(&q->Q, k, u.val) + row_of(&q->V, k, v.val) +
                        row_of(&q->A, k, a.val) + row_of(&q->F, k, f.val) -
                        row_of(&q->H, k, g.val),
                    u.val[k + 1] - u.val[k], 100.0 * 1e2 * DBL_EPSILON);
}

/* Mode acceleration is refused to rows that follow rigid motion and to
   accelerations; other quantities of the same model get it. */
static void rows_that_follow_rigid_motion_are_left_out(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, held = {0};
    RITZ_OWN(ritz_dense) T = {0};
    ritz_mode_accelerations made = {0};
    rows tip = {0};

    put_entry(0, DOFS - 1, 1.0, &tip);
    make_bar(&bar);
    add_quantity("tip", "displacement", &tip, &bar);
    assert_ok(ritz_dense_new(DOFS, 1, &T));
    T.val[1] = 1.0;
    reduce(&bar, &T, NULL, &reduced, &made);
    assert_int_equal(made.count, 1);
    assert_non_null(
        strstr(made.reason, "grid 1 of 'tip' follows rigid motion"));
    assert_non_null(reduced.quantity[0].Q.val);
    assert_null(reduced.quantity[1].Q.val);
    assert_non_null(reduced.quantity[1].ST.val);
    add_quantity("felt", "acceleration", &tip, &bar);
    add_port(0, &bar);
    reduce(&bar, &T, NULL, &held, &made);
    assert_int_equal(made.count, 2); /* the port holds the bar */
    assert_non_null(strstr(made.reason, "'felt' is of kind acceleration"));
}

static void what_makes_no_sense_is_refused(void **)
{
    RITZ_OWN(ritz_component) bar = {0}, bare = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) T = identity(DOFS);
    RITZ_OWN(ritz_dense) few = identity(DOFS - 1);
    ritz_mode_accelerations made = {0};

    make_bar(&bar);
    reduce(&bar, &T, "", &reduced, &made);
    assert_fails(ritz_mode_acceleration(&bar, &T, "tip", &reduced, &made),
                 RITZ_ERR_ARGUMENT, "there is no port 'tip'");
    assert_fails(ritz_mode_acceleration(&bar, &few, NULL, &reduced, &made),
                 RITZ_ERR_ARGUMENT, "not of this component and basis");
    assert_ok(bar_component(ELEMENTS, &bare));
    assert_fails(ritz_mode_acceleration(&bare, &T, NULL, &reduced, &made),
                 RITZ_ERR_ARGUMENT, "no rows to recover");
}

/* Each method that makes second-order models has the rows S T, and S T T_2
   after a second projection T_2. */
static void every_method_carries_rows(void **)
{
    int64_t attached[] = {0};
    int carried = 0;

    for (const ritz_method *const *m = ritz_methods; *m; m++) {
        RITZ_OWN(ritz_component) bar = {0};
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0}, again = {0};
        RITZ_OWN(ritz_dense) due = {0}, twice = {0};
        RITZ_OWN(ritz_dense) V = {0};
        ritz_request request = RITZ_REQUEST_NONE;

        make_bar(&bar);
        request.component = &bar;
        request.attached = (ritz_dofs){1, attached};
        request.modes = 4;
        if (ritz_basis_make(*m, &request, &basis) != RITZ_OK || basis.states ||
            basis.W.val)
            continue;
        carried++;
        assert_ok(ritz_reduce(&bar, &basis, &reduced));
        assert_int_equal(reduced.num_quantities, 1);
        assert_ok(ritz_sparse_mul(&bar.quantity->S, &basis.T, &due));
        assert_memory_equal(due.val, reduced.quantity->ST.val,
                            (size_t)(due.nrow * due.ncol) * sizeof *due.val);
        assert_ok(ritz_dense_new(basis.T.ncol, 1, &V));
        V.val[0] = 2.0;
        assert_ok(ritz_reduced_project(&reduced, &V, &again));
        assert_ok(ritz_dense_mul(&due, &V, &twice));
        assert_memory_equal(twice.val, again.quantity->ST.val,
                            (size_t)twice.nrow * sizeof *twice.val);
    }
    assert_true(carried >= 10);
}

/* A projection multiplies all matrices that act on coordinates; those of
   inputs and dampers stay. */
static void mode_acceleration_is_projected(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, again = {0};
    RITZ_OWN(ritz_dense) T = identity(DOFS);
    RITZ_OWN(ritz_dense) V = {0};
    ritz_mode_accelerations made = {0};

    make_bar(&bar);
    add_port(0, &bar);
    reduce(&bar, &T, NULL, &reduced, &made);
    assert_ok(ritz_dense_new(DOFS, 1, &V));
    V.val[5] = 2.0;
    assert_ok(ritz_reduced_project(&reduced, &V, &again));
    for (int64_t k = 0; k < ELEMENTS; k++) {
        assert_near(again.quantity->Q.val[k],
                    2.0 * ritz_dense_col(&reduced.quantity->Q, 5)[k], 0.0);
        assert_near(again.quantity->A.val[k],
                    2.0 * ritz_dense_col(&reduced.quantity->A, 5)[k], 0.0);
        assert_near(again.quantity->F.val[k], reduced.quantity->F.val[k], 0.0);
    }
    assert_null(again.quantity->V.val);
}

/* Each try makes the whole reduction, so that it starts without results of
   the last. */
static ritz_status reduce_once(const ritz_component *bar,
                               const ritz_basis *basis)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_mode_accelerations made = {0};

    RITZ_CHECK(ritz_reduce(bar, basis, &reduced));
    return ritz_mode_acceleration(bar, &basis->T, NULL, &reduced, &made);
}

static void all_allocations_may_fail(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    make_bar(&bar);
    add_port(0, &bar);
    assert_ok(ritz_basis_new(DOFS, 2, &basis));
    basis.T.val[4] = basis.T.val[DOFS + 6] = 1.0;
    assert_survives_every_allocation(reduce_once(&bar, &basis));
}

static void quantities_that_do_not_fit_are_refused(void **)
{
    RITZ_OWN(ritz_component) bar = {0};
    ritz_quantity *q = NULL;
    char name[RITZ_QUANTITY_NAME_SIZE];

    make_bar(&bar);
    q = bar.quantity;
    assert_string_equal(ritz_quantity_name(q, 2, name), "element 3");
    q->place[2] = 0;
    snprintf(q->part[2], RITZ_NAME_SIZE, "sx");
    assert_string_equal(ritz_quantity_name(q, 2, name), "row 3 sx");
    snprintf(q->kind, sizeof q->kind, "strain");
    assert_fails(ritz_quantities_check(1, q, DOFS), RITZ_ERR_FORMAT,
                 "kind 'strain', which is none of stress");
    snprintf(q->kind, sizeof q->kind, "other");
    assert_fails(ritz_quantities_check(1, q, DOFS + 1), RITZ_ERR_FORMAT,
                 "where 12 x 14 is due");
    q->S.val[0] = HUGE_VAL;
    assert_fails(ritz_quantities_check(1, q, DOFS), RITZ_ERR_FORMAT, "stress");
    snprintf(q->name, sizeof q->name, "a/b");
    assert_fails(ritz_quantities_check(1, q, DOFS), RITZ_ERR_FORMAT,
                 "cannot be the name");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_free_bar_has_the_stress_of_the_mass_behind),
    cmocka_unit_test(a_held_bar_has_the_same_stress_everywhere),
    cmocka_unit_test(a_square_basis_gives_the_stresses_of_its_motion),
    cmocka_unit_test(rows_that_follow_rigid_motion_are_left_out),
    cmocka_unit_test(what_makes_no_sense_is_refused),
    cmocka_unit_test(every_method_carries_rows),
    cmocka_unit_test(mode_acceleration_is_projected),
    cmocka_unit_test(quantities_that_do_not_fit_are_refused),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(mode_acceleration, tests, NULL, NULL)
