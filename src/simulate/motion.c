/*
 * Dense models, modal ones and state spaces as motions.
 *
 * Accelerations are written out of the outputs,
 *
 *     x'' = M^-1 (B u - D x' - K x),
 *
 * so that no integrator has to carry them. Ratios of modes become the matrix
 * M Phi diag(2 zeta w) Phi'M. Where M is singular the model goes on in its
 * modes, with what motions without mass answer at once in `feed`.
 */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>

static bool present(const ritz_dense *A)
{
    return A && A->val;
}

/* A += alpha X; A of zeros if it is {0}. */
static ritz_status add(double alpha, const ritz_dense *X, ritz_dense *A)
{
    if (!A->val)
        RITZ_CHECK(ritz_dense_new(X->nrow, X->ncol, A));
    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        A->val[k] += alpha * X->val[k];
    return RITZ_OK;
}

/* D += M Phi Delta Phi'M of ratios alone, or a M + b K. */
static ritz_status add_damping(const ritz_structure *model,
                               const ritz_damping *damping, ritz_dense *D)
{
    ritz_status status = RITZ_OK;
    const ritz_structure bare = {model->K, model->M, {0}};
    ritz_first_order modes = {0};
    ritz_io io = {0};
    ritz_dense MPhiDelta = {0}, part = {0};

    if (damping->kind == RITZ_DAMPING_NONE)
        return RITZ_OK;
    if (ritz_damping_is_rayleigh(damping)) {
        RITZ_TRY(add(damping->a, &model->M, D));
        RITZ_TRY(add(damping->b, &model->K, D));
        goto done;
    }
    RITZ_TRY(ritz_io_new(model->K.nrow, 0, 0, &io));
    RITZ_TRY(ritz_first_order_new(&bare, &io, damping, &modes));
    RITZ_TRY(ritz_dense_mul(&modes.MPhi, &modes.Delta, &MPhiDelta));
    RITZ_TRY(ritz_dense_mul_nt(&MPhiDelta, &modes.MPhi, &part));
    RITZ_TRY(add(1.0, &part, D));
done:
    ritz_first_order_free(&modes);
    ritz_io_free(&io);
    ritz_dense_free(&MPhiDelta);
    ritz_dense_free(&part);
    return status;
}

/* C -= A X */
static ritz_status take(const ritz_dense *A, const ritz_dense *X, ritz_dense *C)
{
    ritz_status status = RITZ_OK;
    ritz_dense AX = {0};

    if (!X->val)
        return RITZ_OK;
    RITZ_TRY(ritz_dense_mul(A, X, &AX));
    RITZ_TRY(add(-1.0, &AX, C));
done:
    ritz_dense_free(&AX);
    return status;
}

/* Accelerations out of the outputs, by W = Ca M^-1. */
static ritz_status write_out(const ritz_dense *Ca, ritz_motion *m)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0}, W = {0}, feed = {0};

    if (ritz_dense_max(Ca) == 0.0)
        return RITZ_OK;
    RITZ_TRY(ritz_general_transpose(Ca, &X));
    RITZ_TRY_IN("M", ritz_general_solve(&m->M, true, &X));
    RITZ_TRY(ritz_general_transpose(&X, &W));
    RITZ_TRY(take(&W, &m->K, &m->C));
    RITZ_TRY(take(&W, &m->D, &m->Cv));
    RITZ_TRY(ritz_dense_mul(&W, &m->B, &feed));
    RITZ_TRY(add(1.0, &feed, &m->feed));
done:
    ritz_dense_free(&X);
    ritz_dense_free(&W);
    ritz_dense_free(&feed);
    return status;
}

/* B, C, Cv, feed and push of full matrices. */
static ritz_status drive(const ritz_io *io, ritz_motion *m)
{
    RITZ_CHECK(ritz_dense_copy(&io->B, &m->B));
    RITZ_CHECK(ritz_dense_copy(&io->C, &m->C));
    RITZ_CHECK(ritz_dense_copy(&io->Cv, &m->Cv));
    RITZ_CHECK(ritz_dense_new(io->num_outputs, io->num_inputs, &m->feed));
    RITZ_CHECK(ritz_dense_copy(&io->B, &m->push));
    RITZ_CHECK_IN("M", ritz_general_solve(&m->M, false, &m->push));
    return write_out(&io->Ca, m);
}

/* Lambda and I as matrices. */
static ritz_status fill_out(ritz_motion *m)
{
    RITZ_CHECK(ritz_dense_new(m->n, m->n, &m->K));
    RITZ_CHECK(ritz_dense_new(m->n, m->n, &m->M));
    for (int64_t j = 0; j < m->n; j++) {
        ritz_dense_col(&m->K, j)[j] = m->lambda[j];
        ritz_dense_col(&m->M, j)[j] = 1.0;
    }
    if (ritz_dense_max(&m->D) == 0.0)
        ritz_dense_free(&m->D);
    m->form = RITZ_FORM_DENSE;
    return RITZ_OK;
}

static ritz_status fill_dense(const ritz_structure *s, const ritz_io *io,
                              const ritz_damping *damping, ritz_motion *m)
{
    m->form = RITZ_FORM_DENSE;
    m->n = m->original = s->K.nrow;
    RITZ_CHECK(ritz_dense_copy(&s->K, &m->K));
    RITZ_CHECK(ritz_dense_copy(&s->M, &m->M));
    if (s->D.val)
        RITZ_CHECK(ritz_dense_copy(&s->D, &m->D));
    RITZ_CHECK(add_damping(s, damping, &m->D));
    return drive(io, m);
}

ritz_status ritz_motion_dense(const ritz_second_order *model,
                              const ritz_damping *damping, bool modal,
                              ritz_motion *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    /* borrowed */
    const ritz_structure s = {*model->K, *model->M,
                              present(model->D) ? *model->D : (ritz_dense){0}};
    ritz_first_order modes = {0};
    ritz_motion m = {0};
    double highest = 0.0;

    damping = damping ? damping : &none;
    RITZ_TRY(ritz_motion_refuse_structural(present(model->K4) &&
                                           ritz_dense_max(model->K4) > 0.0));
    RITZ_TRY(ritz_first_order_new(&s, model->io, damping, &modes));
    for (int64_t j = 0; j < modes.count; j++)
        highest = fmax(highest, fabs(modes.lambda[j]));
    if (modal || modes.count < modes.num_dofs) {
        RITZ_TRY(ritz_motion_take_modes(&modes, &m));
        if (!modal)
            RITZ_TRY(fill_out(&m));
    } else {
        RITZ_TRY(fill_dense(&s, model->io, damping, &m));
    }
    m.highest = highest;
    *out = m;
    m = (ritz_motion){0};
done:
    ritz_first_order_free(&modes);
    ritz_motion_free(&m);
    return status;
}

ritz_status ritz_motion_states(const ritz_state_space *model, ritz_motion *out)
{
    ritz_status status = RITZ_OK;
    ritz_motion m = {.form = RITZ_FORM_STATES, .highest = nan("")};

    m.n = m.original = model->A.nrow;
    RITZ_TRY(ritz_dense_copy(&model->A, &m.A));
    RITZ_TRY(ritz_dense_copy(&model->B, &m.B));
    RITZ_TRY(ritz_dense_copy(&model->C, &m.C));
    RITZ_TRY(ritz_dense_copy(&model->D, &m.feed));
    if (model->E.val) {
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &m.A));
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &m.B));
    }
    RITZ_TRY(ritz_dense_copy(&m.B, &m.push));
    *out = m;
    m = (ritz_motion){0};
done:
    ritz_motion_free(&m);
    return status;
}

ritz_status ritz_motion_new(const ritz_simulated *subject,
                            const ritz_simulation_request *request,
                            ritz_motion *out)
{
    const ritz_integrator *integrator = request->integrator;
    bool modal = integrator == &ritz_integrator_modal;

    if (subject->states) {
        RITZ_REFUSE_IF(!integrator->takes_states, RITZ_ERR_ARGUMENT,
                       "'%s' is of second-order models, a state space goes by "
                       "modal or trapezoidal",
                       integrator->name);
        return ritz_motion_states(subject->states, out);
    }
    if (subject->model)
        return ritz_motion_dense(subject->model, subject->damping, modal, out);
    if (modal)
        return ritz_motion_modes(subject->component, subject->damping,
                                 request->up_to_hz, out);
    RITZ_REFUSE_IF(!integrator->takes_sparse, RITZ_ERR_ARGUMENT,
                   "'%s' is of small dense models: a full component goes by "
                   "modal, trapezoidal or generalised-alpha",
                   integrator->name);
    return ritz_motion_sparse(subject->component, subject->damping, out);
    return RITZ_OK;
}

void ritz_motion_free(ritz_motion *motion)
{
    enum { MATRICES = 10 };
    ritz_dense *const dense[MATRICES] = {
        &motion->K, &motion->M,  &motion->D,    &motion->A,    &motion->B,
        &motion->C, &motion->Cv, &motion->feed, &motion->push, &motion->to};

    free(motion->lambda);
    free(motion->massless);
    for (int k = 0; k < MATRICES; k++)
        ritz_dense_free(dense[k]);
    ritz_sparse_free(&motion->sK);
    ritz_sparse_free(&motion->sM);
    ritz_sparse_free(&motion->sD);
    *motion = (ritz_motion){0};
}
