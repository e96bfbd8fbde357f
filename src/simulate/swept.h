/* A swept model at a setting, as both its assembly and its march need it. */
#ifndef RITZ_SIMULATE_SWEPT_H
#define RITZ_SIMULATE_SWEPT_H

#include <ritz/swept.h>

/**
 * Compute the second derivatives of the splines through the knots of F, whose
 * ends are "not a knot".
 *
 * @param[in,out] model  bend is written
 */
ritz_status ritz_swept_bend(ritz_swept_model *model);

/**
 * As above for a model with `turn`: F at the last knot is set to its value at
 * the first knot one turn further, so that the spline is continuous over all
 * turns.
 */
ritz_status ritz_swept_bend_around(ritz_swept_model *model);

/** Reduce a setting x to the turn of the knots, and count the turns between
 * them; without `turn` the result is x itself and 0 turns. */
double ritz_swept_within(const ritz_swept_model *model, double x,
                         double *turns);

/**
 * q of the basis at x - 2 pi for q of that at x, which spans the same motions:
 * q = turn q, or turn'q if @p back.
 *
 * @param[out] work  r
 */
void ritz_swept_turn(const ritz_swept_model *model, bool back, double *q,
                     double *work);

/** F at x, rows x r; rounding may place x beyond the ends. With `turn`, F is
 * evaluated in the turn of the knots. */
ritz_status ritz_swept_values(const ritz_swept_model *model, double x,
                              ritz_dense *out);

/*
 * A piece of a spline between two knots, F = sum_k c_k s^k with s from 0 to 1.
 * It has the products of X = [c_0 c_1 c_2 c_3], for T, with the matrices of the
 * bodies, so that the cost of the matrices at x does not depend on Q.
 */
typedef struct ritz_swept_piece {
    int64_t at;               /* number of the knot before it; -1: none yet */
    ritz_dense M, K, D, G, H; /* 4r x 4r: X'M X, ... */
    ritz_dense ST;            /* springs x 4r */
    ritz_dense ratios;        /* r x 4r */
    ritz_dense B;             /* 4r x inputs: X'B */
    ritz_dense C, Cv, Ca;     /* outputs x 4r: C X, ... */
} ritz_swept_piece;

/** Compute the piece that contains x, which is within the knots, unless @p piece is that piece. */
ritz_status ritz_swept_piece_move(const ritz_swept_model *model, double x,
                                  ritz_swept_piece *piece);
void ritz_swept_piece_free(ritz_swept_piece *piece);

/** Powers of s at x in a piece, and their first and second derivatives by x. */
void ritz_swept_weights(const ritz_swept_model *model, int64_t at, double x,
                        double w[static 3][4]);

/** out += factor sum_kl a_k b_l W_kl, W_kl the r x r blocks of W; W {0} is
 * zero. */
void ritz_swept_contract(const ritz_dense *W, const double a[static 4],
                         const double b[static 4], double factor,
                         ritz_dense *out);

/** out = sum_k w_k c_k, c_k the blocks of r columns of c. */
void ritz_swept_combine(const ritz_dense *c, const double w[static 4],
                        ritz_dense *out);

/** z += factor [w_0 q; w_1 q; w_2 q; w_3 q], z of 4r. */
void ritz_swept_spread(const double w[static 4], double factor, int64_t r,
                       const double *q, double *z);

#endif
