/*
 * Conversions between small models: a configuration of a system to a reduced
 * component, and a reduced component to a component or to a state space.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/equations.h"

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Whether row and column @p j of a matrix are zero except on the diagonal. */
static bool is_decoupled(const ritz_dense *A, int64_t j)
{
    for (int64_t i = 0; i < A->nrow; i++)
        if (i != j &&
            (ritz_dense_col(A, j)[i] != 0.0 || ritz_dense_col(A, i)[j] != 0.0))
            return false;
    return true;
}

/*
 * Stiffness of the modes. The eigenvalue of a rigid mode is rounding and
 * becomes 0, unless springs have been installed since.
 */
static ritz_status copy_stiffness(const ritz_configuration *at, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(&at->K, out));
    for (int64_t j = 0; j < at->num_rigid; j++)
        if (ritz_dense_col(out, j)[j] == at->lambda[j] && is_decoupled(out, j))
            ritz_dense_col(out, j)[j] = 0.0;
    return RITZ_OK;
}

/* Columns are modes, the rigid ones first. */
static ritz_status describe_modes(const ritz_configuration *at,
                                  ritz_columns *out)
{
    RITZ_CHECK(ritz_columns_new(at->K.ncol, out));
    for (int64_t j = 0; j < out->count; j++) {
        const bool rigid = j < at->num_rigid;

        out->kind[j] = rigid ? RITZ_COLUMN_RIGID : RITZ_COLUMN_NORMAL;
        out->hertz[j] = rigid ? 0.0 : ritz_eigen_hertz(at->lambda[j]);
    }
    return RITZ_OK;
}

static ritz_status copy_optional(const ritz_dense *A, ritz_dense *out)
{
    return A->val ? ritz_dense_copy(A, out) : RITZ_OK;
}

ritz_status ritz_reduced_of_configuration(const ritz_system *system,
                                          const ritz_configuration *at,
                                          ritz_reduced *out)
{
    RITZ_OWN(ritz_reduced) made = {.origin = {.method = "system"}};
    double mass[sizeof at->rigid / sizeof *at->rigid];
    const ritz_dense rigid = {6, 6, mass};

    memcpy(mass, at->rigid, sizeof mass);
    snprintf(made.origin.options, sizeof made.origin.options, "%s", at->at);
    snprintf(made.origin.reference, sizeof made.origin.reference,
             "McDaniel2000");
    memcpy(made.units, system->units, sizeof made.units);
    memcpy(made.damping, system->damping, sizeof made.damping);
    for (int64_t c = 0; c < system->num_components; c++)
        made.num_dofs += system->component[c].order_full;
    RITZ_CHECK(copy_stiffness(at, &made.K));
    RITZ_CHECK(ritz_dense_copy(&at->M, &made.M));
    RITZ_CHECK(copy_optional(&at->D, &made.D));
    RITZ_CHECK(copy_optional(&at->K4, &made.K4));
    RITZ_CHECK(ritz_loads_project(at->num_loads, at->load, NULL, &made.load));
    made.num_loads = at->num_loads;
    RITZ_CHECK(ritz_dampers_copy(&at->dampers, &made.dampers));
    RITZ_CHECK(ritz_io_copy(&at->io, &made.io));
    RITZ_CHECK(describe_modes(at, &made.columns));
    RITZ_CHECK(ritz_measures_copy(&at->errors, &made.errors));
    if (at->momentum.val)
        ritz_inertia_read(&rigid, &made.inertia);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_system_check_bodies(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies)
{
    RITZ_OWN(ritz_dense) sum = {0};

    RITZ_CHECK(ritz_dense_copy(&at->M, &sum));
    for (int64_t c = 0; c < system->num_components; c++) {
        RITZ_OWN(ritz_dense) part = {0};

        RITZ_REFUSE_IF(bodies[c]->K.ncol != at->P[c].nrow, RITZ_ERR_ARGUMENT,
                       "'%s' has %" PRId64 " coordinates in the system and "
                       "%" PRId64 " in its file",
                       system->component[c].name, at->P[c].nrow,
                       bodies[c]->K.ncol);
        RITZ_CHECK(ritz_dense_congruence(&bodies[c]->M, &at->P[c], &part));
        ritz_dense_add(-1.0, &part, &sum);
    }
    RITZ_REFUSE_IF(ritz_dense_max(&sum) >
                       RITZ_SAME_MASS * ritz_dense_max(&at->M),
                   RITZ_ERR_ARGUMENT,
                   "the masses of these bodies are not the mass of the system: "
                   "it was assembled from others");
    return RITZ_OK;
}

/* y = R x of a vector. */
static void turn_vector(const double R[static 9], const double x[static 3],
                        double y[static 3])
{
    for (size_t i = 0; i < 3; i++)
        y[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

/* Turn rows i to i + 2, the translations or rotations of a grid, by R. */
static void turn_rows(const double *R, int64_t i, ritz_dense *map)
{
    for (int64_t j = 0; j < map->ncol; j++) {
        double *at = ritz_dense_col(map, j) + i;
        double y[3];

        turn_vector(R, at, y);
        memcpy(at, y, sizeof y);
    }
}

/* Whether rows i to i + 2 are all translations, or all rotations, of a grid. */
static bool has_three(const ritz_port_map *port, int64_t i)
{
    return i + 2 < port->count && port->dof[i].component % 3 == 1 &&
           port->dof[i + 2].grid == port->dof[i].grid &&
           port->dof[i + 2].component == port->dof[i].component + 2;
}

/* The port of a body in a system, where a point x of the body is at R x + t. */
static ritz_status place_port(const ritz_port_map *from, const ritz_dense *P,
                              const double *R, const double *t,
                              ritz_port_map *out)
{
    memcpy(out->axes, from->axes, sizeof out->axes);
    out->count = from->count;
    RITZ_CHECK_COPY(out->dof, from->dof, from->count);
    RITZ_CHECK_NEW(out->position, 3 * from->count);
    RITZ_CHECK(ritz_dense_mul(&from->map, P, &out->map));
    turn_vector(R, from->origin, out->origin);
    for (int64_t i = 0; i < from->count; i++)
        turn_vector(R, from->position + 3 * i, out->position + 3 * i);
    for (int i = 0; i < 3; i++) {
        out->origin[i] += t[i];
        for (int64_t k = 0; k < from->count; k++)
            out->position[3 * k + i] += t[i];
    }
    for (int64_t i = 0; i < from->count; i++)
        if (has_three(from, i))
            turn_rows(R, i, &out->map);
    return RITZ_OK;
}

/* The smallest power of ten above all grid numbers of the ports. */
static int64_t find_offset(int64_t count, const ritz_reduced *const *bodies)
{
    int64_t power = 1;

    for (int64_t c = 0; c < count; c++)
        for (int64_t k = 0; k < bodies[c]->num_ports; k++)
            for (int64_t i = 0; i < bodies[c]->port[k].count; i++)
                while (power <= bodies[c]->port[k].dof[i].grid)
                    power *= 10;
    return power;
}

static ritz_status name_port(const char *body, const char *port,
                             char out[RITZ_NAME_SIZE])
{
    const int length = snprintf(out, RITZ_NAME_SIZE, "%s/%s", body, port);

    RITZ_REFUSE_IF(length >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "the name '%s/%s' is longer than %d letters", body, port,
                   RITZ_NAME_SIZE - 1);
    return RITZ_OK;
}

ritz_status ritz_reduced_place_ports(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies,
                                     ritz_reduced *reduced)
{
    const int64_t offset = find_offset(system->num_components, bodies);
    int64_t room = 0;

    RITZ_REFUSE_IF(!at->places.val, RITZ_ERR_ARGUMENT,
                   "it does not say where its bodies are: assemble it anew");
    RITZ_CHECK(ritz_system_check_bodies(system, at, bodies));
    for (int64_t c = 0; c < system->num_components; c++)
        room += bodies[c]->num_ports;
    RITZ_CHECK_NEW(reduced->port, room);
    for (int64_t c = 0; c < system->num_components; c++) {
        double place[12];

        for (int64_t i = 0; i < 12; i++)
            place[i] = ritz_dense_col(&at->places, i)[c];
        for (int64_t k = 0; k < bodies[c]->num_ports; k++) {
            ritz_port_map *port = &reduced->port[reduced->num_ports++];

            RITZ_CHECK(name_port(system->component[c].name,
                                 bodies[c]->port[k].name, port->name));
            RITZ_CHECK(place_port(&bodies[c]->port[k], &at->P[c], place,
                                  place + 9, port));
            for (int64_t i = 0; i < port->count; i++)
                port->dof[i].grid += c * offset;
        }
    }
    return RITZ_OK;
}

/* Refuse columns that a component cannot have: forces at an interface, and
   modes of negative eigenvalue that such forces cause in a system. */
static ritz_status check_columns(const ritz_columns *columns)
{
    for (int64_t j = 0; j < columns->count; j++) {
        RITZ_REFUSE_IF(columns->kind[j] == RITZ_COLUMN_FORCE, RITZ_ERR_ARGUMENT,
                       "column %lld is a force at an interface, which no "
                       "displacement can stand for: take the same made by "
                       "macneal-rubin",
                       (long long)j + 1);
        RITZ_REFUSE_IF(columns->hertz[j] < 0.0, RITZ_ERR_ARGUMENT,
                       "column %lld is a mode of negative eigenvalue, %.4g Hz, "
                       "as bodies of dual-craig-bampton leave them: no "
                       "component has such, take macneal-rubin",
                       (long long)j + 1, columns->hertz[j]);
    }
    return RITZ_OK;
}

ritz_status ritz_component_of_reduced(const ritz_reduced *reduced,
                                      ritz_component *out)
{
    const int64_t n = reduced->K.nrow;
    RITZ_OWN(ritz_component) made = {.num_dofs = n};

    RITZ_CHECK(check_columns(&reduced->columns));
    RITZ_CHECK_NEW(made.dof, n);
    for (int64_t j = 0; j < n; j++)
        made.dof[j] = (ritz_dof){.grid = j + 1};
    RITZ_CHECK(ritz_sparse_from_dense(&reduced->K, &made.K));
    RITZ_CHECK(ritz_sparse_from_dense(&reduced->M, &made.M));
    if (reduced->D.val)
        RITZ_CHECK(ritz_sparse_from_dense(&reduced->D, &made.D));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_sparse_from_dense(&reduced->K4, &made.K4));
    RITZ_CHECK_NEW(made.load, reduced->num_loads);
    for (; made.num_loads < reduced->num_loads; made.num_loads++) {
        const ritz_reduced_load *from = &reduced->load[made.num_loads];
        ritz_load *to = &made.load[made.num_loads];

        memcpy(to->name, from->name, sizeof to->name);
        RITZ_CHECK(ritz_sparse_from_dense(&from->KG, &to->KG));
    }
    RITZ_CHECK(ritz_io_copy(&reduced->io, &made.io));
    RITZ_CHECK(ritz_dampers_copy(&reduced->dampers, &made.dampers));
    memcpy(made.damping, reduced->damping, sizeof made.damping);
    memcpy(made.units, reduced->units, sizeof made.units);
    RITZ_CHECK(ritz_component_settle(&made, false));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_states_of_reduced(const ritz_reduced *reduced,
                                   const ritz_damping *damping,
                                   ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) made = {0};
    const ritz_state_space *same = NULL;

    RITZ_CHECK(ritz_model_states(ritz_model_of_reduced(reduced, damping), &made,
                                 &same));
    made.origin = reduced->origin;
    memcpy(made.units, reduced->units, sizeof made.units);
    RITZ_CHECK(ritz_measures_copy(&reduced->estimates, &made.estimates));
    RITZ_CHECK(ritz_measures_copy(&reduced->errors, &made.errors));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}
