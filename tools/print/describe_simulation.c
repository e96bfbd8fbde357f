/* What is in a time response: times, extremes, whether energies balance. */
#include "print/describe.h"

#include <math.h>

static json_t *names(int64_t count, char (*name)[RITZ_NAME_SIZE])
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, cli_string(name[k]));
    return array;
}

/* Largest |value| of a column, and when. */
static double peak(const ritz_simulation *s, int64_t i, double *when)
{
    double most = 0.0;

    *when = s->count > 0 ? s->seconds[0] : 0.0;
    for (int64_t k = 0; k < s->count; k++) {
        double y = fabs(s->y[k * s->num_outputs + i]);

        if (y > most) {
            most = y;
            *when = s->seconds[k];
        }
    }
    return most;
}

/* Largest |balance| over the largest energy that was about. */
static double imbalance(const ritz_simulation *s)
{
    double off = 0.0, size = 0.0;

    for (int64_t k = 0; k < s->count; k++) {
        off = fmax(off, fabs(s->balance[k]));
        size = fmax(size, fabs(s->kinetic[k]) + fabs(s->potential[k]) +
                              fabs(s->dissipated[k]));
    }
    return size > 0.0 ? off / size : 0.0;
}

void describe_simulation(const cli_run *run, json_t *keys,
                         const ritz_simulation *s)
{
    double end = s->count > 0 ? s->seconds[s->count - 1] : 0.0;
    json_t *peaks = json_array();

    cli_say(run, "  %-14s time response, %lld times to %g s", "kind",
            (long long)s->count, end);
    cli_say(run, "  %-14s %s, step %g s, inputs held to order %s, damping %s",
            "method", s->integrator, s->step, s->hold,
            *s->damping ? s->damping : "of the matrices");
    for (int64_t j = 0; j < s->num_inputs; j++)
        cli_say(run, "  %-14s %s", j > 0 ? "" : "inputs", s->input[j]);
    for (int64_t i = 0; i < s->num_outputs; i++) {
        double when = 0.0;
        double most = peak(s, i, &when);

        cli_say(run, "  %-14s %-20s at most %.6e at %g s",
                i > 0 ? "" : "outputs", s->output[i], most, when);
        json_array_append_new(peaks, cli_real(most));
    }
    if (s->balance) {
        cli_say(run, "  %-14s balance to %.1e of the largest", "energies",
                imbalance(s));
        json_object_set_new(keys, "imbalance", cli_real(imbalance(s)));
    }
    json_object_set_new(keys, "kind", json_string("simulation"));
    json_object_set_new(keys, "points", json_integer((json_int_t)s->count));
    json_object_set_new(keys, "seconds", cli_real(end));
    json_object_set_new(keys, "method", cli_string(s->integrator));
    json_object_set_new(keys, "hold", cli_string(s->hold));
    json_object_set_new(keys, "step", cli_real(s->step));
    json_object_set_new(keys, "order", json_integer((json_int_t)s->order));
    json_object_set_new(keys, "damping", cli_string(s->damping));
    json_object_set_new(keys, "inputs", names(s->num_inputs, s->input));
    json_object_set_new(keys, "outputs", names(s->num_outputs, s->output));
    json_object_set_new(keys, "peaks", peaks);
}
