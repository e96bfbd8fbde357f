/* ritz-info - what is in a container, a matrix file or a bulk data deck. */
#include "print/describe.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One line of the tables of docs/container.md. */
static void print_row(const ritz_container_row *row, void *data)
{
    const char **of = data;
    const char *range = row->range;

    if (!*of || strcmp(*of, row->of) != 0)
        printf("%s%s:\n\n| member | type | shape | meaning |\n"
               "|---|---|---|---|\n",
               *of ? "\n" : "", row->of);
    *of = row->of;
    if (row->type == NULL) {
        printf("| %s | | | see there%s |\n", row->name,
               row->optional ? "; optional" : "");
        return;
    }
    printf("| `%s` | %s%s | %s%s%s | %s%s%s%s |\n", row->name, row->type,
           row->optional ? ", optional" : "", *row->shape ? "(" : "",
           row->shape, *row->shape ? ")" : "", row->about, range ? "; in " : "",
           range ? range : "", row->nan ? "; NaN: none" : "");
}

static void list_members(void)
{
    const char *of = NULL;

    ritz_container_rows(print_row, &of);
}

static void describe_member(const ritz_container_row *row, void *data)
{
    cli_run *run = data;

    sink_say(run, "member,type,shape", "  %-30s %-16s %s", row->name, row->type,
             row->shape);
}

static const void *object_of(const model *m)
{
    switch (m->kind) {
    case MODEL_COMPONENT:
        return &m->component;
    case MODEL_BASIS:
        return &m->basis;
    case MODEL_REDUCED:
        return &m->reduced;
    case MODEL_SYSTEM:
        return &m->system;
    case MODEL_RESPONSE:
        return &m->response;
    case MODEL_RANKING:
        return &m->rankings;
    case MODEL_STATES:
        return &m->states;
    default:
        return &m->simulation;
    }
}

static ritz_status describe_container(cli_run *run, bool members,
                                      const char *path)
{
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};
    model m = {0};

    RITZ_TRY(model_read(run, path, MODEL_ANY, &m));
    RITZ_TRY(ritz_container_summary(path, &summary));
    RITZ_TRY_IN(path, describe_model(run, &m));
    if (members) {
        sink_list(run, "members");
        ritz_container_members(summary.kind, object_of(&m), describe_member,
                               run);
        sink_end(run);
    }
    sink_field(run, "made by", "command", "%s", summary.command);
    sink_field(run, "version", "made_by_version", "ritz %s", summary.version);
    sink_list(run, "made_from");
    for (int64_t k = 0; k < summary.num_inputs; k++) {
        cli_say(run, "  %-14s %s", k > 0 ? "" : "from", summary.input[k]);
        sink_add(run, "%s", summary.input[k]);
    }
    sink_end(run);
done:
    model_free(&m);
    ritz_summary_free(&summary);
    return status;
}

static ritz_status describe_bytes(cli_run *run, const ritz_foreign *file)
{
    ritz_status status = RITZ_OK;
    ritz_deck deck = {0};

    RITZ_FAIL_IF(file->size == 0, RITZ_ERR_FORMAT, "'%s' is empty", file->path);
    RITZ_FAIL_IF(!ritz_deck_recognise(file->bytes, file->size), RITZ_ERR_FORMAT,
                 "'%s' is neither a container nor a matrix file nor text",
                 file->path);
    RITZ_TRY(ritz_deck_parse(file->path, file->bytes, file->size, file->folder,
                             &deck));
    RITZ_FAIL_IF(deck.grids.count + deck.num_points + deck.num_fixed +
                         deck.num_constraints + deck.num_sets[RITZ_SET_A] +
                         deck.num_sets[RITZ_SET_B] +
                         deck.num_sets[RITZ_SET_Q] ==
                     0,
                 RITZ_ERR_FORMAT,
                 "'%s' is no container, no matrix file that Ritz knows, and "
                 "no bulk data with grids",
                 file->path);
    describe_deck(run, &deck);
done:
    ritz_deck_free(&deck);
    return status;
}

static ritz_status describe_foreign(cli_run *run, bool directory,
                                    const char *path)
{
    ritz_status status = RITZ_OK;
    ritz_foreign file = {0};

    RITZ_TRY(cli_input_unread(run, path));
    RITZ_TRY(ritz_foreign_open(path, &file));
    RITZ_TRY(cli_input_sum(run, path, file.digest));
    if (file.format) {
        RITZ_TRY_IN(path, ritz_foreign_list(&file));
        RITZ_TRY_IN(path, describe_matrices(run, &file, directory));
    } else {
        RITZ_TRY(describe_bytes(run, &file));
    }
done:
    ritz_foreign_close(&file);
    return status;
}

/* Keys of a single file stand in the report itself too. */
static ritz_status inform(cli_run *run, bool members, bool directory)
{
    sink_list(run, "files");
    for (int k = 0; k < run->num_operands; k++) {
        const char *path = run->operand[k];

        sink_object(run, NULL);
        sink_set(run, "file", "%s", path);
        cli_say(run, "%s%s:", k > 0 ? "\n" : "", path);
        RITZ_CHECK(ritz_container_is(path)
                       ? describe_container(run, members, path)
                       : describe_foreign(run, directory, path));
        sink_end(run);
    }
    sink_end(run);
    if (run->num_operands == 1)
        sink_lift(run,
                  json_array_get(json_object_get(run->report, "files"), 0));
    if (run->output)
        RITZ_CHECK(cli_save(run, run->output));
    return RITZ_OK;
}

int main(int argc, char **argv)
{
    bool members = false;
    bool directory = false;
    const cli_option options[] = {
        {CLI_FLAG(&members), .name = "members",
         .help = "list what a container holds, with sizes"},
        {CLI_FLAG(&directory), .name = "directory",
         .help = "list a matrix file without reading values"},
        {CLI_ACTION(list_members), .name = "list",
         .help = "list what containers can hold, with its meaning"},
        {0}};
    const cli_program program = {
        .name = "ritz-info",
        .operands = {{"FILE",
                      "a container, a matrix file (OUTPUT4, DMIG, "
                      "Matrix Market, MAT) or bulk data",
                      true}},
        .summary = "What is in a file: sizes, names, frequencies, checksums, "
                   "how it was made.",
        .example = "ritz-info --json blade.h5",
        .options = options,
        .output = "write the text there too",
        .output_optional = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    return cli_finish(&run, inform(&run, members, directory));
}
