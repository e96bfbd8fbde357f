/*
 * Lowest pairs of a sparse pencil.
 *
 *     find     an engine of search_engines.c, most often Lanczos on
 *              (K - sigma M)^-1 M. sigma is 0 if the caller has a factor of K;
 *              otherwise sigma < 0, as K of a free body is singular
 *     polish   inverse iteration and Rayleigh-Ritz on what was found; if the
 *              residuals stay too large, block Lanczos finds the pairs anew
 *     prove    Sylvester: K - tau M has as many negative pivots as there are
 *              eigenvalues below tau. If exactly m are below a frequency, these
 *              are the m lowest pairs, even if an approximate value of one of
 *              them is above it
 *
 * sigma is a guess until modes are known. If it is much farther from the lowest
 * flexible eigenvalue than the requested ones are, theta of all of them are
 * nearly equal; if it is too near to zero, K - sigma M is singular.
 *
 * Held to: bars and membranes in closed form, free, clamped, with double modes
 * and with dofs without mass.
 */
#include "linear/eigen_sparse.h"
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/condensed.h"
#include "linear/enclosure.h"
#include "linear/factor.h"
#include "linear/first_shift.h"
#include "linear/general.h"
#include "linear/inertia.h"
#include "linear/requested.h"
#include "linear/residuals.h"
#include "linear/search_engines.h"
#include "linear/sharpen.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ATTEMPTS = 12, /* changes of sigma, and requests for more */
    BODY = 6,      /* rigid modes of one free body */
    GUESS = 20,    /* flexible modes requested first if they are not counted */
    BEHIND = RITZ_SEARCH_BEHIND,
    SPARE = 4,    /* the same after a mode was missed */
    MISSES = 3,   /* searches repeated as a count found more modes */
    POLISHES = 3, /* inverse iterations, most often one */
    STEPS = 4,    /* the same after substructures, most often three */
};

/* Median of K_jj / M_jj, and the columns of M that are not zero. */
static ritz_status survey_pencil(ritz_mode_search *s)
{
    const ritz_sparse *K = s->S.K, *M = s->S.M;
    RITZ_OWN_ARRAY double *ratio = NULL, *mass = NULL;
    double largest = 0.0;
    int64_t count = 0;

    RITZ_CHECK_NEW(ratio, K->nrow);
    RITZ_CHECK_NEW(mass, K->nrow);
    RITZ_CHECK_NEW(s->heavy, K->nrow);
    for (int64_t j = 0; j < K->nrow; j++) {
        double k = ritz_sparse_diagonal(K, j);
        double m = ritz_sparse_diagonal(M, j);
        bool heavy = false;

        for (int64_t p = M->colptr[j]; p < M->colptr[j + 1] && !heavy; p++)
            heavy = M->val[p] != 0.0;
        if (heavy)
            s->heavy[s->num_heavy++] = j;
        if (k > 0.0 && m > 0.0)
            ratio[count++] = k / m;
        mass[j] = m;
        largest = fmax(largest, m);
    }
    /* rounding of the largest may be negative */
    RITZ_CHECK(
        ritz_eigen_check_mass(K->nrow, mass, 0, -RITZ_RIGID_DIGITS * largest));
    qsort(ratio, (size_t)count, sizeof *ratio, ritz_ascending);
    s->typical = count > 0 ? ratio[count / 2] : 1.0;
    return RITZ_OK;
}

/* Residuals of s->found. If they are small, pairs that lost digits to
   cancellation in K x are computed again. */
static ritz_status assess_sharp(ritz_mode_search *s, double *worst)
{
    RITZ_OWN_ARRAY double *energy = NULL;

    RITZ_CHECK_NEW(energy, s->found.Phi.ncol);
    RITZ_CHECK(ritz_pairs_assess(s->S.K, s->S.M, &s->found, energy, worst));
    if (*worst <= RITZ_EIGEN_RESIDUAL)
        RITZ_CHECK(ritz_pairs_sharpen(s->S.K, s->S.M, energy, &s->found));
    return RITZ_OK;
}

/* Refine the vectors X until their residuals are small, and put the pairs into
   s->found, which takes over X and *lambda. *lambda NULL: eigenvalues are not
   known yet. */
static ritz_status refine_pairs(ritz_mode_search *s, ritz_dense *X,
                                double **lambda)
{
    const bool known = *lambda != NULL;
    double worst = HUGE_VAL;

    ritz_pairs_free(&s->found);
    RITZ_MOVE(s->found.Phi, *X);
    RITZ_MOVE(s->found.lambda, *lambda);
    if (!known)
        RITZ_CHECK_NEW(s->found.lambda, s->found.Phi.ncol);
    RITZ_CHECK_NEW(s->found.residual, s->found.Phi.ncol);
    if (known)
        RITZ_CHECK(assess_sharp(s, &worst));
    for (int k = 0; k < POLISHES && !(worst <= RITZ_EIGEN_RESIDUAL); k++) {
        if (!s->S.A)
            RITZ_CHECK(ritz_search_shift(s, s->S.sigma));
        RITZ_CHECK(
            ritz_vectors_polish(&s->S, &s->found.Phi, s->found.lambda, NULL));
        RITZ_CHECK(assess_sharp(s, &worst));
    }
    RITZ_REFUSE_IF(!(worst <= RITZ_EIGEN_RESIDUAL), RITZ_ERR_CONVERGENCE,
                   "a residual of %.1e stays above %.0e", worst,
                   RITZ_EIGEN_RESIDUAL);
    return RITZ_OK;
}

/* Where to look instead, once it is known how far the modes reach. */
static ritz_status shift_elsewhere(ritz_mode_search *s, double reach)
{
    double sigma = s->S.sigma;

    if (-sigma > fabs(reach))
        sigma = -fmax(fabs(reach), -sigma / 1e3);
    else if (isfinite(reach) && reach > -1e4 * sigma)
        sigma = -reach / 100.0;
    if (sigma == s->S.sigma || -sigma <= s->broken) {
        s->ask += s->ask / 2 + SPARE;
        return RITZ_OK;
    }
    return ritz_search_shift(s, sigma);
}

/* Whether s->found is of an engine that finds eigenvalues approximately. */
static bool is_approximate(const ritz_mode_search *s)
{
    return !s->all && s->engine->approximate;
}

/* How many of the pairs found were requested, by their values. Of approximate
   values up to a frequency these are as many as were counted below it: values
   are upper bounds, and one of them may be above the frequency. */
static int64_t end_by_value(const ritz_mode_search *s)
{
    const ritz_pairs *P = &s->found;

    if (!is_approximate(s) || s->span->modes >= 0 || s->span->uncounted)
        return ritz_pairs_wanted(P, s->span, s->limit);
    return ritz_pairs_whole(P,
                            s->target < P->Phi.ncol ? s->target : P->Phi.ncol);
}

/* Whether eigenvalue j of an approximate engine may be below the limit. */
static bool may_be_below(const ritz_mode_search *s, int64_t j)
{
    const ritz_pairs *P = &s->found;

    return j < P->num_rigid || P->lambda[j] * (1.0 - P->error[j]) <= s->limit;
}

/* How many of the pairs found were requested. Without a count, all that may be
   below a frequency are, as far as there are bounds: up to pair `at`. */
static int64_t end_requested(const ritz_mode_search *s, int64_t at)
{
    int64_t end = end_by_value(s);

    if (!is_approximate(s) || s->span->modes >= 0 || !s->span->uncounted)
        return end;
    while (end < at && may_be_below(s, end))
        end++;
    return ritz_pairs_whole(&s->found, end);
}

/* Index of the pair below which modes are counted. An approximate engine counts
   among the last of the additional modes, unless these are one cluster: bounds
   of eigenvalues far below a count are narrower. */
static int64_t gap_to_count(const ritz_mode_search *s)
{
    const ritz_pairs *P = &s->found;
    const int64_t end = end_by_value(s);
    int64_t at = end;

    if (s->all)
        return end;
    if (s->engine->approximate)
        at = ritz_pairs_gap(P, end + (P->Phi.ncol - end) / 2);
    return at > end && !ritz_pairs_clustered(P, at) ? at
                                                    : ritz_pairs_gap(P, end);
}

/* Bounds of errors of all pairs, if exactly `at` eigenvalues are below
   s->counted_at. *error := the largest of the pairs requested, infinite if
   s->counted_at is an eigenvalue. */
static ritz_status bound_errors(ritz_mode_search *s, int64_t at, double *error)
{
    const ritz_status status =
        ritz_pairs_bound(&s->found, &s->moments, s->S.sigma, s->counted_at, at);

    *error = HUGE_VAL;
    if (status == RITZ_ERR_SINGULAR)
        return RITZ_OK;
    RITZ_CHECK(status);
    *error = 0.0;
    for (int64_t j = 0; j < end_requested(s, at); j++)
        *error = fmax(*error, s->found.error[j]);
    return RITZ_OK;
}

/* *error := bound of errors of the pairs requested, if no mode is missing among
   the pairs found; 0 if more pairs are needed first. */
static ritz_status assess_pairs(ritz_mode_search *s, double *error)
{
    ritz_pairs *P = &s->found;
    int64_t at = 0;
    double worst = 0.0;

    *error = 0.0;
    RITZ_CHECK(ritz_pairs_assess(s->S.K, s->S.M, P, NULL, &worst));
    if (end_by_value(s) >= P->Phi.ncol)
        return RITZ_OK;
    at = gap_to_count(s);
    s->counted_at = ritz_pairs_between(P, at, 0.5);
    return bound_errors(s, at, error);
}

/* Inverse iterations until the bound of errors is small, or only the bound if
   the engine sets the moments itself. If it stays too large, s->found is empty,
   and the next search has smaller residuals or goes by slices. */
static ritz_status improve_pairs(ritz_mode_search *s, ritz_dense *X,
                                 double **lambda)
{
    const int steps = s->engine->bounded ? 1 : STEPS;
    ritz_pairs *P = &s->found;
    double error = 0.0;

    RITZ_MOVE(P->Phi, *X);
    RITZ_MOVE(P->lambda, *lambda);
    RITZ_CHECK_NEW(P->residual, P->Phi.ncol);
    for (int k = 0; k < steps; k++) {
        if (!s->engine->bounded)
            RITZ_CHECK(
                ritz_vectors_polish(&s->S, &P->Phi, P->lambda, &s->moments));
        RITZ_CHECK(assess_pairs(s, &error));
        if (error <= s->accuracy)
            return RITZ_OK;
    }
    ritz_search_better(s);
    ritz_pairs_free(P);
    return RITZ_OK;
}

/* Pairs from the vectors that an engine found. If they cannot be refined, the
   next search is by block Lanczos, and for more modes if this one was. */
static ritz_status settle_pairs(ritz_mode_search *s, ritz_dense *X,
                                double **lambda)
{
    const ritz_status status = is_approximate(s) ? improve_pairs(s, X, lambda)
                                                 : refine_pairs(s, X, lambda);
    const bool dependent = status == RITZ_ERR_CONVERGENCE ||
                           (status == RITZ_ERR_SINGULAR && s->S.A);

    if (!dependent || s->all || s->misses++ >= MISSES)
        return status;
    ritz_pairs_free(&s->found);
    if (s->engine->find == ritz_find_by_blocks)
        s->ask += s->ask / 2 + SPARE;
    s->engine = &ritz_search_reliable;
    return RITZ_OK;
}

/* Fill s->found; it is empty if sigma, the engine or the number asked had to
   change. */
static ritz_status find_pairs(ritz_mode_search *s)
{
    ritz_lanczos_end end = RITZ_LANCZOS_FOUND;
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    double reach = 0.0;

    if (!s->S.A)
        RITZ_CHECK(ritz_search_shift(s, s->S.sigma));
    ritz_pairs_free(&s->found);
    s->all =
        s->all || s->num_heavy <= s->size->small || s->ask + 21 > s->num_heavy;
    RITZ_REFUSE_IF(!s->all && ritz_sparse_max(s->S.K) == 0.0, RITZ_ERR_SINGULAR,
                   "the stiffness is zero: every motion is a rigid one");
    if (s->all)
        RITZ_CHECK(ritz_modes_condensed(&s->S, s->num_heavy, s->heavy, &X));
    else
        RITZ_CHECK(s->engine->find(s, &X, &lambda, &reach, &end));
    if (end == RITZ_LANCZOS_FOUND)
        RITZ_CHECK(settle_pairs(s, &X, &lambda));
    if (end == RITZ_LANCZOS_SLOW)
        RITZ_CHECK(shift_elsewhere(s, reach));
    if (end == RITZ_LANCZOS_EXHAUSTED)
        s->all = true;
    return RITZ_OK;
}

/*
 * A shift far beyond the first flexible mode blurs it: come closer where that
 * is possible. Up to RITZ_SHIFT_BLURRED times beyond it Lanczos still tells
 * modes apart at its tolerance, and a new start would cost as much again
 * (measured: half of all solves).
 */
static ritz_status come_closer(ritz_mode_search *s, bool *moved)
{
    const ritz_pairs *P = &s->found;
    double first = P->num_rigid < P->Phi.ncol ? P->lambda[P->num_rigid] : 0.0;

    *moved = first > 0.0 && s->S.sigma < -RITZ_SHIFT_BLURRED * first &&
             first > s->broken;
    if (*moved)
        RITZ_CHECK(ritz_search_shift(s, -first));
    return RITZ_OK;
}

/* Free the factor before the count makes its own; keep its order of rows. */
static ritz_status keep_order(ritz_mode_search *s)
{
    if (!s->order && s->S.A)
        RITZ_CHECK_COPY(s->order, ritz_factor_order(s->S.A), s->S.K->nrow);
    ritz_factor_free(&s->S.A);
    return RITZ_OK;
}

/* The number of modes below tau. */
static ritz_status count_at(const ritz_mode_search *s, double tau, int64_t *out)
{
    const int64_t *order = s->S.A ? ritz_factor_order(s->S.A) : s->order;
    RITZ_OWN(ritz_counter) *C = NULL;

    RITZ_CHECK(ritz_counter_new(s->S.K, s->S.M, order, &C));
    return ritz_counter_below(C, tau, out);
}

/* The number of modes below a value between pairs k - 1 and k. Where the factor
   for the count is singular, because the value is an eigenvalue, another value
   is taken. */
static ritz_status count_below(ritz_mode_search *s, int64_t k, int64_t *out)
{
    const double parts[] = {0.5, RITZ_COUNT_PLACE, 0.7};
    ritz_status status = RITZ_ERR_SINGULAR;

    RITZ_CHECK(keep_order(s));
    for (size_t i = 0; i < 3 && status == RITZ_ERR_SINGULAR; i++) {
        s->counted_at = ritz_pairs_between(&s->found, k, parts[i]);
        status = count_at(s, s->counted_at, out);
    }
    return status;
}

/* After a count: `missed` modes below lambda were not found. */
static ritz_status search_missed(ritz_mode_search *s, int64_t missed,
                                 double lambda)
{
    RITZ_REFUSE_IF(s->all || ++s->misses > MISSES, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes below %g Hz are not found", missed,
                   ritz_eigen_hertz(lambda));
    if (s->engine->approximate && (s->engine->bounded || s->misses > 1))
        ritz_search_better(s);
    s->ask += missed + SPARE + (s->misses > 1 ? s->ask / 2 : 0);
    return RITZ_OK;
}

/* Also without a factor: what the last call made of other pairs is void. */
static ritz_status lend_factor(const ritz_mode_search *s, int64_t end)
{
    if (!s->use)
        return RITZ_OK;
    return s->use->call(s->use->of, &s->found, end, s->S.A, s->S.sigma);
}

/* Count the modes below a value behind the first `end` pairs: whether none of
   them is missed. */
static ritz_status prove_lowest(ritz_mode_search *s, int64_t end, bool *done)
{
    const int64_t at = gap_to_count(s);
    int64_t count = at;

    RITZ_CHECK(lend_factor(s, end));
    if (s->found.Phi.ncol > 0 && !s->span->uncounted)
        RITZ_CHECK(count_below(s, at, &count));
    *done = count == at;
    if (count < at && is_approximate(s) && s->misses++ < MISSES) {
        ritz_search_better(s); /* the value is within a cluster */
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(count < at, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64, at,
                   count);
    if (!*done)
        return search_missed(s, count - at, s->counted_at);
    if (!is_approximate(s))
        return RITZ_OK;
    RITZ_CHECK(bound_errors(s, at, &s->error));
    *done = s->error <= s->accuracy;
    if (!*done)
        ritz_search_better(s);
    return RITZ_OK;
}

/* By number: whether all modes are found, and none below them is missed. */
static ritz_status prove_number(ritz_mode_search *s, int64_t *end, bool *done)
{
    const ritz_pairs *P = &s->found;

    *end = ritz_pairs_wanted(P, s->span, 0.0);
    if (*end >= P->Phi.ncol && !s->all) {
        s->ask += P->num_rigid + SPARE; /* no flexible mode was found yet */
        return RITZ_OK;
    }
    s->found.proven_to = P->Phi.ncol > 0
                             ? ritz_pairs_between(P, *end, RITZ_COUNT_PLACE)
                             : HUGE_VAL;
    if (s->span->uncounted)
        s->found.proven_to = (double)NAN;
    return prove_lowest(s, *end, done);
}

/* s->target := number of modes up to the frequency, or a guess if they are not
   to be counted. They are counted a little above the frequency, where no mode is
   expected, and in each further call at the next value above it. */
static ritz_status count_target(ritz_mode_search *s)
{
    const double above[] = RITZ_COUNT_ABOVE;
    const double lambda = ritz_eigen_lambda(s->span->up_to_hz);
    ritz_status status = RITZ_ERR_SINGULAR;

    s->limit = lambda * (1.0 + above[0]);
    s->target = BODY + GUESS;
    if (s->span->uncounted)
        return RITZ_OK;
    while (status == RITZ_ERR_SINGULAR && s->limits < 3) {
        s->limit = lambda * (1.0 + above[s->limits++]);
        status = count_at(s, s->limit, &s->target);
    }
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "modes up to %g Hz cannot be counted: several lie there",
                   s->span->up_to_hz);
    return status;
}

/* By frequency, without a count: whether a pair above it was found. */
static ritz_status end_uncounted(ritz_mode_search *s, int64_t *end, bool *done)
{
    const int64_t count = s->found.Phi.ncol;
    const int64_t at = is_approximate(s) ? gap_to_count(s) : count;

    s->found.proven_to = (double)NAN;
    *end = end_requested(s, at);
    *done = *end < at || s->all;
    s->ask *= *done ? 1 : 2;
    s->error = 0.0;
    for (int64_t j = 0; *done && s->found.error && j < *end; j++)
        s->error = fmax(s->error, s->found.error[j]);
    return *done ? lend_factor(s, *end) : RITZ_OK;
}

/* By frequency: are there as many as counted before? If values are approximate,
   a second count among the additional modes shows that none of the lowest is
   missed. */
static ritz_status prove_frequency(ritz_mode_search *s, int64_t *end,
                                   bool *done)
{
    const ritz_pairs *P = &s->found;
    int64_t below = 0;

    if (s->span->uncounted)
        return end_uncounted(s, end, done);
    while (ritz_pairs_unclear(P, s->limit))
        RITZ_CHECK(count_target(s));
    while (below < P->Phi.ncol && P->lambda[below] <= s->limit)
        below++;
    RITZ_REFUSE_IF(below > s->target, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64,
                   below, s->target);
    *end = end_by_value(s);
    s->found.proven_to = s->limit;
    if (is_approximate(s) && *end < P->Phi.ncol)
        return prove_lowest(s, *end, done);
    if (is_approximate(s)) {
        s->ask += SPARE; /* a cluster ends beyond the pairs found */
        return RITZ_OK;
    }
    *done = below == s->target;
    return *done ? lend_factor(s, *end)
                 : search_missed(s, s->target - below, s->limit);
}

/* Search until the pairs that were found are proven to be all; *end of them
   are requested. */
static ritz_status search_proven(ritz_mode_search *s, int64_t *end)
{
    bool done = false;
    bool moved = false;

    for (int k = 0; k < ATTEMPTS && !done; k++) {
        RITZ_CHECK(find_pairs(s));
        if (!s->found.lambda)
            continue;
        RITZ_CHECK(come_closer(s, &moved));
        if (moved)
            continue;
        if (s->span->modes < 0)
            RITZ_CHECK(prove_frequency(s, end, &done));
        else
            RITZ_CHECK(prove_number(s, end, &done));
    }
    RITZ_REFUSE_IF(!done, RITZ_ERR_CONVERGENCE,
                   "the iteration for %" PRId64 " modes does not converge",
                   s->ask);
    return RITZ_OK;
}

/* With a factor of K there are no rigid modes, and sigma = 0 is kept. */
static ritz_status begin_search(ritz_mode_search *s)
{
    double sigma = 0.0;

    RITZ_CHECK(survey_pencil(s));
    s->ask = (s->S.A ? 0 : BODY) + s->span->modes + BEHIND;
    if (s->span->modes < 0) {
        RITZ_CHECK(count_target(s));
        s->ask = s->target + BEHIND;
    }
    if (s->S.A)
        return RITZ_OK;
    RITZ_CHECK(ritz_first_shift(s->S.K, s->typical, s->ask, &sigma));
    if (s->span->modes < 0)
        sigma = fmax(fmin(sigma, 0.1 * s->limit),
                     RITZ_LEAST_SHIFT * RITZ_FIRST_SHIFT * s->typical);
    return ritz_search_shift(s, -sigma);
}

static void name_engine(ritz_mode_search *s)
{
    char error[48] = "";

    if (is_approximate(s)) /* rounded up */
        snprintf(error, sizeof error, ", eigenvalues within %.1e%s",
                 1.05 * s->error,
                 s->span->uncounted ? " if none is missed" : "");
    snprintf(s->found.engine, sizeof s->found.engine, "%s%s",
             s->all ? "condensed LAPACK" : s->engine->name, error);
}

/* The largest relative error of eigenvalues, of an approximate engine. One that
   a test has set for auto is to be as accurate as it can. */
static double accuracy_of(const ritz_span *span)
{
    if (span->accuracy > 0.0)
        return span->accuracy;
    return span->engine == RITZ_EIGEN_AUTO ? RITZ_ACCURACY_LEAST
                                           : RITZ_AMLS_ERROR;
}

ritz_status ritz_eigen_search(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_eigen_given *given,
                              const ritz_span *span, const ritz_factor_use *use,
                              ritz_pairs *out)
{
    RITZ_OWN(ritz_mode_search)
    s = {.span = span,
         .S = {.K = K, .M = M},
         .engine = ritz_search_engine_of(span),
         .size = given && given->size ? given->size : ritz_trial_here(),
         .use = use,
         .accuracy = accuracy_of(span)};
    int64_t end = 0;

    s.settled = RITZ_ACCURACY_SETTLED * sqrt(s.accuracy);
    if (given) {
        if (given->L)
            RITZ_MOVE(s.S.A, *given->L);
        s.own[0] = given->K;
        s.own[1] = given->M;
    }
    RITZ_CHECK(begin_search(&s));
    ritz_search_choose(&s);
    RITZ_CHECK(search_proven(&s, &end));
    ritz_pairs_truncate(&s.found, end);
    ritz_dense_orient(&s.found.Phi);
    s.found.sigma = s.S.sigma;
    name_engine(&s);
    s.found.reason = s.all || s.engine != s.chosen ? NULL : s.reason;
    RITZ_MOVE(*out, s.found);
    return RITZ_OK;
}

ritz_status ritz_eigen_refuse_accuracy(const ritz_span *span)
{
    if (span->accuracy == 0.0)
        return RITZ_OK;
    RITZ_REFUSE_IF(!(span->accuracy >= RITZ_ACCURACY_LEAST &&
                     span->accuracy <= RITZ_ACCURACY_MOST),
                   RITZ_ERR_ARGUMENT,
                   "an accuracy of %g is not between 1e-8 and 1e-2",
                   span->accuracy);
    RITZ_REFUSE_IF(!ritz_search_engine_of(span)->approximate, RITZ_ERR_ARGUMENT,
                   "modes by %s have no accuracy to choose",
                   ritz_search_engine_of(span)->name);
    return RITZ_OK;
}
