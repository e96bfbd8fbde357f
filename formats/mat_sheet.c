#include "formats/mat_sheet.h"
#include "base/alloc.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>

void ritz_mat_sheet_free(ritz_mat_sheet *s)
{
    if (s->file)
        Mat_Close(s->file);
    for (int64_t k = 0; k < s->count; k++)
        Mat_VarFree(s->variable[k]);
    RITZ_FREE(s->variable);
    ritz_draft_free(&s->draft);
}

static ritz_status keep_variable(ritz_mat_sheet *s, matvar_t *variable)
{
    // NOLINTNEXTLINE(bugprone-sizeof-expression): an array of pointers
    RITZ_CHECK_ROOM(s->variable, s->count, s->room);
    s->variable[s->count++] = variable;
    return RITZ_OK;
}

/* Takes ownership of the variable. */
static ritz_status put_variable(ritz_mat_sheet *s, const char *name,
                                matvar_t *variable)
{
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(!variable, RITZ_ERR_MEMORY, "no memory for '%s'", name);
    status = keep_variable(s, variable);
    if (status != RITZ_OK)
        Mat_VarFree(variable);
    RITZ_CHECK(status);
    RITZ_REFUSE_IF(Mat_VarWrite(s->file, variable, MAT_COMPRESSION_NONE) != 0,
                   RITZ_ERR_FILE, "cannot write '%s'", name);
    return RITZ_OK;
}

ritz_status ritz_mat_put_real(ritz_mat_sheet *s, const char *name, int64_t nrow,
                              int64_t ncol, const double *values)
{
    size_t dims[2] = {(size_t)nrow, (size_t)ncol};
    RITZ_OWN_ARRAY double *copy = NULL; /* libmatio takes no const pointer */

    RITZ_CHECK_NEW(copy, nrow * ncol);
    memcpy(copy, values, (size_t)(nrow * ncol) * sizeof *copy);
    return put_variable(
        s, name,
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, copy, 0));
}

/* Convert the next letter of UTF-8 to one or two units of UTF-16.
   @return their number */
static int take_letter(const char **text, uint16_t out[2])
{
    const unsigned char *at = (const unsigned char *)*text;
    int length = ritz_letter_length(*text);
    uint32_t code = at[0];

    if (length > 1)
        code &= 0x3fU >> (length - 1);
    for (int k = 1; k < length; k++)
        code = code << 6 | (at[k] & 0x3f);
    *text += length > 0 ? length : 1;
    if (code < 0x10000) {
        out[0] = (uint16_t)code;
        return 1;
    }
    out[0] = (uint16_t)(0xd800 + ((code - 0x10000) >> 10));
    out[1] = (uint16_t)(0xdc00 + ((code - 0x10000) & 0x3ff));
    return 2;
}

/* Make a variable of text, which MATLAB stores as UTF-16. NULL: no memory. */
static matvar_t *text_variable(const char *name, const char *text)
{
    RITZ_OWN_ARRAY uint16_t *unit = NULL;
    size_t dims[2] = {1, 0};

    unit = ritz_alloc((int64_t)strlen(text) + 1, sizeof *unit);
    if (!unit)
        return NULL;
    while (*text) /* a letter has no more units than bytes */
        dims[1] += (size_t)take_letter(&text, unit + dims[1]);
    return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT16, 2, dims, unit, 0);
}

ritz_status ritz_mat_put_names(ritz_mat_sheet *s, const char *name,
                               int64_t count,
                               const char (*names)[RITZ_NAME_SIZE])
{
    size_t dims[2] = {(size_t)count, 1};
    matvar_t *cells = NULL;

    if (count == 0)
        return RITZ_OK;
    cells = Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, dims, NULL, 0);
    for (int64_t k = 0; cells && k < count; k++) {
        matvar_t *text = text_variable(NULL, names[k]);

        if (!text) {
            Mat_VarFree(cells);
            return ritz_fail(RITZ_ERR_MEMORY, "no memory for '%s'", name);
        }
        Mat_VarSetCell(cells, (int)k, text);
    }
    return put_variable(s, name, cells);
}

ritz_status ritz_mat_put_text(ritz_mat_sheet *s, const char *name,
                              const char *text)
{
    return *text ? put_variable(s, name, text_variable(name, text)) : RITZ_OK;
}

ritz_status ritz_mat_put_matrices(ritz_mat_sheet *s, const ritz_matrices *list)
{
    for (int64_t k = 0; k < list->count; k++) {
        const ritz_sparse *A = &list->matrix[k].A;

        RITZ_CHECK(ritz_mat_put_real(s, list->matrix[k].name, A->nrow, A->ncol,
                                     A->val));
    }
    return RITZ_OK;
}

ritz_status ritz_mat_sheet_open(const char *path, ritz_mat_sheet *out)
{
    char head[64];

    RITZ_CHECK(ritz_draft_new(path, &out->draft));
    snprintf(head, sizeof head, "MATLAB 5.0 MAT-file, written by ritz %s",
             ritz_version());
    out->file = Mat_CreateVer(out->draft.name, head, MAT_FT_MAT5);
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_FILE, "cannot write '%s'", path);
    return RITZ_OK;
}

/* Check that the file contains the matrices, to the bit. */
static ritz_status compare_file(const char *path, const ritz_matrices *list)
{
    RITZ_OWN(ritz_foreign) back = {0};

    RITZ_CHECK_IN("reading back", ritz_foreign_open(path, &back));
    RITZ_CHECK_IN("reading back",
                  ritz_foreign_context(&back, ritz_foreign_list(&back)));
    RITZ_REFUSE_IF(back.listing.count < list->count, RITZ_ERR_FILE,
                   "only part of '%s' could be written", path);
    for (int64_t k = 0; k < list->count; k++) {
        RITZ_OWN(ritz_matrix) read = {0};
        const ritz_sparse *A = &list->matrix[k].A;
        RITZ_OWN(ritz_dense) B = {0};
        bool same = true;

        RITZ_CHECK_IN("reading back", ritz_foreign_take(&back, k, &read));
        RITZ_CHECK(ritz_sparse_dense(&read.A, &B));
        same = A->nrow == B.nrow && A->ncol == B.ncol;
        for (int64_t i = 0; same && i < B.nrow * B.ncol; i++)
            same = A->val[i] == B.val[i];
        RITZ_REFUSE_IF(!same, RITZ_ERR_FILE, "'%s' was not written as it is",
                       list->matrix[k].name);
    }
    return RITZ_OK;
}

static bool is_same_array(const matvar_t *a, const matvar_t *b)
{
    return a && b && a->class_type == b->class_type && a->rank == 2 &&
           b->rank == 2 && a->dims[0] == b->dims[0] &&
           a->dims[1] == b->dims[1] && a->nbytes == b->nbytes &&
           (a->nbytes == 0 || a->class_type == MAT_C_CELL ||
            (a->data && b->data && memcmp(a->data, b->data, a->nbytes) == 0));
}

/* Compare two arrays, or two columns of cells that are arrays. */
static bool is_same(const matvar_t *a, const matvar_t *b)
{
    bool same = is_same_array(a, b) && strcmp(a->name, b->name) == 0;

    for (size_t k = 0;
         same && a->class_type == MAT_C_CELL && k < a->dims[0] * a->dims[1];
         k++)
        same = is_same_array(((matvar_t *const *)a->data)[k],
                             ((matvar_t *const *)b->data)[k]);
    return same;
}

/* Check that the file contains all variables that were written. */
static ritz_status compare_variables(const ritz_mat_sheet *s)
{
    mat_t *file = Mat_Open(s->draft.name, MAT_ACC_RDONLY);
    bool whole = file != NULL;

    for (int64_t k = 0; whole && k < s->count; k++) {
        matvar_t *read = Mat_VarReadNext(file);

        whole = is_same(s->variable[k], read);
        Mat_VarFree(read);
    }
    if (file)
        Mat_Close(file);
    RITZ_REFUSE_IF(!whole, RITZ_ERR_FILE,
                   "cannot be written to its end, is the disk full?");
    return RITZ_OK;
}

ritz_status ritz_mat_sheet_publish(ritz_mat_sheet *s, const ritz_matrices *list)
{
    int failed = Mat_Close(s->file);

    s->file = NULL;
    RITZ_REFUSE_IF(failed != 0, RITZ_ERR_FILE, "cannot write all of it");
    if (list)
        RITZ_CHECK(compare_file(s->draft.name, list));
    RITZ_CHECK(compare_variables(s));
    return ritz_draft_publish(&s->draft);
}
