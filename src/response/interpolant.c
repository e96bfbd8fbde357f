#include "response/interpolant.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void ritz_interpolant_free(ritz_interpolant *f)
{
    for (int64_t v = 0; f->zero && v < f->values; v++)
        free(f->zero[v]);
    RITZ_FREE(f->pole, f->num_zeros, f->zero, f->node, f->weight, f->H);
}

/*
 * A quotient of products, factors multiplied and divided in turn against
 * overflow.
 */
static double _Complex divide_products(double _Complex s, int64_t above,
                                       const double _Complex *top,
                                       int64_t below,
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

ritz_status ritz_interpolant_append(ritz_interpolant *f, double _Complex s,
                                    const double _Complex *H)
{
    double _Complex x = s / f->unit;

    RITZ_CHECK_ROOM(f->node, f->count, f->room);
    RITZ_CHECK_ROOM(f->weight, f->count, f->weight_room);
    while (f->H_room < (f->count + 1) * f->values)
        RITZ_CHECK_ROOM(f->H, f->H_room, f->H_room);
    f->weight[f->count] =
        divide_products(x, f->num_poles, f->pole, f->count, f->node);
    for (int64_t k = 0; k < f->count; k++)
        f->weight[k] /= f->node[k] - x;
    f->node[f->count] = x;
    memcpy(f->H + f->count * f->values, H, (size_t)f->values * sizeof *H);
    f->count++;
    return RITZ_OK;
}

void ritz_interpolant_at(const ritz_interpolant *f, double _Complex s,
                         bool with_zeros, double _Complex *H)
{
    double _Complex x = s / f->unit;
    double _Complex all =
        divide_products(x, f->count, f->node, f->num_poles, f->pole);

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

            for (int64_t k = 0; with_zeros && k < f->num_zeros[v]; k++)
                zeros *= (x - f->zero[v][k]) / (f->node[m] - f->zero[v][k]);
            H[v] += share * zeros * f->H[m * f->values + v];
        }
    }
}

double ritz_interpolant_need(const ritz_interpolant *f, double _Complex s)
{
    double _Complex x = s / f->unit;
    double need = 0.0;

    for (int64_t m = 0; m < f->count; m++)
        need += log(cabs(x - f->node[m]));
    for (int64_t k = 0; k < f->num_poles; k++)
        need -= log(cabs(x - f->pole[k]));
    return need;
}
