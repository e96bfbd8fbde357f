#include "base/alloc.h"
#include "gramians/engines.h"

#include <stdlib.h>
#include <string.h>

/* Rows first, first + step, ... of Z, over or times the scale. */
static ritz_status pick(const ritz_dense *Z, int64_t first, int64_t step,
                        const double *scale, bool over, ritz_dense *out)
{
    int64_t m = Z->nrow / 2;

    RITZ_CHECK(ritz_dense_new(m, Z->ncol, out));
    for (int64_t j = 0; j < Z->ncol; j++) {
        const double *from = ritz_dense_col(Z, j) + first;
        double *to = ritz_dense_col(out, j);

        for (int64_t k = 0; k < m; k++) {
            double s = scale ? scale[k] : 1.0;

            to[k] = over ? from[k * step] / s : from[k * step] * s;
        }
    }
    return RITZ_OK;
}

/* [top Q; bottom V], Q and V the positions and the velocities in Z. */
static ritz_status stack(const ritz_mode_states *states, const ritz_dense *top,
                         const ritz_dense *bottom, bool over,
                         const ritz_dense *Z, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = states->modes->num_dofs;
    int64_t m = Z->nrow / 2;
    int64_t velocities = states->step == 1 ? m : 1;
    ritz_dense part = {0}, x = {0}, made = {0};

    RITZ_TRY(ritz_dense_new(2 * n, Z->ncol, &made));
    for (int half = 0; half < 2 && Z->ncol > 0; half++) {
        RITZ_TRY(pick(Z, half * velocities, states->step,
                      half == 0 ? states->scale : NULL, over, &part));
        RITZ_TRY(ritz_dense_mul(half == 0 ? top : bottom, &part, &x));
        for (int64_t j = 0; j < x.ncol; j++)
            memcpy(ritz_dense_col(&made, j) + half * n, ritz_dense_col(&x, j),
                   (size_t)n * sizeof *x.val);
        ritz_dense_free(&part);
        ritz_dense_free(&x);
    }
    *out = made;
    made = (ritz_dense){0};
done:
    ritz_dense_free(&part);
    ritz_dense_free(&x);
    ritz_dense_free(&made);
    return status;
}

/* [top 0 own; 0 bottom own]: rigid modes, and then what is there. */
static ritz_status behind(const ritz_mode_states *states, const ritz_dense *top,
                          const ritz_dense *bottom, ritz_dense *own)
{
    ritz_status status = RITZ_OK;
    int64_t n = states->modes->num_dofs;
    int64_t r = states->apart;
    size_t column = (size_t)n * sizeof *own->val;
    ritz_dense all = {0};

    RITZ_TRY(ritz_dense_new(2 * n, 2 * r + own->ncol, &all));
    for (int64_t j = 0; j < r; j++) {
        memcpy(ritz_dense_col(&all, j), ritz_dense_col(top, j), column);
        memcpy(ritz_dense_col(&all, r + j) + n, ritz_dense_col(bottom, j),
               column);
    }
    for (int64_t j = 0; j < own->ncol; j++)
        memcpy(ritz_dense_col(&all, 2 * r + j), ritz_dense_col(own, j),
               2 * column);
    ritz_dense_free(own);
    *own = all;
    all = (ritz_dense){0};
done:
    ritz_dense_free(&all);
    return status;
}

ritz_status ritz_gramians_lift(const ritz_mode_states *states,
                               ritz_gramians *gramians)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *modes = states->modes;
    int64_t m = modes->count - states->apart;
    const ritz_dense Phi = ritz_dense_part(&modes->Phi, states->apart, m);
    const ritz_dense MPhi = ritz_dense_part(&modes->MPhi, states->apart, m);
    const ritz_dense *Zc = &gramians->Zc, *Zo = &gramians->Zo;
    const ritz_dense *T = &gramians->T, *W = &gramians->W;
    ritz_gramians made = *gramians;

    made.Zc = made.Zo = made.T = made.W = (ritz_dense){0};
    RITZ_TRY(stack(states, &Phi, &Phi, true, Zc, &made.Zc));
    RITZ_TRY(stack(states, &Phi, &MPhi, true, Zc, &made.EZc));
    RITZ_TRY(stack(states, &MPhi, &Phi, false, Zo, &made.Zo));
    RITZ_TRY(stack(states, &Phi, &Phi, true, T, &made.T));
    RITZ_TRY(stack(states, &MPhi, &Phi, false, W, &made.W));
    RITZ_TRY(behind(states, &modes->Phi, &modes->Phi, &made.T));
    RITZ_TRY(behind(states, &modes->MPhi, &modes->Phi, &made.W));
    ritz_gramians_free(gramians);
    *gramians = made;
    made = (ritz_gramians){0};
done:
    ritz_gramians_free(&made);
    return status;
}
