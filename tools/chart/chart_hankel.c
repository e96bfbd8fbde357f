/* Values of modes as bars, from rankings. */
#include "chart/chart.h"

#include "base/alloc.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

/* A value below this part of the largest is left out of the picture. */
static const double invisible = 1e-12;

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

/* Index in ranking c of the mode with a number; -1: it has none. */
static int64_t find_mode(const contest *all, int64_t c, int64_t number)
{
    for (int64_t k = 0; k < all->ranking[c]->count; k++)
        if (number_of(all, c, k) == number)
            return k;
    return -1;
}

/* Height of the bar of a mode in ranking c; NaN: there is no bar. */
static double height_of(const contest *all, int64_t c, int64_t number)
{
    const ritz_ranking *r = all->ranking[c];
    int64_t mode = find_mode(all, c, number);
    double top = largest_of(r);

    if (mode < 0 || !(fabs(r->value[mode]) > invisible * top))
        return nan("");
    return fabs(r->value[mode]) / (is_mixed(all) ? top : 1.0);
}

/* Numbers of the modes that are among the first few of any ranking, in
   ascending order; how many there are. */
static int64_t pick_numbers(const contest *all, int64_t most, int64_t *number)
{
    int64_t n = 0;

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
    return n;
}

static double hertz_of(const contest *all, int64_t number)
{
    int64_t c = 0;

    while (find_mode(all, c, number) < 0)
        c++;
    return all->ranking[c]->hertz[find_mode(all, c, number)];
}

/* A row for each mode: number, label, then value and tip of each ranking. */
static void put_data(picture *p, const contest *all, int64_t count,
                     const int64_t *number)
{
    FILE *const both[] = {p->data.file, p->table.file};
    const char *noun = all->track[0] ? "track" : "mode";

    for (int64_t c = 0; c < all->count; c++)
        picture_add_sign(p,
                         (picture_sign){.colour = svg_series(c), .wide = 8.0},
                         "%.120s", all->name[c]);
    for (int t = 0; t < 2; t++) {
        fprintf(both[t], "mode\tlabel");
        for (int64_t c = 0; c < all->count; c++) {
            fprintf(both[t], "\t");
            html_line(both[t], all->name[c]);
            fprintf(both[t], t == 0 ? "\ttip" : "");
        }
        for (int64_t k = 0; k < count; k++) {
            const int64_t named = number[k] + 1;
            const double hertz = hertz_of(all, number[k]);

            fprintf(both[t], "\n%ld\t%ld: %.3g", named, named, hertz);
            for (int64_t c = 0; c < all->count; c++) {
                double value = height_of(all, c, number[k]);

                fprintf(both[t], t == 0 ? "\t%.6g\t" : "\t%.6g", value);
                if (t == 0)
                    picture_tip(p, "%s %ld, %.4g Hz\n%s: %.4g", noun, named,
                                hertz, all->name[c], value);
            }
        }
        fprintf(both[t], "\n");
    }
}

static ritz_status draw_rankings(picture *p, const char *title,
                                 const contest *all, int64_t most)
{
    double largest = 0.0;
    RITZ_OWN_ARRAY int64_t *number = NULL;
    int64_t count = 0;

    for (int64_t c = 0; c < all->count; c++)
        largest = fmax(largest, largest_of(all->ranking[c]));
    RITZ_REFUSE_IF(!(largest > 0.0), RITZ_ERR_ARGUMENT,
                   "no mode has a value that could be drawn");
    RITZ_CHECK_NEW(number, all->count * most);
    count = pick_numbers(all, most, number);
    put_data(p, all, count, number);
    p->wide = 220.0 + (double)(count * (14 + 7 * all->count));
    p->wide = fmin(fmax(p->wide, 640.0), 2400.0);
    p->body = 440.0;
    fprintf(p->given.file, "rankings = %ld\ncount = %ld\n", all->count, count);
    picture_give_text(p, "head", title);
    picture_give_text(p, "xlabel", all->track[0] ? "track: Hz" : "mode: Hz");
    picture_give_text(p, "ylabel",
                      is_mixed(all) ? "part of the largest value"
                                    : all->ranking[0]->by);
    return picture_draw(p, "hankel.gp", title, "values of modes as bars");
}

ritz_status chart_rankings(const char *path, const char *title,
                           const contest *all, int64_t most)
{
    RITZ_OWN(picture) p = {0};

    RITZ_CHECK(picture_new(path, true, &p));
    return draw_rankings(&p, title, all, most);
}

ritz_status chart_hankel(const chart_sources *sources,
                         const chart_request *request, picture *out)
{
    RITZ_OWN_ARRAY ranked *group = NULL;
    RITZ_OWN_ARRAY char(*name)[RITZ_NAME_SIZE] = NULL;
    rank_result result = {.count = sources->count};
    RITZ_OWN(contest) all = {0};
    char title[256];

    RITZ_CHECK_NEW(group, sources->count);
    RITZ_CHECK_NEW(name, sources->count);
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];

        RITZ_REFUSE_IF(file->model.rankings.count == 0, RITZ_ERR_FORMAT,
                       "'%s' holds no ranking", file->path);
        group[k].all = file->model.rankings; /* borrowed */
        snprintf(name[k], sizeof name[k], "%.63s", ritz_path_name(file->path));
    }
    result.group = group;
    result.file = name;
    RITZ_CHECK(contest_new(&result, true, &all));
    snprintf(title, sizeof title, "%s, damping %.100s", all.ranking[0]->by,
             rankings_damping(all.ranking[0]));
    return draw_rankings(out, title, &all, request->top);
}
