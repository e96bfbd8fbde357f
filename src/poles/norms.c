/*
 * Norms of what stable poles answer, in the Schur form that tells them apart:
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
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/split.h"
#include "poles/peak.h"

#include <ritz/norms.h>

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

static void discard(stable *s)
{
    ritz_split_free(&s->split);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->D);
}

static double length(const ritz_dense *A)
{
    if (A->nrow == 0 || A->ncol == 0)
        return 0.0;
    return LAPACKE_dlange(LAPACK_COL_MAJOR, 'F', (int)A->nrow, (int)A->ncol,
                          A->val, (int)A->nrow);
}

static void divide(double by, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol && by > 0.0; k++)
        A->val[k] /= by;
}

static ritz_status take_stable(const ritz_state_space *model, stable *s)
{
    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_CHECK(ritz_split_new(&model->A, &model->E, &s->split));
    RITZ_REFUSE_IF(s->split.T.ncol > 0, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " of %" PRId64
                   " poles are not left of the imaginary axis: a norm of the "
                   "response is infinite",
                   s->split.T.ncol, model->A.nrow);
    RITZ_CHECK(ritz_dense_mul_tn(&s->split.Y, &model->B, &s->B));
    RITZ_CHECK(ritz_dense_mul(&model->C, &s->split.X, &s->C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &s->D));
    s->size = length(&s->B) * length(&s->C);
    divide(length(&s->B), &s->B);
    divide(length(&s->C), &s->C);
    if (s->size > 0.0)
        divide(s->size, &s->D);
    else
        s->size = 1.0;
    return RITZ_OK;
}

/* What AB13DD is given, and its work space. */
typedef struct hamiltonian {
    ritz_dense S, P, B, C, D;
    int *iwork;
    double *work;
    double _Complex *cwork;
} hamiltonian;

static void free_hamiltonian(hamiltonian *h)
{
    ritz_dense_free(&h->S);
    ritz_dense_free(&h->P);
    ritz_dense_free(&h->B);
    ritz_dense_free(&h->C);
    ritz_dense_free(&h->D);
    free(h->iwork);
    free(h->work);
    free(h->cwork);
}

static ritz_status copy(const stable *s, hamiltonian *h)
{
    RITZ_CHECK(ritz_dense_copy(&s->split.S, &h->S));
    if (s->split.P.val)
        RITZ_CHECK(ritz_dense_copy(&s->split.P, &h->P));
    else
        RITZ_CHECK(ritz_dense_new(1, 1, &h->P));
    RITZ_CHECK(ritz_dense_copy(&s->B, &h->B));
    RITZ_CHECK(ritz_dense_copy(&s->C, &h->C));
    return ritz_dense_copy(&s->D, &h->D);
}

/* Peak and its frequency, from @p w on; false if it did not come to an end. */
static ritz_status bisect(const stable *s, double tolerance, double *w,
                          double *value, bool *found)
{
    ritz_status status = RITZ_OK;
    hamiltonian h = {0};
    int n = (int)s->B.nrow, m = (int)s->B.ncol, p = (int)s->C.nrow;
    int lde = s->split.P.val ? n : 1;
    int room = 15 * n * n + p * p + m * m + (6 * n + 3) * (p + m) + 4 * p * m +
               n * m + 22 * n + 7 * (p < m ? p : m) + 64 * n;
    int croom = (n + m) * (n + p) + 2 * (p < m ? p : m) + p + m + 64 * n;
    double frequency[2] = {isfinite(*w) ? *w : 1.0, isfinite(*w)};
    double gain[2] = {0.0, 1.0};
    int info = 0;

    RITZ_TRY(copy(s, &h));
    RITZ_NEW(h.iwork, n);
    RITZ_NEW(h.work, room);
    RITZ_NEW(h.cwork, croom);
    ab13dd_("C", s->split.P.val ? "G" : "I", "N", "D", &n, &m, &p, frequency,
            h.S.val, &n, h.P.val, &lde, h.B.val, &n, h.C.val, &p, h.D.val, &p,
            gain, &tolerance, h.iwork, h.work, &room, h.cwork, &croom, &info, 1,
            1, 1, 1);
    *found = info == 0 && gain[1] > 0.0;
    *w = frequency[1] > 0.0 ? frequency[0] : HUGE_VAL;
    *value = gain[0];
done:
    free_hamiltonian(&h);
    return status;
}

static ritz_status find(const stable *s, double tolerance, ritz_norm *out)
{
    ritz_status status = RITZ_OK;
    ritz_peak peak = {0};
    double direct = 0.0, w = 0.0, value = 0.0;
    bool found = false;

    RITZ_TRY(ritz_peak_new(&s->split, &s->B, &s->C, &s->D, &peak));
    RITZ_TRY(ritz_peak_search(&peak));
    w = peak.w;
    if (peak.n > 0 && peak.n <= MOST_STATES && peak.value > 0.0)
        RITZ_TRY(bisect(s, tolerance, &w, &value, &found));
    if (found && isfinite(w))
        RITZ_TRY(ritz_peak_at(&peak, w, &direct));
    snprintf(out->engine, sizeof out->engine,
             found ? "SLICOT AB13DD" : "search at poles, a lower bound");
    out->lower = s->size * peak.value;
    out->value = out->lower;
    out->hertz = peak.w / (2.0 * RITZ_PI);
    if (found && s->size * value > out->value) {
        out->value = s->size * value;
        out->hertz = w / (2.0 * RITZ_PI);
    }
done:
    ritz_peak_free(&peak);
    return status;
}

ritz_status ritz_norm_infinity(const ritz_state_space *model, double tolerance,
                               ritz_norm *out)
{
    ritz_status status = RITZ_OK;
    stable s = {0};
    ritz_norm norm = {0};

    RITZ_FAIL_IF(!(tolerance > 0.0 && tolerance < 1.0), RITZ_ERR_ARGUMENT,
                 "the tolerance of a norm is %g, it must be between 0 and 1",
                 tolerance);
    RITZ_TRY_IN("H-infinity norm", take_stable(model, &s));
    RITZ_TRY_IN("H-infinity norm", find(&s, tolerance, &norm));
    *out = norm;
done:
    discard(&s);
    return status;
}

ritz_status ritz_norm_two(const ritz_state_space *model, ritz_norm *out)
{
    ritz_status status = RITZ_OK;
    stable s = {0};
    ritz_dense F = {0}, CF = {0};

    RITZ_TRY_IN("H2 norm", take_stable(model, &s));
    RITZ_FAIL_IF(ritz_dense_max(&model->D) > 0.0, RITZ_ERR_ARGUMENT,
                 "H2 norm: it is infinite, an input reaches an output at once "
                 "(D is not 0)");
    RITZ_TRY_IN("H2 norm", ritz_general_hammarling(&s.split.S, &s.split.P,
                                                   false, &s.B, &F));
    RITZ_TRY(ritz_dense_mul(&s.C, &F, &CF));
    *out = (ritz_norm){.value = s.size * length(&CF)};
    out->lower = out->value;
    snprintf(out->engine, sizeof out->engine, "SLICOT %s",
             s.split.P.val ? "SG03BD" : "SB03OD");
done:
    discard(&s);
    ritz_dense_free(&F);
    ritz_dense_free(&CF);
    return status;
}
