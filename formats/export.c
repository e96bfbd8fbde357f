/* Exporters by name, and what may be asked of each. */
#include <ritz/export.h>

#include <string.h>

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
