/*
 * Definiteness. With S = diag(A)^-1/2, or diag(M)^-1/2 of D and K4, as matrices
 * mix kg with kg m^2: the least eigenvalue of S A S over the largest, and where
 * its eigenvector S^-1 x lies.
 *
 * Of D only the symmetric part counts: v'D v = v'(D + D')v / 2, and what is
 * antisymmetric does no work.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "model/squares.h"
#include "poles/poles.h"

#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns that a line names, at most. */
enum { SHOWN = 3 };

/* "column 3 constraint, grid 101 T3", "column 7 normal, 12.3 Hz" */
static void name_column(const ritz_reduced *reduced, int64_t j,
                        char text[RITZ_NAME_SIZE])
{
    const ritz_columns *columns = &reduced->columns;
    char detail[RITZ_DOF_NAME_SIZE + 4] = "";
    char dof[RITZ_DOF_NAME_SIZE];
    int64_t row = columns->dof[j];

    if (row >= 0 && reduced->dof && row < reduced->num_dofs)
        snprintf(detail, sizeof detail, ", %s",
                 ritz_dof_name(reduced->dof[row], dof));
    else if (isfinite(columns->hertz[j]))
        snprintf(detail, sizeof detail, ", %.4g Hz", columns->hertz[j]);
    snprintf(text, RITZ_NAME_SIZE, "column %lld %s%.36s", (long long)j + 1,
             ritz_column_name(columns->kind[j]), detail);
}

/* Participation of coordinate j: unlike lengths and angles, energies
   compare. */
static double share_of(const ritz_checker *it, const double *motion, int64_t j)
{
    double m = fabs(ritz_dense_col(&it->model.M, j)[j]);
    double k = fabs(ritz_dense_col(&it->model.K, j)[j]);

    return fabs(motion[j]) * sqrt(m > 0.0 ? m : k);
}

/* Name the columns that have most of a motion. */
static void name_columns(const ritz_checker *it, const double *motion,
                         char where[RITZ_WHERE_SIZE])
{
    double largest = HUGE_VAL;
    double below = HUGE_VAL;

    where[0] = '\0';
    if (!it->reduced || it->reduced->columns.count != it->model.K.nrow)
        return;
    for (int shown = 0; shown < SHOWN; shown++) {
        char text[RITZ_NAME_SIZE];
        double best = 0.0;
        int64_t at = -1;

        for (int64_t j = 0; j < it->model.K.nrow; j++) {
            double s = share_of(it, motion, j);

            if (s < below && s > best) {
                best = s;
                at = j;
            }
        }
        if (shown == 0)
            largest = best;
        if (at < 0 || best < RITZ_WORTH_NAMING * largest)
            return;
        name_column(it->reduced, at, text);
        ritz_checker_list(where, text);
        below = best;
    }
}

/* 1 / sqrt of the diagonal, 1 where it is 0. */
static double find_scale(const ritz_dense *by, int64_t j)
{
    double d = fabs(ritz_dense_col(by, j)[j]);

    return d > 0.0 ? 1.0 / sqrt(d) : 1.0;
}

ritz_status ritz_least_value_new(const ritz_dense *A, const ritz_dense *by,
                                 ritz_least_value *out)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) V = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    double most = 0.0;

    RITZ_CHECK_NEW(out->motion, n);
    RITZ_CHECK_NEW(lambda, n + 1);
    RITZ_CHECK(ritz_dense_copy(A, &V));
    ritz_dense_symmetrise(&V);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&V, j)[i] *= find_scale(by, i) * find_scale(by, j);
    if (n > 0)
        RITZ_REFUSE_IF(
            LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', n, V.val, n, lambda) != 0,
            RITZ_ERR_CONVERGENCE,
            "eigenvalues of a reduced matrix were not found");
    for (int64_t k = 0; k < n; k++)
        most = fmax(most, fabs(lambda[k]));
    out->value = most > 0.0 ? lambda[0] / most : 0.0;
    for (int64_t i = 0; i < n; i++)
        out->motion[i] = ritz_dense_col(&V, 0)[i] * find_scale(by, i);
    return RITZ_OK;
}

void ritz_least_value_free(ritz_least_value *found)
{
    free(found->motion);
    *found = (ritz_least_value){0};
}

double ritz_least_rounding(const ritz_dense *A)
{
    return -RITZ_POLE_BOUND_FACTOR * (double)A->nrow * DBL_EPSILON;
}

/* Say that no eigenvalue is below a limit, or @p bad and where the motion
   is. */
static void say_least(ritz_checker *it, const char *name,
                      const ritz_least_value *found, double limit,
                      ritz_verdict verdict, const char *bad)
{
    bool holds = found->value >= limit;
    char where[RITZ_WHERE_SIZE] = "";

    if (!holds)
        name_columns(it, found->motion, where);
    it->definite = it->definite && holds;
    ritz_checker_say(it, name, found->value, limit, holds ? RITZ_PASS : verdict,
                     where, "%s", holds ? "no negative eigenvalue" : bad);
}

ritz_status ritz_check_reduced_mass(ritz_checker *it)
{
    const ritz_dense *M = &it->model.M;
    RITZ_OWN(ritz_least_value) found = {0};
    char bad[RITZ_NAME_SIZE];

    RITZ_CHECK(ritz_least_value_new(M, M, &found));
    snprintf(bad, sizeof bad,
             "mass with a negative eigenvalue, %.2g of the largest",
             found.value);
    say_least(it, "mass-definite", &found, ritz_least_rounding(M), RITZ_FAIL,
              bad);
    it->usable = it->definite;
    return RITZ_OK;
}

/* Least n'D n of motions without mass, N: k + c s = 0 grows if c < 0. */
static ritz_status find_massless(const ritz_checker *it, ritz_least_value *out)
{
    const ritz_second_order model = {.K = &it->model.K, .M = &it->model.M};
    RITZ_OWN(ritz_dense) N = {0}, D = {0}, unit = {0};
    RITZ_OWN(ritz_least_value) found = {0};
    double floor = 0.0; /* what an entry of N may err by, of its largest,
                           squared */

    if (it->modes.count == it->modes.num_dofs)
        return RITZ_OK;
    RITZ_CHECK(ritz_massless(&model, &it->modes.Phi, it->modes.lambda, &N));
    floor = RITZ_MASSLESS_DAMPING * ritz_dense_max(&it->model.D) *
            pow(ritz_dense_max(&N), 2.0);
    RITZ_CHECK(ritz_project_above(&it->model.D, &N, floor, &D));
    RITZ_CHECK(ritz_dense_new(N.ncol, N.ncol, &unit));
    RITZ_CHECK(ritz_least_value_new(&D, &unit, &found));
    if (found.value >= -RITZ_CONDENSATION_LOSS)
        return RITZ_OK;
    RITZ_CHECK_NEW(out->motion, N.nrow);
    out->value = found.value;
    for (int64_t j = 0; j < N.ncol; j++)
        for (int64_t i = 0; i < N.nrow; i++)
            out->motion[i] += ritz_dense_col(&N, j)[i] * found.motion[j];
    return RITZ_OK;
}

ritz_status ritz_check_reduced_damping(ritz_checker *it)
{
    static const char name[] = "damping-definite";
    const ritz_dense *D = &it->model.D;
    double limit = RITZ_POLE_BOUND_FACTOR * ritz_least_rounding(D);
    double skew = ritz_dense_skew(D);
    RITZ_OWN(ritz_least_value) found = {0}, massless = {0};

    RITZ_CHECK(find_massless(it, &massless));
    if (massless.motion) {
        say_least(it, name, &massless, 0.0, RITZ_FAIL,
                  "negative damping of a motion without mass, which grows");
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_least_value_new(D, &it->model.M, &found));
    if (found.value >= limit && skew > 0.0)
        ritz_checker_say(it, name, found.value, limit, RITZ_PASS, "",
                         "no negative eigenvalue; %.3g %% is gyroscopic, which "
                         "does no work",
                         100.0 * skew);
    else
        say_least(it, name, &found, limit, RITZ_WARN,
                  found.value >= -RITZ_CONDENSATION_LOSS
                      ? "damping with a negative eigenvalue, no larger than "
                        "ten digits leave"
                      : "damping with a negative eigenvalue: a motion gains "
                        "energy");
    return RITZ_OK;
}

/* Proofs for free motion do not count on K4. */
ritz_status ritz_check_reduced_structural(ritz_checker *it)
{
    const bool definite = it->definite;
    RITZ_OWN(ritz_least_value) found = {0};

    RITZ_CHECK(ritz_least_value_new(&it->reduced->K4, &it->model.M, &found));
    say_least(it, "structural-definite", &found, -RITZ_CONDENSATION_LOSS,
              RITZ_FAIL,
              "structural damping with a negative eigenvalue: harmonic motion "
              "gains energy");
    it->definite = definite;
    return RITZ_OK;
}

/*
 * Stiffness, by the modes of (K, M), which other checks use too. A rigid motion
 * phi has none: phi'K phi beyond rounding is of matrices of too few digits,
 * which hold a free body or make it grow.
 */

ritz_status ritz_check_modes(const ritz_structure *model,
                             const ritz_damping *damping,
                             ritz_modal_model *modes, bool *singular)
{
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_io) none = {0};

    RITZ_CHECK(ritz_io_new(model->K.nrow, 0, 0, &none));
    status = ritz_modal_model_new(model, &none, damping, modes);
    *singular = status == RITZ_ERR_SINGULAR;
    return *singular ? RITZ_OK : status;
}

/* phi'K phi of rigid motions, 0 where it is rounding: the largest magnitude. */
static ritz_status rigid_stiffness(const ritz_checker *it, double *out,
                                   int64_t *at)
{
    const ritz_dense *K = &it->model.K;
    ritz_dense Phi = ritz_dense_part(&it->modes.Phi, 0, it->modes.num_rigid);
    RITZ_OWN(ritz_dense) own = {0}, most = {0};

    *out = 0.0;
    *at = 0;
    RITZ_CHECK(ritz_dense_congruence(K, &Phi, &own));
    RITZ_CHECK(ritz_dense_terms(K, &Phi, &most));
    for (int64_t k = 0; k < Phi.ncol; k++) {
        double value = ritz_dense_col(&own, k)[k];

        if (fabs(value) > RITZ_SUM_ROUNDING * ritz_dense_col(&most, k)[k] &&
            fabs(value) > fabs(*out)) {
            *out = value;
            *at = k;
        }
    }
    return RITZ_OK;
}

/* Matrices of few digits hold a rigid motion, or make it grow. */
static ritz_status say_rigid(ritz_checker *it, bool *said)
{
    const ritz_modal_model *modes = &it->modes;
    int64_t r = modes->num_rigid;
    double softest = r < modes->count ? modes->lambda[r] : HUGE_VAL;
    double value = 0.0;
    int64_t at = 0;
    char where[RITZ_WHERE_SIZE] = "";

    RITZ_CHECK(rigid_stiffness(it, &value, &at));
    *said = value < -RITZ_DRIFT_UNNOTICED * softest ||
            value > RITZ_FREE_MOTION * softest;
    if (!*said)
        return RITZ_OK;
    it->definite = value > 0.0;
    name_columns(it, ritz_dense_col(&modes->Phi, at), where);
    ritz_checker_say(
        it, "stiffness-definite", value / softest, -RITZ_FREE_MOTION,
        value < -RITZ_FREE_MOTION * softest ? RITZ_FAIL : RITZ_WARN, where,
        "%s stiffness of a rigid motion, %.2g of the softest flexible one: too "
        "few digits, a free body is not free",
        value < 0.0 ? "negative" : "positive", value / softest);
    return RITZ_OK;
}

/* Eigenvalue of the first mode that is neither counted as rigid nor found to be
   a rigid motion. */
static double find_softest(const ritz_checker *it)
{
    const ritz_modal_model *modes = &it->modes;
    int64_t k = modes->num_rigid;

    while (k < modes->count && it->moves && it->moves[k])
        k++;
    return k < modes->count ? modes->lambda[k] : HUGE_VAL;
}

/* Report negative eigenvalues of the forces between bodies of
   dual-craig-bampton. */
static void say_squares(ritz_checker *it, double value)
{
    const ritz_modal_model *modes = &it->modes;
    const ritz_measure *measure =
        ritz_measures_find(&it->reduced->errors, RITZ_NEGATIVE_SQUARES);
    int64_t k = modes->num_rigid;

    while (k < modes->count && modes->lambda[k] < 0.0)
        k++;
    ritz_checker_say(
        it, "stiffness-definite", value, 0.0, RITZ_FAIL,
        measure->where + strcspn(measure->where, "m"), /* "mode 41, -28 Hz" */
        "%" PRId64 " negative squares of the forces that join bodies of "
        "dual-craig-bampton, and of no motion of these: they grow by %.3g to "
        "%.3g/s; macneal-rubin has the same columns",
        k - modes->num_rigid, sqrt(-modes->lambda[k - 1]),
        sqrt(-modes->lambda[modes->num_rigid]));
}

static void say_negative(ritz_checker *it, double value)
{
    static const char name[] = "stiffness-definite";
    const ritz_modal_model *modes = &it->modes;
    const int64_t r = modes->num_rigid;
    const double least = modes->lambda[r], softest = find_softest(it);
    char where[RITZ_WHERE_SIZE] = "";

    if (ritz_measures_find(&it->reduced->errors, RITZ_NEGATIVE_SQUARES)) {
        say_squares(it, value);
        return;
    }
    name_columns(it, ritz_dense_col(&modes->Phi, r), where);
    if (it->moves && it->moves[r])
        ritz_checker_say(it, name, least / softest, 0.0, RITZ_FAIL, where,
                         "negative stiffness of a rigid motion, %.2g of the "
                         "softest flexible one, %.4g Hz: too few digits, a "
                         "free body is not free",
                         least / softest, ritz_eigen_hertz(least));
    else
        ritz_checker_say(it, name, value, 0.0, RITZ_FAIL, where,
                         "stiffness with a negative eigenvalue, %.4g "
                         "rad^2/s^2",
                         least);
}

/* Report rigid motions with positive stiffness: supports, or a stiffness of too
   few digits. */
static bool say_held(ritz_checker *it, double value)
{
    const ritz_modal_model *modes = &it->modes;
    int64_t held = 0, last = modes->num_rigid;
    char where[RITZ_WHERE_SIZE];

    for (int64_t k = modes->num_rigid; it->moves && k < modes->count; k++)
        if (it->moves[k]) {
            held++;
            last = k;
        }
    if (held == 0)
        return false;
    snprintf(where, sizeof where, "%" PRId64 " rigid, %" PRId64 " held",
             modes->num_rigid, held);
    ritz_checker_say(it, "stiffness-definite", value, 0.0, RITZ_PASS, where,
                     "no negative eigenvalue; rigid motions are held, at up "
                     "to %.4g Hz: by supports, or by a stiffness of too few "
                     "digits",
                     ritz_eigen_hertz(modes->lambda[last]));
    return true;
}

static ritz_status say_stiffness(ritz_checker *it)
{
    static const char name[] = "stiffness-definite";
    const ritz_modal_model *modes = &it->modes;
    int64_t massless = modes->num_dofs - modes->count;
    int64_t r = modes->num_rigid;
    double least = r < modes->count ? modes->lambda[r] : 0.0;
    double most = modes->count > 0 ? modes->lambda[modes->count - 1] : 0.0;
    double value = 0.0;
    char where[RITZ_WHERE_SIZE] = "";
    bool said = false;

    most = fmax(most, -least);
    value = most > 0.0 ? least / most : 0.0;
    it->usable = least >= 0.0;
    it->definite = it->definite && it->usable;
    RITZ_CHECK(ritz_check_motions(it));
    if (least < 0.0) {
        say_negative(it, value);
        return RITZ_OK;
    }
    RITZ_CHECK(say_rigid(it, &said));
    if (said || say_held(it, value))
        return RITZ_OK;
    snprintf(where, sizeof where, "%" PRId64 " rigid", r);
    if (massless > 0)
        ritz_checker_say(it, name, value, 0.0, RITZ_PASS, where,
                         "no negative eigenvalue; %" PRId64 " of %" PRId64
                         " motions have no mass, which no explicit integrator "
                         "takes",
                         massless, modes->num_dofs);
    else
        ritz_checker_say(it, name, value, 0.0, RITZ_PASS, where,
                         "no negative eigenvalue beyond rigid motion");
    return RITZ_OK;
}

ritz_status ritz_check_reduced_stiffness(ritz_checker *it)
{
    bool singular = false;

    RITZ_CHECK(
        ritz_check_modes(&it->model, &it->damping, &it->modes, &singular));
    if (!singular)
        return say_stiffness(it);
    it->usable = it->definite = false;
    ritz_checker_say(it, "stiffness-definite", nan(""), 0.0, RITZ_FAIL, "",
                     "mass and stiffness that are singular together");
    return RITZ_OK;
}
