#include "truss.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 4, BARS_OF_A_BAY = 4 };

const truss_shape truss_free72 = {
    .bays = 17, .bay = 1.0, .height = 1.0, .EA = 7e6, .rhoA = 0.27};
const truss_shape truss_cantilever16 = {.bays = 4,
                                        .bay = 1.0,
                                        .height = 1.0,
                                        .EA = 7e6,
                                        .rhoA = 0.27,
                                        .clamp_left = true};
const truss_shape truss_cantilever48 = {.bays = 12,
                                        .bay = 1.0,
                                        .height = 1.0,
                                        .EA = 7e6,
                                        .rhoA = 0.27,
                                        .clamp_left = true};

/* Entries that are added up, of joints 0, 1, ... with none held. */
typedef struct entries {
    int64_t count;
    int64_t *row, *col;
    double *k, *m;
} entries;

static void free_entries(entries *e)
{
    free(e->row);
    free(e->col);
    free(e->k);
    free(e->m);
}

static void add(entries *e, int64_t row, int64_t col, double k, double m)
{
    e->row[e->count] = row;
    e->col[e->count] = col;
    e->k[e->count] = k;
    e->m[e->count++] = m;
}

static double x_of(const truss_shape *s, int64_t joint)
{
    int64_t post = joint / 2;

    return (double)post * s->bay;
}

static double y_of(const truss_shape *s, int64_t joint)
{
    return joint % 2 ? s->height : 0.0;
}

/* k = EA / l b b', b = [-c; c]; m = rhoA l / 6 [2 I, I; I, 2 I]. */
static void add_bar(const truss_shape *s, int64_t p, int64_t q, entries *e)
{
    double dx = x_of(s, q) - x_of(s, p);
    double dy = y_of(s, q) - y_of(s, p);
    double l = hypot(dx, dy);
    const double b[SIDE] = {-dx / l, -dy / l, dx / l, dy / l};
    const int64_t row[SIDE] = {2 * p, 2 * p + 1, 2 * q, 2 * q + 1};

    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++)
            add(e, row[i], row[j], s->EA / l * b[i] * b[j],
                (i + j) % 2 == 0 ? s->rhoA * l / (i == j ? 3.0 : 6.0) : 0.0);
}

static void add_bars(const truss_shape *s, entries *e)
{
    add_bar(s, 0, 1, e);
    for (int64_t j = 0; j < s->bays; j++) {
        add_bar(s, 2 * j, 2 * j + 2, e);
        add_bar(s, 2 * j + 1, 2 * j + 3, e);
        add_bar(s, 2 * j, 2 * j + 3, e);
        add_bar(s, 2 * j + 2, 2 * j + 3, e);
    }
    for (int64_t i = 4 * s->bays; i < 4 * s->bays + 4; i++)
        add(e, i, i, 0.0, s->tip_mass);
}

/* Leave out what belongs to held dofs, and count from the first that stays. */
static void hold(entries *e, int64_t first)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < e->count; k++)
        if (e->row[k] >= first && e->col[k] >= first) {
            e->row[kept] = e->row[k] - first;
            e->col[kept] = e->col[k] - first;
            e->k[kept] = e->k[k];
            e->m[kept++] = e->m[k];
        }
    e->count = kept;
}

static ritz_status place(const truss_shape *s, ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    int64_t joints = 2 * (s->bays + 1);

    out->count = joints;
    out->num_frames = 1;
    RITZ_NEW(out->id, joints);
    RITZ_NEW(out->frame, joints);
    RITZ_NEW(out->position, 3 * joints);
    RITZ_NEW(out->axes, 9);
    for (int k = 0; k < 3; k++)
        out->axes[4 * k] = 1.0;
    for (int64_t g = 0; g < joints; g++) {
        out->id[g] = g + 1;
        out->position[3 * g] = x_of(s, g);
        out->position[3 * g + 1] = y_of(s, g);
    }
done:
    return status;
}

ritz_status truss_component(const truss_shape *shape, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component truss = {.units = "kg m s"};
    entries e = {0};
    int64_t bars = BARS_OF_A_BAY * shape->bays + 1;
    int64_t first = shape->clamp_left ? SIDE : 0;
    int64_t n = SIDE * (shape->bays + 1) - first;

    RITZ_NEW(e.row, SIDE * SIDE * bars + SIDE);
    RITZ_NEW(e.col, SIDE * SIDE * bars + SIDE);
    RITZ_NEW(e.k, SIDE * SIDE * bars + SIDE);
    RITZ_NEW(e.m, SIDE * SIDE * bars + SIDE);
    add_bars(shape, &e);
    hold(&e, first);
    truss.num_dofs = n;
    RITZ_NEW(truss.dof, n);
    for (int64_t i = 0; i < n; i++)
        truss.dof[i] = (ritz_dof){(first + i) / 2 + 1, i % 2 + 1};
    RITZ_TRY(
        ritz_sparse_from_triplets(n, n, e.count, e.row, e.col, e.k, &truss.K));
    RITZ_TRY(
        ritz_sparse_from_triplets(n, n, e.count, e.row, e.col, e.m, &truss.M));
    RITZ_TRY(place(shape, &truss.grids));
    RITZ_TRY(ritz_component_settle(&truss, false));
    *out = truss;
    truss = (ritz_component){0};
done:
    ritz_component_free(&truss);
    free_entries(&e);
    return status;
}
