/*
 * The axial bar, the structure whose every number is known: E A = rho A = 1,
 * length 1, linear elements with consistent mass, free at both ends, no ports.
 * Grid k + 1 stands at x = k h and has direction 1 alone.
 */
#ifndef RITZ_TESTS_BAR_H
#define RITZ_TESTS_BAR_H

#include <ritz/component.h>

/** Bar of @p elements elements: elements + 1 dofs, from left to right. */
ritz_status bar_component(int64_t elements, ritz_component *out);

/**
 * Eigenvalue k of the bar, exact for the mesh:
 *
 *     lambda_k = 6 / h^2 (1 - cos a) / (2 + cos a),   a = k pi h
 *
 * k = 0, 1, ... with both ends free, k = 1, 2, ... with both ends clamped.
 */
double bar_eigenvalue(int64_t elements, int64_t k);

#endif
