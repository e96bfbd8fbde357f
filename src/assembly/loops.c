/* The closed loops of a scene's joints: one for each joint that is not in a
   tree of joints which reaches all bodies. */
#include "assembly/assembly.h"

#include "base/alloc.h"

#include <stdlib.h>

enum { TWIST = 6 };

void ritz_loops_free(ritz_loops *loops)
{
    free(loops->sign);
    *loops = (ritz_loops){0};
}

/* Bodies that joints connect get one number. */
ritz_status ritz_scene_loops(const ritz_scene *scene, bool *closed)
{
    RITZ_OWN_ARRAY int64_t *number = NULL;

    *closed = false;
    RITZ_CHECK_NEW(number, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++)
        number[k] = k;
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_scene_place *end = scene->joint[j].between;
        const int64_t a = number[end[0].component];
        const int64_t b = number[end[1].component];

        *closed = *closed || a == b;
        for (int64_t k = 0; k < scene->num_components; k++)
            number[k] = number[k] == b ? a : number[k];
    }
    return RITZ_OK;
}

/* Whether a port holds all motions of a body, by itself. */
static bool holds_fully(ritz_plane plane, const ritz_port_map *port)
{
    int64_t grids = 0, needed = 0, there = 0;

    for (int64_t d = 1; d <= TWIST; d++)
        needed += ritz_plane_has(plane, d);
    for (int64_t k = 0; k < port->count; k++) {
        if (port->dof[k].component < 1)
            continue;
        grids += k == 0 || port->dof[k].grid != port->dof[k - 1].grid;
        there += port->dof[k].grid == port->dof[0].grid &&
                 ritz_plane_has(plane, port->dof[k].component);
    }
    return grids > 2 || there >= needed;
}

/* Whether rigid bodies cannot move in all directions against each other. Fixed
   joints of less than a body's six motions are left out. */
static bool ties(const ritz_stage *stage, const ritz_joint *joint)
{
    for (int k = 0; k < 2; k++) {
        const ritz_port_map *port = ritz_reduced_port(
            &stage->body[joint->between[k].component], joint->between[k].port);

        if (!port || (joint->type == RITZ_JOINT_FIXED &&
                      !holds_fully(joint->plane, port)))
            return false;
    }
    return joint->type != RITZ_JOINT_BUSHING;
}

/* A tree of joints: the joint through which a body was reached, -1 at a root. */
typedef struct joint_tree {
    int64_t *up; /* of each body */
    bool *in;    /* of each joint */
} joint_tree;

static void free_tree(joint_tree *t)
{
    free(t->up);
    free(t->in);
}

/* Reach all bodies that joints tie to those which are reached. */
static void grow_tree(const ritz_stage *stage, bool *reached, joint_tree *t)
{
    for (bool found = true; found;) {
        found = false;
        for (int64_t j = 0; j < stage->scene->num_joints; j++) {
            const ritz_joint *joint = &stage->scene->joint[j];
            const int64_t a = joint->between[0].component;
            const int64_t b = joint->between[1].component;

            if (reached[a] == reached[b] || !ties(stage, joint))
                continue;
            t->up[reached[a] ? b : a] = j;
            reached[a] = reached[b] = true;
            t->in[j] = found = true;
        }
    }
}

static ritz_status find_tree(const ritz_stage *stage, joint_tree *t)
{
    RITZ_OWN_ARRAY bool *reached = NULL;

    RITZ_CHECK_NEW(reached, stage->count);
    RITZ_CHECK_NEW(t->up, stage->count);
    RITZ_CHECK_NEW(t->in, stage->scene->num_joints);
    for (int64_t k = 0; k < stage->count; k++)
        t->up[k] = -1;
    for (int64_t k = 0; k < stage->count; k++) {
        if (reached[k])
            continue;
        reached[k] = true;
        grow_tree(stage, reached, t);
    }
    return RITZ_OK;
}

/* Add the joints from a body to the root: the second body's twist less the
   first's counts with @p sign where the way goes up from the second. */
static void walk_up(const ritz_scene *scene, const joint_tree *t, int64_t body,
                    double sign, double *to)
{
    while (t->up[body] >= 0) {
        const ritz_scene_place *end = scene->joint[t->up[body]].between;
        const bool second = end[1].component == body;

        to[t->up[body]] += second ? sign : -sign;
        body = end[second ? 0 : 1].component;
    }
}

ritz_status ritz_loops_of(const ritz_stage *stage, ritz_loops *out)
{
    const ritz_scene *scene = stage->scene;
    [[gnu::cleanup(free_tree)]] joint_tree t = {0};
    RITZ_OWN(ritz_loops) l = {0};
    bool closed = false;

    RITZ_CHECK(ritz_scene_loops(scene, &closed));
    if (!closed)
        return RITZ_OK;
    RITZ_CHECK(find_tree(stage, &t));
    l.num_joints = scene->num_joints;
    for (int64_t j = 0; j < l.num_joints; j++)
        l.count += !t.in[j] && ties(stage, &scene->joint[j]);
    if (l.count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(l.sign, l.count * l.num_joints);
    for (int64_t j = 0, k = 0; j < l.num_joints; j++) {
        double *sign = l.sign + k * l.num_joints;

        if (t.in[j] || !ties(stage, &scene->joint[j]))
            continue;
        sign[j] = 1.0;
        walk_up(scene, &t, scene->joint[j].between[1].component, -1.0, sign);
        walk_up(scene, &t, scene->joint[j].between[0].component, 1.0, sign);
        k++;
    }
    RITZ_MOVE(*out, l);
    return RITZ_OK;
}
