/* Methods side by side: at equal order, and at equal error. */
#include "chart/report_parts.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ORDERS = 8 };

typedef struct side {
    const records *all;
    int64_t num_methods;
    const char **method;
    int64_t *which;
    measure *measure;
    int64_t num_measures;
} side;

static int by_size(const void *a, const void *b)
{
    const int64_t *x = a, *y = b;

    return (*x > *y) - (*x < *y);
}

/* Up to eight orders, spread over those there are. */
static int64_t pick_orders(const records *all, int64_t out[MOST_ORDERS])
{
    int64_t *order = calloc((size_t)all->count + 1, sizeof *order);
    int64_t n = 0, kept = 0;

    for (int64_t k = 0; order && k < all->count; k++)
        order[k] = all->item[k].order;
    if (order)
        qsort(order, (size_t)all->count, sizeof *order, by_size);
    for (int64_t k = 0; order && k < all->count; k++)
        if (n == 0 || order[n - 1] != order[k])
            order[n++] = order[k];
    kept = n < MOST_ORDERS ? n : MOST_ORDERS;
    for (int64_t k = 0; k < kept; k++)
        out[k] = order[kept == 1 ? 0 : k * (n - 1) / (kept - 1)];
    free(order);
    return kept;
}

/* Least error of a method with at most so many coordinates; NaN: none. */
static double least_error(const side *s, int64_t method, int64_t order)
{
    double least = nan("");

    for (int64_t k = 0; k < s->all->count; k++) {
        const record *r = &s->all->item[k];
        double error = record_error(r, s->measure->name);

        if (s->which[k] == method && r->order <= order && !r->incomplete &&
            !isnan(error) && !(least <= error))
            least = error;
    }
    return least < RECORDS_ROUNDING ? 0.5 * RECORDS_ROUNDING : least;
}

/* Smallest record of a method that is good enough; NULL: none. */
static const record *smallest(const side *s, int64_t method, double level)
{
    const record *best = NULL;

    for (int64_t k = 0; k < s->all->count; k++) {
        const record *r = &s->all->item[k];
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
    fprintf(file, "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                  "aria-label=\"");
    html_text(file, caption);
    fprintf(file, "\"><table><caption>");
    html_text(file, caption);
    fprintf(file, "</caption><thead><tr><th scope=\"col\">method</th>");
}

static void begin_row(FILE *file, const char *name)
{
    fprintf(file, "<tr><th scope=\"row\">");
    html_text(file, name);
    fprintf(file, "</th>");
}

static void put_orders(FILE *file, const side *s)
{
    int64_t order[MOST_ORDERS];
    double best[MOST_ORDERS];
    int64_t count = pick_orders(s->all, order);
    char caption[CHART_WORD], word[32];

    snprintf(caption, sizeof caption,
             "Least %s with at most so many coordinates", s->measure->title);
    begin_table(file, caption);
    for (int64_t k = 0; k < count; k++) {
        fprintf(file, "<th scope=\"col\">%lld</th>", (long long)order[k]);
        best[k] = HUGE_VAL;
        for (int64_t m = 0; m < s->num_methods; m++)
            best[k] = fmin(best[k], least_error(s, m, order[k]));
    }
    fprintf(file, "</tr></thead><tbody>\n");
    for (int64_t m = 0; m < s->num_methods; m++) {
        begin_row(file, s->method[m]);
        for (int64_t k = 0; k < count; k++) {
            double error = least_error(s, m, order[k]);

            chart_say_error(error, word);
            fprintf(file, "<td%s>", error <= best[k] ? " class=\"best\"" : "");
            html_text(file, isnan(error) ? "\xe2\x80\x93" : word);
            fprintf(file, "</td>");
        }
        fprintf(file, "</tr>\n");
    }
    fprintf(file, "</tbody></table></div>\n");
}

static void put_cell(FILE *file, const record *r, int64_t best, bool simulate)
{
    double time = r ? simulate ? r->cost : r->cpu : nan("");
    char word[32];

    if (!r) {
        fprintf(file, "<td>&#8211;</td>");
        return;
    }
    fprintf(file, "<td%s>%lld", r->order == best ? " class=\"best\"" : "",
            (long long)r->order);
    if (isfinite(time)) {
        chart_say_seconds(time, word);
        fprintf(file, " <span class=\"small\">%s</span>", word);
    }
    fprintf(file, "</td>");
}

static void put_levels(FILE *file, const side *s)
{
    static const double levels[] = {(double)NAN, 0.1, 1e-2, 1e-3, 1e-4};
    enum { LEVELS = sizeof levels / sizeof *levels };
    int64_t best[LEVELS];
    bool limits = false;
    char caption[CHART_WORD], word[32];

    for (int64_t k = 0; k < s->all->count; k++)
        limits = limits || s->all->item[k].tolerance;
    snprintf(caption, sizeof caption,
             "Fewest coordinates for a %s of at most so much, and %s",
             s->measure->title,
             records_cost(s->all) ? "time for one simulated second"
                                  : "time to reduce");
    begin_table(file, caption);
    for (int k = !limits; k < LEVELS; k++) {
        best[k] = INT64_MAX;
        for (int64_t m = 0; m < s->num_methods; m++) {
            const record *r = smallest(s, m, levels[k]);

            best[k] = r && r->order < best[k] ? r->order : best[k];
        }
        chart_say_error(levels[k], word);
        fprintf(file, "<th scope=\"col\">%s</th>",
                k == 0 ? "every tolerance" : word);
    }
    fprintf(file, "</tr></thead><tbody>\n");
    for (int64_t m = 0; m < s->num_methods; m++) {
        begin_row(file, s->method[m]);
        for (int k = !limits; k < LEVELS; k++)
            put_cell(file, smallest(s, m, levels[k]), best[k],
                     records_cost(s->all));
        fprintf(file, "</tr>\n");
    }
    fprintf(file, "</tbody></table></div>\n");
}

ritz_status report_tables(FILE *file, const records *all)
{
    ritz_status status = RITZ_OK;
    side s = {.all = all};

    RITZ_TRY(records_measures(all, &s.num_measures, &s.measure));
    RITZ_TRY(records_methods(all, &s.num_methods, &s.method, &s.which));
    fprintf(file, "<h3>At equal order</h3>\n");
    put_orders(file, &s);
    fprintf(file, "<h3>At equal error</h3>\n");
    put_levels(file, &s);
    fprintf(file, "<p class=\"note\">The best of each column stands in bold. "
                  "Models that miss a mode of the band do not count.</p>\n");
done:
    free(s.measure);
    free(s.method);
    free(s.which);
    return status;
}

void report_table(FILE *file, const char *text, const char *caption)
{
    bool head = true;

    fprintf(file, "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                  "aria-label=\"");
    html_text(file, caption);
    fprintf(file, "\"><table><caption>");
    html_text(file, caption);
    fprintf(file, "</caption>\n");
    while (*text) {
        const char *end = text + strcspn(text, "\n");

        fprintf(file, head ? "<thead><tr>" : "<tr>");
        while (text <= end && text[0]) {
            size_t length = strcspn(text, "\t\n");
            char *cell = strndup(text, length);

            fprintf(file, head ? "<th scope=\"col\">" : "<td>");
            if (cell)
                html_text(file, cell);
            fprintf(file, head ? "</th>" : "</td>");
            free(cell);
            text += length + 1;
            if (text > end)
                break;
        }
        fprintf(file, head ? "</tr></thead><tbody>\n" : "</tr>\n");
        head = false;
        text = *end ? end + 1 : end;
    }
    fprintf(file, "</tbody></table></div>\n");
}
