/* Evaluation at one frequency of the response of modes that are left out. */
#include "base/alloc.h"
#include "poles/poles.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

void ritz_residual_add_ratios(const ritz_residual *r, double hertz,
                              double _Complex *H)
{
    const ritz_io *io = &r->modes;
    const double w2 = ritz_eigen_lambda(hertz);
    const double w = sqrt(w2);

    for (int64_t k = 0; k < r->num_damped; k++) {
        double lambda = r->lambda[k];
        double _Complex z =
            ritz_complex(lambda - w2, w * (r->a + r->b * lambda));
        double _Complex iwd = ritz_complex(0.0, w * r->rate[k]);
        double _Complex change = -iwd / (z * (z + iwd));

        for (int64_t i = 0; i < io->num_outputs; i++) {
            double _Complex c =
                change * ritz_complex(ritz_dense_col(&io->C, k)[i] -
                                          w2 * ritz_dense_col(&io->Ca, k)[i],
                                      w * ritz_dense_col(&io->Cv, k)[i]);

            for (int64_t j = 0; j < io->num_inputs; j++)
                H[i * io->num_inputs + j] += c * ritz_dense_col(&io->B, j)[k];
        }
    }
}

void ritz_residual_add(const ritz_residual *residual, double hertz,
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
