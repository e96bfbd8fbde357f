/*
 * What an assembly may do to a model: hold its interface, attach springs,
 * dampers or masses to it, or join it by forces.
 *
 * Attached to the pairs of a state space, whatever quantity an output is,
 *
 *     u = -k y,    A - B k (I + D k)^-1 C
 *
 * is a spring, a damper or a mass, and y = 0 holds it: the poles are then its
 * zeros. Of a reduced component
 *
 *     L q = 0;    K + a sum k_i l_i' l_i;    M + a sum m_i l_i' l_i
 *
 * with rows l_i of the interface, each with its own stiffness and mass,
 *
 *     1 / k_i = l_i Phi_f Lambda_f^-1 Phi_f' l_i',  1 / m_i = l_i Phi Phi' l_i'
 *
 * and a from 1e-3 to 1e3. Where M, K and D are semidefinite, so are all of
 * these, and nothing is computed.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdio.h>

static const double times_own[] = RITZ_ATTACHMENTS;
enum { TIMES = sizeof times_own / sizeof *times_own };

static const char proof[] = "M, K and D stay semidefinite";

/* The worst of several models that an assembly makes of one. */
typedef struct attachment_trial {
    double growth, tolerance; /* the largest so far */
    bool fails;
    char where[RITZ_WHERE_SIZE], why[2 * RITZ_NAME_SIZE];
} attachment_trial;

static void keep_worst(const ritz_probe *probe, const char *where,
                       attachment_trial *t)
{
    double growth = ritz_probe_growth(probe);
    bool fails = probe->verdict == RITZ_UNSTABLE;

    if (fails < t->fails || (fails == t->fails && growth <= t->growth))
        return;
    t->growth = growth;
    t->tolerance = probe->tolerance;
    t->fails = fails;
    snprintf(t->where, sizeof t->where, "%s", where);
    ritz_probe_print(probe, t->why);
}

static void say_trial(ritz_checker *it, const char *name,
                      const attachment_trial *t, const char *what)
{
    ritz_checker_say(it, name, t->growth, t->tolerance,
                     t->fails ? RITZ_FAIL : RITZ_PASS, t->where, "%s: %s", what,
                     *t->why ? t->why : "nothing is left that moves");
}

/* k_i, one over the geometric mean of |y_i / u_i| over the grid. */
static ritz_status find_gains(const ritz_collocated *pairs, double *gain)
{
    RITZ_OWN(ritz_sampler) sampler = {0};
    RITZ_OWN_ARRAY double *w = NULL, *sum = NULL;
    int64_t count = 0, met = 0, p = pairs->B.ncol;

    RITZ_CHECK_NEW(sum, p);
    RITZ_CHECK(ritz_probe_grid(&pairs->A, &count, &w));
    RITZ_CHECK(ritz_sampler_new(pairs, &sampler));
    for (int64_t k = 0; k < count; k++) {
        const double _Complex *G = ritz_sampler_at(&sampler, w[k]);

        for (int64_t i = 0; G && i < p; i++)
            sum[i] += log(
                fmax(cabs(G[i + i * p]) / pow(w[k], pairs->power[i]), DBL_MIN));
        met += G != NULL;
    }
    for (int64_t i = 0; i < p; i++)
        gain[i] = met > 0 ? exp(-sum[i] / (double)met) : 1.0;
    return RITZ_OK;
}

/* A - B k (I + D k)^-1 C, k that of one pair alone or, if -1, of all. */
static ritz_status attach_to_pairs(const ritz_collocated *pairs, int64_t only,
                                   double a, const double *gain,
                                   ritz_dense *out)
{
    int64_t p = pairs->B.ncol;
    RITZ_OWN(ritz_dense) F = {0}, X = {0}, part = {0}, A = {0};

    RITZ_CHECK(ritz_dense_new(p, p, &F));
    RITZ_CHECK(ritz_dense_copy(&pairs->C, &X));
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++) {
            double k = only < 0 || j == only ? a * gain[j] : 0.0;

            ritz_dense_col(&F, j)[i] =
                (i == j) + ritz_dense_col(&pairs->D, j)[i] * k;
        }
    RITZ_CHECK_IN("feedthrough", ritz_general_solve(&F, false, &X));
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&X, j)[i] *=
                only < 0 || i == only ? a * gain[i] : 0.0;
    RITZ_CHECK(ritz_dense_mul(&pairs->B, &X, &part));
    RITZ_CHECK(ritz_dense_copy(&pairs->A, &A));
    ritz_dense_add(-1.0, &part, &A);
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

static const char *attachment_name(const ritz_collocated *pairs, int64_t only)
{
    static const char *const names[] = {"a mass", "a damper", "a spring"};

    return only < 0 ? "attachments" : names[pairs->power[only] + 1];
}

static ritz_status try_all_pairs(const ritz_collocated *pairs,
                                 attachment_trial *t)
{
    int64_t p = pairs->B.ncol;
    RITZ_OWN_ARRAY double *gain = NULL;
    char where[RITZ_WHERE_SIZE];

    RITZ_CHECK_NEW(gain, p);
    RITZ_CHECK(find_gains(pairs, gain));
    for (int64_t only = p > 1 ? -1 : 0; only < p; only++)
        for (int k = 0; k < TIMES; k++) {
            RITZ_OWN(ritz_dense) A = {0};
            ritz_probe probe = {0};

            RITZ_CHECK(attach_to_pairs(pairs, only, times_own[k], gain, &A));
            RITZ_CHECK(ritz_probe_matrix(&A, &probe));
            snprintf(where, sizeof where, "%s of %g times its own at %s",
                     attachment_name(pairs, only), times_own[k],
                     only < 0 ? "all pairs" : pairs->name[only]);
            keep_worst(&probe, where, t);
        }
    return RITZ_OK;
}

/*
 * The zero with the largest real part, relative to its magnitude, among those
 * that attachments reach and that are not 0. An acceleration output has a
 * double zero at 0, which rounding of n eps moves by the square root of that,
 * relative to the largest pole.
 */
static int64_t worst_zero(const ritz_collocated *pairs, int64_t count,
                          const double _Complex *zero, double radius)
{
    double least = sqrt((double)pairs->A.nrow * DBL_EPSILON) * radius;
    int64_t worst = -1;

    for (int64_t k = 0; k < count; k++)
        if (cabs(zero[k]) > least &&
            cabs(zero[k]) <= RITZ_ZEROS_REACH * radius &&
            (worst < 0 || creal(zero[k]) / cabs(zero[k]) >
                              creal(zero[worst]) / cabs(zero[worst])))
            worst = k;
    return worst;
}

static void say_locked(ritz_checker *it, int64_t count,
                       const double _Complex *zero, double radius)
{
    int64_t at = worst_zero(&it->pairs, count, zero, radius);
    ritz_probe probe = {.count = count, .radius = radius};
    attachment_trial t = {.tolerance = RITZ_ZERO_ON_AXIS};

    if (at >= 0) {
        t.growth = creal(zero[at]) / cabs(zero[at]);
        t.fails = creal(zero[at]) > RITZ_ZERO_ON_AXIS * cabs(zero[at]);
        probe.pole[0] = creal(zero[at]);
        probe.pole[1] = fabs(cimag(zero[at]));
        ritz_probe_print(&probe, t.why);
    }
    say_trial(it, "interface-locked", &t, "with its outputs held");
}

static ritz_status lock_pairs(ritz_checker *it)
{
    ritz_status status = RITZ_OK;
    const ritz_collocated *pairs = &it->pairs;
    const ritz_state_space model = {
        .A = pairs->A, /* all borrowed */
        .B = pairs->B,
        .C = pairs->C,
        .D = pairs->D,
        .num_inputs = pairs->B.ncol,
        .num_outputs = pairs->B.ncol,
    };
    RITZ_OWN_ARRAY double _Complex *zero = NULL;
    int64_t count = 0;
    ritz_probe probe = {0};

    RITZ_CHECK(ritz_probe_matrix(&pairs->A, &probe));
    status = ritz_zeros_of(ritz_model_of_states(&model), RITZ_ALL_CHANNELS,
                           RITZ_ALL_CHANNELS, &count, &zero);
    if (status == RITZ_OK)
        say_locked(it, count, zero, probe.radius);
    if (status != RITZ_ERR_SINGULAR)
        return status;
    ritz_checker_say(it, "interface-locked", nan(""), nan(""), RITZ_WARN, "",
                     "its pairs depend on each other, they cannot be held");
    return RITZ_OK;
}

/* A := A + a sum over a row, or all, of size_i l_i' l_i. */
static void attach_to_rows(const ritz_dense *L, int64_t only, double a,
                           const double *size, ritz_dense *A)
{
    for (int64_t i = 0; i < L->nrow; i++) {
        if (only >= 0 && i != only)
            continue;
        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t k = 0; k < A->nrow; k++)
                ritz_dense_col(A, j)[k] += a * size[i] *
                                           ritz_dense_col(L, j)[i] *
                                           ritz_dense_col(L, k)[i];
    }
}

/* k_i and m_i; 0 where a row moves no mode. */
static ritz_status find_sizes(const ritz_checker *it, double *k, double *m)
{
    const ritz_modal_model *modes = &it->modes;
    RITZ_OWN(ritz_dense) LPhi = {0};

    RITZ_CHECK(ritz_dense_mul(&it->L, &modes->Phi, &LPhi));
    for (int64_t i = 0; i < LPhi.nrow; i++) {
        double soft = 0.0, light = 0.0;

        for (int64_t j = 0; j < LPhi.ncol; j++) {
            double l = ritz_dense_col(&LPhi, j)[i];

            light += l * l;
            if (j >= modes->num_rigid)
                soft += l * l / modes->lambda[j];
        }
        m[i] = light > 0.0 ? 1.0 / light : 0.0;
        k[i] = soft > 0.0 ? 1.0 / soft : m[i];
    }
    return RITZ_OK;
}

/* Springs and masses at one row or, if -1, at all. */
static ritz_status try_attached(const ritz_checker *it, const ritz_dense *D,
                                int64_t only, const double *const own[2],
                                attachment_trial *t)
{
    static const char *const what[] = {"springs", "masses"};
    char where[RITZ_WHERE_SIZE];

    for (int mass = 0; mass < 2; mass++)
        for (int k = 0; k < TIMES; k += 1 + mass) {
            RITZ_OWN(ritz_dense) K = {0}, M = {0};
            ritz_probe probe = {0};

            RITZ_CHECK(ritz_dense_copy(&it->model.K, &K));
            RITZ_CHECK(ritz_dense_copy(&it->model.M, &M));
            attach_to_rows(&it->L, only, times_own[k], own[mass],
                           mass ? &M : &K);
            snprintf(where, sizeof where, "%s of %g times its own at %s",
                     what[mass], times_own[k],
                     only < 0 ? "the whole interface" : it->row[only]);
            RITZ_CHECK(ritz_probe_second_order(&K, &M, D, NULL, &probe));
            keep_worst(&probe, where, t);
        }
    return RITZ_OK;
}

/* D of the model and the matrix of its damping ratios. */
static ritz_status find_damping(const ritz_checker *it, ritz_dense *out)
{
    if (it->model.D.val)
        RITZ_CHECK(ritz_dense_copy(&it->model.D, out));
    return ritz_modal_damping(&it->model, &it->damping, out);
}

/* In the null space N of L, whose rows are scaled to one length. */
static ritz_status lock_rows(ritz_checker *it)
{
    RITZ_OWN(ritz_dense) D = {0}, scaled = {0}, U = {0}, V = {0};
    RITZ_OWN(ritz_dense) K_N = {0}, M_N = {0}, D_N = {0};
    ritz_dense N = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t rank = 0;
    attachment_trial t = {.growth = -HUGE_VAL};
    ritz_probe probe = {0};

    RITZ_CHECK(find_damping(it, &D));
    RITZ_CHECK(ritz_dense_copy(&it->L, &scaled));
    for (int64_t i = 0; i < scaled.nrow; i++) {
        double size = 0.0;

        for (int64_t j = 0; j < scaled.ncol; j++)
            size = hypot(size, ritz_dense_col(&scaled, j)[i]);
        for (int64_t j = 0; j < scaled.ncol; j++)
            ritz_dense_col(&scaled, j)[i] /= size;
    }
    RITZ_CHECK(ritz_general_svd(&scaled, &U, &sigma, &V));
    while (rank < scaled.nrow && rank < scaled.ncol &&
           sigma[rank] > RITZ_RANK_LOSS * sigma[0])
        rank++;
    N = ritz_dense_part(&V, rank, V.ncol - rank);
    if (N.ncol > 0) {
        RITZ_CHECK(ritz_dense_congruence(&it->model.K, &N, &K_N));
        RITZ_CHECK(ritz_dense_congruence(&it->model.M, &N, &M_N));
        if (D.val)
            RITZ_CHECK(ritz_dense_project(&D, &N, &D_N));
        RITZ_CHECK(ritz_probe_second_order(&K_N, &M_N, &D_N, NULL, &probe));
        keep_worst(&probe, "", &t);
    }
    say_trial(it, "interface-locked", &t, "with its interface held");
    return RITZ_OK;
}

/* All rows at once, and each of them alone while they are few. */
static ritz_status try_all_rows(const ritz_checker *it, attachment_trial *t)
{
    enum { FEW = 12, SMALL = 100 };
    RITZ_OWN(ritz_dense) D = {0};
    RITZ_OWN_ARRAY double *k = NULL, *m = NULL;
    int64_t p = it->L.nrow;
    int64_t alone = p > 1 && it->model.K.nrow <= SMALL ? p : 0;

    RITZ_CHECK_NEW(k, p);
    RITZ_CHECK_NEW(m, p);
    RITZ_CHECK(find_sizes(it, k, m));
    RITZ_CHECK(find_damping(it, &D));
    for (int64_t only = -1; only < alone && only < FEW; only++)
        RITZ_CHECK(try_attached(it, &D, only, (const double *[2]){k, m}, t));
    return RITZ_OK;
}

ritz_status ritz_check_locked(ritz_checker *it)
{
    if (ritz_checker_settled(it, "interface-locked", proof))
        return RITZ_OK;
    return it->space ? lock_pairs(it) : lock_rows(it);
}

ritz_status ritz_check_sprung(ritz_checker *it)
{
    static const char name[] = "interface-sprung";
    attachment_trial t = {.growth = -HUGE_VAL};

    if (ritz_checker_settled(it, name, proof))
        return RITZ_OK;
    RITZ_CHECK(it->space ? try_all_pairs(&it->pairs, &t)
                         : try_all_rows(it, &t));
    say_trial(it, name, &t,
              it->space ? "with these attachments"
                        : "with springs or masses on it");
    return RITZ_OK;
}

/*
 * Columns of kind force, p, are made to join bodies by interface forces lambda,
 * to which they respond statically: C_q q + C_p p = 0, p = -K_pp^-1 C_p'
 * lambda, with C the rows of the ports. Joined so to the ground, a body is
 *
 *     K = [ K_qq   C_q'               ]     M = [ M_qq   0         ]
 *         [ C_q   -C_p K_pp^-1 C_p'   ],        [ 0      H M_pp H' ],
 *
 * H = C_p K_pp^-1, in [q; lambda], C reduced to the rows that C_p reaches: a
 * negative eigenvalue for each force that has mass [Rixen2004].
 */

/* Columns of kind force, and the others. */
static ritz_status sort_columns(const ritz_columns *columns, ritz_dofs *force,
                                ritz_dofs *other)
{
    RITZ_CHECK_NEW(force->at, columns->count);
    RITZ_CHECK_NEW(other->at, columns->count);
    for (int64_t k = 0; k < columns->count; k++)
        if (columns->kind[k] == RITZ_COLUMN_FORCE)
            force->at[force->count++] = k;
        else
            other->at[other->count++] = k;
    return RITZ_OK;
}

/* C := U'C, U the directions of forces that force columns respond to. */
static ritz_status take_rows(const ritz_dense *L, const ritz_dofs *force,
                             const ritz_dofs *other, ritz_dense *C_p,
                             ritz_dense *C_q)
{
    RITZ_OWN(ritz_dense) L_p = {0}, L_q = {0}, U = {0};
    ritz_dense kept = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t rank = 0;
    int64_t most = L->nrow < force->count ? L->nrow : force->count;

    RITZ_CHECK(ritz_dense_pick(L, force->count, force->at, &L_p));
    RITZ_CHECK(ritz_dense_pick(L, other->count, other->at, &L_q));
    RITZ_CHECK(ritz_general_svd(&L_p, &U, &sigma, NULL));
    while (rank < most && sigma[rank] > RITZ_RANK_LOSS * sigma[0])
        rank++;
    kept = ritz_dense_part(&U, 0, rank);
    RITZ_CHECK(ritz_dense_mul_tn(&kept, &L_q, C_q));
    return ritz_dense_mul_tn(&kept, &L_p, C_p);
}

/* A = [A_qq C'; C sign S], C NULL: 0. */
static ritz_status join_blocks(const ritz_dense *A_qq, const ritz_dense *C,
                               double sign, const ritz_dense *S,
                               ritz_dense *out)
{
    int64_t q = A_qq->nrow, s = S->nrow;

    RITZ_CHECK(ritz_dense_new(q + s, q + s, out));
    ritz_general_place(1.0, A_qq, false, 0, 0, out);
    ritz_general_place(sign, S, false, q, q, out);
    if (C) {
        ritz_general_place(1.0, C, false, q, 0, out);
        ritz_general_place(1.0, C, true, 0, q, out);
    }
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

static ritz_status probe_joined(const ritz_checker *it, const ritz_dofs *force,
                                const ritz_dofs *other, ritz_probe *out)
{
    const ritz_dense none = {0};
    RITZ_OWN(ritz_dense) C_p = {0}, C_q = {0}, K_pp = {0}, M_pp = {0};
    RITZ_OWN(ritz_dense) K_qq = {0}, M_qq = {0}, H = {0}, soft = {0};
    RITZ_OWN(ritz_dense) mass = {0}, K = {0}, M = {0};

    RITZ_CHECK(take_rows(&it->L, force, other, &C_p, &C_q));
    RITZ_CHECK(
        ritz_dense_principal(&it->model.K, force->count, force->at, &K_pp));
    RITZ_CHECK(
        ritz_dense_principal(&it->model.M, force->count, force->at, &M_pp));
    RITZ_CHECK(
        ritz_dense_principal(&it->model.K, other->count, other->at, &K_qq));
    RITZ_CHECK(
        ritz_dense_principal(&it->model.M, other->count, other->at, &M_qq));
    RITZ_CHECK(ritz_general_transpose(&C_p, &H));
    RITZ_CHECK_IN("force columns", ritz_general_solve(&K_pp, false, &H));
    RITZ_CHECK(ritz_dense_mul(&C_p, &H, &soft));
    RITZ_CHECK(ritz_dense_congruence(&M_pp, &H, &mass));
    RITZ_CHECK(join_blocks(&K_qq, &C_q, -1.0, &soft, &K));
    RITZ_CHECK(join_blocks(&M_qq, NULL, 1.0, &mass, &M));
    return ritz_probe_second_order(&K, &M, &none, NULL, out);
}

ritz_status ritz_check_joined(ritz_checker *it)
{
    RITZ_OWN(ritz_dofs) force = {0}, other = {0};
    attachment_trial t = {.growth = -HUGE_VAL};
    ritz_probe probe = {0};

    RITZ_CHECK(sort_columns(&it->reduced->columns, &force, &other));
    if (force.count == 0 || it->L.nrow == 0)
        return RITZ_OK;
    RITZ_CHECK(probe_joined(it, &force, &other, &probe));
    keep_worst(&probe, "", &t);
    say_trial(it, "interface-joined", &t,
              "joined by interface forces, which leave negative squares "
              "(macneal-rubin has the same columns)");
    return RITZ_OK;
}
