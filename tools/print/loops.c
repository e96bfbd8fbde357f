/* What tools that close loops print: how signals are joined, and whether the
   loop is stable. */
#include "print/print.h"

ritz_status loop_join(cli_run *run, const loop_options *given,
                      const ritz_io *plant, const ritz_io *controller,
                      ritz_loop *out)
{
    RITZ_OWN(ritz_loop) loop = {0};

    RITZ_CHECK_IN(given->controller,
                  ritz_loop_match(plant, controller, given->connect.count,
                                  given->connect.text, &loop));
    loop.positive = given->feedback && strcmp(given->feedback, "positive") == 0;
    cli_say(run, "loop with '%s', %s feedback:", given->controller,
            loop.positive ? "positive" : "negative");
    for (int64_t k = 0; k < loop.num_measured; k++)
        cli_say(run, "  %s -> controller %s", plant->output[loop.measured[k]],
                controller->input[k]);
    for (int64_t k = 0; k < loop.num_driven; k++)
        cli_say(run, "  controller %s -> %s", controller->output[k],
                plant->input[loop.driven[k]]);
    RITZ_MOVE(*out, loop);
    return RITZ_OK;
}

void loop_say_stability(cli_run *run, const ritz_probe *probe)
{
    char text[2 * RITZ_NAME_SIZE];
    const char *verdict = ritz_stability_name(probe->verdict);

    ritz_probe_print(probe, text);
    sink_say(run, "stability", "the loop is %s: %s", verdict, text);
}
