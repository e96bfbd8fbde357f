#include "container/slab.h"

#include "base/alloc.h"
#include "container/schema.h"

#include <inttypes.h>
#include <string.h>

/* Data sets of a sparse matrix, in the order of their checksums. */
enum { DATA, INDICES, INDPTR };

static const char *const sets[RITZ_SLAB_SETS] = {"data", "indices", "indptr"};

/* --- all but the matrices ------------------------------------------------- */

static bool is_matrix(const ritz_member *row)
{
    return row->kind == MATRIX_SPARSE || strcmp(row->name, "KG") == 0;
}

static ritz_status settle_frame(const ritz_place *place)
{
    return ritz_component_settle_frame(place->target);
}

/* Read by the schema of a component without the rows of its matrices. */
ritz_status ritz_slab_frame(const char *path, ritz_component *out)
{
    enum { MOST = 64 };
    ritz_member kept[MOST] = {0};
    ritz_schema frame = ritz_schema_component;
    RITZ_OWN(ritz_component) component = {0};
    int count = 0;

    for (const ritz_member *row = frame.members; row->name && count < MOST - 1;
         row++)
        if (!is_matrix(row))
            kept[count++] = *row;
    frame.members = kept;
    frame.settle = settle_frame;
    RITZ_CHECK_IN(path, ritz_schema_read(path, &frame, &component));
    RITZ_MOVE(*out, component);
    return RITZ_OK;
}

/* --- columns of a matrix -------------------------------------------------- */

void ritz_slab_free(ritz_slab *slab)
{
    ritz_sparse_free(&slab->A);
    *slab = (ritz_slab){0};
}

ritz_status ritz_slab_has(const char *path, const char *name, bool *out)
{
    RITZ_OWN(hid_t) file = 0;
    char kind[RITZ_NAME_SIZE] = "";

    RITZ_CHECK_IN(path, ritz_schema_open(path, kind, &file));
    *out = ritz_h5_has(file, name);
    return ritz_context(ritz_h5_seen(), path);
}

static ritz_status list_loads(hid_t file, int64_t *count,
                              char (**name)[RITZ_NAME_SIZE])
{
    RITZ_OWN(hid_t) group = 0;

    if (!ritz_h5_has(file, "KG"))
        return ritz_h5_seen();
    RITZ_CHECK(ritz_h5_enter(file, "KG", &group));
    return ritz_context(ritz_h5_list(group, count, name), "KG");
}

ritz_status ritz_slab_loads(const char *path, int64_t *count,
                            char (**name)[RITZ_NAME_SIZE])
{
    RITZ_OWN(hid_t) file = 0;
    char kind[RITZ_NAME_SIZE] = "";

    RITZ_CHECK_IN(path, ritz_schema_open(path, kind, &file));
    return ritz_context(list_loads(file, count, name), path);
}

/* Read values [first, first + count) of a data set of one dimension. */
static ritz_status read_part(hid_t group, const char *name, hid_t type,
                             int64_t first, int64_t count, void *values)
{
    const hsize_t start = (hsize_t)first;
    const hsize_t length = (hsize_t)count;
    RITZ_OWN(hid_t) set = H5Dopen2(group, name, H5P_DEFAULT);
    RITZ_OWN(hid_t) on_file = H5Dget_type(set);
    RITZ_OWN(hid_t) space = H5Dget_space(set);
    RITZ_OWN(hid_t) part = H5Screate_simple(1, &length, NULL);
    RITZ_OWN(hid_t) memory = 0;

    RITZ_CHECK(ritz_h5_match(name, on_file, type, &memory));
    RITZ_CHECK(ritz_h5_take(set, name, length * sizeof(double), true));
    if (count == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL,
                                       &length, NULL) < 0 ||
                       H5Dread(set, memory, part, space, H5P_DEFAULT, values) <
                           0,
                   RITZ_ERR_FORMAT, "'%s' is damaged", name);
    return RITZ_OK;
}

/* Refuse a matrix whose data sets disagree in size; find how many entries it
   has. */
static ritz_status measure_matrix(hid_t group, int64_t n, int64_t *entries)
{
    char format[RITZ_NAME_SIZE] = "";
    ritz_h5_shape shape[RITZ_SLAB_SETS] = {0};

    RITZ_CHECK(ritz_h5_get_text(group, "format", sizeof format, format));
    RITZ_REFUSE_IF(strcmp(format, "csc") != 0, RITZ_ERR_FORMAT,
                   "is not in compressed columns");
    for (int k = 0; k < RITZ_SLAB_SETS; k++)
        RITZ_CHECK(ritz_h5_shape_of(group, sets[k], 1, &shape[k]));
    RITZ_REFUSE_IF(shape[INDPTR].dims[0] != (hsize_t)n + 1, RITZ_ERR_FORMAT,
                   "%" PRId64 " columns where %" PRId64 " are due",
                   (int64_t)shape[INDPTR].dims[0] - 1, n);
    RITZ_REFUSE_IF(shape[DATA].dims[0] != shape[INDICES].dims[0],
                   RITZ_ERR_FORMAT, "'data' and 'indices' differ in length");
    *entries = (int64_t)shape[DATA].dims[0];
    return RITZ_OK;
}

/* Read column pointers; refuse any that descend or leave the entries. */
static ritz_status read_pointers(hid_t group, int64_t from, int64_t columns,
                                 int64_t entries, int64_t *colptr)
{
    RITZ_CHECK(read_part(group, sets[INDPTR], H5T_STD_I64LE, from, columns + 1,
                         colptr));
    RITZ_REFUSE_IF((from == 0 && colptr[0] != 0) || colptr[0] < 0 ||
                       colptr[columns] > entries,
                   RITZ_ERR_FORMAT, "column pointers and entries disagree");
    for (int64_t j = 0; j < columns; j++)
        RITZ_REFUSE_IF(colptr[j] > colptr[j + 1], RITZ_ERR_FORMAT,
                       "column pointers descend at column %" PRId64, from + j);
    return RITZ_OK;
}

static ritz_status read_columns(hid_t group, int64_t n, int64_t columns,
                                ritz_slab *slab)
{
    RITZ_OWN_ARRAY int64_t *colptr = NULL;
    int64_t count = 0;

    RITZ_CHECK(measure_matrix(group, n, &slab->entries));
    RITZ_CHECK_NEW(colptr, columns + 1);
    RITZ_CHECK(
        read_pointers(group, slab->from, columns, slab->entries, colptr));
    RITZ_REFUSE_IF(slab->from + columns == n &&
                       colptr[columns] != slab->entries,
                   RITZ_ERR_FORMAT, "column pointers and entries disagree");
    slab->before = colptr[0];
    count = colptr[columns] - colptr[0];
    RITZ_CHECK(ritz_sparse_new(n, columns, count, &slab->A));
    for (int64_t j = 0; j <= columns; j++)
        slab->A.colptr[j] = colptr[j] - slab->before;
    RITZ_CHECK(read_part(group, sets[DATA], H5T_IEEE_F64LE, slab->before, count,
                         slab->A.val));
    RITZ_CHECK(read_part(group, sets[INDICES], H5T_STD_I64LE, slab->before,
                         count, slab->A.rowind));
    return ritz_sparse_check(&slab->A, count);
}

ritz_status ritz_slab_read(const char *path, const char *name, int64_t n,
                           int64_t from, int64_t to, ritz_slab *out)
{
    RITZ_OWN(ritz_slab) slab = {.from = from};
    RITZ_OWN(hid_t) file = 0, group = 0;
    char kind[RITZ_NAME_SIZE] = "";

    RITZ_CHECK_IN(path, ritz_schema_open(path, kind, &file));
    RITZ_CHECK_IN(path, ritz_context(ritz_h5_enter(file, name, &group), name));
    RITZ_CHECK_IN(path,
                  ritz_context(read_columns(group, n, to - from, &slab), name));
    RITZ_MOVE(*out, slab);
    return RITZ_OK;
}

/* --- checksums ------------------------------------------------------------ */

static uint64_t sum_pointers(const ritz_slab *slab, uint64_t sum)
{
    const bool last = slab->from + slab->A.ncol == slab->A.nrow;
    const int64_t count = slab->A.ncol + (last ? 1 : 0);

    for (int64_t j = 0; j < count; j++) {
        const int64_t pointer = slab->before + slab->A.colptr[j];

        sum = ritz_h5_sum(sizeof pointer, &pointer, sum);
    }
    return sum;
}

void ritz_slab_begin(uint64_t sum[RITZ_SLAB_SETS])
{
    for (int k = 0; k < RITZ_SLAB_SETS; k++)
        sum[k] = RITZ_H5_SUM;
}

void ritz_slab_sum(const ritz_slab *slab, uint64_t sum[RITZ_SLAB_SETS])
{
    const int64_t bytes =
        slab->A.colptr[slab->A.ncol] * (int64_t)sizeof *slab->A.val;

    sum[DATA] = ritz_h5_sum(bytes, slab->A.val, sum[DATA]);
    sum[INDICES] = ritz_h5_sum(bytes, slab->A.rowind, sum[INDICES]);
    sum[INDPTR] = sum_pointers(slab, sum[INDPTR]);
}

static ritz_status verify_set(hid_t group, const char *name, uint64_t sum)
{
    RITZ_OWN(hid_t) set = H5Dopen2(group, name, H5P_DEFAULT);
    int64_t checksum = 0;

    if (!ritz_h5_has_attribute(set, "checksum"))
        return RITZ_OK;
    RITZ_CHECK_IN(name,
                  ritz_h5_get(set, "checksum", H5T_STD_I64LE, 1, &checksum));
    RITZ_REFUSE_IF(checksum != ritz_h5_sum_end(sum), RITZ_ERR_FORMAT,
                   "'%s' is damaged: its checksum does not fit", name);
    return RITZ_OK;
}

ritz_status ritz_slab_verify(const char *path, const char *name,
                             const uint64_t sum[RITZ_SLAB_SETS])
{
    RITZ_OWN(hid_t) file = 0, group = 0;
    char kind[RITZ_NAME_SIZE] = "";

    RITZ_CHECK_IN(path, ritz_schema_open(path, kind, &file));
    RITZ_CHECK_IN(path, ritz_context(ritz_h5_enter(file, name, &group), name));
    for (int k = 0; k < RITZ_SLAB_SETS; k++)
        RITZ_CHECK_IN(path,
                      ritz_context(verify_set(group, sets[k], sum[k]), name));
    return RITZ_OK;
}
