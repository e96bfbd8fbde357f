/* Matrices of a reduced component or state space as one OUTPUT4 file. */
#include "formats/reduced_matrices.h"

static ritz_status write(const ritz_matrices *list,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    const ritz_output4_style style = {
        .text = request->text,
        .sparse = !request->dense,
        .digits = request->digits > 0 ? request->digits : 17,
    };

    for (int64_t k = 0; k < list->count; k++)
        RITZ_CHECK(ritz_export_say(report, "%s  %lld x %lld",
                                   list->matrix[k].name,
                                   (long long)list->matrix[k].A.nrow,
                                   (long long)list->matrix[k].A.ncol));
    if (style.text && style.digits < 17)
        RITZ_CHECK(
            ritz_export_say(report,
                            "%lld digits: values are rounded, and a free "
                            "body is then not quite free",
                            (long long)style.digits));
    return ritz_output4_write(request->output, list->count, list->matrix,
                              &style);
}

static ritz_status write_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};

    RITZ_TRY(ritz_reduced_matrices(reduced, request->matrices, &list));
    RITZ_TRY(write(&list, request, report));
done:
    ritz_matrices_free(&list);
    return status;
}

static ritz_status write_states(const ritz_state_space *model,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};

    RITZ_TRY(ritz_state_matrices(model, request->matrices, &list));
    RITZ_TRY(write(&list, request, report));
done:
    ritz_matrices_free(&list);
    return status;
}

const ritz_exporter ritz_exporter_output4 = {
    .name = "output4",
    .summary = "NASTRAN OUTPUT4 matrices, binary or text",
    .reference = "MSC2014",
    .kind = "reduced",
    .uses = RITZ_EXPORT_MATRICES | RITZ_EXPORT_STYLE,
    .write_reduced = write_reduced,
    .write_states = write_states,
};
