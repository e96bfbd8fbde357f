/* Containers of frequency responses. */
#include "container/schema.h"

#include <inttypes.h>
#include <math.h>

static bool has_peak(const void *object)
{
    const ritz_response *response = object;

    return response->num_singular > 0 && response->singular_peak[1] > 0.0;
}

static bool has_interpolation(const void *object)
{
    return ((const ritz_response *)object)->interpolation[0];
}

static ritz_status settle_response(const ritz_place *place)
{
    const ritz_response *r = place->target;
    const double *peak = r->singular_peak;
    int64_t fewer =
        r->num_outputs < r->num_inputs ? r->num_outputs : r->num_inputs;

    for (int64_t k = 1; k < r->count; k++)
        RITZ_REFUSE_IF(r->hertz[k] < r->hertz[k - 1], RITZ_ERR_FORMAT,
                       "'hertz' descends at value %" PRId64, k + 1);
    RITZ_REFUSE_IF(!(r->tolerance >= 0.0) || !(r->tolerance < 1.0),
                   RITZ_ERR_FORMAT, "'tolerance' is %g, not between 0 and 1",
                   r->tolerance);
    RITZ_REFUSE_IF(r->singular && r->num_singular != fewer, RITZ_ERR_FORMAT,
                   "'singular_values' is not hertz x the fewer of outputs and "
                   "inputs");
    RITZ_REFUSE_IF(
        H5Aexists(place->at, "singular_peak") > 0 &&
            (!(peak[0] >= 0.0) || isinf(peak[0]) || !(peak[1] > 0.0)),
        RITZ_ERR_FORMAT,
        "'singular_peak' is no frequency and no value above 0");
    return RITZ_OK;
}

/* Real (0) or imaginary part (1) of each value: re, im, ... (C 6.2.5). */
#define RITZ_COMPLEX(type, field, part)                                        \
    .offset = offsetof(type, field), .size = sizeof(double _Complex),          \
    .item = (part) * sizeof(double)

static const ritz_size sizes[] = {
    {'k', .offset = offsetof(ritz_response, count), "hertz"},
    {'m', .offset = offsetof(ritz_response, num_inputs), "inputs/names"},
    {'p', .offset = offsetof(ritz_response, num_outputs), "outputs/names"},
    {'s', .offset = offsetof(ritz_response, num_singular), "singular_values"},
    {0},
};

static const ritz_member members[] = {
    {"method", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, method), "",
     "engine that computed the response"},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, damping), "",
     "damping, as `--damping` reads it; may be empty"},
    {"hertz", SET_REAL, RITZ_AT(ritz_response, hertz), "k",
     "frequencies, not descending"},
    {"inputs/names", SET_NAMES, RITZ_AT(ritz_response, input), "m",
     "distinct names of the inputs"},
    {"outputs/names", SET_NAMES, RITZ_AT(ritz_response, output), "p",
     "distinct names of the outputs"},
    {"H/real", SET_REAL, RITZ_COMPLEX(ritz_response, H, 0), "k p m",
     "real part of each entry of H"},
    {"H/imag", SET_REAL, RITZ_COMPLEX(ritz_response, H, 1), "k p m",
     "imaginary part of each entry of H"},
    {"interpolation", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_response, interpolation),
     "", "`cubic`: the points were chosen for cubic interpolation",
     .optional = "", .has = has_interpolation},
    {"tolerance", ATTRIBUTE_REAL, RITZ_AT(ritz_response, tolerance), "",
     "present with `interpolation`: its error, relative to the largest \\|H\\| "
     "of each channel",
     .values = VALUES_ANY, .has = has_interpolation},
    {"singular_values", SET_REAL, RITZ_AT(ritz_response, singular), "k s",
     "singular values of H with the requested scales, descending",
     .optional = "", .some = 's'},
    {"singular_peak", ATTRIBUTE_REAL, RITZ_AT(ritz_response, singular_peak),
     "2",
     "frequency in Hz and value of the largest singular value, also between "
     "the points; infinite at an undamped pole",
     .values = VALUES_ANY, .optional = "", .has = has_peak},
    {0},
};

const ritz_schema ritz_schema_response = {
    .name = "response",
    .sizes = sizes,
    .members = members,
    .settle = settle_response,
};
