/*
 * A model that is being checked: what is known of it, and what one check leaves
 * to those behind it. Not for users.
 */
#ifndef RITZ_CHECK_CHECK_H
#define RITZ_CHECK_CHECK_H

#include "linear/resolvent.h"
#include "model/modal.h"
#include "model/rounding.h"

#include <ritz/check.h>
#include <ritz/matrix.h>

/* Kinds of models a check applies to. */
enum {
    RITZ_OF_COMPONENT = 1,
    RITZ_OF_REDUCED = 2,
    RITZ_OF_STATES = 4,
    RITZ_OF_SPARSE = 8, /* sparse state spaces, too large for dense matrices */
};

/* Features without which a check is left out. */
enum {
    RITZ_NEEDS_STIFFNESS = 1, /* K has entries */
    RITZ_NEEDS_DAMPING = 2,   /* D has */
    RITZ_NEEDS_STRUCTURAL = 4,
    RITZ_NEEDS_PORTS = 8,
    RITZ_NEEDS_LOADS = 16, /* geometric stiffness of a load */
};

/*
 * A square model from forces to the velocities of what they act on,
 *
 *     G(s) = diag(s^power) (C (s I - A)^-1 B + D)
 *
 * power 0 where the output is that velocity, 1 a displacement, -1 an
 * acceleration.
 */
typedef struct ritz_collocated {
    ritz_dense A, B, C, D;
    int *power;                   /* ports */
    char (*name)[RITZ_NAME_SIZE]; /* ports, what each is */
} ritz_collocated;

/* The least eigenvalue of (G + G^*) / 2 over |G|, and where it was met. */
typedef struct ritz_passivity {
    double value; /* negative: energy comes out */
    double hertz;
    int64_t port; /* with the largest share in its eigenvector */
} ritz_passivity;

typedef struct ritz_checker {
    ritz_audit audit;
    int64_t room; /* of the audit */

    /* One of these is what is checked. */
    const ritz_component *component;
    const ritz_reduced *reduced;
    const ritz_state_space *space;
    double *amount; /* of each load that acts; NULL: none does */

    /* Filled by checks of a component. */
    double digits;                 /* of K, at most 17 */
    int64_t *part;                 /* n, connected part of each dof, from 0 */
    int64_t largest;               /* the part with most dofs */
    ritz_rigid_forces shift, turn; /* of translations; of rotations */
    double centre[3];
    double size;      /* largest distance of a grid from the centre, or 1 */
    ritz_dense R;     /* n x 3 or 6, rotations per unit of size */
    double softest;   /* first flexible eigenvalue, NaN if not known */
    ritz_dense Phi;   /* n x k, rigid motions by geometry, Phi'M Phi = I */
    double *mu;       /* k, Phi'K Phi, ascending  [rad^2/s^2] */
    int64_t num_free; /* of Phi, that meet no stiffness */

    /* Of a reduced component; `modes` are filled by its checks. */
    ritz_structure model; /* with dampers installed */
    ritz_damping damping;
    ritz_modal_model modes;
    bool *moves;  /* for each mode, whether it is a rigid motion; NULL: not
                     known */
    ritz_dense L; /* p x r, rows of the interface; velocities are L q' */
    char (*row)[RITZ_NAME_SIZE]; /* p */

    /* x' = A x, and with it, of a state space, inputs and outputs of one name
       or, of a reduced component, forces and velocities of the interface. */
    ritz_collocated pairs;

    bool usable;   /* what checks found so far lets the others be made */
    bool rigid;    /* of a component: K has no entries */
    bool placed;   /* every grid has a position */
    bool declared; /* the digits are those that the source states */
    bool rounded;  /* K times a rigid motion is what its digits leave */
    bool definite; /* of a reduced one, M, K and D are: nothing can grow */
    bool stable;   /* no pole is right of the axis */
} ritz_checker;

/* Room for what all checks say, but for the lines of loads: the tables in
   ritz/check.h have fewer. */
enum { RITZ_MOST_CHECKS = 32, RITZ_LINES_OF_LOAD = 2 };

/* A row of the list: of which models, with what, the function. */
typedef struct ritz_check_row {
    unsigned of, needs;
    ritz_status (*run)(ritz_checker *it);
} ritz_check_row;

/** All checks, in order; the last has no function. */
extern const ritz_check_row ritz_checks[];

/** ritz_probe_states for a sparse model. @cost three factorisations, some
 * solves */
ritz_status ritz_probe_sparse(const ritz_state_space *model, ritz_probe *out);

/** Append what a check found; @p where may be NULL. */
[[gnu::format(printf, 7, 8)]] void
ritz_checker_say(ritz_checker *it, const char *name, double value, double limit,
                 ritz_verdict verdict, const char *where, const char *says,
                 ...);

/** Name the first dofs that are flagged; the number of all of them. */
int64_t ritz_checker_dofs(const ritz_checker *it, const bool *flag,
                          char where[RITZ_WHERE_SIZE]);

/** Append @p text to a list, ", ..." once where it is full. */
void ritz_checker_list(char where[RITZ_WHERE_SIZE], const char *text);

/** Say of the dofs that are flagged @p some, with @p verdict, or @p none. */
void ritz_checker_flagged(ritz_checker *it, const char *name, const bool *flag,
                          ritz_verdict verdict, const char *none,
                          const char *some);

/** Whether a check of the interface needs no computation; then it is said. */
bool ritz_checker_settled(ritz_checker *it, const char *name,
                          const char *proof);

/* Of S A S, S = diag(by)^-1/2. */
typedef struct ritz_least_value {
    double value;   /* its least eigenvalue, over the largest magnitude */
    double *motion; /* S times the eigenvector of that */
} ritz_least_value;

ritz_status ritz_least_value_new(const ritz_dense *A, const ritz_dense *by,
                                 ritz_least_value *out);
void ritz_least_value_free(ritz_least_value *found);

/** The least value that rounding leaves of a semidefinite A. */
double ritz_least_rounding(const ritz_dense *A);

/** Find which modes of a reduced component are rigid motions, by the mass
 * properties and the momentum that it stores. */
ritz_status ritz_check_motions(ritz_checker *it);

/** All modes; or that M and K are singular together. */
ritz_status ritz_check_modes(const ritz_structure *model,
                             const ritz_damping *damping,
                             ritz_modal_model *modes, bool *singular);

/* The checks of a component: each uses what those before it left. */
ritz_status ritz_check_values(ritz_checker *it);
ritz_status ritz_check_dofs(ritz_checker *it);
ritz_status ritz_check_mass_definite(ritz_checker *it);
ritz_status ritz_check_stiffness_definite(ritz_checker *it);
ritz_status ritz_check_geometry(ritz_checker *it);
ritz_status ritz_check_forces(ritz_checker *it);
ritz_status ritz_check_rigid(ritz_checker *it);
ritz_status ritz_check_grounding(ritz_checker *it);
ritz_status ritz_check_mass(ritz_checker *it);
ritz_status ritz_check_damping(ritz_checker *it);
ritz_status ritz_check_ports(ritz_checker *it);
ritz_status ritz_check_buckling(ritz_checker *it);

/* Those of a reduced component and of a state space. */
ritz_status ritz_check_reduced_mass(ritz_checker *it);
ritz_status ritz_check_reduced_stiffness(ritz_checker *it);
ritz_status ritz_check_reduced_damping(ritz_checker *it);
ritz_status ritz_check_reduced_structural(ritz_checker *it);
ritz_status ritz_check_poles(ritz_checker *it);
ritz_status ritz_check_growth(ritz_checker *it);
ritz_status ritz_check_passivity(ritz_checker *it);
ritz_status ritz_check_locked(ritz_checker *it);
ritz_status ritz_check_sprung(ritz_checker *it);
ritz_status ritz_check_joined(ritz_checker *it);

/** The pole of x' = A x that decides on its stability, into @p out. */
ritz_status ritz_probe_matrix(const ritz_dense *A, ritz_probe *out);

/** Re s of that pole over the radius; 0 without poles. */
double ritz_probe_growth(const ritz_probe *probe);

/**
 * Inputs and outputs of one name as pairs; an output is taken for the
 * displacement, velocity or acceleration that violates passivity least.
 *
 * @param[out] out  without columns if there are none
 */
ritz_status ritz_collocated_of_space(const ritz_state_space *model,
                                     ritz_collocated *out);
void ritz_collocated_free(ritz_collocated *model);

/* A model's transfer functions in a form in which a frequency is cheap. */
typedef struct ritz_sampler {
    ritz_resolvent resolvent;
    double _Complex *H; /* ports x ports, by columns, to work in */
    const ritz_collocated *model;
} ritz_sampler;

ritz_status ritz_sampler_new(const ritz_collocated *model, ritz_sampler *s);

/** G(i w), borrowed; NULL where it is infinite. */
const double _Complex *ritz_sampler_at(ritz_sampler *s, double w);
void ritz_sampler_free(ritz_sampler *s);

/**
 * Frequencies at which a response shows what it has: at every pole, around it,
 * and between neighbours [rad/s], ascending, positive.
 */
ritz_status ritz_probe_grid(const ritz_dense *A, int64_t *count, double **out);

/** @cost O(n^3), and O(p n^2) for each of about ten points a pole */
ritz_status ritz_passivity_of(const ritz_collocated *model,
                              ritz_passivity *out);

/**
 * Frequencies at which, besides, G + G^* + 2 slack I may become singular: on
 * the axis, eigenvalues of a Hamiltonian pencil.
 */
ritz_status ritz_passivity_crossings(const ritz_collocated *model, double slack,
                                     int64_t *count, double **out);

#endif
