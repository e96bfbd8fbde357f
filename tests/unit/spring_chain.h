/*
 * A chain of masses and springs, fixed at one end, with dampers across some of
 * its springs, made to show what truncated modes make of dampers
 * [ChuMilman1992]: masses m_i = 1 + 0.1 (7 i mod 5), springs k_i =
 * 1000 (1 + 0.2 (3 i mod 4)). Of MASSES_MOST masses at most.
 */
#ifndef RITZ_TESTS_SPRING_CHAIN_H
#define RITZ_TESTS_SPRING_CHAIN_H

#include <ritz/component.h>

/** Mass i, and the spring from mass i - 1 (the ground for i = 0) to mass i. */
double spring_chain_mass(int64_t i);
double spring_chain_stiffness(int64_t i);

/**
 * @p n masses, grid 1, 2, ... at x = 1, 2, ..., each with dof 1; no ports,
 * inputs, outputs or dampers. Without spring 0 if it is free.
 */
ritz_status spring_chain(int64_t n, bool is_free, ritz_component *out);

/**
 * Put dampers across springs, called "damper 2" after its spring, with rate
 * @p c and a change of stiffness @p k each.
 */
ritz_status spring_chain_damp(ritz_component *chain, int64_t count,
                              const int64_t *spring, double c, double k);

/**
 * The same chain, held, as oracles have it: scalar points 1 .. n, n > 17;
 * dampers 'a', 'b', 'c' across springs 2, 9, 17, c = 150, k = -200; input 'f'
 * and output 'u' at the last.
 */
ritz_status chain_component(int64_t n, ritz_component *out);

/** Remove all its stiffness to ground. */
void chain_free(ritz_component *chain);

#endif
