/*
 * Rigid-body modes three ways. With lambda_f the first flexible eigenvalue:
 *
 *     geometry       mu of the motions that positions give; free is one with
 *                    |mu| <= 1e-4 lambda_f, cleanly so below 1e-8 lambda_f
 *     null space     eigenvalues below lambda_f / 100 by the inertia of
 *                    K - tau M, which knows nothing of the eigensolver
 *     eigenvectors   rigid ones among the lowest pairs
 *
 * and the sine of the largest angle, in the inner product of M, by which the
 * free motions Phi leave the span of the rigid eigenvectors X:
 *
 *     E = Phi - X X'M Phi,    sin^2 = largest eigenvalue of E'ME.
 */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double cleanly_free = 1e-8; /* of lambda_f, as eigen.h has it */
static const double nearly_free = 1e-4;

/* Trace of K over trace of M: an eigenvalue that is certainly not rigid. */
static double typical(const ritz_component *c)
{
    const ritz_sparse *const both[] = {&c->K, &c->M};
    double trace[2] = {0.0, 0.0};

    for (int k = 0; k < 2; k++)
        for (int64_t j = 0; j < c->num_dofs; j++)
            trace[k] += ritz_sparse_diagonal(both[k], j);
    return trace[1] > 0.0 ? fabs(trace[0]) / trace[1] : 1.0;
}

static void check_geometry(ritz_auditor *it)
{
    double scale = isfinite(it->softest) ? it->softest : typical(it->component);
    int64_t motions = it->Phi.ncol;
    double worst = 0.0;

    it->num_free = 0;
    for (int64_t k = 0; k < motions; k++)
        if (fabs(it->mu[k]) <= nearly_free * scale) {
            it->num_free++;
            worst = fmax(worst, fabs(it->mu[k]) / scale);
        }
    if (it->num_free < motions && it->rounded)
        ritz_auditor_say(it, "rigid-modes-geometry", (double)it->num_free,
                         (double)motions, RITZ_FAIL, NULL,
                         "only %" PRId64 " of %" PRId64 " rigid motions are "
                         "free: rounding of the source holds the others",
                         it->num_free, motions);
    else if (it->num_free < motions)
        ritz_auditor_say(it, "rigid-modes-geometry", (double)it->num_free,
                         (double)motions, RITZ_PASS, NULL,
                         "%" PRId64 " of %" PRId64 " rigid motions are free, "
                         "stiffness holds the others",
                         it->num_free, motions);
    else
        ritz_auditor_say(it, "rigid-modes-geometry", (double)it->num_free,
                         (double)motions,
                         worst <= cleanly_free ? RITZ_PASS : RITZ_WARN, NULL,
                         "all %" PRId64 " rigid motions are free: the most "
                         "that one is held is %.1e of the first flexible "
                         "eigenvalue",
                         motions, worst);
}

/* How far the free motions leave the span of X. */
static ritz_status measure_angle(const ritz_auditor *it, const ritz_dense *X,
                                 double *out)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *M = &it->component->M;
    ritz_dense Phi = {0}, MPhi = {0}, C = {0}, E = {0}, ME = {0}, EME = {0};
    double trace = 0.0;

    RITZ_TRY(ritz_dense_new(it->Phi.nrow, it->num_free, &Phi));
    for (int64_t k = 0, kept = 0; kept < it->num_free; k++)
        if (fabs(it->mu[k]) <= nearly_free * it->softest) {
            for (int64_t i = 0; i < Phi.nrow; i++)
                ritz_dense_col(&Phi, kept)[i] = ritz_dense_col(&it->Phi, k)[i];
            kept++;
        }
    RITZ_TRY(ritz_sparse_mul(M, &Phi, &MPhi));
    RITZ_TRY(ritz_dense_mul_tn(X, &MPhi, &C));
    RITZ_TRY(ritz_dense_mul(X, &C, &E));
    for (int64_t k = 0; k < E.nrow * E.ncol; k++)
        E.val[k] = Phi.val[k] - E.val[k];
    RITZ_TRY(ritz_sparse_mul(M, &E, &ME));
    RITZ_TRY(ritz_dense_mul_tn(&E, &ME, &EME));
    for (int64_t k = 0; k < EME.nrow; k++) /* bounds the largest eigenvalue */
        trace += ritz_dense_col(&EME, k)[k];
    *out = sqrt(fmax(trace, 0.0));
done:
    ritz_dense_free(&Phi);
    ritz_dense_free(&MPhi);
    ritz_dense_free(&C);
    ritz_dense_free(&E);
    ritz_dense_free(&ME);
    ritz_dense_free(&EME);
    return status;
}

static void say_agreement(ritz_auditor *it, int64_t eigen, double sine)
{
    const double limit = 1e-6;
    const double bearable = 1e-3;
    const char *const name = "rigid-modes-agree";

    if (it->rounded && eigen < it->Phi.ncol)
        ritz_auditor_say(it, name, nan(""), limit, RITZ_FAIL, NULL,
                         "%" PRId64 " rigid modes where positions give %" PRId64
                         " motions, which rounding holds",
                         eigen, it->Phi.ncol);
    else if (eigen < it->num_free)
        ritz_auditor_say(it, name, sine, limit, RITZ_FAIL, NULL,
                         "geometry gives %" PRId64 " free motions, "
                         "eigenvectors only %" PRId64,
                         it->num_free, eigen);
    else if (sine > limit)
        ritz_auditor_say(it, name, sine, limit,
                         sine > bearable ? RITZ_FAIL : RITZ_WARN, NULL,
                         "the eigenvectors leave the motions that positions "
                         "give: is a position or a frame wrong?");
    else if (eigen > it->num_free && it->placed)
        ritz_auditor_say(it, name, sine, limit, RITZ_WARN, NULL,
                         "%" PRId64 " rigid modes but %" PRId64 " by geometry:"
                         " a mechanism, or several bodies",
                         eigen, it->num_free);
    else
        ritz_auditor_say(it, name, sine, limit, RITZ_PASS, NULL,
                         it->num_free > 0
                             ? "geometry and eigenvectors span the same motions"
                             : "neither finds a free motion");
}

/* The third way is another factor: MUMPS instead of CHOLMOD and ARPACK. */
static ritz_status check_null_space(ritz_auditor *it, int64_t eigen)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    double tau = (isfinite(it->softest) ? it->softest : typical(c)) / 100.0;
    int64_t count = 0;

    status = ritz_eigen_count(&c->K, &c->M, tau, &count);
    if (status == RITZ_ERR_SINGULAR) {
        status = RITZ_OK;
        ritz_auditor_say(it, "rigid-modes-null-space", nan(""), (double)eigen,
                         RITZ_FAIL, NULL, "cannot be counted: %s",
                         ritz_error_message());
        goto done;
    }
    RITZ_TRY(status);
    ritz_auditor_say(it, "rigid-modes-null-space", (double)count, (double)eigen,
                     count == eigen ? RITZ_PASS : RITZ_FAIL, NULL,
                     count == eigen
                         ? "stiffness lets as many motions free as there are "
                           "rigid eigenvectors"
                         : "not as many as rigid eigenvectors");
done:
    return status;
}

/*
 * First flexible eigenvalue. Where rounding holds the body its rigid modes are
 * not told from others by size, and the first six are taken for them.
 */
static double find_softest(const ritz_auditor *it, const ritz_pairs *pairs)
{
    int64_t rigid = pairs->num_rigid;
    int64_t k = it->rounded && rigid < 6 ? 6 : rigid;

    return k < pairs->Phi.ncol && pairs->lambda[k] > 0.0 ? pairs->lambda[k]
                                                         : nan("");
}

static void say_eigenvectors(ritz_auditor *it, const ritz_pairs *pairs)
{
    int64_t count = pairs->num_rigid;

    ritz_auditor_say(
        it, "rigid-modes-eigenvectors", (double)count, 6.0,
        count > 6 || (count == 0 && pairs->lambda[0] < 0.0) ? RITZ_WARN
                                                            : RITZ_PASS,
        NULL,
        isfinite(it->softest)
            ? "%" PRId64 " rigid modes, the first flexible one at %.6g Hz"
            : "%" PRId64 " rigid modes and no flexible one",
        count, ritz_eigen_hertz(it->softest));
}

/* No stiffness at all: everything with mass is free. */
static void audit_rigid_body(ritz_auditor *it)
{
    int64_t n = it->component->num_dofs;

    it->num_free = it->Phi.ncol;
    ritz_auditor_say(it, "rigid-modes-eigenvectors", (double)n, 6.0,
                     n > 6 ? RITZ_FAIL : RITZ_PASS, NULL,
                     n > 6 ? "%" PRId64 " dofs without any stiffness: is the "
                             "stiffness missing?"
                           : "a rigid body of %" PRId64 " dofs",
                     n);
}

ritz_status ritz_audit_rigid(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    const ritz_span span = {.modes = 7};
    ritz_pairs pairs = {0};
    ritz_dense X = {0};
    double sine = 0.0;

    if (it->rigid) {
        audit_rigid_body(it);
        goto done;
    }
    status = ritz_eigen_sparse(&c->K, &c->M, &span, &pairs);
    if (status == RITZ_ERR_SINGULAR || status == RITZ_ERR_CONVERGENCE) {
        status = RITZ_OK;
        ritz_auditor_say(it, "rigid-modes-eigenvectors", nan(""), 6.0,
                         RITZ_FAIL, NULL, "no modes: %s", ritz_error_message());
        check_geometry(it);
        goto done;
    }
    RITZ_TRY(status);
    it->softest = find_softest(it, &pairs);
    check_geometry(it);
    RITZ_TRY(check_null_space(it, pairs.num_rigid));
    say_eigenvectors(it, &pairs);
    if (it->num_free > 0 && isfinite(it->softest)) {
        RITZ_TRY(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &X));
        RITZ_TRY(measure_angle(it, &X, &sine));
    }
    say_agreement(it, pairs.num_rigid, sine);
done:
    ritz_pairs_free(&pairs);
    ritz_dense_free(&X);
    return status;
}
