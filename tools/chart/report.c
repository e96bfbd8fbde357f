#include "chart/report.h"

#include "base/alloc.h"
#include "base/text.h"

#include <ritz/base.h>

#include <string.h>

/* --- files other than records --------------------------------------------- */

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

/* Sections, and which files make one picture: at least and at most so many that
   are `same` as the first; NULL: any. */
static const struct part {
    int holds;
    chart_draw *draw;
    const char *title;
    int64_t least, most;
    bool (*same)(const chart_file *first, const chart_file *other);
} parts[] = {
    {MODEL_RANKING, chart_hankel, "Which modes matter", 1, INT64_MAX, NULL},
    {MODEL_RESPONSE, chart_response, "Frequency responses", 1, INT64_MAX,
     same_points},
    {MODEL_SIMULATION, chart_simulation, "Time responses", 1, INT64_MAX,
     same_outputs},
    {CHART_MOTION, chart_motion, "Stresses in motion", 1, 1, NULL},
    {CHART_MODES | MODEL_SYSTEM, chart_mac, "Mode shapes", 2, 2, NULL},
    {CHART_TRACKS, chart_tracks, "Modes over configurations", 1, 1, NULL},
};

/* Collect the files of one picture, from `first` on, and mark them as taken. */
static int64_t gather_files(const report_page *p, const struct part *part,
                            int64_t first, bool *taken, chart_file *out)
{
    const chart_file *file = p->sources->file;
    int64_t count = 0;

    for (int64_t k = first; k < p->sources->count && count < part->most; k++) {
        if (taken[k] || !(file[k].holds & part->holds) ||
            (part->same && !part->same(&file[first], &file[k])))
            continue;
        taken[k] = true;
        out[count++] = file[k];
    }
    return count;
}

/* Whether responses of several channels all hold singular values. */
static bool have_singular(int64_t count, const chart_file *file)
{
    for (int64_t k = 0; k < count; k++) {
        const ritz_response *r = &file[k].model.response;

        if (file[k].holds != MODEL_RESPONSE || r->num_singular == 0 ||
            r->num_inputs * r->num_outputs < 2)
            return false;
    }
    return count > 0;
}

static bool is_system(const chart_file *file)
{
    return file->holds == MODEL_SYSTEM;
}

/* Whether a single system is to be compared at two of its configurations. */
static bool is_pair(const chart_sources *some, const chart_request *request)
{
    return some->count == 1 && is_system(some->file) &&
           (request->at.count == 2 ||
            some->file->model.system.num_configurations == 2);
}

/* Add a picture. Responses also get one of their singular values, if they hold
   these and no other picture was asked for. */
static ritz_status put_picture(report_page *p, const struct part *part,
                               const chart_sources *some)
{
    chart_request request = *p->request;
    char names[400] = "", caption[500];
    bool systems = false;

    for (int64_t k = 0; k < some->count; k++)
        systems = systems || is_system(&some->file[k]);
    if (!systems) /* --at belongs to a system elsewhere on the page */
        request.at = (cli_list){0};
    for (int64_t k = 0; k < some->count; k++)
        sink_append(names, sizeof names, "%s%.60s", k > 0 ? ", " : "",
                    ritz_path_name(some->file[k].path));
    RITZ_CHECK(
        chart_name_files(report_figure(p, part->draw, some, &request, names),
                         some, part->holds));
    if (request.channel.count > 0 || !have_singular(some->count, some->file))
        return RITZ_OK;
    request.channel = (cli_list){.count = 1, .text = {CHART_SINGULAR_WORD}};
    snprintf(caption, sizeof caption, "singular values: %s", names);
    return chart_name_files(
        report_figure(p, part->draw, some, &request, caption), some,
        part->holds);
}

/* A section of pictures of one kind, if there are files for it. */
static ritz_status put_part(report_page *p, const struct part *part,
                            bool *taken, chart_file *room)
{
    bool begun = false;

    for (int64_t k = 0; k < p->sources->count; k++) {
        chart_sources some = *p->sources;

        if (taken[k] || !(p->sources->file[k].holds & part->holds))
            continue;
        some.file = room;
        some.count = gather_files(p, part, k, taken, room);
        if (some.count < part->least && !is_pair(&some, p->request))
            continue;
        if (!begun)
            report_begin(p, part->title, "");
        begun = true;
        RITZ_CHECK(put_picture(p, part, &some));
    }
    return begun ? report_end(p) : RITZ_OK;
}

static ritz_status put_pictures(report_page *p)
{
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN_ARRAY chart_file *room = NULL;

    RITZ_CHECK_NEW(taken, p->sources->count + 1);
    RITZ_CHECK_NEW(room, p->sources->count + 1);
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        RITZ_CHECK(put_part(p, &parts[k], taken, room));
    return RITZ_OK;
}

/* --- the page ------------------------------------------------------------- */

/* The last section: input files, their digests, and commands. */
static ritz_status put_provenance(report_page *p)
{
    const cli_run *run = p->sources->run;
    const records *all = &p->sources->runs;
    const char *last = "";
    FILE *file = p->body.file;

    report_begin(p, "How this was made", "");
    html_print(file, "<p><code>%s</code>, Ritz %s</p>\n<h3>Inputs</h3>\n<ul>\n",
               run->command, ritz_version());
    for (int64_t k = 0; k < run->num_inputs; k++)
        html_print(file, "<li><code>%s</code></li>\n", run->input[k]);
    if (all->count > 0)
        fprintf(file, "</ul>\n<details><summary>Commands of the "
                      "records</summary>\n<ul>\n");
    for (int64_t k = 0; k < all->count; k++) {
        const char *command =
            json_string_value(json_object_get(all->item[k].json, "command"));

        if (!command || strcmp(command, last) == 0)
            continue;
        last = command;
        html_print(file, "<li><code>%s</code></li>\n", command);
    }
    fprintf(file, all->count > 0 ? "</ul>\n</details>\n" : "</ul>\n");
    return report_end(p);
}

/* The title of the page, with the subject of the records. */
static void put_title(report_page *p)
{
    const records *all = &p->sources->runs;
    const char *subject = NULL;

    for (int64_t k = 0; k < all->count && !subject; k++)
        if (all->item[k].errors && *all->item[k].subject)
            subject = all->item[k].subject;
    html_print(p->title.file, "%s%show small, how fast, how wrong",
               subject ? subject : "", subject ? ": " : "");
}

/* The page is report.html, where a line has one "@NAME@" at most. */
static ritz_status put_page(report_page *p)
{
    const struct {
        const char *mark;
        const cli_table *part;
    } fields[] = {{"@title@", &p->title},
                  {"@contents@", &p->links},
                  {"@body@", &p->body}};
    enum { FIELDS = sizeof fields / sizeof *fields };

    for (int k = 0; k < FIELDS; k++)
        RITZ_CHECK(cli_table_end(fields[k].part));
    for (const char *const *line = chart_text_find("report.html"); *line;
         line++) {
        const char *at = *line + strcspn(*line, "@");
        int k = 0;

        while (k < FIELDS &&
               strncmp(at, fields[k].mark, strlen(fields[k].mark)) != 0)
            k++;
        if (k < FIELDS)
            fprintf(p->whole.file, "%.*s%s%s", (int)(at - *line), *line,
                    fields[k].part->text, at + strlen(fields[k].mark));
        else
            fputs(*line, p->whole.file);
    }
    return cli_table_save(&p->whole, p->request->path);
}

static void report_page_free(report_page *p)
{
    cli_table_free(&p->title);
    cli_table_free(&p->links);
    cli_table_free(&p->body);
    cli_table_free(&p->figures);
    cli_table_free(&p->whole);
}

ritz_status report_write(const chart_sources *sources,
                         const chart_request *request)
{
    RITZ_OWN(report_page) p = {.sources = sources, .request = request};
    const size_t length = strlen(request->path);

    RITZ_REFUSE_IF(
        length >= 4 && strcmp(request->path + length - 4, ".svg") == 0,
        RITZ_ERR_ARGUMENT, "a report is a page, no picture: -o NAME.html");
    RITZ_CHECK(cli_table_new(&p.title));
    RITZ_CHECK(cli_table_new(&p.links));
    RITZ_CHECK(cli_table_new(&p.body));
    RITZ_CHECK(cli_table_new(&p.figures));
    RITZ_CHECK(cli_table_new(&p.whole));
    put_title(&p);
    RITZ_CHECK(chart_name_files(report_records(&p), sources, CHART_RECORDS));
    RITZ_CHECK(put_pictures(&p));
    RITZ_REFUSE_IF(p.num_pictures == 0, RITZ_ERR_ARGUMENT,
                   "there is nothing to draw in these files");
    RITZ_CHECK(put_provenance(&p));
    return put_page(&p);
}
