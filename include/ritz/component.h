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

#include <ritz/parts.h>

#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* A named set of dofs by which other bodies hold this one. */
typedef struct ritz_port {
    char name[RITZ_NAME_SIZE];
    ritz_dofs dofs;
    double origin[3]; /* mean position of its grids, basic frame */
    double axes[9];   /* row by row; always the identity so far */
} ritz_port;

/* Geometric stiffness KG that a load of size 1 causes. */
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
    int64_t num_quantities;
    ritz_quantity *quantity;
    ritz_dampers dampers;            /* K and D do not include them */
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads; "" none */
    char units[RITZ_NAME_SIZE];      /* "kg m s" */
    double asymmetry;                /* relative one that was averaged away */
    double digits; /* significant digits of its files; 0: not known */
} ritz_component;

/**
 * Check and complete a component that was read: sizes must agree, dofs of ports
 * must be among its dofs, dofs must be distinct, and values finite. An
 * asymmetry up to 1e-6 of a matrix' largest entry is averaged away (any
 * asymmetry if
 * @p symmetrise). A larger asymmetry of K or M is refused; D keeps it, as its
 * gyroscopic or circulatory part.
 *
 * Missing parts are added: K without entries, an empty io.
 *
 * @param[in,out] component  its `asymmetry` is set; 0 if nothing was averaged
 * @return RITZ_ERR_FORMAT if a check fails, or K or M is less symmetric
 */
ritz_status ritz_component_settle(ritz_component *component, bool symmetrise);

/** As ritz_component_settle, for a component that was read without its
 * matrices, which stay empty. @return RITZ_ERR_FORMAT as above */
ritz_status ritz_component_settle_frame(ritz_component *component);

/** Add its dampers to its D and K: see ritz_dampers_install. */
ritz_status ritz_component_install(ritz_component *component);

/**
 * The dofs of some ports, each once, in the order of the ports.
 *
 * @param[in] ports  names with commas between them, NULL for all, "" for none
 * @return RITZ_ERR_ARGUMENT if there is no such port
 */
ritz_status ritz_component_attached(const ritz_component *component,
                                    const char *ports, ritz_dofs *out);

/** Port called @p name; NULL and a sentence with the nearest name if none. */
const ritz_port *ritz_component_port(const ritz_component *component,
                                     const char *name);

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

/*
 * Rigid motions R of a free body whose stiffness was rounded: K R is not
 * exactly 0, so the rigid eigenvalues of (K, M) are not 0 but small, of either
 * sign.
 */
typedef struct ritz_rounded {
    int64_t motions; /* number of rigid motions that rounding disturbs; 0:
                        rounding does no harm to responses */
    bool hidden;     /* some of their eigenvalues are not clearly below those of
                        flexible modes, and were counted as flexible */
    double rigid_hz; /* largest |f| among them  [Hz] */
    double flexible_hz; /* of the lowest flexible mode  [Hz] */
} ritz_rounded;

/**
 * How rounding of K affects the responses of a component. Without positions, or
 * where a translation meets larger forces than rounding of K can leave, only
 * the modes that count as rigid are taken for rigid motions.
 *
 * @param[in] pairs        lowest modes of the component; if all are rigid, a
 *                         few more are computed
 * @param[in] by_matrices  the responses are computed from K. Responses from
 *                         modes are not affected by motions that are not
 *                         hidden, because rigid modes respond without stiffness
 */
ritz_status ritz_rounded_of(const ritz_component *component,
                            const ritz_pairs *pairs, bool by_matrices,
                            ritz_rounded *out);

/**
 * Frequency in Hz above which rounding of the rigid stiffness changes flexible
 * responses by less than a relative @p tolerance, where rigid and flexible
 * modes participate alike. With e the tolerance, r `rigid_hz` and f
 * `flexible_hz`, it is r / sqrt(e), or sqrt(f r / sqrt(e)) if f is above that.
 */
double ritz_rounded_ends(const ritz_rounded *rounded, double tolerance);

void ritz_component_free(ritz_component *component);

#pragma GCC visibility pop

#endif
