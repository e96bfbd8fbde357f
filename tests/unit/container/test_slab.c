#include "testing.h"

#include "container/slab.h"
#include "samples.h"

#include <hdf5.h>

#include <stdio.h>

static const char path[] = "test_slab.h5";
static const ritz_stamp stamp = {.command = "ritz-verb this that"};

static int write_sample(void **)
{
    return sample_kinds[0].make(path, &stamp) == RITZ_OK ? 0 : -1;
}

static int tear_down(void **)
{
    remove(path);
    return 0;
}

/* Read all columns in @p parts slabs and compare them with A; find the
   checksums of all. */
static void read_in_parts(const char *name, int64_t parts, const ritz_sparse *A,
                          uint64_t sum[RITZ_SLAB_SETS])
{
    ritz_slab_begin(sum);
    for (int64_t k = 0; k < parts; k++) {
        const int64_t from = A->ncol * k / parts;
        const int64_t to = A->ncol * (k + 1) / parts;
        RITZ_OWN(ritz_slab) slab = {0};

        assert_ok(ritz_slab_read(path, name, A->nrow, from, to, &slab));
        assert_int_equal(slab.A.ncol, to - from);
        assert_int_equal(slab.before, A->colptr[from]);
        assert_int_equal(slab.entries, A->colptr[A->ncol]);
        for (int64_t j = from; j <= to; j++)
            assert_int_equal(slab.A.colptr[j - from],
                             A->colptr[j] - A->colptr[from]);
        for (int64_t p = 0; p < slab.A.colptr[to - from]; p++) {
            assert_int_equal(slab.A.rowind[p], A->rowind[slab.before + p]);
            assert_true(slab.A.val[p] == A->val[slab.before + p]);
        }
        ritz_slab_sum(&slab, sum);
    }
}

static void slabs_are_columns_of_the_matrix(void **)
{
    RITZ_OWN(ritz_component) component = {0};
    uint64_t sum[RITZ_SLAB_SETS];

    assert_ok(ritz_container_read_component(path, &component));
    for (int64_t parts = 1; parts <= 2 * component.num_dofs; parts += 7) {
        read_in_parts("K", parts, &component.K, sum);
        assert_ok(ritz_slab_verify(path, "K", sum));
        read_in_parts("M", parts, &component.M, sum);
        assert_ok(ritz_slab_verify(path, "M", sum));
    }
}

static void a_frame_is_the_component_without_matrices(void **)
{
    RITZ_OWN(ritz_component) component = {0}, frame = {0};

    assert_ok(ritz_container_read_component(path, &component));
    assert_ok(ritz_slab_frame(path, &frame));
    assert_null(frame.K.colptr);
    assert_null(frame.M.colptr);
    assert_null(frame.D.colptr);
    assert_int_equal(frame.num_loads, 0);
    assert_int_equal(frame.num_dofs, component.num_dofs);
    assert_int_equal(frame.num_ports, component.num_ports);
    assert_memory_equal(frame.dof, component.dof,
                        (size_t)frame.num_dofs * sizeof *frame.dof);
    assert_memory_equal(frame.io.B.val, component.io.B.val,
                        (size_t)(frame.num_dofs * frame.io.num_inputs) *
                            sizeof(double));
    assert_string_equal(frame.units, component.units);
}

static void a_file_says_which_matrices_it_has(void **)
{
    bool has = false;

    assert_ok(ritz_slab_has(path, "D", &has));
    assert_true(has);
    assert_ok(ritz_slab_has(path, "K5", &has));
    assert_false(has);
}

/* Overwrite one value of a data set in the file. */
static void overwrite(const char *set, hsize_t at, hid_t type,
                      const void *value)
{
    const hsize_t one = 1;
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    hid_t data = H5Dopen2(file, set, H5P_DEFAULT);
    hid_t space = H5Dget_space(data);
    hid_t memory = H5Screate_simple(1, &one, NULL);

    H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, NULL, &one, NULL);
    assert_true(H5Dwrite(data, type, memory, space, H5P_DEFAULT, value) >= 0);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(data);
    H5Fclose(file);
}

static void one_wrong_value_breaks_the_checksum(void **)
{
    const double value = 12.5;
    uint64_t sum[RITZ_SLAB_SETS];

    overwrite("K/data", 70, H5T_NATIVE_DOUBLE, &value);
    ritz_slab_begin(sum);
    for (int64_t from = 0; from < SAMPLE_DOFS; from += SAMPLE_DOFS / 2) {
        RITZ_OWN(ritz_slab) slab = {0};

        assert_ok(ritz_slab_read(path, "K", SAMPLE_DOFS, from,
                                 from + SAMPLE_DOFS / 2, &slab));
        ritz_slab_sum(&slab, sum);
    }
    assert_fails(ritz_slab_verify(path, "K", sum), RITZ_ERR_FORMAT,
                 "K: 'data' is damaged: its checksum does not fit");
}

static ritz_status read_slab(const char *name, int64_t n, int64_t from,
                             int64_t to)
{
    RITZ_OWN(ritz_slab) slab = {0};

    return ritz_slab_read(path, name, n, from, to, &slab);
}

static void damaged_matrices_are_refused(void **)
{
    const double nan_value = (double)NAN;
    const int64_t wrong = 3000;

    assert_fails(read_slab("K", SAMPLE_DOFS + 1, 0, 3), RITZ_ERR_FORMAT,
                 "K: 40 columns where 41 are due");
    assert_fails(read_slab("K5", SAMPLE_DOFS, 0, 3), RITZ_ERR_FORMAT, "'K5'");
    overwrite("K/data", 2, H5T_NATIVE_DOUBLE, &nan_value);
    assert_fails(read_slab("K", SAMPLE_DOFS, 0, 3), RITZ_ERR_FORMAT,
                 "is not finite");
    overwrite("M/indptr", 20, H5T_NATIVE_INT64, &wrong);
    assert_fails(read_slab("M", SAMPLE_DOFS, 10, 20), RITZ_ERR_FORMAT,
                 "column pointers and entries disagree");
    assert_fails(read_slab("M", SAMPLE_DOFS, 15, 30), RITZ_ERR_FORMAT,
                 "column pointers descend at column 20");
}

static ritz_status read_all(void)
{
    RITZ_OWN(ritz_component) frame = {0};

    RITZ_CHECK(ritz_slab_frame(path, &frame));
    return read_slab("K", frame.num_dofs, 3, 17);
}

static void reading_survives_every_allocation(void **)
{
    assert_survives_every_allocation(read_all());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(slabs_are_columns_of_the_matrix),
    cmocka_unit_test(a_frame_is_the_component_without_matrices),
    cmocka_unit_test(a_file_says_which_matrices_it_has),
    cmocka_unit_test_setup(one_wrong_value_breaks_the_checksum, write_sample),
    cmocka_unit_test_setup(damaged_matrices_are_refused, write_sample),
    cmocka_unit_test_setup(reading_survives_every_allocation, write_sample),
};

TEST_MODULE(slab, tests, write_sample, tear_down)
