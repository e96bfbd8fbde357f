/* Evaluation at one frequency of the response of modes that are left out. */
#include "base/alloc.h"
#include "poles/poles.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

/*
 * -i w d / (z (z + i w d)), d the rate from given ratios and
 * z = lambda - w^2 + i w (a + b lambda). Only numbers whose squares overflow or
 * underflow take the slow complex division, which scales.
 */
static double _Complex change_of(const ritz_residual *r, int64_t k, double w2,
                                 double w)
{
    const double lambda = r->lambda[k], d = w * r->rate[k];
    const double re = lambda - w2, im = w * (r->a + r->b * lambda);
    const double product_re = re * re - im * (im + d);
    const double product_im = re * (im + d) + im * re;
    const double square = product_re * product_re + product_im * product_im;
    const double scale = -d / square;

    return isnormal(square)
               ? ritz_complex(scale * product_im, scale * product_re)
               : ritz_complex(0.0, -d) / ritz_complex(product_re, product_im);
}

void ritz_residual_add_ratios(const ritz_residual *r, double hertz,
                              double _Complex *H)
{
    const ritz_io *io = &r->modes;
    const double w2 = ritz_eigen_lambda(hertz);
    const double w = sqrt(w2);

    for (int64_t k = 0; k < r->num_damped; k++) {
        const double _Complex change = change_of(r, k, w2, w);
        const double *C = io->C.val + k * io->C.nrow;
        const double *Cv = io->Cv.val + k * io->Cv.nrow;
        const double *Ca = io->Ca.val + k * io->Ca.nrow;

        for (int64_t i = 0; i < io->num_outputs; i++) {
            const double re = C[i] - w2 * Ca[i], im = w * Cv[i];
            const double _Complex c =
                ritz_complex(creal(change) * re - cimag(change) * im,
                             creal(change) * im + cimag(change) * re);

            for (int64_t j = 0; j < io->num_inputs; j++)
                H[i * io->num_inputs + j] += c * io->B.val[k + j * io->B.nrow];
        }
    }
}

void ritz_residual_add_series(const ritz_residual *residual, double hertz,
                              double _Complex *H)
{
    const double *C = residual->part[0], *Cv = residual->part[1],
                 *Ca = residual->part[2];
    double w2 = ritz_eigen_lambda(hertz);
    double w = sqrt(w2);
    double _Complex stiff = ritz_complex(1.0, w * residual->b);
    double _Complex mu = ritz_complex(w2, -w * residual->a) / stiff;
    double _Complex power = 1.0 / stiff;
    int64_t p = residual->num_outputs;
    int64_t k = 0;

    for (int64_t term = 0; term < residual->count; term++) {
        for (int64_t j = 0; j < residual->num_inputs; j++)
            for (int64_t i = 0; i < p; i++, k++)
                H[i * residual->num_inputs + j] +=
                    power * ritz_complex(C[k] - w2 * Ca[k], w * Cv[k]);
        if (term + 1 < residual->count)
            power *= mu / residual->unit;
    }
}

void ritz_residual_add(const ritz_residual *residual, double hertz,
                       double _Complex *H)
{
    ritz_residual_add_series(residual, hertz, H);
    ritz_residual_add_ratios(residual, hertz, H);
}

void ritz_residual_free(ritz_residual *residual)
{
    for (int k = 0; k < 3; k++)
        free(residual->part[k]);
    RITZ_FREE(residual->lambda, residual->rate);
    ritz_io_free(&residual->modes);
    *residual = (ritz_residual){0};
}
