/* The parts of estimate_response.c, whose head has the equations. */
#ifndef RITZ_ESTIMATE_BOUNDER_H
#define RITZ_ESTIMATE_BOUNDER_H

#include "estimate/estimator.h"
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

double ritz_bounder_rate_of(const ritz_bounder *r, int64_t j);

/**
 * The largest bound of all pairs anywhere within @p h of @p w rad/s; with h = 0
 * it tells r->least and r->largest too.
 */
double ritz_bound_at(ritz_bounder *r, double w, double h);

#endif
