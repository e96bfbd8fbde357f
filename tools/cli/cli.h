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
    char letter;  /* for -o, -q and -h alone */
    bool written; /* a text that names a file which the tool writes */
    union {       /* where the default is, and then the value */
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
/* The name of a file that is written: it is compared with all inputs and with
   the other outputs, and made when all is done (see cli_finish) */
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

/** Write it under a name of its own, then give it this one. Control characters
 * other than ends of lines and tabs become '?'. */
ritz_status cli_table_save(cli_table *table, const char *path);

/** Write it into a file that is the caller's own, such as a draft. */
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
    const cli_option *options; /* of the program alone */
    int num_operands;
    char **operand;
    char **argv;
    const char *output, *record;
    int num_written; /* of the files that options name, these among them */
    const char *written[CLI_MAX_OUTPUTS];
    bool quiet, json;
    bool kept;                     /* see cli_keep_outputs */
    char command[CLI_MAX_COMMAND]; /* for the file that it makes */
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
 * Answers --help, --version and actions itself, and ends the program with
 * status 2 on a command line that it does not understand. From then on a
 * signal that ends the program leaves no unfinished file, long work shows its
 * progress on a terminal, and files that are written are held back until
 * cli_finish. Two outputs under one name are refused.
 */
void cli_parse(const cli_program *program, const cli_option *options, int argc,
               char **argv, cli_run *run);

/** End the program with status 2: the command line makes no sense. */
[[gnu::format(printf, 2, 3)]] _Noreturn void
cli_refuse(const cli_program *program, const char *format, ...);

/** The same for a name that is none of @p count: "no method 'x', is 'y'
 * meant?". */
_Noreturn void cli_refuse_name(const cli_program *program, const char *what,
                               const char *word, int64_t count,
                               const char *const *names);

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
 * Remember a file that is about to be read: its SHA-256 goes into what is
 * written. One that is named again counts once. A pipe, which can be read only
 * once, has '-' for its sum. An output that is the same file, by device and
 * inode, is refused.
 *
 * A program with `threads` starts once more when its inputs are large and
 * OMP_THREAD_LIMIT is not set, with as many threads as there are cores. So call
 * this before anything is written or said.
 */
ritz_status cli_input(cli_run *run, const char *path);

/** Remember a file whose reader knows its SHA-256 and gives it to
 * cli_input_sum. */
ritz_status cli_input_unread(cli_run *run, const char *path);
void cli_input_sum(cli_run *run, const char *path, const char *digest);

/**
 * Check that a file can be made at @p path, before the work that it is to hold:
 * one is made in its folder and removed. cli_input checks outputs that options
 * name by itself.
 */
ritz_status cli_can_write(const char *path);

/** Command and inputs so far, as containers take them; borrowed from run. */
const ritz_stamp *cli_stamp(cli_run *run);

/** A line on standard error, and in the report, once; not fatal. */
[[gnu::format(printf, 2, 3)]] void cli_warn(cli_run *run, const char *format,
                                            ...);

/** Values that JSON cannot hold become null, or '?' in a text. */
json_t *cli_real(double value);
json_t *cli_string(const char *text);

/** A value as JSON, with what a terminal could obey as \u009b. The caller frees
 * it; NULL: no memory. */
char *cli_json(const json_t *value, size_t flags);

/** Write to standard error: all that tools say there goes this way, with '?'
 * for what a terminal could obey, except the ends of lines. */
[[gnu::format(printf, 1, 2)]] void cli_complain(const char *format, ...);
[[gnu::format(printf, 1, 0)]] void cli_complain_list(const char *format,
                                                     va_list args);

/** Method and order (-1: none) of the line that --record appends. */
void cli_record(cli_run *run, const char *method, int64_t order);
void cli_record_error(cli_run *run, const char *name, double value);
/** Why an error that is recorded, a bound, is so large; "": it is not. */
void cli_record_cause(cli_run *run, const char *name, const char *cause);

/**
 * Append one further line to the file of --record, now: tool, command and
 * inputs are added to it. Without --record nothing happens.
 *
 * @param[in] line  given away
 */
ritz_status cli_record_line(cli_run *run, json_t *line);

/**
 * From now on signals that end the program remove unfinished files first, HDF5
 * files are read by another process before HDF5 opens them (cli/walk.h), and
 * steps of the library are shown as one line if standard error is a terminal.
 * Steps that will take more than ten minutes are a warning, as soon as the
 * first ones tell.
 */
void cli_watch(cli_run *run);

/** From now on the program ends with status 1 where JSON has no memory. */
void cli_prepare(void);

/** The program is about to end by itself; that of cli_watch which ends before is
 * ended by a library, and fails. */
void cli_unwatch(void);

/** "12.5 s", "3 min", "5.2 h" or "4 days"; returns @p out. */
const char *cli_duration(double seconds, char out[CLI_DURATION]);

/** Seconds, of the monotonic clock. */
double cli_clock(void);

/** Remove that line, before something else is written. */
void cli_watch_clear(void);

/**
 * The outputs are as documented though the status will tell of a limit that is
 * not met: cli_finish gives them their names all the same.
 */
void cli_keep_outputs(cli_run *run);

/**
 * Exit status for main: record, report, say why it failed, check standard
 * output; then all files that were written get their names or, after a failure
 * of any of that, none does.
 */
int cli_finish(cli_run *run, ritz_status status);

#endif
