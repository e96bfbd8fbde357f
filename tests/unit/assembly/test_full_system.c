/*
 * The full-order system of beams, whose pieces must make up the whole again:
 * oracles.md section 1 [McDaniel2000].
 */
#include "testing.h"

#include "folder.h"
#include "frame.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/container.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static void assemble(const char *text, const double *setting,
                     ritz_component *out)
{
    RITZ_OWN(ritz_scene) scene = {0};

    folder_parse(text, &scene);
    assert_ok(ritz_assemble_full(&scene, setting, out, NULL));
}

/* Elements first..first + count - 1 of the beam of four; a port a node. */
static void store_piece(const char *file, int64_t first, int64_t count)
{
    frame_section section = frame_mcdaniel;
    RITZ_OWN(ritz_component) piece = {0};

    section.offset = 0.5 * (double)first;
    assert_ok(frame_component(count, 0.5, &section, first == 0, false, first,
                              &piece));
    for (int64_t node = first; node <= first + count; node++) {
        char name[16];

        snprintf(name, sizeof name, "node%d", (int)node);
        if (node > 0)
            assert_ok(add_port(&piece, name, node));
    }
    folder_store(file, &piece);
}

/* table 3.1; half a unit of the last digit */
static void assert_cantilever(const ritz_component *system)
{
    static const double hertz[] = {0.015610, 0.097939, 0.276032, 0.487239,
                                   0.544552, 1.012841, 1.537065, 1.626627,
                                   2.578744, 2.792127, 4.037661, 4.231175};
    const ritz_span all = {.modes = 12};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_int_equal(system->num_dofs, 12);
    assert_ok(ritz_eigen_sparse(&system->K, &system->M, &all, &pairs));
    assert_int_equal(pairs.Phi.ncol, 12);
    for (int k = 0; k < 12; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[k]), hertz[k], 5e-7);
}

static void three_pieces_make_the_cantilever(void **state)
{
    RITZ_OWN(ritz_component) system = {0};

    (void)state;
    store_piece("a.h5", 0, 1);
    store_piece("b.h5", 1, 2);
    store_piece("c.h5", 3, 1);
    assemble("scene: chain\n"
             "components: {A: {model: a.h5, basis: full},"
             " B: {model: b.h5, basis: full}, C: {model: c.h5, basis: full}}\n"
             "joints:\n"
             "  - {name: one, between: [A/node1, B/node1], type: fixed}\n"
             "  - {name: two, between: [C/node3, B/node3], type: fixed}\n",
             NULL, &system);
    assert_cantilever(&system);
}

/* Grid 77 of a piece, twice the first dof and thrice the last. */
static ritz_status add_recovered(ritz_component *piece)
{
    static const int64_t row[] = {0, 0};
    static const double val[] = {2.0, 3.0};
    const int64_t col[] = {0, piece->num_dofs - 1};
    ritz_status status = RITZ_OK;

    RITZ_NEW(piece->recovery.dof, 1);
    piece->recovery.dof[0] = (ritz_dof){77, 2};
    piece->recovery.count = 1;
    RITZ_TRY(ritz_sparse_from_triplets(1, piece->num_dofs, 2, row, col, val,
                                       &piece->recovery.G));
done:
    return status;
}

/* Of each body, by the dofs that its own have become in the system. */
static void what_bodies_recover_the_system_recovers(void **state)
{
    RITZ_OWN(ritz_component) system = {0};
    ritz_component piece = {0};

    (void)state;
    for (int k = 0; k < 2; k++) {
        assert_ok(
            frame_component(1, 0.5, &frame_mcdaniel, false, false, 5, &piece));
        assert_ok(add_port(&piece, "node5", 5));
        assert_ok(add_port(&piece, "node6", 6));
        assert_ok(add_recovered(&piece));
        folder_store(k == 0 ? "a.h5" : "b.h5", &piece);
        ritz_component_free(&piece);
    }
    assemble("scene: pair\n"
             "components: {A: {model: a.h5, basis: full},"
             " B: {model: b.h5, basis: full}}\n"
             "joints:\n"
             "  - {name: one, between: [A/node6, B/node5], type: fixed}\n",
             NULL, &system);
    assert_int_equal(system.num_dofs, 9);
    assert_int_equal(system.recovery.count, 2);
    assert_int_equal(system.recovery.dof[0].grid, 77);
    assert_int_equal(system.recovery.dof[1].grid, 177); /* B's are moved on */
    for (int64_t k = 0; k < 2; k++) {
        RITZ_OWN(ritz_dense) row = {0}, e = {0};
        int64_t first = k == 0 ? row_of_dof(&system, (ritz_dof){5, 1})
                               : row_of_dof(&system, (ritz_dof){105, 1});
        int64_t shared = row_of_dof(&system, (ritz_dof){6, 1});
        int64_t last = k == 0 ? row_of_dof(&system, (ritz_dof){6, 6})
                              : row_of_dof(&system, (ritz_dof){106, 6});

        if (first < 0) /* one of the two that are joined has the row */
            first = shared;
        if (last < 0)
            last = row_of_dof(&system, (ritz_dof){105, 6});
        assert_ok(ritz_dense_new(9, 1, &e));
        e.val[first] = 10.0;
        e.val[last] = 1.0;
        assert_ok(ritz_sparse_mul(&system.recovery.G, &e, &row));
        assert_near(row.val[k], 23.0, 0.0);
    }
}

/* The rank of the constraints counts, not their number. */
static void a_joint_stated_twice_binds_once(void **state)
{
    RITZ_OWN(ritz_component) system = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    assemble("scene: twice\n"
             "components: {A: {model: a.h5, basis: full},"
             " B: {model: b.h5, basis: full}}\n"
             "joints:\n"
             "  - {name: one, between: [A/node2, B/node2], type: fixed}\n"
             "  - {name: two, between: [B/node2, A/node2], type: fixed}\n",
             NULL, &system);
    assert_cantilever(&system);
}

/*
 * B and C both go on where A ends, and all three are joined with each other
 * there: what the third joint states the first two have stated.
 */
static void a_loop_of_joints_closes(void **state)
{
    static const char loop[] =
        "scene: loop\n"
        "components: {A: {model: a.h5, basis: full},"
        " B: {model: b.h5, basis: full}, C: {model: c.h5, basis: full}}\n"
        "joints:\n"
        "  - {name: one, between: [A/node2, B/node2], type: fixed}\n"
        "  - {name: two, between: [B/node2, C/node2], type: fixed}\n";
    static const char third[] =
        "  - {name: three, between: [C/node2, A/node2], type: fixed}\n";
    const ritz_span all = {.modes = 18};
    char closed[1024];
    RITZ_OWN(ritz_component) open = {0}, round = {0};
    RITZ_OWN(ritz_pairs) one = {0}, two = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    store_piece("c.h5", 2, 2);
    snprintf(closed, sizeof closed, "%s%s", loop, third);
    assemble(loop, NULL, &open);
    assemble(closed, NULL, &round);
    assert_int_equal(open.num_dofs, 6 + 9 + 9 - 6);
    assert_int_equal(round.num_dofs, 6 + 9 + 9 - 6);
    assert_ok(ritz_eigen_sparse(&open.K, &open.M, &all, &one));
    assert_ok(ritz_eigen_sparse(&round.K, &round.M, &all, &two));
    for (int64_t k = 0; k < 18; k++)
        assert_near(two.lambda[k], one.lambda[k],
                    DBL_EPSILON * (one.lambda[17] + 50.0 * one.lambda[k]));
}

/* A port of all four free grids, the last one first if `turned`. */
static void store_whole(const char *file, bool turned, int64_t first_grid)
{
    RITZ_OWN(ritz_component) beam = {0};
    ritz_port *port = NULL;

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, false, first_grid,
                              &beam));
    port = calloc(1, sizeof *port);
    assert_non_null(port);
    beam.port = port;
    beam.num_ports = 1;
    snprintf(port->name, sizeof port->name, "all");
    port->dofs.at = calloc(12, sizeof *port->dofs.at);
    assert_non_null(port->dofs.at);
    port->dofs.count = 12;
    for (int64_t i = 0; i < 12; i++)
        port->dofs.at[i] = turned ? 3 * (3 - i / 3) + i % 3 : i;
    port->origin[0] = 0.25 * (0.5 + 1.0 + 1.5 + 2.0);
    for (int64_t k = 0; k < 3; k++)
        port->axes[4 * k] = 1.0;
    folder_store(file, &beam);
}

/* Twice as stiff, twice as heavy: a beam laid on itself moves as one. */
static void four_grids_pair_by_position(void **state)
{
    RITZ_OWN(ritz_component) system = {0};

    (void)state;
    store_whole("a.h5", false, 0);
    store_whole("b.h5", true, 70);
    assemble("scene: double\n"
             "components: {A: {model: a.h5, basis: full},"
             " B: {model: b.h5, basis: full}}\n"
             "joints:\n"
             "  - {name: all, between: [A/all, B/all], type: fixed}\n",
             NULL, &system);
    assert_cantilever(&system);
}

static const char halves[] =
    "scene: halves\n"
    "components: {A: {model: a.h5, basis: full},"
    " B: {model: b.h5, basis: full}}\n"
    "joints:\n"
    "  - {name: one, between: [A/node2, B/node2], type: fixed}\n";

static void a_reduced_model_is_refused(void **state)
{
    const ritz_stamp stamp = {.command = "test"};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_component) body = {0};
    ritz_component none = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    assert_ok(ritz_container_read_component(folder_path("b.h5"), &body));
    assert_ok(reduce_with(&body, &ritz_method_guyan, -1, &reduced));
    assert_ok(
        ritz_container_write_reduced(folder_path("b.h5"), &reduced, &stamp));
    folder_parse(halves, &scene);
    assert_fails(ritz_assemble_full(&scene, NULL, &none, NULL),
                 RITZ_ERR_ARGUMENT,
                 "b.h5' is reduced already, its full model is wanted");
}

static ritz_status assemble_and_free(const ritz_scene *scene)
{
    RITZ_OWN(ritz_component) system = {0};

    return ritz_assemble_full(scene, NULL, &system, NULL);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    folder_parse(halves, &scene);
    assert_survives_every_allocation(assemble_and_free(&scene));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(three_pieces_make_the_cantilever),
    cmocka_unit_test(what_bodies_recover_the_system_recovers),
    cmocka_unit_test(a_joint_stated_twice_binds_once),
    cmocka_unit_test(a_loop_of_joints_closes),
    cmocka_unit_test(four_grids_pair_by_position),
    cmocka_unit_test(a_reduced_model_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(full_system, tests, folder_make, folder_remove)
