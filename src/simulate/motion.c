/*
 * Dense models, modal ones and state spaces as motions.
 *
 * Accelerations are written out of the outputs,
 *
 *     x'' = M^-1 (B u - D x' - K x),
 *
 * so that no integrator has to carry them. Ratios of modes become the matrix
 * M Phi diag(2 zeta w) Phi'M. Where M is singular the model goes on in its
 * modes, with the static response of motions without mass in `feed`.
 */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "linear/general.h"
#include "poles/poles.h"

#include <ritz/matrix.h>

#include <math.h>

/* Modes as a motion: of a dense model, or of a full component up to a band. */

/* The sentence that refuses structural damping, if it is there. */
static ritz_status refuse_structural(bool there)
{
    RITZ_REFUSE_IF(
        there, RITZ_ERR_ARGUMENT,
        "structural damping is of harmonic motion alone, in time it "
        "would respond before the force acts: give it as a modal ratio");
    return RITZ_OK;
}

ritz_status ritz_motion_take(ritz_modal_model *modes, ritz_motion *m)
{
    m->form = RITZ_FORM_MODAL;
    m->n = modes->count;
    m->original = modes->num_dofs;
    m->num_rigid = modes->num_rigid;
    RITZ_CHECK(ritz_dense_copy(&modes->B, &m->push));
    RITZ_MOVE(m->lambda, modes->lambda);
    RITZ_MOVE(m->D, modes->Delta);
    RITZ_MOVE(m->B, modes->B);
    RITZ_MOVE(m->C, modes->C);
    RITZ_MOVE(m->Cv, modes->Cv);
    RITZ_MOVE(m->feed, modes->feed);
    RITZ_MOVE(m->to, modes->MPhi);
    return RITZ_OK;
}

/* Modal, up to a frequency, with the static response of all above in `feed`. */
static ritz_status motion_of_modes(const ritz_component *component,
                                   const ritz_damping *damping, double up_to_hz,
                                   ritz_motion *out)
{
    static const ritz_damping none = {0};
    const ritz_span span = {.modes = -1, .up_to_hz = up_to_hz};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_residual) rest = {0};
    RITZ_OWN(ritz_motion) m = {0};

    RITZ_REFUSE_IF(!(up_to_hz > 0.0), RITZ_ERR_ARGUMENT,
                   "no frequency is given up to which modes are to be found: "
                   "--up-to-hz");
    RITZ_CHECK(refuse_structural(component->K4.colptr &&
                                 ritz_sparse_max(&component->K4) > 0.0));
    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &span, &pairs));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &pairs.Phi, &modes.MPhi));
    RITZ_CHECK(ritz_sparse_project(&component->D, &pairs.Phi, &modes.Delta));
    if (pairs.Phi.ncol < component->num_dofs) /* the first term of a series */
        RITZ_CHECK_IN(
            "what lies above the modes",
            ritz_residual_new(component, NULL, &pairs, 0.0, up_to_hz, &rest));
    ritz_modal_model_take(&pairs, component->num_dofs, &modes);
    RITZ_CHECK(ritz_modal_model_drive(&component->io, damping ? damping : &none,
                                      &modes));
    for (int64_t k = 0;
         rest.count > 0 && k < rest.num_outputs * rest.num_inputs; k++)
        modes.feed.val[k] += rest.part[0][k];
    RITZ_CHECK(ritz_motion_take(&modes, &m));
    m.highest = nan("");
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

/*
 * A full component as a motion, for implicit integrators.
 *
 * Dofs without mass (rows empty in M) are in equilibrium at every step's end;
 * at the start they are put there by the simulation. D must leave them alone.
 */

static ritz_status check_sparse(const ritz_component *component,
                                const ritz_damping *damping,
                                const bool *massless, const ritz_sparse *D)
{
    const ritz_io *io = &component->io;

    RITZ_CHECK(refuse_structural(component->K4.colptr &&
                                 ritz_sparse_max(&component->K4) > 0.0));
    RITZ_REFUSE_IF(damping->kind != RITZ_DAMPING_NONE &&
                       !ritz_damping_is_rayleigh(damping),
                   RITZ_ERR_ARGUMENT,
                   "damping ratios are of modes, which an implicit integrator "
                   "does not find: use modal, or rayleigh damping");
    for (int64_t k = 0; D->colptr && k < D->colptr[D->ncol]; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        RITZ_REFUSE_IF(D->val[k] != 0.0 && massless[D->rowind[k]],
                       RITZ_ERR_ARGUMENT,
                       "%s has damping and no mass: condense it first",
                       ritz_dof_name(component->dof[D->rowind[k]], name));
    }
    for (int64_t j = 0; j < component->num_dofs; j++)
        for (int64_t i = 0; massless[j] && i < io->num_outputs; i++)
            RITZ_REFUSE_IF(
                ritz_dense_col(&io->Cv, j)[i] != 0.0 ||
                    ritz_dense_col(&io->Ca, j)[i] != 0.0,
                RITZ_ERR_ARGUMENT,
                "output '%s' is the velocity or acceleration of a dof "
                "without mass",
                io->output[i]);
    return RITZ_OK;
}

/* C - Ca M^-1 K and so on: Z = M^-1 Ca', C -= Z'K. */
static ritz_status write_out_sparse(const ritz_io *io, ritz_effective *mass,
                                    ritz_motion *m)
{
    RITZ_OWN(ritz_dense) z = {0};
    RITZ_OWN_ARRAY double *row = NULL;

    RITZ_CHECK_NEW(row, m->n);
    RITZ_CHECK(ritz_dense_new(m->n, 1, &z));
    for (int64_t i = 0; i < io->num_outputs; i++) {
        for (int64_t k = 0; k < m->n; k++)
            z.val[k] = ritz_dense_col(&io->Ca, k)[i];
        if (ritz_dense_max(&z) == 0.0)
            continue;
        RITZ_CHECK(ritz_effective_solve(mass, 1, z.val));
        for (int64_t j = 0; j < io->num_inputs; j++)
            ritz_dense_col(&m->feed, j)[i] +=
                ritz_motion_dot(m->n, z.val, ritz_dense_col(&m->B, j));
        for (int64_t k = 0; k < m->n; k++)
            row[k] = 0.0;
        ritz_motion_add(m, RITZ_STIFFNESS, -1.0, z.val,
                        row); /* K is symmetric */
        for (int64_t k = 0; k < m->n; k++)
            ritz_dense_col(&m->C, k)[i] += row[k];
        for (int64_t k = 0; m->sD.colptr && k < m->n; k++)
            for (int64_t e = m->sD.colptr[k]; e < m->sD.colptr[k + 1]; e++)
                ritz_dense_col(&m->Cv, k)[i] -=
                    z.val[m->sD.rowind[e]] * m->sD.val[e];
    }
    return RITZ_OK;
}

/* Dofs without mass do not jump by an impulse. */
static ritz_status find_push(ritz_effective *mass, ritz_motion *m)
{
    RITZ_CHECK(ritz_dense_copy(&m->B, &m->push));
    for (int64_t j = 0; j < m->push.ncol; j++)
        for (int64_t k = 0; k < m->n; k++)
            if (m->massless[k])
                ritz_dense_col(&m->push, j)[k] = 0.0;
    return ritz_effective_solve(mass, m->push.ncol, m->push.val);
}

static ritz_status fill_sparse(const ritz_component *component,
                               const ritz_damping *damping, ritz_motion *m)
{
    const ritz_io *io = &component->io;

    m->n = m->original = component->num_dofs;
    RITZ_CHECK_NEW(m->massless, m->n);
    RITZ_CHECK(ritz_sparse_copy(&component->K, &m->sK));
    RITZ_CHECK(ritz_sparse_copy(&component->M, &m->sM));
    for (int64_t j = 0; j < m->n; j++)
        m->massless[j] = true;
    for (int64_t k = 0; k < m->sM.colptr[m->n]; k++)
        if (m->sM.val[k] != 0.0)
            m->massless[m->sM.rowind[k]] = false;
    if (ritz_damping_is_rayleigh(damping))
        RITZ_CHECK(ritz_damping_matrix(component, damping, &m->sD));
    else if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, &m->sD));
    RITZ_CHECK(check_sparse(component, damping, m->massless, &m->sD));
    RITZ_CHECK(ritz_dense_copy(&io->B, &m->B));
    RITZ_CHECK(ritz_dense_copy(&io->C, &m->C));
    RITZ_CHECK(ritz_dense_copy(&io->Cv, &m->Cv));
    return ritz_dense_new(io->num_outputs, io->num_inputs, &m->feed);
}

static ritz_status motion_of_sparse(const ritz_component *component,
                                    const ritz_damping *damping,
                                    ritz_motion *out)
{
    static const ritz_damping none = {0};
    RITZ_OWN(ritz_motion) m = {.form = RITZ_FORM_SPARSE, .highest = nan("")};
    RITZ_OWN(ritz_effective) mass = {0};

    RITZ_CHECK(fill_sparse(component, damping ? damping : &none, &m));
    RITZ_CHECK_IN("M", ritz_effective_new(&m, 1.0, 0.0, 0.0, true, &mass));
    RITZ_CHECK(find_push(&mass, &m));
    RITZ_CHECK(write_out_sparse(&component->io, &mass, &m));
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

static bool is_present(const ritz_dense *A)
{
    return A && A->val;
}

/* Accelerations out of the outputs, by W = Ca M^-1. */
static ritz_status write_out(const ritz_dense *Ca, ritz_motion *m)
{
    RITZ_OWN(ritz_dense) X = {0}, W = {0}, feed = {0}, WK = {0}, WD = {0};

    if (ritz_dense_max(Ca) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_general_transpose(Ca, &X));
    RITZ_CHECK_IN("M", ritz_general_solve_scaled(&m->M, true, &X));
    RITZ_CHECK(ritz_general_transpose(&X, &W));
    RITZ_CHECK(ritz_dense_mul(&W, &m->K, &WK));
    ritz_dense_add(-1.0, &WK, &m->C);
    if (m->D.val) {
        RITZ_CHECK(ritz_dense_mul(&W, &m->D, &WD));
        ritz_dense_add(-1.0, &WD, &m->Cv);
    }
    RITZ_CHECK(ritz_dense_mul(&W, &m->B, &feed));
    ritz_dense_add(1.0, &feed, &m->feed);
    return RITZ_OK;
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
    RITZ_CHECK(ritz_modal_damping(s, damping, &m->D));
    RITZ_CHECK(ritz_dense_copy(&io->B, &m->B));
    RITZ_CHECK(ritz_dense_copy(&io->C, &m->C));
    RITZ_CHECK(ritz_dense_copy(&io->Cv, &m->Cv));
    RITZ_CHECK(ritz_dense_new(io->num_outputs, io->num_inputs, &m->feed));
    RITZ_CHECK(ritz_dense_copy(&io->B, &m->push));
    RITZ_CHECK_IN("M", ritz_general_solve_scaled(&m->M, false, &m->push));
    return write_out(&io->Ca, m);
}

ritz_status ritz_motion_dense(ritz_model subject, bool modal, ritz_motion *out)
{
    static const ritz_damping none = {0};
    const ritz_second_order *model = &subject.dense;
    const ritz_damping *damping = subject.damping ? subject.damping : &none;
    /* borrowed */
    const ritz_structure s = {*model->K, *model->M,
                              is_present(model->D) ? *model->D
                                                   : (ritz_dense){0}};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_motion) m = {0};
    double highest = 0.0;

    RITZ_CHECK(refuse_structural(is_present(model->K4) &&
                                 ritz_dense_max(model->K4) > 0.0));
    RITZ_CHECK(ritz_modal_model_new(&s, model->io, damping, &modes));
    for (int64_t j = 0; j < modes.count; j++)
        highest = fmax(highest, fabs(modes.lambda[j]));
    if (modal || modes.count < modes.num_dofs) {
        RITZ_CHECK(ritz_motion_take(&modes, &m));
        if (!modal)
            RITZ_CHECK(fill_out(&m));
    } else {
        RITZ_CHECK(fill_dense(&s, model->io, damping, &m));
    }
    m.highest = highest;
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

static ritz_status motion_of_states(const ritz_state_space *model,
                                    ritz_motion *out)
{
    RITZ_OWN(ritz_motion) m = {.form = RITZ_FORM_STATES, .highest = nan("")};
    RITZ_OWN(ritz_state_space) made = {0};

    RITZ_CHECK(ritz_state_space_dense(model, &made, &model));
    m.n = m.original = model->A.nrow;
    RITZ_CHECK(ritz_dense_copy(&model->A, &m.A));
    RITZ_CHECK(ritz_dense_copy(&model->B, &m.B));
    RITZ_CHECK(ritz_dense_copy(&model->C, &m.C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &m.feed));
    if (model->E.val) {
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &m.A));
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &m.B));
    }
    RITZ_CHECK(ritz_dense_copy(&m.B, &m.push));
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

ritz_status ritz_motion_new(ritz_model subject,
                            const ritz_simulation_request *request,
                            ritz_motion *out)
{
    const ritz_integrator *integrator = request->integrator;
    bool modal = integrator == &ritz_integrator_modal;

    if (subject.kind == RITZ_MODEL_STATES) {
        RITZ_REFUSE_IF(!integrator->takes_states, RITZ_ERR_ARGUMENT,
                       "'%s' is of second-order models, a state space goes by "
                       "modal or trapezoidal",
                       integrator->name);
        return motion_of_states(subject.states, out);
    }
    if (subject.kind == RITZ_MODEL_DENSE)
        return ritz_motion_dense(subject, true, out);
    if (modal)
        return motion_of_modes(subject.component, subject.damping,
                               request->up_to_hz, out);
    RITZ_REFUSE_IF(!integrator->takes_sparse, RITZ_ERR_ARGUMENT,
                   "'%s' is of small dense models: a full component goes by "
                   "modal, trapezoidal or generalised-alpha",
                   integrator->name);
    return motion_of_sparse(subject.component, subject.damping, out);
}

ritz_status ritz_motion_full(ritz_model subject,
                             const ritz_simulation_request *request,
                             ritz_motion *out)
{
    const bool modal = request->integrator == &ritz_integrator_modal;

    return subject.kind == RITZ_MODEL_DENSE
               ? ritz_motion_dense(subject, modal, out)
               : ritz_motion_new(subject, request, out);
}

void ritz_motion_free(ritz_motion *motion)
{
    enum { MATRICES = 10 };
    ritz_dense *const dense[MATRICES] = {
        &motion->K, &motion->M,  &motion->D,    &motion->A,    &motion->B,
        &motion->C, &motion->Cv, &motion->feed, &motion->push, &motion->to};

    RITZ_FREE(motion->lambda, motion->massless);
    for (int k = 0; k < MATRICES; k++)
        ritz_dense_free(dense[k]);
    ritz_sparse_free(&motion->sK);
    ritz_sparse_free(&motion->sM);
    ritz_sparse_free(&motion->sD);
    *motion = (ritz_motion){0};
}
