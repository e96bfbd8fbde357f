/* One matrix of a reduced component or state space in Matrix Market form. */
#include "formats/reduced_matrices.h"

#include <stdio.h>

static ritz_status write(const ritz_matrices *list, const char *method,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    const ritz_matrix *one = list->matrix;
    char comment[4 * RITZ_NAME_SIZE];

    RITZ_FAIL_IF(
        list->count != 1, RITZ_ERR_ARGUMENT,
        "a Matrix Market file holds one matrix: name it with --matrix");
    snprintf(comment, sizeof comment, "%s, reduced by %s", one->name, method);
    RITZ_TRY(ritz_matrix_market_write(request->output, one, comment));
    RITZ_TRY(ritz_export_say(report, "%s  %lld x %lld", one->name,
                             (long long)one->A.nrow, (long long)one->A.ncol));
done:
    return status;
}

static ritz_status write_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};

    RITZ_TRY(ritz_reduced_matrices(
        reduced, request->matrices ? request->matrices : "K", &list));
    RITZ_TRY(write(&list, reduced->origin.method, request, report));
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

    RITZ_TRY(ritz_state_matrices(
        model, request->matrices ? request->matrices : "A", &list));
    RITZ_TRY(write(&list, model->origin.method, request, report));
done:
    ritz_matrices_free(&list);
    return status;
}

const ritz_exporter ritz_exporter_matrix_market = {
    .name = "matrix-market",
    .summary = "one matrix as Matrix Market text (--matrix, K or A by default)",
    .reference = "BoisvertPozoRemington1996",
    .kind = "reduced",
    .uses = RITZ_EXPORT_MATRICES,
    .write_reduced = write_reduced,
    .write_states = write_states,
};
