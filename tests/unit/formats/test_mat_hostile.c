/*
 * MAT 7.3 files that MATLAB does not write: links in place of members,
 * compression applied twice, elements of size 0 and very large elements.
 */
#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "foreign.h"

#include <ritz/import.h>

#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* An HDF5 file behind a user block of 512 bytes, as MATLAB writes it. */
static hid_t begin(const char *path)
{
    hid_t plan = H5Pcreate(H5P_FILE_CREATE);
    hid_t file = -1;

    assert_true(H5Pset_userblock(plan, 512) >= 0);
    file = H5Fcreate(path, H5F_ACC_TRUNC, plan, H5P_DEFAULT);
    assert_true(file >= 0);
    H5Pclose(plan);
    return file;
}

static void end(const char *path, hid_t file)
{
    char head[512] = "MATLAB 7.3 MAT-file";
    FILE *stream = NULL;

    assert_true(H5Fclose(file) >= 0);
    stream = fopen(path, "r+b");
    assert_non_null(stream);
    assert_int_equal(fwrite(head, 1, sizeof head, stream), sizeof head);
    assert_int_equal(fclose(stream), 0);
}

/* A data set of zeros: one chunk behind `deflates` deflate filters, if there
   are any. */
static void put_zeros(hid_t at, const char *name, hid_t type, hsize_t rows,
                      hsize_t cols, int deflates)
{
    const hsize_t dims[] = {rows, cols};
    hid_t space = H5Screate_simple(2, dims, NULL);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    hid_t set = -1;
    void *values = calloc((size_t)(rows * cols) + 1, H5Tget_size(type));

    assert_non_null(values);
    if (deflates > 0)
        assert_true(H5Pset_chunk(plan, 2, dims) >= 0);
    for (int k = 0; k < deflates; k++)
        assert_true(H5Pset_filter(plan, H5Z_FILTER_DEFLATE, 0, 1,
                                  (unsigned[]){9}) >= 0);
    set = H5Dcreate2(at, name, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    assert_true(set >= 0);
    assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >=
                0);
    free(values);
    H5Dclose(set);
    H5Pclose(plan);
    H5Sclose(space);
}

static void assert_refused(const char *path, const char *words)
{
    ritz_matrices all = {0};

    assert_fails(foreign_read(path, &all), RITZ_ERR_FORMAT, words);
    ritz_matrices_free(&all);
}

/* One deflate filter inflates 1032-fold at most, two of them 1032^2-fold. */
static void one_deflate_is_read_and_two_are_refused(void **state)
{
    (void)state;
    for (int deflates = 1; deflates <= 2; deflates++) {
        const char *path = folder_path("deflate.mat");
        RITZ_OWN(ritz_matrices) all = {0};
        hid_t file = begin(path);

        put_zeros(file, "A", H5T_NATIVE_DOUBLE, 64, 64, deflates);
        end(path, file);
        if (deflates == 1)
            assert_ok(foreign_read(path, &all));
        else
            assert_refused(path, "'A' is stored in a way that is not known");
    }
}

/* A link in place of values, rows or starts is refused, not taken for an empty
   matrix. */
static void a_link_in_a_sparse_matrix_is_refused(void **state)
{
    static const char *const parts[] = {"data", "ir", "jc"};

    (void)state;
    for (int soft = 0; soft < 2; soft++)
        for (int k = 0; k < 3; k++) {
            const char *path = folder_path("link.mat");
            hid_t file = begin(path);
            hid_t group =
                H5Gcreate2(file, "S", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
            hid_t space = H5Screate(H5S_SCALAR);
            hid_t rows = H5Acreate2(group, "MATLAB_sparse", H5T_NATIVE_INT,
                                    space, H5P_DEFAULT, H5P_DEFAULT);
            int nrow = 3;

            assert_true(H5Awrite(rows, H5T_NATIVE_INT, &nrow) >= 0);
            H5Aclose(rows);
            H5Sclose(space);
            for (int i = 0; i < 3; i++)
                if (i != k)
                    put_zeros(group, parts[i], H5T_NATIVE_DOUBLE, 1,
                              i == 2 ? 4 : 0, 0);
            assert_true(
                (soft ? H5Lcreate_soft("/elsewhere", group, parts[k],
                                       H5P_DEFAULT, H5P_DEFAULT)
                      : H5Lcreate_external("other.mat", "/d", group, parts[k],
                                           H5P_DEFAULT, H5P_DEFAULT)) >= 0);
            H5Gclose(group);
            end(path, file);
            assert_refused(path, "is a link to elsewhere");
        }
}

/* The file's element size is overwritten by 0. */
static void elements_of_no_size_are_refused(void **state)
{
    static const char type[] = {0x11, 0x20, 0x3f, 0, 8, 0, 0, 0, 0, 0, 0x40};
    const char *path = folder_path("none.mat");
    hid_t file = begin(path);
    int64_t size = 0;
    int found = 0;
    char *at = NULL;

    (void)state;
    put_zeros(file, "A", H5T_IEEE_F64LE, 3, 2, 0);
    end(path, file);
    assert_ok(ritz_bytes_read(path, &size, &at));
    for (int64_t k = 0; k + (int64_t)sizeof type <= size; k++)
        if (memcmp(at + k, type, sizeof type) == 0) {
            at[k + 4] = 0;
            found++;
        }
    assert_true(found > 0);
    damage_try(damage_read_matrices, at, size);
    assert_int_equal(damage_read_matrices(at, size), RITZ_ERR_FORMAT);
    free(at);
}

/* The limit of a chunk counts bytes, not values: this chunk of 60000 complex
   values of 4 kB each (mostly padding) takes 245 MB, for which the file stores
   1000 bytes. */
static void a_chunk_is_limited_in_bytes(void **state)
{
    enum { STORED = 1000 };
    static const char stored[STORED];
    const char *path = folder_path("chunk.mat");
    const hsize_t dims[] = {1, 2}, chunk[] = {1, 60000}, most[] = {1, 60000};
    hid_t file = begin(path);
    hid_t space = H5Screate_simple(2, dims, most);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    hid_t type = H5Tcreate(H5T_COMPOUND, 4096);
    hid_t set = -1;

    (void)state;
    assert_true(H5Tinsert(type, "real", 0, H5T_NATIVE_DOUBLE) >= 0);
    assert_true(H5Tinsert(type, "imag", 8, H5T_NATIVE_DOUBLE) >= 0);
    assert_true(H5Pset_chunk(plan, 2, chunk) >= 0);
    assert_true(H5Pset_deflate(plan, 9) >= 0);
    set = H5Dcreate2(file, "A", type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    assert_true(set >= 0);
    assert_true(H5Dwrite_chunk(set, H5P_DEFAULT, 0, (const hsize_t[]){0, 0},
                               STORED, stored) >= 0);
    H5Dclose(set);
    H5Tclose(type);
    H5Pclose(plan);
    H5Sclose(space);
    end(path, file);
    assert_refused(path, "'A' declares more than the file holds");
}

/* The limit counts values as held in memory, 32 bytes each: 36 million values
   of one byte, stored in 36 kB, would take more than 1 GiB. */
static void values_are_limited_as_they_are_in_memory(void **state)
{
    enum { CHUNKS = 36, WIDE = 1000000, ROOM = 4096 };
    const char *path = folder_path("wide.mat");
    const hsize_t dims[] = {1, (hsize_t)CHUNKS * WIDE}, chunk[] = {1, WIDE};
    hid_t file = begin(path);
    hid_t space = H5Screate_simple(2, dims, NULL);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    hid_t set = -1;
    unsigned char *zeros = calloc(WIDE, 1);
    unsigned char packed[ROOM];
    uLongf size = ROOM;

    (void)state;
    assert_non_null(zeros);
    assert_int_equal(compress2(packed, &size, zeros, WIDE, 9), Z_OK);
    assert_true(H5Pset_chunk(plan, 2, chunk) >= 0);
    assert_true(H5Pset_deflate(plan, 9) >= 0);
    set = H5Dcreate2(file, "A", H5T_STD_I8LE, space, H5P_DEFAULT, plan,
                     H5P_DEFAULT);
    assert_true(set >= 0);
    for (hsize_t k = 0; k < CHUNKS; k++)
        assert_true(H5Dwrite_chunk(set, H5P_DEFAULT, 0,
                                   (const hsize_t[]){0, k * WIDE}, size,
                                   packed) >= 0);
    free(zeros);
    H5Dclose(set);
    H5Pclose(plan);
    H5Sclose(space);
    end(path, file);
    assert_refused(path, "'A' has 36000000 values");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_deflate_is_read_and_two_are_refused),
    cmocka_unit_test(a_link_in_a_sparse_matrix_is_refused),
    cmocka_unit_test(elements_of_no_size_are_refused),
    cmocka_unit_test(a_chunk_is_limited_in_bytes),
    cmocka_unit_test(values_are_limited_as_they_are_in_memory),
};

TEST_MODULE(mat_hostile, tests, folder_make, folder_remove)
