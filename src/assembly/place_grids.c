/* Grids of all bodies side by side, where a configuration puts them. */
#include "assembly/placement.h"
#include "assembly/turns.h"
#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

/* Numbers stay where ranges do not overlap; else body k adds k 10^p. */
static void renumber(int64_t count, const ritz_component *body, int64_t *add)
{
    int64_t power = 1;
    int64_t highest = -1;
    bool overlap = false;

    for (int64_t k = 0; k < count; k++) {
        int64_t least = INT64_MAX;
        int64_t most = -1;
        int64_t n = body[k].num_dofs;

        for (int64_t i = 0; i < n + body[k].recovery.count; i++) {
            int64_t grid =
                i < n ? body[k].dof[i].grid : body[k].recovery.dof[i - n].grid;

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
static void append(const ritz_grids *from, const ritz_placement *place,
                   int64_t add, ritz_grids *to)
{
    for (int64_t i = 0; i < from->count; i++) {
        double *x = to->position + 3 * to->count;

        ritz_turn_apply(place->R, from->position + 3 * i, x);
        for (int64_t k = 0; k < 3; k++)
            x[k] += place->t[k];
        to->id[to->count] = from->id[i] + add;
        to->frame[to->count++] = to->num_frames + from->frame[i];
    }
    for (int64_t f = 0; f < from->num_frames; f++)
        for (int64_t k = 0; k < 3; k++)
            ritz_turn_apply(place->R, from->axes + 9 * f + 3 * k,
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
    ritz_placement *place = NULL;
    ritz_joint_pose *pose = NULL;
    ritz_grids all = {0};
    int64_t grids = 0;
    int64_t frames = 1;

    for (int64_t k = 0; k < count; k++) {
        grids += body[k].grids.count;
        frames += body[k].grids.num_frames;
    }
    RITZ_NEW(place, count);
    RITZ_NEW(pose, stage->scene->num_joints);
    RITZ_NEW(all.id, grids);
    RITZ_NEW(all.position, 3 * grids);
    RITZ_NEW(all.frame, grids);
    RITZ_NEW(all.axes, 9 * frames);
    for (int64_t j = 0; j < stage->scene->num_joints; j++)
        ritz_joint_pose_at(&stage->scene->joint[j], setting, &pose[j]);
    ritz_place_bodies(stage, pose, place);
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
    free(pose);
    ritz_grids_free(&all);
    return status;
}
