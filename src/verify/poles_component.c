#include "verify/poles.h"

/* Phi'A Phi of a sparse A; {0} of an absent one. */
static ritz_status project(const ritz_sparse *A, const ritz_dense *Phi,
                           ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense APhi = {0};

    if (!A->colptr)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_mul(A, Phi, &APhi));
    RITZ_TRY(ritz_dense_mul_tn(Phi, &APhi, out));
    if (ritz_sparse_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(out);
done:
    ritz_dense_free(&APhi);
    return status;
}

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
    RITZ_TRY(project(&component->D, &found.Phi, &D));
    RITZ_TRY(project(&component->K4, &found.Phi, &K4));
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
