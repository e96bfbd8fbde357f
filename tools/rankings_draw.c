/* Bars of values by mode: data, a script of gnuplot, and what it draws. */
#include "rankings.h"

#include "../src/base/draft.h"
#include "cli_table.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_SIZE = 4096, NO_PROGRAM = 127 };

/* Of the largest value: what is less is left out of the picture. */
static const double invisible = 1e-12;

/* The same name with an ending behind it, so that no other output has it. */
static ritz_status beside(const char *path, const char *ending,
                          char out[PATH_SIZE])
{
    ritz_status status = RITZ_OK;
    size_t length = strlen(path);

    RITZ_FAIL_IF(length < 5 || strcmp(path + length - 4, ".svg") != 0 ||
                     length + 8 >= PATH_SIZE,
                 RITZ_ERR_ARGUMENT,
                 "a chart is an SVG, '%s' does not end in "
                 "'.svg'",
                 path);
    snprintf(out, PATH_SIZE, "%s%s", path, ending);
done:
    return status;
}

/* Rankings of different kinds share one axis only as parts of their largest. */
static bool is_mixed(const contest *all)
{
    for (int64_t c = 1; c < all->count; c++)
        if (strcmp(all->ranking[c]->by, all->ranking[0]->by) != 0)
            return true;
    return false;
}

static double largest_of(const ritz_ranking *r)
{
    return r->count > 0 ? fabs(r->value[r->order[0]]) : 0.0;
}

static int64_t number_of(const contest *all, int64_t c, int64_t mode)
{
    return all->track[c] ? all->track[c][mode] : mode;
}

/* Mode of that number in ranking c; -1: none. */
static int64_t find(const contest *all, int64_t c, int64_t number)
{
    for (int64_t k = 0; k < all->ranking[c]->count; k++)
        if (number_of(all, c, k) == number)
            return k;
    return -1;
}

/* Magnitude of a number in ranking c, as drawn; NaN: nothing to see. */
static double height(const contest *all, int64_t c, int64_t number, bool mixed)
{
    const ritz_ranking *r = all->ranking[c];
    int64_t mode = find(all, c, number);
    double top = largest_of(r);

    if (mode < 0 || !(fabs(r->value[mode]) > invisible * top))
        return nan("");
    return fabs(r->value[mode]) / (mixed ? top : 1.0);
}

/* Numbers that are among the first few of some ranking, ascending. */
static ritz_status pick(const contest *all, int64_t most, int64_t *count,
                        int64_t **out)
{
    ritz_status status = RITZ_OK;
    int64_t *number = calloc((size_t)(all->count * most) + 1, sizeof *number);
    int64_t n = 0;

    RITZ_FAIL_IF(!number, RITZ_ERR_MEMORY, "no memory for a chart");
    for (int64_t c = 0; c < all->count; c++)
        for (int64_t k = 0; k < all->ranking[c]->count && k < most; k++) {
            int64_t wanted = number_of(all, c, all->ranking[c]->order[k]);
            int64_t at = n;

            while (at > 0 && number[at - 1] > wanted)
                at--;
            if (at > 0 && number[at - 1] == wanted)
                continue;
            memmove(number + at + 1, number + at,
                    (size_t)(n - at) * sizeof *number);
            number[at] = wanted;
            n++;
        }
    *count = n;
    *out = number;
done:
    return status;
}

/* mode, label, then a column for each ranking. */
static ritz_status write_data(const char *path, const contest *all,
                              int64_t most)
{
    ritz_status status = RITZ_OK;
    bool mixed = is_mixed(all);
    cli_table table = {0};
    int64_t *number = NULL;
    int64_t count = 0;

    RITZ_TRY(cli_table_new(&table));
    RITZ_TRY(pick(all, most, &count, &number));
    fprintf(table.file, "mode\tlabel");
    for (int64_t c = 0; c < all->count; c++)
        fprintf(table.file, "\t%s", all->name[c]);
    fprintf(table.file, "\n");
    for (int64_t k = 0; k < count; k++) {
        int64_t c = 0;

        while (find(all, c, number[k]) < 0)
            c++;
        fprintf(table.file, "%lld\t%lld: %.3g", (long long)number[k] + 1,
                (long long)number[k] + 1,
                all->ranking[c]->hertz[find(all, c, number[k])]);
        for (c = 0; c < all->count; c++)
            fprintf(table.file, "\t%.6g", height(all, c, number[k], mixed));
        fprintf(table.file, "\n");
    }
    RITZ_TRY(cli_table_save(&table, path));
done:
    free(number);
    cli_table_free(&table);
    return status;
}

/* In gnuplot's single quotes, which end where two of them do not stand. */
static void quote(FILE *file, const char *text)
{
    fputc('\'', file);
    for (; *text; text++)
        fprintf(file, *text == '\'' ? "''" : "%c", *text);
    fputc('\'', file);
}

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

static ritz_status write_script(const char *path, const char *data,
                                const char *svg, const char *title,
                                const contest *all)
{
    ritz_status status = RITZ_OK;
    cli_table table = {0};
    FILE *file = NULL;

    RITZ_TRY(cli_table_new(&table));
    file = table.file;
    fprintf(file, "# gnuplot %s\nif (!exists('out')) out = ", base_of(path));
    quote(file, base_of(svg));
    fprintf(file, "\nif (!exists('data')) data = ");
    quote(file, base_of(data));
    fprintf(file,
            "\nstats data using 1 skip 1 name 'M' nooutput\n"
            "n = M_records\ncolumns = %lld\n"
            "wide = 220 + n * (14 + 7 * columns)\n"
            "set terminal svg size (wide < 640 ? 640 : wide > 2400 ? 2400 : "
            "wide), 480 enhanced font 'sans,13' background 'white'\n"
            "set output out\nset datafile separator tab\n"
            "set datafile missing 'nan'\nset title ",
            (long long)all->count);
    quote(file, title);
    fprintf(file,
            " noenhanced\nset logscale y\nset format y '10^{%%L}'\n"
            "set ylabel '%s' noenhanced\nset xlabel '%s: Hz'\n"
            "set grid y lc '#dddddd' lt 1\nset key outside top center "
            "horizontal noenhanced\nset xtics rotate by 60 right nomirror "
            "noenhanced font ',11'\n"
            "set style data histograms\nset style histogram clustered gap 1\n"
            "set style fill solid 0.85 noborder\n"
            "array colour[8] = ['#3465a4', '#cc0000', '#4e9a06', '#f57900', "
            "'#75507b', '#06989a', '#555753', '#c4a000']\n"
            "plot for [c = 3:2 + columns] data using c:xtic(2) "
            "title columnheader(c) lc rgb colour[1 + (c - 3) %% 8]\n",
            is_mixed(all) ? "part of the largest value" : all->ranking[0]->by,
            all->track[0] ? "track" : "mode");
    RITZ_TRY(cli_table_save(&table, path));
done:
    cli_table_free(&table);
    return status;
}

/* A text of gnuplot's: NAME='VALUE'. */
static ritz_status assign(const char *name, const char *value, size_t size,
                          char *out)
{
    ritz_status status = RITZ_OK;
    size_t used = (size_t)snprintf(out, size, "%s='", name);

    for (; *value && used + 4 < size; value++)
        used += (size_t)snprintf(out + used, size - used,
                                 *value == '\'' ? "''" : "%c", *value);
    RITZ_FAIL_IF(*value, RITZ_ERR_ARGUMENT, "the name of a chart is too long");
    snprintf(out + used, size - used, "'");
done:
    return status;
}

static ritz_status run_gnuplot(const char *script, const char *data,
                               const char *out)
{
    ritz_status status = RITZ_OK;
    static char program[] = "gnuplot", option[] = "-e";
    char set_out[PATH_SIZE + 8], set_data[PATH_SIZE + 8], file[PATH_SIZE];
    char *const argv[] = {program,  option, set_out, option,
                          set_data, file,   NULL};
    int outcome = 0;
    pid_t child = -1;

    snprintf(file, sizeof file, "%s", script);
    RITZ_TRY(assign("out", out, sizeof set_out, set_out));
    RITZ_TRY(assign("data", data, sizeof set_data, set_data));
    child = fork();
    if (child == 0) {
        execvp(program, argv);
        _exit(NO_PROGRAM);
    }
    RITZ_FAIL_IF(child < 0, RITZ_ERR_FILE, "cannot start gnuplot: %s",
                 strerror(errno));
    while (waitpid(child, &outcome, 0) < 0 && errno == EINTR)
        ;
    RITZ_FAIL_IF(
        WIFEXITED(outcome) && WEXITSTATUS(outcome) == NO_PROGRAM, RITZ_ERR_FILE,
        "gnuplot is not installed: '%s' is there to be drawn by it", script);
    RITZ_FAIL_IF(!WIFEXITED(outcome) || WEXITSTATUS(outcome) != 0,
                 RITZ_ERR_FILE, "gnuplot could not draw '%s'", script);
done:
    return status;
}

ritz_status rankings_draw(const char *path, const char *title,
                          const contest *all, int64_t most)
{
    ritz_status status = RITZ_OK;
    char data[PATH_SIZE], script[PATH_SIZE];
    ritz_draft draft = {0};
    double largest = 0.0;

    for (int64_t c = 0; c < all->count; c++)
        largest = fmax(largest, largest_of(all->ranking[c]));
    RITZ_FAIL_IF(!(largest > 0.0), RITZ_ERR_ARGUMENT,
                 "no mode has a value that could be drawn");
    RITZ_TRY(beside(path, ".tsv", data));
    RITZ_TRY(beside(path, ".gp", script));
    RITZ_TRY(write_data(data, all, most));
    RITZ_TRY(write_script(script, data, path, title, all));
    RITZ_TRY(ritz_draft_new(path, &draft));
    RITZ_TRY(run_gnuplot(script, data, draft.name));
    RITZ_TRY(ritz_draft_publish(&draft));
done:
    ritz_draft_free(&draft);
    return ritz_context(status, path);
}
