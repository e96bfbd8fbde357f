#include "print/neighbours.h"

#include <string.h>

enum { MAX_PATH = 4096 };

/* One neighbour as it was typed. */
typedef struct neighbour {
    char port[RITZ_NAME_SIZE], other[RITZ_NAME_SIZE];
    char path[MAX_PATH];
} neighbour;

/* "PORT=FILE:PORT": the last ':' ends the file's name. */
static ritz_status split(const char *text, neighbour *out)
{
    const char *equals = strchr(text, '=');
    const char *colon = strrchr(text, ':');
    size_t length = equals ? (size_t)(equals - text) : 0;
    size_t path = equals && colon > equals ? (size_t)(colon - equals - 1) : 0;

    RITZ_REFUSE_IF(length == 0 || path == 0 || colon[1] == '\0',
                   RITZ_ERR_ARGUMENT, "'%s' is not PORT=FILE:PORT", text);
    RITZ_REFUSE_IF(length >= sizeof out->port || path >= sizeof out->path ||
                       strlen(colon + 1) >= sizeof out->other,
                   RITZ_ERR_ARGUMENT, "'%.60s...' has too long a name", text);
    snprintf(out->port, sizeof out->port, "%.*s", (int)length, text);
    snprintf(out->path, sizeof out->path, "%.*s", (int)path, equals + 1);
    snprintf(out->other, sizeof out->other, "%s", colon + 1);
    return RITZ_OK;
}

static ritz_status add(cli_run *run, const char *text,
                       const ritz_component *component,
                       const ritz_dofs *attached, ritz_neighbour *sum)
{
    ritz_status status = RITZ_OK;
    neighbour of = {0};
    model far = {0};
    ritz_joint joint = {.type = RITZ_JOINT_FIXED, .name = "neighbour"};
    ritz_joined side[2] = {{run->operand[1], component}, {0}};

    RITZ_TRY(split(text, &of));
    RITZ_TRY(model_read(run, of.path, MODEL_COMPONENT, &far));
    side[1] = (ritz_joined){of.path, &far.component};
    snprintf(joint.between[0].port, sizeof joint.between[0].port, "%s",
             of.port);
    snprintf(joint.between[1].port, sizeof joint.between[1].port, "%s",
             of.other);
    RITZ_TRY(ritz_joint_neighbour(&joint, NULL, side, 0, attached, sum));
done:
    model_free(&far);
    return status;
}

ritz_status neighbours_read(cli_run *run, const cli_list *given,
                            const ritz_component *component,
                            const ritz_dofs *attached, ritz_neighbour *out)
{
    ritz_status status = RITZ_OK;
    ritz_neighbour sum = {0};

    RITZ_TRY(ritz_neighbour_new(attached->count, &sum));
    for (int k = 0; k < given->count; k++)
        RITZ_TRY_IN("--neighbour",
                    add(run, given->text[k], component, attached, &sum));
    *out = sum;
    sum = (ritz_neighbour){0};
done:
    ritz_neighbour_free(&sum);
    return status;
}
