/* What a run tells while it works: progress, warnings, the time that long work
   will take; and what it leaves when a signal or a library ends it. */
#include "cli/cli.h"

#include "base/draft.h"
#include "base/text.h"
#include "cli/walk.h"

#include <inttypes.h>
#include <malloc.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Neither a handler nor an observer has an argument: state is kept here. */
static volatile sig_atomic_t shown; /* a line of progress is on the screen */
static double last;                 /* when it was written, by cli_clock */
static const char *last_of;         /* the step that it names */
static double credit;               /* lines that may be written at once */
static double counted;              /* when it was counted */
static cli_run *watched;            /* the run whose steps are observed */
static bool on_terminal;            /* progress is shown */
static bool passed_on;              /* by another program, to a terminal */

enum { LINES_PER_SECOND = 10 };

static const char erase[] = "\r\033[K";

double cli_clock(void)
{
    struct timespec now = {0};

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The signal is raised again with its own effect, so that whoever started the
 * program sees what ended it; held back here, it comes on return. */
static void end_program(int number)
{
    ritz_draft_discard_all();
    if (shown && write(STDERR_FILENO, erase, sizeof erase - 1) < 0)
        shown = 0;
    signal(number, SIG_DFL);
    raise(number);
}

/* Catch all signals that end a program, sent by others or raised by a defect.
   The handler has its own stack, because a stack overflow is one such defect. A
   signal that is ignored (nohup) or has a handler keeps its setting. */
static void watch_signals(void)
{
    static const int numbers[] = {SIGINT,    SIGTERM, SIGHUP,  SIGQUIT, SIGXCPU,
                                  SIGPIPE,   SIGALRM, SIGUSR1, SIGUSR2, SIGPROF,
                                  SIGVTALRM, SIGABRT, SIGSEGV, SIGBUS,  SIGFPE,
                                  SIGILL,    SIGSYS,  SIGTRAP};
    static char room[1 << 16];
    const stack_t other = {.ss_sp = room, .ss_size = sizeof room};
    struct sigaction before;
    struct sigaction action = {.sa_handler = end_program};

    sigemptyset(&action.sa_mask);
    if (sigaltstack(&other, NULL) == 0)
        action.sa_flags = SA_ONSTACK;
    signal(SIGXFSZ, SIG_IGN); /* a write past a limit fails, and is reported */
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (sigaction(numbers[k], NULL, &before) == 0 &&
            before.sa_handler == SIG_DFL)
            sigaction(numbers[k], &action, NULL);
}

static volatile sig_atomic_t interrupted; /* there was a first signal */

/* The first signal is only noted. A second one ends the program, also in code
   that does not ask cli_interrupted. */
static void note_signal(int number)
{
    if (interrupted)
        end_program(number);
    interrupted = 1;
}

/* Let one handler of SIGINT and SIGTERM take the place of another. */
static void replace_handler(void (*from)(int), void (*to)(int), int flags)
{
    static const int numbers[] = {SIGINT, SIGTERM};
    struct sigaction before;
    struct sigaction action = {.sa_handler = to, .sa_flags = flags};

    sigemptyset(&action.sa_mask);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (sigaction(numbers[k], NULL, &before) == 0 &&
            before.sa_handler == from)
            sigaction(numbers[k], &action, NULL);
}

void cli_interruptible(void)
{
    replace_handler(end_program, note_signal, SA_ONSTACK | SA_RESTART);
}

bool cli_uninterruptible(void)
{
    replace_handler(note_signal, end_program, SA_ONSTACK);
    return cli_interrupted();
}

bool cli_interrupted(void)
{
    return interrupted != 0;
}

bool cli_stop(void *context)
{
    (void)context;
    return cli_interrupted();
}

const char *cli_duration(double seconds, char out[CLI_DURATION])
{
    static const struct unit {
        const char *name;
        double seconds;
    } units[] = {{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"days", 86400.0}};
    int k = 0;

    while (k < 3 && seconds >= 2.0 * units[k + 1].seconds)
        k++;
    snprintf(out, CLI_DURATION, "%.3g %s", seconds / units[k].seconds,
             units[k].name);
    return out;
}

void cli_warn(cli_run *run, const char *format, ...)
{
    char text[512];
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    ritz_text_clean(text);
    for (size_t k = 0; k < json_array_size(run->warnings); k++)
        if (strcmp(json_string_value(json_array_get(run->warnings, k)), text) ==
            0)
            return;
    json_array_append_new(run->warnings, cli_string(text));
    if (!run->quiet) {
        cli_watch_clear();
        fflush(stdout);
        cli_complain("%s: warning: %s\n", run->program->name, text);
    }
}

/* --- steps ---------------------------------------------------------------- */

/* Seconds between a step and the next one of another name, summed by name. */
typedef struct phase {
    const char *what; /* text of the library */
    double seconds;
} phase;

enum { MOST_PHASES = 24 };
static phase phases[MOST_PHASES]; /* in order of their first step */
static int num_phases;
static int now_in;         /* the phase of the last step */
static double phase_began; /* by cli_clock */

/* Add the seconds since the last step to its phase. */
static void end_phase(void)
{
    const double now = cli_clock();

    phases[now_in].seconds += now - phase_began;
    phase_began = now;
}

/* Steps of further names, when there is no room, belong to the last phase. */
static void begin_phase(const char *what)
{
    int k = 0;

    if (phases[now_in].what == what)
        return;
    end_phase();
    while (k < num_phases && strcmp(phases[k].what, what) != 0)
        k++;
    if (k == num_phases && k < MOST_PHASES)
        phases[num_phases++] = (phase){what, 0.0};
    now_in = k < MOST_PHASES ? k : MOST_PHASES - 1;
}

json_t *cli_phases(void)
{
    json_t *out = json_object();

    end_phase();
    for (int k = 0; k < num_phases; k++)
        json_object_set_new(out, phases[k].what, json_real(phases[k].seconds));
    return out;
}

/* A kind of step whose total number is known. */
typedef struct step_series {
    const char *what; /* text of the library */
    int64_t total;
    int64_t first, done; /* number of steps at the start and now */
    double began;
    bool told;
} step_series;

/* Several series at once, because a step may consist of steps of another
   kind. */
static step_series series[8];
static int num_series;

/* The series that a step continues. A step begins a new series if its name is
   new, if it comes before the last one, or if it skips steps and the total is
   another. */
static step_series *find_series(const char *what, int64_t done, int64_t total)
{
    enum { MOST = sizeof series / sizeof *series };
    step_series *found = NULL;

    for (int k = 0; k < MOST && !found; k++)
        if (series[k].what == what)
            found = &series[k];
    if (found && done >= found->done &&
        (found->total == total || done <= found->done + 1)) {
        found->total = total; /* it may be an estimate that changes */
        return found;
    }
    if (!found)
        found = &series[num_series++ % MOST];
    *found = (step_series){what, total, done, done, cli_clock(), false};
    return found;
}

/* Estimate the seconds that all steps of a series take, from its rate so far;
   0: it is too early. */
static double foresee_whole(const step_series *w)
{
    static const double enough = 1.0; /* seconds */
    const double spent = cli_clock() - w->began;

    if (w->done == w->first || spent < enough)
        return 0.0;
    return spent / (double)(w->done - w->first) * (double)(w->total - w->first);
}

/* Warn of long work, once, when its duration can be estimated. */
static void foresee_end(step_series *w)
{
    static const double long_work = 600.0; /* seconds */
    const double whole = foresee_whole(w);
    char text[CLI_DURATION];

    if (w->told || whole < long_work)
        return;
    w->told = true;
    cli_warn(watched, "%s: all %" PRId64 " take about %s at this rate", w->what,
             w->total, cli_duration(whole, text));
}

/* Whether a line for a step is written now. A step that goes on is written ten
   times a second. One of another name is written at once, as it may take long,
   but where short steps alternate only ten of them in a second. */
static bool is_due(const char *what, double now)
{
    const bool begins = what != last_of;

    credit =
        fmin(LINES_PER_SECOND, credit + LINES_PER_SECOND * (now - counted));
    counted = now;
    if (begins ? credit < 1.0 : (now - last) * LINES_PER_SECOND < 1.0)
        return false;
    credit = fmax(0.0, credit - 1.0);
    last = now;
    last_of = what;
    return true;
}

/* "candidates: 12 of 59, about 3.2 s left". @param[in] w  NULL: the total is
   not known */
static void show_progress(const char *what, int64_t done, const step_series *w)
{
    char line[80], text[CLI_DURATION];
    const double now = cli_clock();
    const double whole = w ? foresee_whole(w) : 0.0;
    int length = 0;

    if (!is_due(what, now))
        return;
    if (w && whole > 0.0)
        length = snprintf(
            line, sizeof line, "%s: %" PRId64 " of %" PRId64 ", about %s left",
            what, done, w->total,
            cli_duration(fmax(0.0, whole - (now - w->began)), text));
    else if (w)
        length = snprintf(line, sizeof line, "%s: %" PRId64 " of %" PRId64,
                          what, done, w->total);
    else if (done > 0)
        length = snprintf(line, sizeof line, "%s: %" PRId64, what, done);
    else
        length = snprintf(line, sizeof line, "%s", what);
    if (length > 0) {
        shown = 1;
        fprintf(stderr, "%s%s", erase, line);
        fflush(stderr);
    }
}

static void follow_step(const char *what, int64_t done, int64_t total)
{
    step_series *w = total > 0 ? find_series(what, done, total) : NULL;

    begin_phase(what);
    if (w) {
        w->done = done;
        foresee_end(w);
    }
    if (on_terminal)
        show_progress(what, done, w);
}

/* A library that cannot go on may end the program with any status, Fortran with
   0. Without its output such a run has failed. */
static void end_early(void)
{
    ritz_draft_discard_all();
    if (!watched)
        return;
    cli_complain("%s: ended by a library, perhaps for want of memory\n",
                 watched->program->name);
    _exit(EXIT_FAILURE);
}

void cli_unwatch(void)
{
    watched = NULL;
}

/* Callers do not check each allocation of JSON, and an incomplete report would
   be wrong: end the program. */
static void *allocate_json(size_t size)
{
    void *block = malloc(size);

    if (block)
        return block;
    cli_complain("%s: no memory for the report\n",
                 watched ? watched->program->name : "ritz");
    cli_unwatch();
    exit(EXIT_FAILURE);
}

/*
 * glibc takes large blocks from the system and returns them with free(), and the
 * system clears them again. It raises the size from which it does so with each
 * block that is freed, up to 32 MiB, and keeps twice as much freed memory at the
 * end of the heap. Begin with these values: otherwise a small model has its
 * matrices cleared page by page again and again. Values that the environment
 * states, as cli_run.c does for large models, are kept.
 */
static void keep_freed_memory(void)
{
    enum { LARGEST = 32 << 20 };

    if (getenv("GLIBC_TUNABLES"))
        return;
    (void)mallopt(M_MMAP_THRESHOLD, LARGEST);
    (void)mallopt(M_TRIM_THRESHOLD, 2 * LARGEST);
}

void cli_prepare(void)
{
    keep_freed_memory();
    json_set_alloc_funcs(allocate_json, free);
}

void cli_is_passed_on(void)
{
    passed_on = true;
}

void cli_watch(cli_run *run)
{
    watched = run;
    ritz_container_guard(walk_file);
    for (int k = 0; k < run->num_operands; k++)
        walk_ahead(run->operand[k]);
    atexit(end_early);
    on_terminal = !run->quiet && (passed_on || isatty(STDERR_FILENO));
    watch_signals();
    last = counted = phase_began = cli_clock();
    credit = LINES_PER_SECOND;
    phases[num_phases++] = (phase){"start", 0.0};
    ritz_monitor_observe(follow_step);
}

void cli_watch_clear(void)
{
    if (shown)
        fputs(erase, stderr);
    shown = 0;
}
