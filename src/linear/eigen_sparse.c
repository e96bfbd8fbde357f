/*
 * Lowest pairs of a sparse pencil.
 *
 *     find     Lanczos on (K - sigma M)^-1 M, sigma < 0: K alone is singular
 *              for a free body, and sigma = 0 loses one of a double mode
 *     polish   inverse iteration and Rayleigh-Ritz on what was found
 *     prove    Sylvester: K - tau M has as many negative pivots as there are
 *              eigenvalues below tau
 *
 * sigma is a guess until modes are known. It should lie no further from the
 * lowest flexible mode than the modes asked for: further, and they look alike;
 * too near to zero, and K - sigma M is singular.
 *
 * Held to: bars and membranes in closed form, free, clamped, with double modes
 * and with dofs without mass.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/shifted.h"

#include <ritz/base.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    SMALL = 600,   /* dofs, or dofs with mass: dense is faster */
    MEDIUM = 4000, /* dense where a quarter of all modes is wanted */
    ATTEMPTS = 12, /* changes of sigma, and requests for more */
    BODY = 6,      /* rigid modes of one free body */
    SPARE = 4,     /* modes asked for beyond those needed */
    MISSES = 3,
    POLISHES = 3, /* inverse iterations, most often one */
};

typedef struct search {
    const ritz_span *span;
    double limit;   /* of lambda by frequency, a little above */
    int64_t target; /* modes below limit */
    ritz_shifted S;
    ritz_survey seen;
    double broken; /* -sigma at which the factor broke down */
    int64_t ask;
    int64_t misses; /* how often the count found more */
    bool all;       /* found holds every finite mode */
    ritz_pairs found;
} search;

static bool is_clustered(double a, double b)
{
    return fabs(b - a) <= RITZ_CLUSTER_GAP * fmax(fabs(a), fabs(b));
}

/* How many of the pairs were asked for. */
static int64_t wanted(const ritz_pairs *P, const ritz_span *span, double limit)
{
    int64_t end = P->num_rigid + (span->modes < 0 ? 0 : span->modes);
    int64_t count = P->Phi.ncol;

    if (span->modes < 0)
        for (end = P->num_rigid; end < count && P->lambda[end] <= limit;)
            end++;
    end = end < count ? end : count;
    while (end > 0 && end < count &&
           is_clustered(P->lambda[end - 1], P->lambda[end]))
        end++;
    return end;
}

/* Keep the first @p end pairs. */
static void truncate_pairs(ritz_pairs *P, int64_t end)
{
    P->Phi.ncol = end;
    P->num_rigid = P->num_rigid < end ? P->num_rigid : end;
}

/* Factor K - sigma M in place of what was factored before. */
static ritz_status shift_to(search *s, double sigma)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};

    ritz_factor_free(&s->S.A); /* two at once may not fit */
    ritz_monitor_step("factor", 0, 0);
    RITZ_TRY(ritz_sparse_add(1.0, s->S.K, -sigma, s->S.M, &A));
    status = ritz_factor_spd(&A, &s->S.A);
    if (status == RITZ_ERR_SINGULAR)
        s->broken = fmax(s->broken, -sigma);
    s->S.sigma = sigma;
done:
    ritz_sparse_free(&A);
    return status;
}

/* Shift and factor; the shift moves further away while the factor breaks
   down. */
static ritz_status shift_near(search *s, double sigma)
{
    ritz_status status = shift_to(s, sigma);

    while (status == RITZ_ERR_SINGULAR && -sigma < 1e3 * s->seen.typical) {
        sigma *= 100.0;
        status = shift_to(s, sigma);
    }
    if (status == RITZ_ERR_SINGULAR)
        ritz_record("stiffness and mass together are not positive definite, "
                    "is there a mechanism without mass?");
    return status;
}

/* s->found from the vectors in X, which it takes. */
static ritz_status refine_pairs(search *s, ritz_dense *X)
{
    double worst = HUGE_VAL;

    ritz_pairs_free(&s->found);
    s->found.Phi = *X;
    *X = (ritz_dense){0};
    RITZ_CHECK_NEW(s->found.lambda, s->found.Phi.ncol);
    RITZ_CHECK_NEW(s->found.residual, s->found.Phi.ncol);
    for (int k = 0; k < POLISHES && !(worst <= RITZ_EIGEN_RESIDUAL); k++) {
        RITZ_CHECK(ritz_shifted_polish(&s->S, &s->found.Phi, s->found.lambda));
        worst = ritz_shifted_assess(&s->S, &s->found);
    }
    RITZ_REFUSE_IF(!(worst <= RITZ_EIGEN_RESIDUAL), RITZ_ERR_CONVERGENCE,
                   "a residual of %.1e stays above %.0e", worst,
                   RITZ_EIGEN_RESIDUAL);
    return RITZ_OK;
}

/* Where to look instead, once it is known how far the modes reach. */
static ritz_status shift_elsewhere(search *s, double reach)
{
    double sigma = s->S.sigma;

    if (-sigma > fabs(reach))
        sigma = -fmax(fabs(reach), -sigma / 1e3);
    else if (reach > -1e4 * sigma)
        sigma = -reach / 100.0;
    if (sigma == s->S.sigma || -sigma <= s->broken) {
        s->ask += s->ask / 2 + SPARE;
        return RITZ_OK;
    }
    return shift_near(s, sigma);
}

/* Fill s->found; it is empty if sigma or the number asked had to change. */
static ritz_status find_pairs(search *s)
{
    ritz_lanczos_end end = RITZ_LANCZOS_FOUND;
    RITZ_OWN(ritz_dense) X = {0};
    double reach = 0.0;

    ritz_pairs_free(&s->found);
    s->all =
        s->all || s->seen.num_heavy <= SMALL || s->ask + 21 > s->seen.num_heavy;
    if (s->all)
        RITZ_CHECK(
            ritz_condensed_all(&s->S, s->seen.num_heavy, s->seen.heavy, &X));
    else
        RITZ_CHECK(ritz_lanczos_lowest(&s->S, s->ask, &X, &reach, &end));
    if (end == RITZ_LANCZOS_FOUND)
        RITZ_CHECK(refine_pairs(s, &X));
    if (end == RITZ_LANCZOS_SLOW)
        RITZ_CHECK(shift_elsewhere(s, reach));
    if (end == RITZ_LANCZOS_EXHAUSTED)
        s->all = true;
    return RITZ_OK;
}

/*
 * A shift far beyond the first flexible mode blurs it: come closer where that
 * is possible. Up to RITZ_SHIFT_BLURRED times beyond it Lanczos still tells
 * modes apart at its tolerance, and to begin anew would cost as much again
 * (measured: half of all solves).
 */
static ritz_status come_closer(search *s, bool *moved)
{
    const ritz_pairs *P = &s->found;
    double first = P->num_rigid < P->Phi.ncol ? P->lambda[P->num_rigid] : 0.0;

    *moved = first > 0.0 && s->S.sigma < -RITZ_SHIFT_BLURRED * first &&
             first > s->broken;
    if (*moved)
        RITZ_CHECK(shift_near(s, -first));
    return RITZ_OK;
}

/* The widest relative gap at or behind @p end, to count modes below it. */
static int64_t widest_gap(const ritz_pairs *P, int64_t end)
{
    double widest = 0.0;
    int64_t at = end;

    for (int64_t k = end > 0 ? end : 1; k < P->Phi.ncol; k++) {
        double gap = (P->lambda[k] - P->lambda[k - 1]) / fabs(P->lambda[k]);

        if (gap > widest) {
            widest = gap;
            at = k;
        }
    }
    return at;
}

/* A place between pairs k - 1 and k, part of the way. */
static double place_between(const ritz_pairs *P, int64_t k, double part)
{
    double above = k < P->Phi.ncol ? P->lambda[k] : HUGE_VAL;
    double below = k > 0 ? P->lambda[k - 1] : above - fabs(above) - DBL_MIN;

    if (k == P->Phi.ncol)
        above = below + fabs(below) + DBL_MIN;
    return below + part * (above - below);
}

/* Modes below a place between pairs k - 1 and k, none of which it may hit. */
static ritz_status count_below(const search *s, int64_t k, int64_t *out)
{
    const double parts[] = {0.5, RITZ_COUNT_PLACE, 0.7};
    ritz_status status = RITZ_ERR_SINGULAR;

    for (size_t i = 0; i < 3 && status == RITZ_ERR_SINGULAR; i++)
        status = ritz_eigen_count(s->S.K, s->S.M,
                                  place_between(&s->found, k, parts[i]), out);
    return status;
}

/* Ask for more, as so many were missed or are needed to see a gap behind. */
static ritz_status ask_more(search *s, int64_t more)
{
    double hertz = ritz_eigen_hertz(s->found.lambda[s->found.Phi.ncol - 1]);

    RITZ_REFUSE_IF(s->all || s->misses > MISSES, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes below %g Hz are not found", more, hertz);
    s->ask += more + SPARE;
    return RITZ_OK;
}

/* Modes asked for by number: whether all are found, and none below them is
   missed. */
static ritz_status prove_number(search *s, int64_t *end, bool *done)
{
    const ritz_pairs *P = &s->found;
    int64_t count = 0;
    int64_t at = 0;

    *end = wanted(P, s->span, 0.0);
    if (*end >= P->Phi.ncol && !s->all) {
        s->ask += P->num_rigid + SPARE; /* there is no end of rigid modes yet */
        return RITZ_OK;
    }
    at = s->all ? *end : widest_gap(P, *end);
    if (P->Phi.ncol > 0)
        RITZ_CHECK(count_below(s, at, &count));
    RITZ_REFUSE_IF(count < at, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64, at,
                   count);
    *done = count == at;
    s->found.proven_to =
        P->Phi.ncol > 0 ? place_between(P, *end, RITZ_COUNT_PLACE) : HUGE_VAL;
    if (!*done) {
        s->misses++;
        RITZ_CHECK(ask_more(s, count - at));
    }
    return RITZ_OK;
}

/* By frequency: are there as many as counted before? */
static ritz_status prove_frequency(search *s, int64_t *end, bool *done)
{
    const ritz_pairs *P = &s->found;
    int64_t below = 0;

    while (below < P->Phi.ncol && P->lambda[below] <= s->limit)
        below++;
    *end = wanted(P, s->span, s->limit);
    RITZ_REFUSE_IF(below > s->target, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64,
                   below, s->target);
    *done = below == s->target;
    s->found.proven_to = s->limit;
    if (!*done) {
        s->misses++;
        RITZ_CHECK(ask_more(s, s->target - below));
    }
    return RITZ_OK;
}

/* Search until what was found is proven; *end of the pairs are wanted. */
static ritz_status search_proven(search *s, int64_t *end)
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

/* Modes up to the frequency, counted a little above it lest one lie there. */
static ritz_status count_target(search *s)
{
    const double above[] = RITZ_COUNT_ABOVE;
    ritz_status status = RITZ_ERR_SINGULAR;
    double lambda = ritz_eigen_lambda(s->span->up_to_hz);

    for (size_t i = 0; i < 3 && status == RITZ_ERR_SINGULAR; i++) {
        s->limit = lambda * (1.0 + above[i]);
        status = ritz_eigen_count(s->S.K, s->S.M, s->limit, &s->target);
    }
    return status;
}

static ritz_status begin_search(search *s)
{
    double sigma = 0.0;

    RITZ_CHECK(ritz_shifted_survey(s->S.K, s->S.M, &s->seen));
    sigma = RITZ_FIRST_SHIFT * s->seen.typical;
    s->ask = BODY + s->span->modes + s->span->modes / 10 + SPARE;
    if (s->span->modes < 0) {
        RITZ_CHECK(count_target(s));
        s->ask = s->target + SPARE;
        sigma = fmax(fmin(sigma, 0.1 * s->limit), RITZ_LEAST_SHIFT * sigma);
    }
    return shift_near(s, -sigma);
}

static ritz_status by_lanczos(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    search s = {.span = span, .S = {.K = K, .M = M}};
    int64_t end = 0;

    RITZ_TRY(begin_search(&s));
    RITZ_TRY(search_proven(&s, &end));
    truncate_pairs(&s.found, end);
    ritz_dense_orient(&s.found.Phi);
    s.found.sigma = s.S.sigma;
    snprintf(s.found.engine, sizeof s.found.engine, "%s",
             s.all ? "condensed LAPACK" : "ARPACK");
    *out = s.found;
    s.found = (ritz_pairs){0};
done:
    free(s.seen.heavy);
    ritz_factor_free(&s.S.A);
    ritz_pairs_free(&s.found);
    return status;
}

/* Every mode, which proves itself; then those that are wanted. */
static ritz_status by_lapack(const ritz_sparse *K, const ritz_sparse *M,
                             const ritz_span *span, ritz_pairs *out)
{
    RITZ_OWN(ritz_pairs) P = {0};
    RITZ_OWN(ritz_dense) K_d = {0}, M_d = {0};
    double limit = 0.0;
    int64_t end = 0;

    RITZ_CHECK(ritz_sparse_dense(K, &K_d));
    RITZ_CHECK(ritz_sparse_dense(M, &M_d));
    RITZ_CHECK(ritz_eigen_dense(&K_d, &M_d, &P));
    if (span->modes < 0)
        limit = ritz_eigen_lambda(span->up_to_hz) * (1.0 + RITZ_SPAN_ROUNDING);
    end = wanted(&P, span, limit);
    if (end < P.Phi.ncol) /* limit is 0 by number, and below the next mode */
        P.proven_to = fmax(limit, place_between(&P, end, RITZ_COUNT_PLACE));
    truncate_pairs(&P, end);
    RITZ_MOVE(*out, P);
    return RITZ_OK;
}

ritz_status ritz_eigen_sparse(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out)
{
    int64_t n = K->nrow;

    RITZ_REFUSE_IF(K->ncol != n || M->nrow != n || M->ncol != n,
                   RITZ_ERR_ARGUMENT,
                   "stiffness is %" PRId64 " x %" PRId64 " but mass %" PRId64
                   " x %" PRId64,
                   K->nrow, K->ncol, M->nrow, M->ncol);
    RITZ_REFUSE_IF(span->modes < -1, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes cannot be asked for", span->modes);
    RITZ_REFUSE_IF(span->modes < 0 &&
                       !(span->up_to_hz > 0.0 && isfinite(span->up_to_hz)),
                   RITZ_ERR_ARGUMENT, "modes up to %g Hz cannot be asked for",
                   span->up_to_hz);
    if (n <= SMALL || (n <= MEDIUM && span->modes > n / 4))
        RITZ_CHECK(by_lapack(K, M, span, out));
    else
        RITZ_CHECK(by_lanczos(K, M, span, out));
    return RITZ_OK;
}
