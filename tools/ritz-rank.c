/* ritz-rank - which modes of a model matter from its inputs to its outputs. */
#include "dampers.h"
#include "describe.h"

#include <math.h>

enum { MAX_RANKERS = 64 };

/* Above this share of one mode in another's Gramian, Gregory's assumption of
 * modes that do not couple costs several percent. */
static const double coupled_limit = 0.1;

static void list_rankers(void)
{
    for (const ritz_ranker *const *r = ritz_rankers; *r; r++)
        printf("%-12s %-60s [%s]\n", (*r)->name, (*r)->summary,
               (*r)->reference);
}

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

static void report(cli_run *run, const ritz_ranking *r,
                   const ritz_damping *damping)
{
    char text[RITZ_DAMPING_SIZE];
    json_t *order = json_array();

    ritz_damping_print(damping, text);
    cli_say(run, "%lld flexible modes of '%s' by %s [%s], damping %s",
            (long long)r->count, run->operand[0], r->by, r->reference,
            *text ? text : "of the matrices");
    describe_order(run, r);
    for (int64_t k = 0; k < r->count; k++)
        json_array_append_new(order, json_integer(r->order[k] + 1));
    if (!isnan(r->coupling)) {
        cli_say(run,
                "coupling: modes %lld and %lld share %.3g of the exact "
                "Gramian",
                (long long)r->coupled[0] + 1, (long long)r->coupled[1] + 1,
                r->coupling);
        json_object_set_new(run->report, "coupling", cli_real(r->coupling));
        if (r->coupling > coupled_limit)
            cli_warn(run,
                     "modes %lld and %lld couple by %.3g: values of "
                     "single modes are rough there, trust the exact ones",
                     (long long)r->coupled[0] + 1, (long long)r->coupled[1] + 1,
                     r->coupling);
    }
    cli_report_text(run, "by", r->by);
    cli_report_text(run, "damping", text);
    json_object_set_new(run->report, "order", order);
    cli_report_reals(run, "frequencies_hz", r->count, r->hertz);
    cli_report_reals(run, "values", r->count, r->value);
    cli_report_reals(run, "system_values", r->num_system, r->system_value);
    cli_record(run, r->by, r->count);
}

static ritz_status rank(cli_run *run, const ritz_ranker *ranker, const char *at,
                        const char *asked)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    model m = {0};
    ritz_second_order view = {0};
    ritz_damping damping = {0};
    ritz_modal modal = {0};
    ritz_ranking ranking = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(model_read(run, path, MODEL_REDUCED | MODEL_SYSTEM, &m));
    RITZ_TRY(model_at(&m, path, at));
    RITZ_TRY(model_damping(&m, asked, &damping));
    RITZ_TRY_IN(path, dampers_install(&m, NULL));
    view = model_look(&m).matrices;
    if (view.K4->val)
        cli_warn(run,
                 "the structural damping of '%s' is left out of its ranking",
                 path);
    RITZ_FAIL_IF(view.io->num_inputs == 0 || view.io->num_outputs == 0,
                 RITZ_ERR_ARGUMENT, "'%s' has no %s: nothing to rank by", path,
                 view.io->num_inputs == 0 ? "inputs" : "outputs");
    RITZ_TRY_IN(path, ritz_modal_new(view.K, view.M, view.D, view.io, &damping,
                                     &modal));
    RITZ_TRY_IN(path, ritz_rank(ranker, &modal, &ranking));
    stamp = cli_stamp(run);
    if (run->output)
        RITZ_TRY(ritz_container_write_ranking(run->output, &ranking, &stamp));
    report(run, &ranking, &damping);
done:
    ritz_ranking_free(&ranking);
    ritz_modal_free(&modal);
    model_free(&m);
    return status;
}

int main(int argc, char **argv)
{
    const char *by = "hankel";
    const char *at = NULL;
    const char *damping = NULL;
    const cli_option options[] = {
        {CLI_TEXT(&by), .name = "by", .argument = "NAME",
         .help = "ranking, one of those that --list shows"},
        {CLI_TEXT(&at), .name = "at",
         .argument = "JOINT=SETTING[,JOINT=SETTING]",
         .help = "which configuration of a system, degrees and lengths"},
        DAMPING_OPTION(&damping),
        {CLI_ACTION(list_rankers), .name = "list",
         .help = "list rankings and their papers"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-rank",
        .operands = {{"FILE", "a reduced component or a system", false}},
        .summary = "Rank the flexible modes of a model by what they carry "
                   "from its inputs to its\noutputs, best first; the exact "
                   "Hankel values of the whole stand beside.",
        .example = "ritz-rank system.h5 --at clock=60,cone=0 --by gregory "
                   "--damping \"modal 0.002\"",
        .options = options,
        .output = "the ranking, as a container",
        .output_optional = true,
        .threads = true,
    };
    const ritz_ranker *ranker = NULL;
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    ranker = find(&program, by);
    return cli_finish(&run, rank(&run, ranker, at, damping));
}
