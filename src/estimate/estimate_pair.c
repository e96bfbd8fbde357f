/*
 * The bound of |H - H_r| of each pair of an input and an output, at a frequency
 * or anywhere in an interval: see estimate_response.c.
 */
#include "estimate/estimate_bounder.h"

#include <math.h>
#include <string.h>

typedef double _Complex number;

/* The product of a real symmetric matrix and a complex vector. */
static void multiply(const ritz_dense *G, const number *x, number *y)
{
    memset(y, 0, (size_t)G->nrow * sizeof *y);
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->nrow && x[j] != 0.0; i++)
            y[i] += ritz_dense_col(G, j)[i] * x[j];
}

static double norm_of(const ritz_bounder *r, const number *x, number *work)
{
    double sum = 0.0;

    multiply(&r->G, x, work);
    for (int64_t i = 0; i < r->size; i++)
        sum += creal(conj(x[i]) * work[i]);
    return sqrt(fmax(sum, 0.0));
}

/* Of c eta_j within h of w: what it is at most, and its second derivative. */
static void most_of(const ritz_bounder *r, const ritz_side *s, int64_t j,
                    double w, double h, double out[2])
{
    double d = ritz_bounder_rate_of(r, j);
    double theta = ritz_bounder_stiffness(r, j);
    double off = h * (2.0 * w + h) + h * d;
    double z = fmax(hypot(theta - w * w, w * d) - off, fmax(w - h, 0.0) * d);
    double z1 = hypot(2.0 * (w + h), d);
    double second = s->second[j];
    double first = cabs(s->first[j]) + h * second;
    double share = cabs(s->modal[j]) + h * first;
    double b = r->rayleigh ? r->b : 0.0;
    double eta1 = (first + share * z1 / z) / z;
    double eta2 = (second + 2.0 * first * z1 / z +
                   share * (2.0 * z1 * z1 / z + 2.0) / z) /
                  z;

    out[0] = share / z;
    out[1] = hypot(1.0, (w + h) * b) * eta2 + 2.0 * b * eta1;
}

/*
 * One side at w: modal shares, and alpha and slope of what is not modal, are
 * there. Within h of w
 *
 *     |r(w + d) - r(w)| <= h |r'(w)| + h^2 / 2 max |r''|,
 *
 * where r' is known as a vector, in which large parts cancel; `bent` is what is
 * not modal of |r''|.
 */
static void solve_side(ritz_bounder *r, double w, double h, double bent,
                       ritz_side *s)
{
    double b = r->rayleigh ? r->b : 0.0;
    number c = ritz_complex(1.0, w * b);
    double curve = bent;

    s->damped = s->quarter = s->three = 0.0;
    for (int64_t j = 0; j < r->trial->count; j++) {
        double theta = ritz_bounder_stiffness(r, j);
        double d = ritz_bounder_rate_of(r, j);
        number z = ritz_complex(theta - w * w, w * d);
        number z1 = ritz_complex(-2.0 * w, d);
        double size = r->size_of[j];
        double most[2];

        s->eta[j] = s->modal[j] / z;
        s->alpha[j] = -c * s->eta[j];
        s->slope[j] = -ritz_complex(0.0, b) * s->eta[j] -
                      c * (s->first[j] - s->eta[j] * z1) / z;
        most_of(r, s, j, w, h, most);
        if (h > 0.0)
            curve += size * most[1];
        if (r->rayleigh || theta <= 0.0)
            continue;
        s->damped += size * most[0] * 2.0 * r->zeta * (w + h) / sqrt(theta);
        s->quarter += size * most[0] / sqrt(sqrt(theta));
        s->three += size * most[0] / (sqrt(theta) * sqrt(sqrt(theta)));
    }
    s->norm = norm_of(r, s->alpha, r->GV);
    s->change =
        h > 0.0 ? h * norm_of(r, s->slope, r->GV) + 0.5 * h * h * curve : 0.0;
}

/* Sides of all inputs and outputs. */
static void solve_all(ritz_bounder *r, double w, double h)
{
    const ritz_io *io = r->io;
    int64_t m = r->trial->count;
    int64_t p = io->num_outputs;

    for (int64_t k = 0; k < io->num_inputs; k++) {
        memset(r->in[k].alpha, 0, (size_t)r->size * sizeof(number));
        r->in[k].alpha[m + k] = 1.0;
        for (int64_t j = 0; j < m; j++)
            r->in[k].modal[j] = ritz_dense_col(&r->B, k)[j];
        if (!r->coupled)
            solve_side(r, w, h, 0.0, &r->in[k]);
    }
    for (int64_t k = 0; k < p; k++) {
        ritz_side *s = &r->out[k];
        int64_t at = m + io->num_inputs + k;

        memset(s->alpha, 0, (size_t)r->size * sizeof(number));
        s->alpha[at] = 1.0;
        s->alpha[at + p] = ritz_complex(0.0, w);
        s->alpha[at + 2 * p] = -w * w;
        s->slope[at + p] = ritz_complex(0.0, 1.0);
        s->slope[at + 2 * p] = -2.0 * w;
        for (int64_t j = 0; j < m; j++) {
            double cv = ritz_dense_col(&r->C[1], j)[k];
            double ca = ritz_dense_col(&r->C[2], j)[k];

            s->modal[j] = ritz_complex(
                ritz_dense_col(&r->C[0], j)[k] - w * w * ca, w * cv);
            s->first[j] = ritz_complex(-2.0 * w * ca, cv);
            s->second[j] = 2.0 * fabs(ca);
        }
        if (!r->coupled)
            solve_side(r, w, h, 2.0 * r->size_of[at + 2 * p], s);
    }
    if (!r->coupled)
        return;
    ritz_coupled_solve(r, w);
    for (int64_t k = 0; k < io->num_inputs; k++)
        r->in[k].norm = norm_of(r, r->in[k].alpha, r->GV);
    for (int64_t k = 0; k < p; k++)
        r->out[k].norm = norm_of(r, r->out[k].alpha, r->GV);
}

/* At one interval of frequencies. */
typedef struct place {
    double low, high; /* w, both ends */
    number c, s;
    double most_s;   /* |s| anywhere within */
    double least_c2; /* |c|^2 */
} place;

/* Largest |rest| of a mode whose lambda lies in [low, high]. */
static double rest_of(const ritz_bounder *r, const place *at, double low,
                      double high)
{
    double apart =
        fmax(0.0, fmax(low - at->high * at->high, at->low * at->low - high));
    double z = hypot(apart, at->low * ritz_bounder_rate(r, low));
    double mu = low - r->trial->sigma;
    double own = 0.0;

    if (!(z > 0.0))
        return HUGE_VAL;
    if (!r->rayleigh) {
        double over = fmin(1.0, at->high * ritz_bounder_rate(r, high) / z);

        if (isinf(high))
            over = apart > 0.0 ? at->high * ritz_bounder_rate(r, low) / apart
                               : 1.0;
        own = fmin(1.0, over) * (1.0 + at->most_s / mu);
    }
    return at->most_s * at->most_s / (at->least_c2 * mu * z) + own;
}

/*
 * What modes make of the rest and of what damping adds: of N lowest ones by
 * what is not held of them, of the others together; N is what suits best.
 *
 * @param[in] all, added  products of norms that either goes with
 */
static double weigh(const ritz_bounder *r, const place *at, double all,
                    double added)
{
    const ritz_enclosure *e = r->e;
    double sigma = r->trial->sigma;
    double sum = 0.0;
    double most = 0.0;
    double best = HUGE_VAL;

    for (int64_t N = 0; N < e->count; N++) {
        double low = fmax(e->low[N], 0.0);
        double first = 1.0 + at->most_s / (low - sigma);
        double far = all * rest_of(r, at, low, HUGE_VAL) + added * first;
        double own = all * rest_of(r, at, low, e->high[N]) + added * first;

        best = fmin(best, fmin(sum, most) + far);
        sum += r->sin2[N] * own;
        most = fmax(most, own);
    }
    return best;
}

/* Bound of one pair; *response is its |H_r|. */
static double pair(const ritz_bounder *r, const place *at, double h,
                   const ritz_side *in, const ritz_side *out, double *response)
{
    double sigma = -r->trial->sigma;
    double c = cabs(at->c);
    double P = in->norm + in->change;
    double D = out->norm + out->change;
    double varied = in->norm * out->change + in->change * D;
    double turned = r->rayleigh ? h * r->b : 0.0;
    double moved = h * (2.0 * at->high + fabs(r->a + r->b * -sigma));
    double all = (P + in->damped) * (D + out->damped);
    double w = at->high;
    double defect = 0.0;
    number lead = 0.0;
    number H = 0.0;

    for (int64_t i = 0; i < r->size; i++)
        lead += out->alpha[i] *
                (r->GV[i] / at->c + at->s * r->QV[i] / (at->c * at->c));
    for (int64_t j = 0; j < r->trial->count; j++)
        H += out->modal[j] * in->eta[j];
    *response = cabs(H);
    if (!r->rayleigh)
        defect = r->zeta * w *
                 (in->quarter * out->quarter + sigma * in->three * out->three);
    return cabs(lead) + defect +
           varied * (1.0 / c + cabs(at->s) / (c * c * sigma)) +
           (turned + moved / sigma +
            2.0 * turned * at->most_s / sigma / sqrt(at->least_c2)) /
               at->least_c2 * P * D +
           weigh(r, at, all, all - P * D) +
           ritz_bounder_rounding(r, at->high, in, out);
}

static place place_of(const ritz_bounder *r, double w, double h)
{
    double sigma = r->trial->sigma;
    place at = {
        .low = fmax(w - h, 0.0), .high = w + h, .c = 1.0, .least_c2 = 1.0};

    at.s = w * w - sigma;
    at.most_s = at.high * at.high - sigma;
    if (r->rayleigh) {
        at.c = ritz_complex(1.0, w * r->b);
        at.least_c2 += at.low * r->b * at.low * r->b;
        at.s = ritz_complex(w * w - sigma, -w * (r->a + r->b * sigma));
        at.most_s = hypot(at.most_s, at.high * fabs(r->a + r->b * sigma));
        at.most_s = fmax(at.most_s, cabs(at.s));
    }
    return at;
}

/* The largest bound of all pairs within h of w; with h = 0 it tells |H_r|. */
double ritz_bound_at(ritz_bounder *r, double w, double h)
{
    const ritz_io *io = r->io;
    place at = place_of(r, w, h);
    double largest = 0.0;

    solve_all(r, w, h);
    for (int64_t j = 0; j < io->num_inputs; j++) {
        multiply(&r->G, r->in[j].alpha, r->GV);
        multiply(&r->Q, r->in[j].alpha, r->QV);
        for (int64_t i = 0; i < io->num_outputs; i++) {
            double response = 0.0;
            double one = pair(r, &at, h, &r->in[j], &r->out[i], &response);

            largest = fmax(largest, isnan(one) ? HUGE_VAL : one);
            if (h == 0.0) {
                r->least = fmax(r->least, response - one);
                r->largest = fmax(r->largest, response);
            }
        }
    }
    return largest;
}
