/*
 * Tracks: a mode goes on as the one that is most like it, if the MAC is half or
 * more. As the modes of both configurations are orthonormal, squared products
 * in a row or column sum to at most one, so that above one half there is no
 * second claimant and no assignment problem is left.
 *
 * Modes that are in one cluster at any configuration get one track throughout,
 * by joining their tracks: which of them went on as which is not defined.
 */
#include "base/alloc.h"
#include "compare/tracking_parts.h"

#include <ritz/eigen.h>
#include <ritz/monitor.h>

#include <math.h>
#include <stdlib.h>

/* Relative gap of frequencies within a cluster. */
static const double near = 1e-6;

/* The nearest configuration among those before k, not looking for ever. */
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

/* Room for all modes, their frequencies and clusters. */
static ritz_status lay_out(const ritz_system *system, ritz_tracking *t)
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
            if (j > 0 && hertz[j] - hertz[j - 1] <= near * hertz[j])
                cluster[j] = cluster[j - 1];
        }
    }
    return RITZ_OK;
}

/* The track that stands for one that was joined to it. */
static int64_t find_root(const int64_t *joined, int64_t track)
{
    while (joined[track] != track)
        track = joined[track];
    return track;
}

/* Make one track of two; the older one stays. */
static void join(int64_t *joined, int64_t a, int64_t b)
{
    int64_t p = find_root(joined, a);
    int64_t q = find_root(joined, b);

    joined[p > q ? p : q] = p < q ? p : q;
}

/* Tracks of configuration `to`: those of partners, and new ones. */
static void carry_on(const ritz_track_step *step, ritz_tracking *t)
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
        if (to[j] < 0)
            to[j] = t->num_tracks++;
}

/* Join what shares a cluster, and number what is left in order. */
static ritz_status settle(ritz_tracking *t)
{
    ritz_status status = RITZ_OK;
    int64_t *joined = NULL;
    int64_t *number = NULL;
    int64_t count = 0;

    RITZ_NEW(joined, t->num_tracks);
    RITZ_NEW(number, t->num_tracks);
    for (int64_t k = 0; k < t->num_tracks; k++) {
        joined[k] = k;
        number[k] = -1;
    }
    for (int64_t k = 0; k < t->num_configurations; k++)
        for (int64_t i = t->first[k]; i < t->first[k + 1]; i++)
            join(joined, t->track[i], t->track[t->first[k] + t->cluster[i]]);
    for (int64_t i = 0; i < t->first[t->num_configurations]; i++) {
        int64_t root = find_root(joined, t->track[i]);

        if (number[root] < 0)
            number[root] = count++;
        t->track[i] = number[root];
    }
    t->num_tracks = count;
done:
    free(joined);
    free(number);
    return status;
}

/* Leave out what happened between two modes that share a track after all. */
static void sift(ritz_tracking *t)
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

/* Modes of configuration k, from those of the one before it. */
static ritz_status follow(const ritz_stage *stage, const ritz_system *system,
                          int64_t k, double up_to_hz, ritz_tracking *t)
{
    ritz_status status = RITZ_OK;
    int64_t before = t->before[k];
    ritz_track_step step = {.from = before, .to = k};

    step.num_to = t->first[k + 1] - t->first[k];
    if (before >= 0) {
        step.num_from = t->first[before + 1] - t->first[before];
        step.hertz[0] = t->hertz + t->first[before];
        step.hertz[1] = t->hertz + t->first[k];
        step.cluster[0] = t->cluster + t->first[before];
        step.cluster[1] = t->cluster + t->first[k];
        RITZ_TRY(ritz_track_match(stage, &system->configuration[before],
                                  &system->configuration[k], &step));
        RITZ_TRY(ritz_track_events(&step, up_to_hz, t));
    }
    carry_on(&step, t);
done:
    free(step.partner);
    ritz_dense_free(&step.mac);
    return status;
}

ritz_status ritz_track(const ritz_stage *stage, const ritz_system *system,
                       double up_to_hz, ritz_tracking *out)
{
    ritz_status status = RITZ_OK;
    ritz_tracking t = {0};

    RITZ_TRY(lay_out(system, &t));
    for (int64_t k = 0; k < t.num_configurations; k++) {
        ritz_monitor_step("tracks", k, t.num_configurations);
        RITZ_TRY(follow(stage, system, k, up_to_hz, &t));
    }
    RITZ_TRY(settle(&t));
    sift(&t);
    *out = t;
    t = (ritz_tracking){0};
done:
    ritz_tracking_free(&t);
    return status;
}

void ritz_tracking_free(ritz_tracking *tracking)
{
    free(tracking->before);
    free(tracking->first);
    free(tracking->track);
    free(tracking->cluster);
    free(tracking->hertz);
    free(tracking->mac);
    free(tracking->event);
    *tracking = (ritz_tracking){0};
}
