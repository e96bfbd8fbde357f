/*
 * A tree of substructures is eliminated from its leaves to its root. With
 * A = K - sigma M, s the rows of a substructure and b the rows of its ancestors
 * that it is coupled with,
 *
 *     X     = A_ss^-1 A_sb                              static condensation
 *     A_bb -= A_bs X
 *     M_bb -= X'P + P'X,   P = M_sb - 1/2 M_ss X        the same for the mass
 *     Q     = P - 1/2 M_ss X                            M_sb, condensed
 *
 *     M_ss phi = nu A_ss phi,   nu > 1 / (cutoff - sigma)
 *
 * The space is spanned by the columns T of all substructures, phi in the rows s
 * and its static response in the rows below. They are orthonormal in A, as the
 * elimination is a congruence; what remains of M couples a substructure only
 * with its ancestors:
 *
 *     T'AT = I,   T'MT = R,   R_ss = diag(nu),   R_sd = phi_s' U_s
 *
 * U has a column for each mode of the descendants d. It is condensed in the same
 * way, U_b -= X'U_s, and Q'phi are the columns of s. The largest eigenvalues of
 * R y = theta y are those of A^-1 M from below, lambda = sigma + 1 / theta, and
 * x = T y follows from the root down:
 *
 *     x_s = phi_s y_s - X x_b
 *
 * M may be singular: modes without mass have nu = 0 and are never kept.
 */
#include "linear/amls.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/search.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "linear/largest.h"
#include "linear/ordering.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAF = 200,     /* rows of a leaf, about: measured */
    WIDEST = 20000, /* rows of a front; dense matrices of that order are held */
    COLUMNS = 64,   /* of x that a thread computes at a time */
    SHARES = 8,     /* a subtree for one thread has at most 1 / SHARES of the
                        operations that a thread has on average */
    THREADED = 8000, /* rows from which several threads gain */
    RICH = 6, /* modes of substructures are about so many times those found, for
                 the prediction of memory: measured */
};

/* A substructure, or an interface between substructures. */
typedef struct front {
    int64_t n, b;  /* rows of s, rows b */
    int64_t *row;  /* b positions in the dissection's order, ascending */
    double *X;     /* n x b */
    double *Phi;   /* n x k */
    double *nu;    /* k, descending */
    int64_t k;     /* modes kept */
    int64_t below; /* modes of all descendants */
    double *R;     /* k x below */
    double *A, *M; /* A_bb and M_bb, lower triangles, until the parent has
                        added them */
    double *U;     /* b x (below + k), until then as well */
    double work;   /* operations in the whole subtree */
    ritz_status status;
} front;

static void front_free(front *f)
{
    RITZ_FREE(f->row, f->X, f->Phi, f->nu, f->R, f->A, f->M, f->U);
}

typedef struct amls {
    const ritz_shifted *S;
    ritz_dissection tree;
    int64_t *position; /* of each row of A in the order of the tree */
    front *front;      /* of each node */
    int64_t *job; /* subtrees, by their roots, that one thread eliminates */
    int64_t num_jobs;
    double work;                 /* operations to eliminate all fronts */
    double least;                /* nu of modes kept are at least this */
    int64_t order;               /* of R */
    _Atomic int64_t *eliminated; /* fronts, to show progress */
    int threads;
} amls;

static void amls_free(amls *a)
{
    for (int64_t s = 0; a->front && s < a->tree.nodes; s++)
        front_free(&a->front[s]);
    RITZ_FREE(a->position, a->front, a->job);
    ritz_dissection_free(&a->tree);
}

/* --- the tree ------------------------------------------------------------- */

/* Append to the list of front s those positions in `from` that lie beyond it
   and are not in the list yet. */
static void gather_positions(const amls *a, int64_t s, int64_t count,
                             const int64_t *from, int64_t *met, int64_t *list)
{
    front *f = &a->front[s];

    for (int64_t i = 0; i < count; i++) {
        if (from[i] < a->tree.first[s + 1] || met[from[i]] == s + 1)
            continue;
        met[from[i]] = s + 1;
        list[f->b++] = from[i];
    }
}

/* f->row := rows beyond s that s or a child of it is coupled with. A zero that
   is stored in one triangle only, of which the dissection may have read the
   other, couples nothing. */
static ritz_status find_boundary(const amls *a, int64_t s, int64_t *met,
                                 int64_t *list)
{
    const ritz_sparse *const matrix[] = {a->S->K, a->S->M};
    const int64_t *first = a->tree.first;
    front *f = &a->front[s];

    f->n = first[s + 1] - first[s];
    for (int64_t p = first[s]; p < first[s + 1]; p++)
        for (int m = 0; m < 2; m++) {
            const int64_t j = a->tree.row[p];

            for (int64_t q = matrix[m]->colptr[j]; q < matrix[m]->colptr[j + 1];
                 q++)
                if (matrix[m]->val[q] != 0.0)
                    gather_positions(
                        a, s, 1, &a->position[matrix[m]->rowind[q]], met, list);
        }
    for (int64_t c = a->tree.begin[s]; c < s; c++)
        if (a->tree.parent[c] == s)
            gather_positions(a, s, a->front[c].b, a->front[c].row, met, list);
    qsort(list, (size_t)f->b, sizeof *list, ritz_ascending_index);
    RITZ_CHECK_COPY(f->row, list, f->b);
    return RITZ_OK;
}

/* Operations to eliminate one front, about. */
static double work_of(const front *f)
{
    const double n = (double)f->n;
    const double b = (double)f->b;

    return n * (4.0 * n * n + 6.0 * n * b + 3.0 * b * b);
}

/* Choose subtrees for single threads: as large as allowed, and none within
   another. */
static void choose_jobs(amls *a)
{
    double most = 0.0;

    for (int64_t s = 0; s < a->tree.nodes; s++)
        if (a->tree.parent[s] < 0)
            a->work += a->front[s].work;
    most = a->work / (SHARES * a->threads);
    for (int64_t s = a->tree.nodes - 1; s >= 0;) {
        if (a->front[s].work > most) {
            s--;
            continue;
        }
        a->job[a->num_jobs++] = s;
        s = a->tree.begin[s] - 1;
    }
}

/* The tree and the rows of all fronts. *wide is set if one is too wide. */
static ritz_status plan_fronts(amls *a, int64_t leaf, bool *wide)
{
    const int64_t n = a->S->K->nrow;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN_ARRAY int64_t *met = NULL, *list = NULL;

    RITZ_CHECK(ritz_sparse_add(1.0, a->S->K, -a->S->sigma, a->S->M, &A));
    RITZ_CHECK(ritz_dissection_new(&A, leaf, &a->tree));
    RITZ_CHECK_NEW(a->position, n);
    RITZ_CHECK_NEW(a->front, a->tree.nodes);
    RITZ_CHECK_NEW(a->job, a->tree.nodes);
    RITZ_CHECK_NEW(met, n);
    RITZ_CHECK_NEW(list, n);
    for (int64_t p = 0; p < n; p++)
        a->position[a->tree.row[p]] = p;
    for (int64_t s = 0; s < a->tree.nodes; s++) {
        front *f = &a->front[s];

        RITZ_CHECK(find_boundary(a, s, met, list));
        *wide = *wide || f->n + f->b > WIDEST;
        f->work += work_of(f);
        if (a->tree.parent[s] >= 0)
            a->front[a->tree.parent[s]].work += f->work;
    }
    choose_jobs(a);
    return RITZ_OK;
}

/*
 * Numbers held at a time, about, if fronts are eliminated one after the other
 * and keep modes in proportion to their rows: by a front and what its subtree
 * leaves to it, then by the reduced matrix, by the vectors, and by the inverse
 * iteration of X, M X and A^-1 M X that follows.
 */
static double predict_numbers(const amls *a, int64_t k)
{
    const double rows = (double)a->S->K->nrow;
    const double found = (double)k;
    const double order = fmin(rows, RICH * found);
    double held = 0.0;
    double most = 0.0;

    for (int64_t s = 0; s < a->tree.nodes; s++) {
        const front *f = &a->front[s];
        const int64_t *first = a->tree.first;
        const double n = (double)f->n, b = (double)f->b;
        const double part = order / rows;
        const double below =
            part * (double)(first[s] - first[a->tree.begin[s]]);

        held += n * b + b * (2.0 * b + below + n);
        most = fmax(most, held + n * (3.0 * n + 2.0 * b + below));
        held += part * n * (n + below);
        for (int64_t c = a->tree.begin[s]; c < s; c++)
            if (a->tree.parent[c] == s) {
                const double b_c = (double)a->front[c].b;

                held -=
                    b_c * (2.0 * b_c + (double)a->front[c].n +
                           part * (double)(first[c] - first[a->tree.begin[c]]));
            }
    }
    most = fmax(most, held + order * (order + 3.0 * found) + rows * found);
    return fmax(most, 3.0 * rows * found);
}

/* --- elimination ---------------------------------------------------------- */

/* The matrices of one front while it is eliminated. */
typedef struct blocks {
    double *A_ss, *M_ss; /* n x n, lower triangles */
    double *M_sb;        /* n x b; A_sb is the front's X */
    double *U_s;         /* n x below */
} blocks;

static void blocks_free(blocks *B)
{
    RITZ_FREE(B->A_ss, B->M_ss, B->M_sb, B->U_s);
}

/* Row of a position in the matrices of front s: 0 to n - 1 for the rows s, n
   and above for the rows b. */
static int64_t place_in(const amls *a, int64_t s, int64_t position)
{
    const front *f = &a->front[s];
    int64_t low = 0;
    int64_t high = f->b;

    if (position < a->tree.first[s + 1])
        return position - a->tree.first[s];
    while (low < high) {
        const int64_t middle = (low + high) / 2;

        if (f->row[middle] < position)
            low = middle + 1;
        else
            high = middle;
    }
    return f->n + low;
}

/* The rows s of t * matrix, added to ss (lower triangle) and sb. */
static void add_entries(const amls *a, int64_t s, double t,
                        const ritz_sparse *matrix, double *ss, double *sb)
{
    const int64_t *first = a->tree.first;
    const int64_t n = a->front[s].n;

    for (int64_t j = 0; j < n; j++) {
        const int64_t row = a->tree.row[first[s] + j];

        for (int64_t p = matrix->colptr[row]; p < matrix->colptr[row + 1];
             p++) {
            const int64_t at = a->position[matrix->rowind[p]];
            int64_t i = 0;

            if (at < first[s] + j || matrix->val[p] == 0.0)
                continue;
            i = place_in(a, s, at);
            if (i < n)
                ss[i + j * n] += t * matrix->val[p];
            else
                sb[j + (i - n) * n] += t * matrix->val[p];
        }
    }
}

/* The lower triangle of a child's matrix C, c x c, added to the blocks of its
   parent; place[] ascends. */
static void add_triangle(const front *f, int64_t c, const int64_t *place,
                         const double *C, double *const to[3])
{
    const int64_t n = f->n;

    for (int64_t j = 0; j < c; j++)
        for (int64_t i = j; i < c; i++) {
            const int64_t row = place[i];
            const int64_t col = place[j];
            const double value = C[i + j * c];

            if (row < n)
                to[0][row + col * n] += value;
            else if (col < n)
                to[1][col + (row - n) * n] += value;
            else
                to[2][(row - n) + (col - n) * f->b] += value;
        }
}

/* Add A_bb, M_bb and U of child c to front s, and free them. `from` is the
   column of U for the first mode of the child's subtree. */
static ritz_status add_child(const amls *a, int64_t s, int64_t c, int64_t from,
                             blocks *B)
{
    front *f = &a->front[s];
    front *child = &a->front[c];
    const int64_t columns = child->below + child->k;
    RITZ_OWN_ARRAY int64_t *place = NULL;

    RITZ_CHECK_NEW(place, child->b);
    for (int64_t i = 0; i < child->b; i++)
        place[i] = place_in(a, s, child->row[i]);
    add_triangle(f, child->b, place, child->A,
                 (double *const[]){B->A_ss, f->X, f->A});
    add_triangle(f, child->b, place, child->M,
                 (double *const[]){B->M_ss, B->M_sb, f->M});
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < child->b; i++) {
            const double value = child->U[i + j * child->b];

            if (place[i] < f->n)
                B->U_s[place[i] + (from + j) * f->n] = value;
            else
                f->U[place[i] - f->n + (from + j) * f->b] = value;
        }
    RITZ_FREE(child->A, child->M, child->U);
    child->A = child->M = child->U = NULL;
    return RITZ_OK;
}

/* The blocks of front s, assembled from the matrices and its children. */
static ritz_status assemble_front(const amls *a, int64_t s, blocks *B)
{
    front *f = &a->front[s];
    int64_t from = 0;

    for (int64_t c = a->tree.begin[s]; c < s; c++)
        f->below += a->front[c].k;
    RITZ_CHECK_NEW(B->A_ss, f->n * f->n);
    RITZ_CHECK_NEW(B->M_ss, f->n * f->n);
    RITZ_CHECK_NEW(B->M_sb, f->n * f->b);
    RITZ_CHECK_NEW(B->U_s, f->n * f->below);
    RITZ_CHECK_NEW(f->X, f->n * f->b);
    RITZ_CHECK_NEW(f->A, f->b * f->b);
    RITZ_CHECK_NEW(f->M, f->b * f->b);
    RITZ_CHECK_NEW(f->U, f->b * (f->below + f->n));
    add_entries(a, s, 1.0, a->S->K, B->A_ss, f->X);
    add_entries(a, s, -a->S->sigma, a->S->M, B->A_ss, f->X);
    add_entries(a, s, 1.0, a->S->M, B->M_ss, B->M_sb);
    for (int64_t c = a->tree.begin[s]; c < s; c++) {
        if (a->tree.parent[c] != s)
            continue;
        RITZ_CHECK(add_child(a, s, c, from, B));
        from += a->front[c].below + a->front[c].k;
    }
    return RITZ_OK;
}

/* A_ss := L, A_ss = L L'; X and what is left of A_bb, M_bb, M_sb, U_b: see the
   head. */
static ritz_status condense_front(front *f, blocks *B)
{
    const int n = (int)f->n;
    const int b = (int)f->b;
    RITZ_OWN_ARRAY double *MX = NULL;

    RITZ_REFUSE_IF(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, B->A_ss, n) != 0,
                   RITZ_ERR_SINGULAR,
                   "the stiffness of a substructure is not positive definite");
    if (b == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(MX, f->n * f->b);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans,
                CblasNonUnit, n, b, 1.0, B->A_ss, n, f->X, n);
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, b, n, -1.0, f->X, n, 1.0,
                f->A, b);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit,
                n, b, 1.0, B->A_ss, n, f->X, n);
    cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, n, b, 0.5, B->M_ss, n,
                f->X, n, 0.0, MX, n);
    for (int64_t i = 0; i < f->n * f->b; i++)
        B->M_sb[i] -= MX[i];
    cblas_dsyr2k(CblasColMajor, CblasLower, CblasTrans, b, n, -1.0, f->X, n,
                 B->M_sb, n, 1.0, f->M, b);
    for (int64_t i = 0; i < f->n * f->b; i++)
        B->M_sb[i] -= MX[i];
    if (f->below > 0)
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, b, (int)f->below,
                    n, -1.0, f->X, n, B->U_s, n, 1.0, f->U, b);
    return RITZ_OK;
}

/* Modes of front f, from L in A_ss; M_ss is lost. */
static ritz_status find_modes(const amls *a, front *f, blocks *B)
{
    const int n = (int)f->n;
    double trace = 0.0;

    RITZ_REFUSE_IF(n > 0 && LAPACKE_dsygst(LAPACK_COL_MAJOR, 1, 'L', n, B->M_ss,
                                           n, B->A_ss, n) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "modes of a substructure cannot be found");
    for (int64_t i = 0; i < f->n; i++)
        trace += B->M_ss[i * (f->n + 1)];
    RITZ_CHECK(ritz_largest_pairs(f->n, B->M_ss, 0,
                                  fmax(a->least, DBL_EPSILON * trace), &f->k,
                                  &f->nu, &f->Phi));
    if (f->k > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, (int)f->k, 1.0, B->A_ss, n, f->Phi, n);
    return RITZ_OK;
}

/* f->R, and the columns of U for the modes of f. */
static ritz_status couple_modes(front *f, const blocks *B)
{
    const int n = (int)f->n;
    const int b = (int)f->b;
    const int k = (int)f->k;
    const int below = (int)f->below;

    RITZ_CHECK_NEW(f->R, f->k * f->below);
    if (k > 0 && below > 0)
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, k, below, n, 1.0,
                    f->Phi, n, B->U_s, n, 0.0, f->R, k);
    if (k > 0 && b > 0)
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, b, k, n, 1.0,
                    B->M_sb, n, f->Phi, n, 0.0, f->U + f->below * f->b, b);
    return RITZ_OK;
}

static ritz_status eliminate_front(const amls *a, int64_t s)
{
    front *f = &a->front[s];
    RITZ_OWN(blocks) B = {0};

    /* other threads than the first show nothing */
    ritz_monitor_step("substructures", (*a->eliminated)++, a->tree.nodes);
    RITZ_CHECK(assemble_front(a, s, &B));
    RITZ_CHECK(condense_front(f, &B));
    RITZ_CHECK(find_modes(a, f, &B));
    return couple_modes(f, &B);
}

/* One job: all fronts of a subtree. */
static void eliminate_subtree(int64_t k, void *task)
{
    const amls *a = task;
    const int64_t root = a->job[k];
    ritz_status status = RITZ_OK;

    for (int64_t s = a->tree.begin[root]; s <= root && status == RITZ_OK; s++)
        status = eliminate_front(a, s);
    a->front[root].status = status;
}

/* The sentence of a failure is known only to the thread that failed. */
static ritz_status report_job(ritz_status status)
{
    RITZ_REFUSE_IF(status == RITZ_ERR_MEMORY, status,
                   "no memory to eliminate substructures");
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "the stiffness of a substructure is not positive definite");
    RITZ_REFUSE_IF(status != RITZ_OK, status,
                   "modes of a substructure cannot be found");
    return RITZ_OK;
}

/* Subtrees by single threads, then the fronts above them with threads of the
   BLAS. */
static ritz_status eliminate_fronts(amls *a)
{
    const int before = ritz_blas_threads(1);
    int64_t next = a->num_jobs;

    ritz_team_each(a->threads, a->num_jobs, eliminate_subtree, a);
    ritz_blas_threads(before);
    for (int64_t k = 0; k < a->num_jobs; k++)
        RITZ_CHECK(report_job(a->front[a->job[k]].status));
    for (int64_t s = 0; s < a->tree.nodes; s++) {
        /* jobs are listed from the last to the first */
        if (next > 0 && s == a->tree.begin[a->job[next - 1]]) {
            s = a->job[--next];
            continue;
        }
        RITZ_CHECK(eliminate_front(a, s));
    }
    for (int64_t s = 0; s < a->tree.nodes; s++)
        a->order += a->front[s].k;
    return RITZ_OK;
}

/* --- the reduced problem -------------------------------------------------- */

/* Lower triangle of R. The modes of a subtree are consecutive. */
static void assemble_reduced(const amls *a, double *R)
{
    const int64_t r = a->order;
    int64_t at = 0;

    for (int64_t s = 0; s < a->tree.nodes; s++) {
        const front *f = &a->front[s];

        for (int64_t i = 0; i < f->k; i++) {
            R[(at + i) * (r + 1)] = f->nu[i];
            for (int64_t j = 0; j < f->below; j++)
                R[at + i + (at - f->below + j) * r] = f->R[i + j * f->k];
        }
        at += f->k;
    }
}

/* The k largest eigenvalues of R, descending, and their vectors. */
static ritz_status solve_reduced(const amls *a, int64_t k, double **theta,
                                 ritz_dense *Y)
{
    RITZ_OWN_ARRAY double *R = NULL;
    int64_t found = 0;

    ritz_monitor_step("eigenvalues of the reduced matrix, order", a->order, 0);
    RITZ_CHECK(
        ritz_memory_admit("the matrix of substructure modes",
                          a->order * (a->order + 2 * k) * (int64_t)sizeof *R));
    RITZ_CHECK_NEW(R, a->order * a->order);
    assemble_reduced(a, R);
    RITZ_CHECK(ritz_largest_pairs(a->order, R, k, 0.0, &found, theta, &Y->val));
    Y->nrow = a->order;
    Y->ncol = found;
    return RITZ_OK;
}

/* --- vectors -------------------------------------------------------------- */

typedef struct expansion {
    const amls *a;
    const ritz_dense *Y;
    ritz_dense *X;
    double *room; /* of each share: x of COLUMNS columns, and x_b */
    int64_t size; /* of room for a share */
    int64_t widest;
} expansion;

/* Columns [first, first + count) of X, from the root down. */
static void expand_columns(const expansion *e, int64_t first, int64_t count,
                           double *room)
{
    const amls *a = e->a;
    const int64_t n = e->X->nrow;
    double *x = room;                 /* count columns, in tree order */
    double *x_b = room + COLUMNS * n; /* b x count */
    int64_t at = a->order;

    for (int64_t s = a->tree.nodes - 1; s >= 0; s--) {
        const front *f = &a->front[s];
        double *x_s = x + a->tree.first[s];

        at -= f->k;
        if (f->n == 0)
            continue;
        for (int64_t j = 0; j < count; j++)
            memset(x_s + j * n, 0, (size_t)f->n * sizeof *x_s);
        if (f->k > 0)
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)f->n,
                        (int)count, (int)f->k, 1.0, f->Phi, (int)f->n,
                        ritz_dense_col(e->Y, first) + at, (int)a->order, 0.0,
                        x_s, (int)n);
        for (int64_t j = 0; j < count; j++)
            for (int64_t i = 0; i < f->b; i++)
                x_b[i + j * f->b] = x[f->row[i] + j * n];
        if (f->b > 0)
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)f->n,
                        (int)count, (int)f->b, -1.0, f->X, (int)f->n, x_b,
                        (int)f->b, 1.0, x_s, (int)n);
    }
    for (int64_t j = 0; j < count; j++)
        for (int64_t p = 0; p < n; p++)
            ritz_dense_col(e->X, first + j)[a->tree.row[p]] = x[p + j * n];
}

/* Each thread has every `threads`-th group of columns. */
static void expand_share(int thread, int threads, void *task)
{
    const expansion *e = task;

    for (int64_t j = (int64_t)thread * COLUMNS; j < e->X->ncol;
         j += (int64_t)threads * COLUMNS) {
        const int64_t left = e->X->ncol - j;

        ritz_monitor_step("vectors of substructures", j, e->X->ncol);
        expand_columns(e, j, left < COLUMNS ? left : COLUMNS,
                       e->room + thread * e->size);
    }
}

/* X := T Y */
static ritz_status expand_vectors(const amls *a, const ritz_dense *Y,
                                  ritz_dense *X)
{
    const int64_t n = a->S->K->nrow;
    RITZ_OWN_ARRAY double *room = NULL;
    expansion e = {.a = a, .Y = Y, .X = X};
    int before = 0;

    for (int64_t s = 0; s < a->tree.nodes; s++)
        e.widest = a->front[s].b > e.widest ? a->front[s].b : e.widest;
    e.size = COLUMNS * (n + e.widest);
    RITZ_CHECK_NEW(room, a->threads * e.size);
    RITZ_CHECK(ritz_dense_new(n, Y->ncol, X));
    e.room = room;
    before = ritz_blas_threads(1);
    ritz_team_run(a->threads, expand_share, &e);
    ritz_blas_threads(before);
    return RITZ_OK;
}

/* x / |x|_M, as |x|_M^2 = theta of a vector with |x|_A = 1. */
static void normalise_vectors(const double *theta, ritz_dense *X)
{
    for (int64_t j = 0; j < X->ncol; j++)
        cblas_dscal((int)X->nrow, 1.0 / sqrt(theta[j]), ritz_dense_col(X, j),
                    1);
}

/* The body of ritz_amls_lowest(), once the fronts are planned. */
static ritz_status find_lowest(amls *a, int64_t k, ritz_substructuring *how,
                               ritz_dense *X, double **lambda,
                               ritz_lanczos_end *end)
{
    RITZ_OWN(ritz_dense) Y = {0}, x = {0};
    RITZ_OWN_ARRAY double *theta = NULL;

    RITZ_CHECK(eliminate_fronts(a));
    how->nodes = a->tree.nodes;
    how->order = a->order;
    *end = RITZ_LANCZOS_EXHAUSTED;
    if (a->order < k)
        return RITZ_OK;
    RITZ_CHECK(solve_reduced(a, k, &theta, &Y));
    if (!(theta[k - 1] > DBL_EPSILON * (double)a->order * theta[0]))
        return RITZ_OK; /* fewer than k motions have mass */
    *end = RITZ_LANCZOS_SLOW;
    if (!(theta[k - 1] > RITZ_AMLS_DIGITS * theta[0]))
        return RITZ_OK;
    RITZ_CHECK(expand_vectors(a, &Y, &x));
    normalise_vectors(theta, &x);
    for (int64_t j = 0; j < k; j++)
        theta[j] = a->S->sigma + 1.0 / theta[j];
    RITZ_MOVE(*X, x);
    RITZ_MOVE(*lambda, theta);
    *end = RITZ_LANCZOS_FOUND;
    return RITZ_OK;
}

ritz_status ritz_amls_lowest(const ritz_shifted *S, int64_t k,
                             ritz_substructuring *how, ritz_dense *X,
                             double **lambda, ritz_lanczos_end *end)
{
    _Atomic int64_t eliminated = 0;
    RITZ_OWN(amls) a = {.S = S, .eliminated = &eliminated};
    ritz_blas_setting before = {0};
    ritz_status status = RITZ_OK;
    bool wide = false;

    a.least = 1.0 / (how->cutoff - S->sigma);
    a.threads = ritz_team_ready(S->K->nrow / THREADED + 1);
    RITZ_CHECK(plan_fronts(&a, how->leaf > 0 ? how->leaf : LEAF, &wide));
    *end = RITZ_LANCZOS_SLOW;
    if (wide)
        return RITZ_OK;
    RITZ_CHECK(ritz_memory_admit("elimination of substructures",
                                 (int64_t)predict_numbers(&a, k) *
                                     (int64_t)sizeof(double)));
    before = ritz_blas_alone(a.work);
    status = find_lowest(&a, k, how, X, lambda, end);
    ritz_blas_restore(before);
    return status;
}
