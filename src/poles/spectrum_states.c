/*
 * Poles of a state space: all of a dense one; of a sparse one those nearest to
 * 0 or to a frequency.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/space.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Number of poles that are computed first when a frequency limits them. */
enum { FIRST = 20 };

/* All poles of a dense state space, without shapes and residuals. */
static ritz_status find_all(const ritz_state_space *model, ritz_spectrum *out)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_state_space_poles(model, &count, &out->s));
    RITZ_CHECK_NEW(out->residual, count);
    for (int64_t k = 0; k < count; k++) {
        if (cimag(out->s[k]) < 0.0)
            continue;
        out->residual[out->count] = nan("");
        out->s[out->count++] = out->s[k];
    }
    (void)snprintf(out->engine, sizeof out->engine, "dense LAPACK");
    return RITZ_OK;
}

typedef struct sized_pole {
    double size, residual;
    double _Complex s;
} sized_pole;

static int compare_sizes(const void *left, const void *right)
{
    const sized_pole *a = left, *b = right;

    return (a->size > b->size) - (a->size < b->size);
}

/* Poles on and above the real axis with |s| up to @p limit, by ascending |s|,
   @p most at most. */
static ritz_status list_pairs(const ritz_pencil_pairs *pairs, double limit,
                              int64_t most, ritz_spectrum *out)
{
    RITZ_OWN_ARRAY sized_pole *pole = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(pole, pairs->count);
    for (int64_t k = 0; k < pairs->count && count < most; k++)
        if (cimag(pairs->s[k]) >= 0.0 && cabs(pairs->s[k]) <= limit)
            pole[count++] = (sized_pole){cabs(pairs->s[k]), pairs->residual[k],
                                         pairs->s[k]};
    qsort(pole, (size_t)count, sizeof *pole, compare_sizes);
    RITZ_CHECK_NEW(out->s, count);
    RITZ_CHECK_NEW(out->residual, count);
    for (int64_t k = 0; k < count; k++) {
        out->s[k] = pole[k].s;
        out->residual[k] = pole[k].residual;
    }
    out->count = count;
    (void)snprintf(out->engine, sizeof out->engine, "%s", pairs->engine);
    return RITZ_OK;
}

/* Poles up to a frequency: their number is doubled until one lies beyond it. */
static ritz_status find_up_to(ritz_pencil *pencil, double limit,
                              ritz_pencil_pairs *out)
{
    for (int64_t count = FIRST;; count *= 2) {
        RITZ_OWN(ritz_pencil_pairs) found = {0};
        bool all = count >= pencil->n;

        RITZ_CHECK(ritz_space_slowest(pencil, all ? pencil->n : count, &found));
        if (all || found.count == 0 ||
            cabs(found.s[found.count - 1]) > limit * RITZ_RANGE_END) {
            RITZ_MOVE(*out, found);
            return RITZ_OK;
        }
    }
}

ritz_status ritz_spectrum_of_space(const ritz_state_space *model,
                                   const ritz_span *span, ritz_spectrum *out)
{
    bool by_number = span->modes >= 0;
    double limit =
        by_number ? HUGE_VAL : 2.0 * RITZ_PI * span->up_to_hz * RITZ_RANGE_END;
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(ritz_pencil_pairs) near = {0};

    if (!ritz_state_space_is_sparse(model))
        return find_all(model, out);
    RITZ_CHECK(ritz_pencil_of_space(model, &pencil));
    if (by_number)
        RITZ_CHECK(ritz_space_slowest(
            &pencil, 2 * span->modes > 0 ? 2 * span->modes : 1, &near));
    else
        RITZ_CHECK(find_up_to(&pencil, limit, &near));
    return list_pairs(&near, limit, by_number ? span->modes : near.count, out);
}

ritz_status ritz_spectrum_near(const ritz_state_space *model, double near_hz,
                               int64_t count, ritz_spectrum *out)
{
    RITZ_OWN(ritz_pencil) pencil = {0};
    RITZ_OWN(ritz_pencil_pairs) near = {0};
    RITZ_OWN(ritz_spectrum) spectrum = {0};
    ritz_status status = RITZ_OK;

    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "no poles are asked for");
    RITZ_CHECK(ritz_pencil_of_space(model, &pencil));
    status =
        ritz_pencil_nearest(&pencil, ritz_complex(0.0, 2.0 * RITZ_PI * near_hz),
                            near_hz > 0.0 ? count : 2 * count, &near);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "a pole lies at %.9g Hz itself: ask next to it", near_hz);
    RITZ_CHECK(status);
    RITZ_CHECK(list_pairs(&near, HUGE_VAL, count, &spectrum));
    RITZ_MOVE(*out, spectrum);
    return RITZ_OK;
}
