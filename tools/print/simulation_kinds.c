/* The table of runs that are not those of one linear model. A new one needs a
   file with its functions, and a row here. */
#include "print/simulation.h"

const simulation_kind simulation_kinds[] = {
    {.option = "--constraints",
     .asked = simulation_is_constrained,
     .simulate = simulation_constrained},
    {.option = "--switched",
     .asked = simulation_switched_asked,
     .simulate = simulation_switched,
     .prepare = simulation_switched_prepare},
    {.option = "--controller",
     .asked = simulation_is_controlled,
     .simulate = simulation_controlled,
     .prepare = simulation_prepare_loop},
    {.option = "--sweep",
     .asked = simulation_sweep_asked,
     .simulate = simulation_sweep},
    {0},
};

ritz_status simulation_find_kind(const simulation_options *given,
                                 const simulation_kind **out)
{
    *out = NULL;
    for (const simulation_kind *k = simulation_kinds; k->option; k++) {
        if (!k->asked(given))
            continue;
        RITZ_REFUSE_IF(*out, RITZ_ERR_ARGUMENT, "give %s or %s, not both",
                       (*out)->option, k->option);
        *out = k;
    }
    return RITZ_OK;
}
