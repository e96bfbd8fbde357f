/* The parts of estimate_response.c, whose head has the equations. */
#ifndef RITZ_ESTIMATE_ESTIMATE_BOUNDER_H
#define RITZ_ESTIMATE_ESTIMATE_BOUNDER_H

#include "estimate/estimate_parts.h"
#include "poles/poles.h"

#include <complex.h>

/* C, Cv and Ca of outputs. */
enum { KINDS = 3 };

/* One side at a frequency: an input's b or an output's c + i w cv - w^2 ca. */
typedef struct ritz_side {
    double _Complex *alpha;         /* of [R b_o c_o], what r is */
    double _Complex *modal;         /* X'b, or c'X */
    double _Complex *eta;           /* of each trial mode */
    double _Complex *slope, *first; /* derivatives of alpha and of modal */
    double *second;                 /* most of another one of modal */
    double norm;    /* |r| at the frequency, what damping adds left out */
    double change;  /* most that it changes in the interval */
    double damped;  /* most that damping adds */
    double quarter; /* sum |eta_j||R_j| theta_j^(-1/4), for the defect */
    double three;   /* and theta_j^(-3/4) */
} ritz_side;

typedef struct ritz_bounder {
    const ritz_lehmann *trial;
    const ritz_enclosure *e;
    const ritz_io *io;
    int64_t num_rigid, size; /* size: of G */
    bool rayleigh;
    double zeta, a, b;
    const double *given; /* rates of trial modes, by D; NULL: by zeta */
    ritz_dense G, Q; /* of V = [R b_o c_o D_o K4_o]: V'A^-1 V, and M inside */
    ritz_dense B, C[KINDS]; /* X'B; C X, Cv X, Ca X */
    double *size_of;        /* |V_j| */
    double *sin2;           /* of full modes */
    ritz_side *in, *out;
    double _Complex *GV, *QV; /* G and Q times alpha of an input */
    bool coupled;             /* by D or K4: see estimate_coupled.c */
    const double *matrices;   /* what of given comes from them */
    ritz_dense D, K4;         /* of trial modes */
    double _Complex *Z, *answers;
    int *pivot;
    double largest; /* |H_r| at points */
    double least;   /* |H_r| less its bound: the largest so far */
} ritz_bounder;

/** Forms, sines and room for sides, of a bounder with all else filled in. */
ritz_status ritz_bounder_open(ritz_estimator *estimator, ritz_bounder *r);
void ritz_bounder_free(ritz_bounder *r);

/** The stiffness of trial mode @p j, 0 of a rigid one, and its rate. */
double ritz_bounder_stiffness(const ritz_bounder *r, int64_t j);
double ritz_bounder_rate_of(const ritz_bounder *r, int64_t j);

/** The rate of a full mode: 2 zeta omega, or a + b lambda. */
double ritz_bounder_rate(const ritz_bounder *r, double lambda);

/**
 * How far rounding moves a reduced response at @p w rad/s: K_ij off by
 * sqrt(r_i r_j), r the rounding of eigenvalues, moves it by p_i eta_j K_ij, and
 * what damping is made of K too; M_ij moves it as well. Among rigid motions
 * only M does: their stiffness is set to 0.
 */
double ritz_bounder_rounding(const ritz_bounder *r, double w,
                             const ritz_side *in, const ritz_side *out);

/**
 * Rates where no ratio is common to all modes: D's diagonal, K4's over omega,
 * and what was asked for. The least ratio stands for modes not yet met.
 *
 * @param[out] rates,matrices  of each trial mode; matrices: what comes of D, K4
 */
ritz_status ritz_bounder_rates(const ritz_estimator *estimator, ritz_bounder *r,
                               double *rates, double *matrices);

/**
 * Whether ratios stated mode by mode differ within a pair of equal ones: any
 * vectors of these will do, and each model damps its own.
 */
bool ritz_bounder_at_odds(const ritz_bounder *r);

/** Whether a mode of the band that is driven and seen has no damping. */
bool ritz_bounder_undamped(const ritz_bounder *r, const double band_hz[2]);

/** Room for it, and D and K4 of trial modes. */
ritz_status ritz_coupled_open(const ritz_component *full, ritz_bounder *r);
void ritz_coupled_free(ritz_bounder *r);

/** eta and alpha of all sides at @p w, whose modal shares are there. */
void ritz_coupled_solve(ritz_bounder *r, double w);

/**
 * The largest bound of all pairs anywhere within @p h of @p w rad/s; with h = 0
 * it tells r->least and r->largest too.
 */
double ritz_bound_at(ritz_bounder *r, double w, double h);

#endif
