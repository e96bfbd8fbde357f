/* A scene's models, loaded and reduced: the bodies that are assembled. */
#include "assembly/assembly.h"

#include "base/alloc.h"

#include <ritz/base.h>
#include <ritz/basis.h>
#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Append a port's name to a list with commas, once. */
static ritz_status append_port(char **list, const char *port)
{
    size_t used = *list ? strlen(*list) : 0;
    size_t length = strlen(port);
    char *longer = NULL;

    for (const char *at = *list; at && *at;) {
        size_t word = strcspn(at, ",");

        if (word == length && strncmp(at, port, length) == 0)
            return RITZ_OK;
        at += word + (at[word] != '\0');
    }
    RITZ_CHECK_NEW(longer, (int64_t)(used + length + 2));
    snprintf(longer, used + length + 2, "%s%s%s", used ? *list : "",
             used ? "," : "", port);
    free(*list);
    *list = longer;
    return RITZ_OK;
}

/* A place at which a joint, an input or an output names a port. */
typedef struct port_user {
    const ritz_scene_place *at;
    const char *kind, *name;
    int64_t line, column;
} port_user;

/* The t-th of them: joints, inputs, outputs; false: there are no more. */
static bool find_user(const ritz_scene *scene, int64_t t, port_user *out)
{
    const int64_t k = t / 2 - scene->num_joints, j = k - scene->num_inputs;
    const ritz_joint *joint = k < 0 ? &scene->joint[t / 2] : NULL;
    const ritz_scene_io *io = NULL;

    if (joint)
        *out = (port_user){&joint->between[t % 2], "joint", joint->name,
                           joint->line, joint->column};
    if (joint || j >= scene->num_outputs)
        return joint;
    io = j < 0 ? &scene->input[k] : &scene->output[j];
    *out =
        (port_user){t % 2 == 0 ? &io->at : &io->against,
                    j < 0 ? "input" : "output", io->name, io->line, io->column};
    return true;
}

/* The ports of body k that a joint or an input names. */
static ritz_status list_used_ports(const ritz_scene *scene, int64_t k,
                                   char **out)
{
    RITZ_OWN_ARRAY char *list = NULL;
    port_user user;

    RITZ_CHECK_NEW(list, 1);
    for (int64_t t = 0; t < 2 * (scene->num_joints + scene->num_inputs); t++)
        if (find_user(scene, t, &user) && user.at->component == k &&
            *user.at->port)
            RITZ_CHECK(append_port(&list, user.at->port));
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}

ritz_status ritz_stage_same_ports(const ritz_scene *scene, int64_t j, int64_t k,
                                  bool *same)
{
    const char *given[] = {scene->component[j].attach,
                           scene->component[k].attach};
    RITZ_OWN_ARRAY char *first = NULL, *second = NULL;

    RITZ_CHECK(list_used_ports(scene, j, &first));
    RITZ_CHECK(list_used_ports(scene, k, &second));
    *same =
        strcmp(given[0] ? given[0] : first, given[1] ? given[1] : second) == 0;
    return RITZ_OK;
}

ritz_status ritz_body_request_new(const ritz_scene *scene, int64_t k,
                                  const ritz_scene_component *item,
                                  const ritz_component *component,
                                  ritz_body_request *out)
{
    const ritz_method *method = ritz_method_find(item->basis);
    RITZ_OWN_ARRAY char *ports = NULL;
    ritz_request *request = &out->asked;

    if (!method)
        return RITZ_ERR_ARGUMENT;
    *request = (ritz_request)RITZ_REQUEST_NONE;
    request->component = component;
    request->modes = item->modes;
    request->up_to_hz = item->up_to_hz;
    request->choice = item->choice;
    if (!item->attach)
        RITZ_CHECK(list_used_ports(scene, k, &ports));
    RITZ_CHECK(ritz_component_attached(
        component, item->attach ? item->attach : ports, &out->attached));
    request->attached = out->attached;
    if (method->uses & RITZ_USES_NEIGHBOUR) {
        RITZ_CHECK(ritz_scene_neighbour(scene, k, component, &out->attached,
                                        &out->neighbour));
        request->neighbour = &out->neighbour;
    }
    return RITZ_OK;
}

void ritz_body_request_free(ritz_body_request *request)
{
    ritz_dofs_free(&request->attached);
    ritz_neighbour_free(&request->neighbour);
}

ritz_status ritz_stage_reduce(const ritz_scene *scene, int64_t k,
                              const ritz_scene_component *item,
                              const ritz_component *component,
                              ritz_reduced *out)
{
    RITZ_OWN(ritz_body_request) own = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_body_request_new(scene, k, item, component, &own));
    RITZ_CHECK(
        ritz_basis_make(ritz_method_find(item->basis), &own.asked, &basis));
    return ritz_reduce(component, &basis, out);
}

/* Check that the ports exist that joints, inputs and outputs name. */
static ritz_status check_ports(const ritz_scene *scene, int64_t k,
                               const ritz_component *component)
{
    port_user user;

    for (int64_t t = 0; find_user(scene, t, &user); t++)
        if (user.at->component == k && *user.at->port &&
            !ritz_component_port(component, user.at->port))
            return ritz_scene_context(scene, RITZ_ERR_ARGUMENT, user.line,
                                      user.column, user.kind, user.name);
    return RITZ_OK;
}

/* Check the dofs of the full or the reduced model. A reduced model without its
   basis has no dofs; its ports are checked by check_planes. */
static ritz_status check_plane(const ritz_scene *scene,
                               const ritz_component *full,
                               const ritz_reduced *reduced)
{
    if (full->num_dofs > 0)
        return ritz_plane_check_dofs(scene->plane, full->num_dofs, full->dof,
                                     &full->grids);
    return reduced->dof ? ritz_plane_check_dofs(scene->plane, reduced->num_dofs,
                                                reduced->dof, &reduced->grids)
                        : RITZ_OK;
}

/* The model of a component of the scene: full, or reduced to as many columns as
   the scene takes. */
static ritz_status load_model(const ritz_source *source,
                              const ritz_scene_component *item,
                              ritz_component *full, ritz_reduced *reduced)
{
    RITZ_OWN(ritz_reduced) whole = {0};
    char kind[RITZ_NAME_SIZE];

    RITZ_CHECK(source->kind(source->state, item->model, kind));
    if (strcmp(kind, "reduced") != 0) {
        RITZ_REFUSE_IF(!item->basis[0], RITZ_ERR_ARGUMENT,
                       "'%s' is a full model, so a basis is due", item->model);
        return source->component(source->state, item->model, full);
    }
    RITZ_REFUSE_IF(item->basis[0], RITZ_ERR_ARGUMENT,
                   "'%s' is reduced already, so it takes no basis",
                   item->model);
    RITZ_CHECK(source->reduced(source->state, item->model, &whole));
    if (item->order > 0)
        return ritz_context(ritz_reduced_prefix(&whole, item->order, reduced),
                            item->model);
    RITZ_MOVE(*reduced, whole);
    return RITZ_OK;
}

ritz_status ritz_stage_load(const ritz_scene *scene, int64_t k,
                            ritz_component *full, ritz_reduced *reduced)
{
    const ritz_scene_component *item = &scene->component[k];
    RITZ_OWN(ritz_component) component = {0};

    RITZ_CHECK(ritz_scene_context(
        scene, load_model(scene->source, item, &component, reduced), item->line,
        item->column, "component", item->name));
    RITZ_CHECK(
        ritz_scene_context(scene, check_plane(scene, &component, reduced),
                           item->line, item->column, "component", item->name));
    if (component.num_dofs > 0)
        RITZ_CHECK(check_ports(scene, k, &component));
    RITZ_MOVE(*full, component);
    return RITZ_OK;
}

static ritz_status load_body(const ritz_scene *scene, int64_t k,
                             ritz_reduced *out)
{
    const ritz_scene_component *item = &scene->component[k];
    RITZ_OWN(ritz_component) component = {0};

    RITZ_CHECK(ritz_stage_load(scene, k, &component, out));
    if (component.num_dofs == 0)
        return RITZ_OK;
    return ritz_scene_context(
        scene, ritz_stage_reduce(scene, k, item, &component, out), item->line,
        item->column, "component", item->name);
}

/*
 * The port whose row an input or output of the scene names; NULL and a message
 * if there is none, or more than one.
 */
static const ritz_port_map *find_row(const ritz_scene_io *io,
                                     const ritz_reduced *body, int64_t *row)
{
    const ritz_port_map *port = ritz_reduced_port(body, io->at.port);
    int64_t matches = 0;

    for (int64_t k = 0; port && k < port->count; k++)
        if (port->dof[k].component == io->component &&
            (io->grid == 0 || port->dof[k].grid == io->grid)) {
            *row = k;
            matches++;
        }
    if (!port || matches == 1)
        return port;
    if (matches == 0)
        ritz_record("port '%s' has no direction %" PRId64 "%s", port->name,
                    io->component, io->grid ? " at that grid" : "");
    else
        ritz_record("port '%s' has %" PRId64 " grids with direction %" PRId64
                    ": name one with 'grid'",
                    port->name, matches, io->component);
    return NULL;
}

/* Add a unit force in one direction at a port, times `sign` and its scale. */
static ritz_status add_force(ritz_stage *stage, int64_t j,
                             const ritz_scene_place *at, int64_t direction,
                             double sign)
{
    const ritz_scene_io *input = &stage->scene->input[j];
    ritz_scene_io one = *input;
    double *b = ritz_dense_col(&stage->io.B, j) + stage->first[at->component];
    const ritz_port_map *port = NULL;
    int64_t row = 0;

    one.at = *at;
    one.component = direction;
    if (sign < 0.0)
        one.grid = 0; /* which is of the port that it acts at */
    port = find_row(&one, &stage->body[at->component], &row);
    if (!port)
        return ritz_scene_context(stage->scene, RITZ_ERR_ARGUMENT, input->line,
                                  input->column, "input", input->name);
    for (int64_t i = 0; i < port->map.ncol; i++)
        b[i] += sign * input->scale * ritz_dense_col(&port->map, i)[row];
    return RITZ_OK;
}

static ritz_status set_input(ritz_stage *stage, int64_t j)
{
    const ritz_scene_io *input = &stage->scene->input[j];

    memcpy(stage->io.input[j], input->name, RITZ_NAME_SIZE);
    for (int64_t d = 0; d <= input->num_also; d++) {
        int64_t direction = d == 0 ? input->component : input->also[d - 1];

        RITZ_CHECK(add_force(stage, j, &input->at, direction, 1.0));
        if (*input->against.port)
            RITZ_CHECK(add_force(stage, j, &input->against, direction, -1.0));
    }
    return RITZ_OK;
}

static ritz_status set_output(ritz_stage *stage, int64_t j)
{
    const ritz_scene_io *output = &stage->scene->output[j];
    ritz_dense *const into[] = {&stage->io.C, &stage->io.Cv, &stage->io.Ca};
    int64_t k = output->at.component;
    int64_t row = 0;
    const ritz_port_map *port = find_row(output, &stage->body[k], &row);

    if (!port)
        return ritz_scene_context(stage->scene, RITZ_ERR_ARGUMENT, output->line,
                                  output->column, "output", output->name);
    memcpy(stage->io.output[j], output->name, RITZ_NAME_SIZE);
    stage->io.limit[j] = output->limit;
    for (int64_t i = 0; i < port->map.ncol; i++)
        ritz_dense_col(into[output->derivative], stage->first[k] + i)[j] =
            ritz_dense_col(&port->map, i)[row];
    return RITZ_OK;
}

static void set_scale(ritz_stage *stage)
{
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];

        for (int64_t j = 0; j < body->K.ncol; j++) {
            double m = ritz_dense_col(&body->M, j)[j];
            double own = m > 0.0 ? m : ritz_dense_col(&body->K, j)[j];

            stage->scale[stage->first[k] + j] =
                own > 0.0 ? 1.0 / sqrt(own) : 1.0;
        }
    }
}

/*
 * Bodies are assembled with their dampers installed; the influence vectors are
 * kept, so that dampers of the system can be changed. This step is last, so
 * that an earlier failure leaves the bodies as they were.
 */
static ritz_status install_dampers(ritz_stage *stage)
{
    for (int64_t k = 0; k < stage->count; k++)
        RITZ_CHECK(ritz_dampers_append(
            &stage->body[k].dampers, stage->scene->component[k].name,
            stage->num_coordinates, stage->first[k], &stage->dampers));
    for (int64_t k = 0; k < stage->count; k++)
        RITZ_CHECK(ritz_reduced_install(&stage->body[k]));
    for (int64_t j = 0; j < stage->dampers.count; j++) {
        stage->dampers.held_c[j] = stage->dampers.c[j];
        stage->dampers.held_k[j] = stage->dampers.k[j];
    }
    set_scale(stage);
    return RITZ_OK;
}

/* Check the ports of all bodies, which also covers bodies whose models were not
   loaded here. */
static ritz_status check_planes(const ritz_stage *stage)
{
    const ritz_scene *scene = stage->scene;

    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t p = 0; p < stage->body[k].num_ports; p++)
            RITZ_CHECK(ritz_scene_context(
                scene,
                ritz_plane_check_port(scene->plane, &stage->body[k].port[p]),
                scene->component[k].line, scene->component[k].column,
                "component", scene->component[k].name));
    return RITZ_OK;
}

/* Count coordinates and set up the scene's inputs and outputs. */
static ritz_status complete_stage(ritz_stage *stage)
{
    const ritz_scene *scene = stage->scene;

    RITZ_CHECK(check_planes(stage));
    RITZ_CHECK_NEW(stage->first, stage->count);
    for (int64_t k = 0; k < stage->count; k++) {
        stage->first[k] = stage->num_coordinates;
        stage->num_coordinates += stage->body[k].K.ncol;
    }
    RITZ_CHECK_NEW(stage->scale, stage->num_coordinates);
    RITZ_CHECK(ritz_io_new(stage->num_coordinates, scene->num_inputs,
                           scene->num_outputs, &stage->io));
    for (int64_t j = 0; j < scene->num_inputs; j++)
        RITZ_CHECK(set_input(stage, j));
    for (int64_t j = 0; j < scene->num_outputs; j++)
        RITZ_CHECK(set_output(stage, j));
    return install_dampers(stage);
}

ritz_status ritz_stage_new(const ritz_scene *scene, ritz_stage *out)
{
    RITZ_OWN(ritz_bodies) body = {0};

    RITZ_CHECK(ritz_bodies_new(scene->num_components, &body));
    for (int64_t k = 0; k < body.count; k++) {
        ritz_monitor_step("component", k, body.count);
        RITZ_CHECK(load_body(scene, k, &body.item[k]));
    }
    return ritz_stage_from(scene, body.item, out);
}

ritz_status ritz_stage_from(const ritz_scene *scene, ritz_reduced *body,
                            ritz_stage *out)
{
    const size_t bytes = (size_t)scene->num_components * sizeof *body;
    RITZ_OWN(ritz_stage) stage = {.scene = scene};
    ritz_status status = RITZ_OK;

    RITZ_CHECK_NEW(stage.body, scene->num_components);
    stage.count = scene->num_components;
    memcpy(stage.body, body, bytes);
    status = complete_stage(&stage);
    if (status == RITZ_OK) {
        memset(body, 0, bytes);
        RITZ_MOVE(*out, stage);
    } else { /* return the bodies to the caller */
        memcpy(body, stage.body, bytes);
        memset(stage.body, 0, bytes);
    }
    return status;
}

ritz_status ritz_bodies_new(int64_t count, ritz_bodies *out)
{
    RITZ_CHECK_NEW(out->item, count);
    out->count = count;
    return RITZ_OK;
}

void ritz_bodies_free(ritz_bodies *bodies)
{
    RITZ_FREE_EACH(ritz_reduced, bodies->count, bodies->item);
    *bodies = (ritz_bodies){0};
}

void ritz_stage_free(ritz_stage *stage)
{
    RITZ_FREE_EACH(ritz_reduced, stage->count, stage->body);
    RITZ_FREE(stage->first, stage->scale);
    ritz_io_free(&stage->io);
    ritz_dampers_free(&stage->dampers);
    *stage = (ritz_stage){0};
}

ritz_status ritz_body_load_name(const char *body, const char *load,
                                char out[RITZ_NAME_SIZE])
{
    const int length = snprintf(out, RITZ_NAME_SIZE, "%s:%s", body, load);

    RITZ_REFUSE_IF(length >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "'%s:%s' is longer than %d characters", body, load,
                   RITZ_NAME_SIZE - 1);
    return RITZ_OK;
}
