/*
 * The search of one method: rungs 0, 1, 2, 4, 8, ... of its ladder until one is
 * feasible, then bisection, and then the rungs below one by one, since an error
 * may rise where a mode is added and fall again with the next.
 */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <math.h>
#include <string.h>

/* --- candidates that were tried ------------------------------------------- */

enum { PART = 4 };
/* How many candidates a method is expected to need while none is done. */
enum { USUAL = 15 };
/* Richer first stages in a row that are no better, before they are given up. */
enum { MOST_FLAT_STAGES = 3 };
/* Most modes that one body is given in exchange for one more of another. */
enum { MOST_GIVEN = 4 };
/* Rungs below a feasible one that are tried even if the next below fails. */
enum { COMPONENT_BELOW = 8, SCENE_BELOW = 3 };
/* A method is pursued up to this multiple of the order of the best of the
   others, and some columns more. */
enum { FAR = 2, BESIDE = 8 };
/* A method is given up when its first rungs were refused so often. */
enum { MOST_REFUSED = 4 };
/* Ladders that are longer and come no better, before a method is given up; what
   is better has so much of the error, or less. */
enum { MOST_FLAT = 2 };

ritz_status ritz_fit_append(ritz_fit *fit, ritz_fit_candidate *candidate)
{
    RITZ_CHECK_ROOM(fit->candidate, fit->count, fit->room);
    RITZ_MOVE(fit->candidate[fit->count++], *candidate);
    return RITZ_OK;
}

static bool is_same(const ritz_fit_candidate *c, const ritz_method *method,
                    const int64_t *modes)
{
    if (c->method != method || c->left_out > 0)
        return false;
    for (int64_t k = 0; k < c->num_bodies; k++)
        if (c->modes[k] != (method->uses & RITZ_USES_MODES ? modes[k] : -1))
            return false;
    return true;
}

/* Estimate how many candidates the search will try: each method still to come
   is expected to need as many as those before it did on average, or USUAL. */
static int64_t foresee_count(const ritz_fit *fit, int64_t method)
{
    int64_t before = 0, each = USUAL, here = 0;

    for (int64_t k = 0; k < fit->count; k++)
        here += fit->candidate[k].method == fit->method[method];
    before = fit->count - here;
    if (method > 0 && before >= method)
        each = before / method;
    return fit->count + (here < each ? each - here : 1) +
           each * (fit->num_methods - method - 1);
}

ritz_status ritz_fit_visit(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                           const int64_t *modes, int64_t *at)
{
    RITZ_OWN(ritz_fit_candidate) candidate = {0};

    for (int64_t k = 0; k < fit->count; k++)
        if (is_same(&fit->candidate[k], fit->method[method], modes)) {
            *at = k;
            return RITZ_OK;
        }
    RITZ_CHECK(ritz_fit_go_on(fitter));
    ritz_monitor_step("candidates", fit->count, foresee_count(fit, method));
    RITZ_CHECK(ritz_fitter_try(fitter, fit->method[method], modes, &candidate));
    RITZ_CHECK(ritz_fit_append(fit, &candidate));
    *at = fit->count - 1;
    return RITZ_OK;
}

/* Of two that are as small and as near the one that came first. */
bool ritz_fit_is_better(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b)
{
    if (a->order != b->order)
        return a->order < b->order;
    return a->ratio < b->ratio * (1.0 - RITZ_SAME_RATIO);
}

int64_t ritz_fit_largest_of(const ritz_fit *fit, const ritz_method *method,
                            int64_t order)
{
    int64_t best = -1;

    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        const ritz_fit_candidate *b = best < 0 ? NULL : &fit->candidate[best];

        if (c->method != method || c->refusal[0] || c->order > order)
            continue;
        if (!b || c->order > b->order ||
            (c->order == b->order && c->ratio < b->ratio))
            best = k;
    }
    return best;
}

/* The best and the nearest of a method. */
void ritz_fit_conclude(ritz_fit *fit, int64_t method)
{
    fit->best[method] = fit->reached[method] = -1;
    for (int64_t k = 0; k < fit->count; k++) {
        const ritz_fit_candidate *c = &fit->candidate[k];
        int64_t best = fit->best[method];
        int64_t reached = fit->reached[method];

        if (c->method != fit->method[method])
            continue;
        if (c->feasible &&
            (best < 0 || ritz_fit_is_better(c, &fit->candidate[best])))
            fit->best[method] = k;
        if (!c->refusal[0] &&
            (reached < 0 || ritz_fit_is_nearer(c, &fit->candidate[reached])))
            fit->reached[method] = k;
    }
}

/* --- COMPARE's first stage ------------------------------------------------ */

/* How far COMPARE is off with nothing removed, whatever its order. */
static ritz_status measure_uncut(ritz_fitter *f, double *out)
{
    const ritz_method *method = &ritz_fit_compare;
    const ritz_fit_request request = f->request;
    const int64_t largest = f->largest;
    RITZ_OWN(ritz_fit_candidate) whole = {0};
    RITZ_OWN_ARRAY int64_t *modes = NULL;
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_fit_go_on(f));
    RITZ_CHECK_NEW(modes, f->num_bodies);
    ritz_fit_rung(f, method, ritz_fit_rungs(f, method), modes);
    f->largest = INT64_MAX;
    f->request.thorough = true; /* measured, not bounded */
    f->request.costs = false;
    f->request.observe = NULL;
    status = ritz_fitter_try(f, method, modes, &whole);
    f->request = request;
    f->largest = largest;
    *out = whole.refusal[0] ? 0.0 : whole.ratio; /* its sentence is told */
    return status;
}

/* Modes of bodies up to a frequency, as far as the ladder has them. */
static int64_t count_to(const ritz_fitter *f, double hertz)
{
    int64_t count = 0;

    while (count < f->num_steps && f->step[count].hertz <= hertz)
        count++;
    return count;
}

/* The frequency to which a richer stage has modes. */
static ritz_status next_hz(ritz_fitter *f, double *hertz, ritz_fit_end *end)
{
    const double from = f->second.rich_hz;
    int64_t count = 0, more = 0;

    *end = RITZ_FIT_END_NONE;
    for (;;) {
        count = count_to(f, from);
        more = count + count / PART + 1;
        if ((count_to(f, RITZ_STAGE_FARTHER * from) < f->num_steps &&
             more <= f->num_steps) ||
            *end != RITZ_FIT_END_NONE)
            break;
        RITZ_CHECK(ritz_fit_extend(f, end));
    }
    if (count == f->num_steps)
        return RITZ_OK;
    *end = RITZ_FIT_END_NONE;
    more = more < f->num_steps ? more : f->num_steps;
    *hertz =
        fmax(RITZ_STAGE_FARTHER * from, f->step[more - 1].hertz * RITZ_TIE);
    return RITZ_OK;
}

/*
 * Make COMPARE's first stage richer until, with nothing removed, it leaves at
 * most a tenth of the tolerance, or does not get better; `end` is what ended
 * it.
 */
ritz_status ritz_fit_enrich(ritz_fitter *f, ritz_fit_end *end)
{
    double excess = 0.0, before = HUGE_VAL, hertz = 0.0;
    bool made = false;

    *end = RITZ_FIT_END_NONE;
    RITZ_CHECK(ritz_fit_second_make(f, f->rich_hz, NULL));
    if (f->second.status != RITZ_OK)
        return RITZ_OK;
    RITZ_CHECK(measure_uncut(f, &excess));
    for (int flat = 0; excess > RITZ_STAGE_MAY_LEAVE;) {
        RITZ_CHECK(next_hz(f, &hertz, end));
        if (*end != RITZ_FIT_END_NONE)
            return RITZ_OK;
        RITZ_CHECK(ritz_fit_second_make(f, hertz, &made));
        if (!made) {
            *end = RITZ_FIT_END_REFUSED;
            return RITZ_OK;
        }
        ritz_fit_forget(f, &ritz_fit_compare);
        before = excess;
        RITZ_CHECK(measure_uncut(f, &excess));
        flat = excess > RITZ_NO_NEARER * before ? flat + 1 : 0;
        if (flat == MOST_FLAT_STAGES) {
            *end = RITZ_FIT_END_FLAT;
            return RITZ_OK;
        }
    }
    return RITZ_OK;
}

/* --- the ladder ----------------------------------------------------------- */

/* One method on its ladder. */
typedef struct ladder {
    ritz_fitter *fitter;
    ritz_fit *fit;
    int64_t method, top;
    int64_t length; /* rungs of the scene's ladder as far as it is used */
    bool on; /* beyond the first ladder's end, and no farther than in reach */
    int64_t *modes, *from; /* num_bodies each, to work in */
    int64_t last, earlier; /* candidates: the highest rungs that were made */
    ritz_fit_end end;      /* why there is no higher one; NONE: there is */
} ladder;

static ritz_status visit_rung(const ladder *l, int64_t t, int64_t *at)
{
    ritz_fit_rung(l->fitter, l->fit->method[l->method], t, l->modes);
    return ritz_fit_visit(l->fitter, l->fit, l->method, l->modes, at);
}

static const ritz_fit_candidate *find_candidate(const ladder *l, int64_t at)
{
    return &l->fit->candidate[at];
}

/* Why rungs above a refused candidate are not tried. */
static ritz_fit_end wall_of(const ladder *l, int64_t at)
{
    return find_candidate(l, at)->order > l->fitter->largest
               ? RITZ_FIT_END_LARGEST
               : RITZ_FIT_END_REFUSED;
}

/* Order of the best of all methods but one; INT64_MAX: there is none. */
static int64_t least_order(const ritz_fit *fit, int64_t but)
{
    int64_t least = INT64_MAX;

    for (int64_t m = 0; m < fit->num_methods; m++)
        if (m != but && fit->best[m] >= 0 &&
            fit->candidate[fit->best[m]].order < least)
            least = fit->candidate[fit->best[m]].order;
    return least;
}

/* Whether a candidate may still become the smallest of all methods. */
static bool in_reach(const ladder *l, int64_t at)
{
    int64_t least = least_order(l->fit, l->method);

    return l->fitter->request.thorough || least == INT64_MAX ||
           (double)find_candidate(l, at)->order <
               RITZ_FIT_REACH * (double)least;
}

/*
 * Up: [low, high] with high the first feasible rung that was met, or -1; low
 * the last below that was made and is not feasible, -1 if none. Where a rung is
 * refused for its size, the highest that is not is sought between.
 */
static ritz_status climb_ladder(ladder *l, int64_t *low, int64_t *high)
{
    int64_t refused = 0, at = 0, wall = l->top + 1, before = -1;

    *low = *high = l->last = l->earlier = -1;
    l->end = RITZ_FIT_END_NONE;
    for (int64_t t = 0; t < wall && *high < 0;) {
        const ritz_fit_candidate *c = NULL;

        RITZ_CHECK(visit_rung(l, t, &at));
        c = find_candidate(l, at);
        if (c->feasible) {
            *high = t;
        } else if (!c->refusal[0]) {
            l->earlier = l->last;
            l->last = at;
            if (t > 4 && c->order == before) { /* it has no more to give */
                l->end = RITZ_FIT_END_SAME;
                break;
            }
            before = c->order;
            *low = t;
            if (l->on && !in_reach(l, at))
                break;
        } else if (*low >= 0) {
            l->end = wall_of(l, at);
            wall = t;
        } else if (++refused == MOST_REFUSED) {
            l->end = wall_of(l, at);
            break;
        }
        t = wall <= l->top || t == l->top ? wall
            : t == 0                      ? 1
            : 2 * t < l->top              ? 2 * t
                                          : l->top;
    }
    for (int64_t t = 0; *high < 0 && *low >= 0 && wall - *low > 1;) {
        t = *low + (wall - *low) / 2;
        if (wall > l->top) /* all that was tried was made */
            break;
        RITZ_CHECK(visit_rung(l, t, &at));
        if (find_candidate(l, at)->feasible)
            *high = t;
        else if (!find_candidate(l, at)->refusal[0])
            *low = t;
        else
            wall = t;
    }
    return RITZ_OK;
}

/* Whether one comes better than another of fewer modes; what bounds no longer
   rule out does. */
static bool is_better_than(const ritz_fit_candidate *now,
                           const ritz_fit_candidate *then)
{
    if (now->ruled_out != then->ruled_out)
        return then->ruled_out;
    return ritz_fit_is_nearer(now, then) &&
           (ritz_fit_misses(now) < ritz_fit_misses(then) ||
            now->ratio < RITZ_NO_NEARER * then->ratio);
}

/*
 * How far a method is pursued: while others do with far less, not at all. Rungs
 * are modes, of which there are no more than columns.
 */
static int64_t top_of(const ladder *l)
{
    const ritz_fitter *fitter = l->fitter;
    const ritz_method *method = l->fit->method[l->method];
    int64_t top = fitter->scene ? l->length : fitter->largest;
    int64_t least = least_order(l->fit, l->method);

    if (!(method->uses & RITZ_USES_MODES))
        return 0;
    if (!fitter->request.thorough && least < INT64_MAX &&
        FAR * least + BESIDE < top)
        top = FAR * least + BESIDE;
    return top;
}

/* Climb the ladder as it was made, and set why it ended. */
static ritz_status climb_first(ladder *l, int64_t *low, int64_t *high)
{
    const ritz_method *method = l->fit->method[l->method];
    const bool composite = method == &ritz_fit_compare;
    ritz_fit_end whole = RITZ_FIT_END_NONE;

    if (l->fitter->scene && composite)
        RITZ_CHECK(ritz_fit_enrich(l->fitter, &whole));
    l->length =
        composite ? ritz_fit_rungs(l->fitter, method) : l->fitter->num_first;
    l->top = top_of(l);
    RITZ_CHECK(climb_ladder(l, low, high));
    if (l->end == RITZ_FIT_END_NONE && l->top == l->length)
        l->end = whole;
    if (l->end == RITZ_FIT_END_NONE && l->fitter->component &&
        (method->uses & RITZ_USES_MODES) && l->top == l->fitter->largest)
        l->end = l->top < l->fitter->component->num_dofs ? RITZ_FIT_END_LARGEST
                                                         : RITZ_FIT_END_WHOLE;
    return RITZ_OK;
}

/* Whether it is worth while to go on beyond the ladder's end. */
static bool goes_on(const ladder *l)
{
    const ritz_method *method = l->fit->method[l->method];

    if (l->end != RITZ_FIT_END_NONE || l->last < 0 || l->top < l->length ||
        !l->fitter->scene || !(method->uses & RITZ_USES_MODES))
        return false;
    return in_reach(l, l->last);
}

/* Make the ladder twice as long, as far as more modes can be had. */
static ritz_status lengthen_ladder(ladder *l)
{
    const int64_t twice = 2 * l->length + BESIDE;

    if (l->fitter->num_steps < twice)
        RITZ_CHECK(ritz_fit_extend(l->fitter, &l->end));
    if (l->fitter->num_steps > l->length)
        l->end = RITZ_FIT_END_NONE;
    l->length = twice < l->fitter->num_steps ? twice : l->fitter->num_steps;
    l->top = top_of(l);
    return RITZ_OK;
}

/* Up, on a ladder that is made longer while nothing is met and errors fall. */
static ritz_status climb_on(ladder *l, int64_t *low, int64_t *high)
{
    int64_t flat = 0;

    while (*high < 0 && goes_on(l)) {
        flat = l->earlier >= 0 && is_better_than(find_candidate(l, l->last),
                                                 find_candidate(l, l->earlier))
                   ? 0
                   : flat + 1;
        if (flat == MOST_FLAT) {
            l->end = RITZ_FIT_END_FLAT;
            break;
        }
        RITZ_CHECK(lengthen_ladder(l));
        if (l->end == RITZ_FIT_END_NONE)
            RITZ_CHECK(climb_ladder(l, low, high));
    }
    return RITZ_OK;
}

/* Between, and then below. */
static ritz_status descend_ladder(const ladder *l, int64_t low, int64_t high)
{
    int64_t below = l->fitter->scene ? SCENE_BELOW : COMPONENT_BELOW;
    int64_t at = 0;

    while (high - low > 1) {
        int64_t t = low + (high - low) / 2;

        RITZ_CHECK(visit_rung(l, t, &at));
        *(find_candidate(l, at)->feasible ? &high : &low) = t;
    }
    for (int64_t t = high - 1; t >= 0 && t >= high - below; t--) {
        RITZ_CHECK(visit_rung(l, t, &at));
        if (find_candidate(l, at)->feasible)
            high = t;
    }
    return RITZ_OK;
}

/*
 * Of a method that met nothing the largest model is measured, if bounds had
 * ruled it out: it says how near the method comes.
 */
static ritz_status measure_largest(const ladder *l)
{
    ritz_fitter *fitter = l->fitter;
    const bool thorough = fitter->request.thorough;
    const int64_t at =
        ritz_fit_largest_of(l->fit, l->fit->method[l->method], INT64_MAX);
    ritz_fit_candidate *c = at < 0 ? NULL : &l->fit->candidate[at];
    ritz_fit_candidate again = {0};
    ritz_status status = RITZ_OK;

    if (!c || !c->ruled_out)
        return RITZ_OK;
    fitter->request.thorough = true;
    status = ritz_fitter_try(fitter, c->method, c->modes, &again);
    fitter->request.thorough = thorough;
    RITZ_CHECK(status);
    ritz_fit_candidate_free(c);
    *c = again;
    return RITZ_OK;
}

/*
 * Fewer modes than one cut for all bodies gives: from each body in turn one is
 * taken, that whose loss hurts least is gone for good; where none can go,
 * bodies exchange modes, several of one for fewer of another.
 */

/* Try `from` with @p less modes of one body and @p more of another; it may be
   better than the best so far. */
static ritz_status move_modes(const ladder *l, int64_t i, int64_t less,
                              int64_t j, int64_t more)
{
    int64_t *best = &l->fit->best[l->method];
    const ritz_fit_candidate *all = NULL;
    int64_t at = 0;

    if (l->from[i] < less)
        return RITZ_OK;
    memcpy(l->modes, l->from, (size_t)l->fitter->num_bodies * sizeof *l->modes);
    l->modes[i] -= less;
    l->modes[j] += more;
    RITZ_CHECK(ritz_fit_visit(l->fitter, l->fit, l->method, l->modes, &at));
    all = l->fit->candidate;
    if (all[at].feasible && ritz_fit_is_better(&all[at], &all[*best]))
        *best = at;
    return RITZ_OK;
}

/* One mode of each body in turn; if none can go, exchanges between bodies. */
static ritz_status move_all(const ladder *l)
{
    const int64_t bodies = l->fitter->num_bodies;
    const int64_t before = l->fit->best[l->method];

    for (int64_t i = 0; i < bodies; i++)
        RITZ_CHECK(move_modes(l, i, 1, i, 0));
    if (l->fit->best[l->method] != before)
        return RITZ_OK;
    for (int64_t given = 1; given <= MOST_GIVEN; given++)
        for (int64_t i = 0; i < bodies; i++)
            for (int64_t j = 0; j < bodies; j++)
                if (i != j)
                    RITZ_CHECK(move_modes(l, i, given + 1, j, given));
    return RITZ_OK;
}

static ritz_status thin_modes(const ladder *l)
{
    const int64_t *best = &l->fit->best[l->method];

    for (int64_t before = -1; before != *best;) {
        before = *best;
        memcpy(l->from, l->fit->candidate[before].modes,
               (size_t)l->fitter->num_bodies * sizeof *l->from);
        RITZ_CHECK(move_all(l));
    }
    return RITZ_OK;
}

ritz_status ritz_fit_search(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                            bool on)
{
    RITZ_OWN_ARRAY int64_t *modes = NULL;
    ladder l = {.fitter = fitter, .fit = fit, .method = method};
    int64_t low = -1, high = -1;

    RITZ_CHECK_NEW(modes, 2 * fitter->num_bodies);
    l.modes = modes;
    l.from = modes + fitter->num_bodies;
    RITZ_CHECK(climb_first(&l, &low, &high));
    l.on = on;
    if (on)
        RITZ_CHECK(climb_on(&l, &low, &high));
    if (high >= 0)
        RITZ_CHECK(descend_ladder(&l, low, high));
    ritz_fit_conclude(fit, method);
    fit->end[method] = high < 0 ? l.end : RITZ_FIT_END_NONE;
    if (fit->best[method] < 0) {
        RITZ_CHECK(measure_largest(&l));
        ritz_fit_conclude(fit, method);
    }
    if (fitter->scene && fit->best[method] >= 0 &&
        (!on || in_reach(&l, fit->best[method]))) {
        RITZ_CHECK(thin_modes(&l));
        ritz_fit_conclude(fit, method);
    }
    return RITZ_OK;
}
