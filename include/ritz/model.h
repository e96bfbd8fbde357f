/*
 * Models: components, bases, reduced components, systems and state spaces, and
 * a reference to any of them.
 */
#ifndef RITZ_MODEL_H
#define RITZ_MODEL_H

#include <ritz/parts.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/*
 * A component: the finite-element model of one body,
 *
 *     M u'' + D u' + (K + i K4) u = B f,    y = C u + Cv u' + Ca u''
 *
 * with rows named by grid and direction. Displacements of a grid are along the
 * axes of its displacement frame; positions, port origins and port axes are in
 * the component's basic frame.
 */

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
    int64_t num_quantities;
    ritz_quantity *quantity;
    ritz_dampers dampers;            /* K and D hold none of them */
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

/*
 * A basis: the subspace in which a component is reduced, u = T q or, of states,
 * [u; u'] = T z.
 */

/* A method that makes another kind adds it here, and its name in basis.c. */
typedef enum ritz_column_kind {
    RITZ_COLUMN_RIGID,      /* free rigid-body motion */
    RITZ_COLUMN_CONSTRAINT, /* response to unit motion of an attached dof */
    RITZ_COLUMN_NORMAL,     /* eigenvector, interface clamped or free */
    RITZ_COLUMN_RESIDUAL,   /* response to a unit force, less kept modes */
    RITZ_COLUMN_SYSTEM,     /* part of system modes, from the second stage */
    RITZ_COLUMN_KRYLOV, /* of a block Krylov sequence, any expansion point */
    RITZ_COLUMN_STATIC, /* static Ritz vector: response to a load */
    RITZ_COLUMN_ATTACHMENT, /* inertia-relief attachment mode */
    RITZ_COLUMN_INTERFACE,  /* characteristic constraint mode */
    RITZ_COLUMN_MASSLESS,   /* residual flexibility, its mass left out */
    RITZ_COLUMN_FORCE,      /* residual flexibility of a dual interface force */
    RITZ_COLUMN_STATE,      /* of a first-order basis */
    RITZ_COLUMN_PERTURBED,  /* a state that responds statically */
    RITZ_COLUMN_BALANCED,   /* balanced, of second order */
} ritz_column_kind;

/* Kind and origin of each of r columns. */
typedef struct ritz_columns {
    int64_t count;
    ritz_column_kind *kind;
    int64_t *dof;     /* row of the full component it attaches; -1 where none */
    double *hertz;    /* NaN where none */
    double *residual; /* relative, of the eigenpair; NaN where none */
    /* bound of the relative error of the eigenvalue, of engines that find it
       approximately; NaN where none. NULL: none at all */
    double *error;
} ritz_columns;

/* How it was made. */
typedef struct ritz_origin {
    char method[RITZ_NAME_SIZE];
    char options[RITZ_NAME_SIZE];   /* as asked: "modes 12" */
    char reference[RITZ_NAME_SIZE]; /* key in docs/references.bib */
    char engine[RITZ_NAME_SIZE];    /* "dense LAPACK", "CHOLMOD + ARPACK" */
    const char
        *reason; /* why this engine was chosen, one phrase; NULL: there was
                           no choice, or the basis was read from a file */
} ritz_origin;

/*
 * T, n x r, and of each of its columns what it is. Of states T has 2n rows, n
 * displacements and then n velocities, or the states of a state space; left
 * vectors W may be given too: see ritz_reduce_states.
 */
typedef struct ritz_basis {
    ritz_dense T;
    ritz_dense W; /* as T; {0}: T itself */
    bool states;
    int64_t num_hankel; /* values of the model that was balanced; 0: none */
    double *hankel;     /* descending */
    double bound; /* of the H-infinity error, outputs over their limits, where
                     there are Hankel values; NaN: they bound nothing */
    char damping[RITZ_DAMPING_SIZE]; /* of states, or with a W: what they were
                                        made with, by ritz_damping_parse */
    double among_hz; /* they are made of modes up to here alone; 0: of all */
    ritz_columns columns;
    ritz_origin origin;
    char units[RITZ_NAME_SIZE];      /* of the model, "kg m s" */
    char remark[4 * RITZ_NAME_SIZE]; /* what a user should know; not stored */
} ritz_basis;

/** @p r columns of kind normal, with neither dof nor hertz nor residual. */
ritz_status ritz_columns_new(int64_t r, ritz_columns *out);

/** Columns at[0], at[1], ... in place of @p out; @p at NULL: the first ones. */
ritz_status ritz_columns_pick(const ritz_columns *columns, int64_t count,
                              const int64_t *at, ritz_columns *out);

/** Basis of @p r zero columns for @p n dofs. */
ritz_status ritz_basis_new(int64_t n, int64_t r, ritz_basis *out);

/** Name of a kind, as files hold it: "normal". */
const char *ritz_column_name(ritz_column_kind kind);

/** Kind of that name; false if there is none. */
bool ritz_column_find(const char *name, ritz_column_kind *out);

void ritz_columns_free(ritz_columns *columns);
void ritz_basis_free(ritz_basis *basis);

/*
 * A reduced component: M q'' + D q' + (K + i K4) q = B f, u = T q, small and
 * dense.
 *
 * It carries all that assembly and export need without the full matrices:
 * where its ports are and how they move with q, inputs and outputs, mass
 * properties, and what is known of its errors.
 */

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
    double limit;               /* NaN: none was requested */
    char where[RITZ_NAME_SIZE]; /* "mode 7, 3.41 Hz"; "" if nowhere special */
    char cause[RITZ_NAME_SIZE]; /* why a bound is far above the known error:
                                   "rounding"; else "" */
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
 * Inertia of the body in a moving frame, beyond M_r. R (n x 6) holds unit rigid
 * motions about the basic origin. A point of mass dm at x moves by v_k in
 * column k of T, x_a and v_ka along basic axis a.
 *
 * The first two are of all of M. The integrals of the others are exact for what
 * M, the places of grids and line cells tell: isoparametric solids, lumped mass,
 * rigid bodies at grids, such as offset mass, straight beams with consistent
 * mass (linear along the axis, cubic across) and all of these with grids that
 * follow others rigidly. Of what is none of these, such as tapered or offset
 * beams, what M shares with one of them is taken: then sum_a int v_ja v_ka is
 * not M_r, and ritz-export states the kinetic energy that is lost.
 */
typedef struct ritz_invariants {
    double rigid[36];    /* R'MR, symmetric */
    ritz_dense momentum; /* 6 x r, R'MT; {0}: none of this is known */
    ritz_dense position; /* 3 x 3r, (a, b r + k) is int x_a v_kb dm */
    ritz_dense product;  /* 3r x 3r, (a r + j, b r + k) is int v_ja v_kb dm */
} ritz_invariants;

/* Nine r x r matrices: of more columns than this they are not kept. */
enum { RITZ_INVARIANT_COLUMNS = 400 };

/* Columns so ordered that the first of them are a model too: see below. */
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

/** Invariants of T V, with V r x s; none of none. */
ritz_status ritz_invariants_project(const ritz_invariants *invariants,
                                    const ritz_dense *V, ritz_invariants *out);

/** Store why the bound that was added last is far above the known error. */
void ritz_measures_name_cause(ritz_measures *measures, const char *cause);

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

/*
 * Nested reduced components: the first columns, from `smallest` on, are a
 * reduced component too, so that fewer are used without a new reduction. Such a
 * prefix is Galerkin's model in the subspace of its columns: its matrices are
 * the leading blocks, it is as stable as the whole, and its frequencies lie
 * above those of the whole.
 */

/**
 * Columns order_of_columns[0], [1], ..., from 0 and distinct, and all that has
 * columns: matrices, dampers, ports, inputs and outputs, invariants, T. Errors
 * stay known if all columns are there; they are not true of some.
 *
 * @param[in] smallest  1 .. count: no prefix is shorter
 * @return RITZ_ERR_ARGUMENT if a column is not there, or there twice
 */
ritz_status ritz_reduced_nest(const ritz_reduced *in, int64_t count,
                              const int64_t *order_of_columns, int64_t smallest,
                              ritz_reduced *out);

/**
 * Its first @p order columns alone, a copy if these are all. Errors that were
 * noted of that order become known: names that end in "-bound" as estimates.
 *
 * @return RITZ_ERR_ARGUMENT if it is not nested or has no such prefix
 */
ritz_status ritz_reduced_prefix(const ritz_reduced *in, int64_t order,
                                ritz_reduced *out);

/**
 * Note the value of a measure of a prefix; a second value replaces the first.
 *
 * @return RITZ_ERR_ARGUMENT as above, or if the name cannot be one
 */
ritz_status ritz_nested_note(ritz_reduced *reduced, int64_t order,
                             const char *name, double value);

/*
 * A system: components joined at one or several configurations.
 *
 * At a configuration the coordinates q of all components, one block after the
 * other, are q = P x with the joints' constraints C P = 0; x are the system's
 * own coordinates: its mass-normalised modes, rigid ones first, so that M = I
 * and K = diag(lambda).
 */

typedef struct ritz_configuration {
    char at[RITZ_NAME_SIZE]; /* "clock=60,cone=0" */
    int64_t num_settings;
    double *setting;      /* one for each sweep of the scene, in its order */
    int64_t rank;         /* of the constraints */
    ritz_dense K, M;      /* e x e */
    ritz_dense D, K4;     /* e x e; {0}: none but the damping of the system */
    ritz_dampers dampers; /* of all bodies; K and D hold them */
    double *lambda; /* e, ascending; by size where a dual assembly has negative
                       ones  [rad^2/s^2] */
    int64_t num_rigid;
    ritz_io io;           /* for e coordinates */
    int64_t num_blocks;   /* as many as there are components */
    ritz_dense *P;        /* num_blocks, r_c x e */
    ritz_dense momentum;  /* 6 x e, R'M P of all bodies, R the rigid motions
                             about the origin of the first body's basic frame;
                             {0}: not known of every body */
    double rigid[36];     /* R'MR, symmetric */
    ritz_dense places;    /* num_blocks x 12: rotation R, row by row, and
                             translation t of each body, whose points x are at R
                             x + t; {0}: not known */
    ritz_measures errors; /* by ritz-verify or ritz-compare */
} ritz_configuration;

/* A component of a system: rows first .. first + order - 1 of q are its own. */
typedef struct ritz_block {
    char name[RITZ_NAME_SIZE];
    int64_t first, order; /* r_c */
    int64_t order_full;   /* n of the full component */
} ritz_block;

typedef struct ritz_system {
    char name[RITZ_NAME_SIZE];
    int64_t num_components;
    ritz_block *component;
    int64_t num_sweeps;
    char (*sweep)[RITZ_NAME_SIZE];
    int64_t num_configurations;
    ritz_configuration *configuration;
    double band_hz[2];
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads */
    char units[RITZ_NAME_SIZE];
} ritz_system;

/**
 * The configuration that @p at names: "clock=60,slide=0.5", settings compared
 * within 1e-9; joints that are not named must have one setting only.
 * NULL @p at: the only configuration.
 *
 * @return RITZ_ERR_ARGUMENT listing what there is
 */
ritz_status ritz_system_find(const ritz_system *system, const char *at,
                             const ritz_configuration **out);

/** "clock=60,slide=0.5" from names and settings. */
void ritz_configuration_name(int64_t count, const char *sweep, size_t stride,
                             const double *setting, char out[RITZ_NAME_SIZE]);

/**
 * Change K and D to what the dampers are now: see ritz_dampers_install. lambda
 * stays what it was.
 */
ritz_status ritz_configuration_install(ritz_configuration *configuration);

/**
 * A system at one of its configurations, as a reduced component whose
 * coordinates are the modes of the system, rigid ones without stiffness. The
 * component has inputs, outputs, dampers, damping, mass properties and errors.
 * It has neither ports nor T, because shapes are those of the bodies.
 */
ritz_status ritz_reduced_of_configuration(const ritz_system *system,
                                          const ritz_configuration *at,
                                          ritz_reduced *out);

/**
 * Whether these are the bodies of a system, in its order: sum_c P_c' M_c P_c is
 * its mass.
 *
 * @return RITZ_ERR_ARGUMENT if they are not
 */
ritz_status ritz_system_check_bodies(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies);

/**
 * Give a system at a configuration the ports of its bodies, "body/port", where
 * the configuration puts them and along the axes of the system. Numbers of
 * grids of body k (k = 0, 1, ...) are increased by k times the power of ten
 * above all of them. A port with only some directions of a grid keeps them
 * along the axes of its body.
 *
 * @param[in,out] reduced  of ritz_reduced_of_configuration, without ports
 * @return RITZ_ERR_ARGUMENT as ritz_system_check_bodies, or if the system does
 *         not say where its bodies are
 */
ritz_status ritz_reduced_place_ports(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies,
                                     ritz_reduced *reduced);

void ritz_configuration_free(ritz_configuration *configuration);
void ritz_system_free(ritz_system *system);

/*
 * A modal model: each flexible mode by itself, with modal damping.
 *
 *     q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = b_k u,
 *     y = sum_k c_k q_k + cv_k q_k' + ca_k q_k''
 */

/*
 * Flexible modes of a model and their participation in inputs and outputs.
 * Where damping couples rigid modes to flexible ones, the rigid modes follow
 * the flexible ones in the rows of B, the columns of C and Cv, and in Delta.
 */
typedef struct ritz_modal {
    int64_t count;     /* m */
    double *omega;     /* m, ascending, positive  [rad/s] */
    double *zeta;      /* m, from the diagonal of damping; positive unless
                          damping couples modes */
    ritz_dense B;      /* m + r x inputs, inputs scaled by their weights */
    ritz_dense C, Cv;  /* outputs x m + r, divided by limits. Acceleration
                          outputs are expressed by displacements and velocities,
                          without their feedthrough */
    int64_t num_rigid; /* r */
    ritz_dense Delta;  /* m + r x m + r, Phi'D Phi; {0}: damping couples no
                          modes and is diag(2 zeta omega) */
    ritz_dense Ca;     /* outputs x m + r: the accelerations that C and Cv
                          express; {0} if Delta is */
} ritz_modal;

/*
 * A linear model in first-order form:
 *
 *     E x' = A x + B u,    y = C x + D u
 *
 * with A and E either small and dense or sparse. For second-order models x =
 * [u; u'].
 */

/* Most dofs of a component that is converted to a dense first-order model; a
   dense state space has at most twice as many states. */
enum { RITZ_STATE_DOFS = 1500 };

/* An imported state space with more states than this stays sparse if at most a
   tenth of the entries of A and E is not zero. */
enum { RITZ_SPARSE_STATES = 600 };

typedef struct ritz_state_space {
    ritz_dense A, B, C, D; /* D is always there */
    ritz_dense E;          /* invertible; {0}: the identity */
    ritz_sparse sA, sE; /* sparse model: used instead of A and E, which are then
                           {0}; sE {0}: the identity. sA {0}: the model is
                           dense */
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];
    char (*output)[RITZ_NAME_SIZE];
    double *limit;        /* num_outputs, largest tolerated |y|; NaN: none */
    ritz_columns columns; /* what each state is */
    ritz_origin origin;
    char damping[RITZ_DAMPING_SIZE]; /* that is in A, without D; "" none */
    ritz_measures estimates;         /* by ritz-reduce: stability, a bound */
    ritz_measures errors;            /* by ritz-verify */
    char units[RITZ_NAME_SIZE];
} ritz_state_space;

/** Zero matrices (E the identity), names and limits taken from @p io. */
ritz_status ritz_state_space_new(int64_t states, const ritz_io *io,
                                 ritz_state_space *out);

/** A state space of sparse A and E, which are copied; E {0}: the identity. */
ritz_status ritz_state_space_of_sparse(const ritz_sparse *A,
                                       const ritz_sparse *E, const ritz_io *io,
                                       ritz_state_space *out);

/** Number of states. */
int64_t ritz_state_space_order(const ritz_state_space *model);

/** Whether A and E are sparse. */
bool ritz_state_space_is_sparse(const ritz_state_space *model);

/**
 * The model with dense A and E: @p model itself if it is dense, else a dense
 * copy written to @p made, which the caller frees.
 *
 * @return RITZ_ERR_ARGUMENT if the model is sparse and has more than 2
 *         RITZ_STATE_DOFS states
 */
ritz_status ritz_state_space_dense(const ritz_state_space *model,
                                   ritz_state_space *made,
                                   const ritz_state_space **out);

/**
 * Whether all parts fit each other, values are finite and E, if there is one,
 * is not singular.
 *
 * @return RITZ_ERR_FORMAT with what does not
 */
ritz_status ritz_state_space_check(const ritz_state_space *model);

/**
 * A component with its damping: that of its matrices and dampers, and
 * @p damping in addition, ratios by all its modes, a M + b K exactly.
 *
 * x = [u; u'] where M is definite. Where it is not, x = [q; q'] of the modes
 * that have mass, and the static response of massless dofs is in D.
 *
 * @return RITZ_ERR_ARGUMENT if there are more than RITZ_STATE_DOFS dofs, if
 *         there is structural damping, which is of harmonic motion alone, or if
 *         a massless dof is damped, or driven and observed by its velocity;
 *         RITZ_ERR_SINGULAR if K + M is
 * @cost   O(n^3), n dofs
 */
ritz_status ritz_state_space_of_component(const ritz_component *component,
                                          const ritz_damping *damping,
                                          ritz_state_space *out);

/**
 * A component in a basis of states: with E = [I 0; 0 M] of its first-order form
 *
 *     W'E T x' = W'A T x + W'B u
 *
 * solved for x'. Massless dofs respond as above. Columns of kind perturbed
 * respond statically and are eliminated, and a bound of the error is noted as
 * estimate "h-infinity-bound".
 *
 * Of more than RITZ_STATE_DOFS dofs nothing dense is made; damping ratios then
 * need basis->among_hz, and dofs without mass must be without input.
 *
 * @param[in] basis  of states, W {0}: T itself
 * @return RITZ_ERR_ARGUMENT if it is no such basis, or sizes disagree, or as
 *         above; RITZ_ERR_SINGULAR if W'E T is, or the columns that are to be
 *         eliminated have no static response
 */
ritz_status ritz_reduce_states(const ritz_component *component,
                               const ritz_damping *damping,
                               const ritz_basis *basis, ritz_state_space *out);

/**
 * A state space in a basis of its states: W'E T z' = W'A T z + W'B u, y = C T z
 * + D u, solved for z'; columns of kind perturbed, and the bound, as above.
 *
 * @return RITZ_ERR_ARGUMENT if it is no such basis, or sizes disagree;
 *         RITZ_ERR_SINGULAR as above
 */
ritz_status ritz_reduce_space(const ritz_state_space *full,
                              const ritz_basis *basis, ritz_state_space *out);

/**
 * A component in a basis of displacements u = T q with left vectors W of its
 * own, in companion form x = [q; q'], which is still of second order:
 *
 *     A = [0 I; -M_r^-1 K_r, -M_r^-1 D_r],   B = [0; M_r^-1 W'B],
 *     M_r = W'M T,   K_r = W'K T,   D_r = W'D T
 *
 * K_r and D_r need not be symmetric, which is why this is no ritz_reduced.
 * Rigid columns, which must be M-orthogonal to all others, have no part in K_r.
 *
 * @return RITZ_ERR_ARGUMENT if the basis is of states, or has no W, or as
 *         ritz_reduce_states; RITZ_ERR_SINGULAR if M_r is
 */
ritz_status ritz_reduce_companion(const ritz_component *component,
                                  const ritz_damping *damping,
                                  const ritz_basis *basis,
                                  ritz_state_space *out);

/**
 * A reduced component in first-order form, with its estimates and errors. Its
 * dampers count as far as they are installed.
 *
 * @return as ritz_state_space_of_component
 */
ritz_status ritz_states_of_reduced(const ritz_reduced *reduced,
                                   const ritz_damping *damping,
                                   ritz_state_space *out);

/**
 * Poles: eigenvalues of A, or of E^-1 A, by magnitude ascending; of a pair the
 * one above the axis first. To be freed.
 *
 * @return RITZ_ERR_CONVERGENCE, or as ritz_state_space_dense
 */
ritz_status ritz_state_space_poles(const ritz_state_space *model,
                                   int64_t *count, double _Complex **out);

void ritz_state_space_free(ritz_state_space *model);

/*
 * Small dense matrices and what drives and observes them, borrowed; D, K4 NULL
 * or {0}: there is none.
 */
typedef struct ritz_second_order {
    const ritz_dense *K, *M, *D, *K4;
    const ritz_io *io;
} ritz_second_order;

typedef enum ritz_model_kind {
    RITZ_MODEL_COMPONENT = 1, /* full and sparse */
    RITZ_MODEL_DENSE = 2,     /* a reduced component, or a configuration */
    RITZ_MODEL_STATES = 4,
} ritz_model_kind;

/*
 * A model of any kind whose poles, zeros, response or motion is wanted: a
 * reference that borrows all it names and is passed by value. Dampers act as
 * far as they are installed.
 */
typedef struct ritz_model {
    ritz_model_kind kind;
    union {
        const ritz_component *component;
        ritz_second_order dense;
        const ritz_state_space *states;
    };
    const ritz_reduced
        *reduced; /* whose matrices `dense` are; NULL: no one's */
    const ritz_dampers *dampers; /* of second order; NULL: none */
    const ritz_damping *damping; /* in addition to that of matrices; NULL: none.
                                    Of a state space it is in A */
} ritz_model;

ritz_model ritz_model_of_component(const ritz_component *component,
                                   const ritz_damping *damping);
ritz_model ritz_model_of_reduced(const ritz_reduced *reduced,
                                 const ritz_damping *damping);
ritz_model ritz_model_of_configuration(const ritz_configuration *configuration,
                                       const ritz_damping *damping);
ritz_model ritz_model_of_dense(const ritz_second_order *matrices,
                               const ritz_damping *damping);
ritz_model ritz_model_of_states(const ritz_state_space *states);

/** Number of dofs, reduced coordinates or states. */
int64_t ritz_model_order(ritz_model model);

/** Inputs and outputs, borrowed; names and limits alone of a state space. */
ritz_io ritz_model_io(ritz_model model);

/**
 * The model in dense first-order form: @p model itself if it is a dense state
 * space, else a new one written to @p made, which the caller frees.
 *
 * @return as ritz_state_space_of_component, or as ritz_state_space_dense
 */
ritz_status ritz_model_states(ritz_model model, ritz_state_space *made,
                              const ritz_state_space **out);

#pragma GCC visibility pop

#endif
