/* The bound of a response, whose equations are at the head of response.c. */
#ifndef RITZ_ESTIMATE_BOUNDER_H
#define RITZ_ESTIMATE_BOUNDER_H

#include "estimate/estimator.h"
#include "poles/poles.h"

#include <complex.h>

/* C, Cv and Ca of outputs. */
enum { KINDS = 3 };

/*
 * One input or output at a frequency w: its vector b, or c + i w cv - w^2 ca,
 * the reduced modes' response eta to it, and the residual r that the full
 * equations leave of that, as a combination of the vectors V of the bounder.
 */
typedef struct ritz_side {
    double _Complex *participation; /* X'b, or c'X */
    double _Complex *eta;           /* response of each trial mode */
    double _Complex *residual;      /* coordinates of r in V */
    /* derivatives by w of the residual and of the participation, and a bound of
       the second derivative of the latter */
    double _Complex *residual_slope, *participation_slope;
    double *curvature;
    double residual_norm; /* |r|_(A^-1), without what damping adds */
    double change;        /* bound of its change in the interval */
    double damping_part;  /* bound of what damping ratios add to |r| */
    /* sums over j of |eta_j||R_j| theta_j^(-1/4), and theta_j^(-3/4), that
       bound the defect of reduced damping */
    double defect_quarter, defect_three;
} ritz_side;

typedef struct ritz_bounder {
    const ritz_lehmann *trial;
    const ritz_enclosure *e;
    const ritz_io *io;
    int64_t num_rigid;
    bool rayleigh; /* D = a M + b K; else the ratio zeta of all modes */
    double zeta, a, b;
    double *rates;                 /* damping of each trial mode */
    int64_t size;                  /* columns of V = [R b_o c_o D_o K4_o] */
    ritz_dense G, Q;               /* V'A^-1 V and V'A^-1 M A^-1 V */
    double *vector_norm;           /* |V_j|_(A^-1) */
    ritz_dense channel[1 + KINDS]; /* B'X, C X, Cv X, Ca X */
    double *sin2; /* of each full mode to the trial space, at most */
    int64_t num_sides;
    ritz_side *side;          /* inputs, then outputs */
    double _Complex *GV, *QV; /* G and Q times the residual of an input */
    bool coupled;             /* D or K4 couples modes: an estimate, no bound */
    const double *matrix_rates; /* the part of rates that is of D and K4 */
    ritz_dense D, K4;           /* of trial modes */
    double _Complex *Z, *responses;
    int *pivot;
    double largest; /* |H_r| at points */
    double least;   /* largest |H_r| less its bound: |H| is at least this */
} ritz_bounder;

/** Fill V's forms, angles and sides of a bounder that has the rest. */
ritz_status ritz_bounder_open(ritz_estimator *estimator, ritz_bounder *r);
void ritz_bounder_free(ritz_bounder *r);

/** Rates of damping of trial modes: 2 zeta omega, or a + b lambda. */
void ritz_bounder_take_rates(ritz_bounder *r);

/**
 * The largest bound of all pairs anywhere within @p h of @p w rad/s; with h = 0
 * it tells r->least and r->largest too.
 */
double ritz_bound_at(ritz_bounder *r, double w, double h);

#endif
