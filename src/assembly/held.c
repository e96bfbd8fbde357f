#include "assembly/held.h"

#include "base/alloc.h"

#include <ritz/container.h>

#include <stdlib.h>
#include <string.h>

/* Where held dof `dof` of a body comes among those held. */
static int64_t find_held(const ritz_dofs *held, int64_t dof)
{
    int64_t k = 0;

    while (held->at[k] != dof)
        k++;
    return k;
}

/* A port's rows from the held dofs alone. */
static ritz_status hold_port(const ritz_component *component,
                             const ritz_port *port, const ritz_dofs *held,
                             ritz_port_map *map)
{
    ritz_status status = RITZ_OK;
    ritz_dense turn = {0};

    memcpy(map->name, port->name, sizeof map->name);
    memcpy(map->origin, port->origin, sizeof map->origin);
    map->count = port->dofs.count;
    RITZ_TRY(ritz_port_turn(component, port, &turn, &map->dof));
    RITZ_NEW(map->position, 3 * map->count);
    for (int64_t i = 0; i < map->count; i++) {
        int64_t k = ritz_grids_find(&component->grids, map->dof[i].grid);

        if (k >= 0)
            memcpy(map->position + 3 * i, component->grids.position + 3 * k,
                   3 * sizeof *map->position);
    }
    RITZ_TRY(ritz_dense_new(map->count, held->count, &map->map));
    for (int64_t j = 0; j < map->count; j++)
        memcpy(ritz_dense_col(&map->map, find_held(held, port->dofs.at[j])),
               ritz_dense_col(&turn, j), (size_t)map->count * sizeof *turn.val);
done:
    ritz_dense_free(&turn);
    return status;
}

/* A body of which only the held dofs are seen. */
static ritz_status hold_body(const ritz_component *component,
                             const ritz_dofs *held, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced body = {.num_dofs = component->num_dofs};

    RITZ_TRY(ritz_dense_new(held->count, held->count, &body.K));
    RITZ_TRY(ritz_dense_new(held->count, held->count, &body.M));
    RITZ_NEW(body.port, component->num_ports);
    for (int64_t k = 0; k < component->num_ports; k++) {
        body.num_ports++;
        RITZ_TRY(
            hold_port(component, &component->port[k], held, &body.port[k]));
    }
    *out = body;
    body = (ritz_reduced){0};
done:
    ritz_reduced_free(&body);
    return status;
}

static ritz_status load_body(const char *model, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_summary summary = {0};

    RITZ_TRY(ritz_container_summary(model, &summary));
    RITZ_FAIL_IF(strcmp(summary.kind, "reduced") == 0, RITZ_ERR_ARGUMENT,
                 "'%s' is reduced already, its full model is wanted", model);
    RITZ_TRY(ritz_container_read_component(model, out));
done:
    ritz_summary_free(&summary);
    return status;
}

static ritz_status load(const ritz_scene *scene, ritz_held *p)
{
    p->scene = scene;
    RITZ_CHECK_NEW(p->body, scene->num_components);
    RITZ_CHECK_NEW(p->held, scene->num_components);
    RITZ_CHECK_NEW(p->first, scene->num_components);
    for (int64_t k = 0; k < scene->num_components; k++) {
        p->count++;
        p->first[k] = p->num_dofs;
        RITZ_CHECK_IN(scene->component[k].name,
                      load_body(scene->component[k].model, &p->body[k]));
        p->num_dofs += p->body[k].num_dofs;
        RITZ_CHECK(ritz_component_attached(&p->body[k], NULL, &p->held[k]));
    }
    return RITZ_OK;
}

/* The stage of held dofs, and where its coordinates are among all. */
static ritz_status hold(ritz_held *p)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, p->count);
    for (int64_t k = 0; k < p->count; k++)
        RITZ_TRY_IN(p->scene->component[k].name,
                    hold_body(&p->body[k], &p->held[k], &body[k]));
    RITZ_TRY(ritz_stage_from(p->scene, body, &p->stage));
    RITZ_NEW(p->row, p->stage.num_coordinates);
    for (int64_t k = 0; k < p->count; k++)
        for (int64_t j = 0; j < p->held[k].count; j++)
            p->row[p->stage.first[k] + j] = p->first[k] + p->held[k].at[j];
done:
    for (int64_t k = 0; body && k < p->count; k++)
        ritz_reduced_free(&body[k]);
    free(body);
    return status;
}

ritz_status ritz_held_load(const ritz_scene *scene, ritz_held *out)
{
    ritz_status status = RITZ_OK;
    ritz_held held = {0};

    RITZ_TRY(load(scene, &held));
    RITZ_TRY(hold(&held));
    *out = held;
    held = (ritz_held){0};
done:
    ritz_held_free(&held);
    return status;
}

void ritz_held_free(ritz_held *p)
{
    for (int64_t k = 0; k < p->count; k++) {
        if (p->body)
            ritz_component_free(&p->body[k]);
        if (p->held)
            ritz_dofs_free(&p->held[k]);
    }
    free(p->body);
    free(p->held);
    free(p->first);
    free(p->row);
    ritz_stage_free(&p->stage);
}
