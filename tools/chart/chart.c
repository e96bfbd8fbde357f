#include "chart/chart.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const struct content {
    int holds, model;
    const char *noun;
} contents[] = {
    {CHART_RECORDS, 0, "run records"},
    {CHART_TRACKS, 0, "a table of tracks"},
    {CHART_RANKING, MODEL_RANKING, "a ranking"},
    {CHART_RESPONSE, MODEL_RESPONSE, "a response"},
    {CHART_SIMULATION, MODEL_SIMULATION, "a time response"},
    {CHART_MODES, MODEL_REDUCED, "a reduced component"},
    {CHART_MODES, MODEL_BASIS, "a basis"},
    {CHART_MODES, MODEL_COMPONENT, "a component"},
    {CHART_SYSTEM, MODEL_SYSTEM, "a system"},
};

enum { NUM_CONTENTS = sizeof contents / sizeof *contents };

static const char tracks_head[] = "track\tconfiguration\tmode\thertz\tmac";

static bool is_tracks(const char *path)
{
    char line[sizeof tracks_head] = "";
    FILE *file = fopen(path, "r");
    bool is = false;

    if (!file)
        return false;
    is = fgets(line, sizeof line, file) && strcmp(line, tracks_head) == 0;
    fclose(file);
    return is;
}

/* Kinds of containers (MODEL_...) that hold one of these (CHART_...). */
static int models_of(int holds)
{
    int sum = 0;

    for (int k = 0; k < NUM_CONTENTS; k++)
        if (contents[k].holds & holds)
            sum |= contents[k].model;
    return sum;
}

/* Noun for what a text file holds. */
static const char *noun_of(int found)
{
    for (int k = 0; k < NUM_CONTENTS; k++)
        if (contents[k].holds == found && !contents[k].model)
            return contents[k].noun;
    return "";
}

static ritz_status refuse(const char *path, const char *noun, int holds)
{
    char list[160] = "";
    size_t used = 0;

    for (int k = 0; k < NUM_CONTENTS; k++)
        if ((contents[k].holds & holds) && used < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s",
                                     used > 0 ? " or " : "", contents[k].noun);
    return ritz_fail(RITZ_ERR_FORMAT, "'%s' holds %s, not %s", path, noun,
                     list);
}

static ritz_status check_text(const char *path, int found, int holds)
{
    ritz_status status = RITZ_OK;
    struct stat file = {0};

    RITZ_FAIL_IF(stat(path, &file) != 0, RITZ_ERR_FILE, "cannot open '%s': %s",
                 path, strerror(errno));
    RITZ_FAIL_IF(S_ISREG(file.st_mode) && file.st_size == 0, RITZ_ERR_FORMAT,
                 "'%s' is empty", path);
    RITZ_FAIL_IF(S_ISDIR(file.st_mode), RITZ_ERR_FILE, "'%s' is a folder",
                 path);
    RITZ_FAIL_IF(found == 0, RITZ_ERR_FORMAT,
                 "'%s' is no container, no table of --tracks, and no file of "
                 "--record",
                 path);
    if (!(found & holds))
        status = refuse(path, noun_of(found), holds);
done:
    return status;
}

static ritz_status read_model(cli_run *run, int holds, chart_file *file)
{
    model_kind kind = MODEL_ANY;
    const char *noun = NULL;

    RITZ_CHECK(model_peek(file->path, &kind, &noun));
    if (!(models_of(holds) & (int)kind))
        return refuse(file->path, noun, holds);
    RITZ_CHECK(model_read(run, file->path, (int)kind, &file->model));
    for (int k = 0; k < NUM_CONTENTS; k++)
        if (contents[k].model == (int)kind)
            file->holds = contents[k].holds;
    return RITZ_OK;
}

static ritz_status read_file(cli_run *run, const char *path, int holds,
                             chart_sources *out, chart_file *file)
{
    file->path = path;
    if (ritz_container_is(path))
        return read_model(run, holds, file);
    file->holds = is_tracks(path)    ? CHART_TRACKS
                  : records_is(path) ? CHART_RECORDS
                                     : 0;
    RITZ_CHECK(check_text(path, file->holds, holds));
    RITZ_CHECK(cli_input(run, path));
    if (file->holds == CHART_RECORDS)
        RITZ_CHECK(records_read(path, &out->runs));
    else
        RITZ_CHECK(ritz_text_read(path, &file->text));
    return RITZ_OK;
}

ritz_status chart_read(cli_run *run, int64_t count, char *const *path,
                       int holds, chart_sources *out)
{
    out->run = run;
    out->file = calloc((size_t)count + 1, sizeof *out->file);
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_MEMORY, "no memory for files");
    for (out->count = 0; out->count < count;) {
        chart_file *file = &out->file[out->count];

        RITZ_CHECK(read_file(run, path[out->count++], holds, out, file));
    }
    records_join(&out->runs);
    return RITZ_OK;
}

void chart_sources_free(chart_sources *sources)
{
    for (int64_t k = 0; k < sources->count; k++) {
        model_free(&sources->file[k].model);
        free(sources->file[k].text);
    }
    free(sources->file);
    records_free(&sources->runs);
    *sources = (chart_sources){0};
}

void chart_say_error(double error, char out[32])
{
    if (isnan(error))
        snprintf(out, 32, "not measured");
    else if (error <= 0.0)
        snprintf(out, 32, error < 0.0 ? "below 0" : "0");
    else if (error < RECORDS_ROUNDING)
        snprintf(out, 32, "< %.0e", RECORDS_ROUNDING);
    else if (error >= 0.0995 && error < 100.0)
        snprintf(out, 32, "%.0f\xc2\xa0%%", 100.0 * error);
    else if (error >= 1e-4 && error < 100.0)
        snprintf(out, 32, "%.2g\xc2\xa0%%", 100.0 * error);
    else
        snprintf(out, 32, "%.1e", error);
}

void chart_say_seconds(double seconds, char out[32])
{
    static const struct {
        double unit;
        const char *name;
    } units[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "\xc2\xb5s"}, {1e-9, "ns"}};
    int k = 0;

    while (k < 3 && seconds < 0.9995 * units[k].unit)
        k++;
    snprintf(out, 32,
             seconds >= 99.95 * units[k].unit ? "%.0f\xc2\xa0%s"
                                              : "%.2g\xc2\xa0%s",
             seconds / units[k].unit, units[k].name);
}

const char *chart_base(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

int chart_mark(int64_t series)
{
    static const int marks[] = {7, 5, 9, 13, 11};
    static const int first[SVG_SERIES] = {0, 1, 2, 3, 4, 3, 1, 2};

    return marks[(first[series % SVG_SERIES] + series / SVG_SERIES) % 5];
}
