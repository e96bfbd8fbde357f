/* Where a damping matrix is no combination of mass and stiffness. */
#ifndef RITZ_MODEL_LOCAL_DAMPING_H
#define RITZ_MODEL_LOCAL_DAMPING_H

#include <ritz/model.h>

/**
 * Dofs at which D is not a M + b K, for the a and b on which most columns
 * agree: there local dampers act, or materials differ.
 *
 * @param[out] count  of them; 0 without a D
 * @param[out] first  index of the first; -1: there is none
 * @cost O(nnz + n)
 */
ritz_status ritz_damping_beyond(const ritz_component *component, int64_t *count,
                                int64_t *first);

/**
 * The a and b on which most columns of D agree, 0 without a D; *whole: all of
 * them do, to six digits.
 */
ritz_status ritz_damping_proportion(const ritz_component *component, double *a,
                                    double *b, bool *whole);

#endif
