/*
 * Bodies in floating frames: a chain of grids that turn, and a cube of masses
 * that do not, with bases of arbitrary columns that hold the rigid motions.
 * Everything is summed again over the grids.
 */
#include "testing.h"

#include "base/vector.h"
#include "fixtures/free_bodies.h"
#include "fixtures/matrices.h"
#include "fixtures/project.h"
#include "model/floating.h"

/* Psi = T V - R W, with R as positions give it. */
static void shape_directly(const ritz_component *body,
                           const ritz_reduced *reduced, const ritz_floating *f,
                           ritz_dense *Psi)
{
    static const double origin[3];
    RITZ_OWN(ritz_dense) R = {0}, RW = {0};

    assert_ok(ritz_rigid_geometry(body, origin, &R));
    assert_ok(ritz_dense_mul(&R, &f->W, &RW));
    assert_ok(ritz_dense_mul(&reduced->T, &f->V, Psi));
    ritz_dense_add(-1.0, &RW, Psi);
}

/* 4500 eps: sums of some hundred terms, in a basis whose condition is 10 */
static const double rounding = 1e-12;

/* Compare K, M, shapes and momenta with those of the full matrices. */
static void check_matrices(const ritz_component *body,
                           const ritz_reduced *reduced, const ritz_floating *f)
{
    RITZ_OWN(ritz_dense) Psi = {0}, R = {0}, MPsi = {0}, P = {0}, A = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, rigid = {0};

    shape_directly(body, reduced, f, &Psi);
    for (int64_t j = 0; j < Psi.ncol; j++)
        for (int64_t i = 0; i < body->num_dofs; i++) {
            const int64_t c = body->dof[i].component - 1;
            const int64_t at = 3 * (body->dof[i].grid - FREE_FIRST) + c % 3;

            assert_near(ritz_dense_col(c < 3 ? &f->shape : &f->turn, j)[at],
                        ritz_dense_col(&Psi, j)[i],
                        rounding * ritz_dense_max(&Psi));
        }
    K = project(&body->K, &Psi);
    M = project(&body->M, &Psi);
    assert_near_dense(&f->K, &K, rounding);
    assert_near_dense(&f->M, &M, rounding);
    assert_ok(ritz_rigid_geometry(body, f->origin, &R));
    assert_ok(ritz_sparse_mul(&body->M, &Psi, &MPsi));
    assert_ok(ritz_dense_mul_tn(&R, &MPsi, &P));
    for (int64_t k = 0; k < 6 * P.ncol; k++)
        assert_near(f->invariants.momentum.val[k], P.val[k],
                    rounding * ritz_dense_max(&MPsi) * 100.0);
    A = project(&body->M, &R);
    rigid = (ritz_dense){6, 6, NULL};
    assert_ok(ritz_dense_copy(&A, &rigid));
    memcpy(rigid.val, f->invariants.rigid, sizeof f->invariants.rigid);
    assert_near_dense(&rigid, &A, rounding);
}

/* int (theta x rho)_b rho dm for a node that mode k turns by theta: W S. */
static void turn_moment(const ritz_floating *f, int64_t node, int64_t k,
                        double S[3][3], double out[3][3])
{
    for (int d = 0; d < 3; d++) {
        double turned[3] = {0.0};

        if (f->turn.val)
            ritz_cross(ritz_dense_col(&f->turn, k) + 3 * node, S[d], turned);
        for (int b = 0; b < 3; b++)
            out[b][d] = turned[b];
    }
}

/* One node adds m x u' + S W' to the positions and m u u' + W S W' to the
   products; S is symmetric. */
static void add_node(const ritz_component *body, const ritz_floating *f,
                     int64_t node, ritz_dense *X, ritz_dense *P)
{
    const int64_t m = f->V.ncol;
    const double mass = free_mass(body, node);
    double S[3][3], WS[3][3], turned[3];

    free_moment(body, node, S);
    for (int64_t k = 0; k < m; k++) {
        const double *u = ritz_dense_col(&f->shape, k) + 3 * node;

        turn_moment(f, node, k, S, WS);
        for (int b = 0; b < 3; b++)
            for (int a = 0; a < 3; a++)
                ritz_dense_col(X, b * m + k)[a] +=
                    mass * f->position[3 * node + a] * u[b] + WS[b][a];
        for (int64_t j = 0; j < m; j++)
            for (int b = 0; b < 3; b++) {
                const double *v = ritz_dense_col(&f->shape, j) + 3 * node;

                memset(turned, 0, sizeof turned);
                if (f->turn.val)
                    ritz_cross(ritz_dense_col(&f->turn, j) + 3 * node, WS[b],
                               turned);
                for (int a = 0; a < 3; a++)
                    ritz_dense_col(P, b * m + k)[a * m + j] +=
                        mass * v[a] * u[b] + turned[a];
            }
    }
}

/* int x_a v_b dm and int v_a v_b dm as sums over nodes, each a rigid body. */
static void check_sums(const ritz_component *body, const ritz_floating *f)
{
    const int64_t m = f->V.ncol;
    RITZ_OWN(ritz_dense) X = {0}, P = {0};

    assert_ok(ritz_dense_new(3, 3 * m, &X));
    assert_ok(ritz_dense_new(3 * m, 3 * m, &P));
    for (int64_t i = 0; i < f->count; i++)
        add_node(body, f, i, &X, &P);
    assert_near_dense(&f->invariants.position, &X, rounding);
    assert_near_dense(&f->invariants.product, &P, rounding);
    assert_near(f->approximate, 0.0, rounding);
}

static const ritz_floating_request requests[] = {
    {NULL, NULL},        {"centre", "none"},     {"13", "none"},
    {"13", "mean-axis"}, {"basic", "mean-axis"}, {"centre", "mean-axis"},
};

static void check_body(const ritz_component *body, const ritz_reduced *reduced,
                       const ritz_floating_request *request)
{
    RITZ_OWN(ritz_floating) f = {0};

    assert_ok(ritz_floating_of(reduced, request, &f));
    assert_int_equal(f.V.ncol, FREE_FLEXIBLE);
    assert_int_equal(f.num_rigid, 6);
    check_matrices(body, reduced, &f);
    check_sums(body, &f);
}

static void terms_of_a_chain_are_sums_over_its_grids(void **state)
{
    (void)state;
    const ritz_floating_request tangent = {"15", "tangent"};

    for (int mixed = 0; mixed < 2; mixed++) {
        RITZ_OWN(ritz_component) body = {0};
        RITZ_OWN(ritz_reduced) reduced = {0};

        assert_ok(free_chain(mixed > 0, &body, &reduced));
        for (size_t k = 0; k < sizeof requests / sizeof *requests; k++)
            check_body(&body, &reduced, &requests[k]);
        check_body(&body, &reduced, &tangent);
    }
}

static void terms_of_a_box_are_sums_over_its_grids(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) others = {0};
    RITZ_OWN(ritz_floating) f = {0};
    uint64_t seed = 17;

    assert_ok(free_box(&body));
    assert_ok(ritz_dense_new(body.num_dofs, FREE_FLEXIBLE, &others));
    free_fill(&seed, &others);
    assert_ok(free_reduce(&body, &others, true, &reduced));
    for (size_t k = 0; k < sizeof requests / sizeof *requests; k++)
        check_body(&body, &reduced, &requests[k]);
    assert_ok(ritz_floating_of(&reduced, &requests[0], &f));
    assert_null(f.turn.val);
    assert_near(f.approximate, 0.0, rounding);
}

static void a_tangent_frame_holds_its_node(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) f = {0};
    const ritz_floating_request tangent = {"12", "tangent"};

    assert_ok(free_chain(true, &body, &reduced));
    assert_ok(ritz_floating_of(&reduced, &tangent, &f));
    assert_int_equal(f.grid, 12);
    for (int64_t j = 0; j < FREE_FLEXIBLE; j++)
        for (int a = 0; a < 3; a++) {
            const double most = ritz_dense_col_max(&f.shape, j);

            assert_near(f.position[3 + a], 0.0, 0.0);
            assert_near(ritz_dense_col(&f.shape, j)[3 + a], 0.0,
                        rounding * most);
            assert_near(ritz_dense_col(&f.turn, j)[3 + a], 0.0,
                        rounding * most);
        }
}

static void mean_axes_have_no_momentum(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) f = {0};
    const ritz_floating_request mean = {"15", "mean-axis"};

    assert_ok(free_chain(false, &body, &reduced));
    assert_ok(ritz_floating_of(&reduced, &mean, &f));
    assert_true(f.kept);
    /* masses near 1 at places near 10 */
    for (int64_t k = 0; k < 6 * FREE_FLEXIBLE; k++)
        assert_near(f.invariants.momentum.val[k], 0.0,
                    100.0 * rounding * ritz_dense_max(&f.shape));
}

/* K - 2 lambda M phi phi'M: the second flexible mode gets -lambda. */
static ritz_status make_unstable(ritz_reduced *reduced, double *hertz)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) MPhi = {0};

    RITZ_CHECK(ritz_eigen_dense(&reduced->K, &reduced->M, &pairs));
    RITZ_CHECK(ritz_dense_mul(&reduced->M, &pairs.Phi, &MPhi));
    for (int64_t j = 0; j < MPhi.nrow; j++)
        for (int64_t i = 0; i < MPhi.nrow; i++)
            ritz_dense_col(&reduced->K, j)[i] -= 2.0 * pairs.lambda[7] *
                                                 ritz_dense_col(&MPhi, 7)[i] *
                                                 ritz_dense_col(&MPhi, 7)[j];
    hertz[0] = ritz_eigen_hertz(pairs.lambda[7]);
    hertz[1] = ritz_eigen_hertz(pairs.lambda[9]);
    return RITZ_OK;
}

/* Rigid motions of an indefinite stiffness come behind negative eigenvalues. */
static void an_unstable_body_leaves_its_rigid_motions_to_the_frame(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) f = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double hertz[2] = {0.0};

    assert_ok(free_chain(true, &body, &reduced));
    assert_ok(make_unstable(&reduced, hertz));
    assert_ok(ritz_floating_of(&reduced, &requests[0], &f));
    assert_int_equal(f.num_rigid, 6);
    assert_int_equal(f.V.ncol, FREE_FLEXIBLE);
    assert_near(f.lowest_hz, -hertz[0], 1e-9 * hertz[0]);
    assert_near(f.highest_hz, hertz[1], 1e-9 * hertz[1]);
    assert_ok(ritz_eigen_dense(&f.K, &f.M, &pairs));
    assert_near(ritz_eigen_hertz(pairs.lambda[0]), -hertz[0], 1e-9 * hertz[0]);
}

static ritz_status convert_unstable(void)
{
    ritz_component body = {0};
    ritz_reduced reduced = {0};
    ritz_floating f = {0};
    double hertz[2];
    ritz_status status = free_chain(true, &body, &reduced);

    if (status == RITZ_OK)
        status = make_unstable(&reduced, hertz);
    if (status == RITZ_OK)
        status = ritz_floating_of(&reduced, &requests[0], &f);
    ritz_floating_free(&f);
    ritz_reduced_free(&reduced);
    ritz_component_free(&body);
    return status;
}

static ritz_status convert(void *unused)
{
    const ritz_floating_request request = {"13", "tangent"};
    ritz_component body = {0};
    ritz_reduced reduced = {0};
    ritz_floating f = {0};
    ritz_status status = free_chain(true, &body, &reduced);

    (void)unused;
    if (status == RITZ_OK)
        status = ritz_floating_of(&reduced, &request, &f);
    ritz_floating_free(&f);
    ritz_reduced_free(&reduced);
    ritz_component_free(&body);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(convert(NULL));
    assert_survives_every_allocation(convert_unstable());
}

static void frames_that_do_not_exist_are_refused(void **state)
{
    (void)state;
    static const struct {
        ritz_floating_request request;
        const char *words;
    } list[] = {
        {{"99", NULL}, "a frame at grid 99: there is no such grid"},
        {{"hub", NULL}, "and 'hub' is none of these"},
        {{"11-12", NULL}, "and '11-12' is none of these"},
        {{NULL, "clamped"}, "unknown reference condition 'clamped'"},
        {{NULL, "tangent"}, "a tangent frame is at a grid"},
        {{"centre", "tangent"}, "a tangent frame is at a grid"},
    };
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    assert_ok(free_chain(true, &body, &reduced));
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        RITZ_OWN(ritz_floating) f = {0};

        assert_fails(ritz_floating_of(&reduced, &list[k].request, &f),
                     RITZ_ERR_ARGUMENT, list[k].words);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(terms_of_a_chain_are_sums_over_its_grids),
    cmocka_unit_test(terms_of_a_box_are_sums_over_its_grids),
    cmocka_unit_test(a_tangent_frame_holds_its_node),
    cmocka_unit_test(mean_axes_have_no_momentum),
    cmocka_unit_test(frames_that_do_not_exist_are_refused),
    cmocka_unit_test(an_unstable_body_leaves_its_rigid_motions_to_the_frame),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(floating, tests, NULL, NULL)
