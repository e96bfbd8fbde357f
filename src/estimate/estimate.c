/*
 * How far a reduced model can be off, told by one factor of the full matrices,
 * by what they leave of its modes, and by how many modes lie below some
 * frequencies. See estimate_enclose.c.
 */
#include "base/alloc.h"
#include "estimate/estimate_parts.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* sigma, of the band: smaller is tighter at its end, larger rounds less. */
static const double shift = 0.1;
/* Trial modes so far beyond the band, in lambda, and as many beyond. */
static const double beyond = 30.0;
enum { MORE = 10 };

ritz_status ritz_estimator_new(const ritz_component *full,
                               const ritz_estimate_request *request,
                               ritz_estimator **out)
{
    const double *band = request->band_hz;
    ritz_estimator *made = NULL;

    RITZ_REFUSE_IF(!(band[0] >= 0.0) || !isfinite(band[1]) ||
                       (band[1] != 0.0 && band[0] >= band[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   band[0], band[1]);
    RITZ_CHECK_NEW(made, 1);
    made->component = full;
    made->request = *request;
    *out = made;
    return RITZ_OK;
}

void ritz_estimator_free(ritz_estimator **estimator)
{
    if (!*estimator)
        return;
    ritz_factor_free(&(*estimator)->A);
    free(*estimator);
    *estimator = NULL;
}

/* Half of the highest frequency that the basis knows of. */
static double trusted_hertz(const ritz_basis *basis, const ritz_pairs *pairs)
{
    double highest = 0.0;

    for (int64_t k = 0; k < basis->columns.count; k++)
        if (isfinite(basis->columns.hertz[k]))
            highest = fmax(highest, basis->columns.hertz[k]);
    if (highest == 0.0 && pairs->Phi.ncol > 0)
        highest = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
    return 0.5 * highest;
}

/* Flexible modes in the band, without one asked at least one if any. */
static void choose_modes(const ritz_estimator *estimator,
                         const ritz_basis *basis, ritz_measuring *m)
{
    const ritz_pairs *pairs = &m->pairs;
    const double *asked = estimator->request.band_hz;

    m->band_hz[0] = asked[0];
    m->band_hz[1] = asked[1] > 0.0 ? asked[1] : trusted_hertz(basis, pairs);
    m->first = pairs->num_rigid;
    while (m->first < pairs->Phi.ncol &&
           ritz_eigen_hertz(pairs->lambda[m->first]) < m->band_hz[0])
        m->first++;
    m->last = m->first;
    while (m->last < pairs->Phi.ncol &&
           ritz_eigen_hertz(pairs->lambda[m->last]) <= m->band_hz[1])
        m->last++;
    if (asked[1] == 0.0 && m->last == m->first && m->last < pairs->Phi.ncol) {
        m->last++;
        m->band_hz[1] = ritz_eigen_hertz(pairs->lambda[m->first]);
    }
}

/* Trial modes that serve those of the band. */
static int64_t count_trial(const ritz_measuring *m, bool response)
{
    double reach = beyond * ritz_eigen_lambda(m->band_hz[1]);
    int64_t most = m->pairs.Phi.ncol;
    int64_t count = m->last + MORE < most ? m->last + MORE : most;

    while (count < most && (response || m->pairs.lambda[count] < reach))
        count++;
    return count;
}

static void measuring_free(ritz_measuring *m)
{
    ritz_pairs_free(&m->pairs);
    ritz_lehmann_free(&m->trial);
    ritz_lehmann_free(&m->polished);
    ritz_enclosure_free(&m->enclosure);
}

/* The reduced modes in the band, and the trial that serves them. */
static ritz_status begin(ritz_estimator *estimator, const ritz_basis *basis,
                         const ritz_reduced *reduced, bool *response,
                         ritz_measuring *m)
{
    RITZ_REFUSE_IF(basis->T.nrow != estimator->component->num_dofs ||
                       basis->T.ncol != reduced->K.nrow,
                   RITZ_ERR_ARGUMENT, "the basis is not that of the reduction");
    RITZ_CHECK(ritz_eigen_dense(&reduced->K, &reduced->M, &m->pairs));
    m->T = &basis->T;
    choose_modes(estimator, basis, m);
    *response = *response &&
                ritz_response_boundable(estimator, reduced, m->pairs.Phi.ncol);
    if (!(m->band_hz[1] > 0.0))
        return RITZ_OK;
    RITZ_CHECK(ritz_estimator_open(estimator,
                                   -shift * ritz_eigen_lambda(m->band_hz[1])));
    RITZ_CHECK(ritz_lehmann_new(estimator, &basis->T, reduced, &m->pairs,
                                count_trial(m, *response), &m->trial));
    return ritz_skip_rounded(estimator, m);
}

ritz_status ritz_estimator_measure(ritz_estimator *estimator,
                                   const ritz_basis *basis,
                                   const ritz_reduced *reduced,
                                   ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_measuring m = {0};
    ritz_measures found = {0};
    bool response = true;

    RITZ_TRY(begin(estimator, basis, reduced, &response, &m));
    if (m.band_hz[1] > 0.0) {
        RITZ_TRY(ritz_measuring_refine(estimator, response, &m));
        RITZ_TRY(ritz_report_modes(estimator, &m, &found));
        RITZ_TRY(ritz_report_missing(&m, &found));
        if (response)
            RITZ_TRY(ritz_bound_response(estimator, &m, reduced, &found));
    }
    *out = found;
    found = (ritz_measures){0};
done:
    measuring_free(&m);
    ritz_measures_free(&found);
    return status;
}

ritz_status ritz_estimator_least(ritz_estimator *estimator,
                                 const ritz_basis *basis,
                                 const ritz_reduced *reduced,
                                 ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_measuring m = {0};
    ritz_estimator bare = {0}; /* the same, nothing being counted */
    bool response = false;

    RITZ_TRY(begin(estimator, basis, reduced, &response, &m));
    if (m.band_hz[1] > 0.0) {
        bare = *estimator;
        bare.num_counts = 0;
        RITZ_TRY(
            ritz_enclosure_new(&bare, &m.trial, &m.polished, &m.enclosure));
        RITZ_TRY(ritz_report_least(&bare, &m, out));
    }
done:
    measuring_free(&m);
    return status;
}

ritz_status ritz_estimate(const ritz_component *full, const ritz_basis *basis,
                          const ritz_estimate_request *request,
                          ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    ritz_estimator *estimator = NULL;
    ritz_measures found = {0};

    RITZ_TRY(ritz_estimator_new(full, request, &estimator));
    RITZ_TRY(ritz_estimator_measure(estimator, basis, reduced, &found));
    ritz_measures_free(&reduced->estimates);
    reduced->estimates = found;
    found = (ritz_measures){0};
done:
    ritz_estimator_free(&estimator);
    ritz_measures_free(&found);
    return status;
}
