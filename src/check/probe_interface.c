/*
 * What an assembly does with a reduced component: hold its interface, hang it
 * on springs, hang masses on it, or join it by forces.
 *
 *     L q = 0;    K + a sum k_i l_i' l_i;    M + a sum m_i l_i' l_i
 *
 * with rows l_i of the interface, each with its own stiffness and mass,
 *
 *     1 / k_i = l_i Phi_f Lambda_f^-1 Phi_f' l_i',   1 / m_i = l_i Phi Phi' l_i'
 *
 * and a from 1e-3 to 1e3. Where M, K and D are semidefinite, so are all of
 * these, and nothing is computed.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Singular values of scaled rows below this are dependent rows. */
static const double dependent = 1e-9;
static const double times_own[] = {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3};
enum { TIMES = sizeof times_own / sizeof *times_own };

/* A model as an assembly makes it of this one, and the worst of several. */
typedef struct trial {
    ritz_dense K, M, D;
    double growth, tolerance; /* the largest so far */
    bool fails;
    char where[RITZ_WHERE_SIZE], why[2 * RITZ_NAME_SIZE];
} trial;

static void discard(trial *t)
{
    ritz_dense_free(&t->K);
    ritz_dense_free(&t->M);
    ritz_dense_free(&t->D);
}

/* D with what ratios add to it, by the modes of the free model. */
static ritz_status all_damping(const ritz_prober *it, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *modes = &it->modes;
    ritz_dense own = {0}, part = {0}, sum = {0};

    if (it->model.D.val)
        RITZ_TRY(ritz_dense_project(&it->model.D, &modes->Phi, &own));
    else
        RITZ_TRY(ritz_dense_new(modes->count, modes->count, &own));
    for (int64_t k = 0; k < own.nrow * own.ncol; k++)
        own.val[k] = modes->Delta.val[k] - own.val[k];
    RITZ_TRY(ritz_dense_mul(&modes->MPhi, &own, &part));
    RITZ_TRY(ritz_dense_mul_nt(&part, &modes->MPhi, &sum));
    for (int64_t k = 0; it->model.D.val && k < sum.nrow * sum.ncol; k++)
        sum.val[k] += it->model.D.val[k];
    *out = sum;
    sum = (ritz_dense){0};
done:
    ritz_dense_free(&own);
    ritz_dense_free(&part);
    ritz_dense_free(&sum);
    return status;
}

static ritz_status copy_model(const ritz_prober *it, const ritz_dense *D,
                              trial *t)
{
    discard(t);
    RITZ_CHECK(ritz_dense_copy(&it->model.K, &t->K));
    RITZ_CHECK(ritz_dense_copy(&it->model.M, &t->M));
    return ritz_dense_copy(D, &t->D);
}

/* Its poles; the largest growth of all trials is remembered with its case. */
static ritz_status probe_trial(trial *t, const char *where)
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
static void attach(const ritz_dense *L, int64_t only, double a,
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
static ritz_status own_sizes(const ritz_prober *it, double *k, double *m)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *modes = &it->modes;
    ritz_dense LPhi = {0};

    RITZ_TRY(ritz_dense_mul(&it->L, &modes->Phi, &LPhi));
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
done:
    ritz_dense_free(&LPhi);
    return status;
}

/* Springs and masses, at one row (or at all: -1). */
static ritz_status try_attached(const ritz_prober *it, const ritz_dense *D,
                                int64_t only, const double *own[static 2],
                                trial *t)
{
    static const char *const what[] = {"springs", "masses"};
    char where[RITZ_WHERE_SIZE];

    for (int mass = 0; mass < 2; mass++)
        for (int k = 0; k < TIMES; k += 1 + mass) {
            RITZ_CHECK(copy_model(it, D, t));
            attach(&it->L, only, times_own[k], own[mass], mass ? &t->M : &t->K);
            snprintf(where, sizeof where, "%s of %g times its own at %s",
                     what[mass], times_own[k],
                     only < 0 ? "the whole interface" : it->row[only]);
            RITZ_CHECK(probe_trial(t, where));
        }
    return RITZ_OK;
}

static bool proven(ritz_prober *it, const char *name)
{
    if (it->L.nrow == 0)
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                        "not applicable: no port and no input");
    else if (it->definite)
        ritz_prober_say(it, name, 0.0, 0.0, RITZ_PASS, "",
                        "proven: M, K and D stay semidefinite");
    else
        return false;
    return true;
}

static void say_trial(ritz_prober *it, const char *name, const trial *t,
                      const char *what)
{
    ritz_prober_say(it, name, t->growth, t->tolerance,
                    t->fails ? RITZ_FAIL : RITZ_PASS, t->where, "%s: %s", what,
                    *t->why ? t->why : "nothing is left that moves");
}

static ritz_status locked_reduced(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    ritz_dense D = {0}, scaled = {0}, U = {0}, V = {0}, N = {0};
    double *sigma = NULL;
    int64_t rank = 0;
    trial t = {.growth = -HUGE_VAL};

    RITZ_TRY(all_damping(it, &D));
    RITZ_TRY(ritz_dense_copy(&it->L, &scaled));
    for (int64_t i = 0; i < scaled.nrow; i++) {
        double size = 0.0;

        for (int64_t j = 0; j < scaled.ncol; j++)
            size = hypot(size, ritz_dense_col(&scaled, j)[i]);
        for (int64_t j = 0; j < scaled.ncol; j++)
            ritz_dense_col(&scaled, j)[i] /= size;
    }
    RITZ_TRY(ritz_general_svd(&scaled, &U, &sigma, &V));
    while (rank < scaled.nrow && rank < scaled.ncol &&
           sigma[rank] > dependent * sigma[0])
        rank++;
    N = ritz_dense_part(&V, rank, V.ncol - rank);
    RITZ_TRY(ritz_dense_congruence(&it->model.K, &N, &t.K));
    RITZ_TRY(ritz_dense_congruence(&it->model.M, &N, &t.M));
    RITZ_TRY(ritz_dense_project(&D, &N, &t.D));
    RITZ_TRY(probe_trial(&t, ""));
    say_trial(it, "interface-locked", &t, "with its interface held");
done:
    discard(&t);
    free(sigma);
    ritz_dense_free(&D);
    ritz_dense_free(&scaled);
    ritz_dense_free(&U);
    ritz_dense_free(&V);
    return status;
}

/* All rows at once, and each of them alone while they are few. */
static ritz_status sprung_reduced(ritz_prober *it)
{
    enum { FEW = 12, SMALL = 100 };
    ritz_status status = RITZ_OK;
    ritz_dense D = {0};
    double *k = NULL, *m = NULL;
    int64_t p = it->L.nrow;
    int64_t apart = p > 1 && it->model.K.nrow <= SMALL ? p : 0;
    trial t = {.growth = -HUGE_VAL};
    const double *own[2];

    RITZ_NEW(k, p);
    RITZ_NEW(m, p);
    RITZ_TRY(own_sizes(it, k, m));
    RITZ_TRY(all_damping(it, &D));
    own[0] = k;
    own[1] = m;
    for (int64_t only = -1; only < apart && only < FEW; only++)
        RITZ_TRY(try_attached(it, &D, only, own, &t));
    say_trial(it, "interface-sprung", &t, "with springs or masses on it");
done:
    discard(&t);
    free(k);
    free(m);
    ritz_dense_free(&D);
    return status;
}

ritz_status ritz_probe_locked(ritz_prober *it)
{
    static const char name[] = "interface-locked";

    if (!it->usable)
        return RITZ_OK;
    if (it->space)
        return ritz_probe_locked_states(it);
    return proven(it, name) ? RITZ_OK : locked_reduced(it);
}

ritz_status ritz_probe_sprung(ritz_prober *it)
{
    static const char name[] = "interface-sprung";

    if (!it->usable)
        return RITZ_OK;
    if (it->space)
        return ritz_probe_sprung_states(it);
    return proven(it, name) ? RITZ_OK : sprung_reduced(it);
}
