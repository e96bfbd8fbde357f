/* Marches: the state of a motion over time, its outputs and energies. */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>

ritz_status ritz_march_new(const ritz_motion *motion,
                           const ritz_integrator *integrator, double step,
                           double rho, ritz_march *out)
{
    RITZ_OWN(ritz_march) march = {.motion = motion, .step = step};

    RITZ_CHECK_NEW(march.x, motion->n);
    if (motion->form != RITZ_FORM_STATES)
        RITZ_CHECK_NEW(march.v, motion->n);
    RITZ_CHECK_IN(integrator->name,
                  integrator->start(motion, step, rho, &march));
    RITZ_MOVE(*out, march);
    return RITZ_OK;
}

void ritz_march_free(ritz_march *march)
{
    if (march->own)
        march->free(march->own);
    RITZ_FREE(march->x, march->v);
    *march = (ritz_march){0};
}

void ritz_march_outputs(const ritz_march *march, const double *u, double *y)
{
    const ritz_motion *m = march->motion;

    if (march->outputs) {
        march->outputs(march, u, y);
        return;
    }
    for (int64_t i = 0; i < m->C.nrow; i++)
        y[i] = 0.0;
    ritz_motion_gemv(&m->C, 1.0, march->x, y);
    if (march->v)
        ritz_motion_gemv(&m->Cv, 1.0, march->v, y);
    ritz_motion_gemv(&m->feed, 1.0, u, y);
}

static double sparse_quadratic(const ritz_sparse *A, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t k = A->colptr[j]; k < A->colptr[j + 1]; k++)
            sum += x[A->rowind[k]] * A->val[k] * x[j];
    return 0.5 * sum;
}

/* sqrt(|K_jj|) |x_j| */
static double find_term(const ritz_motion *m, int64_t j, double x)
{
    double diagonal = 0.0;

    if (m->lambda)
        diagonal = m->lambda[j];
    else if (m->K.val)
        diagonal = ritz_dense_col(&m->K, j)[j];
    for (int64_t k = m->sK.colptr ? m->sK.colptr[j] : 0;
         m->sK.colptr && k < m->sK.colptr[j + 1]; k++)
        if (m->sK.rowind[k] == j)
            diagonal = m->sK.val[k];
    return sqrt(fabs(diagonal)) * fabs(x);
}

/* |x_i K_ij x_j| <= sqrt(K_ii) |x_i| sqrt(K_jj) |x_j| of a K without negative
   eigenvalues. */
double ritz_march_energy_rounding(const ritz_march *march)
{
    double sum = 0.0;

    for (int64_t j = 0; j < march->motion->n; j++)
        sum += find_term(march->motion, j, march->x[j]);
    return DBL_EPSILON * sum * sum;
}

void ritz_march_energy(const ritz_march *march, double *kinetic,
                       double *potential)
{
    const ritz_motion *m = march->motion;

    *kinetic = *potential = 0.0;
    if (march->energy) {
        march->energy(march, kinetic, potential);
        return;
    }
    switch (m->form) {
    case RITZ_FORM_MODAL:
        for (int64_t k = 0; k < m->n; k++) {
            *kinetic += 0.5 * march->v[k] * march->v[k];
            *potential += 0.5 * m->lambda[k] * march->x[k] * march->x[k];
        }
        break;
    case RITZ_FORM_DENSE:
        *kinetic = 0.5 * ritz_motion_form(&m->M, march->v);
        *potential = 0.5 * ritz_motion_form(&m->K, march->x);
        break;
    case RITZ_FORM_SPARSE:
        *kinetic = sparse_quadratic(&m->sM, march->v);
        *potential = sparse_quadratic(&m->sK, march->x);
        break;
    case RITZ_FORM_STATES:
        break;
    }
}
