/*
 * Damped modes of poles that D or K4 couples, from the modal matrices; and, as
 * modes that were left out change what a local damper does, made exact on the
 * full ones.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <complex.h>
#include <math.h>

/* The modal matrices as a model. */
static ritz_status fill_modal(const ritz_poles *poles, ritz_reduced *out)
{
    int64_t m = poles->count;

    RITZ_CHECK(ritz_dense_new(m, m, &out->K));
    RITZ_CHECK(ritz_dense_new(m, m, &out->M));
    RITZ_CHECK(ritz_dense_block(&poles->D, 0, m, 0, m, &out->D));
    if (poles->K4.val)
        RITZ_CHECK(ritz_dense_block(&poles->K4, 0, m, 0, m, &out->K4));
    for (int64_t k = 0; k < m; k++) {
        ritz_dense_col(&out->K, k)[k] = poles->lambda[k];
        ritz_dense_col(&out->M, k)[k] = 1.0;
    }
    return RITZ_OK;
}

/* How much of the shape of pole j is of mode k; 0 of what does not oscillate.*/
static double share_of(const ritz_spectrum *spectrum, int64_t k, int64_t j)
{
    if (!(cimag(spectrum->s[j]) > 0.0))
        return 0.0;
    return hypot(ritz_dense_col(&spectrum->re, j)[k],
                 ritz_dense_col(&spectrum->im, j)[k]);
}

/*
 * The pole that each flexible mode has become, -1 where it does not oscillate
 * any more. Each pole is of one mode: the largest part of its shape decides,
 * then the largest of what is left; else an overdamped mode would be given the
 * ratio of a neighbour.
 */
static ritz_status assign_poles(const ritz_poles *poles,
                                const ritz_spectrum *spectrum, int64_t *of)
{
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN(ritz_dense) share = {0};

    RITZ_CHECK_NEW(taken, spectrum->count);
    RITZ_CHECK(ritz_dense_new(poles->count, spectrum->count, &share));
    for (int64_t j = 0; j < spectrum->count; j++)
        for (int64_t k = 0; k < poles->count; k++)
            ritz_dense_col(&share, j)[k] = share_of(spectrum, k, j);
    for (int64_t k = 0; k < poles->count; k++)
        of[k] = -1;
    for (int64_t t = poles->num_rigid; t < poles->count; t++) {
        double best = 0.0;
        int64_t mode = -1, pole = -1;

        for (int64_t j = 0; j < spectrum->count; j++) {
            const double *part = ritz_dense_col(&share, j);

            for (int64_t k = poles->num_rigid; k < poles->count && !taken[j];
                 k++)
                if (part[k] > best && of[k] < 0) {
                    best = part[k];
                    mode = k;
                    pole = j;
                }
        }
        if (mode < 0)
            break;
        of[mode] = pole;
        taken[pole] = true;
    }
    return RITZ_OK;
}

/* Diagonal of Phi'D Phi; 0 without D. */
static ritz_status own_rates(const ritz_sparse *D, const ritz_dense *Phi,
                             double **out)
{
    RITZ_OWN(ritz_dense) DPhi = {0};
    RITZ_OWN_ARRAY double *own = NULL;

    RITZ_CHECK_NEW(own, Phi->ncol);
    if (D->colptr)
        RITZ_CHECK(ritz_sparse_mul(D, Phi, &DPhi));
    for (int64_t k = 0; DPhi.val && k < Phi->ncol; k++)
        for (int64_t i = 0; i < Phi->nrow; i++)
            own[k] += ritz_dense_col(Phi, k)[i] * ritz_dense_col(&DPhi, k)[i];
    RITZ_MOVE(*out, own);
    return RITZ_OK;
}

/* Modes in the band, on the full matrices, from where the modal ones put s. */
static ritz_status refine_band(const ritz_poles *poles,
                               const ritz_component *component,
                               const ritz_pairs *pairs, const double band_hz[2],
                               const int64_t *of, ritz_damped *damped)
{
    RITZ_OWN(ritz_zldl) *Z = NULL;
    RITZ_OWN_ARRAY double *own = NULL; /* of D alone: `rate` has others too */

    RITZ_CHECK(own_rates(&component->D, &pairs->Phi, &own));
    RITZ_CHECK(ritz_impedance_new(component, &Z));
    for (int64_t k = poles->num_rigid; k < poles->count; k++) {
        RITZ_OWN(ritz_dense) q = {0}, x = {0};
        double _Complex s = 0.0;
        double hertz = ritz_eigen_hertz(poles->lambda[k]);

        if (of[k] < 0 || hertz < band_hz[0] ||
            hertz > band_hz[1] * RITZ_RANGE_END)
            continue;
        s = damped->listing.s[of[k]];
        RITZ_CHECK(ritz_spectrum_shape(&damped->listing, of[k], &q));
        RITZ_CHECK(ritz_dense_mul(&pairs->Phi, &q, &x));
        RITZ_CHECK(ritz_refine(component, Z, &x, &s));
        damped->zeta[k] =
            ritz_spectrum_ratio(s) +
            (poles->rate[k] - own[k]) / (2.0 * sqrt(poles->lambda[k]));
        damped->s[k] = ritz_pole_of(cabs(s), damped->zeta[k]);
        ritz_monitor_step("damped modes", k + 1, poles->count);
    }
    return RITZ_OK;
}

static ritz_status take_coupled(const ritz_poles *poles,
                                const ritz_component *component,
                                const ritz_pairs *pairs,
                                const double band_hz[2], ritz_damped *damped)
{
    RITZ_OWN(ritz_reduced) m = {0};
    RITZ_OWN_ARRAY int64_t *of = NULL;

    RITZ_CHECK_NEW(of, poles->count);
    RITZ_CHECK(fill_modal(poles, &m));
    RITZ_CHECK(ritz_spectrum_of(ritz_model_of_reduced(&m, NULL), NULL,
                                &damped->listing));
    RITZ_CHECK(assign_poles(poles, &damped->listing, of));
    for (int64_t k = poles->num_rigid; k < poles->count; k++) {
        damped->s[k] =
            of[k] < 0 ? ritz_complex(nan(""), 0.0) : damped->listing.s[of[k]];
        damped->zeta[k] =
            of[k] < 0 ? nan("") : ritz_spectrum_ratio(damped->s[k]);
    }
    if (component && poles->count < component->num_dofs)
        RITZ_CHECK(refine_band(poles, component, pairs, band_hz, of, damped));
    return RITZ_OK;
}

ritz_status ritz_damped_new(const ritz_poles *poles,
                            const ritz_component *component,
                            const ritz_pairs *pairs, const double band_hz[2],
                            ritz_damped *out)
{
    RITZ_OWN(ritz_damped) damped = {0};
    RITZ_OWN_ARRAY double *omega = NULL;

    RITZ_CHECK(ritz_poles_ratios(poles, &omega, &damped.zeta));
    RITZ_CHECK_NEW(damped.s, poles->count);
    for (int64_t k = 0; k < poles->count; k++)
        damped.s[k] = omega[k] > 0.0 ? ritz_pole_of(omega[k], damped.zeta[k])
                                     : ritz_complex(nan(""), 0.0);
    if (poles->coupled && poles->D.val)
        RITZ_CHECK(take_coupled(poles, component, pairs, band_hz, &damped));
    RITZ_MOVE(*out, damped);
    return RITZ_OK;
}

double _Complex ritz_damped_nearest(const ritz_damped *damped, int64_t count,
                                    double _Complex s)
{
    if (damped->listing.count == 0)
        return ritz_nearest_pole(count, damped->s, true, s);
    return ritz_nearest_pole(damped->listing.count, damped->listing.s, true, s);
}

void ritz_damped_free(ritz_damped *damped)
{
    RITZ_FREE(damped->zeta, damped->s);
    ritz_spectrum_free(&damped->listing);
    *damped = (ritz_damped){0};
}
