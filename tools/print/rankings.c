#include "print/rankings.h"

#include "base/alloc.h"

/* Above this share of one mode in another's Gramian, Gregory's assumption of
 * modes that do not couple costs several percent. */
static const double coupled_limit = 0.1;

/* Values below this part of the largest are rounding: their relative difference
   means nothing. */
static const double invisible = 1e-12;
/* Only values above this part of the largest count in the sentence about the
   largest difference. */
static const double significant = 1e-6;

enum { MOST_PARTS = 6, CELL = 48 };

const ritz_ranking *ranked_whole(const ranked *group)
{
    return group->all.count == 1 ? group->all.item : &group->largest;
}

int64_t *ranked_track(const ranked *group)
{
    return group->all.count > 1 ? group->track : ranked_numbers(&group->all, 0);
}

int64_t *ranked_numbers(const ritz_rankings *all, int64_t k)
{
    return all->track ? all->track[k] : NULL;
}

void ranked_free(ranked *group)
{
    ritz_rankings_free(&group->all);
    ritz_ranking_free(&group->largest);
    RITZ_FREE(group->where, group->track);
    *group = (ranked){0};
}

static int64_t number_of(const int64_t *track, int64_t mode)
{
    return (track ? track[mode] : mode) + 1;
}

/* "7-8" of a cluster, "-" of a mode by itself. */
static void name_cluster(const ritz_ranking *r, const int64_t *track,
                         int64_t mode, char out[CELL])
{
    int64_t first = r->cluster[mode];
    int64_t last = mode;

    while (last + 1 < r->count && r->cluster[last + 1] == first)
        last++;
    snprintf(out, CELL, "-");
    if (last > first)
        snprintf(out, CELL, "%ld-%ld", number_of(track, first),
                 number_of(track, last));
}

/* The total of which shares are given. */
static double sum_of(const ritz_ranking *r)
{
    double sum = 0.0;

    if (!isnan(r->total))
        return r->total;
    for (int64_t k = 0; k < r->count; k++)
        sum += fabs(r->value[k]);
    return sum;
}

/* The value that a ranking by Hankel values has at place k if it is exact. */
static double exact_at(const ritz_ranking *r, int64_t k)
{
    const ritz_ranker *ranker = ritz_ranker_find(r->by);

    if (!ranker || !ranker->exact || 2 * k + 1 >= r->num_system)
        return nan("");
    return ranker->exact(r->system_value + 2 * k);
}

const char *rankings_damping(const ritz_ranking *r)
{
    if (*r->damping)
        return r->damping;
    return r->count > 0 && !(r->zeta[0] > 0.0) ? "none" : "of the matrices";
}

double rankings_difference(const ritz_ranking *r)
{
    double worst = nan("");
    double largest = r->count > 0 ? exact_at(r, 0) : nan("");

    for (int64_t k = 0; k < r->count; k++) {
        double exact = exact_at(r, k);

        if (exact > significant * largest)
            worst = fmax(worst, fabs(r->value[r->order[k]] / exact - 1.0));
    }
    return worst;
}

static double percent_of(double part, double whole)
{
    return whole != 0.0 ? 100.0 * part / whole : 0.0;
}

static bool shows_parts(const ritz_ranking *r)
{
    return r->num_parts > 1 && r->num_parts <= MOST_PARTS;
}

static void say_heads(const cli_run *run, const ritz_ranking *r)
{
    sink_part(run, "%4s %6s %14s %9s %7s %13.13s %7s", "rank", "mode", "Hz",
              "zeta", "cluster", r->by, "share");
    for (int64_t j = 0; shows_parts(r) && j < r->num_parts; j++)
        sink_part(run, " %10.10s", r->part[j]);
    cli_say(run, "%s",
            isnan(exact_at(r, 0))
                ? ""
                : "  exact Hankel values of the system  differs");
}

static void say_line(const cli_run *run, const ritz_ranking *r,
                     const int64_t *track, int64_t k)
{
    int64_t mode = r->order[k];
    double zeta = r->zeta[mode];
    double exact = exact_at(r, k);
    char cluster[CELL];

    name_cluster(r, track, mode, cluster);
    sink_part(run, "%4ld %6ld %14.7g %9.3g %7s %13.5e %6.2f%%", k + 1,
              number_of(track, mode), r->hertz[mode],
              zeta > 0.0 ? zeta : nan(""), cluster, r->value[mode],
              percent_of(r->value[mode], sum_of(r)));
    for (int64_t j = 0; shows_parts(r) && j < r->num_parts; j++) {
        double value = ritz_dense_col(&r->parts, j)[mode];

        if (isnan(r->whole[j]))
            sink_part(run, " %10.3g", value);
        else
            sink_part(run, " %9.2f%%", percent_of(value, r->whole[j]));
    }
    if (!isnan(exact))
        sink_part(run, "  %.5e %.5e", r->system_value[2 * k],
                  r->system_value[2 * k + 1]);
    if (exact > invisible * exact_at(r, 0))
        sink_part(run, "          %+9.1e", r->value[mode] / exact - 1.0);
    cli_say(run, "%s", "");
}

/* The sum over all modes of each part, in percent of the whole. */
static void say_sums(const cli_run *run, const ritz_ranking *r)
{
    char parts[MOST_PARTS * CELL] = "";

    for (int64_t j = 0; j < r->num_parts; j++) {
        double sum = 0.0;

        if (isnan(r->whole[j]))
            return;
        for (int64_t k = 0; k < r->count; k++)
            sum += ritz_dense_col(&r->parts, j)[k];
        sink_append(parts, sizeof parts, " %9.2f%%",
                    percent_of(sum, r->whole[j]));
    }
    cli_say(run, "%4s %52s %13s%s", "sum", "", "", parts);
}

void rankings_say(const cli_run *run, const ritz_ranking *r,
                  const int64_t *track, int64_t most)
{
    say_heads(run, r);
    for (int64_t k = 0; k < r->count && k < most; k++)
        say_line(run, r, track, k);
    if (r->count > most)
        cli_say(run, "     and %ld more", (r->count - most));
    if (shows_parts(r))
        say_sums(run, r);
    if (!isnan(r->total))
        cli_say(run, "all values add up to %.9g", r->total);
}

void rankings_say_place(const cli_run *run, const ritz_ranking *r,
                        const int64_t *track, int64_t number, int width)
{
    int64_t k = 0;

    while (k < r->count && number_of(track, r->order[k]) != number + 1)
        k++;
    if (k < r->count)
        sink_part(run, " %*ld", width, k + 1);
    else
        sink_part(run, " %*s", width, "-");
}

void rankings_say_largest(const cli_run *run, const ranked *group)
{
    enum { MOST_COLUMNS = 24 };
    const ritz_rankings *all = &group->all;
    const ritz_ranking *r = &group->largest;
    char cluster[CELL];

    cli_say(run,
            "\nLargest over %ld configurations by %s; modes are followed by "
            "%s:",
            all->count, r->by, all->track ? "track" : "number");
    cli_say(run, "%4s %6s %14s %7s %13.13s  %-24s %s", "rank",
            all->track ? "track" : "mode", "Hz", "cluster", r->by, "where",
            "place at each");
    for (int64_t k = 0; k < r->count; k++) {
        int64_t mode = r->order[k];

        name_cluster(r, group->track, mode, cluster);
        sink_part(run, "%4ld %6ld %14.7g %7s %13.5e  %-24s ", k + 1,
                  number_of(group->track, mode), r->hertz[mode], cluster,
                  r->value[mode], all->item[group->where[mode]].at);
        for (int64_t c = 0; c < all->count && all->count <= MOST_COLUMNS; c++)
            rankings_say_place(run, &all->item[c], ranked_numbers(all, c),
                               group->track[mode], 3);
        cli_say(run, "%s", "");
    }
}

void rankings_say_values(const cli_run *run, const ritz_ranking *r,
                         int64_t most)
{
    cli_say(run, "%6s %15s %15s", "order", "Hankel value", "bound if cut");
    for (int64_t k = 0; k < r->num_system && k < most; k++)
        cli_say(run, "%6ld %15.7e %15.7e", k + 1, r->system_value[k],
                ritz_hankel_bound(r->num_system, r->system_value, k + 1));
    if (r->num_system > most)
        cli_say(run, "       and %ld more", (r->num_system - most));
}

void rankings_set(cli_run *run, const ritz_ranking *r, const int64_t *track)
{
    bool item = json_is_array(sink_here(run));

    if (item)
        sink_object(run, NULL);
    sink_set(run, "by,at,damping,total,coupling,difference",
             "%s %s %s %g %g %g", r->by, r->at, r->damping, r->total,
             r->coupling, rankings_difference(r));
    sink_numbers(run, "order", r->count, r->order);
    sink_reals(run, "frequencies_hz", r->count, r->hertz);
    sink_reals(run, "zeta", r->count, r->zeta);
    sink_reals(run, "values", r->count, r->value);
    sink_numbers(run, "clusters", r->count, r->cluster);
    sink_reals(run, "system_values", r->num_system, r->system_value);
    if (track)
        sink_numbers(run, "tracks", r->count, track);
    for (int64_t j = 0; j < r->num_parts; j++) {
        sink_list(run, "parts");
        sink_object(run, NULL);
        sink_set(run, "name,whole", "%s %g", r->part[j], r->whole[j]);
        sink_reals(run, "values", r->count, ritz_dense_col(&r->parts, j));
        sink_end(run);
        sink_end(run);
    }
    if (item)
        sink_end(run);
}

/* Every ranking; the object that is open has the keys of the first too. */
void rankings_describe(cli_run *run, const ritz_rankings *all)
{
    const json_t *first = NULL;

    sink_set(run, "kind", "%s", "ranking");
    cli_say(run, "  %-14s %ld ranking%s", "kind", all->count,
            all->count == 1 ? "" : "s");
    sink_list(run, "rankings");
    for (int64_t k = 0; k < all->count; k++) {
        const ritz_ranking *r = &all->item[k];
        const int64_t *track = ranked_numbers(all, k);

        cli_say(run, "  %-14s of %ld flexible modes by %s [%s]%s%s, damping %s",
                "ranking", r->count, r->by, r->reference, *r->at ? ", at " : "",
                r->at, rankings_damping(r));
        if (r->count > 0)
            rankings_say(run, r, track, INT64_MAX);
        else
            rankings_say_values(run, r, INT64_MAX);
        rankings_set(run, r, track);
    }
    first = json_array_get(sink_here(run), 0);
    sink_end(run);
    if (first) {
        sink_lift(run, first);
        sink_set(run, "modes", "%ld", all->item[0].count);
    }
}

void rankings_warn(cli_run *run, const ranked *group)
{
    const ritz_ranking *worst = NULL;
    double differs = nan("");

    for (int64_t k = 0; k < group->all.count; k++) {
        const ritz_ranking *r = &group->all.item[k];

        differs = fmax(differs, rankings_difference(r));
        if (!isnan(r->coupling) && (!worst || r->coupling > worst->coupling))
            worst = r;
    }
    if (!worst)
        return;
    sink_say(run, json_object_get(run->report, "coupling") ? "" : ",,coupling",
             "coupling: modes %ld and %ld share %.3g of the exact "
             "Gramian%s%s",
             worst->coupled[0] + 1, worst->coupled[1] + 1, worst->coupling,
             *worst->at ? " at " : "", worst->at);
    if (!isnan(differs))
        cli_say(run, "values by %s differ from the exact ones by %.2g at most",
                worst->by, differs);
    if (!(worst->coupling > coupled_limit) || isnan(differs))
        return;
    cli_warn(run,
             "modes %ld and %ld couple by %.3g%s%s: values of single modes "
             "are rough there, trust the exact ones",
             worst->coupled[0] + 1, worst->coupled[1] + 1, worst->coupling,
             *worst->at ? " at " : "", worst->at);
}

void rankings_list_modes(int64_t count, const int64_t *mode, size_t size,
                         char *out)
{
    snprintf(out, size, "%s", count > 0 ? "" : "none");
    for (int64_t k = 0; k < count; k++)
        sink_append(out, size, "%s%ld", k > 0 ? " " : "", mode[k] + 1);
}

static const char *outcome_of(const ritz_reweighing *found, char out[128])
{
    if (found->period == 1)
        snprintf(out, 128, "settles after %ld rounds", found->rounds);
    else if (found->period > 1)
        snprintf(out, 128, "oscillates, with a period of %ld rounds",
                 found->period);
    else
        snprintf(out, 128, "neither settles nor repeats within %ld rounds",
                 found->rounds);
    return out;
}

void rankings_say_weights(cli_run *run, const ritz_rank_request *request,
                          const ritz_reweighing *found, int64_t keep)
{
    char kept[1024], other[1024], outcome[128];

    rankings_list_modes(found->num_kept, found->kept, sizeof kept, kept);
    rankings_list_modes(found->num_other, found->other, sizeof other, other);
    sink_object(run, "reweighting");
    sink_say(run, "keep", "\nReweighting outputs for %ld modes %s: modes %s.",
             keep, outcome_of(found, outcome), kept);
    cli_say(run, "%-24s %12s %13s %13s %8s", "output", "weight", "variance",
            "missed", "part");
    for (int64_t i = 0; i < found->num_outputs; i++)
        cli_say(run, "%-24s %12.5g %13.5e %13.5e %7.2f%%", request->output[i],
                found->weight[i], found->cost[i], found->missed[i],
                found->cost[i] > 0.0 ? 100.0 * found->missed[i] / found->cost[i]
                                     : 0.0);
    if (found->period != 1)
        cli_warn(run,
                 "reweighting %s: no weights are right for %ld modes; those "
                 "of the round that misses least are shown%s%s",
                 outcome, keep,
                 found->num_other > 0 ? ", others would keep modes " : "",
                 found->num_other > 0 ? other : "");
    sink_numbers(run, "kept", found->num_kept, found->kept);
    sink_numbers(run, "other", found->num_other, found->other);
    sink_set(run, "rounds,period", "%ld %ld", found->rounds, found->period);
    sink_reals(run, "weights", found->num_outputs, found->weight);
    sink_reals(run, "costs", found->num_outputs, found->cost);
    sink_reals(run, "missed", found->num_outputs, found->missed);
    sink_end(run);
}
