/*
 * Reports of tools: each call gives a line of text for people and the values in
 * it for --json. Values become keys of the object that is open,
 * which at first is the report of the run itself; while a list is open, the
 * values of one call are its next item.
 *
 * Keys name the conversions of a format in their order, divided by commas. A
 * conversion without a key, as the second of "name,,step", is of the text
 * alone.
 *
 *     %s           text      NULL: null; a control character is '?' in the
 *                            text, and escaped as \u001b in JSON
 *     %ld          integer   int64_t, which is long where Ritz builds
 *     %g %e %f     number    not finite: null; NaN is '-' in the text
 *     %d           boolean
 */
#ifndef RITZ_TOOLS_CLI_SINK_H
#define RITZ_TOOLS_CLI_SINK_H

#include "cli/cli.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

/* What becomes of the text of a call. */
typedef enum sink_text { SINK_NONE, SINK_PART, SINK_LINE } sink_text;

/**
 * All that a tool says, by one of the names below.
 *
 * @param[in] title  of a line, in the column that all titles share; NULL: none
 * @param[in] keys   NULL: values are plain items of the list that is open
 */
[[gnu::format(printf, 5, 6)]] void sink_tell(const cli_run *run, sink_text text,
                                             const char *title,
                                             const char *keys,
                                             const char *format, ...);

/* A line, and its values. */
#define sink_say(run, keys, ...)                                               \
    sink_tell(run, SINK_LINE, NULL, keys, __VA_ARGS__)
/* A line of text alone; like all text, not shown with --quiet or --json. */
#define cli_say(run, ...) sink_say(run, "", __VA_ARGS__)
/* A line behind a title. */
#define sink_field(run, title, keys, ...)                                      \
    sink_tell(run, SINK_LINE, title, keys, __VA_ARGS__)
/* Text of a line whose end is still to be said. */
#define sink_part(run, ...) sink_tell(run, SINK_PART, NULL, "", __VA_ARGS__)
/* The values alone; blanks may stand between the conversions. */
#define sink_set(run, keys, ...)                                               \
    sink_tell(run, SINK_NONE, NULL, keys, __VA_ARGS__)
/* Plain items of the list that is open, one for each conversion. */
#define sink_add(run, ...) sink_set(run, NULL, __VA_ARGS__)

/**
 * Open an object or a list, until the sink_end that belongs to it. One that
 * is there under this key already is opened again.
 *
 * @param[in] key  NULL: an item of the list that is open
 */
void sink_object(cli_run *run, const char *key);
void sink_list(cli_run *run, const char *key);
void sink_end(cli_run *run);

/* A list, and a statement for each k below a count, after which the list is
   ended; a statement that returns leaves it open, which only a failure may. */
#define SINK_EACH(run, key, k, count)                                          \
    for (int64_t k = (sink_list(run, key), 0);                                 \
         (k) < (count) || (sink_end(run), false); (k)++)

/* The same with an object for each k, which is an item of the list. */
#define SINK_ITEMS(run, key, k, count)                                         \
    for (int64_t k = (sink_list(run, key), 0);                                 \
         (k) < (count) ? (sink_object(run, NULL), true)                        \
                       : (sink_end(run), false);                               \
         sink_end(run), (k)++)

/** Open an object that is no part of the report; borrowed. */
void sink_open(cli_run *run, json_t *value);

/** The object or list that is open; borrowed. */
json_t *sink_here(const cli_run *run);

/** Give the object that is open those keys of another that it has not. */
void sink_lift(cli_run *run, const json_t *from);

/** Lists of plain values; of whole ones @p first is added to each, 1 where they
 * are indices. */
void sink_reals(cli_run *run, const char *key, int64_t count,
                const double *values);
void sink_wholes(cli_run *run, const char *key, int64_t count,
                 const int64_t *values, int64_t first);

/** Names as a list and, below each other behind @p title, as text; NULL: only
 * as a list. */
void sink_names(cli_run *run, const char *title, const char *key, int64_t count,
                char (*name)[RITZ_NAME_SIZE]);

/** Add to a text that is built piece by piece, as far as there is room. */
[[gnu::format(printf, 3, 4)]] void sink_append(char *text, size_t size,
                                               const char *format, ...);

#endif
