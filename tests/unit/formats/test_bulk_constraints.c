/* Constraint elements of bulk data as equations. */
#include "model/equations.h"
#include "testing.h"

#include "foreign.h"
#include "solvers.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

static ritz_status parse(const char *text, ritz_deck *out)
{
    return ritz_deck_parse("deck.bdf", text, (int64_t)strlen(text), NULL, out);
}

/* The sum of shares of a dof in the equation of another; NaN if there is
   none. */
static double share(const ritz_deck *bulk, ritz_dof dependent, ritz_dof on)
{
    const ritz_equations *eq = &bulk->equations;
    int64_t e = ritz_equations_find(eq, dependent);
    double sum = 0.0;

    if (e < 0)
        return nan("");
    for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
        if (ritz_dof_compare(&eq->dof[k], &on) == 0)
            sum += eq->share[k];
    return sum;
}

/* u(dof) of the rigid motion q = [t; r] about the basic origin. */
static double rigid(const ritz_deck *bulk, ritz_dof dof, const double q[6])
{
    const ritz_grids *g = &bulk->grids;
    int64_t k = ritz_grids_find(g, dof.grid);
    const double *x = g->position + 3 * k;
    const double *a = g->axes + 9 * g->frame[k] + 3 * ((dof.component - 1) % 3);
    const double moved[3] = {q[0] + q[4] * x[2] - q[5] * x[1],
                             q[1] + q[5] * x[0] - q[3] * x[2],
                             q[2] + q[3] * x[1] - q[4] * x[0]};
    const double *u = dof.component > 3 ? q + 3 : moved;

    return a[0] * u[0] + a[1] * u[1] + a[2] * u[2];
}

/* Every equation holds for the six rigid motions, to `bound`. */
static void assert_rigid(const ritz_deck *bulk, double bound)
{
    const ritz_equations *eq = &bulk->equations;

    for (int j = 0; j < 6; j++) {
        const double q[6] = {j == 0, j == 1, j == 2, j == 3, j == 4, j == 5};

        for (int64_t e = 0; e < eq->count; e++) {
            double gap = rigid(bulk, eq->dependent[e], q);

            for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
                gap -= eq->share[k] * rigid(bulk, eq->dof[k], q);
            assert_near(gap, 0.0, bound);
        }
    }
}

/* ---- each element ------------------------------------------------------ */

static void an_mpc_is_solved_for_its_first_dof(void **state)
{
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse("GRID,1\nGRID,2\nSPOINT,5,6\n"
                    "MPC,4,1,3,2.0,2,1,-1.0\n,,5,0,4.0,6,1,-3.0\n,,2,2,1.0\n",
                    &bulk));
    assert_int_equal(bulk.equations.count, 1);
    assert_int_equal(bulk.equations.first[1], 4);
    assert_near(share(&bulk, (ritz_dof){1, 3}, (ritz_dof){2, 1}), 0.5, 0.0);
    assert_near(share(&bulk, (ritz_dof){1, 3}, (ritz_dof){5, 0}), -2.0, 0.0);
    assert_near(share(&bulk, (ritz_dof){1, 3}, (ritz_dof){6, 0}), 1.5, 0.0);
    assert_near(share(&bulk, (ritz_dof){1, 3}, (ritz_dof){2, 2}), -0.5, 0.0);
    assert_string_equal(bulk.equations.from[0].name, "MPC 4");
    assert_int_equal(bulk.equations.from[0].line, 4);
}

static void mpc_sets_act_as_the_case_control_selects(void **state)
{
    static const char TEXT[] = "CEND\nMPC = 8\nBEGIN BULK\nGRID,1\nGRID,2\n"
                               "MPCADD,8,4,5\nMPC,4,1,1,1.,2,1,-1.\n"
                               "MPC,5,1,2,1.,2,2,-1.\nMPC,6,1,3,1.,2,3,-1.\n";
    ritz_deck bulk = {0};

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    assert_int_equal(bulk.equations.count, 2);
    assert_int_equal(bulk.equations.dependent[1].component, 2);
    ritz_deck_free(&bulk);
    assert_ok(parse(strstr(TEXT, "GRID"), &bulk)); /* none selected: all act */
    assert_int_equal(bulk.equations.count, 3);
    ritz_deck_free(&bulk);
}

static void an_rbe2_carries_its_grids_along(void **state)
{
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    /* grid 2 two to the right of grid 1: u_y = u1_y + 2 r1_z */
    assert_ok(parse("GRID,1,,1.,0.,0.\nGRID,2,,3.,0.,0.\nGRID,3,,1.,1.,0.\n"
                    "RBE2,9,1,1236,2,3,6.5-6\n",
                    &bulk));
    assert_int_equal(bulk.equations.count, 8);
    assert_near(share(&bulk, (ritz_dof){2, 2}, (ritz_dof){1, 2}), 1.0, 0.0);
    assert_near(share(&bulk, (ritz_dof){2, 2}, (ritz_dof){1, 6}), 2.0, 0.0);
    assert_near(share(&bulk, (ritz_dof){2, 3}, (ritz_dof){1, 5}), -2.0, 0.0);
    assert_near(share(&bulk, (ritz_dof){3, 1}, (ritz_dof){1, 6}), -1.0, 0.0);
    assert_near(share(&bulk, (ritz_dof){2, 6}, (ritz_dof){1, 6}), 1.0, 0.0);
    assert_true(isnan(share(&bulk, (ritz_dof){2, 4}, (ritz_dof){1, 4})));
    /* along basic axes nothing but what is written above: no rounding */
    assert_int_equal(bulk.equations.first[8], 1 + 2 + 2 + 1 + 2 + 1 + 2 + 1);
}

static const char FRAMES[] = "CORD2R,4,,0.,0.,0.,0.3,0.1,1.0\n,1.0,0.4,0.\n"
                             "CORD2C,5,,1.,0.,0.,-1.0,0.2,0.3\n,0.,1.,0.\n"
                             "GRID,1,,1.,2.,3.,4\nGRID,2,,-1.,2.,0.5,5\n"
                             "GRID,3,,4.,0.,1.\nGRID,4,,0.,-3.,1.,5\n"
                             "GRID,5,,2.,2.,-1.,4\n";

static void every_element_follows_rigid_motion(void **state)
{
    static const char *const cards[] = {
        "RBE2,9,1,123456,2,3,4\n",
        "RBAR,9,1,2,123,456,456,123\n",
        "RBAR,9,1,2,123456\n",
        "RBAR,9,1,2,1234,23\n",
        "RTRPLT,9,1,2,3,1234,3,3,\n",
        "RTRPLT,9,1,2,3,123,23,3,\n,456,1,12\n",
        "RBE1,9,1,123,2,13,3,2\n,UM,4,123456,5,345\n",
        "RBE1,9,1,123,3,456\n,,\n,UM,4,123456,5,6,2.5-6\n",
        "RBE3,9,,1,123456,1.0,123,2,3,\n,4,5\n",
        "RBE3,9,,1,1346,0.5,123456,2,2.0\n,12,3,4,5,ALPHA,1.-6\n",
        "RBE3,9,,1,123456,1.0,123,2,3\n,4,5\n,UM,2,123,3,12,4,3\n",
        "RBE3,9,,1,123456,1.0,123,2,3\n,4,5\n,um,2,12,3,1,1,126\n",
    };
    char text[1024];
    ritz_deck bulk = {0};

    (void)state;
    for (size_t k = 0; k < sizeof cards / sizeof *cards; k++) {
        snprintf(text, sizeof text, "%s%s", FRAMES, cards[k]);
        assert_ok(parse(text, &bulk));
        if (bulk.equations.refused)
            fail_msg("%s", bulk.equations.refused);
        /* positions up to 4, shares up to some 50 where six dofs hold the
         * body badly: eps times that and the terms of a row, measured 2e-14 */
        assert_rigid(&bulk, 1e-12);
        ritz_deck_free(&bulk);
    }
}

static void an_rbar_names_its_dependents_or_leaves_them_over(void **state)
{
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse("GRID,1\nGRID,2,,0.,0.,5.\nRBAR,3,1,2,123456,,,12\n"
                    "RBAR,4,2,1,,123456,,\nRBAR,5,1,2,12346,3\n",
                    &bulk));
    /* 3: u2_1, u2_2; 4: all of grid 2; 5 leaves r1_y and five of grid 2, but
     * u2_z says nothing that u1_z does not: it is refused */
    assert_int_equal(bulk.equations.count, 2 + 6);
    assert_near(share(&bulk, (ritz_dof){2, 1}, (ritz_dof){1, 5}), 5.0, 0.0);
    assert_non_null(strstr(bulk.equations.refused,
                           "'deck.bdf', line 5: RBAR 5 is left free to move by "
                           "its six independent dofs"));
}

/* Four grids around the fifth: what symmetry demands. */
static void an_rbe3_is_the_mean_of_what_is_around_it(void **state)
{
    static const char AROUND[] = "GRID,100,,1.,0.,0.\nGRID,200,,0.,1.,0.\n"
                                 "GRID,300,,-1.,0.,0.\nGRID,400,,0.,-1.,0.\n"
                                 "GRID,500\n";
    const double eps = 4.0 * 0x1p-52; /* a few products of numbers up to 1 */
    char text[400];
    ritz_deck bulk = {0};

    (void)state;
    snprintf(text, sizeof text,
             "%sRBE3,1,,500,123456,1.0,123,100,200\n,300,400\n", AROUND);
    assert_ok(parse(text, &bulk));
    for (int64_t c = 1; c <= 3; c++)
        for (int64_t g = 100; g <= 400; g += 100)
            assert_near(share(&bulk, (ritz_dof){500, c}, (ritz_dof){g, c}),
                        0.25, eps);
    /* turning about x shows at grids 200 and 400 alone, about z at all */
    assert_near(share(&bulk, (ritz_dof){500, 4}, (ritz_dof){200, 3}), 0.5, eps);
    assert_near(share(&bulk, (ritz_dof){500, 4}, (ritz_dof){400, 3}), -0.5,
                eps);
    assert_near(share(&bulk, (ritz_dof){500, 6}, (ritz_dof){100, 2}), 0.25,
                eps);
    assert_near(share(&bulk, (ritz_dof){500, 6}, (ritz_dof){200, 1}), -0.25,
                eps);
    /* 12 shares of translations, 2 + 2 + 4 of rotations, none of rounding */
    assert_int_equal(bulk.equations.first[6], 20);
    ritz_deck_free(&bulk);
    /* a weight of three pulls the mean: (3 u + u) / 4 along the line */
    snprintf(text, sizeof text, "%sRBE3,1,,500,2,3.0,123,100,1.0\n,123,300\n",
             AROUND);
    assert_ok(parse(text, &bulk));
    /* about the reference, amid the two: by least squares the motion is that
     * of the line through both, at its middle */
    assert_near(share(&bulk, (ritz_dof){500, 2}, (ritz_dof){100, 2}), 0.5, eps);
    ritz_deck_free(&bulk);
}

/*
 * With rotations: of two grids at +-L along x with weight 1 on all six dofs,
 * the rotation about z is (L (u2_y - u1_y) + L^2 (r1 + r2)) / (4 L^2), as the
 * mean distance L makes rotations count L^2 each.
 */
static void rotations_weigh_by_the_square_of_the_mean_distance(void **state)
{
    const double L = 8.0;
    RITZ_OWN(ritz_deck) bulk = {0};

    (void)state;
    assert_ok(parse("GRID,1,,-8.,0.,0.\nGRID,2,,8.,0.,0.\nGRID,3\n"
                    "RBE3,1,,3,6,1.0,123456,1,2\n",
                    &bulk));
    assert_near(share(&bulk, (ritz_dof){3, 6}, (ritz_dof){2, 2}), 0.25 / L,
                1e-16); /* eps of the numbers beside */
    assert_near(share(&bulk, (ritz_dof){3, 6}, (ritz_dof){1, 6}), 0.25, 1e-15);
}

/* ---- what a commercial NASTRAN made of it ------------------------------ */

/* GM of superelement 101, 4 x 180, from RBE2 600, RBE3 601 and MPC 602, with
 * grids in two displacement frames. */
static void nastran_makes_the_same_of_the_outboard_deck(void **state)
{
    enum { ALL = 27 * 6 + 22, DEPENDENT = 4 };
    char deck[512], matrix[512], spec[520];
    RITZ_OWN(ritz_deck) bulk = {0};
    RITZ_OWN(ritz_elimination) e = {0};
    RITZ_OWN(ritz_matrix) gm = {0};
    RITZ_OWN(ritz_dense) G = {0}, GM = {0};

    (void)state;
    if (!solvers_find(CSUPER "outboard.dat", deck) ||
        !solvers_find(CSUPER "nas2cam.op4", matrix))
        skip();
    snprintf(spec, sizeof spec, "%s:GM", matrix);
    assert_ok(ritz_deck_read(deck, &bulk));
    assert_int_equal(bulk.num_dofs, ALL);
    assert_ok(ritz_elimination_new(&bulk.equations, ALL, bulk.dof, NULL, &e));
    assert_int_equal(e.gone.count, DEPENDENT);
    assert_ok(foreign_select(spec, &gm));
    assert_ok(ritz_sparse_dense(&gm.A, &GM));
    assert_ok(ritz_sparse_dense(&e.G, &G));
    assert_int_equal(GM.nrow, DEPENDENT);
    assert_int_equal(GM.ncol, ALL - DEPENDENT);
    /* shares up to 600 (lengths), which it writes in double precision: eps
     * times the largest and a condition of 10 */
    for (int64_t j = 0; j < GM.ncol; j++)
        for (int64_t i = 0; i < DEPENDENT; i++)
            assert_near(ritz_dense_col(&G, j)[e.gone.at[i]],
                        ritz_dense_col(&GM, j)[i], 1e-12);
}

/* ---- refusals ---------------------------------------------------------- */

/* On a line, and a point. */
static const char LINE_OF_GRIDS[] =
    "GRID,1\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\n"
    "SPOINT,7\n";
static const struct {
    const char *card, *words;
} misread[] = {
    {"RSPLINE,6,,1,2,3\n",
     "'deck.bdf', line 5: RSPLINE 6 is not understood: MPC, RBAR, RBE1, "
     "RBE2, RBE3 and RTRPLT are"},
    {"RROD,6,1,2,1\n", "RROD 6 is not understood"},
    {"RBE2,6,8,123,1\n",
     "RBE2 6 names grid '8', which the deck does not define"},
    {"RBE2,6,1,123,7\n", "RBE2 6 names '7', a scalar point: it is nowhere"},
    {"RBE2,6,1,,2\n",
     "a field of RBE2 is blank where a list of directions 1 to 6 must be"},
    {"RBE2,6,1,127,2\n", "'127' in RBE2 is not a list of directions"},
    {"RBE2,6,1,123,1\n", "RBE2 6 makes a dof of grid '1' depend on itself"},
    {"RBE2,6,1,123,2,THRU,3\n", "'THRU' in RBE2 is not a positive whole"},
    {"RBAR,6,1,2\n", "RBAR 6 has 0 independent dofs, six are due"},
    {"RBAR,6,1,2,123,12\n", "RBAR 6 has 5 independent dofs, six are due"},
    {"RBAR,6,1,2,12345,1\n",
     "RBAR 6 is left free to move by its six independent dofs"},
    {"RBAR,6,1,2,123456,,1\n",
     "RBAR 6 makes a dof of grid '1' depend on itself"},
    {"RBE1,6,1,123456\n", "RBE1 6 names no dependent dofs by UM"},
    {"RBE3,6,,1,123456,1.0,123,2,3\n",
     "RBE3 6 cannot tell 'grid 1 R1' from the dofs that it averages: do "
     "they lie on a line?"},
    {"RBE3,6,,1,123,0.0,123,2,3\n",
     "RBE3 6 cannot tell 'grid 1 T1' from the dofs that it averages"},
    {"RBE3,6,,1,123,-1.0,123,2,3\n",
     "'-1.0' in RBE3 is not a weight from zero on"},
    {"RBE3,6,,1,123,1.0,,2,3\n", "a field of RBE3 is blank"},
    {"RBE3,6,,1,,1.0,123,2,3\n", "a field of RBE3 is blank"},
    {"RBE3,6,,1,123\n", "RBE3 6 cannot tell 'grid 1 T1'"},
    {"RBE3,6,,1,123,1.0,123456,2,3\n,UM,2,12\n",
     "RBE3 6 names 2 dofs by UM, 3 depend"},
    {"RBE3,6,,1,123,1.0,123,2,3\n,UM,2,126\n",
     "RBE3 6 names 'grid 2 R3' by UM, which it does not hold, or twice"},
    {"RBE3,6,,1,123,1.0,123456,2,3\n,UM,2,1,3,14\n",
     "RBE3 6 cannot be solved for the dofs that UM names"},
    {"MPC,6,1,1,0.0,2,1,1.0\n",
     "MPC 6 begins with a factor of zero, and its first dof is the one "
     "that depends"},
    {"MPC,6,1,1,1.0,2,1\n", "a field of MPC is blank where a factor must be"},
    {"MPC,6,1,0,1.0,2,1,1.0\n", "'0' in MPC is not a direction 1 to 6"},
    {"MPC,6,7,2,1.0,2,1,1.0\n",
     "'2' in MPC is not a direction of a scalar point"},
    {"MPC,6,9,1,1.0,2,1,1.0\n",
     "MPC 6 names '9', which the deck does not define"},
    {"MPC,6,1,1,1.0,2,1,1.0,3\n",
     "'3' in MPC is not where MPC has a term: that field is blank"},
};
static void what_is_not_understood_is_kept_as_a_sentence(void **state)
{
    char text[300];
    ritz_deck bulk = {0};

    (void)state;
    for (size_t k = 0; k < sizeof misread / sizeof *misread; k++) {
        snprintf(text, sizeof text, "%s%s", LINE_OF_GRIDS, misread[k].card);
        assert_ok(parse(text, &bulk));
        if (!bulk.equations.refused ||
            !strstr(bulk.equations.refused, misread[k].words))
            fail_msg("%s: '%s'", misread[k].card,
                     bulk.equations.refused ? bulk.equations.refused : "");
        assert_int_equal(bulk.num_constraints, 1);
        ritz_deck_free(&bulk);
    }
}

static void imposed_motion_is_noted_where_it_acts(void **state)
{
    static const char TEXT[] = "CEND\nSPC = 2\nBEGIN BULK\nGRID,1\n"
                               "SPC,1,1,3,0.5\nSPC,2,1,2,0.0\n";
    ritz_deck bulk = {0};

    (void)state;
    assert_ok(parse(TEXT, &bulk));
    assert_null(bulk.imposed);
    ritz_deck_free(&bulk);
    assert_ok(parse(strstr(TEXT, "GRID"), &bulk)); /* none selected: all act */
    assert_non_null(strstr(bulk.imposed,
                           "'deck.bdf', line 2: SPC 1 moves '1' by what is "
                           "not zero: imposed motion is no part"));
    assert_int_equal(bulk.num_fixed, 2);
    ritz_deck_free(&bulk);
}

/* ---- hostile ----------------------------------------------------------- */

/* A hundred thousand lines of one RBE2, the same grids again and again. */
static void
many_continuations_are_read_and_repeats_left_to_elimination(void **state)
{
    enum { LINES = 100000, EACH = 8 };
    const char line[] = ",2,3,2,3,2,3,2,3\n";
    size_t size = 64 + LINES * sizeof line;
    char *text = malloc(size);
    size_t used = 0;
    ritz_deck bulk = {0};
    ritz_elimination e = {0};
    static const ritz_dof dof[] = {{1, 1}, {1, 2}, {1, 3}, {1, 4},
                                   {1, 5}, {1, 6}, {2, 1}, {3, 1}};

    (void)state;
    assert_non_null(text);
    used = (size_t)snprintf(text, size, "GRID,1\nGRID,2\nGRID,3\nRBE2,9,1,1\n");
    for (int k = 0; k < LINES; k++) {
        memcpy(text + used, line, sizeof line);
        used += sizeof line - 1;
    }
    assert_ok(parse(text, &bulk));
    assert_null(bulk.equations.refused);
    assert_int_equal(bulk.equations.count, LINES * EACH);
    assert_fails(ritz_elimination_new(&bulk.equations, sizeof dof / sizeof *dof,
                                      dof, NULL, &e),
                 RITZ_ERR_FORMAT,
                 "'grid 2 T1' depends on RBE2 9 ('deck.bdf', line 4) twice");
    ritz_deck_free(&bulk);
    free(text);
}

static ritz_status parse_all(void)
{
    char text[1024];
    RITZ_OWN(ritz_deck) bulk = {0};

    snprintf(text, sizeof text,
             "%sSPOINT,7\nRBE2,9,1,123456,2\nRBAR,10,1,3,1234,23\n"
             "RBE3,11,,4,123456,1.0,123,1,2\n,3,5\n,UM,5,123,4,126\n"
             "MPC,1,4,4,1.0,7,0,-1.0\nSPC,1,1,3,0.5\nRSPLINE,12,,1,2,3\n",
             FRAMES);
    RITZ_CHECK(parse(text, &bulk));
    RITZ_REFUSE_IF(!bulk.equations.refused || !bulk.imposed, RITZ_ERR_ARGUMENT,
                   "a sentence is missing");
    return RITZ_OK;
}

static void reading_survives_every_allocation(void **state)
{
    (void)state;
    assert_survives_every_allocation(parse_all());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_mpc_is_solved_for_its_first_dof),
    cmocka_unit_test(mpc_sets_act_as_the_case_control_selects),
    cmocka_unit_test(an_rbe2_carries_its_grids_along),
    cmocka_unit_test(every_element_follows_rigid_motion),
    cmocka_unit_test(an_rbar_names_its_dependents_or_leaves_them_over),
    cmocka_unit_test(an_rbe3_is_the_mean_of_what_is_around_it),
    cmocka_unit_test(rotations_weigh_by_the_square_of_the_mean_distance),
    cmocka_unit_test(nastran_makes_the_same_of_the_outboard_deck),
    cmocka_unit_test(what_is_not_understood_is_kept_as_a_sentence),
    cmocka_unit_test(imposed_motion_is_noted_where_it_acts),
    cmocka_unit_test(
        many_continuations_are_read_and_repeats_left_to_elimination),
    cmocka_unit_test(reading_survives_every_allocation),
};

TEST_MODULE(bulk_constraints, tests, NULL, NULL)
