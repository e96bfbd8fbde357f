/*
 * Krylov vectors of a damped structure about s_0 = i w. The impedance of M x''
 * + D x' + (K + i K4) x = F is
 *
 *     Z(s_0 + t) = Z_0 + t (2 s_0 M + D) + t^2 M,
 *
 * so the series of Z^-1 F in t follows from the recurrence
 *
 *     d_1 = Z_0^-1 F,  v_1 = 0,
 *     d_j+1 = -Z_0^-1 ((2 s_0 M + D) d_j + M v_j),  v_j+1 = d_j
 *
 * with complex d. V contains Re d and Im d, so that the reduced matrices are
 * real and keep the moments about s_0 and about its conjugate.
 *
 * A complex block of p columns is stored as 2 p real ones: real parts first,
 * then imaginary parts.
 */
#include "bases/krylov_waves.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <complex.h>
#include <math.h>
#include <string.h>

void ritz_wave_point_free(ritz_wave_point *point)
{
    ritz_zldl_free(&point->Z);
    ritz_sparse_free(&point->at_rest[0]);
    ritz_sparse_free(&point->at_rest[1]);
    *point = (ritz_wave_point){0};
}

void ritz_waves_free(ritz_waves *waves)
{
    ritz_orthonormal_free(&waves->kept);
    *waves = (ritz_waves){0};
}

/* The real matrices A[k] and factors c[k] of Z_0 = sum c[k] A[k]. */
static ritz_status list_matrices(ritz_wave_point *p, const ritz_sparse *D,
                                 const ritz_sparse *A[4], double _Complex c[4],
                                 int64_t *count)
{
    const ritz_elastic *E = p->body;
    const ritz_dofs *w = &E->rest;
    const double _Complex s = ritz_complex(0.0, p->omega);
    int64_t n = 0;

    A[n] = p->relieved ? &p->at_rest[0] : E->K;
    c[n++] = 1.0;
    if (p->relieved)
        RITZ_CHECK(ritz_sparse_extract(E->K, w->count, w->at, w->count, w->at,
                                       &p->at_rest[0]));
    if (p->relieved && p->K4)
        RITZ_CHECK(ritz_sparse_extract(p->K4, w->count, w->at, w->count, w->at,
                                       &p->at_rest[1]));
    if (p->omega > 0.0) {
        A[n] = E->M;
        c[n++] = s * s;
    }
    if (p->omega > 0.0 && D) {
        A[n] = D;
        c[n++] = s;
    }
    if (p->K4) {
        A[n] = p->relieved ? &p->at_rest[1] : p->K4;
        c[n++] = ritz_complex(0.0, 1.0);
    }
    *count = n;
    return RITZ_OK;
}

ritz_status ritz_wave_point_new(const ritz_elastic *body, const ritz_sparse *D,
                                const ritz_sparse *K4, double hertz,
                                ritz_wave_point *out)
{
    RITZ_OWN(ritz_wave_point)
    p = {.body = body, .K4 = K4, .omega = 2.0 * RITZ_PI * hertz};
    const ritz_sparse *A[4] = {0};
    double _Complex c[4] = {0};
    int64_t count = 0;
    ritz_status status = RITZ_OK;

    p.relieved = hertz == 0.0 && body->held.count > 0;
    RITZ_MOVE(*out, p); /* the factor borrows matrices in it, so it must not
                           move from here on */
    RITZ_CHECK(list_matrices(out, D, A, c, &count));
    if (out->relieved && body->rest.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_zldl_new(count, A, &out->Z));
    status = ritz_zldl_factor(out->Z, c);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "expansion point %g Hz is a pole: move it", hertz);
    return status;
}

/* X := Z_0^-1 X; X has the rows of Z_0. */
static ritz_status solve_complex(const ritz_wave_point *p, bool transposed,
                                 ritz_dense *X)
{
    const int64_t count = X->ncol / 2, size = X->nrow * count;
    RITZ_OWN_ARRAY double _Complex *x = NULL;

    RITZ_CHECK_NEW(x, size);
    for (int64_t k = 0; k < size; k++)
        x[k] = ritz_complex(X->val[k], X->val[size + k]);
    if (p->Z && size > 0)
        RITZ_CHECK(ritz_zldl_solve(p->Z, transposed, count, x));
    for (int64_t k = 0; k < size; k++) {
        X->val[k] = creal(x[k]);
        X->val[size + k] = cimag(x[k]);
    }
    return RITZ_OK;
}

/* X := P' S P X: elastic response with a determinate support, see ritz_elastic
   in elastic.c. */
static ritz_status solve_relieved(const ritz_wave_point *p, ritz_dense *X)
{
    const ritz_elastic *E = p->body;
    const ritz_dofs *w = &E->rest;
    RITZ_OWN(ritz_dense) X_w = {0};

    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(ritz_dense_take_out(&E->MPhi, &E->Phi, X));
    RITZ_CHECK(ritz_dense_rows(X, w->count, w->at, &X_w));
    RITZ_CHECK(solve_complex(p, false, &X_w));
    ritz_dense_spread(&X_w, w->at, X);
    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(ritz_dense_take_out(&E->Phi, &E->MPhi, X));
    return RITZ_OK;
}

/* Set the real or the imaginary part of a column to zero if it is rounding
   relative to the larger of both. */
static void clear_parts(const double *size, ritz_dense *X)
{
    const int64_t p = X->ncol / 2;

    for (int64_t j = 0; j < X->ncol; j++)
        if (!(ritz_dense_col_max(X, j) > RITZ_FORCE_RELIEVED * size[j % p]) &&
            X->nrow > 0)
            memset(ritz_dense_col(X, j), 0, (size_t)X->nrow * sizeof *X->val);
}

/* Response X to forces G, split into rigid coordinates q and the rest X. */
static ritz_status respond(const ritz_waves *waves, const ritz_dense *G,
                           ritz_dense *q, ritz_dense *X)
{
    const ritz_elastic *E = waves->point->body;
    const int64_t p = G->ncol / 2;
    RITZ_OWN(ritz_dense) rigid = {0};
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(size, p);
    RITZ_CHECK(ritz_dense_copy(G, X));
    RITZ_CHECK(waves->point->relieved
                   ? solve_relieved(waves->point, X)
                   : solve_complex(waves->point, waves->transposed, X));
    for (int64_t j = 0; j < p; j++)
        size[j] = fmax(ritz_dense_col_max(X, j), ritz_dense_col_max(X, p + j));
    RITZ_CHECK(ritz_dense_mul_tn(&E->MPhi, X, q));
    RITZ_CHECK(ritz_dense_mul(&E->Phi, q, &rigid));
    ritz_dense_add(-1.0, &rigid, X);
    clear_parts(size, X);
    return RITZ_OK;
}

/*
 * Write column j of the coordinates @p d, from row @p at on, to the real and
 * imaginary parts of d in a state z = [Re d, Im d, Re v, Im v].
 */
static void fill_state(const ritz_dense *d, int64_t at, int64_t j, int64_t room,
                       double *z)
{
    const int64_t p = d->ncol / 2;

    for (int64_t i = 0; i < d->nrow; i++) {
        z[at + i] = ritz_dense_col(d, j)[i];
        z[room + at + i] = ritz_dense_col(d, p + j)[i];
    }
}

/* iz = i z, of a state [Re d, Im d, Re v, Im v]. */
static void turn_state(int64_t room, const double *z, double *iz)
{
    for (int64_t half = 0; half < 4 * room; half += 2 * room)
        for (int64_t i = half; i < half + room; i++) {
            iz[i] = -z[room + i];
            iz[room + i] = z[i];
        }
}

/* Append the independent part of a state, and i times that part; z is
   overwritten. */
static ritz_status keep_state(ritz_waves *waves, ritz_dense *z)
{
    ritz_orthonormal *kept = &waves->kept;
    int64_t before = kept->count;
    RITZ_OWN(ritz_dense) iz = {0};

    RITZ_CHECK(ritz_orthonormal_append(kept, z, 1, NULL));
    if (kept->count == before)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(z->nrow, 1, &iz));
    turn_state(waves->room, ritz_dense_col(&kept->V, before), iz.val);
    return ritz_orthonormal_append(kept, &iz, 1, NULL);
}

/*
 * Append the response to forces G to V, and the resulting states to the
 * sequence.
 *
 * @param[in] before  2 room rows, coordinates of v, which is the previous d;
 *                    {0}: v = 0
 */
static ritz_status append_states(ritz_krylov *S, const ritz_dense *G,
                                 const ritz_dense *before, ritz_waves *waves)
{
    ritz_orthonormal *set = &S->set;
    const int64_t p = G->ncol / 2, room = waves->room;
    RITZ_OWN(ritz_dense) q = {0}, X = {0}, d = {0};

    RITZ_CHECK(respond(waves, G, &q, &X));
    RITZ_CHECK(ritz_orthonormal_express(set, &X, S->vectors - set->count, &d));
    waves->first = waves->kept.count;
    for (int64_t j = 0; j < p; j++) {
        RITZ_OWN(ritz_dense) z = {0};

        RITZ_CHECK(ritz_dense_new(4 * room, 1, &z));
        fill_state(&q, 0, j, room, z.val);
        fill_state(&d, q.nrow, j, room, z.val);
        if (before->val)
            memcpy(z.val + 2 * room, ritz_dense_col(before, j),
                   2 * (size_t)room * sizeof *z.val);
        RITZ_CHECK(keep_state(waves, &z));
    }
    waves->count = waves->kept.count - waves->first;
    waves->ended = waves->count == 0;
    waves->whole += !waves->ended && set->left == 0;
    return RITZ_OK;
}

ritz_status ritz_waves_start(ritz_krylov *S, const ritz_dense *F,
                             ritz_waves *waves)
{
    const ritz_elastic *E = S->body;
    const ritz_sparse *const couplings[] = {waves->D, waves->point->K4};
    const ritz_dense at_rest = {0};
    RITZ_OWN(ritz_dense) all = {0}, G = {0};

    RITZ_CHECK(ritz_dense_copy(F, &all));
    for (int k = 0; k < 2 && waves->point->relieved; k++) {
        RITZ_OWN(ritz_dense) APhi = {0}, more = {0};

        if (!couplings[k])
            continue;
        RITZ_CHECK(ritz_sparse_mul(couplings[k], &E->Phi, &APhi));
        RITZ_CHECK(ritz_dense_beside(&all, &APhi, &more));
        ritz_dense_replace(&all, &more);
    }
    RITZ_CHECK(ritz_dense_new(all.nrow, 2 * all.ncol, &G));
    ritz_dense_put(&all, 0, 0, &G);
    waves->room = E->Phi.ncol + S->vectors;
    RITZ_CHECK(ritz_orthonormal_new(4 * waves->room, NULL, S->set.tolerance,
                                    &waves->kept));
    return append_states(S, &G, &at_rest, waves);
}

/* The d (row 0) or v (row 2 room) of the last block, from its coordinates, as
   [Re, Im]. */
static ritz_status expand_states(const ritz_krylov *S, const ritz_waves *waves,
                                 int64_t row, ritz_dense *out)
{
    const ritz_elastic *E = S->body;
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    const int64_t r = E->Phi.ncol, p = waves->count / 2;
    RITZ_OWN(ritz_dense) Q = {0}, c = {0};

    RITZ_CHECK(ritz_dense_beside(&E->Phi, &V, &Q));
    RITZ_CHECK(ritz_dense_new(r + V.ncol, 2 * p, &c));
    for (int64_t j = 0; j < p; j++) {
        const double *z =
            ritz_dense_col(&waves->kept.V, waves->first + 2 * j) + row;

        for (int64_t i = 0; i < c.nrow; i++) {
            ritz_dense_col(&c, j)[i] = z[i];
            ritz_dense_col(&c, p + j)[i] = z[waves->room + i];
        }
    }
    return ritz_dense_mul(&Q, &c, out);
}

/* G -= (a + i b) A X, with G and X stored as [Re, Im]. */
static ritz_status subtract_product(const ritz_sparse *A, double a, double b,
                                    const ritz_dense *X, ritz_dense *G)
{
    const int64_t size = X->nrow * X->ncol / 2;
    RITZ_OWN(ritz_dense) AX = {0};

    RITZ_CHECK(ritz_sparse_mul(A, X, &AX));
    for (int64_t k = 0; k < size; k++) {
        G->val[k] -= a * AX.val[k] - b * AX.val[size + k];
        G->val[size + k] -= a * AX.val[size + k] + b * AX.val[k];
    }
    return RITZ_OK;
}

ritz_status ritz_waves_advance(ritz_krylov *S, double unit, ritz_waves *waves)
{
    const ritz_sparse *M = S->body->M;
    const int64_t p = waves->count / 2, room = waves->room;
    RITZ_OWN(ritz_dense) d = {0}, v = {0}, G = {0}, before = {0};

    RITZ_CHECK(expand_states(S, waves, 0, &d));
    RITZ_CHECK(expand_states(S, waves, 2 * room, &v));
    RITZ_CHECK(ritz_dense_new(d.nrow, d.ncol, &G));
    RITZ_CHECK(
        subtract_product(M, 0.0, 2.0 * unit * waves->point->omega, &d, &G));
    RITZ_CHECK(subtract_product(M, unit * unit, 0.0, &v, &G));
    if (waves->D)
        RITZ_CHECK(subtract_product(waves->D, unit, 0.0, &d, &G));
    RITZ_CHECK(ritz_dense_new(2 * room, p, &before));
    for (int64_t j = 0; j < p; j++)
        memcpy(ritz_dense_col(&before, j),
               ritz_dense_col(&waves->kept.V, waves->first + 2 * j),
               2 * (size_t)room * sizeof *before.val);
    return append_states(S, &G, &before, waves);
}
