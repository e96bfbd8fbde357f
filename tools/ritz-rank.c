/* ritz-rank - which modes of a model matter from its inputs to its outputs. */
#include "chart/chart.h"
#include "print/dampers.h"
#include "print/nested.h"
#include "print/rankings.h"
#include "print/rankings_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_RANKERS = 64 };

static void list_rankers(void)
{
    for (const ritz_ranker *const *r = ritz_rankers; *r; r++)
        printf("%-25s %-58s [%s]\n", (*r)->name, (*r)->summary,
               (*r)->reference);
}

/* The ranking of that name, or the end of the program. */
static const ritz_ranker *find(const cli_program *program, const char *word)
{
    const ritz_ranker *ranker = ritz_ranker_find(word);
    const char *names[MAX_RANKERS];
    int64_t count = 0;

    if (ranker)
        return ranker;
    while (ritz_rankers[count] && count < MAX_RANKERS) {
        names[count] = ritz_rankers[count]->name;
        count++;
    }
    cli_refuse_name(program, "no ranking", word, count, names);
}

/* "gregory,hankel". */
static void find_all(const cli_program *program, const char *by,
                     rank_wish *asked)
{
    char word[RITZ_NAME_SIZE];

    for (const char *c = by;; c++) {
        size_t length = strcspn(c, ",");

        if (asked->num_rankers == RANK_MOST)
            cli_refuse(program, "--by takes up to %d rankings", RANK_MOST);
        snprintf(word, sizeof word, "%.*s", (int)(length < 60 ? length : 60),
                 c);
        asked->ranker[asked->num_rankers++] = find(program, word);
        c += length;
        if (!*c)
            return;
    }
}

/* Words of Gramians that are a choice of components. */
static void take_choice(const cli_program *program, const char *key,
                        const char *text, ritz_choice *choice)
{
    for (const ritz_choice_word *w = ritz_choice_words; text && w->key; w++)
        if (strcmp(w->key, key) == 0 &&
            ritz_choice_take(w, text, choice) != RITZ_OK)
            cli_refuse(program, "%s", ritz_error_message());
}

static ritz_status report(cli_run *run, const rank_wish *asked,
                          const rank_result *result)
{
    ritz_status status = RITZ_OK;
    contest all = {0};
    char title[256];
    const ritz_ranking *first = ranked_whole(result->group);

    if (run->output) {
        ritz_stamp stamp = cli_stamp(run);

        RITZ_TRY(rank_write(run->output, result, &stamp));
    }
    RITZ_TRY(rank_contest(result, true, &all));
    if (asked->table)
        RITZ_TRY(rankings_write_table(asked->table, &all));
    rank_contest_free(&all);
    RITZ_TRY(rank_contest(result, false, &all));
    if (all.count > 1)
        RITZ_TRY(rankings_compare(run, &all, asked->top));
    snprintf(title, sizeof title, "%.100s, damping %.100s", run->operand[0],
             rankings_damping(first));
    if (asked->chart)
        RITZ_TRY(chart_rankings(asked->chart, title, &all, asked->top));
    cli_record(run, first->by,
               first->count > 0 ? first->count : first->num_system);
done:
    rank_contest_free(&all);
    return status;
}

static ritz_status rank(cli_run *run, const rank_wish *asked)
{
    ritz_status status = RITZ_OK;
    rank_result result = {0};

    if (asked->compare)
        RITZ_TRY(rank_read(run, &result));
    else
        RITZ_TRY(rank_model(run, asked, &result));
    RITZ_TRY(report(run, asked, &result));
done:
    rank_result_free(&result);
    return status;
}

static void check(const cli_program *program, const cli_run *run,
                  const rank_wish *asked)
{
    if (asked->compare && (asked->at || asked->damping.count > 0 ||
                           asked->tracks || asked->keep > 0))
        cli_refuse(program, "--compare takes rankings as they are");
    if (!asked->compare && run->num_operands > 1)
        cli_refuse(program, "one model is ranked; rankings of several go to "
                            "--compare");
    if (asked->at && asked->tracks)
        cli_refuse(program, "--tracks follows modes over configurations, --at "
                            "leaves one");
}

/* Options that are more than a place to put them. */
typedef struct rank_words {
    const char *by, *band, *engine, *among;
} rank_words;

enum { MOST_OPTIONS = 20 };

static void set_options(rank_wish *asked, rank_words *words,
                        cli_option out[MOST_OPTIONS])
{
    const cli_option options[MOST_OPTIONS] = {
        {CLI_TEXT(&words->by), .name = "by", .argument = "NAME[,NAME]",
         .help = "rankings, of those that --list shows"},
        {CLI_TEXT(&asked->at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "one configuration of a system, degrees and lengths [all]"},
        ORDER_OPTION(&asked->order),
        {CLI_LIST(&asked->damping), .name = "damping", .argument = "TEXT",
         .help = "\"modal ZETA\" or another that --help of ritz-frf shows "
                 "[the model's]"},
        {CLI_TEXT(&words->band), .name = "band-hz", .argument = "F,F",
         .help = "of hankel-band [the system's]"},
        {CLI_TEXT(&asked->input_weights), .name = "input-weights",
         .argument = "NAME=W,...",
         .help = "intensities of inputs, squares of their size [1]"},
        {CLI_TEXT(&asked->output_weights), .name = "output-weights",
         .argument = "NAME=W,...",
         .help = "what squares of outputs count [1 / limit^2, or 1]"},
        {CLI_INT(&asked->keep), .name = "reweigh", .argument = "N", .min = 1,
         .max = 1e6,
         .help = "find output weights that suit a choice of N modes"},
        {CLI_TEXT(&words->engine), .name = "engine", .argument = "WORD",
         .help = "Gramians of a component: auto, dense, modal, low-rank"},
        {CLI_TEXT(&words->among), .name = "among-hz", .argument = "F",
         .help = "modal Gramians of a component: modes up to here"},
        {CLI_TEXT(&asked->tracks), .name = "tracks", .argument = "FILE",
         .help = "table of ritz-assemble --tracks: which mode is which at "
                 "other configurations"},
        {CLI_FLAG(&asked->compare), .name = "compare",
         .help = "files are rankings, each is held against the first"},
        {CLI_INT(&asked->top), .name = "top", .argument = "N", .min = 1,
         .max = 1e6,
         .help = "so many of each are compared, drawn and, of several, "
                 "printed"},
        {CLI_TEXT(&asked->table), .name = "table", .argument = "FILE",
         .help = "write all values as a table with tabs"},
        {CLI_TEXT(&asked->chart), .name = "chart", .argument = "FILE.svg",
         .help = "draw bars of the values, by gnuplot"},
        {CLI_ACTION(list_rankers), .name = "list",
         .help = "list rankings and their papers"},
        {0},
    };

    memcpy(out, options, sizeof options);
}

int main(int argc, char **argv)
{
    rank_words words = {.by = "hankel"};
    rank_wish asked = {.top = 10};
    cli_option options[MOST_OPTIONS];
    const cli_program program = {
        .name = "ritz-rank",
        .operands = {{"FILE",
                      "a reduced component or a system; of a component or a "
                      "state space, exact Hankel values alone",
                      true}},
        .summary = "Rank the flexible modes of a model by what they carry "
                   "from its inputs to its\noutputs, best first; the exact "
                   "Hankel values of the whole stand beside.",
        .example = "ritz-rank system.h5 --at clock=60,cone=0 --by "
                   "gregory,modal-cost --damping \"modal 0.002\"",
        .options = options,
        .output = "the rankings, as a container",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    set_options(&asked, &words, options);
    cli_parse(&program, argc, argv, &run);
    check(&program, &run, &asked);
    find_all(&program, words.by, &asked);
    if (words.band)
        cli_pair(&program, "band-hz", words.band, asked.band_hz);
    take_choice(&program, "engine", words.engine, &asked.choice);
    take_choice(&program, "among_hz", words.among, &asked.choice);
    return cli_finish(&run, rank(&run, &asked));
}
