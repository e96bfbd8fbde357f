/*
 * A reduced component or state space as a MAT file of level 5, which MATLAB,
 * Octave and SciPy read: its matrices, names of inputs and outputs as cells of
 * text, limits, and what its columns are. Absent matrices are left out.
 *
 * The head says no time, so that the same run writes the same bytes. What was
 * written is read back by our own reader and compared, as libmatio does not say
 * whether a disk was full. [MathWorks2019]
 */
#include "base/alloc.h"
#include "base/draft.h"
#include "base/text.h"
#include "formats/reduced_matrices.h"

#include <ritz/base.h>

#include <math.h>
#include <matio.h>
#include <stdlib.h>
#include <string.h>

/* A file that is being written. */
typedef struct sheet {
    ritz_draft draft;
    mat_t *file;
} sheet;

static ritz_status put(sheet *s, const char *name, matvar_t *variable)
{
    ritz_status status = RITZ_OK;

    RITZ_FAIL_IF(!variable, RITZ_ERR_MEMORY, "no memory for '%s'", name);
    RITZ_FAIL_IF(Mat_VarWrite(s->file, variable, MAT_COMPRESSION_NONE) != 0,
                 RITZ_ERR_FILE, "cannot write '%s'", name);
done:
    Mat_VarFree(variable);
    return status;
}

static ritz_status put_real(sheet *s, const char *name, int64_t nrow,
                            int64_t ncol, const double *values)
{
    size_t dims[2] = {(size_t)nrow, (size_t)ncol};
    double *copy = NULL; /* which libmatio may write to */
    ritz_status status = RITZ_OK;

    RITZ_NEW(copy, nrow * ncol);
    memcpy(copy, values, (size_t)(nrow * ncol) * sizeof *copy);
    RITZ_TRY(put(s, name,
                 Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, copy,
                               MAT_F_DONT_COPY_DATA)));
done:
    free(copy);
    return status;
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
    ritz_status status = RITZ_OK;
    size_t dims[2] = {(size_t)count, 1};
    matvar_t *cells = NULL;

    if (count == 0)
        return RITZ_OK;
    cells = Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, dims, NULL, 0);
    for (int64_t k = 0; cells && k < count; k++) {
        matvar_t *text = text_variable(NULL, names[k]);

        RITZ_FAIL_IF(!text, RITZ_ERR_MEMORY, "no memory for '%s'", name);
        Mat_VarSetCell(cells, (int)k, text);
    }
    status = put(s, name, cells);
    cells = NULL;
done:
    Mat_VarFree(cells);
    return status;
}

static ritz_status put_text(sheet *s, const char *name, const char *text)
{
    return *text ? put(s, name, text_variable(name, text)) : RITZ_OK;
}

/* Matrices as they are listed, every entry. */
static ritz_status put_matrices(sheet *s, const ritz_matrices *list,
                                ritz_export_report *report)
{
    RITZ_OWN(ritz_dense) A = {0};

    for (int64_t k = 0; k < list->count; k++) {
        const ritz_matrix *m = &list->matrix[k];

        RITZ_CHECK(ritz_sparse_dense(&m->A, &A));
        RITZ_CHECK(put_real(s, m->name, A.nrow, A.ncol, A.val));
        ritz_dense_free(&A);
        RITZ_CHECK(ritz_export_say(report, "%s  %lld x %lld", m->name,
                                   (long long)m->A.nrow, (long long)m->A.ncol));
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

/* True if the file holds the matrices that were to be written, to the bit. */
static ritz_status check(const char *path, const ritz_matrices *list)
{
    RITZ_OWN(ritz_matrices) back = {0};
    RITZ_OWN(ritz_dense) A = {0}, B = {0};

    RITZ_CHECK_IN("reading back", ritz_foreign_read(path, &back));
    RITZ_REFUSE_IF(back.count < list->count, RITZ_ERR_FILE,
                   "only part of '%s' could be written", path);
    for (int64_t k = 0; k < list->count; k++) {
        RITZ_CHECK(ritz_sparse_dense(&list->matrix[k].A, &A));
        RITZ_CHECK(ritz_sparse_dense(&back.matrix[k].A, &B));
        RITZ_REFUSE_IF(A.nrow != B.nrow || A.ncol != B.ncol, RITZ_ERR_FILE,
                       "'%s' was not written as it is", list->matrix[k].name);
        for (int64_t i = 0; i < A.nrow * A.ncol; i++)
            RITZ_REFUSE_IF(A.val[i] != B.val[i], RITZ_ERR_FILE,
                           "'%s' was not written as it is",
                           list->matrix[k].name);
        ritz_dense_free(&A);
        ritz_dense_free(&B);
    }
    return RITZ_OK;
}

static ritz_status sheet_publish(sheet *s, const ritz_matrices *list)
{
    int failed = Mat_Close(s->file);

    s->file = NULL;
    RITZ_REFUSE_IF(failed != 0, RITZ_ERR_FILE, "cannot write all of it");
    RITZ_CHECK(check(s->draft.name, list));
    return ritz_draft_publish(&s->draft);
}

static void sheet_free(sheet *s)
{
    if (s->file)
        Mat_Close(s->file);
    ritz_draft_free(&s->draft);
}

/* All matrices of a reduced component but T, which may be large. */
static void list_all(const ritz_reduced *r, size_t room, char *out)
{
    const struct {
        const char *names;
        bool there;
    } parts[] = {{"K,M", true},
                 {",D", r->D.val != NULL},
                 {",K4", r->K4.val != NULL},
                 {",B", r->io.num_inputs > 0},
                 {",C,Cv,Ca", r->io.num_outputs > 0}};
    size_t used = 0;

    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        if (parts[k].there)
            used +=
                (size_t)snprintf(out + used, room - used, "%s", parts[k].names);
}

/* The kinds of columns by name. */
static ritz_status put_columns(sheet *s, const ritz_columns *columns)
{
    ritz_status status = RITZ_OK;
    char(*kind)[RITZ_NAME_SIZE] = NULL;

    RITZ_NEW(kind, columns->count);
    for (int64_t k = 0; k < columns->count; k++)
        snprintf(kind[k], sizeof kind[k], "%s",
                 ritz_column_name(columns->kind[k]));
    RITZ_TRY(put_names(s, "columns", columns->count, kind));
    RITZ_TRY(put_real(s, "hertz", columns->count, 1, columns->hertz));
done:
    free(kind);
    return status;
}

static ritz_status write_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &reduced->io;
    ritz_matrices list = {0};
    char all[32];
    sheet s = {0};

    list_all(reduced, sizeof all, all);
    RITZ_TRY(ritz_reduced_matrices(
        reduced, request->matrices ? request->matrices : all, &list));
    RITZ_TRY(sheet_open(request->output, &s));
    RITZ_TRY(put_matrices(&s, &list, report));
    RITZ_TRY(put_names(&s, "input_names", io->num_inputs, io->input));
    RITZ_TRY(put_names(&s, "output_names", io->num_outputs, io->output));
    RITZ_TRY(put_limits(&s, io->num_outputs, io->limit));
    RITZ_TRY(put_columns(&s, &reduced->columns));
    RITZ_TRY(put_text(&s, "damping", reduced->damping));
    RITZ_TRY(put_text(&s, "units", reduced->units));
    RITZ_TRY(sheet_publish(&s, &list));
    if (reduced->damping[0])
        RITZ_TRY(ritz_export_say(report,
                                 "damping '%s' is text beside the matrices",
                                 reduced->damping));
    RITZ_TRY(ritz_export_say(report, "M q'' + D q' + K q = B u, "
                                     "y = C q + Cv q' + Ca q''"));
done:
    sheet_free(&s);
    ritz_matrices_free(&list);
    return ritz_context(status, request->output);
}

static ritz_status write_states(const ritz_state_space *model,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};
    sheet s = {0};

    RITZ_TRY(ritz_state_matrices(model, request->matrices, &list));
    RITZ_TRY(sheet_open(request->output, &s));
    RITZ_TRY(put_matrices(&s, &list, report));
    RITZ_TRY(put_names(&s, "input_names", model->num_inputs, model->input));
    RITZ_TRY(put_names(&s, "output_names", model->num_outputs, model->output));
    RITZ_TRY(put_limits(&s, model->num_outputs, model->limit));
    RITZ_TRY(put_text(&s, "units", model->units));
    RITZ_TRY(sheet_publish(&s, &list));
    RITZ_TRY(
        ritz_export_say(report, "%s, y = C x + D u",
                        model->E.val ? "E x' = A x + B u" : "x' = A x + B u"));
done:
    sheet_free(&s);
    ritz_matrices_free(&list);
    return ritz_context(status, request->output);
}

const ritz_exporter ritz_exporter_matlab = {
    .name = "matlab",
    .summary = "matrices and names as a MAT file, level 5",
    .reference = "MathWorks2019",
    .kind = "reduced",
    .uses = RITZ_EXPORT_MATRICES,
    .write_reduced = write_reduced,
    .write_states = write_states,
};
