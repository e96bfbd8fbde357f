/*
 * Lowest pairs of a sparse pencil.
 *
 *     find     Lanczos on (K - sigma M)^-1 M. sigma is 0 if the caller has a
 *              factor of K; otherwise sigma < 0, as K of a free body is singular
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
#include "base/memory.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/amls.h"
#include "linear/block_lanczos.h"
#include "linear/condensed.h"
#include "linear/density.h"
#include "linear/enclosure.h"
#include "linear/factor.h"
#include "linear/first_shift.h"
#include "linear/general.h"
#include "linear/inertia.h"
#include "linear/requested.h"
#include "linear/residuals.h"
#include "linear/sharpen.h"
#include "linear/slices.h"
#include "linear/trial.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ATTEMPTS = 12, /* changes of sigma, and requests for more */
    BODY = 6,      /* rigid modes of one free body */
    GUESS = 20,    /* flexible modes requested first if they are not counted */
    ROUGH_PART = 50, /* with an accuracy, block Lanczos finds k + k / ROUGH_PART
                        + ROUGH_MORE modes for k, to have a gap to count in */
    ROUGH_MORE = 8,
    GUARD = 2,    /* substructures find k + k / GUARD + GUARD modes for k */
    BEHIND = 2,   /* modes requested above those wanted: a gap to count in */
    SPARE = 4,    /* the same after a mode was missed */
    MISSES = 3,   /* searches repeated as a count found more modes */
    POLISHES = 3, /* inverse iterations, most often one */
    STEPS = 4,    /* the same after substructures, most often three */
};

typedef struct engine engine;

typedef struct search {
    const ritz_span *span;
    double limit;   /* of lambda by frequency, a little above */
    int limits;     /* how many of RITZ_COUNT_ABOVE were tried */
    int64_t target; /* modes below limit */
    ritz_shifted S;
    ritz_sparse *own[2]; /* K and M, if they may be folded; NULL: not */
    int64_t *order;      /* fill-reducing order of the factor, for the count */
    double typical;      /* median of K_jj / M_jj, 1 if there is none */
    int64_t *heavy;      /* columns of M that are not zero */
    int64_t num_heavy;
    double broken; /* -sigma at which the factor broke down */
    int64_t ask;
    int64_t misses; /* how often the count found more */
    bool all;       /* found holds every finite mode */
    const engine *engine;
    const ritz_trial *size;
    const ritz_factor_use *use; /* of the factor before the count, or NULL */
    ritz_pairs found;
    ritz_moments moments; /* of what found.Phi was before its last iteration;
                             empty unless the engine is approximate */
    double counted_at;    /* modes were counted below this, or are to be */
    double error;         /* bound of relative errors of eigenvalues */
    double accuracy;      /* its limit */
    double settled;       /* residual at which pairs of block Lanczos have
                             converged for that accuracy */
} search;

static void search_free(search *s)
{
    RITZ_FREE(s->heavy, s->order);
    ritz_factor_free(&s->S.A);
    ritz_pairs_free(&s->found);
    ritz_moments_free(&s->moments);
}

/* Median of K_jj / M_jj, and the columns of M that are not zero. */
static ritz_status survey_pencil(search *s)
{
    const ritz_sparse *K = s->S.K, *M = s->S.M;
    RITZ_OWN_ARRAY double *ratio = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(ratio, K->nrow);
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
    }
    qsort(ratio, (size_t)count, sizeof *ratio, ritz_ascending);
    s->typical = count > 0 ? ratio[count / 2] : 1.0;
    return RITZ_OK;
}

/* Factor K - sigma M in place of what was factored before. */
static ritz_status shift_to(search *s, double sigma)
{
    RITZ_OWN(ritz_sparse) A = {0};
    ritz_status status = RITZ_OK;

    ritz_factor_free(&s->S.A); /* two at once may not fit */
    RITZ_CHECK(ritz_sparse_add(1.0, s->S.K, -sigma, s->S.M, &A));
    status = ritz_factor_spd(&A, &s->S.A);
    if (status == RITZ_ERR_SINGULAR)
        s->broken = fmax(s->broken, -sigma);
    s->S.sigma = sigma;
    return status;
}

/* Shift and factor; the shift moves further away while the factor breaks
   down. */
static ritz_status shift_near(search *s, double sigma)
{
    ritz_status status = shift_to(s, sigma);

    while (status == RITZ_ERR_SINGULAR && -sigma < 1e3 * s->typical) {
        sigma = fmin(100.0 * sigma, -RITZ_FIRST_SHIFT * s->typical);
        status = shift_to(s, sigma);
    }
    if (status == RITZ_ERR_SINGULAR)
        ritz_record("stiffness and mass together are not positive definite, "
                    "is there a mechanism without mass?");
    return status;
}

/* Residuals of s->found. If they are small, pairs that lost digits to
   cancellation in K x are computed again. */
static ritz_status assess_sharp(search *s, double *worst)
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
static ritz_status refine_pairs(search *s, ritz_dense *X, double **lambda)
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
            RITZ_CHECK(shift_near(s, s->S.sigma));
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
static ritz_status shift_elsewhere(search *s, double reach)
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
    return shift_near(s, sigma);
}

/* A method to find the s->ask lowest pairs with the factor s->S.A. */
struct engine {
    const char *name;
    bool approximate; /* eigenvalues to s->accuracy only */
    bool bounded;     /* it sets s->moments; if it is approximate and does not,
                         inverse iterations set them */
    /** *lambda stays NULL if the method gives vectors alone. If *end is SLOW,
     * *reach is set as by ritz_lanczos_lowest(). */
    ritz_status (*find)(search *s, ritz_dense *X, double **lambda,
                        double *reach, ritz_lanczos_end *end);
};

static ritz_status find_by_blocks(search *s, ritz_dense *X, double **lambda,
                                  double *reach, ritz_lanczos_end *end)
{
    ritz_lanczos_plan plan = {
        .k = s->ask, .fold = {s->own[0], s->own[1]}, .next = *reach};

    RITZ_CHECK(ritz_block_lanczos(&s->S, &plan, X, lambda, end));
    *reach = plan.next;
    return RITZ_OK;
}

static ritz_status find_by_arpack(search *s, ritz_dense *X, double **lambda,
                                  double *reach, ritz_lanczos_end *end)
{
    (void)lambda;
    return ritz_lanczos_lowest(&s->S, s->ask, X, reach, end);
}

static const engine reliable = {.name = "block Lanczos",
                                .find = find_by_blocks};

/* More modes than requested are found, so that modes can be counted in the widest
   gap between the additional ones: the wider it is, the smaller is the bound. */
static ritz_status find_roughly(search *s, ritz_dense *X, double **lambda,
                                double *reach, ritz_lanczos_end *end)
{
    ritz_lanczos_plan plan = {.k = s->ask + s->ask / ROUGH_PART + ROUGH_MORE,
                              .settled = s->settled,
                              .fold = {s->own[0], s->own[1]},
                              .next = *reach};
    ritz_status status = ritz_block_lanczos(&s->S, &plan, X, lambda, end);

    ritz_moments_free(&s->moments);
    s->moments = plan.moments;
    *reach = plan.next;
    return status;
}

static const engine rough = {.name = "block Lanczos",
                             .approximate = true,
                             .bounded = true,
                             .find = find_roughly};

/*
 * The order of rows is copied, as the factor that has it is freed with the
 * first slice. If slices fail or find fewer modes than requested, block Lanczos
 * with one shift takes over for the rest of the search.
 */
static ritz_status find_by_slices(search *s, ritz_dense *X, double **lambda,
                                  double *reach, ritz_lanczos_end *end)
{
    ritz_slicing slicing = {.side = s->size->side};
    ritz_status status = RITZ_OK;

    *reach = HUGE_VAL;
    if (!s->order)
        RITZ_CHECK_COPY(s->order, ritz_factor_order(s->S.A), s->S.K->nrow);
    status = ritz_slices_lowest(&s->S, s->ask, &slicing, X, lambda, end);
    if (status == RITZ_OK && *end == RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    if (status != RITZ_OK && status != RITZ_ERR_CONVERGENCE &&
        status != RITZ_ERR_SINGULAR)
        return status;
    s->engine = &reliable;
    RITZ_CHECK(shift_near(s, s->S.sigma));
    return find_by_blocks(s, X, lambda, reach, end);
}

static const engine sliced = {.name = "spectrum slices",
                              .find = find_by_slices};

/* More modes than requested are found, so that the last ones requested are far
   from those that are missing. Slices take over if the structure cannot be
   divided, or if the reduced matrix would be nearly as large as M. */
static ritz_status find_by_amls(search *s, ritz_dense *X, double **lambda,
                                double *reach, ritz_lanczos_end *end)
{
    ritz_substructuring how = {.leaf = s->size->leaf};
    const int64_t k = s->ask + s->ask / GUARD + GUARD;
    double last = 0.0;

    *reach = HUGE_VAL;
    *end = RITZ_LANCZOS_EXHAUSTED;
    if (k < s->num_heavy / s->size->plenty) {
        /* X, M X and A^-1 M X of an inverse iteration */
        RITZ_CHECK(
            ritz_memory_admit("inverse iteration of substructure modes",
                              3 * k * s->S.K->nrow * (int64_t)sizeof(double)));
        RITZ_CHECK(ritz_density_reach(&s->S, k, &last));
        how.cutoff = s->S.sigma + RITZ_AMLS_CUTOFF * (last - s->S.sigma);
        RITZ_CHECK(ritz_amls_lowest(&s->S, k, &how, X, lambda, end));
    }
    if (*end == RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    s->engine = &sliced;
    return find_by_slices(s, X, lambda, reach, end);
}

static const engine engines[] = {
    [RITZ_EIGEN_AUTO] = {.name = "block Lanczos", .find = find_by_blocks},
    [RITZ_EIGEN_LANCZOS] = {.name = "block Lanczos", .find = find_by_blocks},
    [RITZ_EIGEN_ARPACK] = {.name = "ARPACK", .find = find_by_arpack},
    [RITZ_EIGEN_SLICES] = {.name = "spectrum slices", .find = find_by_slices},
    [RITZ_EIGEN_AMLS] = {.name = "substructures",
                         .approximate = true,
                         .find = find_by_amls},
};

/* The engine of a span. With an accuracy block Lanczos ends earlier, and auto
   takes it, as it was the fastest on all models measured; a test may set another
   engine for auto, but not where an accuracy is requested. */
static const engine *engine_of(const ritz_span *span)
{
    const bool tried = span->engine == RITZ_EIGEN_AUTO && span->accuracy == 0.0;
    const engine *e =
        &engines[tried ? ritz_trial_here()->engine : span->engine];

    return span->accuracy > 0.0 && e->find == find_by_blocks ? &rough : e;
}

/* Whether s->found is of an engine that finds eigenvalues approximately. */
static bool is_approximate(const search *s)
{
    return !s->all && s->engine->approximate;
}

/* How many of the pairs found were requested, by their values. Of approximate
   values up to a frequency these are as many as were counted below it: values
   are upper bounds, and one of them may be above the frequency. */
static int64_t end_by_value(const search *s)
{
    const ritz_pairs *P = &s->found;

    if (!is_approximate(s) || s->span->modes >= 0 || s->span->uncounted)
        return ritz_pairs_wanted(P, s->span, s->limit);
    return ritz_pairs_whole(P,
                            s->target < P->Phi.ncol ? s->target : P->Phi.ncol);
}

/* Whether eigenvalue j of an approximate engine may be below the limit. */
static bool may_be_below(const search *s, int64_t j)
{
    const ritz_pairs *P = &s->found;

    return j < P->num_rigid || P->lambda[j] * (1.0 - P->error[j]) <= s->limit;
}

/* How many of the pairs found were requested. Without a count, all that may be
   below a frequency are, as far as there are bounds: up to pair `at`. */
static int64_t end_requested(const search *s, int64_t at)
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
static int64_t gap_to_count(const search *s)
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
static ritz_status bound_errors(search *s, int64_t at, double *error)
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
static ritz_status assess_pairs(search *s, double *error)
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

/* Have the search repeated with smaller residuals, and to rounding as soon as
   these would be smaller than the usual ones. */
static void search_finer(search *s)
{
    s->settled *= RITZ_ACCURACY_FINER;
    if (s->settled < RITZ_LANCZOS_SETTLED)
        s->engine = &reliable;
    s->ask += s->ask / ROUGH_PART + ROUGH_MORE;
}

/* After an approximate engine whose errors are too large, or that missed a
   mode. */
static void search_better(search *s)
{
    if (s->engine->bounded)
        search_finer(s);
    else
        s->engine = &sliced;
}

/* Inverse iterations until the bound of errors is small, or only the bound if
   the engine sets the moments itself. If it stays too large, s->found is empty,
   and the next search has smaller residuals or goes by slices. */
static ritz_status improve_pairs(search *s, ritz_dense *X, double **lambda)
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
    search_better(s);
    ritz_pairs_free(P);
    return RITZ_OK;
}

/* Pairs from the vectors that an engine found. If they cannot be refined, the
   next search is by block Lanczos, and for more modes if this one was. */
static ritz_status settle_pairs(search *s, ritz_dense *X, double **lambda)
{
    const ritz_status status = is_approximate(s) ? improve_pairs(s, X, lambda)
                                                 : refine_pairs(s, X, lambda);
    const bool dependent = status == RITZ_ERR_CONVERGENCE ||
                           (status == RITZ_ERR_SINGULAR && s->S.A);

    if (!dependent || s->all || s->misses++ >= MISSES)
        return status;
    ritz_pairs_free(&s->found);
    if (s->engine->find == find_by_blocks)
        s->ask += s->ask / 2 + SPARE;
    s->engine = &reliable;
    return RITZ_OK;
}

/* Fill s->found; it is empty if sigma, the engine or the number asked had to
   change. */
static ritz_status find_pairs(search *s)
{
    ritz_lanczos_end end = RITZ_LANCZOS_FOUND;
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    double reach = 0.0;

    if (!s->S.A)
        RITZ_CHECK(shift_near(s, s->S.sigma));
    ritz_pairs_free(&s->found);
    s->all =
        s->all || s->num_heavy <= s->size->small || s->ask + 21 > s->num_heavy;
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

/* Free the factor before the count makes its own; keep its order of rows. */
static ritz_status keep_order(search *s)
{
    if (!s->order && s->S.A)
        RITZ_CHECK_COPY(s->order, ritz_factor_order(s->S.A), s->S.K->nrow);
    ritz_factor_free(&s->S.A);
    return RITZ_OK;
}

/* The number of modes below tau. */
static ritz_status count_at(const search *s, double tau, int64_t *out)
{
    const int64_t *order = s->S.A ? ritz_factor_order(s->S.A) : s->order;
    RITZ_OWN(ritz_counter) *C = NULL;

    RITZ_CHECK(ritz_counter_new(s->S.K, s->S.M, order, &C));
    return ritz_counter_below(C, tau, out);
}

/* The number of modes below a value between pairs k - 1 and k. Where the factor
   for the count is singular, because the value is an eigenvalue, another value
   is taken. */
static ritz_status count_below(search *s, int64_t k, int64_t *out)
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
static ritz_status search_missed(search *s, int64_t missed, double lambda)
{
    RITZ_REFUSE_IF(s->all || ++s->misses > MISSES, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes below %g Hz are not found", missed,
                   ritz_eigen_hertz(lambda));
    if (s->engine->approximate && (s->engine->bounded || s->misses > 1))
        search_better(s);
    s->ask += missed + SPARE + (s->misses > 1 ? s->ask / 2 : 0);
    return RITZ_OK;
}

/* Also without a factor: what the last call made of other pairs is void. */
static ritz_status lend_factor(const search *s, int64_t end)
{
    if (!s->use)
        return RITZ_OK;
    return s->use->call(s->use->of, &s->found, end, s->S.A, s->S.sigma);
}

/* Count the modes below a value behind the first `end` pairs: whether none of
   them is missed. */
static ritz_status prove_lowest(search *s, int64_t end, bool *done)
{
    const int64_t at = gap_to_count(s);
    int64_t count = at;

    RITZ_CHECK(lend_factor(s, end));
    if (s->found.Phi.ncol > 0 && !s->span->uncounted)
        RITZ_CHECK(count_below(s, at, &count));
    *done = count == at;
    if (count < at && is_approximate(s) && s->misses++ < MISSES) {
        search_better(s); /* the value is within a cluster */
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
        search_better(s);
    return RITZ_OK;
}

/* By number: whether all modes are found, and none below them is missed. */
static ritz_status prove_number(search *s, int64_t *end, bool *done)
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
static ritz_status count_target(search *s)
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
static ritz_status end_uncounted(search *s, int64_t *end, bool *done)
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
static ritz_status prove_frequency(search *s, int64_t *end, bool *done)
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

/* With a factor of K there are no rigid modes, and sigma = 0 is kept. */
static ritz_status begin_search(search *s)
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
    return shift_near(s, -sigma);
}

static void name_engine(search *s)
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
    RITZ_OWN(search)
    s = {.span = span,
         .S = {.K = K, .M = M},
         .engine = engine_of(span),
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
    RITZ_CHECK(search_proven(&s, &end));
    ritz_pairs_truncate(&s.found, end);
    ritz_dense_orient(&s.found.Phi);
    s.found.sigma = s.S.sigma;
    name_engine(&s);
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
    RITZ_REFUSE_IF(!engine_of(span)->approximate, RITZ_ERR_ARGUMENT,
                   "modes by %s have no accuracy to choose",
                   engine_of(span)->name);
    return RITZ_OK;
}
