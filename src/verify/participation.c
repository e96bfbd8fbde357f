#include "verify/participation.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = 3 }; /* C, Cv and Ca */

static int64_t count_channels(const ritz_io *io)
{
    return io->num_inputs + KINDS * io->num_outputs;
}

/* Column j of B from its row k, or row i of C, Cv or Ca from its column k. */
static const double *find_channel(const ritz_io *io, int64_t c, int64_t k,
                                  int64_t *stride)
{
    const ritz_dense *const of[KINDS] = {&io->C, &io->Cv, &io->Ca};
    int64_t row = c - io->num_inputs, p = io->num_outputs;

    *stride = row < 0 ? 1 : p;
    return row < 0 ? ritz_dense_col(&io->B, c) + k
                   : ritz_dense_col(of[row / p], k) + row % p;
}

/* Participation of mode k in channel c, scaled. */
static double participation_of(const ritz_participation *part,
                               const ritz_poles *poles, int64_t c, int64_t k)
{
    int64_t stride = 0;

    return part->scale[c] * *find_channel(&poles->io, c, k, &stride);
}

bool ritz_in_band(const double band_hz[2], double lambda)
{
    double hertz = ritz_eigen_hertz(lambda);

    return hertz >= band_hz[0] * (1.0 - RITZ_SAME) &&
           hertz <= band_hz[1] * (1.0 + RITZ_SAME);
}

/* Inputs, or outputs, of both have the same names. */
static ritz_status check_names(const char *what, int64_t full, int64_t reduced,
                               const char (*of_full)[RITZ_NAME_SIZE],
                               const char (*of_reduced)[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(full != reduced, RITZ_ERR_ARGUMENT,
                   "the models differ in %ss: %" PRId64 " and %" PRId64, what,
                   full, reduced);
    for (int64_t k = 0; k < full; k++)
        RITZ_REFUSE_IF(strcmp(of_full[k], of_reduced[k]) != 0,
                       RITZ_ERR_ARGUMENT,
                       "%s %" PRId64 " is '%s' in the full model and '%s' in "
                       "the reduced one",
                       what, k + 1, of_full[k], of_reduced[k]);
    return RITZ_OK;
}

ritz_status ritz_verify_signals(const ritz_io *full, const ritz_io *reduced)
{
    RITZ_CHECK(check_names("input", full->num_inputs, reduced->num_inputs,
                           full->input, reduced->input));
    return check_names("output", full->num_outputs, reduced->num_outputs,
                       full->output, reduced->output);
}

ritz_status ritz_verify_band(const double band_hz[2], bool may_be_zero)
{
    const bool zero = may_be_zero && band_hz[1] == 0.0;

    RITZ_REFUSE_IF(!(band_hz[0] >= 0.0) || !isfinite(band_hz[1]) ||
                       (!zero && !(band_hz[0] < band_hz[1])),
                   RITZ_ERR_ARGUMENT,
                   "a band from %g to %g Hz is not a band of frequencies",
                   band_hz[0], band_hz[1]);
    return RITZ_OK;
}

static double norm_of(int64_t n, const double *x, int64_t stride)
{
    double size = 0.0;

    for (int64_t k = 0; k < n; k++)
        size = hypot(size, x[k * stride]);
    return size;
}

/* Whether mode k is flexible and in the band. */
static bool is_compared(const ritz_poles *poles, const double band_hz[2],
                        int64_t k)
{
    return k >= poles->num_rigid && ritz_in_band(band_hz, poles->lambda[k]);
}

static void take_scales(const ritz_component *component,
                        const ritz_pairs *pairs, const ritz_poles *poles,
                        const double band_hz[2], ritz_participation *part)
{
    int64_t n = component->num_dofs, stride = 0;
    double shape = 0.0;

    for (int64_t k = 0; k < part->num_modes; k++)
        if (is_compared(poles, band_hz, k))
            shape = fmax(shape, norm_of(n, ritz_dense_col(&pairs->Phi, k), 1));
    for (int64_t c = 0; c < count_channels(&poles->io); c++) {
        const double *row = NULL;
        double largest = 0.0, size = 0.0;

        for (int64_t k = 0; k < part->num_modes; k++)
            if (is_compared(poles, band_hz, k))
                largest = fmax(largest,
                               fabs(*find_channel(&poles->io, c, k, &stride)));
        row = find_channel(&component->io, c, 0, &stride);
        size = shape * norm_of(n, row, stride);
        if (largest > RITZ_PARTICIPATION_ROUNDING * size)
            part->scale[c] = 1.0 / largest;
    }
}

/* p of mode k: of input j and output i or, where one of them is negative as
   there is none, of the other. */
static double product_of(const ritz_participation *part,
                         const ritz_poles *poles, int64_t j, int64_t i,
                         int64_t k)
{
    double in = j < 0 ? 1.0 : participation_of(part, poles, j, k);
    double out =
        i < 0 ? 1.0 : participation_of(part, poles, part->num_inputs + i, k);

    return fabs(in * out);
}

/* Whether mode k is negligible in a transfer function because of mode m. */
static bool is_negligible(const ritz_poles *poles, int64_t m, double p_m,
                          int64_t k, double p_k)
{
    double stiffer = poles->lambda[m] / poles->lambda[k];
    double ratio_m = fabs(poles->rate[m]) / sqrt(poles->lambda[m]);
    double ratio_k = fabs(poles->rate[k]) / sqrt(poles->lambda[k]);

    /* zeta_m / zeta_k: both may be 0 */
    return p_k * fmax(1.0, stiffer) * fmax(ratio_k, ratio_m) <=
               RITZ_AUDIBLE * p_m * ratio_k &&
           p_k * fmax(1.0, stiffer) <= RITZ_AUDIBLE * p_m;
}

static bool is_observable_in(const ritz_participation *part,
                             const ritz_poles *poles, const double band_hz[2],
                             int64_t j, int64_t i, int64_t k)
{
    double p_k = product_of(part, poles, j, i, k);

    if (p_k <= RITZ_PARTICIPATION_ROUNDING)
        return false;
    for (int64_t m = 0; m < part->num_modes; m++)
        if (is_compared(poles, band_hz, m) &&
            is_negligible(poles, m, product_of(part, poles, j, i, m), k, p_k))
            return false;
    return true;
}

static bool is_observable(const ritz_participation *part,
                          const ritz_poles *poles, const double band_hz[2],
                          int64_t k)
{
    int64_t columns = part->num_inputs, rows = KINDS * part->num_outputs;

    for (int64_t j = columns > 0 ? 0 : -1; j < columns; j++)
        for (int64_t i = rows > 0 ? 0 : -1; i < rows; i++)
            if (is_observable_in(part, poles, band_hz, j, i, k))
                return true;
    return false;
}

ritz_status ritz_participation_new(const ritz_component *component,
                                   const ritz_pairs *pairs,
                                   const ritz_poles *poles,
                                   const double band_hz[2],
                                   ritz_participation *out)
{
    RITZ_OWN(ritz_participation)
    part = {.num_modes = poles->count,
            .num_inputs = poles->io.num_inputs,
            .num_outputs = poles->io.num_outputs};

    RITZ_CHECK_NEW(part.scale, count_channels(&poles->io));
    RITZ_CHECK_NEW(part.observable, part.num_modes);
    take_scales(component, pairs, poles, band_hz, &part);
    if (count_channels(&poles->io) > 0)
        for (int64_t k = poles->num_rigid; k < part.num_modes; k++)
            part.observable[k] = is_observable(&part, poles, band_hz, k);
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

double ritz_participation_mac(const ritz_participation *part,
                              const ritz_poles *full, int64_t k,
                              const ritz_poles *reduced, int64_t r)
{
    double fr = 0.0, ff = 0.0, rr = 0.0;

    for (int64_t c = 0; c < count_channels(&full->io); c++) {
        double a = participation_of(part, full, c, k);
        double b = participation_of(part, reduced, c, r);

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    if (ff > 0.0 && rr > 0.0)
        return fr * fr / (ff * rr);
    return ff > 0.0 ? 0.0 : nan("");
}

void ritz_participation_free(ritz_participation *part)
{
    free(part->scale);
    free(part->observable);
    *part = (ritz_participation){0};
}
