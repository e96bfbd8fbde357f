/* ritz-basis - find the subspace in which a component is reduced. */
#include "cli/words.h"
#include "print/describe.h"
#include "print/neighbours.h"

#include <ritz/method.h>

#include <math.h>
#include <string.h>

enum { MAX_METHODS = 64 };

static void list_methods(void)
{
    for (const ritz_method *const *m = ritz_methods; *m; m++) {
        const struct {
            const char *word, *text;
        } lines[] = {{"when", (*m)->when},
                     {"cost", (*m)->cost},
                     {"holds", (*m)->holds},
                     {"fails", (*m)->fails}};

        printf("%s%-18s %s [%s]\n", m > ritz_methods ? "\n" : "", (*m)->name,
               (*m)->summary, (*m)->reference);
        for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
            if (lines[k].text)
                printf("  %-6s %s\n", lines[k].word, lines[k].text);
    }
}

static const ritz_method *find(const cli_program *program, const char *word)
{
    const ritz_method *method = ritz_method_find(word);
    const char *names[MAX_METHODS];
    int64_t count = 0;

    if (method)
        return method;
    while (ritz_methods[count] && count < MAX_METHODS) {
        names[count] = ritz_methods[count]->name;
        count++;
    }
    cli_refuse_name(program, "no method", word, count, names);
}

/* Frequencies and residuals stand side by side: one of each for each mode. */
static void report(cli_run *run, const ritz_basis *basis)
{
    const ritz_columns *c = &basis->columns;
    json_t *residuals = json_array();
    double worst = (double)NAN;

    cli_say(run, "%s:", run->output);
    describe_basis(run, basis);
    for (int64_t k = 0; k < c->count; k++) {
        if (isnan(c->hertz[k]))
            continue;
        json_array_append_new(residuals, cli_real(c->residual[k]));
        if (!(c->residual[k] <= worst) && !isnan(c->residual[k]))
            worst = c->residual[k];
    }
    json_object_set_new(run->report, "residuals", residuals);
    if (!isnan(worst)) {
        cli_say(run, "  %-14s %.1e relative, of the worst mode", "residual",
                worst);
        cli_record_error(run, "residual", worst);
    }
    if (basis->remark[0]) {
        cli_say(run, "  %-14s %s", "note", basis->remark);
        cli_report_text(run, "note", basis->remark);
    }
    cli_report_int(run, "vectors", c->count);
    cli_record(run, basis->origin.method, c->count);
}

static ritz_status make(cli_run *run, const ritz_method *method,
                        const char *ports, const cli_list *neighbours,
                        ritz_request *request)
{
    ritz_status status = RITZ_OK;
    model m = {0};
    ritz_neighbour neighbour = {0};
    ritz_basis basis = {0};
    ritz_stamp stamp = {0};

    cli_record(run, method->name, -1);
    RITZ_TRY(model_read(run, run->operand[1],
                        MODEL_COMPONENT |
                            (method->uses & RITZ_USES_SPACE ? MODEL_STATES : 0),
                        &m));
    if (m.kind == MODEL_STATES)
        request->space = &m.states;
    else
        request->component = &m.component;
    if (request->component && method->uses & RITZ_USES_ATTACHED)
        RITZ_TRY_IN(
            run->operand[1],
            ritz_component_attached(&m.component, ports, &request->attached));
    if (neighbours->count > 0) {
        RITZ_TRY(neighbours_read(run, neighbours, &m.component,
                                 &request->attached, &neighbour));
        request->neighbour = &neighbour;
    }
    RITZ_TRY_IN(run->operand[1], ritz_basis_make(method, request, &basis));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_basis(
        run->output, &basis,
        request->space ? m.states.units : m.component.units, &stamp));
    report(run, &basis);
done:
    ritz_dofs_free(&request->attached);
    ritz_neighbour_free(&neighbour);
    ritz_basis_free(&basis);
    model_free(&m);
    return status;
}

int main(int argc, char **argv)
{
    enum { NUM_OWN = 6 };
    const char *ports = NULL;
    words choice = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    cli_list neighbours = {0};
    cli_option options[NUM_OWN + WORDS_MOST + 1] = {
        {CLI_INT(&request.modes), .name = "modes", .argument = "N", .min = 0,
         .max = 100000,
         .help = "how many flexible vectors (of states: states), or"},
        {CLI_REAL(&request.up_to_hz), .name = "up-to-hz", .argument = "F",
         .min = 1e-9, .max = 1e9, .help = "every mode up to this frequency"},
        {CLI_TEXT(&ports), .name = "attach", .argument = "PORT[,PORT]",
         .help = "keep the dofs of these ports; '' for none [all]"},
        {CLI_REAL(&request.tolerance), .name = "tolerance", .argument = "X",
         .min = 1e-15, .max = 1e-2,
         .help = "relative, below which a column depends on others"},
        {CLI_LIST(&neighbours), .name = "neighbour",
         .argument = "PORT=FILE:PORT", .help = "hang this component on a port"},
        {CLI_ACTION(list_methods), .name = "list",
         .help = "list methods and their papers"},
    };
    const cli_program program = {
        .name = "ritz-basis",
        .operands = {{"METHOD", "one of those that --list shows", false},
                     {"COMPONENT",
                      "the component, or state space, to be reduced", false}},
        .summary = "Find the subspace in which a component is reduced. Rigid "
                   "modes of a free component\nare kept beside the flexible "
                   "ones asked for.",
        .example = "ritz-basis craig-bampton --modes 12 blade.h5 -o basis.h5",
        .options = options,
        .output = "the basis",
        .threads = true,
    };
    const ritz_method *method = NULL;
    cli_run run;

    words_add(&choice, 0, options + NUM_OWN);
    cli_parse(&program, argc, argv, &run);
    method = find(&program, run.operand[0]);
    if (ports && !(method->uses & RITZ_USES_ATTACHED))
        cli_refuse(&program,
                   "%s keeps no attached dofs, --attach is not for "
                   "it",
                   method->name);
    if (neighbours.count > 0 && !(method->uses & RITZ_USES_NEIGHBOUR))
        cli_refuse(&program, "%s loads nothing, --neighbour is not for it",
                   method->name);
    words_take(&program, &choice, &request.choice);
    if (ritz_request_check(method, &request) != RITZ_OK)
        cli_refuse(&program, "%s", ritz_error_message());
    return cli_finish(&run, make(&run, method, ports, &neighbours, &request));
}
