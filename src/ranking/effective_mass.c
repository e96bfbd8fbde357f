/*
 * Effective masses: with mass-normalised modes and rigid motions r_d of all of
 * the model, three translations and three rotations about the basic origin,
 *
 *     m_kd = (phi_k' M r_d)^2,    sum_k m_kd = r_d' M r_d
 *
 * over all modes of a model that is held. They say what mass a mode takes along
 * when its support is shaken. The value of a mode is its largest share,
 * max_d m_kd / r_d' M r_d.
 *
 * [Girard2008]
 */
#include "ranking/costs.h"
#include "ranking/mass.h"

#include <math.h>

/* Shares below this are rounding: rigid modes carry what there is. */
static const double nothing = 1e-9;

ritz_status ritz_mass_parts(const ritz_rank_request *request,
                            ritz_ranking *ranking)
{
    static const char *const direction[RITZ_MASS_PARTS] = {
        "x", "y", "z", "about x", "about y", "about z"};
    const ritz_dense *L = &request->momentum;

    RITZ_CHECK(ritz_ranking_parts(RITZ_MASS_PARTS, ranking));
    for (int64_t d = 0; d < RITZ_MASS_PARTS; d++) {
        RITZ_CHECK(ritz_name_copy(direction[d], ranking->part[d]));
        ranking->whole[d] = request->rigid[7 * d];
        for (int64_t k = 0; k < L->ncol; k++) {
            double l = ritz_dense_col(L, k)[d];

            ritz_dense_col(&ranking->parts, d)[k] = l * l;
        }
    }
    return RITZ_OK;
}

/* Largest share of mode k; of a cluster the parts are summed up before. */
static double share(const ritz_ranking *ranking, int64_t first, int64_t last)
{
    double largest = 0.0;

    for (int64_t d = 0; d < ranking->num_parts; d++) {
        double sum = 0.0;

        for (int64_t k = first; k < last; k++)
            sum += ritz_dense_col(&ranking->parts, d)[k];
        if (ranking->whole[d] > 0.0)
            largest = fmax(largest, sum / ranking->whole[d]);
    }
    return largest;
}

static ritz_status rank(const ritz_rank_request *request, ritz_ranking *ranking)
{
    int64_t m = request->modal.count;
    int64_t last = 0;
    double largest = 0.0;

    RITZ_CHECK(ritz_mass_parts(request, ranking));
    ritz_ranking_clusters(&request->modal, ranking->cluster);
    for (int64_t first = 0; first < m; first = last) {
        for (last = first + 1; last < m && ranking->cluster[last] == first;)
            last++;
        for (int64_t k = first; k < last; k++)
            ranking->value[k] = share(ranking, first, last);
        largest = fmax(largest, ranking->value[first]);
    }
    RITZ_REFUSE_IF(
        !(largest > nothing), RITZ_ERR_ARGUMENT,
        "rigid modes carry all of the mass of a free model, flexible ones "
        "none: hold it, or take effective-interface-mass of fixed-interface "
        "modes");
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_effective_mass = {
    .name = "effective-mass",
    .summary = "largest share of the mass, in six rigid directions",
    .reference = "Girard2008",
    .needs = RITZ_RANK_MOMENTUM,
    .rank = rank,
};
