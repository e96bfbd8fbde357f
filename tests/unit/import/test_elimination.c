/* Equations between dofs and their elimination; recovery of what is gone. */
#include "testing.h"

#include "model/equations.h"

#include <stdio.h>
#include <stdlib.h>

/* Equations are written u1 = sum share u2, dofs being the points 1, 2, ... */
typedef struct term {
    int64_t dependent, on;
    double share;
} term;

/* One source for all; terms of one dependent follow each other. */
static ritz_status make(int64_t count, const term *list, ritz_equations *out)
{
    ritz_status status = RITZ_OK;
    ritz_equations eq = {0};
    int64_t last = 0;

    for (int64_t k = 0; k < count; k++) {
        ritz_equation_source from = {.file = -1};

        if (list[k].dependent != last) {
            snprintf(from.name, sizeof from.name, "MPC %lld",
                     (long long)eq.num_sources + 1);
            RITZ_TRY(ritz_equations_cite_next(&eq, from));
            RITZ_TRY(
                ritz_equations_begin(&eq, (ritz_dof){list[k].dependent, 0}));
        }
        last = list[k].dependent;
        RITZ_TRY(
            ritz_equations_add(&eq, (ritz_dof){list[k].on, 0}, list[k].share));
    }
    *out = eq;
    eq = (ritz_equations){0};
done:
    ritz_equations_free(&eq);
    return status;
}

enum { POINTS = 6 };

static const ritz_dof points[POINTS] = {{1, 0}, {2, 0}, {3, 0},
                                        {4, 0}, {5, 0}, {6, 0}};

/* Solve equations between the six points. */
static ritz_status solve(int64_t count, const term *list, const bool *fixed,
                         ritz_elimination *out)
{
    ritz_status status = RITZ_OK;
    ritz_equations eq = {0};

    RITZ_TRY(make(count, list, &eq));
    RITZ_TRY(ritz_elimination_new(&eq, POINTS, points, fixed, out));
done:
    ritz_equations_free(&eq);
    return status;
}

static double entry(const ritz_elimination *e, int64_t row, int64_t kept)
{
    ritz_dense G = {0};
    double value = 0.0;
    int64_t j = 0;

    if (!e->kept.at)
        return nan("");
    while (e->kept.at[j] != kept)
        j++;
    assert_ok(ritz_sparse_dense(&e->G, &G));
    value = ritz_dense_col(&G, j)[row];
    ritz_dense_free(&G);
    return value;
}

/* Entries of the first columns of G. */
static int64_t entries(const ritz_elimination *e, int64_t columns)
{
    return e->G.colptr ? e->G.colptr[columns] : -1;
}

static void dependents_follow_what_others_follow(void **)
{
    /* u2 = 2 u5, u1 = u2 + 3 u4, u6 = -u1: in whatever order they come */
    static const term list[] = {
        {6, 1, -1.0}, {1, 2, 1.0}, {1, 4, 3.0}, {2, 5, 2.0}};
    RITZ_OWN(ritz_elimination) e = {0};

    assert_ok(solve(4, list, NULL, &e));
    assert_int_equal(e.kept.count, 3);
    assert_int_equal(e.gone.count, 3);
    assert_true(e.kept.at && e.kept.at[0] == 2);
    assert_true(e.gone.at && e.gone.at[2] == 5);
    assert_near(entry(&e, 0, 3), 3.0, 0.0);
    assert_near(entry(&e, 0, 4), 2.0, 0.0);
    assert_near(entry(&e, 5, 3), -3.0, 0.0);
    assert_near(entry(&e, 5, 4), -2.0, 0.0);
    assert_near(entry(&e, 2, 2), 1.0, 0.0);
    assert_int_equal(entries(&e, 3), 3 + 2 + 1 + 2);
}

static void a_circle_is_a_system_of_its_own(void **)
{
    /* u1 = u2 / 2 + u3, u2 = u1 / 4 + u4: u1 = (8 u3 + 4 u4) / 7;
     * u5 follows the circle and u6 itself, u6 = u6 / 2 + u3 */
    static const term list[] = {{5, 1, 7.0}, {5, 2, 1.0},  {1, 2, 0.5},
                                {1, 3, 1.0}, {2, 1, 0.25}, {2, 4, 1.0},
                                {6, 6, 0.5}, {6, 3, 1.0}};
    const double eps = 8.0 * 0x1p-52; /* some ten operations near 1 */
    RITZ_OWN(ritz_elimination) e = {0};

    assert_ok(solve(8, list, NULL, &e));
    assert_near(entry(&e, 0, 2), 8.0 / 7.0, eps);
    assert_near(entry(&e, 0, 3), 4.0 / 7.0, eps);
    assert_near(entry(&e, 1, 2), 2.0 / 7.0, eps);
    assert_near(entry(&e, 1, 3), 8.0 / 7.0, eps);
    assert_near(entry(&e, 4, 2), 8.0 + 2.0 / 7.0, 8.0 * eps);
    assert_near(entry(&e, 5, 2), 2.0, 2.0 * eps);
}

static void shares_of_one_dof_add_up_and_zeros_are_none(void **)
{
    static const term list[] = {
        {1, 2, 1.0}, {1, 2, 0.5}, {1, 3, 0.0}, {4, 5, 1.0}, {4, 5, -1.0}};
    ritz_elimination e = {0};

    assert_ok(solve(5, list, NULL, &e));
    assert_near(entry(&e, 0, 1), 1.5, 0.0);
    assert_near(entry(&e, 3, 4), 0.0, 0.0);  /* u4 = 0 */
    assert_int_equal(entries(&e, 4), 4 + 1); /* no zero is stored */
    ritz_elimination_free(&e);
    assert_ok(solve(0, NULL, NULL, &e)); /* no equation: the identity */
    assert_int_equal(entries(&e, POINTS), POINTS);
    ritz_elimination_free(&e);
}

static void contradictions_are_refused_with_both_cards(void **)
{
    static const struct {
        term list[4];
        int64_t count;
        ritz_status status;
        const char *words;
    } cases[] = {
        {{{1, 2, 1.0}, {3, 2, 1.0}, {1, 4, 1.0}},
         3,
         RITZ_ERR_FORMAT,
         "'point 1' depends on MPC 1 and on MPC 3"},
        {{{4, 2, 1.0}},
         1,
         RITZ_ERR_FORMAT,
         "'point 4' depends on MPC 1 and is fixed by the deck: it cannot be "
         "both"},
        {{{1, 9, 1.0}},
         1,
         RITZ_ERR_FORMAT,
         "MPC 1 names 'point 9', which is not among the dofs"},
        {{{9, 1, 1.0}},
         1,
         RITZ_ERR_FORMAT,
         "MPC 1 names 'point 9', which is not among the dofs"},
        {{{1, 1, 1.0}, {1, 2, 1.0}},
         2,
         RITZ_ERR_SINGULAR,
         "MPC 1 leaves 'point 1' undetermined: it depends on itself alone"},
        {{{1, 2, 1.0}, {2, 1, 1.0}, {2, 3, 1.0}},
         3,
         RITZ_ERR_SINGULAR,
         "leaves 'point 1' undetermined, together with the constraints that "
         "depend on it"},
    };
    const bool fixed[POINTS] = {[3] = true};
    ritz_elimination e = {0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(solve(cases[k].count, cases[k].list, fixed, &e),
                         cases[k].status);
        if (!strstr(ritz_error_message(), cases[k].words))
            fail_msg("'%s'", ritz_error_message());
    }
    assert_null(e.G.val);
}

static void one_card_may_not_name_a_dof_twice(void **)
{
    RITZ_OWN(ritz_equations) eq = {0};
    ritz_elimination e = {0};
    ritz_equation_source from = {.name = "RBE2 7", .file = -1, .line = 12};

    assert_ok(ritz_equations_cite_next(&eq, from));
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_equations_begin(&eq, (ritz_dof){1, 0}));
        assert_ok(ritz_equations_add(&eq, (ritz_dof){2, 0}, 1.0));
    }
    assert_fails(ritz_elimination_new(&eq, POINTS, points, NULL, &e),
                 RITZ_ERR_FORMAT,
                 "'point 1' depends on RBE2 7 (line 12) twice");
}

/* u_k = u_(k+1) / 2 + v: depth costs no stack, and sums are exact in binary. */
static void a_chain_may_be_long(void **)
{
    enum { LENGTH = 200000 };
    ritz_equations eq = {0};
    ritz_elimination e = {0};
    ritz_dof *dof = calloc(LENGTH + 2, sizeof *dof);

    assert_non_null(dof);
    assert_ok(ritz_equations_cite_next(
        &eq, (ritz_equation_source){.name = "MPC 1", .file = -1}));
    for (int64_t k = 0; k < LENGTH + 2; k++)
        dof[k] = (ritz_dof){k + 1, 0};
    for (int64_t k = 0; k < LENGTH; k++) {
        assert_ok(ritz_equations_begin(&eq, dof[k]));
        assert_ok(ritz_equations_add(&eq, dof[k + 1], 0.5));
        assert_ok(ritz_equations_add(&eq, dof[LENGTH + 1], 1.0));
    }
    assert_ok(ritz_elimination_new(&eq, LENGTH + 2, dof, NULL, &e));
    /* u = 2 v (1 - 2^-k) + 2^-k u_last: after 53 halvings exactly 2 v */
    assert_near(e.G.val[e.G.colptr[1]], 2.0, 0.0);
    assert_near(e.G.val[e.G.colptr[1] + LENGTH - 1], 1.0, 0.0);
    ritz_elimination_free(&e);
    ritz_equations_free(&eq);
    free(dof);
}

static void circles_of_many_are_refused(void **)
{
    enum { LENGTH = 2001 };
    RITZ_OWN(ritz_equations) eq = {0};
    ritz_elimination e = {0};
    ritz_dof dof[LENGTH];

    assert_ok(ritz_equations_cite_next(
        &eq, (ritz_equation_source){.name = "MPC 1", .file = -1}));
    for (int64_t k = 0; k < LENGTH; k++)
        dof[k] = (ritz_dof){k + 1, 0};
    for (int64_t k = 0; k < LENGTH; k++) {
        assert_ok(ritz_equations_begin(&eq, dof[k]));
        assert_ok(ritz_equations_add(&eq, dof[(k + 1) % LENGTH], 0.5));
    }
    assert_fails(ritz_elimination_new(&eq, LENGTH, dof, NULL, &e),
                 RITZ_ERR_FORMAT,
                 "2001 dofs depend on each other in a circle, of at most 2000 "
                 "that is solved");
}

enum { RANDOM_DOFS = 60, RANDOM_TERMS = 3 };

/* An equation of dof `dependent` with terms that a generator chooses. */
static void add_random_equation(const ritz_dof dof[static RANDOM_DOFS],
                                int64_t dependent, uint64_t *seed,
                                ritz_equations *eq)
{
    assert_ok(ritz_equations_begin(eq, dof[dependent]));
    for (int j = 0; j < RANDOM_TERMS; j++) {
        *seed = *seed * 6364136223846793005U + 1442695040888963407U;
        assert_ok(ritz_equations_add(eq, dof[(*seed >> 33) % RANDOM_DOFS],
                                     ((double)((*seed >> 20) % 1000) - 500.0) /
                                         4000.0));
    }
}

/*
 * Whatever the graph is, G solves the equations: u_m - R u = 0 for u = G u_n.
 * Shares up to 1/8 of at most three keep I - R_mm well conditioned, so that
 * rounding of some n products of numbers below 1 is all there is.
 */
static void random_equations_hold_for_every_motion(void **)
{
    enum { ALL = RANDOM_DOFS, DEPENDENT = 25, SEEDS = 200 };
    uint64_t seed = 7;

    for (int s = 0; s < SEEDS; s++) {
        ritz_equations eq = {0};
        ritz_elimination e = {0};
        ritz_dense G = {0};
        ritz_dof dof[ALL];

        for (int64_t k = 0; k < ALL; k++)
            dof[k] = (ritz_dof){100 - k, 0};
        assert_ok(ritz_equations_cite_next(
            &eq, (ritz_equation_source){.name = "MPC 1", .file = -1}));
        for (int64_t k = 0; k < DEPENDENT; k++)
            add_random_equation(dof, 2 * k, &seed, &eq);
        assert_ok(ritz_elimination_new(&eq, ALL, dof, NULL, &e));
        assert_ok(ritz_sparse_dense(&e.G, &G));
        for (int64_t j = 0; j < G.ncol; j++)
            for (int64_t k = 0; k < DEPENDENT; k++) {
                double gap = ritz_dense_col(&G, j)[2 * k];

                for (int64_t t = eq.first[k]; t < eq.first[k + 1]; t++)
                    gap -= eq.share[t] *
                           ritz_dense_col(&G, j)[100 - eq.dof[t].grid];
                assert_near(gap, 0.0, ALL * 0x1p-52);
            }
        ritz_dense_free(&G);
        ritz_elimination_free(&e);
        ritz_equations_free(&eq);
    }
}

static void sources_are_cited_with_file_and_line(void **)
{
    char *paths[] = {(char[]){"deck.bdf"}};
    ritz_equation_source from = {.name = "RBE3 601", .file = 0, .line = 37};
    ritz_equations eq = {
        .num_sources = 1, .from = &from, .num_files = 1, .file = paths};
    char text[RITZ_CITATION_SIZE];

    assert_string_equal(ritz_equations_cite(&eq, 0, text),
                        "RBE3 601 ('deck.bdf', line 37)");
    assert_int_equal(ritz_equations_find(&eq, (ritz_dof){1, 0}), -1);
}

/* ---- recovery ---------------------------------------------------------- */

/* u7 = 2 u1 - u3 */
static ritz_status sample(ritz_recovery *out)
{
    static const int64_t row[] = {0, 0};
    static const int64_t col[] = {0, 2};
    static const double val[] = {2.0, -1.0};
    ritz_status status = RITZ_OK;
    ritz_recovery r = {.count = 1};

    RITZ_NEW(r.dof, 1);
    r.dof[0] = (ritz_dof){7, 0};
    RITZ_TRY(ritz_sparse_from_triplets(1, POINTS, 2, row, col, val, &r.G));
    *out = r;
    r = (ritz_recovery){0};
done:
    ritz_recovery_free(&r);
    return status;
}

static void recovered_dofs_stand_behind_the_others(void **)
{
    RITZ_OWN(ritz_recovery) r = {0}, copy = {0};
    RITZ_OWN(ritz_dense) T = {0}, shape = {0};
    ritz_dof *names = NULL;

    assert_ok(sample(&r));
    assert_ok(ritz_recovery_check(&r, POINTS, points));
    assert_ok(ritz_dense_new(POINTS, 1, &T));
    T.val[0] = 3.0;
    T.val[2] = 5.0;
    assert_ok(ritz_recovery_copy(&r, &copy));
    assert_ok(ritz_recovery_extend(&copy, POINTS, points, &T, &names, &shape));
    assert_int_equal(shape.nrow, POINTS + 1);
    assert_near(shape.val[2], 5.0, 0.0);
    assert_near(shape.val[POINTS], 1.0, 0.0);
    assert_int_equal(names[POINTS].grid, 7);
    free(names);
    names = NULL;
    ritz_dense_free(&shape);
    ritz_recovery_free(&copy);
    assert_ok(ritz_recovery_copy(&copy, &copy)); /* none of none */
    assert_ok(ritz_recovery_extend(&copy, POINTS, points, &T, &names, &shape));
    assert_int_equal(shape.nrow, POINTS);
    free(names);
    ritz_dense_free(&shape);
}

static void a_recovery_that_does_not_fit_is_refused(void **)
{
    RITZ_OWN(ritz_recovery) r = {0};

    assert_ok(sample(&r));
    assert_fails(ritz_recovery_check(&r, POINTS - 1, points), RITZ_ERR_FORMAT,
                 "recovered dofs are of another size: 1 x 6 where 1 x 5 is "
                 "due");
    assert_fails(ritz_recovery_check(&r, POINTS, NULL), RITZ_ERR_FORMAT,
                 "recovered from others that have no names");
    r.dof[0].grid = 3;
    assert_fails(ritz_recovery_check(&r, POINTS, points), RITZ_ERR_FORMAT,
                 "'point 3' is recovered and has a row, or is recovered "
                 "twice");
    r.dof[0].component = 7;
    assert_fails(ritz_recovery_check(&r, POINTS, points), RITZ_ERR_FORMAT,
                 "direction 7, which is not among 0 to 6");
    r.dof[0] = (ritz_dof){7, 0};
    r.G.val[0] = nan("");
    assert_int_equal(ritz_recovery_check(&r, POINTS, points), RITZ_ERR_FORMAT);
}

/* ---- memory ------------------------------------------------------------ */

static ritz_status eliminate_and_recover(void)
{
    static const term list[] = {{5, 1, 7.0},  {1, 2, 0.5}, {1, 3, 1.0},
                                {2, 1, 0.25}, {2, 4, 1.0}, {6, 6, 0.5}};
    ritz_status status = RITZ_OK;
    ritz_elimination e = {0};
    ritz_recovery r = {0}, copy = {0};
    ritz_dense T = {0}, shape = {0};
    ritz_dof *names = NULL;

    RITZ_TRY(solve(6, list, NULL, &e));
    RITZ_TRY(sample(&r));
    RITZ_TRY(ritz_recovery_check(&r, POINTS, points));
    RITZ_TRY(ritz_recovery_copy(&r, &copy));
    RITZ_TRY(ritz_dense_new(POINTS, 2, &T));
    RITZ_TRY(ritz_recovery_extend(&copy, POINTS, points, &T, &names, &shape));
done:
    ritz_elimination_free(&e);
    ritz_recovery_free(&r);
    ritz_recovery_free(&copy);
    ritz_dense_free(&T);
    ritz_dense_free(&shape);
    free(names);
    return status;
}

static void elimination_survives_every_allocation(void **)
{
    assert_survives_every_allocation(eliminate_and_recover());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(dependents_follow_what_others_follow),
    cmocka_unit_test(a_circle_is_a_system_of_its_own),
    cmocka_unit_test(shares_of_one_dof_add_up_and_zeros_are_none),
    cmocka_unit_test(contradictions_are_refused_with_both_cards),
    cmocka_unit_test(one_card_may_not_name_a_dof_twice),
    cmocka_unit_test(a_chain_may_be_long),
    cmocka_unit_test(circles_of_many_are_refused),
    cmocka_unit_test(random_equations_hold_for_every_motion),
    cmocka_unit_test(sources_are_cited_with_file_and_line),
    cmocka_unit_test(recovered_dofs_stand_behind_the_others),
    cmocka_unit_test(a_recovery_that_does_not_fit_is_refused),
    cmocka_unit_test(elimination_survives_every_allocation),
};

TEST_MODULE(elimination, tests, NULL, NULL)
