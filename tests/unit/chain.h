/*
 * The fixed-free chain of oracles: masses m_i = 1 + 0.1 (7 i mod 5), spring i
 * from mass i - 1 (ground for i = 0) to mass i, k_i = 1000 (1 + 0.2 (3 i mod
 * 4)), and dampers 'a', 'b', 'c' across springs 2, 9, 17: c = 150, k = -200.
 */
#ifndef RITZ_TESTS_CHAIN_H
#define RITZ_TESTS_CHAIN_H

#include <ritz/component.h>

/** Scalar points 1 .. n, n > 17; input 'f' and output 'u' at the last. */
ritz_status chain_component(int64_t n, ritz_component *out);

/** Remove all stiffness to ground. */
void chain_free(ritz_component *chain);

#endif
