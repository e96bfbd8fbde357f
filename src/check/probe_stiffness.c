/*
 * Stiffness, by the modes of (K, M), which other checks use too. A rigid motion
 * phi has none: phi'K phi beyond rounding is that of matrices of too few digits,
 * which hold a free body or drive it.
 */
#include "check/probe_parts.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Of the softest flexible eigenvalue: a rigid motion that is held or driven by
   more is wrong, as of an audited component; by less than the second it has not
   moved a radius in 1e6 of that mode's radians. */
static const double driven = 1e-8;
static const double unnoticed = 1e-12;

/* Modes are found here: that they are there is part of the answer. */
static ritz_status find_modes(ritz_prober *it, bool *singular)
{
    ritz_status status = RITZ_OK;
    ritz_io none = {0};

    RITZ_TRY(ritz_io_new(it->model.K.nrow, 0, 0, &none));
    status = ritz_first_order_new(&it->model, &none, &it->damping, &it->modes);
    *singular = status == RITZ_ERR_SINGULAR;
    if (*singular)
        status = RITZ_OK;
done:
    ritz_io_free(&none);
    return status;
}

/* phi'K phi of rigid motions, 0 where it is rounding: the largest magnitude. */
static ritz_status rigid_stiffness(const ritz_prober *it, double *out,
                                   int64_t *at)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *K = &it->model.K;
    ritz_dense Phi = ritz_dense_part(&it->modes.Phi, 0, it->modes.num_rigid);
    ritz_dense own = {0}, most = {0};

    *out = 0.0;
    *at = 0;
    RITZ_TRY(ritz_dense_congruence(K, &Phi, &own));
    RITZ_TRY(ritz_dense_terms(K, &Phi, &most));
    for (int64_t k = 0; k < Phi.ncol; k++) {
        double value = ritz_dense_col(&own, k)[k];

        if (fabs(value) > 64.0 * DBL_EPSILON * ritz_dense_col(&most, k)[k] &&
            fabs(value) > fabs(*out)) {
            *out = value;
            *at = k;
        }
    }
done:
    ritz_dense_free(&own);
    ritz_dense_free(&most);
    return status;
}

/* Matrices of few digits: a rigid motion is held, or driven. */
static ritz_status say_rigid(ritz_prober *it, bool *said)
{
    const ritz_first_order *modes = &it->modes;
    int64_t r = modes->num_rigid;
    double softest = r < modes->count ? modes->lambda[r] : HUGE_VAL;
    double value = 0.0;
    int64_t at = 0;
    char where[RITZ_WHERE_SIZE] = "";

    RITZ_CHECK(rigid_stiffness(it, &value, &at));
    *said = value < -unnoticed * softest || value > driven * softest;
    if (!*said)
        return RITZ_OK;
    it->definite = value > 0.0;
    ritz_prober_where(it, ritz_dense_col(&modes->Phi, at), where);
    ritz_prober_say(
        it, "stiffness-definite", value / softest, -driven,
        value < -driven * softest ? RITZ_FAIL : RITZ_WARN, where,
        "%s stiffness of a rigid motion, %.2g of the softest flexible one: too "
        "few digits, a free body is not free",
        value < 0.0 ? "negative" : "positive", value / softest);
    return RITZ_OK;
}

static ritz_status say_stiffness(ritz_prober *it)
{
    static const char name[] = "stiffness-definite";
    const ritz_first_order *modes = &it->modes;
    int64_t massless = modes->num_dofs - modes->count;
    int64_t r = modes->num_rigid;
    double least = r < modes->count ? modes->lambda[r] : 0.0;
    double most = modes->count > 0 ? modes->lambda[modes->count - 1] : 0.0;
    char where[RITZ_WHERE_SIZE] = "";
    bool said = false;

    most = fmax(most, -least);
    it->usable = least >= 0.0;
    it->definite = it->definite && it->usable;
    if (least < 0.0) {
        ritz_prober_where(it, ritz_dense_col(&modes->Phi, r), where);
        ritz_prober_say(it, name, least / most, 0.0, RITZ_FAIL, where,
                        "stiffness with a negative eigenvalue, %.4g "
                        "rad^2/s^2",
                        least);
        return RITZ_OK;
    }
    RITZ_CHECK(say_rigid(it, &said));
    if (said)
        return RITZ_OK;
    snprintf(where, sizeof where, "%" PRId64 " rigid", r);
    if (massless > 0)
        ritz_prober_say(it, name, most > 0.0 ? least / most : 0.0, 0.0,
                        RITZ_PASS, where,
                        "no negative eigenvalue; %" PRId64 " of %" PRId64
                        " motions have no mass, which no explicit integrator "
                        "takes",
                        massless, modes->num_dofs);
    else
        ritz_prober_say(it, name, most > 0.0 ? least / most : 0.0, 0.0,
                        RITZ_PASS, where,
                        "no negative eigenvalue beyond rigid motion");
    return RITZ_OK;
}

ritz_status ritz_probe_definite_stiffness(ritz_prober *it)
{
    bool singular = false;

    if (!it->usable)
        return RITZ_OK;
    RITZ_CHECK(find_modes(it, &singular));
    if (singular) {
        it->usable = it->definite = false;
        ritz_prober_say(it, "stiffness-definite", nan(""), 0.0, RITZ_FAIL, "",
                        "mass and stiffness that are singular together");
    } else {
        RITZ_CHECK(say_stiffness(it));
    }
    return RITZ_OK;
}
