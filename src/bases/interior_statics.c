/*
 * Static vectors of the interior with a fixed boundary [ChuMilman1992], joined
 * to the modes of the interior:
 *
 *     X = K_ii^-1 F_i,   X := X - Phi Phi'M_ii X,   [Phi, X]
 *
 * Of X the independent columns are kept whose energy F_j'X_j is more than
 * rounding.
 */
#include "bases/interior_statics.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>

void ritz_interior_statics_free(ritz_interior_statics *a)
{
    ritz_dense_free(&a->F);
    ritz_dense_free(&a->X);
    RITZ_FREE(a->least, a->keep);
}

ritz_status ritz_interior_statics_collect(const ritz_request *request,
                                          const ritz_partition *s, int usual,
                                          ritz_interior_statics *out)
{
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    RITZ_CHECK(ritz_loads_beside(request, usual, &out->loads));
    if (ritz_loads_count(request, out->loads) == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_loads_collect(request, out->loads, &F, &dof));
    return ritz_dense_rows(&F, s->i.count, s->i.at, &out->F);
}

ritz_status ritz_interior_statics_respond(const ritz_request *request,
                                          ritz_factor *L,
                                          ritz_interior_statics *a)
{
    const double part = fmax(request->tolerance, RITZ_FORCE_RELIEVED);

    if (a->F.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(&a->F, &a->X));
    if (L)
        RITZ_CHECK(ritz_factor_solve(L, &a->X));
    RITZ_CHECK_NEW(a->least, a->F.ncol);
    RITZ_CHECK_NEW(a->keep, a->F.ncol);
    for (int64_t j = 0; j < a->F.ncol; j++)
        a->least[j] = part * ritz_dense_dot(&a->F, j, &a->X, j);
    return RITZ_OK;
}

/* [Phi, X]: the modes, and the independent columns of X without their part in
   the modes. */
static ritz_status join_statics(const ritz_partition *s, double tolerance,
                                const ritz_dense *Phi, ritz_interior_statics *a,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) MPhi = {0}, X = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_sparse_mul(&s->M_ii, Phi, &MPhi));
    for (int pass = 0; pass < 2 && Phi->ncol > 0; pass++)
        RITZ_CHECK(ritz_dense_take_out(Phi, &MPhi, &a->X));
    RITZ_CHECK(ritz_statics_choose(&a->F, &a->X, a->least, tolerance, a->keep,
                                   &a->kept));
    RITZ_CHECK_NEW(at, a->kept);
    for (int64_t j = 0; j < a->X.ncol; j++)
        if (a->keep[j])
            at[count++] = j;
    RITZ_CHECK(ritz_dense_pick(&a->X, count, at, &X));
    return ritz_dense_beside(Phi, &X, out);
}

ritz_status ritz_interior_statics_join(const ritz_request *request,
                                       const ritz_partition *s,
                                       const ritz_dense *Phi,
                                       ritz_interior_statics *a,
                                       ritz_basis *out)
{
    RITZ_OWN(ritz_dense) X = {0};

    if (a->F.ncol > 0)
        RITZ_CHECK(join_statics(s, request->tolerance, Phi, a, &X));
    RITZ_CHECK(ritz_partition_join(s, a->F.ncol > 0 ? &X : Phi, out));
    for (int64_t j = out->T.ncol - a->kept; j < out->T.ncol; j++)
        out->columns.kind[j] = RITZ_COLUMN_STATIC;
    ritz_remark_left_out(request, a->loads, 0, a->F.ncol, a->keep,
                         RITZ_COLUMN_STATIC, out);
    ritz_remark_dampers(request, a->loads, out);
    return RITZ_OK;
}
