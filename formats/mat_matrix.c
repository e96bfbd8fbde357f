/* Matrices of MAT files, from values as any level holds them. */
#include "formats/mat.h"

#include "base/alloc.h"
#include "formats/matrix.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rows or columns that a file may declare beyond one for each byte. */
enum { NULL_ROWS = 32000000 };

int64_t ritz_mat_size(int type)
{
    static const int64_t sizes[] = {
        [RITZ_MAT_INT8] = 1,   [RITZ_MAT_UINT8] = 1,  [RITZ_MAT_INT16] = 2,
        [RITZ_MAT_UINT16] = 2, [RITZ_MAT_INT32] = 4,  [RITZ_MAT_UINT32] = 4,
        [RITZ_MAT_SINGLE] = 4, [RITZ_MAT_DOUBLE] = 8, [RITZ_MAT_INT64] = 8,
        [RITZ_MAT_UINT64] = 8,
    };

    return type >= 0 && type <= RITZ_MAT_UINT64 ? sizes[type] : 0;
}

uint64_t ritz_mat_bits(const unsigned char *at, int64_t size, bool swap)
{
    uint64_t bits = 0;

    for (int64_t k = 0; k < size; k++)
        bits |= (uint64_t)at[swap ? size - 1 - k : k] << (8 * k);
    return bits;
}

double ritz_mat_value(const ritz_mat_values *values, int64_t k)
{
    int64_t size = ritz_mat_size(values->type);
    uint64_t bits = ritz_mat_bits(values->at + k * size, size, values->swap);
    uint32_t low = (uint32_t)bits;
    double wide = 0.0;
    float narrow = 0.0F;

    switch (values->type) {
    case RITZ_MAT_INT8:
        return (double)(int8_t)bits;
    case RITZ_MAT_INT16:
        return (double)(int16_t)bits;
    case RITZ_MAT_INT32:
        return (double)(int32_t)bits;
    case RITZ_MAT_INT64:
        return (double)(int64_t)bits;
    case RITZ_MAT_SINGLE:
        memcpy(&narrow, &low, sizeof narrow);
        return (double)narrow;
    case RITZ_MAT_DOUBLE:
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    default:
        return (double)bits; /* unsigned */
    }
}

bool ritz_mat_pass(ritz_mat_list *list)
{
    bool passed = !list->listing && list->count != list->wanted;

    list->count += passed;
    return passed;
}

/* A matrix that was met: listed and let go, or kept. */
static ritz_status add_matrix(ritz_mat_list *list, const char *name,
                              ritz_matrix *matrix)
{
    ritz_listed item = {.nrow = matrix->A.nrow,
                        .ncol = matrix->A.ncol,
                        .is_complex = matrix->imaginary != NULL,
                        .at = list->count};

    list->count++;
    snprintf(item.name, sizeof item.name, "%s", name);
    memcpy(item.other, matrix->other, sizeof item.other);
    if (list->listing)
        return ritz_listing_add(list->listing, &item);
    memcpy(matrix->name, item.name, sizeof matrix->name);
    if (!*matrix->spelling)
        snprintf(matrix->spelling, sizeof matrix->spelling, "%s",
                 list->spelling);
    list->matrix = *matrix;
    *matrix = (ritz_matrix){0};
    return RITZ_OK;
}

ritz_status ritz_mat_add_other(ritz_mat_list *list, const char *name,
                               const char *why)
{
    RITZ_OWN(ritz_matrix) none = {0};

    if (ritz_mat_pass(list))
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_new(0, 0, 0, &none.A));
    snprintf(none.other, sizeof none.other, "%s", why);
    return add_matrix(list, name, &none);
}

/* True if all values are finite; if not, `why` says where. */
static bool is_finite(const ritz_triplets *t, char why[RITZ_NAME_SIZE])
{
    for (int64_t k = 0; k < t->count; k++)
        if (!isfinite(t->re[k]) || !isfinite(t->im[k])) {
            snprintf(why, RITZ_NAME_SIZE,
                     "not finite at (%" PRId64 ", %" PRId64 ")", t->row[k] + 1,
                     t->col[k] + 1);
            return false;
        }
    return true;
}

/* Triplets without zeros become a matrix of the list. */
static ritz_status compress_triplets(ritz_mat_list *list, const char *name,
                                     const ritz_mat_entries *e,
                                     const char *form, const ritz_triplets *t)
{
    char why[RITZ_NAME_SIZE];
    RITZ_OWN(ritz_matrix)
    matrix = {.digits = e->re.type == RITZ_MAT_SINGLE ? 7 : 17};

    if (!is_finite(t, why)) {
        RITZ_CHECK(ritz_mat_add_other(list, name, why));
        return RITZ_OK;
    }
    RITZ_CHECK(
        ritz_triplets_compress(t, e->nrow, e->ncol, e->im.at != NULL, &matrix));
    RITZ_REFUSE_IF(matrix.A.colptr[e->ncol] < t->count, RITZ_ERR_FORMAT,
                   "'%s' has an entry twice", name);
    snprintf(matrix.spelling, sizeof matrix.spelling, "%s, %s%s",
             list->spelling, form,
             e->re.type == RITZ_MAT_SINGLE ? ", single" : "");
    return add_matrix(list, name, &matrix);
}

static void put_entry(ritz_triplets *t, int64_t row, int64_t col, double re,
                      double im)
{
    if (re == 0.0 && im == 0.0)
        return;
    t->row[t->count] = row;
    t->col[t->count] = col;
    t->re[t->count] = re;
    t->im[t->count++] = im;
}

ritz_status ritz_mat_add_full(ritz_mat_list *list, const char *name,
                              int64_t nrow, int64_t ncol,
                              const ritz_mat_values *re,
                              const ritz_mat_values *im)
{
    const ritz_mat_entries entries = {
        .nrow = nrow, .ncol = ncol, .count = nrow * ncol, .re = *re, .im = *im};
    RITZ_OWN(ritz_triplets) t = {0};

    if (ritz_mat_pass(list))
        return RITZ_OK;
    RITZ_CHECK(ritz_triplets_new(entries.count, &t));
    for (int64_t k = 0; k < entries.count; k++)
        put_entry(&t, k % nrow, k / nrow, ritz_mat_value(re, k),
                  im->at ? ritz_mat_value(im, k) : 0.0);
    return compress_triplets(list, name, &entries, "full", &t);
}

/* Value k as an index from 0, or -1 if it is not one below `most`. */
static int64_t find_place(const ritz_mat_values *v, int64_t k, int64_t base,
                          int64_t most)
{
    double at = ritz_mat_value(v, k) - (double)base;

    return at >= 0.0 && at < (double)most && at == floor(at) ? (int64_t)at : -1;
}

/* Columns of all entries, from their starts. */
static ritz_status spread_starts(const char *name, const ritz_mat_entries *e,
                                 int64_t *col)
{
    int64_t from = find_place(&e->col, 0, 0, 1);

    for (int64_t j = 0; j < e->ncol; j++) {
        int64_t to = find_place(&e->col, j + 1, 0, e->count + 1);

        RITZ_REFUSE_IF(from < 0 || to < from, RITZ_ERR_FORMAT,
                       "'%s': the entries of column %" PRId64
                       " begin and end nowhere",
                       name, j + 1);
        while (from < to)
            col[from++] = j;
    }
    RITZ_REFUSE_IF(from != e->count, RITZ_ERR_FORMAT,
                   "'%s' has entries of no column", name);
    return RITZ_OK;
}

ritz_status ritz_mat_add_sparse(ritz_mat_list *list, const char *name,
                                const ritz_mat_entries *e)
{
    RITZ_OWN(ritz_triplets) t = {0};
    RITZ_OWN_ARRAY int64_t *col = NULL;

    if (ritz_mat_pass(list))
        return RITZ_OK;
    RITZ_REFUSE_IF(
        e->nrow - NULL_ROWS > list->bytes || e->ncol - NULL_ROWS > list->bytes,
        RITZ_ERR_FORMAT,
        "'%s', %" PRId64 " x %" PRId64 ", is far more than the file can fill",
        name, e->nrow, e->ncol);
    RITZ_CHECK(ritz_triplets_new(e->count, &t));
    RITZ_CHECK_NEW(col, e->count);
    if (e->starts)
        RITZ_CHECK(spread_starts(name, e, col));
    for (int64_t k = 0; k < e->count; k++) {
        int64_t i = find_place(&e->row, k, e->base, e->nrow);

        if (!e->starts)
            col[k] = find_place(&e->col, k, e->base, e->ncol);
        RITZ_REFUSE_IF(i < 0 || col[k] < 0, RITZ_ERR_FORMAT,
                       "'%s': entry %" PRId64 " lies outside %" PRId64
                       " x %" PRId64,
                       name, k + 1, e->nrow, e->ncol);
        put_entry(&t, i, col[k], ritz_mat_value(&e->re, k),
                  e->im.at ? ritz_mat_value(&e->im, k) : 0.0);
    }
    return compress_triplets(list, name, e, "sparse", &t);
}
