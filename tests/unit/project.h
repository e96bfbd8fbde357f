/* What tests of reductions share. */
#ifndef RITZ_TESTS_PROJECT_H
#define RITZ_TESTS_PROJECT_H

#include <ritz/reduced.h>
#include <ritz/sparse.h>

/** T'AT; the test fails if it cannot be had. */
ritz_dense project(const ritz_sparse *A, const ritz_dense *T);

/** The pencil has these @p count frequencies, each within @p bound. */
void assert_hertz(const ritz_dense *K, const ritz_dense *M, int count,
                  const double *expected, double bound);

/** The measure of that name; the test fails if there is none. */
const ritz_measure *find_measure(const ritz_measures *measures,
                                 const char *name);

#endif
