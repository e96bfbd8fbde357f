/*
 * Buckling of columns against closed forms; factors of both signs against an
 * independent program that uses LAPACK; reduced models against full ones;
 * ARPACK against LAPACK, and against plates in closed form; loads that act.
 */
#include "testing.h"

#include "check/buckling.h"
#include "column.h"
#include "linear/arpack.h"
#include "masses.h"
#include "plate.h"

#include <ritz/basis.h>
#include <ritz/check.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static const ritz_check *find(const ritz_audit *audit, const char *name)
{
    for (int64_t k = 0; k < audit->count; k++)
        if (strcmp(audit->check[k].name, name) == 0)
            return &audit->check[k];
    fail_msg("there is no check '%s'", name);
    return NULL;
}

static void a_cantilever_column_buckles_at_a_quarter_of_pi_square(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_buckling *found = NULL;

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_buckling_of_component(&c, &found));
    /* number of an independent program with 12 Hermite elements, to its last
       digit */
    assert_near(found[COLUMN_TIP].factor, 2.4674021, 5e-8);
    /* the error of the mesh is (pi / 24)^4 / 720 */
    assert_near(found[COLUMN_TIP].factor / (PI * PI / 4.0), 1.0, 5e-7);
    assert_true(isnan(found[COLUMN_TIP].reversed));
    assert_true(isnan(found[COLUMN_PULL].factor));
    assert_near(found[COLUMN_PULL].reversed, -found[COLUMN_TIP].factor, 1e-12);
    free(found);
}

static void a_pinned_column_buckles_at_pi_square(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_buckling *found = NULL;

    (void)state;
    assert_ok(column_component(20, COLUMN_PINNED, &c));
    assert_ok(ritz_buckling_of_component(&c, &found));
    /* the error of the mesh is (pi / 20)^4 / 720 */
    assert_near(found[COLUMN_TIP].factor / (PI * PI), 1.0, 1e-6);
    free(found);
}

/* Numbers of an independent program that uses LAPACK. */
static void compare_both(const ritz_buckling *found, double factor,
                         double reversed, double spin)
{
    /* twelve digits are given, and the stiffness has a condition of 1e9 */
    assert_near(found[COLUMN_BOTH].factor / factor, 1.0, 1e-8);
    assert_near(found[COLUMN_BOTH].reversed / reversed, 1.0, 1e-8);
    assert_near(found[COLUMN_SPIN].reversed / spin, 1.0, 1e-8);
    assert_true(isnan(found[COLUMN_SPIN].factor));
}

static void a_load_that_pushes_and_pulls_has_factors_of_both_signs(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_buckling *found = NULL;

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_buckling_of_component(&c, &found));
    compare_both(found, 101.865575588, -11.0312830628, -10.243361021);
    free(found);
}

static void iterations_agree_with_lapack(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_dense) K = {0};

    (void)state;
    assert_ok(column_component(40, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_sparse_dense(&c.K, &K));
    for (int k = 0; k < COLUMN_LOADS; k++) {
        RITZ_OWN(ritz_dense) KG = {0};
        ritz_buckling dense = {0}, iterated = {0};

        assert_ok(ritz_sparse_dense(&c.load[k].KG, &KG));
        assert_ok(ritz_buckling_dense(&K, &KG, &dense));
        assert_ok(ritz_buckling_iterated(&c.K, &c.load[k].KG, &iterated));
        assert_int_equal(isnan(dense.factor), isnan(iterated.factor));
        assert_int_equal(isnan(dense.reversed), isnan(iterated.reversed));
        /* eps times the condition of K, 1e8 */
        if (!isnan(dense.factor))
            assert_near(iterated.factor / dense.factor, 1.0, 2e-8);
        if (!isnan(dense.reversed))
            assert_near(iterated.reversed / dense.reversed, 1.0, 2e-8);
    }
}

/* KG of rank one: the Krylov space ends after one vector. */
static void a_load_of_rank_one_has_one_factor(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_sparse) KG = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    const int64_t at[] = {5};
    const double value[] = {-2.0};
    RITZ_OWN(ritz_dense) e = {0};
    double theta[2] = {0.0, 0.0};

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_sparse_from_triplets(c.num_dofs, c.num_dofs, 1, at, at,
                                        value, &KG));
    assert_ok(ritz_factor_spd(&c.K, &F));
    assert_ok(ritz_lanczos_ends(&(ritz_ended){&KG, &c.K, F}, theta));
    assert_ok(ritz_dense_new(c.num_dofs, 1, &e));
    e.val[5] = 1.0;
    assert_ok(ritz_factor_solve(F, &e));
    assert_near(theta[0] / (-2.0 * e.val[5]), 1.0, 1e-9);
    assert_true(isnan(theta[1]) || fabs(theta[1]) < 1e-9 * fabs(theta[0]));
}

static void nothing_buckles_without_geometric_stiffness(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_sparse) KG = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    ritz_buckling found = {0};
    double theta[2] = {1.0, 1.0};

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_sparse_new(c.num_dofs, c.num_dofs, 0, &KG));
    assert_ok(ritz_buckling_sparse(&c.K, &KG, &found));
    assert_true(isnan(found.factor) && isnan(found.reversed));
    assert_ok(ritz_factor_spd(&c.K, &F));
    assert_ok(ritz_lanczos_ends(&(ritz_ended){&KG, &c.K, F}, theta));
    assert_true(theta[0] == 0.0 && theta[1] == 0.0);
    assert_ok(ritz_lanczos_end_of(&(ritz_ended){&KG, &c.K, F}, RITZ_END_LOWEST,
                                  &theta[0]));
    assert_true(theta[0] == 0.0);
}

static void
a_reduced_model_buckles_later_and_nearly_where_the_full_one_does(void **state)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    ritz_buckling *full = NULL, *small = NULL;

    (void)state;
    assert_ok(column_component(20, COLUMN_CLAMPED_FREE, &c));
    request.component = &c;
    request.modes = 8;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_ok(ritz_reduce(&c, &basis, &reduced));
    assert_ok(ritz_buckling_of_component(&c, &full));
    assert_ok(ritz_buckling_of_reduced(&reduced, &small));
    assert_true(small[COLUMN_TIP].factor > full[COLUMN_TIP].factor);
    /* measured: 1.1e-4 with 8 modes */
    assert_near(small[COLUMN_TIP].factor / full[COLUMN_TIP].factor, 1.0, 1e-3);
    free(full);
    free(small);
}

static void a_free_body_has_no_factor(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_audit) audit = {0};
    ritz_buckling *found = NULL;
    const ritz_applied tip = {"tip", 0.1};

    (void)state;
    assert_ok(column_component(12, COLUMN_FREE, &c));
    assert_ok(ritz_buckling_of_component(&c, &found));
    assert_null(found);
    assert_ok(ritz_audit_component_under(&c, 1, &tip, &audit));
    assert_int_equal(find(&audit, "buckling")->verdict, RITZ_WARN);
    assert_non_null(strstr(find(&audit, "buckling")->says, "a motion is free"));
}

/* Entries of K are 1e10 times its lowest eigenvalue: of a column of 640
   elements four digits of the factor may be wrong. */
static void factors_that_rounding_takes_digits_of_give_a_warning(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    (void)state;
    assert_ok(column_component(640, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_audit_component(&c, &audit));
    assert_int_equal(find(&audit, "buckling:tip")->verdict, RITZ_WARN);
    assert_non_null(strstr(find(&audit, "buckling:tip")->says,
                           "not computed: rounding of a stiffness that is "
                           "nearly singular may change it by "));
}

static void a_fine_column_buckles_at_its_closed_form(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_buckling found = {0};

    (void)state;
    assert_ok(column_component(320, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_buckling_iterated(&c.K, &c.load[COLUMN_TIP].KG, &found));
    /* measured: 1.3e-7, as entries of K are 1e8 times its lowest eigenvalue */
    assert_near(found.factor / (PI * PI / 4.0), 1.0, 1e-6);
    assert_true(isnan(found.reversed));
}

static void same_factor(double found, double exact)
{
    assert_int_equal(isnan(found), isnan(exact));
    /* eps times the largest entry of K over the eigenvalue of the mode, 1e6 */
    if (!isnan(exact))
        assert_near(found / exact, 1.0, 1e-9);
}

/* A factor so far from the other is not given. */
static void leave_out_far(ritz_buckling *b)
{
    const double most = 1e3 * fmin(fabs(b->factor), fabs(b->reversed));

    if (fabs(b->factor) > most)
        b->factor = (double)NAN;
    if (fabs(b->reversed) > most)
        b->reversed = (double)NAN;
}

/* Ends of one sign, of both, of 100 times the size of the other, so that
   K + s KG is factored, and of 1000 times. */
static void factors_of_a_plate_are_those_of_its_closed_form(void **state)
{
    static const double load[][2] = {{1.0, 0.0},   {-1.0, 0.0}, {1.0, -0.1},
                                     {-0.1, 1.0},  {-1.0, 0.9}, {1.0, 1.0},
                                     {1.0, -0.02}, {-1.0, 0.02}};

    (void)state;
    for (size_t k = 0; k < sizeof load / sizeof *load; k++) {
        RITZ_OWN(ritz_sparse) K = {0}, KG = {0};
        ritz_buckling found = {0}, exact = {0};

        assert_ok(plate_matrices(26, load[k][0], load[k][1], &K, &KG));
        plate_factors(26, load[k][0], load[k][1], &exact);
        leave_out_far(&exact);
        assert_ok(ritz_buckling_sparse(&K, &KG, &found));
        same_factor(found.factor, exact.factor);
        same_factor(found.reversed, exact.reversed);
    }
}

/* Both ends are of the same size. */
static void a_sheared_plate_has_the_same_factor_in_both_directions(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, KG = {0}, none = {0};
    ritz_buckling found = {0};

    (void)state;
    assert_ok(plate_matrices(26, 1.0, 0.0, &K, &none));
    assert_ok(plate_shear(26, &KG));
    assert_ok(ritz_buckling_sparse(&K, &KG, &found));
    same_factor(found.factor, -found.reversed);
    /* of an infinitely fine one 9.35 pi^2 (9.34 in [TimoshenkoGere1961]) */
    assert_near(found.factor / (9.34 * PI * PI), 1.0, 0.01);
}

/* KG of 1e-18 of the usual units: ARPACK would take theta for zero. */
static void the_unit_of_a_load_does_not_matter(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, KG = {0};
    ritz_buckling found = {0}, exact = {0};

    (void)state;
    assert_ok(plate_matrices(26, 1e-18, -1e-19, &K, &KG));
    plate_factors(26, 1.0, -0.1, &exact);
    assert_ok(ritz_buckling_sparse(&K, &KG, &found));
    same_factor(1e-18 * found.factor, exact.factor);
    same_factor(1e-18 * found.reversed, exact.reversed);
}

static void expect_verdict(const ritz_component *c, double amount,
                           ritz_verdict verdict, const char *words)
{
    const ritz_applied tip = {"tip", amount};
    RITZ_OWN(ritz_audit) audit = {0};
    const ritz_check *line = NULL;

    assert_ok(ritz_audit_component_under(c, 1, &tip, &audit));
    line = find(&audit, "buckling-applied");
    assert_int_equal(line->verdict, verdict);
    assert_non_null(strstr(line->says, words));
}

static void a_load_above_half_of_its_buckling_load_warns(void **state)
{
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    expect_verdict(&c, 1.2, RITZ_PASS, "48.6 % of those at which it buckles");
    expect_verdict(&c, 1.3, RITZ_WARN, "deflections 2.11 times as large");
    expect_verdict(&c, 2.5, RITZ_FAIL,
                   "buckles at 0.986961 times the loads that act");
    expect_verdict(&c, -3.0, RITZ_PASS, "the loads that act stiffen it");
}

/* The pull cancels half of the push. */
static void loads_that_act_are_added(void **state)
{
    const ritz_applied both[] = {{"tip", 2.0}, {"pull", 1.0}};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    (void)state;
    assert_ok(column_component(12, COLUMN_CLAMPED_FREE, &c));
    assert_ok(ritz_audit_component_under(&c, 2, both, &audit));
    assert_near(find(&audit, "buckling-applied")->value, 2.4674021, 5e-8);
    assert_near(find(&audit, "buckling:tip")->value, 2.4674021, 5e-8);
    assert_true(isnan(find(&audit, "buckling-reversed:tip")->value));
}

static void a_load_that_is_not_there_is_refused(void **state)
{
    const ritz_applied wind = {"wind", 1.0}, huge = {"tip", HUGE_VAL};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    (void)state;
    assert_ok(column_component(4, COLUMN_CLAMPED_FREE, &c));
    assert_fails(ritz_audit_component_under(&c, 1, &wind, &audit),
                 RITZ_ERR_ARGUMENT,
                 "there is no geometric stiffness of a load 'wind'");
    assert_fails(ritz_audit_component_under(&c, 1, &huge, &audit),
                 RITZ_ERR_ARGUMENT, "load 'tip' is not finite");
}

static ritz_status find_and_free(const ritz_component *c,
                                 const ritz_reduced *reduced)
{
    RITZ_OWN(ritz_audit) audit = {0};
    const ritz_applied tip = {"tip", 1.0};
    ritz_buckling *found = NULL;

    RITZ_CHECK(ritz_buckling_of_component(c, &found));
    free(found);
    return ritz_audit_reduced_under(reduced, 1, &tip, &audit);
}

static void buckling_survives_every_allocation(void **state)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    assert_ok(column_component(2, COLUMN_CLAMPED_FREE, &c));
    request.component = &c;
    request.modes = 2;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_ok(ritz_reduce(&c, &basis, &reduced));
    assert_survives_every_allocation(find_and_free(&c, &reduced));
}

static ritz_status iterate(const ritz_component *c)
{
    ritz_buckling found = {0};

    return ritz_buckling_iterated(&c->K, &c->load[COLUMN_BOTH].KG, &found);
}

static void iterations_survive_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(column_component(2, COLUMN_CLAMPED_FREE, &c));
    assert_survives_every_allocation(iterate(&c));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_cantilever_column_buckles_at_a_quarter_of_pi_square),
    cmocka_unit_test(a_pinned_column_buckles_at_pi_square),
    cmocka_unit_test(a_load_that_pushes_and_pulls_has_factors_of_both_signs),
    cmocka_unit_test(iterations_agree_with_lapack),
    cmocka_unit_test(a_load_of_rank_one_has_one_factor),
    cmocka_unit_test(nothing_buckles_without_geometric_stiffness),
    cmocka_unit_test(
        a_reduced_model_buckles_later_and_nearly_where_the_full_one_does),
    cmocka_unit_test(a_free_body_has_no_factor),
    cmocka_unit_test(factors_that_rounding_takes_digits_of_give_a_warning),
    cmocka_unit_test(a_fine_column_buckles_at_its_closed_form),
    cmocka_unit_test(factors_of_a_plate_are_those_of_its_closed_form),
    cmocka_unit_test(a_sheared_plate_has_the_same_factor_in_both_directions),
    cmocka_unit_test(the_unit_of_a_load_does_not_matter),
    cmocka_unit_test(a_load_above_half_of_its_buckling_load_warns),
    cmocka_unit_test(loads_that_act_are_added),
    cmocka_unit_test(a_load_that_is_not_there_is_refused),
    cmocka_unit_test(buckling_survives_every_allocation),
    cmocka_unit_test(iterations_survive_every_allocation),
};

TEST_MODULE(buckling, tests, NULL, NULL)
