/* What a measured file cost, from the lines of the tools that made it. */
#include "cli/records.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_INPUTS = 4, NAME = 512 };

static const char *command_of(const record *r)
{
    const char *command =
        json_string_value(json_object_get(r->json, "command"));

    return command ? command : "";
}

/* The word behind -o or --output; quoted, if the shell needs that. */
static void output_of(const record *r, char out[NAME])
{
    static const char *const options[] = {" -o ", " --output ", " --output="};
    const char *word = NULL;
    size_t length = 0;

    out[0] = '\0';
    for (size_t k = 0; k < sizeof options / sizeof *options && !word; k++) {
        word = strstr(command_of(r), options[k]);
        word = word ? word + strlen(options[k]) : NULL;
    }
    if (!word)
        return;
    if (*word == '\'')
        length = strcspn(++word, "'");
    else
        length = strcspn(word, " ");
    if (length < NAME)
        snprintf(out, NAME, "%.*s", (int)length, word);
}

/* The name in "SHA256  NAME". */
static const char *input_of(const record *r, size_t k)
{
    const char *text = json_string_value(
        json_array_get(json_object_get(r->json, "inputs"), k));
    const char *gap = text ? strstr(text, "  ") : NULL;

    return gap ? gap + 2 : "";
}

static bool makes(const record *r)
{
    return strcmp(r->tool, "ritz-basis") == 0 ||
           strcmp(r->tool, "ritz-reduce") == 0;
}

/* The last line before `end` that made a file; NULL: none did. */
static const record *maker_of(const records *all, const char *name, int64_t end)
{
    char made[NAME];

    for (int64_t k = end - 1; *name && k >= 0; k--) {
        if (!makes(&all->item[k]))
            continue;
        output_of(&all->item[k], made);
        if (strcmp(made, name) == 0)
            return &all->item[k];
    }
    return NULL;
}

/* Processor time of the lines that made the inputs of one; of the k-th maker
 * @p maker is told, so that it can be asked in turn. */
static double time_of_inputs(const records *all, const record *r,
                             const record *maker[MOST_INPUTS])
{
    size_t count = json_array_size(json_object_get(r->json, "inputs"));
    double sum = 0.0;

    for (size_t k = 0; k < MOST_INPUTS; k++) {
        maker[k] = k < count
                       ? maker_of(all, input_of(r, k), (int64_t)(r - all->item))
                       : NULL;
        if (maker[k])
            sum += maker[k]->cpu;
    }
    return sum;
}

/* A reduction, and the basis that it read. */
static double time_to_make(const records *all, const record *r)
{
    const record *reduce[MOST_INPUTS], *basis[MOST_INPUTS];
    double sum = time_of_inputs(all, r, reduce);

    for (size_t k = 0; k < MOST_INPUTS; k++)
        if (reduce[k])
            sum += time_of_inputs(all, reduce[k], basis);
    return sum;
}

/* Simulator cost of a file that a line reads, measured by another line. */
static double cost_of_inputs(const records *all, const record *r)
{
    size_t count = json_array_size(json_object_get(r->json, "inputs"));

    for (int64_t k = all->count - 1; k >= 0; k--) {
        const record *s = &all->item[k];

        if (isnan(s->cost) || s->errors)
            continue;
        for (size_t i = 0; i < count; i++)
            if (*input_of(r, i) && strcmp(input_of(s, 0), input_of(r, i)) == 0)
                return s->cost;
    }
    return nan("");
}

void records_join(records *all)
{
    for (int64_t k = 0; k < all->count; k++) {
        record *r = &all->item[k];
        double time = 0.0;

        if (!r->errors || strcmp(r->tool, "ritz-verify") != 0)
            continue;
        time = time_to_make(all, r);
        r->cpu = time > 0.0 ? time : nan(""); /* its own is verification's */
        if (isnan(r->cost))
            r->cost = cost_of_inputs(all, r);
    }
}
