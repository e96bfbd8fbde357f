/* Whether an output sees an input at all. */
#include "verify/sides.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

/* A mode's largest entry of B, and of C, Cv and Ca, each by any channel. */
enum { SHARES = 4 };

static void shares_of(const ritz_io *io, int64_t k, double share[SHARES])
{
    const ritz_dense *see[] = {&io->C, &io->Cv, &io->Ca};

    share[0] = 0.0;
    for (int64_t j = 0; j < io->num_inputs; j++)
        share[0] = fmax(share[0], fabs(ritz_dense_col(&io->B, j)[k]));
    for (int t = 0; t < 3; t++) {
        share[t + 1] = 0.0;
        for (int64_t i = 0; i < io->num_outputs; i++)
            share[t + 1] =
                fmax(share[t + 1], fabs(ritz_dense_col(see[t], k)[i]));
    }
}

/*
 * Whether any |H| is more than rounding of the sum over modes: entries of B and
 * C are known to some eps of the largest, b and c, so of thousands of modes
 *
 *     1e3 eps sum_k (|c_k| b + c |b_k|) / |w_k^2 - w^2 + i w d_k|
 */
ritz_status ritz_sweep_hear(const ritz_poles *poles, ritz_sweep *s)
{
    const double thousand_eps = 2.3e-13;
    ritz_status status = RITZ_OK;
    double most[SHARES] = {0.0};
    double *share = NULL;

    s->heard = false;
    RITZ_NEW(share, SHARES * poles->count);
    for (int64_t k = 0; k < poles->count; k++) {
        shares_of(&poles->io, k, &share[SHARES * k]);
        for (int t = 0; t < SHARES; t++)
            most[t] = fmax(most[t], share[SHARES * k + t]);
    }
    for (int64_t p = 0; p < s->count && !s->heard; p++) {
        double w = 2.0 * RITZ_PI * s->hertz[p];
        double c_most = most[1] + w * (most[2] + w * most[3]);
        double sum = 0.0;

        for (int64_t k = 0; k < poles->count; k++) {
            const double *of = &share[SHARES * k];
            double c = of[1] + w * (of[2] + w * of[3]);
            double below = hypot(poles->lambda[k] - w * w, w * poles->rate[k]);

            if (below > 0.0)
                sum += (c * most[0] + c_most * of[0]) / below;
        }
        for (int64_t e = p * s->values; e < (p + 1) * s->values; e++)
            s->heard = s->heard || cabs(s->full[e]) > thousand_eps * sum;
    }
done:
    free(share);
    return status;
}
