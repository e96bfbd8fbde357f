/* The table of integrators: a new one is a file with a descriptor, and a
   row. */
#include <ritz/simulate.h>

const ritz_integrator *const ritz_integrators[] = {
    &ritz_integrator_modal,
    &ritz_integrator_trapezoidal,
    &ritz_integrator_generalised_alpha,
    &ritz_integrator_central_difference,
    NULL,
};
