#include "chart/picture.h"

#include "base/alloc.h"
#include "base/draft.h"
#include "base/text.h"
#include "cli/child.h"

#include <ritz/base.h>

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    TIP_SIZE = 1000, /* gnuplot's labels have at most 1024 bytes */
    PIECE = 65536,   /* capacity of a pipe */
};

/* Widths in the legend, pixels: a sign with the space beside it; a letter, as
   gnuplot counts it. */
static const double sign_wide = 60.0, letter_wide = 8.5;

ritz_status picture_new(const char *path, bool keep, picture *out)
{
    const size_t length = strlen(path);

    RITZ_REFUSE_IF(keep &&
                       (length < 5 || strcmp(path + length - 4, ".svg") != 0),
                   RITZ_ERR_ARGUMENT,
                   "a chart is an SVG, '%s' does not end in '.svg'", path);
    RITZ_REFUSE_IF(length + 16 >= PICTURE_PATH, RITZ_ERR_ARGUMENT,
                   "the name of a chart is too long");
    snprintf(out->path, sizeof out->path, "%s", path);
    out->keep = keep;
    RITZ_CHECK(cli_table_new(&out->data));
    RITZ_CHECK(cli_table_new(&out->given));
    RITZ_CHECK(cli_table_new(&out->drawn));
    return cli_table_new(&out->table);
}

void picture_add_sign(picture *p, picture_sign sign, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    vsnprintf(sign.name, sizeof sign.name, format, args);
    va_end(args);
    if (p->num_signs < PICTURE_SIGNS)
        p->sign[p->num_signs++] = sign;
}

/*
 * Texts are in single quotes, where gnuplot interprets quotes only: it reads
 * two of them as a quote, and a third one as the end of the text. Each quote is
 * therefore a string of its own, 'it' . "\047" . 's'.
 */
static void put_byte(FILE *file, char byte)
{
    fprintf(file, "' . \"\\%03o\" . '", (unsigned)(unsigned char)byte);
}

static void quote_text(FILE *file, const char *text)
{
    fputc('\'', file);
    while (*text)
        if (*text == '\'')
            put_byte(file, *text++);
        else
            text += html_letter(file, text);
    fputc('\'', file);
}

/* A file name keeps every byte. A relative one gets "./" in front of it,
   because gnuplot would run "|NAME" and "<NAME" as commands. */
static void quote_path(FILE *file, const char *path, const char *ending)
{
    fprintf(file, "'%s", *path == '/' ? "" : "./");
    while (*path)
        if (*path == '\'' || ritz_letter_length(path) == 0)
            put_byte(file, *path++);
        else
            path += html_letter(file, path);
    fprintf(file, "%s'", ending);
}

void picture_give_text(picture *p, const char *name, const char *text)
{
    fprintf(p->given.file, "%s = ", name);
    quote_text(p->given.file, text);
    fputc('\n', p->given.file);
}

void picture_give_texts(picture *p, const char *name, int64_t count,
                        const char *text, size_t size)
{
    FILE *file = p->given.file;

    fprintf(file, "array %s[%ld] = [", name, count);
    for (int64_t k = 0; k < count; k++) {
        fputs(k > 0 ? ", " : "", file);
        quote_text(file, text + (size_t)k * size);
    }
    fputs("]\n", file);
}

void picture_give_reals(picture *p, const char *names, int64_t count,
                        const double *value, size_t size)
{
    FILE *file = p->given.file;
    char name[RITZ_NAME_SIZE];

    for (; cli_next(&names, name); value++) {
        fprintf(file, "array %s[%ld] = [", name, count);
        for (int64_t k = 0; k < count; k++)
            fprintf(file, "%s%.9g", k > 0 ? ", " : "",
                    value[(size_t)k * (size / sizeof *value)]);
        fputs("]\n", file);
    }
}

/*
 * gnuplot interprets '\' and '"' in data. They are written as entities of
 * markup, as are the characters that markup interprets; svg_copy reads them.
 */
void picture_tip(picture *p, const char *format, ...)
{
    FILE *file = p->data.file;
    const long begin = ftell(file);
    char text[TIP_SIZE];
    const char *c = text;
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    while (*c && ftell(file) - begin < TIP_SIZE) {
        if (*c == '\n' || *c == '\\')
            fputs(*c++ == '\n' ? "\\n" : "&#92;", file);
        else
            c += html_symbol(file, c);
    }
}

static int by_square(const void *a, const void *b)
{
    const picture_point *p = *(const picture_point *const *)a;
    const picture_point *q = *(const picture_point *const *)b;
    const int64_t apart[] = {p->group - q->group, p->column - q->column,
                             p->row - q->row, q->keep - p->keep};

    for (size_t k = 0; k < sizeof apart / sizeof *apart; k++)
        if (apart[k] != 0)
            return apart[k] < 0 ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p < q ? -1 : 1;
}

ritz_status picture_thin(int64_t count, picture_point *point, double cell)
{
    RITZ_OWN_ARRAY picture_point **all = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(all, count); /* NOLINT: of pointers */
    for (int64_t k = 0; k < count; k++) {
        if (point[k].group < 0)
            continue;
        point[k].column = (int64_t)floor(point[k].x / cell);
        point[k].row = (int64_t)floor(point[k].y / cell);
        all[n++] = &point[k];
    }
    qsort(all, (size_t)n, sizeof *all, by_square); /* NOLINT: of pointers */
    for (int64_t i = 0; i < n; i++)
        if (i == 0 || all[i]->group != all[i - 1]->group ||
            all[i]->column != all[i - 1]->column ||
            all[i]->row != all[i - 1]->row)
            all[i]->keep = true;
    return RITZ_OK;
}

/* Set a variable to a file name in the folder of the script. */
static void put_name(FILE *file, const char *variable, const char *path,
                     const char *ending)
{
    fprintf(file, "if (!exists('%s')) %s = ", variable, variable);
    quote_path(file, ritz_path_name(path), ending);
    fputc('\n', file);
}

/* Number of letters of a text, which is cut behind @p most; "..." says so. */
static size_t count_letters(char *text, size_t most)
{
    size_t count = 0;

    for (char *c = text; *c; c++) {
        if (((unsigned char)*c & 0xc0) == 0x80 || ++count <= most)
            continue;
        snprintf(c, 4, "...");
        break;
    }
    return count;
}

/* Names and signs of the legend, in as many columns as have room. */
static void put_legend(const picture *p, FILE *file)
{
    const int count = p->keep ? p->num_signs : 0;
    const size_t space = (size_t)((p->wide - sign_wide) / letter_wide) - 3;
    size_t most = 1;

    if (count > 0)
        fprintf(file, "array key_name[%d]\narray key_sign[%d]\n", count, count);
    for (int k = 0; k < count; k++) {
        const picture_sign *s = &p->sign[k];
        char name[2 * PICTURE_WORD];
        size_t letters = 0;

        snprintf(name, sizeof name - 4, "%s%s%s", s->name, s->role ? ", " : "",
                 s->role ? s->role : "");
        letters = count_letters(name, space);
        most = letters > most ? letters : most;
        fprintf(file, "key_name[%d] = ", k + 1);
        quote_text(file, name);
        fprintf(file, "\nkey_sign[%d] = 'with ", k + 1);
        if (s->mark > 0)
            fprintf(file, "points pt %d ps 0.9 lw 1.6", s->mark);
        else
            fprintf(file, "lines lw %g dt %d", s->wide,
                    s->dash > 1 ? s->dash : 1);
        fprintf(file, " lc rgb %s'\n", s->colour);
    }
    fprintf(file, "keys = %d\ncolumns = %d\n", count,
            (int)fmax(1.0, p->wide / (sign_wide + letter_wide * (double)most)));
}

static void put_template(FILE *file, const char *name)
{
    fputc('\n', file);
    for (const char *const *line = chart_text_find(name); *line; line++)
        fputs(*line, file);
}

/* The whole script: variables, then the templates. */
static ritz_status write_script(picture *p, const char *template,
                                cli_table *out)
{
    RITZ_CHECK(cli_table_new(out));
    RITZ_CHECK(cli_table_end(&p->given));
    fprintf(out->file, "# Draw again, in this folder: gnuplot -d and the name "
                       "of this file\n");
    put_name(out->file, "out", p->path, "");
    put_name(out->file, "data", p->path, ".tsv");
    for (const svg_colour *c = svg_colours; c->name; c++)
        fprintf(out->file, "%s = '#%06lx'\n", c->name, c->rgb);
    fprintf(out->file, "wide = %.0f\nbody = %.0f\nnote = ", p->wide, p->body);
    quote_text(out->file, p->keep ? p->note : "");
    fputc('\n', out->file);
    put_legend(p, out->file);
    fputs(p->given.text, out->file);
    put_template(out->file, "begin.gp");
    put_template(out->file, template);
    put_template(out->file, "end.gp");
    return RITZ_OK;
}

/* Run gnuplot in the child. It is killed when the tool ends; on systems that
   cannot do this it ends when it writes to the broken pipe. */
static void become_gnuplot(const int ends[2], char *const argv[])
{
    dup2(ends[1], STDOUT_FILENO);
    for (int k = 0; k < 2; k++)
        /* not if the tool has no standard output */
        if (ends[k] != STDOUT_FILENO)
            close(ends[k]);
    execvp(argv[0], argv);
    _exit(CHILD_NO_PROGRAM);
}

static ritz_status read_pipe(int from, cli_table *out)
{
    RITZ_OWN_ARRAY char *piece = NULL;
    ssize_t size = 0;

    RITZ_CHECK_NEW(piece, PIECE);
    do {
        size = read(from, piece, PIECE);
        RITZ_REFUSE_IF(size < 0 && errno != EINTR, RITZ_ERR_FILE,
                       "cannot read from gnuplot: %s", strerror(errno));
        if (size > 0)
            fwrite(piece, 1, (size_t)size, out->file);
    } while (size != 0);
    return cli_table_end(out);
}

/* Run gnuplot until it ends, and collect its output. */
static ritz_status collect_gnuplot(char *const argv[], cli_table *out,
                                   int *outcome)
{
    ritz_status status = RITZ_OK;
    int ends[2] = {-1, -1};
    pid_t child = -1;

    RITZ_REFUSE_IF(pipe(ends) != 0, RITZ_ERR_FILE, "cannot start gnuplot: %s",
                   strerror(errno));
    child = child_start(SIGKILL);
    if (child == 0)
        become_gnuplot(ends, argv);
    if (child < 0)
        status = ritz_fail(RITZ_ERR_FILE, "cannot start gnuplot: %s",
                           strerror(errno));
    close(ends[1]);
    if (child > 0)
        status = read_pipe(ends[0], out);
    close(ends[0]);
    if (child > 0)
        (void)child_wait(child, outcome);
    return status;
}

/*
 * Let gnuplot draw, ignoring a user's ~/.gnuplot.
 * @param[in] shown  name of the script in messages
 */
static ritz_status run_gnuplot(const char *script, const char *data,
                               const char *shown, cli_table *out)
{
    static char program[] = "gnuplot", defaults[] = "-d", option[] = "-e";
    RITZ_OWN(cli_table) command = {0};
    char file[PICTURE_PATH + 16];
    char *argv[] = {program, defaults, option, NULL, file, NULL};
    int outcome = 0;

    RITZ_CHECK(cli_table_new(&command));
    fprintf(command.file, "out = ''; data = ");
    quote_path(command.file, data, "");
    RITZ_CHECK(cli_table_end(&command));
    argv[3] = command.text;
    snprintf(file, sizeof file, "%s%s", *script == '/' ? "" : "./", script);
    RITZ_CHECK(collect_gnuplot(argv, out, &outcome));
    RITZ_REFUSE_IF(
        WIFEXITED(outcome) && WEXITSTATUS(outcome) == CHILD_NO_PROGRAM,
        RITZ_ERR_FILE,
        "gnuplot is not installed: '%s' is there to be drawn by it", shown);
    RITZ_REFUSE_IF(!WIFEXITED(outcome) || WEXITSTATUS(outcome) != 0,
                   RITZ_ERR_FILE, "gnuplot could not draw '%s'", shown);
    return RITZ_OK;
}

/* Write a table as a draft next to the picture, under its own name if it is
   kept. */
static ritz_status put_beside(const picture *p, cli_table *table,
                              const char *ending, ritz_draft *draft,
                              char path[PICTURE_PATH])
{
    snprintf(path, PICTURE_PATH, "%.*s%s", PICTURE_PATH - 8, p->path,
             p->keep ? ending : "");
    RITZ_CHECK_IN(path, ritz_draft_new(path, draft));
    return ritz_context(cli_table_write(table, draft->name), path);
}

/* Let gnuplot draw the drafts. If it cannot, data and script of a kept picture
   are published, so that it can be drawn elsewhere. */
static ritz_status draw_drafts(picture *p, ritz_draft *data, ritz_draft *script,
                               const char *shown)
{
    RITZ_OWN_ARRAY char *why = NULL;
    ritz_status status =
        run_gnuplot(script->name, data->name, shown, &p->drawn);

    if (status == RITZ_OK && !strstr(p->drawn.text, "</svg>"))
        status = ritz_fail(RITZ_ERR_FILE, "gnuplot drew no picture");
    if (status == RITZ_OK || !p->keep)
        return status;
    RITZ_CHECK_COPY(why, ritz_error_message(),
                    (int64_t)strlen(ritz_error_message()) + 1);
    RITZ_CHECK(ritz_draft_publish_now(data));
    RITZ_CHECK(ritz_draft_publish_now(script));
    return ritz_fail(status, "%s", why);
}

static ritz_status draw_files(picture *p, const char *template)
{
    char data_path[PICTURE_PATH], script_path[PICTURE_PATH];
    RITZ_OWN(ritz_draft) draft = {0}, data = {0}, script = {0};
    RITZ_OWN(cli_table) text = {0}, named = {0};

    RITZ_CHECK(write_script(p, template, &text));
    RITZ_CHECK(put_beside(p, &p->data, ".tsv", &data, data_path));
    RITZ_CHECK(put_beside(p, &text, ".gp", &script, script_path));
    if (p->keep)
        RITZ_CHECK(ritz_draft_new(p->path, &draft));
    RITZ_CHECK(draw_drafts(p, &data, &script, script_path));
    if (!p->keep)
        return RITZ_OK;
    RITZ_CHECK(ritz_draft_publish(&data));
    RITZ_CHECK(ritz_draft_publish(&script));
    RITZ_CHECK(cli_table_new(&named));
    svg_copy(named.file, p->drawn.text, p->title, p->summary, NULL);
    RITZ_CHECK(cli_table_write(&named, draft.name));
    return ritz_draft_publish(&draft);
}

ritz_status picture_draw(picture *p, const char *template, const char *title,
                         const char *summary)
{
    ritz_status status = RITZ_OK;

    snprintf(p->title, sizeof p->title, "%s", title);
    p->summary = summary;
    status = draw_files(p, template);
    return p->keep ? ritz_context(status, p->path) : status;
}

void picture_free(picture *p)
{
    cli_table_free(&p->drawn);
    cli_table_free(&p->data);
    cli_table_free(&p->given);
    cli_table_free(&p->table);
    *p = (picture){0};
}
