/*
 * A chain of masses and springs, fixed at one end, with dampers across some of
 * its springs, made to show what truncated modes make of dampers
 * [ChuMilman1992].
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

#endif
