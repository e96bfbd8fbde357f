/* Several rankings side by side: correlations, overlaps, what swaps. */
#include "print/rankings.h"

#include "cli/cli_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 10, CELL = 16, ROOM = 32, LIST = 1024 };

/* Frequencies of one mode in two rankings of one model agree to rounding. */
static const double same_frequency = 1e-3;

static int64_t number_of(const contest *all, int64_t which, int64_t mode)
{
    return all->track[which] ? all->track[which][mode] : mode;
}

/* Place from 1 of the mode of that number; 0: it is not there. */
static int64_t place_of(const contest *all, int64_t which, int64_t wanted)
{
    const ritz_ranking *r = all->ranking[which];

    for (int64_t k = 0; k < r->count; k++)
        if (number_of(all, which, r->order[k]) == wanted)
            return k + 1;
    return 0;
}

static void say_names(const cli_run *run, const contest *all)
{
    cli_say(run, "\nRankings compared:");
    for (int64_t k = 0; k < all->count; k++)
        cli_say(run, "  %c  %s", (int)('A' + k % 26), all->name[k]);
}

/* Modes in the order of the first ranking, and their places in all. */
static void say_places(const cli_run *run, const contest *all, int64_t most)
{
    const ritz_ranking *r = all->ranking[0];
    char line[MOST_COLUMNS * CELL] = "";
    size_t used = 0;

    if (all->count > MOST_COLUMNS)
        return;
    for (int64_t c = 0; c < all->count; c++)
        used += (size_t)snprintf(line + used, sizeof line - used, " %5c",
                                 (int)('A' + c));
    cli_say(run, "%6s %14s  %s", all->track[0] ? "track" : "mode", "Hz", line);
    for (int64_t k = 0; k < r->count && k < most; k++) {
        int64_t number = number_of(all, 0, r->order[k]);

        used = 0;
        for (int64_t c = 0; c < all->count; c++) {
            int64_t place = place_of(all, c, number);
            char cell[CELL] = "-";

            if (place > 0)
                snprintf(cell, sizeof cell, "%d", (int)place);
            used +=
                (size_t)snprintf(line + used, sizeof line - used, " %5s", cell);
        }
        cli_say(run, "%6lld %14.7g  %s", (long long)number + 1,
                r->hertz[r->order[k]], line);
    }
    if (r->count > most)
        cli_say(run, "       and %lld more", (long long)(r->count - most));
}

static void list(int64_t count, const int64_t *number, char out[LIST])
{
    size_t used = 0;

    snprintf(out, LIST, "none");
    for (int64_t k = 0; k < count && used + CELL < LIST; k++)
        used += (size_t)snprintf(out + used, LIST - used, "%s%lld",
                                 k > 0 ? " " : "", (long long)number[k] + 1);
}

static void say_pair(const cli_run *run, const contest *all, int64_t a,
                     int64_t b, const ritz_agreement *g)
{
    char text[LIST] = "", left[LIST], entered[LIST];
    size_t used = 0;

    for (int64_t k = 0; k < g->num_overlaps && used + ROOM < LIST; k++)
        used += (size_t)snprintf(text + used, LIST - used, "%s%lld: %.0f%%",
                                 k > 0 ? ", " : "", (long long)g->overlap[k].k,
                                 100.0 * g->overlap[k].share);
    cli_say(run, "%s to %s:", all->name[a], all->name[b]);
    cli_say(run,
            "  rank correlation: Spearman %.4f, Kendall %.4f, of %lld "
            "modes",
            g->spearman, g->kendall, (long long)g->common);
    if (g->alone[0] + g->alone[1] > 0)
        cli_say(run,
                "  %lld modes of the first and %lld of the second are not "
                "in the other",
                (long long)g->alone[0], (long long)g->alone[1]);
    cli_say(run, "  the first k in common, %s", text);
    list(g->num_left, g->left, left);
    list(g->num_entered, g->entered, entered);
    if (g->num_left + g->num_entered > 0)
        cli_say(run, "  among the first %lld: %s leave, %s enter",
                (long long)g->top, left, entered);
}

static json_t *numbers(int64_t count, const int64_t *number)
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, json_integer(number[k] + 1));
    return array;
}

static json_t *pair_json(const contest *all, int64_t a, int64_t b,
                         const ritz_agreement *g)
{
    json_t *item = json_object();
    json_t *overlap = json_array();

    for (int64_t k = 0; k < g->num_overlaps; k++) {
        json_t *one = json_object();

        json_object_set_new(one, "k", json_integer(g->overlap[k].k));
        json_object_set_new(one, "share", cli_real(g->overlap[k].share));
        json_array_append_new(overlap, one);
    }
    json_object_set_new(item, "from", cli_string(all->name[a]));
    json_object_set_new(item, "to", cli_string(all->name[b]));
    json_object_set_new(item, "modes", json_integer(g->common));
    json_object_set_new(item, "spearman", cli_real(g->spearman));
    json_object_set_new(item, "kendall", cli_real(g->kendall));
    json_object_set_new(item, "overlap", overlap);
    json_object_set_new(item, "top", json_integer(g->top));
    json_object_set_new(item, "top_share", cli_real(g->top_share));
    json_object_set_new(item, "left", numbers(g->num_left, g->left));
    json_object_set_new(item, "entered", numbers(g->num_entered, g->entered));
    return item;
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

static ritz_status check(const contest *all)
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
    ritz_status status = RITZ_OK;
    ritz_agreement g = {0};
    json_t *array = json_array();

    json_object_set_new(run->report, "comparison", array);
    RITZ_TRY(check(all));
    say_names(run, all);
    say_places(run, all, top);
    warn_numbers(run, all);
    for (int64_t b = 1; b < all->count; b++) {
        int64_t a = all->chain ? b - 1 : 0;

        RITZ_TRY(ritz_rankings_agree(all->ranking[a], all->track[a],
                                     all->ranking[b], all->track[b], top, &g));
        say_pair(run, all, a, b, &g);
        json_array_append_new(array, pair_json(all, a, b, &g));
        ritz_agreement_free(&g);
    }
done:
    ritz_agreement_free(&g);
    return status;
}

/* Whether all rankings are made of the same parts, which then are columns. */
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

        fprintf(file, "%s\t%s\t%s\t%lld\t", r->by, r->at, r->damping,
                (long long)k + 1);
        if (mode >= 0)
            fprintf(file, "%lld\t%lld\t%lld\t%.12g\t%.6g\t%.12g",
                    (long long)mode + 1,
                    (long long)number_of(all, which, mode) + 1,
                    (long long)r->cluster[mode] + 1, r->hertz[mode],
                    r->zeta[mode], r->value[mode]);
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
    ritz_status status = RITZ_OK;
    bool parts = share_parts(all);
    cli_table table = {0};

    RITZ_TRY(cli_table_new(&table));
    fprintf(table.file, "by\tat\tdamping\trank\tmode\ttrack\tcluster\thertz\t"
                        "zeta\tvalue\texact_1\texact_2");
    for (int64_t j = 0; parts && j < all->ranking[0]->num_parts; j++)
        fprintf(table.file, "\t%s", all->ranking[0]->part[j]);
    fprintf(table.file, "\n");
    for (int64_t k = 0; k < all->count; k++)
        write_ranking(table.file, all, k, parts);
    RITZ_TRY(cli_table_save(&table, path));
done:
    cli_table_free(&table);
    return status;
}
