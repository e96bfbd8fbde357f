/* Geometric stiffness is projected as stiffness is: if KG = K in a model, it is
   so in each model that is made of it. */
#include "testing.h"

#include "masses.h"

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <stdio.h>
#include <string.h>

enum { ORDER = 4, COLUMNS = 3 };

/* A chain held to ground. Its geometric stiffness is K for the load "spin" and
   2 K for "tip". */
static ritz_status loaded_chain(ritz_component *out)
{
    static const double m[] = {1, 2, 1, 3}, k[] = {5, 9, 7, 8};
    static const double none[ORDER] = {0.0};
    static const char *const names[] = {"spin", "tip"};

    RITZ_CHECK(masses_component(ORDER, m, k, none, out));
    RITZ_CHECK_NEW(out->load, 2);
    for (; out->num_loads < 2; out->num_loads++) {
        ritz_load *load = &out->load[out->num_loads];

        snprintf(load->name, sizeof load->name, "%s", names[out->num_loads]);
        RITZ_CHECK(ritz_sparse_copy(&out->K, &load->KG));
    }
    for (int64_t e = 0; e < out->K.colptr[ORDER]; e++)
        out->load[1].KG.val[e] *= 2.0;
    return RITZ_OK;
}

static ritz_status some_basis(ritz_basis *out)
{
    RITZ_CHECK(ritz_basis_new(ORDER, COLUMNS, out));
    for (int64_t j = 0; j < COLUMNS; j++)
        for (int64_t i = 0; i < ORDER; i++)
            ritz_dense_col(&out->T, j)[i] = 1.0 / (double)(1 + i + 2 * j);
    return RITZ_OK;
}

/* The two loads are K and 2 K of the same reduced component. */
static void compare_loads(const ritz_dense *K, int64_t count,
                          const ritz_reduced_load *load)
{
    const double bound = 16.0 * ORDER * DBL_EPSILON * ritz_dense_max(K);

    assert_int_equal(count, 2);
    assert_string_equal(load[0].name, "spin");
    assert_string_equal(load[1].name, "tip");
    for (int k = 0; k < 2; k++) {
        assert_int_equal(load[k].KG.ncol, K->ncol);
        for (int64_t e = 0; e < K->nrow * K->ncol; e++)
            assert_near(load[k].KG.val[e], (k + 1) * K->val[e], bound);
    }
}

static void a_reduction_and_a_projection_keep_loads(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, second = {0};
    RITZ_OWN(ritz_dense) V = {0};

    (void)state;
    assert_ok(loaded_chain(&chain));
    assert_ok(some_basis(&basis));
    assert_ok(ritz_reduce(&chain, &basis, &reduced));
    compare_loads(&reduced.K, reduced.num_loads, reduced.load);
    assert_ok(ritz_dense_new(COLUMNS, 2, &V));
    V.val[0] = V.val[4] = 1.0;
    V.val[1] = -0.5;
    assert_ok(ritz_reduced_project(&reduced, &V, &second));
    compare_loads(&second.K, second.num_loads, second.load);
}

static void a_prefix_keeps_loads(void **state)
{
    static const int64_t order[COLUMNS] = {2, 0, 1};
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, nested = {0}, prefix = {0};

    (void)state;
    assert_ok(loaded_chain(&chain));
    assert_ok(some_basis(&basis));
    assert_ok(ritz_reduce(&chain, &basis, &reduced));
    assert_ok(ritz_reduced_nest(&reduced, COLUMNS, order, 1, &nested));
    compare_loads(&nested.K, nested.num_loads, nested.load);
    assert_ok(ritz_reduced_prefix(&nested, 2, &prefix));
    compare_loads(&prefix.K, prefix.num_loads, prefix.load);
}

static void a_reduced_component_keeps_loads_as_a_component(void **state)
{
    RITZ_OWN(ritz_component) chain = {0}, again = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    assert_ok(loaded_chain(&chain));
    assert_ok(some_basis(&basis));
    assert_ok(ritz_reduce(&chain, &basis, &reduced));
    assert_ok(ritz_component_of_reduced(&reduced, &again));
    assert_int_equal(again.num_loads, 2);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_dense) KG = {0};

        assert_string_equal(again.load[k].name, reduced.load[k].name);
        assert_ok(ritz_sparse_dense(&again.load[k].KG, &KG));
        assert_memory_equal(KG.val, reduced.load[k].KG.val,
                            sizeof(double) * COLUMNS * COLUMNS);
    }
}

static ritz_status reduce_twice(const ritz_component *chain,
                                const ritz_basis *basis)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_component) again = {0};

    RITZ_CHECK(ritz_reduce(chain, basis, &reduced));
    return ritz_component_of_reduced(&reduced, &again);
}

static void loads_survive_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(loaded_chain(&chain));
    assert_ok(some_basis(&basis));
    assert_survives_every_allocation(reduce_twice(&chain, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_reduction_and_a_projection_keep_loads),
    cmocka_unit_test(a_prefix_keeps_loads),
    cmocka_unit_test(a_reduced_component_keeps_loads_as_a_component),
    cmocka_unit_test(loads_survive_every_allocation),
};

TEST_MODULE(loads, tests, NULL, NULL)
