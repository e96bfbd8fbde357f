/* Modes of a component with its neighbours hung on [BenfieldHruda1971]. */
#include "testing.h"

#include "dualspin.h"
#include "frame.h"
#include "scenes.h"
#include "spring_chain.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { MASSES = 12 };

/* As in test_normal_modes.c, of a shorter chain. */
static const double solve_error = MASSES * DBL_EPSILON * 1e3;

static int64_t tip[] = {MASSES - 1};

typedef struct fixture {
    ritz_component chain;
    double k, m;              /* of what hangs on the tip */
    ritz_neighbour neighbour; /* borrows them */
    ritz_request request;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE, .k = 500.0, .m = 3.0};
    f.neighbour.K = (ritz_dense){1, 1, &f.k};
    f.neighbour.M = (ritz_dense){1, 1, &f.m};
    f.request.component = &f.chain;
    f.request.attached = (ritz_dofs){1, tip};
    f.request.modes = 3;
    f.request.neighbour = &f.neighbour;
    assert_ok(spring_chain(MASSES, false, &f.chain));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    ritz_component_free(&((fixture *)*state)->chain);
    return 0;
}

static void make(const fixture *f, ritz_basis *out)
{
    assert_ok(ritz_basis_make(&ritz_method_loaded_interface, &f->request, out));
}

/* Without anything that hangs on it, they are normal modes. */
static void nothing_hung_on_gives_normal_modes(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) one = {0}, two = {0};

    f->k = f->m = 0.0;
    make(f, &one);
    f->k = 500.0;
    f->m = 3.0;
    f->request.neighbour = NULL;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &f->request, &two));
    f->request.neighbour = &f->neighbour;
    assert_int_equal(one.T.ncol, 3);
    for (int64_t k = 0; k < 3 * MASSES; k++)
        assert_near(one.T.val[k], two.T.val[k], solve_error);
}

/*
 * Mass m on a spring k to the ground, more mass and stiffness hung on it:
 * w^2 = (k + k_n) / (m + m_n), normalised in what all of it weighs.
 */
static void one_mass_takes_up_what_hangs_on_it(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_component) mass = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    int64_t zero = 0;

    assert_ok(spring_chain(1, false, &mass));
    request.component = &mass;
    request.attached = (ritz_dofs){1, &zero};
    request.modes = 1;
    assert_ok(ritz_basis_make(&ritz_method_loaded_interface, &request, &basis));
    assert_near(ritz_eigen_lambda(basis.columns.hertz[0]), 1500.0 / 4.0,
                375.0 * 16 * DBL_EPSILON);
    assert_near(basis.T.val[0], 0.5, 4 * DBL_EPSILON);
    assert_string_equal(basis.origin.reference, "BenfieldHruda1971");
}

/* Phi'(M + E M_n E')Phi = I, and the same of K. */
static void modes_are_orthogonal_in_what_is_loaded(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) KT = {0}, MT = {0}, K = {0}, M = {0};

    make(f, &basis);
    assert_ok(ritz_sparse_mul(&f->chain.K, &basis.T, &KT));
    assert_ok(ritz_sparse_mul(&f->chain.M, &basis.T, &MT));
    assert_ok(ritz_dense_mul_tn(&basis.T, &KT, &K));
    assert_ok(ritz_dense_mul_tn(&basis.T, &MT, &M));
    for (int64_t j = 0; j < 3; j++)
        for (int64_t i = 0; i < 3; i++) {
            double both = ritz_dense_col(&basis.T, j)[MASSES - 1] *
                          ritz_dense_col(&basis.T, i)[MASSES - 1];
            double lambda = ritz_eigen_lambda(basis.columns.hertz[j]);

            assert_near(ritz_dense_col(&M, j)[i] + f->m * both,
                        i == j ? 1.0 : 0.0, solve_error);
            assert_near(ritz_dense_col(&K, j)[i] + f->k * both,
                        i == j ? lambda : 0.0, 4000.0 * solve_error);
        }
}

/* A 2-D beam of `elements`, from x = offset on, with a port at both ends. */
static void beam(int64_t elements, double offset, bool clamp_right,
                 int64_t first_grid, ritz_component *out)
{
    frame_section section = frame_mcdaniel;

    section.offset = offset;
    assert_ok(frame_component(elements, 0.5, &section, false, clamp_right,
                              first_grid, out));
    assert_ok(add_port(out, "left", first_grid));
    if (!clamp_right)
        assert_ok(add_port(out, "right", first_grid + elements));
}

/* `far` hangs by its left port on the right one of `near`. */
static void hang(const ritz_joint *joint, const ritz_component *near,
                 const ritz_component *far, const ritz_dofs *attached,
                 ritz_neighbour *out)
{
    const ritz_joined side[2] = {{"near", near}, {"far", far}};

    assert_ok(ritz_neighbour_new(attached->count, out));
    assert_ok(ritz_joint_neighbour(joint, NULL, side, 0, attached, out));
}

static const ritz_joint fixed = {
    .name = "middle",
    .type = RITZ_JOINT_FIXED,
    .between = {{0, "right"}, {1, "left"}},
};

/*
 * A neighbour of one element that is clamped beyond it has no interior: its
 * condensed matrices are exact, and the loaded modes are those of the whole
 * beam, table 3.4 of [McDaniel2000] but for the free end at the left.
 */
static void modes_with_an_exact_neighbour_are_those_of_the_system(void **state)
{
    RITZ_OWN(ritz_component) whole = {0}, near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) one = {0}, two = {0};

    (void)state;
    beam(4, 0.0, true, 0, &whole);
    beam(3, 0.0, false, 0, &near);
    beam(1, 1.5, true, 3, &far);
    request.modes = 5;
    request.component = &near;
    assert_ok(ritz_component_attached(&near, "right", &request.attached));
    hang(&fixed, &near, &far, &request.attached, &neighbour);
    request.neighbour = &neighbour;
    assert_ok(ritz_basis_make(&ritz_method_loaded_interface, &request, &one));
    ritz_dofs_free(&request.attached);
    request.component = &whole;
    request.neighbour = NULL;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &two));
    for (int64_t k = 0; k < 5; k++)
        assert_near(one.columns.hertz[k], two.columns.hertz[k],
                    1e-9 * two.columns.hertz[k]); /* as in test_synthesis.c */
}

/* A rigid mass of 2 kg with inertia I about its centre, at x = 1 + c. */
static void mass_point(double c, ritz_component *out)
{
    static const int64_t direction[] = {1, 2, 6};
    const double m = 2.0, inertia = 0.3;
    const double M[3][3] = {
        {m, 0, 0}, {0, m, m * c}, {0, m * c, inertia + m * c * c}};
    int64_t row[9], col[9];
    double val[9];

    *out = (ritz_component){.num_dofs = 3, .units = "none"};
    assert_non_null(out->dof = calloc(3, sizeof *out->dof));
    assert_non_null(out->grids.id = calloc(1, sizeof *out->grids.id));
    assert_non_null(out->grids.position = calloc(3, sizeof(double)));
    assert_non_null(out->grids.frame = calloc(1, sizeof *out->grids.frame));
    assert_non_null(out->grids.axes = calloc(9, sizeof(double)));
    out->grids.count = out->grids.num_frames = 1;
    out->grids.id[0] = 9;
    for (int k = 0; k < 3; k++) {
        out->dof[k] = (ritz_dof){9, direction[k]};
        out->grids.axes[4 * k] = 1.0;
    }
    for (int k = 0; k < 9; k++) {
        row[k] = k / 3;
        col[k] = k % 3;
        val[k] = M[k / 3][k % 3];
    }
    assert_ok(ritz_sparse_from_triplets(3, 3, 9, row, col, val, &out->M));
    assert_ok(ritz_component_settle(out, false));
    assert_ok(add_port(out, "left", 9));
}

/*
 * Held in x and y alone, the body turns freely about the port: what it adds is
 * m in x, and in y m less what its rotation yields, (m c)^2 / (I + m c^2).
 * Such is a port with translations only; that frees a rotation as a hinge does.
 */
static void a_motion_that_is_free_follows_by_inertia(void **state)
{
    const double c = 0.4, m = 2.0, turning = 0.3 + 2.0 * 0.4 * 0.4;
    RITZ_OWN(ritz_component) near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(ritz_dofs) attached = {0};

    (void)state;
    beam(2, 0.0, false, 0, &near);
    mass_point(c, &far);
    near.port[1].dofs.count = 2; /* T1 and T2 of the right end */
    assert_ok(ritz_component_attached(&near, "right", &attached));
    hang(&fixed, &near, &far, &attached, &neighbour);
    assert_near(neighbour.M.val[0], m, 8 * DBL_EPSILON);
    assert_near(neighbour.M.val[1], 0.0, 8 * DBL_EPSILON);
    assert_near(neighbour.M.val[3], m - m * c * m * c / turning,
                16 * DBL_EPSILON);
    for (int k = 0; k < 4; k++)
        assert_near(neighbour.K.val[k], 0.0, 0.0);
}

/*
 * The same of a neighbour that is held: cantilever of two elements, stiffness
 * 12 EI/l^3 at its end with the rotation held, 3 EI/l^3 with the rotation free.
 */
static void a_motion_that_is_free_goes_where_energy_is_least(void **state)
{
    const frame_section *s = &frame_mcdaniel;
    const double b = s->modulus * s->inertia; /* EI / l^3, l = 1 */
    RITZ_OWN(ritz_component) near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(ritz_dofs) attached = {0};

    (void)state;
    beam(2, 0.0, false, 0, &near);
    beam(2, 1.0, true, 2, &far);
    near.port[1].dofs.count = 2;
    assert_ok(ritz_component_attached(&near, "right", &attached));
    hang(&fixed, &near, &far, &attached, &neighbour);
    assert_near(neighbour.K.val[3], 3.0 * b, 3.0 * b * 64 * DBL_EPSILON);
    assert_near(neighbour.K.val[0], s->modulus * s->area,
                150.0 * 64 * DBL_EPSILON);
}

/*
 * Masses of 1 and 2 with inertia 0.1 and 0.2 at two grids a length of 1 apart,
 * and no stiffness: a rigid body, all of which hangs on the port of one grid.
 */
static void a_body_without_stiffness_hangs_on_as_a_whole(void **state)
{
    static const double M[6] = {1.0, 1.0, 0.1, 2.0, 2.0, 0.2};
    const int64_t diagonal[6] = {0, 1, 2, 3, 4, 5};
    RITZ_OWN(ritz_component) near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(ritz_dofs) attached = {0};

    (void)state;
    beam(2, 0.0, false, 0, &near);
    beam(1, 1.0, false, 2, &far); /* its elements 0.5 long, moved to 1 */
    far.grids.position[3] = far.port[1].origin[0] = 2.0;
    ritz_sparse_free(&far.K);
    ritz_sparse_free(&far.M);
    assert_ok(
        ritz_sparse_from_triplets(6, 6, 6, diagonal, diagonal, M, &far.M));
    assert_ok(ritz_component_settle(&far, false));
    assert_ok(ritz_component_attached(&near, "right", &attached));
    hang(&fixed, &near, &far, &attached, &neighbour);
    assert_near(ritz_dense_col(&neighbour.M, 0)[0], 3.0, 64 * DBL_EPSILON);
    assert_near(ritz_dense_col(&neighbour.M, 1)[1], 3.0, 64 * DBL_EPSILON);
    assert_near(ritz_dense_col(&neighbour.M, 2)[1], 2.0, 64 * DBL_EPSILON);
    assert_near(ritz_dense_col(&neighbour.M, 2)[2], 2.3, 64 * DBL_EPSILON);
    assert_near(ritz_dense_max(&neighbour.K), 0.0, 0.0);
}

static const char pair[] =
    "scene: pair\n"
    "components:\n"
    "  stator: {model: s.h5, basis: full}\n"
    "  platform: {model: p.h5, basis: full}\n"
    "joints:\n"
    "  - {name: cone, between: [stator/scan, platform/scan], type: hinge,\n"
    "     axis: [0, 1, 0], angles_deg: [30]}\n";

/* The pair joined, in all its dofs. */
static void join(const ritz_scene *scene, const ritz_joined side[2],
                 ritz_configuration *c)
{
    ritz_reduced body[2] = {0};
    RITZ_OWN(ritz_stage) stage = {0};

    for (int k = 0; k < 2; k++)
        assert_ok(
            reduce_with(side[k].component, &ritz_method_full, -1, &body[k]));
    assert_ok(ritz_stage_from(scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, scene->setting, c));
}

/* Twelve modes of the first with the second hung on. */
static void load(const ritz_scene *scene, const ritz_joined side[2],
                 ritz_basis *out)
{
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = side[0].component;
    request.modes = 12;
    assert_ok(
        ritz_component_attached(side[0].component, "scan", &request.attached));
    assert_ok(ritz_neighbour_new(6, &neighbour));
    assert_ok(ritz_joint_neighbour(&scene->joint[0], scene->setting, side, 0,
                                   &request.attached, &neighbour));
    request.neighbour = &neighbour;
    assert_ok(ritz_basis_make(&ritz_method_loaded_interface, &request, out));
    ritz_dofs_free(&request.attached);
}

/*
 * The stator of the spacecraft with the platform, which is rigid, on the cone
 * hinge: exactly what the platform is to it. Assembled with the platform, its
 * loaded modes are the modes of the pair, which has one more rigid mode, the
 * turn of the hinge.
 */
static void a_rigid_body_on_a_hinge_is_an_exact_neighbour(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_component) stator = {0}, platform = {0};
    const ritz_joined side[2] = {{"stator", &stator}, {"platform", &platform}};
    RITZ_OWN(ritz_basis) loaded = {0};
    RITZ_OWN(ritz_configuration) c = {0};

    (void)state;
    dualspin_or_skip();
    assert_ok(ritz_scene_parse("pair.yaml", pair, &scene));
    assert_ok(dualspin_component(1, &stator));
    assert_ok(dualspin_component(2, &platform));
    load(&scene, side, &loaded);
    join(&scene, side, &c);
    assert_int_equal(c.num_rigid, 7);
    for (int64_t k = 0; k < 12; k++) {
        double exact = ritz_eigen_hertz(c.lambda[7 + k]);

        /* rounding of the assembled system: eps lambda_max / lambda_k */
        assert_near(loaded.columns.hertz[6 + k], exact,
                    exact * DBL_EPSILON * 100.0 * c.lambda[c.K.ncol - 1] /
                        c.lambda[7 + k]);
    }
}

static void requests_without_a_neighbour_are_refused(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    ritz_basis none = {0};
    double two[4] = {0};
    const ritz_neighbour wide = {{2, 2, two}, {2, 2, two}};

    request.neighbour = NULL;
    assert_fails(
        ritz_basis_make(&ritz_method_loaded_interface, &request, &none),
        RITZ_ERR_ARGUMENT, "it is not said what hangs on");
    request.neighbour = &wide;
    assert_fails(
        ritz_basis_make(&ritz_method_loaded_interface, &request, &none),
        RITZ_ERR_ARGUMENT, "has 2 dofs, 1 are attached");
    assert_fails(ritz_basis_make(&ritz_method_normal_modes, &request, &none),
                 RITZ_ERR_ARGUMENT, "loads nothing on its interface");
    request.attached = (ritz_dofs){0};
    assert_fails(
        ritz_basis_make(&ritz_method_loaded_interface, &request, &none),
        RITZ_ERR_ARGUMENT, "nothing is attached");
}

static void a_port_that_is_not_attached_is_refused(void **state)
{
    RITZ_OWN(ritz_component) near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(ritz_dofs) attached = {0};
    ritz_joint joint = fixed;
    ritz_joined side[2];

    (void)state;
    beam(2, 0.0, false, 0, &near);
    beam(2, 1.0, false, 2, &far);
    side[0] = (ritz_joined){"near", &near};
    side[1] = (ritz_joined){"far", &far};
    assert_ok(ritz_component_attached(&near, "left", &attached));
    assert_ok(ritz_neighbour_new(3, &neighbour));
    assert_fails(
        ritz_joint_neighbour(&joint, NULL, side, 0, &attached, &neighbour),
        RITZ_ERR_ARGUMENT, "grid 2 T1 of port 'right' is not attached");
    snprintf(joint.between[1].port, RITZ_NAME_SIZE, "lift");
    assert_fails(
        ritz_joint_neighbour(&joint, NULL, side, 0, &attached, &neighbour),
        RITZ_ERR_ARGUMENT, "far: there is no port 'lift', is 'left' meant?");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_component) near = {0}, far = {0};
    RITZ_OWN(ritz_neighbour) neighbour = {0};
    RITZ_OWN(ritz_dofs) attached = {0};
    ritz_joined side[2];

    assert_survives_every_allocation(
        ritz_method_loaded_interface.make(&f->request, &basis));
    beam(2, 0.0, false, 0, &near);
    beam(2, 1.0, false, 2, &far);
    near.port[1].dofs.count = 2;
    side[0] = (ritz_joined){"near", &near};
    side[1] = (ritz_joined){"far", &far};
    assert_ok(ritz_component_attached(&near, "right", &attached));
    assert_ok(ritz_neighbour_new(2, &neighbour));
    assert_survives_every_allocation(
        ritz_joint_neighbour(&fixed, NULL, side, 0, &attached, &neighbour));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing_hung_on_gives_normal_modes),
    cmocka_unit_test(one_mass_takes_up_what_hangs_on_it),
    cmocka_unit_test(modes_are_orthogonal_in_what_is_loaded),
    cmocka_unit_test(modes_with_an_exact_neighbour_are_those_of_the_system),
    cmocka_unit_test(a_motion_that_is_free_follows_by_inertia),
    cmocka_unit_test(a_motion_that_is_free_goes_where_energy_is_least),
    cmocka_unit_test(a_body_without_stiffness_hangs_on_as_a_whole),
    cmocka_unit_test(a_rigid_body_on_a_hinge_is_an_exact_neighbour),
    cmocka_unit_test(requests_without_a_neighbour_are_refused),
    cmocka_unit_test(a_port_that_is_not_attached_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(loaded_interface, tests, set_up, tear_down)
