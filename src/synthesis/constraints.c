/*
 * The rows of C q = 0. Coordinates are scaled to unit mass and the rows of one
 * joint and kind by the largest among them, so that rounding stays small beside
 * what is a constraint.
 */
#include "base/alloc.h"
#include "synthesis/joints.h"
#include "synthesis/placement.h"

#include <ritz/synthesis.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static ritz_joint_end describe_end(const ritz_stage *stage,
                                   const ritz_scene_place *place,
                                   const ritz_port_map *port)
{
    return (ritz_joint_end){
        .component = stage->scene->component[place->component].name,
        .port = port->name,
        .origin = port->origin,
        .count = port->count,
        .dof = port->dof,
        .position = port->position,
    };
}

/* The ports that a joint holds. */
static ritz_status find_ports(const ritz_stage *stage, const ritz_joint *joint,
                              const ritz_port_map *port[2])
{
    for (int k = 0; k < 2; k++) {
        port[k] = ritz_reduced_port(&stage->body[joint->between[k].component],
                                    joint->between[k].port);
        if (!port[k])
            return ritz_scene_context(stage->scene, RITZ_ERR_ARGUMENT,
                                      joint->line, joint->column, "joint",
                                      joint->name);
    }
    return RITZ_OK;
}

/* Row of C, in scaled coordinates: ends of opposite sign. */
static void fill_row(const ritz_stage *stage, const ritz_joint *joint,
                     const ritz_port_map *const port[2],
                     const ritz_constraint *c, const double *scale, int64_t row,
                     ritz_dense *C)
{
    for (int end = 0; end < 2; end++) {
        int64_t first = stage->first[joint->between[end].component];
        const ritz_dense *map = &port[end]->map;

        for (int64_t j = 0; j < map->ncol; j++) {
            double sum = 0.0;

            for (int64_t k = 0; k < c->num_terms[end]; k++)
                sum +=
                    c->factor[end][k] * ritz_dense_col(map, j)[c->row[end][k]];
            ritz_dense_col(C, first + j)[row] +=
                (end == 0 ? sum : -sum) * scale[first + j];
        }
    }
}

static double row_norm(const ritz_dense *C, int64_t row)
{
    double sum = 0.0;

    for (int64_t j = 0; j < C->ncol; j++) {
        double x = ritz_dense_col(C, j)[row];

        sum += x * x;
    }
    return sqrt(sum);
}

/* Divide the rows of each kind by the largest norm among them. */
static void level(const ritz_constraints *list, int64_t first, ritz_dense *C)
{
    double most[2] = {0.0, 0.0};

    for (int64_t k = 0; k < list->count; k++) {
        int kind = list->item[k].rotation;

        most[kind] = fmax(most[kind], row_norm(C, first + k));
    }
    for (int64_t k = 0; k < list->count; k++)
        for (int64_t j = 0; j < C->ncol; j++)
            if (most[list->item[k].rotation] > 0.0)
                ritz_dense_col(C, j)[first + k] /= most[list->item[k].rotation];
}

/* The constraints of every joint, and how many there are. */
static ritz_status list_all(const ritz_stage *stage, const double *setting,
                            ritz_constraints *list, int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    int64_t hinge = 0;

    *count = 0;
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j];
        const ritz_port_map *port[2] = {NULL, NULL};
        ritz_joint_end end[2];
        bool turns = joint->type == RITZ_JOINT_HINGE;

        RITZ_TRY(find_ports(stage, joint, port));
        for (int k = 0; k < 2; k++)
            end[k] = describe_end(stage, &joint->between[k], port[k]);
        RITZ_TRY(ritz_joint_constrain(joint, end, turns ? setting[hinge] : 0.0,
                                      &list[j]));
        hinge += turns;
        *count += list[j].count;
    }
done:
    return status;
}

ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_constraints *list = NULL;
    ritz_dense C = {0};
    int64_t count = 0;
    int64_t first = 0;

    RITZ_NEW(list, scene->num_joints);
    RITZ_TRY(ritz_place_check(stage, setting));
    RITZ_TRY(list_all(stage, setting, list, &count));
    RITZ_TRY(ritz_dense_new(count, stage->num_coordinates, &C));
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_port_map *port[2] = {NULL, NULL};

        RITZ_TRY(find_ports(stage, &scene->joint[j], port));
        for (int64_t k = 0; k < list[j].count; k++)
            fill_row(stage, &scene->joint[j], port, &list[j].item[k], scale,
                     first + k, &C);
        level(&list[j], first, &C);
        first += list[j].count;
    }
    *out = C;
    C = (ritz_dense){0};
done:
    for (int64_t j = 0; list && j < scene->num_joints; j++)
        ritz_constraints_free(&list[j]);
    free(list);
    ritz_dense_free(&C);
    return status;
}
