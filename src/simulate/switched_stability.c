/*
 * One Lyapunov function for all models that a library can give
 * [McDaniel2000, 5.2.24], V = (x'Kx + x''M x') / 2.
 *
 * Offset. With P the projector of a set, M P = P'M, and Z' = diag(P, P) A Z:
 *
 *     V' = x'K P v - v'P'(K x + D v) = -v'P'D v
 *
 * for any K. V' is never positive if and only if P'D = D P: otherwise a v with
 * P v = small -D_pq q and (1 - P) v = q has v'P'D v < 0. This holds for every
 * set of vectors if and only if D psi = d M psi for each vector, d >= 0.
 *
 * Projection. Within an interval V' = -v'D v, as the state is in the span of
 * the set. At a switch x'P'K P x <= x'K x for all x if and only if P'K = K P,
 * and for every set if and only if K psi = k M psi for each vector.
 *
 * Where K does not meet this condition, and D is definite on the library (delta
 * is the least eigenvalue of its pencil with M), projection is stable if each
 * set is kept long enough. With
 *
 *     V_e = (v'M v + x'K x + e x'D x) / 2 + e x'M v,   0 < e < delta,
 *     V_e' = -v'(D - e M) v - e x'K x <= -2 a V_e
 *
 * holds in every subspace. A projection multiplies V_e by at most g, the
 * condition number of V_e in a norm in which projectors do not increase
 * lengths: within log(g) / 2a a set dissipates what the switch added. Several e
 * are tried.
 */
#include "simulate/switched.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <inttypes.h>
#include <math.h>

/* |A_S psi - a psi| and |A_S psi| of a candidate in W, and its Rayleigh
   quotient a. S has -M^-1 A Phi, S_x has Phi. */
static void defect_of(const ritz_library *library, const ritz_dense *S,
                      int64_t k, double *work, double found[3])
{
    const int64_t rows = S->nrow;
    const double *psi = ritz_dense_col(&library->vector, k);
    double *x = work, *y = work + rows;
    double square = 0.0, off = 0.0, all = 0.0, a = 0.0;

    for (int64_t i = 0; i < 2 * rows; i++)
        work[i] = 0.0;
    for (int64_t j = 0; j < library->span; j++) {
        const double c = psi[j] / library->scale[j];

        for (int64_t i = 0; i < rows; i++) {
            x[i] += c * ritz_dense_col(&library->S_x, j)[i];
            y[i] -= c * ritz_dense_col(S, j)[i];
        }
    }
    square = ritz_motion_dot(rows, x, x);
    a = ritz_motion_dot(rows, x, y) / square;
    for (int64_t i = 0; i < rows; i++) {
        off += (y[i] - a * x[i]) * (y[i] - a * x[i]);
        all += y[i] * y[i];
    }
    found[0] = sqrt(off / square);
    found[1] = sqrt(all / square);
    found[2] = a;
}

/* The largest defect over all candidates and its vector, and the least
   quotient; defect and quotient are relative to the largest |M^-1 A psi|. */
static ritz_status find_defect(const ritz_library *library, const ritz_dense *S,
                               double *defect, int64_t *which, double *least)
{
    RITZ_OWN_ARRAY double *work = NULL;
    double largest = 0.0;

    *defect = *least = 0.0;
    *which = 0;
    RITZ_CHECK_NEW(work, 2 * S->nrow);
    for (int64_t k = 0; k < library->num_vectors; k++) {
        double found[3] = {0.0};

        defect_of(library, S, k, work, found);
        if (found[0] > *defect) {
            *defect = found[0];
            *which = k;
        }
        largest = fmax(largest, found[1]);
        *least = fmin(*least, found[2]);
    }
    if (largest > 0.0) {
        *defect /= largest;
        *least /= largest;
    }
    return RITZ_OK;
}

/* The part of a matrix in the span of the library, symmetrised. */
static ritz_status take_span(const ritz_library *library, const ritz_dense *A,
                             ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_block(A, 0, library->span, 0, library->span, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

/* Least and largest eigenvalue. */
static ritz_status find_ends(const ritz_dense *A, double ends[2])
{
    RITZ_OWN_ARRAY double *lambda = NULL;

    RITZ_CHECK_NEW(lambda, A->nrow);
    RITZ_CHECK(ritz_general_symmetric_values(A, lambda));
    ends[0] = lambda[0];
    ends[1] = lambda[A->nrow - 1];
    return RITZ_OK;
}

/* [a A, b I; b I, C] with displacements scaled by s; C = c I - d D. */
static ritz_status fill_form(const ritz_dense *A, double s, double b,
                             const ritz_dense *C, ritz_dense *out)
{
    const int64_t n = A->nrow;

    RITZ_CHECK(ritz_dense_new(2 * n, 2 * n, out));
    for (int64_t j = 0; j < n; j++) {
        for (int64_t i = 0; i < n; i++) {
            ritz_dense_col(out, j)[i] = s * s * ritz_dense_col(A, j)[i];
            ritz_dense_col(out, n + j)[n + i] = ritz_dense_col(C, j)[i];
        }
        ritz_dense_col(out, j)[n + j] = s * b;
        ritz_dense_col(out, n + j)[j] = s * b;
    }
    return RITZ_OK;
}

/* The dwell time that one e requires; HUGE_VAL if V_e is no norm. */
static ritz_status dwell_of(const ritz_dense *K, const ritz_dense *D, double e,
                            double s, double *out)
{
    RITZ_OWN(ritz_dense) stored = {0}, lost = {0}, I = {0}, KD = {0}, DI = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double ends[2] = {0.0};

    *out = HUGE_VAL;
    RITZ_CHECK(ritz_dense_identity(K->nrow, &I));
    RITZ_CHECK(ritz_dense_copy(K, &KD));
    ritz_dense_add(e, D, &KD);
    RITZ_CHECK(fill_form(&KD, s, e, &I, &stored));
    RITZ_CHECK(find_ends(&stored, ends));
    if (!(ends[0] > RITZ_NEGLIGIBLE * ends[1]))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(D, &DI));
    ritz_dense_add(-e, &I, &DI);
    ritz_dense_free(&KD);
    RITZ_CHECK(ritz_dense_copy(K, &KD));
    for (int64_t k = 0; k < KD.nrow * KD.ncol; k++)
        KD.val[k] *= e;
    RITZ_CHECK(fill_form(&KD, s, 0.0, &DI, &lost));
    RITZ_CHECK(ritz_eigen_unchecked(&lost, &stored, &pairs));
    if (pairs.lambda[0] > 0.0) /* V_e' <= -2 lambda V_e */
        *out = log(ends[1] / ends[0]) / (2.0 * pairs.lambda[0]);
    return RITZ_OK;
}

/* The shortest dwell time over e = delta / 2^k. */
static ritz_status find_dwell(const ritz_library *library, double *out)
{
    enum { SCANNED = 6 };
    RITZ_OWN(ritz_dense) K = {0}, D = {0};
    double stiff[2] = {0.0}, damped[2] = {0.0};

    *out = HUGE_VAL;
    RITZ_CHECK(take_span(library, &library->K, &K));
    RITZ_CHECK(
        ritz_dense_block(&library->D, 0, library->span, 0, library->span, &D));
    if (ritz_dense_skew(&D) > RITZ_SYMMETRIC) /* x'D x' would not cancel */
        return RITZ_OK;
    ritz_dense_symmetrise(&D);
    RITZ_CHECK(find_ends(&K, stiff));
    RITZ_CHECK(find_ends(&D, damped));
    if (!(stiff[0] > RITZ_NEGLIGIBLE * stiff[1]) ||
        !(damped[0] > RITZ_NEGLIGIBLE * damped[1]))
        return RITZ_OK;
    for (int k = 1; k <= SCANNED; k++) {
        double dwell = 0.0;

        RITZ_CHECK(dwell_of(&K, &D, ldexp(damped[0], -k), 1.0 / sqrt(stiff[0]),
                            &dwell));
        *out = fmin(*out, dwell);
    }
    return RITZ_OK;
}

/* The energy must not be negative, and D must not increase it. */
static ritz_status check_definite(const ritz_library *library)
{
    const ritz_dense *const matrix[] = {&library->K, &library->D};
    static const char *const name[] = {"K", "D"};

    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_dense) A = {0};
        double ends[2] = {0.0};

        RITZ_CHECK(take_span(library, matrix[k], &A));
        RITZ_CHECK(find_ends(&A, ends));
        /* of a gyroscopic D the symmetric part is rounding of the whole */
        RITZ_REFUSE_IF(ends[0] <
                           -RITZ_COMMUTES * fabs(ends[1]) -
                               RITZ_SUM_ROUNDING * ritz_dense_max(matrix[k]),
                       RITZ_ERR_ARGUMENT,
                       "%s has the negative value %.3g on the library: the "
                       "energy does not bound the motion",
                       name[k], ends[0]);
    }
    return RITZ_OK;
}

static ritz_status check_projection(const ritz_library *library,
                                    const ritz_switched *switched,
                                    int64_t which, ritz_switched_report *report)
{
    RITZ_CHECK(find_dwell(library, &report->dwell));
    RITZ_REFUSE_IF(report->dwell == HUGE_VAL, RITZ_ERR_ARGUMENT,
                   "vector %" PRId64 " is no mode (off by %.1e), so that "
                   "projection at a switch may raise the energy, and damping "
                   "takes it from no motion for sure: use modes, or offset",
                   which + 1, report->defect);
    RITZ_REFUSE_IF(switched->dwell < report->dwell, RITZ_ERR_ARGUMENT,
                   "vector %" PRId64 " is no mode (off by %.1e), so that "
                   "projection at a switch may raise the energy: sets that "
                   "dwell %.4g s are stable, not %.4g s; give that dwell, use "
                   "modes, or offset",
                   which + 1, report->defect, report->dwell,
                   fmax(switched->dwell, switched->interval));
    return RITZ_OK;
}

ritz_status ritz_library_stable(const ritz_library *library,
                                const ritz_switched *switched,
                                ritz_switched_report *report)
{
    const bool offset = switched->jump == RITZ_SWITCH_OFFSET;
    int64_t which = 0;
    double least = 0.0;

    RITZ_CHECK(check_definite(library));
    RITZ_CHECK(find_defect(library, offset ? &library->S_d : &library->S_k,
                           &report->defect, &which, &least));
    if (report->defect <= RITZ_COMMUTES)
        return RITZ_OK;
    if (!offset)
        return check_projection(library, switched, which, report);
    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "D couples vector %" PRId64 " to others (off by %.1e), so that the "
        "energy may rise while a part of the velocity stands still: use modes "
        "that D leaves decoupled, or projection",
        which + 1, report->defect);
}
