/* Rankings put in one row, under names that say how they differ. */
#include "print/rankings_make.h"

#include <stdlib.h>
#include <string.h>

static ritz_status contest_new(int64_t count, contest *out)
{
    out->ranking = calloc((size_t)count + 1, sizeof(void *));
    out->track = calloc((size_t)count + 1, sizeof(void *));
    out->name = calloc((size_t)count + 1, sizeof *out->name);
    RITZ_REFUSE_IF(!out->ranking || !out->track || !out->name, RITZ_ERR_MEMORY,
                   "no memory for rankings");
    return RITZ_OK;
}

static void add(const ritz_ranking *ranking, const int64_t *track,
                const char *file, contest *out)
{
    out->ranking[out->count] = ranking;
    out->track[out->count] = track;
    snprintf(out->name[out->count++], sizeof *out->name, "%s", file);
}

/* " word", if there is one. */
static void append(const char *word, char *name, size_t size)
{
    size_t used = strlen(name);

    if (*word)
        snprintf(name + used, size - used, "%s%.60s", used > 0 ? " " : "",
                 word);
}

/* Whether what lies `offset` bytes into a ranking differs among them. */
static bool varies(const contest *c, size_t offset)
{
    for (int64_t k = 1; k < c->count; k++)
        if (strcmp((const char *)c->ranking[k] + offset,
                   (const char *)c->ranking[0] + offset) != 0)
            return true;
    return false;
}

/* By what differs; where nothing does, by ranking and number. */
static void name_all(contest *c)
{
    static const size_t part[] = {offsetof(ritz_ranking, at),
                                  offsetof(ritz_ranking, by),
                                  offsetof(ritz_ranking, damping)};
    size_t size = sizeof *c->name;

    for (size_t i = 0; i < sizeof part / sizeof *part; i++)
        for (int64_t k = 0; varies(c, part[i]) && k < c->count; k++)
            append((const char *)c->ranking[k] + part[i], c->name[k], size);
    for (int64_t k = 0; k < c->count; k++)
        if (!*c->name[k])
            append(c->ranking[k]->by, c->name[k], size);
}

ritz_status rank_contest(const rank_result *result, bool all, contest *out)
{
    ritz_status status = RITZ_OK;
    contest c = {0};
    int64_t count = 0;
    bool files = result->file != NULL;
    bool one = result->count == 1;

    for (int64_t g = 0; g < result->count; g++)
        count += result->group[g].all.count;
    RITZ_TRY(contest_new(count, &c));
    for (int64_t g = 0; g < result->count; g++) {
        const ranked *group = &result->group[g];
        const ritz_rankings *r = &group->all;

        if (!all && !files && !one) {
            add(ranked_whole(group), ranked_track(group), "", &c);
            continue;
        }
        for (int64_t k = 0; k < r->count; k++)
            add(&r->item[k], r->track ? r->track[k] : NULL,
                files && !one ? result->file[g] : "", &c);
    }
    c.chain = one && !files;
    name_all(&c);
    *out = c;
    c = (contest){0};
done:
    rank_contest_free(&c);
    return status;
}

void rank_contest_free(contest *all)
{
    free(all->ranking);
    free(all->track);
    free(all->name);
    *all = (contest){0};
}

ritz_status rank_write(const char *path, const rank_result *result,
                       const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    contest c = {0};
    ritz_rankings all = {0}; /* borrows what it holds */
    bool tracked = true;

    RITZ_TRY(rank_contest(result, true, &c));
    all.item = calloc((size_t)c.count + 1, sizeof *all.item);
    all.track = calloc((size_t)c.count + 1, sizeof *all.track);
    RITZ_FAIL_IF(!all.item || !all.track, RITZ_ERR_MEMORY,
                 "no memory for rankings");
    for (int64_t k = 0; k < c.count; k++) {
        all.item[k] = *c.ranking[k];
        tracked = tracked && c.track[k];
    }
    for (int64_t g = 0, k = 0; tracked && g < result->count; g++)
        for (int64_t i = 0; i < result->group[g].all.count; i++)
            all.track[k++] = result->group[g].all.track[i];
    all.count = c.count;
    if (!tracked) {
        free(all.track);
        all.track = NULL;
    }
    RITZ_TRY(ritz_container_write_rankings(path, &all, stamp));
done:
    free(all.item);
    free(all.track);
    rank_contest_free(&c);
    return status;
}
