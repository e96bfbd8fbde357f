/* A response while its points are being chosen. */
#ifndef RITZ_RESPONSE_MESH_H
#define RITZ_RESPONSE_MESH_H

#include "response/responder.h"

typedef struct ritz_mesh {
    ritz_responder *responder; /* borrowed */
    int64_t values;            /* a point: outputs x inputs */
    int64_t count, room;
    double *hertz;      /* count, ascending */
    double _Complex *H; /* count x values */
    bool *open;         /* count: from this point to the next is not settled */
    double *peak;       /* values, largest |H| that was met */
    double *level;      /* values, of ritz_noise_heed */
    double *scale;      /* values, of ritz_noise_scales */
    double _Complex *row, *between; /* values, to work in */
} ritz_mesh;

/** Of given points, which ascend; all is open. */
ritz_status ritz_mesh_new(ritz_responder *responder, int64_t count,
                          const double *hertz, ritz_mesh *out);

/** H into mesh->row, the peaks heeded. */
ritz_status ritz_mesh_ask(ritz_mesh *mesh, double hertz);

/**
 * Put points among the others, those that are there already left out.
 *
 * @param[in] hertz  ascending
 * @param[in] H      count x values
 */
ritz_status ritz_mesh_insert(ritz_mesh *mesh, int64_t count,
                             const double *hertz, const double _Complex *H);

void ritz_mesh_free(ritz_mesh *mesh);

/**
 * Weights of the points first, first + 1, ... for the cubic at @p at, which
 * lies between points k and k + 1.
 *
 * @return how many, 4 or fewer
 */
int ritz_cubic(int64_t count, const double *x, int64_t k, double at,
               int64_t *first, double weight[static 4]);

/** out = sum of weighted rows. */
void ritz_cubic_mix(int points, const double *weight, int64_t values,
                    const double _Complex *H, double _Complex *out);

/**
 * Add the points where a channel has a zero near the axis: where the cubics
 * dip, and from there by w := Re(w - H / H') [each step one response].
 */
ritz_status ritz_mesh_add_dips(ritz_mesh *mesh);

#endif
