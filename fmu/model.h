/* SPDX-License-Identifier: 0BSD */
/*
 * The linear model x' = A x + B u, y = C x + D u that the file
 * resources/ritz.bin holds.
 *
 * A is block diagonal. A block is dense, or it is an oscillator
 * q'' + d q' + lambda q = B_q' u with the states q and q'. The file is
 * little-endian, numbers have 8 bytes, and matrices are stored by columns:
 *
 *     bytes    "RITZFMU1"
 *     integer  hash of all bytes that follow: FNV-1a of 64 bits
 *              [FowlerNollVo2019]
 *     bytes    64 hexadecimal digits, the instantiation token
 *     integer  4: how many inputs, outputs, states and blocks there are
 *     integer  for each block the number of its states; 0: an oscillator
 *     real     for each block A, or lambda and d of an oscillator
 *     real     B, C, D, and the nominal value of each state
 */
#ifndef RITZ_FMU_MODEL_H
#define RITZ_FMU_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FMU_TOKEN_SIZE = 65, FMU_MESSAGE_SIZE = 512 };

typedef struct fmu_block {
    size_t first, count; /* its states are first ... first + count - 1 */
    bool oscillates;
    const double *A; /* count x count; of an oscillator lambda and d */
} fmu_block;

typedef struct fmu_model {
    size_t num_inputs, num_outputs, num_states, num_blocks;
    fmu_block *block;
    size_t *block_of; /* num_states */
    const double *B, *C, *D, *nominal;
    char token[FMU_TOKEN_SIZE];
    double *numbers; /* the array that A, B, C, D and nominal point into */
} fmu_model;

/**
 * Read a file, and refuse anything that is not exactly such a model.
 *
 * @param[out] why  a sentence if it is refused
 */
bool fmu_model_read(const char *path, fmu_model *out,
                    char why[FMU_MESSAGE_SIZE]);

/** Take the model from the bytes of a file; otherwise as fmu_model_read. */
bool fmu_model_parse(const unsigned char *bytes, size_t size, fmu_model *out,
                     char why[FMU_MESSAGE_SIZE]);
void fmu_model_free(fmu_model *model);

/** dx = A x + B u */
void fmu_model_derive(const fmu_model *model, const double *x, const double *u,
                      double *dx);

/** Output @p i of C x + D u. */
double fmu_model_output(const fmu_model *model, size_t i, const double *x,
                        const double *u);

/** Entry of A in row @p i and column @p j. */
double fmu_model_A(const fmu_model *model, size_t i, size_t j);

#endif
