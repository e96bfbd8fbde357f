/*
 * Inertia terms of simulators: those of point masses by their definitions, for
 * MBDyn as its manual writes them, for SID by the forces that a motion of the
 * frame brings.
 */
#include "testing.h"

#include "base/vector.h"
#include "model/inertia_terms.h"

#include <float.h>

enum { NODES = 3, MODES = 2 };

static const double masses[NODES] = {2.0, 3.0, 0.5};
static const double places[NODES][3] = {
    {1.0, -2.0, 0.5}, {4.0, 1.0, -1.5}, {-2.0, 0.25, 3.0}};
static const double origin[3] = {0.5, -1.0, 0.75};
/* rounding of sums of a dozen terms below 1000 */
static const double rounding = 1e5 * DBL_EPSILON;

/* Motion of node i along axis a in mode k; all numbers are distinct. */
static double shape(int64_t k, int64_t i, int a)
{
    return (double)(1 + 5 * k * k - 7 * i * i + (3 + k) * a * a + i * a) / 8.0;
}

static ritz_status make_masses(ritz_component *out)
{
    int64_t row[3 * NODES];
    double m[3 * NODES];
    const int64_t id[NODES] = {11, 12, 15};
    const int64_t frame[NODES] = {0};
    const double basic[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    ritz_grids *grids = &out->grids;

    out->num_dofs = 3 * NODES;
    RITZ_CHECK_NEW(out->dof, 3 * NODES);
    for (int i = 0; i < 3 * NODES; i++) {
        out->dof[i] = (ritz_dof){id[i / 3], 1 + i % 3};
        m[i] = masses[i / 3];
        row[i] = i;
    }
    RITZ_CHECK(ritz_sparse_from_triplets(3 * NODES, 3 * NODES, 3 * NODES, row,
                                         row, m, &out->M));
    grids->count = NODES;
    grids->num_frames = 1;
    RITZ_CHECK_COPY(grids->id, id, NODES);
    RITZ_CHECK_COPY(grids->frame, frame, NODES);
    RITZ_CHECK_COPY(grids->axes, basic, 9);
    RITZ_CHECK_NEW(grids->position, 3 * NODES);
    memcpy(grids->position, places, sizeof places);
    return ritz_component_settle(out, false);
}

/* Invariants of the modes, and M_r. */
static ritz_status make_body(ritz_invariants *invariants, ritz_dense *M)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_dense) T = {0};

    RITZ_CHECK(make_masses(&body));
    RITZ_CHECK(ritz_dense_new(3 * NODES, MODES, &T));
    for (int64_t k = 0; k < MODES; k++)
        for (int64_t i = 0; i < NODES; i++)
            for (int a = 0; a < 3; a++)
                ritz_dense_col(&T, k)[3 * i + a] = shape(k, i, a);
    RITZ_CHECK(ritz_invariants_of(&body, &T, invariants));
    return ritz_sparse_condense(&body.M, &T, M);
}

typedef double matrix[3][3];

static void skew(const double *v, matrix S)
{
    const matrix of = {
        {0.0, -v[2], v[1]}, {v[2], 0.0, -v[0]}, {-v[1], v[0], 0.0}};

    memcpy(S, of, sizeof of);
}

/* A += m B~ C~, or m B~ C~' */
static void add_skews(double m, const double *b, const double *c, matrix A)
{
    matrix B, C;

    skew(b, B);
    skew(c, C);
    for (int p = 0; p < 3; p++)
        for (int q = 0; q < 3; q++)
            for (int r = 0; r < 3; r++)
                A[p][q] += m * B[p][r] * C[r][q];
}

static void take_shape(int64_t k, int64_t i, double u[3])
{
    for (int a = 0; a < 3; a++)
        u[a] = shape(k, i, a);
}

static void take_arm(int64_t i, double f[3])
{
    for (int a = 0; a < 3; a++)
        f[a] = places[i][a] - origin[a];
}

/* sum m f~ f~' and sum m f~ u_j~' are those with factor -1 of add_skews. */
static void assert_matrix(const ritz_dense *A, int64_t col, const matrix E,
                          double factor)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            assert_near(ritz_dense_col(A, col + b)[a], factor * E[a][b],
                        rounding);
}

static void assert_pair(const ritz_mbdyn_terms *t, int64_t j, int64_t k)
{
    matrix I9 = {{0}};
    double I5[3] = {0};

    for (int64_t i = 0; i < NODES; i++) {
        double u[3], v[3];

        take_shape(j, i, u);
        take_shape(k, i, v);
        add_skews(masses[i], u, v, I9);
        for (int a = 0; a < 3; a++)
            I5[a] += masses[i] * (u[(a + 1) % 3] * v[(a + 2) % 3] -
                                  u[(a + 2) % 3] * v[(a + 1) % 3]);
    }
    assert_matrix(&t->I9, 3 * (j * MODES + k), I9, 1.0);
    for (int a = 0; a < 3; a++)
        assert_near(ritz_dense_col(&t->I5, j * MODES + k)[a], I5[a], rounding);
}

static void assert_mode(const ritz_mbdyn_terms *t, int64_t j)
{
    matrix I8 = {{0}};
    double I3[3] = {0}, I4[3] = {0};

    for (int64_t i = 0; i < NODES; i++) {
        double f[3], u[3];

        take_arm(i, f);
        take_shape(j, i, u);
        add_skews(masses[i], f, u, I8);
        for (int a = 0; a < 3; a++) {
            I3[a] += masses[i] * u[a];
            I4[a] += masses[i] * (f[(a + 1) % 3] * u[(a + 2) % 3] -
                                  f[(a + 2) % 3] * u[(a + 1) % 3]);
        }
    }
    assert_matrix(&t->I8, 3 * j, I8, -1.0);
    for (int a = 0; a < 3; a++) {
        assert_near(ritz_dense_col(&t->I3, j)[a], I3[a], rounding);
        assert_near(ritz_dense_col(&t->I4, j)[a], I4[a], rounding);
    }
}

static void terms_of_mbdyn_are_the_sums_of_its_manual(void **state)
{
    (void)state;
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_dense) M = {0};
    RITZ_OWN(ritz_mbdyn_terms) t = {0};
    matrix I7 = {{0}};
    double I2[3] = {0};

    assert_ok(make_body(&invariants, &M));
    assert_ok(ritz_mbdyn_terms_of(&invariants, &M, origin, &t));
    for (int64_t i = 0; i < NODES; i++) {
        double f[3];

        take_arm(i, f);
        add_skews(masses[i], f, f, I7);
        for (int a = 0; a < 3; a++)
            I2[a] += masses[i] * f[a];
    }
    assert_near(t.I1, 5.5, rounding);
    for (int a = 0; a < 3; a++) {
        assert_near(t.I2[a], I2[a], rounding);
        for (int b = 0; b < 3; b++)
            assert_near(t.I7[3 * a + b], -I7[a][b], rounding);
    }
    for (int64_t j = 0; j < MODES; j++) {
        assert_mode(&t, j);
        for (int64_t k = 0; k < MODES; k++)
            assert_pair(&t, j, k);
    }
    assert_memory_equal(t.I6.val, M.val, sizeof(double) * MODES * MODES);
}

/* m0 + sum_k q_k m1_k */
static double value_of(const ritz_taylor *t, const double *q, int64_t i,
                       int64_t j)
{
    double sum = ritz_dense_col(&t->m0, j)[i];

    for (int64_t k = 0; t->m1.val && k < MODES; k++)
        sum += q[k] * ritz_dense_col(&t->m1, k * t->m0.ncol + j)[i];
    return sum;
}

/* The motion of the frame and of the modes at one instant. */
static const double a0[3] = {0.5, -1.25, 2.0}, w[3] = {0.75, -0.5, 1.5},
                    wdot[3] = {-2.0, 0.25, 1.0};
static const double q[MODES] = {0.25, -0.5}, qdot[MODES] = {1.5, 0.75},
                    qddot[MODES] = {-0.25, 2.0};

/* p = x + u, and p'' = a0 + wdot x p + w x (w x p) + 2 w x u' + u''. */
static void accelerate(int64_t i, double p[3], double out[3])
{
    double du[3] = {0}, t[3], s[3], c[3], g[3];

    take_arm(i, p);
    for (int a = 0; a < 3; a++) {
        out[a] = a0[a];
        for (int64_t k = 0; k < MODES; k++) {
            p[a] += q[k] * shape(k, i, a);
            du[a] += qdot[k] * shape(k, i, a);
            out[a] += qddot[k] * shape(k, i, a);
        }
    }
    ritz_cross(wdot, p, t);
    ritz_cross(w, p, s);
    ritz_cross(w, s, c);
    ritz_cross(w, du, g);
    for (int a = 0; a < 3; a++)
        out[a] += t[a] + c[a] + 2.0 * g[a];
}

/* mdCM~ a0 + J w' + Cr' q'' + Gr(q') w + w~ J w */
static void turn_by_sid(const ritz_sid_terms *t, double out[3])
{
    static const int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    double md[3], Jw[3] = {0}, gyro[3];

    for (int a = 0; a < 3; a++)
        md[a] = value_of(&t->mdCM, q, a, 0);
    ritz_cross(md, a0, out);
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++) {
            const double J = value_of(&t->J, q, at[a][b], 0);

            out[a] += J * wdot[b];
            Jw[a] += J * w[b];
            for (int64_t l = 0; l < MODES; l++)
                out[a] += value_of(&t->Gr, q, a, 3 * l + b) * qdot[l] * w[b];
        }
        for (int64_t l = 0; l < MODES; l++)
            out[a] += value_of(&t->Cr, q, l, a) * qddot[l];
    }
    ritz_cross(w, Jw, gyro);
    for (int a = 0; a < 3; a++)
        out[a] += gyro[a];
}

/* Ct a0 + Cr w' + Me q'' + Ge(q') w + Oe W */
static double force_by_sid(const ritz_sid_terms *t, int64_t l)
{
    const double W[6] = {w[0] * w[0], w[1] * w[1], w[2] * w[2],
                         w[0] * w[1], w[1] * w[2], w[0] * w[2]};
    double sum = 0.0;

    for (int a = 0; a < 3; a++) {
        sum += value_of(&t->Ct, q, l, a) * a0[a] +
               value_of(&t->Cr, q, l, a) * wdot[a];
        for (int64_t k = 0; k < MODES; k++)
            sum += value_of(&t->Ge, q, l, 3 * k + a) * qdot[k] * w[a];
    }
    for (int64_t k = 0; k < MODES; k++)
        sum += value_of(&t->Me, q, l, k) * qddot[k];
    for (int c = 0; c < 6; c++)
        sum += value_of(&t->Oe, q, l, c) * W[c];
    return sum;
}

/* Add sum m u~ u~', the second-order term of J, which SID leaves out. */
static void add_second_order(double turn[3])
{
    for (int64_t i = 0; i < NODES; i++) {
        double u[3] = {0}, s[3], c[3], t[3], g[3];

        for (int a = 0; a < 3; a++)
            for (int64_t k = 0; k < MODES; k++)
                u[a] += q[k] * shape(k, i, a);
        ritz_cross(wdot, u, s);
        ritz_cross(u, s, t);
        ritz_cross(w, u, s);
        ritz_cross(u, s, c); /* u~ u~' w */
        ritz_cross(w, c, g);
        for (int a = 0; a < 3; a++)
            turn[a] += masses[i] * (t[a] + g[a]);
    }
}

static void terms_of_sid_are_the_inertia_forces_of_a_motion(void **state)
{
    (void)state;
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_dense) M = {0};
    RITZ_OWN(ritz_sid_terms) t = {0};
    double torque[3] = {0}, force[MODES] = {0}, turn[3];

    assert_ok(make_body(&invariants, &M));
    assert_ok(ritz_sid_terms_of(&invariants, &M, origin, &t));
    for (int64_t i = 0; i < NODES; i++) {
        double p[3], acceleration[3], moment[3];

        accelerate(i, p, acceleration);
        ritz_cross(p, acceleration, moment);
        for (int a = 0; a < 3; a++) {
            torque[a] += masses[i] * moment[a];
            for (int64_t l = 0; l < MODES; l++)
                force[l] += masses[i] * shape(l, i, a) * acceleration[a];
        }
    }
    assert_near(t.mass, 5.5, rounding);
    turn_by_sid(&t, turn);
    add_second_order(turn);
    for (int a = 0; a < 3; a++)
        assert_near(turn[a], torque[a], rounding);
    for (int64_t l = 0; l < MODES; l++)
        assert_near(force_by_sid(&t, l), force[l], rounding);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_dense) M = {0}, small = {0};
    const ritz_invariants none = {0};
    ritz_mbdyn_terms mbdyn = {0};
    ritz_sid_terms sid = {0};
    ritz_inertia_loss loss = {0};

    assert_ok(make_body(&invariants, &M));
    assert_ok(ritz_dense_new(1, 1, &small));
    assert_fails(ritz_mbdyn_terms_of(&none, &M, origin, &mbdyn),
                 RITZ_ERR_ARGUMENT, "no invariants of inertia");
    assert_fails(ritz_sid_terms_of(&invariants, &small, origin, &sid),
                 RITZ_ERR_ARGUMENT, "of 2 modes and a mass matrix of 1 rows");
    assert_fails(ritz_inertia_loss_of(&invariants, &small, &small, &loss),
                 RITZ_ERR_ARGUMENT, "of 2 modes and a mass matrix of 1 rows");
    memset(invariants.rigid, 0, sizeof invariants.rigid);
    assert_fails(ritz_sid_terms_of(&invariants, &M, origin, &sid),
                 RITZ_ERR_ARGUMENT, "the body has no mass");
}

static ritz_status make_all(void)
{
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_dense) M = {0};
    RITZ_OWN(ritz_mbdyn_terms) mbdyn = {0};
    RITZ_OWN(ritz_sid_terms) sid = {0};
    ritz_inertia_loss loss = {0};

    RITZ_CHECK(make_body(&invariants, &M));
    RITZ_CHECK(ritz_mbdyn_terms_of(&invariants, &M, origin, &mbdyn));
    RITZ_CHECK(ritz_sid_terms_of(&invariants, &M, origin, &sid));
    RITZ_CHECK(ritz_inertia_loss_of(&invariants, &M, &M, &loss));
    assert_true(loss.value < rounding);
    return RITZ_OK;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(make_all());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(terms_of_mbdyn_are_the_sums_of_its_manual),
    cmocka_unit_test(terms_of_sid_are_the_inertia_forces_of_a_motion),
    cmocka_unit_test(what_does_not_fit_is_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(inertia_terms, tests, NULL, NULL)
