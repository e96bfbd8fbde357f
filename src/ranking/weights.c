/* Weights of inputs and outputs as text, and what they make of a model's io. */
#include "ranking/weights.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "torque=4", the text of which ends at `end`. */
static ritz_status take_one(const char *text, const char *end, ritz_weight *out)
{
    const char *equal = memchr(text, '=', (size_t)(end - text));
    char name[RITZ_NAME_SIZE];
    char number[RITZ_NAME_SIZE];

    RITZ_REFUSE_IF(!equal || equal - text >= RITZ_NAME_SIZE ||
                       end - equal > RITZ_NAME_SIZE,
                   RITZ_ERR_ARGUMENT, "'%.*s' is not NAME=WEIGHT",
                   (int)(end - text < 60 ? end - text : 60), text);
    (void)snprintf(name, sizeof name, "%.*s", (int)(equal - text), text);
    (void)snprintf(number, sizeof number, "%.*s", (int)(end - equal - 1),
                   equal + 1);
    RITZ_CHECK(ritz_name_copy(name, out->name));
    RITZ_REFUSE_IF(!ritz_text_real(number, &out->value) || out->value < 0.0,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is no weight of '%s': a number, not negative", number,
                   name);
    return RITZ_OK;
}

static ritz_status take_all(const char *text, int64_t *count, ritz_weight **out)
{
    ritz_status status = RITZ_OK;
    ritz_weight *list = NULL;
    int64_t most = 1, n = 0;

    for (const char *c = text; *c; c++)
        most += *c == ',';
    RITZ_NEW(list, most);
    for (const char *c = text; n < most; n++) {
        const char *end = c + strcspn(c, ",");

        RITZ_TRY(take_one(c, end, &list[n]));
        for (int64_t k = 0; k < n; k++)
            RITZ_FAIL_IF(strcmp(list[k].name, list[n].name) == 0,
                         RITZ_ERR_ARGUMENT, "'%s' has two weights",
                         list[n].name);
        c = end + 1;
    }
    *count = n;
    *out = list;
    list = NULL;
done:
    free(list);
    return status;
}

ritz_status ritz_weights_parse(const char *inputs, const char *outputs,
                               ritz_weights *out)
{
    ritz_status status = RITZ_OK;
    ritz_weights weights = {0};

    if (inputs)
        RITZ_TRY_IN("weights of inputs",
                    take_all(inputs, &weights.num_inputs, &weights.input));
    if (outputs)
        RITZ_TRY_IN("weights of outputs",
                    take_all(outputs, &weights.num_outputs, &weights.output));
    *out = weights;
    weights = (ritz_weights){0};
done:
    ritz_weights_free(&weights);
    return status;
}

void ritz_weights_free(ritz_weights *weights)
{
    free(weights->input);
    free(weights->output);
    *weights = (ritz_weights){0};
}

/* Index of what a weight names, or a sentence that names the nearest. */
static ritz_status find(const ritz_weight *weight, const char *kind,
                        int64_t count, char (*name)[RITZ_NAME_SIZE],
                        int64_t *out)
{
    const char *near = NULL;

    for (int64_t k = 0; k < count; k++)
        if (strcmp(name[k], weight->name) == 0) {
            *out = k;
            return RITZ_OK;
        }
    if (count > 0)
        near = ritz_text_nearest(weight->name, count, name[0], RITZ_NAME_SIZE);
    RITZ_REFUSE_IF(true, RITZ_ERR_ARGUMENT,
                   "there is no %s '%s' to weigh%s%s%s", kind, weight->name,
                   near ? ", is '" : "", near ? near : "",
                   near ? "' meant?" : "");
    return RITZ_OK;
}

ritz_status ritz_weights_apply(const ritz_weights *weights, ritz_io *io)
{
    int64_t at = 0;

    for (int64_t k = 0; k < weights->num_inputs; k++) {
        const ritz_weight *w = &weights->input[k];

        RITZ_CHECK(find(w, "input", io->num_inputs, io->input, &at));
        for (int64_t i = 0; i < io->B.nrow; i++)
            ritz_dense_col(&io->B, at)[i] *= sqrt(w->value);
    }
    for (int64_t k = 0; k < weights->num_outputs; k++) {
        const ritz_weight *w = &weights->output[k];

        RITZ_CHECK(find(w, "output", io->num_outputs, io->output, &at));
        io->limit[at] = 1.0 / sqrt(w->value); /* of 0, infinite */
    }
    return RITZ_OK;
}
