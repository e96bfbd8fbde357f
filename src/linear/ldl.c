/* A = L D L' by sequential MUMPS, real: see mumps.h. */
#include "base/alloc.h"
#include "linear/mumps.h"

#include <ritz/matrix.h>

#include <dmumps_c.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>

enum { NEGATIVE_PIVOTS = 11 }; /* of INFOG */

struct ritz_ldl {
    DMUMPS_STRUC_C id;
    bool started;
    ritz_mumps_pattern pattern; /* borrowed by MUMPS, as val is */
    double *val;
};

static void call_mumps(void *id)
{
    dmumps_c(id);
}

static void set_rhs(void *id, int n, int k, void *x)
{
    DMUMPS_STRUC_C *d = id;

    d->rhs = x;
    d->nrhs = k;
    d->lrhs = n;
}

static ritz_mumps view_mumps(ritz_ldl *F)
{
    return (ritz_mumps){
        .id = &F->id,
        .call = call_mumps,
        .set_rhs = set_rhs,
        .job = &F->id.job,
        .icntl = F->id.icntl,
        .infog = F->id.infog,
        .cntl = F->id.cntl,
        .width = 1,
    };
}

/* Values of the lower triangle, in the order ritz_mumps_unite left them. */
static ritz_status copy_values(const ritz_sparse *A, int64_t nnz, double **out)
{
    int64_t k = 0;

    RITZ_CHECK_NEW(*out, nnz);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->rowind[p] >= j)
                (*out)[k++] = A->val[p];
    return RITZ_OK;
}

static ritz_status factorise_mumps(ritz_ldl *F)
{
    ritz_mumps mumps = view_mumps(F);

    F->id.sym = 2;
    F->id.par = 1;
    RITZ_CHECK(ritz_mumps_run(&mumps, RITZ_MUMPS_START));
    F->started = true;
    ritz_mumps_configure(&mumps);
    F->id.n = (MUMPS_INT)F->pattern.n;
    F->id.nnz = F->pattern.nnz;
    F->id.irn = F->pattern.row;
    F->id.jcn = F->pattern.col;
    F->id.a = F->val;
    RITZ_CHECK(ritz_mumps_run(&mumps, RITZ_MUMPS_ANALYSE));
    RITZ_CHECK(ritz_mumps_run(&mumps, RITZ_MUMPS_FACTOR));
    return ritz_mumps_judge(&mumps, &F->pattern, F->val);
}

ritz_status ritz_ldl_new(const ritz_sparse *A, int64_t *negative,
                         ritz_ldl **out)
{
    RITZ_OWN(ritz_ldl) *F = NULL;

    RITZ_CHECK_NEW(F, 1);
    RITZ_CHECK(ritz_mumps_unite(1, &A, false, &F->pattern));
    RITZ_CHECK(copy_values(A, F->pattern.nnz, &F->val));
    if (A->nrow > 0)
        RITZ_CHECK(factorise_mumps(F));
    if (negative)
        *negative = A->nrow > 0 ? F->id.infog[NEGATIVE_PIVOTS] : 0;
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

ritz_status ritz_ldl_solve(ritz_ldl *F, ritz_dense *X)
{
    ritz_mumps mumps = view_mumps(F);

    RITZ_REFUSE_IF(X->nrow != F->pattern.n, RITZ_ERR_ARGUMENT,
                   "a factor of %" PRId64 " rows meets %" PRId64, F->pattern.n,
                   X->nrow);
    return ritz_mumps_solve(&mumps, X->nrow, X->ncol, X->val);
}

void ritz_ldl_free(ritz_ldl **F)
{
    if (!*F)
        return;
    if ((*F)->started) {
        (*F)->id.job = RITZ_MUMPS_END;
        dmumps_c(&(*F)->id);
    }
    ritz_mumps_pattern_free(&(*F)->pattern);
    free((*F)->val);
    free(*F);
    *F = NULL;
}
