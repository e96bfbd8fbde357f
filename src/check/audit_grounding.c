/*
 * Grounding: forces K r that a rigid motion r meets, and what their size says.
 *
 * A relative error u of the entries of K, or of r, leaves in row i at most
 * u sum_j |K_ij| |r_j|: with u = 1024 eps for elements computed in double
 * precision (a commercial code left 290 eps in a solid, measured), 2^-24 for
 * positions and frames kept in single precision or as eight letters of a card,
 * half a unit of the last digit for a source of few digits. Beyond that,
 * something holds the body.
 */
#include "check/audit_parts.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static ritz_status find_forces(const ritz_auditor *it, int64_t first,
                               double fine, ritz_forces *out)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *K = &it->component->K;
    ritz_dense R = {0}, F = {0};

    RITZ_TRY(ritz_dense_columns(&it->R, first, 3, &R));
    RITZ_TRY(ritz_sparse_mul(K, &R, &F));
    *out = (ritz_forces){.row = -1, .fine = fine};
    for (int64_t j = 0; j < 3; j++)
        for (int64_t i = 0; i < K->ncol; i++) {
            double force = fabs(ritz_dense_col(&F, j)[i]);
            double sum = 0.0;

            for (int64_t p = K->colptr[i]; p < K->colptr[i + 1]; p++)
                sum += fabs(K->val[p] * ritz_dense_col(&R, j)[K->rowind[p]]);
            out->bound = fmax(out->bound, sum);
            if (force > out->largest) {
                out->largest = force;
                out->row = i;
            }
        }
done:
    ritz_dense_free(&R);
    ritz_dense_free(&F);
    return status;
}

/* How much the rigid motions are held, of the first flexible eigenvalue. */
static double worst_hold(const ritz_auditor *it)
{
    double worst = 0.0;

    for (int64_t k = 0; k < it->Phi.ncol; k++)
        worst = fmax(worst, fabs(it->mu[k]));
    return isfinite(it->softest) ? worst / it->softest : 0.0;
}

/* Whether forces are more than rounding, and no more than few digits leave. */
static bool is_rounded(const ritz_auditor *it, const ritz_forces *f)
{
    return it->digits < 15.0 && f->largest > f->fine * f->bound &&
           f->largest <= 0.5 * pow(10.0, 1.0 - it->digits) * f->bound;
}

static void judge(ritz_auditor *it, const char *name, const ritz_forces *f)
{
    const double single = ldexp(1.0, -24);
    double held = worst_hold(it);
    double limit = f->fine * f->bound;
    char dof[RITZ_DOF_NAME_SIZE] = "";

    if (f->row >= 0)
        ritz_dof_name(it->component->dof[f->row], dof);
    if (f->largest <= limit) {
        ritz_auditor_say(it, name, f->largest, limit, RITZ_PASS, dof,
                         f->fine < single
                             ? "free: no more than rounding"
                             : "free: no more than positions kept in single "
                               "precision leave");
    } else if (is_rounded(it, f)) {
        ritz_auditor_say(it, name, f->largest, limit,
                         held <= 1e-8 ? RITZ_WARN : RITZ_FAIL, dof,
                         "a free body is not free: rounding to %.0f digits "
                         "holds it, by %.1e of the first flexible eigenvalue",
                         it->digits, held);
    } else if (f->largest <= 16.0 * single * f->bound) {
        ritz_auditor_say(it, name, f->largest, limit, RITZ_WARN, dof,
                         "free but for a geometry in single precision");
    } else {
        ritz_auditor_say(it, name, f->largest, limit, RITZ_WARN, dof,
                         "held: the largest force of a unit motion is %.3g, "
                         "here",
                         f->largest);
    }
}

/* What the source's digits mean, now that their effect is known. */
static void check_digits(ritz_auditor *it)
{
    const double enough = 12.0;
    ritz_verdict verdict = RITZ_PASS;

    if (it->digits < enough && it->rounded && worst_hold(it) > 1e-8)
        verdict = RITZ_FAIL;
    else if (it->digits < enough && it->declared)
        verdict = RITZ_WARN;
    ritz_auditor_say(it, "source-digits", it->digits, enough, verdict, NULL,
                     verdict == RITZ_FAIL
                         ? "%.0f digits are too few: the body is held by them"
                     : verdict == RITZ_WARN
                         ? "%.0f digits: no harm is seen, but differences of "
                           "stiffness are lost"
                         : "%.0f digits, as far as can be told",
                     it->digits);
}

static bool has_turned_axes(const ritz_grids *grids)
{
    for (int64_t k = 0; k < grids->count; k++)
        if (grids->frame[k] != 0)
            return true;
    return false;
}

ritz_status ritz_audit_forces(ritz_auditor *it)
{
    const double rounding = 1024.0 * DBL_EPSILON;
    const double single = ldexp(1.0, -24);
    bool turned = has_turned_axes(&it->component->grids);

    if (it->rigid)
        return RITZ_OK;
    RITZ_CHECK(find_forces(it, 0, turned ? single : rounding, &it->shift));
    if (it->R.ncol == 6)
        RITZ_CHECK(find_forces(it, 3, single, &it->turn));
    it->rounded = is_rounded(it, &it->shift) || is_rounded(it, &it->turn);
    return RITZ_OK;
}

ritz_status ritz_audit_grounding(ritz_auditor *it)
{
    if (it->rigid)
        return RITZ_OK;
    judge(it, "grounding-translation", &it->shift);
    if (it->R.ncol == 6)
        judge(it, "grounding-rotation", &it->turn);
    check_digits(it);
    return RITZ_OK;
}
