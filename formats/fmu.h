/* A linear model as the parts of an FMU, which export_fmu.c puts together. */
#ifndef RITZ_FORMATS_FMU_H
#define RITZ_FORMATS_FMU_H

#include <ritz/export.h>

#include <stdio.h>

/* A unit of FMI: factor kg^a m^b s^c rad^d; the name is "" if it is not
   known. */
typedef struct ritz_fmu_unit {
    char name[24];
    int kg, m, s, rad; /* exponents */
    double factor;
} ritz_fmu_unit;

/* An input or output. */
typedef struct ritz_fmu_port {
    char name[RITZ_NAME_SIZE]; /* unique among ports, states and time */
    const char *says;          /* its physical quantity, "force" */
    ritz_fmu_unit unit;
} ritz_fmu_port;

/*
 * x' = A x + B u, y = C x + D u, with A block diagonal. A block is dense, or an
 * oscillator q'' + d q' + lambda q = b'u, with the states q and q'.
 */
typedef struct ritz_fmu {
    int64_t num_inputs, num_outputs, num_states, num_blocks;
    ritz_dense *block; /* num_blocks: 1 x 2, lambda and d of an oscillator, or
                          square, a dense block of A */
    ritz_dense B, C, D;
    double *nominal;               /* num_states: size of each state, 2^k */
    char (*state)[RITZ_NAME_SIZE]; /* "q[3]" and "v[3]" of modes, "x[3]" */
    ritz_fmu_port *input, *output;
    int64_t num_renamed, num_without_unit; /* ports */
    ritz_fmu_unit seconds;                 /* of time */
} ritz_fmu;

/** Make the matrices, names and units of an FMU.
 * @return RITZ_ERR_ARGUMENT if the model has structural damping, or neither
 * inputs nor outputs; and as ritz_simulate */
ritz_status ritz_fmu_of(const ritz_export_object *object, ritz_fmu *out);
void ritz_fmu_free(ritz_fmu *fmu);

/**
 * Name the inputs and outputs, and find their units where that is possible: if
 * the model is a reduced component with its basis and units, and the input or
 * output is a single dof.
 */
ritz_status ritz_fmu_name_ports(const ritz_export_object *object,
                                const ritz_io *io, ritz_fmu *fmu);

/** Entry of a block of A, row and column counted within the block. */
double ritz_fmu_entry(const ritz_fmu *fmu, int64_t block, int64_t row,
                      int64_t col);

/** Number of states of a block. */
int64_t ritz_fmu_block_size(const ritz_dense *block);

/** Make resources/ritz.bin, whose layout is in fmu/model.h. */
ritz_status ritz_fmu_numbers(const ritz_fmu *fmu,
                             const char token[RITZ_DIGEST_SIZE],
                             unsigned char **bytes, int64_t *size);

/* Texts of modelDescription.xml that are not part of the model. */
typedef struct ritz_fmu_text {
    int64_t fmi; /* 2 or 3 */
    const char *name, *description;
    const char *token;
} ritz_fmu_text;

/** Make modelDescription.xml; the caller frees it. */
ritz_status ritz_fmu_describe(const ritz_fmu *fmu, const ritz_fmu_text *text,
                              char **out, int64_t *length);

/* A file of an archive. */
typedef struct ritz_zip_file {
    const char *path;
    const void *bytes;
    int64_t size;
    bool runs; /* it is executable */
} ritz_zip_file;

typedef struct ritz_zip_files {
    int64_t count;
    const ritz_zip_file *at;
} ritz_zip_files;

/** Write a zip archive, by libarchive. The same files always give the same
 * bytes. @return RITZ_ERR_FILE */
ritz_status ritz_archive_write(const char *path, const ritz_zip_files *files);

#endif
