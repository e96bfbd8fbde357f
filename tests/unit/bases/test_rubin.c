/* What is kept of residual flexibility: macneal, rubin, inertia-relief. */
#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "project.h"
#include "scenes.h"
#include "spring_chain.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/response.h>
#include <ritz/verify.h>

#include <lapacke.h>

#include <float.h>

static const ritz_estimate_request usual = {0};

enum { ELEMENTS = 16, DOFS = ELEMENTS + 1, MODES = 4, ATTACHED = 3 };

/* Rounding of a solve: the condition number of the bar is (2 / pi h)^2. */
static const double solve_error = DOFS * DBL_EPSILON * ELEMENTS * ELEMENTS;

static int64_t attached[] = {0, 5, DOFS - 1};

typedef struct fixture {
    ritz_component bar;
    ritz_request request;
    ritz_basis reference; /* macneal-rubin */
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.bar;
    f.request.attached = (ritz_dofs){ATTACHED, attached};
    f.request.modes = MODES;
    assert_ok(bar_component(ELEMENTS, &f.bar));
    assert_ok(
        ritz_basis_make(&ritz_method_macneal_rubin, &f.request, &f.reference));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->bar);
    ritz_basis_free(&f->reference);
    return 0;
}

/* All eigenvalues of a component in a subspace. */
static void solve(const ritz_component *component, const ritz_dense *T,
                  ritz_pairs *out)
{
    RITZ_OWN(ritz_dense) K = project(&component->K, T);
    RITZ_OWN(ritz_dense) M = project(&component->M, T);

    assert_ok(ritz_eigen_dense(&K, &M, out));
}

/*
 * One subspace has one set of eigenvalues, to eps times the largest, about 12
 * elements^2 of the bar, and the condition of T'MT: of an attachment mode
 * (lambda_1 / lambda_5)^2 is residual, 1 / 625.
 */
static void all_span_what_macneal_rubin_does(void **state)
{
    const ritz_method *const same_span[] = {&ritz_method_rubin,
                                            &ritz_method_inertia_relief};
    fixture *f = *state;
    RITZ_OWN(ritz_pairs) expected = {0};

    solve(&f->bar, &f->reference.T, &expected);
    for (int n = 0; n < 2; n++) {
        RITZ_OWN(ritz_basis) basis = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};

        assert_ok(ritz_basis_make(same_span[n], &f->request, &basis));
        solve(&f->bar, &basis.T, &pairs);
        assert_int_equal(pairs.Phi.ncol, 1 + MODES + ATTACHED);
        assert_int_equal(pairs.num_rigid, 1);
        for (int64_t k = 0; k < pairs.Phi.ncol; k++)
            assert_near(pairs.lambda[k], expected.lambda[k],
                        625.0 * DBL_EPSILON * 12.0 * ELEMENTS * ELEMENTS);
    }
}

/* The attached displacements are coordinates: T(b, :) = [I, 0] exactly. */
static void rubin_keeps_the_attached_dofs(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_basis_make(&ritz_method_rubin, &f->request, &basis));
    assert_int_equal(basis.T.ncol, ATTACHED + 1 + MODES);
    for (int64_t j = 0; j < basis.T.ncol; j++) {
        for (int64_t i = 0; i < ATTACHED; i++)
            assert_near(ritz_dense_col(&basis.T, j)[attached[i]],
                        i == j ? 1.0 : 0.0, 0.0);
        assert_int_equal(basis.columns.kind[j], j < ATTACHED
                                                    ? RITZ_COLUMN_CONSTRAINT
                                                    : RITZ_COLUMN_NORMAL);
        assert_int_equal(basis.columns.dof[j], j < ATTACHED ? attached[j] : -1);
    }
    assert_true(isnan(basis.columns.hertz[ATTACHED]));
    for (int64_t k = 1; k <= MODES; k++) {
        double exact = ritz_eigen_hertz(bar_eigenvalue(ELEMENTS, k));

        assert_near(basis.columns.hertz[ATTACHED + k], exact,
                    solve_error * exact);
    }
}

/*
 * A unit force at x = 0 of the free bar of mass and stiffness 1 gives it the
 * acceleration 1 and the shape u'' = 1, u'(0) = -1: u = x^2/2 - x + c. Nodes of
 * linear elements are exact, and c makes the mean of what lies between them
 * zero, whose integral is h^2/12 more than -1/3.
 */
static void an_end_force_bends_the_bar_into_a_parabola(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    const double h = 1.0 / ELEMENTS;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = 0;
    assert_ok(ritz_basis_make(&ritz_method_inertia_relief, &request, &basis));
    assert_int_equal(basis.T.ncol, 1 + ATTACHED);
    assert_int_equal(basis.columns.kind[1], RITZ_COLUMN_ATTACHMENT);
    assert_int_equal(basis.columns.dof[1], 0);
    for (int64_t i = 0; i < DOFS; i++) {
        double x = (double)i * h;

        assert_near(ritz_dense_col(&basis.T, 1)[i],
                    0.5 * x * x - x + 1.0 / 3.0 - h * h / 12.0, solve_error);
    }
}

/* The columns of attachment are the same however many modes stand beside. */
static void attachment_modes_do_not_depend_on_the_modes(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) one = {0}, two = {0};

    assert_ok(ritz_basis_make(&ritz_method_inertia_relief, &request, &one));
    request.modes = 0;
    assert_ok(ritz_basis_make(&ritz_method_inertia_relief, &request, &two));
    for (int64_t j = 0; j < ATTACHED; j++)
        for (int64_t i = 0; i < DOFS; i++)
            assert_near(ritz_dense_col(&one.T, 1 + MODES + j)[i],
                        ritz_dense_col(&two.T, 1 + j)[i], solve_error);
}

/* Of a body that is held, attachment modes are columns of K^-1. */
static void of_a_held_body_they_are_static_shapes(void **state)
{
    enum { MASSES = 6 };
    int64_t tip[] = {MASSES - 1};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    double u = 0.0;

    assert_ok(spring_chain(MASSES, false, &chain));
    request.component = &chain;
    request.attached = (ritz_dofs){1, tip};
    request.modes = 2;
    assert_ok(ritz_basis_make(&ritz_method_inertia_relief, &request, &basis));
    for (int64_t i = 0; i < MASSES; i++) {
        u += 1.0 / spring_chain_stiffness(i);
        assert_near(ritz_dense_col(&basis.T, 2)[i], u, solve_error * u);
    }
}

static void reduce(const fixture *f, const ritz_method *method,
                   ritz_reduced *out)
{
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_basis_make(method, &f->request, &basis));
    assert_ok(ritz_reduce(&f->bar, &basis, out));
    assert_ok(ritz_estimate(&f->bar, &basis, &usual, out));
}

/* Flexibility stays, inertia goes: K as of macneal-rubin, M of the modes. */
static void macneal_leaves_out_the_mass_of_residual_columns(void **state)
{
    enum { KEPT = 1 + MODES };
    fixture *f = *state;
    RITZ_OWN(ritz_reduced) with = {0}, without = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    reduce(f, &ritz_method_macneal_rubin, &with);
    reduce(f, &ritz_method_macneal, &without);
    assert_memory_equal(with.K.val, without.K.val,
                        sizeof(double[KEPT + ATTACHED][KEPT + ATTACHED]));
    for (int64_t j = 0; j < without.M.ncol; j++)
        for (int64_t i = 0; i < without.M.nrow; i++) {
            bool kept = i < KEPT && j < KEPT;

            assert_true(ritz_dense_col(&without.M, j)[i] ==
                        (kept ? ritz_dense_col(&with.M, j)[i] : 0.0));
        }
    assert_int_equal(without.columns.kind[KEPT], RITZ_COLUMN_MASSLESS);
    assert_int_equal(without.columns.dof[KEPT + 1], attached[1]);
    assert_ok(ritz_eigen_dense(&without.K, &without.M, &pairs));
    assert_int_equal(pairs.Phi.ncol, KEPT); /* no others */
    for (int64_t k = 1; k < KEPT; k++)
        assert_near(pairs.lambda[k], bar_eigenvalue(ELEMENTS, k),
                    solve_error * bar_eigenvalue(ELEMENTS, k));
}

/* Rows and columns of D that belong to residual columns go as those of M. */
static void macneal_leaves_out_their_damping_too(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(ritz_sparse_copy(&f->bar.K, &f->bar.D));
    reduce(f, &ritz_method_macneal, &reduced);
    for (int64_t j = 1 + MODES; j < reduced.D.ncol; j++)
        for (int64_t i = 0; i < reduced.D.nrow; i++)
            assert_true(ritz_dense_col(&reduced.D, j)[i] == 0.0 &&
                        ritz_dense_col(&reduced.D, i)[j] == 0.0);
    assert_true(ritz_dense_col(&reduced.D, 1)[1] > 1.0);
    ritz_sparse_free(&f->bar.D);
}

/*
 * Motions without mass answer statically. The reduced model is verified against
 * the full one: modes exact, gain exact, and the response short of
 * (w / w_5)^2 times the residual, w_5 the first mode left out: 0.5 of it at
 * the fourth mode, itself a small part of the peaks.
 */
static void macneal_answers_statically_what_it_left_out(void **state)
{
    fixture *f = *state;
    ritz_verify_request request = RITZ_VERIFY_NONE;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    assert_ok(frame_io(&f->bar, 1, attached, 2, attached + 1));
    reduce(f, &ritz_method_macneal, &reduced);
    request.damping = (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    assert_ok(verify_reduced(&f->bar, &reduced, &request, &found));
    for (int64_t k = 0; k < found.count; k++) {
        const ritz_measure *m = &found.item[k];

        if (strcmp(m->name, "static-gain-relative") == 0)
            assert_near(m->value, 0.0, 10.0 * solve_error);
        if (strcmp(m->name, "frequency-relative") == 0)
            assert_near(m->value, 0.0, solve_error);
        if (strcmp(m->name, "response-relative") == 0)
            assert_near(m->value, 0.0, 1e-4); /* measured 3e-5 */
        if (strcmp(m->name, "missing-modes") == 0)
            assert_near(m->value, 0.0, 0.0);
    }
    assert_true(found.count > 4);
    ritz_io_free(&f->bar.io);
    assert_ok(ritz_io_new(DOFS, 0, 0, &f->bar.io));
}

/* Body `which` of the two halves of the beam, by a method with 3 modes. */
static void half(const ritz_stage *stage, int which, ritz_dense *Phi_b,
                 ritz_dense *F, double *lambda)
{
    const ritz_reduced *body = &stage->body[which];
    const ritz_dense *map = &body->port[0].map;
    int64_t k = body->K.ncol - 3;

    assert_ok(ritz_dense_columns(map, 0, k, Phi_b));
    assert_ok(ritz_dense_new(3, 3, F)); /* F'Psi */
    for (int64_t j = 0; j < 3; j++)
        for (int64_t i = 0; i < 3; i++)
            ritz_dense_col(F, j)[i] = ritz_dense_col(map, k + j)[i];
    for (int64_t j = 0; j < k; j++)
        lambda[j] = ritz_dense_col(&body->K, j)[j];
}

/*
 * MacNeal's own formula: the joint is a spring of the residual flexibilities,
 *
 *     K = diag(Lambda_A, Lambda_B) + C' (F_A + F_B)^-1 C,
 *     C = [Phi_A, -Phi_B] at the interface,   M = I
 */
static void by_the_book(const ritz_stage *stage, ritz_pairs *out)
{
    ritz_dense Phi[2] = {{0}}, F[2] = {{0}}, K = {0}, M = {0}, C = {0}, X = {0};
    double lambda[16];
    int64_t k = 0;

    for (int b = 0; b < 2; b++) {
        half(stage, b, &Phi[b], &F[b], lambda + k);
        k += Phi[b].ncol;
    }
    assert_ok(ritz_dense_new(3, k, &C));
    for (int64_t j = 0; j < k; j++)
        for (int64_t i = 0; i < 3; i++)
            ritz_dense_col(&C, j)[i] =
                j < Phi[0].ncol ? ritz_dense_col(&Phi[0], j)[i]
                                : -ritz_dense_col(&Phi[1], j - Phi[0].ncol)[i];
    for (int n = 0; n < 9; n++)
        F[0].val[n] += F[1].val[n];
    assert_ok(ritz_dense_copy(&C, &X));
    assert_int_equal(
        LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', 3, (int)k, F[0].val, 3, X.val, 3),
        0);
    assert_ok(ritz_dense_mul_tn(&C, &X, &K));
    assert_ok(ritz_dense_new(k, k, &M));
    for (int64_t j = 0; j < k; j++) {
        ritz_dense_col(&K, j)[j] += lambda[j];
        ritz_dense_col(&M, j)[j] = 1.0;
    }
    ritz_dense_symmetrise(&K);
    assert_ok(ritz_eigen_dense(&K, &M, out));
    for (int b = 0; b < 2; b++) {
        ritz_dense_free(&Phi[b]);
        ritz_dense_free(&F[b]);
    }
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_dense_free(&C);
    ritz_dense_free(&X);
}

/* cond(K) of the 12-dof beam is 4e4, eps of that and of a cond(F) of 1e3 */
static const double system_error = 1e-8;

static void macneal_joins_bodies_as_its_formula_says(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_pairs) expected = {0};

    (void)state;
    assert_ok(scene_of_two_beams(false, &scene));
    assert_ok(stage_of_two_beams(&scene, &ritz_method_macneal, 3, &stage));
    assert_ok(ritz_stage_assemble(&stage, NULL, &c));
    by_the_book(&stage, &expected);
    assert_int_equal(c.rank, 3);
    assert_int_equal(c.K.ncol, 9);
    assert_int_equal(expected.Phi.ncol, 9);
    for (int64_t k = 0; k < 9; k++)
        assert_near(c.lambda[k], expected.lambda[k],
                    system_error * expected.lambda[k]);
}

/* The two halves by a method, 2 modes each; Hz by SciPy, nine decimals. */
static const struct published {
    const ritz_method *method;
    double hertz[5];
} joined[] = {
    {&ritz_method_macneal,
     {0.015610283, 0.097967883, 0.276116186, 0.538041909, 0.551199855}},
    {&ritz_method_rubin,
     {0.015610247, 0.097938534, 0.276032271, 0.488548192, 0.544552076}},
    {&ritz_method_inertia_relief,
     {0.015610247, 0.097938534, 0.276032271, 0.488548192, 0.544552076}},
};

static void systems_of_two_halves_are_those_of_scipy(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof joined / sizeof *joined; n++) {
        RITZ_OWN(ritz_scene) scene = {0};
        RITZ_OWN(ritz_stage) stage = {0};
        RITZ_OWN(ritz_configuration) c = {0};

        assert_ok(scene_of_two_beams(false, &scene));
        assert_ok(stage_of_two_beams(&scene, joined[n].method, 2, &stage));
        assert_ok(ritz_stage_assemble(&stage, NULL, &c));
        for (int64_t k = 0; k < 5; k++)
            assert_near(ritz_eigen_hertz(c.lambda[k]), joined[n].hertz[k],
                        5e-10 + system_error);
    }
}

/* Both stages of COMPARE take bodies with a singular mass. */
static void compare_takes_bodies_without_full_mass(void **state)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_comparison) comparison = {0};

    (void)state;
    assert_ok(scene_of_two_beams(false, &scene));
    scene.band_hz[1] = 0.4;
    assert_ok(stage_of_two_beams(&scene, &ritz_method_macneal, 3, &stage));
    assert_ok(ritz_compare(&stage, &comparison));
    assert_int_equal(comparison.row[0].num_kept, 3);
    assert_near(comparison.row[0].frequency_error, 0.0, system_error);
}

/*
 * Projected once more, what is made of massless columns alone stays without
 * mass, though rounding mixes 1e-10 of a mode into it; a hundredth is no
 * rounding.
 */
static void without_mass_stays_without_mass(void **state)
{
    enum { R = 1 + MODES + ATTACHED };
    fixture *f = *state;
    RITZ_OWN(ritz_reduced) reduced = {0}, second = {0};
    RITZ_OWN(ritz_dense) V = {0};

    reduce(f, &ritz_method_macneal, &reduced);
    assert_ok(ritz_dense_new(R, 2, &V));
    for (int64_t j = 0; j < 2; j++)
        ritz_dense_col(&V, j)[R - 1 - j] = 1.0;
    ritz_dense_col(&V, 0)[2] = 1e-10;
    ritz_dense_col(&V, 1)[2] = 1e-2;
    assert_ok(ritz_reduced_project(&reduced, &V, &second));
    assert_true(second.M.val[0] == 0.0);
    assert_true(second.M.val[1] == 0.0 && second.M.val[2] == 0.0);
    assert_near(second.M.val[3], 1e-4, 1e-4 * solve_error);
}

/*
 * With all modes of finite frequency kept, what a dof without mass answers has
 * no mass either, but for rounding: the reduced body has the same modes.
 */
static void residual_modes_of_massless_dofs_have_no_mass(void **state)
{
    enum { MASSES = 12 };
    int64_t end[] = {MASSES - 1};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(spring_chain(MASSES, true, &chain));
    chain.M.val[MASSES - 1] = 0.0;
    request.component = &chain;
    request.attached = (ritz_dofs){1, end};
    request.modes = MASSES;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, MASSES);
    assert_int_equal(basis.columns.kind[MASSES - 1], RITZ_COLUMN_RESIDUAL);
    assert_ok(ritz_reduce(&chain, &basis, &reduced));
    assert_true(ritz_dense_col(&reduced.M, MASSES - 1)[MASSES - 1] == 0.0);
    assert_ok(ritz_eigen_dense(&reduced.K, &reduced.M, &pairs));
    assert_int_equal(pairs.Phi.ncol, MASSES - 1);
    assert_int_equal(pairs.num_rigid, 1);
    for (int64_t k = 1; k < MASSES - 1; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[k]), basis.columns.hertz[k],
                    solve_error * basis.columns.hertz[k]);
}

/*
 * Two flexible modes are left out for three attached dofs: one of them is no
 * coordinate. With all modes kept none is, and the modes are what there is.
 */
static void dofs_that_cannot_be_coordinates_are_named(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    ritz_basis basis = {0};

    request.modes = DOFS - 3;
    assert_ok(ritz_basis_make(&ritz_method_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, DOFS);
    assert_non_null(strstr(basis.remark, "1 attached dof(s) are no "
                                         "coordinates, grid "));
    ritz_basis_free(&basis);
    request.modes = DOFS - 1;
    assert_ok(ritz_basis_make(&ritz_method_rubin, &request, &basis));
    assert_int_equal(basis.T.ncol, DOFS);
    assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_RIGID);
    assert_non_null(strstr(basis.remark, "3 attached dof(s) are no "
                                         "coordinates, grid 1 T1, grid 6 T1, "
                                         "grid 17 T1"));
    ritz_basis_free(&basis);
}

/* Every dof attached, no flexible mode: of 17 residual columns 16 are new. */
static void all_dofs_may_be_attached(void **state)
{
    const ritz_method *const methods[] = {
        &ritz_method_rubin, &ritz_method_inertia_relief, &ritz_method_macneal};
    ritz_request request = ((fixture *)*state)->request;
    int64_t all[DOFS];

    for (int64_t i = 0; i < DOFS; i++)
        all[i] = i;
    request.attached = (ritz_dofs){DOFS, all};
    request.modes = 0;
    for (int n = 0; n < 3; n++) {
        RITZ_OWN(ritz_basis) basis = {0};

        assert_ok(ritz_basis_make(methods[n], &request, &basis));
        assert_int_equal(basis.T.ncol, DOFS);
        assert_true(basis.remark[0] != '\0');
    }
}

/* Without attached dofs there are modes alone, whatever the method. */
static void nothing_need_be_attached(void **state)
{
    const ritz_method *const methods[] = {
        &ritz_method_rubin, &ritz_method_inertia_relief, &ritz_method_macneal,
        &ritz_method_dual_craig_bampton};
    ritz_request request = ((fixture *)*state)->request;

    request.attached = (ritz_dofs){0};
    for (int n = 0; n < 4; n++) {
        RITZ_OWN(ritz_basis) basis = {0};

        assert_ok(ritz_basis_make(methods[n], &request, &basis));
        assert_int_equal(basis.T.ncol, 1 + MODES);
        assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_RIGID);
        assert_string_equal(basis.remark, "");
    }
}

static void bad_requests_are_refused(void **state)
{
    const ritz_method *const methods[] = {
        &ritz_method_rubin, &ritz_method_inertia_relief, &ritz_method_macneal};
    int64_t twice[] = {4, 4}, beyond[] = {DOFS};

    for (int n = 0; n < 3; n++) {
        ritz_request request = ((fixture *)*state)->request;
        ritz_basis none = {0};

        request.attached = (ritz_dofs){2, twice};
        assert_fails(ritz_basis_make(methods[n], &request, &none),
                     RITZ_ERR_ARGUMENT, "listed twice");
        request.attached = (ritz_dofs){1, beyond};
        assert_int_equal(ritz_basis_make(methods[n], &request, &none),
                         RITZ_ERR_ARGUMENT);
        request.modes = -1;
        assert_fails(ritz_basis_make(methods[n], &request, &none),
                     RITZ_ERR_ARGUMENT, "either a number of modes");
    }
}

static void no_allocation_failure_leaks(void **state)
{
    const ritz_method *const methods[] = {&ritz_method_rubin,
                                          &ritz_method_inertia_relief};
    fixture *f = *state;
    ritz_basis basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) gain = {0};

    for (int n = 0; n < 2; n++) {
        assert_survives_every_allocation(methods[n]->make(&f->request, &basis));
        ritz_basis_free(&basis);
    }
    assert_ok(ritz_basis_make(&ritz_method_macneal, &f->request, &basis));
    assert_survives_every_allocation(ritz_reduce(&f->bar, &basis, &reduced));
    assert_survives_every_allocation(
        ritz_static_gain(&reduced.K, &reduced.M, &reduced.io, 0, &gain));
    ritz_basis_free(&basis);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_span_what_macneal_rubin_does),
    cmocka_unit_test(rubin_keeps_the_attached_dofs),
    cmocka_unit_test(an_end_force_bends_the_bar_into_a_parabola),
    cmocka_unit_test(attachment_modes_do_not_depend_on_the_modes),
    cmocka_unit_test(of_a_held_body_they_are_static_shapes),
    cmocka_unit_test(macneal_leaves_out_the_mass_of_residual_columns),
    cmocka_unit_test(macneal_leaves_out_their_damping_too),
    cmocka_unit_test(macneal_answers_statically_what_it_left_out),
    cmocka_unit_test(macneal_joins_bodies_as_its_formula_says),
    cmocka_unit_test(systems_of_two_halves_are_those_of_scipy),
    cmocka_unit_test(compare_takes_bodies_without_full_mass),
    cmocka_unit_test(without_mass_stays_without_mass),
    cmocka_unit_test(residual_modes_of_massless_dofs_have_no_mass),
    cmocka_unit_test(dofs_that_cannot_be_coordinates_are_named),
    cmocka_unit_test(all_dofs_may_be_attached),
    cmocka_unit_test(nothing_need_be_attached),
    cmocka_unit_test(bad_requests_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(rubin, tests, set_up, tear_down)
