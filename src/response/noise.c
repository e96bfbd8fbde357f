#include "response/noise.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "response/responder.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

enum { KINDS = 3 };

/* Of a channel's level: one that is nowhere above is rounding; rigid motions
   that cancel leave 1e-13. */
static const double rounding = 1e-12;
/* The same of what is not, from one frequency to the next. */
static const double grain = 0x1p-50;

/* (K + tau M)_kk */
static double diagonal(const ritz_response_request *request, double tau,
                       int64_t k)
{
    const ritz_component *c = request->component;
    const ritz_second_order *m = request->matrices;

    if (c)
        return ritz_sparse_diagonal(&c->K, k) +
               tau * ritz_sparse_diagonal(&c->M, k);
    return ritz_dense_col(m->K, k)[k] + tau * ritz_dense_col(m->M, k)[k];
}

static void take_sizes(const ritz_response_request *request, const ritz_io *io,
                       ritz_noise *noise)
{
    const ritz_dense *const rows[KINDS] = {&io->C, &io->Cv, &io->Ca};
    double tau = ritz_eigen_lambda(request->to_hz);
    int64_t p = io->num_outputs;

    for (int64_t k = 0; k < io->B.nrow; k++) {
        double d = diagonal(request, tau, k);
        double unit = d > 0.0 ? 1.0 / sqrt(d) : 0.0;

        for (int64_t i = 0; i < KINDS * p; i++)
            noise->output[i] = hypot(
                noise->output[i], unit * ritz_dense_col(rows[i / p], k)[i % p]);
        for (int64_t j = 0; j < io->num_inputs; j++)
            noise->input[j] =
                hypot(noise->input[j], unit * ritz_dense_col(&io->B, j)[k]);
    }
}

ritz_status ritz_noise_new(const ritz_response_request *request,
                           ritz_noise *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = request->component  ? &request->component->io
                        : request->matrices ? request->matrices->io
                                            : NULL;
    ritz_noise noise = {0};

    if (!io)
        return RITZ_OK;
    noise.num_outputs = io->num_outputs;
    noise.num_inputs = io->num_inputs;
    RITZ_NEW(noise.output, KINDS * io->num_outputs);
    RITZ_NEW(noise.input, io->num_inputs);
    take_sizes(request, io, &noise);
    *out = noise;
    noise = (ritz_noise){0};
done:
    ritz_noise_free(&noise);
    return status;
}

/* |c_i + i w cv_i - w^2 ca_i|, or a little more. */
static double output_of(const ritz_noise *noise, double w, int64_t i)
{
    const double *size = noise->output;
    int64_t p = noise->num_outputs;

    return size[i] + w * size[p + i] + w * w * size[2 * p + i];
}

void ritz_noise_heed(const ritz_noise *noise, double hertz,
                     const double _Complex *H, double *level)
{
    double w = 2.0 * RITZ_PI * hertz;
    int64_t p = noise->num_outputs;
    int64_t m = noise->num_inputs;
    double gain = 0.0;

    if (!noise->output)
        return;
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++) {
            double size = output_of(noise, w, i) * noise->input[j];

            if (size > 0.0)
                gain = fmax(gain, cabs(H[i * m + j]) / size);
        }
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++)
            level[i * m + j] =
                fmax(level[i * m + j],
                     gain * output_of(noise, w, i) * noise->input[j]);
}

void ritz_noise_scales(int64_t num_outputs, int64_t num_inputs,
                       double tolerance, const double *peak,
                       const double *level, double *scale)
{
    int64_t values = num_outputs * num_inputs;

    ritz_channel_scales(num_outputs, num_inputs, peak, scale);
    for (int64_t v = 0; v < values; v++) {
        double least = rounding * level[v];

        if (peak[v] <= least)
            scale[v] = fmax(scale[v], least / tolerance);
        else
            scale[v] += grain * level[v] / tolerance;
    }
}

void ritz_noise_free(ritz_noise *noise)
{
    free(noise->output);
    free(noise->input);
    *noise = (ritz_noise){0};
}
