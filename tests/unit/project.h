/* What tests of reductions share. */
#ifndef RITZ_TESTS_PROJECT_H
#define RITZ_TESTS_PROJECT_H

#include <ritz/sparse.h>

/** T'AT; the test fails if it cannot be had. */
ritz_dense project(const ritz_sparse *A, const ritz_dense *T);

#endif
