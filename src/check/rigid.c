/* Rigid-body motions: by geometry, by what holds them, and by eigenvectors. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Rigid-body motions by geometry: R, and an M-orthonormal basis Phi of their
 * span in which Phi'K Phi = diag(mu), without motions that have no mass.
 */

/* Dofs of grids without a position; scalar points need none. */
static ritz_status check_positions(ritz_checker *it)
{
    const ritz_component *c = it->component;
    RITZ_OWN_ARRAY bool *flag = NULL;

    RITZ_CHECK_NEW(flag, c->num_dofs);
    it->placed = true;
    for (int64_t k = 0; k < c->num_dofs; k++) {
        flag[k] = c->dof[k].component > 0 &&
                  ritz_grids_find(&c->grids, c->dof[k].grid) < 0;
        it->placed = it->placed && !flag[k];
    }
    ritz_checker_flagged(it, "positions", flag, RITZ_WARN,
                         "all grids have positions",
                         "dofs of grids without a position: rotations cannot "
                         "be checked, and axes are taken as basic");
    return RITZ_OK;
}

/* Mean position of the dofs' grids, and how far they reach. */
static void measure_extent(ritz_checker *it)
{
    const ritz_component *c = it->component;
    int64_t count = 0;

    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < c->num_dofs; k++) {
            int64_t g = ritz_grids_find(&c->grids, c->dof[k].grid);
            double square = 0.0;

            if (g < 0 || c->dof[k].component == 0)
                continue;
            count += pass == 0;
            for (int i = 0; i < 3; i++) {
                double d = c->grids.position[3 * g + i] - it->centre[i];

                if (pass == 0)
                    it->centre[i] += d / (double)count;
                square += d * d;
            }
            if (pass == 1)
                it->size = fmax(it->size, sqrt(square));
        }
    if (it->size <= 0.0)
        it->size = 1.0;
}

/* Without positions: translations along axes that are taken as basic. */
static ritz_status use_translations(ritz_checker *it)
{
    const ritz_component *c = it->component;

    RITZ_CHECK(ritz_dense_new(c->num_dofs, 3, &it->R));
    for (int64_t k = 0; k < c->num_dofs; k++)
        if (c->dof[k].component >= 1 && c->dof[k].component <= 3)
            ritz_dense_col(&it->R, c->dof[k].component - 1)[k] = 1.0;
    return RITZ_OK;
}

static ritz_status find_motions(ritz_checker *it)
{
    int64_t n = it->component->num_dofs;

    measure_extent(it);
    if (!it->placed)
        return use_translations(it);
    RITZ_CHECK(ritz_rigid_geometry(it->component, it->centre, &it->R));
    for (int64_t k = 3 * n; k < 6 * n; k++)
        it->R.val[k] /= it->size;
    return RITZ_OK;
}

/* Columns of V with lambda above 1e-10 of the largest, over sqrt(lambda). */
static void keep_massive(const ritz_pairs *pairs, ritz_dense *V)
{
    int64_t k = pairs->Phi.ncol;
    double largest = k > 0 ? pairs->lambda[k - 1] : 0.0;
    int64_t kept = 0;

    for (int64_t j = 0; j < k; j++) {
        if (!(pairs->lambda[j] > RITZ_MOTION_WITHOUT_MASS * largest))
            continue;
        for (int64_t i = 0; i < V->nrow; i++)
            ritz_dense_col(V, kept)[i] =
                ritz_dense_col(&pairs->Phi, j)[i] / sqrt(pairs->lambda[j]);
        kept++;
    }
    V->ncol = kept;
}

/* R V, M-orthonormal: V from the eigenvectors of R'MR that have mass. */
static ritz_status orthonormalise_motions(const ritz_checker *it,
                                          ritz_dense *out)
{
    RITZ_OWN(ritz_dense) B = {0}, V = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_sparse_condense(&it->component->M, &it->R, &B));
    RITZ_CHECK(ritz_general_symmetric(&B, &pairs));
    RITZ_CHECK(ritz_dense_new(B.nrow, B.nrow, &V));
    keep_massive(&pairs, &V);
    return ritz_dense_mul(&it->R, &V, out);
}

ritz_status ritz_check_geometry(ritz_checker *it)
{
    RITZ_OWN(ritz_dense) Q = {0}, A = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(check_positions(it));
    RITZ_CHECK(find_motions(it));
    RITZ_CHECK(orthonormalise_motions(it, &Q));
    RITZ_CHECK_NEW(it->mu, Q.ncol);
    if (Q.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_condense(&it->component->K, &Q, &A));
    RITZ_CHECK(ritz_general_symmetric(&A, &pairs));
    RITZ_CHECK(ritz_dense_mul(&Q, &pairs.Phi, &it->Phi));
    memcpy(it->mu, pairs.lambda, (size_t)Q.ncol * sizeof *it->mu);
    return RITZ_OK;
}

/*
 * Grounding: forces K r on a rigid motion r, and what their size means.
 *
 * A relative error u of the entries of K, or of r, leaves in row i at most
 * u sum_j |K_ij| |r_j|: with u = 1024 eps for elements computed in double
 * precision (a commercial code left 290 eps in a solid, measured), 2^-24 for
 * positions and frames kept in single precision or as eight letters of a card,
 * half a unit of the last digit for a source of few digits. Beyond that,
 * something holds the body.
 */

static ritz_status find_forces(const ritz_checker *it, int64_t first,
                               double fine, ritz_rigid_forces *out)
{
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_dense_columns(&it->R, first, 3, &R));
    RITZ_CHECK(ritz_rigid_forces_of(&it->component->K, &R, out));
    out->fine = fine;
    return RITZ_OK;
}

/* Largest stiffness of a rigid motion over the first flexible eigenvalue. */
static double worst_hold(const ritz_checker *it)
{
    double worst = 0.0;

    for (int64_t k = 0; k < it->Phi.ncol; k++)
        worst = fmax(worst, fabs(it->mu[k]));
    return isfinite(it->softest) ? worst / it->softest : 0.0;
}

/* Whether forces exceed rounding, but not the effect of the source's digits. */
static bool is_rounded(const ritz_checker *it, const ritz_rigid_forces *f)
{
    return it->digits < RITZ_MOST_DIGITS && f->largest > f->fine * f->bound &&
           f->largest <= ritz_digits_rounding(it->digits) * f->bound;
}

static void say_grounding(ritz_checker *it, const char *name,
                          const ritz_rigid_forces *f)
{
    double held = worst_hold(it);
    double limit = f->fine * f->bound;
    char dof[RITZ_DOF_NAME_SIZE] = "";

    if (f->row >= 0)
        ritz_dof_name(it->component->dof[f->row], dof);
    if (f->largest <= limit) {
        ritz_checker_say(it, name, f->largest, limit, RITZ_PASS, dof,
                         f->fine < RITZ_SINGLE_PRECISION
                             ? "free: no more than rounding"
                             : "free: no more than positions kept in single "
                               "precision leave");
    } else if (is_rounded(it, f)) {
        ritz_checker_say(it, name, f->largest, limit,
                         held <= RITZ_FREE_MOTION ? RITZ_WARN : RITZ_FAIL, dof,
                         "a free body is not free: rounding to %.0f digits "
                         "holds it, by %.1e of the first flexible eigenvalue",
                         it->digits, held);
    } else if (f->largest <= 16.0 * RITZ_SINGLE_PRECISION * f->bound) {
        ritz_checker_say(it, name, f->largest, limit, RITZ_WARN, dof,
                         "free but for a geometry in single precision");
    } else {
        ritz_checker_say(it, name, f->largest, limit, RITZ_WARN, dof,
                         "held: the largest force of a unit motion is %.3g, "
                         "here",
                         f->largest);
    }
}

/* Verdict on the source's digits, now that their effect is known. */
static void check_digits(ritz_checker *it)
{
    ritz_verdict verdict = RITZ_PASS;

    if (it->digits < RITZ_ENOUGH_DIGITS && it->rounded &&
        worst_hold(it) > RITZ_FREE_MOTION)
        verdict = RITZ_FAIL;
    else if (it->digits < RITZ_ENOUGH_DIGITS && it->declared)
        verdict = RITZ_WARN;
    ritz_checker_say(
        it, "source-digits", it->digits, RITZ_ENOUGH_DIGITS, verdict, NULL,
        verdict == RITZ_FAIL
            ? "%.0f digits are too few: the body is held by them"
        : verdict == RITZ_WARN
            ? "%.0f digits: no effect is found, but differences of "
              "stiffness are lost"
            : "%.0f digits, as far as can be told",
        it->digits);
}

ritz_status ritz_check_forces(ritz_checker *it)
{
    const ritz_grids *grids = &it->component->grids;
    bool turned = false; /* any displacement axes from basic ones */

    for (int64_t k = 0; k < grids->count; k++)
        turned = turned || grids->frame[k] != 0;
    RITZ_CHECK(find_forces(
        it, 0, turned ? RITZ_SINGLE_PRECISION : RITZ_ELEMENT_ROUNDING,
        &it->shift));
    if (it->R.ncol == 6)
        RITZ_CHECK(find_forces(it, 3, RITZ_SINGLE_PRECISION, &it->turn));
    it->rounded = is_rounded(it, &it->shift) || is_rounded(it, &it->turn);
    return RITZ_OK;
}

ritz_status ritz_check_grounding(ritz_checker *it)
{
    say_grounding(it, "grounding-translation", &it->shift);
    if (it->R.ncol == 6)
        say_grounding(it, "grounding-rotation", &it->turn);
    check_digits(it);
    return RITZ_OK;
}

/*
 * Rigid-body modes three ways. With lambda_f the first flexible eigenvalue:
 *
 *     geometry       mu of the motions that positions give; free is one with
 *                    |mu| <= 1e-4 lambda_f, cleanly so below 1e-8 lambda_f
 *     null space     eigenvalues below lambda_f / 100 by the inertia of
 *                    K - tau M, which does not use the eigensolver
 *     eigenvectors   rigid ones among the lowest pairs
 *
 * and the sine of the largest angle, in the inner product of M, by which the
 * free motions Phi leave the span of the rigid eigenvectors X:
 *
 *     E = Phi - X X'M Phi,    sin^2 = largest eigenvalue of E'ME.
 */

/* Trace of K over trace of M: a mean stiffness over a mean mass, far above the
   eigenvalues of rigid-body modes. */
static double typical_eigenvalue(const ritz_component *c)
{
    const ritz_sparse *const both[] = {&c->K, &c->M};
    double trace[2] = {0.0, 0.0};

    for (int k = 0; k < 2; k++)
        for (int64_t j = 0; j < c->num_dofs; j++)
            trace[k] += ritz_sparse_diagonal(both[k], j);
    return trace[1] > 0.0 ? fabs(trace[0]) / trace[1] : 1.0;
}

static void check_geometry(ritz_checker *it)
{
    double scale =
        isfinite(it->softest) ? it->softest : typical_eigenvalue(it->component);
    int64_t motions = it->Phi.ncol;
    double worst = 0.0;
    char text[RITZ_WHERE_SIZE];

    it->num_free = 0;
    for (int64_t k = 0; k < motions; k++)
        if (fabs(it->mu[k]) <= RITZ_NEARLY_FREE * scale) {
            it->num_free++;
            worst = fmax(worst, fabs(it->mu[k]) / scale);
        }
    if (it->num_free < motions)
        snprintf(text, sizeof text,
                 "%s%" PRId64 " of %" PRId64 " rigid motions are free%s",
                 it->rounded ? "only " : "", it->num_free, motions,
                 it->rounded ? ": rounding of the source holds the others"
                             : ", stiffness holds the others");
    else
        snprintf(text, sizeof text,
                 "all %" PRId64 " rigid motions are free: the most that one is "
                 "held is %.1e of the first flexible eigenvalue",
                 motions, worst);
    ritz_checker_say(
        it, "rigid-modes-geometry", (double)it->num_free, (double)motions,
        it->num_free < motions      ? it->rounded ? RITZ_FAIL : RITZ_PASS
        : worst <= RITZ_FREE_MOTION ? RITZ_PASS
                                    : RITZ_WARN,
        NULL, "%s", text);
}

/* How far the free motions leave the span of X. */
static ritz_status measure_angle(const ritz_checker *it, const ritz_dense *X,
                                 double *out)
{
    const ritz_sparse *M = &it->component->M;
    RITZ_OWN(ritz_dense)
    Phi = {0}, MPhi = {0}, C = {0}, E = {0}, ME = {0}, EME = {0};
    double trace = 0.0;

    RITZ_CHECK(ritz_dense_new(it->Phi.nrow, it->num_free, &Phi));
    for (int64_t k = 0, kept = 0; kept < it->num_free; k++)
        if (fabs(it->mu[k]) <= RITZ_NEARLY_FREE * it->softest) {
            for (int64_t i = 0; i < Phi.nrow; i++)
                ritz_dense_col(&Phi, kept)[i] = ritz_dense_col(&it->Phi, k)[i];
            kept++;
        }
    RITZ_CHECK(ritz_sparse_mul(M, &Phi, &MPhi));
    RITZ_CHECK(ritz_dense_mul_tn(X, &MPhi, &C));
    RITZ_CHECK(ritz_dense_mul(X, &C, &E));
    for (int64_t k = 0; k < E.nrow * E.ncol; k++)
        E.val[k] = Phi.val[k] - E.val[k];
    RITZ_CHECK(ritz_sparse_mul(M, &E, &ME));
    RITZ_CHECK(ritz_dense_mul_tn(&E, &ME, &EME));
    for (int64_t k = 0; k < EME.nrow; k++) /* bounds the largest eigenvalue */
        trace += ritz_dense_col(&EME, k)[k];
    *out = sqrt(fmax(trace, 0.0));
    return RITZ_OK;
}

static void say_agreement(ritz_checker *it, int64_t eigen, double sine)
{
    const double limit = RITZ_MOTIONS_AGREE;
    const double bearable = RITZ_MOTIONS_BEARABLE;
    const char *const name = "rigid-modes-agree";

    if (it->rounded && eigen < it->Phi.ncol)
        ritz_checker_say(it, name, nan(""), limit, RITZ_FAIL, NULL,
                         "%" PRId64 " rigid modes where positions give %" PRId64
                         " motions, which rounding holds",
                         eigen, it->Phi.ncol);
    else if (eigen < it->num_free)
        ritz_checker_say(it, name, sine, limit, RITZ_FAIL, NULL,
                         "geometry gives %" PRId64 " free motions, "
                         "eigenvectors only %" PRId64,
                         it->num_free, eigen);
    else if (sine > limit)
        ritz_checker_say(it, name, sine, limit,
                         sine > bearable ? RITZ_FAIL : RITZ_WARN, NULL,
                         "the eigenvectors leave the motions that positions "
                         "give: is a position or a frame wrong?");
    else if (eigen > it->num_free && it->placed)
        ritz_checker_say(it, name, sine, limit, RITZ_WARN, NULL,
                         "%" PRId64 " rigid modes but %" PRId64 " by geometry:"
                         " a mechanism, or several bodies",
                         eigen, it->num_free);
    else
        ritz_checker_say(it, name, sine, limit, RITZ_PASS, NULL,
                         it->num_free > 0
                             ? "geometry and eigenvectors span the same motions"
                             : "neither finds a free motion");
}

/* The third way is another factor: MUMPS instead of CHOLMOD and ARPACK. */
static ritz_status check_null_space(ritz_checker *it, int64_t eigen)
{
    static const char name[] = "rigid-modes-null-space";
    const ritz_component *c = it->component;
    double tau =
        (isfinite(it->softest) ? it->softest : typical_eigenvalue(c)) / 100.0;
    int64_t count = 0;
    ritz_status status = ritz_eigen_count(&c->K, &c->M, tau, &count);

    if (status == RITZ_OK)
        ritz_checker_say(it, name, (double)count, (double)eigen,
                         count == eigen ? RITZ_PASS : RITZ_FAIL, NULL, "%s",
                         count == eigen
                             ? "stiffness lets as many motions free as there "
                               "are rigid eigenvectors"
                         : it->rounded && count == it->Phi.ncol
                             ? "all rigid motions, to some of which rounding "
                               "of the stiffness gives a frequency"
                             : "not as many as rigid eigenvectors");
    if (status != RITZ_ERR_SINGULAR)
        return status;
    ritz_checker_say(it, name, nan(""), (double)eigen, RITZ_FAIL, NULL,
                     "cannot be counted: %s", ritz_error_message());
    return RITZ_OK;
}

/* Number of rigid motions that are not rigid modes, since rounding of the
   stiffness gives them a frequency. Without positions six rigid motions are
   assumed. */
static int64_t count_rounded(const ritz_checker *it, const ritz_pairs *pairs)
{
    const int64_t all = it->placed ? it->Phi.ncol : (int64_t)RITZ_BODY_MOTIONS;

    return it->rounded && pairs->num_rigid < all ? all - pairs->num_rigid : 0;
}

/*
 * First flexible eigenvalue. Where rounding of the stiffness holds the body,
 * the size of an eigenvalue does not show whether it is rigid: the lowest
 * eigenvalues count as rigid, one for each rigid motion.
 */
static double find_softest(const ritz_checker *it, const ritz_pairs *pairs)
{
    int64_t k = pairs->num_rigid + count_rounded(it, pairs);

    return k < pairs->Phi.ncol && pairs->lambda[k] > 0.0 ? pairs->lambda[k]
                                                         : nan("");
}

static void say_eigenvectors(ritz_checker *it, const ritz_pairs *pairs)
{
    int64_t count = pairs->num_rigid;
    int64_t rounded = count_rounded(it, pairs);
    char held[RITZ_NAME_SIZE * 2] = "";

    if (rounded > 0 && count + rounded <= pairs->Phi.ncol)
        snprintf(held, sizeof held,
                 "; by rounding of the stiffness %" PRId64 " rigid motion%s "
                 "%.4g to %.4g Hz",
                 rounded, rounded == 1 ? " has" : "s have",
                 ritz_eigen_hertz(pairs->lambda[count]),
                 ritz_eigen_hertz(pairs->lambda[count + rounded - 1]));
    ritz_checker_say(
        it, "rigid-modes-eigenvectors", (double)count, 6.0,
        count > 6 || (count == 0 && pairs->lambda[0] < 0.0) ? RITZ_WARN
                                                            : RITZ_PASS,
        NULL,
        isfinite(it->softest)
            ? "%" PRId64 " rigid modes, the first flexible one at %.6g Hz%s"
            : "%" PRId64 " rigid modes and no flexible one",
        count, ritz_eigen_hertz(it->softest), held);
}

/* No stiffness at all: everything with mass is free. */
static void audit_rigid_body(ritz_checker *it)
{
    int64_t n = it->component->num_dofs;

    it->num_free = it->Phi.ncol;
    ritz_checker_say(it, "rigid-modes-eigenvectors", (double)n, 6.0,
                     n > 6 ? RITZ_FAIL : RITZ_PASS, NULL,
                     n > 6 ? "%" PRId64 " dofs without any stiffness: is the "
                             "stiffness missing?"
                           : "a rigid body of %" PRId64 " dofs",
                     n);
}

ritz_status ritz_check_rigid(ritz_checker *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    const ritz_span span = {.modes = 7};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double sine = 0.0;

    if (it->rigid) {
        audit_rigid_body(it);
        return RITZ_OK;
    }
    status = ritz_eigen_sparse(&c->K, &c->M, &span, &pairs);
    if (status == RITZ_ERR_SINGULAR || status == RITZ_ERR_CONVERGENCE) {
        ritz_checker_say(it, "rigid-modes-eigenvectors", nan(""), 6.0,
                         RITZ_FAIL, NULL, "no modes: %s", ritz_error_message());
        check_geometry(it);
        return RITZ_OK;
    }
    RITZ_CHECK(status);
    it->softest = find_softest(it, &pairs);
    check_geometry(it);
    RITZ_CHECK(check_null_space(it, pairs.num_rigid));
    say_eigenvectors(it, &pairs);
    if (it->num_free > 0 && isfinite(it->softest)) {
        RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &X));
        RITZ_CHECK(measure_angle(it, &X, &sine));
    }
    say_agreement(it, pairs.num_rigid, sine);
    return RITZ_OK;
}
