/* The integrators, as a table. */
#include <ritz/simulate.h>

#include <ritz/text.h>

#include <stdio.h>
#include <string.h>

const ritz_integrator *const ritz_integrators[] = {
    &ritz_integrator_modal,
    &ritz_integrator_trapezoidal,
    &ritz_integrator_generalised_alpha,
    &ritz_integrator_central_difference,
    NULL,
};

enum { NUM_INTEGRATORS = sizeof ritz_integrators / sizeof(void *) - 1 };

const ritz_integrator *ritz_integrator_find(const char *name)
{
    char names[NUM_INTEGRATORS][RITZ_NAME_SIZE];
    const char *nearest = NULL;

    for (int k = 0; k < NUM_INTEGRATORS; k++) {
        if (strcmp(name, ritz_integrators[k]->name) == 0)
            return ritz_integrators[k];
        (void)snprintf(names[k], RITZ_NAME_SIZE, "%s",
                       ritz_integrators[k]->name);
    }
    nearest = ritz_text_nearest(name, NUM_INTEGRATORS, names[0], sizeof *names);
    ritz_record("no integrator '%s'%s%s%s", name, nearest ? ", is '" : "",
                nearest ? nearest : "", nearest ? "' meant?" : "");
    return NULL;
}
