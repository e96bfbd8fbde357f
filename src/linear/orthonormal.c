/*
 * Block Gram-Schmidt, twice or more, then what is independent within the block:
 *
 *     R <- R - V (WV)' R                            (until no R shrinks)
 *     G = R' W R with columns scaled to one = L L', pivoted, as far as its
 *     pivots stay strong, or, of the first block, above rounding;
 *     Q = R_pivots L^-T                       (twice, or until Q'WQ = I)
 *
 * Columns whose pivot was weak go through all of it again, now against Q too,
 * until nothing of them is left: a round resolves only directions that rounding
 * has not blurred, and the energies of the rounds multiply.
 *
 * W R is made by a product after every change of R by which R may shrink:
 * carried along by the same sums, it drifts away from R, by the inverse of what
 * is new in a column, at every block. A change that is small beside R leaves it
 * within the rounding of a product: then W R <- W R - WV (WV)' R.
 *
 * Where more columns are independent than are wanted, one pass serves to choose
 * among them, and only the chosen ones go through the others.
 */
#include "linear/orthonormal.h"
#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/tall.h"

#include <ritz/matrix.h>

#include <float.h>
#include <math.h>
#include <string.h>

int64_t ritz_pivots_find(ritz_dense *G, double least, double tie, int64_t most,
                         int64_t *order)
{
    int64_t p = G->ncol;
    int64_t count = 0;

    while (count < most && count < p) {
        int64_t pivot = -1;
        double d = least;

        for (int64_t j = 0; j < p; j++)
            if (ritz_dense_col(G, j)[j] > (pivot < 0 ? d : tie * d)) {
                pivot = j;
                d = ritz_dense_col(G, j)[j];
            }
        if (pivot < 0)
            break;
        order[count++] = pivot;
        for (int64_t j = 0; j < p; j++) {
            double factor = ritz_dense_col(G, j)[pivot] / d;

            for (int64_t i = 0; i < p && j != pivot; i++)
                ritz_dense_col(G, j)[i] -= factor * ritz_dense_col(G, pivot)[i];
        }
        for (int64_t j = 0; j < p; j++)
            ritz_dense_col(G, j)[pivot] = ritz_dense_col(G, pivot)[j] = 0.0;
    }
    return count;
}

enum { NORMALISED = 4 }; /* passes that make columns orthonormal, at most */

/* G := L of G = L L', column by column; the upper triangle stays. */
static ritz_status factor_cholesky(ritz_dense *G)
{
    int64_t p = G->ncol;

    for (int64_t j = 0; j < p; j++) {
        double *g = ritz_dense_col(G, j);
        double d = sqrt(g[j]);

        RITZ_REFUSE_IF(!(g[j] > 0.0), RITZ_ERR_CONVERGENCE,
                       "a block of vectors lost its independence");
        for (int64_t i = j; i < p; i++)
            g[i] /= d;
        for (int64_t k = j + 1; k < p; k++)
            for (int64_t i = k; i < p; i++)
                ritz_dense_col(G, k)[i] -= g[i] * g[k];
    }
    return RITZ_OK;
}

/* WQ := W Q, and the largest |q|'|W||q| so far. */
static ritz_status weigh_columns(ritz_orthonormal *set, const ritz_dense *Q,
                                 ritz_dense *WQ)
{
    RITZ_OWN_ARRAY double *terms = NULL;

    RITZ_CHECK_NEW(terms, Q->ncol);
    RITZ_CHECK(ritz_tall_weigh_sizes(set->W, Q, Q, WQ, terms));
    for (int64_t j = 0; j < Q->ncol; j++)
        set->terms = fmax(set->terms, terms[j]);
    return RITZ_OK;
}

/* The largest entry of G - I. */
static double measure_gap(const ritz_dense *G)
{
    double gap = 0.0;

    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->nrow; i++)
            gap = fmax(gap, fabs(ritz_dense_col(G, j)[i] - (i == j)));
    return gap;
}

/* Q := Q L^-T with Q'WQ = L L', and WQ with it, twice, or until L is I but for
   rounding: each pass squares Q'WQ - I. */
static ritz_status normalise_columns(ritz_orthonormal *set, ritz_dense *Q,
                                     ritz_dense *WQ)
{
    double gap = HUGE_VAL;

    for (int pass = 0;
         pass < 2 || (pass < NORMALISED && gap > RITZ_NEARLY_NORMAL); pass++) {
        RITZ_OWN(ritz_dense) G = {0};

        RITZ_CHECK(ritz_tall_inner(Q, WQ, &G));
        ritz_dense_symmetrise(&G);
        gap = measure_gap(&G);
        RITZ_CHECK(factor_cholesky(&G));
        ritz_tall_divide(&G, Q);
        if (pass == 0)
            RITZ_CHECK(weigh_columns(set, Q, WQ));
        else
            ritz_tall_divide(&G, WQ);
    }
    return RITZ_OK;
}

enum {
    MOST_PASSES = 8,
    WORTHWHILE = 5000, /* rows from which several threads copy columns */
};

/* A block on its way; column j of R was column source[j] of what came in. */
typedef struct column_block {
    ritz_dense R, WR; /* the first R.ncol columns are left */
    int64_t *source;
    double *size;  /* r'Wr of each column */
    double *whole; /* of the column that came in */
    double *least; /* of what is rounding of the column that came in */
    bool settled;  /* no column shrinks any more */
} column_block;

static ritz_status column_block_new(int64_t count, column_block *b)
{
    RITZ_CHECK_NEW(b->source, count);
    RITZ_CHECK_NEW(b->size, count);
    RITZ_CHECK_NEW(b->whole, count);
    RITZ_CHECK_NEW(b->least, count);
    return RITZ_OK;
}

static void column_block_free(column_block *b)
{
    RITZ_FREE(b->source, b->size, b->whole, b->least); /* R is borrowed */
}

static void copy_column(ritz_dense *A, int64_t from, int64_t to)
{
    if (from != to && A->nrow > 0)
        memcpy(ritz_dense_col(A, to), ritz_dense_col(A, from),
               (size_t)A->nrow * sizeof *A->val);
}

/* Column `from` becomes column `to`. */
static void move_column(column_block *b, int64_t from, int64_t to)
{
    copy_column(&b->R, from, to);
    copy_column(&b->WR, from, to);
    b->source[to] = b->source[from];
    b->size[to] = b->size[from];
    b->whole[to] = b->whole[from];
    b->least[to] = b->least[from];
}

/* Whether something is left of column j. */
static bool is_left(const column_block *b, int64_t j, double tolerance)
{
    const double size = b->size[j];

    return size > 0.0 && isfinite(size) &&
           size > tolerance * tolerance * b->whole[j] && size > b->least[j];
}

/* Whether each column that is left is longer than its part H along V by a
   factor so large that R - V H is as exact as R. */
static bool barely_changes(const column_block *b, const ritz_dense *H,
                           double tolerance)
{
    for (int64_t j = 0; j < b->R.ncol; j++)
        if (is_left(b, j, tolerance) &&
            !(ritz_dense_dot(H, j, H, j) <= RITZ_SMALL_CHANGE * b->size[j]))
            return false;
    return true;
}

/* R := R - V (WV)' R */
static ritz_status project_out(const ritz_orthonormal *set, column_block *b)
{
    const ritz_dense V = ritz_dense_part(&set->V, 0, set->count);
    const ritz_dense WV = ritz_dense_part(&set->WV, 0, set->count);
    RITZ_OWN(ritz_dense) H = {0};

    RITZ_CHECK(ritz_tall_inner(&WV, &b->R, &H));
    ritz_tall_subtract(&V, &H, &b->R);
    if (barely_changes(b, &H, set->tolerance))
        ritz_tall_subtract(&WV, &H, &b->WR);
    else
        RITZ_CHECK(ritz_tall_weigh(set->W, &b->R, &b->WR));
    ritz_tall_dots(&b->R, &b->WR, b->size);
    return RITZ_OK;
}

/* Whether a column that is not nothing yet has lost half its energy. */
static bool still_falls(const column_block *b, const double *before,
                        double tolerance)
{
    for (int64_t j = 0; j < b->R.ncol; j++)
        if (b->size[j] < 0.5 * before[j] &&
            b->size[j] > tolerance * tolerance * b->whole[j] &&
            b->size[j] > b->least[j])
            return true;
    return false;
}

/* Whether what one pass has left of V in R is too small to count where columns
   are compared. */
static bool is_clear(const column_block *b, double tolerance)
{
    for (int64_t j = 0; j < b->R.ncol; j++)
        if (is_left(b, j, tolerance) &&
            !(b->size[j] > RITZ_CLEAR_OF_ROUNDING * b->least[j]))
            return false;
    return true;
}

/*
 * R - V (WV)'R until no column shrinks any more: twice, or oftener where W
 * blurs sums.
 *
 * @param[in] once  one pass will do if it leaves the columns clear of rounding
 */
static ritz_status orthogonalise_block(const ritz_orthonormal *set, bool once,
                                       column_block *b)
{
    RITZ_OWN_ARRAY double *before = NULL;
    bool falls = set->count > 0 && b->R.ncol > 0;

    RITZ_CHECK_NEW(before, b->R.ncol);
    for (int pass = 0; pass < MOST_PASSES && falls; pass++) {
        for (int64_t j = 0; j < b->R.ncol; j++)
            before[j] = b->size[j];
        RITZ_CHECK(project_out(set, b));
        b->settled = pass > 0;
        if (pass == 0 && once && is_clear(b, set->tolerance))
            return RITZ_OK;
        falls = pass == 0 || still_falls(b, before, set->tolerance);
    }
    return RITZ_OK;
}

/* Columns of which nothing is left are dropped. */
static void drop_columns(column_block *b, double tolerance)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < b->R.ncol; j++)
        if (is_left(b, j, tolerance))
            move_column(b, j, kept++);
    b->R.ncol = b->WR.ncol = kept;
}

/*
 * Measure the columns of the incoming block R, and drop those that are zero.
 * Entries of r are known to eps, so that e' W e <= eps^2 |r|' |W| |r| is
 * rounding.
 */
static ritz_status measure_block(const ritz_sparse *W, column_block *b)
{
    const double eps = RITZ_ENTRY_ROUNDING * DBL_EPSILON;

    RITZ_CHECK(ritz_tall_weigh_sizes(W, &b->R, &b->R, &b->WR, b->least));
    ritz_tall_dots(&b->R, &b->WR, b->size);
    for (int64_t j = 0; j < b->R.ncol; j++) {
        b->whole[j] = b->size[j];
        b->least[j] *= eps * eps;
    }
    drop_columns(b, 0.0);
    return RITZ_OK;
}

/* A with room for `room` columns, of which `count` are kept. */
static ritz_status widen_columns(ritz_dense *A, int64_t count, int64_t room)
{
    ritz_dense wide = {0};

    RITZ_CHECK(ritz_tall_new(A->nrow, room, &wide));
    ritz_dense_put(&(ritz_dense){A->nrow, count, A->val}, 0, 0, &wide);
    ritz_dense_replace(A, &wide);
    return RITZ_OK;
}

/* Room for more columns; pages that stay unused take no memory. */
static ritz_status reserve_columns(ritz_orthonormal *set, int64_t more)
{
    int64_t need = set->count + more;
    int64_t room = set->count + set->count / 2 + more;

    if (set->expected >= need && set->expected <= need + need / 2)
        room = set->expected; /* so that the columns are not moved again */
    if (set->V.ncol < need)
        RITZ_CHECK(widen_columns(&set->V, set->count, room));
    if (set->WV.ncol < need)
        RITZ_CHECK(widen_columns(&set->WV, set->count, room));
    return RITZ_OK;
}

/* Columns of a block that become Q and WQ. */
typedef struct chosen_columns {
    const column_block *b;
    const int64_t *order;
    ritz_dense Q, WQ;
} chosen_columns;

/* q := r / |r|, |r|^2 = r'Wr, and Wq with it. */
static void copy_scaled(int thread, int64_t from, int64_t to, void *task)
{
    const chosen_columns *c = task;

    (void)thread;
    for (int64_t k = from; k < to; k++) {
        const int64_t j = c->order[k];
        const double factor = 1.0 / sqrt(c->b->size[j]);
        const double *r = ritz_dense_col(&c->b->R, j);
        const double *w = ritz_dense_col(&c->b->WR, j);
        double *q = ritz_dense_col(&c->Q, k);
        double *wq = ritz_dense_col(&c->WQ, k);

        for (int64_t i = 0; i < c->b->R.nrow; i++) {
            q[i] = factor * r[i];
            wq[i] = factor * w[i];
        }
    }
}

/* The other passes of columns that were chosen after one. */
static ritz_status settle_columns(const ritz_orthonormal *set,
                                  const column_block *b, const int64_t *order,
                                  ritz_dense *Q, ritz_dense *WQ)
{
    RITZ_OWN(column_block) q = {.R = *Q, .WR = *WQ};

    RITZ_CHECK(column_block_new(Q->ncol, &q));
    for (int64_t k = 0; k < Q->ncol; k++) {
        q.size[k] = 1.0;
        q.whole[k] = b->whole[order[k]] / b->size[order[k]];
        q.least[k] = b->least[order[k]] / b->size[order[k]];
    }
    return orthogonalise_block(set, false, &q);
}

/* Move the strong columns of the block into the set; the others move up. */
static ritz_status take_columns(ritz_orthonormal *set, column_block *b,
                                int64_t count, const int64_t *order,
                                bool *taken)
{
    ritz_dense Q = {0}, WQ = {0};
    int64_t kept = 0;

    Q = ritz_dense_part(&set->V, set->count, count);
    WQ = ritz_dense_part(&set->WV, set->count, count);
    ritz_team_over(ritz_team_ready(Q.nrow < WORTHWHILE ? 1 : count), count,
                   copy_scaled, &(chosen_columns){b, order, Q, WQ});
    if (!b->settled && set->count > 0)
        RITZ_CHECK(settle_columns(set, b, order, &Q, &WQ));
    RITZ_CHECK(normalise_columns(set, &Q, &WQ));
    set->count += count;
    for (int64_t j = 0; j < b->R.ncol; j++) {
        bool gone = false;

        for (int64_t k = 0; k < count; k++)
            gone = gone || order[k] == j;
        if (gone && taken)
            taken[b->source[j]] = true;
        if (!gone)
            move_column(b, j, kept++);
    }
    b->R.ncol = b->WR.ncol = kept;
    return RITZ_OK;
}

/* G := R'WR of columns scaled to one. */
static ritz_status compare_columns(const column_block *b, ritz_dense *G)
{
    RITZ_CHECK(ritz_tall_inner(&b->R, &b->WR, G));
    ritz_dense_symmetrise(G);
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->nrow; i++)
            ritz_dense_col(G, j)[i] /= sqrt(b->size[i]) * sqrt(b->size[j]);
    return RITZ_OK;
}

/*
 * The least pivot of a strong column. Products of columns are known to eps times
 * the sizes of their terms, of which b->least is eps^2 times the square of
 * RITZ_ENTRY_ROUNDING: pivots far above this are those of independent columns.
 * Beside other columns V only strong pivots are taken: what rounding leaves of V
 * in R is divided by the square root of the pivot.
 */
static double strong_pivot(const ritz_orthonormal *set, const column_block *b)
{
    const double eps = RITZ_ENTRY_ROUNDING * DBL_EPSILON;
    double rounding = 0.0;

    if (set->count > 0)
        return RITZ_PIVOT_STRONG;
    for (int64_t j = 0; j < b->R.ncol; j++)
        rounding = fmax(rounding,
                        DBL_EPSILON * b->least[j] / (eps * eps * b->size[j]));
    return fmin(RITZ_PIVOT_STRONG,
                fmax(RITZ_PIVOT_CLEAR, RITZ_PIVOT_ROUNDING * rounding));
}

/*
 * One round: what is left of the block against V, and its strong columns.
 * set->left becomes the number of strong columns beyond @p most.
 */
static ritz_status go_round(ritz_orthonormal *set, column_block *b,
                            int64_t most, int64_t *order, bool *taken)
{
    RITZ_OWN(ritz_dense) G = {0};
    double strong = RITZ_PIVOT_STRONG;
    int64_t count = 0;

    RITZ_CHECK(orthogonalise_block(set, b->R.ncol > most, b));
    drop_columns(b, set->tolerance);
    if (b->R.ncol == 0)
        return RITZ_OK;
    strong = strong_pivot(set, b);
    RITZ_CHECK(compare_columns(b, &G));
    count = ritz_pivots_find(&G, strong, RITZ_TIE, most, order);
    for (int64_t j = 0; j < G.ncol; j++)
        set->left += ritz_dense_col(&G, j)[j] > strong;
    return take_columns(set, b, count, order, taken);
}

ritz_status ritz_orthonormal_append(ritz_orthonormal *set, ritz_dense *R,
                                    int64_t most, bool *taken)
{
    RITZ_OWN(column_block) b = {.R = *R};
    RITZ_OWN(ritz_dense) WR = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;
    int64_t before = set->count;

    RITZ_CHECK(column_block_new(R->ncol, &b));
    RITZ_CHECK(ritz_tall_new(R->nrow, R->ncol, &WR));
    RITZ_CHECK_NEW(order, R->ncol);
    b.WR = WR;
    for (int64_t j = 0; j < R->ncol; j++) {
        b.source[j] = j;
        if (taken)
            taken[j] = false;
    }
    RITZ_CHECK(measure_block(set->W, &b));
    RITZ_CHECK(reserve_columns(set, b.R.ncol < most ? b.R.ncol : most));
    set->left = 0;
    while (b.R.ncol > 0 && set->count - before < most)
        RITZ_CHECK(
            go_round(set, &b, most - (set->count - before), order, taken));
    if (set->left > 0)
        return RITZ_OK;
    RITZ_CHECK(orthogonalise_block(set, false, &b));
    drop_columns(&b, set->tolerance);
    set->left = b.R.ncol;
    return RITZ_OK;
}

ritz_status ritz_orthonormal_new(int64_t n, const ritz_sparse *W,
                                 double tolerance, ritz_orthonormal *out)
{
    RITZ_OWN(ritz_orthonormal) set = {.W = W, .tolerance = tolerance};

    RITZ_CHECK(ritz_dense_new(n, 0, &set.V));
    RITZ_CHECK(ritz_dense_new(n, 0, &set.WV));
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

ritz_status ritz_orthonormal_express(ritz_orthonormal *set, ritz_dense *R,
                                     int64_t most, ritz_dense *at)
{
    RITZ_OWN(ritz_dense) raw = {0};
    ritz_dense WV = {0};

    RITZ_CHECK(ritz_dense_copy(R, &raw));
    RITZ_CHECK(ritz_orthonormal_append(set, R, most, NULL));
    WV = ritz_dense_part(&set->WV, 0, set->count);
    return ritz_dense_mul_tn(&WV, &raw, at);
}

void ritz_orthonormal_free(ritz_orthonormal *set)
{
    ritz_dense_free(&set->V);
    ritz_dense_free(&set->WV);
    *set = (ritz_orthonormal){0};
}
