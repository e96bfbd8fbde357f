/*
 * The rows of C q = 0, all that joints lock, and those of S, S q being how far
 * the springs of joints are stretched. In C coordinates are scaled to unit mass
 * and the rows of one joint and kind by the largest among them, so that
 * rounding stays small beside what is a constraint.
 */
#include "assembly/joints.h"
#include "assembly/placement.h"
#include "assembly/springs.h"
#include "base/alloc.h"

#include <ritz/synthesis.h>

#include <math.h>
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

/* A relation as a row over all coordinates, each times its scale. */
static void fill_row(const ritz_stage *stage, const ritz_joint *joint,
                     const ritz_port_map *const port[2], const ritz_relation *r,
                     const double *scale, int64_t row, ritz_dense *C)
{
    for (int end = 0; end < 2; end++) {
        int64_t first = stage->first[joint->between[end].component];
        const ritz_dense *map = &port[end]->map;

        for (int64_t j = 0; j < map->ncol; j++) {
            double sum = 0.0;

            for (int64_t k = 0; k < r->num_terms[end]; k++)
                sum +=
                    r->factor[end][k] * ritz_dense_col(map, j)[r->row[end][k]];
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

/* Divide `count` rows of each kind by the largest norm among them. */
static void level(const bool *rotation, int64_t first, int64_t count,
                  ritz_dense *C)
{
    double most[2] = {0.0, 0.0};

    for (int64_t k = first; k < first + count; k++)
        most[rotation[k]] = fmax(most[rotation[k]], row_norm(C, k));
    for (int64_t k = first; k < first + count; k++)
        for (int64_t j = 0; j < C->ncol; j++)
            if (most[rotation[k]] > 0.0)
                ritz_dense_col(C, j)[k] /= most[rotation[k]];
}

/* The relations of every joint at some settings. */
static ritz_status relate_all(const ritz_stage *stage, const double *setting,
                              ritz_relations *list)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_joint_pose *pose = NULL;

    RITZ_NEW(pose, scene->num_joints);
    RITZ_TRY(ritz_place_joints(stage, setting, pose));
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j];
        const ritz_port_map *port[2] = {NULL, NULL};
        ritz_joint_end end[2];

        RITZ_TRY(find_ports(stage, joint, port));
        for (int k = 0; k < 2; k++)
            end[k] = describe_end(stage, &joint->between[k], port[k]);
        RITZ_TRY(ritz_joint_relate(joint, end, &pose[j], &list[j]));
    }
done:
    free(pose);
    return status;
}

static int64_t count_state(const ritz_relations *list, ritz_freedom_state state)
{
    int64_t count = 0;

    for (int64_t k = 0; k < list->count; k++)
        count += list->item[k].freedom.state == state;
    return count;
}

/* Relations of one state of all joints, as rows of a matrix. */
typedef struct rows {
    ritz_dense C;
    int64_t *of_joint; /* how many rows are of each joint */
    bool *rotation;    /* what each row is */
    ritz_freedom *freedom;
} rows;

static void free_rows(rows *r)
{
    ritz_dense_free(&r->C);
    free(r->of_joint);
    free(r->rotation);
    free(r->freedom);
    *r = (rows){0};
}

/* Room for the rows of one state. */
static ritz_status count_rows(const ritz_stage *stage,
                              const ritz_relations *list,
                              ritz_freedom_state state, rows *out)
{
    int64_t count = 0;

    RITZ_CHECK_NEW(out->of_joint, stage->scene->num_joints);
    for (int64_t j = 0; j < stage->scene->num_joints; j++) {
        out->of_joint[j] = count_state(&list[j], state);
        count += out->of_joint[j];
    }
    RITZ_CHECK_NEW(out->rotation, count);
    RITZ_CHECK_NEW(out->freedom, count);
    return ritz_dense_new(count, stage->num_coordinates, &out->C);
}

static ritz_status make_rows(const ritz_stage *stage, const double *setting,
                             ritz_freedom_state state, const double *scale,
                             rows *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_relations *list = NULL;
    int64_t row = 0;

    RITZ_NEW(list, scene->num_joints);
    RITZ_TRY(relate_all(stage, setting, list));
    RITZ_TRY(count_rows(stage, list, state, out));
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_port_map *port[2] = {NULL, NULL};

        RITZ_TRY(find_ports(stage, &scene->joint[j], port));
        for (int64_t k = 0; k < list[j].count; k++) {
            const ritz_relation *r = &list[j].item[k];

            if (r->freedom.state != state)
                continue;
            out->rotation[row] = r->rotation;
            out->freedom[row] = r->freedom;
            fill_row(stage, &scene->joint[j], port, r, scale, row++, &out->C);
        }
    }
done:
    for (int64_t j = 0; list && j < scene->num_joints; j++)
        ritz_relations_free(&list[j]);
    free(list);
    return status;
}

ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    rows r = {0};
    int64_t first = 0;

    RITZ_TRY(make_rows(stage, setting, RITZ_LOCKED, scale, &r));
    for (int64_t j = 0; j < stage->scene->num_joints; j++) {
        level(r.rotation, first, r.of_joint[j], &r.C);
        first += r.of_joint[j];
    }
    *out = r.C;
    r.C = (ritz_dense){0};
done:
    free_rows(&r);
    return status;
}

ritz_status ritz_stage_springs(const ritz_stage *stage, const double *setting,
                               ritz_springs *out)
{
    ritz_status status = RITZ_OK;
    rows r = {0};
    double *one = NULL;

    RITZ_NEW(one, stage->num_coordinates);
    for (int64_t j = 0; j < stage->num_coordinates; j++)
        one[j] = 1.0;
    RITZ_TRY(make_rows(stage, setting, RITZ_CAGED, one, &r));
    *out = (ritz_springs){.S = r.C, .hold = r.freedom};
    r.C = (ritz_dense){0};
    r.freedom = NULL;
done:
    free_rows(&r);
    free(one);
    return status;
}
