/*
 * Damping that couples modes: of D and K4 as matrices the reduced model's
 * response and what it leaves are exact,
 *
 *     (Theta - w^2 + i w X'DX + i X'K4X) eta = X'b,
 *     r = b_o - R eta - i w D_o eta - i K4_o eta,
 *
 * D_o and K4_o being D X and K4 X without their M X X' of that, and X'r = 0.
 * Only what the full model makes of r is not: its modes are taken as if
 * uncoupled, hence no bound.
 */
#include "estimate/estimate_bounder.h"

#include "base/alloc.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* X'A X; nothing of no A. */
static ritz_status form(const ritz_sparse *A, const ritz_dense *X,
                        ritz_dense *out)
{
    return A->colptr ? ritz_sparse_condense(A, X, out)
                     : ritz_dense_new(X->ncol, X->ncol, out);
}

ritz_status ritz_coupled_open(const ritz_component *full, ritz_bounder *r)
{
    int64_t m = r->trial->count;
    int64_t sides = r->io->num_inputs + r->io->num_outputs;
    const double *rates = r->given;

    RITZ_CHECK(form(&full->D, &r->trial->X, &r->D));
    RITZ_CHECK(form(&full->K4, &r->trial->X, &r->K4));
    for (int64_t j = r->num_rigid; j < m; j++)
        ritz_dense_col(&r->D, j)[j] += rates[j] - r->matrices[j];
    RITZ_CHECK_NEW(r->Z, m * m);
    RITZ_CHECK_NEW(r->answers, m * sides);
    RITZ_CHECK_NEW(r->pivot, m);
    return RITZ_OK;
}

/* eta of one side, and alpha of what it leaves. */
static void fill(const ritz_bounder *r, double w, const double _Complex *eta,
                 ritz_side *s)
{
    int64_t m = r->trial->count;
    int64_t last = r->size - 2 * m;

    for (int64_t j = 0; j < m; j++) {
        s->eta[j] = eta[j];
        s->alpha[j] = -eta[j];
        s->alpha[last + j] = -ritz_complex(0.0, w) * eta[j];
        s->alpha[last + m + j] = -ritz_complex(0.0, 1.0) * eta[j];
    }
    s->change = s->damped = s->quarter = s->three = 0.0;
}

void ritz_coupled_solve(ritz_bounder *r, double w)
{
    int m = (int)r->trial->count;
    int sides = (int)(r->io->num_inputs + r->io->num_outputs);
    double _Complex *at = r->answers;

    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            r->Z[i + j * m] = ritz_complex(
                i == j ? ritz_bounder_stiffness(r, j) - w * w : 0.0,
                w * ritz_dense_col(&r->D, j)[i] + ritz_dense_col(&r->K4, j)[i]);
    for (int side = 0; side < sides; side++) {
        const ritz_side *s = side < r->io->num_inputs
                                 ? &r->in[side]
                                 : &r->out[side - r->io->num_inputs];

        for (int64_t j = 0; j < m; j++)
            at[j + (int64_t)side * m] = s->modal[j];
    }
    if (LAPACKE_zgesv(LAPACK_COL_MAJOR, m, sides, r->Z, m, r->pivot, at, m))
        for (int64_t k = 0; k < (int64_t)m * sides; k++)
            at[k] = nan("");
    for (int64_t k = 0; k < r->io->num_inputs; k++, at += m)
        fill(r, w, at, &r->in[k]);
    for (int64_t k = 0; k < r->io->num_outputs; k++, at += m)
        fill(r, w, at, &r->out[k]);
}

void ritz_coupled_free(ritz_bounder *r)
{
    ritz_dense_free(&r->D);
    ritz_dense_free(&r->K4);
    free(r->Z);
    free(r->answers);
    free(r->pivot);
}
