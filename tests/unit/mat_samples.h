/* MAT files of known matrices, as libmatio writes them. */
#ifndef RITZ_TESTS_MAT_SAMPLES_H
#define RITZ_TESTS_MAT_SAMPLES_H

#include <matio.h>

/* A full 3 x 2 matrix, and a sparse one of 4 x 3 with 5 entries. */
extern const double mat_full[6];
extern const mat_uint32_t mat_rows[5], mat_starts[4];
extern const double mat_entries[5];

/* Both, as A and S, and a struct sys of both, in files of the test's folder. */
enum { MAT_SAMPLES = 4 };

typedef struct mat_sample {
    const char *path;
    enum mat_ft level;
    enum matio_compression how;
} mat_sample;

extern const mat_sample mat_samples[MAT_SAMPLES];

/** For cmocka_run_group_tests, with folder_remove: a folder of the samples. */
int mat_samples_make(void **state);

/** A variable of doubles, at most 64. */
matvar_t *mat_real(const char *name, const double *values, size_t nrow,
                   size_t ncol);

/** Write a variable, and free it. */
void mat_put(mat_t *file, matvar_t *variable, enum matio_compression how);

#endif
