/* The command line of ritz-basis, which is also that of
   libexec/ritz-basis-slepc.c. */
#include "print/print.h"

static void list_methods(void)
{
    for (const ritz_method *const *m = ritz_methods; *m; m++) {
        printf("%s%-18s %s [%s]\n", m > ritz_methods ? "\n" : "", (*m)->name,
               (*m)->summary, (*m)->reference);
        cli_list_advice((*m)->when, (*m)->cost, (*m)->holds, (*m)->fails);
        printf("  takes  %s\n", (*m)->uses & RITZ_USES_SPACE
                                    ? "components and state spaces"
                                    : "components");
    }
    printf("\nAll take a component, a reduced component, whose coordinates are "
           "then its dofs and\nwhose ports cannot be attached, and a system at "
           "a configuration (--at).\nA state space is taken by");
    for (const ritz_method *const *m = ritz_methods; *m; m++)
        if ((*m)->uses & RITZ_USES_SPACE)
            printf(" %s", (*m)->name);
    printf(".\n");
}

int basis_main(int argc, char **argv,
               ritz_status (*make)(cli_run *run, basis_options *given))
{
    enum { NUM_OWN = 8 };
    choice_words choice = {0};
    basis_options given = {.request = RITZ_REQUEST_NONE};
    ritz_request *request = &given.request;
    cli_option options[NUM_OWN + WORDS_MOST + 1] = {
        CLI_INT("modes", &request->modes, "N", 0, 100000,
                "number of flexible vectors (of a state space: states), "
                "or"),
        CLI_REAL("up-to-hz", &request->up_to_hz, "F", 1e-9, 1e9,
                 "all modes up to this frequency"),
        CLI_TEXT("attach", &given.ports, "PORT[,PORT]",
                 "keep the dofs of these ports; '' for none [all]"),
        CLI_REAL("tolerance", &request->tolerance, "X", 1e-15, 1e-2,
                 "drop columns that depend on others within X, relative"),
        CLI_LIST("neighbour", &given.neighbours, "PORT=FILE:PORT",
                 "load a port with another component, joined at its PORT"),
        AT_OPTION(&given.model.at),
        ORDER_OPTION(&given.model.order),
        CLI_ACTION("list", list_methods, "list methods and their papers"),
    };
    const cli_program program = {
        .name = "ritz-basis",
        .operands = {{"METHOD", "one of those that --list shows", false},
                     {"COMPONENT",
                      "the component to be reduced, or a state space, a "
                      "reduced component or a system",
                      false}},
        .summary =
            "Find the subspace in which a component is reduced. Rigid "
            "modes of a free component\nare kept in addition to the "
            "flexible vectors. A reduced component, and a system at a\n"
            "configuration, are reduced as components are, for example to "
            "a low-order model\nfor a controller.",
        .example = "ritz-basis craig-bampton --modes 12 blade.h5 -o basis.h5",
        .output = "the basis",
        .threads = true,
    };
    cli_run run;

    words_add(&choice, 0, options + NUM_OWN);
    cli_parse(&program, options, argc, argv, &run);
    given.method = cli_choose(&program, "method", run.operand[0], ritz_methods);
    if (given.ports && !(given.method->uses & RITZ_USES_ATTACHED))
        cli_refuse(&program,
                   "%s keeps no attached dofs, --attach is not for it",
                   given.method->name);
    if (given.neighbours.count > 0 &&
        !(given.method->uses & RITZ_USES_NEIGHBOUR))
        cli_refuse(&program, "%s loads nothing, --neighbour is not for it",
                   given.method->name);
    words_take(&program, &choice, &request->choice);
    if (ritz_request_check(given.method, request) != RITZ_OK)
        cli_refuse(&program, "%s", ritz_error_message());
    return cli_finish(&run, make(&run, &given));
}
