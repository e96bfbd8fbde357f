/*
 * A component: the finite-element model of one body,
 *
 *     M u'' + D u' + (K + i K4) u = B f,    y = C u + Cv u' + Ca u''
 *
 * with rows named by grid and direction. Displacements of a grid are along the
 * axes of its displacement frame; positions, port origins and port axes are in
 * the component's basic frame.
 */
#ifndef RITZ_COMPONENT_H
#define RITZ_COMPONENT_H

#include <ritz/dampers.h>
#include <ritz/damping.h>
#include <ritz/dofs.h>
#include <ritz/elements.h>
#include <ritz/equations.h>
#include <ritz/io.h>
#include <ritz/sparse.h>
#include <ritz/text.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

/* Where the grids are. Scalar points are not listed. */
typedef struct ritz_grids {
    int64_t count;
    int64_t *id;        /* count, ascending */
    double *position;   /* count x 3, row by row, basic frame */
    int64_t *frame;     /* count, row of `axes`; 0 is the basic frame */
    int64_t num_frames; /* at least 1 once anything is there */
    double *axes; /* num_frames x 3 x 3, row by row: axes[9 f + 3 i + j] is
                     component j (basic) of displacement axis i; frame 0 is I */
} ritz_grids;

/* A named set of dofs by which other bodies hold this one. */
typedef struct ritz_port {
    char name[RITZ_NAME_SIZE];
    ritz_dofs dofs;
    double origin[3]; /* mean position of its grids, basic frame */
    double axes[9];   /* row by row as above; identity */
} ritz_port;

/* Geometric stiffness of one unit load. */
typedef struct ritz_load {
    char name[RITZ_NAME_SIZE];
    ritz_sparse KG;
} ritz_load;

typedef struct ritz_component {
    int64_t num_dofs;  /* n */
    ritz_dof *dof;     /* n, what each row is */
    ritz_sparse K, M;  /* n x n, symmetric; K has no entries if rigid */
    ritz_sparse D, K4; /* n x n; {0}: there is none. D may be unsymmetric */
    int64_t num_loads;
    ritz_load *load;
    ritz_grids grids;
    ritz_elements elements; /* for pictures; {0}: none are known */
    int64_t num_ports;
    ritz_port *port;
    ritz_io io;             /* for n coordinates */
    ritz_recovery recovery; /* dofs that constraints eliminated */
    ritz_dampers dampers;   /* beside K and D, which hold none of them */
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads; "" none */
    char units[RITZ_NAME_SIZE];      /* "kg m s" */
    double asymmetry; /* relative, that was found and averaged away */
    double digits;    /* significant digits of the source; 0 if not known */
} ritz_component;

/**
 * Make what was read into a component: all sizes agree, ports lie in it, dofs
 * are distinct, values are finite, and an asymmetry up to 1e-6 of a matrix'
 * largest entry is averaged away (any asymmetry if @p symmetrise). More is
 * refused, but kept in D, where it is a gyroscopic or circulatory part.
 *
 * Missing parts are completed: K with no entries, an empty io.
 *
 * @param[in,out] component  its asymmetry says what was averaged, 0 if nothing
 * @return RITZ_ERR_FORMAT if it is no component, or is less symmetric
 */
ritz_status ritz_component_settle(ritz_component *component, bool symmetrise);

/** Add the component's dampers to its D and K: see ritz_dampers_install. */
ritz_status ritz_component_install(ritz_component *component);

/**
 * The dofs of some ports, each once, in the order of the ports.
 *
 * @param[in] ports  names with commas between them, NULL for all, "" for none
 * @return RITZ_ERR_ARGUMENT if there is no such port
 */
ritz_status ritz_component_attached(const ritz_component *component,
                                    const char *ports, ritz_dofs *out);

/** Port called @p name; NULL and a sentence naming the nearest if none. */
const ritz_port *ritz_component_port(const ritz_component *component,
                                     const char *name);

/** Row of a dof, -1 if there is none. @cost O(n) */
int64_t ritz_component_row(const ritz_component *component, ritz_dof dof);

/** Index of grid @p id in @p grids, -1 if it has no position. O(log n) */
int64_t ritz_grids_find(const ritz_grids *grids, int64_t id);

/**
 * Displacements of a port's grids along basic axes, from the component's dofs.
 *
 * For each grid of the port in order of first appearance, its present
 * directions ascending; row k of @p turn combines the port's dofs:
 * u_basic = turn * u(port->dofs).
 *
 * A grid whose displacement axes are not the basic ones must bring all three
 * translations, or none, and the same of rotations.
 *
 * @param[out] turn   p x p, p = port->dofs.count
 * @param[out] label  p, grid and basic direction of each row; NULL: not wanted
 * @return RITZ_ERR_ARGUMENT if directions are missing, naming the grid
 */
ritz_status ritz_port_turn(const ritz_component *component,
                           const ritz_port *port, ritz_dense *turn,
                           ritz_dof **label);

/**
 * Rigid-body motions about @p origin by geometry: columns are unit
 * translations along and unit rotations about the basic axes.
 *
 * Rows of scalar points, and of grids without a position, are zero.
 *
 * @param[out] out  n x 6
 */
ritz_status ritz_rigid_geometry(const ritz_component *component,
                                const double origin[static 3], ritz_dense *out);

void ritz_grids_free(ritz_grids *grids);
void ritz_component_free(ritz_component *component);

#pragma GCC visibility pop

#endif
