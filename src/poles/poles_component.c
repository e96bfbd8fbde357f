#include "poles/poles.h"

ritz_status ritz_poles_of_component(const ritz_component *component,
                                    const ritz_damping *damping,
                                    double up_to_hz, ritz_pairs *pairs,
                                    ritz_poles *out)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = -1, .up_to_hz = up_to_hz};
    ritz_pairs found = {0};
    ritz_dense D = {0};
    ritz_dense K4 = {0};

    RITZ_TRY(ritz_eigen_sparse(&component->K, &component->M, &span, &found));
    RITZ_TRY(ritz_sparse_project(&component->D, &found.Phi, &D));
    RITZ_TRY(ritz_sparse_project(&component->K4, &found.Phi, &K4));
    RITZ_TRY(ritz_poles_new(&found, &D, &K4, &component->io, damping, out));
    if (pairs) {
        *pairs = found;
        found = (ritz_pairs){0};
    }
done:
    ritz_pairs_free(&found);
    ritz_dense_free(&D);
    ritz_dense_free(&K4);
    return status;
}
