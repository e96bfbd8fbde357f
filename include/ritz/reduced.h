/*
 * A reduced component: M q'' + D q' + (K + i K4) q = B f, u = T q, small and
 * dense.
 *
 * It carries all that assembly and export need without the full matrices:
 * where its ports are and how they move with q, inputs and outputs, mass
 * properties, and what is known of its errors.
 */
#ifndef RITZ_REDUCED_H
#define RITZ_REDUCED_H

#include <ritz/basis.h>
#include <ritz/component.h>
#include <ritz/io.h>

#pragma GCC visibility push(default)

/* How a port moves: along basic axes, displacement = map q. */
typedef struct ritz_port_map {
    char name[RITZ_NAME_SIZE];
    double origin[3], axes[9];
    int64_t count;    /* p */
    ritz_dof *dof;    /* p, grid and basic direction of each row */
    double *position; /* p x 3, of that grid; zero for scalar points */
    ritz_dense map;   /* p x r */
} ritz_port_map;

/* One named number: an estimate or a measured error, and what it is held to. */
typedef struct ritz_measure {
    char name[RITZ_NAME_SIZE]; /* "frequency-relative" */
    double value;
    double limit;               /* NaN: none was asked */
    char where[RITZ_NAME_SIZE]; /* "mode 7, 3.41 Hz"; "" if nowhere special */
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
 * What the inertia of the body in a moving frame needs beyond M_r, in terms of
 * no code in particular. R (n x 6) holds unit rigid motions about the basic
 * origin; T_b (g x r) the translations of the g grids along basic axis b; X_b
 * (g) their positions; m (g x g) is the nodal mass, a third of the trace of
 * each 3 x 3 block of M that joins translations.
 *
 * The first two are of all of M. The others are exact where those blocks are
 * multiples of I3, as of solids and of lumped masses, and where no constraint
 * has moved mass to the rotations of what its dofs follow.
 */
typedef struct ritz_invariants {
    double rigid[36];    /* R'MR, symmetric */
    ritz_dense momentum; /* 6 x r, R'MT; {0}: none of this is known */
    ritz_dense position; /* 3 x 3r, (a, b r + k) is X_a' m T_b(:,k) */
    ritz_dense product;  /* 3r x 3r, (a r + j, b r + k) T_a(:,j)' m T_b(:,k) */
} ritz_invariants;

/* Nine r x r matrices: of more columns than this they are not kept. */
enum { RITZ_INVARIANT_COLUMNS = 400 };

/*
 * Columns so ordered that the first of them are a model too, and what is known
 * of such prefixes: see nested.h.
 */
typedef struct ritz_nested {
    int64_t smallest; /* columns of the smallest prefix; 0: it is not nested */
    int64_t count;    /* orders of which something is known */
    int64_t *order;   /* count, ascending */
    int64_t num_errors;
    char (*error)[RITZ_NAME_SIZE]; /* distinct names of measures */
    ritz_dense value; /* count x num_errors; NaN where not measured */
} ritz_nested;

typedef struct ritz_reduced {
    ritz_dense K, M, D, K4; /* r x r; D, K4 {0}: none. D may be unsymmetric */
    ritz_dampers dampers;   /* as of a component, for r coordinates */
    ritz_columns columns;
    ritz_origin origin;
    int64_t num_ports;
    ritz_port_map *port;
    ritz_io io; /* for r coordinates */
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
} ritz_reduced;

/**
 * Project a component on a basis: K_r = T'KT and so on, all ports and io.
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
 * Project once more: q = V p with V r x s (the second stage of COMPARE).
 * T becomes T V; columns are all of kind system.
 */
ritz_status ritz_reduced_project(const ritz_reduced *reduced,
                                 const ritz_dense *V, ritz_reduced *out);

/** Add its dampers to its D and K: see ritz_dampers_install. */
ritz_status ritz_reduced_install(ritz_reduced *reduced);

/** Port called @p name; NULL and a sentence if there is none. */
const ritz_port_map *ritz_reduced_port(const ritz_reduced *reduced,
                                       const char *name);

/** Mass, centre and inertia of a component by geometry: R'MR. */
ritz_status ritz_inertia_of(const ritz_component *component, ritz_inertia *out);

/**
 * Invariants of a component that moves by @p T; none, which is no failure, if
 * no grid has a position or there are more than RITZ_INVARIANT_COLUMNS.
 *
 * @param[in] T  n x r
 * @cost   O(r nnz + 4 n r^2), as much memory as T
 */
ritz_status ritz_invariants_of(const ritz_component *component,
                               const ritz_dense *T, ritz_invariants *out);

/** Those of T V, with V r x s; none of none. */
ritz_status ritz_invariants_project(const ritz_invariants *invariants,
                                    const ritz_dense *V, ritz_invariants *out);

/** Append a measure; @p where may be NULL. */
ritz_status ritz_measures_add(ritz_measures *measures, const char *name,
                              double value, double limit, const char *where);

/** The one called @p name; NULL if there is none. */
ritz_measure *ritz_measures_find(const ritz_measures *measures,
                                 const char *name);

/** Its value; NaN if there is none. */
double ritz_measures_value(const ritz_measures *measures, const char *name);

/** All of @p from in place of what @p out has. */
ritz_status ritz_measures_copy(const ritz_measures *from, ritz_measures *out);

void ritz_nested_free(ritz_nested *nested);
void ritz_invariants_free(ritz_invariants *invariants);
void ritz_measures_free(ritz_measures *measures);
void ritz_port_map_free(ritz_port_map *port);
void ritz_reduced_free(ritz_reduced *reduced);

#pragma GCC visibility pop

#endif
