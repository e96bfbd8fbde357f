/* Methods side by side: at equal order, and at equal error. */
#include "chart/html.h"
#include "chart/report.h"

#include <math.h>

enum { MOST_ORDERS = 8 };

/* Least order above another; INT64_MAX: none. */
static int64_t next_order(const records *all, int64_t above)
{
    int64_t least = INT64_MAX;

    for (int64_t k = 0; k < all->count; k++)
        if (all->item[k].order > above && all->item[k].order < least)
            least = all->item[k].order;
    return least;
}

/* Up to eight orders, spread over those there are. */
static int64_t pick_orders(const records *all, int64_t out[MOST_ORDERS])
{
    int64_t n = 0, kept = 0, at = 0;

    for (int64_t o = -1; (o = next_order(all, o)) < INT64_MAX;)
        n++;
    for (int64_t o = -1; (o = next_order(all, o)) < INT64_MAX; at++)
        if (n <= MOST_ORDERS || at == kept * (n - 1) / (MOST_ORDERS - 1))
            out[kept++] = o;
    return kept;
}

/* Least error of a method with at most so many coordinates; NaN: none. */
static double least_error(const selection *s, int64_t method, int64_t order)
{
    double least = nan("");

    for (int64_t k = 0; k < s->all.count; k++) {
        const record *r = &s->all.item[k];
        double error = record_error(r, s->measure->name);

        if (s->which[k] == method && r->order <= order && !r->incomplete &&
            !isnan(error) && !(least <= error))
            least = error;
    }
    return least < RECORDS_ROUNDING ? 0.5 * RECORDS_ROUNDING : least;
}

/* Smallest record of a method that is good enough; NULL: none. */
static const record *find_smallest(const selection *s, int64_t method,
                                   double level)
{
    const record *best = NULL;

    for (int64_t k = 0; k < s->all.count; k++) {
        const record *r = &s->all.item[k];
        bool good = isnan(level) ? r->feasible && r->tolerance
                                 : record_error(r, s->measure->name) <= level &&
                                       !r->incomplete;

        if (s->which[k] == method && good && (!best || r->order < best->order))
            best = r;
    }
    return best;
}

static void begin_table(FILE *file, const char *caption)
{
    html_print(file,
               "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
               "aria-label=\"%s\"><table><caption>%s</caption><thead><tr>"
               "<th scope=\"col\">method</th>",
               caption, caption);
}

static void put_cell(FILE *file, const char *text, const char *small, bool best)
{
    fprintf(file, "<td%s>", best ? " class=\"best\"" : "");
    html_print(file,
               *small ? "%s <span class=\"small\">%s</span></td>" : "%s%s</td>",
               text, small);
}

static void put_orders(FILE *file, const selection *s)
{
    int64_t order[MOST_ORDERS];
    double best[MOST_ORDERS];
    const int64_t count = pick_orders(&s->all, order);
    char text[PICTURE_WORD];

    snprintf(text, sizeof text, "Least %s with at most so many coordinates",
             s->measure->title);
    begin_table(file, text);
    for (int64_t k = 0; k < count; k++) {
        fprintf(file, "<th scope=\"col\">%lld</th>", (long long)order[k]);
        best[k] = HUGE_VAL;
        for (int64_t m = 0; m < s->num_methods; m++)
            best[k] = fmin(best[k], least_error(s, m, order[k]));
    }
    fprintf(file, "</tr></thead><tbody>\n");
    for (int64_t m = 0; m < s->num_methods; m++) {
        html_print(file, "<tr><th scope=\"row\">%s</th>", s->method[m]);
        for (int64_t k = 0; k < count; k++) {
            const double error = least_error(s, m, order[k]);
            char word[32];

            chart_say_error(error, word);
            put_cell(file, isnan(error) ? "\xe2\x80\x93" : word, "",
                     error <= best[k]);
        }
        fprintf(file, "</tr>\n");
    }
    fprintf(file, "</tbody></table></div>\n");
}

static void put_smallest(FILE *file, const record *r, bool best, bool simulate)
{
    const double time = r ? simulate ? r->cost : r->cpu : nan("");
    char order[32] = "\xe2\x80\x93", word[32] = "";

    if (r)
        snprintf(order, sizeof order, "%lld", (long long)r->order);
    if (isfinite(time))
        chart_say_seconds(time, word);
    put_cell(file, order, word, best);
}

static void put_levels(FILE *file, const selection *s)
{
    static const double levels[] = {(double)NAN, 0.1, 1e-2, 1e-3, 1e-4};
    enum { LEVELS = sizeof levels / sizeof *levels };
    const bool simulate = records_cost(&s->all);
    int64_t best[LEVELS];
    bool limits = false;
    char text[PICTURE_WORD], word[32];

    for (int64_t k = 0; k < s->all.count; k++)
        limits = limits || s->all.item[k].tolerance;
    snprintf(text, sizeof text,
             "Fewest coordinates for a %s of at most so much, and %s",
             s->measure->title,
             simulate ? "time for one simulated second" : "time to reduce");
    begin_table(file, text);
    for (int k = !limits; k < LEVELS; k++) {
        best[k] = INT64_MAX;
        for (int64_t m = 0; m < s->num_methods; m++) {
            const record *r = find_smallest(s, m, levels[k]);

            best[k] = r && r->order < best[k] ? r->order : best[k];
        }
        chart_say_error(levels[k], word);
        fprintf(file, "<th scope=\"col\">%s</th>",
                k == 0 ? "every tolerance" : word);
    }
    fprintf(file, "</tr></thead><tbody>\n");
    for (int64_t m = 0; m < s->num_methods; m++) {
        html_print(file, "<tr><th scope=\"row\">%s</th>", s->method[m]);
        for (int k = !limits; k < LEVELS; k++) {
            const record *r = find_smallest(s, m, levels[k]);

            put_smallest(file, r, r && r->order == best[k], simulate);
        }
        fprintf(file, "</tr>\n");
    }
    fprintf(file, "</tbody></table></div>\n");
}

void report_tables(FILE *file, const selection *s)
{
    fprintf(file, "<h3>At equal order</h3>\n");
    put_orders(file, s);
    fprintf(file, "<h3>At equal error</h3>\n");
    put_levels(file, s);
    fprintf(file, "<p class=\"note\">The best of each column stands in bold. "
                  "Models that miss a mode of the band do not count.</p>\n");
}
