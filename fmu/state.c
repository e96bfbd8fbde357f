/* SPDX-License-Identifier: 0BSD */
/*
 * States of an instance that an importer keeps, to return to them. A state is
 * the token of the model, which tells its states from those of other models,
 * and numbers: the mode, the time, the inputs and the states x. An importer may
 * store these bytes in a file, so they are checked before they are taken.
 */
#include "instance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = FMU_TOKEN_SIZE - 1, NUMBERS = 2 };

static size_t size_of(const fmu_instance *s)
{
    return HEAD + (NUMBERS + s->model.num_inputs + s->model.num_states) *
                      sizeof(double);
}

static void save(const fmu_instance *s, unsigned char *bytes)
{
    const size_t p = s->model.num_inputs;
    const double head[NUMBERS] = {(double)s->mode, s->time};

    memcpy(bytes, s->model.token, HEAD);
    bytes += HEAD;
    memcpy(bytes, head, sizeof head);
    memcpy(bytes + sizeof head, s->u, p * sizeof(double));
    memcpy(bytes + sizeof head + p * sizeof(double), s->x,
           s->model.num_states * sizeof(double));
}

static fmu_status check(const fmu_instance *s, const unsigned char *bytes,
                        size_t size)
{
    double value = 0.0;

    if (size != size_of(s) || memcmp(bytes, s->model.token, HEAD) != 0)
        return fmu_complain(s, "it is no state of this model");
    for (size_t k = HEAD; k < size; k += sizeof value) {
        memcpy(&value, bytes + k, sizeof value);
        if (!isfinite(value) || (k == HEAD && value != 0.0 && value != 1.0 &&
                                 value != 2.0 && value != 3.0))
            return fmu_complain(s, "the state holds %g", value);
    }
    return FMU_OK;
}

/* The bytes of a state, new ones if *state is NULL; NULL: no memory. */
static unsigned char *make_room(const fmu_instance *s, void **state)
{
    if (!*state)
        *state = malloc(size_of(s));
    if (!*state)
        (void)fmu_complain(s, "there is no memory for a state");
    return *state;
}

fmu_status fmu_state_get(const fmu_instance *instance, void **state)
{
    unsigned char *bytes =
        instance && state ? make_room(instance, state) : NULL;

    if (!bytes)
        return FMU_ERROR;
    save(instance, bytes);
    return FMU_OK;
}

fmu_status fmu_state_set(fmu_instance *instance, const void *state)
{
    const unsigned char *bytes = state;
    double head[NUMBERS];
    size_t p = 0;

    if (!instance || !state ||
        check(instance, bytes, size_of(instance)) != FMU_OK)
        return FMU_ERROR;
    p = instance->model.num_inputs;
    bytes += HEAD;
    memcpy(head, bytes, sizeof head);
    instance->mode = (fmu_mode)(int)head[0];
    instance->time = head[1];
    memcpy(instance->u, bytes + sizeof head, p * sizeof(double));
    memcpy(instance->x, bytes + sizeof head + p * sizeof(double),
           instance->model.num_states * sizeof(double));
    return FMU_OK;
}

fmu_status fmu_state_free(const fmu_instance *instance, void **state)
{
    if (!instance)
        return FMU_ERROR;
    if (state) {
        free(*state);
        *state = NULL;
    }
    return FMU_OK;
}

fmu_status fmu_state_size(const fmu_instance *instance, const void *state,
                          size_t *size)
{
    if (!instance || !state)
        return FMU_ERROR;
    *size = size_of(instance);
    return FMU_OK;
}

fmu_status fmu_state_serialize(const fmu_instance *instance, const void *state,
                               unsigned char *bytes, size_t size)
{
    if (!instance || !state)
        return FMU_ERROR;
    if (size < size_of(instance))
        return fmu_complain(instance, "a state has %zu bytes, not %zu",
                            size_of(instance), size);
    memcpy(bytes, state, size_of(instance));
    return FMU_OK;
}

fmu_status fmu_state_deserialize(const fmu_instance *instance,
                                 const unsigned char *bytes, size_t size,
                                 void **state)
{
    unsigned char *to = NULL;

    if (!instance || !state || check(instance, bytes, size) != FMU_OK)
        return FMU_ERROR;
    to = make_room(instance, state);
    if (!to)
        return FMU_ERROR;
    memcpy(to, bytes, size);
    return FMU_OK;
}
