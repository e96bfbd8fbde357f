/*
 * What models are made of: degrees of freedom, damping, dampers, inputs and
 * outputs, grids and cells, constraint equations.
 *
 * Rows are counted from 0 inside the library. Users never see row numbers:
 * messages name grid and direction, "grid 101 T3".
 */
#ifndef RITZ_PARTS_H
#define RITZ_PARTS_H

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* Directions of a grid: 1-3 translations, 4-6 rotations, 0 a scalar point. */
typedef struct ritz_dof {
    int64_t grid;
    int64_t component;
} ritz_dof;

typedef struct ritz_dofs {
    int64_t count;
    int64_t *at; /* count distinct row numbers, from 0, in the owner's order */
} ritz_dofs;

/**
 * The rows of 0..n-1 that are not in @p set, ascending.
 *
 * @return RITZ_ERR_ARGUMENT if a member of @p set is out of range or repeated
 */
ritz_status ritz_dofs_complement(const ritz_dofs *set, int64_t n,
                                 ritz_dofs *out);
ritz_status ritz_dofs_copy(const ritz_dofs *set, ritz_dofs *out);
void ritz_dofs_free(ritz_dofs *set);

enum { RITZ_DOF_NAME_SIZE = 40 };

/** "grid 101 T3", "grid 101 R1", "point 2001"; returns @p text. */
const char *ritz_dof_name(ritz_dof dof, char text[RITZ_DOF_NAME_SIZE]);

/** Order of two ritz_dof, for qsort and bsearch: by grid, then direction. */
int ritz_dof_compare(const void *left, const void *right);

/** Sort a list and keep each dof once. @return how many are left */
int64_t ritz_dof_distinct(int64_t count, ritz_dof *dof);

/*
 * Damping as scenes and options state it, in addition to that of matrices.
 *
 * Text form, one word and numbers: "modal 0.002"; "modes 0.01 0.02" (of the
 * first flexible mode, the second, ...; the last for all above); "bands 0 5
 * 0.002 5 20 0.005" (from Hz, to Hz, ratio; ...); "rayleigh a b" (D = a M +
 * b K); "fit 1 0.01 10 0.02" (Hz, ratio; ...: the a and b that come nearest).
 */

enum {
    RITZ_MAX_BANDS = 8,
    RITZ_MOST_RATIOS = 40,
    RITZ_MOST_POINTS = 20,
    RITZ_DAMPING_SIZE = 1024, /* room for the longest text and its NUL */
};

typedef enum ritz_damping_kind {
    RITZ_DAMPING_NONE,
    RITZ_DAMPING_MODAL,
    RITZ_DAMPING_BANDS,
    RITZ_DAMPING_RAYLEIGH,
    RITZ_DAMPING_MODES,
    RITZ_DAMPING_FIT,
} ritz_damping_kind;

typedef struct ritz_damping {
    ritz_damping_kind kind;
    double zeta;                       /* modal */
    int64_t count;                     /* bands, modes, points of a fit */
    double band[RITZ_MAX_BANDS][3];    /* from Hz, to Hz, zeta */
    double ratio[RITZ_MOST_RATIOS];    /* modes */
    double point[RITZ_MOST_POINTS][2]; /* fit: Hz, zeta */
    double a, b;                       /* rayleigh, and of a fit */
} ritz_damping;

/**
 * Whether a damping makes sense: ratios above 0 and below 1; bands that ascend
 * from 0 Hz and do not overlap; a and b not negative nor both 0; two different
 * frequencies at least in a fit.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_damping_check(const ritz_damping *damping);

/** @return RITZ_ERR_ARGUMENT with what is wrong; "" is no damping */
ritz_status ritz_damping_parse(const char *text, ritz_damping *out);

/** Text of a checked damping, shortest digits that read back the same. */
void ritz_damping_print(const ritz_damping *damping,
                        char text[RITZ_DAMPING_SIZE]);

/**
 * Set a and b of a fit whose points are checked where
 *
 *     sum_k ((a / w_k + b w_k) / 2 - zeta_k)^2
 *
 * is least for a, b >= 0.
 */
void ritz_damping_fit(ritz_damping *damping);

/** Whether it is a M + b K, as stated or as fitted. */
bool ritz_damping_is_rayleigh(const ritz_damping *damping);

/** Whether the damping is given as ratios, each of a mode.
 * @param[in] damping  may be NULL */
bool ritz_damping_has_ratios(const ritz_damping *damping);

/**
 * Largest |ratio of the fit - ratio asked| of its points, which is at point
 * @p at; 0 of another kind.
 */
double ritz_damping_misfit(const ritz_damping *damping, int64_t *at);

/**
 * Damping ratio of flexible mode @p mode, 0 being the first, at @p omega rad/s;
 * of mode -1 that of all above those listed. 0 outside all bands; an edge that
 * two bands share belongs to the upper one. Rayleigh: (a / omega + b omega) / 2
 * or, where omega is 0 and no ratio stands for a, 0.
 */
double ritz_damping_of_mode(const ritz_damping *damping, int64_t mode,
                            double omega);

/*
 * Discrete dampers (and springs) kept apart from D and K, so that they can be
 * retuned after reduction: damper j adds c_j b_j b_j' to D and k_j b_j b_j' to
 * K, b_j being its influence vector, +1 and -1 at the dofs it lies between.
 *
 * D and K of a component and of its reduction hold nothing of them, and bases
 * are made without them; a response, poles, errors, assembly and export install
 * them first. What D and K hold already is kept beside c and k, so that
 * installing twice adds nothing, and installing after a change of c or k adds
 * the difference.
 */

typedef struct ritz_dampers {
    int64_t count;
    char (*name)[RITZ_NAME_SIZE]; /* distinct; "body/name" in a system */
    double *c, *k;                /* either sign of k, c >= 0 */
    double *held_c, *held_k;      /* that D and K hold already */
    ritz_dense B;                 /* n x count */
} ritz_dampers;

/** @p count dampers without name, c and k, for @p n coordinates. */
ritz_status ritz_dampers_new(int64_t n, int64_t count, ritz_dampers *out);

/** In the subspace x = T q: T'B; names, c and k kept. */
ritz_status ritz_dampers_project(const ritz_dampers *dampers,
                                 const ritz_dense *T, ritz_dampers *out);

ritz_status ritz_dampers_copy(const ritz_dampers *dampers, ritz_dampers *out);

/**
 * Append @p more, whose coordinates are rows first, first + 1, ... of the @p n
 * that all have; with @p owner each is called "owner/name".
 *
 * @return RITZ_ERR_ARGUMENT if a name becomes too long
 */
ritz_status ritz_dampers_append(const ritz_dampers *more, const char *owner,
                                int64_t n, int64_t first,
                                ritz_dampers *dampers);

/**
 * Whether dampers make sense for a model of @p n coordinates: names there and
 * distinct, values finite, c not negative.
 *
 * @return RITZ_ERR_FORMAT with what is wrong
 */
ritz_status ritz_dampers_check(const ritz_dampers *dampers, int64_t n);

/** Index of a name; -1 and a sentence with the nearest name if none. */
int64_t ritz_dampers_find(const ritz_dampers *dampers, const char *name);

/**
 * Take "NAME=C" or "NAME=C*K" as new values; without K it stays.
 *
 * @return RITZ_ERR_ARGUMENT if the name is unknown, or no numbers follow
 */
ritz_status ritz_dampers_tune(ritz_dampers *dampers, const char *text);

/**
 * Install: D += sum (c - held_c) b b' and K likewise, dense or sparse. An
 * absent D, {0}, is made if there is anything to add.
 *
 * @return RITZ_ERR_ARGUMENT if the sizes disagree
 */
ritz_status ritz_dampers_install(ritz_dampers *dampers, ritz_dense *K,
                                 ritz_dense *D);
ritz_status ritz_dampers_install_sparse(ritz_dampers *dampers, ritz_sparse *K,
                                        ritz_sparse *D);

void ritz_dampers_free(ritz_dampers *dampers);

/*
 * Inputs and outputs of a second-order model with n coordinates x:
 *
 *     M x'' + D x' + K x = B u,    y = C x + Cv x' + Ca x''
 *
 * The same object serves components (n dofs), reduced components and systems
 * (n reduced coordinates): a basis T turns B into T'B and C into C T.
 */

typedef struct ritz_io {
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];  /* num_inputs names */
    char (*output)[RITZ_NAME_SIZE]; /* num_outputs names */
    ritz_dense B;                   /* n x num_inputs */
    ritz_dense C, Cv, Ca;           /* num_outputs x n; all three allocated */
    double *limit; /* num_outputs, largest tolerated |y|; NaN where none */
} ritz_io;

/** All names empty, all matrices zero, all limits NaN, for n coordinates. */
ritz_status ritz_io_new(int64_t n, int64_t num_inputs, int64_t num_outputs,
                        ritz_io *out);

ritz_status ritz_io_copy(const ritz_io *io, ritz_io *out);

/** In the subspace x = T q: T'B, C T, Cv T, Ca T; names and limits kept. */
ritz_status ritz_io_project(const ritz_io *io, const ritz_dense *T,
                            ritz_io *out);

/**
 * H += (C + i w Cv - w^2 Ca) X of a harmonic motion X, w = 2 pi hertz.
 *
 * @param[in]     X  n x num_inputs, column-major
 * @param[in,out] H  num_outputs x num_inputs, row by row
 */
void ritz_io_respond(const ritz_io *io, double hertz, const double _Complex *X,
                     double _Complex *H);

void ritz_io_free(ritz_io *io);

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

/** Index of grid @p id, -1 if it has no position. @cost O(log n) */
int64_t ritz_grids_find(const ritz_grids *grids, int64_t id);

void ritz_grids_free(ritz_grids *grids);

/*
 * Which grids belong together, for pictures: cells of a mesh and no mechanics.
 * Kinds and the order of grids in a cell are those of VTK, which most viewers
 * share.
 */

typedef enum ritz_cell {
    RITZ_CELL_POINT = 1, /* of pictures alone: where there is no element */
    RITZ_CELL_LINE = 3,
    RITZ_CELL_TRIANGLE = 5,
    RITZ_CELL_QUAD = 9,
    RITZ_CELL_TETRA = 10,
    RITZ_CELL_HEXA = 12,
    RITZ_CELL_WEDGE = 13,
    RITZ_CELL_TRIANGLE6 = 22, /* from here on with nodes between corners */
    RITZ_CELL_QUAD8 = 23,
    RITZ_CELL_TETRA10 = 24,
    RITZ_CELL_HEXA20 = 25,
    RITZ_CELL_WEDGE15 = 26,
} ritz_cell;

/* Cell k has grids grid[first[k]] to grid[first[k + 1] - 1]. */
typedef struct ritz_elements {
    int64_t count;
    int64_t *kind;  /* count, of ritz_cell */
    int64_t *first; /* count + 1; NULL if count is 0 */
    int64_t *grid;  /* first[count], ids */
    int64_t *id;    /* count, numbers of the elements; NULL: not known */
} ritz_elements;

typedef struct ritz_cell_shape {
    ritz_cell kind, linear; /* with its corners alone: QUAD of QUAD8 */
    int64_t size, corners;  /* grids, and those at its corners */
} ritz_cell_shape;

/** The shape of a kind of cell; all 0 if there is none. */
const ritz_cell_shape *ritz_cell_shape_of(int64_t kind);

ritz_status ritz_elements_copy(const ritz_elements *elements,
                               ritz_elements *out);

/** Leave out cells with a grid that is not among @p count ascending ids; how
 * many these are. */
int64_t ritz_elements_keep(ritz_elements *elements, int64_t count,
                           const int64_t *id);

/**
 * Whether kinds are known, sizes fit them, and all grids are among the ids.
 *
 * @return RITZ_ERR_FORMAT with what is wrong
 */
ritz_status ritz_elements_check(const ritz_elements *elements, int64_t count,
                                const int64_t *id);

void ritz_elements_free(ritz_elements *elements);

/*
 * Linear equations between dofs, as constraint elements state them, each for
 * its dependent dof.
 */

/* A card of a deck, or a port, that states equations. */
typedef struct ritz_equation_source {
    char name[RITZ_NAME_SIZE]; /* "RBE2 600" */
    int64_t file;              /* index in `file`, -1: none */
    int64_t line;
} ritz_equation_source;

/* Equation e: u(dependent[e]) = sum share[k] u(dof[k]), k from first[e] to
 * first[e + 1] - 1. A dof may occur more than once, its shares add up. */
typedef struct ritz_equations {
    int64_t count;
    ritz_dof *dependent; /* count */
    int64_t *first;      /* count + 1; NULL if count is 0 */
    ritz_dof *dof;
    double *share;
    int64_t *source; /* count, index of what states it */
    int64_t num_sources;
    ritz_equation_source *from;
    int64_t num_files;
    char **file;   /* paths that sources are in */
    char *refused; /* why there are no more of them; NULL: these are all */
    int64_t room[6];
} ritz_equations;

void ritz_equations_free(ritz_equations *equations);

/*
 * Dofs that are not among the coordinates of a model, but follow from them:
 * u(dof[k]) = G(k,:) u.
 */
typedef struct ritz_recovery {
    int64_t count;
    ritz_dof *dof;
    ritz_sparse G; /* count x n; {0} if count is 0 */
} ritz_recovery;

/** Whether these can be recovered from @p n dofs. @return RITZ_ERR_FORMAT */
ritz_status ritz_recovery_check(const ritz_recovery *recovery, int64_t n,
                                const ritz_dof *dof);

ritz_status ritz_recovery_copy(const ritz_recovery *recovery,
                               ritz_recovery *out);

/**
 * The dofs of a model and behind them those recovered, and how all of them
 * move: [T; G T].
 *
 * @param[in]  T      n x r; NULL if @p shape is
 * @param[out] names  n + count
 * @param[out] shape  (n + count) x r; NULL: not wanted
 */
ritz_status ritz_recovery_extend(const ritz_recovery *recovery, int64_t n,
                                 const ritz_dof *dof, const ritz_dense *T,
                                 ritz_dof **names, ritz_dense *shape);

void ritz_recovery_free(ritz_recovery *recovery);

/*
 * A quantity to recover from the motion of a model, such as the stresses of
 * elements, or the displacements of grids that are not dofs of the model. It
 * has a row for each number:
 *
 *     y = S u,   or of kind acceleration y = S u''.
 *
 * In a reduced component, u = T q, it is recovered by mode displacement, y =
 * ST q, or by mode acceleration,
 *
 *     y = Q q + V q' + A q'' + F f - H (c_j b_j'T q' + k_j b_j'T q)_j
 *
 * with the inputs f and the dampers j, see ritz_mode_acceleration().
 */
typedef struct ritz_quantity {
    char name[RITZ_NAME_SIZE];    /* "stress" */
    char kind[RITZ_NAME_SIZE];    /* one of ritz_quantity_kinds */
    int64_t count;                /* rows */
    int64_t *place;               /* count, number of the element or, if
                       ritz_quantity_of_grids(), of the grid; 0: not known */
    char (*part)[RITZ_NAME_SIZE]; /* count, "sx"; may be "" */
    ritz_sparse S;                /* count x n; {0} in a reduced component */
    ritz_dense ST;                /* count x r; {0} in a component */
    ritz_dense Q, A;              /* count x r; {0}: no mode acceleration */
    ritz_dense V;                 /* count x r; {0} without damping matrix */
    ritz_dense F, H; /* count x inputs, count x dampers; {0}: there are none */
} ritz_quantity;

/** "stress", "force", "displacement", "acceleration", "other"; then NULL. */
extern const char *const ritz_quantity_kinds[];

/** Whether the rows of a quantity of this kind belong to grids, not
 * elements. */
bool ritz_quantity_of_grids(const char *kind);

/** Name a row: "element 12 sx", "grid 101 T3", or "row 7" for row 6. */
enum { RITZ_QUANTITY_NAME_SIZE = RITZ_NAME_SIZE + 40 };
const char *ritz_quantity_name(const ritz_quantity *quantity, int64_t row,
                               char text[RITZ_QUANTITY_NAME_SIZE]);

/** Check that S has @p n columns, names are distinct and kinds are known.
 * @return RITZ_ERR_FORMAT if not */
ritz_status ritz_quantities_check(int64_t count, const ritz_quantity *quantity,
                                  int64_t n);

/** The same for a reduced component of @p r coordinates. */
ritz_status ritz_quantities_check_reduced(int64_t count,
                                          const ritz_quantity *quantity,
                                          int64_t r, int64_t inputs,
                                          int64_t dampers);

/**
 * Project quantities onto the subspace x = T q: S becomes ST, and the matrices
 * that multiply coordinates and their rates are multiplied by T.
 *
 * @param[out] out  the caller frees each with ritz_quantity_free(), and the
 *                  array; NULL if @p count is 0
 */
ritz_status ritz_quantities_project(int64_t count,
                                    const ritz_quantity *quantity,
                                    const ritz_dense *T, ritz_quantity **out);

void ritz_quantity_free(ritz_quantity *quantity);

#pragma GCC visibility pop

#endif
