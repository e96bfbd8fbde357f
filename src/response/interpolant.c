#include "response/interpolant.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_interpolant_new(int64_t values, double unit, int64_t num_poles,
                                 const double _Complex *pole,
                                 ritz_interpolant *out)
{
    ritz_status status = RITZ_OK;
    ritz_interpolant f = {
        .values = values, .unit = unit, .num_poles = num_poles};

    RITZ_NEW(f.pole, num_poles);
    for (int64_t k = 0; k < num_poles; k++)
        f.pole[k] = pole[k] / unit;
    RITZ_NEW(f.num_zeros, values);
    RITZ_NEW(f.zero, values);
    *out = f;
    f = (ritz_interpolant){0};
done:
    ritz_interpolant_free(&f);
    return status;
}

ritz_status ritz_interpolant_cancel(ritz_interpolant *interpolant,
                                    int64_t channel, int64_t num_zeros,
                                    const double _Complex *zero)
{
    double _Complex *z = NULL;

    RITZ_CHECK_NEW(z, num_zeros);
    for (int64_t k = 0; k < num_zeros; k++)
        z[k] = zero[k] / interpolant->unit;
    free(interpolant->zero[channel]);
    interpolant->zero[channel] = z;
    interpolant->num_zeros[channel] = num_zeros;
    return RITZ_OK;
}

static ritz_status make_room(ritz_interpolant *f)
{
    ritz_status status = RITZ_OK;
    int64_t room = 2 * f->room + 16;
    double _Complex *node = NULL, *weight = NULL, *H = NULL;
    size_t count = (size_t)f->count;

    if (f->count < f->room)
        return RITZ_OK;
    RITZ_NEW(node, room);
    RITZ_NEW(weight, room);
    RITZ_NEW(H, room * f->values);
    if (count > 0) {
        memcpy(node, f->node, count * sizeof *node);
        memcpy(weight, f->weight, count * sizeof *weight);
        memcpy(H, f->H, count * (size_t)f->values * sizeof *H);
    }
    free(f->node);
    free(f->weight);
    free(f->H);
    f->node = node;
    f->weight = weight;
    f->H = H;
    f->room = room;
    node = weight = H = NULL;
done:
    free(node);
    free(weight);
    free(H);
    return status;
}

/* Factors above and below the line in turn, so that nothing overflows. */
static double _Complex quotient(double _Complex s, int64_t above,
                                const double _Complex *top, int64_t below,
                                const double _Complex *bottom)
{
    double _Complex value = 1.0;

    for (int64_t k = 0; k < above || k < below; k++) {
        if (k < above)
            value *= s - top[k];
        if (k < below)
            value /= s - bottom[k];
    }
    return value;
}

ritz_status ritz_interpolant_add(ritz_interpolant *interpolant,
                                 double _Complex s, const double _Complex *H)
{
    ritz_interpolant *f = interpolant;
    double _Complex x = s / f->unit;

    RITZ_CHECK(make_room(f));
    f->weight[f->count] = quotient(x, f->num_poles, f->pole, f->count, f->node);
    for (int64_t k = 0; k < f->count; k++)
        f->weight[k] /= f->node[k] - x;
    f->node[f->count] = x;
    memcpy(f->H + f->count * f->values, H, (size_t)f->values * sizeof *H);
    f->count++;
    return RITZ_OK;
}

void ritz_interpolant_at(const ritz_interpolant *interpolant, double _Complex s,
                         double _Complex *H)
{
    const ritz_interpolant *f = interpolant;
    double _Complex x = s / f->unit;
    double _Complex all = quotient(x, f->count, f->node, f->num_poles, f->pole);

    for (int64_t v = 0; v < f->values; v++)
        H[v] = 0.0;
    for (int64_t m = 0; m < f->count; m++) {
        double _Complex share = f->weight[m] * all / (x - f->node[m]);

        if (x == f->node[m]) {
            memcpy(H, f->H + m * f->values, (size_t)f->values * sizeof *H);
            return;
        }
        for (int64_t v = 0; v < f->values; v++) {
            double _Complex zeros = 1.0;

            for (int64_t k = 0; k < f->num_zeros[v]; k++)
                zeros *= (x - f->zero[v][k]) / (f->node[m] - f->zero[v][k]);
            H[v] += share * zeros * f->H[m * f->values + v];
        }
    }
}

double ritz_interpolant_need(const ritz_interpolant *interpolant,
                             double _Complex s)
{
    double _Complex x = s / interpolant->unit;
    double need = 0.0;

    for (int64_t m = 0; m < interpolant->count; m++)
        need += log(cabs(x - interpolant->node[m]));
    for (int64_t k = 0; k < interpolant->num_poles; k++)
        need -= log(cabs(x - interpolant->pole[k]));
    return need;
}

void ritz_interpolant_free(ritz_interpolant *interpolant)
{
    for (int64_t v = 0; interpolant->zero && v < interpolant->values; v++)
        free(interpolant->zero[v]);
    free(interpolant->pole);
    free(interpolant->num_zeros);
    free(interpolant->zero);
    free(interpolant->node);
    free(interpolant->weight);
    free(interpolant->H);
    *interpolant = (ritz_interpolant){0};
}
