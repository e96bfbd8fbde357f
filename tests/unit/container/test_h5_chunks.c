#include "testing.h"

#include "base/alloc.h"
#include "container/h5.h"

#include <stdio.h>
#include <stdlib.h>

static const char ours[] = "test_chunks_ours.h5";
static const char theirs[] = "test_chunks_theirs.h5";

enum { CHUNK = 1000 };

static int tear_down(void **)
{
    remove(ours);
    remove(theirs);
    return 0;
}

/* A vector in chunks, written by Ritz or by HDF5 and its filter. */
static ritz_status write_vector(const char *path, int64_t count,
                                const double *values, bool by_hdf5)
{
    const ritz_h5_shape shape = ritz_h5_vector(count);
    const hsize_t chunk = (hsize_t)(count < CHUNK ? count : CHUNK);
    RITZ_OWN(hid_t) file = 0, space = 0, plan = 0;
    ritz_status status = RITZ_OK;
    uint64_t sum = 0;
    hid_t set = 0;

    RITZ_CHECK(ritz_h5_create(path, &file));
    space = H5Screate_simple(1, shape.dims, NULL);
    plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plan, false);
    H5Pset_chunk(plan, 1, &chunk);
    H5Pset_fletcher32(plan);
    set = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan,
                     H5P_DEFAULT);
    assert_true(set > 0);
    assert_int_equal(ritz_h5_chunk(set, H5T_NATIVE_DOUBLE, &shape), chunk);
    assert_int_equal(ritz_h5_chunk(set, H5T_NATIVE_FLOAT, &shape), 0);
    if (by_hdf5)
        assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                             H5P_DEFAULT, values) >= 0);
    else
        status =
            ritz_h5_write_chunks(set, "x", chunk, shape.dims[0], values, &sum);
    if (!by_hdf5 && status == RITZ_OK)
        assert_int_equal(sum, ritz_h5_sum(8 * count, values, RITZ_H5_SUM));
    ritz_h5_close(set);
    RITZ_CHECK(status);
    return ritz_h5_finish(&file);
}

/* Read it by chunks, as another program may have written it. */
static ritz_status read_vector(const char *path, int64_t count, double *values,
                               uint64_t *sum)
{
    const ritz_h5_shape shape = ritz_h5_vector(count);
    RITZ_OWN(hid_t) file = 0, set = 0;

    RITZ_CHECK(ritz_h5_open(path, &file));
    set = H5Dopen2(file, "x", H5P_DEFAULT);
    assert_true(set > 0);
    return ritz_h5_read_chunks(set, "x",
                               ritz_h5_chunk(set, H5T_NATIVE_DOUBLE, &shape),
                               shape.dims[0], values, sum);
}

static void assert_same_files(void)
{
    FILE *a = fopen(ours, "rb");
    FILE *b = fopen(theirs, "rb");
    int left = 0;

    assert_non_null(a);
    assert_non_null(b);
    do {
        left = getc(a);
        assert_int_equal(left, getc(b));
    } while (left != EOF);
    fclose(a);
    fclose(b);
}

/* Bytes from a generator, or all alike, such as words of 2^16 - 1, whose sums
   are multiples of the modulus. */
static void fill(int64_t count, double *values, int kind)
{
    unsigned char *at = (unsigned char *)values;
    uint64_t state = 1;

    for (int64_t k = 0; k < count * (int64_t)sizeof *values; k++) {
        state = 6364136223846793005U * state + 1442695040888963407U;
        at[k] = kind == 0   ? (unsigned char)(state >> 56)
                : kind == 1 ? 255
                            : (unsigned char)(k == 8);
    }
    for (int64_t k = 0; k < count && kind == 3; k++)
        values[k] = 0.0;
}

static void assert_reads_back(int64_t count, const double *values)
{
    static double found[750001]; /* as many as any test has */
    uint64_t sum = 0;

    assert_true(count <= (int64_t)(sizeof found / sizeof *found));
    assert_ok(read_vector(theirs, count, found, &sum));
    assert_memory_equal(found, values, (size_t)count * sizeof *found);
    assert_int_equal(sum, ritz_h5_sum(8 * count, values, RITZ_H5_SUM));
}

static void files_are_those_of_hdf5(void **)
{
    static const int64_t counts[] = {1, 255, 256, 257, 1000, 1001, 5999};

    for (int kind = 0; kind < 4; kind++)
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
            RITZ_OWN_ARRAY double *values =
                calloc((size_t)counts[k], sizeof *values);

            assert_non_null(values);
            fill(counts[k], values, kind);
            assert_ok(write_vector(ours, counts[k], values, false));
            assert_ok(write_vector(theirs, counts[k], values, true));
            assert_same_files();
            assert_reads_back(counts[k], values);
        }
}

/* The definition, byte by byte. */
static uint32_t add_words(int64_t bytes, const unsigned char *at)
{
    uint64_t first = 0, second = 0;

    for (int64_t k = 0; k < bytes; k += 2) {
        first += (uint64_t)at[k] << 8 | at[k + 1];
        first = first > 65535 ? first - 65535 : first;
        second += first;
        second = second > 65535 ? second - 65535 : second;
    }
    return (uint32_t)(second << 16 | first);
}

static void checksums_are_sums_of_words(void **)
{
    double values[1200];

    for (int kind = 0; kind < 4; kind++) {
        fill(1200, values, kind);
        for (int64_t count = 0; count <= 1200; count += 17)
            assert_int_equal(
                ritz_h5_fletcher32(8 * count, values),
                add_words(8 * count, (const unsigned char *)values));
    }
}

/* 6 MB, so that another thread computes the checksums. */
static void two_threads_write_and_read_the_same(void **)
{
    enum { COUNT = 750001 };
    RITZ_OWN_ARRAY double *values = calloc(COUNT, sizeof *values);

    assert_non_null(values);
    fill(COUNT, values, 0);
    assert_ok(write_vector(theirs, COUNT, values, true));
    for (int threads = 1; threads <= 2; threads++) {
        ritz_set_threads(threads);
        assert_ok(write_vector(ours, COUNT, values, false));
        assert_same_files();
        assert_reads_back(COUNT, values);
    }
    ritz_set_threads(1);
}

/* Invert the byte of the file that is @p from its end. */
static void damage_byte(long from)
{
    FILE *file = fopen(ours, "r+b");
    int byte = 0;

    assert_non_null(file);
    assert_int_equal(fseek(file, from, SEEK_END), 0);
    byte = getc(file);
    assert_int_equal(fseek(file, from, SEEK_END), 0);
    putc(~byte, file);
    fclose(file);
}

/* The chunks of the data set are the end of the file. */
static void damaged_chunks_are_refused(void **)
{
    enum { COUNT = 750001 };
    static const long places[] = {-1, -5, -4000000};
    RITZ_OWN_ARRAY double *values = calloc(COUNT, sizeof *values);
    uint64_t sum = 0;

    assert_non_null(values);
    fill(COUNT, values, 0);
    for (int threads = 1; threads <= 2; threads++)
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            ritz_set_threads(threads);
            assert_ok(write_vector(ours, COUNT, values, false));
            damage_byte(places[k]);
            assert_fails(read_vector(ours, COUNT, values, &sum),
                         RITZ_ERR_FORMAT, "'x' is damaged");
            fill(COUNT, values, 0);
        }
    ritz_set_threads(1);
}

static ritz_status write_some(void)
{
    const double values[2 * CHUNK] = {1.0, 2.0};

    return write_vector(ours, 2 * CHUNK, values, false);
}

static void writing_survives_every_allocation(void **)
{
    assert_survives_every_allocation(write_some());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(files_are_those_of_hdf5),
    cmocka_unit_test(checksums_are_sums_of_words),
    cmocka_unit_test(two_threads_write_and_read_the_same),
    cmocka_unit_test(damaged_chunks_are_refused),
    cmocka_unit_test(writing_survives_every_allocation),
};

TEST_MODULE(h5_chunks, tests, NULL, tear_down)
