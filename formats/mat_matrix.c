/* Matrices of MAT files, from values as any level holds them. */
#include "formats/mat.h"

#include "base/alloc.h"
#include "formats/matrix.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
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

double ritz_mat_value(const ritz_mat_values *values, int64_t k)
{
    int64_t size = ritz_mat_size(values->type);
    const unsigned char *at = values->at + k * size;
    uint64_t bits = ritz_bytes_bits(at, size, values->swap);

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
        return ritz_bytes_single(at, values->swap);
    case RITZ_MAT_DOUBLE:
        return ritz_bytes_double(at, values->swap);
    default:
        return (double)bits; /* unsigned */
    }
}

bool ritz_mat_passes(const ritz_mat_list *list)
{
    return !list->listing && list->count != list->wanted;
}

/* A matrix that was met: listed and let go, or kept if it is the wanted one. */
static ritz_status add_matrix(ritz_mat_list *list, const char *name,
                              ritz_matrix *matrix)
{
    ritz_listed item = {.nrow = matrix->A.nrow,
                        .ncol = matrix->A.ncol,
                        .is_complex = matrix->imaginary != NULL,
                        .at = list->count++};

    snprintf(item.name, sizeof item.name, "%s", name);
    memcpy(item.other, matrix->other, sizeof item.other);
    if (list->listing)
        return ritz_listing_add(list->listing, &item);
    memcpy(matrix->name, item.name, sizeof matrix->name);
    RITZ_MOVE(list->matrix, *matrix);
    return RITZ_OK;
}

ritz_status ritz_mat_add_other(ritz_mat_list *list, const char *name,
                               const char *why)
{
    RITZ_OWN(ritz_matrix) none = {0};

    if (ritz_mat_passes(list)) {
        list->count++;
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_sparse_new(0, 0, 0, &none.A));
    snprintf(none.other, sizeof none.other, "%s", why);
    snprintf(none.spelling, sizeof none.spelling, "%s", list->spelling);
    return add_matrix(list, name, &none);
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

/* Rows and columns of all entries. */
static ritz_status find_places(const char *name, const ritz_mat_entries *e,
                               ritz_triplets *t)
{
    bool full = !e->col.at;

    if (e->starts)
        RITZ_CHECK(spread_starts(name, e, t->col));
    for (int64_t k = 0; k < e->count; k++) {
        t->row[k] =
            full ? k % e->nrow : find_place(&e->row, k, e->base, e->nrow);
        if (!e->starts)
            t->col[k] =
                full ? k / e->nrow : find_place(&e->col, k, e->base, e->ncol);
        RITZ_REFUSE_IF(t->row[k] < 0 || t->col[k] < 0, RITZ_ERR_FORMAT,
                       "'%s': entry %" PRId64 " lies outside %" PRId64
                       " x %" PRId64,
                       name, k + 1, e->nrow, e->ncol);
    }
    return RITZ_OK;
}

/* Values at these places, without zeros; `why` is set if one is not finite. */
static void put_values(const ritz_mat_entries *e, ritz_triplets *t,
                       char why[RITZ_NAME_SIZE])
{
    for (int64_t k = 0; k < e->count; k++) {
        double re = ritz_mat_value(&e->re, k);
        double im = e->im.at ? ritz_mat_value(&e->im, k) : 0.0;

        if (!*why && (!isfinite(re) || !isfinite(im)))
            snprintf(why, RITZ_NAME_SIZE,
                     "not finite at (%" PRId64 ", %" PRId64 ")", t->row[k] + 1,
                     t->col[k] + 1);
        ritz_triplets_put_value(t, t->row[k], t->col[k], re, im);
    }
}

ritz_status ritz_mat_fits(int64_t bytes, const char *name, int64_t count)
{
    /* bytes: row, column, value, and the value as read */
    enum { MEBI = 1 << 20, EACH = 32 };
    const int64_t by_file = bytes / MEBI * RITZ_MAT_MOST_RATIO;
    const int64_t most = by_file > 1024 ? by_file : 1024; /* MiB */

    RITZ_REFUSE_IF(count / (MEBI / EACH) > most, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " values, for which the file of %" PRId64
                   " bytes is given %" PRId64
                   " MiB of memory, not enough: if most are zero, write it as "
                   "a sparse matrix",
                   name, count, bytes, most);
    return RITZ_OK;
}

ritz_status ritz_mat_add(ritz_mat_list *list, const char *name,
                         const ritz_mat_entries *e)
{
    bool single = e->re.type == RITZ_MAT_SINGLE;
    char why[RITZ_NAME_SIZE] = "";
    RITZ_OWN(ritz_triplets) t = {.is_complex = e->im.at != NULL};
    RITZ_OWN(ritz_matrix) matrix = {.digits = single ? 7 : 17};
    int64_t kept = 0;

    if (e->nrow == 0 || e->ncol == 0 || ritz_mat_passes(list))
        return ritz_mat_add_other(list, name, "empty");
    RITZ_REFUSE_IF(e->col.at && (e->nrow - NULL_ROWS > list->bytes ||
                                 e->ncol - NULL_ROWS > list->bytes),
                   RITZ_ERR_FORMAT,
                   "'%s', %" PRId64 " x %" PRId64
                   ", is far more than the file can fill",
                   name, e->nrow, e->ncol);
    RITZ_CHECK(ritz_mat_fits(list->bytes, name, e->count));
    RITZ_CHECK(ritz_triplets_reserve(&t, e->count > 0 ? e->count : 1));
    RITZ_CHECK(find_places(name, e, &t));
    put_values(e, &t, why);
    if (*why)
        return ritz_mat_add_other(list, name, why);
    kept = t.count;
    RITZ_CHECK(ritz_triplets_compress(&t, e->nrow, e->ncol, &matrix));
    RITZ_REFUSE_IF(matrix.A.colptr[e->ncol] < kept, RITZ_ERR_FORMAT,
                   "'%s' has an entry twice", name);
    snprintf(matrix.spelling, sizeof matrix.spelling, "%s, %s%s",
             list->spelling, e->col.at ? "sparse" : "full",
             single ? ", single" : "");
    return add_matrix(list, name, &matrix);
}
