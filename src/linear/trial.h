/*
 * Sizes that decide how modes are searched for, and what tests change of them.
 *
 * Models of tests are so small that LAPACK solves them. With the environment
 * variable RITZ_TEST_ENGINE=lanczos, arpack, slices or amls the sizes are small
 * ones, so that searches, slices and substructures take place, by that engine
 * where a caller names none.
 */
#ifndef RITZ_LINEAR_TRIAL_H
#define RITZ_LINEAR_TRIAL_H

#include <ritz/matrix.h>

#include <stdint.h>

typedef struct ritz_trial {
    ritz_eigen_engine
        engine;     /* of a span with RITZ_EIGEN_AUTO; AUTO: no test */
    int64_t small;  /* dofs, or dofs with mass, up to which LAPACK is used */
    int64_t medium; /* dofs up to which LAPACK is used if more than a quarter of
                       all modes are requested */
    int64_t plenty; /* substructures find up to one mode in so many dofs */
    int64_t side;   /* of slices; 0: as usual */
    int64_t leaf;   /* of substructures; 0: as usual */
} ritz_trial;

/** The usual sizes, or those of a test. */
const ritz_trial *ritz_trial_here(void);

#endif
