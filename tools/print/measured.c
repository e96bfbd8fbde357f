/* Measured responses as plants and controllers of ritz-frf. */
#include "print/measured.h"

/* Number of evenly spaced points, if it is not given. */
static const int64_t usual_points = 400;

bool measured_is(const model *m)
{
    return m->kind == MODEL_RESPONSE;
}

ritz_io measured_ends(const model *m)
{
    return measured_is(m) ? ritz_response_io(&m->response)
                          : ritz_model_io(model_reference(m));
}

ritz_status measured_read(cli_run *run, const char *path, int wanted,
                          model *out)
{
    if (!ritz_response_table_seems(path))
        return model_read(run, path, wanted | MODEL_RESPONSE, out);
    RITZ_CHECK(cli_input(run, path));
    RITZ_CHECK(ritz_response_read_table(path, &out->response));
    out->kind = MODEL_RESPONSE;
    return RITZ_OK;
}

ritz_status measured_refuse(const response_options *given, const char *path)
{
    const model_options *of = &given->model;

    RITZ_REFUSE_IF(of->at || of->damping || of->damper.count > 0 ||
                       of->order > 0 || given->up_to_hz > 0.0,
                   RITZ_ERR_ARGUMENT,
                   "'%s' was measured: --at, --damping, --damper, --order and "
                   "--up-to-hz are of models",
                   path);
    RITZ_REFUSE_IF(strcmp(given->method, "auto") != 0, RITZ_ERR_ARGUMENT,
                   "'%s' was measured: there is no --method to compute it",
                   path);
    RITZ_REFUSE_IF(given->zeros, RITZ_ERR_ARGUMENT,
                   "'%s' was measured: it has no states, whose zeros are "
                   "listed",
                   path);
    return RITZ_OK;
}

ritz_status measured_place(const response_options *given, const model *plant,
                           const model *controller, ritz_grid *out)
{
    const ritz_response *r =
        measured_is(plant) ? &plant->response : &controller->response;
    double low = r->hertz[0], high = r->hertz[r->count - 1];
    int64_t first = 0, count = 0;

    if (measured_is(plant) && measured_is(controller)) {
        const ritz_response *c = &controller->response;

        low = fmax(low, c->hertz[0]);
        high = fmin(high, c->hertz[c->count - 1]);
    }
    RITZ_REFUSE_IF(
        given->from_hz < low || given->to_hz > high, RITZ_ERR_ARGUMENT,
        "measured were %g to %g Hz: beyond, nothing is known", low, high);
    low = isnan(given->from_hz) ? low : given->from_hz;
    high = given->to_hz > 0.0 ? given->to_hz : high;
    RITZ_REFUSE_IF(!(low < high), RITZ_ERR_ARGUMENT,
                   "no band from %g to %g Hz that was measured", low, high);
    *out = (ritz_grid){.from_hz = low, .to_hz = high, .log = given->log};
    out->count = given->points > 0 ? given->points : usual_points;
    if (given->points > 0 || given->log)
        return RITZ_OK;
    while (first < r->count && r->hertz[first] < low)
        first++;
    while (first + count < r->count && r->hertz[first + count] <= high)
        count++;
    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT,
                   "nothing was measured from %g to %g Hz", low, high);
    *out = (ritz_grid){.from_hz = r->hertz[first],
                       .to_hz = r->hertz[first + count - 1],
                       .count = count,
                       .hertz = r->hertz + first};
    return RITZ_OK;
}
