/*
 * Modes that damping couples. The states are z = [w_1 q_1, q_1', w_2 q_2, ...,
 * v], with v the velocities of rigid modes coupled to these,
 *
 *     z' = A z + B u,    y = C z + C_r q_r,    q_r' = v = N z
 *
 * where the rigid displacements q_r, which have poles at 0, appear in no other
 * equation. If a rigid motion is not damped, A has further poles at 0. Let A X
 * = X S be the part that decays, Y its left vectors, Y'X = I, Y'A = S Y', and x
 * = Y'z. Then
 *
 *     q_r = N X int x + ...,   int x = S^-1 (x - Y'B int u),
 *
 * so that the part that decays is
 *
 *     x' = S x + Y'B u,    y = (C X + C_r N X S^-1) x
 *
 * and the rest of y belongs to poles at 0. Hammarling's factors of its Gramians
 * are F_c and F_o for x, and X F_c and Y F_o for z.
 *
 * [Moore1981], [Hammarling1982]
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/split.h"

#include <float.h>
#include <math.h>
#include <string.h>

int64_t ritz_modal_order(const ritz_modal *modal)
{
    return 2 * modal->count + modal->num_rigid;
}

/* Index of state q' of flexible mode k, or of v of a rigid one. */
static int64_t rate_of(const ritz_modal *modal, int64_t k)
{
    return k < modal->count ? 2 * k + 1 : modal->count + k;
}

static ritz_status fill_matrix(const ritz_modal *modal, ritz_dense *A)
{
    int64_t n = ritz_modal_order(modal), all = modal->Delta.ncol;

    RITZ_CHECK(ritz_dense_new(n, n, A));
    for (int64_t j = 0; j < all; j++) {
        double *rate = ritz_dense_col(A, rate_of(modal, j));

        for (int64_t i = 0; i < all; i++)
            rate[rate_of(modal, i)] = -ritz_dense_col(&modal->Delta, j)[i];
        if (j < modal->count) {
            rate[2 * j] = modal->omega[j];
            ritz_dense_col(A, 2 * j)[2 * j + 1] = -modal->omega[j];
        }
    }
    return RITZ_OK;
}

/* B, and the outputs as columns; outputs of rigid displacements are left
   out. */
static ritz_status fill_ends(const ritz_modal *modal, ritz_dense *B,
                             ritz_dense *C)
{
    int64_t n = ritz_modal_order(modal);

    RITZ_CHECK(ritz_dense_new(n, modal->B.ncol, B));
    RITZ_CHECK(ritz_dense_new(n, modal->C.nrow, C));
    for (int64_t k = 0; k < modal->B.nrow; k++) {
        int64_t rate = rate_of(modal, k);

        for (int64_t j = 0; j < B->ncol; j++)
            ritz_dense_col(B, j)[rate] = ritz_dense_col(&modal->B, j)[k];
        for (int64_t i = 0; i < C->ncol; i++) {
            double *c = ritz_dense_col(C, i);

            c[rate] = ritz_dense_col(&modal->Cv, k)[i];
            if (k < modal->count)
                c[2 * k] = ritz_dense_col(&modal->C, k)[i] / modal->omega[k];
        }
    }
    return RITZ_OK;
}

/*
 * Separate the part that decays. *hertz is the frequency of a pole that neither
 * decays nor is at 0; 0: there is none.
 */
static ritz_status split_decaying(const ritz_modal *modal, ritz_split *out,
                                  double *hertz)
{
    const ritz_dense none = {0};
    RITZ_OWN(ritz_dense) A = {0}, AT = {0}, rest = {0};
    RITZ_OWN(ritz_eigenvalues) poles = {0};

    *hertz = 0.0;
    RITZ_CHECK(fill_matrix(modal, &A));
    RITZ_CHECK(ritz_split_new(&A, &none, out));
    if (out->T.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(&A, &out->T, &AT));
    RITZ_CHECK(ritz_dense_mul_tn(&out->W, &AT, &rest));
    RITZ_CHECK(ritz_eigenvalues_of(&rest, &poles));
    if (modal->count == 0 || poles.radius > RITZ_POLE_AT_REST * modal->omega[0])
        *hertz = poles.radius / (2.0 * RITZ_PI);
    return RITZ_OK;
}

/* The part that decays, in the coordinates x. */
typedef struct decaying {
    ritz_split split;
    ritz_dense B, C; /* Y'B, and outputs as columns */
} decaying;

static void decaying_free(decaying *part)
{
    ritz_split_free(&part->split);
    ritz_dense_free(&part->B);
    ritz_dense_free(&part->C);
}

/* C += S'^-1 (C_r N X)' */
static ritz_status add_rigid_outputs(const ritz_modal *modal, decaying *part)
{
    int64_t m = modal->count, states = part->split.X.ncol;
    RITZ_OWN(ritz_dense) rates = {0}, Cr = {0}, seen = {0};

    if (modal->num_rigid == 0 || states == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_block(&part->split.X, 2 * m, modal->num_rigid, 0,
                                states, &rates));
    RITZ_CHECK(ritz_dense_columns(&modal->C, m, modal->num_rigid, &Cr));
    RITZ_CHECK(ritz_general_transpose(&Cr, &seen));
    ritz_dense_free(&Cr);
    RITZ_CHECK(ritz_dense_mul_tn(&rates, &seen, &Cr));
    RITZ_CHECK_IN("rigid motion",
                  ritz_general_solve(&part->split.S, true, &Cr));
    ritz_dense_add(1.0, &Cr, &part->C);
    return RITZ_OK;
}

static ritz_status find_decaying(const ritz_modal *modal, decaying *out)
{
    RITZ_OWN(decaying) part = {0};
    RITZ_OWN(ritz_dense) B = {0}, C = {0};
    double hertz = 0.0;

    RITZ_CHECK(split_decaying(modal, &part.split, &hertz));
    RITZ_REFUSE_IF(hertz > 0.0, RITZ_ERR_ARGUMENT,
                   "a motion at %.6g Hz is not damped, or grows: give every "
                   "flexible mode damping, by --damping or the scene",
                   hertz);
    RITZ_CHECK(fill_ends(modal, &B, &C));
    RITZ_CHECK(ritz_dense_mul_tn(&part.split.Y, &B, &part.B));
    RITZ_CHECK(ritz_dense_mul_tn(&part.split.X, &C, &part.C));
    RITZ_CHECK(add_rigid_outputs(modal, &part));
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

/* F_c and F_o. */
static ritz_status factor_decaying(const decaying *part, ritz_dense *Fc,
                                   ritz_dense *Fo)
{
    const ritz_dense one = {0};

    RITZ_CHECK(
        ritz_general_hammarling(&part->split.S, &one, false, &part->B, Fc));
    return ritz_general_hammarling(&part->split.S, &one, true, &part->C, Fo);
}

/* Convert rows of z = [w_1 q_1, q_1', ...] to those of (q_1, q_1', ...): divide
   by w if @p over, else multiply. */
static void scale_positions(const ritz_modal *modal, bool over, ritz_dense *Z)
{
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t k = 0; k < modal->count; k++)
            ritz_dense_col(Z, j)[2 * k] *=
                over ? 1.0 / modal->omega[k] : modal->omega[k];
}

ritz_status ritz_coupled_factors(const ritz_modal *modal, ritz_dense *Zc,
                                 ritz_dense *Zo)
{
    RITZ_OWN(decaying) part = {0};
    RITZ_OWN(ritz_dense) Fc = {0}, Fo = {0}, C = {0}, O = {0};

    RITZ_CHECK(find_decaying(modal, &part));
    RITZ_CHECK(factor_decaying(&part, &Fc, &Fo));
    RITZ_CHECK(ritz_dense_mul(&part.split.X, &Fc, &C));
    RITZ_CHECK(ritz_dense_mul(&part.split.Y, &Fo, &O));
    scale_positions(modal, true, &C);
    scale_positions(modal, false, &O);
    RITZ_MOVE(*Zc, C);
    RITZ_MOVE(*Zo, O);
    return RITZ_OK;
}

ritz_status ritz_coupled_hankel(const ritz_modal *modal, int64_t *count,
                                double *sigma)
{
    RITZ_OWN(decaying) part = {0};
    RITZ_OWN(ritz_dense) Fc = {0}, Fo = {0}, H = {0};

    RITZ_CHECK(find_decaying(modal, &part));
    RITZ_CHECK(factor_decaying(&part, &Fc, &Fo));
    RITZ_CHECK(ritz_dense_mul_tn(&Fo, &Fc, &H));
    *count = H.ncol;
    return ritz_context(ritz_general_singular(&H, sigma), "Hankel values");
}

ritz_status ritz_coupled_outputs(const ritz_modal *modal, ritz_dense *out)
{
    RITZ_OWN(decaying) part = {0};
    RITZ_OWN(ritz_dense) C = {0};

    RITZ_CHECK(find_decaying(modal, &part));
    RITZ_CHECK(ritz_dense_mul(&part.split.Y, &part.C, &C));
    scale_positions(modal, false, &C);
    RITZ_MOVE(*out, C);
    return RITZ_OK;
}

/* Clusters of modes. */

typedef struct joining {
    const ritz_modal *modal;
    int64_t count;  /* number of modes, m + r */
    double largest; /* largest entry of Delta */
    int64_t *cluster;
} joining;

static void merge_clusters(joining *j, int64_t a, int64_t b)
{
    int64_t to = a < b ? a : b, from = a < b ? b : a;

    for (int64_t k = 0; k < j->count; k++)
        if (j->cluster[k] == from)
            j->cluster[k] = to;
}

/* Form clusters of modes that are close in frequency, or that damping
   couples. */
static void join_modes(joining *j)
{
    const ritz_modal *modal = j->modal;
    int64_t last = 0;

    for (int64_t first = 0; first < modal->count; first = last) {
        last = ritz_modal_cluster(modal, first);
        for (int64_t k = first; k < last; k++)
            j->cluster[k] = first;
    }
    for (int64_t b = 0; modal->Delta.val && b < modal->count; b++)
        for (int64_t a = 0; a < b; a++)
            if (j->cluster[a] != j->cluster[b] &&
                ritz_damping_between(&modal->Delta, j->largest, a, b) >
                    RITZ_DAMPING_JOINS)
                merge_clusters(j, j->cluster[a], j->cluster[b]);
}

/* Whether Delta + Delta' is definite: energy then decreases in every motion. */
static ritz_status is_definite(const ritz_dense *Delta, bool *out)
{
    RITZ_OWN(ritz_dense) S = {0};
    double rcond = 0.0;

    RITZ_CHECK(ritz_dense_copy(Delta, &S));
    ritz_dense_symmetrise(&S);
    RITZ_CHECK(ritz_general_cholesky(&S, &rcond));
    *out = rcond > (double)S.ncol * DBL_EPSILON;
    return RITZ_OK;
}

/* Whether every motion of a cluster decays by itself, except rigid motion. */
static ritz_status does_decay(const ritz_modal *part, bool *out)
{
    RITZ_OWN(ritz_split) split = {0};
    double hertz = 0.0;

    *out = true;
    for (int64_t k = 0; k < part->count; k++)
        *out = *out && part->zeta[k] > 0.0;
    if (!part->Delta.val)
        return RITZ_OK;
    RITZ_CHECK(is_definite(&part->Delta, out));
    if (*out)
        return RITZ_OK;
    RITZ_CHECK(split_decaying(part, &split, &hertz));
    *out = !(hertz > 0.0);
    return RITZ_OK;
}

static ritz_status take_cluster(const joining *j, int64_t cluster,
                                ritz_modal *out)
{
    int64_t m = j->modal->count;
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, j->count);
    for (int64_t k = 0; k < j->count; k++)
        taken[k] = j->cluster[k] == cluster;
    return ritz_modal_part(j->modal, taken, taken + m, out);
}

/* The first mode of a cluster that has no damping of its own; if all modes have
   damping, the first. */
static int64_t find_undamped(const joining *j, int64_t cluster)
{
    for (int64_t k = cluster; k < j->modal->count; k++)
        if (j->cluster[k] == cluster && !(j->modal->zeta[k] > 0.0))
            return k;
    return cluster;
}

/* Merge a cluster with all modes that damping couples it to, however weakly. */
static ritz_status grow_cluster(joining *j, int64_t cluster)
{
    const ritz_modal *modal = j->modal;
    int64_t undamped = find_undamped(j, cluster);
    RITZ_OWN_ARRAY bool *was = NULL;
    bool grown = false;

    RITZ_CHECK_NEW(was, j->count);
    for (int64_t k = 0; k < j->count; k++)
        was[k] = j->cluster[k] == cluster;
    for (int64_t b = 0; b < modal->Delta.ncol; b++)
        for (int64_t a = 0; a < modal->Delta.ncol; a++)
            if (was[a] && !was[b] &&
                ritz_damping_between(&modal->Delta, j->largest, a, b) >
                    RITZ_DAMPING_COUPLES) {
                merge_clusters(j, j->cluster[a], j->cluster[b]);
                grown = true;
            }
    return grown ? RITZ_OK
                 : ritz_refuse_undamped(modal->omega[undamped],
                                        modal->zeta[undamped]);
}

ritz_status ritz_coupled_clusters(const ritz_modal *modal, int64_t *cluster)
{
    joining j = {modal, modal->count + modal->num_rigid,
                 ritz_dense_max(&modal->Delta), cluster};
    bool settled = false;

    for (int64_t k = 0; k < j.count; k++)
        cluster[k] = k < modal->count ? k : modal->count;
    join_modes(&j);
    while (!settled) {
        settled = true;
        for (int64_t k = 0; k < modal->count; k++) {
            RITZ_OWN(ritz_modal) part = {0};
            bool decays = false;

            if (cluster[k] != k)
                continue;
            RITZ_CHECK(take_cluster(&j, k, &part));
            RITZ_CHECK(does_decay(&part, &decays));
            if (decays)
                continue;
            RITZ_CHECK(grow_cluster(&j, k));
            settled = false;
        }
    }
    return RITZ_OK;
}

ritz_status ritz_coupled_refuse(const ritz_modal *modal, const char *why)
{
    double largest = ritz_dense_max(&modal->Delta), most = 0.0;
    int64_t pair[2] = {0, 0};

    for (int64_t b = 0; b < modal->count; b++)
        for (int64_t a = 0; a < b; a++) {
            double ratio = ritz_damping_between(&modal->Delta, largest, a, b);

            if (ratio > most) {
                most = ratio;
                pair[0] = a;
                pair[1] = b;
            }
        }
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the damping matrix couples the modes at %.6g and %.6g "
                     "Hz: %s",
                     modal->omega[pair[0]] / (2.0 * RITZ_PI),
                     modal->omega[pair[1]] / (2.0 * RITZ_PI), why);
}
