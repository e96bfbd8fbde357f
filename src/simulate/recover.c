/*
 * Recovery of quantities, such as stresses, from the coordinates q of a reduced
 * component. Mode displacement is y = S T q, or y = S T q'' for quantities of
 * kind acceleration. Mode acceleration is
 *
 *     y = Q q + V q' + A P q'' + F f - H g,   g_j = c_j b_j'q' + k_j b_j'q
 *
 * with the inputs f and the forces g of the dampers. Damping that is stated as
 * a rule, not as a matrix, causes more forces. With A = -S G M T and Q - S T =
 * -S G K T (bases/mode_acceleration.c), damping a M + b K adds
 *
 *     a A P q' + b (Q - S T) q' - b H (k_j b_j'q')_j,
 *
 * where the last term is the part of K that the springs of dampers add. Damping
 * ratios zeta_k of the modes phi_k of the reduced model add
 *
 *     A P W q',   W = sum_k 2 zeta_k omega_k phi_k phi_k'M_r.
 *
 * P = sum_k phi_k phi_k'M_r is the projector on the modes up to the highest
 * frequency of a column. Modes above that frequency are those of residual and
 * constraint columns, and are no modes of the body. A load that jumps excites
 * them, and without P their accelerations would dominate y.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"

#include <ritz/recover.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void ritz_recovery_rule_free(ritz_recovery_rule *rule)
{
    ritz_dense_free(&rule->C);
    ritz_dense_free(&rule->Cv);
    ritz_dense_free(&rule->Ca);
    ritz_dense_free(&rule->F);
}

void ritz_recoverer_free(ritz_recoverer *recoverer)
{
    RITZ_FREE_EACH(ritz_recovery_rule, recoverer->count, recoverer->rule);
    *recoverer = (ritz_recoverer){0};
}

/* Matrices of the head that are made of modes: W is {0} if there are no damping
   ratios, P is {0} if it is the identity. */
typedef struct reduced_modes {
    ritz_dense W, P;
} reduced_modes;

static void reduced_modes_free(reduced_modes *modes)
{
    ritz_dense_free(&modes->W);
    ritz_dense_free(&modes->P);
}

/* Highest frequency of a column; 0 if none is a mode. */
static double highest_hertz(const ritz_columns *columns)
{
    double most = 0.0;

    for (int64_t j = 0; j < columns->count; j++)
        if (columns->hertz[j] > most)
            most = columns->hertz[j];
    return most;
}

/* sum_k factor_k phi_k phi_k'M */
static ritz_status sum_modes(const ritz_pairs *pairs, const ritz_dense *MPhi,
                             const double *factor, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) scaled = {0};

    RITZ_CHECK(ritz_dense_copy(&pairs->Phi, &scaled));
    for (int64_t k = 0; k < scaled.ncol; k++)
        for (int64_t i = 0; i < scaled.nrow; i++)
            ritz_dense_col(&scaled, k)[i] *= factor[k];
    return ritz_dense_mul_nt(&scaled, MPhi, out);
}

static ritz_status find_modes(const ritz_reduced *reduced,
                              const ritz_damping *damping, reduced_modes *out)
{
    const double most = highest_hertz(&reduced->columns) * (1.0 + RITZ_SAME);
    const bool ratios = ritz_damping_has_ratios(damping);
    RITZ_OWN(ritz_structure) model = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) MPhi = {0};
    RITZ_OWN_ARRAY double *rate = NULL, *kept = NULL;

    if (!ratios && most == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_structure_of_reduced(reduced, &model));
    RITZ_CHECK(ritz_eigen_dense(&model.K, &model.M, &pairs));
    RITZ_CHECK(ritz_dense_mul(&model.M, &pairs.Phi, &MPhi));
    RITZ_CHECK_NEW(rate, pairs.Phi.ncol);
    RITZ_CHECK_NEW(kept, pairs.Phi.ncol);
    for (int64_t k = 0; k < pairs.Phi.ncol; k++) {
        double lambda = k < pairs.num_rigid ? 0.0 : pairs.lambda[k];

        kept[k] = ritz_eigen_hertz(lambda) <= most;
        if (lambda > 0.0)
            rate[k] = ritz_modal_rate(damping, k - pairs.num_rigid, lambda);
    }
    if (ratios)
        RITZ_CHECK(sum_modes(&pairs, &MPhi, rate, &out->W));
    return most > 0.0 ? sum_modes(&pairs, &MPhi, kept, &out->P) : RITZ_OK;
}

/* Make the matrix of velocities, zero so far, if a rule has none. */
static ritz_status need_rates(const ritz_quantity *q, ritz_recovery_rule *rule)
{
    return rule->Cv.val ? RITZ_OK
                        : ritz_dense_new(q->count, q->ST.ncol, &rule->Cv);
}

/* A += factor h b' */
static void add_product(double factor, const double *h, const double *b,
                        ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol && factor != 0.0; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] += factor * h[i] * b[j];
}

/* Forces of the dampers. What K and D of the component already hold of them is
   subtracted from c and k. Damping a M + b K also acts on their springs, which
   are a part of K. */
static ritz_status add_dampers(const ritz_dampers *dampers,
                               const ritz_damping *damping,
                               const ritz_quantity *q, ritz_recovery_rule *rule)
{
    const double part = ritz_damping_is_rayleigh(damping) ? damping->b : 0.0;

    if (dampers->count > 0)
        RITZ_CHECK(need_rates(q, rule));
    for (int64_t j = 0; j < dampers->count; j++) {
        const double *h = ritz_dense_col(&q->H, j);
        const double *b = ritz_dense_col(&dampers->B, j);

        const double c = dampers->c[j] - dampers->held_c[j];
        const double k = dampers->k[j] - dampers->held_k[j];

        add_product(-c - part * k, h, b, &rule->Cv);
        add_product(-k, h, b, &rule->C);
    }
    return RITZ_OK;
}

/* Forces of stated damping; rule->Ca already holds A P. */
static ritz_status add_damping(const ritz_damping *damping, const ritz_dense *W,
                               const ritz_quantity *q, ritz_recovery_rule *rule)
{
    RITZ_OWN(ritz_dense) part = {0};

    if (!W->val && !ritz_damping_is_rayleigh(damping))
        return RITZ_OK;
    RITZ_CHECK(need_rates(q, rule));
    if (W->val) {
        RITZ_CHECK(ritz_dense_mul(&rule->Ca, W, &part));
        ritz_dense_add(1.0, &part, &rule->Cv);
        return RITZ_OK;
    }
    ritz_dense_add(damping->a, &rule->Ca, &rule->Cv);
    ritz_dense_add(damping->b, &q->Q, &rule->Cv);
    ritz_dense_add(-damping->b, &q->ST, &rule->Cv);
    return RITZ_OK;
}

static ritz_status make_rule(const ritz_reduced *reduced,
                             const ritz_damping *damping,
                             const reduced_modes *modes, const ritz_quantity *q,
                             ritz_recovery_rule *out)
{
    if (!out->acceleration) {
        bool of_a = strcmp(q->kind, "acceleration") == 0;

        return ritz_dense_copy(&q->ST, of_a ? &out->Ca : &out->C);
    }
    RITZ_CHECK(ritz_dense_copy(&q->Q, &out->C));
    RITZ_CHECK(modes->P.val ? ritz_dense_mul(&q->A, &modes->P, &out->Ca)
                            : ritz_dense_copy(&q->A, &out->Ca));
    if (q->V.val)
        RITZ_CHECK(ritz_dense_copy(&q->V, &out->Cv));
    if (q->F.val)
        RITZ_CHECK(ritz_dense_copy(&q->F, &out->F));
    RITZ_CHECK(add_dampers(&reduced->dampers, damping, q, out));
    return add_damping(damping, &modes->W, q, out);
}

ritz_status ritz_recoverer_new(const ritz_reduced *reduced,
                               const ritz_damping *damping, bool acceleration,
                               ritz_recoverer *out)
{
    const ritz_damping none = {0};
    RITZ_OWN(ritz_recoverer)
    made = {.reduced = reduced, .count = reduced->num_quantities};
    RITZ_OWN(reduced_modes) modes = {0};
    int64_t corrected = 0;

    damping = damping ? damping : &none;
    RITZ_CHECK_NEW(made.rule, made.count);
    for (int64_t k = 0; k < made.count; k++) {
        made.rule[k].acceleration = acceleration && reduced->quantity[k].Q.val;
        corrected += made.rule[k].acceleration;
    }
    RITZ_REFUSE_IF(acceleration && corrected == 0, RITZ_ERR_ARGUMENT,
                   "no quantity has mode acceleration: ritz-reduce --recovery "
                   "acceleration makes it");
    if (corrected > 0)
        RITZ_CHECK(find_modes(reduced, damping, &modes));
    for (int64_t k = 0; k < made.count; k++)
        RITZ_CHECK_IN(reduced->quantity[k].name,
                      make_rule(reduced, damping, &modes, &reduced->quantity[k],
                                &made.rule[k]));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_recoverer_check(const ritz_recoverer *recoverer,
                                 const ritz_instant *now)
{
    for (int64_t k = 0; k < recoverer->count; k++) {
        const ritz_recovery_rule *rule = &recoverer->rule[k];
        const char *lacks = rule->Cv.val && !now->v   ? "velocities"
                            : rule->Ca.val && !now->a ? "accelerations"
                            : rule->F.val && !now->f  ? "inputs"
                                                      : NULL;

        RITZ_REFUSE_IF(lacks, RITZ_ERR_ARGUMENT,
                       "the history has no %s, which '%s' needs%s", lacks,
                       recoverer->reduced->quantity[k].name,
                       rule->acceleration
                           ? " for mode acceleration: --modes displacement "
                             "takes none"
                           : "");
    }
    return RITZ_OK;
}

/* y += A x */
static void add_rows(const ritz_dense *A, const double *x, double *y)
{
    for (int64_t j = 0; A->val && j < A->ncol; j++) {
        const double *column = ritz_dense_col(A, j);

        for (int64_t i = 0; i < A->nrow; i++)
            y[i] += column[i] * x[j];
    }
}

void ritz_recoverer_rows(const ritz_recoverer *recoverer, int64_t k,
                         const ritz_instant *now, double *y)
{
    const ritz_recovery_rule *rule = &recoverer->rule[k];

    memset(y, 0, (size_t)recoverer->reduced->quantity[k].count * sizeof *y);
    add_rows(&rule->C, now->q, y);
    add_rows(&rule->Cv, now->v, y);
    add_rows(&rule->Ca, now->a, y);
    add_rows(&rule->F, now->f, y);
}

/* ---- peaks -------------------------------------------------------------- */

static ritz_status new_peaks(const ritz_quantity *q, bool acceleration,
                             ritz_peaks *out)
{
    memcpy(out->name, q->name, sizeof out->name);
    memcpy(out->kind, q->kind, sizeof out->kind);
    snprintf(out->by, sizeof out->by, "mode %s",
             acceleration ? "acceleration" : "displacement");
    out->count = q->count;
    RITZ_CHECK_COPY(out->place, q->place, q->count);
    RITZ_CHECK_COPY(out->part, q->part, q->count);
    RITZ_CHECK_NEW(out->value, q->count);
    RITZ_CHECK_NEW(out->seconds, q->count);
    return RITZ_OK;
}

ritz_status ritz_recovered_new(const ritz_recoverer *recoverer,
                               ritz_recovered *out)
{
    const ritz_reduced *reduced = recoverer->reduced;
    RITZ_OWN(ritz_recovered) made = {0};

    memcpy(made.units, reduced->units, sizeof made.units);
    RITZ_CHECK_NEW(made.quantity, recoverer->count);
    for (int64_t k = 0; k < recoverer->count; k++) {
        made.num_quantities++;
        RITZ_CHECK(new_peaks(&reduced->quantity[k],
                             recoverer->rule[k].acceleration,
                             &made.quantity[k]));
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_recovered_note(int64_t k, double seconds, const double *y,
                                ritz_recovered *recovered)
{
    ritz_peaks *p = &recovered->quantity[k];

    for (int64_t i = 0; i < p->count; i++) {
        char name[RITZ_QUANTITY_NAME_SIZE];

        RITZ_REFUSE_IF(!isfinite(y[i]), RITZ_ERR_CONVERGENCE,
                       "'%s' of '%s' is not finite at %g s",
                       ritz_peaks_name(p, i, name), p->name, seconds);
        if (recovered->count > 0 && !(fabs(y[i]) > fabs(p->value[i])))
            continue;
        p->value[i] = y[i];
        p->seconds[i] = seconds;
    }
    return RITZ_OK;
}

void ritz_recovered_step(double seconds, ritz_recovered *recovered)
{
    if (recovered->count++ == 0)
        recovered->begin = seconds;
    recovered->end = seconds;
}

const char *ritz_peaks_name(const ritz_peaks *peaks, int64_t row,
                            char text[RITZ_QUANTITY_NAME_SIZE])
{
    ritz_quantity as = {.place = peaks->place, .part = peaks->part};

    memcpy(as.kind, peaks->kind, sizeof as.kind);
    return ritz_quantity_name(&as, row, text);
}
