/*
 * bench_hankel [STATES...] - CPU seconds of the closed forms of modal models
 * and of SLICOT's routines for the same, two inputs and three outputs, on one
 * thread (OMP_NUM_THREADS=1); and how far apart their Hankel values are. 200,
 * 1000 and 2000 states unless other numbers are given, which takes a quarter
 * of an hour.
 *
 * SLICOT gets A block by block, 2 x 2 each, which its QR iterations are quick
 * with. What takes less than a second is the median of five.
 */
#include "../unit/try.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <ritz/model.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Fortran names; character arguments bring their lengths at the end. */
void ab13ad_(/* NOLINT: its name */ const char *dico, const char *equil,
             const int *n, const int *m, const int *p, const double *alpha,
             double *A, const int *lda, double *B, const int *ldb, double *C,
             const int *ldc, int *ns, double *hsv, double *work,
             const int *ldwork, int *info, size_t dico_length,
             size_t equil_length);
void ab09ad_(/* NOLINT: its name */ const char *dico, const char *job,
             const char *equil, const char *select, const int *n, const int *m,
             const int *p, int *nr, double *A, const int *lda, double *B,
             const int *ldb, double *C, const int *ldc, double *hsv,
             const double *tol, int *iwork, double *work, const int *ldwork,
             int *warn, int *info, size_t dico_length, size_t job_length,
             size_t equil_length, size_t select_length);

enum { INPUTS = 2, OUTPUTS = 3, REPEATS = 5 };

/* A modal model and the same as matrices. */
typedef struct subject {
    ritz_modal modal;
    ritz_dense A, B, C, At, Ct;
    double *sigma; /* what was found last, 2m */
} subject;

static void discard(subject *s)
{
    ritz_modal_free(&s->modal);
    ritz_dense_free(&s->A);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->At);
    ritz_dense_free(&s->Ct);
    free(s->sigma);
}

/* A fixed sequence of numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

static ritz_status set_modal(int64_t m, double zeta, ritz_modal *out)
{
    ritz_status status = RITZ_OK;
    uint64_t seed = 7;
    double w = 1.0;

    out->count = m;
    RITZ_NEW(out->omega, m);
    RITZ_NEW(out->zeta, m);
    RITZ_TRY(ritz_dense_new(m, INPUTS, &out->B));
    RITZ_TRY(ritz_dense_new(OUTPUTS, m, &out->C));
    RITZ_TRY(ritz_dense_new(OUTPUTS, m, &out->Cv));
    for (int64_t k = 0; k < m; k++) {
        w += 0.1 * (1.0 + noise(&seed));
        out->omega[k] = w;
        out->zeta[k] = zeta * (1.0 + 0.3 * noise(&seed));
    }
    for (int64_t k = 0; k < m * INPUTS; k++)
        out->B.val[k] = noise(&seed);
    for (int64_t k = 0; k < m * OUTPUTS; k++) {
        out->C.val[k] = noise(&seed);
        out->Cv.val[k] = noise(&seed) / w;
    }
done:
    return status;
}

/* States (w q, q'), mode after mode. */
static ritz_status set_matrices(subject *s)
{
    ritz_status status = RITZ_OK;
    const ritz_modal *modal = &s->modal;
    int64_t n = 2 * modal->count;

    RITZ_NEW(s->sigma, n);
    RITZ_TRY(ritz_dense_new(n, n, &s->A));
    RITZ_TRY(ritz_dense_new(n, INPUTS, &s->B));
    RITZ_TRY(ritz_dense_new(OUTPUTS, n, &s->C));
    for (int64_t k = 0; k < n; k += 2) {
        double w = modal->omega[k / 2];

        ritz_dense_col(&s->A, k + 1)[k] = w;
        ritz_dense_col(&s->A, k)[k + 1] = -w;
        ritz_dense_col(&s->A, k + 1)[k + 1] = -2.0 * modal->zeta[k / 2] * w;
        for (int64_t j = 0; j < INPUTS; j++)
            ritz_dense_col(&s->B, j)[k + 1] =
                ritz_dense_col(&modal->B, j)[k / 2];
        for (int64_t i = 0; i < OUTPUTS; i++) {
            ritz_dense_col(&s->C, k)[i] =
                ritz_dense_col(&modal->C, k / 2)[i] / w;
            ritz_dense_col(&s->C, k + 1)[i] =
                ritz_dense_col(&modal->Cv, k / 2)[i];
        }
    }
    RITZ_TRY(ritz_general_transpose(&s->A, &s->At));
    RITZ_TRY(ritz_general_transpose(&s->C, &s->Ct));
done:
    return status;
}

static ritz_status closed_gramians(subject *s)
{
    ritz_status status = RITZ_OK;
    ritz_dense Wc = {0}, Wo = {0};

    RITZ_TRY(ritz_modal_gramians(&s->modal, NULL, &Wc, &Wo));
done:
    ritz_dense_free(&Wc);
    ritz_dense_free(&Wo);
    return status;
}

static ritz_status closed_factors(subject *s)
{
    ritz_status status = RITZ_OK;
    ritz_dense Zc = {0}, Zo = {0};

    RITZ_TRY(ritz_modal_factors(&s->modal, NULL, &Zc, &Zo));
done:
    ritz_dense_free(&Zc);
    ritz_dense_free(&Zo);
    return status;
}

static ritz_status lyapunov(subject *s)
{
    ritz_status status = RITZ_OK;
    ritz_dense U = {0}, V = {0};

    RITZ_TRY(ritz_general_gramian(&s->A, &s->B, &U));
    RITZ_TRY(ritz_general_gramian(&s->At, &s->Ct, &V));
done:
    ritz_dense_free(&U);
    ritz_dense_free(&V);
    return status;
}

static ritz_status closed_hankel(subject *s)
{
    return ritz_modal_hankel(&s->modal, NULL, s->sigma);
}

/* Either routine of SLICOT, which overwrite what they are given. */
static ritz_status slicot(subject *s, bool reduce)
{
    ritz_status status = RITZ_OK;
    const int inputs = INPUTS, outputs = OUTPUTS;
    int n = (int)s->A.nrow;
    int room = 2 * n * n + n * (n + 5) + 5 * n + n * (n + 1) / 2 + 64 * n;
    int nr = n / 10, warn = 0, info = 0;
    double zero = 0.0;
    ritz_dense A = {0}, B = {0}, C = {0};
    double *work = NULL;
    int *iwork = NULL;

    RITZ_TRY(ritz_dense_copy(&s->A, &A));
    RITZ_TRY(ritz_dense_copy(&s->B, &B));
    RITZ_TRY(ritz_dense_copy(&s->C, &C));
    RITZ_NEW(work, room);
    RITZ_NEW(iwork, n);
    if (reduce)
        ab09ad_("C", "B", "N", "F", &n, &inputs, &outputs, &nr, A.val, &n,
                B.val, &n, C.val, &outputs, s->sigma, &zero, iwork, work, &room,
                &warn, &info, 1, 1, 1, 1);
    else
        ab13ad_("C", "N", &n, &inputs, &outputs, &zero, A.val, &n, B.val, &n,
                C.val, &outputs, &nr, s->sigma, work, &room, &info, 1, 1);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "SLICOT says %d", info);
done:
    ritz_dense_free(&A);
    ritz_dense_free(&B);
    ritz_dense_free(&C);
    free(work);
    free(iwork);
    return status;
}

static ritz_status ab13ad(subject *s)
{
    return slicot(s, false);
}

static ritz_status ab09ad(subject *s)
{
    return slicot(s, true);
}

static int ascending(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;

    return (a > b) - (a < b);
}

static double now(void)
{
    struct timespec t = {0};

    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ritz_status measure(ritz_status (*run)(subject *), subject *s,
                           double *seconds)
{
    ritz_status status = RITZ_OK;
    double took[REPEATS];
    int count = 0;

    do {
        double start = now();

        RITZ_TRY(run(s));
        took[count++] = now() - start;
    } while (count < REPEATS && took[0] < 1.0);
    qsort(took, (size_t)count, sizeof *took, ascending);
    *seconds = took[count / 2];
done:
    return status;
}

/* Largest difference from the last values, over the largest of these. */
static double apart(const subject *s, const double *sigma)
{
    double most = 0.0;

    for (int64_t k = 0; k < s->A.nrow; k++)
        most = fmax(most, fabs(sigma[k] - s->sigma[k]));
    return most / s->sigma[0];
}

static ritz_status row(int64_t states, double zeta)
{
    ritz_status status = RITZ_OK;
    subject s = {0};
    double *sigma = NULL;
    double gramians = 0.0, factors = 0.0, dense = 0.0, hankel = 0.0;
    double values = 0.0, reduce = 0.0;

    RITZ_TRY(set_modal(states / 2, zeta, &s.modal));
    RITZ_TRY(set_matrices(&s));
    RITZ_NEW(sigma, states);
    RITZ_TRY(measure(closed_gramians, &s, &gramians));
    RITZ_TRY(measure(closed_factors, &s, &factors));
    RITZ_TRY(measure(lyapunov, &s, &dense));
    RITZ_TRY(measure(closed_hankel, &s, &hankel));
    memcpy(sigma, s.sigma, (size_t)states * sizeof *sigma);
    RITZ_TRY(measure(ab09ad, &s, &reduce));
    RITZ_TRY(measure(ab13ad, &s, &values));
    printf("%6d %7g %9.4f %9.4f %9.2f %7.0f %9.4f %9.2f %7.1f %9.2f %9.1e\n",
           (int)states, zeta, gramians, factors, dense, dense / gramians,
           hankel, values, values / hankel, reduce, apart(&s, sigma));
    (void)fflush(stdout);
done:
    free(sigma);
    discard(&s);
    return status;
}

int main(int argc, char **argv)
{
    static const char *const usual[] = {"200", "1000", "2000"};
    static const double zeta[] = {0.3, 0.01, 1e-4};
    int count = argc > 1 ? argc - 1 : 3;

    printf("%6s %7s %9s %9s %9s %7s %9s %9s %7s %9s %9s\n", "states", "zeta",
           "Gramians", "factors", "SB03OD 2x", "times", "Hankel", "AB13AD",
           "times", "AB09AD", "apart");
    for (int k = 0; k < 3 * count; k++) {
        const char *text = argc > 1 ? argv[1 + k / 3] : usual[k / 3];

        if (row(strtol(text, NULL, 10) / 2 * 2, zeta[k % 3]) != RITZ_OK) {
            (void)fprintf(stderr, "bench_hankel: %s\n", ritz_error_message());
            return 1;
        }
    }
    return 0;
}
