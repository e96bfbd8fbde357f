/* A frequency response as columns of text: hertz, then |H| and its phase. */
#include "base/draft.h"

#include <ritz/export.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void print_head(FILE *file, const ritz_response *response)
{
    fprintf(file, "# hertz");
    for (int64_t i = 0; i < response->num_outputs; i++)
        for (int64_t j = 0; j < response->num_inputs; j++)
            fprintf(file, "\t|%s/%s|\tdegrees", response->output[i],
                    response->input[j]);
    fputc('\n', file);
}

static void print_rows(FILE *file, const ritz_response *response)
{
    const double degree = 180.0 / 3.14159265358979323846;
    int64_t size = response->num_outputs * response->num_inputs;

    for (int64_t k = 0; k < response->count; k++) {
        fprintf(file, "%.15g", response->hertz[k]);
        for (int64_t i = 0; i < size; i++) {
            double _Complex h = response->H[k * size + i];

            fprintf(file, "\t%.15e\t%.12f", cabs(h), carg(h) * degree);
        }
        fputc('\n', file);
    }
}

static ritz_status write(const ritz_response *response,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};
    FILE *file = NULL;

    RITZ_TRY(ritz_draft_new(request->output, &draft));
    file = fopen(draft.name, "w");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s': %s", draft.name,
                 strerror(errno));
    print_head(file, response);
    print_rows(file, response);
    errno = 0;
    RITZ_FAIL_IF(ferror(file), RITZ_ERR_FILE, "cannot write '%s'", draft.name);
    status = fclose(file) == 0 ? RITZ_OK : RITZ_ERR_FILE;
    file = NULL;
    RITZ_FAIL_IF(status != RITZ_OK, RITZ_ERR_FILE, "cannot write '%s': %s",
                 draft.name, strerror(errno));
    RITZ_TRY(ritz_draft_publish(&draft));
    RITZ_TRY(ritz_export_say(
        report, "%lld frequencies, %lld outputs, %lld inputs",
        (long long)response->count, (long long)response->num_outputs,
        (long long)response->num_inputs));
done:
    if (file)
        fclose(file);
    ritz_draft_free(&draft);
    return status;
}

const ritz_exporter ritz_exporter_tsv = {
    .name = "tsv",
    .summary = "a response as text columns: hertz, magnitude, phase",
    .reference = "Sirlin1992",
    .kind = "response",
    .write_response = write,
};
