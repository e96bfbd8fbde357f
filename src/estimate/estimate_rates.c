/* Rates of trial modes where no ratio is common to all. */
#include "estimate/estimate_bounder.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Eigenvalues nearer than this, relative, are those of a pair. */
static const double pair = 1e-3;
/* Of what other modes do: rounding of vectors, not of a force or a sensor. */
static const double no_part = 1e-9;

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

/*
 * Whether rounding of a mode's stiffness hides w d, in z = theta - w^2 + i w d:
 * what D leaves of a mode that it does not damp is no damping.
 */
static bool is_lost(const ritz_lehmann *trial, int64_t j, double damping)
{
    return fabs(damping) <= trial->rounding[j] + trial->reduced[j];
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
        if (is_lost(r->trial, j, rates[j] * w))
            rates[j] = 0.0; /* see ritz_bounder_undamped */
        else
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

/* Largest |v_j| / sqrt(theta_j - sigma) of a row or column of shares, of all or
 * of one mode. */
static double share(const ritz_bounder *r, const ritz_dense *V, bool rows,
                    int64_t j)
{
    int64_t count = rows ? V->ncol : V->nrow;
    double t = r->trial->theta[j] - r->trial->sigma;
    double most = 0.0;

    for (int64_t i = 0; i < count; i++)
        most = fmax(most, fabs(rows ? ritz_dense_col(V, i)[j]
                                    : ritz_dense_col(V, j)[i]));
    return most / sqrt(t);
}

/* Whether mode j takes part in V, beside the modes that do most. */
static bool takes_part(const ritz_bounder *r, const ritz_dense *V, bool rows,
                       int64_t j)
{
    double most = 0.0;

    for (int64_t k = 0; k < r->trial->count; k++)
        most = fmax(most, share(r, V, rows, k));
    return share(r, V, rows, j) > no_part * most;
}

bool ritz_bounder_undamped(const ritz_bounder *r, const double band_hz[2])
{
    for (int64_t j = r->num_rigid; r->given && j < r->trial->count; j++) {
        double hertz = ritz_eigen_hertz(r->trial->theta[j]);

        if (r->given[j] == 0.0 && hertz >= band_hz[0] && hertz <= band_hz[1] &&
            takes_part(r, &r->B, true, j) &&
            (takes_part(r, &r->C[0], false, j) ||
             takes_part(r, &r->C[1], false, j) ||
             takes_part(r, &r->C[2], false, j)))
            return true;
    }
    return false;
}
