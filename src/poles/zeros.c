/* Zeros: found from the pencil, made exact where the model says more. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/resolvent.h"
#include "model/modal.h"
#include "poles/poles.h"

#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Complex triangular form of one channel: poles are on the diagonal. */
typedef struct triangle {
    int64_t n, band; /* entries above the diagonal lie within `band` of it */
    double _Complex *T, *b, *c;
    double d;
    bool *cancelled;              /* n, poles that do not count */
    double _Complex *x, *w, *two; /* to work in */
} triangle;

/* A value, its derivatives, and how far rounding may move the value. */
typedef struct sample {
    double _Complex f, first, second;
    double error;
} sample;

/*
 * Finite zeros by the reduction of the system pencil to a regular one of the
 * same finite zeros (SLICOT AB08ND, [EmamiNaeiniVanDooren1982]). Time, inputs
 * and outputs are scaled first, so that its decisions on rank are no question
 * of units.
 */

/* The Fortran name; character arguments bring their lengths at the end. */
void ab08nd_(/* NOLINT: its name */ const char *equil, const int *n,
             const int *m, const int *p, double *A, const int *lda, double *B,
             const int *ldb, double *C, const int *ldc, double *D,
             const int *ldd, int *nu, int *rank, int *dinfz, int *nkror,
             int *nkrol, int *infz, int *kronr, int *kronl, double *Af,
             const int *ldaf, double *Bf, const int *ldbf, const double *tol,
             int *iwork, double *work, const int *ldwork, int *info,
             size_t equil_length);

typedef struct pencil {
    int n, m, p, nu, rank;
    double speed; /* that time was divided by */
    ritz_dense A, B, C, D, Af, Bf;
} pencil;

static void pencil_free(pencil *s)
{
    ritz_dense_free(&s->A);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->D);
    ritz_dense_free(&s->Af);
    ritz_dense_free(&s->Bf);
}

/* A scaled to a largest entry of 1; `size` is what it was, or 1 if A is
   zero. */
static ritz_status copy_scaled(const ritz_dense *A, double *size,
                               ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(A, out));
    *size = ritz_dense_max(A);
    if (*size == 0.0)
        *size = 1.0;
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        out->val[k] /= *size;
    return RITZ_OK;
}

static ritz_status start_pencil(const ritz_channel *c, pencil *s)
{
    double b = 1.0, seen = 1.0;

    s->n = (int)c->A.nrow;
    s->m = (int)c->B.ncol;
    s->p = (int)c->C.nrow;
    RITZ_CHECK(copy_scaled(&c->A, &s->speed, &s->A));
    RITZ_CHECK(copy_scaled(&c->B, &b, &s->B));
    RITZ_CHECK(copy_scaled(&c->C, &seen, &s->C));
    RITZ_CHECK(ritz_dense_copy(&c->D, &s->D));
    for (int64_t k = 0; k < s->D.nrow * s->D.ncol; k++)
        s->D.val[k] *= s->speed / (b * seen);
    RITZ_CHECK(ritz_dense_new(s->n + s->m, s->n + (s->m < s->p ? s->m : s->p),
                              &s->Af));
    return ritz_dense_new(s->n + s->p, s->n + s->m, &s->Bf);
}

static ritz_status deflate_pencil(pencil *s)
{
    int room = 64 * (s->n + s->m + s->p + 1);
    int lda = s->n > 1 ? s->n : 1;
    int ldp = s->p > 1 ? s->p : 1;
    int ldaf = s->n + s->m, ldbf = s->n + s->p;
    int dinfz = 0, nkror = 0, nkrol = 0, info = 0;
    double tolerance = 0.0; /* its own: sqrt((n + p)(n + m)) eps */
    RITZ_OWN_ARRAY int *infz = NULL, *kronr = NULL, *kronl = NULL;
    RITZ_OWN_ARRAY int *iwork = NULL;
    RITZ_OWN_ARRAY double *work = NULL;

    RITZ_CHECK_NEW(infz, s->n);
    RITZ_CHECK_NEW(kronr, ldaf + 1);
    RITZ_CHECK_NEW(kronl, ldbf + 1);
    RITZ_CHECK_NEW(iwork, (int64_t)s->m + s->p);
    RITZ_CHECK_NEW(work, room);
    ab08nd_("N", &s->n, &s->m, &s->p, s->A.val, &lda, s->B.val, &lda, s->C.val,
            &ldp, s->D.val, &ldp, &s->nu, &s->rank, &dinfz, &nkror, &nkrol,
            infz, kronr, kronl, s->Af.val, &ldaf, s->Bf.val, &ldbf, &tolerance,
            iwork, work, &room, &info, 1);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the zeros were not found, SLICOT says %d", info);
    RITZ_REFUSE_IF(s->rank < s->m || s->rank < s->p, RITZ_ERR_SINGULAR,
                   s->m == 1 && s->p == 1
                       ? "nothing passes from that input to that output"
                       : "what passes through all channels has not as many "
                         "dimensions as there are of them: zeros are "
                         "everywhere");
    return RITZ_OK;
}

/*
 * Finite zeros as the pencil has them, which rounding of its largest entries
 * moves; conjugate pairs one after the other.
 */
static ritz_status find_pencil_zeros(const ritz_channel *channel,
                                     int64_t *count, double _Complex **out)
{
    RITZ_OWN(pencil) s = {0};
    RITZ_OWN_ARRAY double _Complex *zero = NULL;
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL, *beta = NULL;
    int64_t kept = 0;
    int info = 0;

    RITZ_CHECK(start_pencil(channel, &s));
    RITZ_CHECK(deflate_pencil(&s));
    RITZ_CHECK_NEW(re, s.nu);
    RITZ_CHECK_NEW(im, s.nu);
    RITZ_CHECK_NEW(beta, s.nu);
    RITZ_CHECK_NEW(zero, s.nu);
    if (s.nu > 0)
        info =
            LAPACKE_dggev(LAPACK_COL_MAJOR, 'N', 'N', s.nu, s.Af.val, s.n + s.m,
                          s.Bf.val, s.n + s.p, re, im, beta, NULL, 1, NULL, 1);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "zeros were not found");
    for (int k = 0; k < s.nu; k++) {
        bool second = kept > 0 && im[k] < 0.0 && im[k - 1] > 0.0;

        if (beta[k] == 0.0)
            continue;
        zero[kept] = ritz_complex(re[k], im[k]) / beta[k] * s.speed;
        if (second) /* of a pair, exactly */
            zero[kept] = conj(zero[kept - 1]);
        kept++;
    }
    *count = kept;
    RITZ_MOVE(*out, zero);
    return RITZ_OK;
}

/*
 * A channel as a complex triangle, T = Q^H A Q:
 *
 *     f(z)   = d + c x,            (z I - T) x = b,  w (z I - T) = c
 *     f'(z)  = -w x,               f''(z) = 2 w y,   (z I - T) y = x
 *
 * Where modes are decoupled A is diagonal, or has blocks of two that are
 * triangularised in closed form.
 */

static void fill_diagonal(const ritz_channel *channel, triangle *t)
{
    for (int64_t k = 0; k < t->n; k++) {
        t->T[k + k * t->n] = ritz_dense_col(&channel->A, k)[k];
        t->b[k] = channel->B.val[k];
        t->c[k] = channel->C.val[k];
    }
}

/*
 * [0 w; -l/w -d] has the eigenvector v = [w; s]; beside it, of length one,
 * stands [-conj s; w].
 */
static void fill_block(const ritz_channel *channel, int64_t k, triangle *t)
{
    int64_t n = t->n, m = n / 2, at = 2 * k;
    double w = ritz_dense_col(&channel->A, m + k)[k];
    double low = ritz_dense_col(&channel->A, k)[m + k];
    double half = ritz_dense_col(&channel->A, m + k)[m + k] / 2.0;
    const double *b = channel->B.val, *c = channel->C.val;
    double _Complex gap = csqrt(ritz_complex(half * half + w * low, 0.0));
    /* of two real ones the larger first: the other without cancellation */
    double _Complex s = half < 0.0 ? half - gap : half + gap;
    double _Complex other = s == 0.0 ? 0.0 : -w * low / s;
    double _Complex bar = conj(s);
    double length = sqrt(w * w + creal(s * bar));

    t->T[at + at * n] = s;
    t->T[at + 1 + (at + 1) * n] = other;
    /* v^H A v_beside */
    t->T[at + (at + 1) * n] =
        (w * (w * w) + bar * (-low * bar + 2.0 * half * w)) / (length * length);
    t->b[at] = (w * b[k] + bar * b[m + k]) / length;
    t->b[at + 1] = (-s * b[k] + w * b[m + k]) / length;
    t->c[at] = (w * c[k] + s * c[m + k]) / length;
    t->c[at + 1] = (-bar * c[k] + w * c[m + k]) / length;
}

static ritz_status fill_schur(const ritz_channel *channel, triangle *t)
{
    const ritz_dense none = {0};
    RITZ_OWN(ritz_resolvent) r = {0};

    RITZ_CHECK(
        ritz_resolvent_new(&channel->A, &none, &channel->B, &channel->C, &r));
    RITZ_MOVE(t->T, r.S);
    RITZ_MOVE(t->b, r.B);
    RITZ_MOVE(t->c, r.C);
    return RITZ_OK;
}

static void triangle_free(triangle *t)
{
    RITZ_FREE(t->T, t->b, t->c, t->cancelled, t->x, t->w, t->two);
    *t = (triangle){0};
}

/* @return RITZ_ERR_CONVERGENCE */
static ritz_status triangle_new(const ritz_channel *channel, triangle *out)
{
    int64_t n = channel->A.nrow;
    RITZ_OWN(triangle) t = {.n = n, .d = channel->D.val[0]};

    if (!channel->squared && !channel->blocks) {
        t.band = n;
        RITZ_CHECK(fill_schur(channel, &t));
    } else {
        t.band = channel->blocks;
        RITZ_CHECK_NEW(t.T, n * n);
        RITZ_CHECK_NEW(t.b, n);
        RITZ_CHECK_NEW(t.c, n);
    }
    RITZ_CHECK_NEW(t.cancelled, n);
    RITZ_CHECK_NEW(t.x, n);
    RITZ_CHECK_NEW(t.w, n);
    RITZ_CHECK_NEW(t.two, n);
    if (channel->squared)
        fill_diagonal(channel, &t);
    for (int64_t k = 0; channel->blocks && k < n / 2; k++)
        fill_block(channel, k, &t);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

/* (z I - T) x = b, from the last row up. */
static void solve_right(const triangle *t, double _Complex z,
                        const double _Complex *b, double _Complex *x)
{
    int64_t n = t->n;

    for (int64_t i = n - 1; i >= 0; i--) {
        int64_t last = t->band < n - 1 - i ? i + t->band : n - 1;
        double _Complex sum = b[i];

        for (int64_t j = i + 1; j <= last; j++)
            sum += t->T[i + j * n] * x[j];
        x[i] = sum / (z - t->T[i + i * n]);
    }
}

/* w (z I - T) = c, from the first column on. */
static void solve_left(const triangle *t, double _Complex z)
{
    int64_t n = t->n;

    for (int64_t j = 0; j < n; j++) {
        double _Complex sum = t->c[j];

        for (int64_t i = t->band < j ? j - t->band : 0; i < j; i++)
            sum += t->w[i] * t->T[i + j * n];
        t->w[j] = sum / (z - t->T[j + j * n]);
    }
}

/* eps (|w| (|z I| + |T|) |x| + |c||x| + |w||b| + |d|) */
static double rounding_at(const triangle *t, double _Complex z)
{
    int64_t n = t->n;
    double sum = fabs(t->d);

    for (int64_t j = 0; j < n; j++) {
        double x = cabs(t->x[j]);

        sum +=
            cabs(t->c[j]) * x + cabs(t->w[j]) * (cabs(t->b[j]) + cabs(z) * x);
        for (int64_t i = t->band < j ? j - t->band : 0; i <= j; i++)
            sum += cabs(t->w[i] * t->T[i + j * n]) * x;
    }
    return DBL_EPSILON * sum;
}

/* d + c (z I - T)^-1 b; z is no pole. @cost O(n band) */
static void triangle_at(const triangle *t, double _Complex z, sample *out)
{
    sample s = {.f = t->d};

    solve_right(t, z, t->b, t->x);
    solve_left(t, z);
    solve_right(t, z, t->x, t->two);
    for (int64_t k = 0; k < t->n; k++) {
        s.f += t->c[k] * t->x[k];
        s.first -= t->w[k] * t->x[k];
        s.second += 2.0 * t->w[k] * t->two[k];
    }
    s.error = rounding_at(t, z);
    *out = s;
}

/*
 * Zeros of one channel, all at once, by the method of Ehrlich and Aberth for
 * the roots of P(z) = f(z) prod (z - p_k), whose values are never formed:
 *
 *     z_i := z_i - 1 / (P'/P - sum 1 / (z_i - z_j)),
 *     P'/P = f'/f + sum 1 / (z_i - p_k)
 *
 * [Aberth1973]. Real starts stay real and pairs stay pairs.
 */

enum { MOST_SWEEPS = 60 };

static double _Complex pole_at(const triangle *t, int64_t k)
{
    return t->T[k + k * t->n];
}

/*
 * Each pole cancels one zero that is nearer to it than rounding of the matrix
 * moves either.
 */
static void cancel_zeros(triangle *t, int64_t *count, double _Complex *zero)
{
    double size = 0.0;
    int64_t kept = 0;

    for (int64_t k = 0; k < t->n * t->n; k++)
        size = fmax(size, cabs(t->T[k]));
    for (int64_t i = 0; i < *count; i++) {
        double within = 100.0 * (double)t->n * DBL_EPSILON *
                        (t->band < t->n ? cabs(zero[i]) : size);
        int64_t nearest = -1;

        for (int64_t k = 0; k < t->n; k++)
            if (!t->cancelled[k] && cabs(zero[i] - pole_at(t, k)) <= within &&
                (nearest < 0 || cabs(zero[i] - pole_at(t, k)) <
                                    cabs(zero[i] - pole_at(t, nearest))))
                nearest = k;
        if (nearest >= 0)
            t->cancelled[nearest] = true;
        else
            zero[kept++] = zero[i];
    }
    *count = kept;
}

/* Nearest pole that counts; HUGE_VAL if there is none. */
static double room_around(const triangle *t, double _Complex z)
{
    double least = HUGE_VAL;

    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k])
            least = fmin(least, cabs(z - pole_at(t, k)));
    return least;
}

/* How far rounding may move a zero, one or a double one. */
static double doubt_of(const sample *s)
{
    double one = cabs(s->first), two = cabs(s->second);

    return fmin(one > 0.0 ? s->error / one : HUGE_VAL,
                two > 0.0 ? sqrt(2.0 * s->error / two) : HUGE_VAL);
}

/* The step of zero i; 0 where the next is lost in rounding. */
static double _Complex step_of(triangle *t, int64_t count,
                               const double _Complex *zero, int64_t i)
{
    double _Complex z = zero[i], slope = 0.0, move;
    sample s;

    triangle_at(t, z, &s);
    if (s.f == 0.0)
        return 0.0;
    slope = s.first / s.f;
    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k])
            slope += 1.0 / (z - pole_at(t, k));
    for (int64_t j = 0; j < count; j++)
        if (j != i && zero[j] != z)
            slope -= 1.0 / (z - zero[j]);
    move = slope != 0.0 ? 1.0 / slope : 0.0;
    if (!isfinite(creal(move)) || !isfinite(cimag(move)))
        return 0.0;
    /* of a real model real ones stay so, but for rounding of the triangle */
    return cimag(z) == 0.0 ? creal(move) : move;
}

/* A pole is no place to evaluate at. */
static double _Complex beside_poles(const triangle *t, double _Complex z)
{
    while (room_around(t, z) == 0.0)
        z = z != 0.0 ? z * (1.0 + RITZ_ZERO_STEP) : DBL_EPSILON;
    return z;
}

static void sweep_zeros(triangle *t, int64_t count, double _Complex *zero,
                        bool *done)
{
    for (int64_t i = 0; i < count; i++) {
        double _Complex move;
        bool pair = cimag(zero[i]) != 0.0 && i + 1 < count &&
                    zero[i + 1] == conj(zero[i]);

        if (!done[i]) {
            zero[i] = beside_poles(t, zero[i]);
            move = step_of(t, count, zero, i);
            done[i] = cabs(move) <= RITZ_ZERO_STEP * cabs(zero[i]);
            zero[i] -= move;
        }
        if (pair) {
            zero[i + 1] = conj(zero[i]);
            done[i + 1] = done[i];
            i++;
        }
    }
}

static void drop_far(triangle *t, int64_t *count, double _Complex *zero)
{
    int64_t kept = 0;

    for (int64_t i = 0; i < *count; i++) {
        double _Complex z = beside_poles(t, zero[i]);
        sample s;

        triangle_at(t, z, &s);
        if (!(doubt_of(&s) >
              RITZ_ZERO_DOUBT * fmax(cabs(z), room_around(t, z))))
            zero[kept++] = zero[i];
    }
    *count = kept;
}

/* Drop zeros on poles, make the others as good as the triangle is, and drop
 * those that cannot be told from infinity. */
static ritz_status polish_zeros(triangle *t, int64_t *count,
                                double _Complex *zero)
{
    RITZ_OWN_ARRAY bool *done = NULL;
    RITZ_OWN_ARRAY double _Complex *start = NULL;
    bool all = false;

    RITZ_CHECK_NEW(done, *count);
    if (t->n == 0)
        return RITZ_OK;
    cancel_zeros(t, count, zero);
    RITZ_CHECK_COPY(start, zero, *count);
    for (int k = 0; k < MOST_SWEEPS && !all; k++) {
        all = true;
        sweep_zeros(t, *count, zero, done);
        for (int64_t i = 0; i < *count; i++)
            all = all && done[i];
    }
    for (int64_t i = 0; i < *count; i++) /* such as a double one */
        zero[i] = done[i] ? zero[i] : start[i];
    drop_far(t, count, zero);
    return RITZ_OK;
}

/* By magnitude; equal ones by real part, and of a pair the upper one first. */
static int compare_zeros(const void *left, const void *right)
{
    const double _Complex *a = left;
    const double _Complex *b = right;
    double size = cabs(*a) - cabs(*b);
    double re = creal(*b) - creal(*a);
    double im = cimag(*b) - cimag(*a);

    if (size != 0.0)
        return size > 0.0 ? 1 : -1;
    if (re != 0.0)
        return re > 0.0 ? 1 : -1;
    return (im > 0.0) - (im < 0.0);
}

/* s = +-sqrt(mu), on an axis exactly where mu is real. */
static void unsquare_zero(double _Complex mu, double _Complex out[2])
{
    double re = creal(mu);
    bool real = cimag(mu) == 0.0;

    out[0] = !real      ? csqrt(mu)
             : re < 0.0 ? ritz_complex(0.0, sqrt(-re))
                        : ritz_complex(sqrt(re), 0.0);
    out[1] = real && re < 0.0 ? conj(out[0]) : -out[0];
}

/* Poles at 0 that the zeros of a derivative cancel. */
static int64_t poles_at_rest(const ritz_channel *c, const triangle *t)
{
    int64_t count = 0;
    double size = 0.0;

    for (int64_t k = 0; k < t->n; k++)
        size = fmax(size, cabs(pole_at(t, k)));
    for (int64_t k = 0; k < t->n; k++)
        if (!t->cancelled[k] &&
            cabs(pole_at(t, k)) <= (double)t->n * DBL_EPSILON * size)
            count += c->squared ? 2 : 1;
    return count;
}

static ritz_status find_zeros(const ritz_channel *c, bool single,
                              int64_t *count, double _Complex **out)
{
    RITZ_OWN(triangle) t = {0};
    RITZ_OWN_ARRAY double _Complex *found = NULL, *zero = NULL;
    int64_t n = 0, kept = 0, at_rest = c->derivative;

    RITZ_CHECK(find_pencil_zeros(c, &n, &found));
    if (single) {
        RITZ_CHECK(triangle_new(c, &t));
        RITZ_CHECK(polish_zeros(&t, &n, found));
        at_rest -= poles_at_rest(c, &t);
    }
    RITZ_CHECK_NEW(zero, 2 * n + 2);
    for (int64_t k = 0; k < n; k++)
        if (c->squared) {
            unsquare_zero(found[k], zero + kept);
            kept += 2;
        } else {
            zero[kept++] = found[k];
        }
    for (int64_t k = 0; k < at_rest; k++)
        zero[kept++] = 0.0;
    qsort(zero, (size_t)kept, sizeof *zero, compare_zeros);
    *count = kept;
    RITZ_MOVE(*out, zero);
    return RITZ_OK;
}

ritz_status ritz_zeros_of(ritz_model model, int64_t output, int64_t input,
                          int64_t *count, double _Complex **out)
{
    RITZ_OWN(ritz_channel) channel = {0};
    RITZ_OWN(ritz_structure) dense = {0};
    ritz_second_order matrices = model.dense;

    if (model.kind == RITZ_MODEL_COMPONENT) {
        RITZ_CHECK(ritz_structure_of_component(model.component, &dense));
        matrices = (ritz_second_order){.K = &dense.K,
                                       .M = &dense.M,
                                       .D = &dense.D,
                                       .io = &model.component->io};
    }
    if (model.kind == RITZ_MODEL_STATES)
        RITZ_CHECK(ritz_channel_states(model.states, output, input, &channel));
    else
        RITZ_CHECK(ritz_channel_dense(&matrices, model.damping, output, input,
                                      &channel));
    return find_zeros(&channel, output != RITZ_ALL_CHANNELS, count, out);
}
