/*
 * Poles of a small model. Of M x'' + D x' + K x = 0 they are those of
 *
 *     [0 I; -Lambda -Delta],   Delta = Phi'D Phi + diag(2 zeta w)
 *
 * in its modes, once M and K are known to be semidefinite: a model with a
 * negative eigenvalue of either is unstable.
 */
#include <ritz/check.h>

#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"
#include "linear/split.h"

#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
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
    out->pole[0] = poles.re[k] + 0.0; /* -0 would be printed as decay */
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

    if (ritz_state_space_is_sparse(model))
        return ritz_probe_sparse(model, out);
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
    if (it->space && ritz_state_space_is_sparse(it->space))
        RITZ_CHECK(ritz_probe_sparse(it->space, &probe));
    else
        RITZ_CHECK(ritz_probe_matrix(&it->pairs.A, &probe));
    it->stable = probe.verdict != RITZ_UNSTABLE;
    ritz_probe_print(&probe, text);
    ritz_checker_say(it, "poles", ritz_probe_growth(&probe), probe.tolerance,
                     it->stable ? RITZ_PASS : RITZ_FAIL, it->stable ? text : "",
                     "%s",
                     !it->stable ? text
                     : probe.verdict == RITZ_STABLE && probe.unseen > 0
                         ? "those looked at are left of the axis"
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
    char imaginary[20] = "", unseen[RITZ_NAME_SIZE] = "";

    if (probe->why[0] || probe->count == 0) {
        snprintf(out, (size_t)2 * RITZ_NAME_SIZE, "%s",
                 probe->why[0] ? probe->why : "no poles");
        return;
    }
    if (probe->pole[1] > 0.0)
        snprintf(imaginary, sizeof imaginary, " +- %.5gi", probe->pole[1]);
    if (probe->unseen > 0)
        snprintf(unseen, sizeof unseen,
                 ", rightmost of %" PRId64 " near 0; %" PRId64 " not looked at",
                 probe->count, probe->unseen);
    snprintf(out, (size_t)2 * RITZ_NAME_SIZE,
             "pole at %+.5g%.20s rad/s (%.5g Hz)%.50s", probe->pole[0],
             imaginary, hypot(probe->pole[0], probe->pole[1]) / (2.0 * RITZ_PI),
             unseen);
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

/*
 * How large a free motion becomes before it decays: the largest |e^(A t)|^2.
 *
 * In y = [w q; q'] of the modes |y|^2 is twice the energy, and
 *
 *     d/dt |y|^2 = y'(A + A')y = -2 q'' Delta q',
 *
 * so where D's symmetric part is semidefinite nothing grows. Otherwise e^(A t)
 * is computed at t = h 2^(i/4) by squaring, which gives a lower bound; and with
 * A V = V B, B of diagonal blocks [a b; -b a], a <= 0,
 *
 *     |e^(A t)| <= |V| |V^-1|
 *
 * gives an upper bound.
 */

/* The largest |e^(A t)|^2, t >= 0. */
typedef struct growth {
    double met, seconds; /* largest value found, and its time */
    double most;         /* upper bound; HUGE_VAL: none is known */
    bool followed;       /* false: too many states, `met` is 1 */
} growth;

enum {
    MOST_STATES = 400, /* of whose exponential powers are taken */
    FOURTHS = 4,       /* of an octave */
};

/* e^(A h), e^(2 A h), e^(4 A h), ... until nothing is left, or t = most. */
static ritz_status follow_powers(const ritz_dense *A, double h, double most,
                                 growth *out)
{
    RITZ_OWN(ritz_dense) E = {0}, next = {0};
    double size = 1.0;

    RITZ_CHECK(ritz_exponential(A, h, 0, NULL, &E, NULL));
    for (int k = 0; size > RITZ_DIED_OUT && h * ldexp(1.0, k) <= most; k++) {
        RITZ_CHECK(ritz_dense_copy(&E, &next));
        RITZ_CHECK(ritz_general_norm(&next, &size));
        ritz_dense_free(&next);
        if (!(size < 1e100)) /* unstable: the poles show it */
            break;
        if (size * size > out->met) {
            out->met = size * size;
            out->seconds = h * ldexp(1.0, k);
        }
        RITZ_CHECK(ritz_dense_times(&E, &E));
    }
    return RITZ_OK;
}

/* (|V| |V^-1|)^2, eigenvectors of A as columns of length 1. */
static ritz_status bound_growth(const ritz_dense *A, double *out)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) H = {0}, V = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL, *sigma = NULL;
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(A, &H));
    RITZ_CHECK(ritz_dense_new(n, n, &V));
    RITZ_CHECK_NEW(re, n);
    RITZ_CHECK_NEW(im, n);
    RITZ_CHECK_NEW(sigma, n);
    info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, H.val, n, re, im, NULL,
                         1, V.val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    RITZ_CHECK(ritz_general_singular(&V, sigma));
    *out = sigma[n - 1] > 0.0 ? pow(sigma[0] / sigma[n - 1], 2.0) : HUGE_VAL;
    return RITZ_OK;
}

/* Growth of a stable A. @cost O(n^3), some hundred products up to 400 states */
static ritz_status measure_growth(const ritz_dense *A, growth *out)
{
    double size = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', (int)A->nrow,
                                 (int)A->ncol, A->val, (int)A->nrow);

    *out = (growth){.met = 1.0, .most = HUGE_VAL, .followed = true};
    if (A->nrow == 0 || size == 0.0) {
        out->most = 1.0;
        return RITZ_OK;
    }
    RITZ_CHECK(bound_growth(A, &out->most));
    out->followed = A->nrow <= MOST_STATES;
    if (!out->followed)
        return RITZ_OK;
    for (int k = 0; k < FOURTHS; k++)
        RITZ_CHECK(follow_powers(A, 0.25 / size * exp2((double)k / FOURTHS),
                                 RITZ_POWERS_ROUNDING / DBL_EPSILON / size,
                                 out));
    out->most = fmax(out->most, out->met);
    return RITZ_OK;
}

/*
 * A change of the units of states is no growth. States are scaled until what
 * goes into each is as large as what comes out of it; a coupling in one
 * direction, which units can make as small as one likes, is compared with a
 * least size.
 */
static ritz_status forget_units(ritz_dense *A)
{
    int n = (int)A->nrow;
    double least = DBL_EPSILON * ritz_dense_max(A);
    RITZ_OWN(ritz_dense) sizes = {0};
    RITZ_OWN_ARRAY double *scale = NULL;
    lapack_int low = 0, high = 0;

    RITZ_CHECK_NEW(scale, n);
    RITZ_CHECK(ritz_dense_new(n, n, &sizes));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            if (i != j)
                ritz_dense_col(&sizes, j)[i] =
                    fmax(fabs(ritz_dense_col(A, j)[i]), least);
    if (n > 0)
        LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, sizes.val, n, &low, &high,
                       scale);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(A, j)[i] *= scale[j] / scale[i];
    return RITZ_OK;
}

/*
 * (|s| of the fastest pole over that of the slowest)^2: the growth that a
 * passive structure can have in displacements and velocities, as a unit
 * velocity of the slowest mode displaces it by 1 / |s|. Poles are those of the
 * diagonal blocks of a Schur form.
 */
static double spread_poles(const ritz_dense *S)
{
    const int64_t n = S->nrow;
    double fast = 0.0, slow = HUGE_VAL;

    for (int64_t k = 0, step = 1; k < n; k += step) {
        const double *first = ritz_dense_col(S, k);
        double size = fabs(first[k]);

        step = k + 1 < n && first[k + 1] != 0.0 ? 2 : 1;
        if (step == 2) { /* [a b; c a]: |s|^2 = a^2 - b c */
            const double *second = ritz_dense_col(S, k + 1);

            size =
                sqrt(fabs(first[k] * second[k + 1] - first[k + 1] * second[k]));
        }
        fast = fmax(fast, size);
        slow = fmin(slow, size);
    }
    return n > 0 && slow > 0.0 ? pow(fast / slow, 2.0) : 1.0;
}

/*
 * Growth of the energy of a reduced model. States have no energy, and
 * non-normal growth is no instability: for them it is the growth of the sum of
 * squares of scaled states, and the limit is the growth that the poles explain.
 */
ritz_status ritz_check_growth(ritz_checker *it)
{
    static const char name[] = "energy-growth";
    const ritz_dense none = {0};
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_split) split = {0};
    growth found = {0};
    double limit = 1.0 + RITZ_GROWTH_ROUNDING; /* squaring doubles rounding */
    char where[RITZ_WHERE_SIZE];

    if (it->definite || !it->stable) {
        ritz_checker_say(it, name, it->definite ? 1.0 : HUGE_VAL, 1.0,
                         it->definite ? RITZ_PASS : RITZ_FAIL, "", "%s",
                         it->definite ? "proven: M, K and D are semidefinite"
                                      : "a free motion grows without bound");
        return RITZ_OK;
    }
    if (it->reduced) {
        RITZ_CHECK(measure_growth(&it->pairs.A, &found));
    } else {
        RITZ_CHECK(ritz_dense_copy(&it->pairs.A, &A));
        RITZ_CHECK(forget_units(&A));
        RITZ_CHECK(ritz_split_new(&A, &none, &split));
        RITZ_CHECK(measure_growth(&split.S, &found));
        limit = spread_poles(&split.S);
        limit /= RITZ_INTEGRATOR_ERROR * RITZ_INTEGRATOR_ERROR;
    }
    if (found.seconds > 0.0)
        snprintf(where, sizeof where, "after %.3g s", found.seconds);
    else
        snprintf(where, sizeof where, "not followed, of more than %d states",
                 MOST_STATES);
    ritz_checker_say(it, name, found.met, limit,
                     found.met > limit ? RITZ_WARN : RITZ_PASS,
                     found.met > 1.0 || !found.followed ? where : "",
                     "%s of a free motion: %.4g times its first at least, %.3g "
                     "at most",
                     it->reduced ? "energy" : "square of scaled states",
                     found.met, found.most);
    return RITZ_OK;
}
