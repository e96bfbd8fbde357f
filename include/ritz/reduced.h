/*
 * A reduced component: M q'' + D q' + (K + i K4) q = B f, u = T q, small and
 * dense.
 *
 * It has all that assembly and export need, without the full matrices: where
 * its ports are and how they move with q, inputs and outputs, mass properties,
 * and errors that are known.
 */
#ifndef RITZ_REDUCED_H
#define RITZ_REDUCED_H

#include <ritz/component.h>
#include <ritz/subspace.h>

#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* Motion of a port: its displacements along basic axes are map q. */
typedef struct ritz_port_map {
    char name[RITZ_NAME_SIZE];
    double origin[3], axes[9];
    int64_t count;    /* p */
    ritz_dof *dof;    /* p, grid and basic direction of each row */
    double *position; /* p x 3, of that grid; zero for scalar points */
    ritz_dense map;   /* p x r */
} ritz_port_map;

/* A named number, an estimate or a measured error, and its limit. */
typedef struct ritz_measure {
    char name[RITZ_NAME_SIZE]; /* "frequency-relative" */
    double value;
    double limit;               /* NaN: none was requested */
    char where[RITZ_NAME_SIZE]; /* "mode 7, 3.41 Hz"; "": of the whole model */
    char cause[RITZ_NAME_SIZE]; /* why a bound is far above the known error,
                                   such as "rounding"; "": it is not */
} ritz_measure;

typedef struct ritz_measures {
    int64_t count;
    ritz_measure *item;
} ritz_measures;

/* Mass properties about the basic origin, from M and rigid geometry. */
typedef struct ritz_inertia {
    double mass;      /* mean of the three translations */
    double centre[3]; /* of mass */
    double tensor[9]; /* about the centre, row by row */
    bool known;
} ritz_inertia;

/*
 * Inertia of the body in a moving frame that M_r does not include. R is
 * n x 6, unit rigid motions about the basic origin. A point of mass dm at x
 * moves by v_k in column k of T; x_a and v_ka are components along basic axis
 * a.
 *
 * `rigid` and `momentum` follow from all of M. The integrals `position` and
 * `product` are exact for isoparametric solids, lumped mass, rigid bodies at
 * grids (such as offset mass), straight beams with consistent mass (linear
 * along the axis, cubic across), and all of these where grids follow others
 * rigidly: M, the positions of grids and the line cells determine them. Other
 * elements, such as tapered or offset beams, are approximated by the nearest of
 * these. Then sum_a int v_ja v_ka is not M_r, and ritz-export states the
 * kinetic energy that is lost.
 */
typedef struct ritz_invariants {
    double rigid[36];    /* R'MR, symmetric */
    ritz_dense momentum; /* 6 x r, R'MT; {0}: none of this is known */
    ritz_dense position; /* 3 x 3r, (a, b r + k) is int x_a v_kb dm */
    ritz_dense product;  /* 3r x 3r, (a r + j, b r + k) is int v_ja v_kb dm */
} ritz_invariants;

/* `product` has nine r x r blocks. Reduced components of more columns than this
   have no invariants. */
enum { RITZ_INVARIANT_COLUMNS = 400 };

/* Errors of the smaller models that the first columns make: see "Nested reduced
   components" below. */
typedef struct ritz_nested {
    int64_t smallest; /* columns of the smallest prefix; 0: it is not nested */
    int64_t count;    /* numbers of columns for which an error is known */
    int64_t *order;   /* count, ascending */
    int64_t num_errors;
    char (*error)[RITZ_NAME_SIZE]; /* distinct names of measures */
    ritz_dense value; /* count x num_errors; NaN where not measured */
} ritz_nested;

/* Geometric stiffness of one unit load, in reduced coordinates. */
typedef struct ritz_reduced_load {
    char name[RITZ_NAME_SIZE];
    ritz_dense KG; /* r x r, symmetric */
} ritz_reduced_load;

typedef struct ritz_reduced {
    ritz_dense K, M, D, K4; /* r x r; D, K4 {0}: none. D may be unsymmetric */
    int64_t num_loads;
    ritz_reduced_load *load;
    ritz_dampers dampers; /* as of a component, for r coordinates */
    ritz_columns columns;
    ritz_origin origin;
    int64_t num_ports;
    ritz_port_map *port;
    ritz_io io; /* for r coordinates */
    int64_t num_quantities;
    ritz_quantity *quantity;
    ritz_inertia inertia;
    ritz_invariants invariants;
    ritz_dense T;           /* n x r; {0} without basis */
    int64_t num_dofs;       /* n, of the full component */
    ritz_dof *dof;          /* n; NULL without basis */
    ritz_grids grids;       /* of the full component; {0} without basis */
    ritz_elements elements; /* the same */
    ritz_recovery recovery; /* the same, from its n dofs */
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads; "" none */
    ritz_measures estimates;         /* by ritz-reduce */
    ritz_measures errors;            /* by ritz-verify */
    ritz_nested nested;
    char units[RITZ_NAME_SIZE];
    char remark[4 * RITZ_NAME_SIZE]; /* the remark of the basis; not stored */
} ritz_reduced;

/**
 * Project a component on a basis: K_r = T'KT, likewise the other matrices,
 * ports, inputs and outputs.
 *
 * Columns of kind massless have no mass, no damping and no part in the
 * invariants: their rows and columns of M and D are zero.
 *
 * @param[in] T  n x r, columns independent
 * @return RITZ_ERR_ARGUMENT if the sizes disagree, or the basis is of states or
 *         has left vectors: see ritz_reduce_states and ritz_reduce_companion
 * @cost   O(r nnz + n r^2)
 */
ritz_status ritz_reduce(const ritz_component *component,
                        const ritz_basis *basis, ritz_reduced *out);

/**
 * Project a reduced component once more: q = V p with V r x s, as in the second
 * stage of COMPARE. T becomes T V, and all columns are of kind system.
 */
ritz_status ritz_reduced_project(const ritz_reduced *reduced,
                                 const ritz_dense *V, ritz_reduced *out);

/** Add its dampers to its D and K: see ritz_dampers_install. */
ritz_status ritz_reduced_install(ritz_reduced *reduced);

/**
 * A reduced component as a component that can be reduced again: its coordinates
 * become dofs, the scalar points 1, 2, ... Ports are left out, since a port dof
 * depends on several coordinates.
 *
 * @return RITZ_ERR_ARGUMENT if @p reduced has columns of kind force, or modes
 *         with a negative eigenvalue, which force columns cause in a system
 */
ritz_status ritz_component_of_reduced(const ritz_reduced *reduced,
                                      ritz_component *out);

/**
 * How a port moves by its rows of @p T, turned into basic axes; NULL: by its
 * own dofs.
 *
 * @return as ritz_port_turn
 */
ritz_status ritz_port_map_of(const ritz_component *component,
                             const ritz_port *port, const ritz_dense *T,
                             ritz_port_map *map);

/** As ritz_component_port. */
const ritz_port_map *ritz_reduced_port(const ritz_reduced *reduced,
                                       const char *name);

/** Mass, centre and inertia of a component by geometry: R'MR. */
ritz_status ritz_inertia_of(const ritz_component *component, ritz_inertia *out);

/**
 * Invariants of a component that moves by @p T; none, which is no failure, if
 * no grid has a position or there are more than RITZ_INVARIANT_COLUMNS.
 *
 * @param[in] T  n x r
 * @cost   O(r nnz + 4 n r^2), 18 n r^2 where all grids are of beams; as much
 *         memory as T, five times as much for beams
 */
ritz_status ritz_invariants_of(const ritz_component *component,
                               const ritz_dense *T, ritz_invariants *out);

/** Invariants of T V, with V r x s; empty if those of T are. */
ritz_status ritz_invariants_project(const ritz_invariants *invariants,
                                    const ritz_dense *V, ritz_invariants *out);

/** Set the cause of the measure that was added last: why its value is far above
 * the known error. */
void ritz_measures_name_cause(ritz_measures *measures, const char *cause);

/** Append a measure; @p where may be NULL. */
ritz_status ritz_measures_add(ritz_measures *measures, const char *name,
                              double value, double limit, const char *where);

/** The one called @p name; NULL if there is none. */
ritz_measure *ritz_measures_find(const ritz_measures *measures,
                                 const char *name);

/** Its value; NaN if there is none. */
double ritz_measures_value(const ritz_measures *measures, const char *name);

/** Copy all of @p from; what @p out held is freed. */
ritz_status ritz_measures_copy(const ritz_measures *from, ritz_measures *out);

/** T'KG T of each load; NULL if there is none. */
ritz_status ritz_loads_reduce(int64_t count, const ritz_load *load,
                              const ritz_dense *T, ritz_reduced_load **out);

/** V'KG V of each load, or copies if @p V is NULL; NULL if there is none. */
ritz_status ritz_loads_project(int64_t count, const ritz_reduced_load *load,
                               const ritz_dense *V, ritz_reduced_load **out);

/** Average away an asymmetry up to 1e-6 of the largest entry, as for the
 * stiffness of a component. @return RITZ_ERR_FORMAT if it is larger */
ritz_status ritz_reduced_load_settle(ritz_reduced_load *load);

void ritz_reduced_load_free(ritz_reduced_load *load);
void ritz_nested_free(ritz_nested *nested);
void ritz_invariants_free(ritz_invariants *invariants);
void ritz_measures_free(ritz_measures *measures);
void ritz_port_map_free(ritz_port_map *port);
void ritz_reduced_free(ritz_reduced *reduced);

/*
 * Nested reduced components: the first columns, from `smallest` on, are a
 * reduced component too, so that fewer are used without a new reduction. Such a
 * prefix is Galerkin's model in the subspace of its columns: its matrices are
 * the leading blocks, it is as stable as the whole, and its frequencies lie
 * above those of the whole.
 */

/**
 * A nested reduced component of columns order_of_columns[0], [1], ..., numbered
 * from 0 and distinct: its matrices, dampers, ports, inputs and outputs,
 * invariants and T. Known errors are kept only if all columns are, because they
 * do not hold for fewer.
 *
 * @param[in] smallest  1 .. count: no prefix is shorter
 * @return RITZ_ERR_ARGUMENT if a column does not exist, or is listed twice
 */
ritz_status ritz_reduced_nest(const ritz_reduced *in, int64_t count,
                              const int64_t *order_of_columns, int64_t smallest,
                              ritz_reduced *out);

/**
 * The reduced component of the first @p order columns. Errors that
 * ritz_nested_note stored for that order become its errors, or its estimates if
 * their names end in "-bound".
 *
 * @return RITZ_ERR_ARGUMENT if it is not nested or has no such prefix
 */
ritz_status ritz_reduced_prefix(const ritz_reduced *in, int64_t order,
                                ritz_reduced *out);

/**
 * Store the error of the first @p order columns by one measure; a second value
 * replaces the first.
 *
 * @return RITZ_ERR_ARGUMENT as ritz_reduced_prefix, or if @p name cannot be a
 *         name
 */
ritz_status ritz_nested_note(ritz_reduced *reduced, int64_t order,
                             const char *name, double value);

#pragma GCC visibility pop

#endif
