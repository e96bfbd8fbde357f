/* Real models in complex coordinates, where a triangle answers at i w. */
#ifndef RITZ_POLES_WIDEN_H
#define RITZ_POLES_WIDEN_H

#include <ritz/dense.h>

#include <complex.h>

/** A with complex entries, by column; the caller frees it. */
ritz_status ritz_widen(const ritz_dense *A, double _Complex **out);

/**
 * B := Q^H B, C := C Z, in their places.
 *
 * @param[in]     n,m,p  states, inputs, outputs
 * @param[in]     Q,Z    n x n
 * @param[in,out] B,C    n x m, p x n; as they were if it fails
 */
ritz_status ritz_turn(int n, int m, int p, const double _Complex *Q,
                      const double _Complex *Z, double _Complex **B,
                      double _Complex **C);

#endif
