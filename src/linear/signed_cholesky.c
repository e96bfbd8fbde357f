/*
 * Left-looking, supernode by supernode [NgPeyton1993]. With columns s of a
 * supernode and rows r at and below them:
 *
 *     X := A(r, s) - sum over d of L(r, d) S_d L(s, d)'
 *     X(s, s) = L_s S_s L_s',   L(r, s) = X(r, s) L_s'^-1 S_s
 *
 * where d runs over the finished supernodes with rows in s. Each d is in a
 * linked list that belongs to one supernode: the one that contains its first
 * row which has not been used yet.
 *
 * All columns of a supernode have the same rows, so that they may be exchanged:
 * in each panel of 64 columns the largest remaining pivot comes next. Without
 * this, one shift of four had a backward error above 1e-12 (model S10 of the
 * benchmarks); with it the error was 1e-14. During the factorisation rows keep
 * the number that the analysis gave them, here called their label; L and its
 * permutation are renumbered at the end.
 */
#include "linear/signed_cholesky.h"

#include "base/alloc.h"
#include "base/team.h"
#include "linear/blas_threads.h"

#include <cblas.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    PANEL = 64,          /* columns factored before the rest is updated */
    STRIP = 256,         /* columns of one update by a matrix product */
    SHARE = 8,           /* subtrees for each thread, to balance the loads */
    WORTHWHILE = 400000, /* entries of L from which one more thread is used */
};

/* Memory of one thread. */
typedef struct worker {
    int64_t *at;    /* position of each row in the present supernode */
    double *update; /* L(r, d) S_d L(s, d)' of one d */
    double *scaled; /* L(s, d) S_d, some columns of it */
    bool singular;  /* a pivot was zero or not finite */
} worker;

typedef struct factoring {
    const ritz_sparse *A;
    cholmod_factor *L;
    double *sign;
    int threads;
    int64_t count;  /* number of supernodes */
    int64_t most;   /* number of columns of the widest supernode */
    int64_t *place; /* row of L, as analysed, of each row of A */
    int64_t *of;    /* supernode of each column of L */
    int64_t *label; /* of each column of L: its number in the analysis */
    /* of each supernode */
    int64_t *parent;  /* in the elimination tree, -1 for a root */
    int64_t *pending; /* index of the first row that has not been used yet */
    int64_t *head;    /* first supernode of its list, or -1 */
    int64_t *next;    /* the supernode after it in the list it is in, or -1 */
    int *owner;       /* thread that factors it, -1 for the top of the tree */
    worker *crew;
} factoring;

static void factoring_free(factoring *F)
{
    for (int k = 0; F->crew && k < F->threads; k++)
        RITZ_FREE(F->crew[k].at, F->crew[k].update, F->crew[k].scaled);
    RITZ_FREE(F->place, F->of, F->label, F->parent, F->pending, F->head,
              F->next, F->owner, F->crew);
}

/* Supernode s of L: its columns, its rows and its values, rows x cols. */
typedef struct signed_node {
    int64_t first, cols, rows;
    const int64_t *row;
    double *values;
} signed_node;

static signed_node supernode_of(const factoring *F, int64_t s)
{
    const int64_t *super = F->L->super, *pi = F->L->pi, *px = F->L->px;
    const int64_t *row = F->L->s;
    double *x = F->L->x;

    return (signed_node){super[s], super[s + 1] - super[s], pi[s + 1] - pi[s],
                         row + pi[s], x + px[s]};
}

/* --- the tree ------------------------------------------------------------- */

/* Fill the arrays of rows, columns and supernodes from the analysis. */
static void survey_factor(factoring *F)
{
    const int64_t *perm = F->L->Perm;

    for (int64_t k = 0; k < F->A->nrow; k++)
        F->place[perm[k]] = F->label[k] = k;
    for (int64_t s = 0; s < F->count; s++) {
        const signed_node node = supernode_of(F, s);

        for (int64_t j = 0; j < node.cols; j++)
            F->of[node.first + j] = s;
        F->most = node.cols > F->most ? node.cols : F->most;
        F->pending[s] = node.cols;
        F->head[s] = F->next[s] = -1;
    }
    for (int64_t s = 0; s < F->count; s++) {
        const signed_node node = supernode_of(F, s);

        F->parent[s] =
            node.rows > node.cols ? F->of[node.row[node.cols]] : (int64_t)-1;
    }
}

/* Assign supernodes to threads. A subtree with less than 1 / (SHARE threads) of
   all operations goes as a whole to the thread with the least work so far; what
   is above such subtrees is the top, and has no owner. */
static ritz_status share_tree(factoring *F)
{
    RITZ_OWN_ARRAY double *work = NULL, *load = NULL;
    double whole = 0.0;

    RITZ_CHECK_NEW(work, F->count);
    RITZ_CHECK_NEW(load, F->threads);
    for (int64_t s = 0; s < F->count; s++) {
        const signed_node node = supernode_of(F, s);

        work[s] += (double)node.cols * (double)node.rows * (double)node.rows;
        if (F->parent[s] >= 0)
            work[F->parent[s]] += work[s];
        else
            whole += work[s];
    }
    for (int64_t s = F->count - 1; s >= 0; s--) {
        int least = 0;

        F->owner[s] = F->parent[s] >= 0 ? F->owner[F->parent[s]] : -1;
        if (F->owner[s] >= 0 || F->threads == 1 ||
            work[s] * SHARE * F->threads > whole)
            continue;
        for (int k = 1; k < F->threads; k++)
            least = load[k] < load[least] ? k : least;
        F->owner[s] = least;
        load[least] += work[s];
    }
    return RITZ_OK;
}

static ritz_status allocate_factoring(factoring *F)
{
    RITZ_CHECK_NEW(F->place, F->A->nrow);
    RITZ_CHECK_NEW(F->of, F->A->nrow);
    RITZ_CHECK_NEW(F->label, F->A->nrow);
    RITZ_CHECK_NEW(F->parent, F->count);
    RITZ_CHECK_NEW(F->pending, F->count);
    RITZ_CHECK_NEW(F->head, F->count);
    RITZ_CHECK_NEW(F->next, F->count);
    RITZ_CHECK_NEW(F->owner, F->count);
    RITZ_CHECK_NEW(F->crew, F->threads);
    survey_factor(F);
    for (int k = 0; k < F->threads; k++) {
        RITZ_CHECK_NEW(F->crew[k].at, F->A->nrow);
        RITZ_CHECK_NEW(F->crew[k].update, (int64_t)F->L->maxcsize);
        RITZ_CHECK_NEW(F->crew[k].scaled, F->most * STRIP);
    }
    return share_tree(F);
}

/* --- one supernode -------------------------------------------------------- */

/* X := A(r, s), where X is zero on entry. */
static void load_columns(const factoring *F, const signed_node *node,
                         const int64_t *at)
{
    const ritz_sparse *A = F->A;
    const int64_t *perm = F->L->Perm;

    for (int64_t k = 0; k < node->cols; k++) {
        const int64_t j = perm[node->first + k];

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int64_t row = F->place[A->rowind[p]];

            if (row >= node->first + k)
                node->values[at[row] + k * node->rows] = A->val[p];
        }
    }
}

/* to := A(rows, cols) S, rows x cols. */
static void scale_columns(int64_t rows, int64_t cols, const double *A,
                          int64_t stride, const double *sign, double *to)
{
    for (int64_t j = 0; j < cols; j++)
        for (int64_t i = 0; i < rows; i++)
            to[i + j * rows] = sign[j] * A[i + j * stride];
}

/* X -= L(r, d) S_d L(s, d)' of one supernode d. Its rows in s are then used. */
static void apply_descendant(factoring *F, int64_t d, const signed_node *node,
                             worker *w)
{
    const signed_node from = supernode_of(F, d);
    const int64_t first = F->pending[d];
    const int64_t rows = from.rows - first;
    const int64_t *row = from.row + first;
    const double *L = from.values + first;
    int64_t cols = 0;

    while (cols < rows && row[cols] < node->first + node->cols)
        cols++;
    for (int64_t k = 0; k < from.cols; k += STRIP) {
        const int64_t inner = from.cols - k < STRIP ? from.cols - k : STRIP;
        const double *part = L + k * from.rows;

        scale_columns(cols, inner, part, from.rows, F->sign + from.first + k,
                      w->scaled);
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, (int)rows,
                    (int)cols, (int)inner, 1.0, part, (int)from.rows, w->scaled,
                    (int)cols, k > 0 ? 1.0 : 0.0, w->update, (int)rows);
    }
    for (int64_t j = 0; j < cols; j++) {
        double *to = node->values + (row[j] - node->first) * node->rows;

        for (int64_t i = j; i < rows; i++)
            to[w->at[row[i]]] -= w->update[i + j * rows];
    }
    F->pending[d] += cols;
}

static void swap_values(int64_t count, double *a, double *b, int64_t stride)
{
    for (int64_t i = 0; i < count; i++) {
        const double kept = a[i * stride];

        a[i * stride] = b[i * stride];
        b[i * stride] = kept;
    }
}

/* Exchange columns p < q of a supernode, and rows p and q, in the stored lower
   triangle. Columns before p are factored already. */
static void exchange_columns(const signed_node *node, int64_t p, int64_t q,
                             int64_t *label)
{
    const int64_t ld = node->rows;
    double *X = node->values;
    const int64_t kept = label[p];

    swap_values(p, X + p, X + q, ld);
    swap_values(1, X + p + p * ld, X + q + q * ld, 1);
    for (int64_t i = p + 1; i < q; i++)
        swap_values(1, X + i + p * ld, X + q + i * ld, 1);
    swap_values(ld - q - 1, X + q + 1 + p * ld, X + q + 1 + q * ld, 1);
    label[p] = label[q];
    label[q] = kept;
}

/* Move the largest of the diagonal entries [from, to) to `from`. */
static void choose_pivot(const signed_node *node, int64_t from, int64_t to,
                         int64_t *label)
{
    const int64_t step = node->rows + 1;
    int64_t at = from;

    for (int64_t j = from + 1; j < to; j++)
        if (fabs(node->values[j * step]) > fabs(node->values[at * step]))
            at = j;
    if (at > from)
        exchange_columns(node, from, at, label);
}

/* A = L S L' of the diagonal block of rows and columns [from, to) of a
   supernode; false if a pivot is zero or not finite. */
static bool factor_triangle(const signed_node *node, int64_t from, int64_t to,
                            double *sign, int64_t *label)
{
    for (int64_t j = from; j < to; j++) {
        double *a = node->values + j * node->rows;
        double size = 0.0;

        choose_pivot(node, j, to, label);
        size = sqrt(fabs(a[j]));
        if (!(size > 0.0 && isfinite(size)))
            return false;
        sign[j] = a[j] < 0.0 ? -1.0 : 1.0;
        a[j] = size;
        for (int64_t i = j + 1; i < to; i++)
            a[i] /= sign[j] * size;
        for (int64_t k = j + 1; k < to; k++)
            for (int64_t i = k; i < to; i++)
                node->values[i + k * node->rows] -= a[i] * sign[j] * a[k];
    }
    return true;
}

/* L(r, s) from X, by panels; false if a pivot is zero or not finite. */
static bool factor_supernode(const signed_node *node, double *sign,
                             int64_t *label, double *scaled)
{
    const int64_t ld = node->rows;

    for (int64_t k = 0; k < node->cols; k += PANEL) {
        const int64_t cols = node->cols - k < PANEL ? node->cols - k : PANEL;
        const int64_t below = ld - k - cols;
        double *X = node->values + k + k * ld;

        if (!factor_triangle(node, k, k + cols, sign, label))
            return false;
        if (below == 0)
            continue;
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans,
                    CblasNonUnit, (int)below, (int)cols, 1.0, X, (int)ld,
                    X + cols, (int)ld);
        for (int64_t j = 0; j < cols; j++)
            for (int64_t i = cols; sign[k + j] < 0.0 && i < ld - k; i++)
                X[i + j * ld] = -X[i + j * ld];
        for (int64_t c = k + cols; c < node->cols; c += STRIP) {
            const int64_t some =
                node->cols - c < STRIP ? node->cols - c : STRIP;
            const double *from = node->values + c + k * ld;

            scale_columns(some, cols, from, ld, sign + k, scaled);
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, (int)(ld - c),
                        (int)some, (int)cols, -1.0, from, (int)ld, scaled,
                        (int)some, 1.0, node->values + c + c * ld, (int)ld);
        }
    }
    return true;
}

/* Put d into the list of the supernode that contains its next row, unless that
   supernode has another owner. */
static void enlist(factoring *F, int64_t d, int owner)
{
    const signed_node node = supernode_of(F, d);
    int64_t s = 0;

    if (F->pending[d] >= node.rows)
        return;
    s = F->of[node.row[F->pending[d]]];
    if (F->owner[s] != owner)
        return;
    F->next[d] = F->head[s];
    F->head[s] = d;
}

static void make_supernode(factoring *F, int64_t s, worker *w)
{
    const signed_node node = supernode_of(F, s);

    for (int64_t i = 0; i < node.rows; i++)
        w->at[node.row[i]] = i;
    load_columns(F, &node, w->at);
    for (int64_t d = F->head[s], next = 0; d >= 0; d = next) {
        next = F->next[d];
        apply_descendant(F, d, &node, w);
        enlist(F, d, F->owner[s]);
    }
    if (!factor_supernode(&node, F->sign + node.first, F->label + node.first,
                          w->scaled))
        w->singular = true;
    enlist(F, s, F->owner[s]);
}

/* Factor the subtrees that this thread owns. */
static void factor_subtrees(int thread, int threads, void *task)
{
    factoring *F = task;
    worker *w = &F->crew[thread];

    (void)threads;
    for (int64_t s = 0; s < F->count && !w->singular; s++)
        if (F->owner[s] == thread)
            make_supernode(F, s, w);
}

/* Factor the subtrees by threads, each with a BLAS of one thread, and then the
   top by one thread with a BLAS of several. False if a pivot is zero. */
static bool factor_tree(factoring *F)
{
    const int before = ritz_blas_threads(1);
    bool singular = false;

    if (F->threads > 1)
        ritz_team_run(F->threads, factor_subtrees, F);
    ritz_blas_threads(before);
    for (int k = 0; k < F->threads; k++)
        singular = singular || F->crew[k].singular;
    for (int64_t s = 0; s < F->count && !singular; s++)
        if (F->owner[s] >= 0)
            enlist(F, s, -1);
    for (int64_t s = 0; s < F->count && !singular; s++)
        if (F->owner[s] < 0) {
            make_supernode(F, s, &F->crew[0]);
            singular = F->crew[0].singular;
        }
    return !singular;
}

/* Renumber the permutation and the rows of L: from labels to the columns that
   they ended in. */
static void place_labels(factoring *F)
{
    const int64_t *pi = F->L->pi;
    int64_t *rows = F->L->s, *perm = F->L->Perm;
    int64_t *place = F->crew[0].at;

    for (int64_t k = 0; k < F->A->nrow; k++)
        place[F->label[k]] = k;
    for (int64_t s = 0; s < F->count; s++) {
        const signed_node node = supernode_of(F, s);
        int64_t *row = rows + pi[s];

        for (int64_t i = node.cols; i < node.rows; i++)
            row[i] = place[row[i]];
    }
    for (int64_t i = 0; i < F->A->nrow; i++) /* F->place: inverse of old perm */
        perm[place[F->place[i]]] = i;
}

ritz_status ritz_signed_cholesky(const ritz_sparse *A, cholmod_factor *L,
                                 cholmod_common *common, double *sign)
{
    const int64_t most = 1 + (int64_t)L->xsize / WORTHWHILE;
    RITZ_OWN(factoring)
    F = {.A = A, .L = L, .count = (int64_t)L->nsuper};

    F.sign = sign;
    F.threads = ritz_team_ready(most < INT_MAX ? (int)most : INT_MAX);
    L->x = cholmod_l_calloc(L->xsize, sizeof(double), common);
    RITZ_REFUSE_IF(!L->x, RITZ_ERR_MEMORY,
                   "no memory for the factor of %" PRId64 " rows", A->nrow);
    L->xtype = CHOLMOD_REAL;
    RITZ_CHECK(allocate_factoring(&F));
    RITZ_REFUSE_IF(!factor_tree(&F), RITZ_ERR_SINGULAR,
                   "the matrix or a leading part of it is singular");
    place_labels(&F);
    return RITZ_OK;
}
