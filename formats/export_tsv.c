/* A frequency response as columns of text: hertz, then |H| and its phase, then
   singular values where it has them; a time response as seconds, inputs,
   outputs, energies, diagnostics. */
#include "base/tolerances.h"
#include "formats/sink.h"

#include <complex.h>

static ritz_status print_response(FILE *file, const void *object)
{
    const ritz_response *response = object;
    const double degree = 180.0 / RITZ_PI;
    int64_t size = response->num_outputs * response->num_inputs;

    fprintf(file, "# hertz");
    for (int64_t i = 0; i < response->num_outputs; i++)
        for (int64_t j = 0; j < response->num_inputs; j++)
            fprintf(file, "\t|%s/%s|\tdegrees", response->output[i],
                    response->input[j]);
    for (int64_t k = 0; k < response->num_singular; k++)
        fprintf(file, "\tsigma%lld", (long long)k + 1);
    fputc('\n', file);
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
    return RITZ_OK;
}

static ritz_status print_simulation(FILE *file, const void *object)
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
    for (int64_t j = 0; j < s->num_diagnostics; j++)
        fprintf(file, "\t%s", s->diagnostic[j]);
    fputc('\n', file);
    for (int64_t k = 0; k < s->count; k++) {
        fprintf(file, "%.15g", s->seconds[k]);
        for (int64_t j = 0; j < s->num_inputs; j++)
            fprintf(file, "\t%.15e", s->u[k * s->num_inputs + j]);
        for (int64_t i = 0; i < s->num_outputs; i++)
            fprintf(file, "\t%.15e", s->y[k * s->num_outputs + i]);
        for (int e = 0; e < energies; e++)
            fprintf(file, "\t%.15e", energy[e].value[k]);
        for (int64_t j = 0; j < s->num_diagnostics; j++)
            fprintf(file, "\t%.15e", s->diagnosis[k * s->num_diagnostics + j]);
        fputc('\n', file);
    }
    return RITZ_OK;
}

static ritz_status write_table(const ritz_export_object *object,
                               const ritz_export_request *request,
                               ritz_export_report *report)
{
    const ritz_response *r = object->response;
    const ritz_simulation *s = object->simulation;

    RITZ_CHECK(s ? ritz_sink_write(request->output, print_simulation, s)
                 : ritz_sink_write(request->output, print_response, r));
    return ritz_export_say(report,
                           "%lld %s, %lld outputs, %lld inputs; numbers have "
                           "15 or 16 digits",
                           (long long)(s ? s->count : r->count),
                           s ? "times" : "frequencies",
                           (long long)(s ? s->num_outputs : r->num_outputs),
                           (long long)(s ? s->num_inputs : r->num_inputs));
}

const ritz_exporter ritz_exporter_tsv = {
    .name = "tsv",
    .summary = "a response over hertz or seconds as text columns",
    .reference = "Sirlin1992",
    .kind = "response",
    .takes = RITZ_EXPORT_RESPONSE | RITZ_EXPORT_SIMULATION,
    .write = write_table,
};
