/* What rankings share with each other. */
#ifndef RITZ_RANKING_COSTS_H
#define RITZ_RANKING_COSTS_H

#include <ritz/ranking.h>

/** Modal costs of each output: m x p, row k that of mode k. */
ritz_status ritz_modal_costs(const ritz_modal *modal, ritz_dense *out);

/** Name k of a list or, without one, "y1". */
void ritz_ranking_name_part(const char (*names)[RITZ_NAME_SIZE],
                            const char *letter, int64_t k,
                            char out[RITZ_NAME_SIZE]);

/** Mean of the values within each cluster, for all of its modes. */
void ritz_ranking_share(const ritz_modal *modal, double *value);

/** Modes by magnitude of value, of equal ones the lower. */
ritz_status ritz_ranking_sort(int64_t count, const double *value,
                              int64_t *order);

/** The first mode of each mode's cluster. */
void ritz_ranking_clusters(const ritz_modal *modal, int64_t *cluster);

#endif
