/* Frequencies of modes over configurations, from a table of --tracks. */
#include "chart/chart_tracks.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>

/* A mode is known again by less than this only with doubt. */
#define DOUBT 0.9

static int by_track(const void *a, const void *b)
{
    const track_row *x = a, *y = b;

    if (x->track != y->track)
        return x->track < y->track ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static void put_data(const track_table *t, gnuplot *out)
{
    FILE *data = out->data.file, *rows = out->table.file;

    fprintf(data, "track\tx\thertz\tmac\ttip\tmode\tconfiguration\n");
    fprintf(rows, "track\tconfiguration\tmode\tHz\tMAC\n");
    for (int64_t k = 0; k < t->count; k++) {
        const track_row *r = &t->row[k];
        int64_t tip = gnuplot_tip(
            out, "track %lld, mode %lld at %.100s\n%.6g Hz\nMAC %.3f%s",
            (long long)r->track, (long long)r->mode, r->name, r->hertz, r->mac,
            r->mac < DOUBT ? ": hardly the same mode" : "");

        if (k > 0 && t->row[k - 1].track != r->track)
            fprintf(data, "\n");
        fprintf(data, "%lld\t%.9g\t%.9g\t%.6g\t%lld\t%lld\t",
                (long long)r->track, t->x[r->at], r->hertz, r->mac,
                (long long)tip, (long long)r->mode);
        html_line(data, r->name);
        fprintf(rows, "%lld\t", (long long)r->track);
        html_line(rows, r->name);
        fprintf(rows, "\t%lld\t%.6g\t%.4g\n", (long long)r->mode, r->hertz,
                r->mac);
        fprintf(data, "\n");
    }
}

static void put_plot(const track_table *t, gnuplot *out, bool doubts)
{
    FILE *file = out->plot.file;

    fprintf(file, "plot NaN notitle");
    for (int64_t k = 0; k < t->num_tracks; k++)
        fprintf(file,
                ", \\\n  data skip 1 using ($1 == %lld ? $2 : NaN):3 with "
                "lines lw 1.6 lc rgb '%s' notitle"
                ", \\\n  data skip 1 using ($1 == %lld ? $2 : NaN):3:5 with "
                "labels hypertext point pt %d ps 0.55 lc rgb '%s' notitle",
                (long long)k + 1, chart_colour(k), (long long)k + 1,
                chart_mark(k, false), chart_colour(k));
    if (doubts)
        fprintf(file,
                ", \\\n  data skip 1 using ($4 < %g ? $2 : NaN):3 with points "
                "pt 6 ps 1.2 lw 1.4 lc rgb '" SVG_ALARM "' notitle",
                DOUBT);
    fprintf(file, "\n");
}

static bool has_doubts(const track_table *t)
{
    for (int64_t k = 0; k < t->count; k++)
        if (t->row[k].mac < DOUBT)
            return true;
    return false;
}

static void set_areas(const track_table *t, chart_area *area)
{
    double most = 0.0, least = t->x[0], last = t->x[0];

    for (int64_t k = 0; k < t->count; k++)
        most = fmax(most, t->row[k].hertz);
    for (int64_t k = 0; k < t->num_at; k++) {
        least = fmin(least, t->x[k]);
        last = fmax(last, t->x[k]);
    }
    area->x = (axis){.low = least, .high = last};
    if (!(last > least)) {
        area->x.low -= 0.5;
        area->x.high += 0.5;
    }
    area->y = (axis){.high = most > 0.0 ? 1.04 * most : 1.0};
}

static ritz_status draw(const track_table *t, gnuplot *out)
{
    chart_area area = {.left = 62, .bottom = 84, .right = 702, .top = 446};
    bool doubts = has_doubts(t);
    const chart_sign signs[] = {
        {.name = "MAC below 0.9 to where the mode comes from",
         .colour = SVG_ALARM,
         .mark = 6},
    };

    gnuplot_size(out, 720, 490);
    set_areas(t, &area);
    chart_area_begin(out, &area, "Modes over configurations", t->xlabel, "Hz");
    if (!t->swept)
        fprintf(out->plot.file, "set xtics 1 nomirror\n");
    if (t->num_at == 1)
        fprintf(out->plot.file, "unset xtics\n");
    if (doubts)
        chart_legend(out, 1, signs, area.left, 26, area.right, true);
    put_data(t, out);
    put_plot(t, out, doubts);
    return gnuplot_draw(out, "Modes over configurations",
                        "frequency of each mode, followed by its shape");
}

ritz_status chart_tracks(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out)
{
    ritz_status status = RITZ_OK;
    track_table t = {0};
    const chart_file *file = NULL;

    for (int64_t k = 0; k < sources->count; k++) {
        if (sources->file[k].holds != CHART_TRACKS)
            continue;
        RITZ_FAIL_IF(file, RITZ_ERR_ARGUMENT,
                     "'%s' and '%s': a chart has one table of tracks",
                     file->path, sources->file[k].path);
        file = &sources->file[k];
    }
    RITZ_FAIL_IF(!file, RITZ_ERR_ARGUMENT, "there is no table of tracks");
    RITZ_TRY_IN(file->path, track_table_read(file->text, wish->up_to_hz, &t));
    track_table_place(&t);
    qsort(t.row, (size_t)t.count, sizeof *t.row, by_track);
    RITZ_TRY(gnuplot_new(wish->path, wish->keep, out));
    RITZ_TRY(draw(&t, out));
done:
    track_table_free(&t);
    return status;
}
