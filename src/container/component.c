/* Containers of components. */
#include "container/schema.h"

#include "base/search.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static ritz_status settle_port(const ritz_place *place)
{
    const ritz_port *port = place->target;
    RITZ_OWN(ritz_dofs) sorted = {0};

    RITZ_CHECK(ritz_dofs_copy(&port->dofs, &sorted));
    qsort(sorted.at, (size_t)sorted.count, sizeof *sorted.at,
          ritz_ascending_index);
    for (int64_t k = 1; k < sorted.count; k++)
        RITZ_REFUSE_IF(sorted.at[k - 1] == sorted.at[k], RITZ_ERR_FORMAT,
                       "row %" PRId64 " is in 'dofs' twice", sorted.at[k]);
    return RITZ_OK;
}

static const ritz_member port_members[] = {
    {"origin", ATTRIBUTE_REAL, RITZ_AT(ritz_port, origin), "3",
     "origin of the port in the basic frame"},
    {"axes", ATTRIBUTE_REAL, RITZ_AT(ritz_port, axes), "3 3",
     "axes of the port: row i is axis i in basic axes"},
    {"dofs", SET_WHOLE, RITZ_AT(ritz_port, dofs.at), "q",
     "distinct rows of the component that the port holds", "0..n-1"},
    {0},
};

static const ritz_schema port_schema = {
    .name = "port of a component",
    .sizes = {{'q', .offset = offsetof(ritz_port, dofs.count), "dofs"}},
    .members = port_members,
    .settle = settle_port,
};

static const ritz_member load_members[] = {
    {"", MATRIX_SPARSE, RITZ_AT(ritz_load, KG), "n n",
     "geometric stiffness matrix of a unit load"},
    {0},
};

static const ritz_schema load_schema = {.members = load_members};

static const ritz_member quantity_members[] = {
    {"kind", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_quantity, kind), "",
     "stress, force, displacement, acceleration or other"},
    {"place", SET_WHOLE, RITZ_AT(ritz_quantity, place), "k",
     "number of the element of each row, of displacement and acceleration of "
     "the grid; 0: none",
     "0.."},
    {"part", SET_WORDS, RITZ_AT(ritz_quantity, part), "k",
     "what each row is there, such as `sx`; may be empty"},
    {"S", MATRIX_SPARSE, RITZ_AT(ritz_quantity, S), "k n",
     "y = S u, of kind acceleration y = S u''"},
    {0},
};

static const ritz_schema quantity_schema = {
    .name = "quantity of a component",
    .sizes = {{'k', .offset = offsetof(ritz_quantity, count), "place"}},
    .members = quantity_members,
};

/* The larger of the stored asymmetry and of that which the matrices have. */
static ritz_status settle_component(const ritz_place *place)
{
    ritz_component *component = place->target;
    double asymmetry = component->asymmetry;

    RITZ_CHECK(ritz_component_settle(component, false));
    component->asymmetry = fmax(component->asymmetry, asymmetry);
    return RITZ_OK;
}

static const ritz_member members[] = {
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_component, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"asymmetry", ATTRIBUTE_REAL, RITZ_AT(ritz_component, asymmetry), "",
     "relative asymmetry of the matrices, which was averaged away"},
    {"digits", ATTRIBUTE_REAL, RITZ_AT(ritz_component, digits), "",
     "significant digits of the source; 0: not known"},
    {"K", MATRIX_SPARSE, RITZ_AT(ritz_component, K), "n n",
     "stiffness matrix; without entries in a rigid component", .optional = ""},
    {"M", MATRIX_SPARSE, RITZ_AT(ritz_component, M), "n n", "mass matrix",
     .optional = "", .must = true},
    {"D", MATRIX_SPARSE, RITZ_AT(ritz_component, D), "n n",
     "viscous damping matrix; the only one that need not be symmetric",
     .optional = ""},
    {"K4", MATRIX_SPARSE, RITZ_AT(ritz_component, K4), "n n",
     "structural damping matrix, as in K + i K4", .optional = ""},
    {"KG", LIST, RITZ_LIST(ritz_component, load), "l", .optional = "",
     .some = 'l', .schema = &load_schema},
    {"dofs/grid", SET_WHOLE, RITZ_ITEM(ritz_component, dof, ritz_dof, grid),
     "n", "grid or scalar point of each row"},
    {"dofs/component", SET_WHOLE,
     RITZ_ITEM(ritz_component, dof, ritz_dof, component), "n",
     "direction of each row: 1-3 translation, 4-6 rotation, 0 scalar point",
     "0..6"},
    {"grids", PART, RITZ_AT(ritz_component, grids), .optional = "", .some = 'f',
     .schema = &ritz_schema_grids},
    {"elements", PART, RITZ_AT(ritz_component, elements), .optional = "",
     .some = 'e', .schema = &ritz_schema_elements},
    {"ports", LIST, RITZ_LIST(ritz_component, port), "b",
     .schema = &port_schema},
    {"", PART, RITZ_AT(ritz_component, io), .schema = &ritz_schema_io},
    {"recovery", PART, RITZ_AT(ritz_component, recovery), .optional = "",
     .some = 'd', .schema = &ritz_schema_recovery},
    {"quantities", LIST, RITZ_LIST(ritz_component, quantity), "q",
     .optional = "", .some = 'q', .schema = &quantity_schema},
    {"dampers", PART, RITZ_AT(ritz_component, dampers), .optional = "",
     .some = 'd', .schema = &ritz_schema_dampers},
    {0},
};

const ritz_schema ritz_schema_component = {
    .name = "component",
    .units = offsetof(ritz_component, units),
    .sizes = {{'n', .offset = offsetof(ritz_component, num_dofs), "dofs/grid"},
              {'c', .offset = offsetof(ritz_component, num_dofs)},
              {'l', .offset = offsetof(ritz_component, num_loads)},
              {'b', .offset = offsetof(ritz_component, num_ports)},
              {'q', .offset = offsetof(ritz_component, num_quantities)}},
    .members = members,
    .settle = settle_component,
};
