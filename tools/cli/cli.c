#include "cli/cli.h"

#include "base/draft.h"
#include "base/mapped.h"

#include <ritz/base.h>

#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_USAGE = 2, WORD = 32 };

/* The tool's own options, then those that every tool has; ended by {0}. The
   first of these belongs to tools that compute with large models. */
static void gather_options(cli_run *run, cli_option *all)
{
    const cli_option common[] = {
        CLI_TEXT("memory", &run->memory, "SIZE",
                 "hold basis vectors on disk (TMPDIR) or refuse, before "
                 "memory would exceed this: 500M, 22G [80 % of the machine's]"),
        {.kind = CLI_KIND_TEXT,
         .letter = 'o',
         .written = true,
         .to.text = &run->output,
         .name = "output",
         .argument = "FILE",
         .help = run->program->output},
        CLI_ROW(FLAG, flag, 'q', "quiet", &run->quiet, NULL, 0.0, 0.0,
                "print nothing but errors"),
        CLI_FLAG("json", &run->json, "print one JSON object instead of text"),
        CLI_OUTPUT(
            "record", &run->record, "FILE",
            "append time, memory and errors of this run as one JSON line"),
        CLI_ROW(VERSION, flag, 0, "version", NULL, NULL, 0.0, 0.0,
                "print the version"),
        CLI_ROW(HELP, flag, 'h', "help", NULL, NULL, 0.0, 0.0,
                "print this help"),
        {0},
    };
    const int first = run->program->threads ? 0 : 1;
    const int last = (int)(sizeof common / sizeof *common);
    int count = 0;

    while (run->options[count].kind != CLI_KIND_END)
        count++;
    if (count + last - first > CLI_MAX_OPTIONS)
        abort();
    memcpy(all, run->options, (size_t)count * sizeof *all);
    memcpy(all + count, common + first, (size_t)(last - first) * sizeof *all);
}

static void print_range(const cli_option *o, double value)
{
    printf("; %g to %g", o->min, o->max);
    if (value >= o->min && value <= o->max)
        printf(" [%g]", value);
}

static void print_default(const cli_option *o)
{
    if (o->kind == CLI_KIND_INT)
        print_range(o, (double)*o->to.whole);
    else if (o->kind == CLI_KIND_REAL)
        print_range(o, *o->to.real);
    else if ((o->kind == CLI_KIND_TEXT || o->kind == CLI_KIND_WORD) &&
             *o->to.text)
        printf(" [%s]", *o->to.text);
    else if (o->kind == CLI_KIND_LIST)
        printf("; may be repeated");
}

static void print_operands(FILE *file, const cli_program *program)
{
    for (int k = 0; k < CLI_MAX_OPERANDS && program->operands[k].name; k++)
        fprintf(file, "%s%s%s", k > 0 ? " " : "", program->operands[k].name,
                program->operands[k].many ? "..." : "");
}

/* A word and what it means, side by side or, if the word is long, below. */
static void print_entry(const char *left, const char *help)
{
    enum { COLUMN = 30 };

    if (strlen(left) <= COLUMN)
        printf("  %-*s  %s", COLUMN, left, help);
    else
        printf("  %s\n  %-*s  %s", left, COLUMN, "", help);
}

static void print_help(const cli_program *program, const cli_option *options)
{
    const cli_operand *operand = program->operands;

    printf("Usage: %s [OPTION]...%s", program->name, operand->name ? " " : "");
    print_operands(stdout, program);
    printf(program->output_optional ? " [-o FILE]\n" : " -o FILE\n");
    printf("\n%s\n\n", program->summary);
    for (int k = 0; k < CLI_MAX_OPERANDS && operand[k].name; k++) {
        print_entry(operand[k].name, operand[k].help);
        putchar('\n');
    }
    if (operand->name)
        putchar('\n');
    for (const cli_option *o = options; o->kind != CLI_KIND_END; o++) {
        char left[96];
        char letter[] = {'-', o->letter, ',', ' ', '\0'};

        snprintf(left, sizeof left, "%s--%s%s%s", o->letter ? letter : "",
                 o->name, o->argument ? " " : "",
                 o->argument ? o->argument : "");
        print_entry(left, o->help);
        print_default(o);
        putchar('\n');
    }
    printf("\nExample:\n  %s\n\n", program->example);
    printf("Exit status: 0 done; 1 the work failed or a limit was not met; "
           "2 wrong usage.\n");
}

/* The last words of a program whose command line makes no sense. */
static _Noreturn void give_up(const cli_program *program)
{
    cli_complain("\nTry '%s --help'.\n", program->name);
    cli_unwatch();
    exit(EXIT_USAGE);
}

void cli_refuse(const cli_program *program, const char *format, ...)
{
    va_list args;

    cli_complain("%s: ", program->name);
    va_start(args, format);
    cli_complain_list(format, args);
    va_end(args);
    give_up(program);
}

void cli_refuse_name(const cli_program *program, const char *what,
                     const char *word, int64_t count, const char *const *names)
{
    char(*known)[WORD] = calloc((size_t)count + 1, sizeof *known);
    const char *nearest = NULL;

    for (int64_t k = 0; known && k < count; k++)
        snprintf(known[k], sizeof known[k], "%s", names[k]);
    if (known && count > 0)
        nearest = ritz_text_nearest(word, count, known[0], sizeof known[0]);
    cli_complain("%s: %s '%s'", program->name, what, word);
    if (nearest)
        cli_complain(", is '%s' meant?", nearest);
    free(known);
    give_up(program);
}

const void *cli_choose(const cli_program *program, const char *what,
                       const char *word, const void *table)
{
    const void *row = ritz_row_find(table, what, word);

    if (!row) /* without its "there is" */
        cli_refuse(program, "%s", strstr(ritz_error_message(), "no "));
    return row;
}

void cli_list_advice(const char *when, const char *cost, const char *holds,
                     const char *fails)
{
    static const char *const word[] = {"when", "cost", "holds", "fails"};
    const char *const text[] = {when, cost, holds, fails};

    for (int k = 0; k < 4; k++)
        if (text[k])
            printf("  %-6s %s\n", word[k], text[k]);
}

bool cli_next(const char **list, char word[RITZ_NAME_SIZE])
{
    const char *at = *list;
    int length = at ? (int)strcspn(at, ",") : 0;

    if (!at)
        return false;
    snprintf(word, RITZ_NAME_SIZE, "%.*s", length < 60 ? length : 60, at);
    *list = at[length] ? at + length + 1 : NULL;
    return true;
}

/* A whole number or a real in its range, or no return. */
static double read_number(const cli_program *program, const cli_option *o,
                          const char *text)
{
    bool whole = o->kind == CLI_KIND_INT;
    double number = 0.0;

    if (!ritz_text_real(text, &number) || !(number >= o->min) ||
        !(number <= o->max) || (whole && number != floor(number)))
        cli_refuse(program, "--%s takes a %s from %g to %g, not '%s'", o->name,
                   whole ? "whole number" : "number", o->min, o->max, text);
    return number;
}

static void take_pair(const cli_program *program, const cli_option *o,
                      const char *text)
{
    char low[64] = "";
    const char *comma = strchr(text, ',');
    double *out = o->to.real;

    if (comma && comma - text < (ptrdiff_t)sizeof low)
        memcpy(low, text, (size_t)(comma - text));
    if (!comma || !ritz_text_real(low, &out[0]) ||
        !ritz_text_real(comma + 1, &out[1]) || !(out[0] >= 0.0) ||
        !(out[0] < out[1]))
        cli_refuse(program,
                   "--%s takes two ascending numbers, '0,10', not "
                   "'%s'",
                   o->name, text);
}

/* One of the words of "on|off|both", or no return. */
static void take_word(const cli_program *program, const cli_option *o,
                      const char *text)
{
    char list[128] = ""; /* "'on', 'off' or 'both'" */
    size_t used = 0;
    int length = 0;

    for (const char *at = o->argument; at && *at;
         at += length + (at[length] != 0)) {
        const char *gap = "";

        length = (int)strcspn(at, "|");
        if (strlen(text) == (size_t)length &&
            strncmp(at, text, (size_t)length) == 0) {
            *o->to.text = text;
            return;
        }
        if (at > o->argument)
            gap = at[length] ? ", " : " or ";
        used += (size_t)snprintf(list + used, sizeof list - used, "%s'%.*s'",
                                 gap, length, at);
    }
    cli_refuse(program, "--%s takes %s, not '%s'", o->name, list, text);
}

static void take_option(cli_run *run, const cli_option *all,
                        const cli_option *o, const char *text)
{
    run->given[o - all] = true;
    switch (o->kind) {
    case CLI_KIND_FLAG:
        *o->to.flag = true;
        break;
    case CLI_KIND_INT:
        *o->to.whole = (int64_t)read_number(run->program, o, text);
        break;
    case CLI_KIND_REAL:
        *o->to.real = read_number(run->program, o, text);
        break;
    case CLI_KIND_PAIR:
        take_pair(run->program, o, text);
        break;
    case CLI_KIND_TEXT:
        *o->to.text = text;
        break;
    case CLI_KIND_WORD:
        take_word(run->program, o, text);
        break;
    case CLI_KIND_LIST:
        if (o->to.list->count == CLI_MAX_LIST)
            cli_refuse(run->program, "--%s more than %d times", o->name,
                       CLI_MAX_LIST);
        o->to.list->text[o->to.list->count++] = text;
        break;
    case CLI_KIND_ACTION:
        o->to.action();
        exit(cli_finish(run, RITZ_OK));
    case CLI_KIND_HELP:
        print_help(run->program, all);
        exit(cli_finish(run, RITZ_OK));
    case CLI_KIND_VERSION:
        printf("%s (Ritz) %s\n", run->program->name, ritz_version());
        exit(cli_finish(run, RITZ_OK));
    case CLI_KIND_END:
        break;
    }
}

bool cli_given(const cli_run *run, const char *name)
{
    for (int k = 0; run->options[k].kind != CLI_KIND_END; k++)
        if (strcmp(run->options[k].name, name) == 0)
            return run->given[k];
    abort(); /* no such option: a mistake of the program */
}

/* "--name", "--name=TEXT" or "--name TEXT"; how many words that took. */
static int take_long(cli_run *run, const cli_option *all, char **words)
{
    const char *names[CLI_MAX_OPTIONS];
    const char *word = words[0] + 2;
    size_t length = strcspn(word, "=");
    const char *value = word[length] ? word + length + 1 : NULL;
    int k = 0;

    while (all[k].kind != CLI_KIND_END &&
           (strncmp(all[k].name, word, length) != 0 || all[k].name[length]))
        k++;
    if (all[k].kind == CLI_KIND_END) {
        char unknown[64];

        for (int i = 0; i < k; i++)
            names[i] = all[i].name;
        snprintf(unknown, sizeof unknown, "%.*s", (int)length, word);
        cli_refuse_name(run->program, "unknown option", unknown, k, names);
    }
    if (!all[k].argument && value)
        cli_refuse(run->program, "no argument goes with '--%s'", all[k].name);
    if (all[k].argument && !value && !words[1])
        cli_refuse(run->program, "no argument to '--%s'", all[k].name);
    if (!all[k].argument)
        value = "";
    take_option(run, all, &all[k], value ? value : words[1]);
    return value ? 1 : 2;
}

/* "-q", "-qh", "-oFILE" or "-o FILE"; how many words that took. */
static int take_short(cli_run *run, const cli_option *all, char **words)
{
    for (const char *c = words[0] + 1; *c; c++) {
        const cli_option *o = all;

        while (o->kind != CLI_KIND_END && o->letter != *c)
            o++;
        if (o->kind == CLI_KIND_END)
            cli_refuse(run->program, "unknown option '-%c'", *c);
        if (!o->argument) {
            take_option(run, all, o, "");
            continue;
        }
        if (!c[1] && !words[1])
            cli_refuse(run->program, "no argument to '-%c'", *c);
        take_option(run, all, o, c[1] ? c + 1 : words[1]);
        return c[1] ? 1 : 2;
    }
    return 1;
}

/* Options anywhere, operands in their order; behind "--" only operands. */
static void take_all(cli_run *run, const cli_option *all, int argc, char **argv)
{
    bool options = true;

    for (int k = 1; k < argc;) {
        const char *word = argv[k];

        if (!options || word[0] != '-' || !word[1]) {
            run->operand[run->num_operands++] = argv[k++];
        } else if (strcmp(word, "--") == 0) {
            options = false;
            k++;
        } else if (word[1] == '-') {
            k += take_long(run, all, argv + k);
        } else {
            k += take_short(run, all, argv + k);
        }
    }
}

static void check_operands(const cli_run *run)
{
    const cli_operand *operands = run->program->operands;
    int least = 0;
    bool many = false;

    while (least < CLI_MAX_OPERANDS && operands[least].name)
        many = many || operands[least++].many;
    if (run->num_operands >= least && (many || run->num_operands == least))
        return;
    cli_complain("%s: ", run->program->name);
    if (least == 0) {
        cli_complain("'%s' is no option, and there are no operands",
                     run->operand[0]);
    } else {
        cli_complain("expected '");
        print_operands(stderr, run->program);
        cli_complain("', not %d operand%s", run->num_operands,
                     run->num_operands == 1 ? "" : "s");
    }
    give_up(run->program);
}

/* One word so that a shell reads it back, as far as there is room. */
static size_t quote_word(char *out, size_t room, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyz"
                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789-_=+.,:/@%^";
    size_t used = 0;

    if (*word && word[strspn(word, plain)] == '\0')
        return (size_t)snprintf(out, room, "%s", word);
    used = (size_t)snprintf(out, room, "'");
    for (const char *c = word; *c && used < room; c++)
        used += (size_t)snprintf(out + used, room - used,
                                 *c == '\'' ? "'\\''" : "%c", *c);
    if (used < room)
        used += (size_t)snprintf(out + used, room - used, "'");
    return used;
}

/* The program by its name, not its folder; one cut short ends in '...'. */
static void keep_command(cli_run *run, int argc, char **argv)
{
    size_t used = 0;

    for (int k = 0; k < argc && used + 1 < CLI_MAX_COMMAND; k++) {
        if (k > 0)
            run->command[used++] = ' ';
        used += quote_word(run->command + used, CLI_MAX_COMMAND - used,
                           k > 0 ? argv[k] : run->program->name);
    }
    if (used + 1 >= CLI_MAX_COMMAND)
        memcpy(run->command + CLI_MAX_COMMAND - 4, "...", 4);
}

/*
 * A descriptor of a standard stream that came closed must not be given to the
 * next file that is opened. What is then printed still fails, and is reported.
 */
static void occupy_streams(void)
{
    int file = -1;

    do
        file = open("/dev/null", O_RDONLY);
    while (file >= 0 && file <= STDERR_FILENO);
    if (file >= 0)
        close(file);
}

/* Collect the output files that options name, and refuse one that is named
   twice. */
static void gather_outputs(cli_run *run, const cli_option *all)
{
    const cli_option *named[CLI_MAX_OUTPUTS];
    int count = 0;

    for (const cli_option *o = all; o->kind != CLI_KIND_END; o++) {
        const char *path = o->written ? *o->to.text : NULL;

        if (!path)
            continue;
        for (int k = 0; k < count; k++)
            if (ritz_draft_same(path, run->written[k]))
                cli_refuse(run->program, "--%s and --%s name one file, '%s'",
                           named[k]->name, o->name, path);
        if (count == CLI_MAX_OUTPUTS)
            abort();
        named[count] = o;
        run->written[count++] = path;
    }
    run->num_written = count;
}

void cli_parse(const cli_program *program, const cli_option *options, int argc,
               char **argv, cli_run *run)
{
    cli_option all[CLI_MAX_OPTIONS] = {{0}};

    occupy_streams();
    cli_prepare();
    *run = (cli_run){
        .program = program,
        .options = options,
        .argv = argv,
        .operand = calloc((size_t)argc + 1, sizeof *run->operand),
        .report = json_pack("{s:s, s:s}", "tool", program->name, "version",
                            ritz_version()),
        .warnings = json_array(),
        .line = json_object(),
    };
    if (!run->operand || !run->report || !run->warnings || !run->line ||
        cli_table_new(&run->said) != RITZ_OK) {
        cli_complain("%s: no memory\n", program->name);
        exit(EXIT_FAILURE);
    }
    keep_command(run, argc, argv);
    gather_options(run, all);
    take_all(run, all, argc, argv);
    if (run->memory && !cli_limit_memory(run->memory))
        cli_refuse(program, "--memory: '%s' is no size such as 500M or 22G",
                   run->memory);
    check_operands(run);
    if (run->output ? !*run->output : !program->output_optional)
        cli_refuse(program, "no output, name it with -o");
    gather_outputs(run, all);
    ritz_draft_hold();
    cli_begin_again(run);
    cli_watch(run);
    ritz_map_files(); /* after it, whose handler ends the program */
    run->began = cli_clock();
}
