/* A run: its threads, the files that it reads, its report and record, and the
   status and outputs that it ends with. */
#include "cli/cli.h"
#include "cli/cores.h"

#include "base/alloc.h"
#include "base/crowd.h"
#include "base/draft.h"
#include "base/text.h"
#include "linear/blas_threads.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- threads -------------------------------------------------------------- */

/*
 * Bytes of input from which more threads than one are worth their price. Below
 * it threads that wait for each other cost more than they bring: ten times the
 * whole run where other work keeps the cores busy (measured on data/dualspin).
 */
enum { LARGE = 1 << 20 };

/*
 * How many times an idle thread of GNU OpenMP looks for work before it sleeps.
 * If threads sleep at once, the factor of a model of 55 000 dofs takes 3.0 s;
 * with 3000 to 100 000 times it takes 1.5 s. A larger number keeps cores busy
 * that other threads, of Ritz or of other programs, need: while another program
 * has one of two cores, the factor takes 2 s with 100 times and 6 s with 5000,
 * because threads that spin are stopped when they have work.
 */
static const char *const SPINS = "5000";
static const char *const SPINS_CROWDED = "100";

/*
 * How glibc's malloc works for large models: in pages of 2 MiB where the kernel
 * has them, and blocks below 256 MiB are reused instead of given back to the
 * kernel, which clears each page that it hands out again. With both,
 * Craig-Bampton of 43 000 dofs takes a sixth less time, and 6 % more memory.
 * With one arena, what a thread allocates takes the place of what another one
 * has freed. MUMPS in a thread of its own had twice the system time without.
 */
static const char *const MALLOC = "glibc.malloc.arena_max=1:"
                                  "glibc.malloc.hugetlb=1:"
                                  "glibc.malloc.mmap_threshold=268435456:"
                                  "glibc.malloc.trim_threshold=268435456";

/*
 * As many threads as the process may use cores, or as the environment allows: a
 * BLAS that counts on more than OpenMP may start waits for them for ever.
 */
static int allowed_threads(void)
{
    static const char *const limits[] = {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT"};
    int64_t threads = cli_cores();

    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        const char *text = getenv(limits[k]);
        int64_t limit = 0;

        if (text && ritz_text_whole(text, &limit) && limit > 0 &&
            limit < threads)
            threads = limit;
    }
    return (int)threads;
}

/* The thread that asks is one of those that will run. */
static const char *spins_for(int threads)
{
    return ritz_cores_crowded(threads - 1) ? SPINS_CROWDED : SPINS;
}

/*
 * If the inputs are large and the environment has no limit of threads: set one,
 * and the settings above, and execute the program again, because OpenMP and
 * malloc read these variables only when a process starts. Without the limit,
 * CHOLMOD's own threads take cores from those of the BLAS. The program is not
 * executed again if an input is a pipe, which cannot be read twice, or if a
 * warning was printed, which would appear twice. A failure costs only speed.
 */
static void execute_again(const cli_run *run, int64_t bytes, bool piped)
{
    char cores[24];
    char self[CLI_MAX_COMMAND];
    ssize_t length = 0;

    if (!run->program->threads || bytes < LARGE || piped ||
        json_array_size(run->warnings) > 0 || getenv("OMP_THREAD_LIMIT"))
        return;
    length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        return;
    self[length] = '\0';
    snprintf(cores, sizeof cores, "%d", allowed_threads());
    if (setenv("OMP_THREAD_LIMIT", cores, 1) == 0 &&
        setenv("OMP_NUM_THREADS", cores, 0) == 0 &&
        setenv("GLIBC_TUNABLES", MALLOC, 0) == 0 &&
        (getenv("OMP_WAIT_POLICY") ||
         setenv("GOMP_SPINCOUNT", spins_for(allowed_threads()), 0) == 0))
        execv(self, run->argv);
}

static void limit_threads(cli_run *run, const struct stat *file)
{
    run->piped = run->piped || !S_ISREG(file->st_mode);
    run->bytes += S_ISREG(file->st_mode) ? file->st_size : 0;
    ritz_blas_threads(run->bytes < LARGE ? 1 : allowed_threads());
    ritz_set_threads(allowed_threads());
    execute_again(run, run->bytes, run->piped);
}

void cli_begin_again(const cli_run *run)
{
    struct stat there;
    int64_t bytes = 0;
    bool piped = false;

    for (int k = 0; k < run->num_operands; k++)
        if (stat(run->operand[k], &there) == 0) {
            piped = piped || !S_ISREG(there.st_mode);
            bytes += S_ISREG(there.st_mode) ? there.st_size : 0;
        }
    execute_again(run, bytes, piped);
}

/* --- files that are read -------------------------------------------------- */

/* The line of an input, "SUM  PATH"; NULL if it is none yet. */
static char *find_input(const cli_run *run, const char *path)
{
    for (int64_t k = 0; k < run->num_inputs; k++)
        if (strcmp(strstr(run->input[k], "  ") + 2, path) == 0)
            return run->input[k];
    return NULL;
}

/* Open for reading as well if that is allowed, to look at the file's last
   line. */
static int open_to_append(const char *path)
{
    const int how = O_CREAT | O_APPEND | O_CLOEXEC;
    struct stat there;
    bool plain = stat(path, &there) != 0 || S_ISREG(there.st_mode);
    int file = plain ? open(path, O_RDWR | how, 0666) : -1;

    return file >= 0 ? file : open(path, O_WRONLY | how, 0666);
}

/* Whether a regular file begins with anything but a record; false if it may not
   be read. */
static bool holds_else(int file)
{
    char text[512];
    struct stat there = {0};
    const bool plain = fstat(file, &there) == 0 && S_ISREG(there.st_mode);
    const ssize_t size = plain ? pread(file, text, sizeof text, 0) : 0;

    for (ssize_t k = 0; k < size; k++)
        if (!strchr(" \t\r\n", text[k]) || text[k] == '\0')
            return text[k] != '{';
    return false;
}

/* Open the file of --record for appending. A file that holds anything but
   records is refused: it may be an input that a failed run did not reach. */
static ritz_status open_record(const char *path, int *out)
{
    int file = -1;

    RITZ_CHECK_IN("--record", ritz_draft_check(path));
    file = open_to_append(path);
    RITZ_REFUSE_IF(file < 0, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                   strerror(errno));
    if (!holds_else(file)) {
        *out = file;
        return RITZ_OK;
    }
    close(file);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "--record: '%s' holds something else than records", path);
}

/* Check that no output is an input so far and, once before long work, that each
   output can be created. */
static ritz_status check_outputs(const cli_run *run)
{
    const bool once = run->program->threads && run->num_inputs == 1;
    int file = -1;

    for (int k = 0; k < run->num_written; k++) {
        const char *path = run->written[k];

        RITZ_CHECK_IN(path, ritz_draft_check(path));
        if (once && path != run->record)
            RITZ_CHECK(cli_can_write(path));
    }
    if (once && run->record) {
        RITZ_CHECK(open_record(run->record, &file));
        close(file);
    }
    return RITZ_OK;
}

static ritz_status add_input(cli_run *run, const char *path, bool sum)
{
    char digest[RITZ_DIGEST_SIZE] = "-";
    struct stat there = {0};
    size_t size = sizeof digest + strlen(path) + 2; /* for any sum */

    if (find_input(run, path))
        return RITZ_OK;
    if (stat(path, &there) == 0)
        limit_threads(run, &there);
    if ((S_ISREG(there.st_mode) && sum) || there.st_mode == 0)
        RITZ_CHECK(ritz_digest_file(path, digest));
    else
        RITZ_REFUSE_IF(S_ISREG(there.st_mode) && access(path, R_OK) != 0,
                       RITZ_ERR_FILE, "cannot open '%s': %s", path,
                       strerror(errno));
    RITZ_REFUSE_IF(S_ISDIR(there.st_mode), RITZ_ERR_FILE, "'%s' is a folder",
                   path);
    RITZ_CHECK_ROOM(run->input, run->num_inputs, run->room);
    RITZ_CHECK_NEW(run->input[run->num_inputs], (int64_t)size);
    snprintf(run->input[run->num_inputs++], size, "%s  %s", digest, path);
    RITZ_CHECK(ritz_draft_protect(path));
    return check_outputs(run);
}

ritz_status cli_input(cli_run *run, const char *path)
{
    return add_input(run, path, true);
}

ritz_status cli_input_unread(cli_run *run, const char *path)
{
    return add_input(run, path, false);
}

void cli_input_sum(cli_run *run, const char *path, const char *digest)
{
    char *line = find_input(run, path);
    struct stat there = {0};

    if (line && line[0] == '-' && stat(path, &there) == 0 &&
        S_ISREG(there.st_mode))
        snprintf(line, RITZ_DIGEST_SIZE + strlen(path) + 2, "%s  %s", digest,
                 path);
}

ritz_status cli_divert(cli_run *run, const char *what)
{
    if (!run->output)
        return RITZ_OK;
    snprintf(run->interrupted, sizeof run->interrupted, "%s", what);
    RITZ_REFUSE_IF(
        snprintf(run->diverted, sizeof run->diverted, "%s.interrupted",
                 run->output) >= (int)sizeof run->diverted,
        RITZ_ERR_ARGUMENT, "the name of '%s' is too long", run->output);
    run->output = run->diverted;
    cli_keep_outputs(run);
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
    run->stamp = (ritz_stamp){
        .command = run->command,
        .num_inputs = run->num_inputs,
        .input = run->input,
        .interrupted = run->interrupted[0] ? run->interrupted : NULL};
    return &run->stamp;
}

/* --- reports -------------------------------------------------------------- */

void cli_record(cli_run *run, const char *method, int64_t order)
{
    if (method && *method)
        json_object_set_new(run->line, "method", cli_string(method));
    if (order >= 0)
        json_object_set_new(run->line, "order", json_integer(order));
}

void cli_record_engine(cli_run *run, const char *engine, const char *reason)
{
    if (*engine)
        json_object_set_new(run->line, "engine", cli_string(engine));
    if (reason)
        json_object_set_new(run->line, "reason", cli_string(reason));
}

/* The object with this key in the line that --record appends. */
static json_t *find_recorded(cli_run *run, const char *key)
{
    json_t *found = json_object_get(run->line, key);

    if (!found) {
        found = json_object();
        json_object_set_new(run->line, key, found);
    }
    return found;
}

void cli_record_error(cli_run *run, const char *name, double value)
{
    json_object_set_new(find_recorded(run, "errors"), name, cli_real(value));
}

void cli_record_cause(cli_run *run, const char *name, const char *cause)
{
    if (*cause)
        json_object_set_new(find_recorded(run, "causes"), name,
                            cli_string(cause));
}

static void print_report(cli_run *run, ritz_status status)
{
    json_t *report = run->report;
    char *text = NULL;

    json_object_set_new(report, "ok", json_boolean(status == RITZ_OK));
    json_object_set_new(report, "output", cli_string(run->output));
    json_object_set(report, "warnings", run->warnings);
    if (status != RITZ_OK)
        json_object_set_new(report, "error", cli_string(ritz_error_message()));
    text = cli_json(report, JSON_INDENT(2));
    if (text)
        puts(text);
    else
        cli_complain("%s: no memory for the report\n", run->program->name);
    free(text);
}

/* Tool, version, command and inputs, which every recorded line has. */
static void sign_line(const cli_run *run, json_t *line)
{
    json_t *inputs = json_array();

    for (int64_t k = 0; k < run->num_inputs; k++)
        json_array_append_new(inputs, cli_string(run->input[k]));
    json_object_set_new(line, "tool", json_string(run->program->name));
    json_object_set_new(line, "version", json_string(ritz_version()));
    json_object_set_new(line, "command", cli_string(run->command));
    json_object_set_new(line, "inputs", inputs);
}

static bool write_all(int file, const char *text, size_t length)
{
    while (length > 0) {
        ssize_t written = write(file, text, length);

        if (written == 0 || (written < 0 && errno != EINTR))
            return false;
        text += written > 0 ? written : 0;
        length -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

/* Whether the last line has no newline, as after a run that was killed. */
static bool is_cut(int file, off_t size)
{
    char end = '\n';

    return size > 0 && pread(file, &end, 1, size - 1) == 1 && end != '\n';
}

/*
 * A line that does not fit is removed again, and a line is never joined to half
 * a line of another run. The lock keeps other tools from writing meanwhile.
 * Where locks do not work, lines do not mix either, because each is written in
 * one call.
 */
static ritz_status append_text(int file, const char *path, const char *text,
                               size_t length)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    struct stat before = {0};
    bool plain = false;
    int error = 0;

    while (fcntl(file, F_SETLKW, &whole) != 0 && errno == EINTR)
        ;
    plain = fstat(file, &before) == 0 && S_ISREG(before.st_mode);
    if ((!plain || !is_cut(file, before.st_size) || write_all(file, "\n", 1)) &&
        write_all(file, text, length))
        return RITZ_OK;
    error = errno;
    if (plain && ftruncate(file, before.st_size) != 0)
        return ritz_fail(RITZ_ERR_FILE,
                         "cannot append to '%s', where half a line is left: %s",
                         path, strerror(error));
    return ritz_fail(RITZ_ERR_FILE, "cannot append to '%s': %s", path,
                     strerror(error));
}

/* Append a line, with the memory used so far. */
static ritz_status append_line(const cli_run *run, json_t *line)
{
    RITZ_OWN_ARRAY char *text = NULL;
    ritz_status status = RITZ_OK;
    struct rusage usage = {0};
    size_t length = 0;
    int file = -1;

    getrusage(RUSAGE_SELF, &usage);
    json_object_set_new(line, "phases", cli_phases());
    json_object_set_new(line, "peak_bytes",
                        json_integer(1024 * (json_int_t)usage.ru_maxrss));
    text = cli_json(line, JSON_COMPACT | JSON_PRESERVE_ORDER);
    RITZ_REFUSE_IF(!text, RITZ_ERR_MEMORY, "no memory for the record");
    length = strlen(text);
    text[length] = '\n'; /* in the place of its NUL */
    RITZ_CHECK(open_record(run->record, &file));
    status = append_text(file, run->record, text, length + 1);
    if (close(file) != 0 && status == RITZ_OK)
        status = ritz_fail(RITZ_ERR_FILE, "cannot append to '%s': %s",
                           run->record, strerror(errno));
    return status;
}

ritz_status cli_record_line(cli_run *run, json_t *line)
{
    ritz_status status = RITZ_OK;

    if (run->record) {
        sign_line(run, line);
        status = append_line(run, line);
    }
    json_decref(line);
    return status;
}

/* Append the record of the run. If this fails, so does the run, and its outputs
   are removed; the message of an earlier failure is kept. */
static ritz_status keep_record(cli_run *run, ritz_status outcome, bool *keep)
{
    char *first = outcome == RITZ_OK ? NULL : strdup(ritz_error_message());
    ritz_status recorded = RITZ_OK;
    struct rusage used = {0};

    getrusage(RUSAGE_SELF, &used);
    sign_line(run, run->line);
    json_object_set_new(run->line, "ok", json_boolean(outcome == RITZ_OK));
    json_object_update_missing_new(
        run->line, json_pack("{s:n, s:n, s:{}}", "method", "order", "errors"));
    json_object_set_new(
        run->line, "seconds",
        json_pack("{s:f, s:f}", "wall", cli_clock() - run->began, "cpu",
                  (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                      1e-6 * (double)(used.ru_utime.tv_usec +
                                      used.ru_stime.tv_usec)));
    recorded = append_line(run, run->line);
    if (recorded != RITZ_OK && first && *keep)
        cli_complain("%s: %s\n", run->program->name, ritz_error_message());
    *keep = *keep && recorded == RITZ_OK;
    if (first)
        ritz_record("%s", first);
    free(first);
    return outcome == RITZ_OK ? recorded : outcome;
}

static void free_run(cli_run *run)
{
    for (int64_t k = 0; k < run->num_inputs; k++)
        free(run->input[k]);
    RITZ_FREE(run->input, run->operand);
    cli_table_free(&run->said);
    json_decref(run->report);
    json_decref(run->warnings);
    json_decref(run->line);
}

void cli_keep_outputs(cli_run *run)
{
    run->kept = true;
}

/* Give all outputs their names, or remove all. If that fails after a record of
   success, a record of failure follows it. */
static ritz_status settle_outputs(cli_run *run, bool keep, ritz_status status)
{
    if (ritz_draft_settle(keep) == RITZ_OK)
        return status;
    cli_complain("%s: %s\n", run->program->name, ritz_error_message());
    if (run->record) {
        json_object_set_new(run->line, "ok", json_false());
        if (append_line(run, run->line) != RITZ_OK)
            cli_complain("%s: %s\n", run->program->name, ritz_error_message());
    }
    return RITZ_ERR_FILE;
}

int cli_finish(cli_run *run, ritz_status status)
{
    const char *name = run->program->name;
    bool worked = run->began > 0.0; /* not --help or the like */
    bool keep = status == RITZ_OK || run->kept;

    cli_watch_clear();
    if (run->record && worked)
        status = keep_record(run, status, &keep);
    if (status != RITZ_OK)
        cli_complain("%s: %s\n", name, ritz_error_message());
    if (run->json && worked)
        print_report(run, status);
    if (ferror(stdout) || fclose(stdout) != 0) {
        cli_complain("%s: cannot write to standard output: %s\n", name,
                     strerror(errno));
        status = RITZ_ERR_FILE;
        keep = false;
    }
    status = settle_outputs(run, keep, status);
    cli_unwatch();
    free_run(run);
    return status == RITZ_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
