/* Zeros of each channel that are near enough to the axis to make it dip. */
#include "response/mesh.h"

#include "base/alloc.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 8, MOST_STEPS = 5 };
/* Of the frequency: where a step is smaller, it was the last. */
static const double settled = 1e-9;
/* Of what its errors are measured by: a channel beneath is rounding. */
static const double heard = 0.5;

/* Points that were found, in the order of channels. */
typedef struct finds {
    int64_t count, room, values;
    double *hertz;
    double _Complex *H;
} finds;

static ritz_status keep(finds *f, double hertz, const double _Complex *H)
{
    ritz_status status = RITZ_OK;
    finds more = {
        .count = f->count, .room = 2 * f->room + 16, .values = f->values};

    if (f->count == f->room) {
        RITZ_NEW(more.hertz, more.room);
        RITZ_NEW(more.H, more.room * more.values);
        if (f->count > 0) {
            memcpy(more.hertz, f->hertz, (size_t)f->count * sizeof *f->hertz);
            memcpy(more.H, f->H, (size_t)(f->count * f->values) * sizeof *f->H);
        }
        free(f->hertz);
        free(f->H);
        *f = more;
        more = (finds){0};
    }
    f->hertz[f->count] = hertz;
    memcpy(f->H + f->count * f->values, H, (size_t)f->values * sizeof *H);
    f->count++;
done:
    free(more.hertz);
    free(more.H);
    return status;
}

/* Channel v of the cubics at a point of interval k. */
static double _Complex cubic_at(const ritz_mesh *mesh, int64_t v, int64_t k,
                                double hertz)
{
    double _Complex sum = 0.0;
    double weight[4];
    int64_t first = 0;
    int points = ritz_cubic(mesh->count, mesh->hertz, k, hertz, &first, weight);

    for (int i = 0; i < points; i++)
        sum += weight[i] * mesh->H[(first + i) * mesh->values + v];
    return sum;
}

/*
 * From a dip in (low, high): where H is a (w - z), one step is at Re z. A zero
 * farther off the axis than the dip is wide makes none.
 */
static ritz_status pursue(ritz_mesh *mesh, int64_t v, double low, double high,
                          double _Complex slope, finds *f)
{
    double w = 0.5 * (low + high);
    double before = 0.0;
    double _Complex H = 0.0, z = 0.0;
    bool still = false;

    for (int t = 0; t < MOST_STEPS && !still; t++) {
        double _Complex last = H;

        RITZ_CHECK(ritz_mesh_ask(mesh, w));
        H = mesh->row[v];
        if (t > 0 && w != before)
            slope = (H - last) / (w - before);
        if (!(cabs(slope) > 0.0))
            return RITZ_OK;
        z = w - H / slope;
        before = w;
        still = H == 0.0 || fabs(creal(z) - w) <= settled * w;
        if (!still)
            w = creal(z);
        if (!(w > low && w < high))
            return RITZ_OK;
    }
    if (!still)
        RITZ_CHECK(ritz_mesh_ask(mesh, w));
    if (fabs(cimag(z)) <= high - low)
        RITZ_CHECK(keep(f, w, mesh->row));
    return RITZ_OK;
}

/* Where the cubics of one channel are least among their neighbours. */
static ritz_status search(ritz_mesh *mesh, int64_t v, finds *f)
{
    double w[3] = {0.0, 0.0, 0.0};
    double size[3] = {0.0, 0.0, 0.0};
    double _Complex H[3] = {0.0, 0.0, 0.0};
    int64_t n = 0;

    for (int64_t k = 0; k + 1 < mesh->count; k++) {
        double step = (mesh->hertz[k + 1] - mesh->hertz[k]) / PARTS;

        for (int part = 0; part < PARTS; part++, n++) {
            w[0] = w[1], H[0] = H[1], size[0] = size[1];
            w[1] = w[2], H[1] = H[2], size[1] = size[2];
            w[2] = mesh->hertz[k] + part * step;
            H[2] = cubic_at(mesh, v, k, w[2]);
            size[2] = cabs(H[2]);
            if (n < 2 || size[1] > size[0] || size[1] > size[2])
                continue;
            RITZ_CHECK(
                pursue(mesh, v, w[0], w[2], (H[2] - H[0]) / (w[2] - w[0]), f));
        }
    }
    return RITZ_OK;
}

typedef struct place {
    double hertz;
    int64_t at;
} place;

static int ascending(const void *left, const void *right)
{
    const place *a = left;
    const place *b = right;

    return (a->hertz > b->hertz) - (a->hertz < b->hertz);
}

/* Into the mesh, in order. */
static ritz_status merge(ritz_mesh *mesh, const finds *f)
{
    ritz_status status = RITZ_OK;
    place *order = NULL;
    double *hertz = NULL;
    double _Complex *H = NULL;

    RITZ_NEW(order, f->count);
    RITZ_NEW(hertz, f->count);
    RITZ_NEW(H, f->count * f->values);
    for (int64_t k = 0; k < f->count; k++)
        order[k] = (place){f->hertz[k], k};
    qsort(order, (size_t)f->count, sizeof *order, ascending);
    for (int64_t k = 0; k < f->count; k++) {
        hertz[k] = order[k].hertz;
        memcpy(H + k * f->values, f->H + order[k].at * f->values,
               (size_t)f->values * sizeof *H);
    }
    RITZ_TRY(ritz_mesh_insert(mesh, f->count, hertz, H));
done:
    free(order);
    free(hertz);
    free(H);
    return status;
}

ritz_status ritz_mesh_add_dips(ritz_mesh *mesh)
{
    ritz_status status = RITZ_OK;
    finds f = {.values = mesh->values};

    for (int64_t v = 0; v < mesh->values; v++)
        if (mesh->peak[v] > heard * mesh->scale[v])
            RITZ_TRY(search(mesh, v, &f));
    RITZ_TRY(merge(mesh, &f));
done:
    free(f.hertz);
    free(f.H);
    return status;
}
