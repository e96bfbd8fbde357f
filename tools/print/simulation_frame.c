/* Bodies and frame of the coordinates that a run has stored. */
#include "print/simulation.h"

ritz_status simulation_name_bodies(const simulation_task *task,
                                   const bool *turns, ritz_simulation *s)
{
    if (s->num_coordinates == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_stage_blocks(&task->stage, &s->block));
    s->num_blocks = task->stage.count;
    for (int64_t k = 0; turns && k < s->num_blocks; k++)
        s->block[k].turns = turns[k];
    return RITZ_OK;
}

void simulation_name_spin(const simulation_task *task, ritz_simulation *s)
{
    if (task->m.kind == MODEL_SYSTEM)
        memcpy(s->spin, task->m.system.spin, sizeof s->spin);
    if (simulation_spins(task))
        (void)snprintf(s->spin, sizeof s->spin, "%s, at a rate that changes",
                       ritz_spin_model_name(task->scene.spin.model));
}
