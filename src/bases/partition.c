#include "bases/partition.h"

#include "bases/mechanism.h"

ritz_status ritz_partition_new(const ritz_request *request, ritz_partition *out)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *K = &request->component->K;
    const ritz_sparse *M = &request->component->M;
    const ritz_dofs *b = &request->attached;
    ritz_partition s = {.component = request->component, .b = b};
    const ritz_dofs *i = &s.i;

    RITZ_TRY(ritz_dofs_complement(b, s.component->num_dofs, &s.i));
    RITZ_TRY(ritz_sparse_extract(K, i->count, i->at, i->count, i->at, &s.K_ii));
    RITZ_TRY(ritz_sparse_extract(K, i->count, i->at, b->count, b->at, &s.K_ib));
    RITZ_TRY(ritz_sparse_extract(M, i->count, i->at, i->count, i->at, &s.M_ii));
    *out = s;
    s = (ritz_partition){0};
done:
    ritz_partition_free(&s);
    return status;
}

ritz_status ritz_partition_factor(const ritz_partition *s, ritz_factor **out)
{
    ritz_status status = RITZ_OK;
    int64_t weak = -1;

    if (s->i.count == 0)
        goto done;
    status = ritz_factor_spd_weak(&s->K_ii, out, &weak);
    if (status == RITZ_ERR_SINGULAR)
        status = ritz_mechanism_refuse(s->component, &s->K_ii, &s->M_ii, &s->i,
                                       weak);
    RITZ_TRY_IN("interior stiffness", status);
done:
    return status;
}

/* -A as a dense matrix: the right-hand sides of the constraint modes. */
static ritz_status negate(const ritz_sparse *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->nrow, A->ncol, out));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[A->rowind[p]] = -A->val[p];
    return RITZ_OK;
}

ritz_status ritz_partition_constraint_modes(const ritz_partition *s,
                                            ritz_factor *L, ritz_dense *Psi)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0};

    RITZ_TRY(negate(&s->K_ib, &X));
    if (s->i.count > 0)
        RITZ_TRY(ritz_factor_solve(L, &X));
    *Psi = X;
    X = (ritz_dense){0};
done:
    ritz_dense_free(&X);
    return status;
}

void ritz_partition_scatter(const ritz_dense *part, const ritz_dofs *to,
                            int64_t first, ritz_dense *T)
{
    for (int64_t j = 0; j < part->ncol; j++) {
        const double *from = ritz_dense_col(part, j);
        double *into = ritz_dense_col(T, first + j);

        for (int64_t k = 0; k < part->nrow; k++)
            into[to->at[k]] = from[k];
    }
}

void ritz_partition_free(ritz_partition *s)
{
    ritz_dofs_free(&s->i);
    ritz_sparse_free(&s->K_ii);
    ritz_sparse_free(&s->K_ib);
    ritz_sparse_free(&s->M_ii);
}
