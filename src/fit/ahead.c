/*
 * The fixed-interface modes of a small component, which craig-bampton needs,
 *
 *     K_ii Phi = M_ii Phi Lambda,
 *
 * computed by another thread while this one computes the modes of the whole
 * component. LAPACK takes about as long for the one as for the other, and a
 * second thread makes neither faster.
 */
#include "fit/fitter.h"

#include "linear/general.h"
#include "linear/trial.h"

/* Interior dofs from which the modes take longer than it takes to start a
   thread, some 50 microseconds. */
enum { WORTHWHILE = 48 };

void ritz_fit_ahead_free(ritz_fit_ahead *ahead)
{
    ritz_aside_end(&ahead->aside);
    ritz_sparse_free(&ahead->K_ii);
    ritz_sparse_free(&ahead->M_ii);
    ritz_pairs_free(&ahead->modes);
}

static bool are_wanted(const ritz_fitter *f)
{
    const int64_t interior = f->component->num_dofs - f->attached.count;
    const int64_t asked = f->request.num_methods;
    bool wanted = asked == 0;

    for (int64_t k = 0; k < asked; k++)
        wanted = wanted || f->request.methods[k] == &ritz_method_craig_bampton;
    return wanted && f->attached.count > 0 && interior >= WORTHWHILE &&
           interior <= ritz_trial_here()->small;
}

/* A failure leaves no modes: the basis computes them again, and says why it
   fails. */
static void find_modes(void *task)
{
    ritz_fit_ahead *ahead = task;
    RITZ_OWN(ritz_dense) K = {0}, M = {0};

    if (ritz_sparse_dense(&ahead->K_ii, &K) != RITZ_OK ||
        ritz_sparse_dense(&ahead->M_ii, &M) != RITZ_OK)
        return;
    ahead->found = ritz_eigen_unchecked(&K, &M, &ahead->modes) == RITZ_OK;
}

ritz_status ritz_fit_ahead_begin(const ritz_fitter *fitter, ritz_fit_ahead *out)
{
    const ritz_component *full = fitter->component;
    RITZ_OWN(ritz_dofs) i = {0};

    if (!are_wanted(fitter))
        return RITZ_OK;
    RITZ_CHECK(ritz_dofs_complement(&fitter->attached, full->num_dofs, &i));
    RITZ_CHECK(ritz_sparse_extract(&full->K, i.count, i.at, i.count, i.at,
                                   &out->K_ii));
    RITZ_CHECK(ritz_sparse_extract(&full->M, i.count, i.at, i.count, i.at,
                                   &out->M_ii));
    ritz_aside_begin(find_modes, out, true, &out->aside);
    return RITZ_OK;
}

ritz_status ritz_fit_ahead_store(ritz_fit_ahead *ahead)
{
    ritz_aside_end(&ahead->aside);
    if (!ahead->found)
        return RITZ_OK;
    return ritz_spectra_keep(&ahead->K_ii, &ahead->M_ii, &ahead->modes);
}
