/*
 * Attachments to the pairs of a state space. Whatever quantity an output is,
 *
 *     u = -k y,    A - B k (I + D k)^-1 C
 *
 * is a spring, a damper or a mass on it, and y = 0 holds it: the poles are then
 * its zeros.
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
#include <stdlib.h>
#include <string.h>

static const double times_own[] = RITZ_ATTACHMENTS;
enum { TIMES = sizeof times_own / sizeof *times_own };

/* Middle of what |y_i / u_i| is over the grid; k_i is one over it. */
static ritz_status own_gains(const ritz_collocated *pairs, double *gain)
{
    RITZ_OWN(ritz_sampler) *sampler = NULL;
    RITZ_OWN_ARRAY double *w = NULL, *sum = NULL;
    int64_t count = 0, met = 0, p = pairs->B.ncol;

    RITZ_CHECK_NEW(sum, p);
    RITZ_CHECK(ritz_probe_grid(&pairs->A, &count, &w));
    RITZ_CHECK(ritz_sampler_new(pairs, &sampler));
    for (int64_t k = 0; k < count; k++) {
        const double _Complex *G = ritz_sampler_at(sampler, w[k]);

        for (int64_t i = 0; G && i < p; i++)
            sum[i] += log(
                fmax(cabs(G[i + i * p]) / pow(w[k], pairs->power[i]), DBL_MIN));
        met += G != NULL;
    }
    for (int64_t i = 0; i < p; i++)
        gain[i] = met > 0 ? exp(-sum[i] / (double)met) : 1.0;
    return RITZ_OK;
}

/* A - B k (I + D k)^-1 C; a row alone, or all: -1. */
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
    for (int64_t k = 0; k < A.nrow * A.ncol; k++)
        A.val[k] -= part.val[k];
    RITZ_MOVE(*out, A);
    return RITZ_OK;
}

static const char *attachment_name(const ritz_collocated *pairs, int64_t only)
{
    static const char *const names[] = {"a mass", "a damper", "a spring"};

    return only < 0 ? "attachments" : names[pairs->power[only] + 1];
}

/* The worst case of all attachments, into worst and where. */
static ritz_status try_all_pairs(ritz_checker *it, const double *gain,
                                 ritz_probe *worst, char where[RITZ_WHERE_SIZE])
{
    const ritz_collocated *pairs = &it->pairs;
    int64_t p = pairs->B.ncol;
    RITZ_OWN(ritz_dense) A = {0};
    double most = -HUGE_VAL;

    for (int64_t only = p > 1 ? -1 : 0; only < p; only++)
        for (int k = 0; k < TIMES; k++) {
            ritz_probe probe = {0};
            double growth = 0.0;

            ritz_dense_free(&A);
            RITZ_CHECK(attach_to_pairs(pairs, only, times_own[k], gain, &A));
            RITZ_CHECK(ritz_probe_judge(&A, &probe));
            growth = probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0;
            if (probe.verdict < worst->verdict ||
                (probe.verdict == worst->verdict && growth <= most))
                continue;
            most = growth;
            *worst = probe;
            snprintf(where, RITZ_WHERE_SIZE, "%s of %g times its own at %s",
                     attachment_name(pairs, only), times_own[k],
                     only < 0 ? "all pairs" : pairs->name[only]);
        }
    return RITZ_OK;
}

/*
 * The zero furthest right, over its size, among those that attachments reach
 * and that are not 0. What is read as acceleration has a double zero at 0,
 * which rounding of n eps splits by the root of that, of the largest pole.
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
    static const char name[] = "interface-locked";
    int64_t at = worst_zero(&it->pairs, count, zero, radius);
    ritz_probe probe = {.count = count, .radius = radius};
    char text[2 * RITZ_NAME_SIZE];
    bool fails = false;

    if (at < 0) {
        ritz_checker_say(it, name, 0.0, RITZ_ZERO_ON_AXIS, RITZ_PASS, "",
                         "with its outputs held nothing is left that moves");
        return;
    }
    fails = creal(zero[at]) > RITZ_ZERO_ON_AXIS * cabs(zero[at]);
    probe.pole[0] = creal(zero[at]);
    probe.pole[1] = fabs(cimag(zero[at]));
    ritz_probe_print(&probe, text);
    ritz_checker_say(it, name, creal(zero[at]) / cabs(zero[at]),
                     RITZ_ZERO_ON_AXIS, fails ? RITZ_FAIL : RITZ_PASS, "",
                     "with its outputs held: %s", text);
}

ritz_status ritz_check_locked_states(ritz_checker *it)
{
    static const char name[] = "interface-locked";
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
    double _Complex *zero = NULL;
    int64_t count = 0;
    ritz_probe probe = {0};

    if (pairs->B.ncol == 0) {
        ritz_checker_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                         "not applicable: no input and output of one name");
        return RITZ_OK;
    }
    RITZ_TRY(ritz_probe_judge(&pairs->A, &probe));
    status = ritz_zeros_of(ritz_model_of_states(&model), RITZ_ALL_CHANNELS,
                           RITZ_ALL_CHANNELS, &count, &zero);
    if (status == RITZ_ERR_SINGULAR) {
        ritz_checker_say(it, name, nan(""), nan(""), RITZ_WARN, "",
                         "its pairs depend on each other, they cannot be held");
        return RITZ_OK;
    }
    RITZ_TRY(status);
    say_locked(it, count, zero, probe.radius);
done:
    free(zero);
    return status;
}

ritz_status ritz_check_sprung_states(ritz_checker *it)
{
    static const char name[] = "interface-sprung";
    RITZ_OWN_ARRAY double *gain = NULL;
    ritz_probe worst = {.verdict = RITZ_STABLE};
    char where[RITZ_WHERE_SIZE] = "";
    char text[2 * RITZ_NAME_SIZE];

    if (it->pairs.B.ncol == 0) {
        ritz_checker_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                         "not applicable: no input and output of one name");
        return RITZ_OK;
    }
    RITZ_CHECK_NEW(gain, it->pairs.B.ncol);
    RITZ_CHECK(own_gains(&it->pairs, gain));
    RITZ_CHECK(try_all_pairs(it, gain, &worst, where));
    ritz_probe_print(&worst, text);
    ritz_checker_say(
        it, name, worst.radius > 0.0 ? worst.pole[0] / worst.radius : 0.0,
        worst.tolerance, worst.verdict == RITZ_UNSTABLE ? RITZ_FAIL : RITZ_PASS,
        where, "with that hung on it: %s", text);
    return RITZ_OK;
}

/*
 * What an assembly may do with a reduced component: hold its interface, attach
 * springs or masses to it, or join it by forces.
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

/* A model as an assembly makes it of this one, and the worst of several. */
typedef struct attachment_trial {
    ritz_dense K, M, D;
    double growth, tolerance; /* the largest so far */
    bool fails;
    char where[RITZ_WHERE_SIZE], why[2 * RITZ_NAME_SIZE];
} attachment_trial;

static void trial_free(attachment_trial *t)
{
    ritz_dense_free(&t->K);
    ritz_dense_free(&t->M);
    ritz_dense_free(&t->D);
}

/* D with what ratios add to it, by the modes of the free model. */
static ritz_status all_damping(const ritz_checker *it, ritz_dense *out)
{
    const ritz_modal_model *modes = &it->modes;
    RITZ_OWN(ritz_dense) own = {0}, part = {0}, sum = {0};

    if (it->model.D.val)
        RITZ_CHECK(ritz_dense_project(&it->model.D, &modes->Phi, &own));
    else
        RITZ_CHECK(ritz_dense_new(modes->count, modes->count, &own));
    for (int64_t k = 0; k < own.nrow * own.ncol; k++)
        own.val[k] = modes->Delta.val[k] - own.val[k];
    RITZ_CHECK(ritz_dense_mul(&modes->MPhi, &own, &part));
    RITZ_CHECK(ritz_dense_mul_nt(&part, &modes->MPhi, &sum));
    for (int64_t k = 0; it->model.D.val && k < sum.nrow * sum.ncol; k++)
        sum.val[k] += it->model.D.val[k];
    RITZ_MOVE(*out, sum);
    return RITZ_OK;
}

static ritz_status copy_model(const ritz_checker *it, const ritz_dense *D,
                              attachment_trial *t)
{
    trial_free(t);
    RITZ_CHECK(ritz_dense_copy(&it->model.K, &t->K));
    RITZ_CHECK(ritz_dense_copy(&it->model.M, &t->M));
    return ritz_dense_copy(D, &t->D);
}

/* Its poles; the largest growth of all trials is remembered with its case. */
static ritz_status probe_trial(attachment_trial *t, const char *where)
{
    ritz_probe probe = {0};
    double growth = 0.0;
    bool fails = false;

    if (t->K.nrow == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_probe_second_order(&t->K, &t->M, &t->D, NULL, &probe));
    fails = probe.verdict == RITZ_UNSTABLE;
    growth = probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0;
    if (fails < t->fails || (fails == t->fails && growth <= t->growth))
        return RITZ_OK;
    t->growth = growth;
    t->tolerance = probe.tolerance;
    t->fails = fails;
    snprintf(t->where, sizeof t->where, "%s", where);
    ritz_probe_print(&probe, t->why);
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
static ritz_status own_sizes(const ritz_checker *it, double *k, double *m)
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

/* Springs and masses, at one row (or at all: -1). */
static ritz_status try_attached(const ritz_checker *it, const ritz_dense *D,
                                int64_t only, const double *own[static 2],
                                attachment_trial *t)
{
    static const char *const what[] = {"springs", "masses"};
    char where[RITZ_WHERE_SIZE];

    for (int mass = 0; mass < 2; mass++)
        for (int k = 0; k < TIMES; k += 1 + mass) {
            RITZ_CHECK(copy_model(it, D, t));
            attach_to_rows(&it->L, only, times_own[k], own[mass],
                           mass ? &t->M : &t->K);
            snprintf(where, sizeof where, "%s of %g times its own at %s",
                     what[mass], times_own[k],
                     only < 0 ? "the whole interface" : it->row[only]);
            RITZ_CHECK(probe_trial(t, where));
        }
    return RITZ_OK;
}

static bool is_proven(ritz_checker *it, const char *name)
{
    if (it->L.nrow == 0)
        ritz_checker_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                         "not applicable: no port and no input");
    else if (it->definite)
        ritz_checker_say(it, name, 0.0, 0.0, RITZ_PASS, "",
                         "proven: M, K and D stay semidefinite");
    else
        return false;
    return true;
}

static void say_trial(ritz_checker *it, const char *name,
                      const attachment_trial *t, const char *what)
{
    ritz_checker_say(it, name, t->growth, t->tolerance,
                     t->fails ? RITZ_FAIL : RITZ_PASS, t->where, "%s: %s", what,
                     *t->why ? t->why : "nothing is left that moves");
}

static ritz_status locked_reduced(ritz_checker *it)
{
    RITZ_OWN(ritz_dense) D = {0}, scaled = {0}, U = {0}, V = {0};
    ritz_dense N = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t rank = 0;
    [[gnu::cleanup(trial_free)]] attachment_trial t = {.growth = -HUGE_VAL};

    RITZ_CHECK(all_damping(it, &D));
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
    RITZ_CHECK(ritz_dense_congruence(&it->model.K, &N, &t.K));
    RITZ_CHECK(ritz_dense_congruence(&it->model.M, &N, &t.M));
    RITZ_CHECK(ritz_dense_project(&D, &N, &t.D));
    RITZ_CHECK(probe_trial(&t, ""));
    say_trial(it, "interface-locked", &t, "with its interface held");
    return RITZ_OK;
}

/* All rows at once, and each of them alone while they are few. */
static ritz_status sprung_reduced(ritz_checker *it)
{
    enum { FEW = 12, SMALL = 100 };
    RITZ_OWN(ritz_dense) D = {0};
    RITZ_OWN_ARRAY double *k = NULL, *m = NULL;
    int64_t p = it->L.nrow;
    int64_t apart = p > 1 && it->model.K.nrow <= SMALL ? p : 0;
    [[gnu::cleanup(trial_free)]] attachment_trial t = {.growth = -HUGE_VAL};
    const double *own[2];

    RITZ_CHECK_NEW(k, p);
    RITZ_CHECK_NEW(m, p);
    RITZ_CHECK(own_sizes(it, k, m));
    RITZ_CHECK(all_damping(it, &D));
    own[0] = k;
    own[1] = m;
    for (int64_t only = -1; only < apart && only < FEW; only++)
        RITZ_CHECK(try_attached(it, &D, only, own, &t));
    say_trial(it, "interface-sprung", &t, "with springs or masses on it");
    return RITZ_OK;
}

ritz_status ritz_check_locked(ritz_checker *it)
{
    static const char name[] = "interface-locked";

    if (it->space)
        return ritz_check_locked_states(it);
    return is_proven(it, name) ? RITZ_OK : locked_reduced(it);
}

ritz_status ritz_check_sprung(ritz_checker *it)
{
    static const char name[] = "interface-sprung";

    if (it->space)
        return ritz_check_sprung_states(it);
    return is_proven(it, name) ? RITZ_OK : sprung_reduced(it);
}

/*
 * Columns of kind force, p, are made to join bodies by interface forces lambda,
 * to which they respond statically: C_q q + C_p p = 0, p = -K_pp^-1 C_p'
 * lambda, with C the rows of the ports. Held to the ground so, a body is
 *
 *     K = [ K_qq   C_q'               ]     M = [ M_qq   0         ]
 *         [ C_q   -C_p K_pp^-1 C_p'   ],        [ 0      H M_pp H' ],
 *
 * H = C_p K_pp^-1, in [q; lambda], C reduced to the rows that C_p reaches: a
 * negative eigenvalue for each force that has mass [Rixen2004].
 */

typedef struct joint {
    int64_t count; /* of force columns */
    int64_t *force, *other;
    ritz_dense Cq, Cp;   /* rows of C that C_p reaches */
    ritz_dense Kpp, Mpp; /* of the force columns */
    ritz_dense flexible; /* K_pp^-1 C_p' */
    ritz_dense K, M;     /* of [q; lambda] */
} joint;

static void joint_free(joint *j)
{
    free(j->force);
    free(j->other);
    ritz_dense_free(&j->Cq);
    ritz_dense_free(&j->Cp);
    ritz_dense_free(&j->Kpp);
    ritz_dense_free(&j->Mpp);
    ritz_dense_free(&j->flexible);
    ritz_dense_free(&j->K);
    ritz_dense_free(&j->M);
}

static ritz_status find_columns(const ritz_reduced *reduced, joint *j)
{
    int64_t rest = 0;

    RITZ_CHECK_NEW(j->force, reduced->columns.count);
    RITZ_CHECK_NEW(j->other, reduced->columns.count);
    for (int64_t k = 0; k < reduced->columns.count; k++)
        if (reduced->columns.kind[k] == RITZ_COLUMN_FORCE)
            j->force[j->count++] = k;
        else
            j->other[rest++] = k;
    return RITZ_OK;
}

/* Columns, or a square part, of A. */
static ritz_status pick_columns(const ritz_dense *A, int64_t count,
                                const int64_t *at, bool square, ritz_dense *out)
{
    int64_t rows = square ? count : A->nrow;

    RITZ_CHECK(ritz_dense_new(rows, count, out));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < rows; i++)
            ritz_dense_col(out, j)[i] =
                ritz_dense_col(A, at[j])[square ? at[i] : i];
    return RITZ_OK;
}

/* C := U'C, U the directions of forces that force columns respond to. */
static ritz_status take_rows(const ritz_checker *it, joint *j)
{
    RITZ_OWN(ritz_dense) Cq = {0}, Cp = {0}, U = {0};
    ritz_dense kept = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t rank = 0;
    int64_t most = it->L.nrow < j->count ? it->L.nrow : j->count;

    RITZ_CHECK(pick_columns(&it->L, j->count, j->force, false, &Cp));
    RITZ_CHECK(
        pick_columns(&it->L, it->L.ncol - j->count, j->other, false, &Cq));
    RITZ_CHECK(ritz_general_svd(&Cp, &U, &sigma, NULL));
    while (rank < most && sigma[rank] > RITZ_RANK_LOSS * sigma[0])
        rank++;
    kept = ritz_dense_part(&U, 0, rank);
    RITZ_CHECK(ritz_dense_mul_tn(&kept, &Cq, &j->Cq));
    return ritz_dense_mul_tn(&kept, &Cp, &j->Cp);
}

static ritz_status fill_joint(const ritz_checker *it, joint *j)
{
    int64_t q = it->L.ncol - j->count;
    int64_t s = j->Cp.nrow;
    RITZ_OWN(ritz_dense) soft = {0}, mass = {0};

    RITZ_CHECK(ritz_general_transpose(&j->Cp, &j->flexible));
    RITZ_CHECK_IN("force columns",
                  ritz_general_solve(&j->Kpp, false, &j->flexible));
    RITZ_CHECK(ritz_dense_mul(&j->Cp, &j->flexible, &soft));
    RITZ_CHECK(ritz_dense_congruence(&j->Mpp, &j->flexible, &mass));
    RITZ_CHECK(ritz_dense_new(q + s, q + s, &j->K));
    RITZ_CHECK(ritz_dense_new(q + s, q + s, &j->M));
    for (int64_t b = 0; b < q; b++) {
        for (int64_t a = 0; a < q; a++) {
            ritz_dense_col(&j->K, b)[a] =
                ritz_dense_col(&it->model.K, j->other[b])[j->other[a]];
            ritz_dense_col(&j->M, b)[a] =
                ritz_dense_col(&it->model.M, j->other[b])[j->other[a]];
        }
        for (int64_t a = 0; a < s; a++)
            ritz_dense_col(&j->K, b)[q + a] = ritz_dense_col(&j->K, q + a)[b] =
                ritz_dense_col(&j->Cq, b)[a];
    }
    for (int64_t b = 0; b < s; b++)
        for (int64_t a = 0; a < s; a++) {
            ritz_dense_col(&j->K, q + b)[q + a] = -ritz_dense_col(&soft, b)[a];
            ritz_dense_col(&j->M, q + b)[q + a] = ritz_dense_col(&mass, b)[a];
        }
    ritz_dense_symmetrise(&j->K);
    ritz_dense_symmetrise(&j->M);
    return RITZ_OK;
}

ritz_status ritz_check_joined(ritz_checker *it)
{
    const ritz_dense none = {0};
    RITZ_OWN(joint) j = {0};
    ritz_probe probe = {0};
    char text[2 * RITZ_NAME_SIZE];

    RITZ_CHECK(find_columns(it->reduced, &j));
    if (j.count == 0 || it->L.nrow == 0)
        return RITZ_OK;
    RITZ_CHECK(take_rows(it, &j));
    RITZ_CHECK(pick_columns(&it->model.K, j.count, j.force, true, &j.Kpp));
    RITZ_CHECK(pick_columns(&it->model.M, j.count, j.force, true, &j.Mpp));
    RITZ_CHECK(fill_joint(it, &j));
    RITZ_CHECK(ritz_probe_second_order(&j.K, &j.M, &none, NULL, &probe));
    ritz_probe_print(&probe, text);
    ritz_checker_say(it, "interface-joined",
                     probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0,
                     probe.tolerance,
                     probe.verdict == RITZ_UNSTABLE ? RITZ_FAIL : RITZ_PASS, "",
                     "joined by interface forces, as its columns are made "
                     "for: %s",
                     text);
    return RITZ_OK;
}
