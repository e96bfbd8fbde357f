/* Containers of time responses. */
#include "container/schema.h"

#include <inttypes.h>

static ritz_status settle_simulation(const ritz_place *place)
{
    const ritz_simulation *s = place->target;

    for (int64_t k = 1; k < s->count; k++)
        RITZ_REFUSE_IF(s->seconds[k] <= s->seconds[k - 1], RITZ_ERR_FORMAT,
                       "'seconds' does not ascend at value %" PRId64, k + 1);
    return RITZ_OK;
}

static const ritz_size sizes[] = {
    {'k', .offset = offsetof(ritz_simulation, count), "seconds"},
    {'m', .offset = offsetof(ritz_simulation, num_inputs), "inputs/names"},
    {'p', .offset = offsetof(ritz_simulation, num_outputs), "outputs/names"},
    {0},
};

static const ritz_member members[] = {
    {"method", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, integrator), "",
     "integrator that computed the response"},
    {"hold", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, hold), "",
     "how inputs vary within a step: `first` linearly, `zero` not at all"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, damping), "",
     "damping, as `--damping` reads it; may be empty"},
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
    {0},
};

const ritz_schema ritz_schema_simulation = {
    .name = "simulation",
    .sizes = sizes,
    .members = members,
    .settle = settle_simulation,
};
