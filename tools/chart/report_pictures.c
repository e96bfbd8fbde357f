/* Sections of the page that other files make: one picture for those that
   belong together. */
#include "chart/chart_response.h"
#include "chart/report_parts.h"

#include <stdlib.h>
#include <string.h>

/* Those of the files that belong into one picture. */
typedef bool (*belongs)(const chart_file *first, const chart_file *other);

static bool same_points(const chart_file *first, const chart_file *other)
{
    const ritz_response *a = &first->model.response;
    const ritz_response *b = &other->model.response;

    return a->num_inputs == b->num_inputs && a->num_outputs == b->num_outputs &&
           a->count == b->count &&
           memcmp(a->hertz, b->hertz, (size_t)a->count * sizeof *a->hertz) == 0;
}

static bool same_outputs(const chart_file *first, const chart_file *other)
{
    const ritz_simulation *a = &first->model.simulation;
    const ritz_simulation *b = &other->model.simulation;

    return a->num_outputs == b->num_outputs &&
           memcmp(a->output, b->output,
                  (size_t)a->num_outputs * sizeof *a->output) == 0;
}

static bool any_other(const chart_file *first, const chart_file *other)
{
    (void)first;
    (void)other;
    return true;
}

static bool no_other(const chart_file *first, const chart_file *other)
{
    return first == other;
}

/* The files that `first` begins, and are not taken; they then are. */
static int64_t gather(const report_page *p, int64_t first, belongs same,
                      bool *taken, chart_file *out)
{
    const chart_file *file = p->sources->file;
    int64_t count = 0;

    for (int64_t k = first; k < p->sources->count; k++) {
        if (taken[k] || file[k].holds != file[first].holds ||
            !same(&file[first], &file[k]))
            continue;
        if (file[first].holds == CHART_MODES && count == 2)
            break;
        taken[k] = true;
        out[count++] = file[k];
    }
    return count;
}

static const struct part {
    int holds;
    const char *kind, *title;
    belongs same;
    int64_t least; /* files of a picture */
} parts[] = {
    {CHART_RANKING, "hankel", "Which modes matter", any_other, 1},
    {CHART_RESPONSE, "response", "Frequency responses", same_points, 1},
    {CHART_SIMULATION, "simulation", "Time responses", same_outputs, 1},
    {CHART_MODES, "mac", "Mode shapes", any_other, 2},
    {CHART_TRACKS, "tracks", "Modes over configurations", no_other, 1},
};

static void name_files(int64_t count, const chart_file *file, size_t size,
                       char *out)
{
    size_t used = 0;

    for (int64_t k = 0; k < count && used < size; k++)
        used += (size_t)snprintf(out + used, size - used, "%s%.60s",
                                 k > 0 ? ", " : "", chart_base(file[k].path));
}

/* Whether responses of several channels all hold singular values. */
static bool have_singular(int64_t count, const chart_file *file)
{
    for (int64_t k = 0; k < count; k++) {
        const ritz_response *r = &file[k].model.response;

        if (file[k].holds != CHART_RESPONSE || r->num_singular == 0 ||
            r->num_inputs * r->num_outputs < 2)
            return false;
    }
    return count > 0;
}

/* A picture; and of responses their singular values, if they hold them and
   nothing else was asked for. */
static ritz_status put_picture(report_page *p, const struct part *part,
                               const chart_sources *some)
{
    chart_wish wish = report_wish(p);
    char names[400], caption[500];

    name_files(some->count, some->file, sizeof names, names);
    RITZ_CHECK(
        report_figure(p, some, &wish, report_kind(part->kind)->draw, names));
    if (wish.channel.count > 0 || !have_singular(some->count, some->file))
        return RITZ_OK;
    wish.channel = (cli_list){.count = 1, .text = {CHART_SINGULAR_WORD}};
    snprintf(caption, sizeof caption, "singular values: %s", names);
    return report_figure(p, some, &wish, report_kind(part->kind)->draw,
                         caption);
}

/* A section of pictures of one kind, if there are files for it. */
static ritz_status put_part(report_page *p, const struct part *part,
                            bool *taken, chart_file *room)
{
    bool begun = false;

    for (int64_t k = 0; k < p->sources->count; k++) {
        chart_sources some = *p->sources;

        if (taken[k] || p->sources->file[k].holds != part->holds)
            continue;
        some.file = room;
        some.count = gather(p, k, part->same, taken, room);
        if (some.count < part->least)
            continue;
        if (!begun) {
            report_begin(p, part->title);
            fprintf(p->body.file, "<div class=\"figures\">\n");
        }
        begun = true;
        RITZ_CHECK(put_picture(p, part, &some));
    }
    if (begun) {
        fprintf(p->body.file, "</div>\n");
        report_end(p);
    }
    return RITZ_OK;
}

ritz_status report_pictures(report_page *p)
{
    ritz_status status = RITZ_OK;
    size_t count = (size_t)p->sources->count + 1;
    bool *taken = calloc(count, sizeof *taken);
    chart_file *room = calloc(count, sizeof *room);

    RITZ_FAIL_IF(!taken || !room, RITZ_ERR_MEMORY, "no memory for files");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        RITZ_TRY(put_part(p, &parts[k], taken, room));
done:
    free(taken);
    free(room);
    return status;
}
