/*
 * Command lines of the Ritz tools: one table per tool gives the parsing, the
 * range checks and the --help text with its defaults. What every tool has, -o
 * -q -h --version --json --record, comes from a table in cli.c; every other
 * option is long only. Names are never abbreviated: a later release could make
 * an abbreviation ambiguous.
 */
#ifndef RITZ_TOOLS_CLI_CLI_H
#define RITZ_TOOLS_CLI_CLI_H

#include <ritz/base.h>
#include <ritz/container.h>

#include <jansson.h>

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum {
    CLI_MAX_LIST = 256,
    CLI_MAX_COMMAND = 4096,
    CLI_MAX_OPERANDS = 3,
    CLI_MAX_OUTPUTS = 8,
    CLI_MAX_DEPTH = 8,
    CLI_MAX_OPTIONS = 80,
    CLI_DURATION = 32,
};

typedef enum cli_kind {
    CLI_KIND_END,
    CLI_KIND_ACTION,
    CLI_KIND_FLAG,
    CLI_KIND_INT,
    CLI_KIND_REAL,
    CLI_KIND_PAIR,
    CLI_KIND_TEXT,
    CLI_KIND_WORD,
    CLI_KIND_LIST,
    CLI_KIND_HELP,
    CLI_KIND_VERSION,
} cli_kind;

/* The arguments of an option that may be repeated, in order. */
typedef struct cli_list {
    int count;
    const char *text[CLI_MAX_LIST];
} cli_list;

typedef struct cli_option {
    cli_kind kind;
    char letter;  /* only -o, -q and -h have one */
    bool written; /* the text names an output file */
    union {       /* the default, and then the value */
        void (*action)(void);
        bool *flag;
        int64_t *whole;
        double *real; /* of a pair: two */
        const char **text;
        cli_list *list;
    } to;
    const char *name;
    const char *argument; /* what --help calls it; of a word all: "on|off" */
    double min, max;      /* range of a number; a default outside is none */
    const char *help;
} cli_option;

/* Rows of a table: kind and place of a value, held to each other by the
   compiler. */
#define CLI_ROW(KIND, member, sign, word, place, value, low, high, says)       \
    {                                                                          \
        .kind = CLI_KIND_##KIND, .letter = (sign), .to.member = (place),       \
        .name = (word), .argument = (value), .min = (low), .max = (high),      \
        .help = (says)                                                         \
    }
#define CLI_ACTION(word, function, says)                                       \
    CLI_ROW(ACTION, action, 0, word, function, NULL, 0.0, 0.0, says)
#define CLI_FLAG(word, place, says)                                            \
    CLI_ROW(FLAG, flag, 0, word, place, NULL, 0.0, 0.0, says)
#define CLI_INT(word, place, value, low, high, says)                           \
    CLI_ROW(INT, whole, 0, word, place, value, low, high, says)
#define CLI_REAL(word, place, value, low, high, says)                          \
    CLI_ROW(REAL, real, 0, word, place, value, low, high, says)
/* "LOW,HIGH", ascending and not negative; [0, 0] as long as it is not given */
#define CLI_PAIR(word, place, value, says)                                     \
    CLI_ROW(PAIR, real, 0, word, place, value, 0.0, 0.0, says)
#define CLI_TEXT(word, place, value, says)                                     \
    CLI_ROW(TEXT, text, 0, word, place, value, 0.0, 0.0, says)
/* Name of an output file. It is compared with all inputs and with the other
   outputs, and the file appears when the run has succeeded (see cli_finish). */
#define CLI_OUTPUT(word, place, value, says)                                   \
    {                                                                          \
        .kind = CLI_KIND_TEXT, .written = true, .to.text = (place),            \
        .name = (word), .argument = (value), .help = (says)                    \
    }
#define CLI_WORD(word, place, words, says)                                     \
    CLI_ROW(WORD, text, 0, word, place, words, 0.0, 0.0, says)
#define CLI_LIST(word, place, value, says)                                     \
    CLI_ROW(LIST, list, 0, word, place, value, 0.0, 0.0, says)

/* A text that is written whole or not at all. */
typedef struct cli_table {
    FILE *file; /* to write to, in memory */
    char *text;
    size_t size;
} cli_table;

ritz_status cli_table_new(cli_table *out);

/** Make sure that `text` holds all that was written. @return RITZ_ERR_MEMORY */
ritz_status cli_table_end(const cli_table *table);

/** Write the table as a draft, then rename it. Control characters other than
 * ends of lines and tabs become '?'. */
ritz_status cli_table_save(cli_table *table, const char *path);

/** Write the table into a file that the caller owns, such as a draft. */
ritz_status cli_table_write(cli_table *table, const char *path);

void cli_table_free(cli_table *table);

typedef struct cli_operand {
    const char *name; /* "COMPONENT" */
    const char *help;
    bool many; /* one or more; the last alone */
} cli_operand;

typedef struct cli_program {
    const char *name;
    cli_operand operands[CLI_MAX_OPERANDS];
    const char *summary;
    const char *example;
    const char *output;   /* what -o is */
    bool output_optional; /* works without -o */
    bool threads;         /* does long work: see cli_parse */
} cli_program;

/* One run: what the command line said, and what is to be reported. */
typedef struct cli_run {
    const cli_program *program;
    const cli_option *options;   /* of the program alone */
    bool given[CLI_MAX_OPTIONS]; /* which of them the command line has */
    int num_operands;
    char **operand;
    char **argv;
    const char *output, *record;
    const char *memory; /* --memory; NULL: not given */
    /* number of outputs that options name, these two included */
    int num_written;
    const char *written[CLI_MAX_OUTPUTS];
    bool quiet, json;
    bool unread;                          /* nobody reads what is said */
    bool kept;                            /* see cli_keep_outputs */
    char interrupted[4 * RITZ_NAME_SIZE]; /* what a signal ended early, or "" */
    char diverted[CLI_MAX_COMMAND];       /* OUTPUT.interrupted, if one did */
    char command[CLI_MAX_COMMAND]; /* for the containers that the tool writes */
    json_t *report;                /* of --json; sink.h adds to it */
    json_t *open[CLI_MAX_DEPTH];   /* in it, where values go at present */
    int depth;
    json_t *warnings;
    json_t *line;     /* of --record: method, order, errors */
    cli_table said;   /* all text, with --quiet and --json too */
    ritz_stamp stamp; /* command and inputs, as cli_stamp last gave them */
    int64_t num_inputs, room;
    char **input;  /* "SHA256  NAME" of each file read */
    int64_t bytes; /* of those files */
    bool piped;    /* one of them is no regular file */
    double began;  /* seconds, of the monotonic clock; 0 while parsing */
} cli_run;

/**
 * Parse the command line into the variables of the table and into @p run.
 *
 * It executes --help, --version and actions itself, and ends the program with
 * status 2 on a command line that is wrong. From then on a signal that ends the
 * program removes unfinished files, long work shows its progress on a terminal,
 * and outputs are held back until cli_finish. Two outputs under one name are
 * refused.
 */
void cli_parse(const cli_program *program, const cli_option *options, int argc,
               char **argv, cli_run *run);

/** End the program with status 2 on options that contradict each other, etc. */
[[gnu::format(printf, 2, 3)]] _Noreturn void
cli_refuse(const cli_program *program, const char *format, ...);

/** The same for a name that is none of @p count: "no method 'x', is 'y'
 * meant?". */
_Noreturn void cli_refuse_name(const cli_program *program, const char *what,
                               const char *word, int64_t count,
                               const char *const *names);

/** Whether the command line has that option of the program, "every", even if its
 * value is the default. */
bool cli_given(const cli_run *run, const char *name);

/** The row of a table that has that name, as ritz_row_find, or the end of the
 * program. */
const void *cli_choose(const cli_program *program, const char *what,
                       const char *word, const void *table);

/** What a list of methods says below each; NULL: nothing is known. */
void cli_list_advice(const char *when, const char *cost, const char *holds,
                     const char *fails);

/** The next word of "A,B,C", which is cut off; false if none is left. */
bool cli_next(const char **list, char word[RITZ_NAME_SIZE]);

/**
 * Set the limit of --memory: a number, and K, M, G or T of powers of 1024, with
 * or without "iB" or "B".
 *
 * @return false if the text is no such size; then there is no limit but the
 *         usual one
 */
bool cli_limit_memory(const char *text);

/**
 * Register a file before it is read: its SHA-256 is stored in what the tool
 * writes. A file that is registered twice counts once. The sum of a pipe, which
 * can be read only once, is '-'. An output that is the same file, by device and
 * inode, is refused.
 *
 * A program with `threads` starts again, with as many threads as there are
 * cores, if its inputs are large and OMP_THREAD_LIMIT is not set. Call this
 * therefore before anything is written or printed. If the operands alone are
 * large, it has started again in cli_begin_again().
 */
ritz_status cli_input(cli_run *run, const char *path);

/** Start a program with `threads` again as cli_input() does, before its operands
 * are looked at, if they are files and large. */
void cli_begin_again(const cli_run *run);

/** Register a file whose reader computes the SHA-256 and passes it to
 * cli_input_sum. */
ritz_status cli_input_unread(cli_run *run, const char *path);
void cli_input_sum(cli_run *run, const char *path, const char *digest);

/**
 * Check, before long work, that a file can be created at @p path: create one in
 * its folder and remove it. cli_input does this for outputs that options name.
 */
ritz_status cli_can_write(const char *path);

/** The command and the inputs so far, for containers; borrowed from run. */
const ritz_stamp *cli_stamp(cli_run *run);

/** Print a warning on standard error and add it to the report, once. */
[[gnu::format(printf, 2, 3)]] void cli_warn(cli_run *run, const char *format,
                                            ...);

/** Values that JSON cannot hold become null, or '?' in a text. */
json_t *cli_real(double value);
json_t *cli_string(const char *text);

/** A value as JSON; control characters that could act on a terminal are written
 * as \u009b and the like. The caller frees it; NULL: no memory. */
char *cli_json(const json_t *value, size_t flags);

/** Write to standard error. Every message of a tool goes through this function,
 * which prints '?' for characters that could act on a terminal, except
 * newlines. */
[[gnu::format(printf, 1, 2)]] void cli_complain(const char *format, ...);
[[gnu::format(printf, 1, 0)]] void cli_complain_list(const char *format,
                                                     va_list args);

/** Set method and order (-1: none) in the line that --record appends. */
void cli_record(cli_run *run, const char *method, int64_t order);
/** Record which engine found modes, and why it was chosen; NULL: no choice. */
void cli_record_engine(cli_run *run, const char *engine, const char *reason);
void cli_record_error(cli_run *run, const char *name, double value);
/** Record why an error, a bound, is large; "": no cause. */
void cli_record_cause(cli_run *run, const char *name, const char *cause);

/**
 * Append another line to the file of --record at once, with the tool, the
 * command and the inputs added. Does nothing without --record.
 *
 * @param[in] line  given away
 */
ritz_status cli_record_line(cli_run *run, json_t *line);

/**
 * From now on signals that end the program remove unfinished files first, and
 * HDF5 files are read by another process before HDF5 opens them (cli/walk.h).
 * If standard error is a terminal, steps of the library are shown as one line.
 * Steps that will take more than ten minutes give a warning, as soon as the
 * first ones show it.
 */
void cli_watch(cli_run *run);

/** Show progress also if standard error is no terminal, because another program
 * passes it on to one. To be called before the command line is read. */
void cli_is_passed_on(void);

/** From now on the program ends with status 1 if JSON gets no memory, and keeps
 * freed memory for its next arrays. */
void cli_prepare(void);

/**
 * From now on the first SIGINT or SIGTERM only makes cli_interrupted true, so
 * that the tool can write what it has found so far; the second one ends the
 * program. A signal that is ignored stays ignored.
 */
void cli_interruptible(void);
bool cli_interrupted(void);

/** cli_interrupted() with the parameter of ritz_stop.asked and the like, which
 * is not used. */
bool cli_stop(void *context);

/** Undo cli_interruptible(): from now on the first signal ends the program.
 * @return whether a signal came in between */
bool cli_uninterruptible(void);

/**
 * From now on run->output is OUTPUT.interrupted, and containers get the
 * attribute `interrupted`. cli_finish publishes the file although the status is
 * a failure.
 *
 * @param[in] what  the attribute: "the search, after 12 candidates"
 * @return RITZ_ERR_ARGUMENT if the name of the output is too long
 */
ritz_status cli_divert(cli_run *run, const char *what);

/** The program is about to end by itself. After cli_watch and without this
 * call, an exit counts as a failure within a library. */
void cli_unwatch(void);

/** "12.5 s", "3 min", "5.2 h" or "4 days"; returns @p out. */
const char *cli_duration(double seconds, char out[CLI_DURATION]);

/** Seconds of a monotonic clock. */
double cli_clock(void);

/** Seconds of each kind of step that the library reported, in order of their
 * first one: from each step to the next of another kind. "start" is the time
 * before the first step. */
json_t *cli_phases(void);

/** Remove the line of progress, before something else is written. */
void cli_watch_clear(void);

/**
 * Publish the outputs in cli_finish even if the status is a failure: they are
 * documented to be there when a limit is missed.
 */
void cli_keep_outputs(cli_run *run);

/**
 * Exit status for main. Appends the record, prints the report, says why the run
 * failed, and checks standard output. Then all outputs get their names; if any
 * of these steps has failed, none does.
 */
int cli_finish(cli_run *run, ritz_status status);

#endif
