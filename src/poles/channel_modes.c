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
#include "base/tolerances.h"
#include "linear/general.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mode's input, and its output as displacement, velocity, acceleration. */
enum { FORCE, PLACE, SPEED, PUSH, KINDS };

typedef struct sight {
    const ritz_modal_model *modes;
    double highest, same; /* lambda: the largest, and how near equal ones are */
    double eps;           /* of the magnitudes in a product over all dofs */
    ritz_dense value, doubt; /* modes x KINDS: a'phi_k */
    ritz_dense most;         /* |Phi|'|D||Phi| */
} sight;

static double mixing_of(const sight *s, int64_t j, int64_t k)
{
    double l_j = fabs(s->modes->lambda[j]), l_k = fabs(s->modes->lambda[k]);
    double norm = fmin(s->highest, fmax(l_j, l_k) / RITZ_EIGEN_FAR_BELOW);
    double gap = fabs(s->modes->lambda[j] - s->modes->lambda[k]);

    return RITZ_BACKWARD_ERROR * DBL_EPSILON * norm < gap
               ? RITZ_BACKWARD_ERROR * DBL_EPSILON * norm / gap
               : 1.0;
}

static sight eyes_on(const ritz_modal_model *modes)
{
    int64_t m = modes->count;
    double highest = m > 0 ? fabs(modes->lambda[m - 1]) : 0.0;

    return (sight){.modes = modes,
                   .highest = highest,
                   .same = (double)modes->num_dofs * DBL_EPSILON * highest,
                   .eps = ((double)modes->num_dofs + RITZ_BACKWARD_ERROR) *
                          DBL_EPSILON};
}

/* a'phi_k of all modes; of equal poles only the sum is asked for. */
static void project_rows(const sight *s, const double *a, double *value,
                         double *doubt)
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
                doubt[k] += mixing_of(s, j, k) * fabs(value[j]);
}

/* a'phi_k of every mode, and what rounding may make of it; added to what is
 * there. */
static void channel_see(const ritz_modal_model *modes, const double *a,
                        double *value, double *doubt)
{
    const sight s = eyes_on(modes);

    project_rows(&s, a, value, doubt);
}

/* How much of mode j rounding of K and M may mix into mode k. */
static double channel_mixing(const ritz_modal_model *modes, int64_t j,
                             int64_t k)
{
    const sight s = eyes_on(modes);

    return mixing_of(&s, j, k);
}

static ritz_status open_eyes(const ritz_modal_model *modes, const ritz_dense *D,
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
        project_rows(s, a[kind], ritz_dense_col(&s->value, kind),
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
                              mixing_of(s, i, j) * apart +
                                  s->eps * ritz_dense_col(&s->most, j)[i])
                return true;
        }
    return false;
}

/* (c - lambda ca) b, (cv - rate ca) b, and what rounding makes of them. */
static ritz_channel_row row_of(const sight *s, int64_t k)
{
    const ritz_modal_model *m = s->modes;
    double v[KINDS], d[KINDS], c = m->C.val[k], cv = m->Cv.val[k];
    double l = fabs(m->lambda[k]), rate = ritz_dense_col(&m->Delta, k)[k];
    double off = RITZ_BACKWARD_ERROR * DBL_EPSILON *
                 fmin(s->highest, l / RITZ_EIGEN_FAR_BELOW);
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

ritz_status ritz_channel_rows(const ritz_modal_model *modes,
                              const ritz_dense *D, const ritz_io *io,
                              int64_t *count, ritz_channel_row **out)
{
    ritz_status status = RITZ_OK;
    ritz_channel_row *rows = NULL;
    sight s = {0};

    RITZ_TRY(open_eyes(modes, D, io, &s));
    RITZ_NEW(rows, modes->count);
    *count = is_coupled(&s) ? -1 : drop_silent(collect(&s, rows), rows);
    RITZ_MOVE(*out, rows);
done:
    free(rows);
    ritz_dense_free(&s.value);
    ritz_dense_free(&s.doubt);
    ritz_dense_free(&s.most);
    return status;
}

/*
 * Free rigid motions have no frequency, so any orthogonal basis of them are
 * modes. Without those that damping acts on,
 *
 *     q'' = B_r u,    y = C_r q + Cv_r q'
 *
 * is decoupled from the rest. Only range(B_r) is controllable, and only the
 * part of it that C_r and Cv_r do not map to 0 is observable. All else is a
 * pair of poles at 0 that zeros cancel; numerically they would cancel only up
 * to the square root of eps.
 */

/* Rigid motions by columns: a basis of those that count, so far. */
typedef struct sieve {
    const ritz_modal_model *modes;
    int64_t r;          /* rigid motions */
    ritz_dense loaded;  /* r x ., those that damping acts on */
    ritz_dense left;    /* r x ., those that it leaves free, and that count */
    double uncertainty; /* of any direction of `left` */
} sieve;

/* range(A) and what is orthogonal to it, of values above @p least. */
static ritz_status split_range(const ritz_dense *A, double least,
                               ritz_dense *range, ritz_dense *rest,
                               double *smallest)
{
    RITZ_OWN(ritz_dense) U = {0}, V = {0};
    RITZ_OWN_ARRAY double *s = NULL;
    int64_t most = A->nrow < A->ncol ? A->nrow : A->ncol, rank = 0;

    RITZ_CHECK(ritz_general_svd(A, &U, &s, &V));
    while (rank < most && s[rank] > least)
        rank++;
    *smallest = rank > 0 ? s[rank - 1] : HUGE_VAL;
    RITZ_CHECK(ritz_dense_columns(&U, 0, rank, range));
    if (rest)
        RITZ_CHECK(ritz_dense_columns(&U, rank, A->nrow - rank, rest));
    return RITZ_OK;
}

/* Rounding error of Delta_ik and Delta_ki, i rigid: of the product itself,
   and of the flexible modes that rounding mixes into i. */
static double doubt_of_damping(const sieve *s, const ritz_dense *most,
                               int64_t i, int64_t k)
{
    const ritz_dense *Delta = &s->modes->Delta;
    double sum = (double)s->modes->num_dofs * DBL_EPSILON *
                 (ritz_dense_col(most, k)[i] + ritz_dense_col(most, i)[k]);

    for (int64_t j = s->r; j < s->modes->count; j++)
        sum += channel_mixing(s->modes, j, i) *
               (fabs(ritz_dense_col(Delta, k)[j]) +
                fabs(ritz_dense_col(Delta, j)[k]));
    return sum;
}

/* Split rigid motions into damped and undamped: rows and columns of Delta
   are compared with their rounding error. */
static ritz_status set_apart(const ritz_dense *D, sieve *s)
{
    const ritz_modal_model *f = s->modes;
    int64_t m = f->count;
    double noise = 0.0, smallest = 0.0;
    RITZ_OWN(ritz_dense) G = {0}, most = {0};

    RITZ_CHECK(ritz_dense_new(s->r, 2 * m, &G));
    if (D->val)
        RITZ_CHECK(ritz_dense_terms(D, &f->Phi, &most));
    else
        RITZ_CHECK(ritz_dense_new(m, m, &most));
    for (int64_t i = 0; i < s->r; i++)
        for (int64_t k = 0; k < m; k++) {
            ritz_dense_col(&G, k)[i] = ritz_dense_col(&f->Delta, k)[i];
            ritz_dense_col(&G, m + k)[i] = ritz_dense_col(&f->Delta, i)[k];
            noise = hypot(noise, doubt_of_damping(s, &most, i, k));
        }
    return split_range(&G, noise, &s->loaded, &s->left, &smallest);
}

/* A column of rigid shares a'phi_k over its own doubt. */
static ritz_status weigh_rigid(const sieve *s, const double *a, double *out)
{
    RITZ_OWN_ARRAY double *value = NULL, *doubt = NULL;
    double size = 0.0, unsure = 0.0;

    RITZ_CHECK_NEW(value, s->modes->count);
    RITZ_CHECK_NEW(doubt, s->modes->count);
    channel_see(s->modes, a, value, doubt);
    for (int64_t k = 0; k < s->r; k++) {
        size = hypot(size, value[k]);
        unsure = hypot(unsure, doubt[k]);
    }
    unsure += s->uncertainty * size;
    for (int64_t k = 0; k < s->r && unsure > 0.0; k++)
        out[k] = value[k] / unsure;
    return RITZ_OK;
}

/* Restrict `left` to what the columns of A, r x ., reach; each entry of A is
   known up to 1. */
static ritz_status keep_reached(const ritz_dense *A, sieve *s)
{
    double least = sqrt((double)A->ncol), smallest = 0.0;
    RITZ_OWN(ritz_dense) within = {0}, range = {0}, kept = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&s->left, A, &within));
    RITZ_CHECK(split_range(&within, least, &range, NULL, &smallest));
    RITZ_CHECK(ritz_dense_mul(&s->left, &range, &kept));
    s->uncertainty += least / smallest;
    ritz_dense_free(&s->left);
    RITZ_MOVE(s->left, kept);
    return RITZ_OK;
}

static ritz_status keep_driven(const ritz_io *io, sieve *s)
{
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_dense_new(s->r, io->num_inputs, &A));
    for (int64_t j = 0; j < io->num_inputs; j++)
        RITZ_CHECK(
            weigh_rigid(s, ritz_dense_col(&io->B, j), ritz_dense_col(&A, j)));
    return keep_reached(&A, s);
}

static ritz_status keep_seen(const ritz_io *io, sieve *s)
{
    int64_t outs = io->num_outputs;
    const ritz_dense *by[] = {&io->C, &io->Cv};
    RITZ_OWN(ritz_dense) A = {0}, row = {0};

    RITZ_CHECK(ritz_dense_new(s->r, 2 * outs, &A));
    for (int64_t i = 0; i < 2 * outs; i++) {
        int64_t at = i % outs;

        ritz_dense_free(&row);
        RITZ_CHECK(ritz_dense_rows(by[i / outs], 1, &at, &row));
        RITZ_CHECK(weigh_rigid(s, row.val, ritz_dense_col(&A, i)));
    }
    return keep_reached(&A, s);
}

/* [L N 0; 0 0 I] */
static ritz_status basis_of(const sieve *s, ritz_dense *out)
{
    const ritz_dense *part[] = {&s->loaded, &s->left};
    int64_t m = s->modes->count, at = 0;
    ritz_dense T = {0};

    RITZ_CHECK(ritz_dense_new(m, s->loaded.ncol + s->left.ncol + m - s->r, &T));
    for (int k = 0; k < 2; k++)
        for (int64_t j = 0; j < part[k]->ncol; j++)
            memcpy(ritz_dense_col(&T, at++), ritz_dense_col(part[k], j),
                   (size_t)s->r * sizeof *T.val);
    for (int64_t k = s->r; k < m; k++)
        ritz_dense_col(&T, at++)[k] = 1.0;
    *out = T;
    return RITZ_OK;
}

/* Delta of what is left free is zero, not rounding. */
static void set_free(const sieve *s, ritz_modal_model *f)
{
    for (int64_t k = s->loaded.ncol; k < f->num_rigid; k++)
        for (int64_t i = 0; i < f->count; i++) {
            ritz_dense_col(&f->Delta, k)[i] = 0.0;
            ritz_dense_col(&f->Delta, i)[k] = 0.0;
        }
}

static ritz_status change_basis(const sieve *s, ritz_modal_model *out)
{
    const ritz_modal_model *f = s->modes;
    RITZ_OWN(ritz_modal_model) made = {.num_dofs = f->num_dofs};
    RITZ_OWN(ritz_dense) T = {0};

    RITZ_CHECK(basis_of(s, &T));
    made.count = T.ncol;
    made.num_rigid = T.ncol - (f->count - s->r);
    RITZ_CHECK_NEW(made.lambda, made.count);
    for (int64_t k = made.num_rigid; k < made.count; k++)
        made.lambda[k] = f->lambda[k - made.num_rigid + s->r];
    RITZ_CHECK(ritz_dense_mul(&f->Phi, &T, &made.Phi));
    RITZ_CHECK(ritz_dense_mul(&f->MPhi, &T, &made.MPhi));
    RITZ_CHECK(ritz_dense_project(&f->Delta, &T, &made.Delta));
    RITZ_CHECK(ritz_dense_mul_tn(&T, &f->B, &made.B));
    RITZ_CHECK(ritz_dense_mul(&f->C, &T, &made.C));
    RITZ_CHECK(ritz_dense_mul(&f->Cv, &T, &made.Cv));
    RITZ_CHECK(ritz_dense_copy(&f->feed, &made.feed));
    set_free(s, &made);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_channel_moved(const ritz_modal_model *modes,
                               const ritz_dense *D, const ritz_io *io,
                               ritz_modal_model *out)
{
    ritz_status status = RITZ_OK;
    sieve s = {.modes = modes, .r = modes->num_rigid};

    if (s.r > 0) {
        RITZ_TRY(set_apart(D, &s));
        RITZ_TRY(keep_driven(io, &s));
        RITZ_TRY(keep_seen(io, &s));
    }
    RITZ_TRY(change_basis(&s, out));
done:
    ritz_dense_free(&s.loaded);
    ritz_dense_free(&s.left);
    return status;
}
