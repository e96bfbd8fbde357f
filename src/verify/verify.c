/*
 * A full model against reduced ones. The reference holds what every comparison
 * with one full model needs, made once: modes, responses on a grid that is
 * refined at its poles, flexible static gain. A reduced model is compared with
 * it by every row of the table of measures.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/spectra.h"
#include "poles/poles.h"
#include "verify/sides.h"

#include <ritz/verify.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Dofs up to which all modes are taken where D couples them, or acts on those
   above in a way that is not known. */
enum { SMALL = 300 };
/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };
/* Where nothing says how a response is damped. */
static const ritz_damping unstated = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};

double ritz_random_next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53; /* [Steele2014] */
}

/* Some frequencies of a band, ascending and distinct, the same for one seed. */
static void draw_hertz(uint64_t seed, const double band_hz[2], int64_t count,
                       double *out)
{
    /* one in each of `count` equal parts: anywhere, and nowhere twice */
    double part = (band_hz[1] - band_hz[0]) / (double)count;

    for (int64_t k = 0; k < count; k++)
        out[k] = band_hz[0] + ((double)k + ritz_random_next(&seed)) * part;
    qsort(out, (size_t)count, sizeof *out, ritz_ascending);
}

int64_t ritz_reference_rigid(const ritz_reference *reference)
{
    const ritz_rounded *rounded = &reference->rounded;

    return rounded->hidden ? rounded->motions : reference->poles.num_rigid;
}

/* The flexible gain C Phi Lambda^-1 Phi'B of the modes, and of the rest. */
static ritz_status full_gain(ritz_reference *r)
{
    const ritz_poles *poles = &r->poles;
    int64_t p = poles->io.num_outputs;

    RITZ_CHECK(ritz_dense_new(p, poles->io.num_inputs, &r->gain));
    for (int64_t j = 0; j < poles->io.num_inputs; j++)
        for (int64_t i = 0; i < p; i++) {
            double *g = &ritz_dense_col(&r->gain, j)[i];

            *g = r->residual.count > 0 ? r->residual.part[0][i + j * p] : 0.0;
            for (int64_t k = ritz_reference_rigid(r); k < poles->count; k++)
                *g += ritz_dense_col(&poles->io.C, k)[i] *
                      ritz_dense_col(&poles->io.B, j)[k] / poles->lambda[k];
        }
    return RITZ_OK;
}

/* Modes up to a frequency, and the static response of the rest. */
static ritz_status take_modes(double up_to_hz, ritz_reference *r)
{
    RITZ_CHECK_IN("full model",
                  ritz_poles_of_component(r->component, &r->damping, up_to_hz,
                                          &r->pairs, &r->poles));
    return ritz_context(ritz_residual_new(r->component, &r->damping, &r->pairs,
                                          r->band_hz[1], up_to_hz,
                                          &r->residual),
                        "full model");
}

/* Effect of rounding of the rigid stiffness. Responses by factorisation of the
   full matrices contain all of it. Responses by modes, and by the krylov
   engine, contain only that of motions that are not counted as rigid. */
static ritz_status find_rounding(double tolerance, ritz_reference *r)
{
    const bool factors = ritz_reference_factors(r) &&
                         !ritz_ratios_act_on_all(r->component, &r->damping);

    RITZ_CHECK(ritz_rounded_of(r->component, &r->pairs, factors, &r->rounded));
    if (r->rounded.motions > 0)
        r->rules_hz = ritz_rounded_ends(
            &r->rounded, tolerance > 0.0 ? fmin(tolerance, RITZ_START_ROUNDING)
                                         : RITZ_START_ROUNDING);
    return RITZ_OK;
}

static ritz_status open_modes(double tolerance, ritz_reference *r)
{
    r->modes_hz = RITZ_REFERENCE_REACH * r->band_hz[1];
    RITZ_CHECK(take_modes(r->modes_hz, r));
    if (ritz_reference_factors(r) && r->component->num_dofs <= SMALL) {
        ritz_pairs_free(&r->pairs);
        ritz_poles_free(&r->poles);
        ritz_residual_free(&r->residual);
        RITZ_CHECK(take_modes(RITZ_ALL_MODES, r));
    }
    RITZ_CHECK_IN("full model",
                  ritz_damped_new(&r->poles, r->component, &r->pairs,
                                  r->band_hz, &r->damped));
    RITZ_CHECK_IN("full model", ritz_reference_observe(r));
    RITZ_CHECK_IN("full model", find_rounding(tolerance, r));
    RITZ_CHECK_IN("full model", full_gain(r));
    return RITZ_OK;
}

/* Responses where every reduction is compared. */
static ritz_status open_sweeps(const ritz_reference_request *request,
                               ritz_reference *r)
{
    const double band[2] = {ritz_reference_start(r), r->band_hz[1]};

    if (r->poles.io.num_inputs == 0 || r->poles.io.num_outputs == 0 ||
        !(band[1] > band[0]))
        return RITZ_OK;
    RITZ_CHECK_IN("full model", ritz_reference_prepare(r));
    RITZ_CHECK(
        ritz_sweep_points(r, &r->poles, &r->damped, EVEN_POINTS, &r->own));
    RITZ_CHECK_IN("full model", ritz_reference_respond(r, &r->own));
    if (request->num_random < 1)
        return RITZ_OK;
    r->random.count = request->num_random;
    RITZ_CHECK_NEW(r->random.hertz, r->random.count);
    draw_hertz(request->seed, band, r->random.count, r->random.hertz);
    return ritz_context(ritz_reference_respond(r, &r->random), "full model");
}

/* With the damping of the request, which may be assumed. */
static ritz_status make_reference(const ritz_component *full,
                                  const ritz_reference_request *request,
                                  bool assumed, ritz_reference **out)
{
    RITZ_OWN(ritz_reference) *r = NULL;

    RITZ_CHECK_NEW(r, 1);
    r->component = full;
    r->band_hz[0] = request->band_hz[0];
    r->band_hz[1] = request->band_hz[1];
    r->damping = request->damping;
    r->assumed = assumed;
    RITZ_CHECK(open_modes(request->tolerance, r));
    RITZ_CHECK(open_sweeps(request, r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

/* The modes of the band and those above it are of one pencil, solved once where
   it is small. */
static ritz_status open_reference(const ritz_component *full,
                                  const ritz_reference_request *request,
                                  bool assumed, ritz_reference **out)
{
    RITZ_OWN(ritz_spectra) *own = NULL;
    ritz_spectra_lent lent = {0};
    ritz_status status = RITZ_OK;

    if (ritz_spectra_are_lent())
        return make_reference(full, request, assumed, out);
    RITZ_CHECK(ritz_spectra_new(&own));
    lent = ritz_spectra_lend(own);
    status = make_reference(full, request, assumed, out);
    ritz_spectra_lent_free(&lent);
    return status;
}

/* Damping of both models: as requested, else as the full model states it, else
   as the reduced one does. */
static ritz_status choose_damping(const ritz_component *full,
                                  const char *reduced_text,
                                  const ritz_damping *asked, ritz_damping *out,
                                  bool *is_assumed)
{
    const char *text = full->damping[0] ? full->damping : reduced_text;
    bool matrices = full->D.colptr || full->K4.colptr;

    *out = *asked;
    if (out->kind == RITZ_DAMPING_NONE && text[0])
        RITZ_CHECK_IN("damping", ritz_damping_parse(text, out));
    *is_assumed = out->kind == RITZ_DAMPING_NONE && !matrices;
    if (*is_assumed)
        *out = unstated;
    return RITZ_OK;
}

ritz_status ritz_reference_new(const ritz_component *full,
                               const ritz_reference_request *request,
                               ritz_reference **out)
{
    ritz_reference_request own = *request;
    bool is_assumed = false;

    RITZ_CHECK(ritz_verify_band(own.band_hz, false));
    RITZ_CHECK(
        choose_damping(full, "", &request->damping, &own.damping, &is_assumed));
    return open_reference(full, &own, is_assumed, out);
}

int64_t ritz_reference_modes(const ritz_reference *reference, int64_t *rigid)
{
    int64_t count = 0;

    for (int64_t k = reference->poles.num_rigid; k < reference->poles.count;
         k++)
        count += ritz_in_band(reference->band_hz, reference->poles.lambda[k]);
    *rigid = reference->poles.num_rigid;
    return count;
}

const ritz_pairs *ritz_reference_pairs(const ritz_reference *reference)
{
    return &reference->pairs;
}

void ritz_reference_free(ritz_reference **reference)
{
    ritz_reference *r = *reference;

    if (!r)
        return;
    ritz_pairs_free(&r->pairs);
    ritz_poles_free(&r->poles);
    ritz_residual_free(&r->residual);
    ritz_damped_free(&r->damped);
    RITZ_FREE(r->part.scale, r->part.observable);
    ritz_dense_free(&r->gain);
    ritz_sweep_free(&r->own);
    ritz_sweep_free(&r->random);
    ritz_responder_free(&r->responder);
    free(r);
    *reference = NULL;
}

double ritz_highest_hertz(const ritz_columns *columns, int64_t count,
                          const double *lambda)
{
    double highest = 0.0;

    for (int64_t k = 0; columns && k < columns->count; k++)
        if (isfinite(columns->hertz[k]))
            highest = fmax(highest, columns->hertz[k]);
    if (highest == 0.0 && count > 0)
        highest = ritz_eigen_hertz(lambda[count - 1]);
    return highest;
}

/* Up to the highest mode below half of the highest frequency. */
static void choose_band(const ritz_poles *reduced, double highest,
                        const ritz_verify_request *request, double band[2])
{
    band[0] = request->band_hz[0];
    band[1] = request->band_hz[1];
    if (band[1] > 0.0)
        return;
    for (int64_t k = reduced->num_rigid; k < reduced->count; k++) {
        double hertz = ritz_eigen_hertz(reduced->lambda[k]);

        if (k == reduced->num_rigid || hertz <= 0.5 * highest)
            band[1] = hertz;
    }
    if (band[1] == 0.0)
        band[1] = fmax(1.0, 2.0 * band[0]); /* rigid bodies: any will do */
}

/* Its basis is dense and its modes are all there. */
static ritz_status open_sides(ritz_model reduced, const ritz_damping *damping,
                              double to_hz, ritz_sides *sides)
{
    const ritz_second_order *model = &reduced.dense;

    sides->model = *model;
    sides->component = reduced.reduced;
    RITZ_CHECK_IN("reduced model",
                  ritz_eigen_unchecked(model->K, model->M, &sides->small));
    return ritz_context(ritz_poles_of_modes(model, damping, to_hz,
                                            &sides->small, &sides->reduced),
                        "reduced model");
}

/* Every row of the table that exists for one of both pairs of models. */
static ritz_status measure_rows(const double *limit, const ritz_sides *sides,
                                const ritz_state_pair *states,
                                ritz_measures *out)
{
    const ritz_io *io = sides ? sides->model.io : NULL;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        ritz_measure m = {.value = nan(""), .limit = limit[k]};

        if (states && kind->of_states)
            RITZ_CHECK(kind->of_states(states, &m));
        if (sides && kind->of_modes &&
            !(kind->needs & RITZ_NEEDS_CHANNELS &&
              (io->num_inputs == 0 || io->num_outputs == 0)) &&
            !(kind->needs & RITZ_NEEDS_LIMIT && isnan(m.limit)))
            RITZ_CHECK(kind->of_modes(sides, &m));
        if (!isnan(m.value))
            RITZ_CHECK(
                ritz_measures_add(out, kind->name, m.value, m.limit, m.where));
    }
    return RITZ_OK;
}

/* Whether responses are to be compared. */
static bool needs_responses(const ritz_sides *sides)
{
    bool any = !(sides->where & RITZ_ONLY_LIMITED);

    for (int k = 0; k < RITZ_MEASURES && !any; k++)
        any = ritz_measure_table[k].needs & RITZ_NEEDS_BAND &&
              !isnan(sides->limit[k]);
    return any;
}

/* Whether static gains are to be compared. */
static bool needs_gain(const ritz_sides *sides)
{
    return !(sides->where & RITZ_ONLY_LIMITED) ||
           !isnan(sides->limit[RITZ_MEASURE_GAIN]);
}

/*
 * The measures of one model, whose poles are there already, against the full
 * one.
 *
 * @param[in,out] sides  with `reduced`, `small` and `full`
 */
static ritz_status measure_sides(const ritz_verify_request *limits,
                                 ritz_sides *sides, ritz_measures *out)
{
    const ritz_reference *full = sides->full;

    sides->limit = limits->limit;
    RITZ_CHECK_IN("reduced model",
                  ritz_damped_new(&sides->reduced, NULL, NULL, full->band_hz,
                                  &sides->damped_reduced));
    if (needs_gain(sides))
        RITZ_CHECK_IN("reduced model",
                      ritz_static_gain_of_modes(&sides->model, &sides->small,
                                                ritz_reference_rigid(full),
                                                &sides->gain_reduced));
    RITZ_CHECK(ritz_sides_match(sides));
    if (needs_responses(sides))
        RITZ_CHECK(ritz_sides_respond(sides));
    return measure_rows(limits->limit, sides, NULL, out);
}

static void ritz_sides_free(ritz_sides *sides)
{
    ritz_pairs_free(&sides->small);
    ritz_poles_free(&sides->reduced);
    ritz_dense_free(&sides->gain_reduced);
    ritz_damped_free(&sides->damped_reduced);
    RITZ_FREE(sides->match.partner, sides->match.mac, sides->match.taken);
}

/* It is of the same dofs, inputs and outputs. */
static ritz_status check_reduced(const ritz_component *full, ritz_model reduced)
{
    const ritz_reduced *r = reduced.reduced;

    RITZ_REFUSE_IF(r && r->num_dofs != full->num_dofs, RITZ_ERR_ARGUMENT,
                   "the reduced model comes from %" PRId64
                   " dofs, the full one has %" PRId64,
                   r->num_dofs, full->num_dofs);
    return ritz_verify_signals(ritz_model_of_component(full, NULL), reduced);
}

ritz_status ritz_reference_measure(const ritz_reference *reference,
                                   ritz_model reduced,
                                   const ritz_verify_request *limits, int where,
                                   ritz_measures *out)
{
    return ritz_reference_measure_parts(reference, reduced, NULL, limits, where,
                                        out);
}

/* Whether M, K and the damping are semidefinite. Of M that was a condition for
   the modes; damping without a matrix D acts on each mode by itself. */
static bool is_passive(const ritz_sides *sides)
{
    const ritz_pairs *modes = &sides->small;
    const ritz_dense *D = sides->model.D;
    bool passive = !D || !D->val;

    for (int64_t k = 0; k < sides->reduced.count; k++)
        passive = passive && sides->reduced.rate[k] >= 0.0;
    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++)
        passive = passive && modes->lambda[k] >= 0.0;
    return passive;
}

ritz_status ritz_reference_measure_parts(const ritz_reference *reference,
                                         ritz_model reduced,
                                         ritz_compared *compared,
                                         const ritz_verify_request *limits,
                                         int where, ritz_measures *out)
{
    RITZ_OWN(ritz_sides)
    sides = {.full = reference,
             .where = where,
             .parts = compared ? compared->parts : NULL};
    RITZ_OWN(ritz_measures) found = {0};

    RITZ_CHECK(check_reduced(reference->component, reduced));
    RITZ_CHECK(open_sides(reduced, &reference->damping, reference->band_hz[1],
                          &sides));
    RITZ_CHECK(measure_sides(limits, &sides, &found));
    if (compared) {
        compared->passive = is_passive(&sides);
        if (compared->keeps_modes)
            RITZ_MOVE(compared->modes, sides.small);
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

/* A measure that has a limit must exist. */
static ritz_status check_limits(const ritz_io *io,
                                const ritz_verify_request *request)
{
    for (int k = 0; k < RITZ_MEASURES; k++)
        RITZ_REFUSE_IF(
            !isnan(request->limit[k]) &&
                ritz_measure_table[k].needs & RITZ_NEEDS_CHANNELS &&
                (io->num_inputs == 0 || io->num_outputs == 0),
            RITZ_ERR_ARGUMENT,
            "a limit of '%s' needs inputs and outputs, and there are "
            "%" PRId64 " and %" PRId64,
            ritz_measure_table[k].name, io->num_inputs, io->num_outputs);
    return RITZ_OK;
}

/* The same with a reference of its own. */
static ritz_status verify_dense(const ritz_component *full, ritz_model model,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    const ritz_reduced *reduced = model.reduced;
    const double flexible = request->limit[RITZ_MEASURE_FLEXIBLE];
    ritz_reference_request asked = {.tolerance = flexible};
    RITZ_OWN(ritz_reference) *reference = NULL;
    RITZ_OWN(ritz_sides) sides = {.where = RITZ_AT_OTHER_POLES};
    bool is_assumed = false;

    RITZ_CHECK(check_reduced(full, model));
    RITZ_CHECK(check_limits(&full->io, request));
    RITZ_CHECK(choose_damping(full, reduced ? reduced->damping : "",
                              &request->damping, &asked.damping, &is_assumed));
    RITZ_CHECK(open_sides(model, &asked.damping, request->band_hz[1], &sides));
    choose_band(&sides.reduced,
                ritz_highest_hertz(reduced ? &reduced->columns : NULL,
                                   sides.reduced.count, sides.reduced.lambda),
                request, asked.band_hz);
    RITZ_CHECK(open_reference(full, &asked, is_assumed, &reference));
    sides.full = reference;
    return measure_sides(request, &sides, out);
}

static ritz_status verify_states(const ritz_state_space *full,
                                 const ritz_state_space *reduced,
                                 const ritz_verify_request *request,
                                 ritz_measures *out)
{
    RITZ_OWN(ritz_state_pair) p = {0};

    RITZ_REFUSE_IF(full->num_inputs == 0 || full->num_outputs == 0,
                   RITZ_ERR_ARGUMENT,
                   "there are no %s, nothing can be compared",
                   full->num_inputs == 0 ? "inputs" : "outputs");
    for (int k = 0; k < RITZ_MEASURES && request->band_hz[1] == 0.0; k++)
        RITZ_REFUSE_IF(!isnan(request->limit[k]) &&
                           ritz_measure_table[k].needs & RITZ_NEEDS_BAND,
                       RITZ_ERR_ARGUMENT,
                       "--limit-%s of a state space needs --band-hz",
                       ritz_measure_table[k].word);
    RITZ_CHECK(ritz_state_pair_new(full, reduced, request, &p));
    return measure_rows(request->limit, NULL, &p, out);
}

ritz_status ritz_verify(ritz_model full, ritz_model reduced,
                        const ritz_verify_request *request, ritz_measures *out)
{
    const bool states = full.kind == RITZ_MODEL_STATES;
    RITZ_OWN(ritz_measures) found = {0};

    RITZ_REFUSE_IF(full.kind == RITZ_MODEL_DENSE ||
                       reduced.kind !=
                           (states ? RITZ_MODEL_STATES : RITZ_MODEL_DENSE),
                   RITZ_ERR_ARGUMENT, "there is nothing to compare by");
    RITZ_CHECK(ritz_verify_band(request->band_hz, true));
    RITZ_CHECK(states
                   ? verify_states(full.states, reduced.states, request, &found)
                   : verify_dense(full.component, reduced, request, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}
