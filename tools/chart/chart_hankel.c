/* Bars of values from rankings: see rankings_draw.c. */
#include "chart/chart.h"
#include "print/rankings_make.h"

#include <stdlib.h>
#include <string.h>

/* Rankings as ritz-rank holds them; they stay the sources'. */
static ritz_status borrow(const chart_sources *sources, rank_result *out)
{
    out->group = calloc((size_t)sources->count + 1, sizeof *out->group);
    out->file = calloc((size_t)sources->count + 1, sizeof *out->file);
    RITZ_REFUSE_IF(!out->group || !out->file, RITZ_ERR_MEMORY,
                   "no memory for rankings");
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];

        if (file->holds != CHART_RANKING)
            continue;
        RITZ_REFUSE_IF(file->model.rankings.count == 0, RITZ_ERR_FORMAT,
                       "'%s' holds no ranking", file->path);
        out->group[out->count].all = file->model.rankings;
        snprintf(out->file[out->count++], RITZ_NAME_SIZE, "%.63s",
                 chart_base(file->path));
    }
    return RITZ_OK;
}

ritz_status chart_hankel(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out)
{
    ritz_status status = RITZ_OK;
    rank_result result = {0};
    contest all = {0};
    char title[256];

    RITZ_TRY(borrow(sources, &result));
    RITZ_TRY(rank_contest(&result, true, &all));
    snprintf(title, sizeof title, "%s, damping %.100s", all.ranking[0]->by,
             rankings_damping(all.ranking[0]));
    RITZ_TRY(gnuplot_new(wish->path, wish->keep, out));
    RITZ_TRY(rankings_plot(out, title, &all, wish->top));
    fflush(out->data.file);
    fputs(out->data.text, out->table.file);
done:
    rank_contest_free(&all);
    free(result.group);
    free(result.file);
    return status;
}
