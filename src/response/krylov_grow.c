#include "response/krylov.h"

#include "base/alloc.h"
#include "model/io.h"
#include "response/responder.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of its frequency: so far beside a pole Z can be factored. */
static const double beside = 1e-4;
/* How wrong an indicator may be found, at most. */
static const double most_amplified = 1e6;

/* Whether residual `index` has a part in an error that is too large. */
static bool takes_part(const ritz_krylov *k, int64_t index)
{
    const double *error = k->error + k->at * k->values;

    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++)
            if ((index == j || index == k->inputs + i) &&
                error[i * k->inputs + j] > k->allowed[i * k->inputs + j])
                return true;
    return false;
}

/* Project anew and measure. */
static ritz_status renew(ritz_krylov *k, ritz_dense *X, int64_t *added)
{
    RITZ_CHECK(ritz_krylov_space_add(&k->space, X, added));
    ritz_krylov_small_free(&k->small);
    RITZ_CHECK(ritz_krylov_small_new(&k->full, &k->space, &k->small));
    return ritz_krylov_measure(k);
}

/* X += real and imaginary part of S y, as columns. */
static void correction(const ritz_krylov *k, ritz_dense *X)
{
    int64_t n = k->space.S.nrow;
    double *re = X->val + n * X->ncol;
    double *im = re + n;

    for (int64_t c = 0; c < k->space.S.ncol; c++) {
        const double *s = ritz_dense_col(&k->space.S, c);
        double a = creal(k->y[c]);
        double b = cimag(k->y[c]);

        for (int64_t i = 0; i < n && (a != 0.0 || b != 0.0); i++) {
            re[i] += a * s[i];
            im[i] += b * s[i];
        }
    }
    X->ncol += 2;
}

/* The first: A^-1 of all loads. */
ritz_status ritz_krylov_begin(ritz_krylov *k)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0};
    int64_t added = 0;

    if (k->full.m < k->full.n)
        RITZ_TRY(ritz_dense_copy(&k->space.S, &X));
    X.nrow = k->full.n;
    for (int64_t c = 0; c < k->space.W.ncol; c++)
        if (k->space.column[c].kind > RITZ_KRYLOV_CA && X.ncol > c)
            X.ncol = c; /* loads are in front */
    RITZ_TRY(renew(k, &X, &added));
done:
    ritz_dense_free(&X);
    return status;
}

ritz_status ritz_krylov_correct(ritz_krylov *k, int64_t *added)
{
    ritz_status status = RITZ_OK;
    int64_t loads = k->inputs + k->outputs;
    double hertz = k->hertz[k->at];
    ritz_dense X = {0};

    RITZ_TRY(ritz_dense_new(k->full.n, 2 * loads, &X));
    X.ncol = 0;
    RITZ_TRY(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < loads; j++)
        if (takes_part(k, j)) {
            ritz_krylov_take(k, hertz, j);
            correction(k, &X);
        }
    RITZ_TRY(renew(k, &X, added));
    k->corrections++;
done:
    ritz_dense_free(&X);
    return status;
}

/* b of the inputs, then c of the outputs, n each. */
static void put_loads(const ritz_krylov *k, double w, double _Complex *X)
{
    const ritz_io *io = &k->full.component->io;
    int64_t n = k->full.n;

    for (int64_t i = 0; i < n * k->inputs; i++)
        X[i] = io->B.val[i];
    for (int64_t i = 0; i < n; i++)
        for (int64_t o = 0; o < k->outputs; o++)
            X[i + (k->inputs + o) * n] =
                ritz_complex(ritz_dense_col(&io->C, i)[o] -
                                 w * w * ritz_dense_col(&io->Ca, i)[o],
                             w * ritz_dense_col(&io->Cv, i)[o]);
}

/* Real and imaginary parts side by side. */
static ritz_status split(int64_t n, int64_t columns, const double _Complex *Z,
                         ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_new(n, 2 * columns, X));
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < n; i++) {
            ritz_dense_col(X, 2 * j)[i] = creal(Z[i + j * n]);
            ritz_dense_col(X, 2 * j + 1)[i] = cimag(Z[i + j * n]);
        }
    return RITZ_OK;
}

/*
 * Largest error of the projection beside full answers, over what is allowed;
 * where it is more than was thought, all errors are from now on. Neither is
 * what rounding makes of those answers: Y are the outputs' own.
 */
static ritz_status compare(ritz_krylov *k, double hertz,
                           const double _Complex *X, const double _Complex *Y,
                           double *out)
{
    ritz_status status = RITZ_OK;
    double more = 1.0;
    double _Complex *H = NULL;

    RITZ_NEW(H, k->values);
    RITZ_TRY(ritz_direct_noise(&k->full, hertz, X, k->outputs, Y, k->noise));
    ritz_io_respond(&k->full.component->io, hertz, X, H);
    if (k->full.apart)
        RITZ_TRY(ritz_poles_add(&k->full.poles, hertz, H));
    RITZ_TRY(ritz_krylov_judge(k, hertz, k->trial));
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_TRY(ritz_poles_add(&k->small.poles, hertz, k->H));
    *out = 0.0;
    for (int64_t v = 0; v < k->values; v++) {
        double error = fmax(cabs(H[v] - k->H[v]) - k->noise[v], 0.0);
        double allowed = fmax(k->allowed[v], k->tolerance * cabs(H[v]));

        if (!(allowed > 0.0))
            continue;
        *out = fmax(*out, error / allowed);
        if (error > 0.1 * allowed && error > k->trial[v])
            more = fmax(more, error / k->trial[v]);
    }
    k->amplify = fmin(k->amplify * more, most_amplified);
done:
    free(H);
    return status;
}

/* Answers to all inputs at a frequency, or beside it where there is none; and
   to all outputs, of the transposed system. */
static ritz_status answer(ritz_krylov *k, double *hertz, double _Complex *Z)
{
    ritz_status status = RITZ_OK;

    put_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
    status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    if (status == RITZ_ERR_SINGULAR) {
        *hertz *= 1.0 + beside;
        put_loads(k, sqrt(ritz_eigen_lambda(*hertz)), Z);
        status = ritz_direct_solve(&k->full, *hertz, false, k->inputs, Z);
    }
    if (status != RITZ_OK)
        goto done;
    RITZ_TRY(ritz_direct_solve(&k->full, *hertz, true, k->outputs,
                               Z + k->full.n * k->inputs));
done:
    return status;
}

ritz_status ritz_krylov_expand(ritz_krylov *k, double hertz, int64_t *added,
                               double *was)
{
    ritz_status status = RITZ_OK;
    int64_t n = k->full.n;
    int64_t loads = k->inputs + k->outputs;
    double _Complex *Z = NULL;
    ritz_dense X = {0};

    RITZ_NEW(Z, n * loads);
    RITZ_TRY(answer(k, &hertz, Z));
    RITZ_TRY(compare(k, hertz, Z, Z + n * k->inputs, was));
    k->points++;
    *added = 0;
    if (*was <= 1.0)
        goto done;
    RITZ_TRY(split(n, loads, Z, &X));
    RITZ_TRY(renew(k, &X, added));
    k->unmet = fmax(k->unmet, *was);
done:
    free(Z);
    ritz_dense_free(&X);
    return status;
}
