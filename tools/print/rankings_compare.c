/* Several rankings side by side: correlations, overlaps, what swaps. */
#include "print/rankings.h"

#include "base/alloc.h"

#include "cli/cli_table.h"

enum { MOST_COLUMNS = 10, LIST = 1024 };

/* Frequencies of one mode in two rankings of one model agree to rounding. */
static const double same_frequency = 1e-3;

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

static int64_t number_of(const contest *all, int64_t which, int64_t mode)
{
    return all->track[which] ? all->track[which][mode] : mode;
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
        int64_t number = number_of(all, 0, r->order[k]);

        sink_part(run, "%6ld %14.7g  ", number + 1, r->hertz[r->order[k]]);
        for (int64_t c = 0; c < all->count; c++)
            rankings_say_place(run, all->ranking[c], all->track[c], number, 5);
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
    sink_list(run, "overlap");
    for (int64_t k = 0; k < g->num_overlaps; k++) {
        sink_set(run, "k,share", "%ld %g", g->overlap[k].k,
                 g->overlap[k].share);
        sink_append(text, sizeof text, "%s%ld: %.0f%%", k > 0 ? ", " : "",
                    g->overlap[k].k, 100.0 * g->overlap[k].share);
    }
    sink_end(run);
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
    rankings_list_modes(g->num_left, g->left, LIST, left);
    rankings_list_modes(g->num_entered, g->entered, LIST, entered);
    sink_numbers(run, "left", g->num_left, g->left);
    sink_numbers(run, "entered", g->num_entered, g->entered);
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
                    number_of(all, which, mode) + 1, r->cluster[mode] + 1,
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
