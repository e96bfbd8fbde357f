/*
 * One candidate: its bodies are made, unless a candidate before had the same,
 * and joined. Unless a bound rules it out it is measured at every listed
 * configuration; if it meets the tolerance there, it is confirmed at random
 * frequencies and configurations.
 */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "linear/blas_threads.h"

#include <ritz/check.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- judged --------------------------------------------------------------- */

static void set_refusal(const char *why, ritz_fit_candidate *candidate)
{
    (void)snprintf(candidate->refusal, sizeof candidate->refusal, "%s", why);
    candidate->feasible = false;
    candidate->ratio = HUGE_VAL;
}

ritz_status ritz_fit_refuse(ritz_status status, ritz_fit_candidate *candidate)
{
    if (status == RITZ_OK || status == RITZ_ERR_MEMORY)
        return status;
    set_refusal(ritz_error_message(), candidate);
    return RITZ_OK;
}

void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate)
{
    candidate->ratio = 0.0;
    candidate->worst = -1;
    for (int64_t k = 0; k < candidate->errors.count; k++) {
        ritz_measure *m = &candidate->errors.item[k];
        double ratio = 0.0;

        if (isnan(m->limit))
            m->limit = ritz_measure_limit(limits->limit, m->name);
        if (isnan(m->limit))
            continue;
        ratio = ritz_measure_ratio(m->name, m->value, m->limit);
        if (candidate->worst < 0 || ratio > candidate->ratio) {
            candidate->ratio = ratio;
            candidate->worst = k;
        }
    }
    candidate->feasible = candidate->ratio <= 1.0;
}

double ritz_fit_misses(const ritz_fit_candidate *c)
{
    const ritz_measure *m = ritz_measures_find(&c->errors, "missing-modes");

    return m && m->value > m->limit ? m->value : 0.0;
}

/* What was not measured is only known to be off by at least its ratio; errors
 * of the modes that were found say little where others are missing. */
bool ritz_fit_is_nearer(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b)
{
    double more = ritz_fit_misses(a) - ritz_fit_misses(b);

    if (a->ruled_out != b->ruled_out)
        return b->ruled_out;
    return more != 0.0 ? more < 0.0 : a->ratio < b->ratio;
}

ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst)
{
    char where[RITZ_NAME_SIZE];

    for (int64_t k = 0; k < more->count; k++) {
        const ritz_measure *m = &more->item[k];
        ritz_measure *old = ritz_measures_find(worst, m->name);

        if (at[0])
            (void)snprintf(where, sizeof where, "%.28s%s%.32s", at,
                           m->where[0] ? ": " : "", m->where);
        else
            memcpy(where, m->where, sizeof where);
        if (!old) {
            RITZ_CHECK(
                ritz_measures_add(worst, m->name, m->value, m->limit, where));
            ritz_measures_name_cause(worst, m->cause);
        } else if (!ritz_measure_meets(m->name, m->value, old->value)) {
            old->value = m->value;
            memcpy(old->where, where, sizeof where);
            memcpy(old->cause, m->cause, sizeof old->cause);
        }
    }
    return RITZ_OK;
}

/* --- its bodies ----------------------------------------------------------- */

/* Free a body that was made. */
static void free_made(ritz_fit_made *made)
{
    ritz_reduced_free(&made->reduced);
    ritz_dense_free(&made->parts);
}

void ritz_fit_forget(ritz_fitter *f, const ritz_method *method)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < f->num_made; k++)
        if (f->made[k].method == method)
            free_made(&f->made[k]);
        else
            f->made[kept++] = f->made[k];
    f->num_made = kept;
}

/* Whether T of a body that was made is kept: bounds of a scene need T of all
   bodies. There is a limit of memory. */
static bool keeps_basis(const ritz_fitter *f, const ritz_dense *T)
{
    int64_t held = T->nrow * T->ncol;

    for (int64_t k = 0; k < f->num_made; k++)
        held += f->made[k].reduced.T.nrow * f->made[k].reduced.T.ncol;
    return f->scene && f->place[0].estimator && held <= f->most_entries;
}

/* Whether this is the body, or one that equals it. A refusal names its body. */
static bool serves_body(const ritz_fitter *f, const ritz_fit_made *made,
                        const ritz_method *method, int64_t body, int64_t modes)
{
    return made->method == method && made->modes == modes &&
           (made->body == body ||
            (made->status == RITZ_OK &&
             ritz_fit_are_equal(f, method, made->body, body)));
}

/* Find or make a body reduced by a method with a number of modes. If it cannot
   be made, the reason is kept in its place. */
static ritz_status make_body(ritz_fitter *f, const ritz_method *method,
                             int64_t body, int64_t modes, int64_t *at)
{
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) parts = {0};
    const ritz_fit_watch watch = ritz_fit_start();
    ritz_fit_made *made = NULL;
    ritz_status status = RITZ_OK;

    for (*at = 0; *at < f->num_made; (*at)++)
        if (serves_body(f, &f->made[*at], method, body, modes))
            return RITZ_OK;
    RITZ_CHECK_ROOM(f->made, f->num_made, f->room_made);
    status = ritz_fit_take(f, method, body, modes,
                           f->scene && f->place[0].estimator, &reduced, &parts);
    if (status == RITZ_OK)
        status = ritz_reduced_install(&reduced);
    if (status == RITZ_ERR_MEMORY)
        return status;
    if (!keeps_basis(f, &reduced.T))
        ritz_dense_free(&reduced.T);
    made = &f->made[f->num_made++];
    *made = (ritz_fit_made){
        .method = method, .body = body, .modes = modes, .status = status};
    if (status != RITZ_OK)
        (void)snprintf(made->refusal, sizeof made->refusal, "%s",
                       ritz_error_message());
    made->making = ritz_fit_since(watch);
    RITZ_MOVE(made->reduced, reduced);
    RITZ_MOVE(made->parts, parts);
    return RITZ_OK;
}

/* All bodies joined, and what they took; a refused one refuses the
   candidate. */
static ritz_status join_bodies(ritz_fitter *f, ritz_fit_candidate *candidate,
                               ritz_fit_joined *out)
{
    RITZ_OWN_ARRAY ritz_reduced *body = NULL; /* borrowed */

    RITZ_CHECK_NEW(body, f->num_bodies);
    candidate->making = (ritz_fit_watch){0};
    candidate->columns = 0;
    if (f->scene && candidate->method == &ritz_fit_compare) {
        RITZ_CHECK(ritz_fit_second_make(f, f->rich_hz, NULL));
        candidate->making = f->second.making;
    }
    for (int64_t k = 0; k < f->num_bodies; k++) {
        const ritz_fit_made *made = NULL;
        int64_t at = 0;

        RITZ_CHECK(
            make_body(f, candidate->method, k, candidate->modes[k], &at));
        made = &f->made[at];
        if (made->status != RITZ_OK) {
            set_refusal(made->refusal, candidate);
            return RITZ_OK;
        }
        candidate->making.wall += made->making.wall;
        candidate->making.cpu += made->making.cpu;
        candidate->columns += made->reduced.K.ncol;
        body[k] = made->reduced;
        if (!f->scene)
            RITZ_CHECK(ritz_dense_copy(&made->parts, &out->parts));
    }
    return ritz_fit_join(f, body, out);
}

/* --- a model at a place --------------------------------------------------- */

/* The reduced model at one place. */
typedef struct ritz_fit_model {
    const ritz_fit_place *place;
    const ritz_stage *stage;
    ritz_compared compared; /* of a component: Phi'M T, if it is known */
    ritz_configuration at;  /* of a scene */
    ritz_reduced lent;      /* its matrices, and T of a component; borrowed */
} ritz_fit_model;

static void ritz_fit_model_free(ritz_fit_model *m)
{
    ritz_configuration_free(&m->at);
    ritz_pairs_free(&m->compared.modes);
}

static ritz_status open_model(const ritz_fitter *f, const ritz_stage *stage,
                              const ritz_fit_place *place, ritz_fit_model *m)
{
    m->place = place;
    m->stage = stage;
    if (!f->scene) {
        m->lent = stage->body[0];
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_stage_assemble(stage, place->setting, &m->at));
    m->lent = (ritz_reduced){.K = m->at.K,
                             .M = m->at.M,
                             .D = m->at.D,
                             .K4 = m->at.K4,
                             .io = m->at.io};
    return RITZ_OK;
}

/* A model that moves by itself is none, however near its frequencies are. */
static ritz_status check_stability(const ritz_fitter *f,
                                   const ritz_fit_model *m,
                                   ritz_fit_candidate *candidate)
{
    ritz_probe found = {0};
    char what[2 * RITZ_NAME_SIZE];
    char why[sizeof what + 16];

    RITZ_CHECK(ritz_probe_second_order(&m->lent.K, &m->lent.M, &m->lent.D,
                                       &f->request.tolerance.damping, &found));
    if (found.verdict != RITZ_UNSTABLE)
        return RITZ_OK;
    ritz_probe_print(&found, what);
    (void)snprintf(why, sizeof why, "unstable: %s", what);
    set_refusal(why, candidate);
    return RITZ_OK;
}

/* Its errors there are among the worst so far. */
static ritz_status measure_model(ritz_fitter *f, ritz_fit_model *m, int points,
                                 ritz_fit_candidate *candidate)
{
    const ritz_verify_request *limits = &f->request.tolerance;
    const ritz_reference *reference = m->place->reference;
    RITZ_OWN(ritz_measures) found = {0};

    RITZ_CHECK(ritz_reference_measure_parts(
        reference,
        f->scene ? ritz_model_of_configuration(&m->at, NULL)
                 : ritz_model_of_reduced(&m->lent, NULL),
        &m->compared, limits, points, &found));
    RITZ_CHECK(ritz_fit_worst(&found, m->place->at, &candidate->errors));
    ritz_fit_judge(limits, candidate);
    if (candidate->feasible && points & ~RITZ_ONLY_LIMITED &&
        !m->compared.passive)
        RITZ_CHECK(check_stability(f, m, candidate));
    return RITZ_OK;
}

/* --- bounds --------------------------------------------------------------- */

/* Whether all bodies have their T. */
static bool has_bases(const ritz_stage *stage)
{
    bool all = stage->count > 0;

    for (int64_t k = 0; k < stage->count; k++)
        all = all && stage->body[k].T.val;
    return all;
}

/* Where modes may be missing, no error is certain. */
static bool surely_fails(const ritz_verify_request *limits,
                         const ritz_measures *found, double *ratio)
{
    double least = ritz_measures_value(found, "frequency-relative-least");

    *ratio = least / limits->limit[RITZ_MEASURE_FREQUENCY];
    return !(limits->limit[RITZ_MEASURE_MISSING] > 0.0) && *ratio > 1.0;
}

/* Bounds of a model, or what its error is at least; none where nothing can be
   known, which is no failure. */
static ritz_status bound_model(const ritz_fitter *f, const ritz_fit_model *m,
                               bool least, ritz_measures *out)
{
    const ritz_fit_place *place = m->place;
    RITZ_OWN(ritz_dense) T = {0};
    ritz_basis basis = {.T = m->lent.T};
    ritz_status status = RITZ_OK;

    if (f->scene) {
        RITZ_CHECK(ritz_stage_basis(m->stage, &m->at, place->full.num_dofs,
                                    place->master, &T));
        basis.T = T;
    }
    status =
        ritz_estimator_measure(place->estimator, &basis, &m->lent, least, out);
    return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
}

/* Where modes are missing the worst error of the others may be 0. */
static void forget_least(ritz_measures *found)
{
    ritz_measure *least = ritz_measures_find(found, "frequency-relative-least");

    if (!least || !(ritz_measures_value(found, "missing-modes-bound") > 0.0))
        return;
    found->count--;
    memmove(least, least + 1,
            (size_t)(found->item + found->count - least) * sizeof *least);
}

/*
 * Rule a scene's candidate out if a lower bound of its worst frequency error is
 * above the tolerance. One bound, at one configuration, saves measuring the
 * systems of all. A component is measured at once, which costs less than a
 * bound.
 */
static ritz_status rule_out(const ritz_fitter *f, const ritz_fit_model *m,
                            ritz_fit_candidate *candidate)
{
    const ritz_verify_request *limits = &f->request.tolerance;
    RITZ_OWN(ritz_measures) found = {0};
    double ratio = 0.0;

    if (isnan(limits->limit[RITZ_MEASURE_FREQUENCY]))
        return RITZ_OK;
    RITZ_CHECK(bound_model(f, m, true, &found));
    if (surely_fails(limits, &found, &ratio)) {
        candidate->ruled_out = true;
        candidate->ratio = ratio;
    }
    if (!candidate->ruled_out) /* otherwise it is the reason */
        forget_least(&found);
    return ritz_fit_worst(&found, m->place->at, &candidate->estimates);
}

/* The search found a bound at one place only. Errors of the answer are the
 * worst of all places, random ones too, and so must be its bounds. */
ritz_status ritz_fit_bound_stage(ritz_fitter *f, const ritz_stage *stage,
                                 ritz_fit_candidate *candidate)
{
    ritz_measures_free(&candidate->estimates);
    if (!f->place[0].estimator || !has_bases(stage))
        return RITZ_OK;
    for (int64_t k = 0; k < f->num_places; k++) {
        ritz_fit_place *place = &f->place[k];
        RITZ_OWN(ritz_fit_model) m = {0};
        RITZ_OWN(ritz_measures) found = {0};

        if (!place->estimator)
            RITZ_CHECK(ritz_fit_estimator(f, &place->full, place));
        RITZ_CHECK(open_model(f, stage, place, &m));
        RITZ_CHECK(bound_model(f, &m, false, &found));
        forget_least(&found);
        RITZ_CHECK(ritz_fit_worst(&found, place->at, &candidate->estimates));
    }
    return RITZ_OK;
}

/* --- a candidate ---------------------------------------------------------- */

int ritz_fit_points(const ritz_reference *reference,
                    const ritz_measures *errors)
{
    const bool extra = ritz_measures_value(errors, "extra-modes") > 0.0;

    return extra || !ritz_reference_factors(reference)
               ? RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM
               : RITZ_AT_RANDOM;
}

ritz_status ritz_fit_measure_at(ritz_fitter *f, const ritz_fit_joined *joined,
                                const ritz_fit_place *place, int points,
                                bool bounds, ritz_fit_candidate *candidate)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    RITZ_OWN(ritz_fit_model)
    m = {.compared = {.parts = joined->parts.ncol > 0 ? &joined->parts : NULL,
                      .keeps_modes = joined->modes}};

    RITZ_CHECK(open_model(f, &joined->stage, place, &m));
    if (m.lent.K.ncol > candidate->order)
        candidate->order = m.lent.K.ncol;
    RITZ_REFUSE_IF(candidate->order > f->largest, RITZ_ERR_ARGUMENT,
                   "an order of %" PRId64 " is more than the %" PRId64
                   " that are tried",
                   candidate->order, f->largest);
    if (bounds)
        RITZ_CHECK(rule_out(f, &m, candidate));
    if (candidate->ruled_out)
        return RITZ_OK;
    RITZ_CHECK(measure_model(f, &m, points, candidate));
    if (joined->modes)
        RITZ_MOVE(*joined->modes, m.compared.modes);
    return RITZ_OK;
}

ritz_status ritz_fit_take_cost(const ritz_fitter *f, const ritz_stage *stage,
                               ritz_fit_candidate *candidate)
{
    const ritz_verify_request *limits = &f->request.tolerance;
    RITZ_OWN(ritz_fit_model) m = {0};
    ritz_second_order model = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(open_model(f, stage, &f->place[0], &m));
    model =
        (ritz_second_order){&m.lent.K, &m.lent.M, &m.lent.D, NULL, &m.lent.io};
    status = ritz_simulate_cost(ritz_model_of_dense(&model, &limits->damping),
                                limits->band_hz, &candidate->cost);
    if (status != RITZ_OK)
        candidate->cost = (ritz_cost){0};
    return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
}

/*
 * Bounds are asked where the candidate before was worst, as that is where the
 * next one fails, if it does.
 */
static ritz_status meet_grid(ritz_fitter *f, const ritz_fit_joined *joined,
                             ritz_fit_candidate *candidate)
{
    const int64_t first = f->hardest;
    bool bounds = f->scene && f->place[0].estimator &&
                  has_bases(&joined->stage) && !f->request.thorough;
    double worst = 0.0;

    RITZ_CHECK(
        ritz_fit_measure_at(f, joined, &f->place[first], 0, bounds, candidate));
    worst = candidate->ratio;
    for (int64_t k = 0; k < f->num_listed && !candidate->ruled_out; k++) {
        if (k == first)
            continue;
        RITZ_CHECK(
            ritz_fit_measure_at(f, joined, &f->place[k], 0, false, candidate));
        if (candidate->ratio > worst)
            f->hardest = k;
        worst = candidate->ratio;
    }
    return RITZ_OK;
}

/* Whether the cost of a candidate is measured as soon as it is feasible: more
   than the best of each method is told, or its bodies could not be had again
   without a new basis. */
static bool costs_at_once(const ritz_fitter *f,
                          const ritz_fit_candidate *candidate)
{
    const ritz_method *method = candidate->method;

    return f->request.costs && (f->request.observe || f->request.thorough ||
                                !(method->nested || method->narrow));
}

ritz_status ritz_fit_measure(ritz_fitter *f, const ritz_fit_joined *joined,
                             ritz_fit_candidate *candidate)
{
    int points = 0;

    RITZ_CHECK(meet_grid(f, joined, candidate));
    if (!candidate->feasible || candidate->ruled_out)
        return RITZ_OK;
    points = ritz_fit_points(f->place[0].reference, &candidate->errors);
    ritz_measures_free(&candidate->errors);
    for (int64_t k = 0; k < f->num_places && candidate->refusal[0] == '\0'; k++)
        RITZ_CHECK(ritz_fit_measure_at(f, joined, &f->place[k], points, false,
                                       candidate));
    candidate->unconfirmed =
        !candidate->feasible && candidate->refusal[0] == '\0';
    return candidate->feasible && costs_at_once(f, candidate)
               ? ritz_fit_take_cost(f, &joined->stage, candidate)
               : RITZ_OK;
}

ritz_status ritz_fit_bound_joined(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    RITZ_OWN(ritz_fit_joined) joined = {0};

    RITZ_CHECK(join_bodies(f, candidate, &joined));
    return joined.stage.body ? ritz_fit_bound_stage(f, &joined.stage, candidate)
                             : RITZ_OK;
}

ritz_status ritz_fitter_try(ritz_fitter *fitter, const ritz_method *method,
                            const int64_t *modes, ritz_fit_candidate *out)
{
    RITZ_OWN(ritz_fit_candidate)
    candidate = {
        .method = method, .num_bodies = fitter->num_bodies, .worst = -1};
    RITZ_OWN(ritz_fit_joined) joined = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK_NEW(candidate.modes, fitter->num_bodies);
    for (int64_t k = 0; k < fitter->num_bodies; k++)
        candidate.modes[k] = method->uses & RITZ_USES_MODES ? modes[k] : -1;
    status = join_bodies(fitter, &candidate, &joined);
    if (status == RITZ_OK && joined.stage.body) /* no body is refused */
        status = ritz_fit_measure(fitter, &joined, &candidate);
    if (!fitter->scene) /* its candidates share no body */
        ritz_fit_forget(fitter, method);
    RITZ_CHECK(ritz_fit_refuse(status, &candidate));
    if (fitter->request.observe)
        fitter->request.observe(&candidate, fitter->request.context);
    RITZ_MOVE(*out, candidate);
    return RITZ_OK;
}

void ritz_fit_candidate_free(ritz_fit_candidate *candidate)
{
    free(candidate->modes);
    ritz_measures_free(&candidate->errors);
    ritz_measures_free(&candidate->estimates);
    *candidate = (ritz_fit_candidate){0};
}
