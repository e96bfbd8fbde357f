#include "print/print.h"

/* Above this share of one mode in another's Gramian, Gregory's assumption of
 * modes that do not couple costs several percent. */
static const double coupled_limit = 0.1;

/* Values below this part of the largest are rounding: their relative difference
   means nothing. */
static const double invisible = 1e-12;
/* Only values above this part of the largest count in the sentence about the
   largest difference. */
static const double significant = 1e-6;
/* Frequencies of one mode in two rankings of one model agree to rounding. */
static const double same_frequency = 1e-3;

enum { MOST_PARTS = 6, CELL = 48, MOST_COLUMNS = 10, LIST = 1024 };

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

/* One past the last mode of a run first, first + 1, ... within one cluster. */
static int64_t end_of_run(const ritz_ranking *r, int64_t first)
{
    int64_t last = first + 1;

    while (last < r->count && r->cluster[last] == r->cluster[first])
        last++;
    return last;
}

/* Members of a mode's cluster, as "7-8" or "2,5,7-8"; "-" if it has no others.
   A long list is cut, with the number of the other members: "2,5,7-8+21". */
static void name_cluster(const ritz_ranking *r, const int64_t *track,
                         int64_t mode, char out[CELL])
{
    enum { LONG = 12 };
    int64_t members = 0, more = 0, last = 0;

    out[0] = '\0';
    for (int64_t k = r->cluster[mode]; k < r->count; k = last) {
        last = end_of_run(r, k);
        if (r->cluster[k] != r->cluster[mode])
            continue;
        members += last - k;
        if (strlen(out) > LONG) {
            more += last - k;
            continue;
        }
        sink_append(out, CELL, "%s%ld", *out ? "," : "", number_of(track, k));
        if (last > k + 1)
            sink_append(out, CELL, "-%ld", number_of(track, last - 1));
    }
    if (more > 0)
        sink_append(out, CELL, "+%ld", more);
    if (members == 1)
        snprintf(out, CELL, "-");
}

/* Number of modes that are in their cluster by damping, not by frequency. */
static int64_t count_joined(const ritz_ranking *r)
{
    int64_t joined = 0;

    for (int64_t k = 0; k < r->count; k++)
        joined += fabs(r->hertz[k] - r->hertz[r->cluster[k]]) >
                  same_frequency * r->hertz[k];
    return joined;
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

/* Largest relative difference between values and exact Hankel values. NaN if
   values are no Hankel values, or if damping joins modes, whose single values
   have no exact counterpart. */
static double difference_of(const ritz_ranking *r)
{
    double worst = nan("");
    double largest = r->count > 0 ? exact_at(r, 0) : nan("");

    for (int64_t k = 0; k < r->count && count_joined(r) == 0; k++) {
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
    if (exact > invisible * exact_at(r, 0) && count_joined(r) == 0)
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

static void say_joined(const cli_run *run, const ritz_ranking *r)
{
    int64_t joined = count_joined(r);

    if (joined > 0)
        cli_say(run,
                "damping joins %ld modes to others: a cluster has one value, "
                "and is kept or left out whole",
                joined);
}

/* Exact values alone, with the bound of cutting there. */
static void say_values(const cli_run *run, const ritz_ranking *r, int64_t most)
{
    cli_say(run, "%6s %15s %15s", "order", "Hankel value", "bound if cut");
    for (int64_t k = 0; k < r->num_system && k < most; k++)
        cli_say(run, "%6ld %15.7e %15.7e", k + 1, r->system_value[k],
                ritz_hankel_bound(r->num_system, r->system_value, k + 1));
    if (r->num_system > most)
        cli_say(run, "       and %ld more", (r->num_system - most));
}

void rankings_say(const cli_run *run, const ritz_ranking *r,
                  const int64_t *track, int64_t most)
{
    if (r->count == 0 && r->num_system > 0) {
        say_values(run, r, most);
        return;
    }
    say_heads(run, r);
    for (int64_t k = 0; k < r->count && k < most; k++)
        say_line(run, r, track, k);
    if (r->count > most)
        cli_say(run, "     and %ld more", (r->count - most));
    say_joined(run, r);
    if (shows_parts(r))
        say_sums(run, r);
    if (!isnan(r->total))
        cli_say(run, "all values add up to %.9g", r->total);
}

/* " 3", the place of the mode with that number, right-aligned in `width`
   letters; " -" if the mode is not in the ranking. */
static void say_place(const cli_run *run, const ritz_ranking *r,
                      const int64_t *track, int64_t number, int width)
{
    int64_t k = 0;

    while (k < r->count && number_of(track, r->order[k]) != number)
        k++;
    if (k < r->count)
        sink_part(run, " %*ld", width, k + 1);
    else
        sink_part(run, " %*s", width, "-");
}

void rankings_say_largest(const cli_run *run, const ranked *group)
{
    enum { MOST_PLACES = 24 };
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
        for (int64_t c = 0; c < all->count && all->count <= MOST_PLACES; c++)
            say_place(run, &all->item[c], ranked_numbers(all, c),
                      number_of(group->track, mode), 3);
        cli_say(run, "%s", "");
    }
}

void rankings_set(cli_run *run, const ritz_ranking *r, const int64_t *track)
{
    bool item = json_is_array(sink_here(run));

    if (item)
        sink_object(run, NULL);
    sink_set(run, "by,at,damping,total,coupling,difference",
             "%s %s %s %g %g %g", r->by, r->at, r->damping, r->total,
             r->coupling, difference_of(r));
    sink_wholes(run, "order", r->count, r->order, 1);
    sink_reals(run, "frequencies_hz", r->count, r->hertz);
    sink_reals(run, "zeta", r->count, r->zeta);
    sink_reals(run, "values", r->count, r->value);
    sink_wholes(run, "clusters", r->count, r->cluster, 1);
    sink_set(run, "joined", "%ld", count_joined(r));
    sink_reals(run, "system_values", r->num_system, r->system_value);
    if (track)
        sink_wholes(run, "tracks", r->count, track, 1);
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
ritz_status describe_rankings(cli_run *run, const ritz_rankings *all)
{
    cli_say(run, "  %-14s %ld ranking%s", "kind", all->count,
            all->count == 1 ? "" : "s");
    SINK_EACH(run, "rankings", k, all->count) {
        const ritz_ranking *r = &all->item[k];
        const int64_t *track = ranked_numbers(all, k);

        cli_say(run, "  %-14s of %ld flexible modes by %s [%s]%s%s, damping %s",
                "ranking", r->count, r->by, r->reference, *r->at ? ", at " : "",
                r->at, rankings_damping(r));
        rankings_say(run, r, track, INT64_MAX);
        rankings_set(run, r, track);
    }
    if (all->count > 0) {
        sink_lift(run, json_array_get(
                           json_object_get(sink_here(run), "rankings"), 0));
        sink_set(run, "modes", "%ld", all->item[0].count);
    }
    return RITZ_OK;
}

void rankings_warn(cli_run *run, const ranked *group)
{
    const ritz_ranking *worst = NULL;
    double differs = nan("");

    for (int64_t k = 0; k < group->all.count; k++) {
        const ritz_ranking *r = &group->all.item[k];

        differs = fmax(differs, difference_of(r));
        if (!isnan(r->coupling) && (!worst || r->coupling > worst->coupling))
            worst = r;
    }
    if (!worst)
        return;
    if (worst->coupling > 0.0) /* otherwise all modes are one cluster */
        sink_say(run,
                 json_object_get(run->report, "coupling") ? "" : ",,coupling",
                 "coupling: modes %ld and %ld share %.3g of the exact "
                 "Gramian%s%s",
                 worst->coupled[0] + 1, worst->coupled[1] + 1, worst->coupling,
                 *worst->at ? " at " : "", worst->at);
    if (!isnan(differs))
        cli_say(run, "values by %s differ from the exact ones by %.2g at most",
                worst->by, differs);
    if (!(worst->coupling > coupled_limit) || isnan(exact_at(worst, 0)))
        return;
    cli_warn(run,
             "modes %ld and %ld couple by %.3g%s%s: values of single modes "
             "are rough there, trust the exact ones",
             worst->coupled[0] + 1, worst->coupled[1] + 1, worst->coupling,
             *worst->at ? " at " : "", worst->at);
}

/* "1 2 5" of indices of modes, or "none". */
static void list_modes(int64_t count, const int64_t *mode, char out[LIST])
{
    snprintf(out, LIST, "%s", count > 0 ? "" : "none");
    for (int64_t k = 0; k < count; k++)
        sink_append(out, LIST, "%s%ld", k > 0 ? " " : "", mode[k] + 1);
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
    char kept[LIST], other[LIST], outcome[128];

    list_modes(found->num_kept, found->kept, kept);
    list_modes(found->num_other, found->other, other);
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
    sink_wholes(run, "kept", found->num_kept, found->kept, 1);
    sink_wholes(run, "other", found->num_other, found->other, 1);
    sink_set(run, "rounds,period", "%ld %ld", found->rounds, found->period);
    sink_reals(run, "weights", found->num_outputs, found->weight);
    sink_reals(run, "costs", found->num_outputs, found->cost);
    sink_reals(run, "missed", found->num_outputs, found->missed);
    sink_end(run);
}

/* --- several side by side: correlations, overlaps, what swaps ------------- */

static void add_ranking(const ritz_ranking *ranking, int64_t *track,
                        const char *file, contest *out)
{
    out->ranking[out->count] = ranking;
    out->track[out->count] = track;
    snprintf(out->name[out->count++], sizeof *out->name, "%s", file);
}

/* " word", if there is one. */
static void append_word(const char *word, char *name, size_t size)
{
    if (*word)
        sink_append(name, size, "%s%.60s", *name ? " " : "", word);
}

/* True if the text `offset` bytes into a ranking differs among them. */
static bool text_varies(const contest *c, size_t offset)
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
        for (int64_t k = 0; text_varies(c, part[i]) && k < c->count; k++)
            append_word((const char *)c->ranking[k] + part[i], c->name[k],
                        size);
    for (int64_t k = 0; k < c->count; k++)
        if (!*c->name[k])
            append_word(c->ranking[k]->by, c->name[k], size);
}

ritz_status contest_new(const rank_result *result, bool all, contest *out)
{
    RITZ_OWN(contest) c = {0};
    int64_t count = 1;
    bool files = result->file != NULL;
    bool one = result->count == 1;

    for (int64_t g = 0; g < result->count; g++)
        count += result->group[g].all.count;
    c.ranking = ritz_zalloc(count, sizeof(void *));
    if (!c.ranking)
        return RITZ_ERR_MEMORY;
    RITZ_CHECK_NEW(c.track, count);
    RITZ_CHECK_NEW(c.name, count);
    for (int64_t g = 0; g < result->count; g++) {
        const ranked *group = &result->group[g];

        if (!all && !files && !one) {
            add_ranking(ranked_whole(group), ranked_track(group), "", &c);
            continue;
        }
        for (int64_t k = 0; k < group->all.count; k++)
            add_ranking(&group->all.item[k], ranked_numbers(&group->all, k),
                        files && !one ? result->file[g] : "", &c);
    }
    c.chain = one && !files;
    name_all(&c);
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

void contest_free(contest *all)
{
    RITZ_FREE(all->ranking, all->track, all->name);
    *all = (contest){0};
}

static void say_names(cli_run *run, const contest *all)
{
    cli_say(run, "\nRankings compared:");
    for (int64_t k = 0; k < all->count; k++)
        cli_say(run, "  %c  %s", (int)('A' + k % 26), all->name[k]);
}

/* Modes in the order of the first ranking, and their places in all. */
static void say_places(cli_run *run, const contest *all, int64_t most)
{
    const ritz_ranking *r = all->ranking[0];

    if (all->count > MOST_COLUMNS)
        return;
    sink_part(run, "%6s %14s  ", all->track[0] ? "track" : "mode", "Hz");
    for (int64_t c = 0; c < all->count; c++)
        sink_part(run, " %5c", (int)('A' + c));
    cli_say(run, "%s", "");
    for (int64_t k = 0; k < r->count && k < most; k++) {
        int64_t number = number_of(all->track[0], r->order[k]);

        sink_part(run, "%6ld %14.7g  ", number, r->hertz[r->order[k]]);
        for (int64_t c = 0; c < all->count; c++)
            say_place(run, all->ranking[c], all->track[c], number, 5);
        cli_say(run, "%s", "");
    }
    if (r->count > most)
        cli_say(run, "       and %ld more", (r->count - most));
}

static void say_pair(cli_run *run, const contest *all, int64_t a, int64_t b,
                     const ritz_agreement *g)
{
    char text[LIST] = "", left[LIST], entered[LIST];

    sink_object(run, NULL);
    SINK_EACH(run, "overlap", k, g->num_overlaps) {
        sink_set(run, "k,share", "%ld %g", g->overlap[k].k,
                 g->overlap[k].share);
        sink_append(text, sizeof text, "%s%ld: %.0f%%", k > 0 ? ", " : "",
                    g->overlap[k].k, 100.0 * g->overlap[k].share);
    }
    sink_say(run, "from,to", "%s to %s:", all->name[a], all->name[b]);
    sink_say(run, "spearman,kendall,modes",
             "  rank correlation: Spearman %.4f, Kendall %.4f, of %ld modes",
             g->spearman, g->kendall, g->common);
    if (g->alone[0] + g->alone[1] > 0)
        cli_say(run,
                "  %ld modes of the first and %ld of the second are not "
                "in the other",
                g->alone[0], g->alone[1]);
    cli_say(run, "  the first k in common, %s", text);
    list_modes(g->num_left, g->left, left);
    list_modes(g->num_entered, g->entered, entered);
    sink_wholes(run, "left", g->num_left, g->left, 1);
    sink_wholes(run, "entered", g->num_entered, g->entered, 1);
    sink_set(run, "top,top_share", "%ld %g", g->top, g->top_share);
    if (g->num_left + g->num_entered > 0)
        cli_say(run, "  among the first %ld: %s leave, %s enter", g->top, left,
                entered);
    sink_end(run);
}

/* Largest relative difference of frequencies of modes of one number. */
static double frequency_gap(const contest *all, int64_t a, int64_t b)
{
    const ritz_ranking *r = all->ranking[a];
    const ritz_ranking *s = all->ranking[b];
    double worst = 0.0;

    for (int64_t k = 0; k < r->count && k < s->count; k++)
        worst = fmax(worst, fabs(r->hertz[k] - s->hertz[k]) /
                                fmax(r->hertz[k], s->hertz[k]));
    return worst;
}

/* By number alone the same modes are meant only if frequencies say so. */
static void warn_numbers(cli_run *run, const contest *all)
{
    double worst = 0.0;

    for (int64_t k = 1; k < all->count; k++)
        if (!all->track[0] || !all->track[k])
            worst = fmax(worst, frequency_gap(all, all->chain ? k - 1 : 0, k));
    if (worst > same_frequency)
        cli_warn(run,
                 "modes are matched by number, and their frequencies differ by "
                 "%.2g: --tracks follows them by their shapes",
                 worst);
}

static ritz_status check_contest(const contest *all)
{
    for (int64_t k = 0; k < all->count; k++) {
        RITZ_REFUSE_IF(all->ranking[k]->count == 0, RITZ_ERR_ARGUMENT,
                       "'%s' has exact values and no modes: nothing to compare",
                       all->name[k]);
        RITZ_REFUSE_IF(!all->track[k] != !all->track[0], RITZ_ERR_ARGUMENT,
                       "'%s' has tracks and '%s' has none: modes cannot be "
                       "matched",
                       all->name[all->track[k] ? k : 0],
                       all->name[all->track[k] ? 0 : k]);
    }
    return RITZ_OK;
}

ritz_status rankings_compare(cli_run *run, const contest *all, int64_t top)
{
    sink_list(run, "comparison");
    RITZ_CHECK(check_contest(all));
    say_names(run, all);
    say_places(run, all, top);
    warn_numbers(run, all);
    for (int64_t b = 1; b < all->count; b++) {
        int64_t a = all->chain ? b - 1 : 0;
        RITZ_OWN(ritz_agreement) g = {0};

        RITZ_CHECK(ritz_rankings_agree(all->ranking[a], all->track[a],
                                       all->ranking[b], all->track[b], top,
                                       &g));
        say_pair(run, all, a, b, &g);
    }
    sink_end(run);
    return RITZ_OK;
}

/* True if all rankings are made of the same parts, which then are columns. */
static bool share_parts(const contest *all)
{
    const ritz_ranking *first = all->ranking[0];

    for (int64_t k = 1; k < all->count; k++) {
        const ritz_ranking *r = all->ranking[k];

        if (r->num_parts != first->num_parts)
            return false;
        for (int64_t j = 0; j < r->num_parts; j++)
            if (strcmp(r->part[j], first->part[j]) != 0)
                return false;
    }
    return true;
}

static void write_ranking(FILE *file, const contest *all, int64_t which,
                          bool parts)
{
    const ritz_ranking *r = all->ranking[which];
    int64_t rows = r->count > 0 ? r->count : r->num_system;

    for (int64_t k = 0; k < rows; k++) {
        int64_t mode = r->count > 0 ? r->order[k] : -1;

        fprintf(file, "%s\t%s\t%s\t%ld\t", r->by, r->at, r->damping, k + 1);
        if (mode >= 0)
            fprintf(file, "%ld\t%ld\t%ld\t%.12g\t%.6g\t%.12g", mode + 1,
                    number_of(all->track[which], mode), r->cluster[mode] + 1,
                    r->hertz[mode], r->zeta[mode], r->value[mode]);
        else
            fprintf(file, "nan\tnan\tnan\tnan\tnan\t%.12g", r->system_value[k]);
        for (int64_t i = 2 * k; i < 2 * k + 2; i++)
            if (mode >= 0 && i < r->num_system)
                fprintf(file, "\t%.12g", r->system_value[i]);
            else
                fprintf(file, "\tnan");
        for (int64_t j = 0; parts && j < r->num_parts; j++)
            fprintf(file, "\t%.12g", ritz_dense_col(&r->parts, j)[mode]);
        fprintf(file, "\n");
    }
}

ritz_status rankings_write_table(const char *path, const contest *all)
{
    bool parts = share_parts(all);
    RITZ_OWN(cli_table) table = {0};

    RITZ_CHECK(cli_table_new(&table));
    fprintf(table.file, "by\tat\tdamping\trank\tmode\ttrack\tcluster\thertz\t"
                        "zeta\tvalue\texact_1\texact_2");
    for (int64_t j = 0; parts && j < all->ranking[0]->num_parts; j++)
        fprintf(table.file, "\t%s", all->ranking[0]->part[j]);
    fprintf(table.file, "\n");
    for (int64_t k = 0; k < all->count; k++)
        write_ranking(table.file, all, k, parts);
    return cli_table_save(&table, path);
}
