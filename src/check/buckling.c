/*
 * Buckling factors mu of K phi = -mu KG phi, K positive definite and KG of any
 * sign. With theta = -1 / mu
 *
 *     KG phi = theta K phi,
 *
 * and the factors nearest to 0 of both signs are at the ends of the spectrum,
 * where ARPACK finds them with a factor of K. An end that is far smaller than
 * the other does not converge: with a factor of K + s KG, which is definite as
 * long as s is between the factors of both signs, theta = -1 / (mu - s), so that
 * the first factor beyond s is far from the others.
 *
 * By Sylvester's law of inertia K + s KG has as many negative eigenvalues as
 * there are factors between 0 and s. Counts prove that no factor is missing, and
 * say how far s may go. [GrimesLewisSimon1994] [LehoucqSorensenYang1998]
 */
#include "check/buckling.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/arpack.h"
#include "linear/general.h"
#include "linear/inertia.h"
#include "linear/trial.h"

#include <math.h>
#include <stdlib.h>

enum {
    FARTHER = 4 /* each step of the search for a count above 0 is so far */
};

ritz_status ritz_buckling_held_dense(const ritz_dense *K, const ritz_dense *M,
                                     bool *held)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    *held = K->nrow > 0;
    if (!*held)
        return RITZ_OK;
    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    *held =
        pairs.num_rigid == 0 && (pairs.Phi.ncol == 0 || pairs.lambda[0] > 0.0);
    return RITZ_OK;
}

ritz_status ritz_buckling_held(const ritz_sparse *K, const ritz_sparse *M,
                               bool *held)
{
    const ritz_span span = {.modes = 1, .uncounted = true};
    RITZ_OWN(ritz_pairs) pairs = {0};

    *held = K->nrow > 0 && K->colptr[K->ncol] > 0;
    if (!*held)
        return RITZ_OK;
    RITZ_CHECK(ritz_eigen_sparse(K, M, &span, &pairs));
    *held =
        pairs.num_rigid == 0 && (pairs.Phi.ncol == 0 || pairs.lambda[0] > 0.0);
    return RITZ_OK;
}

/* What thetas at both ends of the spectrum say. */
static ritz_buckling from_ends(double lowest, double highest)
{
    const double least =
        fmax(fabs(lowest), fabs(highest)) / RITZ_BUCKLING_REACH;
    ritz_buckling b = {nan(""), nan("")};

    if (lowest < 0.0 && -lowest >= least)
        b.factor = -1.0 / lowest;
    if (highest > 0.0 && highest >= least)
        b.reversed = -1.0 / highest;
    return b;
}

ritz_status ritz_buckling_dense(const ritz_dense *K, const ritz_dense *KG,
                                ritz_buckling *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t last = 0;

    *out = (ritz_buckling){nan(""), nan("")};
    if (ritz_dense_max(KG) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_eigen_unchecked(KG, K, &pairs));
    last = pairs.Phi.ncol - 1;
    if (last >= 0)
        *out = from_ends(pairs.lambda[0], pairs.lambda[last]);
    return RITZ_OK;
}

/* ---- sparse ------------------------------------------------------------- */

/* A load and the direction, +1 or -1, in which its factor is searched. */
typedef struct directed {
    const ritz_sparse *K, *KG;
    double sign;
} directed;

/* How many factors are between 0 and s. */
static ritz_status count_factors(const directed *to, double s, int64_t *out)
{
    RITZ_OWN(ritz_sparse) A = {0};

    RITZ_CHECK(ritz_sparse_add(1.0, to->K, to->sign * s, to->KG, &A));
    return ritz_inertia_negative(&A, NULL, out);
}

/* Check that no factor is closer to 0 than @p s. */
static ritz_status prove_none(const directed *to, double s)
{
    int64_t count = 0;

    RITZ_CHECK(count_factors(to, s * (1.0 - RITZ_BUCKLING_BELOW), &count));
    RITZ_REFUSE_IF(count > 0, RITZ_ERR_CONVERGENCE,
                   "a buckling factor below %g was missed", s);
    return RITZ_OK;
}

/* Find the factor closest to @p s, where K + s KG is definite. */
static ritz_status find_beyond(const directed *to, double s, double *mu)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    double theta = 0.0;

    RITZ_CHECK(ritz_sparse_add(1.0, to->K, to->sign * s, to->KG, &A));
    RITZ_CHECK(ritz_factor_spd(&A, &F));
    RITZ_CHECK(ritz_lanczos_end_of(
        &(ritz_ended){to->KG, &A, F},
        to->sign > 0.0 ? RITZ_END_LOWEST : RITZ_END_HIGHEST, &theta));
    *mu = to->sign * s - 1.0 / theta;
    return RITZ_OK;
}

/*
 * The factor nearest to 0 between @p from, below which there is none, and
 * RITZ_BUCKLING_REACH times as much; NaN if there is none.
 */
static ritz_status search_factor(const directed *to, double from, double *mu)
{
    const double end = from * RITZ_BUCKLING_REACH;
    int64_t count = 0;

    *mu = nan("");
    RITZ_CHECK(count_factors(to, end, &count));
    if (count == 0)
        return RITZ_OK;
    RITZ_CHECK(prove_none(to, from));
    from *= 1.0 - RITZ_BUCKLING_BELOW;
    for (count = 0; from * FARTHER < end;) {
        RITZ_CHECK(count_factors(to, from * FARTHER, &count));
        if (count > 0)
            break;
        from *= FARTHER;
    }
    return find_beyond(to, from, mu);
}

/*
 * The factor of one direction, or NaN.
 *
 * @param[in] theta  the end of the spectrum there, or NaN
 * @param[in] scale  the smallest |mu| found
 */
static ritz_status find_factor(const directed *to, double theta, double scale,
                               double *mu)
{
    if (!(-to->sign * theta * scale * RITZ_BUCKLING_REACH >= 1.0))
        return search_factor(to, scale, mu);
    *mu = -1.0 / theta;
    return prove_none(to, fabs(*mu));
}

static ritz_status solve_small(const ritz_sparse *K, const ritz_sparse *KG,
                               ritz_buckling *out)
{
    RITZ_OWN(ritz_dense) dense_K = {0}, dense_KG = {0};

    RITZ_CHECK(ritz_sparse_dense(K, &dense_K));
    RITZ_CHECK(ritz_sparse_dense(KG, &dense_KG));
    return ritz_buckling_dense(&dense_K, &dense_KG, out);
}

ritz_status ritz_buckling_sparse(const ritz_sparse *K, const ritz_sparse *KG,
                                 ritz_buckling *out)
{
    return K->nrow <= ritz_trial_here()->small
               ? solve_small(K, KG, out)
               : ritz_buckling_iterated(K, KG, out);
}

ritz_status ritz_buckling_iterated(const ritz_sparse *K, const ritz_sparse *KG,
                                   ritz_buckling *out)
{
    const directed push = {K, KG, 1.0}, pull = {K, KG, -1.0};
    RITZ_OWN(ritz_factor) *F = NULL;
    double theta[2] = {0.0, 0.0}, scale = 0.0;

    *out = (ritz_buckling){nan(""), nan("")};
    RITZ_CHECK(ritz_factor_spd(K, &F));
    RITZ_CHECK(ritz_lanczos_ends(&(ritz_ended){KG, K, F}, theta));
    ritz_factor_free(&F);
    scale = 1.0 / fmax(fabs(theta[0]), fabs(theta[1])); /* of NaN, the other */
    if (isinf(scale))
        return RITZ_OK;
    RITZ_CHECK(find_factor(&push, theta[0], scale, &out->factor));
    return find_factor(&pull, theta[1], scale, &out->reversed);
}

/* ---- models ------------------------------------------------------------- */

ritz_status ritz_buckling_of_reduced(const ritz_reduced *reduced,
                                     ritz_buckling **out)
{
    RITZ_OWN_ARRAY ritz_buckling *found = NULL;
    bool held = false;

    *out = NULL;
    if (reduced->num_loads == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_buckling_held_dense(&reduced->K, &reduced->M, &held));
    if (!held)
        return RITZ_OK;
    RITZ_CHECK_NEW(found, reduced->num_loads);
    for (int64_t k = 0; k < reduced->num_loads; k++)
        RITZ_CHECK_IN(
            reduced->load[k].name,
            ritz_buckling_dense(&reduced->K, &reduced->load[k].KG, &found[k]));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

ritz_status ritz_buckling_of_component(const ritz_component *component,
                                       ritz_buckling **out)
{
    RITZ_OWN_ARRAY ritz_buckling *found = NULL;
    bool held = false;

    *out = NULL;
    if (component->num_loads == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_buckling_held(&component->K, &component->M, &held));
    if (!held)
        return RITZ_OK;
    RITZ_CHECK_NEW(found, component->num_loads);
    for (int64_t k = 0; k < component->num_loads; k++)
        RITZ_CHECK_IN(component->load[k].name,
                      ritz_buckling_sparse(&component->K,
                                           &component->load[k].KG, &found[k]));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}
