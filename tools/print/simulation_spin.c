/* Runs of a scene whose rate of spin changes. */
#include "print/simulation.h"

bool simulation_spins(const simulation_task *task)
{
    return task->scene.spin.given &&
           task->scene.spin.rate.course != RITZ_SPIN_CONSTANT;
}

ritz_status simulation_spin(simulation_task *task,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    RITZ_OWN(ritz_spin_terms) terms = {0};

    RITZ_CHECK(ritz_stage_spin(&task->stage, task->m.at, &terms));
    return ritz_simulate_spun(task->subject, &terms, &task->scene.spin.rate,
                              request, out);
}
