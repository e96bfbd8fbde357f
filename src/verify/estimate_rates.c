/* Rates of trial modes where no ratio is common to all. */
#include "verify/estimate_bounder.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Eigenvalues nearer than this, relative, are those of a pair. */
static const double pair = 1e-3;

/* Diagonal of X'A X, 0 of no A. */
static ritz_status diagonal(const ritz_sparse *D, const ritz_dense *X,
                            double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense DX = {0};

    if (!D->colptr)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_mul(D, X, &DX));
    for (int64_t j = 0; j < X->ncol; j++)
        out[j] = ritz_dense_dot(X, j, &DX, j);
done:
    ritz_dense_free(&DX);
    return status;
}

ritz_status ritz_bounder_rates(const ritz_estimator *estimator, ritz_bounder *r,
                               double *rates, double *matrices)
{
    ritz_status status = RITZ_OK;
    const ritz_damping *damping = &estimator->request.damping;
    double *hysteretic = NULL;

    RITZ_NEW(hysteretic, r->trial->count);
    RITZ_TRY(diagonal(&estimator->component->D, &r->trial->X, rates));
    RITZ_TRY(diagonal(&estimator->component->K4, &r->trial->X, hysteretic));
    r->zeta = 1.0;
    for (int64_t j = r->num_rigid; j < r->trial->count; j++) {
        double w = sqrt(fmax(r->trial->theta[j], DBL_MIN));

        matrices[j] = rates[j] + hysteretic[j] / w;
        rates[j] = matrices[j] +
                   2.0 * w * ritz_damping_of_mode(damping, j - r->num_rigid, w);
        r->zeta = fmin(r->zeta, fmax(0.5 * rates[j] / w, 0.0));
    }
    r->given = rates;
    r->matrices = matrices;
    r->coupled =
        estimator->component->D.colptr || estimator->component->K4.colptr;
    r->rayleigh = false;
done:
    free(hysteretic);
    return status;
}

bool ritz_bounder_at_odds(const ritz_bounder *r)
{
    for (int64_t j = r->num_rigid; r->given && j + 1 < r->trial->count; j++) {
        double low = r->trial->theta[j];
        double high = r->trial->theta[j + 1];
        double zeta = r->given[j] / sqrt(fmax(low, DBL_MIN));
        double next = r->given[j + 1] / sqrt(fmax(high, DBL_MIN));

        if (!r->coupled && high - low <= pair * high &&
            fabs(zeta - next) > pair * next)
            return true;
    }
    return false;
}
