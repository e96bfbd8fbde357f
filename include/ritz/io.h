/*
 * Inputs and outputs of a second-order model with n coordinates x:
 *
 *     M x'' + D x' + K x = B u,    y = C x + Cv x' + Ca x''
 *
 * The same object serves components (n dofs), reduced components and systems
 * (n reduced coordinates): a basis T turns B into T'B and C into C T.
 */
#ifndef RITZ_IO_H
#define RITZ_IO_H

#include <ritz/dense.h>
#include <ritz/text.h>

#pragma GCC visibility push(default)

typedef struct ritz_io {
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];  /* num_inputs names */
    char (*output)[RITZ_NAME_SIZE]; /* num_outputs names */
    ritz_dense B;                   /* n x num_inputs */
    ritz_dense C, Cv, Ca;           /* num_outputs x n; all three allocated */
    double *limit; /* num_outputs, largest tolerated |y|; NaN where none */
} ritz_io;

/** All names empty, all matrices zero, all limits NaN, for n coordinates. */
ritz_status ritz_io_new(int64_t n, int64_t num_inputs, int64_t num_outputs,
                        ritz_io *out);

/**
 * What the subspace x = T q sees: T'B, C T, Cv T, Ca T; names and limits kept.
 *
 * @param[in]  T    n x r
 */
ritz_status ritz_io_project(const ritz_io *io, const ritz_dense *T,
                            ritz_io *out);

void ritz_io_free(ritz_io *io);

#pragma GCC visibility pop

#endif
