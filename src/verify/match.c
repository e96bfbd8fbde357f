/*
 * Which mode of a reduced model corresponds to which of the full one: the one
 * that holds most of its shape, half at least, or, without shapes, by
 * alignment.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "verify/sides.h"

#include <inttypes.h>
#include <math.h>
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

ritz_status ritz_verify_signals(ritz_model full, ritz_model reduced)
{
    const ritz_io io = ritz_model_io(full), small = ritz_model_io(reduced);

    RITZ_CHECK(check_names("input", io.num_inputs, small.num_inputs, io.input,
                           small.input));
    return check_names("output", io.num_outputs, small.num_outputs, io.output,
                       small.output);
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
static bool is_compared(const ritz_reference *r, int64_t k)
{
    return k >= r->poles.num_rigid &&
           ritz_in_band(r->band_hz, r->poles.lambda[k]);
}

static void take_scales(ritz_reference *r)
{
    const ritz_poles *poles = &r->poles;
    int64_t n = r->component->num_dofs, stride = 0;
    double shape = 0.0;

    for (int64_t k = 0; k < poles->count; k++)
        if (is_compared(r, k))
            shape =
                fmax(shape, norm_of(n, ritz_dense_col(&r->pairs.Phi, k), 1));
    for (int64_t c = 0; c < count_channels(&poles->io); c++) {
        const double *row = NULL;
        double largest = 0.0, size = 0.0;

        for (int64_t k = 0; k < poles->count; k++)
            if (is_compared(r, k))
                largest = fmax(largest,
                               fabs(*find_channel(&poles->io, c, k, &stride)));
        row = find_channel(&r->component->io, c, 0, &stride);
        size = shape * norm_of(n, row, stride);
        if (largest > RITZ_PARTICIPATION_ROUNDING * size)
            r->part.scale[c] = 1.0 / largest;
    }
}

/* p of mode k: of input j and output i or, where one of them is negative as
   there is none, of the other. */
static double product_of(const ritz_reference *r, int64_t j, int64_t i,
                         int64_t k)
{
    int64_t inputs = r->poles.io.num_inputs;
    double in = j < 0 ? 1.0 : participation_of(&r->part, &r->poles, j, k);
    double out =
        i < 0 ? 1.0 : participation_of(&r->part, &r->poles, inputs + i, k);

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

static bool is_observable_in(const ritz_reference *r, int64_t j, int64_t i,
                             int64_t k)
{
    double p_k = product_of(r, j, i, k);

    if (p_k <= RITZ_PARTICIPATION_ROUNDING)
        return false;
    for (int64_t m = 0; m < r->poles.count; m++)
        if (is_compared(r, m) &&
            is_negligible(&r->poles, m, product_of(r, j, i, m), k, p_k))
            return false;
    return true;
}

static bool is_observable(const ritz_reference *r, int64_t k)
{
    const ritz_io *io = &r->poles.io;
    int64_t columns = io->num_inputs, rows = KINDS * io->num_outputs;

    for (int64_t j = columns > 0 ? 0 : -1; j < columns; j++)
        for (int64_t i = rows > 0 ? 0 : -1; i < rows; i++)
            if (is_observable_in(r, j, i, k))
                return true;
    return false;
}

ritz_status ritz_reference_observe(ritz_reference *r)
{
    int64_t channels = count_channels(&r->poles.io);

    RITZ_CHECK_NEW(r->part.scale, channels);
    RITZ_CHECK_NEW(r->part.observable, r->poles.count);
    take_scales(r);
    for (int64_t k = r->poles.num_rigid; k < r->poles.count && channels > 0;
         k++)
        r->part.observable[k] = is_observable(r, k);
    return RITZ_OK;
}

/*
 * Cosine squared of the angle between the participations of mode k of one model
 * and of mode r of another; NaN where mode k has none.
 */
static double compare_modes(const ritz_sides *sides, int64_t k, int64_t r)
{
    const ritz_reference *full = sides->full;
    double fr = 0.0, ff = 0.0, rr = 0.0;

    for (int64_t c = 0; c < count_channels(&full->poles.io); c++) {
        double a = participation_of(&full->part, &full->poles, c, k);
        double b = participation_of(&full->part, &sides->reduced, c, r);

        fr += a * b;
        ff += a * a;
        rr += b * b;
    }
    if (ff > 0.0 && rr > 0.0)
        return fr * fr / (ff * rr);
    return ff > 0.0 ? 0.0 : nan("");
}

/* Partners by shapes. */

/* No mode is paired, and there is no MAC. */
static ritz_status match_none(ritz_sides *sides)
{
    const int64_t count = sides->full->poles.count;
    ritz_match *match = &sides->match;

    RITZ_CHECK_NEW(match->partner, count);
    RITZ_CHECK_NEW(match->mac, count);
    RITZ_CHECK_NEW(match->taken, sides->reduced.count);
    for (int64_t k = 0; k < count; k++) {
        match->partner[k] = -1;
        match->mac[k] = nan("");
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

    if (s == 1) {
        *out = pow(ritz_dense_col(Q, partner[first])[first], 2.0);
        return RITZ_OK;
    }
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
static int64_t choose_mode(const ritz_sides *sides, const ritz_dense *Q,
                           int64_t first, int64_t last, double *best)
{
    const ritz_poles *reduced = &sides->reduced;
    int64_t chosen = -1;

    *best = 0.0;
    for (int64_t r = reduced->num_rigid; r < reduced->count; r++) {
        double part =
            sides->match.taken[r] ? 0.0 : sum_squares(Q, first, last, r);

        if (part > *best) {
            *best = part;
            chosen = r;
        }
    }
    return *best >= RITZ_SAME_MODE ? chosen : -1;
}

/* Its partners ascend. */
static ritz_status match_cluster(ritz_sides *sides, const ritz_dense *Q,
                                 int64_t first, int64_t last)
{
    int64_t *partner = sides->match.partner;
    int64_t found = first;
    double best = 1.0;

    while (found < last) {
        int64_t r = choose_mode(sides, Q, first, last, &best);
        int64_t at = found;

        if (r < 0)
            break;
        for (; at > first && partner[at - 1] > r; at--)
            partner[at] = partner[at - 1];
        partner[at] = r;
        sides->match.taken[r] = true;
        found++;
    }
    if (found == last)
        RITZ_CHECK(subspace_mac(Q, first, last, partner, &best));
    for (int64_t k = first; k < last; k++)
        sides->match.mac[k] = fmin(best, 1.0);
    return RITZ_OK;
}

ritz_status ritz_reference_parts(const ritz_reference *reference,
                                 const ritz_dense *T, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) MPhi = {0};

    RITZ_CHECK(ritz_sparse_mul(&reference->component->M, &reference->pairs.Phi,
                               &MPhi));
    return ritz_dense_mul_tn(&MPhi, T, out);
}

/*
 * With Q = Phi_full' M T Phi_reduced, both sides normalised. Full modes closer
 * than 1e-3 are one cluster, whose MAC is that of subspaces: the least singular
 * value of its block of Q, squared. Rigid modes have no partner.
 */
static ritz_status match_shapes(const ritz_dense *parts, ritz_sides *sides)
{
    const ritz_poles *full = &sides->full->poles;
    RITZ_OWN(ritz_dense) Q = {0};
    int64_t last = 0;

    RITZ_CHECK(ritz_dense_mul(parts, &sides->small.Phi, &Q));
    for (int64_t first = full->num_rigid; first < full->count; first = last) {
        last = first + 1;
        while (last < full->count && is_close(full, last - 1))
            last++;
        RITZ_CHECK(match_cluster(sides, &Q, first, last));
    }
    return RITZ_OK;
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
    int64_t *of;   /* m, the reduced mode paired with each full one; -1: none */
    int64_t *by;   /* n, the full mode paired with each reduced one; -1: none */
} pairing;

static void pairing_free(pairing *p)
{
    RITZ_FREE(p->cost, p->total, p->of, p->by);
}

/* A mode that is not observable is known by its frequency alone. */
static double pair_cost(const ritz_sides *sides, int64_t k, int64_t r)
{
    double ratio =
        fabs(log(sides->reduced.lambda[r] / sides->full->poles.lambda[k])) /
        2.0;

    if (!sides->full->part.observable[k])
        return ratio;
    return ratio + RITZ_UNLIKE_COST * (1.0 - compare_modes(sides, k, r));
}

static ritz_status pairing_new(const ritz_sides *sides, pairing *p)
{
    const ritz_poles *full = &sides->full->poles, *reduced = &sides->reduced;

    p->m = full->count - full->num_rigid;
    p->n = reduced->count - reduced->num_rigid;
    RITZ_CHECK_NEW(p->cost, p->m * p->n);
    RITZ_CHECK_NEW(p->total, (p->m + 1) * (p->n + 1));
    RITZ_CHECK_NEW(p->of, p->m);
    RITZ_CHECK_NEW(p->by, p->n);
    for (int64_t k = 0; k < p->m; k++)
        for (int64_t r = 0; r < p->n; r++)
            p->cost[k * p->n + r] =
                pair_cost(sides, full->num_rigid + k, reduced->num_rigid + r);
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

/* Cost of pairing mode k with r, each of which may be none; infinite where two
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

/* Pair mode k with r, and the two modes that were paired with them with each
   other, if that costs less. */
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

/* The MAC of an observable mode that is not paired is 0. */
static void take_partners(const pairing *p, ritz_sides *sides)
{
    const ritz_poles *full = &sides->full->poles;
    ritz_match *match = &sides->match;

    for (int64_t j = 0; j < p->m; j++) {
        int64_t k = full->num_rigid + j;
        int64_t r = sides->reduced.num_rigid + p->of[j];

        if (p->of[j] >= 0) {
            match->partner[k] = r;
            match->taken[r] = true;
        }
        if (sides->full->part.observable[k] &&
            !(k > 0 && is_close(full, k - 1)) &&
            !(k + 1 < full->count && is_close(full, k)))
            match->mac[k] = p->of[j] < 0 ? 0.0 : compare_modes(sides, k, r);
    }
}

/* MAC is NaN of modes that are not observable, and of those closer than 1e-3,
   which may be any mixture. */
static ritz_status match_outputs(ritz_sides *sides)
{
    RITZ_OWN(pairing) p = {0};

    RITZ_CHECK(pairing_new(sides, &p));
    align_modes(&p);
    exchange_all(&p);
    take_partners(&p, sides);
    return RITZ_OK;
}

ritz_status ritz_sides_match(ritz_sides *sides)
{
    const ritz_dense *T = sides->component ? &sides->component->T : NULL;
    RITZ_OWN(ritz_dense) parts = {0};

    RITZ_CHECK(match_none(sides));
    sides->shapes =
        sides->parts ||
        (T && T->val && T->nrow == sides->full->component->num_dofs);
    if (!sides->shapes)
        return match_outputs(sides);
    if (!sides->parts)
        RITZ_CHECK(ritz_reference_parts(sides->full, T, &parts));
    return match_shapes(sides->parts ? sides->parts : &parts, sides);
}
