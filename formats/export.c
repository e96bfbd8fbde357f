#include "base/alloc.h"

#include <ritz/export.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A new format is a new file that defines one descriptor, and one line here. */
const ritz_exporter *const ritz_exporters[] = {
    &ritz_exporter_exudyn,        &ritz_exporter_matlab,
    &ritz_exporter_matrix_market, &ritz_exporter_output4,
    &ritz_exporter_tsv,           &ritz_exporter_vtu,
    &ritz_exporter_xdmf,          NULL,
};

const ritz_exporter *ritz_exporter_find(const char *name)
{
    for (const ritz_exporter *const *e = ritz_exporters; *e; e++)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}

ritz_status ritz_export_check(const ritz_exporter *exporter,
                              const ritz_export_request *request)
{
    bool styled = request->text || request->dense || request->digits > 0;

    RITZ_REFUSE_IF(
        request->matrices && !(exporter->uses & RITZ_EXPORT_MATRICES),
        RITZ_ERR_ARGUMENT, "%s has no matrices to choose", exporter->name);
    RITZ_REFUSE_IF(request->matrices && !*request->matrices, RITZ_ERR_ARGUMENT,
                   "no matrix is named");
    RITZ_REFUSE_IF(request->modes && !(exporter->uses & RITZ_EXPORT_SHAPES),
                   RITZ_ERR_ARGUMENT,
                   "%s takes a model whole, without a choice of modes",
                   exporter->name);
    RITZ_REFUSE_IF(styled && !(exporter->uses & RITZ_EXPORT_STYLE),
                   RITZ_ERR_ARGUMENT,
                   "%s has one way of writing, without text, "
                   "dense or digits",
                   exporter->name);
    return RITZ_OK;
}

ritz_status ritz_export_say(ritz_export_report *report, const char *format, ...)
{
    char(*more)[256] = NULL;
    va_list args;

    RITZ_CHECK_NEW(more, report->count + 1);
    if (report->count > 0)
        memcpy(more, report->line, (size_t)report->count * sizeof *more);
    va_start(args, format);
    vsnprintf(more[report->count], sizeof *more, format, args);
    va_end(args);
    free(report->line);
    report->line = more;
    report->count++;
    return RITZ_OK;
}

void ritz_export_report_free(ritz_export_report *report)
{
    free(report->line);
    *report = (ritz_export_report){0};
}
