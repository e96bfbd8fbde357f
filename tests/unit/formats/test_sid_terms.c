/*
 * The terms of a Standard Input Data file equal sums over point masses that
 * follow the nodes of the file, and together with the six motions of the frame
 * they give the mass and stiffness of the body.
 */
#include "testing.h"

#include "base/vector.h"
#include "folder.h"
#include "moving_body.h"
#include "sid_file.h"

#include <float.h>

static void write_and_read(const moving_body *f, const char *frame,
                           const char *reference, sid_file *out)
{
    const char *path = folder_path("body.SID_FEM");

    moving_body_write(f, &ritz_exporter_sid, path, frame, reference);
    sid_file_read(path, out);
}

/* ---- sums over points --------------------------------------------------- */

static void collect_points(const moving_body *f, const sid_file *file,
                           moving_point *out)
{
    moving_node node[MOVING_GRIDS] = {0};

    for (int64_t i = 0; i < MOVING_GRIDS; i++) {
        const sid_node *of = &file->node[i];

        for (int a = 0; a < 3; a++) {
            node[i].x[a] = sid_m0(&of->at[SID_ORIGIN], a, 0);
            for (int k = 0; k < MOVING_MODES; k++) {
                node[i].phi[k][a] = sid_m0(&of->at[SID_PHI], a, k);
                node[i].psi[k][a] = sid_m0(&of->at[SID_PSI], a, k);
            }
        }
    }
    moving_body_points(f, node, out);
}

/* Entry (i, j) of m0 + sum of m1_k q_k. */
static double value_at(const sid_taylor *t, int64_t i, int64_t j,
                       const double *q)
{
    double sum = sid_m0(t, i, j);

    for (int64_t k = 0; k < t->nq; k++)
        sum += sid_m1(t, i, k, j) * q[k];
    return sum;
}

static void check_rigid(const sid_file *f, const moving_point *n,
                        const double *q)
{
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2},
                                 {0, 1}, {0, 2}, {1, 2}};
    double mass = 0.0, moment[3] = {0}, J[6] = {0}, change[6] = {0};

    for (int i = 0; i < MOVING_POINTS; i++) {
        const double *x = n[i].x;
        double u[3];

        moving_velocity(&n[i], q, u);
        mass += n[i].m;
        for (int a = 0; a < 3; a++)
            moment[a] += n[i].m * (x[a] + u[a]);
        for (int e = 0; e < 6; e++) {
            int a = at[e][0];
            int b = at[e][1];

            J[e] += n[i].m * ((a == b ? ritz_dot(x, x) : 0.0) - x[a] * x[b]);
            change[e] += n[i].m * ((a == b ? 2.0 * ritz_dot(x, u) : 0.0) -
                                   x[a] * u[b] - u[a] * x[b]);
        }
    }
    assert_near(f->mass, mass, moving_rounding);
    for (int a = 0; a < 3; a++)
        assert_near(value_at(&f->of[SID_MDCM], a, 0, q), moment[a],
                    moving_rounding);
    for (int e = 0; e < 6; e++) {
        assert_near(sid_m0(&f->of[SID_J], e, 0), J[e], moving_rounding);
        assert_near(value_at(&f->of[SID_J], e, 0, q), J[e] + change[e],
                    moving_rounding);
    }
}

/* Ct = sum m u, Cr = sum m r x u, Me = sum m u.u */
static void check_couplings(const sid_file *f, const moving_point *n,
                            const double *q)
{
    for (int k = 0; k < MOVING_MODES; k++) {
        double Ct[3] = {0}, Cr[3] = {0}, Me[MOVING_MODES] = {0};

        for (int i = 0; i < MOVING_POINTS; i++) {
            double r[3], moment[3];

            moving_place(&n[i], q, r);
            ritz_cross(r, n[i].u[k], moment);
            for (int a = 0; a < 3; a++) {
                Ct[a] += n[i].m * n[i].u[k][a];
                Cr[a] += n[i].m * moment[a];
            }
            for (int l = 0; l < MOVING_MODES; l++)
                Me[l] += n[i].m * ritz_dot(n[i].u[k], n[i].u[l]);
        }
        for (int a = 0; a < 3; a++) {
            assert_near(sid_m0(&f->of[SID_CT], k, a), Ct[a], moving_rounding);
            assert_near(value_at(&f->of[SID_CR], k, a, q), Cr[a],
                        moving_rounding);
        }
        for (int l = 0; l < MOVING_MODES; l++)
            assert_near(sid_m0(&f->of[SID_ME], k, l), Me[l], moving_rounding);
    }
}

/* Ge(q') w + Oe(q) W = sum m u . (2 w x u q' + w x (w x r)) */
static void check_mode_force(const sid_file *f, const moving_point *n,
                             const moving_motion *at)
{
    const double *w = at->w;
    const double W[6] = {w[0] * w[0], w[1] * w[1], w[2] * w[2],
                         w[0] * w[1], w[1] * w[2], w[0] * w[2]};

    for (int k = 0; k < MOVING_MODES; k++) {
        double force = 0.0;

        for (int64_t l = 0; l < MOVING_MODES; l++)
            for (int a = 0; a < 3; a++)
                force +=
                    sid_m0(&f->of[SID_GE], k, 3 * l + a) * at->rate[l] * w[a];
        for (int e = 0; e < 6; e++)
            force += value_at(&f->of[SID_OE], k, e, at->q) * W[e];
        assert_near(force, moving_force(n, k, at), 10.0 * moving_rounding);
    }
}

/* Gr(q') w = sum of 2 x x (w x m u') at q = 0 */
static void check_torque(const sid_file *f, const moving_point *n,
                         const moving_motion *at)
{
    double torque[3] = {0}, stated[3] = {0};

    for (int i = 0; i < MOVING_POINTS; i++) {
        double v[3], wv[3], xwv[3];

        moving_velocity(&n[i], at->rate, v);
        ritz_cross(at->w, v, wv);
        ritz_cross(n[i].x, wv, xwv);
        for (int a = 0; a < 3; a++)
            torque[a] += 2.0 * n[i].m * xwv[a];
    }
    for (int a = 0; a < 3; a++) {
        for (int64_t l = 0; l < MOVING_MODES; l++)
            for (int b = 0; b < 3; b++)
                stated[a] += sid_m0(&f->of[SID_GR], a, 3 * l + b) *
                             at->rate[l] * at->w[b];
        assert_near(stated[a], torque[a], 10.0 * moving_rounding);
    }
}

static void check_sums(const moving_body *f, const char *frame,
                       const char *reference)
{
    const moving_motion *at = &moving_example;
    RITZ_OWN(sid_file) file = {0};
    moving_point n[MOVING_POINTS] = {0};

    write_and_read(f, frame, reference, &file);
    assert_int_equal(file.num_modes, MOVING_MODES);
    collect_points(f, &file, n);
    check_rigid(&file, n, at->q);
    check_couplings(&file, n, at->q);
    check_mode_force(&file, n, at);
    check_torque(&file, n, at);
}

static void terms_are_sums_over_points(void **state)
{
    check_sums(*state, NULL, NULL);
    check_sums(*state, "centre", "mean-axis");
    check_sums(*state, "22", NULL);
    check_sums(*state, "basic", "none");
}

/* Oe(q) W is minus the derivative of the kinetic energy w'J(q)w / 2, which is
   quadratic in q: its central difference of any step is exact. */
static void centrifugal_forces_are_derivatives_of_energy(void **state)
{
    const double *w = moving_example.w;
    moving_motion at = moving_example;
    double *q = at.q;
    const double W[6] = {w[0] * w[0], w[1] * w[1], w[2] * w[2],
                         w[0] * w[1], w[1] * w[2], w[0] * w[2]};
    RITZ_OWN(sid_file) file = {0};
    moving_point n[MOVING_POINTS] = {0};

    write_and_read(*state, NULL, NULL, &file);
    collect_points(*state, &file, n);
    for (int k = 0; k < MOVING_MODES; k++) {
        double energy[2] = {0}, force = 0.0, middle = q[k];

        for (int side = 0; side < 2; side++) {
            q[k] = middle + (side ? 1.0 : -1.0);
            for (int i = 0; i < MOVING_POINTS; i++) {
                double r[3], wr[3];

                moving_place(&n[i], q, r);
                ritz_cross(w, r, wr);
                energy[side] += n[i].m * ritz_dot(wr, wr) / 2.0;
            }
        }
        q[k] = middle;
        for (int e = 0; e < 6; e++)
            force += value_at(&file.of[SID_OE], k, e, q) * W[e];
        assert_near(force, -(energy[1] - energy[0]) / 2.0,
                    10.0 * moving_rounding);
    }
}

/* ---- frames ------------------------------------------------------------- */

/* M and K of the body that the file describes, in six motions of the frame and
   its modes: M = [m, -c~, Ct'; c~, J, Cr'; Ct, Cr, Me], c = mdCM; K has Ke. */
static void assemble(const sid_file *f, ritz_dense *K, ritz_dense *M)
{
    const int64_t m = f->num_modes;
    static const int of_J[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    double c[3];

    assert_ok(ritz_dense_new(6 + m, 6 + m, K));
    assert_ok(ritz_dense_new(6 + m, 6 + m, M));
    for (int a = 0; a < 3; a++) {
        c[a] = sid_m0(&f->of[SID_MDCM], a, 0);
        ritz_dense_col(M, a)[a] = f->mass;
        for (int b = 0; b < 3; b++)
            ritz_dense_col(M, 3 + a)[3 + b] =
                sid_m0(&f->of[SID_J], of_J[a][b], 0);
        for (int64_t k = 0; k < m; k++) {
            ritz_dense_col(M, 6 + k)[a] = sid_m0(&f->of[SID_CT], k, a);
            ritz_dense_col(M, 6 + k)[3 + a] = sid_m0(&f->of[SID_CR], k, a);
            ritz_dense_col(M, a)[6 + k] = sid_m0(&f->of[SID_CT], k, a);
            ritz_dense_col(M, 3 + a)[6 + k] = sid_m0(&f->of[SID_CR], k, a);
        }
    }
    for (int b = 0; b < 3; b++) {
        const double unit[3] = {b == 0, b == 1, b == 2};
        double moved[3]; /* c x e_b */

        ritz_cross(c, unit, moved);
        for (int a = 0; a < 3; a++) {
            ritz_dense_col(M, b)[3 + a] = moved[a];
            ritz_dense_col(M, 3 + a)[b] = moved[a];
        }
    }
    for (int64_t k = 0; k < m; k++)
        for (int64_t l = 0; l < m; l++) {
            ritz_dense_col(M, 6 + l)[6 + k] = sid_m0(&f->of[SID_ME], k, l);
            ritz_dense_col(K, 6 + l)[6 + k] = sid_m0(&f->of[SID_KE], k, l);
        }
}

/* The eigenvalues of the file's body do not depend on the frame: six are zero,
   the others are those of the reduced component. */
static void a_free_body_vibrates_as_the_component(void **state)
{
    const moving_body *f = *state;
    static const char *const of[][2] = {{NULL, NULL},
                                        {"centre", "mean-axis"},
                                        {"22", "tangent"},
                                        {"24", NULL},
                                        {"basic", "none"}};
    RITZ_OWN(ritz_pairs) expected = {0};

    assert_ok(ritz_eigen_dense(&f->reduced.K, &f->reduced.M, &expected));
    assert_int_equal(expected.num_rigid, 6);
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        RITZ_OWN(sid_file) file = {0};
        RITZ_OWN(ritz_dense) K = {0}, M = {0};
        RITZ_OWN(ritz_pairs) pairs = {0};

        write_and_read(f, of[i][0], of[i][1], &file);
        assemble(&file, &K, &M);
        assert_ok(ritz_eigen_dense(&K, &M, &pairs));
        assert_int_equal(pairs.num_rigid, 6);
        /* ten times eps cond(M) lambda_max, with cond(M) below 1e3 */
        for (int64_t k = 6; k < 6 + MOVING_MODES; k++)
            assert_near(pairs.lambda[k], expected.lambda[k],
                        1e4 * DBL_EPSILON * expected.lambda[5 + MOVING_MODES]);
    }
}

static void references_hold(void **state)
{
    const moving_body *f = *state;
    RITZ_OWN(sid_file) mean = {0}, tangent = {0};

    write_and_read(f, "centre", NULL, &mean);
    assert_non_null(strstr(mean.comment, "reference mean-axis"));
    for (int k = 0; k < MOVING_MODES; k++)
        for (int a = 0; a < 3; a++) {
            assert_near(sid_m0(&mean.of[SID_CT], k, a), 0.0, moving_rounding);
            assert_near(sid_m0(&mean.of[SID_CR], k, a), 0.0, moving_rounding);
            assert_near(sid_m0(&mean.of[SID_MDCM], a, 0), 0.0, moving_rounding);
        }
    write_and_read(f, "22", NULL, &tangent);
    assert_non_null(strstr(tangent.comment, "reference tangent"));
    for (int k = 0; k < MOVING_MODES; k++)
        for (int a = 0; a < 3; a++) {
            const sid_node *node = &tangent.node[1];

            assert_true(sid_m0(&node->at[SID_ORIGIN], a, 0) == 0.0);
            assert_near(sid_m0(&node->at[SID_PHI], a, k), 0.0, moving_rounding);
            assert_near(sid_m0(&node->at[SID_PSI], a, k), 0.0, moving_rounding);
        }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(terms_are_sums_over_points),
    cmocka_unit_test(centrifugal_forces_are_derivatives_of_energy),
    cmocka_unit_test(a_free_body_vibrates_as_the_component),
    cmocka_unit_test(references_hold),
};

TEST_MODULE(sid_terms, tests, moving_body_set_up, moving_body_tear_down)
