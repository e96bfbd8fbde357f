/* The report of ritz-compare. */
#ifndef RITZ_TOOLS_PRINT_COMPARISON_H
#define RITZ_TOOLS_PRINT_COMPARISON_H

#include "cli/model.h"

#include <ritz/compare.h>

/** Orders, errors at every configuration, frequencies; the same as JSON. */
ritz_status comparison_say(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *comparison);

/** The composite tolerance against orders and errors; the same as JSON. */
void comparison_say_tolerances(cli_run *run, const ritz_stage *first,
                               int64_t count, const ritz_tolerance_row *rows);

/** The same as a table with tabs. */
ritz_status comparison_write_tolerances(const char *path,
                                        const ritz_stage *first, int64_t count,
                                        const ritz_tolerance_row *rows);

/* Parts of the report, each of which may have nothing to say. */
void comparison_say_candidates(cli_run *run, const ritz_stage *first,
                               const ritz_comparison *comparison);
void comparison_say_suggestion(cli_run *run, const ritz_stage *first,
                               const ritz_comparison *comparison);
void comparison_say_strays(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *comparison);
ritz_status comparison_say_frequencies(cli_run *run,
                                       const ritz_comparison *comparison);

/** "clock=60,cone=0" of a row. */
void comparison_name_row(const ritz_stage *stage,
                         const ritz_comparison *comparison,
                         const ritz_compare_row *row, char out[RITZ_NAME_SIZE]);

#endif
