/*
 * Which system modes matter. Values of all configurations are relative to one
 * largest value, so that a mode that matters at a single angle is kept for it.
 * A cluster is kept whole, however its members were chosen: its modes are an
 * arbitrary basis of one space, and a subset of them is no property of the
 * system.
 */
#include "base/tolerances.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/team.h"
#include "compare/compare.h"
#include "linear/orthonormal.h"
#include "model/pair.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Krylov vectors of a system at one configuration [McDaniel2000, eq. 3.2.15 to
 * 3.2.17]. In its modal coordinates M = I and K = diag(lambda), so that the
 * flexible part has the blocks
 *
 *     V_1 = Lambda^-1 R,    V_{j+1} = Lambda^-1 V_j,    R = B or [B, C']
 *
 * each block made K-orthonormal to all before it, twice, and dependent columns
 * left out. Galerkin's projection on j blocks keeps the first j of the moments
 * C Lambda^-i-1 B, and the first 2j if outputs start the block too, since then
 * C Lambda^-i and Lambda^-i B are both spanned.
 *
 * An output of velocity or acceleration adds its own rows to the first block.
 */

/* v = Lambda^-1 r, where r is a column, or a row of a matrix with a stride. */
static void divide_by_lambda(const ritz_configuration *c, const double *r,
                             int64_t stride, double *v)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        v[k] = r[k * stride] / c->lambda[k];
}

/*
 * Static solutions in modal coordinates, flexible part: Lambda^-1 B and, if @p
 * both, Lambda^-1 [C', Cv', Ca'] for unit forces where outputs measure.
 */
static ritz_status find_statics(const ritz_configuration *configuration,
                                bool both, ritz_dense *out)
{
    const ritz_configuration *c = configuration;
    const ritz_io *io = &c->io;
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t m = 0;

    RITZ_CHECK(ritz_dense_new(
        c->K.ncol, io->num_inputs + (both ? 3 * io->num_outputs : 0), out));
    for (int64_t j = 0; j < io->num_inputs; j++)
        divide_by_lambda(c, ritz_dense_col(&io->B, j), 1,
                         ritz_dense_col(out, m++));
    for (int k = 0; k < 3 && both; k++)
        for (int64_t i = 0; i < io->num_outputs; i++)
            divide_by_lambda(c, C[k]->val + i, io->num_outputs,
                             ritz_dense_col(out, m++));
    return RITZ_OK;
}

/* diag(Lambda), 0 for rigid modes: the inner product of the vectors. */
static ritz_status fill_weights(const ritz_configuration *c, ritz_sparse *out)
{
    RITZ_OWN(ritz_dense) Lambda = {0};

    RITZ_CHECK(ritz_dense_new(c->K.ncol, c->K.ncol, &Lambda));
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        ritz_dense_col(&Lambda, k)[k] = c->lambda[k];
    return ritz_sparse_from_dense(&Lambda, out);
}

/*
 * Append one block, up to `vectors` in all; says whether all new vectors fit.
 */
static ritz_status append_block(ritz_dense *W, int64_t vectors,
                                ritz_orthonormal *set, bool *fits)
{
    *fits = true;
    for (int64_t j = 0; j < W->ncol && *fits; j++) {
        ritz_dense column = ritz_dense_part(W, j, 1);

        RITZ_CHECK(
            ritz_orthonormal_append(set, &column, set->count < vectors, NULL));
        *fits = set->left == 0;
    }
    return RITZ_OK;
}

ritz_status ritz_system_krylov(const ritz_configuration *configuration,
                               int64_t vectors, bool both, ritz_dense *out,
                               int64_t *moments)
{
    const ritz_configuration *c = configuration;
    int64_t flexible = c->K.ncol - c->num_rigid;
    int64_t most = vectors < flexible ? vectors : flexible;
    int64_t first = 0, blocks = 0;
    RITZ_OWN(ritz_sparse) weights = {0};
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) W = {0};
    bool fits = false;

    RITZ_CHECK(fill_weights(c, &weights));
    RITZ_CHECK(ritz_orthonormal_new(c->K.ncol, &weights, RITZ_DEPENDENT, &set));
    RITZ_CHECK(find_statics(c, both, &W));
    RITZ_CHECK(append_block(&W, most, &set, &fits));
    while (fits) {
        blocks++;
        if (set.count == first) /* all further moments are kept as well */
            break;
        ritz_dense_free(&W);
        RITZ_CHECK(ritz_dense_columns(&set.V, first, set.count - first, &W));
        for (int64_t j = 0; j < W.ncol; j++)
            divide_by_lambda(c, ritz_dense_col(&W, j), 1,
                             ritz_dense_col(&W, j));
        first = set.count;
        RITZ_CHECK(append_block(&W, most, &set, &fits));
    }
    *moments = both ? 2 * blocks : blocks;
    return ritz_dense_columns(&set.V, 0, set.count, out);
}

/* Whether a configuration has what the ranking needs. */
static bool is_ranked(const ritz_scene *scene)
{
    const ritz_ranker *ranker = ritz_ranker_find(scene->select_by);
    int needs = ranker ? ranker->needs : RITZ_RANK_INPUTS | RITZ_RANK_OUTPUTS;

    return scene->select == RITZ_SELECT_RANKED &&
           (scene->num_inputs > 0 || !(needs & RITZ_RANK_INPUTS)) &&
           (scene->num_outputs > 0 || !(needs & RITZ_RANK_OUTPUTS));
}

/* Number of modes whose frequency is not that of the first mode of their
   cluster, which damping therefore coupled. */
static int64_t count_joined(const ritz_ranking *r)
{
    double gap = (double)r->count * RITZ_CLUSTER_GAP;
    int64_t count = 0;

    for (int64_t k = 0; k < r->count; k++)
        count += r->hertz[k] - r->hertz[r->cluster[k]] > gap * r->hertz[k];
    return count;
}

/* Put what one ranking says of the modes of one configuration into `value`. */
static ritz_status rank_modes(const ritz_scene *scene,
                              const ritz_configuration *c, double *value,
                              int64_t *joined)
{
    const ritz_ranker *ranker = ritz_ranker_find(scene->select_by);
    const ritz_rank_choice choice = {
        .damping = scene->damping,
        .band_hz = {scene->band_hz[0], scene->band_hz[1]}};
    int64_t flexible = c->K.ncol - c->num_rigid;
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_ranking) ranking = {0};

    if (!ranker)
        return RITZ_ERR_ARGUMENT;
    RITZ_CHECK(ritz_rank_request_of_configuration(c, &choice, ranker->needs,
                                                  &request));
    request.bare = true;
    RITZ_CHECK(ritz_rank(ranker, &request, &ranking));
    RITZ_REFUSE_IF(ranking.count != flexible, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " flexible modes were ranked where there are "
                   "%" PRId64,
                   ranking.count, flexible);
    for (int64_t k = 0; k < flexible; k++)
        value[k] = fabs(ranking.value[k]);
    if (joined)
        *joined = count_joined(&ranking);
    return RITZ_OK;
}

ritz_status ritz_compare_values(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                double *value, int64_t *joined)
{
    const ritz_configuration *c = configuration;

    for (int64_t k = 0; k < c->K.ncol - c->num_rigid; k++)
        value[k] = 1.0;
    if (!is_ranked(scene))
        return RITZ_OK;
    return ritz_context(rank_modes(scene, c, value, joined), c->at);
}

/* Values of the configurations of a system. */
typedef struct system_values {
    const ritz_scene *scene;
    const ritz_system *system;
    double *largest; /* value at each */
} system_values;

static ritz_status find_largest(int64_t k, void *task)
{
    const system_values *v = task;
    const ritz_configuration *c = &v->system->configuration[k];
    RITZ_OWN_ARRAY double *value = NULL;

    RITZ_CHECK_NEW(value, c->K.ncol - c->num_rigid);
    RITZ_CHECK(ritz_compare_values(v->scene, c, value, NULL));
    for (int64_t j = 0; j < c->K.ncol - c->num_rigid; j++)
        v->largest[k] = fmax(v->largest[k], value[j]);
    return RITZ_OK;
}

ritz_status ritz_compare_threshold(const ritz_stage *stage,
                                   const ritz_system *system, double *least)
{
    const ritz_scene *scene = stage->scene;
    const int64_t count = system->num_configurations;
    RITZ_OWN_ARRAY double *each = NULL;
    double largest = 0.0;

    *least = 0.0;
    if (!is_ranked(scene)) {
        RITZ_REFUSE_IF(scene->select == RITZ_SELECT_RANKED &&
                           scene->band_hz[1] <= 0.0,
                       RITZ_ERR_ARGUMENT,
                       "the scene has neither inputs and outputs to rank modes "
                       "by nor a band to keep");
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(each, count);
    RITZ_CHECK(ritz_team_try(ritz_stage_threads(stage, count), count,
                             find_largest,
                             &(system_values){scene, system, each}));
    for (int64_t k = 0; k < count; k++)
        largest = fmax(largest, each[k]);
    RITZ_REFUSE_IF(
        largest <= 0.0, RITZ_ERR_ARGUMENT,
        "no flexible mode is controllable by an input and observable "
        "at an output, so none can be chosen");
    *least = scene->select_tolerance * largest;
    return RITZ_OK;
}

/*
 * Mark the modes whose value is at least the threshold. Modes whose value
 * equals the least of these are marked as well, since rounding decides which of
 * equal values is above a threshold; their number is returned.
 */
static int64_t mark_ranked(int64_t flexible, const double *value, double least,
                           bool *taken)
{
    double last = HUGE_VAL;
    int64_t added = 0;

    for (int64_t k = 0; k < flexible; k++) {
        taken[k] = value[k] >= least;
        if (taken[k])
            last = fmin(last, value[k]);
    }
    for (int64_t k = 0; k < flexible; k++)
        if (!taken[k] && ritz_is_one_value(last, value[k])) {
            taken[k] = true;
            added++;
        }
    return added;
}

/* Store the pair with the largest value of which only one mode is kept. */
static void find_cut(const ritz_configuration *c, const double *value,
                     const bool *taken, ritz_compare_row *row)
{
    const double *lambda = c->lambda + c->num_rigid;
    const int64_t flexible = c->K.ncol - c->num_rigid;

    for (int64_t i = 0; i < flexible; i++)
        for (int64_t j = 0; taken[i] && j < flexible; j++) {
            const double hertz[] = {ritz_eigen_hertz(lambda[i]),
                                    ritz_eigen_hertz(lambda[j])};
            const double values[] = {value[i], value[j]};

            if (taken[j] || value[i] <= row->cut_value[0] ||
                !ritz_is_pair(hertz, values))
                continue;
            memcpy(row->cut_hertz, hertz, sizeof hertz);
            memcpy(row->cut_value, values, sizeof values);
        }
}

/* Values of all modes where modes are chosen by number, to find pairs of which
   one is left out. *ranked is false if there are no values, as without inputs,
   outputs or damping, or if they would be expensive, as with damping that
   couples modes. */
static ritz_status rank_listed(const ritz_scene *scene,
                               const ritz_configuration *c, double *value,
                               bool *ranked)
{
    ritz_scene by = *scene;
    ritz_status status = RITZ_OK;

    by.select = RITZ_SELECT_RANKED;
    *ranked = false;
    if (scene->select != RITZ_SELECT_LISTED || !is_ranked(&by) || c->D.val)
        return RITZ_OK;
    status = ritz_compare_values(&by, c, value, NULL);
    *ranked = status == RITZ_OK;
    return status == RITZ_ERR_ARGUMENT ? RITZ_OK : status;
}

/* Modes in the band; without inputs or outputs, those below its lower end. */
static void mark_band(const ritz_scene *scene, const ritz_configuration *c,
                      bool *taken)
{
    double lowest = scene->select == RITZ_SELECT_BAND
                        ? ritz_eigen_lambda(scene->band_hz[0])
                        : 0.0;
    double highest = ritz_eigen_lambda(scene->band_hz[1]);

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        taken[k - c->num_rigid] =
            c->lambda[k] >= lowest && c->lambda[k] <= highest;
}

static ritz_status mark_listed(const ritz_scene *scene,
                               const ritz_configuration *c, bool *taken)
{
    int64_t flexible = c->K.ncol - c->num_rigid;

    for (int64_t k = 0; k < scene->num_select_modes; k++) {
        int64_t mode = scene->select_mode[k];

        RITZ_REFUSE_IF(mode >= flexible, RITZ_ERR_ARGUMENT,
                       "mode %" PRId64 " is listed, and there are %" PRId64
                       " flexible modes%s%s",
                       mode + 1, flexible, *c->at ? " at " : "", c->at);
        taken[mode] = true;
    }
    return RITZ_OK;
}

/*
 * Take the rest of each cluster that has a mode taken; returns the number
 * added.
 */
static int64_t complete_clusters(const ritz_configuration *c, bool *taken)
{
    const double *lambda = c->lambda + c->num_rigid;
    int64_t flexible = c->K.ncol - c->num_rigid;
    int64_t added = 0;
    int64_t last = 0;

    for (int64_t first = 0; first < flexible; first = last) {
        bool any = taken[first];

        for (last = first + 1; last < flexible; last++) {
            double w = sqrt(lambda[last]);

            if (w - sqrt(lambda[last - 1]) > RITZ_CLUSTER_GAP * w)
                break;
            any = any || taken[last];
        }
        for (int64_t k = first; k < last; k++) {
            added += any && !taken[k];
            taken[k] = any;
        }
    }
    return added;
}

/*
 * Without modes: count the vectors that replace them and the moments they keep.
 */
static ritz_status count_vectors(const ritz_scene *scene,
                                 const ritz_configuration *c,
                                 ritz_compare_row *row)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_system_krylov(c, scene->select_vectors,
                                  scene->select_outputs, &X,
                                  &row->num_moments));
    row->num_vectors = X.ncol;
    RITZ_REFUSE_IF(
        X.ncol == 0, RITZ_ERR_ARGUMENT,
        "no flexible mode is controllable by an input, so there is no Krylov "
        "vector%s%s",
        *c->at ? " at " : "", c->at);
    return RITZ_OK;
}

ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                double least, ritz_compare_row *row)
{
    const ritz_configuration *c = configuration;
    int64_t flexible = c->K.ncol - c->num_rigid;
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN_ARRAY double *value = NULL;
    bool ranked = is_ranked(scene);

    RITZ_CHECK_NEW(row->kept, flexible);
    if (scene->select == RITZ_SELECT_KRYLOV)
        return count_vectors(scene, c, row);
    RITZ_CHECK_NEW(taken, flexible);
    RITZ_CHECK_NEW(value, flexible);
    if (ranked) {
        RITZ_CHECK(ritz_compare_values(scene, c, value, &row->num_joined));
        row->num_equal = mark_ranked(flexible, value, least, taken);
    } else if (scene->select == RITZ_SELECT_LISTED)
        RITZ_CHECK(mark_listed(scene, c, taken));
    else
        mark_band(scene, c, taken);
    row->num_completed = complete_clusters(c, taken);
    if (!ranked)
        RITZ_CHECK(rank_listed(scene, c, value, &ranked));
    if (ranked)
        find_cut(c, value, taken, row);
    for (int64_t k = 0; k < flexible; k++)
        if (taken[k])
            row->kept[row->num_kept++] = k;
    return RITZ_OK;
}

const ritz_configuration *ritz_rows_first(const ritz_rows *rows, int64_t k)
{
    int64_t listed = rows->listed->num_configurations;

    return k < listed ? &rows->listed->configuration[k]
                      : &rows->between.configuration[k - listed];
}
