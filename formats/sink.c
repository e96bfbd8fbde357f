/* What is asked of exporters, files that they write, lines of their reports,
 * XML text. */
#include "formats/sink.h"

#include "base/alloc.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

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
    RITZ_REFUSE_IF(failed, RITZ_ERR_FILE,
                   "'%s' cannot be written to its end, is the disk full?",
                   draft->path);
    return RITZ_OK;
}

ritz_status ritz_sink_fill_h5(const ritz_draft *draft,
                              ritz_sink_h5_writer *write, const void *what)
{
    hid_t file = 0;
    ritz_status status = RITZ_OK;
    herr_t closed = 0;

    RITZ_CHECK(ritz_h5_create(draft->name, &file));
    status = write(file, what);
    closed = H5Fclose(file); /* what HDF5 held back may not fit */
    RITZ_CHECK(status);
    RITZ_REFUSE_IF(closed < 0, RITZ_ERR_FILE,
                   "'%s' cannot be written to its end, is the disk full?",
                   draft->path);
    return RITZ_OK;
}

ritz_status ritz_sink_write(const char *path, ritz_sink_writer *write,
                            const void *what)
{
    RITZ_OWN(ritz_draft) draft = {0};

    RITZ_CHECK_IN(path, ritz_draft_new(path, &draft));
    RITZ_CHECK(ritz_sink_fill(&draft, write, what));
    return ritz_draft_publish(&draft);
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
    bool styled = request->text || request->dense || request->digits > 0;

    RITZ_REFUSE_IF(
        request->matrices && !(exporter->takes & RITZ_EXPORT_MATRICES),
        RITZ_ERR_ARGUMENT, "%s has no matrices to choose", exporter->name);
    RITZ_REFUSE_IF(request->matrices && !*request->matrices, RITZ_ERR_ARGUMENT,
                   "no matrix is named");
    RITZ_REFUSE_IF(request->modes && !(exporter->takes & RITZ_EXPORT_SHAPES),
                   RITZ_ERR_ARGUMENT,
                   "%s takes a model whole, without a choice of modes",
                   exporter->name);
    RITZ_REFUSE_IF(styled && !(exporter->takes & RITZ_EXPORT_STYLE),
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
