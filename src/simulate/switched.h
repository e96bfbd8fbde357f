/* The parts of switched models: the library, its stability, the choice of a
   set, and the march. */
#ifndef RITZ_SIMULATE_SWITCHED_H
#define RITZ_SIMULATE_SWITCHED_H

#include "simulate/motion.h"

#include <ritz/switched.h>

/*
 * A library and the full model in its coordinates: x = Phi q, x' = Phi w,
 * Phi'M Phi = I. The first `span` columns span the candidates. Those after them
 * span the parts of the initial state and of impulses that are orthogonal to
 * the candidates, and never move.
 *
 *     R = [S_x w;  S_k q + S_d w + S_b u]
 *
 * are the coordinates of R in a basis that is orthonormal in W, so that |R| is
 * computed without loss of digits.
 */
typedef struct ritz_library {
    int64_t num_vectors;   /* L, candidates */
    int64_t n, span;       /* columns of Phi */
    ritz_dense Phi, MPhi;  /* full rows x n */
    ritz_dense vector;     /* span x L: directions of candidates in V = Phi
                              diag(1 / scale), orthonormal in W */
    double *scale;         /* n: 1, or 1/sqrt(mu) where W = I */
    bool redundant;        /* else `vector` is the identity */
    bool share_of_library; /* |R|^2 is that of its part in the library */
    ritz_dense K, D, B;    /* Phi'K Phi, Phi'D Phi, Phi'B */
    ritz_dense S_x, S_k, S_d, S_b;
    double outside; /* share of the initial state outside the library */
} ritz_library;

ritz_status ritz_library_new(const ritz_simulation_request *request,
                             const ritz_switched *switched,
                             const ritz_motion *full, ritz_library *out);
void ritz_library_free(ritz_library *library);

/**
 * Check the condition of stability of ritz_simulate_switched.
 *
 * @param[out] report  defect and dwell
 * @return RITZ_ERR_ARGUMENT
 */
ritz_status ritz_library_stable(const ritz_library *library,
                                const ritz_switched *switched,
                                ritz_switched_report *report);

/* R at a switch, in the coordinates of a library. With `ahead` these are two R,
   with the inputs at the start and at the end of the interval. */
typedef struct ritz_residue {
    double *x, *v, *ahead; /* span: V'W of both rows of R, and of the second row
                              with the inputs ahead, else 0 */
    double twice;          /* how often x counts: 2 with inputs ahead, else 1 */
    double *whole;         /* rows of S_x: work space */
    double square;         /* |R|^2, or the sum of both R */
    double largest;        /* size of terms of R, which bounds its rounding */
} ritz_residue;

/** Compute R, or both R.
 * @param[in] ahead  inputs at the end of the interval; NULL: one R */
void ritz_residue_find(const ritz_library *library, const double *q,
                       const double *w, const double *u, const double *ahead,
                       ritz_residue *r);

/* The choice of a set, with its work space. */
typedef struct ritz_choosing {
    double *present; /* L: 1 in the set, else 0 */
    double *next;    /* L: the set that is chosen */
    double *share;   /* L */
    ritz_dense rest; /* parts of redundant vectors that are orthogonal to those
                        chosen */
    int64_t leading; /* number of the vector with the largest share, from 0 */
    double indicator;
    bool fallback; /* E of all vectors is below Emin */
} ritz_choosing;

/** Choose the next set: fill next, leading, indicator and fallback. */
void ritz_choose_vectors(const ritz_library *library,
                         const ritz_switched *switched, const ritz_residue *r,
                         ritz_choosing *c);

/** E of the present set. */
double ritz_present_indicator(const ritz_library *library,
                              const ritz_residue *r, ritz_choosing *c);

/** span x r: orthonormal columns that span the vectors of a set. */
ritz_status ritz_library_columns(const ritz_library *library,
                                 const double *present, ritz_dense *U);

/* The model of a set: U X p, X the modes of U'K U, of the columns U that span
   its vectors. */
typedef struct ritz_set_model {
    bool made;
    ritz_motion motion; /* p; the last input is the constant load */
    ritz_march march;
    int64_t *at; /* numbers of the vectors, if they are orthonormal modes; UX is
                    then not needed. NULL: they are not */
    ritz_dense UX;       /* span x r */
    double *damped_hold; /* r: X'U'D w_0 */
} ritz_set_model;

/** The modes of the set of vectors whose `present` is not 0. Its inputs are
 * filled by ritz_set_model_load. */
ritz_status ritz_set_model_new(const ritz_library *library,
                               const double *present, ritz_set_model *out);
void ritz_set_model_free(ritz_set_model *set);

/** Fill the inputs: those of the library, and the constant load of q_0 and
 * w_0. */
ritz_status ritz_set_model_load(const ritz_library *library, const double *q_0,
                                const double *w_0, ritz_set_model *set);

/** x = x_0 + U X p. */
void ritz_set_model_expand(const ritz_set_model *set, const double *x_0,
                           const double *p, int64_t n, double *x);

/** p = X'U'y, and y_0 = y - U X p. */
void ritz_set_model_hold(const ritz_set_model *set, int64_t n, const double *y,
                         double *y_0, double *p);

#endif
