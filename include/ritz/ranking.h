/*
 * Rankings of the modes of a modal model: which matter from input to output.
 *
 *     q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = b_k u,
 *     y = sum_k c_k q_k + cv_k q_k' + ca_k q_k''
 *
 * Rigid modes are not ranked. Modes closer than 1e-6 in frequency are one
 * cluster, which gets one value and is kept or dropped whole.
 */
#ifndef RITZ_RANKING_H
#define RITZ_RANKING_H

#include <ritz/damping.h>
#include <ritz/io.h>
#include <ritz/system.h>

/* Flexible modes of a model, with their own share of inputs and outputs. */
typedef struct ritz_modal {
    int64_t count;    /* m */
    double *omega;    /* m, ascending, positive  [rad/s] */
    double *zeta;     /* m, positive where a ranking needs damping */
    ritz_dense B;     /* m x inputs, inputs scaled by their weights */
    ritz_dense C, Cv; /* outputs x m, divided by limits; acceleration outputs
                          are folded into both, their feedthrough left out */
} ritz_modal;

typedef struct ritz_ranking {
    char by[RITZ_NAME_SIZE];
    char reference[RITZ_NAME_SIZE];
    int64_t count;  /* m flexible modes */
    double *hertz;  /* m */
    double *zeta;   /* m, the damping used */
    double *value;  /* m, one for each mode; equal within a cluster */
    int64_t *order; /* m, best first; ties in order of frequency */
    int64_t num_system;
    double *system_value; /* exact Hankel values of the whole, descending */
    double coupling;      /* largest normalised off-diagonal of the exact modal
                        Gramian: where it is not small, Gregory's assumption
                        fails; NaN if not computed */
    int64_t coupled[2];   /* modes between which it stands */
} ritz_ranking;

typedef struct ritz_ranker {
    const char *name;
    const char *summary;
    const char *reference;
    /** Value of each mode; those of a cluster get that of the whole cluster. */
    ritz_status (*rank)(const ritz_modal *modal, double *value);
} ritz_ranker;

/** All rankings, ended by NULL. */
extern const ritz_ranker *const ritz_rankers[];
extern const ritz_ranker ritz_ranker_gregory;
extern const ritz_ranker ritz_ranker_hankel;

const ritz_ranker *ritz_ranker_find(const char *name);

/**
 * Modal model of symmetric dense matrices or of a configuration in modal form.
 *
 * @param[in] damping  ratio of each mode, added to what D says on the diagonal
 * @return RITZ_ERR_ARGUMENT if a flexible mode has no damping
 */
ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out);

/**
 * Exact controllability and observability Gramians of the modal model in the
 * states (q_1, q_1', q_2, ...), 2m x 2m, closed form, O(m^2).
 */
ritz_status ritz_modal_gramians(const ritz_modal *modal, ritz_dense *Wc,
                                ritz_dense *Wo);

/** Exact Hankel singular values, 2m, descending. @cost O(m^3) */
ritz_status ritz_modal_hankel(const ritz_modal *modal, double *sigma);

/** Rank, with exact system values and the coupling flag beside. */
ritz_status ritz_rank(const ritz_ranker *ranker, const ritz_modal *modal,
                      ritz_ranking *out);

void ritz_modal_free(ritz_modal *modal);
void ritz_ranking_free(ritz_ranking *ranking);

#endif
