#include "poles/static_rest.h"

#include "base/alloc.h"
#include "poles/state.h"

#include <string.h>

/* out = C N (N'B), num_outputs x num_inputs. */
static ritz_status see(const ritz_dense *C, const ritz_dense *N,
                       const ritz_dense *NB, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense CN = {0}, H = {0};

    RITZ_TRY(ritz_dense_mul(C, N, &CN));
    RITZ_TRY(ritz_dense_mul(&CN, NB, &H));
    memcpy(out, H.val, (size_t)(H.nrow * H.ncol) * sizeof *out);
done:
    ritz_dense_free(&CN);
    ritz_dense_free(&H);
    return status;
}

ritz_status ritz_static_rest(const ritz_second_order *model,
                             const ritz_pairs *pairs, ritz_residual *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = model->io;
    int64_t size = io->num_outputs * io->num_inputs;
    ritz_residual found = {.num_outputs = io->num_outputs,
                           .num_inputs = io->num_inputs,
                           .known = true};
    ritz_dense N = {0}, NB = {0};

    if (pairs->Phi.ncol == model->K->ncol || size == 0)
        return RITZ_OK;
    found.count = 1;
    RITZ_NEW(found.C, size);
    RITZ_NEW(found.Cv, size);
    RITZ_NEW(found.Ca, size);
    RITZ_TRY(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    RITZ_TRY(ritz_dense_mul_tn(&N, &io->B, &NB));
    RITZ_TRY(see(&io->C, &N, &NB, found.C));
    RITZ_TRY(see(&io->Cv, &N, &NB, found.Cv));
    RITZ_TRY(see(&io->Ca, &N, &NB, found.Ca));
    *out = found;
    found = (ritz_residual){0};
done:
    ritz_dense_free(&N);
    ritz_dense_free(&NB);
    ritz_residual_free(&found);
    return status;
}
