/*
 * The c and k of some dampers that minimise the H2 norm, by sequential
 * quadratic programming within bounds [Kraft1994] (NLopt's SLSQP), as in
 * [ChuMilman1992], started at a few of the best points of a coarse grid.
 *
 * Variables x run from 0 to 1 over each range: k linearly, c as
 *
 *     c = c_0 + (c_1 - c_0) (exp(a x) - 1) / (exp(a) - 1),   exp(a) = 1000
 *
 * because a good c is not known to within a factor of ten, and 0 may be in the
 * range.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/h2.h"
#include "poles/poles.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

/* A variable of the search: c or k of a group. */
typedef struct variable {
    int64_t group;
    bool of_k;
} variable;

typedef struct tuner {
    const ritz_tuning_search *search;
    ritz_plant *plant;
    int64_t count; /* number of variables */
    variable *variable;
    ritz_variance variance;
    double unit; /* NLopt minimises the norm divided by this */
    ritz_status status;
    int64_t evaluations;
    double *here;         /* the variables at which the norm is evaluated */
    double found;         /* least norm of the present search */
    double best, *best_x; /* least norm of all searches, and its variables */
    double slope;         /* relative slope at best_x */
} tuner;

static void tuner_free(tuner *t)
{
    RITZ_FREE(t->variable, t->variance.by_c, t->variance.by_k, t->here,
              t->best_x);
}

static bool varies(const double range[2])
{
    return range[1] > range[0];
}

static const double *range_of(const tuner *t, int64_t i)
{
    const ritz_tuned *tuned = &t->search->tuned[t->variable[i].group];

    return t->variable[i].of_k ? tuned->k : tuned->c;
}

/* Value of c or k for a variable x, and its derivative by x. */
static double value_at(const tuner *t, int64_t i, double x, double *slope)
{
    const double *range = range_of(t, i);
    double width = range[1] - range[0];

    *slope = t->variable[i].of_k
                 ? width
                 : width * RITZ_TUNED_DECADES * exp(RITZ_TUNED_DECADES * x) /
                       expm1(RITZ_TUNED_DECADES);
    if (x >= 1.0)
        return range[1]; /* exactly, without the rounding of exp */
    return range[0] + (t->variable[i].of_k
                           ? width * x
                           : width * expm1(RITZ_TUNED_DECADES * x) /
                                 expm1(RITZ_TUNED_DECADES));
}

static double place_of(const tuner *t, int64_t i, double value)
{
    const double *range = range_of(t, i);
    double part = (value - range[0]) / (range[1] - range[0]);

    part = fmin(fmax(part, 0.0), 1.0);
    return t->variable[i].of_k
               ? part
               : log1p(part * expm1(RITZ_TUNED_DECADES)) / RITZ_TUNED_DECADES;
}

static void set_group(const ritz_tuned *tuned, bool of_k, double value,
                      ritz_dampers *dampers)
{
    double *values = of_k ? dampers->k : dampers->c;

    for (int64_t j = 0; j < tuned->count; j++)
        values[tuned->damper[j]] = value;
}

/* Set the values that do not vary; with NaN each damper keeps its own value. */
static void set_fixed(const ritz_tuning_search *search, ritz_dampers *dampers)
{
    for (int64_t g = 0; g < search->count; g++) {
        const ritz_tuned *tuned = &search->tuned[g];

        if (!isnan(tuned->c[0]))
            set_group(tuned, false, tuned->c[0], dampers);
        if (!isnan(tuned->k[0]))
            set_group(tuned, true, tuned->k[0], dampers);
    }
}

static void set_variables(const tuner *t, const double *x)
{
    double slope = 0.0;

    for (int64_t i = 0; i < t->count; i++)
        set_group(&t->search->tuned[t->variable[i].group], t->variable[i].of_k,
                  value_at(t, i, x[i], &slope), &t->plant->dampers);
}

/* d norm / dx, from d norm^2 / dc = 2 norm d norm / dc. */
static void fill_gradient(const tuner *t, const double *x, double norm,
                          double *gradient)
{
    for (int64_t i = 0; i < t->count; i++) {
        const ritz_tuned *tuned = &t->search->tuned[t->variable[i].group];
        const double *by =
            t->variable[i].of_k ? t->variance.by_k : t->variance.by_c;
        double slope = 0.0, sum = 0.0;

        (void)value_at(t, i, x[i], &slope);
        for (int64_t j = 0; j < tuned->count; j++)
            sum += by[tuned->damper[j]];
        gradient[i] = 0.5 * sum * slope / norm;
    }
}

/* Largest component of a gradient that does not lead out of the bounds,
   relative to the norm. */
static double slope_of(const tuner *t, const double *x, double norm,
                       const double *gradient)
{
    double most = 0.0;

    for (int64_t i = 0; i < t->count; i++) {
        bool outward = (x[i] <= 0.0 && gradient[i] > 0.0) ||
                       (x[i] >= 1.0 && gradient[i] < 0.0);

        if (!outward)
            most = fmax(most, fabs(gradient[i]) / norm);
    }
    return most;
}

/* Move x onto the end of its range if it differs by rounding. */
static double settle_place(double x)
{
    if (x < RITZ_TUNED_PLACE)
        return 0.0;
    return x > 1.0 - RITZ_TUNED_PLACE ? 1.0 : x;
}

/* Norm and gradient at `place`, and the best so far; HUGE_VAL if the norm is
   infinite. */
static ritz_status measure_at(tuner *t, const double *place, double *gradient,
                              double *norm)
{
    double *x = t->here;

    for (int64_t i = 0; i < t->count; i++)
        x[i] = settle_place(place[i]);
    set_variables(t, x);
    t->evaluations++;
    RITZ_CHECK(ritz_variance_of(t->plant, &t->variance));
    *norm = sqrt(t->variance.square);
    for (int64_t i = 0; i < t->count; i++)
        gradient[i] = 0.0;
    if (!t->variance.finite)
        return RITZ_OK;
    if (*norm > 0.0)
        fill_gradient(t, x, *norm, gradient);
    t->found = fmin(t->found, *norm);
    if (*norm < t->best) {
        t->best = *norm;
        t->slope = *norm > 0.0 ? slope_of(t, x, *norm, gradient) : 0.0;
        memcpy(t->best_x, x, (size_t)t->count * sizeof *x);
    }
    return RITZ_OK;
}

/* What NLopt passes to objective_at. */
typedef struct objective {
    tuner *t;
    nlopt_opt engine;
    double *gradient;
} objective;

static void objective_free(objective *o)
{
    nlopt_destroy(o->engine);
    free(o->gradient);
}

static double objective_at(unsigned n, const double *x, double *gradient,
                           void *data)
{
    objective *o = data;
    double norm = HUGE_VAL;

    o->t->status = measure_at(o->t, x, o->gradient, &norm);
    if (o->t->status != RITZ_OK) {
        (void)nlopt_force_stop(o->engine);
        return HUGE_VAL;
    }
    for (unsigned i = 0; gradient && i < n; i++)
        gradient[i] = o->gradient[i] / o->t->unit;
    return norm / o->t->unit;
}

/*
 * One search from @p start. Apart from missing memory, the way in which NLopt
 * ends does not matter: measure_at keeps the least norm found, and its slope.
 */
static ritz_status search_from(tuner *t, const double *start)
{
    RITZ_OWN(objective)
    o = {.t = t, .engine = nlopt_create(NLOPT_LD_SLSQP, (unsigned)t->count)};
    RITZ_OWN_ARRAY double *x = NULL;
    double value = 0.0;
    nlopt_result end = NLOPT_OUT_OF_MEMORY;

    RITZ_REFUSE_IF(!o.engine, RITZ_ERR_MEMORY,
                   "there is no memory for a search of %" PRId64 " variables",
                   t->count);
    RITZ_CHECK_NEW(o.gradient, t->count);
    RITZ_CHECK_COPY(x, start, t->count);
    t->found = HUGE_VAL;
    if (nlopt_set_min_objective(o.engine, objective_at, &o) > 0 &&
        nlopt_set_lower_bounds1(o.engine, 0.0) > 0 &&
        nlopt_set_upper_bounds1(o.engine, 1.0) > 0 &&
        nlopt_set_ftol_rel(o.engine, RITZ_TUNED_NORM) > 0 &&
        nlopt_set_xtol_abs1(o.engine, RITZ_TUNED_PLACE) > 0 &&
        nlopt_set_maxeval(o.engine, (int)t->search->most) > 0)
        end = nlopt_optimize(o.engine, x, &value);
    RITZ_CHECK(t->status);
    RITZ_REFUSE_IF(end == NLOPT_OUT_OF_MEMORY, RITZ_ERR_MEMORY,
                   "there is no memory for a search of %" PRId64 " variables",
                   t->count);
    return RITZ_OK;
}

/* --- Starts --------------------------------------------------------------- */

/* Grid of starts: the same x for all c, and the same x for all k. */
enum { GRID_C = 9, GRID_K = 3, GRID = GRID_C * GRID_K };

static const double grid_c[GRID_C] = {0.1, 0.2, 0.3, 0.4, 0.5,
                                      0.6, 0.7, 0.8, 0.9};
static const double grid_k[GRID_K] = {0.25, 0.5, 0.75};

typedef struct grid_point {
    double norm, c, k;
} grid_point;

static int compare_points(const void *left, const void *right)
{
    const grid_point *a = left, *b = right;

    return (a->norm > b->norm) - (a->norm < b->norm);
}

static void fill_start(const tuner *t, const grid_point *point, double *x)
{
    for (int64_t i = 0; i < t->count; i++)
        x[i] = t->variable[i].of_k ? point->k : point->c;
}

static bool has_variable(const tuner *t, bool of_k)
{
    for (int64_t i = 0; i < t->count; i++)
        if (t->variable[i].of_k == of_k)
            return true;
    return false;
}

/* Norms at all points of the grid, in ascending order. */
static ritz_status survey_grid(tuner *t, grid_point point[GRID], int64_t *count)
{
    RITZ_OWN_ARRAY double *x = NULL, *gradient = NULL;
    int num_c = has_variable(t, false) ? GRID_C : 1;
    int num_k = has_variable(t, true) ? GRID_K : 1;

    RITZ_CHECK_NEW(x, t->count);
    RITZ_CHECK_NEW(gradient, t->count);
    *count = 0;
    for (int i = 0; i < num_c; i++)
        for (int j = 0; j < num_k; j++) {
            grid_point *p = &point[(*count)++];

            p->c = grid_c[i];
            p->k = grid_k[j];
            fill_start(t, p, x);
            RITZ_CHECK(measure_at(t, x, gradient, &p->norm));
        }
    qsort(point, (size_t)*count, sizeof *point, compare_points);
    return RITZ_OK;
}

/* Whether two starts are so close in x that they lead to the same minimum. */
static bool is_near(const grid_point *a, const grid_point *b)
{
    return fabs(a->c - b->c) < RITZ_TUNED_STARTS &&
           fabs(a->k - b->k) < RITZ_TUNED_STARTS;
}

/* Keep the best points of the grid that are not close to better ones. */
static int64_t choose_starts(int64_t count, grid_point *point, int64_t most)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < count && kept < most; j++) {
        bool near = !isfinite(point[j].norm);

        for (int64_t i = 0; i < kept && !near; i++)
            near = is_near(&point[i], &point[j]);
        if (!near)
            point[kept++] = point[j];
    }
    return kept;
}

/* Run one search, and append the norm that it found. */
static ritz_status run_search(tuner *t, const double *start, double *found,
                              ritz_tuning *out)
{
    RITZ_CHECK(search_from(t, start));
    found[out->starts++] = t->found;
    ritz_monitor_step("tuning", t->evaluations, 0);
    return RITZ_OK;
}

static ritz_status run_searches(tuner *t, ritz_tuning *out)
{
    const ritz_tuning_search *search = t->search;
    grid_point point[GRID] = {0};
    int64_t count = 0;
    RITZ_OWN_ARRAY double *x = NULL, *found = NULL;

    RITZ_CHECK_NEW(x, t->count);
    RITZ_CHECK_NEW(found, search->starts + 1);
    RITZ_CHECK(survey_grid(t, point, &count));
    t->unit =
        isfinite(point[0].norm) && point[0].norm > 0.0 ? point[0].norm : 1.0;
    count = choose_starts(count, point, search->starts);
    for (int64_t s = 0; s < count; s++) {
        fill_start(t, &point[s], x);
        RITZ_CHECK(run_search(t, x, found, out));
    }
    for (int64_t i = 0; search->c && i < t->count; i++) {
        const double *from = t->variable[i].of_k ? search->k : search->c;

        x[i] = place_of(t, i, from[t->variable[i].group]);
    }
    if (search->c)
        RITZ_CHECK(run_search(t, x, found, out));
    for (int64_t s = 0; s < out->starts; s++)
        out->agreed += found[s] <= t->best * (1.0 + RITZ_TUNED_SAME);
    return RITZ_OK;
}

/* --- A plant -------------------------------------------------------------- */

static ritz_status tuner_new(ritz_plant *plant,
                             const ritz_tuning_search *search, tuner *t)
{
    t->plant = plant;
    t->search = search;
    t->best = t->found = HUGE_VAL;
    t->unit = 1.0;
    RITZ_CHECK_NEW(t->variable, 2 * search->count);
    for (int64_t g = 0; g < search->count; g++)
        for (int of_k = 0; of_k < 2; of_k++)
            if (varies(of_k ? search->tuned[g].k : search->tuned[g].c))
                t->variable[t->count++] = (variable){g, of_k};
    RITZ_CHECK_NEW(t->here, t->count);
    RITZ_CHECK_NEW(t->best_x, t->count);
    RITZ_CHECK_NEW(t->variance.by_c, plant->dampers.count);
    RITZ_CHECK_NEW(t->variance.by_k, plant->dampers.count);
    return RITZ_OK;
}

/* Values of each group, by its first damper; NaN: each damper has its own
   value. */
static void read_values(const ritz_tuning_search *search,
                        const ritz_dampers *dampers, ritz_tuning *out)
{
    for (int64_t g = 0; g < search->count; g++) {
        const ritz_tuned *tuned = &search->tuned[g];

        out->c[g] =
            isnan(tuned->c[0]) ? tuned->c[0] : dampers->c[tuned->damper[0]];
        out->k[g] =
            isnan(tuned->k[0]) ? tuned->k[0] : dampers->k[tuned->damper[0]];
    }
}

ritz_status ritz_tune_plant(ritz_plant *plant, const ritz_tuning_search *search,
                            ritz_tuning *out)
{
    RITZ_OWN(tuner) t = {0};
    RITZ_OWN(ritz_tuning) tuning = {.count = search->count};

    RITZ_CHECK_NEW(tuning.c, search->count);
    RITZ_CHECK_NEW(tuning.k, search->count);
    RITZ_CHECK(tuner_new(plant, search, &t));
    set_fixed(search, &plant->dampers);
    RITZ_CHECK(run_searches(&t, &tuning));
    set_variables(&t, t.best_x);
    read_values(search, &plant->dampers, &tuning);
    tuning.norm = tuning.tuned = t.best;
    tuning.slope = t.slope;
    tuning.evaluations = t.evaluations;
    RITZ_MOVE(*out, tuning);
    return RITZ_OK;
}

void ritz_tuning_free(ritz_tuning *tuning)
{
    RITZ_FREE(tuning->c, tuning->k);
    *tuning = (ritz_tuning){0};
}

/* --- A model -------------------------------------------------------------- */

enum { FIRST_MODES = 20, WHOLE_DOFS = 50, MOST_ROUNDS = 5 };
enum { STARTS = 3, MOST_EVALUATIONS = 300 };

static const ritz_dampers *dampers_of(ritz_model model)
{
    return model.kind == RITZ_MODEL_COMPONENT ? &model.component->dampers
                                              : model.dampers;
}

static ritz_status check_range(const ritz_tuned *tuned, const char *name)
{
    bool keeps_c = isnan(tuned->c[0]) && isnan(tuned->c[1]);
    bool keeps_k = isnan(tuned->k[0]) && isnan(tuned->k[1]);

    RITZ_REFUSE_IF(!keeps_c && (!(tuned->c[0] >= 0.0) ||
                                !(tuned->c[1] >= tuned->c[0]) ||
                                !isfinite(tuned->c[1])),
                   RITZ_ERR_ARGUMENT,
                   "c of damper '%s' cannot be from %g to %g: it is not "
                   "negative, and the larger end comes last",
                   name, tuned->c[0], tuned->c[1]);
    RITZ_REFUSE_IF(!keeps_k &&
                       (!(tuned->k[1] >= tuned->k[0]) ||
                        !isfinite(tuned->k[0]) || !isfinite(tuned->k[1])),
                   RITZ_ERR_ARGUMENT,
                   "k of damper '%s' cannot be from %g to %g: the larger end "
                   "comes last",
                   name, tuned->k[0], tuned->k[1]);
    return RITZ_OK;
}

ritz_status ritz_tuning_check(const ritz_tuning_request *request)
{
    const ritz_dampers *dampers = request->model.kind == RITZ_MODEL_STATES
                                      ? NULL
                                      : dampers_of(request->model);
    RITZ_OWN_ARRAY bool *taken = NULL;
    bool any = false;

    RITZ_REFUSE_IF(!dampers || dampers->count == 0, RITZ_ERR_ARGUMENT,
                   "the model has no dampers to tune");
    RITZ_CHECK_NEW(taken, dampers->count);
    for (int64_t g = 0; g < request->count; g++) {
        const ritz_tuned *tuned = &request->tuned[g];

        for (int64_t j = 0; j < tuned->count; j++) {
            int64_t at = tuned->damper[j];

            RITZ_REFUSE_IF(at < 0 || at >= dampers->count, RITZ_ERR_ARGUMENT,
                           "there is no damper %" PRId64, at + 1);
            RITZ_REFUSE_IF(taken[at], RITZ_ERR_ARGUMENT,
                           "damper '%s' is tuned twice", dampers->name[at]);
            taken[at] = true;
            RITZ_CHECK(check_range(tuned, dampers->name[at]));
        }
        any =
            any || (tuned->count > 0 && (varies(tuned->c) || varies(tuned->k)));
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "no value of a damper has a range to be tuned in");
    return RITZ_OK;
}

int64_t ritz_tuning_modes(const ritz_tuning_request *request)
{
    return request->modes > 0 ? request->modes : FIRST_MODES;
}

bool ritz_tuned_in_space(const ritz_tuning_request *request, int64_t modes)
{
    const ritz_component *c = request->model.component;
    int64_t most = request->most_full > 0 ? request->most_full : WHOLE_DOFS;

    return request->model.kind == RITZ_MODEL_COMPONENT && c->num_dofs > most &&
           modes + c->io.num_inputs < c->num_dofs;
}

void ritz_tuning_uses(const ritz_tuning_request *request, bool *used)
{
    const ritz_dampers *dampers = dampers_of(request->model);

    for (int64_t j = 0; j < dampers->count; j++)
        used[j] = dampers->c[j] != 0.0 || dampers->k[j] != 0.0 ||
                  dampers->held_c[j] != 0.0 || dampers->held_k[j] != 0.0;
    for (int64_t g = 0; g < request->count; g++)
        for (int64_t j = 0; j < request->tuned[g].count; j++)
            used[request->tuned[g].damper[j]] = true;
}

/* The plant that is tuned: the model itself, or its projection on a space of @p
   modes modes and static responses. */
static ritz_status make_plant(const ritz_tuning_request *request, int64_t modes,
                              ritz_plant *out)
{
    RITZ_OWN(ritz_static_space) space = {0};
    RITZ_OWN_ARRAY bool *used = NULL;

    if (!ritz_tuned_in_space(request, modes))
        return ritz_plant_new(request->model, &request->noise, out);
    RITZ_CHECK_NEW(used, dampers_of(request->model)->count);
    ritz_tuning_uses(request, used);
    RITZ_CHECK(
        ritz_static_space_new(request->model, modes, &request->noise, &space));
    return ritz_static_space_plant(&space, used, out);
}

/* One round: tune the plant, and compute the norm of the full model with the
   values found. */
static ritz_status tune_once(const ritz_tuning_request *request,
                             const ritz_tuning_search *search, int64_t modes,
                             ritz_tuning *out)
{
    bool in_space = ritz_tuned_in_space(request, modes);
    RITZ_OWN(ritz_plant) plant = {0};
    RITZ_OWN(ritz_tuning) tuning = {0};
    ritz_h2 full = {0};
    double before = 0.0;

    RITZ_CHECK(make_plant(request, modes, &plant));
    RITZ_CHECK(ritz_plant_norm(&plant, &before));
    RITZ_CHECK(ritz_tune_plant(&plant, search, &tuning));
    RITZ_REFUSE_IF(!isfinite(tuning.norm), RITZ_ERR_ARGUMENT,
                   "the H2 norm is infinite wherever it was tried: a motion "
                   "that is driven and observed is damped by nothing");
    RITZ_REFUSE_IF(tuning.norm == 0.0, RITZ_ERR_ARGUMENT,
                   "the H2 norm is 0 whatever the dampers do: no output "
                   "observes what the inputs drive");
    tuning.before = before;
    tuning.modes = in_space ? modes : 0;
    if (in_space) {
        RITZ_CHECK_IN("full model",
                      ritz_h2_with(request->model, &request->noise,
                                   plant.dampers.c, plant.dampers.k, &full));
        tuning.norm = full.value;
        tuning.change = full.change;
    }
    RITZ_MOVE(*out, tuning);
    return RITZ_OK;
}

ritz_status ritz_tune_from(const ritz_tuning_request *request, const double *c,
                           const double *k, ritz_tuning *out)
{
    ritz_tuning_search search = {request->count,
                                 request->tuned,
                                 c,
                                 k,
                                 STARTS,
                                 request->most > 0 ? request->most
                                                   : MOST_EVALUATIONS};
    int64_t modes = ritz_tuning_modes(request);
    RITZ_OWN(ritz_tuning) tuning = {0};

    RITZ_CHECK(ritz_tuning_check(request));
    for (int round = 0; round < MOST_ROUNDS; round++, modes *= 2) {
        RITZ_OWN(ritz_tuning) next = {0};

        RITZ_CHECK(tune_once(request, &search, modes, &next));
        next.evaluations += tuning.evaluations;
        ritz_tuning_free(&tuning);
        RITZ_MOVE(tuning, next);
        if (fabs(tuning.norm - tuning.tuned) <= RITZ_TUNED_FULL * tuning.norm)
            break;
        search.c = tuning.c;
        search.k = tuning.k;
        search.starts = 1;
    }
    RITZ_MOVE(*out, tuning);
    return RITZ_OK;
}

ritz_status ritz_tuning_of(const ritz_tuning_request *request, ritz_tuning *out)
{
    return ritz_tune_from(request, NULL, NULL, out);
}
