/* Components: what is refused, frames, rigid geometry, mass, reduction. */
#include "testing.h"

#include "frame.h"

#include "bar.h"
#include "project.h"
#include "scenes.h"

#include <ritz/basis.h>
#include <ritz/model.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { GRIDS = 2, DOFS = 6 * GRIDS };

static const double pi = 3.14159265358979323846;

/*
 * Two six-dof grids at (1, 2, 3) and (3, 2, 3), unit point masses of 2 and 3
 * with unit inertias; the second grid's displacement axes are turned by 30
 * degrees about z.
 */
static ritz_status two_masses(ritz_component *out)
{
    static const double place[] = {1, 2, 3, 3, 2, 3};
    RITZ_OWN(ritz_component) c = {.num_dofs = DOFS, .units = "kg m s"};
    int64_t at[DOFS];
    double mass[DOFS];
    const double s = 0.5;
    const double k = cos(pi / 6.0);
    const double turned[] = {k, s, 0, -s, k, 0, 0, 0, 1};

    RITZ_CHECK_NEW(c.dof, DOFS);
    for (int64_t i = 0; i < DOFS; i++) {
        c.dof[i] = (ritz_dof){10 + i / 6, i % 6 + 1};
        at[i] = i;
        mass[i] = i % 6 >= 3 ? 1.0 : i < 6 ? 2.0 : 3.0;
    }
    RITZ_CHECK(ritz_sparse_from_triplets(DOFS, DOFS, DOFS, at, at, mass, &c.M));
    RITZ_CHECK_NEW(c.grids.id, GRIDS);
    RITZ_CHECK_NEW(c.grids.position, 3 * GRIDS);
    RITZ_CHECK_NEW(c.grids.frame, GRIDS);
    RITZ_CHECK_NEW(c.grids.axes, 18);
    c.grids.count = GRIDS;
    c.grids.num_frames = 2;
    memcpy(c.grids.position, place, sizeof place);
    for (int i = 0; i < 3; i++)
        c.grids.axes[4 * i] = 1.0;
    memcpy(c.grids.axes + 9, turned, sizeof turned);
    for (int64_t i = 0; i < GRIDS; i++) {
        c.grids.id[i] = 10 + i;
        c.grids.frame[i] = i;
    }
    RITZ_CHECK(ritz_component_settle(&c, false));
    *out = c;
    c = (ritz_component){0};
    return RITZ_OK;
}

static void missing_parts_are_completed(void **state)
{
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(two_masses(&c));
    assert_int_equal(c.K.ncol, DOFS);
    assert_int_equal(c.K.colptr[DOFS], 0);
    assert_int_equal(c.io.B.nrow, DOFS);
    assert_int_equal(c.io.num_inputs, 0);
}

static void what_is_no_component_is_refused(void **state)
{
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(two_masses(&c));
    c.dof[3] = c.dof[2];
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "grid 10 T3 has two rows");
    c.dof[3].component = 7;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "which is not among 0 to 6");
    c.dof[3].component = 4;
    c.M.val[0] = nan("");
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "M: entry (0, 0) is not finite");
    c.M.val[0] = 2.0;
    c.grids.frame[0] = 5;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "grid 10 has no such frame");
    c.grids.frame[0] = 0;
    assert_ok(add_port(&c, "end", 10));
    assert_ok(add_port(&c, "end", 11));
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "there are two ports 'end'");
    c.port[1].name[0] = 'E';
    c.port[0].dofs.at[0] = DOFS;
    assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                 "which is not among the 12");
}

/* 1e-7 of the largest entry is averaged, 1e-5 is refused unless asked. */
static void a_little_asymmetry_is_averaged(void **state)
{
    static const int64_t row[] = {0, 1, 0, 1};
    static const int64_t col[] = {0, 0, 1, 1};

    (void)state;
    for (int large = 0; large < 2; large++) {
        double gap = large ? 1e-5 : 1e-7;
        const double K[] = {1.0, -0.5, -0.5 + gap, 1.0};
        const double M[] = {1.0, 0.0, 0.0, 1.0};
        ritz_component c = {.num_dofs = 2};

        assert_non_null(c.dof = calloc(2, sizeof *c.dof));
        c.dof[0] = (ritz_dof){1, 1};
        c.dof[1] = (ritz_dof){2, 1};
        assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, K, &c.K));
        assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, M, &c.M));
        if (large)
            assert_fails(ritz_component_settle(&c, false), RITZ_ERR_FORMAT,
                         "K: unsymmetric by 1.0e-05");
        assert_ok(ritz_component_settle(&c, large));
        assert_near(c.asymmetry, gap, 1e-15);
        assert_true(c.K.val[1] == c.K.val[2]);
        assert_near(c.K.val[1], -0.5 + gap / 2.0, DBL_EPSILON);
        ritz_component_free(&c);
    }
}

static void a_port_is_found_or_the_nearest_named(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_dofs set = {0};

    (void)state;
    assert_ok(two_masses(&c));
    assert_ok(add_port(&c, "left", 10));
    assert_ok(add_port(&c, "right", 11));
    assert_non_null(ritz_component_port(&c, "left"));
    assert_null(ritz_component_port(&c, "rihgt"));
    assert_non_null(strstr(ritz_error_message(), "is 'right' meant?"));
    assert_ok(ritz_component_attached(&c, "right,left,right", &set));
    assert_int_equal(set.count, 12);
    assert_int_equal(set.at[0], 6);
    ritz_dofs_free(&set);
    assert_ok(ritz_component_attached(&c, "", &set));
    assert_int_equal(set.count, 0);
    ritz_dofs_free(&set);
    assert_fails(ritz_component_attached(&c, "top", &set), RITZ_ERR_ARGUMENT,
                 "there is no port 'top'");
    assert_int_equal(row_of_dof(&c, (ritz_dof){11, 2}), 7);
    assert_int_equal(row_of_dof(&c, (ritz_dof){12, 2}), -1);
}

/* u_basic = A' u: a displacement along the turned x axis is (cos, sin, 0). */
static void a_port_is_turned_into_basic_axes(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_dense turn = {0};
    ritz_dof *label = NULL;

    (void)state;
    assert_ok(two_masses(&c));
    assert_ok(add_port(&c, "right", 11));
    assert_ok(ritz_port_turn(&c, &c.port[0], &turn, &label));
    assert_near(ritz_dense_col(&turn, 0)[0], cos(pi / 6.0), DBL_EPSILON);
    assert_near(ritz_dense_col(&turn, 0)[1], sin(pi / 6.0), DBL_EPSILON);
    assert_near(ritz_dense_col(&turn, 4)[3], -sin(pi / 6.0), DBL_EPSILON);
    assert_int_equal(label[4].grid, 11);
    assert_int_equal(label[4].component, 5);
    ritz_dense_free(&turn);
    free(label);
    c.port[0].dofs.count = 5; /* R3 is left out */
    assert_fails(ritz_port_turn(&c, &c.port[0], &turn, NULL), RITZ_ERR_ARGUMENT,
                 "brings only some of its rotations");
}

/* u = t + r x d, seen along the displacement axes of the grid. */
static void rigid_geometry_follows_its_formula(void **state)
{
    const double origin[] = {1, 2, 3};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_dense) R = {0};

    (void)state;
    assert_ok(two_masses(&c));
    assert_ok(ritz_rigid_geometry(&c, origin, &R));
    /* about z at d = (2, 0, 0): u = (0, 2, 0), turned by -30 degrees */
    assert_near(ritz_dense_col(&R, 5)[6], 2.0 * sin(pi / 6.0), 4 * DBL_EPSILON);
    assert_near(ritz_dense_col(&R, 5)[7], 2.0 * cos(pi / 6.0), 4 * DBL_EPSILON);
    assert_near(ritz_dense_col(&R, 5)[11], 1.0, 0.0);
    /* about y at d: u = (0, 0, -2) */
    assert_near(ritz_dense_col(&R, 4)[8], -2.0, 4 * DBL_EPSILON);
}

/* m = 5, c = (11/5, 2, 3), J_c = 2 I + 6/5 * 4 diag(0, 1, 1). */
static void mass_properties_are_those_of_two_points(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_inertia inertia = {0};
    const double spread = 2.0 * 3.0 / 5.0 * 4.0;

    (void)state;
    assert_ok(two_masses(&c));
    assert_ok(ritz_inertia_of(&c, &inertia));
    assert_true(inertia.known);
    assert_near(inertia.mass, 5.0, 1e-14);
    assert_near(inertia.centre[0], 2.2, 1e-14);
    assert_near(inertia.centre[1], 2.0, 1e-14);
    assert_near(inertia.centre[2], 3.0, 1e-14);
    /* J_o of 45 and more cancels: 100 eps of it */
    assert_near(inertia.tensor[0], 2.0, 1e-12);
    assert_near(inertia.tensor[4], 2.0 + spread, 1e-12);
    assert_near(inertia.tensor[8], 2.0 + spread, 1e-12);
    assert_near(inertia.tensor[1], 0.0, 1e-12);
}

/* A beam of 20 kg and 2 m in the plane: J_zz = m L^2 / 12, nothing else
   seen. */
static void a_plane_model_shows_its_inertia_in_the_plane(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_inertia inertia = {0};

    (void)state;
    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &c));
    assert_ok(ritz_inertia_of(&c, &inertia));
    assert_near(inertia.mass, 20.0, 1e-13);
    assert_near(inertia.centre[0], 1.0, 1e-14);
    assert_near(inertia.centre[1], 0.0, 1e-14);
    /* J_o of 27 cancels to this: 100 eps of it */
    assert_near(inertia.tensor[8], 20.0 / 3.0, 1e-12);
    for (int k = 0; k < 8; k++)
        assert_near(inertia.tensor[k], 0.0, 1e-12);
}

static void fill_io(ritz_io *io, const char *name, double value)
{
    snprintf(io->input[0], RITZ_NAME_SIZE, "%s", name);
    snprintf(io->output[0], RITZ_NAME_SIZE, "%s", name);
    io->limit[0] = value;
    for (int64_t i = 0; i < io->B.nrow; i++) {
        io->B.val[i] = value + (double)i;
        io->C.val[i] = value * (double)i;
    }
}

static void inputs_and_outputs_are_projected(void **state)
{
    RITZ_OWN(ritz_io) io = {0}, part = {0};
    RITZ_OWN(ritz_dense) T = {0};

    (void)state;
    assert_ok(ritz_io_new(3, 1, 1, &io));
    fill_io(&io, "b", 5.0);
    assert_ok(ritz_dense_new(3, 1, &T));
    T.val[1] = 1.0;
    T.val[2] = 2.0;
    assert_ok(ritz_io_project(&io, &T, &part));
    assert_string_equal(part.input[0], "b");
    assert_near(part.limit[0], 5.0, 0.0);
    assert_near(part.B.val[0], 20.0, 0.0);
    assert_near(part.C.val[0], 25.0, 0.0);
}

/* A free bar held at one end has no stiffness there: exactly none. */
static void rigid_motion_costs_exactly_nothing(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    (void)state;
    assert_ok(bar_component(11, &bar));
    assert_ok(add_port(&bar, "end", 1));
    assert_ok(reduce_with(&bar, &ritz_method_guyan, -1, &reduced));
    assert_int_equal(reduced.K.ncol, 1);
    assert_true(reduced.K.val[0] == 0.0);
    assert_near(reduced.M.val[0], 1.0, 11 * 121 * DBL_EPSILON);
}

/* (T V)' K (T V) = V' (T'KT) V, and what the port and T become. */
static void projecting_twice_is_projecting_by_the_product(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) first = {0}, second = {0};
    RITZ_OWN(ritz_dense) V = {0}, direct = {0};

    (void)state;
    assert_ok(bar_component(8, &bar));
    assert_ok(add_port(&bar, "end", 1));
    assert_ok(reduce_with(&bar, &ritz_method_craig_bampton, 3, &first));
    assert_ok(ritz_dense_new(4, 2, &V));
    for (int64_t k = 0; k < 8; k++)
        V.val[k] = sin((double)(3 * k + 1));
    assert_ok(ritz_reduced_project(&first, &V, &second));
    assert_string_equal(ritz_column_name(second.columns.kind[0]), "system");
    direct = project(&bar.K, &second.T);
    for (int64_t k = 0; k < 4; k++)
        assert_near(second.K.val[k], direct.val[k],
                    64 * DBL_EPSILON * ritz_dense_max(&first.K) * 4);
    for (int64_t j = 0; j < 2; j++)
        assert_near(second.port[0].map.val[j], ritz_dense_col(&second.T, j)[0],
                    4 * DBL_EPSILON);
}

static void a_basis_of_another_size_is_refused(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_reduced none = {0};

    (void)state;
    assert_ok(bar_component(4, &bar));
    assert_ok(ritz_basis_new(3, 1, &basis));
    assert_fails(ritz_reduce(&bar, &basis, &none), RITZ_ERR_ARGUMENT,
                 "the basis is for 3 dofs, the component has 5");
}

static ritz_status reduce_anew(const ritz_component *bar)
{
    ritz_reduced reduced = {0};
    ritz_status status =
        reduce_with(bar, &ritz_method_craig_bampton, 2, &reduced);

    ritz_reduced_free(&reduced);
    return status;
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_component) c = {0};

    (void)state;
    assert_ok(bar_component(4, &bar));
    assert_ok(add_port(&bar, "end", 1));
    assert_survives_every_allocation(reduce_anew(&bar));
    assert_survives_every_allocation(two_masses(&c));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(missing_parts_are_completed),
    cmocka_unit_test(what_is_no_component_is_refused),
    cmocka_unit_test(a_little_asymmetry_is_averaged),
    cmocka_unit_test(a_port_is_found_or_the_nearest_named),
    cmocka_unit_test(a_port_is_turned_into_basic_axes),
    cmocka_unit_test(rigid_geometry_follows_its_formula),
    cmocka_unit_test(mass_properties_are_those_of_two_points),
    cmocka_unit_test(a_plane_model_shows_its_inertia_in_the_plane),
    cmocka_unit_test(inputs_and_outputs_are_projected),
    cmocka_unit_test(rigid_motion_costs_exactly_nothing),
    cmocka_unit_test(projecting_twice_is_projecting_by_the_product),
    cmocka_unit_test(a_basis_of_another_size_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(component, tests, NULL, NULL)
