/* Claims files: a table of statements, each one line, run in order. */
#include "claims/claims.h"

#include "base/alloc.h"
#include "base/text.h"
#include "cli/child.h"
#include "import/import.h"

#include <ritz/base.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* --- words ---------------------------------------------------------------- */

/* A folder that a word begins with: "$DATA/lund" */
static const char *replace_folder(const claims_state *state, const char *text,
                                  size_t *length)
{
    const struct {
        const char *name, *value;
    } known[] = {{"$DATA", state->data}, {"$HERE", state->here}};

    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        *length = strlen(known[k].name);
        if (strncmp(text, known[k].name, *length) == 0)
            return known[k].value;
    }
    return NULL;
}

/*
 * One word from `text` to `out`; what follows it, or NULL: never closed. A
 * quote within a word is a letter.
 */
static const char *take_word(const claims_state *state, const char *text,
                             FILE *out)
{
    char quote = '\0';

    if (strchr("\"'", *text))
        quote = *text++;
    for (; *text && (quote ? *text != quote : !strchr(" \t", *text)); text++) {
        size_t length = 0;
        const char *value =
            *text == '$' ? replace_folder(state, text, &length) : NULL;

        if (value)
            text += length - 1;
        if (value)
            fputs(value, out);
        else
            fputc(*text, out);
    }
    fputc('\0', out);
    if (!quote)
        return text;
    return *text ? text + 1 : NULL;
}

/*
 * Cut a line into words: blanks part them, "..." and '...' keep them together,
 * a word that begins with # ends the line, $DATA and $HERE stand for folders.
 */
static ritz_status cut_line(const claims_state *state, const char *text,
                            claims_line *line)
{
    char *word = NULL;

    RITZ_CHECK(cli_table_new(&line->words));
    for (text += strspn(text, " \t"); *text && *text != '#';
         text += strspn(text, " \t")) {
        RITZ_REFUSE_IF(line->count == CLAIMS_MOST_WORDS, RITZ_ERR_FORMAT,
                       "more than %d words", CLAIMS_MOST_WORDS);
        text = take_word(state, text, line->words.file);
        RITZ_REFUSE_IF(!text, RITZ_ERR_FORMAT, "a quote is not closed");
        line->count++;
    }
    RITZ_CHECK(cli_table_end(&line->words));
    word = line->words.text;
    for (int k = 0; k < line->count; word += strlen(word) + 1)
        line->word[k++] = word;
    return RITZ_OK;
}

static void claims_line_free(claims_line *line)
{
    cli_table_free(&line->words);
}

/* --- statements ----------------------------------------------------------- */

/* The answer of a tool is read from here, in the folder of the state. */
static const char answer_name[] = "answer.json";

/* Words from the second on as one text. */
static void join_words(const claims_line *line, size_t size, char *out)
{
    out[0] = '\0';
    for (int k = 1; k < line->count; k++)
        sink_append(out, size, "%s%s", k > 1 ? " " : "", line->word[k]);
}

static ritz_status set_source(claims_state *state, const claims_line *line)
{
    RITZ_REFUSE_IF(line->count < 2, RITZ_ERR_FORMAT, "a source is not named");
    join_words(line, sizeof state->source, state->source);
    return RITZ_OK;
}

/* "need FILE...": what follows is skipped while one of them is absent. */
static ritz_status need_file(claims_state *state, const claims_line *line)
{
    state->skipping = false;
    for (int k = 1; k < line->count; k++)
        if (access(line->word[k], R_OK) != 0 && !state->skipping) {
            state->skipping = true;
            snprintf(state->absent, sizeof state->absent, "%s", line->word[k]);
        }
    return RITZ_OK;
}

/* In the child: run the tool with --json, its output in the answer's file. It
   is killed when this program ends. */
static _Noreturn void become(const claims_state *state, const char *tool,
                             char **argv)
{
    int out = -1;

    if (chdir(state->folder) == 0)
        out = open(answer_name, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (out >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(out, STDERR_FILENO) >= 0)
        execv(tool, argv);
    _exit(CHILD_NO_PROGRAM);
}

/* The JSON object that the tool printed, after any warnings. */
static ritz_status read_answer(claims_state *state)
{
    char path[PATH_MAX + sizeof answer_name + 1];
    RITZ_OWN_ARRAY char *text = NULL;
    const char *object = NULL;

    snprintf(path, sizeof path, "%s/%s", state->folder, answer_name);
    RITZ_CHECK(ritz_text_read(path, &text));
    object = text[0] == '{' ? text : strstr(text, "\n{");
    if (object)
        state->answer = json_loads(object, JSON_REJECT_DUPLICATES, NULL);
    if (!state->answer) /* wrong usage is told without an object */
        state->answer = json_pack("{s:s}", "error", text);
    if (!state->answer)
        state->answer = json_object();
    return RITZ_OK;
}

/* "try TOOL ARGUMENT...", whatever becomes of it. */
static ritz_status try_tool(claims_state *state, const claims_line *line)
{
    char tool[2 * PATH_MAX];
    char *argv[CLAIMS_MOST_WORDS + 2] = {NULL};
    static char json[] = "--json";
    int outcome = 0;
    pid_t child = -1;

    RITZ_REFUSE_IF(line->count < 2 || strncmp(line->word[1], "ritz-", 5) != 0 ||
                       strchr(line->word[1], '/'),
                   RITZ_ERR_FORMAT,
                   "what is run is a tool, such as ritz-basis");
    snprintf(tool, sizeof tool, "%s/%s", state->bin, line->word[1]);
    RITZ_REFUSE_IF(access(tool, X_OK) != 0, RITZ_ERR_FORMAT,
                   "there is no tool '%.40s'", line->word[1]);
    memcpy(argv, line->word + 1, (size_t)(line->count - 1) * sizeof *argv);
    argv[line->count - 1] = json;
    join_words(line, sizeof state->command, state->command);
    json_decref(state->answer);
    state->answer = NULL;
    fflush(stdout);
    child = child_start(SIGTERM);
    if (child == 0)
        become(state, tool, argv);
    RITZ_REFUSE_IF(child < 0, RITZ_ERR_FILE, "cannot start '%.40s': %s",
                   line->word[1], strerror(errno));
    (void)child_wait(child, &outcome);
    state->exit_code = WIFEXITED(outcome) ? WEXITSTATUS(outcome) : -1;
    return read_answer(state);
}

/* "run TOOL ARGUMENT...", which must succeed. */
static ritz_status run_tool(claims_state *state, const claims_line *line)
{
    const char *sentence = NULL;

    RITZ_CHECK(try_tool(state, line));
    sentence = json_string_value(json_object_get(state->answer, "error"));
    RITZ_REFUSE_IF(state->exit_code != 0, RITZ_ERR_FORMAT,
                   "'%.60s' ended with %d: %.300s", state->command,
                   state->exit_code, sentence ? sentence : "it says nothing");
    return RITZ_OK;
}

/* "rows NAME N [COMPS]": what --dofs reads, N grids or N scalar points. */
static ritz_status write_rows(claims_state *state, const claims_line *line)
{
    const char *directions = line->count == 4 ? line->word[3] : "0";
    RITZ_OWN(cli_table) table = {0};
    bool want[7] = {false};
    int64_t count = 0;

    RITZ_REFUSE_IF(line->count < 3 || line->count > 4 ||
                       strchr(line->word[1], '/') ||
                       !ritz_text_whole(line->word[2], &count) || count < 1,
                   RITZ_ERR_FORMAT,
                   "rows are NAME, a number of grids and their directions");
    RITZ_REFUSE_IF(count > CLAIMS_MOST_ROWS, RITZ_ERR_FORMAT,
                   "rows have at most %d grids", (int)CLAIMS_MOST_ROWS);
    RITZ_CHECK(ritz_import_directions(directions, want));
    RITZ_CHECK(cli_table_new(&table));
    for (int64_t k = 1; k <= count; k++)
        for (const char *at = directions; *at; at++)
            fprintf(table.file, "%ld %c\n", k, *at);
    return claims_save(state, line->word[1], "", &table);
}

/* Cut the next line off the text that follows. */
static char *take_line(claims_state *state)
{
    char *line = state->rest;
    char *end = strchr(line, '\n');

    if (end)
        *end = '\0';
    state->rest = end ? end + 1 : NULL;
    state->number++;
    return line;
}

/* "text NAME": the lines that follow, indented as the first of them, become
 * that file. */
static ritz_status write_text(claims_state *state, const claims_line *line)
{
    const size_t indent = state->rest ? strspn(state->rest, " \t") : 0;
    RITZ_OWN(cli_table) table = {0};

    RITZ_REFUSE_IF(line->count != 2 || strchr(line->word[1], '/'),
                   RITZ_ERR_FORMAT, "a text has one name");
    RITZ_CHECK(cli_table_new(&table));
    while (state->rest && (*state->rest == ' ' || *state->rest == '\t')) {
        const char *text = take_line(state);
        const size_t blank = strspn(text, " \t");

        fprintf(table.file, "%s\n", text + (blank < indent ? blank : indent));
    }
    return claims_save(state, line->word[1], "", &table);
}

static const struct statement {
    const char *word;
    ritz_status (*run)(claims_state *state, const claims_line *line);
    bool always; /* even while claims are skipped */
} statements[] = {
    {"source", set_source, true}, {"need", need_file, true},
    {"beam", claims_beam, false}, {"rows", write_rows, false},
    {"text", write_text, true},   {"run", run_tool, false},
    {"try", try_tool, false},     {"expect", claims_expect, true},
};

/* Run the next line, with those that belong to it. */
static ritz_status run_line(claims_state *state)
{
    const size_t count = sizeof statements / sizeof *statements;
    RITZ_OWN(claims_line) line = {0};
    size_t k = 0;

    RITZ_CHECK(cut_line(state, take_line(state), &line));
    if (line.count == 0)
        return RITZ_OK;
    while (k < count && strcmp(statements[k].word, line.word[0]) != 0)
        k++;
    RITZ_REFUSE_IF(
        k == count, RITZ_ERR_FORMAT,
        "'%.40s' is none of source, need, beam, rows, text, run, try, "
        "expect",
        line.word[0]);
    return statements[k].always || !state->skipping
               ? statements[k].run(state, &line)
               : RITZ_OK;
}

ritz_status claims_file(claims_state *state, const char *path)
{
    char where[PATH_MAX + 32];
    RITZ_OWN_ARRAY char *text = NULL, *folder = NULL;

    RITZ_CHECK(ritz_path_folder(path, &folder));
    RITZ_REFUSE_IF(!realpath(folder, state->here), RITZ_ERR_FILE,
                   "there is no folder '%s'", folder);
    state->source[0] = '\0';
    state->skipping = false;
    RITZ_CHECK(ritz_text_read(path, &text));
    state->file = path;
    state->number = 0;
    state->rest = text;
    while (state->rest && *state->rest) {
        snprintf(where, sizeof where, "%s:%d", path, state->number + 1);
        RITZ_CHECK_IN(where, run_line(state));
    }
    return RITZ_OK;
}
