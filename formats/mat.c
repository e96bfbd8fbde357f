/*
 * MAT files of MATLAB and Octave: Level 4, Level 5 and 7.3, which is HDF5. All
 * full and sparse matrices of numbers, those in structs as "sys.A"; whatever
 * else a file holds is kept by name, so that it can be said what it is.
 *
 * Every size is held against the bytes present before anything is allocated,
 * and inflated data against their checksum. [MathWorks2019]
 */
#include "formats/mat.h"

static const struct level {
    bool (*recognise)(const char *bytes, int64_t size);
    ritz_status (*read)(const char *bytes, int64_t size, ritz_mat_list *list);
    const char *spelling;
} levels[] = {
    {ritz_mat_is_hdf5, ritz_mat_read_hdf5, "MAT 7.3"},
    {ritz_mat_is_level5, ritz_mat_read_level5, "MAT level 5"},
    {ritz_mat_is_level4, ritz_mat_read_level4, "MAT level 4"},
};

enum { NUM_LEVELS = sizeof levels / sizeof *levels };

static const struct level *find_level(const char *bytes, int64_t size)
{
    for (int k = 0; k < NUM_LEVELS; k++)
        if (levels[k].recognise(bytes, size))
            return &levels[k];
    return NULL;
}

static bool is_mat(const char *bytes, int64_t size)
{
    return find_level(bytes, size) != NULL;
}

/* Values are read too: a matrix with NaN is listed as unusable. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    const struct level *level = find_level(file->bytes, file->size);
    ritz_mat_list list = {
        .listing = out, .bytes = file->size, .spelling = level->spelling};

    return level->read(file->bytes, file->size, &list);
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    const struct level *level = find_level(file->bytes, file->size);
    ritz_mat_list list = {
        .wanted = which->at, .bytes = file->size, .spelling = level->spelling};
    ritz_status status = level->read(file->bytes, file->size, &list);

    if (status == RITZ_OK)
        RITZ_MOVE(*out, list.matrix);
    ritz_matrix_free(&list.matrix);
    return status;
}

const ritz_format ritz_format_mat = {
    .name = "mat",
    .summary = "MAT files of MATLAB, levels 4, 5 and 7.3",
    .reference = "MathWorks2019",
    .recognise = is_mat,
    .list = list_file,
    .read = read_matrix,
};
