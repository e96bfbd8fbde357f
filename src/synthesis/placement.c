/*
 * Bodies follow each other through the joints: a point x_B of the second body
 * stands, in the axes of the first, at o_A + R (x_B - o_B), the origins being
 * those of the ports.
 */
#include "synthesis/placement.h"

#include "base/alloc.h"
#include "synthesis/joints.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Angles and positions of a loop are written with so many digits. */
static const double closure = 1e-4;

/* x_system = R x + t. */
typedef struct placement {
    bool known;
    double R[9];
    double t[3];
} placement;

static void multiply(const double *A, const double *B, double *C)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            C[3 * i + j] = 0.0;
            for (int k = 0; k < 3; k++)
                C[3 * i + j] += A[3 * i + k] * B[3 * k + j];
        }
}

static void apply(const double *R, const double *x, double *y)
{
    for (int64_t i = 0; i < 3; i++)
        y[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

/*
 * With R_A, t_A known: R_B = R_A R and t_B = R_A (o_A - R o_B) + t_A; with the
 * second body known the same holds with R' and the ends exchanged.
 */
static void follow(const placement *known, const double *R, const double *near,
                   const double *far, placement *out)
{
    double turned[3], gap[3];

    multiply(known->R, R, out->R);
    apply(R, far, turned);
    for (int i = 0; i < 3; i++)
        turned[i] = near[i] - turned[i];
    apply(known->R, turned, gap);
    for (int i = 0; i < 3; i++)
        out->t[i] = gap[i] + known->t[i];
    out->known = true;
}

static void transpose(double *R)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) {
            double kept = R[3 * i + j];

            R[3 * i + j] = R[3 * j + i];
            R[3 * j + i] = kept;
        }
}

/* Go once through the joints; whether a body found its place. */
static bool spread(const ritz_stage *stage, const double *setting,
                   placement *place)
{
    static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const ritz_scene *scene = stage->scene;
    bool found = false;
    int64_t hinge = 0;

    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j];
        int64_t a = joint->between[0].component;
        int64_t b = joint->between[1].component;
        const ritz_port_map *port_a =
            ritz_reduced_port(&stage->body[a], joint->between[0].port);
        const ritz_port_map *port_b =
            ritz_reduced_port(&stage->body[b], joint->between[1].port);
        double R[9];

        memcpy(R, unit, sizeof R);
        if (joint->type == RITZ_JOINT_HINGE)
            ritz_joint_rotation(joint->axis, setting[hinge++], R);
        if (!port_a || !port_b || place[a].known == place[b].known)
            continue;
        if (place[a].known) {
            follow(&place[a], R, port_a->origin, port_b->origin, &place[b]);
        } else {
            transpose(R);
            follow(&place[b], R, port_b->origin, port_a->origin, &place[a]);
        }
        found = true;
    }
    return found;
}

/* Every body, those that nothing holds staying where they are. */
static void place_all(const ritz_stage *stage, const double *setting,
                      placement *place)
{
    for (int64_t k = 0; k < stage->count; k++) {
        if (place[k].known)
            continue;
        place[k] = (placement){true, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}};
        while (spread(stage, setting, place))
            ;
    }
}

static double length(const double *x)
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* How badly a loop closes: apart, beside the size of bodies there; turned. */
typedef struct misfit {
    double gap, size, turn;
} misfit;

/* Where the joint puts the second body against where it stands. */
static misfit measure_joint(const placement *a, const placement *b,
                            const double *R, const double *near,
                            const double *far)
{
    misfit found = {0.0, length(near) + length(far) + length(b->t), 0.0};
    placement due = {0};
    double here[3], there[3];

    follow(a, R, near, far, &due);
    apply(due.R, far, here);
    apply(b->R, far, there);
    for (int i = 0; i < 3; i++)
        here[i] += due.t[i] - there[i] - b->t[i];
    found.gap = length(here);
    for (int i = 0; i < 9; i++)
        found.turn = fmax(found.turn, fabs(due.R[i] - b->R[i]));
    return found;
}

static ritz_status check_joint(const ritz_stage *stage, const placement *place,
                               const ritz_joint *joint, double setting)
{
    ritz_status status = RITZ_OK;
    int64_t a = joint->between[0].component;
    int64_t b = joint->between[1].component;
    const ritz_port_map *near =
        ritz_reduced_port(&stage->body[a], joint->between[0].port);
    const ritz_port_map *far =
        ritz_reduced_port(&stage->body[b], joint->between[1].port);
    double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    misfit found = {0};

    if (!near || !far)
        return RITZ_OK; /* refused where the joint is made */
    if (joint->type == RITZ_JOINT_HINGE)
        ritz_joint_rotation(joint->axis, setting, R);
    found = measure_joint(&place[a], &place[b], R, near->origin, far->origin);
    RITZ_FAIL_IF(found.gap > closure * found.size, RITZ_ERR_ARGUMENT,
                 "closes a loop of joints that does not meet: '%s/%s' and "
                 "'%s/%s' stand %.3g apart",
                 stage->scene->component[a].name, near->name,
                 stage->scene->component[b].name, far->name, found.gap);
    RITZ_FAIL_IF(found.turn > closure, RITZ_ERR_ARGUMENT,
                 "closes a loop of joints whose angles do not agree: '%s' is "
                 "turned otherwise against '%s' by the other joints",
                 stage->scene->component[b].name,
                 stage->scene->component[a].name);
done:
    return ritz_scene_context(stage->scene, status, joint->line, joint->column,
                              "joint", joint->name);
}

ritz_status ritz_place_check(const ritz_stage *stage, const double *setting)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    placement *place = NULL;
    int64_t hinge = 0;

    RITZ_NEW(place, stage->count);
    place_all(stage, setting, place);
    for (int64_t j = 0; j < scene->num_joints; j++) {
        bool turns = scene->joint[j].type == RITZ_JOINT_HINGE;

        RITZ_TRY(check_joint(stage, place, &scene->joint[j],
                             turns ? setting[hinge] : 0.0));
        hinge += turns;
    }
done:
    free(place);
    return status;
}

/* Numbers stay where ranges do not overlap; else body k adds k 10^p. */
static void renumber(int64_t count, const ritz_component *body, int64_t *add)
{
    int64_t power = 1;
    int64_t highest = -1;
    bool overlap = false;

    for (int64_t k = 0; k < count; k++) {
        int64_t least = INT64_MAX;
        int64_t most = -1;

        for (int64_t i = 0; i < body[k].num_dofs; i++) {
            int64_t grid = body[k].dof[i].grid;

            least = grid < least ? grid : least;
            most = grid > most ? grid : most;
        }
        overlap = overlap || least <= highest;
        highest = most > highest ? most : highest;
    }
    while (highest >= power && power < INT64_MAX / 1000)
        power *= 10;
    for (int64_t k = 0; k < count; k++)
        add[k] = overlap ? k * power : 0;
}

/* Append the grids of one body. */
static void append(const ritz_grids *from, const placement *place, int64_t add,
                   ritz_grids *to)
{
    for (int64_t i = 0; i < from->count; i++) {
        double *x = to->position + 3 * to->count;

        apply(place->R, from->position + 3 * i, x);
        for (int64_t k = 0; k < 3; k++)
            x[k] += place->t[k];
        to->id[to->count] = from->id[i] + add;
        to->frame[to->count++] = to->num_frames + from->frame[i];
    }
    for (int64_t f = 0; f < from->num_frames; f++)
        for (int64_t k = 0; k < 3; k++)
            apply(place->R, from->axes + 9 * f + 3 * k,
                  to->axes + 9 * (to->num_frames + f) + 3 * k);
    to->num_frames += from->num_frames;
}

/* One grid of the sorted order. */
typedef struct entry {
    int64_t id, at;
} entry;

static int compare(const void *left, const void *right)
{
    const entry *a = left;
    const entry *b = right;

    return (a->id > b->id) - (a->id < b->id);
}

/* Put grids in ascending order of number. */
static ritz_status sort(ritz_grids *grids)
{
    ritz_status status = RITZ_OK;
    size_t n = (size_t)grids->count;
    entry *order = NULL;
    double *position = NULL;
    int64_t *frame = NULL;

    RITZ_NEW(order, grids->count);
    RITZ_NEW(position, 3 * grids->count);
    RITZ_NEW(frame, grids->count);
    for (int64_t k = 0; k < grids->count; k++)
        order[k] = (entry){grids->id[k], k};
    qsort(order, n, sizeof *order, compare);
    for (int64_t k = 0; k < grids->count; k++) {
        memcpy(position + 3 * k, grids->position + 3 * order[k].at,
               3 * sizeof *position);
        frame[k] = grids->frame[order[k].at];
        grids->id[k] = order[k].id;
    }
    free(grids->position);
    free(grids->frame);
    grids->position = position;
    grids->frame = frame;
    position = NULL;
    frame = NULL;
done:
    free(order);
    free(position);
    free(frame);
    return status;
}

ritz_status ritz_place_grids(const ritz_stage *stage, const double *setting,
                             int64_t count, const ritz_component *body,
                             int64_t *add, ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    placement *place = NULL;
    ritz_grids all = {0};
    int64_t grids = 0;
    int64_t frames = 1;

    for (int64_t k = 0; k < count; k++) {
        grids += body[k].grids.count;
        frames += body[k].grids.num_frames;
    }
    RITZ_NEW(place, count);
    RITZ_NEW(all.id, grids);
    RITZ_NEW(all.position, 3 * grids);
    RITZ_NEW(all.frame, grids);
    RITZ_NEW(all.axes, 9 * frames);
    place_all(stage, setting, place);
    renumber(count, body, add);
    all.num_frames = 1;
    for (int64_t k = 0; k < 3; k++)
        all.axes[4 * k] = 1.0;
    for (int64_t k = 0; k < count; k++)
        append(&body[k].grids, &place[k], add[k], &all);
    RITZ_TRY(sort(&all));
    *out = all;
    all = (ritz_grids){0};
done:
    free(place);
    ritz_grids_free(&all);
    return status;
}
