/* Which signals of a plant and a controller meet. */
#include "base/alloc.h"

#include <ritz/closed_loop.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static int64_t find(int64_t count, const char (*name)[RITZ_NAME_SIZE],
                    const char *word)
{
    for (int64_t k = 0; k < count; k++)
        if (strcmp(name[k], word) == 0)
            return k;
    return -1;
}

ritz_status ritz_loop_check(const ritz_loop *loop, const ritz_ends *plant,
                            const ritz_ends *controller)
{
    RITZ_REFUSE_IF(loop->num_measured != controller->num_inputs ||
                       loop->num_driven != controller->num_outputs,
                   RITZ_ERR_ARGUMENT,
                   "a loop of %" PRId64 " measured and %" PRId64
                   " driven signals is not of this controller",
                   loop->num_measured, loop->num_driven);
    for (int64_t k = 0; k < loop->num_measured; k++)
        RITZ_REFUSE_IF(loop->measured[k] < 0 ||
                           loop->measured[k] >= plant->num_outputs,
                       RITZ_ERR_ARGUMENT, "the plant has no output %" PRId64,
                       loop->measured[k] + 1);
    for (int64_t k = 0; k < loop->num_driven; k++)
        RITZ_REFUSE_IF(loop->driven[k] < 0 ||
                           loop->driven[k] >= plant->num_inputs,
                       RITZ_ERR_ARGUMENT, "the plant has no input %" PRId64,
                       loop->driven[k] + 1);
    return RITZ_OK;
}

/* One place is taken once. */
static ritz_status put(int64_t *place, int64_t index, const char *name)
{
    RITZ_REFUSE_IF(*place >= 0, RITZ_ERR_ARGUMENT,
                   "'%s' of the controller is connected twice", name);
    *place = index;
    return RITZ_OK;
}

/* "OUT=IN", in whichever direction there are such names. */
static ritz_status take_pair(const ritz_ends *plant, const ritz_ends *control,
                             const char *pair, ritz_loop *loop)
{
    ritz_status status = RITZ_OK;
    const char *equals = strchr(pair, '=');
    const char *in = equals ? equals + 1 : "";
    char out[RITZ_NAME_SIZE] = "";
    int64_t from = -1, to = -1, back_from = -1, back_to = -1;

    RITZ_FAIL_IF(!equals || equals == pair || !*in ||
                     equals - pair >= RITZ_NAME_SIZE,
                 RITZ_ERR_ARGUMENT, "'%.80s' is not of the form OUT=IN", pair);
    memcpy(out, pair, (size_t)(equals - pair));
    from = find(plant->num_outputs, plant->output, out);
    to = find(control->num_inputs, control->input, in);
    back_from = find(control->num_outputs, control->output, out);
    back_to = find(plant->num_inputs, plant->input, in);
    RITZ_FAIL_IF(from >= 0 && to >= 0 && back_from >= 0 && back_to >= 0,
                 RITZ_ERR_ARGUMENT,
                 "'%s' can be read both ways: plant and controller have both "
                 "names",
                 pair);
    if (from >= 0 && to >= 0)
        RITZ_TRY(put(&loop->measured[to], from, control->input[to]));
    else if (back_from >= 0 && back_to >= 0)
        RITZ_TRY(
            put(&loop->driven[back_from], back_to, control->output[back_from]));
    else
        status = ritz_fail(
            RITZ_ERR_ARGUMENT,
            "'%s' joins no output of the plant to an input of the controller, "
            "nor one of the controller to one of the plant",
            pair);
done:
    return status;
}

/* What no pair named, by its own name. */
static ritz_status fill(int64_t count, const char (*name)[RITZ_NAME_SIZE],
                        int64_t others, const char (*other)[RITZ_NAME_SIZE],
                        const char *what, int64_t *place)
{
    const char *near = NULL;

    for (int64_t k = 0; k < count; k++) {
        if (place[k] >= 0)
            continue;
        place[k] = find(others, other, name[k]);
        if (place[k] >= 0)
            continue;
        near = others > 0 ? ritz_text_nearest(name[k], others, other[0],
                                              RITZ_NAME_SIZE)
                          : NULL;
        RITZ_REFUSE_IF(near != NULL, RITZ_ERR_ARGUMENT,
                       "the plant has no %s '%s' for the controller, is '%s' "
                       "meant?",
                       what, name[k], near);
        RITZ_REFUSE_IF(near == NULL, RITZ_ERR_ARGUMENT,
                       "the plant has no %s '%s' for the controller", what,
                       name[k]);
    }
    return RITZ_OK;
}

ritz_status ritz_loop_match(const ritz_ends *plant, const ritz_ends *controller,
                            int64_t num_pairs, const char *const *pair,
                            ritz_loop *out)
{
    ritz_status status = RITZ_OK;
    ritz_loop loop = {.num_measured = controller->num_inputs,
                      .num_driven = controller->num_outputs};

    RITZ_FAIL_IF(loop.num_measured == 0 || loop.num_driven == 0,
                 RITZ_ERR_ARGUMENT, "the controller has no %s: it is none",
                 loop.num_measured == 0 ? "inputs" : "outputs");
    RITZ_NEW(loop.measured, loop.num_measured);
    RITZ_NEW(loop.driven, loop.num_driven);
    for (int64_t k = 0; k < loop.num_measured; k++)
        loop.measured[k] = -1;
    for (int64_t k = 0; k < loop.num_driven; k++)
        loop.driven[k] = -1;
    for (int64_t k = 0; k < num_pairs; k++)
        RITZ_TRY(take_pair(plant, controller, pair[k], &loop));
    RITZ_TRY(fill(loop.num_measured, controller->input, plant->num_outputs,
                  plant->output, "output", loop.measured));
    RITZ_TRY(fill(loop.num_driven, controller->output, plant->num_inputs,
                  plant->input, "input", loop.driven));
    *out = loop;
    loop = (ritz_loop){0};
done:
    ritz_loop_free(&loop);
    return status;
}

void ritz_loop_free(ritz_loop *loop)
{
    free(loop->measured);
    free(loop->driven);
    *loop = (ritz_loop){0};
}
