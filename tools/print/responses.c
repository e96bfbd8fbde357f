#include "print/responses.h"

#include "base/tolerances.h"

#include <ritz/zeros.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a component with more dofs no first-order model is made just to be asked
   for its poles or zeros. */
enum { MOST_DOFS = 400 };

/* "NAME=X" of --input-size. */
static ritz_status take_size(const ritz_response *r, const char *text,
                             double *size)
{
    const char *equals = strrchr(text, '=');
    double value = 0.0;
    int64_t found = -1;

    RITZ_REFUSE_IF(
        !equals || !ritz_text_real(equals + 1, &value) || !(value > 0.0),
        RITZ_ERR_ARGUMENT,
        "--input-size: '%s' is not of the form NAME=X with X above 0", text);
    for (int64_t j = 0; j < r->num_inputs; j++)
        if (strlen(r->input[j]) == (size_t)(equals - text) &&
            strncmp(r->input[j], text, (size_t)(equals - text)) == 0)
            found = j;
    RITZ_REFUSE_IF(found < 0, RITZ_ERR_ARGUMENT,
                   "--input-size: there is no input '%.*s'",
                   (int)(equals - text), text);
    size[found] = value;
    return RITZ_OK;
}

/* Limits of the outputs; NULL if the model has no place for any. */
static const double *limits_of(const model *m)
{
    if (m->kind == MODEL_STATES)
        return m->states.limit;
    return m->kind == MODEL_COMPONENT ? m->component.io.limit
                                      : model_look(m).matrices.io->limit;
}

static ritz_status find_scales(const responses_wish *asked, const model *m,
                               const ritz_response *r, double *size,
                               ritz_scales *out)
{
    const double *limit = limits_of(m);
    bool any = false;

    for (int64_t j = 0; j < r->num_inputs; j++)
        size[j] = 1.0;
    for (int k = 0; k < asked->input_size.count; k++)
        RITZ_CHECK(take_size(r, asked->input_size.text[k], size));
    for (int64_t i = 0; asked->over_limits && limit && i < r->num_outputs; i++)
        any = any || !isnan(limit[i]);
    RITZ_REFUSE_IF(asked->over_limits && !any, RITZ_ERR_ARGUMENT,
                   "--over-limits: no output of the model has a limit");
    *out = (ritz_scales){.output = asked->over_limits ? limit : NULL,
                         .input = size};
    return RITZ_OK;
}

static void add_measure(cli_run *run, const char *name, double value,
                        double hertz)
{
    json_t *item = json_object();
    json_t *measures = json_object_get(run->report, "measures");

    json_object_set_new(item, "name", cli_string(name));
    json_object_set_new(item, "value", cli_real(value));
    json_object_set_new(item, "at_hz", cli_real(hertz));
    json_object_set_new(item, "limit", json_null());
    json_object_set_new(item, "verdict", json_string("pass"));
    if (!measures) {
        measures = json_array();
        json_object_set_new(run->report, "measures", measures);
    }
    json_array_append_new(measures, item);
}

ritz_status responses_singular(cli_run *run, const responses_wish *asked,
                               const model *m, ritz_responder *responder,
                               ritz_response *response)
{
    ritz_status status = RITZ_OK;
    ritz_scales scales = {0};
    double *size = NULL;
    double hertz = 0.0, value = 0.0;

    if (!asked->singular)
        return RITZ_OK;
    size = calloc((size_t)response->num_inputs + 1, sizeof *size);
    RITZ_FAIL_IF(!size, RITZ_ERR_MEMORY, "no memory for sizes of inputs");
    RITZ_TRY(find_scales(asked, m, response, size, &scales));
    RITZ_TRY(ritz_singular_of(&scales, response));
    RITZ_TRY(ritz_singular_peak(response, &scales, responder, &hertz, &value));
    response->singular_peak[0] = hertz;
    response->singular_peak[1] = value;
    cli_say(run, "%-41s %14.6e %14.7g", "largest singular value", value, hertz);
    if (isinf(value))
        cli_warn(run, "it is infinite: a pole at %.7g Hz is not damped", hertz);
    add_measure(run, "largest singular value", value, hertz);
done:
    free(size);
    return status;
}

ritz_status responses_states(const model *m, const ritz_damping *damping,
                             ritz_state_space *made,
                             const ritz_state_space **out)
{
    ritz_second_order view = {0};
    ritz_reduced bare = {0}; /* borrowed; dampers are in K and D already */

    *out = NULL;
    if (m->kind == MODEL_STATES) {
        *out = &m->states;
        return RITZ_OK;
    }
    if (m->kind == MODEL_COMPONENT) {
        if (m->component.num_dofs > MOST_DOFS || m->component.K4.colptr)
            return RITZ_OK;
        RITZ_CHECK(ritz_state_space_of_component(&m->component, damping, made));
    } else {
        view = model_look(m).matrices;
        if (view.K4 && view.K4->val)
            return RITZ_OK;
        bare.K = *view.K;
        bare.M = *view.M;
        bare.io = *view.io;
        if (view.D)
            bare.D = *view.D;
        RITZ_CHECK(ritz_state_space_of_reduced(&bare, damping, made));
    }
    *out = made;
    return RITZ_OK;
}

static json_t *say_zeros(cli_run *run, int64_t count,
                         const double _Complex *zero)
{
    json_t *list = json_array();

    for (int64_t k = 0; k < count; k++) {
        double size = cabs(zero[k]);
        json_t *item = json_object();

        json_object_set_new(item, "re", cli_real(creal(zero[k])));
        json_object_set_new(item, "im", cli_real(cimag(zero[k])));
        json_object_set_new(item, "hz", cli_real(size / (2.0 * RITZ_PI)));
        json_array_append_new(list, item);
        if (k > 0 && zero[k] == conj(zero[k - 1]) && cimag(zero[k]) != 0.0)
            continue; /* said with the other of the pair */
        cli_say(run, "  %14.7g Hz  %12.5g %s %.7g i rad/s",
                size / (2.0 * RITZ_PI), creal(zero[k]),
                cimag(zero[k]) != 0.0 ? "+-" : "+", fabs(cimag(zero[k])));
    }
    if (count == 0)
        cli_say(run, "  none is finite");
    return list;
}

/* Second-order models as they are: their modes tell more than states. */
static ritz_status zeros_of(const model *m, const ritz_damping *damping,
                            const int64_t at[2], int64_t *count,
                            double _Complex **out)
{
    ritz_second_order view = {0};

    if (m->kind == MODEL_STATES)
        return ritz_zeros_states(&m->states, at[0], at[1], count, out);
    if (m->kind == MODEL_COMPONENT)
        return ritz_zeros_component(&m->component, damping, at[0], at[1], count,
                                    out);
    view = model_look(m).matrices;
    return ritz_zeros_dense(&view, damping, at[0], at[1], count, out);
}

/* What drives and is seen of it, by name. */
static ritz_io names_of(const model *m)
{
    const ritz_state_space *states = &m->states;

    if (m->kind == MODEL_STATES)
        return (ritz_io){.num_inputs = states->num_inputs,
                         .num_outputs = states->num_outputs,
                         .input = states->input,
                         .output = states->output};
    return m->kind == MODEL_COMPONENT ? m->component.io
                                      : *model_look(m).matrices.io;
}

static ritz_status list(cli_run *run, const model *m,
                        const ritz_damping *damping, json_t *zeros)
{
    ritz_status status = RITZ_OK;
    const ritz_io io = names_of(m);
    double _Complex *zero = NULL;

    for (int64_t i = 0; i < io.num_outputs; i++)
        for (int64_t j = 0; j < io.num_inputs; j++) {
            const int64_t at[2] = {i, j};
            json_t *item = json_object();
            int64_t count = 0;

            json_array_append_new(zeros, item);
            json_object_set_new(item, "output", cli_string(io.output[i]));
            json_object_set_new(item, "input", cli_string(io.input[j]));
            cli_say(run, "zeros of %s / %s:", io.output[i], io.input[j]);
            status = zeros_of(m, damping, at, &count, &zero);
            if (status == RITZ_ERR_SINGULAR) {
                cli_say(run, "  %s", ritz_error_message());
                status = RITZ_OK;
                continue;
            }
            RITZ_TRY(status);
            json_object_set_new(item, "zeros", say_zeros(run, count, zero));
            free(zero);
            zero = NULL;
        }
done:
    free(zero);
    return status;
}

ritz_status responses_zeros(cli_run *run, const responses_wish *asked,
                            const model *m, const ritz_damping *damping)
{
    const ritz_component *whole = &m->component;
    json_t *zeros = NULL;

    if (!asked->zeros)
        return RITZ_OK;
    RITZ_REFUSE_IF(
        m->kind == MODEL_COMPONENT &&
            (whole->num_dofs > MOST_DOFS || whole->K4.colptr),
        RITZ_ERR_ARGUMENT,
        "--zeros: of a component with structural damping, or of more "
        "than %d dofs, there are none to be had: reduce it",
        MOST_DOFS);
    zeros = json_array();
    json_object_set_new(run->report, "zeros", zeros);
    return list(run, m, damping, zeros);
}
