#include "chart/chart.h"

#include "base/alloc.h"
#include "base/text.h"

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

/* Whether a file begins as a collection of VTK, behind comments of some
   kilobytes at most. */
static bool is_motion(const char *path)
{
    char head[1 << 14];
    FILE *file = fopen(path, "r");
    size_t size = 0;

    if (!file)
        return false;
    size = fread(head, 1, sizeof head - 1, file);
    fclose(file);
    head[size] = '\0';
    return ritz_collection_recognise(head);
}

/* Texts, which are told by how they begin. */
static const struct text_kind {
    int holds;
    bool (*is)(const char *path);
    const char *noun;
} texts[] = {
    {CHART_RECORDS, records_is, "run records"},
    {CHART_TRACKS, is_tracks, "a table of tracks"},
    {CHART_MOTION, is_motion, "a collection of frames"},
};

enum { NUM_TEXTS = sizeof texts / sizeof *texts };

static ritz_status refuse_content(const char *path, const char *noun, int holds)
{
    char list[160];

    model_nouns(holds, list, sizeof list);
    for (int k = 0; k < NUM_TEXTS; k++)
        if (texts[k].holds & holds)
            sink_append(list, sizeof list, "%s%s", *list ? " or " : "",
                        texts[k].noun);
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
    return ritz_fail(
        RITZ_ERR_FORMAT,
        "'%s' is no container, no table of --tracks, no collection "
        "of frames, and no file of --record",
        path);
}

static ritz_status read_file(cli_run *run, const char *path, int holds,
                             chart_sources *out, chart_file *file)
{
    model_kind kind = MODEL_ANY;
    const char *noun = NULL;

    file->path = path;
    if (ritz_container_seems(path)) {
        RITZ_CHECK(model_peek(path, &kind, &noun));
        file->holds = (int)kind;
    }
    for (int k = 0; k < NUM_TEXTS && !noun; k++)
        if (texts[k].is(path)) {
            file->holds = texts[k].holds;
            noun = texts[k].noun;
        }
    if (!noun)
        return refuse_file(path);
    if (!(file->holds & holds))
        return refuse_content(path, noun, holds);
    if (file->holds & MODEL_ANY)
        return model_read(run, path, file->holds, &file->model);
    RITZ_CHECK(cli_input(run, path));
    return file->holds == CHART_RECORDS ? records_read(path, &out->runs)
                                        : ritz_text_read(path, &file->text);
}

ritz_status chart_read(cli_run *run, int64_t count, char *const *path,
                       int holds, chart_sources *out)
{
    out->run = run;
    RITZ_CHECK_NEW(out->file, count);
    for (out->count = 0; out->count < count;) {
        chart_file *file = &out->file[out->count];

        RITZ_CHECK(read_file(run, path[out->count++], holds, out, file));
    }
    records_join(&out->runs);
    return RITZ_OK;
}

ritz_status chart_name_files(ritz_status status, const chart_sources *sources,
                             int holds)
{
    char names[400] = "";

    if (status == RITZ_OK)
        return RITZ_OK;
    for (int64_t k = 0; k < sources->count; k++) {
        const char *base = ritz_path_name(sources->file[k].path);

        if (strstr(ritz_error_message(), base))
            return status;
        if (sources->file[k].holds & holds)
            sink_append(names, sizeof names, "%s'%.60s'", *names ? ", " : "",
                        base);
    }
    return *names ? ritz_context(status, names) : status;
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

void chart_leave_squares(const chart_sources *sources, const char *name,
                         int64_t count, picture *out)
{
    if (count == 0)
        return;
    cli_warn(sources->run,
             "'%s': %ld negative squares of the forces that join bodies of "
             "dual-craig-bampton, no modes of these, are left out; "
             "macneal-rubin has the same columns",
             name, count);
    if (!strstr(out->note, "negative squares"))
        sink_append(out->note, sizeof out->note,
                    "%s%ld negative squares of interface forces, no modes, are "
                    "left out",
                    *out->note ? "; " : "", count);
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

ritz_status chart_check_names(const char *path, const char *what, int64_t count,
                              char (*name)[RITZ_NAME_SIZE], int64_t num_wanted,
                              char (*wanted)[RITZ_NAME_SIZE])
{
    for (int64_t k = 0; k < num_wanted; k++)
        RITZ_REFUSE_IF(ritz_name_index(count, name, wanted[k]) < 0,
                       RITZ_ERR_ARGUMENT, "'%s' has no %s '%s'", path, what,
                       wanted[k]);
    return RITZ_OK;
}
