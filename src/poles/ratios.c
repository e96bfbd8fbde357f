/*
 * Damping ratios that act on every mode: for one common ratio, D = 2 zeta M
 * (M^-1 K)^1/2. For components that are not too large all modes are computed,
 * the lowest by the sparse eigensolver, which is more accurate. For larger ones
 * Ritz vectors take the place of the modes above (ratio_space.c), unless D or
 * K4 couples modes.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/poles.h"

#include <math.h>

bool ritz_ratios_act_on_all(const ritz_component *component,
                            const ritz_damping *damping)
{
    return ritz_damping_has_ratios(damping) &&
           (component->num_dofs <= RITZ_RATIO_DOFS ||
            (!component->D.colptr && !component->K4.colptr));
}

ritz_status ritz_modes_above(const ritz_component *component,
                             const ritz_pairs *pairs, ritz_dense *Phi,
                             double **lambda)
{
    const ritz_span all = {.modes = component->num_dofs};
    const int64_t m = pairs->Phi.ncol;
    RITZ_OWN(ritz_pairs) found = {0};
    RITZ_OWN(ritz_dense) MPhi = {0}, above = {0};
    int64_t count = 0;

    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &all, &found));
    count = found.Phi.ncol > m ? found.Phi.ncol - m : 0;
    RITZ_CHECK(
        ritz_dense_columns(&found.Phi, found.Phi.ncol - count, count, &above));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &pairs->Phi, &MPhi));
    RITZ_CHECK(ritz_dense_take_out(&pairs->Phi, &MPhi, &above));
    RITZ_CHECK_NEW(*lambda, count);
    for (int64_t k = 0; k < count; k++)
        (*lambda)[k] = found.lambda[m + k];
    RITZ_MOVE(*Phi, above);
    return RITZ_OK;
}

ritz_status ritz_modes_of_whole(const ritz_component *component,
                                double up_to_hz, ritz_pairs *out)
{
    const ritz_span span = {.modes = -1, .up_to_hz = up_to_hz};
    RITZ_OWN(ritz_pairs) low = {0}, all = {0};
    RITZ_OWN(ritz_dense) above = {0};
    RITZ_OWN_ARRAY double *more = NULL;

    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &span, &low));
    RITZ_CHECK(ritz_modes_above(component, &low, &above, &more));
    RITZ_CHECK(ritz_dense_beside(&low.Phi, &above, &all.Phi));
    RITZ_CHECK_NEW(all.lambda, all.Phi.ncol);
    for (int64_t k = 0; k < all.Phi.ncol; k++)
        all.lambda[k] =
            k < low.Phi.ncol ? low.lambda[k] : more[k - low.Phi.ncol];
    all.num_rigid = low.num_rigid;
    all.sigma = low.sigma;
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

void ritz_channel_scales(int64_t num_outputs, int64_t num_inputs,
                         const double *peak, double *scale)
{
    for (int64_t i = 0; i < num_outputs; i++)
        for (int64_t j = 0; j < num_inputs; j++) {
            double row = 0.0, column = 0.0;

            for (int64_t k = 0; k < num_inputs; k++)
                row = fmax(row, peak[i * num_inputs + k]);
            for (int64_t k = 0; k < num_outputs; k++)
                column = fmax(column, peak[k * num_inputs + j]);
            scale[i * num_inputs + j] =
                fmax(peak[i * num_inputs + j],
                     RITZ_CHANNEL_LEAST * sqrt(row * column));
        }
}
