#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "foreign.h"
#include "mat_samples.h"

#include <ritz/import.h>

#include <hdf5.h>

#include <stdio.h>
#include <stdlib.h>

static void assert_full(const ritz_matrix *m, const char *name)
{
    assert_string_equal(m->name, name);
    assert_string_equal(m->other, "");
    assert_int_equal(m->A.nrow, 3);
    assert_int_equal(m->A.ncol, 2);
    assert_int_equal(m->A.colptr[2], 5); /* a zero is not kept */
    assert_int_equal(m->digits, 17);
    for (int64_t k = 0; k < 6; k++)
        assert_true(matrix_entry(&m->A, m->A.val, k % 3, k / 3) == mat_full[k]);
}

static void assert_sparse(const ritz_matrix *m, const char *name)
{
    assert_string_equal(m->name, name);
    assert_int_equal(m->A.nrow, 4);
    assert_int_equal(m->A.ncol, 3);
    assert_int_equal(m->A.colptr[3], 5);
    for (int64_t j = 0; j < 3; j++)
        for (int64_t k = mat_starts[j]; k < mat_starts[j + 1]; k++)
            assert_true(matrix_entry(&m->A, m->A.val, mat_rows[k], j) ==
                        mat_entries[k]);
}

static void what_libmatio_writes_is_read_to_the_bit(void **state)
{
    (void)state;
    for (int k = 0; k < MAT_SAMPLES; k++) {
        RITZ_OWN(ritz_matrices) all = {0};

        assert_ok(foreign_read(folder_path(mat_samples[k].path), &all));
        assert_string_equal(foreign_format, "mat");
        assert_int_equal(all.count, 4);
        assert_full(&all.matrix[0], "A");
        assert_sparse(&all.matrix[1], "S");
        assert_full(&all.matrix[2], "sys.a");
        assert_sparse(&all.matrix[3], "sys.s");
    }
}

/* Level 4 by hand: head, name, values; of either byte order. */
typedef struct bytes {
    int64_t size;
    char at[1024];
} bytes;

static void add_bytes(bytes *b, const void *from, size_t size, bool swap)
{
    const char *at = from;

    for (size_t k = 0; k < size; k++)
        b->at[b->size++] = at[swap ? size - 1 - k : k];
}

static void add_words(bytes *b, int count, const int32_t *word, bool swap)
{
    for (int k = 0; k < count; k++)
        add_bytes(b, &word[k], sizeof *word, swap);
}

static void add_level4(bytes *b, int32_t type, int32_t nrow, int32_t ncol,
                       const double *values, bool swap)
{
    const int32_t head[] = {type + (swap ? 1000 : 0), nrow, ncol, 0, 2};

    add_words(b, 5, head, swap);
    add_bytes(b, "A", 2, false);
    for (int32_t k = 0; k < nrow * ncol; k++)
        add_bytes(b, &values[k], sizeof *values, swap);
}

static void level_four_is_read_in_either_byte_order(void **state)
{
    /* rows, columns and values, the last row being the size */
    static const double triplets[] = {1, 4, 2, 1, 3, 4,  1, 1,   2,
                                      3, 3, 3, 1, 2, -3, 4, 0.5, 0};
    (void)state;
    for (int swap = 0; swap < 2; swap++) {
        bytes b = {0};
        RITZ_OWN(ritz_matrices) all = {0};

        add_level4(&b, 0, 3, 2, mat_full, swap);
        add_level4(&b, 2, 6, 3, triplets, swap);
        assert_ok(foreign_parse(b.at, b.size, &all));
        assert_int_equal(all.count, 2);
        assert_full(&all.matrix[0], "A");
        assert_sparse(&all.matrix[1], "A");
    }
}

static void what_is_no_matrix_is_said_by_name(void **state)
{
    static const struct {
        ritz_status status;
        const char *spec, *words;
    } table[] = {
        {RITZ_ERR_FORMAT, "other.mat:text", "other.mat:text' is text"},
        {RITZ_ERR_FORMAT, "other.mat:cells", "is a cell array"},
        {RITZ_ERR_FORMAT, "other.mat:none", "is empty"},
        {RITZ_ERR_FORMAT, "other.mat:cube",
         "is an array of more than two dimensions"},
        {RITZ_ERR_FORMAT, "other.mat:holes", "is not finite at (2, 1)"},
        {RITZ_ERR_FORMAT, "other.mat:structs", "is an array of structs"},
        {RITZ_ERR_ARGUMENT, "other.mat:nothing",
         "holds no 'nothing', but text, cells"},
    };
    static const char *fields[] = {"a"};
    const double holes[] = {1.0, nan(""), 2.0, 3.0};
    size_t none[2] = {0, 3}, two[2] = {2, 1}, cube[3] = {2, 2, 2};
    double eight[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    char letters[] = "abc";
    size_t three[2] = {1, 3};
    mat_t *file = Mat_CreateVer(folder_path("other.mat"), NULL, MAT_FT_MAT5);
    RITZ_OWN(ritz_matrix) m = {0};

    (void)state;
    mat_put(file,
            Mat_VarCreate("text", MAT_C_CHAR, MAT_T_UTF8, 2, three, letters, 0),
            0);
    mat_put(file,
            Mat_VarCreate("cells", MAT_C_CELL, MAT_T_CELL, 2, two, NULL, 0), 0);
    mat_put(file,
            Mat_VarCreate("none", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, none, NULL, 0),
            0);
    mat_put(
        file,
        Mat_VarCreate("cube", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, cube, eight, 0),
        0);
    mat_put(file, mat_real("holes", holes, 2, 2), 0);
    mat_put(file, Mat_VarCreateStruct("structs", 2, two, fields, 1), 0);
    mat_put(file, mat_real("A", mat_full, 3, 2), 0);
    assert_int_equal(Mat_Close(file), 0);
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        assert_fails(foreign_select(folder_path(table[k].spec), &m),
                     table[k].status, table[k].words);
    }
    assert_ok(
        foreign_select(folder_path("other.mat"), &m)); /* the only matrix */
    assert_full(&m, "A");
}

static void integers_singles_and_pairs_keep_what_they_are(void **state)
{
    size_t dims[2] = {2, 1};
    mat_int8_t small[2] = {-5, 100};
    mat_uint16_t middle[2] = {65535, 1};
    float narrow[2] = {0.1F, -2.0F};
    double re[2] = {1, 2}, im[2] = {0, -4};
    mat_complex_split_t z = {re, im};
    mat_t *file = Mat_CreateVer(folder_path("types.mat"), NULL, MAT_FT_MAT5);
    RITZ_OWN(ritz_matrices) all = {0};

    (void)state;
    mat_put(file,
            Mat_VarCreate("i8", MAT_C_INT8, MAT_T_INT8, 2, dims, small, 0), 0);
    mat_put(
        file,
        Mat_VarCreate("u16", MAT_C_UINT16, MAT_T_UINT16, 2, dims, middle, 0),
        0);
    mat_put(file,
            Mat_VarCreate("f", MAT_C_SINGLE, MAT_T_SINGLE, 2, dims, narrow, 0),
            0);
    mat_put(file,
            Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, &z,
                          MAT_F_COMPLEX),
            0);
    assert_int_equal(Mat_Close(file), 0);
    assert_ok(foreign_read(folder_path("types.mat"), &all));
    assert_true(all.matrix[0].A.val[0] == -5.0);
    assert_true(all.matrix[1].A.val[0] == 65535.0);
    assert_true(all.matrix[2].A.val[0] == (double)0.1F);
    assert_int_equal(all.matrix[2].digits, 7);
    assert_true(all.matrix[3].imaginary && all.matrix[3].imaginary[1] == -4.0);
}

static void a_wrong_checksum_of_compressed_data_is_found(void **state)
{
    ritz_matrices all = {0};
    int64_t size = 0;
    char *at = NULL;

    (void)state;
    assert_ok(ritz_bytes_read(folder_path("packed.mat"), &size, &at));
    at[size - 1] ^= 1; /* the last byte of the Adler-32 */
    assert_fails(foreign_parse(at, size, &all), RITZ_ERR_FORMAT,
                 "compressed data are damaged");
    free(at);
}

/* A Level 5 array of doubles that declares what it has not. */
static void sizes_are_held_against_the_bytes_present(void **state)
{
    static const int32_t huge[] = {14, 56, 6,          8,          6,       0,
                                   5,  8,  2000000000, 2000000000, 0x10001, 'A',
                                   9,  8,  0,          0};
    static const int32_t many[] = {14, 2000000000, 6, 8, 6, 0};
    bytes b = {0};
    ritz_matrices all = {0};

    (void)state;
    b.size = 128;
    memset(b.at, ' ', 128);
    memcpy(b.at + 124, "\0\1IM", 4);
    add_words(&b, 16, huge, false);
    assert_fails(foreign_parse(b.at, b.size, &all), RITZ_ERR_FORMAT,
                 "'A' is 2000000000 x 2000000000 and has 1 values");
    b.size = 128;
    add_words(&b, 6, many, false);
    assert_fails(foreign_parse(b.at, b.size, &all), RITZ_ERR_FORMAT,
                 "byte 128: an element of 2000000000 bytes begins, but 16");
    b.size = 0;
    add_level4(&b, 0, 0, 0, mat_full, false);
    memcpy(b.at + 4, (int32_t[]){2000000000, 2000000000}, 8);
    assert_fails(foreign_parse(b.at, b.size, &all), RITZ_ERR_FORMAT,
                 "'A' is 2000000000 x 2000000000, but 0 bytes are left");
}

static ritz_status read_and_drop(const char *path)
{
    ritz_matrices all = {0};
    ritz_status status = foreign_read(path, &all);

    ritz_matrices_free(&all);
    return status;
}

static void copy_sample(const mat_sample *sample, const char *name)
{
    RITZ_OWN_ARRAY char *content = NULL;
    int64_t size = 0;
    FILE *file = NULL;

    assert_ok(ritz_bytes_read(folder_path(sample->path), &size, &content));
    file = fopen(folder_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(content, 1, (size_t)size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* A struct with a member that is a hard link to the struct itself. */
static void a_struct_is_gone_through_once(void **state)
{
    enum { OWN = 4 };
    static const char loop[] = "loop.mat";
    RITZ_OWN(ritz_foreign) file = {0};
    hid_t copy = -1;

    (void)state;
    for (int k = 0; k < MAT_SAMPLES; k++)
        if (mat_samples[k].level == MAT_FT_MAT73)
            copy_sample(&mat_samples[k], loop);
    copy = H5Fopen(folder_path(loop), H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(copy >= 0);
    assert_true(H5Lcreate_hard(copy, "sys", copy, "sys/same", H5P_DEFAULT,
                               H5P_DEFAULT) >= 0);
    assert_true(H5Fclose(copy) >= 0);
    assert_ok(ritz_foreign_open(folder_path(loop), &file));
    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, OWN + 1);
    assert_string_equal(file.listing.item[OWN].name, "sys.same");
    assert_string_equal(file.listing.item[OWN].other,
                        "the same struct as under another name");
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (int k = 0; k < MAT_SAMPLES; k++) {
        const char *path = folder_path(mat_samples[k].path);

        assert_survives_every_allocation(read_and_drop(path));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_libmatio_writes_is_read_to_the_bit),
    cmocka_unit_test(level_four_is_read_in_either_byte_order),
    cmocka_unit_test(what_is_no_matrix_is_said_by_name),
    cmocka_unit_test(integers_singles_and_pairs_keep_what_they_are),
    cmocka_unit_test(a_wrong_checksum_of_compressed_data_is_found),
    cmocka_unit_test(sizes_are_held_against_the_bytes_present),
    cmocka_unit_test(a_struct_is_gone_through_once),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(mat, tests, mat_samples_make, folder_remove)
