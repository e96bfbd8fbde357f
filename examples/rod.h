/* An elastic rod along x as a component: what every example begins with. */
#ifndef ROD_H
#define ROD_H

#include <ritz/ritz.h>

/**
 * A rod of n elements of unit length, axial stiffness EA and mass rho A of 1,
 * free at both ends; ports "left" and "right" are its end grids 1 and n + 1,
 * input "force" and output "tip" act and measure along x at the right end.
 */
ritz_status rod_component(int64_t n, ritz_component *out);

#endif
