/*
 * The full-order system of the dual-spin spacecraft in data/dualspin, whose
 * frequencies SOURCE.md has from an independent assembly.
 */
#include "testing.h"

#include "folder.h"
#include "scenes.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { DOFS = 296, RIGID = 8, ANGLES = 6, MODES = 32 };

/* data/dualspin/SOURCE.md: flexible modes in Hz at clock 0, 60, ... 300 */
static const double published[MODES][ANGLES] = {
    {0.1821, 0.1824, 0.1821, 0.1821, 0.1824, 0.1820},
    {0.4935, 0.4935, 0.4935, 0.4935, 0.4935, 0.4935},
    {1.2960, 1.2958, 1.2959, 1.2960, 1.2961, 1.2962},
    {1.4204, 1.4475, 1.4299, 1.4200, 1.4472, 1.4299},
    {1.7229, 1.7207, 1.7216, 1.7229, 1.7207, 1.7216},
    {2.3433, 2.3436, 2.3435, 2.3432, 2.3436, 2.3435},
    {2.5323, 2.5341, 2.5351, 2.5322, 2.5333, 2.5351},
    {2.7260, 2.6236, 2.9120, 2.7234, 2.6084, 2.8883},
    {3.6264, 3.5620, 3.1886, 3.6496, 3.5669, 3.1847},
    {4.2361, 4.2364, 4.2359, 4.2361, 4.2364, 4.2359},
    {4.6332, 4.6096, 4.6188, 4.6298, 4.6116, 4.6232},
    {5.2481, 5.2444, 5.2475, 5.2490, 5.2448, 5.2472},
    {5.6039, 5.6032, 5.6032, 5.6038, 5.6031, 5.6032},
    {6.1804, 6.1641, 6.2047, 6.1860, 6.1959, 6.2350},
    {6.8933, 6.9765, 6.8463, 6.8656, 6.9534, 6.8451},
    {7.4029, 7.4026, 7.4031, 7.4029, 7.4026, 7.4031},
    {8.5177, 8.5226, 8.5226, 8.5179, 8.5229, 8.5226},
    {9.3369, 9.1163, 9.1105, 9.3386, 9.1258, 9.1375},
    {9.5025, 9.9266, 9.6944, 9.4445, 9.8786, 9.7245},
    {10.5700, 10.2860, 10.3706, 10.5700, 10.3253, 10.3161},
    {10.7060, 10.5701, 10.5700, 10.7570, 10.5701, 10.5700},
    {12.4667, 12.3148, 12.3549, 12.4778, 12.3164, 12.3508},
    {13.0264, 13.0483, 13.0483, 13.0261, 13.0483, 13.0483},
    {13.0483, 13.0898, 13.1306, 13.0483, 13.0910, 13.1318},
    {13.1894, 13.2201, 13.1809, 13.1893, 13.2200, 13.1801},
    {13.4182, 13.4182, 13.4182, 13.4182, 13.4182, 13.4182},
    {14.0029, 14.0032, 14.0033, 14.0028, 14.0032, 14.0033},
    {14.0975, 14.6464, 14.3977, 14.0997, 14.6528, 14.3990},
    {15.5544, 15.5543, 15.5540, 15.5547, 15.5546, 15.5539},
    {16.8155, 17.4321, 17.0529, 16.8139, 17.4323, 17.0525},
    {18.9081, 17.8278, 18.7458, 18.9056, 17.8238, 18.7472},
    {19.7434, 19.7431, 19.7434, 19.7434, 19.7431, 19.7434},
};

/* One of the three bodies, with its ports. */
static void import(const char *name, ritz_component *out)
{
    static const char *const ports[] = {"bearing=1", "scan=5"};
    static const char *const scan[] = {"scan=1"};
    const bool rigid = strcmp(name, "platform") == 0;
    const char *data = getenv("RITZ_DATA");
    char K[512], M[512], bulk[512];
    const ritz_import_request request = {
        .stiffness = rigid ? NULL : K,
        .mass = M,
        .bulk = bulk,
        .num_ports = strcmp(name, "stator") == 0 ? 2 : 1,
        .port = rigid ? scan : ports};
    RITZ_OWN(ritz_import_report) report = {0};

    snprintf(K, sizeof K, "%s/dualspin/%s.op4:KGG", data, name);
    snprintf(M, sizeof M, "%s/dualspin/%s.op4:MGG", data, name);
    snprintf(bulk, sizeof bulk, "%s/dualspin/%s.bdf", data, name);
    assert_ok(ritz_import(&request, out, &report));
}

static const char spacecraft[] =
    "scene: dual-spin spacecraft\n"
    "components:\n"
    "  rotor:    {model: rotor.h5,    basis: full}\n"
    "  stator:   {model: stator.h5,   basis: full}\n"
    "  platform: {model: platform.h5, basis: full}\n"
    "joints:\n"
    "  - {name: clock, between: [rotor/bearing, stator/bearing], type: hinge,"
    " axis: [0, 0, 1]}\n"
    "  - {name: cone, between: [stator/scan, platform/scan], type: hinge,"
    " axis: [0, 1, 0]}\n";

static const char *const bodies[] = {"rotor", "stator", "platform"};

/* Import the bodies and store them; false, and a reason, without the data. */
static bool store_spacecraft(void)
{
    if (!getenv("RITZ_DATA")) {
        print_message("skipped: no RITZ_DATA\n");
        return false;
    }
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_component) body = {0};
        char file[32];

        import(bodies[k], &body);
        snprintf(file, sizeof file, "%s.h5", bodies[k]);
        folder_store(file, &body);
    }
    return true;
}

static void assemble(const char *text, const double *setting,
                     ritz_component *out)
{
    RITZ_OWN(ritz_scene) scene = {0};

    folder_parse(text, &scene);
    assert_ok(ritz_assemble_full(&scene, setting, out, NULL));
}

static void find_modes(const ritz_component *system, ritz_pairs *out)
{
    const ritz_span span = {.modes = DOFS - RIGID};

    assert_ok(ritz_eigen_sparse(&system->K, &system->M, &span, out));
    assert_int_equal(out->num_rigid, RIGID);
    assert_int_equal(out->Phi.ncol, DOFS);
}

static void spacecraft_has_the_frequencies_of_its_table(void **state)
{
    (void)state;
    if (!store_spacecraft())
        skip();
    for (int a = 0; a < ANGLES; a++) {
        const double angle[] = {60.0 * a, 0.0};
        RITZ_OWN(ritz_component) system = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};

        assemble(spacecraft, angle, &system);
        assert_int_equal(system.num_dofs, DOFS);
        find_modes(&system, &pairs);
        for (int k = 0; k < MODES; k++)
            assert_near(ritz_eigen_hertz(pairs.lambda[RIGID + k]),
                        published[k][a], 5e-5 /* half a unit */);
    }
}

static void reduce_body(const char *name, ritz_reduced *out)
{
    RITZ_OWN(ritz_component) body = {0};

    import(name, &body);
    assert_ok(reduce_with(&body, &ritz_method_full, -1, out));
}

/* Rounding of both: eps lambda_max, and some operations on each. */
static void sparse_and_dense_assembly_agree(void **state)
{
    const double angle[] = {60.0, 0.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_component) system = {0};
    ritz_reduced reduced[3] = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    (void)state;
    if (!store_spacecraft())
        skip();
    assemble(spacecraft, angle, &system);
    find_modes(&system, &pairs);
    for (int k = 0; k < 3; k++)
        reduce_body(bodies[k], &reduced[k]);
    folder_parse(spacecraft, &scene);
    assert_ok(ritz_stage_from(&scene, reduced, &stage));
    assert_ok(ritz_stage_assemble(&stage, angle, &c));
    assert_int_equal(c.K.ncol, DOFS);
    assert_int_equal(c.num_rigid, RIGID);
    for (int64_t k = RIGID; k < DOFS; k++)
        assert_near(pairs.lambda[k], c.lambda[k],
                    DBL_EPSILON * (c.lambda[DOFS - 1] + 50.0 * c.lambda[k]));
}

/*
 * The clock hinge once more, from the other side: its five constraints follow
 * from those that are there, but for rounding. To find eigenvalues a matrix is
 * turned by n reflections, each of which rounds it by eps lambda_max; at random
 * they add up to the root of n of that [Higham2002, sec. 2.8 and 19.3].
 */
static void a_hinge_stated_from_both_sides_binds_once(void **state)
{
    const double angle[] = {37.0, 0.0, -37.0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_component) once = {0}, twice = {0};
    ritz_reduced reduced[3] = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_pairs) one = {0}, two = {0};
    char text[1024];

    (void)state;
    if (!store_spacecraft())
        skip();
    snprintf(text, sizeof text,
             "%s  - {name: again, between: [stator/bearing, rotor/bearing],"
             " type: hinge, axis: [0, 0, 1]}\n",
             spacecraft);
    assemble(spacecraft, angle, &once);
    assemble(text, angle, &twice);
    find_modes(&once, &one);
    find_modes(&twice, &two);
    for (int k = 0; k < 3; k++)
        reduce_body(bodies[k], &reduced[k]);
    folder_parse(text, &scene);
    assert_ok(ritz_stage_from(&scene, reduced, &stage));
    assert_ok(ritz_stage_assemble(&stage, angle, &c));
    assert_int_equal(c.rank, 10);
    for (int64_t k = RIGID; k < DOFS; k++) {
        const double bound = DBL_EPSILON * (sqrt(DOFS) * one.lambda[DOFS - 1] +
                                            50.0 * one.lambda[k]);

        assert_near(two.lambda[k], one.lambda[k], bound);
        assert_near(c.lambda[k], one.lambda[k], bound);
    }
}

/* Shuffle the rows; grids count downwards from 9999 in the order of ids. */
static void disorder(ritz_component *c)
{
    const int64_t n = c->num_dofs;
    int64_t *row = calloc((size_t)n, sizeof *row);
    int64_t *place = calloc((size_t)n, sizeof *place);
    ritz_dof *dof = calloc((size_t)n, sizeof *dof);
    ritz_sparse K = {0}, M = {0};

    assert_true(row && place && dof);
    for (int64_t i = 0; i < n; i++)
        row[i] = (7919 * i + 11) % n; /* 7919 is prime: each row once */
    for (int64_t i = 0; i < n; i++) {
        place[row[i]] = i;
        dof[i] = c->dof[row[i]];
        dof[i].grid = 9999 - dof[i].grid;
    }
    assert_ok(ritz_sparse_extract(&c->K, n, row, n, row, &K));
    assert_ok(ritz_sparse_extract(&c->M, n, row, n, row, &M));
    for (int64_t k = 0; k < c->num_ports; k++)
        for (int64_t i = 0; i < c->port[k].dofs.count; i++)
            c->port[k].dofs.at[i] = place[c->port[k].dofs.at[i]];
    for (int64_t i = 0, j = c->grids.count - 1; i <= j; i++, j--) {
        const int64_t id = c->grids.id[i], frame = c->grids.frame[i];

        c->grids.id[i] = 9999 - c->grids.id[j];
        c->grids.id[j] = 9999 - id;
        c->grids.frame[i] = c->grids.frame[j];
        c->grids.frame[j] = frame;
        for (int k = 0; k < 3; k++) {
            const double x = c->grids.position[3 * i + k];

            c->grids.position[3 * i + k] = c->grids.position[3 * j + k];
            c->grids.position[3 * j + k] = x;
        }
    }
    for (int64_t k = 0; k < c->elements.count; k++)
        for (int64_t i = c->elements.first[k]; i < c->elements.first[k + 1];
             i++)
            c->elements.grid[i] = 9999 - c->elements.grid[i];
    ritz_sparse_free(&c->K);
    ritz_sparse_free(&c->M);
    free(c->dof);
    c->K = K;
    c->M = M;
    c->dof = dof;
    free(row);
    free(place);
}

/* All modes of both, eps lambda_max apart at most; the same centre of mass. */
static void order_and_numbers_of_grids_do_not_matter(void **state)
{
    const double angle[] = {240.0, 0.0};
    RITZ_OWN(ritz_component) system = {0}, other = {0};
    RITZ_OWN(ritz_pairs) one = {0}, two = {0};
    ritz_inertia here = {0}, there = {0};

    (void)state;
    if (!store_spacecraft())
        skip();
    assemble(spacecraft, angle, &system);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) body = {0};
        char file[32];

        import(bodies[k], &body);
        disorder(&body);
        snprintf(file, sizeof file, "%s.h5", bodies[k]);
        folder_store(file, &body);
    }
    assemble(spacecraft, angle, &other);
    find_modes(&system, &one);
    find_modes(&other, &two);
    for (int64_t k = RIGID; k < DOFS; k++)
        assert_near(two.lambda[k], one.lambda[k],
                    DBL_EPSILON *
                        (one.lambda[DOFS - 1] + 50.0 * one.lambda[k]));
    assert_ok(ritz_inertia_of(&system, &here));
    assert_ok(ritz_inertia_of(&other, &there));
    for (int k = 0; k < 3; k++)
        assert_near(there.centre[k], here.centre[k],
                    DOFS * DBL_EPSILON * 13.2 /* extent, m */);
}

/* The same, from the platform outwards, one joint seen from its second body. */
static const char inside_out[] =
    "scene: dual-spin spacecraft\n"
    "components:\n"
    "  platform: {model: platform.h5, basis: full}\n"
    "  stator:   {model: stator.h5,   basis: full}\n"
    "  rotor:    {model: rotor.h5,    basis: full}\n"
    "joints:\n"
    "  - {name: clock, between: [rotor/bearing, stator/bearing], type: hinge,"
    " axis: [0, 0, 1]}\n"
    "  - {name: cone, between: [platform/scan, stator/scan], type: hinge,"
    " axis: [0, 1, 0]}\n";

/*
 * Positions and frames of the grids of all bodies follow the joints: then the
 * six overall motions cost nothing. NASTRAN-95 keeps offsets in single
 * precision: measured for the rotor alone, 2.3e-8 of the largest entry of K is
 * left (SOURCE.md), and no more is left here, in whatever axes (sqrt(3)).
 */
static void overall_motions_by_geometry_cost_nothing(void **state)
{
    static const char *const scenes[] = {spacecraft, inside_out};
    const double angle[] = {60.0, 25.0};
    const double origin[3] = {0.0, 0.0, 0.0};

    (void)state;
    if (!store_spacecraft())
        skip();
    for (int s = 0; s < 2; s++) {
        RITZ_OWN(ritz_component) system = {0};
        RITZ_OWN(ritz_dense) R = {0}, KR = {0};
        ritz_inertia inertia = {0};

        assemble(scenes[s], angle, &system);
        assert_ok(ritz_rigid_geometry(&system, origin, &R));
        assert_ok(ritz_sparse_mul(&system.K, &R, &KR));
        assert_true(ritz_dense_max(&R) > 1.0);
        assert_near(ritz_dense_max(&KR), 0.0,
                    2.4e-8 * sqrt(3.0) * ritz_sparse_max(&system.K));
        assert_ok(ritz_inertia_of(&system, &inertia));
        assert_near(inertia.mass, 2068.392 + 536.620 + 102.000, 3.0 * 5e-4);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(spacecraft_has_the_frequencies_of_its_table),
    cmocka_unit_test(sparse_and_dense_assembly_agree),
    cmocka_unit_test(a_hinge_stated_from_both_sides_binds_once),
    cmocka_unit_test(order_and_numbers_of_grids_do_not_matter),
    cmocka_unit_test(overall_motions_by_geometry_cost_nothing),
};

TEST_MODULE(spacecraft, tests, folder_make, folder_remove)
