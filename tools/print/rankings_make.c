#include "print/rankings_make.h"

#include "base/alloc.h"

#include <ritz/base.h>
#include <ritz/basis.h>

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 3, FIELD = 256 };

/* "TRACK\tCONFIGURATION\tMODE\t..." of one line; false if it is none. */
static bool cut_line(const char *line, char field[FIELDS][FIELD])
{
    for (int k = 0; k < FIELDS; k++) {
        size_t length = strcspn(line, "\t\n");

        if (length >= FIELD)
            return false;
        memcpy(field[k], line, length);
        field[k][length] = '\0';
        line += length;
        if (*line != '\t')
            return k == FIELDS - 1;
        line++;
    }
    return true;
}

/* Configuration of that name; systems without sweeps are "as joined". */
static int64_t find_configuration(const ritz_rankings *all, const char *at)
{
    for (int64_t k = 0; k < all->count; k++)
        if (strcmp(*all->item[k].at ? all->item[k].at : "as joined", at) == 0)
            return k;
    return -1;
}

static ritz_status take_track(const char *line, int64_t most,
                              ritz_rankings *all)
{
    char field[FIELDS][FIELD];
    int64_t track = 0, mode = 0, at = -1;

    RITZ_REFUSE_IF(
        !cut_line(line, field) || !ritz_text_whole(field[0], &track) ||
            !ritz_text_whole(field[2], &mode) || track < 1 || track > most ||
            mode < 1,
        RITZ_ERR_FORMAT, "'%.40s' is no line of a table of tracks", line);
    at = find_configuration(all, field[1]);
    if (at < 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(mode > all->item[at].count, RITZ_ERR_FORMAT,
                   "mode %ld at '%s' is not there: the tracks are those of "
                   "another system",
                   mode, field[1]);
    all->track[at][mode - 1] = track - 1;
    return RITZ_OK;
}

static ritz_status check_tracks(const ritz_rankings *all)
{
    for (int64_t k = 0; k < all->count; k++)
        for (int64_t i = 0; i < all->item[k].count; i++)
            RITZ_REFUSE_IF(all->track[k][i] < 0, RITZ_ERR_FORMAT,
                           "mode %ld at '%s' has no track", i + 1,
                           all->item[k].at);
    return RITZ_OK;
}

static ritz_status make_tracks(ritz_rankings *all)
{
    all->track = ritz_zalloc(all->count + 1, sizeof *all->track);
    RITZ_REFUSE_IF(!all->track, RITZ_ERR_MEMORY, "no memory for tracks");
    for (int64_t k = 0; k < all->count; k++) {
        size_t m = (size_t)all->item[k].count;

        all->track[k] = malloc((m + 1) * sizeof **all->track);
        RITZ_REFUSE_IF(!all->track[k], RITZ_ERR_MEMORY, "no memory for tracks");
        for (size_t i = 0; i < m; i++)
            all->track[k][i] = -1;
    }
    return RITZ_OK;
}

/* Numbers of modes at each configuration, from the table that --tracks of other
   tools writes. */
static ritz_status read_tracks(cli_run *run, const char *path,
                               ritz_rankings *all)
{
    ritz_status status = RITZ_OK;
    char *text = NULL;
    int64_t size = 0, rows = 0;

    RITZ_TRY(cli_input(run, path));
    RITZ_TRY(ritz_bytes_read(path, &size, &text));
    RITZ_TRY(make_tracks(all));
    RITZ_FAIL_IF(strncmp(text, "track\tconfiguration\tmode\t", 25) != 0,
                 RITZ_ERR_FORMAT, "it is no table of tracks");
    for (const char *c = text; *c; c++)
        rows += *c == '\n';
    for (const char *line = strchr(text, '\n'); line && line[1];
         line = strchr(line + 1, '\n'))
        RITZ_TRY(take_track(line + 1, rows, all));
    RITZ_TRY(check_tracks(all));
done:
    free(text);
    return ritz_context(status, path);
}

/* Words of Gramians that are a choice of components. */
static void take_choice(const cli_program *program, const char *key,
                        const char *text, ritz_choice *choice)
{
    for (const ritz_choice_word *w = ritz_choice_words; text && w->key; w++)
        if (strcmp(w->key, key) == 0 &&
            ritz_choice_take(w, text, choice) != RITZ_OK)
            cli_refuse(program, "%s", ritz_error_message());
}

void rank_take(const cli_run *run, rank_wish *asked)
{
    const cli_program *program = run->program;
    const char *list = asked->by;
    char word[RITZ_NAME_SIZE];

    if (asked->compare && (asked->at || asked->damping.count > 0 ||
                           asked->tracks || asked->keep > 0))
        cli_refuse(program, "--compare takes rankings as they are");
    if (!asked->compare && run->num_operands > 1)
        cli_refuse(program, "one model is ranked; rankings of several go to "
                            "--compare");
    if (asked->at && asked->tracks)
        cli_refuse(program, "--tracks follows modes over configurations, --at "
                            "leaves one");
    while (cli_next(&list, word)) {
        if (asked->num_rankers == RANK_MOST)
            cli_refuse(program, "--by takes up to %d rankings", RANK_MOST);
        asked->ranker[asked->num_rankers++] =
            cli_choose(program, "no ranking", word, ritz_rankers);
    }
    if (asked->band)
        cli_pair(program, "band-hz", asked->band, asked->band_hz);
    take_choice(program, "engine", asked->engine, &asked->choice);
    take_choice(program, "among_hz", asked->among, &asked->choice);
}

/* A model, and the settings of the rankings at work. */
typedef struct subject {
    cli_run *run;
    const rank_wish *asked;
    model *m;
    ritz_weights weights;
    ritz_rank_choice choice; /* with the damping of the group at work */
    char damping[RITZ_DAMPING_SIZE];
} subject;

static ritz_status request_of(const subject *s, const ritz_ranker *ranker,
                              const ritz_configuration *at,
                              ritz_rank_request *out)
{
    return at ? ritz_rank_request_of_configuration(at, &s->choice,
                                                   ranker->needs, out)
              : ritz_rank_request_of_reduced(&s->m->reduced, &s->choice,
                                             ranker->needs, out);
}

static ritz_status rank_at(const subject *s, const ritz_ranker *ranker,
                           const ritz_configuration *at, ritz_ranking *out)
{
    ritz_status status = RITZ_OK;
    ritz_rank_request request = {0};

    RITZ_TRY(request_of(s, ranker, at, &request));
    RITZ_TRY(ritz_rank(ranker, &request, out));
    snprintf(out->damping, sizeof out->damping, "%s", s->damping);
    if (at)
        snprintf(out->at, sizeof out->at, "%s", at->at);
done:
    ritz_rank_request_free(&request);
    return at ? ritz_context(status, at->at) : status;
}

/* At one configuration: at several, each would want weights of its own. */
static ritz_status reweigh_outputs(const subject *s)
{
    const ritz_system *system = &s->m->system;
    const ritz_configuration *at = s->m->at;
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_reweighing) found = {0};
    const rank_wish *asked = s->asked;

    RITZ_REFUSE_IF(!at && system->num_configurations > 1, RITZ_ERR_ARGUMENT,
                   "weights are found at one configuration, --at says which");
    if (!at && system->num_configurations == 1)
        at = system->configuration;
    RITZ_CHECK(request_of(s, &ritz_ranker_modal_cost, at, &request));
    RITZ_CHECK(ritz_reweigh(&request, asked->keep, &found));
    rankings_say_weights(s->run, &request, &found, asked->keep);
    return RITZ_OK;
}

static void say_group(const subject *s, const ranked *group)
{
    const rank_wish *asked = s->asked;
    bool several = group->all.count > 1 || asked->num_rankers > 1 ||
                   asked->damping.count > 1;

    for (int64_t k = 0; k < group->all.count; k++) {
        const ritz_ranking *r = &group->all.item[k];

        cli_say(s->run,
                "%s%ld flexible modes of '%s'%s%s by %s [%s], damping %s",
                k > 0 ? "\n" : "", r->count, s->run->operand[0],
                *r->at ? " at " : "", r->at, r->by, r->reference,
                rankings_damping(r));
        rankings_say(s->run, r, group->all.track ? group->all.track[k] : NULL,
                     several ? asked->top : INT64_MAX);
    }
    if (group->all.count > 1)
        rankings_say_largest(s->run, group);
    rankings_warn(s->run, group);
}

/* One ranking and one damping, at one configuration or all. */
static ritz_status make_group(const subject *s, const ritz_ranker *ranker,
                              ranked *out)
{
    const model *m = s->m;
    bool system = m->kind == MODEL_SYSTEM;
    int64_t count = system && !m->at ? m->system.num_configurations : 1;
    ritz_rankings *all = &out->all;

    all->item = ritz_zalloc(count + 1, sizeof *all->item);
    RITZ_REFUSE_IF(!all->item, RITZ_ERR_MEMORY, "no memory for rankings");
    for (int64_t k = 0; k < count; k++) {
        const ritz_configuration *at = m->at    ? m->at
                                       : system ? &m->system.configuration[k]
                                                : NULL;

        all->count++;
        RITZ_CHECK(rank_at(s, ranker, at, &all->item[k]));
    }
    if (s->asked->tracks)
        RITZ_CHECK(read_tracks(s->run, s->asked->tracks, all));
    if (count > 1)
        RITZ_CHECK(ritz_rankings_largest(all, &out->largest, &out->where,
                                         &out->track));
    return RITZ_OK;
}

/* Dampers of every configuration that is ranked; what is left out is said. */
static ritz_status install_dampers(subject *s)
{
    ritz_status status = RITZ_OK;
    model *m = s->m;
    const char *path = s->run->operand[0];
    ritz_configuration *chosen = m->at;
    bool all = m->kind == MODEL_SYSTEM && !chosen;
    int64_t count = all ? m->system.num_configurations : 1;
    bool structural = false;

    for (int64_t k = 0; k < count; k++) {
        if (all)
            m->at = &m->system.configuration[k];
        RITZ_TRY_IN(path, model_install(m, NULL));
        structural = structural || model_matrices(m).K4->val;
    }
    if (structural)
        cli_warn(s->run,
                 "the structural damping of '%s' is left out of its ranking",
                 path);
done:
    m->at = chosen;
    return status;
}

static ritz_status set_damping(subject *s, const char *asked)
{
    const char *own = s->m->kind == MODEL_SYSTEM ? s->m->system.damping
                                                 : s->m->reduced.damping;

    RITZ_CHECK_IN(asked ? "--damping" : "damping of the model",
                  ritz_damping_parse(asked ? asked : own, &s->choice.damping));
    ritz_damping_print(&s->choice.damping, s->damping);
    return RITZ_OK;
}

static ritz_status make_groups(subject *s, rank_result *out)
{
    const rank_wish *asked = s->asked;
    int64_t dampings = asked->damping.count > 0 ? asked->damping.count : 1;

    out->group =
        ritz_zalloc((asked->num_rankers * dampings) + 1, sizeof *out->group);
    RITZ_REFUSE_IF(!out->group, RITZ_ERR_MEMORY, "no memory for rankings");
    for (int64_t d = 0; d < dampings; d++) {
        RITZ_CHECK(set_damping(
            s, asked->damping.count > 0 ? asked->damping.text[d] : NULL));
        for (int64_t r = 0; r < asked->num_rankers; r++) {
            ranked *group = &out->group[out->count++];

            RITZ_CHECK_IN(s->run->operand[0],
                          make_group(s, asked->ranker[r], group));
            if (out->count > 1)
                cli_say(s->run, "%s", "");
            say_group(s, group);
        }
    }
    if (asked->keep > 0)
        RITZ_CHECK_IN(s->run->operand[0], reweigh_outputs(s));
    return RITZ_OK;
}

/* Keys of the report: those of the first group, and all others in a list. */
static void set_groups(cli_run *run, const rank_result *result)
{
    const ranked *first = result->group;

    sink_list(run, "rankings");
    for (int64_t g = 0; g < result->count; g++) {
        const ritz_rankings *all = &result->group[g].all;

        for (int64_t k = 0; k < all->count; k++) {
            sink_object(run, NULL);
            rankings_set(run, &all->item[k], all->track ? all->track[k] : NULL);
            sink_end(run);
        }
    }
    sink_end(run);
    sink_object(run, "whole");
    rankings_set(run, ranked_whole(first), ranked_track(first));
    sink_end(run);
    sink_lift(run, json_object_get(run->report, "whole"));
    json_object_del(run->report, "whole");
    if (first->all.count > 1) {
        sink_list(run, "where");
        for (int64_t k = 0; k < first->largest.count; k++)
            sink_add(run, "%s", first->all.item[first->where[k]].at);
        sink_end(run);
    }
}

static ritz_status rank_modes(cli_run *run, const rank_wish *asked, model *m,
                              rank_result *out)
{
    ritz_status status = RITZ_OK;
    subject s = {.run = run, .asked = asked, .m = m};
    const double *band = asked->band_hz;

    RITZ_FAIL_IF(asked->choice.given, RITZ_ERR_ARGUMENT,
                 "'%s' is small: its Gramians are in closed form, an engine is "
                 "chosen for components",
                 run->operand[0]);
    if (asked->at)
        RITZ_TRY(model_at(m, run->operand[0], asked->at));
    if (m->kind == MODEL_SYSTEM && !(band[1] > 0.0))
        band = m->system.band_hz;
    memcpy(s.choice.band_hz, band, sizeof s.choice.band_hz);
    s.choice.weights = &s.weights;
    RITZ_TRY(ritz_weights_parse(asked->input_weights, asked->output_weights,
                                &s.weights));
    RITZ_TRY(install_dampers(&s));
    RITZ_TRY(make_groups(&s, out));
    set_groups(run, out);
done:
    ritz_weights_free(&s.weights);
    return status;
}

/* Exact values of what is not in modes. */
static ritz_status make_gramians(cli_run *run, const rank_wish *asked,
                                 const model *m, ritz_gramians *gramians)
{
    ritz_status status = RITZ_OK;
    ritz_gramians_request request = {.component = &m->component,
                                     .engine = asked->choice.engine,
                                     .among_hz = asked->choice.among_hz};

    if (m->kind == MODEL_STATES) {
        RITZ_FAIL_IF(asked->damping.count > 0 || asked->choice.given,
                     RITZ_ERR_ARGUMENT,
                     "a state space has its damping, and one engine for its "
                     "Gramians");
        return ritz_gramians_of_space(&m->states, gramians);
    }
    RITZ_TRY(model_damping(
        m, asked->damping.count > 0 ? asked->damping.text[0] : NULL,
        &request.damping));
    RITZ_TRY(ritz_gramians_of_component(&request, gramians));
done:
    return ritz_context(status, run->operand[0]);
}

static ritz_status check_values(const rank_wish *asked, const model *m)
{
    const char *what =
        m->kind == MODEL_STATES ? "a state space" : "a component";

    RITZ_REFUSE_IF(asked->num_rankers > 1 ||
                       asked->ranker[0] != &ritz_ranker_hankel,
                   RITZ_ERR_ARGUMENT,
                   "%s is not in modes: it has Hankel values, and nothing else "
                   "ranks it; reduce it to modes first",
                   what);
    RITZ_REFUSE_IF(asked->at || asked->tracks || asked->keep > 0 ||
                       asked->chart || asked->damping.count > 1 ||
                       asked->input_weights || asked->output_weights,
                   RITZ_ERR_ARGUMENT,
                   "%s is not in modes: --at, --tracks, --reweigh, --chart, "
                   "weights and several dampings go with those",
                   what);
    return RITZ_OK;
}

static ritz_status rank_values(cli_run *run, const rank_wish *asked, model *m,
                               rank_result *out)
{
    RITZ_OWN(ritz_gramians) gramians = {0};
    ritz_ranking *r = NULL;

    RITZ_CHECK_IN(run->operand[0], check_values(asked, m));
    RITZ_CHECK(make_gramians(run, asked, m, &gramians));
    out->group = ritz_zalloc(1, sizeof *out->group);
    RITZ_REFUSE_IF(!out->group, RITZ_ERR_MEMORY, "no memory for rankings");
    out->count = 1;
    out->group->all.item = r = ritz_zalloc(1, sizeof *r);
    RITZ_REFUSE_IF(!r, RITZ_ERR_MEMORY, "no memory for rankings");
    out->group->all.count = 1;
    snprintf(r->by, sizeof r->by, "%s", ritz_ranker_hankel.name);
    snprintf(r->reference, sizeof r->reference, "%s",
             ritz_ranker_hankel.reference);
    snprintf(r->damping, sizeof r->damping, "%s",
             m->kind == MODEL_STATES ? m->states.damping : gramians.damping);
    r->total = nan("");
    r->coupling = nan("");
    RITZ_CHECK(
        ritz_gramians_hankel(&gramians, &r->num_system, &r->system_value));
    cli_say(run, "%ld Hankel values of '%s', %s, damping %s", r->num_system,
            run->operand[0], gramians.engine, rankings_damping(r));
    if (gramians.T.ncol > 0)
        cli_say(run,
                "%ld states that are not damped, or grow, have none and stand "
                "apart",
                gramians.T.ncol);
    if (gramians.residual[0] > 0.0 || gramians.residual[1] > 0.0)
        cli_say(run, "residuals of both Gramians %.1e and %.1e",
                gramians.residual[0], gramians.residual[1]);
    rankings_say_values(run, r, 40);
    set_groups(run, out);
    sink_set(run, "engine", "%s", gramians.engine);
    return RITZ_OK;
}

static ritz_status rank_model(cli_run *run, const rank_wish *asked,
                              rank_result *out)
{
    RITZ_OWN(model) m = {0};

    RITZ_CHECK(model_read(
        run, run->operand[0],
        MODEL_REDUCED | MODEL_SYSTEM | MODEL_COMPONENT | MODEL_STATES, &m));
    RITZ_CHECK(model_prefix(&m, run->operand[0], asked->order));
    return m.kind == MODEL_REDUCED || m.kind == MODEL_SYSTEM
               ? rank_modes(run, asked, &m, out)
               : rank_values(run, asked, &m, out);
}

/* Rankings of --compare. */
static ritz_status read_rankings(cli_run *run, rank_result *out)
{
    int64_t count = run->num_operands;
    RITZ_OWN(model) m = {0};

    out->group = ritz_zalloc(count, sizeof *out->group);
    out->file = ritz_zalloc(count, sizeof *out->file);
    RITZ_REFUSE_IF(!out->group || !out->file, RITZ_ERR_MEMORY,
                   "no memory for rankings");
    for (int64_t k = 0; k < count; k++) {
        RITZ_CHECK(model_read(run, run->operand[k], MODEL_RANKING, &m));
        RITZ_REFUSE_IF(m.rankings.count == 0, RITZ_ERR_FORMAT,
                       "'%s' holds no ranking", run->operand[k]);
        out->group[k].all = m.rankings;
        m.rankings = (ritz_rankings){0};
        snprintf(out->file[k], RITZ_NAME_SIZE, "%.63s", run->operand[k]);
        out->count++;
    }
    RITZ_REFUSE_IF(count == 1 && out->group->all.count == 1, RITZ_ERR_ARGUMENT,
                   "'%s' holds one ranking: name another to compare it with",
                   run->operand[0]);
    set_groups(run, out);
    return RITZ_OK;
}

void rank_result_free(rank_result *result)
{
    for (int64_t k = 0; k < result->count; k++)
        ranked_free(&result->group[k]);
    free(result->group);
    free(result->file);
    *result = (rank_result){0};
}

/* Write rankings and their table, compare them, draw their chart. */
static ritz_status report_rankings(cli_run *run, const rank_wish *asked,
                                   const rank_result *result)
{
    [[gnu::cleanup(rank_contest_free)]] contest all = {0};
    char title[256];
    const ritz_ranking *first = ranked_whole(result->group);

    if (run->output) {
        ritz_stamp stamp = cli_stamp(run);

        RITZ_CHECK(rank_write(run->output, result, &stamp));
    }
    RITZ_CHECK(rank_contest(result, true, &all));
    if (asked->table)
        RITZ_CHECK(rankings_write_table(asked->table, &all));
    rank_contest_free(&all);
    RITZ_CHECK(rank_contest(result, false, &all));
    if (all.count > 1)
        RITZ_CHECK(rankings_compare(run, &all, asked->top));
    snprintf(title, sizeof title, "%.100s, damping %.100s", run->operand[0],
             rankings_damping(first));
    if (asked->chart)
        RITZ_CHECK(asked->draw(asked->chart, title, &all, asked->top));
    cli_record(run, first->by,
               first->count > 0 ? first->count : first->num_system);
    return RITZ_OK;
}

ritz_status rank_run(cli_run *run, const rank_wish *asked)
{
    RITZ_OWN(rank_result) result = {0};

    if (asked->compare)
        RITZ_CHECK(read_rankings(run, &result));
    else
        RITZ_CHECK(rank_model(run, asked, &result));
    return report_rankings(run, asked, &result);
}
