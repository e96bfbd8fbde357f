/* Exporters, and what each of them says of geometric stiffness. */
#include <ritz/export.h>

#include <stdio.h>
#include <string.h>

/* @param[in] format  "fxbody" */
static ritz_status say_loads(const ritz_reduced *reduced, const char *format,
                             ritz_export_report *report)
{
    char names[128] = "";
    size_t used = 0;

    for (int64_t k = 0; k < reduced->num_loads && used < sizeof names; k++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s'%s'",
                                 k > 0 ? ", " : "", reduced->load[k].name);
    if (used >= sizeof names)
        memcpy(names + sizeof names - 4, "...", 4);
    return ritz_export_say(report,
                           "geometric stiffness (KG) of load%s %s is left out: "
                           "%s has no place for it",
                           reduced->num_loads > 1 ? "s" : "", names, format);
}

/* Formats that take names of matrices take those of quantities too, and say
   themselves what is left out. */
static ritz_status say_rows(const ritz_exporter *exporter,
                            const ritz_export_object *object,
                            ritz_export_report *report)
{
    const ritz_reduced *r = object->reduced;
    char names[200] = "";

    if (!r || object->shapes || r->num_quantities == 0 ||
        exporter->takes & (RITZ_EXPORT_ROWS | RITZ_EXPORT_MATRICES))
        return RITZ_OK;
    for (int64_t k = 0; k < r->num_quantities; k++) {
        const size_t used = strlen(names);

        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
                 r->quantity[k].name);
    }
    return ritz_export_say(report,
                           "rows to recover are left out, ritz-recover has "
                           "them: %s",
                           names);
}

ritz_status ritz_export_write(const ritz_exporter *exporter,
                              const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    const ritz_reduced *of = object->reduced;
    const bool picture = !(exporter->takes & RITZ_EXPORT_REDUCED) &&
                         exporter != &ritz_exporter_uff;

    RITZ_CHECK(exporter->write(object, request, report));
    RITZ_CHECK(say_rows(exporter, object, report));
    if (!of || of->num_loads == 0 || picture ||
        exporter->takes & (RITZ_EXPORT_LOADS | RITZ_EXPORT_STIFFENING))
        return RITZ_OK;
    return say_loads(of, exporter->name, report);
}
