/* What a scene says once of the whole: band and damping. */
#include "scene/scene_parts.h"

#include <inttypes.h>

ritz_status ritz_scene_band(const ritz_yaml *yaml, const yaml_node_t *node,
                            void *field)
{
    double *band = (double *)field;

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 2, band));
    RITZ_REFUSE_AT(!(band[0] >= 0.0 && band[1] > band[0]), yaml, node,
                   "the band %g to %g Hz does not ascend from 0 or above",
                   band[0], band[1]);
    return RITZ_OK;
}

static ritz_status take_modal(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    ritz_damping *damping = (ritz_damping *)field;

    damping->kind = RITZ_DAMPING_MODAL;
    RITZ_CHECK(ritz_yaml_real(yaml, node, &damping->zeta));
    return ritz_yaml_at(yaml, node, ritz_damping_check(damping));
}

static ritz_status take_bands(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    ritz_damping *damping = (ritz_damping *)field;
    int64_t count = 0;

    damping->kind = RITZ_DAMPING_BANDS;
    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < 1 || count > RITZ_MAX_BANDS, yaml, node,
                   "1 to %d bands can be given, not %" PRId64, RITZ_MAX_BANDS,
                   count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);

        RITZ_CHECK(ritz_yaml_reals(yaml, item, 3, damping->band[k]));
        damping->count = k + 1;
        RITZ_CHECK(ritz_yaml_at(yaml, item, ritz_damping_check(damping)));
    }
    return RITZ_OK;
}

static ritz_status take_rayleigh(const ritz_yaml *yaml, const yaml_node_t *node,
                                 void *field)
{
    ritz_damping *damping = (ritz_damping *)field;
    double number[2] = {0.0};

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 2, number));
    *damping = (ritz_damping){
        .kind = RITZ_DAMPING_RAYLEIGH, .a = number[0], .b = number[1]};
    return ritz_yaml_at(yaml, node, ritz_damping_check(damping));
}

static ritz_status take_modes(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    ritz_damping *damping = (ritz_damping *)field;

    damping->kind = RITZ_DAMPING_MODES;
    RITZ_CHECK(ritz_yaml_list(yaml, node, &damping->count));
    RITZ_REFUSE_AT(damping->count < 1 || damping->count > RITZ_MOST_RATIOS,
                   yaml, node,
                   "1 to %d ratios of modes can be given, not %" PRId64,
                   RITZ_MOST_RATIOS, damping->count);
    RITZ_CHECK(ritz_yaml_reals(yaml, node, damping->count, damping->ratio));
    return ritz_yaml_at(yaml, node, ritz_damping_check(damping));
}

static ritz_status take_fit(const ritz_yaml *yaml, const yaml_node_t *node,
                            void *field)
{
    ritz_damping *damping = (ritz_damping *)field;

    damping->kind = RITZ_DAMPING_FIT;
    RITZ_CHECK(ritz_yaml_list(yaml, node, &damping->count));
    RITZ_REFUSE_AT(damping->count < 2 || damping->count > RITZ_MOST_POINTS,
                   yaml, node,
                   "2 to %d points of a fit can be given, not %" PRId64,
                   RITZ_MOST_POINTS, damping->count);
    for (int64_t k = 0; k < damping->count; k++)
        RITZ_CHECK(ritz_yaml_reals(yaml, ritz_yaml_item(yaml, node, k), 2,
                                   damping->point[k]));
    RITZ_CHECK(ritz_yaml_at(yaml, node, ritz_damping_check(damping)));
    ritz_damping_fit(damping);
    return RITZ_OK;
}

static const ritz_yaml_key damping_keys[] = {
    {"modal", false, take_modal, 0},      {"modes", false, take_modes, 0},
    {"bands", false, take_bands, 0},      {"rayleigh", false, take_rayleigh, 0},
    {"rayleigh_fit", false, take_fit, 0},
};

ritz_status ritz_scene_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    enum { NUM_KEYS = sizeof damping_keys / sizeof *damping_keys };
    const yaml_node_t *value[NUM_KEYS];
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_pairs(yaml, node, &count));
    RITZ_REFUSE_AT(count != 1, yaml, node,
                   "damping is one of modal, modes, bands, rayleigh and "
                   "rayleigh_fit");
    return ritz_yaml_mapping(yaml, node, NUM_KEYS, damping_keys, field, value);
}
