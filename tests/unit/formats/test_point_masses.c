/*
 * Point masses with the invariants of a body. Sums over points must be the
 * products of its fields, to 1e-12 of the sizes of the fields: eigenvalues
 * below 1e-13 are left out, and LAPACK errs by some p eps lambda_max, of order
 * p = 76 at most.
 */
#include "testing.h"

#include "bodies.h"
#include "formats/point_masses.h"

#include <ritz/basis.h>

#include <stdlib.h>

enum { GRIDS = 4 };

static const double bound = 1e-12;

/* A body that moves by columns T. */
typedef struct moved_body {
    ritz_inertia inertia;
    ritz_invariants invariants;
    ritz_dense M;
} moved_body;

static void moved_body_free(moved_body *b)
{
    ritz_invariants_free(&b->invariants);
    ritz_dense_free(&b->M);
}

static ritz_status move_body(const ritz_component *body, const ritz_dense *T,
                             moved_body *out)
{
    RITZ_CHECK(ritz_inertia_of(body, &out->inertia));
    RITZ_CHECK(ritz_invariants_of(body, T, &out->invariants));
    return ritz_sparse_condense(&body->M, T, &out->M);
}

/* Each of the first dofs is a mode. */
static ritz_status move_by_dofs(const ritz_component *body, int64_t count,
                                moved_body *out)
{
    RITZ_OWN(ritz_dense) all = {0}, T = {0};

    RITZ_CHECK(ritz_dense_identity(body->num_dofs, &all));
    RITZ_CHECK(ritz_dense_columns(&all, 0, count, &T));
    return move_body(body, &T, out);
}

/* Sum over points of field f, mass and field g; field -1 is 1. */
static double sum_of(const ritz_point_masses *p, int64_t f, int64_t g)
{
    double sum = 0.0;

    for (int64_t i = 0; i < p->count; i++)
        sum += p->mass[i] * (f < 0 ? 1.0 : ritz_dense_col(&p->field, f)[i]) *
               (g < 0 ? 1.0 : ritz_dense_col(&p->field, g)[i]);
    return sum;
}

/* Mass, static moment and inertia about the origin, of points and of R'MR. */
static void assert_rigid(const moved_body *b, const ritz_point_masses *p)
{
    const double *A = b->invariants.rigid;
    const double m = b->inertia.mass;
    const double size = A[21] + A[28] + A[35];
    double trace = 0.0;

    assert_near(sum_of(p, -1, -1), m, bound * m);
    for (int a = 0; a < 3; a++) {
        assert_near(sum_of(p, -1, a), m * b->inertia.centre[a],
                    bound * sqrt(m * size));
        trace += sum_of(p, a, a);
    }
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
            assert_near((a == c ? trace : 0.0) - sum_of(p, a, c),
                        A[3 + a + 6 * (3 + c)], bound * size);
}

/* Linear and angular momentum of mode j. */
static void assert_momenta(const moved_body *b, const ritz_point_masses *p,
                           int64_t j)
{
    const int64_t m = b->M.ncol;
    const double *A = b->invariants.rigid;
    const double *momentum = ritz_dense_col(&b->invariants.momentum, j);
    const double size = sqrt(ritz_dense_col(&b->M, j)[j]);
    const double length = sqrt(A[21] + A[28] + A[35]);

    for (int a = 0; a < 3; a++) {
        int c = (a + 1) % 3;
        int d = (a + 2) % 3;

        assert_near(sum_of(p, -1, 3 + a * m + j), momentum[a],
                    bound * sqrt(b->inertia.mass) * size);
        assert_near(sum_of(p, c, 3 + d * m + j) - sum_of(p, d, 3 + c * m + j),
                    momentum[3 + a], 2.0 * bound * length * size);
        for (int e = 0; e < 3; e++)
            assert_near(
                sum_of(p, a, 3 + e * m + j) + sum_of(p, e, 3 + a * m + j),
                ritz_dense_col(&b->invariants.position, e * m + j)[a] +
                    ritz_dense_col(&b->invariants.position, a * m + j)[e],
                2.0 * bound * length * size);
    }
}

static void assert_invariants(const moved_body *b, const ritz_point_masses *p)
{
    const int64_t m = b->M.ncol;

    assert_int_equal(p->field.ncol, 3 + 3 * m);
    assert_rigid(b, p);
    for (int64_t j = 0; j < m; j++)
        assert_momenta(b, p, j);
    for (int64_t f = 0; f < 3 * m; f++)
        for (int64_t g = 0; g < 3 * m; g++)
            assert_near(sum_of(p, 3 + f, 3 + g),
                        ritz_dense_col(&b->invariants.product, g)[f],
                        bound * sqrt(ritz_dense_col(&b->M, f % m)[f % m] *
                                     ritz_dense_col(&b->M, g % m)[g % m]));
}

/* Grids of a chain without rotations: masses at points. */
static ritz_status make_masses(ritz_component *out)
{
    static const double at[GRIDS][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};
    RITZ_OWN(ritz_component) chain = {0};
    const double mass[3 * GRIDS] = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4};
    int64_t row[3 * GRIDS];

    RITZ_CHECK(body_chain(GRIDS, at, 1, 5, &chain));
    out->num_dofs = 3 * GRIDS;
    RITZ_MOVE(out->grids, chain.grids);
    RITZ_MOVE(out->dof, chain.dof);
    for (int i = 0; i < 3 * GRIDS; i++) {
        out->dof[i] = (ritz_dof){1 + i / 3, 1 + i % 3};
        row[i] = i;
    }
    RITZ_CHECK(ritz_sparse_from_triplets(12, 12, 12, row, row, mass, &out->M));
    return ritz_sparse_copy(&out->M, &out->K);
}

static void four_masses_are_four_equal_points(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(moved_body) b = {0};
    RITZ_OWN(ritz_point_masses) p = {0};

    assert_ok(make_masses(&body));
    assert_ok(move_by_dofs(&body, body.num_dofs, &b));
    assert_ok(ritz_point_masses_of(&b.inertia, &b.invariants, &b.M, &p));
    /* the fields of four points span four dimensions: 10 kg on four points */
    assert_int_equal(p.count, 4);
    assert_int_equal(p.num_negative, 0);
    for (int64_t i = 0; i < 4; i++)
        assert_near(p.mass[i], 2.5, 1e-14);
    assert_near(p.least, 0.0, 1e-14);
    assert_invariants(&b, &p);
}

/* Grids that turn have inertia of their own. */
static void rotations_keep_their_momenta(void **state)
{
    static const double at[GRIDS][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(moved_body) b = {0};
    RITZ_OWN(ritz_point_masses) p = {0};

    assert_ok(body_chain(GRIDS, at, 1, 5, &body));
    assert_ok(move_by_dofs(&body, body.num_dofs, &b));
    assert_ok(ritz_point_masses_of(&b.inertia, &b.invariants, &b.M, &p));
    assert_true(p.count <= 4 + 3 * body.num_dofs + 2);
    assert_invariants(&b, &p);
}

/* A grid with J_x alone has the products -J/2, J/2, J/2 of positions. */
static void a_thin_disc_needs_negative_masses(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(moved_body) b = {0};
    RITZ_OWN(ritz_point_masses) p = {0};
    double sum = 0.0;

    assert_ok(body_point(2.0, 3.0, &body));
    for (int64_t j = 4; j < 6; j++)
        for (int64_t e = body.M.colptr[j]; e < body.M.colptr[j + 1]; e++)
            body.M.val[e] = 0.0;
    assert_ok(move_by_dofs(&body, 4, &b));
    assert_near(b.inertia.tensor[0], 3.0, 1e-15);
    assert_near(b.inertia.tensor[4], 0.0, 1e-15);
    assert_ok(ritz_point_masses_of(&b.inertia, &b.invariants, &b.M, &p));
    assert_true(p.num_negative > 0 && p.least < 0.0);
    for (int64_t i = 0; i < p.count; i++) {
        assert_true(i < p.count - p.num_negative ? p.mass[i] > 0.0
                                                 : p.mass[i] < 0.0);
        sum += fabs(p.mass[i]);
    }
    /* no point needs more than a few times the mass of the body */
    assert_true(sum < 10.0 * b.inertia.mass);
    assert_invariants(&b, &p);
    assert_near(sum_of(&p, 0, 0), -1.5, 3e-12);
    assert_near(sum_of(&p, 1, 1), 1.5, 3e-12);
}

static ritz_status find_once(const moved_body *b)
{
    RITZ_OWN(ritz_point_masses) p = {0};

    return ritz_point_masses_of(&b->inertia, &b->invariants, &b->M, &p);
}

static void no_allocation_failure_leaks(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(moved_body) b = {0};

    assert_ok(body_point(2.0, 3.0, &body));
    assert_ok(move_by_dofs(&body, body.num_dofs, &b));
    assert_survives_every_allocation(find_once(&b));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(four_masses_are_four_equal_points),
    cmocka_unit_test(rotations_keep_their_momenta),
    cmocka_unit_test(a_thin_disc_needs_negative_masses),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(point_masses, tests, NULL, NULL)
