/*
 * Block Gram-Schmidt, twice or more, then what is independent within the block:
 *
 *     R <- R - V (WV)' R                            (until no R shrinks)
 *     G = R' W R with columns scaled to one = L L', pivoted, as far as its
 *     pivots stay strong;   Q = R_pivots L^-T                (twice)
 *
 * Columns whose pivot was weak go through all of it again, now against Q too,
 * until nothing of them is left: a round resolves only directions that rounding
 * has not blurred, and the energies of the rounds multiply. W R is made by a
 * product after every change of R: carried along by the same sums, it drifts
 * away from R, by the inverse of what is new in a column, at every block.
 */
#include "linear/orthonormal.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* WR := W R; W NULL is the identity. */
static ritz_status weigh_columns(const ritz_sparse *W, const ritz_dense *R,
                                 ritz_dense *WR)
{
    RITZ_OWN(ritz_dense) product = {0};

    if (R->nrow * R->ncol == 0)
        return RITZ_OK;
    if (W)
        RITZ_CHECK(ritz_sparse_mul(W, R, &product));
    memcpy(WR->val, W ? product.val : R->val,
           (size_t)(R->nrow * R->ncol) * sizeof *R->val);
    return RITZ_OK;
}

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

/* Q := Q L^-T with Q'WQ = L L', twice, and WQ with it; pivots are strong. */
static ritz_status normalise_columns(const ritz_sparse *W, ritz_dense *Q,
                                     ritz_dense *WQ)
{
    RITZ_OWN(ritz_dense) G = {0};
    int n = (int)Q->nrow;
    int p = (int)Q->ncol;

    for (int pass = 0; pass < 2; pass++) {
        RITZ_CHECK(ritz_dense_mul_tn(Q, WQ, &G));
        ritz_dense_symmetrise(&G);
        RITZ_CHECK(factor_cholesky(&G));
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans,
                    CblasNonUnit, n, p, 1.0, G.val, p, Q->val, n);
        RITZ_CHECK(weigh_columns(W, Q, WQ));
        ritz_dense_free(&G);
    }
    return RITZ_OK;
}

enum { MOST_PASSES = 8 };

/* A block on its way; column j of R was column source[j] of what came in. */
typedef struct column_block {
    ritz_dense R, WR; /* the first R.ncol columns are left */
    int64_t *source;
    double *energy; /* of what is left, of the column that came in */
    double *least;  /* energy that is rounding of the column that came in */
} column_block;

static void column_block_free(column_block *b)
{
    ritz_dense_free(&b->WR); /* R is borrowed */
    RITZ_FREE(b->source, b->energy, b->least);
}

static void scale_column(ritz_dense *A, int64_t j, double factor)
{
    double *a = ritz_dense_col(A, j);

    for (int64_t i = 0; i < A->nrow; i++)
        a[i] *= factor;
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
    b->least[to] = b->least[from];
    b->energy[to] = b->energy[from];
}

/* A := A - B H, of what is kept as columns. */
static void subtract_product(const ritz_dense *B, const ritz_dense *H,
                             ritz_dense *A)
{
    if (A->nrow > 0 && A->ncol > 0 && B->ncol > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)A->nrow,
                    (int)A->ncol, (int)B->ncol, -1.0, B->val, (int)B->nrow,
                    H->val, (int)H->nrow, 1.0, A->val, (int)A->nrow);
}

/* R := R - V (WV)' R */
static ritz_status project_out(const ritz_orthonormal *set, column_block *b)
{
    const ritz_dense V = ritz_dense_part(&set->V, 0, set->count);
    const ritz_dense WV = ritz_dense_part(&set->WV, 0, set->count);
    RITZ_OWN(ritz_dense) H = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&WV, &b->R, &H));
    subtract_product(&V, &H, &b->R);
    return weigh_columns(set->W, &b->R, &b->WR);
}

/* Whether a column that is not nothing yet has lost half its energy. */
static bool still_falls(const column_block *b, const double *before,
                        double tolerance)
{
    for (int64_t j = 0; j < b->R.ncol; j++) {
        double size = ritz_dense_dot(&b->R, j, &b->WR, j);
        double left = b->energy[j] * size;

        if (size < 0.5 * before[j] && left > tolerance * tolerance &&
            left > b->least[j])
            return true;
    }
    return false;
}

/* Until no column shrinks any more: twice, or oftener where W blurs sums. */
static ritz_status orthogonalise_block(const ritz_orthonormal *set,
                                       column_block *b)
{
    RITZ_OWN_ARRAY double *before = NULL;
    bool falls = set->count > 0 && b->R.ncol > 0;

    RITZ_CHECK_NEW(before, b->R.ncol);
    for (int pass = 0; pass < MOST_PASSES && falls; pass++) {
        for (int64_t j = 0; j < b->R.ncol; j++)
            before[j] = ritz_dense_dot(&b->R, j, &b->WR, j);
        RITZ_CHECK(project_out(set, b));
        falls = pass == 0 || still_falls(b, before, set->tolerance);
    }
    return RITZ_OK;
}

/* Scale what is left to one; columns of which nothing is left are dropped. */
static void drop_columns(column_block *b, double tolerance)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < b->R.ncol; j++) {
        double size = ritz_dense_dot(&b->R, j, &b->WR, j);
        double left = b->energy[j] * size;

        if (!(size > 0.0 && isfinite(size) && left > tolerance * tolerance &&
              left > b->least[j]))
            continue;
        scale_column(&b->R, j, 1.0 / sqrt(size));
        scale_column(&b->WR, j, 1.0 / sqrt(size));
        b->energy[j] = left;
        move_column(b, j, kept++);
    }
    b->R.ncol = b->WR.ncol = kept;
}

/*
 * Columns of the incoming block R are scaled to one, and zero columns dropped.
 * Entries of r are known to eps, so that e' W e <= eps^2 |r|' |W| |r| is
 * rounding.
 */
static ritz_status scale_block(const ritz_sparse *W, column_block *b)
{
    const double eps = RITZ_ENTRY_ROUNDING * DBL_EPSILON;
    RITZ_OWN(ritz_dense) size = {0};

    if (W && b->R.nrow > 0)
        RITZ_CHECK(ritz_sparse_mul_sizes(W, &b->R, &b->WR, &size));
    else
        RITZ_CHECK(ritz_dense_copy(&b->R, &b->WR));
    for (int64_t j = 0; j < b->R.ncol; j++) {
        const double *r = ritz_dense_col(&b->R, j);
        const double *all = ritz_dense_col(W && size.val ? &size : &b->R, j);
        double sum = 0.0;

        for (int64_t i = 0; i < b->R.nrow; i++)
            sum += fabs(r[i] * all[i]);
        b->least[j] = eps * eps * sum;
        b->energy[j] = 1.0;
    }
    drop_columns(b, 0.0);
    for (int64_t j = 0; j < b->R.ncol; j++) {
        b->least[j] /= b->energy[j]; /* of the column scaled to one */
        b->energy[j] = 1.0;
    }
    return RITZ_OK;
}

/* A with room for `room` columns, of which `count` are kept. */
static ritz_status widen_columns(ritz_dense *A, int64_t count, int64_t room)
{
    ritz_dense wide = {0};

    RITZ_CHECK(ritz_dense_new(A->nrow, room, &wide));
    ritz_dense_put(&(ritz_dense){A->nrow, count, A->val}, 0, 0, &wide);
    ritz_dense_replace(A, &wide);
    return RITZ_OK;
}

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

/* Move the strong columns of the block into the set; the others move up. */
static ritz_status take_columns(ritz_orthonormal *set, column_block *b,
                                int64_t count, const int64_t *order,
                                bool *taken)
{
    ritz_dense Q = {0}, WQ = {0};
    int64_t kept = 0;
    size_t size = (size_t)b->R.nrow * sizeof *b->R.val;

    RITZ_CHECK(reserve_columns(set, count));
    Q = ritz_dense_part(&set->V, set->count, count);
    WQ = ritz_dense_part(&set->WV, set->count, count);
    for (int64_t k = 0; k < count && size > 0; k++) {
        memcpy(ritz_dense_col(&Q, k), ritz_dense_col(&b->R, order[k]), size);
        memcpy(ritz_dense_col(&WQ, k), ritz_dense_col(&b->WR, order[k]), size);
    }
    RITZ_CHECK(normalise_columns(set->W, &Q, &WQ));
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

/*
 * One round: what is left of the block against V, and its strong columns.
 * set->left becomes the number of strong columns beyond @p most.
 */
static ritz_status go_round(ritz_orthonormal *set, column_block *b,
                            int64_t most, int64_t *order, bool *taken)
{
    RITZ_OWN(ritz_dense) G = {0};
    int64_t count = 0;

    RITZ_CHECK(orthogonalise_block(set, b));
    drop_columns(b, set->tolerance);
    if (b->R.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&b->R, &b->WR, &G));
    ritz_dense_symmetrise(&G);
    count = ritz_pivots_find(&G, RITZ_PIVOT_STRONG, RITZ_TIE, most, order);
    for (int64_t j = 0; j < G.ncol; j++)
        set->left += ritz_dense_col(&G, j)[j] > RITZ_PIVOT_STRONG;
    return take_columns(set, b, count, order, taken);
}

ritz_status ritz_orthonormal_append(ritz_orthonormal *set, ritz_dense *R,
                                    int64_t most, bool *taken)
{
    RITZ_OWN(column_block) b = {.R = *R};
    RITZ_OWN_ARRAY int64_t *order = NULL;
    int64_t before = set->count;

    RITZ_CHECK_NEW(b.source, R->ncol);
    RITZ_CHECK_NEW(b.energy, R->ncol);
    RITZ_CHECK_NEW(b.least, R->ncol);
    RITZ_CHECK_NEW(order, R->ncol);
    for (int64_t j = 0; j < R->ncol; j++) {
        b.source[j] = j;
        if (taken)
            taken[j] = false;
    }
    RITZ_CHECK(scale_block(set->W, &b));
    set->left = 0;
    while (b.R.ncol > 0 && set->count - before < most)
        RITZ_CHECK(
            go_round(set, &b, most - (set->count - before), order, taken));
    if (set->left > 0)
        return RITZ_OK;
    RITZ_CHECK(orthogonalise_block(set, &b));
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
