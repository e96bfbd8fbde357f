/*
 * Errors of run records, against time (pareto) or order (convergence): a panel
 * for each measure, a series for each method.
 */
#include "chart/chart.h"

#include "base/alloc.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

/* A finite element model is itself wrong by about this: see docs/chart.md. */
static const double uncertainty = 0.1;

typedef struct form {
    const char *title, *xlabel;
    bool times;    /* pareto: x is a time, on a logarithmic axis, and there is a
                   front; else an order, and a line for each method */
    bool simulate; /* the time is that of a simulated second */
} form;

/* Pixels, as errors.gp has them: of a cell, and of its panel. */
enum { CELL_WIDE = 490, CELL_HIGH = 380, PANEL_WIDE = 376, PANEL_HIGH = 280 };

/* A reader cannot distinguish two marks that are nearer than this, in
   pixels. */
static const double mark_apart = 5.0;

/* The order of a point of the front is written if the point is this far from
   the last one with its order, in one direction or the other; pixels. */
static const double word_wide = 28.0, word_high = 15.0;

/* Part of the height of a panel that stays free below the lowest point, for its
   mark and its order. */
static const double foot_part = 0.07;

/* Least ratio of the ends of an axis of times, so that two of the numbers 1, 2
   and 5 of a decade are on it. */
static const double least_ratio = 6.25;

/* Kinds of rows of the data, column "style". */
enum { MEETS, MISSES, CHOSEN, RUNNER_UP, ON_FRONT, ON_LINE };

/* The axes of a panel and its tolerance (0: none), for the template. */
typedef struct panel {
    double x_low, x_high, y_low, y_high, tolerance;
} panel;

/* A chart while it is composed. */
typedef struct work {
    const form *form;
    record_set *s;
    panel *panel;      /* of each measure */
    double *x, *y;     /* of each record, as drawn; NaN: not in this panel */
    picture_point *at; /* the same in pixels of the panel */
    int64_t *order;    /* records in the order of a line */
    int64_t lifted, left_out; /* errors drawn at the foot; not drawn */
    picture *picture;
} work;

static void work_free(work *w)
{
    RITZ_FREE(w->panel, w->x, w->y, w->at, w->order);
}

/* --- scales --------------------------------------------------------------- */

chart_range chart_decades(int64_t count, const double *values,
                          double floor_value, int64_t *lifted)
{
    chart_range range = {HUGE_VAL, 0.0};

    *lifted = 0;
    for (int64_t k = 0; k < count; k++) {
        if (!isfinite(values[k]))
            continue;
        *lifted += values[k] <= floor_value;
        if (values[k] > floor_value)
            range.low = fmin(range.low, values[k]);
        range.high = fmax(range.high, values[k]);
    }
    if (!(range.high > floor_value))
        range.low = range.high = 3.0 * floor_value;
    range.low = pow(10.0, floor(log10(range.low) - 0.08));
    range.high = pow(10.0, ceil(log10(range.high) + 0.08));
    if (*lifted > 0)
        range.low /= 10.0;
    return range;
}

/* The abscissa of a record; NaN: it is not known. */
static double x_of(const form *f, const record *r)
{
    if (!f->times)
        return (double)r->order;
    return f->simulate ? r->cost : r->cpu;
}

/* Coordinates of all records in the panel of a measure, and its axes. */
static void place_records(work *w, const measure *m, panel *p)
{
    double least = HUGE_VAL, most = 0.0;
    chart_range y = {0.0, 0.0};
    int64_t lifted = 0;

    for (int64_t k = 0; k < w->s->all.count; k++) {
        w->x[k] = x_of(w->form, &w->s->all.item[k]);
        w->y[k] = record_error(&w->s->all.item[k], m->name);
        if (!isfinite(w->y[k]) || !isfinite(w->x[k]) ||
            (w->form->times && !(w->x[k] > 0.0))) {
            w->left_out++;
            w->x[k] = w->y[k] = nan("");
            continue;
        }
        least = fmin(least, w->x[k]);
        most = fmax(most, w->x[k]);
    }
    y = chart_decades(w->s->all.count, w->y, RECORDS_ROUNDING, &lifted);
    w->lifted += lifted;
    *p = (panel){.x_low = least > most ? 0.5 : 0.7 * least,
                 .x_high = least > most ? 2.0 : 1.3 * most,
                 .y_low = y.low,
                 .y_high = y.high};
    if (p->x_high < least_ratio * p->x_low) {
        p->x_low *= sqrt(p->x_high / p->x_low / least_ratio);
        p->x_high = least_ratio * p->x_low;
    }
    if (!w->form->times)
        p->x_high = most > 0.0 ? 1.05 * most : 1.0;
    if (m->tolerance > 0.0) {
        p->tolerance = m->tolerance;
        if (m->tolerance < p->y_low)
            p->y_low = m->tolerance / 2.0;
        if (m->tolerance >= p->y_high)
            p->y_high = 2.0 * m->tolerance;
    }
    const double foot = p->y_low;

    p->y_low *= pow(p->y_low / p->y_high, foot_part);
    for (int64_t k = 0; k < w->s->all.count; k++) {
        w->y[k] = isnan(w->y[k]) ? w->y[k] : fmax(w->y[k], foot);
        w->at[k].x = PANEL_WIDE *
                     (w->form->times
                          ? log(w->x[k] / p->x_low) / log(p->x_high / p->x_low)
                          : w->x[k] / p->x_high);
        w->at[k].y =
            PANEL_HIGH * log(w->y[k] / p->y_low) / log(p->y_high / p->y_low);
    }
}

/* --- front and lines ------------------------------------------------------ */

/* Whether record a stands before b: to the left of it, or there and lower. */
static bool is_before(const work *w, int64_t a, int64_t b)
{
    if (w->x[a] != w->x[b])
        return w->x[a] < w->x[b];
    return w->y[a] != w->y[b] ? w->y[a] < w->y[b] : a < b;
}

/*
 * Records of the front (method -1), each lower than all to the left of it, or
 * the best of a method at each order; from left to right. A model without all
 * modes of the band is on neither.
 */
static int64_t list_line(work *w, int64_t method)
{
    int64_t count = 0, kept = 0;

    for (int64_t k = 0; k < w->s->all.count; k++) {
        int64_t at = count;

        if (isnan(w->x[k]) || w->s->all.item[k].incomplete ||
            (method >= 0 && w->s->which[k] != method))
            continue;
        for (; at > 0 && is_before(w, k, w->order[at - 1]); at--)
            w->order[at] = w->order[at - 1];
        w->order[at] = k;
        count++;
    }
    for (int64_t i = 0; i < count; i++) {
        const int64_t k = w->order[i], last = w->order[kept > 0 ? kept - 1 : 0];

        if (kept == 0 ||
            (method < 0 ? w->y[k] < w->y[last] : w->x[k] > w->x[last]))
            w->order[kept++] = k;
    }
    return kept;
}

/* --- data ----------------------------------------------------------------- */

static void say_point(work *w, const record *r, const measure *m)
{
    char costs[160] = "";

    if (isfinite(r->cpu))
        sink_append(costs, sizeof costs, "\nto reduce: %s",
                    chart_say_seconds(r->cpu).text);
    if (isfinite(r->cost))
        sink_append(costs, sizeof costs, "\none simulated second: %s",
                    chart_say_seconds(r->cost).text);
    if (r->tolerance)
        sink_append(costs, sizeof costs, "\n%s the tolerance%s",
                    r->feasible ? "meets" : "misses",
                    r->chosen      ? "; chosen"
                    : r->runner_up ? "; runner-up"
                                   : "");
    picture_tip(w->picture, "%.60s, order %ld\n%s: %s (%.4g)%s", r->method,
                r->order, m->title,
                chart_say_error(record_error(r, m->name)).text,
                record_error(r, m->name), costs);
}

/* A row; with @p word the order is written next to the point. */
static void put_row(work *w, int64_t p, int64_t k, int style, bool word)
{
    const record *r = &w->s->all.item[k];
    FILE *file = w->picture->data.file;

    fprintf(file, "%ld\t%ld\t%d\t%.9g\t%.9g\t", p, w->s->which[k], style,
            w->x[k], w->y[k]);
    if (style <= MISSES)
        say_point(w, r, &w->s->measure[p]);
    fputc('\t', file);
    if (word)
        fprintf(file, "%ld", r->order);
    /* the last column, because a quote in a field takes in all that follows */
    fprintf(file, "\t%ld\t", r->order);
    html_line(file, r->method);
    fputc('\n', file);
}

/*
 * A line, ended by an empty row. By its definition a point of the front has no
 * other point below and left of it: its order is written there, unless the last
 * order is too near.
 */
static void put_line(work *w, int64_t p, int64_t method)
{
    const int64_t count = list_line(w, method);
    double x = -HUGE_VAL, y = HUGE_VAL;

    for (int64_t i = 0; i < count; i++) {
        const int64_t k = w->order[i];
        const record *r = &w->s->all.item[k];
        /* the legend has the orders of what was chosen, which has a ring */
        const bool word =
            method < 0 && !r->chosen && !r->runner_up &&
            (w->at[k].x - x > word_wide || y - w->at[k].y > word_high);

        if (word) {
            x = w->at[k].x;
            y = w->at[k].y;
        }
        put_row(w, p, k, method < 0 ? ON_FRONT : ON_LINE, word);
    }
    fputc('\n', w->picture->data.file);
}

/* Rows of a panel: points, thinned, then its lines. */
static ritz_status put_panel(work *w, int64_t p)
{
    const int64_t count = list_line(w, -1);

    for (int64_t k = 0; k < w->s->all.count; k++) {
        const record *r = &w->s->all.item[k];

        w->at[k].keep = r->chosen || r->runner_up;
        w->at[k].group = isnan(w->x[k]) ? -1 : 2 * w->s->which[k] + r->feasible;
    }
    for (int64_t i = 0; i < count; i++)
        w->at[w->order[i]].keep = true;
    RITZ_CHECK(picture_thin(w->s->all.count, w->at, mark_apart));
    for (int64_t k = 0; k < w->s->all.count; k++) {
        const record *r = &w->s->all.item[k];

        if (w->at[k].group < 0 || !w->at[k].keep)
            continue;
        put_row(w, p, k, r->feasible ? MEETS : MISSES, false);
        if (r->chosen || r->runner_up)
            put_row(w, p, k, r->chosen ? CHOSEN : RUNNER_UP, false);
    }
    if (w->form->times)
        put_line(w, p, -1);
    for (int64_t s = 0; !w->form->times && s < w->s->num_methods; s++)
        put_line(w, p, s);
    return RITZ_OK;
}

static void put_table(const work *w)
{
    FILE *file = w->picture->table.file;

    fprintf(file, "method\torder\tto reduce, s\tone simulated second, s");
    for (int64_t m = 0; m < w->s->num_measures; m++) {
        fputc('\t', file);
        html_line(file, w->s->measure[m].title);
    }
    fprintf(file, "\tverdict\n");
    for (int64_t k = 0; k < w->s->all.count; k++) {
        const record *r = &w->s->all.item[k];

        html_line(file, r->method);
        fprintf(file, "\t%ld\t%.4g\t%.4g", r->order, r->cpu, r->cost);
        for (int64_t m = 0; m < w->s->num_measures; m++)
            fprintf(file, "\t%.4g", record_error(r, w->s->measure[m].name));
        fprintf(file, "\t%s\n",
                r->chosen      ? "chosen"
                : r->runner_up ? "runner-up"
                : r->feasible  ? "meets"
                               : "misses");
    }
}

/* --- legend and note ------------------------------------------------------ */

/* "chosen: compare, 34", instead of the order next to the point. */
static void add_chosen(work *w, const record *r, bool chosen)
{
    picture_add_sign(
        w->picture,
        (picture_sign){.colour = chosen ? "alarm" : "ink", .mark = 6},
        "%s: %.40s, %ld", chosen ? "chosen" : "runner-up", r->method, r->order);
}

/* Mark of a series, as gnuplot numbers them; begin.gp has the same rule. */
static int find_mark(int64_t series)
{
    static const int marks[] = {7, 5, 9, 13, 11};
    static const int first[SVG_SERIES] = {0, 1, 2, 3, 4, 3, 1, 2};

    return marks[(first[series % SVG_SERIES] + series / SVG_SERIES) % 5];
}

static void add_signs(work *w)
{
    const record *chosen = NULL, *second = NULL;
    bool hollow = false, limit = false, uncertain = false;

    for (int64_t s = 0; s < w->s->num_methods && s < PICTURE_SIGNS - 7; s++)
        picture_add_sign(
            w->picture,
            (picture_sign){.colour = svg_series(s), .mark = find_mark(s)},
            "%.60s", w->s->method[s]);
    for (int64_t k = w->s->all.count - 1; k >= 0; k--) {
        const record *r = &w->s->all.item[k];

        chosen = r->chosen ? r : chosen;
        second = r->runner_up && !r->chosen ? r : second;
        hollow = hollow || !r->feasible;
    }
    for (int64_t p = 0; p < w->s->num_measures; p++) {
        limit = limit || w->panel[p].tolerance > 0.0;
        uncertain = uncertain || (w->panel[p].y_low <= uncertainty &&
                                  uncertainty <= w->panel[p].y_high);
    }
    if (chosen)
        add_chosen(w, chosen, true);
    if (second)
        add_chosen(w, second, false);
    const picture_sign others[] = {
        {.name = "hollow: misses a limit", .colour = "muted", .mark = 6},
        {.name = "Pareto front", .colour = "muted", .wide = 2.0},
        {.name = "equal error", .colour = "pale", .wide = 1.0},
        {.name = "tolerance", .colour = "alarm", .wide = 1.6},
        {.name = "10 %: model uncertainty",
         .colour = "ink",
         .dash = 2,
         .wide = 1.4},
    };
    const bool there[] = {hollow, w->form->times, true, limit, uncertain};

    for (size_t k = 0; k < sizeof there / sizeof *there; k++)
        if (there[k])
            picture_add_sign(w->picture, others[k], "%s", others[k].name);
}

/* The note: how many errors are drawn at the foot or not at all. */
static void say_missing(work *w)
{
    const int64_t lifted = w->lifted, left_out = w->left_out;

    if (lifted > 0)
        sink_append(w->picture->note, PICTURE_WORD,
                    "%ld error%s below %.0e %s at the foot. ", lifted,
                    lifted > 1 ? "s" : "", RECORDS_ROUNDING,
                    lifted > 1 ? "stand" : "stands");
    if (left_out > 0)
        sink_append(w->picture->note, PICTURE_WORD,
                    "%ld %s not known and left out.", left_out,
                    left_out > 1 ? "are" : "is");
}

/* --- the picture ---------------------------------------------------------- */

static ritz_status compose_errors(work *w)
{
    const int64_t n = w->s->num_measures, across = n > 1 ? 2 : 1;
    picture *p = w->picture;

    fprintf(p->data.file,
            "area\tseries\tstyle\tx\ty\ttip\tword\torder\tmethod\n");
    for (int64_t k = 0; k < n; k++) {
        place_records(w, &w->s->measure[k], &w->panel[k]);
        RITZ_CHECK(put_panel(w, k));
    }
    p->wide = (double)(across * CELL_WIDE);
    const int64_t down = (n + across - 1) / across;

    p->body = (double)(down * CELL_HIGH);
    fprintf(p->given.file,
            "panels = %ld\nacross = %ld\nmethods = %ld\nseconds = %d\n"
            "lines = %d\n",
            n, across, w->s->num_methods, w->form->times, !w->form->times);
    picture_give_text(p, "xlabel", w->form->xlabel);
    picture_give_texts(p, "title", n, w->s->measure->title, sizeof(measure));
    picture_give_reals(p, "x_low,x_high,y_low,y_high,tolerance", n,
                       &w->panel->x_low, sizeof *w->panel);
    add_signs(w);
    say_missing(w);
    put_table(w);
    return picture_draw(p, "errors.gp", w->form->title, w->form->xlabel);
}

/* Measures of --measure, or all with an error that is more than rounding. */
static ritz_status choose_measures(record_set *s, const cli_list *asked)
{
    const ritz_names all = {NULL, s->num_measures, s->measure->name,
                            sizeof *s->measure};
    char names[16 * RITZ_NAME_SIZE] = "";
    int64_t kept = 0;

    for (int64_t m = 0; m < s->num_measures; m++)
        sink_append(names, sizeof names, "%s%s", m > 0 ? ", " : "",
                    s->measure[m].name);
    for (int64_t m = 0; asked->count == 0 && m < s->num_measures; m++)
        if (m == 0 || records_matter(&s->all, &s->measure[m]))
            s->measure[kept++] = s->measure[m];
    for (int a = 0; a < asked->count; a++) {
        const int64_t k = ritz_names_index(&all, asked->text[a]);

        RITZ_REFUSE_IF(k < 0, RITZ_ERR_ARGUMENT,
                       "no record has an error '%s', but %s", asked->text[a],
                       names);
        RITZ_REFUSE_IF(k < kept, RITZ_ERR_ARGUMENT,
                       "--measure '%s' is given twice", asked->text[a]);
        const measure found = s->measure[k];

        s->measure[k] = s->measure[kept];
        s->measure[kept++] = found;
    }
    s->num_measures = kept;
    return RITZ_OK;
}

static ritz_status draw_errors(const chart_sources *sources,
                               const chart_request *request, const form *how,
                               picture *out)
{
    RITZ_OWN(record_set) set = {0};
    RITZ_OWN(work) w = {.form = how, .s = &set, .picture = out};
    bool any = false;

    RITZ_CHECK(record_set_new(&sources->runs, request->subject, &set));
    RITZ_CHECK(choose_measures(&set, &request->measure));
    for (int64_t k = 0; k < set.all.count; k++)
        any = any || isfinite(x_of(how, &set.all.item[k]));
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "no record says what its model cost");
    RITZ_CHECK_NEW(w.panel, set.num_measures);
    RITZ_CHECK_NEW(w.x, set.all.count);
    RITZ_CHECK_NEW(w.y, set.all.count);
    RITZ_CHECK_NEW(w.at, set.all.count);
    RITZ_CHECK_NEW(w.order, set.all.count);
    return compose_errors(&w);
}

ritz_status chart_pareto(const chart_sources *sources,
                         const chart_request *request, picture *out)
{
    static const form reduce = {"Errors against the time to reduce",
                                "processor time to make basis and reduction",
                                true, false};
    static const form simulate = {"Errors against the cost of simulation",
                                  "processor time for one simulated second",
                                  true, true};
    const bool costs = request->against
                           ? strcmp(request->against, "simulate") == 0
                           : records_cost(&sources->runs);

    return draw_errors(sources, request, costs ? &simulate : &reduce, out);
}

ritz_status chart_convergence(const chart_sources *sources,
                              const chart_request *request, picture *out)
{
    static const form orders = {"Errors against order",
                                "order of the reduced model", false, false};

    return draw_errors(sources, request, &orders, out);
}
