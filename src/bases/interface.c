#include "bases/interface.h"

#include "bases/condense.h"

#include <string.h>

/* How many of the modes are kept: a cluster at the end is not cut. */
static int64_t count_kept(const ritz_pairs *modes, int64_t wanted)
{
    const double together = 1e-6;
    int64_t all = modes->Phi.ncol;
    int64_t kept = modes->num_rigid + wanted;

    if (wanted >= all - modes->num_rigid)
        return all;
    while (kept > modes->num_rigid && kept < all &&
           modes->lambda[kept] - modes->lambda[kept - 1] <=
               together * modes->lambda[kept])
        kept++;
    return kept;
}

ritz_status ritz_interface_modes(const ritz_request *request,
                                 const ritz_dense *T_b, ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense K = {0}, M = {0}, Phi = {0};
    ritz_pairs modes = {0};

    RITZ_TRY(ritz_condense(request->component, T_b, &K, &M));
    RITZ_TRY(ritz_eigen_dense(&K, &M, &modes));
    RITZ_TRY(ritz_dense_columns(
        &modes.Phi, 0, count_kept(&modes, request->choice.interface_modes),
        &Phi));
    ritz_dense_free(&modes.Phi);
    modes.Phi = Phi;
    Phi = (ritz_dense){0};
    *out = modes;
    modes = (ritz_pairs){0};
done:
    ritz_dense_free(&K);
    ritz_dense_free(&M);
    ritz_dense_free(&Phi);
    ritz_pairs_free(&modes);
    return ritz_context(status, "interface modes");
}
