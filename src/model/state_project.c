/*
 * A component of many dofs in a basis of states, without its modes:
 *
 *     W'E T = W_q'T_q + W_v'M T_v,   W'A T = W_q'T_v - W_v'F,
 *     F = K T_q + (D + a M + b K + M Phi diag(2 zeta w) Phi'M) T_v
 *
 * with Phi the modes of which the vectors are made, where damping is by ratios.
 * Accelerations are M u'' = B f - F z, so that with M Y = Ca'
 *
 *     y = (C T_q + Cv T_v - Y'F) z + Y'B f
 *
 * Rigid motion costs no energy: K u is zero there, and so is u'K.
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "model/modal.h"
#include "model/state_reduce.h"

#include <ritz/matrix.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>

/* Halves of T and W, and forces F; K and D hold the dampers. */
typedef struct large {
    const ritz_component *component;
    const ritz_columns *columns;
    ritz_sparse K, D;
    ritz_dense T_q, T_v, W_q, W_v;
    ritz_dense KT, F; /* K T_q; all of it */
} large;

static void large_free(large *m)
{
    ritz_sparse_free(&m->K);
    ritz_sparse_free(&m->D);
    ritz_dense_free(&m->T_q);
    ritz_dense_free(&m->T_v);
    ritz_dense_free(&m->W_q);
    ritz_dense_free(&m->W_v);
    ritz_dense_free(&m->KT);
    ritz_dense_free(&m->F);
}

static ritz_status take_halves(const ritz_dense *T, ritz_dense *upper,
                               ritz_dense *lower)
{
    int64_t n = T->nrow / 2;

    RITZ_CHECK(ritz_dense_new(n, T->ncol, upper));
    RITZ_CHECK(ritz_dense_new(n, T->ncol, lower));
    ritz_dense_cut(T, 0, 0, upper);
    ritz_dense_cut(T, n, 0, lower);
    return RITZ_OK;
}

static ritz_status install_dampers(const ritz_component *component, large *m)
{
    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    return ritz_structure_sparse(component, NULL, &m->K, &m->D);
}

static bool is_rigid(const large *m, int64_t j)
{
    return m->columns->kind[j] == RITZ_COLUMN_RIGID;
}

/* Y := K X but for rigid columns. */
static ritz_status stiffness_times(const large *m, const ritz_dense *X,
                                   ritz_dense *Y)
{
    RITZ_CHECK(ritz_sparse_mul(&m->K, X, Y));
    for (int64_t j = 0; j < Y->ncol; j++)
        for (int64_t i = 0; i < Y->nrow && is_rigid(m, j); i++)
            ritz_dense_col(Y, j)[i] = 0.0;
    return RITZ_OK;
}

/* F += M Phi diag(2 zeta w) Phi'M T_v */
static ritz_status add_ratios(const ritz_damping *damping, double among_hz,
                              const ritz_dense *MT, large *m)
{
    const ritz_sparse *M = &m->component->M;
    const ritz_span span = {-1, among_hz};
    RITZ_OWN(ritz_pairs) modes = {0};
    RITZ_OWN(ritz_dense) q = {0}, rate = {0}, force = {0};

    RITZ_REFUSE_IF(!(among_hz > 0.0), RITZ_ERR_ARGUMENT,
                   "damping ratios need all modes of %" PRId64
                   " dofs: state damping as rayleigh or fit, or choose modes "
                   "up to a frequency",
                   m->component->num_dofs);
    RITZ_CHECK_IN("damping ratios", ritz_eigen_sparse(&m->K, M, &span, &modes));
    RITZ_CHECK(ritz_dense_mul_tn(&modes.Phi, MT, &q));
    for (int64_t j = 0; j < q.ncol; j++)
        for (int64_t k = 0; k < q.nrow; k++)
            ritz_dense_col(&q, j)[k] *=
                ritz_modal_rate(damping, k - modes.num_rigid, modes.lambda[k]);
    RITZ_CHECK(ritz_dense_mul(&modes.Phi, &q, &rate));
    RITZ_CHECK(ritz_sparse_mul(M, &rate, &force));
    ritz_dense_add(1.0, &force, &m->F);
    return RITZ_OK;
}

/* F, once K T_q is there. */
static ritz_status add_damping(const ritz_damping *damping, double among_hz,
                               const ritz_dense *MT, large *m)
{
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(ritz_dense_copy(&m->KT, &m->F));
    if (m->D.colptr) {
        RITZ_CHECK(ritz_sparse_mul(&m->D, &m->T_v, &part));
        ritz_dense_add(1.0, &part, &m->F);
    }
    if (ritz_damping_is_rayleigh(damping)) {
        ritz_dense_free(&part);
        RITZ_CHECK(stiffness_times(m, &m->T_v, &part));
        ritz_dense_add(damping->b, &part, &m->F);
        ritz_dense_add(damping->a, MT, &m->F);
    } else if (damping->kind != RITZ_DAMPING_NONE) {
        RITZ_CHECK(add_ratios(damping, among_hz, MT, m));
    }
    return RITZ_OK;
}

/* S := |X|'|Y| */
static ritz_status multiply_magnitudes(const ritz_dense *X, const ritz_dense *Y,
                                       ritz_dense *S)
{
    RITZ_OWN(ritz_dense) x = {0}, y = {0};

    RITZ_CHECK(ritz_dense_abs(X, &x));
    RITZ_CHECK(ritz_dense_abs(Y, &y));
    return ritz_dense_mul_tn(&x, &y, S);
}

/*
 * Of A = U'X +- V'Y, what is rounding between rigid motion and the rest is
 * nothing: rigid motion stands apart.
 */
static ritz_status settle_rigid(const large *m, const ritz_dense *const left[2],
                                const ritz_dense *const right[2], ritz_dense *A)
{
    double rounding = (double)(left[0]->nrow + 64) * DBL_EPSILON;
    RITZ_OWN(ritz_dense) first = {0}, second = {0};

    RITZ_CHECK(multiply_magnitudes(left[0], right[0], &first));
    RITZ_CHECK(multiply_magnitudes(left[1], right[1], &second));
    ritz_dense_add(1.0, &second, &first);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            if (is_rigid(m, i) != is_rigid(m, j) &&
                fabs(ritz_dense_col(A, j)[i]) <=
                    rounding * ritz_dense_col(&first, j)[i])
                ritz_dense_col(A, j)[i] = 0.0;
    return RITZ_OK;
}

/* A := W_q'T_v - W_v'F, where rigid rows see nothing of K. */
static ritz_status project_forces(const large *m, ritz_dense *A)
{
    RITZ_OWN(ritz_dense) WF = {0}, WK = {0};

    ritz_dense_free(A);
    RITZ_CHECK(ritz_dense_mul_tn(&m->W_q, &m->T_v, A));
    RITZ_CHECK(ritz_dense_mul_tn(&m->W_v, &m->F, &WF));
    RITZ_CHECK(ritz_dense_mul_tn(&m->W_v, &m->KT, &WK));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] -=
                ritz_dense_col(&WF, j)[i] -
                (is_rigid(m, i) ? ritz_dense_col(&WK, j)[i] : 0.0);
    return settle_rigid(m, (const ritz_dense *[]){&m->W_q, &m->W_v},
                        (const ritz_dense *[]){&m->T_v, &m->F}, A);
}

/* C := C - Y'F, D := Y'B; M Y = Ca' */
static ritz_status fill_accelerations(const large *m, ritz_state_space *out)
{
    const ritz_io *io = &m->component->io;
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) Y = {0}, part = {0};
    ritz_status status = RITZ_OK;

    if (ritz_dense_max(&io->Ca) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_general_transpose(&io->Ca, &Y));
    status = ritz_factor_spd(&m->component->M, &L);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_ARGUMENT,
                   "accelerations are seen of a component with massless dofs: "
                   "condense them first");
    RITZ_CHECK(status);
    RITZ_CHECK(ritz_factor_solve(L, &Y));
    RITZ_CHECK(ritz_dense_mul_tn(&Y, &m->F, &part));
    ritz_dense_add(-1.0, &part, &out->C);
    ritz_dense_free(&part);
    RITZ_CHECK(ritz_dense_mul_tn(&Y, &io->B, &part));
    ritz_dense_add(1.0, &part, &out->D);
    return RITZ_OK;
}

static ritz_status fill_outputs(const large *m, ritz_state_space *out)
{
    const ritz_io *io = &m->component->io;
    RITZ_OWN(ritz_dense) rate = {0};

    ritz_dense_free(&out->B);
    ritz_dense_free(&out->C);
    RITZ_CHECK(ritz_dense_mul_tn(&m->W_v, &io->B, &out->B));
    RITZ_CHECK(ritz_dense_mul(&io->C, &m->T_q, &out->C));
    RITZ_CHECK(ritz_dense_mul(&io->Cv, &m->T_v, &rate));
    ritz_dense_add(1.0, &rate, &out->C);
    return fill_accelerations(m, out);
}

/* What massless dofs answer at once would need more than the vectors. */
static ritz_status refuse_massless_inputs(const ritz_component *component)
{
    const ritz_io *io = &component->io;

    for (int64_t j = 0; j < io->num_inputs; j++)
        for (int64_t i = 0; i < component->num_dofs; i++)
            RITZ_REFUSE_IF(
                ritz_dense_col(&io->B, j)[i] != 0.0 &&
                    ritz_sparse_diagonal(&component->M, i) == 0.0,
                RITZ_ERR_ARGUMENT,
                "input '%s' drives a dof without mass, and there are "
                "too many dofs for what it answers at once: condense "
                "it first",
                io->input[j]);
    return RITZ_OK;
}

ritz_status ritz_states_project(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_basis *basis, ritz_state_space *out,
                                ritz_dense *E)
{
    const ritz_dense *W = basis->W.val ? &basis->W : &basis->T;
    RITZ_OWN(large) m = {.component = component, .columns = &basis->columns};
    RITZ_OWN(ritz_dense) MT = {0}, inertia = {0};

    RITZ_CHECK(refuse_massless_inputs(component));
    RITZ_CHECK(install_dampers(component, &m));
    RITZ_CHECK(take_halves(&basis->T, &m.T_q, &m.T_v));
    RITZ_CHECK(take_halves(W, &m.W_q, &m.W_v));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &m.T_v, &MT));
    RITZ_CHECK(stiffness_times(&m, &m.T_q, &m.KT));
    RITZ_CHECK(add_damping(damping, basis->among_hz, &MT, &m));
    RITZ_CHECK(project_forces(&m, &out->A));
    RITZ_CHECK(fill_outputs(&m, out));
    RITZ_CHECK(ritz_dense_mul_tn(&m.W_q, &m.T_q, E));
    RITZ_CHECK(ritz_dense_mul_tn(&m.W_v, &MT, &inertia));
    ritz_dense_add(1.0, &inertia, E);
    return settle_rigid(&m, (const ritz_dense *[]){&m.W_q, &m.W_v},
                        (const ritz_dense *[]){&m.T_q, &MT}, E);
}
