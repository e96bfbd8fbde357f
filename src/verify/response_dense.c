/* Response of a small dense model, by all its modes. */
#include "verify/dense_poles.h"

#include <ritz/monitor.h>

ritz_status ritz_poles_of_dense(const ritz_dense *K, const ritz_dense *M,
                                const ritz_dense *D, const ritz_io *io,
                                const ritz_damping *damping, ritz_poles *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    ritz_dense DPhi = {0};
    ritz_dense d = {0};

    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    if (D && D->val) {
        RITZ_TRY_IN("D", ritz_dense_mul(D, &pairs.Phi, &DPhi));
        RITZ_TRY_IN("D", ritz_dense_mul_tn(&pairs.Phi, &DPhi, &d));
    }
    RITZ_TRY(ritz_poles_new(&pairs, &d, NULL, io, damping, out));
done:
    ritz_pairs_free(&pairs);
    ritz_dense_free(&DPhi);
    ritz_dense_free(&d);
    return status;
}

ritz_status ritz_response_dense(const ritz_dense *K, const ritz_dense *M,
                                const ritz_dense *D, const ritz_io *io,
                                const ritz_damping *damping,
                                const ritz_grid *grid, ritz_response *out)
{
    ritz_status status = RITZ_OK;
    ritz_poles poles = {0};
    ritz_response r = {0};

    RITZ_TRY(ritz_poles_of_dense(K, M, D, io, damping, &poles));
    RITZ_TRY(ritz_response_new(grid, &poles, "modal", damping, &r));
    for (int64_t k = 0; k < r.count; k++) {
        RITZ_TRY(ritz_poles_add(&poles, r.hertz[k],
                                r.H + k * r.num_outputs * r.num_inputs));
        ritz_monitor_step("response", k + 1, r.count);
    }
    *out = r;
    r = (ritz_response){0};
done:
    ritz_poles_free(&poles);
    ritz_response_free(&r);
    return status;
}
