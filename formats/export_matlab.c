/*
 * A reduced component or state space as a MAT file of level 5 for MATLAB,
 * Octave and SciPy: matrices, names of inputs and outputs as cells of text,
 * limits, and the kinds of columns. Absent matrices are left out.
 * [MathWorks2019]
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/mat_sheet.h"

#include <math.h>
#include <string.h>

static ritz_status put_limits(ritz_mat_sheet *s, int64_t count,
                              const double *limit)
{
    bool any = false;

    for (int64_t k = 0; k < count; k++)
        any = any || !isnan(limit[k]);
    return any ? ritz_mat_put_real(s, "limits", count, 1, limit) : RITZ_OK;
}

/* The kinds of columns by name. */
static ritz_status put_columns(ritz_mat_sheet *s, const ritz_columns *columns)
{
    RITZ_OWN_ARRAY char(*kind)[RITZ_NAME_SIZE] = NULL;

    RITZ_CHECK_NEW(kind, columns->count);
    for (int64_t k = 0; k < columns->count; k++)
        snprintf(kind[k], sizeof kind[k], "%s",
                 ritz_column_name(columns->kind[k]));
    RITZ_CHECK(ritz_mat_put_names(s, "columns", columns->count, kind));
    return ritz_mat_put_real(s, "hertz", columns->count, 1, columns->hertz);
}

/* Names of loads: KG1 is of the first of them. */
static ritz_status put_loads(ritz_mat_sheet *s, const ritz_reduced *reduced)
{
    RITZ_OWN_ARRAY char(*load)[RITZ_NAME_SIZE] = NULL;

    if (reduced->num_loads == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(load, reduced->num_loads);
    for (int64_t k = 0; k < reduced->num_loads; k++)
        memcpy(load[k], reduced->load[k].name, sizeof *load);
    return ritz_mat_put_names(s, "load_names", reduced->num_loads, load);
}

/* What a reduced component has in addition to its matrices. */
static ritz_status put_reduced(ritz_mat_sheet *s, const ritz_reduced *reduced)
{
    const ritz_io *io = &reduced->io;

    RITZ_CHECK(ritz_mat_put_names(s, "input_names", io->num_inputs, io->input));
    RITZ_CHECK(
        ritz_mat_put_names(s, "output_names", io->num_outputs, io->output));
    RITZ_CHECK(put_limits(s, io->num_outputs, io->limit));
    RITZ_CHECK(put_loads(s, reduced));
    RITZ_CHECK(put_columns(s, &reduced->columns));
    RITZ_CHECK(ritz_mat_put_text(s, "damping", reduced->damping));
    return ritz_mat_put_text(s, "units", reduced->units);
}

static ritz_status put_states(ritz_mat_sheet *s, const ritz_state_space *model)
{
    RITZ_CHECK(
        ritz_mat_put_names(s, "input_names", model->num_inputs, model->input));
    RITZ_CHECK(ritz_mat_put_names(s, "output_names", model->num_outputs,
                                  model->output));
    RITZ_CHECK(put_limits(s, model->num_outputs, model->limit));
    return ritz_mat_put_text(s, "units", model->units);
}

static ritz_status fill_sheet(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    const ritz_reduced *reduced = object->reduced;
    RITZ_OWN(ritz_matrices) list = {0};
    RITZ_OWN(ritz_mat_sheet) s = {0};
    RITZ_OWN_ARRAY char *certificate = NULL;

    /* all but T, which may be large */
    RITZ_CHECK(ritz_export_matrices(object, request,
                                    reduced ? "K,M,D,K4,KG,B,C,Cv,Ca" : NULL,
                                    report, &list));
    RITZ_CHECK(ritz_export_say_rest(object, request, &list, report));
    RITZ_CHECK(ritz_export_say(report, "numbers keep every bit; inertia and "
                                       "ports are left out"));
    RITZ_CHECK(ritz_mat_sheet_open(request->output, &s));
    RITZ_CHECK(ritz_mat_put_matrices(&s, &list));
    RITZ_CHECK(reduced ? put_reduced(&s, reduced)
                       : put_states(&s, object->states));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    RITZ_CHECK(ritz_mat_put_text(&s, "certificate", certificate));
    RITZ_CHECK(ritz_mat_sheet_publish(&s, &list));
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
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_MATRICES |
             RITZ_EXPORT_LOADS,
    .write = write_sheet,
};
