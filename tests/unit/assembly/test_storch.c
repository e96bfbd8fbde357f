/*
 * A cantilever with a rigid tip body [Storch1992], E I = rho A = l = 1: beam
 * and body are two components that meet in a port each. The body has mass m,
 * inertia J about the port and its centre c beyond it. omega_k = beta_k^2.
 */
#include "testing.h"

#include "frame.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdlib.h>

enum { TIP = 100 }; /* grid of the body */

/* A tip body and, where they were computed, the exact beta of the beam. */
typedef struct tip_body {
    double m, J, c;
    int count;
    double beta[6];
} tip_body;

/* oracles.md section 3: roots of eq. A.9 to the digits shown */
static const tip_body storch = {2.0,
                                0.028,
                                0.1,
                                6,
                                {1.00766920016, 3.45996371162, 5.91002187326,
                                 8.50464434752, 11.3805475677, 14.3948276492}};
static const tip_body point_mass = {5.0, 0.0, 0.0, 1, {0.8700214589}};
static const tip_body heavy = {1.0, 1.0, 0.0, 1, {0.9316113841}};

/* Keep the directions y and turning about z of a clamped frame: no axial. */
static ritz_status make_beam(int64_t elements, ritz_component *out)
{
    static const frame_section unit = {
        .rho = 1.0, .area = 1.0, .inertia = 1.0, .modulus = 1.0};
    ritz_status status = RITZ_OK;
    ritz_component beam = {0};
    ritz_sparse K = {0}, M = {0};
    int64_t *keep = NULL;
    int64_t n = 0;

    RITZ_TRY(frame_component(elements, 1.0 / (double)elements, &unit, true,
                             false, 0, &beam));
    RITZ_NEW(keep, beam.num_dofs);
    for (int64_t i = 0; i < beam.num_dofs; i++)
        if (beam.dof[i].component != 1) {
            beam.dof[n] = beam.dof[i];
            keep[n++] = i;
        }
    RITZ_TRY(ritz_sparse_extract(&beam.K, n, keep, n, keep, &K));
    RITZ_TRY(ritz_sparse_extract(&beam.M, n, keep, n, keep, &M));
    ritz_sparse_free(&beam.K);
    ritz_sparse_free(&beam.M);
    ritz_io_free(&beam.io);
    beam.K = K;
    beam.M = M;
    K = M = (ritz_sparse){0};
    beam.num_dofs = n;
    RITZ_TRY(ritz_component_settle(&beam, false));
    RITZ_TRY(add_port(&beam, "end", elements));
    *out = beam;
    beam = (ritz_component){0};
done:
    free(keep);
    ritz_sparse_free(&K);
    ritz_sparse_free(&M);
    ritz_component_free(&beam);
    return status;
}

/*
 * Mass alone, about the port at x = 1: with r = (c, 0, 0) to the centre,
 * M = [m I, -m r~; m r~, J]. Without inertia it is a point of three dofs.
 */
static ritz_status make_body(const tip_body *tip, ritz_component *out)
{
    const double mc = tip->m * tip->c;
    const int64_t row[] = {0, 1, 2, 1, 5, 2, 4, 3, 4, 5};
    const int64_t col[] = {0, 1, 2, 5, 1, 4, 2, 3, 4, 5};
    const double val[] = {tip->m, tip->m, tip->m,       mc,     mc,
                          -mc,    -mc,    0.4 * tip->J, tip->J, tip->J};
    const bool turns = tip->J > 0.0;
    ritz_status status = RITZ_OK;
    ritz_component body = {.num_dofs = turns ? 6 : 3};

    RITZ_TRY(ritz_sparse_from_triplets(body.num_dofs, body.num_dofs,
                                       turns ? 10 : 3, row, col, val, &body.M));
    RITZ_NEW(body.dof, body.num_dofs);
    for (int64_t k = 0; k < body.num_dofs; k++)
        body.dof[k] = (ritz_dof){TIP, k + 1};
    RITZ_NEW(body.grids.id, 1);
    RITZ_NEW(body.grids.frame, 1);
    RITZ_NEW(body.grids.position, 3);
    RITZ_NEW(body.grids.axes, 9);
    body.grids.count = body.grids.num_frames = 1;
    body.grids.id[0] = TIP;
    body.grids.position[0] = 1.0;
    for (int64_t k = 0; k < 3; k++)
        body.grids.axes[4 * k] = 1.0;
    RITZ_TRY(ritz_component_settle(&body, false));
    RITZ_TRY(add_port(&body, "root", TIP));
    *out = body;
    body = (ritz_component){0};
done:
    ritz_component_free(&body);
    return status;
}

/* How the two components are reduced; -1 modes where the method takes none. */
typedef struct reduction {
    const ritz_method *beam;
    int64_t modes;
    const ritz_method *body;
} reduction;

static const reduction unreduced = {&ritz_method_full, -1, &ritz_method_full};

static void join(int64_t elements, const tip_body *tip, const reduction *way,
                 ritz_configuration *out)
{
    static const char text[] =
        "scene: a cantilever with a tip body\n"
        "components:\n"
        "  beam: {model: beam.h5, basis: full}\n"
        "  body: {model: body.h5, basis: full}\n"
        "joints:\n"
        "  - {name: tip, between: [beam/end, body/root], type: fixed}\n";
    RITZ_OWN(ritz_component) beam = {0}, body = {0};
    ritz_reduced reduced[2] = {0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(ritz_scene_parse("storch.yaml", text, &scene));
    assert_ok(make_beam(elements, &beam));
    assert_ok(make_body(tip, &body));
    assert_ok(reduce_with(&beam, way->beam, way->modes, &reduced[0]));
    assert_ok(reduce_with(&body, way->body, -1, &reduced[1]));
    assert_ok(ritz_stage_from(&scene, reduced, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, out));
}

/* beta of flexible mode k, from 0. */
static double beta_of(const ritz_configuration *c, int64_t k)
{
    return pow(c->lambda[c->num_rigid + k], 0.25);
}

/*
 * Rounding of an eigenvalue, relative: eps of the largest, and operations of
 * its own. Of low ones 400 times less was measured, of high ones 5 eps.
 */
static double rounding(const ritz_configuration *c, int64_t k)
{
    return DBL_EPSILON *
           (50.0 + c->lambda[c->K.ncol - 1] / c->lambda[c->num_rigid + k]);
}

/*
 * The body moves freely where the plane beam has no dofs to hold it: along x
 * and z and about x and y.
 */
static void joint_holds_what_both_bodies_have(void **state)
{
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    join(4, &storch, &unreduced, &c);
    assert_int_equal(c.rank, 2);
    assert_int_equal(c.K.ncol, 8 + 6 - 2);
    assert_int_equal(c.num_rigid, 4);
}

static void hermite_elements_give_the_printed_table(void **state)
{
    /* oracles.md section 3; half a unit of the last digit */
    static const struct line {
        int64_t elements;
        int count;
        double beta[3], bound[3];
    } lines[] = {
        {1, 2, {1.007684, 3.62776284}, {5e-7, 5e-9}},
        {4, 3, {1.00766931, 3.46048549, 5.91673948}, {5e-9, 5e-9, 5e-9}},
        {8, 3, {1.00766921, 3.45999648, 5.91044951}, {5e-9, 5e-9, 5e-9}},
    };

    (void)state;
    for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) {
        RITZ_OWN(ritz_configuration) c = {0};

        join(lines[n].elements, &storch, &unreduced, &c);
        for (int k = 0; k < lines[n].count; k++)
            assert_near(beta_of(&c, k), lines[n].beta[k],
                        lines[n].bound[k] + lines[n].beta[k] * rounding(&c, k));
    }
}

/*
 * Hermite elements give lambda (1 + (beta h)^4 / 720) of a uniform beam, so
 * beta (1 + (beta h)^4 / 2880); a body, which is exact, can but lessen that.
 */
static void frequencies_come_down_to_the_exact_ones(void **state)
{
    static const tip_body *const tips[] = {&storch, &point_mass, &heavy};

    (void)state;
    for (int64_t elements = 8; elements <= 32; elements *= 2)
        for (int t = 0; t < 3; t++) {
            RITZ_OWN(ritz_configuration) c = {0};

            join(elements, tips[t], &unreduced, &c);
            for (int k = 0; k < tips[t]->count; k++) {
                const double beta = tips[t]->beta[k];
                const double coarse =
                    beta * pow(beta / (double)elements, 4.0) / 2880.0;
                const double slack =
                    beta * rounding(&c, k) + 5e-10 /* digits of beta */;

                assert_true(beta_of(&c, k) >= beta - slack);
                assert_true(beta_of(&c, k) <= beta + coarse + slack);
            }
        }
}

/*
 * sum beta^-4 = trace(K^-1 M) = integral of G(x, x) dm(x), G the static
 * deflection. Nodes of Hermite elements are exact, so that their G lacks but
 * what an element clamped at both ends would deflect: h^4 / 420 in each trace.
 */
static void sum_of_inverse_squares_is_the_trace(void **state)
{
    static const tip_body *const tips[] = {&storch, &point_mass, &heavy};

    (void)state;
    assert_near((4.0 * storch.m + 12.0 * (storch.J + storch.m * storch.c) + 1) /
                    12.0,
                0.978, DBL_EPSILON);
    for (int64_t elements = 1; elements <= 8; elements *= 2)
        for (int t = 0; t < 3; t++) {
            const tip_body *it = tips[t];
            const double exact =
                (12.0 * (it->J + it->m * it->c) + 4.0 * it->m + 1.0) / 12.0;
            const double missing = pow((double)elements, -3.0) / 420.0;
            RITZ_OWN(ritz_configuration) c = {0};
            double sum = 0.0;

            join(elements, it, &unreduced, &c);
            for (int64_t k = c.num_rigid; k < c.K.ncol; k++)
                sum += 1.0 / c.lambda[k];
            /* d(1/lambda) is relative to lambda as dlambda is */
            assert_near(sum + missing, exact, exact * rounding(&c, 0));
        }
}

/*
 * With A = A_h + E, E what the elements lack: trace(A^2) - trace(A_h^2) =
 * 2 trace(A E) - trace(E^2), between 0 and 2 |A| trace(E), |A| = beta_1^-4.
 */
static void sum_of_inverse_fourth_powers_converges(void **state)
{
    (void)state;
    for (int64_t elements = 2; elements <= 16; elements *= 2) {
        const double lacking = pow((double)elements, -3.0) / 420.0;
        RITZ_OWN(ritz_configuration) c = {0};
        double sum = 0.0;
        double slack = 0.0;

        join(elements, &storch, &unreduced, &c);
        for (int64_t k = c.num_rigid; k < c.K.ncol; k++)
            sum += 1.0 / (c.lambda[k] * c.lambda[k]);
        slack = 2.0 * rounding(&c, 0) + 5e-11 /* ten digits */;
        assert_true(0.9407601905 - sum >= -slack);
        assert_true(0.9407601905 - sum <=
                    2.0 * pow(storch.beta[0], -4.0) * lacking + slack);
    }
}

/* Six motions about the centre, which is c off the port, are all there is. */
static void rigid_basis_about_the_centre_loses_nothing(void **state)
{
    static const reduction rigid = {&ritz_method_full, -1, &ritz_method_rigid};
    static const tip_body *const tips[] = {&storch, &point_mass, &heavy};

    (void)state;
    for (int t = 0; t < 3; t++) {
        RITZ_OWN(ritz_configuration) one = {0}, other = {0};

        join(4, tips[t], &unreduced, &one);
        join(4, tips[t], &rigid, &other);
        assert_int_equal(one.K.ncol, other.K.ncol);
        assert_int_equal(one.num_rigid, other.num_rigid);
        for (int64_t k = 0; k < one.K.ncol - one.num_rigid; k++)
            assert_near(beta_of(&other, k), beta_of(&one, k),
                        beta_of(&one, k) * rounding(&one, k));
    }
}

static void all_modes_kept_lose_nothing(void **state)
{
    static const reduction ways[] = {
        {&ritz_method_craig_bampton, 14, &ritz_method_rigid},
        {&ritz_method_macneal_rubin, 16, &ritz_method_rigid}};
    RITZ_OWN(ritz_configuration) full = {0};

    (void)state;
    join(8, &storch, &unreduced, &full);
    for (int w = 0; w < 2; w++) {
        RITZ_OWN(ritz_configuration) c = {0};

        join(8, &storch, &ways[w], &c);
        assert_int_equal(c.K.ncol, full.K.ncol);
        for (int64_t k = 0; k < 16; k++)
            assert_near(beta_of(&c, k), beta_of(&full, k),
                        beta_of(&full, k) * rounding(&full, k));
    }
}

/* From above the mesh, not above the basis before, and as far as measured. */
static void come_down(const ritz_configuration *full,
                      const ritz_configuration *c, const double *left,
                      double before[static 3])
{
    for (int k = 0; k < 3; k++) {
        const double mesh = beta_of(full, k);
        const double slack = mesh * rounding(full, k);

        assert_true(beta_of(c, k) >= mesh - slack);
        assert_true(beta_of(c, k) <= before[k] + slack);
        if (left)
            assert_near(beta_of(c, k), mesh, 1.1 * mesh * left[k] + slack);
        before[k] = beta_of(c, k);
    }
}

/*
 * Each further mode widens the subspace, so no frequency rises; none falls
 * below that of the mesh. What four modes leave of beta_1 to beta_3, relative,
 * was measured and may grow by a tenth.
 */
static void few_modes_come_down_to_the_mesh(void **state)
{
    static const struct few {
        reduction way;
        double left[3];
    } list[] = {{{&ritz_method_craig_bampton, 0, &ritz_method_rigid},
                 {1.69e-8, 3.12e-6, 6.17e-5}},
                {{&ritz_method_macneal_rubin, 0, &ritz_method_rigid},
                 {0.0, 8.13e-9, 1.68e-6}}};
    RITZ_OWN(ritz_configuration) full = {0};

    (void)state;
    join(8, &storch, &unreduced, &full);
    for (int w = 0; w < 2; w++) {
        double before[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};

        for (int64_t modes = 1; modes <= 6; modes++) {
            reduction way = list[w].way;
            RITZ_OWN(ritz_configuration) c = {0};

            way.modes = modes;
            join(8, &storch, &way, &c);
            assert_int_equal(c.K.ncol, modes + 6);
            come_down(&full, &c, modes == 4 ? list[w].left : NULL, before);
        }
    }
}

/* Tables 2 and 3 of the paper: beta_1 squared, c = 0; four digits. */
static void tables_of_the_paper_are_met(void **state)
{
    static const double table[][3] = {
        /* m, J, beta^2 */
        {5.0, 0.0, 0.7569},  {10.0, 0.0, 0.5414}, {15.0, 0.0, 0.4437},
        {20.0, 0.0, 0.3850}, {1.0, 1.0, 0.8679},  {1.3, 1.0, 0.8406},
        {1.5, 1.0, 0.8236},  {1.8, 1.0, 0.7995},  {2.0, 1.0, 0.7845},
    };

    (void)state;
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        const tip_body tip = {.m = table[k][0], .J = table[k][1]};
        RITZ_OWN(ritz_configuration) c = {0};

        /* four elements are 1e-6 off */
        join(4, &tip, &unreduced, &c);
        assert_near(sqrt(c.lambda[c.num_rigid]), table[k][2], 5e-5 + 1e-6);
    }
}

/* 1.875104069 without a tip body; eight elements add (beta h)^4 / 1440. */
static void beam_alone_is_the_cantilever(void **state)
{
    const double beta = 1.875104069;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    assert_ok(make_beam(8, &beam));
    assert_ok(reduce_with(&beam, &ritz_method_macneal_rubin, 1, &reduced));
    assert_near(reduced.columns.hertz[0] * 8.0 * atan(1.0), beta * beta,
                beta * beta * pow(beta / 8.0, 4.0) / 1440.0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(joint_holds_what_both_bodies_have),
    cmocka_unit_test(hermite_elements_give_the_printed_table),
    cmocka_unit_test(frequencies_come_down_to_the_exact_ones),
    cmocka_unit_test(sum_of_inverse_squares_is_the_trace),
    cmocka_unit_test(sum_of_inverse_fourth_powers_converges),
    cmocka_unit_test(rigid_basis_about_the_centre_loses_nothing),
    cmocka_unit_test(all_modes_kept_lose_nothing),
    cmocka_unit_test(few_modes_come_down_to_the_mesh),
    cmocka_unit_test(tables_of_the_paper_are_met),
    cmocka_unit_test(beam_alone_is_the_cantilever),
};

TEST_MODULE(storch, tests, NULL, NULL)
