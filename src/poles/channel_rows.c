/*
 * Which modes a channel sums. A symmetric structure has modes that its middle
 * does not see, and rounding shows them all the same: with K and M perturbed
 * by few eps of their size, mode k has of mode j, to first order,
 *
 *     mixing_jk = few eps norm_jk / |lambda_j - lambda_k|
 *
 * so a product a'phi_k is known up to n eps |a|'|phi_k| of its own sum and the
 * mixing_jk |a'phi_j| of all others; likewise the damping between two modes,
 * up to mixing_jk |Delta_jj - Delta_kk|. norm_jk is the largest eigenvalue of
 * what LAPACK was given with both: ritz_eigen_dense solves again what is far
 * below.
 */
#include "poles/channel_modes.h"

#include "base/alloc.h"
#include "linear/eigen_dense.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Of eps: LAPACK's backward error. Measured, what a middle sees of modes that
   are zero there: 0.1 to 1.8 times `mixing` with 1 for it, of rows of 5 to 767
   masses and clamped beams of 4 to 128 elements. */
static const double few = 8.0;

/* What acts, and what is seen. */
enum { FORCE, PLACE, SPEED, PUSH, KINDS };

typedef struct sight {
    const ritz_first_order *modes;
    double highest, same; /* lambda: the largest, and how near equal ones are */
    double eps;           /* of the magnitudes in a product over all dofs */
    ritz_dense value, doubt; /* modes x KINDS: a'phi_k */
    ritz_dense most;         /* |Phi|'|D||Phi| */
} sight;

static double mixing(const sight *s, int64_t j, int64_t k)
{
    double l_j = fabs(s->modes->lambda[j]), l_k = fabs(s->modes->lambda[k]);
    double norm = fmin(s->highest, fmax(l_j, l_k) / RITZ_EIGEN_FAR_BELOW);
    double gap = fabs(s->modes->lambda[j] - s->modes->lambda[k]);

    return few * DBL_EPSILON * norm < gap ? few * DBL_EPSILON * norm / gap
                                          : 1.0;
}

static sight eyes_on(const ritz_first_order *modes)
{
    int64_t m = modes->count;
    double highest = m > 0 ? fabs(modes->lambda[m - 1]) : 0.0;

    return (sight){.modes = modes,
                   .highest = highest,
                   .same = (double)modes->num_dofs * DBL_EPSILON * highest,
                   .eps = ((double)modes->num_dofs + few) * DBL_EPSILON};
}

/* a'phi_k of all modes; of equal poles only the sum is asked for. */
static void see(const sight *s, const double *a, double *value, double *doubt)
{
    const double *lambda = s->modes->lambda;

    for (int64_t k = 0; k < s->modes->count; k++) {
        const double *phi = ritz_dense_col(&s->modes->Phi, k);

        for (int64_t i = 0; i < s->modes->num_dofs; i++) {
            value[k] += a[i] * phi[i];
            doubt[k] += s->eps * fabs(a[i] * phi[i]);
        }
    }
    for (int64_t k = 0; k < s->modes->count; k++)
        for (int64_t j = 0; j < s->modes->count; j++)
            if (fabs(lambda[j] - lambda[k]) > s->same)
                doubt[k] += mixing(s, j, k) * fabs(value[j]);
}

void ritz_channel_see(const ritz_first_order *modes, const double *a,
                      double *value, double *doubt)
{
    const sight s = eyes_on(modes);

    see(&s, a, value, doubt);
}

double ritz_channel_mixing(const ritz_first_order *modes, int64_t j, int64_t k)
{
    const sight s = eyes_on(modes);

    return mixing(&s, j, k);
}

static ritz_status open_eyes(const ritz_first_order *modes, const ritz_dense *D,
                             const ritz_io *io, sight *s)
{
    int64_t m = modes->count;
    const double *a[KINDS] = {io->B.val, io->C.val, io->Cv.val, io->Ca.val};

    *s = eyes_on(modes);
    RITZ_CHECK(ritz_dense_new(m, KINDS, &s->value));
    RITZ_CHECK(ritz_dense_new(m, KINDS, &s->doubt));
    if (D->val)
        RITZ_CHECK(ritz_dense_terms(D, &modes->Phi, &s->most));
    else
        RITZ_CHECK(ritz_dense_new(m, m, &s->most));
    for (int kind = 0; kind < KINDS; kind++)
        see(s, a[kind], ritz_dense_col(&s->value, kind),
            ritz_dense_col(&s->doubt, kind));
    return RITZ_OK;
}

static bool is_coupled(const sight *s)
{
    const ritz_dense *Delta = &s->modes->Delta;

    for (int64_t j = 0; j < Delta->ncol; j++)
        for (int64_t i = 0; i < Delta->nrow; i++) {
            double apart =
                fabs(ritz_dense_col(Delta, i)[i] - ritz_dense_col(Delta, j)[j]);

            if (i != j && fabs(ritz_dense_col(Delta, j)[i]) >
                              mixing(s, i, j) * apart +
                                  s->eps * ritz_dense_col(&s->most, j)[i])
                return true;
        }
    return false;
}

/* (c - lambda ca) b, (cv - rate ca) b, and what rounding makes of them. */
static ritz_channel_row row_of(const sight *s, int64_t k)
{
    const ritz_first_order *m = s->modes;
    double v[KINDS], d[KINDS], c = m->C.val[k], cv = m->Cv.val[k];
    double l = fabs(m->lambda[k]), rate = ritz_dense_col(&m->Delta, k)[k];
    double off = few * DBL_EPSILON * fmin(s->highest, l / RITZ_EIGEN_FAR_BELOW);
    double off_rate = s->eps * ritz_dense_col(&s->most, k)[k];

    for (int kind = 0; kind < KINDS; kind++) {
        v[kind] = ritz_dense_col(&s->value, kind)[k];
        d[kind] = ritz_dense_col(&s->doubt, kind)[k];
    }
    d[PLACE] += l * d[PUSH] + off * fabs(v[PUSH]);
    d[SPEED] += fabs(rate) * d[PUSH] + off_rate * fabs(v[PUSH]);
    return (ritz_channel_row){
        .lambda = m->lambda[k],
        .rate = rate,
        .c = c * v[FORCE],
        .cv = cv * v[FORCE],
        .doubt_rate = off_rate,
        .doubt_c = fabs(c) * d[FORCE] + fabs(v[FORCE]) * d[PLACE],
        .doubt_cv = fabs(cv) * d[FORCE] + fabs(v[FORCE]) * d[SPEED]};
}

/* Rates follow lambda at most in proportion: 2 zeta w, a + b w^2. */
static bool is_same(const sight *s, const ritz_channel_row *a,
                    const ritz_channel_row *b)
{
    double size = fabs(a->rate) + fabs(b->rate);
    double l = fabs(a->lambda) + fabs(b->lambda);

    return b->lambda - a->lambda <= s->same &&
           fabs(a->rate - b->rate) <=
               size * (s->eps + (l > 0.0 ? s->same / l : 0.0)) + a->doubt_rate +
                   b->doubt_rate;
}

static int64_t collect(const sight *s, ritz_channel_row *rows)
{
    int64_t count = 0;

    for (int64_t k = 0; k < s->modes->count; k++) {
        ritz_channel_row r = row_of(s, k);
        ritz_channel_row *last = count > 0 ? &rows[count - 1] : NULL;

        if (!last || !is_same(s, last, &r)) {
            rows[count++] = r;
            continue;
        }
        last->c += r.c;
        last->cv += r.cv;
        last->doubt_c += r.doubt_c;
        last->doubt_cv += r.doubt_cv;
    }
    return count;
}

static int64_t drop_silent(int64_t count, ritz_channel_row *rows)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < count; k++) {
        ritz_channel_row r = rows[k];

        r.c = fabs(r.c) <= r.doubt_c ? 0.0 : r.c;
        r.cv = fabs(r.cv) <= r.doubt_cv ? 0.0 : r.cv;
        if (r.c != 0.0 || r.cv != 0.0)
            rows[kept++] = r;
    }
    return kept;
}

ritz_status ritz_channel_rows(const ritz_first_order *modes,
                              const ritz_dense *D, const ritz_io *io,
                              int64_t *count, ritz_channel_row **out)
{
    ritz_status status = RITZ_OK;
    ritz_channel_row *rows = NULL;
    sight s = {0};

    RITZ_TRY(open_eyes(modes, D, io, &s));
    RITZ_NEW(rows, modes->count);
    *count = is_coupled(&s) ? -1 : drop_silent(collect(&s, rows), rows);
    *out = rows;
    rows = NULL;
done:
    free(rows);
    ritz_dense_free(&s.value);
    ritz_dense_free(&s.doubt);
    ritz_dense_free(&s.most);
    return status;
}
