/* The matrix of the first-order form: see state.h. */
#include "poles/state.h"

#include "base/alloc.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

double ritz_state_weight(const ritz_state *state, int64_t j)
{
    return state->lambda[j] == 0.0 ? 1.0 : sqrt(fabs(state->lambda[j]));
}

/* G = D_aa^-1 [D_ap I], k x (m + k). */
static ritz_status solve_massless(const ritz_state *s, ritz_dense *G)
{
    ritz_status status = RITZ_OK;
    int64_t m = s->m, k = s->k;
    ritz_dense A = {0};
    lapack_int *pivot = NULL;
    int info = 0;

    RITZ_NEW(pivot, k);
    RITZ_TRY(ritz_dense_new(k, k, &A));
    RITZ_TRY(ritz_dense_new(k, m + k, G));
    for (int64_t i = 0; i < k; i++) {
        for (int64_t j = 0; j < k; j++)
            ritz_dense_col(&A, j)[i] = ritz_dense_col(&s->D, m + j)[m + i];
        for (int64_t j = 0; j < m; j++)
            ritz_dense_col(G, j)[i] = ritz_dense_col(&s->D, j)[m + i];
        ritz_dense_col(G, m + i)[i] = 1.0;
    }
    if (k > 0)
        info = LAPACKE_dgesv(LAPACK_COL_MAJOR, (int)k, (int)(m + k), A.val,
                             (int)k, pivot, G->val, (int)k);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_SINGULAR,
                 "damping of the motions without mass is singular");
done:
    free(pivot);
    ritz_dense_free(&A);
    return status;
}

ritz_status ritz_state_matrix(const ritz_state *s, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = s->m, k = s->k;
    ritz_dense A = {0}, G = {0};

    RITZ_TRY(ritz_dense_new(2 * m + k, 2 * m + k, &A));
    RITZ_TRY(solve_massless(s, &G));
    for (int64_t j = 0; j < m; j++) {
        double w = ritz_state_weight(s, j);

        ritz_dense_col(&A, m + j)[j] = w;
        ritz_dense_col(&A, j)[m + j] = -s->lambda[j] / w;
    }
    for (int64_t j = 0; j < m + k; j++)
        for (int64_t i = 0; i < m + k; i++) {
            double *a = &ritz_dense_col(&A, m + j)[m + i];

            if (i >= m) {
                *a = -ritz_dense_col(&G, j)[i - m];
                continue;
            }
            *a = j < m ? -ritz_dense_col(&s->D, j)[i] : 0.0;
            for (int64_t t = 0; t < k; t++) /* D_pa G */
                *a +=
                    ritz_dense_col(&s->D, m + t)[i] * ritz_dense_col(&G, j)[t];
        }
    *out = A;
    A = (ritz_dense){0};
done:
    ritz_dense_free(&A);
    ritz_dense_free(&G);
    return status;
}
