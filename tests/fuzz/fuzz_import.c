/*
 * Options of ritz-import with the files that they name, in one text:
 *
 *     stiffness K
 *     dofs D
 *     port tip=2:1
 *     >K
 *     %%MatrixMarket matrix coordinate real symmetric
 *     ...
 *     >D
 *     1 1
 *     ...
 */
#include "fuzz.h"

#include "base/alloc.h"

#include <ritz/import.h>

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TEXTS = 8 };

/* An option, and where the request keeps its text or list of texts. */
typedef struct fuzz_option {
    const char *word;
    bool is_file; /* a path, which must stay in the working folder */
    size_t text;  /* offset of the text, or of the list of texts */
    size_t count; /* offset of the number of texts; 0: one text */
} fuzz_option;

#define ONE(word, field)                                                       \
    {                                                                          \
        word, false, offsetof(REQUEST, field), 0                               \
    }
#define FILE_OF(word, field)                                                   \
    {                                                                          \
        word, true, offsetof(REQUEST, field), 0                                \
    }
#define LIST(word, field, number)                                              \
    {                                                                          \
        word, false, offsetof(REQUEST, field), offsetof(REQUEST, number)       \
    }

#define FILES_OF(word, field, number)                                          \
    {                                                                          \
        word, true, offsetof(REQUEST, field), offsetof(REQUEST, number)        \
    }

#define REQUEST ritz_import_request
static const fuzz_option of_component[] = {
    FILE_OF("stiffness", stiffness),
    FILE_OF("mass", mass),
    FILE_OF("damping", damping),
    FILE_OF("structural-damping", structural_damping),
    FILE_OF("bulk", bulk),
    FILE_OF("dofs", dofs),
    ONE("rows", rows),
    FILE_OF("frequencies", frequencies),
    FILE_OF("ratios", ratios),
    FILE_OF("input-matrix", input_matrix),
    FILE_OF("output-matrix", output_matrix),
    FILE_OF("velocity-matrix", velocity_matrix),
    FILE_OF("acceleration-matrix", acceleration_matrix),
    ONE("input-names", input_names),
    ONE("output-names", output_names),
    ONE("units", units),
    LIST("port", port, num_ports),
    LIST("rigid-port", rigid_port, num_rigid_ports),
    LIST("averaged-port", averaged_port, num_averaged_ports),
    LIST("input", input, num_inputs),
    LIST("output", output, num_outputs),
    LIST("damper", damper, num_dampers),
    FILES_OF("recovery", recovery, num_recoveries),
    FILES_OF("recovery-rows", recovery_rows, num_recovery_rows),
    {0},
};
#undef REQUEST

#define REQUEST ritz_import_space_request
static const fuzz_option of_space[] = {
    FILE_OF("matrices", matrices),
    ONE("inputs", inputs),
    ONE("outputs", outputs),
    ONE("units", units),
    {0},
};
#undef REQUEST

/* The request that a text states, and its lists of texts. */
typedef struct fuzz_reading {
    char *request;
    const fuzz_option *options;
    int num_lists;
    const char *list[MOST_TEXTS][MOST_TEXTS];
} fuzz_reading;

static void take_list(fuzz_reading *reading, const fuzz_option *option,
                      const char *value)
{
    int64_t *count = (int64_t *)(void *)(reading->request + option->count);
    const char *const **text =
        (const char *const **)(void *)(reading->request + option->text);

    if (*count == 0) {
        if (reading->num_lists == MOST_TEXTS)
            return;
        *text = reading->list[reading->num_lists++];
    }
    for (int k = 0; k < reading->num_lists && *count < MOST_TEXTS; k++)
        if (*text == reading->list[k])
            reading->list[k][(*count)++] = value;
}

/* "WORD VALUE"; unknown words are ignored. */
static void take_option(fuzz_reading *reading, char *line)
{
    char *value = strchr(line, ' ');

    if (!value)
        return;
    *value++ = '\0';
    for (const fuzz_option *o = reading->options; o->word; o++) {
        if (strcmp(o->word, line) != 0 || (o->is_file && strchr(value, '/')))
            continue;
        if (o->count > 0)
            take_list(reading, o, value);
        else
            memcpy(reading->request + o->text, &value, sizeof value);
    }
}

static void take_text(fuzz_reading *reading, char *text)
{
    char *line = text;

    while (line && *line != '>') {
        char *end = strchr(line, '\n');

        if (end)
            *end = '\0';
        take_option(reading, line);
        line = end ? end + 1 : NULL;
    }
    if (line)
        fuzz_store_files(line);
}

void fuzz_import(const char *bytes, int64_t size)
{
    char *text = strndup(bytes, (size_t)size);
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_import_report) report = {0};
    ritz_import_request request = {0};
    fuzz_reading reading = {.request = (char *)&request,
                            .options = of_component};

    if (!text)
        return;
    take_text(&reading, text);
    fuzz_judge(ritz_import(&request, &component, &report));
    fuzz_remove_files(bytes);
    free(text);
}

void fuzz_state_space(const char *bytes, int64_t size)
{
    char *text = strndup(bytes, (size_t)size);
    RITZ_OWN(ritz_state_space) space = {0};
    ritz_import_space_request request = {0};
    fuzz_reading reading = {.request = (char *)&request, .options = of_space};

    if (!text)
        return;
    take_text(&reading, text);
    if (request.matrices)
        fuzz_judge(ritz_import_state_space(&request, &space));
    fuzz_remove_files(bytes);
    free(text);
}
