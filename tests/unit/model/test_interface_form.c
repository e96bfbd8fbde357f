/* Reduced components whose first coordinates are the motions of ports. */
#include "model/interface_form.h"
#include "testing.h"

#include "bodies.h"

#include <ritz/basis.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRIDS = 4, MODES = 5, DOFS = 6 * GRIDS };

static int set_up(void **state)
{
    static const double at[GRIDS][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};
    static ritz_component body;

    *state = &body;
    return body_chain(GRIDS, at, 21, 9, &body) == RITZ_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    ritz_component_free(*state);
    return 0;
}

static ritz_status attach(const ritz_component *body, const char *ports,
                          const ritz_method *method, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_status status = RITZ_OK;

    request.component = body;
    request.modes = method == &ritz_method_full ? -1 : MODES;
    if (method != &ritz_method_full)
        RITZ_CHECK(ritz_component_attached(body, ports, &request.attached));
    status = ritz_basis_make(method, &request, &basis);
    ritz_dofs_free(&request.attached);
    RITZ_CHECK(status);
    return ritz_reduce(body, &basis, out);
}

/* Largest difference between A and the leading block of B. */
static double difference(const ritz_dense *A, const ritz_dense *B)
{
    double most = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            most = fmax(
                most, fabs(ritz_dense_col(A, j)[i] - ritz_dense_col(B, j)[i]));
    return most;
}

static void constraint_modes_are_kept_bit_for_bit(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_interface_form) form = {0};

    assert_ok(attach(*state, "g4", &ritz_method_craig_bampton, &reduced));
    assert_ok(ritz_interface_form_of(&reduced, NULL, &form));
    assert_true(form.kept);
    assert_int_equal(form.count, 1);
    assert_int_equal(form.grid[0], 24);
    assert_string_equal(form.port[0], "g4");
    assert_near(form.position[0], 2.0, 0.0);
    assert_near(difference(&form.K, &reduced.K), 0.0, 0.0);
    assert_near(difference(&form.M, &reduced.M), 0.0, 0.0);
    assert_null(form.D.val);
}

/*
 * All dofs as columns hold what Craig-Bampton makes of them: K_x is the static
 * condensation, and the modes are those with the interface held. Errors of both
 * are eps times the condition of the held body, 1e4, and as much again of the
 * frequencies' spread.
 */
static void the_full_space_gives_craig_bampton(void **state)
{
    RITZ_OWN(ritz_reduced) full = {0}, fixed = {0};
    RITZ_OWN(ritz_interface_form) form = {0}, known = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};

    assert_ok(attach(*state, "g1,g4", &ritz_method_craig_bampton, &fixed));
    assert_ok(ritz_interface_form_of(&fixed, NULL, &known));
    assert_ok(attach(*state, NULL, &ritz_method_full, &full));
    assert_ok(ritz_interface_form_of(&full, "g1,g4", &form));
    assert_false(form.kept);
    assert_int_equal(form.count, 2);
    assert_int_equal(form.K.ncol, DOFS);
    assert_ok(ritz_dense_block(&known.K, 0, 12, 0, 12, &K));
    assert_ok(ritz_dense_block(&known.M, 0, 12, 0, 12, &M));
    assert_near(difference(&K, &form.K), 0.0, 1e-11 * ritz_dense_max(&K));
    assert_near(difference(&M, &form.M), 0.0, 1e-11 * ritz_dense_max(&M));
    for (int64_t k = 0; fixed.columns.hertz && k < MODES; k++)
        assert_near(form.hertz[k], fixed.columns.hertz[12 + k],
                    1e-11 * form.hertz[k]);
}

/* Check the blocks of V'K V and V'M V that docs/methods/interfaces.md
   states. */
static void assert_blocks(const ritz_interface_form *form, int64_t motions)
{
    const double most = ritz_dense_max(&form->K);

    for (int64_t j = motions; j < form->K.ncol; j++)
        for (int64_t i = 0; i < form->K.nrow; i++) {
            const double lambda =
                i == j ? ritz_eigen_lambda(form->hertz[j - motions]) : 0.0;

            assert_near(ritz_dense_col(&form->K, j)[i], lambda, 1e-11 * most);
            if (i >= motions)
                assert_near(ritz_dense_col(&form->M, j)[i], i == j ? 1.0 : 0.0,
                            1e-11);
        }
}

/* The coordinates x are the motions of the port, frequencies do not change,
   and rigid motions have no stiffness. */
static void a_free_basis_takes_the_form(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_interface_form) form = {0};
    RITZ_OWN(ritz_dense) x = {0};
    RITZ_OWN(ritz_pairs) before = {0}, after = {0};
    ritz_interface_ground ground = {.rigid_hz = 1.0};

    assert_ok(attach(*state, "g4", &ritz_method_macneal_rubin, &reduced));
    assert_ok(ritz_interface_form_of(&reduced, "g4", &form));
    assert_false(form.kept);
    assert_ok(ritz_dense_mul(&reduced.port[3].map, &form.V, &x));
    for (int64_t j = 0; j < x.ncol; j++)
        for (int64_t i = 0; i < 6; i++)
            assert_near(ritz_dense_col(&x, j)[i], i == j ? 1.0 : 0.0, 1e-11);
    assert_blocks(&form, 6);
    assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &before));
    assert_ok(ritz_eigen_dense(&form.K, &form.M, &after));
    assert_int_equal(before.num_rigid, 6);
    assert_int_equal(after.num_rigid, 6);
    for (int64_t k = 6; k < form.K.ncol; k++)
        assert_near(after.lambda[k], before.lambda[k],
                    1e-10 * before.lambda[form.K.ncol - 1]);
    /* the stiffness of rigid motion is eps of the largest lambda, measured */
    assert_ok(ritz_interface_form_ground(&form, &ground));
    assert_near(ground.flexible_hz, ritz_eigen_hertz(before.lambda[6]),
                1e-9 * ground.flexible_hz);
    assert_false(ground.holds);
    assert_true(ground.rigid_hz <= 1e-6 * ground.flexible_hz);
}

/* Columns of a Rubin basis move the attached dofs: they are no modes of the
   held body. The stiffness of rigid motion is eps of the largest lambda. */
static void columns_that_move_the_interface_become_modes(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_interface_form) form = {0};
    ritz_interface_ground ground = {.rigid_hz = 1.0};

    assert_ok(attach(*state, "g1,g4", &ritz_method_rubin, &reduced));
    assert_ok(ritz_interface_form_of(&reduced, NULL, &form));
    assert_false(form.kept);
    assert_blocks(&form, 12);
    assert_ok(ritz_interface_form_ground(&form, &ground));
    assert_true(ground.rigid_hz <= 1e-6 * ground.flexible_hz);
}

/* Krylov vectors of krylov-cms-free leave the attached dofs at rest but for
   rounding, which says nothing about their size. The frequencies stay. */
static void columns_at_rest_at_the_interface_are_scaled_by_mass(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_interface_form) form = {0};
    RITZ_OWN(ritz_pairs) before = {0}, after = {0};
    double rest = 1.0;

    assert_ok(attach(*state, "g4", &ritz_method_krylov_cms_free, &reduced));
    for (int64_t j = 0; j < reduced.K.ncol; j++)
        rest = fmin(rest, ritz_dense_col_max(&reduced.port[3].map, j) /
                              sqrt(ritz_dense_col(&reduced.M, j)[j]));
    assert_true(rest < 1e-12);
    assert_ok(ritz_interface_form_of(&reduced, "g4", &form));
    assert_blocks(&form, 6);
    assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &before));
    assert_ok(ritz_eigen_dense(&form.K, &form.M, &after));
    for (int64_t k = 6; k < form.K.ncol; k++)
        assert_near(after.lambda[k], before.lambda[k],
                    1e-10 * before.lambda[form.K.ncol - 1]);
}

/* Springs to the ground that are as stiff as the body: its diagonal doubles. */
static void a_held_body_is_recognised(void **state)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_interface_form) form = {0};
    ritz_interface_ground ground = {0};

    assert_ok(attach(*state, "g1,g4", &ritz_method_craig_bampton, &reduced));
    for (int64_t i = 0; i < 6; i++)
        ritz_dense_col(&reduced.K, i)[i] *= 2.0;
    assert_ok(ritz_interface_form_of(&reduced, NULL, &form));
    assert_ok(ritz_interface_form_ground(&form, &ground));
    assert_true(ground.holds);
}

static void assert_refused(const ritz_reduced *reduced, const char *ports,
                           const char *words)
{
    RITZ_OWN(ritz_interface_form) form = {0};

    assert_fails(ritz_interface_form_of(reduced, ports, &form),
                 RITZ_ERR_ARGUMENT, words);
    assert_null(form.V.val);
}

static void what_cannot_be_an_interface_is_refused(void **state)
{
    RITZ_OWN(ritz_reduced) fixed = {0}, free_free = {0};
    int64_t ports = 0;

    assert_ok(attach(*state, "g4", &ritz_method_craig_bampton, &fixed));
    assert_refused(&fixed, "g5", "there is no port 'g5'");
    assert_refused(&fixed, "g1,g2,g3",
                   "11 coordinates cannot hold the six "
                   "motions of 3 grids");
    assert_ok(attach(*state, "g4", &ritz_method_macneal_rubin, &free_free));
    if (!free_free.port)
        return;
    memcpy(free_free.port[0].map.val, free_free.port[3].map.val,
           sizeof(double) * (size_t)(6 * free_free.K.ncol));
    assert_refused(&free_free, "g1,g4", "depend on each other");
    free_free.port[3].count = 5;
    assert_refused(&free_free, "g4",
                   "grid 24 of port 'g4' does not have all "
                   "six motions");
    ports = fixed.num_ports;
    fixed.num_ports = 0;
    assert_refused(&fixed, NULL, "import with --port");
    fixed.num_ports = ports;
}

/* Grid 4 has no springs and is free while grid 1 is held. */
static void a_mechanism_with_the_interface_held_has_no_stiffness(void **state)
{
    RITZ_OWN(ritz_reduced) full = {0};
    RITZ_OWN(ritz_interface_form) form = {0};

    assert_ok(attach(*state, NULL, &ritz_method_full, &full));
    for (int64_t j = 0; j < DOFS; j++)
        for (int64_t i = 0; i < DOFS; i++)
            if (i >= DOFS - 6 || j >= DOFS - 6)
                ritz_dense_col(&full.K, j)[i] = 0.0;
    assert_ok(ritz_interface_form_of(&full, "g1", &form));
    assert_int_equal(form.num_loose, 6);
    assert_true(form.hertz && form.hertz[5] == 0.0 && form.hertz[6] > 0.0);
    assert_blocks(&form, 6);
}

/* The mass matrix of the rigid motions of the frames. */
static double mass_of(const ritz_reduced *reduced)
{
    RITZ_OWN(ritz_interface_form) form = {0};
    double mass = -1.0;

    if (ritz_interface_form_of(reduced, "g1", &form) == RITZ_OK) {
        assert_int_equal(form.num_loose, DOFS - 6);
        mass = ritz_dense_col(&form.M, 0)[0];
    }
    return mass;
}

/* Without stiffness every part of the body follows the interface, as a part
   on a free hinge does: the mass at the interface is that of the body, whether
   it is found from the momentum or, without invariants, from the motions of
   ports. */
static void parts_without_stiffness_follow_the_interface(void **state)
{
    RITZ_OWN(ritz_reduced) full = {0};
    RITZ_OWN(ritz_invariants) none = {0};

    assert_ok(attach(*state, NULL, &ritz_method_full, &full));
    if (!full.K.val)
        return;
    memset(full.K.val, 0, (size_t)(DOFS * DOFS) * sizeof *full.K.val);
    assert_non_null(full.invariants.momentum.val);
    assert_near(mass_of(&full), full.inertia.mass, 1e-11 * full.inertia.mass);
    RITZ_MOVE(none, full.invariants);
    assert_near(mass_of(&full), full.inertia.mass, 1e-11 * full.inertia.mass);
}

static ritz_status form_once(const ritz_reduced *reduced, const char *ports)
{
    RITZ_OWN(ritz_interface_form) form = {0};
    ritz_interface_ground ground = {0};

    RITZ_CHECK(ritz_interface_form_of(reduced, ports, &form));
    return ritz_interface_form_ground(&form, &ground);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_reduced) fixed = {0}, full = {0}, loose = {0};

    assert_ok(attach(*state, "g4", &ritz_method_craig_bampton, &fixed));
    assert_ok(attach(*state, NULL, &ritz_method_full, &full));
    assert_ok(attach(*state, NULL, &ritz_method_full, &loose));
    if (!loose.K.val)
        return;
    memset(loose.K.val, 0, (size_t)(DOFS * DOFS) * sizeof *loose.K.val);
    ritz_invariants_free(&loose.invariants);
    snprintf(full.damping, sizeof full.damping, "modal 0.01");
    assert_survives_every_allocation(form_once(&fixed, NULL));
    assert_survives_every_allocation(form_once(&full, "g1,g4"));
    assert_survives_every_allocation(form_once(&loose, "g1"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(constraint_modes_are_kept_bit_for_bit),
    cmocka_unit_test(the_full_space_gives_craig_bampton),
    cmocka_unit_test(a_free_basis_takes_the_form),
    cmocka_unit_test(columns_that_move_the_interface_become_modes),
    cmocka_unit_test(columns_at_rest_at_the_interface_are_scaled_by_mass),
    cmocka_unit_test(a_held_body_is_recognised),
    cmocka_unit_test(what_cannot_be_an_interface_is_refused),
    cmocka_unit_test(a_mechanism_with_the_interface_held_has_no_stiffness),
    cmocka_unit_test(parts_without_stiffness_follow_the_interface),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(interface_form, tests, set_up, tear_down)
