/* Modes as a motion: of a dense model, or of a full component up to a band. */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "poles/poles.h"

#include <ritz/eigen.h>

#include <math.h>

ritz_status ritz_motion_refuse_structural(bool there)
{
    RITZ_REFUSE_IF(
        there, RITZ_ERR_ARGUMENT,
        "structural damping is of harmonic motion alone, in time it "
        "would answer before it is driven: give it as a modal ratio");
    return RITZ_OK;
}

ritz_status ritz_motion_take_modes(ritz_first_order *modes, ritz_motion *m)
{
    m->form = RITZ_FORM_MODAL;
    m->n = modes->count;
    m->original = modes->num_dofs;
    m->num_rigid = modes->num_rigid;
    RITZ_CHECK(ritz_dense_copy(&modes->B, &m->push));
    m->lambda = modes->lambda;
    m->D = modes->Delta;
    m->B = modes->B;
    m->C = modes->C;
    m->Cv = modes->Cv;
    m->feed = modes->feed;
    m->to = modes->MPhi;
    modes->lambda = NULL;
    modes->Delta = modes->B = modes->C = (ritz_dense){0};
    modes->Cv = modes->feed = modes->MPhi = (ritz_dense){0};
    return RITZ_OK;
}

/* What K leaves to modes above, as the first term of their series. */
static ritz_status add_rest(const ritz_component *component, double up_to_hz,
                            const ritz_pairs *pairs, ritz_dense *feed)
{
    ritz_status status = RITZ_OK;
    ritz_residual rest = {0};
    int64_t size = feed->nrow * feed->ncol;

    if (pairs->Phi.ncol >= component->num_dofs)
        return RITZ_OK;
    RITZ_TRY(ritz_residual_new(component, NULL, pairs, 0.0, up_to_hz, &rest));
    for (int64_t k = 0; rest.count > 0 && k < size; k++)
        feed->val[k] += rest.C[k];
done:
    ritz_residual_free(&rest);
    return status;
}

ritz_status ritz_motion_modes(const ritz_component *component,
                              const ritz_damping *damping, double up_to_hz,
                              ritz_motion *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = -1, .up_to_hz = up_to_hz};
    ritz_pairs pairs = {0};
    ritz_first_order modes = {.num_dofs = component->num_dofs};
    ritz_motion m = {0};

    RITZ_FAIL_IF(!(up_to_hz > 0.0), RITZ_ERR_ARGUMENT,
                 "no frequency is given up to which modes are to be found");
    RITZ_TRY(ritz_motion_refuse_structural(
        component->K4.colptr && ritz_sparse_max(&component->K4) > 0.0));
    RITZ_TRY(ritz_eigen_sparse(&component->K, &component->M, &span, &pairs));
    modes.count = pairs.Phi.ncol;
    modes.num_rigid = pairs.num_rigid;
    RITZ_TRY(ritz_dense_copy(&pairs.Phi, &modes.Phi));
    RITZ_TRY(ritz_sparse_mul(&component->M, &pairs.Phi, &modes.MPhi));
    RITZ_TRY(ritz_sparse_project(&component->D, &pairs.Phi, &modes.Delta));
    RITZ_NEW(modes.lambda, modes.count);
    for (int64_t j = modes.num_rigid; j < modes.count; j++)
        modes.lambda[j] = pairs.lambda[j];
    RITZ_TRY(ritz_first_order_drive(&component->io, damping ? damping : &none,
                                    &modes));
    RITZ_TRY_IN("what lies above the modes",
                add_rest(component, up_to_hz, &pairs, &modes.feed));
    RITZ_TRY(ritz_motion_take_modes(&modes, &m));
    m.highest = nan("");
    *out = m;
    m = (ritz_motion){0};
done:
    ritz_pairs_free(&pairs);
    ritz_first_order_free(&modes);
    ritz_motion_free(&m);
    return status;
}
