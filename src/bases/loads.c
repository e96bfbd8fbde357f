#include "bases/loads.h"

#include "base/alloc.h"

#include <stdio.h>
#include <stdlib.h>

/* One kind of load: the number of its columns, and the entries of each. */
typedef struct source {
    int bit;
    const char *word;
    int64_t (*count)(const ritz_request *request);
    double (*entry)(const ritz_request *request, int64_t j, int64_t i);
    const char *(*name)(const ritz_request *request, int64_t j);
} source;

static int64_t count_attached(const ritz_request *request)
{
    return request->attached.count;
}

static double attached_entry(const ritz_request *request, int64_t j, int64_t i)
{
    return request->attached.at[j] == i ? 1.0 : 0.0;
}

static int64_t count_inputs(const ritz_request *request)
{
    return request->component->io.num_inputs;
}

static double input_entry(const ritz_request *request, int64_t j, int64_t i)
{
    return ritz_dense_col(&request->component->io.B, j)[i];
}

static const char *input_name(const ritz_request *request, int64_t j)
{
    return request->component->io.input[j];
}

/* Rows of C, then those of Cv, then those of Ca. */
static int64_t count_outputs(const ritz_request *request)
{
    return 3 * request->component->io.num_outputs;
}

static double output_entry(const ritz_request *request, int64_t j, int64_t i)
{
    const ritz_io *io = &request->component->io;
    const ritz_dense *const reads[] = {&io->C, &io->Cv, &io->Ca};

    return ritz_dense_col(reads[j / io->num_outputs], i)[j % io->num_outputs];
}

static const char *output_name(const ritz_request *request, int64_t j)
{
    const ritz_io *io = &request->component->io;

    return io->output[j % io->num_outputs];
}

static int64_t count_dampers(const ritz_request *request)
{
    return request->component->dampers.count;
}

static double damper_entry(const ritz_request *request, int64_t j, int64_t i)
{
    return ritz_dense_col(&request->component->dampers.B, j)[i];
}

static const char *damper_name(const ritz_request *request, int64_t j)
{
    return request->component->dampers.name[j];
}

static const source sources[] = {
    {RITZ_LOADS_ATTACHED, "attached", count_attached, attached_entry, NULL},
    {RITZ_LOADS_INPUTS, "input", count_inputs, input_entry, input_name},
    {RITZ_LOADS_OUTPUTS, "output", count_outputs, output_entry, output_name},
    {RITZ_LOADS_DAMPERS, "damper", count_dampers, damper_entry, damper_name},
};

/* An iterator over the loads that are not zero. */
typedef struct load_walk {
    const ritz_request *request;
    int loads;
    size_t kind;
    int64_t at; /* of that kind: the next to be looked at */
} load_walk;

static bool is_zero(const ritz_request *request, const source *from, int64_t j)
{
    for (int64_t i = 0; i < request->component->num_dofs; i++)
        if (from->entry(request, j, i) != 0.0)
            return false;
    return true;
}

/* The next source and its load; false past the last. */
static bool next_load(load_walk *w, const source **from, int64_t *j)
{
    for (; w->kind < sizeof sources / sizeof *sources; w->kind++, w->at = 0) {
        const source *here = &sources[w->kind];

        while ((w->loads & here->bit) && w->at < here->count(w->request)) {
            int64_t k = w->at++;

            if (is_zero(w->request, here, k))
                continue;
            *from = here;
            *j = k;
            return true;
        }
    }
    return false;
}

int64_t ritz_loads_count(const ritz_request *request, int loads)
{
    load_walk w = {request, loads, 0, 0};
    const source *from = NULL;
    int64_t j = 0;
    int64_t count = 0;

    while (next_load(&w, &from, &j))
        count++;
    return count;
}

/* "attached, inputs": the requested kinds. */
static const char *list_kinds(int loads, char text[64])
{
    size_t used = 0;

    text[0] = '\0';
    for (size_t k = 0; k < sizeof sources / sizeof *sources; k++)
        if (loads & sources[k].bit)
            used += (size_t)snprintf(
                text + used, 64 - used, "%s%s%s", used > 0 ? " or " : "",
                sources[k].word,
                sources[k].bit == RITZ_LOADS_ATTACHED ? " dof" : "");
    return text;
}

ritz_status ritz_loads_collect(const ritz_request *request, int loads,
                               ritz_dense *F, int64_t **dof)
{
    int64_t n = request->component->num_dofs;
    load_walk w = {request, loads, 0, 0};
    const source *from = NULL;
    RITZ_OWN(ritz_dofs) rest = {0};
    RITZ_OWN(ritz_dense) columns = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;
    int64_t count = 0;
    int64_t j = 0;
    char text[64];

    if (loads & RITZ_LOADS_ATTACHED) /* refuses repeated or impossible ones */
        RITZ_CHECK(ritz_dofs_complement(&request->attached, n, &rest));
    count = ritz_loads_count(request, loads);
    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT,
                   "there is no load to answer, no %s",
                   list_kinds(loads, text));
    RITZ_CHECK(ritz_dense_new(n, count, &columns));
    RITZ_CHECK_NEW(row, count);
    for (int64_t k = 0; k < count && next_load(&w, &from, &j); k++) {
        row[k] =
            from->bit == RITZ_LOADS_ATTACHED ? request->attached.at[j] : -1;
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&columns, k)[i] = from->entry(request, j, i);
    }
    RITZ_MOVE(*F, columns);
    RITZ_MOVE(*dof, row);
    return RITZ_OK;
}

const char *ritz_loads_name(const ritz_request *request, int loads, int64_t j,
                            char text[RITZ_LOADS_NAME_SIZE])
{
    load_walk w = {request, loads, 0, 0};
    const source *from = NULL;
    char name[RITZ_DOF_NAME_SIZE];
    int64_t at = 0;

    text[0] = '\0';
    for (int64_t k = 0; k <= j; k++)
        if (!next_load(&w, &from, &at))
            return text;
    if (!from)
        return text;
    if (from->bit == RITZ_LOADS_ATTACHED)
        snprintf(text, RITZ_LOADS_NAME_SIZE, "%s",
                 ritz_dof_name(
                     request->component->dof[request->attached.at[at]], name));
    else
        snprintf(text, RITZ_LOADS_NAME_SIZE, "%s '%s'", from->word,
                 from->name(request, at));
    return text;
}
