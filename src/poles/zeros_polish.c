/*
 * Zeros of one channel, all at once, by the method of Ehrlich and Aberth for
 * the roots of P(z) = f(z) prod (z - p_k), whose values are never formed:
 *
 *     z_i := z_i - 1 / (P'/P - sum 1 / (z_i - z_j)),
 *     P'/P = f'/f + sum 1 / (z_i - p_k)
 *
 * [Aberth1973]. Real starts stay real and pairs stay pairs.
 */
#include "poles/channel.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_SWEEPS = 60 };

/* Steps that are no more than this of a zero end its way. */
static const double small_step = 4.0 * DBL_EPSILON;
/* A zero that rounding may move by this share of its distance from 0 and from
   all poles is taken for one at infinity. */
static const double too_far = 0.1;

static double _Complex pole_at(const ritz_triangle *t, int64_t k)
{
    return t->T[k + k * t->n];
}

/*
 * Each pole cancels one zero that is nearer to it than rounding of the matrix
 * moves either.
 */
static void cancel(ritz_triangle *t, int64_t *count, double _Complex *zero)
{
    double size = 0.0;
    int64_t kept = 0;

    for (int64_t k = 0; k < t->n * t->n; k++)
        size = fmax(size, cabs(t->T[k]));
    for (int64_t i = 0; i < *count; i++) {
        double within = 100.0 * (double)t->n * DBL_EPSILON *
                        (t->band < t->n ? cabs(zero[i]) : size);
        int64_t nearest = -1;

        for (int64_t k = 0; k < t->n; k++)
            if (!t->cancelled[k] && cabs(zero[i] - pole_at(t, k)) <= within &&
                (nearest < 0 || cabs(zero[i] - pole_at(t, k)) <
                                    cabs(zero[i] - pole_at(t, nearest))))
                nearest = k;
        if (nearest >= 0)
            t->cancelled[nearest] = true;
        else
            zero[kept++] = zero[i];
    }
    *count = kept;
}

/* Nearest pole that counts; HUGE_VAL if there is none. */
static double room_around(const ritz_triangle *t, double _Complex z)
{
    double least = HUGE_VAL;

    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k])
            least = fmin(least, cabs(z - pole_at(t, k)));
    return least;
}

/* How far rounding may move a zero, one or a double one. */
static double doubt(const ritz_sample *s)
{
    double one = cabs(s->first), two = cabs(s->second);

    return fmin(one > 0.0 ? s->error / one : HUGE_VAL,
                two > 0.0 ? sqrt(2.0 * s->error / two) : HUGE_VAL);
}

/* The step of zero i; 0 where the next is lost in rounding. */
static double _Complex step(ritz_triangle *t, int64_t count,
                            const double _Complex *zero, int64_t i)
{
    double _Complex z = zero[i], slope = 0.0, move;
    ritz_sample s;

    ritz_triangle_at(t, z, &s);
    if (s.f == 0.0)
        return 0.0;
    slope = s.first / s.f;
    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k])
            slope += 1.0 / (z - pole_at(t, k));
    for (int64_t j = 0; j < count; j++)
        if (j != i && zero[j] != z)
            slope -= 1.0 / (z - zero[j]);
    move = slope != 0.0 ? 1.0 / slope : 0.0;
    if (!isfinite(creal(move)) || !isfinite(cimag(move)))
        return 0.0;
    /* of a real model real ones stay so, but for rounding of the triangle */
    return cimag(z) == 0.0 ? creal(move) : move;
}

/* A pole is no place to evaluate at. */
static double _Complex beside_poles(const ritz_triangle *t, double _Complex z)
{
    while (room_around(t, z) == 0.0)
        z = z != 0.0 ? z * (1.0 + small_step) : DBL_EPSILON;
    return z;
}

static void sweep(ritz_triangle *t, int64_t count, double _Complex *zero,
                  bool *done)
{
    for (int64_t i = 0; i < count; i++) {
        double _Complex move;
        bool pair = cimag(zero[i]) != 0.0 && i + 1 < count &&
                    zero[i + 1] == conj(zero[i]);

        if (!done[i]) {
            zero[i] = beside_poles(t, zero[i]);
            move = step(t, count, zero, i);
            done[i] = cabs(move) <= small_step * cabs(zero[i]);
            zero[i] -= move;
        }
        if (pair) {
            zero[i + 1] = conj(zero[i]);
            done[i + 1] = done[i];
            i++;
        }
    }
}

static void drop_far(ritz_triangle *t, int64_t *count, double _Complex *zero)
{
    int64_t kept = 0;

    for (int64_t i = 0; i < *count; i++) {
        double _Complex z = beside_poles(t, zero[i]);
        ritz_sample s;

        ritz_triangle_at(t, z, &s);
        if (!(doubt(&s) > too_far * fmax(cabs(z), room_around(t, z))))
            zero[kept++] = zero[i];
    }
    *count = kept;
}

ritz_status ritz_zeros_polish(ritz_triangle *triangle, int64_t *count,
                              double _Complex *zero)
{
    ritz_status status = RITZ_OK;
    bool *done = NULL;
    double _Complex *start = NULL;
    bool all = false;

    RITZ_NEW(done, *count);
    RITZ_NEW(start, *count);
    if (triangle->n == 0)
        goto done;
    cancel(triangle, count, zero);
    for (int64_t i = 0; i < *count; i++)
        start[i] = zero[i];
    for (int k = 0; k < MOST_SWEEPS && !all; k++) {
        all = true;
        sweep(triangle, *count, zero, done);
        for (int64_t i = 0; i < *count; i++)
            all = all && done[i];
    }
    for (int64_t i = 0; i < *count; i++) /* such as a double one */
        zero[i] = done[i] ? zero[i] : start[i];
    drop_far(triangle, count, zero);
done:
    free(start);
    free(done);
    return status;
}
