#include "linear/mumps.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

enum {
    EQUILIBRATIONS = 5, /* halve the logarithm of the row maxima each */
    SWEEPS = 3,         /* of inverse iteration */
    MORE_ROOM = 8,      /* times the workspace may grow */
};

/* Indices from zero of the control arrays, ICNTL(k) of the manual being k - 1.
 */
enum {
    ERROR_UNIT = 0,
    DIAGNOSTIC_UNIT = 1,
    GLOBAL_UNIT = 2,
    PRINT_LEVEL = 3,
    MAX_TRANSVERSAL = 5,
    ORDERING = 6,
    SCALING = 7,
    SYMMETRIC_STRATEGY = 11,
    ROOT_SEQUENTIAL = 12,
    ROOM_PERCENT = 13,
    NULL_PIVOTS = 23,
    NULL_PIVOT_SIZE = 2, /* of CNTL */
    OUTCOME = 0,         /* of INFOG */
    NUM_NULL_PIVOTS = 27,
};

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

/* Add column j of A to P, unless `whole` without what lies above the diagonal;
 * mark[i] is the last column + 1 that row i was met in. */
static ritz_status unite_column(const ritz_sparse *A, int64_t j, bool whole,
                                int64_t *mark, ritz_mumps_pattern *P)
{
    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
        int64_t i = A->rowind[p];

        RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_ARGUMENT,
                       "entry (%" PRId64 ", %" PRId64 ") is not finite", i, j);
        if ((i < j && !whole) || mark[i] == j + 1)
            continue;
        mark[i] = j + 1;
        P->row[P->nnz] = (MUMPS_INT)(i + 1);
        P->col[P->nnz++] = (MUMPS_INT)(j + 1);
    }
    return RITZ_OK;
}

ritz_status ritz_mumps_unite(int64_t count, const ritz_sparse *const *A,
                             bool whole, ritz_mumps_pattern *out)
{
    RITZ_OWN(ritz_mumps_pattern) P = {0};
    RITZ_OWN_ARRAY int64_t *mark = NULL;
    int64_t room = 0;

    RITZ_CHECK(check_sizes(count, A, &room));
    P.n = A[0]->nrow;
    RITZ_CHECK_NEW(mark, P.n);
    RITZ_CHECK_NEW(P.row, room);
    RITZ_CHECK_NEW(P.col, room);
    for (int64_t j = 0; j < P.n; j++)
        for (int64_t k = 0; k < count; k++)
            RITZ_CHECK(unite_column(A[k], j, whole, mark, &P));
    RITZ_MOVE(*out, P);
    return RITZ_OK;
}

void ritz_mumps_pattern_free(ritz_mumps_pattern *P)
{
    free(P->row);
    free(P->col);
    *P = (ritz_mumps_pattern){0};
}

void ritz_mumps_configure(const ritz_mumps *mumps)
{
    mumps->icntl[ERROR_UNIT] = -1;
    mumps->icntl[DIAGNOSTIC_UNIT] = -1;
    mumps->icntl[GLOBAL_UNIT] = -1;
    mumps->icntl[PRINT_LEVEL] = 0;
    mumps->icntl[MAX_TRANSVERSAL] = 0; /* so that analysis reads no values */
    mumps->icntl[SYMMETRIC_STRATEGY] = 1;
    mumps->icntl[ORDERING] = 7;        /* the best of those it was built with */
    mumps->icntl[SCALING] = 7;         /* rows and columns, while factoring */
    mumps->icntl[ROOT_SEQUENTIAL] = 1; /* or pivots there go uncounted */
    mumps->icntl[ROOM_PERCENT] = 30;
    mumps->icntl[NULL_PIVOTS] = 1;
    mumps->cntl[NULL_PIVOT_SIZE] = DBL_EPSILON / 16.0; /* judge() does more */
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

ritz_status ritz_mumps_run(const ritz_mumps *mumps, int job)
{
    *mumps->job = job;
    mumps->call(mumps->id);
    for (int k = 0; k < MORE_ROOM && (mumps->infog[OUTCOME] == -8 ||
                                      mumps->infog[OUTCOME] == -9);
         k++) {
        mumps->icntl[ROOM_PERCENT] *= 2;
        *mumps->job = job;
        mumps->call(mumps->id);
    }
    RITZ_CHECK(report_failure(mumps->infog));
    RITZ_REFUSE_IF(job == RITZ_MUMPS_FACTOR &&
                       mumps->infog[NUM_NULL_PIVOTS] > 0,
                   RITZ_ERR_SINGULAR, "the matrix is singular, %d times",
                   (int)mumps->infog[NUM_NULL_PIVOTS]);
    return RITZ_OK;
}

static double magnitude_of(const double *val, int64_t k, int width)
{
    return width == 1 ? fabs(val[k]) : hypot(val[2 * k], val[2 * k + 1]);
}

/* S such that the largest |S A S| of every row and column is near one. */
static ritz_status equilibrate_rows(const ritz_mumps_pattern *P,
                                    const double *val, int width, double *s)
{
    RITZ_OWN_ARRAY double *largest = NULL;

    RITZ_CHECK_NEW(largest, P->n);
    for (int64_t i = 0; i < P->n; i++)
        s[i] = 1.0;
    for (int e = 0; e < EQUILIBRATIONS; e++) {
        for (int64_t i = 0; i < P->n; i++)
            largest[i] = 0.0;
        for (int64_t k = 0; k < P->nnz; k++) {
            int64_t i = P->row[k] - 1;
            int64_t j = P->col[k] - 1;
            double a = s[i] * magnitude_of(val, k, width) * s[j];

            largest[i] = fmax(largest[i], a);
            largest[j] = fmax(largest[j], a);
        }
        for (int64_t i = 0; i < P->n; i++)
            s[i] /= largest[i] > 0.0 ? sqrt(largest[i]) : 1.0;
    }
    return RITZ_OK;
}

ritz_status ritz_mumps_solve(const ritz_mumps *mumps, int64_t n, int64_t k,
                             void *x)
{
    RITZ_REFUSE_IF(k < 0 || k > INT_MAX, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " right-hand sides are more than MUMPS can count",
                   k);
    if (n == 0 || k == 0)
        return RITZ_OK;
    mumps->set_rhs(mumps->id, (int)n, (int)k, x);
    return ritz_mumps_run(mumps, RITZ_MUMPS_SOLVE);
}

/* Every entry counts, none equal: no eigenvector is likely to be missed. */
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

ritz_status ritz_mumps_judge(const ritz_mumps *mumps,
                             const ritz_mumps_pattern *P, const double *val)
{
    int64_t count = P->n * mumps->width;
    double smallest = HUGE_VAL;
    RITZ_OWN_ARRAY double *s = NULL;
    RITZ_OWN_ARRAY double *y = NULL;

    RITZ_CHECK_NEW(s, P->n);
    RITZ_CHECK_NEW(y, count);
    RITZ_CHECK(equilibrate_rows(P, val, mumps->width, s));
    start_vector(count, y);
    normalise_vector(count, y);
    for (int k = 0; k < SWEEPS && P->n > 0; k++) {
        divide_rows(s, count, mumps->width, y);
        RITZ_CHECK(ritz_mumps_solve(mumps, P->n, 1, y));
        divide_rows(s, count, mumps->width, y);
        smallest = 1.0 / normalise_vector(count, y);
    }
    RITZ_REFUSE_IF(!(smallest > RITZ_SINGULAR_LDL), RITZ_ERR_SINGULAR,
                   "the matrix is singular to working accuracy");
    return RITZ_OK;
}
