#include "bodies.h"

#include "base/alloc.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double body_number(uint64_t *seed)
{
    uint64_t x = *seed;

    x ^= x << 13; /* xorshift, any will do */
    x ^= x >> 7;
    x ^= x << 17;
    *seed = x;
    return (double)(x >> 11) / 4503599627370496.0 - 1.0;
}

/* What elements add, place by place. */
typedef struct triplets {
    int64_t count;
    int64_t *row, *col;
    double *val;
} triplets;

static ritz_status make_room(int64_t most, triplets *t)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(t->row, most);
    RITZ_NEW(t->col, most);
    RITZ_NEW(t->val, most);
done:
    return status;
}

static void put(triplets *t, int64_t row, int64_t col, double val)
{
    t->row[t->count] = row;
    t->col[t->count] = col;
    t->val[t->count++] = val;
}

static void free_triplets(triplets *t)
{
    free(t->row);
    free(t->col);
    free(t->val);
}

/* L L' + 3 I with entries of L between -1 and 1: positive definite. */
static void random_definite(int64_t n, uint64_t *seed, double *A)
{
    double L[36];

    for (int64_t k = 0; k < n * n; k++)
        L[k] = body_number(seed);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            A[n * i + j] = i == j ? 3.0 : 0.0;
            for (int64_t k = 0; k < n; k++)
                A[n * i + j] += L[n * i + k] * L[n * j + k];
        }
}

/*
 * The springs S between grids i and j pull where j leaves what rigid motion of
 * i would give it: r = [u_j - u_i - theta_i x d; theta_j - theta_i] = B u.
 */
static void add_springs(int64_t i, const double *d, uint64_t *seed, triplets *t)
{
    const double skew[3][3] = {
        {0.0, d[2], -d[1]}, {-d[2], 0.0, d[0]}, {d[1], -d[0], 0.0}};
    double B[6][12] = {{0}};
    double S[36];

    random_definite(6, seed, S);
    for (int k = 0; k < 6; k++) {
        B[k][k] = -1.0;
        B[k][k + 6] = 1.0;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            B[a][b + 3] = -skew[a][b];
    for (int64_t a = 0; a < 12; a++)
        for (int64_t b = 0; b < 12; b++) {
            double sum = 0.0;

            for (int k = 0; k < 36; k++)
                sum += B[k / 6][a] * S[k] * B[k % 6][b];
            put(t, 6 * i + a, 6 * i + b, 1000.0 * sum);
        }
}

static void add_mass(int64_t i, uint64_t *seed, triplets *t)
{
    double m = 1.5 + 0.5 * body_number(seed);
    double J[9];

    random_definite(3, seed, J);
    for (int64_t a = 0; a < 3; a++)
        put(t, 6 * i + a, 6 * i + a, m);
    for (int64_t a = 0; a < 9; a++)
        put(t, 6 * i + 3 + a / 3, 6 * i + 3 + a % 3, 0.1 * J[a]);
}

/* Dofs, grids and ports of a body whose matrices are there. */
static ritz_status complete(int64_t count, const double (*position)[3],
                            int64_t first, ritz_component *body)
{
    ritz_status status = RITZ_OK;
    ritz_grids *grids = &body->grids;

    RITZ_NEW(body->dof, 6 * count);
    RITZ_NEW(grids->id, count);
    RITZ_NEW(grids->position, 3 * count);
    RITZ_NEW(grids->frame, count);
    RITZ_NEW(grids->axes, 9);
    grids->num_frames = 1;
    grids->count = count;
    for (int64_t k = 0; k < 3; k++)
        grids->axes[4 * k] = 1.0;
    for (int64_t k = 0; k < count; k++) {
        grids->id[k] = first + k;
        memcpy(grids->position + 3 * k, position[k], sizeof *position);
    }
    for (int64_t k = 0; k < 6 * count; k++)
        body->dof[k] =
            (ritz_dof){.grid = first + k / 6, .component = 1 + (int)(k % 6)};
    for (int64_t k = 0; k < count; k++) {
        char name[16];

        snprintf(name, sizeof name, "g%d", (int)k + 1);
        RITZ_TRY(add_port(body, name, first + k));
    }
    RITZ_TRY(ritz_component_settle(body, false));
done:
    return status;
}

ritz_status body_chain(int64_t count, const double (*position)[3],
                       int64_t first, uint64_t seed, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component body = {.num_dofs = 6 * count};
    triplets K = {0}, M = {0};

    RITZ_TRY(make_room(144 * count, &K));
    RITZ_TRY(make_room(12 * count, &M));
    for (int64_t i = 0; i < count; i++) {
        double d[3];

        add_mass(i, &seed, &M);
        for (int k = 0; k < 3 && i + 1 < count; k++)
            d[k] = position[i + 1][k] - position[i][k];
        if (i + 1 < count)
            add_springs(i, d, &seed, &K);
    }
    RITZ_TRY(ritz_sparse_from_triplets(6 * count, 6 * count, K.count, K.row,
                                       K.col, K.val, &body.K));
    RITZ_TRY(ritz_sparse_from_triplets(6 * count, 6 * count, M.count, M.row,
                                       M.col, M.val, &body.M));
    RITZ_TRY(complete(count, position, first, &body));
    *out = body;
    body = (ritz_component){0};
done:
    free_triplets(&K);
    free_triplets(&M);
    ritz_component_free(&body);
    return status;
}

ritz_status body_point(double m, double J, ritz_component *out)
{
    static const double origin[1][3] = {{0.0}};
    static const int64_t at[6] = {0, 1, 2, 3, 4, 5};
    const double mass[6] = {m, m, m, J, J, J};
    ritz_status status = RITZ_OK;
    ritz_component body = {.num_dofs = 6};

    RITZ_TRY(ritz_sparse_from_triplets(6, 6, 0, NULL, NULL, NULL, &body.K));
    RITZ_TRY(ritz_sparse_from_triplets(6, 6, 6, at, at, mass, &body.M));
    RITZ_TRY(complete(1, origin, 1, &body));
    *out = body;
    body = (ritz_component){0};
done:
    ritz_component_free(&body);
    return status;
}

/* x := R x + t */
static void move(const double R[9], const double *t, double *x)
{
    const double old[3] = {x[0], x[1], x[2]};

    for (int i = 0; i < 3; i++)
        x[i] = R[3 * i] * old[0] + R[3 * i + 1] * old[1] +
               R[3 * i + 2] * old[2] + t[i];
}

ritz_status body_move(ritz_component *body, const double R[9],
                      const double t[3])
{
    ritz_status status = RITZ_OK;
    int64_t n = body->num_dofs;
    triplets T = {0};
    ritz_sparse turn = {0}, K = {0}, M = {0};

    RITZ_TRY(make_room(3 * n, &T)); /* u_old = R'u_new */
    for (int64_t k = 0; k < 3 * n; k++)
        put(&T, k / 9 * 3 + k % 3, k / 9 * 3 + k / 3 % 3, R[k % 9]);
    RITZ_TRY(
        ritz_sparse_from_triplets(n, n, T.count, T.row, T.col, T.val, &turn));
    RITZ_TRY(ritz_sparse_congruence(&body->K, &turn, &K));
    RITZ_TRY(ritz_sparse_congruence(&body->M, &turn, &M));
    ritz_sparse_free(&body->K);
    ritz_sparse_free(&body->M);
    body->K = K;
    body->M = M;
    for (int64_t k = 0; k < body->grids.count; k++)
        move(R, t, body->grids.position + 3 * k);
    for (int64_t k = 0; k < body->num_ports; k++)
        move(R, t, body->port[k].origin);
done:
    ritz_sparse_free(&turn);
    free_triplets(&T);
    return status;
}
