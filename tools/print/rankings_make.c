#include "print/print.h"

/* Configuration of that name; systems without sweeps are "as joined". */
static int64_t find_configuration(const ritz_rankings *all, const char *at)
{
    for (int64_t k = 0; k < all->count; k++)
        if (strcmp(*all->item[k].at ? all->item[k].at : "as joined", at) == 0)
            return k;
    return -1;
}

/* "TRACK\tCONFIGURATION\tMODE\t..." of one line. */
static ritz_status take_track(const char *line, int64_t most,
                              ritz_rankings *all)
{
    char first[256], name[256], third[256];
    int64_t track = 0, mode = 0, at = -1;

    RITZ_REFUSE_IF(
        sscanf(line, "%255[^\t\n]%*1[\t]%255[^\t\n]%*1[\t]%255[^\t\n]", first,
               name, third) != 3 ||
            !ritz_text_whole(first, &track) || !ritz_text_whole(third, &mode) ||
            track < 0 || track > most || mode < 1,
        RITZ_ERR_FORMAT, "'%.40s' is no line of a table of tracks", line);
    at = find_configuration(all, name);
    if (at < 0 || track == 0) /* a negative square of forces has no track */
        return RITZ_OK;
    RITZ_REFUSE_IF(mode > all->item[at].count, RITZ_ERR_FORMAT,
                   "mode %ld at '%s' is not there: the tracks are those of "
                   "another system",
                   mode, name);
    all->track[at][mode - 1] = track - 1;
    return RITZ_OK;
}

/* No mode has a number yet. */
static ritz_status make_tracks(ritz_rankings *all)
{
    RITZ_CHECK_NEW(all->track, all->count + 1);
    for (int64_t k = 0; k < all->count; k++) {
        RITZ_CHECK_NEW(all->track[k], all->item[k].count + 1);
        for (int64_t i = 0; i < all->item[k].count; i++)
            all->track[k][i] = -1;
    }
    return RITZ_OK;
}

static ritz_status take_tracks(const char *text, ritz_rankings *all)
{
    int64_t rows = 0;

    RITZ_CHECK(make_tracks(all));
    RITZ_REFUSE_IF(strncmp(text, "track\tconfiguration\tmode\t", 25) != 0,
                   RITZ_ERR_FORMAT, "it is no table of tracks");
    for (const char *c = text; *c; c++)
        rows += *c == '\n';
    for (const char *line = strchr(text, '\n'); line && line[1];
         line = strchr(line + 1, '\n'))
        RITZ_CHECK(take_track(line + 1, rows, all));
    for (int64_t k = 0; k < all->count; k++)
        for (int64_t i = 0; i < all->item[k].count; i++)
            RITZ_REFUSE_IF(all->track[k][i] < 0, RITZ_ERR_FORMAT,
                           "mode %ld at '%s' has no track", i + 1,
                           all->item[k].at);
    return RITZ_OK;
}

/* Numbers of modes at each configuration, from the table that --tracks of other
   tools writes. */
static ritz_status read_tracks(cli_run *run, const char *path,
                               ritz_rankings *all)
{
    RITZ_OWN_ARRAY char *text = NULL;
    int64_t size = 0;

    RITZ_CHECK_IN(path, cli_input(run, path));
    RITZ_CHECK_IN(path, ritz_bytes_read(path, &size, &text));
    return ritz_context(take_tracks(text, all), path);
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

/* Take words of the command line, or end the program. */
static void take_options(const cli_run *run, rank_options *given)
{
    const cli_program *program = run->program;
    const char *list = given->by;
    char word[RITZ_NAME_SIZE];

    if (given->compare && (given->at || given->damping.count > 0 ||
                           given->tracks || given->keep > 0))
        cli_refuse(program, "--compare takes rankings as they are");
    if (!given->compare && run->num_operands > 1)
        cli_refuse(program, "one model is ranked; rankings of several go to "
                            "--compare");
    if (given->at && given->tracks)
        cli_refuse(program, "--tracks follows modes over configurations, --at "
                            "leaves one");
    while (cli_next(&list, word)) {
        if (given->num_rankers == RANK_MOST)
            cli_refuse(program, "--by takes up to %d rankings", RANK_MOST);
        given->ranker[given->num_rankers++] =
            cli_choose(program, "ranking", word, ritz_rankers);
    }
    take_choice(program, "engine", given->engine, &given->choice);
    take_choice(program, "among_hz", given->among, &given->choice);
}

/* A model, and the settings of the rankings at work. */
typedef struct subject {
    cli_run *run;
    const rank_options *given;
    model *m;
    ritz_rank_choice choice; /* with the damping of the group at work */
    char damping[RITZ_DAMPING_SIZE];
} subject;

static int64_t count_configurations(const model *m)
{
    return m->kind == MODEL_SYSTEM && !m->at ? m->system.num_configurations : 1;
}

/* The k-th configuration that is ranked; NULL: of a reduced component. */
static ritz_configuration *configuration_of(const model *m, int64_t k)
{
    if (m->at || m->kind != MODEL_SYSTEM)
        return m->at;
    return &m->system.configuration[k];
}

static ritz_status make_request(const subject *s, const ritz_ranker *ranker,
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
    RITZ_OWN(ritz_rank_request) request = {0};

    RITZ_CHECK(make_request(s, ranker, at, &request));
    RITZ_CHECK(ritz_rank(ranker, &request, out));
    snprintf(out->damping, sizeof out->damping, "%s", s->damping);
    if (at)
        snprintf(out->at, sizeof out->at, "%s", at->at);
    return RITZ_OK;
}

/* At one configuration: at several, each would want weights of its own. */
static ritz_status reweigh_outputs(const subject *s)
{
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_reweighing) found = {0};
    int64_t keep = s->given->keep;

    RITZ_REFUSE_IF(count_configurations(s->m) > 1, RITZ_ERR_ARGUMENT,
                   "weights are found at one configuration, --at says which");
    RITZ_CHECK(make_request(s, &ritz_ranker_modal_cost,
                            configuration_of(s->m, 0), &request));
    RITZ_CHECK(ritz_reweigh(&request, keep, &found));
    rankings_say_weights(s->run, &request, &found, keep);
    return RITZ_OK;
}

static void say_group(const subject *s, const ranked *group)
{
    const rank_options *given = s->given;
    bool several = group->all.count > 1 || given->num_rankers > 1 ||
                   given->damping.count > 1;

    for (int64_t k = 0; k < group->all.count; k++) {
        const ritz_ranking *r = &group->all.item[k];

        if (k > 0)
            cli_say(s->run, "%s", "");
        cli_say(s->run, "%ld flexible modes of '%s'%s%s by %s [%s], damping %s",
                r->count, s->run->operand[0], *r->at ? " at " : "", r->at,
                r->by, r->reference, rankings_damping(r));
        rankings_say(s->run, r, ranked_numbers(&group->all, k),
                     several ? given->top : INT64_MAX);
    }
    if (group->all.count > 1)
        rankings_say_largest(s->run, group);
    rankings_warn(s->run, group);
}

/* One ranking and one damping, at one configuration or all. */
static ritz_status make_group(const subject *s, const ritz_ranker *ranker,
                              ranked *out)
{
    int64_t count = count_configurations(s->m);
    ritz_rankings *all = &out->all;

    RITZ_CHECK_NEW(all->item, count + 1);
    while (all->count < count) {
        const ritz_configuration *at = configuration_of(s->m, all->count);
        ritz_ranking *item = &all->item[all->count++];

        if (at)
            RITZ_CHECK_IN(at->at, rank_at(s, ranker, at, item));
        else
            RITZ_CHECK(rank_at(s, ranker, NULL, item));
    }
    if (s->given->tracks)
        RITZ_CHECK(read_tracks(s->run, s->given->tracks, all));
    if (count > 1)
        RITZ_CHECK(ritz_rankings_largest(all, &out->largest, &out->where,
                                         &out->track));
    return RITZ_OK;
}

/* Dampers of every configuration that is ranked; what is left out is said. */
static ritz_status install_dampers(const subject *s)
{
    const char *path = s->run->operand[0];
    bool structural = false;

    for (int64_t k = 0; k < count_configurations(s->m); k++) {
        ritz_configuration *at = configuration_of(s->m, k);

        RITZ_CHECK_IN(path, at ? ritz_configuration_install(at)
                               : ritz_reduced_install(&s->m->reduced));
        structural = structural || (at ? at->K4 : s->m->reduced.K4).val;
    }
    if (structural)
        cli_warn(s->run,
                 "the structural damping of '%s' is left out of its ranking",
                 path);
    return RITZ_OK;
}

static ritz_status make_groups(subject *s, rank_result *out)
{
    const rank_options *given = s->given;
    int64_t dampings = given->damping.count > 0 ? given->damping.count : 1;

    RITZ_CHECK_NEW(out->group, given->num_rankers * dampings + 1);
    for (int64_t d = 0; d < dampings; d++) {
        RITZ_CHECK(model_damping(
            s->m, given->damping.count > 0 ? given->damping.text[d] : NULL,
            &s->choice.damping));
        ritz_damping_print(&s->choice.damping, s->damping);
        for (int64_t r = 0; r < given->num_rankers; r++) {
            ranked *group = &out->group[out->count++];

            RITZ_CHECK_IN(s->run->operand[0],
                          make_group(s, given->ranker[r], group));
            if (out->count > 1)
                cli_say(s->run, "%s", "");
            say_group(s, group);
        }
    }
    if (given->keep > 0)
        RITZ_CHECK_IN(s->run->operand[0], reweigh_outputs(s));
    return RITZ_OK;
}

/* Keys of the report: those of the first group, and all others in a list. */
static void set_groups(cli_run *run, const rank_result *result)
{
    const ranked *first = result->group;

    SINK_EACH(run, "rankings", g, result->count) {
        const ritz_rankings *all = &result->group[g].all;

        for (int64_t k = 0; k < all->count; k++)
            rankings_set(run, &all->item[k], ranked_numbers(all, k));
    }
    sink_object(run, "whole");
    rankings_set(run, ranked_whole(first), ranked_track(first));
    sink_end(run);
    sink_lift(run, json_object_get(run->report, "whole"));
    json_object_del(run->report, "whole");
    if (first->all.count > 1) {
        SINK_EACH(run, "where", k, first->largest.count)
            sink_add(run, "%s", first->all.item[first->where[k]].at);
    }
}

static ritz_status rank_modes(cli_run *run, const rank_options *given, model *m,
                              rank_result *out)
{
    RITZ_OWN(ritz_weights) weights = {0};
    subject s = {
        .run = run, .given = given, .m = m, .choice.weights = &weights};
    const double *band = given->band_hz;

    RITZ_REFUSE_IF(given->choice.given, RITZ_ERR_ARGUMENT,
                   "'%s' is small: its Gramians are in closed form, an engine "
                   "is chosen for components",
                   run->operand[0]);
    if (given->at)
        RITZ_CHECK(model_at(m, run->operand[0], given->at));
    if (m->kind == MODEL_SYSTEM && !(band[1] > 0.0))
        band = m->system.band_hz;
    memcpy(s.choice.band_hz, band, sizeof s.choice.band_hz);
    RITZ_CHECK(ritz_weights_parse(given->input_weights, given->output_weights,
                                  &weights));
    RITZ_CHECK(install_dampers(&s));
    RITZ_CHECK(make_groups(&s, out));
    set_groups(run, out);
    return RITZ_OK;
}

/* Exact values of what is not in modes. */
static ritz_status make_gramians(const rank_options *given, const model *m,
                                 ritz_gramians *gramians)
{
    ritz_gramians_request request = {.component = &m->component,
                                     .engine = given->choice.engine,
                                     .among_hz = given->choice.among_hz,
                                     .values_only = true};

    if (m->kind == MODEL_STATES) {
        RITZ_REFUSE_IF(given->damping.count > 0 ||
                           (given->choice.given & ~RITZ_USES_ENGINE),
                       RITZ_ERR_ARGUMENT,
                       "a state space has its damping, and no modes to choose");
        return ritz_gramians_of_space_by(&m->states, given->choice.engine, NULL,
                                         gramians);
    }
    RITZ_CHECK(model_damping(
        m, given->damping.count > 0 ? given->damping.text[0] : NULL,
        &request.damping));
    return ritz_gramians_of_component(&request, gramians);
}

static ritz_status check_values(const rank_options *given, const model *m)
{
    const char *what =
        m->kind == MODEL_STATES ? "a state space" : "a component";

    RITZ_REFUSE_IF(given->num_rankers > 1 ||
                       given->ranker[0] != &ritz_ranker_hankel,
                   RITZ_ERR_ARGUMENT,
                   "%s is not in modes: it has Hankel values, and nothing else "
                   "ranks it; reduce it to modes first",
                   what);
    RITZ_REFUSE_IF(given->at || given->tracks || given->keep > 0 ||
                       given->chart || given->damping.count > 1 ||
                       given->input_weights || given->output_weights,
                   RITZ_ERR_ARGUMENT,
                   "%s is not in modes: --at, --tracks, --reweigh, --chart, "
                   "weights and several dampings go with those",
                   what);
    return RITZ_OK;
}

static bool is_iterative(const ritz_gramians *gramians)
{
    return gramians->residual[0] > 0.0 || gramians->residual[1] > 0.0;
}

static void say_accuracy(cli_run *run, const ritz_gramians *gramians)
{
    const double *residual = gramians->residual;

    if (gramians->error > 0.0)
        cli_say(run, "no Hankel value errs by more than %.1e of the largest",
                gramians->error);
    if (is_iterative(gramians))
        cli_say(run, "residuals of both Gramians %.1e and %.1e", residual[0],
                residual[1]);
}

static ritz_status rank_values(cli_run *run, const rank_options *given,
                               model *m, rank_result *out)
{
    RITZ_OWN(ritz_gramians) gramians = {0};
    ritz_ranking *r = NULL;

    RITZ_CHECK_IN(run->operand[0], check_values(given, m));
    RITZ_CHECK_IN(run->operand[0], make_gramians(given, m, &gramians));
    RITZ_CHECK_NEW(out->group, 1);
    out->count = 1;
    RITZ_CHECK_NEW(out->group->all.item, 1);
    out->group->all.count = 1;
    r = out->group->all.item;
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
    say_accuracy(run, &gramians);
    rankings_say(run, r, NULL, 40);
    set_groups(run, out);
    sink_set(run, "engine", "%s", gramians.engine);
    if (gramians.error > 0.0)
        sink_set(run, "error", "%g", gramians.error);
    if (is_iterative(&gramians))
        SINK_EACH(run, "residuals", k, 2)
            sink_add(run, "%g", gramians.residual[k]);
    return RITZ_OK;
}

static ritz_status rank_model(cli_run *run, const rank_options *given,
                              rank_result *out)
{
    RITZ_OWN(model) m = {0};

    RITZ_CHECK(model_read(
        run, run->operand[0],
        MODEL_REDUCED | MODEL_SYSTEM | MODEL_COMPONENT | MODEL_STATES, &m));
    RITZ_CHECK(model_prefix(&m, run->operand[0], given->order));
    return m.kind == MODEL_REDUCED || m.kind == MODEL_SYSTEM
               ? rank_modes(run, given, &m, out)
               : rank_values(run, given, &m, out);
}

/* Rankings of --compare. */
static ritz_status read_rankings(cli_run *run, rank_result *out)
{
    int64_t count = run->num_operands;
    RITZ_OWN(model) m = {0};

    RITZ_CHECK_NEW(out->group, count);
    RITZ_CHECK_NEW(out->file, count);
    for (int64_t k = 0; k < count; k++) {
        RITZ_CHECK(model_read(run, run->operand[k], MODEL_RANKING, &m));
        RITZ_REFUSE_IF(m.rankings.count == 0, RITZ_ERR_FORMAT,
                       "'%s' holds no ranking", run->operand[k]);
        RITZ_MOVE(out->group[k].all, m.rankings);
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
    RITZ_FREE_EACH(ranked, result->count, result->group);
    free(result->file);
    *result = (rank_result){0};
}

/* All rankings in one container; their tracks, if all of them have some. */
static ritz_status write_rankings(cli_run *run, const contest *all)
{
    RITZ_OWN_ARRAY ritz_ranking *item = NULL; /* borrow what they hold */
    ritz_rankings rankings = {.count = all->count, .track = all->track};

    RITZ_CHECK_NEW(item, all->count + 1);
    for (int64_t k = 0; k < all->count; k++) {
        item[k] = *all->ranking[k];
        if (!all->track[k])
            rankings.track = NULL;
    }
    rankings.item = item;
    return ritz_container_write_rankings(run->output, &rankings,
                                         cli_stamp(run));
}

/* Write rankings and their table, compare them, draw their chart. */
static ritz_status report_rankings(cli_run *run, const rank_options *given,
                                   const rank_result *result)
{
    RITZ_OWN(contest) every = {0}, wholes = {0};
    char title[256];
    const ritz_ranking *first = ranked_whole(result->group);

    RITZ_CHECK(contest_new(result, true, &every));
    RITZ_CHECK(contest_new(result, false, &wholes));
    if (run->output)
        RITZ_CHECK(write_rankings(run, &every));
    if (given->table)
        RITZ_CHECK(rankings_write_table(given->table, &every));
    if (wholes.count > 1)
        RITZ_CHECK(rankings_compare(run, &wholes, given->top));
    snprintf(title, sizeof title, "%.100s, damping %.100s", run->operand[0],
             rankings_damping(first));
    if (given->chart)
        RITZ_CHECK(given->draw(given->chart, title, &wholes, given->top));
    cli_record(run, first->by,
               first->count > 0 ? first->count : first->num_system);
    return RITZ_OK;
}

ritz_status rank_run(cli_run *run, rank_options *given)
{
    RITZ_OWN(rank_result) result = {0};

    take_options(run, given);
    if (given->compare)
        RITZ_CHECK(read_rankings(run, &result));
    else
        RITZ_CHECK(rank_model(run, given, &result));
    return report_rankings(run, given, &result);
}
