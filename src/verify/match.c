/*
 * Which mode of a reduced model corresponds to which of the full one: the one
 * that holds most of its shape, half at least, or, without shapes, by
 * alignment.
 */
#include "verify/match.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = 3 }; /* C, Cv and Ca */

static int64_t count_channels(const ritz_io *io)
{
    return io->num_inputs + KINDS * io->num_outputs;
}

/* Column j of B from its row k, or row i of C, Cv or Ca from its column k. */
static const double *find_channel(const ritz_io *io, int64_t c, int64_t k,
                                  int64_t *stride)
{
    const ritz_dense *const of[KINDS] = {&io->C, &io->Cv, &io->Ca};
    int64_t row = c - io->num_inputs, p = io->num_outputs;

    *stride = row < 0 ? 1 : p;
    return row < 0 ? ritz_dense_col(&io->B, c) + k
                   : ritz_dense_col(of[row / p], k) + row % p;
}

/* Participation of mode k in channel c, scaled. */
static double participation_of(const ritz_participation *part,
                               const ritz_poles *poles, int64_t c, int64_t k)
{
    int64_t stride = 0;

    return part->scale[c] * *find_channel(&poles->io, c, k, &stride);
}

bool ritz_in_band(const double band_hz[2], double lambda)
{
    double hertz = ritz_eigen_hertz(lambda);

    return hertz >= band_hz[0] * (1.0 - RITZ_SAME) &&
           hertz <= band_hz[1] * (1.0 + RITZ_SAME);
}

/* Inputs, or outputs, of both have the same names. */
static ritz_status check_names(const char *what, int64_t full, int64_t reduced,
                               const char (*of_full)[RITZ_NAME_SIZE],
                               const char (*of_reduced)[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(full != reduced, RITZ_ERR_ARGUMENT,
                   "the models differ in %ss: %" PRId64 " and %" PRId64, what,
                   full, reduced);
    for (int64_t k = 0; k < full; k++)
        RITZ_REFUSE_IF(strcmp(of_full[k], of_reduced[k]) != 0,
                       RITZ_ERR_ARGUMENT,
                       "%s %" PRId64 " is '%s' in the full model and '%s' in "
                       "the reduced one",
                       what, k + 1, of_full[k], of_reduced[k]);
    return RITZ_OK;
}

ritz_status ritz_verify_signals(const ritz_io *full, const ritz_io *reduced)
{
    RITZ_CHECK(check_names("input", full->num_inputs, reduced->num_inputs,
                           full->input, reduced->input));
    return check_names("output", full->num_outputs, reduced->num_outputs,
                       full->output, reduced->output);
}

ritz_status ritz_verify_band(const double band_hz[2], bool may_be_zero)
{
    const bool zero = may_be_zero && band_hz[1] == 0.0;

    RITZ_REFUSE_IF(!(band_hz[0] >= 0.0) || !isfinite(band_hz[1]) ||
                       (!zero && !(band_hz[0] < band_hz[1])),
                   RITZ_ERR_ARGUMENT,
                   "a band from %g to %g Hz is not a band of frequencies",
                   band_hz[0], band_hz[1]);
    return RITZ_OK;
}

static double norm_of(int64_t n, const double *x, int64_t stride)
{
    double size = 0.0;

    for (int64_t k = 0; k < n; k++)
        size = hypot(size, x[k * stride]);
    return size;
}

/* Whether mode k is flexible and in the band. */
static bool is_compared(const ritz_poles *poles, const double band_hz[2],
                        int64_t k)
{
    return k >= poles->num_rigid && ritz_in_band(band_hz, poles->lambda[k]);
}

static void take_scales(const ritz_component *component,
                        const ritz_pairs *pairs, const ritz_poles *poles,
                        const double band_hz[2], ritz_participation *part)
{
    int64_t n = component->num_dofs, stride = 0;
    double shape = 0.0;

    for (int64_t k = 0; k < part->num_modes; k++)
        if (is_compared(poles, band_hz, k))
            shape = fmax(shape, norm_of(n, ritz_dense_col(&pairs->Phi, k), 1));
    for (int64_t c = 0; c < count_channels(&poles->io); c++) {
        const double *row = NULL;
        double largest = 0.0, size = 0.0;

        for (int64_t k = 0; k < part->num_modes; k++)
            if (is_compared(poles, band_hz, k))
                largest = fmax(largest,
                               fabs(*find_channel(&poles->io, c, k, &stride)));
        row = find_channel(&component->io, c, 0, &stride);
        size = shape * norm_of(n, row, stride);
        if (largest > RITZ_PARTICIPATION_ROUNDING * size)
            part->scale[c] = 1.0 / largest;
    }
}

/* p of mode k: of input j and output i or, where one of them is negative as
   there is none, of the other. */
static double product_of(const ritz_participation *part,
                         const ritz_poles *poles, int64_t j, int64_t i,
                         int64_t k)
{
    double in = j < 0 ? 1.0 : participation_of(part, poles, j, k);
    double out =
        i < 0 ? 1.0 : participation_of(part, poles, part->num_inputs + i, k);

    return fabs(in * out);
}

/* Whether mode k is negligible in a transfer function because of mode m. */
static bool is_negligible(const ritz_poles *poles, int64_t m, double p_m,
                          int64_t k, double p_k)
{
    double stiffer = poles->lambda[m] / poles->lambda[k];
    double ratio_m = fabs(poles->rate[m]) / sqrt(poles->lambda[m]);
    double ratio_k = fabs(poles->rate[k]) / sqrt(poles->lambda[k]);

    /* zeta_m / zeta_k: both may be 0 */
    return p_k * fmax(1.0, stiffer) * fmax(ratio_k, ratio_m) <=
               RITZ_AUDIBLE * p_m * ratio_k &&
           p_k * fmax(1.0, stiffer) <= RITZ_AUDIBLE * p_m;
}

static bool is_observable_in(const ritz_participation *part,
                             const ritz_poles *poles, const double band_hz[2],
                             int64_t j, int64_t i, int64_t k)
{
    double p_k = product_of(part, poles, j, i, k);

    if (p_k <= RITZ_PARTICIPATION_ROUNDING)
        return false;
    for (int64_t m = 0; m < part->num_modes; m++)
        if (is_compared(poles, band_hz, m) &&
            is_negligible(poles, m, product_of(part, poles, j, i, m), k, p_k))
            return false;
    return true;
}

static bool is_observable(const ritz_participation *part,
                          const ritz_poles *poles, const double band_hz[2],
                          int64_t k)
{
    int64_t columns = part->num_inputs, rows = KINDS * part->num_outputs;

    for (int64_t j = columns > 0 ? 0 : -1; j < columns; j++)
        for (int64_t i = rows > 0 ? 0 : -1; i < rows; i++)
            if (is_observable_in(part, poles, band_hz, j, i, k))
                return true;
    return false;
}

ritz_status ritz_participation_new(const ritz_component *component,
                                   const ritz_pairs *pairs,
                                   const ritz_poles *poles,
                                   const double band_hz[2],
                                   ritz_participation *out)
{
    RITZ_OWN(ritz_participation)
    part = {.num_modes = poles->count,
            .num_inputs = poles->io.num_inputs,
            .num_outputs = poles->io.num_outputs};

    RITZ_CHECK_NEW(part.scale, count_channels(&poles->io));
    RITZ_CHECK_NEW(part.observable, part.num_modes);
    take_scales(component, pairs, poles, band_hz, &part);
    if (count_channels(&poles->io) > 0)
        for (int64_t k = poles->num_rigid; k < part.num_modes; k++)
            part.observable[k] = is_observable(&part, poles, band_hz, k);
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

double ritz_participation_mac(const ritz_participation *part,
                              const ritz_poles *full, int64_t k,
                              const ritz_poles *reduced, int64_t r)
{
    double fr = 0.0, ff = 0.0, rr = 0.0;

    for (int64_t c = 0; c < count_channels(&full->io); c++) {
        double a = participation_of(part, full, c, k);
        double b = participation_of(part, reduced, c, r);

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    if (ff > 0.0 && rr > 0.0)
        return fr * fr / (ff * rr);
    return ff > 0.0 ? 0.0 : nan("");
}

void ritz_participation_free(ritz_participation *part)
{
    RITZ_FREE(part->scale, part->observable);
    *part = (ritz_participation){0};
}

/* Partners by shapes. */

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
    RITZ_FREE(match->partner, match->mac, match->taken);
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
    RITZ_FREE(p->cost, p->total, p->of, p->by);
}

/* A mode that is not observable is known by its frequency alone. */
static double pair_cost(const ritz_participation *part, const ritz_poles *full,
                        int64_t k, const ritz_poles *reduced, int64_t r)
{
    double ratio = fabs(log(reduced->lambda[r] / full->lambda[k])) / 2.0;

    if (!part->observable[k])
        return ratio;
    return ratio + RITZ_UNLIKE_COST * (1.0 - ritz_participation_mac(
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
