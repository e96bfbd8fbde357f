/* SPDX-License-Identifier: 0BSD */
#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Log a sentence before there is an instance, or of one. */
static void log_text(const fmu_callback *to, const char *name, const char *text)
{
    if (to->callback)
        to->log(to->callback, to->environment, name, FMU_ERROR, text);
}

fmu_status fmu_complain(const fmu_instance *instance, const char *format, ...)
{
    char text[FMU_MESSAGE_SIZE];
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    log_text(&instance->to, instance->name, text);
    return FMU_ERROR;
}

fmu_status fmu_expect(const fmu_instance *instance, fmu_mode mode,
                      const char *function)
{
    static const char *const modes[] = {"instantiated", "being initialised",
                                        "running", "terminated"};

    if (instance->mode == mode)
        return FMU_OK;
    return fmu_complain(instance, "%s: the instance is %s, it should be %s",
                        function, modes[instance->mode], modes[mode]);
}

fmu_status fmu_change_mode(fmu_instance *instance, fmu_mode from, fmu_mode to,
                           const char *function)
{
    if (!instance || fmu_expect(instance, from, function) != FMU_OK)
        return FMU_ERROR;
    instance->mode = to;
    return FMU_OK;
}

fmu_status fmu_expect_exchange(const fmu_instance *instance,
                               const char *function)
{
    if (!instance)
        return FMU_ERROR;
    if (instance->steps_itself)
        return fmu_complain(instance,
                            "%s is for model exchange, and the instance is for "
                            "co-simulation",
                            function);
    return fmu_expect(instance, FMU_RUNNING, function);
}

/* ---- a new instance ----------------------------------------------------- */

static int hex_digit(char c)
{
    static const char digits[] = "0123456789abcdefABCDEF";
    const char *at = c ? strchr(digits, c) : NULL;
    const int digit = at ? (int)(at - digits) : -1;

    return digit < 16 ? digit : digit - 6;
}

/* Where the path in a URI "file:///..." or "file:/..." begins [BernersLee2005];
 * text that is no such URI is a path. */
static const char *skip_scheme(const char *uri)
{
    static const char scheme[] = "file:";

    if (strncasecmp(uri, scheme, sizeof scheme - 1) != 0)
        return uri;
    uri += sizeof scheme - 1;
    if (strncmp(uri, "//", 2) == 0) {
        const char *path = strchr(uri + 2, '/');

        return path ? path : uri;
    }
    return uri;
}

/* FOLDER/ritz.bin; NULL: no memory. Codes such as %20 in a URI are decoded. The
 * code %00 is not: it would end the path early, and another file would be
 * read. */
static char *path_of_model(const char *resources, bool is_uri)
{
    static const char file[] = "/ritz.bin";
    const char *from = is_uri ? skip_scheme(resources) : resources;
    const bool coded = is_uri && from != resources;
    char *path = malloc(strlen(from) + sizeof file);
    char *to = path;

    if (!path)
        return NULL;
    while (*from) {
        const int high = coded && *from == '%' ? hex_digit(from[1]) : -1;
        const int low = high >= 0 ? hex_digit(from[2]) : -1;
        const bool letter = low >= 0 && high + low > 0;

        *to++ = (char)(letter ? 16 * high + low : *from);
        from += letter ? 3 : 1;
    }
    memcpy(to, file, sizeof file);
    return path;
}

/* Read the numbers of the model. If their token is not that of the request,
 * they belong to another modelDescription.xml and are refused. */
static bool read_model(const fmu_request *request, fmu_model *model,
                       char why[FMU_MESSAGE_SIZE])
{
    char *path = path_of_model(request->resources, request->is_uri);
    char cause[FMU_MESSAGE_SIZE] = "there is no memory";
    bool whole = path && fmu_model_read(path, model, cause);

    if (whole &&
        (!request->token || strcmp(model->token, request->token) != 0)) {
        snprintf(cause, sizeof cause,
                 "it belongs to the token '%s', not to '%.80s'", model->token,
                 request->token ? request->token : "");
        fmu_model_free(model);
        whole = false;
    }
    if (!whole)
        snprintf(why, FMU_MESSAGE_SIZE, "'%.150s' is refused: %.300s",
                 path ? path : "ritz.bin", cause);
    free(path);
    return whole;
}

static bool make_room(const char *name, fmu_instance *s)
{
    const size_t n = s->model.num_states + 1; /* calloc(0) may return NULL */

    s->x = calloc(n, sizeof *s->x);
    s->work = calloc(n, sizeof *s->work);
    s->u = calloc(s->model.num_inputs + 1, sizeof *s->u);
    s->name = malloc(strlen(name) + 1);
    if (s->name)
        memcpy(s->name, name, strlen(name) + 1);
    return s->x && s->work && s->u && s->name;
}

fmu_instance *fmu_new(const fmu_request *request)
{
    const char *name = request->name ? request->name : "";
    char why[FMU_MESSAGE_SIZE] = "there is no memory for an instance";
    fmu_instance *s = NULL;

    if (!request->resources) {
        log_text(&request->to, name, "no folder of resources is given");
        return NULL;
    }
    s = calloc(1, sizeof *s);
    if (s && read_model(request, &s->model, why) && make_room(name, s)) {
        s->steps_itself = request->steps_itself;
        s->to = request->to;
        return s;
    }
    log_text(&request->to, name, why);
    fmu_free(s);
    return NULL;
}

void fmu_free(fmu_instance *instance)
{
    if (!instance)
        return;
    fmu_model_free(&instance->model);
    fmu_steps_free(&instance->steps);
    free(instance->x);
    free(instance->u);
    free(instance->work);
    free(instance->name);
    free(instance);
}

fmu_status fmu_reset(fmu_instance *instance)
{
    for (size_t k = 0; k < instance->model.num_states; k++)
        instance->x[k] = 0.0;
    for (size_t k = 0; k < instance->model.num_inputs; k++)
        instance->u[k] = 0.0;
    instance->time = 0.0;
    instance->mode = FMU_INSTANTIATED;
    return FMU_OK;
}

/* ---- values ------------------------------------------------------------- */

typedef enum fmu_kind {
    FMU_TIME,
    FMU_INPUT,
    FMU_OUTPUT,
    FMU_STATE,
    FMU_DERIVATIVE,
    FMU_NOTHING,
} fmu_kind;

/* The kind of variable that a value reference names, and its number, from 0,
 * among the variables of that kind. */
static fmu_kind find_reference(const fmu_model *m, size_t reference,
                               size_t *number)
{
    const size_t count[] = {1, m->num_inputs, m->num_outputs, m->num_states,
                            m->num_states};

    for (int kind = FMU_TIME; kind < FMU_NOTHING; kind++) {
        if (reference < count[kind]) {
            *number = reference;
            return (fmu_kind)kind;
        }
        reference -= count[kind];
    }
    return FMU_NOTHING;
}

static double derivative_of(const fmu_instance *s, size_t i)
{
    const fmu_model *m = &s->model;
    const fmu_block *b = &m->block[m->block_of[i]];
    double sum = 0.0;

    for (size_t j = b->first; j < b->first + b->count; j++)
        sum += fmu_model_A(m, i, j) * s->x[j];
    for (size_t j = 0; j < m->num_inputs; j++)
        sum += m->B[j * m->num_states + i] * s->u[j];
    return sum;
}

fmu_status fmu_set_time(fmu_instance *instance, double time)
{
    if (!isfinite(time))
        return fmu_complain(instance, "a time is not finite");
    instance->time = time;
    return FMU_OK;
}

fmu_status fmu_get(const fmu_instance *instance, const unsigned *reference,
                   size_t count, double *value)
{
    const fmu_instance *s = instance;

    for (size_t k = 0; k < count; k++) {
        size_t i = 0;

        switch (find_reference(&s->model, reference[k], &i)) {
        case FMU_TIME:
            value[k] = s->time;
            break;
        case FMU_INPUT:
            value[k] = s->u[i];
            break;
        case FMU_OUTPUT:
            value[k] = fmu_model_output(&s->model, i, s->x, s->u);
            break;
        case FMU_STATE:
            value[k] = s->x[i];
            break;
        case FMU_DERIVATIVE:
            value[k] = derivative_of(s, i);
            break;
        case FMU_NOTHING:
            return fmu_complain(s, "there is no variable %u", reference[k]);
        }
    }
    return FMU_OK;
}

/* Where the value of a variable is stored; NULL, with a sentence, if the
 * variable cannot be set, or not in the present mode. */
static double *find_target(const fmu_instance *s, unsigned reference)
{
    const bool early =
        s->mode == FMU_INSTANTIATED || s->mode == FMU_INITIALISING;
    size_t i = 0;
    const fmu_kind kind = find_reference(&s->model, reference, &i);

    if (kind == FMU_INPUT && s->mode != FMU_TERMINATED)
        return &s->u[i];
    if (kind == FMU_STATE && early)
        return &s->x[i];
    (void)fmu_complain(s,
                       kind == FMU_STATE
                           ? "variable %u, a state, is set before the "
                             "simulation only"
                           : "variable %u cannot be set",
                       reference);
    return NULL;
}

fmu_status fmu_set(fmu_instance *instance, const unsigned *reference,
                   size_t count, const double *value)
{
    for (size_t k = 0; k < count; k++) {
        double *target = find_target(instance, reference[k]);

        if (!target)
            return FMU_ERROR;
        if (!isfinite(value[k]))
            return fmu_complain(instance, "variable %u is set to %g",
                                reference[k], value[k]);
        *target = value[k];
    }
    return FMU_OK;
}

/* ---- states ------------------------------------------------------------- */

static fmu_status check_count(const fmu_instance *s, size_t count)
{
    if (count == s->model.num_states)
        return FMU_OK;
    return fmu_complain(s, "there are %zu states, not %zu", s->model.num_states,
                        count);
}

/* For memcpy, which must not get NULL even if it copies nothing. */
static void copy(double *to, const double *from, size_t count)
{
    for (size_t k = 0; k < count; k++)
        to[k] = from[k];
}

fmu_status fmu_set_states(fmu_instance *instance, const double *x, size_t count)
{
    if (check_count(instance, count) != FMU_OK)
        return FMU_ERROR;
    for (size_t k = 0; k < count; k++)
        if (!isfinite(x[k]))
            return fmu_complain(instance, "state %zu is set to %g", k + 1,
                                x[k]);
    copy(instance->x, x, count);
    return FMU_OK;
}

fmu_status fmu_get_states(const fmu_instance *instance, double *x, size_t count)
{
    if (check_count(instance, count) != FMU_OK)
        return FMU_ERROR;
    copy(x, instance->x, count);
    return FMU_OK;
}

fmu_status fmu_get_nominals(const fmu_instance *instance, double *x,
                            size_t count)
{
    if (check_count(instance, count) != FMU_OK)
        return FMU_ERROR;
    copy(x, instance->model.nominal, count);
    return FMU_OK;
}

fmu_status fmu_get_derivatives(const fmu_instance *instance, double *dx,
                               size_t count)
{
    if (check_count(instance, count) != FMU_OK)
        return FMU_ERROR;
    fmu_model_derive(&instance->model, instance->x, instance->u, dx);
    return FMU_OK;
}

fmu_status fmu_do_step(fmu_instance *instance, double from, double h)
{
    char why[FMU_MESSAGE_SIZE];
    double *before = instance->x;

    if (!instance->steps_itself)
        return fmu_complain(instance, "an instance for model exchange makes "
                                      "no steps");
    if (fmu_expect(instance, FMU_RUNNING, "a step") != FMU_OK)
        return FMU_ERROR;
    if (!(h > 0.0) || !isfinite(from) || !isfinite(from + h))
        return fmu_complain(instance, "no step from %g over %g is possible",
                            from, h);
    if (!fmu_propagate(&instance->model, &instance->steps, h, instance->u,
                       before, instance->work, why))
        return fmu_complain(instance, "%s", why);
    instance->x = instance->work;
    instance->work = before;
    instance->time = from + h;
    return FMU_OK;
}

/* ---- derivatives -------------------------------------------------------- */

/* d unknown / d known, an entry of A, B, C or D; NAN if @p unknown is neither
 * an output nor a derivative, or @p known neither an input nor a state. */
static double partial(const fmu_model *m, unsigned unknown, unsigned known)
{
    size_t i = 0, j = 0;
    const fmu_kind of = find_reference(m, unknown, &i);
    const fmu_kind by = find_reference(m, known, &j);

    if (of == FMU_OUTPUT && by == FMU_INPUT)
        return m->D[j * m->num_outputs + i];
    if (of == FMU_OUTPUT && by == FMU_STATE)
        return m->C[j * m->num_outputs + i];
    if (of == FMU_DERIVATIVE && by == FMU_INPUT)
        return m->B[j * m->num_states + i];
    if (of == FMU_DERIVATIVE && by == FMU_STATE)
        return fmu_model_A(m, i, j);
    return (double)NAN;
}

fmu_status fmu_differentiate(const fmu_instance *instance,
                             const fmu_partials *partials, bool adjoint,
                             const double *seed, double *out)
{
    const size_t rows = adjoint ? partials->num_knowns : partials->num_unknowns;
    const size_t cols = adjoint ? partials->num_unknowns : partials->num_knowns;

    for (size_t r = 0; r < rows; r++) {
        out[r] = 0.0;
        for (size_t c = 0; c < cols; c++) {
            const unsigned unknown = partials->unknown[adjoint ? c : r];
            const unsigned known = partials->known[adjoint ? r : c];
            const double entry = partial(&instance->model, unknown, known);

            if (isnan(entry))
                return fmu_complain(instance,
                                    "variable %u has no derivative with "
                                    "respect to variable %u",
                                    unknown, known);
            out[r] += entry * seed[c];
        }
    }
    return FMU_OK;
}

fmu_status fmu_dependencies(const fmu_instance *instance, unsigned unknown,
                            unsigned *known, size_t *count)
{
    const fmu_model *m = &instance->model;
    const size_t first_state = 1 + m->num_inputs + m->num_outputs;
    const size_t first_derivative = first_state + m->num_states;
    size_t i = 0;
    const fmu_kind kind = find_reference(m, unknown, &i);

    *count = 0;
    if (kind != FMU_OUTPUT && kind != FMU_DERIVATIVE)
        return fmu_complain(instance, "variable %u depends on no other",
                            unknown);
    for (size_t k = 1; k < first_derivative; k++) {
        if (k > m->num_inputs && k < first_state)
            continue;
        if (partial(m, unknown, (unsigned)k) == 0.0)
            continue;
        if (known)
            known[*count] = (unsigned)k;
        (*count)++;
    }
    return FMU_OK;
}
