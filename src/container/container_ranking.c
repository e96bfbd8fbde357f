/*
 * Containers of rankings: one has its members in the file itself, several in
 * `rankings/0`, 1, ... A file of before there were clusters, parts and
 * configurations lacks those members, and is read.
 */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const ritz_text_member members[] = {
    {"by", offsetof(ritz_ranking, by)},
    {"reference", offsetof(ritz_ranking, reference)},
    {NULL, 0},
};

/* Each mode has one place. */
static ritz_status check_order(const ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    bool *placed = NULL;

    RITZ_NEW(placed, ranking->count);
    for (int64_t k = 0; k < ranking->count; k++) {
        int64_t mode = ranking->order[k];

        RITZ_FAIL_IF(placed[mode], RITZ_ERR_FORMAT,
                     "mode %" PRId64 " is in 'order' twice", mode);
        placed[mode] = true;
    }
done:
    free(placed);
    return status;
}

/* Modes that are coupled, if any pair was found. */
static ritz_status read_coupling(hid_t at, ritz_ranking *ranking)
{
    RITZ_CHECK(ritz_part_get_real(at, "coupling", true, 1, &ranking->coupling));
    RITZ_CHECK(ritz_h5_get(at, "coupled", H5T_STD_I64LE, 2, ranking->coupled));
    for (int k = 0; k < 2; k++)
        RITZ_REFUSE_IF(!isnan(ranking->coupling) && ranking->coupling > 0.0 &&
                           (ranking->coupled[k] < 0 ||
                            ranking->coupled[k] >= ranking->count),
                       RITZ_ERR_FORMAT, "'coupled' is not a pair of modes");
    return RITZ_OK;
}

/* Without any, each mode is by itself. Those of one follow each other. */
static ritz_status read_clusters(hid_t at, ritz_ranking *ranking)
{
    int64_t m = ranking->count;

    RITZ_CHECK_NEW(ranking->cluster, m);
    for (int64_t k = 0; k < m; k++)
        ranking->cluster[k] = k;
    if (ritz_h5_has(at, "cluster"))
        RITZ_CHECK(
            ritz_part_read_whole(at, "cluster", m, 0, m - 1, ranking->cluster));
    for (int64_t k = 0; k < m; k++)
        RITZ_REFUSE_IF(
            ranking->cluster[k] != k &&
                (k == 0 || ranking->cluster[k] != ranking->cluster[k - 1]),
            RITZ_ERR_FORMAT, "'cluster' does not name the first mode");
    return RITZ_OK;
}

/* Attributes that are later than the first such files. */
static ritz_status get_later(hid_t at, ritz_ranking *ranking)
{
    ranking->total = nan("");
    if (H5Aexists(at, "at") > 0)
        RITZ_CHECK(ritz_h5_get_text(at, "at", sizeof ranking->at, ranking->at));
    if (H5Aexists(at, "damping") > 0)
        RITZ_CHECK(ritz_h5_get_text(at, "damping", sizeof ranking->damping,
                                    ranking->damping));
    if (H5Aexists(at, "total") > 0)
        RITZ_CHECK(ritz_part_get_real(at, "total", true, 1, &ranking->total));
    return RITZ_OK;
}

static ritz_status read_parts(hid_t at, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    int64_t p = 0;

    if (!ritz_h5_has(at, "parts"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "parts", &group));
    RITZ_TRY(ritz_h5_count(group, "names", &p));
    RITZ_NEW(ranking->part, p);
    RITZ_NEW(ranking->whole, p);
    RITZ_TRY(ritz_part_read_words(group, "names", p, ranking->part));
    RITZ_TRY(ritz_h5_read_real(group, "whole", ritz_h5_vector(p), true,
                               ranking->whole));
    RITZ_TRY(ritz_h5_read_dense(group, "values", ranking->count, p,
                                &ranking->parts));
    ranking->num_parts = p;
done:
    ritz_h5_close(group);
    return ritz_context(status, "parts");
}

static ritz_status read_one(hid_t at, ritz_ranking *ranking)
{
    ritz_h5_shape modes;
    int64_t m = 0;

    RITZ_CHECK(ritz_part_get_members(at, members, ranking));
    RITZ_CHECK(get_later(at, ranking));
    RITZ_CHECK(ritz_h5_count(at, "hertz", &m));
    ranking->count = m;
    modes = ritz_h5_vector(m);
    RITZ_CHECK_NEW(ranking->hertz, m);
    RITZ_CHECK_NEW(ranking->zeta, m);
    RITZ_CHECK_NEW(ranking->value, m);
    RITZ_CHECK_NEW(ranking->order, m);
    RITZ_CHECK(ritz_h5_read_real(at, "hertz", modes, false, ranking->hertz));
    RITZ_CHECK(ritz_h5_read_real(at, "zeta", modes, false, ranking->zeta));
    RITZ_CHECK(ritz_h5_read_real(at, "value", modes, false, ranking->value));
    RITZ_CHECK(ritz_part_read_whole(at, "order", m, 0, m - 1, ranking->order));
    RITZ_CHECK(check_order(ranking));
    RITZ_CHECK(read_clusters(at, ranking));
    RITZ_CHECK(read_parts(at, ranking));
    RITZ_CHECK(ritz_h5_count(at, "system_value", &ranking->num_system));
    RITZ_CHECK_NEW(ranking->system_value, ranking->num_system);
    RITZ_CHECK(ritz_h5_read_real(at, "system_value",
                                 ritz_h5_vector(ranking->num_system), false,
                                 ranking->system_value));
    return read_coupling(at, ranking);
}

/* Numbers by which modes are followed; all rankings have them, or none. */
static ritz_status read_track(hid_t at, int64_t k, ritz_rankings *all)
{
    int64_t m = all->item[k].count;
    bool there = ritz_h5_has(at, "track");

    if (there && k == 0)
        RITZ_CHECK_NEW(all->track, all->count);
    RITZ_REFUSE_IF(there != !!all->track, RITZ_ERR_FORMAT,
                   "some rankings have 'track' and some do not");
    if (!there)
        return RITZ_OK;
    RITZ_CHECK_NEW(all->track[k], m);
    return ritz_part_read_whole(at, "track", m, 0, INT32_MAX, all->track[k]);
}

static ritz_status read_several(hid_t file, ritz_rankings *all)
{
    ritz_status status = RITZ_OK;
    ritz_name *name = NULL;
    hid_t groups = 0, group = 0;
    int64_t count = 0;

    RITZ_TRY(ritz_h5_enter(file, "rankings", &groups));
    RITZ_TRY(ritz_h5_list(groups, &count, &name));
    RITZ_NEW(all->item, count);
    all->count = count;
    for (int64_t k = 0; k < count; k++) {
        RITZ_TRY(ritz_h5_enter(groups, name[k], &group));
        RITZ_TRY_IN(name[k], read_one(group, &all->item[k]));
        RITZ_TRY_IN(name[k], read_track(group, k, all));
        ritz_h5_close(group);
        group = 0;
    }
done:
    free(name);
    ritz_h5_close(group);
    ritz_h5_close(groups);
    return ritz_context(status, "rankings");
}

ritz_status ritz_container_read_rankings(const char *path, ritz_rankings *out)
{
    ritz_status status = RITZ_OK;
    ritz_rankings all = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "ranking", &file));
    if (ritz_h5_has(file, "rankings")) {
        RITZ_TRY(read_several(file, &all));
    } else {
        RITZ_NEW(all.item, 1);
        all.count = 1;
        RITZ_TRY(read_one(file, all.item));
        RITZ_TRY(read_track(file, 0, &all));
    }
    *out = all;
    all = (ritz_rankings){0};
done:
    ritz_rankings_free(&all);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_read_ranking(const char *path, ritz_ranking *out)
{
    ritz_status status = RITZ_OK;
    ritz_rankings all = {0};

    RITZ_TRY(ritz_container_read_rankings(path, &all));
    RITZ_FAIL_IF(all.count != 1, RITZ_ERR_FORMAT,
                 "'%s' holds %" PRId64 " rankings, not one", path, all.count);
    *out = all.item[0];
    all.item[0] = (ritz_ranking){0};
done:
    ritz_rankings_free(&all);
    return status;
}

static ritz_status write_parts(hid_t at, const ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    int64_t p = ranking->num_parts;
    hid_t group = 0;

    if (p == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "parts", &group));
    RITZ_TRY(ritz_part_write_words(group, "names", p,
                                   (const ritz_name *)ranking->part));
    RITZ_TRY(ritz_h5_write(group, "whole", H5T_IEEE_F64LE, ritz_h5_vector(p),
                           ranking->whole));
    RITZ_TRY(ritz_h5_write_dense(group, "values", &ranking->parts));
done:
    ritz_h5_close(group);
    return ritz_context(status, "parts");
}

static ritz_status set_attributes(hid_t at, const ritz_ranking *ranking)
{
    RITZ_CHECK(ritz_part_set_members(at, members, ranking));
    RITZ_CHECK(ritz_h5_set_text(at, "at", ranking->at));
    RITZ_CHECK(ritz_h5_set_text(at, "damping", ranking->damping));
    RITZ_CHECK(ritz_part_set_real(at, "total", 1, &ranking->total));
    RITZ_CHECK(ritz_part_set_real(at, "coupling", 1, &ranking->coupling));
    return ritz_h5_set(at, "coupled", H5T_STD_I64LE, ritz_h5_vector(2),
                       ranking->coupled);
}

static ritz_status write_one(hid_t at, const ritz_ranking *ranking,
                             const int64_t *track)
{
    const ritz_h5_shape modes = ritz_h5_vector(ranking->count);
    const struct {
        const char *name;
        const double *values;
    } reals[] = {{"hertz", ranking->hertz},
                 {"zeta", ranking->zeta},
                 {"value", ranking->value}};
    const struct {
        const char *name;
        const int64_t *values;
    } wholes[] = {{"order", ranking->order},
                  {"cluster", ranking->count > 0 ? ranking->cluster : NULL},
                  {"track", track}};

    RITZ_CHECK(set_attributes(at, ranking));
    for (size_t k = 0; k < sizeof reals / sizeof *reals; k++)
        RITZ_CHECK(ritz_h5_write(at, reals[k].name, H5T_IEEE_F64LE, modes,
                                 reals[k].values));
    for (size_t k = 0; k < sizeof wholes / sizeof *wholes; k++)
        if (wholes[k].values || k == 0)
            RITZ_CHECK(ritz_h5_write(at, wholes[k].name, H5T_STD_I64LE, modes,
                                     wholes[k].values));
    RITZ_CHECK(write_parts(at, ranking));
    return ritz_h5_write(at, "system_value", H5T_IEEE_F64LE,
                         ritz_h5_vector(ranking->num_system),
                         ranking->system_value);
}

static ritz_status write_several(hid_t file, const ritz_rankings *all)
{
    ritz_status status = RITZ_OK;
    hid_t groups = 0, group = 0;
    char name[24];

    RITZ_TRY(ritz_h5_group(file, "rankings", &groups));
    for (int64_t k = 0; k < all->count; k++) {
        (void)snprintf(name, sizeof name, "%" PRId64, k);
        RITZ_TRY(ritz_h5_group(groups, name, &group));
        RITZ_TRY(ritz_part_set_whole(group, "index", k));
        RITZ_TRY_IN(name, write_one(group, &all->item[k],
                                    all->track ? all->track[k] : NULL));
        ritz_h5_close(group);
        group = 0;
    }
done:
    ritz_h5_close(group);
    ritz_h5_close(groups);
    return ritz_context(status, "rankings");
}

ritz_status ritz_container_write_rankings(const char *path,
                                          const ritz_rankings *rankings,
                                          const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};

    RITZ_TRY(ritz_writer_new(path, "ranking", "", stamp, &writer));
    if (rankings->count == 1)
        RITZ_TRY(write_one(writer.file, rankings->item,
                           rankings->track ? rankings->track[0] : NULL));
    else
        RITZ_TRY(write_several(writer.file, rankings));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_ranking(const char *path,
                                         const ritz_ranking *ranking,
                                         const ritz_stamp *stamp)
{
    ritz_ranking one = *ranking; /* borrowed */
    const ritz_rankings all = {.count = 1, .item = &one};

    return ritz_container_write_rankings(path, &all, stamp);
}
