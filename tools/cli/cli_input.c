/* Files that a run reads: their sums, and whether the work is large. */
#include "cli/cli.h"

#include "base/alloc.h"
#include "base/draft.h"

#include <ritz/base.h>

#include <cblas.h>

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/*
 * Bytes of input from which more threads than one are worth their price. Below
 * it threads that wait for each other cost more than they bring: ten times the
 * whole run where other work keeps the cores busy (measured on data/dualspin).
 */
enum { LARGE = 1 << 20 };

/*
 * As many threads as there are cores, or as the environment allows: a BLAS that
 * counts on more than OpenMP may start waits for them for ever.
 */
static int allowed_threads(void)
{
    static const char *const limits[] = {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT"};
    int64_t threads = sysconf(_SC_NPROCESSORS_ONLN);

    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        const char *text = getenv(limits[k]);
        int64_t limit = 0;

        if (text && ritz_text_whole(text, &limit) && limit > 0 &&
            limit < threads)
            threads = limit;
    }
    return threads > 0 ? (int)threads : 1;
}

/*
 * Start once more with a limit of threads, where there is none and the inputs
 * are large. The limit is heeded only if it stands when a process starts;
 * without it CHOLMOD's own threads crowd out those of the BLAS. If that cannot
 * be done, it costs only speed. A pipe cannot be read again, and what was said
 * is not to be said twice.
 */
static void limit_threads(cli_run *run, const struct stat *file)
{
    char cores[24];
    char self[CLI_MAX_COMMAND];
    ssize_t length = 0;

    run->piped = run->piped || !S_ISREG(file->st_mode);
    run->bytes += S_ISREG(file->st_mode) ? file->st_size : 0;
    openblas_set_num_threads(run->bytes < LARGE ? 1 : allowed_threads());
    if (!run->program->threads || run->bytes < LARGE || run->piped ||
        json_array_size(run->warnings) > 0 || getenv("OMP_THREAD_LIMIT"))
        return;
    length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        return;
    self[length] = '\0';
    snprintf(cores, sizeof cores, "%ld", sysconf(_SC_NPROCESSORS_ONLN));
    if (setenv("OMP_THREAD_LIMIT", cores, 1) == 0 &&
        setenv("OMP_NUM_THREADS", cores, 0) == 0 &&
        setenv("OMP_WAIT_POLICY", "passive", 0) == 0)
        execv(self, run->argv);
}

static ritz_status check_opens(const char *path)
{
    FILE *file = fopen(path, "rb");

    RITZ_REFUSE_IF(!file, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                   strerror(errno));
    fclose(file);
    return RITZ_OK;
}

/* The line of an input, "SUM  PATH"; NULL if it is none yet. */
static char **find_input(const cli_run *run, const char *path)
{
    for (int64_t k = 0; k < run->num_inputs; k++)
        if (strcmp(strstr(run->input[k], "  ") + 2, path) == 0)
            return &run->input[k];
    return NULL;
}

static ritz_status add_input(cli_run *run, const char *path, bool sum)
{
    char digest[RITZ_DIGEST_SIZE] = "-";
    RITZ_OWN_ARRAY char *line = NULL;
    char **more = NULL;
    struct stat there = {0};

    if (find_input(run, path))
        return RITZ_OK;
    if (stat(path, &there) == 0)
        limit_threads(run, &there);
    if ((S_ISREG(there.st_mode) && sum) || there.st_mode == 0)
        RITZ_CHECK(ritz_digest_file(path, digest));
    else if (S_ISREG(there.st_mode))
        RITZ_CHECK(check_opens(path));
    RITZ_REFUSE_IF(S_ISDIR(there.st_mode), RITZ_ERR_FILE, "'%s' is a folder",
                   path);
    more =
        realloc(run->input, (size_t)(run->num_inputs + 1) * sizeof *run->input);
    RITZ_REFUSE_IF(!more, RITZ_ERR_MEMORY, "no memory for '%s'", path);
    run->input = more;
    RITZ_CHECK_NEW(line, (int64_t)(strlen(digest) + strlen(path) + 3));
    snprintf(line, strlen(digest) + strlen(path) + 3, "%s  %s", digest, path);
    RITZ_MOVE(run->input[run->num_inputs++], line);
    if (run->output && run->program->threads && run->num_inputs == 1)
        RITZ_CHECK(cli_can_write(run->output));
    return RITZ_OK;
}

ritz_status cli_input(cli_run *run, const char *path)
{
    return add_input(run, path, true);
}

ritz_status cli_input_unread(cli_run *run, const char *path)
{
    return add_input(run, path, false);
}

ritz_status cli_input_sum(cli_run *run, const char *path, const char *digest)
{
    char **line = find_input(run, path);
    size_t size = strlen(digest) + strlen(path) + 3;
    struct stat there = {0};
    char *whole = NULL;

    if (!line || (*line)[0] != '-' || stat(path, &there) != 0 ||
        !S_ISREG(there.st_mode))
        return RITZ_OK;
    whole = malloc(size);
    RITZ_REFUSE_IF(!whole, RITZ_ERR_MEMORY, "no memory for '%s'", path);
    snprintf(whole, size, "%s  %s", digest, path);
    free(*line);
    *line = whole;
    return RITZ_OK;
}

ritz_status cli_can_write(const char *path)
{
    ritz_draft draft = {0};
    ritz_status status = ritz_draft_new(path, &draft);

    ritz_draft_free(&draft);
    return ritz_context(status, path);
}

const ritz_stamp *cli_stamp(cli_run *run)
{
    run->stamp = (ritz_stamp){run->command, run->num_inputs, run->input};
    return &run->stamp;
}
