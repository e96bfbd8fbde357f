/*
 * Masses in a row: spring and dashpot i join mass i - 1, or the ground for
 * i = 0, to mass i. Mass i is grid i + 1 and moves along 1.
 */
#ifndef RITZ_TESTS_MASSES_H
#define RITZ_TESTS_MASSES_H

#include <ritz/component.h>

enum { MASSES_MOST = 64 };

/**
 * @p n masses, MASSES_MOST at most, without inputs and outputs. k[0] = 0 sets
 * them free.
 *
 * @param[in] c  dashpots, in D; NULL: there is no D
 */
ritz_status masses_component(int64_t n, const double *m, const double *k,
                             const double *c, ritz_component *out);

/**
 * @p n unit masses, MASSES_MOST at most, each on a spring and dashpot of its
 * own: the pencil (diag k, I). `io` is {0}, and the caller's to make.
 *
 * @param[in] c  NULL: there is no D
 */
ritz_status masses_apart(int64_t n, const double *k, const double *c,
                         ritz_component *out);

/**
 * Unit forces on some masses as inputs u1, u2, ..., and displacements of some
 * as outputs y1, y2, ...
 */
ritz_status masses_io(ritz_component *masses, int64_t num_inputs,
                      const int64_t *input_mass, int64_t num_outputs,
                      const int64_t *output_mass);

/** data/chain through ritz_import: force at mass 10, displacement of mass 1.
 * RITZ_ERR_FILE without RITZ_DATA. */
ritz_status masses_shipped(ritz_component *out);

#endif
