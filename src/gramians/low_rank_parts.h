/* Parts of the low-rank engine: see low_rank.c for the equations. */
#ifndef RITZ_GRAMIANS_LOW_RANK_PARTS_H
#define RITZ_GRAMIANS_LOW_RANK_PARTS_H

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <complex.h>

enum {
    RITZ_LOW_RANK_STARTS = 2,  /* shifts at the lowest modes */
    RITZ_LOW_RANK_SHIFTS = 300 /* most of them */
};

/* The two equations, and the two halves of 2n rows. */
enum { RITZ_CONTROLLABLE, RITZ_OBSERVABLE, RITZ_SIDES };
enum { RITZ_ABOVE, RITZ_BELOW, RITZ_HALVES };

/* The equation M v' + D v + K u = 0 with its loads W. */
typedef struct ritz_low_rank_model {
    int64_t n;
    ritz_sparse K, D;  /* with damping of words and dampers installed */
    ritz_sparse Dt;    /* D' of an unsymmetric D; else {0} */
    ritz_sparse M;     /* borrowed */
    ritz_dofs massive; /* dofs with mass */
    ritz_dofs massless;
    ritz_dense Phi, MPhi; /* n x a, rigid modes, which are decoupled */
    ritz_dense W[RITZ_SIDES][RITZ_HALVES]; /* n x inputs, n x outputs */
    double whole[RITZ_SIDES];              /* |W'W| with rigid motion */
    double *stiff, *mass; /* of each dof, by which residuals are scaled */
    double lowest;        /* lowest flexible eigenvalue; 1 if there is none */
    int64_t num_starts;
    double _Complex start[RITZ_LOW_RANK_STARTS];
} ritz_low_rank_model;

ritz_status ritz_low_rank_model_new(const ritz_gramians_request *request,
                                    ritz_low_rank_model *out);
void ritz_low_rank_model_free(ritz_low_rank_model *model);

/** |W'W| of a side, each dof in its own units of energy. */
ritz_status ritz_low_rank_size(const ritz_low_rank_model *model, int side,
                               double *out);

/** Scale the rows of both halves of W, or of a residual, so that their squares
 * are energies. @param[in] side  RITZ_CONTROLLABLE or RITZ_OBSERVABLE */
void ritz_low_rank_weigh(const ritz_low_rank_model *model, int side,
                         ritz_dense W[static RITZ_HALVES]);

/** The number by which row @p i of the 2n of a factor is multiplied, so that
 * its squares are energies. */
double ritz_low_rank_unit(const ritz_low_rank_model *model, int side,
                          int64_t i);

/* Latest displacements, and M, K and D between them. */
typedef struct ritz_low_rank_window {
    int64_t count, room, next;
    ritz_dense X;    /* n x room, the oldest are overwritten */
    ritz_dense G[3]; /* X'MX, X'KX, X'DX */
} ritz_low_rank_window;

ritz_status ritz_low_rank_window_new(const ritz_low_rank_model *model,
                                     ritz_low_rank_window *out);
ritz_status ritz_low_rank_window_add(const ritz_low_rank_model *model,
                                     const ritz_dense *X,
                                     ritz_low_rank_window *window);
void ritz_low_rank_window_free(ritz_low_rank_window *window);

/**
 * Shifts for what is left of W.
 *
 * @param[in]  open  of either side: it has not converged
 * @param[out] out   at least one, at most @p most
 */
ritz_status ritz_low_rank_shifts(const ritz_low_rank_model *model,
                                 const ritz_low_rank_window *window,
                                 const bool open[static RITZ_SIDES],
                                 int64_t most, int64_t *count,
                                 double _Complex *out);

#endif
