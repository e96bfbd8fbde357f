/*
 * HDF5 files of any content. Damaged bytes would find faults of HDF5, not of
 * Ritz. Therefore HDF5 itself writes the files here: a sound file, edited as
 * the input says. An input is a list of commands,
 *
 *     number of an object, number of an edit, bytes that the edit takes,
 *
 * followed by zeros.
 */
#include "fuzz.h"

#include "base/alloc.h"
#include "samples.h"

#include <ritz/import.h>

#include <hdf5.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_EDITS = 12,
    MOST_OBJECTS = 256,
    MOST_BYTES = 4096, /* bytes of values in a data set */
    PATH_SIZE = 256,
    MOST_RANK = 4,
    USER_BLOCK = 512, /* bytes before HDF5 in a MAT 7.3 file */
};

/* --- the commands --------------------------------------------------------- */

typedef struct fuzz_tape {
    const char *at, *end;
} fuzz_tape;

static unsigned take_byte(fuzz_tape *tape)
{
    return tape->at < tape->end ? (unsigned char)*tape->at++ : 0U;
}

/* Eight bytes: one of some special values, or the next eight of the tape. */
static void take_word(fuzz_tape *tape, char out[8])
{
    static const double reals[] = {0.0,   -0.0,   1.0,      -1.0,     0.5,
                                   1e300, 1e-300, HUGE_VAL, -HUGE_VAL};
    static const int64_t wholes[] = {
        0, 1, 2, 3, 6, 7, -1, INT64_MAX, INT64_MIN, INT32_MAX, 1000000};
    enum {
        REALS = sizeof reals / sizeof *reals,
        WHOLES = sizeof wholes / sizeof *wholes
    };
    const unsigned which = take_byte(tape);

    if (which < REALS)
        memcpy(out, &reals[which], 8);
    else if (which < REALS + WHOLES)
        memcpy(out, &wholes[which - REALS], 8);
    else
        for (int k = 0; k < 8; k++)
            out[k] = (char)take_byte(tape);
}

/* --- objects of a file ---------------------------------------------------- */

typedef struct fuzz_objects {
    int count;
    char path[MOST_OBJECTS][PATH_SIZE];
} fuzz_objects;

static herr_t add_object(hid_t, const char *name, const H5O_info_t *,
                         void *data)
{
    fuzz_objects *all = data;

    if (all->count < MOST_OBJECTS && strlen(name) < PATH_SIZE)
        (void)snprintf(all->path[all->count++], PATH_SIZE, "%s", name);
    return 0;
}

static const char *take_object(fuzz_tape *tape, const fuzz_objects *all)
{
    return all->path[take_byte(tape) % (unsigned)all->count];
}

/* --- edits ---------------------------------------------------------------- */

static hid_t take_type(fuzz_tape *tape)
{
    static const size_t sizes[] = {1, 3, 48, 300, H5T_VARIABLE};
    const hid_t known[] = {
        H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_I32LE,      H5T_IEEE_F32BE,
        H5T_STD_U8LE,   H5T_STD_U64BE, H5T_NATIVE_LDOUBLE, H5T_STD_B16LE,
    };
    enum { KNOWN = sizeof known / sizeof *known };
    const unsigned which = take_byte(tape);
    hid_t type = H5Tcopy(which < KNOWN ? known[which] : H5T_C_S1);

    if (which >= KNOWN)
        H5Tset_size(type, sizes[which % 5]);
    return type;
}

static hid_t take_space(fuzz_tape *tape, hsize_t *volume)
{
    static const hsize_t sizes[] = {1,
                                    0,
                                    2,
                                    3,
                                    6,
                                    9,
                                    40,
                                    41,
                                    81,
                                    118,
                                    1024,
                                    65537,
                                    (hsize_t)1 << 31,
                                    (hsize_t)1 << 40,
                                    (hsize_t)1 << 61};
    const unsigned rank = take_byte(tape) % (MOST_RANK + 2);
    hsize_t dims[MOST_RANK] = {0};

    *volume = rank > MOST_RANK ? 0 : 1;
    if (rank > MOST_RANK)
        return H5Screate(H5S_NULL);
    for (unsigned k = 0; k < rank; k++) {
        const hsize_t size =
            sizes[take_byte(tape) % (sizeof sizes / sizeof *sizes)];

        dims[k] = size;
        *volume = *volume > MOST_BYTES ? *volume : *volume * size;
    }
    return rank == 0 ? H5Screate(H5S_SCALAR)
                     : H5Screate_simple((int)rank, dims, NULL);
}

static void fill_values(fuzz_tape *tape, char values[MOST_BYTES])
{
    memset(values, 0, MOST_BYTES);
    for (int k = (int)(take_byte(tape) % 16), at = 0; k > 0; k--, at += 8)
        take_word(tape, values + at);
}

/* Whether `volume` values of a type can be written from bytes of the input. */
static bool is_small(hid_t type, hsize_t volume)
{
    return volume > 0 && !H5Tis_variable_str(type) &&
           H5Tget_size(type) <= MOST_BYTES &&
           volume <= MOST_BYTES / H5Tget_size(type);
}

/* Replace a member by a data set from the tape. */
static void replace_member(fuzz_tape *tape, hid_t file, const char *path)
{
    char values[MOST_BYTES];
    hsize_t volume = 0;
    const hid_t type = take_type(tape);
    const hid_t space = take_space(tape, &volume);
    hid_t set = -1;

    H5Ldelete(file, path, H5P_DEFAULT);
    set = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT,
                     H5P_DEFAULT);
    fill_values(tape, values);
    if (set >= 0 && is_small(type, volume))
        H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
}

/* Overwrite some values of a data set, and delete its checksum. */
static void patch_values(fuzz_tape *tape, hid_t file, const char *path)
{
    char values[2 * MOST_BYTES];
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    const hid_t type = set < 0 ? -1 : H5Dget_type(set);
    const hid_t space = set < 0 ? -1 : H5Dget_space(set);
    const hssize_t volume = set < 0 ? 0 : H5Sget_simple_extent_npoints(space);

    if (volume > 0 && is_small(type, (hsize_t)volume) &&
        H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) {
        const unsigned words =
            (unsigned)((size_t)volume * H5Tget_size(type) / 8);

        for (unsigned k = take_byte(tape) % 4 + 1; k > 0 && words > 0; k--) {
            unsigned at = take_byte(tape);

            at = (at + 256U * take_byte(tape)) % words;
            take_word(tape, values + (size_t)8 * at);
        }
        H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
        H5Adelete(set, "checksum");
    }
    if (set >= 0) {
        H5Sclose(space);
        H5Tclose(type);
        H5Dclose(set);
    }
}

/* Delete an attribute of an object and, in most cases, write another one. */
static void replace_attribute(fuzz_tape *tape, hid_t file, const char *path)
{
    char values[MOST_BYTES];
    char name[PATH_SIZE] = "";
    hsize_t volume = 0;
    const hid_t object = H5Oopen(file, path, H5P_DEFAULT);
    const int count = object < 0 ? 0 : H5Aget_num_attrs(object);
    const unsigned which = take_byte(tape);
    hid_t type = -1, space = -1, made = -1;

    if (count > 0)
        H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                           which % (unsigned)count, name, sizeof name,
                           H5P_DEFAULT);
    if (*name && H5Adelete(object, name) >= 0 && take_byte(tape) % 4 > 0) {
        type = take_type(tape);
        space = take_space(tape, &volume);
        fill_values(tape, values);
        if (is_small(type, volume))
            made =
                H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        if (made >= 0) {
            H5Awrite(made, type, values);
            H5Aclose(made);
        }
        H5Sclose(space);
        H5Tclose(type);
    }
    if (object >= 0)
        H5Oclose(object);
}

static void edit_file(fuzz_tape *tape, const fuzz_objects *all, hid_t file)
{
    const char *path = take_object(tape, all);
    const char *other = NULL;

    switch (take_byte(tape) % 7) {
    case 0:
        patch_values(tape, file, path);
        break;
    case 1:
        replace_attribute(tape, file, path);
        break;
    case 2:
        replace_member(tape, file, path);
        break;
    case 3:
        H5Ldelete(file, path, H5P_DEFAULT);
        break;
    case 4: /* replace it by another member */
        other = take_object(tape, all);
        H5Ldelete(file, path, H5P_DEFAULT);
        H5Lcreate_hard(file, other, file, path, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case 5:
        other = take_object(tape, all);
        H5Ldelete(file, path, H5P_DEFAULT);
        H5Lcreate_soft(other, file, path, H5P_DEFAULT, H5P_DEFAULT);
        break;
    default:
        H5Ldelete(file, path, H5P_DEFAULT);
        H5Gclose(H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
}

/* --- sound files ---------------------------------------------------------- */

/* A file that HDF5 wrote once, kept because writing takes longer than
   reading. */
typedef struct fuzz_image {
    int64_t size;
    char *bytes; /* NULL: not written yet */
    fuzz_objects objects;
} fuzz_image;

/*
 * HDF5 allocates blocks of half a megabyte and more for each file and each
 * conversion, and frees them at once; mapping and clearing them took most of
 * the time. Without limits its free lists keep these blocks.
 */
static bool keep_image(const char *path, fuzz_image *image)
{
    hid_t file = -1;

    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
    file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
        return false;
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_object, &image->objects);
    H5Fclose(file);
    return image->objects.count > 0 &&
           ritz_bytes_read(path, &image->size, &image->bytes) == RITZ_OK;
}

/* Write the file, edited as the tape says. */
static void put_edited(fuzz_tape *tape, const fuzz_image *image,
                       const char *path)
{
    hid_t file = -1;

    fuzz_store(path, image->bytes, image->size);
    if (tape->at == tape->end)
        return;
    file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    for (int k = 0; file >= 0 && k < MOST_EDITS && tape->at < tape->end; k++)
        edit_file(tape, &image->objects, file);
    if (file >= 0)
        H5Fclose(file);
}

/* Abort if a reader has left an object of HDF5 open. */
static void judge_ids(void)
{
    if (H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) == 0)
        return;
    fprintf(stderr, "an object of HDF5 is left open\n");
    abort();
}

/* --- containers ----------------------------------------------------------- */

/* The first letter is the kind of container: 'a' to 'h' with all optional
   members, 'A' to 'H' without. A container that can be read must be
   writable. */
void fuzz_container(const char *bytes, int64_t size)
{
    static const char path[] = "container.h5", again[] = "again.h5";
    static fuzz_image images[2][SAMPLE_KINDS];
    const ritz_stamp stamp = {.command = "ritz-verb"};
    const int which = (*bytes & 31) % SAMPLE_KINDS;
    const sample_kind *kind = &sample_kinds[which];
    const bool full = *bytes & 32;
    fuzz_image *image = &images[full][which];
    fuzz_tape tape = {bytes + (size > 0), bytes + size};
    RITZ_OWN(ritz_summary) summary = {0};

    if (!image->bytes &&
        ((full ? kind->make : kind->make_bare)(path, &stamp) != RITZ_OK ||
         !keep_image(path, image)))
        return;
    put_edited(&tape, image, path);
    fuzz_judge(ritz_container_summary(path, &summary));
    judge_ids();
    fuzz_judge(kind->copy(path, again, &stamp));
    judge_ids();
}

/* --- MAT 7.3 -------------------------------------------------------------- */

static void put_class(hid_t object, const char *name)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    const hid_t space = H5Screate(H5S_SCALAR);
    hid_t made = -1;

    H5Tset_size(type, strlen(name));
    made = H5Acreate2(object, "MATLAB_class", type, space, H5P_DEFAULT,
                      H5P_DEFAULT);
    H5Awrite(made, type, name);
    H5Aclose(made);
    H5Sclose(space);
    H5Tclose(type);
}

static void put_set(hid_t at, const char *name, hid_t type,
                    const hsize_t dims[2], const void *values)
{
    const hid_t space = H5Screate_simple(dims[1] > 0 ? 2 : 1, dims, NULL);
    const hid_t set = H5Dcreate2(at, name, type, space, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT);

    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    put_class(set, "double");
    H5Dclose(set);
    H5Sclose(space);
}

/* A sparse matrix of 3 x 3 with 4 entries. */
static void put_sparse(hid_t at, const char *name)
{
    const double data[] = {1.0, 2.0, 3.0, -1.0};
    const uint64_t ir[] = {0, 1, 2, 1}, jc[] = {0, 1, 2, 4}, nrow = 3;
    const hid_t group =
        H5Gcreate2(at, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t rows = H5Acreate2(group, "MATLAB_sparse", H5T_NATIVE_UINT64,
                                  space, H5P_DEFAULT, H5P_DEFAULT);

    H5Awrite(rows, H5T_NATIVE_UINT64, &nrow);
    H5Aclose(rows);
    H5Sclose(space);
    put_class(group, "double");
    put_set(group, "data", H5T_IEEE_F64LE, (const hsize_t[2]){4, 0}, data);
    put_set(group, "ir", H5T_STD_U64LE, (const hsize_t[2]){4, 0}, ir);
    put_set(group, "jc", H5T_STD_U64LE, (const hsize_t[2]){4, 0}, jc);
    H5Gclose(group);
}

/* A file with a full, a sparse and a complex matrix, and a struct of the first
   two. */
static void make_mat(const char *path)
{
    const double full[] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    const hsize_t dims[2] = {2, 3};
    const hid_t plan = H5Pcreate(H5P_FILE_CREATE);
    const hid_t pair = H5Tcreate(H5T_COMPOUND, 2 * sizeof *full);
    hid_t file = -1, group = -1;

    H5Pset_userblock(plan, USER_BLOCK);
    file = H5Fcreate(path, H5F_ACC_TRUNC, plan, H5P_DEFAULT);
    H5Tinsert(pair, "real", 0, H5T_IEEE_F64LE);
    H5Tinsert(pair, "imag", sizeof *full, H5T_IEEE_F64LE);
    group = H5Gcreate2(file, "sys", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    put_class(group, "struct");
    put_set(file, "A", H5T_IEEE_F64LE, dims, full);
    put_set(file, "Z", pair, (const hsize_t[2]){1, 3}, full);
    put_sparse(file, "S");
    put_set(group, "A", H5T_IEEE_F64LE, dims, full);
    put_sparse(group, "S");
    H5Gclose(group);
    H5Tclose(pair);
    H5Fclose(file);
    H5Pclose(plan);
}

/* List the file's matrices, then read one of them in a second pass. */
static void read_mat(const char *path, unsigned which)
{
    ritz_foreign file = {0};
    ritz_status status = ritz_foreign_open(path, &file);

    if (status == RITZ_OK)
        status = ritz_foreign_list(&file);
    fuzz_judge(status);
    if (status == RITZ_OK && file.listing.count > 0) {
        RITZ_OWN(ritz_matrix) matrix = {0};

        fuzz_judge(
            ritz_foreign_take(&file, which % file.listing.count, &matrix));
    }
    ritz_foreign_free(&file);
}

/* The first byte selects the matrix to read. */
void fuzz_mat_hdf5(const char *bytes, int64_t size)
{
    static const char path[] = "v73.mat";
    static const char head[] = "MATLAB 7.3 MAT-file";
    static fuzz_image image;
    fuzz_tape tape = {bytes, bytes + size};
    const unsigned which = take_byte(&tape);

    if (!image.bytes) {
        make_mat(path);
        if (!keep_image(path, &image))
            return;
        memcpy(image.bytes, head, sizeof head - 1);
    }
    put_edited(&tape, &image, path);
    read_mat(path, which);
    judge_ids();
}
