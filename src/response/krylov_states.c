/*
 * The krylov engine for state spaces. With V real and orthonormal
 * (E-orthonormal if E is symmetric and definite),
 *
 *     H_r = C V (i w V'E V - V'A V)^-1 V'B + D
 *
 * V spans eigenvectors of poles near the range, and real and imaginary parts of
 *
 *     (A - i w_k E)^-1 B,    (A - i w_k E)^-T C'
 *
 * at expansion points w_k. Since V contains both, H_r and its derivative equal
 * those of H at w_k [Grimme1997].
 *
 * The next point is the candidate at which H_r, relative to the error allowed
 * for each channel, changed most when V last grew. H_r is compared with the
 * full response there. The search ends when three comparisons in a row are
 * within the tolerance, or within rounding, and two more at the candidates
 * farthest from all points are as well. The error is therefore not proven, but
 * measured where it was expected to be largest and where nothing was known.
 */
#include "response/krylov_states.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"
#include "linear/resolvent.h"
#include "model/space.h"
#include "response/state_poles.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    EVEN = 200,       /* candidates spread evenly over the range */
    DECADES = 6,      /* decades of candidates towards the lower end of the
                         range */
    A_DECADE = 5,     /* candidates in each of these decades */
    IN_A_ROW = 3,     /* comparisons at candidates where H_r changed most */
    ELSEWHERE = 2,    /* comparisons at candidates far from all points */
    MOST_POINTS = 100 /* largest number of full responses */
};

typedef struct krylov_states {
    const ritz_state_space *model; /* borrowed */
    ritz_pencil pencil;
    bool plain; /* V is E-orthonormal: V'E V is the identity */
    ritz_poles poles;
    int64_t p, m, values; /* outputs, inputs, p m */
    ritz_orthonormal V;
    ritz_resolvent small;
    double tolerance, unmet;
    double rounding; /* largest rounding of a full response, relative to the
                        allowed error */
    int64_t count;   /* number of candidates */
    double *hertz;
    bool *used;
    double _Complex *H, *before; /* count x values, column-major as D */
    double *peak, *allowed;      /* values, row by row as H of engines */
    double _Complex *G;          /* values, work space */
    double *noise;               /* values: rounding of the last full
                                    response */
    bool infinite_at_rest;       /* 0 is a pole */
    int64_t points;
} krylov_states;

static void krylov_states_free(void *state)
{
    krylov_states *k = state;

    ritz_pencil_free(&k->pencil);
    ritz_poles_free(&k->poles);
    ritz_orthonormal_free(&k->V);
    ritz_resolvent_free(&k->small);
    RITZ_FREE(k->hertz, k->used, k->H, k->before, k->peak, k->allowed, k->G,
              k->noise);
}

/* Whether E is symmetric and positive definite, so that V can be
   E-orthonormal. */
static ritz_status is_definite(const ritz_pencil *pencil, bool *out)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    ritz_status status = RITZ_OK;

    *out = pencil->plain;
    if (pencil->plain || ritz_sparse_asymmetry(&pencil->E) > 0.0)
        return RITZ_OK;
    status = ritz_factor_spd(&pencil->E, &L);
    *out = status == RITZ_OK;
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

/* Candidates: evenly spread ones, ones towards the lower end, and frequencies
   of poles. */
static ritz_status place_candidates(krylov_states *k,
                                    const ritz_response_request *request)
{
    const double low = request->from_hz, high = request->to_hz;
    const double width = high - low;

    RITZ_CHECK_NEW(k->hertz, EVEN + DECADES * A_DECADE + k->poles.count);
    for (int j = 0; j < EVEN; j++)
        k->hertz[k->count++] = low + width * j / (EVEN - 1);
    for (int j = 1; j <= DECADES * A_DECADE; j++)
        k->hertz[k->count++] = low + width * pow(10.0, -(double)j / A_DECADE);
    for (int64_t j = 0; j < k->poles.count; j++) {
        double hertz = ritz_eigen_hertz(k->poles.lambda[j]);

        if (hertz > low && hertz < high)
            k->hertz[k->count++] = hertz;
    }
    RITZ_CHECK_NEW(k->used, k->count);
    RITZ_CHECK_NEW(k->H, k->count * k->values);
    RITZ_CHECK_NEW(k->before, k->count * k->values);
    RITZ_CHECK_NEW(k->peak, k->values);
    RITZ_CHECK_NEW(k->allowed, k->values);
    RITZ_CHECK_NEW(k->G, k->values);
    RITZ_CHECK_NEW(k->noise, k->values);
    return RITZ_OK;
}

/* Append real and imaginary parts of @p count vectors to V. */
static ritz_status append_parts(krylov_states *k, int64_t count,
                                const double _Complex *X)
{
    const int64_t n = k->pencil.n;
    RITZ_OWN(ritz_dense) parts = {0};

    RITZ_CHECK(ritz_dense_new(n, 2 * count, &parts));
    for (int64_t i = 0; i < n * count; i++) {
        parts.val[i] = creal(X[i]);
        parts.val[n * count + i] = cimag(X[i]);
    }
    return ritz_orthonormal_append(&k->V, &parts, n - k->V.count, NULL);
}

/* Project the model on V. */
static ritz_status renew_small(krylov_states *k)
{
    RITZ_OWN(ritz_dense) V = {0}, X = {0}, A = {0}, E = {0}, B = {0}, C = {0};

    RITZ_CHECK(ritz_dense_columns(&k->V.V, 0, k->V.count, &V));
    RITZ_CHECK(ritz_sparse_mul(&k->pencil.A, &V, &X));
    RITZ_CHECK(ritz_dense_mul_tn(&V, &X, &A));
    if (!k->plain) {
        RITZ_CHECK(ritz_sparse_mul(&k->pencil.E, &V, &X));
        RITZ_CHECK(ritz_dense_mul_tn(&V, &X, &E));
    }
    RITZ_CHECK(ritz_dense_mul_tn(&V, &k->model->B, &B));
    RITZ_CHECK(ritz_dense_mul(&k->model->C, &V, &C));
    ritz_resolvent_free(&k->small);
    return ritz_resolvent_new(&A, &E, &B, &C, &k->small);
}

/* Evaluate H_r at all candidates, and the error allowed for each channel. */
static ritz_status renew_candidates(krylov_states *k)
{
    RITZ_OWN_ARRAY double _Complex *z = NULL;

    RITZ_CHECK_NEW(z, k->count);
    RITZ_CHECK(renew_small(k));
    memcpy(k->before, k->H, (size_t)(k->count * k->values) * sizeof *k->H);
    for (int64_t c = 0; c < k->count; c++) {
        z[c] = ritz_complex(0.0, 2.0 * RITZ_PI * k->hertz[c]);
        for (int64_t v = 0; v < k->values; v++)
            k->H[c * k->values + v] = k->model->D.val[v];
    }
    RITZ_CHECK(ritz_resolvent_many(&k->small, k->count, z, k->H));
    for (int64_t c = 0; c < k->count; c++)
        for (int64_t v = 0; v < k->values; v++) {
            double size = cabs(k->H[c * k->values + v]);
            int64_t at = v % k->p * k->m + v / k->p;

            if (isfinite(size) && size > k->peak[at])
                k->peak[at] = size;
        }
    ritz_channel_scales(k->p, k->m, k->peak, k->allowed);
    for (int64_t v = 0; v < k->values; v++)
        k->allowed[v] *= k->tolerance;
    return RITZ_OK;
}

/* Largest difference of two responses beyond rounding, relative to the error
   allowed for its channel. */
static double worst_ratio(const krylov_states *k, const double _Complex *a,
                          const double _Complex *b, const double *noise)
{
    double worst = 0.0;

    for (int64_t v = 0; v < k->values; v++) {
        double off = cabs(a[v] - b[v]) - (noise ? noise[v] : 0.0);
        double may = k->allowed[v % k->p * k->m + v / k->p];

        if (off > 0.0 && !(off <= worst * may))
            worst = may > 0.0 ? off / may : HUGE_VAL;
    }
    return worst;
}

/* Least distance of a candidate from the points used so far  [Hz] */
static double distance_of(const krylov_states *k, int64_t c)
{
    double least = HUGE_VAL;

    for (int64_t j = 0; j < k->count; j++)
        if (k->used[j])
            least = fmin(least, fabs(k->hertz[j] - k->hertz[c]));
    return least;
}

/* The next candidate: the one at which H_r changed most, or the one farthest
   from all points; -1: none is left. */
static int64_t choose_next(const krylov_states *k, bool farthest)
{
    int64_t best = -1;
    double most = -1.0;

    for (int64_t c = 0; c < k->count; c++) {
        double worth = 0.0;

        if (k->used[c])
            continue;
        worth = farthest ? distance_of(k, c)
                         : worst_ratio(k, k->H + c * k->values,
                                       k->before + c * k->values, NULL);
        if (worth > most) {
            most = worth;
            best = c;
        }
    }
    return best;
}

/* X = [(A - s E)^-1 B, (A - s E)^-T C']. */
static ritz_status solve_both(krylov_states *k, double _Complex s,
                              double _Complex *X)
{
    const int64_t n = k->pencil.n;
    double _Complex *Y = X + n * k->m;

    for (int64_t i = 0; i < n * k->m; i++)
        X[i] = k->model->B.val[i];
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < k->p; i++)
            Y[j + i * n] = ritz_dense_col(&k->model->C, j)[i];
    RITZ_CHECK(ritz_pencil_factor(&k->pencil, s));
    RITZ_CHECK(ritz_pencil_solve(&k->pencil, false, k->m, X));
    return ritz_pencil_solve(&k->pencil, true, k->p, Y);
}

/* G = D - C X, column-major. */
static void respond_full(const krylov_states *k, const double _Complex *X)
{
    const int64_t n = k->pencil.n;

    for (int64_t j = 0; j < k->m; j++)
        for (int64_t i = 0; i < k->p; i++) {
            double _Complex sum = k->model->D.val[i + j * k->p];

            for (int64_t r = 0; r < n; r++)
                sum -= ritz_dense_col(&k->model->C, r)[i] * X[r + j * n];
            k->G[i + j * k->p] = sum;
        }
}

/* t += factor |A| |x|, entry by entry. */
static void add_magnitudes(const ritz_sparse *A, double factor,
                           const double _Complex *x, double *t)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t e = A->colptr[j]; e < A->colptr[j + 1]; e++)
            t[A->rowind[e]] += factor * fabs(A->val[e]) * cabs(x[j]);
}

/*
 * Rounding of the full response. Factors are exact for a matrix whose entries
 * differ by some eps of their size, so the rounding of H is some eps times
 * |y|'(|A| + w |E|)|x|.
 */
static ritz_status find_noise(krylov_states *k, double w,
                              const double _Complex *X)
{
    const int64_t n = k->pencil.n;
    RITZ_OWN_ARRAY double *t = NULL;

    RITZ_CHECK_NEW(t, n);
    for (int64_t j = 0; j < k->m; j++) {
        memset(t, 0, (size_t)n * sizeof *t);
        add_magnitudes(&k->pencil.A, 1.0, X + j * n, t);
        add_magnitudes(&k->pencil.E, w, X + j * n, t);
        for (int64_t i = 0; i < k->p; i++) {
            const double _Complex *y = X + (k->m + i) * n;
            double sum = 0.0;

            for (int64_t r = 0; r < n; r++)
                sum += cabs(y[r]) * t[r];
            k->noise[i + j * k->p] = RITZ_SUMMED_ROUNDING * DBL_EPSILON * sum;
        }
    }
    return RITZ_OK;
}

/* Update `rounding` by the rounding of a full response. */
static void note_rounding(krylov_states *k)
{
    for (int64_t v = 0; v < k->values; v++) {
        double may = k->allowed[v % k->p * k->m + v / k->p];

        if (may > 0.0)
            k->rounding = fmax(k->rounding, k->noise[v] / may);
    }
}

/*
 * Compare H_r with the full response at a candidate, and extend V by the latter
 * if the difference exceeds the tolerance. *held: the difference is within the
 * tolerance.
 */
static ritz_status try_candidate(krylov_states *k, int64_t c, bool *held)
{
    const double hertz = k->hertz[c];
    RITZ_OWN_ARRAY double _Complex *X = NULL;
    ritz_status status = RITZ_OK;
    double was = 0.0;

    RITZ_CHECK_NEW(X, k->pencil.n * (k->m + k->p));
    k->used[c] = true;
    status = solve_both(k, ritz_complex(0.0, 2.0 * RITZ_PI * hertz), X);
    if (status == RITZ_ERR_SINGULAR) { /* a pole: there is no response to
                                          compare with */
        k->infinite_at_rest = k->infinite_at_rest || hertz == 0.0;
        return RITZ_OK;
    }
    RITZ_CHECK(status);
    k->points++;
    respond_full(k, X);
    RITZ_CHECK(find_noise(k, 2.0 * RITZ_PI * hertz, X));
    was = worst_ratio(k, k->H + c * k->values, k->G, k->noise);
    *held = k->points > 1 && was <= 1.0;
    if (*held) {
        note_rounding(k);
        return RITZ_OK;
    }
    k->unmet = was;
    RITZ_CHECK(append_parts(k, k->m + k->p, X));
    return renew_candidates(k);
}

static ritz_status converge_space(krylov_states *k)
{
    int in_a_row = 0;

    while (in_a_row < IN_A_ROW + ELSEWHERE) {
        bool held = false, far = in_a_row >= IN_A_ROW;
        int64_t before = k->V.count, points = k->points;
        int64_t c = k->points == 0 ? 0 : choose_next(k, far);

        if (c < 0 || (k->points == 0 && k->used[c]))
            c = choose_next(k, true);
        if (c < 0 && in_a_row > 0)
            break;
        RITZ_REFUSE_IF(c < 0 || k->points >= MOST_POINTS, RITZ_ERR_CONVERGENCE,
                       "a space of %" PRId64
                       " vectors errs by %.1e of the largest response, not "
                       "%.1e: take the engine that factors at each point",
                       k->V.count, k->unmet * k->tolerance, k->tolerance);
        RITZ_CHECK(try_candidate(k, c, &held));
        if (k->points == points)
            continue; /* the candidate was a pole */
        in_a_row = held ? in_a_row + 1 : 0;
        if (!held && k->V.count == before && before == k->pencil.n)
            break; /* V spans the whole space */
        ritz_monitor_step("space of the response", k->V.count, 0);
    }
    return RITZ_OK;
}

static ritz_status begin_space(krylov_states *k,
                               const ritz_response_request *request)
{
    RITZ_OWN(ritz_near_poles) near = {0};

    RITZ_CHECK(ritz_poles_near(&k->pencil, request, &near));
    RITZ_CHECK(ritz_near_poles_list(&near, request, &k->poles));
    RITZ_CHECK(is_definite(&k->pencil, &k->plain));
    RITZ_CHECK(ritz_orthonormal_new(
        k->pencil.n, k->plain && !k->pencil.plain ? &k->pencil.E : NULL,
        RITZ_DEPENDENT, &k->V));
    RITZ_CHECK(place_candidates(k, request));
    RITZ_CHECK(append_parts(k, near.count, near.x));
    return renew_candidates(k);
}

static ritz_status start_states(const ritz_response_request *request,
                                krylov_states *k)
{
    k->model = request->model.states;
    k->p = k->model->num_outputs;
    k->m = k->model->num_inputs;
    k->values = k->p * k->m;
    k->tolerance =
        request->tolerance > 0.0 ? request->tolerance : RITZ_ENGINE_TOLERANCE;
    k->tolerance = fmax(k->tolerance, RITZ_PROJECTION_FLOOR);
    RITZ_CHECK(ritz_pencil_of_space(k->model, &k->pencil));
    RITZ_CHECK(begin_space(k, request));
    return converge_space(k);
}

/* Whether i w is a pole of the projected model, to rounding. */
static bool is_on_pole(const krylov_states *k, double w)
{
    if (w == 0.0)
        return k->infinite_at_rest;
    for (int64_t j = 0; j < k->small.n; j++) {
        double _Complex s = ritz_resolvent_pole(&k->small, j);

        if (cabs(ritz_complex(0.0, w) - s) <= RITZ_POLE_HIT * (w + cabs(s)))
            return true;
    }
    return false;
}

static ritz_status krylov_states_at(void *state, double hertz,
                                    double _Complex *H)
{
    krylov_states *k = state;
    const double w = 2.0 * RITZ_PI * hertz;

    if (is_on_pole(k, w))
        return ritz_refuse_pole(hertz == 0.0, hertz);
    for (int64_t v = 0; v < k->values; v++)
        k->G[v] = k->model->D.val[v];
    (void)ritz_resolvent_add(&k->small, ritz_complex(0.0, w), 0.0, k->G);
    for (int64_t i = 0; i < k->p; i++)
        for (int64_t j = 0; j < k->m; j++)
            H[i * k->m + j] = k->G[i + j * k->p];
    return RITZ_OK;
}

ritz_status ritz_krylov_states(const ritz_response_request *request,
                               ritz_responder *out)
{
    krylov_states *k = NULL;

    RITZ_CHECK_NEW(k, 1);
    out->state = k;
    out->free = krylov_states_free;
    out->poles = &k->poles;
    out->at = krylov_states_at;
    memcpy(out->damping, request->model.states->damping, sizeof out->damping);
    RITZ_CHECK(start_states(request, k));
    (void)snprintf(out->remark, sizeof out->remark,
                   "%" PRId64 " vectors, %" PRId64
                   " full responses, the last of which were met to %.1e%s",
                   k->V.count, k->points, fmax(k->rounding, 1.0) * k->tolerance,
                   k->rounding > 1.0 ? ", which is their rounding" : "");
    ritz_pencil_free(&k->pencil); /* large matrices are no longer needed */
    ritz_orthonormal_free(&k->V);
    return RITZ_OK;
}
