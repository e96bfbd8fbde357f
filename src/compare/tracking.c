/*
 * One step: the MAC of modes, the pairs of modes, and the events of the step.
 */
#include "base/alloc.h"
#include "base/tolerances.h"

#include "compare/compare.h"
#include "model/squares.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>

/* One step of tracking: modes of a configuration and of the one before it. */

typedef struct ritz_track_step {
    int64_t from, to; /* configurations */
    const ritz_configuration *at[2];
    int64_t num_from, num_to;  /* flexible modes */
    const double *hertz[2];    /* of both */
    const int64_t *cluster[2]; /* first mode of each one's cluster */
    ritz_dense mac;            /* num_from x num_to, the same in a cluster */
    int64_t *partner;          /* num_from, in `to`; -1: lost */
} ritz_track_step;

static void ritz_track_step_free(ritz_track_step *step)
{
    free(step->partner);
    ritz_dense_free(&step->mac);
}

/* Whether flexible mode i of `from` (side 0) or `to` (side 1) is a negative
   eigenvalue of forces between bodies. */
static bool is_square(const ritz_track_step *step, int side, int64_t i)
{
    const ritz_configuration *c = step->at[side];

    return ritz_configuration_is_square(c, c->num_rigid + i);
}

/* One past the last mode of the cluster of mode i. */
static int64_t cluster_end(const int64_t *cluster, int64_t count, int64_t i)
{
    int64_t last = i;

    while (last < count && cluster[last] == cluster[i])
        last++;
    return last;
}

/* Squares of X; within a pair of clusters all become that of the clusters. */
static void average_clusters(ritz_track_step *step)
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

/*
 * The unpaired mode of `to` with the largest MAC with mode i; -1 if none has
 * any.
 */
static int64_t find_paired_mode(const ritz_track_step *step, const bool *taken,
                                int64_t i)
{
    int64_t best = -1;

    for (int64_t j = 0; j < step->num_to; j++) {
        double mac = ritz_dense_col(&step->mac, j)[i];

        if (!taken[j] && mac >= RITZ_SAME_MODE && !is_square(step, 1, j) &&
            (best < 0 || mac > ritz_dense_col(&step->mac, best)[i]))
            best = j;
    }
    return best;
}

/* MAC values and pairs of one step; cluster and hertz are set. */
static ritz_status match_modes(const ritz_stage *stage, ritz_track_step *step)
{
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, step->num_to);
    RITZ_CHECK_NEW(step->partner, step->num_from);
    RITZ_CHECK(ritz_modes_correlate(stage, NULL, true, step->at[0], step->at[1],
                                    &step->mac));
    average_clusters(step);
    for (int64_t i = 0; i < step->num_from; i++) {
        step->partner[i] =
            is_square(step, 0, i) ? -1 : find_paired_mode(step, taken, i);
        if (step->partner[i] >= 0)
            taken[step->partner[i]] = true;
    }
    return RITZ_OK;
}

/* The MAC of mode i and mode j; 0 if j is -1. */
static double read_mac(const ritz_track_step *step, int64_t i, int64_t j)
{
    return j < 0 ? 0.0 : ritz_dense_col(&step->mac, j)[i];
}

static ritz_status add_event(const ritz_track_step *step,
                             const ritz_track_event *event, ritz_tracking *t)
{
    RITZ_CHECK_ROOM(t->event, t->num_events, t->room);
    t->event[t->num_events] = *event;
    t->event[t->num_events].from = step->from;
    t->event[t->num_events].to = step->to;
    t->event[t->num_events].hertz = step->hertz[0][event->mode[0]];
    t->num_events++;
    return RITZ_OK;
}

/* Whether mode j is paired with a mode of i's cluster. */
static bool is_of_pair(const ritz_track_step *step, int64_t i, int64_t j)
{
    const int64_t *cluster = step->cluster[0];

    for (int64_t m = cluster[i]; m < step->num_from && cluster[m] == cluster[i];
         m++)
        if (m != i && step->partner[m] == j)
            return true;
    return false;
}

/*
 * The two modes that mode i is most like: its paired mode if it has one, and
 * the best one of another cluster that is not paired with i's own cluster.
 */
static void find_two_best(const ritz_track_step *step, int64_t i,
                          int64_t best[2])
{
    best[0] = step->partner[i];
    best[1] = -1;
    for (int64_t j = 0; j < step->num_to && step->partner[i] < 0; j++)
        if (!is_square(step, 1, j) &&
            read_mac(step, i, j) > read_mac(step, i, best[0]))
            best[0] = j;
    for (int64_t j = 0; j < step->num_to; j++)
        if (best[0] >= 0 && step->cluster[1][j] != step->cluster[1][best[0]] &&
            !is_of_pair(step, i, j) && !is_square(step, 1, j) &&
            read_mac(step, i, j) > read_mac(step, i, best[1]))
            best[1] = j;
}

/*
 * Record a mode that is lost, or whose second MAC is nearly as large as its
 * first.
 */
static ritz_status classify_mode(const ritz_track_step *step, int64_t i,
                                 ritz_tracking *t)
{
    int64_t best[2] = {-1, -1};
    ritz_track_event event = {.mode = {i, -1}, .shared = nan("")};

    find_two_best(step, i, best);
    for (int k = 0; k < 2; k++) {
        event.other[k] = best[k];
        event.mac[k] = read_mac(step, i, best[k]);
    }
    event.kind = step->partner[i] < 0 ? RITZ_TRACK_LOST : RITZ_TRACK_TIE;
    if (step->partner[i] >= 0 &&
        (best[1] < 0 || event.mac[0] - event.mac[1] >= RITZ_TRACK_CLEAR))
        return RITZ_OK;
    return add_event(step, &event, t);
}

/*
 * Two modes of different clusters that are both paired: whether they change
 * their order, or rotate in their plane, which only neighbours in frequency do.
 */
static ritz_status classify_pair(const ritz_track_step *step, int64_t i,
                                 int64_t j, ritz_tracking *t)
{
    int64_t p = step->partner[i];
    int64_t q = step->partner[j];
    double own[2] = {read_mac(step, i, p), read_mac(step, j, q)};
    double crossed[2] = {read_mac(step, i, q), read_mac(step, j, p)};
    double shared = 0.5 * (own[0] + own[1] + crossed[0] + crossed[1]);
    ritz_track_event event = {.mode = {i, j},
                              .other = {p, q},
                              .mac = {own[0], own[1]},
                              .shared = nan("")};

    if (p > q) {
        event.kind = RITZ_TRACK_SWAP;
        RITZ_CHECK(add_event(step, &event, t));
    }
    if (j == i + 1 && shared >= RITZ_TRACK_PLANE &&
        fmin(crossed[0], crossed[1]) > RITZ_TRACK_MIXED) {
        event.kind = RITZ_TRACK_AVOIDED;
        event.shared = shared;
        RITZ_CHECK(add_event(step, &event, t));
    }
    return RITZ_OK;
}

/* Append the events of one step, up to a frequency; 0 for all. */
static ritz_status append_events(const ritz_track_step *step, double up_to_hz,
                                 ritz_tracking *tracking)
{
    double most = up_to_hz > 0.0 ? up_to_hz : HUGE_VAL;

    for (int64_t i = 0; i < step->num_from; i++) {
        if (step->hertz[0][i] > most)
            break;
        if (is_square(step, 0, i))
            continue;
        RITZ_CHECK(classify_mode(step, i, tracking));
        for (int64_t j = i + 1; j < step->num_from; j++) {
            int64_t p = step->partner[i], q = step->partner[j];

            /* of different clusters, in both configurations */
            if (p >= 0 && q >= 0 &&
                step->cluster[0][i] != step->cluster[0][j] &&
                step->cluster[1][p] != step->cluster[1][q])
                RITZ_CHECK(classify_pair(step, i, j, tracking));
        }
    }
    return RITZ_OK;
}

/*
 * Tracks: a mode continues as the mode with the largest MAC, if that is half or
 * more. As the modes of both configurations are orthonormal, squared products
 * in a row or column sum to at most one, so that above one half no second mode
 * qualifies and no assignment problem is left.
 *
 * Modes that are in one cluster at any configuration get one track throughout,
 * by joining their tracks: which of them continues as which is not defined.
 */

/* The nearest configuration among those before k; the search is limited. */
static int64_t find_before(const ritz_system *system, int64_t k)
{
    enum { FURTHEST = 1000 };
    const ritz_configuration *c = system->configuration;
    int64_t best = -1;
    int64_t fewest = 0;
    double least = 0.0;

    for (int64_t j = k > FURTHEST ? k - FURTHEST : 0; j < k; j++) {
        int64_t count = 0;
        double apart = 0.0;

        for (int64_t s = 0; s < c[k].num_settings; s++) {
            count += c[k].setting[s] != c[j].setting[s];
            apart += fabs(c[k].setting[s] - c[j].setting[s]);
        }
        if (best < 0 || count < fewest || (count == fewest && apart <= least)) {
            best = j;
            fewest = count;
            least = apart;
        }
    }
    return best;
}

/* Allocate room for all modes, their frequencies and clusters. */
static ritz_status allocate_tracking(const ritz_system *system,
                                     ritz_tracking *t)
{
    int64_t count = system->num_configurations;
    int64_t total = 0;

    t->num_configurations = count;
    RITZ_CHECK_NEW(t->before, count);
    RITZ_CHECK_NEW(t->first, count + 1);
    for (int64_t k = 0; k < count; k++) {
        const ritz_configuration *c = &system->configuration[k];

        t->before[k] = find_before(system, k);
        t->first[k] = total;
        total += c->K.ncol - c->num_rigid;
    }
    t->first[count] = total;
    RITZ_CHECK_NEW(t->track, total);
    RITZ_CHECK_NEW(t->cluster, total);
    RITZ_CHECK_NEW(t->hertz, total);
    RITZ_CHECK_NEW(t->mac, total);
    for (int64_t k = 0; k < count; k++) {
        const ritz_configuration *c = &system->configuration[k];
        int64_t *cluster = t->cluster + t->first[k];
        double *hertz = t->hertz + t->first[k];

        for (int64_t j = 0; j < t->first[k + 1] - t->first[k]; j++) {
            hertz[j] = ritz_eigen_hertz(c->lambda[c->num_rigid + j]);
            cluster[j] = j;
            if (j > 0 && fabs(hertz[j] - hertz[j - 1]) <=
                             RITZ_CLUSTER_GAP * fabs(hertz[j]))
                cluster[j] = cluster[j - 1];
        }
    }
    return RITZ_OK;
}

/* The track that represents one that was joined to it. */
static int64_t find_root(const int64_t *joined, int64_t track)
{
    while (joined[track] != track)
        track = joined[track];
    return track;
}

/* Tracks of configuration `to`: those of paired modes, and new ones. */
static void continue_tracks(const ritz_track_step *step, ritz_tracking *t)
{
    const int64_t *from =
        step->from < 0 ? NULL : t->track + t->first[step->from];
    int64_t *to = t->track + t->first[step->to];
    double *mac = t->mac + t->first[step->to];

    for (int64_t j = 0; j < step->num_to; j++) {
        to[j] = -1;
        mac[j] = nan("");
    }
    for (int64_t i = 0; from && i < step->num_from; i++)
        if (step->partner[i] >= 0) {
            to[step->partner[i]] = from[i];
            mac[step->partner[i]] =
                ritz_dense_col(&step->mac, step->partner[i])[i];
        }
    for (int64_t j = 0; j < step->num_to; j++)
        if (to[j] < 0 && !is_square(step, 1, j))
            to[j] = t->num_tracks++;
}

/*
 * Join the tracks that share a cluster, and number the remaining ones in order.
 */
static ritz_status number_tracks(ritz_tracking *t)
{
    RITZ_OWN_ARRAY int64_t *joined = NULL;
    RITZ_OWN_ARRAY int64_t *number = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(joined, t->num_tracks);
    RITZ_CHECK_NEW(number, t->num_tracks);
    for (int64_t k = 0; k < t->num_tracks; k++) {
        joined[k] = k;
        number[k] = -1;
    }
    for (int64_t k = 0; k < t->num_configurations; k++)
        for (int64_t i = t->first[k]; i < t->first[k + 1]; i++) {
            if (t->track[i] < 0)
                continue;

            int64_t p = find_root(joined, t->track[i]);
            int64_t q =
                find_root(joined, t->track[t->first[k] + t->cluster[i]]);

            joined[p > q ? p : q] = p < q ? p : q; /* the older one remains */
        }
    for (int64_t i = 0; i < t->first[t->num_configurations]; i++) {
        if (t->track[i] < 0)
            continue;

        int64_t root = find_root(joined, t->track[i]);

        if (number[root] < 0)
            number[root] = count++;
        t->track[i] = number[root];
    }
    t->num_tracks = count;
    return RITZ_OK;
}

/* Remove events between two modes that share a track after joining. */
static void remove_events(ritz_tracking *t)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < t->num_events; k++) {
        const ritz_track_event *event = &t->event[k];
        const int64_t *track = t->track + t->first[event->from];

        if (event->mode[1] < 0 ||
            track[event->mode[0]] != track[event->mode[1]])
            t->event[kept++] = *event;
    }
    t->num_events = kept;
}

/* Track the modes of configuration k from the configuration before it. */
static ritz_status track_step(const ritz_stage *stage,
                              const ritz_system *system, int64_t k,
                              double up_to_hz, ritz_tracking *t)
{
    int64_t before = t->before[k];
    RITZ_OWN(ritz_track_step) step = {.from = before, .to = k};
    const ritz_configuration *all = system->configuration;

    step.at[0] = before < 0 ? NULL : &all[before];
    step.at[1] = &all[k];

    step.num_to = t->first[k + 1] - t->first[k];
    if (before >= 0) {
        step.num_from = t->first[before + 1] - t->first[before];
        step.hertz[0] = t->hertz + t->first[before];
        step.hertz[1] = t->hertz + t->first[k];
        step.cluster[0] = t->cluster + t->first[before];
        step.cluster[1] = t->cluster + t->first[k];
        RITZ_CHECK(match_modes(stage, &step));
        RITZ_CHECK(append_events(&step, up_to_hz, t));
    }
    continue_tracks(&step, t);
    return RITZ_OK;
}

ritz_status ritz_track(const ritz_stage *stage, const ritz_system *system,
                       double up_to_hz, ritz_tracking *out)
{
    RITZ_OWN(ritz_tracking) t = {0};

    RITZ_CHECK(allocate_tracking(system, &t));
    for (int64_t k = 0; k < t.num_configurations; k++) {
        ritz_monitor_step("tracks", k, t.num_configurations);
        RITZ_CHECK(track_step(stage, system, k, up_to_hz, &t));
    }
    RITZ_CHECK(number_tracks(&t));
    remove_events(&t);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

void ritz_tracking_free(ritz_tracking *tracking)
{
    RITZ_FREE(tracking->before, tracking->first, tracking->track,
              tracking->cluster, tracking->hertz, tracking->mac,
              tracking->event);
    *tracking = (ritz_tracking){0};
}
