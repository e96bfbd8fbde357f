/*
 * Bodies follow each other through the joints: a point x_B of the second body
 * stands, in the axes of the first, at o_A + d + R (x_B - o_B), the origins
 * being those of the ports.
 *
 * The joint that closes a loop finds both bodies placed. Its settings are
 * written with a few digits and fit as well as that; what it states must hold
 * where the bodies are, lest a gap of rounded digits take a rigid motion from
 * the system. So it gets R and d of the placements.
 */
#include "assembly/placement.h"

#include "assembly/turns.h"
#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Angles and positions of a loop are written with so many digits. */
static const double closure = 1e-4;
/* Of placements a few bodies apart, each a product of rotations: no gap. */
static const double rounding = 1e-13;

/* What a joint says of its two bodies: x - near of the first is R (x - far). */
typedef struct link {
    int64_t body[2];
    double near[3]; /* o_A + d */
    double far[3];  /* o_B */
    const double *R;
    bool turns_freely;
} link;

/* Whether a joint's ports are there; where not, its making refuses it. */
static bool find_link(const ritz_stage *stage, int64_t j,
                      const ritz_joint_pose *pose, link *out)
{
    const ritz_joint *joint = &stage->scene->joint[j];
    const ritz_port_map *port[2];

    for (int k = 0; k < 2; k++) {
        out->body[k] = joint->between[k].component;
        port[k] = ritz_reduced_port(&stage->body[out->body[k]],
                                    joint->between[k].port);
        if (!port[k])
            return false;
    }
    for (int i = 0; i < 3; i++) {
        out->near[i] = port[0]->origin[i] + pose[j].d[i];
        out->far[i] = port[1]->origin[i];
    }
    out->R = pose[j].R;
    out->turns_freely = joint->type == RITZ_JOINT_SPHERICAL;
    return true;
}

/*
 * With R_A, t_A known: R_B = R_A R and t_B = R_A (o_A + d - R o_B) + t_A; with
 * the second body known the same holds with R' and the ends exchanged.
 */
static void follow(const ritz_placement *known, const double *R,
                   const double *near, const double *far, ritz_placement *out)
{
    double turned[3], gap[3];

    ritz_turn_product(known->R, R, out->R);
    ritz_turn_apply(R, far, turned);
    for (int i = 0; i < 3; i++)
        turned[i] = near[i] - turned[i];
    ritz_turn_apply(known->R, turned, gap);
    for (int i = 0; i < 3; i++)
        out->t[i] = gap[i] + known->t[i];
    out->known = true;
}

static void transpose(const double *R, double *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = R[3 * j + i];
}

/*
 * Go once through the joints; whether a body found its place. With
 * `turns_freely` one body does, through a joint that cannot turn it.
 */
static bool spread(const ritz_stage *stage, const ritz_joint_pose *pose,
                   bool turns_freely, ritz_placement *place)
{
    bool found = false;

    for (int64_t j = 0; j < stage->scene->num_joints; j++) {
        link at;
        ritz_placement *a = NULL, *b = NULL;
        double back[9];

        if (!find_link(stage, j, pose, &at) || at.turns_freely != turns_freely)
            continue;
        a = &place[at.body[0]];
        b = &place[at.body[1]];
        if (a->known == b->known)
            continue;
        transpose(at.R, back);
        if (a->known)
            follow(a, at.R, at.near, at.far, b);
        else
            follow(b, back, at.far, at.near, a);
        found = true;
        if (turns_freely)
            return true;
    }
    return found;
}

void ritz_place_bodies(const ritz_stage *stage, const ritz_joint_pose *pose,
                       ritz_placement *place)
{
    for (int64_t k = 0; k < stage->count; k++) {
        if (place[k].known)
            continue;
        place[k] = (ritz_placement){true, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}};
        while (spread(stage, pose, false, place) ||
               spread(stage, pose, true, place))
            ;
    }
}

static double length(const double *x)
{
    return sqrt(ritz_dot(x, x));
}

/* How badly a loop closes: apart, beside the size of bodies there; turned. */
typedef struct misfit {
    double gap, size, turn;
} misfit;

/* Where the joint puts the second body against where it stands. */
static misfit measure(const link *at, const ritz_placement *place)
{
    const ritz_placement *b = &place[at->body[1]];
    misfit found = {0.0, length(at->near) + length(at->far) + length(b->t),
                    0.0};
    ritz_placement due = {0};
    double here[3], there[3];

    follow(&place[at->body[0]], at->R, at->near, at->far, &due);
    ritz_turn_apply(due.R, at->far, here);
    ritz_turn_apply(b->R, at->far, there);
    for (int i = 0; i < 3; i++)
        here[i] += due.t[i] - there[i] - b->t[i];
    found.gap = length(here);
    for (int i = 0; i < 9; i++)
        found.turn = fmax(found.turn, fabs(due.R[i] - b->R[i]));
    return found;
}

/* R = R_A'R_B, d = R_A'(R_B o_B + t_B - t_A) - o_A: what the bodies have. */
static void take_pose(const link *at, const ritz_placement *place,
                      ritz_joint_pose *pose)
{
    const ritz_placement *a = &place[at->body[0]];
    const ritz_placement *b = &place[at->body[1]];
    double there[3], seen[3];

    ritz_turn_apply(b->R, at->far, there);
    for (int i = 0; i < 3; i++)
        there[i] += b->t[i] - a->t[i];
    ritz_turn_back(a->R, there, seen);
    for (int i = 0; i < 3; i++) /* near is o_A + d of the settings */
        pose->d[i] += seen[i] - at->near[i];
    ritz_turn_between(a->R, b->R, pose->R);
}

static ritz_status close_joint(const ritz_stage *stage, int64_t j,
                               const link *at, const ritz_placement *place,
                               ritz_joint_pose *pose)
{
    ritz_status status = RITZ_OK;
    const ritz_joint *joint = &stage->scene->joint[j];
    const ritz_scene_component *component = stage->scene->component;
    const misfit found = measure(at, place);

    if (found.gap <= rounding * found.size && found.turn <= rounding)
        return RITZ_OK;
    RITZ_FAIL_IF(found.gap > closure * found.size, RITZ_ERR_ARGUMENT,
                 "closes a loop of joints that does not meet: '%s/%s' and "
                 "'%s/%s' stand %.3g apart",
                 component[at->body[0]].name, joint->between[0].port,
                 component[at->body[1]].name, joint->between[1].port,
                 found.gap);
    RITZ_FAIL_IF(found.turn > closure && !at->turns_freely, RITZ_ERR_ARGUMENT,
                 "closes a loop of joints whose angles do not agree: '%s' is "
                 "turned otherwise against '%s' by the other joints",
                 component[at->body[1]].name, component[at->body[0]].name);
    take_pose(at, place, pose);
done:
    return ritz_scene_context(stage->scene, status, joint->line, joint->column,
                              "joint", joint->name);
}

ritz_status ritz_place_joints(const ritz_stage *stage, const double *setting,
                              ritz_joint_pose *pose)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_placement *place = NULL;

    RITZ_NEW(place, stage->count);
    for (int64_t j = 0; j < scene->num_joints; j++)
        ritz_joint_pose_at(&scene->joint[j], setting, &pose[j]);
    ritz_place_bodies(stage, pose, place);
    for (int64_t j = 0; j < scene->num_joints; j++) {
        link at;

        if (find_link(stage, j, pose, &at))
            RITZ_TRY(close_joint(stage, j, &at, place, &pose[j]));
    }
done:
    free(place);
    return status;
}
