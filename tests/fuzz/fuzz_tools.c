/* Texts that tools read: claims, records, tables of tracks. */
#include "fuzz.h"

#include "base/alloc.h"
#include "chart/chart.h"
#include "claims/claims.h"
#include "cli/records.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* --- claims --------------------------------------------------------------- */

/* The folder where commands run, and into which claims write files. */
static const char folder[] = "claims";

/* What the last command would have printed as JSON. */
static json_t *make_answer(void)
{
    return json_pack("{s:[f,f,f], s:s, s:b, s:i, s:[{s:s, s:f}]}",
                     "frequencies_hz", 0.5, 1.875104, 4.694091, "error",
                     "a rigid-body motion is left free", "ok", 1, "order", 12,
                     "measures", "name", "static-gain-relative", "value", 1e-9);
}

/* No command runs, because its tools are not where claims look for them. */
void fuzz_claims(const char *bytes, int64_t size)
{
    cli_run run = {.quiet = true};
    claims_state state = {.run = &run,
                          .bin = "/no-tools",
                          .data = "data",
                          .exit_code = 1,
                          .list = json_array(),
                          .answer = make_answer()};

    mkdir(folder, 0700);
    (void)snprintf(state.folder, sizeof state.folder, "%s", folder);
    fuzz_store("a.claims", bytes, size);
    fuzz_judge(cli_table_new(&run.said));
    fuzz_judge(claims_file(&state, "a.claims"));
    cli_table_free(&run.said);
    json_decref(state.list);
    json_decref(state.answer);
    fuzz_empty(folder);
}

/* --- records -------------------------------------------------------------- */

void fuzz_records(const char *bytes, int64_t size)
{
    records all = {0};
    record_set set = {0};
    ritz_status status = RITZ_OK;

    fuzz_store("runs.jsonl", bytes, size);
    (void)records_is("runs.jsonl");
    status = records_read("runs.jsonl", &all);
    fuzz_judge(status);
    if (status == RITZ_OK) {
        records_join(&all);
        (void)records_cost(&all);
        status = record_set_new(&all, NULL, &set);
        fuzz_judge(status);
        for (int64_t k = 0; status == RITZ_OK && k < set.num_measures; k++)
            (void)records_matter(&set.all, &set.measure[k]);
        record_set_free(&set);
    }
    records_free(&all);
}

/* --- tracks --------------------------------------------------------------- */

ritz_status __wrap_picture_draw(picture *p, const char *template, /* NOLINT */
                                const char *title, const char *summary);

/* Draws nothing: gnuplot is not to be fuzzed. */
ritz_status __wrap_picture_draw(picture *p, const char *template, /* NOLINT */
                                const char *title, const char *summary)
{
    (void)p;
    (void)template;
    (void)title;
    (void)summary;
    return RITZ_OK;
}

void fuzz_tracks(const char *bytes, int64_t size)
{
    chart_file file = {.holds = CHART_TRACKS,
                       .path = "tracks.tsv",
                       .text = strndup(bytes, (size_t)size)};
    cli_run run = {.quiet = true, .warnings = json_array()};
    const chart_sources sources = {.run = &run, .count = 1, .file = &file};
    const chart_request request = {.up_to_hz = DBL_MAX};
    RITZ_OWN(picture) drawn = {0};

    if (file.text && picture_new("tracks.svg", false, &drawn) == RITZ_OK)
        fuzz_judge(chart_tracks(&sources, &request, &drawn));
    json_decref(run.warnings);
    free(file.text);
}
