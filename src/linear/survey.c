/* Scales of K and M before they are factored, and residuals of eigenpairs
   after. */
#include "base/alloc.h"
#include "base/search.h"
#include "linear/shifted.h"

#include <math.h>
#include <stdlib.h>

ritz_status ritz_shifted_survey(const ritz_sparse *K, const ritz_sparse *M,
                                ritz_survey *out)
{
    ritz_status status = RITZ_OK;
    ritz_survey s = {0};
    double *ratio = NULL;
    int64_t count = 0;

    RITZ_NEW(ratio, K->nrow);
    RITZ_NEW(s.heavy, K->nrow);
    for (int64_t j = 0; j < K->nrow; j++) {
        double k = ritz_sparse_diagonal(K, j);
        double m = ritz_sparse_diagonal(M, j);
        bool heavy = false;

        for (int64_t p = M->colptr[j]; p < M->colptr[j + 1]; p++)
            heavy = heavy || M->val[p] != 0.0;
        if (heavy)
            s.heavy[s.num_heavy++] = j;
        if (k > 0.0 && m > 0.0)
            ratio[count++] = k / m;
    }
    qsort(ratio, (size_t)count, sizeof *ratio, ritz_ascending);
    s.typical = count > 0 ? ratio[count / 2] : 1.0;
    RITZ_MOVE(*out, s);
done:
    free(s.heavy);
    free(ratio);
    return status;
}

/* Residual of one pair, as ritz_eigen.h defines it; *energy = |x|'|K||x|. */
static double residual_of(const ritz_shifted *S, const double *x, double lambda,
                          double *energy)
{
    const ritz_sparse *K = S->K;
    const ritz_sparse *M = S->M;
    double gap = 0.0;
    double size = 0.0;

    *energy = 0.0;
    for (int64_t j = 0; j < K->ncol; j++) {
        double g = 0.0;
        double k = 0.0;
        double m = 0.0;

        for (int64_t p = K->colptr[j]; p < K->colptr[j + 1]; p++) {
            g += K->val[p] * x[K->rowind[p]];
            k += fabs(K->val[p] * x[K->rowind[p]]);
        }
        for (int64_t p = M->colptr[j]; p < M->colptr[j + 1]; p++) {
            g -= lambda * M->val[p] * x[M->rowind[p]];
            m += fabs(M->val[p] * x[M->rowind[p]]);
        }
        *energy += fabs(x[j]) * k;
        k += fabs(lambda) * m;
        gap = hypot(gap, g);
        size = hypot(size, k);
    }
    return size > 0.0 ? gap / size : 0.0;
}

double ritz_shifted_assess(const ritz_shifted *S, ritz_pairs *P)
{
    double worst = 0.0;
    double scale = 0.0;

    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        double energy = 0.0;

        P->residual[j] =
            residual_of(S, ritz_dense_col(&P->Phi, j), P->lambda[j], &energy);
        scale = fmax(scale, energy);
        worst = P->residual[j] <= worst ? worst : P->residual[j];
    }
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    return worst;
}
