/* Congruences are linear in the matrices: those of parts add up to those of the
   whole, and a reduced component made of the sum is that of ritz_reduce. */
#include "testing.h"

#include "model/congruences.h"

#include "frame.h"

#include <float.h>
#include <math.h>

enum { COLUMNS = 7, PARTS = 3 };

/* A beam with structural damping of 1 % and an unsymmetric D, and a basis of
   COLUMNS vectors. */
typedef struct beam {
    ritz_component component;
    ritz_basis basis;
} beam;

static void beam_free(beam *b)
{
    ritz_component_free(&b->component);
    ritz_basis_free(&b->basis);
}

static void scale_entries(double factor, bool lower_alone, ritz_sparse *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            A->val[p] *= lower_alone && A->rowind[p] < j ? 0.0 : factor;
}

static void make_beam(beam *b)
{
    ritz_component *c = &b->component;

    assert_ok(frame_component(6, 0.5, &frame_mcdaniel, false, false, 1, c));
    assert_ok(ritz_sparse_copy(&c->K, &c->K4));
    scale_entries(0.01, false, &c->K4);
    ritz_sparse_free(&c->D);
    assert_ok(ritz_sparse_copy(&c->K, &c->D));
    scale_entries(0.1, true, &c->D);
    assert_ok(ritz_basis_new(c->num_dofs, COLUMNS, &b->basis));
    for (int64_t j = 0; j < COLUMNS; j++) {
        b->basis.columns.kind[j] = RITZ_COLUMN_NORMAL;
        for (int64_t i = 0; i < c->num_dofs; i++)
            ritz_dense_col(&b->basis.T, j)[i] =
                sin((double)(i * (j + 1)) + 0.3);
    }
}

/* Set all entries outside the columns j with j % PARTS == part to zero. */
static void keep_columns(int64_t part, ritz_sparse *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (j % PARTS != part)
                A->val[p] = 0.0;
}

static void add_dense(const ritz_dense *A, ritz_dense *sum)
{
    if (!sum->val)
        assert_ok(ritz_dense_new(A->nrow, A->ncol, sum));
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        sum->val[k] += A->val[k];
}

/* The matrices of congruences, without those of rounding. */
enum { MEMBERS = 8 };

static void list_members(ritz_congruences *s, ritz_dense *member[MEMBERS])
{
    ritz_dense *const all[MEMBERS] = {&s->K,
                                      &s->M,
                                      &s->D,
                                      &s->K4,
                                      &s->rigid,
                                      &s->invariants.momentum,
                                      &s->invariants.position,
                                      &s->invariants.product};

    for (int k = 0; k < MEMBERS; k++)
        member[k] = all[k];
}

static void add_parts(const beam *b, bool twofold, ritz_congruences *sum)
{
    ritz_dense *to[MEMBERS], *from[MEMBERS];

    list_members(sum, to);
    for (int64_t k = 0; k < PARTS; k++) {
        RITZ_OWN(ritz_congruences) s = {0};
        RITZ_OWN(ritz_sparse) K = {0}, M = {0}, D = {0}, K4 = {0};
        ritz_component part = b->component; /* all but its matrices borrowed */

        assert_ok(ritz_sparse_copy(&b->component.K, &K));
        assert_ok(ritz_sparse_copy(&b->component.M, &M));
        assert_ok(ritz_sparse_copy(&b->component.D, &D));
        assert_ok(ritz_sparse_copy(&b->component.K4, &K4));
        keep_columns(k, &K);
        keep_columns(k, &M);
        keep_columns(k, &D);
        keep_columns(k, &K4);
        part.K = K;
        part.M = M;
        part.D = D;
        part.K4 = K4;
        assert_ok(ritz_congruences_of(&part, b->basis.columns.kind, &b->basis.T,
                                      twofold, &s));
        list_members(&s, from);
        for (int m = 0; m < MEMBERS; m++)
            add_dense(from[m], to[m]);
    }
}

/* Sums of at most n^2 = 441 products, whose magnitudes add up to the bound of
   the largest entry times some ten, in two orders. */
static void assert_equal_sums(const ritz_dense *A, const ritz_dense *B)
{
    const double rounding = 10.0 * 441.0 * DBL_EPSILON;
    double most = 0.0;

    assert_int_equal(A->nrow, B->nrow);
    assert_int_equal(A->ncol, B->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        most = fmax(most, fabs(A->val[k]));
    assert_true(most > 0.0);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        assert_near(A->val[k], B->val[k], rounding * most);
}

static void parts_add_up_to_the_whole(void **state)
{
    RITZ_OWN(beam) b = {0};

    (void)state;
    make_beam(&b);
    for (int twofold = 0; twofold < 2; twofold++) {
        RITZ_OWN(ritz_congruences) whole = {0}, sum = {0};
        ritz_dense *all[MEMBERS], *added[MEMBERS];

        assert_ok(ritz_congruences_of(&b.component, b.basis.columns.kind,
                                      &b.basis.T, twofold, &whole));
        add_parts(&b, twofold, &sum);
        list_members(&whole, all);
        list_members(&sum, added);
        for (int m = 0; m < MEMBERS; m++)
            assert_equal_sums(all[m], added[m]);
    }
}

static void their_reduced_component_is_that_of_reduce(void **state)
{
    RITZ_OWN(beam) b = {0};
    RITZ_OWN(ritz_congruences) sum = {0};
    RITZ_OWN(ritz_reduced) one = {0}, two = {0};

    (void)state;
    make_beam(&b);
    assert_ok(ritz_reduce(&b.component, &b.basis, &one));
    assert_ok(ritz_congruences_of(&b.component, b.basis.columns.kind,
                                  &b.basis.T, false, &sum));
    assert_ok(ritz_congruences_reduce(&b.component, &b.basis, &sum, &two));
    assert_null(sum.K.val);
    assert_equal_sums(&one.K, &two.K);
    assert_equal_sums(&one.D, &two.D);
    assert_near(one.inertia.mass, two.inertia.mass, 0.0);
    assert_true(one.inertia.mass > 0.0);
}

/* Coordinates without mass are not among the fastest, and are reported. */
static void the_fastest_coordinate_has_a_mass(void **state)
{
    ritz_fastest f = {0};

    (void)state;
    ritz_fastest_add(8.0, 2.0, &f);
    ritz_fastest_add(1.0, 1.0, &f);
    assert_near(f.ratio, 4.0, 0.0);
    assert_false(f.massless);
    ritz_fastest_add(100.0, 0.0, &f);
    assert_near(f.ratio, 4.0, 0.0);
    assert_true(f.massless);
}

/* Two columns at an angle a have T'T of condition 4 / a^2 or so: six digits are
   lost at a = 1e-6. */
static void nearly_dependent_columns_need_more_digits(void **state)
{
    (void)state;
    for (int near = 0; near < 2; near++) {
        const double a = near ? 1e-7 : 1e-3;
        double G[] = {9.0, 3.0 * cos(a), 3.0 * cos(a), 1.0};
        const ritz_dense square = {2, 2, G};
        bool twofold = !near;

        assert_ok(ritz_congruences_twofold(&square, &twofold));
        assert_int_equal(twofold, near);
    }
}

static void a_basis_for_other_dofs_is_refused(void **state)
{
    RITZ_OWN(beam) b = {0};
    RITZ_OWN(ritz_congruences) sum = {0};
    RITZ_OWN(ritz_reduced) out = {0};

    (void)state;
    make_beam(&b);
    b.basis.T.nrow--;
    assert_fails(ritz_congruences_reduce(&b.component, &b.basis, &sum, &out),
                 RITZ_ERR_ARGUMENT, "the basis is for 20 dofs");
    assert_fails(ritz_congruences_of(&b.component, b.basis.columns.kind,
                                     &b.basis.T, false, &sum),
                 RITZ_ERR_ARGUMENT, "");
    b.basis.T.nrow++;
}

static ritz_status find_congruences(const beam *b)
{
    RITZ_OWN(ritz_congruences) sums = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    RITZ_CHECK(ritz_congruences_of(&b->component, b->basis.columns.kind,
                                   &b->basis.T, true, &sums));
    return ritz_congruences_reduce(&b->component, &b->basis, &sums, &reduced);
}

static void every_allocation_may_fail(void **state)
{
    RITZ_OWN(beam) b = {0};

    (void)state;
    make_beam(&b);
    assert_survives_every_allocation(find_congruences(&b));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(parts_add_up_to_the_whole),
    cmocka_unit_test(their_reduced_component_is_that_of_reduce),
    cmocka_unit_test(the_fastest_coordinate_has_a_mass),
    cmocka_unit_test(nearly_dependent_columns_need_more_digits),
    cmocka_unit_test(a_basis_for_other_dofs_is_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(congruences, tests, NULL, NULL)
