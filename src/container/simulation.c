/* Containers of time responses. */
#include "container/schema.h"

#include <inttypes.h>

/* There are all energies or none. */
static bool has_energies(const void *object)
{
    return ((const ritz_simulation *)object)->balance;
}

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
     "the integrator"},
    {"hold", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, hold), "",
     "`first` or `zero`: inputs within a step"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_simulation, damping), "",
     "as `--damping` reads it; may be empty"},
    {"step", ATTRIBUTE_REAL, RITZ_AT(ritz_simulation, step), "",
     "in seconds, which may be smaller than what was written"},
    {"order", ATTRIBUTE_WHOLE, RITZ_AT(ritz_simulation, order), "",
     "number of coordinates that were integrated", "0.."},
    {"seconds", SET_REAL, RITZ_AT(ritz_simulation, seconds), "k",
     "from 0, ascending"},
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_simulation, input), "m",
     "distinct"},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_simulation, output), "p",
     "distinct"},
    {"u", SET_REAL, RITZ_AT(ritz_simulation, u), "k m",
     "inputs, without an impulse at 0"},
    {"y", SET_REAL, RITZ_AT(ritz_simulation, y), "k p", "outputs"},
    {"energies/kinetic", SET_REAL, RITZ_AT(ritz_simulation, kinetic), "k",
     "of M; energies are of second-order models alone", .optional = "energies",
     .has = has_energies},
    {"energies/potential", SET_REAL, RITZ_AT(ritz_simulation, potential), "k",
     "of K", .optional = "energies", .has = has_energies},
    {"energies/dissipated", SET_REAL, RITZ_AT(ritz_simulation, dissipated), "k",
     "by damping up to then", .optional = "energies", .has = has_energies},
    {"energies/work", SET_REAL, RITZ_AT(ritz_simulation, work), "k",
     "of the inputs up to then", .optional = "energies", .has = has_energies},
    {"energies/balance", SET_REAL, RITZ_AT(ritz_simulation, balance), "k",
     "kinetic + potential + dissipated - work - what was there at the start",
     .optional = "energies", .has = has_energies},
    {0},
};

const ritz_schema ritz_schema_simulation = {
    .name = "simulation",
    .sizes = sizes,
    .members = members,
    .settle = settle_simulation,
};

ritz_status ritz_container_read_simulation(const char *path,
                                           ritz_simulation *out)
{
    ritz_simulation simulation = {0};
    ritz_status status =
        ritz_schema_read(path, &ritz_schema_simulation, &simulation, NULL);

    if (status == RITZ_OK)
        *out = simulation;
    else
        ritz_simulation_free(&simulation);
    return status;
}

ritz_status ritz_container_write_simulation(const char *path,
                                            const ritz_simulation *simulation,
                                            const ritz_stamp *stamp)
{
    return ritz_schema_write(path, &ritz_schema_simulation, simulation, "",
                             stamp);
}
