/* Coordinates in which a linear system E x' = A x is well scaled. */
#ifndef RITZ_LINEAR_FRAME_H
#define RITZ_LINEAR_FRAME_H

#include <ritz/matrix.h>

/* x = L^-T diag(right) z; left vectors are L^-T diag(left) times theirs. */
typedef struct ritz_frame {
    ritz_dense A, E; /* in these coordinates; E {0}: the identity */
    ritz_dense L;    /* lower triangle; {0}: the identity */
    double *right, *left;
} ritz_frame;

/** @param[in] E  {0}: the identity */
ritz_status ritz_frame_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_frame *out);

/** V := L^-T diag(scale) V, scale either of right and left. */
void ritz_frame_turn_back(const ritz_frame *f, const double *scale,
                          ritz_dense *V);

/** (L^-T diag(scale))' V: B by `left`, C' by `right`, in these coordinates. */
ritz_status ritz_frame_forward(const ritz_frame *f, const double *scale,
                               const ritz_dense *V, ritz_dense *out);

/**
 * E x' = A x + B u, y = C x in such coordinates, E divided out.
 *
 * @param[in]  E                    {0}: the identity
 * @param[out] out_A, out_B, out_C  the caller's to free, if it fails too
 */
ritz_status ritz_frame_system(const ritz_dense *A, const ritz_dense *E,
                              const ritz_dense *B, const ritz_dense *C,
                              ritz_dense *out_A, ritz_dense *out_B,
                              ritz_dense *out_C);

void ritz_frame_free(ritz_frame *f);

#endif
