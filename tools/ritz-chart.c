/* ritz-chart - pictures of what other tools found, and one page of them all. */
#include "chart/chart.h"
#include "chart/report.h"

#include <string.h>

enum { MAX_KINDS = 32 };

static void list_kinds(void)
{
    for (const chart_kind *k = chart_kinds; k->name; k++)
        printf("%-12s %-56s from %s\n", k->name, k->summary, k->files);
    printf("%-12s %-56s from any of these\n", "report",
           "all of these on one page, with tables and a verdict");
}

/* NULL: the report. Another word ends the program. */
static const chart_kind *find_chart(const cli_program *program,
                                    const char *word)
{
    const char *names[MAX_KINDS] = {"report"};
    int64_t count = 1;

    if (strcmp(word, *names) == 0)
        return NULL;
    for (const chart_kind *k = chart_kinds; k->name; k++) {
        if (strcmp(k->name, word) == 0)
            return k;
        names[count++] = k->name;
    }
    cli_refuse_name(program, "no chart", word, count, names);
}

static ritz_status draw_chart(cli_run *run, const chart_kind *kind,
                              const chart_request *request)
{
    RITZ_OWN(chart_sources) sources = {0};
    RITZ_OWN(picture) drawn = {0};

    RITZ_CHECK(chart_read(run, run->num_operands - 1, run->operand + 1,
                          kind ? kind->holds : CHART_REPORT, &sources));
    if (kind)
        RITZ_CHECK(picture_new(request->path, true, &drawn));
    RITZ_CHECK(chart_name_files(kind ? kind->draw(&sources, request, &drawn)
                                     : report_write(&sources, request),
                                &sources, CHART_REPORT | MODEL_ANY));
    cli_say(run, "%s", run->output);
    return RITZ_OK;
}

int main(int argc, char **argv)
{
    chart_request request = {.top = 10, .up_to_hz = 1e12};
    const cli_option options[] = {
        CLI_LIST("measure", &request.measure, "NAME",
                 "of records: errors to draw [all relative ones]"),
        CLI_TEXT("subject", &request.subject, "NAME",
                 "of records: draw those of one component or scene"),
        CLI_WORD("against", &request.against, "reduce|simulate",
                 "pareto: time to reduce or to simulate [simulate, if all "
                 "records know it]"),
        CLI_LIST("channel", &request.channel, "OUTPUT/INPUT",
                 "response: channels to draw, or 'singular-values' of "
                 "files that hold them [the first four]"),
        CLI_WORD("error", &request.error, "relative|decibels|both",
                 "response: relative to the largest |H|, in decibels at "
                 "each point, or both [relative]"),
        CLI_LIST(
            "at", &request.at, "JOINT=SETTING[,...]",
            "mac, report: configuration of each system, or two of one [the "
            "only ones]; modes are compared by the masses of all "
            "bodies if their reduced components are named too, else "
            "by inputs and outputs"),
        CLI_INT("top", &request.top, "N", 1, 1000,
                "hankel: number of modes of each ranking"),
        CLI_REAL("up-to-hz", &request.up_to_hz, "F", 0.0, 1e12,
                 "tracks: highest frequency"),
        CLI_ACTION("list", list_kinds,
                   "list charts and what they are made from"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-chart",
        .operands = {{"KIND",
                      "a chart, of those that --list shows, or 'report'",
                      false},
                     {"FILE", "what it is made from", true}},
        .summary = "Draw charts as SVG, by gnuplot; data and script stay "
                   "beside each. A report is one\nHTML page of all that the "
                   "files allow, with tables and a verdict, that needs no\n"
                   "network.",
        .example = "ritz-chart report runs.jsonl ranking.h5 full.h5 "
                   "reduced.h5 -o report.html",
        .output = "the picture, NAME.svg, or the page, NAME.html",
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    request.path = run.output;
    return cli_finish(
        &run, draw_chart(&run, find_chart(&program, *run.operand), &request));
}
