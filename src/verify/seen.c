#include "verify/seen.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdlib.h>

enum { KINDS = 3 };

/* A row of outputs sees mode k: rows of C, then Cv, then Ca. */
static double output_of(const ritz_io *io, int64_t row, int64_t k)
{
    const ritz_dense *const of[KINDS] = {&io->C, &io->Cv, &io->Ca};

    return ritz_dense_col(of[row / io->num_outputs], k)[row % io->num_outputs];
}

static double input_of(const ritz_io *io, int64_t j, int64_t k)
{
    return ritz_dense_col(&io->B, j)[k];
}

bool ritz_in_band(const double band_hz[2], double lambda)
{
    double hertz = ritz_eigen_hertz(lambda);

    return hertz >= band_hz[0] * (1.0 - RITZ_SAME) &&
           hertz <= band_hz[1] * (1.0 + RITZ_SAME);
}

static double norm(int64_t n, const double *x, int64_t stride)
{
    double size = 0.0;

    for (int64_t k = 0; k < n; k++)
        size = hypot(size, x[k * stride]);
    return size;
}

static bool counts(const ritz_poles *poles, const double band_hz[2], int64_t k)
{
    return k >= poles->num_rigid && ritz_in_band(band_hz, poles->lambda[k]);
}

/* One over the largest of what is more than rounding of a row c of @p size. */
static double scale(double largest, double size)
{
    return largest > RITZ_PARTICIPATION_ROUNDING * size ? 1.0 / largest : 0.0;
}

static void take_scales(const ritz_component *component,
                        const ritz_pairs *pairs, const ritz_poles *poles,
                        const double band_hz[2], ritz_seen *seen)
{
    const ritz_dense *const of[KINDS] = {&component->io.C, &component->io.Cv,
                                         &component->io.Ca};
    int64_t n = component->num_dofs;
    int64_t p = seen->num_outputs;
    double shape = 0.0;

    for (int64_t k = 0; k < seen->num_modes; k++) {
        if (!counts(poles, band_hz, k))
            continue;
        shape = fmax(shape, norm(n, ritz_dense_col(&pairs->Phi, k), 1));
        for (int64_t j = 0; j < seen->num_inputs; j++)
            seen->input[j] =
                fmax(seen->input[j], fabs(input_of(&poles->io, j, k)));
        for (int64_t i = 0; i < KINDS * p; i++)
            seen->output[i] =
                fmax(seen->output[i], fabs(output_of(&poles->io, i, k)));
    }
    for (int64_t j = 0; j < seen->num_inputs; j++)
        seen->input[j] =
            scale(seen->input[j],
                  shape * norm(n, ritz_dense_col(&component->io.B, j), 1));
    for (int64_t i = 0; i < KINDS * p; i++)
        seen->output[i] =
            scale(seen->output[i], shape * norm(n, of[i / p]->val + i % p, p));
}

/* p of mode k; without inputs, or outputs, of what there is. */
static double share(const ritz_seen *seen, const ritz_poles *poles, int64_t j,
                    int64_t i, int64_t k)
{
    double of_input = seen->num_inputs == 0
                          ? 1.0
                          : seen->input[j] * input_of(&poles->io, j, k);
    double of_output = seen->num_outputs == 0
                           ? 1.0
                           : seen->output[i] * output_of(&poles->io, i, k);

    return fabs(of_input * of_output);
}

/* Whether mode m leaves nothing of mode k to be seen in a channel. */
static bool drowns(const ritz_poles *poles, int64_t m, double p_m, int64_t k,
                   double p_k)
{
    double stiffer = poles->lambda[m] / poles->lambda[k];
    double ratio_m = fabs(poles->rate[m]) / sqrt(poles->lambda[m]);
    double ratio_k = fabs(poles->rate[k]) / sqrt(poles->lambda[k]);

    /* zeta_m / zeta_k: both may be 0 */
    return p_k * fmax(1.0, stiffer) * fmax(ratio_k, ratio_m) <=
               RITZ_AUDIBLE * p_m * ratio_k &&
           p_k * fmax(1.0, stiffer) <= RITZ_AUDIBLE * p_m;
}

static bool is_seen_in(const ritz_seen *seen, const ritz_poles *poles,
                       const double band_hz[2], int64_t j, int64_t i, int64_t k)
{
    double p_k = share(seen, poles, j, i, k);

    if (p_k <= RITZ_PARTICIPATION_ROUNDING)
        return false;
    for (int64_t m = 0; m < seen->num_modes; m++)
        if (counts(poles, band_hz, m) &&
            drowns(poles, m, share(seen, poles, j, i, m), k, p_k))
            return false;
    return true;
}

static bool is_seen(const ritz_seen *seen, const ritz_poles *poles,
                    const double band_hz[2], int64_t k)
{
    int64_t columns = seen->num_inputs > 0 ? seen->num_inputs : 1;
    int64_t rows = seen->num_outputs > 0 ? KINDS * seen->num_outputs : 1;

    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < rows; i++)
            if (is_seen_in(seen, poles, band_hz, j, i, k))
                return true;
    return false;
}

ritz_status ritz_seen_new(const ritz_component *component,
                          const ritz_pairs *pairs, const ritz_poles *poles,
                          const double band_hz[2], ritz_seen *out)
{
    RITZ_OWN(ritz_seen)
    seen = {.num_modes = poles->count,
            .num_inputs = poles->io.num_inputs,
            .num_outputs = poles->io.num_outputs};

    RITZ_CHECK_NEW(seen.input, seen.num_inputs);
    RITZ_CHECK_NEW(seen.output, KINDS * seen.num_outputs);
    RITZ_CHECK_NEW(seen.mode, seen.num_modes);
    take_scales(component, pairs, poles, band_hz, &seen);
    if (seen.num_inputs + seen.num_outputs > 0)
        for (int64_t k = poles->num_rigid; k < seen.num_modes; k++)
            seen.mode[k] = is_seen(&seen, poles, band_hz, k);
    RITZ_MOVE(*out, seen);
    return RITZ_OK;
}

double ritz_seen_mac(const ritz_seen *seen, const ritz_poles *full, int64_t k,
                     const ritz_poles *reduced, int64_t r)
{
    double fr = 0.0, ff = 0.0, rr = 0.0;

    for (int64_t j = 0; j < seen->num_inputs; j++) {
        double a = seen->input[j] * input_of(&full->io, j, k);
        double b = seen->input[j] * input_of(&reduced->io, j, r);

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    for (int64_t i = 0; i < KINDS * seen->num_outputs; i++) {
        double a = seen->output[i] * output_of(&full->io, i, k);
        double b = seen->output[i] * output_of(&reduced->io, i, r);

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    if (ff > 0.0 && rr > 0.0)
        return fr * fr / (ff * rr);
    return ff > 0.0 ? 0.0 : nan("");
}

void ritz_seen_free(ritz_seen *seen)
{
    free(seen->input);
    free(seen->output);
    free(seen->mode);
    *seen = (ritz_seen){0};
}
