/* What may be asked of each exporter. */
#include <ritz/export.h>

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
