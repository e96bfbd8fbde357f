/*
 * A fixed joint: every grid of one port with the grid of the other that lies
 * at the same place, each measured from its port's origin.
 */
#include "assembly/joints.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

int64_t ritz_joint_direction(const ritz_joint_end *end, int64_t first,
                             int64_t direction)
{
    for (int64_t k = first; k < end->count; k++)
        if (end->dof[k].grid == end->dof[first].grid &&
            end->dof[k].component == direction)
            return k;
    return -1;
}

/* Rows at which a new grid begins, scalar points left out; how many. */
static int64_t list_grids(const ritz_joint_end *end, int64_t *first)
{
    int64_t count = 0;

    for (int64_t k = 0; k < end->count; k++)
        if (end->dof[k].component > 0 &&
            (k == 0 || end->dof[k].grid != end->dof[k - 1].grid))
            first[count++] = k;
    return count;
}

double ritz_joint_distance(const ritz_joint_end end[static 2], int64_t a,
                           int64_t b)
{
    double sum = 0.0;

    for (int i = 0; i < 3; i++) {
        double d = end[0].position[3 * a + i] - end[0].origin[i] -
                   (end[1].position[3 * b + i] - end[1].origin[i]);

        sum += d * d;
    }
    return sqrt(sum);
}

/* 1e-5 of the largest distance of a port's grids from its origin. */
double ritz_joint_tolerance(const ritz_joint *joint, const ritz_joint_end *end)
{
    double most = 0.0;

    for (int64_t k = 0; k < end->count; k++) {
        double sum = 0.0;

        for (int i = 0; i < 3; i++) {
            double d = end->position[3 * k + i] - end->origin[i];

            sum += d * d;
        }
        most = fmax(most, sqrt(sum));
    }
    return joint->tolerance > 0.0 ? joint->tolerance : 1e-5 * most + 1e-12;
}

/* Six equalities at most, of the directions that both grids have. */
static void pair_grids(const ritz_joint_end end[static 2], int64_t a, int64_t b,
                       ritz_relations *list)
{
    for (int64_t direction = 1; direction <= 6; direction++) {
        int64_t i = ritz_joint_direction(&end[0], a, direction);
        int64_t j = ritz_joint_direction(&end[1], b, direction);

        if (i >= 0 && j >= 0)
            list->item[list->count++] = (ritz_relation){
                .rotation = direction > 3,
                .freedom = {.state = RITZ_LOCKED},
                .num_terms = {1, 1},
                .row = {{i}, {j}},
                .factor = {{1.0}, {1.0}},
            };
    }
}

/* The grid nearest to `grid` that is not taken, -1 if all are. */
static int64_t find_nearest(const ritz_joint_end end[static 2], int64_t grid,
                            int64_t count, const int64_t *first,
                            const bool *taken)
{
    int64_t near = -1;

    for (int64_t j = 0; j < count; j++)
        if (!taken[j] &&
            (near < 0 || ritz_joint_distance(end, grid, first[j]) <
                             ritz_joint_distance(end, grid, first[near])))
            near = j;
    return near;
}

ritz_status ritz_joint_pair(const ritz_joint *joint,
                            const ritz_joint_end end[static 2],
                            ritz_relations *list)
{
    ritz_status status = RITZ_OK;
    double tolerance = ritz_joint_tolerance(joint, &end[0]);
    int64_t *first[2] = {NULL, NULL};
    bool *taken = NULL;
    int64_t count[2];

    for (int k = 0; k < 2; k++) {
        RITZ_NEW(first[k], end[k].count);
        count[k] = list_grids(&end[k], first[k]);
    }
    RITZ_FAIL_IF(count[0] != count[1], RITZ_ERR_ARGUMENT,
                 "'%s/%s' has %" PRId64 " grids and '%s/%s' has %" PRId64,
                 end[0].component, end[0].port, count[0], end[1].component,
                 end[1].port, count[1]);
    RITZ_NEW(taken, count[1]);
    for (int64_t k = 0; k < count[0]; k++) {
        int64_t a = first[0][k];
        int64_t near = find_nearest(end, a, count[1], first[1], taken);
        int64_t b = first[1][near];

        RITZ_FAIL_IF(
            ritz_joint_distance(end, a, b) > tolerance, RITZ_ERR_ARGUMENT,
            "grid %" PRId64 " of '%s/%s' has no partner: the nearest, grid "
            "%" PRId64 " of '%s/%s', lies %.3g away, %.3g is let pass",
            end[0].dof[a].grid, end[0].component, end[0].port,
            end[1].dof[b].grid, end[1].component, end[1].port,
            ritz_joint_distance(end, a, b), tolerance);
        taken[near] = true;
        pair_grids(end, a, b, list);
    }
done:
    free(first[0]);
    free(first[1]);
    free(taken);
    return status;
}
