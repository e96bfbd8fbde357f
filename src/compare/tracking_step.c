/*
 * One step: likenesses, partners, and what happened on the way.
 *
 *     X_ij = sum_c (P_c' M_c P'_c)_ij
 *
 * Between clusters A and B of p and q modes the likeness of each pair is
 * ||X_AB||_F^2 / min(p, q), the mean squared cosine of the angles of their
 * spaces: 1 where one contains the other, whatever their bases are.
 */
#include "base/alloc.h"
#include "compare/tracking_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Likeness that makes a partner, and by how much a second must fall behind. */
static const double alike = 0.5;
static const double clear = 0.1;

/* Two modes mixed beyond these, in a plane that stays so well, do not cross. */
static const double mixed = 0.05;
static const double plane = 0.9;

/* One past the last mode of the cluster of mode i. */
static int64_t cluster_end(const int64_t *cluster, int64_t count, int64_t i)
{
    int64_t last = i;

    while (last < count && cluster[last] == cluster[i])
        last++;
    return last;
}

/* Squares of X, those of a pair of clusters replaced by their likeness. */
static void level(ritz_track_step *step)
{
    ritz_dense *X = &step->mac;
    int64_t i1 = 0, j1 = 0;

    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        X->val[k] *= X->val[k];
    for (int64_t j0 = 0; j0 < X->ncol; j0 = j1) {
        j1 = cluster_end(step->cluster[1], X->ncol, j0);
        for (int64_t i0 = 0; i0 < X->nrow; i0 = i1) {
            double sum = 0.0;

            i1 = cluster_end(step->cluster[0], X->nrow, i0);
            for (int64_t j = j0; j < j1; j++)
                for (int64_t i = i0; i < i1; i++)
                    sum += ritz_dense_col(X, j)[i];
            sum /= (double)(i1 - i0 < j1 - j0 ? i1 - i0 : j1 - j0);
            for (int64_t j = j0; j < j1; j++)
                for (int64_t i = i0; i < i1; i++)
                    ritz_dense_col(X, j)[i] = sum;
        }
    }
}

/* X of flexible modes. */
static ritz_status correlate(const ritz_stage *stage,
                             const ritz_configuration *from,
                             const ritz_configuration *to, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense A = {0}, B = {0}, MB = {0}, part = {0};
    int64_t m = from->K.ncol - from->num_rigid;
    int64_t n = to->K.ncol - to->num_rigid;

    RITZ_TRY(ritz_dense_new(m, n, X));
    for (int64_t c = 0; c < stage->count; c++) {
        RITZ_TRY(ritz_dense_columns(&from->P[c], from->num_rigid, m, &A));
        RITZ_TRY(ritz_dense_columns(&to->P[c], to->num_rigid, n, &B));
        RITZ_TRY(ritz_dense_mul(&stage->body[c].M, &B, &MB));
        RITZ_TRY(ritz_dense_mul_tn(&A, &MB, &part));
        for (int64_t k = 0; k < m * n; k++)
            X->val[k] += part.val[k];
        ritz_dense_free(&A);
        ritz_dense_free(&B);
        ritz_dense_free(&MB);
        ritz_dense_free(&part);
    }
done:
    ritz_dense_free(&A);
    ritz_dense_free(&B);
    ritz_dense_free(&MB);
    ritz_dense_free(&part);
    return status;
}

/* The free mode of `to` that is most like mode i; -1 if none is like it. */
static int64_t find_partner(const ritz_track_step *step, const bool *taken,
                            int64_t i)
{
    int64_t best = -1;

    for (int64_t j = 0; j < step->num_to; j++) {
        double mac = ritz_dense_col(&step->mac, j)[i];

        if (!taken[j] && mac >= alike &&
            (best < 0 || mac > ritz_dense_col(&step->mac, best)[i]))
            best = j;
    }
    return best;
}

ritz_status ritz_track_match(const ritz_stage *stage,
                             const ritz_configuration *from,
                             const ritz_configuration *to,
                             ritz_track_step *step)
{
    ritz_status status = RITZ_OK;
    bool *taken = NULL;

    RITZ_NEW(taken, step->num_to);
    RITZ_NEW(step->partner, step->num_from);
    RITZ_TRY(correlate(stage, from, to, &step->mac));
    level(step);
    for (int64_t i = 0; i < step->num_from; i++) {
        step->partner[i] = find_partner(step, taken, i);
        if (step->partner[i] >= 0)
            taken[step->partner[i]] = true;
    }
done:
    free(taken);
    return status;
}

/* Likeness of mode i with j; 0 for none. */
static double mac_of(const ritz_track_step *step, int64_t i, int64_t j)
{
    return j < 0 ? 0.0 : ritz_dense_col(&step->mac, j)[i];
}

static ritz_status add_event(const ritz_track_step *step,
                             const ritz_track_event *event, ritz_tracking *t)
{
    ritz_track_event *more = NULL;

    if ((t->num_events & (t->num_events - 1)) == 0) { /* a power of two, or 0 */
        RITZ_CHECK_NEW(more, t->num_events > 0 ? 2 * t->num_events : 1);
        if (t->num_events > 0)
            memcpy(more, t->event, (size_t)t->num_events * sizeof *more);
        free(t->event);
        t->event = more;
    }
    t->event[t->num_events] = *event;
    t->event[t->num_events].from = step->from;
    t->event[t->num_events].to = step->to;
    t->event[t->num_events].hertz = step->hertz[0][event->mode[0]];
    t->num_events++;
    return RITZ_OK;
}

/* Whether mode j is what a mode of i's cluster becomes. */
static bool is_of_mate(const ritz_track_step *step, int64_t i, int64_t j)
{
    const int64_t *cluster = step->cluster[0];

    for (int64_t m = cluster[i]; m < step->num_from && cluster[m] == cluster[i];
         m++)
        if (m != i && step->partner[m] == j)
            return true;
    return false;
}

/*
 * What mode i is most like, which is its partner if it has one, and the next of
 * another cluster that is not what its own cluster becomes.
 */
static void find_best(const ritz_track_step *step, int64_t i, int64_t best[2])
{
    best[0] = step->partner[i];
    best[1] = -1;
    for (int64_t j = 0; j < step->num_to && step->partner[i] < 0; j++)
        if (mac_of(step, i, j) > mac_of(step, i, best[0]))
            best[0] = j;
    for (int64_t j = 0; j < step->num_to; j++)
        if (best[0] >= 0 && step->cluster[1][j] != step->cluster[1][best[0]] &&
            !is_of_mate(step, i, j) &&
            mac_of(step, i, j) > mac_of(step, i, best[1]))
            best[1] = j;
}

/* A mode that is lost, or nearly as like a second as the first. */
static ritz_status judge_one(const ritz_track_step *step, int64_t i,
                             ritz_tracking *t)
{
    int64_t best[2] = {-1, -1};
    ritz_track_event event = {.mode = {i, -1}, .shared = nan("")};

    find_best(step, i, best);
    for (int k = 0; k < 2; k++) {
        event.other[k] = best[k];
        event.mac[k] = mac_of(step, i, best[k]);
    }
    if (step->partner[i] < 0) {
        event.kind = RITZ_TRACK_LOST;
        RITZ_CHECK(add_event(step, &event, t));
    } else if (best[1] >= 0 && event.mac[0] - event.mac[1] < clear) {
        event.kind = RITZ_TRACK_TIE;
        RITZ_CHECK(add_event(step, &event, t));
    }
    return RITZ_OK;
}

/*
 * Two modes of different clusters that have partners: do they change places, or
 * turn within their plane? The latter are neighbours in frequency.
 */
static ritz_status judge_two(const ritz_track_step *step, int64_t i, int64_t j,
                             ritz_tracking *t)
{
    int64_t p = step->partner[i];
    int64_t q = step->partner[j];
    double own[2] = {mac_of(step, i, p), mac_of(step, j, q)};
    double crossed[2] = {mac_of(step, i, q), mac_of(step, j, p)};
    double shared = 0.5 * (own[0] + own[1] + crossed[0] + crossed[1]);
    ritz_track_event event = {.mode = {i, j},
                              .other = {p, q},
                              .mac = {own[0], own[1]},
                              .shared = nan("")};

    if (p > q) {
        event.kind = RITZ_TRACK_SWAP;
        RITZ_CHECK(add_event(step, &event, t));
    }
    if (j == i + 1 && shared >= plane && fmin(crossed[0], crossed[1]) > mixed) {
        event.kind = RITZ_TRACK_AVOIDED;
        event.shared = shared;
        RITZ_CHECK(add_event(step, &event, t));
    }
    return RITZ_OK;
}

/* Whether two modes, or what they became, are of one cluster. */
static bool are_one(const ritz_track_step *step, int64_t i, int64_t j)
{
    int64_t p = step->partner[i];
    int64_t q = step->partner[j];

    return step->cluster[0][i] == step->cluster[0][j] ||
           step->cluster[1][p] == step->cluster[1][q];
}

ritz_status ritz_track_events(const ritz_track_step *step, double up_to_hz,
                              ritz_tracking *tracking)
{
    double most = up_to_hz > 0.0 ? up_to_hz : HUGE_VAL;

    for (int64_t i = 0; i < step->num_from; i++) {
        if (step->hertz[0][i] > most)
            break;
        RITZ_CHECK(judge_one(step, i, tracking));
        for (int64_t j = i + 1; j < step->num_from; j++)
            if (step->partner[i] >= 0 && step->partner[j] >= 0 &&
                !are_one(step, i, j))
                RITZ_CHECK(judge_two(step, i, j, tracking));
    }
    return RITZ_OK;
}
