/*
 * Block Lanczos with one shift below the k lowest eigenvalues needs about three
 * basis vectors for each of them, and orthogonalises all of these: 2 n (3 k)^2
 * operations. With slices a basis serves only the eigenvalues near one shift.
 * Slice i, of shift sigma_i, begins at border_i and has the eigenvalues
 *
 *     border_i < lambda <= sigma_i:  as many as the inertia of K - sigma_i M
 *                                    counts, less those below the border
 *     lambda > sigma_i:              some more, which are verified by the count
 *                                    at the next shift
 *
 * A border lies in the widest gap among the last eigenvalues of a slice, never
 * in a cluster. Vectors of two slices are therefore orthogonal up to the ratio
 * of their residuals to that gap, and one projection makes them orthogonal to
 * rounding. If Lanczos finds fewer eigenvalues than were counted, the search
 * goes back to the last verified one and takes a nearer shift.
 *
 * Tests compare with block Lanczos and LAPACK on random pencils with clusters,
 * also at borders, with singular M, free bodies and mechanisms.
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
    SIDE = 100,       /* eigenvalues on each side of a shift */
    TRIES = 3,        /* shifts to try if one is too far away, or singular */
    MISSES = 4,       /* slices that may be repeated, in the whole search */
    SPARE = 64,       /* columns for eigenvalues found beyond those requested */
    MORE_SLICES = 12, /* slices allowed beyond 4 ask / side */
    BEYOND = 8,       /* side / BEYOND more are found: a border cuts some off */
    ROOM = 96,        /* basis vectors beyond four for each pair */
    FUTILE = 16,  /* `longer` above which no further eigenvalue is expected */
    TOO_MANY = 3, /* a shift is moved with so many times the expected number of
                     eigenvalues between it and the border */
};

typedef struct slices {
    ritz_shifted S;
    int64_t *order; /* of rows in the first factor, used for all others */
    int64_t ask;    /* eigenvalues requested */
    int64_t side;   /* eigenvalues on each side of a shift */
    int64_t count;  /* slices so far */
    ritz_dense X;   /* `found` columns are set, by ascending eigenvalue */
    double *lambda;
    int64_t found;
    int64_t proven; /* so many of the lowest are verified by a count */
    int64_t longer; /* factor on the length of the next slice, usually 1 */
    double base;    /* the first shift */
    double border;  /* of the next slice: all eigenvalues below are in X */
    double nearer;  /* the next shift, if the last slice missed some; or NaN */
    int64_t misses; /* slices with eigenvalues missing so far */
} slices;

static void slices_free(slices *s)
{
    ritz_factor_free(&s->S.A);
    ritz_dense_free(&s->X);
    RITZ_FREE(s->order, s->lambda);
}

/* The pairs that one run of block Lanczos found. */
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
 * V := V - X (X'M V) for the columns V from `first` on, X the columns before,
 * then V is normalised. Entries of X'M V are at most the residuals divided by
 * the gap between the eigenvalues; after the projection the square of that is
 * left.
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

/* Append the pairs of a run with the `from`-th to (`to` - 1)-th lowest
   eigenvalue, counted from 0, as far as there is room. */
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

/* Least gap to an eigenvalue that no cluster contains. Eigenvalues of
   rigid-body modes, which are 0, err in proportion to |base|: hence its
   share. */
static double clear_gap(const slices *s, double lambda)
{
    return RITZ_BORDER_GAP * (fabs(lambda) + fabs(s->base));
}

/*
 * Set the border in the widest gap among the last side / 4 eigenvalues, or
 * below them if they have no clear gap, and drop the pairs above it: the next
 * slice finds these again.
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

/* Number of eigenvalues on each side of the next shift. It doubles with each
   slice that brings nothing new. */
static int64_t side_of_next(const slices *s)
{
    const int64_t left = s->ask - s->found;
    const int64_t more = (left + 2 * s->side - 1) / (2 * s->side);

    return (left + 2 * more - 1) / (2 * more) * s->longer;
}

/* A lower bound of the eigenvalues of the next slice. */
static double next_begin(const slices *s)
{
    return s->found > 0 ? s->border : s->lambda[0];
}

/* The shift with `half` eigenvalues between the border and itself, if their
   mean distance is that of the last `half` of those `known`. */
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

/* Factor K - sigma M and count the eigenvalues below sigma. */
static ritz_status factor_at(slices *s, double sigma, int64_t *negative)
{
    RITZ_OWN(ritz_sparse) A = {0};

    ritz_factor_free(&s->S.A); /* memory may not hold two factors */
    ritz_monitor_step("factor", 0, 0);
    RITZ_CHECK(ritz_sparse_add(1.0, s->S.K, -sigma, s->S.M, &A));
    s->S.sigma = sigma;
    return ritz_factor_signed(&A, s->order, negative, &s->S.A);
}

/* Choose the next shift and factor. With too many eigenvalues between border
   and shift a nearer shift is tried, and a slightly nearer one if the factor is
   singular. */
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
 * Append the pairs of a run: `below` of them between the border and the shift,
 * and all above the shift. If fewer than `below` are there, an eigenvalue was
 * missed, in this run or above the last shift: *missed is set and nothing is
 * appended.
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

/* After a miss: drop all pairs that are not verified, and let the next shift be
   half as far from the new border. */
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
 * Block Lanczos with the present shift: at least `pairs` pairs, s->S.below of
 * them below the shift. As many above it may be nearer to it, and are then
 * found first: the basis has room for these, too. Each step adds one block, as a
 * slice has too few eigenvalues for steps of two blocks to be faster.
 */
static ritz_status find_run(slices *s, int64_t pairs, run *r,
                            ritz_lanczos_end *end)
{
    const int64_t nearest = pairs > 2 * s->S.below ? pairs : 2 * s->S.below;
    ritz_lanczos_plan plan = {
        .k = pairs, .room = 4 * nearest + ROOM, .width = 1};

    s->count++;
    RITZ_CHECK(ritz_block_lanczos(&s->S, &plan, &r->X, &r->lambda, end));
    return *end == RITZ_LANCZOS_FOUND ? rank_values(r) : RITZ_OK;
}

/* Find the next slice, above a new border. */
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

/* All slices. The first uses the factor that the caller gave; each other one
   makes its own. */
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

    S->A = NULL; /* now owned by s.S */
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

int64_t ritz_slices_need(const ritz_shifted *S, int64_t k)
{
    const int64_t n = S->K->nrow;
    const int64_t most = INT64_C(2) * SIDE;
    const int64_t found = k < most ? k : most + SIDE / BEYOND;

    return (int64_t)sizeof(double) * n * (k + SIDE + SPARE) +
           ritz_block_lanczos_needs(S, found, false);
}
