#include "print/rankings.h"

#include <ritz/gramians.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Above this share of one mode in another's Gramian, Gregory's assumption of
 * modes that do not couple costs several percent. */
static const double coupled_limit = 0.1;

/* Of the largest: a value that is rounding differs from another by anything. */
static const double invisible = 1e-12;
/* The same of those whose difference is worth a sentence. */
static const double significant = 1e-6;

enum { MOST_PARTS = 6, CELL = 48 };

const ritz_ranking *ranked_whole(const ranked *group)
{
    return group->all.count == 1 ? group->all.item : &group->largest;
}

const int64_t *ranked_track(const ranked *group)
{
    if (group->all.count > 1)
        return group->track;
    return group->all.track ? group->all.track[0] : NULL;
}

void ranked_free(ranked *group)
{
    ritz_rankings_free(&group->all);
    ritz_ranking_free(&group->largest);
    free(group->where);
    free(group->track);
    *group = (ranked){0};
}

static long long number(const int64_t *track, int64_t mode)
{
    return (long long)(track ? track[mode] : mode) + 1;
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
        snprintf(out, CELL, "%lld-%lld", number(track, first),
                 number(track, last));
}

/* What shares are shares of. */
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

static void say_parts(const ritz_ranking *r, int64_t mode, size_t size,
                      char *out)
{
    size_t used = 0;

    out[0] = '\0';
    for (int64_t j = 0; j < r->num_parts && used < size; j++) {
        double value = ritz_dense_col(&r->parts, j)[mode];
        double whole = r->whole[j];

        used +=
            (size_t)(isnan(whole)
                         ? snprintf(out + used, size - used, " %10.3g", value)
                         : snprintf(out + used, size - used, " %9.2f%%",
                                    whole != 0.0 ? 100.0 * value / whole
                                                 : 0.0));
    }
}

static bool shows_parts(const ritz_ranking *r)
{
    return r->num_parts > 1 && r->num_parts <= MOST_PARTS;
}

static void say_heads(const cli_run *run, const ritz_ranking *r)
{
    char parts[MOST_PARTS * CELL] = "";
    size_t used = 0;

    for (int64_t j = 0; shows_parts(r) && j < r->num_parts; j++)
        used += (size_t)snprintf(parts + used, sizeof parts - used, " %10.10s",
                                 r->part[j]);
    cli_say(run, "%4s %6s %14s %9s %7s %13.13s %7s%s%s", "rank", "mode", "Hz",
            "zeta", "cluster", r->by, "share", parts,
            isnan(exact_at(r, 0))
                ? ""
                : "  exact Hankel values of the system  differs");
}

static void say_line(const cli_run *run, const ritz_ranking *r,
                     const int64_t *track, int64_t k)
{
    int64_t mode = r->order[k];
    double total = sum_of(r);
    double exact = exact_at(r, k);
    char cluster[CELL], zeta[CELL] = "-";
    char parts[MOST_PARTS * CELL] = "";
    char beside[64] = "", differs[CELL] = "";

    name_cluster(r, track, mode, cluster);
    if (r->zeta[mode] > 0.0)
        snprintf(zeta, sizeof zeta, "%.3g", r->zeta[mode]);
    if (shows_parts(r))
        say_parts(r, mode, sizeof parts, parts);
    if (!isnan(exact))
        snprintf(beside, sizeof beside, "  %.5e %.5e", r->system_value[2 * k],
                 r->system_value[2 * k + 1]);
    if (exact > invisible * exact_at(r, 0))
        snprintf(differs, sizeof differs, "          %+9.1e",
                 r->value[mode] / exact - 1.0);
    cli_say(run, "%4lld %6lld %14.7g %9s %7s %13.5e %6.2f%%%s%s%s",
            (long long)k + 1, number(track, mode), r->hertz[mode], zeta,
            cluster, r->value[mode],
            total != 0.0 ? 100.0 * r->value[mode] / total : 0.0, parts, beside,
            differs);
}

/* What all modes of the model have of each part. */
static void say_sums(const cli_run *run, const ritz_ranking *r)
{
    char parts[MOST_PARTS * CELL] = "";
    size_t used = 0;

    for (int64_t j = 0; j < r->num_parts; j++) {
        double sum = 0.0;

        if (isnan(r->whole[j]))
            return;
        for (int64_t k = 0; k < r->count; k++)
            sum += ritz_dense_col(&r->parts, j)[k];
        used += (size_t)snprintf(parts + used, sizeof parts - used, " %9.2f%%",
                                 r->whole[j] != 0.0 ? 100.0 * sum / r->whole[j]
                                                    : 0.0);
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
        cli_say(run, "     and %lld more", (long long)(r->count - most));
    if (shows_parts(r))
        say_sums(run, r);
    if (!isnan(r->total))
        cli_say(run, "all values add up to %.9g", r->total);
}

/* Places of one mode in each ranking of a group: "  1  2  -". */
static void say_places(const ranked *group, int64_t number_wanted, size_t size,
                       char *out)
{
    size_t used = 0;

    for (int64_t c = 0; c < group->all.count && used + CELL < size; c++) {
        const ritz_ranking *r = &group->all.item[c];
        long long place = 0;

        for (int64_t k = 0; k < r->count; k++) {
            int64_t mode = r->order[k];
            int64_t n = group->all.track ? group->all.track[c][mode] : mode;

            if (n == number_wanted)
                place = (long long)k + 1;
        }
        used += (size_t)(place > 0 ? snprintf(out + used, size - used, " %3lld",
                                              place)
                                   : snprintf(out + used, size - used, "   -"));
    }
}

void rankings_say_largest(const cli_run *run, const ranked *group)
{
    enum { MOST_COLUMNS = 24 };
    const ritz_ranking *r = &group->largest;
    char places[MOST_COLUMNS * 8] = "";
    char cluster[CELL];

    cli_say(run,
            "\nLargest over %lld configurations by %s; modes are followed by "
            "%s:",
            (long long)group->all.count, r->by,
            group->all.track ? "track" : "number");
    cli_say(run, "%4s %6s %14s %7s %13.13s  %-24s %s", "rank",
            group->all.track ? "track" : "mode", "Hz", "cluster", r->by,
            "where", "place at each");
    for (int64_t k = 0; k < r->count; k++) {
        int64_t mode = r->order[k];

        name_cluster(r, group->track, mode, cluster);
        if (group->all.count <= MOST_COLUMNS)
            say_places(group, group->track[mode], sizeof places, places);
        cli_say(run, "%4lld %6lld %14.7g %7s %13.5e  %-24s %s",
                (long long)k + 1, number(group->track, mode), r->hertz[mode],
                cluster, r->value[mode], group->all.item[group->where[mode]].at,
                places);
    }
}

void rankings_say_values(const cli_run *run, const ritz_ranking *r,
                         int64_t most)
{
    cli_say(run, "%6s %15s %15s", "order", "Hankel value", "bound if cut");
    for (int64_t k = 0; k < r->num_system && k < most; k++)
        cli_say(run, "%6lld %15.7e %15.7e", (long long)k + 1,
                r->system_value[k],
                ritz_hankel_bound(r->num_system, r->system_value, k + 1));
    if (r->num_system > most)
        cli_say(run, "       and %lld more", (long long)(r->num_system - most));
}

static json_t *reals(int64_t count, const double *values)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, cli_real(values[k]));
    return array;
}

static json_t *numbers(int64_t count, const int64_t *values)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, json_integer(values[k] + 1));
    return array;
}

static json_t *parts_json(const ritz_ranking *r)
{
    json_t *array = json_array();

    for (int64_t j = 0; j < r->num_parts; j++) {
        json_t *item = json_object();

        json_object_set_new(item, "name", cli_string(r->part[j]));
        json_object_set_new(item, "whole", cli_real(r->whole[j]));
        json_object_set_new(item, "values",
                            reals(r->count, ritz_dense_col(&r->parts, j)));
        json_array_append_new(array, item);
    }
    return array;
}

json_t *rankings_json(const ritz_ranking *r, const int64_t *track)
{
    json_t *item = json_object();

    json_object_set_new(item, "by", cli_string(r->by));
    json_object_set_new(item, "at", cli_string(r->at));
    json_object_set_new(item, "damping", cli_string(r->damping));
    json_object_set_new(item, "order", numbers(r->count, r->order));
    json_object_set_new(item, "frequencies_hz", reals(r->count, r->hertz));
    json_object_set_new(item, "zeta", reals(r->count, r->zeta));
    json_object_set_new(item, "values", reals(r->count, r->value));
    json_object_set_new(item, "clusters", numbers(r->count, r->cluster));
    json_object_set_new(item, "total", cli_real(r->total));
    json_object_set_new(item, "system_values",
                        reals(r->num_system, r->system_value));
    json_object_set_new(item, "coupling", cli_real(r->coupling));
    json_object_set_new(item, "difference", cli_real(rankings_difference(r)));
    if (track)
        json_object_set_new(item, "tracks", numbers(r->count, track));
    if (r->num_parts > 0)
        json_object_set_new(item, "parts", parts_json(r));
    return item;
}

/* Of one model every ranking has the same to say. */
static bool was_warned(const cli_run *run, const char *text)
{
    for (size_t k = 0; k < json_array_size(run->warnings); k++) {
        const char *before =
            json_string_value(json_array_get(run->warnings, k));

        if (before && strcmp(before, text) == 0)
            return true;
    }
    return false;
}

void rankings_warn(cli_run *run, const ranked *group)
{
    char text[256];
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
    cli_say(run,
            "coupling: modes %lld and %lld share %.3g of the exact Gramian%s%s",
            (long long)worst->coupled[0] + 1, (long long)worst->coupled[1] + 1,
            worst->coupling, *worst->at ? " at " : "", worst->at);
    if (!isnan(differs))
        cli_say(run, "values by %s differ from the exact ones by %.2g at most",
                worst->by, differs);
    if (!json_object_get(run->report, "coupling"))
        json_object_set_new(run->report, "coupling", cli_real(worst->coupling));
    if (!(worst->coupling > coupled_limit) || isnan(differs))
        return;
    snprintf(text, sizeof text,
             "modes %lld and %lld couple by %.3g%s%s: values of single modes "
             "are rough there, trust the exact ones",
             (long long)worst->coupled[0] + 1, (long long)worst->coupled[1] + 1,
             worst->coupling, *worst->at ? " at " : "", worst->at);
    if (!was_warned(run, text))
        cli_warn(run, "%s", text);
}

/* "1 2 5" of modes. */
static void list_modes(int64_t count, const int64_t *mode, size_t size,
                       char *out)
{
    size_t used = 0;

    snprintf(out, size, "none");
    for (int64_t k = 0; k < count && used + CELL < size; k++)
        used += (size_t)snprintf(out + used, size - used, "%s%lld",
                                 k > 0 ? " " : "", (long long)mode[k] + 1);
}

static const char *outcome_of(const ritz_reweighing *found, char out[128])
{
    if (found->period == 1)
        snprintf(out, 128, "settles after %lld rounds",
                 (long long)found->rounds);
    else if (found->period > 1)
        snprintf(out, 128, "oscillates, with a period of %lld rounds",
                 (long long)found->period);
    else
        snprintf(out, 128, "neither settles nor repeats within %lld rounds",
                 (long long)found->rounds);
    return out;
}

void rankings_say_weights(cli_run *run, const ritz_rank_request *request,
                          const ritz_reweighing *found, int64_t keep)
{
    json_t *item = json_object();
    char kept[1024], other[1024], outcome[128];

    list_modes(found->num_kept, found->kept, sizeof kept, kept);
    list_modes(found->num_other, found->other, sizeof other, other);
    cli_say(run, "\nReweighting outputs for %lld modes %s: modes %s.",
            (long long)keep, outcome_of(found, outcome), kept);
    cli_say(run, "%-24s %12s %13s %13s %8s", "output", "weight", "variance",
            "missed", "part");
    for (int64_t i = 0; i < found->num_outputs; i++)
        cli_say(run, "%-24s %12.5g %13.5e %13.5e %7.2f%%", request->output[i],
                found->weight[i], found->cost[i], found->missed[i],
                found->cost[i] > 0.0 ? 100.0 * found->missed[i] / found->cost[i]
                                     : 0.0);
    if (found->period != 1)
        cli_warn(run,
                 "reweighting %s: no weights are right for %lld modes; those "
                 "of the round that misses least are shown%s%s",
                 outcome, (long long)keep,
                 found->num_other > 0 ? ", others would keep modes " : "",
                 found->num_other > 0 ? other : "");
    json_object_set_new(run->report, "reweighting", item);
    json_object_set_new(item, "keep", json_integer(keep));
    json_object_set_new(item, "kept", numbers(found->num_kept, found->kept));
    json_object_set_new(item, "other", numbers(found->num_other, found->other));
    json_object_set_new(item, "rounds", json_integer(found->rounds));
    json_object_set_new(item, "period", json_integer(found->period));
    json_object_set_new(item, "weights",
                        reals(found->num_outputs, found->weight));
    json_object_set_new(item, "costs", reals(found->num_outputs, found->cost));
    json_object_set_new(item, "missed",
                        reals(found->num_outputs, found->missed));
}
