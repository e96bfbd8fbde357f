#include "testing.h"

#include "matrices.h"
#include "spring_chain.h"

#include <ritz/import.h>
#include <ritz/model.h>

#include <stdio.h>

static ritz_component chain(void)
{
    ritz_component component = {0};

    assert_ok(chain_component(30, &component));
    return component;
}

/* A basis of r columns that have nothing to do with the model. */
static ritz_basis some_basis(int64_t n, int64_t r)
{
    ritz_basis basis = {0};

    assert_ok(ritz_basis_new(n, r, &basis));
    for (int64_t k = 0; k < n * r; k++)
        basis.T.val[k] = sin(1.0 + 0.7 * (double)(k * k % 101));
    return basis;
}

static void assert_same(const ritz_dense *A, const ritz_dense *B, double bound)
{
    assert_int_equal(A->nrow, B->nrow);
    assert_int_equal(A->ncol, B->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        assert_near(A->val[k], B->val[k], bound);
}

/* Damper 'a' lies between the third mass and the second, spring 2 has 1400. */
static void a_damper_goes_into_the_matrices_where_it_lies(void **state)
{
    ritz_component c = chain();
    double before = entry(&c.K, 2, 1);

    (void)state;
    assert_null(c.D.colptr);
    assert_ok(ritz_component_install(&c));
    assert_near(entry(&c.D, 2, 2), 150.0, 0.0);
    assert_near(entry(&c.D, 2, 1), -150.0, 0.0);
    assert_near(entry(&c.D, 0, 0), 0.0, 0.0);
    assert_near(entry(&c.K, 2, 1), before + 200.0, 0.0);
    assert_near(ritz_sparse_asymmetry(&c.D), 0.0, 0.0);
    ritz_component_free(&c);
}

static void installing_twice_adds_nothing(void **state)
{
    ritz_component c = chain();

    (void)state;
    assert_ok(ritz_component_install(&c));
    assert_ok(ritz_component_install(&c));
    assert_near(entry(&c.D, 2, 2), 150.0, 0.0);
    assert_near(entry(&c.K, 16, 17), -1000.0 * 1.6 + 200.0, 0.0);
    ritz_component_free(&c);
}

static void installing_after_a_change_adds_the_difference(void **state)
{
    ritz_component c = chain();

    (void)state;
    assert_ok(ritz_component_install(&c));
    assert_ok(ritz_dampers_tune(&c.dampers, "a=10"));
    assert_ok(ritz_dampers_tune(&c.dampers, "b=0*0"));
    assert_ok(ritz_component_install(&c));
    assert_near(entry(&c.D, 2, 2), 10.0, 0.0);
    assert_near(entry(&c.D, 9, 9), 0.0, 0.0);
    assert_near(entry(&c.K, 9, 8), -1000.0 * 1.6, 0.0);
    assert_near(entry(&c.K, 2, 1), -1000.0 * 1.4 + 200.0, 0.0);
    ritz_component_free(&c);
}

/* T'(D + c b b')T = T'DT + c (T'b)(T'b)': rounding of 30 terms of size 1e4. */
static void projecting_and_installing_commute(void **state)
{
    ritz_component c = chain();
    ritz_basis basis = some_basis(30, 4);
    RITZ_OWN(ritz_reduced) after = {0}, before = {0};

    (void)state;
    assert_ok(ritz_reduce(&c, &basis, &after));
    assert_null(after.D.val);
    assert_int_equal(after.dampers.count, 3);
    assert_ok(ritz_dampers_tune(&after.dampers, "b=7*3"));
    assert_ok(ritz_reduced_install(&after));
    assert_ok(ritz_dampers_tune(&c.dampers, "b=7*3"));
    assert_ok(ritz_component_install(&c));
    assert_ok(ritz_reduce(&c, &basis, &before));
    assert_same(&after.K, &before.K, 1e-9);
    assert_same(&after.D, &before.D, 1e-10);
    ritz_basis_free(&basis);
    ritz_component_free(&c);
}

static void projecting_once_more_takes_the_dampers_along(void **state)
{
    ritz_component c = chain();
    ritz_basis basis = some_basis(30, 4);
    ritz_basis V = some_basis(4, 2);
    RITZ_OWN(ritz_reduced) once = {0}, twice = {0};
    RITZ_OWN(ritz_dense) expected = {0};

    (void)state;
    assert_ok(ritz_reduce(&c, &basis, &once));
    assert_ok(ritz_reduced_project(&once, &V.T, &twice));
    assert_ok(ritz_dense_mul_tn(&V.T, &once.dampers.B, &expected));
    assert_same(&twice.dampers.B, &expected, 0.0);
    assert_string_equal(twice.dampers.name[2], "c");
    assert_near(twice.dampers.k[2], -200.0, 0.0);
    ritz_basis_free(&basis);
    ritz_basis_free(&V);
    ritz_component_free(&c);
}

/* K4 as K, and a D that is not symmetric as it is: T'DT entry by entry. */
static void structural_and_gyroscopic_damping_are_projected(void **state)
{
    static const int64_t at[] = {3, 4};
    static const int64_t other[] = {4, 3};
    static const double gyroscopic[] = {2.0, -2.0};
    static const double loss[] = {1.0, 5.0};
    ritz_component c = chain();
    ritz_basis basis = some_basis(30, 2);
    RITZ_OWN(ritz_reduced) r = {0}, again = {0};
    const double *t = basis.T.val;
    double d = 0.0;

    (void)state;
    assert_ok(
        ritz_sparse_from_triplets(30, 30, 2, at, other, gyroscopic, &c.D));
    assert_ok(ritz_sparse_from_triplets(30, 30, 2, at, at, loss, &c.K4));
    assert_ok(ritz_component_settle(&c, false));
    assert_near(ritz_sparse_skew(&c.D), 1.0, 1e-15);
    assert_ok(ritz_reduce(&c, &basis, &r));
    d = 2.0 * (t[3] * t[34] - t[4] * t[33]);
    assert_near(r.D.val[2], d, 1e-15);
    assert_near(r.D.val[1], -d, 1e-15);
    assert_near(r.D.val[0], 0.0, 1e-15);
    assert_near(r.K4.val[0], t[3] * t[3] + 5.0 * t[4] * t[4], 1e-14);
    assert_ok(ritz_reduced_project(
        &r, &(ritz_dense){2, 2, (double[]){0.0, 1.0, 1.0, 0.0}}, &again));
    assert_near(again.D.val[2], -d, 1e-15);
    assert_near(again.K4.val[3], r.K4.val[0], 0.0);
    ritz_basis_free(&basis);
    ritz_component_free(&c);
}

/* 1e-6 of the largest entry is averaged away, in D too; K stays refused. */
static void stiffness_must_be_symmetric_and_damping_need_not(void **state)
{
    static const int64_t at[] = {3, 4}, other[] = {4, 3};
    static const double little[] = {1.0, 1.0 + 1e-7};
    static const double more[] = {1.0, 1.5};
    ritz_component c = chain();

    (void)state;
    assert_ok(ritz_sparse_from_triplets(30, 30, 2, at, other, little, &c.D));
    assert_ok(ritz_component_settle(&c, false));
    assert_near(ritz_sparse_asymmetry(&c.D), 0.0, 0.0);
    assert_true(c.asymmetry > 0.0);
    ritz_sparse_free(&c.D);
    assert_ok(ritz_sparse_from_triplets(30, 30, 2, at, other, more, &c.D));
    assert_ok(ritz_component_settle(&c, false));
    assert_near(entry(&c.D, 4, 3), 1.5, 0.0);
    /* (1.5 - 1) / 2 sqrt(2) over sqrt(1 + 1.5^2) */
    assert_near(ritz_sparse_skew(&c.D), 0.25 * sqrt(2.0 / 3.25), 1e-15);
    assert_ok(ritz_component_settle(&c, true));
    assert_near(entry(&c.D, 4, 3), 1.25, 0.0);
    c.K.val[1] *= 1.1;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "K: unsymmetric by");
    ritz_component_free(&c);
}

static void bodies_are_told_apart_by_the_names_of_their_dampers(void **state)
{
    ritz_component c = chain();
    RITZ_OWN(ritz_dampers) all = {0};
    char name[RITZ_NAME_SIZE];

    (void)state;
    assert_ok(ritz_dampers_append(&c.dampers, "boom", 65, 5, &all));
    assert_ok(ritz_dampers_append(&c.dampers, "mast", 65, 35, &all));
    assert_int_equal(all.count, 6);
    assert_string_equal(all.name[4], "mast/b");
    assert_near(ritz_dense_col(&all.B, 0)[5 + 2], 1.0, 0.0);
    assert_near(ritz_dense_col(&all.B, 4)[35 + 8], -1.0, 0.0);
    assert_near(ritz_dense_col(&all.B, 4)[9], 0.0, 0.0);
    assert_near(all.c[5], 150.0, 0.0);
    memset(name, 'x', sizeof name);
    name[RITZ_NAME_SIZE - 1] = '\0';
    assert_fails(ritz_dampers_append(&c.dampers, name, 30, 0, &all),
                 RITZ_ERR_ARGUMENT, "gets a name of more than 63 letters");
    assert_int_equal(all.count, 6);
    ritz_component_free(&c);
}

static void bad_dampers_are_refused_in_words(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"a", "'a' is not of the form NAME=C or NAME=C*K"},
        {"a=", "'a=' is not of the form"},
        {"a=1*", "'a=1*' is not of the form"},
        {"a=1*2*3", "is not of the form"},
        {"a=nan", "is not of the form"},
        {"a=-1", "'a=-1': a damper's c is not negative"},
        {"d=1", "there is no damper 'd'"},
    };
    ritz_component c = chain();

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(ritz_dampers_tune(&c.dampers, cases[k].text),
                     RITZ_ERR_ARGUMENT, cases[k].words);
    assert_near(c.dampers.c[0], 150.0, 0.0);
    assert_fails(ritz_dampers_tune(&(ritz_dampers){0}, "a=1"),
                 RITZ_ERR_ARGUMENT, "no damper 'a', the model has none");
    c.dampers.c[1] = -1.0;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "damper 'b' has c = -1");
    c.dampers.c[1] = 0.0;
    c.dampers.k[1] = HUGE_VAL;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "damper 'b' has c = 0 and k = inf");
    c.dampers.k[1] = 0.0;
    c.dampers.B.val[3] = nan("");
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "influence vector of damper 'a' is not finite");
    c.dampers.B.val[3] = 0.0;
    snprintf(c.dampers.name[2], RITZ_NAME_SIZE, "a");
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "there are two dampers 'a'");
    c.dampers.name[2][0] = '\0';
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "damper 3 has no name");
    ritz_component_free(&c);
}

static void dampers_of_another_model_are_refused(void **state)
{
    ritz_component c = chain();
    ritz_dense K = {0}, D = {0};

    (void)state;
    assert_ok(ritz_dense_new(4, 4, &K));
    assert_fails(ritz_dampers_install(&c.dampers, &K, &D), RITZ_ERR_ARGUMENT,
                 "dampers of 30 coordinates in a model of 4");
    c.dampers.B.nrow = 29;
    assert_fails(ritz_component_install(&c), RITZ_ERR_ARGUMENT,
                 "dampers of 29 coordinates in a model of 30");
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "influence vectors of dampers are 29 x 3, not 30 x 3");
    c.dampers.B.nrow = 30;
    ritz_dense_free(&K);
    ritz_component_free(&c);
}

static ritz_status install_all(void)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) r = {0};
    RITZ_OWN(ritz_dampers) all = {0};

    RITZ_CHECK(chain_component(20, &c));
    RITZ_CHECK(ritz_basis_new(20, 2, &basis));
    RITZ_CHECK(ritz_reduce(&c, &basis, &r));
    RITZ_CHECK(ritz_reduced_install(&r));
    RITZ_CHECK(ritz_dampers_append(&c.dampers, "body", 30, 3, &all));
    return ritz_component_install(&c);
}

static void no_allocation_is_forgotten(void **state)
{
    (void)state;
    assert_survives_every_allocation(install_all());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_damper_goes_into_the_matrices_where_it_lies),
    cmocka_unit_test(installing_twice_adds_nothing),
    cmocka_unit_test(installing_after_a_change_adds_the_difference),
    cmocka_unit_test(projecting_and_installing_commute),
    cmocka_unit_test(projecting_once_more_takes_the_dampers_along),
    cmocka_unit_test(structural_and_gyroscopic_damping_are_projected),
    cmocka_unit_test(stiffness_must_be_symmetric_and_damping_need_not),
    cmocka_unit_test(bodies_are_told_apart_by_the_names_of_their_dampers),
    cmocka_unit_test(bad_dampers_are_refused_in_words),
    cmocka_unit_test(dampers_of_another_model_are_refused),
    cmocka_unit_test(no_allocation_is_forgotten),
};

TEST_MODULE(dampers, tests, NULL, NULL)
