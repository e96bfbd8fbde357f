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
#include "linear/resolvent.h"
#include "linear/split.h"
#include "poles/peak.h"
#include "poles/poles.h"

#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>

/* C (i w P - S)^-1 B + D. */
typedef struct axis_response {
    ritz_resolvent resolvent;
    ritz_dense D; /* borrowed */
} axis_response;

static void axis_response_free(axis_response *r)
{
    ritz_resolvent_free(&r->resolvent);
}

/* Response at points on the imaginary axis; infinite ones come last. */
static ritz_status respond_at(void *state, int64_t count, const double *w,
                              double _Complex *H)
{
    const axis_response *r = state;
    const int64_t size = r->D.nrow * r->D.ncol;
    int64_t finite = 0;
    RITZ_OWN_ARRAY double _Complex *z = NULL;

    RITZ_CHECK_NEW(z, count);
    for (int64_t k = 0; k < count * size; k++)
        H[k] = r->D.val[k % size];
    while (finite < count && isfinite(w[finite])) {
        z[finite] = ritz_complex(0.0, w[finite]);
        finite++;
    }
    return ritz_resolvent_many(&r->resolvent, finite, z, H);
}

/* Search the peak, starting at 0 and where the response of each pole by itself
   peaks. */
static ritz_status search_peak(axis_response *r, ritz_peak *out)
{
    int64_t n = r->resolvent.n;
    RITZ_OWN_ARRAY double *w = NULL;

    *out = (ritz_peak){.outputs = r->D.nrow,
                       .inputs = r->D.ncol,
                       .respond = respond_at,
                       .state = r};
    RITZ_CHECK_NEW(w, n + 1);
    for (int64_t k = 0; k < n; k++)
        w[k + 1] = ritz_peak_of_pole(ritz_resolvent_pole(&r->resolvent, k));
    return ritz_peak_find(out, ritz_sort_distinct(n + 1, w, RITZ_PEAK_PLACED),
                          w);
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

/* Scale B and C to unit norm, and D by both factors. */
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

/* Copy a stable model that is in Schur form already. */
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
 * A change dA changes the response by C R dA R B with R = (i w P - S)^-1;
 * rounding therefore changes it by eps (|S| + w |P|) |C R| |R B|.
 */
static ritz_status find_rounding(axis_response *r, const stable *s,
                                 ritz_norm *out)
{
    double w = 2.0 * RITZ_PI * out->hertz,
           size = ritz_general_size(&s->split.S);
    double right = 0.0, left = 0.0;

    if (!isfinite(w) || r->resolvent.n == 0)
        return RITZ_OK;
    if (s->split.P.val)
        size += w * ritz_general_size(&s->split.P);
    RITZ_CHECK(ritz_resolvent_sides(&r->resolvent, ritz_complex(0.0, w), &right,
                                    &left));
    out->rounding = DBL_EPSILON * s->size * size * right * left;
    return RITZ_OK;
}

static ritz_status find_peak(const stable *s, double tolerance, ritz_norm *out)
{
    RITZ_OWN(axis_response) r = {.D = s->D};
    ritz_peak p = {0};
    double direct = 0.0, w = 0.0, value = 0.0;
    bool found = false;

    RITZ_CHECK(ritz_resolvent_new(&s->split.S, &s->split.P, &s->B, &s->C,
                                  &r.resolvent));
    RITZ_CHECK(search_peak(&r, &p));
    w = p.w;
    if (r.resolvent.n > 0 && r.resolvent.n <= MOST_STATES && p.value > 0.0)
        RITZ_CHECK(bisect_peak(s, tolerance, &w, &value, &found));
    if (found && isfinite(w))
        RITZ_CHECK(ritz_peak_at(&p, 1, &w, &direct));
    snprintf(out->engine, sizeof out->engine,
             found ? "SLICOT AB13DD" : "search at poles, a lower bound");
    out->lower = s->size * p.value;
    out->value = out->lower;
    out->hertz = p.w / (2.0 * RITZ_PI);
    if (found && s->size * value > out->value) {
        out->value = s->size * value;
        out->hertz = w / (2.0 * RITZ_PI);
    }
    return find_rounding(&r, s, out);
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

static void tell_two(const stable *s, const ritz_dense *CF, ritz_norm *out)
{
    *out = (ritz_norm){.value = s->size * ritz_general_size(CF)};
    out->lower = out->value;
    snprintf(out->engine, sizeof out->engine, "SLICOT %s",
             s->split.P.val ? "SG03BD" : "SB03OD");
}

/*
 * Factor F is upper triangular. If A is block diagonal, the last diagonal block
 * of F is therefore the factor of the last block by itself.
 */
static ritz_status norm_two(const stable *s, int64_t last, ritz_norm *out,
                            ritz_norm *part)
{
    const int64_t n = s->B.nrow, p = s->C.nrow;
    RITZ_OWN(ritz_dense) F = {0}, CF = {0}, C2 = {0}, F2 = {0}, CF2 = {0};

    RITZ_REFUSE_IF(
        ritz_dense_max(&s->D) > 0.0, RITZ_ERR_ARGUMENT,
        "H2 norm: it is infinite, an input reaches an output at once "
        "(D is not 0)");
    RITZ_CHECK_IN("H2 norm", ritz_general_hammarling(&s->split.S, &s->split.P,
                                                     false, &s->B, &F));
    RITZ_CHECK(ritz_dense_mul(&s->C, &F, &CF));
    tell_two(s, &CF, out);
    if (!part)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_block(&s->C, 0, p, n - last, last, &C2));
    RITZ_CHECK(ritz_dense_block(&F, n - last, last, n - last, last, &F2));
    RITZ_CHECK(ritz_dense_mul(&C2, &F2, &CF2));
    tell_two(s, &CF2, part);
    return RITZ_OK;
}

ritz_status ritz_norm_two(const ritz_state_space *model, ritz_norm *out)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK_IN("H2 norm", take_stable(model, &s));
    return norm_two(&s, 0, out, NULL);
}

ritz_status ritz_norm_two_schur(const ritz_state_space *model, int64_t last,
                                ritz_norm *out, ritz_norm *part)
{
    RITZ_OWN(stable) s = {0};

    RITZ_CHECK_IN("H2 norm", copy_stable(model, &s));
    return norm_two(&s, last, out, part);
}
