/*
 * Which forces get static corrections [McDaniel2000, sec. 3.2.2 and 3.3.1].
 * Stage two is built with the static corrections of a set of forces and
 * compared with stage one by its MIMO Bode plot at the listed configurations,
 * which shows the largest singular value of H(i w) over the band and the
 * smallest one that is not zero. The static gain is compared at and between
 * listed configurations.
 *
 * First the sets that have names are tried, and each force alone. Until a set
 * is accurate enough, all pairs follow, all triples, and so on, as long as
 * these are not too many. A larger set is then found by adding, one at a time,
 * the force that reduces the error most. If no force reduces it, the search
 * starts from all forces and leaves out those that are not needed.
 */
#include "compare/compare.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double ritz_candidate_worst(const ritz_candidate *candidate)
{
    return fmax(candidate->deviation[0], candidate->deviation[1]);
}

void ritz_candidate_free(ritz_candidate *candidate)
{
    RITZ_FREE(candidate->force, candidate->order);
    *candidate = (ritz_candidate){0};
}

static ritz_status copy_candidate(const ritz_candidate *from,
                                  int64_t num_bodies, ritz_candidate *out)
{
    RITZ_OWN(ritz_candidate) made = *from;

    made.force = NULL;
    made.order = NULL;
    RITZ_CHECK_COPY(made.force, from->force, from->num_forces);
    RITZ_CHECK_COPY(made.order, from->order, num_bodies);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* A set of forces: ascending indices. */
typedef struct force_set {
    int64_t count;
    int64_t *at;
} force_set;

static void force_set_free(force_set *set)
{
    free(set->at);
}

typedef struct chooser {
    const ritz_rows *rows; /* borrowed, with the responses of stage one */
    const ritz_plan *plan; /* the scene's plan; borrowed */
    force_set own;         /* forces of that plan */
    force_set pool;        /* forces to choose from */
    int64_t tried;
    int64_t room;
    ritz_comparison *out; /* the candidates are appended to it */
} chooser;

/* Sets of forces that have names, in ascending order of size. */
static const int of_system[] = {0, RITZ_ATTACHED_INPUTS,
                                RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS};

static const int of_components[] = {
    0,
    RITZ_ATTACHED_INPUTS,
    RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE | RITZ_ATTACHED_OUTPUTS,
};

/* A name like "inputs, rotor/boom:3": the words of @p sets, then the names of
   forces that belong to none of them. */
static void name_candidate(const ritz_unit_forces *forces, int sets,
                           ritz_candidate *out)
{
    static const char *const words[] = {"inputs", "interface", "outputs",
                                        "dampers"};
    size_t size = sizeof out->name;
    size_t used = 0;

    for (int k = 0; k < 4; k++)
        if (sets & (1 << k))
            used += (size_t)snprintf(out->name + used, size - used, "%s%s",
                                     used ? ", " : "", words[k]);
    for (int64_t k = 0; k < out->num_forces; k++) {
        const ritz_unit_force *force = &forces->each[out->force[k]];

        if (force->sets & sets)
            continue;
        if (used + strlen(force->name) + 8 > size) {
            snprintf(out->name + used, size - used, ", ...");
            return;
        }
        used += (size_t)snprintf(out->name + used, size - used, "%s%s",
                                 used ? ", " : "", force->name);
    }
    if (used == 0)
        snprintf(out->name, size, "nothing");
}

/* Update the worst deviations of the MIMO Bode plot with listed configuration
   k. */
static ritz_status measure_deviation(const chooser *it, int64_t k,
                                     const ritz_configuration *second,
                                     ritz_candidate *out)
{
    const ritz_configuration *first = ritz_rows_first(it->rows, k);
    const ritz_scales scales = {.output = first->io.limit};
    RITZ_OWN(ritz_response) two = {0};
    ritz_bode_gap gap = {0};

    RITZ_CHECK(ritz_compare_follow(it->rows->stage->scene, second,
                                   &it->rows->response[k], &two));
    RITZ_CHECK(ritz_compare_bode(&scales, &it->rows->response[k], &two, &gap));
    for (int i = 0; i < 2; i++)
        if (isnan(out->deviation[i]) || gap.deviation[i] > out->deviation[i]) {
            out->deviation[i] = gap.deviation[i];
            out->hertz[i] = gap.hertz[i];
            memcpy(out->at[i], first->at, sizeof out->at[i]);
        }
    return RITZ_OK;
}

/* Errors at listed configurations; stops after the first one at which a
   deviation exceeds @p enough. */
static ritz_status measure_listed(const chooser *it,
                                  const ritz_comparison *trial, double enough,
                                  bool gain, ritz_candidate *out)
{
    for (int64_t k = 0; k < it->rows->listed->num_configurations; k++) {
        RITZ_OWN(ritz_configuration) second = {0};
        double error = nan("");

        if (ritz_candidate_worst(out) > enough)
            break;
        RITZ_CHECK(ritz_stage_assemble(&trial->second, it->rows->row[k].setting,
                                       &second));
        if (second.K.ncol > out->largest)
            out->largest = second.K.ncol;
        if (gain)
            RITZ_CHECK(ritz_compare_gain(ritz_rows_first(it->rows, k), &second,
                                         &error));
        out->gain_listed = fmax(out->gain_listed, error);
        if (it->rows->response)
            RITZ_CHECK(measure_deviation(it, k, &second, out));
    }
    return RITZ_OK;
}

/* Static gain error between listed configurations. */
static ritz_status measure_between(const chooser *it,
                                   const ritz_comparison *trial,
                                   ritz_candidate *out)
{
    for (int64_t k = it->rows->listed->num_configurations;
         k < it->rows->num_rows; k++) {
        RITZ_OWN(ritz_configuration) second = {0};
        double error = nan("");

        RITZ_CHECK(ritz_stage_assemble(&trial->second, it->rows->row[k].setting,
                                       &second));
        RITZ_CHECK(
            ritz_compare_gain(ritz_rows_first(it->rows, k), &second, &error));
        out->gain_between = fmax(out->gain_between, error);
    }
    return RITZ_OK;
}

/* Build stage two with a set of forces and measure it. Measuring stops once a
   deviation exceeds @p enough. Gain errors are measured only for sets that are
   reported. */
static ritz_status try_set(chooser *it, const force_set *set, double enough,
                           bool shown, ritz_candidate *out)
{
    const ritz_scene *scene = it->rows->stage->scene;
    const bool gain = shown && scene->num_inputs > 0 && scene->num_outputs > 0;
    ritz_plan plan = *it->plan;
    RITZ_OWN(ritz_subspaces) subspaces = {0};
    RITZ_OWN(ritz_comparison) trial = {0};
    RITZ_OWN(ritz_candidate)
    made = {.level = plan.augment, .num_forces = set->count};

    made.gain_listed = made.gain_between = nan("");
    made.deviation[0] = made.deviation[1] = nan("");
    RITZ_CHECK_COPY(made.force, set->at, set->count);
    plan.count = made.num_forces;
    plan.force = made.force;
    RITZ_CHECK_IN("composite modes",
                  ritz_compare_composite(it->rows, &plan, &subspaces));
    RITZ_CHECK_IN("stage 2",
                  ritz_compare_project(it->rows->stage, &subspaces, &trial));
    RITZ_CHECK(ritz_compare_orders(&trial, &made.order, &made.total));
    RITZ_CHECK(measure_listed(it, &trial, enough, gain, &made));
    if (gain)
        RITZ_CHECK(measure_between(it, &trial, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* Try a set of forces and add it to the candidates that are reported. */
static ritz_status show_set(chooser *it, const force_set *set, int sets)
{
    ritz_comparison *out = it->out;
    RITZ_OWN(ritz_candidate) made = {0};

    made.num_forces = set->count;
    RITZ_CHECK_ROOM(out->candidate, out->num_candidates, it->room);
    RITZ_CHECK(try_set(it, set, HUGE_VAL, true, &made));
    name_candidate(it->plan->forces, sets, &made);
    RITZ_MOVE(out->candidate[out->num_candidates++], made);
    return RITZ_OK;
}

/*
 * Whether set b is better than set a: it is if only b is accurate enough; if
 * both are, the one with fewer coordinates of all bodies is better, then the
 * one with fewer forces; if neither is, the more accurate one. Differences
 * within rounding do not count.
 */
static bool is_better(const ritz_scene *scene, const ritz_candidate *b,
                      const ritz_candidate *a)
{
    double near[2] = {ritz_candidate_worst(a), ritz_candidate_worst(b)};
    bool a_fits = near[0] <= scene->attached_tolerance;
    bool b_fits = near[1] <= scene->attached_tolerance;

    if (a_fits != b_fits)
        return b_fits;
    if (b_fits && a->total != b->total)
        return b->total < a->total;
    if (b_fits && a->num_forces != b->num_forces)
        return b->num_forces < a->num_forces;
    return near[1] < RITZ_NO_NEARER * near[0];
}

static bool fits(const chooser *it, const ritz_candidate *candidate)
{
    return ritz_candidate_worst(candidate) <=
           it->rows->stage->scene->attached_tolerance;
}

/* Try a set, and store it in @p best if it is better. */
static ritz_status try_better(chooser *it, const force_set *set,
                              ritz_candidate *best)
{
    const ritz_scene *scene = it->rows->stage->scene;
    double enough = best->force ? fmax(ritz_candidate_worst(best),
                                       scene->attached_tolerance)
                                : HUGE_VAL;
    RITZ_OWN(ritz_candidate) made = {0};

    RITZ_CHECK(try_set(it, set, enough, false, &made));
    it->tried++;
    ritz_monitor_step("sets of attached dofs", it->tried, 0);
    if (!best->force || is_better(scene, &made, best)) {
        ritz_candidate_free(best);
        RITZ_MOVE(*best, made);
    }
    return RITZ_OK;
}

/* Try all sets of @p size forces of the pool. */
static ritz_status try_size(chooser *it, int64_t size, ritz_candidate *best)
{
    RITZ_OWN(force_set) set = {.count = size};
    RITZ_OWN_ARRAY int64_t *place = NULL;

    RITZ_CHECK_NEW(set.at, size);
    RITZ_CHECK_NEW(place, size);
    for (int64_t k = 0; k < size; k++)
        place[k] = k;
    do {
        for (int64_t k = 0; k < size; k++)
            set.at[k] = it->pool.at[place[k]];
        RITZ_CHECK(try_better(it, &set, best));
    } while (ritz_next_choice(it->pool.count, size, place));
    return RITZ_OK;
}

/* Whether the number of sets of @p size forces is small enough to try them
   all. */
static bool is_small(const chooser *it, int64_t size)
{
    enum { MOST_SETS = 1000 };
    const double most_work = 2e10; /* largest sum of the cubes of the systems'
                                      orders: some minutes of work */
    double sets = 1.0, work = 0.0;

    for (int64_t k = 0; k < size; k++)
        sets *= (double)(it->pool.count - k) / (double)(k + 1);
    for (int64_t k = 0; k < it->rows->listed->num_configurations; k++)
        work += pow((double)ritz_rows_first(it->rows, k)->K.ncol, 3.0);
    sets += (double)it->tried;
    return sets <= MOST_SETS && sets * work <= most_work;
}

static bool holds(const ritz_candidate *set, int64_t force)
{
    for (int64_t k = 0; k < set->num_forces; k++)
        if (set->force[k] == force)
            return true;
    return false;
}

/* The best set that consists of @p with and one more force of the pool. */
static ritz_status try_one_more(chooser *it, const ritz_candidate *with,
                                ritz_candidate *best)
{
    RITZ_OWN(force_set) set = {.count = with->num_forces + 1};

    RITZ_CHECK_NEW(set.at, set.count);
    for (int64_t k = 0; k < it->pool.count; k++) {
        if (holds(with, it->pool.at[k]))
            continue;
        memcpy(set.at, with->force, (size_t)with->num_forces * sizeof *set.at);
        set.at[set.count - 1] = it->pool.at[k];
        qsort(set.at, (size_t)set.count, sizeof *set.at, ritz_ascending_index);
        RITZ_CHECK(try_better(it, &set, best));
    }
    return RITZ_OK;
}

/* Add forces one by one, each time the one that reduces the error most, until
   the set is accurate enough or no force reduces it. */
static ritz_status add_forces(chooser *it, ritz_candidate *set)
{
    while (!fits(it, set) && set->num_forces < it->pool.count) {
        RITZ_OWN(ritz_candidate) more = {0};

        RITZ_CHECK(try_one_more(it, set, &more));
        if (!(ritz_candidate_worst(&more) <
              RITZ_NO_NEARER * ritz_candidate_worst(set)))
            return RITZ_OK;
        ritz_candidate_free(set);
        RITZ_MOVE(*set, more);
    }
    return RITZ_OK;
}

/* Remove forces from a set that is accurate enough, as long as it stays so. */
static ritz_status leave_out_forces(chooser *it, ritz_candidate *set)
{
    for (int64_t k = set->num_forces - 1; k >= 0; k--) {
        RITZ_OWN(force_set) less = {.count = set->num_forces - 1};
        RITZ_OWN(ritz_candidate) made = {0};

        RITZ_CHECK_NEW(less.at, less.count);
        for (int64_t i = 0, j = 0; i < set->num_forces; i++)
            if (i != k)
                less.at[j++] = set->force[i];
        RITZ_CHECK(try_set(it, &less,
                           it->rows->stage->scene->attached_tolerance, false,
                           &made));
        it->tried++;
        if (!fits(it, &made))
            continue;
        ritz_candidate_free(set);
        RITZ_MOVE(*set, made);
    }
    return RITZ_OK;
}

/* Search among sets that are too many to be tried one by one. */
static ritz_status seek_further(chooser *it, ritz_candidate *set)
{
    RITZ_CHECK(add_forces(it, set));
    if (!fits(it, set)) {
        RITZ_OWN(ritz_candidate) all = {0};

        RITZ_CHECK(try_better(it, &it->pool, &all));
        if (!is_better(it->rows->stage->scene, &all, set))
            return RITZ_OK;
        ritz_candidate_free(set);
        RITZ_MOVE(*set, all);
    }
    return fits(it, set) ? leave_out_forces(it, set) : RITZ_OK;
}

static ritz_status show_candidate(chooser *it, const ritz_candidate *set)
{
    const force_set as = {set->num_forces, set->force};

    return show_set(it, &as, 0);
}

/* The best of the single forces, which are the last candidates. */
static ritz_status find_single(chooser *it, ritz_candidate *best)
{
    const ritz_comparison *out = it->out;
    const ritz_candidate *one =
        &out->candidate[out->num_candidates - it->pool.count];
    int64_t at = 0;

    for (int64_t k = 1; k < it->pool.count; k++)
        if (is_better(it->rows->stage->scene, &one[k], &one[at]))
            at = k;
    it->tried += it->pool.count;
    return copy_candidate(&one[at], it->rows->stage->count, best);
}

/* Try sets of the pool of increasing size until one is accurate enough. */
static ritz_status seek_sets(chooser *it)
{
    ritz_attached_search *search = &it->out->search;
    RITZ_OWN(ritz_candidate) best = {0};

    RITZ_CHECK(find_single(it, &best));
    while (!fits(it, &best)) {
        RITZ_OWN(ritz_candidate) found = {0};

        search->below = best.num_forces;
        if (search->below == it->pool.count || !is_small(it, search->below + 1))
            break;
        RITZ_CHECK(try_size(it, search->below + 1, &found));
        ritz_candidate_free(&best);
        RITZ_MOVE(best, found);
        RITZ_CHECK(show_candidate(it, &best));
    }
    if (!fits(it, &best) && search->below < it->pool.count) {
        RITZ_CHECK(seek_further(it, &best));
        if (best.num_forces > search->below)
            RITZ_CHECK(show_candidate(it, &best));
    }
    search->tried = it->tried;
    return RITZ_OK;
}

/*
 * The effect of each force as a column whose length is meaningful: with
 * component augmentation, forces on bodies relieved by the inertia of rigid
 * motion, scaled by mass; with system augmentation, forces on flexible modes of
 * all listed configurations, scaled by stiffness.
 */
static ritz_status measure_forces(const chooser *it, const force_set *from,
                                  ritz_dense *out)
{
    const ritz_rows *rows = it->rows;
    const ritz_stage *stage = rows->stage;
    const bool own = it->plan->augment == RITZ_AUGMENT_COMPONENT;
    ritz_plan plan = *it->plan;
    RITZ_OWN(ritz_dense) made = {0};
    int64_t rows_of_all = own ? stage->num_coordinates : 0, used = 0;

    plan.count = from->count;
    plan.force = from->at;
    for (int64_t k = 0; !own && k < rows->listed->num_configurations; k++)
        rows_of_all += ritz_rows_first(rows, k)->K.ncol;
    RITZ_CHECK(ritz_dense_new(rows_of_all, from->count, &made));
    for (int64_t k = 0; own && k < stage->count; k++) {
        RITZ_OWN(ritz_dense) F = {0};

        RITZ_CHECK(ritz_plan_body(stage, k, &plan, &F));
        RITZ_CHECK(ritz_body_relieve(stage, k, &F));
        ritz_dense_put(&F, stage->first[k], 0, &made);
    }
    for (int64_t k = 0; !own && k < rows->listed->num_configurations; k++) {
        const ritz_configuration *c = ritz_rows_first(rows, k);
        RITZ_OWN(ritz_dense) B = {0};

        RITZ_CHECK(ritz_plan_system(stage, c, &plan, &B));
        for (int64_t j = 0; j < B.ncol; j++)
            for (int64_t i = c->num_rigid; i < c->K.ncol; i++)
                ritz_dense_col(&made, j)[used + i] =
                    ritz_dense_col(&B, j)[i] / sqrt(c->lambda[i]);
        used += c->K.ncol;
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* Whether two unit vectors are parallel. */
static bool is_alike(int64_t n, const double *y, const double *x)
{
    double along = 0.0, rest = 0.0;

    for (int64_t i = 0; i < n; i++)
        along += y[i] * x[i];
    for (int64_t i = 0; i < n; i++)
        rest = hypot(rest, x[i] - along * y[i]);
    return rest <= RITZ_SAME_FORCE;
}

/* The pool: forces that deform the structure; of forces with the same effect
   only the first. */
static ritz_status fill_pool(chooser *it, const force_set *from)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK_NEW(it->pool.at, from->count);
    RITZ_CHECK(measure_forces(it, from, &X));
    for (int64_t k = 0; k < from->count; k++) {
        double *x = ritz_dense_col(&X, k);
        bool new = ritz_general_unit(X.nrow, x);

        for (int64_t j = 0; j < it->pool.count && new; j++)
            new = !is_alike(X.nrow, ritz_dense_col(&X, j), x);
        if (!new)
            continue;
        memmove(ritz_dense_col(&X, it->pool.count), x,
                (size_t)X.nrow * sizeof *x);
        it->pool.at[it->pool.count++] = from->at[k];
    }
    return RITZ_OK;
}

/* Try the named sets and, if there are dampers, each of them once more with the
   dampers. The scene's own set is tried as well unless it is one of these;
   *requested is its index, or -1 if the scene leaves the choice open. */
static ritz_status try_named(chooser *it, int64_t *requested)
{
    const ritz_stage *stage = it->rows->stage;
    const ritz_plan *plan = it->plan;
    const bool system = plan->augment == RITZ_AUGMENT_SYSTEM;
    const bool open = stage->scene->attached & RITZ_ATTACHED_AUTO;
    const int *of = system ? of_system : of_components;
    const int64_t alone =
        (int64_t)(system ? sizeof of_system : sizeof of_components) /
        (int64_t)sizeof *of;
    const int64_t count = ritz_stage_is_damped(stage) ? 2 * alone : alone;
    const force_set own = {plan->count, it->own.at};

    *requested = -1;
    for (int64_t k = 0; k < count; k++) {
        const int sets =
            of[k % alone] | (k < alone ? 0 : RITZ_ATTACHED_DAMPERS);
        RITZ_OWN(force_set) set = {0};

        ritz_monitor_step("attached dofs", k, count);
        RITZ_CHECK(ritz_unit_forces_select(plan->forces, sets, false,
                                           &set.count, &set.at));
        RITZ_CHECK(show_set(it, &set, sets));
        if (sets == plan->sets && set.count == plan->count)
            *requested = k;
    }
    if (open || *requested >= 0)
        return RITZ_OK;
    *requested = count;
    return show_set(it, &own, plan->sets);
}

/* Search for a set, and return the index of the best of all candidates. */
static ritz_status try_open(chooser *it, int64_t *chosen)
{
    const ritz_scene *scene = it->rows->stage->scene;
    ritz_comparison *out = it->out;
    RITZ_OWN(force_set) all = {0};

    RITZ_CHECK(ritz_unit_forces_select(it->plan->forces, scene->attached, true,
                                       &all.count, &all.at));
    RITZ_CHECK(fill_pool(it, &all));
    out->search.pool = it->pool.count;
    for (int64_t k = 0; k < it->pool.count; k++) {
        ritz_monitor_step("attached dofs", k, it->pool.count);
        RITZ_CHECK(show_set(it, &(force_set){1, &it->pool.at[k]}, 0));
    }
    if (!fits(it, &out->candidate[0]) && it->pool.count > 0)
        RITZ_CHECK(seek_sets(it)); /* candidate 0 attaches no force */
    *chosen = 0;
    for (int64_t k = 1; k < out->num_candidates; k++)
        if (is_better(scene, &out->candidate[k], &out->candidate[*chosen]))
            *chosen = k;
    return RITZ_OK;
}

static void chooser_free(chooser *it)
{
    force_set_free(&it->own);
    force_set_free(&it->pool);
}

ritz_status ritz_attached_choose(ritz_rows *rows, ritz_plan *plan,
                                 ritz_comparison *out, int64_t **force)
{
    const ritz_scene *scene = rows->stage->scene;
    bool open = scene->attached & RITZ_ATTACHED_AUTO;
    RITZ_OWN(chooser) it = {.rows = rows, .plan = plan, .out = out};
    int64_t chosen = 0;

    if (plan->augment != RITZ_AUGMENT_COMPONENT && !open)
        return RITZ_OK;
    RITZ_REFUSE_IF(open && !ritz_compare_responds(scene), RITZ_ERR_ARGUMENT,
                   "they are chosen by frequency responses, which need inputs, "
                   "outputs, a band and a damping of the scene");
    RITZ_CHECK(ritz_rows_respond(rows));
    it.own.count = plan->count;
    RITZ_CHECK_COPY(it.own.at, plan->force, plan->count);
    RITZ_CHECK(try_named(&it, &chosen));
    if (open)
        RITZ_CHECK(try_open(&it, &chosen));
    out->candidate[chosen].chosen = true;
    RITZ_CHECK_COPY(*force, out->candidate[chosen].force,
                    out->candidate[chosen].num_forces);
    plan->count = out->candidate[chosen].num_forces;
    plan->force = *force;
    return RITZ_OK;
}
