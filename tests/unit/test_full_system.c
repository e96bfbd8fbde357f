/*
 * The full-order system: the dual-spin spacecraft of data/dualspin, whose
 * frequencies SOURCE.md has from an independent assembly, and beams whose
 * pieces must make up the whole again [McDaniel2000].
 */
#include "testing.h"

#include "frame.h"
#include "scenes.h"

#include <ritz/container.h>
#include <ritz/eigen.h>
#include <ritz/import.h>
#include <ritz/method.h>
#include <ritz/reduced.h>
#include <ritz/synthesis.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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

static char folder[] = "ritz-full-XXXXXX";
static const char *const files[] = {"rotor.h5", "stator.h5", "platform.h5",
                                    "a.h5",     "b.h5",      "c.h5"};

static const char *at(const char *name)
{
    static char path[4][256];
    static int turn = 0;

    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++)
        (void)remove(at(files[k]));
    return rmdir(folder);
}

static void store(const char *file, const ritz_component *component)
{
    const ritz_stamp stamp = {.command = "test"};

    assert_ok(ritz_container_write_component(at(file), component, &stamp));
}

/* Scene of `body` lines and joints; FOLDER in models is that of this run. */
static void parse(const char *text, ritz_scene *out)
{
    assert_ok(ritz_scene_parse("full.yaml", text, out));
    for (int64_t k = 0; k < out->num_components; k++) {
        char *model = strdup(at(out->component[k].model));

        assert_non_null(model);
        free(out->component[k].model);
        out->component[k].model = model;
    }
}

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
    ritz_import_report report = {0};

    snprintf(K, sizeof K, "%s/dualspin/%s.op4:KGG", data, name);
    snprintf(M, sizeof M, "%s/dualspin/%s.op4:MGG", data, name);
    snprintf(bulk, sizeof bulk, "%s/dualspin/%s.bdf", data, name);
    assert_ok(ritz_import(&request, out, &report));
    ritz_import_report_free(&report);
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
        ritz_component body = {0};
        char file[32];

        import(bodies[k], &body);
        snprintf(file, sizeof file, "%s.h5", bodies[k]);
        store(file, &body);
        ritz_component_free(&body);
    }
    return true;
}

static void assemble(const char *text, const double *angle_deg,
                     ritz_component *out)
{
    ritz_scene scene = {0};

    parse(text, &scene);
    assert_ok(ritz_assemble_full(&scene, angle_deg, out));
    ritz_scene_free(&scene);
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
        ritz_component system = {0};
        ritz_pairs pairs = {0};

        assemble(spacecraft, angle, &system);
        assert_int_equal(system.num_dofs, DOFS);
        find_modes(&system, &pairs);
        for (int k = 0; k < MODES; k++)
            assert_near(ritz_eigen_hertz(pairs.lambda[RIGID + k]),
                        published[k][a], 5e-5 /* half a unit */);
        ritz_pairs_free(&pairs);
        ritz_component_free(&system);
    }
}

/* Rounding of both: eps lambda_max, and some operations on each. */
static void sparse_and_dense_assembly_agree(void **state)
{
    const double angle[] = {60.0, 0.0};
    ritz_scene scene = {0};
    ritz_component system = {0};
    ritz_reduced reduced[3] = {0};
    ritz_stage stage = {0};
    ritz_configuration c = {0};
    ritz_pairs pairs = {0};

    (void)state;
    if (!store_spacecraft())
        skip();
    assemble(spacecraft, angle, &system);
    find_modes(&system, &pairs);
    for (int k = 0; k < 3; k++) {
        ritz_component body = {0};

        import(bodies[k], &body);
        assert_ok(reduce_with(&body, &ritz_method_full, -1, &reduced[k]));
        ritz_component_free(&body);
    }
    parse(spacecraft, &scene);
    assert_ok(ritz_stage_from(&scene, reduced, &stage));
    assert_ok(ritz_stage_assemble(&stage, angle, &c));
    assert_int_equal(c.K.ncol, DOFS);
    assert_int_equal(c.num_rigid, RIGID);
    for (int64_t k = RIGID; k < DOFS; k++)
        assert_near(pairs.lambda[k], c.lambda[k],
                    DBL_EPSILON * (c.lambda[DOFS - 1] + 50.0 * c.lambda[k]));
    ritz_configuration_free(&c);
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
    ritz_pairs_free(&pairs);
    ritz_component_free(&system);
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
    ritz_component system = {0}, other = {0};
    ritz_pairs one = {0}, two = {0};
    ritz_inertia here = {0}, there = {0};

    (void)state;
    if (!store_spacecraft())
        skip();
    assemble(spacecraft, angle, &system);
    for (int k = 0; k < 2; k++) {
        ritz_component body = {0};

        import(bodies[k], &body);
        disorder(&body);
        store(files[k], &body);
        ritz_component_free(&body);
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
    ritz_pairs_free(&one);
    ritz_pairs_free(&two);
    ritz_component_free(&system);
    ritz_component_free(&other);
}

/*
 * Positions of the grids of all bodies, turned with their joints, and frames
 * too: then the six overall motions cost nothing. NASTRAN-95 keeps offsets in
 * single precision: measured for the rotor alone, 2.3e-8 of the largest entry
 * of K is left (SOURCE.md), and no more is left here.
 */
static void overall_motions_by_geometry_cost_nothing(void **state)
{
    const double angle[] = {60.0, 0.0};
    const double origin[3] = {0.0, 0.0, 0.0};
    ritz_component system = {0};
    ritz_dense R = {0}, KR = {0};
    ritz_inertia inertia = {0};

    (void)state;
    if (!store_spacecraft())
        skip();
    assemble(spacecraft, angle, &system);
    assert_ok(ritz_rigid_geometry(&system, origin, &R));
    assert_ok(ritz_sparse_mul(&system.K, &R, &KR));
    assert_true(ritz_dense_max(&R) > 1.0);
    assert_near(ritz_dense_max(&KR), 0.0, 2.4e-8 * ritz_sparse_max(&system.K));
    assert_ok(ritz_inertia_of(&system, &inertia));
    assert_near(inertia.mass, 2068.392 + 536.620 + 102.000, 3.0 * 5e-4);
    ritz_dense_free(&R);
    ritz_dense_free(&KR);
    ritz_component_free(&system);
}

/* Elements first..first + count - 1 of the beam of four; a port a node. */
static void store_piece(const char *file, int64_t first, int64_t count)
{
    frame_section section = frame_mcdaniel;
    ritz_component piece = {0};

    section.offset = 0.5 * (double)first;
    assert_ok(frame_component(count, 0.5, &section, first == 0, false, first,
                              &piece));
    for (int64_t node = first; node <= first + count; node++) {
        char name[16];

        snprintf(name, sizeof name, "node%d", (int)node);
        if (node > 0)
            assert_ok(add_port(&piece, name, node));
    }
    store(file, &piece);
    ritz_component_free(&piece);
}

/* oracles.md section 1, table 3.1; half a unit of the last digit */
static void assert_cantilever(const ritz_component *system)
{
    static const double hertz[] = {0.015610, 0.097939, 0.276032, 0.487239,
                                   0.544552, 1.012841, 1.537065, 1.626627,
                                   2.578744, 2.792127, 4.037661, 4.231175};
    const ritz_span all = {.modes = 12};
    ritz_pairs pairs = {0};

    assert_int_equal(system->num_dofs, 12);
    assert_ok(ritz_eigen_sparse(&system->K, &system->M, &all, &pairs));
    assert_int_equal(pairs.Phi.ncol, 12);
    for (int k = 0; k < 12; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[k]), hertz[k], 5e-7);
    ritz_pairs_free(&pairs);
}

static void three_pieces_make_the_cantilever(void **state)
{
    ritz_component system = {0};

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
    ritz_component_free(&system);
}

/* The rank of the constraints counts, not their number. */
static void a_joint_stated_twice_binds_once(void **state)
{
    ritz_component system = {0};

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
    ritz_component_free(&system);
}

/*
 * A with B and C, the two halves of B's and C's common section beyond node 2,
 * joined all round at nodes 2: three joints of rank six. B and C are as stiff
 * and heavy as A's section each, so that they move as the beam does with its
 * outer half doubled; and joined at nodes 3 and 4 too they are that beam.
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
    ritz_component open = {0}, round = {0};
    ritz_pairs one = {0}, two = {0};

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
    ritz_pairs_free(&one);
    ritz_pairs_free(&two);
    ritz_component_free(&open);
    ritz_component_free(&round);
}

/* A port of all four free grids, the last one first if `turned`. */
static void store_whole(const char *file, bool turned, int64_t first_grid)
{
    ritz_component beam = {0};
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
    for (int k = 0; k < 3; k++)
        port->axes[4 * k] = 1.0;
    store(file, &beam);
    ritz_component_free(&beam);
}

/* Twice as stiff, twice as heavy: a beam laid on itself moves as one. */
static void four_grids_pair_by_position(void **state)
{
    ritz_component system = {0};

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
    ritz_component_free(&system);
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
    ritz_scene scene = {0};
    ritz_component body = {0}, none = {0};
    ritz_reduced reduced = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    assert_ok(ritz_container_read_component(at("b.h5"), &body));
    assert_ok(reduce_with(&body, &ritz_method_guyan, -1, &reduced));
    assert_ok(ritz_container_write_reduced(at("b.h5"), &reduced, &stamp));
    parse(halves, &scene);
    assert_fails(ritz_assemble_full(&scene, NULL, &none), RITZ_ERR_ARGUMENT,
                 "b.h5' is reduced already, its full model is wanted");
    ritz_reduced_free(&reduced);
    ritz_component_free(&body);
    ritz_scene_free(&scene);
}

static ritz_status assemble_and_free(const ritz_scene *scene)
{
    ritz_component system = {0};
    ritz_status status = ritz_assemble_full(scene, NULL, &system);

    ritz_component_free(&system);
    return status;
}

static void no_allocation_failure_leaks(void **state)
{
    ritz_scene scene = {0};

    (void)state;
    store_piece("a.h5", 0, 2);
    store_piece("b.h5", 2, 2);
    parse(halves, &scene);
    assert_survives_every_allocation(assemble_and_free(&scene));
    ritz_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spacecraft_has_the_frequencies_of_its_table),
        cmocka_unit_test(sparse_and_dense_assembly_agree),
        cmocka_unit_test(order_and_numbers_of_grids_do_not_matter),
        cmocka_unit_test(overall_motions_by_geometry_cost_nothing),
        cmocka_unit_test(three_pieces_make_the_cantilever),
        cmocka_unit_test(a_joint_stated_twice_binds_once),
        cmocka_unit_test(a_loop_of_joints_closes),
        cmocka_unit_test(four_grids_pair_by_position),
        cmocka_unit_test(a_reduced_model_is_refused),
        cmocka_unit_test(no_allocation_failure_leaks),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
