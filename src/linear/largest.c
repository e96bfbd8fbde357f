#include "linear/largest.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* LAPACK returns eigenvalues in ascending order. */
ritz_status ritz_largest_pairs(int64_t n, double *A, int64_t most, double least,
                               int64_t *count, double **theta, double **vector)
{
    const int order = (int)n;
    const int64_t room = most > 0 ? most : n;
    RITZ_OWN_ARRAY double *w = NULL, *Z = NULL, *value = NULL, *x = NULL;
    RITZ_OWN_ARRAY lapack_int *support = NULL;
    lapack_int found = 0;
    int info = 0;

    RITZ_CHECK_NEW(w, n);
    RITZ_CHECK_NEW(Z, n * room);
    RITZ_CHECK_NEW(support, 2 * room);
    if (n > 0)
        info = LAPACKE_dsyevr(LAPACK_COL_MAJOR, 'V', most > 0 ? 'I' : 'V', 'L',
                              order, A, order, least, HUGE_VAL,
                              order - (int)room + 1, order, 0.0, &found, w, Z,
                              order, support);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for eigenvectors of order %" PRId64, n);
    RITZ_REFUSE_IF(info != 0 || (most > 0 && found != most),
                   RITZ_ERR_CONVERGENCE,
                   "the eigenvectors of order %" PRId64 " cannot be found", n);
    RITZ_CHECK_NEW(value, found);
    RITZ_CHECK_NEW(x, n * found);
    for (int64_t j = 0; j < found; j++) {
        value[j] = w[found - 1 - j];
        memcpy(x + j * n, Z + (found - 1 - j) * n, (size_t)n * sizeof *Z);
    }
    *count = found;
    RITZ_MOVE(*theta, value);
    RITZ_MOVE(*vector, x);
    return RITZ_OK;
}
