/*
 * Command lines of the tools. Their mains are compiled into the fuzzer, and
 * read options, files and texts as usual. An input has the tool and its words,
 * one per line, then the files that these name:
 *
 *     ritz-simulate
 *     --initial
 *     F
 *     r.h5
 *     >F
 *     1 0.5
 *     ...
 *
 * Models are samples, and computations are refused (fuzz_samples.c). Inputs
 * with a '/' in a word are skipped, so that no file outside of the working
 * folder is touched.
 */
#define _GNU_SOURCE /* NOLINT: declares memmem */
#include "fuzz.h"

#include "base/draft.h"
#include "cli/cli.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_WORDS = 48 };

/* --- tools ---------------------------------------------------------------- */

typedef int tool_main(int argc, char **argv);

/* X(NAME): a tool ritz-NAME. CMakeLists.txt renames its main to
   fuzz_ritz_NAME. */
#define EACH_TOOL(X)                                                           \
    X(assemble)                                                                \
    X(basis)                                                                   \
    X(check)                                                                   \
    X(compare)                                                                 \
    X(export)                                                                  \
    X(fit)                                                                     \
    X(frf)                                                                     \
    X(import)                                                                  \
    X(info)                                                                    \
    X(poles)                                                                   \
    X(rank)                                                                    \
    X(recover)                                                                 \
    X(reduce)                                                                  \
    X(simulate)                                                                \
    X(verify)

#define DECLARE_TOOL(name) tool_main fuzz_ritz_##name;
EACH_TOOL(DECLARE_TOOL)
#undef DECLARE_TOOL

static const struct tool {
    const char *name;
    tool_main *main;
} tools[] = {
#define TOOL_ROW(name) {"ritz-" #name, fuzz_ritz_##name},
    EACH_TOOL(TOOL_ROW)
#undef TOOL_ROW
};

/* --- how a run ends ------------------------------------------------------- */

static jmp_buf end;      /* exit of a tool returns here */
static bool running;     /* a tool runs, and may exit */
static cli_run *current; /* the tool's run, from cli_parse to cli_finish */

/* NOLINTBEGIN(*-reserved-identifier, *-identifier-naming): the linker's */
void __real_cli_parse(const cli_program *program, const cli_option *options,
                      int argc, char **argv, cli_run *run);
void __wrap_cli_parse(const cli_program *program, const cli_option *options,
                      int argc, char **argv, cli_run *run);
void __wrap_cli_watch(const cli_run *run);
int __wrap_cli_finish(cli_run *run, ritz_status status);
_Noreturn void __real_exit(int status);
_Noreturn void __wrap_exit(int status);

void __wrap_cli_parse(const cli_program *program, const cli_option *options,
                      int argc, char **argv, cli_run *run)
{
    current = run;
    __real_cli_parse(program, options, argc, argv, run);
}

/* Does nothing: libFuzzer handles signals. */
void __wrap_cli_watch(const cli_run *run)
{
    (void)run;
}

/* Unlike the tools' own, leaves standard output open and publishes no
   output. */
int __wrap_cli_finish(cli_run *run, ritz_status status)
{
    fuzz_judge(status);
    if (status != RITZ_OK)
        cli_complain("%s: %s\n", run->program->name, ritz_error_message());
    current = NULL;
    for (int64_t k = 0; k < run->num_inputs; k++)
        free(run->input[k]);
    free(run->input);
    free(run->operand);
    cli_table_free(&run->said);
    json_decref(run->report);
    json_decref(run->warnings);
    json_decref(run->line);
    return status == RITZ_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}

void __wrap_exit(int status)
{
    if (!running)
        __real_exit(status);
    if (current)
        __wrap_cli_finish(current, RITZ_OK);
    longjmp(end, 1); /* NOLINT: a tool that ends */
}
/* NOLINTEND(*-reserved-identifier, *-identifier-naming) */

/* --- words ---------------------------------------------------------------- */

/* The words of a command line, each in a heap block of its own length. */
typedef struct fuzz_words {
    int count;
    char *word[MOST_WORDS + 1];
} fuzz_words;

static void add_word(fuzz_words *words, const char *text, size_t length)
{
    char *word = words->count < MOST_WORDS ? strndup(text, length) : NULL;

    if (word)
        words->word[words->count++] = word;
} /* NOLINT(clang-analyzer-unix.Malloc): free_words */

static void add_words(fuzz_words *words, const char *const *list)
{
    for (; *list; list++)
        add_word(words, *list, strlen(*list));
}

static void free_words(fuzz_words *words)
{
    for (int k = 0; k < words->count; k++)
        free(words->word[k]);
}

/* Run a tool in a folder of its own, which is empty afterwards. */
static void run_tool(tool_main *tool, fuzz_words *words, const char *files)
{
    static const char folder[] = "commands";
    const int before = open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);

    mkdir(folder, 0700);
    if (before < 0 || chdir(folder) != 0)
        __real_exit(1);
    fuzz_store_files(files);
    current = NULL;
    running = true;
    if (setjmp(end) == 0) /* NOLINT */
        (void)tool(words->count, words->word);
    running = false;
    cli_unwatch();
    (void)ritz_draft_settle(false);
    if (fchdir(before) != 0)
        __real_exit(1);
    close(before);
    fuzz_empty(folder);
}

/* Add each line as a word, preceded by before[0] for the first line and by
   before[1] for all others, if there are any. Returns the files that follow. */
static const char *add_lines(fuzz_words *words, const char *text,
                             const char *const *before)
{
    while (*text && *text != '>') {
        const size_t length = strcspn(text, "\n");

        if (before)
            add_word(words, *before, strlen(*before));
        if (before && before[1])
            before++;
        add_word(words, text, length);
        text += length + (text[length] != '\0');
    }
    return text;
}

/* Whether no word leads out of the folder, and no file is HDF5, which has its
   own targets (fuzz_hdf5.c) and is not robust to damaged files. */
static bool is_harmless(const fuzz_words *words, const char *bytes,
                        int64_t size)
{
    static const char mark[] = "\211HDF";

    for (int k = 0; k < words->count; k++)
        if (strchr(words->word[k], '/'))
            return false;
    return !memmem(bytes, (size_t)size, mark, sizeof mark - 1);
}

void fuzz_commands(const char *bytes, int64_t size)
{
    fuzz_words words = {0};
    const char *files = add_lines(&words, bytes, NULL);

    if (words.count > 0 && is_harmless(&words, bytes, size))
        for (size_t k = 0; k < sizeof tools / sizeof *tools; k++)
            if (strcmp(words.word[0], tools[k].name) == 0)
                run_tool(tools[k].main, &words, files);
    free_words(&words);
}

/* A line for --initial, further lines for --input, then files. */
void fuzz_initial(const char *bytes, int64_t size)
{
    static const char *const head[] = {
        "ritz-simulate", "c.h5", "--seconds", "1", "-oo", NULL};
    static const char *const before[] = {"--initial", "--input", NULL};
    fuzz_words words = {0};
    const char *files = NULL;

    add_words(&words, head);
    files = add_lines(&words, bytes, before);
    if (is_harmless(&words, bytes, size))
        run_tool(fuzz_ritz_simulate, &words, files);
    free_words(&words);
}

/* The input is the file of --tracks. */
void fuzz_rank_tracks(const char *bytes, int64_t size)
{
    static const char *const line[] = {"ritz-rank", "s.h5", "--tracks",
                                       "../tracks", NULL};
    fuzz_words words = {0};

    fuzz_store("tracks", bytes, size);
    add_words(&words, line);
    run_tool(fuzz_ritz_rank, &words, NULL);
    free_words(&words);
}
