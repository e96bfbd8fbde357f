/*
 * K R = f, Phi'M R = 0, is consistent where f = (I - M Phi Phi') f, the rigid
 * modes being among Phi, and is solved with A = K - sigma M, sigma < 0, by
 *
 *     A R_new = f - sigma M R,
 *
 * whose error falls by |sigma| / (lambda + |sigma|) a step, lambda being of the
 * first mode that is left out.
 *
 * Where no mass is left in the rest, M R_0 = 0: it answers by R_0 alone, and
 * all other terms are rounding. So a term is held to what it adds at the end of
 * the range, of the whole answer there, and not to its own size.
 */
#include "poles/rest_solver.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* Steps shrink by 100 or more, so that 8 reach rounding; a body of which no
   flexible mode is kept may need more. */
enum { MOST_STEPS = 200 };
static const double settled = 1e-14;
/* Rounding of an ill-conditioned K may keep it from that, not from this. */
static const double unsettled = 1e-6;
/* Of the whole answer: a change that is not seen. */
static const double unseen = 0x1p-53;
static const double small_shift = 0.01;
/* Of the largest K_jj / M_jj. */
static const double lost_in_K = 1e-10;

void ritz_rest_solver_free(ritz_rest_solver *s)
{
    ritz_dense_free(&s->MPhi);
    ritz_factor_free(&s->F);
    free(s->whole);
}

/*
 * Of a body of which nothing but rigid motion is kept: a hundredth of what all
 * others are above, but no less than what the rounding of K leaves definite.
 */
static double rigid_shift(const ritz_component *component,
                          const ritz_pairs *pairs, double out_hz)
{
    double usual = pairs->sigma < 0.0 ? -pairs->sigma : 1.0;
    double least = 0.0;

    for (int64_t j = 0; j < component->num_dofs; j++) {
        double m = ritz_sparse_diagonal(&component->M, j);

        if (m > 0.0)
            least = fmax(least, lost_in_K *
                                    ritz_sparse_diagonal(&component->K, j) / m);
    }
    return -fmin(usual, fmax(least, small_shift * ritz_eigen_lambda(out_hz)));
}

/*
 * The largest value of sum_k |phi_k| |phi_k'b| / max(lambda_k, w^2), of each
 * input: how large the modes answer between their resonances.
 */
static ritz_status size_modes(const ritz_pairs *pairs, const ritz_dense *B,
                              double to_hz, double *out)
{
    ritz_status status = RITZ_OK;
    double w2 = ritz_eigen_lambda(to_hz);
    ritz_dense share = {0};

    RITZ_TRY(ritz_dense_mul_tn(&pairs->Phi, B, &share));
    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t i = 0; i < B->nrow; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < pairs->Phi.ncol; k++) {
                double lambda = fmax(pairs->lambda[k], w2);

                if (lambda > 0.0)
                    sum += fabs(ritz_dense_col(&pairs->Phi, k)[i] *
                                ritz_dense_col(&share, j)[k]) /
                           lambda;
            }
            out[j] = fmax(out[j], sum);
        }
done:
    ritz_dense_free(&share);
    return status;
}

ritz_status ritz_rest_solver_new(const ritz_component *component,
                                 const ritz_pairs *pairs, double to_hz,
                                 double out_hz, ritz_rest_solver *s)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *B = &component->io.B;
    int64_t m = pairs->Phi.ncol;
    ritz_sparse A = {0};

    s->M = &component->M;
    s->Phi = &pairs->Phi;
    s->sigma = rigid_shift(component, pairs, out_hz);
    if (m > pairs->num_rigid)
        s->sigma = -small_shift * pairs->lambda[m - 1];
    else if (m == 0) /* nothing moves freely: K is definite */
        s->sigma = 0.0;
    RITZ_TRY(ritz_sparse_mul(s->M, s->Phi, &s->MPhi));
    RITZ_TRY(ritz_sparse_add(1.0, &component->K, -s->sigma, &component->M, &A));
    RITZ_TRY_IN("static answer", ritz_factor_spd(&A, &s->F));
    RITZ_NEW(s->whole, B->ncol);
    RITZ_TRY(size_modes(pairs, B, to_hz, s->whole));
done:
    ritz_sparse_free(&A);
    return status;
}

/*
 * The last change of a term, worst of all inputs, over what is small beside
 * its largest value, or beside the whole answer at the end of the range:
 * @p change as it should be, @p apart as it must be.
 */
static void judge(const ritz_rest_solver *s, const ritz_dense *R,
                  const ritz_dense *last, double *change, double *apart)
{
    *change = *apart = 0.0;
    for (int64_t j = 0; j < R->ncol; j++) {
        double moved = 0.0;
        double size = ritz_dense_col_max(R, j);
        double seen = s->whole[j];

        for (int64_t i = 0; i < R->nrow; i++)
            moved = fmax(moved, fabs(ritz_dense_col(R, j)[i] -
                                     ritz_dense_col(last, j)[i]));
        if (!(moved > 0.0))
            continue;
        *change = fmax(*change, moved / (settled * size + unseen * seen));
        *apart = fmax(*apart,
                      moved / (unsettled * size + RITZ_SERIES_WITHIN * seen));
    }
}

/* As M-orthogonal to the modes as rounding leaves it: twice is enough. */
static ritz_status take_out(const ritz_dense *left, const ritz_dense *right,
                            ritz_dense *X)
{
    RITZ_CHECK(ritz_dense_take_out(left, right, X));
    return ritz_dense_take_out(left, right, X);
}

ritz_status ritz_rest_solve(ritz_rest_solver *s, ritz_dense *f, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense R = {0};
    ritz_dense next = {0};
    double change = HUGE_VAL, apart = HUGE_VAL;

    RITZ_TRY(take_out(&s->MPhi, s->Phi, f));
    RITZ_TRY(ritz_dense_new(f->nrow, f->ncol, &R));
    for (int step = 0; step < MOST_STEPS && change > 1.0; step++) {
        RITZ_TRY(ritz_sparse_mul(s->M, &R, &next));
        for (int64_t k = 0; k < f->nrow * f->ncol; k++)
            next.val[k] = f->val[k] - s->sigma * next.val[k];
        RITZ_TRY(ritz_factor_solve(s->F, &next));
        RITZ_TRY(take_out(s->Phi, &s->MPhi, &next));
        judge(s, &next, &R, &change, &apart);
        ritz_dense_free(&R);
        R = next;
        next = (ritz_dense){0};
    }
    RITZ_FAIL_IF(!(apart <= 1.0), RITZ_ERR_CONVERGENCE,
                 "what modes above the band answer did not settle in %d steps: "
                 "the last one changed it by %.1e",
                 (int)MOST_STEPS, apart * unsettled);
    for (int64_t j = 0; !s->begun && j < R.ncol; j++)
        s->whole[j] = fmax(s->whole[j], ritz_dense_col_max(&R, j));
    s->begun = true;
    *out = R;
    R = (ritz_dense){0};
done:
    ritz_dense_free(&R);
    ritz_dense_free(&next);
    return status;
}
