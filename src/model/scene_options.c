/* What a scene says once: band, damping, selection, augmentation. */
#include "model/scene_parts.h"

#include <ritz/ranking.h>

#include <inttypes.h>

ritz_status ritz_scene_band(const ritz_yaml *yaml, const yaml_node_t *node,
                            void *field)
{
    ritz_status status = RITZ_OK;
    double *band = (double *)field;

    RITZ_TRY(ritz_yaml_reals(yaml, node, 2, band));
    RITZ_REFUSE_IF(!(band[0] >= 0.0 && band[1] > band[0]), yaml, node,
                   "the band %g to %g Hz does not ascend from 0 or above",
                   band[0], band[1]);
done:
    return status;
}

static ritz_status take_modal(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    ritz_status status = RITZ_OK;
    ritz_damping *damping = (ritz_damping *)field;

    damping->kind = RITZ_DAMPING_MODAL;
    RITZ_TRY(ritz_yaml_real(yaml, node, &damping->zeta));
    RITZ_TRY(ritz_yaml_at(yaml, node, ritz_damping_check(damping)));
done:
    return status;
}

static ritz_status take_bands(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    ritz_status status = RITZ_OK;
    ritz_damping *damping = (ritz_damping *)field;
    int64_t count = 0;

    damping->kind = RITZ_DAMPING_BANDS;
    RITZ_TRY(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_IF(count < 1 || count > RITZ_MAX_BANDS, yaml, node,
                   "1 to %d bands can be given, not %" PRId64, RITZ_MAX_BANDS,
                   count);
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);

        RITZ_TRY(ritz_yaml_reals(yaml, item, 3, damping->band[k]));
        damping->count = k + 1;
        RITZ_TRY(ritz_yaml_at(yaml, item, ritz_damping_check(damping)));
    }
done:
    return status;
}

static ritz_status take_rayleigh(const ritz_yaml *yaml, const yaml_node_t *node,
                                 void *field)
{
    ritz_status status = RITZ_OK;
    ritz_damping *damping = (ritz_damping *)field;
    double number[2] = {0.0};

    RITZ_TRY(ritz_yaml_reals(yaml, node, 2, number));
    *damping = (ritz_damping){
        .kind = RITZ_DAMPING_RAYLEIGH, .a = number[0], .b = number[1]};
    RITZ_TRY(ritz_yaml_at(yaml, node, ritz_damping_check(damping)));
done:
    return status;
}

static const ritz_yaml_key damping_keys[] = {
    {"modal", false, take_modal, 0},
    {"bands", false, take_bands, 0},
    {"rayleigh", false, take_rayleigh, 0},
};

ritz_status ritz_scene_damping(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    enum { NUM_KEYS = sizeof damping_keys / sizeof *damping_keys };
    ritz_status status = RITZ_OK;
    const yaml_node_t *value[NUM_KEYS];
    int64_t count = 0;

    RITZ_TRY(ritz_yaml_pairs(yaml, node, &count));
    RITZ_REFUSE_IF(count != 1, yaml, node,
                   "damping is one of modal, bands and rayleigh");
    RITZ_TRY(
        ritz_yaml_mapping(yaml, node, NUM_KEYS, damping_keys, field, value));
done:
    return status;
}

static ritz_status take_ranking(const ritz_yaml *yaml, const yaml_node_t *node,
                                void *field)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_yaml_name(yaml, node, field));
    if (!ritz_ranker_find((const char *)field))
        status = ritz_yaml_at(yaml, node, RITZ_ERR_ARGUMENT);
done:
    return status;
}

static const ritz_yaml_key select_keys[] = {
    {"by", false, take_ranking, offsetof(ritz_scene, select_by)},
    {"tolerance", false, ritz_yaml_fraction,
     offsetof(ritz_scene, select_tolerance)},
};

ritz_status ritz_scene_select(const ritz_yaml *yaml, const yaml_node_t *node,
                              void *field)
{
    enum { NUM_KEYS = sizeof select_keys / sizeof *select_keys };
    const yaml_node_t *value[NUM_KEYS];

    return ritz_yaml_mapping(yaml, node, NUM_KEYS, select_keys, field, value);
}

ritz_status ritz_scene_augment(const ritz_yaml *yaml, const yaml_node_t *node,
                               void *field)
{
    enum { COMPONENT = 2, NUM_WORDS };
    static const char words[NUM_WORDS][16] = {
        [RITZ_AUGMENT_NONE] = "none",
        [RITZ_AUGMENT_SYSTEM] = "system",
        [COMPONENT] = "component",
    };
    ritz_status status = RITZ_OK;
    ritz_names names = {"augmentation", NUM_WORDS, words[0], sizeof *words};
    int64_t at = 0;

    RITZ_TRY(ritz_yaml_word(yaml, node, &names, &at));
    RITZ_REFUSE_IF(at == COMPONENT, yaml, node,
                   "augmentation of each component comes with a later release, "
                   "there is system and none");
    *(ritz_augment *)field = (ritz_augment)at;
done:
    return status;
}
