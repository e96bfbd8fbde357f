/* Containers of systems: `blocks`, and `configurations/0`, 1, ... */
#include "container/schema.h"

#include "base/alloc.h"

#include <inttypes.h>

/* Blocks: components bring one row of q after the other. */

static ritz_status settle_block(const ritz_place *place)
{
    const ritz_block *block = place->target;
    int64_t due = place->index > 0 ? block[-1].first + block[-1].order : 0;

    RITZ_REFUSE_IF(block->first != due, RITZ_ERR_FORMAT,
                   "attribute 'first' is %" PRId64 ", not in %" PRId64
                   "..%" PRId64,
                   block->first, due, due);
    return RITZ_OK;
}

static const ritz_member block_members[] = {
    {"first", ATTRIBUTE_WHOLE, RITZ_AT(ritz_block, first), "",
     "first row of the component's coordinates in q"},
    {"order", ATTRIBUTE_WHOLE, RITZ_AT(ritz_block, order), "",
     "number of these rows", "0..2147483647"},
    {"order_full", ATTRIBUTE_WHOLE, RITZ_AT(ritz_block, order_full), "",
     "number of dofs of the full component", "0.."},
    {"turns", ATTRIBUTE_FLAG, RITZ_AT(ritz_block, turns), "",
     "1: in a time response, a joint turns the component as it moves",
     .optional = ""},
    {0},
};

const ritz_schema ritz_schema_block = {
    .name = "block",
    .members = block_members,
    .settle = settle_block,
};

/* The way back from x to each component: q_c = P_c x. */

static ritz_status move_maps(const ritz_place *place, hid_t group)
{
    const ritz_configuration *configuration = place->object;
    ritz_configuration *read = place->target;
    const ritz_system *system = place->outer->object;

    if (read) {
        RITZ_CHECK_NEW(read->P, system->num_components);
        read->num_blocks = system->num_components;
    }
    RITZ_REFUSE_IF(configuration->num_blocks != system->num_components,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " blocks for %" PRId64 " components",
                   configuration->num_blocks, system->num_components);
    for (int64_t c = 0; c < system->num_components; c++) {
        const ritz_block *block = &system->component[c];

        RITZ_CHECK(read ? ritz_h5_read_dense(group, block->name, block->order,
                                             read->K.ncol, &read->P[c])
                        : ritz_h5_write_dense(group, block->name,
                                              &configuration->P[c]));
    }
    return RITZ_OK;
}

/* Configurations. */

static bool has_momentum(const void *object)
{
    return ((const ritz_configuration *)object)->momentum.val;
}

static const ritz_member load_members[] = {
    {"matrix", MATRIX_DENSE, RITZ_AT(ritz_reduced_load, KG), "e e",
     "geometric stiffness matrix of a unit load"},
    {0},
};

static ritz_status settle_load(const ritz_place *place)
{
    return ritz_reduced_load_settle(place->target);
}

static const ritz_schema load_schema = {.members = load_members,
                                        .settle = settle_load};

static const ritz_member configuration_members[] = {
    {"at", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_configuration, at), "",
     "settings of the joints, such as `clock=60,cone=0`"},
    {"rank", ATTRIBUTE_WHOLE, RITZ_AT(ritz_configuration, rank), "",
     "rank of the constraints", "0.."},
    {"num_rigid", ATTRIBUTE_WHOLE, RITZ_AT(ritz_configuration, num_rigid), "",
     "number of rigid-body modes", "0..e"},
    {"settings", SET_REAL, RITZ_AT(ritz_configuration, setting), "w",
     "setting of each of `sweeps`"},
    {"K", MATRIX_DENSE, RITZ_AT(ritz_configuration, K), "e e",
     "stiffness matrix"},
    {"M", MATRIX_DENSE, RITZ_AT(ritz_configuration, M), "e e", "mass matrix"},
    {"D", MATRIX_DENSE, RITZ_AT(ritz_configuration, D), "e e",
     "viscous damping matrix", .optional = ""},
    {"K4", MATRIX_DENSE, RITZ_AT(ritz_configuration, K4), "e e",
     "structural damping matrix, as in K + i K4", .optional = ""},
    {"KG", LIST, RITZ_LIST(ritz_configuration, load), "l", .optional = "",
     .some = 'l', .schema = &load_schema},
    {"dampers", PART, RITZ_AT(ritz_configuration, dampers), .optional = "",
     .some = 'd', .schema = &ritz_schema_dampers},
    {"lambda", SET_REAL, RITZ_AT(ritz_configuration, lambda), "e",
     "eigenvalues, in rad^2/s^2"},
    {"", PART, RITZ_AT(ritz_configuration, io), .schema = &ritz_schema_io},
    {"blocks/<component>", BY_HAND, .type = "f64", .shape = "order e",
     .about = "q = block x are the coordinates of the component",
     .move = move_maps},
    {"momentum", MATRIX_DENSE, RITZ_AT(ritz_configuration, momentum), "6 e",
     "R'M in the coordinates x, where R are the rigid motions about the origin "
     "of the first body's basic frame",
     .optional = ""},
    {"rigid", SET_REAL, RITZ_AT(ritz_configuration, rigid), "6 6", "R'MR",
     .inside = true, .optional = "momentum", .has = has_momentum},
    {"places", MATRIX_DENSE, RITZ_AT(ritz_configuration, places), "b 12",
     "a point x of body k is at R x + t in the basic frame of the first body: "
     "R row by row, then t",
     .optional = ""},
    {"errors", PART, RITZ_AT(ritz_configuration, errors), .optional = "",
     .some = 'k', .schema = &ritz_schema_measures},
    {0},
};

static const ritz_schema configuration_schema = {
    .name = "configuration",
    .sizes = {{'e', .offset = offsetof(ritz_configuration, K.ncol), "K"},
              {'c', .offset = offsetof(ritz_configuration, K.ncol)},
              {'w', .offset = offsetof(ritz_configuration, num_settings), "^"},
              {'b', .offset = offsetof(ritz_configuration, num_blocks), "^"},
              {'l', .offset = offsetof(ritz_configuration, num_loads)}},
    .members = configuration_members,
};

/* The whole. */

static bool has_spin(const void *object)
{
    return *((const ritz_system *)object)->spin;
}

static const ritz_member members[] = {
    {"name", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_system, name), "",
     "name of the scene"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_system, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"band_hz", ATTRIBUTE_REAL, RITZ_AT(ritz_system, band_hz), "2",
     "frequency band for which the system is made"},
    {"spin", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_system, spin), "",
     "spin that K, D and the input `centrifugal` have in them: model, rate and "
     "axis",
     .optional = "", .has = has_spin},
    {"sweeps", SET_NAMES, RITZ_AT(ritz_system, sweep), "w",
     "names of the settings of joints, such as `clock`, `wrist`, `wrist.2`"},
    {"blocks", LIST, RITZ_LIST(ritz_system, component), "b",
     .schema = &ritz_schema_block},
    {"configurations", LIST, RITZ_LIST(ritz_system, configuration), "k",
     .numbered = true, .schema = &configuration_schema},
    {0},
};

const ritz_schema ritz_schema_system = {
    .name = "system",
    .units = offsetof(ritz_system, units),
    .sizes = {{'w', .offset = offsetof(ritz_system, num_sweeps), "sweeps"},
              {'b', .offset = offsetof(ritz_system, num_components)},
              {'k', .offset = offsetof(ritz_system, num_configurations)}},
    .members = members,
};
