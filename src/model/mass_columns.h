/* Columns without mass, exactly so, of reduced components. */
#ifndef RITZ_MODEL_MASS_COLUMNS_H
#define RITZ_MODEL_MASS_COLUMNS_H

#include <ritz/reduced.h>

/** T with zeros for columns of kind massless. */
ritz_status ritz_mass_columns(const ritz_basis *basis, ritz_dense *out);

/**
 * Clear what columns of kind massless have of M and D, and in M what is the
 * rounding of columns that are made of massless dofs.
 *
 * @param[in,out] reduced  K, M and D are there
 */
void ritz_mass_settle(const ritz_component *component,
                      const ritz_columns *columns, ritz_reduced *reduced);

/** The same rounding after a second projection. */
void ritz_mass_settle_again(const ritz_reduced *from, ritz_reduced *to);

#endif
