/* ritz-rank - which modes of a model matter from its inputs to its outputs. */
#include "chart/chart.h"
#include "print/print.h"

static void list_rankers(void)
{
    for (const ritz_ranker *const *r = ritz_rankers; *r; r++)
        printf("%-25s %-58s [%s]\n", (*r)->name, (*r)->summary,
               (*r)->reference);
}

int main(int argc, char **argv)
{
    rank_options given = {.by = "hankel", .top = 10, .draw = chart_rankings};
    const cli_option options[] = {
        CLI_TEXT("by", &given.by, "NAME[,NAME]",
                 "rankings to make, of those that --list shows"),
        CLI_TEXT("at", &given.at, "JOINT=SETTING[,JOINT=SETTING]",
                 "one configuration of a system, in degrees and lengths "
                 "[all]"),
        ORDER_OPTION(&given.order),
        CLI_LIST("damping", &given.damping, "TEXT",
                 "\"modal ZETA\" or another form that ritz-frf --help "
                 "shows [the model's]"),
        CLI_PAIR("band-hz", given.band_hz, "F,F",
                 "band of the ranking hankel-band [the system's]"),
        CLI_TEXT("input-weights", &given.input_weights, "NAME=W,...",
                 "intensities of inputs: squares of their amplitudes [1]"),
        CLI_TEXT("output-weights", &given.output_weights, "NAME=W,...",
                 "weights of squared outputs [1 / limit^2, or 1]"),
        CLI_INT("reweigh", &given.keep, "N", 1, 1e6,
                "find the output weights that suit a choice of N modes"),
        CLI_TEXT("engine", &given.engine, "WORD",
                 "Gramians of a component by auto, dense, modal, low-rank or "
                 "projection"),
        CLI_TEXT("among-hz", &given.among, "F",
                 "modes up to this frequency, for modal Gramians of a "
                 "component"),
        CLI_TEXT("tracks", &given.tracks, "FILE",
                 "table of ritz-assemble --tracks, which matches modes of "
                 "all configurations"),
        CLI_FLAG("compare", &given.compare,
                 "compare rankings that files hold, each with the first"),
        CLI_INT("top", &given.top, "N", 1, 1e6,
                "compare, draw and, of several rankings, print so many modes"),
        CLI_OUTPUT("table", &given.table, "FILE",
                   "write all values as a table with tabs"),
        CLI_OUTPUT("chart", &given.chart, "FILE.svg",
                   "draw the values as bars, by gnuplot"),
        CLI_ACTION("list", list_rankers, "list rankings and their papers"),
        {0},
    };
    const cli_program program = {
        .name = "ritz-rank",
        .operands = {{"FILE",
                      "a reduced component or a system; of a component or a "
                      "state space, exact Hankel values alone",
                      true}},
        .summary = "Rank the flexible modes of a model by what they carry "
                   "from its inputs to its\noutputs, best first, with "
                   "the exact Hankel values of the whole model.",
        .example = "ritz-rank system.h5 --at clock=60,cone=0 --by "
                   "gregory,modal-cost --damping \"modal 0.002\"",
        .output = "the rankings, as a container",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, options, argc, argv, &run);
    return cli_finish(&run, rank_run(&run, &given));
}
