/* Steps of ritz_stage_sweep: compute bases at several settings of a joint,
   align and interpolate them. */
#ifndef RITZ_ASSEMBLY_SWEPT_H
#define RITZ_ASSEMBLY_SWEPT_H

#include "assembly/assembly.h"
#include "simulate/swept.h"

/* Numbers of intervals: at first, and at most. The first ones of a hinge are at
   most 45 degrees: from settings that are whole turns apart, neither its axis
   nor an error of the spline is seen. */
enum { RITZ_SWEEP_FEWEST = 8, RITZ_SWEEP_MOST = 1024 };

/* The system at one setting. */
typedef struct ritz_sweep_knot {
    double x;
    int64_t rank, rigid;
    ritz_dense V;   /* Q x e, modes */
    ritz_dense SV;  /* springs x e */
    double *lambda; /* e */
    ritz_dense places;
} ritz_sweep_knot;

typedef struct ritz_sweep_grid {
    int64_t count;
    ritz_sweep_knot *knot; /* count, x ascending */
} ritz_sweep_grid;

typedef struct ritz_sweeper {
    const ritz_stage *stage;
    const ritz_sweep_request *asked;
    double unit, first, last; /* of x, at most one turn of a hinge */
    bool whole;               /* it is one turn of several */
} ritz_sweeper;

static inline const char *ritz_sweep_name(const ritz_sweeper *w)
{
    return w->stage->scene->sweep[w->asked->sweep].name;
}

void ritz_sweep_grid_free(ritz_sweep_grid *grid);

/** Compute the first grid. */
ritz_status ritz_sweep_begin(const ritz_sweeper *w, ritz_sweep_grid *out);

/** Compute the knots half way between those of a grid. */
ritz_status ritz_sweep_middles(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid,
                               ritz_sweep_grid *out);

/** Merge both grids into @p grid; the other one is left empty. */
ritz_status ritz_sweep_merge(ritz_sweep_grid *grid, ritz_sweep_grid *middles);

/** Compute a grid of a single knot, at x. */
ritz_status ritz_sweep_one(const ritz_sweeper *w, double x,
                           ritz_sweep_grid *out);

/** Modes of a knot up to the band's end. */
int64_t ritz_sweep_count_modes(const ritz_sweep_knot *k, double up_to_hz);

/** Refuse a grid on which the rank of the constraints changes, or on which a
 * mode leaves or enters the band. */
ritz_status ritz_sweep_check(const ritz_sweeper *w,
                             const ritz_sweep_grid *grid);

/** V'M T, with V the r modes of a knot. */
ritz_status ritz_sweep_correlate(const ritz_dense *V, const ritz_dense *M,
                                 const ritz_dense *T, ritz_dense *out);

/** G and H of a model, if any body turns. */
ritz_status ritz_sweep_turning(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid,
                               ritz_swept_model *m);

/** The map from x0 to q at the start, and the frequencies there. */
ritz_status ritz_sweep_start(const ritz_sweeper *w, ritz_swept_model *m);

#endif
