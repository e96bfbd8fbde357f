/*
 * A component in a basis of states, in modal coordinates: with z = [q; q'],
 * u = Phi q, and of the first-order form
 *
 *     [I 0; 0 M] x' = [0 I; -K -D] x + [0; B] u
 *
 *     T = [Phi T_q; Phi T_v],   W = [M Phi W_q; Phi W_v],
 *     W'E T = W_q'T_q + W_v'T_v
 *     W'A T = W_q'T_v - W_v' (Lambda T_q + Delta T_v),   W'B = W_v' Phi'B
 *
 * Differences of large numbers, which K u is for every smooth u, are so taken
 * once, when the modes are found. Of too many dofs for that the products are
 * those of sparse matrices.
 */
#include "base/alloc.h"
#include "linear/general.h"
#include "model/modal.h"

#include <ritz/model.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

/*
 * States that respond statically, x2' = 0, are eliminated [LiuAnderson1989]:
 *
 *     0 = A21 x1 + A22 x2 + B2 u
 *
 *     A := A11 - A12 A22^-1 A21,   B := B1 - A12 A22^-1 B2,
 *     C := C1 - C2 A22^-1 A21,     D := D - C2 A22^-1 B2
 *
 * so that the response at 0 Hz is unchanged. Of balanced states the bound of a
 * truncation holds for them too. All four are one Schur complement of
 * G = [A B; C D].
 */

/* Numbers below @p count of those that stay: states, and all that follow. */
static ritz_status choose_states(const ritz_columns *columns, int64_t count,
                                 bool perturbed, ritz_dofs *out)
{
    RITZ_CHECK_NEW(out->at, count);
    for (int64_t k = 0; k < count; k++)
        if (perturbed ==
            (k < columns->count && columns->kind[k] == RITZ_COLUMN_PERTURBED))
            out->at[out->count++] = k;
    return RITZ_OK;
}

/* G11 - G12 G22^-1 G21, the first with `rows` and `cols`. */
static ritz_status eliminate_rest(const ritz_dense *G, const ritz_dofs *rows,
                                  const ritz_dofs *cols, const ritz_dofs *rest,
                                  ritz_dense *out)
{
    RITZ_OWN(ritz_dense) upper = {0}, lower = {0}, change = {0};
    RITZ_OWN(ritz_dense) G12 = {0}, G21 = {0}, G22 = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_dense_rows(G, rows->count, rows->at, &upper));
    RITZ_CHECK(ritz_dense_rows(G, rest->count, rest->at, &lower));
    RITZ_CHECK(ritz_dense_pick(&upper, cols->count, cols->at, out));
    RITZ_CHECK(ritz_dense_pick(&upper, rest->count, rest->at, &G12));
    RITZ_CHECK(ritz_dense_pick(&lower, cols->count, cols->at, &G21));
    RITZ_CHECK(ritz_dense_pick(&lower, rest->count, rest->at, &G22));
    status = ritz_general_solve(&G22, false, &G21);
    RITZ_REFUSE_IF(
        status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
        "the remainder has no static response: a motion that nothing "
        "holds is among its states");
    RITZ_CHECK(status);
    RITZ_CHECK(ritz_dense_mul(&G12, &G21, &change));
    ritz_dense_add(-1.0, &change, out);
    return RITZ_OK;
}

/* Block of G that begins at (row, col), in place of A. */
static ritz_status take_block(const ritz_dense *G, int64_t row, int64_t col,
                              int64_t nrow, int64_t ncol, ritz_dense *A)
{
    ritz_dense_free(A);
    return ritz_dense_block(G, row, nrow, col, ncol, A);
}

static ritz_status perturb_states(const ritz_columns *columns,
                                  ritz_state_space *model)
{
    int64_t n = model->A.nrow, p = model->num_outputs, m = model->num_inputs;
    RITZ_OWN(ritz_dofs) rows = {0}, cols = {0}, rest = {0};
    RITZ_OWN(ritz_dense) whole = {0}, G = {0};
    int64_t r = 0;

    RITZ_CHECK(ritz_dense_new(n + p, n + m, &whole));
    ritz_dense_put(&model->A, 0, 0, &whole);
    ritz_dense_put(&model->B, 0, n, &whole);
    ritz_dense_put(&model->C, n, 0, &whole);
    ritz_dense_put(&model->D, n, n, &whole);
    RITZ_CHECK(choose_states(columns, n + p, false, &rows));
    RITZ_CHECK(choose_states(columns, n + m, false, &cols));
    RITZ_CHECK(choose_states(columns, n, true, &rest));
    RITZ_CHECK(eliminate_rest(&whole, &rows, &cols, &rest, &G));
    r = G.nrow - p;
    RITZ_CHECK(take_block(&G, 0, 0, r, r, &model->A));
    RITZ_CHECK(take_block(&G, 0, r, r, m, &model->B));
    RITZ_CHECK(take_block(&G, r, 0, p, r, &model->C));
    ritz_dense_cut(&G, r, r, &model->D);
    return ritz_columns_pick(columns, r, rows.at, &model->columns);
}

static ritz_status note_bound(const ritz_basis *basis, ritz_state_space *model)
{
    bool limited = false;

    if (basis->num_hankel == 0 || isnan(basis->bound))
        return RITZ_OK;
    for (int64_t k = 0; k < model->num_outputs; k++)
        limited = limited || !isnan(model->limit[k]);
    return ritz_measures_add(&model->estimates, "h-infinity-bound",
                             basis->bound, nan(""),
                             limited ? "outputs over their limits" : NULL);
}

ritz_status ritz_states_settle(const ritz_basis *basis, const ritz_dense *E,
                               ritz_state_space *model)
{
    bool whole = true;

    RITZ_CHECK_IN("left against right vectors",
                  ritz_general_solve(E, false, &model->A));
    RITZ_CHECK(ritz_general_solve(E, false, &model->B));
    for (int64_t k = 0; k < basis->columns.count; k++)
        whole = whole && basis->columns.kind[k] != RITZ_COLUMN_PERTURBED;
    if (whole)
        RITZ_CHECK(ritz_columns_pick(&basis->columns, basis->columns.count,
                                     NULL, &model->columns));
    else
        RITZ_CHECK(perturb_states(&basis->columns, model));
    RITZ_CHECK(note_bound(basis, model));
    model->origin = basis->origin;
    return RITZ_OK;
}

/* Modal coordinates. */

/* out = A'B + sign C'D */
static ritz_status two_products(const ritz_dense *A, const ritz_dense *B,
                                double sign, const ritz_dense *C,
                                const ritz_dense *D, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) second = {0};

    RITZ_CHECK(ritz_dense_mul_tn(A, B, out));
    RITZ_CHECK(ritz_dense_mul_tn(C, D, &second));
    ritz_dense_add(sign, &second, out);
    return RITZ_OK;
}

/* Lambda T_q + Delta T_v */
static ritz_status find_restoring(const ritz_modal_model *modes,
                                  const ritz_dense *T_q, const ritz_dense *T_v,
                                  ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_mul(&modes->Delta, T_v, out));
    for (int64_t j = 0; j < T_q->ncol; j++)
        for (int64_t i = 0; i < T_q->nrow; i++)
            ritz_dense_col(out, j)[i] +=
                modes->lambda[i] * ritz_dense_col(T_q, j)[i];
    return RITZ_OK;
}

/* C T_q + Cv T_v */
static ritz_status project_outputs(const ritz_dense *C, const ritz_dense *Cv,
                                   const ritz_dense *T_q, const ritz_dense *T_v,
                                   ritz_dense *out)
{
    RITZ_OWN(ritz_dense) rate = {0};

    ritz_dense_free(out);
    RITZ_CHECK(ritz_dense_mul(C, T_q, out));
    RITZ_CHECK(ritz_dense_mul(Cv, T_v, &rate));
    ritz_dense_add(1.0, &rate, out);
    return RITZ_OK;
}

/* Sum of |A(k,i) X(first + k,j)|: n eps of it is rounding of what they add
   to. */
static double largest_terms(const ritz_dense *A, int64_t i, const ritz_dense *X,
                            int64_t first, int64_t j)
{
    double sum = 0.0;

    for (int64_t k = 0; k < A->nrow; k++)
        sum += fabs(ritz_dense_col(A, i)[k] * ritz_dense_col(X, j)[first + k]);
    return sum;
}

/*
 * Columns of rigid motion are made of rigid modes and of no others. Rigid
 * motion of other columns that is rounding is set to 0: left as it is, it would
 * couple what is decoupled, by numbers so small that scaling goes astray.
 */
static void settle_rigid(const ritz_modal_model *modes,
                         const ritz_columns *columns, const ritz_dense *A,
                         const ritz_dense *X, int64_t first, ritz_dense *part)
{
    double rounding = (double)(A->nrow + 64) * DBL_EPSILON;

    for (int64_t j = 0; j < part->ncol && modes->num_rigid > 0; j++) {
        bool rigid = columns->kind[j] == RITZ_COLUMN_RIGID;
        double *x = ritz_dense_col(part, j);

        for (int64_t i = 0; i < modes->num_rigid && !rigid; i++)
            if (fabs(x[i]) <= rounding * largest_terms(A, i, X, first, j))
                x[i] = 0.0;
        for (int64_t i = modes->num_rigid; i < part->nrow && rigid; i++)
            x[i] = 0.0;
    }
}

/* A'(half of T or W that begins at row `first`), in modal coordinates. */
static ritz_status take_half(const ritz_modal_model *modes,
                             const ritz_columns *columns, const ritz_dense *A,
                             const ritz_dense *X, int64_t first,
                             ritz_dense *out)
{
    RITZ_OWN(ritz_dense) half = {0};

    RITZ_CHECK(ritz_dense_block(X, first, A->nrow, 0, X->ncol, &half));
    RITZ_CHECK(ritz_dense_mul_tn(A, &half, out));
    settle_rigid(modes, columns, A, X, first, out);
    return RITZ_OK;
}

/* Project a component of few dofs: modal coordinates of all its modes make
   W'E T and W'A T. */
static ritz_status project_modes(const ritz_component *component,
                                 const ritz_damping *damping,
                                 const ritz_basis *basis, ritz_state_space *out,
                                 ritz_dense *E)
{
    int64_t n = component->num_dofs;
    const ritz_dense *W = basis->W.val ? &basis->W : &basis->T;
    RITZ_OWN(ritz_structure) model = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_dense) T_q = {0}, T_v = {0}, W_q = {0}, W_v = {0}, F = {0};
    const ritz_columns *columns = &basis->columns;

    RITZ_CHECK(ritz_structure_of_component(component, &model));
    RITZ_CHECK(ritz_modal_model_new(&model, &component->io, damping, &modes));
    ritz_dense_free(&out->A);
    ritz_dense_free(&out->B);
    RITZ_CHECK(take_half(&modes, columns, &modes.MPhi, &basis->T, 0, &T_q));
    RITZ_CHECK(take_half(&modes, columns, &modes.MPhi, &basis->T, n, &T_v));
    RITZ_CHECK(take_half(&modes, columns, &modes.Phi, W, 0, &W_q));
    RITZ_CHECK(take_half(&modes, columns, &modes.MPhi, W, n, &W_v));
    RITZ_CHECK(find_restoring(&modes, &T_q, &T_v, &F));
    RITZ_CHECK(two_products(&W_q, &T_q, 1.0, &W_v, &T_v, E));
    RITZ_CHECK(two_products(&W_q, &T_v, -1.0, &W_v, &F, &out->A));
    RITZ_CHECK(ritz_dense_mul_tn(&W_v, &modes.B, &out->B));
    ritz_dense_add(1.0, &modes.feed, &out->D);
    return project_outputs(&modes.C, &modes.Cv, &T_q, &T_v, &out->C);
}

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

    RITZ_CHECK(ritz_dense_block(T, 0, n, 0, T->ncol, upper));
    return ritz_dense_block(T, n, n, 0, T->ncol, lower);
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
    const ritz_span span = {.modes = -1, .up_to_hz = among_hz};
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
 * Couplings of A = U'X +- V'Y between rigid and other motion that are rounding
 * are set to 0: rigid motion is decoupled.
 */
static ritz_status settle_couplings(const large *m,
                                    const ritz_dense *const left[2],
                                    const ritz_dense *const right[2],
                                    ritz_dense *A)
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

/* A := W_q'T_v - W_v'F, where rigid rows have no part in K. */
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
    return settle_couplings(m, (const ritz_dense *[]){&m->W_q, &m->W_v},
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
    RITZ_REFUSE_IF(
        status == RITZ_ERR_SINGULAR, RITZ_ERR_ARGUMENT,
        "accelerations are outputs of a component with massless dofs: "
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

/* The static response of massless dofs would need more than the vectors. */
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
                "too many dofs for its static response: condense it first",
                io->input[j]);
    return RITZ_OK;
}

ritz_status ritz_states_project(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_basis *basis, ritz_state_space *out,
                                ritz_dense *E)
{
    const ritz_dense *W = basis->W.val ? &basis->W : &basis->T;
    const ritz_io *io = &component->io;
    RITZ_OWN(large) m = {.component = component, .columns = &basis->columns};
    RITZ_OWN(ritz_dense) MT = {0}, inertia = {0};

    RITZ_CHECK(refuse_massless_inputs(component));
    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_CHECK(ritz_structure_sparse(component, NULL, &m.K, &m.D));
    RITZ_CHECK(take_halves(&basis->T, &m.T_q, &m.T_v));
    RITZ_CHECK(take_halves(W, &m.W_q, &m.W_v));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &m.T_v, &MT));
    RITZ_CHECK(stiffness_times(&m, &m.T_q, &m.KT));
    RITZ_CHECK(add_damping(damping, basis->among_hz, &MT, &m));
    RITZ_CHECK(project_forces(&m, &out->A));
    ritz_dense_free(&out->B);
    RITZ_CHECK(ritz_dense_mul_tn(&m.W_v, &io->B, &out->B));
    RITZ_CHECK(project_outputs(&io->C, &io->Cv, &m.T_q, &m.T_v, &out->C));
    RITZ_CHECK(fill_accelerations(&m, out));
    RITZ_CHECK(ritz_dense_mul_tn(&m.W_q, &m.T_q, E));
    RITZ_CHECK(ritz_dense_mul_tn(&m.W_v, &MT, &inertia));
    ritz_dense_add(1.0, &inertia, E);
    return settle_couplings(&m, (const ritz_dense *[]){&m.W_q, &m.W_v},
                            (const ritz_dense *[]){&m.T_q, &MT}, E);
}

static ritz_status check_basis(const ritz_basis *basis, int64_t states)
{
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = &basis->W;

    RITZ_REFUSE_IF(!basis->states, RITZ_ERR_ARGUMENT,
                   "the basis is of displacements, not of states");
    RITZ_REFUSE_IF(T->nrow != states, RITZ_ERR_ARGUMENT,
                   "the basis is for %" PRId64
                   " states, the model has %" PRId64,
                   T->nrow, states);
    RITZ_REFUSE_IF(W->val && (W->nrow != T->nrow || W->ncol != T->ncol),
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " left vectors do not fit %" PRId64
                   " x %" PRId64 " right ones",
                   W->nrow, W->ncol, T->nrow, T->ncol);
    return RITZ_OK;
}

ritz_status ritz_reduce_states(const ritz_component *component,
                               const ritz_damping *damping,
                               const ritz_basis *basis, ritz_state_space *out)
{
    bool small = component->num_dofs <= RITZ_STATE_DOFS;
    RITZ_OWN(ritz_state_space) reduced = {0};
    RITZ_OWN(ritz_dense) E = {0};

    RITZ_CHECK(check_basis(basis, 2 * component->num_dofs));
    RITZ_CHECK(ritz_state_space_new(basis->T.ncol, &component->io, &reduced));
    if (small)
        RITZ_CHECK(project_modes(component, damping, basis, &reduced, &E));
    else
        RITZ_CHECK(
            ritz_states_project(component, damping, basis, &reduced, &E));
    RITZ_CHECK(ritz_states_settle(basis, &E, &reduced));
    memcpy(reduced.units, component->units, sizeof reduced.units);
    ritz_damping_print(damping, reduced.damping);
    RITZ_MOVE(*out, reduced);
    return RITZ_OK;
}

/*
 * Left vectors of second order as a basis of states: with
 *
 *     T_2 = [T 0; 0 T],   W_2 = [M'W 0; 0 W],
 *
 * W_2'E T_2 = [W'M T 0; 0 W'M T] and W_2'A T_2 = [0 W'M T; -W'K T -W'D T], from
 * which the companion form comes by division, its upper half being [0 I].
 */

static ritz_status check_second_order(const ritz_component *component,
                                      const ritz_basis *basis)
{
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = &basis->W;

    RITZ_REFUSE_IF(
        basis->states || !W->val, RITZ_ERR_ARGUMENT,
        "the basis of '%s' is not of displacements with left vectors",
        basis->origin.method);
    RITZ_REFUSE_IF(T->nrow != component->num_dofs || W->nrow != T->nrow ||
                       W->ncol != T->ncol,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " x %" PRId64 " left and %" PRId64 " x %" PRId64
                   " right vectors do not fit %" PRId64 " dofs",
                   W->nrow, W->ncol, T->nrow, T->ncol, component->num_dofs);
    return RITZ_OK;
}

/* out = [upper 0; 0 lower] */
static ritz_status stack_halves(const ritz_dense *upper,
                                const ritz_dense *lower, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(2 * upper->nrow, 2 * upper->ncol, out));
    ritz_dense_put(upper, 0, 0, out);
    ritz_dense_put(lower, upper->nrow, upper->ncol, out);
    return RITZ_OK;
}

static ritz_status to_states(const ritz_component *component,
                             const ritz_basis *basis, ritz_basis *out)
{
    const ritz_columns *columns = &basis->columns;
    int64_t r = basis->T.ncol;
    RITZ_OWN(ritz_basis) states = {.states = true, .among_hz = basis->among_hz};
    RITZ_OWN(ritz_dense) MW = {0};

    states.origin = basis->origin;
    RITZ_CHECK(ritz_sparse_mul(&component->M, &basis->W, &MW));
    RITZ_CHECK(stack_halves(&basis->T, &basis->T, &states.T));
    RITZ_CHECK(stack_halves(&MW, &basis->W, &states.W));
    RITZ_CHECK(ritz_columns_new(2 * r, &states.columns));
    for (int64_t j = 0; j < 2 * r; j++) {
        states.columns.kind[j] = columns->kind[j % r];
        states.columns.dof[j] = columns->dof[j % r];
        states.columns.hertz[j] = columns->hertz[j % r];
    }
    RITZ_MOVE(*out, states);
    return RITZ_OK;
}

/* q' is q', without the rounding of a division. */
static void settle_companion(ritz_state_space *model)
{
    int64_t r = model->A.nrow / 2;

    for (int64_t j = 0; j < 2 * r; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&model->A, j)[i] = j == r + i ? 1.0 : 0.0;
    for (int64_t j = 0; j < model->num_inputs; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&model->B, j)[i] = 0.0;
}

ritz_status ritz_reduce_companion(const ritz_component *component,
                                  const ritz_damping *damping,
                                  const ritz_basis *basis,
                                  ritz_state_space *out)
{
    RITZ_OWN(ritz_basis) states = {0};

    RITZ_CHECK(check_second_order(component, basis));
    RITZ_CHECK(to_states(component, basis, &states));
    RITZ_CHECK(ritz_reduce_states(component, damping, &states, out));
    settle_companion(out);
    return RITZ_OK;
}

/* A state space in a basis of its states: see ritz_reduce_states. */

/* W'A T, with a dense or a sparse A; without either, A is the identity. */
static ritz_status product_between(const ritz_dense *W, const ritz_dense *A,
                                   const ritz_sparse *sA, const ritz_dense *T,
                                   ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AT = {0};

    ritz_dense_free(out);
    if (!A->val && !sA->colptr)
        return ritz_dense_mul_tn(W, T, out);
    RITZ_CHECK(A->val ? ritz_dense_mul(A, T, &AT)
                      : ritz_sparse_mul(sA, T, &AT));
    return ritz_dense_mul_tn(W, &AT, out);
}

ritz_status ritz_reduce_space(const ritz_state_space *full,
                              const ritz_basis *basis, ritz_state_space *out)
{
    const ritz_dense *T = &basis->T;
    const ritz_dense *W = basis->W.val ? &basis->W : T;
    const ritz_io io = ritz_model_io(ritz_model_of_states(full));
    RITZ_OWN(ritz_state_space) reduced = {0};
    RITZ_OWN(ritz_dense) E = {0};

    RITZ_CHECK(check_basis(basis, ritz_state_space_order(full)));
    RITZ_CHECK(ritz_state_space_new(T->ncol, &io, &reduced));
    RITZ_CHECK(product_between(W, &full->A, &full->sA, T, &reduced.A));
    RITZ_CHECK(product_between(W, &full->E, &full->sE, T, &E));
    ritz_dense_free(&reduced.B);
    RITZ_CHECK(ritz_dense_mul_tn(W, &full->B, &reduced.B));
    ritz_dense_free(&reduced.C);
    RITZ_CHECK(ritz_dense_mul(&full->C, T, &reduced.C));
    ritz_dense_put(&full->D, 0, 0, &reduced.D);
    RITZ_CHECK(ritz_states_settle(basis, &E, &reduced));
    memcpy(reduced.units, full->units, sizeof reduced.units);
    memcpy(reduced.damping, full->damping, sizeof reduced.damping);
    RITZ_MOVE(*out, reduced);
    return RITZ_OK;
}
