#include "verify/match.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>

/* Less than half of a mode is not that mode. */
static const double partner_above = 0.5;

ritz_status ritz_match_new(const ritz_poles *full, const ritz_poles *reduced,
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
    ritz_status status = RITZ_OK;
    ritz_match match = {0};
    int64_t last = 0;

    RITZ_TRY(ritz_match_new(full, reduced, &match));
    for (int64_t first = full->num_rigid; first < full->count; first = last) {
        last = first + 1;
        while (last < full->count &&
               sqrt(full->lambda[last]) * (1.0 - RITZ_CLOSE) <=
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

void ritz_match_free(ritz_match *match)
{
    free(match->partner);
    free(match->mac);
    free(match->taken);
    *match = (ritz_match){0};
}
