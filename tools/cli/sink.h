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
 *     %s           text      NULL: null
 *     %ld          integer   int64_t, which is long where Ritz builds
 *     %g %e %f     number    not finite: null; NaN is '-' in the text
 *     %d           boolean
 */
#ifndef RITZ_TOOLS_CLI_SINK_H
#define RITZ_TOOLS_CLI_SINK_H

#include "cli/cli.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

/** A line, and its values. */
[[gnu::format(printf, 3, 4)]] void sink_say(cli_run *run, const char *keys,
                                            const char *format, ...);

/** Text of a line whose end is still to be said. */
[[gnu::format(printf, 2, 3)]] void sink_part(const cli_run *run,
                                             const char *format, ...);

/** A line behind a title, in the column that all titles share. */
[[gnu::format(printf, 4, 5)]] void sink_field(cli_run *run, const char *title,
                                              const char *keys,
                                              const char *format, ...);

/** The values alone; blanks may stand between the conversions. */
[[gnu::format(printf, 3, 4)]] void sink_set(cli_run *run, const char *keys,
                                            const char *format, ...);

/** Plain items of the list that is open, one for each conversion. */
[[gnu::format(printf, 2, 3)]] void sink_add(cli_run *run, const char *format,
                                            ...);

/**
 * Open an object or a list, until the sink_end that belongs to it. One that
 * is there under this key already is opened again.
 *
 * @param[in] key  NULL: an item of the list that is open
 */
void sink_object(cli_run *run, const char *key);
void sink_list(cli_run *run, const char *key);
void sink_end(cli_run *run);

/**
 * Open the object of a line of its own for the file of --record. Its
 * sink_end_record adds tool, command, inputs and memory, and appends it now;
 * without --record it is dropped.
 */
void sink_record(cli_run *run);
ritz_status sink_end_record(cli_run *run);

/** Open the object of the line that --record appends when the run ends. */
void sink_line(cli_run *run);

/** The object or list that is open; borrowed. */
json_t *sink_here(const cli_run *run);

/** Give the object that is open those keys of another that it has not. */
void sink_lift(cli_run *run, const json_t *from);

/** Lists of plain values; numbers count from 1 where they are indices. */
void sink_reals(cli_run *run, const char *key, int64_t count,
                const double *values);
void sink_wholes(cli_run *run, const char *key, int64_t count,
                 const int64_t *values);
void sink_numbers(cli_run *run, const char *key, int64_t count,
                  const int64_t *indices);

/** Names as a list and, below each other behind @p title, as text; NULL: only
 * as a list. */
void sink_names(cli_run *run, const char *title, const char *key, int64_t count,
                char (*name)[RITZ_NAME_SIZE]);

/** Add to a text that is built piece by piece, as far as there is room. */
[[gnu::format(printf, 3, 4)]] void sink_append(char *text, size_t size,
                                               const char *format, ...);

#endif
