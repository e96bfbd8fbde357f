/*
 * Dual Craig-Bampton [Rixen2004]: bodies joined by interface forces. Systems of
 * the two halves of the beam of [McDaniel2000, chapter 3] are held to SciPy.
 */
#include "responses.h"
#include "testing.h"

#include "frame.h"
#include "scenes.h"
#include "spring_chain.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/response.h>

#include <float.h>
#include <stdlib.h>

/*
 * Rounding of the system: cond(K) of the 12-dof beam is 4e4 and of its scaled
 * mass below 1e3, eps times both; as in test_synthesis.c.
 */
static const double system_error = 1e-8;

/* Bodies of two_beams, each by a method and with some modes. */
typedef struct halves {
    const ritz_method *method[2];
    int64_t modes[2];
    bool free_left; /* node 0 is not clamped */
} halves;

static ritz_status make_stage(const halves *of, const ritz_scene *scene,
                              ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    ritz_component half = {0};
    ritz_reduced body[2] = {0};

    for (int k = 0; k < 2; k++) {
        frame_section section = frame_mcdaniel;

        section.offset = (double)k;
        RITZ_TRY(frame_component(2, 0.5, &section, k == 0 && !of->free_left,
                                 false, 2 * k, &half));
        RITZ_TRY(add_port(&half, "middle", 2));
        RITZ_TRY(reduce_with(&half, of->method[k], of->modes[k], &body[k]));
        ritz_component_free(&half);
    }
    RITZ_TRY(ritz_stage_from(scene, body, out));
done:
    ritz_component_free(&half);
    for (int k = 0; k < 2; k++)
        ritz_reduced_free(&body[k]);
    return status;
}

static void assemble(const halves *of, ritz_configuration *c)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(scene_of_two_beams(false, &scene));
    assert_ok(make_stage(of, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, c));
}

/* A body alone is what macneal-rubin makes of it, but for the kind. */
static void a_body_alone_is_that_of_macneal_rubin(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    int64_t ends[] = {0, 9};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) one = {0}, two = {0};

    (void)state;
    assert_ok(spring_chain(10, true, &chain));
    request.component = &chain;
    request.attached = (ritz_dofs){2, ends};
    request.modes = 3;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &one));
    assert_ok(ritz_basis_make(&ritz_method_dual_craig_bampton, &request, &two));
    assert_int_equal(two.T.ncol, 1 + 3 + 2);
    assert_memory_equal(one.T.val, two.T.val, 60 * sizeof *one.T.val);
    for (int64_t j = 0; j < 6; j++)
        assert_int_equal(two.columns.kind[j], j < 1   ? RITZ_COLUMN_RIGID
                                              : j < 4 ? RITZ_COLUMN_NORMAL
                                                      : RITZ_COLUMN_FORCE);
    assert_int_equal(two.columns.dof[5], 9);
    assert_string_equal(two.origin.reference, "Rixen2004");
}

/* Two bodies, which are taken, fixed to each other at their ports 'end'. */
static void join_ends(ritz_reduced body[2], ritz_configuration *c)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    assert_ok(ritz_scene_parse(
        "two.yaml",
        "scene: two masses\n"
        "components:\n"
        "  A: {model: a.h5, basis: full}\n"
        "  B: {model: b.h5, basis: full}\n"
        "joints:\n"
        "  - {name: middle, between: [A/end, B/end], type: fixed}\n",
        &scene));
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, c));
}

/*
 * Two masses of 1 on springs of 1000, no mode kept: of each there is 1/k, and
 * K = -2/k, M = 2 m/k^2 of the force between them: lambda = -k/m, where the
 * joined masses have +k/m.
 */
static void a_force_alone_has_a_negative_eigenvalue(void **state)
{
    ritz_reduced body[2] = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) mass = {0};

        assert_ok(spring_chain(1, false, &mass));
        assert_ok(add_port(&mass, "end", 1));
        assert_ok(
            reduce_with(&mass, &ritz_method_dual_craig_bampton, 0, &body[k]));
        assert_int_equal(body[k].K.ncol, 1);
    }
    join_ends(body, &c);
    assert_int_equal(c.K.ncol, 1);
    assert_int_equal(c.rank, 1);
    assert_int_equal(c.num_rigid, 0);
    assert_near(c.lambda[0], -1000.0, 1000.0 * 16 * DBL_EPSILON);
    assert_int_equal(c.errors.count, 1);
    assert_string_equal(c.errors.item[0].name, "negative-eigenvalues");
    assert_near(c.errors.item[0].value, 1.0, 0.0);
    assert_near(c.errors.item[0].limit, 0.0, 0.0);
    assert_string_equal(c.errors.item[0].where, "first: mode 1, -5.033 Hz");
}

/*
 * Systems by SciPy from the matrices in the head of dual_forces.c, Hz, in order
 * of size; nine decimals of which the last is rounded.
 */
static const struct published {
    const char *what;
    halves of;
    int64_t rigid, count, negative;
    double hertz[15];
} systems[] = {
    {"clamped and free, 3 modes each",
     {{&ritz_method_dual_craig_bampton, &ritz_method_dual_craig_bampton},
      {3, 3},
      false},
     0,
     12,
     3,
     {0.015610247, 0.097938654, 0.276035534, 0.487247853, 0.545385061,
      1.058501695, 1.540569689, -1.916753695, 2.021719793, 3.108829366,
      -3.878433154, -4.486894614}},
    {"a full body beside one of 3 modes",
     {{&ritz_method_full, &ritz_method_dual_craig_bampton}, {-1, 3}, false},
     0,
     15,
     3,
     {0.015610247, 0.097938538, 0.276032316, 0.487240688, 0.544575411,
      1.012932866, 1.537573129, 1.637073207, 2.746877962, 2.807386261,
      -3.940126748, 5.629942131, -6.544505413, 19.376186276, -19.682072643}},
    {"both free, 2 modes each",
     {{&ritz_method_dual_craig_bampton, &ritz_method_dual_craig_bampton},
      {2, 2},
      true},
     3,
     13,
     3,
     {0.0, 0.0, 0.0, 0.099436669, 0.275508249, 0.541056035, 0.991536361,
      1.010630440, 1.564963819, -2.526942134, 2.720393716, -3.681697396,
      -4.287360522}},
};

static void systems_are_those_of_the_formula(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof systems / sizeof *systems; n++) {
        const struct published *s = &systems[n];
        RITZ_OWN(ritz_configuration) c = {0};

        print_message("%s\n", s->what);
        assemble(&s->of, &c);
        assert_int_equal(c.K.ncol, s->count);
        assert_int_equal(c.num_rigid, s->rigid);
        assert_int_equal(c.rank, 3);
        for (int64_t k = s->rigid; k < s->count; k++)
            assert_near(ritz_eigen_hertz(c.lambda[k]), s->hertz[k],
                        5e-10 + system_error * fabs(s->hertz[k]));
        assert_near(c.errors.item[0].value, (double)s->negative, 0.0);
    }
}

/*
 * Sylvester: the -I of the forces makes as many negative eigenvalues as there
 * are forces, and no more, for Lambda + C_1q' C_1q is never negative.
 */
static void there_are_as_many_negative_eigenvalues_as_forces(void **state)
{
    (void)state;
    for (int64_t modes = 0; modes < 5; modes++) {
        const halves of = {
            {&ritz_method_dual_craig_bampton, &ritz_method_dual_craig_bampton},
            {modes, modes},
            modes % 2 == 1};
        RITZ_OWN(ritz_configuration) c = {0};

        assemble(&of, &c);
        assert_near(c.errors.item[0].value, 3.0, 0.0);
        for (int64_t k = 1; k < c.K.ncol; k++)
            assert_true(fabs(c.lambda[k - 1]) <=
                            fabs(c.lambda[k]) * (1.0 + DBL_EPSILON) ||
                        k < c.num_rigid);
    }
}

/* With all modes kept there is no force column, and the joint is the usual. */
static void without_force_columns_joints_are_displacements(void **state)
{
    const halves of = {
        {&ritz_method_dual_craig_bampton, &ritz_method_dual_craig_bampton},
        {9, 9},
        false};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    assemble(&of, &c);
    assert_int_equal(c.K.ncol, 12);
    assert_int_equal(c.errors.count, 0);
    assert_near(ritz_eigen_hertz(c.lambda[11]), 4.231174895,
                5e-10 + system_error * 4.2);
}

/*
 * A force on a massless dof has no mass: condensed, it is a spring of 1/F. Mass
 * 1 on k = 3, and a dof without mass beyond 2 that is joined to the same of a
 * twin: with all modes kept a spring of 2/2 lies between the masses, so that
 * lambda = 3 and 3 + 2.
 */
static void forces_without_mass_are_springs(void **state)
{
    static const int64_t row[] = {0, 1, 0, 1}, col[] = {0, 0, 1, 1};
    static const double k[] = {5.0, -2.0, -2.0, 2.0};
    ritz_reduced body[2] = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    for (int n = 0; n < 2; n++) {
        RITZ_OWN(ritz_component) two = {0};
        int64_t zero = 0;

        assert_ok(spring_chain(2, false, &two));
        ritz_sparse_free(&two.K);
        ritz_sparse_free(&two.M);
        assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, k, &two.K));
        assert_ok(ritz_sparse_from_triplets(2, 2, 1, &zero, &zero,
                                            &(double){1.0}, &two.M));
        assert_ok(add_port(&two, "end", 2));
        assert_ok(
            reduce_with(&two, &ritz_method_dual_craig_bampton, 1, &body[n]));
        assert_int_equal(body[n].K.ncol, 2);
    }
    join_ends(body, &c);
    assert_int_equal(c.K.ncol, 2);
    assert_near(c.errors.item[0].value, 0.0, 0.0);
    assert_near(c.lambda[0], 3.0, 64 * DBL_EPSILON);
    assert_near(c.lambda[1], 5.0, 64 * DBL_EPSILON);
}

/* u = P x fits at the joint only weakly, and in the low modes nearly. */
static void the_joint_of_low_modes_nearly_closes(void **state)
{
    const halves of = systems[0].of;
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    assert_ok(scene_of_two_beams(false, &scene));
    assert_ok(make_stage(&of, &scene, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    for (int64_t k = 0; k < 2; k++) {
        ritz_dense u[2] = {{0}};

        for (int b = 0; b < 2; b++) {
            const ritz_port_map *port =
                ritz_reduced_port(&stage.body[b], "middle");

            assert_ok(ritz_dense_mul(&port->map, &c.P[b], &u[b]));
        }
        for (int64_t i = 0; i < 3; i++) {
            double left = ritz_dense_col(&u[0], k)[i];
            double right = ritz_dense_col(&u[1], k)[i];

            /* measured 2.4e-6 in the first mode, 1.1e-3 in the second */
            assert_near(left, right, k == 0 ? 5e-6 : 2e-3);
        }
        ritz_dense_free(&u[0]);
        ritz_dense_free(&u[1]);
    }
}

static void modes_of_such_a_system_are_not_chosen_from(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_comparison none = {0};

    (void)state;
    assert_ok(scene_of_two_beams(false, &scene));
    assert_ok(make_stage(&systems[0].of, &scene, &stage));
    assert_fails(ritz_compare(&stage, &none), RITZ_ERR_ARGUMENT,
                 "component 'A' is reduced by dual-craig-bampton");
}

static void an_unstable_model_has_no_response(void **state)
{
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    const ritz_grid grid = {.from_hz = 0.01, .to_hz = 1.0, .count = 5};
    RITZ_OWN(ritz_configuration) c = {0};
    ritz_response none = {0};
    RITZ_OWN(ritz_io) io = {0};

    (void)state;
    assemble(&systems[0].of, &c);
    assert_ok(ritz_io_new(c.K.ncol, 1, 1, &io));
    assert_fails(dense_response(&c.K, &c.M, NULL, &io, &damping, &grid, &none),
                 RITZ_ERR_ARGUMENT, "negative eigenvalue");
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    assert_ok(scene_of_two_beams(false, &scene));
    assert_ok(make_stage(&systems[1].of, &scene, &stage));
    assert_survives_every_allocation(ritz_stage_assemble(&stage, NULL, &c));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_body_alone_is_that_of_macneal_rubin),
    cmocka_unit_test(a_force_alone_has_a_negative_eigenvalue),
    cmocka_unit_test(systems_are_those_of_the_formula),
    cmocka_unit_test(there_are_as_many_negative_eigenvalues_as_forces),
    cmocka_unit_test(without_force_columns_joints_are_displacements),
    cmocka_unit_test(forces_without_mass_are_springs),
    cmocka_unit_test(the_joint_of_low_modes_nearly_closes),
    cmocka_unit_test(modes_of_such_a_system_are_not_chosen_from),
    cmocka_unit_test(an_unstable_model_has_no_response),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(dual, tests, NULL, NULL)
