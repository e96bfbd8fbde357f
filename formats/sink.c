/* What is asked of exporters, files that they write, lines of their reports,
 * XML text. */
#include "formats/sink.h"

#include "base/alloc.h"
#include "model/modal.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static ritz_status refuse_failure(const ritz_draft *draft, bool failed)
{
    RITZ_REFUSE_IF(failed, RITZ_ERR_FILE,
                   "'%s' cannot be written to its end: %s", draft->path,
                   strerror(errno));
    return RITZ_OK;
}

ritz_status ritz_sink_fill(const ritz_draft *draft, ritz_sink_writer *write,
                           const void *what)
{
    FILE *file = fopen(draft->name, "wb");
    ritz_status status = RITZ_OK;
    bool failed = false;

    RITZ_REFUSE_IF(!file, RITZ_ERR_FILE, "cannot write '%s': %s", draft->path,
                   strerror(errno));
    status = write(file, what);
    failed = ferror(file);
    failed = fclose(file) != 0 || failed;
    RITZ_CHECK(status);
    return refuse_failure(draft, failed);
}

ritz_status ritz_sink_fill_h5(const ritz_draft *draft,
                              ritz_sink_h5_writer *write, const void *what)
{
    RITZ_OWN(hid_t) file = 0;

    RITZ_CHECK(ritz_h5_create(draft->name, &file));
    RITZ_CHECK_IN(draft->path, write(file, what));
    return ritz_context(ritz_h5_finish(&file), draft->path);
}

ritz_status ritz_sink_write(const char *path, ritz_sink_writer *write,
                            const void *what)
{
    RITZ_OWN(ritz_draft) draft = {0};

    RITZ_CHECK_IN(path, ritz_draft_new(path, &draft));
    RITZ_CHECK(ritz_sink_fill(&draft, write, what));
    return ritz_draft_publish(&draft);
}

ritz_status ritz_sink_hold(ritz_sink_writer *write, const void *what,
                           const char *name, char **out, int64_t *size)
{
    RITZ_OWN_ARRAY char *text = NULL;
    size_t length = 0;
    FILE *file = open_memstream(&text, &length);
    ritz_status status = RITZ_OK;
    bool failed = false;

    RITZ_REFUSE_IF(!file, RITZ_ERR_MEMORY, "no memory for %s", name);
    status = write(file, what);
    failed = ferror(file);
    failed = fclose(file) != 0 || failed;
    RITZ_CHECK(status);
    RITZ_REFUSE_IF(failed, RITZ_ERR_MEMORY, "no memory for %s", name);
    if (size)
        *size = (int64_t)length;
    RITZ_MOVE(*out, text);
    return RITZ_OK;
}

ritz_status ritz_sink_check(const ritz_matrix *m)
{
    for (int64_t j = 0; j < m->A.ncol; j++)
        for (int64_t p = m->A.colptr[j]; p < m->A.colptr[j + 1]; p++)
            RITZ_REFUSE_IF(!isfinite(m->A.val[p]) ||
                               (m->imaginary && !isfinite(m->imaginary[p])),
                           RITZ_ERR_ARGUMENT,
                           "row %" PRId64 " of column %" PRId64
                           " of '%s' is not finite",
                           m->A.rowind[p] + 1, j + 1, m->name);
    return RITZ_OK;
}

ritz_status ritz_export_check(const ritz_exporter *exporter,
                              const ritz_export_request *request)
{
    const struct {
        bool given;
        int takes;
        const char *lack; /* the refusal of an exporter without the option */
    } option[] = {
        {request->matrices != NULL, RITZ_EXPORT_MATRICES,
         "has no matrices to choose"},
        {request->modes != NULL, RITZ_EXPORT_SHAPES,
         "takes a model whole, without a choice of modes"},
        {request->text || request->dense || request->digits > 0,
         RITZ_EXPORT_STYLE,
         "has one way of writing, without text, dense or digits"},
        {request->fmi > 0, RITZ_EXPORT_FMI, "has no version of FMI"},
        {request->numbered, RITZ_EXPORT_NUMBERED,
         "has no continuations to number"},
        {request->id != 0, RITZ_EXPORT_ID, "has no superelement to number"},
        {request->ports != NULL, RITZ_EXPORT_PORTS,
         "takes a model whole, without a choice of ports"},
        {request->frame || request->reference, RITZ_EXPORT_FRAME,
         "has no body in a moving frame"},
        {request->stiffening != NULL, RITZ_EXPORT_STIFFENING,
         "has no terms of geometric stiffness"},
    };

    for (size_t k = 0; k < sizeof option / sizeof *option; k++)
        RITZ_REFUSE_IF(option[k].given && !(exporter->takes & option[k].takes),
                       RITZ_ERR_ARGUMENT, "%s %s", exporter->name,
                       option[k].lack);
    RITZ_REFUSE_IF(request->matrices && !*request->matrices, RITZ_ERR_ARGUMENT,
                   "no matrix is named");
    return RITZ_OK;
}

ritz_status ritz_export_demand_si(const char *units, const char *program)
{
    static const char si[] = "kg m s"; /* as ritz-import --units states them */

    RITZ_REFUSE_IF(!*units, RITZ_ERR_ARGUMENT,
                   "%s takes kg, m and s, and the units are not known: import "
                   "with --units \"%s\" if they are these",
                   program, si);
    RITZ_REFUSE_IF(strcmp(units, si) != 0, RITZ_ERR_ARGUMENT,
                   "%s takes kg, m and s, and the units are '%s': import "
                   "matrices in these units, with --units \"%s\"",
                   program, units, si);
    return RITZ_OK;
}

void ritz_rows_put(FILE *file, const ritz_dense *A, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++)
            fprintf(file, "%.17g%c", A->val ? ritz_dense_col(A, j)[i] : 0.0,
                    j + 1 < n ? ' ' : '\n');
}

ritz_status ritz_export_say(ritz_export_report *report, const char *format, ...)
{
    va_list args;

    RITZ_CHECK(ritz_array_extend(&report->line, report->count, 1,
                                 sizeof *report->line));
    va_start(args, format);
    vsnprintf(report->line[report->count++], sizeof *report->line, format,
              args);
    va_end(args);
    return RITZ_OK;
}

void ritz_export_report_free(ritz_export_report *report)
{
    free(report->line);
    *report = (ritz_export_report){0};
}

void ritz_xml_put(FILE *file, const char *text)
{
    static const char marks[] = "&<>\"'";
    static const char *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;",
                                           "&apos;"};

    for (; *text; text++) {
        const char *mark = strchr(marks, *text);

        if (mark)
            fputs(entities[mark - marks], file);
        else
            fputc((unsigned char)*text < ' ' ? '?' : *text, file);
    }
}

ritz_status ritz_shapes_say(const ritz_shapes *shapes,
                            ritz_export_report *report)
{
    long long cells = shapes->meshed ? (long long)shapes->cells.count : 0;

    RITZ_CHECK(ritz_export_say(
        report, "%lld shapes at %lld points, %lld elements%s",
        (long long)shapes->count, (long long)shapes->num_points, cells,
        shapes->turn.val ? "; rotations as fields of their own" : ""));
    if (!shapes->meshed)
        RITZ_CHECK(ritz_export_say(report,
                                   "no elements are known: single points "
                                   "(import with --bulk for them)"));
    if (shapes->num_placeless > 0)
        RITZ_CHECK(ritz_export_say(
            report, "%lld points have no position and are left out",
            (long long)shapes->num_placeless));
    return RITZ_OK;
}

/* ---- matrices by name --------------------------------------------------- */

typedef struct entry {
    const char *name;
    size_t offset;  /* position of the dense matrix in its object */
    bool symmetric; /* false for a gyroscopic D */
    /* position of a sparse matrix that may replace it; 0: none may */
    size_t sparse;
} entry;

/* Matrices of one kind of object; the table ends in one without a name. */
typedef struct matrix_kind {
    const entry *entry;
    const char *noun;
    const char *all;   /* "K, M and D" */
    const char *usual; /* "K,M,D" */
} matrix_kind;

static const matrix_kind states = {
    .entry =
        (const entry[]){
            {"A", offsetof(ritz_state_space, A), false,
             offsetof(ritz_state_space, sA)},
            {"B", offsetof(ritz_state_space, B), false, 0},
            {"C", offsetof(ritz_state_space, C), false, 0},
            {"D", offsetof(ritz_state_space, D), false, 0},
            {"E", offsetof(ritz_state_space, E), false,
             offsetof(ritz_state_space, sE)},
            {0},
        },
    .noun = "state space",
    .all = "A, B, C, D and E",
    .usual = "A,B,C,D,E",
};

static const matrix_kind reduced = {
    .entry =
        (const entry[]){
            {"K", offsetof(ritz_reduced, K), true, 0},
            {"M", offsetof(ritz_reduced, M), true, 0},
            {"D", offsetof(ritz_reduced, D), true, 0},
            {"K4", offsetof(ritz_reduced, K4), true, 0},
            {"T", offsetof(ritz_reduced, T), false, 0},
            {"B", offsetof(ritz_reduced, io.B), false, 0},
            {"C", offsetof(ritz_reduced, io.C), false, 0},
            {"Cv", offsetof(ritz_reduced, io.Cv), false, 0},
            {"Ca", offsetof(ritz_reduced, io.Ca), false, 0},
            {0},
        },
    .noun = "reduced component",
    .all = "K, M, D, K4, KG, KG:LOAD, T, B, C, Cv and Ca",
    .usual = "K,M,D,K4,KG",
};

static const ritz_dense *dense_of(const void *object, const entry *e)
{
    return (const ritz_dense *)(const void *)((const char *)object + e->offset);
}

/* The sparse matrix that replaces a dense one; NULL: none does. */
static const ritz_sparse *sparse_of(const void *object, const entry *e)
{
    const ritz_sparse *A =
        (const ritz_sparse *)(const void *)((const char *)object + e->sparse);

    return e->sparse > 0 && A->colptr ? A : NULL;
}

static ritz_status copy_matrix(const entry *e, const ritz_sparse *A,
                               ritz_matrix *out)
{
    RITZ_CHECK(ritz_sparse_copy(A, &out->A));
    snprintf(out->name, sizeof out->name, "%s", e->name);
    out->digits = 17;
    return RITZ_OK;
}

ritz_status ritz_sink_store(const ritz_dense *A, ritz_sparse *out)
{
    int64_t at = 0;

    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol, A->nrow * A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++) {
        for (int64_t i = 0; i < A->nrow; i++) {
            out->rowind[at] = i;
            out->val[at++] = ritz_dense_col(A, j)[i];
        }
        out->colptr[j + 1] = at;
    }
    return RITZ_OK;
}

static ritz_status fill_matrix(const entry *e, const ritz_dense *A,
                               ritz_matrix *out)
{
    RITZ_CHECK(ritz_sink_store(A, &out->A));
    snprintf(out->name, sizeof out->name, "%s", e->name);
    out->symmetric = e->symmetric && ritz_dense_asymmetry(A) == 0.0;
    out->digits = 17;
    return RITZ_OK;
}

/* The quantity of a reduced component with a name; NULL if there is none. */
static const ritz_quantity *find_quantity(const ritz_export_object *object,
                                          const char *name, size_t length)
{
    const ritz_reduced *r = object->reduced;

    for (int64_t k = 0; r && k < r->num_quantities; k++)
        if (strlen(r->quantity[k].name) == length &&
            strncmp(r->quantity[k].name, name, length) == 0)
            return &r->quantity[k];
    return NULL;
}

static const entry *find_entry(const entry *among, const char *name,
                               size_t length)
{
    for (; among->name; among++)
        if (strlen(among->name) == length &&
            strncmp(among->name, name, length) == 0)
            return among;
    return NULL;
}

static ritz_status refuse_twice(const ritz_matrices *list, const char *name)
{
    for (int64_t k = 0; k < list->count; k++)
        RITZ_REFUSE_IF(strcmp(list->matrix[k].name, name) == 0,
                       RITZ_ERR_ARGUMENT, "'%s' is named twice", name);
    return RITZ_OK;
}

/* KG of load k as "KG1", "KG2", ...: names that every format can hold. */
static ritz_status take_load(const ritz_reduced *r, int64_t k,
                             ritz_matrices *out)
{
    char name[RITZ_NAME_SIZE];
    const entry load = {.name = name, .symmetric = true};

    snprintf(name, sizeof name, "KG%" PRId64, k + 1);
    RITZ_CHECK(refuse_twice(out, name));
    RITZ_CHECK(fill_matrix(&load, &r->load[k].KG, &out->matrix[out->count]));
    out->count++;
    return RITZ_OK;
}

/* "KG", of all loads, or "KG:LOAD". */
static ritz_status take_loads(const ritz_reduced *r, const char *at,
                              size_t length, bool asked, ritz_matrices *out)
{
    const size_t prefix = strlen("KG:");
    bool any = false;

    for (int64_t k = 0; k < r->num_loads; k++) {
        const char *name = r->load[k].name;

        if (length > prefix &&
            (strlen(name) != length - prefix ||
             strncmp(name, at + prefix, length - prefix) != 0))
            continue;
        any = true;
        RITZ_CHECK(take_load(r, k, out));
    }
    RITZ_REFUSE_IF(asked && !any, RITZ_ERR_ARGUMENT,
                   "this reduced component has no '%.*s'", (int)length, at);
    return RITZ_OK;
}

static bool is_load(const ritz_export_object *of, const char *at, size_t length)
{
    return of->reduced && strncmp(at, "KG", 2) == 0 &&
           (length == 2 || (length > 3 && at[2] == ':'));
}

/* A matrix of the table, or rows that recover a quantity. */
static ritz_status take_entry(const matrix_kind *kind,
                              const ritz_export_object *of, const char *at,
                              size_t length, bool asked, ritz_matrices *out)
{
    const void *object =
        of->states ? (const void *)of->states : (const void *)of->reduced;
    const entry *e = find_entry(kind->entry, at, length);
    const ritz_quantity *rows = e ? NULL : find_quantity(of, at, length);
    const entry quantity = {.name = rows ? rows->name : NULL};
    const ritz_dense *A = NULL;
    const ritz_sparse *sparse = NULL;

    RITZ_REFUSE_IF(!e && !rows, RITZ_ERR_ARGUMENT,
                   "there is no matrix '%.*s', there are %s, and rows to "
                   "recover by their names",
                   (int)length, at, kind->all);
    e = rows ? &quantity : e;
    RITZ_CHECK(refuse_twice(out, e->name));
    A = rows ? &rows->ST : dense_of(object, e);
    sparse = rows ? NULL : sparse_of(object, e);
    RITZ_REFUSE_IF(asked && !A->val && !sparse, RITZ_ERR_ARGUMENT,
                   "this %s has no '%s'", kind->noun, e->name);
    if (sparse)
        RITZ_CHECK(copy_matrix(e, sparse, &out->matrix[out->count++]));
    else if (asked || (A->val && A->nrow > 0 && A->ncol > 0)) {
        RITZ_CHECK(fill_matrix(e, A, &out->matrix[out->count]));
        out->count++;
    }
    return RITZ_OK;
}

/* The matrices that `at` lists, with commas between; of usual ones those that
 * the object has. */
static ritz_status list_matrices(const matrix_kind *kind,
                                 const ritz_export_object *of, const char *at,
                                 bool asked, ritz_matrices *out)
{
    while (*at) {
        size_t length = strcspn(at, ",");

        if (is_load(of, at, length))
            RITZ_CHECK(take_loads(of->reduced, at, length, asked, out));
        else
            RITZ_CHECK(take_entry(kind, of, at, length, asked, out));
        at += length + (at[length] != '\0');
    }
    return RITZ_OK;
}

static ritz_status say_matrix(const ritz_export_object *object,
                              const ritz_matrix *m, ritz_export_report *report)
{
    const ritz_reduced *r = object->reduced;
    char load[2 * RITZ_NAME_SIZE] = "";
    const int64_t k =
        strncmp(m->name, "KG", 2) == 0 ? strtoll(m->name + 2, NULL, 10) : 0;

    if (r && k > 0 && k <= r->num_loads)
        snprintf(load, sizeof load, ", KG of load '%s'", r->load[k - 1].name);
    return ritz_export_say(report, "%s  %lld x %lld%s", m->name,
                           (long long)m->A.nrow, (long long)m->A.ncol, load);
}

ritz_status ritz_export_matrices(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 const char *usual, ritz_export_report *report,
                                 ritz_matrices *out)
{
    const matrix_kind *kind = object->states ? &states : &reduced;
    const char *names = request->matrices;
    RITZ_OWN(ritz_matrices) list = {0};

    if (!names)
        names = usual ? usual : kind->usual;
    RITZ_CHECK_NEW(list.matrix,
                   (int64_t)strlen(names) + 1 +
                       (object->reduced ? object->reduced->num_loads : 0));
    RITZ_CHECK(
        list_matrices(kind, object, names, request->matrices != NULL, &list));
    for (int64_t k = 0; k < list.count; k++)
        RITZ_CHECK(say_matrix(object, &list.matrix[k], report));
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}

static bool has_matrix(const ritz_matrices *list, const char *name)
{
    for (int64_t k = 0; k < list->count; k++)
        if (strcmp(list->matrix[k].name, name) == 0)
            return true;
    return false;
}

ritz_status ritz_export_say_rest(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 const ritz_matrices *list,
                                 ritz_export_report *report)
{
    const ritz_reduced *r = object->reduced;
    char names[160] = "";
    int length = 0;

    if (!r || request->matrices)
        return RITZ_OK;
    for (const entry *e = reduced.entry; e->name; e++) {
        const ritz_dense *A = dense_of(r, e);

        if (A->val && A->nrow > 0 && A->ncol > 0 && !has_matrix(list, e->name))
            length += snprintf(names + length, sizeof names - (size_t)length,
                               " %s", e->name);
    }
    for (int64_t k = 0; k < r->num_quantities; k++) {
        const size_t used = strlen(names);

        snprintf(names + used, sizeof names - used, " %s", r->quantity[k].name);
    }
    return *names ? ritz_export_say(report, "left out, --matrix names them:%s",
                                    names)
                  : RITZ_OK;
}

ritz_status ritz_export_damped(const ritz_export_object *object,
                               const ritz_export_request *request,
                               const char *usual, ritz_export_report *report,
                               ritz_matrices *out)
{
    const char *text = object->reduced ? object->reduced->damping : "";
    RITZ_OWN(ritz_structure) model = {0};
    RITZ_OWN(ritz_matrices) list = {0};
    ritz_export_object damped = *object; /* borrowed but for D */
    ritz_reduced reduced_damped;
    ritz_damping damping = {0};

    if (*text) {
        RITZ_CHECK(ritz_damping_parse(text, &damping));
        RITZ_CHECK(ritz_structure_of_reduced(object->reduced, &model));
        RITZ_CHECK_IN("damping",
                      ritz_modal_damping(&model, &damping, &model.D));
        reduced_damped = *object->reduced;
        reduced_damped.D = model.D;
        damped.reduced = &reduced_damped;
    }
    RITZ_CHECK(ritz_export_matrices(&damped, request, usual, report, &list));
    if (*text)
        RITZ_CHECK(ritz_export_say(report,
                                   has_matrix(&list, "D")
                                       ? "damping '%s' is in D"
                                       : "damping '%s' is left out: D has it",
                                   text));
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}
