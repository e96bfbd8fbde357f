/*
 * Which mode of a reduced model corresponds to which of the full one: the one
 * that holds most of its shape, half at least, or, without shapes, by alignment.
 */
#include "verify/match.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* No partner for any mode, and no MAC. */
static ritz_status match_none(const ritz_poles *full, const ritz_poles *reduced,
                              ritz_match *out)
{
    out->count = full->count;
    out->num_reduced = reduced->count;
    RITZ_CHECK_NEW(out->partner, full->count);
    RITZ_CHECK_NEW(out->mac, full->count);
    RITZ_CHECK_NEW(out->taken, reduced->count);
    for (int64_t k = 0; k < full->count; k++) {
        out->partner[k] = -1;
        out->mac[k] = nan("");
    }
    return RITZ_OK;
}

/* How much of the space of modes first .. last - 1 reduced mode r holds. */
static double sum_squares(const ritz_dense *Q, int64_t first, int64_t last,
                          int64_t r)
{
    double sum = 0.0;

    for (int64_t k = first; k < last; k++)
        sum += ritz_dense_col(Q, r)[k] * ritz_dense_col(Q, r)[k];
    return sum;
}

/* Whether mode k and the next are so close that vectors may be any mixture. */
static bool is_close(const ritz_poles *full, int64_t k)
{
    return sqrt(full->lambda[k + 1]) * (1.0 - RITZ_CLOSE) <=
           sqrt(full->lambda[k]);
}

/* Least singular value of a cluster's block of Q, squared. */
static ritz_status subspace_mac(const ritz_dense *Q, int64_t first,
                                int64_t last, const int64_t *partner,
                                double *out)
{
    int64_t s = last - first;
    RITZ_OWN(ritz_dense) block = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK(ritz_dense_new(s, s, &block));
    RITZ_CHECK_NEW(sigma, s);
    for (int64_t j = 0; j < s; j++)
        for (int64_t i = 0; i < s; i++)
            ritz_dense_col(&block, j)[i] =
                ritz_dense_col(Q, partner[first + j])[first + i];
    RITZ_CHECK_IN("shapes of a cluster", ritz_general_singular(&block, sigma));
    *out = sigma[s - 1] * sigma[s - 1];
    return RITZ_OK;
}

/* The best free reduced mode for a cluster, -1 if none has half of it. */
static int64_t choose_mode(const ritz_dense *Q, const ritz_poles *reduced,
                           const bool *taken, const int64_t range[2],
                           double *best)
{
    int64_t chosen = -1;

    *best = 0.0;
    for (int64_t r = reduced->num_rigid; r < reduced->count; r++) {
        double part = taken[r] ? 0.0 : sum_squares(Q, range[0], range[1], r);

        if (part > *best) {
            *best = part;
            chosen = r;
        }
    }
    return *best >= RITZ_SAME_MODE ? chosen : -1;
}

static int compare_numbers(const void *left, const void *right)
{
    int64_t a = *(const int64_t *)left;
    int64_t b = *(const int64_t *)right;

    return (a > b) - (a < b);
}

static ritz_status match_cluster(const ritz_dense *Q, const ritz_poles *reduced,
                                 int64_t first, int64_t last, ritz_match *match)
{
    const int64_t range[2] = {first, last};
    int64_t found = first;
    double best = 1.0;

    while (found < last) {
        int64_t r = choose_mode(Q, reduced, match->taken, range, &best);

        if (r < 0)
            break;
        match->partner[found++] = r;
        match->taken[r] = true;
    }
    qsort(match->partner + first, (size_t)(found - first),
          sizeof *match->partner, compare_numbers);
    if (found == last)
        RITZ_CHECK(subspace_mac(Q, first, last, match->partner, &best));
    for (int64_t k = first; k < last; k++)
        match->mac[k] = fmin(best, 1.0);
    return RITZ_OK;
}

ritz_status ritz_match_shapes(const ritz_poles *full, const ritz_poles *reduced,
                              const ritz_dense *Q, ritz_match *out)
{
    RITZ_OWN(ritz_match) match = {0};
    int64_t last = 0;

    RITZ_CHECK(match_none(full, reduced, &match));
    for (int64_t first = full->num_rigid; first < full->count; first = last) {
        last = first + 1;
        while (last < full->count && is_close(full, last - 1))
            last++;
        RITZ_CHECK(match_cluster(Q, reduced, first, last, &match));
    }
    RITZ_MOVE(*out, match);
    return RITZ_OK;
}

void ritz_match_free(ritz_match *match)
{
    free(match->partner);
    free(match->mac);
    free(match->taken);
    *match = (ritz_match){0};
}

/*
 * Modes of two models without common coordinates. Two lists that ascend are
 * aligned; then partners are exchanged where that costs less, since modes of
 * different kinds, bending and stretching, pass each other as a model changes.
 */

/* Flexible modes of both, and what it costs to pair them. */
typedef struct pairing {
    int64_t m, n;  /* of the full model, of the reduced one */
    double *cost;  /* m x n, row by row */
    double *total; /* (m + 1) x (n + 1), of aligning the first ones */
    int64_t *of;   /* m, partner; -1: none */
    int64_t *by;   /* n, whose partner; -1: nobody's */
} pairing;

static void pairing_free(pairing *p)
{
    free(p->cost);
    free(p->total);
    free(p->of);
    free(p->by);
}

/* A mode that is not observable is known by its frequency alone. */
static double pair_cost(const ritz_participation *part, const ritz_poles *full,
                        int64_t k, const ritz_poles *reduced, int64_t r)
{
    double apart = fabs(log(reduced->lambda[r] / full->lambda[k])) / 2.0;

    if (!part->observable[k])
        return apart;
    return apart + RITZ_UNLIKE_COST * (1.0 - ritz_participation_mac(
                                                 part, full, k, reduced, r));
}

static ritz_status pairing_new(const ritz_participation *part,
                               const ritz_poles *full,
                               const ritz_poles *reduced, pairing *p)
{
    p->m = full->count - full->num_rigid;
    p->n = reduced->count - reduced->num_rigid;
    RITZ_CHECK_NEW(p->cost, p->m * p->n);
    RITZ_CHECK_NEW(p->total, (p->m + 1) * (p->n + 1));
    RITZ_CHECK_NEW(p->of, p->m);
    RITZ_CHECK_NEW(p->by, p->n);
    for (int64_t k = 0; k < p->m; k++)
        for (int64_t r = 0; r < p->n; r++)
            p->cost[k * p->n + r] = pair_cost(part, full, full->num_rigid + k,
                                              reduced, reduced->num_rigid + r);
    memset(p->of, -1, (size_t)p->m * sizeof *p->of);
    memset(p->by, -1, (size_t)p->n * sizeof *p->by);
    return RITZ_OK;
}

/*
 * total(k, r) of aligning the first k and r modes, by the recurrence of edit
 * distance; then back along what was cheapest.
 */
static void align_modes(pairing *p)
{
    int64_t n = p->n;

    for (int64_t k = 0; k <= p->m; k++)
        for (int64_t r = 0; r <= n; r++) {
            double *c = &p->total[k * (n + 1) + r];

            *c = k == 0 && r == 0 ? 0.0 : HUGE_VAL;
            if (k > 0)
                *c = fmin(*c, c[-(n + 1)] + RITZ_SKIP_COST);
            if (r > 0)
                *c = fmin(*c, c[-1] + RITZ_SKIP_COST);
            if (k > 0 && r > 0)
                *c = fmin(*c, c[-(n + 2)] + p->cost[(k - 1) * n + r - 1]);
        }
    for (int64_t k = p->m, r = n; k > 0 && r > 0;) {
        const double *c = &p->total[k * (n + 1) + r];

        if (*c == c[-(n + 1)] + RITZ_SKIP_COST) {
            k--;
        } else if (*c == c[-1] + RITZ_SKIP_COST) {
            r--;
        } else {
            k--;
            r--;
            p->of[k] = r;
            p->by[r] = k;
        }
    }
}

/* Cost of mode k with partner r, each of which may be none; infinite where two
   unpaired modes would cost less. */
static double cost_of(const pairing *p, int64_t k, int64_t r)
{
    double cost = RITZ_SKIP_COST;

    if (k >= 0 && r >= 0)
        cost = p->cost[k * p->n + r];
    else if (k < 0 && r < 0)
        cost = 0.0;
    return cost <= 2.0 * RITZ_SKIP_COST ? cost : HUGE_VAL;
}

/* Give mode k partner r, and the former owner of r that of k, if that costs
   less. */
static bool exchange_partners(pairing *p, int64_t k, int64_t r)
{
    int64_t old = p->of[k];
    int64_t other = p->by[r];
    double before = cost_of(p, k, old) + cost_of(p, other, r);
    double after = cost_of(p, k, r) + cost_of(p, other, old);

    if (old == r || !(after < before - RITZ_EXCHANGE_GAIN))
        return false;
    p->of[k] = r;
    p->by[r] = k;
    if (other >= 0)
        p->of[other] = old;
    if (old >= 0)
        p->by[old] = other;
    return true;
}

/* Until no exchange lowers the sum of costs. */
static void exchange_all(pairing *p)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (int64_t k = 0; k < p->m; k++)
            for (int64_t r = 0; r < p->n; r++)
                changed = exchange_partners(p, k, r) || changed;
    }
}

/* The MAC of an observable mode without partner is 0. */
static void take_partners(const pairing *p, const ritz_participation *part,
                          const ritz_poles *full, const ritz_poles *reduced,
                          ritz_match *match)
{
    for (int64_t j = 0; j < p->m; j++) {
        int64_t k = full->num_rigid + j;
        int64_t r = reduced->num_rigid + p->of[j];

        if (p->of[j] >= 0) {
            match->partner[k] = r;
            match->taken[r] = true;
        }
        if (part->observable[k] && !(k > 0 && is_close(full, k - 1)) &&
            !(k + 1 < full->count && is_close(full, k)))
            match->mac[k] = p->of[j] < 0 ? 0.0
                                         : ritz_participation_mac(part, full, k,
                                                                  reduced, r);
    }
}

ritz_status ritz_match_outputs(const ritz_poles *full,
                               const ritz_poles *reduced,
                               const ritz_participation *part, ritz_match *out)
{
    RITZ_OWN(ritz_match) match = {0};
    RITZ_OWN(pairing) p = {0};

    RITZ_CHECK(match_none(full, reduced, &match));
    RITZ_CHECK(pairing_new(part, full, reduced, &p));
    align_modes(&p);
    exchange_all(&p);
    take_partners(&p, part, full, reduced, &match);
    RITZ_MOVE(*out, match);
    return RITZ_OK;
}
