#include "chart/gnuplot.h"

#include "chart/html.h"

#include <ritz/text.h>

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NO_PROGRAM = 127, TIP_SIZE = 2000 };

ritz_status gnuplot_new(const char *path, bool keep, gnuplot *out)
{
    size_t length = strlen(path);

    RITZ_REFUSE_IF(keep &&
                       (length < 5 || strcmp(path + length - 4, ".svg") != 0),
                   RITZ_ERR_ARGUMENT,
                   "a chart is an SVG, '%s' does not end in '.svg'", path);
    RITZ_REFUSE_IF(length + 8 >= GNUPLOT_PATH, RITZ_ERR_ARGUMENT,
                   "the name of a chart is too long");
    snprintf(out->path, sizeof out->path, "%s", path);
    out->keep = keep;
    RITZ_CHECK(cli_table_new(&out->data));
    RITZ_CHECK(cli_table_new(&out->plot));
    return cli_table_new(&out->table);
}

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

void gnuplot_quote(FILE *file, const char *text)
{
    fputc('\'', file);
    while (*text) {
        if (*text == '\'')
            fputc('\'', file);
        text += html_letter(file, text);
    }
    fputc('\'', file);
}

void gnuplot_size(gnuplot *picture, double wide, double high)
{
    FILE *file = picture->plot.file;
    char name[GNUPLOT_PATH + 8];

    picture->wide = wide;
    picture->high = high;
    fprintf(file, "# gnuplot ");
    html_line(file, base_of(picture->path));
    fprintf(file, ".gp\nif (!exists('out')) out = ");
    gnuplot_quote(file, base_of(picture->path));
    snprintf(name, sizeof name, "%s.tsv", base_of(picture->path));
    fprintf(file, "\nif (!exists('data')) data = ");
    gnuplot_quote(file, name);
    fprintf(file,
            "\nset encoding utf8\n"
            "set terminal svg size %.0f, %.0f dynamic enhanced font 'sans,13' "
            "background '" SVG_PAPER "'\nset output out\n"
            "set datafile separator tab\nset datafile missing 'nan'\n"
            "set border lc rgb '" SVG_MUTED "'\n",
            wide, high);
}

int64_t gnuplot_tip(gnuplot *picture, const char *format, ...)
{
    char text[TIP_SIZE];
    char **more = NULL;
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    more =
        realloc(picture->tip, (size_t)(picture->num_tips + 1) * sizeof *more);
    if (!more)
        return -1;
    picture->tip = more;
    more[picture->num_tips] = strdup(text);
    return more[picture->num_tips] ? picture->num_tips++ : -1;
}

/* A text of gnuplot's: NAME='VALUE'. */
static ritz_status assign(const char *name, const char *value, size_t size,
                          char *out)
{
    size_t used = (size_t)snprintf(out, size, "%s='", name);

    for (; *value && used + 4 < size; value++)
        used += (size_t)snprintf(out + used, size - used,
                                 *value == '\'' ? "''" : "%c", *value);
    RITZ_REFUSE_IF(*value, RITZ_ERR_ARGUMENT,
                   "the name of a chart is too long");
    snprintf(out + used, size - used, "'");
    return RITZ_OK;
}

static ritz_status run_gnuplot(const char *script, const char *data,
                               const char *out)
{
    static char program[] = "gnuplot", option[] = "-e";
    char set_out[GNUPLOT_PATH + 8], set_data[GNUPLOT_PATH + 8];
    char file[GNUPLOT_PATH];
    char *const argv[] = {program,  option, set_out, option,
                          set_data, file,   NULL};
    int outcome = 0;
    pid_t child = -1;

    snprintf(file, sizeof file, "%s", script);
    RITZ_CHECK(assign("out", out, sizeof set_out, set_out));
    RITZ_CHECK(assign("data", data, sizeof set_data, set_data));
    child = fork();
    if (child == 0) {
        execvp(program, argv);
        _exit(NO_PROGRAM);
    }
    RITZ_REFUSE_IF(child < 0, RITZ_ERR_FILE, "cannot start gnuplot: %s",
                   strerror(errno));
    while (waitpid(child, &outcome, 0) < 0 && errno == EINTR)
        ;
    RITZ_REFUSE_IF(
        WIFEXITED(outcome) && WEXITSTATUS(outcome) == NO_PROGRAM, RITZ_ERR_FILE,
        "gnuplot is not installed: '%s' is there to be drawn by it", script);
    RITZ_REFUSE_IF(!WIFEXITED(outcome) || WEXITSTATUS(outcome) != 0,
                   RITZ_ERR_FILE, "gnuplot could not draw '%s'", script);
    return RITZ_OK;
}

/* Beside the picture, to stay or until the draft is freed. */
static ritz_status put_beside(const gnuplot *picture, cli_table *table,
                              const char *ending, ritz_draft *draft,
                              char out[GNUPLOT_PATH])
{
    if (picture->keep) {
        snprintf(out, GNUPLOT_PATH, "%.*s%s", GNUPLOT_PATH - 8, picture->path,
                 ending);
        return cli_table_save(table, out);
    }
    RITZ_CHECK(ritz_draft_new(picture->path, draft));
    snprintf(out, GNUPLOT_PATH, "%s", draft->name);
    return cli_table_write(table, out);
}

static ritz_status publish(const gnuplot *picture)
{
    ritz_status status = RITZ_OK;
    cli_table table = {0};

    RITZ_TRY(cli_table_new(&table));
    fputs(picture->svg, table.file);
    RITZ_TRY(cli_table_save(&table, picture->path));
done:
    cli_table_free(&table);
    return status;
}

ritz_status gnuplot_draw(gnuplot *picture, const char *title,
                         const char *summary)
{
    ritz_status status = RITZ_OK;
    char data[GNUPLOT_PATH], script[GNUPLOT_PATH];
    ritz_draft draft = {0}, data_draft = {0}, script_draft = {0};
    char *drawn = NULL;

    RITZ_TRY(put_beside(picture, &picture->data, ".tsv", &data_draft, data));
    RITZ_TRY(put_beside(picture, &picture->plot, ".gp", &script_draft, script));
    RITZ_TRY(ritz_draft_new(picture->path, &draft));
    RITZ_TRY(run_gnuplot(script, data, draft.name));
    RITZ_TRY(ritz_text_read(draft.name, &drawn));
    RITZ_TRY(svg_dress(drawn, title, summary, picture->num_tips, picture->tip,
                       &picture->svg));
    if (picture->keep)
        RITZ_TRY(publish(picture));
done:
    free(drawn);
    ritz_draft_free(&draft);
    ritz_draft_free(&data_draft);
    ritz_draft_free(&script_draft);
    return picture->keep ? ritz_context(status, picture->path) : status;
}

void gnuplot_free(gnuplot *picture)
{
    for (int64_t k = 0; k < picture->num_tips; k++)
        free(picture->tip[k]);
    free(picture->tip);
    free(picture->svg);
    cli_table_free(&picture->data);
    cli_table_free(&picture->plot);
    cli_table_free(&picture->table);
    *picture = (gnuplot){0};
}
