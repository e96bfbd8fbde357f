/*
 * Whether force to velocity is positive real: energy only ever flows in,
 *
 *     (G(i w) + G(i w)^*) / 2 >= 0     for all w
 *
 * [AndersonVongpanitlerd1973]. It is met at and around every pole and between
 * them, down from the lowest of these, and where probe_pencil.c says that a grid
 * may have stepped over something.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/eigenvalues.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static const double golden = 0.61803398874989485;
/* Widths beside a pole, of |Re s| or, where that is less, of |s| / 1000. */
static const double beside[] = {0.25, 1.0, 4.0};
static const double least_width = 1e-3;
enum { DESCENTS = 3, STEPS = 40, MOST_STATES = 200, PER_POLE = 9 };

/* (G + G^*) / 2 and its eigenvalues, and where they were least. */
typedef struct search {
    ritz_sampler *sampler;
    int p;
    double _Complex *H;
    double *lambda;
    double scale; /* largest |G| so far */
    ritz_passivity found;
} search;

static int ascending(const void *left, const void *right)
{
    const double *a = left;
    const double *b = right;

    return (*a > *b) - (*a < *b);
}

int64_t ritz_probe_sort(int64_t count, double *w)
{
    int64_t kept = 0;

    qsort(w, (size_t)count, sizeof *w, ascending);
    for (int64_t k = 0; k < count; k++)
        if (w[k] > 0.0 && (kept == 0 || w[k] > w[kept - 1] * (1.0 + 1e-12)))
            w[kept++] = w[k];
    return kept;
}

ritz_status ritz_probe_grid(const ritz_dense *A, int64_t *count, double **out)
{
    ritz_status status = RITZ_OK;
    ritz_eigenvalues poles = {0};
    double *w = NULL;
    int64_t n = 0;
    int64_t alone = 0;

    RITZ_TRY(ritz_eigenvalues_of(A, &poles));
    RITZ_NEW(w, 2 * (PER_POLE * poles.count + 2));
    for (int64_t k = 0; k < poles.count; k++) {
        double size = hypot(poles.re[k], poles.im[k]);
        double width = fmax(fabs(poles.re[k]), least_width * size);

        w[n++] = size;
        w[n++] = fabs(poles.im[k]);
        for (size_t i = 0; i < sizeof beside / sizeof *beside; i++) {
            w[n++] = fabs(poles.im[k]) - beside[i] * width;
            w[n++] = fabs(poles.im[k]) + beside[i] * width;
        }
    }
    n = ritz_probe_sort(n, w);
    if (n == 0)
        w[n++] = 1.0;
    w[n] = 0.1 * w[0]; /* below all, above all, and between neighbours */
    w[n + 1] = 10.0 * w[n - 1];
    alone = n;
    n += 2;
    for (int64_t k = 1; k < alone; k++)
        w[n++] = sqrt(w[k - 1] * w[k]);
    *count = ritz_probe_sort(n, w);
    *out = w;
    w = NULL;
done:
    free(w);
    ritz_eigenvalues_free(&poles);
    return status;
}

/* Least eigenvalue over |G| at w; positive where there is no answer. */
static double meet(search *s, double w)
{
    const double _Complex *G = ritz_sampler_at(s->sampler, w);
    double size = 0.0;
    double value = 1.0;
    int p = s->p;

    for (int64_t k = 0; G && k < (int64_t)p * p; k++)
        size = hypot(size, cabs(G[k]));
    if (!G || !isfinite(size) || size == 0.0)
        return 1.0;
    s->scale = fmax(s->scale, size);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            s->H[i + j * p] = 0.5 * (G[i + j * p] + conj(G[j + i * p]));
    if (LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', p, s->H, p, s->lambda) != 0)
        return 1.0;
    value = s->lambda[0] / size;
    if (value < s->found.value) {
        s->found.value = value;
        s->found.hertz = w / (2.0 * RITZ_PI);
        s->found.port = 0;
        for (int64_t i = 1; i < p; i++)
            if (cabs(s->H[i]) > cabs(s->H[s->found.port]))
                s->found.port = i;
    }
    return value;
}

/* Golden section of what is least between two points, in log w. */
static void descend(search *s, double low, double high)
{
    double a = log(low), b = log(high);
    double c = b - golden * (b - a), d = a + golden * (b - a);
    double at_c = meet(s, exp(c)), at_d = meet(s, exp(d));

    for (int step = 0; step < STEPS; step++) {
        if (at_c < at_d) {
            b = d;
            d = c;
            at_d = at_c;
            c = b - golden * (b - a);
            at_c = meet(s, exp(c));
        } else {
            a = c;
            c = d;
            at_c = at_d;
            d = a + golden * (b - a);
            at_d = meet(s, exp(d));
        }
    }
}

/* The lowest points of the grid, each with its neighbours. */
static void descend_all(search *s, int64_t count, const double *w,
                        double *value)
{
    for (int turn = 0; turn < DESCENTS; turn++) {
        int64_t at = 0;

        for (int64_t k = 1; k < count; k++)
            if (value[k] < value[at])
                at = k;
        if (value[at] >= 1.0)
            return;
        descend(s, at > 0 ? w[at - 1] : 0.5 * w[at],
                at + 1 < count ? w[at + 1] : 2.0 * w[at]);
        for (int64_t k = at > 0 ? at - 1 : 0; k <= at + 1 && k < count; k++)
            value[k] = 1.0;
    }
}

/* Where two of these follow each other, and between. */
static ritz_status meet_crossings(search *s, const ritz_collocated *model)
{
    ritz_status status = RITZ_OK;
    double *w = NULL;
    int64_t count = 0;

    if (model->A.nrow > MOST_STATES || s->scale == 0.0)
        return RITZ_OK;
    RITZ_TRY(ritz_passivity_crossings(model, 1e-9 * s->scale, &count, &w));
    for (int64_t k = 0; k < count; k++) {
        meet(s, w[k]);
        meet(s, k > 0 ? sqrt(w[k - 1] * w[k]) : 0.5 * w[k]);
        if (k + 1 == count)
            meet(s, 2.0 * w[k]);
    }
done:
    free(w);
    return status;
}

ritz_status ritz_passivity_of(const ritz_collocated *model, ritz_passivity *out)
{
    ritz_status status = RITZ_OK;
    search s = {.p = (int)model->B.ncol, .found = {.value = 1.0}};
    double *w = NULL, *value = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_sampler_new(model, &s.sampler));
    RITZ_NEW(s.H, (int64_t)s.p * s.p);
    RITZ_NEW(s.lambda, s.p);
    RITZ_TRY(ritz_probe_grid(&model->A, &count, &w));
    RITZ_NEW(value, count);
    for (int64_t k = 0; k < count; k++)
        value[k] = meet(&s, w[k]);
    descend_all(&s, count, w, value);
    RITZ_TRY(meet_crossings(&s, model));
    *out = s.found;
done:
    ritz_sampler_free(&s.sampler);
    free(s.H);
    free(s.lambda);
    free(w);
    free(value);
    return status;
}
