/*
 * Matrices of a reduced component or state space in Matrix Market form, each in
 * a file of its own: "small-%.mtx" becomes small-A.mtx, small-B.mtx, ...
 */
#include "base/alloc.h"
#include "formats/reduced_matrices.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The output with the matrix' name in the place of its '%', if there is one. */
static ritz_status name_file(const char *output, const char *name, char **out)
{
    int64_t room = (int64_t)(strlen(output) + strlen(name)) + 1;
    const char *mark = strchr(output, '%');
    char *path = NULL;

    RITZ_CHECK_NEW(path, room);
    if (mark)
        snprintf(path, (size_t)room, "%.*s%s%s", (int)(mark - output), output,
                 name, mark + 1);
    else
        snprintf(path, (size_t)room, "%s", output);
    *out = path;
    return RITZ_OK;
}

static ritz_status write_one(const ritz_matrix *one, const char *method,
                             const ritz_export_request *request,
                             ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    char comment[4 * RITZ_NAME_SIZE];
    char *path = NULL;

    snprintf(comment, sizeof comment, *method ? "%s, reduced by %s" : "%s",
             one->name, method);
    RITZ_TRY(name_file(request->output, one->name, &path));
    RITZ_TRY(ritz_matrix_market_write(path, one, comment));
    RITZ_TRY(ritz_export_say(report, "%s  %lld x %lld", one->name,
                             (long long)one->A.nrow, (long long)one->A.ncol));
done:
    free(path);
    return status;
}

static ritz_status write(const ritz_matrices *list, const char *method,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    RITZ_REFUSE_IF(list->count != 1 && !strchr(request->output, '%'),
                   RITZ_ERR_ARGUMENT,
                   "a Matrix Market file holds one matrix: name it with "
                   "--matrix, or write '%%' for it in the output's name");
    for (int64_t k = 0; k < list->count; k++)
        RITZ_CHECK(write_one(&list->matrix[k], method, request, report));
    return RITZ_OK;
}

/* One file takes one matrix, a pattern of names all of them. */
static const char *choose(const ritz_export_request *request, const char *one)
{
    if (request->matrices || strchr(request->output, '%'))
        return request->matrices;
    return one;
}

static ritz_status write_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_matrices list = {0};

    RITZ_TRY(ritz_reduced_matrices(reduced, choose(request, "K"), &list));
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

    RITZ_TRY(ritz_state_matrices(model, choose(request, "A"), &list));
    RITZ_TRY(write(&list, model->origin.method, request, report));
done:
    ritz_matrices_free(&list);
    return status;
}

const ritz_exporter ritz_exporter_matrix_market = {
    .name = "matrix-market",
    .summary = "Matrix Market text: one matrix, or -o NAME-%.mtx for all",
    .reference = "BoisvertPozoRemington1996",
    .kind = "reduced",
    .uses = RITZ_EXPORT_MATRICES,
    .write_reduced = write_reduced,
    .write_states = write_states,
};
