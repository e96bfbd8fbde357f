/* The matrices of a reduced component by name, for formats of matrices. */
#ifndef RITZ_FORMATS_REDUCED_MATRICES_H
#define RITZ_FORMATS_REDUCED_MATRICES_H

#include <ritz/export.h>
#include <ritz/import.h>

/**
 * The matrices that `names` lists: K, M, D, T, B (inputs), C, Cv, Ca (outputs).
 *
 * @param[in] names  with commas between; NULL: K, M, and D if there is one
 * @return RITZ_ERR_ARGUMENT if there is no such matrix
 */
ritz_status ritz_reduced_matrices(const ritz_reduced *reduced,
                                  const char *names, ritz_matrices *out);

/** Matrices of a state space, A, B, C, D, E; NULL: all but an absent E. */
ritz_status ritz_state_matrices(const ritz_state_space *model,
                                const char *names, ritz_matrices *out);

#endif
