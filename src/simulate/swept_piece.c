/*
 * Splines over the setting of a joint, and matrices in the interpolated basis.
 * On equally spaced knots with values f_i the second derivatives m_i of the
 * cubic spline follow from
 *
 *     m_i-1 + 4 m_i + m_i+1 = 6 (f_i-1 - 2 f_i + f_i+1) / h^2
 *
 * and from the condition "not a knot" [DeBoor2001]: the third derivative is
 * continuous at the second knot, so that m_0 = 2 m_1 - m_2 and m_1 is the
 * second difference there, and likewise at the last knot but one. Errors are of
 * order h^4 in f, h^3 in f' and h^2 in f''. Between knots i and i + 1, with s =
 * (x - x_i) / h,
 *
 *     f = c_0 + c_1 s + c_2 s^2 + c_3 s^3,   c_0 = f_i,   c_2 = h^2 m_i / 2,
 *     c_1 = f_i+1 - f_i - h^2 (2 m_i + m_i+1) / 6,   c_3 = h^2 (m_i+1 - m_i) /
 *     6
 */
#include "simulate/swept.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

enum { POWERS = 4 };

/* Values at knot k of A, which is F or its second derivatives. */
static double *knot(const ritz_swept_model *m, const ritz_dense *A, int64_t k)
{
    return ritz_dense_col(A, k * m->order);
}

/* to += factor from, for the values at a knot. */
static void add_knot(int64_t size, double factor, const double *from,
                     double *to)
{
    for (int64_t k = 0; k < size; k++)
        to[k] += factor * from[k];
}

ritz_status ritz_swept_bend(ritz_swept_model *m)
{
    const int64_t size = m->F.nrow * m->order, last = m->count - 1;
    const double h2 = m->spacing * m->spacing;
    RITZ_OWN(ritz_dense) bend = {0};
    RITZ_OWN_ARRAY double *upper = NULL;

    RITZ_CHECK_NEW(upper, m->count);
    RITZ_CHECK(ritz_dense_new(m->F.nrow, m->F.ncol, &bend));
    for (int64_t i = 1; i < last; i++) {
        const bool fixed = i == 1 || i == last - 1;
        const double factor = (fixed ? 1.0 : 6.0) / h2;
        double own = fixed ? 1.0 : 4.0 - upper[i - 1];
        double *to = knot(m, &bend, i);

        add_knot(size, factor, knot(m, &m->F, i - 1), to);
        add_knot(size, -2.0 * factor, knot(m, &m->F, i), to);
        add_knot(size, factor, knot(m, &m->F, i + 1), to);
        if (!fixed)
            add_knot(size, -1.0, knot(m, &bend, i - 1), to);
        for (int64_t k = 0; k < size; k++)
            to[k] /= own;
        upper[i] = fixed ? 0.0 : 1.0 / own;
    }
    for (int64_t i = last - 2; i > 1; i--)
        add_knot(size, -upper[i], knot(m, &bend, i + 1), knot(m, &bend, i));
    add_knot(size, 2.0, knot(m, &bend, 1), knot(m, &bend, 0));
    add_knot(size, -1.0, knot(m, &bend, 2), knot(m, &bend, 0));
    add_knot(size, 2.0, knot(m, &bend, last - 1), knot(m, &bend, last));
    add_knot(size, -1.0, knot(m, &bend, last - 2), knot(m, &bend, last));
    ritz_dense_replace(&m->bend, &bend);
    return RITZ_OK;
}

/* Number of the knot before x. */
static int64_t find_piece(const ritz_swept_model *m, double x)
{
    double k = floor((x - m->first) / m->spacing);

    return (int64_t)fmin(fmax(k, 0.0), (double)(m->count - 2));
}

void ritz_swept_weights(const ritz_swept_model *m, int64_t at, double x,
                        double w[static 3][4])
{
    const double h = m->spacing;
    const double s = (x - m->first) / h - (double)at;
    const double rows[3][POWERS] = {{1.0, s, s * s, s * s * s},
                                    {0.0, 1.0, 2.0 * s, 3.0 * s * s},
                                    {0.0, 0.0, 2.0, 6.0 * s}};

    for (int k = 0; k < POWERS; k++) {
        w[0][k] = rows[0][k];
        w[1][k] = rows[1][k] / h;
        w[2][k] = rows[2][k] / (h * h);
    }
}

/* The coefficients c_0 .. c_3 between knots `at` and at + 1, rows x 4r. */
static ritz_status find_powers(const ritz_swept_model *m, int64_t at,
                               ritz_dense *out)
{
    const int64_t size = m->F.nrow * m->order;
    const double h2 = m->spacing * m->spacing;
    const double *f0 = knot(m, &m->F, at), *f1 = knot(m, &m->F, at + 1);
    const double *m0 = knot(m, &m->bend, at), *m1 = knot(m, &m->bend, at + 1);
    double *c = NULL;

    RITZ_CHECK(ritz_dense_new(m->F.nrow, POWERS * m->order, out));
    c = out->val;
    for (int64_t k = 0; k < size; k++) {
        c[k] = f0[k];
        c[size + k] = f1[k] - f0[k] - h2 * (2.0 * m0[k] + m1[k]) / 6.0;
        c[2 * size + k] = 0.5 * h2 * m0[k];
        c[3 * size + k] = h2 * (m1[k] - m0[k]) / 6.0;
    }
    return RITZ_OK;
}

double ritz_swept_within(const ritz_swept_model *m, double x, double *turns)
{
    const double whole = (double)(m->count - 1) * m->spacing;

    *turns = m->turn.val ? floor((x - m->first) / whole) : 0.0;
    return x - *turns * whole;
}

ritz_status ritz_swept_values(const ritz_swept_model *m, double x,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_dense) powers = {0};
    double w[3][POWERS], turns = 0.0;
    int64_t at = 0;

    x = ritz_swept_within(m, x, &turns);
    at = find_piece(m, x);
    RITZ_CHECK(find_powers(m, at, &powers));
    ritz_swept_weights(m, at, x, w);
    RITZ_CHECK(ritz_dense_new(m->F.nrow, m->order, out));
    ritz_swept_combine(&powers, w[0], out);
    return RITZ_OK;
}

/* X'A X; {0} if A is {0}. */
static ritz_status project(const ritz_dense *A, const ritz_dense *X,
                           ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AX = {0};

    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(A, X, &AX));
    return ritz_dense_mul_tn(X, &AX, out);
}

static ritz_status fill_piece(const ritz_swept_model *m, int64_t at,
                              ritz_swept_piece *p)
{
    const int64_t Q = m->M.nrow, all = POWERS * m->order;
    RITZ_OWN(ritz_dense) powers = {0}, X = {0};

    RITZ_CHECK(find_powers(m, at, &powers));
    RITZ_CHECK(ritz_dense_block(&powers, 0, Q, 0, all, &X));
    RITZ_CHECK(ritz_dense_block(&powers, Q, m->num_springs, 0, all, &p->ST));
    if (m->has_ratios)
        RITZ_CHECK(ritz_dense_block(&powers, Q + m->num_springs, m->order, 0,
                                    all, &p->ratios));
    RITZ_CHECK(project(&m->M, &X, &p->M));
    RITZ_CHECK(project(&m->K, &X, &p->K));
    RITZ_CHECK(project(&m->D, &X, &p->D));
    RITZ_CHECK(project(&m->G, &X, &p->G));
    RITZ_CHECK(project(&m->H, &X, &p->H));
    RITZ_CHECK(ritz_dense_mul_tn(&X, &m->io.B, &p->B));
    RITZ_CHECK(ritz_dense_mul(&m->io.C, &X, &p->C));
    RITZ_CHECK(ritz_dense_mul(&m->io.Cv, &X, &p->Cv));
    RITZ_CHECK(ritz_dense_mul(&m->io.Ca, &X, &p->Ca));
    p->at = at;
    return RITZ_OK;
}

ritz_status ritz_swept_piece_move(const ritz_swept_model *m, double x,
                                  ritz_swept_piece *piece)
{
    const int64_t at = find_piece(m, x);
    RITZ_OWN(ritz_swept_piece) next = {.at = -1};

    if (piece->M.val && piece->at == at)
        return RITZ_OK;
    RITZ_CHECK(fill_piece(m, at, &next));
    ritz_swept_piece_free(piece);
    RITZ_MOVE(*piece, next);
    return RITZ_OK;
}

void ritz_swept_piece_free(ritz_swept_piece *p)
{
    enum { OWNED = 11 };
    ritz_dense *const all[OWNED] = {&p->M, &p->K,  &p->D,      &p->G,
                                    &p->H, &p->ST, &p->ratios, &p->B,
                                    &p->C, &p->Cv, &p->Ca};

    for (int k = 0; k < OWNED; k++)
        ritz_dense_free(all[k]);
    *p = (ritz_swept_piece){.at = -1};
}

void ritz_swept_contract(const ritz_dense *W, const double a[static 4],
                         const double b[static 4], double factor,
                         ritz_dense *out)
{
    const int64_t r = out->ncol;

    for (int64_t l = 0; W->val && factor != 0.0 && l < POWERS; l++)
        for (int64_t k = 0; k < POWERS; k++) {
            const double weight = factor * a[k] * b[l];

            for (int64_t j = 0; weight != 0.0 && j < r; j++) {
                const double *from = ritz_dense_col(W, l * r + j) + k * r;
                double *to = ritz_dense_col(out, j);

                for (int64_t i = 0; i < r; i++)
                    to[i] += weight * from[i];
            }
        }
}

void ritz_swept_combine(const ritz_dense *c, const double w[static 4],
                        ritz_dense *out)
{
    const int64_t size = out->nrow * out->ncol;

    memset(out->val, 0, (size_t)size * sizeof *out->val);
    for (int64_t k = 0; k < POWERS; k++)
        add_knot(size, w[k], c->val + k * size, out->val);
}

void ritz_swept_spread(const double w[static 4], double factor, int64_t r,
                       const double *q, double *z)
{
    for (int64_t k = 0; k < POWERS; k++)
        for (int64_t j = 0; j < r; j++)
            z[k * r + j] += factor * w[k] * q[j];
}

void ritz_swept_model_free(ritz_swept_model *m)
{
    enum { OWNED = 11 };
    ritz_dense *const all[OWNED] = {&m->F,     &m->bend,    &m->M, &m->K,
                                    &m->D,     &m->G,       &m->H, &m->turn,
                                    &m->start, &m->start_B, &m->V};

    for (int k = 0; k < OWNED; k++)
        ritz_dense_free(all[k]);
    ritz_io_free(&m->io);
    RITZ_FREE(m->stiffness, m->damping, m->start_lambda, m->turns);
    *m = (ritz_swept_model){0};
}
