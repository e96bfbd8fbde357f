/*
 * What the joints of a body hold in a scene that spins: the bodies that are
 * connected to the first body only through this one pull at it by W^2 m_j d_j.
 */
#include "assembly/spin.h"

#include "base/alloc.h"
#include "base/vector.h"

void ritz_spin_take_place(const ritz_dense *places, int64_t k,
                          double R[static 9], double t[static 3])
{
    for (int64_t j = 0; j < 12; j++)
        *(j < 9 ? &R[j] : &t[j - 9]) = ritz_dense_col(places, j)[k];
}

void ritz_spin_arm(const ritz_scene_spin *spin, const ritz_dense *places,
                   int64_t k, const double *point, double arm[static 3])
{
    double R[9], t[3], along = 0.0;

    ritz_spin_take_place(places, k, R, t);
    ritz_turn_apply(R, point, arm);
    for (int a = 0; a < 3; a++)
        arm[a] += t[a] - spin->through[a];
    along = ritz_dot(spin->axis, arm);
    for (int a = 0; a < 3; a++)
        arm[a] -= along * spin->axis[a];
}

bool ritz_spin_names_load(const ritz_scene_component *item)
{
    for (int s = 0; s < RITZ_NUM_STIFFENINGS; s++)
        if (*item->stiffening[s])
            return true;
    return false;
}

/* Joints in their order, without those that close a loop: whether each is part
   of the tree of joints. */
static ritz_status find_tree(const ritz_scene *scene, int64_t bodies,
                             bool **out)
{
    RITZ_OWN_ARRAY int64_t *label = NULL;

    RITZ_CHECK_NEW(label, bodies);
    RITZ_CHECK_NEW(*out, scene->num_joints);
    for (int64_t k = 0; k < bodies; k++)
        label[k] = k;
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const int64_t a = label[scene->joint[j].between[0].component];
        const int64_t b = label[scene->joint[j].between[1].component];

        (*out)[j] = a != b;
        for (int64_t k = 0; k < bodies; k++)
            if (label[k] == b)
                label[k] = a;
    }
    return RITZ_OK;
}

/* Bodies that joints of the tree connect to @p start without passing through
   body k; k -1: all of its tree. */
static void reach_bodies(const ritz_scene *scene, const bool *tree,
                         int64_t start, int64_t k, bool *reached)
{
    bool more = true;

    reached[start] = true;
    while (more) {
        more = false;
        for (int64_t j = 0; j < scene->num_joints; j++) {
            const int64_t a = scene->joint[j].between[0].component;
            const int64_t b = scene->joint[j].between[1].component;

            if (!tree[j] || a == k || b == k || reached[a] == reached[b])
                continue;
            reached[a] = reached[b] = more = true;
        }
    }
}

/* Bodies between body k and the first of its tree, and all that these hold. */
static ritz_status find_inboard(const ritz_stage *stage, const bool *tree,
                                int64_t k, bool *inboard)
{
    RITZ_OWN_ARRAY bool *all = NULL;
    int64_t first = 0;

    RITZ_CHECK_NEW(all, stage->count);
    reach_bodies(stage->scene, tree, k, -1, all);
    while (!all[first])
        first++;
    if (first != k)
        reach_bodies(stage->scene, tree, first, k, inboard);
    return RITZ_OK;
}

/* Add mass and pull of the bodies from @p start outwards. */
static ritz_status add_outboard(const ritz_stage *stage, const bool *tree,
                                const ritz_dense *places, int64_t start,
                                int64_t k, ritz_spin_outlet *out)
{
    RITZ_OWN_ARRAY bool *reached = NULL;

    RITZ_CHECK_NEW(reached, stage->count);
    reach_bodies(stage->scene, tree, start, k, reached);
    out->unknown = -1;
    for (int64_t j = 0; j < stage->count; j++) {
        const ritz_inertia *of = &stage->body[j].inertia;
        double arm[3];

        if (!reached[j])
            continue;
        if (!of->known)
            out->unknown = j;
        out->mass += of->mass;
        ritz_spin_arm(&stage->scene->spin, places, j, of->centre, arm);
        for (int a = 0; a < 3; a++)
            out->pull[a] += of->mass * arm[a];
    }
    return RITZ_OK;
}

/* The origin of a port, in the frame of body k. */
static void find_origin(const ritz_stage *stage, const ritz_dense *places,
                        const ritz_scene_place *of, int64_t k, double out[3])
{
    const ritz_port_map *port =
        ritz_reduced_port(&stage->body[of->component], of->port);
    double R[9], t[3], x[3];

    if (!port) /* assembly refuses such a joint */
        return;
    ritz_spin_take_place(places, of->component, R, t);
    ritz_turn_apply(R, port->origin, x);
    for (int a = 0; a < 3; a++)
        x[a] += t[a];
    ritz_spin_take_place(places, k, R, t);
    for (int a = 0; a < 3; a++)
        x[a] -= t[a];
    ritz_turn_back(R, x, out);
}

/* Add a joint whose side s is on body k. */
static ritz_status add_joint(const ritz_stage *stage, const bool *tree,
                             const ritz_dense *places, const ritz_joint *joint,
                             int s, ritz_spin_joints *joints)
{
    const ritz_scene_place *end = joint->between;
    const int64_t k = end[s].component;
    ritz_spin_outlet *outlet = &joints->outlet[joints->count];

    outlet->port = ritz_reduced_port(&stage->body[k], end[s].port);
    if (!outlet->port) /* assembly refuses such a joint */
        return RITZ_ERR_ARGUMENT;
    joints->count++;
    return add_outboard(stage, tree, places, end[1 - s].component, k, outlet);
}

ritz_status ritz_spin_joints_of(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                ritz_spin_joints *out)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN(ritz_spin_joints) joints = {0};
    RITZ_OWN_ARRAY bool *inboard = NULL, *tree = NULL;

    RITZ_CHECK_NEW(inboard, stage->count);
    RITZ_CHECK(find_tree(scene, stage->count, &tree));
    RITZ_CHECK_NEW(joints.outlet, 2 * scene->num_joints);
    RITZ_CHECK(find_inboard(stage, tree, k, inboard));
    for (int64_t j = 0; j < 2 * scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j / 2];
        const ritz_scene_place *near = &joint->between[j % 2];
        const int64_t far = joint->between[1 - j % 2].component;

        if (!tree[j / 2] || near->component != k)
            continue;
        if (!inboard[far]) {
            RITZ_CHECK(
                add_joint(stage, tree, places, joint, (int)(j % 2), &joints));
            continue;
        }
        joints.inlet = ritz_reduced_port(&stage->body[k], near->port);
        find_origin(stage, places, &joint->between[1 - j % 2], k, joints.from);
    }
    RITZ_MOVE(*out, joints);
    return RITZ_OK;
}

ritz_status ritz_stage_spin_loop(const ritz_stage *stage, int64_t *out)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN_ARRAY bool *tree = NULL;

    *out = -1;
    RITZ_CHECK(find_tree(scene, stage->count, &tree));
    for (int64_t j = 0; j < scene->num_joints && *out < 0; j++)
        if (!tree[j])
            *out = j;
    return RITZ_OK;
}

ritz_status ritz_stage_spin_outboard(const ritz_stage *stage,
                                     const ritz_configuration *at, int64_t k,
                                     double *out)
{
    RITZ_OWN(ritz_spin_joints) joints = {0};
    double sum = 0.0;

    RITZ_CHECK(ritz_spin_joints_of(stage, &at->places, k, &joints));
    for (int64_t j = 0; j < joints.count; j++)
        sum += joints.outlet[j].mass;
    *out = sum;
    return RITZ_OK;
}

void ritz_spin_joints_free(ritz_spin_joints *joints)
{
    RITZ_FREE(joints->outlet);
    *joints = (ritz_spin_joints){0};
}
