/* One matrix of a reduced component as a Matrix Market file. */
#include "formats/reduced_matrices.h"

#include <stdio.h>

static ritz_status write(const ritz_reduced *reduced,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};
    char comment[4 * RITZ_NAME_SIZE];

    RITZ_TRY(ritz_reduced_matrices(
        reduced, request->matrices ? request->matrices : "K", &list));
    RITZ_FAIL_IF(
        list.count != 1, RITZ_ERR_ARGUMENT,
        "a Matrix Market file holds one matrix: name it with --matrix");
    snprintf(comment, sizeof comment, "%s, reduced by %s", list.matrix[0].name,
             reduced->origin.method);
    RITZ_TRY(
        ritz_matrix_market_write(request->output, &list.matrix[0], comment));
    RITZ_TRY(ritz_export_say(report, "%s  %lld x %lld", list.matrix[0].name,
                             (long long)list.matrix[0].A.nrow,
                             (long long)list.matrix[0].A.ncol));
done:
    ritz_matrices_free(&list);
    return status;
}

const ritz_exporter ritz_exporter_matrix_market = {
    .name = "matrix-market",
    .summary = "one matrix as Matrix Market text (--matrix, K by default)",
    .reference = "BoisvertPozoRemington1996",
    .kind = "reduced",
    .uses = RITZ_EXPORT_MATRICES,
    .write_reduced = write,
};
