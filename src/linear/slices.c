/*
 * Block Lanczos at one end of the spectrum keeps three vectors for each pair,
 * all orthogonal to each other: n (3 k)^2 operations. In slices it keeps two,
 * and only those of a slice:
 *
 *     border_i < lambda <= sigma_i:  as many as the inertia of K - sigma_i M
 *                                    says, less those below the border
 *     lambda > sigma_i:              some more, until the next shift proves them
 *
 * A border lies in the widest gap among the last eigenvalues of a slice, never
 * in a cluster, so that vectors of two slices are orthogonal to their residuals
 * over that gap, and become so to rounding with one projection. A slice that
 * has fewer eigenvalues than were counted is found again from the last proven
 * one, with a shift that is nearer.
 *
 * Held to: block Lanczos and LAPACK on random pencils with clusters, masses of
 * zero, free bodies and mechanisms, with clusters at borders.
 */
#include "linear/slices.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/block_lanczos.h"
#include "linear/factor.h"

#include <cblas.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 100, /* eigenvalues on each side of a shift */
    TRIES = 3,  /* shifts that are tried where one is too far, or singular */
    MISSES = 4, /* slices that are found again */
    SPARE = 64, /* room for eigenvalues found beside those asked for */
    MORE_SLICES = 12, /* slices beyond those that are expected */
    BEYOND = 8,       /* of a side: what the next border may cut off */
    ROOM = 96,        /* vectors beyond four for each pair */
    FUTILE = 16,      /* times longer: nothing new so far is nothing at all */
    TOO_MANY = 3,     /* times the eigenvalues that a shift should have below */
};

typedef struct slices {
    ritz_shifted S;
    int64_t *order; /* of the first factor, for all others */
    int64_t ask, side, count;
    ritz_dense X; /* the first `found` columns, by ascending eigenvalue */
    double *lambda;
    int64_t found;
    int64_t proven; /* so many of the lowest are counted */
    int64_t longer; /* than a usual one is the next slice, this many times */
    double base;    /* the first shift */
    double border;  /* no eigenvalue behind X is below it */
    double nearer;  /* the next shift, after a miss; NaN: none was missed */
    int64_t misses;
} slices;

static void slices_free(slices *s)
{
    ritz_factor_free(&s->S.A);
    ritz_dense_free(&s->X);
    RITZ_FREE(s->order, s->lambda);
}

/* Pairs of one run, with the places of their eigenvalues by size. */
typedef struct run {
    ritz_dense X;
    double *lambda;
    int64_t *rank; /* column of each, by ascending eigenvalue */
} run;

static void run_free(run *r)
{
    ritz_dense_free(&r->X);
    RITZ_FREE(r->lambda, r->rank);
}

typedef struct valued_column {
    double value;
    int64_t column;
} valued_column;

static int compare_values(const void *a, const void *b)
{
    const valued_column *x = a;
    const valued_column *y = b;

    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return x->column < y->column ? -1 : x->column > y->column;
}

static ritz_status rank_values(run *r)
{
    const int64_t count = r->X.ncol;
    RITZ_OWN_ARRAY valued_column *list = NULL;

    RITZ_CHECK_NEW(list, count);
    RITZ_CHECK_NEW(r->rank, count);
    for (int64_t c = 0; c < count; c++)
        list[c] = (valued_column){r->lambda[c], c};
    qsort(list, (size_t)count, sizeof *list, compare_values);
    for (int64_t c = 0; c < count; c++)
        r->rank[c] = list[c].column;
    return RITZ_OK;
}

/*
 * The columns [first, found) made orthogonal to all before them, and of length
 * one: V := V - X (X'M V). What is taken out is the residual of both over the
 * gap between their eigenvalues; its square is left.
 */
static ritz_status restore_border(slices *s, int64_t first)
{
    const int64_t n = s->X.nrow;
    const ritz_dense X = {n, first, s->X.val};
    const ritz_dense V = {n, s->found - first, ritz_dense_col(&s->X, first)};
    RITZ_OWN(ritz_dense) MV = {0}, G = {0};
    double worst = 0.0;

    if (first == 0 || V.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(s->S.M, &V, &MV));
    RITZ_CHECK(ritz_dense_mul_tn(&X, &MV, &G));
    for (int64_t k = 0; k < first * V.ncol; k++)
        worst = fmax(worst, fabs(G.val[k]));
    RITZ_REFUSE_IF(!(worst <= RITZ_BORDER_COSINE), RITZ_ERR_CONVERGENCE,
                   "modes of two slices are orthogonal to %.1e only", worst);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)n, (int)V.ncol,
                (int)first, -1.0, X.val, (int)n, G.val, (int)first, 1.0, V.val,
                (int)n);
    for (int64_t j = 0; j < V.ncol; j++) {
        const double size = sqrt(ritz_dense_dot(&V, j, &MV, j));

        for (int64_t i = 0; i < n; i++)
            V.val[i + j * n] /= size;
    }
    return RITZ_OK;
}

/* Append pairs [from, to) of a run, by rank, as far as there is room. */
static ritz_status append_pairs(slices *s, const run *r, int64_t from,
                                int64_t to)
{
    const int64_t first = s->found;

    for (int64_t c = from; c < to && s->found < s->X.ncol; c++) {
        memcpy(ritz_dense_col(&s->X, s->found),
               r->X.val + r->rank[c] * s->X.nrow,
               (size_t)s->X.nrow * sizeof *s->X.val);
        s->lambda[s->found++] = r->lambda[r->rank[c]];
    }
    return restore_border(s, first);
}

/* A gap behind this eigenvalue that is none of a cluster, nor of rigid motions:
   they err by parts of their distance from the first shift, below 0. */
static double clear_gap(const slices *s, double lambda)
{
    return RITZ_BORDER_GAP * (fabs(lambda) + fabs(s->base));
}

/*
 * Cut what was found, in the widest gap among the last quarter of a side, or
 * further down where that is not clear: what is behind it is found again with
 * the next slice.
 */
static void settle_border(slices *s)
{
    const int64_t tail = s->found - 2 - s->side / 4;
    double widest = 0.0;
    int64_t at = 0;

    for (int64_t k = s->found - 1; k > 0 && (k >= tail || at == 0); k--) {
        const double gap = s->lambda[k] - s->lambda[k - 1];

        if (gap > widest && gap > clear_gap(s, s->lambda[k])) {
            widest = gap;
            at = k;
        }
    }
    s->border = at > 0 ? 0.5 * (s->lambda[at - 1] + s->lambda[at]) : -HUGE_VAL;
    s->found = at;
    s->proven = s->proven < at ? s->proven : at;
}

/* Eigenvalues on each side of the next shift: more if the last slice brought
   nothing new. */
static int64_t side_of_next(const slices *s)
{
    const int64_t left = s->ask - s->found;
    const int64_t more = (left + 2 * s->side - 1) / (2 * s->side);

    return (left + 2 * more - 1) / (2 * more) * s->longer;
}

/* Where the next slice begins, at least. */
static double next_begin(const slices *s)
{
    return s->found > 0 ? s->border : s->lambda[0];
}

/* The shift below which `half` eigenvalues lie behind the border, if they go on
   as the last ones did. */
static double next_shift(const slices *s, int64_t known, int64_t half)
{
    const int64_t last = known - 1;
    const int64_t first = last > half ? last - half : 0;
    const double span = s->lambda[last] - s->lambda[first];
    const double mean = last > first ? span / (double)(last - first) : 0.0;
    const double from = next_begin(s);

    if (s->found == 0) /* all that is known is one cluster */
        return from +
               fmax(mean * (double)half,
                    fmax(fabs(s->base), RITZ_BEHIND_CLUSTER * fabs(from)));
    return from + fmax(mean, clear_gap(s, from)) * (double)half;
}

/* Factor K - sigma M and count. */
static ritz_status factor_at(slices *s, double sigma, int64_t *negative)
{
    RITZ_OWN(ritz_sparse) A = {0};

    ritz_factor_free(&s->S.A); /* two at once may not fit */
    ritz_monitor_step("factor", 0, 0);
    RITZ_CHECK(ritz_sparse_add(1.0, s->S.K, -sigma, s->S.M, &A));
    s->S.sigma = sigma;
    return ritz_factor_signed(&A, s->order, negative, &s->S.A);
}

/* The next shift, factored: nearer to the border where it would have too many
   eigenvalues below, and a little elsewhere where it is an eigenvalue. */
static ritz_status shift_on(slices *s, int64_t known, int64_t half,
                            int64_t *negative)
{
    const double from = next_begin(s);
    double sigma = next_shift(s, known, half);
    ritz_status status = RITZ_ERR_SINGULAR;

    if (isfinite(s->nearer))
        sigma = s->nearer;
    s->nearer = (double)NAN;
    for (int k = 0; k < TRIES; k++) {
        int64_t below = 0;
        double other = 0.0;

        status = factor_at(s, sigma, negative);
        if (status != RITZ_OK && status != RITZ_ERR_SINGULAR)
            return status;
        below = *negative - s->found;
        other = from + (sigma - from) * (double)half / (double)below;
        if (status == RITZ_ERR_SINGULAR)
            sigma = from + RITZ_SHIFT_ASTRAY * (sigma - from);
        else if (below > TOO_MANY * half && k + 1 < TRIES &&
                 other - from > clear_gap(s, from))
            sigma = other;
        else
            return RITZ_OK;
    }
    return status;
}

/*
 * Take the pairs of a run: `below` between the border and the shift, and those
 * above it. If there are fewer, one of this slice or one above the last shift
 * was missed: *missed, and the search goes on from what is proven.
 */
static ritz_status take_run(slices *s, const run *r, int64_t below,
                            bool *missed)
{
    const int64_t count = r->X.ncol;
    int64_t split = 0;

    while (split < count && r->lambda[r->rank[split]] < s->S.sigma)
        split++;
    *missed = split < below ||
              (below > 0 && r->lambda[r->rank[split - below]] <= s->border);
    if (*missed)
        return RITZ_OK;
    s->proven = s->found + below;
    RITZ_CHECK(append_pairs(s, r, split - below, count));
    s->proven = s->proven < s->found ? s->proven : s->found;
    return RITZ_OK;
}

/* After a miss: from the last proven pair on, with a shift at half the way. */
static ritz_status step_back(slices *s, int64_t count)
{
    const double sigma = s->S.sigma;

    s->misses++;
    RITZ_REFUSE_IF(s->misses > MISSES, RITZ_ERR_CONVERGENCE,
                   "some of the %" PRId64 " modes below %g Hz are not found",
                   count, ritz_eigen_hertz(sigma));
    s->found = s->proven;
    settle_border(s);
    s->nearer = next_begin(s) + fmax(0.5 * (sigma - next_begin(s)),
                                     clear_gap(s, next_begin(s)));
    return RITZ_OK;
}

/*
 * Lanczos at the shift that is factored: some pairs, s->S.below of them below
 * it. As many again may lie nearer to the shift on its other side.
 */
static ritz_status find_run(slices *s, int64_t pairs, run *r,
                            ritz_lanczos_end *end)
{
    const int64_t nearest = pairs > 2 * s->S.below ? pairs : 2 * s->S.below;
    double next = 0.0;

    s->count++;
    RITZ_CHECK(ritz_block_lanczos(&s->S, pairs, 4 * nearest + ROOM, &r->X,
                                  &r->lambda, &next, end));
    return *end == RITZ_LANCZOS_FOUND ? rank_values(r) : RITZ_OK;
}

/* The next slice, from the border on. */
static ritz_status add_slice(slices *s, ritz_lanczos_end *end)
{
    RITZ_OWN(run) r = {0};
    const int64_t known = s->found > 1 ? s->found : 1;
    int64_t half = 0;
    int64_t above = 0;
    int64_t negative = 0;
    bool missed = false;

    settle_border(s);
    half = side_of_next(s);
    RITZ_CHECK(shift_on(s, known, half, &negative));
    RITZ_REFUSE_IF(negative < s->found, RITZ_ERR_CONVERGENCE,
                   "%" PRId64 " modes were found where there are %" PRId64,
                   s->found, negative);
    s->S.below = negative - s->found;
    above = s->ask - negative;
    above = (above < half ? above : half) + s->side / BEYOND;
    above = above > 0 ? above : 0;
    above += s->S.below + above == 0;
    RITZ_CHECK(find_run(s, s->S.below + above, &r, end));
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    RITZ_CHECK(take_run(s, &r, s->S.below, &missed));
    s->longer = missed || s->found > known ? 1 : 2 * s->longer;
    return missed ? step_back(s, negative) : RITZ_OK;
}

/* All slices; those behind the first begin with a factor of their own. */
static ritz_status find_slices(slices *s, ritz_lanczos_end *end)
{
    RITZ_OWN(run) r = {0};
    const int64_t most = 4 * s->ask / s->side + MORE_SLICES;

    RITZ_CHECK(find_run(s, s->ask <= 2 * s->side ? s->ask : s->side, &r, end));
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    ritz_factor_free(&s->S.A);
    RITZ_CHECK(append_pairs(s, &r, 0, r.X.ncol));
    run_free(&r);
    r = (run){0};
    while (s->found < s->ask && *end == RITZ_LANCZOS_FOUND) {
        if (s->longer > FUTILE)
            *end = RITZ_LANCZOS_EXHAUSTED;
        else if (s->count > most)
            *end = RITZ_LANCZOS_SLOW;
        else
            RITZ_CHECK(add_slice(s, end));
    }
    return RITZ_OK;
}

ritz_status ritz_slices_lowest(ritz_shifted *S, int64_t k,
                               ritz_slicing *slicing, ritz_dense *X,
                               double **lambda, ritz_lanczos_end *end)
{
    const int64_t side = slicing->side > 0 ? slicing->side : SIDE;
    const int64_t room = k + side + SPARE;
    RITZ_OWN(slices)
    s = {.S = *S,
         .ask = k,
         .side = side,
         .longer = 1,
         .base = S->sigma,
         .border = -HUGE_VAL,
         .nearer = (double)NAN};

    S->A = NULL; /* taken */
    RITZ_CHECK_COPY(s.order, ritz_factor_order(s.S.A), S->K->nrow);
    RITZ_CHECK(ritz_dense_new(S->K->nrow, room, &s.X));
    RITZ_CHECK_NEW(s.lambda, room);
    RITZ_CHECK(find_slices(&s, end));
    slicing->slices = s.count;
    slicing->proven = s.proven;
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    s.X.ncol = s.found;
    RITZ_MOVE(*X, s.X);
    RITZ_MOVE(*lambda, s.lambda);
    return RITZ_OK;
}
