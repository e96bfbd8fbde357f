/* Columns in the order in which they matter, whatever they are columns of. */
#ifndef RITZ_FIT_ORDER_H
#define RITZ_FIT_ORDER_H

#include <ritz/model.h>

/**
 * How far a model of some columns is off, in parts of its tolerance; infinite
 * if it is none. Once it is known to be @p most or more it need not be known
 * better.
 */
typedef ritz_status ritz_fit_ratio(void *context, int64_t count,
                                   const int64_t *column, double most,
                                   double *out);

typedef struct ritz_fit_order {
    int64_t count, fixed; /* columns; those that stay, first */
    int64_t *column;      /* count, what matters most first */
    ritz_fit_ratio *ratio;
    void *context;  /* of ratio; borrowed */
    int64_t *trial; /* to work in */
    double *alone;  /* of each column: the ratio without it */
} ritz_fit_order;

/** Whether a column must stay: without it a body could not move rigidly, or
 * would not have its interface. */
bool ritz_fit_stays(ritz_column_kind kind);

/**
 * What the columns of a body are. One that takes part in its rigid motion is
 * rigid, whatever its method calls it: modes of Rubin store energy.
 *
 * @param[out] kind  one for each column
 */
ritz_status ritz_fit_kinds(const ritz_reduced *whole, ritz_column_kind *kind);

/** Columns as they were made, but that those that must stay are first. */
ritz_status ritz_fit_order_new(int64_t count, const ritz_column_kind *kind,
                               ritz_fit_ratio *ratio, void *context,
                               ritz_fit_order *out);

/** Those that may go, by how far the model without each of them alone is off.
 */
ritz_status ritz_fit_order_alone(ritz_fit_order *order);

/** One after the other left out, of few that matter least alone that without
 * which the rest is nearest to its tolerance. */
ritz_status ritz_fit_order_drop(ritz_fit_order *order);

void ritz_fit_order_free(ritz_fit_order *order);

#endif
