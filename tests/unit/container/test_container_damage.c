#include "testing.h"

#include "container/h5.h"
#include "samples.h"

#include <ritz/container.h>

#include <hdf5.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Damages of each kind of object; ./bootstrap fuzz makes millions. */
enum { SEEDS = 200, CUTS = 60, MOST = 1 << 18 };

static const char path[] = "test_container_damage.h5";
static const char again[] = "test_container_damage_again.h5";
static const ritz_stamp stamp = {.command = "ritz-verb"};

static int tear_down(void **)
{
    remove(path);
    remove(again);
    return 0;
}

static size_t load(const char *name, unsigned char bytes[MOST])
{
    FILE *file = fopen(name, "rb");
    size_t size = 0;

    assert_non_null(file);
    size = fread(bytes, 1, MOST, file);
    assert_true(size < MOST);
    fclose(file);
    return size;
}

static void store(const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* Read the stored file and write its object again. True if the file is refused,
   with a sentence; otherwise the copy must equal the undamaged file. */
static bool is_found(const sample_kind *kind, const unsigned char *whole,
                     size_t size)
{
    static unsigned char bytes[MOST];
    ritz_status status = kind->copy(path, again, &stamp);

    if (status != RITZ_OK) {
        assert_true(strlen(ritz_error_message()) > sizeof path + 4);
        assert_int_equal(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
        return true;
    }
    assert_int_equal(load(again, bytes), size);
    assert_memory_equal(bytes, whole, size);
    return false;
}

/* Linear congruential numbers, with the constants of rand() in the C standard. */
static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1103515245U + 12345U;
    return *seed >> 8;
}

/* One to three bytes are changed. */
static void damage_is_found_or_harmless(void **)
{
    static unsigned char whole[MOST];
    static unsigned char bytes[MOST];

    for (int k = 0; k < SAMPLE_KINDS; k++) {
        size_t size = 0;
        int found = 0;

        assert_ok(sample_kinds[k].make(path, &stamp));
        size = load(path, whole);
        for (uint32_t n = 0; n < SEEDS; n++) {
            uint32_t seed = n;

            memcpy(bytes, whole, size);
            for (uint32_t i = 0; i <= n % 3; i++)
                bytes[next(&seed) % size] ^=
                    (unsigned char)(1 + next(&seed) % 255);
            store(bytes, size);
            found += is_found(&sample_kinds[k], whole, size);
        }
        assert_true(found > SEEDS / 10); /* measured: 2 to 4 of 5 */
    }
}

static void a_file_cut_short_is_refused(void **)
{
    static unsigned char whole[MOST];

    for (int k = 0; k < SAMPLE_KINDS; k++) {
        size_t size = 0;

        assert_ok(sample_kinds[k].make(path, &stamp));
        size = load(path, whole);
        for (size_t n = 0; n < CUTS; n++) {
            store(whole, n < CUTS / 2 ? n * size / CUTS : size - (CUTS - n));
            assert_true(is_found(&sample_kinds[k], whole, size));
        }
    }
}

/* The smallest of the samples is cut at every byte. */
static void a_small_file_cut_at_any_byte_is_refused(void **)
{
    static unsigned char whole[MOST];
    size_t least = MOST;
    int smallest = 0;

    for (int k = 0; k < SAMPLE_KINDS; k++) {
        size_t size = 0;

        assert_ok(sample_kinds[k].make(path, &stamp));
        size = load(path, whole);
        if (size < least) {
            least = size;
            smallest = k;
        }
    }
    assert_ok(sample_kinds[smallest].make(path, &stamp));
    assert_int_equal(load(path, whole), least);
    for (size_t n = 0; n < least; n++) {
        store(whole, n);
        assert_true(is_found(&sample_kinds[smallest], whole, least));
    }
}

enum { NOTHING, REAL, WHOLE };

#define HUGE_LENGTH ((hsize_t)1 << 37)

/* One change made to a proper container, and what is said of it. */
typedef struct change {
    int64_t kind;      /* of sample_kinds */
    const char *where; /* group or file that is changed */
    const char *name;  /* of the data set or attribute, which is replaced */
    const char *sentence;
    int type; /* NOTHING: removed */
    int attribute;
    int rank;
    hsize_t dims[3];
    double value[4];
} change;

static void apply(const change *c)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    hid_t at = H5Oopen(file, c->where, H5P_DEFAULT);
    hid_t space = H5Screate_simple(c->rank, c->dims, NULL);
    hid_t type = c->type == REAL ? H5T_IEEE_F64LE : H5T_STD_I64LE;
    hid_t set = 0;

    assert_true(at > 0);
    if (c->attribute)
        H5Adelete(at, c->name);
    else
        H5Ldelete(at, c->name, H5P_DEFAULT);
    if (c->type != NOTHING && c->attribute) {
        set = H5Acreate2(at, c->name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        assert_true(H5Awrite(set, H5T_NATIVE_DOUBLE, c->value) >= 0);
        H5Aclose(set);
    } else if (c->type != NOTHING) {
        set = H5Dcreate2(at, c->name, type, space, H5P_DEFAULT, H5P_DEFAULT,
                         H5P_DEFAULT);
        assert_true(set > 0);
        if (c->dims[0] <= 4)
            H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                     c->value);
        H5Dclose(set);
    }
    H5Sclose(space);
    H5Oclose(at);
    H5Fclose(file);
}

static const change changes[] = {
    {0, "/", "ritz_format", "is of format 2, this release reads 1",
     .type = WHOLE, .attribute = true, .value = {2.0}},
    {0, "/", "ritz_kind", "no container", .type = NOTHING, .attribute = true},
    {0, "/", "M", "there is no mass", .type = NOTHING},
    {0, "/K", "data", "'data' declares more values than the file holds",
     .type = REAL, .rank = 1, .dims = {HUGE_LENGTH}},
    {0, "/K", "shape", "shape and column pointers disagree", .type = WHOLE,
     .attribute = true, .rank = 1, .dims = {2}, .value = {41.0, 41.0}},
    {0, "/ports/tip", "dofs", "tip: value 2 of 'dofs' is 40, not in 0..39",
     .type = WHOLE, .rank = 1, .dims = {2}, .value = {0.0, 40.0}},
    {0, "/ports/tip", "dofs", "row 3 is in 'dofs' twice", .type = WHOLE,
     .rank = 1, .dims = {2}, .value = {3.0, 3.0}},
    {0, "/ports/tip", "axes", "no attribute 'axes'", .type = NOTHING,
     .attribute = true},
    {0, "/ports/tip", "index", "some members have an 'index'", .type = NOTHING,
     .attribute = true},
    {0, "/ports/tip", "index", "index 1 of 'tip' is taken", .type = WHOLE,
     .attribute = true, .value = {1.0}},
    {0, "/inputs", "B", "'B' is 2 x 2 where 40 x 2 is due", .type = REAL,
     .rank = 2, .dims = {2, 2}},
    {0, "/grids", "frame", "'frame' is 2, not in 0..1", .type = WHOLE,
     .rank = 1, .dims = {3}, .value = {0.0, 2.0, 0.0}},
    {0, "/grids", "id", "'id' does not ascend at grid 7", .type = WHOLE,
     .rank = 1, .dims = {3}, .value = {7.0, 7.0, 9.0}},
    {0, "/recovery", "grid",
     "recovery: 'grid 101 T1' is recovered and has a row", .type = WHOLE,
     .rank = 1, .dims = {4}, .value = {101.0, 901.0, 901.0, 901.0}},
    {0, "/recovery/G", "shape",
     "recovery: recovered dofs are of another size: 6 x 40 where 4 x 40 is due",
     .type = WHOLE, .attribute = true, .rank = 1, .dims = {2},
     .value = {6.0, 40.0}},
    {1, "/", "T", "'T' declares more values than the file holds", .type = REAL,
     .rank = 2, .dims = {1 << 20, 1 << 20}},
    {1, "/", "T", "no data set 'T' of 2 dimensions", .type = REAL, .rank = 1,
     .dims = {3}},
    {1, "/columns", "kind", "'kind' declares more values", .type = REAL,
     .rank = 1, .dims = {9}},
    {1, "/", "T", "'T' holds values of another type", .type = WHOLE, .rank = 2,
     .dims = {2, 2}, .value = {1.0, 2.0, 3.0, 4.0}},
    {2, "/", "K", "'K' is not square", .type = REAL, .rank = 2, .dims = {1, 2}},
    {2, "/", "num_dofs", "'num_dofs' is -1", .type = WHOLE, .attribute = true,
     .value = {-1.0}},
    {2, "/errors", "value", "value 1 of 'value' is none", .type = REAL,
     .rank = 1, .dims = {2}, .value = {(double)NAN, 1.0}},
    {0, "/dampers", "B", "dampers: 'B' is 2 x 2 where 40 x 2 is due",
     .type = REAL, .rank = 2, .dims = {2, 2}},
    {2, "/dampers", "c", "dampers: damper 'strut' has c = -1", .type = REAL,
     .rank = 1, .dims = {2}, .value = {-1.0, 0.0}},
    {3, "/configurations/1/dampers", "held_k",
     "dampers: value 1 of 'held_k' is not finite", .type = REAL, .rank = 1,
     .dims = {2}, .value = {(double)NAN, 1.0}},
    {3, "/blocks/rotor", "first", "rotor: attribute 'first' is 4",
     .type = WHOLE, .attribute = true, .value = {4.0}},
    {3, "/configurations/1", "lambda", "configurations: 1: 'lambda' is of",
     .type = REAL, .rank = 1, .dims = {2}},
    {3, "/configurations/1/blocks", "rotor", "no data set 'rotor'",
     .type = NOTHING},
    {4, "/H", "imag", "'imag' is of 1 x 3 x 1 values where 20 x 3 x 2",
     .type = REAL, .rank = 3, .dims = {1, 3, 1}},
    {5, "/", "order", "'order' is of 2 values where 70 are due", .type = WHOLE,
     .rank = 1, .dims = {2}},
    {1, "/", "states", "attribute 'states' is 2, not in 1..1", .type = WHOLE,
     .attribute = true, .value = {2.0}},
    {1, "/", "W", "'W' is 2 x 2 where 40 x 9 is due", .type = REAL, .rank = 2,
     .dims = {2, 2}},
    {6, "/", "A", "'A' is not square", .type = REAL, .rank = 2, .dims = {1, 2}},
    {6, "/", "D", "'D' is 2 x 2 where 3 x 2 is due", .type = REAL, .rank = 2,
     .dims = {2, 2}},
    {6, "/", "E", "'E' is 2 x 2 where 9 x 9 is due", .type = REAL, .rank = 2,
     .dims = {2, 2}},
    {6, "/outputs", "limits", "'limits' is of 2 values", .type = REAL,
     .rank = 1, .dims = {2}},
};

static void what_does_not_fit_is_refused_with_its_sentence(void **)
{
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        const sample_kind *kind = &sample_kinds[changes[k].kind];

        assert_ok(kind->make(path, &stamp));
        apply(&changes[k]);
        assert_int_equal(kind->copy(path, again, &stamp), RITZ_ERR_FORMAT);
        if (!strstr(ritz_error_message(), changes[k].sentence))
            fail_msg("'%s' is not in '%s'", changes[k].sentence,
                     ritz_error_message());
    }
}

/* A link cannot make the reader open other files. */
static void links_to_elsewhere_are_not_followed(void **)
{
    ritz_basis none = {0};
    hid_t file = 0;

    assert_ok(sample_kinds[1].make(again, &stamp));
    assert_ok(sample_kinds[1].make(path, &stamp));
    file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Ldelete(file, "T", H5P_DEFAULT) >= 0);
    assert_true(H5Lcreate_external(again, "/T", file, "T", H5P_DEFAULT,
                                   H5P_DEFAULT) >= 0);
    H5Fclose(file);
    assert_fails(ritz_container_read_basis(path, &none), RITZ_ERR_FORMAT,
                 "'T' is a link to elsewhere");
}

/* A linked matrix, or a linked part of one, must not count as absent, which
   would mean 0. */
static void a_member_that_is_a_link_is_not_absent(void **)
{
    static const char *const members[] = {"K",        "D",    "dampers",
                                          "K/values", "dofs", "unknown"};

    for (size_t k = 0; k < sizeof members / sizeof *members; k++) {
        ritz_component none = {0};
        hid_t file = 0;

        assert_ok(sample_kinds[0].make(path, &stamp));
        file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
        if (H5Lexists(file, members[k], H5P_DEFAULT) > 0)
            assert_true(H5Ldelete(file, members[k], H5P_DEFAULT) >= 0);
        assert_true(H5Lcreate_soft("/M", file, members[k], H5P_DEFAULT,
                                   H5P_DEFAULT) >= 0);
        H5Fclose(file);
        assert_fails(ritz_container_read_component(path, &none),
                     RITZ_ERR_FORMAT, "is a link to elsewhere");
    }
}

static void store_letters(hid_t set, hsize_t count)
{
    char *letters = malloc(count);

    assert_non_null(letters);
    memset(letters, 'a', count);
    assert_true(
        H5Dwrite(set, H5T_C_S1, H5S_ALL, H5S_ALL, H5P_DEFAULT, letters) >= 0);
    free(letters);
}

/* A name takes 64 bytes of memory: 2 million names of one letter are 128 MB,
   from a file of 2 MB. */
static void texts_are_limited_in_memory(void **)
{
    const hsize_t count = 2000000;
    ritz_component none = {0};
    hid_t space = H5Screate_simple(1, &count, NULL);
    hid_t file = 0, set = 0;

    assert_ok(sample_kinds[0].make(path, &stamp));
    file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Ldelete(file, "inputs/names", H5P_DEFAULT) >= 0);
    set = H5Dcreate2(file, "inputs/names", H5T_C_S1, space, H5P_DEFAULT,
                     H5P_DEFAULT, H5P_DEFAULT);
    assert_true(set >= 0);
    store_letters(set, count);
    H5Dclose(set);
    H5Sclose(space);
    H5Fclose(file);
    assert_fails(ritz_container_read_component(path, &none), RITZ_ERR_FORMAT,
                 "'names' takes 122 MiB of memory, in all more than a file of");
}

/* A data set that is read again counts again, as it would through many links.
   The limit is 8 times the file's size and 64 MiB: 16 reads of a data set of 8
   MB. */
static void a_file_is_limited_in_memory(void **)
{
    enum { COUNT = 1000000, TIMES = 15 };
    const ritz_h5_shape shape = ritz_h5_vector(COUNT);
    const hsize_t count = COUNT;
    double *values = calloc(COUNT, sizeof *values);
    hid_t space = H5Screate_simple(1, &count, NULL);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t set = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT,
                           H5P_DEFAULT, H5P_DEFAULT);

    assert_non_null(values);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         values) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Fclose(file);
    for (int round = 0; round < 2; round++) { /* each open begins a new count */
        assert_ok(ritz_h5_open(path, &file));
        for (int k = 0; k < TIMES; k++)
            assert_ok(ritz_h5_read(file, "x", H5T_IEEE_F64LE, shape, values));
        H5Fclose(file);
    }
    assert_ok(ritz_h5_open(path, &file));
    for (int k = 0; k <= TIMES; k++)
        assert_ok(ritz_h5_read(file, "x", H5T_IEEE_F64LE, shape, values));
    assert_fails(ritz_h5_read(file, "x", H5T_IEEE_F64LE, shape, values),
                 RITZ_ERR_FORMAT, "of memory, in all more than a file of");
    H5Fclose(file);
    free(values);
}

/* A file that the guard refuses is not opened. A file that it admits is the one
   that is read, even if another file has taken its name meanwhile. */
static int64_t num_guarded;
static bool refusing;

static ritz_status guard_file(int file)
{
    char begins[8] = "";

    num_guarded++;
    assert_int_equal(pread(file, begins, sizeof begins, 0), sizeof begins);
    assert_memory_equal(begins, "\211HDF\r\n\032\n", sizeof begins);
    if (!refusing) /* another file takes its name */
        assert_int_equal(rename(again, path), 0);
    RITZ_REFUSE_IF(refusing, RITZ_ERR_FORMAT, "not by this guard");
    return RITZ_OK;
}

static void a_guard_sees_what_is_read(void **)
{
    ritz_summary summary = {0};

    ritz_container_guard(guard_file);
    for (int k = 0; k < 2; k++) {
        refusing = k > 0;
        assert_ok(sample_kinds[1].make(path, &stamp));
        assert_ok(sample_kinds[2].make(again, &stamp));
        num_guarded = 0;
        if (refusing) {
            assert_fails(ritz_container_summary(path, &summary),
                         RITZ_ERR_FORMAT, "not by this guard");
            assert_fails(ritz_container_keep(path), RITZ_ERR_FORMAT,
                         "not by this guard");
            continue;
        }
        assert_ok(ritz_container_keep(path));
        assert_ok(ritz_container_summary(path, &summary));
        assert_string_equal(summary.kind, sample_kinds[1].name);
        assert_int_equal(num_guarded, 1);
        ritz_container_release();
        ritz_summary_free(&summary);
        refusing = true; /* the path now names the other file */
        assert_fails(ritz_container_summary(path, &summary), RITZ_ERR_FORMAT,
                     "not by this guard");
    }
    ritz_container_guard(NULL);
    assert_ok(ritz_container_summary(path, &summary));
    assert_string_equal(summary.kind, sample_kinds[1].name);
    ritz_summary_free(&summary);
}

static void other_files_are_refused(void **)
{
    ritz_component none = {0};
    ritz_basis basis = {0};
    ritz_summary summary = {0};
    hid_t file = 0;

    assert_fails(ritz_container_read_component("nowhere", &none), RITZ_ERR_FILE,
                 "nowhere: No such file");
    assert_false(ritz_container_seems("nowhere"));
    assert_fails(ritz_container_read_component("/dev/null", &none),
                 RITZ_ERR_FILE, "/dev/null: not a regular file");
    assert_false(ritz_container_seems("/dev/null"));
    store((const unsigned char *)"text", 4);
    assert_false(ritz_container_seems(path));
    assert_fails(ritz_container_read_component(path, &none), RITZ_ERR_FORMAT,
                 "not an HDF5 file");
    file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    assert_true(ritz_container_seems(path)); /* by its first bytes */
    assert_fails(ritz_container_summary(path, &summary), RITZ_ERR_FORMAT,
                 "no container");
    assert_ok(sample_kinds[1].make(path, &stamp));
    assert_fails(ritz_container_read_component(path, &none), RITZ_ERR_FORMAT,
                 "test_container_damage.h5: holds a basis where a component "
                 "is due");
    assert_fails(ritz_container_write_basis("nowhere/b.h5", &basis, &stamp),
                 RITZ_ERR_FILE, "nowhere/b.h5: cannot create");
}

static void no_allocation_failure_leaks(void **)
{
    char input[] = "00  name";
    char *inputs[] = {input};
    const ritz_stamp full = {
        .command = "ritz-verb", .num_inputs = 1, .input = inputs};

    for (int k = 0; k < SAMPLE_KINDS; k++) {
        ritz_summary summary = {0};

        assert_survives_every_allocation(sample_kinds[k].make(path, &full));
        assert_survives_every_allocation(
            sample_kinds[k].copy(path, again, &full));
        assert_survives_every_allocation(
            ritz_container_summary(path, &summary));
        ritz_summary_free(&summary);
        assert_int_equal(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(links_to_elsewhere_are_not_followed),
    cmocka_unit_test(a_member_that_is_a_link_is_not_absent),
    cmocka_unit_test(damage_is_found_or_harmless),
    cmocka_unit_test(a_file_cut_short_is_refused),
    cmocka_unit_test(a_small_file_cut_at_any_byte_is_refused),
    cmocka_unit_test(what_does_not_fit_is_refused_with_its_sentence),
    cmocka_unit_test(texts_are_limited_in_memory),
    cmocka_unit_test(a_file_is_limited_in_memory),
    cmocka_unit_test(a_guard_sees_what_is_read),
    cmocka_unit_test(other_files_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(container_damage, tests, NULL, tear_down)
