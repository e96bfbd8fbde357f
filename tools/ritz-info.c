/* ritz-info - what is in a container, a matrix file or a deck. */
#include "print/print.h"

#include <stdio.h>
#include <string.h>

/* Print after a member's type whether it must exist. */
static void print_presence(const ritz_container_row *row)
{
    if (row->with)
        printf(", with `%s`", row->with);
    else if (row->optional)
        printf(", optional");
}

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
    printf("| `%s` | %s", row->name, row->type);
    print_presence(row);
    printf(" | %s%s%s | %s%s%s%s |\n", *row->shape ? "(" : "", row->shape,
           *row->shape ? ")" : "", row->about, range ? "; in " : "",
           range ? range : "", row->nan ? "; NaN: none" : "");
}

static void list_members(void)
{
    const char *of = NULL;

    ritz_container_rows(print_row, &of);
}

/* Keys of a single file stand in the report itself too. */
static ritz_status describe_files(cli_run *run, bool members, bool directory)
{
    SINK_ITEMS(run, "files", k, run->num_operands) {
        const char *path = run->operand[k];

        sink_set(run, "file", "%s", path);
        if (k > 0)
            cli_say(run, "%s", "");
        cli_say(run, "%s:", path);
        RITZ_CHECK(describe_file(run, path, members, directory));
    }
    if (run->num_operands == 1)
        sink_lift(run,
                  json_array_get(json_object_get(run->report, "files"), 0));
    if (run->output)
        RITZ_CHECK(cli_table_save(&run->said, run->output));
    return RITZ_OK;
}

int main(int argc, char **argv)
{
    bool members = false;
    bool directory = false;
    const cli_option options[] = {
        CLI_FLAG("members", &members,
                 "list what a container holds, with sizes"),
        CLI_FLAG("directory", &directory,
                 "list a matrix file without reading values"),
        CLI_ACTION("list", list_members,
                   "list what containers can hold, with its meaning"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-info",
        .operands =
            {{"FILE",
              "a container, a matrix file (OUTPUT4, DMIG, "
              "Matrix Market, Harwell-Boeing, MAT, coordinates) or bulk "
              "data",
              true}},
        .summary = "What is in a file: sizes, names, frequencies, checksums, "
                   "how it was made.",
        .example = "ritz-info --json blade.h5",
        .output = "write the text there too",
        .output_optional = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, describe_files(&run, members, directory));
}
