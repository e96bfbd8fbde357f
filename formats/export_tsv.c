/* A frequency response as columns of text: hertz, then |H| and its phase, then
   singular values where it has them; a time response as seconds, inputs,
   outputs, energies. */
#include "base/draft.h"

#include "base/tolerances.h"

#include <ritz/export.h>

#include <complex.h>
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
    for (int64_t k = 0; k < response->num_singular; k++)
        fprintf(file, "\tsigma%lld", (long long)k + 1);
    fputc('\n', file);
}

static void print_rows(FILE *file, const ritz_response *response)
{
    const double degree = 180.0 / RITZ_PI;
    int64_t size = response->num_outputs * response->num_inputs;

    for (int64_t k = 0; k < response->count; k++) {
        fprintf(file, "%.15g", response->hertz[k]);
        for (int64_t i = 0; i < size; i++) {
            double _Complex h = response->H[k * size + i];

            fprintf(file, "\t%.15e\t%.12f", cabs(h), carg(h) * degree);
        }
        for (int64_t i = 0; i < response->num_singular; i++)
            fprintf(file, "\t%.15e",
                    response->singular[k * response->num_singular + i]);
        fputc('\n', file);
    }
}

static void print_response(FILE *file, const void *object)
{
    print_head(file, object);
    print_rows(file, object);
}

static void print_simulation(FILE *file, const void *object)
{
    const ritz_simulation *s = object;
    const struct {
        const char *name;
        const double *value;
    } energy[] = {{"kinetic", s->kinetic},
                  {"potential", s->potential},
                  {"dissipated", s->dissipated},
                  {"work", s->work},
                  {"balance", s->balance}};
    int energies = s->balance ? 5 : 0;

    fprintf(file, "# seconds");
    for (int64_t j = 0; j < s->num_inputs; j++)
        fprintf(file, "\t%s", s->input[j]);
    for (int64_t i = 0; i < s->num_outputs; i++)
        fprintf(file, "\t%s", s->output[i]);
    for (int e = 0; e < energies; e++)
        fprintf(file, "\t%s", energy[e].name);
    fputc('\n', file);
    for (int64_t k = 0; k < s->count; k++) {
        fprintf(file, "%.15g", s->seconds[k]);
        for (int64_t j = 0; j < s->num_inputs; j++)
            fprintf(file, "\t%.15e", s->u[k * s->num_inputs + j]);
        for (int64_t i = 0; i < s->num_outputs; i++)
            fprintf(file, "\t%.15e", s->y[k * s->num_outputs + i]);
        for (int e = 0; e < energies; e++)
            fprintf(file, "\t%.15e", energy[e].value[k]);
        fputc('\n', file);
    }
}

static ritz_status save(const char *output,
                        void (*print)(FILE *file, const void *object),
                        const void *object)
{
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};
    FILE *file = NULL;

    RITZ_TRY(ritz_draft_new(output, &draft));
    file = fopen(draft.name, "w");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s': %s", draft.name,
                 strerror(errno));
    print(file, object);
    errno = 0;
    RITZ_FAIL_IF(ferror(file), RITZ_ERR_FILE, "cannot write '%s'", draft.name);
    status = fclose(file) == 0 ? RITZ_OK : RITZ_ERR_FILE;
    file = NULL;
    RITZ_FAIL_IF(status != RITZ_OK, RITZ_ERR_FILE, "cannot write '%s': %s",
                 draft.name, strerror(errno));
    RITZ_TRY(ritz_draft_publish(&draft));
done:
    if (file)
        fclose(file);
    ritz_draft_free(&draft);
    return status;
}

static ritz_status write(const ritz_response *response,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    RITZ_CHECK(save(request->output, print_response, response));
    return ritz_export_say(
        report, "%lld frequencies, %lld outputs, %lld inputs",
        (long long)response->count, (long long)response->num_outputs,
        (long long)response->num_inputs);
}

static ritz_status write_simulation(const ritz_simulation *simulation,
                                    const ritz_export_request *request,
                                    ritz_export_report *report)
{
    RITZ_CHECK(save(request->output, print_simulation, simulation));
    return ritz_export_say(report, "%lld times, %lld outputs, %lld inputs",
                           (long long)simulation->count,
                           (long long)simulation->num_outputs,
                           (long long)simulation->num_inputs);
}

const ritz_exporter ritz_exporter_tsv = {
    .name = "tsv",
    .summary = "a response over hertz or seconds as text columns",
    .reference = "Sirlin1992",
    .kind = "response",
    .write_response = write,
    .write_simulation = write_simulation,
};
