/*
 * A full component as a motion, for implicit integrators.
 *
 * Dofs without mass (rows empty in M) are in equilibrium at every step's end;
 * at the start they are put there by the simulation. D must leave them alone.
 */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* Rows in which A has nothing but zeros. */
static void find_empty(const ritz_sparse *A, bool *out)
{
    for (int64_t j = 0; j < A->ncol; j++)
        out[j] = true;
    for (int64_t k = 0; k < A->colptr[A->ncol]; k++)
        if (A->val[k] != 0.0)
            out[A->rowind[k]] = false;
}

static ritz_status check(const ritz_component *component,
                         const ritz_damping *damping, const bool *massless,
                         const ritz_sparse *D)
{
    const ritz_io *io = &component->io;

    RITZ_CHECK(ritz_motion_refuse_structural(
        component->K4.colptr && ritz_sparse_max(&component->K4) > 0.0));
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
static ritz_status write_out(const ritz_io *io, ritz_effective *mass,
                             ritz_motion *m)
{
    ritz_status status = RITZ_OK;
    ritz_dense z = {0};
    double *row = NULL;

    RITZ_NEW(row, m->n);
    RITZ_TRY(ritz_dense_new(m->n, 1, &z));
    for (int64_t i = 0; i < io->num_outputs; i++) {
        for (int64_t k = 0; k < m->n; k++)
            z.val[k] = ritz_dense_col(&io->Ca, k)[i];
        if (ritz_dense_max(&z) == 0.0)
            continue;
        RITZ_TRY(ritz_effective_solve(mass, 1, z.val));
        for (int64_t j = 0; j < io->num_inputs; j++)
            ritz_dense_col(&m->feed, j)[i] +=
                ritz_motion_dot(m->n, z.val, ritz_dense_col(&m->B, j));
        for (int64_t k = 0; k < m->n; k++)
            row[k] = 0.0;
        ritz_motion_stiffness(m, -1.0, z.val, row); /* K is symmetric */
        for (int64_t k = 0; k < m->n; k++)
            ritz_dense_col(&m->C, k)[i] += row[k];
        for (int64_t k = 0; m->sD.colptr && k < m->n; k++)
            for (int64_t e = m->sD.colptr[k]; e < m->sD.colptr[k + 1]; e++)
                ritz_dense_col(&m->Cv, k)[i] -=
                    z.val[m->sD.rowind[e]] * m->sD.val[e];
    }
done:
    free(row);
    ritz_dense_free(&z);
    return status;
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

static ritz_status fill(const ritz_component *component,
                        const ritz_damping *damping, ritz_motion *m)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &component->io;
    ritz_sparse D = {0};

    m->n = m->original = component->num_dofs;
    RITZ_NEW(m->massless, m->n);
    RITZ_TRY(ritz_sparse_copy(&component->K, &m->sK));
    RITZ_TRY(ritz_sparse_copy(&component->M, &m->sM));
    find_empty(&m->sM, m->massless);
    if (component->D.colptr)
        RITZ_TRY(ritz_sparse_copy(&component->D, &m->sD));
    if (ritz_damping_is_rayleigh(damping)) {
        RITZ_TRY(ritz_sparse_add(damping->a, &m->sM, damping->b, &m->sK, &D));
        if (m->sD.colptr) {
            ritz_sparse sum = {0};

            RITZ_TRY(ritz_sparse_add(1.0, &D, 1.0, &m->sD, &sum));
            ritz_sparse_free(&m->sD);
            m->sD = sum;
        } else {
            m->sD = D;
            D = (ritz_sparse){0};
        }
    }
    RITZ_TRY(check(component, damping, m->massless, &m->sD));
    RITZ_TRY(ritz_dense_copy(&io->B, &m->B));
    RITZ_TRY(ritz_dense_copy(&io->C, &m->C));
    RITZ_TRY(ritz_dense_copy(&io->Cv, &m->Cv));
    RITZ_TRY(ritz_dense_new(io->num_outputs, io->num_inputs, &m->feed));
done:
    ritz_sparse_free(&D);
    return status;
}

ritz_status ritz_motion_sparse(const ritz_component *component,
                               const ritz_damping *damping, ritz_motion *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    ritz_motion m = {.form = RITZ_FORM_SPARSE, .highest = nan("")};
    ritz_effective mass = {0};

    RITZ_TRY(fill(component, damping ? damping : &none, &m));
    RITZ_TRY_IN("M", ritz_effective_new(&m, 1.0, 0.0, 0.0, true, &mass));
    RITZ_TRY(find_push(&mass, &m));
    RITZ_TRY(write_out(&component->io, &mass, &m));
    *out = m;
    m = (ritz_motion){0};
done:
    ritz_effective_free(&mass);
    ritz_motion_free(&m);
    return status;
}
