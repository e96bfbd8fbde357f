/*
 * What is hung on the pairs of a state space. Whatever an output is,
 *
 *     u = -k y,    A - B k (I + D k)^-1 C
 *
 * is a spring, a damper or a mass on it, and y = 0 holds it: the poles are then
 * its zeros.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <ritz/zeros.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double times_own[] = {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3};
enum { TIMES = sizeof times_own / sizeof *times_own };
/* Of the largest pole: a zero beyond is met by stiffer attachments alone. */
static const double beyond = 1e3;
/* Of |s|: a zero no further right is on the axis. */
static const double on_axis = 1e-7;

/* Middle of what |y_i / u_i| is over the grid; k_i is one over it. */
static ritz_status own_gains(const ritz_collocated *pairs, double *gain)
{
    ritz_status status = RITZ_OK;
    ritz_sampler *sampler = NULL;
    double *w = NULL, *sum = NULL;
    int64_t count = 0, met = 0, p = pairs->B.ncol;

    RITZ_NEW(sum, p);
    RITZ_TRY(ritz_probe_grid(&pairs->A, &count, &w));
    RITZ_TRY(ritz_sampler_new(pairs, &sampler));
    for (int64_t k = 0; k < count; k++) {
        const double _Complex *G = ritz_sampler_at(sampler, w[k]);

        for (int64_t i = 0; G && i < p; i++)
            sum[i] += log(
                fmax(cabs(G[i + i * p]) / pow(w[k], pairs->power[i]), DBL_MIN));
        met += G != NULL;
    }
    for (int64_t i = 0; i < p; i++)
        gain[i] = met > 0 ? exp(-sum[i] / (double)met) : 1.0;
done:
    ritz_sampler_free(&sampler);
    free(w);
    free(sum);
    return status;
}

/* A - B k (I + D k)^-1 C; a row alone, or all: -1. */
static ritz_status hang(const ritz_collocated *pairs, int64_t only, double a,
                        const double *gain, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t p = pairs->B.ncol;
    ritz_dense F = {0}, X = {0}, part = {0}, A = {0};

    RITZ_TRY(ritz_dense_new(p, p, &F));
    RITZ_TRY(ritz_dense_copy(&pairs->C, &X));
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++) {
            double k = only < 0 || j == only ? a * gain[j] : 0.0;

            ritz_dense_col(&F, j)[i] =
                (i == j) + ritz_dense_col(&pairs->D, j)[i] * k;
        }
    RITZ_TRY_IN("feedthrough", ritz_general_solve(&F, false, &X));
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&X, j)[i] *=
                only < 0 || i == only ? a * gain[i] : 0.0;
    RITZ_TRY(ritz_dense_mul(&pairs->B, &X, &part));
    RITZ_TRY(ritz_dense_copy(&pairs->A, &A));
    for (int64_t k = 0; k < A.nrow * A.ncol; k++)
        A.val[k] -= part.val[k];
    *out = A;
    A = (ritz_dense){0};
done:
    ritz_dense_free(&F);
    ritz_dense_free(&X);
    ritz_dense_free(&part);
    ritz_dense_free(&A);
    return status;
}

static const char *attachment(const ritz_collocated *pairs, int64_t only)
{
    static const char *const names[] = {"a mass", "a damper", "a spring"};

    return only < 0 ? "attachments" : names[pairs->power[only] + 1];
}

/* The worst case of all attachments, into worst and where. */
static ritz_status try_all(ritz_prober *it, const double *gain,
                           ritz_probe *worst, char where[RITZ_WHERE_SIZE])
{
    ritz_status status = RITZ_OK;
    const ritz_collocated *pairs = &it->pairs;
    int64_t p = pairs->B.ncol;
    ritz_dense A = {0};
    double most = -HUGE_VAL;

    for (int64_t only = p > 1 ? -1 : 0; only < p; only++)
        for (int k = 0; k < TIMES; k++) {
            ritz_probe probe = {0};
            double growth = 0.0;

            ritz_dense_free(&A);
            RITZ_TRY(hang(pairs, only, times_own[k], gain, &A));
            RITZ_TRY(ritz_probe_judge(&A, &probe));
            growth = probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0;
            if (probe.verdict < worst->verdict ||
                (probe.verdict == worst->verdict && growth <= most))
                continue;
            most = growth;
            *worst = probe;
            snprintf(where, RITZ_WHERE_SIZE, "%s of %g times its own at %s",
                     attachment(pairs, only), times_own[k],
                     only < 0 ? "all pairs" : pairs->name[only]);
        }
done:
    ritz_dense_free(&A);
    return status;
}

/* The zero furthest right, over its size, among those within reach. */
static int64_t worst_zero(int64_t count, const double _Complex *zero,
                          double reach)
{
    int64_t worst = -1;

    for (int64_t k = 0; k < count; k++)
        if (cabs(zero[k]) > 0.0 && cabs(zero[k]) <= reach &&
            (worst < 0 || creal(zero[k]) / cabs(zero[k]) >
                              creal(zero[worst]) / cabs(zero[worst])))
            worst = k;
    return worst;
}

static void say_locked(ritz_prober *it, int64_t count,
                       const double _Complex *zero, double radius)
{
    static const char name[] = "interface-locked";
    int64_t at = worst_zero(count, zero, beyond * radius);
    ritz_probe probe = {.count = count, .radius = radius};
    char text[2 * RITZ_NAME_SIZE];
    bool fails = false;

    if (at < 0) {
        ritz_prober_say(it, name, 0.0, on_axis, RITZ_PASS, "",
                        "with its outputs held nothing is left that moves");
        return;
    }
    fails = creal(zero[at]) > on_axis * cabs(zero[at]);
    probe.pole[0] = creal(zero[at]);
    probe.pole[1] = fabs(cimag(zero[at]));
    ritz_probe_print(&probe, text);
    ritz_prober_say(it, name, creal(zero[at]) / cabs(zero[at]), on_axis,
                    fails ? RITZ_FAIL : RITZ_PASS, "",
                    "with its outputs held: %s", text);
}

ritz_status ritz_probe_locked_states(ritz_prober *it)
{
    static const char name[] = "interface-locked";
    ritz_status status = RITZ_OK;
    const ritz_collocated *pairs = &it->pairs;
    const ritz_state_space model = {
        .A = pairs->A, /* all borrowed */
        .B = pairs->B,
        .C = pairs->C,
        .D = pairs->D,
        .num_inputs = pairs->B.ncol,
        .num_outputs = pairs->B.ncol,
    };
    double _Complex *zero = NULL;
    int64_t count = 0;
    ritz_probe probe = {0};

    if (pairs->B.ncol == 0) {
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                        "not applicable: no input and output of one name");
        return RITZ_OK;
    }
    RITZ_TRY(ritz_probe_judge(&pairs->A, &probe));
    status = ritz_zeros_states(&model, RITZ_ALL_CHANNELS, RITZ_ALL_CHANNELS,
                               &count, &zero);
    if (status == RITZ_ERR_SINGULAR) {
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_WARN, "",
                        "its pairs depend on each other, they cannot be held");
        return RITZ_OK;
    }
    RITZ_TRY(status);
    say_locked(it, count, zero, probe.radius);
done:
    free(zero);
    return status;
}

ritz_status ritz_probe_sprung_states(ritz_prober *it)
{
    static const char name[] = "interface-sprung";
    ritz_status status = RITZ_OK;
    double *gain = NULL;
    ritz_probe worst = {.verdict = RITZ_STABLE};
    char where[RITZ_WHERE_SIZE] = "";
    char text[2 * RITZ_NAME_SIZE];

    if (it->pairs.B.ncol == 0) {
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                        "not applicable: no input and output of one name");
        return RITZ_OK;
    }
    RITZ_NEW(gain, it->pairs.B.ncol);
    RITZ_TRY(own_gains(&it->pairs, gain));
    RITZ_TRY(try_all(it, gain, &worst, where));
    ritz_probe_print(&worst, text);
    ritz_prober_say(
        it, name, worst.radius > 0.0 ? worst.pole[0] / worst.radius : 0.0,
        worst.tolerance, worst.verdict == RITZ_UNSTABLE ? RITZ_FAIL : RITZ_PASS,
        where, "with that hung on it: %s", text);
done:
    free(gain);
    return status;
}
