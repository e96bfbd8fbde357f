/* State spaces: from rows of numbers, and of the benchmark collections. */
#ifndef RITZ_TESTS_SPACES_H
#define RITZ_TESTS_SPACES_H

#include <ritz/state_space.h>

#include <stdbool.h>

/* Row by row; D NULL: 0, E NULL: the identity. */
typedef struct spaces_rows {
    int64_t states, inputs, outputs;
    const double *A, *B, *C, *D, *E;
} spaces_rows;

ritz_status spaces_make(const spaces_rows *rows, ritz_state_space *out);

/** W'E T z' = W'A T z + W'B u solved for z', y = C T z + D u. */
ritz_status spaces_project(const ritz_state_space *model, const ritz_dense *W,
                           const ritz_dense *T, ritz_state_space *out);

/**
 * A of folder state_space/@p name of RITZ_EXTERNAL_DATA with B, C and, where it
 * is, E. False, and said on stdout, if it is not there.
 */
bool spaces_read(const char *name, ritz_state_space *out);

/** Numbers of a text file there, one a line; the caller frees @p out. */
int64_t spaces_numbers(const char *name, const char *file, double **out);

#endif
