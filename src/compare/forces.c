/* Forces for which static corrections are made: what a plan asks for. */
#include "compare/compare.h"

#include "assembly/assembly.h"
#include "base/alloc.h"

#include <string.h>

bool ritz_plan_attaches(const ritz_scene *scene, const ritz_plan *plan,
                        int64_t j)
{
    for (int64_t k = 0; plan->inputs_too && k < scene->num_attached_inputs; k++)
        if (scene->attached_input[k] == j)
            return true;
    return plan->attached & RITZ_ATTACHED_INPUTS;
}

/* Whether a joint has a damper in a motion that it leaves. */
static bool has_damper(const ritz_joint *joint)
{
    for (int64_t k = 0; k < joint->num_freedoms; k++)
        if (joint->freedom[k].state == RITZ_CAGED &&
            joint->freedom[k].damping > 0.0)
            return true;
    return false;
}

bool ritz_stage_is_damped(const ritz_stage *stage)
{
    bool damped = stage->dampers.count > 0;

    for (int64_t j = 0; j < stage->scene->num_joints; j++)
        damped = damped || has_damper(&stage->scene->joint[j]);
    return damped;
}

/* Whether a joint that is among the planned forces holds a port of body k. */
static bool is_attached(const ritz_scene *scene, const ritz_plan *plan,
                        int64_t k, const char *port)
{
    for (int64_t j = 0; j < scene->num_joints; j++)
        for (int end = 0; end < 2; end++) {
            const ritz_joint *joint = &scene->joint[j];
            const ritz_scene_place *at = &joint->between[end];

            if (at->component == k && strcmp(at->port, port) == 0 &&
                (plan->attached & RITZ_ATTACHED_INTERFACE ||
                 (plan->attached & RITZ_ATTACHED_DAMPERS && has_damper(joint))))
                return true;
        }
    return false;
}

/* Append rows of A, for the coordinates of one body, as columns m.. of F. */
static int64_t append_rows(const ritz_dense *A, int64_t first, ritz_dense *F,
                           int64_t m)
{
    for (int64_t i = 0; i < A->nrow; i++)
        for (int64_t q = 0; q < F->nrow; q++)
            ritz_dense_col(F, m + i)[q] = ritz_dense_col(A, first + q)[i];
    return m + A->nrow;
}

ritz_status ritz_plan_forces(const ritz_stage *stage, int64_t k,
                             const ritz_plan *plan, ritz_dense *out)
{
    const ritz_reduced *body = &stage->body[k];
    const ritz_io *io = &stage->io;
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t most = io->num_inputs + 3 * io->num_outputs + body->dampers.count;
    int64_t first = stage->first[k];
    int64_t m = 0;
    RITZ_OWN(ritz_dense) F = {0};

    for (int64_t p = 0; p < body->num_ports; p++)
        most += body->port[p].count;
    RITZ_CHECK(ritz_dense_new(body->K.ncol, most, &F));
    for (int64_t j = 0; j < io->num_inputs && F.nrow > 0; j++)
        if (ritz_plan_attaches(stage->scene, plan, j))
            memcpy(ritz_dense_col(&F, m++), ritz_dense_col(&io->B, j) + first,
                   (size_t)F.nrow * sizeof *F.val);
    for (int64_t p = 0; p < body->num_ports; p++)
        if (is_attached(stage->scene, plan, k, body->port[p].name))
            m = append_rows(&body->port[p].map, 0, &F, m);
    for (int c = 0; c < 3 && (plan->attached & RITZ_ATTACHED_OUTPUTS); c++)
        m = append_rows(C[c], first, &F, m);
    if (plan->attached & RITZ_ATTACHED_DAMPERS) {
        ritz_dense_put(&body->dampers.B, 0, m, &F);
        m += body->dampers.count;
    }
    return ritz_dense_columns(&F, 0, m, out);
}

/* (S P)' of one spring, its elongations as the modes move. */
static void add_spring(const ritz_stage *stage, const ritz_configuration *c,
                       const ritz_springs *springs, int64_t spring, double *f)
{
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t j = 0; j < c->K.ncol; j++)
            for (int64_t q = 0; q < c->P[k].nrow; q++)
                f[j] +=
                    ritz_dense_col(&springs->S, stage->first[k] + q)[spring] *
                    ritz_dense_col(&c->P[k], j)[q];
}

ritz_status ritz_damper_forces(const ritz_stage *stage,
                               const ritz_configuration *configuration,
                               ritz_dense *out)
{
    const ritz_configuration *c = configuration;
    const int64_t own = c->dampers.count;
    RITZ_OWN(ritz_springs) springs = {0};
    RITZ_OWN(ritz_dense) F = {0};
    int64_t m = own;

    RITZ_CHECK(ritz_stage_springs(stage, c->setting, &springs));
    RITZ_CHECK(ritz_dense_new(c->K.ncol, own + springs.S.nrow, &F));
    ritz_dense_put(&c->dampers.B, 0, 0, &F);
    for (int64_t k = 0; k < springs.S.nrow; k++)
        if (springs.hold[k].damping > 0.0)
            add_spring(stage, c, &springs, k, ritz_dense_col(&F, m++));
    return ritz_dense_columns(&F, 0, m, out);
}
