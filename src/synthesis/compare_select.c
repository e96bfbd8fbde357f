/*
 * Which system modes matter. Values of all configurations are held against one
 * largest value, so that a mode that matters at one angle alone is kept for it.
 */
#include "base/alloc.h"
#include "synthesis/compare_parts.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Values of the flexible modes of one configuration. */
static ritz_status rank_one(const ritz_scene *scene,
                            const ritz_configuration *c, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    const ritz_ranker *ranker = ritz_ranker_find(scene->select_by);
    ritz_modal modal = {0};

    if (!ranker) {
        status = RITZ_ERR_ARGUMENT;
        goto done;
    }
    RITZ_TRY(ritz_modal_new(&c->K, &c->M, c->D.val ? &c->D : NULL, &c->io,
                            &scene->damping, &modal));
    RITZ_TRY(ritz_rank(ranker, &modal, ranking));
    RITZ_FAIL_IF(ranking->count != c->K.ncol - c->num_rigid,
                 RITZ_ERR_CONVERGENCE,
                 "%" PRId64 " flexible modes were ranked where there are "
                 "%" PRId64,
                 ranking->count, c->K.ncol - c->num_rigid);
done:
    ritz_modal_free(&modal);
    return ritz_context(status, c->at);
}

/* Keep the modes whose value reaches `least`. */
static ritz_status keep(int64_t count, const double *value, double least,
                        ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(row->kept, count);
    for (int64_t k = 0; k < count; k++)
        if (value[k] >= least)
            row->kept[row->num_kept++] = k;
done:
    return status;
}

static ritz_status select_by_rank(const ritz_scene *scene,
                                  const ritz_system *system,
                                  ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;
    int64_t count = system->num_configurations;
    ritz_ranking *ranking = NULL;
    double largest = 0.0;

    RITZ_NEW(ranking, count);
    for (int64_t k = 0; k < count; k++) {
        RITZ_TRY(rank_one(scene, &system->configuration[k], &ranking[k]));
        for (int64_t j = 0; j < ranking[k].count; j++)
            largest = fmax(largest, ranking[k].value[j]);
    }
    RITZ_FAIL_IF(largest <= 0.0, RITZ_ERR_ARGUMENT,
                 "no flexible mode answers any input at any output, so none "
                 "can be chosen");
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(keep(ranking[k].count, ranking[k].value,
                      scene->select_tolerance * largest, &row[k]));
done:
    for (int64_t k = 0; ranking && k < count; k++)
        ritz_ranking_free(&ranking[k]);
    free(ranking);
    return status;
}

static ritz_status select_by_band(const ritz_scene *scene,
                                  const ritz_system *system,
                                  ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;
    double highest = ritz_eigen_lambda(scene->band_hz[1]);

    RITZ_FAIL_IF(scene->band_hz[1] <= 0.0, RITZ_ERR_ARGUMENT,
                 "the scene has neither inputs and outputs to rank modes by "
                 "nor a band to keep");
    for (int64_t k = 0; k < system->num_configurations; k++) {
        const ritz_configuration *c = &system->configuration[k];

        RITZ_NEW(row[k].kept, c->K.ncol);
        for (int64_t j = c->num_rigid; j < c->K.ncol; j++)
            if (c->lambda[j] <= highest)
                row[k].kept[row[k].num_kept++] = j - c->num_rigid;
    }
done:
    return status;
}

ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_system *system,
                                ritz_compare_row *row)
{
    bool ranked = scene->num_inputs > 0 && scene->num_outputs > 0;

    return ranked ? select_by_rank(scene, system, row)
                  : select_by_band(scene, system, row);
}
