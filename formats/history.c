/* Reads histories, the coordinates of a reduced component over time, one time
 * after the other. */
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/recover.h>

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 1 << 16, RATES = 3 };

/* Allocate coordinates and inputs of one time. */
static ritz_status make_room(const ritz_history_request *request,
                             ritz_history *out)
{
    out->order = request->order;
    out->num_inputs = request->num_inputs;
    out->V = request->V;
    out->unforced = request->unforced;
    RITZ_CHECK_NEW(out->x, RATES * request->order);
    RITZ_CHECK_NEW(out->f, request->num_inputs);
    if (request->V)
        RITZ_CHECK_NEW(out->q, RATES * request->V->nrow);
    return RITZ_OK;
}

/* Find the format of a file by its first bytes, and rewind the file. */
static ritz_status find_format(FILE *file, const ritz_history_format **out)
{
    RITZ_OWN_ARRAY char *head = NULL;
    int64_t size = 0;

    RITZ_CHECK_NEW(head, HEAD);
    size = (int64_t)fread(head, 1, HEAD, file);
    RITZ_REFUSE_IF(ferror(file) || fseek(file, 0, SEEK_SET) != 0, RITZ_ERR_FILE,
                   "cannot be read from its beginning: %s", strerror(errno));
    for (const ritz_history_format *const *f = ritz_history_formats; *f; f++)
        if ((*f)->recognise(head, size)) {
            *out = *f;
            return RITZ_OK;
        }
    return ritz_fail(RITZ_ERR_FORMAT,
                     "is no history that is known: a table of text, a file "
                     ".mod of MBDyn, or a container of ritz-simulate");
}

static ritz_status open_history(const char *path,
                                const ritz_history_request *request,
                                ritz_history *out)
{
    FILE *file = fopen(path, "re");
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(!file, RITZ_ERR_FILE, "cannot be opened: %s",
                   strerror(errno));
    status = find_format(file, &out->format);
    if (status == RITZ_OK)
        status = make_room(request, out);
    if (status == RITZ_OK)
        return out->format->begin(file, request, out);
    fclose(file);
    return status;
}

ritz_status ritz_history_open(const char *path,
                              const ritz_history_request *request,
                              ritz_history *out)
{
    RITZ_OWN(ritz_history) history = {0};

    RITZ_CHECK_IN(path, open_history(path, request, &history));
    RITZ_MOVE(*out, history);
    return RITZ_OK;
}

/* Of a body, or of the whole model: the first coordinate and their number. */
static ritz_status find_coordinates(const ritz_simulation *s,
                                    const ritz_history_request *request,
                                    ritz_history *history)
{
    const ritz_names names = {"body", s->num_blocks, (const char *)s->block,
                              sizeof *s->block};
    const char *whose = request->body ? request->body : "the time response";
    int64_t count = s->num_coordinates, k = 0;

    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT,
                   "the time response has no coordinates: ritz-simulate "
                   "--coordinates stores them");
    RITZ_REFUSE_IF(!request->body && s->num_blocks > 0, RITZ_ERR_ARGUMENT,
                   "the time response has the coordinates of %" PRId64
                   " bodies: of which one? name it by --body",
                   s->num_blocks);
    if (request->body) {
        RITZ_CHECK(ritz_words_find(&names, request->body, &k));
        history->first = s->block[k].first;
        count = s->block[k].order;
    }
    RITZ_REFUSE_IF(count != request->order, RITZ_ERR_ARGUMENT,
                   "%s has %" PRId64 " coordinates, the component %" PRId64,
                   whose, count, request->order);
    return RITZ_OK;
}

ritz_status ritz_history_of_simulation(const ritz_simulation *simulation,
                                       const ritz_history_request *request,
                                       ritz_history *out)
{
    RITZ_OWN(ritz_history) history = {.simulation = simulation};

    RITZ_CHECK(find_coordinates(simulation, request, &history));
    RITZ_CHECK(make_room(request, &history));
    history.has_v = history.has_a = true;
    history.has_f =
        simulation->num_inputs == request->num_inputs && !request->unforced;
    for (int64_t j = 0; j < request->num_inputs && history.has_f; j++)
        history.has_f = strcmp(simulation->input[j], request->input[j]) == 0;
    RITZ_MOVE(*out, history);
    return RITZ_OK;
}

static void take_simulated(ritz_history *history, bool *more)
{
    const ritz_simulation *s = history->simulation;
    const double *const from[RATES] = {s->q, s->v, s->a};
    const int64_t n = history->order, k = history->at;

    *more = k < s->count;
    if (!*more)
        return;
    history->seconds = s->seconds[k];
    for (int i = 0; i < RATES; i++)
        memcpy(history->x + i * n,
               from[i] + k * s->num_coordinates + history->first,
               (size_t)n * sizeof *history->x);
    for (int64_t j = 0; history->has_f && j < history->num_inputs; j++)
        history->f[j] = s->u[k * s->num_inputs + j];
}

/* q = V x, q' = V x', q'' = V x''. */
static void turn_coordinates(ritz_history *history)
{
    const ritz_dense *V = history->V;

    memset(history->q, 0, (size_t)(RATES * V->nrow) * sizeof *history->q);
    for (int k = 0; k < RATES; k++)
        for (int64_t j = 0; j < V->ncol; j++)
            for (int64_t i = 0; i < V->nrow; i++)
                history->q[k * V->nrow + i] +=
                    ritz_dense_col(V, j)[i] * history->x[k * V->ncol + j];
}

ritz_status ritz_history_next(ritz_history *history, ritz_instant *now,
                              bool *more)
{
    const double before = history->seconds;
    const double *q = history->V ? history->q : history->x;
    const int64_t r = history->V ? history->V->nrow : history->order;

    if (history->simulation)
        take_simulated(history, more);
    else
        RITZ_CHECK(history->format->next(history, more));
    if (!*more)
        return RITZ_OK;
    RITZ_REFUSE_IF(history->at > 0 && history->seconds < before,
                   RITZ_ERR_FORMAT, "time %" PRId64 ", %g s, comes before %g s",
                   history->at + 1, history->seconds, before);
    history->at++;
    if (history->V)
        turn_coordinates(history);
    *now = (ritz_instant){
        .seconds = history->seconds,
        .q = q,
        .v = history->has_v ? q + r : NULL,
        .a = history->has_a ? q + 2 * r : NULL,
        .f = history->has_f || history->unforced ? history->f : NULL,
    };
    return RITZ_OK;
}

void ritz_history_free(ritz_history *history)
{
    if (history->own)
        history->format->end(history->own);
    RITZ_FREE(history->x, history->q, history->f);
    *history = (ritz_history){0};
}
