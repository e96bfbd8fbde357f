/* What a frequency response and a time response hold. */
#include "print/print.h"

ritz_status describe_response(cli_run *run, const ritz_response *r)
{
    sink_field(run, "kind", "points,from_hz,to_hz",
               "frequency response, %ld points, %g to %g Hz", r->count,
               r->count > 0 ? r->hertz[0] : (double)NAN,
               r->count > 0 ? r->hertz[r->count - 1] : (double)NAN);
    sink_set(run, "damping", "%s", r->damping);
    sink_field(run, "method", "method", "%s, damping %s", r->method,
               *r->damping ? r->damping : "of the matrices");
    sink_names(run, "inputs", "inputs", r->num_inputs, r->input);
    sink_names(run, "outputs", "outputs", r->num_outputs, r->output);
    return RITZ_OK;
}

/* Largest |value| of an output, and when. */
static double find_peak(const ritz_simulation *s, int64_t i, double *when)
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

/* Largest error of the energy balance over the largest energy. Energies that are
   rounding, as those of a rigid body that was moved, balance with nothing: their
   size is printed. */
static void describe_energies(cli_run *run, const ritz_simulation *s)
{
    double off = 0.0, size = 0.0;

    if (!s->balance)
        return;
    for (int64_t k = 0; k < s->count; k++) {
        off = fmax(off, fabs(s->balance[k]));
        size = fmax(size, fabs(s->kinetic[k]) + fabs(s->potential[k]) +
                              fabs(s->dissipated[k]));
    }
    if (size > s->energy_rounding) {
        sink_field(run, "energies", "imbalance",
                   "balance to %.1e of the largest", off / size);
        return;
    }
    sink_set(run, "imbalance", "%g", nan(""));
    sink_field(run, "energies", "largest_energy", "at most %.1e%s", size,
               size > 0.0 ? ", which is rounding" : "");
}

/* Least, greatest and last value of each diagnostic. */
static void describe_diagnostics(cli_run *run, const ritz_simulation *s)
{
    if (s->num_diagnostics == 0)
        return;
    SINK_ITEMS(run, "diagnostics", j, s->num_diagnostics) {
        const double *value = s->diagnosis + j;
        double least = HUGE_VAL, most = -HUGE_VAL, last = 0.0;

        for (int64_t k = 0; k < s->count; k++) {
            last = value[k * s->num_diagnostics];
            least = fmin(least, last);
            most = fmax(most, last);
        }
        sink_say(run, ",name,least,most,last",
                 "  %-14s %-20s %.6g to %.6g, %.6g at the end",
                 j > 0 ? "" : "diagnostics", s->diagnostic[j], least, most,
                 last);
    }
}

ritz_status describe_simulation(cli_run *run, const ritz_simulation *s)
{
    double end = s->count > 0 ? s->seconds[s->count - 1] : 0.0;

    sink_set(run, "order,damping", "%ld %s", s->order, s->damping);
    sink_field(run, "kind", "points,seconds",
               "time response, %ld times to %g s", s->count, end);
    sink_field(run, "method", "method,step,hold",
               "%s, step %g s, inputs held to order %s, damping %s",
               s->integrator, s->step, s->hold,
               *s->damping ? s->damping : "of the matrices");
    sink_names(run, "inputs", "inputs", s->num_inputs, s->input);
    sink_names(run, NULL, "outputs", s->num_outputs, s->output);
    SINK_EACH(run, "peaks", i, s->num_outputs) {
        double when = 0.0;
        double most = find_peak(s, i, &when);

        cli_say(run, "  %-14s %-20s at most %.6e at %g s",
                i > 0 ? "" : "outputs", s->output[i], most, when);
        sink_add(run, "%g", most);
    }
    sink_set(run, "coordinates", "%ld", s->num_coordinates);
    if (s->num_coordinates > 0)
        sink_field(run, "coordinates", "", "%ld, with rates and accelerations",
                   s->num_coordinates);
    SINK_EACH(run, "bodies", k, s->num_blocks) {
        cli_say(run, "  %-14s %-20s %ld coordinates%s", k > 0 ? "" : "bodies",
                s->block[k].name, s->block[k].order,
                s->block[k].turns ? ", turned by the joint" : "");
        sink_add(run, "%s", s->block[k].name);
    }
    if (*s->spin)
        sink_field(run, "spin", "spin", "%s", s->spin);
    describe_energies(run, s);
    describe_diagnostics(run, s);
    return RITZ_OK;
}
