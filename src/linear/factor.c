/*
 * P A P' = L L' by CHOLMOD, packed for solves of many right-hand sides.
 *
 * Whether A is singular must not depend on units: a model mixes N/m with N m.
 * Rounding perturbs A(i,j) by about eps sqrt(A(i,i) A(j,j)), whatever they are
 * [Demmel1989], so the measure is the smallest eigenvalue of
 *
 *     H = S A S,   S = diag(A)^-1/2
 *
 * estimated by inverse iteration from the row with the smallest L(j,j)^2 /
 * A(j,j).
 */
#include "linear/factor.h"
#include "base/alloc.h"
#include "base/memory.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "linear/ordering.h"
#include "linear/signed_cholesky.h"
#include "linear/supernodal.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SWEEPS = 3, /* of inverse iteration: one finds a lone small eigenvalue */
    PAGES = 12 << 20,  /* bytes: buffers of the BLAS, and parts of huge pages
                          that are held twice while L is packed, at most */
    LARGE = 128 << 20, /* bytes of L from which its packing has freed memory
                          returned first */
};

struct ritz_factor {
    int64_t n;
    double entries, operations; /* as CHOLMOD counts them */
    int64_t *order;             /* row k of the factor is row order[k] of A */
    int32_t *place; /* its inverse: row i of A is row place[i] of the factor */
    ritz_supernodal *S;
};

/* What CHOLMOD needs while it factors. */
typedef struct cholesky {
    cholmod_common common;
    cholmod_factor *L;
} cholesky;

static void cholesky_free(cholesky *C)
{
    cholmod_l_free_factor(&C->L, &C->common);
    cholmod_l_finish(&C->common);
}

/* Describe A to CHOLMOD without copying; stype -1 reads the lower triangle. */
static cholmod_sparse view_sparse(const ritz_sparse *A)
{
    return (cholmod_sparse){
        .nrow = (size_t)A->nrow,
        .ncol = (size_t)A->ncol,
        .nzmax = (size_t)A->colptr[A->ncol],
        .p = A->colptr,
        .i = A->rowind,
        .x = A->val,
        .stype = -1,
        .itype = CHOLMOD_LONG,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
        .sorted = 1,
        .packed = 1,
    };
}

static ritz_status copy_diagonal(const ritz_sparse *A, double *a)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_ARGUMENT,
                           "entry (%" PRId64 ", %" PRId64 ") is not finite",
                           A->rowind[p], j);
            if (A->rowind[p] == j)
                a[j] = A->val[p];
        }
    return RITZ_OK;
}

/* d(k) := L(k,k). L is stored in supernodes, columns with the same rows. */
static void copy_pivots(const cholmod_factor *L, double *d)
{
    const int64_t *super = L->super;
    const int64_t *pi = L->pi;
    const int64_t *px = L->px;
    const double *x = L->x;

    for (size_t s = 0; s < L->nsuper; s++) {
        int64_t rows = pi[s + 1] - pi[s];

        for (int64_t k = super[s]; k < super[s + 1]; k++)
            d[k] = x[px[s] + (k - super[s]) * (rows + 1)];
    }
}

/* Smallest L(k,k)^2 / A(k,k), and the row of A where it stands. */
static ritz_status weakest_pivot(const cholmod_factor *L, const double *a,
                                 double *ratio, int64_t *row)
{
    const int64_t *perm = L->Perm;
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(d, (int64_t)L->n);
    copy_pivots(L, d);
    for (size_t k = 0; k < L->n; k++) {
        double r = d[k] * d[k] / a[perm[k]];

        if (r >= *ratio) /* what is not a number is the weakest */
            continue;
        *ratio = r;
        *row = perm[k];
    }
    return RITZ_OK;
}

/* y := y / |y|, and |y|; an infinite one stays as it is. */
static double normalise_vector(int64_t n, double *y)
{
    double largest = 0.0;
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        largest = fabs(y[i]) <= largest ? largest : fabs(y[i]);
    for (int64_t i = 0; i < n; i++)
        sum += y[i] / largest * (y[i] / largest);
    sum = largest * sqrt(sum);
    for (int64_t i = 0; i < n; i++)
        y[i] /= sum;
    return sum;
}

/* Smallest eigenvalue of H, y := H^-1 y from y = e_row. */
static ritz_status smallest_eigenvalue(ritz_factor *F, const double *a,
                                       int64_t row, double *out)
{
    const int64_t n = F->n;
    RITZ_OWN(ritz_dense) y = {0};

    RITZ_CHECK(ritz_dense_new(n, 1, &y));
    y.val[row] = 1.0;
    for (int s = 0; s < SWEEPS; s++) {
        for (int64_t i = 0; i < n; i++)
            y.val[i] *= sqrt(a[i]);
        RITZ_CHECK(ritz_factor_solve(F, &y));
        for (int64_t i = 0; i < n; i++)
            y.val[i] *= sqrt(a[i]);
        *out = 1.0 / normalise_vector(n, y.val);
    }
    return RITZ_OK;
}

/* Copy the order of rows, and invert it. */
static ritz_status copy_order(const cholmod_factor *L, ritz_factor *F)
{
    const int64_t *order = L->Perm;

    RITZ_CHECK_COPY(F->order, order, F->n);
    RITZ_CHECK_NEW(F->place, F->n);
    for (int64_t k = 0; k < F->n; k++)
        F->place[order[k]] =
            (int32_t)k; /* packing refuses more rows than that numbers */
    return RITZ_OK;
}

/* Pack the factor, and judge whether A was positive definite. */
static ritz_status pack_factor(ritz_factor *F, cholesky *C, const double *a,
                               int64_t *weak)
{
    const int64_t *order = C->L->Perm;
    double ratio = HUGE_VAL;
    double lambda = HUGE_VAL;
    int64_t row = -1;

    if (C->common.status == CHOLMOD_NOT_POSDEF) {
        row = C->L->minor < C->L->n ? order[C->L->minor] : -1;
        lambda = 0.0;
    } else {
        RITZ_CHECK(weakest_pivot(C->L, a, &ratio, &row));
        if (C->L->xsize * sizeof(double) >= LARGE)
            ritz_memory_return(); /* for a while parts of L are held twice */
        RITZ_CHECK(copy_order(C->L, F));
        F->entries = C->common.lnz;
        F->operations = C->common.fl;
        RITZ_CHECK(ritz_supernodal_new(C->L, NULL, &F->S));
        cholmod_l_free_factor(&C->L, &C->common);
        if (row >= 0 && !(ratio > RITZ_PIVOT_STRONG))
            RITZ_CHECK(smallest_eigenvalue(F, a, row, &lambda));
    }
    if (weak)
        *weak = row;
    RITZ_REFUSE_IF(!(lambda > RITZ_SINGULAR_SPD), RITZ_ERR_SINGULAR,
                   "not positive definite, is a rigid-body motion left free?");
    return RITZ_OK;
}

/* The failure of the last call of CHOLMOD as a status; RITZ_OK if there is
   none. A matrix that is not positive definite is not a failure here. */
static ritz_status report_failure(const cholesky *C, int64_t rows)
{
    RITZ_REFUSE_IF(C->common.status == CHOLMOD_OUT_OF_MEMORY ||
                       C->common.status == CHOLMOD_TOO_LARGE,
                   RITZ_ERR_MEMORY,
                   "no memory for the factor of %" PRId64 " rows", rows);
    RITZ_REFUSE_IF(C->common.status < 0, RITZ_ERR_ARGUMENT,
                   "the matrix cannot be factored, CHOLMOD says %d",
                   C->common.status);
    return RITZ_OK;
}

/* L is packed while its pages are given back: it is held once. While it is made
   there are also the largest update matrix and two copies of the lower triangle
   of A. */
static ritz_status admit_factor(const cholmod_factor *L, const ritz_sparse *A)
{
    const int64_t size = (int64_t)sizeof(double);
    const int64_t kept = (int64_t)L->xsize * size;
    const int64_t triangle = (A->colptr[A->ncol] + A->ncol) / 2;
    const int64_t pages = kept / 2 < PAGES ? kept / 2 : PAGES;

    return ritz_memory_admit_factor(
        kept + (int64_t)L->maxcsize * size + 4 * size * triangle + pages, kept);
}

/* Find the pattern of L, with rows in the order `known`; NULL: find an order,
   too. For a small matrix CHOLMOD tries several orders and keeps the best. */
static ritz_status analyse_sparse(cholesky *C, const ritz_sparse *A,
                                  const int64_t *known)
{
    RITZ_OWN_ARRAY int64_t *order = NULL;
    cholmod_sparse view = view_sparse(A);

    ritz_monitor_step("order of rows", 0, 0);
    cholmod_l_start(&C->common);
    C->common.print = 0;
    C->common.final_ll = 1; /* LDL', the default, accepts negative pivots */
    C->common.supernodal = CHOLMOD_SUPERNODAL;
    if (known)
        RITZ_CHECK_COPY(order, known, A->nrow);
    else if (A->nrow >= RITZ_ORDER_FROM)
        RITZ_CHECK(ritz_ordering_new(A, &order));
    if (order) {
        C->common.nmethods = 1;
        C->common.method[0].ordering = CHOLMOD_GIVEN;
    }
    C->L = cholmod_l_analyze_p(&view, order, NULL, 0, &C->common);
    RITZ_CHECK(report_failure(C, A->nrow));
    return admit_factor(C->L, A);
}

/* How a definite matrix is factored. */
typedef struct manner {
    const int64_t *order; /* of rows; NULL: find one */
    bool alone;           /* by one thread, however large it is */
} manner;

static ritz_status factorise_sparse(cholesky *C, const ritz_sparse *A,
                                    const manner *how)
{
    cholmod_sparse view = view_sparse(A);
    ritz_blas_setting before = {0};

    RITZ_CHECK(analyse_sparse(C, A, how->order));
    ritz_monitor_step("factor", 0, 0);
    before = ritz_blas_alone(how->alone ? 0.0 : C->common.fl);
    cholmod_l_factorize(&view, C->L, &C->common);
    ritz_blas_restore(before);
    return report_failure(C, A->nrow);
}

/* Refuse A if it is not square; copy its diagonal to *a. */
static ritz_status begin_factor(const ritz_sparse *A, ritz_factor *F,
                                double **a)
{
    RITZ_REFUSE_IF(A->nrow != A->ncol, RITZ_ERR_ARGUMENT,
                   "a %" PRId64 " x %" PRId64 " matrix is not square", A->nrow,
                   A->ncol);
    RITZ_CHECK_NEW(*a, A->nrow);
    RITZ_CHECK(copy_diagonal(A, *a));
    F->n = A->nrow;
    return RITZ_OK;
}

/* @param[out] weak  as for ritz_factor_spd_weak(); NULL: not wanted */
static ritz_status factor_definite(const ritz_sparse *A, const manner *how,
                                   ritz_factor **out, int64_t *weak)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(cholesky) C = {0};
    RITZ_OWN_ARRAY double *a = NULL;

    if (weak)
        *weak = -1;
    RITZ_CHECK_NEW(F, 1);
    RITZ_CHECK(begin_factor(A, F, &a));
    RITZ_CHECK(factorise_sparse(&C, A, how));
    RITZ_CHECK(pack_factor(F, &C, a, weak));
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

ritz_status ritz_factor_spd_weak(const ritz_sparse *A, ritz_factor **out,
                                 int64_t *weak)
{
    return factor_definite(A, &(manner){0}, out, weak);
}

ritz_status ritz_factor_spd(const ritz_sparse *A, ritz_factor **out)
{
    return factor_definite(A, &(manner){0}, out, NULL);
}

ritz_status ritz_factor_spd_ordered(const ritz_sparse *A, const int64_t *order,
                                    ritz_factor **out)
{
    return factor_definite(A, &(manner){.order = order}, out, NULL);
}

ritz_status ritz_factor_spd_alone(const ritz_sparse *A, const int64_t *order,
                                  ritz_factor **out)
{
    const manner how = {.order = order, .alone = true};

    return factor_definite(A, &how, out, NULL);
}

/* |b - A x| / | |A||x| + |b| | of the computed solution x of A x = b, for one b
   of unequal entries. x solves a system exactly whose A and b are changed by
   about this part. */
static ritz_status backward_error(ritz_factor *F, const ritz_sparse *A,
                                  double *out)
{
    RITZ_OWN(ritz_dense) x = {0};
    double gap = 0.0;
    double size = 0.0;

    RITZ_CHECK(ritz_dense_new(F->n, 1, &x));
    for (int64_t i = 0; i < F->n; i++)
        x.val[i] = cos((double)i) * sqrt(fabs(ritz_sparse_diagonal(A, i)));
    RITZ_CHECK(ritz_factor_solve(F, &x));
    for (int64_t j = 0; j < F->n; j++) { /* column j is row j: A is symmetric */
        const double b =
            cos((double)j) * sqrt(fabs(ritz_sparse_diagonal(A, j)));
        double rest = b;
        double sum = fabs(b);

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            rest -= A->val[p] * x.val[A->rowind[p]];
            sum += fabs(A->val[p] * x.val[A->rowind[p]]);
        }
        gap = hypot(gap, rest);
        size = hypot(size, sum);
    }
    *out = gap / size;
    return RITZ_OK;
}

ritz_status ritz_factor_signed(const ritz_sparse *A, const int64_t *order,
                               int64_t *negative, ritz_factor **out)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(cholesky) C = {0};
    RITZ_OWN_ARRAY double *a = NULL, *sign = NULL;
    double error = 0.0;

    RITZ_CHECK_NEW(F, 1);
    RITZ_CHECK(begin_factor(A, F, &a));
    RITZ_CHECK_NEW(sign, F->n);
    RITZ_CHECK(analyse_sparse(&C, A, order));
    ritz_monitor_step("factor", 0, 0);
    RITZ_CHECK(ritz_signed_cholesky(A, C.L, &C.common, sign));
    RITZ_CHECK(copy_order(C.L, F));
    RITZ_CHECK(ritz_supernodal_new(C.L, sign, &F->S));
    cholmod_l_free_factor(&C.L, &C.common);
    RITZ_CHECK(backward_error(F, A, &error));
    RITZ_REFUSE_IF(!(error <= RITZ_SIGNED_ERROR), RITZ_ERR_SINGULAR,
                   "the factor has a backward error of %.1e", error);
    *negative = 0;
    for (int64_t k = 0; k < F->n; k++)
        *negative += sign[k] < 0.0;
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

/* Copies `count` columns of X to x, or back: x has `width` numbers for each
   row, and its rows are in the factor's order. Rows are taken as they are in X,
   so that only whole rows of x are reached out of order. */
typedef struct exchange {
    const ritz_factor *F;
    double *X, *x;
    int64_t count, width;
} exchange;

static void take_columns(int thread, int64_t from, int64_t to, void *task)
{
    const exchange *e = task;

    (void)thread;
    for (int64_t i = from; i < to; i++) {
        double *x = e->x + e->F->place[i] * e->width;

        for (int64_t j = 0; j < e->count; j++)
            x[j] = e->X[i + j * e->F->n];
        for (int64_t j = e->count; j < e->width; j++)
            x[j] = 0.0;
    }
}

static void return_columns(int thread, int64_t from, int64_t to, void *task)
{
    const exchange *e = task;

    (void)thread;
    for (int64_t i = from; i < to; i++) {
        const double *x = e->x + e->F->place[i] * e->width;

        for (int64_t j = 0; j < e->count; j++)
            e->X[i + j * e->F->n] = x[j];
    }
}

/* The width of the block in which so many columns, or some of them, are solved
   for. */
static int64_t width_for(int64_t columns)
{
    return columns <= RITZ_SOLVE_WIDTH / 2 ? RITZ_SOLVE_WIDTH / 2
                                           : RITZ_SOLVE_WIDTH;
}

ritz_status ritz_factor_solve(ritz_factor *F, ritz_dense *X)
{
    RITZ_OWN_ARRAY double *x = NULL;

    RITZ_REFUSE_IF(X->nrow != F->n, RITZ_ERR_ARGUMENT,
                   "a factor of %" PRId64 " rows meets %" PRId64, F->n,
                   X->nrow);
    if (F->n == 0 || X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_supernodal_fetch(F->S));
    RITZ_CHECK_NEW(x, F->n * width_for(X->ncol));
    for (int64_t j = 0; j < X->ncol;) {
        const int threads = ritz_supernodal_threads(F->S);
        const int64_t left = X->ncol - j;
        exchange e = {F, ritz_dense_col(X, j), x, left, width_for(left)};

        e.count = left < e.width ? left : e.width;
        ritz_team_over(threads, F->n, take_columns, &e);
        ritz_supernodal_solve(F->S, e.width, x);
        ritz_team_over(threads, F->n, return_columns, &e);
        j += e.count;
    }
    return RITZ_OK;
}

ritz_status ritz_factor_spill(ritz_factor *F)
{
    return ritz_supernodal_spill(F->S);
}

const int64_t *ritz_factor_order(const ritz_factor *F)
{
    return F->order;
}

void ritz_factor_solve_rows(ritz_factor *F, double *x)
{
    ritz_supernodal_solve(F->S, RITZ_SOLVE_WIDTH / 2, x);
}

/* Two blocks x of n x 8 and one block y of n x 16. */
typedef struct block_exchange {
    int64_t n;
    double *x, *y;
} block_exchange;

static void join_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_exchange *t = task;
    const size_t half = RITZ_SOLVE_WIDTH / 2;

    (void)thread;
    for (int64_t k = from; k < to; k++)
        for (int64_t q = 0; q < 2; q++)
            memcpy(t->y + (2 * k + q) * (int64_t)half,
                   t->x + (q * t->n + k) * (int64_t)half, half * sizeof *t->y);
}

static void part_rows(int thread, int64_t from, int64_t to, void *task)
{
    const block_exchange *t = task;
    const size_t half = RITZ_SOLVE_WIDTH / 2;

    (void)thread;
    for (int64_t k = from; k < to; k++)
        for (int64_t q = 0; q < 2; q++)
            memcpy(t->x + (q * t->n + k) * (int64_t)half,
                   t->y + (2 * k + q) * (int64_t)half, half * sizeof *t->y);
}

void ritz_factor_solve_two(ritz_factor *F, double *x, double *room)
{
    const int threads = ritz_supernodal_threads(F->S);
    block_exchange t = {.n = F->n, .y = room};

    t.x = x;
    ritz_team_over(threads, F->n, join_rows, &t);
    ritz_supernodal_solve(F->S, RITZ_SOLVE_WIDTH, room);
    ritz_team_over(threads, F->n, part_rows, &t);
}

void ritz_factor_size(const ritz_factor *F, double *entries, double *operations)
{
    *entries = F->entries;
    *operations = F->operations;
}

int ritz_factor_threads(const ritz_factor *F)
{
    return ritz_supernodal_threads(F->S);
}

void ritz_factor_free(ritz_factor **F)
{
    if (!*F)
        return;
    ritz_supernodal_free(&(*F)->S);
    RITZ_FREE((*F)->order, (*F)->place);
    free(*F);
    *F = NULL;
}
