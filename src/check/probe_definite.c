/*
 * Definiteness. With S = diag(A)^-1/2, or diag(M)^-1/2 of D and K4, as matrices
 * mix kg with kg m^2: the least eigenvalue of S A S over the largest, and where
 * its eigenvector S^-1 x lies.
 *
 * Of D only the symmetric part counts: v'D v = v'(D + D')v / 2, and what is
 * antisymmetric does no work.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "poles/massless.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* The least eigenvalue over the largest magnitude, and its vector. */
typedef struct bottom {
    double value;
    double *motion; /* n */
} bottom;

/* 1 / sqrt of the diagonal, 1 where it is 0. */
static double scale_of(const ritz_dense *by, int64_t j)
{
    double d = fabs(ritz_dense_col(by, j)[j]);

    return d > 0.0 ? 1.0 / sqrt(d) : 1.0;
}

static ritz_status find_least(const ritz_dense *A, const ritz_dense *by,
                              bottom *out)
{
    ritz_status status = RITZ_OK;
    int n = (int)A->nrow;
    ritz_dense V = {0};
    double *lambda = NULL;
    double most = 0.0;

    RITZ_NEW(out->motion, n);
    RITZ_NEW(lambda, n + 1);
    RITZ_TRY(ritz_dense_copy(A, &V));
    ritz_dense_symmetrise(&V);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&V, j)[i] *= scale_of(by, i) * scale_of(by, j);
    if (n > 0)
        RITZ_FAIL_IF(
            LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', n, V.val, n, lambda) != 0,
            RITZ_ERR_CONVERGENCE,
            "eigenvalues of a reduced matrix were not found");
    for (int64_t k = 0; k < n; k++)
        most = fmax(most, fabs(lambda[k]));
    out->value = most > 0.0 ? lambda[0] / most : 0.0;
    for (int64_t i = 0; i < n; i++)
        out->motion[i] = ritz_dense_col(&V, 0)[i] * scale_of(by, i);
done:
    free(lambda);
    ritz_dense_free(&V);
    return status;
}

ritz_status ritz_probe_definite_mass(ritz_prober *it)
{
    static const char name[] = "mass-definite";
    ritz_status status = RITZ_OK;
    const ritz_dense *M = &it->model.M;
    double limit = -RITZ_PROBE_TIMES * (double)M->nrow * DBL_EPSILON;
    bottom found = {0};
    char where[RITZ_WHERE_SIZE];

    RITZ_TRY(find_least(M, M, &found));
    if (found.value >= limit) {
        ritz_prober_say(it, name, found.value, limit, RITZ_PASS, "",
                        "no negative eigenvalue");
    } else {
        it->usable = it->definite = false;
        ritz_prober_where(it, found.motion, where);
        ritz_prober_say(it, name, found.value, limit, RITZ_FAIL, where,
                        "mass with a negative eigenvalue, %.2g of the largest",
                        found.value);
    }
done:
    free(found.motion);
    return status;
}

/* N'DN of motions without mass, entries that are rounding alone taken out. */
static ritz_status damping_of(const ritz_dense *D, const ritz_dense *N,
                              ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const double rounding = 64.0 * DBL_EPSILON;
    /* what an entry of N may err by, of its largest, squared */
    double floor = 1e-20 * ritz_dense_max(D) * pow(ritz_dense_max(N), 2.0);
    ritz_dense most = {0};

    RITZ_TRY(ritz_dense_project(D, N, out));
    RITZ_TRY(ritz_dense_terms(D, N, &most));
    for (int64_t k = 0; k < out->nrow * out->ncol; k++)
        if (fabs(out->val[k]) <= rounding * most.val[k] + floor)
            out->val[k] = 0.0;
done:
    ritz_dense_free(&most);
    return status;
}

/* Of motions without mass N the least n'D n: k + c s = 0 grows if c < 0. */
static ritz_status find_massless(const ritz_prober *it, bottom *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {.K = &it->model.K, .M = &it->model.M};
    ritz_dense N = {0}, D = {0}, unit = {0};
    bottom found = {0};

    if (it->modes.count == it->modes.num_dofs)
        return RITZ_OK;
    RITZ_TRY(ritz_massless(&model, &it->modes.Phi, it->modes.lambda, &N));
    RITZ_TRY(damping_of(&it->model.D, &N, &D));
    RITZ_TRY(ritz_dense_new(N.ncol, N.ncol, &unit));
    RITZ_TRY(find_least(&D, &unit, &found));
    if (found.value < -RITZ_PROBE_SLIGHT) {
        RITZ_NEW(out->motion, N.nrow);
        out->value = found.value;
        for (int64_t j = 0; j < N.ncol; j++)
            for (int64_t i = 0; i < N.nrow; i++)
                out->motion[i] += ritz_dense_col(&N, j)[i] * found.motion[j];
    }
done:
    free(found.motion);
    ritz_dense_free(&N);
    ritz_dense_free(&D);
    ritz_dense_free(&unit);
    return status;
}

/* Share of D that is antisymmetric, in the Frobenius norm. */
static double skew_of(const ritz_dense *D)
{
    double whole = 0.0;
    double skew = 0.0;

    for (int64_t j = 0; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++) {
            double a = ritz_dense_col(D, j)[i];
            double b = ritz_dense_col(D, i)[j];

            whole = hypot(whole, a);
            skew = hypot(skew, 0.5 * (a - b));
        }
    return whole > 0.0 ? skew / whole : 0.0;
}

static void say_damping(ritz_prober *it, const bottom *found, double limit)
{
    static const char name[] = "damping-definite";
    double skew = skew_of(&it->model.D);
    bool slight = found->value >= -RITZ_PROBE_SLIGHT;
    char where[RITZ_WHERE_SIZE] = "";

    if (found->value >= limit && skew > 0.0) {
        ritz_prober_say(it, name, found->value, limit, RITZ_PASS, "",
                        "no negative eigenvalue; %.3g %% is gyroscopic, which "
                        "does no work",
                        100.0 * skew);
        return;
    }
    if (found->value < limit)
        ritz_prober_where(it, found->motion, where);
    it->definite = it->definite && found->value >= limit;
    ritz_prober_say(it, name, found->value, limit,
                    found->value >= limit ? RITZ_PASS : RITZ_WARN, where, "%s",
                    found->value >= limit ? "no negative eigenvalue"
                    : slight ? "damping with a negative eigenvalue, no larger "
                               "than ten digits leave"
                             : "damping with a negative eigenvalue: a motion "
                               "is driven");
}

ritz_status ritz_probe_definite_damping(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *D = &it->model.D;
    double limit =
        -RITZ_PROBE_TIMES * RITZ_PROBE_TIMES * (double)D->nrow * DBL_EPSILON;
    bottom found = {0}, massless = {0};
    char where[RITZ_WHERE_SIZE];

    if (!it->usable || !D->val)
        return RITZ_OK;
    RITZ_TRY(find_massless(it, &massless));
    if (massless.motion) {
        it->definite = false;
        ritz_prober_where(it, massless.motion, where);
        ritz_prober_say(it, "damping-definite", massless.value, 0.0, RITZ_FAIL,
                        where,
                        "negative damping of a motion without mass, which "
                        "grows");
        goto done;
    }
    RITZ_TRY(find_least(D, &it->model.M, &found));
    say_damping(it, &found, limit);
done:
    free(found.motion);
    free(massless.motion);
    return status;
}

ritz_status ritz_probe_definite_structural(ritz_prober *it)
{
    static const char name[] = "structural-definite";
    ritz_status status = RITZ_OK;
    const ritz_dense *K4 = &it->reduced->K4;
    bottom found = {0};
    char where[RITZ_WHERE_SIZE] = "";
    bool holds = true;

    if (!it->usable || !K4->val)
        return RITZ_OK;
    RITZ_TRY(find_least(K4, &it->model.M, &found));
    holds = found.value >= -RITZ_PROBE_SLIGHT;
    if (!holds)
        ritz_prober_where(it, found.motion, where);
    ritz_prober_say(it, name, found.value, -RITZ_PROBE_SLIGHT,
                    holds ? RITZ_PASS : RITZ_FAIL, where, "%s",
                    holds ? "no negative eigenvalue"
                          : "structural damping with a negative eigenvalue: "
                            "harmonic motion gains energy");
done:
    free(found.motion);
    return status;
}
