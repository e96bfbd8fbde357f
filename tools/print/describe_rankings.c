#include "print/describe.h"
#include "print/rankings.h"

static void describe_one(const cli_run *run, const ritz_ranking *r,
                         const int64_t *track)
{
    cli_say(run, "  %-14s of %lld flexible modes by %s [%s]%s%s, damping %s",
            "ranking", (long long)r->count, r->by, r->reference,
            *r->at ? ", at " : "", r->at, rankings_damping(r));
    if (r->count > 0)
        rankings_say(run, r, track, INT64_MAX);
    else
        rankings_say_values(run, r, INT64_MAX);
}

void describe_rankings(const cli_run *run, json_t *keys,
                       const ritz_rankings *all)
{
    json_t *list = json_array();
    json_t *first = NULL;

    cli_say(run, "  %-14s %lld ranking%s", "kind", (long long)all->count,
            all->count == 1 ? "" : "s");
    for (int64_t k = 0; k < all->count; k++) {
        const int64_t *track = all->track ? all->track[k] : NULL;

        describe_one(run, &all->item[k], track);
        json_array_append_new(list, rankings_json(&all->item[k], track));
    }
    first = json_array_get(list, 0);
    if (first)
        json_object_update_missing(keys, first);
    json_object_set_new(keys, "kind", json_string("ranking"));
    if (first)
        json_object_set_new(keys, "modes", json_integer(all->item[0].count));
    json_object_set_new(keys, "rankings", list);
}
