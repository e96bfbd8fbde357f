/* What a bound of responses is made of, once; see estimate_response.c. */
#include "estimate/estimate_bounder.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a sum: one is due, the rest is room. */
static const double roundings = 4.0;

static double square(double x)
{
    return x * x;
}

/* The stiffness of a trial mode, its rate of damping. */
double ritz_bounder_stiffness(const ritz_bounder *r, int64_t j)
{
    return j < r->num_rigid ? 0.0 : r->trial->theta[j];
}

double ritz_bounder_rate(const ritz_bounder *r, double lambda)
{
    return r->rayleigh ? r->a + r->b * lambda
                       : 2.0 * r->zeta * sqrt(fmax(lambda, 0.0));
}

double ritz_bounder_rate_of(const ritz_bounder *r, int64_t j)
{
    if (r->given)
        return r->given[j];
    return j < r->num_rigid && !r->rayleigh
               ? 0.0
               : ritz_bounder_rate(r, ritz_bounder_stiffness(r, j));
}

/* A X from a column of V on; nothing of no A. */
static ritz_status damp(const ritz_sparse *A, const ritz_bounder *r, int64_t at,
                        ritz_dense *V)
{
    ritz_status status = RITZ_OK;
    ritz_dense AX = {0};

    if (!A->colptr)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_mul(A, &r->trial->X, &AX));
    memcpy(ritz_dense_col(V, at), AX.val,
           (size_t)(AX.nrow * AX.ncol) * sizeof *AX.val);
done:
    ritz_dense_free(&AX);
    return status;
}

/* [R b_o c_o D_o K4_o], with M X X' of all but R taken out. */
static ritz_status stack(const ritz_estimator *estimator, ritz_bounder *r,
                         ritz_dense *V)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &estimator->component->io;
    const ritz_dense *const C[KINDS] = {&io->C, &io->Cv, &io->Ca};
    int64_t n = estimator->component->num_dofs;
    int64_t m = r->trial->count;
    ritz_dense MX = {0};
    ritz_dense part = {0};

    RITZ_TRY(ritz_dense_new(n, r->size, V));
    memcpy(V->val, r->trial->R.val, (size_t)(n * m) * sizeof *V->val);
    for (int64_t j = 0; j < io->num_inputs; j++)
        memcpy(ritz_dense_col(V, m + j), ritz_dense_col(&io->B, j),
               (size_t)n * sizeof *V->val);
    for (int64_t k = 0; k < KINDS; k++)
        for (int64_t i = 0; i < io->num_outputs; i++)
            for (int64_t d = 0; d < n; d++)
                ritz_dense_col(V, m + io->num_inputs + k * io->num_outputs +
                                      i)[d] = ritz_dense_col(C[k], d)[i];
    if (r->coupled) {
        RITZ_TRY(damp(&estimator->component->D, r, r->size - 2 * m, V));
        RITZ_TRY(damp(&estimator->component->K4, r, r->size - m, V));
    }
    RITZ_TRY(ritz_sparse_mul(&estimator->component->M, &r->trial->X, &MX));
    part = ritz_dense_part(V, m, r->size - m);
    for (int twice = 0; twice < 2; twice++)
        RITZ_TRY(ritz_dense_take_out(&MX, &r->trial->X, &part));
done:
    ritz_dense_free(&MX);
    return status;
}

/* G, Q and the norms of V's columns. */
static ritz_status form(ritz_estimator *estimator, ritz_bounder *r)
{
    ritz_status status = RITZ_OK;
    ritz_dense V = {0};
    ritz_dense E = {0};

    RITZ_TRY(stack(estimator, r, &V));
    RITZ_TRY(ritz_dense_copy(&V, &E));
    RITZ_TRY(ritz_factor_solve(estimator->A, &E));
    RITZ_TRY(ritz_dense_mul_tn(&V, &E, &r->G));
    ritz_dense_symmetrise(&r->G);
    RITZ_TRY(ritz_sparse_condense(&estimator->component->M, &E, &r->Q));
    RITZ_NEW(r->size_of, r->size);
    for (int64_t j = 0; j < r->size; j++)
        r->size_of[j] = sqrt(fmax(ritz_dense_col(&r->G, j)[j], 0.0));
done:
    ritz_dense_free(&V);
    ritz_dense_free(&E);
    return status;
}

/*
 * sin^2 of each rigid mode: by the residuals of all together, as full and trial
 * ones may be turned among themselves, and the gap to flexible modes.
 */
static double rigid_sin2(const ritz_bounder *r)
{
    const ritz_lehmann *trial = r->trial;
    double next = r->num_rigid < r->e->count ? r->e->low[r->num_rigid] : 0.0;
    double sum = 0.0;

    if (!(next > 0.0))
        return 1.0;
    for (int64_t j = 0; j < r->num_rigid; j++) {
        double t = trial->theta[j] - trial->sigma;
        double eps2 = fmax(ritz_dense_col(&trial->G, j)[j], 0.0) / t;

        sum += square(trial->rounding[j] / trial->sigma) +
               eps2 * square(1.0 - trial->sigma / next);
    }
    return sum;
}

/* sin^2 of each full mode against the trial modes of numbers up to N. */
static ritz_status turn(ritz_bounder *r)
{
    const ritz_lehmann *trial = r->trial;
    const ritz_enclosure *e = r->e;
    double sum = 0.0;

    RITZ_CHECK_NEW(r->sin2, e->count);
    for (int64_t p = 0; p < e->count; p++)
        r->sin2[p] = 1.0;
    for (int64_t N = 1; N < e->count && N <= trial->count; N++) {
        double t = trial->theta[N - 1] - trial->sigma;
        double next = 1.0 / (e->low[N] - trial->sigma);
        double most = 1.0 / (e->low[N - 1] - trial->sigma);

        sum += fmax(most - 1.0 / t, 0.0);
        for (int64_t p = 0; p < N; p++) {
            double least = 1.0 / (e->high[p] - trial->sigma);

            if (least > next)
                r->sin2[p] = fmin(r->sin2[p], sum / (least - next));
        }
    }
    for (int64_t p = 0; p < r->num_rigid && p < e->count; p++)
        r->sin2[p] = fmin(r->sin2[p], rigid_sin2(r));
    return RITZ_OK;
}

/* How much faster w d grows with an eigenvalue than that does itself. */
static double damping_over(const ritz_bounder *r, double w, double theta)
{
    return r->rayleigh ? w * r->b : w * r->zeta / sqrt(theta);
}

double ritz_bounder_rounding(const ritz_bounder *r, double w,
                             const ritz_side *in, const ritz_side *out)
{
    double all[2] = {0.0, 0.0};
    double rigid[2] = {0.0, 0.0};
    double mass[2] = {0.0, 0.0};

    for (int64_t j = 0; j < r->trial->count; j++) {
        double off = r->trial->rounding[j] + r->trial->reduced[j];
        double own = w * sqrt(r->trial->inertia[j]);
        double each = sqrt(
            off * (1.0 + damping_over(r, w, fmax(r->trial->theta[j], off))));

        mass[0] += own * cabs(in->eta[j]);
        mass[1] += own * cabs(out->eta[j]);
        all[0] += cabs(in->eta[j]) * each;
        all[1] += cabs(out->eta[j]) * each;
        if (j + 1 == r->num_rigid) {
            rigid[0] = all[0];
            rigid[1] = all[1];
        }
    }
    return all[0] * all[1] - rigid[0] * rigid[1] +
           roundings * DBL_EPSILON * mass[0] * mass[1];
}

static ritz_status side_new(const ritz_bounder *r, int64_t count,
                            ritz_side **out)
{
    RITZ_CHECK_NEW(*out, count);
    for (int64_t k = 0; k < count; k++) {
        RITZ_CHECK_NEW((*out)[k].alpha, r->size);
        RITZ_CHECK_NEW((*out)[k].modal, r->trial->count);
        RITZ_CHECK_NEW((*out)[k].eta, r->trial->count);
        RITZ_CHECK_NEW((*out)[k].slope, r->size);
        RITZ_CHECK_NEW((*out)[k].first, r->trial->count);
        RITZ_CHECK_NEW((*out)[k].second, r->trial->count);
    }
    return RITZ_OK;
}

static void side_free(int64_t count, ritz_side *sides)
{
    for (int64_t k = 0; sides && k < count; k++) {
        free(sides[k].alpha);
        free(sides[k].modal);
        free(sides[k].eta);
        free(sides[k].slope);
        free(sides[k].first);
        free(sides[k].second);
    }
    free(sides);
}

void ritz_bounder_free(ritz_bounder *r)
{
    side_free(r->io->num_inputs, r->in);
    side_free(r->io->num_outputs, r->out);
    ritz_dense_free(&r->G);
    ritz_dense_free(&r->Q);
    ritz_dense_free(&r->B);
    for (int k = 0; k < KINDS; k++)
        ritz_dense_free(&r->C[k]);
    free(r->size_of);
    free(r->sin2);
    free(r->GV);
    free(r->QV);
    ritz_coupled_free(r);
}

ritz_status ritz_bounder_open(ritz_estimator *estimator, ritz_bounder *r)
{
    const ritz_io *io = r->io;
    const ritz_dense *X = &r->trial->X;

    r->size = (r->coupled ? 3 : 1) * r->trial->count + io->num_inputs +
              KINDS * io->num_outputs;
    RITZ_CHECK(form(estimator, r));
    RITZ_CHECK(turn(r));
    RITZ_CHECK(ritz_dense_mul_tn(X, &io->B, &r->B));
    RITZ_CHECK(ritz_dense_mul(&io->C, X, &r->C[0]));
    RITZ_CHECK(ritz_dense_mul(&io->Cv, X, &r->C[1]));
    RITZ_CHECK(ritz_dense_mul(&io->Ca, X, &r->C[2]));
    RITZ_CHECK(side_new(r, io->num_inputs, &r->in));
    RITZ_CHECK(side_new(r, io->num_outputs, &r->out));
    RITZ_CHECK_NEW(r->GV, r->size);
    RITZ_CHECK_NEW(r->QV, r->size);
    if (r->coupled)
        RITZ_CHECK(ritz_coupled_open(estimator->component, r));
    return RITZ_OK;
}
