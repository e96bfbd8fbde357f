/* Real models in complex coordinates. */
#include "poles/widen.h"

#include "base/alloc.h"

#include <cblas.h>
#include <stdlib.h>

ritz_status ritz_widen(const ritz_dense *A, double _Complex **out)
{
    RITZ_CHECK_NEW(*out, A->nrow * A->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        (*out)[k] = A->val[k];
    return RITZ_OK;
}

ritz_status ritz_turn(int n, int m, int p, const double _Complex *Q,
                      const double _Complex *Z, double _Complex **B,
                      double _Complex **C)
{
    ritz_status status = RITZ_OK;
    const double _Complex one = 1.0, zero = 0.0;
    double _Complex *QB = NULL, *CZ = NULL;

    RITZ_NEW(QB, (int64_t)n * m);
    RITZ_NEW(CZ, (int64_t)p * n);
    cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, n, m, n, &one, Q,
                n, *B, n, &zero, QB, n);
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, p, n, n, &one, *C, p,
                Z, n, &zero, CZ, p);
    free(*B);
    free(*C);
    *B = QB;
    *C = CZ;
    QB = CZ = NULL;
done:
    free(QB);
    free(CZ);
    return status;
}
