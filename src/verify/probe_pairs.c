/*
 * Pairs of an input and an output of one name in a state space: a force, and
 * the displacement, velocity or acceleration of where it acts. Whatever that
 * is,
 *
 *     u = -k y,    A - B k (I + D k)^-1 C
 *
 * is a spring, a damper or a mass that is hung on it, and y = 0 holds it: the
 * poles are then its zeros.
 */
#include "verify/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <ritz/zeros.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double times_own[] = {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3};
enum { TIMES = sizeof times_own / sizeof *times_own };
/* Of the largest pole: a zero beyond is met by stiffer attachments alone. */
static const double beyond = 1e3;
/* Of |s|: a zero no further right is on the axis. */
static const double on_axis = 1e-7;
static const double rounding = 1e-9;

static int64_t output_of(const ritz_state_space *model, int64_t input)
{
    for (int64_t i = 0; i < model->num_outputs; i++)
        if (strcmp(model->output[i], model->input[input]) == 0)
            return i;
    return -1;
}

static ritz_status take_pairs(const ritz_state_space *model,
                              ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = model->A.nrow;
    int64_t *in = NULL, *seen = NULL;
    int64_t p = 0;

    RITZ_NEW(in, model->num_inputs);
    RITZ_NEW(seen, model->num_inputs);
    for (int64_t j = 0; j < model->num_inputs; j++) {
        seen[p] = output_of(model, j);
        in[p] = j;
        p += seen[p] >= 0;
    }
    RITZ_TRY(ritz_dense_copy(&model->A, &out->A));
    RITZ_TRY(ritz_dense_new(n, p, &out->B));
    RITZ_TRY(ritz_dense_new(p, n, &out->C));
    RITZ_TRY(ritz_dense_new(p, p, &out->D));
    RITZ_NEW(out->power, p);
    RITZ_NEW(out->name, p);
    for (int64_t j = 0; j < p; j++) {
        memcpy(ritz_dense_col(&out->B, j), ritz_dense_col(&model->B, in[j]),
               (size_t)n * sizeof *out->B.val);
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&out->C, i)[j] =
                ritz_dense_col(&model->C, i)[seen[j]];
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&out->D, j)[i] =
                ritz_dense_col(&model->D, in[j])[seen[i]];
        memcpy(out->name[j], model->input[in[j]], sizeof *out->name);
    }
    if (model->E.val) {
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &out->A));
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &out->B));
    }
done:
    free(in);
    free(seen);
    return status;
}

/* One pair as a model of its own. */
static ritz_status alone(const ritz_collocated *all, int64_t i, int *power,
                         ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense row = {0};

    out->A = all->A; /* borrowed, as power is */
    out->power = power;
    RITZ_TRY(ritz_dense_columns(&all->B, i, 1, &out->B));
    RITZ_TRY(ritz_dense_rows(&all->C, 1, &i, &out->C));
    RITZ_TRY(ritz_dense_rows(&all->D, 1, &i, &row));
    RITZ_TRY(ritz_dense_columns(&row, i, 1, &out->D));
done:
    ritz_dense_free(&row);
    return status;
}

/* What output i is: what breaks passivity least; of equals a displacement. */
static ritz_status guess(const ritz_collocated *all, int64_t i)
{
    ritz_status status = RITZ_OK;
    static const int powers[] = {1, 0, -1};
    double best = -HUGE_VAL;

    for (size_t k = 0; k < sizeof powers / sizeof *powers; k++) {
        ritz_collocated one = {0};
        ritz_passivity found = {0};
        int power = powers[k];

        status = alone(all, i, &power, &one);
        if (status == RITZ_OK)
            status = ritz_passivity_of(&one, &found);
        one.A = (ritz_dense){0};
        one.power = NULL;
        ritz_collocated_free(&one);
        RITZ_TRY(status);
        if (found.value > best + rounding) {
            best = found.value;
            all->power[i] = power;
        }
    }
done:
    return status;
}

ritz_status ritz_collocated_of_space(const ritz_state_space *model,
                                     ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    ritz_collocated pairs = {0};

    RITZ_TRY(take_pairs(model, &pairs));
    for (int64_t i = 0; i < pairs.B.ncol; i++)
        RITZ_TRY(guess(&pairs, i));
    *out = pairs;
    pairs = (ritz_collocated){0};
done:
    ritz_collocated_free(&pairs);
    return status;
}

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
