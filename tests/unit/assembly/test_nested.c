/* Nested reduced components: what is moved, what is known, what is refused. */
#include "bodies.h"
#include "testing.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <stdlib.h>

enum { GRIDS = 6, MODES = 12 };

/* A chain of six-dof bodies, held at both ends by Craig-Bampton, with all that
   a reduced component can have. */
static void reduced_chain(ritz_reduced *out)
{
    static const double place[GRIDS][3] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0},
                                           {3, 1, 1}, {4, 0, 1}, {5, 0, 0}};
    int64_t attached[] = {0, 1, 2, 3, 4, 5, 30, 31, 32, 33, 34, 35};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    const ritz_method *method = &ritz_method_craig_bampton;

    assert_ok(body_chain(GRIDS, place, 1, 7, &body));
    assert_ok(ritz_sparse_add(1e-3, &body.K, 0.1, &body.M, &body.D));
    ritz_io_free(&body.io);
    assert_ok(ritz_io_new(body.num_dofs, 1, 1, &body.io));
    memcpy(body.io.input[0], "push", 5);
    memcpy(body.io.output[0], "seen", 5);
    body.io.B.val[7] = 1.0;
    body.io.C.val[20] = 1.0;
    body.io.Ca.val[21] = 2.0;
    assert_ok(ritz_dampers_new(body.num_dofs, 1, &body.dampers));
    memcpy(body.dampers.name[0], "link", 5);
    body.dampers.c[0] = 3.0;
    body.dampers.B.val[8] = 1.0;
    body.dampers.B.val[14] = -1.0;
    request.modes = MODES;
    request.component = &body;
    request.attached = (ritz_dofs){12, attached};
    /* leaves out the damper's static vector */
    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_ATTACHED;
    assert_ok(method->make(&request, &basis));
    assert_ok(ritz_reduce(&body, &basis, out));
    assert_ok(ritz_measures_add(&out->estimates, "mode-1", 1e-9, nan(""), ""));
    assert_ok(ritz_measures_add(&out->errors, "mac", 1.0, nan(""), ""));
}

/* A(row(i), col(j)) of the whole is B(i, j); NULL: the same. */
static void moved(const ritz_dense *A, const int64_t *row, const int64_t *col,
                  const ritz_dense *B)
{
    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t i = 0; i < B->nrow; i++)
            assert_near(ritz_dense_col(B, j)[i],
                        ritz_dense_col(A, col ? col[j] : j)[row ? row[i] : i],
                        0.0);
}

/* Everything that has columns, by brute force. */
static void same_but_moved(const ritz_reduced *a, int64_t count,
                           const int64_t *at, const ritz_reduced *b)
{
    int64_t r = a->K.ncol;
    int64_t *at3 = calloc((size_t)(3 * count), sizeof *at3);

    assert_non_null(at3);
    for (int64_t k = 0; k < 3 * count; k++)
        at3[k] = k / count * r + at[k % count];
    assert_int_equal(b->K.ncol, count);
    assert_int_equal(b->columns.count, count);
    moved(&a->K, at, at, &b->K);
    moved(&a->M, at, at, &b->M);
    moved(&a->D, at, at, &b->D);
    moved(&a->T, NULL, at, &b->T);
    moved(&a->dampers.B, at, NULL, &b->dampers.B);
    moved(&a->io.B, at, NULL, &b->io.B);
    moved(&a->io.C, NULL, at, &b->io.C);
    moved(&a->io.Ca, NULL, at, &b->io.Ca);
    for (int64_t k = 0; k < a->num_ports; k++)
        moved(&a->port[k].map, NULL, at, &b->port[k].map);
    moved(&a->invariants.momentum, NULL, at, &b->invariants.momentum);
    moved(&a->invariants.position, NULL, at3, &b->invariants.position);
    moved(&a->invariants.product, at3, at3, &b->invariants.product);
    for (int64_t j = 0; j < count; j++) {
        assert_int_equal(a->columns.kind[at[j]], b->columns.kind[j]);
        assert_int_equal(a->columns.dof[at[j]], b->columns.dof[j]);
    }
    assert_int_equal(b->T.nrow, a->num_dofs);
    assert_int_equal(a->grids.count, b->grids.count);
    assert_int_equal(a->num_ports, b->num_ports);
    assert_string_equal(a->origin.method, b->origin.method);
    assert_true(b->dof && b->inertia.known);
    free(at3);
}

static void columns_move_and_no_number_changes(void **state)
{
    RITZ_OWN(ritz_reduced) a = {0}, b = {0}, c = {0};
    int64_t *at = NULL, *back = NULL;
    int64_t r = 0;

    (void)state;
    reduced_chain(&a);
    r = a.K.ncol;
    at = calloc((size_t)r, sizeof *at);
    back = calloc((size_t)r, sizeof *back);
    assert_true(at && back);
    for (int64_t j = 0; j < r; j++) {
        at[j] = (7 * j + 3) % r; /* 24 columns: 7 is prime to it */
        back[at[j]] = j;
    }
    assert_int_equal(r, 24);
    assert_true(a.invariants.momentum.val && a.T.val && a.D.val);
    assert_ok(ritz_reduced_nest(&a, r, at, 5, &b));
    same_but_moved(&a, r, at, &b);
    assert_int_equal(b.nested.smallest, 5);
    assert_int_equal(b.estimates.count, 1);
    assert_int_equal(b.errors.count, 1);
    assert_ok(ritz_reduced_nest(&b, r, back, 5, &c));
    assert_memory_equal(a.K.val, c.K.val, (size_t)(r * r) * sizeof *a.K.val);
    assert_memory_equal(a.T.val, c.T.val,
                        (size_t)(a.T.nrow * r) * sizeof *a.T.val);
    free(at);
    free(back);
}

static void natural(const ritz_reduced *a, int64_t smallest, ritz_reduced *out)
{
    int64_t at[64];

    for (int64_t j = 0; j < a->K.ncol; j++)
        at[j] = j;
    assert_ok(ritz_reduced_nest(a, a->K.ncol, at, smallest, out));
}

/* The frequencies of a subspace lie above those of the space. */
static void a_prefix_is_galerkins_model_in_its_columns(void **state)
{
    enum { ORDER = 17 };
    RITZ_OWN(ritz_reduced) a = {0}, whole = {0}, prefix = {0};
    RITZ_OWN(ritz_pairs) all = {0}, some = {0};
    int64_t first[ORDER];

    (void)state;
    reduced_chain(&a);
    natural(&a, 12, &whole);
    assert_ok(ritz_reduced_prefix(&whole, ORDER, &prefix));
    for (int64_t j = 0; j < ORDER; j++)
        first[j] = j;
    same_but_moved(&a, ORDER, first, &prefix);
    assert_int_equal(prefix.nested.smallest, 12);
    assert_ok(ritz_eigen_dense(&whole.K, &whole.M, &all));
    assert_ok(ritz_eigen_dense(&prefix.K, &prefix.M, &some));
    for (int64_t j = 6; j < ORDER; j++)
        assert_true(some.lambda[j] >= all.lambda[j] * (1.0 - 1e-12));
}

/* Errors of the whole are none of a prefix; those of its order are. */
static void a_prefix_knows_what_was_noted_of_it_alone(void **state)
{
    RITZ_OWN(ritz_reduced) a = {0}, whole = {0}, prefix = {0}, again = {0};

    (void)state;
    reduced_chain(&a);
    natural(&a, 12, &whole);
    assert_ok(ritz_nested_note(&whole, 20, "response-relative", 0.5));
    assert_ok(ritz_nested_note(&whole, 16, "mac", 0.25));
    assert_ok(ritz_nested_note(&whole, 16, "frequency-relative-bound", 1.0));
    assert_ok(ritz_nested_note(&whole, 16, "frequency-relative-bound", 0.125));
    assert_int_equal(whole.nested.count, 2);
    assert_int_equal(whole.nested.num_errors, 3);
    assert_ok(ritz_reduced_prefix(&whole, 16, &prefix));
    assert_int_equal(prefix.estimates.count, 1);
    assert_string_equal(prefix.estimates.item->name,
                        "frequency-relative-bound");
    assert_near(prefix.estimates.item->value, 0.125, 0.0);
    assert_string_equal(prefix.estimates.item->where,
                        "16 columns, when it was made");
    assert_int_equal(prefix.errors.count, 1);
    assert_string_equal(prefix.errors.item->name, "mac");
    assert_int_equal(prefix.nested.count, 1);
    assert_int_equal(prefix.nested.order[0], 16);
    ritz_reduced_free(&prefix);
    assert_ok(ritz_reduced_prefix(&whole, 18, &prefix));
    assert_int_equal(prefix.estimates.count + prefix.errors.count, 0);
    assert_ok(ritz_reduced_prefix(&prefix, 16, &again));
    assert_int_equal(again.errors.count, 1);
    ritz_reduced_free(&again);
    assert_ok(ritz_reduced_prefix(&whole, whole.K.ncol, &again));
    assert_int_equal(again.errors.count, 1);
    assert_near(again.errors.item->value, 1.0, 0.0);
    assert_int_equal(again.nested.count, 2);
}

static void what_is_no_prefix_is_refused(void **state)
{
    const int64_t twice[] = {0, 1, 0}, far[] = {0, 99};
    RITZ_OWN(ritz_reduced) a = {0}, whole = {0};
    ritz_reduced out = {0};

    (void)state;
    reduced_chain(&a);
    assert_fails(ritz_reduced_prefix(&a, 14, &out), RITZ_ERR_ARGUMENT,
                 "it is not nested: its 24 columns are one model");
    assert_fails(ritz_nested_note(&a, 14, "mac", 1.0), RITZ_ERR_ARGUMENT,
                 "it is not nested");
    natural(&a, 12, &whole);
    assert_fails(ritz_reduced_prefix(&whole, 11, &out), RITZ_ERR_ARGUMENT,
                 "no prefix of 11 columns, there are those of 12 to 24");
    assert_fails(ritz_reduced_prefix(&whole, 25, &out), RITZ_ERR_ARGUMENT,
                 "no prefix of 25 columns");
    assert_fails(ritz_reduced_nest(&a, 3, twice, 1, &out), RITZ_ERR_ARGUMENT,
                 "column 1 is named twice");
    assert_fails(ritz_reduced_nest(&a, 2, far, 1, &out), RITZ_ERR_ARGUMENT,
                 "there is no column 100, there are 24");
    assert_fails(ritz_reduced_nest(&a, 2, twice, 3, &out), RITZ_ERR_ARGUMENT,
                 "a smallest prefix of 3 columns is not in 1..2");
    assert_fails(ritz_nested_note(&whole, 14, "a/b", 1.0), RITZ_ERR_ARGUMENT,
                 "holds '/'");
    assert_fails(ritz_nested_note(&whole, 14, "mac", nan("")),
                 RITZ_ERR_ARGUMENT, "which is no measure");
    assert_int_equal(whole.nested.count, 0);
}

static ritz_status forget(const ritz_reduced *a)
{
    const int64_t at[] = {5, 0, 3, 2};
    RITZ_OWN(ritz_reduced) whole = {0}, prefix = {0};

    RITZ_CHECK(ritz_reduced_nest(a, 4, at, 2, &whole));
    RITZ_CHECK(ritz_nested_note(&whole, 3, "mac", 1.0));
    RITZ_CHECK(ritz_reduced_prefix(&whole, 3, &prefix));
    return RITZ_OK;
}

static void nesting_survives_every_allocation(void **state)
{
    RITZ_OWN(ritz_reduced) a = {0};

    (void)state;
    reduced_chain(&a);
    assert_survives_every_allocation(forget(&a));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(columns_move_and_no_number_changes),
    cmocka_unit_test(a_prefix_is_galerkins_model_in_its_columns),
    cmocka_unit_test(a_prefix_knows_what_was_noted_of_it_alone),
    cmocka_unit_test(what_is_no_prefix_is_refused),
    cmocka_unit_test(nesting_survives_every_allocation),
};

TEST_MODULE(nested, tests, NULL, NULL)
