/* What ritz-compare says of several composite tolerances. */
#include "print/print.h"

void tolerances_orders(cli_run *run, int64_t count, const int64_t *order,
                       char out[80])
{
    out[0] = '\0';
    for (int64_t k = 0; k < count && strlen(out) < 72; k++)
        sink_append(out, 80, "%s%ld", k > 0 ? "+" : "", order[k]);
    sink_wholes(run, "orders", count, order, 0);
}

void tolerance_rows_free(tolerance_rows *rows)
{
    ritz_tolerances_free(rows->count, &rows->at);
}

void tolerances_say(cli_run *run, const ritz_stage *first,
                    const tolerance_rows *rows)
{
    cli_say(run, "\nComposite tolerance against orders, and worst errors at "
                 "listed configurations");
    cli_say(run, "%10s  %-16s %6s %6s %9s %9s %9s %9s", "tolerance", "orders",
            "total", "system", "frequency", "gain", "response", "damping");
    SINK_ITEMS(run, "tolerances", k, rows->count) {
        const ritz_tolerance_row *row = &rows->at[k];
        char orders[80];

        tolerances_orders(run, first->count, row->order, orders);
        sink_set(run, "removed", "%d", row->removed);
        sink_say(run, "tolerance,,,dofs,frequency,gain,response,damping",
                 "%10.0e  %-16s %6ld %6ld %9.1e %9.1e %9.1e %9.1e%s",
                 row->tolerance, orders, row->total, row->largest,
                 row->frequency_error, row->gain_error, row->response_error,
                 row->damping_error,
                 row->removed ? "" : "  stage two removed nothing");
    }
}

ritz_status tolerances_write(const char *path, const ritz_stage *first,
                             const tolerance_rows *rows)
{
    RITZ_OWN(cli_table) table = {0};

    RITZ_CHECK(cli_table_new(&table));
    fprintf(table.file, "tolerance\ttotal\tsystem\tremoved\tfrequency\tgain\t"
                        "response");
    for (int64_t b = 0; b < first->count; b++)
        fprintf(table.file, "\t%s", first->scene->component[b].name);
    fprintf(table.file, "\tdamping");
    for (int64_t k = 0; k < rows->count; k++) {
        const ritz_tolerance_row *row = &rows->at[k];

        fprintf(table.file, "\n%g\t%ld\t%ld\t%s\t%.6e\t%.6e\t%.6e",
                row->tolerance, row->total, row->largest,
                row->removed ? "yes" : "no", row->frequency_error,
                row->gain_error, row->response_error);
        for (int64_t b = 0; b < first->count; b++)
            fprintf(table.file, "\t%ld", row->order[b]);
        fprintf(table.file, "\t%.6e", row->damping_error);
    }
    fprintf(table.file, "\n");
    return cli_table_save(&table, path);
}
