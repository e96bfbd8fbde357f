/*
 * The forces whose static solutions may be added to the composite set: inputs,
 * unit forces at dofs that joints hold, at points where outputs measure and at
 * dofs that the scene names, and forces along dampers. Each is a vector over
 * the coordinates of all bodies, except forces along dampers of joints, whose
 * directions depend on the configuration. With system augmentation these are
 * found at each configuration; with component augmentation they are replaced by
 * the dofs that such joints hold.
 */
#include "compare/compare.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Append a force. Its vector is zero, and returned to be filled; without @p
   vector it is a force along the damper of a joint. */
static ritz_status add_force(const ritz_stage *stage, int sets, bool named,
                             const char *name, ritz_unit_forces *forces,
                             double **vector)
{
    ritz_unit_force *force = NULL;

    RITZ_CHECK_ROOM(forces->each, forces->count, forces->room);
    force = &forces->each[forces->count++];
    *force = (ritz_unit_force){.sets = sets, .named = named};
    snprintf(force->name, sizeof force->name, "%s", name);
    if (!vector)
        return RITZ_OK;
    RITZ_CHECK_NEW(force->f, stage->num_coordinates);
    *vector = force->f;
    return RITZ_OK;
}

/* Append column j of B as a force. */
static ritz_status add_column(const ritz_stage *stage, int sets, bool named,
                              const char *name, const ritz_dense *B, int64_t j,
                              ritz_unit_forces *forces)
{
    double *f = NULL;

    RITZ_CHECK(add_force(stage, sets, named, name, forces, &f));
    memcpy(f, ritz_dense_col(B, j), (size_t)B->nrow * sizeof *f);
    return RITZ_OK;
}

/* Whether the scene attaches input, or output, @p j by name. */
static bool is_named(const ritz_scene *scene, bool input, int64_t j)
{
    for (int64_t k = 0; k < scene->num_attached_forces; k++) {
        const ritz_scene_force *force = &scene->attached_force[k];

        if ((input ? force->input : force->output) == j)
            return true;
    }
    return false;
}

static ritz_status add_inputs(const ritz_stage *stage, ritz_unit_forces *forces)
{
    for (int64_t j = 0; j < stage->io.num_inputs; j++)
        RITZ_CHECK(add_column(stage, RITZ_ATTACHED_INPUTS,
                              is_named(stage->scene, true, j),
                              stage->io.input[j], &stage->io.B, j, forces));
    return RITZ_OK;
}

/* A unit force at the point of each output, for displacements, velocities and
   accelerations alike. */
static ritz_status add_outputs(const ritz_stage *stage,
                               ritz_unit_forces *forces)
{
    const ritz_dense *const C[] = {&stage->io.C, &stage->io.Cv, &stage->io.Ca};

    for (int64_t j = 0; j < stage->io.num_outputs; j++) {
        double *f = NULL;

        RITZ_CHECK(add_force(stage, RITZ_ATTACHED_OUTPUTS,
                             is_named(stage->scene, false, j),
                             stage->io.output[j], forces, &f));
        for (int64_t q = 0; q < stage->num_coordinates; q++)
            for (int c = 0; c < 3; c++)
                f[q] += ritz_dense_col(C[c], q)[j];
    }
    return RITZ_OK;
}

/* Whether all dofs of a port belong to one grid. */
static bool has_one_grid(const ritz_port_map *port)
{
    for (int64_t i = 1; i < port->count; i++)
        if (port->dof[i].grid != port->dof[0].grid)
            return false;
    return true;
}

/* A unit force at one row of a port of body k. Its name is "rotor/boom:3", as
   in scenes, or "rotor/33:3" if the port has several grids. */
static ritz_status add_row(const ritz_stage *stage, int64_t k,
                           const ritz_port_map *port, int64_t row, int sets,
                           bool named, ritz_unit_forces *forces)
{
    const char *body = stage->scene->component[k].name;
    const ritz_dof dof = port->dof[row];
    char name[RITZ_FORCE_SIZE];
    double *f = NULL;

    if (has_one_grid(port))
        snprintf(name, sizeof name, "%s/%s:%" PRId64, body, port->name,
                 dof.component);
    else
        snprintf(name, sizeof name, "%s/%" PRId64 ":%" PRId64, body, dof.grid,
                 dof.component);
    RITZ_CHECK(add_force(stage, sets, named, name, forces, &f));
    for (int64_t q = 0; q < port->map.ncol; q++)
        f[stage->first[k] + q] = ritz_dense_col(&port->map, q)[row];
    return RITZ_OK;
}

/* Whether one of the joint's springs has a damper. */
static bool has_damper(const ritz_joint *joint)
{
    for (int64_t k = 0; k < joint->num_freedoms; k++)
        if (joint->freedom[k].state == RITZ_CAGED &&
            joint->freedom[k].damping > 0.0)
            return true;
    return false;
}

bool ritz_stage_is_damped(const ritz_stage *stage)
{
    bool damped = stage->dampers.count > 0;

    for (int64_t j = 0; j < stage->scene->num_joints; j++)
        damped = damped || has_damper(&stage->scene->joint[j]);
    return damped;
}

/* The sets that the dofs of a port of body k belong to: the interface if a
   joint holds the port, and dampers if that joint has a damper and components
   are augmented. */
static int sets_of_port(const ritz_scene *scene, int64_t k, const char *port)
{
    int sets = 0;

    for (int64_t j = 0; j < scene->num_joints; j++)
        for (int end = 0; end < 2; end++) {
            const ritz_joint *joint = &scene->joint[j];
            const ritz_scene_place *at = &joint->between[end];

            if (at->component != k || strcmp(at->port, port) != 0)
                continue;
            sets |= RITZ_ATTACHED_INTERFACE;
            if (has_damper(joint) && scene->augment == RITZ_AUGMENT_COMPONENT)
                sets |= RITZ_ATTACHED_DAMPERS;
        }
    return sets;
}

/* Each dof of the ports that joints hold or, without @p held, of the other
   ports. */
static ritz_status add_ports(const ritz_stage *stage, bool held,
                             ritz_unit_forces *forces)
{
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t p = 0; p < stage->body[k].num_ports; p++) {
            const ritz_port_map *port = &stage->body[k].port[p];
            int sets = sets_of_port(stage->scene, k, port->name);

            if ((sets != 0) != held)
                continue;
            for (int64_t row = 0; row < port->count; row++)
                RITZ_CHECK(add_row(stage, k, port, row, sets, false, forces));
        }
    return RITZ_OK;
}

static ritz_status add_damper(const ritz_stage *stage, int64_t j, int sets,
                              bool named, ritz_unit_forces *forces)
{
    return add_column(stage, sets, named, stage->dampers.name[j],
                      &stage->dampers.B, j, forces);
}

/*
 * Forces along the dampers of joints, in the order of ritz_stage_springs. The
 * same joints have dampers at every configuration; in a plane a joint may have
 * fewer dampers than freedoms.
 */
static ritz_status add_joint_dampers(const ritz_stage *stage,
                                     ritz_unit_forces *forces)
{
    RITZ_OWN(ritz_springs) springs = {0};
    int64_t dampers = 0;

    RITZ_CHECK(ritz_stage_springs(stage, stage->scene->setting, &springs));
    for (int64_t k = 0; k < springs.of.count; k++) {
        const ritz_relation *of = &springs.of.item[k];
        char name[RITZ_FORCE_SIZE];

        if (!(of->freedom->damping > 0.0))
            continue;
        snprintf(name, sizeof name, "damper %d of %s",
                 (int)(of->freedom - of->joint->freedom) + 1, of->joint->name);
        RITZ_CHECK(
            add_force(stage, RITZ_ATTACHED_DAMPERS, false, name, forces, NULL));
        forces->each[forces->count - 1].spring = dampers++;
    }
    return RITZ_OK;
}

/* Forces along the dampers of bodies and, if @p of_joints, of joints. */
static ritz_status add_dampers(const ritz_stage *stage, bool of_joints,
                               ritz_unit_forces *forces)
{
    for (int64_t j = 0; j < stage->dampers.count; j++)
        RITZ_CHECK(add_damper(stage, j, RITZ_ATTACHED_DAMPERS, false, forces));
    return of_joints ? add_joint_dampers(stage, forces) : RITZ_OK;
}

/* The row of a port in a direction; a port with none, or with several, is
   refused. */
static ritz_status find_direction(const ritz_port_map *port, int64_t direction,
                                  int64_t *row)
{
    int64_t matches = 0;

    for (int64_t i = 0; i < port->count; i++)
        if (port->dof[i].component == direction) {
            *row = i;
            matches++;
        }
    RITZ_REFUSE_IF(matches == 0, RITZ_ERR_ARGUMENT,
                   "'%s' has no direction %" PRId64, port->name, direction);
    RITZ_REFUSE_IF(matches > 1, RITZ_ERR_ARGUMENT,
                   "port '%s' has %" PRId64 " grids with direction %" PRId64
                   ": name the grid in place of the port",
                   port->name, matches, direction);
    return RITZ_OK;
}

/* The motion of a grid of the full model, as if the grid were a port. */
static ritz_status map_grid(const ritz_reduced *body, int64_t grid,
                            ritz_port_map *out)
{
    /* borrowed; only read */
    const ritz_component full = {
        .num_dofs = body->num_dofs, .dof = body->dof, .grids = body->grids};
    ritz_port port = {0};
    RITZ_OWN(ritz_dofs) dofs = {0};
    RITZ_OWN(ritz_port_map) map = {0};

    RITZ_REFUSE_IF(!body->T.val || !body->dof, RITZ_ERR_ARGUMENT,
                   "only its ports are known of this component");
    RITZ_CHECK_NEW(dofs.at, body->num_dofs);
    for (int64_t i = 0; i < body->num_dofs; i++)
        if (body->dof[i].grid == grid)
            dofs.at[dofs.count++] = i;
    RITZ_REFUSE_IF(dofs.count == 0, RITZ_ERR_ARGUMENT,
                   "there is no port and no grid '%" PRId64 "'", grid);
    snprintf(port.name, sizeof port.name, "%" PRId64, grid);
    port.dofs = dofs;
    RITZ_CHECK(ritz_port_map_of(&full, &port, &body->T, &map));
    RITZ_MOVE(*out, map);
    return RITZ_OK;
}

/* Split "33:3" at its last colon into a place and a direction; false if the
   text does not end in a direction. */
static bool split_direction(const char *text, char place[RITZ_NAME_SIZE],
                            int64_t *direction)
{
    const char *colon = strrchr(text, ':');

    if (!colon || colon[1] < '0' || colon[1] > '6' || colon[2] != '\0')
        return false;
    *direction = colon[1] - '0';
    memcpy(place, text, (size_t)(colon - text));
    place[colon - text] = '\0';
    return true;
}

/* Whether @p at names a damper of a body, "rotor/strut". */
static bool is_damper(const ritz_stage *stage, const ritz_scene_place *at,
                      const char *damper)
{
    const char *body = stage->scene->component[at->component].name;
    size_t length = strlen(body);

    return strncmp(damper, body, length) == 0 && damper[length] == '/' &&
           strcmp(damper + length + 1, at->port) == 0;
}

/* Unit forces at a place that the scene attaches by name: a port, a damper, or
   one direction of a port or a grid. */
static ritz_status add_place(const ritz_stage *stage,
                             const ritz_scene_place *at,
                             ritz_unit_forces *forces)
{
    const ritz_reduced *body = &stage->body[at->component];
    RITZ_OWN(ritz_port_map) map = {0};
    char place[RITZ_NAME_SIZE];
    char *end = NULL;
    int64_t direction = 0, row = 0, grid = 0;
    const ritz_names ports = {"port", body->num_ports, (char *)body->port,
                              sizeof *body->port};
    int64_t p = ritz_names_index(&ports, at->port);

    for (int64_t i = 0; p >= 0 && i < body->port[p].count; i++)
        RITZ_CHECK(
            add_row(stage, at->component, &body->port[p], i, 0, true, forces));
    if (p >= 0)
        return RITZ_OK;
    for (int64_t j = 0; j < stage->dampers.count; j++)
        if (is_damper(stage, at, stage->dampers.name[j]))
            return add_damper(stage, j, 0, true, forces);
    if (!split_direction(at->port, place, &direction))
        return ritz_reduced_port(body, at->port) ? RITZ_OK : RITZ_ERR_ARGUMENT;
    p = ritz_names_index(&ports, place);
    grid = strtoll(place, &end, 10);
    if (p < 0 && (end == place || *end != '\0'))
        return ritz_reduced_port(body, place) ? RITZ_OK : RITZ_ERR_ARGUMENT;
    if (p < 0)
        RITZ_CHECK(map_grid(body, grid, &map));
    RITZ_CHECK(find_direction(p < 0 ? &map : &body->port[p], direction, &row));
    return add_row(stage, at->component, p < 0 ? &map : &body->port[p], row, 0,
                   true, forces);
}

static ritz_status add_places(const ritz_stage *stage, ritz_unit_forces *forces)
{
    const ritz_scene *scene = stage->scene;

    for (int64_t k = 0; k < scene->num_attached_forces; k++) {
        const ritz_scene_force *force = &scene->attached_force[k];

        if (force->input < 0 && force->output < 0)
            RITZ_CHECK(ritz_scene_context(
                scene, add_place(stage, &force->at, forces), force->line,
                force->column, "attached dof", force->at.port));
    }
    return RITZ_OK;
}

ritz_status ritz_unit_forces_of_channels(const ritz_stage *stage,
                                         ritz_unit_forces *out)
{
    RITZ_OWN(ritz_unit_forces) forces = {0};

    RITZ_CHECK(add_inputs(stage, &forces));
    RITZ_CHECK(add_outputs(stage, &forces));
    RITZ_CHECK(add_dampers(stage, true, &forces));
    RITZ_MOVE(*out, forces);
    return RITZ_OK;
}

ritz_status ritz_unit_forces_new(const ritz_stage *stage, ritz_unit_forces *out)
{
    const ritz_scene *scene = stage->scene;
    const bool open = scene->attached & RITZ_ATTACHED_AUTO;
    const bool all = scene->attached == RITZ_ATTACHED_AUTO &&
                     scene->num_attached_forces == 0;
    RITZ_OWN(ritz_unit_forces) forces = {0};

    RITZ_CHECK(add_inputs(stage, &forces));
    RITZ_CHECK(add_outputs(stage, &forces));
    RITZ_CHECK(
        add_dampers(stage, scene->augment == RITZ_AUGMENT_SYSTEM, &forces));
    if (open || scene->augment == RITZ_AUGMENT_COMPONENT)
        RITZ_CHECK(add_ports(stage, true, &forces));
    RITZ_CHECK(add_places(stage, &forces));
    if (all)
        RITZ_CHECK(add_ports(stage, false, &forces));
    for (int64_t k = 0; k < forces.count; k++)
        forces.each[k].named = forces.each[k].named || all;
    RITZ_MOVE(*out, forces);
    return RITZ_OK;
}

ritz_status ritz_unit_forces_select(const ritz_unit_forces *forces, int sets,
                                    bool named, int64_t *count, int64_t **out)
{
    RITZ_CHECK_NEW(*out, forces->count);
    *count = 0;
    for (int64_t k = 0; k < forces->count; k++)
        if ((forces->each[k].sets & sets) || (named && forces->each[k].named))
            (*out)[(*count)++] = k;
    return RITZ_OK;
}

ritz_status ritz_plan_body(const ritz_stage *stage, int64_t k,
                           const ritz_plan *plan, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(stage->body[k].K.ncol, plan->count, out));
    for (int64_t j = 0; j < plan->count && out->nrow > 0; j++) {
        const double *f = plan->forces->each[plan->force[j]].f;

        if (f)
            memcpy(ritz_dense_col(out, j), f + stage->first[k],
                   (size_t)out->nrow * sizeof *out->val);
    }
    return RITZ_OK;
}

/* f += (S P)' of one spring: its elongation in each mode. */
static void add_spring(const ritz_stage *stage, const ritz_configuration *c,
                       const ritz_springs *springs, int64_t spring, double *f)
{
    for (int64_t k = 0; k < stage->count; k++)
        for (int64_t j = 0; j < c->K.ncol; j++)
            for (int64_t q = 0; q < c->P[k].nrow; q++)
                f[j] +=
                    ritz_dense_col(&springs->S, stage->first[k] + q)[spring] *
                    ritz_dense_col(&c->P[k], j)[q];
}

ritz_status ritz_damper_forces(const ritz_stage *stage,
                               const ritz_configuration *configuration,
                               ritz_dense *out)
{
    const ritz_configuration *c = configuration;
    const int64_t own = c->dampers.count;
    RITZ_OWN(ritz_springs) springs = {0};
    RITZ_OWN(ritz_dense) F = {0};
    int64_t m = own;

    RITZ_CHECK(ritz_stage_springs(stage, c->setting, &springs));
    RITZ_CHECK(ritz_dense_new(c->K.ncol, own + springs.S.nrow, &F));
    ritz_dense_put(&c->dampers.B, 0, 0, &F);
    for (int64_t k = 0; k < springs.S.nrow; k++)
        if (springs.of.item[k].freedom->damping > 0.0)
            add_spring(stage, c, &springs, k, ritz_dense_col(&F, m++));
    return ritz_dense_columns(&F, 0, m, out);
}

/* Write forces along the dampers of joints to their columns of B. */
static ritz_status put_springs(const ritz_stage *stage,
                               const ritz_configuration *at,
                               const ritz_plan *plan, ritz_dense *B)
{
    RITZ_OWN(ritz_dense) D = {0};

    for (int64_t j = 0; j < plan->count; j++) {
        const ritz_unit_force *force = &plan->forces->each[plan->force[j]];

        if (force->f)
            continue;
        if (!D.val)
            RITZ_CHECK(ritz_damper_forces(stage, at, &D));
        memcpy(ritz_dense_col(B, j),
               ritz_dense_col(&D, at->dampers.count + force->spring),
               (size_t)B->nrow * sizeof *B->val);
    }
    return RITZ_OK;
}

ritz_status ritz_plan_system(const ritz_stage *stage,
                             const ritz_configuration *at,
                             const ritz_plan *plan, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) B = {0};

    RITZ_CHECK(ritz_dense_new(at->K.ncol, plan->count, &B));
    for (int64_t k = 0; k < stage->count; k++) {
        RITZ_OWN(ritz_dense) F = {0}, part = {0};

        RITZ_CHECK(ritz_plan_body(stage, k, plan, &F));
        RITZ_CHECK(ritz_dense_mul_tn(&at->P[k], &F, &part));
        ritz_dense_add(1.0, &part, &B);
    }
    RITZ_CHECK(put_springs(stage, at, plan, &B));
    RITZ_MOVE(*out, B);
    return RITZ_OK;
}

static void ritz_unit_force_free(ritz_unit_force *force)
{
    free(force->f);
}

void ritz_unit_forces_free(ritz_unit_forces *forces)
{
    RITZ_FREE_EACH(ritz_unit_force, forces->count, forces->each);
    *forces = (ritz_unit_forces){0};
}
