#include "response/mesh.h"

#include "base/alloc.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* H of more values than this is a mistake in the request. */
static const int64_t most_values = INT64_C(1) << 28;
/* Points closer than this, relative, are one: a cubic through two of them
   divides the rounding of H by their distance. */
static const double same = 1e-9;

ritz_status ritz_mesh_ask(ritz_mesh *mesh, double hertz)
{
    RITZ_CHECK(ritz_responder_at(mesh->responder, hertz, mesh->row));
    for (int64_t v = 0; v < mesh->values; v++)
        mesh->peak[v] = fmax(mesh->peak[v], cabs(mesh->row[v]));
    ritz_noise_heed(&mesh->responder->noise, hertz, mesh->row, mesh->level);
    return RITZ_OK;
}

static ritz_status make_room(ritz_mesh *mesh, int64_t room)
{
    ritz_status status = RITZ_OK;
    double *hertz = NULL;
    double _Complex *H = NULL;
    bool *open = NULL;
    size_t count = (size_t)mesh->count;

    if (room <= mesh->room)
        return RITZ_OK;
    room += room / 2;
    RITZ_FAIL_IF(room > most_values / (mesh->values > 0 ? mesh->values : 1),
                 RITZ_ERR_CONVERGENCE,
                 "%" PRId64 " points do not keep the tolerance: ask for less, "
                 "or for a shorter range",
                 mesh->count);
    RITZ_NEW(hertz, room);
    RITZ_NEW(H, room * mesh->values);
    RITZ_NEW(open, room);
    if (count > 0) {
        memcpy(hertz, mesh->hertz, count * sizeof *hertz);
        memcpy(H, mesh->H, count * (size_t)mesh->values * sizeof *H);
        memcpy(open, mesh->open, count * sizeof *open);
    }
    free(mesh->hertz);
    free(mesh->H);
    free(mesh->open);
    mesh->hertz = hertz;
    mesh->H = H;
    mesh->open = open;
    mesh->room = room;
    hertz = NULL;
    H = NULL;
    open = NULL;
done:
    free(hertz);
    free(H);
    free(open);
    return status;
}

static void place(ritz_mesh *mesh, int64_t to, double hertz, bool open,
                  const double _Complex *H)
{
    mesh->hertz[to] = hertz;
    mesh->open[to] = open;
    memmove(mesh->H + to * mesh->values, H, (size_t)mesh->values * sizeof *H);
}

/* Those that are at a point, or beside it by rounding, are taken out. */
static void close_up(ritz_mesh *mesh)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < mesh->count; k++) {
        if (kept > 0 &&
            mesh->hertz[k] - mesh->hertz[kept - 1] <= same * mesh->hertz[k]) {
            mesh->open[kept - 1] = mesh->open[kept - 1] || mesh->open[k];
            continue;
        }
        place(mesh, kept++, mesh->hertz[k], mesh->open[k],
              mesh->H + k * mesh->values);
    }
    mesh->count = kept;
}

ritz_status ritz_mesh_new(ritz_responder *responder, int64_t count,
                          const double *hertz, ritz_mesh *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &responder->poles->io;
    ritz_mesh mesh = {.responder = responder,
                      .values = io->num_outputs * io->num_inputs};

    RITZ_NEW(mesh.peak, mesh.values);
    RITZ_NEW(mesh.level, mesh.values);
    RITZ_NEW(mesh.scale, mesh.values);
    RITZ_NEW(mesh.row, mesh.values);
    RITZ_NEW(mesh.between, mesh.values);
    RITZ_TRY(make_room(&mesh, count));
    for (int64_t k = 0; k < count; k++) {
        RITZ_TRY(ritz_mesh_ask(&mesh, hertz[k]));
        mesh.hertz[k] = hertz[k];
        mesh.open[k] = true;
        memcpy(mesh.H + k * mesh.values, mesh.row,
               (size_t)mesh.values * sizeof *mesh.row);
    }
    mesh.count = count;
    close_up(&mesh);
    *out = mesh;
    mesh = (ritz_mesh){0};
done:
    ritz_mesh_free(&mesh);
    return status;
}

ritz_status ritz_mesh_insert(ritz_mesh *mesh, int64_t count,
                             const double *hertz, const double _Complex *H)
{
    int64_t from = mesh->count - 1;
    int64_t add = count - 1;

    RITZ_CHECK(make_room(mesh, mesh->count + count));
    for (int64_t to = mesh->count + count - 1; add >= 0; to--) {
        if (from >= 0 && mesh->hertz[from] > hertz[add]) {
            place(mesh, to, mesh->hertz[from], mesh->open[from],
                  mesh->H + from * mesh->values);
            from--;
        } else {
            place(mesh, to, hertz[add], from < 0 || mesh->open[from],
                  H + add * mesh->values);
            add--;
        }
    }
    mesh->count += count;
    close_up(mesh);
    return RITZ_OK;
}

void ritz_mesh_free(ritz_mesh *mesh)
{
    free(mesh->hertz);
    free(mesh->H);
    free(mesh->open);
    free(mesh->peak);
    free(mesh->level);
    free(mesh->scale);
    free(mesh->row);
    free(mesh->between);
    *mesh = (ritz_mesh){0};
}
