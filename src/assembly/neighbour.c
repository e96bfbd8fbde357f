/*
 * What hangs on a component: the body beyond a joint, condensed to its port by
 * Guyan's reduction, or, if it has no stiffness, its six rigid motions; both
 * are few coordinates q. link.c says how they follow the component's port.
 */
#include "assembly/neighbour.h"

#include "assembly/joints.h"
#include "base/alloc.h"

#include <ritz/container.h>

#include <stdlib.h>
#include <string.h>

/* The far body in few coordinates. */
static ritz_status condense(const ritz_component *far, const ritz_port *port,
                            ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_basis basis = {0};
    bool rigid =
        far->K.colptr[far->K.ncol] == 0 && port->dofs.count < far->num_dofs;

    request.component = far;
    if (!rigid)
        request.attached = port->dofs;
    RITZ_TRY(ritz_basis_make(rigid ? &ritz_method_rigid : &ritz_method_guyan,
                             &request, &basis));
    RITZ_TRY(ritz_reduce(far, &basis, out));
done:
    ritz_basis_free(&basis);
    return status;
}

/* The rows of a port: what they are and where; turn * dofs along basic axes. */
typedef struct near_port {
    ritz_dense turn;
    ritz_dof *dof;
    double *position;
} near_port;

static ritz_status look(const ritz_component *component, const ritz_port *port,
                        near_port *out)
{
    const ritz_grids *grids = &component->grids;

    RITZ_CHECK(ritz_port_turn(component, port, &out->turn, &out->dof));
    RITZ_CHECK_NEW(out->position, 3 * port->dofs.count);
    for (int64_t i = 0; i < port->dofs.count; i++) {
        int64_t k = ritz_grids_find(grids, out->dof[i].grid);

        if (k >= 0)
            memcpy(out->position + 3 * i, grids->position + 3 * k,
                   3 * sizeof *out->position);
    }
    return RITZ_OK;
}

/* Row k of a matrix += factor times row i of another. */
static void add_row(double factor, const ritz_dense *from, int64_t i,
                    ritz_dense *to, int64_t k)
{
    for (int64_t j = 0; j < from->ncol; j++)
        ritz_dense_col(to, j)[k] += factor * ritz_dense_col(from, j)[i];
}

/* F and G of the joint's relations. */
static ritz_status fill_rows(const ritz_relations *list, int near,
                             const ritz_dense *turn, const ritz_dense *map,
                             ritz_link *out)
{
    int far = 1 - near;

    out->count = list->count;
    RITZ_CHECK_NEW(out->freedom, list->count);
    RITZ_CHECK(ritz_dense_new(list->count, map->ncol, &out->F));
    RITZ_CHECK(ritz_dense_new(list->count, turn->ncol, &out->G));
    for (int64_t k = 0; k < list->count; k++) {
        const ritz_relation *r = &list->item[k];

        out->freedom[k] = r->freedom;
        for (int64_t t = 0; t < r->num_terms[far]; t++)
            add_row(r->factor[far][t], map, r->row[far][t], &out->F, k);
        for (int64_t t = 0; t < r->num_terms[near]; t++)
            add_row(r->factor[near][t], turn, r->row[near][t], &out->G, k);
    }
    return RITZ_OK;
}

static ritz_status relate(const ritz_joint *joint, const double *setting,
                          const ritz_joined side[2], int near,
                          const ritz_reduced *far, ritz_link *out)
{
    ritz_status status = RITZ_OK;
    const char *name = joint->between[near].port;
    const ritz_port *port = ritz_component_port(side[near].component, name);
    const ritz_port_map *map =
        ritz_reduced_port(far, joint->between[1 - near].port);
    ritz_joint_pose pose;
    ritz_joint_end end[2];
    ritz_relations list = {0};
    near_port at = {0};

    if (!port || !map)
        return RITZ_ERR_ARGUMENT;
    RITZ_TRY(look(side[near].component, port, &at));
    end[near] = (ritz_joint_end){side[near].name,  name,   port->origin,
                                 port->dofs.count, at.dof, at.position};
    end[1 - near] =
        (ritz_joint_end){side[1 - near].name, map->name, map->origin,
                         map->count,          map->dof,  map->position};
    ritz_joint_pose_at(joint, setting, &pose);
    RITZ_TRY(ritz_joint_relate(joint, end, &pose, &list));
    RITZ_TRY(fill_rows(&list, near, &at.turn, &map->map, out));
done:
    ritz_relations_free(&list);
    ritz_dense_free(&at.turn);
    free(at.dof);
    free(at.position);
    return status;
}

/* Where a port's dofs are among the attached ones. */
static ritz_status locate(const ritz_component *component,
                          const ritz_port *port, const ritz_dofs *attached,
                          int64_t *at)
{
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t j = 0; j < port->dofs.count; j++) {
        at[j] = -1;
        for (int64_t i = 0; i < attached->count; i++)
            if (attached->at[i] == port->dofs.at[j])
                at[j] = i;
        RITZ_REFUSE_IF(
            at[j] < 0, RITZ_ERR_ARGUMENT,
            "%s of port '%s' is not attached, so nothing can hang on "
            "it",
            ritz_dof_name(component->dof[port->dofs.at[j]], name), port->name);
    }
    return RITZ_OK;
}

/* sum(at, at) += A. */
static void scatter(const ritz_dense *A, const int64_t *at, ritz_dense *sum)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(sum, at[j])[at[i]] += ritz_dense_col(A, j)[i];
}

ritz_status ritz_joint_neighbour(const ritz_joint *joint, const double *setting,
                                 const ritz_joined side[static 2], int near,
                                 const ritz_dofs *attached, ritz_neighbour *sum)
{
    ritz_status status = RITZ_OK;
    const ritz_port *port =
        ritz_component_port(side[near].component, joint->between[near].port);
    const ritz_port *other =
        port ? ritz_component_port(side[1 - near].component,
                                   joint->between[1 - near].port)
             : NULL;
    ritz_reduced far = {0};
    ritz_link link = {0};
    ritz_dense K = {0}, M = {0};
    int64_t *at = NULL;

    if (!other)
        return ritz_context(RITZ_ERR_ARGUMENT,
                            side[port ? 1 - near : near].name);
    RITZ_NEW(at, port->dofs.count);
    RITZ_TRY(locate(side[near].component, port, attached, at));
    RITZ_TRY_IN(side[1 - near].name,
                condense(side[1 - near].component, other, &far));
    RITZ_TRY(relate(joint, setting, side, near, &far, &link));
    RITZ_TRY(ritz_link_condense(&far, &link, &K, &M));
    scatter(&K, at, &sum->K);
    scatter(&M, at, &sum->M);
done:
    free(at);
    ritz_reduced_free(&far);
    ritz_link_free(&link);
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    return status;
}

ritz_status ritz_neighbour_new(int64_t attached, ritz_neighbour *out)
{
    ritz_status status = RITZ_OK;
    ritz_neighbour neighbour = {0};

    RITZ_TRY(ritz_dense_new(attached, attached, &neighbour.K));
    RITZ_TRY(ritz_dense_new(attached, attached, &neighbour.M));
    *out = neighbour;
    neighbour = (ritz_neighbour){0};
done:
    ritz_neighbour_free(&neighbour);
    return status;
}

void ritz_neighbour_free(ritz_neighbour *neighbour)
{
    ritz_dense_free(&neighbour->K);
    ritz_dense_free(&neighbour->M);
    *neighbour = (ritz_neighbour){0};
}

/* The full model of the body beyond a joint. */
static ritz_status read_body(const ritz_scene_component *item,
                             ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};

    RITZ_TRY(ritz_container_summary(item->model, &summary));
    RITZ_FAIL_IF(strcmp(summary.kind, "component") != 0, RITZ_ERR_ARGUMENT,
                 "its neighbour '%s' is not there as a full model, of which "
                 "loaded-interface needs mass and stiffness",
                 item->name);
    RITZ_TRY(ritz_container_read_component(item->model, out));
done:
    ritz_summary_free(&summary);
    return status;
}

/* What one joint hangs on component k at the end `near`. */
static ritz_status add_joint(const ritz_scene *scene, const ritz_joint *joint,
                             int near, const ritz_component *component,
                             const ritz_dofs *attached, ritz_neighbour *sum)
{
    ritz_status status = RITZ_OK;
    int64_t k = joint->between[near].component;
    int64_t other = joint->between[1 - near].component;
    ritz_component far = {0};
    ritz_joined side[2];

    RITZ_TRY(read_body(&scene->component[other], &far));
    side[near] = (ritz_joined){scene->component[k].name, component};
    side[1 - near] = (ritz_joined){scene->component[other].name, &far};
    RITZ_TRY(
        ritz_joint_neighbour(joint, scene->setting, side, near, attached, sum));
done:
    ritz_component_free(&far);
    return status;
}

ritz_status ritz_scene_neighbour(const ritz_scene *scene, int64_t k,
                                 const ritz_component *component,
                                 const ritz_dofs *attached, ritz_neighbour *out)
{
    ritz_status status = RITZ_OK;
    ritz_neighbour sum = {0};

    RITZ_TRY(ritz_neighbour_new(attached->count, &sum));
    for (int64_t j = 0; j < scene->num_joints; j++)
        for (int near = 0; near < 2; near++)
            if (scene->joint[j].between[near].component == k)
                RITZ_TRY(add_joint(scene, &scene->joint[j], near, component,
                                   attached, &sum));
    *out = sum;
    sum = (ritz_neighbour){0};
done:
    ritz_neighbour_free(&sum);
    return status;
}
