/*
 * A reduced component or state space as a MAT file of level 5 for MATLAB,
 * Octave and SciPy: matrices, names of inputs and outputs as cells of text,
 * limits, and the kinds of columns. Absent matrices are left out.
 *
 * The head contains no time, so that the same run writes the same bytes. The
 * file is read back and compared, matrices by Ritz's own reader, because
 * libmatio does not report a full disk. [MathWorks2019]
 */
#include "base/alloc.h"
#include "base/text.h"
#include "formats/sink.h"

#include <math.h>
#include <matio.h>
#include <string.h>

/* The file, and the variables written to it. */
typedef struct sheet {
    ritz_draft draft;
    mat_t *file;
    int64_t count, room;
    matvar_t **variable;
} sheet;

static void sheet_free(sheet *s)
{
    if (s->file)
        Mat_Close(s->file);
    for (int64_t k = 0; k < s->count; k++)
        Mat_VarFree(s->variable[k]);
    RITZ_FREE(s->variable);
    ritz_draft_free(&s->draft);
}

static ritz_status keep_variable(sheet *s, matvar_t *variable)
{
    // NOLINTNEXTLINE(bugprone-sizeof-expression): an array of pointers
    RITZ_CHECK_ROOM(s->variable, s->count, s->room);
    s->variable[s->count++] = variable;
    return RITZ_OK;
}

/* Takes ownership of the variable. */
static ritz_status put_variable(sheet *s, const char *name, matvar_t *variable)
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

static ritz_status put_real(sheet *s, const char *name, int64_t nrow,
                            int64_t ncol, const double *values)
{
    size_t dims[2] = {(size_t)nrow, (size_t)ncol};
    RITZ_OWN_ARRAY double *copy = NULL; /* which libmatio may write to */

    RITZ_CHECK_NEW(copy, nrow * ncol);
    memcpy(copy, values, (size_t)(nrow * ncol) * sizeof *copy);
    return put_variable(
        s, name,
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, copy, 0));
}

/* The next letter of UTF-8 as one or two units of UTF-16. */
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

/* Text as MATLAB holds it; NULL: no memory. */
static matvar_t *text_variable(const char *name, const char *text)
{
    uint16_t unit[RITZ_NAME_SIZE * 2] = {0};
    size_t dims[2] = {1, 0};

    while (*text && dims[1] < RITZ_NAME_SIZE)
        dims[1] += (size_t)take_letter(&text, unit + dims[1]);
    return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT16, 2, dims, unit, 0);
}

/* Names as a column of cells. */
static ritz_status put_names(sheet *s, const char *name, int64_t count,
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

static ritz_status put_text(sheet *s, const char *name, const char *text)
{
    return *text ? put_variable(s, name, text_variable(name, text)) : RITZ_OK;
}

/* Matrices as they are listed, with every entry stored by columns. */
static ritz_status put_matrices(sheet *s, const ritz_matrices *list)
{
    for (int64_t k = 0; k < list->count; k++) {
        const ritz_sparse *A = &list->matrix[k].A;

        RITZ_CHECK(put_real(s, list->matrix[k].name, A->nrow, A->ncol, A->val));
    }
    return RITZ_OK;
}

static ritz_status put_limits(sheet *s, int64_t count, const double *limit)
{
    bool any = false;

    for (int64_t k = 0; k < count; k++)
        any = any || !isnan(limit[k]);
    return any ? put_real(s, "limits", count, 1, limit) : RITZ_OK;
}

static ritz_status sheet_open(const char *path, sheet *out)
{
    char head[64];

    RITZ_CHECK(ritz_draft_new(path, &out->draft));
    snprintf(head, sizeof head, "MATLAB 5.0 MAT-file, written by ritz %s",
             ritz_version());
    out->file = Mat_CreateVer(out->draft.name, head, MAT_FT_MAT5);
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_FILE, "cannot write '%s'", path);
    return RITZ_OK;
}

/* Whether the file holds the matrices that were to be written, to the bit. */
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
static ritz_status compare_variables(const sheet *s)
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

static ritz_status sheet_publish(sheet *s, const ritz_matrices *list)
{
    int failed = Mat_Close(s->file);

    s->file = NULL;
    RITZ_REFUSE_IF(failed != 0, RITZ_ERR_FILE, "cannot write all of it");
    RITZ_CHECK(compare_file(s->draft.name, list));
    RITZ_CHECK(compare_variables(s));
    return ritz_draft_publish(&s->draft);
}

/* The kinds of columns by name. */
static ritz_status put_columns(sheet *s, const ritz_columns *columns)
{
    RITZ_OWN_ARRAY char(*kind)[RITZ_NAME_SIZE] = NULL;

    RITZ_CHECK_NEW(kind, columns->count);
    for (int64_t k = 0; k < columns->count; k++)
        snprintf(kind[k], sizeof kind[k], "%s",
                 ritz_column_name(columns->kind[k]));
    RITZ_CHECK(put_names(s, "columns", columns->count, kind));
    return put_real(s, "hertz", columns->count, 1, columns->hertz);
}

/* What a reduced component has in addition to its matrices. */
static ritz_status put_reduced(sheet *s, const ritz_reduced *reduced)
{
    const ritz_io *io = &reduced->io;

    RITZ_CHECK(put_names(s, "input_names", io->num_inputs, io->input));
    RITZ_CHECK(put_names(s, "output_names", io->num_outputs, io->output));
    RITZ_CHECK(put_limits(s, io->num_outputs, io->limit));
    RITZ_CHECK(put_columns(s, &reduced->columns));
    RITZ_CHECK(put_text(s, "damping", reduced->damping));
    return put_text(s, "units", reduced->units);
}

static ritz_status put_states(sheet *s, const ritz_state_space *model)
{
    RITZ_CHECK(put_names(s, "input_names", model->num_inputs, model->input));
    RITZ_CHECK(put_names(s, "output_names", model->num_outputs, model->output));
    RITZ_CHECK(put_limits(s, model->num_outputs, model->limit));
    return put_text(s, "units", model->units);
}

static ritz_status fill_sheet(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    const ritz_reduced *reduced = object->reduced;
    RITZ_OWN(ritz_matrices) list = {0};
    RITZ_OWN(sheet) s = {0};

    /* all but T, which may be large */
    RITZ_CHECK(ritz_export_matrices(
        object, request, reduced ? "K,M,D,K4,B,C,Cv,Ca" : NULL, report, &list));
    RITZ_CHECK(sheet_open(request->output, &s));
    RITZ_CHECK(put_matrices(&s, &list));
    RITZ_CHECK(reduced ? put_reduced(&s, reduced)
                       : put_states(&s, object->states));
    RITZ_CHECK(sheet_publish(&s, &list));
    if (!reduced)
        return ritz_export_say(report, "%s, y = C x + D u",
                               object->states->E.val ? "E x' = A x + B u"
                                                     : "x' = A x + B u");
    if (reduced->damping[0])
        RITZ_CHECK(ritz_export_say(report,
                                   "damping '%s' is text beside the matrices",
                                   reduced->damping));
    return ritz_export_say(report, "M q'' + D q' + K q = B u, "
                                   "y = C q + Cv q' + Ca q''");
}

/* Sparse A and E are converted to dense ones. */
static ritz_status write_sheet(const ritz_export_object *object,
                               const ritz_export_request *request,
                               ritz_export_report *report)
{
    ritz_export_object dense = *object;
    RITZ_OWN(ritz_state_space) made = {0};

    if (object->states)
        RITZ_CHECK_IN(
            "matrix-market and output4 write sparse matrices, matlab "
            "none",
            ritz_state_space_dense(object->states, &made, &dense.states));
    return ritz_context(fill_sheet(&dense, request, report), request->output);
}

const ritz_exporter ritz_exporter_matlab = {
    .name = "matlab",
    .summary = "matrices and names as a MAT file, level 5",
    .reference = "MathWorks2019",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_MATRICES,
    .write = write_sheet,
};
