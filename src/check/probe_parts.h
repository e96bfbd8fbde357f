/* Parts of the stability probe: what its checks share. Not for users. */
#ifndef RITZ_CHECK_PROBE_PARTS_H
#define RITZ_CHECK_PROBE_PARTS_H

#include "model/first_order.h"

#include <ritz/probe.h>

#include <complex.h>

enum { RITZ_PROBE_MOST = 16 }; /* checks; the table in probe.h has fewer */

/* The bound on what rounding does to a pole is of first order, and eigensolvers
   are backward stable within a few eps. */
#define RITZ_PROBE_TIMES 8.0

/* Below this, of the largest, D and K4 are as indefinite as text is that was
   rounded to ten digits. */
#define RITZ_PROBE_SLIGHT 1e-10

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

/* The largest |e^(A t)|^2, t >= 0. */
typedef struct ritz_growth {
    double met, seconds; /* what was met, and when */
    double most;         /* bound; HUGE_VAL: none is known */
    bool followed;       /* false: too many states, `met` is 1 */
} ritz_growth;

typedef struct ritz_prober {
    const ritz_reduced *reduced;   /* NULL of a state space */
    const ritz_state_space *space; /* NULL of a reduced component */
    ritz_structure model;          /* with dampers installed */
    ritz_damping damping;
    ritz_first_order modes;
    bool usable;   /* M and K are semidefinite: modes are there */
    bool definite; /* and so is D: nothing can grow */
    bool stable;   /* no pole is right of the axis */
    ritz_dense L;  /* p x r, rows of the interface; velocities are L q' */
    char (*row)[RITZ_NAME_SIZE]; /* p */
    ritz_collocated pairs;       /* of a state space, or of the modes */
    ritz_audit audit;
} ritz_prober;

/** Append a check; @p where may be NULL. */
[[gnu::format(printf, 7, 8)]] void
ritz_prober_say(ritz_prober *it, const char *name, double value, double limit,
                ritz_verdict verdict, const char *where, const char *says, ...);

/** Name the columns that have most of a motion, "column 7 normal, 12.3 Hz". */
void ritz_prober_where(const ritz_prober *it, const double *motion,
                       char where[RITZ_WHERE_SIZE]);

/**
 * Rows of the interface: those of all ports or, without ports, what inputs act
 * on; rows that move nothing are left out.
 */
ritz_status ritz_prober_interface(ritz_prober *it);

/* The checks; each says what it finds, and does nothing where that is moot. */
ritz_status ritz_probe_definite_mass(ritz_prober *it);
ritz_status ritz_probe_definite_stiffness(ritz_prober *it);
ritz_status ritz_probe_definite_damping(ritz_prober *it);
ritz_status ritz_probe_definite_structural(ritz_prober *it);
ritz_status ritz_probe_poles(ritz_prober *it);
ritz_status ritz_probe_growth(ritz_prober *it);
ritz_status ritz_probe_passive(ritz_prober *it);
ritz_status ritz_probe_locked(ritz_prober *it);
ritz_status ritz_probe_sprung(ritz_prober *it);
ritz_status ritz_probe_joined(ritz_prober *it);

/** The part of a state space, which is stable. */
ritz_status ritz_probe_growth_states(ritz_prober *it);

/** Of a stable A. @cost O(n^3), some hundred products up to 400 states */
ritz_status ritz_growth_measure(const ritz_dense *A, ritz_growth *out);

/** Say it of @p what, which may reach @p limit. */
void ritz_prober_growth(ritz_prober *it, const ritz_growth *found, double limit,
                        const char *what);

/** The same of pairs of a state space. */
ritz_status ritz_probe_locked_states(ritz_prober *it);
ritz_status ritz_probe_sprung_states(ritz_prober *it);

/** The pole of x' = A x that decides, into @p out. */
ritz_status ritz_probe_judge(const ritz_dense *A, ritz_probe *out);

/**
 * First-order matrix of the modes that have mass in [w q; q'], whose square is
 * twice the energy, q of rigid modes left out.
 */
ritz_status ritz_probe_energy_matrix(const ritz_first_order *modes,
                                     ritz_dense *out);

/**
 * Inputs and outputs of one name as pairs; what each output is, displacement,
 * velocity or acceleration, is what breaks passivity least.
 *
 * @param[out] out  without columns if there are none
 */
ritz_status ritz_collocated_of_space(const ritz_state_space *model,
                                     ritz_collocated *out);

/** From forces along the interface to its velocities, by the modes. */
ritz_status ritz_collocated_of_modes(const ritz_prober *it,
                                     ritz_collocated *out);
void ritz_collocated_free(ritz_collocated *model);

/** A model's response in a form in which a point is cheap. */
typedef struct ritz_sampler ritz_sampler;

ritz_status ritz_sampler_new(const ritz_collocated *model, ritz_sampler **out);

/**
 * G(i w), ports x ports by columns, borrowed; NULL where it is infinite.
 */
const double _Complex *ritz_sampler_at(ritz_sampler *sampler, double w);
void ritz_sampler_free(ritz_sampler **sampler);

/**
 * Frequencies at which a response shows what it has: at every pole, around it,
 * and between neighbours [rad/s], ascending, positive.
 */
ritz_status ritz_probe_grid(const ritz_dense *A, int64_t *count, double **out);

/** Sort, leave out what is not positive or there twice; how many are left. */
int64_t ritz_probe_sort(int64_t count, double *w);

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
