/*
 * Columns in the order in which they matter. From all of them one at a time is
 * left out, that without which the model is nearest to its tolerance; what is
 * left out last comes first.
 */
#include "fit/order.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns that are tried at each step: those that matter least alone. */
enum { TRIED = 6 };

bool ritz_fit_stays(ritz_column_kind kind)
{
    static const ritz_column_kind kinds[] = {
        RITZ_COLUMN_RIGID,      RITZ_COLUMN_CONSTRAINT, RITZ_COLUMN_INTERFACE,
        RITZ_COLUMN_ATTACHMENT, RITZ_COLUMN_RESIDUAL,   RITZ_COLUMN_MASSLESS,
        RITZ_COLUMN_FORCE};

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (kind == kinds[k])
            return true;
    return false;
}

/* Columns j that take part in rigid motion, |x_j| sqrt(M_jj) of its x'M x = 1. */
ritz_status ritz_fit_kinds(const ritz_reduced *whole, ritz_column_kind *kind)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    const int64_t n = whole->K.ncol;

    if (n == 0)
        return RITZ_OK;
    memcpy(kind, whole->columns.kind, (size_t)n * sizeof *kind);
    status = ritz_eigen_dense(&whole->K, &whole->M, &pairs);
    if (status == RITZ_ERR_SINGULAR)
        return RITZ_OK; /* a mechanism without mass: kinds alone decide */
    RITZ_TRY(status);
    for (int64_t r = 0; r < pairs.num_rigid; r++)
        for (int64_t j = 0; j < n; j++) {
            const double mass = ritz_dense_col(&whole->M, j)[j];
            const double part = ritz_dense_col(&pairs.Phi, r)[j];

            if (part * part * mass > RITZ_RIGID_PART * RITZ_RIGID_PART &&
                !ritz_fit_stays(kind[j]))
                kind[j] = RITZ_COLUMN_RIGID;
        }
done:
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status ritz_fit_order_new(int64_t count, const ritz_column_kind *kind,
                               ritz_fit_ratio *ratio, void *context,
                               ritz_fit_order *out)
{
    RITZ_OWN(ritz_fit_order)
    made = {.count = count, .ratio = ratio, .context = context};

    RITZ_CHECK_NEW(made.column, count);
    RITZ_CHECK_NEW(made.trial, count);
    RITZ_CHECK_NEW(made.alone, count);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0, at = made.fixed; k < count; k++)
            if (ritz_fit_stays(kind[k]) == (pass == 0)) {
                made.column[at++] = k;
                made.fixed += pass == 0;
            }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* Without one of the first `left` columns of the order. */
static ritz_status without(const ritz_fit_order *o, int64_t left, int64_t which,
                           double most, double *out)
{
    memcpy(o->trial, o->column, (size_t)left * sizeof *o->trial);
    memmove(o->trial + which, o->trial + which + 1,
            (size_t)(left - which - 1) * sizeof *o->trial);
    return o->ratio(o->context, left - 1, o->trial, most, out);
}

ritz_status ritz_fit_order_alone(ritz_fit_order *o)
{
    for (int64_t k = o->fixed; k < o->count && o->count > 1; k++) {
        ritz_monitor_step("columns alone", k, o->count);
        RITZ_CHECK(without(o, o->count, k, HUGE_VAL, &o->alone[o->column[k]]));
    }
    for (int64_t k = o->fixed + 1; k < o->count; k++)
        for (int64_t i = k; i > o->fixed; i--) {
            int64_t here = o->column[i];

            if (!(o->alone[here] > o->alone[o->column[i - 1]]))
                break;
            o->column[i] = o->column[i - 1];
            o->column[i - 1] = here;
        }
    return RITZ_OK;
}

/* Of the last few of those that are left, the one that goes to the end. */
static ritz_status drop(ritz_fit_order *o, int64_t left)
{
    double least = HUGE_VAL;
    int64_t worst = left - 1;
    int64_t here = 0;

    for (int64_t t = 0; t < TRIED && left - 1 - t >= o->fixed; t++) {
        double ratio = 0.0;

        RITZ_CHECK(without(o, left, left - 1 - t, least, &ratio));
        if (ratio < least) {
            least = ratio;
            worst = left - 1 - t;
        }
    }
    here = o->column[worst];
    memmove(o->column + worst, o->column + worst + 1,
            (size_t)(left - 1 - worst) * sizeof *o->column);
    o->column[left - 1] = here;
    return RITZ_OK;
}

ritz_status ritz_fit_order_drop(ritz_fit_order *o)
{
    /* the one that matters least alone is the first to go */
    for (int64_t left = o->count - 1; left > o->fixed + 1; left--) {
        ritz_monitor_step("columns in order", o->count - left, o->count);
        RITZ_CHECK(drop(o, left));
    }
    return RITZ_OK;
}

void ritz_fit_order_free(ritz_fit_order *order)
{
    free(order->column);
    free(order->trial);
    free(order->alone);
    *order = (ritz_fit_order){0};
}
