#include "chart/chart.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool is_tracks(const char *path)
{
    static const char head[] = "track\tconfiguration\tmode\thertz\tmac";
    char line[sizeof head] = "";
    FILE *file = fopen(path, "r");
    bool is = false;

    if (!file)
        return false;
    is = fgets(line, sizeof line, file) && strcmp(line, head) == 0;
    fclose(file);
    return is;
}

/* Contents, by the kind of a container or by a test of a text file. */
static const struct content {
    int holds, model;
    bool (*is)(const char *path);
    const char *noun;
} contents[] = {
    {CHART_RECORDS, 0, records_is, "run records"},
    {CHART_TRACKS, 0, is_tracks, "a table of tracks"},
    {CHART_RANKING, MODEL_RANKING, NULL, "a ranking"},
    {CHART_RESPONSE, MODEL_RESPONSE, NULL, "a response"},
    {CHART_SIMULATION, MODEL_SIMULATION, NULL, "a time response"},
    {CHART_MODES, MODEL_REDUCED, NULL, "a reduced component"},
    {CHART_MODES, MODEL_BASIS, NULL, "a basis"},
    {CHART_MODES, MODEL_COMPONENT, NULL, "a component"},
    {CHART_SYSTEM, MODEL_SYSTEM, NULL, "a system"},
};

enum { NUM_CONTENTS = sizeof contents / sizeof *contents };

static ritz_status refuse_content(const char *path, const char *noun, int holds)
{
    char list[160] = "";

    for (int k = 0; k < NUM_CONTENTS; k++)
        if (contents[k].holds & holds)
            sink_append(list, sizeof list, "%s%s", *list ? " or " : "",
                        contents[k].noun);
    return ritz_fail(RITZ_ERR_FORMAT, "'%s' holds %s, not %s", path, noun,
                     list);
}

/* Say what is wrong with a file without any of these contents. */
static ritz_status refuse_file(const char *path)
{
    struct stat file = {0};

    RITZ_REFUSE_IF(stat(path, &file) != 0, RITZ_ERR_FILE,
                   "cannot open '%s': %s", path, strerror(errno));
    RITZ_REFUSE_IF(S_ISREG(file.st_mode) && file.st_size == 0, RITZ_ERR_FORMAT,
                   "'%s' is empty", path);
    RITZ_REFUSE_IF(S_ISDIR(file.st_mode), RITZ_ERR_FILE, "'%s' is a folder",
                   path);
    return ritz_fail(RITZ_ERR_FORMAT,
                     "'%s' is no container, no table of --tracks, and no file "
                     "of --record",
                     path);
}

static ritz_status read_file(cli_run *run, const char *path, int holds,
                             chart_sources *out, chart_file *file)
{
    const bool container = ritz_container_is(path);
    model_kind kind = MODEL_ANY;
    const char *noun = NULL;

    file->path = path;
    if (container)
        RITZ_CHECK(model_peek(path, &kind, &noun));
    for (int k = 0; k < NUM_CONTENTS; k++) {
        const struct content *c = &contents[k];

        if (container ? c->model != (int)kind : !c->is || !c->is(path))
            continue;
        file->holds = c->holds;
        noun = container ? noun : c->noun;
    }
    if (!noun)
        return refuse_file(path);
    if (!(file->holds & holds))
        return refuse_content(path, noun, holds);
    if (container)
        return model_read(run, path, (int)kind, &file->model);
    RITZ_CHECK(cli_input(run, path));
    return file->holds == CHART_RECORDS ? records_read(path, &out->runs)
                                        : ritz_text_read(path, &file->text);
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

chart_word chart_say_error(double error)
{
    chart_word out = {"not measured"};

    if (error <= 0.0)
        snprintf(out.text, sizeof out, error < 0.0 ? "below 0" : "0");
    else if (error < RECORDS_ROUNDING)
        snprintf(out.text, sizeof out, "< %.0e", RECORDS_ROUNDING);
    else if (error >= 0.0995 && error < 100.0)
        snprintf(out.text, sizeof out, "%.0f\xc2\xa0%%", 100.0 * error);
    else if (error >= 1e-4 && error < 100.0)
        snprintf(out.text, sizeof out, "%.2g\xc2\xa0%%", 100.0 * error);
    else if (!isnan(error))
        snprintf(out.text, sizeof out, "%.1e", error);
    return out;
}

chart_word chart_say_seconds(double seconds)
{
    static const struct {
        double unit;
        const char *name;
    } units[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "\xc2\xb5s"}, {1e-9, "ns"}};
    chart_word out;
    int k = 0;

    while (k < 3 && seconds < 0.9995 * units[k].unit)
        k++;
    snprintf(out.text, sizeof out,
             seconds >= 99.95 * units[k].unit ? "%.0f\xc2\xa0%s"
                                              : "%.2g\xc2\xa0%s",
             seconds / units[k].unit, units[k].name);
    return out;
}

int64_t chart_find_name(int64_t count, char (*name)[RITZ_NAME_SIZE],
                        const char *wanted)
{
    for (int64_t k = 0; k < count; k++)
        if (strcmp(name[k], wanted) == 0)
            return k;
    return -1;
}
