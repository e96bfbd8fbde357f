#include "verify/poles.h"

#include "base/alloc.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
/* H of more values than this is a mistake in the request. */
static const int64_t most_values = INT64_C(1) << 31;

static ritz_status copy_names(int64_t count, const char (*from)[RITZ_NAME_SIZE],
                              char (**out)[RITZ_NAME_SIZE])
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(*out, count);
    memcpy(*out, from, (size_t)count * RITZ_NAME_SIZE);
done:
    return status;
}

ritz_status ritz_response_new(const ritz_grid *grid, const ritz_poles *poles,
                              const char *method, const ritz_damping *damping,
                              ritz_response *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    const ritz_io *io = &poles->io;
    ritz_response r = {.num_inputs = io->num_inputs,
                       .num_outputs = io->num_outputs};
    double *omega = NULL;
    double *zeta = NULL;

    RITZ_TRY(ritz_poles_ratios(poles, &omega, &zeta));
    RITZ_TRY(
        ritz_grid_points(grid, poles->count, omega, zeta, &r.count, &r.hertz));
    RITZ_FAIL_IF(r.num_inputs * r.num_outputs > most_values / r.count,
                 RITZ_ERR_ARGUMENT,
                 "%" PRId64 " frequencies of %" PRId64 " x %" PRId64
                 " responses are too many",
                 r.count, r.num_outputs, r.num_inputs);
    RITZ_TRY(copy_names(r.num_inputs, io->input, &r.input));
    RITZ_TRY(copy_names(r.num_outputs, io->output, &r.output));
    RITZ_NEW(r.H, r.count * r.num_inputs * r.num_outputs);
    (void)snprintf(r.method, RITZ_NAME_SIZE, "%s", method);
    ritz_damping_print(damping ? damping : &none, r.damping);
    *out = r;
    r = (ritz_response){0};
done:
    free(omega);
    free(zeta);
    ritz_response_free(&r);
    return status;
}

void ritz_response_see(const ritz_io *io, double hertz,
                       const double _Complex *X, double _Complex *H)
{
    double w = 2.0 * pi * hertz;
    int64_t n = io->B.nrow;

    for (int64_t k = 0; k < n; k++) {
        const double *c = ritz_dense_col(&io->C, k);
        const double *cv = ritz_dense_col(&io->Cv, k);
        const double *ca = ritz_dense_col(&io->Ca, k);

        for (int64_t i = 0; i < io->num_outputs; i++) {
            double _Complex s = ritz_complex(c[i] - w * w * ca[i], w * cv[i]);

            if (c[i] == 0.0 && cv[i] == 0.0 && ca[i] == 0.0)
                continue;
            for (int64_t j = 0; j < io->num_inputs; j++)
                H[i * io->num_inputs + j] += s * X[k + j * n];
        }
    }
}

void ritz_response_free(ritz_response *response)
{
    free(response->hertz);
    free(response->input);
    free(response->output);
    free(response->H);
    free(response->singular);
    *response = (ritz_response){0};
}
