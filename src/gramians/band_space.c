/*
 * Gramians of a state space over a band, by quadrature of
 *
 *     x(w) = (i w E - A)^-1 B,   y(w) = (i w E - A)^-* C',
 *     W_c = 1/pi int_{w1}^{w2} Re x x^* dw,   W_o = 1/pi int Re y y^* dw
 *
 * with the factor's columns sqrt(weight / pi) [Re x, Im x] at every point, so
 * that the computed Gramian is semidefinite whatever its error
 * [GawronskiJuang1990]. Panels are halved until the Gauss rule of seven points
 * and the Kronrod rule of fifteen agree in the integrals of |x|^2 and |y|^2.
 * The first panels end at poles near the band, where both change most.
 */
#include "gramians/space.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    NODES = 15,
    HALF = 8,      /* nodes of half a panel, with the middle */
    DEPTH = 40,    /* largest number of halvings of a panel */
    PLACES = 3,    /* frequencies near which poles are sought */
    NEAR = 10,     /* poles sought near each of them */
    COLUMNS = 400, /* of a factor, above which it is compressed */
    SIDES = 2
};

/* Kronrod's nodes and weights on -1 .. 1, from 0 on; every other node is one of
   Gauss. [PiessensDonckerUberhuberKahaner1983] */
static const double node[HALF] = {
    0.0,
    0.207784955007898467600689403773245,
    0.405845151377397166906606412076961,
    0.586087235467691130294144691693013,
    0.741531185599394439863864773280788,
    0.864864423359769072789712788640926,
    0.949107912342758524526189684047851,
    0.991455371120812639206854697526329,
};
static const double kronrod[HALF] = {
    0.209482141084727828012999174891714, 0.204432940075298892414161999234649,
    0.190350578064785409913256402421014, 0.169004726639267902826583426598550,
    0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
    0.063092092629978553290700663189204, 0.022935322010529224963732008058970,
};
static const double gauss[HALF] = {
    0.417959183673469387755102040816327, 0.0,
    0.381830050505118944950369775488975, 0.0,
    0.279705391489276667901467771423780, 0.0,
    0.129484966168869693270611432679082, 0.0,
};

typedef struct quadrature {
    const ritz_state_space *model; /* borrowed */
    ritz_pencil pencil;
    ritz_zero_poles zero;
    ritz_dense F[SIDES]; /* B, and C' divided by limits, without poles at 0 */
    ritz_dense Z[SIDES]; /* room for `room` columns, ncol in use */
    int64_t room[SIDES];
    double sum[SIDES]; /* integrals of |x|^2 and |y|^2 over the panels accepted
                          so far */
    int64_t points;
} quadrature;

static void quadrature_free(quadrature *q)
{
    ritz_pencil_free(&q->pencil);
    ritz_zero_poles_free(&q->zero);
    for (int k = 0; k < SIDES; k++) {
        ritz_dense_free(&q->F[k]);
        ritz_dense_free(&q->Z[k]);
    }
}

/* x and then y at a frequency w, n x columns each. */
static ritz_status solve_at(quadrature *q, double w, double _Complex *out)
{
    ritz_status status = ritz_pencil_factor(&q->pencil, ritz_complex(0.0, w));

    RITZ_REFUSE_IF(
        status == RITZ_ERR_SINGULAR, RITZ_ERR_CONVERGENCE,
        "%.6g Hz is the frequency of a pole on the axis: there is no "
        "Gramian over this band",
        w / (2.0 * RITZ_PI));
    RITZ_CHECK(status);
    for (int k = 0; k < SIDES; k++) {
        int64_t size = q->F[k].nrow * q->F[k].ncol;

        for (int64_t i = 0; i < size; i++)
            out[i] = q->F[k].val[i];
        RITZ_CHECK(ritz_pencil_solve(&q->pencil, k == 1, q->F[k].ncol, out));
        RITZ_CHECK(
            ritz_zero_poles_of_states(&q->zero, k == 1, q->F[k].ncol, out));
        out += size;
    }
    ritz_monitor_step("points", ++q->points, 0);
    return RITZ_OK;
}

/* A panel: solutions at its nodes, and the integrals by both rules. */
typedef struct band_panel {
    double from, to;
    double _Complex *x; /* NODES times all columns */
    double rule[2][SIDES];
} band_panel;

static void band_panel_free(band_panel *p)
{
    free(p->x);
}

static int64_t values_of(const quadrature *q)
{
    return q->pencil.n * (q->F[0].ncol + q->F[1].ncol);
}

static double weight_of(const band_panel *p, const double *weights, int k)
{
    return 0.5 * (p->to - p->from) *
           weights[k < HALF ? HALF - 1 - k : k - HALF + 1];
}

static double point_of(const band_panel *p, int k)
{
    double t = k < HALF ? -node[HALF - 1 - k] : node[k - HALF + 1];

    return 0.5 * (p->from + p->to) + 0.5 * (p->to - p->from) * t;
}

static ritz_status fill_panel(quadrature *q, band_panel *p)
{
    int64_t values = values_of(q);

    RITZ_CHECK_NEW(p->x, NODES * values);
    for (int node_k = 0; node_k < NODES; node_k++) {
        const double _Complex *x = p->x + node_k * values;

        RITZ_CHECK(solve_at(q, point_of(p, node_k), p->x + node_k * values));
        for (int k = 0; k < SIDES; k++) {
            int64_t size = q->F[k].nrow * q->F[k].ncol;
            double squares = 0.0;

            for (int64_t i = 0; i < size; i++)
                squares +=
                    creal(x[i]) * creal(x[i]) + cimag(x[i]) * cimag(x[i]);
            p->rule[0][k] += weight_of(p, gauss, node_k) * squares;
            p->rule[1][k] += weight_of(p, kronrod, node_k) * squares;
            x += size;
        }
    }
    return RITZ_OK;
}

static ritz_status reserve_columns(quadrature *q, int k, int64_t more)
{
    RITZ_OWN(ritz_dense) Z = {0};
    int64_t used = 0;

    if (q->Z[k].ncol > COLUMNS) {
        RITZ_CHECK(ritz_factor_compress(&q->Z[k]));
        q->room[k] = q->Z[k].ncol;
    }
    used = q->Z[k].ncol;
    RITZ_CHECK(ritz_dense_new(q->pencil.n, used + more, &Z));
    if (used > 0)
        ritz_dense_put(&q->Z[k], 0, 0, &Z);
    ritz_dense_replace(&q->Z[k], &Z);
    q->Z[k].ncol = used;
    q->room[k] = used + more;
    return RITZ_OK;
}

/* sqrt(weight / pi) [Re x, Im x] as the next two columns of a factor. */
static void append_pair(double f, int64_t n, const double _Complex *x,
                        ritz_dense *Z)
{
    double *re = ritz_dense_col(Z, Z->ncol);
    double *im = re + n;

    for (int64_t i = 0; i < n; i++) {
        re[i] = f * creal(x[i]);
        im[i] = f * cimag(x[i]);
    }
    Z->ncol += 2;
}

/* Append the columns of an accepted panel to both factors. */
static ritz_status accept_panel(quadrature *q, const band_panel *p)
{
    const int64_t n = q->pencil.n, values = values_of(q);

    for (int k = 0; k < SIDES; k++) {
        const int64_t m = q->F[k].ncol;
        const double _Complex *first = p->x + (k == 0 ? 0 : n * q->F[0].ncol);

        q->sum[k] += p->rule[1][k];
        RITZ_CHECK(reserve_columns(q, k, 2 * (int64_t)NODES * m));
        for (int at = 0; at < NODES; at++)
            for (int64_t j = 0; j < m; j++)
                append_pair(sqrt(weight_of(p, kronrod, at) / RITZ_PI), n,
                            first + at * values + j * n, &q->Z[k]);
    }
    return RITZ_OK;
}

/* Whether both rules agree, relative to the integral so far. */
static bool is_fine(const quadrature *q, const band_panel *p)
{
    bool fine = true;

    for (int k = 0; k < SIDES; k++)
        fine =
            fine && fabs(p->rule[1][k] - p->rule[0][k]) <=
                        RITZ_BAND_QUADRATURE * fmax(q->sum[k], p->rule[1][k]);
    return fine;
}

/* Integrate one panel; where it is too coarse, its halves, with a stack of the
   right halves. */
static ritz_status integrate_panel(quadrature *q, double from, double to)
{
    double end[DEPTH + 1] = {to};
    int depth = 0;

    while (depth >= 0) {
        RITZ_OWN(band_panel) p = {.from = from, .to = end[depth]};

        RITZ_CHECK(fill_panel(q, &p));
        if (is_fine(q, &p)) {
            RITZ_CHECK(accept_panel(q, &p));
            from = end[depth--];
            continue;
        }
        RITZ_REFUSE_IF(depth == DEPTH ||
                           end[depth] - from <=
                               RITZ_SHORTEST_INTERVAL * end[depth],
                       RITZ_ERR_CONVERGENCE,
                       "Gramians over this band do not settle near %.6g Hz: is "
                       "a pole on the axis?",
                       from / (2.0 * RITZ_PI));
        end[depth + 1] = 0.5 * (from + end[depth]);
        depth++;
    }
    return RITZ_OK;
}

/*
 * Ends of the first panels: those of the band, and frequencies of poles within.
 * A pole nearer to an end of the band than the shortest panel that halving can
 * reach makes no panel: rounding gives poles at 0 such frequencies.
 */
static ritz_status list_ends(quadrature *q, const double band[2],
                             int64_t *count, double *end)
{
    const double shortest = ldexp(band[1] - band[0], -DEPTH);

    *count = 0;
    end[(*count)++] = band[0];
    end[(*count)++] = band[1];
    for (int k = 0; k < PLACES; k++) {
        double w = band[0] + (band[1] - band[0]) * (k + 0.5) / PLACES;
        RITZ_OWN(ritz_pencil_pairs) near = {0};
        ritz_status status =
            ritz_pencil_nearest(&q->pencil, ritz_complex(0.0, w), NEAR, &near);

        if (status == RITZ_ERR_MEMORY)
            return status;
        for (int64_t j = 0; status == RITZ_OK && j < near.count; j++)
            if (cimag(near.s[j]) > band[0] + shortest &&
                cimag(near.s[j]) < band[1] - shortest)
                end[(*count)++] = cimag(near.s[j]);
    }
    *count = ritz_sort_distinct(*count, end, RITZ_SAME);
    return RITZ_OK;
}

static ritz_status finish_factors(quadrature *q, ritz_gramians *out)
{
    for (int k = 0; k < SIDES; k++)
        RITZ_CHECK(ritz_factor_compress(&q->Z[k]));
    RITZ_MOVE(out->Zc, q->Z[0]);
    RITZ_MOVE(out->Zo, q->Z[1]);
    if (!q->pencil.plain)
        RITZ_CHECK(ritz_sparse_mul(&q->pencil.E, &out->Zc, &out->EZc));
    RITZ_MOVE(out->T, q->zero.T);
    RITZ_MOVE(out->W, q->zero.W);
    (void)snprintf(out->engine, sizeof out->engine,
                   "quadrature, %" PRId64 " points", q->points);
    return RITZ_OK;
}

ritz_status ritz_gramians_space_band(const ritz_state_space *model,
                                     const double band_hz[2],
                                     ritz_gramians *out)
{
    const double band[2] = {2.0 * RITZ_PI * band_hz[0],
                            2.0 * RITZ_PI * band_hz[1]};
    double end[2 + PLACES * NEAR];
    int64_t count = 0;
    RITZ_OWN(quadrature) q = {.model = model};
    RITZ_OWN(ritz_gramians) g = {0};

    RITZ_REFUSE_IF(!(band[0] >= 0.0 && band[1] > band[0] && isfinite(band[1])),
                   RITZ_ERR_ARGUMENT,
                   "a band is from 0 Hz or more to more, not from %g to %g",
                   band_hz[0], band_hz[1]);
    RITZ_CHECK(ritz_pencil_of_space(model, &q.pencil));
    RITZ_CHECK(ritz_dense_copy(&model->B, &q.F[0]));
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &q.F[1]));
    RITZ_CHECK_IN("poles at 0", ritz_zero_poles_find(&q.pencil, &q.zero));
    for (int k = 0; k < SIDES; k++)
        RITZ_CHECK(ritz_zero_poles_of_loads(&q.zero, k == 1, &q.F[k]));
    RITZ_CHECK(list_ends(&q, band, &count, end));
    for (int64_t k = 0; k + 1 < count; k++)
        RITZ_CHECK(integrate_panel(&q, end[k], end[k + 1]));
    RITZ_CHECK(finish_factors(&q, &g));
    memcpy(g.damping, model->damping, sizeof g.damping);
    RITZ_MOVE(*out, g);
    return RITZ_OK;
}
