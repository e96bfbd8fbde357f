#include "verify/match.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>

/* Reduction turns vectors within modes that lie closer than its own error. */
static const double near = 1e-3;
/* Less than half of a mode is not that mode. */
static const double partner_above = 0.5;
/* Leaving out a mode costs as much as frequencies 15 % apart do: with two left
   out, modes pair up to 30 %. Unlike outputs cost a third of that. */
static const double skip_cost = 0.15;
static const double unlike_cost = 0.1;

static ritz_status match_new(const ritz_poles *full, const ritz_poles *reduced,
                             ritz_match *out)
{
    ritz_status status = RITZ_OK;

    out->count = full->count;
    out->num_reduced = reduced->count;
    RITZ_NEW(out->partner, full->count);
    RITZ_NEW(out->mac, full->count);
    RITZ_NEW(out->taken, reduced->count);
    for (int64_t k = 0; k < full->count; k++) {
        out->partner[k] = -1;
        out->mac[k] = nan("");
    }
done:
    return status;
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
    ritz_status status = RITZ_OK;
    int64_t s = last - first;
    ritz_dense block = {0};
    double *sigma = NULL;

    RITZ_TRY(ritz_dense_new(s, s, &block));
    RITZ_NEW(sigma, s);
    for (int64_t j = 0; j < s; j++)
        for (int64_t i = 0; i < s; i++)
            ritz_dense_col(&block, j)[i] =
                ritz_dense_col(Q, partner[first + j])[first + i];
    RITZ_TRY_IN("shapes of a cluster", ritz_general_singular(&block, sigma));
    *out = sigma[s - 1] * sigma[s - 1];
done:
    ritz_dense_free(&block);
    free(sigma);
    return status;
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
    return *best >= partner_above ? chosen : -1;
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
    ritz_status status = RITZ_OK;
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
        RITZ_TRY(subspace_mac(Q, first, last, match->partner, &best));
    for (int64_t k = first; k < last; k++)
        match->mac[k] = fmin(best, 1.0);
done:
    return status;
}

ritz_status ritz_match_shapes(const ritz_poles *full, const ritz_poles *reduced,
                              const ritz_dense *Q, ritz_match *out)
{
    ritz_status status = RITZ_OK;
    ritz_match match = {0};
    int64_t last = 0;

    RITZ_TRY(match_new(full, reduced, &match));
    for (int64_t first = full->num_rigid; first < full->count; first = last) {
        last = first + 1;
        while (last < full->count && sqrt(full->lambda[last]) * (1.0 - near) <=
                                         sqrt(full->lambda[last - 1]))
            last++;
        RITZ_TRY(match_cluster(Q, reduced, first, last, &match));
    }
    *out = match;
    match = (ritz_match){0};
done:
    ritz_match_free(&match);
    return status;
}

/* MAC of what inputs drive and outputs see of mode k and mode r. */
static double seen_mac(const ritz_poles *full, int64_t k,
                       const ritz_poles *reduced, int64_t r)
{
    double fr = 0.0;
    double ff = 0.0;
    double rr = 0.0;
    const ritz_io *f = &full->io;
    const ritz_io *g = &reduced->io;
    const ritz_dense *const pair[3][2] = {
        {&f->C, &g->C}, {&f->Cv, &g->Cv}, {&f->Ca, &g->Ca}};

    for (int64_t j = 0; j < f->num_inputs; j++) {
        double a = ritz_dense_col(&f->B, j)[k];
        double b = ritz_dense_col(&g->B, j)[r];

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    for (int t = 0; t < 3; t++)
        for (int64_t i = 0; i < f->num_outputs; i++) {
            double a = ritz_dense_col(pair[t][0], k)[i];
            double b = ritz_dense_col(pair[t][1], r)[i];

            fr += a * b;
            ff += a * a;
            rr += b * b;
        }
    return ff > 0.0 && rr > 0.0 ? fr * fr / (ff * rr) : nan("");
}

/* What it costs to call r the partner of k. */
static double pair_cost(const ritz_poles *full, int64_t k,
                        const ritz_poles *reduced, int64_t r)
{
    double mac = seen_mac(full, k, reduced, r);
    double apart = fabs(log(reduced->lambda[r] / full->lambda[k])) / 2.0;

    return apart + (isnan(mac) ? 0.0 : unlike_cost * (1.0 - mac));
}

/* Whether a neighbour is so close that vectors are any mixture of both. */
static bool in_cluster(const ritz_poles *full, int64_t k)
{
    double w = sqrt(full->lambda[k]);

    return (k > 0 && w - sqrt(full->lambda[k - 1]) <= near * w) ||
           (k + 1 < full->count && sqrt(full->lambda[k + 1]) - w <= near * w);
}

/*
 * cost(k, r) of aligning the first k full and r reduced flexible modes, by the
 * recurrence of edit distance; then back along what was cheapest.
 */
static void align(const ritz_poles *full, const ritz_poles *reduced,
                  double *cost, ritz_match *match)
{
    int64_t m = full->count - full->num_rigid;
    int64_t n = reduced->count - reduced->num_rigid;
    int64_t f = full->num_rigid - 1;
    int64_t g = reduced->num_rigid - 1;

    for (int64_t k = 0; k <= m; k++)
        for (int64_t r = 0; r <= n; r++) {
            double *c = &cost[k * (n + 1) + r];

            *c = k == 0 && r == 0 ? 0.0 : HUGE_VAL;
            if (k > 0)
                *c = fmin(*c, c[-(n + 1)] + skip_cost);
            if (r > 0)
                *c = fmin(*c, c[-1] + skip_cost);
            if (k > 0 && r > 0)
                *c = fmin(*c,
                          c[-(n + 2)] + pair_cost(full, f + k, reduced, g + r));
        }
    for (int64_t k = m, r = n; k > 0 && r > 0;) {
        const double *c = &cost[k * (n + 1) + r];

        if (*c == c[-(n + 1)] + skip_cost) {
            k--;
        } else if (*c == c[-1] + skip_cost) {
            r--;
        } else {
            match->partner[f + k] = g + r;
            if (!in_cluster(full, f + k))
                match->mac[f + k] = seen_mac(full, f + k, reduced, g + r);
            match->taken[g + r] = true;
            k--;
            r--;
        }
    }
}

ritz_status ritz_match_outputs(const ritz_poles *full,
                               const ritz_poles *reduced, ritz_match *out)
{
    ritz_status status = RITZ_OK;
    ritz_match match = {0};
    double *cost = NULL;

    RITZ_TRY(match_new(full, reduced, &match));
    RITZ_NEW(cost, (full->count + 1) * (reduced->count + 1));
    align(full, reduced, cost, &match);
    *out = match;
    match = (ritz_match){0};
done:
    ritz_match_free(&match);
    free(cost);
    return status;
}

void ritz_match_free(ritz_match *match)
{
    free(match->partner);
    free(match->mac);
    free(match->taken);
    *match = (ritz_match){0};
}
