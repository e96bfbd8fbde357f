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

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

ritz_status ritz_probe_judge(const ritz_dense *A, ritz_probe *out)
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
    RITZ_CHECK(ritz_probe_judge(&A, &probe));
    *out = probe;
    return RITZ_OK;
}

/* Least and largest eigenvalue of a symmetric A. */
static ritz_status find_extremes(const ritz_dense *A, double *least,
                                 double *most)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) copy = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;

    RITZ_CHECK_NEW(lambda, n + 1);
    RITZ_CHECK(ritz_dense_copy(A, &copy));
    if (n > 0)
        RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, copy.val, n,
                                     lambda) != 0,
                       RITZ_ERR_CONVERGENCE,
                       "eigenvalues of the mass matrix were not found");
    *least = lambda[0];
    *most = n > 0 ? lambda[n - 1] : 0.0;
    return RITZ_OK;
}

/* M scaled to a unit diagonal, as it mixes kg with kg m^2. */
static ritz_status probe_mass(const ritz_dense *M, ritz_probe *out)
{
    RITZ_OWN(ritz_dense) scaled = {0};
    double least = 0.0, most = 0.0;
    int64_t n = M->nrow;

    RITZ_CHECK(ritz_dense_copy(M, &scaled));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) {
            double size = sqrt(fabs(ritz_dense_col(M, i)[i]) *
                               fabs(ritz_dense_col(M, j)[j]));

            if (size > 0.0)
                ritz_dense_col(&scaled, j)[i] /= size;
        }
    RITZ_CHECK(find_extremes(&scaled, &least, &most));
    if (least <
        -RITZ_POLE_BOUND_FACTOR * (double)n * DBL_EPSILON * fabs(most)) {
        out->verdict = RITZ_UNSTABLE;
        snprintf(out->why, sizeof out->why,
                 "mass with a negative eigenvalue, %.2g of the largest",
                 least / fabs(most));
    }
    return RITZ_OK;
}

static ritz_status probe_modes(const ritz_structure *model,
                               const ritz_damping *damping, ritz_probe *out)
{
    ritz_status status = RITZ_OK;
    ritz_modal_model modes = {0};
    ritz_io none = {0};
    ritz_dense A = {0};
    int64_t r = 0;

    RITZ_TRY(ritz_io_new(model->K.nrow, 0, 0, &none));
    status = ritz_modal_model_new(model, &none, damping, &modes);
    if (status == RITZ_ERR_SINGULAR) {
        out->verdict = RITZ_UNSTABLE;
        snprintf(out->why, sizeof out->why,
                 "mass and stiffness that are singular together");
        status = RITZ_OK;
        goto done;
    }
    RITZ_TRY(status);
    RITZ_TRY(
        ritz_modal_states(&modes, &(ritz_modal_layout){0}, &A, NULL, NULL));
    RITZ_TRY(ritz_probe_judge(&A, out));
    r = modes.num_rigid;
    if (r < modes.count && modes.lambda[r] < 0.0) {
        out->verdict = RITZ_UNSTABLE;
        snprintf(out->why, sizeof out->why,
                 "stiffness with a negative eigenvalue, %.4g rad^2/s^2",
                 modes.lambda[r]);
    }
done:
    ritz_modal_model_free(&modes);
    ritz_io_free(&none);
    ritz_dense_free(&A);
    return status;
}

ritz_status ritz_probe_second_order(const ritz_dense *K, const ritz_dense *M,
                                    const ritz_dense *D,
                                    const ritz_damping *damping,
                                    ritz_probe *out)
{
    static const ritz_damping no_damping = {0};
    const ritz_structure model = {*K, *M, *D};
    ritz_probe probe = {0};

    RITZ_CHECK(probe_mass(M, &probe));
    if (probe.verdict != RITZ_UNSTABLE)
        RITZ_CHECK(
            probe_modes(&model, damping ? damping : &no_damping, &probe));
    *out = probe;
    return RITZ_OK;
}

ritz_status ritz_check_poles(ritz_checker *it)
{
    ritz_probe probe = {0};
    RITZ_OWN(ritz_dense) A = {0};
    char text[2 * RITZ_NAME_SIZE];
    double growth = 0.0;

    if (it->reduced) {
        /* rigid positions are left out: their double pole is defective */
        RITZ_CHECK(ritz_probe_energy_matrix(&it->modes, &A));
        RITZ_CHECK(ritz_probe_judge(&A, &probe));
    } else {
        RITZ_CHECK(ritz_probe_states(it->space, &probe));
    }
    growth = probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0;
    it->stable = probe.verdict != RITZ_UNSTABLE;
    ritz_probe_print(&probe, text);
    if (!it->stable)
        ritz_checker_say(it, "poles", growth, probe.tolerance, RITZ_FAIL, "",
                         "%s", text);
    else
        ritz_checker_say(it, "poles", growth, probe.tolerance, RITZ_PASS, text,
                         "%s",
                         probe.verdict == RITZ_STABLE
                             ? "all are left of the axis"
                             : "on the axis: rigid motion, or no damping");
    return RITZ_OK;
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
    double growth = probe->radius > 0.0 ? probe->pole[0] / probe->radius : 0.0;

    ritz_probe_print(probe, text);
    snprintf(where, sizeof where, "%s, %.50s",
             ritz_stability_name(probe->verdict), text);
    return ritz_measures_add(estimates, "growth-relative", growth,
                             probe->tolerance, where);
}
