/*
 * Engines of the search of eigen_sparse.c: methods to find the lowest pairs of
 *
 *     K x = lambda M x   with a factor of   K - sigma M,   sigma <= 0
 *
 *     block Lanczos     theta = 1 / (lambda - sigma), the largest eigenvalues of
 *                       (K - sigma M)^-1 M; to rounding, or to an accuracy
 *     ARPACK            the same, vector by vector
 *     spectrum slices   the same with a shift for each part of the spectrum
 *     substructures     modes of parts of the structure, and Rayleigh-Ritz on
 *                       them: eigenvalues are upper bounds
 *
 * An engine that fails hands over to the next: substructures to slices, slices
 * to block Lanczos with one shift, block Lanczos to an accuracy to the same with
 * smaller residuals.
 */
#include "linear/search_engines.h"
#include "base/alloc.h"
#include "base/memory.h"
#include "base/tolerances.h"
#include "linear/amls.h"
#include "linear/arpack.h"
#include "linear/block_lanczos.h"
#include "linear/density.h"
#include "linear/engine_choice.h"
#include "linear/factor.h"
#include "linear/first_shift.h"
#include "linear/slices.h"

#include <math.h>

enum {
    ROUGH_PART = 50, /* with an accuracy, block Lanczos finds k + k / ROUGH_PART
                        + ROUGH_MORE modes for k, to have a gap to count in */
    ROUGH_MORE = 8,
    GUARD = 2, /* substructures find k + k / GUARD + GUARD modes for k */
};

void ritz_mode_search_free(ritz_mode_search *s)
{
    RITZ_FREE(s->heavy, s->order);
    ritz_factor_free(&s->S.A);
    ritz_pairs_free(&s->found);
    ritz_moments_free(&s->moments);
}

/* What the factor is for. Pairs of an earlier search are freed before the next
   one begins. */
static ritz_foresight foresee_search(const ritz_mode_search *s)
{
    const ritz_dense *X = &s->found.Phi;
    ritz_foresight later = {0};

    if (s->engine->needs)
        later.beside = s->engine->needs(&s->S, s->ask, s->own[0] && s->own[1]) -
                       X->nrow * X->ncol * (int64_t)sizeof *X->val;
    return later;
}

int64_t ritz_eigen_factored_needs(const ritz_sparse *K, const ritz_sparse *M,
                                  const ritz_span *span)
{
    const ritz_search_engine *engine = ritz_search_engine_of(span);
    const ritz_shifted S = {.K = K, .M = M};

    return engine->needs && span->modes > 0
               ? engine->needs(&S, span->modes + RITZ_SEARCH_BEHIND, true)
               : 0;
}

/* Factor K - sigma M in place of what was factored before. */
static ritz_status shift_to(void *search, double sigma)
{
    ritz_mode_search *s = search;
    RITZ_OWN(ritz_sparse) A = {0};
    ritz_status status = RITZ_OK;
    ritz_foresight before = {0};

    ritz_factor_free(&s->S.A); /* two at once may not fit */
    RITZ_CHECK(ritz_sparse_add(1.0, s->S.K, -sigma, s->S.M, &A));
    before = ritz_memory_foresee(foresee_search(s));
    status = ritz_factor_spd(&A, &s->S.A);
    (void)ritz_memory_foresee(before);
    if (status == RITZ_ERR_SINGULAR)
        s->broken = fmax(s->broken, -sigma);
    s->S.sigma = sigma;
    return status;
}

ritz_status ritz_search_shift(ritz_mode_search *s, double sigma)
{
    return ritz_first_factor(s->typical, sigma, shift_to, s);
}

ritz_status ritz_find_by_blocks(ritz_mode_search *s, ritz_dense *X,
                                double **lambda, double *reach,
                                ritz_lanczos_end *end)
{
    ritz_lanczos_plan plan = {
        .k = s->ask, .fold = {s->own[0], s->own[1]}, .next = *reach};

    RITZ_CHECK(ritz_block_lanczos(&s->S, &plan, X, lambda, end));
    *reach = plan.next;
    return RITZ_OK;
}

static ritz_status find_by_arpack(ritz_mode_search *s, ritz_dense *X,
                                  double **lambda, double *reach,
                                  ritz_lanczos_end *end)
{
    (void)lambda;
    return ritz_lanczos_lowest(&s->S, s->ask, X, reach, end);
}

const ritz_search_engine ritz_search_reliable = {.name = "block Lanczos",
                                                 .find = ritz_find_by_blocks,
                                                 .needs =
                                                     ritz_block_lanczos_needs};

/* Pairs to find for `ask` requested to an accuracy. */
static int64_t pairs_of_rough(int64_t ask)
{
    return ask + ask / ROUGH_PART + ROUGH_MORE;
}

static int64_t needs_of_rough(const ritz_shifted *S, int64_t ask, bool folded)
{
    return ritz_block_lanczos_needs(S, pairs_of_rough(ask), folded);
}

/* More modes than requested are found, so that modes can be counted in the widest
   gap between the additional ones: the wider it is, the smaller is the bound. */
static ritz_status find_roughly(ritz_mode_search *s, ritz_dense *X,
                                double **lambda, double *reach,
                                ritz_lanczos_end *end)
{
    ritz_lanczos_plan plan = {.k = pairs_of_rough(s->ask),
                              .settled = s->settled,
                              .fold = {s->own[0], s->own[1]},
                              .next = *reach};
    ritz_status status = ritz_block_lanczos(&s->S, &plan, X, lambda, end);

    ritz_moments_free(&s->moments);
    s->moments = plan.moments;
    *reach = plan.next;
    return status;
}

static const ritz_search_engine rough = {.name = "block Lanczos",
                                         .approximate = true,
                                         .bounded = true,
                                         .find = find_roughly,
                                         .needs = needs_of_rough};

/*
 * The order of rows is copied, as the factor that has it is freed with the
 * first slice. If slices fail or find fewer modes than requested, block Lanczos
 * with one shift takes over for the rest of the search.
 */
static ritz_status find_by_slices(ritz_mode_search *s, ritz_dense *X,
                                  double **lambda, double *reach,
                                  ritz_lanczos_end *end)
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
    s->engine = &ritz_search_reliable;
    RITZ_CHECK(ritz_search_shift(s, s->S.sigma));
    return ritz_find_by_blocks(s, X, lambda, reach, end);
}

/* Of the usual slices: a test may have smaller ones. */
static int64_t needs_of_slices(const ritz_shifted *S, int64_t ask, bool folded)
{
    (void)folded;
    return ritz_slices_need(S, ask);
}

static const ritz_search_engine sliced = {.name = "spectrum slices",
                                          .find = find_by_slices,
                                          .needs = needs_of_slices};

/* Pairs to find by substructures. */
static int64_t pairs_of_amls(int64_t ask)
{
    return ask + ask / GUARD + GUARD;
}

/* X, M X and A^-1 M X of an inverse iteration. */
static int64_t needs_of_amls(const ritz_shifted *S, int64_t ask, bool folded)
{
    (void)folded;
    return 3 * pairs_of_amls(ask) * S->K->nrow * (int64_t)sizeof(double);
}

/* More modes than requested are found, so that the last ones requested are far
   from those that are missing. Slices take over if the structure cannot be
   divided, or if the reduced matrix would be nearly as large as M. */
static ritz_status find_by_amls(ritz_mode_search *s, ritz_dense *X,
                                double **lambda, double *reach,
                                ritz_lanczos_end *end)
{
    ritz_substructuring how = {.leaf = s->size->leaf};
    const int64_t k = pairs_of_amls(s->ask);
    double last = 0.0;

    *reach = HUGE_VAL;
    *end = RITZ_LANCZOS_EXHAUSTED;
    if (k < s->num_heavy / s->size->plenty) {
        RITZ_CHECK(ritz_memory_admit("inverse iteration of substructure modes",
                                     needs_of_amls(&s->S, s->ask, false)));
        RITZ_CHECK(ritz_density_reach(&s->S, k, &last));
        how.cutoff = s->S.sigma + RITZ_AMLS_CUTOFF * (last - s->S.sigma);
        RITZ_CHECK(ritz_amls_lowest(&s->S, k, &how, X, lambda, end));
    }
    if (*end == RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    s->engine = &sliced;
    return find_by_slices(s, X, lambda, reach, end);
}

/* Before there is a factor it is not known whether slices will be chosen. */
static int64_t needs_of_auto(const ritz_shifted *S, int64_t ask, bool folded)
{
    const int64_t blocks = ritz_block_lanczos_needs(S, ask, folded);
    const int64_t slices = ritz_slices_need(S, ask);

    return blocks < slices ? blocks : slices;
}

static const ritz_search_engine engines[] = {
    [RITZ_EIGEN_AUTO] = {.name = "block Lanczos",
                         .find = ritz_find_by_blocks,
                         .needs = needs_of_auto},
    [RITZ_EIGEN_LANCZOS] = {.name = "block Lanczos",
                            .find = ritz_find_by_blocks,
                            .needs = ritz_block_lanczos_needs},
    [RITZ_EIGEN_ARPACK] = {.name = "ARPACK", .find = find_by_arpack},
    [RITZ_EIGEN_SLICES] = {.name = "spectrum slices",
                           .find = find_by_slices,
                           .needs = needs_of_slices},
    [RITZ_EIGEN_AMLS] = {.name = "substructures",
                         .approximate = true,
                         .find = find_by_amls,
                         .needs = needs_of_amls},
};

const ritz_search_engine *ritz_search_engine_of(const ritz_span *span)
{
    const bool tried = span->engine == RITZ_EIGEN_AUTO && span->accuracy == 0.0;
    const ritz_search_engine *e =
        &engines[tried ? ritz_trial_here()->engine : span->engine];

    return span->accuracy > 0.0 && e->find == ritz_find_by_blocks ? &rough : e;
}

void ritz_search_choose(ritz_mode_search *s)
{
    ritz_eigen_engine chosen = RITZ_EIGEN_LANCZOS;

    if (s->span->engine != RITZ_EIGEN_AUTO || !s->S.A ||
        ritz_trial_here()->engine != RITZ_EIGEN_AUTO)
        return;
    chosen = ritz_engine_of(s->span, s->S.A, s->S.K->nrow, s->ask);
    s->reason = "the fastest by prediction";
    if (chosen != RITZ_EIGEN_LANCZOS)
        s->engine = &engines[chosen];
    s->chosen = s->engine;
}

/* Have the search repeated with smaller residuals, and to rounding as soon as
   these would be smaller than the usual ones. */
static void search_finer(ritz_mode_search *s)
{
    s->settled *= RITZ_ACCURACY_FINER;
    if (s->settled < RITZ_LANCZOS_SETTLED)
        s->engine = &ritz_search_reliable;
    s->ask += s->ask / ROUGH_PART + ROUGH_MORE;
}

void ritz_search_better(ritz_mode_search *s)
{
    if (s->engine->bounded)
        search_finer(s);
    else
        s->engine = &sliced;
}
