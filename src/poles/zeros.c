/* Zeros: found from the pencil, made exact where the model says more. */
#include "poles/channel.h"

#include "base/alloc.h"
#include "model/first_order.h"
#include "poles/poles.h"

#include <ritz/zeros.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* By magnitude; equal ones by real part, and of a pair the upper one first. */
static int ascending(const void *left, const void *right)
{
    const double _Complex *a = left;
    const double _Complex *b = right;
    double size = cabs(*a) - cabs(*b);
    double re = creal(*b) - creal(*a);
    double im = cimag(*b) - cimag(*a);

    if (size != 0.0)
        return size > 0.0 ? 1 : -1;
    if (re != 0.0)
        return re > 0.0 ? 1 : -1;
    return (im > 0.0) - (im < 0.0);
}

/* s = +-sqrt(mu), on an axis exactly where mu is real. */
static int64_t unsquare(double _Complex mu, double _Complex *out)
{
    double re = creal(mu);
    double _Complex s;

    if (cimag(mu) == 0.0)
        s = re < 0.0 ? ritz_complex(0.0, sqrt(-re))
                     : ritz_complex(sqrt(re), 0.0);
    else
        s = csqrt(mu);
    out[0] = s;
    out[1] = cimag(mu) == 0.0 && re < 0.0 ? conj(s) : -s;
    return 2;
}

/* Poles at 0 that the zeros of a derivative cancel. */
static int64_t poles_at_rest(const ritz_channel *c, const ritz_triangle *t)
{
    int64_t count = 0;
    double size = 0.0;

    for (int64_t k = 0; k < t->n; k++)
        size = fmax(size, cabs(t->T[k + k * t->n]));
    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k] &&
            cabs(t->T[k + k * t->n]) <= (double)t->n * DBL_EPSILON * size)
            count += c->squared ? 2 : 1;
    return count;
}

static ritz_status find(const ritz_channel *c, bool single, int64_t *count,
                        double _Complex **out)
{
    ritz_status status = RITZ_OK;
    ritz_triangle t = {0};
    double _Complex *found = NULL, *zero = NULL;
    int64_t n = 0, kept = 0, at_rest = c->derivative;

    RITZ_TRY(ritz_channel_pencil(c, &n, &found));
    if (single) {
        RITZ_TRY(ritz_triangle_new(c, &t));
        RITZ_TRY(ritz_zeros_polish(&t, &n, found));
        at_rest -= poles_at_rest(c, &t);
    }
    RITZ_NEW(zero, 2 * n + 2);
    for (int64_t k = 0; k < n; k++)
        if (c->squared)
            kept += unsquare(found[k], zero + kept);
        else
            zero[kept++] = found[k];
    for (int64_t k = 0; k < at_rest; k++)
        zero[kept++] = 0.0;
    qsort(zero, (size_t)kept, sizeof *zero, ascending);
    *count = kept;
    *out = zero;
    zero = NULL;
done:
    free(found);
    free(zero);
    ritz_triangle_free(&t);
    return status;
}

ritz_status ritz_zeros_dense(const ritz_second_order *model,
                             const ritz_damping *damping, int64_t output,
                             int64_t input, int64_t *count,
                             double _Complex **out)
{
    ritz_status status = RITZ_OK;
    ritz_channel channel = {0};

    RITZ_TRY(ritz_channel_dense(model, damping, output, input, &channel));
    RITZ_TRY(find(&channel, output != RITZ_ALL_CHANNELS, count, out));
done:
    ritz_channel_free(&channel);
    return status;
}

ritz_status ritz_zeros_component(const ritz_component *component,
                                 const ritz_damping *damping, int64_t output,
                                 int64_t input, int64_t *count,
                                 double _Complex **out)
{
    ritz_status status = RITZ_OK;
    ritz_structure dense = {0};
    ritz_second_order model = {
        .K = &dense.K, .M = &dense.M, .D = &dense.D, .io = &component->io};

    RITZ_TRY(ritz_structure_of_component(component, &dense));
    RITZ_TRY(ritz_zeros_dense(&model, damping, output, input, count, out));
done:
    ritz_structure_free(&dense);
    return status;
}

ritz_status ritz_zeros_states(const ritz_state_space *model, int64_t output,
                              int64_t input, int64_t *count,
                              double _Complex **out)
{
    ritz_status status = RITZ_OK;
    ritz_channel channel = {0};

    RITZ_TRY(ritz_channel_states(model, output, input, &channel));
    RITZ_TRY(find(&channel, output != RITZ_ALL_CHANNELS, count, out));
done:
    ritz_channel_free(&channel);
    return status;
}
