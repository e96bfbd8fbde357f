/*
 * Norms of the transfer function of a stable model, in the Schur form that
 * proves it stable:
 *
 *     |G|_inf = max_w sigma_1(C (i w P - S)^-1 B + D),
 *     |G|_2   = |C F_c|_F,   S W_c P' + P W_c S' + B B' = 0,   W_c = F_c F_c'
 *
 * AB13DD decides by eigenvalues of a Hamiltonian matrix whether a value is ever
 * reached. B and C go in with length one, so that it is not a question of
 * units. Its peak is compared with values that are met at every pole.
 * [Bruinsma1990], [Hammarling1982]
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/search.h"
#include "linear/split.h"
#include "poles/poles.h"

#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>

/*
 * Peaks lie near poles: they are where the search begins, and a golden section
 * between neighbours ends it.
 */

/* C (i w P - S)^-1 B + D. */
typedef struct peak {
    ritz_resolvent resolvent;
    ritz_dense D;       /* borrowed */
    double _Complex *H; /* p x m, to work in */
    double *sigma, *spare;
    double w, value; /* the largest that was met, and where */
} peak;

/* Peaks that are followed between points, at most. */
enum { MOST_PEAKS = 8 };

static void peak_free(peak *s)
{
    ritz_resolvent_free(&s->resolvent);
    RITZ_FREE(s->H, s->sigma, s->spare);
}

static ritz_status peak_at(void *state, double w, double *value)
{
    peak *s = state;
    int m = s->resolvent.m, p = s->resolvent.p;
    int info = 0;

    *value = 0.0;
    if (m == 0 || p == 0)
        return RITZ_OK;
    for (int64_t k = 0; k < (int64_t)p * m; k++)
        s->H[k] = s->D.val[k];
    if (isfinite(w))
        ritz_resolvent_add(&s->resolvent, ritz_complex(0.0, w), 0.0, s->H);
    info = LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', p, m, s->H, p, s->sigma,
                          NULL, 1, NULL, 1, s->spare);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "singular values of a response were not found");
    *value = s->sigma[0];
    if (*value > s->value) {
        s->value = *value;
        s->w = w;
    }
    return RITZ_OK;
}

/* 0 and, for every pole, the frequency at which its own response peaks, or
   its magnitude if it has no peak. */
static ritz_status choose_frequencies(const peak *s, int64_t *count,
                                      double **out)
{
    RITZ_OWN_ARRAY double *w = NULL;
    int64_t n = s->resolvent.n, kept = 0;

    RITZ_CHECK_NEW(w, n + 2);
    for (int64_t k = 0; k < n; k++) {
        double _Complex pole = ritz_resolvent_pole(&s->resolvent, k);
        double gap = cimag(pole) * cimag(pole) - creal(pole) * creal(pole);

        w[k + 1] = gap > 0.0 ? sqrt(gap) : cabs(pole);
    }
    kept = ritz_sort_distinct(n + 1, w, RITZ_PEAK_PLACED);
    w[kept] = 2.0 * w[kept - 1] + 1.0; /* the last bracket ends there */
    *count = kept;
    RITZ_MOVE(*out, w);
    return RITZ_OK;
}

/* The largest value so far is kept in the peak. */
static ritz_status climb_between(peak *s, double low, double high)
{
    const ritz_curve curve = {peak_at, s};
    double most = 0.0;

    return ritz_curve_between(&curve, RITZ_PEAK_PLACED, &low, &high, &most);
}

/* Index of the largest that was not yet taken, -1 if there is none. */
static int64_t next_highest_point(int64_t count, const double *value)
{
    int64_t best = -1;

    for (int64_t k = 0; k < count; k++)
        if (value[k] >= 0.0 && (best < 0 || value[k] > value[best]))
            best = k;
    return best;
}

/*
 * Between a point and a neighbour on either side; a narrow peak is in the half
 * width around the point, whatever is between it and the next.
 */
static ritz_status climb_around(peak *s, const double *w, int64_t k)
{
    double low = k > 0 ? w[k - 1] : w[k];
    double high = w[k + 1];

    RITZ_CHECK(climb_between(s, low, w[k]));
    RITZ_CHECK(climb_between(s, w[k], high));
    low = fmax(low, w[k] * 0.99);
    high = fmin(high, w[k] * 1.01);
    return climb_between(s, low, high);
}

static ritz_status peak_search(peak *s)
{
    RITZ_OWN_ARRAY double *w = NULL, *value = NULL;
    double at_infinity = 0.0;
    int64_t count = 0;

    RITZ_CHECK(choose_frequencies(s, &count, &w));
    RITZ_CHECK_NEW(value, count);
    for (int64_t k = 0; k < count; k++)
        RITZ_CHECK(peak_at(s, w[k], &value[k]));
    RITZ_CHECK(peak_at(s, HUGE_VAL, &at_infinity));
    for (int t = 0; t < MOST_PEAKS; t++) {
        int64_t k = next_highest_point(count, value);

        if (k < 0 || value[k] < RITZ_PEAK_WORTH * s->value)
            break;
        value[k] = -1.0;
        RITZ_CHECK(climb_around(s, w, k));
    }
    return RITZ_OK;
}

/* Beyond this many states no Hamiltonian is made. */
enum { MOST_STATES = 600 };

/* The Fortran name; character arguments bring their lengths at the end. */
void ab13dd_(/* NOLINT: its name */ const char *dico, const char *jobe,
             const char *equil, const char *jobd, const int *n, const int *m,
             const int *p, double *fpeak, double *A, const int *lda, double *E,
             const int *lde, double *B, const int *ldb, double *C,
             const int *ldc, double *D, const int *ldd, double *gpeak,
             const double *tol, int *iwork, double *work, const int *ldwork,
             double _Complex *cwork, const int *lcwork, int *info,
             size_t dico_length, size_t jobe_length, size_t equil_length,
             size_t jobd_length);

/* The stable part, its inputs and outputs of length one. */
typedef struct stable {
    ritz_split split;
    ritz_dense B, C, D;
    double size; /* of B times that of C: what was divided by */
} stable;

static void stable_free(stable *s)
{
    ritz_split_free(&s->split);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->D);
}

static void divide_by(double by, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol && by > 0.0; k++)
        A->val[k] /= by;
}

/* B and C of length one. */
static void divide_sides(stable *s)
{
    s->size = ritz_general_size(&s->B) * ritz_general_size(&s->C);
    divide_by(ritz_general_size(&s->B), &s->B);
    divide_by(ritz_general_size(&s->C), &s->C);
    if (s->size > 0.0)
        divide_by(s->size, &s->D);
    else
        s->size = 1.0;
}

static ritz_status take_stable(const ritz_state_space *model, stable *s)
{
    RITZ_OWN(ritz_state_space) made = {0};

    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_CHECK(ritz_state_space_dense(model, &made, &model));
    RITZ_CHECK(ritz_split_new(&model->A, &model->E, &s->split));
    RITZ_REFUSE_IF(s->split.T.ncol > 0, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " of %" PRId64
                   " poles are not left of the imaginary axis: a norm of the "
                   "response is infinite",
                   s->split.T.ncol, model->A.nrow);
    RITZ_CHECK(ritz_dense_mul_tn(&s->split.Y, &model->B, &s->B));
    RITZ_CHECK(ritz_dense_mul(&model->C, &s->split.X, &s->C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &s->D));
    divide_sides(s);
    return RITZ_OK;
}

/* The same of a model that is in Schur form and stable. */
static ritz_status copy_stable(const ritz_state_space *model, stable *s)
{
    RITZ_CHECK(ritz_dense_copy(&model->A, &s->split.S));
    if (model->E.val)
        RITZ_CHECK(ritz_dense_copy(&model->E, &s->split.P));
    RITZ_CHECK(ritz_dense_copy(&model->B, &s->B));
    RITZ_CHECK(ritz_dense_copy(&model->C, &s->C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &s->D));
    divide_sides(s);
    return RITZ_OK;
}

/* Peak and its frequency, from @p w on; false if it did not come to an end. */
static ritz_status bisect_peak(const stable *s, double tolerance, double *w,
                               double *value, bool *found)
{
    RITZ_OWN(ritz_dense) S = {0}, P = {0}, B = {0}, C = {0}, D = {0};
    RITZ_OWN_ARRAY int *iwork = NULL;
    RITZ_OWN_ARRAY double *work = NULL;
    RITZ_OWN_ARRAY double _Complex *cwork = NULL;
    bool pencil = s->split.P.val;
    int n = (int)s->B.nrow, m = (int)s->B.ncol, p = (int)s->C.nrow;
    int lde = pencil ? n : 1;
    int room = 15 * n * n + p * p + m * m + (6 * n + 3) * (p + m) + 4 * p * m +
               n * m + 22 * n + 7 * (p < m ? p : m) + 64 * n;
    int croom = (n + m) * (n + p) + 2 * (p < m ? p : m) + p + m + 64 * n;
    double frequency[2] = {isfinite(*w) ? *w : 1.0, isfinite(*w)};
    double gain[2] = {0.0, 1.0};
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(&s->split.S, &S));
    RITZ_CHECK(pencil ? ritz_dense_copy(&s->split.P, &P)
                      : ritz_dense_new(1, 1, &P));
    RITZ_CHECK(ritz_dense_copy(&s->B, &B));
    RITZ_CHECK(ritz_dense_copy(&s->C, &C));
    RITZ_CHECK(ritz_dense_copy(&s->D, &D));
    RITZ_CHECK_NEW(iwork, n);
    RITZ_CHECK_NEW(work, room);
    RITZ_CHECK_NEW(cwork, croom);
    ab13dd_("C", pencil ? "G" : "I", "N", "D", &n, &m, &p, frequency, S.val, &n,
            P.val, &lde, B.val, &n, C.val, &p, D.val, &p, gain, &tolerance,
            iwork, work, &room, cwork, &croom, &info, 1, 1, 1, 1);
    *found = info == 0 && gain[1] > 0.0;
    *w = frequency[1] > 0.0 ? frequency[0] : HUGE_VAL;
    *value = gain[0];
    return RITZ_OK;
}

/*
 * A change dA of the matrix moves the response by C R dA R B, R = (i w P -
 * S)^-1: rounding by eps (|S| + w |P|) |C R| |R B|.
 */
static ritz_status find_rounding(peak *p, const stable *s, ritz_norm *out)
{
    double w = 2.0 * RITZ_PI * out->hertz,
           size = ritz_general_size(&s->split.S);
    double right = 0.0, left = 0.0;

    if (!isfinite(w) || p->resolvent.n == 0)
        return RITZ_OK;
    if (s->split.P.val)
        size += w * ritz_general_size(&s->split.P);
    RITZ_CHECK(ritz_resolvent_sides(&p->resolvent, ritz_complex(0.0, w), &right,
                                    &left));
    out->rounding = DBL_EPSILON * s->size * size * right * left;
    return RITZ_OK;
}

static ritz_status find_peak(const stable *s, double tolerance, ritz_norm *out)
{
    RITZ_OWN(peak) p = {.D = s->D};
    int64_t least = s->B.ncol < s->C.nrow ? s->B.ncol : s->C.nrow;
    double direct = 0.0, w = 0.0, value = 0.0;
    bool found = false;

    RITZ_CHECK(ritz_resolvent_new(&s->split.S, &s->split.P, &s->B, &s->C,
                                  &p.resolvent));
    RITZ_CHECK_NEW(p.H, s->B.ncol * s->C.nrow);
    RITZ_CHECK_NEW(p.sigma, least);
    RITZ_CHECK_NEW(p.spare, least);
    RITZ_CHECK(peak_search(&p));
    w = p.w;
    if (p.resolvent.n > 0 && p.resolvent.n <= MOST_STATES && p.value > 0.0)
        RITZ_CHECK(bisect_peak(s, tolerance, &w, &value, &found));
    if (found && isfinite(w))
        RITZ_CHECK(peak_at(&p, w, &direct));
    snprintf(out->engine, sizeof out->engine,
             found ? "SLICOT AB13DD" : "search at poles, a lower bound");
    out->lower = s->size * p.value;
    out->value = out->lower;
    out->hertz = p.w / (2.0 * RITZ_PI);
    if (found && s->size * value > out->value) {
        out->value = s->size * value;
        out->hertz = w / (2.0 * RITZ_PI);
    }
    return find_rounding(&p, s, out);
}

static ritz_status check_tolerance(double tolerance)
{
    RITZ_REFUSE_IF(!(tolerance > 0.0 && tolerance < 1.0), RITZ_ERR_ARGUMENT,
                   "the tolerance of a norm is %g, it must be between 0 and 1",
                   tolerance);
    return RITZ_OK;
}

static ritz_status norm_infinity(const stable *s, double tolerance,
                                 ritz_norm *out)
{
    ritz_norm norm = {0};

    RITZ_CHECK_IN("H-infinity norm", find_peak(s, tolerance, &norm));
    *out = norm;
    return RITZ_OK;
}

ritz_status ritz_norm_infinity(const ritz_state_space *model, double tolerance,
                               ritz_norm *out)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK(check_tolerance(tolerance));
    RITZ_CHECK_IN("H-infinity norm", take_stable(model, &s));
    return norm_infinity(&s, tolerance, out);
}

ritz_status ritz_norm_infinity_schur(const ritz_state_space *model,
                                     double tolerance, ritz_norm *out)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK(check_tolerance(tolerance));
    RITZ_CHECK_IN("H-infinity norm", copy_stable(model, &s));
    return norm_infinity(&s, tolerance, out);
}

static ritz_status norm_two(const stable *s, ritz_norm *out)
{
    RITZ_OWN(ritz_dense) F = {0}, CF = {0};

    RITZ_REFUSE_IF(
        ritz_dense_max(&s->D) > 0.0, RITZ_ERR_ARGUMENT,
        "H2 norm: it is infinite, an input reaches an output at once "
        "(D is not 0)");
    RITZ_CHECK_IN("H2 norm", ritz_general_hammarling(&s->split.S, &s->split.P,
                                                     false, &s->B, &F));
    RITZ_CHECK(ritz_dense_mul(&s->C, &F, &CF));
    *out = (ritz_norm){.value = s->size * ritz_general_size(&CF)};
    out->lower = out->value;
    snprintf(out->engine, sizeof out->engine, "SLICOT %s",
             s->split.P.val ? "SG03BD" : "SB03OD");
    return RITZ_OK;
}

ritz_status ritz_norm_two(const ritz_state_space *model, ritz_norm *out)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK_IN("H2 norm", take_stable(model, &s));
    return norm_two(&s, out);
}

ritz_status ritz_norm_two_schur(const ritz_state_space *model, ritz_norm *out)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK_IN("H2 norm", copy_stable(model, &s));
    return norm_two(&s, out);
}
