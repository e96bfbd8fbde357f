/*
 * Inputs and outputs from matrix files,
 *
 *     M u'' + D u' + K u = B f,    y = C u + Cv u' + Ca u''
 *
 * u being the rows of mass and stiffness as they are read, along the
 * displacement axes of their grids. B has a row for each dof. C, Cv and Ca have
 * a column for each dof, or else a row for each. Files that name their rows
 * refer to dofs by name. If constraints eliminate dofs, u = G u_n, the matrices
 * become G'B and C G. Entries of dofs that the deck fixes are dropped, because
 * these do not move.
 */
#include "import/import.h"

#include "base/alloc.h"
#include "base/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const WHAT[RITZ_NUM_IO_FILES] = {
    "input matrix", "output matrix", "velocity matrix", "acceleration matrix"};

ritz_status ritz_io_files_want(const ritz_import_request *request,
                               ritz_io_files *files, ritz_wanted *wanted,
                               int64_t *count)
{
    const char *const spec[RITZ_NUM_IO_FILES] = {
        request->input_matrix, request->output_matrix, request->velocity_matrix,
        request->acceleration_matrix};

    for (int k = 0; k < RITZ_NUM_IO_FILES; k++) {
        files->spec[k] = spec[k];
        if (spec[k])
            wanted[(*count)++] =
                (ritz_wanted){spec[k], WHAT[k], &files->matrix[k]};
    }
    RITZ_CHECK_IN("recovery", ritz_quantity_files_name(request, files));
    for (int64_t k = 0; k < files->num_quantities; k++)
        wanted[(*count)++] = (ritz_wanted){files->quantity[k].spec, "recovery",
                                           &files->quantity[k].matrix};
    return RITZ_OK;
}

ritz_status ritz_io_files_name(const ritz_import_request *request,
                               const ritz_row_names *names,
                               ritz_io_files *files)
{
    RITZ_CHECK_COPY(files->dof, names->dof, names->count);
    files->num_dofs = names->count;
    files->in_order = request->dofs;
    return RITZ_OK;
}

void ritz_io_files_free(ritz_io_files *files)
{
    for (int k = 0; k < RITZ_NUM_IO_FILES; k++)
        ritz_matrix_free(&files->matrix[k]);
    RITZ_FREE_EACH(ritz_quantity_file, files->num_quantities, files->quantity);
    free(files->dof);
    *files = (ritz_io_files){0};
}

/* ---- sizes -------------------------------------------------------------- */

static ritz_status find_layout(const ritz_io_files *files, int k,
                               ritz_layout *out)
{
    return ritz_layout_find(files, &files->matrix[k], files->spec[k],
                            k == RITZ_FILE_B, out);
}

ritz_status ritz_io_files_size(const ritz_io_files *files, int64_t *inputs,
                               int64_t *outputs)
{
    int first = -1; /* first output matrix that is given */

    *inputs = *outputs = 0;
    for (int k = 0; k < RITZ_NUM_IO_FILES; k++) {
        ritz_layout is = {0};

        if (!files->spec[k])
            continue;
        RITZ_CHECK_IN(WHAT[k], find_layout(files, k, &is));
        if (k == RITZ_FILE_B) {
            *inputs = is.count;
            continue;
        }
        RITZ_REFUSE_IF(first >= 0 && is.count != *outputs, RITZ_ERR_FORMAT,
                       "'%s' has %" PRId64 " outputs, '%s' has %" PRId64
                       ": y = C u + Cv u' + Ca u'' needs as many of each",
                       files->spec[k], is.count, files->spec[first], *outputs);
        *outputs = is.count;
        first = first < 0 ? k : first;
    }
    return RITZ_OK;
}

/* ---- names --------------------------------------------------------------- */

static int64_t count_items(const char *list)
{
    int64_t count = 1;

    for (; *list; list++)
        count += *list == ',';
    return count;
}

/* Cut "@LIMIT" off a name and parse it; @p limit NULL: names have no limits. */
static ritz_status take_limit(char *item, double *limit)
{
    char *at = limit ? strrchr(item, '@') : NULL;

    if (!at)
        return RITZ_OK;
    *at = '\0';
    RITZ_REFUSE_IF(!ritz_text_real(at + 1, limit) || !(*limit > 0.0),
                   RITZ_ERR_ARGUMENT,
                   "'%s' is no limit, a positive number is due", at + 1);
    return RITZ_OK;
}

ritz_status ritz_import_channels(const char *list, char prefix, int64_t count,
                                 char (*name)[RITZ_NAME_SIZE], double *limit)
{
    char item[2 * RITZ_NAME_SIZE], twice[RITZ_NAME_SIZE];

    RITZ_REFUSE_IF(list && count_items(list) != count, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " names are given for %" PRId64 " %s",
                   count_items(list), count,
                   prefix == 'u' ? "inputs" : "outputs");
    for (int64_t k = 0; k < count; k++) {
        if (list) {
            size_t length = strcspn(list, ",");

            snprintf(item, sizeof item, "%.*s", (int)length, list);
            list += length + 1;
        } else {
            snprintf(item, sizeof item, "%c%" PRId64, prefix, k + 1);
        }
        RITZ_CHECK(take_limit(item, limit ? &limit[k] : NULL));
        RITZ_CHECK(ritz_name_copy(item, name[k]));
    }
    RITZ_CHECK(
        ritz_names_repeated(count, (const char(*)[RITZ_NAME_SIZE])name, twice));
    RITZ_REFUSE_IF(*twice, RITZ_ERR_ARGUMENT, "'%s' is named twice", twice);
    return RITZ_OK;
}

/* ---- entries ------------------------------------------------------------ */

/* A matrix whose entries are added to a component. */
typedef struct filling {
    const char *spec;
    const ritz_matrix *matrix;
    ritz_layout is;
    const ritz_import_report *report;
    const ritz_extended *extended;
    int64_t *row;   /* of each dof of the matrix: ritz_layout_rows() */
    int64_t stride; /* of dofs in `into`; its channels are `step` apart */
    int64_t step;
    double *into;
} filling;

static void filling_free(filling *it)
{
    free(it->row);
}

static ritz_status add_entry(const filling *it, int64_t i, int64_t channel,
                             double value)
{
    RITZ_REFUSE_IF(!isfinite(value), RITZ_ERR_FORMAT,
                   "'%s' holds a value that is not finite", it->spec);
    if (value == 0.0 || it->row[i] == RITZ_ROW_FIXED)
        return RITZ_OK;
    if (it->row[i] == RITZ_ROW_NONE)
        return ritz_layout_refuse(it->spec, it->report, it->extended,
                                  it->is.dof[i]);
    ritz_extended_add(it->extended, it->row[i], value, it->stride,
                      it->into + it->step * channel);
    return RITZ_OK;
}

static ritz_status add_entries(const filling *it)
{
    const ritz_sparse *A = &it->matrix->A;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            RITZ_CHECK(add_entry(it, it->is.across ? j : A->rowind[p],
                                 it->is.across ? A->rowind[p] : j, A->val[p]));
    return RITZ_OK;
}

static ritz_status add_names(const ritz_import_request *request,
                             const ritz_io_files *files, int64_t inputs,
                             int64_t outputs, ritz_io *io)
{
    RITZ_REFUSE_IF(request->input_names && inputs == 0, RITZ_ERR_ARGUMENT,
                   "names of inputs are given, but no input matrix");
    RITZ_REFUSE_IF(request->output_names && outputs == 0, RITZ_ERR_ARGUMENT,
                   "names of outputs are given, but no output matrix");
    if (files->spec[RITZ_FILE_B])
        RITZ_CHECK_IN("--input-names",
                      ritz_import_channels(request->input_names, 'u', inputs,
                                           io->input + io->num_inputs - inputs,
                                           NULL));
    if (outputs > 0)
        RITZ_CHECK_IN(
            "--output-names",
            ritz_import_channels(request->output_names, 'y', outputs,
                                 io->output + io->num_outputs - outputs,
                                 io->limit + io->num_outputs - outputs));
    return RITZ_OK;
}

ritz_status ritz_io_files_add(const ritz_import_request *request,
                              const ritz_deck *deck,
                              const ritz_import_report *report,
                              const ritz_extended *extended,
                              const ritz_io_files *files, ritz_io *io)
{
    ritz_dense *const into[RITZ_NUM_IO_FILES] = {&io->B, &io->C, &io->Cv,
                                                 &io->Ca};
    int64_t inputs = 0;
    int64_t outputs = 0;

    RITZ_CHECK(ritz_io_files_size(files, &inputs, &outputs));
    RITZ_CHECK(add_names(request, files, inputs, outputs, io));
    for (int k = 0; k < RITZ_NUM_IO_FILES; k++) {
        ritz_dense *to = into[k];
        bool is_B = k == RITZ_FILE_B;
        RITZ_OWN(filling)
        it = {.spec = files->spec[k],
              .matrix = &files->matrix[k],
              .report = report,
              .extended = extended,
              .stride = is_B ? 1 : to->nrow,
              .step = is_B ? to->nrow : 1};

        if (!files->spec[k])
            continue;
        it.into =
            to->val + it.step * (is_B ? to->ncol - inputs : to->nrow - outputs);
        RITZ_CHECK(find_layout(files, k, &it.is));
        RITZ_CHECK(ritz_layout_rows(&it.is, deck, extended, &it.row));
        RITZ_CHECK_IN(WHAT[k], add_entries(&it));
    }
    return RITZ_OK;
}
