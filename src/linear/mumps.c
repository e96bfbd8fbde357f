/*
 * Factors by MUMPS in one process: A = L D L', real, and sum_k c_k A_k = L D L'
 * or L U, complex.
 */
#include "base/alloc.h"
#include "base/memory.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/inertia.h"
#include "linear/ordering.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <complex.h>
#include <dmumps_c.h>
#include <float.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zmumps_c.h>
#ifdef RITZ_MPI /* defined for the copy that is linked to ritz-basis-slepc */
#include <mpi.h>
#endif

enum {
    EQUILIBRATIONS = 5, /* halve the logarithm of the row maxima each */
    SWEEPS = 3,         /* of inverse iteration */
    MORE_ROOM = 8,      /* times the workspace may grow */
};

/* MUMPS's numbers for its jobs. */
enum {
    START = -1,
    END = -2,
    ANALYSE = 1,
    FACTOR = 2,
    SOLVE = 3,
};

/* Indices from zero of the control arrays: ICNTL(k) of the manual is k - 1. */
enum {
    ERROR_UNIT = 0,
    DIAGNOSTIC_UNIT = 1,
    GLOBAL_UNIT = 2,
    PRINT_LEVEL = 3,
    MAX_TRANSVERSAL = 5,
    ORDERING = 6,
    SCALING = 7,
    TRANSPOSED = 8, /* 1 is A, else its transpose is solved for */
    SYMMETRIC_STRATEGY = 11,
    ROOT_SEQUENTIAL = 12,
    ROOM_PERCENT = 13,
    NULL_PIVOTS = 23,
    DISCARD_FACTOR = 30,
    THRESHOLD = 0,        /* of CNTL: of pivots, 0 for none */
    NULL_PIVOT_SIZE = 2,  /* of CNTL */
    OUTCOME = 0,          /* of INFOG */
    NEGATIVE_PIVOTS = 11, /* of INFOG */
    FACTOR_ENTRIES = 19,  /* of INFOG; negative: in millions */
    MEGABYTES = 15,       /* of INFOG, that the job FACTOR will need */
    NUM_NULL_PIVOTS = 27, /* of INFOG */
};

typedef struct mumps_factor {
    int width; /* doubles per number: 1 real, 2 complex */
    union {
        DMUMPS_STRUC_C d;
        ZMUMPS_STRUC_C z;
    } id; /* real, complex */
    bool started;
    bool factored;
    bool
        whole; /* one of the matrices is not symmetric: not only its triangle */
    int64_t n, nnz;       /* union of the patterns, entry k at row[k], col[k] */
    MUMPS_INT *row, *col; /* from 1; borrowed by MUMPS, as val is */
    MUMPS_INT *place;     /* pivot of each row, from 1; NULL: MUMPS orders */
    bool counted;         /* only pivots are wanted: the factor is not kept */
    double *val;          /* width * nnz */
    int64_t count;
    ritz_sparse *A;     /* borrowed, all but the array */
    int64_t *at;        /* of each row among the entries of one column */
    ritz_relief relief; /* of a counter; {0}: none */
    bool shared;        /* another thread makes a factor, too */
} mumps_factor;

struct ritz_ldl {
    mumps_factor of;
};

struct ritz_zldl {
    mumps_factor of;
};

struct ritz_counter {
    mumps_factor of;
};

/* A field that the structs of both arithmetics have. */
#define FIELD(F, name) (*((F)->width == 1 ? &(F)->id.d.name : &(F)->id.z.name))

static ritz_status check_sizes(int64_t count, const ritz_sparse *const *A,
                               int64_t *room)
{
    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "no matrix to factor");
    for (int64_t k = 0; k < count; k++) {
        RITZ_REFUSE_IF(A[k]->nrow != A[0]->nrow || A[k]->ncol != A[0]->nrow,
                       RITZ_ERR_ARGUMENT,
                       "a %" PRId64 " x %" PRId64
                       " matrix stands beside %" PRId64 " rows",
                       A[k]->nrow, A[k]->ncol, A[0]->nrow);
        *room += A[k]->colptr[A[k]->ncol];
    }
    RITZ_REFUSE_IF(A[0]->nrow > INT_MAX - 1, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " rows are more than MUMPS can count",
                   A[0]->nrow);
    return RITZ_OK;
}

/* Add column j of A to the pattern; mark[i] is the last column + 1 that row i
 * was met in. */
static ritz_status unite_column(const ritz_sparse *A, int64_t j, int64_t *mark,
                                mumps_factor *F)
{
    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
        int64_t i = A->rowind[p];

        RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_ARGUMENT,
                       "entry (%" PRId64 ", %" PRId64 ") is not finite", i, j);
        if ((i < j && !F->whole) || mark[i] == j + 1)
            continue;
        mark[i] = j + 1;
        F->row[F->nnz] = (MUMPS_INT)(i + 1);
        F->col[F->nnz++] = (MUMPS_INT)(j + 1);
    }
    return RITZ_OK;
}

/* Column by column, rows in the order they are met. */
static ritz_status unite_patterns(int64_t count, const ritz_sparse *const *A,
                                  mumps_factor *F)
{
    RITZ_OWN_ARRAY int64_t *mark = NULL;
    int64_t room = 0;

    RITZ_CHECK(check_sizes(count, A, &room));
    F->n = A[0]->nrow;
    RITZ_CHECK_NEW(mark, F->n);
    RITZ_CHECK_RAW(F->row, room); /* half is never used of triangles */
    RITZ_CHECK_RAW(F->col, room);
    for (int64_t j = 0; j < F->n; j++)
        for (int64_t k = 0; k < count; k++)
            RITZ_CHECK(unite_column(A[k], j, mark, F));
    return RITZ_OK;
}

/* Silent, null pivots found. */
static void set_options(mumps_factor *F)
{
    MUMPS_INT *icntl = FIELD(F, icntl);

    icntl[ERROR_UNIT] = icntl[DIAGNOSTIC_UNIT] = icntl[GLOBAL_UNIT] = -1;
    icntl[PRINT_LEVEL] = 0;
    icntl[MAX_TRANSVERSAL] = 0; /* so that analysis reads no values */
    icntl[SYMMETRIC_STRATEGY] = 1;
    icntl[ORDERING] = 7;        /* the best of those it was built with */
    icntl[SCALING] = 7;         /* rows and columns, while factoring */
    icntl[ROOT_SEQUENTIAL] = 1; /* or pivots there go uncounted */
    icntl[ROOM_PERCENT] = 30;
    icntl[NULL_PIVOTS] = 1;
    /* refuse_singular() does more */
    FIELD(F, cntl)[NULL_PIVOT_SIZE] = DBL_EPSILON / 16.0;
}

/* Failures that MUMPS reports in INFOG(1). */
typedef struct outcome {
    int code;
    ritz_status status;
    const char *sentence;
} outcome;

static const outcome outcomes[] = {
    {-5, RITZ_ERR_MEMORY, "no memory to analyse the matrix"},
    {-6, RITZ_ERR_SINGULAR, "the matrix is singular by its pattern"},
    {-7, RITZ_ERR_MEMORY, "no memory to analyse the matrix"},
    {-8, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-9, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-10, RITZ_ERR_SINGULAR, "the matrix is singular"},
    {-13, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-17, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-19, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-20, RITZ_ERR_MEMORY, "no memory for the factor"},
    {-51, RITZ_ERR_MEMORY, "the matrix is too large for its ordering"},
    {-52, RITZ_ERR_MEMORY, "the matrix is too large for its ordering"},
};

static ritz_status report_failure(const MUMPS_INT *infog)
{
    if (infog[OUTCOME] >= 0)
        return RITZ_OK;
    for (size_t k = 0; k < sizeof outcomes / sizeof *outcomes; k++)
        if (outcomes[k].code == infog[OUTCOME])
            return ritz_fail(outcomes[k].status, "%s", outcomes[k].sentence);
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "the matrix cannot be factored, MUMPS says %d",
                     (int)infog[OUTCOME]);
}

static void call_mumps(mumps_factor *F, int job)
{
    FIELD(F, job) = job;
    if (F->width == 1)
        dmumps_c(&F->id.d);
    else
        zmumps_c(&F->id.z);
}

/* Run a job, with more room each time MUMPS asks for it. */
static ritz_status run_job(mumps_factor *F, int job)
{
    const MUMPS_INT *infog = FIELD(F, infog);

    call_mumps(F, job);
    for (int k = 0;
         k < MORE_ROOM && (infog[OUTCOME] == -8 || infog[OUTCOME] == -9); k++) {
        FIELD(F, icntl)[ROOM_PERCENT] *= 2;
        call_mumps(F, job);
    }
    RITZ_CHECK(report_failure(infog));
    RITZ_REFUSE_IF(job == FACTOR && infog[NUM_NULL_PIVOTS] > 0,
                   RITZ_ERR_SINGULAR,
                   "the matrix is singular, %d pivots are zero",
                   (int)infog[NUM_NULL_PIVOTS]);
    return RITZ_OK;
}

/* About the bytes that CHOLMOD needs to factor the same matrix. It joins
   supernodes, and stores up to half as much again as MUMPS counts; it also copies
   the triangle twice (see factor.c). */
static int64_t other_factor(mumps_factor *F)
{
    const int64_t entries = FIELD(F, infog)[FACTOR_ENTRIES];

    return 12 * (entries < 0 ? -1000000 * entries : entries) + 32 * F->nnz;
}

/* Call the relief if so many bytes would not fit; refuse them if they still do
   not. */
static ritz_status admit_bytes(mumps_factor *F, const char *what, int64_t bytes)
{
    if (F->relief.call && !ritz_memory_fits(bytes))
        RITZ_CHECK(F->relief.call(F->relief.of));
    return ritz_memory_admit(what, bytes);
}

static ritz_status admit_factor(mumps_factor *F)
{
    const int64_t bytes = (int64_t)FIELD(F, infog)[MEGABYTES] * 1000000;

    RITZ_REFUSE_IF(F->shared && !ritz_memory_fits(bytes + other_factor(F)),
                   RITZ_ERR_MEMORY, "memory does not hold two factors");
    return admit_bytes(F, F->counted ? "the factor of a count" : "the factor",
                       bytes);
}

static ritz_status analyse_pattern(mumps_factor *F)
{
    FIELD(F, sym) = F->whole ? 0 : 2;
    FIELD(F, par) = 1;
#ifdef RITZ_MPI
    FIELD(F, comm_fortran) = (MUMPS_INT)MPI_Comm_c2f(MPI_COMM_SELF);
#endif
    RITZ_CHECK(run_job(F, START));
    F->started = true;
    set_options(F);
    FIELD(F, n) = (MUMPS_INT)F->n;
    FIELD(F, nnz) = F->nnz;
    FIELD(F, irn) = F->row;
    FIELD(F, jcn) = F->col;
    if (F->width == 1)
        F->id.d.a = F->val;
    else
        F->id.z.a = (void *)F->val;
    if (F->place) {
        FIELD(F, icntl)[ORDERING] = 1;
        FIELD(F, perm_in) = F->place;
    }
    FIELD(F, icntl)[DISCARD_FACTOR] = F->counted;
    RITZ_CHECK(admit_bytes(F,
                           F->counted ? "the pattern of the factor of a count"
                                      : "the pattern of the factor",
                           16 * F->nnz));
    RITZ_CHECK(run_job(F, ANALYSE));
    return admit_factor(F);
}

/* A fill-reducing order for the union of the patterns of all matrices. */
static ritz_status order_union(int64_t count, const ritz_sparse *const *A,
                               int64_t **order)
{
    RITZ_OWN(ritz_sparse) sum = {0};

    if (count == 1)
        return ritz_ordering_new(A[0], order);
    RITZ_CHECK(ritz_sparse_add(1.0, A[0], 1.0, A[1], &sum));
    for (int64_t k = 2; k < count; k++) {
        RITZ_OWN(ritz_sparse) next = {0};

        RITZ_CHECK(ritz_sparse_add(1.0, &sum, 1.0, A[k], &next));
        ritz_sparse_free(&sum);
        RITZ_MOVE(sum, next);
    }
    return ritz_ordering_new(&sum, order);
}

/* F->place, from the given order or from one that is found. MUMPS itself orders
   small and unsymmetric matrices. */
static ritz_status place_rows(int64_t count, const ritz_sparse *const *A,
                              const int64_t *order, mumps_factor *F)
{
    RITZ_OWN_ARRAY int64_t *found = NULL;

    if (F->n < RITZ_ORDER_FROM || F->whole)
        return RITZ_OK;
    if (!order)
        RITZ_CHECK(order_union(count, A, &found));
    order = order ? order : found;
    RITZ_CHECK_NEW(F->place, F->n);
    for (int64_t k = 0; k < F->n; k++)
        F->place[order[k]] = (MUMPS_INT)(k + 1);
    return RITZ_OK;
}

static ritz_status unite_matrices(int64_t count, const ritz_sparse *const *A,
                                  const int64_t *order, mumps_factor *F)
{
    RITZ_CHECK(unite_patterns(count, A, F));
    RITZ_CHECK(place_rows(count, A, order, F));
    RITZ_CHECK_NEW(F->val, F->width * F->nnz);
    RITZ_CHECK_NEW(F->at, F->n);
    RITZ_CHECK_NEW(F->A, count);
    for (int64_t k = 0; k < count; k++)
        F->A[k] = *A[k];
    F->count = count;
    return RITZ_OK;
}

static ritz_status prepare_factor(int64_t count, const ritz_sparse *const *A,
                                  const int64_t *order, mumps_factor *F)
{
    RITZ_CHECK(unite_matrices(count, A, order, F));
    return F->n > 0 ? analyse_pattern(F) : RITZ_OK;
}

/* val += c A, or its lower triangle. */
static void add_values(const ritz_sparse *A, double _Complex c, mumps_factor *F)
{
    double _Complex *z = (void *)F->val;
    int64_t at = 0;

    for (int64_t j = 0; j < F->n; j++) {
        for (; at < F->nnz && F->col[at] == j + 1; at++)
            F->at[F->row[at] - 1] = at;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            if (!F->whole && A->rowind[p] < j)
                continue;
            if (F->width == 1)
                F->val[F->at[A->rowind[p]]] += creal(c) * A->val[p];
            else
                z[F->at[A->rowind[p]]] += c * A->val[p];
        }
    }
}

static double magnitude_of(const double *val, int64_t k, int width)
{
    return width == 1 ? fabs(val[k]) : hypot(val[2 * k], val[2 * k + 1]);
}

/* S such that the largest |S A S| of every row and column is near one. */
static ritz_status equilibrate_rows(const mumps_factor *F, double *s)
{
    RITZ_OWN_ARRAY double *largest = NULL;

    RITZ_CHECK_NEW(largest, F->n);
    for (int64_t i = 0; i < F->n; i++)
        s[i] = 1.0;
    for (int e = 0; e < EQUILIBRATIONS; e++) {
        for (int64_t i = 0; i < F->n; i++)
            largest[i] = 0.0;
        for (int64_t k = 0; k < F->nnz; k++) {
            int64_t i = F->row[k] - 1;
            int64_t j = F->col[k] - 1;
            double a = s[i] * magnitude_of(F->val, k, F->width) * s[j];

            largest[i] = ritz_larger(largest[i], a);
            largest[j] = ritz_larger(largest[j], a);
        }
        for (int64_t i = 0; i < F->n; i++)
            s[i] /= largest[i] > 0.0 ? sqrt(largest[i]) : 1.0;
    }
    return RITZ_OK;
}

/* Overwrite @p x, n x k numbers, by the solution. */
static ritz_status solve_factored(mumps_factor *F, int64_t k, double *x)
{
    RITZ_REFUSE_IF(k < 0 || k > INT_MAX, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " right-hand sides are more than MUMPS can count",
                   k);
    if (F->n == 0 || k == 0)
        return RITZ_OK;
    if (F->width == 1)
        F->id.d.rhs = x;
    else
        F->id.z.rhs = (void *)x;
    FIELD(F, nrhs) = (MUMPS_INT)k;
    FIELD(F, lrhs) = (MUMPS_INT)F->n;
    return run_job(F, SOLVE);
}

/* Unequal entries, none 0: orthogonal to no eigenvector, most likely. */
static void start_vector(int64_t count, double *y)
{
    for (int64_t i = 0; i < count; i++)
        y[i] = cos((double)i);
}

/* y := y / |y|, and |y|. */
static double normalise_vector(int64_t count, double *y)
{
    double size = cblas_dnrm2((int)count, y, 1);

    for (int64_t i = 0; i < count; i++)
        y[i] /= size;
    return size;
}

static void divide_rows(const double *s, int64_t count, int width, double *y)
{
    for (int64_t i = 0; i < count; i++)
        y[i] /= s[i / width];
}

/*
 * A is singular to working accuracy if |H y| <= c eps |y| for some y, where
 * H = S A S is A scaled so that the largest entry of each row is near one.
 */
static ritz_status refuse_singular(mumps_factor *F)
{
    int64_t count = F->n * F->width;
    double smallest = HUGE_VAL;
    RITZ_OWN_ARRAY double *s = NULL;
    RITZ_OWN_ARRAY double *y = NULL;

    RITZ_CHECK_NEW(s, F->n);
    RITZ_CHECK_NEW(y, count);
    RITZ_CHECK(equilibrate_rows(F, s));
    start_vector(count, y);
    normalise_vector(count, y);
    for (int k = 0; k < SWEEPS; k++) {
        divide_rows(s, count, F->width, y);
        RITZ_CHECK(solve_factored(F, 1, y));
        divide_rows(s, count, F->width, y);
        smallest = 1.0 / normalise_vector(count, y);
    }
    RITZ_REFUSE_IF(!(smallest > RITZ_SINGULAR_LDL), RITZ_ERR_SINGULAR,
                   "the matrix is singular to working accuracy");
    return RITZ_OK;
}

static ritz_status factor_values(mumps_factor *F)
{
    if (F->n > 0) {
        RITZ_CHECK(run_job(F, FACTOR));
        if (!F->counted)
            RITZ_CHECK(refuse_singular(F));
    }
    F->factored = true;
    return RITZ_OK;
}

static void end_mumps(mumps_factor *F)
{
    if (F->started)
        call_mumps(F, END);
    F->started = false;
}

static void release_factor(mumps_factor *F)
{
    end_mumps(F);
    RITZ_FREE(F->row, F->col, F->val, F->A, F->place, F->at);
}

/* A = L D L'. @param[in] counted  only pivots are wanted: L is not kept */
static ritz_status factor_real(const ritz_sparse *A, const int64_t *order,
                               bool counted, int64_t *negative, ritz_ldl **out)
{
    RITZ_OWN(ritz_ldl) *F = NULL;

    RITZ_CHECK_NEW(F, 1);
    F->of.width = 1;
    F->of.counted = counted;
    RITZ_CHECK(prepare_factor(1, &A, order, &F->of));
    add_values(A, 1.0, &F->of);
    RITZ_CHECK(factor_values(&F->of));
    if (negative)
        *negative = A->nrow > 0 ? F->of.id.d.infog[NEGATIVE_PIVOTS] : 0;
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

ritz_status ritz_ldl_new(const ritz_sparse *A, int64_t *negative,
                         ritz_ldl **out)
{
    return factor_real(A, NULL, false, negative, out);
}

ritz_status ritz_inertia_negative(const ritz_sparse *A, const int64_t *order,
                                  int64_t *negative)
{
    RITZ_OWN(ritz_ldl) *F = NULL;

    return factor_real(A, order, true, negative, &F);
}

/* @param[in] counted  as for factor_real() */
static ritz_status make_counter(const ritz_sparse *K, const ritz_sparse *M,
                                const int64_t *order, bool counted,
                                ritz_counter **out)
{
    const ritz_sparse *const both[] = {K, M};
    RITZ_OWN(ritz_counter) *C = NULL;

    RITZ_CHECK(ritz_eigen_refuse(K->nrow, K->ncol, M->nrow, M->ncol));
    RITZ_CHECK_NEW(C, 1);
    C->of.width = 1;
    C->of.counted = counted;
    RITZ_CHECK(unite_matrices(2, both, order, &C->of));
    RITZ_MOVE(*out, C);
    return RITZ_OK;
}

ritz_status ritz_counter_new(const ritz_sparse *K, const ritz_sparse *M,
                             const int64_t *order, ritz_counter **out)
{
    return make_counter(K, M, order, true, out);
}

void ritz_counter_relieve(ritz_counter *C, ritz_relief relief)
{
    C->of.relief = relief;
}

void ritz_counter_share(ritz_counter *C, bool shared)
{
    C->of.shared = shared;
}

/* MUMPS frees its workspace only together with its analysis. The analysis is
   therefore made again for each count; with a known order it is cheap. */
ritz_status ritz_counter_below(ritz_counter *C, double tau, int64_t *below)
{
    mumps_factor *F = &C->of;
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(!isfinite(tau), RITZ_ERR_ARGUMENT,
                   "modes below %g cannot be counted", tau);
    if (F->n == 0) {
        *below = 0;
        return RITZ_OK;
    }
    memset(F->val, 0, (size_t)F->nnz * sizeof *F->val);
    add_values(&F->A[0], 1.0, F);
    add_values(&F->A[1], -tau, F);
    ritz_monitor_step("count of modes", 0, 0);
    status = analyse_pattern(F);
    if (status == RITZ_OK)
        status = factor_values(F);
    if (status == RITZ_OK)
        *below = F->id.d.infog[NEGATIVE_PIVOTS];
    end_mumps(F);
    return status;
}

void ritz_counter_free(ritz_counter **C)
{
    if (*C)
        release_factor(&(*C)->of);
    free(*C);
    *C = NULL;
}

ritz_status ritz_inertia_below(const ritz_sparse *K, const ritz_sparse *M,
                               double tau, const int64_t *order, int64_t *out)
{
    RITZ_OWN(ritz_counter) *C = NULL;

    RITZ_CHECK(make_counter(K, M, order, false, &C));
    return ritz_counter_below(C, tau, out);
}

ritz_status ritz_ldl_solve(ritz_ldl *F, ritz_dense *X)
{
    RITZ_REFUSE_IF(X->nrow != F->of.n, RITZ_ERR_ARGUMENT,
                   "a factor of %" PRId64 " rows meets %" PRId64, F->of.n,
                   X->nrow);
    return solve_factored(&F->of, X->ncol, X->val);
}

void ritz_ldl_free(ritz_ldl **F)
{
    if (*F)
        release_factor(&(*F)->of);
    free(*F);
    *F = NULL;
}

ritz_status ritz_zldl_new(int64_t count, const ritz_sparse *const *A,
                          ritz_zldl **out)
{
    RITZ_OWN(ritz_zldl) *F = NULL;

    RITZ_CHECK_NEW(F, 1);
    F->of.width = 2;
    for (int64_t k = 0; k < count; k++)
        F->of.whole = F->of.whole || (A[k]->nrow == A[k]->ncol &&
                                      ritz_sparse_asymmetry(A[k]) > 0.0);
    RITZ_CHECK(prepare_factor(count, A, NULL, &F->of));
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

void ritz_zldl_definite(ritz_zldl *F)
{
    if (F->of.started)
        F->of.id.z.cntl[THRESHOLD] = 0.0;
}

ritz_status ritz_zldl_factor(ritz_zldl *F, const double _Complex *c)
{
    F->of.factored = false;
    memset(F->of.val, 0, 2 * (size_t)F->of.nnz * sizeof *F->of.val);
    for (int64_t k = 0; k < F->of.count; k++) {
        RITZ_REFUSE_IF(
            !isfinite(creal(c[k])) || !isfinite(cimag(c[k])), RITZ_ERR_ARGUMENT,
            "coefficient %" PRId64 " of the matrices is not finite", k + 1);
        add_values(&F->of.A[k], c[k], &F->of);
    }
    return factor_values(&F->of);
}

ritz_status ritz_zldl_solve(ritz_zldl *F, bool transposed, int64_t k,
                            double _Complex *X)
{
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(!F->of.factored, RITZ_ERR_ARGUMENT,
                   "a solve needs a factor first");
    F->of.id.z.icntl[TRANSPOSED] = !transposed;
    status = solve_factored(&F->of, k, (double *)X);
    F->of.id.z.icntl[TRANSPOSED] = 1;
    return status;
}

void ritz_zldl_free(ritz_zldl **F)
{
    if (*F)
        release_factor(&(*F)->of);
    free(*F);
    *F = NULL;
}
