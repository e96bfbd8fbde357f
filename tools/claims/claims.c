/* Claims files: a table of statements, each one line, run in order. */
#include "claims/claims.h"

#include "base/alloc.h"

#include <ritz/base.h>

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* The answer of a tool is read from here, in the folder of the state. */
static const char answer_name[] = "answer.json";

static ritz_status set_source(claims_state *state, const claims_line *line)
{
    size_t used = 0;

    RITZ_REFUSE_IF(line->count < 2, RITZ_ERR_FORMAT, "a source is not named");
    state->source[0] = '\0';
    for (int k = 1; k < line->count && used < sizeof state->source; k++)
        used +=
            (size_t)snprintf(state->source + used, sizeof state->source - used,
                             "%s%s", k > 1 ? " " : "", line->word[k]);
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

/* In the child: the tool with --json, its words to the answer. */
static _Noreturn void become(const claims_state *state, const char *tool,
                             char **argv)
{
    int out = -1;

    if (chdir(state->folder) == 0)
        out = open(answer_name, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (out >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(out, STDERR_FILENO) >= 0)
        execv(tool, argv);
    _exit(127);
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

static void remember_command(claims_state *state, const claims_line *line)
{
    state->command[0] = '\0';
    for (int k = 1; k < line->count; k++)
        sink_append(state->command, sizeof state->command, "%s%s",
                    k > 1 ? " " : "", line->word[k]);
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
    remember_command(state, line);
    json_decref(state->answer);
    state->answer = NULL;
    fflush(stdout);
    child = fork();
    if (child == 0)
        become(state, tool, argv);
    RITZ_REFUSE_IF(child < 0, RITZ_ERR_FILE, "cannot start '%.40s': %s",
                   line->word[1], strerror(errno));
    while (waitpid(child, &outcome, 0) < 0 && errno == EINTR)
        ;
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
    ritz_status status = RITZ_OK;
    const char *directions = line->count == 4 ? line->word[3] : "0";
    char path[2 * PATH_MAX];
    FILE *file = NULL;
    int64_t count = 0;

    RITZ_FAIL_IF(line->count < 3 || line->count > 4 ||
                     strchr(line->word[1], '/') ||
                     !ritz_text_whole(line->word[2], &count) || count < 1,
                 RITZ_ERR_FORMAT,
                 "rows are NAME, a number of grids and their directions");
    snprintf(path, sizeof path, "%s/%s", state->folder, line->word[1]);
    file = fopen(path, "w");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s'", path);
    for (int64_t k = 1; k <= count; k++)
        for (const char *at = directions; *at; at++)
            fprintf(file, "%" PRId64 " %c\n", k, *at);
done:
    if (file)
        fclose(file);
    return status;
}

static const struct statement {
    const char *word;
    ritz_status (*run)(claims_state *state, const claims_line *line);
    bool always; /* even while claims are skipped */
} statements[] = {
    {"source", set_source, true},    {"need", need_file, true},
    {"beam", claims_beam, false},    {"rows", write_rows, false},
    {"run", run_tool, false},        {"try", try_tool, false},
    {"expect", claims_expect, true},
};

static ritz_status run_line(claims_state *state, const claims_line *line)
{
    const size_t count = sizeof statements / sizeof *statements;
    size_t k = 0;

    while (k < count && strcmp(statements[k].word, line->word[0]) != 0)
        k++;
    RITZ_REFUSE_IF(
        k == count, RITZ_ERR_FORMAT,
        "'%.40s' is none of source, need, beam, rows, text, run, try, "
        "expect",
        line->word[0]);
    if (statements[k].always || !state->skipping)
        RITZ_CHECK(statements[k].run(state, line));
    return RITZ_OK;
}

/* "text NAME": the lines that follow, indented as the first of them, become
 * that file. */
static ritz_status write_text(const claims_state *state,
                              const claims_line *line, char **rest, int *number)
{
    ritz_status status = RITZ_OK;
    char path[2 * PATH_MAX];
    size_t indent = *rest ? strspn(*rest, " \t") : 0;
    FILE *file = NULL;

    RITZ_FAIL_IF(line->count != 2 || strchr(line->word[1], '/'),
                 RITZ_ERR_FORMAT, "a text has one name");
    snprintf(path, sizeof path, "%s/%s", state->folder, line->word[1]);
    file = fopen(path, "w");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s'", path);
    while (*rest && (**rest == ' ' || **rest == '\t')) {
        size_t blank = strspn(*rest, " \t");
        char *end = strchr(*rest, '\n');

        if (end)
            *end = '\0';
        fprintf(file, "%s\n", *rest + (blank < indent ? blank : indent));
        *rest = end ? end + 1 : NULL;
        ++*number;
    }
done:
    if (file && fclose(file) != 0 && status == RITZ_OK) {
        ritz_record("cannot write '%s'", path);
        status = RITZ_ERR_FILE;
    }
    return status;
}

static ritz_status run_text(claims_state *state, const char *path, char *text)
{
    ritz_status status = RITZ_OK;
    claims_line line = {.file = path};
    char *rest = text;
    int number = 0;

    while (rest && *rest) {
        char *now = rest;
        char *end = strchr(now, '\n');

        if (end)
            *end = '\0';
        rest = end ? end + 1 : NULL;
        line.number = ++number;
        RITZ_TRY(claims_cut(state, now, &line));
        if (line.count > 0 && strcmp(line.word[0], "text") == 0)
            RITZ_TRY(write_text(state, &line, &rest, &number));
        else if (line.count > 0)
            RITZ_TRY(run_line(state, &line));
        claims_line_free(&line);
    }
done:
    claims_line_free(&line);
    if (status != RITZ_OK) {
        char where[PATH_MAX + 32];

        snprintf(where, sizeof where, "%s:%d", path, line.number);
        status = ritz_context(status, where);
    }
    return status;
}

ritz_status claims_file(claims_state *state, const char *path)
{
    const char *slash = strrchr(path, '/');
    char folder[PATH_MAX] = ".";
    RITZ_OWN_ARRAY char *text = NULL;

    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path + 1), path);
    RITZ_REFUSE_IF(!realpath(folder, state->here), RITZ_ERR_FILE,
                   "there is no folder '%s'", folder);
    state->source[0] = '\0';
    state->skipping = false;
    RITZ_CHECK(ritz_text_read(path, &text));
    return run_text(state, path, text);
}
