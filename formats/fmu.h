/* A linear model as the parts of an FMU, which export_fmu.c puts together. */
#ifndef RITZ_FORMATS_FMU_H
#define RITZ_FORMATS_FMU_H

#include <ritz/export.h>

#include <stdio.h>

/* A unit of FMI: `factor` times powers of base units; name "": not known. */
typedef struct ritz_fmu_unit {
    char name[24];
    int kg, m, s, rad;
    double factor;
} ritz_fmu_unit;

/* What an input acts on, or an output is of. */
typedef struct ritz_fmu_port {
    char name[RITZ_NAME_SIZE]; /* unique among ports, states and time */
    const char *says;          /* "force", "velocity" */
    ritz_fmu_unit unit;
} ritz_fmu_port;

/*
 * x' = A x + B u, y = C x + D u, with A of blocks: oscillators, whose states
 * are q and q' of q'' + d q' + lambda q = B_q' u, and dense ones.
 */
typedef struct ritz_fmu {
    int64_t num_inputs, num_outputs, num_states, num_blocks;
    ritz_dense *block; /* num_blocks: lambda and d, 1 x 2, or A, square */
    ritz_dense B, C, D;
    double *nominal;               /* num_states, powers of two */
    char (*state)[RITZ_NAME_SIZE]; /* "q[3]" and "v[3]" of modes, "x[3]" */
    ritz_fmu_port *input, *output;
    int64_t num_renamed, num_without_unit; /* of ports */
    ritz_fmu_unit seconds;                 /* of time */
} ritz_fmu;

/** @return RITZ_ERR_ARGUMENT if there is structural damping, or nothing drives
 * or observes the model; as ritz_simulate */
ritz_status ritz_fmu_of(const ritz_export_object *object, ritz_fmu *out);
void ritz_fmu_free(ritz_fmu *fmu);

/**
 * Names of inputs and outputs, and their units where they are known: of a
 * reduced component with its basis, of which an input or output is one dof.
 */
ritz_status ritz_fmu_name_ports(const ritz_export_object *object,
                                const ritz_io *io, ritz_fmu *fmu);

/** Entry of a block of A. */
double ritz_fmu_entry(const ritz_fmu *fmu, int64_t block, int64_t row,
                      int64_t col);

/** Number of states of a block. */
int64_t ritz_fmu_block_size(const ritz_dense *block);

/** resources/ritz.bin, laid out as fmu/model.h says. */
ritz_status ritz_fmu_numbers(const ritz_fmu *fmu,
                             const char token[RITZ_DIGEST_SIZE],
                             unsigned char **bytes, int64_t *size);

/* What modelDescription.xml says in addition to the model. */
typedef struct ritz_fmu_text {
    int64_t fmi; /* 2 or 3 */
    const char *name, *description;
    const char *token;
} ritz_fmu_text;

/** modelDescription.xml; the caller frees it. */
ritz_status ritz_fmu_describe(const ritz_fmu *fmu, const ritz_fmu_text *text,
                              char **out, int64_t *length);

/* A file of an archive. */
typedef struct ritz_zip_file {
    const char *path;
    const void *bytes;
    int64_t size;
    bool runs; /* it has the mode of a program */
} ritz_zip_file;

typedef struct ritz_zip_files {
    int64_t count;
    const ritz_zip_file *at;
} ritz_zip_files;

/** A zip archive, by libarchive, whose bytes depend on those of its files
 * alone. @return RITZ_ERR_FILE */
ritz_status ritz_archive_write(const char *path, const ritz_zip_files *files);

#endif
