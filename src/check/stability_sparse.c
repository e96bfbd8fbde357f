/*
 * Stability of a large sparse E x' = A x, whose poles cannot all be computed.
 * If E = E' is positive definite and A + A' negative definite, V = x'E x
 * decreases along every motion, since V' = x'(A + A')x: no pole is right of the
 * axis. If A = A' and E is definite, the inertia of A gives the number of poles
 * right of the axis. Otherwise only the poles nearest to 0 are computed, and
 * the number of the others is reported. ARPACK finds multiple poles at 0 only
 * to a root of rounding; ritz_zero_poles_find recognises them.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "model/space.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { LOOKED_AT = 20 };

/* The rightmost of the computed poles, with its imaginary part made
   positive. */
static void take_rightmost(const ritz_pencil *pencil,
                           const ritz_pencil_pairs *near, ritz_probe *out)
{
    const double least = RITZ_POLE_BOUND_FACTOR * DBL_EPSILON *
                         ritz_sparse_max(&pencil->A) /
                         ritz_sparse_max(&pencil->E);
    int64_t worst = 0;

    for (int64_t k = 0; k < near->count; k++) {
        out->radius = fmax(out->radius, cabs(near->s[k]));
        if (creal(near->s[k]) > creal(near->s[worst]))
            worst = k;
    }
    out->count = near->count;
    if (near->count == 0)
        return;
    out->pole[0] = creal(near->s[worst]) + 0.0;
    out->pole[1] = fabs(cimag(near->s[worst]));
    out->tolerance = fmax(RITZ_POLE_FOUND * cabs(near->s[worst]), least) /
                     fmax(out->radius, RITZ_LEAST_SCALE);
}

/*
 * Number of poles right of the axis of a symmetric pencil with definite E,
 * which is the number of positive eigenvalues of A by its inertia; *known is
 * false for other pencils.
 */
static ritz_status count_unstable(const ritz_pencil *pencil, bool *known,
                                  int64_t *count, bool *singular)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_ldl) *F = NULL;
    ritz_status status = RITZ_OK;
    int64_t negative = 0;

    *known = false;
    if (!ritz_pencil_is_symmetric(pencil))
        return RITZ_OK;
    status = ritz_factor_spd(&pencil->E, &L);
    if (status != RITZ_OK)
        return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
    status = ritz_ldl_new(&pencil->A, &negative, &F);
    *singular = status == RITZ_ERR_SINGULAR;
    if (status != RITZ_OK && !*singular)
        return status;
    *known = true;
    *count = *singular ? 0 : pencil->n - negative;
    return RITZ_OK;
}

/* Verdict by the poles nearest to 0 alone. */
static void judge_found(double error, ritz_probe *probe)
{
    if (probe->pole[0] >= -error)
        probe->verdict = probe->pole[0] > error ? RITZ_UNSTABLE : RITZ_MARGINAL;
}

ritz_status ritz_probe_sparse(const ritz_state_space *model, ritz_probe *out)
{
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(ritz_pencil_pairs) near = {0};
    RITZ_OWN(ritz_zero_poles) zero = {0};
    ritz_probe probe = {.verdict = RITZ_STABLE};
    bool proven = false, known = false, singular = false;
    int64_t unstable = 0;

    RITZ_CHECK(ritz_pencil_of_space(model, &pencil));
    RITZ_CHECK(ritz_pencil_is_dissipative(&pencil, &proven));
    if (!proven)
        RITZ_CHECK(count_unstable(&pencil, &known, &unstable, &singular));
    RITZ_CHECK(ritz_space_slowest(&pencil, LOOKED_AT, &near));
    RITZ_CHECK(ritz_zero_poles_find(&pencil, &zero));
    for (int64_t k = 0; k < near.count && k < zero.T.ncol; k++)
        near.s[k] = 0.0;
    take_rightmost(&pencil, &near, &probe);
    judge_found(probe.tolerance * probe.radius, &probe);
    if ((proven || singular) && probe.verdict == RITZ_UNSTABLE)
        probe.verdict = RITZ_MARGINAL;
    if (known && unstable > 0) {
        probe.verdict = RITZ_UNSTABLE;
        (void)snprintf(probe.why, sizeof probe.why,
                       "%" PRId64 " real poles are right of the axis",
                       unstable);
    }
    probe.unseen = proven || known ? 0 : pencil.n - near.count;
    *out = probe;
    return RITZ_OK;
}
