#include "chart/report.h"

#include "chart/html.h"
#include "chart/text.h"

#include <ritz/version.h>

#include <stdlib.h>
#include <string.h>

/* --- sections, figures and their legend ----------------------------------- */

void report_begin(report_page *p, const char *title)
{
    const long long k = ++p->num_sections;

    p->num_signs = 0;
    html_print(p->links.file, "<li><a href=\"#s%lld\">%s</a></li>\n", k, title);
    html_print(p->body.file,
               "<section aria-labelledby=\"s%lld\">\n<h2 id=\"s%lld\">%s</h2>"
               "\n",
               k, k, title);
}

static bool look_alike(const picture_sign *a, const picture_sign *b)
{
    return a->mark == b->mark && a->dash == b->dash && a->wide == b->wide &&
           strcmp(a->colour, b->colour) == 0 && !a->role == !b->role &&
           (!a->role || strcmp(a->role, b->role) == 0);
}

/* Signs that look alike have one row with the names of all. */
static void add_signs(report_page *p, const picture *from)
{
    for (int k = 0; k < from->num_signs; k++) {
        const picture_sign *s = &from->sign[k];
        picture_sign *own = p->sign;
        const picture_sign *end = p->sign + p->num_signs;

        while (own < end && !look_alike(own, s))
            own++;
        if (own == end && p->num_signs < PICTURE_SIGNS) {
            p->sign[p->num_signs++] = *s;
        } else if (own < end && !strstr(own->name, s->name)) {
            size_t used = strlen(own->name);

            snprintf(own->name + used, sizeof own->name - used, ", %s",
                     s->name);
        }
    }
}

/* A mark as gnuplot numbers them, hollow before filled; or a line. */
static void put_sign(FILE *file, const picture_sign *s)
{
    static const char *const shapes[] = {
        "M10 3h8v8h-8z", "M9 7a5 5 0 1 0 10 0a5 5 0 1 0-10 0z",
        "M14 2l5.5 9h-11z", "M14 12l5.5-9h-11z",
        "M14 1.5l5.5 5.5l-5.5 5.5l-5.5-5.5z"};
    static const char *const dashes[] = {"none", "none", "7 4", "2 3",
                                         "7 3 2 3"};
    const int shape = (s->mark - 4) / 2;

    fprintf(file, "<li><svg class=\"sign\" viewBox=\"0 0 28 14\" "
                  "aria-hidden=\"true\">");
    if (s->mark >= 4 && shape < 5)
        fprintf(file,
                "<path d=\"%s\" fill=\"%s%s%s\" stroke=\"var(--%s)\" "
                "stroke-width=\"1.6\"/>",
                shapes[shape], s->mark % 2 ? "var(--" : "none",
                s->mark % 2 ? s->colour : "", s->mark % 2 ? ")" : "",
                s->colour);
    else
        fprintf(file,
                "<path d=\"M1 7H27\" stroke=\"var(--%s)\" stroke-width=\"%g\" "
                "stroke-dasharray=\"%s\"/>",
                s->colour, s->wide, dashes[s->dash % 5]);
    html_print(file, "</svg>%s%s%s</li>\n", s->name, s->role ? ": " : "",
               s->role ? s->role : "");
}

ritz_status report_end(report_page *p)
{
    FILE *file = p->body.file;

    RITZ_REFUSE_IF(fflush(p->figures.file) != 0, RITZ_ERR_MEMORY,
                   "no memory for the page");
    if (p->num_signs > 0)
        fprintf(file, "<ul class=\"legend\">\n");
    for (int k = 0; k < p->num_signs; k++)
        put_sign(file, &p->sign[k]);
    if (p->num_signs > 0)
        fprintf(file, "</ul>\n");
    if (p->figures.size > 0)
        fprintf(file, "<div class=\"figures\">\n%s</div>\n", p->figures.text);
    fprintf(file, "</section>\n");
    cli_table_free(&p->figures);
    return cli_table_new(&p->figures);
}

/* A table with tabs, names of columns first. */
static void put_table(FILE *file, const char *text, const char *caption)
{
    const char *cell = "th";

    html_print(file,
               "<details><summary>The same as a table</summary>\n"
               "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
               "aria-label=\"%s\"><table><caption>%s</caption>\n<thead>",
               caption, caption);
    for (const char *c = text; *c; c += *c == '\n') {
        fprintf(file, "<tr>");
        for (bool more = true; more; c += more) {
            const size_t length = strcspn(c, "\t\n");
            char *word = strndup(c, length);

            html_print(file,
                       *cell == 't' && cell[1] == 'h'
                           ? "<th scope=\"col\">%s</th>"
                           : "<td>%s</td>",
                       word ? word : "");
            free(word);
            c += length;
            more = *c == '\t';
        }
        fprintf(file,
                strcmp(cell, "th") == 0 ? "</tr></thead><tbody>\n" : "</tr>\n");
        cell = "td";
    }
    fprintf(file, "</tbody></table></div>\n</details>\n");
}

static const chart_kind *find_kind(const char *name)
{
    const chart_kind *kind = chart_kinds;

    while (strcmp(kind->name, name) != 0)
        kind++;
    return kind;
}

ritz_status report_figure(report_page *p, const char *kind,
                          const chart_sources *sources, const chart_wish *wish,
                          const char *caption)
{
    ritz_status status = RITZ_OK;
    chart_wish own = *wish;
    FILE *file = p->figures.file;
    picture drawn = {0};
    char prefix[32];

    own.keep = false;
    RITZ_TRY(find_kind(kind)->draw(sources, &own, &drawn));
    RITZ_FAIL_IF(fflush(drawn.table.file) != 0, RITZ_ERR_MEMORY,
                 "no memory for a table");
    add_signs(p, &drawn);
    snprintf(prefix, sizeof prefix, "p%lld-", (long long)++p->num_pictures);
    fprintf(file, "<figure%s>\n<div class=\"scroll\">\n",
            drawn.wide > PICTURE_WIDE ? " class=\"whole\"" : "");
    svg_copy(file, drawn.drawn,
             &(svg_names){drawn.title, drawn.summary, prefix});
    html_print(file, "</div>\n<figcaption>%s%s%s</figcaption>\n", caption,
               *drawn.note ? ". " : "", drawn.note);
    put_table(file, drawn.table.text, caption);
    fprintf(file, "</figure>\n");
done:
    picture_free(&drawn);
    return status;
}

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

/* Sections, and which files belong into one picture: those that are `same` as
   the first, all without it, at least and at most so many. */
static const struct part {
    int holds;
    const char *kind, *title;
    int64_t least, most;
    bool (*same)(const chart_file *first, const chart_file *other);
} parts[] = {
    {CHART_RANKING, "hankel", "Which modes matter", 1, INT64_MAX, NULL},
    {CHART_RESPONSE, "response", "Frequency responses", 1, INT64_MAX,
     same_points},
    {CHART_SIMULATION, "simulation", "Time responses", 1, INT64_MAX,
     same_outputs},
    {CHART_MODES, "mac", "Mode shapes", 2, 2, NULL},
    {CHART_TRACKS, "tracks", "Modes over configurations", 1, 1, NULL},
};

/* The files that `first` begins, and are not taken; they then are. */
static int64_t gather_files(const report_page *p, const struct part *part,
                            int64_t first, bool *taken, chart_file *out)
{
    const chart_file *file = p->sources->file;
    int64_t count = 0;

    for (int64_t k = first; k < p->sources->count && count < part->most; k++) {
        if (taken[k] || file[k].holds != part->holds ||
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
    chart_wish wish = *p->wish;
    char names[400] = "", caption[500];
    size_t used = 0;

    for (int64_t k = 0; k < some->count && used < sizeof names; k++)
        used +=
            (size_t)snprintf(names + used, sizeof names - used, "%s%.60s",
                             k > 0 ? ", " : "", chart_base(some->file[k].path));
    RITZ_CHECK(report_figure(p, part->kind, some, &wish, names));
    if (wish.channel.count > 0 || !have_singular(some->count, some->file))
        return RITZ_OK;
    wish.channel = (cli_list){.count = 1, .text = {CHART_SINGULAR_WORD}};
    snprintf(caption, sizeof caption, "singular values: %s", names);
    return report_figure(p, part->kind, some, &wish, caption);
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
        some.count = gather_files(p, part, k, taken, room);
        if (some.count < part->least)
            continue;
        if (!begun)
            report_begin(p, part->title);
        begun = true;
        RITZ_CHECK(put_picture(p, part, &some));
    }
    return begun ? report_end(p) : RITZ_OK;
}

static ritz_status put_pictures(report_page *p)
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

/* --- the page ------------------------------------------------------------- */

/* What was read, and by which commands it was made. */
static ritz_status put_provenance(report_page *p)
{
    const cli_run *run = p->sources->run;
    const records *all = &p->sources->runs;
    const char *last = "";
    FILE *file = p->body.file;

    report_begin(p, "How this was made");
    html_print(file, "<p><code>%s</code>, Ritz %s</p>\n<h3>Inputs</h3>\n<ul>\n",
               run->command, ritz_version());
    for (int64_t k = 0; k < run->num_inputs; k++)
        html_print(file, "<li><code>%s</code></li>\n", run->input[k]);
    fprintf(file, "</ul>\n");
    if (all->count > 0)
        fprintf(file, "<details><summary>Commands of the "
                      "records</summary>\n<ul>\n");
    for (int64_t k = 0; k < all->count; k++) {
        const char *command =
            json_string_value(json_object_get(all->item[k].json, "command"));

        if (!command || strcmp(command, last) == 0)
            continue;
        last = command;
        html_print(file, "<li><code>%s</code></li>\n", command);
    }
    if (all->count > 0)
        fprintf(file, "</ul>\n</details>\n");
    return report_end(p);
}

/* What names the page: whose records it shows, and what it is. */
static void put_title(FILE *file, const chart_sources *sources)
{
    const char *subject = NULL;

    for (int64_t k = 0; k < sources->runs.count && !subject; k++)
        if (sources->runs.item[k].errors && *sources->runs.item[k].subject)
            subject = sources->runs.item[k].subject;
    html_print(file, "%s%show small, how fast, how wrong",
               subject ? subject : "", subject ? ": " : "");
}

static void put_lines(FILE *file, const char *name)
{
    for (const char *const *line = chart_text_find(name); *line; line++)
        fputs(*line, file);
}

/* "sha256-..." in base 64, as a policy of contents names style and script:
   three bytes are four letters, two are three and a '='. */
static void put_hash(FILE *file, const char *name)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnop"
                                  "qrstuvwxyz0123456789+/";
    char digest[RITZ_DIGEST_SIZE];
    unsigned char byte[33] = {0};
    cli_table text = {0};

    if (cli_table_new(&text) != RITZ_OK)
        return;
    put_lines(text.file, name);
    fflush(text.file);
    ritz_digest_bytes(text.text, text.size, digest);
    cli_table_free(&text);
    for (size_t k = 0; k < 32; k++) {
        const char pair[] = {digest[2 * k], digest[2 * k + 1], '\0'};

        byte[k] = (unsigned char)strtoul(pair, NULL, 16);
    }
    fputs("sha256-", file);
    for (size_t k = 0; k < 33; k += 3) {
        const unsigned word =
            (unsigned)byte[k] << 16 | (unsigned)byte[k + 1] << 8 | byte[k + 2];

        for (unsigned i = 0; i < 4; i++)
            fputc(k + i < 33 ? letters[word >> (18 - 6 * i) & 63] : '=', file);
    }
}

/* What stands for "@NAME@" in report.html. */
static void put_field(FILE *file, const char *name, size_t length,
                      const report_page *p)
{
    char word[32] = "";

    snprintf(word, sizeof word, "%.*s", (int)length, name);
    if (strcmp(word, "style") == 0)
        put_lines(file, "report.css");
    else if (strcmp(word, "script") == 0)
        put_lines(file, "report.js");
    else if (strcmp(word, "style-hash") == 0)
        put_hash(file, "report.css");
    else if (strcmp(word, "script-hash") == 0)
        put_hash(file, "report.js");
    else if (strcmp(word, "version") == 0)
        fputs(ritz_version(), file);
    else if (strcmp(word, "title") == 0)
        put_title(file, p->sources);
    else
        fputs(strcmp(word, "body") == 0 ? p->body.text : p->links.text, file);
}

static ritz_status put_page(FILE *file, const report_page *p)
{
    RITZ_REFUSE_IF(fflush(p->body.file) != 0 || fflush(p->links.file) != 0,
                   RITZ_ERR_MEMORY, "no memory for the page");
    for (const char *const *line = chart_text_find("report.html"); *line;
         line++)
        for (const char *c = *line; *c; c++) {
            const size_t length = strcspn(c + 1, "@");

            if (*c != '@') {
                fputc(*c, file);
                continue;
            }
            put_field(file, c + 1, length, p);
            c += length + 1;
        }
    return RITZ_OK;
}

ritz_status report_write(const chart_sources *sources, const chart_wish *wish)
{
    ritz_status status = RITZ_OK;
    report_page p = {.sources = sources, .wish = wish};
    cli_table whole = {0};
    const size_t length = strlen(wish->path);

    RITZ_FAIL_IF(length >= 4 && strcmp(wish->path + length - 4, ".svg") == 0,
                 RITZ_ERR_ARGUMENT,
                 "a report is a page, no picture: -o NAME.html");
    RITZ_TRY(cli_table_new(&p.body));
    RITZ_TRY(cli_table_new(&p.links));
    RITZ_TRY(cli_table_new(&p.figures));
    RITZ_TRY(cli_table_new(&whole));
    RITZ_TRY(report_records(&p));
    RITZ_TRY(put_pictures(&p));
    RITZ_FAIL_IF(p.num_pictures == 0, RITZ_ERR_ARGUMENT,
                 "there is nothing to draw in these files");
    RITZ_TRY(put_provenance(&p));
    RITZ_TRY(put_page(whole.file, &p));
    RITZ_TRY(cli_table_save(&whole, wish->path));
done:
    cli_table_free(&p.body);
    cli_table_free(&p.links);
    cli_table_free(&p.figures);
    cli_table_free(&whole);
    return status;
}
