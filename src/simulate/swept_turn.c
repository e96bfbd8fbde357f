/*
 * Splines over whole turns. The system at x + 2 pi is that at x. A basis T that
 * is aligned from knot to knot does not return to itself, but to
 *
 *     T(x + 2 pi) = T(x) O,   S T likewise,   D_r(x + 2 pi) = O'D_r(x) O
 *
 * with an orthogonal O. This continues the knots of one turn on both sides.
 * The effect of the ends on second derivatives of a spline decreases by a
 * factor of 2 - sqrt(3) a knot, so that 32 more knots on either side reduce it
 * to 5e-19.
 */
#include "simulate/swept.h"

#include "base/alloc.h"

#include <string.h>

static const int64_t beside = 32;

/* Values at a knot one turn further, or one turn back. */
static ritz_status turn_values(const ritz_swept_model *m, bool back,
                               ritz_dense *F)
{
    const int64_t r = m->order, rows = F->nrow - (m->has_ratios ? r : 0);
    RITZ_OWN(ritz_dense) turned = {0}, D = {0}, left = {0};

    RITZ_CHECK(back ? ritz_dense_mul_nt(F, &m->turn, &turned)
                    : ritz_dense_mul(F, &m->turn, &turned));
    if (m->has_ratios) {
        RITZ_CHECK(ritz_dense_block(&turned, rows, r, 0, r, &D));
        RITZ_CHECK(back ? ritz_dense_mul(&m->turn, &D, &left)
                        : ritz_dense_mul_tn(&m->turn, &D, &left));
        ritz_dense_put(&left, rows, 0, &turned);
    }
    ritz_dense_replace(F, &turned);
    return RITZ_OK;
}

/* F at knot i of the turn of the knots, or of the turns on either side. */
static ritz_status continue_values(const ritz_swept_model *m, int64_t i,
                                   ritz_dense *out)
{
    const int64_t whole = m->count - 1, r = m->order;
    int64_t turns = 0;

    for (; i < 0; i += whole)
        turns--;
    for (; i >= whole; i -= whole)
        turns++;
    RITZ_CHECK(ritz_dense_block(&m->F, 0, m->F.nrow, i * r, r, out));
    for (; turns != 0; turns += turns < 0 ? 1 : -1)
        RITZ_CHECK(turn_values(m, turns < 0, out));
    return RITZ_OK;
}

/* The knots, with further ones on either side, and their spline. */
static ritz_status make_wider(const ritz_swept_model *m, ritz_swept_model *out)
{
    out->order = m->order;
    out->count = m->count + 2 * beside;
    out->spacing = m->spacing;
    RITZ_CHECK(ritz_dense_new(m->F.nrow, out->count * m->order, &out->F));
    for (int64_t k = 0; k < out->count; k++) {
        RITZ_OWN(ritz_dense) F = {0};

        RITZ_CHECK(continue_values(m, k - beside, &F));
        ritz_dense_put(&F, 0, k * m->order, &out->F);
    }
    return ritz_swept_bend(out);
}

ritz_status ritz_swept_bend_around(ritz_swept_model *m)
{
    const int64_t r = m->order;
    RITZ_OWN(ritz_swept_model) wider = {0};
    RITZ_OWN(ritz_dense) F = {0}, bend = {0};

    RITZ_CHECK(make_wider(m, &wider));
    RITZ_CHECK(
        ritz_dense_block(&wider.F, 0, m->F.nrow, beside * r, m->count * r, &F));
    RITZ_CHECK(ritz_dense_block(&wider.bend, 0, m->F.nrow, beside * r,
                                m->count * r, &bend));
    ritz_dense_replace(&m->F, &F);
    ritz_dense_replace(&m->bend, &bend);
    return RITZ_OK;
}

void ritz_swept_turn(const ritz_swept_model *m, bool back, double *q,
                     double *work)
{
    const int64_t r = m->order;

    memcpy(work, q, (size_t)r * sizeof *q);
    memset(q, 0, (size_t)r * sizeof *q);
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < r; i++)
            if (back)
                q[j] += ritz_dense_col(&m->turn, j)[i] * work[i];
            else
                q[i] += ritz_dense_col(&m->turn, j)[i] * work[j];
}
