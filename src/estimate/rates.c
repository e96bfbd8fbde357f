/* Damping of the modes of a trial, and where it is not known. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "model/modal.h"

#include <float.h>
#include <math.h>

enum { PASSES = 3 };

/*
 * Whether D is a M + b K to rounding: a and b by least squares, corrected twice
 * by the least squares of the remainder; then every entry is compared.
 */

/* Entries of a soft row are compared with soft ones, however stiff others
   are. */
static ritz_status is_negligible(const ritz_component *full, const double ab[2],
                                 const ritz_sparse *rest, bool *out)
{
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(size, full->num_dofs);
    for (int64_t j = 0; j < full->num_dofs; j++)
        size[j] = sqrt(RITZ_RAYLEIGH_WITHIN *
                       (fabs(ritz_sparse_diagonal(&full->D, j)) +
                        fabs(ab[0] * ritz_sparse_diagonal(&full->M, j)) +
                        fabs(ab[1] * ritz_sparse_diagonal(&full->K, j))));
    *out = true;
    for (int64_t j = 0; j < rest->ncol; j++)
        for (int64_t p = rest->colptr[j]; p < rest->colptr[j + 1]; p++)
            *out =
                *out && fabs(rest->val[p]) <= size[rest->rowind[p]] * size[j];
    return RITZ_OK;
}

ritz_status ritz_estimator_rayleigh(const ritz_component *full, double *a,
                                    double *b, bool *found)
{
    RITZ_OWN(ritz_sparse) rest = {0};
    double ab[2] = {0.0, 0.0};
    double most = 0.0;

    *found = false;
    if (!full->D.colptr || full->K4.colptr)
        return RITZ_OK;
    most = RITZ_RAYLEIGH_WITHIN * ritz_sparse_max(&full->D);
    RITZ_CHECK(ritz_sparse_copy(&full->D, &rest));
    for (int pass = 0; pass < PASSES; pass++) {
        RITZ_OWN(ritz_sparse) part = {0};
        ritz_component left = *full; /* borrowed */
        double more[2] = {0.0, 0.0}, size = 0.0;

        left.D = rest;
        RITZ_CHECK(ritz_proportional(&left, &more[0], &more[1], &size));
        ab[0] += more[0];
        ab[1] += more[1];
        RITZ_CHECK(ritz_sparse_add(1.0, &full->D, -ab[0], &full->M, &part));
        ritz_sparse_free(&rest);
        RITZ_CHECK(ritz_sparse_add(1.0, &part, -ab[1], &full->K, &rest));
    }
    RITZ_CHECK(is_negligible(full, ab, &rest, found));
    *found = *found && ab[0] * ritz_sparse_max(&full->M) >= -most &&
             ab[1] * ritz_sparse_max(&full->K) >= -most;
    *a = fmax(ab[0], 0.0);
    *b = fmax(ab[1], 0.0);
    return RITZ_OK;
}

/* Modal damping where no ratio is common to all modes. */

/* Diagonal of X'A X; unchanged if there is no A. */
static ritz_status project_diagonal(const ritz_sparse *D, const ritz_dense *X,
                                    double *out)
{
    RITZ_OWN(ritz_dense) DX = {0};

    if (!D->colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(D, X, &DX));
    for (int64_t j = 0; j < X->ncol; j++)
        out[j] = ritz_dense_dot(X, j, &DX, j);
    return RITZ_OK;
}

/*
 * Whether rounding of a mode's stiffness hides w d, in z = theta - w^2 + i w d:
 * what D leaves of a mode that it does not damp is no damping.
 */
static bool is_lost(const ritz_lehmann *trial, int64_t j, double damping)
{
    return fabs(damping) <= trial->rounding[j] + trial->reduced_rounding[j];
}

ritz_status ritz_bounder_take_rates(const ritz_estimator *estimator,
                                    ritz_bounder *r, double *matrices)
{
    double *rates = r->rates;
    const ritz_damping *damping = &estimator->request.damping;
    RITZ_OWN_ARRAY double *hysteretic = NULL;

    RITZ_CHECK_NEW(hysteretic, r->trial->count);
    RITZ_CHECK(project_diagonal(&estimator->component->D, &r->trial->X, rates));
    RITZ_CHECK(
        project_diagonal(&estimator->component->K4, &r->trial->X, hysteretic));
    r->zeta = 1.0;
    for (int64_t j = r->num_rigid; j < r->trial->count; j++) {
        double w = sqrt(fmax(r->trial->theta[j], DBL_MIN));

        matrices[j] = rates[j] + hysteretic[j] / w;
        rates[j] = matrices[j] + ritz_modal_rate(damping, j - r->num_rigid,
                                                 r->trial->theta[j]);
        if (is_lost(r->trial, j, rates[j] * w))
            rates[j] = 0.0; /* see has_undamped */
        else
            r->zeta = fmin(r->zeta, fmax(0.5 * rates[j] / w, 0.0));
    }
    r->matrix_rates = matrices;
    r->coupled =
        estimator->component->D.colptr || estimator->component->K4.colptr;
    r->rayleigh = false;
    return RITZ_OK;
}

/*
 * Whether ratios that are stated mode by mode differ within a pair of equal
 * frequencies. Any combination of the two modes is a mode too, so that the full
 * and the reduced model may damp different ones.
 */
static bool is_at_odds(const ritz_bounder *r)
{
    for (int64_t j = r->num_rigid; j + 1 < r->trial->count; j++) {
        double low = r->trial->theta[j];
        double high = r->trial->theta[j + 1];
        double zeta = r->rates[j] / sqrt(fmax(low, DBL_MIN));
        double next = r->rates[j + 1] / sqrt(fmax(high, DBL_MIN));

        if (!r->coupled && high - low <= RITZ_CLOSE * high &&
            fabs(zeta - next) > RITZ_CLOSE * next)
            return true;
    }
    return false;
}

/* Largest participation of mode j in some channels, over sqrt(theta_j -
   sigma). */
static double participation_of(const ritz_bounder *r, int which, int64_t j)
{
    return ritz_dense_col_max(&r->channel[which], j) /
           sqrt(r->trial->theta[j] - r->trial->sigma);
}

/* Whether that is not negligible relative to those of other modes. */
static bool takes_part(const ritz_bounder *r, int which, int64_t j)
{
    double most = 0.0;

    for (int64_t k = 0; k < r->trial->count; k++)
        most = fmax(most, participation_of(r, which, k));
    return participation_of(r, which, j) > RITZ_NO_PART * most;
}

/* Whether a controllable and observable mode of the band has no damping. */
static bool has_undamped(const ritz_bounder *r, const double band_hz[2])
{
    for (int64_t j = r->num_rigid; j < r->trial->count; j++) {
        double hertz = ritz_eigen_hertz(r->trial->theta[j]);

        if (r->rates[j] == 0.0 && hertz >= band_hz[0] && hertz <= band_hz[1] &&
            takes_part(r, 0, j) &&
            (takes_part(r, 1, j) || takes_part(r, 2, j) || takes_part(r, 3, j)))
            return true;
    }
    return false;
}

const char *ritz_bounder_unknown(const ritz_measuring *m, const ritz_bounder *r)
{
    if (r->coupled && ritz_missing_modes(m) != 0)
        return "damping of missing modes is not known";
    if (is_at_odds(r))
        return "ratios differ within a pair of equal modes";
    return has_undamped(r, m->band_hz) ? "a mode of the band is not damped"
                                       : NULL;
}
