/*
 * The factors of an estimate: L L' of K - sigma M for residuals, L D L' of
 * K - rho M for each count.
 *
 * The first two are made at the same time by one thread each. They have one
 * order of rows. Each by two threads, one after the other, takes longer: a BLAS
 * gains little from a second thread in fronts of a few hundred rows.
 */
#include "base/alloc.h"
#include "base/aside.h"
#include "estimate/estimator.h"
#include "linear/factor.h"
#include "linear/inertia.h"
#include "linear/ordering.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_SHIFTS = 16 };

/* The factor of K - sigma M is not needed while modes are counted. */
static ritz_status spill_factor(void *of)
{
    ritz_estimator *estimator = of;

    return estimator->A ? ritz_factor_spill(estimator->A) : RITZ_OK;
}

static ritz_status open_counter(ritz_estimator *estimator, const int64_t *order)
{
    const ritz_component *full = estimator->component;

    RITZ_CHECK(
        ritz_counter_new(&full->K, &full->M, order, &estimator->counter));
    ritz_counter_relieve(estimator->counter,
                         (ritz_relief){spill_factor, estimator});
    return RITZ_OK;
}

ritz_status ritz_estimator_below(ritz_estimator *estimator, double rho,
                                 int64_t *below)
{
    if (rho > 0.0 && estimator->early.rho == rho) {
        *below = estimator->early.below;
        return RITZ_OK;
    }
    estimator->num_factors++;
    if (!estimator->counter)
        RITZ_CHECK(open_counter(
            estimator, estimator->A ? ritz_factor_order(estimator->A) : NULL));
    return ritz_counter_below(estimator->counter, rho, below);
}

/* A count that is taken while K - sigma M is factored. */
typedef struct first_count {
    const ritz_component *full; /* borrowed */
    const int64_t *order;       /* borrowed */
    double rho;
    ritz_counter *counter; /* NULL: the count has failed */
    int64_t below;
    ritz_aside aside;
} first_count;

static void take_count(void *task)
{
    first_count *c = task;
    RITZ_OWN(ritz_counter) *counter = NULL;

    if (ritz_counter_new(&c->full->K, &c->full->M, c->order, &counter) !=
        RITZ_OK)
        return;
    ritz_counter_share(counter, true);
    if (ritz_counter_below(counter, c->rho, &c->below) == RITZ_OK)
        RITZ_MOVE(c->counter, counter);
}

static ritz_status shift(const ritz_estimator *estimator, ritz_sparse *A)
{
    const ritz_component *full = estimator->component;

    return ritz_sparse_add(1.0, &full->K, -estimator->sigma, &full->M, A);
}

/*
 * K - sigma M = L L'.
 *
 * @param[in] first  K - sigma M of the present sigma; NULL: compute it
 * @param[in] order  of rows, for one thread; NULL: find one
 */
static ritz_status factor_shifted(ritz_estimator *estimator,
                                  const ritz_sparse *first,
                                  const int64_t *order)
{
    ritz_status status = RITZ_ERR_SINGULAR;

    for (int t = 0; t < MOST_SHIFTS && status == RITZ_ERR_SINGULAR; t++) {
        RITZ_OWN(ritz_sparse) A = {0};
        const ritz_sparse *shifted = t == 0 && first ? first : &A;

        estimator->sigma *= t > 0 ? 10.0 : 1.0;
        if (shifted == &A)
            RITZ_CHECK(shift(estimator, &A));
        status = order ? ritz_factor_spd_alone(shifted, order, &estimator->A)
                       : ritz_factor_spd(shifted, &estimator->A);
    }
    return status;
}

/* Both factors. What the count holds is gone when the second try begins, which
   one thread makes, too, so that results do not depend on memory. */
static ritz_status factor_and_count(ritz_estimator *estimator, double rho)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;
    first_count c = {.full = estimator->component, .rho = rho};
    const double sigma = estimator->sigma; /* of A */
    ritz_status status = RITZ_OK;

    RITZ_CHECK(shift(estimator, &A));
    RITZ_CHECK(ritz_ordering_new(&A, &order));
    c.order = order;
    ritz_aside_begin(take_count, &c, true, &c.aside);
    status = factor_shifted(estimator, &A, order);
    ritz_aside_end(&c.aside);
    if (status == RITZ_ERR_MEMORY)
        status = factor_shifted(estimator,
                                estimator->sigma == sigma ? &A : NULL, order);
    if (!c.counter)
        return status;
    ritz_counter_share(c.counter, false);
    ritz_counter_relieve(c.counter, (ritz_relief){spill_factor, estimator});
    estimator->counter = c.counter;
    estimator->early = (ritz_counted){rho, c.below};
    estimator->num_factors++;
    return status;
}

ritz_status ritz_estimator_factor(ritz_estimator *estimator, double rho)
{
    const int64_t n = estimator->component->num_dofs;

    if (estimator->A)
        return RITZ_OK;
    return ritz_context(isnan(rho) || n < RITZ_ORDER_FROM
                            ? factor_shifted(estimator, NULL, NULL)
                            : factor_and_count(estimator, rho),
                        "estimate");
}
