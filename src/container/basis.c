/* Containers of bases. */
#include "container/schema.h"

/* Bases of states, and those with left vectors, store their damping. */
static bool has_damping(const void *object)
{
    const ritz_basis *basis = object;

    return basis->states || basis->W.val;
}

static bool has_among(const void *object)
{
    const ritz_basis *basis = object;

    return has_damping(basis) && basis->among_hz > 0.0;
}

static ritz_status settle_basis(const ritz_place *place)
{
    const ritz_basis *basis = place->target;

    for (int64_t k = 0; k < basis->num_hankel; k++)
        RITZ_REFUSE_IF(basis->hankel[k] < 0.0 ||
                           (k > 0 && basis->hankel[k] > basis->hankel[k - 1]),
                       RITZ_ERR_FORMAT, "'hankel' does not descend to zero");
    RITZ_REFUSE_IF(basis->bound < 0.0, RITZ_ERR_FORMAT,
                   "'bound' is %g, which bounds no error", basis->bound);
    return RITZ_OK;
}

static const ritz_member members[] = {
    {"", PART, RITZ_AT(ritz_basis, origin), .schema = &ritz_schema_origin},
    {"T", MATRIX_DENSE, RITZ_AT(ritz_basis, T), "n r",
     "u = T q; in a basis of states [u; u'] = T z, with 2n rows"},
    {"W", MATRIX_DENSE, RITZ_AT(ritz_basis, W), "n r",
     "left vectors, as many and as long as those of T", .optional = ""},
    {"hankel", SET_REAL, RITZ_AT(ritz_basis, hankel), "h",
     "Hankel values of the balanced model, descending", .optional = "",
     .some = 'h'},
    {"bound", ATTRIBUTE_REAL, RITZ_AT(ritz_basis, bound), "",
     "present with `hankel`: bound of the H-infinity norm of the error, with "
     "outputs divided by their limits",
     .values = VALUES_OR_NAN, .some = 'h'},
    {"states", ATTRIBUTE_FLAG, RITZ_AT(ritz_basis, states), "",
     "1 if it is a basis of states", .optional = ""},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_basis, damping), "",
     "present with `states` or `W`: damping with which the basis was made",
     .has = has_damping},
    {"among_hz", ATTRIBUTE_REAL, RITZ_AT(ritz_basis, among_hz), "",
     "all columns are combinations of the modes up to this frequency, and "
     "`damping` holds for these modes",
     .optional = "", .has = has_among},
    {"", PART, RITZ_AT(ritz_basis, columns), .schema = &ritz_schema_columns},
    {0},
};

const ritz_schema ritz_schema_basis = {
    .name = "basis",
    .units = offsetof(ritz_basis, units),
    .sizes = {{'n', .offset = offsetof(ritz_basis, T.nrow), "T"},
              {'r', .offset = offsetof(ritz_basis, T.ncol), "T"},
              {'h', .offset = offsetof(ritz_basis, num_hankel), "hankel"}},
    .members = members,
    .settle = settle_basis,
};
