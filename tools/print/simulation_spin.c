/* Runs of a scene whose rate of spin changes. */
#include "print/simulation.h"

#include "base/tolerances.h"

#include <math.h>

bool simulation_spins(const simulation_task *task)
{
    return task->scene.spin.given &&
           task->scene.spin.rate.course != RITZ_SPIN_CONSTANT;
}

/* The shortest time within which the rate changes from one value to the next
   during a run. */
static double shortest_change(const ritz_spin_rate *rate, double seconds)
{
    double least = HUGE_VAL;

    if (rate->course == RITZ_SPIN_RAMP)
        return rate->value[0] != 0.0 ? rate->time[0] : least;
    for (int64_t k = 0; k + 1 < rate->count && rate->time[k] < seconds; k++)
        if (rate->time[k + 1] > 0.0 && rate->value[k + 1] != rate->value[k])
            least = fmin(least, rate->time[k + 1] - rate->time[k]);
    return least;
}

static void warn_of_step(const simulation_task *task,
                         const ritz_simulation_request *request)
{
    const double least =
        shortest_change(&task->scene.spin.rate, request->seconds);

    if (request->step > least * (1.0 + RITZ_SAME))
        cli_warn(task->run,
                 "the step of %g s is longer than the %g s in which the rate "
                 "of spin changes: only the mean of that change acts",
                 request->step, least);
}

ritz_status simulation_spin(simulation_task *task,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    RITZ_OWN(ritz_spin_terms) terms = {0};

    if (!task->told) /* once, of a run with checkpoints too */
        warn_of_step(task, request);
    task->told = true;
    RITZ_CHECK(ritz_stage_spin(&task->stage, task->m.at, &terms));
    return ritz_simulate_spun(task->subject, &terms, &task->scene.spin.rate,
                              request, out);
}
