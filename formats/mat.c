/*
 * MAT files of MATLAB and Octave: Level 4, Level 5 and 7.3, which is HDF5. All
 * full and sparse matrices of numbers, those in structs as "sys.A"; whatever
 * else a file holds is kept by name, so that it can be said what it is.
 *
 * Every size is held against the bytes present before anything is allocated,
 * and inflated data against their checksum. [MathWorks2019]
 */
#include "formats/mat.h"

#include <inttypes.h>
#include <string.h>

/* ---- level 4 ------------------------------------------------------------ */

/*
 * One matrix after another, each with a head of five words,
 *
 *     1000 M + 10 P + T, rows, columns, imaginary part or not, length of name
 *
 * M byte order, P type of value, T full, text or sparse; then the name, and the
 * values by columns. A sparse one is stored as rows (i, j, value), the last one
 * its size.
 */

enum { WORDS = 5, HEAD = 4 * WORDS, FULL = 0, TEXT = 1, SPARSE = 2 };

typedef struct head {
    bool swap;
    int type, form; /* of values; FULL, TEXT or SPARSE */
    int64_t nrow, ncol, parts, name_size;
} head;

static bool take_head(const char *bytes, int64_t size, head *out)
{
    static const int types[] = {RITZ_MAT_DOUBLE, RITZ_MAT_SINGLE,
                                RITZ_MAT_INT32,  RITZ_MAT_INT16,
                                RITZ_MAT_UINT16, RITZ_MAT_UINT8};
    const unsigned char *at = (const unsigned char *)bytes;
    int64_t word[WORDS];
    bool swap = false;

    if (size < HEAD)
        return false;
    swap = ritz_bytes_bits(at, 4, false) > 52; /* M = 0: little endian */
    for (int64_t k = 0; k < WORDS; k++)
        word[k] = (int32_t)(uint32_t)ritz_bytes_bits(at + 4 * k, 4, swap);
    word[0] -= swap ? 1000 : 0;
    if (word[0] < 0 || word[0] > 52 || word[0] % 10 > SPARSE || word[1] < 0 ||
        word[2] < 0 || word[3] < 0 || word[3] > 1 || word[4] < 1 ||
        word[4] > RITZ_NAME_SIZE)
        return false;
    *out = (head){swap,
                  types[word[0] / 10],
                  (int)(word[0] % 10),
                  word[1],
                  word[2],
                  word[3] + 1,
                  word[4]};
    return true;
}

/* A name of letters, digits and '_', and its NUL. */
static bool take_name(const char *text, int64_t size, char out[RITZ_NAME_SIZE])
{
    if (text[size - 1] != '\0' || size < 2)
        return false;
    for (int64_t k = 0; k + 1 < size; k++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_"
                    "0123456789",
                    text[k]) ||
            !text[k])
            return false;
    memcpy(out, text, (size_t)size);
    return true;
}

static bool is_level4(const char *bytes, int64_t size)
{
    char name[RITZ_NAME_SIZE];
    head h;

    return take_head(bytes, size, &h) && size - HEAD >= h.name_size &&
           take_name(bytes + HEAD, h.name_size, name);
}

/* Columns of a full array: rows, columns, values, sometimes imaginary parts. */
static ritz_status add_sparse(ritz_mat_list *list, const char *name,
                              const head *h, const ritz_mat_values *all)
{
    int64_t n = h->nrow;
    ritz_mat_values column[4] = {0};
    double size[2];

    RITZ_REFUSE_IF(n < 1 || h->ncol < 3 || h->ncol > 4 || h->parts > 1,
                   RITZ_ERR_FORMAT, "'%s' is no sparse matrix", name);
    for (int64_t j = 0; j < h->ncol; j++)
        column[j] = (ritz_mat_values){all->at + j * n * ritz_mat_size(h->type),
                                      n, all->type, all->swap};
    for (int k = 0; k < 2; k++) {
        size[k] = ritz_mat_value(&column[k], n - 1);
        RITZ_REFUSE_IF(!(size[k] >= 0.0 && size[k] < 9e15), RITZ_ERR_FORMAT,
                       "'%s' has no size", name);
    }
    return ritz_mat_add(list, name,
                        &(ritz_mat_entries){.nrow = (int64_t)size[0],
                                            .ncol = (int64_t)size[1],
                                            .count = n - 1,
                                            .row = column[0],
                                            .col = column[1],
                                            .re = column[2],
                                            .im = column[3],
                                            .base = 1});
}

static ritz_status add_variable(ritz_mat_list *list, const char *name,
                                const head *h, const char *values)
{
    ritz_mat_entries e = {.nrow = h->nrow,
                          .ncol = h->ncol,
                          .count = h->nrow * h->ncol,
                          .re = {(const unsigned char *)values,
                                 h->nrow * h->ncol, h->type, h->swap}};

    if (h->form == TEXT)
        return ritz_mat_add_other(list, name, "text");
    if (h->form == SPARSE && e.count > 0)
        return add_sparse(list, name, h, &e.re);
    if (h->parts > 1) {
        e.im = e.re;
        e.im.at += e.count * ritz_mat_size(h->type);
    }
    return ritz_mat_add(list, name, &e);
}

static ritz_status read_level4(const char *bytes, int64_t size,
                               ritz_mat_list *list)
{
    char name[RITZ_NAME_SIZE];
    int64_t at = 0;
    head h;

    while (at < size) {
        int64_t left = size - at;
        int64_t values = 0;

        RITZ_REFUSE_IF(
            !take_head(bytes + at, left, &h) || left - HEAD < h.name_size ||
                !take_name(bytes + at + HEAD, h.name_size, name),
            RITZ_ERR_FORMAT, "byte %" PRId64 ": no matrix begins here", at);
        left -= HEAD + h.name_size;
        at += HEAD + h.name_size;
        values = left / (h.parts * ritz_mat_size(h.type));
        RITZ_REFUSE_IF(h.ncol > 0 && h.nrow > values / h.ncol, RITZ_ERR_FORMAT,
                       "'%s' is %" PRId64 " x %" PRId64 ", but %" PRId64
                       " bytes are left",
                       name, h.nrow, h.ncol, left);
        RITZ_CHECK(add_variable(list, name, &h, bytes + at));
        at += h.nrow * h.ncol * h.parts * ritz_mat_size(h.type);
    }
    return RITZ_OK;
}

/* ---- all levels --------------------------------------------------------- */

static const struct level {
    bool (*recognise)(const char *bytes, int64_t size);
    ritz_status (*read)(const char *bytes, int64_t size, ritz_mat_list *list);
    const char *spelling;
} levels[] = {
    {ritz_mat_is_hdf5, ritz_mat_read_hdf5, "MAT 7.3"},
    {ritz_mat_is_level5, ritz_mat_read_level5, "MAT level 5"},
    {is_level4, read_level4, "MAT level 4"},
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

static ritz_status admit_file(const char *bytes, int64_t size)
{
    return ritz_mat_is_hdf5(bytes, size) ? ritz_mat_admit_hdf5(bytes, size)
                                         : RITZ_OK;
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
    .admit = admit_file,
    .list = list_file,
    .read = read_matrix,
};
