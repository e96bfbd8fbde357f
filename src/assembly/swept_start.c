/* The state at the start of a sweep, in its basis. */
#include "assembly/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>

/* Eigenvalues and number of rigid motions among the modes in which x0 is. */
static ritz_status copy_modes(int64_t count, int64_t rigid,
                              const double *lambda, ritz_swept_model *m)
{
    m->start_rigid = rigid;
    RITZ_CHECK_COPY(m->start_lambda, lambda, count);
    for (int64_t k = 0; k < rigid && k < count; k++)
        m->start_lambda[k] = 0.0;
    return RITZ_OK;
}

/* start = sum_c P_c'M_c V_c T_c over the bodies of the stage `origin`, in whose
   modes x0 is; P_c and M_c are of that stage. */
static ritz_status start_from(const ritz_sweeper *w, const ritz_dense *T,
                              ritz_swept_model *m)
{
    const ritz_stage *origin = w->asked->origin;
    RITZ_OWN(ritz_configuration) c = {0};

    RITZ_CHECK(ritz_stage_assemble(origin, w->asked->setting, &c));
    RITZ_CHECK(copy_modes(c.K.ncol, c.num_rigid, c.lambda, m));
    RITZ_CHECK(ritz_dense_copy(&c.io.B, &m->start_B));
    RITZ_CHECK(ritz_dense_new(c.K.ncol, m->order, &m->start));
    for (int64_t k = 0; k < origin->count; k++) {
        RITZ_OWN(ritz_dense) part = {0}, VT = {0}, MVT = {0}, own = {0};

        RITZ_CHECK(ritz_dense_block(T, w->stage->first[k], w->asked->V[k].ncol,
                                    0, m->order, &part));
        RITZ_CHECK(ritz_dense_mul(&w->asked->V[k], &part, &VT));
        RITZ_CHECK(ritz_dense_mul(&origin->body[k].M, &VT, &MVT));
        RITZ_CHECK(ritz_dense_mul_tn(&c.P[k], &MVT, &own));
        ritz_dense_add(1.0, &own, &m->start);
    }
    return RITZ_OK;
}

/* The matrix that gives q for x0 at the start, and the modes there. */
ritz_status ritz_sweep_start(const ritz_sweeper *w, ritz_swept_model *m)
{
    const double x = m->unit * w->asked->setting[w->asked->sweep];
    RITZ_OWN(ritz_sweep_grid) one = {0};
    RITZ_OWN(ritz_dense) F = {0}, T = {0};
    const ritz_sweep_knot *k = NULL;

    RITZ_CHECK(ritz_sweep_one(w, x, &one));
    k = &one.knot[0];
    RITZ_CHECK(ritz_swept_values(m, x, &F));
    RITZ_CHECK(ritz_dense_block(&F, 0, m->M.nrow, 0, m->order, &T));
    if (k->rigid < m->order)
        m->start_hz[0] = sqrt(k->lambda[k->rigid]) / (2.0 * RITZ_PI);
    m->start_hz[1] = sqrt(fmax(k->lambda[m->order - 1], 0.0)) / (2.0 * RITZ_PI);
    if (w->asked->origin) {
        RITZ_CHECK(ritz_stage_expansion(w->stage, w->asked->V, &m->V));
        return start_from(w, &T, m);
    }
    RITZ_CHECK(copy_modes(k->V.ncol, k->rigid, k->lambda, m));
    RITZ_CHECK(ritz_dense_mul_tn(&k->V, &m->io.B, &m->start_B));
    return ritz_sweep_correlate(&k->V, &m->M, &T, &m->start);
}
