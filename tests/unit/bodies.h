/* Bodies in space of six-dof grids, for joints to hold. */
#ifndef RITZ_TESTS_BODIES_H
#define RITZ_TESTS_BODIES_H

#include <ritz/component.h>

/** Numbers that look random between -1 and 1, the same for the same seed. */
double body_number(uint64_t *seed);

/**
 * Grids first, first + 1, ... at given places, each a mass of 1 to 2 with an
 * inertia of its own, successive ones held together by six springs: free, with
 * six rigid modes. Each grid is a port, "g1", "g2", ...
 *
 * @param[in] seed  other numbers, another body
 */
ritz_status body_chain(int64_t count, const double (*position)[3],
                       int64_t first, uint64_t seed, ritz_component *out);

/** One grid, 1, of mass m and inertia J about each axis, port "g1"; m and J may
 * be 0. */
ritz_status body_point(double m, double J, ritz_component *out);

/** The same body in another deck: x becomes R x + t, dofs turn too. */
ritz_status body_move(ritz_component *body, const double R[9],
                      const double t[3]);

#endif
