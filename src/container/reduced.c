/* Containers of reduced components. */
#include "container/schema.h"

#include "base/alloc.h"

#include <inttypes.h>

/* Ports. */

static const ritz_member port_members[] = {
    {"origin", ATTRIBUTE_REAL, RITZ_AT(ritz_port_map, origin), "3",
     "origin of the port in the basic frame"},
    {"axes", ATTRIBUTE_REAL, RITZ_AT(ritz_port_map, axes), "3 3",
     "axes of the port: row i is axis i in basic axes"},
    {"grid", SET_WHOLE, RITZ_ITEM(ritz_port_map, dof, ritz_dof, grid), "p",
     "grid or scalar point of each row"},
    {"component", SET_WHOLE, RITZ_ITEM(ritz_port_map, dof, ritz_dof, component),
     "p", "basic direction of each row", "0..6"},
    {"position", SET_REAL, RITZ_AT(ritz_port_map, position), "p 3",
     "position of the grid of each row; zero for a scalar point"},
    {"map", MATRIX_DENSE, RITZ_AT(ritz_port_map, map), "p r",
     "displacements of the port along basic axes are map q"},
    {0},
};

static const ritz_schema port_schema = {
    .name = "port of a reduced component",
    .sizes = {{'p', .offset = offsetof(ritz_port_map, count), "grid"}},
    .members = port_members,
};

/* Quantities to recover. */

static const ritz_member quantity_members[] = {
    {"kind", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_quantity, kind), "",
     "as in a component, like the next two"},
    {"place", SET_WHOLE, RITZ_AT(ritz_quantity, place), "k",
     "number of an element or grid; 0: none", "0.."},
    {"part", SET_WORDS, RITZ_AT(ritz_quantity, part), "k",
     "what each row is there"},
    {"S", MATRIX_DENSE, RITZ_AT(ritz_quantity, ST), "k r",
     "mode displacement: y = S q, of kind acceleration y = S q''"},
    {"Q", MATRIX_DENSE, RITZ_AT(ritz_quantity, Q), "k r",
     "mode acceleration: y = Q q + V q' + A q'' + F f - H g, where f are the "
     "inputs and g the forces c b'q' + k b'q of the dampers",
     .optional = ""},
    {"V", MATRIX_DENSE, RITZ_AT(ritz_quantity, V), "k r",
     "part of the damping matrix in mode acceleration", .optional = ""},
    {"A", MATRIX_DENSE, RITZ_AT(ritz_quantity, A), "k r",
     "part of inertia forces", .optional = ""},
    {"F", MATRIX_DENSE, RITZ_AT(ritz_quantity, F), "k m", "part of the inputs",
     .optional = ""},
    {"H", MATRIX_DENSE, RITZ_AT(ritz_quantity, H), "k d", "part of the dampers",
     .optional = ""},
    {0},
};

static const ritz_schema quantity_schema = {
    .name = "quantity of a reduced component",
    .sizes = {{'k', .offset = offsetof(ritz_quantity, count), "place"},
              {'m', .offset = offsetof(ritz_quantity, F.ncol), "F"},
              {'d', .offset = offsetof(ritz_quantity, H.ncol), "H"}},
    .members = quantity_members,
};

/* Prefixes of nested columns: a data set of errors for each measure. */

static ritz_status move_errors(const ritz_place *place, hid_t group)
{
    const ritz_nested *nested = place->object;
    ritz_nested *read = place->target;
    ritz_name name = "";

    if (read) {
        RITZ_CHECK(ritz_h5_list(group, &read->num_errors, &read->error));
        RITZ_CHECK(ritz_dense_new(read->count, read->num_errors, &read->value));
    }
    for (int64_t j = 0; j < nested->num_errors; j++) {
        double *value = ritz_dense_col(&nested->value, j);
        const ritz_member row[] = {
            {name, SET_REAL, .shape = "k", .values = VALUES_OR_NAN},
            {0},
        };
        const ritz_schema schema = {.members = row};

        RITZ_CHECK(ritz_name_copy(nested->error[j], name));
        RITZ_CHECK(ritz_schema_move(&(ritz_place){
            .at = group,
            .schema = &schema,
            .object = &value,
            .target = read ? &value : NULL,
            .outer = place,
        }));
    }
    return RITZ_OK;
}

static ritz_status settle_nested(const ritz_place *place)
{
    const ritz_nested *nested = place->target;

    for (int64_t k = 1; k < nested->count; k++)
        RITZ_REFUSE_IF(nested->order[k] <= nested->order[k - 1],
                       RITZ_ERR_FORMAT,
                       "'order' does not ascend at value %" PRId64, k + 1);
    return RITZ_OK;
}

static const ritz_member nested_members[] = {
    {"smallest", ATTRIBUTE_WHOLE, RITZ_AT(ritz_nested, smallest), "",
     "least number of leading columns that are a reduced component of their "
     "own",
     "1..r"},
    {"order", SET_WHOLE, RITZ_AT(ritz_nested, order), "k",
     "orders for which measures are stored, ascending", "s..r"},
    {"error/<measure>", BY_HAND, .type = "f64", .shape = "k",
     .about =
         "value of that measure at each order; NaN where it was not measured",
     .move = move_errors},
    {0},
};

const ritz_schema ritz_schema_nested = {
    .name = "nested",
    .sizes = {{'s', .offset = offsetof(ritz_nested, smallest)},
              {'k', .offset = offsetof(ritz_nested, count), "order"}},
    .members = nested_members,
    .settle = settle_nested,
};

/* The whole. */

static bool has_inertia(const void *object)
{
    return ((const ritz_reduced *)object)->inertia.known;
}

static bool has_invariants(const void *object)
{
    const ritz_reduced *reduced = object;

    return has_inertia(object) && reduced->invariants.momentum.val;
}

static ritz_status settle_reduced(const ritz_place *place)
{
    ritz_reduced *reduced = place->target;

    reduced->inertia.known = ritz_h5_has(place->at, "inertia");
    RITZ_CHECK_IN("elements",
                  ritz_elements_check(&reduced->elements, reduced->grids.count,
                                      reduced->grids.id));
    RITZ_CHECK_IN("quantities", ritz_quantities_check_reduced(
                                    reduced->num_quantities, reduced->quantity,
                                    reduced->K.ncol, reduced->io.num_inputs,
                                    reduced->dampers.count));
    return ritz_context(ritz_recovery_check(&reduced->recovery,
                                            reduced->num_dofs, reduced->dof),
                        "recovery");
}

static const ritz_member load_members[] = {
    {"matrix", MATRIX_DENSE, RITZ_AT(ritz_reduced_load, KG), "r r",
     "geometric stiffness matrix of a unit load"},
    {0},
};

static ritz_status settle_load(const ritz_place *place)
{
    return ritz_reduced_load_settle(place->target);
}

static const ritz_schema load_schema = {.members = load_members,
                                        .settle = settle_load};

static const ritz_member members[] = {
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_reduced, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"", PART, RITZ_AT(ritz_reduced, origin), .schema = &ritz_schema_origin},
    {"num_dofs", ATTRIBUTE_WHOLE, RITZ_AT(ritz_reduced, num_dofs), "",
     "number n of dofs of the full component", "0.."},
    {"K", MATRIX_DENSE, RITZ_AT(ritz_reduced, K), "r r", "stiffness matrix"},
    {"M", MATRIX_DENSE, RITZ_AT(ritz_reduced, M), "r r", "mass matrix"},
    {"D", MATRIX_DENSE, RITZ_AT(ritz_reduced, D), "r r",
     "viscous damping matrix", .optional = ""},
    {"K4", MATRIX_DENSE, RITZ_AT(ritz_reduced, K4), "r r",
     "structural damping matrix, as in K + i K4", .optional = ""},
    {"KG", LIST, RITZ_LIST(ritz_reduced, load), "l", .optional = "",
     .some = 'l', .schema = &load_schema},
    {"dampers", PART, RITZ_AT(ritz_reduced, dampers), .optional = "",
     .some = 'd', .schema = &ritz_schema_dampers},
    {"T", MATRIX_DENSE, RITZ_AT(ritz_reduced, T), "n r",
     "u = T q; left out by `--without-basis`", .optional = ""},
    {"grids", PART, RITZ_AT(ritz_reduced, grids), .optional = "", .some = 'f',
     .schema = &ritz_schema_grids},
    {"elements", PART, RITZ_AT(ritz_reduced, elements), .optional = "",
     .some = 'e', .schema = &ritz_schema_elements},
    {"dofs/grid", SET_WHOLE, RITZ_ITEM(ritz_reduced, dof, ritz_dof, grid), "n",
     "as in a component", .optional = "dofs"},
    {"dofs/component", SET_WHOLE,
     RITZ_ITEM(ritz_reduced, dof, ritz_dof, component), "n",
     "as in a component", "0..6", .optional = "dofs"},
    {"recovery", PART, RITZ_AT(ritz_reduced, recovery), .optional = "recovery",
     .some = 'd', .schema = &ritz_schema_recovery},
    {"", PART, RITZ_AT(ritz_reduced, columns), .schema = &ritz_schema_columns},
    {"ports", LIST, RITZ_LIST(ritz_reduced, port), "b", .schema = &port_schema},
    {"", PART, RITZ_AT(ritz_reduced, io), .schema = &ritz_schema_io},
    {"quantities", LIST, RITZ_LIST(ritz_reduced, quantity), "q", .optional = "",
     .some = 'q', .schema = &quantity_schema},
    {"inertia/mass", SET_REAL, RITZ_AT(ritz_reduced, inertia.mass), "1",
     "total mass, from the rigid geometry", .inside = true,
     .optional = "inertia", .has = has_inertia},
    {"inertia/centre", SET_REAL, RITZ_AT(ritz_reduced, inertia.centre), "3",
     "centre of mass in the basic frame", .inside = true, .optional = "inertia",
     .has = has_inertia},
    {"inertia/tensor", SET_REAL, RITZ_AT(ritz_reduced, inertia.tensor), "3 3",
     "inertia tensor about the centre of mass, along basic axes",
     .inside = true, .optional = "inertia", .has = has_inertia},
    {"inertia/rigid", SET_REAL, RITZ_AT(ritz_reduced, invariants.rigid), "6 6",
     "R' M R", .inside = true, .optional = "inertia/momentum",
     .has = has_invariants},
    {"inertia/momentum", MATRIX_DENSE,
     RITZ_AT(ritz_reduced, invariants.momentum), "6 r",
     "R' M T: linear and angular momentum of each column",
     .optional = "inertia/momentum", .has = has_invariants},
    {"inertia/position", MATRIX_DENSE,
     RITZ_AT(ritz_reduced, invariants.position), "3 3r",
     "`[a, b*r + k]` is the integral of x_a v_kb over the mass",
     .optional = "inertia/momentum", .has = has_invariants},
    {"inertia/product", MATRIX_DENSE, RITZ_AT(ritz_reduced, invariants.product),
     "3r 3r", "`[a*r + j, b*r + k]` is the integral of v_ja v_kb over the mass",
     .optional = "inertia/momentum", .has = has_invariants},
    {"estimates", PART, RITZ_AT(ritz_reduced, estimates), .optional = "",
     .some = 'k', .schema = &ritz_schema_measures},
    {"errors", PART, RITZ_AT(ritz_reduced, errors), .optional = "", .some = 'k',
     .schema = &ritz_schema_measures},
    {"nested", PART, RITZ_AT(ritz_reduced, nested), .optional = "", .some = 's',
     .schema = &ritz_schema_nested},
    {0},
};

const ritz_schema ritz_schema_reduced = {
    .name = "reduced",
    .units = offsetof(ritz_reduced, units),
    .sizes = {{'n', .offset = offsetof(ritz_reduced, num_dofs)},
              {'r', .offset = offsetof(ritz_reduced, K.ncol), "K"},
              {'c', .offset = offsetof(ritz_reduced, K.ncol)},
              {'b', .offset = offsetof(ritz_reduced, num_ports)},
              {'q', .offset = offsetof(ritz_reduced, num_quantities)},
              {'l', .offset = offsetof(ritz_reduced, num_loads)}},
    .members = members,
    .settle = settle_reduced,
};
