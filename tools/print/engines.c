#include "print/engines.h"

#include <math.h>
#include <string.h>

enum { MOST = 16 };

/* Of the tolerance between points, what an engine may take of it. */
static const double share = 0.1;

void engines_list(void)
{
    printf("%-12s %s\n", "auto",
           "the one that the model asks for, and says why");
    for (const ritz_response_engine *const *e = ritz_response_engines; *e;
         e++) {
        const struct {
            const char *word, *text;
        } lines[] = {{"when", (*e)->when},
                     {"cost", (*e)->cost},
                     {"holds", (*e)->holds},
                     {"fails", (*e)->fails}};

        printf("\n%-12s %s", (*e)->name, (*e)->summary);
        printf((*e)->reference ? " [%s]\n" : "\n", (*e)->reference);
        for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
            printf("  %-6s %s\n", lines[k].word, lines[k].text);
    }
}

void engines_check(const cli_program *program, const engines_wish *asked)
{
    const char *names[MOST + 1] = {"auto"};
    int64_t count = 1;

    for (int k = 0; ritz_response_engines[k] && count <= MOST; k++)
        names[count++] = ritz_response_engines[k]->name;
    for (int64_t k = 0; k < count; k++)
        if (strcmp(asked->method, names[k]) == 0)
            return;
    cli_refuse_name(program, "no method", asked->method, count, names);
}

static int kind_of(const model *m)
{
    switch (m->kind) {
    case MODEL_COMPONENT:
        return RITZ_RESPONDS_COMPONENT;
    case MODEL_STATES:
        return RITZ_RESPONDS_STATES;
    default:
        return RITZ_RESPONDS_MATRICES;
    }
}

/* The engine that is asked for, if it is for such a model. */
static ritz_status choose(cli_run *run, const model *m, const char *method,
                          const ritz_response_request *request,
                          const ritz_response_engine **out)
{
    const char *why = NULL;
    int kind = kind_of(m);

    *out = strcmp(method, "auto") == 0
               ? ritz_response_engine_choose(request, &why)
               : ritz_response_engine_find(method);
    RITZ_REFUSE_IF(!((*out)->takes & kind) && kind == RITZ_RESPONDS_COMPONENT,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is a component: --method %s is not for it",
                   run->operand[0], method);
    RITZ_REFUSE_IF(!((*out)->takes & kind), RITZ_ERR_ARGUMENT,
                   "'%s' is small and dense: --method %s is for components",
                   run->operand[0], method);
    if (why && kind == RITZ_RESPONDS_COMPONENT)
        cli_say(run, "method %s: %s", (*out)->name, why);
    return RITZ_OK;
}

ritz_status engines_start(cli_run *run, const model *m,
                          const engines_wish *asked,
                          const ritz_damping *damping, const ritz_grid *grid,
                          const ritz_second_order *view, ritz_responder **out)
{
    const ritz_response_engine *engine = NULL;
    const char *why = NULL; /* said before */
    ritz_response_request request = {
        .damping = damping,
        .up_to_hz = isnan(asked->up_to_hz) ? 0.0 : asked->up_to_hz,
        .tolerance = isnan(asked->tolerance) ? 0.0 : share * asked->tolerance,
        .from_hz = grid->hertz ? grid->hertz[0] : grid->from_hz,
        .to_hz = grid->hertz ? grid->hertz[grid->count - 1] : grid->to_hz};

    if (m->kind == MODEL_STATES)
        request.states = &m->states;
    else if (m->kind == MODEL_COMPONENT)
        request.component = &m->component;
    else
        request.matrices = view;
    RITZ_CHECK(choose(run, m, asked->method, &request, &engine));
    if (request.component && strcmp(asked->method, "modal") == 0 &&
        (m->component.D.colptr || m->component.K4.colptr))
        cli_warn(run,
                 "the damping matrices of '%s' act on the modes that are "
                 "summed alone, --method krylov leaves out nothing",
                 run->operand[0]);
    if (strcmp(asked->method, "auto") == 0)
        RITZ_CHECK(ritz_responder_auto(&request, &why, out));
    else
        RITZ_CHECK(ritz_responder_new(engine, &request, out));
    if (ritz_responder_remark(*out)[0]) {
        cli_say(run, "  %s", ritz_responder_remark(*out));
        cli_report_text(run, "note", ritz_responder_remark(*out));
    }
    return RITZ_OK;
}

ritz_status engines_respond(ritz_responder *responder,
                            const engines_wish *asked, const ritz_grid *grid,
                            ritz_response *out)
{
    return isnan(asked->tolerance)
               ? ritz_responder_sample(responder, grid, out)
               : ritz_responder_follow(responder, grid, asked->tolerance, out);
}
