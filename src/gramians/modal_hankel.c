/*
 * Exact Hankel singular values of a modal model: those of Z_o'Z_c, of factors
 * in closed form (modal_factors.c). Modes that are not reached, or not seen,
 * get zero and not a failure.
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
#include "gramians/modal_block.h"
#include "linear/general.h"

static ritz_status hankel(const ritz_dense *Zo, const ritz_dense *Zc,
                          double *sigma)
{
    ritz_status status = RITZ_OK;
    ritz_dense H = {0};

    for (int64_t k = 0; k < Zc->nrow; k++)
        sigma[k] = 0.0;
    RITZ_TRY(ritz_dense_mul_tn(Zo, Zc, &H));
    RITZ_TRY_IN("Hankel values", ritz_general_singular(&H, sigma));
done:
    ritz_dense_free(&H);
    return status;
}

ritz_status ritz_modal_hankel(const ritz_modal *modal, double *sigma)
{
    ritz_status status = RITZ_OK;
    ritz_dense Zc = {0}, Zo = {0};

    RITZ_TRY(ritz_modal_factors(modal, &Zc, &Zo));
    RITZ_TRY(hankel(&Zo, &Zc, sigma));
done:
    ritz_dense_free(&Zc);
    ritz_dense_free(&Zo);
    return status;
}

ritz_status ritz_modal_hankel_band(const ritz_modal *modal,
                                   const double band_hz[static 2],
                                   double *sigma)
{
    ritz_status status = RITZ_OK;
    ritz_dense Zc = {0}, Zo = {0};

    RITZ_TRY(ritz_modal_factors_band(modal, band_hz, &Zc, &Zo));
    RITZ_TRY(hankel(&Zo, &Zc, sigma));
done:
    ritz_dense_free(&Zc);
    ritz_dense_free(&Zo);
    return status;
}
