#include "gramians/states.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rigid modes are split off if Delta does not couple them with flexible
   ones. */
static int64_t count_apart(const ritz_modal_model *modes)
{
    int64_t r = modes->num_rigid;

    for (int64_t j = r; j < modes->count; j++)
        for (int64_t i = 0; i < r; i++)
            if (ritz_dense_col(&modes->Delta, j)[i] != 0.0 ||
                ritz_dense_col(&modes->Delta, i)[j] != 0.0)
                return 0;
    return r;
}

static ritz_status choose_scale(ritz_states *states)
{
    const ritz_modal_model *modes = &states->modes;
    int64_t half = modes->count - states->num_apart;
    double least = 0.0;

    RITZ_CHECK_NEW(states->scale, half);
    for (int64_t k = 0; k < half; k++) {
        double w = sqrt(fabs(modes->lambda[states->num_apart + k]));

        states->scale[k] = w;
        if (w > 0.0 && (least == 0.0 || w < least))
            least = w;
    }
    for (int64_t k = 0; k < half; k++)
        if (states->scale[k] == 0.0)
            states->scale[k] = least > 0.0 ? least : 1.0;
    return RITZ_OK;
}

/* A - alpha I, B and C. */
static ritz_status fill_states(ritz_states *states)
{
    int64_t r = states->num_apart;
    const ritz_modal_layout layout = {r, r, states->scale};

    RITZ_CHECK(ritz_modal_states(&states->modes, &layout, &states->A,
                                 &states->B, &states->C));
    states->count = states->A.nrow;
    for (int64_t k = 0; k < states->count; k++)
        ritz_dense_col(&states->A, k)[k] -= states->alpha;
    return RITZ_OK;
}

ritz_status ritz_states_new(const ritz_component *component,
                            const ritz_damping *damping, double alpha,
                            ritz_states *out)
{
    RITZ_OWN(ritz_states) states = {.alpha = alpha};
    RITZ_OWN(ritz_structure) structure = {0};

    RITZ_CHECK(ritz_structure_of_component(component, &structure));
    RITZ_CHECK(ritz_modal_model_new(&structure, &component->io, damping,
                                    &states.modes));
    ritz_damping_print(damping, states.damping);
    states.num_apart = count_apart(&states.modes);
    RITZ_CHECK(choose_scale(&states));
    RITZ_CHECK(fill_states(&states));
    RITZ_REFUSE_IF(states.count == 0, RITZ_ERR_ARGUMENT,
                   "the component has no flexible states: its rigid modes are "
                   "all there is");
    RITZ_MOVE(*out, states);
    return RITZ_OK;
}

ritz_status ritz_states_operator(const ritz_dense *A, bool inverse,
                                 ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0};

    if (!inverse)
        return ritz_dense_copy(A, out);
    RITZ_TRY(ritz_dense_new(A->nrow, A->nrow, &G));
    for (int64_t k = 0; k < A->nrow; k++)
        ritz_dense_col(&G, k)[k] = 1.0;
    status = ritz_general_solve(A, false, &G);
    RITZ_FAIL_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                 "the matrix of states has no inverse: a motion that nothing "
                 "holds, give a shift above 0 Hz");
    RITZ_TRY(status);
    RITZ_MOVE(*out, G);
done:
    ritz_dense_free(&G);
    return status;
}

/* out(first.., column..) = A diag(s) (rows row.. of Z); s NULL: I */
static ritz_status lift_states(const ritz_dense *A, const double *s,
                               const ritz_dense *Z, int64_t row, int64_t first,
                               int64_t column, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) part = {0}, lifted = {0};

    RITZ_CHECK(ritz_dense_new(A->ncol, Z->ncol, &part));
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t i = 0; i < A->ncol; i++)
            ritz_dense_col(&part, j)[i] =
                (s ? s[i] : 1.0) * ritz_dense_col(Z, j)[row + i];
    RITZ_CHECK(ritz_dense_mul(A, &part, &lifted));
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(out, column + j)[first + i] =
                ritz_dense_col(&lifted, j)[i];
    return RITZ_OK;
}

/* T = [Phi 0; 0 Phi], W = [M Phi 0; 0 Phi] of rigid modes. */
static void put_rigid(const ritz_states *states, ritz_basis *basis)
{
    int64_t n = states->modes.num_dofs;
    int64_t r = states->num_apart;

    for (int64_t j = 0; j < r; j++) {
        const double *phi = ritz_dense_col(&states->modes.Phi, j);
        size_t size = (size_t)n * sizeof *phi;

        memcpy(ritz_dense_col(&basis->T, j), phi, size);
        memcpy(ritz_dense_col(&basis->T, r + j) + n, phi, size);
        memcpy(ritz_dense_col(&basis->W, j),
               ritz_dense_col(&states->modes.MPhi, j), size);
        memcpy(ritz_dense_col(&basis->W, r + j) + n, phi, size);
        for (int64_t k = j; k < 2 * r; k += r) {
            basis->columns.kind[k] = RITZ_COLUMN_RIGID;
            basis->columns.hertz[k] = 0.0;
        }
    }
}

static ritz_status put_states(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *basis)
{
    const ritz_modal_model *modes = &states->modes;
    int64_t n = modes->num_dofs;
    int64_t r = states->num_apart;
    int64_t m = states->count / 2;
    RITZ_OWN(ritz_dense) Phi = {0}, MPhi = {0};
    RITZ_OWN_ARRAY double *inverse = NULL;

    RITZ_CHECK_NEW(inverse, m);
    for (int64_t k = 0; k < m; k++)
        inverse[k] = 1.0 / states->scale[k];
    RITZ_CHECK(ritz_dense_columns(&modes->Phi, r, m, &Phi));
    RITZ_CHECK(ritz_dense_columns(&modes->MPhi, r, m, &MPhi));
    RITZ_CHECK(lift_states(&Phi, inverse, T, 0, 0, 2 * r, &basis->T));
    RITZ_CHECK(lift_states(&Phi, NULL, T, m, n, 2 * r, &basis->T));
    RITZ_CHECK(lift_states(&MPhi, states->scale, W, 0, 0, 2 * r, &basis->W));
    return lift_states(&Phi, NULL, W, m, n, 2 * r, &basis->W);
}

ritz_status ritz_states_basis(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *out)
{
    int64_t n = states->modes.num_dofs;
    int64_t r = states->num_apart;
    int64_t k = 2 * r + T->ncol;
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_basis_new(2 * n, k, &basis));
    RITZ_CHECK(ritz_dense_new(2 * n, k, &basis.W));
    basis.states = true;
    memcpy(basis.damping, states->damping, sizeof basis.damping);
    for (int64_t j = 2 * r; j < k; j++)
        basis.columns.kind[j] = RITZ_COLUMN_STATE;
    put_rigid(states, &basis);
    RITZ_CHECK(put_states(states, T, W, &basis));
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "dense LAPACK");
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

void ritz_states_free(ritz_states *states)
{
    ritz_modal_model_free(&states->modes);
    free(states->scale);
    ritz_dense_free(&states->A);
    ritz_dense_free(&states->B);
    ritz_dense_free(&states->C);
    *states = (ritz_states){0};
}
