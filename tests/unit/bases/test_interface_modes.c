#include "testing.h"

#include "frame.h"
#include "project.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

/*
 * The lattice: NX x NY masses of 1 that move along z, a spring between
 * neighbours, the port 'edge' of NY masses at x = 0. Springs across y are 1
 * and, if the lattice is even, those along x too.
 */
enum { NX = 6, NY = 8, DOFS = NX * NY, MODES = 10 };

static const double pi = 3.14159265358979323846;

/* Eigenvalues reach 8, the lowest flexible one is (pi / NY)^2 / 2 and more. */
static const double solve_error = DOFS * DBL_EPSILON * 100.0;

static int64_t at(int64_t x, int64_t y)
{
    return x * NY + y;
}

static int64_t add_spring(int64_t count, int64_t i, int64_t j, double k,
                          int64_t *row, int64_t *col, double *val)
{
    const int64_t end[2] = {i, j};

    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++, count++) {
            row[count] = end[a];
            col[count] = end[b];
            val[count] = a == b ? k : -k;
        }
    return count;
}

/* Uneven: springs along x grow with y. */
static void stiffen(bool even, ritz_sparse *out)
{
    int64_t row[8 * DOFS], col[8 * DOFS];
    double val[8 * DOFS];
    int64_t count = 0;

    for (int64_t x = 0; x < NX; x++)
        for (int64_t y = 0; y < NY; y++) {
            double along = even ? 1.0 : 1.0 + (double)y;

            if (x + 1 < NX)
                count = add_spring(count, at(x, y), at(x + 1, y), along, row,
                                   col, val);
            if (y + 1 < NY)
                count = add_spring(count, at(x, y), at(x, y + 1), 1.0, row, col,
                                   val);
        }
    assert_ok(ritz_sparse_from_triplets(DOFS, DOFS, count, row, col, val, out));
}

/* Grids at (side x, y, 0), numbered from `first`. */
static void lattice(bool even, double side, int64_t first, ritz_component *out)
{
    int64_t all[DOFS];
    double one[DOFS];
    ritz_port *port = NULL;

    *out = (ritz_component){.num_dofs = DOFS, .num_ports = 1, .units = "none"};
    stiffen(even, &out->K);
    assert_non_null(out->dof = calloc(DOFS, sizeof *out->dof));
    assert_non_null(out->grids.id = calloc(DOFS, sizeof *out->grids.id));
    assert_non_null(out->grids.frame = calloc(DOFS, sizeof *out->grids.frame));
    assert_non_null(out->grids.position =
                        calloc(3 * (size_t)DOFS, sizeof *out->grids.position));
    assert_non_null(out->grids.axes = calloc(9, sizeof *out->grids.axes));
    assert_non_null(out->port = calloc(1, sizeof *out->port));
    out->grids.count = DOFS;
    out->grids.num_frames = 1;
    for (int k = 0; k < 3; k++)
        out->grids.axes[4 * k] = 1.0;
    for (int64_t i = 0; i < DOFS; i++) {
        int64_t x = i / NY;

        all[i] = i;
        one[i] = 1.0;
        out->dof[i] = (ritz_dof){first + i, 3};
        out->grids.id[i] = first + i;
        out->grids.position[3 * i] = side * (double)x;
        out->grids.position[3 * i + 1] = (double)(i % NY);
    }
    assert_ok(
        ritz_sparse_from_triplets(DOFS, DOFS, DOFS, all, all, one, &out->M));
    port = out->port;
    (void)snprintf(port->name, sizeof port->name, "edge");
    assert_non_null(port->dofs.at = calloc(NY, sizeof *port->dofs.at));
    port->dofs.count = NY;
    port->origin[1] = (NY - 1) / 2.0;
    for (int64_t y = 0; y < NY; y++)
        port->dofs.at[y] = at(0, y);
    for (int k = 0; k < 3; k++)
        port->axes[4 * k] = 1.0;
    assert_ok(ritz_component_settle(out, false));
}

/* Craig-Bampton with N interface modes; 0 keeps every dof of the edge. */
static void reduce(const ritz_component *body, int64_t modes, int64_t wanted,
                   ritz_basis *basis, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = body;
    request.modes = modes;
    request.attached = body->port[0].dofs;
    if (wanted > 0) {
        request.choice.given = RITZ_USES_INTERFACE;
        request.choice.interface_modes = wanted;
    }
    assert_ok(ritz_basis_make(&ritz_method_craig_bampton, &request, basis));
    if (out)
        assert_ok(ritz_reduce(body, basis, out));
}

/*
 * The lattice separates: across, mode k of the free chain is
 * cos(k pi (y + 1/2) / NY) with mu_k = 2 - 2 cos(k pi / NY); along, static
 * motion solves psi_{x-1} - (2 + mu) psi_x + psi_{x+1} = 0 with a free end,
 * psi_x = cosh((NX - x - 1/2) t) / cosh((NX - 1/2) t), 2 cosh t = 2 + mu.
 */
static double exact_eigenvalue(int64_t k)
{
    double mu = 2.0 - 2.0 * cos((double)k * pi / NY);
    double t = acosh(1.0 + mu / 2.0);
    double end = cosh((NX - 0.5) * t);
    double mass = 0.0;

    for (int x = 0; x < NX; x++)
        mass += pow(cosh((NX - x - 0.5) * t) / end, 2.0);
    return (1.0 + mu - cosh((NX - 1.5) * t) / end) / mass;
}

static void shapes_and_frequencies_of_the_lattice(void **state)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    const ritz_columns *columns = &basis.columns;

    (void)state;
    lattice(true, 1.0, 1, &body);
    reduce(&body, 0, 4, &basis, NULL);
    assert_string_equal(basis.origin.options, "modes 0 interface-modes 4");
    assert_int_equal(basis.T.ncol, 5);
    for (int64_t k = 0; k < 5; k++) {
        const double *t = ritz_dense_col(&basis.T, k);
        double exact = k == 0 ? 0.0 : ritz_eigen_hertz(exact_eigenvalue(k));

        assert_int_equal(columns->kind[k],
                         k == 0 ? RITZ_COLUMN_RIGID : RITZ_COLUMN_INTERFACE);
        assert_int_equal(columns->dof[k], -1);
        assert_near(columns->hertz[k], exact, solve_error);
        for (int64_t y = 0; y < NY; y++)
            assert_near(t[at(0, y)] / t[at(0, 0)],
                        cos((double)k * pi * ((double)y + 0.5) / NY) /
                            cos((double)k * pi * 0.5 / NY),
                        10.0 * solve_error);
    }
}

/* As many as there are, or more, are no reduction of the interface. */
static void all_interface_modes_are_all_boundary_motion(void **state)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0}, plain = {0};
    RITZ_OWN(ritz_reduced) some = {0}, all = {0};
    RITZ_OWN(ritz_pairs) a = {0}, b = {0};

    (void)state;
    lattice(false, 1.0, 1, &body);
    reduce(&body, MODES, NY + 3, &basis, &some);
    reduce(&body, MODES, 0, &plain, &all);
    assert_int_equal(basis.T.ncol, NY + MODES);
    assert_ok(ritz_eigen_dense(&some.K, &some.M, &a));
    assert_ok(ritz_eigen_dense(&all.K, &all.M, &b));
    for (int64_t k = 0; k < NY + MODES; k++)
        assert_near(a.lambda[k], b.lambda[k],
                    solve_error * b.lambda[NY + MODES - 1]);
}

/* Frequencies only fall as interface modes are added, never below the full. */
static void more_interface_modes_are_nearer(void **state)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) full = {0};
    double before = HUGE_VAL;

    (void)state;
    lattice(false, 1.0, 1, &body);
    assert_ok(ritz_sparse_dense(&body.K, &K));
    assert_ok(ritz_sparse_dense(&body.M, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &full));
    for (int64_t n = 1; n < NY; n += 2) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};
        double error = 0.0;

        reduce(&body, MODES, n, &basis, &reduced);
        assert_int_equal(basis.T.ncol, 1 + n + MODES);
        assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &pairs));
        assert_int_equal(pairs.num_rigid, 1);
        for (int k = 1; k <= 5; k++) {
            double e = pairs.lambda[k] / full.lambda[k] - 1.0;

            assert_true(e >= -solve_error);
            error = fmax(error, e);
        }
        assert_true(error < before);
        before = error;
    }
}

/* Two lattices joined at their edges, each with its own interface modes. */
static void join(bool even, int64_t left, int64_t right,
                 ritz_configuration *out)
{
    static const char text[] =
        "scene: two lattices\n"
        "components:\n"
        "  A: {model: a.h5, basis: craig-bampton, modes: 10}\n"
        "  B: {model: b.h5, basis: craig-bampton, modes: 10}\n"
        "joints:\n"
        "  - {name: seam, between: [A/edge, B/edge], type: fixed}\n";
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    ritz_component half[2] = {{0}};
    ritz_reduced body[2] = {0};

    assert_ok(ritz_scene_parse("two.yaml", text, &scene));
    lattice(true, -1.0, 1, &half[0]);
    lattice(even, 1.0, 101, &half[1]);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_basis) basis = {0};

        reduce(&half[k], MODES, k == 0 ? left : right, &basis, &body[k]);
        ritz_component_free(&half[k]);
    }
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, out));
}

/*
 * One side reduced: its few shapes lead the other side's dofs. With six of
 * seven flexible shapes the error of the lowest five modes is below 1e-3
 * (3.0e-4 measured).
 */
static void one_side_may_be_reduced(void **state)
{
    RITZ_OWN(ritz_configuration) full = {0}, one = {0};

    (void)state;
    join(false, 0, 0, &full);
    join(false, 6, 0, &one);
    assert_int_equal(full.rank, NY);
    assert_int_equal(one.rank, NY);
    assert_int_equal(full.K.ncol, NY + 2 * MODES);
    assert_int_equal(one.K.ncol, 1 + 6 + 2 * MODES);
    assert_int_equal(one.num_rigid, 1);
    for (int k = 1; k <= 5; k++) {
        assert_true(one.lambda[k] >= full.lambda[k] * (1.0 - solve_error));
        assert_near(one.lambda[k] / full.lambda[k], 1.0, 1e-3);
    }
}

/* Both sides reduced to the same shapes are as one side reduced. */
static void both_sides_with_the_same_shapes_do_not_lock(void **state)
{
    RITZ_OWN(ritz_configuration) one = {0}, both = {0};

    (void)state;
    join(true, 4, 0, &one);
    join(true, 4, 4, &both);
    assert_int_equal(both.rank, 5);
    assert_int_equal(both.K.ncol, 5 + 2 * MODES);
    for (int64_t k = 1; k < both.K.ncol; k++)
        assert_near(both.lambda[k], one.lambda[k], 100.0 * solve_error);
}

static double worst_error(const ritz_configuration *full,
                          const ritz_configuration *reduced)
{
    double worst = 0.0;

    for (int k = 1; k <= 5; k++)
        worst = fmax(worst, reduced->lambda[k] / full->lambda[k] - 1.0);
    return worst;
}

/*
 * Shapes that differ share rigid motion alone: every other coordinate of the
 * interface is lost, and the seam is as stiff as if it were held flat. The
 * errors are measured: 0.53 with both sides reduced, 6.2e-4 with one.
 */
static void both_sides_with_different_shapes_lock(void **state)
{
    RITZ_OWN(ritz_configuration) full = {0}, one = {0}, both = {0};

    (void)state;
    join(false, 0, 0, &full);
    join(false, 3, 0, &one);
    join(false, 3, 3, &both);
    assert_int_equal(both.rank, 2 * (1 + 3) - 1);
    assert_int_equal(both.K.ncol, 1 + 2 * MODES);
    assert_int_equal(both.num_rigid, 1);
    assert_near(worst_error(&full, &one), 6.2e-4, 1e-5);
    assert_near(worst_error(&full, &both), 0.53, 0.01);
}

/* One grid holds a plane beam: its three motions are rigid, and that is all. */
static void a_determinate_interface_has_rigid_modes_alone(void **state)
{
    static int64_t dofs[] = {0, 1, 2};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(frame_component(6, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    request.component = &beam;
    request.attached = (ritz_dofs){3, dofs};
    request.choice.given = RITZ_USES_INTERFACE;
    request.choice.interface_modes = 2;
    assert_ok(ritz_basis_make(&ritz_method_guyan, &request, &basis));
    assert_int_equal(basis.T.ncol, 3);
    for (int64_t j = 0; j < 3; j++)
        assert_int_equal(basis.columns.kind[j], RITZ_COLUMN_RIGID);
}

static void other_methods_have_none(void **state)
{
    ritz_request request = RITZ_REQUEST_NONE;

    (void)state;
    request.modes = 3;
    request.choice.given = RITZ_USES_INTERFACE;
    request.choice.interface_modes = 2;
    assert_fails(ritz_request_check(&ritz_method_macneal_rubin, &request),
                 RITZ_ERR_ARGUMENT,
                 "macneal-rubin has no 'interface_modes' to choose");
}

/* Two dofs of the edge that no mass follows and no spring holds. */
static void an_interface_without_mass_and_stiffness_is_refused(void **state)
{
    static const int64_t index[] = {0, 1, 2};
    static const double mass[] = {1, 0, 0};
    static int64_t ends[] = {0, 1, 2};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) loose = {.num_dofs = 3};
    ritz_basis none = {0};

    (void)state;
    assert_non_null(loose.dof = calloc(3, sizeof *loose.dof));
    for (int64_t i = 0; i < 3; i++)
        loose.dof[i] = (ritz_dof){i + 1, 3};
    assert_ok(ritz_sparse_from_triplets(3, 3, 3, index, index, mass, &loose.M));
    assert_ok(ritz_component_settle(&loose, false));
    request.component = &loose;
    request.attached = (ritz_dofs){3, ends};
    request.choice.given = RITZ_USES_INTERFACE;
    request.choice.interface_modes = 1;
    assert_fails(ritz_basis_make(&ritz_method_guyan, &request, &none),
                 RITZ_ERR_SINGULAR, "guyan: interface modes: ");
}

static void no_allocation_failure_leaks(void **state)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    lattice(true, 1.0, 1, &body);
    request.component = &body;
    request.modes = 2;
    request.attached = body.port[0].dofs;
    request.choice.given = RITZ_USES_INTERFACE;
    request.choice.interface_modes = 3;
    assert_survives_every_allocation(
        ritz_method_craig_bampton.make(&request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(shapes_and_frequencies_of_the_lattice),
    cmocka_unit_test(all_interface_modes_are_all_boundary_motion),
    cmocka_unit_test(more_interface_modes_are_nearer),
    cmocka_unit_test(one_side_may_be_reduced),
    cmocka_unit_test(both_sides_with_the_same_shapes_do_not_lock),
    cmocka_unit_test(both_sides_with_different_shapes_lock),
    cmocka_unit_test(a_determinate_interface_has_rigid_modes_alone),
    cmocka_unit_test(other_methods_have_none),
    cmocka_unit_test(an_interface_without_mass_and_stiffness_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(interface_modes, tests, NULL, NULL)
