/*
 * Resources of an FMU as its program reads them, with the checksum that they
 * should have, and a step of what they describe.
 */
#include "fuzz.h"

#include "fmu/propagate.h"

#include <stdlib.h>
#include <string.h>

/* FNV-1a of all behind it [FowlerNollVo2019]. */
static void mend_checksum(unsigned char *bytes, size_t size)
{
    enum { AT_HASH = 8, AT_REST = 16 };
    uint64_t hash = 14695981039346656037U;

    for (size_t k = AT_REST; k < size; k++)
        hash = (hash ^ bytes[k]) * 1099511628211U;
    if (size >= AT_REST)
        memcpy(bytes + AT_HASH, &hash, sizeof hash);
}

static void step_once(const fmu_model *m)
{
    fmu_steps steps = {0};
    char why[FMU_MESSAGE_SIZE] = "";
    double *room = calloc(2 * m->num_states + m->num_inputs + 1, sizeof *room);

    if (!room)
        abort();
    for (size_t k = 0; k < m->num_states + m->num_inputs; k++)
        room[k] = 1.0;
    if (!fmu_propagate(m, &steps, 0.5, room + m->num_states, room,
                       room + m->num_states + m->num_inputs, why) &&
        !*why)
        abort();
    fmu_steps_free(&steps);
    free(room);
}

void fuzz_fmu(const char *bytes, int64_t size)
{
    fmu_model m = {0};
    char why[FMU_MESSAGE_SIZE] = "";
    unsigned char *copy = malloc((size_t)size + 1);

    if (!copy)
        abort();
    memcpy(copy, bytes, (size_t)size);
    mend_checksum(copy, (size_t)size);
    if (fmu_model_parse(copy, (size_t)size, &m, why))
        step_once(&m);
    else if (!*why)
        abort();
    fmu_model_free(&m);
    free(copy);
}
