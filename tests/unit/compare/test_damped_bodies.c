/*
 * Dampers in stage two: two elastic bodies with internal dampers, connected by
 * a hinge with a spring and a damper. Kept modes are exact under every
 * augmentation; their damping is exact only with the static responses to the
 * damper forces.
 */
#include "testing.h"

#include "bodies.h"
#include "compared.h"
#include "scenes.h"

#include "compare/compare.h"

#include <ritz/basis.h>

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <stdio.h>
#include <stdlib.h>

enum { GRIDS = 7, MODES = 12 };

static const char head[] =
    "scene: dampers in bodies and joints\n"
    "components:\n"
    "  A: {model: a.h5, basis: macneal-rubin, modes: 12}\n"
    "  B: {model: b.h5, basis: craig-bampton, modes: 12}\n"
    "joints:\n"
    "  - {name: hinge, between: [A/g7, B/g1], type: hinge, axis: [0, 0, 1],\n"
    "     angles_deg: [0, 50], state: caged, stiffness: 2, damping: 1.5}\n"
    "inputs:\n"
    "  - {name: push, at: A/g7, component: 2}\n"
    "band_hz: [0, 4]\n"
    "select: {by: band}\n";

/* A chain of grids out of line; a damper with a spring acts along y between two
   of them. */
static void damped_chain(int64_t first, const int64_t between[2], double spring,
                         ritz_component *out)
{
    double place[GRIDS][3];

    for (int k = 0; k < GRIDS; k++) {
        place[k][0] = (double)k;
        place[k][1] = k % 2 ? 0.5 : 0.0;
        place[k][2] = k % 3 ? 0.0 : 0.25;
    }
    assert_ok(body_chain(GRIDS, place, 1, (uint64_t)first + 5, out));
    assert_ok(ritz_dampers_new(out->num_dofs, 1, &out->dampers));
    memcpy(out->dampers.name[0], "strut", 6);
    out->dampers.c[0] = 2.0;
    out->dampers.k[0] = spring;
    ritz_dense_col(&out->dampers.B, 0)[6 * between[0] + 1] = 1.0;
    ritz_dense_col(&out->dampers.B, 0)[6 * between[1] + 1] = -1.0;
}

static void reduce_chain(const ritz_component *chain, const char *port,
                         const char *method, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_dofs) attached = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_component_attached(chain, port, &attached));
    request.component = chain;
    request.attached = attached;
    request.modes = MODES;
    assert_ok(ritz_basis_make(ritz_method_find(method), &request, &basis));
    assert_ok(ritz_reduce(chain, &basis, out));
}

static void prepare_sprung(compared *f, const char *choice, double spring)
{
    static const int64_t between[2][2] = {{1, 4}, {2, 5}};
    char text[2048];
    ritz_reduced body[2] = {0};

    *f = (compared){0};
    (void)snprintf(text, sizeof text, "%s%s", head, choice);
    assert_ok(ritz_scene_parse("dampers.yaml", text, &f->scene));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) chain = {0};

        damped_chain(k, between[k], spring, &chain);
        reduce_chain(&chain, k == 0 ? "g7" : "g1", f->scene.component[k].basis,
                     &body[k]);
    }
    assert_ok(ritz_stage_from(&f->scene, body, &f->stage));
    assert_ok(ritz_compare(&f->stage, &f->c));
}

static void prepare(compared *f, const char *choice)
{
    prepare_sprung(f, choice, 0.0);
}

/* Poles of x'' + D x' + Lambda x = 0 above the real axis, by dgeev. */
static int64_t poles_of(const ritz_configuration *c, double _Complex *out)
{
    int64_t n = c->K.ncol, count = 0;
    int size = (int)(2 * n);
    double *A = calloc((size_t)(4 * n * n), sizeof *A);
    double *re = calloc((size_t)size, sizeof *re);
    double *im = calloc((size_t)size, sizeof *im);

    assert_true(A && re && im);
    for (int64_t j = 0; j < n; j++) {
        A[j + (n + j) * 2 * n] = 1.0;
        A[n + j + j * 2 * n] = -c->lambda[j];
        for (int64_t i = 0; i < n; i++)
            A[n + i + (n + j) * 2 * n] = -ritz_dense_col(&c->D, j)[i];
    }
    assert_int_equal(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', size, A, size,
                                   re, im, NULL, 1, NULL, 1),
                     0);
    for (int k = 0; k < size; k++)
        if (im[k] > 0.0)
            out[count++] = re[k] + im[k] * (double _Complex)_Complex_I;
    free(A);
    free(re);
    free(im);
    return count;
}

static double ratio(double _Complex s)
{
    return -creal(s) / cabs(s);
}

static double _Complex nearest(int64_t count, const double _Complex *pole,
                               double _Complex s)
{
    double _Complex best = pole[0];

    for (int64_t k = 1; k < count; k++)
        if (cabs(pole[k] - s) < cabs(best - s))
            best = pole[k];
    return best;
}

/* Largest relative error of a kept mode's damping ratio; the pole nearest to a
   mode is taken for its pole. */
static double worst_damping(const compared *f, int64_t row)
{
    const ritz_configuration *one = &f->c.first_system.configuration[row];
    const ritz_configuration *two = &f->c.second_system.configuration[row];
    double _Complex of_one[128], of_two[128];
    int64_t m = poles_of(one, of_one), n = poles_of(two, of_two);
    double worst = 0.0;

    assert_true(m > 0 && n > 0);
    for (int64_t i = 0; i < f->c.row[row].num_kept; i++) {
        double w = sqrt(one->lambda[one->num_rigid + f->c.row[row].kept[i]]);
        double _Complex s = nearest(m, of_one, w * (double _Complex)_Complex_I);
        double a = ratio(s), b = ratio(nearest(n, of_two, s));

        worst = fmax(worst, fabs(a - b) / fmax(a, b));
    }
    return worst;
}

/* The reported error is the one that an eigenvalue solver finds in both
   systems. */
static void the_error_is_that_of_the_poles(void **state)
{
    compared f;

    (void)state;
    prepare(&f, "augment: {level: system, attached: [inputs]}\n");
    for (int64_t k = 0; k < 2; k++) {
        double worst = worst_damping(&f, k);

        assert_true(f.c.row[k].num_kept >= 3);
        assert_true(worst > 1e-4);
        assert_near(f.c.row[k].damping_error, worst, 1e-6 * worst);
        assert_true(f.c.row[k].frequency_error <= f.c.row[k].allowed);
    }
    assert_true(f.c.row[2].damping_error > 1e-4); /* between the two angles */
    compared_release(&f);
}

static double largest(const compared *f)
{
    return fmax(f->c.row[0].damping_error, f->c.row[1].damping_error);
}

/* At either level, whether dampers are implied by `augment` or listed in
   `attached`. */
static void static_responses_along_dampers_make_damping_right(void **state)
{
    static const struct {
        const char *without, *with, *listed;
    } cases[] = {
        {"augment: {level: system, attached: [inputs]}\n", "augment: system\n",
         "augment: {level: system, attached: [inputs, dampers]}\n"},
        {"augment: {level: component, attached: [inputs]}\n",
         "augment: component\n",
         "augment: {level: component, attached: [inputs, dampers]}\n"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double error = 0.0;
        compared f;

        prepare(&f, cases[k].without);
        error = largest(&f);
        assert_true(error > 1e-4);
        compared_release(&f);
        prepare(&f, cases[k].with);
        assert_true(largest(&f) < 0.05 * error);
        compared_release(&f);
        prepare(&f, cases[k].listed);
        assert_true(largest(&f) < 0.05 * error);
        compared_release(&f);
    }
}

/* One force vector for each body's damper, and one for the hinge's, which turns
   with the hinge. */
static void forces_are_those_of_dampers(void **state)
{
    compared f;

    (void)state;
    prepare(&f, "augment: none\n");
    assert_true(ritz_stage_is_damped(&f.stage));
    for (int64_t k = 0; k < 2; k++) {
        const ritz_configuration *c = &f.c.first_system.configuration[k];
        RITZ_OWN(ritz_dense) F = {0}, D = {0};

        assert_ok(ritz_damper_forces(&f.stage, c, &F));
        assert_int_equal(F.ncol, 3);
        assert_ok(ritz_dense_new(F.nrow, F.nrow, &D));
        for (int64_t d = 0; d < 3; d++) /* D = sum c b b' */
            for (int64_t j = 0; j < F.nrow; j++)
                for (int64_t i = 0; i < F.nrow; i++)
                    ritz_dense_col(&D, j)[i] += (d < 2 ? 2.0 : 1.5) *
                                                ritz_dense_col(&F, d)[i] *
                                                ritz_dense_col(&F, d)[j];
        for (int64_t i = 0; i < F.nrow * F.nrow; i++)
            assert_near(D.val[i], c->D.val[i], 1e-12 * ritz_dense_max(&D));
    }
    compared_release(&f);
}

/* Bodies with dampers have sets with dampers as candidates; test_augment.c has
   the sets of bodies without. */
static void sets_are_tried_with_dampers_too(void **state)
{
    compared f;

    (void)state;
    prepare(&f, "augment: component\n");
    assert_int_equal(f.c.num_candidates, 10);
    assert_string_equal(f.c.candidate[5].name, "dampers");
    assert_string_equal(f.c.candidate[8].name, "inputs, interface, dampers");
    assert_true(f.c.candidate[8].chosen);
    compared_release(&f);
}

/* A body's damper is attached by its name, and adds one coordinate. */
static void a_damper_can_be_attached_by_its_name(void **state)
{
    int64_t total = 0;
    compared f;

    (void)state;
    prepare(&f, "augment: {level: component, attached: [inputs]}\n");
    total = f.c.second.num_coordinates;
    compared_release(&f);
    prepare(&f, "augment: {level: component, attached: [inputs, A/strut]}\n");
    assert_int_equal(f.c.second.num_coordinates, total + 1);
    assert_int_equal(f.c.num_candidates, 11);
    assert_string_equal(f.c.candidate[10].name, "inputs, A/strut");
    assert_true(f.c.candidate[10].chosen);
    compared_release(&f);
}

/* A negative spring makes the system unstable: no mode has a damping ratio, and
   no error of damping is reported. */
static void an_unstable_system_has_no_damping_error(void **state)
{
    compared f;

    (void)state;
    prepare_sprung(&f, "augment: none\n", -1e4);
    assert_true(f.c.first_system.configuration[0].lambda[0] < -1.0);
    for (int64_t k = 0; k < f.c.num_rows; k++)
        assert_true(isnan(f.c.row[k].damping_error));
    compared_release(&f);
}

/* The part of w outside the span of the first `count` columns of V, relative to
   w. */
static double unspanned(const ritz_dense *V, int64_t count, const double *w)
{
    int n = (int)V->nrow, m = (int)count;
    RITZ_OWN(ritz_dense) A = {0};
    double x[64] = {0.0};
    double left = 0.0, all = 0.0;

    assert_true(n <= 64 && m < n);
    assert_ok(ritz_dense_columns(V, 0, count, &A));
    memcpy(x, w, (size_t)n * sizeof *x);
    assert_int_equal(
        LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', n, m, 1, A.val, n, x, n), 0);
    for (int i = 0; i < n; i++) {
        left = i < m ? left : hypot(left, x[i]);
        all = hypot(all, w[i]);
    }
    return left / all;
}

/* Static response of body A, in the full system, to forces along its damper. */
static void static_response_of(const compared *f, double *w)
{
    const ritz_configuration *c = &f->c.first_system.configuration[0];
    RITZ_OWN(ritz_dense) F = {0};

    assert_ok(ritz_damper_forces(&f->stage, c, &F));
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        for (int64_t i = 0; i < c->P[0].nrow; i++)
            w[i] += ritz_dense_col(&c->P[0], k)[i] * F.val[k] / c->lambda[k];
}

/* The search takes modes and static responses before all other directions. */
static void modes_and_static_responses_are_searched_first(void **state)
{
    RITZ_OWN(ritz_composite) composite = {0};
    double w[64] = {0.0};
    int64_t first = 0;
    compared f;

    (void)state;
    prepare(&f, "augment: system\nconfigurations: [{hinge: 0}]\n");
    assert_ok(ritz_composite_new(&f.stage, &composite));
    static_response_of(&f, w);
    first = composite.rigid[0] + f.c.row[0].num_kept;
    assert_true(unspanned(&composite.V[0], first, w) > 1e-3);
    first += f.scene.num_inputs + 3; /* three dampers */
    assert_true(unspanned(&composite.V[0], first, w) < 1e-9);
    compared_release(&f);
}

static void no_allocation_failure_leaks(void **state)
{
    compared f;

    (void)state;
    prepare(&f, "augment: system\n");
    assert_survives_allocations(7, compared_anew(&f.stage));
    compared_release(&f);
}

/*
 * In a plane model a joint has only the motions in the plane, and so have its
 * dampers: D of the system is the sum of c b b' over their force vectors b.
 */
static void dampers_out_of_a_plane_are_no_forces(void **)
{
    static const char text[] =
        "scene: plane\nplane: xy\ncomponents:\n"
        "  A: {model: a.h5, basis: full}\n"
        "  B: {model: b.h5, basis: full}\njoints:\n"
        "  - {name: p, between: [A/g1, B/g1], type: bushing,\n"
        "     stiffness: [1, 1, 1, 1, 1, 1], damping: [1, 2, 3, 4, 5, 6]}\n";
    static const char *const names[] = {"damper 1 of p", "damper 2 of p",
                                        "damper 6 of p"};
    static const double c[] = {1.0, 2.0, 6.0};
    static const int64_t all[] = {0, 1, 2};
    ritz_reduced body[2] = {0};
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) at = {0};
    RITZ_OWN(ritz_unit_forces) forces = {0};
    RITZ_OWN(ritz_dense) B = {0};
    ritz_plan plan = {.forces = &forces, .count = 3, .force = all};

    assert_ok(ritz_scene_parse("plane.yaml", text, &scene));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) link = {0};

        assert_ok(body_link((int64_t[]){1, 2, 6}, 1.0,
                            (double[]){2.0 + k, 0.5, 0.6, 0.2}, &link));
        assert_ok(reduce_with(&link, &ritz_method_full, -1, &body[k]));
    }
    assert_ok(ritz_stage_from(&scene, body, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &at));
    assert_ok(ritz_unit_forces_of_channels(&stage, &forces));
    assert_int_equal(forces.count, 3);
    for (int k = 0; k < 3; k++)
        assert_string_equal(forces.each[k].name, names[k]);
    assert_ok(ritz_plan_system(&stage, &at, &plan, &B));
    for (int64_t j = 0; j < at.D.ncol; j++)
        for (int64_t i = 0; i < at.D.nrow; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < 3; k++)
                sum +=
                    c[k] * ritz_dense_col(&B, k)[i] * ritz_dense_col(&B, k)[j];
            assert_near(ritz_dense_col(&at.D, j)[i], sum,
                        20.0 * DBL_EPSILON * ritz_dense_max(&at.D));
        }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(dampers_out_of_a_plane_are_no_forces),
    cmocka_unit_test(the_error_is_that_of_the_poles),
    cmocka_unit_test(static_responses_along_dampers_make_damping_right),
    cmocka_unit_test(forces_are_those_of_dampers),
    cmocka_unit_test(sets_are_tried_with_dampers_too),
    cmocka_unit_test(a_damper_can_be_attached_by_its_name),
    cmocka_unit_test(an_unstable_system_has_no_damping_error),
    cmocka_unit_test(modes_and_static_responses_are_searched_first),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(damped_bodies, tests, NULL, NULL)
