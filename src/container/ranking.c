/*
 * Containers of rankings: a single one has its members in the file itself,
 * several have theirs in `rankings/0`, 1, ... Files written before there were
 * clusters, parts and configurations lack those members, and are read.
 */
#include "container/schema.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Each mode has one place in the order. */
static ritz_status check_order(const ritz_ranking *ranking)
{
    RITZ_OWN_ARRAY bool *placed = NULL;

    RITZ_CHECK_NEW(placed, ranking->count);
    for (int64_t k = 0; k < ranking->count; k++) {
        int64_t mode = ranking->order[k];

        RITZ_REFUSE_IF(placed[mode], RITZ_ERR_FORMAT,
                       "mode %" PRId64 " is in 'order' twice", mode);
        placed[mode] = true;
    }
    return RITZ_OK;
}

/* Without clusters in the file, each mode is a cluster of its own. */
static ritz_status settle_clusters(ritz_ranking *ranking)
{
    int64_t m = ranking->count;
    int64_t *cluster = ranking->cluster;

    if (!cluster) {
        RITZ_CHECK_NEW(cluster, m);
        for (int64_t k = 0; k < m; k++)
            cluster[k] = k;
        ranking->cluster = cluster;
    }
    for (int64_t k = 0; k < m; k++)
        RITZ_REFUSE_IF(cluster[k] > k || cluster[cluster[k]] != cluster[k],
                       RITZ_ERR_FORMAT,
                       "'cluster' does not name the first "
                       "mode");
    return RITZ_OK;
}

static ritz_status settle_ranking(const ritz_place *place)
{
    ritz_ranking *ranking = place->target;

    RITZ_CHECK(check_order(ranking));
    RITZ_CHECK(settle_clusters(ranking));
    for (int k = 0; k < 2; k++)
        RITZ_REFUSE_IF(!isnan(ranking->coupling) && ranking->coupling > 0.0 &&
                           (ranking->coupled[k] < 0 ||
                            ranking->coupled[k] >= ranking->count),
                       RITZ_ERR_FORMAT, "'coupled' is not a pair of modes");
    return RITZ_OK;
}

/* What earlier releases did not write is always written. */
static bool has_always(const void *)
{
    return true;
}

/* Tracks: numbers by which modes are followed, of all rankings or of none. */

static const ritz_member track_members[] = {
    {"track", SET_WHOLE, .shape = "m", .range = "0..2147483647"},
    {0},
};

static const ritz_schema track_schema = {.members = track_members};

static ritz_status move_track(const ritz_place *place, hid_t group)
{
    const ritz_rankings *all = place->outer->object;
    ritz_rankings *read = place->outer->target;
    bool there = read ? ritz_h5_has(group, "track") : !!all->track;

    if (read && there && place->index == 0)
        RITZ_CHECK_NEW(read->track, read->count);
    RITZ_REFUSE_IF(there != !!all->track, RITZ_ERR_FORMAT,
                   "some rankings have 'track' and some do not");
    if (!there)
        return RITZ_OK;
    return ritz_schema_move(&(ritz_place){
        .at = group,
        .schema = &track_schema,
        .object = &all->track[place->index],
        .target = read ? &read->track[place->index] : NULL,
        .outer = place,
    });
}

static const ritz_member members[] = {
    {"by", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_ranking, by), "",
     "name of the ranking"},
    {"reference", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_ranking, reference), "",
     "key of its source in `references.bib`"},
    {"at", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_ranking, at), "",
     "configuration of the system", .optional = "", .has = has_always},
    {"damping", ATTRIBUTE_TEXT, RITZ_TEXT(ritz_ranking, damping), "",
     "damping, as `--damping` reads it; may be empty", .optional = "",
     .has = has_always},
    {"total", ATTRIBUTE_REAL, RITZ_AT(ritz_ranking, total), "",
     "sum of all values, computed from an identity", .values = VALUES_OR_NAN,
     .optional = "", .has = has_always},
    {"coupling", ATTRIBUTE_REAL, RITZ_AT(ritz_ranking, coupling), "",
     "largest normalised off-diagonal entry of the modal Gramian",
     .values = VALUES_OR_NAN},
    {"coupled", ATTRIBUTE_WHOLE, RITZ_AT(ritz_ranking, coupled), "2",
     "the two modes of that entry"},
    {"hertz", SET_REAL, RITZ_AT(ritz_ranking, hertz), "m",
     "frequency of each flexible mode"},
    {"zeta", SET_REAL, RITZ_AT(ritz_ranking, zeta), "m",
     "damping ratio of each mode, as used; 0: none"},
    {"value", SET_REAL, RITZ_AT(ritz_ranking, value), "m",
     "value of each mode"},
    {"order", SET_WHOLE, RITZ_AT(ritz_ranking, order), "m", "modes, best first",
     "0..m-1"},
    {"cluster", SET_WHOLE, RITZ_AT(ritz_ranking, cluster), "m",
     "first mode of each mode's cluster", "0..m-1", .optional = "",
     .some = 'm'},
    {"track", BY_HAND, .type = "i64, optional", .shape = "m",
     .about = "number from 0 by which each mode is known in all rankings",
     .move = move_track},
    {"parts/names", SET_WORDS, RITZ_AT(ritz_ranking, part), "p",
     "names of the outputs, inputs or directions that add up to values",
     .optional = "parts", .some = 'p'},
    {"parts/whole", SET_REAL, RITZ_AT(ritz_ranking, whole), "p",
     "total of each part", .values = VALUES_OR_NAN, .optional = "parts",
     .some = 'p'},
    {"parts/values", MATRIX_DENSE, RITZ_AT(ritz_ranking, parts), "m p",
     "contribution of each part to the value of each mode", .optional = "parts",
     .some = 'p'},
    {"system_value", SET_REAL, RITZ_AT(ritz_ranking, system_value), "s",
     "exact Hankel values of the model, descending"},
    {0},
};

const ritz_schema ritz_schema_ranking = {
    .name = "ranking",
    .sizes = {{'m', .offset = offsetof(ritz_ranking, count), "hertz"},
              {'p', .offset = offsetof(ritz_ranking, num_parts), "parts/names"},
              {'s', .offset = offsetof(ritz_ranking, num_system),
               "system_value"}},
    .members = members,
    .settle = settle_ranking,
};

/* One ranking or several. */

static const ritz_member rankings_members[] = {
    {"rankings", LIST, RITZ_LIST(ritz_rankings, item), "k", .numbered = true,
     .alone = true, .schema = &ritz_schema_ranking},
    {0},
};

const ritz_schema ritz_schema_rankings = {
    .name = "ranking",
    .sizes = {{'k', .offset = offsetof(ritz_rankings, count)}},
    .members = rankings_members,
};
