#include "mat_samples.h"

#include "folder.h"
#include "testing.h"

const double mat_full[6] = {1.5, -2.0, 1e300, 0.0, 3.0, -0.25};
const mat_uint32_t mat_rows[5] = {0, 3, 1, 0, 2};
const mat_uint32_t mat_starts[4] = {0, 2, 3, 5};
const double mat_entries[5] = {1.0, 2.0, -3.0, 4.0, 0.5};

void mat_put(mat_t *file, matvar_t *variable, enum matio_compression how)
{
    assert_non_null(variable);
    assert_int_equal(Mat_VarWrite(file, variable, how), 0);
    Mat_VarFree(variable);
}

matvar_t *mat_real(const char *name, const double *values, size_t nrow,
                   size_t ncol)
{
    size_t dims[2] = {nrow, ncol};
    double copy[64];

    memcpy(copy, values, nrow * ncol * sizeof *copy);
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, copy, 0);
}

static matvar_t *sparse_variable(const char *name)
{
    size_t dims[2] = {4, 3};
    mat_uint32_t ir[5], jc[4];
    double value[5];
    mat_sparse_t sparse = {.nzmax = 5,
                           .ir = ir,
                           .nir = 5,
                           .jc = jc,
                           .njc = 4,
                           .ndata = 5,
                           .data = value};

    memcpy(ir, mat_rows, sizeof ir);
    memcpy(jc, mat_starts, sizeof jc);
    memcpy(value, mat_entries, sizeof value);
    return Mat_VarCreate(name, MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims, &sparse, 0);
}

static matvar_t *struct_variable(const char *name)
{
    static const char *fields[] = {"a", "s"};
    size_t dims[2] = {1, 1};
    matvar_t *outer = Mat_VarCreateStruct(name, 2, dims, fields, 2);

    assert_non_null(outer);
    Mat_VarSetStructFieldByName(outer, "a", 0, mat_real("a", mat_full, 3, 2));
    Mat_VarSetStructFieldByName(outer, "s", 0, sparse_variable("s"));
    return outer;
}

/* A, S and a struct of both. */
static void write_sample(const char *path, enum mat_ft level,
                         enum matio_compression how)
{
    mat_t *file = Mat_CreateVer(folder_path(path),
                                "MATLAB 7.3 MAT-file of a test", level);

    assert_non_null(file);
    mat_put(file, mat_real("A", mat_full, 3, 2), how);
    mat_put(file, sparse_variable("S"), how);
    mat_put(file, struct_variable("sys"), how);
    assert_int_equal(Mat_Close(file), 0);
}

const mat_sample mat_samples[MAT_SAMPLES] = {
    {"five.mat", MAT_FT_MAT5, MAT_COMPRESSION_NONE},
    {"packed.mat", MAT_FT_MAT5, MAT_COMPRESSION_ZLIB},
    {"hdf.mat", MAT_FT_MAT73, MAT_COMPRESSION_NONE},
    {"hdfpacked.mat", MAT_FT_MAT73, MAT_COMPRESSION_ZLIB},
};

int mat_samples_make(void **state)
{
    int failed = folder_make(state);

    for (int k = 0; failed == 0 && k < MAT_SAMPLES; k++)
        write_sample(mat_samples[k].path, mat_samples[k].level,
                     mat_samples[k].how);
    return failed;
}
