/*
 * Inertia invariants of solids, of what follows a grid rigidly, and of parts of
 * a mass matrix, against sums over points.
 */
#include "testing.h"

#include "base/vector.h"
#include "fixtures/drafts.h"

#include <stdlib.h>

/* ---- solids ------------------------------------------------------------- */

/*
 * A distorted hexahedron with trilinear shapes N_c. Corner c is node c, or the
 * point of a rigid body of which node `tied[c]` is one.
 */
typedef struct solid {
    double corner[8][3];
    int64_t node[8];
} solid;

static void place_solid(solid *s)
{
    for (int c = 0; c < 8; c++) {
        s->node[c] = c;
        for (int a = 0; a < 3; a++)
            s->corner[c][a] = (c >> a & 1) + 0.2 * draft_noise(3 * c + a);
    }
}

/* The shape functions N and the Jacobian determinant at a point. */
static double shape_solid(const solid *s, const double xi[3], double N[8])
{
    double J[3][3] = {{0}};

    for (int c = 0; c < 8; c++) {
        N[c] = 1.0;
        for (int a = 0; a < 3; a++)
            N[c] *= (c >> a & 1 ? 1 + xi[a] : 1 - xi[a]) / 2.0;
        for (int b = 0; b < 3; b++) {
            const double slope =
                N[c] * (c >> b & 1 ? 1 / (1 + xi[b]) : -1 / (1 - xi[b]));

            for (int a = 0; a < 3; a++)
                J[a][b] += s->corner[c][a] * slope;
        }
    }
    return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
           J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
           J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

/* B, 3 x 6, gives the motion of a corner from that of its node. */
static void move_corner(const draft *d, const solid *s, int c, double B[3][6])
{
    const double *at = d->place[s->node[c]];

    for (int p = 0; p < 3; p++) {
        double unit[3] = {0}, arm[3], slope[3];

        for (int a = 0; a < 3; a++)
            arm[a] = s->corner[c][a] - at[a];
        unit[p] = 1.0;
        ritz_cross(unit, arm, slope);
        for (int a = 0; a < 3; a++) {
            B[a][p] = unit[a];
            B[a][3 + p] = slope[a];
        }
    }
}

static void add_solid_point(const solid *s, const double N[8], double dm,
                            draft *d, draft_sums *sum)
{
    RITZ_OWN(ritz_dense) T = {0};
    double x[3] = {0}, v[DRAFT_COLUMNS][3] = {{0}}, B[8][3][6];

    assert_ok(draft_shapes(d, &T));
    for (int c = 0; c < 8; c++) {
        move_corner(d, s, c, B[c]);
        for (int a = 0; a < 3; a++) {
            x[a] += N[c] * s->corner[c][a];
            for (int k = 0; k < DRAFT_COLUMNS; k++)
                for (int p = 0; p < 6; p++)
                    v[k][a] += N[c] * B[c][a][p] *
                               ritz_dense_col(&T, k)[6 * s->node[c] + p];
        }
    }
    for (int k = 0; k < 64; k++)
        for (int pq = 0; pq < 36; pq++)
            for (int a = 0; a < 3; a++)
                draft_add(d, 6 * s->node[k / 8] + pq / 6,
                          6 * s->node[k % 8] + pq % 6,
                          dm * N[k / 8] * N[k % 8] * B[k / 8][a][pq / 6] *
                              B[k % 8][a][pq % 6]);
    draft_point(dm, x, v, sum);
}

/* N_c N_d and the volume are of degree 4 in each direction: four points are
   more than enough. */
static void add_solid(const solid *s, draft *d, draft_sums *sum)
{
    for (int g = 0; g < 64; g++) {
        const int at[3] = {g % 4, g / 4 % 4, g / 16};
        double xi[3], N[8], dm = 1.5;

        for (int a = 0; a < 3; a++) {
            xi[a] = draft_gauss[at[a]];
            dm *= draft_weight[at[a]];
        }
        dm *= shape_solid(s, xi, N);
        add_solid_point(s, N, dm, d, sum);
    }
}

static void a_distorted_solid_is_exact(void **state)
{
    (void)state;
    RITZ_OWN(draft) d = {0};
    draft_sums sum = {.all = true};
    solid s = {0};

    place_solid(&s);
    draft_new(8, &d);
    memcpy(d.place, s.corner, sizeof s.corner);
    d.frame[3] = d.frame[4] = 1;
    add_solid(&s, &d, &sum);
    draft_assert_exact(&d, &sum);
}

static void a_face_that_follows_a_grid_is_exact(void **state)
{
    (void)state;
    RITZ_OWN(draft) d = {0};
    draft_sums sum = {.all = true};
    solid s = {0};

    place_solid(&s);
    draft_new(10, &d);
    memcpy(d.place, s.corner, sizeof s.corner);
    for (int a = 0; a < 3; a++) {
        d.place[8][a] = 0.3 + draft_noise(a);
        d.place[9][a] = 0.4 - draft_noise(a + 3);
    }
    d.frame[8] = 1;
    /* two rigid bodies, of four and of two corners */
    for (int c = 0; c < 8; c += 2)
        s.node[c] = 8;
    s.node[5] = s.node[7] = 9;
    add_solid(&s, &d, &sum);
    draft_assert_exact(&d, &sum);
}

/* M is given in two groups of columns, as two ranks of a reduction hold it. */
static void parts_of_the_mass_matrix_add_up(void **state)
{
    (void)state;
    RITZ_OWN(draft) d = {0};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN(ritz_invariants) whole = {0}, first = {0}, second = {0};
    RITZ_OWN_ARRAY double *val = NULL;
    draft_sums s = {.all = true};
    int64_t middle = 0;

    draft_frame(&d);
    draft_lump(2, &d, &s);
    draft_beam(2.0, 0, 1, &d, &s);
    draft_beam(0.75, 1, 2, &d, &s);
    assert_ok(draft_component(&d, &body));
    assert_ok(draft_shapes(&d, &T));
    assert_ok(ritz_invariants_of(&body, &T, &whole));
    middle = body.M.colptr[6];
    val = ritz_zalloc(body.M.colptr[24], sizeof *val);
    assert_non_null(val);
    memcpy(val, body.M.val, (size_t)body.M.colptr[24] * sizeof *val);
    memset(body.M.val, 0, (size_t)middle * sizeof *val);
    assert_ok(ritz_invariants_of(&body, &T, &first));
    memset(body.M.val, 0, (size_t)body.M.colptr[24] * sizeof *val);
    memcpy(body.M.val, val, (size_t)middle * sizeof *val);
    assert_ok(ritz_invariants_of(&body, &T, &second));
    ritz_dense_add(1.0, &second.product, &first.product);
    ritz_dense_add(1.0, &second.position, &first.position);
    for (int64_t k = 0; k < 9 * DRAFT_COLUMNS * DRAFT_COLUMNS; k++)
        assert_near(first.product.val[k], whole.product.val[k],
                    draft_rounding * ritz_dense_max(&whole.product));
    for (int64_t k = 0; k < 9 * DRAFT_COLUMNS; k++)
        assert_near(first.position.val[k], whole.position.val[k],
                    draft_rounding * ritz_dense_max(&whole.position));
}

static ritz_status find_all(void *of)
{
    RITZ_OWN(ritz_invariants) found = {0};
    ritz_inertia_loss loss = {0};

    return draft_invariants(of, &found, &loss);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    RITZ_OWN(draft) d = {0};
    draft_sums s = {.all = true};

    draft_frame(&d);
    draft_lump(2, &d, &s);
    draft_beam(2.0, 0, 1, &d, &s);
    assert_survives_every_allocation(find_all(&d));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_distorted_solid_is_exact),
    cmocka_unit_test(a_face_that_follows_a_grid_is_exact),
    cmocka_unit_test(parts_of_the_mass_matrix_add_up),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(invariants, tests, NULL, NULL)
