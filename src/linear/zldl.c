/* sum_k c_k A_k = L D L', or L U, by sequential MUMPS, complex: see mumps.h. */
#include "base/alloc.h"
#include "linear/mumps.h"

#include <ritz/matrix.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zmumps_c.h>

/* Indices from zero: ICNTL(9) is 1 for the matrix, else its transpose is
 * meant; CNTL(1) is the threshold of pivots, 0 for none. */
enum { TRANSPOSED = 8, THRESHOLD = 0 };

struct ritz_zldl {
    ZMUMPS_STRUC_C id;
    bool started;
    bool factored;
    bool whole;                 /* one of the matrices is not symmetric */
    ritz_mumps_pattern pattern; /* borrowed by MUMPS, as val is */
    double _Complex *val;
    int64_t count;
    ritz_sparse *A; /* borrowed, all but the array */
    int64_t *place; /* of each row among the entries of one column */
};

static void call_mumps(void *id)
{
    zmumps_c(id);
}

static void set_rhs(void *id, int n, int k, void *x)
{
    ZMUMPS_STRUC_C *z = id;

    z->rhs = x;
    z->nrhs = k;
    z->lrhs = n;
}

static ritz_mumps view_mumps(ritz_zldl *F)
{
    return (ritz_mumps){
        .id = &F->id,
        .call = call_mumps,
        .set_rhs = set_rhs,
        .job = &F->id.job,
        .icntl = F->id.icntl,
        .infog = F->id.infog,
        .cntl = F->id.cntl,
        .width = 2,
    };
}

static ritz_status analyse_pattern(ritz_zldl *F)
{
    ritz_mumps mumps = view_mumps(F);

    F->id.sym = F->whole ? 0 : 2;
    F->id.par = 1;
    RITZ_CHECK(ritz_mumps_run(&mumps, RITZ_MUMPS_START));
    F->started = true;
    ritz_mumps_configure(&mumps);
    F->id.n = (MUMPS_INT)F->pattern.n;
    F->id.nnz = F->pattern.nnz;
    F->id.irn = F->pattern.row;
    F->id.jcn = F->pattern.col;
    F->id.a = (void *)F->val; /* two doubles each, for both */
    return ritz_mumps_run(&mumps, RITZ_MUMPS_ANALYSE);
}

ritz_status ritz_zldl_new(int64_t count, const ritz_sparse *const *A,
                          ritz_zldl **out)
{
    RITZ_OWN(ritz_zldl) *F = NULL;

    RITZ_CHECK_NEW(F, 1);
    for (int64_t k = 0; k < count; k++)
        F->whole = F->whole || (A[k]->nrow == A[k]->ncol &&
                                ritz_sparse_asymmetry(A[k]) > 0.0);
    RITZ_CHECK(ritz_mumps_unite(count, A, F->whole, &F->pattern));
    RITZ_CHECK_NEW(F->val, F->pattern.nnz);
    RITZ_CHECK_NEW(F->place, F->pattern.n);
    RITZ_CHECK_NEW(F->A, count);
    for (int64_t k = 0; k < count; k++)
        F->A[k] = *A[k];
    F->count = count;
    if (F->pattern.n > 0)
        RITZ_CHECK(analyse_pattern(F));
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

void ritz_zldl_definite(ritz_zldl *F)
{
    if (F->started)
        F->id.cntl[THRESHOLD] = 0.0;
}

/* val += c A, or its lower triangle. */
static void add_values(const ritz_sparse *A, double _Complex c, ritz_zldl *F)
{
    int64_t at = 0;

    for (int64_t j = 0; j < F->pattern.n; j++) {
        for (; at < F->pattern.nnz && F->pattern.col[at] == j + 1; at++)
            F->place[F->pattern.row[at] - 1] = at;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (F->whole || A->rowind[p] >= j)
                F->val[F->place[A->rowind[p]]] += c * A->val[p];
    }
}

ritz_status ritz_zldl_factor(ritz_zldl *F, const double _Complex *c)
{
    ritz_mumps mumps = view_mumps(F);

    F->factored = false;
    memset(F->val, 0, (size_t)F->pattern.nnz * sizeof *F->val);
    for (int64_t k = 0; k < F->count; k++) {
        RITZ_REFUSE_IF(
            !isfinite(creal(c[k])) || !isfinite(cimag(c[k])), RITZ_ERR_ARGUMENT,
            "coefficient %" PRId64 " of the matrices is not finite", k + 1);
        add_values(&F->A[k], c[k], F);
    }
    if (F->pattern.n > 0) {
        RITZ_CHECK(ritz_mumps_run(&mumps, RITZ_MUMPS_FACTOR));
        RITZ_CHECK(ritz_mumps_judge(&mumps, &F->pattern, (double *)F->val));
    }
    F->factored = true;
    return RITZ_OK;
}

ritz_status ritz_zldl_solve(ritz_zldl *F, int64_t k, double _Complex *X)
{
    ritz_mumps mumps = view_mumps(F);

    RITZ_REFUSE_IF(!F->factored, RITZ_ERR_ARGUMENT,
                   "a solve needs a factor first");
    return ritz_mumps_solve(&mumps, F->pattern.n, k, X);
}

ritz_status ritz_zldl_solve_transposed(ritz_zldl *F, int64_t k,
                                       double _Complex *X)
{
    ritz_status status = RITZ_OK;

    F->id.icntl[TRANSPOSED] = 0;
    status = ritz_zldl_solve(F, k, X);
    F->id.icntl[TRANSPOSED] = 1;
    return status;
}

void ritz_zldl_free(ritz_zldl **F)
{
    if (!*F)
        return;
    if ((*F)->started) {
        (*F)->id.job = RITZ_MUMPS_END;
        zmumps_c(&(*F)->id);
    }
    ritz_mumps_pattern_free(&(*F)->pattern);
    free((*F)->val);
    free((*F)->A);
    free((*F)->place);
    free(*F);
    *F = NULL;
}
