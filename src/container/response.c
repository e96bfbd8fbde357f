/* Containers of frequency and time responses. */
#include "container/schema.h"

#include <inttypes.h>
#include <math.h>

static bool has_peak(const void *object)
{
    const ritz_response *response = object;

    return response->num_singular > 0 && response->singular_peak[1] > 0.0;
}

static bool has_interpolation(const void *object)
{
    return ((const ritz_response *)object)->interpolation[0];
}

static ritz_status settle_response(const ritz_place *place)
{
    const ritz_response *r = place->target;
    const double *peak = r->singular_peak;
    int64_t fewer =
        r->num_outputs < r->num_inputs ? r->num_outputs : r->num_inputs;

    for (int64_t k = 1; k < r->count; k++)
        RITZ_REFUSE_IF(r->hertz[k] < r->hertz[k - 1], RITZ_ERR_FORMAT,
                       "'hertz' descends at value %" PRId64, k + 1);
    RITZ_REFUSE_IF(!(r->tolerance >= 0.0) || !(r->tolerance < 1.0),
                   RITZ_ERR_FORMAT, "'tolerance' is %g, not between 0 and 1",
                   r->tolerance);
    RITZ_REFUSE_IF(r->singular && r->num_singular != fewer, RITZ_ERR_FORMAT,
                   "'singular_values' is not hertz x the fewer of outputs and "
                   "inputs");
    RITZ_REFUSE_IF(
        ritz_h5_has_attribute(place->at, "singular_peak") &&
            (!(peak[0] >= 0.0) || isinf(peak[0]) || !(peak[1] > 0.0)),
        RITZ_ERR_FORMAT,
        "'singular_peak' is no frequency and no value above 0");
    return RITZ_OK;
}

/* Real (0) or imaginary part (1) of each value: re, im, ... (C 6.2.5). */
#define RITZ_COMPLEX(type, field, part)                                        \
    .offset = offsetof(type, field), .size = sizeof(double _Complex),          \
    .item = (part) * sizeof(double)

static const ritz_member response_members[] = {
    {"method", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, method), "",
     "engine that computed the response"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"hertz", SET_REAL, RITZ_AT(ritz_response, hertz), "k",
     "frequencies, not descending"},
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_response, input), "m",
     "distinct names of the inputs"},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_response, output), "p",
     "distinct names of the outputs"},
    {"H/real", SET_REAL, RITZ_COMPLEX(ritz_response, H, 0), "k p m",
     "real part of each entry of H"},
    {"H/imag", SET_REAL, RITZ_COMPLEX(ritz_response, H, 1), "k p m",
     "imaginary part of each entry of H"},
    {"interpolation", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, interpolation),
     "", "`cubic`: the points were chosen for cubic interpolation",
     .optional = "", .has = has_interpolation},
    {"tolerance", ATTRIBUTE_REAL, RITZ_AT(ritz_response, tolerance), "",
     "present with `interpolation`: its error, relative to the largest \\|H\\| "
     "of each channel",
     .values = VALUES_ANY, .has = has_interpolation},
    {"singular_values", SET_REAL, RITZ_AT(ritz_response, singular), "k s",
     "singular values of H with the requested scales, descending",
     .optional = "", .some = 's'},
    {"singular_peak", ATTRIBUTE_REAL, RITZ_AT(ritz_response, singular_peak),
     "2",
     "frequency in Hz and value of the largest singular value, also between "
     "the points; infinite at an undamped pole",
     .values = VALUES_ANY, .optional = "", .has = has_peak},
    {0},
};

const ritz_schema ritz_schema_response = {
    .name = "response",
    .sizes = {{'k', .offset = offsetof(ritz_response, count), "hertz"},
              {'m', .offset = offsetof(ritz_response, num_inputs),
               "inputs/names"},
              {'p', .offset = offsetof(ritz_response, num_outputs),
               "outputs/names"},
              {'s', .offset = offsetof(ritz_response, num_singular),
               "singular_values"}},
    .members = response_members,
    .settle = settle_response,
};

/* Time responses. */

static ritz_status settle_simulation(const ritz_place *place)
{
    const ritz_simulation *s = place->target;

    for (int64_t k = 1; k < s->count; k++)
        RITZ_REFUSE_IF(s->seconds[k] <= s->seconds[k - 1], RITZ_ERR_FORMAT,
                       "'seconds' does not ascend at value %" PRId64, k + 1);
    if (s->num_blocks > 0) {
        const ritz_block *last = &s->block[s->num_blocks - 1];

        RITZ_REFUSE_IF(last->first + last->order != s->num_coordinates,
                       RITZ_ERR_FORMAT,
                       "'blocks' have %" PRId64 " coordinates, not %" PRId64,
                       last->first + last->order, s->num_coordinates);
    }
    return RITZ_OK;
}

static bool has_rounding(const void *object)
{
    return ((const ritz_simulation *)object)->energy_rounding > 0.0;
}

static bool turns(const void *object)
{
    return *((const ritz_simulation *)object)->spin;
}

static const ritz_member simulation_members[] = {
    {"method", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, integrator), "",
     "integrator that computed the response"},
    {"hold", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, hold), "",
     "how inputs vary within a step: `first` linearly, `zero` not at all"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"spin", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, spin), "",
     "spin of the frame in which the motion is measured, as in a system",
     .optional = "", .has = turns},
    {"step", ATTRIBUTE_REAL, RITZ_AT(ritz_simulation, step), "",
     "time step in seconds, which may be smaller than that of the stored "
     "times"},
    {"order", ATTRIBUTE_WHOLE, RITZ_AT(ritz_simulation, order), "",
     "number of integrated coordinates", "0.."},
    {"seconds", SET_REAL, RITZ_AT(ritz_simulation, seconds), "k",
     "times, ascending from 0"},
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_simulation, input), "m",
     "distinct names of the inputs"},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_simulation, output), "p",
     "distinct names of the outputs"},
    {"u", SET_REAL, RITZ_AT(ritz_simulation, u), "k m",
     "inputs, without an impulse at time 0"},
    {"y", SET_REAL, RITZ_AT(ritz_simulation, y), "k p", "outputs"},
    {"energies/kinetic", SET_REAL, RITZ_AT(ritz_simulation, kinetic), "k",
     "kinetic energy; only second-order models have energies",
     .optional = "energies"},
    {"energies/potential", SET_REAL, RITZ_AT(ritz_simulation, potential), "k",
     "potential energy", .optional = "energies"},
    {"energies/dissipated", SET_REAL, RITZ_AT(ritz_simulation, dissipated), "k",
     "energy that damping has dissipated so far", .optional = "energies"},
    {"energies/work", SET_REAL, RITZ_AT(ritz_simulation, work), "k",
     "work of the inputs so far", .optional = "energies"},
    {"energies/balance", SET_REAL, RITZ_AT(ritz_simulation, balance), "k",
     "kinetic + potential + dissipated - work - energy at the start",
     .optional = "energies"},
    {"energy_rounding", ATTRIBUTE_REAL,
     RITZ_AT(ritz_simulation, energy_rounding), "",
     "energies below it are rounding of larger terms", .optional = "",
     .has = has_rounding},
    {"diagnostics/names", SET_NAMES, RITZ_AT(ritz_simulation, diagnostic), "d",
     "distinct names of values of the run itself", .optional = "diagnostics",
     .some = 'd'},
    {"diagnostics/values", SET_REAL, RITZ_AT(ritz_simulation, diagnosis), "k d",
     "these values", .optional = "diagnostics", .some = 'd'},
    {"state", SET_REAL, RITZ_AT(ritz_simulation, state), "z",
     "what a run that ended early is continued from: steps taken, energies, "
     "coordinates and rates as they are integrated, memory of the integrator",
     .optional = "", .some = 'z'},
    {"coordinates/q", SET_REAL, RITZ_AT(ritz_simulation, q), "k c",
     "coordinates of the model, of `--coordinates`", .optional = "coordinates",
     .some = 'c'},
    {"coordinates/v", SET_REAL, RITZ_AT(ritz_simulation, v), "k c",
     "first derivatives of the coordinates", .optional = "coordinates",
     .some = 'c'},
    {"coordinates/a", SET_REAL, RITZ_AT(ritz_simulation, a), "k c",
     "second derivatives of the coordinates", .optional = "coordinates",
     .some = 'c'},
    {"blocks", LIST, RITZ_LIST(ritz_simulation, block), "b", .optional = "",
     .some = 'b', .schema = &ritz_schema_block},
    {0},
};

const ritz_schema ritz_schema_simulation = {
    .name = "simulation",
    .sizes = {{'k', .offset = offsetof(ritz_simulation, count), "seconds"},
              {'m', .offset = offsetof(ritz_simulation, num_inputs),
               "inputs/names"},
              {'p', .offset = offsetof(ritz_simulation, num_outputs),
               "outputs/names"},
              {'d', .offset = offsetof(ritz_simulation, num_diagnostics),
               "diagnostics/names"},
              {'c', .offset = offsetof(ritz_simulation, num_coordinates),
               "coordinates/q"},
              {'b', .offset = offsetof(ritz_simulation, num_blocks)},
              {'z', .offset = offsetof(ritz_simulation, num_state), "state"}},
    .members = simulation_members,
    .settle = settle_simulation,
};

/* Maxima of quantities over time. */

static const ritz_member peaks_members[] = {
    {"kind", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_peaks, kind), "",
     "as in a component, like `place` and `part`"},
    {"by", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_peaks, by), "",
     "mode displacement or mode acceleration"},
    {"place", SET_WHOLE, RITZ_AT(ritz_peaks, place), "k",
     "number of an element or grid; 0: none", "0.."},
    {"part", SET_WORDS, RITZ_AT(ritz_peaks, part), "k",
     "what each row is there"},
    {"value", SET_REAL, RITZ_AT(ritz_peaks, value), "k",
     "value whose magnitude is the largest over time, with its sign"},
    {"seconds", SET_REAL, RITZ_AT(ritz_peaks, seconds), "k",
     "time at which it was reached first"},
    {0},
};

static const ritz_schema peaks_schema = {
    .name = "maxima of a quantity",
    .sizes = {{'k', .offset = offsetof(ritz_peaks, count), "place"}},
    .members = peaks_members,
};

static const ritz_member recovered_members[] = {
    {"count", ATTRIBUTE_WHOLE, RITZ_AT(ritz_recovered, count), "",
     "number of times", "0.."},
    {"begin", ATTRIBUTE_REAL, RITZ_AT(ritz_recovered, begin), "",
     "first of these times"},
    {"end", ATTRIBUTE_REAL, RITZ_AT(ritz_recovered, end), "", "last of them"},
    {"quantities", LIST, RITZ_LIST(ritz_recovered, quantity), "q",
     .schema = &peaks_schema},
    {0},
};

const ritz_schema ritz_schema_recovered = {
    .name = "recovered",
    .units = offsetof(ritz_recovered, units),
    .sizes = {{'q', .offset = offsetof(ritz_recovered, num_quantities)}},
    .members = recovered_members,
};
