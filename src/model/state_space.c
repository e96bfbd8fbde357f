/*
 * First-order form of M u'' + D u' + K u = B f, x = [u; u']:
 *
 *     A = [0 I; -M^-1 K -M^-1 D],   B = [0; M^-1 B],
 *     C = [C - Ca M^-1 K, Cv - Ca M^-1 D],   D = Ca M^-1 B
 *
 * Damping ratios are M Phi diag(2 zeta w) Phi'M beside D. Where M is singular
 * x = [q; q'] of the modes with mass, as modal.c finds them.
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "linear/general.h"
#include "model/modal.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Allocate a state space without A and E. */
static ritz_status start_space(int64_t states, const ritz_io *io,
                               ritz_state_space *model)
{
    model->num_inputs = io->num_inputs;
    model->num_outputs = io->num_outputs;
    RITZ_CHECK(ritz_dense_new(states, io->num_inputs, &model->B));
    RITZ_CHECK(ritz_dense_new(io->num_outputs, states, &model->C));
    RITZ_CHECK(ritz_dense_new(io->num_outputs, io->num_inputs, &model->D));
    RITZ_CHECK_COPY(model->input, io->input, io->num_inputs);
    RITZ_CHECK_COPY(model->output, io->output, io->num_outputs);
    RITZ_CHECK_COPY(model->limit, io->limit, io->num_outputs);
    RITZ_CHECK(ritz_columns_new(states, &model->columns));
    for (int64_t k = 0; k < states; k++)
        model->columns.kind[k] = RITZ_COLUMN_STATE;
    return RITZ_OK;
}

ritz_status ritz_state_space_new(int64_t states, const ritz_io *io,
                                 ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) model = {0};

    RITZ_CHECK(ritz_dense_new(states, states, &model.A));
    RITZ_CHECK(start_space(states, io, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

ritz_status ritz_state_space_of_sparse(const ritz_sparse *A,
                                       const ritz_sparse *E, const ritz_io *io,
                                       ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) model = {0};

    RITZ_CHECK(ritz_sparse_copy(A, &model.sA));
    if (E->colptr)
        RITZ_CHECK(ritz_sparse_copy(E, &model.sE));
    RITZ_CHECK(start_space(A->nrow, io, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

/* Copy a state space without A and E. */
static ritz_status copy_space(const ritz_state_space *model,
                              ritz_state_space *out)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(model));
    int64_t n = ritz_state_space_order(model);

    RITZ_CHECK(start_space(n, &io, out));
    ritz_dense_put(&model->B, 0, 0, &out->B);
    ritz_dense_put(&model->C, 0, 0, &out->C);
    ritz_dense_put(&model->D, 0, 0, &out->D);
    RITZ_CHECK(ritz_columns_pick(&model->columns, n, NULL, &out->columns));
    RITZ_CHECK(ritz_measures_copy(&model->estimates, &out->estimates));
    RITZ_CHECK(ritz_measures_copy(&model->errors, &out->errors));
    out->origin = model->origin;
    memcpy(out->damping, model->damping, sizeof out->damping);
    memcpy(out->units, model->units, sizeof out->units);
    return RITZ_OK;
}

ritz_status ritz_state_space_dense(const ritz_state_space *model,
                                   ritz_state_space *made,
                                   const ritz_state_space **out)
{
    const int64_t most = 2 * (int64_t)RITZ_STATE_DOFS;
    RITZ_OWN(ritz_state_space) dense = {0};

    *out = model;
    if (!model->sA.colptr)
        return RITZ_OK;
    RITZ_REFUSE_IF(model->sA.nrow > most, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " sparse states are more than %" PRId64
                   ", of which dense matrices are made: reduce the model first",
                   model->sA.nrow, most);
    RITZ_CHECK(copy_space(model, &dense));
    RITZ_CHECK(ritz_sparse_dense(&model->sA, &dense.A));
    if (model->sE.colptr)
        RITZ_CHECK(ritz_sparse_dense(&model->sE, &dense.E));
    RITZ_MOVE(*made, dense);
    *out = made;
    return RITZ_OK;
}

static ritz_status check_size(const char *name, int64_t rows, int64_t cols,
                              int64_t nrow, int64_t ncol)
{
    RITZ_REFUSE_IF(rows != nrow || cols != ncol, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 " where %" PRId64
                   " x %" PRId64 " is due",
                   name, rows, cols, nrow, ncol);
    return RITZ_OK;
}

static ritz_status check_finite(const char *name, int64_t count,
                                const double *val)
{
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(!isfinite(val[k]), RITZ_ERR_FORMAT, "'%s' is not finite",
                       name);
    return RITZ_OK;
}

static ritz_status check_matrix(const char *name, const ritz_dense *A,
                                int64_t nrow, int64_t ncol)
{
    RITZ_CHECK(check_size(name, A->nrow, A->ncol, nrow, ncol));
    return check_finite(name, nrow * ncol, A->val);
}

static ritz_status check_sparse(const char *name, const ritz_sparse *A,
                                int64_t n)
{
    RITZ_CHECK(check_size(name, A->nrow, A->ncol, n, n));
    return check_finite(name, A->colptr[n], A->val);
}

static ritz_status refuse_singular(ritz_status status)
{
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_FORMAT,
                   "'E' is singular");
    return status;
}

/* Check A and E, both dense or both sparse. */
static ritz_status check_pencil(const ritz_state_space *model, int64_t n)
{
    const ritz_sparse *const E[] = {&model->sE};
    const double _Complex c[] = {1.0};
    RITZ_OWN(ritz_zldl) *F = NULL;
    RITZ_OWN(ritz_dense) one = {0};

    if (model->sA.colptr) {
        RITZ_CHECK(check_sparse("A", &model->sA, n));
        if (!model->sE.colptr)
            return RITZ_OK;
        RITZ_CHECK(check_sparse("E", &model->sE, n));
        RITZ_CHECK(refuse_singular(ritz_zldl_new(1, E, &F)));
        return refuse_singular(ritz_zldl_factor(F, c));
    }
    RITZ_CHECK(check_matrix("A", &model->A, n, n));
    if (!model->E.val)
        return RITZ_OK;
    RITZ_CHECK(check_matrix("E", &model->E, n, n));
    RITZ_CHECK(ritz_dense_new(n, n > 0, &one));
    return refuse_singular(ritz_general_solve(&model->E, false, &one));
}

ritz_status ritz_state_space_check(const ritz_state_space *model)
{
    int64_t n = ritz_state_space_order(model);

    RITZ_REFUSE_IF(!model->A.val && !model->sA.colptr, RITZ_ERR_FORMAT,
                   "there is no 'A'");
    RITZ_REFUSE_IF(model->sA.colptr ? model->A.val || model->E.val
                                    : model->sE.colptr != NULL,
                   RITZ_ERR_FORMAT,
                   "'A' and 'E' are both dense or both sparse");
    RITZ_CHECK(check_matrix("B", &model->B, n, model->num_inputs));
    RITZ_CHECK(check_matrix("C", &model->C, model->num_outputs, n));
    RITZ_CHECK(
        check_matrix("D", &model->D, model->num_outputs, model->num_inputs));
    RITZ_REFUSE_IF(model->columns.count != n, RITZ_ERR_FORMAT,
                   "%" PRId64 " states are described of %" PRId64,
                   model->columns.count, n);
    return check_pencil(model, n);
}

/* C(:, first..) += sign A B */
static ritz_status add_product(double sign, const ritz_dense *A,
                               const ritz_dense *B, int64_t first,
                               ritz_dense *C)
{
    RITZ_OWN(ritz_dense) AB = {0};
    ritz_dense part = {0};

    RITZ_CHECK(ritz_dense_mul(A, B, &AB));
    part = ritz_dense_part(C, first, AB.ncol);
    ritz_dense_add(sign, &AB, &part);
    return RITZ_OK;
}

/* K, D and B are M^-1 K and so on here. */
static ritz_status fill_dofs(const ritz_dense *K, const ritz_dense *D,
                             const ritz_dense *B, const ritz_io *io,
                             ritz_state_space *out)
{
    int64_t n = K->nrow;

    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&out->A, n + j)[j] = 1.0;
        for (int64_t i = 0; i < n; i++) {
            ritz_dense_col(&out->A, j)[n + i] = -ritz_dense_col(K, j)[i];
            ritz_dense_col(&out->A, n + j)[n + i] = -ritz_dense_col(D, j)[i];
        }
    }
    ritz_dense_put(&io->C, 0, 0, &out->C);
    ritz_dense_put(&io->Cv, 0, n, &out->C);
    ritz_dense_put(B, n, 0, &out->B);
    if (ritz_dense_max(&io->Ca) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(add_product(-1.0, &io->Ca, K, 0, &out->C));
    RITZ_CHECK(add_product(-1.0, &io->Ca, D, n, &out->C));
    return add_product(1.0, &io->Ca, B, 0, &out->D);
}

/* X = M^-1 B */
static ritz_status divide_mass(const ritz_structure *model, const ritz_dense *B,
                               ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_copy(B, X));
    return ritz_general_solve_scaled(&model->M, false, X);
}

/* x = [u; u']; RITZ_ERR_SINGULAR if M is. */
static ritz_status by_dofs(const ritz_structure *model, const ritz_dense *D,
                           const ritz_io *io, ritz_state_space *out)
{
    RITZ_OWN(ritz_dense) K_m = {0}, D_m = {0}, B_m = {0};
    RITZ_OWN(ritz_state_space) made = {0};

    RITZ_CHECK(divide_mass(model, &model->K, &K_m));
    RITZ_CHECK(divide_mass(model, D, &D_m));
    RITZ_CHECK(divide_mass(model, &io->B, &B_m));
    RITZ_CHECK(ritz_state_space_new(2 * D->nrow, io, &made));
    RITZ_CHECK(fill_dofs(&K_m, &D_m, &B_m, io, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* x = [q; q'] */
static ritz_status by_modes(const ritz_structure *model, const ritz_io *io,
                            const ritz_damping *damping, ritz_state_space *out)
{
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN_ARRAY double *ones = NULL;
    int64_t m = 0;

    RITZ_CHECK(ritz_modal_model_new(model, io, damping, &modes));
    m = modes.count;
    RITZ_CHECK(ritz_state_space_new(2 * m, io, &made));
    RITZ_CHECK_NEW(ones, m);
    for (int64_t k = 0; k < m; k++)
        ones[k] = 1.0;
    ritz_dense_free(&made.A);
    ritz_dense_free(&made.B);
    ritz_dense_free(&made.C);
    RITZ_CHECK(ritz_modal_states(&modes, &(ritz_modal_layout){.scale = ones},
                                 &made.A, &made.B, &made.C));
    ritz_dense_replace(&made.D, &modes.feed);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

static ritz_status convert_structure(const ritz_structure *model,
                                     const ritz_io *io,
                                     const ritz_damping *damping,
                                     ritz_state_space *out)
{
    RITZ_OWN(ritz_dense) D = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_dense_new(model->K.nrow, model->K.nrow, &D));
    if (model->D.val)
        ritz_dense_put(&model->D, 0, 0, &D);
    RITZ_CHECK(ritz_modal_damping(model, damping, &D));
    status = by_dofs(model, &D, io, out);
    if (status == RITZ_ERR_SINGULAR)
        status = by_modes(model, io, damping, out);
    RITZ_CHECK(status);
    ritz_damping_print(damping, out->damping);
    return RITZ_OK;
}

ritz_status ritz_state_space_of_component(const ritz_component *component,
                                          const ritz_damping *damping,
                                          ritz_state_space *out)
{
    RITZ_OWN(ritz_structure) model = {0};

    RITZ_CHECK(ritz_structure_of_component(component, &model));
    RITZ_CHECK(convert_structure(&model, &component->io, damping, out));
    memcpy(out->units, component->units, sizeof out->units);
    return RITZ_OK;
}

ritz_status ritz_model_states(ritz_model model, ritz_state_space *made,
                              const ritz_state_space **out)
{
    static const ritz_damping none = {0};
    const ritz_damping *damping = model.damping ? model.damping : &none;
    const ritz_second_order *m = &model.dense;
    ritz_structure structure = {0}; /* borrowed */

    if (model.kind == RITZ_MODEL_STATES)
        return ritz_state_space_dense(model.states, made, out);
    *out = made;
    if (model.kind == RITZ_MODEL_COMPONENT)
        return ritz_state_space_of_component(model.component, damping, made);
    RITZ_CHECK(ritz_structure_refuse(m->K4 && m->K4->val));
    structure = (ritz_structure){.K = *m->K, .M = *m->M};
    if (m->D)
        structure.D = *m->D;
    return convert_structure(&structure, m->io, damping, made);
}

ritz_status ritz_state_space_poles(const ritz_state_space *model,
                                   int64_t *count, double _Complex **out)
{
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_eigenvalues) found = {0};
    double _Complex *poles = NULL;

    RITZ_CHECK(ritz_state_space_dense(model, &made, &model));
    RITZ_CHECK(ritz_dense_copy(&model->A, &A));
    if (model->E.val)
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &A));
    RITZ_CHECK(ritz_eigenvalues_of(&A, &found));
    RITZ_CHECK_NEW(poles, found.count);
    for (int64_t k = 0; k < found.count; k++)
        poles[k] = ritz_complex(found.re[k], found.im[k]);
    *count = found.count;
    *out = poles;
    return RITZ_OK;
}

void ritz_state_space_free(ritz_state_space *model)
{
    ritz_dense_free(&model->A);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    ritz_dense_free(&model->D);
    ritz_dense_free(&model->E);
    ritz_sparse_free(&model->sA);
    ritz_sparse_free(&model->sE);
    RITZ_FREE(model->input, model->output, model->limit);
    ritz_columns_free(&model->columns);
    ritz_measures_free(&model->estimates);
    ritz_measures_free(&model->errors);
    *model = (ritz_state_space){0};
}
