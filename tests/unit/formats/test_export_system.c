/*
 * A system at a configuration, exported as shapes of its bodies and as a
 * container.
 */
#include "testing.h"

#include "bodies.h"
#include "folder.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/container.h>
#include <ritz/export.h>
#include <ritz/matrix.h>

#include <float.h>

enum { BODIES = 2, GRIDS = 2 };

static const double places[GRIDS][3] = {{0.5, -0.2, 0.1}, {1.5, 0.4, -0.3}};

/* Two bodies with the same grid numbers; B is turned by 90 degrees about z. */
typedef struct fixture {
    ritz_bodies bodies; /* the stage owns another copy */
    ritz_system system;
} fixture;

static ritz_status reduce_bodies(ritz_bodies *out)
{
    RITZ_CHECK(ritz_bodies_new(BODIES, out));
    for (int k = 0; k < BODIES; k++) {
        RITZ_OWN(ritz_component) body = {0};

        RITZ_CHECK(body_chain(GRIDS, places, 1, 7 + (uint64_t)k, &body));
        RITZ_CHECK(reduce_with(&body, &ritz_method_full, -1, &out->item[k]));
    }
    return RITZ_OK;
}

static int set_up(void **state)
{
    static const char text[] =
        "scene: pair\ncomponents:\n  A: {model: a.h5, basis: full}\n"
        "  B: {model: b.h5, basis: full}\njoints:\n"
        "  - {name: p, between: [A/g2, B/g1], type: hinge, axis: [0, 0, 1], "
        "angles_deg: [90]}\n";
    static fixture f;
    RITZ_OWN(ritz_bodies) again = {0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    *state = &f;
    if (folder_make(state) != 0 ||
        ritz_scene_parse("pair.yaml", text, &scene) != RITZ_OK ||
        reduce_bodies(&again) != RITZ_OK ||
        reduce_bodies(&f.bodies) != RITZ_OK ||
        ritz_stage_from(&scene, again.item, &stage) != RITZ_OK ||
        ritz_assemble(&stage, NULL, &f.system) != RITZ_OK)
        return -1;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_bodies_free(&f->bodies);
    ritz_system_free(&f->system);
    return folder_remove(state);
}

static ritz_status shape_once(const fixture *f, const char *list,
                              ritz_shapes *out)
{
    const ritz_reduced *const body[] = {&f->bodies.item[0], &f->bodies.item[1]};

    return ritz_shapes_of_system(&f->system, f->system.configuration, body,
                                 list, out);
}

/* Displacement of a grid in shape k. */
static const double *motion_of(const ritz_dense *u, int64_t point, int64_t k)
{
    return ritz_dense_col(u, k) + 3 * point;
}

static void bodies_stand_where_joints_put_them(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_shapes) s = {0};
    /* B's second grid lies at R (x_2 - x_1) from A's second grid */
    const double last[3] = {1.5 - 0.6, 0.4 + 1.0, -0.3 - 0.4};
    const double near = 100.0 * DBL_EPSILON;

    assert_ok(shape_once(f, "8-11", &s));
    assert_int_equal(s.num_points, BODIES * GRIDS);
    assert_int_equal(s.count, 4);
    assert_false(s.meshed);
    assert_int_equal(s.cells.count, BODIES * GRIDS);
    assert_int_equal(s.cells.grid[3], 3);
    assert_int_equal(s.id[0], 1);
    assert_int_equal(s.id[3], 12); /* grid 2, offset by 10 */
    for (int i = 0; i < 3; i++) {
        assert_near(s.position[3 + i], places[1][i], 0.0);
        assert_near(s.position[6 + i], places[1][i], near);
        assert_near(s.position[9 + i], last[i], near);
    }
    for (int64_t k = 0; k < s.count; k++)
        for (int i = 0; i < 3; i++) {
            assert_near(motion_of(&s.u, 2, k)[i], motion_of(&s.u, 1, k)[i],
                        1e4 * DBL_EPSILON);
            if (i < 2) /* the hinge is free about z */
                assert_near(motion_of(&s.turn, 2, k)[i],
                            motion_of(&s.turn, 1, k)[i], 1e4 * DBL_EPSILON);
        }
}

/* B's second grid lies at R (x_2 - x_1) from the hinge, and moves along axes of
   the system as B's own do, turned by 90 degrees about z. */
static void ports_of_bodies_are_placed(void **state)
{
    const fixture *f = *state;
    const ritz_reduced *const body[] = {&f->bodies.item[0], &f->bodies.item[1]};
    const ritz_configuration *at = f->system.configuration;
    const double place[3] = {1.5 - 0.6, 0.4 + 1.0, -0.3 - 0.4};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) own = {0};
    const ritz_port_map *port = NULL;

    assert_ok(ritz_reduced_of_configuration(&f->system, at, &reduced));
    assert_ok(ritz_reduced_place_ports(&f->system, at, body, &reduced));
    assert_int_equal(reduced.num_ports, 4);
    port = ritz_reduced_port(&reduced, "B/g2");
    assert_non_null(port);
    assert_int_equal(port->count, 6);
    assert_int_equal(port->dof[0].grid, 12);
    for (int i = 0; i < 3; i++) {
        assert_near(port->position[i], place[i], 100.0 * DBL_EPSILON);
        assert_near(port->origin[i], place[i], 100.0 * DBL_EPSILON);
    }
    assert_ok(ritz_dense_mul(&body[1]->port[1].map, &at->P[1], &own));
    for (int64_t j = 0; j < own.ncol; j++)
        for (int i = 0; i < 6; i += 3) {
            const double *q = ritz_dense_col(&own, j) + i;
            const double *x = ritz_dense_col(&port->map, j) + i;

            assert_near(x[0], -q[1], 1e-14);
            assert_near(x[1], q[0], 1e-14);
            assert_near(x[2], q[2], 1e-14);
        }
}

static ritz_status place_once(const fixture *f)
{
    const ritz_reduced *const body[] = {&f->bodies.item[0], &f->bodies.item[1]};
    RITZ_OWN(ritz_reduced) reduced = {0};

    RITZ_CHECK(ritz_reduced_of_configuration(
        &f->system, f->system.configuration, &reduced));
    return ritz_reduced_place_ports(&f->system, f->system.configuration, body,
                                    &reduced);
}

static void placing_survives_failing_allocations(void **state)
{
    assert_survives_every_allocation(place_once(*state));
}

static void bodies_of_another_system_are_refused(void **state)
{
    fixture *f = *state;
    const ritz_reduced *swapped[] = {&f->bodies.item[1], &f->bodies.item[0]};
    ritz_configuration *at = f->system.configuration;
    RITZ_OWN(ritz_shapes) s = {0};
    RITZ_OWN(ritz_dense) kept = {0};
    ritz_reduced bare = f->bodies.item[0]; /* borrowed */
    const ritz_reduced *without[] = {&bare, &f->bodies.item[1]};

    assert_fails(ritz_shapes_of_system(&f->system, at, swapped, NULL, &s),
                 RITZ_ERR_ARGUMENT, "are not the mass of the system");
    bare.T = (ritz_dense){0};
    assert_fails(ritz_shapes_of_system(&f->system, at, without, NULL, &s),
                 RITZ_ERR_ARGUMENT, "'A' was reduced --without-basis");
    bare.K.ncol = 3;
    assert_fails(ritz_shapes_of_system(&f->system, at, without, NULL, &s),
                 RITZ_ERR_ARGUMENT,
                 "'A' has 12 coordinates in the system and 3 in its file");
    assert_fails(shape_once(f, "99", &s), RITZ_ERR_ARGUMENT,
                 "there is no mode 99");
    RITZ_MOVE(kept, at->places);
    assert_fails(shape_once(f, NULL, &s), RITZ_ERR_ARGUMENT,
                 "does not say where its bodies are: assemble it anew");
    RITZ_MOVE(at->places, kept);
}

static void rename_grid(fixture *f, int64_t from, int64_t to)
{
    for (int c = 0; c < 2; c++) {
        const ritz_reduced *body = &f->bodies.item[c];

        for (int64_t k = 0; k < body->grids.count; k++)
            if (body->grids.id[k] == from)
                body->grids.id[k] = to;
        for (int64_t i = 0; i < body->num_dofs; i++)
            if (body->dof[i].grid == from)
                body->dof[i].grid = to;
    }
}

/* Renumber the last grid of both bodies: grids of B get an offset above the
   largest number. */
static void grid_numbers_without_room_for_an_offset_are_refused(void **state)
{
    static const int64_t huge[] = {INT64_MAX / 2, 999999999999999999};
    fixture *f = *state;
    int64_t last = f->bodies.item[0].grids.id[GRIDS - 1];
    RITZ_OWN(ritz_shapes) s = {0};

    rename_grid(f, last, huge[0]);
    assert_fails(shape_once(f, "8", &s), RITZ_ERR_ARGUMENT,
                 "leave no others for those of 2 bodies");
    rename_grid(f, huge[0], huge[1]);
    assert_ok(shape_once(f, "8", &s));
    assert_int_equal(s.id[2 * GRIDS - 1], 1999999999999999999);
    rename_grid(f, huge[1], last);
}

static ritz_status write_once(const fixture *f, bool states, const char *path)
{
    const ritz_export_request request = {.output = path};
    const ritz_damping none = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    ritz_export_object object = {.reduced = &reduced};

    RITZ_CHECK(ritz_reduced_of_configuration(
        &f->system, f->system.configuration, &reduced));
    if (states) {
        RITZ_CHECK(ritz_states_of_reduced(&reduced, &none, &space));
        object = (ritz_export_object){.states = &space};
    }
    return ritz_exporter_container.write(&object, &request, &report);
}

static void a_container_holds_what_was_exported(void **state)
{
    fixture *f = *state;
    const ritz_configuration *at = f->system.configuration;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    const int64_t e = at->K.ncol;

    assert_ok(write_once(f, false, folder_path("r.h5")));
    assert_ok(ritz_container_read_reduced(folder_path("r.h5"), &reduced));
    assert_int_equal(reduced.K.ncol, e);
    for (int64_t j = at->num_rigid; j < e; j++)
        assert_near(ritz_dense_col(&reduced.K, j)[j], at->lambda[j], 0.0);
    assert_true(reduced.inertia.known);
    assert_ok(write_once(f, true, folder_path("s.h5")));
    assert_ok(ritz_container_read_state_space(folder_path("s.h5"), &space));
    assert_int_equal(space.A.ncol, 2 * e);
    assert_fails(write_once(f, false, "/no/where.h5"), RITZ_ERR_FILE,
                 "/no/where.h5");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    ritz_shapes s = {0};

    assert_survives_every_allocation(shape_once(f, "8", &s));
    ritz_shapes_free(&s);
    assert_survives_every_allocation(write_once(f, false, folder_path("r.h5")));
    assert_survives_every_allocation(write_once(f, true, folder_path("s.h5")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bodies_stand_where_joints_put_them),
    cmocka_unit_test(ports_of_bodies_are_placed),
    cmocka_unit_test(placing_survives_failing_allocations),
    cmocka_unit_test(bodies_of_another_system_are_refused),
    cmocka_unit_test(grid_numbers_without_room_for_an_offset_are_refused),
    cmocka_unit_test(a_container_holds_what_was_exported),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(export_system, tests, set_up, tear_down)
