/*
 * Poles of a small model. Of M x'' + D x' + K x = 0 they are those of
 *
 *     [0 I; -Lambda -Delta],   Delta = Phi'D Phi + diag(2 zeta w)
 *
 * in its modes, once M and K are known to be no worse than semidefinite: a
 * negative eigenvalue of either is itself the verdict.
 */
#include <ritz/check.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/eigenvalues.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

ritz_status ritz_probe_matrix(const ritz_dense *A, ritz_probe *out)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    int64_t k = -1;
    double error = 0.0;

    RITZ_CHECK(ritz_eigenvalues_of(A, &poles));
    out->count = poles.count;
    out->radius = poles.radius;
    out->verdict = RITZ_STABLE;
    k = ritz_eigenvalues_worst(&poles, RITZ_POLE_BOUND_FACTOR);
    if (k < 0)
        return RITZ_OK;
    error = RITZ_POLE_BOUND_FACTOR * poles.error[k];
    out->pole[0] = poles.re[k] + 0.0; /* -0 reads as if it decayed */
    out->pole[1] = fabs(poles.im[k]);
    out->tolerance = poles.radius > 0.0 ? error / poles.radius : 0.0;
    if (poles.re[k] >= -error)
        out->verdict = RITZ_MARGINAL;
    if (poles.re[k] > error)
        out->verdict = RITZ_UNSTABLE;
    return RITZ_OK;
}

ritz_status ritz_probe_states(const ritz_state_space *model, ritz_probe *out)
{
    ritz_probe probe = {0};
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_dense_copy(&model->A, &A));
    if (model->E.val)
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &A));
    RITZ_CHECK(ritz_probe_matrix(&A, &probe));
    *out = probe;
    return RITZ_OK;
}

static ritz_status probe_modes(const ritz_modal_model *modes, ritz_probe *out)
{
    const ritz_modal_layout layout = {0};
    RITZ_OWN(ritz_dense) A = {0};
    int64_t r = modes->num_rigid;

    RITZ_CHECK(ritz_modal_states(modes, &layout, &A, NULL, NULL));
    RITZ_CHECK(ritz_probe_matrix(&A, out));
    if (r < modes->count && modes->lambda[r] < 0.0) {
        out->verdict = RITZ_UNSTABLE;
        snprintf(out->why, sizeof out->why,
                 "stiffness with a negative eigenvalue, %.4g rad^2/s^2",
                 modes->lambda[r]);
    }
    return RITZ_OK;
}

ritz_status ritz_probe_second_order(const ritz_dense *K, const ritz_dense *M,
                                    const ritz_dense *D,
                                    const ritz_damping *damping,
                                    ritz_probe *out)
{
    static const ritz_damping no_damping = {0};
    const ritz_structure model = {*K, *M, *D};
    RITZ_OWN(ritz_least_value) mass = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};
    ritz_probe probe = {.verdict = RITZ_UNSTABLE};
    bool singular = false;

    RITZ_CHECK(ritz_least_value_new(M, M, &mass));
    if (mass.value >= ritz_least_rounding(M))
        RITZ_CHECK(ritz_check_modes(&model, damping ? damping : &no_damping,
                                    &modes, &singular));
    if (mass.value < ritz_least_rounding(M))
        snprintf(probe.why, sizeof probe.why,
                 "mass with a negative eigenvalue, %.2g of the largest",
                 mass.value);
    else if (singular)
        snprintf(probe.why, sizeof probe.why,
                 "mass and stiffness that are singular together");
    else
        RITZ_CHECK(probe_modes(&modes, &probe));
    *out = probe;
    return RITZ_OK;
}

/*
 * Rigid positions of a reduced model are left out of its states [w q; q']:
 * their double pole is defective.
 */
ritz_status ritz_check_poles(ritz_checker *it)
{
    const ritz_modal_layout layout = {.position = it->modes.num_rigid};
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];

    if (it->reduced)
        RITZ_CHECK(
            ritz_modal_states(&it->modes, &layout, &it->pairs.A, NULL, NULL));
    RITZ_CHECK(ritz_probe_matrix(&it->pairs.A, &probe));
    it->stable = probe.verdict != RITZ_UNSTABLE;
    ritz_probe_print(&probe, text);
    ritz_checker_say(it, "poles", ritz_probe_growth(&probe), probe.tolerance,
                     it->stable ? RITZ_PASS : RITZ_FAIL, it->stable ? text : "",
                     "%s",
                     !it->stable ? text
                     : probe.verdict == RITZ_STABLE
                         ? "all are left of the axis"
                         : "on the axis: rigid motion, or no damping");
    return RITZ_OK;
}

double ritz_probe_growth(const ritz_probe *probe)
{
    return probe->radius > 0.0 ? probe->pole[0] / probe->radius : 0.0;
}

const char *ritz_stability_name(ritz_stability verdict)
{
    static const char *const names[] = {
        [RITZ_STABLE] = "stable",
        [RITZ_MARGINAL] = "marginal",
        [RITZ_UNSTABLE] = "unstable",
    };

    return names[verdict];
}

void ritz_probe_print(const ritz_probe *probe, char out[2 * RITZ_NAME_SIZE])
{
    char beside[RITZ_NAME_SIZE] = "";

    if (probe->why[0] || probe->count == 0) {
        snprintf(out, (size_t)2 * RITZ_NAME_SIZE, "%s",
                 probe->why[0] ? probe->why : "no poles");
        return;
    }
    if (probe->pole[1] > 0.0)
        snprintf(beside, sizeof beside, " +- %.5gi", probe->pole[1]);
    snprintf(out, (size_t)2 * RITZ_NAME_SIZE, "pole at %+.5g%s rad/s (%.5g Hz)",
             probe->pole[0], beside,
             hypot(probe->pole[0], probe->pole[1]) / (2.0 * RITZ_PI));
}

ritz_status ritz_probe_record(const ritz_probe *probe, ritz_measures *estimates)
{
    char text[2 * RITZ_NAME_SIZE] = "";
    char where[RITZ_NAME_SIZE] = "";

    ritz_probe_print(probe, text);
    snprintf(where, sizeof where, "%s, %.50s",
             ritz_stability_name(probe->verdict), text);
    return ritz_measures_add(estimates, "growth-relative",
                             ritz_probe_growth(probe), probe->tolerance, where);
}
