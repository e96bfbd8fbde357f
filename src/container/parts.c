/* Members that several kinds of container share. */
#include "container/schema.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>

/* Grids. */

static ritz_status settle_grids(const ritz_place *place)
{
    const ritz_grids *grids = place->target;

    RITZ_REFUSE_IF(grids->num_frames < 1, RITZ_ERR_FORMAT,
                   "'frames' is not f x 3 x 3");
    for (int64_t k = 1; k < grids->count; k++)
        RITZ_REFUSE_IF(grids->id[k - 1] >= grids->id[k], RITZ_ERR_FORMAT,
                       "'id' does not ascend at grid %" PRId64, grids->id[k]);
    for (int k = 0; k < 9; k++)
        RITZ_REFUSE_IF(fabs(grids->axes[k] - (k % 4 == 0 ? 1.0 : 0.0)) > 0.0,
                       RITZ_ERR_FORMAT, "frame 0 is not the basic frame");
    return RITZ_OK;
}

static const ritz_member grids_members[] = {
    {"id", SET_WHOLE, RITZ_AT(ritz_grids, id), "g",
     "numbers of the grids, ascending"},
    {"position", SET_REAL, RITZ_AT(ritz_grids, position), "g 3",
     "position of each grid in the basic frame"},
    {"frame", SET_WHOLE, RITZ_AT(ritz_grids, frame), "g",
     "index in `frames` of the axes along which the displacements of each grid "
     "are measured",
     "0..f-1"},
    {"frames", SET_REAL, RITZ_AT(ritz_grids, axes), "f 3 3",
     "`frames[k, i]` is displacement axis i in basic axes; `frames[0]` is the "
     "identity"},
    {0},
};

const ritz_schema ritz_schema_grids = {
    .name = "grids",
    .shared = "grids/",
    .sizes = {{'g', .offset = offsetof(ritz_grids, count), "id"},
              {'f', .offset = offsetof(ritz_grids, num_frames), "frames"}},
    .members = grids_members,
    .settle = settle_grids,
};

/* Elements. */

static int64_t count_nodes(const void *object)
{
    const ritz_elements *elements = object;

    return elements->first ? elements->first[elements->count] : 0;
}

static ritz_status settle_elements(const ritz_place *place)
{
    const ritz_elements *elements = place->target;

    RITZ_REFUSE_IF(elements->count == 0, RITZ_ERR_FORMAT,
                   "'first' has 1 values for 0 elements");
    for (int64_t k = 0; k < elements->count; k++)
        RITZ_REFUSE_IF(elements->first[k + 1] < elements->first[k],
                       RITZ_ERR_FORMAT, "'first' does not ascend");
    return RITZ_OK;
}

static const ritz_member elements_members[] = {
    {"kind", SET_WHOLE, RITZ_AT(ritz_elements, kind), "e",
     "type of cell, as VTK numbers it", "1.."},
    {"first", SET_WHOLE, RITZ_AT(ritz_elements, first), "e+1",
     "element k has the grids `grids[first[k]:first[k + 1]]`", "0.."},
    {"grids", SET_WHOLE, RITZ_AT(ritz_elements, grid), "t",
     "numbers of the grids of each element, in VTK's order; all are in "
     "`grids/id`"},
    {"id", SET_WHOLE, RITZ_AT(ritz_elements, id), "e",
     "number of each element in its deck", .optional = ""},
    {0},
};

const ritz_schema ritz_schema_elements = {
    .name = "elements",
    .shared = "elements/",
    .sizes = {{'e', .offset = offsetof(ritz_elements, count), "kind"},
              {'t', .count = count_nodes}},
    .members = elements_members,
    .settle = settle_elements,
};

/* Dofs that constraints eliminated. */

static ritz_status settle_recovery(const ritz_place *place)
{
    const ritz_recovery *recovery = place->target;

    RITZ_REFUSE_IF(recovery->count == 0, RITZ_ERR_FORMAT, "it names no dofs");
    return RITZ_OK;
}

static const ritz_member recovery_members[] = {
    {"grid", SET_WHOLE, RITZ_ITEM(ritz_recovery, dof, ritz_dof, grid), "d",
     "grid of each dof that constraints eliminated"},
    {"component", SET_WHOLE, RITZ_ITEM(ritz_recovery, dof, ritz_dof, component),
     "d", "direction of each of these dofs, as in `dofs`", "0..6"},
    {"G", MATRIX_SPARSE, RITZ_AT(ritz_recovery, G), "d n",
     "u(recovery) = G u, where u are the dofs that `dofs` names"},
    {0},
};

const ritz_schema ritz_schema_recovery = {
    .name = "recovery",
    .shared = "recovery/",
    .sizes = {{'d', .offset = offsetof(ritz_recovery, count), "grid"}},
    .members = recovery_members,
    .settle = settle_recovery,
};

/* Dampers. */

static ritz_status settle_dampers(const ritz_place *place)
{
    return ritz_dampers_check(place->target, ritz_schema_size(place, 'c'));
}

static const ritz_member dampers_members[] = {
    {"names", SET_WORDS, RITZ_AT(ritz_dampers, name), "d",
     "distinct names of the dampers; `body/damper` in systems"},
    {"c", SET_REAL, RITZ_AT(ritz_dampers, c), "d",
     "damping constant: each damper adds c b b' to D; not negative"},
    {"k", SET_REAL, RITZ_AT(ritz_dampers, k), "d",
     "stiffness: each damper adds k b b' to K"},
    {"held_c", SET_REAL, RITZ_AT(ritz_dampers, held_c), "d",
     "part of c that `D` already contains: 0 in components and reduced "
     "components, c in systems"},
    {"held_k", SET_REAL, RITZ_AT(ritz_dampers, held_k), "d",
     "part of k that `K` already contains"},
    {"B", MATRIX_DENSE, RITZ_AT(ritz_dampers, B), "c d",
     "influence vectors b, as columns"},
    {0},
};

const ritz_schema ritz_schema_dampers = {
    .name = "dampers",
    .shared = "dampers/",
    .sizes = {{'d', .offset = offsetof(ritz_dampers, count), "names"}},
    .members = dampers_members,
    .settle = settle_dampers,
};

/* Inputs and outputs. */

/* Matrices without columns or rows, and empty lists, where there are none. */
static ritz_status settle_io(const ritz_place *place)
{
    ritz_io *io = place->target;
    int64_t n = ritz_schema_size(place, 'c');

    if (!io->B.val) {
        RITZ_CHECK_NEW(io->input, 0);
        RITZ_CHECK(ritz_dense_new(n, 0, &io->B));
    }
    if (!io->C.val) {
        RITZ_CHECK_NEW(io->output, 0);
        RITZ_CHECK_NEW(io->limit, 0);
        RITZ_CHECK(ritz_dense_new(0, n, &io->C));
        RITZ_CHECK(ritz_dense_new(0, n, &io->Cv));
        RITZ_CHECK(ritz_dense_new(0, n, &io->Ca));
    }
    return RITZ_OK;
}

static const ritz_member io_members[] = {
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_io, input), "m",
     "distinct names of the inputs", .optional = "inputs", .some = 'm'},
    {"inputs/B", MATRIX_DENSE, RITZ_AT(ritz_io, B), "c m",
     "input matrix: M x'' + D x' + K x = B u", .optional = "inputs",
     .some = 'm'},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_io, output), "p",
     "distinct names of the outputs", .optional = "outputs", .some = 'p'},
    {"outputs/C", MATRIX_DENSE, RITZ_AT(ritz_io, C), "p c",
     "output matrix of displacements: y = C x + Cv x' + Ca x''",
     .optional = "outputs", .some = 'p'},
    {"outputs/Cv", MATRIX_DENSE, RITZ_AT(ritz_io, Cv), "p c",
     "output matrix of velocities", .optional = "outputs", .some = 'p'},
    {"outputs/Ca", MATRIX_DENSE, RITZ_AT(ritz_io, Ca), "p c",
     "output matrix of accelerations", .optional = "outputs", .some = 'p'},
    {"outputs/limits", SET_REAL, RITZ_AT(ritz_io, limit), "p",
     "largest tolerated \\|y\\| of each output", .values = VALUES_OR_NAN,
     .optional = "outputs", .some = 'p'},
    {0},
};

const ritz_schema ritz_schema_io = {
    .name = "inputs and outputs",
    .shared = "",
    .sizes = {{'m', .offset = offsetof(ritz_io, num_inputs), "inputs/names"},
              {'p', .offset = offsetof(ritz_io, num_outputs), "outputs/names"}},
    .members = io_members,
    .settle = settle_io,
};

/* Columns of a basis. */

static bool has_error(const void *object)
{
    const ritz_columns *columns = object;

    for (int64_t j = 0; columns->error && j < columns->count; j++)
        if (!isnan(columns->error[j]))
            return true;
    return false;
}

static const ritz_member columns_members[] = {
    {"columns/kind", SET_COLUMN_KINDS, RITZ_AT(ritz_columns, kind), "r",
     "kind of each column: rigid, constraint, normal, residual, system, "
     "krylov, static, "
     "attachment, interface, massless, force, state, perturbed, balanced"},
    {"columns/dof", SET_WHOLE, RITZ_AT(ritz_columns, dof), "r",
     "row of the full component whose unit motion or unit force defines the "
     "column; -1: the column has none",
     "-1..n-1"},
    {"columns/hertz", SET_REAL, RITZ_AT(ritz_columns, hertz), "r",
     "frequency of a column that is a mode", .values = VALUES_OR_NAN},
    {"residuals", SET_REAL, RITZ_AT(ritz_columns, residual), "r",
     "relative residual of a column that is an eigenvector",
     .values = VALUES_OR_NAN},
    {"error_bounds", SET_REAL, RITZ_AT(ritz_columns, error), "r",
     "of engines that find modes approximately: bound of the relative error of "
     "the eigenvalue (2 pi hertz)^2, which is too high by no more; of a rigid "
     "motion relative to the first flexible eigenvalue",
     .values = VALUES_OR_NAN, .optional = "", .has = has_error},
    {0},
};

const ritz_schema ritz_schema_columns = {
    .name = "columns",
    .shared = "",
    .sizes = {{'r', .offset = offsetof(ritz_columns, count), "^"}},
    .members = columns_members,
};

/* How a basis was made. */

static const ritz_member origin_members[] = {
    {"method", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_origin, method), "",
     "method that made the basis"},
    {"options", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_origin, options), "",
     "options of the method, as given"},
    {"reference", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_origin, reference), "",
     "key of the method's source in `references.bib`"},
    {"engine", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_origin, engine), "",
     "libraries that computed the basis"},
    {0},
};

const ritz_schema ritz_schema_origin = {
    .name = "origin",
    .shared = "",
    .members = origin_members,
};

/* Measures. */

/* An infinite value is a bound that bounds nothing. */
static ritz_status settle_measures(const ritz_place *place)
{
    const ritz_measures *measures = place->target;
    ritz_name name = "";

    for (int64_t k = 0; k < measures->count; k++) {
        const ritz_measure *item = &measures->item[k];

        RITZ_REFUSE_IF(isnan(item->value) || item->value == -HUGE_VAL,
                       RITZ_ERR_FORMAT, "value %" PRId64 " of 'value' is none",
                       k + 1);
        RITZ_CHECK(ritz_name_copy(item->name, name));
    }
    return RITZ_OK;
}

static bool has_cause(const void *object)
{
    const ritz_measures *measures = object;

    for (int64_t k = 0; k < measures->count; k++)
        if (measures->item[k].cause[0])
            return true;
    return false;
}

static const ritz_member measures_members[] = {
    {"name", SET_WORDS, RITZ_ITEM(ritz_measures, item, ritz_measure, name), "k",
     "name of each measure, such as `frequency-relative`; the group "
     "`estimates` has the same members"},
    {"value", SET_REAL, RITZ_ITEM(ritz_measures, item, ritz_measure, value),
     "k", "value of each measure; infinite for a bound that bounds nothing",
     .values = VALUES_ANY},
    {"limit", SET_REAL, RITZ_ITEM(ritz_measures, item, ritz_measure, limit),
     "k", "requested tolerance", .values = VALUES_OR_NAN},
    {"where", SET_WORDS, RITZ_ITEM(ritz_measures, item, ritz_measure, where),
     "k", "mode, channel or frequency where it was found; may be empty"},
    {"cause", SET_WORDS, RITZ_ITEM(ritz_measures, item, ritz_measure, cause),
     "k",
     "why a bound is more than ten times what is known of the error, such as "
     "`rounding`; empty where it is not",
     .optional = "", .has = has_cause},
    {0},
};

const ritz_schema ritz_schema_measures = {
    .name = "measures",
    .shared = "errors/",
    .sizes = {{'k', .offset = offsetof(ritz_measures, count), "name"}},
    .members = measures_members,
    .settle = settle_measures,
};
