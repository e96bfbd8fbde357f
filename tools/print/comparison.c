/* The report of ritz-compare: what was reduced, how far, how wrong it is. */
#include "print/print.h"

#include "base/alloc.h"
#include "model/pair.h"

#include <float.h>
#include <inttypes.h>

static void say_orders(cli_run *run, const ritz_stage *first,
                       const ritz_stage *second)
{
    int64_t sum[3] = {0};

    cli_say(run, "%-20s %10s %10s %10s  %s", "component", "full dofs",
            "stage 1", "stage 2", "basis of stage 1");
    SINK_EACH(run, "components", k, first->count) {
        const ritz_reduced *body = &first->body[k];
        const ritz_reduced *last = &second->body[k];
        int64_t order[] = {body->num_dofs,
                           body->K.nrow > 0 ? body->K.nrow : body->M.nrow,
                           last->K.nrow > 0 ? last->K.nrow : last->M.nrow};

        for (int i = 0; i < 3; i++)
            sum[i] += order[i];
        sink_say(run, "name,dofs_full,stage1,dofs",
                 "%-20s %10ld %10ld %10ld  %s", first->scene->component[k].name,
                 order[0], order[1], order[2], body->origin.method);
    }
    cli_say(run, "%-20s %10ld %10ld %10ld", "total", sum[0], sum[1], sum[2]);
    cli_record(run, "compare", sum[2]);
}

/* How vectors of the composite set were chosen. */
static void describe_choice(const ritz_scene *scene, char out[160])
{
    const size_t size = 160;
    bool channels = scene->num_inputs > 0 && scene->num_outputs > 0;

    switch (scene->select) {
    case RITZ_SELECT_LISTED:
        snprintf(out, size, "modes by a list of %ld", scene->num_select_modes);
        break;
    case RITZ_SELECT_KRYLOV:
        snprintf(out, size, "up to %ld Krylov vectors from %s at each",
                 scene->select_vectors,
                 scene->select_outputs ? "inputs and outputs" : "inputs");
        break;
    case RITZ_SELECT_RANKED:
        if (channels) {
            snprintf(out, size, "modes by %s above %g of the largest value",
                     *scene->select_by ? scene->select_by : "hankel",
                     scene->select_tolerance);
            break;
        }
        [[fallthrough]];
    case RITZ_SELECT_BAND:
        snprintf(out, size, "modes in the band");
        break;
    }
}

/* Whether modes were selected by a ranking, which does not include K4. */
static bool ranks_without_loss(const ritz_stage *first)
{
    const ritz_scene *scene = first->scene;
    bool structural = false;

    for (int64_t k = 0; k < first->count; k++)
        structural = structural || first->body[k].K4.val;
    return structural && scene->select == RITZ_SELECT_RANKED &&
           scene->num_inputs > 0 && scene->num_outputs > 0;
}

/* The first pair that a choice of modes cuts. */
static void warn_of_cuts(cli_run *run, const ritz_comparison *c)
{
    int64_t count = 0, first = 0;
    char text[RITZ_PAIR_SIZE];

    for (int64_t k = c->num_rows - 1; k >= 0; k--)
        if (c->row[k].listed && c->row[k].cut_value[0] > 0.0) {
            first = k;
            count++;
        }
    sink_set(run, "cut_pairs", "%ld", count);
    if (count == 0)
        return;
    ritz_pair_print(c->row[first].cut_hertz, c->row[first].cut_value,
                    c->row[first].num_kept, text);
    if (c->first_system.num_sweeps == 0)
        cli_warn(run, "%s", text);
    else
        cli_warn(run, "%s: %s%s", c->first_system.configuration[first].at, text,
                 count > 1 ? ", as at other configurations" : "");
}

static void say_composite(cli_run *run, const ritz_stage *first,
                          const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    int64_t count = scene->num_reference > 0 ? scene->num_reference
                                             : scene->num_configurations;
    int64_t completed = 0, equal = 0, joined = 0;
    char choice[160];

    describe_choice(scene, choice);
    for (int64_t k = 0; k < c->num_rows; k++)
        if (c->row[k].listed) {
            completed += c->row[k].num_completed;
            equal += c->row[k].num_equal;
            joined =
                c->row[k].num_joined > joined ? c->row[k].num_joined : joined;
        }
    sink_set(run, "removed,completed,equal,joined", "%d %ld %ld %ld",
             c->removed, completed, equal, joined);
    sink_say(run, "composite",
             "Composite set: %ld vectors from %ld configurations, %s,",
             c->composite, count, choice);
    cli_say(run, "vectors dependent within %g removed on each component.",
            scene->composite_tolerance);
    if (completed > 0)
        cli_say(run,
                "%ld modes are kept in addition, as a cluster is never split.",
                completed);
    if (equal > 0)
        cli_say(run,
                "%ld modes are kept in addition, as their value is that of the "
                "least one above the tolerance.",
                equal);
    warn_of_cuts(run, c);
    if (joined > 0)
        cli_say(run,
                "Damping joins up to %ld flexible modes to others: they are "
                "ranked as one, and kept or left out whole.",
                joined);
    if (ranks_without_loss(first))
        cli_warn(run,
                 "the structural damping of '%s' is left out of its "
                 "ranking",
                 run->operand[0]);
    if (c->removed)
        return;
    cli_warn(run, "stage two removed nothing: every component kept its "
                  "order; choose fewer modes (select: tolerance) or a "
                  "looser composite tolerance");
    cli_say(run, "STAGE TWO REMOVED NOTHING: the reduced components are as "
                 "large as those of stage 1.");
}

static void say_candidate(cli_run *run, int64_t bodies, const ritz_candidate *k)
{
    int worse = k->deviation[1] > k->deviation[0];
    char orders[80];
    char where[RITZ_NAME_SIZE + 32] = "";

    tolerances_orders(run, bodies, k->order, orders);
    if (!isnan(k->deviation[worse]) && k->deviation[worse] > 0.0)
        snprintf(where, sizeof where, "%.4g Hz%s%s", k->hertz[worse],
                 *k->at[worse] ? ", " : "", k->at[worse]);
    sink_say(run,
             ",attached,,dofs,gain_listed,gain_between,singular_value,"
             "smallest_singular_value",
             "%c %-35s %-16s %6ld %9.1e %9.1e %9.1e %9.1e  %s",
             k->chosen ? '>' : ' ', k->name, orders, k->largest, k->gain_listed,
             k->gain_between, k->deviation[0], k->deviation[1], where);
    sink_set(run, "hertz,at,smallest_hertz,smallest_at,forces,chosen",
             "%g %s %g %s %ld %d", k->hertz[0], k->at[0], k->hertz[1], k->at[1],
             k->num_forces, k->chosen);
}

/* Report how the chosen set was found in the pool. */
static void say_search(cli_run *run, const ritz_scene *scene,
                       const ritz_comparison *c, const ritz_candidate *chosen)
{
    const ritz_attached_search *s = &c->search;
    bool fits = ritz_candidate_worst(chosen) <= scene->attached_tolerance;
    int64_t gap = fits ? chosen->num_forces - s->below - 1 : 0;

    gap = gap > 0 ? gap : 0;
    sink_object(run, "attached_search");
    sink_set(run, "pool,tried,none_up_to,gap", "%ld %ld %ld %ld", s->pool,
             s->tried, s->below, gap);
    sink_end(run);
    cli_say(run, "  chosen from %ld forces, no two alike; %ld sets were tried",
            s->pool, s->tried);
    if (s->below > 0)
        cli_say(run,
                "  all sets of up to %ld are among them, and none is near "
                "enough",
                s->below);
    if (gap > 0)
        cli_say(run,
                "  the set with the mark was found by steps: at most %ld of "
                "its %ld forces could be spared",
                gap, chosen->num_forces);
    if (!fits)
        cli_warn(run,
                 "no set of attached dofs brings the largest singular value "
                 "and the smallest within %g: the nearest is %.1e off",
                 scene->attached_tolerance, ritz_candidate_worst(chosen));
}

/* Static corrections, each for a set of forces; there may be none. */
static void say_candidates(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    bool open = scene->attached & RITZ_ATTACHED_AUTO;
    const ritz_candidate *chosen = NULL;

    if (c->num_candidates > 0) {
        cli_say(run, "\nStatic corrections of %s, for these forces",
                c->candidate[0].level == RITZ_AUGMENT_COMPONENT
                    ? "each component, with its rigid modes, once for all "
                      "angles"
                    : "the system");
        cli_say(run, "  %-35s %-16s %6s %9s %9s %9s %9s", "attached", "orders",
                "system", "gain", "gain *", "sigma max", "sigma min");
    }
    SINK_ITEMS(run, "candidates", k, c->num_candidates) {
        say_candidate(run, first->count, &c->candidate[k]);
        if (c->candidate[k].chosen)
            chosen = &c->candidate[k];
    }
    if (!chosen)
        return;
    cli_say(run, "  worst relative errors: of the static gain at listed angles "
                 "and between them (*), of the largest singular");
    cli_say(run, "  value of H(i w) and of the smallest that is not zero, in "
                 "the band at listed angles, and where the worse");
    cli_say(run, "  one is; > is what stage 2 was made with");
    if (open)
        say_search(run, scene, c, chosen);
}

/* Report the vectors that were dropped because they make extraneous modes. */
static void say_compact(cli_run *run, const ritz_stage *first,
                        const ritz_comparison *c)
{
    double tolerance = first->scene->extraneous_tolerance;

    if (first->scene->extraneous != RITZ_EXTRANEOUS_COMPACT)
        return;
    sink_set(run, "dropped,next_drop", "%ld %g", c->dropped, c->next_drop);
    cli_say(run,
            "%ld vectors of components that made extraneous modes are dropped: "
            "errors of kept frequencies",
            c->dropped);
    cli_say(run,
            "and shapes (1 - MAC), of response, static gain and damping grow "
            "by at most %g for it.",
            tolerance);
    if (!isnan(c->next_drop))
        cli_say(run, "For one more they would grow by %.1e.", c->next_drop);
}

/* "clock=60,cone=0" of a row. */
static void name_row(const ritz_stage *stage, const ritz_comparison *c,
                     const ritz_compare_row *row, char out[RITZ_NAME_SIZE])
{
    const ritz_system *system = &c->second_system;

    snprintf(out, RITZ_NAME_SIZE, "as joined");
    if (stage->scene->num_sweeps > 0)
        ritz_configuration_name(system->num_sweeps, (const char *)system->sweep,
                                RITZ_NAME_SIZE, row->setting, out);
}

/* A line of the table of errors; listed configurations are numbered. */
static void say_errors(cli_run *run, const ritz_compare_row *row,
                       int64_t number, const char *at)
{
    char first[24] = "*";
    char chosen[24];
    int64_t kept = row->num_vectors > 0 ? row->num_vectors : row->num_kept;

    if (row->listed)
        snprintf(first, sizeof first, "%ld", number);
    snprintf(chosen, sizeof chosen, row->listed ? "%ld" : "(%ld)", kept);
    sink_set(run, "at,listed,rigid,flexible,dofs,vectors,moments",
             "%s %d %ld %ld %ld %ld %ld", at, row->listed, row->num_rigid,
             row->num_flexible, row->order, row->num_vectors, row->num_moments);
    sink_object(run, "errors");
    sink_say(run,
             ",,,,,,frequency,frequency_allowed,rigid_hz,gain,response,damping",
             "%3s  %-28s %5ld %4ld %4s %5ld %9.1e %9.1e %9.1e %9.1e %9.1e "
             "%9.1e %9.1e",
             first, at, row->num_rigid, row->num_flexible, chosen, row->order,
             row->frequency_error, row->allowed, row->rigid_error,
             row->gain_error, row->response_error, row->damping_error,
             isnan(row->mac) ? row->mac : fmax(1.0 - row->mac, 0.0));
    sink_set(run, "mac,moments", "%g %g", row->mac, row->moment_error);
    sink_end(run);
}

/* Extraneous modes of a row, and all frequencies of its system if it has one
   in the output. */
static ritz_status set_modes(cli_run *run, const ritz_compare_row *row,
                             const ritz_configuration *at)
{
    RITZ_OWN_ARRAY double *hertz = NULL;

    SINK_EACH(run, "extraneous", i, row->num_strays) {
        const ritz_stray *s = &row->stray[i];

        sink_set(run, "mode,hertz,like,mac,removed", "%ld %g %ld %g %d",
                 s->mode + 1, s->hertz, s->like + 1, s->mac, s->removed);
    }
    if (!at)
        return RITZ_OK;
    RITZ_CHECK(model_hertz_at(at, &hertz));
    sink_reals(run, "frequencies_hz", at->K.nrow, hertz);
    return RITZ_OK;
}

static void say_legend(cli_run *run, const ritz_comparison *c)
{
    bool between = c->num_rows > c->first_system.num_configurations;
    int64_t moments = c->row[0].num_moments;
    double worst = nan("");

    for (int64_t k = 0; k < c->num_rows; k++)
        if (c->row[k].listed) {
            worst = fmax(worst, c->row[k].moment_error);
            moments = c->row[k].num_moments < moments ? c->row[k].num_moments
                                                      : moments;
        }
    cli_say(run,
            "  rigid, flex, kept: modes of stage 1%s; order: of the "
            "stage-2 system; frequency of kept modes (and what",
            moments > 0 ? ", kept: Krylov vectors" : "");
    cli_say(run, "  rounding allows it), flexible static gain, response in the "
                 "band, damping ratio: largest relative errors");
    if (between)
        cli_say(run, "  * between listed angles: errors of the modes (so many) "
                     "that would have been kept there");
    if (moments > 0)
        cli_say(run,
                "  the first %ld moments C (K^-1 M)^i K^-1 B are kept, of the "
                "flexible part: worst relative error %.1e",
                moments, worst);
}

static ritz_status say_rows(cli_run *run, const ritz_stage *stage,
                            const ritz_comparison *c)
{
    const ritz_system *system = &c->second_system;
    double worst = 0.0;

    cli_say(run, "%3s  %-28s %5s %4s %4s %5s %9s %9s %9s %9s %9s %9s %9s", "#",
            "configuration", "rigid", "flex", "kept", "order", "frequency",
            "allowed", "rigid Hz", "gain", "response", "damping", "1 - MAC");
    SINK_ITEMS(run, "configurations", k, c->num_rows) {
        const ritz_compare_row *row = &c->row[k];
        char at[RITZ_NAME_SIZE];

        name_row(stage, c, row, at);
        say_errors(run, row, k + 1, at);
        RITZ_CHECK(set_modes(
            run, row,
            k < system->num_configurations ? &system->configuration[k] : NULL));
        worst = fmax(worst, row->response_error);
    }
    SINK_EACH(run, "kept", k, c->num_rows)
        if (c->row[k].listed)
            sink_wholes(run, NULL, c->row[k].num_kept, c->row[k].kept, 1);
    say_legend(run, c);
    cli_record_error(run, "response", worst);
    return RITZ_OK;
}

/* The angle with the worst errors between listed ones, if there is any. */
static void say_suggestion(cli_run *run, const ritz_stage *first,
                           const ritz_comparison *c)
{
    const ritz_suggestion *s = &c->suggestion;
    char at[RITZ_NAME_SIZE];

    if (s->row < 0)
        return;
    name_row(first, c, &c->row[s->row], at);
    sink_object(run, "suggestion");
    sink_set(run, "at,measure,error,listed,worth", "%s %s %g %g %d", at,
             s->measure, s->error, s->listed, s->worth);
    sink_end(run);
    if (s->worth)
        cli_say(run,
                "  add %s: %s error %.1e there, %.1e at listed configurations",
                at, s->measure, s->error, s->listed);
    else
        cli_say(run,
                "  no angle need be added: the worst %s error between listed "
                "ones is %.1e, at %s",
                s->measure, s->error, at);
}

/* Frequencies of one row's, as many as fit a line. */
static void say_stray_row(cli_run *run, const char *at,
                          const ritz_compare_row *row)
{
    enum { WIDTH = 72 };
    char line[WIDTH + 64] = "";
    int64_t shown = 0;

    while (shown < row->num_strays && strlen(line) < WIDTH) {
        const ritz_stray *stray = &row->stray[shown++];

        sink_append(line, sizeof line, " %.5g%s%s", stray->hertz,
                    stray->mac >= 0.9 ? "~" : "", stray->removed ? "x" : "");
    }
    if (shown < row->num_strays)
        cli_say(run, "  %-28s %4ld %s ...", at, row->num_strays, line);
    else
        cli_say(run, "  %-28s %4ld %s", at, row->num_strays, line);
}

static void say_strays(cli_run *run, const ritz_stage *first,
                       const ritz_comparison *c)
{
    int64_t removed = 0, total = 0;

    for (int64_t k = 0; k < c->num_rows; k++)
        for (int64_t i = 0; c->row[k].listed && i < c->row[k].num_strays; i++) {
            removed += c->row[k].stray[i].removed;
            total++;
        }
    sink_set(run, "extraneous_removed", "%ld", removed);
    if (total == 0)
        return;
    cli_say(run, "\nExtraneous modes of the stage-2 system, Hz: those that "
                 "stand for no mode that was kept");
    for (int64_t k = 0; k < c->num_rows; k++) {
        char at[RITZ_NAME_SIZE];

        if (!c->row[k].listed)
            continue;
        name_row(first, c, &c->row[k], at);
        say_stray_row(run, at, &c->row[k]);
    }
    cli_say(run, "  ~ yet has the shape of a mode of stage 1, MAC 0.9 or more; "
                 "x removed from the system that was written");
    if (removed > 0)
        cli_say(run,
                "  %ld of %ld were removed; the components still contain "
                "them%s",
                removed, total,
                first->scene->augment == RITZ_AUGMENT_NONE
                    ? ""
                    : ". What carries the static gain was among them: the "
                      "errors above are without");
}

/*
 * The last table of the report is Table 1 of [LeeTsuha1992]: a column for each
 * reduced component and one for each configuration; a dagger stands at modes of
 * the system that were kept and are those of the first stage.
 */
typedef struct mode_column {
    char title[RITZ_NAME_SIZE];
    int64_t count, rigid; /* of all modes, rigid ones first */
    double *hertz;
    bool *kept; /* of flexible modes */
} mode_column;

static void mode_column_free(mode_column *column)
{
    RITZ_FREE(column->hertz, column->kept);
}

RITZ_ARRAY_OF(mode_column);

/*
 * The stage-2 mode nearest to each kept mode of stage 1 is marked if it is as
 * near as rounding allows: eps lambda_max / lambda_k, times 1000 for the two
 * projections and eigenproblems between them, or 1e-9.
 */
static void mark_kept(const ritz_compare_row *row,
                      const ritz_configuration *first,
                      const ritz_configuration *second, mode_column *out)
{
    double highest = first->lambda[first->K.nrow - 1];

    for (int64_t i = 0; i < row->num_kept; i++) {
        double kept = first->lambda[first->num_rigid + row->kept[i]];
        double best = (double)INFINITY;
        int64_t at = -1;

        for (int64_t k = 0; k < out->count - out->rigid; k++) {
            double apart = fabs(second->lambda[out->rigid + k] - kept) / kept;

            if (apart < best && !out->kept[k]) {
                best = apart;
                at = k;
            }
        }
        if (at >= 0 && best <= fmax(1e-9, 1e3 * DBL_EPSILON * highest / kept))
            out->kept[at] = true;
    }
}

/* Of a component by its number or, behind these, of a configuration. */
static ritz_status find_column(const ritz_comparison *c, int64_t k,
                               mode_column *out)
{
    const ritz_reduced *body = &c->second.body[k];
    int64_t at = k - c->second.count;

    if (at < 0) {
        snprintf(out->title, sizeof out->title, "%s",
                 c->second.scene->component[k].name);
        RITZ_CHECK(model_hertz(&body->K, &body->M, &out->rigid, &out->count,
                               &out->hertz));
    } else {
        const ritz_configuration *system = &c->second_system.configuration[at];

        snprintf(out->title, sizeof out->title, "#%ld", at + 1);
        RITZ_CHECK(model_hertz_at(system, &out->hertz));
        out->rigid = system->num_rigid;
        out->count = system->K.nrow;
    }
    RITZ_CHECK_NEW(out->kept, out->count + 1);
    if (at >= 0)
        mark_kept(&c->row[at], &c->first_system.configuration[at],
                  &c->second_system.configuration[at], out);
    return RITZ_OK;
}

/* Frequencies of the mode-th flexible mode; below 0: the titles. */
static void say_mode_line(cli_run *run, int64_t mode,
                          const mode_column_array *columns)
{
    enum { WIDTH = 13, MOST = 512 };
    char line[MOST] = "";
    size_t used = 0;

    for (int64_t k = 0;
         k < columns->count && strlen(line) + WIDTH + WIDTH < MOST; k++) {
        const mode_column *c = &columns->at[k];

        if (mode < 0)
            sink_append(line, MOST, " %10.10s  ", c->title);
        else if (c->rigid + mode < c->count)
            sink_append(line, MOST, " %10.5f%s", c->hertz[c->rigid + mode],
                        c->kept[mode] ? " \u2020" : "  ");
        else
            sink_append(line, MOST, "%13s", "");
    }
    for (used = strlen(line); used > 0 && line[used - 1] == ' ';)
        line[--used] = '\0';
    if (mode < 0)
        cli_say(run, "%5s%s", "mode", line);
    else
        cli_say(run, "%5ld%s", mode + 1, line);
}

static ritz_status say_modes(cli_run *run, const ritz_comparison *c)
{
    enum { MOST_SYSTEMS = 12 };
    int64_t systems = c->second_system.num_configurations;
    int64_t shown = systems < MOST_SYSTEMS ? systems : MOST_SYSTEMS;
    int64_t longest = 0;
    RITZ_OWN(mode_column_array) columns = {.count = c->second.count + shown};

    RITZ_CHECK_NEW(columns.at, columns.count + 1);
    for (int64_t k = 0; k < columns.count; k++) {
        mode_column *column = &columns.at[k];
        int64_t flexible = 0;

        RITZ_CHECK(find_column(c, k, column));
        flexible = column->count - column->rigid;
        longest = flexible > longest ? flexible : longest;
    }
    cli_say(run, "\nFlexible modes after stage 2, Hz: of each component by "
                 "itself, and of the system at each configuration");
    for (int64_t mode = -1; mode < longest; mode++)
        say_mode_line(run, mode, &columns);
    cli_say(run, "  \u2020 a mode of the stage-1 system that was kept, and is "
                 "there exactly");
    if (shown < systems)
        cli_say(run, "  %ld more configurations are in the output",
                systems - shown);
    return RITZ_OK;
}

static ritz_status say_comparison(cli_run *run, const ritz_stage *first,
                                  const ritz_comparison *c)
{
    const ritz_scene *scene = first->scene;
    char band[64] = "no band";

    if (scene->band_hz[1] > 0.0)
        snprintf(band, sizeof band, "band %g to %g Hz", scene->band_hz[0],
                 scene->band_hz[1]);
    cli_say(run,
            "Two-stage reduction of '%s', %ld configurations, %s "
            "[LeeTsuha1992]\n",
            *scene->name ? scene->name : run->operand[0],
            scene->num_configurations, band);
    say_orders(run, first, &c->second);
    describe_remarks(run, first->scene, first->body);
    cli_say(run, "%s", "");
    say_composite(run, first, c);
    say_compact(run, first, c);
    say_candidates(run, first, c);
    cli_say(run, "\nErrors of the stage-2 system against the stage-1 system");
    RITZ_CHECK(say_rows(run, first, c));
    say_suggestion(run, first, c);
    say_strays(run, first, c);
    return say_modes(run, c);
}

/* After a signal: write the system at the configurations whose errors are
   measured to OUTPUT.interrupted, and fail. Report, tables and components are
   not written. */
static ritz_status keep_done(cli_run *run, const ritz_scene *scene,
                             const ritz_comparison *c)
{
    const int64_t done = c->second_system.num_configurations;
    const int64_t all = scene->num_configurations;
    char what[4 * RITZ_NAME_SIZE];

    if (done < all)
        (void)snprintf(what, sizeof what,
                       "the comparison, at the first %" PRId64 " of %" PRId64
                       " configurations, with modes of the first %" PRId64,
                       done, all, c->num_composed);
    else
        (void)snprintf(
            what, sizeof what,
            "the comparison, at all %" PRId64 " configurations%s", all,
            c->interrupted ? ", without all errors between them" : "");
    RITZ_CHECK(cli_divert(run, what));
    RITZ_CHECK(ritz_container_write_system(run->output, &c->second_system,
                                           cli_stamp(run)));
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "interrupted: the first %" PRId64 " of %" PRId64
                     " configurations are in '%s'",
                     done, all, run->output);
}

/* Write the result, and say it. */
static ritz_status report_result(cli_run *run, const comparison_options *given,
                                 const ritz_stage *stage,
                                 const ritz_comparison *c)
{
    RITZ_CHECK(
        model_write_bodies(run, given->prefix, stage->scene, c->second.body));
    RITZ_CHECK(ritz_container_write_system(run->output, &c->second_system,
                                           cli_stamp(run)));
    RITZ_CHECK(say_comparison(run, stage, c));
    return tracks_report(run, stage, &c->first_system, given->tracks);
}

/* Try the tolerances that are given, and write their table and the report. */
static ritz_status report_tolerances(cli_run *run,
                                     const comparison_options *given,
                                     ritz_stage *stage,
                                     const ritz_comparison *c)
{
    RITZ_OWN(tolerance_rows) rows = {.count = given->num_tolerances};

    if (rows.count > 0) {
        RITZ_CHECK_IN("tolerances",
                      ritz_compare_tolerances(stage, c, rows.count,
                                              given->tolerance, &rows.at));
        tolerances_say(run, stage, &rows);
    }
    if (given->tolerance_table)
        RITZ_CHECK(tolerances_write(given->tolerance_table, stage, &rows));
    return given->report ? cli_table_save(&run->said, given->report) : RITZ_OK;
}

/* A signal that comes while a complete result is written lets it be written to
   its end; then tolerances, if any are to follow, are not tried. */
ritz_status comparison_run(cli_run *run, const comparison_options *given)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_comparison) c = {0};
    const ritz_stop stop = {.asked = cli_stop};

    RITZ_CHECK(model_scene(run, run->operand[0], &scene));
    RITZ_CHECK(model_foresee_bodies(given->prefix, &scene));
    if (given->extraneous)
        RITZ_CHECK_IN("--extraneous",
                      ritz_scene_set_extraneous(&scene, given->extraneous));
    RITZ_CHECK(ritz_stage_new(&scene, &stage));
    RITZ_CHECK(model_foresee(run, &stage));
    cli_interruptible();
    RITZ_CHECK(ritz_compare_until(&stage, &stop, &c));
    if (cli_interrupted())
        return keep_done(run, &scene, &c);
    RITZ_CHECK(report_result(run, given, &stage, &c));
    RITZ_CHECK(axes_say(run, &stage, scene.num_configurations, scene.setting));
    if (cli_uninterruptible() && given->num_tolerances > 0)
        return keep_done(run, &scene, &c);
    return report_tolerances(run, given, &stage, &c);
}
