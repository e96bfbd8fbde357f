/* Less than half of a mode is not that mode. */
#include "verify/match.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>

/* No partner for any mode, and no MAC. */
static ritz_status ritz_match_new(const ritz_poles *full,
                                  const ritz_poles *reduced, ritz_match *out)
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
static double share(const ritz_dense *Q, int64_t first, int64_t last, int64_t r)
{
    double sum = 0.0;

    for (int64_t k = first; k < last; k++)
        sum += ritz_dense_col(Q, r)[k] * ritz_dense_col(Q, r)[k];
    return sum;
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
static int64_t choose(const ritz_dense *Q, const ritz_poles *reduced,
                      const bool *taken, const int64_t range[2], double *best)
{
    int64_t chosen = -1;

    *best = 0.0;
    for (int64_t r = reduced->num_rigid; r < reduced->count; r++) {
        double part = taken[r] ? 0.0 : share(Q, range[0], range[1], r);

        if (part > *best) {
            *best = part;
            chosen = r;
        }
    }
    return *best >= RITZ_SAME_MODE ? chosen : -1;
}

static int ascending(const void *left, const void *right)
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
        int64_t r = choose(Q, reduced, match->taken, range, &best);

        if (r < 0)
            break;
        match->partner[found++] = r;
        match->taken[r] = true;
    }
    qsort(match->partner + first, (size_t)(found - first),
          sizeof *match->partner, ascending);
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

    RITZ_CHECK(ritz_match_new(full, reduced, &match));
    for (int64_t first = full->num_rigid; first < full->count; first = last) {
        last = first + 1;
        while (last < full->count &&
               sqrt(full->lambda[last]) * (1.0 - RITZ_CLOSE) <=
                   sqrt(full->lambda[last - 1]))
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

/* Of a mode that is not seen nothing tells but its frequency. */
static double pair_cost(const ritz_seen *seen, const ritz_poles *full,
                        int64_t k, const ritz_poles *reduced, int64_t r)
{
    double apart = fabs(log(reduced->lambda[r] / full->lambda[k])) / 2.0;

    if (!seen->mode[k])
        return apart;
    return apart +
           RITZ_UNLIKE_COST * (1.0 - ritz_seen_mac(seen, full, k, reduced, r));
}

static ritz_status pairing_new(const ritz_seen *seen, const ritz_poles *full,
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
            p->cost[k * p->n + r] = pair_cost(seen, full, full->num_rigid + k,
                                              reduced, reduced->num_rigid + r);
    for (int64_t k = 0; k < p->m; k++)
        p->of[k] = -1;
    for (int64_t r = 0; r < p->n; r++)
        p->by[r] = -1;
    return RITZ_OK;
}

/*
 * total(k, r) of aligning the first k and r modes, by the recurrence of edit
 * distance; then back along what was cheapest.
 */
static void align(pairing *p)
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

/* Of mode k with that partner, which may be none; so far and no further. */
static double cost_of(const pairing *p, int64_t k, int64_t r)
{
    double cost = RITZ_SKIP_COST;

    if (k >= 0 && r >= 0)
        cost = p->cost[k * p->n + r];
    else if (k < 0 && r < 0)
        cost = 0.0;
    return cost <= 2.0 * RITZ_SKIP_COST ? cost : HUGE_VAL;
}

/* Give mode k partner r, and who had r what k had, if that costs less. */
static bool exchange(pairing *p, int64_t k, int64_t r)
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

/* Each exchange lowers the sum, so that there is an end. */
static void untangle(pairing *p)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (int64_t k = 0; k < p->m; k++)
            for (int64_t r = 0; r < p->n; r++)
                changed = exchange(p, k, r) || changed;
    }
}

/* Whether a neighbour is so close that vectors are any mixture of both. */
static bool in_cluster(const ritz_poles *full, int64_t k)
{
    double w = sqrt(full->lambda[k]);

    return (k > 0 && w - sqrt(full->lambda[k - 1]) <= RITZ_CLOSE * w) ||
           (k + 1 < full->count &&
            sqrt(full->lambda[k + 1]) - w <= RITZ_CLOSE * w);
}

/* Nothing is like a mode that is seen and has no partner. */
static void take(const pairing *p, const ritz_seen *seen,
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
        if (seen->mode[k] && !in_cluster(full, k))
            match->mac[k] =
                p->of[j] < 0 ? 0.0 : ritz_seen_mac(seen, full, k, reduced, r);
    }
}

ritz_status ritz_match_outputs(const ritz_poles *full,
                               const ritz_poles *reduced, const ritz_seen *seen,
                               ritz_match *out)
{
    RITZ_OWN(ritz_match) match = {0};
    RITZ_OWN(pairing) p = {0};

    RITZ_CHECK(ritz_match_new(full, reduced, &match));
    RITZ_CHECK(pairing_new(seen, full, reduced, &p));
    align(&p);
    untangle(&p);
    take(&p, seen, full, reduced, &match);
    RITZ_MOVE(*out, match);
    return RITZ_OK;
}
