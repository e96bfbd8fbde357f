/* Containers of models in first-order form. */
#include "container/schema.h"

#include "base/alloc.h"

/* The full component is not known, so that no column names a row of it. */
static int64_t count_no_dofs(const void *)
{
    return 0;
}

static ritz_status settle_state_space(const ritz_place *place)
{
    ritz_state_space *model = place->target;

    if (!model->input)
        RITZ_CHECK_NEW(model->input, 0);
    if (!model->output) {
        RITZ_CHECK_NEW(model->output, 0);
        RITZ_CHECK_NEW(model->limit, 0);
    }
    return ritz_state_space_check(model);
}

static ritz_status check_model(const void *object)
{
    return ritz_state_space_check(object);
}

static const ritz_member members[] = {
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_state_space, damping), "",
     "damping that A contains in addition to the component's matrices"},
    {"", PART, RITZ_AT(ritz_state_space, origin),
     .schema = &ritz_schema_origin},
    {"A", MATRIX_DENSE, RITZ_AT(ritz_state_space, A), "r r",
     "system matrix: E x' = A x + B u; absent if it is sparse", .optional = ""},
    {"B", MATRIX_DENSE, RITZ_AT(ritz_state_space, B), "r m", "input matrix"},
    {"C", MATRIX_DENSE, RITZ_AT(ritz_state_space, C), "p r",
     "output matrix: y = C x + D u"},
    {"D", MATRIX_DENSE, RITZ_AT(ritz_state_space, D), "p m", "feedthrough"},
    {"E", MATRIX_DENSE, RITZ_AT(ritz_state_space, E), "r r",
     "not singular; absent if it is sparse, or the identity", .optional = ""},
    {"sparse/A", MATRIX_SPARSE, RITZ_AT(ritz_state_space, sA), "r r",
     "A of a large sparse model, in the place of A", .optional = ""},
    {"sparse/E", MATRIX_SPARSE, RITZ_AT(ritz_state_space, sE), "r r",
     "its E; absent if it is the identity", .optional = ""},
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_state_space, input), "m",
     "distinct names of the inputs", .optional = "inputs", .some = 'm'},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_state_space, output), "p",
     "distinct names of the outputs", .optional = "outputs", .some = 'p'},
    {"outputs/limits", SET_REAL, RITZ_AT(ritz_state_space, limit), "p",
     "largest tolerated \\|y\\| of each output", .values = VALUES_OR_NAN,
     .optional = "outputs", .some = 'p'},
    {"", PART, RITZ_AT(ritz_state_space, columns),
     .schema = &ritz_schema_columns},
    {"estimates", PART, RITZ_AT(ritz_state_space, estimates), .optional = "",
     .some = 'k', .schema = &ritz_schema_measures},
    {"errors", PART, RITZ_AT(ritz_state_space, errors), .optional = "",
     .some = 'k', .schema = &ritz_schema_measures},
    {0},
};

const ritz_schema ritz_schema_state_space = {
    .name = "state-space",
    .units = offsetof(ritz_state_space, units),
    .sizes = {{'r', .offset = offsetof(ritz_state_space, B.nrow), "B"},
              {'m', .offset = offsetof(ritz_state_space, num_inputs),
               "inputs/names"},
              {'p', .offset = offsetof(ritz_state_space, num_outputs),
               "outputs/names"},
              {'n', .count = count_no_dofs}},
    .members = members,
    .check = check_model,
    .settle = settle_state_space,
};
