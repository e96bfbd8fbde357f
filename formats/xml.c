#include "formats/xml.h"

#include <string.h>

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
