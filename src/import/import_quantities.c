/*
 * Quantities to recover, y = S u: rows from a matrix file, their names from a
 * text file. The matrix refers to dofs as an output matrix does
 * (import_matrices.c); with constraints u = G u_n it becomes S G.
 */
#include "import/import.h"

#include "base/alloc.h"
#include "base/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_kind(const char *word)
{
    for (int k = 0; ritz_quantity_kinds[k]; k++)
        if (strcmp(ritz_quantity_kinds[k], word) == 0)
            return true;
    return false;
}

/* "NAME=..." : what follows. */
static ritz_status split_name(const char *text, const char *form,
                              char name[RITZ_NAME_SIZE], const char **rest)
{
    char word[RITZ_NAME_SIZE];
    const char *equals = strchr(text, '=');

    RITZ_REFUSE_IF(!equals || equals - text >= RITZ_NAME_SIZE || !equals[1],
                   RITZ_ERR_ARGUMENT, "'%s' is not of the form %s", text, form);
    snprintf(word, sizeof word, "%.*s", (int)(equals - text), text);
    *rest = equals + 1;
    return ritz_name_copy(word, name);
}

/* "NAME=F[,KIND]": what follows the last comma is a kind, or part of F. */
static ritz_status split_file(const char *text, ritz_quantity_file *out)
{
    const char *rest = NULL;
    const char *comma = NULL;
    size_t length = 0;

    RITZ_CHECK(split_name(text, "NAME=FILE[:MATRIX][,KIND]", out->name, &rest));
    comma = strrchr(rest, ',');
    if (comma && !is_kind(comma + 1))
        comma = NULL;
    snprintf(out->kind, sizeof out->kind, "%s",
             comma                ? comma + 1
             : is_kind(out->name) ? out->name
                                  : "other");
    length = comma ? (size_t)(comma - rest) : strlen(rest);
    RITZ_REFUSE_IF(length == 0, RITZ_ERR_ARGUMENT, "'%s' names no file", text);
    RITZ_CHECK_NEW(out->spec, (int64_t)length + 1);
    memcpy(out->spec, rest, length);
    return RITZ_OK;
}

ritz_status ritz_import_recovery_spec(const char *text, char **out)
{
    RITZ_OWN(ritz_quantity_file) file = {0};

    RITZ_CHECK(split_file(text, &file));
    RITZ_MOVE(*out, file.spec);
    return RITZ_OK;
}

ritz_status ritz_quantity_files_name(const ritz_import_request *request,
                                     ritz_io_files *files)
{
    RITZ_CHECK_NEW(files->quantity, request->num_recoveries);
    for (int64_t k = 0; k < request->num_recoveries; k++) {
        files->num_quantities++;
        RITZ_CHECK(split_file(request->recovery[k], &files->quantity[k]));
        for (int64_t j = 0; j < k; j++)
            RITZ_REFUSE_IF(
                strcmp(files->quantity[j].name, files->quantity[k].name) == 0,
                RITZ_ERR_ARGUMENT, "there are two quantities '%s'",
                files->quantity[k].name);
    }
    return RITZ_OK;
}

void ritz_quantity_file_free(ritz_quantity_file *file)
{
    ritz_matrix_free(&file->matrix);
    free(file->spec);
    *file = (ritz_quantity_file){0};
}

/* ---- entries ------------------------------------------------------------ */

/* S of a component, as entries that are added up. */
typedef struct row_entries {
    int64_t count, room[3];
    int64_t *row, *col;
    double *val;
} row_entries;

static void row_entries_free(row_entries *e)
{
    RITZ_FREE(e->row, e->col, e->val);
}

static ritz_status put_entry(int64_t row, int64_t col, double val,
                             row_entries *e)
{
    RITZ_CHECK_ROOM(e->row, e->count, e->room[0]);
    RITZ_CHECK_ROOM(e->col, e->count, e->room[1]);
    RITZ_CHECK_ROOM(e->val, e->count, e->room[2]);
    e->row[e->count] = row;
    e->col[e->count] = col;
    e->val[e->count++] = val;
    return RITZ_OK;
}

/* An entry of an extended row: of a recovered dof one for each dof that it
   follows. */
static ritz_status spread_entry(const ritz_extended *extended, int64_t row,
                                int64_t dof, double val, row_entries *e)
{
    const ritz_sparse *from = &extended->from;
    int64_t k = dof - extended->num_rows;

    if (k < 0)
        return put_entry(row, dof, val, e);
    for (int64_t p = from->colptr[k]; p < from->colptr[k + 1]; p++)
        RITZ_CHECK(put_entry(row, from->rowind[p], val * from->val[p], e));
    return RITZ_OK;
}

/* What all quantities of an import share. */
typedef struct recovering {
    const ritz_deck *deck;
    const ritz_import_report *report;
    const ritz_extended *extended;
    const ritz_io_files *files;
} recovering;

static ritz_status list_entries(const recovering *all,
                                const ritz_quantity_file *file,
                                const ritz_layout *is, const int64_t *at,
                                row_entries *e)
{
    const ritz_sparse *A = &file->matrix.A;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t i = is->across ? j : A->rowind[p];
            int64_t row = is->across ? A->rowind[p] : j;

            RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_FORMAT,
                           "'%s' holds a value that is not finite", file->spec);
            if (A->val[p] == 0.0 || at[i] == RITZ_ROW_FIXED)
                continue;
            if (at[i] == RITZ_ROW_NONE)
                return ritz_layout_refuse(file->spec, all->report,
                                          all->extended, is->dof[i]);
            RITZ_CHECK(spread_entry(all->extended, row, at[i], A->val[p], e));
        }
    return RITZ_OK;
}

static ritz_status fill_rows(const recovering *all,
                             const ritz_quantity_file *file, ritz_quantity *out)
{
    RITZ_OWN(row_entries) e = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;
    ritz_layout is = {0};

    RITZ_CHECK(
        ritz_layout_find(all->files, &file->matrix, file->spec, false, &is));
    RITZ_CHECK(ritz_layout_rows(&is, all->deck, all->extended, &at));
    RITZ_CHECK(list_entries(all, file, &is, at, &e));
    memcpy(out->name, file->name, sizeof out->name);
    memcpy(out->kind, file->kind, sizeof out->kind);
    out->count = is.count;
    RITZ_CHECK_NEW(out->place, is.count);
    RITZ_CHECK_NEW(out->part, is.count);
    return ritz_sparse_from_triplets(is.count, all->extended->num_rows, e.count,
                                     e.row, e.col, e.val, &out->S);
}

/* ---- names of rows ------------------------------------------------------ */

/* "PLACE [PART]"; *row is the row that the line names, -1: it is blank. */
static ritz_status take_line(const char *path, int64_t line, char *text,
                             int64_t *row, ritz_quantity *out)
{
    static const char blank[] = " \t\r,;";
    char *next = NULL;
    char *word = NULL;
    char *part = NULL;
    int64_t place = 0;

    text[strcspn(text, "#")] = '\0';
    word = strtok_r(text, blank, &next);
    part = word ? strtok_r(NULL, blank, &next) : NULL;
    if (!word)
        return RITZ_OK;
    RITZ_REFUSE_IF(!ritz_text_whole(word, &place) || place < 0 ||
                       (part && strtok_r(NULL, blank, &next)),
                   RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 " is no number of an element or grid "
                   "and a word, as '12 sx'",
                   path, line);
    RITZ_REFUSE_IF(*row == out->count, RITZ_ERR_FORMAT,
                   "'%s' names more than the %" PRId64 " rows of '%s'", path,
                   out->count, out->name);
    out->place[*row] = place;
    if (part)
        RITZ_CHECK_IN(path, ritz_name_copy(part, out->part[*row]));
    (*row)++;
    return RITZ_OK;
}

/* Names by a table of NASTRAN, of the kind of the quantity. */
static ritz_status name_by_table(const char *path, const char *text,
                                 ritz_quantity *out)
{
    RITZ_OWN(ritz_row_table) table = {0};

    RITZ_CHECK(ritz_row_table_parse(path, text, out->kind, &table));
    RITZ_REFUSE_IF(table.count != out->count, RITZ_ERR_FORMAT,
                   "'%s' has a table of NASTRAN for %" PRId64
                   " rows of kind %s, '%s' has %" PRId64,
                   path, table.count, out->kind, out->name, out->count);
    memcpy(out->place, table.place, (size_t)out->count * sizeof *out->place);
    memcpy(out->part, table.part, (size_t)out->count * sizeof *out->part);
    return RITZ_OK;
}

static ritz_status name_rows(const char *path, ritz_quantity *out)
{
    RITZ_OWN_ARRAY char *text = NULL;
    int64_t line = 0, row = 0;

    RITZ_CHECK(ritz_text_read(path, &text));
    if (ritz_row_table_recognise(text))
        return name_by_table(path, text, out);
    for (char *at = text; at;) {
        char *end = strchr(at, '\n');

        if (end)
            *end = '\0';
        RITZ_CHECK(take_line(path, ++line, at, &row, out));
        at = end ? end + 1 : NULL;
    }
    RITZ_REFUSE_IF(row != out->count, RITZ_ERR_FORMAT,
                   "'%s' names %" PRId64 " rows, '%s' has %" PRId64, path, row,
                   out->name, out->count);
    return RITZ_OK;
}

/* Names in "NAME=FILE", for the quantity of that name. */
static ritz_status take_names(const char *text, ritz_component *component)
{
    char name[RITZ_NAME_SIZE];
    const char *path = NULL;
    const ritz_names names = {"quantity", component->num_quantities,
                              (char *)component->quantity,
                              sizeof *component->quantity};
    int64_t k = 0;

    RITZ_CHECK(split_name(text, "NAME=FILE", name, &path));
    k = ritz_names_seek(&names, name);
    return k < 0 ? RITZ_ERR_ARGUMENT : name_rows(path, &component->quantity[k]);
}

ritz_status ritz_quantity_files_add(const ritz_import_request *request,
                                    const ritz_deck *deck,
                                    const ritz_import_report *report,
                                    const ritz_extended *extended,
                                    const ritz_io_files *files,
                                    ritz_component *component)
{
    const recovering all = {deck, report, extended, files};

    RITZ_CHECK_NEW(component->quantity, files->num_quantities);
    for (int64_t k = 0; k < files->num_quantities; k++) {
        component->num_quantities++;
        RITZ_CHECK(
            fill_rows(&all, &files->quantity[k], &component->quantity[k]));
    }
    for (int64_t k = 0; k < request->num_recovery_rows; k++)
        RITZ_CHECK(take_names(request->recovery_rows[k], component));
    return RITZ_OK;
}
