/* A row of twelve unequal masses for Gramians, and what is asked of it. */
#ifndef RITZ_TESTS_MASS_ROW_H
#define RITZ_TESTS_MASS_ROW_H

#include <ritz/gramians.h>

enum { MASS_ROW = 12 };

/** Inputs at masses 2 and 9, outputs at 0, 5 and 11; @p ground 0: free. */
ritz_component mass_row(double ground);

/** Held; masses 3 and 8 are none; inputs at @p pushed and 10, outputs at 0 and
 * 8. */
ritz_component mass_row_massless(int64_t pushed);

/** Engine 'low-rank', D = a M + b K. */
ritz_gramians_request mass_row_rayleigh(const ritz_component *component,
                                        double a, double b);

#endif
