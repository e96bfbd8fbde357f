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

enum { IS_FIXED = -1, IS_NO_DOF = -2 };

static const char *const WHAT[RITZ_NUM_IO_FILES] = {
    "input matrix", "output matrix", "velocity matrix", "acceleration matrix"};

int64_t ritz_io_files_want(const ritz_import_request *request,
                           ritz_io_files *files, ritz_wanted *wanted)
{
    const char *const spec[RITZ_NUM_IO_FILES] = {
        request->input_matrix, request->output_matrix, request->velocity_matrix,
        request->acceleration_matrix};
    int64_t count = 0;

    for (int k = 0; k < RITZ_NUM_IO_FILES; k++) {
        files->spec[k] = spec[k];
        if (spec[k])
            wanted[count++] =
                (ritz_wanted){spec[k], WHAT[k], &files->matrix[k]};
    }
    return count;
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
    free(files->dof);
    *files = (ritz_io_files){0};
}

/* ---- sizes -------------------------------------------------------------- */

/* The dofs of a matrix, in its columns or its rows, and its number of inputs or
 * outputs. */
typedef struct layout {
    int64_t num_dofs;
    const ritz_dof *dof;
    bool across; /* dofs are its columns */
    int64_t count;
} layout;

static ritz_status find_layout(const ritz_io_files *files, int k, layout *out)
{
    const ritz_matrix *m = &files->matrix[k];
    bool named = m->row && !files->in_order;
    int64_t n = named ? m->A.nrow : files->num_dofs;
    bool across = k != RITZ_FILE_B && !named && m->A.ncol == n;

    RITZ_REFUSE_IF(m->imaginary, RITZ_ERR_FORMAT,
                   "'%s' is complex, a real matrix is due", files->spec[k]);
    RITZ_REFUSE_IF(!across && m->A.nrow != n, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 ": %" PRId64
                   " %s are due, one for each dof of the mass",
                   files->spec[k], m->A.nrow, m->A.ncol, n,
                   k == RITZ_FILE_B ? "rows" : "columns");
    *out = (layout){.num_dofs = n,
                    .dof = named ? m->row : files->dof,
                    .across = across,
                    .count = across ? m->A.nrow : m->A.ncol};
    RITZ_REFUSE_IF(out->count == 0, RITZ_ERR_FORMAT, "'%s' is empty",
                   files->spec[k]);
    return RITZ_OK;
}

ritz_status ritz_io_files_size(const ritz_io_files *files, int64_t *inputs,
                               int64_t *outputs)
{
    int first = -1; /* first output matrix that is given */

    *inputs = *outputs = 0;
    for (int k = 0; k < RITZ_NUM_IO_FILES; k++) {
        layout is = {0};

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
                   "%" PRId64 " names are given for %" PRId64,
                   count_items(list), count);
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
    layout is;
    const ritz_import_report *report;
    const ritz_extended *extended;
    int64_t *row;   /* extended row of each dof of the matrix, or IS_... */
    int64_t stride; /* of dofs in `into`; its channels are `step` apart */
    int64_t step;
    double *into;
} filling;

static void filling_free(filling *it)
{
    free(it->row);
}

static ritz_status find_rows(const ritz_deck *deck, filling *it)
{
    RITZ_CHECK_NEW(it->row, it->is.num_dofs);
    for (int64_t i = 0; i < it->is.num_dofs; i++) {
        ritz_dof dof = it->is.dof[i];

        it->row[i] = ritz_roster_row(&it->extended->roster, dof);
        if (it->row[i] < 0)
            it->row[i] = ritz_dof_among(dof, deck->num_fixed, deck->fixed)
                             ? IS_FIXED
                             : IS_NO_DOF;
    }
    return RITZ_OK;
}

static ritz_status refuse_dof(const filling *it, ritz_dof dof)
{
    const ritz_import_report *report = it->report;
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 0; k < report->num_removed; k++)
        RITZ_REFUSE_IF(ritz_dof_compare(&report->removed[k], &dof) == 0,
                       RITZ_ERR_FORMAT,
                       "'%s' has an entry for '%s', which has neither "
                       "stiffness nor mass",
                       it->spec, ritz_dof_name(dof, name));
    return ritz_context(ritz_roster_miss(&it->extended->roster, dof), it->spec);
}

static ritz_status add_entry(const filling *it, int64_t i, int64_t channel,
                             double value)
{
    RITZ_REFUSE_IF(!isfinite(value), RITZ_ERR_FORMAT,
                   "'%s' holds a value that is not finite", it->spec);
    if (value == 0.0 || it->row[i] == IS_FIXED)
        return RITZ_OK;
    if (it->row[i] == IS_NO_DOF)
        return refuse_dof(it, it->is.dof[i]);
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
        RITZ_CHECK(find_rows(deck, &it));
        RITZ_CHECK_IN(WHAT[k], add_entries(&it));
    }
    return RITZ_OK;
}
