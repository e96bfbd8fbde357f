/*
 * What joints demand of the displacements u and rotations theta of two ports,
 * each along the basic axes of its own body. Components of a vector in the
 * second body's axes are turned into the first's by R = R(axis, angle):
 *
 *     fixed:  u_A = u_B,  theta_A = theta_B   for every pair of grids and every
 *             direction that both have; R = I
 *     hinge:  u_A = R u_B,  e_1'(theta_A - R theta_B) = 0,  the same with e_2,
 *             e_1 and e_2 normal to the axis
 */
#include "synthesis/joints.h"
#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void ritz_joint_rotation(const double axis[static 3], double setting,
                         double R[static 9])
{
    const double pi = 3.14159265358979323846;
    /* quarter turns are exact, so that 90 degrees swaps axes and no more */
    double quarter = fmod(setting, 90.0) == 0.0
                         ? fmod(fmod(setting / 90.0, 4.0) + 4.0, 4.0)
                         : -1.0;
    static const double sines[] = {0.0, 1.0, 0.0, -1.0, 0.0};
    double s = quarter >= 0.0 ? sines[(int)quarter] : sin(setting * pi / 180.0);
    double c =
        quarter >= 0.0 ? sines[(int)quarter + 1] : cos(setting * pi / 180.0);
    const double skew[9] = {0.0,      -axis[2], axis[1], axis[2], 0.0,
                            -axis[0], -axis[1], axis[0], 0.0};

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            R[3 * i + j] = (i == j ? c : 0.0) + s * skew[3 * i + j] +
                           (1.0 - c) * axis[i] * axis[j];
}

/* Two unit vectors normal to the axis and to each other. */
static void find_normals(const double axis[static 3], double e[2][3])
{
    int least = 0;
    double length = 0.0;
    double start[3] = {0.0, 0.0, 0.0};

    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) < fabs(axis[least]))
            least = i;
    start[least] = 1.0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        e[0][i] = axis[j] * start[k] - axis[k] * start[j];
        length += e[0][i] * e[0][i];
    }
    for (int i = 0; i < 3; i++)
        e[0][i] /= sqrt(length);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        e[1][i] = axis[j] * e[0][k] - axis[k] * e[0][j];
    }
}

/* Row of a direction of the grid that starts at port row `first`; -1 if none. */
static int64_t find_direction(const ritz_joint_end *end, int64_t first,
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

/* Distance of two grids, each measured from its port's origin. */
static double part(const ritz_joint_end end[static 2], int64_t a, int64_t b)
{
    double sum = 0.0;

    for (int i = 0; i < 3; i++) {
        double d = end[0].position[3 * a + i] - end[0].origin[i] -
                   (end[1].position[3 * b + i] - end[1].origin[i]);

        sum += d * d;
    }
    return sqrt(sum);
}

/* Largest distance of a port's grids from its origin. */
static double extent(const ritz_joint_end *end)
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
    return most;
}

/* Six equalities at most, of the directions that both grids have. */
static void pair_grids(const ritz_joint_end end[static 2], int64_t a, int64_t b,
                       ritz_constraints *list)
{
    for (int64_t direction = 1; direction <= 6; direction++) {
        int64_t i = find_direction(&end[0], a, direction);
        int64_t j = find_direction(&end[1], b, direction);

        if (i >= 0 && j >= 0)
            list->item[list->count++] = (ritz_constraint){
                .rotation = direction > 3,
                .num_terms = {1, 1},
                .row = {{i}, {j}},
                .factor = {{1.0}, {1.0}},
            };
    }
}

static ritz_status constrain_fixed(const ritz_joint *joint,
                                   const ritz_joint_end end[static 2],
                                   ritz_constraints *list)
{
    ritz_status status = RITZ_OK;
    double tolerance = joint->tolerance > 0.0 ? joint->tolerance
                                              : 1e-5 * extent(&end[0]) + 1e-12;
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
        int64_t near = -1;

        for (int64_t j = 0; j < count[1]; j++)
            if (!taken[j] &&
                (near < 0 || part(end, first[0][k], first[1][j]) <
                                 part(end, first[0][k], first[1][near])))
                near = j;
        RITZ_FAIL_IF(
            part(end, first[0][k], first[1][near]) > tolerance,
            RITZ_ERR_ARGUMENT,
            "grid %" PRId64 " of '%s/%s' has no partner: the nearest, grid "
            "%" PRId64 " of '%s/%s', lies %.3g away, %.3g is let pass",
            end[0].dof[first[0][k]].grid, end[0].component, end[0].port,
            end[1].dof[first[1][near]].grid, end[1].component, end[1].port,
            part(end, first[0][k], first[1][near]), tolerance);
        taken[near] = true;
        pair_grids(end, first[0][k], first[1][near], list);
    }
done:
    free(first[0]);
    free(first[1]);
    free(taken);
    return status;
}

/* Port rows of the six directions of a hinge's one grid. */
static ritz_status find_six(const ritz_joint_end *end, int64_t row[static 6])
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < 6; k++) {
        row[k] = end->count > 0 ? find_direction(end, 0, k + 1) : -1;
        RITZ_FAIL_IF(row[k] < 0 || end->count != 6, RITZ_ERR_ARGUMENT,
                     "a hinge holds one six-dof grid on each side, '%s/%s' "
                     "is not that",
                     end->component, end->port);
    }
done:
    return status;
}

/* sum_i e_i (v_A - R v_B)_i = 0, v the translations (0) or rotations (3). */
static ritz_constraint project(const double e[static 3],
                               const double R[static 9],
                               const int64_t row[2][6], int first)
{
    ritz_constraint c = {.rotation = first == 3, .num_terms = {3, 3}};

    for (int i = 0; i < 3; i++) {
        c.row[0][i] = row[0][first + i];
        c.row[1][i] = row[1][first + i];
        c.factor[0][i] = e[i];
        for (int k = 0; k < 3; k++)
            c.factor[1][i] += e[k] * R[3 * k + i];
    }
    return c;
}

static ritz_status constrain_hinge(const ritz_joint *joint,
                                   const ritz_joint_end end[static 2],
                                   double setting, ritz_constraints *list)
{
    ritz_status status = RITZ_OK;
    static const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double R[9];
    double e[2][3];
    int64_t row[2][6];

    RITZ_TRY(find_six(&end[0], row[0]));
    RITZ_TRY(find_six(&end[1], row[1]));
    ritz_joint_rotation(joint->axis, setting, R);
    find_normals(joint->axis, e);
    for (int i = 0; i < 3; i++)
        list->item[list->count++] = project(unit[i], R, row, 0);
    for (int i = 0; i < 2; i++)
        list->item[list->count++] = project(e[i], R, row, 3);
done:
    return status;
}

ritz_status ritz_joint_constrain(const ritz_joint *joint,
                                 const ritz_joint_end end[static 2],
                                 double setting, ritz_constraints *out)
{
    ritz_status status = RITZ_OK;
    ritz_constraints list = {0};

    RITZ_NEW(list.item, end[0].count + 6);
    switch (joint->type) {
    case RITZ_JOINT_FIXED:
        RITZ_TRY(constrain_fixed(joint, end, &list));
        break;
    case RITZ_JOINT_HINGE:
        RITZ_TRY(constrain_hinge(joint, end, setting, &list));
        break;
    }
    RITZ_FAIL_IF(list.count == 0, RITZ_ERR_ARGUMENT,
                 "its ports have no direction in common");
    *out = list;
    list = (ritz_constraints){0};
done:
    ritz_constraints_free(&list);
    if (status != RITZ_OK) {
        char what[RITZ_NAME_SIZE + 40];

        snprintf(what, sizeof what, "joint '%s'", joint->name);
        status = ritz_context(status, what);
    }
    return status;
}

void ritz_constraints_free(ritz_constraints *constraints)
{
    free(constraints->item);
    *constraints = (ritz_constraints){0};
}
