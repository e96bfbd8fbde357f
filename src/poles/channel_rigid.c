/*
 * Free rigid motions have no frequency, so any orthogonal basis of them are
 * modes. With those that damping acts on set apart,
 *
 *     q'' = B_r u,    y = C_r q + Cv_r q'
 *
 * stands for itself, and only range(B_r) moves; of it only what C_r and Cv_r
 * tell from rest is seen. All else is a pair of poles at 0 that zeros cancel:
 * it would be found as such only up to the square root of eps.
 */
#include "poles/channel_modes.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rigid motions by columns: a basis of those that count, so far. */
typedef struct sieve {
    const ritz_first_order *modes;
    int64_t r;          /* rigid motions */
    ritz_dense loaded;  /* r x ., those that damping acts on */
    ritz_dense left;    /* r x ., those that it leaves free, and that count */
    double uncertainty; /* of any direction of `left` */
} sieve;

/* range(A) and what is orthogonal to it, of values above @p least. */
static ritz_status split(const ritz_dense *A, double least, ritz_dense *range,
                         ritz_dense *rest, double *smallest)
{
    ritz_status status = RITZ_OK;
    ritz_dense U = {0}, V = {0};
    double *s = NULL;
    int64_t most = A->nrow < A->ncol ? A->nrow : A->ncol, rank = 0;

    RITZ_TRY(ritz_general_svd(A, &U, &s, &V));
    while (rank < most && s[rank] > least)
        rank++;
    *smallest = rank > 0 ? s[rank - 1] : HUGE_VAL;
    RITZ_TRY(ritz_dense_columns(&U, 0, rank, range));
    if (rest)
        RITZ_TRY(ritz_dense_columns(&U, rank, A->nrow - rank, rest));
done:
    ritz_dense_free(&U);
    ritz_dense_free(&V);
    free(s);
    return status;
}

/* Of Delta_ik and Delta_ki, i rigid: that of the product itself, and what
   flexible modes that rounding mixes into i bring of theirs. */
static double doubt_of(const sieve *s, const ritz_dense *most, int64_t i,
                       int64_t k)
{
    const ritz_dense *Delta = &s->modes->Delta;
    double sum = (double)s->modes->num_dofs * DBL_EPSILON *
                 (ritz_dense_col(most, k)[i] + ritz_dense_col(most, i)[k]);

    for (int64_t j = s->r; j < s->modes->count; j++)
        sum += ritz_channel_mixing(s->modes, j, i) *
               (fabs(ritz_dense_col(Delta, k)[j]) +
                fabs(ritz_dense_col(Delta, j)[k]));
    return sum;
}

/* Of Delta, rows and columns of rigid motions, against its rounding. */
static ritz_status set_apart(const ritz_dense *D, sieve *s)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *f = s->modes;
    int64_t m = f->count;
    double noise = 0.0, smallest = 0.0;
    ritz_dense G = {0}, most = {0};

    RITZ_TRY(ritz_dense_new(s->r, 2 * m, &G));
    if (D->val)
        RITZ_TRY(ritz_dense_terms(D, &f->Phi, &most));
    else
        RITZ_TRY(ritz_dense_new(m, m, &most));
    for (int64_t i = 0; i < s->r; i++)
        for (int64_t k = 0; k < m; k++) {
            ritz_dense_col(&G, k)[i] = ritz_dense_col(&f->Delta, k)[i];
            ritz_dense_col(&G, m + k)[i] = ritz_dense_col(&f->Delta, i)[k];
            noise = hypot(noise, doubt_of(s, &most, i, k));
        }
    RITZ_TRY(split(&G, noise, &s->loaded, &s->left, &smallest));
done:
    ritz_dense_free(&G);
    ritz_dense_free(&most);
    return status;
}

/* A column of rigid shares a'phi_k over its own doubt. */
static ritz_status weigh(const sieve *s, const double *a, double *out)
{
    ritz_status status = RITZ_OK;
    double *value = NULL, *doubt = NULL;
    double size = 0.0, unsure = 0.0;

    RITZ_NEW(value, s->modes->count);
    RITZ_NEW(doubt, s->modes->count);
    ritz_channel_see(s->modes, a, value, doubt);
    for (int64_t k = 0; k < s->r; k++) {
        size = hypot(size, value[k]);
        unsure = hypot(unsure, doubt[k]);
    }
    unsure += s->uncertainty * size;
    for (int64_t k = 0; k < s->r && unsure > 0.0; k++)
        out[k] = value[k] / unsure;
done:
    free(value);
    free(doubt);
    return status;
}

/* Of `left` what the columns of A, r x ., reach; each is known up to 1. */
static ritz_status keep_reached(const ritz_dense *A, sieve *s)
{
    ritz_status status = RITZ_OK;
    double least = sqrt((double)A->ncol), smallest = 0.0;
    ritz_dense within = {0}, range = {0}, kept = {0};

    RITZ_TRY(ritz_dense_mul_tn(&s->left, A, &within));
    RITZ_TRY(split(&within, least, &range, NULL, &smallest));
    RITZ_TRY(ritz_dense_mul(&s->left, &range, &kept));
    s->uncertainty += least / smallest;
    ritz_dense_free(&s->left);
    s->left = kept;
    kept = (ritz_dense){0};
done:
    ritz_dense_free(&within);
    ritz_dense_free(&range);
    ritz_dense_free(&kept);
    return status;
}

static ritz_status keep_driven(const ritz_io *io, sieve *s)
{
    ritz_status status = RITZ_OK;
    ritz_dense A = {0};

    RITZ_TRY(ritz_dense_new(s->r, io->num_inputs, &A));
    for (int64_t j = 0; j < io->num_inputs; j++)
        RITZ_TRY(weigh(s, ritz_dense_col(&io->B, j), ritz_dense_col(&A, j)));
    RITZ_TRY(keep_reached(&A, s));
done:
    ritz_dense_free(&A);
    return status;
}

static ritz_status keep_seen(const ritz_io *io, sieve *s)
{
    ritz_status status = RITZ_OK;
    int64_t outs = io->num_outputs;
    const ritz_dense *by[] = {&io->C, &io->Cv};
    ritz_dense A = {0}, row = {0};

    RITZ_TRY(ritz_dense_new(s->r, 2 * outs, &A));
    for (int64_t i = 0; i < 2 * outs; i++) {
        int64_t at = i % outs;

        ritz_dense_free(&row);
        RITZ_TRY(ritz_dense_rows(by[i / outs], 1, &at, &row));
        RITZ_TRY(weigh(s, row.val, ritz_dense_col(&A, i)));
    }
    RITZ_TRY(keep_reached(&A, s));
done:
    ritz_dense_free(&A);
    ritz_dense_free(&row);
    return status;
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
static void set_free(const sieve *s, ritz_first_order *f)
{
    for (int64_t k = s->loaded.ncol; k < f->num_rigid; k++)
        for (int64_t i = 0; i < f->count; i++) {
            ritz_dense_col(&f->Delta, k)[i] = 0.0;
            ritz_dense_col(&f->Delta, i)[k] = 0.0;
        }
}

static ritz_status change(const sieve *s, ritz_first_order *out)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *f = s->modes;
    ritz_first_order made = {.num_dofs = f->num_dofs};
    ritz_dense T = {0};

    RITZ_TRY(basis_of(s, &T));
    made.count = T.ncol;
    made.num_rigid = T.ncol - (f->count - s->r);
    RITZ_NEW(made.lambda, made.count);
    for (int64_t k = made.num_rigid; k < made.count; k++)
        made.lambda[k] = f->lambda[k - made.num_rigid + s->r];
    RITZ_TRY(ritz_dense_mul(&f->Phi, &T, &made.Phi));
    RITZ_TRY(ritz_dense_mul(&f->MPhi, &T, &made.MPhi));
    RITZ_TRY(ritz_dense_project(&f->Delta, &T, &made.Delta));
    RITZ_TRY(ritz_dense_mul_tn(&T, &f->B, &made.B));
    RITZ_TRY(ritz_dense_mul(&f->C, &T, &made.C));
    RITZ_TRY(ritz_dense_mul(&f->Cv, &T, &made.Cv));
    RITZ_TRY(ritz_dense_copy(&f->feed, &made.feed));
    set_free(s, &made);
    *out = made;
    made = (ritz_first_order){0};
done:
    ritz_dense_free(&T);
    ritz_first_order_free(&made);
    return status;
}

ritz_status ritz_channel_moved(const ritz_first_order *modes,
                               const ritz_dense *D, const ritz_io *io,
                               ritz_first_order *out)
{
    ritz_status status = RITZ_OK;
    sieve s = {.modes = modes, .r = modes->num_rigid};

    if (s.r > 0) {
        RITZ_TRY(set_apart(D, &s));
        RITZ_TRY(keep_driven(io, &s));
        RITZ_TRY(keep_seen(io, &s));
    }
    RITZ_TRY(change(&s, out));
done:
    ritz_dense_free(&s.loaded);
    ritz_dense_free(&s.left);
    return status;
}
