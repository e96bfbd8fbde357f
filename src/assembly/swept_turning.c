/*
 * Bodies on the far side of a joint turn about its axis n with the setting x.
 * With N u = n x u and the mass of a body, G = <phi, N phi> and H = <N phi, N
 * phi> follow from its inertia invariants.
 */
#include "assembly/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>

/* The axis n about which a body turns with x, in its own frame. With N u = n x
   u and d the angle between two knots, R_0'R_1 = exp(d N) has the skew part
   sin(d) N. */
static void find_axis(const ritz_sweep_knot *a, const ritz_sweep_knot *b,
                      int64_t body, double n[3])
{
    const double d = sin(b->x - a->x);

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        double sum = 0.0;

        for (int c = 0; c < 3; c++) {
            const double *const at[4] = {ritz_dense_col(&a->places, 3 * c + k),
                                         ritz_dense_col(&b->places, 3 * c + j),
                                         ritz_dense_col(&a->places, 3 * c + j),
                                         ritz_dense_col(&b->places, 3 * c + k)};

            sum += at[0][body] * at[1][body] - at[2][body] * at[3][body];
        }
        n[i] = 0.5 * sum / d;
    }
}

/* Add to G and H the blocks of a body that turns about n. */
static void add_turning(const ritz_invariants *own, const double n[3],
                        int64_t first, ritz_dense *G, ritz_dense *H)
{
    const int64_t r = own->momentum.ncol;

    for (int64_t k = 0; k < r; k++)
        for (int64_t j = 0; j < r; j++) {
            double g = 0.0, h = 0.0;

            for (int a = 0; a < 3; a++) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                const double *at_b = ritz_dense_col(&own->product, b * r + k);
                const double *at_c = ritz_dense_col(&own->product, c * r + k);

                /* n . phi_k x phi_j = sum_a n_a (k_b j_c - k_c j_b) */
                g += n[a] * (at_b[c * r + j] - at_c[b * r + j]);
                h += ritz_dense_col(&own->product, a * r + k)[a * r + j];
                for (int e = 0; e < 3; e++)
                    h -= n[a] * n[e] *
                         ritz_dense_col(&own->product, e * r + k)[a * r + j];
            }
            ritz_dense_col(G, first + k)[first + j] = g;
            ritz_dense_col(H, first + k)[first + j] = h;
        }
}

/* G and H, if any body turns. */
ritz_status ritz_sweep_turning(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid, ritz_swept_model *m)
{
    const ritz_stage *stage = w->stage;
    const int64_t Q = stage->num_coordinates, last = grid->count - 1;

    RITZ_CHECK_NEW(m->turns, stage->count);
    m->num_bodies = stage->count;
    if (!stage->scene->sweep[w->asked->sweep].turns)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->G));
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->H));
    for (int64_t k = 0; k < stage->count; k++) {
        const char *name = stage->scene->component[k].name;
        double n[3], end[3], off = 0.0, length = 0.0;

        find_axis(&grid->knot[0], &grid->knot[1], k, n);
        find_axis(&grid->knot[last - 1], &grid->knot[last], k, end);
        for (int i = 0; i < 3; i++) {
            length += n[i] * n[i];
            off = fmax(off, fabs(n[i] - end[i]));
        }
        if (length < RITZ_SWEPT_AXIS && off < RITZ_SWEPT_AXIS)
            continue;
        RITZ_REFUSE_IF(off > RITZ_SWEPT_AXIS ||
                           fabs(length - 1.0) > RITZ_SWEPT_AXIS,
                       RITZ_ERR_ARGUMENT,
                       "'%s' does not turn evenly with '%s': a loop of joints "
                       "turns it",
                       name, ritz_sweep_name(w));
        RITZ_REFUSE_IF(!stage->body[k].invariants.momentum.val,
                       RITZ_ERR_ARGUMENT,
                       "'%s' turns with '%s', and its inertia is not known: it "
                       "has no grids, or more than %d columns",
                       name, ritz_sweep_name(w), RITZ_INVARIANT_COLUMNS);
        add_turning(&stage->body[k].invariants, n, stage->first[k], &m->G,
                    &m->H);
        m->turns[k] = true;
    }
    return RITZ_OK;
}
