/*
 * Mass properties: with rigid motions R = [T, Theta] about the mass centre,
 *
 *     R'MR = | m I   0  |
 *            |  0   J_c |
 *
 * whatever the body is: three equal masses, no coupling between translation
 * and rotation, and principal moments with J_1 + J_2 >= J_3 > 0. Directions
 * without any dof, as in plane models, are passed over.
 */
#include "check/audit_parts.h"

#include <ritz/eigen.h>
#include <ritz/reduced.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Relative, as of symmetry: lumping, averaging and single precision stay
 * below; a mass that is not the same along all axes does not. */
static const double agree_within = 1e-6;
static const double bearable = 1e-2;

static ritz_verdict judge(double value)
{
    if (value <= agree_within)
        return RITZ_PASS;
    return value <= bearable ? RITZ_WARN : RITZ_FAIL;
}

/* R'MR, about the mass centre where positions are known. */
static ritz_status condense(const ritz_auditor *it, const double *centre,
                            ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense R = {0};

    if (it->placed)
        RITZ_TRY(ritz_rigid_geometry(it->component, centre, &R));
    else
        RITZ_TRY(ritz_dense_copy(&it->R, &R));
    RITZ_TRY(ritz_sparse_condense(&it->component->M, &R, out));
done:
    ritz_dense_free(&R);
    return status;
}

/* Whether any dof lies along a basic axis. */
static bool has_direction(const ritz_auditor *it, int64_t j)
{
    for (int64_t i = 0; i < it->R.nrow; i++)
        if (fabs(ritz_dense_col(&it->R, j)[i]) > 0.0)
            return true;
    return false;
}

/* The three masses agree; the largest of them. */
static double check_masses(ritz_auditor *it, const ritz_dense *A)
{
    double least = DBL_MAX;
    double most = 0.0;
    double spread = 0.0;

    for (int64_t j = 0; j < 3; j++) {
        if (!has_direction(it, j))
            continue;
        least = fmin(least, ritz_dense_col(A, j)[j]);
        most = fmax(most, ritz_dense_col(A, j)[j]);
    }
    if (!(most > 0.0)) {
        ritz_auditor_say(it, "mass-translations", nan(""), agree_within,
                         RITZ_WARN, NULL, "no mass moves with a translation");
        return 0.0;
    }
    spread = (most - least) / most;
    ritz_auditor_say(
        it, "mass-translations", spread, agree_within, judge(spread), NULL,
        spread <= agree_within ? "mass %.9g, the same along all axes"
                               : "mass %.9g along one axis, %.9g along another",
        most, least);
    return most;
}

/*
 * What couples translations with each other, and with rotations about the mass
 * centre, against m and m times the size.
 */
static void check_coupling(ritz_auditor *it, const ritz_dense *A, double mass,
                           const double *centre)
{
    double worst = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < 3; i++) {
            double scale = mass * (j < 3 ? 1.0 : it->size);

            if (i == j || !has_direction(it, i) ||
                !has_direction(it, j < 3 ? j : j - 3))
                continue;
            worst = fmax(worst, fabs(ritz_dense_col(A, j)[i]) / scale);
        }
    if (it->placed)
        ritz_auditor_say(it, "mass-coupling", worst, agree_within, judge(worst),
                         NULL, "mass centre at %.6g %.6g %.6g", centre[0],
                         centre[1], centre[2]);
    else
        ritz_auditor_say(it, "mass-coupling", worst, agree_within, judge(worst),
                         NULL, "translations are %scoupled by mass",
                         worst <= agree_within ? "not " : "");
}

/* Principal moments of inertia, ascending. */
static ritz_status find_moments(const ritz_dense *A, double J[3])
{
    ritz_status status = RITZ_OK;
    ritz_dense tensor = {0}, I = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_dense_new(3, 3, &tensor));
    RITZ_TRY(ritz_dense_new(3, 3, &I));
    for (int64_t j = 0; j < 3; j++) {
        ritz_dense_col(&I, j)[j] = 1.0;
        for (int64_t i = 0; i < 3; i++)
            ritz_dense_col(&tensor, j)[i] = ritz_dense_col(A, 3 + j)[3 + i];
    }
    ritz_dense_symmetrise(&tensor);
    RITZ_TRY(ritz_eigen_dense(&tensor, &I, &pairs));
    for (int64_t k = 0; k < 3; k++)
        J[k] = pairs.lambda[k];
done:
    ritz_dense_free(&tensor);
    ritz_dense_free(&I);
    ritz_pairs_free(&pairs);
    return status;
}

static ritz_status check_moments(ritz_auditor *it, const ritz_dense *A)
{
    double J[3] = {0.0, 0.0, 0.0};
    double margin = 0.0;
    bool spatial = true;

    for (int64_t j = 0; j < 6; j++)
        spatial = spatial && has_direction(it, j);
    if (!spatial)
        return RITZ_OK;
    RITZ_CHECK(find_moments(A, J));
    margin = J[2] > 0.0 ? (J[0] + J[1] - J[2]) / J[2] : 0.0;
    ritz_auditor_say(
        it, "inertia-tensor", margin, -agree_within,
        margin >= -agree_within && J[0] >= -agree_within * J[2] ? RITZ_PASS
                                                                : RITZ_FAIL,
        NULL, "principal moments %.6g %.6g %.6g%s", J[0], J[1], J[2],
        margin >= -agree_within ? "" : ": no body has these moments");
    return RITZ_OK;
}

ritz_status ritz_audit_mass(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    ritz_inertia inertia = {0};
    ritz_dense A = {0};
    double mass = 0.0;

    if (it->placed)
        RITZ_TRY(ritz_inertia_of(it->component, &inertia));
    RITZ_TRY(condense(it, inertia.centre, &A));
    mass = check_masses(it, &A);
    if (mass > 0.0) {
        check_coupling(it, &A, mass, inertia.centre);
        if (A.ncol == 6)
            RITZ_TRY(check_moments(it, &A));
    }
done:
    ritz_dense_free(&A);
    return status;
}
